// SPDX-License-Identifier: Apache-2.0
// The stream of tokens, with frames of files and macros and scopes of variables. directives.cpp and
// directives_file.cpp obey directives.
#include "importers/pov/words/reader.h"

#include "importers/file/available_memory.h"
#include "importers/pov/shapes/font.h"
#include "importers/pov/trace.h"
#include "importers/pov/words/keywords.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc::pov {

Deeper::Deeper(Reader& reader) : reader_(reader) {
    if (++reader_.depth_ > reader_.limits.depth) {
        --reader_.depth_;
        reader_.fail(reader_.place(), fmt::format("found blocks more than {} deep in each other",
                                                  reader_.limits.depth));
    }
}

Deeper::~Deeper() {
    assert(reader_.depth_ > 0);
    --reader_.depth_;
}

InVector::InVector(Reader& reader) : reader_(reader) {
    ++reader_.brackets_;
}

InVector::~InVector() {
    --reader_.brackets_;
}

Reader::Reader(Hooks hooks, LogSink log, std::string main_folder, FilesRead* files_read)
    : limits{},
      hooks_(std::move(hooks)),
      log_(std::move(log)),
      folder_(std::move(main_folder)),
      files_read_(files_read),
      available_(available_memory()) {
    push_scope(); // the scene's own scope, for #declare
}

Reader::~Reader() = default;

void Reader::open(std::unique_ptr<SourceFile> file) {
    assert(file && frames_.empty());
    files_.push_back(std::move(file));
    SourceFile* opened = files_.back().get();
    tokenize(*opened, names_);
    const uint32_t scope = push_scope();
    frames_.push_back({opened, 0, opened->tokens.size() - 1, false, scope, {}, last_});
}

Token Reader::next() {
    if (back_.empty())
        return step(Hold::Nothing);
    const Token token = back_.back();
    back_.pop_back();
    return token;
}

const Token& Reader::peek() {
    if (back_.empty())
        back_.push_back(step(Hold::Nothing));
    return back_.back();
}

Token Reader::peek_held(Hold hold) {
    if (!back_.empty())
        return back_.back();
    const Token token = step(hold);
    if (token.kind != TokenKind::Directive)
        back_.push_back(token);
    return token;
}

void Reader::put_back(const Token& token) {
    back_.push_back(token);
}

bool Reader::ends_value() const {
    if (!obeys_ || brackets_ > obeys_->brackets || frames_.size() > obeys_->frames)
        return false;
    return frames_.size() < obeys_->frames || frames_.back().open.size() <= obeys_->blocks;
}

Token Reader::step(Hold hold) {
    const auto is_held = [&](Hold from) {
        if (hold < from || !ends_value())
            return false;
        assert(frame().at > 0);
        --frame().at;
        return true;
    };
    for (;;) {
        Token token = raw();
        last_ = token.place;
        if (token.kind == TokenKind::Directive) {
            if (is_held(Hold::Directives))
                return token;
            obey(token);
            if (!back_.empty()) // the token that ended the directive's expression
                return next();
            continue;
        }
        if (token.kind == TokenKind::Name && !token.name->is_keyword)
            if (const Slot* slot = find(token.name))
                if (const auto* macro = std::get_if<const Macro*>(&slot->value)) {
                    if (is_held(Hold::DirectivesAndMacros)) {
                        token.kind = TokenKind::Directive;
                        return token;
                    }
                    call(token, **macro);
                    continue;
                }
        return token;
    }
}

void Reader::spend(uint64_t words) {
    run_over_ += words;
    if (run_over_ > limits.tokens)
        fail(last_,
             fmt::format("stopped after {} words: a loop or a macro does not end", limits.tokens));
}

void Reader::grow(uint64_t bytes) {
    constexpr uint64_t kBetweenChecks = uint64_t(64) << 20; // bytes; asking the system is slow
    grown_ += bytes;
    unchecked_ += bytes;
    if (unchecked_ < kBetweenChecks)
        return;
    if (available_memory() < available_ / 2 + bytes)
        fail(last_, fmt::format("stopped after half of the {} MB of memory were taken: a loop or a "
                                "macro does not end, or the scene is too large",
                                available_ >> 20));
    unchecked_ = 0;
}

