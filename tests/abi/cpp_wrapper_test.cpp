// SPDX-License-Identifier: Apache-2.0
// Tests overcast.hpp: owners destroy once, errors carry a code and a sentence, spans of different
// lengths are refused, and exceptions of a stream's functions arrive.
#include "plugin/overcast.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <optional>

namespace {

using overcast::make;
using testing::HasSubstr;

constexpr std::array<float, 9> kCorners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
constexpr ovc_ray kAlong = {{0.25, 0.25, 1}, 0, {0, 0, -1}, HUGE_VAL};
constexpr ovc_ray kAside = {{2, 2, 1}, 0, {0, 0, -1}, HUGE_VAL};

template <class Call>
overcast::Error error_of(Call&& call) {
    try {
        call();
    } catch (const overcast::Error& error) {
        return error;
    }
    return {OVC_OK, "nothing was thrown"};
}

class CppWrapper : public testing::Test {
protected:
    void SetUp() override {
        const overcast::Error error = error_of([&] { device.emplace(); });
        if (error.code() == OVC_ERROR_NO_DEVICE)
            GTEST_SKIP() << error.what();
        ASSERT_TRUE(device) << error.what();
    }
    overcast::Scene committed(const ovc_scene_config& config = make<ovc_scene_config>()) {
        overcast::Scene scene(*device, config);
        EXPECT_EQ(scene.add<float>(kCorners), 0u);
        EXPECT_EQ(scene.add_instance(0, {1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, 0}), 1u);
        scene.commit();
        return scene; // This moves the scene.
    }
    std::optional<overcast::Device> device;
};

TEST_F(CppWrapper, AnswersAsTheTableDoes) {
    EXPECT_FALSE(overcast::Device::list().empty());
    EXPECT_FALSE(std::string(device->describe().renderer).empty());
    const overcast::Scene scene = committed();
    const std::array rays = {kAlong, kAside, ovc_ray{{2.25, 0.25, 3}, 0, {0, 0, -1}, HUGE_VAL}};
    const std::vector<ovc_hit> hits = scene.intersect(rays);
    EXPECT_EQ(hits[0].t, 1);
    EXPECT_EQ(hits[1].mesh, OVC_NONE);
    EXPECT_EQ(hits[2].mesh, 1u);
    std::array<uint8_t, 3> occluded{7, 7, 7};
    scene.occluded(rays, occluded);
    EXPECT_THAT(occluded, testing::ElementsAre(1, 0, 1));
    EXPECT_EQ(scene.intersect1(kAlong).t, 1);
    EXPECT_TRUE(scene.occluded1(kAlong));
    EXPECT_FALSE(scene.occluded1(kAside));
    EXPECT_EQ(scene.statistics().triangles, 2u);
    EXPECT_EQ(scene.plan().triangles, 2u);
    scene.purge();
    EXPECT_EQ(scene.statistics().gpu_bytes, 0u);
    EXPECT_EQ(scene.intersect(rays)[2].mesh, 1u);
}

TEST_F(CppWrapper, WhatIsSavedServesALaterScene) {
    const overcast::SavedBytes bytes = committed().save();
    auto config = make<ovc_scene_config>();
    config.saved = bytes.data();
    config.saved_bytes = bytes.size();
    const overcast::Scene scene = committed(config);
    EXPECT_EQ(scene.statistics().from_saved, 1u);
    const std::vector<std::byte> copied = bytes; // as programs of earlier versions take them
    EXPECT_EQ(copied.size(), bytes.size());
    EXPECT_EQ(scene.intersect1(kAlong).t, 1);
}

TEST_F(CppWrapper, TakesDoublesAndIndices) {
    overcast::Scene scene(*device);
    const std::vector<double> corners = {1e7, 0, 0, 1e7 + 1e-6, 0, 0, 1e7, 1e-6, 0};
    const std::vector<uint32_t> indices = {2, 0, 1, 0, 1, 2};
    scene.add<double>(corners, indices);
    scene.commit();
    EXPECT_EQ(scene.statistics().triangles, 2u);
    EXPECT_EQ(scene.intersect1({{1e7, 0, 1}, 0, {0, 0, -1}, HUGE_VAL}).t, 1);
}

TEST_F(CppWrapper, ErrorsCarryCodeAndSentence) {
    overcast::Scene scene(*device);
    const auto early = error_of([&] { (void)scene.intersect1(kAlong); });
    EXPECT_EQ(early.code(), OVC_ERROR_INVALID_STATE);
    EXPECT_STREQ(early.what(),
                 "intersect1: the scene is not committed yet, or has changed since it was");
    EXPECT_THAT(error_of([&] { (void)scene.active(); }).what(), HasSubstr("active"));
    EXPECT_THAT(error_of([&] { scene.add<float>(std::span(kCorners).first(8)); }).what(),
                HasSubstr("three at a time"));
    EXPECT_THAT(error_of([&] { scene.add_instance(5, {}); }).what(),
                HasSubstr("ovc_instance.mesh is 5"));
    scene.commit();
    std::array<ovc_hit, 2> room;
    EXPECT_THAT(error_of([&] { scene.intersect(std::array{kAlong}, room); }).what(),
                HasSubstr("1 rays, but room for 2 answers"));
    auto config = make<ovc_device_config>();
    config.name = "no such card";
    EXPECT_EQ(error_of([&] { overcast::Device other(config); }).code(), OVC_ERROR_NO_DEVICE);
}

TEST_F(CppWrapper, TicketsWaitCancelAndReleaseThemselves) {
    const overcast::Scene scene = committed();
    const std::vector<ovc_ray> rays(10'000, kAlong);
    std::vector<ovc_hit> hits(rays.size());
    std::vector<uint8_t> occluded(rays.size());
    const overcast::Ticket nearest = scene.submit_intersect(rays, hits);
    overcast::Ticket any = scene.submit_occluded(rays, occluded);
    nearest.wait();
    EXPECT_TRUE(nearest.done());
    EXPECT_EQ(nearest.progress(), 1);
    EXPECT_EQ(hits.back().t, 1);
    overcast::Ticket moved = std::move(any);
    moved.wait();
    EXPECT_EQ(occluded.back(), 1);
    const overcast::Ticket cancelled = scene.submit_intersect(rays, hits);
    cancelled.cancel();
    const auto error = error_of([&] { cancelled.wait(); });
    EXPECT_TRUE(error.code() == OVC_OK || error.code() == OVC_ERROR_CANCELLED) << error.what();
    EXPECT_THAT(error_of([&] { (void)scene.submit_occluded(rays, {}); }).what(),
                HasSubstr("room for 0 answers"));
}

TEST_F(CppWrapper, StreamsAndWhatTheirFunctionsThrowArrives) {
    const overcast::Scene scene = committed();
    const std::array rays = {kAlong, kAside};
    const std::array<uint64_t, 2> tokens = {10, 11};
    bool pushed = false;
    std::vector<uint64_t> hit;
    scene.stream(
        [&](overcast::Stream& stream, size_t) {
            if (!std::exchange(pushed, true))
                stream.push(rays, tokens, /* any_hit= */ false);
        },
        [&](overcast::Stream&, const ovc_stream_answers& answers) {
            for (size_t i = 0; i < answers.count; ++i)
                if (answers.hits[i].mesh != OVC_NONE)
                    hit.push_back(answers.tokens[i]);
        });
    EXPECT_THAT(hit, testing::ElementsAre(10u));
    EXPECT_THROW(scene.stream([](overcast::Stream&, size_t) { throw std::out_of_range("mine"); },
                              [](overcast::Stream&, const ovc_stream_answers&) {}),
                 std::out_of_range);
    EXPECT_EQ(scene.intersect1(kAlong).t, 1) << "the scene goes on";
}

} // namespace
