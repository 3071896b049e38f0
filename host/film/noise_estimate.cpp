// SPDX-License-Identifier: Apache-2.0
// The variance of a sample is estimated from the spread of means, each weighed by its samples.
#include "host/film/noise_estimate.h"

#include "core/scene.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace ovc {

void NoiseEstimate::add(const Film& film, std::span<const uint32_t> pixels) {
    assert(pixels_.size() == size_t(film.width()) * film.height());
    const double weight = film.samples();
    for (const uint32_t pixel : pixels) {
        const dvec3 mean = film.mean(pixel);
        Pixel& sums = pixels_[pixel];
        sums.light += weight * mean;
        sums.squares += weight * mean * mean;
        sums.samples += film.samples();
        ++sums.films;
    }
}

/// Returns the slope of sRGB's curve, at white for light that is brighter.
static double slope_of_srgb(double light) {
    const double x = std::clamp(light, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 : 1.055 / 2.4 * std::pow(x, 1 / 2.4 - 1);
}

/// Returns the slope of the code that a display shows of a film's light.
static double slope_of_code(double light, double scale, double gamma) {
    const double linear = double(linear_light(float(light), gamma));
    const double step = 0.01 * std::max(light, 0.001); // long enough for floats
    const double slope_of_light = gamma == 1 ? 1
                                             : (double(linear_light(float(light + step), gamma)) -
                                                double(linear_light(float(light - step), gamma))) /
                                                   (2 * step);
    return slope_of_srgb(scale * linear) * scale * slope_of_light;
}

double NoiseEstimate::noise(std::span<const uint32_t> pixels, uint32_t samples, double scale,
                            double gamma) const {
    dvec3 light(0), variance(0); // of one sample, summed over the pixels
    for (const uint32_t number : pixels) {
        const Pixel& pixel = pixels_[number];
        if (pixel.films < 2)
            return std::numeric_limits<double>::infinity();
        const dvec3 mean = pixel.light / double(pixel.samples);
        light += mean;
        variance += glm::max(pixel.squares - pixel.light * mean, 0.0) / double(pixel.films - 1);
    }
    const double count = double(pixels.size());
    double squares = 0;
    for (int channel = 0; channel < 3; ++channel) {
        // One slope for the block: the mean of a pixel alone would be too noisy to ask for it.
        const double slope = slope_of_code(light[channel] / count, scale, gamma);
        squares += slope * slope * variance[channel] / (count * samples);
    }
    return std::sqrt(squares / 3);
}

Image NoiseEstimate::image(uint32_t width, uint32_t height) const {
    assert(pixels_.size() == size_t(width) * height);
    Image image(width, height);
    for (size_t i = 0; i < pixels_.size(); ++i)
        if (pixels_[i].samples > 0)
            image.pixels[i] = vec4(vec3(pixels_[i].light / double(pixels_[i].samples)), 1);
    return image;
}

} // namespace ovc
