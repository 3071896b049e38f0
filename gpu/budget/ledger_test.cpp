// SPDX-License-Identifier: Apache-2.0
// The ledger of GPU bytes.
#include "gpu/budget/ledger.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

TEST(Ledger, KeepsThePeak) {
    Ledger ledger;
    ledger.budget = 100;
    ledger.add(60);
    ledger.remove(50);
    ledger.add(20);
    EXPECT_EQ(ledger.in_use, 30u);
    EXPECT_EQ(ledger.peak, 60u);
}

} // namespace
} // namespace ovc
