// SPDX-License-Identifier: Apache-2.0
// Blocks of pixels take their passes by the noise that is estimated for them.
#include "host/render/progressive.h"

#include "core/system/stopwatch.h"
#include "host/camera/camera.h"
#include "host/film/noise_estimate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

namespace ovc {
namespace {

constexpr uint32_t kBlockSide = 16; // pixels
/// After the first pass, each block gets so many samples in all before its noise is known.
constexpr uint32_t kFirstSamples = 8;
/// The estimate takes a sample for so many of the picture's.
constexpr uint32_t kSamplesPerEstimated = 8;
/// Without a limit, the noise to reach next is so much lower: about 1.5 times the samples.
constexpr double kNextNoise = 0.82;
constexpr double kFirstNoise = 0.1;
/// The first picture shows every so many pixels across and down, each as a square.
constexpr uint32_t kCoarse = 4;
/// Pictures are shown at twice the time of the one before, but no farther apart than this.
constexpr double kFirstShown = 1, kMaxBetweenShown = 20;

/// The next number of samples of a block: 2^k, 1.5 x 2^k, 2^(k + 1).
uint32_t more_samples(uint32_t samples) {
    if (samples < kFirstSamples)
        return kFirstSamples;
    const bool is_power = (samples & (samples - 1)) == 0;
    return is_power ? samples + samples / 2 : samples / 3 * 4;
}

class Progression {
public:
    Progression(const Progressive& options, double gamma, const RenderPass& render,
                const RenderObserver& observe, Film& film)
        : options_(options),
          gamma_(gamma),
          render_(render),
          observe_(observe),
          film_(film),
          width_(film.width()),
          order_(pixel_order(film.width(), film.height())),
          columns_((film.width() + kBlockSide - 1) / kBlockSide),
          blocks_(size_t(columns_) * ((film.height() + kBlockSide - 1) / kBlockSide)),
          sums_(order_.size()),
          estimate_(order_.size()),
          wanted_noise_(options.noise > 0 ? options.noise : kFirstNoise) {
        for (const uint32_t pixel : order_)
            blocks_[block_of(pixel)].pixels.push_back(pixel);
    }

    Result<RenderReport> run() {
        bool goes_on = show_coarse() && take(every_block(), 1);
        is_whole_ = goes_on;
        while (goes_on) {
            show();
            const std::optional<Group> group = next_group();
            if (!group)
                break;
            const uint32_t samples = std::min(more_samples(group->samples), options_.max_samples);
            goes_on = judged(*group, samples) && take(group->blocks, samples);
        }
        if (error_)
            return *error_;
        if (is_whole_) {
            put_means(film_);
            report_.sampled = sampled();
        }
        report_.complete = is_whole_ && !interrupted_;
        return report_;
    }

private:
    struct Block {
        std::vector<uint32_t> pixels;
        uint32_t samples = 0, estimated = 0; // of each pixel, in the picture and in the estimate
        double noise = std::numeric_limits<double>::infinity();
    };
    using BlockNumbers = std::vector<uint32_t>;
    /// Blocks that have had the same number of samples.
    struct Group {
        BlockNumbers blocks;
        uint32_t samples;
    };

    uint32_t block_of(uint32_t pixel) const {
        return pixel / width_ / kBlockSide * columns_ + pixel % width_ / kBlockSide;
    }
    BlockNumbers every_block() const {
        BlockNumbers all(blocks_.size());
        for (uint32_t i = 0; i < all.size(); ++i)
            all[i] = i;
        return all;
    }
    /// Returns their pixels along the curve through the picture.
    std::vector<uint32_t> pixels_of(const BlockNumbers& blocks) const {
        std::vector<uint8_t> is_among(blocks_.size());
        for (const uint32_t block : blocks)
            is_among[block] = 1;
        std::vector<uint32_t> pixels;
        for (const uint32_t pixel : order_)
            if (is_among[block_of(pixel)])
                pixels.push_back(pixel);
        return pixels;
    }

