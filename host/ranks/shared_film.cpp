// SPDX-License-Identifier: Apache-2.0
// Renders in rounds, after each of which rank 0 has what all ranks have done, so that an end by
// force loses no more than a round.
#include "host/ranks/shared_film.h"

#include "host/terminal/message.h"

#include <algorithm>
#include <cstring>

namespace ovc {
namespace {

/// A round has about so many rays a rank: more of them move fewer pages under a budget.
constexpr uint64_t kRoundRays = uint64_t(1) << 20;
constexpr uint64_t kMaxRounds = 64;

/// Deals pixels out in tiles, so that neighbours' rays stay together and all ranks have about as
/// much to do.
class Tiles {
public:
    Tiles(const Film& film, uint32_t ranks, uint32_t rounds)
        : width_(film.width()),
          side_(film.height() > 1 ? 16 : 1),
          run_(film.height() > 1 ? 16 : 256),
          ranks_(ranks),
          rounds_(rounds) {}

    uint32_t rank_of(uint32_t pixel) const { return (x(pixel) + y(pixel)) % ranks_; }
    uint32_t round_of(uint32_t pixel) const {
        return ((x(pixel) + y(pixel)) / ranks_ + y(pixel)) % rounds_;
    }

private:
    uint32_t x(uint32_t pixel) const { return pixel % width_ / run_; }
    uint32_t y(uint32_t pixel) const { return pixel / width_ / side_; }

    const uint32_t width_, side_, run_, ranks_, rounds_;
};

/// Pixels that are done.
struct Pixels {
    bool complete = true; // all that were asked for
    std::vector<uint32_t> pixels;
    std::vector<Film::Sums> sums;

    void add(uint32_t pixel, const Film& film) {
        pixels.push_back(pixel);
        sums.push_back(film.sums(pixel));
    }
    void restore(Film& film) const {
        for (size_t i = 0; i < pixels.size(); ++i)
            film.restore(pixels[i], sums[i]);
    }
    RankBytes bytes() const {
        const auto numbers = std::as_bytes(std::span(pixels)),
                   light = std::as_bytes(std::span(sums));
        RankBytes bytes(1, std::byte(complete));
        bytes.reserve(1 + numbers.size() + light.size());
        bytes.insert(bytes.end(), numbers.begin(), numbers.end());
        bytes.insert(bytes.end(), light.begin(), light.end());
        return bytes;
    }
    static Pixels of(std::span<const std::byte> bytes) {
        Pixels some;
        const size_t count = bytes.size() / (sizeof(uint32_t) + sizeof(Film::Sums));
        some.complete = bytes.front() != std::byte(0);
        some.pixels.resize(count);
        some.sums.resize(count);
        if (count == 0)
            return some;
        const std::byte* const numbers = bytes.data() + 1;
        std::memcpy(some.pixels.data(), numbers, count * sizeof(uint32_t));
        std::memcpy(some.sums.data(), numbers + count * sizeof(uint32_t),
                    count * sizeof(Film::Sums));
        return some;
    }
};

class SharedFilm {
public:
    SharedFilm(const Ranks& ranks, Film& film, const SharedFilmOptions& options,
               const RenderPart& render, const RenderObserver& observe)
        : ranks_(ranks),
          film_(film),
          to_all_(options.to_all),
          rays_per_sample_(options.rays_per_sample),
          render_(render),
          observe_(observe) {}

    Result<RenderReport> run() {
        const uint64_t left = pixel_count() - film_.pixels_done();
        const uint64_t rays = left * film_.samples() * rays_per_sample_;
        const auto rounds =
            uint32_t(std::clamp<uint64_t>(rays / (ranks_.count() * kRoundRays), 1, kMaxRounds));
        report_.complete = true;
        for (uint32_t round = 0; round < rounds && report_.complete; ++round)
            if (const Result<Done> done = run_round(Tiles(film_, ranks_.count(), rounds), round);
                !done)
                return done.error();
        return report_;
    }

private:
    uint64_t pixel_count() const { return uint64_t(film_.width()) * film_.height(); }
    GoesOn goes_on() const {
        return [this] { return !observe_ || observe_(report_); };
    }

    Result<Done> run_round(const Tiles& tiles, uint32_t round) {
        Film part(film_.width(), film_.height(), film_.samples());
        std::vector<uint32_t> asked;
        for (uint32_t pixel = 0; pixel < pixel_count(); ++pixel)
            if (!film_.done(pixel) && tiles.rank_of(pixel) == ranks_.rank() &&
                tiles.round_of(pixel) == round)
                asked.push_back(pixel);
            else
                part.restore(pixel, {});
        Pixels mine;
        mine.complete = trace(part);
        for (const uint32_t pixel : asked)
            if (part.done(pixel))
                mine.add(pixel, part);
        mine.restore(film_);
        if (ranks_.is_first() && !mine.complete) {
            report_.complete = false;
            return Done{};
        }
        return exchange(mine);
    }

    /// Returns whether all of the part's pixels are done.
    bool trace(Film& part) {
        const RenderReport before = report_;
        const RenderObserver observe = [&](const RenderReport& now) {
            RenderReport all = before;
            all += now;
            all.pixels_done = film_.pixels_done();
            return !observe_ || observe_(all);
        };
        const Result<RenderReport> done = render_(observe, part);
        if (!done) {
            fail(done.error());
            return false;
        }
        report_ += *done;
        return done->complete;
    }

    Result<Done> exchange(const Pixels& mine) {
        const Result<std::vector<RankBytes>> all = ranks_.gather(mine.bytes(), goes_on());
        if (!all)
            return stop(all.error());
        Pixels joined;
        for (const RankBytes& bytes : *all) {
            const Pixels some = Pixels::of(bytes);
            some.restore(film_);
            joined.complete = joined.complete && some.complete;
            if (!to_all_)
                continue;
            joined.pixels.insert(joined.pixels.end(), some.pixels.begin(), some.pixels.end());
            joined.sums.insert(joined.sums.end(), some.sums.begin(), some.sums.end());
        }
        const Result<RankBytes> spread = ranks_.spread(joined.bytes(), goes_on());
        if (!spread)
            return stop(spread.error());
        const Pixels of_all = Pixels::of(*spread);
        of_all.restore(film_);
        report_.complete = of_all.complete;
        return Done{};
    }

    Result<Done> stop(const Error& error) {
        if (error.kind != ErrorKind::Cancelled)
            fail(error);
        report_.complete = false;
        return Done{};
    }
    void fail(const Error& error) {
        if (error.kind == ErrorKind::Cancelled)
            return;
        print_message(error.message);
        report_.failed = true;
    }

    const Ranks& ranks_;
    Film& film_;
    const bool to_all_;
    const uint32_t rays_per_sample_;
    const RenderPart& render_;
    const RenderObserver& observe_;
    RenderReport report_;
};

} // namespace

Result<Done> spread_film(const Ranks& ranks, Film& film) {
    Pixels done;
    for (uint32_t pixel = 0; ranks.is_first() && pixel < film.width() * film.height(); ++pixel)
        if (film.done(pixel))
            done.add(pixel, film);
    const Result<RankBytes> spread = ranks.spread(done.bytes(), goes_on_always);
    if (!spread)
        return spread.error();
    Pixels::of(*spread).restore(film);
    return Done{};
}

Result<RenderReport> render_shared(const Ranks& ranks, Film& film, const SharedFilmOptions& options,
                                   const RenderPart& render, const RenderObserver& observe) {
    return SharedFilm(ranks, film, options, render, observe).run();
}

} // namespace ovc
