// SPDX-License-Identifier: Apache-2.0
// The reference tests: watertight, inclusive, conservative, and right where exact arithmetic can
// tell.
#include "core/exact/triangle.h"
#include "tests/random.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <vector>

namespace ovc {
namespace {

using Rational = boost::multiprecision::cpp_rational;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
const Triangle kUnit = {dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)};

struct Random : test::Random {
    using test::Random::Random;

    double uniform(double from, double to) { return (*this)(from, to); }
    dvec3 in_cube(double half) { return point(-half, half); }
};

std::optional<Hit> shoot(const Ray& ray, const Triangle& triangle) {
    return intersect(PreparedRay(ray), triangle, {0, 0});
}

struct ClosedMesh {
    std::vector<dvec3> vertices;
    std::vector<std::array<uint32_t, 3>> faces;

    Triangle triangle(size_t face) const {
        return {vertices[faces[face][0]], vertices[faces[face][1]], vertices[faces[face][2]]};
    }
};

/// Returns an octahedron, subdivided and pushed out to the unit sphere around `center`.
ClosedMesh sphere(int subdivisions, dvec3 center) {
    ClosedMesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (double sign : {1.0, -1.0}) {
            dvec3 v(0);
            v[axis] = sign;
            mesh.vertices.push_back(v);
        }
    for (uint32_t octant = 0; octant < 8; ++octant) {
        const uint32_t x = octant & 1, y = 2 + (octant >> 1 & 1), z = 4 + (octant >> 2);
        const bool flip = (octant & 1) ^ (octant >> 1 & 1) ^ (octant >> 2);
        mesh.faces.push_back(flip ? std::array{x, z, y} : std::array{x, y, z});
    }
    for (int step = 0; step < subdivisions; ++step) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [it, fresh] =
                middles.try_emplace(std::minmax(a, b), uint32_t(mesh.vertices.size()));
            if (fresh)
                mesh.vertices.push_back(glm::normalize(mesh.vertices[a] + mesh.vertices[b]));
            return it->second;
        };
        std::vector<std::array<uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.faces) {
            const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.faces = std::move(finer);
    }
    for (dvec3& v : mesh.vertices)
        v += center;
    return mesh;
}

/// Returns whether the ray meets any face.
bool meets(const ClosedMesh& mesh, const Ray& ray) {
    const PreparedRay prepared(ray);
    for (size_t face = 0; face < mesh.faces.size(); ++face)
        if (intersect(prepared, mesh.triangle(face), {0, uint32_t(face)}))
            return true;
    return false;
}

/// Returns a point of a random face: on a vertex, on an edge, or inside.
dvec3 point_to_aim_at(const ClosedMesh& mesh, Random& random) {
    const Triangle t = mesh.triangle(random.below(mesh.faces.size()));
    switch (random.below(4)) {
    case 0:
        return t[0];
    case 1:
        return t[0] + 0.5 * (t[1] - t[0]);
    case 2:
        return t[0] + random.uniform(0, 1) * (t[1] - t[0]);
    default:
        return (t[0] + t[1] + t[2]) / 3.0;
    }
}

class Watertight : public testing::TestWithParam<double> {};

TEST_P(Watertight, NoRayLeavesAClosedMeshThroughEdgesOrVertices) {
    const dvec3 center(GetParam(), -0.7 * GetParam(), 0.3 * GetParam());
    const ClosedMesh mesh = sphere(3, center); // 512 faces
    uint64_t leaks = 0;
    for (uint64_t seed = 0; seed < 50000; ++seed) {
        Random random(seed);
        const dvec3 target = point_to_aim_at(mesh, random);
        const dvec3 org = center + random.in_cube(0.5); // inside: the faces lie beyond 0.95
        leaks += !meets(mesh, {org, 0, target - org});
    }
    EXPECT_EQ(leaks, 0u);
}

