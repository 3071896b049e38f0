// SPDX-License-Identifier: Apache-2.0
// Tokens cuts lines into words and keeps a stack of files.
// Based on: the lexer of pbrt-v1 (core/pbrtlex.l), which includes files below its grammar, and the
// tokenizer of pbrt-v4 (parser.cpp) for escapes in strings.
#include "importers/pbrt/interpret/tokens.h"

#include "core/text/suggestion.h"
#include "importers/file/text.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc::pbrt {

/// The max depth of includes. Scenes have a few; beyond that, a file includes itself under ever new
/// names. Files one after the other may be any number: some scenes have an include for every leaf.
static constexpr size_t kDeepest = 64;

std::string described(const Token& token) {
    switch (token.kind) {
    case TokenKind::Number:
        return fmt::format("the number {}", token.number);
    case TokenKind::Open:
        return "'['";
    case TokenKind::Close:
        return "']'";
    case TokenKind::Text:
        return fmt::format("the string {}", ovc::quoted(token.text));
    case TokenKind::Word:
        return ovc::quoted(token.text);
    default:
        return "the end of the file";
    }
}

static bool ends_word(char c) {
    return is_blank(c) || c == '\n' || c == '"' || c == '[' || c == ']' || c == '#';
}

/// Skips blanks and comments; returns false if nothing else is left. A line may contain line ends
/// if a file mixes CR and LF (Source::line()).
static bool skip_to_token(std::string_view& rest) {
    for (;;) {
        while (!rest.empty() && (is_blank(rest[0]) || rest[0] == '\n'))
            rest.remove_prefix(1);
        if (rest.empty() || rest[0] != '#')
            return !rest.empty();
        rest.remove_prefix(std::min(rest.find('\n'), rest.size()));
    }
}

Place Tokens::place() const {
    if (files_.empty())
        return token_.place;
    return {files_.back().name, files_.back().source.line_number()};
}

bool Tokens::next() {
    if (again_) {
        again_ = false;
        return true;
    }
    for (;;) {
        if (files_.empty()) {
            token_.kind = TokenKind::End;
            return true;
        }
        if (skip_to_token(files_.back().rest))
            break;
        const bool marked = files_.back().marks_its_end;
        const size_t depth = files_.size();
        if (!next_line())
            return false;
        if (files_.size() < depth && marked) {
            token_.kind = TokenKind::ImportEnd;
            return true;
        }
    }
    token_.place = place();
    std::string_view& rest = files_.back().rest;
    if (rest[0] == '[' || rest[0] == ']') {
        token_.kind = rest[0] == '[' ? TokenKind::Open : TokenKind::Close;
        rest.remove_prefix(1);
        return true;
    }
    return rest[0] == '"' ? read_text(rest) : read_word(rest);
}

/// Reads a line, or leaves a file that has no more lines.
bool Tokens::next_line() {
    assert(!files_.empty());
    File& file = files_.back();
    const auto line = file.source.line();
    if (!line) {
        token_.place = place();
        if (file.source.is_damaged())
            return diagnostics_.fail(file.source.error_at_line(""));
        files_.pop_back();
        return true;
    }
    file.rest = *line;
    return true;
}

bool Tokens::read_text(std::string_view& rest) {
    assert(rest.starts_with('"'));
    token_.kind = TokenKind::Text;
    token_.text.clear();
    for (size_t i = 1; i < rest.size(); ++i) {
        char c = rest[i];
        if (c == '"') {
            rest.remove_prefix(i + 1);
            return true;
        }
        if (c == '\\' && i + 1 < rest.size()) {
            constexpr std::string_view kLetters = "bfnrt\\\"'/", kMeanings = "\b\f\n\r\t\\\"'/";
            // Any other backslash separates the folders of a path, as on Windows.
            if (const size_t at = kLetters.find(rest[i + 1]); at != kLetters.npos) {
                c = kMeanings[at];
                ++i;
            }
        }
        token_.text += c;
    }
    return diagnostics_.fail(
        token_.place,
        fmt::format("found the string {} without a closing quote", ovc::quoted(rest)));
}

