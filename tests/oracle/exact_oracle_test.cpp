// SPDX-License-Identifier: Apache-2.0
// Compares the C ABI with the oracle: it must find the right triangle, and t, u and v to the last
// bit, for rays in batches and one by one, over hard cases. OVC_ORACLE_RAYS sets the number of
// rays; by default there are few.
#include "tests/abi/abi_scene.h"
#include "tests/oracle/cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <set>
#include <thread>

namespace ovc::oracle {
namespace {

using test::api;
using test::sized;

constexpr ovc_hit kMiss = {std::numeric_limits<double>::infinity(), 0, 0, OVC_NONE, OVC_NONE};

class ExactOracle : public testing::Test {
protected:
    void SetUp() override {
        device = test::open_device();
        if (!device)
            GTEST_SKIP() << api().last_error(nullptr);
    }

    uint32_t add(ovc_scene scene, const Mesh& mesh, uint32_t mask) const {
        auto given = sized<ovc_mesh>();
        given.mask = mask;
        std::vector<float> floats;
        given.vertex_count = mesh.corners.size();
        if (mesh.in_floats) {
            for (const Corner& corner : mesh.corners)
                floats.insert(floats.end(), {float(corner[0]), float(corner[1]), float(corner[2])});
            given.positions = floats.data();
        } else {
            given.positions_double = mesh.corners[0].data();
        }
        uint32_t number = OVC_NONE;
        EXPECT_EQ(api().add_mesh(scene, &given, &number), OVC_OK) << error();
        return number;
    }

    /// Returns an instance's corner as overcast.h defines it.
    static Corner placed(const std::array<double, 12>& m, const Corner& p) {
        Corner q;
        for (size_t row = 0; row < 3; ++row) {
            const double* r = &m[4 * row];
            q[row] = ((r[0] * p[0] + r[1] * p[1]) + r[2] * p[2]) + r[3];
        }
        return q;
    }

    static void list(std::vector<Triangle>& triangles, uint32_t number,
                     const std::vector<Corner>& corners) {
        for (uint32_t prim = 0; prim < corners.size() / 3; ++prim)
            triangles.push_back({{corners[3 * prim], corners[3 * prim + 1], corners[3 * prim + 2]},
                                 {number, prim}});
    }

    /// Returns the mask of a mesh or an instance by its number.
    static uint32_t mask_of(uint32_t number) { return number % 4; }

    /// Makes a scene of the meshes, built in one of several ways. Returns it and its triangles.
    test::AbiScene make(const std::vector<Mesh>& meshes, Random& random,
                        std::vector<Triangle>& triangles) const {
        auto config = sized<ovc_scene_config>();
        config.leaves = random.below(3) == 0 ? uint32_t(1 + random.below(12)) : 0;
        config.kernel = uint32_t(random.below(3));
        config.gpu_memory_bytes = random.below(4) == 0 ? 64 << 10 : 0;
        ovc_scene scene = nullptr;
        EXPECT_EQ(api().create_scene(device.get(), &config, &scene), OVC_OK) << error();
        test::AbiScene owner(scene);
        uint32_t added = 0;
        for (const Mesh& mesh : meshes) {
            const uint32_t number = add(scene, mesh, mask_of(added++));
            list(triangles, number, mesh.corners);
            for (const auto& transform : mesh.instances) {
                auto instance = sized<ovc_instance>();
                instance.mesh = number;
                instance.transform = transform.data();
                instance.mask = mask_of(added++);
                uint32_t placed_as = OVC_NONE;
                EXPECT_EQ(api().add_instance(scene, &instance, &placed_as), OVC_OK) << error();
                std::vector<Corner> corners;
                for (const Corner& corner : mesh.corners)
                    corners.push_back(placed(transform, corner));
                list(triangles, placed_as, corners);
            }
        }
        EXPECT_EQ(api().commit(scene), OVC_OK) << error();
        return owner;
    }

    std::string error() const { return api().last_error(device.get()); }

