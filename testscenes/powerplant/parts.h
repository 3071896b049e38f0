// SPDX-License-Identifier: Apache-2.0
// The parts of the plant: bars, turned bodies and bent tubes, and flanges, valves and rails made of
// them. Units are metres, and y is up.
#pragma once

#include "testscenes/corners.h"

#include <array>
#include <cstdint>
#include <span>

namespace ovc::powerplant {

inline constexpr dvec3 kUp{0, 1, 0};

/// Each paint is a material and a mesh.
enum class Paint : uint8_t {
    Concrete,
    Steel,
    Grating,
    Rail,
    Sheet,
    Lagging,
    Water,
    Fire,
    Gas,
    Oil,
    Machine,
    Cable,
    Brass,
    Window,
    Coal
};
inline constexpr size_t kPaints = 15;

/// The triangles of each paint.
struct Works {
    std::array<Corners, kPaints> of;

    Corners& operator[](Paint paint) { return of[size_t(paint)]; }
};

/// Adds the six sides of a box along the axes.
void add_box(Corners& out, dvec3 lo, dvec3 hi);

/// Adds a box from a to b, `width` to each side of the line and `height` above and below it.
void add_bar(Corners& out, dvec3 a, dvec3 b, double width, double height);

/// Adds a body turned around the axis from `base`. Profile points are (radius, way along the axis).
/// axis: unit length.
void add_turned(Corners& out, dvec3 base, dvec3 axis, std::span<const dvec2> profile,
                uint32_t segments);

/// Adds a round bar from a to b, closed at both ends.
void add_rod(Corners& out, dvec3 a, dvec3 b, double radius, uint32_t segments);

/// Adds a tube of `radius` along a line of points. round: its end is its beginning; otherwise both
/// ends are closed.
void add_sweep(Corners& out, std::span<const dvec3> line, double radius, uint32_t segments,
               bool round = false);

/// Returns the line through `points` with bends of `radius` at its corners.
std::vector<dvec3> bent_line(std::span<const dvec3> points, double radius);

/// Adds two bolted discs around a pipe of `radius`. axis: unit length.
void add_flange(Works& works, Paint paint, dvec3 at, dvec3 axis, double radius);

/// Adds a valve in a pipe of `radius` along `axis`, with flanges, and with a hand wheel towards
/// `up`.
void add_valve(Works& works, Paint paint, dvec3 at, dvec3 axis, dvec3 up, double radius);

/// Adds a pipe through `points` with flanges at both sides of each bend and every six metres.
/// valve: a valve replaces one of them, if a straight piece is long enough.
void add_pipe(Works& works, Paint paint, std::span<const dvec3> points, double radius, bool valve);

/// Adds a hand rail along a line: posts, two rails and a kick plate.
void add_railing(Works& works, dvec3 from, dvec3 to);

} // namespace ovc::powerplant
