// SPDX-License-Identifier: Apache-2.0
// LDR-FLIP compares colors as the eye blurs them, and edges and points, and makes one error of
// both. Section numbers are the paper's.
#include "host/diff/flip.h"

#include "core/system/parallel.h"
#include "core/vec.h"
#include "host/output/srgb.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ovc {
namespace {

using std::numbers::pi;
constexpr double kColorExponent = 0.7;                 // q_c, section 4.1
constexpr double kFeatureExponent = 0.5;               // q_f, section 4.2
constexpr dvec3 kWhite(0.950428545, 1.0, 1.088900371); // D65 in XYZ

using Plane = std::vector<float>;
/// The planes of YCxCz: luminance, red against green, blue against yellow.
using Opponent = std::array<Plane, 3>;

dvec3 xyz_of(const dvec3& rgb) {
    return {(10135552 * rgb.r + 8788810 * rgb.g + 4435075 * rgb.b) / 24577794,
            (2613072 * rgb.r + 8788810 * rgb.g + 887015 * rgb.b) / 12288897,
            (1425312 * rgb.r + 8788810 * rgb.g + 70074185 * rgb.b) / 73733382};
}

/// Inverts xyz_of(), and cuts off light beyond 0 to 1.
dvec3 rgb_of(const dvec3& xyz) {
    const dvec3 rgb(3.241003275 * xyz.x - 1.537398934 * xyz.y - 0.498615861 * xyz.z,
                    -0.969224334 * xyz.x + 1.875930071 * xyz.y + 0.041554224 * xyz.z,
                    0.055639423 * xyz.x - 0.204011202 * xyz.y + 1.057148933 * xyz.z);
    return glm::clamp(rgb, 0.0, 1.0);
}

dvec3 opponent_of(const dvec3& xyz) {
    const dvec3 n = xyz / kWhite;
    return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}

dvec3 xyz_of_opponent(const dvec3& c) {
    const double y = (c.x + 16) / 116;
    return kWhite * dvec3(y + c.y / 500, y, y - c.z / 200);
}

double lab_curve(double t) {
    constexpr double d = 6.0 / 29;
    return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29;
}

/// Returns CIELAB with Hunt's effect: colors are fainter where it is dark (section 4.1.3).
dvec3 hunt_lab_of(const dvec3& rgb) {
    const dvec3 n = xyz_of(rgb) / kWhite;
    const dvec3 f(lab_curve(n.x), lab_curve(n.y), lab_curve(n.z));
    const double lightness = 116 * f.y - 16;
    return {lightness, 0.01 * lightness * 500 * (f.x - f.y), 0.01 * lightness * 200 * (f.y - f.z)};
}

/// Returns the HyAB distance, which suits large color differences.
double color_distance(const dvec3& a, const dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// The weights for offsets from -radius to radius.
using Kernel = std::vector<double>;

template <class Weight>
Kernel make_kernel(int radius, const Weight& weight) {
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x)
        kernel.push_back(weight(double(x)));
    return kernel;
}

double sum_of(const Kernel& kernel) {
    double sum = 0;
    for (const double weight : kernel)
        sum += weight;
    return sum;
}

/// Scales the weights so that positive ones add up to 1, negative ones to -1.
Kernel normalized(Kernel kernel) {
    double positive = 0, negative = 0;
    for (const double weight : kernel)
        (weight > 0 ? positive : negative) += std::abs(weight);
    for (double& weight : kernel)
        if (weight != 0)
            weight /= weight > 0 ? positive : negative;
    return kernel;
}

struct Grid {
    int width = 0;
    int height = 0;
};

/// Filters with `along` in x and `across` in y. Beyond the picture its border continues.
Plane filtered(const Plane& in, const Grid& grid, const Kernel& along, const Kernel& across) {
    Plane rows(in.size()), out(in.size());
    const auto pass = [&](const Plane& from, Plane& to, const Kernel& kernel, int dx, int dy) {
        const int radius = int(kernel.size() / 2);
        parallel_for(size_t(grid.height), 8, [&](size_t first, size_t last) {
            for (int y = int(first); y < int(last); ++y)
                for (int x = 0; x < grid.width; ++x) {
                    double sum = 0;
                    for (int k = -radius; k <= radius; ++k) {
                        const int at_x = std::clamp(x + k * dx, 0, grid.width - 1);
                        const int at_y = std::clamp(y + k * dy, 0, grid.height - 1);
                        sum += kernel[size_t(k + radius)] *
                               double(from[size_t(at_y) * size_t(grid.width) + size_t(at_x)]);
                    }
                    to[size_t(y) * size_t(grid.width) + size_t(x)] = float(sum);
                }
        });
    };
    pass(in, rows, along, 1, 0);
    pass(rows, out, across, 0, 1);
    return out;
}

/// a sqrt(pi / b) exp(-pi^2 z / b), z in degrees squared: one term of a contrast sensitivity
/// (section 4.1.1, table 1).
struct Sensitivity {
    double a, b;
};

/// Blurs one opponent channel as the eye does.
Plane blurred(const Plane& in, const Grid& grid, std::span<const Sensitivity> terms,
              double pixels_per_degree) {
    constexpr double kWidest = 0.04; // the b of the widest term of all channels
    const int radius = int(std::ceil(3 * std::sqrt(kWidest / (2 * pi * pi)) * pixels_per_degree));
    Plane sum(in.size(), 0.0f);
    double all = 0;
    for (const auto& [a, b] : terms) {
        const Kernel kernel = make_kernel(radius, [&](double x) {
            const double degrees = x / pixels_per_degree;
            return std::exp(-pi * pi * degrees * degrees / b);
        });
        const double weight = a * std::sqrt(pi / b) * sum_of(kernel) * sum_of(kernel);
        const Plane one = filtered(in, grid, normalized(kernel), normalized(kernel));
        for (size_t i = 0; i < sum.size(); ++i)
            sum[i] += float(weight) * one[i];
        all += weight;
    }
    for (float& value : sum)
        value /= float(all);
    return sum;
}

Opponent opponent_planes(const SrgbPlanes& picture) {
    const size_t size = size_t(picture.width) * picture.height;
    assert(picture.red.size() == size && picture.green.size() == size &&
           picture.blue.size() == size);
    Opponent planes = {Plane(size), Plane(size), Plane(size)};
    parallel_for(size, 4096, [&](size_t first, size_t last) {
        const auto light = [](float code) {
            return double(srgb_light(code > 0 ? std::min(code, 1.0f) : 0.0f));
        };
        for (size_t i = first; i < last; ++i) {
            const dvec3 c = opponent_of(
                xyz_of({light(picture.red[i]), light(picture.green[i]), light(picture.blue[i])}));
            for (int channel = 0; channel < 3; ++channel)
                planes[size_t(channel)][i] = float(c[channel]);
        }
    });
    return planes;
}

/// Returns the picture's colors as the eye blurs them.
Opponent seen(const Opponent& planes, const Grid& grid, double pixels_per_degree) {
    static constexpr Sensitivity luminance[] = {{1, 0.0047}};
    static constexpr Sensitivity red_green[] = {{1, 0.0053}};
    static constexpr Sensitivity blue_yellow[] = {{34.1, 0.04}, {13.5, 0.025}};
    return {blurred(planes[0], grid, luminance, pixels_per_degree),
            blurred(planes[1], grid, red_green, pixels_per_degree),
            blurred(planes[2], grid, blue_yellow, pixels_per_degree)};
}

/// Maps a distance from 0 to `farthest` to an error from 0 to 1. Small distances get most of the
/// range (section 4.1.4).
double spread(double distance, double farthest) {
    constexpr double near_share = 0.4;  // p_c
    constexpr double near_error = 0.95; // p_t
    const double near = near_share * farthest;
    return distance < near ? near_error / near * distance
                           : near_error + (distance - near) / (farthest - near) * (1 - near_error);
}

Plane color_errors(const Opponent& a, const Opponent& b) {
    const double farthest =
        std::pow(color_distance(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), kColorExponent);
    Plane errors(a[0].size());
    parallel_for(errors.size(), 1024, [&](size_t first, size_t last) {
        const auto lab = [](const Opponent& planes, size_t i) {
            return hunt_lab_of(rgb_of(xyz_of_opponent(
                {double(planes[0][i]), double(planes[1][i]), double(planes[2][i])})));
        };
        for (size_t i = first; i < last; ++i)
            errors[i] = float(
                spread(std::pow(color_distance(lab(a, i), lab(b, i)), kColorExponent), farthest));
    });
    return errors;
}

/// The strength of edges and of points in each pixel (section 4.2).
struct Features {
    Plane edges, points;
};

Features features_of(const Plane& luminance, const Grid& grid, double pixels_per_degree) {
    constexpr double kWidth = 0.082; // of the eye's edge detector, in degrees
    const double sd = 0.5 * kWidth * pixels_per_degree;
    const int radius = int(std::ceil(3 * sd));
    const auto bell = [&](double x) { return std::exp(-x * x / (2 * sd * sd)); };
    const Kernel smooth = normalized(make_kernel(radius, bell));
    const auto strength = [&](const Kernel& kernel) {
        const Plane x = filtered(luminance, grid, kernel, smooth);
        Plane y = filtered(luminance, grid, smooth, kernel);
        for (size_t i = 0; i < x.size(); ++i)
            y[i] = std::hypot(x[i], y[i]);
        return y;
    };
    const auto slope = [&](double x) { return -x * bell(x); };
    const auto bend = [&](double x) { return (x * x / (sd * sd) - 1) * bell(x); };
    return {strength(normalized(make_kernel(radius, slope))),
            strength(normalized(make_kernel(radius, bend)))};
}

Features features_of(const Opponent& planes, const Grid& grid, double pixels_per_degree) {
    Plane luminance = planes[0];
    for (float& y : luminance)
        y = (y + 16) / 116;
    return features_of(luminance, grid, pixels_per_degree);
}

} // namespace

std::vector<float> flip_errors(const SrgbPlanes& a, const SrgbPlanes& b, double pixels_per_degree) {
    assert(a.width == b.width && a.height == b.height);
    const Grid grid{int(a.width), int(a.height)};
    const Opponent planes_a = opponent_planes(a), planes_b = opponent_planes(b);
    const Features features_a = features_of(planes_a, grid, pixels_per_degree);
    const Features features_b = features_of(planes_b, grid, pixels_per_degree);
    Plane errors = color_errors(seen(planes_a, grid, pixels_per_degree),
                                seen(planes_b, grid, pixels_per_degree));
    for (size_t i = 0; i < errors.size(); ++i) {
        const double feature =
            double(std::max(std::abs(features_a.edges[i] - features_b.edges[i]),
                            std::abs(features_a.points[i] - features_b.points[i])));
        const double feature_error = std::pow(feature / std::sqrt(2.0), kFeatureExponent);
        errors[i] = float(std::pow(double(errors[i]), 1 - feature_error)); // section 4.3
    }
    return errors;
}

} // namespace ovc
