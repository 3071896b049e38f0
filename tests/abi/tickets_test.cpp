// SPDX-License-Identifier: Apache-2.0
// Compares submitted calls with blocking ones, bit by bit, and tests tickets that are cancelled,
// released, or outlive their scene.
#include "kdtree/test_soups.h"
#include "tests/abi/abi_scene.h"

#include <gmock/gmock.h>

#include <atomic>
#include <cstring>
#include <thread>

namespace ovc {
namespace {

using test::api;
using test::as_abi;
using test::sized;

class Tickets : public test::DeviceTest {
public:
    void SetUp() override {
        DeviceTest::SetUp();
        if (IsSkipped())
            return;
        scene = committed();
        rays = test::unpleasant_rays(soup, 3, 400000);
    }

    test::AbiScene committed() {
        test::AbiScene made = test::add_soup(device, soup, sized<ovc_scene_config>());
        EXPECT_EQ(api().commit(made.get()), OVC_OK) << error();
        return made;
    }

    ovc_ticket submit(size_t first, size_t count, ovc_hit* hits, const ovc_query* query = nullptr) {
        ovc_ticket ticket = nullptr;
        EXPECT_EQ(
            api().submit_intersect(scene.get(), as_abi(rays) + first, count, hits, query, &ticket),
            OVC_OK)
            << error();
        return ticket;
    }

