// SPDX-License-Identifier: Apache-2.0
// Instances through the ABI beside the same triangles moved by hand: a scene, rays at it, and
// comparisons of the two.
#pragma once

#include "kdtree/test_soups.h"
#include "tests/abi/abi_scene.h"
#include "tests/exact.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace ovc::test {

using Matrix = std::array<double, 12>;

/// Moves a point as overcast.h defines it.
inline dvec3 moved(const Matrix& m, const dvec3& p) {
    dvec3 q;
    for (int row = 0; row < 3; ++row) {
        const double* r = &m[size_t(4 * row)];
        q[row] = ((r[0] * p.x + r[1] * p.y) + r[2] * p.z) + r[3];
    }
    return q;
}

inline Matrix product(const Matrix& second, const Matrix& first) {
    Matrix both{};
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 4; ++j) {
            const double* r = &second[4 * i];
            both[4 * i + j] = (r[0] * first[j] + r[1] * first[4 + j]) + r[2] * first[8 + j];
            if (j == 3)
                both[4 * i + j] += r[3];
        }
    return both;
}

inline Matrix shift(const dvec3& by) {
    return {1, 0, 0, by.x, 0, 1, 0, by.y, 0, 0, 1, by.z};
}

inline Matrix scale(const dvec3& by) {
    return {by.x, 0, 0, 0, 0, by.y, 0, 0, 0, 0, by.z, 0};
}

/// Returns any affine map, such as a rotation, a shear or a mirror.
inline Matrix any_transform(Random& random, double reach) {
    Matrix m;
    for (size_t i = 0; i < 12; ++i)
        m[i] = random.point(-1, 1).x * (i % 4 == 3 ? reach : 1);
    return m;
}

/// A scene behind the ABI, and its triangles at the places that overcast.h defines, mesh by mesh.
class World {
public:
    World(ovc_device device, const ovc_scene_config& config) : device_(device) {
        ovc_scene created = nullptr;
        EXPECT_EQ(api().create_scene(device, &config, &created), OVC_OK);
        scene.reset(created);
    }

    uint32_t add(const std::vector<vec3>& positions, const dvec3& origin, const Matrix* m,
                 uint32_t flags = 0) {
        auto mesh = sized<ovc_mesh>();
        mesh.positions = &positions[0].x;
        return add(mesh, {positions.begin(), positions.end()}, origin, m, flags);
    }
    uint32_t add(const std::vector<dvec3>& positions, const dvec3& origin, const Matrix* m,
                 uint32_t flags = 0) {
        auto mesh = sized<ovc_mesh>();
        mesh.positions_double = &positions[0].x;
        return add(mesh, positions, origin, m, flags);
    }
    uint32_t instance(uint32_t mesh, const Matrix* m) {
        auto given = sized<ovc_instance>();
        given.mesh = mesh;
        given.transform = m ? m->data() : nullptr;
        uint32_t number = OVC_NONE;
        EXPECT_EQ(api().add_instance(scene.get(), &given, &number), OVC_OK) << error();
        const Matrix first = transforms_.count(mesh) ? transforms_[mesh] : shift(dvec3(0));
        const bool has_both = m && transforms_.count(mesh);
        if (m)
            transforms_[number] = has_both ? product(*m, first) : *m;
        else if (transforms_.count(mesh))
            transforms_[number] = first;
        if (transforms_.count(mesh))
            firsts_[number] = first;
        things_.push_back(things_[mesh]);
        things_.back().is_there = true;
        things_.back().is_instance = true;
        expected.chunks.push_back(expect(number));
        return number;
    }

    uint32_t count() const { return uint32_t(things_.size()); }
    bool is_removed(uint32_t number) const { return things_[number].mesh == OVC_NONE; }
    bool is_instance(uint32_t number) const { return things_[number].is_instance; }
    uint64_t triangles(uint32_t number) const {
        return sources_.at(things_[number].mesh).size() / 3;
    }

    const std::vector<dvec3>& source(uint32_t mesh) const { return sources_.at(mesh); }
    const dvec3& origin(uint32_t number) const { return things_[number].origin; }

