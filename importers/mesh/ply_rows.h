// SPDX-License-Identifier: Apache-2.0
// AsciiRows and BinaryRows read the rows of a PLY file's elements, value by value, by the same
// functions.
#pragma once

#include "importers/file/text.h"
#include "importers/mesh/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <concepts>
#include <cstring>
#include <limits>

namespace ovc {

/// Counts the rows of an element that have been read.
struct RowCount {
    const PlyElement* element = nullptr;
    uint64_t done = 0;

    void begin(const PlyElement& next) {
        if (element != &next)
            done = 0;
        element = &next;
    }

    std::string end_of_file() const {
        assert(element);
        return fmt::format("the file ends early: found {} of {} of {}", done,
                           counted(element->count, "row"), element->name);
    }
};

/// Every call except error(), surplus() and left_over() returns false at an error, which error()
/// then holds. An element's row is one line; blank lines between rows do not count.
class AsciiRows {
public:
    explicit AsciiRows(Source& source) : source_(source) {}

    bool begin_row(const PlyElement& element) {
        rows_.begin(element);
        do {
            const auto line = source_.line();
            if (!line) {
                error_ = source_.error_at_line(rows_.end_of_file());
                return false;
            }
            rest_ = *line;
            skip_blanks(rest_);
        } while (rest_.empty());
        return true;
    }

    /// Passes over numbers that the header does not tell of (VCGLIB writes some).
    bool end_row() {
        assert(rows_.done < rows_.element->count);
        skip_blanks(rest_);
        ++rows_.done;
        return rest_.empty() || pass_over_numbers();
    }

    /// T is float or double. The file may write integer types with a point, too.
    template <class T>
    bool scalar(const PlyProperty& property, T& value) {
        const std::string_view word = next_word(rest_);
        std::optional<T> parsed;
        if constexpr (std::same_as<T, float>)
            parsed = parse_float(word);
        else
            parsed = parse_double(word);
        if (!parsed)
            return fail_word(word, fmt::format("a number for {}", property.name));
        value = *parsed;
        return true;
    }

    bool skip_scalar(const PlyProperty& property) {
        const std::string_view word = next_word(rest_);
        return !word.empty() || fail_word(word, fmt::format("a value for {}", property.name));
    }

    /// Reads integers only.
    bool list(const PlyProperty& property, std::vector<int64_t>& values) {
        uint64_t left = 0;
        values.clear();
        if (!integer("the length of", property, left))
            return false;
        for (int64_t value = 0; left > 0; --left) {
            if (!integer("a whole number for", property, value))
                return false;
            values.push_back(value);
        }
        return true;
    }

    bool skip_list(const PlyProperty& property) {
        uint64_t left = 0;
        if (!integer("the length of", property, left))
            return false;
        for (; left > 0; --left)
            if (!skip_scalar(property))
                return false;
        return true;
    }

    bool fail(std::string_view found, std::string_view expected) {
        error_ = source_.error_at_line(fmt::format("found {}, expected {}", found, expected));
        return false;
    }

    const Error& error() const { return error_; }

    /// Returns a warning if rows have more numbers than the header says.
    std::optional<Error> surplus() const {
        if (surplus_rows_ == 0)
            return std::nullopt;
        return source_.error_at_line(
            first_surplus_, fmt::format("numbers that the header does not tell of left out, in {}",
                                        counted(surplus_rows_, "row")));
    }

    /// Returns a warning if more than blank lines follow the last row.
    std::optional<Error> left_over() {
        uint64_t first = 0, count = 0;
        while (const auto line = source_.line())
            if (!trimmed(*line).empty() && count++ == 0)
                first = source_.line_number();
        if (count == 0)
            return std::nullopt;
        return source_.error_at_line(
            first, fmt::format("{} after the last row left out", counted(count, "line")));
    }

private:
    bool pass_over_numbers() {
        for (std::string_view word = next_word(rest_); !word.empty(); word = next_word(rest_))
            if (!parse_double(word))
                return fail(quoted(word), "the end of the line");
        if (surplus_rows_++ == 0)
            first_surplus_ = source_.line_number();
        return true;
    }

    template <class T>
    bool integer(std::string_view what, const PlyProperty& property, T& value) {
        if (uint32_t digits = 0; take_digits(rest_, digits)) {
            value = digits;
            return true;
        }
        const std::string_view word = next_word(rest_);
        const auto parsed = parse_number<T>(word);
        if (!parsed)
            return fail_word(word, fmt::format("{} {}", what, property.name));
        value = *parsed;
        return true;
    }

