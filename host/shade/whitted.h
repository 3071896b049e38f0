// SPDX-License-Identifier: Apache-2.0
// Whitted's integrator has lights with shadows, mirrors and glass.
// Based on: Whitted 1980, "An Improved Illumination Model for Shaded Display".
#pragma once

#include "core/scene.h"
#include "core/system/log.h"
#include "host/shade/integrator.h"
#include "host/shade/shade.h"
#include "host/shade/surface/media.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace ovc {

/// A reflection or refraction that adds less than this to its pixel is not followed; an 8-bit image
/// would hardly show it, and POV-Ray does not follow it either (adc_bailout). The shares of a
/// camera ray's paths add up to at most 1, so it never has more than 255 of them at a time.
inline constexpr float kMinWeight = 1 / 255.0f;

/// Tells the log how this integrator simplifies the scene's light where path tracing does not.
/// lights: those of the picture. source: the scene's name on the command line.
void tell_simplifications(const Scene& scene, std::span<const Light> lights,
                          std::string_view source, const LogSink& log);

class BouncedLight;

struct WhittedOptions {
    /// Max reflections and refractions in a row, below 2^16; the last surface shows its own color
    /// alone.
    uint32_t max_depth = 5;
    bool shadows = true;
    bool media = true;                     // the scene's are seen
    std::optional<dvec3> eye{};            // the camera's, which may lie in media
    const BouncedLight* bounced = nullptr; // the scene's diffuse light, which outlives the rays
    /// A path asks one light in so many, which counts for as many. Its sample says which ones, so
    /// that so many samples in a row have asked all.
    uint32_t light_stride = 1;
};

class Whitted final : public Integrator {
public:
    /// up: of the background, unit length. The scene must outlive it, and its lights must be
    /// placed.
    Whitted(const Scene& scene, const vec3& up, const WhittedOptions& options);

    void shade(std::span<const Ray> rays, std::span<const Path> paths, std::span<const Hit> hits,
               Film& film, Spawned& spawned) const override;
    size_t max_shadow_rays() const override { return ovc::max_shadow_rays(scene_); }
    bool light_may_pass() const override { return light_may_pass_; }
    bool pass(const Hit& hit, Ray& ray, Shadow& shadow) const override;

private:
    struct Met;
    void look_around(const dvec3& eye);
    void dim_by_fog(const Ray& ray, const Hit& hit, Path& path, Film& film) const;
    void dim_by_media(const Ray& ray, const Hit& hit, Path& path, Film& film,
                      Spawned& spawned) const;
    std::vector<const Medium*> media_along(const Path& path) const;
    void scatter(const ScatteringPlace& from, const dvec3& way, const Path& path, uint32_t turn,
                 Film& film, Spawned& spawned) const;
    vec3 share_of_air(const Light& light, const Ray& ray) const;
    Containers inside_behind(const Path& path, const Met& met, bool goes_through) const;
    void follow(const Ray& ray, const Path& path, const Hit& hit, Met& met, Spawned& spawned) const;
    void light_up(const Light& light, uint32_t number, const Met& met, Film& film,
                  Spawned& spawned) const;

    const Scene& scene_;
    const vec3 up_;
    const WhittedOptions options_;
    const bool light_may_pass_;
    const bool needs_cones_;
    const bool has_media_;
    const std::vector<const Medium*> air_;          // the media outside of containers
    std::vector<std::vector<const Medium*>> media_; // by a container's number; none has 0
    std::vector<uint16_t> containers_;              // their numbers, by material
    Containers around_eye_;
    Solids eye_within_; // of which those are not listed that are hollow
};

} // namespace ovc
