// SPDX-License-Identifier: Apache-2.0
// Prints what warps of 32 lanes do with a scene's rays, for each variant of the kernel and each
// kind of rays, and the rays a second that this allows on a GPU.
// usage: warp SCENE SIDE GPU.json...     SCENE: a test scene; SIDE: pixels of a side
#include "gpu/trace/packets.h"
#include "host/backend/backend.h"
#include "host/bench/ray_sets.h"
#include "host/camera/camera.h"
#include "host/scene/scene_source.h"
#include "host/scene/scene_summary.h"
#include "tests/warp/pooled_scene.h"
#include "tests/warp/warp_model.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace ovc {
namespace {

Gpu read_gpu(const char* path) {
    std::ifstream file(path);
    const nlohmann::json json = nlohmann::json::parse(file);
    return {json.at("name"),
            json.at("multiprocessors"),
            json.at("warps_a_cycle"),
            json.at("hertz"),
            json.at("l1_bytes_a_cycle"),
            json.at("l2_bytes_a_second"),
            json.at("memory_bytes_a_second"),
            json.at("l1_bytes"),
            json.at("l2_bytes")};
}

void print_row(const std::string& name, const WarpVariant& variant, std::span<const Steps> slots,
               uint64_t rays, std::span<const Gpu> gpus) {
    const WarpWork work = run_warps(variant, slots, rays, gpus[0]);
    fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.0f} % | {:.0f} % |", name,
               double(work.warp_rounds * kWarpLanes) / double(rays), work.active_lanes(),
               work.lines_a_ray(), 100 - 100.0 * double(work.l1_misses) / double(work.lines),
               100 -
                   100.0 * double(work.l2_misses) / double(std::max<uint64_t>(work.l1_misses, 1)));
    for (const Gpu& gpu : gpus) {
        const RayRate rate = rate_of(variant, run_warps(variant, slots, rays, gpu), gpu);
        fmt::print(" {:.0f} ({}) |", rate.bound() / 1e6, rate.bound_by());
    }
    fmt::print("\n");
}

void print_set(const PooledScene& scene, const RaySet& set, std::span<const Gpu> gpus) {
    const bool any_hit = set.query == RayQuery::Occlusion;
    const PagedVector<LocalRay> rays = scene.local_rays(set.rays, any_hit);
    const size_t block = 256;
    LocalRay none{};
    none.t_end = OVC_NO_RAY;
    PagedVector<LocalRay> slots = rays;
    slots.resize((rays.size() + block - 1) / block * block, none);
    PagedVector<LocalRay> pairs = slots;
    const bool packs = coherent(rays) && part_packets(pairs, rays.size(), 2 * slots.size());
    for (const bool branches : {true, false})
        for (const bool packets : {false, true}) {
            if (packets && !packs)
                continue;
            const std::vector<Steps> steps =
                replay({any_hit, branches, packets}, scene.pool, packets ? pairs : slots);
            for (const bool refill : {false, true}) {
                const std::string name =
                    fmt::format("{}: {}{}{}", set.name, branches ? "branches" : "both sides",
                                packets ? ", packets" : "", refill ? ", refill" : "");
                print_row(name, {branches, packets, refill}, steps, set.rays.size(), gpus);
            }
        }
}

int run(const char* name, uint32_t side, std::span<const Gpu> gpus) {
    const Result<Scene> scene = open_scene(name, LogSink());
    if (!scene) {
        std::fprintf(stderr, "warp: %s\n", scene.error().message.c_str());
        return 1;
    }
    BackendOptions options;
    options.kind = BackendKind::CpuKdTree;
    const auto reference = make_backend(scene->soup, options, LogSink());
    const Camera camera =
        scene->camera ? *scene->camera : framing_camera(hittable_bounds(scene->soup), side, side);
    const auto sets = make_ray_sets(*scene, camera, side, side, **reference);
    if (!sets) {
        std::fprintf(stderr, "warp: %s\n", sets.error().message.c_str());
        return 1;
    }
    const PooledScene pooled(scene->soup, 1);
    fmt::print(
        "| rays and variant | rounds a ray | active lanes | lines a ray | found in L1 | in L2 |");
    for (const Gpu& gpu : gpus)
        fmt::print(" {}, Mrays/s at most |", gpu.name);
    fmt::print("\n|---|--:|--:|--:|--:|--:|");
    for (size_t i = 0; i < gpus.size(); ++i)
        fmt::print("--:|");
    fmt::print("\n");
    for (const RaySet& set : *sets)
        print_set(pooled, set, gpus);
    return 0;
}

} // namespace
} // namespace ovc

int main(int count, char** arguments) {
    if (count < 4) {
        std::fprintf(stderr, "usage: warp SCENE SIDE GPU.json...\n");
        return 2;
    }
    std::vector<ovc::Gpu> gpus;
    for (int i = 3; i < count; ++i)
        gpus.push_back(ovc::read_gpu(arguments[i]));
    return ovc::run(arguments[1], uint32_t(std::atoi(arguments[2])), gpus);
}
