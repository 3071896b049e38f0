// SPDX-License-Identifier: Apache-2.0
// updates_cost SCENE [--moves] [--calls] [--repeats N] measures the cost of changing a scene
// through the ABI beside that of building it anew, and of calls after a hundred changes beside
// calls of a new scene, for docs/benchmarks.md. All take turns, and medians are printed. --moves:
// meshes are added with OVC_MESH_MOVES. --calls: only calls are compared.
#include "core/system/stopwatch.h"
#include "host/bench/ray_sets.h"
#include "host/camera/camera.h"
#include "host/scene/scene_source.h"
#include "host/scene/scene_summary.h"
#include "tests/abi/abi_scene.h"
#include "testscenes/random.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>

namespace ovc {
namespace {

using test::AbiScene;
using test::api;
using test::sized;

void must(ovc_result result) {
    if (result == OVC_OK)
        return;
    fmt::print(stderr, "a call failed with {}\n", int(result));
    std::exit(1);
}

/// A mesh of the scene in floats around its origin, and the transforms of its instances.
struct Mesh {
    std::vector<vec3> corners;
    dvec3 origin;
    std::vector<Transform> places; // If there is only one, the mesh itself is placed there.
};

std::vector<Mesh> meshes_of(const Soup& soup) {
    std::vector<Mesh> meshes;
    std::map<Chunk::MeshKey, size_t> found;
    for (const Chunk& chunk : soup.chunks) {
        if (chunk.size() == 0)
            continue;
        const auto [at, is_new] = found.try_emplace(chunk.mesh_key(), meshes.size());
        if (is_new)
            meshes.push_back(
                {{chunk.corners().begin(), chunk.corners().end()}, chunk.origin(), {}});
        meshes[at->second].places.push_back(or_identity(chunk.transform()));
    }
    return meshes;
}

/// A scene of these meshes that changes.
class Changing {
public:
    Changing(const test::Device& device, const std::vector<Mesh>& meshes, bool moves)
        : meshes_(meshes), now_(meshes) {
        auto config = sized<ovc_scene_config>();
        ovc_scene scene = nullptr;
        must(api().create_scene(device.get(), &config, &scene));
        scene_.reset(scene);
        for (const Mesh& mesh : meshes) {
            const bool is_placed_once = mesh.places.size() == 1;
            auto given = given_of(mesh, mesh.corners);
            given.flags = is_placed_once ? (moves ? OVC_MESH_MOVES : 0) : OVC_MESH_TEMPLATE;
            if (is_placed_once)
                given.transform = mesh.places[0].rows[0].data();
            uint32_t number = 0;
            must(api().add_mesh(scene, &given, &number));
            numbers_.push_back(number);
            if (is_placed_once)
                placed_.push_back(number);
            for (size_t i = 0; i < mesh.places.size() && !is_placed_once; ++i) {
                auto instance = sized<ovc_instance>();
                instance.mesh = number;
                instance.transform = mesh.places[i].rows[0].data();
                must(api().add_instance(scene, &instance, &number));
                placed_.push_back(number);
            }
        }
        commit();
    }

    void commit() { must(api().commit(scene_.get())); }

    struct Moved {
        size_t first; // the number of the first triangle
        std::vector<vec3> corners;
    };
    /// Returns the corners of `part` of each mesh's triangles, moved by the wind of that time.
    std::vector<Moved> blown(double part, double time) const {
        std::vector<Moved> all;
        for (const Mesh& mesh : meshes_) {
            const size_t triangles = mesh.corners.size() / 3;
            const size_t count = std::max<size_t>(size_t(part * double(triangles)), 1);
            const size_t first = size_t(std::abs(std::sin(100 * time)) * double(triangles - count));
            const auto begin = mesh.corners.begin() + ptrdiff_t(3 * first);
            all.push_back({first, {begin, begin + ptrdiff_t(3 * count)}});
            for (vec3& p : all.back().corners)
                p.y += 0.02f * std::sin(3 * p.x + float(time));
        }
        return all;
    }
    void move_corners(const std::vector<Moved>& moved) {
        for (size_t m = 0; m < meshes_.size(); ++m) {
            const ovc_mesh given = given_of(meshes_[m], moved[m].corners);
            must(api().update_mesh(scene_.get(), numbers_[m], &given, moved[m].first));
            std::ranges::copy(moved[m].corners,
                              now_[m].corners.begin() + ptrdiff_t(3 * moved[m].first));
        }
    }

