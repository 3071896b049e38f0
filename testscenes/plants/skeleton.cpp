// SPDX-License-Identifier: Apache-2.0
// The wood of a tree: growth, and tubes around it.
#include "testscenes/plants/skeleton.h"

#include "testscenes/noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ovc::plants {

namespace {

/// The crown's radius at a height, as a share of its largest: two half ellipses that meet where it
/// is widest.
double profile(const Crown& crown, double height) {
    const double s = (height - crown.bottom) / (crown.top - crown.bottom);
    const double from_widest = s < crown.widest ? (crown.widest - s) / crown.widest
                                                : (s - crown.widest) / (1 - crown.widest);
    return std::sqrt(std::max(0.0, 1 - from_widest * from_widest));
}

struct Attractor {
    dvec3 at;
    uint32_t nearest = 0;
    double distance = std::numeric_limits<double>::infinity();
};

std::vector<Attractor> scatter(const Crown& crown, Random& random) {
    std::vector<Attractor> attractors;
    while (attractors.size() < crown.twigs) {
        const double x = random.uniform(-1, 1), z = random.uniform(-1, 1);
        const double y = random.uniform(crown.bottom, crown.top);
        const double limit = profile(crown, y);
        const double out = std::sqrt(x * x + z * z);
        if (out <= limit && (out >= limit * crown.hollow || random.chance(0.15)))
            attractors.push_back({{x * crown.radius, y, z * crown.radius}});
    }
    return attractors;
}

std::vector<Knot> trunk(const Crown& crown, double step, Random& random) {
    std::vector<Knot> knots = {{dvec3(0), dvec3(0, 1, 0), 0}};
    const double top = crown.bottom + 0.35 * (crown.top - crown.bottom);
    dvec3 along(0, 1, 0);
    while (knots.back().at.y < top) {
        along = glm::normalize(along + 0.16 * random.in_ball() + dvec3(0, 0.12, 0));
        const uint32_t parent = uint32_t(knots.size() - 1);
        knots.push_back({knots[parent].at + step * along, along, parent});
    }
    return knots;
}

void find_nearest(std::vector<Attractor>& attractors, const std::vector<Knot>& knots, size_t from) {
    for (Attractor& attractor : attractors)
        for (size_t k = from; k < knots.size(); ++k) {
            const double distance = glm::length(knots[k].at - attractor.at);
            if (distance < attractor.distance) {
                attractor.distance = distance;
                attractor.nearest = uint32_t(k);
            }
        }
}

/// Leonardo's rule: a branch has the cross section of its children together.
void thicken(std::vector<Knot>& knots, double tip_radius) {
    std::vector<double> section(knots.size(), 0);
    for (size_t k = knots.size(); k-- > 0;) {
        if (section[k] == 0)
            section[k] = tip_radius * tip_radius;
        else
            knots[k].is_tip = false;
        knots[k].radius = std::sqrt(section[k]);
        if (k > 0)
            section[knots[k].parent] += section[k];
    }
}

} // namespace

std::vector<Knot> grow(const Crown& crown, double tip_radius, Random& random) {
    const double step = 0.07 * (crown.top - crown.bottom);
    std::vector<Attractor> attractors = scatter(crown, random);
    std::vector<Knot> knots = trunk(crown, step, random);
    size_t known = 0;
    for (int round = 0; round < 60 && !attractors.empty(); ++round) {
        find_nearest(attractors, knots, known);
        std::erase_if(attractors, [&](const Attractor& a) { return a.distance < 1.6 * step; });
        known = knots.size();
        std::vector<dvec3> pull(known, dvec3(0));
        for (const Attractor& a : attractors)
            pull[a.nearest] += glm::normalize(a.at - knots[a.nearest].at);
        for (uint32_t k = 0; k < known; ++k) {
            if (pull[k] == dvec3(0))
                continue;
            const dvec3 wander = 0.25 * random.in_ball() + dvec3(0, 0.1, 0);
            const dvec3 along = glm::normalize(glm::normalize(pull[k] + dvec3(0, 1e-3, 0)) +
                                               0.4 * knots[k].along + wander);
            knots.push_back({knots[k].at + step * along, along, k});
        }
        if (knots.size() > 6000)
            break;
    }
    thicken(knots, tip_radius);
    return knots;
}

void add_wood(Corners& out, const std::vector<Knot>& knots, double thinnest, double detail) {
    std::vector<dvec3> sideways(knots.size());
    sideways[0] = dvec3(1, 0, 0);
    for (size_t k = 1; k < knots.size(); ++k) {
        const Knot& knot = knots[k];
        const Knot& parent = knots[knot.parent];
        // The parent's frame, carried over: tubes do not twist.
        const dvec3 carried = sideways[knot.parent];
        const dvec3 flat = carried - knot.along * glm::dot(carried, knot.along);
        sideways[k] =
            glm::dot(flat, flat) > 1e-6 ? glm::normalize(flat) : any_perpendicular(knot.along);
        if (knot.radius < thinnest)
            continue;
        const uint32_t sides = detail < 0.3 || knot.radius < 0.03 ? 3 : knot.radius < 0.09 ? 5 : 8;
        const bool main_branch = knot.radius > 0.8 * parent.radius;
        const double root_flare = knot.parent == 0 ? 1.5 : 1;
        const double from_radius = (main_branch ? parent.radius : 1.15 * knot.radius) * root_flare;
        const double to_radius = knot.is_tip ? 0.4 * knot.radius : knot.radius;
        const dvec3 from_side = main_branch ? carried : sideways[k];
        const dvec3 from_up = glm::cross(main_branch ? parent.along : knot.along, from_side);
        const dvec3 to_up = glm::cross(knot.along, sideways[k]);
        for (uint32_t side = 0; side < sides; ++side) {
            const dvec2 a = circle(double(side) / sides), b = circle(double(side + 1) / sides);
            const auto from = [&](dvec2 c) {
                return parent.at + from_radius * (c.x * from_side + c.y * from_up);
            };
            const auto to = [&](dvec2 c) {
                return knot.at + to_radius * (c.x * sideways[k] + c.y * to_up);
            };
            add_quad(out, from(a), from(b), to(b), to(a));
        }
    }
}

} // namespace ovc::plants
