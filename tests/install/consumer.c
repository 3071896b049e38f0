/* SPDX-License-Identifier: Apache-2.0 */
/* Traces one ray at one triangle through an installed Overcast; prints "hit t u v", or why not. */
#include <overcast/overcast.h>

#include <math.h>
#include <stdio.h>

int main(void) {
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const ovc_ray ray = {{0.25, 0.5, 5}, 0, {0, 0, -1}, HUGE_VAL};
    const ovc_api* api = ovc_get_api(OVC_ABI_VERSION);
    ovc_device device;
    ovc_scene scene;
    ovc_hit hit;
    ovc_mesh mesh = {sizeof mesh, positions, 12, 3};
    ovc_result result;
    if (!api || api->version != OVC_VERSION)
        return puts("the library is not of the header's version");
    if (api->create_device(NULL, &device) != OVC_OK)
        return puts(api->last_error(NULL));
    result = api->create_scene(device, NULL, &scene);
    if (result == OVC_OK)
        result = api->add_mesh(scene, &mesh, NULL);
    if (result == OVC_OK)
        result = api->commit(scene);
    if (result == OVC_OK)
        result = api->intersect(scene, &ray, 1, &hit, NULL);
    if (result != OVC_OK)
        return puts(api->last_error(device));
    printf("hit %g %g %g\n", hit.t, hit.u, hit.v);
    api->destroy_scene(scene);
    api->destroy_device(device);
    return 0;
}
