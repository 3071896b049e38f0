// SPDX-License-Identifier: Apache-2.0
// A film whose pixels are shared out between ranks.
#pragma once

#include "host/film/film.h"
#include "host/ranks/film_tiles.h"
#include "host/ranks/ranks.h"
#include "host/render/render.h"

#include <functional>

namespace ovc {

/// Renders these pixels of the film, none of which is done.
using RenderPart =
    std::function<Result<RenderReport>(const RenderObserver&, std::vector<uint32_t> pixels)>;

/// Marks the pixels that are done on the film of rank 0 on all films. All ranks call it.
Result<Done> spread_film(const Ranks& ranks, Film& film);

struct SharedFilmOptions {
    bool to_all = false;          // the films of all ranks get all pixels, not only that of rank 0
    uint32_t rays_per_sample = 1; // about so many, at least 1
    FirstRanks first_ranks{};     // of the pixels' rays
    /// Called on a thread of its own once no rank has rays to trace any more, while the last pixels
    /// come together.
    std::function<void()> traced{};
    /// Keeps the film so far; rank 0 calls it after a round where it has not for so many seconds.
    std::function<Result<Done>(const Film&)> keep{};
    double keep_seconds = 30;
};

/// Renders the pixels of the film that are not done, each on one rank; all ranks call it, with
/// films on which the same pixels are done. That of rank 0 has all of them afterwards. Where it is
/// stopped, or a rank is lost or fails, rank 0 has those that have come, and the report is not
/// complete. Sums of light do not depend on who adds them, so the bits are those of one rank.
Result<RenderReport> render_shared(const Ranks& ranks, Film& film, const SharedFilmOptions& options,
                                   const RenderPart& render, const RenderObserver& observe);

} // namespace ovc
