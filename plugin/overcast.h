/* SPDX-License-Identifier: Apache-2.0 */
/* The C ABI of Overcast: triangles and batches of rays in, nearest hits and occlusion out, for scenes larger than GPU memory.
 *
 * Load libovercast.so, look up ovc_get_api, ask for OVC_ABI_VERSION, and call through the table. C99.
 *
 * Every call returns an ovc_result; on anything but OVC_OK, last_error() has one sentence. Nothing throws or exits. The caller owns
 * every buffer, and none is used after the call returns, except shared positions, what is saved, the functions that are handed in
 * with their user pointers, and the buffers of a submitted call (docs/reference/abi.md, "Lifetimes").
 * Structs that go in begin with struct_size = sizeof(the struct); every other field means "default" when zero. Structs and the
 * table only ever grow at their end: the struct_size of an earlier header is fine. The manual is docs/reference/abi.md.
 * Calls may come from any thread, of 256 KiB of stack at least; calls on one scene wait their turn, first come, first served. The
 * caller's GL context, floating-point state and environment are left alone, except by prepare_process(): each device has a thread of
 * its own. The functions that a caller hands in for errors, logs, progress and what is saved may call last_error and nothing else.
 * In a process that is forked, the parent's handles are errors. */
#ifndef OVERCAST_H
#define OVERCAST_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define OVC_ABI_VERSION 1u
#define OVC_VERSION 100u /* major * 10000 + minor * 100 + patch: 0.1.0 */

typedef struct ovc_device_t* ovc_device;
typedef struct ovc_scene_t* ovc_scene;
typedef struct ovc_stream_t* ovc_stream;
typedef struct ovc_ticket_t* ovc_ticket;

typedef enum ovc_result {
    OVC_OK = 0,
    OVC_ERROR_INVALID_ARGUMENT = 1, /* a null, a wrong struct_size, a number out of range, EGL_PLATFORM set to nonsense */
    OVC_ERROR_INVALID_STATE = 2,    /* tracing before commit, or after a change */
    OVC_ERROR_NO_DEVICE = 3,        /* EGL or OpenGL is missing, or no device has that name */
    OVC_ERROR_OUT_OF_BUDGET = 4,    /* gpu_memory_bytes is too small; the message names the smallest that works */
    OVC_ERROR_OUT_OF_MEMORY = 5,
    OVC_ERROR_DEVICE_LOST = 6,
    OVC_ERROR_INTERNAL = 7,
    OVC_ERROR_CANCELLED = 8, /* a caller's function, cancel, release or destroy_scene asked for it */
    OVC_ERROR_UNREADABLE = 9 /* what read_saved or read_corners gives is damaged, or they failed; the scene stays usable */
} ovc_result;

#define OVC_NONE 0xffffffffu

/* The points org + t dir, t_min <= t <= t_max. dir need not be of unit length: t counts in its lengths. A ray with NaN or
 * infinity in it (but t_max may be infinite), a direction whose components are all below 1e-300 in magnitude, or t_min > t_max
 * misses, and is counted. All other rays are answered exactly, from any distance and with denormal parts; t_min or t_max of -0 is 0,
 * and nothing is hit beyond the largest double. 64 bytes. */
typedef struct ovc_ray {
    double org[3];
    double t_min;
    double dir[3];
    double t_max;
} ovc_ray;

/* The same in half the bytes, where ovc_query.ray_format says so. Its floats are taken as doubles,
 * and answers are the same bits as for an ovc_ray of these. 32 bytes. */
typedef struct ovc_ray_float {
    float org[3];
    float t_min;
    float dir[3];
    float t_max;
} ovc_ray_float;

typedef enum ovc_ray_format {
    OVC_RAY_DOUBLE = 0, /* ovc_ray */
    OVC_RAY_FLOAT = 1   /* ovc_ray_float: the call's `rays` is cast from a pointer to them */
} ovc_ray_format;

/* The nearest hit, at org + t dir = (1-u-v) a + u b + v c of the triangle's corners a, b, c; equal t goes to the smaller
 * (mesh, prim). A triangle that the ray sees exactly edge-on is not hit. t, u and v are the exact values, each
 * rounded once to the nearest double. A miss: mesh = prim = OVC_NONE, t = infinity. 32 bytes. */
typedef struct ovc_hit {
    double t;
    double u;
    double v;
    uint32_t mesh;
    uint32_t prim;
} ovc_hit;

/* The name of a triangle. 8 bytes. */
typedef struct ovc_triangle {
    uint32_t mesh;
    uint32_t prim;
} ovc_triangle;

typedef enum ovc_log_level { OVC_LOG_ERROR = 0, OVC_LOG_WARNING = 1, OVC_LOG_INFO = 2 } ovc_log_level;

/* Takes a message of one sentence without a line end, valid during the call only. It may be called
 * on the device's thread. */
typedef void (*ovc_log_function)(void* user, ovc_log_level level, const char* message);

/* Takes the code of a call that has failed, and the sentence that last_error() has from now on,
 * valid during the call only. It is called on the thread whose call it is, before that call returns
 * and in the caller's floating-point mode; from several threads at once, where several calls fail.
 * It may call last_error and nothing else, and must not throw. */
typedef void (*ovc_error_function)(void* user, ovc_result result, const char* message);

typedef struct ovc_device_config {
    size_t struct_size;
    const char* name; /* NULL: the first GPU, else the software renderer. A number as listed, or a part of the renderer's name, any case */
    ovc_log_function log; /* NULL: silent */
    void* log_user;
    ovc_error_function error; /* NULL: nobody is told. Else told of all calls on the device and its scenes that fail, create_device too */
    void* error_user;
    /* the budget of all scenes together, each of which gets what it has use for or an equal part; one that has not been used for
     * long makes room for others, and a call may wait for one on another scene to end. 0: each scene has a budget of its own */
    uint64_t gpu_memory_bytes;
    /* max threads that the library's loops run on at once, and max cores that a software renderer's kernels use; 0: all cores.
     * Threads that call count while they work in such a loop. The first device on a software renderer decides for it */
    uint32_t threads;
    uint32_t reserved; /* 0 */
} ovc_device_config;

