// SPDX-License-Identifier: Apache-2.0
// Traces one batch of camera rays after another, and writes their hits into layers.
#include "host/output/aov.h"

#include "core/system/parallel.h"
#include "core/text/suggestion.h"
#include "host/camera/camera.h"
#include "host/render/sight.h"
#include "host/shade/shade.h"
#include "host/shade/surface/bsdf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>

namespace ovc {
namespace {

constexpr std::string_view kNames[] = {"depth", "normal", "albedo", "id",
                                       "leaf",  "passes", "flagged"};
constexpr size_t kBatchRays = size_t(1) << 20;
/// Means of more samples than these look alike.
constexpr uint32_t kMeanSamples = 16;
constexpr size_t kLayerGrain = 1024; // pixels a task

Layer layer(std::string name, Layer::Type type, size_t pixels) {
    return {std::move(name), type, std::vector<uint32_t>(pixels)};
}

/// The layers that are wanted; set() fills in a pixel.
class Layers {
public:
    Layers(const Aovs& aovs, size_t pixels) : aovs_(aovs) {
        if (aovs.depth)
            all_.push_back(layer("depth.Z", Layer::Type::Float, pixels));
        for (const char* name : {"normal.X", "normal.Y", "normal.Z"})
            if (aovs.normal)
                all_.push_back(layer(name, Layer::Type::Float, pixels));
        for (const char* name : {"albedo.R", "albedo.G", "albedo.B"})
            if (aovs.albedo)
                all_.push_back(layer(name, Layer::Type::Float, pixels));
        for (const char* name : {"id.mesh", "id.prim"})
            if (aovs.id)
                all_.push_back(layer(name, Layer::Type::Uint, pixels));
        if (aovs.leaf)
            all_.push_back(layer("leaf", Layer::Type::Uint, pixels));
        if (aovs.passes)
            all_.push_back(layer("passes", Layer::Type::Uint, pixels));
        if (aovs.flagged)
            all_.push_back(layer("flagged", Layer::Type::Uint, pixels));
    }

    /// The values for denoisers, of one ray or means over several.
    struct Look {
        vec3 normal{0}, albedo{0};
    };
    Look looked_at(const Scene& scene, const Ray& ray, const Hit& hit,
                   const Cone& cone = {}) const {
        if (!aovs_.normal && !aovs_.albedo)
            return {};
        if (!hit.is_hit())
            return {vec3(0), vec3(1)};
        const SurfacePoint surface = surface_point(scene, ray, hit, cone);
        return {vec3(surface.normal), aovs_.albedo ? Bsdf(surface).albedo() : vec3(0)};
    }

    /// Replaces normals and albedos by the means of others. looks: of each pixel, their sum.
    void put_means(std::span<const Look> looks, uint32_t samples) {
        for (Layer& one : all_) {
            const bool is_normal = one.name.starts_with("normal.");
            if (!is_normal && !one.name.starts_with("albedo."))
                continue;
            const int channel = one.name.back() == 'X' || one.name.back() == 'R'   ? 0
                                : one.name.back() == 'Y' || one.name.back() == 'G' ? 1
                                                                                   : 2;
            for (size_t i = 0; i < looks.size(); ++i) {
                const vec3& sum = is_normal ? looks[i].normal : looks[i].albedo;
                one.values[i] = std::bit_cast<uint32_t>(sum[channel] / float(samples));
            }
        }
    }

    /// Returns the memory in which the backend writes its notes of the rays of these pixels.
    RayNotes notes(size_t first, size_t count) {
        const auto values = [&](bool wanted, std::string_view name) {
            const auto found = std::find_if(all_.begin(), all_.end(),
                                            [&](const Layer& one) { return one.name == name; });
            return wanted ? std::span(found->values).subspan(first, count) : std::span<uint32_t>();
        };
        return {values(aovs_.leaf, "leaf"), values(aovs_.passes, "passes"),
                values(aovs_.flagged, "flagged")};
    }

    void set(size_t pixel, const Scene& scene, const Ray& ray, const Hit& hit) {
        size_t next = 0;
        const auto put = [&](uint32_t bits) { all_[next++].values[pixel] = bits; };
        if (aovs_.depth)
            put(std::bit_cast<uint32_t>(float(hit.t)));
        const auto put_three = [&](const vec3& values) {
            for (int axis = 0; axis < 3; ++axis)
                put(std::bit_cast<uint32_t>(values[axis]));
        };
        const Look look = looked_at(scene, ray, hit);
        if (aovs_.normal)
            put_three(look.normal);
        if (aovs_.albedo)
            put_three(look.albedo);
        if (aovs_.id) {
            put(hit.id.mesh);
            put(hit.id.prim);
        }
    }

