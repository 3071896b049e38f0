// SPDX-License-Identifier: Apache-2.0
// Walks a uniform grid cell by cell. Every cell lists the triangles of a slightly larger cell
// (plugin/thesis/grid.h), so the walk may round.
// Based on: Amanatides and Woo 1987; Thrane and Simonsen 2005, section 4.2.

// Returns the words of an answer (layout.h).
uvec4 trace(vec3 org, float t_end, vec3 dir, uint skip) {
    Found found = nothing_found(t_end);
    Line line = line_of(org, dir);
    vec3 lo = uintBitsToFloat(scene_texel(0).xyz);
    vec3 size = uintBitsToFloat(scene_texel(1).xyz);
    ivec3 count = ivec3(scene_texel(2).xyz);
    ivec4 first = ivec4(scene_texel(3)); // the first texels of cells, of references, of triangles

    vec3 inv_dir = finite_reciprocal(dir);
    // From a cell to the plane by which the ray leaves it.
    ivec3 onward = ivec3(greaterThan(inv_dir, vec3(0.0)));
    ivec3 cell = clamp(ivec3(floor((org - lo) / size)), ivec3(0), count - 1);
    float t = 0.0; // where the ray enters the cell
    int reference = 0;
    int end = 0; // of the references of the cell that the ray has just left
    int rounds = first.w;
    bool done = t_end < 0.0;
    while (going_on(done, rounds)) {
        for (int i = 0; i < OVC_WALK_STEPS && reference >= end && !done; ++i) {
            if (t > found.best_hi || any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, count))) {
                done = true;
            } else {
                int index = (cell.z * count.y + cell.y) * count.x + cell.x;
                uvec4 two = scene_texel(first.x + (index >> 1));
                ivec2 range = ivec2((index & 1) == 0 ? two.xy : two.zw);
                reference = range.x;
                end = range.y;
                // Computed from the cell's place each time, because a sum of steps would drift.
                vec3 exit = (lo + vec3(cell + onward) * size - org) * inv_dir;
                t = min(exit.x, min(exit.y, exit.z));
                cell += (2 * onward - 1) *
                        (exit.x == t ? ivec3(1, 0, 0)
                                     : (exit.y == t ? ivec3(0, 1, 0) : ivec3(0, 0, 1)));
            }
        }
        bool valid = reference < end;
        int at = first.z + 3 * int(scene_texel(first.y + (reference >> 2))[reference & 3]);
        at = valid ? at : first.z;
        bool took = take_triangle(found, scene_texel(at), scene_texel(at + 1), scene_texel(at + 2),
                                  valid, line, skip);
        ++reference;
        done = done || (OVC_ANY_HIT != 0 && took);
    }
    return done ? frame_answer(found) : uvec4(0u, 0u, 0u, OVC_CAPPED);
}
