// SPDX-License-Identifier: Apache-2.0
// Algorithm 6 from the host's side: every answer is shaded when it comes, and what it spawns joins
// the stream at once.
#include "host/whitted_mixed.h"

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "host/camera.h"
#include "host/slots.h"

#include <array>
#include <atomic>
#include <cmath>

namespace ovc {
namespace {

constexpr size_t kGrain = 256;       // answers a task
constexpr size_t kSpawned = 1 << 18; // rays at most that a block of answers spawns

/// Sums that do not depend on the order of what is added: in multiples of 2^-32.
class PixelSums {
public:
    explicit PixelSums(size_t pixels) : sums_(pixels) {}

    void add(uint32_t pixel, const vec3& color) {
        for (int channel = 0; channel < 3; ++channel)
            sums_[pixel][size_t(channel)].fetch_add(fixed(color[channel]),
                                                    std::memory_order_relaxed);
    }
    vec3 of(size_t pixel) const {
        const auto& sum = sums_[pixel];
        return vec3(dvec3(double(sum[0]), double(sum[1]), double(sum[2])) * 0x1p-32);
    }

private:
    /// Light brighter than a million is a million; NaN is dark.
    static int64_t fixed(float x) {
        return x == x ? std::llround(double(std::clamp(x, -1e6f, 1e6f)) * 0x1p32) : 0;
    }
    std::vector<std::array<std::atomic<int64_t>, 3>> sums_;
};

/// A ray whose nearest hit is wanted.
struct PathRay {
    Path path;
    Ray ray;
};

/// A shadow ray, and what its pixel gets where it arrives.
struct ShadowRay {
    vec3 arriving;
    vec3 weight;
    uint32_t pixel;
    uint32_t light;
    uint32_t depth; // surfaces passed
    Ray ray;
};

/// Rays to push, with whom they belong to: gathered by many threads, each at its own place.
template <class Owner>
struct Spawned {
    std::vector<uint8_t> wanted;
    std::vector<Owner> owners;
    std::vector<TriangleId> skip;

    void resize(size_t count) {
        wanted.assign(count, 0);
        owners.resize(count);
        skip.resize(count);
    }
    void set(size_t i, const Owner& owner, TriangleId start) {
        wanted[i] = 1;
        owners[i] = owner;
        skip[i] = start;
    }
};

class MixedRenderer final : public StreamHost {
public:
    MixedRenderer(const Scene& scene, const Camera& camera, Backend& backend,
                  const WhittedOptions& options, const RenderObserver& observe, Image& image)
        : scene_(scene),
          backend_(backend),
          options_(options),
          observe_(observe),
          image_(image),
          pinhole_(camera, image.width, image.height),
          up_(glm::normalize(camera.up)),
          glass_(lets_light_through(scene)),
          order_(pixel_order(image.width, image.height)),
          sums_(image.pixels.size()) {}

    Result<RenderReport> render() {
        const Stopwatch watch;
        const Result<Done> done = backend_.stream(*this);
        if (!done && done.error().kind != ErrorKind::Cancelled)
            return done.error();
        report_.complete = bool(done);
        for (size_t i = 0; i < begun_; ++i)
            image_.pixels[order_[i]] = vec4(sums_.of(order_[i]), 1);
        report_.seconds_trace = watch.seconds() - report_.seconds_shade;
        return report_;
    }

    bool more(RayStream& stream, size_t wanted) override {
        const Stopwatch watch;
        const size_t first = begun_;
        begun_ += std::min(wanted, order_.size() - begun_);
        Spawned<PathRay> camera;
        camera.resize(begun_ - first);
        parallel_for(begun_ - first, kGrain, [&](size_t from, size_t to) {
            for (size_t i = from; i < to; ++i) {
                const uint32_t pixel = order_[first + i];
                const Ray ray = pinhole_.ray(pixel % image_.width, pixel / image_.width);
                camera.set(i, {{pixel, 0, vec3(1)}, ray}, {});
            }
        });
        report_.rays.primary += push_paths(stream, camera);
        report_.seconds_shade += watch.seconds();
        return true;
    }

