// SPDX-License-Identifier: Apache-2.0
// The plants scene: prototypes, put where they stand, every instance expanded into triangles of its
// own.
#include "testscenes/scenes.h"

#include "core/system/parallel.h"
#include "testscenes/noise.h"
#include "testscenes/plants/ground.h"
#include "testscenes/plants/landscape.h"
#include "testscenes/plants/placement.h"

#include <algorithm>
#include <cmath>

namespace ovc {

namespace {

using namespace plants;

// Each for plants beyond kFarther times their fine distance.
constexpr double kDetails[] = {1, 0.42, 0.14, 0.042, 0.009};
constexpr double kFarther[] = {0, 1, 2.1, 4.4, 9};
constexpr size_t kDetailLevels = std::size(kDetails);

/// Prototypes of all species, variants and details.
class Nursery {
public:
    explicit Nursery(double detail) {
        std::vector<uint32_t> owner; // the species of a prototype
        for (uint32_t s = 0; s < species().size(); ++s) {
            first_.push_back(uint32_t(owner.size()));
            owner.insert(owner.end(), species()[s].variants * kDetailLevels, s);
        }
        prototypes_.resize(owner.size());
        parallel_for(owner.size(), 1, [&](size_t begin, size_t end) {
            for (size_t p = begin; p < end; ++p) {
                const size_t number = p - first_[owner[p]];
                const Random random(100 + owner[p], number / kDetailLevels);
                prototypes_[p] =
                    species()[owner[p]].make(random, detail * kDetails[number % kDetailLevels]);
            }
        });
    }

    const Prototype& of(const Plant& plant) const {
        const size_t kind = size_t(plant.kind);
        const double distance = glm::length(dvec2(plant.at.x, plant.at.z) - kViewpoint) /
                                (species()[kind].fine_distance * std::max(0.7, plant.size));
        size_t level = kDetailLevels - 1;
        while (distance < kFarther[level])
            --level;
        return prototypes_[first_[kind] + plant.variant * kDetailLevels + level];
    }

private:
    std::vector<uint32_t> first_; // of a species
    std::vector<Prototype> prototypes_;
};

/// Copies of prototype parts that make up one mesh.
struct MeshPlan {
    std::string name;
    vec3 color;
    struct Copy {
        const Corners* corners;
        const Plant* plant;
        size_t at; // the copy's first corner in the mesh
    };
    std::vector<Copy> copies;
    size_t corners = 0;
};

void add_copy(MeshPlan& mesh, const Corners& corners, const Plant& plant) {
    if (corners.empty())
        return;
    mesh.copies.push_back({&corners, &plant, mesh.corners});
    mesh.corners += corners.size();
}

std::vector<MeshPlan> plan_meshes(const std::vector<Plant>& plants, const Nursery& nursery) {
    std::vector<MeshPlan> meshes;
    std::vector<size_t> first;
    for (const Species& s : species()) {
        first.push_back(meshes.size());
        meshes.push_back({std::string(s.name) + " wood", s.wood});
        meshes.push_back({std::string(s.name) + " accent", s.accent});
        for (size_t tint = 0; tint < s.tints.size(); ++tint)
            meshes.push_back({std::string(s.name) + " " + std::to_string(tint + 1), s.tints[tint]});
    }
    for (const Plant& plant : plants) {
        const Prototype& prototype = nursery.of(plant);
        MeshPlan* of_species = &meshes[first[size_t(plant.kind)]];
        add_copy(of_species[0], prototype[Part::Wood], plant);
        add_copy(of_species[1], prototype[Part::Accent], plant);
        add_copy(of_species[2 + plant.tint], prototype[Part::Tinted], plant);
    }
    std::erase_if(meshes, [](const MeshPlan& mesh) { return mesh.copies.empty(); });
    return meshes;
}

Corners expand(const MeshPlan& mesh) {
    Corners out(mesh.corners);
    parallel_for(mesh.copies.size(), 16, [&](size_t first, size_t last) {
        for (size_t c = first; c < last; ++c) {
            const MeshPlan::Copy& copy = mesh.copies[c];
            const dvec2 turn = copy.plant->size * circle(copy.plant->turn);
            vec3* to = out.data() + copy.at;
            for (const vec3& from : *copy.corners)
                *to++ = vec3(copy.plant->at + dvec3(turn.x * from.x + turn.y * from.z,
                                                    copy.plant->size * from.y,
                                                    turn.x * from.z - turn.y * from.x));
        }
    });
    return out;
}

void add_mesh(Scene& scene, std::string name, vec3 color, float mirror, Corners corners) {
    if (corners.empty())
        return;
    scene.materials.push_back({name, color, mirror});
    scene.add_mesh(std::move(name), uint32_t(scene.materials.size() - 1),
                   Chunk::owning(dvec3(0), std::move(corners)));
}

void add_land(Scene& scene, double detail) {
    constexpr struct {
        const char* name;
        vec3 color;
    } kCoverLooks[kCovers] = {
        {"mud", {0.10f, 0.075f, 0.045f}},        {"sand", {0.36f, 0.29f, 0.19f}},
        {"meadow", {0.12f, 0.20f, 0.04f}},       {"dry meadow", {0.22f, 0.24f, 0.07f}},
        {"forest floor", {0.09f, 0.11f, 0.04f}}, {"stone", {0.27f, 0.25f, 0.22f}},
        {"far wood", {0.10f, 0.16f, 0.11f}},     {"far ridge", {0.23f, 0.29f, 0.34f}},
    };
    std::array<Corners, kCovers> ground =
        make_ground(std::max(60u, uint32_t(720 * std::sqrt(detail))));
    for (size_t cover = 0; cover < kCovers; ++cover)
        add_mesh(scene, kCoverLooks[cover].name, kCoverLooks[cover].color, 0,
                 std::move(ground[cover]));
    add_mesh(scene, "water", {0.02f, 0.05f, 0.07f}, 0.6f, make_water());
}

} // namespace

Scene make_plants(uint32_t size) {
    // A smaller scene has fewer plants, and each a little fewer triangles.
    const double share = size / kPlantsDemoSize;
    const double fewer = std::sqrt(std::sqrt(share));
    const Nursery nursery(fewer);
    const std::vector<Plant> plants = place_plants(share / fewer);

    Scene scene;
    add_land(scene, share);
    for (const MeshPlan& mesh : plan_meshes(plants, nursery))
        add_mesh(scene, mesh.name, mesh.color, 0, expand(mesh));

    scene.lights.push_back({dvec3(6300, 3000, 3600), vec3(5.6f, 4.2f, 2.6f)});
    const double eye_height = ground_height(kViewpoint) + 2.3;
    scene.camera = Camera{dvec3(kViewpoint.x, eye_height, kViewpoint.y),
                          dvec3(-9, eye_height - 2.6, -40), dvec3(0, 1, 0), 42};
    scene.background = {vec3(0.66f, 0.72f, 0.78f), vec3(0.0f, 0.13f, 0.60f)};
    return scene;
}

} // namespace ovc
