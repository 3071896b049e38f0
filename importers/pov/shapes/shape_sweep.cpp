// SPDX-License-Identifier: Apache-2.0
// Reads shapes of a curve that is swept along y (prism) or around it (lathe, sor, ovus).
#include "importers/pov/shapes/contour.h"
#include "importers/pov/shapes/shape.h"
#include "importers/pov/shapes/simple_contours.h"
#include "importers/pov/shapes/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace ovc::pov {

namespace {

std::optional<Curve> take_curve(Reader& reader) {
    if (reader.take("linear_spline"))
        return Curve::Linear;
    if (reader.take("quadratic_spline"))
        return Curve::Quadratic;
    if (reader.take("cubic_spline"))
        return Curve::Cubic;
    if (reader.take("bezier_spline"))
        return Curve::Bezier;
    return std::nullopt;
}

std::vector<dvec2> parse_points(Reader& reader, int count) {
    std::vector<dvec2> points;
    for (int i = 0; i < count; ++i) {
        reader.take_comma();
        points.push_back(parse_vector2(reader));
    }
    return points;
}

/// Returns how many straight pieces stand for one piece of a curve.
int steps_of(Curve curve, int segments) {
    return curve == Curve::Linear ? 1 : std::max(4, segments / 8);
}

bool same(const dvec2& a, const dvec2& b) {
    return glm::length(a - b) < 1e-9;
}

/// Returns the closed curves of a prism as straight pieces.
std::vector<Contour> prism_contours(Curve curve, const std::vector<dvec2>& points, int segments) {
    std::vector<Contour> contours;
    const size_t stride = curve == Curve::Bezier ? 4 : 1;
    const size_t lead = curve == Curve::Quadratic || curve == Curve::Cubic ? 1 : 0;
    const size_t trail = curve == Curve::Cubic ? 1 : 0;
    const int steps = steps_of(curve, segments);
    for (size_t start = 0; start + points_of_a_piece(curve) <= points.size();) {
        Contour contour;
        const dvec2 first = points[start + lead];
        size_t piece = start;
        bool closed = false;
        for (; !closed && piece + points_of_a_piece(curve) <= points.size(); piece += stride) {
            for (int i = 0; i < steps; ++i)
                contour.push_back(curve_point(curve, &points[piece], double(i) / steps, nullptr));
            closed = same(curve_point(curve, &points[piece], 1, nullptr), first);
        }
        if (!closed && curve == Curve::Linear) // a last side leads back, as povray says
            contour.push_back(points.back());
        if (contour.size() >= 3)
            contours.push_back(std::move(contour));
        start = piece + (curve == Curve::Bezier ? 0 : lead + trail + 1);
    }
    return contours;
}

/// A point of a profile that is turned around y.
struct ProfilePoint {
    dvec2 at;        // radius, height
    dvec2 direction; // of the profile, of any length
};

/// ends: null, or the second texture coordinates of the profile's ends. The first goes around y.
void revolve(const std::vector<ProfilePoint>& profile, int segments, const dvec2* ends,
             Facets& out) {
    const auto corner = [&](const ProfilePoint& p, int step) -> Corner {
        const dvec2 c = on_circle(step, segments);
        const dvec3 outward(c.x, 0, -c.y);
        return {out.circle_radius * p.at.x * outward + dvec3(0, p.at.y, 0),
                p.direction.y * outward - dvec3(0, p.direction.x, 0)};
    };
    for (size_t i = 0; i + 1 < profile.size(); ++i)
        for (int step = 0; step < segments; ++step) {
            const std::array<Corner, 4> quad = {
                corner(profile[i], step), corner(profile[i], step + 1),
                corner(profile[i + 1], step + 1), corner(profile[i + 1], step)};
            if (!ends) {
                out.add_quad(quad[0], quad[1], quad[2], quad[3]);
                continue;
            }
            const auto at = [&](int s, size_t p) {
                return dvec2(1 - double(s) / segments,
                             glm::mix(ends->x, ends->y, double(p) / double(profile.size() - 1)));
            };
            out.add_quad(quad,
                         {at(step, i), at(step + 1, i), at(step + 1, i + 1), at(step, i + 1)});
        }
}

/// The pieces of a lathe's profile. Its surface faces outside, so they run upwards on the whole.
struct Profiles {
    std::vector<std::vector<ProfilePoint>> pieces;
    double min_radius = std::numeric_limits<double>::infinity();
    bool are_turned = false; // they run the other way than in the file

    /// Returns the volume inside, by a third of pi; negative where the surface faces inside.
    double volume() const {
        double sum = 0;
        for (const std::vector<ProfilePoint>& piece : pieces) {
            for (size_t i = 0; i + 1 < piece.size(); ++i) {
                const dvec2 &p = piece[i].at, &q = piece[i + 1].at;
                sum += (p.x * p.x + p.x * q.x + q.x * q.x) * (q.y - p.y);
            }
            sum += 3 * min_radius * min_radius * (piece.front().at.y - piece.back().at.y);
        }
        return sum;
    }

