// SPDX-License-Identifier: Apache-2.0
// Expressions: floats, vectors, colors, texts.
#pragma once

#include "importers/pov/words/reader.h"

namespace ovc::pov {

/// A sum of products: of any size. Ends before the first token that cannot go on with it.
Number parse_number(Reader& reader);
/// With comparisons, `&`, `|` and `?:`, as it stands in parentheses.
Number parse_logical(Reader& reader);

double parse_float(Reader& reader);
int parse_int(Reader& reader, int least, int most, std::string_view what);
/// A float counts for all components.
dvec3 parse_vector(Reader& reader);
dvec2 parse_vector2(Reader& reader);
Color parse_color(Reader& reader);
std::string parse_text(Reader& reader);
/// `(`, a logical expression, `)`.
double parse_condition(Reader& reader);
/// What may follow a word such as `hollow`: on, off, a float; nothing: true.
bool parse_flag(Reader& reader);

/// Whether an expression may begin with this token.
bool starts_number(const Reader& reader, const Token& token);
bool starts_text(const Reader& reader, const Token& token);
/// rgb, color, red, …
bool starts_color(const Token& token);

/// A part of an sRGB color as the scene's colors are: light, or light ^ (1 / gamma).
double from_srgb(double c, double gamma);

/// From the first [ behind the array's name on.
Value* parse_item(Reader& reader, Array& array);

/// Like a vector of `size`, or ParseError.
Number resized(Reader& reader, const Number& number, int size);
Color color_of(const Number& number);
dvec3 vector_of(const Number& number);

/// The object, texture or whatever else `token` names; null: it names nothing of this kind.
template <class T>
const T* named(const Reader& reader, const Token& token) {
    if (token.kind != TokenKind::Name || token.name->is_keyword)
        return nullptr;
    const Slot* slot = reader.find(token.name);
    return slot ? std::get_if<T>(&slot->value) : nullptr;
}

/// named() of the next token or, where that is an array, of the item that follows; taken. Nothing
/// is taken where there is none.
template <class T>
std::optional<T> take_named(Reader& reader) {
    const Token token = reader.next();
    if (const T* value = named<T>(reader, token))
        return *value;
    if (const auto* array = named<std::shared_ptr<Array>>(reader, token);
        array && reader.peek().is('[')) {
        const std::shared_ptr<Array> kept = *array;
        const Value* item = parse_item(reader, *kept);
        if (const T* value = std::get_if<T>(item))
            return *value;
        reader.fail(token.place, "found " + kind_of(*item) + " in the array " + token.name->text +
                                     ", expected something else here");
    }
    reader.put_back(token);
    return std::nullopt;
}

/// take_named(), but an array of other things is no error: nothing is taken.
template <class T>
std::optional<T> take_named_if(Reader& reader) {
    const Token token = reader.peek();
    if (const auto* array = named<std::shared_ptr<Array>>(reader, token))
        if ((*array)->items.empty() || !std::holds_alternative<T>((*array)->items[0]))
            return std::nullopt;
    return take_named<T>(reader);
}

} // namespace ovc::pov
