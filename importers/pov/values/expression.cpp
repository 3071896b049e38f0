// SPDX-License-Identifier: Apache-2.0
// Reads POV-Ray's expressions by recursive descent.
#include "importers/pov/values/expression.h"

#include "importers/file/text.h"
#include "importers/pov/values/builtin.h"
#include "importers/pov/values/function.h"
#include "importers/pov/values/spline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

namespace ovc::pov {

namespace {

/// Gives both numbers one size. A float counts for all components, a shorter vector gets zeros.
void make_alike(Number& a, Number& b) {
    const int size = std::max(a.size, b.size);
    assert(std::min(a.size, b.size) >= 1 && size <= 5);
    for (Number* n : {&a, &b}) {
        if (n->size == 1)
            n->v.fill(n->v[0]);
        for (int i = n->size == 1 ? size : n->size; i < 5; ++i)
            n->v[size_t(i)] = 0;
        n->size = size;
    }
    a.is_color = b.is_color = a.is_color || b.is_color;
}

template <class Op>
Number combined(Number a, Number b, Op op) {
    make_alike(a, b);
    for (size_t i = 0; i < size_t(a.size); ++i)
        a.v[i] = op(a.v[i], b.v[i]);
    return a;
}

double as_float(Reader& reader, const Number& n) {
    if (n.size != 1)
        reader.fail(reader.place(), fmt::format("found a vector of {}, expected a float", n.size));
    return n.v[0];
}

/// Returns the index of a component such as x or red; -1 for any other name.
int component(std::string_view name) {
    static constexpr std::string_view kNames[][3] = {{"x", "u", "red"},
                                                     {"y", "v", "green"},
                                                     {"z", "blue", ""},
                                                     {"t", "filter", ""},
                                                     {"transmit", "", ""}};
    for (int i = 0; i < 5; ++i)
        for (const std::string_view n : kNames[i])
            if (!n.empty() && n == name)
                return i;
    return -1;
}

Number parse_member(Reader& reader, const Number& whole) {
    const Token name = reader.next();
    const double* v = whole.v.data();
    if (name.is("gray") || name.is("grey"))
        return Number::of(whole.gray());
    const int i = name.kind == TokenKind::Name ? component(name.name->text) : -1;
    if (i < 0)
        reader.fail(name.place,
                    fmt::format("found {} after '.', expected a component such as x", found(name)));
    // The filter of a plain vector is 0, and a float has the same value in all components.
    if (whole.size == 1)
        return Number::of(v[0]);
    return Number::of(i < whole.size ? v[i] : 0);
}

Number parse_literal_vector(Reader& reader) {
    const InVector in_vector(reader);
    Number vector;
    vector.size = 0;
    do {
        if (vector.size == 5)
            reader.fail_here("'>', for a vector has five components at most");
        vector.v[size_t(vector.size++)] = as_float(reader, parse_number(reader));
        reader.take_comma();
    } while (!reader.peek().is('>'));
    reader.next();
    return vector;
}

Number parse_color_number(Reader& reader);

/// Reads the arguments, in parentheses, of the function that `name` names.
std::vector<double> parse_arguments(Reader& reader, const Token& name) {
    std::vector<double> arguments;
    reader.expect('(', name.name->text);
    while (!reader.peek().is(')')) {
        const Number n = parse_number(reader);
        arguments.insert(arguments.end(), n.v.begin(), n.v.begin() + n.size);
        reader.take_comma();
    }
    reader.next();
    return arguments;
}

/// Reads `(CLOCK)` or `(CLOCK, KIND)` behind the name of a spline.
std::pair<double, Spline::Kind> parse_clock(Reader& reader, const Token& name, Spline::Kind kind) {
    reader.expect('(', name.name->text);
    const double clock = parse_float(reader);
    if (reader.take(','))
        kind = take_spline_kind(reader, kind);
    reader.expect(')', "the clock of a spline");
    return {clock, kind};
}

/// Returns the value, which is still there and of this kind. `name` is what the scene calls it.
template <class T>
const T& unchanged(Reader& reader, const ValueHandle& handle, const Token& name) {
    const Value* value = reader.value_of(handle);
    const T* same = value ? std::get_if<T>(value) : nullptr;
    if (!same)
        reader.fail(name.place, fmt::format("found {}, whose index or argument changes it",
                                            ovc::quoted(name.name->text)));
    return *same;
}

Number parse_variable(Reader& reader, const Token& name) {
    Slot* slot = reader.find(name.name);
    if (!slot || std::holds_alternative<std::monostate>(slot->value))
        reader.fail(name.place, fmt::format("found {}, which is not declared", found(name)));
    ValueHandle handle(*slot);
    if (std::holds_alternative<Array>(slot->value))
        handle = parse_item(reader, *slot);
    const Value* value = reader.value_of(handle);
    if (value && std::holds_alternative<Function>(*value)) {
        const std::vector<double> arguments = parse_arguments(reader, name);
        return call(reader, name, unchanged<Function>(reader, handle, name), arguments);
    }
    if (const auto* spline = value ? std::get_if<Spline>(value) : nullptr) {
        const auto [clock, kind] = parse_clock(reader, name, spline->kind);
        return at(unchanged<Spline>(reader, handle, name), kind, clock);
    }
    if (value && !std::holds_alternative<Number>(*value))
        reader.fail(name.place, fmt::format("found {} {}, expected a number", kind_of(*value),
                                            ovc::quoted(name.name->text)));
    return unchanged<Number>(reader, handle, name);
}

Number parse_operand(Reader& reader) {
    const Deeper deeper(reader);
    const Token token = reader.next();
    switch (token.kind) {
    case TokenKind::Number:
        return Number::of(token.number);
    case TokenKind::Sign: {
        if (token.is('(')) {
            const Number inside = parse_logical(reader);
            reader.expect(')', "an expression");
            return inside;
        }
        if (token.is('<'))
            return parse_literal_vector(reader);
        if (token.is('+'))
            return parse_operand(reader);
        if (token.is('-')) {
            const Number n = parse_operand(reader);
            return combined(Number::of(-1), n, [](double a, double b) { return a * b; });
        }
        if (token.is('!')) {
            return Number::of(as_float(reader, parse_operand(reader)) == 0 ? 1.0 : 0.0);
        }
        break;
    }
    case TokenKind::Name:
        if (starts_color(token)) {
            reader.put_back(token);
            return parse_color_number(reader);
        }
        if (const Builtin builtin = find_builtin(token.name->text))
            return builtin(reader, token);
        if (!token.name->is_keyword)
            return parse_variable(reader, token);
        break;
    default:
        break;
    }
    reader.fail(token.place, fmt::format("found {}, expected a number", found(token)));
}

Number parse_factor(Reader& reader) {
    Number n = parse_operand(reader);
    while (reader.peek_operator().is('.')) {
        reader.next();
        n = parse_member(reader, n);
    }
    return n;
}

/// As povray, whose quotient by 0 is infinity, even of numbers below 0. Colors that have no filter
/// get none by a division.
Number divided(Reader& reader, const Token& op, Number a, Number b) {
    make_alike(a, b);
    bool by_zero = false;
    for (size_t i = 0; i < size_t(a.size); ++i) {
        const bool is_channel = i >= 3 && a.v[i] == 0;
        by_zero = by_zero || (b.v[i] == 0 && !is_channel);
        a.v[i] = b.v[i] != 0 ? a.v[i] / b.v[i]
                             : (is_channel ? 0 : std::numeric_limits<double>::infinity());
    }
    if (by_zero)
        reader.warn("division by zero", op.place,
                    "found a division by zero, whose value is infinity");
    return a;
}

Number parse_product(Reader& reader) {
    Number n = parse_factor(reader);
    for (;;) {
        const Token op = reader.peek_operator();
        if (!op.is('*') && !op.is('/'))
            return n;
        reader.next();
        const Number right = parse_factor(reader);
        if (op.is('*'))
            n = combined(n, right, [](double a, double b) { return a * b; });
        else
            n = divided(reader, op, n, right);
    }
}

bool is_comparison(const Token& token) {
    return token.kind == TokenKind::Sign &&
           std::string_view("<>=lgn").find(token.sign) != std::string_view::npos;
}

bool holds(char op, double a, double b) {
    // POV-Ray's equality has a small tolerance; its < and > have none.
    constexpr double kRoom = 1e-10;
    switch (op) {
    case '<':
        return a < b;
    case '>':
        return a > b;
    case 'l':
        return a - b <= kRoom;
    case 'g':
        return b - a <= kRoom;
    case '=':
        return std::abs(a - b) <= kRoom;
    default:
        return std::abs(a - b) > kRoom;
    }
}

Number parse_comparison(Reader& reader) {
    // Texts can only be compared for equality.
    if (starts_text(reader, reader.peek())) {
        const std::string left = parse_text(reader);
        const Token op = reader.next();
        const std::string right = parse_text(reader);
        return Number::of((left == right) == op.is('=') ? 1.0 : 0.0);
    }
    Number left = parse_number(reader);
    for (Token op = reader.peek_operator(); is_comparison(op); op = reader.peek_operator()) {
        reader.next();
        const double right = as_float(reader, parse_number(reader));
        left = Number::of(holds(op.sign, as_float(reader, left), right) ? 1.0 : 0.0);
    }
    return left;
}

/// Reads comparisons joined by & and |. Both sides are always evaluated.
Number parse_choice_of(Reader& reader) {
    Number left = parse_comparison(reader);
    for (Token op = reader.peek_operator(); op.is('&') || op.is('|'); op = reader.peek_operator()) {
        reader.next();
        const bool b = as_float(reader, parse_comparison(reader)) != 0;
        const bool a = as_float(reader, left) != 0;
        left = Number::of((op.is('&') ? a && b : a || b) ? 1.0 : 0.0);
    }
    return left;
}

/// Reads the number behind `word`: rgb, rgbf, rgbt, rgbft, or one of these with an s in front.
void parse_rgb(Reader& reader, std::string_view word, Number& color) {
    const bool is_srgb = word[0] == 's';
    const std::string_view kind = word.substr(is_srgb ? 4 : 3);
    // A float stands for the components that the word names, while a vector keeps all of its own.
    Number n = parse_number(reader);
    if (n.size == 1)
        n = resized(reader, n, 3 + int(kind.size()));
    color = resized(reader, n, 5);
    for (size_t i = 0; is_srgb && i < 3; ++i)
        color.v[i] = from_srgb(color.v[i], reader.gamma);
    if (kind == "t")
        color.v[4] = std::exchange(color.v[3], 0.0);
}

/// Returns the index of the channel in `red 0.5` and the like; -1 for any other word.
int channel(const Token& token) {
    static constexpr std::string_view kChannels[] = {"red", "green", "blue", "filter", "transmit"};
    for (int i = 0; i < 5; ++i)
        if (token.is(kChannels[i]))
            return i;
    return -1;
}

bool is_rgb(std::string_view word) {
    return word == "rgb" || word == "rgbf" || word == "rgbt" || word == "rgbft" || word == "srgb" ||
           word == "srgbf" || word == "srgbt" || word == "srgbft";
}

Number parse_color_number(Reader& reader) {
    Number color{{}, 5, true};
    bool any = false;
    for (;;) {
        const Token token = any ? reader.peek_operator() : reader.peek();
        if (const int i = channel(token); i >= 0) {
            reader.next();
            color.v[size_t(i)] = parse_float(reader);
        } else if (token.is("color") || token.is("colour")) {
            if (any)
                return color;
            reader.next();
            continue;
        } else if (token.kind == TokenKind::Name && is_rgb(token.name->text)) {
            if (any)
                return color;
            reader.next();
            parse_rgb(reader, token.name->text, color);
        } else if (!any) {
            color = parse_number(reader);
            color = resized(reader, color, 5);
        } else
            return color;
        any = true;
    }
}

} // namespace

Number parse_number(Reader& reader) {
    Number n = parse_product(reader);
    for (;;) {
        const Token op = reader.peek_operator();
        if (!op.is('+') && !op.is('-'))
            return n;
        reader.next();
        const Number right = parse_product(reader);
        if (op.is('+'))
            n = combined(n, right, [](double a, double b) { return a + b; });
        else
            n = combined(n, right, [](double a, double b) { return a - b; });
    }
}

Number parse_logical(Reader& reader) {
    const Number n = parse_choice_of(reader);
    if (!reader.peek_operator().is('?'))
        return n;
    reader.next();
    const Number yes = parse_logical(reader);
    reader.expect(':', "the first choice of ?");
    const Number no = parse_logical(reader);
    return as_float(reader, n) != 0 ? yes : no;
}

double parse_float(Reader& reader) {
    return as_float(reader, parse_number(reader));
}

int parse_int(Reader& reader, int min, int max, std::string_view what) {
    const Place at = reader.peek().place;
    const double value = parse_float(reader);
    if (!(value >= min && value < double(max) + 1))
        reader.fail(at, fmt::format("found {} as {}, expected {} to {}", value, what, min, max));
    return int(value);
}

Number resized(Reader& reader, const Number& number, int size) {
    assert(size >= 1 && size <= 5 && number.size >= 1 && number.size <= 5);
    Number n = number;
    if (n.size == 1)
        n.v.fill(n.v[0]);
    else if (n.size < size)
        std::fill(n.v.begin() + n.size, n.v.end(), 0.0);
    else if (n.size > size && !(n.is_color || size >= 3))
        reader.fail(reader.place(),
                    fmt::format("found a vector of {}, expected one of {}", n.size, size));
    n.size = size;
    n.is_color = size == 5;
    return n;
}

dvec3 vector_of(const Number& n) {
    return n.size == 1 ? dvec3(n.v[0]) : dvec3(n.v[0], n.v[1], n.size > 2 ? n.v[2] : 0);
}

Color color_of(const Number& n) {
    Color color;
    color.rgb = vec3(vector_of(n));
    if (n.size > 3)
        color.filter = float(n.v[3]);
    if (n.size > 4)
        color.transmit = float(n.v[4]);
    return color;
}

dvec3 parse_vector(Reader& reader) {
    return vector_of(resized(reader, parse_number(reader), 3));
}

dvec2 parse_vector2(Reader& reader) {
    const Number n = parse_number(reader);
    return n.size == 1 ? dvec2(n.v[0]) : dvec2(n.v[0], n.v[1]);
}

Color parse_color(Reader& reader) {
    return color_of(resized(reader, parse_color_number(reader), 5));
}

double parse_condition(Reader& reader) {
    reader.expect('(', "a condition's word");
    const Number n = parse_logical(reader);
    reader.expect(')', "a condition");
    return as_float(reader, n);
}

bool parse_flag(Reader& reader) {
    const Token token = reader.peek();
    if (token.is("on") || token.is("off") || token.is("true") || token.is("false") ||
        token.is("yes") || token.is("no") || token.kind == TokenKind::Number || token.is('('))
        return parse_float(reader) != 0;
    return true;
}

double from_srgb(double c, double gamma) {
    if (gamma == kSrgbGamma)
        return c;
    const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    return gamma == 1 ? linear : std::pow(linear, 1 / gamma);
}

bool starts_color(const Token& token) {
    return token.kind == TokenKind::Name && (token.is("color") || token.is("colour") ||
                                             is_rgb(token.name->text) || channel(token) >= 0);
}

bool starts_text(const Reader& reader, const Token& token) {
    return token.kind == TokenKind::Text || named<std::string>(reader, token) ||
           (token.kind == TokenKind::Name && find_text_function(token.name->text));
}

bool starts_number(const Reader& reader, const Token& token) {
    switch (token.kind) {
    case TokenKind::Number:
        return true;
    case TokenKind::Sign:
        return token.is('<') || token.is('(') || token.is('-') || token.is('+') || token.is('!');
    case TokenKind::Name:
        if (const auto* array = named<Array>(reader, token)) {
            const Value* item = first_item(*array);
            return item && std::holds_alternative<Number>(*item);
        }
        return starts_color(token) || find_builtin(token.name->text) ||
               named<Number>(reader, token) || named<Function>(reader, token) ||
               named<Spline>(reader, token);
    default:
        return false;
    }
}

ValueHandle parse_item(Reader& reader, Slot& slot) {
    ValueHandle handle(slot);
    size_t index = 0;
    const std::vector<size_t> sizes = std::get<Array>(slot.value).sizes;
    for (const size_t size : sizes) {
        reader.expect('[', "an array");
        const Place at = reader.peek().place;
        const double i = std::floor(parse_float(reader) + 1e-8);
        if (!(i >= 0 && i < double(size)))
            reader.fail(at, fmt::format("found the index {} of an array of {}", i, size));
        index = index * size + size_t(i);
        reader.expect(']', "an index");
    }
    handle.item = index;
    return handle;
}

const Value* first_item(const Array& array) {
    const auto first = std::find_if(array.items.begin(), array.items.end(), [](const Value& item) {
        return !std::holds_alternative<std::monostate>(item);
    });
    return first == array.items.end() ? nullptr : &*first;
}

Value& take_item(Reader& reader, const Token& name) {
    Slot* slot = reader.find(name.name);
    Value* item = nullptr;
    if (slot && std::holds_alternative<Array>(slot->value))
        item = reader.value_of(parse_item(reader, *slot));
    if (!item)
        reader.fail(name.place, fmt::format("found {}, whose index or argument changes it",
                                            ovc::quoted(name.name->text)));
    return *item;
}

/// Returns the value of hexadecimal digits, or 0 where there are other letters.
static uint32_t code_of(std::string_view digits) {
    uint32_t code = 0;
    const auto end = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
    return end.ptr == digits.data() + digits.size() ? code : 0;
}

/// Returns the UTF-8 of a code below 2^16.
static std::string utf8(uint32_t code) {
    assert(code < 0x10000);
    if (code < 0x80)
        return {char(code)};
    if (code < 0x800)
        return {char(0xc0 | code >> 6), char(0x80 | (code & 0x3f))};
    return {char(0xe0 | code >> 12), char(0x80 | (code >> 6 & 0x3f)), char(0x80 | (code & 0x3f))};
}

static std::string unescaped(std::string_view raw) {
    std::string text;
    for (size_t i = 0; i < raw.size(); ++i) {
        if (raw[i] != '\\' || i + 1 == raw.size()) {
            text += raw[i];
            continue;
        }
        const char c = raw[++i];
        switch (c) {
        case 'n':
            text += '\n';
            break;
        case 't':
            text += '\t';
            break;
        case 'u': // four hexadecimal digits follow
            text += utf8(code_of(raw.substr(i + 1, 4)));
            i += std::min<size_t>(4, raw.size() - i - 1);
            break;
        case 'a':
        case 'b':
        case 'f':
        case 'r':
        case 'v':
            text += ' ';
            break;
        default:
            text += c;
        }
    }
    return text;
}

std::string parse_text(Reader& reader) {
    const Deeper deeper(reader);
    const Token token = reader.next();
    if (token.kind == TokenKind::Text)
        return unescaped(token.text);
    if (token.kind == TokenKind::Name)
        if (const TextFunction function = find_text_function(token.name->text))
            return function(reader);
    reader.put_back(token);
    if (std::optional<std::string> text = take_named<std::string>(reader))
        return *text;
    reader.fail(token.place, fmt::format("found {}, expected a text", found(token)));
}

} // namespace ovc::pov