void Reader::count_depth(Array& array, const Value& item) const {
    const auto* inner = std::get_if<Array>(&item);
    if (!inner)
        return;
    array.depth = std::max(array.depth, inner->depth + 1);
    if (array.depth > limits.array_depth)
        fail(last_,
             fmt::format("found arrays more than {} deep in each other", limits.array_depth));
}

Token Reader::raw() {
    spend(1);
    while (!frames_.empty() && frame().at >= frame().end) {
        if (!frame().open.empty())
            fail(frame().open.back().place, "found no #end to this");
        if (frames_.size() == 1)
            return frame().file->tokens.back();
        pop_frame();
    }
    assert(!frames_.empty());
    const Token& token = frame().file->tokens[frame().at++];
    if (token.is('(') || token.is('[') || token.is('{'))
        ++brackets_;
    else if (token.is(')') || token.is(']') || token.is('}'))
        --brackets_;
    return token;
}

const Token& Reader::peek_raw() const {
    const Frame& now = frames_.back();
    return now.at < now.end ? now.file->tokens[now.at] : now.file->tokens.back();
}

void Reader::pop_frame() {
    assert(frames_.size() > 1 && frames_.back().scope + 1 == scopes_.size());
    frames_.pop_back();
    pop_scope();
}

uint32_t Reader::push_scope() {
    scopes_.push_back({++last_scope_, {}, {}});
    return uint32_t(scopes_.size() - 1);
}

Slot& Reader::add_slot(uint32_t scope) {
    assert(scope < scopes_.size());
    scopes_[scope].slots.push_back(std::make_unique<Slot>());
    Slot& slot = *scopes_[scope].slots.back();
    slot.scope = scopes_[scope].serial;
    return slot;
}

void Reader::pop_scope() {
    for (Name* name : scopes_.back().names)
        if (!name->bound.empty() && name->bound.back().scope + 1 == scopes_.size())
            name->bound.pop_back();
    ended_.push_back(std::move(scopes_.back()));
    scopes_.pop_back();
    if (ended_.size() > kEndedScopes)
        ended_.pop_front();
}

Slot* Reader::find(const Name* name) const {
    return name->bound.empty() ? nullptr : name->bound.back().slot;
}

Value* Reader::value_of(const ValueHandle& handle) const {
    const auto scope = std::ranges::lower_bound(scopes_, handle.scope, {}, &Scope::serial);
    if ((scope == scopes_.end() || scope->serial != handle.scope) &&
        std::ranges::find(ended_, handle.scope, &Scope::serial) == ended_.end())
        return nullptr;
    if (!handle.item)
        return &handle.slot->value;
    auto* array = std::get_if<Array>(&handle.slot->value);
    return array && *handle.item < array->items.size() ? &array->items[*handle.item] : nullptr;
}

void Reader::bind(Name* name, uint32_t scope, Slot* slot) {
    assert(scope < scopes_.size() && slot);
    auto at = name->bound.end();
    while (at != name->bound.begin() && (at - 1)->scope > scope)
        --at;
    if (at != name->bound.begin() && (at - 1)->scope == scope)
        (at - 1)->slot = slot;
    else {
        name->bound.insert(at, {scope, slot});
        scopes_[scope].names.push_back(name);
    }
}

uint32_t Reader::scope_of(const Name* name, bool local) const {
    if (local)
        return uint32_t(scopes_.size() - 1);
    return name->bound.empty() ? 0 : name->bound.back().scope;
}

Slot& Reader::declare(Name* name, bool local) {
    return declare_in(scope_of(name, local), name);
}

Slot& Reader::declare_in(uint32_t scope, Name* name) {
    assert(scope < scopes_.size());
    changed();
    for (const Name::Bound& bound : name->bound)
        if (bound.scope == scope)
            return *bound.slot;
    Slot& slot = add_slot(scope);
    bind(name, scope, &slot);
    return slot;
}

void Reader::undefine(Name* name) {
    changed();
    if (!name->bound.empty())
        name->bound.pop_back();
}

