// SPDX-License-Identifier: Apache-2.0
// Tests that Bsdf sends on no more light than arrives, both ways alike, and chooses directions by
// its density; and the values of Fresnel's equations.
#include "host/shade/surface/bsdf.h"

#include "core/fresnel.h"
#include "host/shade/path_sampler.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace ovc {
namespace {

using std::numbers::pi;
using Boundary = Optics::Boundary;

struct BsdfCase {
    std::string name;
    Material material;
};

Material with_optics(Boundary boundary, const vec3& diffuse, const vec3& reflection, float width,
                     const vec3& through = vec3(0), double ior = 1.5) {
    Material m;
    Optics optics;
    optics.diffuse = diffuse;
    optics.boundary = boundary;
    optics.reflection = reflection;
    optics.width = width;
    optics.through = through;
    optics.ior = ior;
    m.ior = boundary == Boundary::Dielectric ? ior : 1;
    m.optics = optics;
    return m;
}

Material with_finish(const Finish& finish, const vec3& color = vec3(1)) {
    Material m;
    m.color = color;
    m.finish = finish;
    return m;
}

std::vector<BsdfCase> scattering() {
    Finish phong;
    phong.diffuse = 0.6f;
    phong.phong = 0.8f;
    Finish metal;
    metal.diffuse = 0.3f;
    metal.specular = 3;
    metal.roughness = 0.02f;
    metal.metallic = 1;
    return {{"matte", with_optics(Boundary::None, vec3(1), vec3(0), 0)},
            {"plastic", with_optics(Boundary::Dielectric, {1, 0.5f, 0}, vec3(1), 0.3f)},
            {"sharp plastic", with_optics(Boundary::Dielectric, vec3(1), vec3(1), 0.02f)},
            {"smooth plastic", with_optics(Boundary::Dielectric, vec3(1), vec3(1), 0)},
            {"dull plastic", with_optics(Boundary::Dielectric, vec3(0.4f), vec3(0.25f), 1)},
            {"metal", with_optics(Boundary::Metal, vec3(0), {1, 0.7f, 0.3f}, 0.2f)},
            {"rough metal", with_optics(Boundary::Metal, vec3(0), vec3(1), 0.9f)},
            {"phong", with_finish(phong)},
            {"POV-Ray's metal", with_finish(metal, {1, 0.8f, 0.2f})}};
}

SurfacePoint seen_from(const Material& material, const dvec3& towards_viewer,
                       bool entering = true) {
    SurfacePoint s;
    s.position = s.beyond = dvec3(0);
    s.geometric_normal = s.normal = glm::normalize(dvec3(1, 2, -3));
    s.view = -towards_viewer;
    s.material = &material;
    s.color = material.color;
    s.entering = entering;
    return s;
}

/// Returns a direction by its cosine to the normal of seen_from(), and its angle around it.
dvec3 way(double cosine, double phi) {
    const dvec3 n = glm::normalize(dvec3(1, 2, -3));
    const dvec3 x = glm::normalize(glm::cross(n, dvec3(0, 0, 1))), y = glm::cross(n, x);
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
    return glm::normalize(cosine * n + sine * (std::cos(phi) * x + std::sin(phi) * y));
}

constexpr double kCosines[] = {0.02, 0.3, 0.7, 0.999};

/// Integrates over all directions above a surface, in cells of one size.
constexpr int kRings = 600, kSectors = 900;
template <class Function>
auto integral(Function&& of) {
    decltype(of(dvec3())) sum(0);
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j)
            sum += of(way((i + 0.5) / kRings, 2 * pi * (j + 0.5) / kSectors));
    return sum * decltype(sum)(2 * pi / (kRings * kSectors));
}

TEST(Fresnel, HasItsKnownValues) {
    EXPECT_NEAR(fresnel(1, 1.5), 0.04, 1e-15);
    EXPECT_NEAR(fresnel(1, 1 / 1.5), 0.04, 1e-15);
    EXPECT_NEAR(fresnel(1, 2.4), 1.96 / 11.56, 1e-15);
    EXPECT_EQ(fresnel(0, 1.5), 1);
    EXPECT_EQ(fresnel(0.5, 1), 0) << "no boundary";
    // At Brewster's angle one polarisation passes; the other is reflected by the square of the sine
    // of the angles' difference.
    const double angle = std::atan(1.5);
    const double s = std::sin(2 * angle - pi / 2);
    EXPECT_NEAR(fresnel(std::cos(angle), 1.5), 0.5 * s * s, 1e-15);
    const double critical = std::asin(1 / 1.5);
    EXPECT_EQ(fresnel(std::cos(critical + 1e-6), 1 / 1.5), 1);
    EXPECT_LT(fresnel(std::cos(critical - 1e-6), 1 / 1.5), 1);
    // The share is the same on the way back.
    for (const double cosine : kCosines) {
        const double below = std::sqrt(1 - (1 - cosine * cosine) / (1.5 * 1.5));
        EXPECT_NEAR(fresnel(cosine, 1.5), fresnel(below, 1 / 1.5), 1e-12);
    }
}