    /// Moves all meshes and instances.
    void move_places(double time) {
        size_t next = 0;
        for (size_t m = 0; m < meshes_.size(); ++m)
            for (size_t i = 0; i < meshes_[m].places.size(); ++i) {
                Transform place = meshes_[m].places[i];
                place.rows[1][3] += 0.1 * std::sin(time + double(next));
                now_[m].places[i] = place;
                must(api().update_instance(scene_.get(), placed_[next++], place.rows[0].data()));
            }
    }

    /// Returns the meshes as they are now.
    const std::vector<Mesh>& now() const { return now_; }

    const AbiScene& scene() const { return scene_; }

private:
    static ovc_mesh given_of(const Mesh& mesh, const std::vector<vec3>& corners) {
        auto given = sized<ovc_mesh>();
        given.positions = &corners.data()->x;
        given.vertex_count = corners.size();
        for (int axis = 0; axis < 3; ++axis)
            given.origin[axis] = mesh.origin[axis];
        return given;
    }

    const std::vector<Mesh>& meshes_; // the meshes before any change
    std::vector<Mesh> now_;
    AbiScene scene_;
    std::vector<uint32_t> numbers_; // the numbers of the meshes
    std::vector<uint32_t> placed_;  // the numbers of meshes and instances that have a place
};

double seconds_of(const std::function<void()>& work) {
    const Stopwatch watch;
    work();
    return watch.seconds();
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

/// Counts what calls of a scene take, and what they leave to the CPU.
class CallCost {
public:
    explicit CallCost(const AbiScene& scene) : scene_(scene) {}

    std::vector<ovc_hit> trace(const std::vector<Ray>& rays) {
        const ovc_statistics before = test::statistics(scene_);
        std::vector<ovc_hit> hits;
        calls_.push_back(seconds_of([&] { hits = test::answers(scene_, rays); }));
        const ovc_statistics after = test::statistics(scene_);
        kernel_.push_back(after.seconds_kernel - before.seconds_kernel);
        flagged_ = double(after.flagged - before.flagged) / double(rays.size());
        return hits;
    }

    const std::vector<double>& calls() const { return calls_; }
    void print(const char* name) const {
        fmt::print("{:22} {:10.1f} {:10.1f} {:10.1f} {:9.2f}%\n", name, 1e3 * median(calls_),
                   1e3 * calls_.front(), 1e3 * median(kernel_), 100 * flagged_);
    }

private:
    const AbiScene& scene_;
    std::vector<double> calls_, kernel_; // seconds of each call
    double flagged_ = 0;                 // the share of the rays
};

/// Compares the times of calls with the same rays, across a box and towards points in it.
void compare_calls(const AbiScene& changed, const AbiScene& fresh, const Box& box, int repeats) {
    Random random(1);
    const auto point = [&](double reach) {
        const dvec3 at{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        return box.center() + reach * box.extent() * at;
    };
    std::vector<Ray> rays;
    for (int i = 0; i < 1 << 18; ++i) {
        const dvec3 org = point(1.5);
        rays.push_back({org, 0, point(0.4) - org});
    }
    CallCost mine(changed), other(fresh);
    std::vector<double> ratios;
    for (int i = 0; i < 2 * repeats + 1; ++i) {
        const std::vector<ovc_hit> a = mine.trace(rays), b = other.trace(rays);
        ratios.push_back(mine.calls().back() / other.calls().back());
        if (std::memcmp(a.data(), b.data(), a.size() * sizeof(ovc_hit)) != 0)
            fmt::print("other answers\n");
    }
    fmt::print("{} rays a call {:>18} {:>10} {:>10} {:>10}\n", rays.size(), "ms", "first", "kernel",
               "flagged");
    mine.print("after 100 updates");
    other.print("new");
    fmt::print("calls after 100 more updates: {:.2f} times as long as a new scene's\n",
               median(ratios));
}

/// Prints what changes of the scene cost beside building it anew.
void compare_updates(const std::string& name, const test::Device& device, Changing& changing,
                     const std::vector<Mesh>& meshes, bool moves, int repeats) {
    std::map<std::string, std::vector<double>> times;
    for (int i = 0; i < repeats; ++i) {
        times["0 anew"].push_back(seconds_of([&] { Changing(device, meshes, moves); }));
        const double time = 0.37 * (i + 1);
        const auto measure = [&](const char* what, const std::function<void()>& change) {
            times[what].push_back(seconds_of([&] {
                change();
                changing.commit();
            }));
        };
        const auto all = changing.blown(1, time), some = changing.blown(0.01, time + 1),
                   others = changing.blown(0.01, time + 2);
        measure("1 all positions", [&] { changing.move_corners(all); });
        measure("2 1 % of positions", [&] { changing.move_corners(some); });
        measure("3 all transforms", [&] { changing.move_places(time); });
        measure("4 1 % after these", [&] { changing.move_corners(others); });
    }
    const double anew = median(times["0 anew"]);
    fmt::print("{}, {} meshes; medians of {}\n{:22} {:>10} {:>10} {:>10}\n", name, meshes.size(),
               repeats, "", "ms", "of anew", "first");
    for (const auto& [what, values] : times)
        fmt::print("{:22} {:10.1f} {:>10} {:10.1f}\n", what.substr(2), 1e3 * median(values),
                   fmt::format("1/{:.1f}", anew / median(values)), 1e3 * values.front());
}

Result<Done> run(const std::string& name, bool moves, bool only_calls, int repeats) {
    Result<Scene> scene = open_scene(name, standard_error_log(LogLevel::Warning));
    if (!scene)
        return scene.error();
    const std::vector<Mesh> meshes = meshes_of(scene->soup);
    const test::Device device = test::open_device();
    Changing changing(device, meshes, moves);
    if (!only_calls)
        compare_updates(name, device, changing, meshes, moves, repeats);
    for (int i = 0; i < 100; ++i) {
        const double time = 1.7 * i;
        if (i % 4 == 0)
            changing.move_places(time);
        changing.move_corners(changing.blown(i % 10 == 0 ? 1 : 0.01 * (1 + i % 5), time));
        changing.commit();
    }
    const ovc_statistics told = test::statistics(changing.scene());
    fmt::print("{} updates, {} pages refitted, {} built\n", told.updates, told.pages_refitted,
               told.pages_rebuilt);
    compare_calls(changing.scene(), Changing(device, changing.now(), moves).scene(),
                  hittable_bounds(scene->soup), repeats);
    return Done{};
}

} // namespace
} // namespace ovc

int main(int count, char** arguments) {
    std::string scene;
    bool moves = false, only_calls = false;
    int repeats = 5;
    for (int i = 1; i < count; ++i) {
        const std::string argument = arguments[i];
        if (argument == "--moves")
            moves = true;
        else if (argument == "--calls")
            only_calls = true;
        else if (argument == "--repeats" && i + 1 < count)
            repeats = std::max(std::atoi(arguments[++i]), 1);
        else
            scene = argument;
    }
    const auto done = ovc::run(scene, moves, only_calls, repeats);
    if (!done)
        fmt::print(stderr, "updates_cost: {}\n", done.error().message);
    return done ? 0 : 1;
}
