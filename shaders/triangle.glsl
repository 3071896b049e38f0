// SPDX-License-Identifier: Apache-2.0
// A ray against triangles in float32, with proof: each candidate is certainly hit, certainly missed, or in doubt.
// Based on: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection"; the bound: docs/numerics.md.

// Maps the ray onto the z axis: the axis along which it goes farthest becomes z, and is sheared.
struct Basis {
    bool along_x;
    bool along_z; // along y where neither
    vec3 shear;   // of the other two axes, by the distance along this one; z: the direction along it, 1 or -1
};

// One of three by the axis that the ray goes along. At most two are asked for that are the same, so that this is four
// selections for three components; a dot product each with zeros and ones was nine products.
vec3 by_axis(Basis basis, vec3 v) {
    return vec3(basis.along_x ? v.y : v.x, basis.along_z ? v.y : v.z, basis.along_z ? v.z : (basis.along_x ? v.x : v.y));
}

// The direction's largest component is 1 or -1, so the shear is exact.
Basis basis_of(vec3 dir) {
    Basis basis;
    basis.along_z = abs(dir.z) == 1.0;
    basis.along_x = !basis.along_z && abs(dir.y) != 1.0;
    vec3 d = by_axis(basis, dir);
    basis.shear = vec3(d.xy * d.z, d.z);
    return basis;
}

// A corner in the basis; `error` bounds what each coordinate is off by, and a share for the products of an edge function.
struct Corner {
    float x;
    float y;
    float z;
    float error;
    float reach; // |x| + |y| + error
};

Corner corner(vec3 position, vec3 org, Basis basis) {
    precise vec3 p = by_axis(basis, position - org);
    precise float x = p.x - p.z * basis.shear.x;
    precise float y = p.y - p.z * basis.shear.y;
    precise float z = p.z * basis.shear.z;
    float size = abs(x) + abs(y);
    float error = float(OVC_BOUND_UNIT * OVC_BOUND_CONSTANT) +
                  float(OVC_BOUND_UNIT * OVC_BOUND_RELATIVE) * (size + abs(z));
    return Corner(x, y, z, error, size + error);
}

// Twice the signed area of (origin, a, b), and what it is off by at most.
float edge(Corner a, Corner b) {
    precise float e = a.x * b.y - a.y * b.x;
    return e;
}
float edge_error(Corner a, Corner b) { return a.error * b.reach + b.error * a.reach; }

// The edge functions of a triangle (a, b, c), and what they are off by at most.
struct Edges {
    float ab;
    float bc;
    float ca;
    float ab_error;
    float bc_error;
    float ca_error;
};

Edges edges_of(Corner a, Corner b, Corner c) {
    return Edges(edge(a, b), edge(b, c), edge(c, a), edge_error(a, b), edge_error(b, c), edge_error(c, a));
}

// Where the ray passes: `outside` certainly, `inside` certainly, or neither.
struct Passing {
    bool outside;
    bool inside;
};

Passing passing_of(Edges e) {
    bool all_positive = e.ab > e.ab_error && e.bc > e.bc_error && e.ca > e.ca_error;
    bool all_negative = e.ab < -e.ab_error && e.bc < -e.bc_error && e.ca < -e.ca_error;
    bool any_positive = e.ab > e.ab_error || e.bc > e.bc_error || e.ca > e.ca_error;
    bool any_negative = e.ab < -e.ab_error || e.bc < -e.bc_error || e.ca < -e.ca_error;
    return Passing(any_positive && any_negative, all_positive || all_negative);
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

// Instead of min() and max(), which llvmpipe makes of three instructions, because of NaNs.
float lesser(float a, float b) {
    precise float r = a < b ? a : b;
    return r;
}
float greater(float a, float b) {
    precise float r = a < b ? b : a;
    return r;
}

// Between which depths corners lie, and by how much t may be off besides: the corners' errors, and as much for its arithmetic.
struct Depths {
    float lo;
    float hi;
    float error;
};

Depths depths_of(Corner a, Corner b) {
    return Depths(lesser(a.z, b.z), greater(a.z, b.z), 2.0 * greater(a.error, b.error));
}
Depths with_corner(Depths d, Corner c) {
    return Depths(lesser(d.lo, c.z), greater(d.hi, c.z), greater(d.error, 2.0 * c.error));
}

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
    result.possible = !passing.outside;
    result.certain = passing.inside;

    // t is an average of the corners' z. The weights' errors move it by at most their share of the spread of z.
    float share = float(OVC_BOUND_SHARE) * (e.ab_error + e.bc_error + e.ca_error) * abs(inv_area);
    float t_error = share * (depths.hi - depths.lo) + depths.error;
    result.lo = result.certain ? t - t_error : depths.lo - depths.error;
    result.hi = result.certain ? t + t_error : depths.hi + depths.error;
    return result;
}
