// SPDX-License-Identifier: Apache-2.0
// Makes the report as a user does, on small scenes: each experiment gets a whole page, and every
// number on it stands in its JSON.
#include "tests/run_command.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string_view>

namespace ovc {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string text_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

/// Returns the texts between each `open` and the next `close`.
std::vector<std::string> between(const std::string& text, const std::string& open,
                                 const std::string& close) {
    std::vector<std::string> found;
    for (size_t at = 0; (at = text.find(open, at)) != std::string::npos;) {
        const size_t begin = at + open.size();
        at = text.find(close, begin);
        if (at == std::string::npos)
            break;
        found.push_back(text.substr(begin, at - begin));
    }
    return found;
}

std::string without(std::string text, const std::string& open, const std::string& close) {
    for (size_t at; (at = text.find(open)) != std::string::npos;) {
        const size_t end = text.find(close, at);
        text.erase(at, end == std::string::npos ? end : end + close.size() - at);
    }
    return text;
}

std::string plain(std::string text) {
    text = without(std::move(text), "<", ">");
    for (const auto& [name, letter] : std::map<std::string, std::string>{
             {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}})
        for (size_t at; (at = text.find(name)) != std::string::npos;)
            text.replace(at, name.size(), letter);
    return text;
}

bool has_digit(const std::string& text) {
    return std::ranges::any_of(text, [](unsigned char c) { return std::isdigit(c); });
}

/// Splits the text at spaces and removes punctuation around the words.
std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; stream >> word;) {
        const size_t begin = word.find_first_not_of("(,.;:"), end = word.find_last_not_of("),.;:");
        if (begin != std::string::npos && end != std::string::npos && begin <= end)
            words.push_back(word.substr(begin, end - begin + 1));
    }
    return words;
}

/// Adds the words of all texts in the JSON.
void add_words(const Json& json, std::set<std::string>& words) {
    if (json.is_string())
        for (std::string& word : words_of(json.get<std::string>()))
            words.insert(std::move(word));
    else if (json.is_structured())
        for (const Json& part : json)
            add_words(part, words);
}

class Report : public testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        if (test::run_shell("command -v gnuplot").exit_code != 0)
            GTEST_SKIP() << "gnuplot is not installed";
        std::string name = GetParam();
        std::ranges::replace(name, ' ', '_');
        folder = fs::path(OVC_BINARY_DIR) / "tests" / ("report_" + name);
        fs::remove_all(folder);
        if (takes_a_dragon())
            make_data();
    }
    test::CommandResult make() const {
        // What the page says of its JSON does not depend on the number of rays or triangles.
        return test::run_shell(OVC_BINARY_DIR "/bin/overcast report --quick --size 64x64 -o '" +
                               folder.string() + "' --only " + GetParam() +
                               (takes_a_dragon() ? " --data '" + data().string() + "'" : ""));
    }
    static bool takes_a_dragon() { return std::string_view(GetParam()).starts_with("dragon"); }
    /// Where the experiments on dragons find a sphere of 1,280 triangles as the scan.
    fs::path data() const { return folder.string() + "_data"; }
    void make_data() const {
        const fs::path scan = data() / "meshes/stanford-dragon/dragon_vrip.ply";
        fs::create_directories(scan.parent_path());
        ASSERT_EQ(test::run_shell(OVC_BINARY_DIR "/bin/overcast convert --quiet sphere-3 '" +
                                  scan.string() + "'")
                      .exit_code,
                  0);
    }
    const Json& figures(const std::string& file) {
        if (!files_.contains(file))
            files_[file] = Json::parse(text_of(folder / file));
        return files_[file];
    }
    /// Checks one number of a page. data: the part of <data value="V"
    /// data-at="FILE#POINTER">shown</data> that follows `<data value="`.
    void expect_in_its_json(const std::string& data) {
        const std::string value = data.substr(0, data.find('"'));
        const std::string at = between(data, "data-at=\"", "\"").at(0);
        const Json& stored = figures(at.substr(0, at.find('#')))
                                 .at(Json::json_pointer(plain(at.substr(at.find('#') + 1))));
        ASSERT_TRUE(stored.is_number()) << at;
        EXPECT_EQ(stored.dump(), value) << at;
        std::string shown = data.substr(data.find('>') + 1);
        std::erase(shown, ',');
        EXPECT_NEAR(std::stod(shown), stored.get<double>(), 0.006 * std::abs(stored.get<double>()))
            << at << ": " << shown;
    }
    /// Checks that the text outside of <data> has no word with a digit, except words of the JSON's
    /// texts, such as a scene's name.
    void expect_no_other_number(std::string html, const std::set<std::string>& words) {
        html = without(std::move(html), "<data ", "</data>");
        for (const std::string& word : words_of(plain(std::move(html))))
            if (has_digit(word)) {
                EXPECT_TRUE(words.contains(word)) << "a number that is not in the JSON: " << word;
            }
    }
    void expect_all_numbers_in_json(const std::string& html) {
        const std::vector<std::string> numbers = between(html, "<data value=\"", "</data>");
        EXPECT_FALSE(numbers.empty());
        for (const std::string& data : numbers)
            expect_in_its_json(data);
        const std::vector<std::string> sections = between(html, "<section id=\"", "</section>");
        ASSERT_EQ(sections.size(), 1u);
        std::set<std::string> words;
        add_words(figures(sections[0].substr(0, sections[0].find('"')) + ".json"), words);
        for (const std::string& cell : between(sections[0], "<td", "</td>"))
            expect_no_other_number(cell.substr(cell.find('>') + 1), words);
        for (const std::string& paragraph : between(sections[0], "<p>", "</p>"))
            expect_no_other_number(paragraph, words);
    }
    void expect_all_plots(const std::string& html) const {
        size_t plots = 0;
        for (const fs::directory_entry& file : fs::directory_iterator(folder / "plots"))
            if (file.path().extension() == ".svg") {
                ++plots;
                EXPECT_TRUE(fs::exists(fs::path(file.path()).replace_extension(".png")));
            }
        EXPECT_EQ(between(html, "<svg", "</svg>").size(), plots);
        EXPECT_GT(plots, 0u);
    }

    fs::path folder;

