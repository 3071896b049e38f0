// SPDX-License-Identifier: Apache-2.0
// Reader: the tokens of a scene in the order in which they count: directives obeyed, includes and
// macros put in.
#pragma once

#include "core/scene.h"
#include "core/system/log.h"
#include "importers/file/files_read.h"
#include "importers/pov/values/value.h"

#include <filesystem>
#include <functional>
#include <set>

namespace ovc::pov {

/// Bounds on what a scene may make a reader do, each far beyond what scenes do.
struct Limits {
    uint64_t tokens = 0;   // run over in all
    size_t nesting = 1000; // includes and macros inside each other
    /// A loop is taken for one that does not end beyond both of these without making anything, and
    /// a #while beyond `rounds` without reading from a file.
    uint64_t idle_rounds = 100'000, idle_tokens = 15'000'000;
    uint64_t rounds = 1'000'000;
    uint64_t objects = 20'000'000;
    uint64_t triangles = 0; // of an object that the scene asks about
    uint64_t array_items = 2'000'000;
    uint32_t chain = 2000;      // groups in groups, arrays in arrays
    uint32_t operations = 4000; // of a function and what it calls
    size_t depth = 400; // blocks and parentheses inside each other: the C++ stack holds as many
};

class Reader;
class Font;
class TraceTarget;

/// Counts how deep the parser stands in itself; throws ParseError beyond Limits::depth.
class Deeper {
public:
    explicit Deeper(Reader& reader);
    ~Deeper();
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;

private:
    Reader& reader_;
};

/// A vector is being read: as in parentheses, directives are obeyed wherever they stand. Of '<' the
/// reader cannot tell by itself that it is a bracket.
class InVector {
public:
    explicit InVector(Reader& reader);
    ~InVector();
    InVector(const InVector&) = delete;
    InVector& operator=(const InVector&) = delete;

private:
    Reader& reader_;
};

class Reader {
public:
    /// What directives need of those who parse: expressions.cpp, scene.cpp.
    struct Hooks {
        std::function<Value(Reader&)> value;
        std::function<double(Reader&)> number;       // a float expression
        std::function<double(Reader&)> condition;    // one that may compare, between parentheses
        std::function<Value*(Reader&, Array&)> item; // of an array, from the first [ on
        std::function<void(Reader&)> defaults;       // of #default
    };

    /// files_read: receives what is looked for and read; or null.
    Reader(Hooks hooks, LogSink log, std::string main_folder, FilesRead* files_read);

    /// The scene itself.
    void open(std::unique_ptr<SourceFile> file);

    /// The next token that is no directive; macros are put in. End: the scene is over.
    Token next();
    const Token& peek();
    void put_back(const Token& token);
    /// The next token where it may be an operator. A directive ends the value of another one, such
    /// as #declare, and is not obeyed yet; in brackets, in a macro that gives the value and outside
    /// of directives it is. Taken by next(), unless it is such a directive.
    Token peek_operator();

    /// The sign `c`, or ParseError.
    void expect(char c, std::string_view after);
    /// True, and taken, where the next token is that.
    bool take(char c);
    bool take(std::string_view word);
    void take_comma() { take(','); }

    [[noreturn]] void fail(const Place& at, const std::string& sentence) const;
    [[noreturn]] void fail_here(const std::string& expected);
    /// Work other than running over words, counted in words: what takes about as long.
    void spend(uint64_t words);
    /// Something is not as it was: a variable, a random number. A round of a #while without any
    /// such thing is followed by the same one, for ever.
    void changed() { ++changes_; }
    /// Before so many bytes are taken for what the scene makes. Fails once reading has taken more
    /// than half of the memory there was: the rest is for the triangles.
    void grow(uint64_t bytes);
    /// Before `item` becomes one of the array's. ParseError: arrays in arrays, too deep.
    void count_depth(Array& array, const Value& item) const;
    /// Once for each `kind`.
    void warn(const std::string& kind, const Place& at, const std::string& sentence);

    /// The variable, or null.
    Slot* find(const Name* name) const;
    /// A variable in the scope of the running macro or include (local) or of the scene; what was
    /// there is replaced.
    Slot& declare(Name* name, bool local);
    void undefine(Name* name);

