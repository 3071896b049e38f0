// SPDX-License-Identifier: Apache-2.0
// Tokens returns the words of a PBRT file and of the files it includes, one after the other.
#pragma once

#include "importers/file/source.h"
#include "importers/pbrt/interpret/diagnostics.h"

#include <cassert>
#include <deque>
#include <filesystem>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace ovc::pbrt {

enum class TokenKind {
    Word,      // WorldBegin, true
    Text,      // "a string", without its quotes
    Number,    // 1, -.5, 1e3
    Open,      // [
    Close,     // ]
    ImportEnd, // the end of a file that include_next() was told to mark
    End        // the end of the outermost file
};

struct Token {
    TokenKind kind = TokenKind::End;
    std::string text; // for Word and Text
    double number = 0;
    Place place;
};

/// Describes a token for messages: "'Shape'", "the number 3", "the end of the file".
std::string described(const Token& token);

/// Reads front to back in bounded memory. The tokens of an included file come in the place of its
/// Include, which may stand in the middle of a parameter list.
class Tokens {
public:
    /// Reads nothing yet. Names are relative to the folder `root`. `files_read` receives the files
    /// that are looked for or read; it may be null. At most `max_again` includes are followed in
    /// files that are read again; files that are read only once may have any number of includes.
    Tokens(std::filesystem::path root, Diagnostics& diagnostics, FilesRead* files_read,
           uint64_t max_again)
        : root_(std::move(root)),
          diagnostics_(diagnostics),
          files_read_(files_read),
          max_again_(max_again) {}

    FilesRead* files_read() const { return files_read_; }

    /// Reads the next token, which the next call changes. Returns false after an error, which the
    /// diagnostics hold.
    bool next();
    const Token& token() const { return token_; }
    /// Makes next() return the same token again, once.
    void again() {
        assert(!again_);
        again_ = true;
    }

    /// Begins with this file. Returns false after an error.
    bool open(const std::filesystem::path& path);
    /// Takes the next token for the name of a file and goes on with that. If it cannot be read,
    /// warns and leaves depth() as it is. Returns false after an error.
    bool include_next(bool marks_its_end);
    /// Returns how many files are open inside each other.
    size_t depth() const { return files_.size(); }

    /// Returns the file of that name, with .gz behind it or without: beside the outermost file,
    /// else beside the one being read. Returns nothing if there is none.
    std::optional<std::filesystem::path> find(const std::string& name) const;

    /// Returns the sentence for a name that find() does not find.
    std::string no_file(const std::string& name) const;

    /// Returns the place at which the next token is looked for.
    Place place() const;

private:
    struct File {
        Source source;
        std::filesystem::path folder;
        std::filesystem::path identity; // the same for all names of one file
        const std::string* name;
        std::string_view rest; // the rest of the line
        bool marks_its_end;
        bool again; // whether this file, or one that includes it, was read before
    };

    bool include(const std::string& name, const Place& place, bool marks_its_end);
    void push(Source source, const std::filesystem::path& path, std::filesystem::path identity,
              bool marks_its_end);
    bool next_line();
    bool read_text(std::string_view& rest);
    bool read_word(std::string_view& rest);

    std::filesystem::path root_;
    Diagnostics& diagnostics_;
    FilesRead* const files_read_;
    const uint64_t max_again_;
    uint64_t again_count_ = 0;
    std::unordered_set<std::string> read_; // identities
    std::vector<File> files_;              // the innermost last
    std::deque<std::string> names_;
    std::unordered_map<std::string, const std::string*> known_names_;
    Token token_;
    bool again_ = false;
};

} // namespace ovc::pbrt