    std::vector<Layer> take() { return std::move(all_); }

private:
    const Aovs aovs_;
    std::vector<Layer> all_;
};

} // namespace

Result<Aovs> parse_aovs(std::string_view text) {
    Aovs aovs;
    while (true) {
        const size_t comma = std::min(text.find(','), text.size());
        const std::string_view name = text.substr(0, comma);
        bool* const wanted = name == "depth"     ? &aovs.depth
                             : name == "normal"  ? &aovs.normal
                             : name == "albedo"  ? &aovs.albedo
                             : name == "id"      ? &aovs.id
                             : name == "leaf"    ? &aovs.leaf
                             : name == "passes"  ? &aovs.passes
                             : name == "flagged" ? &aovs.flagged
                                                 : nullptr;
        if (!wanted)
            return Error{fmt::format("--aov: '{}' is none of {}{}", name, fmt::join(kNames, ", "),
                                     did_you_mean(name, kNames))};
        if (*wanted)
            return Error{fmt::format("--aov: {} is given twice", name)};
        *wanted = true;
        if (comma == text.size())
            return aovs;
        text.remove_prefix(comma + 1);
    }
}

/// Traces `samples` camera rays of each pixel, for normals and albedos.
static Result<Done> put_means(const Scene& scene, const Pinhole& camera, const Sight& sight,
                              Backend& backend, uint32_t samples, const CameraSampling& sampling,
                              Layers& layers) {
    const Film film(camera.width(), camera.height(), samples);
    const CameraRays all(camera, film, sampling);
    std::vector<Layers::Look> looks(size_t(camera.width()) * camera.height());
    RayList<Path> rays;
    std::vector<Hit> hits;
    std::vector<uint32_t> masks;
    // A batch has whole pixels, whose rays follow each other, so that a sum has one thread.
    const size_t batch = std::max<size_t>(kBatchRays / samples, 1) * samples;
    for (uint64_t start = 0; start < all.size(); start += batch) {
        rays.resize(0);
        all.make(start, size_t(std::min<uint64_t>(batch, all.size() - start)), rays);
        hits.resize(rays.size());
        Exclusions without;
        without.sieves = sight.of_camera(rays.size(), masks);
        if (const Result<Done> done = backend.intersect(rays.rays, without, hits); !done)
            return done;
        parallel_for(rays.size() / samples, kLayerGrain, [&](size_t first, size_t last) {
            for (size_t i = first * samples; i < last * samples; ++i) {
                const auto look =
                    layers.looked_at(scene, rays.rays[i], hits[i], rays.purposes[i].cone);
                looks[rays.purposes[i].pixel].normal += look.normal;
                looks[rays.purposes[i].pixel].albedo += look.albedo;
            }
        });
    }
    layers.put_means(looks, samples);
    return Done{};
}

Result<std::vector<Layer>> trace_aovs(const Scene& scene, const Pinhole& camera, const Sight& sight,
                                      Backend& backend, const Aovs& aovs, uint32_t samples,
                                      const CameraSampling& sampling) {
    const uint32_t width = camera.width();
    const size_t pixels = size_t(width) * camera.height();
    Layers layers(aovs, pixels);
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<uint32_t> masks;
    for (size_t start = 0; start < pixels; start += kBatchRays) {
        rays.resize(std::min(kBatchRays, pixels - start));
        hits.resize(rays.size());
        parallel_for(rays.size(), kLayerGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                rays[i] = camera.ray(uint32_t((start + i) % width), uint32_t((start + i) / width));
        });
        Exclusions without;
        without.sieves = sight.of_camera(rays.size(), masks);
        if (const Result<Done> done =
                backend.intersect_noted(rays, without, hits, layers.notes(start, rays.size()));
            !done)
            return done.error();
        parallel_for(rays.size(), kLayerGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                layers.set(start + i, scene, rays[i], hits[i]);
        });
    }
    if (samples > 1 && (aovs.normal || aovs.albedo))
        if (const Result<Done> done = put_means(scene, camera, sight, backend,
                                                std::min(samples, kMeanSamples), sampling, layers);
            !done)
            return done.error();
    return layers.take();
}

} // namespace ovc
