// SPDX-License-Identifier: Apache-2.0
// Frames of scenes that move: those of a backend that is told what has moved are those of one that
// is built anew for each.
#include "host/render/stage.h"

#include "testscenes/catalog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace ovc {
namespace {

namespace fs = std::filesystem;

/// A ball that stays, and a tower of boxes of which one turns.
constexpr const char* kPov = R"(#version 3.7;
camera { location <0, 2, -6> look_at <0, .5, 0> rotate 20 * clock * y }
light_source { <5, 8, -6> rgb 1 - clock / 2 }
plane { y, 0 pigment { rgb <.7, .7, .6> } }
sphere { <1, 1, 2>, .7 pigment { rgb <1, .3, .2> } }
box { -.5, .5 rotate 90 * clock * y translate (.5 + .1 * (frame_number - initial_frame)) * y
      pigment { rgb <.2, .4, 1> } }
)";

/// A like scene with an object in two places, one of which turns, and a shape that rises.
constexpr const char* kPbrt = R"(LookAt 0 2 -8  0 .5 0  0 1 0
Camera "perspective" "float fov" [40]
WorldBegin
LightSource "point" "point from" [5 8 -6] "rgb I" [150 150 150]
Shape "trianglemesh" "point P" [-9 0 -9  9 0 -9  9 0 9  -9 0 9] "integer indices" [0 1 2 0 2 3]
ObjectBegin "ball"
  Shape "sphere" "float radius" [.7]
ObjectEnd
AttributeBegin
  Translate -1.5 1 0
  ObjectInstance "ball"
AttributeEnd
AttributeBegin
  Translate 1.5 1 0
  ActiveTransform EndTime
  Rotate 80 0 0 1
  Translate 0 .5 0
  ActiveTransform All
  Scale 1 .6 1
  ObjectInstance "ball"
AttributeEnd
AttributeBegin
  ActiveTransform EndTime
  Translate 0 2 0
  ActiveTransform All
  Shape "trianglemesh" "point P" [-.5 .1 0  .5 .1 0  0 .9 .2] "integer indices" [0 1 2]
AttributeEnd
)";

/// A box that comes in the last two frames, as a mesh before that of the ball.
constexpr const char* kAppears = R"(#version 3.7;
camera { location <0, 2, -6> look_at <0, .5, 0> }
light_source { <5, 8, -6> rgb 1 }
plane { y, 0 pigment { rgb <.7, .7, .6> } }
#if (clock > .5) box { <-2, 0, 0>, <-1, 1 + clock, 1> pigment { rgb <.9, .9, .2> } } #end
sphere { <1 - clock, 1, 2>, .7 pigment { rgb <1, .3, .2> } }
)";

constexpr uint32_t kFrames = 4;

class MovingScene : public testing::TestWithParam<const char*> {
protected:
    MovingScene() { fs::create_directories(folder_); }
    ~MovingScene() override { fs::remove_all(folder_); }

    /// Returns the scene's name, or that of the file that it is written to.
    std::string name() const {
        const std::string scene = GetParam();
        if (is_test_scene(scene))
            return scene;
        std::string path = folder_ / (scene == "pbrt" ? "scene.pbrt" : "scene.pov");
        std::ofstream(path) << (scene == "pbrt" ? kPbrt : scene == "pov" ? kPov : kAppears);
        return path;
    }

    /// Makes the scene at a moment, and a backend of it.
    struct Made {
        RenderJob job;
        std::optional<Scene> scene;
        std::unique_ptr<Backend> backend;
    };
    Made made_at(uint32_t frame) const {
        Made made;
        made.job.scene.scenes = {name()};
        made.job.scene.moment = Moment::of_frame(frame, 1, kFrames);
        made.job.backend.kind = BackendKind::TwoLevel;
        Result<Scene> scene = open_scene(made.job.scene, {});
        if (scene)
            made.scene = std::move(*scene);
        auto backend = scene ? make_backend(made.scene->soup, made.job.backend, {})
                             : Result<std::unique_ptr<Backend>>(scene.error());
        EXPECT_TRUE(backend) << (backend ? "" : backend.error().message);
        if (backend)
            made.backend = std::move(*backend);
        return made;
    }

