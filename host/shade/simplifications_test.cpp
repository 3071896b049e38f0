// SPDX-License-Identifier: Apache-2.0
// Sentences about what Whitted's integrator does not draw as its author meant.
#include "host/shade/whitted.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace ovc {
namespace {

/// Returns what is said of a scene that the integrator simplifies.
std::vector<std::string> simplifications(const Scene& scene, const std::string& source) {
    std::vector<std::string> said;
    tell_simplifications(scene, scene.lights, source,
                         [&](LogLevel, const std::string& sentence) { said.push_back(sentence); });
    return said;
}

/// Path tracing has the light of a picture in the sky, so that no reader says it.
TEST(Simplifications, TellThatAPictureInTheSkyLightsEvenly) {
    Scene scene;
    scene.background.layers.push_back({});
    EXPECT_TRUE(simplifications(scene, "a.pbrt").empty()) << "POV-Ray's skies light nothing";
    scene.lights.push_back({.parallel = true, .stand_in = true});
    EXPECT_THAT(simplifications(scene, "a.pbrt"),
                testing::ElementsAre("a.pbrt: environment maps light surfaces as a sky of even "
                                     "colors; --integrator path has them as they are"));
}

TEST(Simplifications, TellThatSurfacesLightNoOthers) {
    Scene scene;
    scene.materials.emplace_back().optics = Optics{.emission = vec3(1)};
    EXPECT_THAT(simplifications(scene, "a.obj"),
                testing::ElementsAre("a.obj: surfaces that send out light are bright but light no "
                                     "others; --integrator path has their light"));
    scene.materials[0].finish.emplace(); // lights stand for such emitters
    EXPECT_TRUE(simplifications(scene, "a.obj").empty());
}

TEST(Simplifications, TellThatMetalsAreMatte) {
    Scene scene;
    Material& metal = scene.materials.emplace_back();
    metal.optics = Optics{.boundary = Optics::Boundary::Metal};
    EXPECT_THAT(simplifications(scene, "a.glb"),
                testing::ElementsAre("a.glb: metals are matte; --integrator path has their shine"));
    for (const float share : {0.0f, 0.5f}) {
        metal.maps.emplace().metallic = uint32_t(scene.textures.size());
        scene.textures.push_back({{}, {{0, {vec3(share)}, kNoTexture}}});
        EXPECT_EQ(simplifications(scene, "a.glb").empty(), share == 0);
    }
    metal.finish.emplace();
    EXPECT_TRUE(simplifications(scene, "a.glb").empty()) << "shown by its finish";
}

} // namespace
} // namespace ovc
