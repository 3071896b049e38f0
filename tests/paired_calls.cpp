// SPDX-License-Identifier: Apache-2.0
// paired_calls BEFORE.so AFTER.so SCENE [--rays N] [--repeats N] times calls of two versions of the
// library on the same rays, by turns, for docs/benchmarks.md. Prints the median and the quartiles
// of the ratio of each pair, of the seconds from call to return and of the CPU time, which other
// programs change less. Edges: rays from the camera at corners and points of sides. Answers must be
// the same bits. With --shared the camera is the scene's own, and instances share their mesh's
// pages, as `overcast` hands them over; else they are triangles of their own.
#include "core/system/stopwatch.h"
#include "host/bench/contender.h"
#include "host/bench/ray_sets.h"
#include "host/scene/scene_source.h"
#include "host/scene/scene_summary.h"
#include "plugin/overcast.h"
#include "testscenes/random.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace ovc {
namespace {

/// A scene in one of the libraries. Structs have the sizes of the first version of the ABI. The
/// soup keeps its corners while the scene lives.
class Side {
public:
    Side(const char* path, const Soup& soup) {
        void* const library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
        if (!library)
            give_up(dlerror());
        const auto get_api = ovc_get_api_function(dlsym(library, "ovc_get_api"));
        api_ = get_api ? get_api(OVC_ABI_VERSION) : nullptr;
        if (!api_)
            give_up(fmt::format("{} is no library of Overcast of this version", path));
        must(api_->create_device(nullptr, &device_));
        must(api_->create_scene(device_, nullptr, &scene_));
        for (const Chunk& chunk : soup.chunks)
            add(chunk);
        must(api_->commit(scene_));
    }

    void intersect(const std::vector<ovc_ray>& rays, std::vector<ovc_hit>& hits) const {
        must(api_->intersect(scene_, rays.data(), rays.size(), hits.data(), nullptr));
    }
    void occluded(const std::vector<ovc_ray>& rays, std::vector<uint8_t>& occluded) const {
        must(api_->occluded(scene_, rays.data(), rays.size(), occluded.data(), nullptr));
    }

private:
    void add(const Chunk& chunk) const {
        ovc_mesh mesh{};
        mesh.struct_size = offsetof(ovc_mesh, mask);
        std::copy_n(&chunk.origin().x, 3, mesh.origin);
        if (chunk.transform())
            mesh.transform = chunk.transform()->rows[0].data();
        if (chunk.double_corners().empty())
            mesh.positions = reinterpret_cast<const float*>(chunk.corners().data());
        else
            mesh.positions_double = reinterpret_cast<const double*>(chunk.double_corners().data());
        mesh.vertex_count = 3 * uint64_t(chunk.size());
        mesh.flags = OVC_MESH_SHARED;
        must(api_->add_mesh(scene_, &mesh, nullptr));
    }
    [[noreturn]] static void give_up(const std::string& why) {
        fmt::print(stderr, "paired_calls: {}\n", why);
        std::exit(1);
    }
    void must(ovc_result result) const {
        if (result != OVC_OK)
            give_up(api_->last_error(device_));
    }