TEST(Fresnel, MeanIsThatOverAllDirections) {
    for (const double ior : {1.00001, 1.001, 1.1, 1.33, 1.5, 2.4, 10.0, 1 / 1.33, 1 / 2.4}) {
        constexpr int kSteps = 200000;
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double cosine = (i + 0.5) / kSteps;
            sum += 2 * cosine * fresnel(cosine, ior) / kSteps;
        }
        EXPECT_NEAR(fresnel_mean(ior), sum, 1e-5) << ior;
    }
    EXPECT_EQ(fresnel_mean(1), 0);
}

/// A surface reflects a white sky: matte white all of it, no surface more.
TEST(Bsdf, SendsOnNoMoreThanArrives) {
    for (const BsdfCase& test : scattering())
        for (const double cosine : kCosines) {
            const Bsdf bsdf(seen_from(test.material, way(cosine, 1)));
            constexpr uint32_t kCount = 1 << 14;
            dvec3 sum(0);
            for (uint32_t i = 0; i < kCount; ++i) {
                const PathSampler random(1, 2, i);
                if (const auto s = bsdf.sample(random.pair(0).x, random.pair(1)))
                    sum += dvec3(s->weight) / double(kCount);
            }
            SCOPED_TRACE(test.name + fmt::format(" at {}", cosine));
            EXPECT_LT(max_component(sum), 1.005);
            if (test.name == "matte" || test.name == "smooth plastic") {
                EXPECT_NEAR(sum.x, 1, 0.005) << "white keeps all";
            }
            if (test.name == "sharp plastic" && cosine > 0.2) {
                EXPECT_NEAR(sum.x, 1, 0.02);
            }
        }
}

/// The coat throws 0.596 of the light from below back: 1 - (1 - 0.0918) / 1.5^2. Of that, a ground
/// that reflects a half loses a half each time.
TEST(Bsdf, LightGoesToAndFroBelowACoat) {
    Material m = with_optics(Boundary::Dielectric, vec3(0.5f), vec3(1), 0);
    m.optics->internal_reflection = true;
    const dvec3 view = way(0.7, 1);
    const Bsdf bsdf(seen_from(m, view));
    const double sum = integral([&](const dvec3& d) { return bsdf.evaluate(d); }).x;
    const double ground = 0.5 * 0.4036 / (1 - 0.5 * 0.5964);
    EXPECT_NEAR(sum, ground * (1 - fresnel(0.7, 1.5)), 1e-3);
    m.texture = PlacedTexture{}; // its color is the ground's as well
    SurfacePoint at = seen_from(m, view);
    at.color = vec3(0.5f);
    m.optics->diffuse = vec3(0);
    const Bsdf textured(at);
    EXPECT_EQ(textured.evaluate(view), bsdf.evaluate(view));
}

TEST(Bsdf, IsTheSameBothWays) {
    for (const BsdfCase& test : scattering()) {
        if (test.material.finish)
            continue; // POV-Ray's mirror, highlight and tint depend on the viewer's angle alone
        for (const double a : kCosines)
            for (const double b : kCosines)
                for (const double phi : {0.1, 1.0, 3.0}) {
                    const dvec3 from = way(a, 0), to = way(b, phi);
                    const vec3 there = Bsdf(seen_from(test.material, from)).evaluate(to);
                    const vec3 back = Bsdf(seen_from(test.material, to)).evaluate(from);
                    for (int c = 0; c < 3; ++c)
                        EXPECT_NEAR(there[c] * a, back[c] * b, 1e-4 * (1e-3 + back[c] * b))
                            << test.name << " " << a << " " << b;
                }
    }
}

