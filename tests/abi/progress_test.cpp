// SPDX-License-Identifier: Apache-2.0
// Tests the progress of a commit, and that a cancelled commit ends at once, at any stage, without a
// trace.
#include "core/system/stopwatch.h"
#include "tests/abi/abi_scene.h"
#include "testscenes/catalog.h"

#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <set>
#include <thread>

namespace ovc {
namespace {

using test::api;
using test::sized;

/// Listens to a commit, and cancels it when the progress is `stop_at` or more.
struct Listener {
    double stop_at = 2;
    double last = -1;
    int calls = 0;
    bool went_back = false;
    std::set<std::string> stages;
    std::atomic<bool> inside{false};
    std::atomic<bool> two_at_once{false};
    Stopwatch since_stop;

    static int listen(void* user, double done, const char* stage) {
        auto& self = *static_cast<Listener*>(user);
        self.two_at_once = self.two_at_once || self.inside.exchange(true);
        self.went_back = self.went_back || done < self.last || done > 1;
        self.last = done;
        ++self.calls;
        self.stages.insert(stage);
        if (done >= self.stop_at)
            self.since_stop = Stopwatch();
        self.inside = false;
        return done >= self.stop_at;
    }

    ovc_scene_config config() {
        auto config = sized<ovc_scene_config>();
        config.progress = listen;
        config.progress_user = this;
        return config;
    }
};

class Commit : public test::DeviceTest {
protected:
    /// Returns the nearest hits along a row of rays through the middle.
    std::vector<ovc_hit> hits(ovc_scene scene) const {
        std::vector<ovc_ray> rays;
        for (int i = 0; i < 500; ++i)
            rays.push_back({{-30 + 0.12 * i, 0.1, 50}, 0, {0.01, 0.02, -1}, HUGE_VAL});
        std::vector<ovc_hit> found(rays.size());
        EXPECT_EQ(api().intersect(scene, rays.data(), rays.size(), found.data(), nullptr), OVC_OK)
            << error();
        return found;
    }
};

TEST_F(Commit, TellsHowFarItIs) {
    const Result<Scene> scene = make_test_scene("knot");
    ASSERT_TRUE(scene);
    Listener listener;
    const auto made = test::add_soup(device, scene->soup, listener.config());
    ASSERT_EQ(api().commit(made.get()), OVC_OK) << error();
    EXPECT_FALSE(listener.went_back);
    EXPECT_FALSE(listener.two_at_once);
    EXPECT_EQ(listener.last, 1);
    EXPECT_THAT(listener.stages,
                testing::IsSupersetOf({"triangles", "level 1", "level 2", "done"}));
}

TEST_F(Commit, CancelledAnywhereLeavesASceneThatCanBeCommittedAgain) {
    const Result<Scene> scene = make_test_scene("knot");
    ASSERT_TRUE(scene);
    const auto reference = test::add_soup(device, scene->soup, sized<ovc_scene_config>());
    ASSERT_EQ(api().commit(reference.get()), OVC_OK);
    const auto expected = hits(reference.get());
    Listener listener;
    const auto made = test::add_soup(device, scene->soup, listener.config());
    // At 1, everything is built, and the commit is given up at the very end.
    for (const double stop_at : {0.0, 0.05, 0.15, 0.3, 0.5, 0.7, 0.9, 0.96, 1.0}) {
        listener.stop_at = stop_at;
        listener.last = -1;
        ASSERT_EQ(api().commit(made.get()), OVC_ERROR_CANCELLED) << stop_at;
        EXPECT_EQ(error(), "commit: cancelled by ovc_scene_config.progress");
        EXPECT_GE(listener.last, stop_at);
        ovc_hit hit;
        const ovc_ray ray{{0, 0, 9}, 0, {0, 0, -1}, HUGE_VAL};
        EXPECT_EQ(api().intersect(made.get(), &ray, 1, &hit, nullptr), OVC_ERROR_INVALID_STATE);
    }
    listener.stop_at = 2;
    listener.last = -1;
    ASSERT_EQ(api().commit(made.get()), OVC_OK) << error();
    const auto found = hits(made.get());
    for (size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].prim, expected[i].prim) << i;
        EXPECT_EQ(found[i].t, expected[i].t) << i;
    }
}

TEST_F(Commit, AMeshMayBeAddedAfterACancelledOne) {
    Listener listener;
    listener.stop_at = 0;
    const Result<Scene> scene = make_test_scene("box");
    ASSERT_TRUE(scene);
    const auto made = test::add_soup(device, scene->soup, listener.config());
    ASSERT_EQ(api().commit(made.get()), OVC_ERROR_CANCELLED);
    const float corners[9] = {0, 0, 90, 1, 0, 90, 0, 1, 90};
    auto mesh = sized<ovc_mesh>();
    mesh.positions = corners;
    mesh.vertex_count = 3;
    uint32_t id = 0;
    ASSERT_EQ(api().add_mesh(made.get(), &mesh, &id), OVC_OK) << error();
    listener.stop_at = 2;
    ASSERT_EQ(api().commit(made.get()), OVC_OK) << error();
    ovc_hit hit;
    const ovc_ray ray{{0.2, 0.2, 99}, 0, {0, 0, -1}, HUGE_VAL};
    ASSERT_EQ(api().intersect(made.get(), &ray, 1, &hit, nullptr), OVC_OK);
    EXPECT_EQ(hit.mesh, id);
    EXPECT_EQ(hit.t, 9);
}

TEST_F(Commit, CancelsAPlanToo) {
    const Result<Scene> scene = make_test_scene("knot");
    ASSERT_TRUE(scene);
    Listener listener;
    listener.stop_at = 0;
    const auto made = test::add_soup(device, scene->soup, listener.config());
    auto plan = sized<ovc_plan>();
    EXPECT_EQ(api().plan(made.get(), &plan), OVC_ERROR_CANCELLED);
    EXPECT_EQ(error(), "plan: cancelled by ovc_scene_config.progress");
}

TEST_F(Commit, TakesTheConfigOfAnEarlierHeader) {
    auto config = sized<ovc_scene_config>();
    config.struct_size = offsetof(ovc_scene_config, progress);
    // This field is beyond the struct's end, so it must not be read.
    config.progress = [](void*, double, const char*) { return 1; };
    const auto made = test::add_soup(device, {}, config);
    ASSERT_TRUE(made) << error();
    EXPECT_EQ(api().commit(made.get()), OVC_OK) << error();
    auto statistics = sized<ovc_statistics>();
    statistics.struct_size = offsetof(ovc_statistics, host_bytes);
    statistics.host_bytes = 77;
    EXPECT_EQ(api().statistics(made.get(), &statistics), OVC_OK) << error();
    EXPECT_EQ(statistics.host_bytes, 77u);
}

/// A commit ends within a tenth of a second on an idle machine. The test allows for a busy one.
TEST_F(Commit, AnswersSoonWhereverItIsCancelled) {
    const Result<Scene> scene = make_test_scene("dragons-10");
    ASSERT_TRUE(scene);
    Listener listener;
    const auto made = test::add_soup(device, scene->soup, listener.config());
    double longest = 0;
    for (double stop_at = 0.02; stop_at < 1; stop_at += 0.16) {
        listener.stop_at = stop_at;
        listener.last = -1;
        ASSERT_EQ(api().commit(made.get()), OVC_ERROR_CANCELLED);
        const double seconds = listener.since_stop.seconds();
        std::printf("cancelled at %.2f: %.3f s\n", listener.last, seconds);
        longest = std::max(longest, seconds);
    }
    EXPECT_LT(longest, 1.0);
}

} // namespace
} // namespace ovc
