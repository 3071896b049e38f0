// SPDX-License-Identifier: Apache-2.0
#include "host/scene/moved_meshes.h"

#include "kdtree/test_soups.h"

#include <gmock/gmock.h>

namespace ovc {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Optional;

const Transform kUp{{{{1, 0, 0, 0}, {0, 1, 0, 2}, {0, 0, 1, 0}}}};

/// Two meshes, and the first one a second time, higher up.
Soup three_meshes() {
    Soup soup;
    soup.chunks.push_back(std::move(test::random_soup(1, 10, 0.1).chunks[0]));
    soup.chunks.push_back(std::move(test::random_soup(2, 20, 0.1).chunks[0]));
    soup.chunks.push_back(soup.chunks[0].unplaced());
    soup.chunks[2].place(kUp);
    return soup;
}

void shift(Chunk& chunk, uint32_t prim) {
    std::vector<vec3> corners;
    for (size_t k = 0; k < 3; ++k)
        corners.push_back(chunk.corners()[3 * prim + k] + vec3(1));
    chunk.set_corners(prim, corners);
}

TEST(MovedMeshes, AreNoneWhereNothingHasMoved) {
    EXPECT_THAT(moved_meshes(three_meshes(), three_meshes()), Optional(IsEmpty()));
}

TEST(MovedMeshes, AreFoundAndMoved) {
    Soup before = three_meshes(), now = three_meshes();
    shift(now.chunks[0], 3);
    shift(now.chunks[0], 6);
    now.chunks[1].place(kUp);
    now.chunks[2].place_anew(std::nullopt);
    const auto moved = moved_meshes(before, now);
    EXPECT_THAT(moved, Optional(ElementsAre(MovedMesh{0, 3, 7, false}, MovedMesh{1, 0, 0, true},
                                            MovedMesh{2, 3, 7, true})));
    const void* const place = before.chunks[0].address_of(0);
    move_meshes(before, now, *moved);
    EXPECT_EQ(before.chunks[0].address_of(0), place);
    EXPECT_THAT(moved_meshes(before, now), Optional(IsEmpty()));
    for (uint32_t mesh = 0; mesh < 3; ++mesh)
        for (uint32_t prim = 0; prim < now.chunks[mesh].size(); ++prim)
            EXPECT_EQ(before.triangle({mesh, prim}), now.triangle({mesh, prim}));
}

TEST(MovedMeshes, CannotBecomeOthers) {
    const Soup before = three_meshes();
    Soup more = three_meshes(), larger = three_meshes(), hidden = three_meshes(),
         lent = three_meshes();
    more.chunks.push_back(more.chunks[0].instance());
    larger.chunks[1] = std::move(test::random_soup(2, 21, 0.1).chunks[0]);
    hidden.chunks[1].set_mask(4);
    lent.chunks[2] = std::move(test::random_soup(1, 10, 0.1).chunks[0]);
    for (const Soup* now : {&more, &larger, &hidden, &lent})
        EXPECT_EQ(moved_meshes(before, *now), std::nullopt);
}

} // namespace
} // namespace ovc
