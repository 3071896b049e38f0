// SPDX-License-Identifier: Apache-2.0
// Numbers of triangles lead back to the triangles, whatever the sizes of chunks.
#include "core/numbering.h"

#include <gtest/gtest.h>

#include <random>

namespace ovc {
namespace {

void add(Soup& soup, uint32_t triangles) {
    soup.chunks.push_back(Chunk::owning(dvec3(0), std::vector<vec3>(triangles * size_t(3))));
}

void expect_names(const Soup& soup, const Numbering& numbering) {
    uint32_t number = numbering.first();
    for (uint32_t mesh = 0; mesh < soup.chunks.size(); ++mesh)
        for (uint32_t prim = 0; prim < soup.chunks[mesh].size(); ++prim, ++number) {
            ASSERT_EQ(numbering.of({mesh, prim}), number);
            ASSERT_EQ(numbering.id(number), (TriangleId{mesh, prim}));
        }
    EXPECT_EQ(numbering.count(), number);
}

TEST(Numbering, LeadsBackToTriangles) {
    std::mt19937 random(1);
    for (const uint32_t chunks : {1u, 2u, 3u, 10u, 500u})
        for (const uint32_t largest : {0u, 1u, 3u, 4000u})
            for (const uint32_t first : {0u, 77u}) {
                SCOPED_TRACE(testing::Message() << chunks << " chunks of up to " << largest);
                Soup soup;
                for (uint32_t i = 0; i < chunks; ++i) // most are small, some empty, few large
                    add(soup, random() % (random() % 20 == 0 ? largest + 1 : largest % 5 + 1));
                Numbering numbering(soup, first);
                expect_names(soup, numbering);
                add(soup, 0);
                add(soup, 9);
                numbering.append(soup);
                expect_names(soup, numbering);
            }
}

} // namespace
} // namespace ovc
