// SPDX-License-Identifier: Apache-2.0
// Tests functions of the host that call the plugin back where they may not. Where the plugin would
// wait for itself, the call must return an error.
#include "tests/misuse/entries.h"

#include <atomic>
#include <utility>
#include <xmmintrin.h>

namespace ovc {
namespace {

using test::api;
using test::sized;

/// Uses every function of the table once, in a place where only last_error may be called, on a
/// subject that is in the middle of a call.
struct Intruder {
    test::Subject* subject = nullptr;
    std::atomic<bool> called{false};
    std::string allowed; // the calls that should not have been allowed

    void intrude() {
        if (!subject || called.exchange(true))
            return;
        for (const test::Entry& entry : test::entries()) {
            const bool may = entry.offset == offsetof(ovc_api, last_error);
            if ((entry.use(*subject) == OVC_OK) != may)
                allowed += std::string(entry.name) + "; ";
            entry.misuse(*subject);
        }
        api().destroy_scene(subject->field);
        api().destroy_device(subject->device);
    }
};

void log(void* user, ovc_log_level, const char*) {
    static_cast<Intruder*>(user)->intrude();
}
int progress(void* user, double, const char*) {
    static_cast<Intruder*>(user)->intrude();
    return 0;
}
int write(void* user, const void*, size_t) {
    static_cast<Intruder*>(user)->intrude();
    return 0;
}

class HostFunctions : public test::DeviceTest {};

TEST_F(HostFunctions, ALogThatCallsBackGetsErrors) {
    Intruder intruder;
    auto config = sized<ovc_device_config>();
    config.log = log;
    config.log_user = &intruder;
    ovc_device talking = nullptr;
    ASSERT_EQ(api().create_device(&config, &talking), OVC_OK);
    {
        test::Subject subject(talking);
        intruder.subject = &subject;
        api().destroy_device(talking); // The refusal goes to the log.
        EXPECT_TRUE(intruder.called);
        EXPECT_EQ(intruder.allowed, "");
        EXPECT_TRUE(test::field_answers(subject.field));
        intruder.subject = nullptr;
    }
    api().destroy_device(talking);
}

TEST_F(HostFunctions, AProgressThatCallsBackGetsErrors) {
    test::Subject subject(device.get());
    Intruder intruder{&subject, {}, {}};
    auto config = sized<ovc_scene_config>();
    config.progress = progress;
    config.progress_user = &intruder;
    ovc_scene scene = nullptr;
    ASSERT_EQ(api().create_scene(device.get(), &config, &scene), OVC_OK);
    const test::AbiScene owner(scene);
    const ovc_mesh mesh = test::field_mesh();
    ASSERT_EQ(api().add_mesh(scene, &mesh, nullptr), OVC_OK);
    ovc_scene field = std::exchange(subject.field, scene); // The subject is the scene itself.
    EXPECT_EQ(api().commit(scene), OVC_OK);
    subject.field = field;
    EXPECT_TRUE(intruder.called);
    EXPECT_EQ(intruder.allowed, "");
    EXPECT_TRUE(test::field_answers(scene));
}

TEST_F(HostFunctions, AWriteThatCallsBackGetsErrors) {
    test::Subject subject(device.get());
    Intruder intruder{&subject, {}, {}};
    EXPECT_EQ(api().save(subject.field, write, &intruder), OVC_OK);
    EXPECT_TRUE(intruder.called);
    EXPECT_EQ(intruder.allowed, "");
    EXPECT_TRUE(test::field_answers(subject.field));
}

int keep_all(void* user, size_t, const uint64_t*, const ovc_hit*, uint8_t*) {
    static_cast<Intruder*>(user)->intrude();
    return 0;
}

TEST_F(HostFunctions, AFilterThatCallsBackGetsErrors) {
    test::Subject subject(device.get());
    Intruder intruder{&subject, {}, {}};
    auto query = sized<ovc_query>();
    query.filter = keep_all;
    query.filter_user = &intruder;
    const ovc_ray ray = test::into_cell(5, 1);
    ovc_hit hit;
    EXPECT_EQ(api().intersect(subject.field, &ray, 1, &hit, &query), OVC_OK);
    EXPECT_TRUE(test::is_in_cell(hit, 5, 1));
    EXPECT_TRUE(intruder.called);
    EXPECT_EQ(intruder.allowed, "");
    EXPECT_TRUE(test::field_answers(subject.field));
}

/// Pushes a ray into each cell once, with the query that is the user's.
int push_all(void* user, ovc_stream stream, size_t) {
    auto& query = *static_cast<ovc_query**>(user);
    if (!std::exchange(query, nullptr))
        return 0;
    auto stopped = sized<ovc_query>();
    stopped.filter = [](void*, size_t, const uint64_t*, const ovc_hit*, uint8_t*) { return 1; };
    for (uint32_t cell = 0; cell < test::kCells; ++cell) {
        const ovc_ray ray = test::into_cell(cell, 1);
        const uint64_t token = cell;
        EXPECT_EQ(api().push(stream, &ray, &token, 1, cell % 2, &stopped), OVC_OK);
    }
    return 0;
}

TEST_F(HostFunctions, AFilterStopsCallsOfEveryForm) {
    test::Subject subject(device.get());
    const ovc_scene field = subject.field;
    auto query = sized<ovc_query>();
    query.filter = [](void*, size_t, const uint64_t*, const ovc_hit*, uint8_t*) { return 1; };
    std::vector<ovc_ray> rays;
    for (uint32_t cell = 0; cell < test::kCells; ++cell)
        rays.push_back(test::into_cell(cell, 1));
    std::vector<ovc_hit> hits(rays.size());
    std::vector<uint8_t> occluded(rays.size());
    const auto stops = [&](ovc_result result, const char* call) {
        EXPECT_EQ(result, OVC_ERROR_CANCELLED) << call;
        EXPECT_NE(error().find(call), std::string::npos) << error();
        EXPECT_TRUE(test::field_answers(field)) << call;
    };
    const ovc_ray* const first = rays.data();
    const size_t count = rays.size();
    stops(api().intersect(field, first, count, hits.data(), &query), "intersect");
    stops(api().occluded(field, first, count, occluded.data(), &query), "occluded");
    stops(api().all_hits(field, first, count, 1, hits.data(), nullptr, &query), "all_hits");
    stops(api().intersect1(field, first, hits.data(), &query), "intersect1");
    stops(api().occluded1(field, first, occluded.data(), &query), "occluded1");
    ovc_ticket ticket = nullptr;
    ASSERT_EQ(api().submit_intersect(field, first, count, hits.data(), &query, &ticket), OVC_OK);
    stops(api().wait(ticket), "submit_intersect");
    api().release(ticket);
    auto host = sized<ovc_stream_host>();
    ovc_query* once = &query;
    host.user = &once;
    host.more = push_all;
    host.answered = [](void*, ovc_stream, const ovc_stream_answers*) { return 0; };
    stops(api().stream(field, &host), "stream");
}

constexpr unsigned kNearest = 0x1f80, kUp = 0x5f80, kControl = 0xffc0; // of MXCSR

/// Counts of calls of a function, and of those in a mode that an earlier call had left.
struct Modes {
    int calls = 0;
    int left = 0;

