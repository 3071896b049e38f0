// SPDX-License-Identifier: Apache-2.0
// Tests path tracing in both modes: one seed gives the same bits, and other seeds the same mean in
// each pixel.
#include "host/render/render.h"
#include "host/render/test_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace ovc {
namespace {

constexpr uint32_t kPathSide = 20;

/// Returns a floor, a glossy one beside it, a mirror behind, a pane in front, a lamp above and a
/// blue sky.
Scene corner() {
    using Boundary = Optics::Boundary;
    Scene scene;
    const auto add = [&](const Optics& optics, Chunk chunk) {
        Material material;
        material.optics = optics;
        scene.materials.push_back(material);
        scene.add_mesh("quad", uint32_t(scene.materials.size() - 1), std::move(chunk));
    };
    scene.background = {vec3(0.1f), {0.05f, 0.1f, 0.2f}};
    add({.diffuse = {0.7f, 0.4f, 0.3f}}, quad({-3, 0, -2}, {-3, 0, 2}, {0, 0, 2}, {0, 0, -2}));
    add({.diffuse = vec3(0.2f), .boundary = Boundary::Dielectric, .width = 0.3f},
        quad({0, 0, -2}, {0, 0, 2}, {3, 0, 2}, {3, 0, -2}));
    add({.boundary = Boundary::Mirror, .reflection = vec3(0.8f)},
        quad({-3, 0, -2}, {3, 0, -2}, {3, 3, -2}, {-3, 3, -2}));
    add({.boundary = Boundary::Thin, .through = {0.9f, 1, 0.9f}},
        quad({-1, 0, 1}, {1, 0, 1}, {1, 1, 1}, {-1, 1, 1}));
    add({.emission = vec3(6)}, quad({-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}));
    return scene;
}

Image picture(const Scene& scene, Backend& backend, RenderMode mode, uint64_t seed,
              uint32_t samples, const std::optional<Progressive>& progressive = {}) {
    Camera camera;
    camera.eye = {0.5, 2, 6};
    camera.target = {0, 0.9, 0};
    camera.fov_degrees = 45;
    Film film(kPathSide, kPathSide, samples);
    RenderOptions options;
    options.integrator = IntegratorKind::Path;
    options.mode = mode;
    options.max_depth = 8;
    options.seed = seed;
    options.progressive = progressive;
    const auto report = render_picture(scene, camera, backend, options, {}, film);
    EXPECT_TRUE(report && report->complete);
    EXPECT_TRUE(report && report->rays.bounce > 0 && report->rays.shadow > 0);
    return film.image();
}

TEST(PathModes, MakeTheSameBitsOfTheSameSeed) {
    const Scene scene = corner();
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    const Image batched = picture(scene, *backend, RenderMode::Batched, 5, 4);
    EXPECT_EQ(batched.pixels, picture(scene, *backend, RenderMode::Mixed, 5, 4).pixels);
    EXPECT_NE(batched.pixels, picture(scene, *backend, RenderMode::Mixed, 6, 4).pixels);
}

/// A part of a picture is that part of it, noise and all.
TEST(PathModes, APartHasTheNoiseOfTheWholePicture) {
    const Scene scene = corner();
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    Camera camera;
    camera.eye = {0.5, 2, 6};
    camera.target = {0, 0.9, 0};
    camera.fov_degrees = 45;
    camera.lens = Lens{dvec3(0.1, 0, 0), dvec3(0, 0.1, 0), 5};
    RenderOptions options;
    options.integrator = IntegratorKind::Path;
    options.max_depth = 8;
    Film whole(kPathSide, kPathSide, 4);
    ASSERT_TRUE(render_picture(scene, camera, *backend, options, {}, whole));
    options.part = {{kPathSide, kPathSide}, 7, 9, {6, 5}};
    Film part(6, 5, 4);
    ASSERT_TRUE(render_picture(scene, camera, *backend, options, {}, part));
    const Image all = whole.image(), some = part.image();
    for (uint32_t y = 0; y < 5; ++y)
        for (uint32_t x = 0; x < 6; ++x)
            EXPECT_EQ(some.pixels[y * 6 + x], all.pixels[(y + 9) * kPathSide + x + 7]) << x << y;
}

/// The mean, and its variance, of each pixel over pictures of different seeds.
struct Pixels {
    std::vector<double> mean, variance;
};

constexpr uint32_t kPictures = 24;

/// Each has 16 samples, or is progressive.
Pixels many(const Scene& scene, Backend& backend, RenderMode mode, uint64_t first_seed,
            const std::optional<Progressive>& progressive = {}) {
    Pixels all{std::vector<double>(kPathSide * kPathSide),
               std::vector<double>(kPathSide * kPathSide)};
    std::vector<double> squares(kPathSide * kPathSide);
    for (uint32_t i = 0; i < kPictures; ++i) {
        const Image image =
            picture(scene, backend, mode, first_seed + i, progressive ? 1 : 16, progressive);
        for (size_t p = 0; p < image.pixels.size(); ++p) {
            all.mean[p] += double(image.pixels[p].g) / kPictures;
            squares[p] += double(image.pixels[p].g) * double(image.pixels[p].g) / kPictures;
        }
    }
    for (size_t p = 0; p < squares.size(); ++p)
        all.variance[p] = std::max(squares[p] - all.mean[p] * all.mean[p], 0.0) / (kPictures - 1);
    return all;
}

TEST(PathModes, ConvergeToTheSameMean) {
    const Scene scene = corner();
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    const Pixels batched = many(scene, *backend, RenderMode::Batched, 100);
    const Pixels mixed = many(scene, *backend, RenderMode::Mixed, 200);
    double squares = 0, sum = 0;
    int pixels = 0;
    for (size_t p = 0; p < batched.mean.size(); ++p) {
        const double sigma = std::sqrt(batched.variance[p] + mixed.variance[p]);
        if (!(sigma > 0)) { // the pixel sees sky or lamp alone
            EXPECT_EQ(batched.mean[p], mixed.mean[p]);
            continue;
        }
        const double z = (batched.mean[p] - mixed.mean[p]) / sigma;
        // z is Student's t of some 40 degrees of freedom.
        EXPECT_LT(std::abs(z), 5.5) << "pixel " << p;
        squares += z * z;
        sum += z;
        ++pixels;
    }
    EXPECT_GT(pixels, int(kPathSide * kPathSide / 2));
    // Such a t has variance 46/44; the limits are five sigma of the means of n values.
    EXPECT_NEAR(sum / pixels, 0, 5 / std::sqrt(pixels));
    EXPECT_NEAR(squares / pixels, 46 / 44.0, 5 * std::sqrt(2.2 / pixels));
}

/// The reference takes the same number of samples everywhere, whatever the noise.
TEST(PathModes, ProgressiveHasTheMeanAndTheNoiseThatWasAskedFor) {
    constexpr double kNoise = 0.06;
    const Scene scene = corner();
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    const Pixels reference = many(scene, *backend, RenderMode::Batched, 400,
                                  Progressive{.noise = 1e-9, .max_samples = 32});
    const Pixels found = many(scene, *backend, RenderMode::Mixed, 300,
                              Progressive{.noise = kNoise, .max_samples = 4096});
    double sum = 0, errors = 0;
    int pixels = 0;
    for (size_t p = 0; p < found.mean.size(); ++p) {
        const double truth = reference.mean[p];
        const double slope = 1.055 / 2.4 * std::pow(std::clamp(truth, 0.01, 1.0), 1 / 2.4 - 1);
        errors += slope * slope * found.variance[p] * kPictures;
        const double sigma = std::sqrt(found.variance[p] + reference.variance[p]);
        if (!(sigma > 0)) // sky or lamp alone
            continue;
        const double z = (found.mean[p] - truth) / sigma;
        // Student's t again, of fewer degrees of freedom where the variances differ.
        EXPECT_LT(std::abs(z), 7) << "pixel " << p;
        sum += z;
        ++pixels;
    }
    EXPECT_GT(pixels, int(kPathSide * kPathSide / 2));
    EXPECT_NEAR(sum / pixels, 0, 5 / std::sqrt(pixels));
    // No block is noisier; most end between two numbers of samples, and some are quiet at once.
    const double noise = std::sqrt(errors / double(found.mean.size()));
    EXPECT_LT(noise, 1.1 * kNoise);
    EXPECT_GT(noise, 0.4 * kNoise);
}

} // namespace
} // namespace ovc
