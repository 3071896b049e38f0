// SPDX-License-Identifier: Apache-2.0
// Tests filters and lenses by the picture of an edge, whose blur is known in closed form.
#include "host/render/render.h"
#include "host/render/test_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ovc {
namespace {

constexpr uint32_t kEdgeWidth = 12, kEdgeHeight = 3;

/// Returns black where x < 0, at this depth below the eye at 0, before a white sky.
Scene edge(double depth) {
    Scene scene;
    Material black;
    black.color = vec3(0);
    scene.materials.push_back(black);
    scene.background = {vec3(1), vec3(1)};
    scene.may_add_light = false;
    scene.add_mesh("half", 0,
                   quad({-90, -90, -depth}, {0, -90, -depth}, {0, 90, -depth}, {-90, 90, -depth}));
    return scene;
}

/// Returns the middle row of the picture.
std::vector<double> row(const Scene& scene, const Camera& camera, const RenderOptions& options,
                        uint32_t samples) {
    Film film(kEdgeWidth, kEdgeHeight, samples);
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    const auto report = render_picture(scene, camera, *backend, options, {}, film);
    EXPECT_TRUE(report && report->complete);
    const Image image = film.image();
    std::vector<double> values;
    for (uint32_t x = 0; x < kEdgeWidth; ++x)
        values.push_back(double(image.at(x, kEdgeHeight / 2).g));
    return values;
}

TEST(FilmOptions, AFilteredEdgeIsTheFiltersRunningSum) {
    const Scene scene = edge(2);
    Camera camera;
    camera.eye = {0.3, 0, 0}; // the edge is at 5.7 of 12 pixels
    camera.target = {0.3, 0, -1};
    camera.window = ImageWindow{{0, 0, -1}, {kEdgeWidth, 0, 0}, {0, kEdgeHeight, 0}, true};
    const double at = kEdgeWidth / 2.0 - 0.3;
    for (const FilterOptions& filter :
         {FilterOptions{}, FilterOptions{FilterOptions::Kind::Flat, 2},
          FilterOptions{FilterOptions::Kind::Gaussian, 1.5},
          FilterOptions{FilterOptions::Kind::BlackmanHarris, 3}}) {
        RenderOptions options;
        options.filter = filter;
        const std::vector<double> found = row(scene, camera, options, 4096);
        for (uint32_t x = 0; x < kEdgeWidth; ++x) {
            double light = 0, all = 0; // of the filter's weight, in small steps
            for (double offset = -1 + 5e-5; offset < 1; offset += 1e-4) {
                const double weight = filter_weight(filter.kind, offset);
                all += weight;
                light += x + 0.5 + offset * filter.radius > at ? weight : 0;
            }
            EXPECT_NEAR(found[x], light / all, 1.5e-3)
                << "filter " << int(filter.kind) << ", pixel " << x;
        }
    }
}

/// The edge lies halfway to where the lens is sharp. It covers the part of the lens to the left of
/// the place that the pixel shows there, mirrored: a segment of a disk.
TEST(FilmOptions, AnEdgeOutOfFocusIsBlurredByTheShapeOfTheLens) {
    constexpr double kRadius = 0.25, kFocus = 4;
    const Scene scene = edge(kFocus / 2);
    Camera camera;
    camera.eye = dvec3(0);
    camera.target = {0, 0, -1};
    camera.window = ImageWindow{{0, 0, -1}, {0.15, 0, 0}, {0, 0.15, 0}};
    camera.lens = lens_of(camera, kRadius, kFocus);
    const std::vector<double> found = row(scene, camera, {}, 4096);
    for (uint32_t x = 0; x < kEdgeWidth; ++x) {
        const double shown = ((x + 0.5) / kEdgeWidth - 0.5) * 0.15 * kFocus;
        const double a = std::clamp(shown / kRadius, -1.0, 1.0);
        const double covered = (std::acos(a) - a * std::sqrt(1 - a * a)) / std::numbers::pi;
        EXPECT_NEAR(found[x], 1 - covered, 0.01) << "pixel " << x;
    }
    // At the distance where the lens is sharp, nothing but the pixel itself blurs the edge.
    const std::vector<double> sharp = row(edge(kFocus), camera, {}, 256);
    EXPECT_EQ(sharp[kEdgeWidth / 2 - 1], 0);
    EXPECT_EQ(sharp[kEdgeWidth / 2], 1);
}

TEST(FilmOptions, OneRayAPixelGoesThroughTheMiddleOfPixelAndLens) {
    const Scene scene = edge(2);
    Camera camera;
    camera.target = {0, 0, -1};
    const std::vector<double> plain = row(scene, camera, {}, 1);
    camera.lens = lens_of(camera, 0.5, {});
    RenderOptions options;
    options.filter = {FilterOptions::Kind::Gaussian, 2};
    EXPECT_EQ(row(scene, camera, options, 1), plain);
}

} // namespace
} // namespace ovc
