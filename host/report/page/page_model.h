// SPDX-License-Identifier: Apache-2.0
// What a page of the report says, before it is HTML or Markdown: sections of text, tables and
// plots. Each number in it remembers where in its JSON it stands.
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
    Json value;          // what stands there; null is shown as "-"
    std::string shown;
};

using Piece = std::variant<std::string, Number>;
using Text = std::vector<Piece>;

struct Table {
    std::string caption;
    std::vector<std::string> header;
    std::vector<std::vector<Text>> rows; // each as long as the header; the first cell is a name
    size_t marked = SIZE_MAX;            // a row to bring out
};

/// A picture that gnuplot draws: `script` reads `data`, which lies beside it as NAME.dat.
struct Plot {
    std::string name; // of its files; one word
    std::string caption;
    std::string data;
    std::string script;
    int height = 440; // in 640ths of its width
};

/// Of a plot with so many lines of text at its left.
int height_of_bars(size_t lines);

/// A .png file that is there already.
struct PagePicture {
    std::string file; // within the report's folder
    std::string caption;
};

using Block = std::variant<Text, Table, Plot, PagePicture>;

struct Section {
    std::string name; // of its experiment
    std::string title;
    Json figures; // every number of its blocks is here
    std::vector<Block> blocks;
};

/// Three digits of a fraction, all of a whole number below 1e5: "0", "12,345", "3.1e-07", "0.125".
std::string shown_number(double value);

/// Bytes as millions of them; null stays null.
Json megabytes(const Json& bytes);

/// The one way for a number onto the page. Asserts that the figures have a number or null there.
Piece number(const Json& figures, const std::string& pointer);

} // namespace ovc