    bool fail_word(std::string_view word, std::string_view expected) {
        return fail(found(word), expected);
    }

    Source& source_;
    RowCount rows_;
    std::string_view rest_; // of the row
    uint64_t surplus_rows_ = 0, first_surplus_ = 0;
    Error error_;
};

template <std::endian kOrder>
class BinaryRows {
public:
    explicit BinaryRows(Source& source) : source_(source) {}

    bool begin_row(const PlyElement& element) {
        rows_.begin(element);
        row_ = source_.offset();
        return true;
    }

    bool end_row() {
        assert(rows_.done < rows_.element->count);
        ++rows_.done;
        return true;
    }

    template <class T>
    bool scalar(const PlyProperty& property, T& value) {
        return take(property.type, &value, 1);
    }

    bool skip_scalar(const PlyProperty& property) { return skip(size_of(property.type)); }

    bool list(const PlyProperty& property, std::vector<int64_t>& values) {
        uint64_t left = 0;
        values.clear();
        if (!count(property, left))
            return false;
        // The values grow part by part, because the length may claim more than the file holds.
        while (left > 0) {
            const auto part = size_t(std::min<uint64_t>(left, 4096));
            const size_t first = values.size();
            values.resize(first + part);
            if (!take(property.type, values.data() + first, part))
                return false;
            left -= part;
        }
        return true;
    }

    bool skip_list(const PlyProperty& property) {
        uint64_t length = 0;
        return count(property, length) && skip(length * size_of(property.type));
    }

    bool fail(std::string_view found, std::string_view expected) {
        error_ = source_.error_at_byte(row_, fmt::format("found {}, expected {}", found, expected));
        return false;
    }

    const Error& error() const { return error_; }

    /// Returns nothing: the header fixes the size of a binary row.
    std::optional<Error> surplus() const { return std::nullopt; }

    /// Returns a warning if bytes follow the last row.
    std::optional<Error> left_over() {
        const uint64_t first = source_.offset();
        const uint64_t count = source_.skip_rest();
        if (count == 0)
            return std::nullopt;
        return source_.error_at_byte(
            first, fmt::format("{} after the last row left out", counted(count, "byte")));
    }

private:
    bool count(const PlyProperty& property, uint64_t& value) {
        int64_t length = 0;
        if (!take(property.count_type, &length, 1))
            return false;
        value = uint64_t(length);
        return length >= 0 ||
               fail(fmt::format("{} of length {}", property.name, length), "a length of 0 or more");
    }

    template <class Stored, class T>
    bool take_as(T* values, size_t count) {
        const unsigned char* at = source_.bytes(count * sizeof(Stored));
        if (!at)
            return fail_end();
        for (size_t k = 0; k < count; ++k, at += sizeof(Stored)) {
            unsigned char raw[sizeof(Stored)];
            for (size_t i = 0; i < sizeof(Stored); ++i)
                raw[i] = at[kOrder == std::endian::native ? i : sizeof(Stored) - 1 - i];
            values[k] = T(std::bit_cast<Stored>(raw));
        }
        return true;
    }

    template <class T>
    bool take(PlyType type, T* values, size_t count) {
        switch (type) {
        case PlyType::Int8:
            return take_as<int8_t>(values, count);
        case PlyType::UInt8:
            return take_as<uint8_t>(values, count);
        case PlyType::Int16:
            return take_as<int16_t>(values, count);
        case PlyType::UInt16:
            return take_as<uint16_t>(values, count);
        case PlyType::Int32:
            return take_as<int32_t>(values, count);
        case PlyType::UInt32:
            return take_as<uint32_t>(values, count);
        case PlyType::Float32:
            return take_as<float>(values, count);
        case PlyType::Float64:
            return take_as<double>(values, count);
        }
        return false;
    }

    bool skip(uint64_t bytes) { return source_.skip(bytes) || fail_end(); }

    bool fail_end() {
        error_ = source_.error_at_byte(source_.offset(), rows_.end_of_file());
        return false;
    }

    Source& source_;
    RowCount rows_;
    uint64_t row_ = 0; // the byte at which the row begins
    Error error_;
};

} // namespace ovc
