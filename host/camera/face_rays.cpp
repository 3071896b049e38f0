// SPDX-License-Identifier: Apache-2.0
// Based on: POV-Ray 3.7's sample scenes of mesh_camera, whose README says which face a pixel has.
#include "host/camera/face_rays.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc {

/// So many cells a side at most, and about so many faces a cell.
static constexpr int kMaxCells = 512;
static constexpr double kFacesACell = 4;

/// Returns the weights of the corners at a point of their plane; none where they lie in a line.
static std::optional<dvec3> weights_at(const std::array<vec2, 3>& corners, const dvec2& at) {
    const dvec2 a(corners[0]), to_b = dvec2(corners[1]) - a, to_c = dvec2(corners[2]) - a;
    const double area = to_b.x * to_c.y - to_b.y * to_c.x;
    if (area == 0)
        return std::nullopt;
    const dvec2 way = at - a;
    const double b = (way.x * to_c.y - way.y * to_c.x) / area;
    const double c = (to_b.x * way.y - to_b.y * way.x) / area;
    return dvec3(1 - b - c, b, c);
}

FaceRays::FaceRays(const FaceCamera& camera, const ImageSize& size) : camera_(camera), size_(size) {
    assert(!camera.meshes.empty());
    if (camera.order == FaceCamera::Order::ByUv)
        sort_by_uv();
}

std::array<int, 2> FaceRays::cell_at(const dvec2& uv) const {
    const dvec2 cell =
        glm::clamp(glm::floor(uv * double(cells_a_side_)), 0.0, double(cells_a_side_ - 1));
    return {int(cell.x), int(cell.y)};
}

void FaceRays::sort_by_uv() {
    const std::vector<std::array<vec2, 3>>& faces = camera_.meshes[0].uv;
    const double wanted = std::sqrt(double(faces.size()) / kFacesACell);
    cells_a_side_ = std::clamp(int(wanted), 1, kMaxCells);
    cells_.resize(size_t(cells_a_side_) * size_t(cells_a_side_));
    for (uint32_t face = 0; face < faces.size(); ++face) {
        const auto& [a, b, c] = faces[face];
        const dvec2 lowest(glm::min(a, glm::min(b, c))), highest(glm::max(a, glm::max(b, c)));
        if (!is_finite(dvec3(lowest, 0)) || !is_finite(dvec3(highest, 0)))
            continue;
        const auto low = cell_at(lowest), high = cell_at(highest);
        for (int row = low[1]; row <= high[1]; ++row)
            for (int column = low[0]; column <= high[0]; ++column)
                cells_[size_t(row) * size_t(cells_a_side_) + size_t(column)].push_back(face);
    }
}

std::optional<FaceRays::Spot> FaceRays::spot_at(const dvec2& uv) const {
    const auto [column, row] = cell_at(uv);
    for (const uint32_t face : cells_[size_t(row) * size_t(cells_a_side_) + size_t(column)])
        if (const auto weights = weights_at(camera_.meshes[0].uv[face], uv);
            weights && -max_component(-*weights) >= 0)
            return Spot{0, face, *weights};
    return std::nullopt;
}

std::optional<FaceRays::Spot> FaceRays::spot_in(uint32_t mesh, uint64_t face) const {
    if (mesh >= camera_.meshes.size() || face >= camera_.meshes[mesh].corners.size())
        return std::nullopt;
    return Spot{mesh, size_t(face)};
}

std::optional<FaceRays::Spot> FaceRays::spot(uint32_t x, uint32_t y, const dvec2& place,
                                             uint32_t sample) const {
    const auto meshes = uint32_t(camera_.meshes.size());
    const uint64_t pixel = uint64_t(y) * size_.width + x;
    switch (camera_.order) {
    case FaceCamera::Order::EachMesh:
        return spot_in(sample % meshes, pixel);
    case FaceCamera::Order::OneAfterAnother: {
        uint64_t face = uint64_t(size_.width) * size_.height * sample + pixel;
        uint32_t mesh = 0;
        while (mesh < meshes && face >= camera_.meshes[mesh].corners.size())
            face -= camera_.meshes[mesh++].corners.size();
        return spot_in(mesh, face);
    }
    case FaceCamera::Order::SideBySide: {
        const uint32_t width = std::max(size_.width / meshes, 1u);
        return spot_in(x / width, uint64_t(y) * width + x % width);
    }
    case FaceCamera::Order::ByUv:
        break;
    }
    return spot_at({(x + place.x) / size_.width, 1 - (y + place.y) / size_.height});
}

Ray FaceRays::ray(uint32_t x, uint32_t y, const dvec2& place, uint32_t sample) const {
    Ray ray;
    ray.dir = dvec3(0);
    const std::optional<Spot> found = spot(x, y, place, sample);
    if (!found)
        return ray;
    const FaceMesh& mesh = camera_.meshes[found->mesh];
    const auto& [a, b, c] = mesh.corners[found->face];
    const dvec3& w = found->weights;
    dvec3 normal = glm::cross(c - a, b - a); // as povray has it: its space is left-handed
    if (!mesh.normals.empty()) {
        const std::array<vec3, 3>& of = mesh.normals[found->face];
        normal = w.x * dvec3(of[0]) + w.y * dvec3(of[1]) + w.z * dvec3(of[2]);
    }
    const double length = glm::length(normal);
    if (!(length > 0) || !std::isfinite(length))
        return ray;
    normal /= length;
    ray.org = w.x * a + w.y * b + w.z * c + camera_.ahead * normal;
    ray.dir = camera_.backwards ? -normal : normal;
    return ray;
}

} // namespace ovc