    test::Device device;
};

bool same_bits(const ovc_hit& a, const ovc_hit& b) {
    return a.t == b.t && a.u == b.u && a.v == b.v && a.mesh == b.mesh && a.prim == b.prim;
}

std::string text(const ovc_hit& hit) {
    char line[200];
    snprintf(line, sizeof line, "t %.17g u %.17g v %.17g mesh %d prim %d", hit.t, hit.u, hit.v,
             int(hit.mesh), int(hit.prim));
    return line;
}

/// Returns how often a test goes through all cases, with so many rays for each. rays: of the test,
/// where OVC_ORACLE_RAYS does not say how many.
uint64_t rounds_of(uint64_t rays, uint64_t rays_per_case) {
    if (const char* asked = std::getenv("OVC_ORACLE_RAYS"))
        rays = uint64_t(std::strtod(asked, nullptr));
    const uint64_t each = rays_per_case * cases().size();
    return std::max<uint64_t>((rays + each - 1) / each, 1);
}

TEST_F(ExactOracle, FindsNoAnswerThatIsOffByABit) {
    constexpr size_t kRaysPerScene = 500;
    const uint64_t rounds = rounds_of(90'000, kRaysPerScene);
    uint64_t hits = 0, rays_asked = 0;
    for (uint64_t seed = 0; seed < rounds; ++seed)
        for (const Case& c : cases()) {
            SCOPED_TRACE(c.name);
            SCOPED_TRACE(seed);
            Random random(seed);
            std::vector<Triangle> triangles;
            const test::AbiScene scene = make(c.meshes(random), random, triangles);
            const Oracle oracle(triangles);
            std::vector<ovc_ray> rays;
            std::vector<ovc_triangle> skip;
            for (size_t i = 0; i < kRaysPerScene; ++i) {
                rays.push_back(c.ray(random, triangles));
                skip.push_back(random.below(4) == 0 ? triangles[random.below(triangles.size())].id
                                                    : ovc_triangle{OVC_NONE, OVC_NONE});
            }
            auto query = sized<ovc_query>();
            query.skip = skip.data();
            const std::vector<ovc_hit> got = test::answers(scene.get(), rays, &query);
            const std::vector<uint8_t> occluded = test::occlusion(scene.get(), rays, &query);
            for (size_t i = 0; i < rays.size(); ++i) {
                const ovc_hit expected = oracle.nearest(rays[i], skip[i]);
                ASSERT_TRUE(same_bits(got[i], expected))
                    << "ray " << i << ": " << text(got[i]) << ", exactly " << text(expected);
                ASSERT_EQ(occluded[i] != 0, expected.mesh != OVC_NONE) << "ray " << i;
                hits += expected.mesh != OVC_NONE;
                if (i % 8 != 0)
                    continue;
                query.skip = &skip[i];
                ovc_hit one;
                ASSERT_EQ(api().intersect1(scene.get(), &rays[i], &one, &query), OVC_OK);
                ASSERT_TRUE(same_bits(one, expected))
                    << "single ray " << i << ": " << text(one) << ", exactly " << text(expected);
            }
            rays_asked += rays.size();
        }
    EXPECT_GT(hits, rays_asked / 5);
    RecordProperty("rays", int(rays_asked));
    std::printf("%llu rays, %llu hits: none off by a bit\n", (unsigned long long)(rays_asked),
                (unsigned long long)(hits));
}

/// Returns a hit of the ray, or a place before, behind or between its hits that is none.
ovc_hit some_place(Random& random, const std::vector<ovc_hit>& hits, const Triangle& triangle) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    ovc_hit place = hits.empty() ? ovc_hit{1, 0, 0, 0, 0} : hits[random.below(hits.size())];
    switch (random.below(6)) {
    case 0:
        place.mesh = triangle.id.mesh; // The ray may meet it elsewhere.
        place.prim = triangle.id.prim;
        return place;
    case 1:
        place.t = std::nextafter(place.t, random.below(2) ? infinity : -infinity);
        return place;
    case 2:
        place.t = random.below(2) ? infinity : -infinity;
        return place;
    case 3:
        place.mesh = place.prim = random.below(2) ? OVC_NONE : 0;
        return place;
    default:
        return place;
    }
}

class ExactOrder : public ExactOracle {
protected:
    static constexpr size_t kRays = 100;

    /// Asks for one hit after the other, in place, until all rays miss.
    void expect_all_hits(ovc_scene scene, const std::vector<std::vector<ovc_hit>>& expected) {
        std::vector<ovc_hit> hits(kRays, {-std::numeric_limits<double>::infinity(), 0, 0, 0, 0});
        auto query = sized<ovc_query>();
        query.after = hits.data();
        size_t left = 1;
        for (size_t n = 0; left > 0; ++n) {
            const std::vector<ovc_hit> next = test::answers(scene, rays, &query);
            ASSERT_EQ(api().intersect(scene, rays.data(), kRays, hits.data(), &query), OVC_OK)
                << error();
            ASSERT_TRUE(std::ranges::equal(next, hits, same_bits));
            left = 0;
            for (size_t i = 0; i < kRays; ++i) {
                const bool more = n < expected[i].size();
                const ovc_hit& wanted = more ? expected[i][n] : kMiss;
                ASSERT_TRUE(same_bits(hits[i], wanted))
                    << "hit " << n << " of ray " << i << ": " << text(hits[i]) << ", exactly "
                    << text(wanted);
                left += more;
            }
        }
    }

