// SPDX-License-Identifier: Apache-2.0
// Edit distance with swaps of neighbours, over short words.
#include "core/text/suggestion.h"

#include <algorithm>
#include <vector>

namespace ovc {

/// Counts the insertions, deletions, replacements and swaps of two neighbours from a to b.
static size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> before_last, last(b.size() + 1), row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j)
        last[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before_last[j - 2] + 1);
        }
        before_last = last;
        std::swap(last, row);
    }
    return last[b.size()];
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates) {
    std::string_view best;
    // A third of the letters may be wrong; beyond that it is another word.
    size_t smallest = std::max<size_t>(1, word.size() / 3) + 1;
    for (const std::string_view candidate : candidates)
        if (const size_t distance = edit_distance(word, candidate); distance < smallest) {
            smallest = distance;
            best = candidate;
        }
    return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
    const std::string_view meant = nearest(word, candidates);
    return meant.empty() ? "" : "; did you mean '" + std::string(meant) + "'?";
}

/// A limit, so that no slow disk with a million files is read for a hint.
static constexpr size_t kMaxFiles = 10000;

static std::string in_small_letters(std::string word) {
    for (char& c : word)
        c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    return word;
}

std::string did_you_mean_file(const std::filesystem::path& missing) {
    namespace fs = std::filesystem;
    const std::string word = in_small_letters(missing.filename().string());
    const fs::path folder = missing.has_parent_path() ? missing.parent_path() : fs::path(".");
    std::vector<std::pair<std::string, std::string>> names; // each in small letters, and as it is
    std::error_code ec;
    for (fs::directory_iterator at(folder, ec), end; !ec && at != end && names.size() < kMaxFiles;
         at.increment(ec)) {
        std::error_code unknown;
        if (!at->is_directory(unknown)) {
            std::string name = at->path().filename().string();
            names.emplace_back(in_small_letters(name), name);
        }
    }
    std::sort(names.begin(), names.end()); // folders have no order
    std::vector<std::string_view> candidates;
    for (const auto& [small, name] : names)
        candidates.push_back(small);
    const std::string_view meant = word.empty() ? "" : nearest(word, candidates);
    for (const auto& [small, name] : names)
        if (!meant.empty() && small == meant && name != missing.filename())
            return "; did you mean '" + name + "'?";
    return "";
}

} // namespace ovc
