// SPDX-License-Identifier: Apache-2.0
// Tokens: the words of a PBRT file and of the files it includes, one after the other.
#pragma once

#include "importers/file/source.h"
#include "importers/pbrt/interpret/diagnostics.h"

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
    ImportEnd, // where a file that include() was told to mark ends
    End        // of the outermost file
};

struct Token {
    TokenKind kind = TokenKind::End;
    std::string text; // of Word and Text
    double number = 0;
    Place place;
};

/// "'Shape'", "the number 3", "the end of the file": for messages.
std::string described(const Token& token);

/// Reads front to back in bounded memory. A file is included wherever it is asked for, in the
/// middle of a parameter list too; then its tokens come first.
class Tokens {
public:
    /// Nothing is read yet. root: the folder that names are relative to. files_read: receives what
    /// is looked for and read; or null. max_again: how many includes of files that are read again
    /// are followed; those of files that are read once only are followed in any number.
    Tokens(std::filesystem::path root, Diagnostics& diagnostics, FilesRead* files_read,
           uint64_t max_again)
        : root_(std::move(root)),
          diagnostics_(diagnostics),
          files_read_(files_read),
          max_again_(max_again) {}

    FilesRead* files_read() const { return files_read_; }

    /// The next token, to be changed by the next call. False: an error, in the diagnostics.
    bool next();
    const Token& token() const { return token_; }
    /// next() gives the same token again.
    void again() { again_ = true; }

    /// Begins with this file. False: an error.
    bool open(const std::filesystem::path& path);
    /// The next token is the name of a file: goes on with that, if it can be read; else warns, and
    /// depth() stays. False: an error.
    bool include_next(bool marks_its_end);
    /// How many files are open in each other.
    size_t depth() const { return files_.size(); }

    /// The file of that name: beside the outermost file, else beside the one being read, with .gz
    /// behind it or without. Nothing where there is none.
    std::optional<std::filesystem::path> find(const std::string& name) const;

    /// What to say where there is none.
    std::string no_file(const std::string& name) const;

    /// Where the next token is looked for.
    Place place() const;

private:
    struct File {
        Source source;
        std::filesystem::path folder;
        std::filesystem::path identity; // the same for all names of one file
        const std::string* name;
        std::string_view rest; // of the line
        bool marks_its_end;
        bool again; // it was read before, or a file that it is included in was
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