    void expect_next(ovc_scene scene, const Oracle& oracle, const std::vector<ovc_hit>& places) {
        auto query = sized<ovc_query>();
        query.after = places.data();
        const std::vector<ovc_hit> hits = test::answers(scene, rays, &query);
        const std::vector<uint8_t> occluded = test::occlusion(scene, rays, &query);
        for (size_t i = 0; i < kRays; ++i) {
            const ovc_hit wanted = oracle.next(rays[i], places[i]);
            ASSERT_TRUE(same_bits(hits[i], wanted))
                << "ray " << i << " behind " << text(places[i]) << ": " << text(hits[i])
                << ", exactly " << text(wanted);
            ASSERT_EQ(occluded[i] != 0, wanted.mesh != OVC_NONE) << "ray " << i;
            query.after = &places[i];
            ovc_hit one;
            ASSERT_EQ(api().intersect1(scene, &rays[i], &one, &query), OVC_OK);
            ASSERT_TRUE(same_bits(one, wanted)) << "single ray " << i;
        }
    }

    void expect_all_hits_at_once(ovc_scene scene, size_t max_hits,
                                 const std::vector<std::vector<ovc_hit>>& expected) {
        std::vector<ovc_hit> hits(kRays * max_hits);
        std::vector<uint64_t> counts(kRays);
        for (const bool with_counts : {true, false}) {
            if (max_hits == 0 && !with_counts)
                continue;
            std::ranges::fill(hits, ovc_hit{});
            ASSERT_EQ(api().all_hits(scene, rays.data(), kRays, max_hits, hits.data(),
                                     with_counts ? counts.data() : nullptr, nullptr),
                      OVC_OK)
                << error();
            for (size_t i = 0; i < kRays; ++i) {
                ASSERT_EQ(counts[i], expected[i].size()) << "ray " << i;
                for (size_t n = 0; n < max_hits; ++n) {
                    const ovc_hit& wanted = n < expected[i].size() ? expected[i][n] : kMiss;
                    ASSERT_TRUE(same_bits(hits[i * max_hits + n], wanted))
                        << "hit " << n << " of ray " << i << ": " << text(hits[i * max_hits + n])
                        << ", exactly " << text(wanted);
                }
            }
        }
    }

    std::vector<ovc_ray> rays;
};

/// A filter that lets some hits of each ray pass, and records the hits that it is asked about.
class NotedFilter {
public:
    explicit NotedFilter(std::vector<std::set<std::pair<uint32_t, uint32_t>>>& asked)
        : asked_(asked) {}

    static bool lets_pass(uint64_t ray, const ovc_hit& hit) {
        return (ray * 31 + hit.mesh * 7 + hit.prim) % 3 == 0;
    }
    static int keep(void* user, size_t count, const uint64_t* rays, const ovc_hit* hits,
                    uint8_t* keep) {
        auto& self = *static_cast<NotedFilter*>(user);
        const std::lock_guard lock(self.mutex_);
        for (size_t i = 0; i < count; ++i) {
            const bool is_new = self.asked_[rays[i]].insert({hits[i].mesh, hits[i].prim}).second;
            self.asked_twice_ |= !is_new;
            keep[i] = lets_pass(rays[i], hits[i]);
        }
        return 0;
    }
    bool asked_twice() const { return asked_twice_; }

private:
    std::mutex mutex_;
    std::vector<std::set<std::pair<uint32_t, uint32_t>>>& asked_;
    bool asked_twice_ = false;
};

/// Tests the first hit, or all hits, of rays with skips, masks and a filter, in every form of a
/// call.
class ExactSieves : public ExactOrder {
protected:
    void expect_counting_hits(ovc_scene scene, Random& random,
                              const std::vector<std::vector<ovc_hit>>& hits) {
        masks.clear();
        skips.assign(kRays, {OVC_NONE, OVC_NONE});
        expected.assign(kRays, {});
        for (size_t i = 0; i < kRays; ++i) {
            masks.push_back(uint32_t(random.below(4)));
            if (!hits[i].empty() && random.below(2)) {
                const ovc_hit& hit = hits[i][random.below(std::min<size_t>(hits[i].size(), 3))];
                skips[i] = {hit.mesh, hit.prim};
            }
            for (const ovc_hit& hit : hits[i])
                if (sees(i, hit) && NotedFilter::lets_pass(i, hit))
                    expected[i].push_back(hit);
        }
        ASSERT_NO_FATAL_FAILURE(expect_in_batches(scene));
        ASSERT_NO_FATAL_FAILURE(expect_one_by_one(scene));
        ASSERT_NO_FATAL_FAILURE(expect_in_a_stream(scene));
    }

