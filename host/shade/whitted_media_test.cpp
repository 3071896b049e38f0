// SPDX-License-Identifier: Apache-2.0
// Tests media and fog in solids and around them, in pictures of one pixel.
#include "host/render/render.h"
#include "host/render/test_shapes.h"
#include "host/shade/whitted.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace ovc {

static float red_of(const Scene& scene, const Camera& camera) {
    Film film(1, 1);
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    const Result<RenderReport> done = render_picture(scene, camera, *backend, {}, {}, film);
    EXPECT_TRUE(done && done->complete);
    return film.image().pixels[0].r;
}

/// Returns the red of a pixel behind a clear box that the media fill, 2 long along the view.
static float seen_through(const std::vector<Medium>& media, bool lamp) {
    Scene scene;
    Material clear;
    clear.transmission = 1;
    clear.media = media;
    clear.hollow = true;
    add_box(scene, clear, {-1, -1, -1}, {1, 1, 1});
    scene.materials.push_back({"blocker"});
    scene.add_mesh("blocker", 1, quad({-2, 4, 2}, {2, 4, 2}, {2, 4, 0}, {-2, 4, 0}));
    if (lamp)
        scene.lights = {{{0, 1000, 0}, vec3(std::numbers::pi_v<float>)}};
    scene.may_add_light = false;
    scene.background = {vec3(0.5f), vec3(0.5f)};
    Camera camera;
    camera.eye = {0, 0, 9};
    camera.fov_degrees = 0.01;
    return red_of(scene, camera);
}

TEST(WhittedMedia, MediaFillWhatTheirSurfaceEncloses) {
    const float empty = seen_through({}, false);
    Medium dark, bright, misty;
    dark.absorption = vec3(0.3f);
    bright.emission = vec3(0.1f);
    misty.scattering = vec3(0.1f);
    misty.extinction = 0;
    misty.samples = 64;
    misty.levels = 0;
    EXPECT_NEAR(seen_through({dark}, false), empty * std::exp(-0.6f), 1e-4);
    EXPECT_NEAR(seen_through({bright}, false), empty + 0.2f, 1e-4);
    EXPECT_NEAR(seen_through({misty}, true) - seen_through({}, true), 0.1f, 0.002)
        << "half of the way is in shadow";
    EXPECT_NEAR(seen_through({misty}, false), empty, 1e-6);
}

/// Three boxes in each other, each of its own medium, with a wall in the innermost one.
TEST(WhittedMedia, MediaOfContainersAddUpAlsoAroundTheCamera) {
    const auto seen_from = [](double z) {
        Scene scene;
        for (uint32_t box = 0; box < 3; ++box) {
            Material clear;
            clear.transmission = 1;
            clear.media.resize(1);
            clear.hollow = true;
            clear.media[0].absorption = vec3(box == 0 ? 0.1f : box == 1 ? 0.2f : 0.4f);
            const dvec3 half(1, 1, 3 - int(box));
            add_box(scene, clear, -half, half);
        }
        scene.materials.push_back({"wall", vec3(1)});
        scene.materials[3].finish = Finish{.ambient = vec3(1), .diffuse = 0};
        scene.add_mesh("wall", 3, quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}));
        scene.may_add_light = false;
        Camera camera;
        camera.eye = {0.01, 0.02, z};
        camera.target = {0.01, 0.02, 0};
        camera.fov_degrees = 0.01;
        return double(red_of(scene, camera));
    };
    for (const double z : {9.0, 3.0 - 1e-6})
        EXPECT_NEAR(seen_from(z), std::exp(-(0.1 + 0.3 + 0.7)), 1e-4) << z;
    EXPECT_NEAR(seen_from(1.5), std::exp(-(0.15 + 0.7)), 1e-4);
    EXPECT_NEAR(seen_from(0.5), std::exp(-0.35), 1e-4);
}