/// The density adds up to the share of samples that are not mirrored and do not end below the
/// surface. A chi-square test compares the number of samples in each cell with it.
TEST(Bsdf, ChoosesDirectionsAsItsDensitySays) {
    constexpr int kCells = 8, kTurns = 12;
    constexpr uint32_t kCount = 1 << 16;
    for (const BsdfCase& test : scattering())
        for (const double cosine : {0.3, 0.7, 0.999}) {
            const Bsdf bsdf(seen_from(test.material, way(cosine, 1)));
            const dvec3 n = glm::normalize(dvec3(1, 2, -3));
            const dvec3 x = glm::normalize(glm::cross(n, dvec3(0, 0, 1))), y = glm::cross(n, x);
            const auto cell = [&](const dvec3& d) {
                const double phi = std::atan2(glm::dot(d, y), glm::dot(d, x)) / (2 * pi) + 0.5;
                const int ring = std::min(int(glm::dot(d, n) * kCells), kCells - 1);
                return ring * kTurns + std::min(int(phi * kTurns), kTurns - 1);
            };
            std::vector<double> expected(kCells * kTurns), found(kCells * kTurns);
            const double total = integral([&](const dvec3& d) {
                const double density = bsdf.density(d);
                expected[size_t(cell(d))] += density * 2 * pi / (kRings * kSectors);
                return density;
            });
            double above = 0;
            for (uint32_t i = 0; i < kCount; ++i) {
                const PathSampler random(i, 5, 0); // chi-square needs independent samples
                const auto s = bsdf.sample(random.pair(0).x, random.pair(1));
                if (!s || s->way == Scattering::Mirror)
                    continue;
                above += 1.0 / kCount;
                found[size_t(cell(s->direction))] += 1;
                EXPECT_NEAR(s->density, bsdf.density(s->direction), 1e-6 * s->density);
            }
            SCOPED_TRACE(test.name + fmt::format(" at {}", cosine));
            const bool is_sharp = test.name == "sharp plastic"; // narrower than the cells
            EXPECT_NEAR(total, above, is_sharp ? 0.02 : 0.01);
            double chi_square = 0;
            int cells = 0;
            for (size_t i = 0; i < expected.size(); ++i)
                if (const double e = expected[i] * kCount; e > 20) {
                    chi_square += (found[i] - e) * (found[i] - e) / e;
                    ++cells;
                }
            // A chi-square of n degrees has variance 2 n; the limit is five sigma.
            if (!is_sharp) {
                EXPECT_LT(chi_square, cells + 5 * std::sqrt(2.0 * cells)) << cells << " cells";
            }
        }
}

/// Returns a surface seen from this side of it, by a cosine and an angle as way() has them.
SurfacePoint seen_from_inside(const Material& material, double cosine, double phi) {
    SurfacePoint s = seen_from(material, -way(cosine, phi), /* entering= */ false);
    s.geometric_normal = s.normal = -s.normal;
    return s;
}

/// Frosted glass and a leaf, from the outside and from the inside.
std::vector<std::pair<std::string, SurfacePoint>> letting_through(double cosine) {
    static const Material frosted =
        with_optics(Boundary::Dielectric, vec3(0), vec3(1), 0.4f, vec3(1, 0.5f, 1));
    static const Material leaf = [] {
        Material m = with_optics(Boundary::None, vec3(0.2f), vec3(0), 0);
        m.optics->diffuse_behind = vec3(0.6f);
        return m;
    }();
    return {{"frosted", seen_from(frosted, way(cosine, 1))},
            {"frosted, from inside", seen_from_inside(frosted, cosine, 1)},
            {"leaf", seen_from(leaf, way(cosine, 1))},
            {"leaf, from inside", seen_from_inside(leaf, cosine, 1)}};
}

/// Radiance falls by the square of the index, so that f / index^2 is the same both ways.
TEST(Bsdf, FacetsRefractTheSameBothWays) {
    const Material frosted = with_optics(Boundary::Dielectric, vec3(0), vec3(1), 0.4f, vec3(1));
    int met = 0;
    for (const double a : kCosines)
        for (const double b : kCosines)
            for (const double phi : {0.1, 1.0, 3.0}) {
                const vec3 in = Bsdf(seen_from(frosted, way(a, 0))).evaluate(-way(b, phi));
                const vec3 out = Bsdf(seen_from_inside(frosted, b, phi)).evaluate(way(a, 0));
                EXPECT_NEAR(in.x * a * 1.5 * 1.5, out.x * b, 1e-4 * (1e-3 + out.x * b))
                    << a << " " << b << " " << phi;
                met += in.x > 0;
            }
    EXPECT_GT(met, 10);
}

