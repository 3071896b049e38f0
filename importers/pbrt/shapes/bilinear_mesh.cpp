// SPDX-License-Identifier: Apache-2.0
// A bilinear patch becomes two triangles if it is flat, else a grid of them.
#include "importers/pbrt/shapes/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc::pbrt {

namespace {

/// The corners lie at (u, v) = (0,0), (1,0), (0,1), (1,1).
struct BilinearPatch {
    dvec3 p[4];
    dvec2 uv[4] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}}; // texture coordinates of the corners
    dvec3 normal[4]{};                              // of the corners; 0: the file has none

    template <class T>
    static T between(const T (&of)[4], double u, double v) {
        return glm::mix(glm::mix(of[0], of[1], u), glm::mix(of[2], of[3], u), v);
    }
    double size() const {
        Box box;
        for (const dvec3& corner : p)
            box.add(corner);
        return glm::length(box.extent());
    }
    /// Returns how far the middle lies off either diagonal.
    double bulge() const { return glm::length(p[0] + p[3] - p[1] - p[2]) / 4; }
};

constexpr double kMaxPatchSteps = 16;

/// Divided into n x n, a patch lies 1/n^2 of its bulge off its triangles. All patches are divided
/// alike, or neighbours would not meet.
uint32_t steps_for(const std::vector<BilinearPatch>& patches, double tolerance) {
    double steps = 1;
    for (const BilinearPatch& patch : patches) {
        const double allowed = tolerance * patch.size();
        if (allowed > 0 && allowed < 1e300 && patch.bulge() > 1e-9 * patch.size())
            steps = std::max(steps, std::ceil(std::sqrt(patch.bulge() / allowed)));
    }
    return uint32_t(std::min(steps, kMaxPatchSteps));
}

void add_patch(const BilinearPatch& patch, uint32_t steps, bool with_uv, bool with_normals,
               Mesh& mesh) {
    assert(steps >= 1 && steps <= kMaxPatchSteps);
    const auto first = uint32_t(mesh.positions.size() / 3);
    const uint32_t row = steps + 1;
    for (uint32_t v = 0; v <= steps; ++v)
        for (uint32_t u = 0; u <= steps; ++u) {
            const auto here = [&](const auto& of) {
                return BilinearPatch::between(of, double(u) / steps, double(v) / steps);
            };
            mesh.add_vertex(here(patch.p));
            if (with_uv)
                mesh.uv.emplace_back(here(patch.uv));
            if (with_normals)
                mesh.normals.emplace_back(here(patch.normal));
        }
    for (uint32_t v = 0; v < steps; ++v)
        for (uint32_t u = 0; u < steps; ++u) {
            const uint32_t a = first + v * row + u;
            mesh.add_triangle(a, a + 1, a + row + 1);
            mesh.add_triangle(a, a + row + 1, a + row);
        }
}

} // namespace

std::optional<Mesh> make_bilinear_mesh(ShapeRequest& request) {
    const std::vector<double> points = take_points(request);
    if (points.empty())
        return std::nullopt;
    auto indices = take_indices(request, points.size() / 3, 4);
    if (!indices)
        return std::nullopt;
    if (indices->empty() && points.size() == 12)
        *indices = {0, 1, 2, 3};
    if (indices->empty())
        return left_out(request, "it has no indices");
    const std::vector<vec2> uv = take_uv(request, points.size() / 3);
    const std::vector<vec3> normals = take_normals(request, points.size() / 3);
    std::vector<BilinearPatch> patches(indices->size() / 4);
    for (size_t i = 0; i < indices->size(); ++i) {
        const double* p = points.data() + size_t((*indices)[i]) * 3;
        patches[i / 4].p[i % 4] = {p[0], p[1], p[2]};
        if (!uv.empty())
            patches[i / 4].uv[i % 4] = dvec2(uv[(*indices)[i]]);
        if (!normals.empty())
            patches[i / 4].normal[i % 4] = dvec3(normals[(*indices)[i]]);
    }
    const uint32_t steps = steps_for(patches, request.tolerance);
    if (patches.size() * 2 * steps * steps > request.max_triangles) {
        request.diagnostics.fail(
            request.place,
            fmt::format("found a bilinearmesh of {} triangles, expected at most {} more; "
                        "--max-triangles allows more",
                        patches.size() * 2 * steps * steps, request.max_triangles));
        return std::nullopt;
    }
    Mesh mesh;
    mesh.emitters = patches.size();
    for (const BilinearPatch& patch : patches)
        add_patch(patch, steps, request.wants_uv, !normals.empty(), mesh);
    return mesh;
}

} // namespace ovc::pbrt
