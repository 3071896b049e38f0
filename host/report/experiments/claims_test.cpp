// SPDX-License-Identifier: Apache-2.0
// Compares the report's claims with the documents, so that figures and promises cannot drift apart.
#include "host/report/experiments/claims.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace ovc {
namespace {

namespace fs = std::filesystem;

/// Returns the line without Markdown's marks for emphasis, code and columns.
std::string plain(const std::string& line) {
    std::string text;
    for (const char c : line)
        if (c == '|')
            text += ' ';
        else if (c != '*' && c != '`')
            text += c;
    return text;
}

/// Returns the rows of tables and the paragraphs, each as one line, of each section by its heading;
/// those before the first section have "".
std::map<std::string, std::vector<std::string>> sections_of(const std::string& document) {
    std::map<std::string, std::vector<std::string>> sections;
    std::string heading;
    std::ifstream file(fs::path(OVC_SOURCE_DIR) / document);
    EXPECT_TRUE(file) << document;
    bool in_paragraph = false;
    for (std::string line; std::getline(file, line);) {
        const bool begins = line.empty() || line.starts_with("|") || line.starts_with("#") ||
                            line.starts_with("* ") || line.starts_with("- ");
        if (line.starts_with("## "))
            heading = line.substr(3);
        else if (in_paragraph && !begins)
            sections[heading].back().append(" ").append(line, line.find_first_not_of(' '));
        else
            sections[heading].push_back(line);
        in_paragraph = !line.empty() && !line.starts_with("|") && !line.starts_with("#");
    }
    return sections;
}

/// Finds `words` where they begin and end as whole words, so that 0.5 is not found in 0.55.
size_t find_words(const std::string& line, const std::string& words, size_t from) {
    const auto goes_on = [&](size_t at) {
        return at < line.size() && (std::isalnum(static_cast<unsigned char>(line[at])) ||
                                    (line[at] == '.' && at + 1 < line.size() &&
                                     std::isdigit(static_cast<unsigned char>(line[at + 1]))));
    };
    for (size_t at = line.find(words, from); at != std::string::npos; at = line.find(words, at + 1))
        if ((at == 0 || !goes_on(at - 1)) && !goes_on(at + words.size()))
            return at;
    return std::string::npos;
}

bool says(const std::string& line, const Claim& claim) {
    const size_t at = find_words(line, claim.what, 0);
    return at != std::string::npos &&
           find_words(line, claim.says, at + claim.what.size()) != std::string::npos;
}

TEST(Claims, StandInTheDocuments) {
    for (const Claim& claim : claims()) {
        const auto sections = sections_of(claim.document);
        ASSERT_TRUE(sections.contains(claim.heading)) << claim.document << ": " << claim.heading;
        EXPECT_TRUE(
            std::ranges::any_of(sections.at(claim.heading),
                                [&](const std::string& line) { return says(plain(line), claim); }))
            << claim.document << ", " << claim.heading << ", does not say: " << claim.what
            << " ... " << claim.says;
    }
}

/// Returns the first cells of the section's tables, without their headers.
std::vector<std::string> first_cells(const std::vector<std::string>& lines) {
    std::vector<std::string> cells;
    bool in_body = false;
    for (const std::string& line : lines)
        if (line.starts_with("|--"))
            in_body = true;
        else if (!line.starts_with("|"))
            in_body = false;
        else if (in_body)
            cells.push_back(plain(line.substr(2, line.find(" |", 2) - 2)));
    return cells;
}

TEST(Claims, AreAllOfTheBarsAndOfWhatThePerformancePageMeasures) {
    std::set<std::string> claimed;
    for (const Claim& claim : claims())
        claimed.insert(claim.what);
    const std::vector<std::string> bars =
        first_cells(sections_of("docs/benchmarks.md")["The bars"]);
    EXPECT_GT(bars.size(), 20u);
    for (const std::string& line : bars)
        EXPECT_TRUE(claimed.contains(line)) << line;
    const std::vector<Claim> all = claims();
    const auto is_claimed = [&](const std::string& line) {
        return std::ranges::any_of(all, [&](const Claim& one) { return says(plain(line), one); });
    };
    auto performance = sections_of("docs/guide/performance.md");
    for (const char* heading : {"Measured", "What it promises"})
        for (const std::string& line : performance[heading]) {
            const bool is_row = line.starts_with("| ") && !line.starts_with("| what");
            EXPECT_TRUE(!(is_row || line.starts_with("- ")) || is_claimed(line)) << line;
        }
}

TEST(Claims, AreOfEverySectionOfTheBenchmarks) {
    std::set<std::string> claimed;
    for (const Claim& claim : claims())
        claimed.insert(claim.heading);
    claimed.insert({"", "Contenders, columns, keys"}); // these have no figures
    for (const auto& [heading, lines] : sections_of("docs/benchmarks.md"))
        EXPECT_TRUE(claimed.contains(heading)) << heading;
}

/// Returns every TEST(Suite, Name) of the sources as "Suite.Name".
std::set<std::string> all_tests() {
    std::set<std::string> tests;
    for (const char* folder : {"core", "importers", "kdtree", "gpu", "plugin", "host", "tests"})
        for (const fs::directory_entry& file :
             fs::recursive_directory_iterator(fs::path(OVC_SOURCE_DIR) / folder)) {
            if (file.path().extension() != ".cpp")
                continue;
            std::ifstream text(file.path());
            for (std::string line; std::getline(text, line);) {
                const size_t open = line.find('('), comma = line.find(", "), close = line.find(')');
                if (line.starts_with("TEST") && comma < close)
                    tests.insert(line.substr(open + 1, comma - open - 1) + "." +
                                 line.substr(comma + 2, close - comma - 2));
            }
        }
    return tests;
}

TEST(Claims, NameTestsThatAreThere) {
    const std::set<std::string> tests = all_tests();
    constexpr std::string_view command = "ctest -R ";
    for (const Claim& claim : claims()) {
        EXPECT_TRUE(claim.measure || !claim.held_by.empty()) << claim.what;
        if (claim.held_by.starts_with(command)) {
            const std::string name = claim.held_by.substr(command.size());
            EXPECT_TRUE(std::ranges::any_of(tests, [&](const std::string& test) {
                return test.starts_with(name);
            })) << claim.held_by;
        }
    }
}

} // namespace
} // namespace ovc
