// SPDX-License-Identifier: Apache-2.0
// Compares calls that take single rays and rays in floats, bit by bit, with intersect() and
// occluded() on batches of doubles.
#include "kdtree/test_soups.h"
#include "tests/abi/abi_scene.h"

#include <gmock/gmock.h>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <cstring>
#include <thread>

namespace ovc {
namespace {

using test::api;
using test::as_abi;
using test::sized;
using Clock = std::chrono::steady_clock;

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

class Calls : public test::DeviceTest {
protected:
    test::AbiScene committed(const Soup& soup) {
        auto config = sized<ovc_scene_config>();
        config.leaf_triangles = 300;
        test::AbiScene scene = test::add_soup(device, soup, config);
        EXPECT_TRUE(scene) << error();
        EXPECT_EQ(api().commit(scene.get()), OVC_OK) << error();
        return scene;
    }

    std::vector<ovc_hit> nearest(const test::AbiScene& scene, const std::vector<Ray>& rays,
                                 const ovc_query* query = nullptr) {
        std::vector<ovc_hit> hits(rays.size());
        EXPECT_EQ(api().intersect(scene.get(), as_abi(rays), rays.size(), hits.data(), query),
                  OVC_OK)
            << error();
        return hits;
    }
    std::vector<uint8_t> occlusion(const test::AbiScene& scene, const std::vector<Ray>& rays,
                                   const ovc_query* query = nullptr) {
        std::vector<uint8_t> occluded(rays.size());
        EXPECT_EQ(api().occluded(scene.get(), as_abi(rays), rays.size(), occluded.data(), query),
                  OVC_OK)
            << error();
        return occluded;
    }
};

/// Calls body(i) for i in [0, count), shared out among so many threads of the host.
template <class Body>
void on_threads(size_t threads, size_t count, Body&& body) {
    std::vector<std::thread> running;
    for (size_t k = 0; k < threads; ++k)
        running.emplace_back([&, k] {
            for (size_t i = k; i < count; i += threads)
                body(i);
        });
    for (std::thread& thread : running)
        thread.join();
}

std::vector<ovc_triangle> first_hits(const std::vector<ovc_hit>& hits) {
    std::vector<ovc_triangle> ids;
    for (const ovc_hit& hit : hits)
        ids.push_back({hit.mesh, hit.prim});
    return ids;
}

TEST_F(Calls, SingleRaysFromManyThreadsAreAnsweredAsBatchesAre) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        SCOPED_TRACE(name);
        const auto scene = committed(soup);
        const auto rays = test::unpleasant_rays(soup, 7, 1500);
        const auto expected = nearest(scene, rays);
        const auto expected_shadows = occlusion(scene, rays);
        std::vector<ovc_hit> hits(rays.size());
        std::vector<uint8_t> shadows(rays.size(), 2);
        std::atomic<size_t> failed{0};
        on_threads(16, rays.size(), [&](size_t i) {
            failed += api().intersect1(scene.get(), as_abi(rays) + i, &hits[i], nullptr) != OVC_OK;
            failed +=
                api().occluded1(scene.get(), as_abi(rays) + i, &shadows[i], nullptr) != OVC_OK;
        });
        EXPECT_EQ(failed, 0u) << error();
        EXPECT_TRUE(same_bits(hits, expected));
        EXPECT_EQ(shadows, expected_shadows);

        auto statistics = sized<ovc_statistics>();
        ASSERT_EQ(api().statistics(scene.get(), &statistics), OVC_OK);
        EXPECT_EQ(statistics.single_rays, 2 * rays.size());
        EXPECT_EQ(statistics.nearest_rays, 2 * rays.size());
        EXPECT_EQ(statistics.occlusion_rays, 2 * rays.size());
        EXPECT_EQ(statistics.invalid_rays % 4, 0u);
    }
}