    bool hits(RayStream& stream, std::span<const uint64_t> tokens,
              std::span<const Hit> hits) override {
        const Stopwatch watch;
        const size_t block = kSpawned / (scene_.lights.size() + 2) + 1;
        for (size_t first = 0; first < tokens.size(); first += block) {
            const size_t count = std::min(block, tokens.size() - first);
            shade(stream, tokens.subspan(first, count), hits.subspan(first, count));
        }
        return go_on(watch);
    }

    bool occlusions(RayStream&, std::span<const uint64_t> tokens,
                    std::span<const uint8_t> occluded) override {
        const Stopwatch watch;
        parallel_for(tokens.size(), kGrain, [&](size_t from, size_t to) {
            for (size_t i = from; i < to; ++i)
                if (!occluded[i])
                    arrive(shadows_[slot_of(tokens[i])]);
        });
        for (const uint64_t token : tokens)
            shadows_.give_back(slot_of(token));
        return go_on(watch);
    }

private:
    static uint32_t slot_of(uint64_t token) { return uint32_t(token); }
    static bool is_shadow(uint64_t token) { return token >> 32; }
    static uint64_t shadow_token(uint32_t slot) { return uint64_t(1) << 32 | slot; }

    bool go_on(const Stopwatch& watch) {
        report_.seconds_shade += watch.seconds();
        return !observe_ || observe_(report_);
    }

    void arrive(const ShadowRay& shadow) {
        sums_.add(shadow.pixel, shadow.weight * shadow.arriving);
    }

    /// Shades the surfaces found, moves shadow rays behind glass, and pushes what follows.
    void shade(RayStream& stream, std::span<const uint64_t> tokens, std::span<const Hit> hits) {
        const size_t lights = scene_.lights.size();
        Spawned<PathRay> mirrored;
        Spawned<PathRay> refracted;
        Spawned<ShadowRay> shadows;
        mirrored.resize(tokens.size());
        refracted.resize(tokens.size());
        shadows.resize(tokens.size() * std::max<size_t>(lights, 1));
        parallel_for(tokens.size(), kGrain, [&](size_t from, size_t to) {
            for (size_t i = from; i < to; ++i) {
                if (is_shadow(tokens[i])) {
                    pass(hits[i], shadows_[slot_of(tokens[i])], i * std::max<size_t>(lights, 1),
                         shadows);
                    continue;
                }
                const PathRay& at = paths_[slot_of(tokens[i])];
                if (!hits[i].is_hit())
                    sums_.add(at.path.pixel, at.path.weight * background_color(scene_.background,
                                                                               up_, at.ray.dir));
                else
                    spawn(at, hits[i], i, mirrored, refracted, shadows);
            }
        });
        for (const uint64_t token : tokens) {
            if (is_shadow(token))
                shadows_.give_back(slot_of(token));
            else
                give_back_path(slot_of(token));
        }
        report_.rays.reflection += push_paths(stream, mirrored);
        report_.rays.refraction += push_paths(stream, refracted);
        report_.rays.shadow += push_shadows(stream, shadows);
    }

    void give_back_path(uint32_t slot) {
        report_.pixels_done += paths_[slot].path.depth == 0;
        paths_.give_back(slot);
    }

