// SPDX-License-Identifier: Apache-2.0
// Turns formulas into programs.
#include "importers/pov/values/function.h"

#include "core/texture/pattern.h"
#include "importers/file/text.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/texture_table.h"
#include "importers/pov/values/builtin.h"
#include "importers/pov/values/spline.h"
#include "importers/pov/values/transform.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc::pov {

namespace {

using StepKind = FormulaStep::Kind;

/// Returns a program of the transform's component at a point.
ProgramPtr transform_program(const dmat4& transform, size_t component) {
    ProgramBuilder program;
    program.constant(transform[3][int(component)]);
    for (int i = 0; i < 3; ++i) {
        program.add(StepKind::Argument, uint32_t(i));
        program.constant(component < 3 ? transform[i][int(component)] : 0);
        program.add(StepKind::Multiply);
        program.add(StepKind::Add);
    }
    return program.take();
}

/// Adds the cubic through four values at first + width x {0, 1/3, 2/3, 1}.
void add_cubic(ProgramBuilder& program, double first, double width,
               const std::array<double, 4>& v) {
    // Coefficients of powers of t = 3 (clock - first) / width, by Newton's divided differences.
    const double d1 = v[1] - v[0], d2 = (v[2] - 2 * v[1] + v[0]) / 2,
                 d3 = (v[3] - 3 * v[2] + 3 * v[1] - v[0]) / 6;
    const double powers[] = {d3, d2 - 3 * d3, d1 - d2 + 2 * d3, v[0]};
    program.constant(powers[0]);
    for (int i = 1; i < 4; ++i) {
        program.add(StepKind::Argument);
        program.constant(first);
        program.add(StepKind::Subtract);
        program.constant(3 / width);
        program.add(StepKind::Multiply);
        program.add(StepKind::Multiply);
        program.constant(powers[i]);
        program.add(StepKind::Add);
    }
}

/// Returns a program of the spline's component at a clock: a cubic for each piece.
ProgramPtr spline_program(const Spline& spline, size_t component) {
    ProgramBuilder program;
    const auto value = [&](double clock) { return at(spline, spline.kind, clock).v[component]; };
    // select(clock - last, select(… select(clock - first, before, piece) …, piece), piece)
    for (auto point = spline.points.rbegin(); point != spline.points.rend(); ++point) {
        program.add(StepKind::Argument);
        program.constant(point->first);
        program.add(StepKind::Subtract);
    }
    program.constant(value(spline.points.begin()->first));
    for (auto point = spline.points.begin(); point != spline.points.end(); ++point) {
        const double first = point->first;
        const auto next = std::next(point);
        if (next == spline.points.end()) {
            program.constant(value(first));
        } else {
            const double width = next->first - first;
            add_cubic(program, first, width,
                      {value(first), value(first + width / 3), value(first + width * 2 / 3),
                       value(next->first)});
        }
        program.add(StepKind::Select, 0, 3);
    }
    return program.take();
}

/// Turns a formula into steps, an operation behind its operands.
class FormulaParser {
public:
    FormulaParser(Reader& reader, std::vector<std::string> parameters)
        : reader_(reader), parameters_(std::move(parameters)) {}

    /// Returns an upper bound on how deep operations lie in each other, with those of functions
    /// that are called.
    uint32_t depth() const { return operations_ + called_; }

    ProgramPtr program() {
        whole();
        const Place place = reader_.place();
        ProgramPtr made = program_.take();
        if (!made)
            reader_.fail(place, "found a function that takes more than a million steps");
        return made;
    }

private:
    struct Operator {
        char sign;
        StepKind kind;
    };

    /// Reads `operand sign operand sign operand …`, from left to right.
    template <size_t N, class Operand>
    void chain(const Operator (&operators)[N], const Operand& operand) {
        operand();
        for (;;) {
            const auto found = std::find_if(
                std::begin(operators), std::end(operators),
                [&](const Operator& candidate) { return reader_.take(candidate.sign); });
            if (found == std::end(operators))
                return;
            operand();
            count_operation();
            program_.add(found->kind);
        }
    }

    void whole() {
        static constexpr Operator kSigns[] = {{'&', StepKind::And}, {'|', StepKind::Or}};
        chain(kSigns, [&] { comparison(); });
    }

    void comparison() {
        static constexpr Operator kSigns[] = {
            {'<', StepKind::Less},           {'>', StepKind::Greater}, {'l', StepKind::LessOrEqual},
            {'g', StepKind::GreaterOrEqual}, {'=', StepKind::Equal},   {'n', StepKind::NotEqual}};
        chain(kSigns, [&] { sum(); });
    }

    void sum() {
        static constexpr Operator kSigns[] = {{'+', StepKind::Add}, {'-', StepKind::Subtract}};
        chain(kSigns, [&] { product(); });
    }

