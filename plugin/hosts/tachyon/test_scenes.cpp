// SPDX-License-Identifier: Apache-2.0
// Text of small scenes.
#include "plugin/hosts/tachyon/test_scenes.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace ovc::tachyon {

using Vector = std::array<double, 3>;

static std::string words(const Vector& v) {
    std::array<char, 96> text;
    std::snprintf(text.data(), text.size(), " %.7g %.7g %.7g", v[0], v[1], v[2]);
    return text.data();
}

static std::string triangle(Kind kind, const std::string& texture, const std::array<Vector, 3>& n,
                            const Vector& center, double radius) {
    std::string text = kind == Kind::Flat ? "TRI" : kind == Kind::Smooth ? "STRI" : "VCSTRI";
    for (int i = 0; i < 3; ++i)
        text += " V" + std::to_string(i) +
                words({center[0] + radius * n[size_t(i)][0], center[1] + radius * n[size_t(i)][1],
                       center[2] + radius * n[size_t(i)][2]});
    if (kind != Kind::Flat)
        for (int i = 0; i < 3; ++i)
            text += " N" + std::to_string(i) + words(n[size_t(i)]);
    if (kind == Kind::Colored)
        for (int i = 0; i < 3; ++i)
            text += " C" + std::to_string(i) +
                    words({n[size_t(i)][0] * 0.5 + 0.5, n[size_t(i)][1] * 0.5 + 0.5, 0.5});
    // Behind the texture of a VCSTRI Tachyon reads one more word, whatever it is.
    const std::string look = "\nAMBIENT 0.1 DIFFUSE 0.8 SPECULAR 0.1 OPACITY 1 COLOR";
    return text + (kind == Kind::Colored ? look : " " + texture) + "\n";
}

std::string ball(Kind kind, const std::string& texture, double x, double y, double z,
                 double radius) {
    constexpr int kAround = 16, kDown = 8;
    const auto normal = [](int i, int j) {
        const double a = 2 * std::numbers::pi * i / kAround, b = std::numbers::pi * j / kDown;
        return Vector{std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a)};
    };
    std::string text;
    for (int j = 0; j < kDown; ++j)
        for (int i = 0; i < kAround; ++i) {
            const Vector a = normal(i, j), b = normal(i + 1, j), c = normal(i, j + 1),
                         d = normal(i + 1, j + 1);
            if (j > 0)
                text += triangle(kind, texture, {a, b, c}, {x, y, z}, radius);
            if (j + 1 < kDown)
                text += triangle(kind, texture, {b, d, c}, {x, y, z}, radius);
        }
    return text;
}

std::string scene(const std::string& parts, const std::string& settings,
                  const std::string& projection, int antialiasing) {
    return "BEGIN_SCENE\nRESOLUTION 64 64\n" + settings + "\nCAMERA " + projection +
           " ASPECTRATIO 1 ANTIALIASING " + std::to_string(antialiasing) +
           R"( RAYDEPTH 6 CENTER 0.3 1.1 -4 VIEWDIR -0.07 -0.25 1 UPDIR 0 1 0 END_CAMERA
BACKGROUND 0.4 0.5 0.7
LIGHT CENTER -4 6 -5 RAD 0.1 COLOR 0.9 0.9 0.8
DIRECTIONAL_LIGHT DIRECTION 0.4 -1 0.3 COLOR 0.4 0.4 0.5
TEXDEF plain AMBIENT 0.1 DIFFUSE 0.8 SPECULAR 0 OPACITY 1 PHONG PLASTIC 0.5 PHONG_SIZE 40 COLOR 0.9 0.7 0.5 TEXFUNC 0
TEXDEF glass AMBIENT 0.1 DIFFUSE 0.4 SPECULAR 0.2 OPACITY 0.4 COLOR 0.5 0.9 0.8 TEXFUNC 0
TEXDEF mirror AMBIENT 0 DIFFUSE 0.1 SPECULAR 0.8 OPACITY 1 COLOR 1 1 1 TEXFUNC 0
TEXDEF checker AMBIENT 0.1 DIFFUSE 0.8 SPECULAR 0 OPACITY 1 COLOR 1 0.9 0.8 TEXFUNC 1 CENTER 0 0 0 ROTATE 0 0 0 SCALE 0.3 0.3 0.3
PLANE CENTER 0 -1 0 NORMAL 0 1 0 checker
SPHERE CENTER -1.4 -0.6 0.4 RAD 0.4 mirror
)" + parts +
           "END_SCENE\n";
}

} // namespace ovc::tachyon
