#include "terminal/quoted.hpp"

#include <fmt/core.h>

#include "terminal/display.hpp"

namespace dinal::terminal {
namespace {

std::string escaped(char c) {
    switch (c) {
        case '\n':
            return "\\n";
        case '\t':
            return "\\t";
        case '\r':
            return "\\r";
        default:
            return fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
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

}  // namespace dinal::terminal
