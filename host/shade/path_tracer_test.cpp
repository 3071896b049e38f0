// SPDX-License-Identifier: Apache-2.0
// Tests PathTracer against formulas: furnaces, a lamp over a floor, points, mirrors, glass and
// panes; and its ways to find light against each other.
#include "host/shade/path_tracer.h"

#include "core/fresnel.h"
#include "host/camera/camera_rays.h"
#include "host/render/render.h"
#include "host/render/render_batched.h"
#include "host/render/test_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace ovc {
namespace {

using std::numbers::pi;
using Boundary = Optics::Boundary;

Material optical(const Optics& optics) {
    Material m;
    m.optics = optics;
    if (optics.boundary == Boundary::Dielectric)
        m.ior = optics.ior;
    return m;
}

Material matte(const vec3& diffuse) {
    return optical({.diffuse = diffuse});
}

Material lamp(const vec3& radiance) {
    return optical({.emission = radiance});
}

Material glass(double ior = 1.5) {
    return optical({.boundary = Boundary::Dielectric, .through = vec3(1), .ior = ior});
}

Scene dark() {
    Scene scene;
    scene.background = {vec3(0), vec3(0)};
    return scene;
}

/// Adds a square at this height with this half width, whose front is above (up) or below.
void add_level(Scene& scene, const Material& material, double y, double half, bool up) {
    scene.materials.push_back(material);
    const dvec3 a(-half, y, -half), b(-half, y, half), c(half, y, half), d(half, y, -half);
    scene.add_mesh("level", uint32_t(scene.materials.size() - 1),
                   up ? quad(a, b, c, d) : quad(d, c, b, a));
}

/// Returns a camera with so narrow a view that all its pixels show one point.
Camera at_point(dvec3 eye, dvec3 target) {
    Camera camera;
    camera.eye = eye;
    camera.target = target;
    camera.up = {0.1, 0.2, 1};
    camera.fov_degrees = 1e-4;
    return camera;
}

/// The mean of pixels that show the same.
struct Estimate {
    double mean = 0;
    double sigma = 0; // of the mean
};

/// Estimates the second channel from 24 x 24 pixels.
Estimate estimate(const Scene& scene, const Camera& camera, uint32_t samples,
                  const PathTracerOptions& options = {}) {
    Film film(24, 24, samples);
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    const Pinhole pinhole(camera, film.width(), film.height());
    const PathTracer tracer(scene, vec3(0, 1, 0), options);
    const auto report = render_batched({tracer, CameraRays(pinhole, film), Sight(scene), {}, film},
                                       *backend, size_t(1) << 16);
    EXPECT_TRUE(report && report->complete);
    const Image image = film.image();
    const double count = double(image.pixels.size());
    double sum = 0, squares = 0;
    for (const vec4& pixel : image.pixels) {
        sum += double(pixel.g);
        squares += double(pixel.g) * double(pixel.g);
    }
    const double mean = sum / count;
    return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / (count - 1))};
}

/// Allows five sigma, which may be at most 2 % of the expected value, or the test would be void.
void expect_mean(const Estimate& found, double expected, const char* what) {
    EXPECT_LT(found.sigma, 0.004 * expected + 1e-9) << what;
    EXPECT_NEAR(found.mean, expected, 5 * found.sigma + 1e-5 * expected) << what;
}

void expect_alike(const Estimate& a, const Estimate& b, const char* what) {
    const double sigma = std::hypot(a.sigma, b.sigma);
    EXPECT_LT(sigma, 0.02 * a.mean) << what;
    EXPECT_NEAR(a.mean, b.mean, 5 * sigma) << what << ", sigma " << sigma;
}

/// The camera sees 0.8 directly; after one bounce it is 0.4, after two 0.2.
TEST(PathTracer, ClampBoundsLightThatOtherSurfacesScatterAndNothingElse) {
    Scene scene = dark();
    add_box(scene, optical({.diffuse = vec3(0.5f), .emission = vec3(0.8f)}), dvec3(-1), dvec3(1),
            /* outside= */ false);
    PathTracerOptions options{.max_depth = 2, .search = LightSearch::Paths};
    const Camera camera = at_point(dvec3(0), {1, 0, 0});
    for (const auto& [clamp, expected] :
         {std::pair(0.0f, 1.4), std::pair(0.5f, 1.4), std::pair(0.3f, 1.3), std::pair(0.1f, 1.0)}) {
        options.clamp = clamp;
        EXPECT_NEAR(estimate(scene, camera, 2, options).mean, expected, 1e-5) << clamp;
    }
}

