// SPDX-License-Identifier: Apache-2.0
// Reads expressions: floats, vectors, colors and texts.
#pragma once

#include "importers/pov/words/reader.h"

namespace ovc::pov {

/// Reads a sum of products: a float, vector or color, up to the first token that cannot continue
/// it. Like the functions below it throws ParseError where something else comes next.
Number parse_number(Reader& reader);
/// Reads an expression as it may stand in parentheses, with comparisons, `&`, `|` and `?:`.
Number parse_logical(Reader& reader);

double parse_float(Reader& reader);
/// Reads a float from `min` to below `max` + 1 and truncates it. `what` names it in the error.
int parse_int(Reader& reader, int min, int max, std::string_view what);
/// Reads a vector. A float counts for all components, here and in the next two functions.
dvec3 parse_vector(Reader& reader);
dvec2 parse_vector2(Reader& reader);
Color parse_color(Reader& reader);
std::string parse_text(Reader& reader);
/// Reads `(`, a logical expression and `)`.
double parse_condition(Reader& reader);
/// Reads the on, off or float that may follow a word such as `hollow`; true where there is none.
bool parse_flag(Reader& reader);

/// Returns whether an expression may begin with this token.
bool starts_number(const Reader& reader, const Token& token);
bool starts_text(const Reader& reader, const Token& token);
/// Returns whether a color may begin with this token: rgb, color, red and the like.
bool starts_color(const Token& token);

/// Returns a channel of an sRGB color as the scene's colors are: light ^ (1 / gamma). A gamma of 1
/// gives light itself, and kSrgbGamma leaves `c` as it is.
double from_srgb(double c, double gamma);

/// Reads the indices of an item, from the first [ behind the name of the slot's array.
ValueHandle parse_item(Reader& reader, Slot& slot);
/// Takes the indices behind `name`, the name of an array, which is taken already, and returns the
/// item. The reference is valid until the variable changes.
Value& take_item(Reader& reader, const Token& name);

/// Returns the first item of the array that has a value, which tells the kind of them all, or null.
const Value* first_item(const Array& array);

/// Returns the number with `size` components, which is 1 to 5. Throws ParseError where it has more.
Number resized(Reader& reader, const Number& number, int size);
Color color_of(const Number& number);
dvec3 vector_of(const Number& number);

/// Returns the object, texture or other value that `token` names, or null where it names nothing of
/// this kind. The pointer is valid until the variable changes.
template <class T>
const T* named(const Reader& reader, const Token& token) {
    if (token.kind != TokenKind::Name || token.name->is_keyword)
        return nullptr;
    const Slot* slot = reader.find(token.name);
    return slot ? std::get_if<T>(&slot->value) : nullptr;
}

/// Takes the name of a value of this kind, or the name of an array with an item's indices, and
/// returns the value. For any other token it takes nothing and returns nothing. Throws ParseError
/// where the item is of another kind.
template <class T>
std::optional<T> take_named(Reader& reader) {
    const Token token = reader.next();
    if (const T* value = named<T>(reader, token))
        return *value;
    if (named<Array>(reader, token) && reader.peek().is('[')) {
        const Value& item = take_item(reader, token);
        if (const T* value = std::get_if<T>(&item))
            return *value;
        reader.fail(token.place, "found " + kind_of(item) + " in the array " + token.name->text +
                                     ", expected something else here");
    }
    reader.put_back(token);
    return std::nullopt;
}

/// Does the same, but an array of items of another kind is no error; nothing is taken.
template <class T>
std::optional<T> take_named_if(Reader& reader) {
    const Token token = reader.peek();
    if (const auto* array = named<Array>(reader, token)) {
        const Value* item = first_item(*array);
        if (!item || !std::holds_alternative<T>(*item))
            return std::nullopt;
    }
    return take_named<T>(reader);
}

} // namespace ovc::pov