/// Asks until trials have sent some rays both ways, beside batches that take their turns.
TEST_F(Calls, SingleRaysHaveTheSameBitsWhicheverWayTheyGo) {
    const Soup soup = test::closed_grid(40);
    const auto scene = committed(soup);
    const auto rays = test::unpleasant_rays(soup, 12, 4000);
    const auto expected = nearest(scene, rays);
    const auto expected_shadows = occlusion(scene, rays);
    std::atomic<size_t> wrong{0}, asked{0};
    std::atomic<bool> enough{false};
    std::thread batches([&] {
        while (!enough) {
            wrong += !same_bits(nearest(scene, rays), expected);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    });
    auto statistics = sized<ovc_statistics>();
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (statistics.gathered_rays < 20 && std::chrono::steady_clock::now() < end) {
        on_threads(64, 6400, [&](size_t k) {
            const size_t i = k % rays.size();
            ovc_hit hit{};
            uint8_t shadow = 2;
            wrong += api().intersect1(scene.get(), as_abi(rays) + i, &hit, nullptr) != OVC_OK ||
                     std::memcmp(&hit, &expected[i], sizeof(hit)) != 0;
            wrong += api().occluded1(scene.get(), as_abi(rays) + i, &shadow, nullptr) != OVC_OK ||
                     shadow != expected_shadows[i];
            asked += 2;
        });
        ASSERT_EQ(api().statistics(scene.get(), &statistics), OVC_OK);
    }
    enough = true;
    batches.join();
    EXPECT_EQ(wrong, 0u);
    EXPECT_GE(statistics.gathered_rays, 20u);
    EXPECT_EQ(statistics.single_rays, asked) << "none is lost";
    EXPECT_LT(statistics.gathered_rays, statistics.single_rays);
}

/// Calls ask(first, count) for batches of 1 to 64 rays, which are all of them.
template <class Ask>
void in_small_batches(size_t rays, Ask&& ask) {
    for (size_t first = 0, size = 1; first < rays; first += size, size = size % 64 + 1)
        ask(first, std::min(size, rays - first));
}

TEST_F(Calls, SmallBatchesAreAnsweredAsLargeOnesAre) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        SCOPED_TRACE(name);
        const auto scene = committed(soup);
        const auto rays = test::unpleasant_rays(soup, 17, 1500);
        const auto first = nearest(scene, rays);
        const auto skip = first_hits(first);
        for (const bool skips : {false, true})
            for (const bool goes_on : {false, true}) {
                auto query = sized<ovc_query>();
                query.skip = skips ? skip.data() : nullptr;
                query.after = goes_on ? first.data() : nullptr;
                const auto expected = nearest(scene, rays, &query);
                const auto expected_shadows = occlusion(scene, rays, &query);
                std::vector<ovc_hit> hits = first; // a query may be answered in place of `after`
                std::vector<uint8_t> shadows(rays.size(), 2);
                in_small_batches(rays.size(), [&](size_t i, size_t count) {
                    auto part = sized<ovc_query>();
                    part.skip = skips ? &skip[i] : nullptr;
                    part.after = goes_on ? &first[i] : nullptr;
                    ASSERT_EQ(
                        api().occluded(scene.get(), as_abi(rays) + i, count, &shadows[i], &part),
                        OVC_OK);
                    part.after = goes_on ? &hits[i] : nullptr;
                    ASSERT_EQ(
                        api().intersect(scene.get(), as_abi(rays) + i, count, &hits[i], &part),
                        OVC_OK);
                });
                EXPECT_TRUE(same_bits(hits, expected)) << skips << goes_on;
                EXPECT_EQ(shadows, expected_shadows) << skips << goes_on;
            }
        auto statistics = sized<ovc_statistics>();
        ASSERT_EQ(api().statistics(scene.get(), &statistics), OVC_OK);
        EXPECT_EQ(statistics.nearest_rays, 9 * rays.size());
        EXPECT_EQ(statistics.occlusion_rays, 8 * rays.size());
        EXPECT_EQ(statistics.single_rays, 0u);
    }
}

