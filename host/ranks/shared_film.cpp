// SPDX-License-Identifier: Apache-2.0
// Renders in rounds, after each of which rank 0 has what all ranks have done, so that an end by
// force loses no more than a round.
#include "host/ranks/shared_film.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "host/terminal/message.h"

#include <malloc.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <numeric>
#include <thread>

namespace ovc {
namespace {

/// A round has about so many rays a rank: more of them move fewer pages under a budget. But for
/// long pictures, which would have more than a few rounds, it has up to so many.
constexpr uint64_t kRoundRays = uint64_t(1) << 20, kMaxRoundRays = uint64_t(1) << 24;
constexpr uint64_t kFewRounds = 64, kMaxRounds = 4096;
/// A rank sends so many parts of its tiles before rank 0 has taken the first.
constexpr size_t kPartsUnderWay = 4;

uint32_t rounds_for(uint64_t rays_a_rank) {
    return uint32_t(std::max(std::clamp<uint64_t>(rays_a_rank / kRoundRays, 1, kFewRounds),
                             std::min(rays_a_rank / kMaxRoundRays, kMaxRounds)));
}

using Tiles = std::vector<uint32_t>;

/// A rank's message about tiles that all ranks know: their bytes, and whether they are complete.
class TileBytes {
public:
    static RankBytes of(const Film& film, std::span<const uint32_t> tiles, bool complete) {
        RankBytes bytes(size_of(tiles.size()));
        for (size_t i = 0; i < tiles.size(); ++i)
            film.copy_tile(tiles[i], std::span(bytes).subspan(i * kOne).first<kOne>());
        bytes.back() = std::byte(complete);
        return bytes;
    }
    /// Returns whether the tiles are complete.
    static bool restore(std::span<const std::byte> bytes, std::span<const uint32_t> tiles,
                        Film& film) {
        assert(bytes.size() == size_of(tiles.size()));
        parallel_for(tiles.size(), 4, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                film.restore_tile(tiles[i], bytes.subspan(i * kOne).first<kOne>());
        });
        return bytes.back() != std::byte(0);
    }

private:
    static constexpr size_t kOne = Film::kTileBytes;
    static size_t size_of(size_t tiles) { return tiles * kOne + 1; }
};

class SharedFilm {
public:
    SharedFilm(const Ranks& ranks, Film& film, const SharedFilmOptions& options,
               const RenderPart& render, const RenderObserver& observe)
        : ranks_(ranks),
          film_(film),
          options_(options),
          tiles_(film.width(), film.height()),
          render_(render),
          observe_(observe) {}

    Result<RenderReport> run() {
        const uint64_t left = pixel_count() - film_.pixels_done();
        const uint64_t rays = left * film_.samples() * options_.rays_per_sample;
        rounds_ = rounds_for(rays / ranks_.count());
        report_.complete = true;
        if (const Result<Done> dealt = deal_tiles(); !dealt)
            return dealt.error();
        for (uint32_t round = 0; round < rounds_ && report_.complete; ++round) {
            if (const Result<Done> done = run_round(round); !done)
                return done.error();
            if (round + 1 < rounds_)
                keep();
        }
        return report_;
    }

private:
    uint64_t pixel_count() const { return uint64_t(film_.width()) * film_.height(); }
    GoesOn goes_on() const {
        return [this] { return !observe_ || observe_(report_); };
    }

    /// Rank 0 deals the tiles out, for ranks must agree. The tiles of a rank take turns in rounds,
    /// so that these take about as long.
    Result<Done> deal_tiles() {
        std::vector<uint32_t> owners;
        if (ranks_.is_first())
            owners = tiles_.deal(ranks_.count(), options_.first_ranks);
        const Result<RankBytes> told = ranks_.spread(std::as_bytes(std::span(owners)), goes_on());
        if (!told)
            return stop(told.error());
        owners_.resize(told->size() / sizeof(uint32_t));
        std::memcpy(owners_.data(), told->data(), told->size());
        std::vector<uint32_t> tiles_before(ranks_.count());
        for (const uint32_t owner : owners_)
            round_of_tile_.push_back(tiles_before[owner]++ % rounds_);
        return Done{};
    }

    /// Returns each rank's tiles of a round, whether they were done before or not.
    std::vector<Tiles> tiles_of_ranks(uint32_t round) const {
        std::vector<Tiles> tiles(ranks_.count());
        for (const uint32_t tile :
             tiles_.tiles([&](uint32_t tile) { return round_of_tile_[tile] == round; }))
            tiles[owners_[tile]].push_back(tile);
        return tiles;
    }

    Result<Done> run_round(uint32_t round) {
        const std::vector<Tiles> tiles = tiles_of_ranks(round);
        const bool complete = trace(tiles_.pixels(tiles[ranks_.rank()]));
        if (ranks_.is_first() && !complete) {
            report_.complete = false;
            return Done{};
        }
        return exchange(tiles, round, complete);
    }

    /// Returns whether all of the pixels are done.
    bool trace(std::vector<uint32_t> pixels) {
        std::erase_if(pixels, [&](uint32_t pixel) { return film_.done(pixel); });
        const RenderReport before = report_;
        const RenderObserver observe = [&](const RenderReport& now) {
            RenderReport all = before;
            all += now;
            all.pixels_done = film_.pixels_done();
            return !observe_ || observe_(all);
        };
        const Result<RenderReport> done = render_(observe, std::move(pixels));
        if (!done) {
            fail(done.error());
            return false;
        }
        report_ += *done;
        // Rays took memory that films of other ranks, on their way, take next.
        malloc_trim(0);
        return done->complete;
    }

