// SPDX-License-Identifier: Apache-2.0
// Traces a ray through one page, with the traversal of the product's kernel (traverse.glsl).

// Returns the words of an answer (layout.h) from the page whose header is unit `page`.
uvec4 trace_page(int page, vec3 org, float t_end, vec3 dir, uint skip, bool any_hit) {
    Found found = nothing_found(t_end);
    int rounds = int(unit_at(page).z.w); // 0, but fetched: see Tree::start
    bool done = t_end < 0.0;
    if (!done)
        done = traverse(found, page, org, direction_of(dir), skip, any_hit, rounds);
    return done ? frame_answer(found, any_hit) : uvec4(0u, 0u, 0u, OVC_CAPPED);
}

// Returns the words of an answer if the whole scene is one page.
uvec4 trace(vec3 org, float t_end, vec3 dir, uint skip) {
    return trace_page(0, org, t_end, dir, skip, OVC_ANY_HIT != 0);
}
