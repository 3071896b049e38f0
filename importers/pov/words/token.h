// SPDX-License-Identifier: Apache-2.0
// Tokens of POV-Ray's scene language. A file is cut into tokens once, however often a loop or a
// macro reads them.
#pragma once

#include <compare>
#include <cstdint>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace ovc::pov {

struct Slot;
struct SourceFile;

/// A token's place; line and column count from 1.
struct Place {
    const SourceFile* file = nullptr;
    uint32_t line = 0;
    uint32_t column = 0;

    auto operator<=>(const Place&) const = default;
};

/// The place in the scene's own file that calls the macro, or includes the file, which contains
/// another place. It has no file where that other place is in the scene's own file.
struct Caller {
    Place place;
    bool is_macro = false;
};

/// An error in the scene, thrown inside this folder and caught in pov.cpp. what() is the sentence
/// without the place.
struct ParseError : std::runtime_error {
    ParseError(const Place& at, const std::string& sentence, const Caller& from = {})
        : std::runtime_error(sentence), place(at), caller(from) {}
    Place place;
    Caller caller;
};

/// An identifier or a keyword. There is one Name for each spelling.
struct Name {
    /// A variable of this name in one scope. The innermost scope comes last in `bound`.
    struct Bound {
        uint32_t scope;
        Slot* slot;
    };

    std::string text;
    bool is_keyword = false;
    std::vector<Bound> bound;
};

class Names {
public:
    Name* intern(std::string_view text);

private:
    std::unordered_map<std::string_view, std::unique_ptr<Name>> names_;
};

enum class TokenKind : uint8_t { End, Name, Number, Text, Sign, Directive };

struct Token {
    TokenKind kind = TokenKind::End;
    char sign = 0; // of a Sign: the character, or 'l' for <=, 'g' for >=, 'n' for !=
    Place place;
    Name* name = nullptr;  // of a Name or Directive
    double number = 0;     // of a Number
    std::string_view text; // of a Text: between the quotes, with its escape sequences

    bool is(char c) const { return kind == TokenKind::Sign && sign == c; }
    bool is(std::string_view word) const { return kind == TokenKind::Name && name->text == word; }
};

struct SourceFile {
    std::string name; // as messages show it
    std::string folder;
    std::string text;
    std::vector<Token> tokens; // the last is an End
};

/// Cuts file.text into file.tokens, which point into it. Throws ParseError for a text or comment
/// without an end.
void tokenize(SourceFile& file, Names& names);

/// Returns the token as a message shows it.
std::string found(const Token& token);

/// Returns the place's line and, below it, a caret, without a line end behind the caret. Returns an
/// empty text for a place without a file.
std::string excerpt(const Place& place);

} // namespace ovc::pov
