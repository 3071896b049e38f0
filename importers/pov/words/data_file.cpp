// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/words/data_file.h"

#include "importers/pov/values/value.h"

#include <fmt/format.h>

#include <cassert>
#include <charconv>

namespace ovc::pov {

void DataFile::skip_space() {
    while (at_ < text.size() && uint8_t(text[at_]) <= ' ')
        ++at_;
}

std::optional<double> DataFile::read_float() {
    skip_space();
    at_ += at_ < text.size() && text[at_] == '+';
    double value = 0;
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(text.data() + at_, end, value);
    if (read.ec != std::errc())
        return std::nullopt;
    at_ = size_t(read.ptr - text.data());
    skip_space();
    return value;
}

std::optional<Value> DataFile::read() {
    assert(at_ <= text.size() && !writes);
    skip_space();
    std::optional<Value> value;
    if (ended())
        return value;
    if (text[at_] == '"') {
        const size_t end = text.find('"', at_ + 1);
        if (end == text.npos)
            return value;
        value = text.substr(at_ + 1, end - at_ - 1);
        at_ = end + 1;
    } else if (text[at_] == '<') {
        Number number;
        number.size = 0;
        do {
            ++at_;
            const std::optional<double> part = read_float();
            if (!part || number.size == 5 || ended())
                return value;
            number.v[size_t(number.size++)] = *part;
        } while (text[at_] == ',');
        if (text[at_++] != '>' || number.size < 2)
            return value;
        value = number;
    } else if (const std::optional<double> number = read_float())
        value = Number::of(*number);
    skip_space();
    if (!ended() && text[at_] == ',') {
        ++at_;
        skip_space();
    }
    return value;
}

bool DataFile::write(const Value& value) {
    if (const auto* words = std::get_if<std::string>(&value))
        text += *words;
    else if (const auto* number = std::get_if<Number>(&value)) {
        text += number->size > 1 ? "<" : "";
        for (int i = 0; i < number->size; ++i)
            text += fmt::format("{}{}", i > 0 ? "," : "", number->v[size_t(i)]);
        text += number->size > 1 ? ">" : "";
    } else
        return false;
    return true;
}

} // namespace ovc::pov
