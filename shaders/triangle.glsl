// SPDX-License-Identifier: Apache-2.0
// Tests a ray against triangles in float32, with proof: each candidate is certainly hit, certainly
// missed, or in doubt.
// Based on: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection"; the bound:
// docs/design/numerics.md.

// The axis along which a ray goes farthest becomes z, turned so that the ray goes up; the others
// become x and y.
struct Axes {
    bool along_x;
    bool along_z; // the ray goes along y if neither is set
    uint turned;  // the sign bit, if the ray goes down
};

// dir: its largest component is 1 or -1.
Axes axes_of(vec3 dir) {
    bool along_z = abs(dir.z) == 1.0;
    bool along_x = !along_z && abs(dir.y) != 1.0;
    return Axes(along_x, along_z,
                floatBitsToUint(along_z ? dir.z : (along_x ? dir.x : dir.y)) & 0x80000000u);
}

// Four selections make the three components; a dot product each with zeros and ones took nine
// products. The sign is turned by bits, because some components come from nodes and are subnormal.
vec3 by_axis(Axes axes, vec3 v) {
    float z = axes.along_z ? v.z : (axes.along_x ? v.x : v.y);
    return vec3(axes.along_x ? v.y : v.x, axes.along_z ? v.y : v.z,
                uintBitsToFloat(floatBitsToUint(z) ^ axes.turned));
}

// A ray as the triangle test takes it, by axis: its origin, and x and y of its direction, whose z
// is 1.
struct Line {
    Axes axes;
    vec3 org;
    vec2 shear;
};

Line line_of(vec3 org, vec3 dir) {
    Axes axes = axes_of(dir);
    return Line(axes, by_axis(axes, org), by_axis(axes, dir).xy);
}

// A corner in coordinates in which the line is the z axis.
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

// These stand for min() and max(), which take three instructions on llvmpipe because of NaNs.
float lesser(float a, float b) {
    precise float r = a < b ? a : b;
    return r;
}
float greater(float a, float b) {
    precise float r = a < b ? b : a;
    return r;
}

// Returns the max error of any coordinate of the corners, with a share for the products of an edge
// function. One error for all corners takes fewer instructions than one for each, and leaves one
// ray in fifty more in doubt.
float reach(Corner c) { return c.size + abs(c.z); }
float error_at(float reach) {
    return float(OVC_BOUND_UNIT * OVC_BOUND_CONSTANT) + float(OVC_BOUND_UNIT * OVC_BOUND_RELATIVE) * reach;
}
float error_of(Corner a, Corner b, Corner c) { return error_at(greater(greater(reach(a), reach(b)), reach(c))); }
float error_of(Corner a, Corner b, Corner c, Corner d) {
    return error_at(greater(greater(reach(a), reach(b)), greater(reach(c), reach(d))));
}

// Twice the signed area of (origin, a, b), and its max error.
float edge(Corner a, Corner b) {
    precise float e = a.x * b.y - a.y * b.x;
    return e;
}
// error: that of the corners.
float edge_error(Corner a, Corner b, float error) { return error * ((a.size + error) + (b.size + error)); }

// The edge functions of a triangle (a, b, c), and their max errors.
struct Edges {
    float ab;
    float bc;
    float ca;
    float ab_error;
    float bc_error;
    float ca_error;
};

Edges edges_of(Corner a, Corner b, Corner c, float error) {
    return Edges(edge(a, b), edge(b, c), edge(c, a), edge_error(a, b, error),
                 edge_error(b, c, error), edge_error(c, a, error));
}

// A verdict is the sign of a number, true if it is negative: a difference and bits take fewer
// instructions than comparisons and masks.
int less(float a, float b) { return floatBitsToInt(a - b); }

// Where the ray passes the triangle: `outside` certainly, `inside` certainly, or neither.
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

// The verdict on a ray and a triangle: the ray certainly misses it (possible is false), or any hit
// lies in [lo, hi]. certain: there is a hit.
struct Candidate {
    bool possible;
    bool certain;
    float lo;
    float hi;
    vec2 weights; // of corners b and c at the hit
};

// The depths between which corners lie, and the further error of t: that of the corners, and as
// much for the arithmetic of t.
struct Depths {
    float lo;
    float hi;
    float error;
};

Depths depths_of(Corner a, Corner b, float error) {
    return Depths(lesser(a.z, b.z), greater(a.z, b.z), 2.0 * error);
}
Depths with_corner(Depths d, Corner c) {
    return Depths(lesser(d.lo, c.z), greater(d.hi, c.z), d.error);
}

Candidate candidate(Corner a, Corner b, Corner c, Edges e, Depths depths) {
    Candidate result;
    float area = e.ab + e.bc + e.ca;
    float inv_area = 1.0 / area;
    float t = (e.bc * a.z + e.ca * b.z + e.ab * c.z) * inv_area;
    result.weights = vec2(e.ca, e.ab) * inv_area;
    if (OVC_CERTIFY == 0) {
        // Closed: a shared edge belongs to both triangles.
        result.certain = (e.ab >= 0.0 && e.bc >= 0.0 && e.ca >= 0.0) ||
                         (e.ab <= 0.0 && e.bc <= 0.0 && e.ca <= 0.0);
        result.certain = result.certain && area != 0.0;
        result.possible = result.certain;
        result.lo = t;
        result.hi = t;
        return result;
    }
    Passing passing = passing_of(e);
    result.possible = passing.outside >= 0;
    result.certain = passing.inside < 0;

    // t is an average of the corners' z. The weights' errors move it by at most their share of the
    // spread of z.
    float share = float(OVC_BOUND_SHARE) * (e.ab_error + e.bc_error + e.ca_error) * abs(inv_area);
    float t_error = share * (depths.hi - depths.lo) + depths.error;
    result.lo = result.certain ? t - t_error : depths.lo - depths.error;
    result.hi = result.certain ? t + t_error : depths.hi + depths.error;
    return result;
}
