// SPDX-License-Identifier: Apache-2.0
// Uses and misuses every function of the table. It does what it should, or returns the right error
// with a sentence, and later calls are not affected.
#include "tests/misuse/entries.h"

#include <gmock/gmock.h>

#include <set>

namespace ovc {
namespace {

using test::api;

class Entries : public test::DeviceTest {};

TEST_F(Entries, EveryFunctionOfTheTableHasARow) {
    std::set<size_t> offsets;
    for (const test::Entry& entry : test::entries())
        EXPECT_TRUE(offsets.insert(entry.offset).second) << entry.name << " has two rows";
    for (size_t offset = offsetof(ovc_api, last_error); offset < sizeof(ovc_api);
         offset += sizeof(void*))
        EXPECT_EQ(offsets.count(offset), 1u)
            << "the function at byte " << offset
            << " of ovc_api has no row: add one to tests/misuse/*_entries.cpp";
}

TEST_F(Entries, EachIsUsed) {
    test::Subject subject(device.get());
    for (const test::Entry& entry : test::entries())
        EXPECT_EQ(entry.use(subject), OVC_OK) << entry.name << api().last_error(device.get());
}

TEST_F(Entries, EachMisuseIsAnErrorWithASentenceAndLeavesNothingBehind) {
    test::Subject subject(device.get());
    for (const test::Entry& entry : test::entries()) {
        for (const test::Misuse& misuse : entry.misuse(subject)) {
            EXPECT_EQ(misuse.got, misuse.expected) << entry.name << ": " << misuse.what;
            const bool told = misuse.expected == OVC_OK || misuse.said.size() > 10;
            EXPECT_TRUE(told) << entry.name << ": " << misuse.what;
        }
        EXPECT_EQ(entry.use(subject), OVC_OK) << entry.name << " after misuse";
    }
    EXPECT_TRUE(test::field_answers(subject.field));
}

} // namespace
} // namespace ovc
