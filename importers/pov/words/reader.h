// SPDX-License-Identifier: Apache-2.0
// Reader: the tokens of a scene in the order in which they take effect. It obeys directives itself
// and inserts the tokens of includes and macros.
#pragma once

#include "core/moment.h"
#include "core/scene.h"
#include "core/system/log.h"
#include "importers/file/files_read.h"
#include "importers/pov/values/value.h"

#include <deque>
#include <filesystem>
#include <functional>
#include <set>

namespace ovc::pov {

/// Bounds on the work that a scene may cause, each far beyond what real scenes need.
struct Limits {
    uint64_t tokens = 0;   // read in all, with those of further rounds and calls
    size_t nesting = 1000; // includes and macros inside each other
    /// A loop counts as endless once it has exceeded both of these without making anything, and a
    /// #while also once it has run `rounds` rounds without reading from a file.
    uint64_t idle_rounds = 100'000, idle_tokens = 15'000'000;
    uint64_t rounds = 1'000'000;
    uint64_t objects = 20'000'000;
    uint64_t triangles = 0; // of an object that the scene asks about
    uint64_t array_items = 2'000'000;
    uint32_t chain = 2000;      // groups in groups
    uint32_t array_depth = 100; // arrays in arrays, all of which are copied with the outermost
    uint32_t operations = 4000; // of a function and those it calls
    size_t depth = 400; // blocks and parentheses inside each other, for which the stack has room
};

class Reader;
class Font;
class TraceTarget;

/// Counts how deep the parser's functions call each other. Throws ParseError beyond Limits::depth.
class Deeper {
public:
    explicit Deeper(Reader& reader);
    ~Deeper();
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;

private:
    Reader& reader_;
};

/// Tells the reader that a vector is being read, in which directives are obeyed wherever they
/// stand, as in parentheses. The reader cannot tell by itself whether a '<' is a bracket.
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
    /// The parser's functions that directives call: pov.cpp passes those of parse/ and values/.
    struct Hooks {
        std::function<Value(Reader&)> value;
        std::function<double(Reader&)> number;    // a float expression
        std::function<double(Reader&)> condition; // one that may compare, in parentheses
        /// The item of the slot's array whose indices come next, from the first [ on.
        std::function<ValueHandle(Reader&, Slot&)> item;
        std::function<void(Reader&)> defaults; // the block of #default
    };

    /// `files_read`, or null, receives every file that is looked for or read.
    Reader(Hooks hooks, LogSink log, std::string main_folder, FilesRead* files_read);
    ~Reader();
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    /// Starts with the scene's own file. Must be called once, before anything is read.
    void open(std::unique_ptr<SourceFile> file);

    /// Takes the next token of the scene, an End where it is over. Directives are obeyed and macros
    /// replaced by their tokens, so it returns neither.
    Token next();
    const Token& peek();
    void put_back(const Token& token);
    /// Returns the next token where it may be an operator; next() then takes it. A directive ends
    /// the value of another one, such as #declare: it is returned, but neither obeyed nor taken. In
    /// brackets, in a macro that gives the value and outside of directives it is obeyed.
    Token peek_operator() { return peek_held(Hold::Directives); }
    /// Returns the next token where it may be more of a value that could end here, such as another
    /// layer of a texture, likewise. A macro ends the value too, and runs once it is declared.
    Token peek_more() { return peek_held(Hold::DirectivesAndMacros); }

    /// Takes the sign `c`, or throws ParseError.
    void expect(char c, std::string_view after);
    /// Takes the next token if it is this one, and returns whether it is.
    bool take(char c);
    bool take(std::string_view word);
    void take_comma() { take(','); }

    [[noreturn]] void fail(const Place& at, const std::string& sentence) const;
    [[noreturn]] void fail_here(const std::string& expected);
    /// Counts work other than reading tokens as the number of words that take about as long to
    /// read. Throws ParseError beyond Limits::tokens.
    void spend(uint64_t words);
    /// Notes that a variable or a random stream has changed. A round of a #while that changes
    /// nothing would repeat for ever.
    void changed() { ++changes_; }
    /// Counts bytes before the scene takes them. Throws ParseError once reading has taken more than
    /// half of the memory that was available, because the triangles need the rest.
    void grow(uint64_t bytes);
    /// Updates the array's depth before `item` goes into it. Throws ParseError beyond a limit.
    void count_depth(Array& array, const Value& item) const;
    /// Returns a note, which lives as long as the reader. There are no more of them than words in
    /// the scene's files, apart from sentences that name a file.
    const Note* note(const std::string& kind, const Place& at, const std::string& sentence);
    /// Logs a warning, once for each `kind`.
    void warn(const std::string& kind, const Place& at, const std::string& sentence);
    /// Warns of a thing that is not drawn as its author meant, and counts it. Throws ParseError
    /// instead where the reader is strict.
    void omit(const std::string& kind, const Place& at, const std::string& sentence);
    std::vector<Omission> omissions() const;
    bool strict = false;

    /// Returns the innermost variable of this name, or null. The scope of the variable owns it.
    Slot* find(const Name* name) const;
    /// Returns the value, or null where its variable has ended or its array has no such item.
    Value* value_of(const ValueHandle& handle) const;
    /// Returns the variable to assign to: with `local` in the scope of the running macro or
    /// include, else the innermost one of this name, or a new one of the scene where there is none.
    Slot& declare(Name* name, bool local);
    void undefine(Name* name);

