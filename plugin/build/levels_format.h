// SPDX-License-Identifier: Apache-2.0
// What saved levels consist of. They are an archive of arrays as they lie, with a key of what they
// were made of.
#pragma once

#include "plugin/build/built_scene.h"

#include <cstdint>
#include <string_view>

namespace ovc {

inline constexpr std::string_view kLevelsKind = "ovc levels";
/// The version must be raised when a build makes other leaves or pages of the same soup. A change
/// of layout.h is noticed without that.
inline constexpr uint32_t kLevelsVersion = 14;

/// A build makes the same levels where all of its key is the same.
struct SavedKey {
    uint64_t layout = 0;         // checksum of shaders/layout.h
    uint64_t soup = 0;           // checksum of origins and corners
    uint64_t leaf_triangles = 0; // limits
    uint64_t page_bytes = 0;     // 0 where no page could come near it
    uint64_t whole_bytes = 0;
    uint64_t any_limits = 0; // 1: limits do not matter, and are 0

    bool operator==(const SavedKey&) const = default;
};

/// One cut: all triangles that are placed once make the first, and each shared mesh makes another.
struct SavedCut {
    uint64_t not_finite = 0;
    uint64_t degenerate = 0;
    // So many of each part of the archive belong to this cut, behind those of the cuts before.
    uint64_t duplicates = 0;
    uint64_t nodes = 0;
    uint64_t leaves = 0;
    uint64_t triangles = 0;
    uint64_t shares_frame = 0;
    uint64_t far_leaves = 0;
    Box bounds;
    double padding = 0;
    uint64_t rests = 0;               // 1: a mesh that came to rest
    Transform rest_place = kIdentity; // where it did
};
static_assert(sizeof(SavedCut) == 28 * 8);

/// A leaf as it is saved.
struct SavedLeaf {
    Box cell;
    Box box;
    Box grid;
    dvec3 origin{0};
    double scale = 1;
    uint64_t triangles = 0; // so many of the part "lists", behind those of the leaves before
};
static_assert(sizeof(SavedLeaf) == 23 * 8);

struct SavedPage {
    uint64_t texels = 0;
    uint64_t depth = 0;
    uint64_t checksum = 0; // so that the page can be read by itself
};

/// Returns the checksum of shaders/layout.h, which the pages follow.
uint64_t checksum_of_layout();

/// Writes the limits that the levels were cut by into their key.
void put_limits(SavedKey& key, const LeafLimits& limits);

} // namespace ovc
