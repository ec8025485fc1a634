#include "text/html.hpp"

#include <utf8proc.h>

#include <algorithm>

namespace dinal::text {
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
