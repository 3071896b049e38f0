// SPDX-License-Identifier: Apache-2.0
// How a frame counts t, in pairs of floats, as times_doubles.glsl does it in doubles.

struct Times {
    FloatPair enter; // the ray's own t = (enter + t / speed) * 2^n, where n belongs to the ray
    FloatPair speed;
};

const float OVC_LONGEST = 1.0e18; // of a t, far beyond what pairs decide

// Returns the t of another frame, and the max error.
float moved(float t, Times from, Times to, out float error) {
    FloatPair apart = difference(from.enter, to.enter);
    FloatPair there = product(sum(apart, quotient(FloatPair(t, 0.0), from.speed)), to.speed);
    // 2^-21, for that and for the roundings of what comes after it; 2^-28; and 2^-40, more than
    // 64 u^2, of the terms.
    error = abs(there.hi) * 4.76837158203125e-7 + 3.725290298461914e-9 +
            (abs(from.enter.hi) + abs(to.enter.hi)) * to.speed.hi * 9.094947017729282e-13;
    return there.hi;
}

// These return a float that is not later, or not earlier, than the same moment in another frame.
float earlier(float t, Times from, Times to) {
    float error;
    float there = moved(t, from, to, error);
    there -= error;
    bool tells = abs(t) <= OVC_LONGEST && abs(there) <= OVC_LONGEST; // not with a NaN
    return tells ? there : -3.0e38;
}
float later(float t, Times from, Times to) {
    float error;
    float there = moved(t, from, to, error);
    there += error;
    bool tells = abs(t) <= OVC_LONGEST && abs(there) <= OVC_LONGEST;
    return tells ? there : OVC_UNDECIDABLE;
}

// Returns (from.enter - to.enter) * to.speed, and to.speed / from.speed, as floats.
float offset_between(Times from, Times to) {
    return product(difference(from.enter, to.enter), to.speed).hi;
}
float rate_between(Times from, Times to) {
    precise float rate = min(to.speed.hi / from.speed.hi, OVC_LONGEST);
    return rate;
}
