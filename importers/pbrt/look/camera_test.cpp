// SPDX-License-Identifier: Apache-2.0
// The part of a picture that Film asks for is the same view through a smaller window.
#include "importers/test_files.h"

namespace ovc {
namespace {

Scene scene_of(const std::string& film, const std::string& camera) {
    const TestFolder folder;
    Result<Scene> scene =
        load(folder.write("a.pbrt", "Film \"rgb\" \"integer xresolution\" 100 \"integer "
                                    "yresolution\" 50 " +
                                        film + "\nCamera " + camera + "\nShape \"sphere\"\n"));
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
    return scene ? std::move(*scene) : Scene();
}

TEST(PbrtFilm, APartOfThePictureIsTheSameView) {
    for (const char* camera : {"\"perspective\" \"float fov\" 40", "\"orthographic\""})
        for (const char* film :
             {"\"float cropwindow\" [0.25 0.55 0.1 0.9]", "\"integer pixelbounds\" [25 55 5 45]"}) {
            const Scene whole = scene_of("", camera), part = scene_of(film, camera);
            EXPECT_FALSE(whole.part);
            ASSERT_TRUE(part.size && part.part && part.camera && whole.camera);
            EXPECT_EQ(part.size->width, 100u);
            EXPECT_EQ(part.part->picture.height, 50u);
            EXPECT_EQ(part.part->left, 25u);
            EXPECT_EQ(part.part->top, 5u);
            EXPECT_EQ(part.part->size.width, 30u) << "0.55 x 100 is 55 in floats";
            EXPECT_EQ(part.part->size.height, 40u);
            EXPECT_EQ(part.camera->eye, whole.camera->eye);
            EXPECT_EQ(part.camera->window->direction, whole.camera->window->direction);
            EXPECT_EQ(part.camera->window->right, whole.camera->window->right);
            EXPECT_EQ(part.camera->window->up, whole.camera->window->up);
        }
}

/// pbrt's angle of view is that of the shorter side, whatever the picture's shape.
TEST(PbrtFilm, AWindowKnowsThePictureThatItIsFor) {
    EXPECT_EQ(scene_of("", "\"perspective\"").camera->window->shape, 2);
    EXPECT_EQ(scene_of("\"float cropwindow\" [0 1 0 0.5]", "\"perspective\"").camera->window->shape,
              2);
    for (const char* own : {"\"float frameaspectratio\" 1", "\"float screenwindow\" [-1 1 -1 1]"})
        EXPECT_EQ(scene_of("", std::string("\"perspective\" ") + own).camera->window->shape, 0);
}

TEST(PbrtFilm, ASphericalCameraSeesAllAround) {
    for (const char* type : {"\"environment\"", "\"spherical\""})
        for (const bool mirrored : {false, true}) {
            const Scene scene = scene_of(mirrored ? "Scale -1 1 1" : "", type);
            ASSERT_TRUE(scene.camera && scene.camera->window);
            const ImageWindow& window = *scene.camera->window;
            EXPECT_EQ(window.bend, ImageWindow::Bend::Spherical);
            EXPECT_EQ(window.angle, 360);
            EXPECT_EQ(window.vertical_angle, 180);
            const double x = mirrored ? 1 : -1;
            EXPECT_EQ(window.direction, dvec3(x, 0, 0));
            // The host turns the other way where these are left-handed.
            EXPECT_EQ(window.right, dvec3(0, 0, mirrored ? -1 : 1));
            EXPECT_EQ(window.up, dvec3(0, mirrored ? 1 : -1, 0));
            EXPECT_EQ(scene.camera->up, dvec3(0, 1, 0));
        }
}

} // namespace
} // namespace ovc
