// SPDX-License-Identifier: Apache-2.0
// Scenes that change after their commit: answers have the bits of the triangles as they are now.
#include "core/file/test_archive.h"
#include "core/system/stopwatch.h"
#include "tests/abi/instances_world.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace ovc {
namespace {

using namespace test;

/// A scene that changes at random.
class Changing {
public:
    Changing(World& world, uint64_t seed) : world_(world), random_(seed) {
        for (uint64_t left = 2 + random_.below(4); left > 0; --left)
            add_mesh();
        for (uint64_t left = random_.below(4); left > 0; --left)
            add_instance();
        if (random_.below(3) == 0)
            place_together();
    }

    /// Makes some changes, without a commit.
    void change() {
        for (uint64_t left = 1 + random_.below(3); left > 0; --left) {
            const uint64_t kind = random_.below(16);
            if (kind == 0)
                add_mesh();
            else if (kind == 1)
                random_.below(4) ? add_instance() : place_together();
            else if (kind == 2)
                remove();
            else if (kind < 7)
                move();
            else
                move_corners();
        }
    }

private:
    Matrix transform() {
        const Matrix at = shift(random_.point(-2, 2));
        switch (random_.below(6)) {
        case 0:
            return product(at, any_transform(random_, 0));
        case 1:
            return product(at, scale({1, random_.below(2) ? 1e-7 : 0, 1})); // flat
        default:
            return at;
        }
    }

    /// Makes some of the triangles equal to one of the first.
    template <class Corner>
    void repeat_some(std::vector<Corner>& corners) {
        for (size_t i = 3; i < corners.size(); i += 3)
            if (random_.below(2) == 0)
                std::copy_n(corners.begin() +
                                3 * ptrdiff_t(random_.below(std::min<size_t>(i / 3, 2))),
                            3, corners.begin() + ptrdiff_t(i));
    }

    /// A cloth of squares, whose triangles share sides.
    std::vector<vec3> cloth() {
        const int squares = 2 + int(random_.below(20));
        std::vector<vec3> corners;
        for (int x = 0; x < squares; ++x)
            for (int y = 0; y < squares; ++y)
                for (const auto& [right, up] :
                     {std::pair{0, 0}, {1, 0}, {0, 1}, {0, 1}, {1, 0}, {1, 1}})
                    corners.push_back(vec3(x + right, y + up, 0) / float(squares) - 0.5f);
        return corners;
    }
    /// Returns where the wind takes a point of a cloth.
    static dvec3 blown(const dvec3& p, const dvec3& wind) {
        return {p.x, p.y, wind.x * std::sin(6 * wind.y * p.x + 4 * wind.z * p.y)};
    }

    void add_mesh() {
        if (random_.below(3) == 0) {
            const Matrix m = transform();
            clothes_.push_back(world_.add(cloth(), random_.point(-1, 1), &m,
                                          random_.below(3) ? 0u : uint32_t(OVC_MESH_MOVES)));
            return;
        }
        const size_t triangles = 1 + random_.below(random_.below(2) ? 10 : 300);
        auto corners = random_corners<vec3>(random_, triangles, 0.3);
        if (random_.below(2))
            for (vec3& corner : corners) // many share sides, lie on lines and in planes
                corner = glm::round(corner * 4.0f) / 4.0f;
        if (random_.below(3) == 0)
            repeat_some(corners);
        const uint32_t flags = (random_.below(4) ? 0u : uint32_t(OVC_MESH_TEMPLATE)) |
                               (random_.below(3) ? 0u : uint32_t(OVC_MESH_MOVES));
        const Matrix m = transform();
        const dvec3 origin = random_.point(-1, 1);
        if (random_.below(3))
            world_.add(corners, origin, random_.below(2) ? &m : nullptr, flags);
        else
            world_.add(std::vector<dvec3>(corners.begin(), corners.end()), origin, nullptr, flags);
    }

    uint32_t any_left() {
        for (int tries = 0; tries < 100; ++tries)
            if (const auto number = uint32_t(random_.below(world_.count()));
                !world_.is_removed(number))
                return number;
        add_mesh();
        return world_.count() - 1;
    }
    uint32_t any_mesh() {
        for (int tries = 0; tries < 100; ++tries)
            if (const uint32_t number = any_left(); !world_.is_instance(number))
                return number;
        add_mesh();
        return world_.count() - 1;
    }