    void turn() {
        are_turned = !are_turned;
        for (std::vector<ProfilePoint>& piece : pieces) {
            std::ranges::reverse(piece);
            for (ProfilePoint& p : piece)
                p.direction = -p.direction;
        }
    }
};

Profiles lathe_profiles(Curve curve, const std::vector<dvec2>& points, int steps) {
    const size_t stride = curve == Curve::Bezier ? 4 : 1;
    Profiles profiles;
    for (size_t piece = 0; piece + points_of_a_piece(curve) <= points.size(); piece += stride) {
        std::vector<ProfilePoint>& profile = profiles.pieces.emplace_back();
        for (int i = 0; i <= steps; ++i) {
            ProfilePoint p;
            p.at = curve_point(curve, &points[piece], double(i) / steps, &p.direction);
            profiles.min_radius = std::min(profiles.min_radius, p.at.x);
            profile.push_back(p);
        }
    }
    if (profiles.volume() < 0)
        profiles.turn();
    return profiles;
}

/// Leads each end of a lathe's profile that no other piece goes on from back to a loose beginning,
/// along the profile's least radius: povray's inside lies between the two, as its inside() tells.
void close_lathe(const Profiles& profiles, int segments, Facets& out) {
    std::vector<dvec2> begins, ends;
    for (const std::vector<ProfilePoint>& profile : profiles.pieces)
        begins.push_back(profile.front().at);
    for (const std::vector<ProfilePoint>& profile : profiles.pieces) {
        const dvec2& end = profile.back().at;
        const auto next = std::find_if(begins.begin(), begins.end(),
                                       [&](const dvec2& begin) { return same(begin, end); });
        if (next != begins.end())
            begins.erase(next);
        else
            ends.push_back(end);
    }
    assert(begins.size() == ends.size());
    for (size_t i = 0; i < ends.size(); ++i)
        revolve({{ends[i], {}},
                 {{profiles.min_radius, ends[i].y}, {}},
                 {{profiles.min_radius, begins[i].y}, {}},
                 {begins[i], {}}},
                segments, nullptr, out);
}

} // namespace

Shape parse_prism(Reader& reader) {
    bool conic = false;
    Curve curve = Curve::Linear;
    for (;;) {
        if (reader.take("conic_sweep"))
            conic = true;
        else if (const std::optional<Curve> c = take_curve(reader))
            curve = *c;
        else if (!reader.take("linear_sweep"))
            break;
    }
    double low = parse_float(reader);
    reader.take_comma();
    double high = parse_float(reader);
    reader.take_comma();
    const std::vector<dvec2> points = parse_points(reader, parse_count(reader, 3));
    if (low > high)
        std::swap(low, high);
    Shape shape;
    shape.fixed = 4 * double(points.size());
    shape.per_segment = curve == Curve::Linear ? 0 : double(points.size()) / 2;
    shape.cut = [=](int segments, bool open, Facets& out) {
        const auto place = [&](const dvec2& p, bool end) {
            const double y = end ? high : low;
            const double scale = conic ? y : 1;
            return dvec3(p.x * scale, y, p.y * scale);
        };
        sweep(simple_contours(prism_contours(curve, points, segments)), /* lids= */ !open, place,
              out);
    };
    return shape;
}

Shape parse_lathe(Reader& reader) {
    const Curve curve = take_curve(reader).value_or(Curve::Linear);
    reader.take_comma();
    const std::vector<dvec2> points = parse_points(reader, parse_count(reader, 2));
    Shape shape;
    shape.corners_have_uv = true;
    shape.per_segment = curve == Curve::Linear ? 2 * double(points.size()) : 0;
    shape.per_square = curve == Curve::Linear ? 0 : double(points.size()) / 4;
    const auto profiles = [=](int segments) {
        return lathe_profiles(curve, points, steps_of(curve, segments));
    };
    shape.cut = [profiles](int segments, bool, Facets& out) {
        const Profiles all = profiles(segments);
        for (size_t i = 0; i < all.pieces.size(); ++i) {
            const dvec2 ends =
                (all.are_turned ? dvec2(i + 1, i) : dvec2(i, i + 1)) / double(all.pieces.size());
            revolve(all.pieces[i], segments, &ends, out);
        }
    };
    shape.close = [profiles](int segments, Facets& out) {
        close_lathe(profiles(segments), segments, out);
    };
    return shape;
}

