// SPDX-License-Identifier: Apache-2.0
// Progressive rendering takes pass after pass over a picture, until it is good enough or its time
// is over, and more of them where it is noisy.
#pragma once

#include "core/result.h"
#include "host/film/film.h"
#include "host/output/tone_mapping.h"
#include "host/render/render.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace ovc {

/// Samples of some pixels.
struct Pass {
    std::vector<uint32_t> pixels; // of the film, each once; neighbours follow each other
    uint32_t first_sample = 0;    // of each pixel: the number of the first one of the pass
    uint32_t samples = 1;         // of each pixel
    bool for_estimate = false;    // other random numbers than those of the picture's samples
};

/// Renders a pass onto a film that has its samples.
using RenderPass = std::function<Result<RenderReport>(const Pass&, const RenderObserver&, Film&)>;

/// Renders a film of one sample a pixel, which gets the mean of each pixel's samples. All pixels
/// have a first sample, whatever the time. Further ones go to blocks of pixels whose noise is above
/// the limit, and without one to the noisiest.
///
/// The number of a block's samples depends on samples that the picture does not have, and on the
/// clock, so that each pixel's expectation is the truth. gamma: of the scene. Where observe() stops
/// it, the film has the passes that are complete, if any, and the report is not complete.
Result<RenderReport> render_progressively(const Progressive& options, double gamma,
                                          const RenderPass& render, const RenderObserver& observe,
                                          Film& film);

} // namespace ovc