    void add_instance() {
        const Matrix m = transform();
        world_.instance(any_left(), random_.below(4) ? &m : nullptr);
    }
    /// Places some meshes together, as an object of several shapes.
    void place_together() {
        std::vector<uint32_t> shapes;
        for (uint64_t left = 2 + random_.below(2); left > 0; --left)
            shapes.push_back(any_left());
        for (uint64_t left = 2 + random_.below(2); left > 0; --left) {
            const Matrix m = transform();
            for (const uint32_t shape : shapes)
                world_.instance(shape, &m);
        }
    }
    void move() {
        const Matrix m = transform();
        world_.move(any_left(), random_.below(6) ? &m : nullptr);
    }
    void remove() {
        if (world_.count() > 3)
            world_.remove(any_left());
    }
    void blow() {
        const uint32_t mesh = clothes_[random_.below(clothes_.size())];
        if (world_.is_removed(mesh))
            return;
        const dvec3 wind = (random_.below(4) ? 0.2 : 3) * random_.point(-1, 1);
        const dvec3 origin = world_.origin(mesh);
        std::vector<dvec3> corners = world_.source(mesh);
        for (dvec3& corner : corners)
            corner = blown(corner - origin, wind);
        const size_t first = random_.below(3) ? 0 : random_.below(corners.size() / 3);
        corners.erase(corners.begin(), corners.begin() + ptrdiff_t(3 * first));
        world_.move_corners(mesh, first, corners);
    }
    void move_corners() {
        if (random_.below(3) && !clothes_.empty())
            return blow();
        const uint32_t mesh = any_mesh();
        const size_t all = world_.triangles(mesh);
        const size_t first = random_.below(2) ? random_.below(all) : 0;
        const size_t count = first == 0 && random_.below(2) ? all
                             : random_.below(2)             ? 1
                                                            : 1 + random_.below(all - first);
        const double reach = random_.below(8) ? 1 : 20;
        auto corners = random_corners<dvec3>(random_, count, 0.3);
        const bool on_grid = random_.below(2), broken = random_.below(8) == 0;
        for (dvec3& corner : corners) {
            corner *= reach;
            if (on_grid)
                corner = glm::round(corner * 4.0) / 4.0;
            if (broken && random_.below(20) == 0)
                corner.y = NAN;
        }
        if (random_.below(4) == 0)
            repeat_some(corners);
        world_.move_corners(mesh, first, corners);
    }

    World& world_;
    Random random_;
    std::vector<uint32_t> clothes_;
};

/// Whether two chunks are the same triangles in the same place.
bool has_copies(const Soup& soup) {
    for (const Chunk& a : soup.chunks)
        for (const Chunk& b : soup.chunks)
            if (&a != &b && a.size() > 0 && a.size() == b.size() &&
                std::memcmp(a.address_of(0), b.address_of(0), a.double_corners().size_bytes()) == 0)
                return true;
    return false;
}

/// Masks that see all change no answer, but the way of rays.
void expect_alike_with_masks(const World& w, const std::vector<Ray>& rays) {
    const std::vector<uint32_t> masks(rays.size(), 1);
    auto query = sized<ovc_query>();
    query.masks = masks.data();
    const std::vector<Hit> plain = w.intersect(rays), masked = w.intersect(rays, &query);
    EXPECT_EQ(std::memcmp(plain.data(), masked.data(), rays.size() * sizeof(Hit)), 0);
}

class Updates : public Instances {};

/// OVC_UPDATES_SECONDS=600 goes on for as long.
TEST_F(Updates, AnswerAsAScenesThatIsNew) {
    const char* const asked = std::getenv("OVC_UPDATES_SECONDS");
    const double seconds = asked ? std::strtod(asked, nullptr) : 8;
    const Stopwatch watch;
    uint64_t rays_asked = 0, updates = 0, refitted = 0, rebuilt = 0, commits = 0;
    for (uint64_t seed = 0; seed < 12 || watch.seconds() < seconds; ++seed) {
        Random random(seed);
        config.leaf_triangles = random.below(3) ? 0 : 40;
        config.kernel = random.below(2) ? OVC_KERNEL_FRAGMENT : OVC_KERNEL_AUTO;
        config.gpu_memory_bytes = random.below(3) ? 0 : 300 << 10;
        World w = world();
        Changing changing(w, seed);
        w.commit();
        ovc_statistics before = w.statistics();
        for (int round = 0; round < 8; ++round) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
            changing.change();
            w.commit();
            if (HasFatalFailure())
                return;
            ++commits;
            const ovc_statistics now = w.statistics();
            Dropped dropped;
            const auto ids = hittable_triangles(w.expected, &dropped, nullptr);
            EXPECT_EQ(now.triangles, w.expected.triangle_count());
            // Copies count as duplicates, and instances as their mesh does before it is placed.
            if (now.instances == 0 && !has_copies(w.expected)) {
                EXPECT_EQ(now.dropped_not_finite, dropped.not_finite);
                EXPECT_EQ(now.dropped_degenerate, dropped.degenerate);
            }
            const bool is_updated = now.updates > before.updates;
            updates += is_updated;
            refitted += is_updated ? now.pages_refitted - before.pages_refitted : 0;
            rebuilt += is_updated ? now.pages_rebuilt - before.pages_rebuilt : 0;
            before = now;
            if (ids.empty())
                continue;
            const std::vector<Ray> rays = rays_at(w.expected, 100, seed);
            expect_brute_force(w, rays, 2, /* most_hit= */ false);
            expect_brute_force_with_skips(w, rays, seed);
            expect_alike_with_masks(w, rays);
            if (HasFatalFailure())
                return;
            rays_asked += rays.size();
        }
    }
    EXPECT_GT(updates, 10u);
    EXPECT_GT(refitted, 10u);
    EXPECT_GT(rebuilt, 10u);
    std::printf("%llu rays after %llu commits, %llu of them updates, of %llu pages refitted and "
                "%llu built\n",
                static_cast<unsigned long long>(rays_asked),
                static_cast<unsigned long long>(commits), static_cast<unsigned long long>(updates),
                static_cast<unsigned long long>(refitted),
                static_cast<unsigned long long>(rebuilt));
}

