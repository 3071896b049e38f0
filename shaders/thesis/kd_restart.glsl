// SPDX-License-Identifier: Apache-2.0
// Walks a KD-tree without a stack: it goes from leaf to leaf by starting again at the root, or at
// the deepest node that holds the rest of the ray. Every leaf lists the triangles of a slightly
// larger cell (plugin/thesis/kd_texels.h), so planes may round.
// Based on: Foley and Sugerman 2005, section 3.1 (kd-restart); Horn et al. 2007, section 3.2
// (push-down).

// Returns the words of an answer (layout.h).
uvec4 trace(vec3 org, float t_end, vec3 dir, uint skip) {
    Found found = nothing_found(t_end);
    Line line = line_of(org, dir);
    ivec4 first = ivec4(scene_texel(0)); // the first texels of nodes, of references, of triangles
    vec3 inv_dir = finite_reciprocal(dir);

    int root = 0;
    int node = 0;
    bool pushing = true; // no plane above the node cuts the rest of the ray
    float t = 0.0;       // the ray is done up to here
    float exit = OVC_NEVER;
    int reference = 0;
    int end = 0; // of the references of the leaf that the ray has just left
    int rounds = first.w;
    bool done = t_end < 0.0;
    while (going_on(done, rounds)) {
        for (int i = 0; i < OVC_WALK_STEPS && reference >= end && !done; ++i) {
            uvec4 two = scene_texel(first.x + (node >> 1));
            uvec2 words = (node & 1) == 0 ? two.xy : two.zw;
            int axis = int(words.y & 3u);
            int number = int(words.y >> 2);
            if (axis == 3) {
                reference = int(words.x);
                end = reference + number;
                t = exit;
                exit = OVC_NEVER;
                node = root;
                pushing = true;
                done = reference >= end && t > found.best_hi;
            } else {
                // Computed in one way only, so that a start at t lands beyond every plane that was
                // met up to t.
                float plane = (uintBitsToFloat(words.x) - org[axis]) * inv_dir[axis];
                bool before = t < plane;
                exit = before ? min(exit, plane) : exit;
                node = before == (inv_dir[axis] > 0.0) ? node + 1 : number;
                pushing = pushing && !(before && plane <= found.best_hi);
                root = pushing ? node : root;
            }
        }
        bool valid = reference < end;
        int at = first.z + 3 * int(scene_texel(first.y + (reference >> 2))[reference & 3]);
        at = valid ? at : first.z;
        bool took = take_triangle(found, scene_texel(at), scene_texel(at + 1), scene_texel(at + 2),
                                  valid, line, skip);
        ++reference;
        done = done || (reference >= end && t > found.best_hi) || (OVC_ANY_HIT != 0 && took);
    }
    return done ? frame_answer(found) : uvec4(0u, 0u, 0u, OVC_CAPPED);
}
