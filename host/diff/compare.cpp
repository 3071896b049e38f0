// SPDX-License-Identifier: Apache-2.0
// All metrics except FLIP, which has a file of its own.
#include "host/diff/compare.h"

#include "host/diff/flip.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace ovc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double distance(float a, float b) {
    if (a == b || (std::isnan(a) && std::isnan(b)))
        return 0;
    const double d = std::abs(double(a) - double(b));
    return std::isnan(d) ? kInfinity : d;
}

/// Returns the layer of a channel: "normal" for "normal.X", "color" for "R", "leaf" for "leaf".
/// Opacity is a layer by itself: where it is 1 everywhere it would only dilute the colors' errors.
std::string layer_of(const std::string& channel) {
    if (const size_t dot = channel.rfind('.'); dot != std::string::npos)
        return channel.substr(0, dot);
    if (channel == "A")
        return "opacity";
    return channel == "R" || channel == "G" || channel == "B" ? "color" : channel;
}

/// Whole numbers are equal or not, also beside floats, as which other programs may write them.
bool are_whole(const Layer& a, const Layer& b) {
    return a.type == Layer::Type::Uint || b.type == Layer::Type::Uint;
}

double number_of(const Layer& layer, size_t i) {
    return layer.type == Layer::Type::Uint ? double(layer.values[i])
                                           : double(std::bit_cast<float>(layer.values[i]));
}

/// Adds up the channels of one layer.
class LayerSum {
public:
    LayerSum(std::string name, size_t size) : unequal_(size) { result_.name = std::move(name); }

    /// Adds one more channel, and returns the distance in each pixel.
    std::vector<float> add(const Layer& a, const Layer& b, uint32_t width) {
        result_.channels.push_back(a.name);
        return are_whole(a, b) ? add_whole(a, b) : add_real(a, b, width);
    }

    LayerDifference result() const {
        LayerDifference done = result_;
        done.differing = uint64_t(std::count(unequal_.begin(), unequal_.end(), true));
        if (count_ == 0)
            return done;
        done.errors->mean /= double(count_);
        done.errors->rmse = std::sqrt(done.errors->rmse / double(count_));
        done.errors->psnr = -20 * std::log10(done.errors->rmse);
        return done;
    }

private:
    std::vector<float> add_whole(const Layer& a, const Layer& b) {
        std::vector<float> distances(a.values.size());
        for (size_t i = 0; i < distances.size(); ++i)
            if (number_of(a, i) != number_of(b, i)) {
                unequal_[i] = true;
                distances[i] = float(kInfinity);
            }
        return distances;
    }

    std::vector<float> add_real(const Layer& a, const Layer& b, uint32_t width) {
        if (!result_.errors)
            result_.errors.emplace();
        Errors& errors = *result_.errors;
        count_ += a.values.size();
        std::vector<float> distances(a.values.size());
        for (size_t i = 0; i < distances.size(); ++i) {
            const float in_a = std::bit_cast<float>(a.values[i]);
            const float in_b = std::bit_cast<float>(b.values[i]);
            const double d = distance(in_a, in_b);
            if (d == 0)
                continue;
            unequal_[i] = true;
            distances[i] = float(d);
            errors.mean += d;
            errors.rmse += d * d; // result() takes the root of the mean
            if (d > errors.max) {
                errors.max = d;
                errors.at = {uint32_t(i % width), uint32_t(i / width), a.name, double(in_a),
                             double(in_b)};
            }
        }
        return distances;
    }

    LayerDifference result_;
    std::vector<bool> unequal_;
    uint64_t count_ = 0; // numbers that were added
};

std::vector<std::string> not_in(const Channels& other, const Channels& channels) {
    std::vector<std::string> names;
    for (const Layer& layer : channels.all)
        if (!other.find(layer.name))
            names.push_back(layer.name);
    return names;
}

/// Returns R, G and B as codes of sRGB; nothing where one is missing.
std::optional<std::array<std::vector<float>, 3>> colors_of(const Channels& channels) {
    Channels colors{channels.width, channels.height, channels.coding, {}};
    for (const char* name : {"R", "G", "B"}) {
        const Layer* const layer = channels.find(name);
        if (!layer || layer->type != Layer::Type::Float)
            return std::nullopt;
        colors.all.push_back(*layer);
    }
    if (colors.coding == Coding::Linear)
        encode_srgb(colors);
    std::array<std::vector<float>, 3> planes;
    for (size_t channel = 0; channel < 3; ++channel)
        for (const uint32_t bits : colors.all[channel].values)
            planes[channel].push_back(std::bit_cast<float>(bits));
    return planes;
}

std::optional<Flip> flip_of(const Channels& a, const Channels& b) {
    const auto in_a = colors_of(a), in_b = colors_of(b);
    if (!in_a || !in_b)
        return std::nullopt;
    const auto planes = [&](const std::array<std::vector<float>, 3>& colors) {
        return SrgbPlanes{a.width, a.height, colors[0], colors[1], colors[2]};
    };
    Flip flip;
    const std::vector<float> errors = flip_errors(planes(*in_a), planes(*in_b));
    for (const float error : errors) {
        flip.mean += double(error);
        flip.max = std::max(flip.max, double(error));
    }
    flip.mean /= double(errors.size());
    return flip;
}

/// Takes one more channel into the differences and into each pixel's worst.
void take(Comparison& comparison, const std::string& channel, bool whole,
          const std::vector<float>& distances) {
    Layer difference{channel, Layer::Type::Float, std::vector<uint32_t>(distances.size())};
    for (size_t i = 0; i < distances.size(); ++i) {
        comparison.worst[i] = std::max(comparison.worst[i], distances[i]);
        difference.values[i] =
            std::bit_cast<uint32_t>(whole ? std::min(distances[i], 1.0f) : distances[i]);
    }
    comparison.differences.push_back(std::move(difference));
}

} // namespace

uint64_t Comparison::over(double threshold) const {
    return uint64_t(std::count_if(worst.begin(), worst.end(),
                                  [&](float one) { return double(one) > threshold; }));
}

Comparison compare(const Channels& a, const Channels& b) {
    assert(a.width == b.width && a.height == b.height && a.coding == b.coding);
    Comparison comparison;
    comparison.width = a.width;
    comparison.height = a.height;
    comparison.coding = a.coding;
    comparison.worst.resize(a.size());
    std::vector<LayerSum> sums;
    std::vector<std::string> names;
    for (const Layer& channel : a.all) {
        const Layer* const other = b.find(channel.name);
        if (!other)
            continue;
        const std::string name = layer_of(channel.name);
        size_t at = size_t(std::find(names.begin(), names.end(), name) - names.begin());
        if (at == names.size()) {
            names.push_back(name);
            sums.emplace_back(name, a.size());
        }
        take(comparison, channel.name, are_whole(channel, *other),
             sums[at].add(channel, *other, a.width));
    }
    for (const LayerSum& sum : sums)
        comparison.layers.push_back(sum.result());
    comparison.only_in_a = not_in(b, a);
    comparison.only_in_b = not_in(a, b);
    comparison.flip = flip_of(a, b);
    return comparison;
}

} // namespace ovc
