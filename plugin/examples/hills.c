/* SPDX-License-Identifier: Apache-2.0 */
/* Draws hills in letters, in C99: loads libovercast.so, adds a mesh and four instances of it, and
 * asks for the nearest hits of a batch of rays. Usage: hills [libovercast.so.1] */
#include <overcast/overcast.h>

#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 33, CELLS = (SIDE - 1) * (SIDE - 1), WIDTH = 72, HEIGHT = 24 };

static const ovc_api* api;
static ovc_device device;

static void check(ovc_result result) {
    if (result != OVC_OK) {
        fprintf(stderr, "hills: %s\n", api->last_error(device));
        exit(1);
    }
}

/* A hill of one by one; its border is level, so that tiles meet. */
static void add_hill(ovc_scene scene, uint32_t* number) {
    static float positions[SIDE * SIDE][3];
    static uint32_t indices[CELLS * 2][3];
    ovc_mesh mesh = {sizeof mesh};
    for (int i = 0; i < SIDE * SIDE; ++i) {
        const float x = (float)(i % SIDE) / (SIDE - 1), y = (float)(i / SIDE) / (SIDE - 1);
        positions[i][0] = x, positions[i][1] = y, positions[i][2] = 8 * x * (1 - x) * y * (1 - y);
    }
    for (uint32_t c = 0; c < CELLS; ++c) {
        const uint32_t a = c / (SIDE - 1) * SIDE + c % (SIDE - 1), corners[6] = {a, a + 1, a + SIDE + 1, a, a + SIDE + 1, a + SIDE};
        for (int i = 0; i < 6; ++i)
            indices[2 * c + i / 3][i % 3] = corners[i];
    }
    mesh.positions = &positions[0][0];
    mesh.vertex_count = SIDE * SIDE;
    mesh.indices = &indices[0][0];
    mesh.triangle_count = CELLS * 2;
    mesh.flags = OVC_MESH_TEMPLATE; /* only its instances are seen */
    check(api->add_mesh(scene, &mesh, number));
}

int main(int argc, char** argv) {
    static ovc_ray rays[WIDTH * HEIGHT];
    static ovc_hit hits[WIDTH * HEIGHT];
    ovc_scene scene;
    uint32_t hill;
    void* library = dlopen(argc > 1 ? argv[1] : "libovercast.so.1", RTLD_NOW | RTLD_LOCAL);
    ovc_get_api_function get_api = NULL;
    if (library)
        *(void**)&get_api = dlsym(library, "ovc_get_api");
    if (!get_api || !(api = get_api(OVC_ABI_VERSION))) {
        fprintf(stderr, "hills: %s\n", library ? "the library has another ABI" : dlerror());
        return 1;
    }
    check(api->create_device(NULL, &device));
    check(api->create_scene(device, NULL, &scene));
    add_hill(scene, &hill);
    for (int i = 0; i < 4; ++i) {
        const double transform[12] = {1, 0, 0, i % 2, 0, 1, 0, i / 2, 0, 0, 1 + i % 3, 0};
        const ovc_instance instance = {sizeof instance, hill, 0, transform};
        check(api->add_instance(scene, &instance, NULL));
    }
    check(api->commit(scene));
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
        const ovc_ray ray = {{1, -3, 2}, 0, {(i % WIDTH + 0.5) / WIDTH - 0.5, 1, 0.1 - (i / WIDTH + 0.5) / HEIGHT}, INFINITY};
        rays[i] = ray;
    }
    check(api->intersect(scene, rays, WIDTH * HEIGHT, hits, NULL));
    for (int i = 0; i < WIDTH * HEIGHT; ++i) { /* each instance has two letters */
        putchar(hits[i].mesh == OVC_NONE ? ' ' : "aAbBcCdD"[(hits[i].mesh - 1) * 2 + hits[i].prim / 2 % 2]);
        if (i % WIDTH == WIDTH - 1)
            putchar('\n');
    }
    api->destroy_scene(scene);
    api->destroy_device(device);
    return dlclose(library);
}
