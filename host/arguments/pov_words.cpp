// SPDX-License-Identifier: Apache-2.0
// The tables of POV-Ray's words and settings, and their translation one by one.
// Source: the documentation of POV-Ray 3.7, section 3.2, "Command-Line and INI-File Options".
#include "host/arguments/pov_words.h"

#include "core/text/lower_case.h"
#include "host/arguments/arguments.h"
#include "host/arguments/pov_ini.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cctype>

namespace ovc {
namespace {

/// Switches that we ignore, since they leave the picture as it is: they are about a window, message
/// streams, or other ways to the same picture.
constexpr std::string_view kPassedOver[] = {"D",  "P",  "V",  "X",  "G",  "UV", "UO", "MB", "BP",
                                            "BS", "UR", "UL", "UD", "AG", "BM", "MI", "SU", "TH"};

/// A word that is an error, and what the error says instead: our option, or that there is none.
struct Refused {
    std::string_view word;
    std::string_view instead;
};
constexpr Refused kRefused[] = {
    {"KF", "the clock runs from 0 to 1; +KFI1 +KFF25 are its frames"},
    {"KI", "the clock runs from 0 to 1; +KFI1 +KFF25 are its frames"},
    {"KC", "the clock is 1 in the last frame"},
    {"K", "the clock of a still picture is 0; +KFI1 +KFF25 take it from 0 to 1"},
    {"SF", "+KFI1 +KFF25 take all frames, and --continue those that are not there"},
    {"EF", "+KFI1 +KFF25 take all frames, and --continue those that are not there"},
    {"SC", "--crop WxH+X+Y renders a part of the picture"},
    {"EC", "--crop WxH+X+Y renders a part of the picture"},
    {"SR", "--crop WxH+X+Y renders a part of the picture"},
    {"ER", "--crop WxH+X+Y renders a part of the picture"},
    {"SP", "there are no previews; a small --size is one"},
    {"EP", "there are no previews; a small --size is one"},
    {"L", "include files are found beside the scene and where POV-Ray has its own"},
    {"HI", "the scene itself has to include it"},
    {"F", "the ending of -o's name says the format, .png or .exr; +FN16 is --png-bits 16"},
};

/// A setting's key in .ini files, and its word on the command line.
struct Setting {
    std::string_view key;
    std::string_view word;
    bool is_switch = false; // on is "+WORD", off is "-WORD"; otherwise "+WORD" and the value
};
constexpr Setting kSettings[] = {
    {"antialias", "A", true},
    {"antialias_depth", "R"},
    {"antialias_gamma", "AG"},
    {"bounding", "MB", true},
    {"bounding_method", "BM"},
    {"bounding_threshold", "MB"},
    {"clock", "K"},
    {"continue_trace", "C", true},
    {"cyclic_animation", "KC", true},
    {"display", "D", true},
    {"dither", "TH", true},
    {"end_column", "EC"},
    {"end_row", "ER"},
    {"final_clock", "KF"},
    {"final_frame", "KFF"},
    {"height", "H"},
    {"include_header", "HI"},
    {"initial_clock", "KI"},
    {"initial_frame", "KFI"},
    {"input_file_name", "I"},
    {"jitter", "J", true},
    {"library_path", "L"},
    {"light_buffer", "UL", true},
    {"max_image_buffer_memory", "MI"},
    {"output_file_name", "O"},
    {"output_file_type", "F"},
    {"pause_when_done", "P", true},
    {"preview_end_size", "EP"},
    {"preview_start_size", "SP"},
    {"quality", "Q"},
    {"remove_bounds", "UR", true},
    {"render_block_size", "BS"},
    {"sampling_method", "AM"},
    {"split_unions", "SU", true},
    {"start_column", "SC"},
    {"start_row", "SR"},
    {"subset_end_frame", "EF"},
    {"subset_start_frame", "SF"},
    {"test_abort", "X", true},
    {"verbose", "V", true},
    {"version", "MV"},
    {"vista_buffer", "UV", true},
    {"width", "W"},
    {"work_threads", "WT"},
};

const Setting* setting_of(std::string_view key) {
    const auto at = std::find_if(std::begin(kSettings), std::end(kSettings),
                                 [&](const Setting& setting) { return setting.key == key; });
    return at == std::end(kSettings) ? nullptr : at;
}

class Translation {
public:
    explicit Translation(const LogSink& log) : log_(log) {}

