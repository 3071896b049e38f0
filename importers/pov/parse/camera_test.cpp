// SPDX-License-Identifier: Apache-2.0
// Tests the cameras of a scene.
#include "importers/pov/test_parse.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace ovc {
namespace {

TEST(PovScene, FocalBlurIsALens) {
    const std::string camera = "sphere { 0, 1 } camera { location -5*z direction 2*z right 4*x "
                               "aperture 0.5 focal_point <7, 1, 1> ";
    const Result<Scene> scene = parsed_scene(camera + "blur_samples 4, 30 }");
    ASSERT_TRUE(scene && scene->camera->lens);
    EXPECT_EQ(*scene->camera->lens, (Lens{dvec3(0.125, 0, 0), dvec3(0, 0.125, 0), 3}));
    EXPECT_EQ(scene->samples, 30u);
    EXPECT_FALSE(parsed_scene(camera + "}")->camera->lens) << "as povray, without blur_samples";
}

TEST(PovScene, MeshCamerasHaveFaces) {
    const std::string mesh =
        "#declare M = mesh { triangle { 0, x, y } triangle { 0, y, z uv_vectors <0, 0>, <0, 1>, "
        "<1, 1> } } sphere { 0, 1 }";
    const Result<Scene> scene =
        parsed_scene(mesh + "camera { mesh_camera { 2 1 mesh { M translate 5*x } "
                            "mesh { M } } location -0.5*z direction -z }");
    ASSERT_TRUE(scene && scene->faces) << scene.error().message;
    EXPECT_TRUE(scene->camera->by_faces);
    EXPECT_EQ(scene->samples, 2u);
    EXPECT_EQ(scene->faces->order, FaceCamera::Order::OneAfterAnother);
    EXPECT_EQ(scene->faces->ahead, -0.5);
    EXPECT_TRUE(scene->faces->backwards);
    ASSERT_EQ(scene->faces->meshes.size(), 2u);
    EXPECT_EQ(scene->faces->meshes[0].corners[0],
              (std::array<dvec3, 3>{dvec3(5, 0, 0), dvec3(6, 0, 0), dvec3(5, 1, 0)}));
    EXPECT_TRUE(scene->faces->meshes[0].uv.empty() && scene->faces->meshes[0].normals.empty());
    const Result<Scene> baking =
        parsed_scene(mesh + "camera { mesh_camera { 1 3 mesh { M } smooth } location 0.01*z }");
    EXPECT_EQ(baking->faces->meshes[0].uv[1],
              (std::array<vec2, 3>{vec2(0, 0), vec2(0, 1), vec2(1, 1)}));
    EXPECT_EQ(baking->faces->meshes[0].normals[0][2], vec3(0, 0, -1));
    EXPECT_FALSE(parsed_scene("camera { mesh_camera { 1 0 } }"));
}

/// povray 3.7.0.10 shows this much of a plane at z = 0.
TEST(PovScene, OrthographicCamerasShowAsMuchAsPovRay) {
    const struct {
        const char* camera;
        double width, height;
    } cases[] = {
        {"location -z*10 look_at 0", 13.3, 10},
        {"location -z*10 look_at 0 angle 40 angle 0", 13.3, 10},
        {"location -z*20 look_at 0", 26.6, 20},
        {"location -z*10", 14.63, 11},
        {"location -z*10 direction 2*z look_at 0", 6.65, 5},
        {"location -z*10 look_at 0 right 3*x up 2*y", 3, 2},
        {"location -z*10 look_at 0 direction 2*z right 3*x", 3, 1},
        {"location -z*10 look_at 0 angle 40", 7.279, 5.473},
        {"location -z*10 right 3*x up 2*y look_at 0 angle 40", 7.279, 4.853},
        {"location -z*10 angle 40", 8.007, 6.021},
    };
    for (const auto& c : cases) {
        const Result<Scene> scene =
            parsed_scene(std::string("sphere { 0, 1 } camera { orthographic ") + c.camera + " }");
        ASSERT_TRUE(scene) << scene.error().message;
        EXPECT_NEAR(glm::length(scene->camera->window->right), c.width, 0.001) << c.camera;
        EXPECT_NEAR(glm::length(scene->camera->window->up), c.height, 0.001) << c.camera;
    }
}

} // namespace
} // namespace ovc