TEST_P(Watertight, NoRayFromOutsideSlipsThroughEdgesOrVerticesThatFaceIt) {
    const dvec3 center(GetParam(), -0.7 * GetParam(), 0.3 * GetParam());
    const ClosedMesh mesh = sphere(3, center);
    uint64_t leaks = 0;
    for (uint64_t seed = 0; seed < 50000; ++seed) {
        Random random(seed);
        const dvec3 target = point_to_aim_at(mesh, random);
        // Roughly along the normal, the ray is far from the silhouette, where a miss may be right.
        const dvec3 org = target + 4.0 * (target - center) + random.in_cube(1.5);
        leaks += !meets(mesh, {org, 0, target - org});
    }
    EXPECT_EQ(leaks, 0u);
}

TEST_P(Watertight, AxisParallelRaysThroughVerticesHit) {
    const dvec3 center(GetParam(), -0.7 * GetParam(), 0.3 * GetParam());
    const ClosedMesh mesh = sphere(3, center);
    for (int axis = 0; axis < 3; ++axis)
        for (double sign : {1.0, -1.0})
            for (const dvec3& vertex : mesh.vertices) {
                dvec3 dir(sign < 0 ? -0.0 : 0.0);
                dir[axis] = sign;
                if ((vertex - center)[axis] * sign > -0.3)
                    continue; // behind, or too near the silhouette
                dvec3 org = vertex;
                org[axis] -= 4 * sign;
                ASSERT_TRUE(meets(mesh, {org, 0, dir})) << axis << " " << sign;
            }
}

INSTANTIATE_TEST_SUITE_P(FarFromOrigin, Watertight, testing::Values(0.0, 1e3, 1e7),
                         [](const auto& at) { return "At" + std::to_string(int(at.param)); });

TEST(Intersect, GivesTAndBarycentrics) {
    const std::optional<Hit> hit = shoot({dvec3(0.25, 0.5, -2), 0, dvec3(0, 0, 4)}, kUnit);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, 0.5);
    EXPECT_EQ(hit->u, 0.25);
    EXPECT_EQ(hit->v, 0.5);
}

TEST(Intersect, SeesBothSides) {
    EXPECT_TRUE(shoot({dvec3(0.2, 0.2, 1), 0, dvec3(0, 0, -1)}, kUnit));
    EXPECT_TRUE(shoot({dvec3(0.2, 0.2, -1), 0, dvec3(0, 0, 1)}, kUnit));
}

TEST(Intersect, TMinAndTMaxAreInclusive) {
    const dvec3 org(0.25, 0.25, -1), dir(0, 0, 1);
    const double below = std::nextafter(1.0, 0.0), above = std::nextafter(1.0, 2.0);
    EXPECT_TRUE(shoot({org, 1, dir, 1}, kUnit));
    EXPECT_TRUE(shoot({org, 0, dir, 1}, kUnit));
    EXPECT_TRUE(shoot({org, 1, dir, kInf}, kUnit));
    EXPECT_FALSE(shoot({org, 0, dir, below}, kUnit));
    EXPECT_FALSE(shoot({org, above, dir, kInf}, kUnit));
    EXPECT_FALSE(shoot({org, 2, dir, 0}, kUnit));
}

TEST(Intersect, NegativeTCountsOnlyWhereAskedFor) {
    EXPECT_FALSE(shoot({dvec3(0.2, 0.2, 1), 0, dvec3(0, 0, 1)}, kUnit));
    const std::optional<Hit> behind = shoot({dvec3(0.2, 0.2, 1), -5, dvec3(0, 0, 1)}, kUnit);
    ASSERT_TRUE(behind);
    EXPECT_DOUBLE_EQ(behind->t, -1);
}

TEST(Intersect, SkipsOnlyTheTriangleItStartsOn) {
    const PreparedRay ray({dvec3(0.2, 0.2, 0), 0, dvec3(0, 0, 1)}, TriangleId{3, 7});
    EXPECT_FALSE(intersect(ray, kUnit, {3, 7}));
    EXPECT_TRUE(intersect(ray, kUnit, {3, 8}));
    EXPECT_TRUE(intersect(ray, kUnit, {7, 3}));
}

