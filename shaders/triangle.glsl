// SPDX-License-Identifier: Apache-2.0
// A ray against triangles in float32, with proof: each candidate is certainly hit, certainly missed, or in doubt.
// Based on: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection"; the bound: docs/design/numerics.md.

// The axis along which a ray goes farthest becomes z, turned so that it goes up; the others x and y.
struct Axes {
    bool along_x;
    bool along_z; // along y where neither
    uint turned;  // the sign bit, where the ray goes down
};

// The direction's largest component is 1 or -1.
Axes axes_of(vec3 dir) {
    bool along_z = abs(dir.z) == 1.0;
    bool along_x = !along_z && abs(dir.y) != 1.0;
    return Axes(along_x, along_z, floatBitsToUint(along_z ? dir.z : (along_x ? dir.x : dir.y)) & 0x80000000u);
}

// At most two of the axes are asked for that are the same, so that this is four selections for three components; a dot product
// each with zeros and ones was nine products. Turned by bits: some come from nodes, and are no normal numbers.
vec3 by_axis(Axes axes, vec3 v) {
    float z = axes.along_z ? v.z : (axes.along_x ? v.x : v.y);
    return vec3(axes.along_x ? v.y : v.x, axes.along_z ? v.y : v.z, uintBitsToFloat(floatBitsToUint(z) ^ axes.turned));
}

// A ray as triangles are tested with it: by axis, its origin, and x and y of its direction, whose z is 1.
struct Line {
    Axes axes;
    vec3 org;
    vec2 shear;
};

Line line_of(vec3 org, vec3 dir) {
    Axes axes = axes_of(dir);
    return Line(axes, by_axis(axes, org), by_axis(axes, dir).xy);
}

// A corner, where the line is the z axis.
struct Corner {
    float x;
    float y;
    float z;
    float size; // |x| + |y|
};

Corner corner(vec3 position, Line line) {
    precise vec3 p = by_axis(line.axes, position) - line.org;
    precise float x = p.x - p.z * line.shear.x;
    precise float y = p.y - p.z * line.shear.y;
    return Corner(x, y, p.z, abs(x) + abs(y));
}

// Instead of min() and max(), which llvmpipe makes of three instructions, because of NaNs.
float lesser(float a, float b) {
    precise float r = a < b ? a : b;
    return r;
}
float greater(float a, float b) {
    precise float r = a < b ? b : a;
    return r;
}

// What each coordinate of any of the corners is off by at most, and a share for the products of an edge function. One for all of them takes
// fewer instructions than one each, and one ray in fifty more is in doubt.
float reach(Corner c) { return c.size + abs(c.z); }
float error_at(float reach) {
    return float(OVC_BOUND_UNIT * OVC_BOUND_CONSTANT) + float(OVC_BOUND_UNIT * OVC_BOUND_RELATIVE) * reach;
}
float error_of(Corner a, Corner b, Corner c) { return error_at(greater(greater(reach(a), reach(b)), reach(c))); }
float error_of(Corner a, Corner b, Corner c, Corner d) {
    return error_at(greater(greater(reach(a), reach(b)), greater(reach(c), reach(d))));
}

// Twice the signed area of (origin, a, b), and what it is off by at most.
float edge(Corner a, Corner b) {
    precise float e = a.x * b.y - a.y * b.x;
    return e;
}
// error: of the corners.
float edge_error(Corner a, Corner b, float error) { return error * ((a.size + error) + (b.size + error)); }

// The edge functions of a triangle (a, b, c), and what they are off by at most.
struct Edges {
    float ab;
    float bc;
    float ca;
    float ab_error;
    float bc_error;
    float ca_error;
};

Edges edges_of(Corner a, Corner b, Corner c, float error) {
    return Edges(edge(a, b), edge(b, c), edge(c, a), edge_error(a, b, error), edge_error(b, c, error), edge_error(c, a, error));
}

// A verdict is the sign of a number, true where it is negative: a difference and bits take fewer instructions than comparisons and masks.
int less(float a, float b) { return floatBitsToInt(a - b); }

// Where the ray passes: `outside` certainly, `inside` certainly, or neither.
struct Passing {
    int outside;
    int inside;
};

Passing passing_of(Edges e) {
    ivec3 not_positive = ivec3(less(e.ab, e.ab_error), less(e.bc, e.bc_error), less(e.ca, e.ca_error));
    ivec3 negative = ivec3(less(e.ab, -e.ab_error), less(e.bc, -e.bc_error), less(e.ca, -e.ca_error));
    int all_positive = ~(not_positive.x | not_positive.y | not_positive.z);
    int any_positive = ~(not_positive.x & not_positive.y & not_positive.z);
    int all_negative = negative.x & negative.y & negative.z;
    int any_negative = negative.x | negative.y | negative.z;
    return Passing(any_positive & any_negative, all_positive | all_negative);
}

// What is known of a ray and a triangle: nothing it can be hit by (possible false), or that any hit lies in [lo, hi], and
// whether there certainly is one.
struct Candidate {
    bool possible;
    bool certain;
    float lo;
    float hi;
    vec2 weights; // of corners b and c at the hit
};

// Between which depths corners lie, and by how much t may be off besides: the corners' error, and as much for its arithmetic.
struct Depths {
    float lo;
    float hi;
    float error;
};

Depths depths_of(Corner a, Corner b, float error) { return Depths(lesser(a.z, b.z), greater(a.z, b.z), 2.0 * error); }
Depths with_corner(Depths d, Corner c) { return Depths(lesser(d.lo, c.z), greater(d.hi, c.z), d.error); }

Candidate candidate(Corner a, Corner b, Corner c, Edges e, Depths depths) {
    Candidate result;
    float area = e.ab + e.bc + e.ca;
    float inv_area = 1.0 / area;
    float t = (e.bc * a.z + e.ca * b.z + e.ab * c.z) * inv_area;
    result.weights = vec2(e.ca, e.ab) * inv_area;
    if (OVC_CERTIFY == 0) {
        // Closed: a shared edge belongs to both triangles.
        result.certain = (e.ab >= 0.0 && e.bc >= 0.0 && e.ca >= 0.0) || (e.ab <= 0.0 && e.bc <= 0.0 && e.ca <= 0.0);
        result.certain = result.certain && area != 0.0;
        result.possible = result.certain;
        result.lo = t;
        result.hi = t;
        return result;
    }
    Passing passing = passing_of(e);
    result.possible = passing.outside >= 0;
    result.certain = passing.inside < 0;

    // t is an average of the corners' z. The weights' errors move it by at most their share of the spread of z.
    float share = float(OVC_BOUND_SHARE) * (e.ab_error + e.bc_error + e.ca_error) * abs(inv_area);
    float t_error = share * (depths.hi - depths.lo) + depths.error;
    result.lo = result.certain ? t - t_error : depths.lo - depths.error;
    result.hi = result.certain ? t + t_error : depths.hi + depths.error;
    return result;
}
