// SPDX-License-Identifier: Apache-2.0
// An Integrator computes the light that a path brings to its pixel, and the rays that go on from
// its hit. The renderers (render_batched.h, render_mixed.h) trace those, each in an order of its
// own, for the same picture.
#pragma once

#include "core/ray.h"
#include "core/vec.h"
#include "host/backend/ray_list.h"
#include "host/film/film.h"
#include "host/shade/cone.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace ovc {

enum class RayKind : uint8_t { Camera, Reflection, Refraction, Bounce };

/// The materials of the solids that a ray has entered and not left, as far as its path has seen.
/// It has room for four, and forgets the outermost of more.
class Solids {
public:
    /// Returns the one that was entered last; kNone: the ray is in none.
    uint32_t innermost() const { return materials_.front(); }
    void enter(uint32_t material) {
        std::rotate(materials_.begin(), materials_.end() - 1, materials_.end());
        materials_.front() = material;
    }
    /// Does nothing where the ray has not entered the material.
    void leave(uint32_t material) {
        const auto left = std::find(materials_.begin(), materials_.end(), material);
        if (left == materials_.end())
            return;
        std::rotate(left, left + 1, materials_.end());
        materials_.back() = kNone;
    }
    /// Returns the materials, and kNone in the place of missing ones.
    std::span<const uint32_t> all() const { return materials_; }

private:
    std::array<uint32_t, 4> materials_{kNone, kNone, kNone, kNone}; // the last entered comes first
};

/// The numbers of the media's containers that a ray is in; 0: none. One may come more than once.
/// Where they lie deeper in each other than this, the outer ones stay.
struct Containers {
    std::array<uint16_t, 4> numbers = {};

    void replace(uint16_t from, uint16_t to) {
        if (const auto found = std::find(numbers.begin(), numbers.end(), from);
            found != numbers.end())
            *found = to;
    }
    void enter(uint16_t number) { replace(0, number); }
    void leave(uint16_t number) { replace(number, 0); }
    bool includes(uint16_t number) const {
        return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
    }
};

/// The purpose of a ray that looks for the nearest surface.
struct Path {
    uint32_t pixel;
    uint32_t sample;    // the number of the pixel's camera ray that led here
    uint16_t depth;     // surfaces that the path left on its way here
    RayKind kind;       // how it left the last one
    bool reflected : 1; // some surface has reflected it; what has no_image is seen then
    bool scattered : 1; // path tracing: one has, in a direction that was chosen among many
    vec3 weight;        // the pixel's share of the light at the ray's end
    float density;    // path tracing: the density of its direction, by solid angle; 0: no other was
                      // possible
    float behind = 0; // path tracing: the distance from the ray's origin back to where the
                      // direction was chosen, through panes that do not bend it
    Cone cone = {};
    Containers inside = {}; // of media, as far as the path has seen
    Solids within = {};
};

/// The purpose of a shadow ray, which reaches the light, or a point of it, at t = 1.
struct Shadow {
    uint32_t pixel;
    uint32_t light;  // its number, for Integrator::pass(); kNone: an emitter
    uint32_t passed; // surfaces that the ray has passed
    vec3 arriving;   // the light that the pixel gets if nothing is in the way
};

/// Rays that go on from hits.
struct Spawned {
    RayList<Path> paths;
    RayList<Shadow> shadows;

    void clear() {
        paths.resize(0);
        shadows.resize(0);
    }
};

/// An Integrator is stateless: many threads may call its functions at once.
class Integrator {
public:
    virtual ~Integrator() = default;

    /// Adds the light that the paths see at the ends of their rays to the film, and appends the
    /// rays that go on from there to `spawned`. It puts rays of one kind side by side, so that
    /// neighbours go the same way. rays, paths and hits have the same size.
    virtual void shade(std::span<const Ray> rays, std::span<const Path> paths,
                       std::span<const Hit> hits, Film& film, Spawned& spawned) const = 0;

    /// Returns the max number of shadow rays that an answer spawns.
    virtual size_t max_shadow_rays() const = 0;

    /// Returns whether light may pass some surface. If so, shadow rays look for the nearest surface
    /// and the renderer asks pass(); otherwise any surface in the way blocks the light.
    virtual bool light_may_pass() const = 0;

    /// Takes a shadow ray that has hit a surface. Returns true where the ray goes on: `ray` then
    /// begins behind the surface, and `shadow` is dimmed by it. Returns false where it ends; the
    /// light that arrives, perhaps 0, is then in `shadow`.
    virtual bool pass(const Hit& hit, Ray& ray, Shadow& shadow) const = 0;
};

} // namespace ovc