bool Tokens::read_word(std::string_view& rest) {
    size_t length = 0;
    while (length < rest.size() && !ends_word(rest[length]))
        ++length;
    assert(length > 0); // next() has handled characters that end a word
    const std::string_view word = rest.substr(0, length);
    rest.remove_prefix(length);
    const char c = word[0];
    if ((c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.') {
        const auto value = parse_double(word);
        if (!value)
            return diagnostics_.fail(token_.place,
                                     fmt::format("found {}, expected a number", ovc::quoted(word)));
        token_.kind = TokenKind::Number;
        token_.number = *value;
        return true;
    }
    token_.kind = TokenKind::Word;
    token_.text = word;
    return true;
}

bool Tokens::open(const std::filesystem::path& path) {
    Result<Source> source = Source::open(path, files_read_);
    if (!source)
        return diagnostics_.fail(source.error());
    std::error_code ignored;
    push(std::move(*source), path, std::filesystem::canonical(path, ignored), false);
    return true;
}

void Tokens::push(Source source, const std::filesystem::path& path, std::filesystem::path identity,
                  bool marks_its_end) {
    const auto [at, is_new] = known_names_.try_emplace(path.string(), nullptr);
    if (is_new)
        at->second = &names_.emplace_back(path.string());
    const bool is_first = read_.insert(identity.string()).second;
    files_.push_back({std::move(source),
                      path.parent_path(),
                      std::move(identity),
                      at->second,
                      {},
                      marks_its_end,
                      !is_first || (!files_.empty() && files_.back().again)});
}

bool Tokens::include_next(bool marks_its_end) {
    if (!next())
        return false;
    if (token_.kind != TokenKind::Text)
        return diagnostics_.fail(
            token_.place,
            fmt::format("found {}, expected the name of a file in quotes", described(token_)));
    const std::string name = token_.text;
    return include(name, token_.place, marks_its_end);
}

bool Tokens::include(const std::string& name, const Place& place, bool marks_its_end) {
    const auto missing = [&](const std::string& sentence) {
        diagnostics_.missing("file " + name, place, sentence);
        return !diagnostics_.failed();
    };
    const auto path = find(name);
    if (!path)
        return missing(no_file(name));
    std::error_code ignored;
    std::filesystem::path identity = std::filesystem::canonical(*path, ignored);
    for (const File& file : files_)
        if (file.identity == identity)
            return diagnostics_.fail(place, fmt::format("{} includes itself", ovc::quoted(name)));
    if (files_.size() >= kDeepest)
        return diagnostics_.fail(place,
                                 fmt::format("found more than {} files in each other", kDeepest));
    assert(!files_.empty()); // the name stands in the last one
    if (files_.back().again && ++again_count_ > max_again_)
        return diagnostics_.fail(
            place, fmt::format("found more than {} includes in files that are included again and "
                               "again; a larger --max-triangles allows more",
                               max_again_));
    Result<Source> source = Source::open(*path, files_read_);
    if (!source)
        return missing(source.error().message);
    push(std::move(*source), *path, std::move(identity), marks_its_end);
    return true;
}

std::string Tokens::no_file(const std::string& name) const {
    std::string plain = name;
    std::replace(plain.begin(), plain.end(), '\\', '/');
    return fmt::format("there is no file {}{}", ovc::quoted(name),
                       did_you_mean_file(root_ / plain));
}

std::optional<std::filesystem::path> Tokens::find(const std::string& name) const {
    std::string plain = name;
    std::replace(plain.begin(), plain.end(), '\\', '/');
    const std::string other =
        plain.ends_with(".gz") ? plain.substr(0, plain.size() - 3) : plain + ".gz";
    std::error_code ignored;
    for (const std::string& spelling : {plain, other})
        for (const std::filesystem::path& folder :
             {root_, files_.empty() ? root_ : files_.back().folder}) {
            const std::filesystem::path path = folder / spelling;
            note(files_read_, path);
            if (std::filesystem::is_regular_file(path, ignored))
                return path;
        }
    return std::nullopt;
}

} // namespace ovc::pbrt
