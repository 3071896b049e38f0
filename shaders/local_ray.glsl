// SPDX-License-Identifier: Apache-2.0
// A ray in the frame behind a portal, and how it comes there.

// A ray in a frame, as the traversal takes it, and the times that lead back to the world's t.
struct LocalRay {
    vec3 org; // where it enters the box
    vec3 dir; // the largest component 1 or -1
    float t_end;
    bool meets;     // the box
    bool decidable; // doubles, or pairs of floats, can say where it enters
    Times times;
    float early;    // the host's t in this frame may be so much less
};

#if OVC_FLOAT_PAIRS
#include "rebase_float_pairs.glsl"
#else
#include "rebase_doubles.glsl"
#endif