    /// Returns the blocks to go on with: of those that are too noisy, the ones with the fewest
    /// samples. Nothing where none is, or the time is over.
    std::optional<Group> next_group() {
        if (options_.seconds > 0 && watch_.seconds() >= options_.seconds)
            return std::nullopt;
        while (true) {
            Group group{{}, options_.max_samples};
            for (uint32_t i = 0; i < blocks_.size(); ++i) {
                const Block& block = blocks_[i];
                if (block.samples >= options_.max_samples || block.noise <= wanted_noise_)
                    continue;
                if (block.samples < group.samples)
                    group = {{}, block.samples};
                if (block.samples == group.samples)
                    group.blocks.push_back(i);
            }
            if (!group.blocks.empty())
                return group;
            const bool all_are_full = std::ranges::all_of(blocks_, [&](const Block& block) {
                return block.samples >= options_.max_samples || block.noise == 0;
            });
            if (options_.noise > 0 || all_are_full)
                return std::nullopt;
            wanted_noise_ *= kNextNoise;
        }
    }

    /// Takes the samples of the estimate that belong to `samples` of the picture, and estimates the
    /// noise that these will have. Returns false where it was stopped.
    bool judged(const Group& group, uint32_t samples) {
        const std::vector<uint32_t> pixels = pixels_of(group.blocks);
        const uint32_t there = blocks_[group.blocks[0]].estimated;
        const uint32_t wanted = std::max(samples / kSamplesPerEstimated, 2u);
        // The first films have one sample each, for their spread is what tells the variance.
        const uint32_t films = there == 0 ? wanted : 1;
        for (uint32_t i = 0; i < films && there < wanted; ++i) {
            const uint32_t at_once = (wanted - there) / films;
            Film film(film_.width(), film_.height(), at_once);
            if (!trace({pixels, there + i * at_once, at_once, /* for_estimate= */ true}, film))
                return false;
            estimate_.add(film, pixels);
        }
        const double scale = std::exp2(stops());
        for (const uint32_t number : group.blocks) {
            Block& block = blocks_[number];
            block.estimated = std::max(there, wanted);
            block.noise = estimate_.noise(block.pixels, samples, scale, gamma_);
        }
        return true;
    }

    /// Returns the picture's exposure, which must not depend on the picture's own samples either.
    double stops() const {
        if (!options_.exposure)
            return 0;
        if (!options_.exposure->is_automatic)
            return options_.exposure->stops;
        Image image = estimate_.image(film_.width(), film_.height());
        if (gamma_ != 1)
            to_linear(image.pixels, gamma_);
        return automatic_stops(image);
    }

    /// Takes samples of the blocks until each of their pixels has so many. A pass that is cut off
    /// does not count: pixels that are done sooner than others differ from them.
    bool take(const BlockNumbers& blocks, uint32_t samples) {
        const uint32_t before = blocks_[blocks[0]].samples;
        const std::vector<uint32_t> pixels = pixels_of(blocks);
        const uint32_t more = within_time(pixels.size(), samples - before);
        if (more == 0)
            return false;
        Film film(film_.width(), film_.height(), more);
        if (!trace({pixels, before, more}, film))
            return false;
        for (const uint32_t pixel : pixels)
            for (size_t channel = 0; channel < 3; ++channel)
                sums_[pixel][channel] += film.sums(pixel)[channel];
        for (const uint32_t block : blocks)
            blocks_[block].samples += more;
        return true;
    }

    /// Returns how many of these samples of so many pixels the time that is left allows.
    uint32_t within_time(size_t pixels, uint32_t samples) const {
        if (!(options_.seconds > 0) || !is_whole_)
            return samples;
        const double left = options_.seconds - watch_.seconds();
        const double possible = left * rate_ / double(pixels);
        return uint32_t(std::clamp(possible, 0.0, double(samples)));
    }

    /// Returns false where it failed or was stopped, by the user or the time.
    bool trace(const Pass& pass, Film& film) {
        const RenderReport before = report_;
        const Stopwatch watch;
        const RenderObserver observe = [&](const RenderReport& now) {
            RenderReport all = before;
            all += now;
            all.pixels_done = uint64_t(share_done() * double(order_.size()));
            interrupted_ = interrupted_ || (observe_ && !observe_(all));
            return !interrupted_ && !is_over();
        };
        const Result<RenderReport> done = render_(pass, observe, film);
        if (!done) {
            error_ = done.error();
            return false;
        }
        report_ += *done;
        rate_ = double(pass.pixels.size()) * pass.samples / std::max(watch.seconds(), 1e-6);
        return done->complete;
    }