    void product() {
        static constexpr Operator kSigns[] = {{'*', StepKind::Multiply}, {'/', StepKind::Divide}};
        chain(kSigns, [&] { operand(); });
    }

    void count_operation() {
        ++operations_;
        if (depth() > reader_.limits.operations)
            reader_.fail(reader_.place(),
                         fmt::format("found a function of more than {} operations, those of the "
                                     "functions that it calls included",
                                     reader_.limits.operations));
    }

    void operand() {
        const Deeper deeper(reader_);
        count_operation();
        if (reader_.take('-')) {
            operand();
            program_.add(StepKind::Negate);
        } else if (reader_.take('+')) {
            operand();
        } else if (reader_.take('!')) {
            operand();
            program_.add(StepKind::Not);
        } else if (reader_.take('(')) {
            whole();
            reader_.expect(')', "a formula");
        } else if (const Token token = reader_.next(); token.kind == TokenKind::Name) {
            name(token);
        } else if (token.kind == TokenKind::Number) {
            program_.constant(token.number);
        } else
            reader_.fail(token.place,
                         fmt::format("found {} in a function, expected a formula", found(token)));
    }

    void name(const Token& token) {
        const std::string& text = token.name->text;
        const auto parameter = std::find(parameters_.begin(), parameters_.end(), text);
        if (parameter != parameters_.end()) {
            program_.add(StepKind::Argument, uint32_t(parameter - parameters_.begin()));
        } else if (const FloatFunction* function = find_float_function(text)) {
            call_builtin(token, *function);
        } else if (text == "select") {
            choice(token);
        } else if (text == "sum" || text == "prod") {
            series(token, text == "sum" ? StepKind::Add : StepKind::Multiply);
        } else if (const auto* user_function = named<Function>(reader_, token)) {
            call_user(token, *user_function);
        } else if (find_builtin(text) || named<Number>(reader_, token) ||
                   named<Array>(reader_, token)) {
            // A constant: pi, a variable, an array's item or a component such as V.x.
            reader_.put_back(token);
            program_.constant(parse_constant());
        } else
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

    /// Reads arguments, whose values are then on the stack. Calls each() behind each but the first.
    template <class Each>
    uint32_t arguments(const Token& token, const Each& each) {
        uint32_t count = 0;
        reader_.expect('(', token.name->text);
        while (!reader_.take(')')) {
            whole();
            if (count++ > 0)
                each();
            reader_.take_comma();
        }
        return count;
    }
    uint32_t arguments(const Token& token) {
        return arguments(token, [] {});
    }

    void call_builtin(const Token& token, const FloatFunction& function) {
        const auto number = uint32_t(&function - float_functions().data());
        const bool any = function.count < 0; // min and max take two arguments at a time
        const uint32_t given = arguments(token, [&] {
            if (any)
                program_.add(StepKind::Builtin, number);
        });
        if (given == 0 || (!any && given != uint32_t(function.count)))
            reader_.fail(token.place, fmt::format("found {} arguments to {}, expected {}", given,
                                                  token.name->text, any ? 2 : function.count));
        if (!any)
            program_.add(StepKind::Builtin, number);
    }

    void choice(const Token& token) {
        const uint32_t given = arguments(token);
        if (given != 3 && given != 4)
            reader_.fail(token.place,
                         fmt::format("found {} arguments to select, expected 3 or 4", given));
        program_.add(StepKind::Select, 0, given);
    }

    /// Reads `sum(NAME, FROM, TO, FORMULA)` or `prod(…)`: a call of the formula for each number.
    void series(const Token& token, StepKind kind) {
        reader_.expect('(', token.name->text);
        const Token index = reader_.next();
        if (index.kind != TokenKind::Name)
            reader_.fail(index.place, fmt::format("found {}, expected the name of a number that {} "
                                                  "counts up",
                                                  found(index), token.name->text));
        reader_.take_comma();
        const double from = bound(), to = bound();
        std::vector<std::string> parameters = parameters_;
        std::ranges::replace(parameters, index.name->text, std::string());
        parameters.push_back(index.name->text);
        FormulaParser part(reader_, parameters);
        const ProgramPtr program = part.program();
        reader_.expect(')', token.name->text);
        called_ = std::max(called_, part.depth());
        count_operation();
        program_.constant(kind == StepKind::Add ? 0 : 1);
        for (double i = from; i <= to; ++i) {
            for (uint32_t argument = 0; argument < parameters_.size(); ++argument)
                program_.add(StepKind::Argument, argument);
            program_.constant(i);
            program_.call(program, uint32_t(parameters.size()));
            program_.add(kind);
        }
    }

    /// Reads a bound of a sum or product, and the comma behind it.
    double bound() {
        constexpr double kMaxBound = 10'000;
        const Place at = reader_.peek().place;
        const ProgramPtr program = FormulaParser(reader_, parameters_).program();
        const Formula& formula = program->formula;
        const size_t routines = formula.ends.size();
        const size_t first = routines > 1 ? formula.ends[routines - 2] : 0; // step of the last one
        const bool varies =
            std::any_of(formula.steps.begin() + ptrdiff_t(first), formula.steps.end(),
                        [](const FormulaStep& step) { return step.kind == StepKind::Argument; });
        const double value = varies ? double(NAN) : (*program)({});
        if (!(std::abs(value) <= kMaxBound))
            reader_.fail(at, "expected a number from -10000 to 10000, which does not depend on the "
                             "function's parameters, as the bound of a sum or product");
        reader_.take_comma();
        return value;
    }

    void call_user(const Token& token, const Function function) {
        if (!function.refused.empty())
            reader_.fail(token.place, fmt::format("{} cannot be called: {}",
                                                  ovc::quoted(token.name->text), function.refused));
        uint32_t given = arguments(token);
        called_ = std::max(called_, function.depth);
        count_operation();
        if (function.formula) {
            program_.call(function.program, given);
            return;
        }
        for (; given < 3 && !function.spline; ++given)
            program_.constant(0);
        if (function.color)
            call_color(given, function);
        else if (function.spline)
            call_component(given, [&](size_t i) { return spline_program(*function.spline, i); });
        else
            call_component(given,
                           [&](size_t i) { return transform_program(*function.transform, i); });
    }

    /// Reads the component of a pigment's color, such as .red, behind the pigment's point.
    void call_color(uint32_t given, const Function& function) {
        if (given != 3)
            reader_.fail(reader_.place(), fmt::format("found {} arguments to a pigment's function, "
                                                      "expected 3",
                                                      given));
        reader_.expect('.', "the color of a pigment");
        const bool is_gray = reader_.take("gray") || reader_.take("grey");
        program_.texture(StepKind::Color, function.program,
                         is_gray ? 5 : uint32_t(parse_component()));
    }

    /// Reads the component of a vector behind the call that gives it; the first without one.
    template <class ProgramOf>
    void call_component(uint32_t given, const ProgramOf& program_of) {
        const size_t component = reader_.take('.') ? parse_component() : 0;
        const ProgramPtr program = program_of(component);
        if (!program)
            reader_.fail(reader_.place(), "found a spline with too many points for a function");
        program_.call(program, given);
    }

    Reader& reader_;
    const std::vector<std::string> parameters_;
    ProgramBuilder program_;
    uint32_t operations_ = 0;
    uint32_t called_ = 0; // the depth of the deepest function that it calls
};

/// usual: their names where none are given.
std::vector<std::string> parse_parameters(Reader& reader, std::vector<std::string> usual) {
    if (!reader.take('('))
        return usual;
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

/// Makes the function call the program.
static void set_program(Function& function, ProgramPtr program) {
    function.program = program;
    function.formula = [program = std::move(program)](std::span<const double> x) {
        return (*program)(x);
    };
}

/// Reads `internal(N)`, with which functions.inc declares its functions.
static void parse_internal(Reader& reader, Function& function) {
    reader.next();
    reader.expect('(', "internal");
    const int number = parse_int(reader, 0, 1000, "the number of a function");
    reader.expect(')', "internal");
    const InternalFunction internal = internal_function(uint32_t(number));
    if (!internal.call) {
        function.refused =
            fmt::format("the function is internal({}), which Overcast does not compute", number);
        return;
    }
    function.parameters = size_t(internal.count);
    ProgramBuilder program;
    for (uint32_t i = 0; i < uint32_t(internal.count); ++i)
        program.add(StepKind::Argument, i);
    program.add(StepKind::Internal, uint32_t(number), uint32_t(internal.count));
    set_program(function, program.take());
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
    const ProgramPtr colors = color_program(pigment);
    if (!is_pattern) {
        function.program = colors;
        function.color = [colors](const dvec3& at) {
            return color_at(colors->textures, uint32_t(colors->textures.size() - 1), at);
        };
        return;
    }
    ProgramBuilder program;
    for (uint32_t i = 0; i < 3; ++i)
        program.add(StepKind::Argument, i);
    program.texture(StepKind::Value, colors);
    set_program(function, program.take());
}

Function parse_function(Reader& reader, std::vector<std::string> usual) {
    Function function;
    const std::vector<std::string> parameters = parse_parameters(reader, std::move(usual));
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
        set_program(function, parser.program());
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
        return at(*function.spline, function.spline->kind, arguments.empty() ? 0 : arguments[0]);
    const auto argument = [&](size_t i) { return i < arguments.size() ? arguments[i] : 0; };
    if (function.color) {
        const Color c = function.color({argument(0), argument(1), argument(2)});
        return {{c.rgb.x, c.rgb.y, c.rgb.z, c.filter, c.transmit}, 5, true};
    }
    return Number::of(dvec3(*function.transform * dvec4(argument(0), argument(1), argument(2), 1)));
}

} // namespace ovc::pov
