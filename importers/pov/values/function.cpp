// SPDX-License-Identifier: Apache-2.0
// Turns formulas into trees of closures.
#include "importers/pov/values/function.h"

#include "core/texture/pattern.h"
#include "importers/file/text.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/texture_table.h"
#include "importers/pov/values/builtin.h"
#include "importers/pov/values/internal.h"
#include "importers/pov/values/spline.h"
#include "importers/pov/values/transform.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc::pov {

namespace {

class FormulaParser {
public:
    FormulaParser(Reader& reader, std::vector<std::string> parameters)
        : reader_(reader), parameters_(std::move(parameters)) {}

    /// Returns an upper bound on how deep closures call each other, with those of called functions.
    uint32_t depth() const { return operations_ + called_; }

    Formula whole() {
        Formula left = comparison();
        for (;;) {
            if (reader_.take('&'))
                left = both(left, comparison(), [](double a, double b) { return double(a && b); });
            else if (reader_.take('|'))
                left = both(left, comparison(), [](double a, double b) { return double(a || b); });
            else
                return left;
        }
    }

private:
    /// Calling a formula, and destroying it, takes as many stack frames as closures are nested,
    /// which is at most one for each operation.
    void count_operation() {
        ++operations_;
        if (depth() > reader_.limits.operations)
            reader_.fail(reader_.place(),
                         fmt::format("found a function of more than {} operations, those of the "
                                     "functions that it calls included",
                                     reader_.limits.operations));
    }

    template <class Op>
    Formula both(Formula a, Formula b, Op op) {
        count_operation();
        return [a = std::move(a), b = std::move(b), op](std::span<const double> x) {
            return op(a(x), b(x));
        };
    }

    Formula comparison() {
        Formula left = sum();
        for (;;) {
            if (reader_.take('<'))
                left = both(left, sum(), [](double a, double b) { return double(a < b); });
            else if (reader_.take('>'))
                left = both(left, sum(), [](double a, double b) { return double(a > b); });
            else if (reader_.take('l'))
                left = both(left, sum(), [](double a, double b) { return double(a <= b); });
            else if (reader_.take('g'))
                left = both(left, sum(), [](double a, double b) { return double(a >= b); });
            else if (reader_.take('='))
                left = both(left, sum(), [](double a, double b) { return double(a == b); });
            else if (reader_.take('n'))
                left = both(left, sum(), [](double a, double b) { return double(a != b); });
            else
                return left;
        }
    }

    Formula sum() {
        Formula left = product();
        for (;;) {
            if (reader_.take('+'))
                left = both(left, product(), [](double a, double b) { return a + b; });
            else if (reader_.take('-'))
                left = both(left, product(), [](double a, double b) { return a - b; });
            else
                return left;
        }
    }

    Formula product() {
        Formula left = operand();
        for (;;) {
            if (reader_.take('*'))
                left = both(left, operand(), [](double a, double b) { return a * b; });
            else if (reader_.take('/'))
                left = both(left, operand(), [](double a, double b) { return a / b; });
            else
                return left;
        }
    }

    Formula operand() {
        const Deeper deeper(reader_);
        count_operation();
        if (reader_.take('-')) {
            Formula inside = operand();
            return [inside](std::span<const double> x) { return -inside(x); };
        }
        if (reader_.take('+'))
            return operand();
        if (reader_.take('!')) {
            Formula inside = operand();
            return [inside](std::span<const double> x) { return double(inside(x) == 0); };
        }
        if (reader_.take('(')) {
            Formula inside = whole();
            reader_.expect(')', "a formula");
            return inside;
        }
        const Token token = reader_.next();
        if (token.kind == TokenKind::Name)
            return name(token);
        reader_.put_back(token);
        return constant(parse_number_operand());
    }

    static Formula constant(double value) {
        return [value](std::span<const double>) { return value; };
    }

    double parse_number_operand() {
        const Token token = reader_.next();
        if (token.kind != TokenKind::Number)
            reader_.fail(token.place,
                         fmt::format("found {} in a function, expected a formula", found(token)));
        return token.number;
    }

