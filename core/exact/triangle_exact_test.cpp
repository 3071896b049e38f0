// SPDX-License-Identifier: Apache-2.0
// The reference equals exact rational arithmetic where doubles alone would not: at edges and
// vertices, grazing, in planes, at the ends of the ray, at ties.
#include "core/exact/triangle.h"
#include "tests/exact.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovc {
namespace {

class Lattice : public test::Random {
public:
    using test::Random::Random;
    dvec3 point() { return test::Random::point(-1, 1); }
    /// Returns a point of few bits, so that exact coincidences happen.
    dvec3 lattice() { return glm::round(point() * 8.0) / 2.0; }
};

struct Coincidence {
    const char* name;
    void (*make)(Lattice&, std::vector<Triangle>&, Ray&);
};

const Coincidence kCoincidences[] = {
    {"at a vertex",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         t = {{r.point(), r.point(), r.point()}};
         ray = {r.point() * 3.0, 0, dvec3(0)};
         ray.dir = t[0][0] - ray.org;
     }},
    {"at an edge",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         t = {{r.point(), r.point(), r.point()}};
         ray = {r.point() * 3.0, 0, dvec3(0)};
         ray.dir = t[0][0] + r(0, 1) * (t[0][1] - t[0][0]) - ray.org;
     }},
    {"lattice",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         for (int i = 0; i < 8; ++i)
             t.push_back({r.lattice(), r.lattice(), r.lattice()});
         ray = {r.lattice() * 3.0, 0, r.lattice() / 3.0};
     }},
    {"far away",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         const dvec3 far(4.5e6, 6e6, -1e9);
         t = {{far + r.point(), far + r.point(), far + r.point()}};
         ray = {r.point() * 3.0, 0, dvec3(0)};
         ray.dir = t[0][2] - ray.org;
     }},
    {"fan, some of it edge-on",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         const dvec3 hub = r.lattice();
         ray = {r.lattice() * 3.0, 0, dvec3(0)};
         ray.dir = hub - ray.org;
         for (int i = 0; i < 12; ++i) {
             const dvec3 a = r.lattice(), b = r.below(3) == 0 ? a + ray.dir : r.lattice();
             t.push_back(r.below(2) == 0 ? Triangle{hub, a, b} : Triangle{a, b, hub});
         }
     }},
    {"book",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         const dvec3 a = r.lattice(), b = r.lattice();
         ray = {r.lattice() * 3.0, 0, dvec3(0)};
         ray.dir = 0.25 * a + 0.75 * b - ray.org;
         for (int i = 0; i < 12; ++i) {
             const dvec3 page = r.below(3) == 0 ? a + ray.dir : r.lattice();
             t.push_back(r.below(2) == 0 ? Triangle{a, page, b} : Triangle{page, b, a});
         }
     }},
    {"one plane",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         for (int i = 0; i < 12; ++i) {
             t.push_back({r.lattice(), r.lattice(), r.lattice()});
             for (dvec3& corner : t.back())
                 corner.z = corner.x + corner.y;
         }
         t[r.below(12)][0].z += 0x1p-50;
         ray = {r.point() * 3.0, 0, r.lattice() / 3.0};
     }},
    {"copies within ulps",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         const Triangle base{r.point(), r.point(), r.point()};
         for (int i = 0; i < 12; ++i) {
             t.push_back(base);
             for (dvec3& corner : t.back())
                 corner.x = std::nextafter(corner.x, r(-2, 2));
         }
         ray = {r.point() * 3.0, 0, dvec3(0)};
         ray.dir = 0.3 * base[0] + 0.3 * base[1] + 0.4 * base[2] - ray.org;
     }},
    {"sliver",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         const dvec3 a = r.point(), along = r.point();
         t = {{a, a + along, a + 0.5 * along + 1e-9 * r.point()}};
         ray = {r.point() * 3.0, 0, dvec3(0)};
         ray.dir = a + r(0, 1) * along - ray.org;
     }},
    {"grazing",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         t = {{r.point(), r.point(), r.point()}};
         const dvec3 inside = (t[0][0] + t[0][1] + t[0][2]) / 3.0;
         const dvec3 along = t[0][1] - t[0][0];
         const dvec3 up = 1e-12 * glm::cross(along, t[0][2] - t[0][0]);
         ray = {inside - 2.0 * along + 2.0 * up, 0, along - up + 1e-16 * r.point()};
     }},
    {"a kilometre through the origin",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         t = {{1e3 * r.point(), 1e3 * r.point(), dvec3(0)}};
         t[0][2] = -(t[0][0] + t[0][1]);
         ray = {1e-12 * r.point(), 0, r.point()};
     }},
    {"ends at the hit",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         t = {{r.lattice(), r.lattice(), r.lattice()}};
         const dvec3 inside = 0.5 * t[0][0] + 0.25 * t[0][1] + 0.25 * t[0][2];
         ray = {r.lattice(), 0, dvec3(0)};
         ray.dir = inside - ray.org;
         (r.below(2) ? ray.t_min : ray.t_max) = 1;
     }},
    {"a vertex of many",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         const dvec3 apex = r.lattice();
         for (int i = 0; i < 6; ++i) {
             t.push_back({r.lattice(), r.lattice(), apex});
             std::rotate(t[i].begin(), t[i].begin() + int(r.below(3)), t[i].end());
         }
         ray = {r.lattice() * 3.0, 0, dvec3(0)};
         ray.dir = apex - ray.org;
     }},
    {"a side of many",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         const dvec3 a = r.lattice(), b = r.lattice();
         for (int i = 0; i < 6; ++i) {
             t.push_back({a, r.lattice(), b});
             std::rotate(t[i].begin(), t[i].begin() + int(r.below(3)), t[i].end());
             if (r.below(2))
                 std::swap(t[i][0], t[i][1]);
         }
         ray = {r.lattice() * 3.0, 0, dvec3(0)};
         ray.dir = 0.5 * (a + b) - ray.org;
     }},
    {"next to a side of many",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         const dvec3 a = r.point(), b = r.point();
         for (int i = 0; i < 6; ++i)
             t.push_back({a, b, r.point()});
         ray = {r.point() * 3.0, 0, dvec3(0)};
         ray.dir = a + r(0, 1) * (b - a) - ray.org;
     }},
    {"tiny ones seen from afar",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         const double size = std::ldexp(1.0, -int(r.below(140)));
         for (int i = 0; i < 4; ++i)
             t.push_back({size * r.point(), size * r.point(), size * r.lattice()});
         ray = {r.below(2) ? 1e3 * r.point() : 100.0 * r.lattice(), 0, dvec3(0)};
         ray.dir = r.below(2) ? -ray.org : t[0][2] - ray.org;
     }},
    {"a tiny way from it",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         const double way = std::ldexp(1.0, -600 - int(r.below(470)));
         for (int i = 0; i < 4; ++i) {
             const double size = std::ldexp(1.0, -int(r.below(250)));
             t.push_back({size * r.point(), size * r.point(), dvec3(0)});
             t[i][2] = -(t[i][0] + t[i][1]);
             for (dvec3& corner : t[i])
                 corner.z = i == 0 ? 0 : way * double(r.below(3));
         }
         ray = {dvec3(0, 0, -way), 0, dvec3(0, 0, 1)};
         if (r.below(2))
             (r.below(2) ? ray.t_min : ray.t_max) = way;
     }},
    {"huge",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         for (int i = 0; i < 4; ++i)
             t.push_back({1e93 * r.lattice(), 1e93 * r.lattice(), 1e93 * r.lattice()});
         ray = {3e93 * r.lattice(), 0, dvec3(0)};
         ray.dir = 1e-93 * (0.5 * (t[0][0] + t[0][1]) - ray.org);
     }},
    {"coplanar and overlapping",
     [](Lattice& r, std::vector<Triangle>& t, Ray& ray) {
         const dvec3 a = r.lattice(), u = r.lattice(), v = r.lattice();
         for (int i = 0; i < 6; ++i) {
             const auto point = [&] { return a + double(r.below(5)) * u + double(r.below(5)) * v; };
             t.push_back({point(), point(), point()});
         }
         ray = {r.lattice() * 3.0, 0, r.point()};
     }},
};

