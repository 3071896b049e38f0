// SPDX-License-Identifier: Apache-2.0
#include "core/text/lower_case.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

TEST(LowerCase, ChangesTheLettersOfAsciiAlone) {
    EXPECT_EQ(lower_case("AZ @[ `{ az 09"), "az @[ `{ az 09");
    EXPECT_EQ(lower_case("GRÖẞE.PLY"), "grÖẞe.ply");
    EXPECT_EQ(lower_case(""), "");
}

} // namespace
} // namespace ovc
