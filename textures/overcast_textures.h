/* SPDX-License-Identifier: Apache-2.0 */
/* The C ABI of libovercast-textures.so, which reads pictures by OpenImageIO for `overcast`. It is a
 * library of its own, opened only for scenes that have pictures, since OpenImageIO brings a hundred
 * packages. Experimental. C99. */
#ifndef OVERCAST_TEXTURES_H
#define OVERCAST_TEXTURES_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define OVC_TEXTURES_VERSION 1

/* A cache of pictures. */
typedef struct ovc_textures_* ovc_textures;

/* What lies beyond the unit square. BLACK is transparent. */
enum { OVC_WRAP_REPEAT = 0, OVC_WRAP_CLAMP = 1, OVC_WRAP_MIRROR = 2, OVC_WRAP_BLACK = 3 };

/* NEAREST takes one texel of the finest level, SMOOTH four. MIPMAPS takes the mean over the area.
 */
enum { OVC_TEXELS_NEAREST = 0, OVC_TEXELS_SMOOTH = 1, OVC_TEXELS_MIPMAPS = 2 };

/* A parallelogram around (s, t), with the sides a and b. (0, 0) is the lower left corner of the
 * picture, whose first row is at t = 1. */
typedef struct ovc_texture_area {
    float s, t;
    float a[2], b[2];
    uint32_t wrap_s, wrap_t;
    uint32_t texels;
} ovc_texture_area;

/* A picture to open. */
typedef struct ovc_picture {
    size_t struct_size;
    const char* file;     /* its path; in messages even where there are `bytes` */
    const void* bytes;    /* the contents of the file where it has none; or NULL */
    size_t byte_count;    /* they stay the caller's, who keeps them until destroy() */
    double gamma;         /* whole numbers become linear by this power; 0: by sRGB's curve */
    uint32_t width;       /* out, in texels */
    uint32_t height;      /* out */
    uint32_t has_opacity; /* out: 1 where it has an alpha channel, else 0 */
} ovc_picture;

/* Fields are only ever appended. Functions return 1, or 0 where last_error() has a sentence. */
typedef struct ovc_textures_api {
    size_t struct_size;
    uint32_t version;
    /* memory_bytes: the max memory of texels at a time; less than 10 MiB count as 10 MiB. NULL:
     * failed. */
    ovc_textures (*create)(uint64_t memory_bytes);
    /* No other call may be under way. */
    void (*destroy)(ovc_textures textures);
    /* Opens a picture. number: out, for sample(). Any number of threads may call it. */
    int (*open)(ovc_textures textures, ovc_picture* picture, uint32_t* number);
    /* Finds the mean color of an area, linear, with its opacity; a picture without an alpha channel
     * is opaque, and one of a single channel is gray. Any number of threads may call it. */
    int (*sample)(ovc_textures textures, uint32_t number, const ovc_texture_area* area,
                  float rgba[4]);
    /* Returns the sentence of the last call of this thread that failed. Valid until its next. */
    const char* (*last_error)(void);
    /* Returns the memory that texels take now, in bytes. */
    uint64_t (*memory_used)(ovc_textures textures);
} ovc_textures_api;

/* Returns NULL for a version that it does not speak. */
const ovc_textures_api* ovc_get_textures(uint32_t version);
typedef const ovc_textures_api* (*ovc_get_textures_function)(uint32_t version);

#ifdef __cplusplus
}
#endif

#endif
