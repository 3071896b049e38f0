// SPDX-License-Identifier: Apache-2.0
// The loop of algorithm 5: trace, shade, ask for shadows, spawn reflections and refractions, until
// no rays are left.
#include "host/whitted_batched.h"

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "host/camera.h"
#include "host/shade.h"

#include <algorithm>
#include <utility>

namespace ovc {

/// Rays per task: some ten microseconds of work.
static constexpr size_t kGrain = 1024;
/// A reflection or refraction that adds less than this to its pixel is not followed; an 8-bit image
/// would not show it. The shares of a pixel's paths add up to at most 1, so it never has more than
/// 512 of them at a time.
static constexpr float kLeastWeight = 1 / 512.0f;

/// What a ray is for: the share of its pixel's color that it decides.
struct Path {
    uint32_t pixel;
    uint32_t depth; // reflections and refractions that led here
    vec3 weight;
};

/// Rays and what belongs to each of them. The rays of a pixel stand side by side and are all of one
/// depth, so that a pixel's sum does not depend on what else is traced with it.
struct Frontier {
    std::vector<Ray> rays;
    std::vector<TriangleId> skip; // empty, or one for each ray
    std::vector<Path> paths;

    size_t size() const { return rays.size(); }
    bool empty() const { return rays.empty(); }

    /// skip too. What is new is to be filled in.
    void resize(size_t count) {
        rays.resize(count);
        skip.resize(count);
        paths.resize(count);
    }