    /// What the path that hit a surface sees of it, and the rays that leave it.
    void spawn(const PathRay& at, const Hit& hit, size_t i, Spawned<PathRay>& mirrored,
               Spawned<PathRay>& refracted, Spawned<ShadowRay>& shadows) {
        const SurfacePoint surface = surface_point(scene_, at.ray, hit);
        Path path = at.path;
        const Children children = split_weight(path, at.ray, surface, options_.max_depth);
        if (children.mirror != vec3(0))
            mirrored.set(
                i, {{path.pixel, path.depth + 1, children.mirror}, mirror_ray(at.ray, surface)},
                hit.id);
        if (children.through != vec3(0))
            refracted.set(
                i,
                {{path.pixel, path.depth + 1, children.through}, *refracted_ray(at.ray, surface)},
                hit.id);
        sums_.add(path.pixel, path.weight * ambient_light(scene_.background, up_, surface));
        for (size_t l = 0; l < scene_.lights.size(); ++l) {
            const Light& light = scene_.lights[l];
            const vec3 arriving = direct_light(light, surface);
            if (arriving == vec3(0))
                continue;
            const ShadowRay shadow = {arriving,   path.weight,
                                      path.pixel, uint32_t(l),
                                      0,          shadow_ray(light, surface.position)};
            if (options_.shadows && !light.shadowless)
                shadows.set(i * scene_.lights.size() + l, shadow, hit.id);
            else
                arrive(shadow);
        }
    }

    /// A shadow ray that looks for glass has found something, or nothing any more.
    void pass(const Hit& hit, ShadowRay shadow, size_t place, Spawned<ShadowRay>& shadows) {
        if (!hit.is_hit())
            return arrive(shadow);
        if (pass_glass(scene_, scene_.lights[shadow.light], options_, shadow.depth, hit, shadow.ray,
                       shadow.arriving)) {
            ++shadow.depth;
            shadows.set(place, shadow, hit.id);
        } else if (shadow.arriving != vec3(0)) {
            arrive(shadow);
        }
    }

    size_t push_paths(RayStream& stream, const Spawned<PathRay>& spawned) {
        return push(stream, spawned, paths_, /* any_hit= */ false,
                    [](uint32_t slot) { return uint64_t(slot); });
    }
    size_t push_shadows(RayStream& stream, const Spawned<ShadowRay>& spawned) {
        return push(stream, spawned, shadows_, /* any_hit= */ !glass_, shadow_token);
    }

    /// Pushes what is wanted; returns how many rays that were.
    template <class Owner, class Name>
    size_t push(RayStream& stream, const Spawned<Owner>& spawned, Slots<Owner>& slots, bool any_hit,
                Name&& name) {
        std::vector<uint32_t> chosen;
        for (size_t i = 0; i < spawned.wanted.size(); ++i)
            if (spawned.wanted[i])
                chosen.push_back(uint32_t(i));
        const std::vector<uint32_t> taken = slots.take(chosen.size());
        std::vector<Ray> rays(chosen.size());
        std::vector<TriangleId> skip(chosen.size());
        std::vector<uint64_t> tokens(chosen.size());
        for (size_t j = 0; j < chosen.size(); ++j) {
            slots[taken[j]] = spawned.owners[chosen[j]];
            rays[j] = spawned.owners[chosen[j]].ray;
            skip[j] = spawned.skip[chosen[j]];
            tokens[j] = name(taken[j]);
        }
        stream.push({any_hit, rays, skip, tokens});
        return chosen.size();
    }

    const Scene& scene_;
    Backend& backend_;
    const WhittedOptions options_;
    const RenderObserver& observe_;
    Image& image_;
    const Pinhole pinhole_;
    const vec3 up_;
    const bool glass_; // shadow rays look for the nearest surface
    const std::vector<uint32_t> order_;
    size_t begun_ = 0; // pixels, in that order
    PixelSums sums_;
    RenderReport report_;
    Slots<PathRay> paths_;
    Slots<ShadowRay> shadows_;
};

} // namespace

Result<RenderReport> render_mixed(const Scene& scene, const Camera& camera, Backend& backend,
                                  const WhittedOptions& options, const RenderObserver& observe,
                                  Image& image) {
    return MixedRenderer(scene, camera, backend, options, observe, image).render();
}

} // namespace ovc