    ovc_hit first(size_t i) const { return expected[i].empty() ? kMiss : expected[i][0]; }

    /// Calls trace(query) with a filter of its own, which is asked about no hit twice.
    template <class Trace>
    void with_filter(Trace&& trace) {
        std::vector<std::set<std::pair<uint32_t, uint32_t>>> asked(kRays);
        NotedFilter filter(asked);
        auto query = sized<ovc_query>();
        query.skip = skips.data();
        query.masks = masks.data();
        query.filter = NotedFilter::keep;
        query.filter_user = &filter;
        trace(query);
        EXPECT_FALSE(filter.asked_twice());
    }

    void expect_in_batches(ovc_scene scene) {
        constexpr size_t kMaxHits = 3;
        std::vector<ovc_hit> got(kRays), all(kRays * kMaxHits);
        std::vector<uint64_t> counts(kRays);
        std::vector<uint8_t> occluded(kRays);
        with_filter([&](ovc_query& query) {
            EXPECT_EQ(api().intersect(scene, rays.data(), kRays, got.data(), &query), OVC_OK);
        });
        with_filter([&](ovc_query& query) {
            EXPECT_EQ(api().occluded(scene, rays.data(), kRays, occluded.data(), &query), OVC_OK);
        });
        with_filter([&](ovc_query& query) {
            EXPECT_EQ(api().all_hits(scene, rays.data(), kRays, kMaxHits, all.data(), counts.data(),
                                     &query),
                      OVC_OK);
        });
        for (size_t i = 0; i < kRays; ++i) {
            ASSERT_TRUE(same_bits(got[i], first(i)))
                << "ray " << i << ": " << text(got[i]) << ", exactly " << text(first(i));
            ASSERT_EQ(occluded[i] != 0, !expected[i].empty()) << "ray " << i;
            ASSERT_EQ(counts[i], expected[i].size()) << "ray " << i;
            for (size_t n = 0; n < kMaxHits; ++n)
                ASSERT_TRUE(same_bits(all[i * kMaxHits + n],
                                      n < expected[i].size() ? expected[i][n] : kMiss))
                    << "hit " << n << " of ray " << i;
        }
    }

    void expect_one_by_one(ovc_scene scene) {
        with_filter([&](ovc_query& query) {
            for (size_t i = 0; i < kRays; i += 10) {
                query.skip = &skips[i];
                query.masks = &masks[i];
                query.filter = [](void*, size_t count, const uint64_t*, const ovc_hit* hits,
                                  uint8_t* keep) {
                    for (size_t k = 0; k < count; ++k)
                        keep[k] = NotedFilter::lets_pass(0, hits[k]);
                    return 0;
                };
                ovc_hit wanted = kMiss, got;
                uint8_t occluded = 0;
                for (const ovc_hit& hit : all_seen(i))
                    if (wanted.mesh == OVC_NONE && NotedFilter::lets_pass(0, hit))
                        wanted = hit;
                EXPECT_EQ(api().intersect1(scene, &rays[i], &got, &query), OVC_OK);
                EXPECT_TRUE(same_bits(got, wanted)) << "single ray " << i;
                EXPECT_EQ(api().occluded1(scene, &rays[i], &occluded, &query), OVC_OK);
                EXPECT_EQ(occluded != 0, wanted.mesh != OVC_NONE) << "single ray " << i;
            }
        });
    }

    bool sees(size_t i, const ovc_hit& hit) const {
        const uint32_t mask = mask_of(hit.mesh);
        return (masks[i] == 0 || mask == 0 || (masks[i] & mask)) &&
               (hit.mesh != skips[i].mesh || hit.prim != skips[i].prim);
    }

    /// Returns the hits of the ray that it sees.
    std::vector<ovc_hit> all_seen(size_t i) const {
        std::vector<ovc_hit> seen;
        for (const ovc_hit& hit : all_hits[i])
            if (sees(i, hit))
                seen.push_back(hit);
        return seen;
    }

