// SPDX-License-Identifier: Apache-2.0
// Tests the estimated noise against the noise of means of known samples.
#include "host/film/noise_estimate.h"

#include "host/output/srgb.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace ovc {
namespace {

TEST(NoiseEstimate, IsWhatMeansOfSamplesDifferByOnADisplay) {
    constexpr uint32_t kPixels = 256, kSamples = 32;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> light(0.1f, 0.5f);
    std::array<uint32_t, kPixels> pixels;
    std::iota(pixels.begin(), pixels.end(), 0u);
    const auto fill = [&](Film& film) {
        for (const uint32_t pixel : pixels)
            for (uint32_t i = 0; i < film.samples(); ++i) {
                film.add(pixel, vec3(light(random)));
                film.close(pixel);
            }
    };
    const auto add_to = [&](NoiseEstimate& estimate, uint32_t samples) {
        Film film(kPixels, 1, samples);
        fill(film);
        estimate.add(film, pixels);
    };
    NoiseEstimate estimate(kPixels);
    add_to(estimate, 1);
    EXPECT_EQ(estimate.noise(pixels, 1, 1), std::numeric_limits<double>::infinity());
    for (const uint32_t samples : {1u, 2u, 4u}) // films of any size tell of the same samples
        add_to(estimate, samples);
    double squares = 0;
    Film film(kPixels, 1, kSamples);
    fill(film);
    const Image found = film.image();
    for (const vec4& pixel : found.pixels)
        squares += std::pow(double(srgb_code(pixel.g)) - double(srgb_code(0.3f)), 2) / kPixels;
    EXPECT_NEAR(estimate.noise(pixels, kSamples, 1) / std::sqrt(squares), 1, 0.12);
    EXPECT_NEAR(estimate.noise(pixels, kSamples, 1) / estimate.noise(pixels, 4 * kSamples, 1), 2,
                1e-9);
    // A film may hold codes already: then a display shows the difference as it is.
    EXPECT_NEAR(estimate.noise(pixels, 1, 1, /* gamma= */ 0), 0.4 / std::sqrt(12.0), 0.008);
    EXPECT_NEAR(double(estimate.image(kPixels, 1).pixels[7].g), 0.3, 0.2);
}

} // namespace
} // namespace ovc
