// SPDX-License-Identifier: Apache-2.0
// Where a ray is, in the frame of the top-level tree or behind a portal, and its t in both frames.

#if OVC_PORTALS
// How a frame counts t: the ray's own t = enter + t / speed.
struct Times {
    double enter;
    double speed;
};

struct Place {
    bool behind_portal;
    Times part;        // of the frame that the ray was in last; Found counts its t's there
    Times scene;       // of the top-level tree
    GridRay grid;      // in the top-level tree
    bvec3 backward;    // in the top-level tree
    float end;         // in the top-level tree
    vec2 not_after;    // t in the top-level tree is at least x + y t, and
    vec2 not_before;   // at most x + y t of this one
};

const double OVC_LONGEST = 1.0e30; // a longer float of one frame may have no float in another

double moved(float t, Times from, Times to) {
    precise double there = ((from.enter - to.enter) + double(t) / from.speed) * to.speed;
    return there;
}
// 2^-22, 2^-28
double moved_error(double t) { return abs(t) * 2.384185791015625e-7 + 3.725290298461914e-9; }

// These return a float that is not later, or not earlier, than the same moment in another frame.
float earlier(float t, Times from, Times to) {
    double there = moved(t, from, to);
    there -= moved_error(there);
    return there < -OVC_LONGEST ? -3.0e38 : float(min(there, OVC_LONGEST));
}
float later(float t, Times from, Times to) {
    double there = moved(t, from, to);
    there += moved_error(there);
    float result = there < -OVC_LONGEST ? -1.0e30 : float(there);
    return there > OVC_LONGEST ? OVC_UNDECIDABLE : result;
}

// Prepares the same from a part to the top-level tree, for a step of the traversal. Its results are
// off by more, and always to the same side.
void measure(inout Place place) {
    const float slack = 9.5367431640625e-7; // 2^-20
    precise float offset = float((place.part.enter - place.scene.enter) * place.scene.speed);
    precise float rate = float(min(place.scene.speed / place.part.speed, OVC_LONGEST));
    float error = (abs(offset) + 1.0) * slack;
    place.not_after = vec2(offset - error, rate * (1.0 - slack));
    place.not_before = vec2(offset + error, rate * (1.0 + slack));
}

int not_after(Place place, int t) {
    OVC_EXACTLY float there = place.not_after.x + intBitsToFloat(t) * place.not_after.y;
    return max(floatBitsToInt(there), 0);
}
#else
struct Place {
    int none;
};

int not_after(Place place, int t) { return t; }
#endif
