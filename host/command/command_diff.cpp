// SPDX-License-Identifier: Apache-2.0
// overcast diff: compares two pictures, with the exit codes of OpenImageIO's idiff.
#include "host/arguments/arguments.h"
#include "host/command/command.h"
#include "host/diff/verdict.h"
#include "host/output/output.h"
#include "host/output/srgb.h"
#include "host/terminal/message.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>

namespace ovc {

static constexpr const char* kDiffExamples =
    R"(PNG is compared as its codes, 0 to 1 whatever its depth; OpenEXR as its numbers, every layer that both files have.
Of a PNG and an OpenEXR file, the second is encoded as sRGB first, but not rounded. Whole numbers, such as the layers
id and leaf, are equal or not. FLIP (Andersson et al. 2020) says how different the colors look, 0 to 1, to somebody who
sees one picture after the other from 0.7 m on a screen of 3840 pixels and 0.7 m.

Exit codes are those of OpenImageIO's idiff, not those of the other commands:
  0  within both limits
  1  a warning: more than --warnpercent of the pixels are more than --warn apart, or one more than --hardwarn
  2  a failure: the same of --failpercent, --fail and --hardfail
  3  the pictures cannot be compared: other sizes, or no channel in common
  4  nothing was compared: a file that cannot be read or written, or wrong arguments

Examples:
  overcast diff old.png new.png
      equal to the last bit, or how far apart
  overcast diff ours.png theirs.png --fail 0.004 --failpercent 1 -o far.png --scale 20
      one code of 255 is nothing, and so is 1 % of the pixels; the difference, 20 times as bright
  overcast diff a.exr b.exr --json | jq .flip.mean
      one number for a program
  overcast diff a.exr b.exr -o d.exr && echo same
      in a script, with the difference of every channel)";

namespace {

/// The three options of a limit as the user wrote them.
struct LimitWords {
    std::string each, percent, any;

    /// name: fail or warn; code: the exit code when the limit is exceeded.
    void add_to(CLI::App& app, const std::string& name, Verdict code) {
        app.add_option("--" + name, each,
                       fmt::format("Pixels that are farther apart than this count for "
                                   "--{}percent; default: 1e-6",
                                   name))
            ->type_name("X");
        app.add_option(
               "--" + name + "percent", percent,
               fmt::format("The exit code is {} where more than so many percent are farther; "
                           "default: 0",
                           int(code)))
            ->type_name("P");
        app.add_option("--hard" + name, any,
                       fmt::format("The exit code is {} where a single pixel is farther apart than "
                                   "this; default: never",
                                   int(code)))
            ->type_name("X");
    }
};

Result<double> parse_limit(std::string_view option, std::string_view text, double otherwise) {
    if (text.empty())
        return otherwise;
    double value = 0;
    const auto [stop, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc{} || stop != text.data() + text.size() || !(value >= 0))
        return Error{fmt::format("{} needs a number from 0 on, not '{}'", option, text)};
    return value;
}

Result<Limit> understand(const LimitWords& words, const std::string& name) {
    const Limit defaults;
    const Result<double> each = parse_limit("--" + name, words.each, defaults.each);
    const Result<double> percent =
        parse_limit("--" + name + "percent", words.percent, defaults.percent);
    const Result<double> any = parse_limit("--hard" + name, words.any, defaults.any);
    for (const Result<double>* value : {&each, &percent, &any})
        if (!*value)
            return value->error();
    return Limit{*each, *percent, *any};
}

/// Returns the differences of red, green and blue, times `scale`. as_codes: for a .png, whose codes
/// should be the differences; the picture holds the light that is encoded as them.
Image picture_of(const Comparison& comparison, double scale, bool as_codes) {
    Image image(comparison.width, comparison.height);
    for (vec4& pixel : image.pixels)
        pixel.a = 1;
    static constexpr std::string_view kNames[] = {"R", "G", "B"};
    for (int channel = 0; channel < 3; ++channel)
        for (const Layer& layer : comparison.differences)
            if (layer.name == kNames[channel])
                for (size_t i = 0; i < image.pixels.size(); ++i) {
                    const float d = std::bit_cast<float>(layer.values[i]) * float(scale);
                    image.pixels[i][channel] = as_codes ? srgb_light(std::min(d, 1.0f)) : d;
                }
    return image;
}

/// Returns the differences of all other channels, for a format that has layers. That of opacity has
/// another name, for the picture itself is opaque.
std::vector<Layer> other_layers(const Comparison& comparison) {
    std::vector<Layer> layers;
    for (const Layer& layer : comparison.differences)
        if (layer.name.find_first_not_of("RGB") != std::string::npos || layer.name.size() > 1) {
            layers.push_back(layer);
            if (layer.name == "A")
                layers.back().name = "opacity";
        }
    return layers;
}

class Diff final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Compares two pictures, .png or .exr: largest and mean difference, RMSE, "
                        "PSNR, FLIP.");
        app.add_option("A", a_, "A picture")->required();
        app.add_option("B", b_, "Another of the same size")->required();
        app.add_option("-o,--output", output_,
                       "The difference of each channel, without its sign: .png of the colors, .exr "
                       "of all channels, that of A as opacity")
            ->type_name("FILE");
        app.add_option("--scale", scale_,
                       "The colors of that file are so many times the difference; default: 1")
            ->type_name("X");
        fail_.add_to(app, "fail", Verdict::Failure);
        warn_.add_to(app, "warn", Verdict::Warning);
        app.add_flag("--json", json_, "As JSON, for a program (docs/guide/diff.md)");
        app.add_flag("-q,--quiet", quiet_, "Print nothing but errors");
        app.footer(kDiffExamples);
    }

    Result<int> run() override {
        const Result<Limit> fail = understand(fail_, "fail");
        if (!fail)
            return fail.error();
        const Result<Limit> warn = understand(warn_, "warn");
        if (!warn)
            return warn.error();
        const Result<double> scale = parse_limit("--scale", scale_, 1);
        if (!scale)
            return scale.error();
        if (const Result<Done> fine = check_output(); !fine)
            return fine.error();
        Result<Channels> a = read_channels(a_);
        if (!a)
            return a.error();
        Result<Channels> b = read_channels(b_);
        if (!b)
            return b.error();
        return compared(*a, *b, {*fail, *warn}, *scale);
    }

