// SPDX-License-Identifier: Apache-2.0
// Tests which rays see meshes that a scene hides from some of them, on every backend that has
// masks. What POV-Ray 3.7 draws of the same scenes is written beside them.
#include "host/render/sight.h"

#include "host/camera/camera.h"
#include "host/render/render.h"
#include "importers/readers.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>

namespace ovc {
namespace {

constexpr uint32_t kSightSide = 48;

/// Red balls that are seen at the top left directly, at the bottom left through a pane, at the top
/// right in a mirror, and at the bottom right in the mirror through a pane.
constexpr std::string_view kBalls = R"(
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 10 }
camera { location <0, 0, -5> right x up y look_at 0 angle 40 }
#declare Ball = sphere { 0, 0.5 pigment { rgb <1, 0, 0> } finish { ambient 1 diffuse 0 } FLAG }
object { Ball translate <-1.2, 1, 0> }
object { Ball translate <-1.2, -1, 0> }
box { <-1.8, -1.8, -1>, <-0.6, -0.3, -0.9> pigment { rgbt 1 } }
box { <0, -5, 3>, <5, 5, 3.1> pigment { rgb 0 } finish { reflection 1 ambient 0 diffuse 0 } }
object { Ball translate <1.5, 1, -6> }
object { Ball translate <1.5, -1.5, -6> }
box { <-1, -3, -5.5>, <4, -0.5, -5.4> pigment { rgbt 1 } }
)";

/// A ball over a white floor, seen from above.
constexpr std::string_view kShadow = R"(
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 9, -0.1> right x up y look_at 0 angle 40 }
light_source { <4, 8, 0> 1 }
plane { y, 0 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }
sphere { <0, 2, 0>, 0.5 pigment { rgb <1, 0, 0> } finish { ambient 0.3 diffuse 0.7 } FLAG }
)";

Scene scene_of(std::string_view text, const std::string& flag) {
    std::string with_flag(text);
    with_flag.replace(with_flag.find("FLAG"), 4, flag);
    Result<Scene> scene = parse_pov(with_flag, "x.pov", {});
    EXPECT_TRUE(scene) << scene.error().message;
    return std::move(*scene);
}

std::map<std::string, std::unique_ptr<Backend>> backends_of(const Scene& scene) {
    std::map<std::string, std::unique_ptr<Backend>> all;
    all["cpu"] = make_cpu_backend(scene.soup);
    if (auto embree = make_embree_backend(scene.soup, EmbreeMode::Robust))
        all["embree"] = std::move(*embree);
    BackendOptions options;
    options.kind = BackendKind::TwoLevel;
    if (auto gpu = make_backend(scene.soup, options, {}))
        all["two-level"] = std::move(*gpu);
    return all;
}

Image drawn(const Scene& scene, Backend& backend, RenderMode mode) {
    Film film(kSightSide, kSightSide);
    RenderOptions options;
    options.mode = mode;
    options.max_depth = 9;
    EXPECT_TRUE(render_picture(scene, *scene.camera, backend, options, {}, film));
    return film.image();
}

/// Returns whether each quarter of the picture has a red ball: the top left, the top right, the
/// bottom left, the bottom right.
std::array<bool, 4> balls_in(const Image& image) {
    std::array<bool, 4> quarters{};
    for (uint32_t y = 0; y < kSightSide; ++y)
        for (uint32_t x = 0; x < kSightSide; ++x)
            if (const vec4 c = image.at(x, y); c.r > 0.5f && c.g < 0.3f)
                quarters[2 * (y >= kSightSide / 2) + (x >= kSightSide / 2)] = true;
    return quarters;
}

TEST(Sight, HidesFromTheCameraAndFromMirrors) {
    const std::pair<const char*, std::array<bool, 4>> cases[] = {
        {"", {true, true, true, true}},
        {"no_shadow", {true, true, true, true}},
        {"no_image", {false, true, false, true}},
        {"no_reflection", {true, false, true, false}},
        {"no_image no_reflection", {}}};
    for (const auto& [flag, expected] : cases) {
        const Scene scene = scene_of(kBalls, flag);
        for (const auto& [name, backend] : backends_of(scene))
            for (const RenderMode mode : {RenderMode::Batched, RenderMode::Mixed})
                EXPECT_EQ(balls_in(drawn(scene, *backend, mode)), expected) << flag << name;
    }
}

TEST(Sight, HidesFromShadowRays) {
    const auto darkest_floor = [](const Image& image) {
        float darkest = 1;
        for (const vec4& c : image.pixels)
            darkest = c.r == c.g ? std::min(darkest, c.r) : darkest;
        return darkest;
    };
    for (const auto& [flag, has_shadow] :
         {std::pair("", true), {"no_image", true}, {"no_reflection", true}, {"no_shadow", false}}) {
        const Scene scene = scene_of(kShadow, flag);
        for (const auto& [name, backend] : backends_of(scene))
            for (const RenderMode mode : {RenderMode::Batched, RenderMode::Mixed}) {
                const float darkest = darkest_floor(drawn(scene, *backend, mode));
                EXPECT_EQ(darkest < 0.01f, has_shadow) << flag << name << darkest;
            }
    }
}

/// A light that stands for an emitter lies in it. Of the others an emitter throws shadows.
TEST(Sight, TellsLightsThatStandForEmittersFromOthers) {
    Scene scene = scene_of(kShadow, "");
    scene.lights = {{.stand_in = true}, {}};
    scene.show(0, kSeenByAll & ~uint32_t(kShadowsStandIns));
    const std::vector<Shadow> shadows = {{0, 0}, {0, 1}, {0, kNone}};
    std::vector<uint32_t> room;
    const Sight sight(scene);
    const Sieves sieves = sight.of(shadows, room);
    EXPECT_EQ(std::vector(sieves.masks.begin(), sieves.masks.end()),
              (std::vector<uint32_t>{kShadowsStandIns, kShadowsLights, kShadowsEmitters}));
}

TEST(Sight, LeavesOutWhatNoRaySees) {
    EXPECT_EQ(scene_of(kShadow, "no_image no_reflection no_shadow").meshes.size(), 1u);
}

TEST(Sight, AsksForNothingWhereAllRaysSeeAll) {
    const Scene scene = scene_of(kShadow, "");
    std::vector<uint32_t> room;
    EXPECT_TRUE(Sight(scene).of_camera(5, room).pass_all());
    const Scene hidden = scene_of(kShadow, "no_image");
    const Sieves sieves = Sight(hidden).of_camera(5, room);
    EXPECT_EQ(std::vector(sieves.masks.begin(), sieves.masks.end()),
              std::vector<uint32_t>(5, kSeenByCamera));
}

} // namespace
} // namespace ovc
