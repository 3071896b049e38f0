// SPDX-License-Identifier: Apache-2.0
// NoiseEstimate tells how noisy a block of pixels is, from samples of its own that the picture does
// not have. A sample that decides when its pixel ends would bias it.
// Based on: Kirk and Arvo 1991, "Unbiased Sampling Techniques for Image Synthesis".
#pragma once

#include "core/file/image.h"
#include "core/vec.h"
#include "host/film/film.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

class NoiseEstimate {
public:
    explicit NoiseEstimate(size_t pixels) : pixels_(pixels) {}

    /// Adds the mean of film.samples() independent samples of these pixels, which are done on it.
    void add(const Film& film, std::span<const uint32_t> pixels);

    /// Returns the root mean square, over these pixels and their colors, of the error that a mean
    /// of `samples` has to expect, as a display shows it: in sRGB codes from 0 to 1. scale: of
    /// linear light before it is shown. gamma: of what the films hold (Scene::gamma). Infinite
    /// where a pixel has had fewer than two films.
    double noise(std::span<const uint32_t> pixels, uint32_t samples, double scale,
                 double gamma = 1) const;

    /// Returns the mean of what was added.
    Image image(uint32_t width, uint32_t height) const;

private:
    /// Sums over the films, each weighed by its samples.
    struct Pixel {
        dvec3 light{0}, squares{0};
        uint32_t samples = 0, films = 0;
    };
    std::vector<Pixel> pixels_;
};

} // namespace ovc
