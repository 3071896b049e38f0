// SPDX-License-Identifier: Apache-2.0
#include "host/arguments/pov_ini.h"

#include "core/text/lower_case.h"
#include "importers/file/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cctype>

namespace ovc {

static std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t\r");
    if (first == text.npos)
        return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

static std::string unquoted(std::string_view text) {
    if (text.size() >= 2 && (text[0] == '"' || text[0] == '\'') && text.back() == text[0])
        text = text.substr(1, text.size() - 2);
    return std::string(text);
}

/// Returns the line up to the first semicolon that is not quoted.
static std::string_view without_comment(std::string_view line) {
    char quote = 0;
    for (size_t i = 0; i < line.size(); ++i) {
        if (!quote && line[i] == ';')
            return line.substr(0, i);
        if (line[i] == '"' || line[i] == '\'')
            quote = !quote ? line[i] : quote == line[i] ? '\0' : quote;
    }
    return line;
}

bool names_ini(std::string_view word) {
    const std::string small = lower_case(word.substr(0, word.find('[')));
    return small.size() > 4 && small.ends_with(".ini") &&
           (word.find('[') == word.npos || word.back() == ']');
}

std::optional<IniItem> as_setting(std::string_view word) {
    const size_t equals = word.find('=');
    if (equals == word.npos)
        return std::nullopt;
    const std::string_view key = trimmed(word.substr(0, equals));
    const bool is_name = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
        return std::isalnum(c) || c == '_';
    });
    if (!is_name)
        return std::nullopt;
    return IniItem{lower_case(key), unquoted(trimmed(word.substr(equals + 1))), {}};
}

/// Splits the line at blanks that are not quoted, and drops the quotes.
static std::vector<std::string> words_of(std::string_view line) {
    std::vector<std::string> words;
    bool in_word = false;
    char quote = 0;
    for (const char c : line) {
        if (quote == 0 && (c == ' ' || c == '\t')) {
            in_word = false;
            continue;
        }
        if (!in_word)
            words.emplace_back();
        in_word = true;
        if (quote == 0 && (c == '"' || c == '\''))
            quote = c;
        else if (c == quote)
            quote = 0;
        else
            words.back() += c;
    }
    return words;
}

Result<std::vector<IniItem>> read_ini(const std::string& word) {
    assert(names_ini(word));
    const size_t bracket = std::min(word.find('['), word.size());
    const std::string path = word.substr(0, bracket);
    const std::string wanted = bracket < word.size()
                                   ? lower_case(word.substr(bracket + 1, word.size() - bracket - 2))
                                   : "";
    Result<Source> file = Source::open(path, nullptr, Source::Empty::Fine);
    if (!file)
        return file.error();
    std::vector<IniItem> items;
    bool counts = true;
    while (const std::optional<std::string_view> line = file->line()) {
        const std::string_view text = trimmed(without_comment(*line));
        if (text.starts_with('[') && text.ends_with(']')) {
            counts = lower_case(trimmed(text.substr(1, text.size() - 2))) == wanted;
            continue;
        }
        if (!counts || text.empty())
            continue;
        const std::string place = fmt::format("{}:{}: ", path, file->line_number());
        if (const std::optional<IniItem> setting = as_setting(text))
            items.push_back({setting->key, setting->value, place});
        else
            for (const std::string& each : words_of(text))
                items.push_back({"", each, place});
    }
    if (file->is_damaged())
        return file->error("");
    return items;
}

} // namespace ovc
