// SPDX-License-Identifier: Apache-2.0
// Portals: where a ray comes to a part in another frame. The kernel computes the ray there in
// doubles, or in pairs of floats, from the ray in the world (docs/design/numerics.md, "Frames").

#if OVC_PORTALS
OVC_TEXELS(OVC_BINDING_PORTALS, PortalTexels) portals;
uvec4 portal_texel(int i) { return OVC_TEXEL(portals, i); }

#include "local_ray.glsl"

// Pushes a word that leads to unit 0. It lies below the words of the part that the ray comes to.
void push_mark(inout Descent d) {
    bool store = !is_none(d.top);
#if OVC_STACK == 1
    d.lost = d.lost || (store && !is_none(d.stack[OVC_STACK_DEPTH - 1]));
    Word above = d.top;
    for (int i = 0; i < OVC_STACK_DEPTH; ++i) {
        Word own = d.stack[i];
        d.stack[i] = store ? above : own;
        above = own;
    }
#else
    d.lost = d.lost || (store && d.height >= OVC_STACK_DEPTH - 1);
    if (store && !d.lost) {
        ++d.height;
        OVC_STACK_AT(d, d.height) = d.top;
    }
#endif
    d.top = word_of(0, 4);
}

// Keeps the ray as it is in the frame of the top-level tree, for when it comes back there.
void keep_scene(inout Packet packet, LocalRay local) {
    packet.place.grid = packet.grid[0];
    packet.place.backward = packet.backward;
    packet.place.end = local.t_end;
#if OVC_FLOAT_PAIRS
    packet.place.early = local.early;
#endif
}

void set_local_ray(inout Packet packet, LocalRay local, Tree tree) {
    packet.backward = lessThan(local.dir, vec3(0.0));
    packet.axes = axes_of(local.dir);
    set_ray(packet, 0, tree, local.org, direction_of(local.dir, packet.axes), packet.skip[0],
            packet.any_hit[0]);
}

// Brings a ray into another frame: one that sets out into that of the top-level tree, whose portal
// is the first, and another one into that behind the portal that it has come to. If nothing behind
// that portal can be nearer than what the ray has found, it stays in the top-level tree.
void change_frame(int ray, bool sets_out, inout Descent d, inout Packet packet,
                  inout Found found) {
    Portal portal = portal_at(sets_out ? 0 : -d.unit);
    LocalRay local = local_ray(world_ray(ray), portal);
    if (sets_out) {
        found = nothing_found(OVC_NO_RAY);
        packet.place.part = local.times;
        packet.place.scene = local.times;
    }
    Found there = in_times(found, packet.place.part, local.times, local.t_end);
    bool decidable = local.decidable && there.best_hi != OVC_UNDECIDABLE;
    d.unit = 0; // if the part has nothing for the ray, it goes on to the next of the stack
    if (local.meets && !decidable) {
        // Candidates that lie before the part would give it an end, and it would go on.
        found = nothing_found(OVC_UNDECIDABLE);
    } else if (local.meets && there.best_hi >= 0.0) { // else its hit comes before the part
        Tree tree = tree_of(portal.tree, 0);
        found = there;
        packet.place.part = local.times;
        packet.place.behind_portal = !sets_out;
        packet.first_number = portal.first_number;
        measure(packet.place);
        set_local_ray(packet, local, tree);
        if (sets_out)
            keep_scene(packet, local);
        else
            push_mark(d);
        d.unit = tree.start.x;
    }
    d.done = d.lost || found.best_hi < 0.0;
}
#endif
