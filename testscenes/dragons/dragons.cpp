// SPDX-License-Identifier: Apache-2.0
// dragons-N: N dragons on a mirror, the thesis' scalable scene.
#include "testscenes/dragons/stage.h"
#include "testscenes/scenes.h"

#include <algorithm>
#include <string>

namespace ovc {

namespace {

using namespace dragons;

constexpr uint64_t kDragonTriangles = 871'414; // the scanned dragon of Stanford, in the thesis too
constexpr uint32_t kPlaneCells = 320;          // 204,800 triangles: 1,076,214 less one dragon
constexpr double kPlaneHalf = 10;
constexpr double kAcross = 3, kDeep = 1.75; // metres from a dragon to the next
constexpr dvec3 kRoom{2.6, 1.9, 1.3};       // for one dragon

/// Columns and rows of figure 4.1, in the order in which dragons are added.
constexpr int kPlaces[][2] = {{0, 0},  {1, 0},   {-1, 0},  {-1, -1}, {0, -1}, {1, -1}, {1, 1},
                              {0, 1},  {-1, 1},  {-1, -2}, {0, -2},  {1, -2}, {1, 2},  {0, 2},
                              {-1, 2}, {-1, -3}, {0, -3},  {1, -3},  {1, 3},  {0, 3},  {-1, 3}};

dvec3 place_of(uint32_t dragon) {
    return {kAcross * kPlaces[dragon][0], 0, kDeep * kPlaces[dragon][1]};
}

/// The distance that the dragons stretch from the middle.
double reach_of(uint32_t count) {
    double reach = 0;
    for (uint32_t dragon = 0; dragon < count; ++dragon)
        reach = std::max(reach, glm::length(place_of(dragon)));
    return reach + 1.9;
}

} // namespace

CameraPath dragons_path(uint32_t count) {
    return circling_path(reach_of(count));
}

Scene make_dragons(uint32_t count, const Soup* model) {
    static_assert(std::size(kPlaces) == kMaxDragons);
    Scene scene;
    scene.materials.push_back({"mirror", vec3(0.30f, 0.31f, 0.33f), 0.45f});
    scene.materials.push_back({"jade", vec3(0.30f, 0.50f, 0.34f), 0});
    Surface plane =
        make_sheet(kPlaneCells, kPlaneCells, kPlaneHalf, false, [](dvec2) { return 0.0; });
    scene.add_mesh("plane", 0, Chunk::owning(dvec3(0), std::move(plane.corners)));
    Surface dragon = make_model(model, kDragonTriangles, kRoom, false);
    scene.add_mesh("dragon 1", 1, Chunk::owning(place_of(0), std::move(dragon.corners)));
    // The others stand elsewhere and share the first one's memory, which moves with the scene. To
    // a tracer they are triangles of their own all the same: nothing is instanced.
    for (uint32_t i = 1; i < count; ++i)
        scene.add_mesh("dragon " + std::to_string(i + 1), 1,
                       Chunk::borrowing(place_of(i), scene.soup.chunks[1].corners()));
    scene.lights.push_back({dvec3(-9, 16, 11), vec3(3.2f, 3.0f, 2.7f)});
    scene.camera = dragons_path(count)[0];
    return scene;
}

} // namespace ovc