    /// As files.h has it: beside the scene, beside the including files, among POV-Ray's.
    std::filesystem::path find_file(const std::string& name, std::string_view extension) const;
    Names& names() { return names_; }
    const Place& place() const { return last_; } // of the token read last
    Caller caller() const;                       // of what is running
    double version = 3.7;
    bool version_given = false; // by some #version; else povray takes the scene for an older one
    /// Colors are light, not what screens are told.
    bool has_linear_colors() const { return version_given && version >= 3.7; }
    double gamma = 1; // assumed_gamma: what srgb colors are converted to
    ImageSize picture{640, 480};
    Texture defaults; // of #default
    /// Objects that the scene asked about.
    std::map<std::shared_ptr<const Object>, std::shared_ptr<const TraceTarget>> targets;
    std::map<std::string, std::shared_ptr<Font>> fonts; // by name
    std::vector<uint32_t> random_streams;
    Limits limits;
    uint64_t objects = 0;

private:
    friend class Deeper;
    friend class InVector;
    struct Progress {
        uint64_t grown = 0, tokens = 0, rounds = 0;
    };
    struct Condition {
        enum class Kind { If, While, For, Switch };
        Kind kind;
        size_t start = 0;        // While: of the condition; For: of the body
        Slot* counter = nullptr; // For
        double last = 0, step = 0;
        double value = 0; // Switch
        bool matched = false;
        Place place;
        Progress progress{};  // While, For: when it made something last
        uint64_t changes = 0; // While: when the round began
        uint64_t rounds = 0, reads = 0, rounds_at_read = 0;
    };
    /// Where a directive began: how deep in frames, blocks and brackets.
    struct Depth {
        size_t frames, blocks;
        int64_t brackets;
    };
    struct Frame {
        const SourceFile* file;
        size_t at, end;
        bool is_macro;
        uint32_t scope;
        std::vector<Condition> open;
        Place called;
    };
    struct Scope {
        std::vector<Name*> names;
        std::vector<std::unique_ptr<Slot>> slots;
    };

    Token raw();
    const Token& peek_raw() const;
    Token step(bool hold_directives);
    /// Whether a directive that comes now ends the value of the one that is being obeyed.
    bool ends_value() const;
    Name* raw_name(std::string_view after);
    void raw_expect(char c, std::string_view after);
    void take_semicolon();
    void pop_frame();
    void obey(const Token& directive);
    void do_declare(bool local);
    void do_undef();
    void do_include();
    void do_if(bool condition, const Place& at);
    void do_else(const Token& at);
    void do_end(const Token& at);
    void do_while(const Token& at);
    void test_while(Condition& loop);
    /// A further round of a loop begins. ParseError: nothing suggests that it will ever end.
    void count_round(Condition& loop) const;
    void do_for(const Token& at);
    bool test_for(Condition& loop) const;
    void do_switch(const Token& at);
    void next_case();
    bool case_matches(std::string_view directive, double value);
    bool is_defined();
    void do_break(const Token& at);
    void do_macro();
    void do_message(const Token& at);
    void do_version();
    void do_fopen();
    void do_fclose();
    void do_read();
    void do_write();
    /// The open file that is named next.
    std::shared_ptr<DataFile> raw_file(std::string_view after, bool writes);
    bool condition();
    /// Passes over tokens up to the #end that belongs to the innermost open block, or to an #else,
    /// #elseif, #case or #range of it where that is asked for; that directive is taken. Its name.
    std::string_view skip(bool stop_at_else, bool stop_at_case);
    void call(const Token& at, const std::shared_ptr<const Macro>& macro);
    /// Where #declare or #local puts a variable of this name now.
    uint32_t scope_of(const Name* name, bool local) const;
    Slot& declare_in(uint32_t scope, Name* name);
    void bind(Name* name, uint32_t scope, Slot* slot);
    /// The value where it is given, or the caller's variable. scopes: where the call stands.
    std::pair<Slot*, Value> argument(size_t scopes);
    Frame& frame() { return frames_.back(); }
    uint32_t push_scope();
    void pop_scope();

    Hooks hooks_;
    LogSink log_;
    Names names_;
    std::string folder_;
    FilesRead* files_read_;
    std::vector<std::unique_ptr<SourceFile>> files_;
    std::map<std::string, SourceFile*> by_path_;
    std::vector<Frame> frames_;
    std::vector<Scope> scopes_;
    std::vector<Token> back_;
    std::set<std::string> warned_;
    std::map<std::string, std::string> written_; // files of #fopen, by name
    uint64_t written_bytes_ = 0;
    uint64_t available_; // memory, when reading began
    uint64_t unchecked_ = 0;
    uint64_t grown_ = 0;   // bytes, in all
    uint64_t changes_ = 0; // that changed() was told of
    uint64_t reads_ = 0;   // #read
    Place last_;
    uint64_t run_over_ = 0;
    int64_t brackets_ = 0;       // open around what is read: ( [ { and vectors
    std::optional<Depth> obeys_; // the innermost directive that is being obeyed
    size_t depth_ = 0;
};

} // namespace ovc::pov
