// SPDX-License-Identifier: Apache-2.0
// The header of a PLY file names its elements and describes the layout of their rows.
// Source: Turk 1994, "The PLY Polygon File Format".
#pragma once

#include "importers/file/source.h"

#include <cassert>
#include <iterator>
#include <string>
#include <vector>

namespace ovc {

enum class PlyFormat { Ascii, BinaryLittleEndian, BinaryBigEndian };

enum class PlyType : uint8_t { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

inline size_t size_of(PlyType type) {
    constexpr uint8_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    assert(size_t(type) < std::size(kSizes));
    return kSizes[size_t(type)];
}

inline bool is_integer(PlyType type) {
    return type < PlyType::Float32;
}

/// Returns whether some values of the type are no floats.
inline bool exceeds_float(PlyType type) {
    return type == PlyType::Int32 || type == PlyType::UInt32 || type == PlyType::Float64;
}

struct PlyProperty {
    std::string name;
    PlyType type{};       // of the scalar or of the list's items
    PlyType count_type{}; // lists only; always an integer type
    bool is_list = false;
};

struct PlyElement {
    std::string name;
    uint64_t count = 0; // rows that the file claims
    std::vector<PlyProperty> properties;

    /// Returns the number of the first property of that name; -1 if there is none.
    int find(std::string_view property) const;
    /// Returns the bytes of the shortest row: a binary row with empty lists, or an ASCII row of one
    /// digit and one blank per property.
    uint64_t shortest_row(PlyFormat format) const;
};

struct PlyHeader {
    PlyFormat format{};
    std::vector<PlyElement> elements;
    std::vector<std::string> textures; // names of pictures

    const PlyElement* find(std::string_view element) const;
};

/// Reads the header and leaves `source` behind the line end_header.
Result<PlyHeader> read_ply_header(Source& source);

} // namespace ovc
