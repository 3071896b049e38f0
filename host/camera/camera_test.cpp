// SPDX-License-Identifier: Apache-2.0
// Tests of pinhole rays, the pixel order and the automatic view.
#include "host/camera/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace ovc {

TEST(Pinhole, LooksAtTheTargetThroughTheCentreOfTheImage) {
    Camera camera;
    camera.eye = {3, 4, 5};
    camera.target = {-1, 2, 0};
    const Ray ray = Pinhole(camera, 5, 3).ray(2, 1);
    EXPECT_EQ(ray.org, camera.eye);
    const dvec3 off =
        glm::cross(glm::normalize(ray.dir), glm::normalize(camera.target - camera.eye));
    EXPECT_LT(glm::length(off), 1e-15);
}

TEST(Pinhole, RowsGoDownAndColumnsGoRight) {
    const Pinhole pinhole(Camera{}, 4, 4); // from +z towards the origin, y up: x to the right
    EXPECT_LT(pinhole.ray(0, 0).dir.x, 0);
    EXPECT_GT(pinhole.ray(3, 0).dir.x, 0);
    EXPECT_GT(pinhole.ray(0, 0).dir.y, 0);
    EXPECT_LT(pinhole.ray(0, 3).dir.y, 0);
}

TEST(Pinhole, OpensTheFieldOfViewAlongTheShorterSide) {
    Camera camera;
    camera.fov_degrees = 90;
    // The image plane at distance 1 is 2 high; the outermost pixel centres are half a pixel inside.
    const dvec3 wide = Pinhole(camera, 200, 100).ray(0, 0).dir;
    EXPECT_NEAR(wide.y, 0.99, 1e-12);
    EXPECT_NEAR(wide.x, -1.99, 1e-12);
    const dvec3 tall = Pinhole(camera, 100, 200).ray(0, 0).dir;
    EXPECT_NEAR(tall.x, -0.99, 1e-12);
    EXPECT_NEAR(tall.y, 1.99, 1e-12);
    camera.fov_is_upright = true;
    EXPECT_EQ(Pinhole(camera, 200, 100).ray(0, 0).dir, wide);
    const dvec3 upright = Pinhole(camera, 100, 200).ray(0, 0).dir;
    EXPECT_NEAR(upright.x, -0.495, 1e-12);
    EXPECT_NEAR(upright.y, 0.995, 1e-12);
}

/// Returns POV-Ray's camera { location <1,2,3> direction 2*z right -1.6*x up <0,1,0.5> }, which is
/// left-handed, sheared, and wider than high whatever the image's size.
static Camera windowed(bool orthographic) {
    Camera camera;
    camera.eye = {1, 2, 3};
    camera.window = ImageWindow{{0, 0, 2}, {-1.6, 0, 0}, {0, 1, 0.5}, orthographic};
    return camera;
}

TEST(Pinhole, SeesThroughTheWindowThatTheCameraNames) {
    const Pinhole pinhole(windowed(false), 4, 2);
    const Ray first = pinhole.ray(0, 0); // 3/8 of the width to the left, 1/4 of the height up
    EXPECT_EQ(first.org, dvec3(1, 2, 3));
    EXPECT_LT(glm::length(first.dir - dvec3(0.6, 0.25, 2.125)), 1e-15);
    EXPECT_LT(glm::length(pinhole.ray(3, 1).dir - dvec3(-0.6, -0.25, 1.875)), 1e-15);
}

TEST(Pinhole, AWindowForAShapeIsNotStretched) {
    Camera camera;
    camera.window = ImageWindow{{0, 0, 1}, {4, 0, 0}, {0, 2, 0}};
    camera.window->shape = 2;
    const auto corner = [&](uint32_t width, uint32_t height) {
        const dvec3 first = Pinhole(camera, width, height).ray(0, 0).dir;
        return dvec2(first.x, first.y) / dvec2(1 - 1.0 / width, 1 - 1.0 / height);
    };
    EXPECT_LT(glm::length(corner(200, 100) - dvec2(-2, 1)), 1e-12);
    EXPECT_LT(glm::length(corner(400, 100) - dvec2(-4, 1)), 1e-12);
    EXPECT_LT(glm::length(corner(100, 100) - dvec2(-1, 1)), 1e-12);
    EXPECT_LT(glm::length(corner(100, 200) - dvec2(-1, 2)), 1e-12);
}

