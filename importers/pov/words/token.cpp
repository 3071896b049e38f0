// SPDX-License-Identifier: Apache-2.0
// Cuts text into tokens.
#include "importers/pov/words/token.h"

#include "importers/file/text.h"
#include "importers/pov/words/keywords.h"

#include <fmt/format.h>

#include <cassert>

namespace ovc::pov {

namespace {

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

class Tokenizer {
public:
    Tokenizer(SourceFile& file, Names& names) : file_(file), text_(file.text), names_(names) {
        if (text_.starts_with("\xef\xbb\xbf"))
            line_start_ = at_ = 3;
    }

    void run() {
        for (;;) {
            skip_space();
            Token token;
            token.place = place();
            if (at_ == text_.size()) {
                file_.tokens.push_back(token);
                return;
            }
            if (read(token))
                file_.tokens.push_back(token);
        }
    }

private:
    Place place() const { return {&file_, line_, uint32_t(at_ - line_start_ + 1)}; }
    char peek(size_t ahead = 0) const {
        return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
    }

    void advance() {
        assert(at_ < text_.size());
        // A line ends with LF, CR LF or CR.
        if (text_[at_] == '\n' || (text_[at_] == '\r' && peek(1) != '\n')) {
            ++line_;
            line_start_ = at_ + 1;
        }
        ++at_;
    }

    void skip_space() {
        for (;;) {
            if (peek() == '/' && peek(1) == '/')
                while (at_ < text_.size() && peek() != '\n' && peek() != '\r')
                    ++at_;
            else if (peek() == '/' && peek(1) == '*')
                skip_comment();
            else if (at_ < text_.size() && (uint8_t(peek()) <= ' ' || uint8_t(peek()) == 0xa0))
                advance();
            else
                return;
        }
    }

    /// Skips a comment, in which others may be nested.
    void skip_comment() {
        const Place start = place();
        int depth = 0;
        do {
            const bool opens = peek() == '/' && peek(1) == '*';
            const bool closes = peek() == '*' && peek(1) == '/';
            depth += opens ? 1 : closes ? -1 : 0;
            if (opens || closes)
                ++at_;
            if (at_ >= text_.size())
                throw ParseError(start, "found a comment without an end, expected */");
            advance();
        } while (depth > 0);
    }

    /// Reads a token. Returns false where there is only a # that means nothing.
    bool read(Token& token) {
        const char c = peek();
        if (is_letter(c)) {
            token.name = read_name();
            // Old scenes write these without a #.
            const std::string& text = token.name->text;
            const bool is_directive = text == "declare" || text == "default" || text == "include";
            token.kind = is_directive ? TokenKind::Directive : TokenKind::Name;
        } else if (is_digit(c) || (c == '.' && is_digit(peek(1)))) {
            token.kind = TokenKind::Number;
            token.number = read_number();
        } else if (c == '"') {
            token.kind = TokenKind::Text;
            token.text = read_text();
        } else if (c == '#') {
            return read_directive(token);
        } else {
            token.kind = TokenKind::Sign;
            token.sign = read_sign();
        }
        return true;
    }

    Name* read_name() {
        const size_t first = at_;
        while (is_letter(peek()) || is_digit(peek()))
            ++at_;
        return names_.intern(text_.substr(first, at_ - first));
    }

    double read_number() {
        const size_t first = at_;
        while (is_digit(peek()))
            ++at_;
        // The dot of 3.x, like that of V.x, takes a component and starts no fraction.
        if (peek() == '.' && !is_letter(peek(1))) {
            ++at_;
            while (is_digit(peek()))
                ++at_;
        }
        const bool sign = peek(1) == '+' || peek(1) == '-';
        if ((peek() == 'e' || peek() == 'E') && is_digit(peek(sign ? 2 : 1))) {
            at_ += sign ? 2 : 1;
            while (is_digit(peek()))
                ++at_;
        }
        return parse_double(text_.substr(first, at_ - first)).value_or(0);
    }

    std::string_view read_text() {
        const Place start = place();
        const size_t first = ++at_;
        while (at_ < text_.size() && peek() != '"') {
            if (peek() == '\\' && peek(1) != '\0')
                ++at_;
            advance();
        }
        if (at_ >= text_.size())
            throw ParseError(start, "found a text without an end, expected \"");
        return text_.substr(first, at_++ - first);
    }

    /// Reads a directive. Returns false for a # without a word behind it, which POV-Ray ignores.
    bool read_directive(Token& token) {
        ++at_;
        while (peek() == ' ' || peek() == '\t')
            ++at_;
        if (!is_letter(peek()))
            return false;
        token.kind = TokenKind::Directive;
        token.name = read_name();
        return true;
    }

    char read_sign() {
        const char c = text_[at_++];
        if (peek() == '=' && (c == '<' || c == '>' || c == '!')) {
            ++at_;
            return c == '<' ? 'l' : c == '>' ? 'g' : 'n';
        }
        return c;
    }

    SourceFile& file_;
    std::string_view text_;
    Names& names_;
    size_t at_ = 0;
    size_t line_start_ = 0;
    uint32_t line_ = 1;
};

} // namespace

Name* Names::intern(std::string_view text) {
    const auto at = names_.find(text);
    if (at != names_.end())
        return at->second.get();
    auto name = std::make_unique<Name>();
    name->text = text;
    name->is_keyword = is_keyword(text);
    Name* made = name.get();
    names_.emplace(std::string_view(made->text), std::move(name));
    return made;
}

void tokenize(SourceFile& file, Names& names) {
    assert(file.tokens.empty());
    Tokenizer(file, names).run();
    assert(!file.tokens.empty() && file.tokens.back().kind == TokenKind::End);
}

std::string found(const Token& token) {
    switch (token.kind) {
    case TokenKind::End:
        return "the end of the file";
    case TokenKind::Name:
        return ovc::quoted(token.name->text);
    case TokenKind::Directive:
        return ovc::quoted("#" + token.name->text);
    case TokenKind::Number:
        return fmt::format("the number {}", token.number);
    case TokenKind::Text:
        return fmt::format("the text {}", ovc::quoted(token.text));
    case TokenKind::Sign:
        break;
    }
    switch (token.sign) {
    case 'l':
        return "'<='";
    case 'g':
        return "'>='";
    case 'n':
        return "'!='";
    default:
        return ovc::quoted(std::string_view(&token.sign, 1));
    }
}

std::string excerpt(const Place& place) {
    if (!place.file || place.line == 0)
        return "";
    std::string_view text = place.file->text;
    for (uint32_t line = 1; line < place.line; ++line) {
        const size_t end = text.find_first_of("\r\n");
        if (end == text.npos)
            return "";
        const bool both = text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n';
        text.remove_prefix(end + (both ? 2 : 1));
    }
    text = text.substr(0, text.find_first_of("\r\n"));
    // Only the part of a long line around the place is shown.
    constexpr size_t kBefore = 60, kShown = 100;
    const size_t skipped = place.column > kBefore ? place.column - kBefore : 0;
    if (skipped > text.size())
        return "";
    assert(place.column > skipped);
    text = text.substr(skipped, kShown);
    std::string shown, caret;
    for (size_t i = 0; i < text.size(); ++i)
        shown += text[i] >= ' ' && text[i] <= '~' ? text[i] : ' ';
    return fmt::format("    {}\n    {:>{}}", shown, '^', place.column - skipped);
}

} // namespace ovc::pov