/* The struct_size of an earlier header is fine: fields that it lacks are not filled in. */
typedef struct ovc_device_info {
    size_t struct_size;
    char renderer[128]; /* GL_RENDERER, as the driver says it */
    char vendor[64];
    char version[128];
    uint32_t is_software;
    uint32_t max_texture_size;       /* texels a side */
    uint64_t max_buffer_texels;      /* of a buffer texture, after the clamp to what works */
    uint64_t memory_bytes;           /* free GPU memory as the driver reports it; on a software renderer 1 GiB */
    uint64_t default_budget_bytes;   /* what ovc_scene_config.gpu_memory_bytes = 0 means */
    uint32_t is_tested; /* 1: all of Overcast's tests have run on a driver of this kind; 0: none that we know of */
    uint32_t reserved;  /* 0 */
} ovc_device_info;

typedef enum ovc_precision {
    OVC_PRECISION_CERTIFIED = 0, /* the exact answer for doubles, each number rounded once: the kernel proves, the CPU decides the rest */
    OVC_PRECISION_FAST = 1       /* float32 chooses the triangle: near sides, near ties and near the ray's ends another one may be
                                    named, or none. What is named is truly hit, and its t, u and v are exact, each rounded once.
                                    occluded takes float32's word. Of the structures of the thesis: the kernel's own t, u, v */
} ovc_precision;

typedef enum ovc_kernel {
    OVC_KERNEL_AUTO = 0, /* whichever is faster on this device; for batches of up to 4096 nearest hits that may be the CPU */
    OVC_KERNEL_FRAGMENT = 1, /* answers all batches of more than 64 rays, as the next one does */
    OVC_KERNEL_COMPUTE = 2
} ovc_kernel;

/* Experimental: the numbers stay, but the structures other than 0 may change. libovercast.so has
 * two-level alone. libovercast-thesis.so, of the same ABI, has the others, which two-level is
 * compared with; 1 to 5 keep the whole scene in GPU memory at once. */
typedef enum ovc_structure {
    OVC_STRUCTURE_TWO_LEVEL = 0,
    OVC_STRUCTURE_SINGLE_TEXTURE = 1, /* one BVH in one texture of at most 4096 x 4096 texels */
    OVC_STRUCTURE_MULTI_TEXTURE = 2,  /* the same in several textures; `leaves`: in so many at least */
    OVC_STRUCTURE_GPU_GRID = 3,       /* a uniform grid */
    OVC_STRUCTURE_GPU_KD_TREE = 4,    /* a KD-tree, walked by restarts */
    OVC_STRUCTURE_SKIP_BVH = 5,       /* a BVH by insertion, walked without a stack in bounded passes */
    OVC_STRUCTURE_THESIS_TWO_LEVEL = 6 /* two-level as the thesis has it: level 1 walked on the CPU, a queue and a pass for each leaf */
} ovc_structure;

/* Experimental: level 1 of OVC_STRUCTURE_THESIS_TWO_LEVEL. */
typedef enum ovc_level1 { OVC_LEVEL1_KD_TREE = 0, OVC_LEVEL1_GRID = 1, OVC_LEVEL1_BVH = 2 } ovc_level1;

/* Experimental: how that level 1 is built. */
typedef enum ovc_level1_build {
    OVC_LEVEL1_BUILD_TOP_DOWN = 0, /* cut until leaves are small enough */
    OVC_LEVEL1_BUILD_BOTTOM_UP = 1 /* the leaves of a complete tree merged while they are small enough; not for a grid */
} ovc_level1_build;

/* Experimental: what the ranks of libovercast-mpi.so have. */
typedef enum ovc_ranks_own {
    OVC_RANKS_OWN_AUTO = 0,  /* all leaves where they fit into the budgets of each, else a share */
    OVC_RANKS_OWN_SHARE = 1, /* a share of the leaves; rays go to the ranks that have those on their way */
    OVC_RANKS_OWN_ALL = 2    /* all leaves; no ray travels */
} ovc_ranks_own;

/* Takes the next `size` bytes that are saved. Returns 0 to go on, anything else to stop. */
typedef int (*ovc_write_function)(void* user, const void* bytes, size_t size);

/* Writes the `size` bytes of a file from `offset` on into `bytes`. Returns 0 where it could. It is called from several threads at
 * once, must not throw and may call last_error and nothing else. */
typedef int (*ovc_read_function)(void* user, uint64_t offset, void* bytes, size_t size);

/* The same for the corners of `count` triangles of a mesh, from `first` on: three offsets from its origin each. */
typedef int (*ovc_read_corners_function)(void* user, uint64_t first, uint64_t count, void* corners);

/* Takes how far a commit, a plan or a call with rays is. done: from 0 to 1, never less than before;
 * stage: names the work under way, valid during the call only. It is called fifty times a second at
 * most, from any thread, but never from two at once. It must return soon and call nothing on the
 * scene. It returns 0 to go on, anything else to stop: the call then returns OVC_ERROR_CANCELLED
 * within a tenth of a second or so. */
typedef int (*ovc_progress_function)(void* user, double done, const char* stage);

