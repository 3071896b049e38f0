/* SPDX-License-Identifier: Apache-2.0 */
/* Of two ranks the second never comes to commit. The first prints what its own commit says, and
 * destroys the scene. Usage: mpirun -n 2 absent_rank libovercast-mpi.so */
#define _GNU_SOURCE
#include <overcast/overcast.h>

#include <dlfcn.h>
#include <mpi.h>
#include <stdio.h>
#include <unistd.h>

int main(int argc, char** argv) {
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    int threads, rank;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &threads);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    while (rank == 1)
        pause();
    void* library = argc > 1 ? dlopen(argv[1], RTLD_NOW | RTLD_LOCAL) : NULL;
    ovc_get_api_function get_api = NULL;
    if (library)
        *(void**)&get_api = dlsym(library, "ovc_get_api");
    const ovc_api* api = get_api ? get_api(OVC_ABI_VERSION) : NULL;
    ovc_device device = NULL;
    if (api && api->create_device(NULL, &device) == OVC_OK) {
        ovc_scene_config config = {sizeof config};
        config.rank_timeout = 1;
        ovc_mesh mesh = {sizeof mesh};
        mesh.positions = corners;
        mesh.vertex_count = 3;
        ovc_scene scene;
        api->create_scene(device, &config, &scene);
        api->add_mesh(scene, &mesh, NULL);
        const ovc_result result = api->commit(scene);
        printf("commit: %d: %s\n", (int)result, result ? api->last_error(device) : "it is fine");
        api->destroy_scene(scene);
        api->destroy_device(device);
        printf("destroyed\n");
    } else {
        printf("no device\n");
    }
    fflush(stdout);
    MPI_Abort(MPI_COMM_WORLD, 1); /* the other would wait for this one */
}
