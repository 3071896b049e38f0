// SPDX-License-Identifier: Apache-2.0
// A field of triangles with obvious answers, behind the C ABI: cell (x, y) of the unit grid holds
// triangle x + y kSide, whose corners are (x, y), (x + 1, y), (x, y + 1) at height 0.
#pragma once

#include "tests/abi/abi_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ovc::test {

constexpr uint32_t kSide = 12;
constexpr uint32_t kCells = kSide * kSide;

inline const std::vector<float>& field_positions() {
    static const std::vector<float> positions = [] {
        std::vector<float> corners;
        for (uint32_t cell = 0; cell < kCells; ++cell)
            for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}})
                corners.insert(corners.end(),
                               {float(cell % kSide + dx), float(cell / kSide + dy), 0});
        return corners;
    }();
    return positions;
}

/// Returns a shared mesh, whose positions live as long as the program.
inline ovc_mesh field_mesh() {
    auto mesh = sized<ovc_mesh>();
    mesh.positions = field_positions().data();
    mesh.vertex_count = field_positions().size() / 3;
    mesh.flags = OVC_MESH_SHARED;
    return mesh;
}

/// Returns a ray down into a cell from this height, which hits at u = v = 1/4.
inline ovc_ray into_cell(uint32_t cell, double height) {
    return {{cell % kSide + 0.25, cell / kSide + 0.25, height}, 0, {0, 0, -1}, HUGE_VAL};
}

inline bool is_in_cell(const ovc_hit& hit, uint32_t cell, double height) {
    return hit.mesh == 0 && hit.prim == cell && hit.t == height && hit.u == 0.25 && hit.v == 0.25;
}

/// Returns the committed field on a device, or null if it is refused.
inline ovc_scene make_field(ovc_device device) {
    ovc_scene scene = nullptr;
    const ovc_mesh mesh = field_mesh();
    if (api().create_scene(device, nullptr, &scene) == OVC_OK &&
        api().add_mesh(scene, &mesh, nullptr) == OVC_OK && api().commit(scene) == OVC_OK)
        return scene;
    api().destroy_scene(scene);
    return nullptr;
}

/// Sends rays into all cells, and returns whether all answers to both queries are right.
inline bool field_answers(ovc_scene scene) {
    std::vector<ovc_ray> rays;
    for (uint32_t cell = 0; cell < kCells; ++cell)
        rays.push_back(into_cell(cell, 1 + cell % 5));
    rays.push_back({{-1, -1, 1}, 0, {0, 0, -1}, HUGE_VAL}); // This ray goes beside the field.
    std::vector<ovc_hit> hits(rays.size());
    std::vector<uint8_t> occluded(rays.size(), 9);
    if (api().intersect(scene, rays.data(), rays.size(), hits.data(), nullptr) != OVC_OK ||
        api().occluded(scene, rays.data(), rays.size(), occluded.data(), nullptr) != OVC_OK)
        return false;
    for (uint32_t cell = 0; cell < kCells; ++cell)
        if (!is_in_cell(hits[cell], cell, 1 + cell % 5) || occluded[cell] != 1)
            return false;
    return hits.back().mesh == OVC_NONE && occluded.back() == 0;
}

} // namespace ovc::test
