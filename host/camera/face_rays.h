// SPDX-License-Identifier: Apache-2.0
// FaceRays finds the faces of a FaceCamera that look at the pixels of a picture.
#pragma once

#include "core/face_camera.h"
#include "core/ray.h"
#include "core/scene.h"

#include <optional>

namespace ovc {

class FaceRays {
public:
    /// camera: must outlive it. size: of the whole picture.
    FaceRays(const FaceCamera& camera, const ImageSize& size);

    /// Returns the ray of the pixel's sample, or a ray with a dir of 0 where no face has it. place:
    /// in the pixel, from its top left corner (0, 0) to (1, 1); only Order::ByUv has a use for it.
    Ray ray(uint32_t x, uint32_t y, const dvec2& place, uint32_t sample) const;

private:
    /// A face and the weights of its corners where its ray begins.
    struct Spot {
        uint32_t mesh = 0;
        size_t face = 0;
        dvec3 weights{1 / 3.0};
    };

    std::optional<Spot> spot(uint32_t x, uint32_t y, const dvec2& place, uint32_t sample) const;
    std::optional<Spot> spot_in(uint32_t mesh, uint64_t face) const;
    std::optional<Spot> spot_at(const dvec2& uv) const;
    void sort_by_uv();
    std::array<int, 2> cell_at(const dvec2& uv) const;

    const FaceCamera& camera_;
    const ImageSize size_;
    /// Of Order::ByUv: the first mesh's faces that may lie in each cell of a grid over the unit
    /// square, row by row.
    std::vector<std::vector<uint32_t>> cells_;
    int cells_a_side_ = 0;
};

} // namespace ovc
