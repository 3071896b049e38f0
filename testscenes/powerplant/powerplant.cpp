// SPDX-License-Identifier: Apache-2.0
// powerplant: the hall built bay by bay, storey by storey, until the triangles are used up.
#include "testscenes/noise.h"
#include "testscenes/powerplant/plant.h"
#include "testscenes/scenes.h"
#include "testscenes/spline.h"

#include "core/system/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ovc {

namespace {

using namespace powerplant;

/// One piece of the plant that can be built by itself.
struct Task {
    enum Kind { Yard, Rack, WholeBay } kind;
    Bay bay;
};

/// Returns the tasks, from the ground up.
std::vector<Task> tasks_of(const Plan& plan) {
    std::vector<Task> tasks = {{Task::Yard, {}}};
    for (uint32_t storey = 0; storey < plan.storeys; ++storey)
        for (uint32_t z = 0; z < plan.bays_z; ++z) {
            tasks.push_back({Task::Rack, {0, storey, z}});
            for (uint32_t x = 0; x < plan.bays_x; ++x)
                tasks.push_back({Task::WholeBay, {x, storey, z}});
        }
    return tasks;
}

void add_bay(Works& works, const Plan& plan, const Bay& bay) {
    Random random(401, uint64_t(bay.storey) << 40 | uint64_t(bay.z) << 20 | bay.x);
    add_structure(works, plan, bay);
    if (bay.z == plan.aisle())
        return;
    add_cable_trays(works, bay, random);
    if (bay.x == plan.shaft() && bay.z == plan.aisle() + 1)
        return; // the stairs
    add_risers(works, bay, random);
    add_machines(works, bay, random);
}

Works build(const Plan& plan, const Task& task) {
    Works works;
    switch (task.kind) {
    case Task::Yard:
        add_yard(works, plan);
        break;
    case Task::Rack:
        add_pipe_rack(works, plan, task.bay.storey, task.bay.z);
        break;
    case Task::WholeBay:
        add_bay(works, plan, task.bay);
        break;
    }
    return works;
}

using Sizes = std::array<size_t, kPaints>; // in corners, by paint

/// How large each task comes out. Building twice takes a second more and half the memory.
std::vector<Sizes> measure(const Plan& plan, const std::vector<Task>& tasks) {
    std::vector<Sizes> sizes(tasks.size());
    parallel_for(tasks.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
            const Works works = build(plan, tasks[i]);
            for (size_t paint = 0; paint < kPaints; ++paint)
                sizes[i][paint] = works.of[paint].size();
        }
    });
    return sizes;
}

/// Builds the tasks in order as far as `triangles` go; the heap takes the rest.
Works build_all(const Plan& plan, uint64_t triangles) {
    const std::vector<Task> tasks = tasks_of(plan);
    const std::vector<Sizes> sizes = measure(plan, tasks);
    std::vector<Sizes> places; // where each task that is built begins
    Sizes at{};
    uint64_t used = 0;
    for (const Sizes& size : sizes) {
        const uint64_t more = std::accumulate(size.begin(), size.end(), uint64_t(0)) / 3;
        if (used + more > triangles - kMinHeap)
            break;
        used += more;
        places.push_back(at);
        for (size_t paint = 0; paint < kPaints; ++paint)
            at[paint] += size[paint];
    }
    Works whole;
    for (size_t paint = 0; paint < kPaints; ++paint)
        whole.of[paint].resize(at[paint]);
    parallel_for(places.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
            const Works works = build(plan, tasks[i]);
            for (size_t paint = 0; paint < kPaints; ++paint)
                std::ranges::copy(works.of[paint],
                                  whole.of[paint].begin() + ptrdiff_t(places[i][paint]));
        }
    });
    add_coal_heap(whole, plan, triangles - used);
    return whole;
}

struct Look {
    const char* name;
    vec3 color;
};

constexpr Look kLooks[kPaints] = {
    {"concrete", {0.42f, 0.41f, 0.39f}},    {"steel", {0.36f, 0.38f, 0.41f}},
    {"grating", {0.30f, 0.31f, 0.32f}},     {"rails", {0.85f, 0.62f, 0.06f}},
    {"sheet", {0.55f, 0.62f, 0.68f}},       {"lagging", {0.70f, 0.71f, 0.72f}},
    {"water pipes", {0.10f, 0.38f, 0.20f}}, {"fire pipes", {0.66f, 0.08f, 0.05f}},
    {"gas pipes", {0.75f, 0.55f, 0.10f}},   {"oil pipes", {0.40f, 0.23f, 0.12f}},
    {"machines", {0.13f, 0.30f, 0.42f}},    {"cables", {0.05f, 0.05f, 0.06f}},
    {"brass", {0.55f, 0.38f, 0.18f}},       {"panes", {0.50f, 0.60f, 0.65f}},
    {"coal", {0.06f, 0.06f, 0.07f}},
};

/// One mesh a paint.
void add_meshes(Scene& scene, Works works) {
    for (size_t paint = 0; paint < kPaints; ++paint) {
        if (works.of[paint].empty())
            continue;
        scene.materials.push_back({kLooks[paint].name, kLooks[paint].color, 0});
        scene.add_mesh(kLooks[paint].name, uint32_t(scene.materials.size() - 1),
                       Chunk::owning(dvec3(0), std::move(works.of[paint])));
    }
}

