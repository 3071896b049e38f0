// SPDX-License-Identifier: Apache-2.0
#include "host/scene/joined_scene.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

Scene scene_of(const char* name, float x) {
    Scene scene;
    scene.name = name;
    scene.materials = {{"plain"}, {name, vec3(x)}};
    scene.add_mesh(name, 1, Chunk::owning(dvec3(x, 0, 0), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    scene.lights.push_back({dvec3(x, 9, 0)});
    return scene;
}

TEST(JoinedScene, HasAllMeshesMaterialsAndLights) {
    Scene second = scene_of("b", 0.5f);
    second.add_mesh("again", 1, second.soup.chunks[0].instance());
    second.meshes[0].normals = std::vector<vec3>(3, vec3(0, 0, 1));
    second.meshes[1].normals_from = 0;
    second.instancing = Instancing{1, 2};
    second.camera = Camera{};
    second.background.horizon = vec3(1, 0, 0);
    std::vector<std::string> warnings;
    const LogSink log = [&](LogLevel, const std::string& text) { warnings.push_back(text); };
    std::vector<NamedScene> scenes;
    scenes.push_back({"a.ply", scene_of("a", 0.25f)});
    scenes.push_back({"b.pbrt", std::move(second)});
    scenes.push_back({"c.ply", scene_of("c", 0.75f)});
    const Scene all = join(std::move(scenes), log);
    EXPECT_EQ(all.name, "a + b + c");
    ASSERT_EQ(all.meshes.size(), 4u);
    const char* names[] = {"a", "b", "again", "c"};
    const char* materials[] = {"a", "b", "b", "c"};
    const float places[] = {0.25f, 0.5f, 0.5f, 0.75f};
    for (size_t m = 0; m < 4; ++m) {
        EXPECT_EQ(all.meshes[m].name, names[m]);
        EXPECT_EQ(all.materials[all.meshes[m].material].name, materials[m]);
        EXPECT_EQ(all.soup.chunks[m].triangle(0)[0].x, places[m]);
    }
    EXPECT_EQ(all.normals_of(all.meshes[2]).size(), 3u);
    EXPECT_TRUE(all.normals_of(all.meshes[3]).empty());
    EXPECT_EQ(all.lights.size(), 3u);
    EXPECT_TRUE(all.camera);
    EXPECT_EQ(all.background.horizon, vec3(1, 0, 0));
    ASSERT_TRUE(all.instancing);
    EXPECT_EQ(all.instancing->unique_triangles, 3u);
    EXPECT_EQ(all.instancing->instances, 2u);
    EXPECT_TRUE(warnings.empty());
}

TEST(JoinedScene, OfWhatThereIsOnlyOneTheFirstCounts) {
    std::vector<NamedScene> scenes;
    for (const char* name : {"a", "b"}) {
        Scene scene = scene_of(name, 0);
        const bool first = scenes.empty();
        scene.camera = Camera{dvec3(0, 0, first ? 1 : 2)};
        scene.size = ImageSize{first ? 10u : 20u, 10};
        scene.gamma = first ? 2.2 : 1.8;
        scenes.push_back({std::string(name) + ".pov", std::move(scene)});
    }
    std::vector<std::string> warnings;
    const Scene all = join(std::move(scenes),
                           [&](LogLevel, const std::string& text) { warnings.push_back(text); });
    EXPECT_EQ(all.camera->eye.z, 1);
    EXPECT_EQ(all.size->width, 10u);
    EXPECT_EQ(all.gamma, 2.2);
    EXPECT_EQ(warnings, (std::vector<std::string>{
                            "b.pov: its camera left out: a scene of several files has one",
                            "b.pov: its picture's size left out: a scene of several files has one",
                            "b.pov: its gamma left out: a scene of several files has one"}));
}

} // namespace
} // namespace ovc