    Formula name(const Token& token) {
        const std::string& text = token.name->text;
        const auto parameter = std::find(parameters_.begin(), parameters_.end(), text);
        if (parameter != parameters_.end()) {
            const size_t i = size_t(parameter - parameters_.begin());
            return [i](std::span<const double> x) { return i < x.size() ? x[i] : 0; };
        }
        if (const FloatFunction* function = find_float_function(text))
            return call_builtin(token, *function);
        if (text == "select")
            return choice(token);
        if (const auto* function = named<Function>(reader_, token))
            return call_user(token, *function);
        if (find_builtin(text) || named<Number>(reader_, token) || named<Array>(reader_, token)) {
            // A constant: pi, a variable, an array's item or a component such as V.x.
            reader_.put_back(token);
            return constant(parse_constant());
        }
        reader_.fail(token.place,
                     fmt::format("found {} in a function, expected a formula", found(token)));
    }

    double parse_constant() {
        const Token token = reader_.next();
        assert(token.kind == TokenKind::Name);
        Number n;
        if (const Builtin builtin = find_builtin(token.name->text))
            n = builtin(reader_, token);
        else {
            reader_.put_back(token);
            n = *take_named<Number>(reader_);
        }
        return reader_.take('.') ? n.v[parse_component()] : n.v[0];
    }

    /// Returns the index of the component whose name comes next, behind the point.
    size_t parse_component() {
        static constexpr std::string_view kParts[] = {"x", "y", "z", "t", "transmit"};
        static constexpr std::string_view kColors[] = {"red", "green", "blue", "filter", ""};
        const Token part = reader_.next();
        for (size_t i = 0; i < 5; ++i)
            if (part.is(kParts[i]) || part.is(kColors[i]))
                return i;
        reader_.fail(part.place, fmt::format("found {} after '.', expected a component such as x",
                                             found(part)));
    }

    std::vector<Formula> arguments(const Token& token) {
        std::vector<Formula> formulas;
        reader_.expect('(', token.name->text);
        while (!reader_.take(')')) {
            formulas.push_back(whole());
            reader_.take_comma();
        }
        return formulas;
    }

    Formula call_builtin(const Token& token, const FloatFunction& function) {
        const std::vector<Formula> given = arguments(token);
        const bool any = function.count < 0;
        if (given.empty() || (!any && given.size() != size_t(function.count)) || given.size() > 8)
            reader_.fail(token.place,
                         fmt::format("found {} arguments to {}, expected {}", given.size(),
                                     token.name->text, any ? 2 : function.count));
        if (any) // min and max take two arguments at a time
            return [given, call = function.call](std::span<const double> x) {
                double pair[2] = {given[0](x), 0};
                for (size_t i = 1; i < given.size(); ++i) {
                    pair[1] = given[i](x);
                    pair[0] = call(pair);
                }
                return pair[0];
            };
        return [given, call = function.call](std::span<const double> x) {
            double values[8];
            for (size_t i = 0; i < given.size(); ++i)
                values[i] = given[i](x);
            return call(values);
        };
    }

    Formula choice(const Token& token) {
        const std::vector<Formula> given = arguments(token);
        if (given.size() != 3 && given.size() != 4)
            reader_.fail(token.place, fmt::format("found {} arguments to select, expected 3 or 4",
                                                  given.size()));
        return [given](std::span<const double> x) {
            const double sign = given[0](x);
            return sign < 0 ? given[1](x) : sign == 0 ? given[2](x) : given.back()(x);
        };
    }

    Formula call_user(const Token& token, Function function) {
        const std::vector<Formula> given = arguments(token);
        called_ = std::max(called_, function.depth);
        count_operation();
        if (function.color)
            return call_color(given, function.color);
        return [given, function = std::move(function), token,
                this_reader = &reader_](std::span<const double> x) {
            std::vector<double> values;
            for (const Formula& formula : given)
                values.push_back(formula(x));
            return pov::call(*this_reader, token, function, values).v[0];
        };
    }

    /// Reads the component of a pigment's color, such as .red, behind the pigment's point.
    Formula call_color(std::vector<Formula> given, ColorFormula color) {
        reader_.expect('.', "the color of a pigment");
        if (reader_.take("gray") || reader_.take("grey"))
            return [given = std::move(given), color = std::move(color)](std::span<const double> x) {
                const vec3 rgb = color(point(given, x)).rgb;
                return double(0.297f * rgb.x + 0.589f * rgb.y + 0.114f * rgb.z);
            };
        const size_t component = parse_component();
        return [given = std::move(given), color = std::move(color),
                component](std::span<const double> x) {
            const Color c = color(point(given, x));
            const float all[5] = {c.rgb.x, c.rgb.y, c.rgb.z, c.filter, c.transmit};
            return double(all[component]);
        };
    }

    static dvec3 point(const std::vector<Formula>& given, std::span<const double> x) {
        dvec3 at(0);
        for (size_t i = 0; i < 3 && i < given.size(); ++i)
            at[int(i)] = given[i](x);
        return at;
    }

