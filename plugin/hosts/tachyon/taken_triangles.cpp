// SPDX-License-Identifier: Apache-2.0
// Tachyon's object_methods for triangles that Overcast finds.
#include "plugin/hosts/tachyon/taken_triangles.h"

#include "plugin/hosts/tachyon/beside.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace ovc::tachyon {

namespace {

struct Stand {
    RT_OBJECT_HEAD
    std::vector<object*> triangles; // by prim
    bool has_duplicates = false;    // triangles with the same three corners
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

/// The triangles that a ray was offered. Each is offered once, for glass dims a shadow each time.
class Offered {
public:
    /// Returns whether it is the first time.
    bool add(uint32_t prim) {
        if (std::ranges::find(prims_, prim) != prims_.end())
            return false;
        prims_.push_back(prim);
        return true;
    }

private:
    std::vector<uint32_t> prims_;
};

/// Adds the triangles in the nearest point of the ray but `skip`.
void add_nearest(const Stand& stand, const ovc_ray& ray, uint32_t skip, std::set<uint32_t>& prims) {
    const std::optional<ovc_hit> first = stand.rays->nearest(ray, kBeforeAll, skip);
    for (auto hit = first; hit && hit->t == first->t; hit = stand.rays->nearest(ray, *hit, skip)) {
        prims.insert(hit->prim);
        if (!stand.has_duplicates)
            return;
    }
}

/// Offers the triangle and, where the ray passes a side of it within rounding errors, its
/// neighbours, in the order in which Tachyon tests: it may find the ray in one, in both or in none.
bool offer_found(const Stand& stand, const ovc_ray& asked, const ovc_hit& hit, ray& r,
                 Offered& offered) {
    const auto& triangle = *reinterpret_cast<const Triangle*>(stand.triangles[hit.prim]);
    std::set<uint32_t> prims = {hit.prim};
    for (const ovc_ray& beside : rays_beside(asked, hit, triangle))
        add_nearest(stand, beside, hit.prim, prims);
    bool taken = false;
    for (const uint32_t prim : prims)
        if (offered.add(prim))
            taken = offer(stand.triangles[prim], r) || taken;
    return taken;
}

/// Offers the triangles on the ray, nearest first, until Tachyon takes one; and where triangles are
/// there twice, those in the same point, which may look otherwise.
void ask(const Stand& stand, ray& r) {
    const ovc_ray asked{{r.o.x, r.o.y, r.o.z}, EPSILON, {r.d.x, r.d.y, r.d.z}, r.maxdist};
    Offered offered;
    double last = r.maxdist;
    for (auto hit = stand.rays->nearest(asked, kBeforeAll); hit && hit->t <= last;
         hit = stand.rays->nearest(asked, *hit))
        if (offer_found(stand, asked, *hit, r, offered)) {
            if (!stand.has_duplicates)
                return;
            last = hit->t;
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

vector sum(const vector& a, const vector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// Takes them as floats where floats hold them, as doubles otherwise.
Corners corners_of(const std::vector<object*>& triangles) {
    std::vector<double> exact;
    exact.reserve(9 * triangles.size());
    for (const object* o : triangles) {
        const auto* t = reinterpret_cast<const Triangle*>(o);
        for (const vector& v : {t->v0, sum(t->v0, t->edge1), sum(t->v0, t->edge2)})
            exact.insert(exact.end(), {v.x, v.y, v.z});
    }
    if (std::ranges::all_of(exact, [](double x) { return double(float(x)) == x; }))
        return std::vector<float>(exact.begin(), exact.end());
    return exact;
}

struct Objects {
    std::vector<object*> triangles; // as Tachyon lists them
    std::vector<object*> others;
};

Objects sort_objects(const scenedef& scene, Intersect triangle_intersect) {
    Objects sorted;
    for (object* o = scene.objgroup.boundedobj; o; o = static_cast<object*>(o->nextobj)) {
        const bool triangle = o->methods->intersect == triangle_intersect;
        (triangle ? sorted.triangles : sorted.others).push_back(o);
    }
    return sorted;
}

/// Of equally near triangles Tachyon sees the one it tests first. Its list begins with the last one
/// added, and so does what it tests; unless it makes a grid, whose cells begin with the first (and
/// crowded cells, which become grids themselves, with the last again: those are not told apart).
void order_as_tested(const scenedef& scene, std::vector<object*>& triangles, size_t objects) {
    if (scene.boundmode == RT_BOUNDING_ENABLED && objects > size_t(scene.boundthresh))
        std::ranges::reverse(triangles);
}

/// Makes the stand and then the others the scene's list.
void relink(scenedef& scene, Stand& stand, const std::vector<object*>& others) {
    object* last = reinterpret_cast<object*>(&stand);
    scene.objgroup.boundedobj = last;
    for (object* o : others) {
        last->nextobj = o;
        last = o;
    }
    last->nextobj = nullptr;
}

} // namespace

const SingleRays* take_triangles(scenedef& scene, Intersect triangle_intersect,
                                 const Settings& settings) {
    Objects objects = sort_objects(scene, triangle_intersect);
    if (objects.triangles.empty())
        return nullptr;
    auto stand = std::make_unique<Stand>();
    stand->methods = &stand_methods;
    stand->triangles = std::move(objects.triangles);
    order_as_tested(scene, stand->triangles, stand->triangles.size() + objects.others.size());
    stand->rays = std::make_unique<SingleRays>(corners_of(stand->triangles), settings);
    stand->has_duplicates = stand->rays->statistics().twins > 0;
    const SingleRays* rays = stand->rays.get();
    relink(scene, *stand.release(), objects.others);
    return rays;
}

} // namespace ovc::tachyon
