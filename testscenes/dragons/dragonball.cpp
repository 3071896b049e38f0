// SPDX-License-Identifier: Apache-2.0
// dragonball: the largest scanned dragon between a mirror ball, a glass ball and a lens, over
// waves.
#include "testscenes/dragons/stage.h"
#include "testscenes/noise.h"
#include "testscenes/scenes.h"

namespace ovc {

namespace {

using namespace dragons;

constexpr uint64_t kLargeDragonTriangles = 7'219'045; // the XYZ RGB dragon of Stanford
constexpr uint32_t kWavesAcross = 205, kWavesDeep = 208;
constexpr TubeGrid kBall{142, 71};
static_assert(kLargeDragonTriangles + 2 * kWavesAcross * kWavesDeep + 3 * 2 * 142 * 71 ==
              7'364'817);
constexpr double kWaterHalf = 7;

double waves(dvec2 at) {
    const double swell = 0.035 * circle(0.55 * at.x + 0.21 * at.y).y;
    const double cross = 0.025 * circle(0.35 * at.x - 0.62 * at.y).y;
    return swell + cross + 0.05 * fractal_noise(at * 1.1, 3, 231) - 0.12;
}

/// A ball squeezed along z.
Surface ball(double radius, double half_thickness) {
    Surface surface;
    add_tube(surface, kBall, true, [&](uint32_t ring, double turns) {
        const dvec2 latitude = circle(0.5 * ring / (kBall.along + 1) - 0.25);
        const dvec2 c = circle(turns);
        return dvec3(radius * latitude.x * c.x, radius * latitude.x * c.y,
                     half_thickness * latitude.y);
    });
    return surface;
}

void add(Scene& scene, Material material, dvec3 origin, Surface surface) {
    const std::string name = material.name;
    scene.materials.push_back(std::move(material));
    scene.add_mesh(name, uint32_t(scene.materials.size() - 1),
                   Chunk::owning(origin, std::move(surface.corners)), std::move(surface.normals));
}

} // namespace

CameraPath dragonball_path() {
    return circling_path(2.8);
}

Scene make_dragonball(const Soup* model) {
    Scene scene;
    add(scene, {"dragon", vec3(0.72f, 0.53f, 0.20f), 0}, dvec3(0),
        make_model(model, kLargeDragonTriangles, {3.1, 2.2, 1.5}, true));
    add(scene, {"waves", vec3(0.04f, 0.09f, 0.11f), 0.6f}, dvec3(0),
        make_sheet(kWavesAcross, kWavesDeep, kWaterHalf, true, waves));
    add(scene, {"mirror ball", vec3(0.75f, 0.10f, 0.07f), 0.6f}, {-1.0, 0.68, 1.5},
        ball(0.65, 0.65));
    Material glass{"glass ball", vec3(0.1f, 0.2f, 0.6f), 0.06f};
    glass.transmission = 0.88f;
    glass.filter = vec3(0.72f, 0.82f, 1.0f);
    glass.ior = 1.5;
    add(scene, glass, {1.0, 0.68, -1.45}, ball(0.65, 0.65));
    Material lens{"lens", vec3(0.5f), 0.04f};
    lens.transmission = 0.94f;
    lens.ior = 1.45;
    add(scene, lens, {0.9, 0.62, 1.75}, ball(0.5, 0.14));
    scene.lights.push_back({dvec3(-6, 11, 8), vec3(3.2f, 3.0f, 2.7f)});
    scene.camera = dragonball_path()[0];
    return scene;
}

} // namespace ovc
