// SPDX-License-Identifier: Apache-2.0
// The part of a picture that Film asks for is the same view through a smaller window.
#include "importers/test_files.h"

#include <array>

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

/// Returns the place where a pixel's corner lies: its eye and its direction.
std::array<dvec3, 2> through(const Camera& camera, const dvec2& share) {
    const ImageWindow& w = *camera.window;
    const dvec3 across = (share.x - 0.5) * w.right + (0.5 - share.y) * w.up;
    return {camera.eye + (w.orthographic ? across : dvec3(0)),
            w.direction + (w.orthographic ? dvec3(0) : across)};
}

TEST(PbrtFilm, APartOfThePictureIsTheSameView) {
    for (const char* camera : {"\"perspective\" \"float fov\" 40", "\"orthographic\""})
        for (const char* film :
             {"\"float cropwindow\" [0.25 0.5 0.1 0.9]", "\"integer pixelbounds\" [25 50 5 45]"}) {
            const Scene whole = scene_of("", camera), part = scene_of(film, camera);
            EXPECT_EQ(whole.size->width, 100u);
            ASSERT_TRUE(part.size && part.camera && whole.camera);
            EXPECT_EQ(part.size->width, 25u);
            EXPECT_EQ(part.size->height, 40u);
            for (const dvec2 at : {dvec2(0, 0), dvec2(1, 0), dvec2(0.25, 1)}) {
                const auto expected =
                    through(*whole.camera, dvec2(0.25, 0.1) + at * dvec2(0.25, 0.8));
                const auto found = through(*part.camera, at);
                for (size_t i = 0; i < 2; ++i)
                    EXPECT_LT(glm::length(found[i] - expected[i]), 1e-12) << camera << film;
            }
        }
}

/// pbrt's angle of view is that of the shorter side, whatever the picture's shape.
TEST(PbrtFilm, AWindowKnowsThePictureThatItIsFor) {
    EXPECT_EQ(scene_of("", "\"perspective\"").camera->window->shape, 2);
    EXPECT_EQ(scene_of("\"float cropwindow\" [0 1 0 0.5]", "\"perspective\"").camera->window->shape,
              4);
    for (const char* own : {"\"float frameaspectratio\" 1", "\"float screenwindow\" [-1 1 -1 1]"})
        EXPECT_EQ(scene_of("", std::string("\"perspective\" ") + own).camera->window->shape, 0);
}

} // namespace
} // namespace ovc
