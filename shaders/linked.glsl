// SPDX-License-Identifier: Apache-2.0
// A ray through linked pages: all leaves share a frame, and one tree holds them.

// The words of an answer (layout.h).
uvec4 trace_linked(Traveller traveller) {
    WorldRay ray = traveller.ray;
    double longest = longest_component(ray);
    Direction direction = direction_of(local_direction(ray, longest));
    int scene = int(level1_texel(OVC_LEVEL1_START).y);
    dvec2 inside = inside_box(ray, scene);
    LocalRay local = rebase(ray, longest, scene, inside);
    Found found = nothing_found(local.t_end);
    int rounds = 0;
    bool some = inside.x <= inside.y && ray.t_max >= ray.t_min;
    bool done = !some || !local.decidable;
    if (!done)
        done = traverse(found, int(level1_texel(scene + OVC_LEAF_PAGE_TEXEL).x), 0, local.org, local.t_end, direction,
                        traveller.skip, traveller.any_hit, rounds);
    uvec4 answer = answer_of(found, traveller.any_hit, OVC_NO_LEAF);
#if !OVC_CERTIFY
    double t_hit = local.enter + double(found.best_lo) / local.speed;
    answer.xyz = uvec3(unpackDouble2x32(t_hit), packUnorm2x16(barycentric(found)));
#endif
    answer.w = some && !local.decidable ? OVC_FLAGGED : answer.w;
    return done ? answer : uvec4(0u, 0u, OVC_NO_LEAF, OVC_CAPPED);
}
