// SPDX-License-Identifier: Apache-2.0
// PathTracer finds all light there is by random paths. A picture's mean is the truth, and its noise
// falls with the root of the samples.
// Based on: Kajiya 1986, "The Rendering Equation"; Veach and Guibas 1995, "Optimally Combining
// Sampling Techniques for Monte Carlo Rendering" (multiple importance sampling); Arvo and Kirk
// 1990, "Particle Transport and Image Synthesis" (Russian roulette).
#pragma once

#include "core/scene.h"
#include "core/system/log.h"
#include "host/shade/integrator.h"
#include "host/shade/lights/light_sampler.h"
#include "host/shade/surface/bsdf.h"

#include <cstdint>
#include <string_view>

namespace ovc {

/// How light of emitters is found: by shadow rays, by paths that happen to hit them, or by both,
/// each where it is the better one. All have the same mean, except that shadow rays see nothing in
/// mirrors.
enum class LightSearch { Both, ShadowRays, Paths };

struct PathTracerOptions {
    uint32_t max_depth = 16; // max surfaces that a path leaves; below 2^16
    bool shadows = true;
    bool cutouts = true; // emitters have their holes
    uint64_t seed = 0;
    PicturePart part = {{1, 1}, 0, 0, {1, 1}}; // where the film lies in the picture
    LightSearch search = LightSearch::Both;
    /// The most light, in any color, that a pixel's sample gets at once by way of a surface that
    /// scatters; the rest of it is left out. 0: no limit.
    float clamp = 0;
};

class PathTracer final : public Integrator {
public:
    /// up: of the background, unit length. The scene must outlive it, and its lights must be
    /// placed.
    PathTracer(const Scene& scene, const vec3& up, const PathTracerOptions& options);

    void shade(std::span<const Ray> rays, std::span<const Path> paths, std::span<const Hit> hits,
               Film& film, Spawned& spawned) const override;
    size_t max_shadow_rays() const override { return 1; }
    bool light_may_pass() const override { return light_may_pass_; }
    bool pass(const Hit& hit, Ray& ray, Shadow& shadow) const override;

private:
    struct Met;
    struct Sides;
    void meet(const Ray& ray, Path path, const Hit& hit, Film& film, Sides& sides,
              Spawned& spawned) const;
    vec3 seen_sky(const Ray& ray, const Path& path) const;
    vec3 seen_emission(const Met& met) const;
    void light_up(const Met& met, double choice, const dvec2& u, Film& film,
                  Spawned& spawned) const;
    vec3 clamped(const Path& path, const vec3& light) const;
    void go_on(const Met& met, const Scattered& scattered, const vec3& weight, Sides& sides) const;

    const Scene& scene_;
    const vec3 up_;
    const PathTracerOptions options_;
    const LightSampler lights_;
    const float unexposed_; // converts the scene's light to the file's
    const bool needs_cones_;
    const bool light_may_pass_;
};

/// Warns of what the scene has and path tracing does not follow: fog, media, and words of POV-Ray's
/// finishes. source: the name of what the scene was read from.
void tell_what_paths_leave_out(const Scene& scene, std::string_view source, const LogSink& log);

} // namespace ovc