TEST(Intersect, NeverHitsEdgeOnDegenerateOrNonFiniteTriangles) {
    const struct {
        const char* name;
        Triangle triangle;
    } cases[] = {
        {"edge-on", {dvec3(0, -1, 1), dvec3(0, 1, 1), dvec3(0, 0, 5)}},
        {"a point on the ray", {dvec3(0, 0, 2), dvec3(0, 0, 2), dvec3(0, 0, 2)}},
        {"a line across the ray", {dvec3(-1, 0, 2), dvec3(0, 0, 2), dvec3(1, 0, 2)}},
        {"a line along the ray", {dvec3(0, 0, 1), dvec3(0, 0, 2), dvec3(0, 0, 3)}},
        {"NaN corner", {dvec3(-1, -1, 2), dvec3(1, -1, kNan), dvec3(0, 1, 2)}},
        {"all NaN", {dvec3(kNan), dvec3(kNan), dvec3(kNan)}},
        {"infinite corner", {dvec3(-1, -1, 2), dvec3(kInf, -1, 2), dvec3(0, 1, 2)}},
        {"infinitely deep", {dvec3(-1, -1, 2), dvec3(1, -1, 2), dvec3(0, 1, kInf)}},
    };
    for (const auto& c : cases)
        for (int turn = 0; turn < 3; ++turn) { // every corner in every place
            const Triangle t = {c.triangle[turn], c.triangle[(turn + 1) % 3],
                                c.triangle[(turn + 2) % 3]};
            const std::optional<Hit> hit = shoot({dvec3(0), 0, dvec3(0, 0, 1)}, t);
            EXPECT_TRUE(!hit || hit->t == kInf) << c.name << " t " << hit->t;
        }
}

TEST(Intersect, EdgesAndVerticesBelongToTheTriangle) {
    const dvec2 points[] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0, 0.5}, {0.5, 0.5}};
    for (const dvec2& p : points)
        EXPECT_TRUE(shoot({dvec3(p.x, p.y, -1), 0, dvec3(0, 0, 1)}, kUnit)) << p.x << " " << p.y;
    const double off =
        1e-17; // far below an ulp of the corners: differences are taken from the ray's origin
    EXPECT_FALSE(shoot({dvec3(-off, 0.5, -1), 0, dvec3(0, 0, 1)}, kUnit));
    EXPECT_FALSE(shoot({dvec3(0.5, -off, -1), 0, dvec3(0, 0, 1)}, kUnit));
}

TEST(Hit, TiesGoToTheSmallerMeshThenPrim) {
    const auto hit = [](double t, uint32_t mesh, uint32_t prim) {
        return Hit{t, 0, 0, {mesh, prim}};
    };
    EXPECT_TRUE(hit(1, 9, 9).nearer_than(hit(2, 0, 0)));
    EXPECT_TRUE(hit(1, 1, 9).nearer_than(hit(1, 2, 0)));
    EXPECT_TRUE(hit(1, 1, 3).nearer_than(hit(1, 1, 4)));
    EXPECT_FALSE(hit(1, 1, 3).nearer_than(hit(1, 1, 3)));
    EXPECT_TRUE(hit(kInf, 0, 0).nearer_than(Hit{}));
    EXPECT_FALSE(Hit{}.is_hit());
}

TEST(Ray, KnowsWhatNoTriangleCanBeAskedAbout) {
    const Ray good{dvec3(0), 0, dvec3(0, 0, 1)};
    EXPECT_TRUE(good.valid());
    EXPECT_TRUE((Ray{dvec3(0), 1, dvec3(0, -0.0, 1e-290), 1}.valid()));
    EXPECT_FALSE((Ray{dvec3(0), 1, dvec3(0, -0.0, 1e-310), 1}.valid()));
    EXPECT_FALSE((Ray{dvec3(0, kNan, 0), 0, dvec3(1)}.valid()));
    EXPECT_FALSE((Ray{dvec3(kInf, 0, 0), 0, dvec3(1)}.valid()));
    EXPECT_FALSE((Ray{dvec3(0), 0, dvec3(0, kNan, 1)}.valid()));
    EXPECT_FALSE((Ray{dvec3(0), 0, dvec3(0, kInf, 1)}.valid()));
    EXPECT_FALSE((Ray{dvec3(0), 0, dvec3(0, -0.0, 0)}.valid()));
    EXPECT_FALSE((Ray{dvec3(0), 2, dvec3(1), 1}.valid()));
    EXPECT_FALSE((Ray{dvec3(0), kNan, dvec3(1)}.valid()));
    EXPECT_FALSE((Ray{dvec3(0), 0, dvec3(1), kNan}.valid()));
}