    Result<Done> take(const std::vector<std::string>& arguments) {
        for (size_t i = 0; i < arguments.size(); ++i) {
            const std::string& word = arguments[i];
            const std::string next = i + 1 < arguments.size() ? arguments[i + 1] : "";
            const std::optional<IniItem> setting = as_setting(word);
            if (names_ini(word)) {
                if (const Result<Done> fine = take_ini(word); !fine)
                    return fine;
            } else if (setting && is_known(setting->key)) {
                if (const Result<Done> fine = take_setting(*setting); !fine)
                    return fine;
            } else if (is_pov(word)) {
                const bool alone = word.size() == 2 && std::toupper(word[1]) == 'O';
                i += alone && !next.empty(); // "+O file" is two words
                if (const Result<Done> fine = take_word(alone ? word + next : word); !fine)
                    return fine;
            } else if (takes_sign(word) && !next.empty()) {
                ours_.push_back(word + "=" + next);
                ++i;
            } else {
                ours_.push_back(word);
            }
        }
        return Done{};
    }

    Result<std::vector<std::string>> result() {
        if (width_.empty() != height_.empty())
            return Error{fmt::format("+W and +H belong together; {} is missing",
                                     width_.empty() ? "+W" : "+H")};
        if (!width_.empty())
            ours_.push_back("--size=" + width_ + "x" + height_);
        if (antialiasing_)
            add_antialias();
        if (!first_frame_.empty() && last_frame_.empty())
            return Error{"+KFI and +KFF belong together; +KFF is missing"};
        if (!last_frame_.empty())
            add_frames();
        return std::move(ours_);
    }

private:
    Result<Done> take_ini(const std::string& word) {
        constexpr int kMaxDeep = 10; // an .ini file may name others
        if (ini_depth_ == kMaxDeep)
            return Error{fmt::format("{}: .ini files name each other without an end", word)};
        const Result<std::vector<IniItem>> items = read_ini(word);
        if (!items)
            return items.error();
        ++ini_depth_;
        for (const IniItem& item : *items) {
            Result<Done> fine = item.key.empty() ? take({item.value}) : take_setting(item);
            if (!fine)
                return Error{item.place + fine.error().message};
        }
        --ini_depth_;
        return Done{};
    }

    /// Four keys have no row in kSettings, because take_setting() knows them by itself.
    static bool is_known(std::string_view key) {
        return setting_of(key) || key == "antialias_threshold" || key == "jitter_amount" ||
               key == "bits_per_color" || key == "output_to_file";
    }

    Result<Done> take_setting(const IniItem& item) {
        if (item.key == "antialias_threshold")
            threshold_ = item.value;
        else if (item.key == "jitter_amount")
            jitter_ = item.value;
        else if (item.key == "bits_per_color")
            return item.value == "16" ? take_word("+FN16") : Done{};
        else if (item.key == "output_to_file")
            return is_off(item.value) ? take_word("-F") : Done{};
        else if (const Setting* setting = setting_of(item.key); !setting)
            return Error{
                fmt::format("'{}' is no setting of POV-Ray's that is understood here", item.key)};
        else if (setting->is_switch)
            return take_word((is_off(item.value) ? "-" : "+") + std::string(setting->word));
        else
            return take_word("+" + std::string(setting->word) + item.value);
        return Done{};
    }

    static bool is_off(const std::string& word) {
        const std::string value = lower_case(word);
        return value == "off" || value == "no" || value == "false" || value == "0";
    }

    void add_antialias() {
        ours_.push_back("--antialias=" + threshold_);
        if (!method_.empty())
            ours_.push_back("--antialias-method=" + method_);
        if (!depth_.empty())
            ours_.push_back("--antialias-depth=" + depth_);
        if (!jitters_ || !jitter_.empty())
            ours_.push_back("--jitter=" + (jitters_ ? jitter_ : "0"));
    }

    /// Gives names of files a place for the frame's number, where they have none: before the
    /// ending, as POV-Ray does.
    void add_frames() {
        for (size_t i = 0; i + 1 < ours_.size(); ++i)
            if (std::string& name = ours_[i + 1];
                ours_[i] == "-o" && name.find('#') == std::string::npos)
                name.insert(std::min(name.rfind('.'), name.size()), last_frame_.size(), '#');
        ours_.push_back("--frames=" + (first_frame_.empty() ? "1" : first_frame_) + ":" +
                        last_frame_);
    }