TEST(Bsdf, SendsLightThroughAsItsDensitySays) {
    for (const double cosine : {0.3, 0.9})
        for (const auto& [name, surface] : letting_through(cosine)) {
            SCOPED_TRACE(name + fmt::format(" at {}", cosine));
            const Bsdf bsdf(surface);
            const double side = surface.entering ? -1 : 1; // of the other side of the surface
            const vec3 expected = integral([&](const dvec3& d) { return bsdf.evaluate(side * d); });
            const double density = integral([&](const dvec3& d) { return bsdf.density(side * d); });
            constexpr uint32_t kCount = 1 << 16;
            dvec3 sum(0);
            double share = 0, flux = 0;
            for (uint32_t i = 0; i < kCount; ++i) {
                const PathSampler random(i, 5, 0);
                const auto s = bsdf.sample(random.pair(0).x, random.pair(1));
                if (!s)
                    continue;
                EXPECT_NEAR(s->density, bsdf.density(s->direction), 1e-6 * s->density);
                const bool is_through = glm::dot(s->direction, surface.normal) < 0;
                const double index = name[0] != 'f' ? 1 : surface.entering ? 1.5 : 1 / 1.5;
                flux += double(s->weight.x) * (is_through ? index * index : 1) / kCount;
                sum += is_through ? dvec3(s->weight) / double(kCount) : dvec3(0);
                share += is_through ? 1.0 / kCount : 0;
            }
            EXPECT_NEAR(density, share, 0.01);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(sum[c], expected[c], 0.015 * (1 + expected[c]));
            EXPECT_LT(flux, 1.01);
            EXPECT_GT(flux, name[0] == 'l' ? 0.79 : 0.65) << "facets hide some light";
        }
}

/// The mean weight of samples is the integral of evaluate().
TEST(Bsdf, WeighsWhatItChooses) {
    for (const BsdfCase& test : scattering()) {
        if (test.name == "sharp plastic")
            continue;
        const Bsdf bsdf(seen_from(test.material, way(0.6, 1)));
        const vec3 whole = integral([&](const dvec3& d) { return bsdf.evaluate(d); });
        constexpr uint32_t kCount = 1 << 14;
        dvec3 sum(0);
        for (uint32_t i = 0; i < kCount; ++i) {
            const PathSampler random(3, 4, i);
            const auto s = bsdf.sample(random.pair(0).x, random.pair(1));
            if (s && s->density > 0)
                sum += dvec3(s->weight) / double(kCount);
        }
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sum[c], whole[c], 0.01) << test.name;
    }
}

TEST(Bsdf, GlassSharesOutAsFresnelSays) {
    const Material glass =
        with_optics(Boundary::Dielectric, vec3(0), vec3(1), 0, {1, 0.5f, 0.25f}, 1.5);
    for (const double cosine : kCosines) {
        const double share = fresnel(cosine, 1.5);
        double mirrored = 0;
        vec3 through(0);
        constexpr uint32_t kCount = 1 << 12;
        const Bsdf bsdf(seen_from(glass, way(cosine, 1)));
        for (uint32_t i = 0; i < kCount; ++i) {
            const auto s = bsdf.sample((i + 0.5) / kCount, dvec2(0.5));
            ASSERT_TRUE(s);
            EXPECT_EQ(s->density, 0);
            if (s->way == Scattering::Mirror)
                mirrored += double(s->weight.x) / kCount;
            else
                through += s->weight / float(kCount);
        }
        EXPECT_NEAR(mirrored, share, 1e-3);
        // Radiance in glass is denser by the square of the index.
        EXPECT_NEAR(through.x, (1 - share) / 2.25, 1e-3);
        EXPECT_NEAR(through.z, (1 - share) / 2.25 / 4, 1e-3);
    }
    const Bsdf inside(seen_from(glass, way(0.3, 1), /* entering= */ false));
    EXPECT_EQ(inside.through(), vec3(0)) << "reflected totally";
    EXPECT_EQ(inside.sample(0.9, dvec2(0.5))->weight, vec3(1));
    const Bsdf leaving(seen_from(glass, way(1, 1), /* entering= */ false));
    EXPECT_EQ(leaving.sample(0.99, dvec2(0.5))->way, Scattering::Through);
    EXPECT_NEAR(leaving.through().x, 0.96f, 1e-6f);
}