    static std::vector<Hit> hits(const Scene& scene, Backend& backend) {
        constexpr uint32_t kSide = 80;
        const Pinhole pinhole(*scene.camera, {{kSide, kSide}, 0, 0, {kSide, kSide}});
        std::vector<Ray> rays;
        for (uint32_t i = 0; i < kSide * kSide; ++i)
            rays.push_back(pinhole.ray(i % kSide + 0.5, i / kSide + 0.5));
        std::vector<Hit> hits(rays.size());
        EXPECT_TRUE(backend.intersect(rays, {}, hits));
        return hits;
    }

    fs::path folder_ = fs::path(testing::TempDir()) / ("moving_" + std::to_string(getpid()));
};

TEST_P(MovingScene, HasTheFramesOfOneThatIsBuiltAnew) {
    Made first = made_at(1);
    ASSERT_TRUE(first.backend);
    ScenePictures pictures({}, LogSink());
    Stage stage(first.job, *first.scene, pictures, std::move(first.backend), first.job.backend);
    std::vector<Hit> before;
    for (uint32_t frame = 1; frame <= kFrames; ++frame) {
        ASSERT_TRUE(stage.go_to(Moment::of_frame(frame, 1, kFrames)));
        const std::vector<Hit> updated = hits(*first.scene, stage.backend());
        Made anew = made_at(frame);
        ASSERT_TRUE(anew.backend);
        const std::vector<Hit> expected = hits(*anew.scene, *anew.backend);
        ASSERT_TRUE(std::ranges::equal(updated, expected, [](const Hit& a, const Hit& b) {
            return a.id == b.id && a.t == b.t && a.u == b.u && a.v == b.v;
        })) << frame;
        EXPECT_FALSE(std::ranges::equal(before, expected, {}, &Hit::t, &Hit::t)) << "all stays";
        before = expected;
    }
    if (GetParam() != std::string("pov that gets a mesh")) {
        EXPECT_EQ(stage.statistics().updates, kFrames - 1) << "it was not built anew";
    }
    EXPECT_EQ(stage.statistics().nearest_rays, kFrames * before.size());
}

/// A file of the scene is mapped into memory anew for each moment.
TEST(Stage, KeepsWhatIsMappedIntoMemory) {
    const fs::path folder = fs::path(testing::TempDir()) / ("mapped_" + std::to_string(getpid()));
    fs::create_directories(folder);
    ASSERT_TRUE(save(*make_test_scene("sphere-3"), folder / "ball.ovc"));
    RenderJob job;
    job.scene.scenes = {folder / "ball.ovc", "cloth"};
    job.scene.moment = Moment::of_frame(1, 1, 3);
    job.backend.kind = BackendKind::CpuKdTree;
    Result<Scene> scene = open_scene(job.scene, {});
    ASSERT_TRUE(scene);
    const Triangle first = scene->soup.triangle({0, 7});
    ScenePictures pictures({}, LogSink());
    Stage stage(job, *scene, pictures, make_cpu_backend(scene->soup), job.backend);
    for (const uint32_t frame : {2u, 3u}) {
        ASSERT_TRUE(stage.go_to(Moment::of_frame(frame, 1, 3)));
        EXPECT_EQ(scene->soup.triangle({0, 7}), first);
    }
    fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Scenes, MovingScene,
                         testing::Values("cloth", "grass-in-wind", "pov", "pbrt",
                                         "pov that gets a mesh"),
                         [](const auto& scene) {
                             std::string name = scene.param;
                             std::ranges::replace(name, '-', '_');
                             std::ranges::replace(name, ' ', '_');
                             return name;
                         });

} // namespace
} // namespace ovc
