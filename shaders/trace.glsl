// SPDX-License-Identifier: Apache-2.0
// Traces rays through the top-level tree: takes them from the pass and gives their answers.

// Writes the words of an answer. The wrapper, trace.frag.glsl or trace.comp.glsl, defines it.
void give(int ray, uvec4 answer);
#if OVC_NAMES > 2
// Writes the names of so many candidates of each ray to where it was.
void give_names(int first, Found found[OVC_PACKET], int counts[OVC_PACKET]);
#endif

#if OVC_PORTALS
// Takes what a ray says besides where it goes: what it skips, if any hit will do, where it goes on.
void take_asks(int ray, inout Packet packet) {
    uvec4 asks = ray_texel(ray * OVC_RAY_TEXELS + 4);
    packet.skip[0] = asks.z;
    packet.any_hit[0] = OVC_ANY_HIT != 0 || (asks.w & OVC_RAY_ANY_HIT) != 0u;
    packet.links[0] = no_links();
#if OVC_MAY_WAIT
    packet.links[0].done = int(asks.w & OVC_NO_LEAF);
#endif
}
#else
// Takes the rays from `first` on, in the frame that all pages share. A packet has the octant and
// the axis of its first ray. The host makes packets that way; a ray that differs is left for
// doubles to decide. Returns whether any of them is a ray.
bool take_rays(int first, Tree tree, out Packet packet, out Found found[OVC_PACKET]) {
    const int texels = OVC_MAY_WAIT == 0 ? OVC_LOCAL_RAY_TEXELS : OVC_RESUMED_RAY_TEXELS;
    bool any = false;
    for (int k = 0; k < OVC_PACKET; ++k) {
        uvec4 from = ray_texel((first + k) * texels);
        uvec4 to = ray_texel((first + k) * texels + 1);
        vec3 dir = uintBitsToFloat(to.xyz);
        bvec3 backward = lessThan(dir, vec3(0.0));
        Axes axes = axes_of(dir);
        if (!any) {
            packet.backward = backward;
            packet.axes = axes;
        }
        float t_end = uintBitsToFloat(from.w);
        bool alike = backward == packet.backward && axes == packet.axes;
        t_end = t_end >= 0.0 && !alike ? OVC_UNDECIDABLE : t_end;
        found[k] = nothing_found(t_end);
        set_ray(packet, k, tree, uintBitsToFloat(from.xyz), direction_of(dir, packet.axes),
                to.w & OVC_SKIPS_NONE, OVC_ANY_HIT != 0 || (to.w & OVC_RAY_ANY_HIT) != 0u);
        packet.links[k] = no_links();
#if OVC_MAY_WAIT
        packet.links[k].done = int(ray_texel((first + k) * texels + 2).x);
#endif
        any = any || t_end >= 0.0;
    }
    packet.first_number = 0u;
    return any;
}
#endif

// Takes the rays from `ray` on if these set out, and else brings the ray through the portal that it
// has come to, if it has. Both are one change of frames: llvmpipe goes through everything that any
// lane may need.
void go_on(int ray, bool sets_out, Tree tree, inout Descent d, inout Packet packet,
           inout Found found[OVC_PACKET]) {
#if OVC_PORTALS
    if (sets_out)
        take_asks(ray, packet);
    if (sets_out || is_at_portal(d, found[0]))
        change_frame(ray, sets_out, d, packet, found[0]);
#else
    if (sets_out)
        d.done = !take_rays(ray, tree, packet, found);
#endif
}

const float OVC_ANYWHERE = -3.0e38; // a t before all others

// Returns a t before which the ray certainly hits nothing, in the frame of the top-level tree.
float begin_of(Found found, Place place) {
#if OVC_FLOAT_PAIRS
    return earlier(first_t(found), place.part, place.scene) - place.early;
#elif OVC_PORTALS
    return earlier(first_t(found), place.part, place.scene);
#else
    return first_t(found);
#endif
}

// ended: not lost on the way; whole: nor given up as hopeless. Returns whether candidates were
// named in the places of rays.
bool give_answers(int first, Packet packet, Found found[OVC_PACKET], bool ended, bool whole,
                  int rounds) {
#if OVC_NAMES > 2
    int counts[OVC_PACKET];
#endif
    for (int k = 0; k < OVC_PACKET; ++k) {
        uvec4 answer = answer_of(found[k], packet.any_hit[k], OVC_NO_LEAF);
#if OVC_MAY_WAIT
        // A ray does not wait for a page that lies beyond its best hit.
        int waits = packet.links[k].waits;
        float end = found[k].best_hi < 0.0 ? found[k].best_hi : end_of(packet, found[k], k);
        answer.z = (waits & ~OVC_KEY_LEAF) <= floatBitsToInt(end) ? uint(waits) : answer.z;
#endif
        bool undecidable = found[k].best_hi == OVC_UNDECIDABLE;
        answer.w = undecidable ? OVC_FLAGGED : answer.w;
        if (answer.w == OVC_FLAGGED) {
            bool tells = whole && !undecidable;
            answer.x = 0u;
            answer.y = floatBitsToUint(tells ? begin_of(found[k], packet.place) : OVC_ANYWHERE);
        }
#if OVC_NAMES > 2
        // The two that the words of the answer would name may both be the certain hit itself.
        bool decided = packet.any_hit[k] && found[k].prim != OVC_MISS;
        bool listed = ended && !decided && answer.w != OVC_FLAGGED && are_listed(found[k]);
        counts[k] = listed ? found[k].count : 0;
        answer.x = listed ? OVC_LISTED : answer.x;
        answer.y = listed ? uint((first + k) << OVC_LIST_BITS | counts[k]) : answer.y;
#endif
#if OVC_COUNTS
        answer.x = uint(rounds);
        answer.y = uint(units_fetched);
#endif
        give(first + k, ended ? answer : uvec4(0u, 0u, OVC_NO_LEAF, OVC_CAPPED));
    }
    bool named = false;
#if OVC_NAMES > 2
    give_names(first, found, counts);
    for (int k = 0; k < OVC_PACKET; ++k)
        named = named || counts[k] > 0;
#endif
    return named;
}

