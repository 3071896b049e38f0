// SPDX-License-Identifier: Apache-2.0
// Tachyon's object_methods for triangles that Overcast finds.
#include "plugin/hosts/tachyon/taken_triangles.h"

#include "plugin/hosts/tachyon/twin_sets.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace ovc::tachyon {

namespace {

struct Stand {
    RT_OBJECT_HEAD
    std::vector<object*> triangles; // by prim
    TwinSets twins;
    std::unique_ptr<SingleRays> rays;
};

/// Tachyon's own test, told of the triangle alone. Whether it took the hit, so that nothing farther
/// away matters: not where it finds no hit, where a clipping plane cuts it off, or where the shadow
/// only dims.
bool offer(const object* triangle, ray& r) {
    const flt before = r.maxdist;
    triangle->methods->intersect(triangle, &r);
    return r.maxdist < before;
}

bool offer_set(const Stand& stand, uint32_t prim, ray& r) {
    bool taken = offer(stand.triangles[prim], r);
    for (const uint32_t twin : stand.twins.of(prim))
        taken = offer(stand.triangles[twin], r) || taken;
    return taken;
}

void ask(const Stand& stand, ray& r) {
    ovc_ray asked{{r.o.x, r.o.y, r.o.z}, EPSILON, {r.d.x, r.d.y, r.d.z}, r.maxdist};
    while (asked.t_min < asked.t_max) {
        const std::optional<ovc_hit> hit = stand.rays->nearest(asked);
        if (!hit || offer_set(stand, hit->prim, r))
            return;
        asked.t_min = std::nextafter(hit->t, std::numeric_limits<double>::infinity());
    }
}

void intersect(const void* self, void* voidray) {
    ray& r = *static_cast<ray*>(voidray);
    if (r.flags & RT_RAY_FINISHED)
        return;
    try {
        ask(*static_cast<const Stand*>(self), r);
    } catch (const std::exception& e) {
        // A lost device: Tachyon knows no errors here, and half a picture must not be saved.
        std::fprintf(stderr, "overcast: %s\n", e.what());
        std::_Exit(EXIT_FAILURE);
    }
}

/// None to tell: Tachyon's grid then leaves the object out.
int bounds(void*, vector*, vector*) {
    return 0;
}

void free_stand(void* self) {
    const std::unique_ptr<Stand> stand(static_cast<Stand*>(self));
    for (object* triangle : stand->triangles)
        triangle->methods->freeobj(triangle);
}

object_methods stand_methods = {intersect, /* normal: of Tachyon's triangle */ nullptr, bounds,
                                free_stand};

/// The corners where floats hold them; else nothing.
std::optional<std::array<float, 9>> float_corners(const Triangle& t) {
    const flt exact[9] = {t.v0.x,
                          t.v0.y,
                          t.v0.z,
                          t.v0.x + t.edge1.x,
                          t.v0.y + t.edge1.y,
                          t.v0.z + t.edge1.z,
                          t.v0.x + t.edge2.x,
                          t.v0.y + t.edge2.y,
                          t.v0.z + t.edge2.z};
    std::array<float, 9> corners;
    for (size_t i = 0; i < 9; ++i) {
        corners[i] = float(exact[i]);
        if (flt(corners[i]) != exact[i])
            return std::nullopt;
    }
    return corners;
}

/// Links everything but the stand's triangles behind the stand, in the order it was.
void replace_triangles(scenedef& scene, Stand& stand) {
    object* head = reinterpret_cast<object*>(&stand);
    void** end = &head->nextobj;
    size_t prim = 0;
    for (object* o = scene.objgroup.boundedobj; o; o = static_cast<object*>(o->nextobj)) {
        if (prim < stand.triangles.size() && o == stand.triangles[prim]) {
            ++prim;
            continue;
        }
        *end = o;
        end = &o->nextobj;
    }
    *end = nullptr;
    scene.objgroup.boundedobj = head;
}

} // namespace

Taken take_triangles(scenedef& scene, Intersect triangle_intersect, const Settings& settings) {
    Taken taken;
    auto stand = std::make_unique<Stand>();
    std::vector<float> corners;
    for (object* o = scene.objgroup.boundedobj; o; o = static_cast<object*>(o->nextobj)) {
        if (o->methods->intersect != triangle_intersect)
            continue;
        if (const auto nine = float_corners(*reinterpret_cast<const Triangle*>(o))) {
            corners.insert(corners.end(), nine->begin(), nine->end());
            stand->triangles.push_back(o);
        } else {
            ++taken.left;
        }
    }
    taken.triangles = stand->triangles.size();
    if (stand->triangles.empty())
        return taken;
    stand->methods = &stand_methods;
    stand->rays = std::make_unique<SingleRays>(std::move(corners), settings);
    if (stand->rays->statistics().twins > 0)
        stand->twins = TwinSets(stand->rays->corners());
    taken.rays = stand->rays.get();
    replace_triangles(scene, *stand.release());
    return taken;
}

} // namespace ovc::tachyon
