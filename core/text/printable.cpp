// SPDX-License-Identifier: Apache-2.0
// Reads UTF-8, as RFC 3629 defines it, character by character.
#include "core/text/printable.h"

#include <cassert>
#include <cstdint>
#include <cstdio>

namespace ovc {

namespace {

/// A character and the number of its bytes; 0 bytes where the text does not begin with one.
struct Character {
    uint32_t code = 0;
    size_t bytes = 0;
};

Character first_of(std::string_view text) {
    assert(!text.empty());
    const auto byte = [&](size_t i) { return uint32_t(static_cast<unsigned char>(text[i])); };
    const uint32_t lead = byte(0);
    if (lead < 0x80)
        return {lead, 1};
    const size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes)
        return {};
    uint32_t code = lead & (0x7fu >> bytes);
    for (size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xc0) != 0x80)
            return {};
        code = code << 6 | (byte(i) & 0x3f);
    }
    constexpr uint32_t kMin[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
    if (code < kMin[bytes] || code > 0x10ffff || is_surrogate)
        return {};
    return {code, bytes};
}

bool is_between(uint32_t code, uint32_t first, uint32_t last) {
    return code >= first && code <= last;
}

bool prints(uint32_t code) {
    const bool controls = code < 0x20 || is_between(code, 0x7f, 0x9f);
    const bool ends_a_line = is_between(code, 0x2028, 0x2029);
    const bool turns_direction = code == 0x61c || is_between(code, 0x200e, 0x200f) ||
                                 is_between(code, 0x202a, 0x202e) ||
                                 is_between(code, 0x2066, 0x2069);
    return !controls && !ends_a_line && !turns_direction;
}

std::string escaped(uint32_t code) {
    switch (code) {
    case '\n':
        return "\\n";
    case '\r':
        return "\\r";
    case '\t':
        return "\\t";
    }
    char text[8];
    std::snprintf(text, sizeof text, code < 0x80 ? "\\x%02x" : "\\u%04x", unsigned(code));
    return text;
}

std::string escaped_byte(char byte) {
    char text[8];
    std::snprintf(text, sizeof text, "\\x%02x", unsigned(static_cast<unsigned char>(byte)));
    return text;
}

} // namespace

std::string printable(std::string_view text, size_t max_bytes) {
    std::string shown;
    for (size_t i = 0; i < text.size();) {
        const Character c = first_of(text.substr(i));
        const size_t bytes = c.bytes > 0 ? c.bytes : 1;
        if (i + bytes > max_bytes)
            return shown + "…";
        if (c.bytes == 0)
            shown += escaped_byte(text[i]);
        else if (prints(c.code))
            shown += text.substr(i, bytes);
        else
            shown += escaped(c.code);
        i += bytes;
    }
    return shown;
}

std::string printable(std::string_view text) {
    return printable(text, text.size());
}

} // namespace ovc