    /// Gives triangles of a mesh new corners, in floats if the mesh has floats.
    void move_corners(uint32_t number, size_t first, const std::vector<dvec3>& corners) {
        const Thing& thing = things_[number];
        auto mesh = sized<ovc_mesh>();
        const std::vector<vec3> floats(corners.begin(), corners.end());
        if (thing.has_doubles)
            mesh.positions_double = &corners[0].x;
        else
            mesh.positions = &floats[0].x;
        mesh.vertex_count = corners.size();
        for (int axis = 0; axis < 3; ++axis)
            mesh.origin[axis] = thing.origin[axis];
        ASSERT_EQ(api().update_mesh(scene.get(), number, &mesh, first), OVC_OK) << error();
        for (size_t i = 0; i < corners.size(); ++i)
            sources_[number][3 * first + i] =
                thing.origin + (thing.has_doubles ? corners[i] : dvec3(floats[i]));
        for (uint32_t other = 0; other < count(); ++other)
            if (things_[other].mesh == number)
                expected.chunks[other] = expect(other);
    }
    void move(uint32_t number, const Matrix* m) {
        ASSERT_EQ(api().update_instance(scene.get(), number, m ? m->data() : nullptr), OVC_OK)
            << error();
        transforms_.erase(number);
        if (firsts_.count(number))
            transforms_[number] = m ? product(*m, firsts_[number]) : firsts_[number];
        else if (m)
            transforms_[number] = *m;
        expected.chunks[number] = expect(number);
    }
    void remove(uint32_t number) {
        ASSERT_EQ(api().remove_mesh(scene.get(), number), OVC_OK) << error();
        things_[number] = {};
        expected.chunks[number] = expect(number);
    }

    void commit() { ASSERT_EQ(api().commit(scene.get()), OVC_OK) << error(); }

    std::vector<Hit> intersect(const std::vector<Ray>& rays,
                               const ovc_query* query = nullptr) const {
        const std::vector<ovc_hit> answered = answers(scene, rays, query);
        std::vector<Hit> hits(rays.size());
        std::memcpy(static_cast<void*>(hits.data()), answered.data(), rays.size() * sizeof(Hit));
        return hits;
    }
    ovc_statistics statistics() const {
        auto statistics = sized<ovc_statistics>();
        EXPECT_EQ(api().statistics(scene.get(), &statistics), OVC_OK) << error();
        return statistics;
    }
    std::string error() const { return api().last_error(device_); }

    AbiScene scene;
    Soup expected;

private:
    uint32_t add(ovc_mesh& mesh, std::vector<dvec3> positions, const dvec3& origin, const Matrix* m,
                 uint32_t flags) {
        mesh.vertex_count = positions.size();
        mesh.flags = flags;
        mesh.transform = m ? m->data() : nullptr;
        for (int axis = 0; axis < 3; ++axis)
            mesh.origin[axis] = origin[axis];
        uint32_t number = OVC_NONE;
        EXPECT_EQ(api().add_mesh(scene.get(), &mesh, &number), OVC_OK) << error();
        for (dvec3& p : positions)
            p = origin + p;
        sources_[number] = std::move(positions);
        if (m)
            transforms_[number] = *m;
        things_.push_back(
            {number, origin, mesh.positions_double != nullptr, !(flags & OVC_MESH_TEMPLATE)});
        expected.chunks.push_back(expect(number));
        return number;
    }
    Chunk expect(uint32_t number) {
        EXPECT_LT(number, things_.size()) << "numbered in the order they are added";
        std::vector<dvec3> corners;
        if (things_[number].is_there)
            corners = sources_[things_[number].mesh];
        if (transforms_.count(number))
            for (dvec3& p : corners)
                p = moved(transforms_[number], p);
        return Chunk::owning_doubles(dvec3(0), std::move(corners));
    }

    /// A mesh or an instance of one.
    struct Thing {
        uint32_t mesh = OVC_NONE; // OVC_NONE after it is removed
        dvec3 origin{0};
        bool has_doubles = false;
        bool is_there = false; // false for templates and removed ones
        bool is_instance = false;
    };

    ovc_device device_;
    std::vector<Thing> things_;
    /// The corners as overcast.h defines them, without transforms.
    std::map<uint32_t, std::vector<dvec3>> sources_;
    std::map<uint32_t, Matrix> transforms_;
    /// The transforms by which the meshes of instances were placed.
    std::map<uint32_t, Matrix> firsts_;
};

template <class Corner>
std::vector<Corner> random_corners(Random& random, size_t triangles, double size) {
    std::vector<Corner> corners;
    for (size_t i = 0; i < triangles; ++i) {
        const dvec3 middle = random.point(-1, 1);
        for (int c = 0; c < 3; ++c)
            corners.push_back(Corner(middle + size * random.point(-1, 1)));
    }
    return corners;
}

