// SPDX-License-Identifier: Apache-2.0
// Tests functions of the host that call the plugin back where they may not. Where the plugin would
// wait for itself, the call must return an error.
#include "tests/misuse/entries.h"

#include <atomic>

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

} // namespace
} // namespace ovc
