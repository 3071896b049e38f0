// SPDX-License-Identifier: Apache-2.0
// Obeys directives: declarations, conditions, loops, includes, macros and messages.
#include "importers/file/text.h"
#include "importers/pov/words/files.h"
#include "importers/pov/words/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <unordered_map>

namespace ovc::pov {

namespace {

bool opens_block(std::string_view d) {
    return d == "if" || d == "ifdef" || d == "ifndef" || d == "while" || d == "for" ||
           d == "switch" || d == "macro";
}

} // namespace

void Reader::obey(const Token& at) {
    using Action = void (*)(Reader&, const Token&);
    static const std::unordered_map<std::string_view, Action> kActions = {
        {"declare", [](Reader& r, const Token&) { r.do_declare(false); }},
        {"local", [](Reader& r, const Token&) { r.do_declare(true); }},
        {"undef", [](Reader& r, const Token&) { r.do_undef(); }},
        {"include", [](Reader& r, const Token&) { r.do_include(); }},
        {"if", [](Reader& r, const Token& t) { r.do_if(r.condition(), t.place); }},
        {"ifdef", [](Reader& r, const Token& t) { r.do_if(r.is_defined(), t.place); }},
        {"ifndef", [](Reader& r, const Token& t) { r.do_if(!r.is_defined(), t.place); }},
        {"else", [](Reader& r, const Token& t) { r.do_else(t); }},
        {"elseif", [](Reader& r, const Token& t) { r.do_else(t); }},
        {"case", [](Reader& r, const Token& t) { r.do_else(t); }},
        {"range", [](Reader& r, const Token& t) { r.do_else(t); }},
        {"end", [](Reader& r, const Token& t) { r.do_end(t); }},
        {"while", [](Reader& r, const Token& t) { r.do_while(t); }},
        {"for", [](Reader& r, const Token& t) { r.do_for(t); }},
        {"switch", [](Reader& r, const Token& t) { r.do_switch(t); }},
        {"break", [](Reader& r, const Token& t) { r.do_break(t); }},
        {"macro", [](Reader& r, const Token&) { r.do_macro(); }},
        {"version", [](Reader& r, const Token&) { r.do_version(); }},
        {"default", [](Reader& r, const Token&) { r.hooks_.defaults(r); }},
        {"error", [](Reader& r, const Token& t) { r.do_message(t); }},
        {"warning", [](Reader& r, const Token& t) { r.do_message(t); }},
        {"debug", [](Reader& r, const Token& t) { r.do_message(t); }},
        {"render", [](Reader& r, const Token& t) { r.do_message(t); }},
        {"statistics", [](Reader& r, const Token& t) { r.do_message(t); }},
        {"fopen", [](Reader& r, const Token&) { r.do_fopen(); }},
        {"fclose", [](Reader& r, const Token&) { r.do_fclose(); }},
        {"read", [](Reader& r, const Token&) { r.do_read(); }},
        {"write", [](Reader& r, const Token&) { r.do_write(); }}};
    const auto action = kActions.find(at.name->text);
    if (action == kActions.end())
        fail(at.place,
             fmt::format("found #{}, expected a directive that Overcast knows", at.name->text));
    const std::optional<Depth> outer =
        std::exchange(obeys_, Depth{frames_.size(), frame().open.size(), brackets_});
    action->second(*this, at);
    obeys_ = outer;
}

Name* Reader::raw_name(std::string_view after) {
    const Token token = raw();
    last_ = token.place;
    if (token.kind != TokenKind::Name)
        fail(token.place,
             fmt::format("found {} after {}, expected an identifier", found(token), after));
    if (token.name->is_keyword)
        fail(token.place, fmt::format("found {} after {}, which is a word of the language, "
                                      "expected an identifier",
                                      found(token), after));
    return token.name;
}

void Reader::raw_expect(char c, std::string_view after) {
    const Token token = raw();
    if (!token.is(c))
        fail(token.place, fmt::format("found {} after {}, expected '{}'", found(token), after, c));
}

void Reader::take_semicolon() {
    if (!back_.empty()) {
        if (back_.back().is(';'))
            back_.pop_back();
    } else if (!frames_.empty() && peek_raw().is(';'))
        ++frame().at;
}

void Reader::do_declare(bool local) {
    const Deeper deeper(*this);
    Name* name = raw_name(local ? "#local" : "#declare");
    if (name->text == "deprecated") { // the form is: deprecated once "why" NAME
        while (peek_raw().kind == TokenKind::Text || peek_raw().is("once"))
            raw();
        name = raw_name("deprecated");
    }
    if (peek_raw().is('[')) {
        Slot* slot = find(name);
        if (!slot || !std::holds_alternative<Array>(slot->value))
            fail(last_, fmt::format("{} is no array", name->text));
        const ValueHandle handle = hooks_.item(*this, *slot);
        expect('=', name->text);
        Value value = hooks_.value(*this);
        // The macro with this directive may have ended, and its array with it.
        if (Value* item = value_of(handle)) {
            count_depth(std::get<Array>(handle.slot->value), value);
            *item = std::move(value);
        }
        changed();
        return take_semicolon();
    }
    raw_expect('=', name->text);
    // A macro that gives the value may still run afterwards, and the macro with this directive may
    // have ended, which removes its variables. So the scope is chosen before.
    const uint32_t scope = scope_of(name, local);
    const Declaring outer = std::exchange(declaring_, {name, scope});
    Value value = hooks_.value(*this);
    declaring_ = outer;
    if (scope < scopes_.size())
        declare_in(scope, name).value = std::move(value);
    take_semicolon();
}

void Reader::do_undef() {
    undefine(raw_name("#undef"));
    take_semicolon();
}

void Reader::do_include() {
    const Place at = last_;
    Value value;
    if (peek_raw().kind == TokenKind::Text)
        value = std::string(raw().text);
    else
        value = hooks_.value(*this);
    const std::string* name = std::get_if<std::string>(&value);
    if (!name)
        fail(at,
             fmt::format("found {} after #include, expected the name of a file", kind_of(value)));
    if (frames_.size() >= limits.nesting)
        fail(at, fmt::format("found macros and includes more than {} deep in each other: {} does "
                             "not end",
                             limits.nesting, ovc::quoted(*name)));
    const SourceFile* file = included(*name, at);
    const uint32_t scope = push_scope();
    frames_.push_back({file, 0, file->tokens.size() - 1, false, scope, {}, at});
}

/// Returns the file of this name that the scene has written, or else one on the disk.
const SourceFile* Reader::included(const std::string& name, const Place& at) {
    if (const std::string* text = written(name)) {
        SourceFile*& file = by_path_[name];
        if (!file || file->text != *text) { // a macro may still run in what was written before
            spend(text->size() / 16);
            grow(text->size() * (1 + sizeof(Token) / 2));
            file = &add_file(name, folder_, *text);
        }
        return file;
    }
    const std::filesystem::path path = find_file(name, ".inc");
    if (path.empty())
        fail(at, fmt::format("there is no file {}, neither beside the scene nor among POV-Ray's "
                             "include files",
                             ovc::quoted(name)));
    SourceFile*& file = by_path_[path.string()];
    if (!file) {
        Result<std::string> text = read_text(path, files_read_);
        if (!text)
            fail(at, text.error().message);
        file = &add_file(path.string(), path.parent_path().string(), std::move(*text));
    }
    return file;
}

SourceFile& Reader::add_file(std::string name, std::string folder, std::string text) {
    files_.push_back(std::make_unique<SourceFile>());
    SourceFile& file = *files_.back();
    file.name = std::move(name);
    file.folder = std::move(folder);
    file.text = std::move(text);
    tokenize(file, names_);
    return file;
}

const std::string* Reader::written(const std::string& name) const {
    const auto at = written_.find(name);
    return at == written_.end() ? nullptr : &at->second;
}

std::filesystem::path Reader::find_file(const std::string& name, std::string_view extension) const {
    std::vector<std::string> folders = {folder_};
    for (auto f = frames_.rbegin(); f != frames_.rend(); ++f)
        if (folders.back() != f->file->folder)
            folders.push_back(f->file->folder);
    return pov::find_file(name, extension, folders, files_read_);
}

bool Reader::condition() {
    assert(!frames_.empty());
    const std::optional<Depth> outer =
        std::exchange(condition_, Depth{frames_.size(), frame().open.size(), brackets_});
    const bool holds = hooks_.condition(*this) != 0;
    condition_ = outer;
    return holds;
}

/// Fails where a directive would end the block that a condition under way belongs to, or one around
/// it. blocks_that_stay: how many of the frame's blocks it leaves open.
void Reader::check_is_no_condition(const Token& at, size_t blocks_that_stay) {
    if (condition_ && frames_.size() == condition_->frames && blocks_that_stay < condition_->blocks)
        fail(at.place, fmt::format("found #{} of a block within its condition", at.name->text));
}

bool Reader::is_defined() {
    raw_expect('(', "#ifdef");
    const Token token = raw();
    if (token.kind != TokenKind::Name)
        fail(token.place,
             fmt::format("found {} after #ifdef, expected an identifier", found(token)));
    Slot* slot = find(token.name);
    bool defined =
        token.name->is_keyword || (slot && !std::holds_alternative<std::monostate>(slot->value));
    if (peek_raw().is('[')) {
        if (!slot || !std::holds_alternative<Array>(slot->value))
            fail(token.place, fmt::format("{} is no array", token.name->text));
        const Value* item = value_of(hooks_.item(*this, *slot));
        defined = item && !std::holds_alternative<std::monostate>(*item);
    }
    expect(')', "#ifdef");
    return defined;
}

std::string_view Reader::skip(bool stop_at_else, bool stop_at_case) {
    const int64_t brackets = brackets_; // skipped brackets do not count
    size_t depth = 0;
    for (;;) {
        brackets_ = brackets;
        if (frame().at >= frame().end)
            fail(frame().open.back().place, "found no #end to this");
        const Token token = raw();
        if (token.kind != TokenKind::Directive)
            continue;
        const std::string_view d = token.name->text;
        if (opens_block(d))
            ++depth;
        else if (d == "end") {
            if (depth-- == 0)
                return d;
        } else if (depth == 0 && ((stop_at_else && (d == "else" || d == "elseif")) ||
                                  (stop_at_case && (d == "case" || d == "range" || d == "else"))))
            return d;
    }
}

void Reader::do_if(bool condition_holds, const Place& at) {
    frame().open.push_back({Condition::Kind::If});
    frame().open.back().place = at;
    while (!condition_holds) {
        const std::string_view stop = skip(/* stop_at_else= */ true, /* stop_at_case= */ false);
        if (stop == "end") {
            frame().open.pop_back();
            return;
        }
        condition_holds = stop == "else" || condition();
    }
}

void Reader::do_else(const Token& at) {
    const std::string_view d = at.name->text;
    if (frame().open.empty() || frame().open.back().kind == Condition::Kind::While ||
        frame().open.back().kind == Condition::Kind::For ||
        (frame().open.back().kind == Condition::Kind::If && (d == "case" || d == "range")))
        fail(at.place, fmt::format("found #{} without what it belongs to", d));
    check_is_no_condition(at, frame().open.size() - 1);
    if (frame().open.back().kind == Condition::Kind::Switch) {
        // The case before this one falls through, as in C.
        if (d == "case" || d == "range")
            case_matches(d, 0);
        return;
    }
    skip(false, false);
    frame().open.pop_back();
}

void Reader::do_end(const Token& at) {
    if (frame().open.empty())
        fail(at.place, "found #end without what it ends");
    check_is_no_condition(at, frame().open.size() - 1);
    Condition& open = frame().open.back();
    if (open.kind == Condition::Kind::While) {
        test_while(open);
    } else if (open.kind == Condition::Kind::For) {
        if (auto* counter = std::get_if<Number>(&open.counter->value)) {
            *counter = Number::of(counter->v[0] + open.step);
            if (test_for(open)) {
                frame().at = open.start;
                return;
            }
        }
        frame().open.pop_back();
    } else
        frame().open.pop_back();
}

void Reader::do_while(const Token& at) {
    Condition loop{Condition::Kind::While};
    loop.start = frame().at;
    loop.place = at.place;
    loop.progress = {grown_, run_over_, 0};
    frame().open.push_back(loop);
    test_while(frame().open.back());
}

void Reader::count_round(Condition& loop) const {
    ++loop.rounds;
    if (loop.progress.grown != grown_)
        loop.progress = {grown_, run_over_, loop.rounds};
    if (loop.reads != reads_) {
        loop.reads = reads_;
        loop.rounds_at_read = loop.rounds;
    }
    if (loop.kind == Condition::Kind::While && loop.rounds - loop.rounds_at_read > limits.rounds)
        fail(loop.place,
             fmt::format("stopped after {} rounds: the loop does not end", loop.rounds));
    const uint64_t idle = loop.rounds - loop.progress.rounds;
    if (idle > limits.idle_rounds && run_over_ - loop.progress.tokens > limits.idle_tokens)
        fail(loop.place, fmt::format("stopped after {} rounds that made nothing: the loop does not "
                                     "end",
                                     idle));
}

void Reader::test_while(Condition& loop) {
    assert(loop.kind == Condition::Kind::While);
    if (loop.rounds > 0 && loop.changes == changes_)
        fail(loop.place, "stopped after a round that changed nothing: the loop does not end");
    count_round(loop);
    loop.changes = changes_;
    frame().at = loop.start;
    if (condition())
        return;
    skip(false, false);
    frame().open.pop_back();
}

void Reader::do_for(const Token& at) {
    raw_expect('(', "#for");
    Name* name = raw_name("#for");
    expect(',', "the counter of #for");
    const double first = hooks_.number(*this);
    expect(',', "the first value of #for");
    Condition loop{Condition::Kind::For};
    loop.last = hooks_.number(*this);
    loop.step = take(',') ? hooks_.number(*this) : 1;
    expect(')', "the values of #for");
    if (loop.step == 0)
        fail(at.place, "found a #for whose step is 0");
    Slot& counter = declare(name, /* local= */ true);
    counter.value = Number::of(first);
    loop.counter = &counter;
    loop.start = frame().at;
    loop.place = at.place;
    loop.progress = {grown_, run_over_, 0};
    frame().open.push_back(loop);
    if (test_for(frame().open.back()))
        return;
    skip(false, false);
    frame().open.pop_back();
}

bool Reader::test_for(Condition& loop) const {
    assert(loop.kind == Condition::Kind::For && loop.counter);
    count_round(loop);
    // As in POV-Ray 3.7 the last value may be missed by a rounding error.
    const double at = std::get<Number>(loop.counter->value).v[0];
    const double slack = std::abs(loop.step) * 1e-10;
    return loop.step > 0 ? at <= loop.last + slack : at >= loop.last - slack;
}

void Reader::do_switch(const Token& at) {
    Condition chosen{Condition::Kind::Switch};
    chosen.place = at.place;
    chosen.value = hooks_.condition(*this);
    frame().open.push_back(chosen);
    next_case();
}

void Reader::next_case() {
    assert(!frame().open.empty() && frame().open.back().kind == Condition::Kind::Switch);
    const double value = frame().open.back().value;
    for (;;) {
        const std::string_view stop = skip(/* stop_at_else= */ false, /* stop_at_case= */ true);
        if (stop == "end")
            return frame().open.pop_back();
        if (stop == "else" || case_matches(stop, value))
            return;
    }
}

bool Reader::case_matches(std::string_view directive, double value) {
    if (directive == "case")
        return hooks_.condition(*this) == value;
    expect('(', "#range");
    const double min = hooks_.number(*this);
    take_comma();
    const double max = hooks_.number(*this);
    expect(')', "#range");
    return value >= min && value <= max;
}

void Reader::do_break(const Token& at) {
    std::vector<Condition>& open = frame().open;
    const auto loop = std::find_if(open.rbegin(), open.rend(), [](const Condition& c) {
        return c.kind != Condition::Kind::If;
    });
    if (loop == open.rend()) {
        if (!frame().is_macro)
            fail(at.place, "found #break outside of #while, #for, #switch and #macro");
        check_is_no_condition(at, 0);
        open.clear();
        frame().at = frame().end;
        return;
    }
    const size_t blocks = size_t(loop - open.rbegin()) + 1;
    check_is_no_condition(at, open.size() - blocks);
    for (size_t i = 0; i < blocks; ++i) {
        skip(false, false);
        frame().open.pop_back();
    }
}

void Reader::do_macro() {
    const Place at = last_;
    Macro macro;
    macro.name = raw_name("#macro");
    raw_expect('(', macro.name->text);
    while (!peek_raw().is(')')) {
        macro.parameters.push_back(raw_name("the parameters of " + macro.name->text));
        if (peek_raw().is(','))
            raw();
        else if (!peek_raw().is(')') && peek_raw().kind != TokenKind::Name) // commas may be missing
            fail(peek_raw().place, fmt::format("found {} in the parameters of {}, expected ')'",
                                               found(peek_raw()), macro.name->text));
    }
    raw();
    macro.file = frame().file;
    macro.first = frame().at;
    Condition block{Condition::Kind::If};
    block.place = at;
    frame().open.push_back(block); // so that skip() can name its place in an error
    skip(false, false);
    frame().open.pop_back();
    macro.last = frame().at - 1;
    assert(macro.first <= macro.last);
    declare(macro.name, /* local= */ false).value =
        &macros_.try_emplace({macro.file, macro.first}, macro).first->second;
}

void Reader::do_message(const Token& at) {
    const Value value = hooks_.value(*this);
    const std::string* text = std::get_if<std::string>(&value);
    std::string shown = text ? *text : kind_of(value);
    while (!shown.empty() && (shown.back() == '\n' || shown.back() == ' '))
        shown.pop_back();
    if (at.name->text == "error")
        fail(at.place, "the scene stops with #error: " + shown);
    if (at.name->text == "warning")
        warn("#warning " + shown, at.place, "the scene warns: " + shown);
    take_semicolon();
}

void Reader::do_version() {
    const Value value = hooks_.value(*this);
    if (const Number* number = std::get_if<Number>(&value))
        version = number->v[0];
    version_given = true;
    take_semicolon();
}

} // namespace ovc::pov