    /// Pushes each ray for both kinds of answers, every fourth one without masks and filter.
    void expect_in_a_stream(ovc_scene scene) {
        struct Host {
            const ExactSieves& test;
            ovc_query sieved;
            bool pushed = false;
            std::vector<ovc_hit> hits = std::vector<ovc_hit>(kRays);
            std::vector<uint8_t> occluded = std::vector<uint8_t>(kRays);
        };
        with_filter([&](ovc_query& query) {
            Host host{*this, query};
            host.sieved.skip = nullptr; // Rays come one by one.
            host.sieved.masks = nullptr;
            auto calls = sized<ovc_stream_host>();
            calls.user = &host;
            calls.more = [](void* user, ovc_stream stream, size_t) {
                auto& self = *static_cast<Host*>(user);
                if (std::exchange(self.pushed, true))
                    return 0;
                for (uint64_t i = 0; i < kRays; ++i) {
                    self.sieved.skip = &self.test.skips[i];
                    self.sieved.masks = &self.test.masks[i];
                    const ovc_query* const given = i % 4 == 0 ? nullptr : &self.sieved;
                    if (i % 2 == 0)
                        api().push(stream, &self.test.rays[i], &i, 1, 0, given);
                    else
                        api().push(stream, &self.test.rays[i], &i, 1, 1, given);
                }
                return 0;
            };
            calls.answered = [](void* user, ovc_stream, const ovc_stream_answers* answers) {
                auto& self = *static_cast<Host*>(user);
                for (size_t k = 0; k < answers->count; ++k) {
                    if (answers->hits)
                        self.hits[answers->tokens[k]] = answers->hits[k];
                    else
                        self.occluded[answers->tokens[k]] = answers->occluded[k];
                }
                return 0;
            };
            ASSERT_EQ(api().stream(scene, &calls), OVC_OK) << error();
            for (size_t i = 0; i < kRays; ++i) {
                const ovc_hit plain = all_hits[i].empty() ? kMiss : all_hits[i][0];
                const ovc_hit wanted = i % 4 == 0 ? plain : first(i);
                if (i % 2 == 0)
                    ASSERT_TRUE(same_bits(host.hits[i], wanted)) << "pushed ray " << i;
                else
                    ASSERT_EQ(host.occluded[i] != 0, wanted.mesh != OVC_NONE) << "pushed " << i;
            }
        });
    }

    std::vector<ovc_triangle> skips;
    std::vector<uint32_t> masks;
    std::vector<std::vector<ovc_hit>> all_hits, expected;
};

TEST_F(ExactSieves, LetTheFirstHitPassThatCounts) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        Random random(77);
        std::vector<Triangle> triangles;
        const test::AbiScene scene = make(c.meshes(random), random, triangles);
        const Oracle oracle(triangles);
        rays.clear();
        all_hits.clear();
        for (size_t i = 0; i < kRays; ++i) {
            rays.push_back(c.ray(random, triangles));
            all_hits.push_back(oracle.all_hits(rays[i]));
        }
        ASSERT_NO_FATAL_FAILURE(expect_counting_hits(scene.get(), random, all_hits));
    }
}

TEST_F(ExactOrder, HasEveryHitOnce) {
    const uint64_t rounds = rounds_of(3'800, kRays);
    uint64_t hits = 0, rays_asked = 0;
    for (uint64_t seed = 0; seed < rounds; ++seed)
        for (const Case& c : cases()) {
            SCOPED_TRACE(c.name);
            SCOPED_TRACE(seed);
            Random random(seed);
            std::vector<Triangle> triangles;
            const test::AbiScene scene = make(c.meshes(random), random, triangles);
            const Oracle oracle(triangles);
            std::vector<std::vector<ovc_hit>> expected;
            std::vector<ovc_hit> places;
            rays.clear();
            for (size_t i = 0; i < kRays; ++i) {
                rays.push_back(c.ray(random, triangles));
                expected.push_back(oracle.all_hits(rays[i]));
                hits += expected[i].size();
                places.push_back(
                    some_place(random, expected[i], triangles[random.below(triangles.size())]));
            }
            ASSERT_NO_FATAL_FAILURE(expect_all_hits(scene.get(), expected));
            ASSERT_NO_FATAL_FAILURE(
                expect_all_hits_at_once(scene.get(), random.below(8), expected));
            ASSERT_NO_FATAL_FAILURE(expect_next(scene.get(), oracle, places));
            rays_asked += kRays;
        }
    EXPECT_GT(hits, rays_asked);
    std::printf("%llu rays, %llu hits: each found once, in its place\n",
                (unsigned long long)(rays_asked), (unsigned long long)(hits));
}

} // namespace
} // namespace ovc::oracle
