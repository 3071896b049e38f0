// SPDX-License-Identifier: Apache-2.0
// Misuses the C ABI, which must return an error with a sentence and never crash, and tests its
// promises about numbers.
#include "tests/abi/abi_scene.h"

#include <gmock/gmock.h>

#include <atomic>
#include <cfenv>
#include <cmath>
#include <cstring>
#include <thread>
#include <vector>

namespace {

using ovc::test::api;
using ovc::test::sized;
using testing::HasSubstr;

constexpr float kTriangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
constexpr ovc_ray kDown = {{0.25, 0.25, 1}, 0, {0, 0, -1}, HUGE_VAL};

class Abi : public testing::Test {
protected:
    void SetUp() override {
        if (api().create_device(nullptr, &device) == OVC_ERROR_NO_DEVICE)
            GTEST_SKIP() << api().last_error(nullptr);
        ASSERT_TRUE(device);
        ASSERT_EQ(api().create_scene(device, nullptr, &scene), OVC_OK);
    }
    void TearDown() override {
        api().destroy_scene(scene);
        api().destroy_device(device);
    }

    std::string error() const { return api().last_error(device); }

    ovc_mesh triangle() const {
        auto mesh = sized<ovc_mesh>();
        mesh.positions = kTriangle;
        mesh.vertex_count = 3;
        return mesh;
    }

    void commit_triangle() {
        const ovc_mesh mesh = triangle();
        ASSERT_EQ(api().add_mesh(scene, &mesh, nullptr), OVC_OK) << error();
        ASSERT_EQ(api().commit(scene), OVC_OK) << error();
    }

