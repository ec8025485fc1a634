#include "text/harmless.hpp"

#include <utf8proc.h>
#include <algorithm>
#include <array>

#include "text/characters.hpp"

namespace dinal::text {

namespace {

/// Returns the length of an escape sequence for colour, bold, underlined or reset at the front of the text, otherwise
/// 0.
std::size_t colour_at(std::string_view text) {
    if (!text.starts_with("\x1b[")) {
        return 0;
    }
    const std::size_t end = text.find_first_not_of("0123456789;", 2);
    if (end == std::string_view::npos || text[end] != 'm') {
        return 0;
    }
    // styles that neither blink nor hide text
    constexpr std::array<std::string_view, 5> styles = {"", "0", "1", "4", "7"};
    for (std::string_view numbers = text.substr(2, end - 2);;) {
        const std::size_t size = std::min(numbers.find(';'), numbers.size());
        const std::string_view one = numbers.substr(0, size);
        const bool colour = one.size() == 2 && (one.front() == '3' || one.front() == '9');
        if (!colour && std::ranges::find(styles, one) == styles.end()) {
            return 0;
        }
        if (size == numbers.size()) {
            return end + 1;
        }
        numbers.remove_prefix(size + 1);
    }
}

/// The length in bytes of the first character, or 1 if it is not UTF-8.
std::size_t first_bytes(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text.front());
    const std::size_t bytes = lead < 0xC0 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
    const auto goes_on = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
    std::size_t found = 1;
    while (found < std::min(bytes, text.size()) && goes_on(text[found])) {
        ++found;
    }
    return found;
}

}  // namespace

std::string harmless(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        std::size_t bytes = colour_at(text);
        if (bytes == 0 && (text.front() == '\n' || text.front() == '\t')) {
            bytes = 1;
        }
        if (bytes > 0) {
            result += text.substr(0, bytes);
        } else {
            bytes = first_bytes(text);
            result += displayable(text.substr(0, bytes));
        }
        text.remove_prefix(bytes);
    }
    return result;
}

namespace {

constexpr std::string_view no_letter = "\xEF\xBF\xBD";  // U+FFFD

struct Letter {
    std::size_t bytes = 0;  ///< 0 if it is not UTF-8
    bool shown = false;     ///< whether it is neither a control character nor a direction mark
};

/// The first letter of the text.
Letter letter_at(std::string_view text) {
    utf8proc_int32_t code = 0;
    const auto* const bytes = reinterpret_cast<const utf8proc_uint8_t*>(text.data());  // NOLINT: bytes are unsigned
    const auto size = utf8proc_iterate(bytes, static_cast<utf8proc_ssize_t>(text.size()), &code);
    if (size <= 0) return {};
    const bool turns = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
    return {static_cast<std::size_t>(size), code >= 0xA0 && !turns};
}

}  // namespace

std::string html(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        if (static_cast<unsigned char>(c) >= 0x80) {
            const Letter letter = letter_at(text.substr(at));
            result += letter.shown ? text.substr(at, letter.bytes) : no_letter;
            at += std::max<std::size_t>(letter.bytes, 1) - 1;
            continue;
        }
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            case '\'':
                result += "&#39;";
                break;
            default:
                if ((static_cast<unsigned char>(c) < 0x20 || c == '\x7F') && c != '\t' && c != '\n') {
                    result += no_letter;
                } else {
                    result += c;
                }
        }
    }
    return result;
}

std::string markdown(std::string_view text, std::string_view marks) {
    std::string result;
    for (const char& c : text) {
        if (marks.find(c) != std::string_view::npos) result += '\\';
        result += c == '&' || c == '<' || c == '>' ? html({&c, 1}) : std::string(1, c);
    }
    return result;
}

}  // namespace dinal::text