    /// The first picture is complete whatever the time, or there would be none.
    bool is_over() const {
        return is_whole_ && options_.seconds > 0 && watch_.seconds() >= options_.seconds;
    }

    /// Returns how much is done of what is asked for, of which the first end counts.
    double share_done() const {
        const double by_time =
            options_.seconds > 0 ? std::min(watch_.seconds() / options_.seconds, 1.0) : 0;
        const auto quiet = std::ranges::count_if(blocks_, [&](const Block& block) {
            return block.samples >= options_.max_samples || block.noise <= options_.noise;
        });
        return std::max(by_time, double(quiet) / double(blocks_.size()));
    }

    Sampled sampled() const {
        Sampled all{blocks_[0].samples, blocks_[0].samples};
        for (const Block& block : blocks_) {
            all.min = std::min(all.min, block.samples);
            all.max = std::max(all.max, block.samples);
            all.mean += double(block.samples) * double(block.pixels.size());
            all.noise = std::max(all.noise, block.noise);
        }
        all.mean /= double(order_.size());
        return all;
    }

    void put_means(Film& film) const {
        std::vector<Film::Sums> means(order_.size());
        std::vector<uint32_t> pixels(order_.size());
        for (uint32_t pixel = 0; pixel < means.size(); ++pixel) {
            pixels[pixel] = pixel;
            const int64_t samples = blocks_[block_of(pixel)].samples;
            for (size_t channel = 0; channel < 3; ++channel)
                means[pixel][channel] = sums_[pixel][channel] / samples;
        }
        film.restore(pixels, means);
    }

    void show() {
        if (!options_.show || watch_.seconds() < next_shown_)
            return;
        Film so_far(film_.width(), film_.height());
        put_means(so_far);
        options_.show(so_far);
        set_next_shown();
    }

    void set_next_shown() {
        const double now = watch_.seconds();
        next_shown_ = std::max(kFirstShown, std::min(2 * now, now + kMaxBetweenShown));
    }

    /// Shows a picture of few pixels, from samples that no other uses, before the first pass.
    bool show_coarse() {
        if (!options_.show)
            return true;
        Pass pass;
        for (const uint32_t pixel : order_)
            if (pixel % width_ % kCoarse == 0 && pixel / width_ % kCoarse == 0)
                pass.pixels.push_back(pixel);
        pass.for_estimate = true;
        pass.first_sample = options_.max_samples; // the estimate takes fewer
        Film film(film_.width(), film_.height());
        if (!trace(pass, film))
            return false;
        Film squares(film_.width(), film_.height());
        for (const uint32_t pixel : order_)
            squares.restore(pixel, film.sums(pixel - pixel % width_ % kCoarse -
                                             pixel / width_ % kCoarse * width_));
        options_.show(squares);
        set_next_shown();
        return true;
    }

    const Progressive& options_;
    const double gamma_;
    const RenderPass& render_;
    const RenderObserver& observe_;
    Film& film_;
    const uint32_t width_;
    const std::vector<uint32_t> order_; // of pixels
    const uint32_t columns_;            // of blocks
    std::vector<Block> blocks_;
    std::vector<Film::Sums> sums_; // of the picture's pixels
    NoiseEstimate estimate_;
    double wanted_noise_;
    bool is_whole_ = false; // each pixel has a sample
    bool interrupted_ = false;
    double rate_ = 0; // samples a second, of the pass before
    double next_shown_ = kFirstShown;
    const Stopwatch watch_;
    std::optional<Error> error_;
    RenderReport report_;
};

} // namespace

Result<RenderReport> render_progressively(const Progressive& options, double gamma,
                                          const RenderPass& render, const RenderObserver& observe,
                                          Film& film) {
    assert(film.samples() == 1 && options.max_samples >= 1);
    return Progression(options, gamma, render, observe, film).run();
}

} // namespace ovc