private:
    std::map<std::string, Json> files_;
};

TEST_P(Report, HasEveryNumberInItsJsonAndRepeatsNothing) {
    const test::CommandResult made = make();
    ASSERT_EQ(made.exit_code, 0) << made.output;
    const std::string html = text_of(folder / "index.html");
    expect_all_numbers_in_json(html);
    expect_all_plots(html);
    EXPECT_THAT(text_of(folder / "summary.md"), testing::HasSubstr("](plots/"));
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder / "raw"))
        if (file.path().extension() == ".png") {
            const std::string png =
                test::run_shell("base64 -w0 '" + file.path().string() + "'").output;
            EXPECT_TRUE(html.find("src=\"data:image/png;base64," + png + "\"") != std::string::npos)
                << file.path() << " is not on the page";
        }
    std::map<fs::path, fs::file_time_type> raw;
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder / "raw"))
        raw[file.path()] = fs::last_write_time(file);
    ASSERT_EQ(make().exit_code, 0);
    for (const auto& [path, time] : raw)
        EXPECT_EQ(fs::last_write_time(path), time) << path << " was made anew";
}

/// The library of tests/broken_kernel differs from this one by a line of its kernel.
TEST(BrokenKernel, ShowsUpAsWrongIds) {
    if (test::run_shell("command -v gnuplot").exit_code != 0)
        GTEST_SKIP() << "gnuplot is not installed";
    const fs::path folder = fs::path(OVC_BINARY_DIR) / "tests" / "report_broken";
    fs::remove_all(folder);
    const test::CommandResult made = test::run_shell(
        "OVC_PLUGIN=" OVC_BINARY_DIR "/bin/libovercast-broken.so " OVC_BINARY_DIR
        "/bin/overcast report --quick --only error --scene sphere-4 --size 64x64 -o '" +
        folder.string() + "'");
    EXPECT_EQ(made.exit_code, 1);
    EXPECT_THAT(made.output, testing::HasSubstr("answered wrong"));
    EXPECT_THAT(text_of(folder / "index.html"), testing::HasSubstr("class=\"trouble\""));
    const Json figures = Json::parse(text_of(folder / "error.json"));
    const auto wrong_of = [&](const Json& workload, const std::string& family) {
        double most = 0;
        for (const Json& choice : workload["choices"])
            if (choice["choice"].get<std::string>().starts_with(family))
                most = std::max(most, choice["wrong_per_million"].get<double>());
        return most;
    };
    for (const Json& workload : figures["scenes"][0]["workloads"])
        if (workload["workload"] == "edges") { // The broken line decides these rays.
            EXPECT_GT(wrong_of(workload, "certified"), 1000);
            EXPECT_EQ(wrong_of(workload, "cpu-kdtree"), 0);
            return;
        }
    FAIL() << "no rays at edges";
}

INSTANTIATE_TEST_SUITE_P(Experiments, Report,
                         testing::Values("error --scene sphere-4", "tessellation",
                                         "samples --scene sphere-3", "scale --scene sphere-6",
                                         "hard-cases", "claims --scene sphere-5",
                                         "pictures --scene sphere-5", "left-out --scene sphere-3",
                                         "dragons --scene dragons-1", "dragonball",
                                         "plants --scene plants-1",
                                         "powerplant --scene powerplant-200000"),
                         [](const testing::TestParamInfo<const char*>& one) {
                             const std::string words = one.param;
                             std::string name = words.substr(0, words.find(' '));
                             std::erase(name, '-');
                             return name;
                         });

} // namespace
} // namespace ovc