    Reader& reader_;
    const std::vector<std::string> parameters_;
    uint32_t operations_ = 0;
    uint32_t called_ = 0; // the depth of the deepest function that it calls
};

std::vector<std::string> parse_parameters(Reader& reader) {
    if (!reader.take('('))
        return {"x", "y", "z"};
    std::vector<std::string> parameters;
    while (!reader.take(')')) {
        const Token token = reader.next();
        if (token.kind != TokenKind::Name)
            reader.fail(token.place, fmt::format("found {} in the parameters of a function, "
                                                 "expected a name",
                                                 found(token)));
        parameters.push_back(token.name->text);
        reader.take_comma();
    }
    return parameters;
}

} // namespace

/// Reads `internal(N)`, with which functions.inc declares its functions.
static void parse_internal(Reader& reader, Function& function) {
    reader.next();
    reader.expect('(', "internal");
    const int number = parse_int(reader, 0, 1000, "the number of a function");
    reader.expect(')', "internal");
    const Internal internal = find_internal(number);
    if (!internal.call) {
        function.refused =
            fmt::format("the function is internal({}), which Overcast does not compute", number);
        return;
    }
    function.parameters = size_t(internal.count);
    assert(function.parameters <= 8);
    function.formula = [internal](std::span<const double> x) {
        std::array<double, 8> all{};
        std::copy_n(x.begin(), std::min(x.size(), all.size()), all.begin());
        return internal.call(all);
    };
}

/// Reads the { … } of `pattern` or `pigment`, whose word is `what`.
static void parse_pattern_function(Reader& reader, const Token& what, Function& function) {
    reader.expect('{', what.name->text);
    const bool is_pattern = what.is("pattern");
    const Pigment pigment =
        parse_pigment_parts(reader, is_pattern ? Pigment{} : reader.defaults.pigment, '}');
    reader.expect('}', what.name->text);
    if (!pigment.notes.empty() || (is_pattern && !pigment.pattern)) {
        function.refused =
            fmt::format("the function is a {} that Overcast does not compute", what.name->text);
        return;
    }
    if (!is_pattern) {
        function.color = color_function(pigment);
        return;
    }
    function.formula = [pattern = pigment.pattern,
                        back = glm::inverse(pigment.placed)](std::span<const double> x) {
        dvec4 at(0, 0, 0, 1);
        for (size_t i = 0; i < 3 && i < x.size(); ++i)
            at[int(i)] = x[i];
        return evaluate(pattern->pattern, dvec3(back * at)).value;
    };
}

Function parse_function(Reader& reader) {
    Function function;
    const std::vector<std::string> parameters = parse_parameters(reader);
    function.parameters = parameters.size();
    if (!reader.peek().is('{')) { // the grid of an image or a height_field
        function.grid.x = parse_float(reader);
        reader.take_comma();
        function.grid.y = parse_float(reader);
    }
    reader.expect('{', "function");
    const Token first = reader.peek();
    if (reader.take("transform"))
        function.transform = parse_transform_block(reader);
    else if (reader.take("spline"))
        function.spline = parse_spline(reader);
    else if (first.is("internal"))
        parse_internal(reader, function);
    else if (reader.take("pigment") || reader.take("pattern"))
        parse_pattern_function(reader, first, function);
    else {
        FormulaParser parser(reader, parameters);
        function.formula = parser.whole();
        function.depth = parser.depth();
    }
    reader.expect('}', "a function");
    return function;
}

Number call(Reader& reader, const Token& name, const Function& function,
            std::span<const double> arguments) {
    reader.spend(1);
    if (!function.refused.empty())
        reader.fail(name.place, fmt::format("{} cannot be called: {}", ovc::quoted(name.name->text),
                                            function.refused));
    assert(function.formula || function.color || function.spline || function.transform);
    if (function.formula)
        return Number::of(function.formula(arguments));
    if (function.spline)
        return at(*function.spline, arguments.empty() ? 0 : arguments[0]);
    const auto argument = [&](size_t i) { return i < arguments.size() ? arguments[i] : 0; };
    if (function.color) {
        const Color c = function.color({argument(0), argument(1), argument(2)});
        return {{c.rgb.x, c.rgb.y, c.rgb.z, c.filter, c.transmit}, 5, true};
    }
    return Number::of(dvec3(*function.transform * dvec4(argument(0), argument(1), argument(2), 1)));
}

} // namespace ovc::pov