    /// Our own options begin with "--", or with a minus and a small letter.
    static bool is_pov(const std::string& word) {
        return word.size() > 1 &&
               (word[0] == '+' || (word[0] == '-' && word[1] >= 'A' && word[1] <= 'Z'));
    }
    static bool takes_sign(const std::string& word) {
        return word == "--camera" || word == "--light";
    }

    Result<Done> take_word(const std::string& word) {
        assert(word.size() > 1 && (word[0] == '+' || word[0] == '-'));
        const bool on = word[0] == '+';
        std::string letters = word.substr(1, 2);
        std::transform(letters.begin(), letters.end(), letters.begin(),
                       [](unsigned char c) { return char(std::toupper(c)); });
        const bool two =
            letters.size() == 2 && std::isalpha(static_cast<unsigned char>(letters[1]));
        const std::string value = word.substr(letters == "WT" ? 3 : 2);
        if (on && letters == "WT")
            ours_.push_back("--threads=" + value);
        else if (on && letters[0] == 'W')
            width_ = value;
        else if (on && letters[0] == 'H' && letters != "HI")
            height_ = value;
        else if (on && letters[0] == 'O')
            ours_.insert(ours_.end(), {"-o", value});
        else if (on && letters[0] == 'I')
            ours_.push_back(value);
        else if (on && letters[0] == 'Q')
            return take_quality(value);
        else if (letters[0] == 'A' && !two)
            take_antialias(on, value);
        else if (letters == "AM")
            method_ = word.substr(3);
        else if (on && letters[0] == 'R' && !two)
            depth_ = value;
        else if (letters[0] == 'J' && !two)
            take_jitter(on, value);
        else if (letters == "MV")
            ours_.push_back("--pov-version=" + word.substr(3));
        else if (letters == "KF" && word.size() > 3 && std::toupper(word[3]) == 'I')
            first_frame_ = word.substr(4);
        else if (letters == "KF" && word.size() > 3 && std::toupper(word[3]) == 'F')
            last_frame_ = word.substr(4);
        else if (letters == "C")
            take_continue(on);
        else if (on && (word == "+FN16" || word == "+fn16"))
            ours_.push_back("--png-bits=16");
        else if (!on || letters != "FN")
            return pass_over_or_refuse(word, letters);
        return Done{};
    }

    /// POV-Ray has shadows from 4 on, mirrors and glass from 8 on. Whatever else its levels change,
    /// we always do, or never.
    Result<Done> take_quality(const std::string& value) {
        const Result<uint64_t> quality = parse_count("+Q", value, 0, 11);
        if (!quality)
            return quality.error();
        if (*quality < 4)
            ours_.push_back("--no-shadows");
        if (*quality < 8)
            ours_.push_back("--max-depth=0");
        return Done{};
    }

    void take_antialias(bool on, const std::string& threshold) {
        antialiasing_ = on;
        if (!threshold.empty())
            threshold_ = threshold;
    }

    void take_jitter(bool on, const std::string& amount) {
        jitters_ = on;
        if (!amount.empty())
            jitter_ = amount;
    }

    void take_continue(bool on) {
        if (on)
            ours_.push_back("--continue");
    }

    Result<Done> pass_over_or_refuse(const std::string& word, const std::string& letters) const {
        for (const std::string_view known : kPassedOver)
            if (letters.starts_with(known)) {
                say(log_, LogLevel::Info, fmt::format("{} means nothing here", word));
                return Done{};
            }
        for (const Refused& refused : kRefused)
            if (letters.starts_with(refused.word))
                return Error{fmt::format("{} is not there: {}", word, refused.instead)};
        return Error{fmt::format("'{}' is no word of POV-Ray's that is understood here; there are "
                                 "+I +O +W +H +A +AM +R +J +Q +C +MV +WT +FN +KFI +KFF",
                                 word)};
    }

    const LogSink& log_;
    std::vector<std::string> ours_;
    std::string width_, height_, first_frame_, last_frame_;
    bool antialiasing_ = false, jitters_ = true;
    std::string threshold_ = "0.3"; // POV-Ray's default
    std::string method_, depth_, jitter_;
    int ini_depth_ = 0;
};

} // namespace

Result<std::vector<std::string>> translate_pov_words(const std::vector<std::string>& arguments,
                                                     const LogSink& log) {
    Translation translation(log);
    if (const Result<Done> fine = translation.take(arguments); !fine)
        return fine.error();
    return translation.result();
}

} // namespace ovc