TEST(PathTracer, AFurnaceGlowsAsTheSeriesOfItsBouncesSays) {
    for (const float albedo : {0.0f, 0.5f, 0.8f}) {
        Scene scene = dark();
        add_box(scene, optical({.diffuse = vec3(albedo), .emission = vec3(0.7f)}), dvec3(-1),
                dvec3(1, 2, 1.5), /* outside= */ false);
        PathTracerOptions options;
        options.max_depth = 200;
        expect_mean(estimate(scene, at_point(dvec3(0), {0.3, 2, 0.4}), 64, options),
                    0.7 / (1 - double(albedo)), "the bounces of light add up to e / (1 - a)");
    }
}

TEST(PathTracer, ASkyLightsWhatItSees) {
    Scene scene = dark();
    scene.background = {vec3(2), vec3(2)};
    add_level(scene, matte(vec3(0.6f)), 0, 5, true);
    expect_mean(estimate(scene, at_point({1, 4, 0}, dvec3(0)), 16), 0.6 * 2, "albedo x sky");
    expect_mean(estimate(scene, at_point({1, 4, 0}, {1, 9, 0}), 1), 2, "seen itself");
}

/// Returns Lambert's form factor from a level to a square lamp of half width s at height h above
/// it.
double form_factor(double s, double h) {
    const double a = s / h, r = std::sqrt(1 + a * a);
    return 4 * (2 * a / r * std::atan(a / r)) / (2 * pi);
}

