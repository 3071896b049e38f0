// SPDX-License-Identifier: Apache-2.0
// Renders a picture. Options, counts and times here are shared by the batched and the mixed form.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "host/backend/backend.h"
#include "host/camera/camera.h"
#include "host/film/film.h"
#include "host/film/pixel_filter.h"
#include "host/output/tone_mapping.h"
#include "host/render/antialias.h"
#include "host/shade/integrator.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace ovc {

class Ranks;

/// Whitted 1980 has mirrors, glass and point lights; Path, Kajiya 1986, has all light there is.
enum class IntegratorKind { Whitted, Path };

/// Algorithms 5 and 6 of the thesis. Auto is batched, which is faster (docs/benchmarks.md).
enum class RenderMode { Auto, Batched, Mixed };

/// When progressive rendering ends: by whichever comes first.
struct Progressive {
    double seconds = 0; // of wall clock; 0: no limit
    /// The noise that every block of pixels comes down to: the root mean square of its error, in
    /// sRGB codes from 0 to 1. 0: no limit, and the noisiest blocks get the most samples.
    double noise = 0;
    uint32_t max_samples = 1;         // of each pixel
    std::optional<Exposure> exposure; // of the picture, by which noise is judged
    /// Shows the picture so far, which is coarse at first: at the beginning, and again whenever as
    /// much time has gone by, but at least every 20 s. Null: nobody looks.
    std::function<void(const Film&)> show{};
};

/// The result of progressive rendering.
struct Sampled {
    uint32_t min = 0, max = 0; // samples of a pixel
    double mean = 0;
    double noise = 0; // of the noisiest block, as estimated
};

struct RenderOptions {
    IntegratorKind integrator = IntegratorKind::Whitted;
    RenderMode mode = RenderMode::Auto;
    uint32_t max_depth = 5; // max surfaces that a path leaves
    bool shadows = true;
    bool cutouts = true;                    // surfaces have the holes that their pictures cut out
    uint64_t seed = 0;                      // of path tracing
    FilterOptions filter;                   // where samples of a pixel lie; not with antialias
    float clamp = 0;                        // PathTracerOptions::clamp
    std::optional<Progressive> progressive; // not with antialias or ranks; the film has 1 sample
    std::optional<Antialias> antialias;     // none: the film's samples, evenly; else the film has 1
    std::optional<PicturePart> part;        // the film's part of the picture; none: all of it
    /// The batched form gives a backend at most so many rays at once. It bounds host memory too:
    /// at most about three times as many rays wait.
    size_t batch_rays = size_t(1) << 20;
    const Ranks* ranks = nullptr; // that render the picture together; null: this process alone
    /// Keeps the film so far. Rank 0 calls it about so often, in case that it ends by force.
    std::function<Result<Done>(const Film&)> keep{};
    double keep_seconds = 30;
    /// Ranks purge the backend once all of them have traced their part of the picture.
    bool purges = false;
};

struct RayCounts {
    uint64_t primary = 0;
    uint64_t shadow = 0;
    uint64_t reflection = 0;
    uint64_t refraction = 0;
    uint64_t bounce = 0;

    uint64_t total() const { return primary + shadow + reflection + refraction + bounce; }
    void count(RayKind kind);
    RayCounts& operator+=(const RayCounts& other);
};

struct RenderReport {
    RayCounts rays;
    double seconds = 0;       // from the first ray to the last
    double seconds_trace = 0; // of these, those in which the backend was at work
    double seconds_shade = 0; // making and shading rays, perhaps beside tracing
    double seconds_cpu = 0;   // of all threads of this process
    uint64_t pixels_done = 0;
    std::optional<Sampled> sampled; // of progressive rendering
    bool complete = false; // false: `observe` stopped it; pixels that are done are on the film
    bool failed = false;   // it is not complete because of an error, which the user was told

    RenderReport& operator+=(const RenderReport& other); // leaves `complete` as it is
};

/// Gets a report so far after every answer of the backend, from one thread at a time. Returns false
/// to stop the rendering.
using RenderObserver = std::function<bool(const RenderReport&)>;

/// Renders the pixels of the film that are not done. The same scene, camera and options give the
/// same bits in either mode, in whatever batches and on however many threads.
Result<RenderReport> render_picture(const Scene& scene, const Camera& camera, Backend& backend,
                                    const RenderOptions& options, const RenderObserver& observe,
                                    Film& film);

} // namespace ovc