    const Soup soup = test::closed_grid(60);
    test::AbiScene scene;
    std::vector<Ray> rays;
};

TEST_F(Tickets, OfManyThreadsAreAnsweredAsBlockingCallsAre) {
    std::vector<ovc_hit> expected(rays.size()), hits(rays.size());
    std::vector<uint8_t> expected_shadows(rays.size()), shadows(rays.size(), 2);
    ASSERT_EQ(api().intersect(scene.get(), as_abi(rays), rays.size(), expected.data(), nullptr),
              OVC_OK);
    ASSERT_EQ(
        api().occluded(scene.get(), as_abi(rays), rays.size(), expected_shadows.data(), nullptr),
        OVC_OK);
    constexpr size_t kPart = 2000;
    constexpr size_t kThreads = 8;
    std::atomic<size_t> failed{0};
    std::vector<std::thread> threads;
    for (size_t t = 0; t < kThreads; ++t)
        threads.emplace_back([&, t] {
            std::vector<ovc_ticket> open;
            for (size_t first = t * kPart; first < rays.size(); first += kThreads * kPart) {
                open.push_back(submit(first, kPart, &hits[first]));
                ovc_ticket shadow = nullptr;
                failed += api().submit_occluded(scene.get(), as_abi(rays) + first, kPart,
                                                &shadows[first], nullptr, &shadow) != OVC_OK;
                open.push_back(shadow);
            }
            for (ovc_ticket ticket : open) {
                failed += api().wait(ticket) != OVC_OK;
                uint32_t done = 0;
                double progress = 0;
                failed += api().poll(ticket, &done, &progress) != OVC_OK || !done || progress != 1;
                api().release(ticket);
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(failed, 0u) << error();
    EXPECT_EQ(std::memcmp(hits.data(), expected.data(), hits.size() * sizeof(ovc_hit)), 0);
    EXPECT_EQ(shadows, expected_shadows);
}

/// Holds the first ticket in its progress function until the gate opens.
struct Gate {
    std::atomic<bool> reached{false};
    std::atomic<bool> open{false};

    ovc_query query() {
        auto query = sized<ovc_query>();
        query.progress_user = this;
        query.progress = [](void* user, double, const char*) {
            Gate& gate = *static_cast<Gate*>(user);
            gate.reached = true;
            while (!gate.open)
                std::this_thread::yield();
            return 0;
        };
        return query;
    }
    void wait_until_reached() const {
        while (!reached)
            std::this_thread::yield();
    }
};

TEST_F(Tickets, ThatWaitAreCancelledAtOnceAndThatIsUnderWaySoon) {
    Gate gate;
    const ovc_query query = gate.query();
    std::vector<ovc_hit> hits(rays.size()), more(1000);
    ovc_ticket first = submit(0, rays.size(), hits.data(), &query);
    ovc_ticket second = submit(0, more.size(), more.data());
    ovc_ticket third = submit(0, more.size(), more.data());
    gate.wait_until_reached();
    uint32_t done = 7;
    ASSERT_EQ(api().poll(first, &done, nullptr), OVC_OK);
    EXPECT_EQ(done, 0u);
    ASSERT_EQ(api().cancel(second), OVC_OK);
    ASSERT_EQ(api().poll(second, &done, nullptr), OVC_OK);
    EXPECT_EQ(done, 1u) << "though the first is under way yet";
    EXPECT_EQ(api().wait(second), OVC_ERROR_CANCELLED);
    EXPECT_EQ(error(), "submit_intersect: cancelled");
    ASSERT_EQ(api().cancel(first), OVC_OK);
    gate.open = true;
    EXPECT_EQ(api().wait(first), OVC_ERROR_CANCELLED);
    EXPECT_EQ(api().wait(third), OVC_OK) << error();
    ASSERT_EQ(api().cancel(third), OVC_OK);
    EXPECT_EQ(api().wait(third), OVC_OK) << "what is done stays as it is";
    for (ovc_ticket ticket : {first, second, third})
        api().release(ticket);
}

TEST_F(Tickets, MayBeReleasedBeforeTheyAreDone) {
    std::vector<ovc_hit> hits(rays.size()), expected(1000), again(1000);
    ASSERT_EQ(api().intersect(scene.get(), as_abi(rays), 1000, expected.data(), nullptr), OVC_OK);
    for (int i = 0; i < 20; ++i)
        api().release(submit(0, rays.size(), hits.data()));
    // The buffers are the caller's again.
    std::memset(hits.data(), 0x55, hits.size() * sizeof(ovc_hit));
    ovc_ticket ticket = submit(0, 1000, again.data());
    EXPECT_EQ(api().wait(ticket), OVC_OK);
    api().release(ticket);
    EXPECT_EQ(std::memcmp(again.data(), expected.data(), 1000 * sizeof(ovc_hit)), 0);
    for (const ovc_hit& hit : hits)
        ASSERT_EQ(hit.prim, 0x55555555u) << "nobody writes there any more";
    api().release(nullptr);
}

TEST_F(Tickets, OutliveTheirSceneAndEndCancelled) {
    Gate gate;
    const ovc_query query = gate.query();
    std::vector<ovc_hit> hits(rays.size());
    std::vector<ovc_ticket> open = {submit(0, rays.size(), hits.data(), &query)};
    for (int i = 0; i < 10; ++i)
        open.push_back(submit(0, 1000, hits.data()));
    gate.wait_until_reached();
    std::thread opener([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        gate.open = true;
    });
    scene.reset();
    opener.join();
    for (ovc_ticket ticket : open) {
        uint32_t done = 0;
        EXPECT_EQ(api().poll(ticket, &done, nullptr), OVC_OK);
        EXPECT_EQ(done, 1u);
        EXPECT_EQ(api().wait(ticket), OVC_ERROR_CANCELLED);
    }
    api().destroy_device(device.get());
    auto info = sized<ovc_device_info>();
    EXPECT_EQ(api().describe_device(device.get(), &info), OVC_OK) << "tickets keep the device";
    for (ovc_ticket ticket : open)
        api().release(ticket);
}

TEST_F(Tickets, AreNotWaitedForByTheStreamThatTheyWaitFor) {
    struct Host {
        Tickets* test;
        ovc_ticket ticket;
        ovc_hit hit;
        ovc_result waited;
    } host{this, nullptr, {}, OVC_OK};
    auto calls = sized<ovc_stream_host>();
    calls.user = &host;
    calls.more = [](void* user, ovc_stream, size_t) {
        Host& h = *static_cast<Host*>(user);
        h.ticket = h.test->submit(0, 1, &h.hit);
        h.waited = api().wait(h.ticket);
        return 0;
    };
    calls.answered = [](void*, ovc_stream, const ovc_stream_answers*) { return 0; };
    ASSERT_EQ(api().stream(scene.get(), &calls), OVC_OK) << error();
    EXPECT_EQ(host.waited, OVC_ERROR_INVALID_STATE);
    EXPECT_EQ(api().wait(host.ticket), OVC_OK) << error();
    api().release(host.ticket);
}

TEST_F(Tickets, AreNotMadeOfWhatMakesNoSense) {
    ovc_hit hit{};
    ovc_ticket ticket = reinterpret_cast<ovc_ticket>(this);
    const auto submitted = [&](ovc_scene to, const ovc_ray* asked, const ovc_query* query) {
        return api().submit_intersect(to, asked, 1, &hit, query, &ticket);
    };
    EXPECT_EQ(submitted(nullptr, as_abi(rays), nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(ticket, nullptr);
    EXPECT_EQ(submitted(scene.get(), nullptr, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(error(), "submit_intersect: rays or the answers' buffer is NULL");
    auto query = sized<ovc_query>();
    query.reserved = 1;
    EXPECT_EQ(submitted(scene.get(), as_abi(rays), &query), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().submit_intersect(scene.get(), as_abi(rays), 1, &hit, nullptr, nullptr),
              OVC_ERROR_INVALID_ARGUMENT);
    const test::AbiScene open = test::add_soup(device, soup, sized<ovc_scene_config>());
    EXPECT_EQ(submitted(open.get(), as_abi(rays), nullptr), OVC_ERROR_INVALID_STATE);
    uint32_t done = 0;
    EXPECT_EQ(api().wait(nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().poll(nullptr, &done, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().cancel(nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(api().last_error(nullptr), testing::HasSubstr("cancel: ticket is NULL"));
}

} // namespace
} // namespace ovc