/// There is no page then, and no tracer.
TEST_F(Updates, OfAMeshWithoutAreaLeaveNothingToHit) {
    World w = world();
    const std::vector<vec3> needle{vec3(0), vec3(0), vec3(1)};
    const uint32_t mesh = w.add(needle, dvec3(0), nullptr, OVC_MESH_MOVES);
    w.commit();
    const Matrix m = shift({0, 1, 0});
    w.move(mesh, &m);
    w.commit();
    for (const Hit& hit : w.intersect(
             {{dvec3(0.5, 1, -1), 0, dvec3(0, 0, 1)}, {dvec3(-1, 0, -1), 0, dvec3(1, 1.5, 1)}}))
        EXPECT_FALSE(hit.is_hit());
}

/// The mesh has a tree of its own, with nothing in it, and the host meets the floor's triangles.
TEST_F(Updates, OfAMeshWithoutAreaLeaveTheFloor) {
    World w = world();
    w.add(std::vector<vec3>{{-9, 0, -9}, {9, 0, -9}, {0, 0, 9}}, dvec3(0), nullptr, 0);
    const uint32_t mesh =
        w.add(std::vector<vec3>{vec3(0), vec3(0), vec3(1)}, dvec3(0), nullptr, OVC_MESH_MOVES);
    w.commit();
    const Matrix m = shift({0, 1, 0});
    w.move(mesh, &m);
    w.commit();
    expect_brute_force(w,
                       {{dvec3(0, 1, 0), 0, dvec3(0, -1, 0)}, {dvec3(0, 1, 0), 0, dvec3(0, 1, 0)}},
                       2, /* most_hit= */ false);
}

/// The first update parts the triangles from the one that they are equal to. The second parts two
/// that share a side in the late leaf.
TEST_F(Updates, PartTrianglesInTheLateLeaf) {
    config.leaf_triangles = 0;
    World w = world();
    const std::vector<dvec3> flat{{-8, 8, -8}, {-8, 8, 8}, {8, 8, 8}};
    std::vector<dvec3> three;
    for (int i = 0; i < 3; ++i)
        three.insert(three.end(), flat.begin(), flat.end());
    w.add(three, dvec3(0), nullptr);
    w.commit();
    w.move_corners(0, 0, {{-0.5, 0.5, 1}, {0.5, 0.5, -1}, {0.5, 1.5, 0}});
    w.commit();
    const std::vector<dvec3> last{{1, -2, -3}, {1, -3, 2}, {-1, 0, 3}};
    w.move_corners(0, 2, last);
    w.commit();
    EXPECT_EQ(w.statistics().updates, 2u);
    const dvec3 middle = (last[0] + last[1] + last[2]) / 3.0;
    expect_brute_force(w, {{middle - dvec3(0, 0, 1), 0, dvec3(0, 0, 1)}}, 1);
    expect_brute_force(w, rays_at(w.expected, 200, 1), 20, /* most_hit= */ false);
}

/// The frame of what is left is not that of the scene.
TEST_F(Updates, LeaveOnePartOfAWideScene) {
    config.leaf_triangles = 15;
    World w = world();
    test::Random random(5);
    w.add(random_corners<vec3>(random, 5, 3), dvec3(0), nullptr);
    const uint32_t far = w.add(random_corners<vec3>(random, 20, 3), dvec3(1e6, 0, 0), nullptr);
    w.commit();
    w.remove(far);
    w.commit();
    EXPECT_EQ(w.statistics().updates, 1u);
    expect_brute_force(w, rays_at(w.expected, 200, 4), 2, /* most_hit= */ false);
}