/* Fields are only ever appended; the struct_size of an earlier header is fine, and what it lacks is the default. */
typedef struct ovc_scene_config {
    size_t struct_size;
    uint64_t gpu_memory_bytes; /* the budget: pages, rays and hits together stay below it. 0: the device's default. Max: what the device's scenes share */
    uint64_t leaf_triangles;   /* max triangles of a level-1 leaf. 0: a tenth of the scene, or as suits budget and build; one leaf where that fits and rays gain by it */
    uint32_t leaves;           /* instead of leaf_triangles: about this many leaves. 0: as leaf_triangles says */
    uint32_t precision;        /* ovc_precision */
    uint32_t kernel;           /* ovc_kernel */
    uint32_t structure;        /* ovc_structure */
    uint32_t level1;           /* ovc_level1; 0 for all other structures */
    uint32_t level1_build;     /* ovc_level1_build; 0 for all other structures */
    ovc_progress_function progress; /* NULL: silent, and not to be stopped */
    void* progress_user;
    uint32_t tell_active; /* experimental. 1: active() tells which pages rays go through, and tracing takes up to half as long again; not for all structures. 0: off */
    uint32_t reserved;    /* 0 */
    /* NULL, or the bytes that save() wrote of a scene with the same meshes, so that commit need not
     * build. They are aligned to 64, valid and unchanged until the scene is destroyed; a mapped
     * file will do. Commit checks them: where they are damaged, or of other meshes or options, it
     * builds, and the device's log says why. Answers are the same bits either way. */
    const void* saved;
    uint64_t saved_bytes;
    /* Experimental. Not 0: the scene need not fit into host memory, and pages, corners and tables
     * together take so many bytes of it at most. Commit then opens what was saved, saved_bytes in
     * all, by read_saved, and `saved` is NULL; pages and corners are read as rays need them. All
     * meshes have read_corners, their corners are those that the levels were saved of, and nothing
     * changes after commit. OVC_ERROR_OUT_OF_BUDGET: too few, and the sentence names the smallest
     * number that works. */
    uint64_t host_memory_bytes;
    ovc_read_function read_saved;
    void* read_user;
    /* Experimental, of libovercast-mpi.so alone; elsewhere they are 0. There several processes, the
     * ranks of an MPI communicator, have a scene together: create_scene, commit and destroy_scene
     * are calls that all ranks make, with the same meshes and the same config, but for budgets; a
     * commit in which they differ fails on all ranks. Every other call is a rank's own. Changes too
     * are made by all ranks, once all have their answers: a call whose rays come to a rank that has
     * begun with changes is OVC_ERROR_INVALID_STATE. See docs/guide/ranks.md. */
    int32_t communicator; /* as MPI_Comm_c2f tells it. 0: MPI_COMM_WORLD */
    uint32_t ranks_own;   /* ovc_ranks_own */
    double rank_timeout;  /* seconds: a rank that gives no word for so long is lost, and calls fail. 0: 60 */
    const ovc_ray* sample; /* sample_rays of them, such as will be traced, or NULL: leaves are shared out by them. Read during commit */
    uint64_t sample_rays;
    /* Experimental. How the kernel goes about its work, which changes how fast it is and nothing of certified answers. NULL or "auto":
     * what was measured to be the fastest on this device; where nothing was, a GPU is measured beside the passes of a scene that has
     * many rays, in 0.3 s at most, which is kept for later processes. "default": what suits devices of this kind. "measure": all that
     * there is is measured with the first rays of each kind, in some seconds. Each measurement is told to the device's log. Else
     * a variant as the log names it. Copied by create_scene. With OVC_KERNEL_FRAGMENT or OVC_KERNEL_COMPUTE, and in
     * OVC_PRECISION_FAST, NULL means "default". For OVC_STRUCTURE_TWO_LEVEL. */
    const char* kernel_variant;
} ovc_scene_config;

typedef enum ovc_mesh_flags {
    OVC_MESH_SHARED = 1, /* positions are used in place: they stay valid until the scene is destroyed or the mesh removed,
                            and change with update_mesh() only. Needs stride 12, or 24 of doubles, and no indices */
    OVC_MESH_TEMPLATE = 2, /* no ray hits the mesh itself: it is there for its instances. It counts for no triangles */
    OVC_MESH_MOVES = 4 /* update_instance() is to move the mesh: it is built by itself from the start, so that the first move is quick too */
} ovc_mesh_flags;

/* Corners are kept as they are given: floats as floats, doubles as doubles (twice the host memory). A coordinate of a corner, with
 * its origin and its transform, beyond 2^256 counts as infinite, and one within 2^-256 as 0. */
typedef struct ovc_mesh {
    size_t struct_size;
    const float* positions;   /* vertex_count x 3 offsets from origin, stride bytes apart, aligned to 4 */
    size_t stride;            /* bytes from one vertex to the next; 0: 12, or 24 of doubles */
    uint64_t vertex_count;
    const uint32_t* indices;  /* 3 per triangle, each < vertex_count; NULL: vertices 3i, 3i+1, 3i+2 make triangle i */
    uint64_t triangle_count;  /* 0 without indices: vertex_count / 3 */
    double origin[3];         /* added to every position, in double */
    uint32_t flags;           /* ovc_mesh_flags */
    uint32_t reserved;        /* 0 */
    const double* positions_double; /* instead of positions, which is NULL then: the same in double, stride and address aligned to 8 */
    const double* transform;  /* 12 finite numbers, or NULL: as in ovc_instance; applied after origin is added */
    uint32_t mask;            /* which rays see the mesh (ovc_query.masks). 0: all */
    uint32_t reserved1;       /* 0 */
    /* Experimental: instead of positions, in a scene with host_memory_bytes. It reads corners of the
     * triangle_count triangles, of floats or of doubles, until the scene is destroyed. Meshes with
     * the same function and user show the same corners, and share pages as instances do. */
    ovc_read_corners_function read_corners;
    void* read_user;
    uint32_t reads_doubles;   /* 0: 36 bytes a triangle; 1: 72 */
    uint32_t reserved2;       /* 0 */
} ovc_mesh;