// Traces on for at least one round, until all rays have their answers, or the ray is at a portal,
// or `rounds` reaches max_rounds. Returns whether they have their answers.
bool trace_on(inout Descent d, inout Packet packet, inout Found found[OVC_PACKET],
              int max_rounds, inout int rounds) {
    bool ended = run(d, found, packet, 0, max_rounds, rounds);
#if OVC_REFILL // else after each round
    for (int k = 0; k < OVC_PACKET; ++k)
        end_behind_candidates(found[k], packet.any_hit[k]);
#endif
    return ended && !is_at_portal(d, found[0]);
}

// A ray that has gone on for so many rounds, and has so many candidates that none could be named,
// gives up: it may meet thousands of triangles in one point, which are for doubles to decide.
const int OVC_PATIENCE = 256;

// Returns whether all rays of the packet have their answers, or will be flagged as they stand.
bool are_hopeless(Found found[OVC_PACKET]) {
    bool all = OVC_CERTIFY != 0;
    for (int k = 0; k < OVC_PACKET; ++k)
        all = all && (found[k].best_hi < 0.0 || are_too_many(found[k]));
    return all;
}

#if !OVC_REFILL
// Traces the rays from `ray` on that an invocation takes together. Returns how many rounds that
// took; max_rounds: they give up after so many.
int trace_once(int ray, int max_rounds) {
    Tree tree = tree_of(0, 0);
    Descent d = descent(tree);
    Packet packet;
    Found found[OVC_PACKET];
    int rounds = 0;
    go_on(ray, true, tree, d, packet, found);
    int look = min(OVC_PATIENCE, max_rounds); // at this round
    bool whole, ended;
    do {
        whole = trace_on(d, packet, found, look, rounds);
        ended = whole || (rounds >= look && are_hopeless(found));
        go_on(ray, false, tree, d, packet, found);
        look = rounds >= look ? min(look + OVC_PATIENCE, max_rounds) : look;
    } while (!ended && rounds < max_rounds);
    give_answers(ray, packet, found, ended && !d.lost, whole, rounds);
    return rounds;
}
#else
// Rounds between two looks at which lanes have an answer or have come to a portal; more if taking
// up new rays costs more, or going through portals.
const int OVC_REFILL_ROUNDS = OVC_PACKET > 1 ? 5 : (OVC_PORTALS != 0 ? 5 : 3);

// Traces the rays from `begin` to before `end` by the lanes of a subgroup. Now and then the lanes
// that have an answer go on to the next rays that no lane has taken, so that lanes do not wait for
// each other. Returns how many rounds that took, never fewer than llvmpipe has counted of its loops
// while the lane had rays; max_rounds: those that are left then give up.
// Based on: Aila and Laine 2009, "Understanding the Efficiency of Ray Traversal on GPUs" (replacing
// terminated rays, persistent threads).
int trace_with_refill(int begin, int end, int max_rounds) {
    Tree tree = tree_of(0, 0);
    Descent d = descent(tree);
    Packet packet;
    Found found[OVC_PACKET];
    int ray = begin + int(gl_SubGroupInvocationARB) * OVC_PACKET;
    int next = begin + int(gl_SubGroupSizeARB) * OVC_PACKET; // the same in all lanes
    uint lanes_before = (1u << gl_SubGroupInvocationARB) - 1u;
    int rounds = 0;
    int looks = 0; // since the lane took its rays
    go_on(ray, true, tree, d, packet, found);
    while (ray < end) {
        bool enough = rounds >= max_rounds;
        int own = 0; // at most OVC_REFILL_ROUNDS
        bool whole = trace_on(d, packet, found, enough ? 1 : OVC_REFILL_ROUNDS, own);
        rounds += OVC_REFILL_ROUNDS + 1;
        ++looks;
        bool ended = whole || (looks > OVC_PATIENCE / OVC_REFILL_ROUNDS && are_hopeless(found));
        bool ready = ended || enough;
        uint ready_lanes = uint(ballotARB(ready));
        bool named = false;
        if (ready) {
            named = give_answers(ray, packet, found, ended && !d.lost, whole, rounds);
            ray = next + bitCount(ready_lanes & lanes_before) * OVC_PACKET;
            start(d, tree);
            looks = 0;
        }
        go_on(ray, ready, tree, d, packet, found);
        next += bitCount(ready_lanes) * OVC_PACKET;
#if OVC_NAMES > 2
        // llvmpipe goes through the loop of give_names() once where no lane has any.
        rounds += uint(ballotARB(named)) != 0u ? OVC_PACKET * OVC_NAMES : 1;
#endif
    }
    return rounds;
}
#endif