private:
    Result<Done> check_output() const {
        if (output_.empty())
            return Done{};
        if (const Result<Done> fine = check_image_output(output_); !fine)
            return fine;
        for (const std::string& input : {a_, b_}) {
            const NamedFile files[] = {{"input", input}, {"output", output_}};
            if (const Result<Done> fine = check_distinct(files); !fine)
                return fine;
        }
        return Done{};
    }

    Result<int> compared(Channels& a, Channels& b, const Limits& limits, double scale) const {
        if (a.width != b.width || a.height != b.height)
            return cannot_be_compared(fmt::format("{} has {} x {} pixels, {} has {} x {}", a_,
                                                  a.width, a.height, b_, b.width, b.height));
        if (a.x != b.x || a.y != b.y)
            return cannot_be_compared(fmt::format("{} begins at pixel {}, {} of its picture, {} at "
                                                  "{}, {}",
                                                  a_, a.x, a.y, b_, b.x, b.y));
        if (a.coding != b.coding)
            encode_srgb(a.coding == Coding::Linear ? a : b);
        else if (a.coding == Coding::Srgb)
            add_opacity(a, b);
        const Comparison comparison = compare(a, b);
        if (comparison.layers.empty())
            return cannot_be_compared(fmt::format("{} and {} have no channel in common", a_, b_));
        if (const Result<Done> saved = save(comparison, scale); !saved)
            return saved.error();
        if (json_)
            fmt::print("{}", diff_json(a_, b_, comparison, limits));
        else if (!quiet_)
            print_lines(diff_text(a_, b_, comparison, limits));
        return int(judge(comparison, limits));
    }

    static int cannot_be_compared(const std::string& why) {
        print_message(why);
        return int(Verdict::NotComparable);
    }

    Result<Done> save(const Comparison& comparison, double scale) const {
        if (output_.empty())
            return Done{};
        FileContents contents;
        if (takes_layers(output_))
            contents.layers = other_layers(comparison);
        return save_image(picture_of(comparison, scale, /* as_codes= */ !takes_layers(output_)),
                          output_, contents);
    }

    std::string a_, b_, output_, scale_;
    LimitWords fail_, warn_;
    bool json_ = false;
    bool quiet_ = false;
};

} // namespace

std::unique_ptr<Subcommand> make_diff() {
    return std::make_unique<Diff>();
}

} // namespace ovc