/* A mesh placed once more, somewhere else. It has a number of its own, which its hits name, and the
 * prims of its mesh.
 *
 * transform: three rows of four numbers. A corner (x, y, z) of the mesh comes to lie at ((r0 x + r1 y) + r2 z) + r3 for each row r,
 * in doubles, every operation rounded; and there it is, in certified precision, to the last bit. So tiles whose corners these sums
 * bring to the same doubles share them, and no ray falls between them: shifts by whole numbers and quarter turns do that to short
 * numbers; else corners that should meet may be roundings of a double apart. Corners keep their order, so a mirroring transform
 * turns the other side out. A singular one flattens: triangles left without area are dropped and counted, as are those that
 * overflow.
 *
 * What it costs: positions and pages are kept once, for all instances, and each adds some 250 bytes
 * to the top-level tree. Meshes that lie together wherever they lie, as the shapes of an object do,
 * cost as one if the instances in a place are added one after the other, always in the same order
 * and with the same transform; rays find them faster, too. But instances of small meshes, and of
 * transforms that doubles cannot invert well enough, are built as if they were meshes of their
 * own. */
typedef struct ovc_instance {
    size_t struct_size;
    uint32_t mesh;           /* the number of a mesh added before, or of an instance: then that one's transform comes first, in one product of both */
    uint32_t reserved;       /* 0 */
    const double* transform; /* 12 finite numbers, or NULL: where the mesh is. Read during the call */
    uint32_t mask;           /* as ovc_mesh.mask; that of the mesh does not matter here */
    uint32_t reserved1;      /* 0 */
} ovc_instance;

/* Tells which hits count: sets keep[i], which is 1 before, to 0 where hits[i] of ray rays[i] does not. rays: their numbers in the
 * call, from 0; in a stream their tokens. Returns 0 to go on, anything else to stop the call, which then returns
 * OVC_ERROR_CANCELLED. It is called from the library's threads, from several at once, beside passes, and at most once for each hit
 * of a ray; only about hits whose meshes the ray's mask sees. Hits come in the order of t, mesh and prim for each ray. The arrays
 * are valid during the call only. It must return soon, must not throw and may call last_error and nothing else. */
typedef int (*ovc_filter_function)(void* user, size_t count, const uint64_t* rays, const ovc_hit* hits, uint8_t* keep);

/* The struct_size of an earlier header is fine. */
typedef struct ovc_query {
    size_t struct_size;
    const ovc_triangle* skip; /* ray_count, or NULL: the triangle that ray i starts on and therefore does not see; {OVC_NONE, OVC_NONE}, or one that there is not: none */
    /* Experimental. Written by intersect of OVC_STRUCTURE_TWO_LEVEL alone; NULL for all else. */
    uint32_t* leaf;   /* ray_count, or NULL: the level-1 leaf that the hit of ray i lies in; OVC_NONE: a miss */
    uint32_t* passes; /* ray_count, or NULL: kernel launches that ray i took part in; 0: one that is invalid or passes the scene by, or that doubles alone could walk */
    uint32_t* flagged; /* ray_count, or NULL: 1 where the kernel was not certain and doubles decided; else 0 */
    uint32_t ray_format; /* ovc_ray_format */
    uint32_t reserved;   /* 0 */
    /* NULL, or asked each twentieth of a second or so by intersect and occluded, also while they
     * wait for their turn on the scene; not for single rays and push. done: the share of rays that
     * is answered; stage: "rays". It runs on the thread that called; for a submitted call, on one
     * of the library's. Where it does not return 0, the call ends within a tenth of a second or so
     * with OVC_ERROR_CANCELLED, and its answers are undefined. Structures other than two-level ask
     * before the first ray only. */
    ovc_progress_function progress;
    void* progress_user;
    /* ray_count, or NULL: only hits of ray i behind the hit after[i] count, in the order of t, mesh and prim. So the hits of a
     * ray, those in the same point too, come one after the other: hand in what the call before answered. The place is the exact
     * one of the hit that is named if its t is the double given; else it is that t itself. u and v do not matter. A t of -infinity: all
     * hits count; of infinity, as in a miss: none. `after` may be the array of hits that the answers are written to. In
     * OVC_PRECISION_FAST some may be left out, and none comes twice. For OVC_STRUCTURE_TWO_LEVEL, as all that follows. */
    const ovc_hit* after;
    /* ray_count, or NULL: ray i sees a mesh where masks[i] and the mesh's mask have a bit in common, or where one of them is 0. */
    const uint32_t* masks;
    /* NULL: all hits count. Else it is asked about each hit that a ray would be answered with, or be occluded by; where one does not
     * count, the ray goes on behind it. So leaves cut out of a texture need no triangles of their own. */
    ovc_filter_function filter;
    void* filter_user;
} ovc_query;

/* The scene that commit would make of the meshes added so far, told without making it. Numbers of
 * leaves, bytes and pages are estimates: within 10 % of what commit then makes, or one whole leaf
 * or page. The smallest budget is exact. */
typedef struct ovc_plan {
    size_t struct_size;
    uint64_t triangles;            /* added */
    uint64_t hittable;             /* of them not dropped */
    uint64_t leaves;
    uint64_t leaf_references;      /* triangles counted once in each leaf they touch */
    uint64_t level2_bytes;         /* all pages together: to move every page once */
    uint64_t largest_page_bytes;   /* an upper estimate: up to three tenths above the true size */
    uint64_t gpu_budget_bytes;
    uint64_t smallest_budget_bytes; /* works, as all larger ones do; commit names the same */
    uint64_t ray_bytes;            /* of the budget, for rays and answers */
    uint64_t level1_bytes;         /* of the budget, for the table of portals: 0 where one frame suits all pages */
    uint64_t pool_bytes;           /* of the budget, for pages: what rays and portals leave, and no more than pages take */
    uint64_t resident_pages;       /* pages that are in the pool at once when commit returns */
    uint64_t host_bytes;           /* level 1 and level 2 in host memory; with host_memory_bytes the most that is taken of them */
    uint64_t batch_rays;           /* max rays a pass */
    uint32_t fits;                 /* 0: the budget is too small; commit would be OVC_ERROR_OUT_OF_BUDGET */
    uint32_t reserved;             /* 0 */
    double seconds;                /* that this call took */
    /* What follows is not filled in where struct_size is that of an earlier header. */
    uint64_t saved_bytes;          /* that save would write; of a scene with host_memory_bytes exact, for it is saved */
    uint64_t smallest_host_bytes;  /* the smallest host_memory_bytes that works, exactly; 0: the scene lies in memory */
} ovc_plan;