    int leave_another() {
        ++calls;
        left += (_mm_getcsr() & kControl) != kNearest;
        _mm_setcsr(kUp);
        return 0;
    }
};

/// The proofs about rounding hold in the default mode alone.
TEST_F(HostFunctions, MayLeaveAnotherFloatingPointMode) {
    Modes progress, written, filtered;
    auto config = sized<ovc_scene_config>();
    config.progress = [](void* user, double, const char*) {
        return static_cast<Modes*>(user)->leave_another();
    };
    config.progress_user = &progress;
    ovc_scene scene = nullptr;
    ASSERT_EQ(api().create_scene(device.get(), &config, &scene), OVC_OK);
    const test::AbiScene owner(scene);
    const ovc_mesh mesh = test::field_mesh();
    ASSERT_EQ(api().add_mesh(scene, &mesh, nullptr), OVC_OK);
    ASSERT_EQ(api().commit(scene), OVC_OK);
    const auto write = [](void* user, const void*, size_t) {
        return static_cast<Modes*>(user)->leave_another();
    };
    ASSERT_EQ(api().save(scene, write, &written), OVC_OK);
    auto query = sized<ovc_query>();
    query.filter = [](void* user, size_t, const uint64_t*, const ovc_hit*, uint8_t*) {
        return static_cast<Modes*>(user)->leave_another();
    };
    query.filter_user = &filtered;
    const ovc_ray ray = test::into_cell(5, 1);
    uint64_t hits = 0;
    for (int i = 0; i < 4; ++i)
        ASSERT_EQ(api().all_hits(scene, &ray, 1, 0, nullptr, &hits, &query), OVC_OK);
    for (const Modes& modes : {progress, written, filtered}) {
        EXPECT_GT(modes.calls, 3);
        EXPECT_EQ(modes.left, 0);
    }
    EXPECT_EQ(_mm_getcsr() & kControl, kNearest) << "the mode is the host's outside of calls";
}

/// Submitted calls, too, ask on in the mode of the thread that made them.
TEST_F(HostFunctions, AreAskedInTheModeOfTheCall) {
    const test::Subject subject(device.get());
    const ovc_ray ray = test::into_cell(5, 1);
    ovc_hit hit;
    unsigned found = 0;
    auto query = sized<ovc_query>();
    query.progress = [](void* user, double, const char*) {
        *static_cast<unsigned*>(user) = _mm_getcsr() & kControl;
        return 0;
    };
    query.progress_user = &found;
    ovc_ticket ticket = nullptr;
    _mm_setcsr(kUp);
    const ovc_result called = api().intersect(subject.field, &ray, 1, &hit, &query);
    const unsigned in_call = std::exchange(found, 0);
    const ovc_result submitted =
        api().submit_intersect(subject.field, &ray, 1, &hit, &query, &ticket);
    const ovc_result waited = api().wait(ticket);
    _mm_setcsr(kNearest);
    api().release(ticket);
    EXPECT_EQ(called, OVC_OK);
    EXPECT_EQ(submitted, OVC_OK);
    EXPECT_EQ(waited, OVC_OK);
    EXPECT_EQ(in_call, kUp & kControl);
    EXPECT_EQ(found, kUp & kControl);
}

} // namespace
} // namespace ovc