    /// Finds a file as files.h says: beside the scene, beside the including files, among POV-Ray's.
    std::filesystem::path find_file(const std::string& name, std::string_view extension) const;
    /// Returns the text of a file that the scene has written and closed, or null.
    const std::string* written(const std::string& name) const;
    Names& names() { return names_; }
    const Place& place() const { return last_; } // of the token read last
    Caller caller() const;                       // of the code that is running
    double version = 3.7;
    bool version_given = false; // without a #version povray takes the scene for an older one
    /// Returns whether colors are linear light instead of code values for a screen.
    bool has_linear_colors() const { return version_given && version >= 3.7; }
    /// Returns the noise of patterns that do not name one.
    NoiseKind noise_kind() const {
        return noise.value_or(version < 3.5 ? NoiseKind::Original : NoiseKind::Corrected);
    }
    double gamma = 1; // assumed_gamma, to which srgb colors are converted
    ImageSize picture{640, 480};
    Moment moment;
    bool moves = false;             // the scene has asked for the moment
    bool has_media = false;         // it names media, fog or rainbows
    Texture defaults;               // of #default
    TexturePtr shared_defaults;     // the same, for the objects that are drawn from here on
    std::optional<NoiseKind> noise; // noise_generator of global_settings
    int wave_sources = 10;          // number_of_waves of global_settings
    /// The objects that the scene asked about with trace().
    std::map<ObjectPtr, std::unique_ptr<const TraceTarget>> targets;
    std::map<std::string, std::unique_ptr<Font>> fonts; // by name; shapes point to their letters
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
        size_t start = 0;        // of a While's condition, or of a For's body
        Slot* counter = nullptr; // of a For
        double last = 0, step = 0;
        double value = 0; // of a Switch
        bool matched = false;
        Place place;
        Progress progress{};  // of a loop, when it last made something
        uint64_t changes = 0; // of a While, when its round began
        uint64_t rounds = 0, reads = 0, rounds_at_read = 0;
    };
    /// The depth of frames, blocks and brackets at which a directive began.
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
    /// The variable whose value is being read, and the scope that it will be in.
    struct Declaring {
        const Name* name = nullptr;
        uint32_t scope = 0;
    };
    /// So many scopes stay after their end: a macro's last word may name its variable, and macros
    /// may end together with the word that is looked at to see whether an index follows.
    static constexpr size_t kEndedScopes = 16;
    struct Scope {
        uint64_t serial; // ascending
        std::vector<Name*> names;
        std::vector<std::unique_ptr<Slot>> slots;
    };

    Token raw();
    const Token& peek_raw() const;
    /// What ends the value of a directive, and is then neither obeyed nor taken.
    enum class Hold { Nothing, Directives, DirectivesAndMacros };
    Token step(Hold hold);
    Token peek_held(Hold hold);
    /// Returns whether a directive that comes now ends the value of the one that is being obeyed.
    bool ends_value() const;
    Name* raw_name(std::string_view after);
    void raw_expect(char c, std::string_view after);
    void take_semicolon();
    void pop_frame();
    void obey(const Token& directive);
    void do_declare(bool local);
    void do_undef();
    void do_include();
    const SourceFile* included(const std::string& name, const Place& at);
    SourceFile& add_file(std::string name, std::string folder, std::string text);
    void do_if(bool condition, const Place& at);
    void do_else(const Token& at);
    void do_end(const Token& at);
    void do_while(const Token& at);
    void test_while(Condition& loop);
    /// Counts a further round of a loop. Throws ParseError where nothing suggests that it will end.
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
    /// Takes the name of an open file.
    ValueHandle raw_file(std::string_view after, bool writes);
    /// Returns the file, or throws ParseError where the values that a directive reads closed it.
    DataFile& open_file(const ValueHandle& handle, const Place& at) const;
    bool condition();
    void check_is_no_condition(const Token& at, size_t blocks_that_stay);
    /// Skips tokens up to the #end of the innermost open block or, where that is asked for, up to
    /// its next #else, #elseif, #case or #range. Takes that directive and returns its name.
    std::string_view skip(bool stop_at_else, bool stop_at_case);
    void call(const Token& at, const Macro& macro);
    /// Returns the scope in which #declare or #local would put a variable of this name now.
    uint32_t scope_of(const Name* name, bool local) const;
    Slot& declare_in(uint32_t scope, Name* name);
    void bind(Name* name, uint32_t scope, Slot* slot);
    /// Reads an argument. Returns the caller's variable, or null and a value. `scopes` is how many
    /// scopes there were at the call.
    std::pair<Slot*, Value> argument(size_t scopes);
    Frame& frame() { return frames_.back(); }
    uint32_t push_scope();
    Slot& add_slot(uint32_t scope);
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
    std::deque<Scope> ended_; // the last of them
    uint64_t last_scope_ = 0; // the serial number given last
    /// By the place of the body. Declaring a macro again and again keeps one of it.
    std::map<std::pair<const SourceFile*, size_t>, Macro> macros_;
    std::set<Note> notes_;
    std::vector<Token> back_;
    std::set<std::string> warned_;
    std::map<std::string, Omission> omissions_;  // by kind
    std::map<std::string, std::string> written_; // files of #fopen, by name
    uint64_t written_bytes_ = 0;
    uint64_t available_;     // bytes of memory when reading began
    uint64_t unchecked_ = 0; // bytes that grow() has counted since it last checked the memory
    uint64_t grown_ = 0;     // bytes that grow() has counted in all
    uint64_t changes_ = 0;   // calls of changed()
    uint64_t reads_ = 0;     // #read directives
    Place last_;
    uint64_t run_over_ = 0;      // words that spend() has counted
    int64_t brackets_ = 0;       // open ( [ { and vectors; below 0 after a stray ) ] or }
    std::optional<Depth> obeys_; // the innermost directive that is being obeyed
    Declaring declaring_;
    std::optional<Depth> condition_; // the innermost condition that is being read
    size_t depth_ = 0;
};

} // namespace ovc::pov
