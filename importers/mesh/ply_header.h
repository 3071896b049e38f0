// SPDX-License-Identifier: Apache-2.0
// The header of a PLY file: what its elements are and how each row is laid out.
// Source: Turk 1994, "The PLY Polygon File Format".
#pragma once

#include "importers/file/source.h"

#include <string>
#include <vector>

namespace ovc {

enum class PlyFormat { Ascii, BinaryLittleEndian, BinaryBigEndian };

enum class PlyType : uint8_t { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

inline size_t size_of(PlyType type) {
    constexpr uint8_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[size_t(type)];
}

inline bool is_integer(PlyType type) {
    return type < PlyType::Float32;
}

/// True where some values of the type are no floats.
inline bool exceeds_float(PlyType type) {
    return type == PlyType::Int32 || type == PlyType::UInt32 || type == PlyType::Float64;
}

struct PlyProperty {
    std::string name;
    PlyType type{};       // of the scalar, or of the items of the list
    PlyType count_type{}; // lists only; always an integer type
    bool is_list = false;
};

struct PlyElement {
    std::string name;
    uint64_t count = 0; // as the file claims
    std::vector<PlyProperty> properties;

    /// The first property of that name; -1 where there is none.
    int find(std::string_view property) const;
    /// The bytes of the shortest binary row, every list empty; of an ASCII row, digits and blanks.
    uint64_t shortest_row(PlyFormat format) const;
};

struct PlyHeader {
    PlyFormat format{};
    std::vector<PlyElement> elements;

    const PlyElement* find(std::string_view element) const;
};

/// Leaves `source` behind the line end_header.
Result<PlyHeader> read_ply_header(Source& source);

} // namespace ovc
