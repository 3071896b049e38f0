// SPDX-License-Identifier: Apache-2.0
// The loop of algorithm 5: trace, shade, ask for shadows, spawn reflections, until no rays are
// left.
#include "host/whitted_batched.h"

#include "core/parallel.h"
#include "host/camera.h"
#include "host/shade.h"
#include "host/stopwatch.h"

#include <algorithm>

namespace ovc {

/// Rays per task: some ten microseconds of work.
static constexpr size_t kGrain = 1024;
/// A reflection that adds less than this to its pixel is not followed; an 8-bit image would not
/// show it.
static constexpr float kLeastWeight = 1 / 512.0f;

/// One ray of a pixel and the share of the pixel's colour it decides. A pixel has one path at a
/// time, so that paths add to their pixels from several threads without locks and in an order of
/// their own.
struct Path {
    uint32_t pixel;
    vec3 weight;
};

/// The indices i < count for which keep(i), in order.
template <class Keep>
static void select(size_t count, std::vector<uint32_t>& chosen, Keep&& keep) {
    chosen.clear();
    for (size_t i = 0; i < count; ++i)
        if (keep(i))
            chosen.push_back(uint32_t(i));
}

class BatchedRenderer {
public:
    BatchedRenderer(const Scene& scene, const Camera& camera, Backend& backend,
                    const WhittedOptions& options, const RenderObserver& observe, Image& image)
        : scene_(scene),
          backend_(backend),
          options_(options),
          observe_(observe),
          image_(image),
          pinhole_(camera, image.width, image.height),
          up_(glm::normalize(camera.up)) {}

    Result<RenderReport> render() {
        const Stopwatch watch;
        const std::vector<uint32_t> order = pixel_order(image_.width, image_.height);
        report_.complete = true;
        for (size_t first = 0; first < order.size() && report_.complete;
             first += options_.batch_rays) {
            const size_t count = std::min(options_.batch_rays, order.size() - first);
            if (const Result<Done> done = render_pixels({order.data() + first, count}); !done)
                return done.error();
            report_.pixels_done += count;
        }
        report_.seconds_shade = watch.seconds() - report_.seconds_trace;
        return report_;
    }

private:
    Result<Done> render_pixels(std::span<const uint32_t> pixels) {
        start_paths(pixels);
        for (uint32_t depth = 0; !rays_.empty() && report_.complete; ++depth) {
            (depth == 0 ? report_.rays.primary : report_.rays.reflection) += rays_.size();
            hits_.resize(rays_.size());
            Result<Done> done = timed([&] { return backend_.intersect(rays_, skip_, hits_); });
            if (!done || !report_.complete)
                return done;
            shade_hits(/* last_bounce= */ depth >= options_.max_depth);
            for (const PointLight& light : scene_.lights)
                if (done = add_light(light); !done || !report_.complete)
                    return done;
            spawn_reflections();
        }
        return Done{};
    }

    /// Runs one call of the backend and tells the observer.
    template <class Call>
    Result<Done> timed(Call&& call) {
        const Stopwatch watch;
        Result<Done> done = call();
        report_.seconds_trace += watch.seconds();
        if (done && observe_ && !observe_(report_))
            report_.complete = false;
        return done;
    }

