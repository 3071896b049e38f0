// SPDX-License-Identifier: Apache-2.0
// DataFile: a file that #fopen opens, to read or write values one after the other. It is kept in
// memory only: a scene can read again what it writes, but nothing is written to disk.
#pragma once

#include <optional>
#include <string>

namespace ovc::pov {

struct Value;

struct DataFile {
    std::string name;
    std::string text;
    bool writes = false;

    /// Reads the next text, float or vector, and skips spaces and a comma behind it. Returns
    /// nothing where something else, or nothing, comes next.
    std::optional<Value> read();
    bool ended() const { return at_ >= text.size(); }
    /// Appends a text as it is, or a float or vector in the form that read() takes. Returns false
    /// and writes nothing for any other value.
    bool write(const Value& value);
    void skip_space();

private:
    std::optional<double> read_float();

    size_t at_ = 0;
};

} // namespace ovc::pov
