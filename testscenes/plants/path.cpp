// SPDX-License-Identifier: Apache-2.0
// The flight over the plants: from high above down to the water, along it, and round the trees.
#include "testscenes/plants/landscape.h"
#include "testscenes/scenes.h"
#include "testscenes/spline.h"

#include "testscenes/noise.h"

#include <algorithm>

namespace ovc {

namespace {

using namespace plants;

struct View {
    dvec3 eye, target;
};
View operator+(const View& a, const View& b) {
    return {a.eye + b.eye, a.target + b.target};
}
View operator*(double s, const View& a) {
    return {s * a.eye, s * a.target};
}

/// Down towards the viewer's place, low along the water, then once round the nearest trees.
std::vector<View> waypoints() {
    std::vector<View> views = {
        {{60, 190, 170}, {-5, 0, -60}},   {{40, 120, 130}, {-8, 0, -60}},
        {{15, 55, 75}, {-10, 0, -50}},    {{0, 18, 35}, {-12, 0, -45}},
        {{-6, 5.5, 10}, {-14, 1.5, -40}}, {{-13, 2.6, -6}, {-8, 2, -50}},
        {{-12, 2.6, -20}, {-2, 3, -70}},  {{-12, 3, -32}, {8, 5, -70}},
        {{-15, 6, -42}, {22, 6, -50}},
    };
    constexpr int kSteps = 14;
    const dvec3 middle(8, 3, -14);
    for (int i = 0; i <= kSteps; ++i) {
        const dvec2 c = circle(0.63 + 1.05 * i / kSteps);
        views.push_back({middle + dvec3(36 * c.x, 10 + 0.3 * i, 36 * c.y), middle});
    }
    return views;
}

/// Above the water and, on the way round, above the trees.
dvec3 lifted(dvec3 eye, double along) {
    const double clearance = 2 + 12 * smooth_step(0.42, 0.55, along);
    eye.y = std::max(eye.y, std::max(0.0, ground_height({eye.x, eye.z})) + clearance);
    return eye;
}

} // namespace

CameraPath plants_path() {
    constexpr uint32_t kFrames = 255;
    const std::vector<View> views = waypoints();
    CameraPath path(kFrames);
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
        const double along = double(frame) / (kFrames - 1);
        const View view = spline_at<View>(views, along);
        path[frame].eye = lifted(view.eye, along);
        path[frame].target = view.target;
        path[frame].fov_degrees = 45;
    }
    return path;
}

} // namespace ovc
