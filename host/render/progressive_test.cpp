// SPDX-License-Identifier: Apache-2.0
// Tests progressive rendering on pixels whose samples are drawn from known distributions.
#include "host/render/progressive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ovc {
namespace {

constexpr uint32_t kPassesSide = 32; // four blocks

/// Returns a number in [0, 1) for a sample of a pixel. Steele, Lea and Flood 2014, SplitMix.
double drawn(uint64_t run, uint32_t pixel, uint32_t sample, bool for_estimate) {
    uint64_t x =
        run * 0x9e3779b97f4a7c15u + (uint64_t(pixel) << 32) + 2 * uint64_t(sample) + for_estimate;
    for (int round = 0; round < 2; ++round) {
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        x ^= x >> 31;
    }
    return double(x >> 32) * 0x1p-32;
}

struct Passes {
    uint64_t run = 0;
    /// Light is 0.2 on average. On the left of the picture it is 0.2 / chance with this chance,
    /// else 0; on the right it hardly varies.
    double chance = 0.2;
    uint32_t noisy_columns = kPassesSide / 2;
    bool shares_samples = false; // the estimate sees the picture's own samples
    uint64_t samples = 0;

    double light(uint32_t pixel, double u) const {
        if (pixel % kPassesSide >= noisy_columns)
            return 0.16 + 0.08 * u;
        return u < chance ? 0.2 / chance : 0;
    }

    Result<RenderReport> operator()(const Pass& pass, const RenderObserver& observe, Film& film) {
        const bool for_estimate = pass.for_estimate && !shares_samples;
        for (const uint32_t pixel : pass.pixels)
            for (uint32_t i = 0; i < pass.samples; ++i) {
                const double u = drawn(run, pixel, pass.first_sample + i, for_estimate);
                film.add(pixel, vec3(float(light(pixel, u))));
                film.close(pixel);
            }
        samples += pass.pixels.size() * pass.samples;
        RenderReport report;
        report.complete = !observe || observe(report);
        return report;
    }
};

Image picture(Passes& passes, const Progressive& how, std::optional<Sampled>* sampled = nullptr) {
    Film film(kPassesSide, kPassesSide);
    const auto report = render_progressively(how, 1, std::ref(passes), {}, film);
    EXPECT_TRUE(report && report->complete);
    EXPECT_EQ(film.pixels_done(), kPassesSide * kPassesSide);
    if (sampled)
        *sampled = report->sampled;
    return film.image();
}

double mean_of(const Image& image) {
    double sum = 0;
    for (const vec4& pixel : image.pixels)
        sum += double(pixel.g);
    return sum / double(image.pixels.size());
}

/// The error of a pixel's display in the left half is the slope of sRGB's curve at 0.2, 1.15, times
/// the root of 0.2 x 0.8 over the samples.
TEST(Progressive, TakesSamplesUntilTheNoiseIsWhatWasAskedFor) {
    const double slope = 1.055 / 2.4 * std::pow(0.2, 1 / 2.4 - 1);
    for (const double noise : {0.2, 0.1, 0.05}) {
        Passes passes;
        std::optional<Sampled> sampled;
        picture(passes, {.noise = noise, .max_samples = 4096}, &sampled);
        ASSERT_TRUE(sampled);
        const double needed = 0.16 * slope * slope / (noise * noise);
        EXPECT_GT(sampled->max, 0.8 * needed) << noise;
        EXPECT_LT(sampled->max, 1.8 * needed + 8) << noise;
        EXPECT_LE(sampled->noise, noise);
        EXPECT_EQ(sampled->min, 8u) << "the right half is quiet at once";
        // The estimate and the first pass take about an eighth more.
        const double pixels = kPassesSide * kPassesSide;
        EXPECT_LT(double(passes.samples) / pixels, 1.2 * sampled->mean + 3);
    }
}

/// Light is rare, as where a path must find a small lamp. Of many pictures, the mean is the truth.
/// Where the estimate sees the samples of the picture, it is not: blocks whose samples happen to be
/// dark look quiet, and end. That the second is found shows that the first would be.
TEST(Progressive, IsUnbiasedBecauseOtherSamplesDecideWhenItEnds) {
    constexpr int kRuns = 500;
    for (const bool shares : {false, true}) {
        double sum = 0, squares = 0;
        for (int run = 1; run <= kRuns; ++run) {
            Passes passes{.run = uint64_t(run),
                          .chance = 0.001,
                          .noisy_columns = kPassesSide,
                          .shares_samples = shares};
            const double mean = mean_of(picture(passes, {.noise = 0.16, .max_samples = 32}));
            sum += mean / kRuns;
            squares += mean * mean / kRuns;
        }
        const double sigma = std::sqrt((squares - sum * sum) / (kRuns - 1));
        if (shares)
            EXPECT_GT(std::abs(sum - 0.2), 5 * sigma) << "mean " << sum << ", sigma " << sigma;
        else
            EXPECT_NEAR(sum, 0.2, 4 * sigma) << "sigma " << sigma;
    }
}

TEST(Progressive, EndsAtTheTimeWithOneSampleAtLeast) {
    Passes passes;
    std::optional<Sampled> sampled;
    picture(passes, {.seconds = 1e-9, .max_samples = 4096}, &sampled);
    EXPECT_EQ(sampled->min, 1u);
    EXPECT_EQ(sampled->max, 1u);
    // Within a time the noisy half gets more samples than the quiet one.
    picture(passes, {.seconds = 0.3, .max_samples = 1u << 20}, &sampled);
    EXPECT_GT(sampled->max, 2 * sampled->min);
}

TEST(Progressive, ShowsACoarsePictureFirstAndEndsWhereItIsInterrupted) {
    Passes passes;
    int shown = 0;
    Progressive how{.noise = 0.01, .max_samples = 4096};
    how.show = [&](const Film& film) {
        EXPECT_EQ(film.pixels_done(), kPassesSide * kPassesSide);
        for (uint32_t x = 0; shown == 0 && x < kPassesSide; ++x)
            EXPECT_EQ(film.sums(x), film.sums(x - x % 4));
        ++shown;
    };
    Film film(kPassesSide, kPassesSide);
    int calls = 0;
    const auto report = render_progressively(
        how, 1, std::ref(passes), [&](const RenderReport&) { return ++calls < 4; }, film);
    ASSERT_TRUE(report);
    EXPECT_FALSE(report->complete);
    EXPECT_EQ(shown, 1); // less than a second has passed
    EXPECT_EQ(film.pixels_done(), kPassesSide * kPassesSide) << "the passes that were complete";
}

} // namespace
} // namespace ovc
