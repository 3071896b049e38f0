// SPDX-License-Identifier: Apache-2.0
// The product's page over the whole scene: its traversal (traverse.glsl), once.

uvec4 trace(vec3 org, float t_end, vec3 dir, uint skip) {
    Found found = nothing_found(t_end);
    int rounds = int(page_texel(2).w); // 0, fetched
    bool done = t_end < 0.0;
    if (!done)
        done = traverse(found, 0, org, t_end, direction_of(dir), skip, OVC_ANY_HIT != 0, rounds);
    return done ? frame_answer(found) : uvec4(0u, 0u, 0u, OVC_CAPPED);
}