TEST(Pinhole, AnOrthographicWindowSendsParallelRays) {
    const Pinhole pinhole(windowed(true), 4, 2);
    const Ray first = pinhole.ray(0, 0), last = pinhole.ray(3, 1);
    EXPECT_LT(glm::length(first.org - dvec3(1.6, 2.25, 3.125)), 1e-15);
    EXPECT_LT(glm::length(last.org - dvec3(0.4, 1.75, 2.875)), 1e-15);
    EXPECT_EQ(first.dir, dvec3(0, 0, 2));
    EXPECT_EQ(last.dir, first.dir);
}

TEST(Pinhole, AcceptsAnUpAlongTheView) {
    Camera camera;
    camera.eye = {0, 5, 0};
    EXPECT_TRUE(is_finite(Pinhole(camera, 8, 8).ray(3, 5).dir));
}

TEST(PixelOrder, VisitsEveryPixelOnce) {
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, {8u, 8u}, {17u, 5u}, {64u, 48u}, {1u, 100u}}) {
        std::vector<uint32_t> pixels = pixel_order(width, height);
        std::sort(pixels.begin(), pixels.end());
        std::vector<uint32_t> all(size_t(width) * height);
        std::iota(all.begin(), all.end(), 0u);
        EXPECT_EQ(pixels, all) << width << " x " << height;
    }
}

TEST(PixelOrder, GoesFromNeighbourToNeighbour) {
    const std::vector<uint32_t> pixels = pixel_order(64, 64);
    for (size_t i = 1; i < pixels.size(); ++i) {
        const auto apart = [](uint32_t a, uint32_t b) { return a > b ? a - b : b - a; };
        EXPECT_EQ(apart(pixels[i] % 64, pixels[i - 1] % 64) +
                      apart(pixels[i] / 64, pixels[i - 1] / 64),
                  1u);
    }
}

TEST(PixelOrder, KeepsATileTogether) {
    for (const auto& [width, height] : {std::pair{64u, 64u}, {48u, 24u}}) {
        const std::vector<uint32_t> pixels = pixel_order(width, height);
        for (size_t i = 0; i < pixels.size(); ++i) {
            const uint32_t first = pixels[i / 64 * 64];
            EXPECT_EQ(pixels[i] % width / 8, first % width / 8);
            EXPECT_EQ(pixels[i] / width / 8, first / width / 8);
        }
    }
}

/// Returns the largest |x| and |y| of the corners of `box` as `camera` sees them; 1 is the edge of
/// the image.
static dvec2 seen_extent(const Box& box, const Camera& camera, uint32_t width, uint32_t height) {
    const Pinhole pinhole(camera, width, height);
    const double plane =
        std::tan(camera.fov_degrees * 3.14159265358979323846 / 360) / std::min(width, height);
    const dvec3 forward = glm::normalize(camera.target - camera.eye);
    dvec2 largest(0);
    for (int i = 0; i < 8; ++i) {
        const dvec3 corner(i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y,
                           i & 4 ? box.hi.z : box.lo.z);
        const dvec3 d = corner - camera.eye;
        const double depth = glm::dot(d, forward);
        EXPECT_GT(depth, 0);
        const dvec2 at(std::abs(glm::dot(d, pinhole.right())) / depth / (plane * width),
                       std::abs(glm::dot(d, pinhole.up())) / depth / (plane * height));
        largest = glm::max(largest, at);
    }
    return largest;
}