/* How a scene stands, and what has been done with it. Fields that are marked + count up from commit
 * on, so that the difference of two readings tells what lies between; they begin at 0 again where a
 * commit after changes had to build the scene anew. Seconds are of wall clock.
 * The struct_size of an earlier header is fine: what it lacks is not filled in. A field is added
 * here, at the end, and nowhere else: its name in JSON and Python and its line in
 * docs/reference/stats.md are made from this list (cmake/statistics.cmake). */
typedef struct ovc_statistics {
    size_t struct_size;
    /* added, dropped ones and duplicates among them */
    uint64_t triangles;
    /* never hit, for a corner is NaN or infinite */
    uint64_t dropped_not_finite;
    /* never hit, for they have no area */
    uint64_t dropped_degenerate;
    /* duplicates: in no leaf, because a smaller (mesh, prim) has the same three corners and
     * answers for them; with all triangles of an instance that lies where one before it does */
    uint64_t twins;
    /* of the level-1 tree */
    uint64_t leaves;
    /* triangles, counted once in each leaf that they touch */
    uint64_t leaf_references;
    /* of all pages together: what would have to fit for the whole scene to be resident */
    uint64_t level2_bytes;
    /* of the largest page */
    uint64_t largest_page_bytes;
    /* that pages, rays and answers may take together */
    uint64_t gpu_budget_bytes;
    /* of GL buffers and textures, the most that were alive at once; never above the budget */
    uint64_t gpu_peak_bytes;
    /* + launches of the kernel */
    uint64_t passes;
    /* + pages moved to the GPU */
    uint64_t pages_in;
    /* + their bytes */
    uint64_t bytes_in;
    /* + rays that asked for their nearest hit, or for all hits */
    uint64_t nearest_rays;
    /* + rays that asked whether anything is hit */
    uint64_t occlusion_rays;
    /* + rays that can hit nothing: NaN or infinity in them, a direction below 1e-300,
     * t_min > t_max */
    uint64_t invalid_rays;
    /* + rays, counted once in each pass that they took part in */
    uint64_t ray_visits;
    /* + answers that the kernel could not decide alone: doubles chose among its candidates */
    uint64_t flagged;
    /* + of `flagged`, those with too many candidates: the ray was traced again in double */
    uint64_t retraced;
    /* + of `retraced`, those whose loop in the kernel ended early: by the driver (llvmpipe,
     * after 65,535 rounds), or because the stack was full */
    uint64_t capped;
    /* building the level-1 tree */
    double seconds_level1;
    /* building and packing all pages */
    double seconds_level2;
    /* + inside calls with rays in batches, and streams without their host's functions */
    double seconds_trace;
    /* + of `seconds_pass`, the kernel alone, by the device's clock; with a software renderer the
     * CPU time of its threads, shared out among them; all of it where a structure cannot tell */
    double seconds_kernel;
    /* of level 1 and level 2 in host memory */
    uint64_t host_bytes;
    /* + queues of rays that waited for a leaf until its page was moved in */
    uint64_t queues;
    /* + rays in them, all together */
    uint64_t queued_rays;
    /* rays in the longest of them */
    uint64_t longest_queue;
    /* 1: commit took them from ovc_scene_config.saved; else 0 */
    uint64_t from_saved;
    /* + of `seconds_trace`, passes: from sending rays until their answers are here, pages moved
     * in beside; other rays are resolved meanwhile */
    double seconds_pass;
    /* of GL buffers and textures alive now; after purge 0, until rays are traced again */
    uint64_t gpu_bytes;
    /* of positions in host memory, without shared ones; instances share those of their mesh */
    uint64_t soup_bytes;
    /* + of `nearest_rays` and `occlusion_rays`, those of intersect1 and occluded1 */
    uint64_t single_rays;
    /* + of `single_rays`, those that the GPU answered in batches; the CPU answered the others */
    uint64_t gathered_rays;
    /* + rays that doubles answered on the CPU, because too few waited for a page to be worth
     * moving, or too few went on behind hits that do not count to be worth a pass */
    uint64_t stragglers;
    /* of `triangles`, those that are packed: once for a mesh whose instances share pages */
    uint64_t unique_triangles;
    /* that share pages */
    uint64_t instances;
    /* of the tree over all pages and instances, on the GPU */
    uint64_t top_level_bytes;
    /* + commits that brought the scene up to date without building all of it */
    uint64_t updates;
    /* + pages that they refitted: their triangles moved */
    uint64_t pages_refitted;
    /* + pages that they built, anew or for meshes that were added */
    uint64_t pages_rebuilt;
    /* ovc_scene_config.host_memory_bytes, as the next ones 0 where that is not set */
    uint64_t host_budget_bytes;
    /* of it, the most that pages, corners and tables took together */
    uint64_t host_budget_peak_bytes;
    /* + calls of read_saved and read_corners */
    uint64_t disk_reads;
    /* + bytes that they read */
    uint64_t disk_bytes;
    /* + pages and blocks of corners that were in host memory when they were needed */
    uint64_t disk_hits;
    /* + those that somebody had to wait for */
    uint64_t disk_misses;
    /* + pages that were read ahead of need */
    uint64_t disk_ahead;
    /* processes that have the scene together; 0 where it is that of one */
    uint64_t ranks;
    /* of this process among them */
    uint64_t rank;
    /* + rays of this rank that visited another, counted once for each visit */
    uint64_t rays_sent;
    /* + rays of other ranks that visited this one */
    uint64_t rays_served;
    /* + bytes that went to other ranks: rays, answers and heartbeats */
    uint64_t bytes_sent;
    /* + bytes that came from them */
    uint64_t bytes_received;
    /* + of `seconds_trace`, those in which this rank had nothing to do but to wait for others */
    double seconds_waiting;
} ovc_statistics;

