/* SPDX-License-Identifier: Apache-2.0 */
/* The smallest host, in C99 with overcast.h alone: it loads the plugin, adds one triangle and asks
 * two rays. Its exit code is 0 if the answers are right. usage: c99_host libovercast.so */
#include "plugin/overcast.h"

#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static int failed(const ovc_api* api, ovc_device device, const char* call) {
    fprintf(stderr, "%s: %s\n", call, api->last_error(device));
    return 1;
}

int main(int argc, char** argv) {
    static const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const ovc_ray rays[2] = {{{0.25, 0.25, 1}, 0, {0, 0, -1}, INFINITY}, {{2, 2, 1}, 0, {0, 0, -1}, INFINITY}};
    ovc_get_api_function get_api;
    const ovc_api* api;
    ovc_device device = NULL;
    ovc_scene scene = NULL;
    ovc_mesh mesh;
    ovc_hit hits[2];
    uint8_t shadows[2];
    int right;

    void* library = argc > 1 ? dlopen(argv[1], RTLD_NOW | RTLD_LOCAL) : NULL;
    if (!library) {
        fprintf(stderr, "usage: c99_host libovercast.so\n%s\n", argc > 1 ? dlerror() : "");
        return 1;
    }
    *(void**)&get_api = dlsym(library, "ovc_get_api");
    if (!get_api || get_api(OVC_ABI_VERSION + 1) || !(api = get_api(OVC_ABI_VERSION)))
        return 1;
    if (api->create_device(NULL, &device))
        return failed(api, NULL, "create_device");
    if (api->create_scene(device, NULL, &scene))
        return failed(api, device, "create_scene");
    memset(&mesh, 0, sizeof mesh);
    mesh.struct_size = sizeof mesh;
    mesh.positions = positions;
    mesh.vertex_count = 3;
    if (api->add_mesh(scene, &mesh, NULL) || api->commit(scene))
        return failed(api, device, "add_mesh or commit");
    if (api->intersect(scene, rays, 2, hits, NULL) || api->occluded(scene, rays, 2, shadows, NULL))
        return failed(api, device, "intersect or occluded");
    right = hits[0].t == 1 && hits[0].mesh == 0 && hits[0].prim == 0 && hits[0].u == 0.25 && hits[1].mesh == OVC_NONE &&
            shadows[0] == 1 && shadows[1] == 0;
    printf("t %g u %g v %g mesh %u prim %u\n", hits[0].t, hits[0].u, hits[0].v, (unsigned)hits[0].mesh,
           (unsigned)hits[0].prim);
    api->destroy_scene(scene);
    api->destroy_device(device);
    dlclose(library);
    return right ? 0 : 1;
}
