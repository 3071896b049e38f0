// SPDX-License-Identifier: Apache-2.0
// A PLY header has one keyword per line.
#include "importers/mesh/ply_header.h"

#include "importers/file/text.h"
#include "importers/readers.h"

#include <fmt/format.h>

#include <limits>

namespace ovc {

namespace {

struct TypeName {
    std::string_view name;
    PlyType type;
};

constexpr TypeName kTypeNames[] = {
    {"char", PlyType::Int8},      {"int8", PlyType::Int8},       {"uchar", PlyType::UInt8},
    {"uint8", PlyType::UInt8},    {"short", PlyType::Int16},     {"int16", PlyType::Int16},
    {"ushort", PlyType::UInt16},  {"uint16", PlyType::UInt16},   {"int", PlyType::Int32},
    {"int32", PlyType::Int32},    {"uint", PlyType::UInt32},     {"uint32", PlyType::UInt32},
    {"float", PlyType::Float32},  {"float32", PlyType::Float32}, {"double", PlyType::Float64},
    {"float64", PlyType::Float64}};

constexpr std::string_view kTypeList =
    "a type such as char, uchar, short, ushort, int, uint, float, double";

std::optional<PlyType> type_named(std::string_view name) {
    for (const TypeName& row : kTypeNames)
        if (row.name == name)
            return row.type;
    return std::nullopt;
}

/// Blender 2.4 wrote its remark "Created by Blender3D" without the word comment.
bool is_remark(std::string_view keyword) {
    return keyword == "comment" || keyword == "obj_info" || keyword == "Created";
}

/// 32 bits number the vertices, except one value that marks the end of a strip, and the triangles.
/// Rows of other elements are only skipped.
uint64_t max_rows(std::string_view element) {
    if (element == "vertex")
        return 0xffffffff;
    if (element == "face" || element == "tristrips")
        return kMaxTriangles;
    return std::numeric_limits<uint64_t>::max();
}

bool is_whole(std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == word.npos;
}

class HeaderReader {
public:
    explicit HeaderReader(Source& source) : source_(source) {}

    Result<PlyHeader> read() {
        const std::string_view first = trimmed(source_.line().value_or(""));
        if (first != "ply")
            return wrong(found(first), "ply");
        bool format_seen = false;
        while (const auto line = source_.line()) {
            std::string_view rest = *line;
            const std::string_view keyword = next_word(rest);
            if (keyword == "end_header")
                return format_seen ? Result<PlyHeader>(std::move(header_))
                                   : wrong("end_header", "a line format … before it");
            if (keyword == "comment" && next_word(rest) == "TextureFile" && !trimmed(rest).empty())
                header_.textures.emplace_back(trimmed(rest)); // as VCGLIB writes them
            if (keyword.empty() || is_remark(keyword))
                continue;
            format_seen = format_seen || keyword == "format";
            if (auto error = read_line(keyword, rest))
                return std::move(*error);
        }
        return wrong("the end of the file", "end_header");
    }

private:
    Error wrong(std::string_view found, std::string_view expected) const {
        return source_.error_at_line(fmt::format("found {}, expected {}", found, expected));
    }

    std::optional<Error> read_line(std::string_view keyword, std::string_view rest) {
        if (keyword == "format")
            return read_format(rest);
        if (keyword == "element")
            return read_element(rest);
        if (keyword == "property")
            return read_property(rest);
        return wrong(quoted(keyword), "format, element, property, comment, obj_info or end_header");
    }

    std::optional<Error> read_format(std::string_view rest) {
        const std::string_view format = next_word(rest);
        if (format == "ascii")
            header_.format = PlyFormat::Ascii;
        else if (format == "binary_little_endian")
            header_.format = PlyFormat::BinaryLittleEndian;
        else if (format == "binary_big_endian")
            header_.format = PlyFormat::BinaryBigEndian;
        else
            return wrong(found(format, "format"),
                         "ascii, binary_little_endian or binary_big_endian");
        if (const std::string_view version = next_word(rest); version != "1.0")
            return wrong(found(version, "format version"), "1.0");
        return std::nullopt;
    }

    std::optional<Error> read_element(std::string_view rest) {
        PlyElement element;
        element.name = next_word(rest);
        const std::string_view count = next_word(rest);
        const auto value = parse_number<uint64_t>(count);
        const uint64_t max = max_rows(element.name);
        if (value ? *value > max : is_whole(count))
            return wrong(found(count, "element count"),
                         fmt::format("at most {} rows of {}", max, element.name));
        if (!value)
            return wrong(found(count, "element count"), "a whole number, 0 or more");
        element.count = *value;
        header_.elements.push_back(std::move(element));
        return std::nullopt;
    }

    std::optional<Error> read_property(std::string_view rest) {
        if (header_.elements.empty())
            return wrong("a property", "an element before it");
        PlyProperty property;
        std::string_view type = next_word(rest);
        if (type == "list") {
            property.is_list = true;
            const std::string_view count_type = next_word(rest);
            const auto known = type_named(count_type);
            if (!known || !is_integer(*known))
                return wrong(found(count_type, "list length type"), "an integer type");
            property.count_type = *known;
            type = next_word(rest);
        }
        const auto known = type_named(type);
        if (!known)
            return wrong(found(type, "type"), kTypeList);
        property.type = *known;
        property.name = next_word(rest);
        if (property.name.empty())
            return wrong("the end of the line", "the name of the property");
        header_.elements.back().properties.push_back(std::move(property));
        return std::nullopt;
    }

    Source& source_;
    PlyHeader header_;
};

} // namespace

int PlyElement::find(std::string_view property) const {
    for (size_t i = 0; i < properties.size(); ++i)
        if (properties[i].name == property)
            return int(i);
    return -1;
}

uint64_t PlyElement::shortest_row(PlyFormat format) const {
    uint64_t bytes = 0;
    for (const PlyProperty& property : properties)
        bytes += format == PlyFormat::Ascii ? 2
                 : property.is_list         ? size_of(property.count_type)
                                            : size_of(property.type);
    return bytes;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
    for (const PlyElement& e : elements)
        if (e.name == element)
            return &e;
    return nullptr;
}

Result<PlyHeader> read_ply_header(Source& source) {
    return HeaderReader(source).read();
}

} // namespace ovc
