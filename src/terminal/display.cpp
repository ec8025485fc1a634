#include "terminal/display.hpp"

#include <langinfo.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <cwchar>
#include <utility>

namespace dinal::terminal {
namespace {

constexpr std::size_t narrowest = 20;  // text laid out for less is unreadable anyway

const char* variable(const char* name) {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): one thread
    return value == nullptr ? "" : value;
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 8> spellings = {
    {{"…", "..."}, {"θ", "theta"}, {"ω", "omega"}, {"ζ", "zeta"}, {"│", "|"}, {"─", "-"}, {"→", "->"}, {"·", "."}}};

/// Bytes of the UTF-8 character that begins the text, and its code; one byte for what is none.
std::pair<std::size_t, wchar_t> first_character(std::string_view text) {
    const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::size_t length = byte(0) < 0xC0U ? 1 : byte(0) < 0xE0U ? 2 : byte(0) < 0xF0U ? 3 : 4;
    if (length == 1 || text.size() < length) {
        return {1, static_cast<wchar_t>(byte(0))};
    }
    unsigned code = byte(0) & (0xFFU >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0U) != 0x80U) {
            return {1, static_cast<wchar_t>(byte(0))};
        }
        code = code << 6U | (byte(i) & 0x3FU);
    }
    return {length, static_cast<wchar_t>(code)};
}

unsigned byte(char c) {
    return static_cast<unsigned char>(c);
}

bool continues(char c) {
    return (byte(c) & 0xC0U) == 0x80U;
}

}  // namespace

bool obeys_escapes() {
    const std::string_view name = variable("TERM");
    return !name.empty() && name != "dumb";
}

Display display_of(int descriptor) {
    Display screen;
    screen.unicode = std::strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
    screen.terminal = isatty(descriptor) != 0;
    if (!screen.terminal) {
        return screen;
    }
    screen.colour = obeys_escapes() && *variable("NO_COLOR") == '\0';  // as https://no-color.org says
    winsize size{};
    if (ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
        screen.width = std::max<std::size_t>(size.ws_col, narrowest);
    }
    return screen;
}

std::string spelled(std::string_view text, const Display& screen) {
    std::string result(text);
    if (!screen.unicode) {
        for (const auto& [letter, words] : spellings) {
            for (std::size_t at = result.find(letter); at != std::string::npos; at = result.find(letter, at)) {
                result.replace(at, letter.size(), words);
                at += words.size();
            }
        }
    }
    return result;
}

std::size_t columns(std::string_view text) {
    std::size_t count = 0;
    while (!text.empty()) {
        const auto [length, code] = first_character(text);
        const bool stray =
            length == 1 && code >= 0x80 && code < 0xC0;  // in the middle of a character: has been counted
        const int width = code < 0x80 ? 1 : wcwidth(code);
        count += stray ? 0 : width < 0 ? 1 : static_cast<std::size_t>(width);
        text.remove_prefix(length);
    }
    return count;
}

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

std::string printable(std::string_view line, const Display& screen) {
    std::string result;
    while (!line.empty()) {
        const std::size_t length = printable_length(line);
        const bool fits = length == 1 || (length > 1 && screen.unicode);
        const bool blank = line.front() == '\t' || line.front() == '\r';
        result += fits ? line.substr(0, length) : blank ? " " : "?";
        line.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return result;
}

namespace {

std::string line_in_rows(std::string_view line, std::size_t width) {
    std::string rows;
    std::size_t column = 0;
    while (!line.empty()) {
        const std::string_view word = line.substr(0, line.find(' '));
        const std::size_t size = columns(word);
        if (column > 0) {
            const bool fits = column + 1 + size <= width;
            rows += fits ? ' ' : '\n';
            column = fits ? column + 1 : 0;
        }
        rows += word;
        column += size;
        line.remove_prefix(std::min(word.size() + 1, line.size()));
    }
    return rows;
}

}  // namespace

std::string wrapped(std::string_view text, std::size_t width) {
    std::string result;
    for (;;) {
        const std::string_view line = text.substr(0, text.find('\n'));
        const bool laid_out = line.starts_with(' ') || columns(line) <= width;
        result += laid_out ? std::string(line) : line_in_rows(line, width);
        if (line.size() == text.size()) {
            return result;
        }
        result += '\n';
        text.remove_prefix(line.size() + 1);
    }
}

}  // namespace dinal::terminal
