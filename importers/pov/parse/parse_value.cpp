// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/parse_value.h"

#include "importers/file/text.h"
#include "importers/pov/parse/parse_camera.h"
#include "importers/pov/parse/parse_object.h"
#include "importers/pov/parse/parse_sky.h"
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
    auto array = std::make_shared<Array>();
    double count = 1;
    while (reader.peek_operator().is('[')) {
        reader.next();
        const int size = parse_int(reader, 1, 1 << 30, "the size of an array");
        array->sizes.push_back(size_t(size));
        reader.expect(']', "the size of an array");
        count *= size;
        if (count > double(reader.limits.array_items) || array->sizes.size() > 5)
            reader.fail(reader.place(), fmt::format("found an array of {} items, expected at most "
                                                    "{} in up to 5 dimensions",
                                                    count, reader.limits.array_items));
    }
    if (array->sizes.empty())
        reader.fail_here("'[' and the size of an array");
    take_items(reader, uint64_t(count));
    array->items.resize(size_t(count));
    if (reader.peek_operator().is('{'))
        fill(reader, *array, 0, 0, array->items.size());
    return array;
}

Value parse_layers(Reader& reader) {
    Texture texture = parse_texture(reader);
    while (reader.peek_operator().is("texture")) {
        reader.next();
        texture = layered(parse_texture(reader), texture, reader.place());
    }
    return texture;
}

using ParseValue = Value (*)(Reader&);
Value parse_opaque(Reader& reader) {
    skip_braces(reader, "a block");
    return Opaque{"a block"};
}

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
    {"color_map", [](Reader& r) -> Value { return parse_map(r); }},
    {"colour_map", [](Reader& r) -> Value { return parse_map(r); }},
    {"pigment_map", [](Reader& r) -> Value { return parse_map(r); }},
    {"texture_map", [](Reader& r) -> Value { return parse_map(r); }},
    {"normal", parse_opaque},
    {"normal_map", parse_opaque},
    {"slope_map", parse_opaque},
    {"density", parse_opaque},
    {"density_map", parse_opaque},
    {"media", parse_opaque},
    {"fog", parse_opaque},
    {"rainbow", parse_opaque},
    {"sky_sphere", [](Reader& r) -> Value { return parse_sky_sphere(r); }}};

Value copy_of(Reader& reader, const Array& array) {
    take_items(reader, array.items.size());
    return std::make_shared<Array>(array);
}

/// Takes a variable or an array's item and returns its value. Takes nothing where the value may be
/// part of an expression.
std::optional<Value> take_whole(Reader& reader) {
    const Token token = reader.peek();
    if (token.kind != TokenKind::Name || token.name->is_keyword)
        return std::nullopt;
    const Slot* slot = reader.find(token.name);
    if (!slot || std::holds_alternative<std::monostate>(slot->value) ||
        std::holds_alternative<Number>(slot->value))
        return std::nullopt;
    reader.next();
    if (const auto* array = std::get_if<std::shared_ptr<Array>>(&slot->value)) {
        const std::shared_ptr<Array> kept = *array;
        if (!reader.peek_operator().is('['))
            return copy_of(reader, *kept);
        if (!kept->items.empty() && std::holds_alternative<Number>(kept->items[0])) {
            reader.put_back(token);
            return std::nullopt;
        }
        const Value item = *parse_item(reader, *kept);
        // A copy, so that an array in an array never changes and cannot contain itself.
        if (const auto* inner = std::get_if<std::shared_ptr<Array>>(&item))
            return copy_of(reader, **inner);
        return item;
    }
    const bool is_callable = std::holds_alternative<std::shared_ptr<const Function>>(slot->value) ||
                             std::holds_alternative<std::shared_ptr<const Spline>>(slot->value);
    const Value value = slot->value;
    if (is_callable && reader.peek_operator().is('(')) {
        reader.put_back(token);
        return std::nullopt;
    }
    return value;
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
        "nothing",   "a number",    "a text",      "an object",  "a texture",
        "a pigment", "a finish",    "an interior", "a material", "a color map",
        "a sky",     "a transform", "an array",    "a macro",    "a function",
        "a spline",  "a camera",    "a file",      "a block"};
    static_assert(std::size(kKindNames) == std::variant_size_v<Value>);
    return kKindNames[value.index()];
}

} // namespace ovc::pov
