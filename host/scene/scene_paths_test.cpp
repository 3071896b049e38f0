// SPDX-License-Identifier: Apache-2.0
// Tests the camera paths of the test scenes: every camera sees something and is not inside of it.
#include "host/backend/backend.h"
#include "host/camera/camera.h"
#include "testscenes/catalog.h"
#include "testscenes/sphere.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

constexpr uint32_t kPathFileSide = 12;

std::vector<Hit> look(Backend& backend, const Camera& camera) {
    const Pinhole pinhole(camera, kPathFileSide, kPathFileSide);
    std::vector<Ray> rays;
    for (uint32_t pixel = 0; pixel < kPathFileSide * kPathFileSide; ++pixel)
        rays.push_back(pinhole.ray(pixel % kPathFileSide, pixel / kPathFileSide));
    std::vector<Hit> hits(rays.size());
    EXPECT_TRUE(backend.intersect(rays, {}, hits));
    return hits;
}

struct ScenePath {
    const char* name;
    bool with_model;
    size_t step;         // the test looks at every step-th frame
    double min_distance; // to the nearest surface in view
};

TEST(ScenePaths, SeeSomethingAndStandInNothing) {
    Soup model;
    model.chunks.push_back(Chunk::owning(dvec3(0), make_sphere(3)));
    for (const ScenePath& c :
         {ScenePath{"dragons-1", true, 5, 0.5}, ScenePath{"dragons-21", true, 5, 0.5},
          ScenePath{"dragonball", true, 5, 0.5}, ScenePath{"plants-1", false, 5, 0.3},
          ScenePath{"powerplant-600000", false, 2, 0.2}}) {
        const Result<Scene> scene = make_test_scene(c.name, c.with_model ? &model : nullptr);
        ASSERT_TRUE(scene);
        const auto backend = make_embree_backend(scene->soup, EmbreeMode::Medium);
        if (!backend)
            GTEST_SKIP() << backend.error().message;
        const CameraPath path = *test_scene_path(c.name);
        ASSERT_FALSE(path.empty());
        for (size_t frame = 0; frame < path.size(); frame += c.step) {
            size_t seen = 0;
            double nearest = INFINITY;
            for (const Hit& hit : look(**backend, path[frame]))
                if (hit.is_hit()) {
                    ++seen;
                    nearest = std::min(nearest, hit.t); // t is the depth
                }
            EXPECT_GT(seen, kPathFileSide * kPathFileSide / 4) << c.name << ", frame " << frame;
            EXPECT_GT(nearest, c.min_distance) << c.name << ", frame " << frame;
        }
    }
}

} // namespace
} // namespace ovc