    /// Brings the tiles of all ranks to rank 0, and all of them to all ranks where these want
    /// them. complete: whether those of this rank are. They go in parts, of which a few are on the
    /// way: nobody waits for messages, and rank 0 needs little room, however large the film. The
    /// first part has no tiles: when it is over, all ranks have traced theirs.
    Result<Done> exchange(std::span<const Tiles> tiles, uint32_t round, bool complete) {
        const std::vector<Tiles> none(ranks_.count());
        if (const Result<Done> traced = gather_part(none, 0, 0, complete); !traced)
            return stop(traced.error());
        if (const Result<Done> told = tell_of_first({}, complete); !told)
            return stop(told.error());
        // Beside the film, for what is given back may be much.
        std::jthread after_last_ray;
        if (round + 1 == rounds_ && options_.traced)
            after_last_ray = std::jthread([&] {
                options_.traced();
                malloc_trim(0);
            });
        if (const Result<Done> gathered = gather(tiles, complete); !gathered)
            return stop(gathered.error());
        if (!options_.to_all || !report_.complete)
            return Done{};
        const auto all = tiles_.tiles([&](uint32_t tile) { return round_of_tile_[tile] == round; });
        const Result<Done> told = tell_of_first(all, complete);
        return told ? told : stop(told.error());
    }

    Result<Done> gather(std::span<const Tiles> tiles, bool complete) {
        constexpr size_t kPartTiles = (size_t(1) << 16) / FilmTiles::kTilePixels; // of all ranks
        const size_t tiles_a_part = std::max<size_t>(kPartTiles / ranks_.count(), 1);
        const size_t max = std::ranges::max(tiles, {}, &Tiles::size).size(); // of a rank
        const size_t parts = (max + tiles_a_part - 1) / tiles_a_part;
        // Rank 0 tells of each part, and the others listen to it so many parts later.
        const size_t later = ranks_.is_first() ? 0 : std::min(kPartsUnderWay - 1, parts);
        for (size_t part = 0; part < parts + later; ++part) {
            if (part < parts)
                if (const Result<Done> sent =
                        gather_part(tiles, part * tiles_a_part, tiles_a_part, complete);
                    !sent)
                    return sent;
            if (part >= later)
                if (const Result<Done> told = tell_of_first({}, complete); !told)
                    return told;
        }
        return Done{};
    }

    /// Brings `count` tiles of each rank to rank 0. complete: whether this rank's
    /// are; on rank 0, whether those of all ranks are.
    Result<Done> gather_part(std::span<const Tiles> tiles, size_t first, size_t count,
                             bool& complete) {
        const auto some_of = [&](uint32_t rank) {
            const std::span<const uint32_t> all = tiles[rank];
            const size_t from = std::min(first, all.size());
            return all.subspan(from, std::min(count, all.size() - from));
        };
        const auto mine = ranks_.is_first() ? std::span<const uint32_t>() : some_of(ranks_.rank());
        return ranks_.gather(TileBytes::of(film_, mine, complete), goes_on(),
                             [&](uint32_t rank, std::span<const std::byte> bytes) {
                                 if (rank != 0)
                                     complete &= TileBytes::restore(bytes, some_of(rank), film_);
                             });
    }

    /// Brings these tiles of rank 0 to all ranks, and whether all are complete.
    Result<Done> tell_of_first(std::span<const uint32_t> tiles, bool complete) {
        const Result<RankBytes> spread = ranks_.spread(
            ranks_.is_first() ? TileBytes::of(film_, tiles, complete) : RankBytes(), goes_on());
        if (!spread)
            return spread.error();
        report_.complete = TileBytes::restore(*spread, tiles, film_);
        return Done{};
    }

    /// Lets rank 0 keep its film where it has not for a while, and not so often that this takes
    /// more than a twentieth of the time.
    void keep() {
        if (!ranks_.is_first() || !options_.keep || !report_.complete ||
            since_kept_.seconds() < std::max(options_.keep_seconds, 20 * seconds_to_keep_))
            return;
        const Stopwatch watch;
        if (const Result<Done> kept = options_.keep(film_); !kept && !has_told_) {
            print_message(kept.error().message);
            has_told_ = true;
        }
        seconds_to_keep_ = watch.seconds();
        since_kept_ = Stopwatch();
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
    const SharedFilmOptions& options_;
    const FilmTiles tiles_;
    const RenderPart& render_;
    const RenderObserver& observe_;
    uint32_t rounds_ = 1;
    std::vector<uint32_t> owners_, round_of_tile_; // of each tile
    Stopwatch since_kept_;
    double seconds_to_keep_ = 0;
    bool has_told_ = false; // why the film cannot be kept
    RenderReport report_;
};

} // namespace

Result<Done> spread_film(const Ranks& ranks, Film& film) {
    if (const auto begun = ranks.spread(RankBytes(film.pixels_done() > 0), goes_on_always); !begun)
        return begun.error();
    else if (begun->empty())
        return Done{};
    Tiles all(film.tile_count());
    std::iota(all.begin(), all.end(), 0u);
    const Result<RankBytes> spread = ranks.spread(
        ranks.is_first() ? TileBytes::of(film, all, /* complete= */ true) : RankBytes(),
        goes_on_always);
    if (!spread)
        return spread.error();
    TileBytes::restore(*spread, all, film);
    return Done{};
}

Result<RenderReport> render_shared(const Ranks& ranks, Film& film, const SharedFilmOptions& options,
                                   const RenderPart& render, const RenderObserver& observe) {
    return SharedFilm(ranks, film, options, render, observe).run();
}

} // namespace ovc