/// Calls check(triangles, ray, hits) with triangles of area and a valid ray, for each seed of each
/// coincidence. Expects `hits`, which check() counts up, to become more than min_hits for each.
template <class Check>
void for_each_coincidence(uint64_t seeds, size_t min_hits, Check&& check) {
    for (const Coincidence& c : kCoincidences) {
        SCOPED_TRACE(c.name);
        size_t hits = 0;
        for (uint64_t seed = 0; seed < seeds; ++seed) {
            SCOPED_TRACE(seed);
            Lattice random(seed);
            std::vector<Triangle> triangles;
            Ray ray;
            c.make(random, triangles, ray);
            std::erase_if(triangles, [](const Triangle& triangle) {
                return triangle_fault(triangle) != TriangleFault::None;
            });
            if (ray.valid()) {
                ASSERT_NO_FATAL_FAILURE(check(triangles, ray, hits));
            }
        }
        EXPECT_GT(hits, min_hits);
    }
}

TEST(Reference, EqualsExactArithmetic) {
    const auto check = [](const std::vector<Triangle>& triangles, const Ray& ray, size_t& hits) {
        const PreparedRay p(ray);
        Nearest nearest(p);
        std::optional<test::ExactHit> truth;
        for (uint32_t i = 0; i < triangles.size(); ++i) {
            const TriangleId id{0, i};
            nearest.offer(triangles[i], id);
            const auto hit = test::exact_hit(ray, triangles[i], id);
            ASSERT_EQ(hit.has_value(), intersect(p, triangles[i], id).has_value());
            if (hit && (!truth || hit->t < truth->t))
                truth = hit;
        }
        const Hit expected = truth ? truth->rounded() : Hit{}, got = nearest.hit();
        ASSERT_EQ(got.id, expected.id);
        ASSERT_EQ(got.t, expected.t);
        ASSERT_EQ(got.u, expected.u);
        ASSERT_EQ(got.v, expected.v);
        hits += truth.has_value();
    };
    for_each_coincidence(/* seeds= */ 1500, /* min_hits= */ 20, check);
}