/// Asks until trials have sent some batches both ways: those of the kernel have a pass each.
TEST_F(Calls, SmallBatchesHaveTheSameBitsWhicheverWayTheyGo) {
    constexpr size_t kRays = 500; // of a batch
    const Soup soup = test::closed_grid(40);
    const auto scene = committed(soup);
    const auto rays = test::unpleasant_rays(soup, 22, 8 * kRays);
    const auto expected = nearest(scene, rays);
    const auto expected_shadows = occlusion(scene, rays);
    std::atomic<size_t> wrong{0};
    const auto ask = [&](size_t k) {
        const size_t at = k / 2 % 8 * kRays;
        std::vector<ovc_hit> hits(kRays);
        std::vector<uint8_t> shadows(kRays, 2);
        wrong +=
            (k % 2 ? api().occluded(scene.get(), as_abi(rays) + at, kRays, shadows.data(), nullptr)
                   : api().intersect(scene.get(), as_abi(rays) + at, kRays, hits.data(),
                                     nullptr)) != OVC_OK;
        wrong += k % 2 ? std::memcmp(shadows.data(), &expected_shadows[at], kRays) != 0
                       : std::memcmp(hits.data(), &expected[at], kRays * sizeof(ovc_hit)) != 0;
    };
    const uint64_t passes = test::statistics(scene).passes;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    uint64_t asked = 0, by_kernel = 0;
    while (asked < by_kernel + 20 && std::chrono::steady_clock::now() < end) {
        ask(asked++);
        by_kernel = test::statistics(scene).passes - passes;
    }
    EXPECT_GE(asked, by_kernel + 20);
    EXPECT_GT(by_kernel, 60u) << "the first are the kernel's";
    on_threads(8, 400, ask);
    EXPECT_EQ(wrong, 0u);
}

/// A call that has the scene's turn, and keeps it as long as this lives, or for ten seconds.
class LongCall {
public:
    LongCall(ovc_scene scene, const std::vector<Ray>& rays) {
        query_.progress_user = this;
        query_.progress = [](void* user, double, const char*) {
            LongCall& self = *static_cast<LongCall*>(user);
            self.has_turn_ = true;
            while (!self.goes_on_ && Clock::now() < self.end_)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            return 0;
        };
        thread_ = std::thread([this, scene, &rays] {
            std::vector<ovc_hit> hits(rays.size());
            EXPECT_EQ(api().intersect(scene, as_abi(rays), rays.size(), hits.data(), &query_),
                      OVC_OK);
            is_over_ = true;
        });
        while (!has_turn_)
            std::this_thread::yield();
    }
    ~LongCall() {
        goes_on_ = true;
        thread_.join();
    }
    bool is_over() const { return is_over_; }

private:
    ovc_query query_ = sized<ovc_query>();
    const Clock::time_point end_ = Clock::now() + std::chrono::seconds(10);
    std::atomic<bool> has_turn_{false}, goes_on_{false}, is_over_{false};
    std::thread thread_;
};

