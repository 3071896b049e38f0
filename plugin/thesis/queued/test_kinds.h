// SPDX-License-Identifier: Apache-2.0
// Lists every kind of level 1 that the thesis names, for tests.
#pragma once

#include "plugin/overcast.h"

#include <string>
#include <vector>

namespace ovc::thesis {

struct Kind {
    std::string name;
    ovc_level1 level1;
    ovc_level1_build build;
};

inline const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all = {
        {"kd-tree from the top", OVC_LEVEL1_KD_TREE, OVC_LEVEL1_BUILD_TOP_DOWN},
        {"kd-tree from the bottom", OVC_LEVEL1_KD_TREE, OVC_LEVEL1_BUILD_BOTTOM_UP},
        {"grid", OVC_LEVEL1_GRID, OVC_LEVEL1_BUILD_TOP_DOWN},
        {"BVH from the top", OVC_LEVEL1_BVH, OVC_LEVEL1_BUILD_TOP_DOWN},
        {"BVH from the bottom", OVC_LEVEL1_BVH, OVC_LEVEL1_BUILD_BOTTOM_UP}};
    return all;
}

} // namespace ovc::thesis