void Reader::expect(char c, std::string_view after) {
    const Token token = next();
    if (!token.is(c))
        fail(token.place, fmt::format("found {} after {}, expected '{}'", found(token), after, c));
}

bool Reader::take(char c) {
    if (!peek().is(c))
        return false;
    back_.pop_back();
    return true;
}

bool Reader::take(std::string_view word) {
    if (!peek().is(word))
        return false;
    back_.pop_back();
    return true;
}

void Reader::fail(const Place& at, const std::string& sentence) const {
    throw ParseError(at, sentence, caller());
}

Caller Reader::caller() const {
    return frames_.size() > 1 ? Caller{frames_[1].called, frames_[1].is_macro} : Caller{};
}

void Reader::fail_here(const std::string& expected) {
    const Token token = next();
    const bool is_unknown =
        token.kind == TokenKind::Name && !token.name->is_keyword && !find(token.name);
    fail(token.place, fmt::format("found {}, expected {}{}", found(token), expected,
                                  is_unknown ? did_you_mean_keyword(token.name->text) : ""));
}

const Note* Reader::note(const std::string& kind, const Place& at, const std::string& sentence) {
    return &*notes_.insert({kind, at, sentence}).first;
}

void Reader::warn(const std::string& kind, const Place& at, const std::string& sentence) {
    if (!warned_.insert(kind).second)
        return;
    const std::string shown = excerpt(at);
    say(log_, LogLevel::Warning,
        fmt::format("{}:{}:{}: {}{}{}", at.file ? at.file->name : "", at.line, at.column, sentence,
                    shown.empty() ? "" : "\n", shown));
}

void Reader::omit(const std::string& kind, const Place& at, const std::string& sentence) {
    if (strict)
        fail(at, sentence + ", which --strict makes an error");
    warn(kind, at, sentence);
    Omission& omission = omissions_[kind];
    omission.sentence = sentence;
    ++omission.count;
}

std::vector<Omission> Reader::omissions() const {
    std::vector<Omission> all;
    for (const auto& [kind, omission] : omissions_)
        all.push_back(omission);
    return all;
}

void Reader::call(const Token& at, const Macro& macro) {
    const Deeper deeper(*this);
    if (frames_.size() >= limits.nesting)
        fail(at.place, fmt::format("found macros and includes more than {} deep in each other: "
                                   "{} does not end",
                                   limits.nesting, macro.name->text));
    const size_t scopes = scopes_.size();
    std::vector<std::pair<Slot*, Value>> arguments;
    expect('(', macro.name->text);
    for (size_t i = 0; i < macro.parameters.size(); ++i) {
        if (i > 0)
            take_comma();
        if (peek().is(')'))
            fail(at.place, fmt::format("found {} arguments to {}, expected {}", i, macro.name->text,
                                       macro.parameters.size()));
        arguments.push_back(argument(scopes));
    }
    expect(')', "the arguments of " + macro.name->text);
    const uint32_t scope = push_scope();
    for (size_t i = 0; i < arguments.size(); ++i) {
        Slot* slot = arguments[i].first;
        if (!slot) {
            slot = &add_slot(scope);
            slot->value = std::move(arguments[i].second);
        }
        bind(macro.parameters[i], scope, slot);
    }
    frames_.push_back({macro.file, macro.first, macro.last, true, scope, {}, at.place});
}

std::pair<Slot*, Value> Reader::argument(size_t scopes) {
    const Token first = next();
    // A macro within the argument loses its variables when it ends, so they are passed by value.
    const bool is_passing =
        !first.name || (!first.name->bound.empty() && first.name->bound.back().scope >= scopes);
    if (first.kind == TokenKind::Name && !first.name->is_keyword && !is_passing) {
        const Token after = next();
        put_back(after);
        if (after.is(',') || after.is(')')) {
            if (Slot* slot = find(first.name))
                return {slot, {}};
            // The macro may stand behind a #declare that has no semicolon, whose variable it takes.
            const bool is_coming = declaring_.name == first.name;
            return {&declare_in(is_coming ? declaring_.scope : uint32_t(scopes_.size() - 1),
                                first.name),
                    {}};
        }
    }
    put_back(first);
    return {nullptr, hooks_.value(*this)};
}

} // namespace ovc::pov
