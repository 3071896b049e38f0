// SPDX-License-Identifier: Apache-2.0
// A model scaled to fit, the sheet under it, the camera's circle.
#include "testscenes/dragons/stage.h"

#include "core/system/parallel.h"
#include "testscenes/dragons/creature.h"
#include "testscenes/noise.h"

#include <algorithm>

namespace ovc::dragons {

namespace {

/// Uniform scale, then a shift.
struct Fit {
    double scale;
    dvec3 shift;
};

Fit fit_of(const Box& bounds, const dvec3& room) {
    const dvec3 size = bounds.extent();
    double scale = INFINITY;
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] > 0)
            scale = std::min(scale, room[axis] / size[axis]);
    const dvec3 middle = bounds.center();
    return {scale, {-scale * middle.x, -scale * bounds.lo.y, -scale * middle.z}};
}

Corners gather(const Soup& soup, const dvec3& room) {
    Box bounds;
    hittable_triangles(soup, nullptr, &bounds);
    const Fit fit = fit_of(bounds, room);
    Corners corners;
    corners.reserve(3 * soup.triangle_count());
    for (const Chunk& chunk : soup.chunks)
        for (const vec3& corner : chunk.corners())
            corners.push_back(vec3(fit.scale * (chunk.origin() + dvec3(corner)) + fit.shift));
    return corners;
}

} // namespace

Surface make_model(const Soup* given, uint64_t triangles, const dvec3& room, bool with_normals) {
    if (given) {
        Surface model{gather(*given, room), {}};
        if (with_normals)
            model.normals = smooth_normals(model.corners);
        return model;
    }
    Surface model = make_creature(triangles, with_normals);
    Box bounds;
    for (const vec3& corner : model.corners)
        bounds.add(dvec3(corner));
    const Fit fit = fit_of(bounds, room);
    for (vec3& corner : model.corners)
        corner = vec3(fit.scale * dvec3(corner) + fit.shift);
    return model;
}

CameraPath circling_path(double reach) {
    constexpr uint32_t kFrames = 100;
    constexpr double kWaves = 3;
    CameraPath path(kFrames);
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
        const double turns = double(frame) / kFrames;
        const dvec2 c = circle(turns + 0.2);
        const double height = 0.85 + 0.55 * circle(kWaves * turns).y;
        path[frame].eye = reach * dvec3(1.9 * c.x, height, 1.9 * c.y);
        path[frame].target = {0, 0.6, 0};
    }
    return path;
}

Surface make_sheet(uint32_t cells_x, uint32_t cells_z, double half, bool with_normals,
                   double (*height)(dvec2 at)) {
    const auto coordinate = [&](size_t i, uint32_t cells) {
        return half * (2 * double(i) / cells - 1);
    };
    const auto point = [&](size_t i, size_t j) {
        const dvec2 at(coordinate(i, cells_x), coordinate(j, cells_z));
        return vec3(dvec3(at.x, height(at), at.y));
    };
    const auto normal = [&](const vec3& p) {
        const double step = 1e-3;
        const double dx = height({p.x + step, p.z}) - height({p.x - step, p.z});
        const double dz = height({p.x, p.z + step}) - height({p.x, p.z - step});
        return vec3(glm::normalize(dvec3(-dx, 2 * step, -dz)));
    };
    Surface sheet;
    sheet.corners.resize(size_t(6) * cells_x * cells_z);
    sheet.normals.resize(with_normals ? sheet.corners.size() : 0);
    parallel_for(cells_z, 8, [&](size_t first, size_t last) {
        for (size_t j = first; j < last; ++j)
            for (size_t i = 0; i < cells_x; ++i) {
                const vec3 a = point(i, j), b = point(i, j + 1);
                const vec3 c = point(i + 1, j + 1), d = point(i + 1, j);
                const vec3 corners[6] = {a, b, c, a, c, d};
                for (size_t k = 0; k < 6; ++k) {
                    const size_t at = 6 * (j * cells_x + i) + k;
                    sheet.corners[at] = corners[k];
                    if (with_normals)
                        sheet.normals[at] = normal(corners[k]);
                }
            }
    });
    return sheet;
}

} // namespace ovc::dragons
