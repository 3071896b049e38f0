// SPDX-License-Identifier: Apache-2.0
// How a frame counts t, in doubles.

struct Times {
    double enter; // the ray's own t = enter + t / speed
    double speed;
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

// Returns (from.enter - to.enter) * to.speed, and to.speed / from.speed, as floats.
float offset_between(Times from, Times to) {
    precise float offset = float((from.enter - to.enter) * to.speed);
    return offset;
}
float rate_between(Times from, Times to) {
    precise float rate = float(min(to.speed / from.speed, OVC_LONGEST));
    return rate;
}
