// SPDX-License-Identifier: Apache-2.0
// A quadric is a profile in steps, swept about the z axis in steps, up to phimax.
// Based on: Pharr, Jakob and Humphreys, "Physically Based Rendering", chapter 3 (parametrisations),
// pbrt-v1 to v3 (cone, paraboloid, hyperboloid).
#include "importers/pbrt/shapes/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <numbers>
#include <utility>

namespace ovc::pbrt {

namespace {

using std::numbers::pi;
constexpr double kMaxQuadricSteps = 256;

/// The points at phi = 0, in the order of pbrt's v, and the normals there.
struct Profile {
    std::vector<dvec3> points;
    std::vector<dvec3> normals;
    std::vector<double> v;  // pbrt's, of each point; empty: in even steps
    bool is_curved = false; // the surface bends both ways

    void add(const dvec3& point, const dvec3& normal) {
        points.push_back(point);
        normals.push_back(normal);
    }
};

/// Says how finely curves are divided.
struct Steps {
    double tolerance; // of the ShapeRequest

    /// Returns the steps round a full circle: a multiple of 4, so that the bounds are exact. A
    /// triangle between steps of angle a lies 1 - cos(a / 2) radii off a cylinder, about twice that
    /// off a sphere.
    double round(bool is_curved) const {
        const double steps = pi / std::sqrt(is_curved ? tolerance : 2 * tolerance);
        return 4 * std::ceil(steps / 4);
    }
    /// Returns a whole number of steps, from 1 to the larger of a circle's and kMaxQuadricSteps; 1
    /// for NaN.
    size_t whole(double steps) const {
        const double max_steps = std::max(kMaxQuadricSteps, round(true));
        return steps > 1 ? size_t(std::ceil(std::min(steps, max_steps))) : 1;
    }
    size_t of(double share_of_circle, bool is_curved) const {
        return whole(share_of_circle * round(is_curved) - 1e-9);
    }
};

/// Turns the point about z, exactly at quarter turns; `turns` lies in [0, 1].
dvec3 turned(const dvec3& p, double turns) {
    assert(turns >= 0 && turns <= 1);
    const double quarter = turns * 4;
    double c = std::cos(2 * pi * turns), s = std::sin(2 * pi * turns);
    if (quarter == std::floor(quarter)) {
        constexpr double kCosines[] = {1, 0, -1, 0};
        c = kCosines[int(quarter) % 4];
        s = kCosines[(int(quarter) + 3) % 4];
    }
    return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

bool on_axis(const dvec3& p) {
    return p.x == 0 && p.y == 0;
}

/// Makes rows of vertices at each step of phi. A row on the axis is one point, yet has a normal for
/// each step; triangles without area at such points are left out. with_uv: the last row is another
/// one than the first, in the same place, because its u is 1.
Mesh sweep(const Profile& profile, double phi_max_degrees, const Steps& fine, bool with_uv) {
    assert(profile.points.size() >= 2 && profile.points.size() == profile.normals.size());
    const double share = std::clamp(phi_max_degrees, 0.0, 360.0) / 360;
    const size_t steps = fine.of(share, profile.is_curved);
    const bool closed = share == 1 && !with_uv;
    const size_t columns = closed ? steps : steps + 1;
    const size_t rows = profile.points.size();
    Mesh mesh;
    for (size_t i = 0; i < columns; ++i)
        for (size_t j = 0; j < rows; ++j) {
            const double turns = share * double(i) / double(steps);
            mesh.add_vertex(turned(profile.points[j], turns));
            mesh.normals.push_back(vec3(turned(profile.normals[j], turns)));
            const double v = profile.v.empty() ? double(j) / double(rows - 1) : profile.v[j];
            if (with_uv)
                mesh.uv.emplace_back(double(i) / double(steps), v);
        }
    for (size_t i = 0; i < steps; ++i)
        for (size_t j = 0; j + 1 < rows; ++j) {
            const size_t next = (i + 1) % columns;
            const auto a = uint32_t(i * rows + j), b = uint32_t(next * rows + j);
            if (!on_axis(profile.points[j]))
                mesh.add_triangle(a, b, on_axis(profile.points[j + 1]) ? a + 1 : b + 1);
            if (!on_axis(profile.points[j + 1]))
                mesh.add_triangle(a, b + 1, a + 1);
        }
    return mesh;
}

double clamped(const Parameters& p, std::string_view name, double otherwise, double radius) {
    return std::clamp(p.number(name, otherwise), -radius, radius);
}

Profile sphere(const Parameters& p, const Steps& fine) {
    const double radius = std::abs(p.number("radius", 1));
    const double z0 = clamped(p, "zmin", -radius, radius), z1 = clamped(p, "zmax", radius, radius);
    if (!(radius > 0) || !(z0 != z1))
        return {};
    const double low = std::asin(std::min(z0, z1) / radius);
    const double high = std::asin(std::max(z0, z1) / radius);
    Profile profile;
    profile.is_curved = true;
    const size_t steps = fine.of((high - low) / (2 * pi), true);
    for (size_t i = 0; i <= steps; ++i) {
        const double latitude = low + (high - low) * double(i) / double(steps);
        const bool is_pole = std::abs(latitude) == pi / 2;
        const bool is_equator = latitude == 0;
        const dvec3 normal(is_pole      ? 0.0
                           : is_equator ? 1.0
                                        : std::cos(latitude),
                           0, is_pole ? (latitude > 0 ? 1.0 : -1.0) : std::sin(latitude));
        profile.add(radius * normal, normal);
    }
    return profile;
}

Profile cylinder(const Parameters& p, const Steps&) {
    const double radius = std::abs(p.number("radius", 1));
    const double z0 = p.number("zmin", -1), z1 = p.number("zmax", 1);
    Profile profile;
    profile.add({radius, 0, std::min(z0, z1)}, {1, 0, 0});
    profile.add({radius, 0, std::max(z0, z1)}, {1, 0, 0});
    return profile;
}

Profile disk(const Parameters& p, const Steps&) {
    const double height = p.number("height", 0);
    Profile profile;
    profile.add({p.number("radius", 1), 0, height}, {0, 0, 1});
    profile.add({p.number("innerradius", 0), 0, height}, {0, 0, 1});
    return profile;
}

Profile cone(const Parameters& p, const Steps&) {
    const double radius = p.number("radius", 1), height = p.number("height", 1);
    const dvec3 normal(height, 0, radius);
    Profile profile;
    profile.add({radius, 0, 0}, normal);
    profile.add({0, 0, height}, normal);
    return profile;
}

/// On a paraboloid, z grows with the square of the distance from the axis.
Profile paraboloid(const Parameters& p, const Steps& fine) {
    const double radius = std::abs(p.number("radius", 1));
    const double z0 = p.number("zmin", 0), z1 = p.number("zmax", 1);
    const double top = std::max(z0, z1), bottom = std::max(std::min(z0, z1), 0.0);
    Profile profile;
    if (!(top > 0) || !(radius > 0))
        return profile;
    profile.is_curved = true;
    const double first = std::sqrt(bottom / top);
    // A chord over a step s of the share of the radius lies top s^2 / 4 off the parabola.
    const double step = 2 * std::sqrt(fine.tolerance * radius / top);
    const size_t steps = fine.whole((1 - first) / step);
    for (size_t i = 0; i <= steps; ++i) {
        const double share = i == steps ? 1 : first + (1 - first) * double(i) / double(steps);
        profile.add({radius * share, 0, top * share * share}, {2 * top * share, 0, -radius});
        profile.v.push_back(top > bottom ? (top * share * share - bottom) / (top - bottom) : 0);
    }
    return profile;
}

/// A hyperboloid is a line turned about the axis.
Profile hyperboloid(const Parameters& p, const Steps& fine) {
    dvec3 p1 = p.point("p1", {0, 0, 0}), p2 = p.point("p2", {1, 1, 1});
    if (p2.z == 0) // as in pbrt, which turns the surface inside out
        std::swap(p1, p2);
    const auto azimuth = [](const dvec3& v) { return std::atan2(v.y, v.x); };
    double twist = on_axis(p1) || on_axis(p2) ? 0 : std::abs(azimuth(p2) - azimuth(p1));
    twist = std::min(twist, 2 * pi - twist);
    Profile profile;
    profile.is_curved = twist > 0;
    const size_t steps = fine.of(twist / (2 * pi), true);
    for (size_t i = 0; i <= steps; ++i) {
        const dvec3 at = glm::mix(p1, p2, double(i) / double(steps));
        const dvec3 round =
            on_axis(at) ? dvec3(-(p1 + p2).y, (p1 + p2).x, 0) : dvec3(-at.y, at.x, 0);
        profile.add(at, glm::cross(round, p2 - p1));
    }
    return profile;
}

struct Quadric {
    std::string_view type;
    Profile (*profile)(const Parameters&, const Steps&);
};

constexpr Quadric kQuadrics[] = {{"sphere", sphere},         {"disk", disk},
                                 {"cylinder", cylinder},     {"cone", cone},
                                 {"paraboloid", paraboloid}, {"hyperboloid", hyperboloid}};

bool is_usable(const Profile& profile) {
    return profile.points.size() >= 2 &&
           std::all_of(profile.points.begin(), profile.points.end(), [](const dvec3& p) {
               return ovc::is_finite(p) && max_component(glm::abs(p)) < 1e30;
           });
}

} // namespace

std::optional<Mesh> make_quadric(ShapeRequest& request) {
    for (const Quadric& quadric : kQuadrics) {
        if (quadric.type != request.type)
            continue;
        const Steps fine{request.tolerance};
        const Profile profile = quadric.profile(request.parameters, fine);
        const double phi = request.parameters.number("phimax", 360);
        if (!is_usable(profile) || !(phi > 0))
            return left_out(request, "its numbers make no surface");
        Mesh mesh = sweep(profile, phi, fine, request.wants_uv);
        mesh.emitters = 1;
        return mesh;
    }
    return std::nullopt;
}

} // namespace ovc::pbrt