/// The sun, four lamps in rooms of their own, one on the camera.
std::vector<Light> lights_of(const Plan& plan) {
    const double z = kBay * (plan.aisle() + 0.5),
                 upper = kStorey * (std::min(3u, plan.storeys - 1));
    const double west = 0.5 * kBay * plan.first_wall(), east = plan.length() - west;
    const double middle = 0.5 * plan.length(), up = 3.1;
    const vec3 lamp(1.7f, 1.55f, 1.25f);
    return {{dvec3(-0.9, 1.6, 1.4) * (200 + plan.length()), vec3(3.0f, 2.8f, 2.4f)},
            {dvec3(east, up, z), lamp},
            {dvec3(middle - 3.5, up, z), lamp},
            {dvec3(middle + 3.5, upper + up, z), lamp},
            {dvec3(west, upper + up, z), lamp},
            {dvec3(0, 0.25, 0), vec3(0.9f, 0.9f, 0.95f), true}};
}

struct View {
    dvec3 eye, target;
};
View operator+(const View& a, const View& b) {
    return {a.eye + b.eye, a.target + b.target};
}
View operator*(double s, const View& a) {
    return {s * a.eye, s * a.target};
}

/// From outside round to the other side, in by the door, through the rooms, up the shaft, and
/// through the rooms there; standing still to look round where points repeat.
std::vector<View> walk(const Plan& plan) {
    const double z = kBay * (plan.aisle() + 0.5), length = plan.length();
    const double reach = plan.length() + plan.depth(), eye = 1.8;
    const double upper = kStorey * (std::min(3u, plan.storeys - 1)) + eye;
    const double middle = kBay * (plan.shaft() + 0.5), far = 0.5 * kBay * plan.first_wall();
    const dvec3 centre(0.5 * length, 0.4 * plan.height(), 0.5 * plan.depth());
    std::vector<View> views;
    for (int i = 0; i <= 8; ++i) { // outside, a good half circle
        const dvec2 c = circle(0.42 - 0.42 * i / 8);
        const double close = 1.25 - 0.045 * i;
        views.push_back({{centre.x + close * reach * c.x, plan.height() * (0.9 - 0.085 * i) + 3,
                          centre.z + close * reach * c.y},
                         centre});
    }
    const auto go = [&](double x, double y, dvec3 towards) {
        views.push_back({{x, y, z}, dvec3(x, y, z) + towards});
    };
    const dvec3 west(-8, -0.3, 0), north(-3, 0.6, -6), south(-3, 0.3, 6), up(-3, 5, 0);
    go(length + 18, 4, west);
    go(length + 8, eye, west);
    go(length - 4, eye, west);
    go(length - far, eye, north);
    go(length - far, eye, south);
    go(length - far - 1, eye, west);
    go(kBay * plan.second_wall() + 1, eye, west);
    go(middle + 4, eye, west);
    go(middle + 0.5, eye, up);
    go(middle, eye + 1, up);
    go(middle, std::max(upper - 3, eye + 1), south); // not below a plant of one storey
    go(middle, upper, dvec3(2, 0, 7));
    go(middle, upper, dvec3(7, -0.5, 1));
    go(middle, upper, dvec3(1, -1, -7));
    go(middle - 3, upper, west);
    go(kBay * plan.first_wall() + 1, upper, west);
    go(far + 2, upper, west);
    go(far, upper, north);
    go(far, upper, dvec3(6, -0.5, -4));
    go(far, upper, dvec3(8, -0.4, 1));
    return views;
}

} // namespace

powerplant::Plan powerplant::plan_for(uint64_t triangles) {
    constexpr double kYard =
        100'000; // as measured, and per bay: what all have, and all but the aisle
    constexpr double kAnyBay = 9'800, kFullBay = 30'000;
    const double scale = std::cbrt(double(triangles) / kPowerplantTriangles);
    Plan plan{};
    plan.bays_x = std::clamp(uint32_t(9 * scale + 0.5), 3u, 16u);
    plan.bays_z = std::clamp(uint32_t(5 * scale + 0.5), 3u, 10u);
    const double floor = plan.bays_x * (plan.bays_z * kAnyBay + (plan.bays_z - 1) * kFullBay);
    plan.storeys = uint32_t(std::max(1.0, 0.985 * (double(triangles) - kYard) / floor));
    return plan;
}

CameraPath powerplant_path(uint32_t triangles) {
    constexpr uint32_t kFrames = 275;
    const std::vector<View> views = walk(plan_for(triangles));
    CameraPath path(kFrames);
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
        const View view = spline_at<View>(views, double(frame) / (kFrames - 1));
        path[frame].eye = view.eye;
        path[frame].target = view.target;
        path[frame].fov_degrees = 60;
    }
    return path;
}

Scene make_powerplant(uint32_t triangles) {
    const uint64_t even = triangles / 2 * 2;
    const Plan plan = plan_for(even);
    Scene scene;
    add_meshes(scene, build_all(plan, even));
    scene.lights = lights_of(plan);
    scene.camera = powerplant_path(triangles)[0];
    return scene;
}

} // namespace ovc
