// SPDX-License-Identifier: Apache-2.0
// How much of what a camera sees of a field of tents is in the sun, in C++20: a stream of camera
// rays, each of which sends a shadow ray from where it hits. Links with libovercast.
#include <overcast/overcast.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

int main() try {
    const overcast::Device device;
    overcast::Scene scene(device);
    const std::vector<double> ground = {-50, -50, 0, 50, -50, 0, 50,  50, 0,
                                        -50, -50, 0, 50, 50,  0, -50, 50, 0};
    const std::vector<float> tent = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 0, 2};
    const std::vector<uint32_t> sides = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    scene.add<double>(ground);
    const uint32_t first = scene.add<float>(tent, sides, OVC_MESH_TEMPLATE);
    for (int i = 0; i < 100; ++i) {
        const double c = std::cos(i), s = std::sin(i), x = i % 10 * 4 - 18, y = i / 10 * 4 - 18;
        scene.add_instance(first, {c, -s, 0, x, s, c, 0, y, 0, 0, 1, 0});
    }
    scene.commit();

    constexpr int kSide = 400;
    std::vector<ovc_ray> camera;
    std::vector<uint64_t> tokens; // of the camera rays; those of shadow rays do not matter
    for (int i = 0; i < kSide * kSide; ++i) {
        const double x = (i % kSide + 0.5) / kSide - 0.5, y = (i / kSide + 0.5) / kSide - 0.5;
        camera.push_back({{0, 0, 60}, 0, {x, y, -1}, HUGE_VAL});
        tokens.push_back(uint64_t(i));
    }
    size_t next = 0, seen = 0, lit = 0;
    const auto more = [&](overcast::Stream& stream, size_t wanted) {
        const size_t count = std::min(wanted, camera.size() - next);
        stream.push(std::span(camera).subspan(next, count), std::span(tokens).subspan(next, count),
                    /* any_hit= */ false);
        next += count;
    };
    const auto answered = [&](overcast::Stream& stream, const ovc_stream_answers& answers) {
        std::vector<ovc_ray> shadows;
        std::vector<ovc_triangle> from; // a shadow ray does not see the triangle it starts on
        for (size_t i = 0; i < answers.count; ++i) {
            if (!answers.hits) {
                lit += !answers.occluded[i];
                continue;
            }
            const ovc_hit& hit = answers.hits[i];
            if (hit.mesh == OVC_NONE)
                continue;
            const ovc_ray& ray = camera[answers.tokens[i]];
            ovc_ray shadow = {{}, 0, {1, 2, 3}, HUGE_VAL};
            for (int axis = 0; axis < 3; ++axis)
                shadow.org[axis] = ray.org[axis] + hit.t * ray.dir[axis];
            shadows.push_back(shadow);
            from.push_back({hit.mesh, hit.prim});
        }
        seen += shadows.size();
        auto query = overcast::make<ovc_query>();
        query.skip = from.data();
        const std::vector<uint64_t> any(shadows.size());
        stream.push(shadows, any, /* any_hit= */ true, &query);
    };
    scene.stream(more, answered);
    std::printf("%zu of %zu rays hit, %zu of those in the sun\n", seen, camera.size(), lit);
    return 0;
} catch (const overcast::Error& error) {
    std::fprintf(stderr, "sunlit: %s\n", error.what());
    return 1;
}