/// Returns the red of a white floor below a clear box, 2 high, under a lamp high above.
static float floor_below(const Material& box, const Background& air = {}, bool fades = false) {
    Scene scene;
    add_box(scene, box, {-2, 1, -2}, {2, 3, 2});
    scene.materials.push_back({"floor", vec3(1)});
    scene.materials[1].finish = Finish{};
    scene.add_mesh("floor", 1, quad({-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}));
    scene.lights = {{{0, 1000, 0}, vec3(0.5f * std::numbers::pi_v<float>)}};
    scene.lights[0].fades_in_air = fades;
    scene.background = air;
    Camera camera;
    camera.eye = {0, 0.5, 9};
    camera.target = {0, 0, 0};
    camera.fov_degrees = 0.01;
    return red_of(scene, camera);
}

/// As povray 3.7.0.10 draws them, whatever media_attenuation says.
TEST(WhittedMedia, MediaInASolidDimItsShadow) {
    Material box;
    box.transmission = 1;
    const float bare = floor_below(box);
    EXPECT_NEAR(bare, 0.5f, 1e-3);
    Medium dark, misty;
    dark.absorption = vec3(0.3f);
    misty.scattering = vec3(0.2f);
    box.media = {dark, misty};
    EXPECT_NEAR(floor_below(box), bare * std::exp(-1.0f), 1e-3);
}

TEST(WhittedMedia, ALampFadesInTheAirIfItIsToldTo) {
    Material box;
    box.transmission = 1;
    Background air;
    air.fogs = {{{vec3(0)}, 1000}};
    const float lit = floor_below(box, air);
    EXPECT_NEAR(floor_below(box, air, /* fades= */ true), lit * std::exp(-1.0f), 1e-3);
}

TEST(WhittedMedia, FogFillsHollowSolids) {
    const auto seen = [](bool hollow) {
        Scene scene;
        Material clear;
        clear.transmission = 1;
        clear.hollow = hollow;
        add_box(scene, clear, {-1, -1, -3}, {1, 1, 3});
        scene.background = {vec3(1), vec3(1)};
        scene.materials.push_back({"wall", vec3(1)});
        scene.materials[1].finish = Finish{.ambient = vec3(1), .diffuse = 0};
        scene.add_mesh("wall", 1, quad({-9, -9, -4}, {9, -9, -4}, {9, 9, -4}, {-9, 9, -4}));
        scene.background.fogs = {{{vec3(0)}, 10}};
        scene.may_add_light = false;
        Camera camera;
        camera.eye = {0, 0, 6};
        camera.fov_degrees = 0.01;
        return red_of(scene, camera);
    };
    EXPECT_NEAR(seen(true), std::exp(-1.0f), 1e-3);
    EXPECT_NEAR(seen(false), std::exp(-0.4f), 1e-3);
}

/// Returns what is left of the light of a wall behind two boxes in each other, the inner one with
/// dark media, as povray 3.7.0.10 has it.
static float through_boxes(bool outer_is_hollow, double eye_z) {
    Scene scene;
    Material clear, smoke;
    clear.transmission = smoke.transmission = 1;
    clear.hollow = outer_is_hollow;
    smoke.hollow = true;
    Medium dark;
    dark.absorption = vec3(0.5f);
    smoke.media = {dark};
    add_box(scene, clear, {-2, -2, -3}, {2, 2, 3});
    add_box(scene, smoke, {-1, -1, -1}, {1, 1, 1});
    scene.materials.push_back({"wall", vec3(1)});
    scene.materials[2].finish = Finish{.ambient = vec3(1), .diffuse = 0};
    scene.add_mesh("wall", 2, quad({-9, -9, -4}, {9, -9, -4}, {9, 9, -4}, {-9, 9, -4}));
    scene.may_add_light = false;
    Camera camera;
    camera.eye = {0, 0, eye_z};
    camera.fov_degrees = 0.01;
    return red_of(scene, camera);
}

TEST(WhittedMedia, MediaEndWhereASolidThatIsNotHollowBegins) {
    EXPECT_NEAR(through_boxes(true, 6), std::exp(-1.0f), 1e-3);
    EXPECT_NEAR(through_boxes(false, 6), 1, 1e-3);
    EXPECT_NEAR(through_boxes(true, 2), std::exp(-1.0f), 1e-3);
    EXPECT_NEAR(through_boxes(false, 2), 1, 1e-3) << "the camera is in it";
    EXPECT_NEAR(through_boxes(true, 0.5), std::exp(-0.75f), 1e-3);
}

} // namespace ovc