// --- against exact arithmetic

using ExactVec = std::array<Rational, 3>;

ExactVec exact(const dvec3& v) {
    return {Rational(v.x), Rational(v.y), Rational(v.z)};
}
ExactVec operator-(const ExactVec& a, const ExactVec& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Rational dot(const ExactVec& a, const ExactVec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
ExactVec cross(const ExactVec& a, const ExactVec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct ExactHit {
    double t, u, v, w; // of the plane; inside when u, v, w >= 0
};

/// Returns the result of Möller and Trumbore's test without a rounding, up to the last conversion.
ExactHit exact_hit(const Ray& ray, const Triangle& triangle) {
    const ExactVec a = exact(triangle[0]), org = exact(ray.org), dir = exact(ray.dir);
    const ExactVec ab = exact(triangle[1]) - a, ac = exact(triangle[2]) - a;
    const ExactVec p = cross(dir, ac), s = org - a, q = cross(s, ab);
    const Rational det = dot(ab, p);
    const Rational u = dot(s, p) / det, v = dot(dir, q) / det, t = dot(ac, q) / det;
    return {double(t), double(u), double(v), double(Rational(1 - u - v))};
}

TEST(Intersect, AgreesWithExactArithmeticAwayFromEdges) {
    int hits = 0, misses = 0;
    for (uint64_t seed = 0; seed < 4000; ++seed) {
        Random random(seed);
        const dvec3 center = random.in_cube(seed % 4 == 0 ? 1e6 : 1);
        const double size = seed % 3 == 0 ? 1e-3 : 1;
        Triangle triangle;
        for (dvec3& corner : triangle)
            corner = center + random.in_cube(size);
        const dvec3 target = triangle[0] + random.uniform(-0.2, 1) * (triangle[1] - triangle[0]) +
                             random.uniform(-0.2, 1) * (triangle[2] - triangle[0]);
        const dvec3 org = center + random.in_cube(10);
        const Ray ray{org, 0, (target - org) * random.uniform(0.1, 10)};

        const ExactHit truth = exact_hit(ray, triangle);
        const double least = std::min({truth.u, truth.v, truth.w});
        // Corners and org are exact inputs. Only their differences round, by at most 10 / 1e-3 in
        // ratio to the triangle's own size.
        if (std::abs(least) < 1e-9 || std::abs(truth.t) < 1e-9)
            continue;
        const std::optional<Hit> hit = shoot(ray, triangle);
        ASSERT_EQ(hit.has_value(), least > 0 && truth.t > 0) << "seed " << seed;
        hits += hit.has_value();
        misses += !hit;
        if (!hit)
            continue;
        EXPECT_NEAR(hit->u, truth.u, 1e-8) << "seed " << seed;
        EXPECT_NEAR(hit->v, truth.v, 1e-8) << "seed " << seed;
        EXPECT_NEAR(hit->t / truth.t, 1, 1e-8) << "seed " << seed;
    }
    EXPECT_GT(hits, 1000);
    EXPECT_GT(misses, 1000);
}

/// Returns the part of [0, infinity) of a ray in a box, without rounding; nothing for a miss.
std::optional<std::pair<Rational, Rational>> exact_clip(const Ray& ray, const Box& box) {
    Rational enter = 0, exit = 0;
    bool bounded = false;
    for (int axis = 0; axis < 3; ++axis) {
        const Rational lo(box.lo[axis]), hi(box.hi[axis]), org(ray.org[axis]), dir(ray.dir[axis]);
        if (dir == 0) {
            if (org < lo || org > hi)
                return std::nullopt;
            continue;
        }
        Rational near = (lo - org) / dir, far = (hi - org) / dir;
        if (near > far)
            std::swap(near, far);
        enter = std::max(enter, near);
        exit = bounded ? std::min(exit, far) : far;
        bounded = true;
    }
    if (enter > exit)
        return std::nullopt;
    return std::pair{enter, exit};
}

double direction_component(Random& random) {
    const double tiny = std::numeric_limits<double>::denorm_min();
    const double sign = random.below(2) ? 1 : -1;
    switch (random.below(6)) {
    case 0:
        return sign * 0.0;
    case 1:
        return sign * tiny * double(random.below(1000));
    case 2:
        return sign * 1e-30;
    default:
        return random.uniform(-1, 1);
    }
}

TEST(Clip, NeverShortensTheRayForAnyDirection) {
    int crossed = 0;
    for (uint64_t seed = 0; seed < 20000; ++seed) {
        Random random(seed);
        Box box;
        box.add(random.in_cube(2));
        box.add(random.below(5) == 0 ? box.lo : random.in_cube(2)); // a fifth: a point
        Ray ray;
        for (int axis = 0; axis < 3; ++axis) {
            // The origin is often exactly on a face's plane, where 0 times infinity may come up.
            const size_t where = random.below(4);
            ray.org[axis] = where == 0   ? box.lo[axis]
                            : where == 1 ? box.hi[axis]
                                         : random.uniform(-3, 3);
            ray.dir[axis] = direction_component(random);
        }
        if (!ray.valid())
            continue;
        const auto truth = exact_clip(ray, box);
        // Beyond the largest double (a denormal direction) there is no t to compare with.
        if (!truth || truth->first > Rational(std::numeric_limits<double>::max()))
            continue;
        const PreparedRay prepared(ray);
        const Interval got = clip(prepared, box.padded(prepared.margin(box)), 0, kInf);
        ++crossed;
        ASSERT_FALSE(got.empty()) << "seed " << seed;
        ASSERT_TRUE(std::isfinite(got.enter)) << "seed " << seed;
        ASSERT_LE(Rational(got.enter), truth->first) << "seed " << seed;
        ASSERT_TRUE(got.exit == kInf || Rational(got.exit) >= truth->second) << "seed " << seed;
    }
    EXPECT_GT(crossed, 2000);
}

TEST(Clip, MissesABoxBesideOrBehindTheRay) {
    const Box box{dvec3(-1), dvec3(1)};
    const auto misses = [&](dvec3 org, dvec3 dir) {
        return clip(PreparedRay({org, 0, dir}), box, 0, kInf).empty();
    };
    EXPECT_TRUE(misses(dvec3(0, 0, 2), dvec3(0, 0, 1)));
    EXPECT_TRUE(misses(dvec3(2, 0, -5), dvec3(0, 0, 1)));
    EXPECT_TRUE(misses(dvec3(2, 0, -5), dvec3(-0.0, 0, 1)));
    EXPECT_TRUE(misses(dvec3(2, 0, -5), dvec3(1e-310, 0, 1)));
    EXPECT_FALSE(misses(dvec3(1, 1, -5), dvec3(0, -0.0, 1)));
}

TEST(Clip, KeepsToTheIntervalItWasGiven) {
    const Box box{dvec3(-1), dvec3(1)};
    const PreparedRay ray({dvec3(0, 0, -3), 0, dvec3(0, 0, 1)});
    const Interval all = clip(ray, box, 0, kInf);
    EXPECT_EQ(all.enter, 2);
    EXPECT_EQ(all.exit, 4);
    const Interval part = clip(ray, box, 2.5, 3.5);
    EXPECT_EQ(part.enter, 2.5);
    EXPECT_EQ(part.exit, 3.5);
    EXPECT_TRUE(clip(ray, box, 5, 6).empty());
}

} // namespace
} // namespace ovc
