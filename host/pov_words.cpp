// SPDX-License-Identifier: Apache-2.0
// POV-Ray's words, one by one.
// Source: the documentation of POV-Ray 3.7, section 3.2, "Command-Line and INI-File Options".
#include "host/pov_words.h"

#include "host/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace ovc {
namespace {

/// Switches about what we do not have: a window, other texts, other ways to the same picture.
constexpr std::string_view kPassedOver[] = {"D",  "P",  "V",  "X",  "G",  "UV", "UO", "MB",
                                            "BP", "BS", "UR", "UL", "UD", "J",  "AM", "AG"};

/// Words with a meaning that ours have under another name, or not at all.
struct Refused {
    std::string_view word;
    std::string_view instead;
};
constexpr Refused kRefused[] = {
    {"KF", "--frames A:B takes frames of a camera path"},
    {"KI", "--frames A:B takes frames of a camera path"},
    {"K", "a scene has no clock here; --frames takes frames of a camera path"},
    {"SF", "--frames A:B takes frames from A to B"},
    {"EF", "--frames A:B takes frames from A to B"},
    {"SC", "--crop WxH+X+Y renders a part of the picture"},
    {"EC", "--crop WxH+X+Y renders a part of the picture"},
    {"SR", "--crop WxH+X+Y renders a part of the picture"},
    {"ER", "--crop WxH+X+Y renders a part of the picture"},
    {"SP", "there are no previews; a small --size is one"},
    {"EP", "there are no previews; a small --size is one"},
    {"L", "include files are found beside the scene and where POV-Ray has its own"},
    {"HI", "the scene itself has to include it"},
    {"MV", "the scene says its version itself: #version"},
    {"F", "the ending of -o's name says the format, .png or .exr; +FN16 is --png-bits 16"},
};

class Translation {
public:
    explicit Translation(const LogSink& log) : log_(log) {}

    Result<Done> take(const std::vector<std::string>& arguments) {
        for (size_t i = 0; i < arguments.size(); ++i) {
            const std::string& word = arguments[i];
            const std::string next = i + 1 < arguments.size() ? arguments[i + 1] : "";
            if (is_pov(word)) {
                const bool alone = word.size() == 2 && std::toupper(word[1]) == 'O';
                i += alone && !next.empty(); // +O file
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
            ours_.push_back(fmt::format("--samples={}", rays_a_side_ * rays_a_side_));
        return std::move(ours_);
    }

private:
    /// Ours with a minus are small letters or begin with two.
    static bool is_pov(const std::string& word) {
        return word.size() > 1 &&
               (word[0] == '+' || (word[0] == '-' && word[1] >= 'A' && word[1] <= 'Z'));
    }
    static bool takes_sign(const std::string& word) {
        return word == "--camera" || word == "--light";
    }

    Result<Done> take_word(const std::string& word) {
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
            antialiasing_ = on; // its threshold is for another method than ours
        else if (on && letters[0] == 'R' && !two)
            return take_depth(value);
        else if (letters == "C")
            take_continue(on);
        else if (on && (word == "+FN16" || word == "+fn16"))
            ours_.push_back("--png-bits=16");
        else if (!on || letters != "FN")
            return pass_over_or_refuse(word, letters);
        return Done{};
    }

    /// From 4 on there are shadows, from 8 on mirrors and glass; what else it tells apart is always
    /// there, or never.
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

    /// n x n rays a pixel.
    Result<Done> take_depth(const std::string& value) {
        const Result<uint64_t> side = parse_count("+R", value, 1, 9);
        if (!side)
            return side.error();
        rays_a_side_ = *side;
        return Done{};
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
                                 "+I +O +W +H +A +R +Q +C +WT +FN",
                                 word)};
    }

    const LogSink& log_;
    std::vector<std::string> ours_;
    std::string width_, height_;
    bool antialiasing_ = false;
    uint64_t rays_a_side_ = 3; // POV-Ray's default
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
