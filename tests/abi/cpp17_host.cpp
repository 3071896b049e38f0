// SPDX-License-Identifier: Apache-2.0
// Uses overcast.hpp in C++17: a triangle, its hits and its shadow. The exit code is 0 if the
// answers are right.
#include "plugin/overcast.hpp"

#include <cmath>
#include <cstdio>

int main() {
    try {
        const overcast::Device device;
        overcast::Scene scene(device);
        const std::vector<float> triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};
        scene.add<float>(triangle);
        scene.add<double>(std::vector<double>{0, 0, -1, 1, 0, -1, 0, 1, -1});
        scene.commit();
        const std::vector<ovc_ray> rays(2, {{0.25, 0.25, 1}, 0, {0, 0, -1}, HUGE_VAL});
        std::vector<ovc_hit> hits(4);
        std::vector<uint64_t> counts(2);
        std::vector<uint8_t> occluded(2);
        scene.all_hits(rays, 2, hits, counts);
        scene.occluded(rays, occluded);
        const bool right = hits[2].t == 1 && hits[3].t == 2 && counts[1] == 2 && occluded[0] == 1 &&
                           scene.intersect(rays)[1].mesh == 0;
        return right ? 0 : 1;
    } catch (const overcast::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
