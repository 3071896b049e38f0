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

/// The same with an object in two places, one of which turns, and a shape that rises.
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

class MovingScene : public testing::TestWithParam<const char*> {
protected:
    MovingScene() { fs::create_directories(folder_); }
    ~MovingScene() override { fs::remove_all(folder_); }

    /// Returns the scene's name, or that of the file that it is written to.
    std::string name() const {
        const std::string scene = GetParam();
        if (is_test_scene(scene))
            return scene;
        std::string path = folder_ / ("scene." + scene);
        std::ofstream(path) << (scene == "pov" ? kPov : kPbrt);
        return path;
    }

    /// Returns the scene at each moment, as go_to() leaves it, from a backend of that kind.
    std::vector<std::vector<Hit>> hits_of(BackendKind kind, ovc_statistics* told = nullptr) {
        RenderJob job;
        job.scene.scenes = {name()};
        job.scene.moment = Moment::of_frame(1, 1, 4);
        job.backend.kind = kind;
        Result<Scene> scene = open_scene(job.scene, {});
        auto backend = scene ? make_backend(scene->soup, job.backend, {})
                             : Result<std::unique_ptr<Backend>>(scene.error());
        EXPECT_TRUE(backend) << (backend ? "" : backend.error().message);
        if (!backend)
            return {};
        Stage stage(job, *scene, std::move(*backend), job.backend);
        std::vector<std::vector<Hit>> all;
        for (uint32_t frame = 1; frame <= 4; ++frame) {
            EXPECT_TRUE(stage.go_to(Moment::of_frame(frame, 1, 4)));
            all.push_back(hits(*scene, stage.backend()));
        }
        if (told)
            *told = stage.backend().statistics();
        return all;
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

    fs::path folder_ = fs::path(testing::TempDir()) / "overcast-moving-scene";
};

TEST_P(MovingScene, HasTheFramesOfOneThatIsBuiltAnew) {
    ovc_statistics told{};
    const auto updated = hits_of(BackendKind::TwoLevel, &told);
    const auto anew = hits_of(BackendKind::CpuKdTree);
    ASSERT_EQ(updated.size(), 4u);
    ASSERT_EQ(anew.size(), 4u);
    for (size_t frame = 0; frame < 4; ++frame)
        for (size_t i = 0; i < anew[frame].size(); ++i) {
            ASSERT_EQ(updated[frame][i].id, anew[frame][i].id) << frame << " " << i;
            ASSERT_EQ(updated[frame][i].t, anew[frame][i].t) << frame << " " << i;
        }
    EXPECT_EQ(told.updates, 3u) << "it was not built anew";
    size_t moved = 0;
    for (size_t i = 0; i < anew[0].size(); ++i)
        moved += anew[1][i].t != anew[2][i].t;
    EXPECT_GT(moved, 20u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, MovingScene,
                         testing::Values("cloth", "grass-in-wind", "pov", "pbrt"),
                         [](const auto& scene) {
                             std::string name = scene.param;
                             std::ranges::replace(name, '-', '_');
                             return name;
                         });

} // namespace
} // namespace ovc
