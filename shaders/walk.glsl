// SPDX-License-Identifier: Apache-2.0
// A ray's way through level 1: from leaf to leaf as long as they are in the pool, until one has an answer for it.

#if !OVC_TOP_LEVEL
// The words of an answer (layout.h).
uvec4 walk(Traveller traveller) {
    WorldRay ray = traveller.ray;
    double longest = longest_component(ray);
    Direction direction = direction_of(local_direction(ray, longest));
    double t = traveller.t_from; // of the cells done
    double t_cell = t;           // before the cell that `cell` is
    Cell cell = Cell(0, 0, ray.t_max);
    bool last = false; // the ray ends in `cell`
    int first_leaf = traveller.first_leaf;
    uvec4 answer = uvec4(OVC_NO_TRIANGLE, OVC_NO_TRIANGLE, 0u, OVC_MISS);
    int rounds = 0;
    bool done = ray.t_max < ray.t_min;
    while (!done && rounds < OVC_MOST_ROUNDS) {
        // The next leaf whose box the ray meets.
        int leaf = -1;
        dvec2 inside = dvec2(1.0, 0.0);
        while (leaf < 0 && !done && rounds < OVC_MOST_ROUNDS) {
            ++rounds;
            if (cell.first == cell.end) {
                done = last;
                t_cell = t;
                cell = cell_after(ray, t);
                t = cell.exit;
                last = t >= ray.t_max;
                cell.first = first_leaf > cell.first && first_leaf <= cell.end ? first_leaf : cell.first;
                first_leaf = -1;
            }
            if (!done && cell.first < cell.end) {
                inside = inside_box(ray, OVC_LEVEL1_LEAVES + cell.first * OVC_LEAF_TEXELS);
                leaf = inside.x <= inside.y ? cell.first : -1;
                ++cell.first;
            }
        }
        if (leaf >= 0) {
            int texel = OVC_LEVEL1_LEAVES + leaf * OVC_LEAF_TEXELS;
            uint page = level1_texel(texel + OVC_LEAF_PAGE_TEXEL).x;
            LocalRay local = rebase(ray, longest, texel, inside);
            if (page == OVC_NOT_RESIDENT) {
                answer = uvec4(unpackDouble2x32(t_cell), uint(leaf), OVC_WAITS);
                done = true;
            } else if (!local.decidable) {
                answer = uvec4(OVC_NO_TRIANGLE, OVC_NO_TRIANGLE, uint(leaf), OVC_FLAGGED);
                done = true;
            } else {
#if OVC_TELL_ACTIVE
                mark_active(leaf);
#endif
                Found found = nothing_found(local.t_end);
                if (traverse(found, int(page), local.org, direction, traveller.skip, traveller.any_hit, rounds)) {
                    answer = answer_of(found, traveller.any_hit, uint(leaf));
                    done = answer.w != OVC_MISS || answer.x != OVC_NO_TRIANGLE;
#if !OVC_CERTIFY
                    double t_hit = local.enter + double(found.best_lo) / local.speed;
                    // Farther than a few roundings beyond the cell, a nearer hit may be in the next leaf.
                    done = done && t_hit <= cell.exit + double(OVC_FAST_SLACK) / local.speed;
                    answer = done ? uvec4(unpackDouble2x32(t_hit), packUnorm2x16(barycentric(found)), answer.w)
                                  : uvec4(OVC_NO_TRIANGLE, OVC_NO_TRIANGLE, 0u, OVC_MISS);
#endif
                    // Another leaf of the same cell may hold something nearer, and only doubles could tell.
                    bool alone = cell.first == cell.end || (traveller.any_hit && answer.w < OVC_MAX_TRIANGLES);
                    answer.w = done && !alone ? OVC_FLAGGED : answer.w;
                    done = done || (last && cell.first == cell.end);
                }
            }
        }
    }
    // llvmpipe ends loops after 65,535 rounds without a word; such a ray is not done, and nobody may believe it. The second
    // way out of the loops is there so that no compiler takes `done` for true behind them.
    return done ? answer : uvec4(0u, 0u, 0u, OVC_CAPPED);
}
#endif
