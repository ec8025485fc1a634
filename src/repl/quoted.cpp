#include "repl/quoted.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace dinal {
namespace {

unsigned byte(char c) {
    return static_cast<unsigned char>(c);
}

bool continues(char c) {
    return (byte(c) & 0xC0U) == 0x80U;
}

/// Bytes of the printable character that begins the text; 0 when it is a control character or not UTF-8.
std::size_t printable_length(std::string_view text) {
    const unsigned first = byte(text[0]);
    if (first < 0x80U) {
        return first >= 0x20U && first != 0x7FU ? 1 : 0;
    }
    const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
    if (first < 0xC2U || first > 0xF4U || text.size() < length) {
        return 0;
    }
    if (!std::all_of(text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(length), continues)) {
        return 0;
    }
    const unsigned second = byte(text[1]);
    const bool overlong = (first == 0xE0U && second < 0xA0U) || (first == 0xF0U && second < 0x90U);
    const bool outside = (first == 0xEDU && second > 0x9FU) || (first == 0xF4U && second > 0x8FU);
    const bool control = first == 0xC2U && second < 0xA0U;
    return overlong || outside || control ? 0 : length;
}

std::string escaped(char c) {
    switch (c) {
        case '\n':
            return "\\n";
        case '\t':
            return "\\t";
        case '\r':
            return "\\r";
        default:
            return fmt::format("\\x{:02X}", byte(c));
    }
}

}  // namespace

std::string quoted(std::string_view text, std::size_t limit, bool unicode) {
    std::string result = "\"";
    std::size_t i = 0;
    while (i < text.size() && i < limit) {
        const std::size_t length = printable_length(text.substr(i));
        if (length == 0 || (length > 1 && !unicode)) {
            result += escaped(text[i++]);
            continue;
        }
        if (text[i] == '"' || text[i] == '\\') {
            result += '\\';
        }
        result += text.substr(i, length);
        i += length;
    }
    return result + (i < text.size() ? "\"..." : "\"");
}

}  // namespace dinal