/* The pages that rays went through since this was asked last, or since the commit; experimental. */
typedef struct ovc_active {
    size_t struct_size;
    uint64_t pages;
    uint64_t bytes;     /* of them: the working set */
    uint64_t new_pages; /* not among those told the time before */
    uint64_t new_bytes;
} ovc_active;

/* Answers of a stream, in any order: hits for rays pushed for the nearest, occluded for the others; the other pointer is NULL.
 * Valid during the call only. */
typedef struct ovc_stream_answers {
    size_t struct_size;
    size_t count;
    const uint64_t* tokens;  /* count: those that the rays were pushed with */
    const ovc_hit* hits;     /* count, or NULL */
    const uint8_t* occluded; /* count: 1 or 0, or NULL */
} ovc_stream_answers;

/* The caller's side of a stream. Both functions are called on the thread that called stream(), may push() rays, may call nothing
 * else on the scene, and return 0 to go on, anything else to stop. */
typedef struct ovc_stream_host {
    size_t struct_size;
    void* user;
    /* Asks for rays that come from no answer, such as camera rays: about `wanted` are welcome.
     * Where it pushes none, there are no more, and it is not called again. */
    int (*more)(void* user, ovc_stream stream, size_t wanted);
    int (*answered)(void* user, ovc_stream stream, const ovc_stream_answers* answers);
} ovc_stream_host;

/* Experimental: a mesh whose corners are read in parts. */
typedef struct ovc_streamed_mesh {
    double origin[3];        /* added to every corner, in double */
    uint64_t triangle_count;
    uint32_t has_doubles;    /* 0: corners are floats, 36 bytes a triangle; 1: doubles, 72 */
    uint32_t reserved;       /* 0 */
} ovc_streamed_mesh;

/* Experimental: a step that save_streamed has kept. */
typedef struct ovc_kept_step {
    const void* bytes;
    size_t size;
} ovc_kept_step;

/* Experimental: a scene that need not fit into host memory, for save_streamed. The functions get `user` and return 0 to go on,
 * anything else to stop the call. The library calls those that read and write scratch from several threads at once, each on bytes
 * of its own, and `write` from one at a time. They must not throw and may call last_error and nothing else. */
typedef struct ovc_streamed_scene {
    size_t struct_size;
    uint64_t host_memory_bytes; /* what the library may allocate besides what it takes for a scene of nothing. 0: no limit */
    const ovc_streamed_mesh* meshes; /* mesh_count of them; they are numbered in this order */
    uint32_t mesh_count;
    uint32_t reserved; /* 0 */
    void* user;
    /* Writes the corners of `count` triangles of a mesh, from `first` on, into `corners`: three offsets from its origin each, of
     * floats or doubles as the mesh says. Each triangle is read two times or three, and must be the same each time. */
    int (*read_corners)(void* user, uint32_t mesh, uint64_t first, uint64_t count, void* corners);
    /* A file that is empty at first, of the host's choice: write_scratch puts bytes at an offset, and read_scratch gets bytes that
     * were put there. It grows to some 60 bytes a triangle of floats. */
    int (*write_scratch)(void* user, uint64_t offset, const void* bytes, size_t size);
    int (*read_scratch)(void* user, uint64_t offset, void* bytes, size_t size);
    ovc_write_function write; /* takes what is saved, front to back */
    /* To go on where an earlier call ended; all of them may be NULL or 0. keep_step takes bytes to keep behind those that it took
     * before, from one thread at a time; by then `write` and write_scratch have taken all that they stand for. A later call gets
     * them as `kept`, in order, and the scratch as it was. It passes the same bytes to `write`, again from the first on, and where
     * those were written before it gets them by read_written, instead of making them. OVC_ERROR_UNREADABLE: `kept` is damaged, or of
     * other meshes, another config, another number of threads or another version; nothing is kept of what is built in memory. */
    int (*keep_step)(void* user, const void* bytes, size_t size);
    const ovc_kept_step* kept; /* kept_count of them */
    size_t kept_count;
    int (*read_written)(void* user, uint64_t offset, void* bytes, size_t size); /* by the offset among all that `write` took */
} ovc_streamed_scene;

