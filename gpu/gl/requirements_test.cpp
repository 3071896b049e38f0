// SPDX-License-Identifier: Apache-2.0
// A driver that meets the list is taken, and one that misses an entry is refused by name.
#include "gpu/gl/requirements.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace ovc {
namespace {

/// Offers just what is needed, except for one entry.
int just_enough(GLenum asked, GLenum spoilt) {
    if (asked == GL_MAJOR_VERSION)
        return kGlMajor;
    if (asked == GL_MINOR_VERSION)
        return kGlMinor - (spoilt == asked);
    for (const LimitRequirement& required : kLimits)
        if (required.limit == asked)
            return required.needed - (spoilt == asked);
    ADD_FAILURE() << "asked for " << asked << ", which is not in the list";
    return 0;
}

Result<Done> check(GLenum spoilt) {
    return check_requirements("Card", [&](GLenum asked) { return just_enough(asked, spoilt); });
}

TEST(Requirements, AreMetByADriverThatOffersJustThem) {
    EXPECT_TRUE(check(GL_NONE));
}

TEST(Requirements, EachIsNamedWhereADriverOffersLess) {
    for (const LimitRequirement& required : kLimits) {
        const Result<Done> checked = check(required.limit);
        ASSERT_FALSE(checked) << required.name;
        EXPECT_EQ(checked.error().message,
                  "'Card' offers less than Overcast needs: " + std::string(required.name) + " " +
                      std::to_string(required.needed - 1) + ", not " +
                      std::to_string(required.needed) + "; a newer driver may offer it");
    }
    const Result<Done> old = check(GL_MINOR_VERSION);
    ASSERT_FALSE(old);
    EXPECT_THAT(old.error().message, testing::HasSubstr("OpenGL 4.4, not 4.5"));
}

TEST(Requirements, LaterVersionsMeetThem) {
    EXPECT_TRUE(check_requirements("Card", [](GLenum asked) {
        return asked == GL_MAJOR_VERSION ? 5 : asked == GL_MINOR_VERSION ? 0 : 1 << 20;
    }));
}

} // namespace
} // namespace ovc