TEST(FramingCamera, ShowsTheWholeBoxAndFillsTheImage) {
    const Box boxes[] = {{dvec3(-1), dvec3(1)},
                         {{1e6, 0, 0}, {1e6 + 10, 1, 2}},
                         {{0, 0, 0}, {1, 50, 1}},
                         {{0, 0, 0}, {3, 0, 3}}};
    for (const Box& box : boxes)
        for (const auto& [width, height] : {std::pair{512u, 512u}, {800u, 200u}, {200u, 800u}}) {
            for (const int up : {0, 1, 2}) {
                const dvec2 seen =
                    seen_extent(box, framing_camera(box, width, height, up), width, height);
                const double fullest = std::max(seen.x, seen.y);
                EXPECT_LT(fullest, 1);
                EXPECT_GT(fullest, 0.8);
            }
        }
}

TEST(FramingCamera, LooksFromAboveWhateverIsUp) {
    const Box box{dvec3(-1), dvec3(1)};
    for (const int up : {0, 1, 2}) {
        const Camera camera = framing_camera(box, 10, 10, up);
        EXPECT_EQ(camera.up, axis_vector(up));
        const dvec3 towards = glm::normalize(camera.eye);
        EXPECT_NEAR(towards[up], 0.304, 1e-3);
    }
    EXPECT_LT(framing_camera(box, 10, 10, 2).eye.y, -1) << "in front of a z-up model is -y";
}

TEST(FramingCamera, CopesWithNothingAndWithOnePoint) {
    EXPECT_EQ(framing_camera(Box{}, 10, 10).eye, Camera{}.eye);
    const Camera camera = framing_camera(Box{dvec3(7), dvec3(7)}, 10, 10);
    EXPECT_EQ(camera.target, dvec3(7));
    EXPECT_NE(camera.eye, camera.target);
}

TEST(ShoulderLight, StandsAboveTheCamera) {
    const Camera camera = framing_camera(Box{dvec3(-1), dvec3(1)}, 10, 10);
    EXPECT_GT(shoulder_light(camera).position.y, camera.eye.y);
    Scene scene;
    EXPECT_EQ(placed_lights(scene, {}, camera).size(), 1u);
    scene.may_add_light = false;
    EXPECT_EQ(placed_lights(scene, {}, camera).size(), 0u) << "as POV-Ray has it";
    EXPECT_EQ(placed_lights(scene, {Light{}}, camera).size(), 1u);
}

TEST(CheckCamera, RefusesWhatMakesNoRays) {
    EXPECT_TRUE(check_camera({}));
    const double nan = std::nan("");
    const struct {
        Camera camera;
        const char* error;
    } cases[] = {
        {{{nan, 0, 1}}, "the camera's numbers are not all finite and within 1e+100"},
        {{{0, 0, 2e100}}, "the camera's numbers are not all finite and within 1e+100"},
        {{{1, 2, 3}, {1, 2, 3}}, "the camera looks from a point at itself"},
        {{{0, 0, 1e-300}, {0, 0, 0}}, "the camera looks from a point at itself"},
        {{{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, nan},
         "the camera's field of view is nan, not between 0 and 180 degrees"},
    };
    for (const auto& c : cases) {
        const Result<Done> checked = check_camera(c.camera);
        ASSERT_FALSE(checked) << c.error;
        EXPECT_EQ(checked.error().message, c.error);
    }
    Camera flat = windowed(false);
    flat.window->direction = {1, 1, 0.5};
    EXPECT_EQ(check_camera(flat).error().message,
              "the camera's direction, right and up lie in one plane");
    flat.window->direction = {0, nan, 1};
    EXPECT_FALSE(check_camera(flat));
    EXPECT_TRUE(check_camera(windowed(true)));
    for (const double far : {1e-100, 1e100})
        EXPECT_TRUE(Pinhole({{far, far, -far}, {0, 0, 0}}, 4, 4).ray(3, 0).valid()) << far;
}

} // namespace ovc
