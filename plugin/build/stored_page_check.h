// SPDX-License-Identifier: Apache-2.0
// StoredPageCheck tells whether pages that are read from a disk may be walked.
#pragma once

#include "gpu/page/page_check.h"
#include "plugin/build/built_scene.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// A page must have the head that the tables have, which the top-level tree was built from.
class StoredPageCheck {
public:
    StoredPageCheck(const BuiltScene& scene, std::span<const Page> pages) {
        const auto add = [&](const BuiltScene& cut) {
            const Part part{uint32_t(cut.soup.triangle_count()), cut.numbers.first()};
            parts_.insert(parts_.end(), cut.level1.leaves.size(), part);
        };
        add(scene);
        for (const SharedMesh& mesh : scene.shared)
            add(mesh.scene);
        heads_.resize(parts_.size());
        for (const Page& page : pages)
            heads_[page.stored_number] = {page.view(), page.depth};
    }

    bool operator()(uint32_t number, std::span<const uvec4> texels) const {
        const Head& head = heads_[number];
        const Part& part = parts_[number];
        const Page page{.texels = {}, .borrowed = texels, .depth = head.depth};
        return std::ranges::equal(head.texels, texels.first(kHeadTexels)) &&
               is_walkable(page, part.triangles, part.first_number);
    }

private:
    struct Part {
        uint32_t triangles = 0;
        uint32_t first_number = 0;
    };
    struct Head {
        std::span<const uvec4> texels;
        uint32_t depth = 0;
    };

    std::vector<Part> parts_; // of each page, in the order that they were saved
    std::vector<Head> heads_;
};

} // namespace ovc