/* The table. Fields are only ever appended; struct_size tells how many there are. All of them are stable within an abi. */
typedef struct ovc_api {
    size_t struct_size;
    uint32_t abi;
    uint32_t version; /* OVC_VERSION of the library */

    /* The sentence for the last call that failed on this device, or, with NULL, on this thread without a device. Never NULL;
     * valid until the next call on the device from this thread. */
    const char* (*last_error)(ovc_device device);

    /* Describes up to `capacity` devices into infos (each with struct_size set) and sets *count to how many there are. */
    ovc_result (*list_devices)(ovc_device_info* infos, uint32_t capacity, uint32_t* count);

    /* Opens a device and its thread. config may be NULL. */
    ovc_result (*create_device)(const ovc_device_config* config, ovc_device* device);
    ovc_result (*describe_device)(ovc_device device, ovc_device_info* info);
    /* Closes a device and ends its thread. Its scenes must be destroyed and its tickets released
     * before. NULL does nothing. Afterwards its handle, and those of the scenes and tickets it had,
     * are like freed memory. */
    void (*destroy_device)(ovc_device device);

    /* config may be NULL. */
    ovc_result (*create_scene)(ovc_device device, const ovc_scene_config* config, ovc_scene* scene);
    /* Meshes are numbered from 0 in the order they are added; mesh_id may be NULL. */
    ovc_result (*add_mesh)(ovc_scene scene, const ovc_mesh* mesh, uint32_t* mesh_id);
    /* Builds level 1 and level 2, or brings them up to date with what has changed since the last commit; where nothing has, it does
     * nothing. Afterwards the scene takes rays. An empty scene is fine: all rays miss. Where it fails or is cancelled
     * (ovc_scene_config.progress) it leaves nothing behind, and may be called again to build. */
    ovc_result (*commit)(ovc_scene scene);
    /* Writes the nearest hits of ray_count rays into hits[ray_count]. query may be NULL. Up to 64 rays may be answered on the
     * calling thread, and up to 4096 on all cores, beside other calls; more are the kernel's, and calls with them take turns. */
    ovc_result (*intersect)(ovc_scene scene, const ovc_ray* rays, size_t ray_count, ovc_hit* hits, const ovc_query* query);
    /* Sets occluded[i] to 1 when ray i hits anything, else to 0. query may be NULL. */
    ovc_result (*occluded)(ovc_scene scene, const ovc_ray* rays, size_t ray_count, uint8_t* occluded, const ovc_query* query);
    ovc_result (*statistics)(ovc_scene scene, ovc_statistics* statistics);
    /* Destroys a scene. NULL does nothing. A call that is running ends first; those that wait for
     * their turn end with OVC_ERROR_INVALID_STATE. As long as the device lives, and until it has
     * destroyed a thousand more scenes, the handle is an error wherever it is used. */
    void (*destroy_scene)(ovc_scene scene);

    /* The mixed form: rays of both kinds are under way together, and what the caller pushes joins them before the next leaves are
     * moved to the GPU, so that fewer moves serve more rays. Every ray is answered once. Returns when all are and there are no
     * more; OVC_ERROR_CANCELLED where the caller's functions stopped it. */
    ovc_result (*stream)(ovc_scene scene, const ovc_stream_host* host);
    /* Only from within the functions of the stream's host. Copies ray_count rays and their tokens, which come back with the
     * answers. any_hit: 0 for nearest hits, 1 for occlusion. query may be NULL. The caller bounds how many rays wait. */
    ovc_result (*push)(ovc_stream stream, const ovc_ray* rays, const uint64_t* tokens, size_t ray_count, uint32_t any_hit,
                       const ovc_query* query);

    /* Tells what commit makes, or has made, of the scene, for a small part of its work; before
     * commit or after it. OVC_ERROR_INVALID_ARGUMENT for structures that cannot tell. */
    ovc_result (*plan)(ovc_scene scene, ovc_plan* plan);

    /* Counts the pages that are active: asked at the end of each picture, they are its working set.
     * OVC_ERROR_INVALID_ARGUMENT where the scene's config did not ask for it (tell_active) or its
     * structure cannot tell. Experimental. */
    ovc_result (*active)(ovc_scene scene, ovc_active* active);
    /* Hands what commit has built to `write`, front to back in parts of any size, for
     * ovc_scene_config.saved of a later scene with the same meshes. The bytes are for this version
     * on this kind of machine: any other builds anew. OVC_ERROR_CANCELLED where `write` says so;
     * OVC_ERROR_INVALID_ARGUMENT for structures that cannot be saved. `write` may call nothing on
     * the scene. */
    ovc_result (*save)(ovc_scene scene, ovc_write_function write, void* user);

    /* Adds an instance of a mesh. It is numbered as meshes are, in the order that both are added; mesh_id may be NULL. */
    ovc_result (*add_instance)(ovc_scene scene, const ovc_instance* instance, uint32_t* mesh_id);
    /* Gives back the scene's GPU memory, all of it, and what host memory only serves speed: for a host that goes to do something
     * else. The next call that traces rays brings it in again, and takes as much longer; answers are the same. Before commit there
     * is nothing to give back. OVC_ERROR_INVALID_ARGUMENT for structures that cannot. */
    ovc_result (*purge)(ovc_scene scene);

    /* One ray, for renderers that need an answer before they know the next ray: made to be called
     * from many threads at once, beside all other calls on the scene, none of which it waits for,
     * and from within the functions of a stream. The calling thread walks the CPU's tree, or what
     * all threads ask is gathered into batches for the GPU, whichever is faster: short trials tell,
     * now and then while the calls go on. Answers are those of intersect, bit for bit; in
     * OVC_PRECISION_FAST those of doubles where the CPU answers. query may be NULL; its arrays have
     * one element. For structures other than two-level it is intersect of one ray. */
    ovc_result (*intersect1)(ovc_scene scene, const ovc_ray* ray, ovc_hit* hit, const ovc_query* query);
    /* The same for occlusion: *occluded = 1 when the ray hits anything, else 0. */
    ovc_result (*occluded1)(ovc_scene scene, const ovc_ray* ray, uint8_t* occluded, const ovc_query* query);

    /* intersect and occluded that return at once, with a ticket, and are done on a thread of the library's. What is submitted to one
     * scene is done in its order; any number may be open. All buffers, those in the query too, stay the caller's: valid and
     * untouched until the ticket is done; the query itself is copied. Arguments are checked before these return; where that fails
     * there is no ticket (NULL). Destroying the scene cancels its tickets and waits until they are done; they are released as ever,
     * and all before the device is destroyed. */
    ovc_result (*submit_intersect)(ovc_scene scene, const ovc_ray* rays, size_t ray_count, ovc_hit* hits, const ovc_query* query,
                                   ovc_ticket* ticket);
    ovc_result (*submit_occluded)(ovc_scene scene, const ovc_ray* rays, size_t ray_count, uint8_t* occluded, const ovc_query* query,
                                  ovc_ticket* ticket);
    /* Returns when the ticket is done, with the result of its call: OVC_OK, or an error, whose
     * sentence last_error() then has. OVC_ERROR_CANCELLED: it was cancelled, and the answers are
     * undefined. It may be called as often as wished, from any thread; but from within the scene's
     * stream, which it would wait for, it is OVC_ERROR_INVALID_STATE. */
    ovc_result (*wait)(ovc_ticket ticket);
    /* Whether the ticket is done, without waiting: *done = 1 or 0. progress: NULL, or set to the
     * share of rays answered, from 0 to 1. Errors are those of poll itself; wait() returns the
     * result of the ticket's call. */
    ovc_result (*poll)(ovc_ticket ticket, uint32_t* done, double* progress);
    /* Asks for an end, and does not wait for it: a ticket that has not begun is done at once, one under way after its pass, both
     * with OVC_ERROR_CANCELLED; one that is done, or just getting done, stays as it is. */
    ovc_result (*cancel)(ovc_ticket ticket);
    /* Cancels the ticket, waits until it is done, and forgets it. NULL does nothing. */
    void (*release)(ovc_ticket ticket);

    /* Writes the hits of each ray in the order of t, mesh and prim, the first max_hits of them: those of ray i from
     * hits[i * max_hits] on, and misses where there are fewer. counts: NULL, or ray_count numbers: how many hits the ray has in all.
     * max_hits may be 0, and hits NULL then. query may be NULL; its skip, `after`, masks and filter tell which hits count. A ray of
     * n hits takes O(n log n) time, however many of them lie in one point. */
    ovc_result (*all_hits)(ovc_scene scene, const ovc_ray* rays, size_t ray_count, size_t max_hits, ovc_hit* hits,
                           uint64_t* counts, const ovc_query* query);

    /* Changes of a scene, before its commit or after it. Once one of these, add_mesh or add_instance has succeeded, the scene takes
     * no rays (OVC_ERROR_INVALID_STATE, for tickets that are under way too) until commit has brought it up to date; only a change of
     * what no ray can meet, such as a template, may leave it as it is. Answers are then those of a scene built anew from what is
     * there, bit for bit in certified precision. Commit rebuilds no more than it must: for moved instances the tree above the pages,
     * for new positions what lies around them. */

    /* Gives triangles of a mesh, from first_triangle on, new corners: `mesh` describes as many triangles as change, as in add_mesh,
     * with floats or doubles and the origin as there; transform and mask are NULL and 0, for these stay. All instances of the mesh
     * follow. Where OVC_MESH_SHARED was set it must be set again, and positions must be the address of first_triangle's first
     * corner: the caller writes to its own memory while no call uses the scene, and then tells here what it has written. */
    ovc_result (*update_mesh)(ovc_scene scene, uint32_t mesh_id, const ovc_mesh* mesh, uint64_t first_triangle);
    /* Gives a mesh or an instance a new transform, as in ovc_mesh or ovc_instance, in place of the one it was added with or got
     * last. NULL: none. What was added as an instance of it stays where it is. A mesh that is moved for the first time is built by
     * itself then, if OVC_MESH_MOVES was not set. */
    ovc_result (*update_instance)(ovc_scene scene, uint32_t mesh_id, const double* transform);
    /* Removes a mesh or an instance. Numbers of others stay as they are, and this one is not used again; instances of a removed
     * mesh stay. Positions with OVC_MESH_SHARED are no longer read once the mesh and all of its instances are removed and the next
     * commit has returned. */
    ovc_result (*remove_mesh)(ovc_scene scene, uint32_t mesh_id);

    /* Experimental. Builds a scene that need not fit into host memory, and hands to its `write` what save() would, for
     * ovc_scene_config.saved of a scene of the same meshes. Answers are the same bits as of a scene that was built in memory. What
     * fits is built there; else leaves are as small as host_memory_bytes asks, and such levels are taken under any budget that has
     * room for their pages, unless the config asks for leaves itself. config may be NULL; its `saved` and `tell_active` mean
     * nothing here. OVC_ERROR_OUT_OF_BUDGET: host_memory_bytes are too few, and the sentence names the smallest number that works.
     * OVC_ERROR_CANCELLED where a function of the host's says so. */
    ovc_result (*save_streamed)(ovc_device device, const ovc_scene_config* config, const ovc_streamed_scene* scene);

    /* For a host that owns its process and draws nothing by OpenGL itself: sets the environment variables by which Mesa's
     * software renderer uses vectors of 512 bits where the CPU has them, should that become the device, for scenes that ask for
     * this kernel: LP_NATIVE_VECTOR_WIDTH, and MESA_SHADER_CACHE_DIR or MESA_SHADER_CACHE_DISABLE with it.
     * What the user has set stays. Call it before other threads read the environment. At that width llvmpipe (22.3) crashes on
     * fragment shaders, the host's own too. OVC_ERROR_INVALID_STATE where a device was listed or opened before: the renderer no
     * longer looks. */
    ovc_result (*prepare_process)(ovc_kernel kernel);

    /* Experimental. Tells what save_streamed would make, for two looks at every triangle: leaves and bytes of the GPU as plan does;
     * host_bytes: the most that tracing what is saved takes of as many host_memory_bytes; smallest_host_bytes: the smallest number
     * that save_streamed works with; smallest_budget_bytes: about. Of the scene's functions read_corners alone is called, and the
     * others may be NULL. Its own memory stays below host_memory_bytes. Errors are those of save_streamed. */
    ovc_result (*plan_streamed)(ovc_device device, const ovc_scene_config* config, const ovc_streamed_scene* scene, ovc_plan* plan);
} ovc_api;

#if defined(_WIN32)
#define OVC_EXPORT
#else
#define OVC_EXPORT __attribute__((visibility("default")))
#endif

/* Returns the table for this version of the ABI, or NULL when the library does not have it. The
 * library owns it. */
OVC_EXPORT const ovc_api* ovc_get_api(uint32_t abi_version);
typedef const ovc_api* (*ovc_get_api_function)(uint32_t abi_version);

#ifdef __cplusplus
}
#endif

#endif