    /// Moves the rays from `first` on into `to`, whose own are lost.
    void move_tail(size_t first, Frontier& to) {
        to.rays.assign(rays.begin() + ptrdiff_t(first), rays.end());
        to.skip.assign(skip.begin() + ptrdiff_t(first), skip.end());
        to.paths.assign(paths.begin() + ptrdiff_t(first), paths.end());
        resize(first);
    }
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
          up_(glm::normalize(camera.up)),
          glass_(std::any_of(scene.materials.begin(), scene.materials.end(),
                             [](const Material& m) { return m.transmission > 0; }) ||
                 std::any_of(scene.meshes.begin(), scene.meshes.end(),
                             [](const MeshInfo& m) { return m.no_shadow; })) {}

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
        waiting_.resize(0);
        while (!now_.empty() && report_.complete) {
            hits_.resize(now_.size());
            Result<Done> done =
                timed([&] { return backend_.intersect(now_.rays, now_.skip, hits_); });
            if (!done || !report_.complete)
                return done;
            shade_hits();
            for (const Light& light : scene_.lights)
                if (done = add_light(light); !done || !report_.complete)
                    return done;
            add_to_image();
            spawn();
            take_waiting();
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
        now_.resize(pixels.size());
        now_.skip.clear();
        parallel_for(pixels.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i) {
                now_.rays[i] = pinhole_.ray(pixels[i] % image_.width, pixels[i] / image_.width);
                now_.paths[i] = {pixels[i], 0, vec3(1)};
                image_.pixels[pixels[i]] = vec4(0, 0, 0, 1);
            }
        });
        report_.rays.primary += pixels.size();
    }

    /// Finds what each path sees by itself: the background, or a surface in ambient light.
    void shade_hits() {
        select(hits_.size(), hit_rays_, [&](size_t i) { return hits_[i].is_hit(); });
        surfaces_.resize(hit_rays_.size());
        child_weights_.resize(2 * hit_rays_.size());
        radiance_.resize(hits_.size());
        parallel_for(hits_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                if (!hits_[i].is_hit())
                    radiance_[i] = background_color(scene_.background, up_, now_.rays[i].dir);
        });
        parallel_for(hit_rays_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t k = first; k < last; ++k) {
                const uint32_t i = hit_rays_[k];
                surfaces_[k] = surface_point(scene_, now_.rays[i], hits_[i]);
                split_weight(k);
                radiance_[i] = ambient_light(scene_.background, up_, surfaces_[k]);
            }
        });
    }

    /// Divides the weight of the path to surface k among the surface's own color, which keeps
    /// what is not followed, and the two rays that may leave it.
    void split_weight(size_t k) {
        const uint32_t i = hit_rays_[k];
        Path& path = now_.paths[i];
        const bool total =
            surfaces_[k].material->transmission > 0 && !refracted_ray(now_.rays[i], surfaces_[k]);
        const Branches parts = branches(surfaces_[k], total);
        const vec3 shares[] = {parts.mirror, parts.through};
        const float taken[] = {parts.taken_by_mirror, parts.taken_by_through};
        const vec3 whole = path.weight;
        for (int kind = 0; kind < 2; ++kind) {
            const vec3 weight = whole * shares[kind];
            const bool follow =
                path.depth < options_.max_depth && max_component(weight) >= kLeastWeight;
            child_weights_[2 * k + size_t(kind)] = follow ? weight : vec3(0);
            if (follow)
                path.weight -= whole * taken[kind];
        }
    }

    /// Adds one light to every surface that it reaches.
    Result<Done> add_light(const Light& light) {
        arriving_.resize(surfaces_.size());
        parallel_for(surfaces_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t k = first; k < last; ++k)
                arriving_[k] = direct_light(light, surfaces_[k]);
        });
        if (options_.shadows && !light.shadowless)
            if (Result<Done> done = trace_shadows(light); !done || !report_.complete)
                return done;
        parallel_for(surfaces_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t k = first; k < last; ++k)
                radiance_[hit_rays_[k]] += arriving_[k];
        });
        return Done{};
    }

    /// Takes from arriving_ what does not reach its surface.
    Result<Done> trace_shadows(const Light& light) {
        select(surfaces_.size(), chosen_, [&](size_t k) { return arriving_[k] != vec3(0); });
        shadow_rays_.resize(chosen_.size());
        shadow_skip_.resize(chosen_.size());
        parallel_for(chosen_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t j = first; j < last; ++j) {
                shadow_rays_[j] = shadow_ray(light, surfaces_[chosen_[j]].position);
                shadow_skip_[j] = hits_[hit_rays_[chosen_[j]]].id;
            }
        });
        for (uint32_t depth = 0; !chosen_.empty(); ++depth) {
            report_.rays.shadow += chosen_.size();
            const Result<Done> done = glass_ ? dim_by_glass(light, depth) : block();
            if (!done || !report_.complete)
                return done;
        }
        return Done{};
    }

    /// Nothing is let through: whatever is in the way blocks the light, and all rays are answered.
    Result<Done> block() {
        occluded_.resize(chosen_.size());
        Result<Done> done =
            timed([&] { return backend_.occluded(shadow_rays_, shadow_skip_, occluded_); });
        for (size_t j = 0; j < chosen_.size(); ++j)
            if (occluded_[j])
                arriving_[chosen_[j]] = vec3(0);
        chosen_.clear();
        return done;
    }

    /// Follows the shadow rays to the nearest surface in their way, straight on as POV-Ray does,
    /// and keeps those that light comes through.
    Result<Done> dim_by_glass(const Light& light, uint32_t depth) {
        shadow_hits_.resize(chosen_.size());
        Result<Done> done =
            timed([&] { return backend_.intersect(shadow_rays_, shadow_skip_, shadow_hits_); });
        if (!done || !report_.complete)
            return done;
        occluded_.resize(chosen_.size());
        parallel_for(chosen_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t j = first; j < last; ++j)
                occluded_[j] = shadow_hits_[j].is_hit() && pass_glass(light, depth, j);
        });
        size_t kept = 0;
        for (size_t j = 0; j < chosen_.size(); ++j)
            if (occluded_[j]) {
                shadow_rays_[kept] = shadow_rays_[j];
                shadow_skip_[kept] = shadow_hits_[j].id;
                chosen_[kept++] = chosen_[j];
            }
        shadow_rays_.resize(kept);
        shadow_skip_.resize(kept);
        chosen_.resize(kept);
        return done;
    }

    /// Dims the light of shadow ray j by what it hit; true when some is left, and the ray begins
    /// behind it.
    bool pass_glass(const Light& light, uint32_t depth, size_t j) {
        const SurfacePoint glass = surface_point(scene_, shadow_rays_[j], shadow_hits_[j]);
        vec3& left = arriving_[chosen_[j]];
        if (!scene_.meshes[shadow_hits_[j].id.mesh].no_shadow) {
            left *= branches(glass, /* total= */ false).through;
            if (depth >= options_.max_depth || max_component(left) < kLeastWeight)
                left = vec3(0);
        }
        const dvec3 there = shadow_rays_[j].dir;
        shadow_rays_[j] = shadow_ray(light, glass.beyond);
        // A light that lies in the surface has been reached; going back to it might never end.
        return left != vec3(0) && glm::dot(shadow_rays_[j].dir, there) > 0;
    }

    /// A pixel's paths are added in their order, by whoever has the first of them.
    void add_to_image() {
        const std::vector<Path>& paths = now_.paths;
        const auto goes_on = [&](size_t i) {
            return i > 0 && i < paths.size() && paths[i].pixel == paths[i - 1].pixel;
        };
        parallel_for(paths.size(), kGrain, [&](size_t first, size_t last) {
            while (first < last && goes_on(first))
                ++first;
            for (size_t i = first; i < last || (first < last && goes_on(i)); ++i)
                image_.pixels[paths[i].pixel] += vec4(paths[i].weight * radiance_[i], 0);
        });
    }

    /// Puts the reflected and refracted rays behind those that wait.
    void spawn() {
        select(child_weights_.size(), chosen_,
               [&](size_t c) { return child_weights_[c] != vec3(0); });
        const size_t before = waiting_.size();
        waiting_.resize(before + chosen_.size());
        parallel_for(chosen_.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t j = first; j < last; ++j) {
                const SurfacePoint& surface = surfaces_[chosen_[j] / 2];
                const uint32_t i = hit_rays_[chosen_[j] / 2];
                const Path& path = now_.paths[i];
                waiting_.rays[before + j] = is_refraction(chosen_[j])
                                                ? *refracted_ray(now_.rays[i], surface)
                                                : mirror_ray(now_.rays[i], surface);
                waiting_.skip[before + j] = hits_[i].id;
                waiting_.paths[before + j] = {path.pixel, path.depth + 1,
                                              child_weights_[chosen_[j]]};
            }
        });
        const size_t refractions =
            size_t(std::count_if(chosen_.begin(), chosen_.end(), is_refraction));
        report_.rays.refraction += refractions;
        report_.rays.reflection += chosen_.size() - refractions;
    }

    static bool is_refraction(uint32_t child) { return child % 2 == 1; }

    /// The rays to trace next: all that wait, while one batch holds them. Where splitting rays have
    /// made them more, the deepest few: n rays leave at most n waiting at each depth below theirs.
    void take_waiting() {
        size_t first = 0;
        if (waiting_.size() > options_.batch_rays) {
            const size_t few = options_.batch_rays / (size_t(options_.max_depth) + 1);
            first = waiting_.size() - std::max<size_t>(few, 1);
            while (first > 0 && waiting_.paths[first].pixel == waiting_.paths[first - 1].pixel)
                --first;
        }
        if (first > 0)
            return waiting_.move_tail(first, now_);
        std::swap(now_, waiting_);
        waiting_.resize(0);
    }

    const Scene& scene_;
    Backend& backend_;
    const WhittedOptions options_;
    const RenderObserver& observe_;
    Image& image_;
    const Pinhole pinhole_;
    const vec3 up_;
    const bool glass_; // light may pass some material or mesh
    RenderReport report_;

    // All are kept between rounds so that they are allocated once.
    Frontier now_;     // being traced
    Frontier waiting_; // the deepest last
    // One entry per ray being traced.
    std::vector<Hit> hits_;
    std::vector<vec3> radiance_; // what the ray sees, but for its children's part
    // One entry per ray that hit.
    std::vector<uint32_t> hit_rays_;
    std::vector<SurfacePoint> surfaces_;
    std::vector<vec3> arriving_;
    // Two entries per ray that hit: of the reflected and of the refracted ray; 0: there is none.
    std::vector<vec3> child_weights_;
    // One entry per surface that a light may reach, then per child.
    std::vector<uint32_t> chosen_;
    std::vector<Ray> shadow_rays_;
    std::vector<TriangleId> shadow_skip_;
    std::vector<Hit> shadow_hits_;
    std::vector<uint8_t> occluded_; // or dimmed, and some light is left
};

Result<RenderReport> render_batched(const Scene& scene, const Camera& camera, Backend& backend,
                                    const WhittedOptions& options, const RenderObserver& observe,
                                    Image& image) {
    return BatchedRenderer(scene, camera, backend, options, observe, image).render();
}

} // namespace ovc