/// Of half glass and half white paint all light goes on, from inside as well.
TEST(Bsdf, GlassBesidePaintLosesNothing) {
    const Material m = with_optics(Boundary::Dielectric, vec3(0.5f), vec3(0.5f), 0, vec3(0.5f));
    for (const bool entering : {true, false})
        for (const double cosine : kCosines) {
            const Bsdf bsdf(seen_from(m, way(cosine, 1), entering));
            const double mirrored = 0.5 * fresnel(cosine, entering ? 1.5 : 1 / 1.5);
            const double scattered = integral([&](const dvec3& d) { return bsdf.evaluate(d); }).x;
            EXPECT_NEAR(mirrored + double(bsdf.through().x) + scattered, 1, 1e-3) << cosine;
        }
}

TEST(Bsdf, ATextureHasTheShareThatIsLeft) {
    Material m = with_optics(Boundary::None, vec3(0), vec3(0), 0, vec3(0.75f));
    m.texture = PlacedTexture{};
    m.transmission = 0.75f;
    SurfacePoint seen = seen_from(m, way(1, 0));
    seen.color = {1, 0.5f, 0};
    EXPECT_EQ(Bsdf(seen).albedo(), vec3(1, 0.875f, 0.75f));
    m.finish.emplace(); // its parts are added up
    EXPECT_EQ(Bsdf(seen).evaluate(way(1, 0)), seen.color * float(std::numbers::inv_pi));
}

TEST(Bsdf, APaneReflectsWithBothItsSides) {
    const Material pane = with_optics(Boundary::Thin, vec3(0), vec3(1), 0, vec3(1), 1.5);
    const Bsdf bsdf(seen_from(pane, way(1, 0)));
    // R + T R T + T R R R T + ...: 2 R / (1 + R).
    EXPECT_NEAR(bsdf.through().x, 1 - 0.08 / 1.04, 1e-6);
    EXPECT_TRUE(bsdf.is_straight());
}

/// A third glows in red; two thirds are green paint with a highlight.
TEST(Bsdf, CoatsHaveFinishesOfTheirOwn) {
    Finish glow, paint;
    glow.ambient = vec3(1);
    glow.diffuse = 0;
    paint.diffuse = 0.6f;
    paint.phong = 0.3f;
    const Material red = with_finish(glow, {1, 0, 0}), green = with_finish(paint, {0, 1, 0});
    SurfacePoint mixed = seen_from(red, way(1, 0));
    mixed.coats = {{seen_from(red, way(1, 0)), vec3(1 / 3.0f)},
                   {seen_from(green, way(1, 0)), vec3(2 / 3.0f)}};
    const Bsdf bsdf(mixed), alone(seen_from(green, way(1, 0)));
    EXPECT_EQ(bsdf.emission(), vec3(1 / 3.0f, 0, 0));
    for (const double cosine : kCosines) {
        const vec3 found = bsdf.evaluate(way(cosine, 2)), whole = alone.evaluate(way(cosine, 2));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], 2 / 3.0f * whole[c], 1e-5f * (1 + whole[c])) << cosine;
    }
}

TEST(Bsdf, EmitsFromItsFrontUnlessItHasTwo) {
    Material lamp = with_optics(Boundary::None, vec3(0), vec3(0), 0);
    lamp.optics->emission = vec3(3);
    EXPECT_EQ(Bsdf(seen_from(lamp, way(1, 0))).emission(), vec3(3));
    EXPECT_EQ(Bsdf(seen_from(lamp, way(1, 0), false)).emission(), vec3(0));
    lamp.optics->two_sided = true;
    EXPECT_EQ(Bsdf(seen_from(lamp, way(1, 0), false)).emission(), vec3(3));
    EXPECT_FALSE(Bsdf(seen_from(lamp, way(1, 0))).sample(0.5, dvec2(0.5)));

    Finish finish;
    finish.ambient = vec3(0.5f);
    const Material matte = with_finish(finish, {1, 0.5f, 0});
    EXPECT_EQ(Bsdf(seen_from(matte, way(1, 0))).emission(), vec3(0)) << "stands for other light";
    finish.emission = vec3(0.25f);
    const Material both = with_finish(finish, {1, 0.5f, 0});
    EXPECT_EQ(Bsdf(seen_from(both, way(1, 0))).emission(), vec3(0.25f, 0.125f, 0));
    finish.diffuse = 0;
    const Material glowing = with_finish(finish, {1, 0.5f, 0});
    EXPECT_EQ(Bsdf(seen_from(glowing, way(1, 0))).emission(), vec3(0.5f, 0.25f, 0));
}

} // namespace
} // namespace ovc
