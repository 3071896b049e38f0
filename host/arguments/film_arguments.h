// SPDX-License-Identifier: Apache-2.0
// The options of `overcast render` for samples and the film: how a pixel is sampled, and how its
// light becomes tones.
#pragma once

#include "core/result.h"

#include <string>

namespace CLI {
class App;
}

namespace ovc {

struct RenderJob;

/// The options as the user wrote them; empty where not given.
class FilmArguments {
public:
    void add_to(CLI::App& app);
    /// Writes what the options ask for into the job, whose integrator is known.
    Result<Done> resolve(RenderJob& job) const;

private:
    void add_samples_to(CLI::App& app);
    void add_passes_to(CLI::App& app);
    void add_lens_to(CLI::App& app);
    void add_tones_to(CLI::App& app);
    Result<Done> resolve_antialias(RenderJob& job) const;
    Result<Done> resolve_samples(RenderJob& job) const;
    Result<Done> resolve_passes(RenderJob& job) const;
    Result<Done> resolve_filter(RenderJob& job) const;
    Result<Done> resolve_lens(RenderJob& job) const;
    Result<Done> resolve_tones(RenderJob& job) const;

    std::string samples_;
    std::string antialias_, antialias_method_, antialias_depth_, jitter_;
    std::string seed_;
    std::string time_, noise_;
    std::string filter_, filter_radius_;
    std::string clamp_;
    std::string lens_radius_, focus_;
    std::string exposure_, tone_map_;
    std::string png_bits_;
    bool denoise_ = false, view_ = false;
};

} // namespace ovc
