// SPDX-License-Identifier: Apache-2.0
// What the plant is built of: bars, turned bodies, bent tubes; flanges, valves and rails made of
// them. Metres; y is up.
#pragma once

#include "testscenes/corners.h"

#include <array>
#include <cstdint>
#include <span>

namespace ovc::powerplant {

inline constexpr dvec3 kUp{0, 1, 0};

/// Each is a material and a mesh.
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

/// Triangles by paint.
struct Works {
    std::array<Corners, kPaints> of;

    Corners& operator[](Paint paint) { return of[size_t(paint)]; }
};

/// The six sides of a box along the axes.
void add_box(Corners& out, dvec3 lo, dvec3 hi);

/// A box from a to b, `width` to each side of the line and `height` above and below it.
void add_bar(Corners& out, dvec3 a, dvec3 b, double width, double height);

/// A body turned round the axis from `base`: profile points are (radius, way along the axis). axis:
/// unit length.
void add_turned(Corners& out, dvec3 base, dvec3 axis, std::span<const dvec2> profile,
                uint32_t segments);

/// A round bar from a to b, closed at both ends.
void add_rod(Corners& out, dvec3 a, dvec3 b, double radius, uint32_t segments);

/// A tube of `radius` along a line of points; round: its end is its beginning, otherwise both ends
/// are closed.
void add_sweep(Corners& out, std::span<const dvec3> line, double radius, uint32_t segments,
               bool round = false);

/// The line through `points` with bends of `radius` at its corners.
std::vector<dvec3> bent_line(std::span<const dvec3> points, double radius);

/// Two bolted discs round a pipe of `radius`. axis: unit length.
void add_flange(Works& works, Paint paint, dvec3 at, dvec3 axis, double radius);

/// A valve in a pipe of `radius` along `axis`, with flanges, and a hand wheel towards `up`.
void add_valve(Works& works, Paint paint, dvec3 at, dvec3 axis, dvec3 up, double radius);

/// A pipe through `points` with a flange to both sides of each bend and every six metres; valve:
/// one of them is a valve, where a straight piece is long enough.
void add_pipe(Works& works, Paint paint, std::span<const dvec3> points, double radius, bool valve);

/// A hand rail along a line: posts, two rails, a kick plate.
void add_railing(Works& works, dvec3 from, dvec3 to);

} // namespace ovc::powerplant
