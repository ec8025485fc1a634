#include "text/characters.hpp"

#include <fmt/format.h>
#include <utf8proc.h>

#include <algorithm>
#include <array>
#include <utility>

#include "text/words.hpp"

namespace dinal::text {

namespace {

enum class CharacterKind { letter, blank, control, none };

struct Character {
    utf8proc_int32_t code = 0xFFFD;
    std::size_t bytes = 1;
    CharacterKind kind = CharacterKind::none;  // none: a byte that is not UTF-8
    std::size_t columns = 1;
};

CharacterKind kind_of(utf8proc_int32_t code) {
    if (code == '\t' || code == '\n' || code == '\r') {
        return CharacterKind::blank;
    }
    switch (utf8proc_category(code)) {
        case UTF8PROC_CATEGORY_CC:
            return CharacterKind::control;
        case UTF8PROC_CATEGORY_CF:
        case UTF8PROC_CATEGORY_ZL:
        case UTF8PROC_CATEGORY_ZP:
            return CharacterKind::blank;
        default:
            return (code & 0xFFFE) == 0xFFFE ? CharacterKind::control
                                             : CharacterKind::letter;  // noncharacters, which XML forbids
    }
}

/// The first character of a non-empty text.
Character first_of(std::string_view text) {
    Character first;
    const auto* const bytes = reinterpret_cast<const utf8proc_uint8_t*>(text.data());  // NOLINT: bytes are unsigned
    const auto size = utf8proc_iterate(bytes, static_cast<utf8proc_ssize_t>(text.size()), &first.code);
    if (size <= 0) {
        return {};
    }
    first.bytes = static_cast<std::size_t>(size);
    first.kind = kind_of(first.code);
    // Not wcwidth(), which in the locale "C" knows only ASCII.
    first.columns = first.kind == CharacterKind::letter ? static_cast<std::size_t>(utf8proc_charwidth(first.code)) : 1;
    return first;
}

/// Removes the first character of a non-empty text and returns it.
Character taken_from(std::string_view& text) {
    const Character first = first_of(text);
    text.remove_prefix(first.bytes);
    return first;
}

constexpr std::array<std::pair<char32_t, std::string_view>, 37> spelled{
    {{U'α', "alpha"}, {U'β', "beta"},  {U'γ', "gamma"}, {U'δ', "delta"},  {U'ε', "epsilon"}, {U'ζ', "zeta"},
     {U'η', "eta"},   {U'θ', "theta"}, {U'κ', "kappa"}, {U'λ', "lambda"}, {U'μ', "mu"},      {U'ν', "nu"},
     {U'π', "pi"},    {U'ρ', "rho"},   {U'σ', "sigma"}, {U'τ', "tau"},    {U'φ', "phi"},     {U'χ', "chi"},
     {U'ψ', "psi"},   {U'ω', "omega"}, {U'Δ', "Delta"}, {U'Θ', "Theta"},  {U'Σ', "Sigma"},   {U'Φ', "Phi"},
     {U'Ψ', "Psi"},   {U'Ω', "Omega"}, {U'₀', "0"},     {U'₁', "1"},      {U'²', "^2"},      {U'°', " deg"},
     {U'·', "."},     {U'−', "-"},     {U'…', "..."},   {U'′', "'"},      {U'│', "|"},       {U'─', "-"},
     {U'→', "->"}}};

/// Returns whether a formula must not be broken beside this word: a relation, an operator or the factor k.
bool binds(std::string_view word) {
    return word == "=" || word == "<=" || word == ">" || word == "-" || word == "+" || word == "k";
}

/// The length in bytes of the first word, including the words that a formula binds to it while they fit.
std::size_t unbroken(std::string_view line, std::size_t width) {
    std::size_t end = std::min(line.find(' '), line.size());
    std::string_view word = line.substr(0, end);
    while (end < line.size()) {
        const std::size_t next = std::min(line.find(' ', end + 1), line.size());
        const std::string_view after = line.substr(end + 1, next - end - 1);
        if ((!binds(word) && !binds(after) && after != "%") || columns(line.substr(0, next)) > width) {
            break;
        }
        word = after;
        end = next;
    }
    return end;
}

std::string line_in_rows(std::string_view line, std::size_t width) {
    std::string rows;
    std::size_t column = 0;
    while (!line.empty()) {
        const std::string_view word = line.substr(0, unbroken(line, width));
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

std::size_t columns(std::string_view text) {
    std::size_t count = 0;
    while (!text.empty()) {
        count += taken_from(text).columns;
    }
    return count;
}

std::string_view cut_to_columns(std::string_view text, std::size_t width) {
    std::string_view rest = text;
    while (!rest.empty()) {
        const Character next = first_of(rest);
        if (next.columns > width) {
            break;
        }
        width -= next.columns;
        rest.remove_prefix(next.bytes);
    }
    return text.substr(0, text.size() - rest.size());
}

bool is_printable(std::string_view text) {
    while (!text.empty()) {
        const Character next = taken_from(text);
        if (next.kind != CharacterKind::letter && next.code != '\n') {
            return false;
        }
    }
    return true;
}

std::string displayable(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const Character next = first_of(text);
        result += next.kind == CharacterKind::letter    ? text.substr(0, next.bytes)
                  : next.kind == CharacterKind::blank   ? " "
                  : next.kind == CharacterKind::control ? "?"
                                                        : "\xEF\xBF\xBD";
        text.remove_prefix(next.bytes);
    }
    return result;
}

std::string in_ascii(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const Character next = taken_from(text);
        if (next.code < 0x80) {
            result += static_cast<char>(next.code);
        } else if (next.columns > 0) {
            const auto* const found = std::ranges::find_if(
                spelled, [&next](const auto& pair) { return pair.first == static_cast<char32_t>(next.code); });
            result += found != spelled.end() ? found->second : "?";
        }
    }
    return result;
}

std::string quoted(std::string_view text, std::size_t limit, bool unicode) {
    std::string result = "\"";
    std::size_t at = 0;
    while (at < text.size() && at < limit) {
        const Character next = first_of(text.substr(at));
        const bool shown = next.kind == CharacterKind::letter && (next.bytes == 1 || unicode);
        if (text[at] == '"' || text[at] == '\\') {
            result += '\\';
        }
        for (const char c : text.substr(at, next.bytes)) {
            result += shown ? std::string(1, c) : escaped(c);
        }
        at += next.bytes;
    }
    return result + (at < text.size() ? "\"..." : "\"");
}

std::string wrapped(std::string_view text, std::size_t width) {
    std::vector<std::string> lines;
    for (const std::string_view line : split(text, '\n')) {
        const bool laid_out = line.starts_with(' ') || columns(line) <= width;
        lines.push_back(laid_out ? std::string(line) : line_in_rows(line, width));
    }
    return fmt::format("{}", fmt::join(lines, "\n"));
}

std::string indented(std::string text, std::size_t blanks) {
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
        text.insert(at + 1, blanks, ' ');
    }
    return text;
}

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
        if (!colour && !contains(styles, one)) {
            return 0;
        }
        if (size == numbers.size()) {
            return end + 1;
        }
        numbers.remove_prefix(size + 1);
    }
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
            bytes = first_of(text).bytes;
            result += displayable(text.substr(0, bytes));
        }
        text.remove_prefix(bytes);
    }
    return result;
}

std::string html(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const Character next = taken_from(text);
        switch (next.code) {
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
                if (next.code == '\t' || next.code == '\n' || next.kind == CharacterKind::letter) {
                    result.append(text.data() - next.bytes, next.bytes);
                } else {
                    result += next.kind == CharacterKind::blank ? " " : "\xEF\xBF\xBD";  // U+FFFD
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
