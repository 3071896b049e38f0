// SPDX-License-Identifier: Apache-2.0
#include "plugin/structure/call_watch.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

/// Counts how often it is asked, and says stop at the second time.
struct Stopping final : TraceWatch {
    int asked = 0;
    bool goes_on(double) override { return ++asked < 2; }
};

TEST(CallWatch, IsNotAskedAgainOnceItSaysStop) {
    CallWatch call;
    Stopping watch;
    const CallWatch::Scope scope(call, &watch);
    EXPECT_TRUE(call.keeps_on());
    EXPECT_FALSE(call.keeps_on());
    EXPECT_FALSE(call.keeps_on());
    EXPECT_FALSE(call.go_on(1, 2));
    EXPECT_EQ(watch.asked, 2);
}

TEST(CallWatch, AsksNobodyWhereThereIsNoWatch) {
    CallWatch call;
    const CallWatch::Scope scope(call, nullptr);
    EXPECT_TRUE(call.keeps_on());
    EXPECT_TRUE(call.go_on(1, 2));
}

TEST(CallWatch, AFailureEndsTheCallAndIsForgottenByTheNext) {
    CallWatch call;
    EXPECT_TRUE(call.keeps_on());
    call.fail({"the first", ErrorKind::Unreadable});
    call.fail({"the second", ErrorKind::Other});
    EXPECT_FALSE(call.keeps_on());
    EXPECT_EQ(call.unless_cancelled().error().message, "the first");
    EXPECT_EQ(call.go_on(0, 1).error().kind, ErrorKind::Unreadable);
    call.begin_call();
    EXPECT_TRUE(call.keeps_on());
    EXPECT_TRUE(call.unless_cancelled());
}

} // namespace
} // namespace ovc
