// SPDX-License-Identifier: Apache-2.0
// Compares two pictures: layer by layer in numbers, and as a person sees them.
#pragma once

#include "host/diff/channels.h"

#include <optional>
#include <string>
#include <vector>

namespace ovc {

/// The pixel and channel in which two layers are farthest apart.
struct Farthest {
    uint32_t x = 0;
    uint32_t y = 0;
    std::string channel;
    double a = 0;
    double b = 0;
};

/// The errors over all channels of one layer. Two NaNs and two equal infinities are 0 apart; a NaN
/// and a number are infinitely far apart.
struct Errors {
    double max = 0;
    double mean = 0; // of |a - b|
    double rmse = 0;
    double psnr = 0; // in decibels, with a signal's peak of 1; infinite for equal layers
    Farthest at;
};

/// A layer, such as "normal" with X, Y and Z; R, G and B are "color", A is "opacity".
struct LayerDifference {
    std::string name;
    std::vector<std::string> channels; // as the files name them
    uint64_t differing = 0;            // pixels with a channel that is not equal
    std::optional<Errors> errors;      // none for whole numbers, whose distance says nothing
};

struct Flip {
    double mean = 0;
    double max = 0;
};

struct Comparison {
    uint32_t width = 0;
    uint32_t height = 0;
    Coding coding = Coding::Linear;
    std::vector<LayerDifference> layers;
    std::vector<std::string> only_in_a; // channels
    std::vector<std::string> only_in_b;
    std::optional<Flip> flip; // where both have R, G and B
    std::vector<float> worst; // for each pixel the largest difference of its channels; infinite for
                              // whole numbers that differ
    std::vector<Layer> differences; // |a - b| of each channel compared; 0 or 1 for whole numbers

    uint64_t over(double threshold) const; // the number of pixels whose worst is greater
};

/// Compares the channels that both pictures have. The pictures are of one size and one coding (both
/// asserted). FLIP sees linear light encoded as sRGB.
Comparison compare(const Channels& a, const Channels& b);

} // namespace ovc
