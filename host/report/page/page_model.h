// SPDX-License-Identifier: Apache-2.0
// The content of the report's page before it is HTML or Markdown: sections of text, tables and
// plots. Each number remembers its place in the JSON file of its section.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace ovc {

/// Keys stay in the order they are written in.
using Json = nlohmann::ordered_json;

/// A number of the page.
struct Number {
    std::string pointer; // RFC 6901, into the figures of its section
    Json value;          // at the pointer; null is shown as "-"
    std::string shown;
};

using Piece = std::variant<std::string, Number>;
using Text = std::vector<Piece>;

struct Table {
    std::string caption;
    std::vector<std::string> header;
    std::vector<std::vector<Text>> rows; // each as long as the header; the first cell is a name
    size_t marked = SIZE_MAX;            // index of a row to highlight
};

/// A picture that gnuplot draws. `script` reads `data`, which lies beside it as NAME.dat.
struct Plot {
    std::string name; // of its files; one word
    std::string caption;
    std::string data;
    std::string script;
    int height = 440; // in 640ths of its width
};

/// Returns the height of a plot with so many lines of text at its left.
int height_of_bars(size_t lines);

/// A .png file that a run has drawn.
struct PagePicture {
    std::string file; // within the report's folder
    std::string caption;
};

using Block = std::variant<Text, Table, Plot, PagePicture>;

struct Section {
    std::string name; // of its experiment
    std::string title;
    Json figures; // has every number of the blocks
    std::vector<Block> blocks;
};

/// Returns a whole number below 1e15 with all digits, any other number from 100 to 1e6 rounded to a
/// whole one, and the rest with three digits: "0", "12,345", "3.1e-07", "0.125".
std::string shown_number(double value);

/// Returns bytes in millions; null stays null.
Json megabytes(const Json& bytes);

/// Returns a number for the page; there is no other way to make one. The figures have a number or
/// null at the pointer (asserted).
Piece number(const Json& figures, const std::string& pointer);

} // namespace ovc
