/* SPDX-License-Identifier: Apache-2.0 */
/* What libovercast-mpi.so offers besides the ABI of overcast.h: the ranks of MPI_COMM_WORLD, for
 * hosts that do not link MPI themselves. Experimental. C99. */
#ifndef OVERCAST_RANKS_H
#define OVERCAST_RANKS_H

#include "overcast.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Takes what a rank has sent: `size` bytes, valid during the call only. */
typedef void (*ovc_take_function)(void* user, uint32_t rank, const void* bytes, size_t size);

/* Returns 0 to go on waiting, anything else to stop. It is asked some twenty times a second. */
typedef int (*ovc_wait_function)(void* user);

/* Fields are only ever appended. Calls come from one thread at a time. Where one does not return
 * OVC_OK, last_error() has a sentence. */
typedef struct ovc_ranks {
    size_t struct_size;
    uint32_t rank;  /* of this process */
    uint32_t ranks; /* how many there are */
    /* How people call a rank: "rank 3 on node7". Valid until the process ends. */
    const char* (*name_of)(uint32_t rank);
    const char* (*last_error)(void);
    /* All ranks call it. On rank 0 it waits for the bytes of all ranks and hands them to `take`, in
     * the order of ranks; on the others it returns at once. OVC_ERROR_CANCELLED where `wait` says
     * so, which may be NULL; OVC_ERROR_INTERNAL where a rank is lost. */
    ovc_result (*gather)(const void* bytes, size_t size, ovc_take_function take,
                         ovc_wait_function wait, void* user);
    /* All ranks call it. Hands the bytes of rank 0 to `take` on all ranks. Errors are those of
     * gather. */
    ovc_result (*spread)(const void* bytes, size_t size, ovc_take_function take,
                         ovc_wait_function wait, void* user);
    /* Ends all processes at once, with this exit code. */
    void (*abort)(int code);
    /* Sets ranks[i] to the rank whose leaves of the scene ray i comes by first, of those that no
     * other rank has, and to 0xffffffff where it comes by none, or the scene is not shared out. A
     * host whose ranks each trace their own rays sends fewer of them to others. The answers are
     * those of all ranks. ranks: ray_count numbers. Errors are those of intersect. */
    ovc_result (*first_ranks)(ovc_scene scene, const ovc_ray* rays, size_t ray_count,
                              uint32_t* ranks);
} ovc_ranks;

/* Starts MPI where it is not, and returns the ranks; the same on each call. NULL: MPI cannot be
 * started. All ranks call it. timeout_seconds: a rank that gives no word for so long is lost; 0:
 * 60. */
OVC_EXPORT const ovc_ranks* ovc_get_ranks(double timeout_seconds);
typedef const ovc_ranks* (*ovc_get_ranks_function)(double timeout_seconds);

#ifdef __cplusplus
}
#endif

#endif