    ovc_device device = nullptr;
    ovc_scene scene = nullptr;
};

TEST_F(Abi, AnUnknownVersionHasNoTable) {
    EXPECT_EQ(ovc_get_api(0), nullptr);
    EXPECT_EQ(ovc_get_api(OVC_ABI_VERSION + 1), nullptr);
    EXPECT_EQ(api().struct_size, sizeof(ovc_api));
    EXPECT_EQ(api().abi, OVC_ABI_VERSION);
}

TEST_F(Abi, NullHandlesAndPointersAreErrors) {
    uint32_t count;
    EXPECT_EQ(api().list_devices(nullptr, 0, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().list_devices(nullptr, 3, &count), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().create_device(nullptr, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().describe_device(nullptr, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().describe_device(device, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().create_scene(nullptr, nullptr, &scene), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().create_scene(device, nullptr, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().add_mesh(nullptr, nullptr, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(api().last_error(nullptr), HasSubstr("add_mesh: scene is NULL"));
    EXPECT_EQ(api().add_mesh(scene, nullptr, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().commit(nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().intersect(nullptr, nullptr, 1, nullptr, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().occluded(nullptr, nullptr, 1, nullptr, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().statistics(scene, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    api().destroy_scene(nullptr);
    api().destroy_device(nullptr);
}

TEST_F(Abi, WrongSizesAreNamed) {
    auto config = sized<ovc_scene_config>();
    config.struct_size = 3;
    ovc_scene other;
    EXPECT_EQ(api().create_scene(device, &config, &other), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error(),
                HasSubstr("ovc_scene_config.struct_size is 3, expected sizeof(ovc_scene_config)"));
    ovc_mesh mesh = triangle();
    mesh.struct_size = 0;
    EXPECT_EQ(api().add_mesh(scene, &mesh, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error(), HasSubstr("ovc_mesh.struct_size is 0"));
    ovc_device_info info{};
    EXPECT_EQ(api().describe_device(device, &info), OVC_ERROR_INVALID_ARGUMENT);
    commit_triangle();
    ovc_statistics statistics{};
    EXPECT_EQ(api().statistics(scene, &statistics), OVC_ERROR_INVALID_ARGUMENT);
}

TEST_F(Abi, MeshesThatMakeNoSenseAreRefused) {
    const uint32_t outside[3] = {0, 1, 3};
    const struct {
        const char* part;
        void (*spoil)(ovc_mesh&, const uint32_t*);
    } cases[] = {
        {"positions is NULL", [](ovc_mesh& m, const uint32_t*) { m.positions = nullptr; }},
        {"stride is 8", [](ovc_mesh& m, const uint32_t*) { m.stride = 8; }},
        {"stride is 13", [](ovc_mesh& m, const uint32_t*) { m.stride = 13; }},
        {"vertex_count is 2 without indices",
         [](ovc_mesh& m, const uint32_t*) { m.vertex_count = 2; }},
        {"triangle_count is 5, but 3 vertices",
         [](ovc_mesh& m, const uint32_t*) { m.triangle_count = 5; }},
        {"indices[2] is 3, expected less than vertex_count = 3",
         [](ovc_mesh& m, const uint32_t* i) { m.indices = i, m.triangle_count = 1; }},
        {"fewer than",
         [](ovc_mesh& m, const uint32_t* i) { m.indices = i, m.triangle_count = 1ull << 40; }},
        {"OVC_MESH_SHARED needs",
         [](ovc_mesh& m, const uint32_t*) { m.flags = OVC_MESH_SHARED, m.stride = 16; }},
        {"bits that this version does not know",
         [](ovc_mesh& m, const uint32_t*) { m.flags = 64; }},
        {"origin is not finite", [](ovc_mesh& m, const uint32_t*) { m.origin[1] = NAN; }},
    };
    for (const auto& c : cases) {
        ovc_mesh mesh = triangle();
        c.spoil(mesh, outside);
        EXPECT_EQ(api().add_mesh(scene, &mesh, nullptr), OVC_ERROR_INVALID_ARGUMENT) << c.part;
        EXPECT_THAT(error(), HasSubstr(c.part));
    }
}

TEST_F(Abi, CallsInTheWrongOrderAreErrors) {
    ovc_hit hit;
    EXPECT_EQ(api().intersect(scene, &kDown, 1, &hit, nullptr), OVC_ERROR_INVALID_STATE);
    EXPECT_EQ(error(), "intersect: the scene is not committed yet, or has changed since it was");
    commit_triangle();
    EXPECT_EQ(api().commit(scene), OVC_OK) << "nothing to do";
    EXPECT_EQ(api().intersect(scene, &kDown, 1, &hit, nullptr), OVC_OK);
    const ovc_mesh mesh = triangle();
    EXPECT_EQ(api().add_mesh(scene, &mesh, nullptr), OVC_OK);
    EXPECT_EQ(api().intersect(scene, &kDown, 1, &hit, nullptr), OVC_ERROR_INVALID_STATE);
}

TEST_F(Abi, ABudgetTooSmallNamesTheSmallest) {
    auto config = sized<ovc_scene_config>();
    config.gpu_memory_bytes = 1024;
    ovc_scene small = nullptr;
    EXPECT_EQ(api().create_scene(device, &config, &small), OVC_ERROR_OUT_OF_BUDGET);
    EXPECT_THAT(error(), HasSubstr("the smallest that works is 40964 bytes"));
    EXPECT_EQ(small, nullptr);
}

TEST_F(Abi, ADeviceThatDoesNotExistIsNamed) {
    auto config = sized<ovc_device_config>();
    config.name = "no such card";
    ovc_device other;
    EXPECT_EQ(api().create_device(&config, &other), OVC_ERROR_NO_DEVICE);
    EXPECT_EQ(other, nullptr);
    EXPECT_THAT(api().last_error(nullptr), HasSubstr("no device is called 'no such card'"));
}

TEST_F(Abi, AnEmptySceneMissesAndNoRaysAreFine) {
    ASSERT_EQ(api().commit(scene), OVC_OK) << error();
    ovc_hit hit;
    uint8_t shadow = 7;
    EXPECT_EQ(api().intersect(scene, &kDown, 1, &hit, nullptr), OVC_OK);
    EXPECT_EQ(hit.mesh, OVC_NONE);
    EXPECT_TRUE(std::isinf(hit.t));
    EXPECT_EQ(api().occluded(scene, &kDown, 1, &shadow, nullptr), OVC_OK);
    EXPECT_EQ(shadow, 0);
    EXPECT_EQ(api().intersect(scene, nullptr, 0, nullptr, nullptr), OVC_OK);
}

TEST_F(Abi, BadRaysMissAndAreCounted) {
    commit_triangle();
    std::vector<ovc_ray> rays;
    for (int field = 0; field < 8; ++field)
        for (const double bad : {double(NAN), HUGE_VAL, -HUGE_VAL}) {
            ovc_ray ray = kDown;
            (&ray.org[0])[field] = bad;
            if (field != 7 || bad != HUGE_VAL) // An infinite end is allowed.
                rays.push_back(ray);
        }
    rays.push_back({{0.25, 0.25, 1}, 0, {0, 0, 0}, 9});
    rays.push_back({{0.25, 0.25, 1}, 2, {0, 0, -1}, 1});
    std::vector<ovc_hit> hits(rays.size());
    ASSERT_EQ(api().intersect(scene, rays.data(), rays.size(), hits.data(), nullptr), OVC_OK);
    for (const ovc_hit& hit : hits)
        EXPECT_EQ(hit.mesh, OVC_NONE);
    auto statistics = sized<ovc_statistics>();
    ASSERT_EQ(api().statistics(scene, &statistics), OVC_OK);
    EXPECT_EQ(statistics.invalid_rays, rays.size());
}

TEST_F(Abi, IndicesStridesOriginsAndSharingGiveTheSameTriangle) {
    const float wide[] = {9, 1, 0, 0, 9, 0,
                          1, 0, 9, 0, 0, 0}; // The stride is 16 and skips the first float.
    const uint32_t indices[3] = {2, 0, 1};
    ovc_mesh indexed = triangle();
    indexed.positions = wide + 1;
    indexed.stride = 16;
    indexed.indices = indices;
    indexed.triangle_count = 1;
    indexed.origin[2] = -1;
    ovc_mesh shared = triangle();
    shared.flags = OVC_MESH_SHARED;
    uint32_t first = 9, second = 9;
    ASSERT_EQ(api().add_mesh(scene, &indexed, &first), OVC_OK) << error();
    ASSERT_EQ(api().add_mesh(scene, &shared, &second), OVC_OK) << error();
    EXPECT_EQ(first, 0u);
    EXPECT_EQ(second, 1u);
    ASSERT_EQ(api().commit(scene), OVC_OK) << error();
    ovc_hit hit;
    auto query = sized<ovc_query>();
    const ovc_triangle skip{1, 0};
    ASSERT_EQ(api().intersect(scene, &kDown, 1, &hit, nullptr), OVC_OK);
    EXPECT_EQ(hit.mesh, 1u);
    EXPECT_EQ(hit.t, 1);
    query.skip = &skip;
    ASSERT_EQ(api().intersect(scene, &kDown, 1, &hit, &query), OVC_OK);
    EXPECT_EQ(hit.mesh, 0u);
    EXPECT_EQ(hit.t, 2);
    EXPECT_EQ(hit.u, 0.25);
    EXPECT_EQ(hit.v, 0.25);
}

TEST_F(Abi, TellsLeafPassesAndActivePagesWhereItWasAskedTo) {
    commit_triangle();
    ovc_hit hit{};
    uint32_t leaf = 7, passes = 7, flagged = 7;
    auto query = sized<ovc_query>();
    query.leaf = &leaf;
    query.passes = &passes;
    query.flagged = &flagged;
    ASSERT_EQ(api().intersect(scene, &kDown, 1, &hit, &query), OVC_OK);
    EXPECT_EQ(leaf, 0u);
    EXPECT_EQ(passes, 1u);
    EXPECT_EQ(flagged, 0u) << "through the middle of a triangle";
    uint8_t occluded = 0;
    EXPECT_EQ(api().occluded(scene, &kDown, 1, &occluded, &query), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(error(), "occluded: ovc_query.leaf, passes and flagged are for intersect");
    // Hosts of earlier headers have a query that ends before `flagged`, or before `leaf`.
    query.struct_size = offsetof(ovc_query, flagged);
    flagged = 7;
    ASSERT_EQ(api().intersect(scene, &kDown, 1, &hit, &query), OVC_OK);
    EXPECT_EQ(flagged, 7u);
    query.struct_size = offsetof(ovc_query, leaf);
    leaf = 7;
    ASSERT_EQ(api().intersect(scene, &kDown, 1, &hit, &query), OVC_OK);
    EXPECT_EQ(leaf, 7u);

    auto active = sized<ovc_active>();
    EXPECT_EQ(api().active(scene, &active), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error(), HasSubstr("tell_active"));
    auto config = sized<ovc_scene_config>();
    config.tell_active = 1;
    ovc_scene telling = nullptr;
    ASSERT_EQ(api().create_scene(device, &config, &telling), OVC_OK);
    const ovc_mesh mesh = triangle();
    ASSERT_EQ(api().add_mesh(telling, &mesh, nullptr), OVC_OK);
    ASSERT_EQ(api().commit(telling), OVC_OK);
    ASSERT_EQ(api().intersect(telling, &kDown, 1, &hit, nullptr), OVC_OK);
    ASSERT_EQ(api().active(telling, &active), OVC_OK);
    EXPECT_EQ(active.pages, 1u);
    EXPECT_EQ(active.new_bytes, active.bytes);
    api().destroy_scene(telling);
}

TEST_F(Abi, ThirtyTwoThreadsTakeTurns) {
    commit_triangle();
    std::atomic<int> wrong{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 32; ++i)
        threads.emplace_back([&] {
            for (int k = 0; k < 20; ++k) {
                ovc_hit hit{};
                wrong += api().intersect(scene, &kDown, 1, &hit, nullptr) != OVC_OK || hit.t != 1;
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, 0);
}

TEST_F(Abi, LeavesTheHostsRoundingModeAlone) {
    commit_triangle();
    std::fesetround(FE_UPWARD);
    ovc_hit hit{};
    const ovc_result result = api().intersect(scene, &kDown, 1, &hit, nullptr);
    const int mode = std::fegetround();
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(result, OVC_OK);
    EXPECT_EQ(mode, FE_UPWARD);
    EXPECT_EQ(hit.t, 1);
}

TEST_F(Abi, TheSystemsOfTheThesisAreInALibraryOfTheirOwn) {
    auto config = sized<ovc_scene_config>();
    ovc_scene other = nullptr;
    config.structure = OVC_STRUCTURE_GPU_GRID;
    EXPECT_EQ(api().create_scene(device, &config, &other), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error(), HasSubstr("libovercast-thesis.so"));
    config.structure = 99;
    EXPECT_EQ(api().create_scene(device, &config, &other), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(error(), "ovc_scene_config.structure is 99, expected 0 to 6");
    config.structure = OVC_STRUCTURE_TWO_LEVEL;
    config.level1 = 3;
    EXPECT_EQ(api().create_scene(device, &config, &other), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(error(), "ovc_scene_config.level1 is 3, expected 0 to 2");
    config.level1 = OVC_LEVEL1_GRID;
    EXPECT_EQ(api().create_scene(device, &config, &other), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error(), HasSubstr("mean nothing to two-level"));
    EXPECT_EQ(other, nullptr);
}

TEST_F(Abi, AKernelVariantIsOneThatThereIs) {
    auto config = sized<ovc_scene_config>();
    ovc_scene other = nullptr;
    config.kernel_variant = "compute,warps";
    EXPECT_EQ(api().create_scene(device, &config, &other), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error(), HasSubstr("ovc_scene_config.kernel_variant: 'warps' is no switch"));
    config.kernel_variant = "fragment,refill";
    EXPECT_EQ(api().create_scene(device, &config, &other), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error(), HasSubstr("no kernel is 'fragment,refill'"));
    config.kernel_variant = "measure";
    config.kernel = OVC_KERNEL_COMPUTE;
    EXPECT_EQ(api().create_scene(device, &config, &other), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error(), HasSubstr("kernel is 2, expected 0"));
    EXPECT_EQ(other, nullptr);
}

TEST_F(Abi, TwoDevicesAndScenesWorkSideBySide) {
    commit_triangle();
    ovc_device other = nullptr;
    ovc_scene far = nullptr;
    ASSERT_EQ(api().create_device(nullptr, &other), OVC_OK);
    ASSERT_EQ(api().create_scene(other, nullptr, &far), OVC_OK);
    ovc_mesh mesh = triangle();
    mesh.origin[2] = -9;
    ASSERT_EQ(api().add_mesh(far, &mesh, nullptr), OVC_OK);
    ASSERT_EQ(api().commit(far), OVC_OK);
    ovc_hit near_hit, far_hit;
    ASSERT_EQ(api().intersect(scene, &kDown, 1, &near_hit, nullptr), OVC_OK);
    ASSERT_EQ(api().intersect(far, &kDown, 1, &far_hit, nullptr), OVC_OK);
    EXPECT_EQ(near_hit.t, 1);
    EXPECT_EQ(far_hit.t, 10);
    api().destroy_device(other); // This is refused, because a scene is alive.
    ASSERT_EQ(api().intersect(far, &kDown, 1, &far_hit, nullptr), OVC_OK);
    api().destroy_scene(far);
    api().destroy_device(other);
}

/// The host of a stream. It asks for each hit whether the way up is free, and counts.
struct Streamer {
    const ovc_api* api = nullptr;
    ovc_scene scene = nullptr;
    size_t rays = 0;
    size_t hits = 0;
    size_t misses = 0;
    size_t free = 0;
    ovc_result inner = OVC_OK; // the result of a call that is not allowed
    int stop = 0;

    static int more(void* user, ovc_stream stream, size_t wanted) {
        Streamer& self = *static_cast<Streamer*>(user);
        EXPECT_GT(wanted, 0u);
        if (self.rays > 0)
            return 0; // There are no more rays.
        self.rays = 2;
        const ovc_ray rays[2] = {kDown, {{5, 5, 1}, 0, {0, 0, -1}, HUGE_VAL}};
        const uint64_t tokens[2] = {70, 71};
        EXPECT_EQ(self.api->push(stream, rays, tokens, 2, 0, nullptr), OVC_OK);
        return 0;
    }
    static int answered(void* user, ovc_stream stream, const ovc_stream_answers* answers) {
        Streamer& self = *static_cast<Streamer*>(user);
        for (size_t i = 0; i < answers->count; ++i) {
            if (answers->occluded) {
                EXPECT_EQ(answers->tokens[i], 170u);
                self.free += answers->occluded[i] == 0;
                continue;
            }
            const bool hit = answers->hits[i].mesh != OVC_NONE;
            EXPECT_EQ(answers->tokens[i], hit ? 70u : 71u);
            (hit ? self.hits : self.misses) += 1;
            if (!hit)
                continue;
            const ovc_ray up = {{0.25, 0.25, 0}, 0, {0, 0, 1}, HUGE_VAL};
            const uint64_t token = 170;
            const ovc_triangle start = {0, 0};
            auto query = sized<ovc_query>();
            query.skip = &start;
            EXPECT_EQ(self.api->push(stream, &up, &token, 1, 1, &query), OVC_OK);
        }
        ovc_hit unused;
        self.inner = self.api->intersect(self.scene, &kDown, 1, &unused, nullptr);
        return self.stop;
    }
};

TEST_F(Abi, AStreamAnswersEveryRayOnce) {
    commit_triangle();
    Streamer streamer{&api(), scene};
    auto host = sized<ovc_stream_host>();
    host.user = &streamer;
    host.more = Streamer::more;
    host.answered = Streamer::answered;
    ASSERT_EQ(api().stream(scene, &host), OVC_OK) << error();
    EXPECT_EQ(streamer.hits, 1u);
    EXPECT_EQ(streamer.misses, 1u);
    EXPECT_EQ(streamer.free, 1u);
    EXPECT_EQ(streamer.inner, OVC_ERROR_INVALID_STATE);
}

TEST_F(Abi, AStreamIsStoppedByItsHostAndTheSceneGoesOn) {
    commit_triangle();
    Streamer streamer{&api(), scene};
    streamer.stop = 1;
    auto host = sized<ovc_stream_host>();
    host.user = &streamer;
    host.more = Streamer::more;
    host.answered = Streamer::answered;
    EXPECT_EQ(api().stream(scene, &host), OVC_ERROR_CANCELLED);
    EXPECT_THAT(error(), HasSubstr("stopped by its host"));
    ovc_hit hit;
    EXPECT_EQ(api().intersect(scene, &kDown, 1, &hit, nullptr), OVC_OK) << error();
    EXPECT_EQ(hit.mesh, 0u);
}

TEST_F(Abi, AMisusedStreamIsRefused) {
    auto host = sized<ovc_stream_host>();
    host.more = Streamer::more;
    host.answered = Streamer::answered;
    EXPECT_EQ(api().stream(nullptr, &host), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().stream(scene, &host), OVC_ERROR_INVALID_STATE); // The scene is not committed.
    commit_triangle();
    EXPECT_EQ(api().stream(scene, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    host.answered = nullptr;
    EXPECT_EQ(api().stream(scene, &host), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error(), HasSubstr("answered is NULL"));
    host.struct_size = 1;
    EXPECT_EQ(api().stream(scene, &host), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().push(nullptr, &kDown, nullptr, 1, 0, nullptr), OVC_ERROR_INVALID_ARGUMENT);
}

} // namespace