    void start_paths(std::span<const uint32_t> pixels) {
        rays_.resize(pixels.size());
        paths_.resize(pixels.size());
        skip_.clear();
        parallel_for(pixels.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i) {
                rays_[i] = pinhole_.ray(pixels[i] % image_.width, pixels[i] / image_.width);
                paths_[i] = {pixels[i], vec3(1)};
                image_.pixels[pixels[i]] = vec4(0, 0, 0, 1);
            }
        });
    }

    void add(const Path& path, const vec3& light) {
        image_.pixels[path.pixel] += vec4(path.weight * light, 0);
    }

    /// Finishes the paths that left the scene; for the others finds the surface, adds ambient
    /// light, and splits the path's weight between the surface's own colour (paths_) and the
    /// reflection (mirror_weights_).
    void shade_hits(bool last_bounce) {
        select(hits_.size(), hit_rays_, [&](size_t i) { return hits_[i].is_hit(); });
        surfaces_.resize(hit_rays_.size());
        mirror_weights_.resize(hit_rays_.size());
        parallel_for(hits_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                if (!hits_[i].is_hit())
                    add(paths_[i], background_color(scene_.background, up_, rays_[i].dir));
        });
        parallel_for(hit_rays_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t k = first; k < last; ++k) {
                const uint32_t i = hit_rays_[k];
                surfaces_[k] = surface_point(scene_, rays_[i], hits_[i]);
                const vec3 mirrored = paths_[i].weight * surfaces_[k].mirror;
                const bool follow = !last_bounce && max_component(mirrored) >= kLeastWeight;
                mirror_weights_[k] = follow ? mirrored : vec3(0);
                if (follow)
                    paths_[i].weight -= mirrored;
                add(paths_[i], ambient_light(scene_.background, up_, surfaces_[k]));
            }
        });
    }

    /// Adds one light to every surface that it reaches.
    Result<Done> add_light(const PointLight& light) {
        arriving_.resize(surfaces_.size());
        parallel_for(surfaces_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t k = first; k < last; ++k)
                arriving_[k] = direct_light(light, surfaces_[k]);
        });
        select(surfaces_.size(), chosen_, [&](size_t k) { return arriving_[k] != vec3(0); });
        occluded_.assign(chosen_.size(), 0);
        if (options_.shadows)
            if (Result<Done> done = trace_shadows(light); !done || !report_.complete)
                return done;
        parallel_for(chosen_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t j = first; j < last; ++j)
                if (!occluded_[j])
                    add(paths_[hit_rays_[chosen_[j]]], arriving_[chosen_[j]]);
        });
        return Done{};
    }

    Result<Done> trace_shadows(const PointLight& light) {
        if (chosen_.empty())
            return Done{};
        next_rays_.resize(chosen_.size());
        next_skip_.resize(chosen_.size());
        parallel_for(chosen_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t j = first; j < last; ++j) {
                next_rays_[j] = shadow_ray(light, surfaces_[chosen_[j]]);
                next_skip_[j] = hits_[hit_rays_[chosen_[j]]].id;
            }
        });
        report_.rays.shadow += chosen_.size();
        return timed([&] { return backend_.occluded(next_rays_, next_skip_, occluded_); });
    }

    /// Replaces the rays by the reflections of those that hit a mirror.
    void spawn_reflections() {
        select(surfaces_.size(), chosen_, [&](size_t k) { return mirror_weights_[k] != vec3(0); });
        next_rays_.resize(chosen_.size());
        next_skip_.resize(chosen_.size());
        next_paths_.resize(chosen_.size());
        parallel_for(chosen_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t j = first; j < last; ++j) {
                const uint32_t k = chosen_[j];
                const uint32_t i = hit_rays_[k];
                next_rays_[j] = mirror_ray(rays_[i], surfaces_[k]);
                next_skip_[j] = hits_[i].id;
                next_paths_[j] = {paths_[i].pixel, mirror_weights_[k]};
            }
        });
        rays_.swap(next_rays_);
        skip_.swap(next_skip_);
        paths_.swap(next_paths_);
    }

    const Scene& scene_;
    Backend& backend_;
    const WhittedOptions options_;
    const RenderObserver& observe_;
    Image& image_;
    const Pinhole pinhole_;
    const vec3 up_;
    RenderReport report_;

    // One entry per ray of the round; all are kept between rounds so that they are allocated once.
    std::vector<Ray> rays_, next_rays_;
    std::vector<TriangleId> skip_, next_skip_;
    std::vector<Path> paths_, next_paths_;
    std::vector<Hit> hits_;
    // One entry per ray that hit.
    std::vector<uint32_t> hit_rays_;
    std::vector<SurfacePoint> surfaces_;
    std::vector<vec3> mirror_weights_, arriving_;
    // One entry per surface chosen: that a light may reach, or that reflects.
    std::vector<uint32_t> chosen_;
    std::vector<uint8_t> occluded_;
};

Result<RenderReport> render_batched(const Scene& scene, const Camera& camera, Backend& backend,
                                    const WhittedOptions& options, const RenderObserver& observe,
                                    Image& image) {
    return BatchedRenderer(scene, camera, backend, options, observe, image).render();
}

} // namespace ovc
