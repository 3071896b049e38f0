// SPDX-License-Identifier: Apache-2.0
// Computes signed distances, which are exact for these shapes, and steps along rays by them. Based
// on: Hart, "Sphere Tracing", The Visual Computer 12 (1996).
#include "host/bench/pictures/exact_shapes.h"

#include "core/system/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace ovc {

namespace {

std::string list(const dvec3& v) {
    return fmt::format("<{},{},{}>", v.x, v.y, v.z);
}

/// Returns the distance from p to the segment from a to b, which differ.
double to_segment(const dvec2& p, const dvec2& a, const dvec2& b) {
    const dvec2 along = b - a;
    const double share = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::length(p - (a + share * along));
}

} // namespace

ExactShape exact_sphere(const dvec3& center, double radius) {
    return {"sphere", fmt::format("sphere {{ {}, {}", list(center), radius), radius,
            [=](const dvec3& p) { return glm::length(p - center) - radius; }};
}

ExactShape exact_cone(const dvec3& base, double base_radius, double height, double top_radius) {
    assert(base_radius > 0 && height > 0);
    const auto distance = [=](const dvec3& p) {
        // In the half-plane through the axis and p the cone is a trapezoid.
        const dvec2 at(std::hypot(p.x - base.x, p.z - base.z), p.y - base.y);
        const dvec2 low(base_radius, 0), high(top_radius, height);
        const double to_surface =
            std::min({to_segment(at, low, high), to_segment(at, dvec2(0), low),
                      top_radius > 0 ? to_segment(at, dvec2(0, height), high) : INFINITY});
        const double width = base_radius + (top_radius - base_radius) * at.y / height;
        const bool inside = at.y > 0 && at.y < height && at.x < width;
        return inside ? -to_surface : to_surface;
    };
    return {"cone",
            fmt::format("cone {{ {}, {}, {}, {}", list(base), base_radius,
                        list(base + dvec3(0, height, 0)), top_radius),
            std::max(base_radius, top_radius), distance};
}

ExactShape exact_torus(const dvec3& center, double major, double minor) {
    const auto distance = [=](const dvec3& p) {
        const double from_circle = std::hypot(p.x - center.x, p.z - center.z) - major;
        return std::hypot(from_circle, p.y - center.y) - minor;
    };
    return {"torus", fmt::format("torus {{ {}, {} translate {}", major, minor, list(center)),
            major + minor, distance};
}

std::vector<ExactShape> example_shapes() {
    return {exact_sphere({-2.3, 0, 0}, 1), exact_cone({0, -1, 0}, 1, 2.2, 0.3),
            exact_torus({2.4, -0.2, 0}, 0.85, 0.35)};
}

std::string povray_scene(std::span<const ExactShape> shapes) {
    std::string text = "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n"
                       "camera { location <0, 3, 10> right -x*image_width/image_height "
                       "look_at <0, 0, 0> angle 38 }\n"
                       "light_source { <-12, 4, 4> rgb 1 }\nbackground { rgb 0.5 }\n";
    for (const ExactShape& shape : shapes)
        text += shape.words + " pigment { rgb 0.8 } finish { ambient 0.1 diffuse 0.9 } }\n";
    return text;
}

double first_hit(std::span<const ExactShape> shapes, const Ray& ray, double far) {
    constexpr double met = 1e-12;
    const double length = glm::length(ray.dir);
    for (double t = 0; t <= far;) {
        double step = std::numeric_limits<double>::infinity();
        for (const ExactShape& shape : shapes)
            step = std::min(step, shape.distance(ray.org + t * ray.dir));
        if (step <= met)
            return t;
        t += step / length;
    }
    return std::numeric_limits<double>::infinity();
}

std::vector<double> first_hits(std::span<const ExactShape> shapes, std::span<const Ray> rays,
                               double far) {
    std::vector<double> hits(rays.size());
    parallel_for(rays.size(), 256, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            hits[i] = first_hit(shapes, rays[i], far);
    });
    return hits;
}

} // namespace ovc