TEST(Reference, CandidatesAreOffByTheirErrorAtMost) {
    const auto check = [](const std::vector<Triangle>& triangles, const Ray& ray, size_t& hits) {
        const PreparedRay p(ray);
        for (const Triangle& triangle : triangles) {
            const auto truth = test::exact_hit(ray, triangle);
            for (const auto& found :
                 {candidate(p, triangle, {0, 0}), exact_candidate(p, triangle, {0, 0})}) {
                ASSERT_EQ(truth.has_value(), found.has_value());
                if (!truth)
                    continue;
                ++hits;
                const test::Rational t =
                    test::Rational(found->hit.t) + test::Rational(found->t_low);
                ASSERT_LE(abs(t - truth->t), test::Rational(found->t_error));
                if (found->support != Candidate::kAllCorners) {
                    const test::Rational w = 1 - truth->u - truth->v;
                    ASSERT_EQ(found->support, uint32_t(w != 0) | uint32_t(truth->u != 0) << 1 |
                                                  uint32_t(truth->v != 0) << 2);
                }
            }
        }
    };
    for_each_coincidence(/* seeds= */ 800, /* min_hits= */ 40, check);
}

TEST(Reference, EqualBitsForTheSameTriangleWhateverItsCornersOrder) {
    Lattice random(1);
    for (int i = 0; i < 2000; ++i) {
        const Triangle t{random.point(), random.point(), random.point()};
        Ray ray{random.point() * 3.0, 0, dvec3(0)};
        ray.dir = 0.2 * t[0] + 0.3 * t[1] + 0.5 * t[2] - ray.org;
        const PreparedRay p(ray);
        Nearest nearest(p);
        nearest.offer({t[1], t[0], t[2]}, {0, 1});
        nearest.offer({t[2], t[0], t[1]}, {0, 0});
        EXPECT_EQ(nearest.hit().id, (TriangleId{0, 0})) << "equal t goes to the smaller id";
    }
}

/// Rounding takes some of these t beyond all doubles, on the way to the largest one.
TEST(Triangle, IsHitAtTheLargestDouble) {
    constexpr double kLargest = std::numeric_limits<double>::max();
    test::Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const double z = std::ldexp(kLargest, -900);
        Triangle triangle;
        for (int k = 0; k < 3; ++k)
            triangle[k] = dvec3(z * std::cos(2.0944 * k) * random(0.5, 1),
                                z * std::sin(2.0944 * k) * random(0.5, 1), z);
        const PreparedRay p(Ray{dvec3(0), 0, dvec3(0, 0, std::ldexp(1.0, -900))});
        const std::optional<Hit> hit = intersect(p, triangle, {0, 0});
        ASSERT_TRUE(hit) << i;
        EXPECT_EQ(hit->t, kLargest) << i;
    }
}

} // namespace
} // namespace ovc