TEST(PathTracer, ALampLightsAFloorByItsFormFactor) {
    Scene scene = dark();
    add_level(scene, matte(vec3(0.5f)), 0, 3, true);
    add_level(scene, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
    const Camera camera = at_point({2, 1, 0}, dvec3(0));
    const double expected = 0.5 * 4 * form_factor(0.8, 1.5);
    for (const LightSearch search :
         {LightSearch::Both, LightSearch::ShadowRays, LightSearch::Paths}) {
        PathTracerOptions options;
        options.search = search;
        expect_mean(estimate(scene, camera, search == LightSearch::Paths ? 256 : 64, options),
                    expected, "albedo x radiance x form factor");
    }
    scene.materials[1] = lamp(vec3(4));
    scene.soup.chunks[1] =
        quad({-0.8, 1.5, -0.8}, {-0.8, 1.5, 0.8}, {0.8, 1.5, 0.8}, {0.8, 1.5, -0.8});
    EXPECT_EQ(estimate(scene, camera, 4).mean, 0) << "its back is dark";
    scene.materials[1].optics->two_sided = true;
    expect_mean(estimate(scene, camera, 64), expected, "its back shines too");
}

TEST(PathTracer, ALampWithHolesShinesWhereThereIsSome) {
    Scene scene = dark();
    add_level(scene, matte(vec3(0.5f)), 0, 3, true);
    add_level(scene, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
    scene.cutouts = {{.width = 1, .height = 1, .opacity = {255}, .scale = 0.75f, .partial = true}};
    scene.meshes[1].cutout = 0;
    scene.meshes[1].uv.assign(6, vec2(0.5f));
    expect_mean(estimate(scene, at_point({2, 1, 0}, dvec3(0)), 64),
                0.75 * 0.5 * 4 * form_factor(0.8, 1.5), "three quarters of its light");
    PathTracerOptions options;
    options.search = LightSearch::ShadowRays;
    expect_mean(estimate(scene, at_point({2, 1, 0}, dvec3(0)), 64, options),
                0.75 * 0.5 * 4 * form_factor(0.8, 1.5), "and of shadow rays");
}

/// A picture: the half of it at s < 0.5 shines.
class ShinesAtTheLeft final : public ImageLookup {
public:
    vec4 color(const PictureArea& area) const override {
        return vec4(vec3(area.st.x < 0.5 ? 1.0f : 0.0f), 1);
    }
    dvec2 size() const override { return dvec2(2); }
    bool has_opacity() const override { return false; }
};

TEST(PathTracer, ALampMayShineLikeAPicture) {
    static const ShinesAtTheLeft lookup;
    Scene scene = dark();
    add_level(scene, matte(vec3(0.5f)), 0, 3, true);
    add_level(scene, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
    scene.textures.push_back(
        {.kind = TextureKind::Image,
         .on_uv = true,
         .image = ImageTexture{.filter = TexelFilter::Nearest, .lookup = &lookup}});
    scene.materials[1].maps = MaterialMaps{.emission = 0};
    const Chunk& chunk = scene.soup.chunks[1];
    for (uint32_t t = 0; t < 2; ++t)
        for (const dvec3& corner : chunk.triangle(t))
            scene.meshes[1].uv.push_back(vec2(corner.x / 1.6 + 0.5, 0));
    const double expected = 0.5 * 0.5 * 4 * form_factor(0.8, 1.5); // by symmetry
    for (const LightSearch search :
         {LightSearch::Both, LightSearch::ShadowRays, LightSearch::Paths}) {
        PathTracerOptions options;
        options.search = search;
        expect_mean(estimate(scene, at_point({2, 1, 0}, dvec3(0)),
                             search == LightSearch::Paths ? 512 : 128, options),
                    expected, "half of a lamp");
    }
}

TEST(PathTracer, OfAMixtureEachMaterialHasItsShare) {
    Scene scene;
    scene.background = {vec3(1), vec3(1)};
    add_level(scene, optical({.boundary = Boundary::Mirror, .reflection = vec3(0.8f)}), 0, 3, true);
    scene.materials.push_back(optical({.boundary = Boundary::Metal, .reflection = vec3(0)}));
    Material mixed = scene.materials[0];
    scene.textures.push_back({.stops = {{0.25, {}, 0}, {0.75, {}, 1}}});
    scene.textures[0].pattern.kind = Pattern::Kind::Average;
    mixed.mix = PlacedTexture{};
    scene.materials.push_back(mixed);
    scene.meshes[0].material = 2;
    expect_mean(estimate(scene, at_point({0, 1, 0.01}, dvec3(0)), 1024), 0.2,
                "a quarter reflects 0.8, and the rest nothing");
}

/// Shadow rays alone find its light, so that they count in full.
TEST(PathTracer, ALampThatNoRaySeesShinesAlike) {
    Scene scene = dark();
    add_level(scene, matte(vec3(0.5f)), 0, 3, true);
    add_level(scene, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
    scene.show(1, kSeenByNone);
    const double expected = 0.5 * 4 * form_factor(0.8, 1.5);
    expect_mean(estimate(scene, at_point({2, 1, 0}, dvec3(0)), 64), expected, "none of it is lost");
    EXPECT_EQ(estimate(scene, at_point({0, 1, 0}, {0, 9, 0}), 4).mean, 0) << "not seen";
}

/// Behind 2 of glass that keeps a share of exp(-(1 - color) x way / distance).
TEST(PathTracer, GlassKeepsLightAsItsAbsorptionSays) {
    Scene scene = dark();
    scene.background = {vec3(1), vec3(1)};
    Material tinted;
    tinted.color = vec3(0);
    tinted.transmission = 1;
    tinted.finish = Finish{.diffuse = 0};
    tinted.absorption = Absorption{.distance = 4, .power = 1000, .color = vec3(0, 0.5f, 1)};
    add_box(scene, tinted, dvec3(-1), dvec3(1), /* outside= */ true);
    EXPECT_NEAR(estimate(scene, at_point({0, 0, 5}, dvec3(0)), 1).mean, std::exp(-0.25), 1e-3);
}

TEST(PathTracer, TellsWhatItLeavesOut) {
    Scene scene = dark();
    std::string said;
    const LogSink log = [&](LogLevel, const std::string& sentence) { said += sentence; };
    scene.materials.emplace_back().finish = Finish{.diffuse = 1, .brilliance = 2, .irid = 0.1f};
    scene.materials.push_back(scene.materials.back());
    scene.materials.back().finish->irid = 0;
    scene.materials.back().media.emplace_back();
    scene.materials.push_back(scene.materials.back());
    scene.materials.back().optics.emplace();
    tell_what_paths_leave_out(scene, "a.pov", log);
    EXPECT_EQ(said, "a.pov: --integrator path leaves out media (2), irid (1), brilliance (2)");
    scene = dark();
    said = "";
    tell_what_paths_leave_out(scene, "a.pov", log);
    EXPECT_EQ(said, "");
}

TEST(PathTracer, DepthCountsTheSurfacesThatAPathLeaves) {
    Scene scene = dark();
    add_level(scene, matte(vec3(0.5f)), 0, 3, true);
    add_level(scene, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
    const Camera at_floor = at_point({2, 1, 0}, dvec3(0)),
                 at_lamp = at_point({2, 1, 0}, {0, 1.5, 0});
    PathTracerOptions options;
    options.max_depth = 0;
    EXPECT_EQ(estimate(scene, at_floor, 4, options).mean, 0);
    EXPECT_EQ(estimate(scene, at_lamp, 4, options).mean, 4);
    options.max_depth = 1;
    expect_mean(estimate(scene, at_floor, 64, options), 2 * form_factor(0.8, 1.5), "light once");
}

TEST(PathTracer, PointsShineAsTheyDoForWhitted) {
    Scene scene = dark();
    add_level(scene, matte(vec3(0.5f)), 0, 3, true);
    scene.lights = {{{0, 2, 0}, vec3(3)}};
    const Camera camera = at_point({2, 1, 0}, dvec3(0));
    expect_mean(estimate(scene, camera, 1), 0.5 * 3 / pi, "no fall-off, as POV-Ray's");
    scene.lights[0].fade_distance = 1e-4;
    scene.lights[0].fade_power = 2;
    scene.lights[0].color = vec3(8 / (2e-8f));
    expect_mean(estimate(scene, camera, 1), 0.5 * 8 / 4 / pi, "intensity over distance squared");
    scene.lights[0].stand_in = true;
    EXPECT_EQ(estimate(scene, camera, 1).mean, 0) << "path tracing finds its light elsewhere";
}

TEST(PathTracer, MirrorsShowLamps) {
    Scene scene = dark();
    add_level(scene, optical({.boundary = Boundary::Mirror, .reflection = {1, 0.7f, 0}}), 0, 3,
              true);
    add_level(scene, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
    expect_mean(estimate(scene, at_point({1, 1.5, 0}, {0.5, 0, 0}), 4), 0.7 * 4, "mirror image");
}

/// A lamp behind glass is seen head on: each side reflects R, and within it again.
TEST(PathTracer, ASlabLetsThroughWhatItsTwoSidesDo) {
    const double r = fresnel(1, 1.5), expected = 4 * (1 - r) / (1 + r);
    const Camera camera = at_point({0.2, -3, 0.1}, {0.2, 0, 0.1});
    Scene slab = dark();
    add_level(slab, lamp(vec3(4)), 1.5, 3, /* up= */ false);
    add_box(slab, glass(), {-2, 0, -2}, {2, 0.3, 2}, /* outside= */ true);
    expect_mean(estimate(slab, camera, 256), expected, "a slab");
    Scene pane = dark();
    add_level(pane, lamp(vec3(4)), 1.5, 3, /* up= */ false);
    add_level(pane, optical({.boundary = Boundary::Thin, .through = vec3(1)}), 0.3, 2, true);
    expect_mean(estimate(pane, camera, 256), expected, "a pane");
}

TEST(PathTracer, ClearGlassIsNotSeenUnderAnEvenSky) {
    Scene scene = dark();
    scene.background = {vec3(1), vec3(1)};
    add_box(scene, glass(), {-1, 0, -1}, {1, 0.7, 1}, /* outside= */ true);
    PathTracerOptions options;
    options.max_depth = 100;
    expect_mean(estimate(scene, at_point({3, 2, 1}, {0.3, 0.7, 0.2}), 64, options), 1,
                "all light that is reflected or bent comes out again");
}

/// All ways to find light have one mean.
TEST(PathTracer, ShadowRaysAndPathsFindTheSameLight) {
    const auto compare = [](const Scene& scene, const Camera& camera, bool shadow_rays,
                            const char* what) {
        PathTracerOptions options;
        const Estimate both = estimate(scene, camera, 64, options);
        options.search = LightSearch::Paths;
        options.seed = 1;
        expect_alike(both, estimate(scene, camera, 256, options), what);
        options.search = LightSearch::ShadowRays;
        if (shadow_rays)
            expect_alike(both, estimate(scene, camera, 256, options), what);
    };
    for (const float width : {0.15f, 0.5f}) {
        Scene scene = dark();
        add_level(
            scene,
            optical({.diffuse = vec3(0.3f), .boundary = Boundary::Dielectric, .width = width}), 0,
            3, true);
        add_level(scene, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
        compare(scene, at_point({1.5, 1.2, 0.1}, {0.6, 0, 0}), true, "a glossy floor");
    }
    Scene metal = dark();
    add_level(metal,
              optical({.boundary = Boundary::Metal, .reflection = vec3(0.7f), .width = 0.3f}), 0, 3,
              true);
    add_level(metal, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
    compare(metal, at_point({1.5, 1.2, 0.1}, {0.6, 0, 0}), true, "metal");
    Scene frosted = dark();
    add_level(frosted, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
    add_level(frosted,
              optical({.boundary = Boundary::Dielectric, .through = vec3(1), .width = 0.5f}), 0.5,
              3, false);
    compare(frosted, at_point({0.3, -1, 0.1}, {0, 0.5, 0}), true, "frosted glass");
    Scene leaf = dark();
    add_level(leaf, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
    add_level(leaf, optical({.diffuse = vec3(0.2f), .diffuse_behind = vec3(0.5f)}), 0.5, 3, false);
    compare(leaf, at_point({0.3, -1, 0.1}, {0, 0.5, 0}), true, "a leaf");
    // Shadow rays go through a pane, and so do paths; paths alone find the light of the lamp's
    // mirror image.
    Scene pane = dark();
    add_level(pane, matte(vec3(0.5f)), 0, 3, true);
    add_level(pane, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
    add_level(pane, optical({.boundary = Boundary::Thin, .through = vec3(1)}), 0.7, 3, true);
    compare(pane, at_point({2, 0.5, 0}, dvec3(0)), false, "below a pane");
    // Paths alone find light through glass that bends it.
    Scene slab = dark();
    add_level(slab, matte(vec3(0.5f)), 0, 3, true);
    add_level(slab, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
    add_box(slab, glass(), {-3, 0.5, -3}, {3, 0.7, 3}, /* outside= */ true);
    compare(slab, at_point({2, 0.4, 0}, dvec3(0)), false, "below glass");
}

TEST(PathTracer, PointsShineThroughGlassStraight) {
    Scene scene = dark();
    add_level(scene, matte(vec3(0.5f)), 0, 3, true);
    scene.lights = {{{0, 2, 0}, vec3(3)}};
    add_box(scene, glass(), {-1, 0.5, -1}, {1, 0.7, 1}, /* outside= */ true);
    PathTracerOptions options;
    options.max_depth = 4;
    // Light goes through two sides. Light from the floor that the glass throws back comes on top.
    const double direct = 0.5 * 3 / pi * 0.96 * 0.96;
    const Estimate found = estimate(scene, at_point({2, 0.4, 0}, dvec3(0)), 64, options);
    EXPECT_GT(found.mean, direct - 1e-6);
    EXPECT_LT(found.mean, 1.2 * direct);
    scene.materials[1] = matte(vec3(0));
    EXPECT_EQ(estimate(scene, at_point({2, 0.4, 0}, dvec3(0)), 4, options).mean, 0) << "a shadow";
}

TEST(PathTracer, ShowsTheLightOfTheFileWhateverItsExposure) {
    Scene scene = dark();
    scene.background = {vec3(0.5f), vec3(0.5f)};
    add_level(scene, matte(vec3(0.5f)), 0, 3, true);
    add_level(scene, lamp(vec3(4)), 1.5, 0.8, /* up= */ false);
    const Camera camera = at_point({2, 1, 0}, dvec3(0));
    const double expected = estimate(scene, camera, 4).mean;
    scene.exposure = 0.25f;
    scene.background = {vec3(0.125f), vec3(0.125f)};
    scene.materials[1] = lamp(vec3(1));
    EXPECT_NEAR(estimate(scene, camera, 4).mean, expected, 1e-6 * expected);
}

} // namespace
} // namespace ovc
