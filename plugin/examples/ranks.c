/* SPDX-License-Identifier: Apache-2.0 */
/* Draws hills in letters on several ranks, in C99 with MPI: each rank adds the whole scene, keeps a
 * share of its leaves, and traces the rays of its own rows of the picture. Usage: mpirun -n 4 ranks
 * [libovercast-mpi.so] */
#include <overcast/overcast.h>

#include <dlfcn.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 129, CELLS = (SIDE - 1) * (SIDE - 1), WIDTH = 72, HEIGHT = 24 };

static const ovc_api* api;
static ovc_device device;

static void check(ovc_result result) {
    if (result != OVC_OK) {
        fprintf(stderr, "ranks: %s\n", api->last_error(device));
        MPI_Abort(MPI_COMM_WORLD, 1); /* the others would wait for this one */
    }
}

static float height(float x, float y) {
    const float a = x * 3 - (int)(x * 3), b = y * 3 - (int)(y * 3); /* nine hills */
    return 6 * a * (1 - a) * b * (1 - b);
}

static void add_hills(ovc_scene scene) {
    static float positions[SIDE * SIDE][3];
    static uint32_t indices[CELLS * 2][3];
    ovc_mesh mesh = {sizeof mesh};
    for (int i = 0; i < SIDE * SIDE; ++i) {
        const float x = (float)(i % SIDE) / (SIDE - 1), y = (float)(i / SIDE) / (SIDE - 1);
        positions[i][0] = x, positions[i][1] = y, positions[i][2] = height(x, y);
    }
    for (uint32_t c = 0; c < CELLS; ++c) {
        const uint32_t a = c / (SIDE - 1) * SIDE + c % (SIDE - 1);
        const uint32_t corners[6] = {a, a + 1, a + SIDE + 1, a, a + SIDE + 1, a + SIDE};
        for (int i = 0; i < 6; ++i)
            indices[2 * c + i / 3][i % 3] = corners[i];
    }
    mesh.positions = &positions[0][0];
    mesh.vertex_count = SIDE * SIDE;
    mesh.indices = &indices[0][0];
    mesh.triangle_count = CELLS * 2;
    check(api->add_mesh(scene, &mesh, NULL));
}

int main(int argc, char** argv) {
    static ovc_ray rays[WIDTH * HEIGHT];
    static ovc_hit hits[WIDTH * HEIGHT];
    char mine[WIDTH * HEIGHT] = {0}, all[WIDTH * HEIGHT] = {0};
    int threads, rank, ranks, count = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &threads);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    void* library = dlopen(argc > 1 ? argv[1] : "libovercast-mpi.so", RTLD_NOW | RTLD_LOCAL);
    ovc_get_api_function get_api = NULL;
    if (library)
        *(void**)&get_api = dlsym(library, "ovc_get_api");
    if (!get_api || !(api = get_api(OVC_ABI_VERSION))) {
        fprintf(stderr, "ranks: %s\n", library ? "the library has another ABI" : dlerror());
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    check(api->create_device(NULL, &device));
    ovc_scene_config config = {sizeof config};
    config.communicator = (int32_t)MPI_Comm_c2f(MPI_COMM_WORLD);
    config.ranks_own = OVC_RANKS_OWN_SHARE;
    ovc_scene scene;
    check(api->create_scene(device, &config, &scene));
    add_hills(scene);
    check(api->commit(scene)); /* all ranks call it */
    for (int y = rank; y < HEIGHT; y += ranks)
        for (int x = 0; x < WIDTH; ++x, ++count) {
            const double to[3] = {(x + 0.5) / WIDTH, 1.2 - 1.2 * (y + 0.5) / HEIGHT, 0};
            const ovc_ray ray = {{0.5, -1, 1.2}, 0, {to[0] - 0.5, to[1] + 1, -1.2}, 1e30};
            rays[count] = ray;
        }
    check(api->intersect(scene, rays, (size_t)count, hits, NULL)); /* a call of this rank's own */
    for (int i = 0; i < count; ++i) {
        const double z = 1.2 - 1.2 * hits[i].t;
        const int y = rank + i / WIDTH * ranks, shade = (int)(z * 22);
        const char* letters = ".:-=+*#%@";
        const char letter = letters[shade < 0 ? 0 : shade > 8 ? 8 : shade];
        mine[y * WIDTH + i % WIDTH] = hits[i].mesh == OVC_NONE ? ' ' : letter;
    }
    /* Each letter is set on one rank. */
    MPI_Reduce(mine, all, sizeof all, MPI_CHAR, MPI_SUM, 0, MPI_COMM_WORLD);
    for (int y = 0; rank == 0 && y < HEIGHT; ++y)
        printf("%.*s\n", WIDTH, all + (ptrdiff_t)y * WIDTH);
    api->destroy_scene(scene); /* all ranks call it */
    api->destroy_device(device);
    MPI_Finalize();
    return 0;
}
