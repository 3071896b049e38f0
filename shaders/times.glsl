// SPDX-License-Identifier: Apache-2.0
// Where a ray is, in the frame of the top-level tree or behind a portal, and its t in both frames.

#if OVC_PORTALS
#if OVC_FLOAT_PAIRS
#include "float_pairs.glsl"
#include "times_float_pairs.glsl"
#else
#include "times_doubles.glsl"
#endif

struct Place {
    bool behind_portal;
    Times part;        // of the frame that the ray was in last; Found counts its t's there
    Times scene;       // of the top-level tree
    GridRay grid;      // in the top-level tree
    bvec3 backward;    // in the top-level tree
    float end;         // in the top-level tree
    vec2 not_after;    // t in the top-level tree is at least x + y t, and
    vec2 not_before;   // at most x + y t of this one
#if OVC_FLOAT_PAIRS
    float early;       // the host's t in the top-level tree may be so much less
#endif
};

// Prepares the same from a part to the top-level tree, for a step of the traversal. Its results are
// off by more, and always to the same side.
void measure(inout Place place) {
    const float slack = 9.5367431640625e-7; // 2^-20
    precise float offset = offset_between(place.part, place.scene);
    precise float rate = rate_between(place.part, place.scene);
    OVC_EXACTLY float error = (abs(offset) + 1.0) * slack;
    OVC_EXACTLY vec2 line = vec2(offset - error, rate * (1.0 - slack));
    place.not_after = line;
    place.not_before = vec2(offset + error, rate * (1.0 + slack));
}

int not_after(Place place, int t) {
    OVC_EXACTLY float there = place.not_after.x + intBitsToFloat(t) * place.not_after.y;
    return max(floatBitsToInt(there), 0);
}
#else
struct Place {
    int none;
};

int not_after(Place place, int t) { return t; }
#endif
