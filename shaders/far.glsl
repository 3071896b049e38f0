// SPDX-License-Identifier: Apache-2.0
// Far triangles: a few that reach through much of the scene, as those of a floor do. Float32 knows
// them to a rounding of their own size, which may be more than the size of all else. The kernel
// tests them in doubles, at their portal (docs/design/numerics.md, "Far triangles").

// A ray and a far triangle: any hit is at a t of the ray in [first, last].
struct FarHit {
    double first;
    double last;
    bool possible;
    bool certain;
    vec2 weights; // of corners 1 and 2
    uint number;
};

FarHit far_hit(int texel, FrameRay ray, double t_min, double t_max) {
    const double slack = 3.552713678800501e-15; // 2^-48, more than all roundings of a product
    dvec2 n[9];
    for (int i = 0; i < 9; ++i)
        n[i] = doubles_of(portal_texel(texel + i));
    dvec3 normal = dvec3(n[0], n[1].x);
    precise double height = normal.x * ray.org.x + normal.y * ray.org.y + normal.z * ray.org.z;
    precise double rate = normal.x * ray.dir.x + normal.y * ray.dir.y + normal.z * ray.dir.z;
    precise double below = (n[1].y - height) - slack * ray.reach;
    precise double above = (n[2].x - height) + slack * ray.reach;
    precise dvec2 t = dvec2(below, above) / rate;
    double share = 2.0 * (slack * ray.dir_reach / abs(rate) + slack);
    precise dvec2 off = abs(t) * share;
    bool tells = share <= 1.0e-3; // not if the ray runs along the plane, and not with a NaN
    FarHit hit;
    hit.first = tells ? max(min(t.x - off.x, t.y - off.y), t_min) : t_min;
    hit.last = tells ? min(max(t.x + off.x, t.y + off.y), t_max) : t_max;
    double middle = 0.5 * (hit.first + hit.last);
    precise dvec3 at = ray.org + ray.dir * middle;
    double reach = ray.reach + ray.dir_reach * abs(middle);
    double error = ray.dir_reach * (hit.last - hit.first) + slack * reach;
    dvec3 to_weight[3] = dvec3[3](dvec3(n[2].y, n[3]), dvec3(n[4].y, n[5]), dvec3(n[6].y, n[7]));
    dvec3 shift = dvec3(n[4].x, n[6].x, n[8].x);
    bool inside = true, outside = false;
    dvec3 weight;
    for (int corner = 0; corner < 3; ++corner) {
        dvec3 m = to_weight[corner];
        precise double w = m.x * at.x + m.y * at.y + m.z * at.z - shift[corner];
        double w_error = error * (abs(m.x) + abs(m.y) + abs(m.z)) + slack * abs(shift[corner]) + n[8].y;
        inside = inside && w > w_error;
        outside = outside || w < -w_error;
        weight[corner] = w;
    }
    hit.possible = hit.first <= hit.last && !outside;
    hit.certain = hit.possible && inside && hit.first > t_min && hit.last < t_max;
    hit.weights = vec2(weight.yz);
    hit.number = portal_texel(texel + 9).x;
    return hit;
}

// Returns a t of the ray itself in other times, rounded up.
float rounded_up(double t, Times times) {
    double there = min((t - times.enter) * times.speed, OVC_LONGEST);
    return float(there + moved_error(there));
}

// Takes the far triangles behind a portal. A ray does not change its frame for them; it only counts
// its times from the hit on, so that a float tells the hit's time as closely as the doubles do.
void take_far_triangles(WorldRay ray, Portal portal, inout Packet packet, inout Found found) {
    FrameRay frame = frame_ray(ray, portal);
    for (int i = 0; i < portal.far.y; ++i) {
        FarHit hit = far_hit(portal.far.x + i * OVC_FAR_TRIANGLE_TEXELS, frame, ray.t_min, ray.t_max);
        Times times = Times(hit.first, packet.place.part.speed);
        Found there = in_times(found, packet.place.part, times, rounded_up(ray.t_max, times));
        bool undecidable = there.best_hi == OVC_UNDECIDABLE;
        if (!hit.possible || (there.best_hi < 0.0 && !undecidable) || found.best_hi < 0.0)
            continue; // the hit that the ray has already comes before
        Candidate candidate = Candidate(true, hit.certain, hit.certain ? 1.0e-37 : 0.0,
                                        rounded_up(hit.last, times), hit.weights);
        uint prim = hit.number + portal.first_number;
        bool took = take(there, candidate, prim != packet.skip[0] && !is_known(there, prim), prim,
                         OVC_OWN_ORDER);
        there.best_hi = packet.any_hit[0] && took ? OVC_ENOUGH : there.best_hi;
        found = there;
        packet.place.part = times;
        packet.place.behind_portal = true;
    }
    measure(packet.place);
    leave(packet.place, found, true);
}