/// Returns rays from all around at corners, sides and inner points of a soup's triangles.
inline std::vector<Ray> rays_at(const Soup& soup, size_t count, uint64_t seed) {
    Random random(seed);
    Box bounds;
    const std::vector<TriangleId> ids = hittable_triangles(soup, nullptr, &bounds);
    std::vector<Ray> rays;
    for (size_t i = 0; i < count; ++i) {
        const Triangle t = soup.triangle(ids[random.below(uint32_t(ids.size()))]);
        dvec3 weights = random.point(0, 1);
        weights.x = i % 4 < 1 ? 0 : weights.x;
        weights.y = i % 8 < 1 ? 0 : weights.y;
        weights /= weights.x + weights.y + weights.z;
        const dvec3 target = weights.x * t[0] + weights.y * t[1] + weights.z * t[2];
        const dvec3 org = bounds.center() + max_component(bounds.extent()) * random.point(-1, 1);
        rays.push_back({org, 0, target - org});
    }
    return rays;
}

/// Expects, bit for bit, the answers of testing every triangle, and for the first `exactly` rays
/// those of exact rationals.
inline void expect_brute_force(const World& world, const std::vector<Ray>& rays, size_t exactly,
                               bool most_hit = true) {
    const std::vector<TriangleId> ids = hittable_triangles(world.expected, nullptr, nullptr);
    const std::vector<Hit> hits = world.intersect(rays);
    size_t hit_count = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const PreparedRay p(rays[i]);
        Nearest nearest(p);
        for (const TriangleId id : ids)
            nearest.offer(world.expected.triangle(id), id);
        const Hit expected = nearest.hit();
        ASSERT_EQ(std::memcmp(&hits[i], &expected, sizeof(Hit)), 0)
            << "ray " << i << ": (" << hits[i].id.mesh << ", " << hits[i].id.prim << ") at "
            << hits[i].t << ", expected (" << expected.id.mesh << ", " << expected.id.prim
            << ") at " << expected.t;
        hit_count += hits[i].is_hit();
    }
    EXPECT_GT(hit_count, most_hit ? rays.size() / 2 : 0);
    for (size_t i = 0; i < std::min(exactly, rays.size()); ++i) {
        const auto truth = exact_nearest(world.expected, ids, rays[i]);
        ASSERT_EQ(truth ? truth->id : TriangleId{}, hits[i].id) << "ray " << i;
    }
}

/// Expects the same if each ray skips one triangle, often the one that it would hit, and compares
/// whether rays hit anything.
inline void expect_brute_force_with_skips(const World& world, const std::vector<Ray>& rays,
                                          uint64_t seed) {
    Random random(seed);
    const std::vector<TriangleId> ids = hittable_triangles(world.expected, nullptr, nullptr);
    const std::vector<Hit> first = world.intersect(rays);
    std::vector<ovc_triangle> skip;
    for (const Hit& hit : first) {
        const TriangleId id =
            hit.is_hit() && random.below(4) ? hit.id : ids[random.below(uint32_t(ids.size()))];
        skip.push_back({id.mesh, id.prim});
    }
    auto query = sized<ovc_query>();
    query.skip = skip.data();
    const std::vector<Hit> hits = world.intersect(rays, &query);
    const std::vector<uint8_t> occluded =
        occlusion(world.scene.get(), std::span(as_abi(rays), rays.size()), &query);
    for (size_t i = 0; i < rays.size(); ++i) {
        const Hit expected =
            brute_force(world.expected, ids, rays[i], {skip[i].mesh, skip[i].prim});
        ASSERT_EQ(std::memcmp(&hits[i], &expected, sizeof(Hit)), 0)
            << "ray " << i << " does not see (" << skip[i].mesh << ", " << skip[i].prim << "): ("
            << hits[i].id.mesh << ", " << hits[i].id.prim << ") at " << hits[i].t << ", expected ("
            << expected.id.mesh << ", " << expected.id.prim << ") at " << expected.t;
        ASSERT_EQ(occluded[i] != 0, expected.is_hit()) << "ray " << i;
    }
}

class Instances : public DeviceTest {
protected:
    void SetUp() override {
        DeviceTest::SetUp();
        if (IsSkipped())
            return;
        config.leaf_triangles = 50;
    }
    World world() const { return World(device.get(), config); }

    ovc_scene_config config = sized<ovc_scene_config>();
};

} // namespace ovc::test
