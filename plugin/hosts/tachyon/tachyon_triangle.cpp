// SPDX-License-Identifier: Apache-2.0
// Asks Tachyon itself which objects are triangles.
#include "plugin/hosts/tachyon/tachyon_triangle.h"

#include <cstddef>
#include <stdexcept>

#include <dlfcn.h>

namespace ovc::tachyon {

namespace {

using MakeTriangle = void (*)(SceneHandle, void*, apivector, apivector, apivector);

/// A scene of another layout may be longer than the header says.
struct RoomyScene {
    scenedef scene;
    std::byte room[4096];
};

flt shot_t = 0;
const object* shot_object = nullptr;

void remember_shot(flt t, const object* hit, ray*) {
    shot_t = t;
    shot_object = hit;
}

bool same(const vector& v, flt x, flt y, flt z) {
    return v.x == x && v.y == y && v.z == z;
}

/// Whether a ray down the z axis from z = 5 meets the triangle at t = 4, and says so.
bool is_hit(const object* triangle) {
    ray down{};
    down.o = {0, 0, 5};
    down.d = {0, 0, -1};
    down.maxdist = FHUGE;
    down.add_intersection = remember_shot;
    shot_object = nullptr;
    triangle->methods->intersect(triangle, &down);
    return shot_object == triangle && shot_t == 4;
}

} // namespace

Intersect triangle_intersect() {
    const auto make = reinterpret_cast<MakeTriangle>(dlsym(RTLD_DEFAULT, "rt_tri"));
    if (!make)
        throw std::runtime_error("there is no Tachyon in this program: it has no rt_tri");
    // Not rt_newscene(): what would delete that scene frees the images of all scenes.
    RoomyScene probe{};
    texture plain{};
    make(&probe.scene, &plain, {-1, -1, 1}, {3, -1, 1}, {-1, 4, 1});
    const object* made = probe.scene.objgroup.boundedobj;
    const auto* triangle = reinterpret_cast<const Triangle*>(made);
    if (!made || probe.scene.objgroup.numobjects != 1 || probe.scene.scenecheck != 1 ||
        made->nextobj || made->tex != &plain || !same(triangle->v0, -1, -1, 1) ||
        !same(triangle->edge1, 4, 0, 0) || !same(triangle->edge2, 0, 5, 0) || !is_hit(made))
        throw std::runtime_error(
            "this Tachyon keeps its triangles otherwise than version " TACHYON_VERSION_STRING
            ", which Overcast was built for");
    const Intersect intersect = made->methods->intersect;
    made->methods->freeobj(probe.scene.objgroup.boundedobj);
    return intersect;
}

} // namespace ovc::tachyon