    const ovc_api* api_ = nullptr;
    ovc_device device_ = nullptr;
    ovc_scene scene_ = nullptr;
};

ovc_ray ray_from(const dvec3& org, const dvec3& dir) {
    return {
        {org.x, org.y, org.z}, 0, {dir.x, dir.y, dir.z}, std::numeric_limits<double>::infinity()};
}

/// Returns rays of a camera, row by row.
std::vector<ovc_ray> camera_rays(const Box& box, size_t count) {
    const double reach = max_component(box.extent());
    const dvec3 eye = box.center() + reach * dvec3(0.3, 0.4, 1.4);
    const auto width = size_t(std::sqrt(double(count)));
    std::vector<ovc_ray> rays;
    for (size_t i = 0; i < count; ++i) {
        const dvec3 on_screen(double(i % width) / double(width) - 0.5,
                              double(i / width) / double(width) - 0.5, 0);
        rays.push_back(ray_from(eye, box.center() + 0.9 * reach * on_screen - eye));
    }
    return rays;
}

/// Returns about so many rays of the scene's own camera, in the order in which pixels are traced.
std::vector<ovc_ray> own_camera_rays(const Scene& scene, size_t count) {
    const auto side = uint32_t(std::sqrt(double(count)));
    std::vector<ovc_ray> rays;
    for (const Ray& ray :
         make_primary_set(own_or_framing_camera(scene, side, side), side, side).rays)
        rays.push_back({{ray.org.x, ray.org.y, ray.org.z},
                        ray.t_min,
                        {ray.dir.x, ray.dir.y, ray.dir.z},
                        ray.t_max});
    return rays;
}

/// Returns rays in all directions, from just before the hits of `first`, or from points of the box.
std::vector<ovc_ray> bounced_rays(const Box& box, const std::vector<ovc_ray>& first,
                                  const std::vector<ovc_hit>& hits) {
    Random random(1);
    const auto any = [&] {
        return dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    };
    std::vector<ovc_ray> rays;
    for (size_t i = 0; i < first.size(); ++i) {
        const auto& [org, t_min, dir, t_max] = first[i];
        const dvec3 from = hits[i].mesh == OVC_NONE
                               ? box.center() + 0.5 * box.extent() * any()
                               : dvec3(org[0], org[1], org[2]) +
                                     0.9999 * hits[i].t * dvec3(dir[0], dir[1], dir[2]);
        rays.push_back(ray_from(from, any()));
    }
    return rays;
}

/// Returns rays that leave as those of `first` do, each to a corner of the triangle that its hit
/// names, or as often to a point between two of them.
std::vector<ovc_ray> edge_rays(const Soup& soup, const std::vector<ovc_ray>& first,
                               const std::vector<ovc_hit>& hits) {
    Random random(1);
    std::vector<ovc_ray> rays;
    for (size_t i = 0; i < first.size(); ++i) {
        if (hits[i].mesh == OVC_NONE)
            continue;
        const Triangle triangle = soup.triangle({hits[i].mesh, hits[i].prim});
        const uint32_t corner = random.below(3);
        const double along = random.chance(0.5) ? 0 : random.uniform();
        const dvec3 org(first[i].org[0], first[i].org[1], first[i].org[2]);
        rays.push_back(
            ray_from(org, glm::mix(triangle[corner], triangle[(corner + 1) % 3], along) - org));
    }
    return rays;
}

/// The time that a call took.
struct Cost {
    double seconds = 0, cpu_seconds = 0;
};

template <class Call>
Cost cost_of(Call&& call) {
    const std::clock_t cpu = std::clock(); // of all threads
    const Stopwatch watch;
    call();
    return {watch.seconds(), double(std::clock() - cpu) / CLOCKS_PER_SEC};
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[(values.size() - 1) / 2];
}

std::string spread(std::vector<double> ratios) {
    std::ranges::sort(ratios);
    const auto at = [&](double share) { return ratios[size_t(share * double(ratios.size() - 1))]; };
    return fmt::format("{:.3f} ({:.3f} to {:.3f})", at(0.5), at(0.25), at(0.75));
}

/// only: a kind of rays; empty: all.
Result<Done> run(const char* before, const char* after, const std::string& name, size_t wanted,
                 int repeats, std::string_view only, bool shared) {
    const Result<Scene> scene = open_scene(name, standard_error_log(LogLevel::Warning));
    if (!scene)
        return scene.error();
    const Box box = hittable_bounds(scene->soup);
    const Soup baked_soup = shared ? Soup{} : baked(scene->soup);
    const Soup& soup = shared ? scene->soup : baked_soup;
    const std::array<Side, 2> sides{Side(before, soup), Side(after, soup)};
    const std::vector<ovc_ray> primary =
        shared ? own_camera_rays(*scene, wanted) : camera_rays(box, wanted);
    const size_t count = primary.size();
    std::array<std::vector<ovc_hit>, 2> hits{std::vector<ovc_hit>(count),
                                             std::vector<ovc_hit>(count)};
    std::array<std::vector<uint8_t>, 2> occluded{std::vector<uint8_t>(count),
                                                 std::vector<uint8_t>(count)};
    sides[0].intersect(primary, hits[0]);
    const std::vector<ovc_ray> bounced = bounced_rays(box, primary, hits[0]);

    const std::vector<ovc_ray> edges = edge_rays(scene->soup, primary, hits[0]);

    const auto compare = [&](const char* what, size_t rays, auto&& call, const auto& answers) {
        if (rays == 0 || (!only.empty() && only != what))
            return;
        std::vector<double> ratios, cpu_ratios;
        std::array<std::vector<double>, 2> cpu;
        for (int i = 0; i < repeats + 2; ++i) {
            std::array<Cost, 2> costs;
            for (const size_t side : {size_t(i) % 2, 1 - size_t(i) % 2})
                costs[side] = cost_of([&] { call(side); });
            if (i < 2) // these compile kernels and move pages in
                continue;
            ratios.push_back(costs[1].seconds / costs[0].seconds);
            cpu_ratios.push_back(costs[1].cpu_seconds / costs[0].cpu_seconds);
            for (const size_t side : {0, 1})
                cpu[side].push_back(costs[side].cpu_seconds / double(rays) * 1e9);
        }
        fmt::print("{:10} {}, CPU {}; {:.0f} and {:.0f} ns of CPU time a ray\n", what,
                   spread(ratios), spread(cpu_ratios), median(cpu[0]), median(cpu[1]));
        if (std::memcmp(answers[0].data(), answers[1].data(), rays * sizeof(answers[0][0])) != 0)
            fmt::print("{:10} other answers\n", what);
    };
    fmt::print("{}, {} rays: the time of {} to that of {}, by turns; median (quartiles) of {}\n",
               name, count, after, before, repeats);
    compare(
        "primary", count, [&](size_t s) { sides[s].intersect(primary, hits[s]); }, hits);
    compare(
        "diffuse", count, [&](size_t s) { sides[s].intersect(bounced, hits[s]); }, hits);
    compare(
        "occlusion", count, [&](size_t s) { sides[s].occluded(bounced, occluded[s]); }, occluded);
    compare(
        "edges", edges.size(), [&](size_t s) { sides[s].intersect(edges, hits[s]); }, hits);
    return Done{};
}

} // namespace
} // namespace ovc

int main(int count, char** arguments) {
    std::vector<const char*> names;
    size_t rays = 1 << 18;
    int repeats = 101;
    std::string_view only;
    bool shared = false;
    for (int i = 1; i < count; ++i) {
        const std::string argument = arguments[i];
        if (argument == "--rays" && i + 1 < count)
            rays = std::max<size_t>(std::strtoull(arguments[++i], nullptr, 10), 1);
        else if (argument == "--repeats" && i + 1 < count)
            repeats = std::max(std::atoi(arguments[++i]), 1);
        else if (argument == "--only" && i + 1 < count)
            only = arguments[++i];
        else if (argument == "--shared")
            shared = true;
        else
            names.push_back(arguments[i]);
    }
    if (names.size() != 3) {
        fmt::print(stderr, "Usage: paired_calls BEFORE.so AFTER.so SCENE [--rays N] [--repeats N] "
                           "[--only primary|diffuse|occlusion|edges] [--shared]\n");
        return 1;
    }
    const auto done = ovc::run(names[0], names[1], names[2], rays, repeats, only, shared);
    if (!done)
        fmt::print(stderr, "paired_calls: {}\n", done.error().message);
    return done ? 0 : 1;
}
