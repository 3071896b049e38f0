// SPDX-License-Identifier: Apache-2.0
// Puts a soup behind the C ABI, for tests: handles with owners, and the fixture of tests that need
// a device.
#pragma once

#include "core/ray.h"
#include "core/soup.h"
#include "tests/abi/abi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace ovc::test {

struct DestroyDevice {
    void operator()(ovc_device device) const { api().destroy_device(device); }
};
using Device = std::unique_ptr<ovc_device_t, DestroyDevice>;

/// Opens a device. Returns null if there is none.
inline Device open_device() {
    ovc_device device = nullptr;
    api().create_device(nullptr, &device);
    return Device(device);
}

struct DestroyScene {
    void operator()(ovc_scene scene) const { api().destroy_scene(scene); }
};
using AbiScene = std::unique_ptr<ovc_scene_t, DestroyScene>;

/// Adds the soup's meshes to a new scene, which shares them and is not committed. Returns null if
/// the config is refused.
inline AbiScene add_soup(const Device& device, const Soup& soup, const ovc_scene_config& config) {
    ovc_scene scene = nullptr;
    if (api().create_scene(device.get(), &config, &scene) != OVC_OK)
        return nullptr;
    AbiScene owner(scene);
    for (const Chunk& chunk : soup.chunks) {
        auto mesh = sized<ovc_mesh>();
        mesh.positions = reinterpret_cast<const float*>(chunk.corners().data());
        mesh.vertex_count = chunk.corners().size();
        for (int axis = 0; axis < 3; ++axis)
            mesh.origin[axis] = chunk.origin()[axis];
        mesh.flags = OVC_MESH_SHARED;
        if (chunk.transform())
            mesh.transform = chunk.transform()->rows[0].data();
        if (api().add_mesh(scene, &mesh, nullptr) != OVC_OK)
            return nullptr;
    }
    return owner;
}

inline const ovc_ray* as_abi(const std::vector<Ray>& rays) {
    return reinterpret_cast<const ovc_ray*>(rays.data());
}

/// Returns the query of a call that has the same answers and is the kernel's, however few its rays
/// are: a call that tells its progress is never answered aside.
inline ovc_query by_kernel(const ovc_query* query) {
    ovc_query same = query ? *query : sized<ovc_query>();
    if (!same.progress)
        same.progress = [](void*, double, const char*) { return 0; };
    return same;
}

/// Calls ask(first, count, query) for some of the rays at a time, so few that they are answered
/// aside. Not for queries with masks or a filter, which never are.
template <class Ask>
void few_at_a_time(size_t rays, const ovc_query* query, Ask&& ask) {
    constexpr size_t kFew = 50;
    for (size_t first = 0; first < rays; first += kFew) {
        ovc_query some = query ? *query : sized<ovc_query>();
        some.skip = some.skip ? some.skip + first : nullptr;
        some.after = some.after ? some.after + first : nullptr;
        ask(first, std::min(kFew, rays - first), some);
    }
}

/// Returns an answer for each ray, and expects it to be the same bits by either way: by the kernel,
/// and few rays at a time. trace(rays, count, answers, query) calls the ABI.
template <class T, class Trace>
std::vector<T> traced_both_ways(std::span<const ovc_ray> rays, const ovc_query* query,
                                Trace&& trace) {
    std::vector<T> answers(rays.size()), aside(rays.size());
    const ovc_query asked = by_kernel(query);
    EXPECT_EQ(trace(rays.data(), rays.size(), answers.data(), &asked), OVC_OK);
    if (query && (query->masks || query->filter))
        return answers;
    few_at_a_time(rays.size(), query, [&](size_t first, size_t count, const ovc_query& some) {
        EXPECT_EQ(trace(&rays[first], count, &aside[first], &some), OVC_OK);
    });
    for (size_t i = 0; i < rays.size(); ++i)
        EXPECT_EQ(std::memcmp(&answers[i], &aside[i], sizeof(T)), 0) << "ray " << i;
    return answers;
}

/// The nearest hits.
inline std::vector<ovc_hit> answers(ovc_scene scene, std::span<const ovc_ray> rays,
                                    const ovc_query* query = nullptr) {
    return traced_both_ways<ovc_hit>(
        rays, query, [&](auto&&... asked) { return api().intersect(scene, asked...); });
}
inline std::vector<ovc_hit> answers(const AbiScene& scene, const std::vector<Ray>& rays,
                                    const ovc_query* query = nullptr) {
    return answers(scene.get(), std::span(as_abi(rays), rays.size()), query);
}

/// Whether anything is hit.
inline std::vector<uint8_t> occlusion(ovc_scene scene, std::span<const ovc_ray> rays,
                                      const ovc_query* query = nullptr) {
    return traced_both_ways<uint8_t>(
        rays, query, [&](auto&&... asked) { return api().occluded(scene, asked...); });
}

inline ovc_statistics statistics(const AbiScene& scene) {
    auto statistics = sized<ovc_statistics>();
    EXPECT_EQ(api().statistics(scene.get(), &statistics), OVC_OK);
    return statistics;
}

/// A test with a device. Without one, the test is skipped.
class DeviceTest : public testing::Test {
protected:
    void SetUp() override {
        device = open_device();
        if (!device)
            GTEST_SKIP() << api().last_error(nullptr);
    }

    std::string error() const { return api().last_error(device.get()); }

    Device device;
};

} // namespace ovc::test
