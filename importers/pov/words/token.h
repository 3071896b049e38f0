// SPDX-License-Identifier: Apache-2.0
// Tokens of POV-Ray's scene language: a file is cut into them once, however often a loop or a macro
// runs over them.
#pragma once

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

/// Where a token stands; line and column from 1.
struct Place {
    const SourceFile* file = nullptr;
    uint32_t line = 0;
    uint32_t column = 0;
};

/// Where the scene's own file calls the macro, or includes the file, in which a place stands; no
/// file: the place stands in the scene's own file.
struct Caller {
    Place place;
    bool is_macro = false;
};

/// What is wrong with the scene, thrown inside this folder and caught in pov.cpp: the sentence
/// alone, and where.
struct ParseError : std::runtime_error {
    ParseError(const Place& at, const std::string& sentence, const Caller& from = {})
        : std::runtime_error(sentence), place(at), caller(from) {}
    Place place;
    Caller caller;
};

/// An identifier or a keyword; one for each spelling.
struct Name {
    /// A variable of this name: in which scope, the innermost last.
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
    char sign = 0; // of Sign: the character; 'l' <=, 'g' >=, 'n' !=
    Place place;
    Name* name = nullptr;  // of Name and Directive
    double number = 0;     // of Number
    std::string_view text; // of Text: between the quotes, as it stands in the file

    bool is(char c) const { return kind == TokenKind::Sign && sign == c; }
    bool is(std::string_view word) const { return kind == TokenKind::Name && name->text == word; }
};

struct SourceFile {
    std::string name; // as messages show it
    std::string folder;
    std::string text;
    std::vector<Token> tokens; // the last is an End
};

/// Cuts file.text into file.tokens. Throws ParseError for a text or comment without an end.
void tokenize(SourceFile& file, Names& names);

/// The token as a message shows it.
std::string found(const Token& token);

/// The line of the place and, below it, a caret; two lines without an end, or nothing.
std::string excerpt(const Place& place);

} // namespace ovc::pov
