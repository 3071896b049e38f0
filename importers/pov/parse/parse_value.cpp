// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/parse_value.h"

#include "importers/file/text.h"
#include "importers/pov/parse/parse_camera.h"
#include "importers/pov/parse/parse_media.h"
#include "importers/pov/parse/parse_object.h"
#include "importers/pov/parse/parse_sky.h"
#include "importers/pov/parse/pattern.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/values/function.h"
#include "importers/pov/values/spline.h"
#include "importers/pov/values/transform.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <unordered_map>

namespace ovc::pov {

namespace {

void fill_item(Reader& reader, Array& array, size_t i) {
    Value value = parse_value(reader);
    reader.count_depth(array, value);
    array.items[i] = std::move(value);
}

/// Counts the work and memory of making or copying items. An item takes as long as a few words.
void take_items(Reader& reader, uint64_t count) {
    reader.spend(4 * count);
    reader.grow(count * sizeof(Value));
}

/// Reads the `{ … }` of one dimension into the `count` items from `first` on.
void fill(Reader& reader, Array& array, size_t dimension, size_t first, size_t count) {
    assert(dimension < array.sizes.size() && count % array.sizes[dimension] == 0);
    assert(first + count <= array.items.size());
    const Deeper deeper(reader);
    reader.expect('{', "an array");
    const size_t size = array.sizes[dimension];
    const size_t stride = count / size;
    for (size_t i = 0; i < size && !reader.peek().is('}'); ++i) {
        if (dimension + 1 < array.sizes.size())
            fill(reader, array, dimension + 1, first + i * stride, stride);
        else
            fill_item(reader, array, first + i);
        reader.take_comma();
    }
    reader.expect('}', "the items of an array");
}

/// Reads an array from behind the word `array`.
Value parse_array(Reader& reader) {
    Array array;
    double count = 1;
    while (reader.peek_more().is('[')) {
        reader.next();
        const int size = parse_int(reader, 1, 1 << 30, "the size of an array");
        array.sizes.push_back(size_t(size));
        reader.expect(']', "the size of an array");
        count *= size;
        if (count > double(reader.limits.array_items) || array.sizes.size() > 5)
            reader.fail(reader.place(), fmt::format("found an array of {} items, expected at most "
                                                    "{} in up to 5 dimensions",
                                                    count, reader.limits.array_items));
    }
    if (array.sizes.empty())
        reader.fail_here("'[' and the size of an array");
    take_items(reader, uint64_t(count));
    array.items.resize(size_t(count));
    if (reader.peek_more().is('{'))
        fill(reader, array, 0, 0, array.items.size());
    return array;
}

Value parse_layers(Reader& reader) {
    Texture texture = parse_texture(reader);
    while (reader.peek_more().is("texture")) {
        reader.next();
        texture = layered(reader, parse_texture(reader), texture);
    }
    return texture;
}

using ParseValue = Value (*)(Reader&);
const std::unordered_map<std::string_view, ParseValue> kKinds = {
    {"array", parse_array},
    {"texture", parse_layers},
    {"pigment", [](Reader& r) -> Value { return parse_pigment(r, r.defaults.pigment); }},
    {"finish", [](Reader& r) -> Value { return parse_finish(r, r.defaults.surface); }},
    {"interior", [](Reader& r) -> Value { return parse_interior(r, {}); }},
    {"material", [](Reader& r) -> Value { return parse_material(r); }},
    {"camera", [](Reader& r) -> Value { return parse_camera(r); }},
    {"function", [](Reader& r) -> Value { return parse_function(r); }},
    {"spline", [](Reader& r) -> Value { return parse_spline(r); }},
    {"transform",
     [](Reader& r) -> Value {
         if (const auto m = take_named_if<dmat4>(r))
             return *m;
         return parse_transform_block(r);
     }},
    {"color_map", [](Reader& r) -> Value { return parse_map(r, MapOf::Pigments); }},
    {"colour_map", [](Reader& r) -> Value { return parse_map(r, MapOf::Pigments); }},
    {"pigment_map", [](Reader& r) -> Value { return parse_map(r, MapOf::Pigments); }},
    {"texture_map", [](Reader& r) -> Value { return parse_map(r, MapOf::Textures); }},
    {"normal", [](Reader& r) -> Value { return parse_normal(r, {}); }},
    {"normal_map", [](Reader& r) -> Value { return parse_map(r, MapOf::Normals); }},
    {"slope_map",
     [](Reader& r) -> Value {
         return ColorMap{{}, parse_slope_map(r)};
     }},
    {"density", [](Reader& r) -> Value { return parse_density(r); }},
    {"density_map", [](Reader& r) -> Value { return parse_map(r, MapOf::Pigments); }},
    {"media", [](Reader& r) -> Value { return parse_media(r); }},
    {"fog", [](Reader& r) -> Value { return parse_fog(r); }},
    {"rainbow", [](Reader& r) -> Value { return parse_rainbow(r); }},
    {"sky_sphere", [](Reader& r) -> Value { return parse_sky_sphere(r); }}};

/// Returns the number of items, with those of arrays in the array.
uint64_t count_items(const Array& array) {
    uint64_t count = array.items.size();
    if (array.depth > 1)
        for (const Value& item : array.items)
            if (const auto* inner = std::get_if<Array>(&item))
                count += count_items(*inner);
    return count;
}

/// Counts what it takes to copy the value, and returns it.
const Value& counted(Reader& reader, const Value& value) {
    if (const auto* array = std::get_if<Array>(&value))
        take_items(reader, count_items(*array));
    else if (const auto* file = std::get_if<DataFile>(&value)) {
        reader.spend(file->text.size() / 16);
        reader.grow(file->text.size());
    } else if (const auto* spline = std::get_if<Spline>(&value)) {
        reader.spend(spline->points.size());
        reader.grow(spline->points.size() * sizeof(*spline->points.begin()));
    }
    return value;
}

bool can_be_called(const Value& value) {
    return std::holds_alternative<Function>(value) || std::holds_alternative<Spline>(value);
}

/// Returns whether the value is part of an expression: an array of numbers, of which an item's
/// indices come next, or a function whose arguments do.
bool begins_number(Reader& reader, const ValueHandle& handle) {
    const bool indices = reader.peek_more().is('['), arguments = reader.peek_more().is('(');
    const Value* value = reader.value_of(handle);
    if (!value)
        return false;
    if (const auto* array = std::get_if<Array>(value)) {
        const Value* item = first_item(*array);
        return indices && item && std::holds_alternative<Number>(*item);
    }
    return arguments && can_be_called(*value);
}

/// Takes a variable or an array's item and returns its value. Takes nothing where the value may be
/// part of an expression.
std::optional<Value> take_whole(Reader& reader) {
    const Token token = reader.peek();
    if (token.kind != TokenKind::Name || token.name->is_keyword)
        return std::nullopt;
    Slot* slot = reader.find(token.name);
    if (!slot || std::holds_alternative<std::monostate>(slot->value) ||
        std::holds_alternative<Number>(slot->value))
        return std::nullopt;
    reader.next();
    ValueHandle handle(*slot);
    if (begins_number(reader, handle)) {
        reader.put_back(token);
        return std::nullopt;
    }
    if (reader.peek_more().is('[') && reader.value_of(handle) &&
        std::holds_alternative<Array>(handle.slot->value))
        handle = parse_item(reader, *handle.slot);
    const bool arguments = reader.peek_more().is('(');
    const Value* value = reader.value_of(handle);
    if (!value)
        reader.fail(token.place, fmt::format("found {}, whose index or argument changes it",
                                             ovc::quoted(token.name->text)));
    const Value& whole = counted(reader, *value);
    if (!arguments || !can_be_called(whole))
        return whole;
    // An array's function begins an expression. Its indices are read, so it gets a name for that.
    Token item = token;
    item.name = reader.names().intern(token.name->text + "[]");
    reader.declare(item.name, /* local= */ true).value = Value(whole);
    reader.put_back(item);
    return std::nullopt;
}

} // namespace

Value parse_value(Reader& reader) {
    const Deeper deeper(reader);
    const Token token = reader.peek();
    if (starts_object(token))
        return parse_object(reader);
    if (token.kind == TokenKind::Name)
        if (const auto kind = kKinds.find(token.name->text); kind != kKinds.end()) {
            reader.next();
            return kind->second(reader);
        }
    if (token.kind == TokenKind::Text ||
        (token.kind == TokenKind::Name && token.name->is_keyword && starts_text(reader, token)))
        return parse_text(reader);
    if (const std::optional<Value> whole = take_whole(reader))
        return *whole;
    return parse_number(reader);
}

std::string kind_of(const Value& value) {
    static constexpr const char* kKindNames[] = {
        "nothing",  "a number",    "a text",      "an object",  "a texture",   "a pigment",
        "a normal", "a finish",    "an interior", "a material", "a color map", "a sky",
        "a fog",    "a transform", "an array",    "a macro",    "a function",  "a spline",
        "a camera", "a file",      "a media",     "a rainbow"};
    static_assert(std::size(kKindNames) == std::variant_size_v<Value::variant>);
    return kKindNames[value.index()];
}

} // namespace ovc::pov