/// An answer to an occlusion ray does not tell which triangle is hit, and number 0 is of no mesh
/// that is there.
TEST_F(Updates, OcclusionBehindAPlaceNeedsNoFirstMesh) {
    World w = world();
    const std::vector<vec3> triangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    for (int z = 0; z < 3; ++z)
        w.add(triangle, dvec3(0, 0, z), nullptr);
    w.commit();
    w.remove(0);
    w.commit();
    const Ray ray{dvec3(1, 1, -1), 0, dvec3(0, 0, 1)};
    const ovc_hit before_all{-INFINITY, 0, 0, OVC_NONE, OVC_NONE};
    const ovc_hit places[] = {before_all, {2, 0, 0, 1, 0}, {3, 0, 0, 2, 0}};
    for (const ovc_hit& place : places) {
        auto query = sized<ovc_query>();
        query.after = &place;
        uint8_t occluded = 2;
        ASSERT_EQ(api().occluded(w.scene.get(), reinterpret_cast<const ovc_ray*>(&ray), 1,
                                 &occluded, &query),
                  OVC_OK);
        EXPECT_EQ(occluded, place.t < 3) << place.t;
    }
}

/// Passes before the update named leaves that rays waited for. Those after it name none, for all
/// pages are resident then. Rays with masks could go on to such leaves.
TEST_F(Updates, ThatLetAllPagesFitLeaveNoRayWaiting) {
    config.gpu_memory_bytes = 1 << 20;
    config.kernel = OVC_KERNEL_COMPUTE;
    World w = world();
    test::Random random(6);
    const uint32_t large = w.add(random_corners<vec3>(random, 20000, 0.05), dvec3(0), nullptr);
    w.add(random_corners<vec3>(random, 1000, 0.1), dvec3(3, 0, 0), nullptr);
    w.commit();
    w.intersect(rays_at(w.expected, 5000, 1));
    ASSERT_GT(w.statistics().queued_rays, 0u);
    w.remove(large);
    w.commit();
    ASSERT_EQ(w.statistics().updates, 1u);
    const std::vector<Ray> rays = rays_at(w.expected, 5000, 2); // a quarter at corners and sides
    expect_brute_force(w, rays, 2, /* most_hit= */ false);
    expect_alike_with_masks(w, rays);
}

/// Another scene of the meshes as they are now takes the bytes.
TEST_F(Updates, AreSavedUnlessMeshesWereRemoved) {
    test::Random random(3);
    const Soup grid = test::closed_grid(20);
    std::vector<vec3> cloth(grid.chunks[0].corners().begin(), grid.chunks[0].corners().end());
    const auto stone = random_corners<vec3>(random, 40, 0.3);
    config.leaf_triangles = 300;
    World w = world();
    w.add(cloth, dvec3(0), nullptr);
    w.add(stone, dvec3(0), nullptr);
    w.commit();
    std::vector<dvec3> moved(cloth.begin() + 150, cloth.begin() + 210);
    for (dvec3& corner : moved)
        corner = dvec3(vec3(0.999 * corner)); // within the box of all
    w.move_corners(0, 50, moved);
    w.commit();
    EXPECT_EQ(w.statistics().updates, 1u);
    test::ArchiveMemory saved;
    const auto append = [](void* user, const void* bytes, size_t size) {
        static_cast<test::ArchiveMemory*>(user)->append(
            {static_cast<const std::byte*>(bytes), size});
        return 0;
    };
    ASSERT_EQ(api().save(w.scene.get(), append, &saved), OVC_OK) << w.error();
    for (size_t i = 0; i < moved.size(); ++i)
        cloth[150 + i] = vec3(moved[i]);
    config.saved = saved.bytes().data();
    config.saved_bytes = saved.bytes().size();
    World again = world();
    again.add(cloth, dvec3(0), nullptr);
    again.add(stone, dvec3(0), nullptr);
    again.commit();
    EXPECT_EQ(again.statistics().from_saved, 1u);
    expect_brute_force(again, rays_at(again.expected, 1000, 14), 50);
    again.move_corners(0, 10, moved);
    again.commit();
    expect_brute_force(again, rays_at(again.expected, 1000, 15), 50);

    w.remove(1);
    w.commit();
    EXPECT_EQ(api().save(w.scene.get(), append, &saved), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(w.error(), testing::HasSubstr("meshes were removed"));
}

} // namespace
} // namespace ovc