Shape parse_sor(Reader& reader) {
    const std::vector<dvec2> points = parse_points(reader, parse_count(reader, 4));
    for (size_t i = 0; i + 1 < points.size(); ++i)
        if (!(points[i + 1].y - points[i].y > 0) && i > 0 && i + 2 < points.size())
            reader.fail(reader.place(), "found a sor whose heights do not rise");
    Shape shape;
    shape.per_square = double(points.size()) / 4;
    shape.per_segment = 2;
    const double low = points[1].y, high = points[points.size() - 2].y;
    TextureStep by_height;
    by_height.rows[1] = dvec4(0, 1, 0, -low) / std::max(high - low, 1e-300);
    shape.to_uv = {by_height, wrapped_around_y(TextureStep::Kind::Cylindrical)};
    shape.cut = [points](int segments, bool open, Facets& out) {
        std::vector<ProfilePoint> profile;
        const int steps = steps_of(Curve::Cubic, segments);
        for (size_t i = 0; i + 3 < points.size(); ++i) {
            // The square of the radius is a cubic polynomial of the height.
            const dvec2 *p = &points[i], &a = p[1], &b = p[2];
            const double h = b.y - a.y;
            const double m0 = 2 * a.x * (b.x - p[0].x) / (b.y - p[0].y) * h;
            const double m1 = 2 * b.x * (p[3].x - a.x) / (p[3].y - a.y) * h;
            const double r0 = a.x * a.x, r1 = b.x * b.x;
            for (int s = i == 0 ? 0 : 1; s <= steps; ++s) {
                const double t = double(s) / steps;
                const double c2 = 3 * (r1 - r0) - 2 * m0 - m1, c3 = 2 * (r0 - r1) + m0 + m1;
                const double square = std::max(0.0, r0 + t * (m0 + t * (c2 + t * c3)));
                const double slope = (m0 + t * (2 * c2 + t * 3 * c3)) / h;
                profile.push_back(
                    {{std::sqrt(square), a.y + t * h}, {slope / 2, std::sqrt(square)}});
            }
        }
        assert(!profile.empty());
        revolve(profile, segments, nullptr, out);
        for (int step = 1; !open && step + 1 < segments; ++step)
            for (const bool top : {false, true}) {
                const dvec2 at = (top ? profile.back() : profile.front()).at;
                const auto corner = [&](int s) {
                    const dvec2 c = out.circle_radius * on_circle(s, segments);
                    return dvec3(at.x * c.x, at.y, -at.x * c.y);
                };
                out.add(corner(0), corner(top ? step : step + 1), corner(top ? step + 1 : step));
            }
    };
    return shape;
}

/// Adds the points of a circle's arc, whose angles count from the profile's outside towards its
/// top.
static void add_arc(const dvec2& center, double radius, double from, double to, int segments,
                    std::vector<ProfilePoint>& profile) {
    const int steps =
        std::max(2, int(std::lround((to - from) / (2 * std::numbers::pi) * segments)));
    for (int i = 0; i <= steps; ++i) {
        const double angle = glm::mix(from, to, double(i) / steps);
        const dvec2 out(std::cos(angle), std::sin(angle));
        profile.push_back({center + radius * out, {-out.y, out.x}});
    }
}

/// Reads `{ BOTTOM, TOP`: balls around 0 and around BOTTOM y, joined by the arc that touches both
/// and is twice as large as the larger one. As measured of povray 3.7.0.10.
Shape parse_ovus(Reader& reader) {
    const Place at = reader.peek().place;
    const double bottom = parse_float(reader);
    reader.take_comma();
    const double top = parse_float(reader);
    if (!(bottom >= 0 && top >= 0 && bottom + top > 0))
        reader.fail(at, fmt::format("found an ovus of the radii {} and {}, expected some above 0",
                                    bottom, top));
    const bool is_ball = top >= 2 * bottom;
    if (is_ball)
        reader.warn("ovus", at, "an ovus whose second radius is twice its first is a sphere");
    const double radius = 2 * std::max(bottom, top);
    const double to_bottom = radius - bottom, to_top = radius - top; // from the arc's center
    const double y =
        is_ball ? 0 : (bottom + (to_bottom * to_bottom - to_top * to_top) / bottom) / 2;
    const dvec2 center(-std::sqrt(std::max(0.0, to_bottom * to_bottom - y * y)), y);
    const double low = std::atan2(-center.y, -center.x);
    const double high = std::atan2(bottom - center.y, -center.x);
    Shape shape;
    shape.per_square = 1;
    shape.per_segment = 8;
    shape.cut = [=](int segments, bool, Facets& out) {
        const double quarter = std::numbers::pi / 2;
        const dvec2 peak(0, bottom);
        std::vector<ProfilePoint> profile;
        if (is_ball)
            add_arc(peak, top, -quarter, quarter, segments, profile);
        else {
            add_arc({0, 0}, bottom, -quarter, low, segments, profile);
            add_arc(center, radius, low, high, segments, profile);
            add_arc(peak, top, high, quarter, segments, profile);
        }
        profile.front().at.x = profile.back().at.x = 0;
        revolve(profile, segments, nullptr, out);
    };
    return shape;
}

} // namespace ovc::pov