TEST_F(Calls, ASmallBatchDoesNotWaitForALargeOne) {
    const Soup soup = test::closed_grid(40);
    const auto scene = committed(soup);
    const auto rays = test::unpleasant_rays(soup, 18, 100'000);
    const auto expected = nearest(scene, rays);
    const std::vector<Ray> few(rays.begin(), rays.begin() + 64);
    const LongCall large(scene.get(), rays);
    EXPECT_TRUE(same_bits(nearest(scene, few), {expected.begin(), expected.begin() + 64}));
    EXPECT_FALSE(large.is_over());
}

/// Threads ask while another call has the turn, and then all at once.
TEST_F(Calls, BatchesOfManyThreadsShareTheirPasses) {
    constexpr size_t kThreads = 16, kRays = 300; // a thread's
    const Soup soup = test::closed_grid(40);
    const auto scene = committed(soup);
    const auto rays = test::unpleasant_rays(soup, 19, 2 * kThreads * kRays);
    const auto first = nearest(scene, rays);
    const auto skip = first_hits(first);
    auto skips = sized<ovc_query>(), goes_on = sized<ovc_query>();
    skips.skip = skip.data();
    goes_on.after = first.data();
    const std::vector<ovc_hit> expected[] = {first, nearest(scene, rays, &skips),
                                             nearest(scene, rays, &goes_on)};
    const std::vector<uint8_t> expected_shadows[] = {
        occlusion(scene, rays), occlusion(scene, rays, &skips), occlusion(scene, rays, &goes_on)};
    auto before = sized<ovc_statistics>(), after = before;
    std::atomic<size_t> wrong{0};
    std::vector<std::thread> threads;
    ASSERT_EQ(api().statistics(scene.get(), &before), OVC_OK);
    {
        LongCall large(scene.get(), rays);
        for (size_t t = 0; t < kThreads; ++t)
            threads.emplace_back([&, t] {
                const size_t kind = t % 3, at = t * kRays;
                auto query = sized<ovc_query>();
                query.skip = kind == 1 ? &skip[at] : nullptr;
                query.after = kind == 2 ? &first[at] : nullptr;
                std::vector<ovc_hit> hits(kRays);
                std::vector<uint8_t> shadows(kRays);
                const bool any_hit = t % 2 == 1;
                const ovc_result done = any_hit ? api().occluded(scene.get(), as_abi(rays) + at,
                                                                 kRays, shadows.data(), &query)
                                                : api().intersect(scene.get(), as_abi(rays) + at,
                                                                  kRays, hits.data(), &query);
                wrong += done != OVC_OK;
                wrong += any_hit
                             ? std::memcmp(shadows.data(), &expected_shadows[kind][at], kRays) != 0
                             : std::memcmp(hits.data(), &expected[kind][at],
                                           kRays * sizeof(ovc_hit)) != 0;
            });
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, 0u);
    ASSERT_EQ(api().statistics(scene.get(), &after), OVC_OK);
    EXPECT_EQ(after.occlusion_rays - before.occlusion_rays, kThreads / 2 * kRays);
    EXPECT_LT(after.passes - before.passes, kThreads);
}

TEST_F(Calls, BatchesOfManyThreadsAreRefusedEachWithItsMessage) {
    const Soup soup = test::closed_grid(40);
    const auto scene = committed(soup);
    const auto rays = test::unpleasant_rays(soup, 20, 300);
    ASSERT_EQ(api().remove_mesh(scene.get(), 0), OVC_OK);
    on_threads(8, 8, [&](size_t) {
        std::vector<ovc_hit> hits(rays.size());
        EXPECT_EQ(api().intersect(scene.get(), as_abi(rays), rays.size(), hits.data(), nullptr),
                  OVC_ERROR_INVALID_STATE);
        EXPECT_THAT(error(), testing::HasSubstr("intersect: the scene is not committed yet"));
    });
}

TEST_F(Calls, RaysAreCountedFromTheCommitThatBuilds) {
    const Soup soup = test::closed_grid(40);
    const auto scene = committed(soup);
    const auto rays = test::unpleasant_rays(soup, 21, 10);
    nearest(scene, rays);
    ovc_hit hit{};
    ASSERT_EQ(api().intersect1(scene.get(), as_abi(rays), &hit, nullptr), OVC_OK);
    const double aside[12] = {1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0};
    const ovc_instance instance{sizeof(ovc_instance), 0, 0, aside};
    ASSERT_EQ(api().add_instance(scene.get(), &instance, nullptr), OVC_OK) << error();
    ASSERT_EQ(api().commit(scene.get()), OVC_OK) << error();
    auto statistics = sized<ovc_statistics>();
    ASSERT_EQ(api().statistics(scene.get(), &statistics), OVC_OK);
    ASSERT_EQ(statistics.updates, 0u) << "it is built anew";
    EXPECT_EQ(statistics.nearest_rays, 0u);
    EXPECT_EQ(statistics.single_rays, 0u);
}

TEST_F(Calls, ASingleRayDoesNotSeeWhatItSkips) {
    const Soup soup = test::closed_grid(30);
    const auto scene = committed(soup);
    const auto rays = test::unpleasant_rays(soup, 8, 2000);
    const auto skip = first_hits(nearest(scene, rays));
    auto query = sized<ovc_query>();
    query.skip = skip.data();
    const auto expected = nearest(scene, rays, &query);
    const auto expected_shadows = occlusion(scene, rays, &query);
    for (size_t i = 0; i < rays.size(); ++i) {
        auto one = sized<ovc_query>();
        one.skip = &skip[i];
        ovc_hit hit{};
        uint8_t shadow = 2;
        ASSERT_EQ(api().intersect1(scene.get(), as_abi(rays) + i, &hit, &one), OVC_OK);
        ASSERT_EQ(api().occluded1(scene.get(), as_abi(rays) + i, &shadow, &one), OVC_OK);
        ASSERT_EQ(std::memcmp(&hit, &expected[i], sizeof(hit)), 0) << "ray " << i;
        ASSERT_EQ(shadow, expected_shadows[i]) << "ray " << i;
    }
}

TEST_F(Calls, RaysInFloatsAreTheRaysOfThoseNumbers) {
    const Soup soup = test::closed_grid(40);
    const auto scene = committed(soup);
    std::vector<Ray> rays = test::unpleasant_rays(soup, 9, 5000);
    std::vector<ovc_ray_float> floats;
    for (Ray& ray : rays) {
        const vec3 org(ray.org), dir(ray.dir);
        floats.push_back(
            {{org.x, org.y, org.z}, float(ray.t_min), {dir.x, dir.y, dir.z}, float(ray.t_max)});
        ray = {dvec3(org), double(float(ray.t_min)), dvec3(dir), double(float(ray.t_max))};
    }
    const ovc_ray* cast = reinterpret_cast<const ovc_ray*>(floats.data());
    auto query = sized<ovc_query>();
    query.ray_format = OVC_RAY_FLOAT;
    const auto expected = nearest(scene, rays);
    const auto expected_shadows = occlusion(scene, rays);

    std::vector<ovc_hit> hits(rays.size());
    ASSERT_EQ(api().intersect(scene.get(), cast, rays.size(), hits.data(), &query), OVC_OK);
    EXPECT_TRUE(same_bits(hits, expected));
    std::vector<uint8_t> shadows(rays.size());
    ASSERT_EQ(api().occluded(scene.get(), cast, rays.size(), shadows.data(), &query), OVC_OK);
    EXPECT_EQ(shadows, expected_shadows);
    for (size_t i = 0; i < rays.size(); ++i) {
        cast = reinterpret_cast<const ovc_ray*>(&floats[i]);
        ASSERT_EQ(api().intersect1(scene.get(), cast, &hits[i], &query), OVC_OK);
        ASSERT_EQ(api().occluded1(scene.get(), cast, &shadows[i], &query), OVC_OK);
    }
    EXPECT_TRUE(same_bits(hits, expected));
    EXPECT_EQ(shadows, expected_shadows);
    query.ray_format = 2;
    EXPECT_EQ(api().intersect(scene.get(), cast, 1, hits.data(), &query),
              OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(error(), "ovc_query.ray_format is 2, expected 0 or 1");
}

TEST_F(Calls, RaysInFloatsGoIntoStreams) {
    const Soup soup = test::closed_grid(20);
    const auto scene = committed(soup);
    struct Host {
        std::vector<ovc_ray_float> rays;
        std::vector<ovc_hit> hits;
        bool pushed = false;
    } host;
    for (int i = 0; i < 100; ++i)
        host.rays.push_back({{0.02f * float(i) - 1, 0.1f, 4}, 0, {0, 0, -1}, HUGE_VALF});
    host.hits.resize(host.rays.size());
    auto calls = sized<ovc_stream_host>();
    calls.user = &host;
    calls.more = [](void* user, ovc_stream stream, size_t) {
        Host& h = *static_cast<Host*>(user);
        if (std::exchange(h.pushed, true))
            return 0;
        std::vector<uint64_t> tokens;
        for (size_t i = 0; i < h.rays.size(); ++i)
            tokens.push_back(i);
        auto query = sized<ovc_query>();
        query.ray_format = OVC_RAY_FLOAT;
        return int(api().push(stream, reinterpret_cast<const ovc_ray*>(h.rays.data()),
                              tokens.data(), tokens.size(), 0, &query));
    };
    calls.answered = [](void* user, ovc_stream, const ovc_stream_answers* answers) {
        for (size_t i = 0; i < answers->count; ++i)
            static_cast<Host*>(user)->hits[answers->tokens[i]] = answers->hits[i];
        return 0;
    };
    ASSERT_EQ(api().stream(scene.get(), &calls), OVC_OK) << error();
    std::vector<Ray> rays;
    for (const ovc_ray_float& ray : host.rays)
        rays.push_back({dvec3(ray.org[0], ray.org[1], ray.org[2]), 0, dvec3(0, 0, -1)});
    EXPECT_TRUE(same_bits(host.hits, nearest(scene, rays)));
}

TEST_F(Calls, SingleRaysRefuseWhatTheyCannotDo) {
    const Soup soup = test::closed_grid(10);
    const auto scene = committed(soup);
    const Ray ray;
    const auto* asked = reinterpret_cast<const ovc_ray*>(&ray);
    ovc_hit hit{};
    EXPECT_EQ(api().intersect1(nullptr, asked, &hit, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().intersect1(scene.get(), nullptr, &hit, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().occluded1(scene.get(), asked, nullptr, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    uint32_t leaf = 0;
    auto query = sized<ovc_query>();
    query.leaf = &leaf;
    EXPECT_EQ(api().intersect1(scene.get(), asked, &hit, &query), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(error(), "intersect1: ovc_query.leaf, passes and flagged are for intersect");
    const auto config = sized<ovc_scene_config>();
    const test::AbiScene open = test::add_soup(device, soup, config);
    EXPECT_EQ(api().intersect1(open.get(), asked, &hit, nullptr), OVC_ERROR_INVALID_STATE);
    EXPECT_EQ(error(), "intersect1: the scene is not committed yet, or has changed since it was");
}

/// A thread may wait for a part of its call and run another task of the host meanwhile. It then
/// waits for its own turn. There are two scenes, so that threads in one help with parts of the
/// other.
TEST_F(Calls, AHostMayCallFromItsOwnTasks) {
    const Soup soup = test::closed_grid(60);
    const test::AbiScene scenes[] = {committed(soup), committed(soup)};
    const auto rays = test::unpleasant_rays(soup, 11, 20000);
    const auto expected = nearest(scenes[0], rays);
    const oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism,
                                              8);
    oneapi::tbb::task_arena arena(8);
    std::atomic<size_t> wrong{0};
    arena.execute([&] {
        oneapi::tbb::parallel_for(size_t(0), size_t(100), [&](size_t i) {
            const test::AbiScene& scene = scenes[i / 7 % 2];
            if (i % 2)
                wrong += !same_bits(nearest(scene, rays), expected);
            ovc_hit hit{};
            wrong += api().intersect1(scene.get(), as_abi(rays) + i, &hit, nullptr) != OVC_OK ||
                     std::memcmp(&hit, &expected[i], sizeof(hit)) != 0;
        });
    });
    EXPECT_EQ(wrong, 0u);
}

TEST_F(Calls, ACallStopsWhenItsProgressSaysSo) {
    const Soup soup = test::closed_grid(60);
    const auto scene = committed(soup);
    const auto rays = test::unpleasant_rays(soup, 10, 600000);
    struct Told {
        double before = 0;
        int calls = 0;
        int stop_at = 0;
    } told;
    auto query = sized<ovc_query>();
    query.progress_user = &told;
    query.progress = [](void* user, double done, const char* stage) {
        Told& t = *static_cast<Told*>(user);
        EXPECT_STREQ(stage, "rays");
        EXPECT_GE(done, t.before);
        EXPECT_LT(done, 1);
        t.before = done;
        return int(++t.calls == t.stop_at);
    };
    const auto expected = nearest(scene, rays);
    EXPECT_TRUE(same_bits(nearest(scene, rays, &query), expected));
    EXPECT_GT(told.calls, 1);
    told = {.stop_at = 2};
    std::vector<ovc_hit> hits(rays.size());
    EXPECT_EQ(api().intersect(scene.get(), as_abi(rays), rays.size(), hits.data(), &query),
              OVC_ERROR_CANCELLED);
    EXPECT_EQ(error(), "intersect: cancelled");
    EXPECT_EQ(told.calls, 2);
    EXPECT_TRUE(same_bits(nearest(scene, rays), expected)) << "the scene is as before";
}

double seconds_since(Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
}

/// Returns rays that only integers can decide, which takes some microseconds each. A call with them
/// takes many seconds, most of them on the CPU.
std::vector<Ray> slow_rays(const Soup& soup, size_t count) {
    std::vector<Ray> rays = test::unpleasant_rays(soup, 12, count);
    for (size_t i = 0; i < rays.size(); ++i) {
        rays[i].org = dvec3(i % 3 == 0, i % 3 == 1, i % 3 == 2) * 1e100;
        rays[i].dir = -rays[i].org * 1e-100;
        rays[i].org += soup.triangle({0, uint32_t(i % soup.triangle_count())})[0];
    }
    return rays;
}

/// Tests that the host is asked in time and obeyed in time. Limits are wide, for busy machines;
/// docs/reference/abi.md promises a twentieth and a tenth of a second.
TEST_F(Calls, ASlowCallIsAskedOftenAndEndsSoon) {
    const Soup soup = test::closed_grid(60);
    const auto scene = committed(soup);
    const auto rays = slow_rays(soup, 3'000'000);
    struct Told {
        Clock::time_point begun = Clock::now(), asked = begun, stopped{};
        double longest = 0;
    } told;
    auto query = sized<ovc_query>();
    query.progress_user = &told;
    query.progress = [](void* user, double, const char*) {
        Told& t = *static_cast<Told*>(user);
        t.longest = std::max(t.longest, seconds_since(t.asked));
        t.asked = Clock::now();
        if (seconds_since(t.begun) < 0.3)
            return 0;
        t.stopped = t.asked;
        return 1;
    };
    std::vector<ovc_hit> hits(rays.size());
    EXPECT_EQ(api().intersect(scene.get(), as_abi(rays), rays.size(), hits.data(), &query),
              OVC_ERROR_CANCELLED);
    const double ended = seconds_since(told.stopped);
    std::printf("asked every %.3f s at least, ended within %.3f s\n", told.longest, ended);
    EXPECT_LT(told.longest, 0.5);
    EXPECT_LT(ended, 0.5);
}

TEST_F(Calls, ACallThatWaitsForItsTurnIsAskedAsWell) {
    const Soup soup = test::closed_grid(60);
    const auto scene = committed(soup);
    const auto rays = slow_rays(soup, 400'000);
    std::atomic<bool> slow_call_done{false};
    std::thread other([&] {
        nearest(scene, rays);
        slow_call_done = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    auto query = sized<ovc_query>();
    query.progress = [](void*, double, const char*) { return 1; };
    ovc_hit hit;
    EXPECT_EQ(api().intersect(scene.get(), as_abi(rays), 1, &hit, &query), OVC_ERROR_CANCELLED);
    EXPECT_FALSE(slow_call_done) << "cancelled before its turn";
    other.join();
    EXPECT_EQ(api().intersect(scene.get(), as_abi(rays), 1, &hit, nullptr), OVC_OK);
}

} // namespace
} // namespace ovc
