#include "lua/lua_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace dinal {

namespace {

constexpr std::array<std::string_view, 22> keywords = {
    "and", "break", "do",  "else", "elseif", "end",    "false",  "for",  "function", "goto",  "if",
    "in",  "local", "nil", "not",  "or",     "repeat", "return", "then", "true",     "until", "while"};

bool is_name_char(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Past the long bracket that opens at `open`; `open` itself when none does.
std::size_t past_long_bracket(std::string_view source, std::size_t open) {
    const std::size_t second = std::min(source.find_first_not_of('=', open + 1), source.size());
    if (second >= source.size() || source[open] != '[' || source[second] != '[') {
        return open;
    }
    const std::string close = "]" + std::string(second - open - 1, '=') + "]";
    const std::size_t found = source.find(close, second);
    return found == std::string_view::npos ? source.size() : found + close.size();
}

/// Past a comment or a string that begins at `at`; `at` itself when there is none.
std::size_t past_text(std::string_view source, std::size_t at) {
    if (source.substr(at, 3) == "--[") {
        if (const std::size_t end = past_long_bracket(source, at + 2); end != at + 2) {
            return end;
        }
    }
    if (source.substr(at, 2) == "--") {
        return std::min(source.find('\n', at), source.size());
    }
    if (source[at] == '"' || source[at] == '\'') {
        std::size_t end = at + 1;
        while (end < source.size() && source[end] != source[at]) {
            end += source[end] == '\\' ? 2 : 1;
        }
        return std::min(end + 1, source.size());
    }
    return past_long_bracket(source, at);
}

}  // namespace

bool is_name(std::string_view text) {
    return !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) == 0 &&
           std::all_of(text.begin(), text.end(), is_name_char) &&
           std::find(keywords.begin(), keywords.end(), text) == keywords.end();
}

std::vector<std::string> free_names(std::string_view source) {
    std::vector<std::string> names;
    bool field = false;  // after . or : a name is a field
    for (std::size_t at = 0; at < source.size();) {
        const std::size_t past = past_text(source, at);
        if (past != at) {
            at = past;
        } else if (is_name_char(source[at])) {
            std::size_t end = at;
            while (end < source.size() && is_name_char(source[end])) {
                ++end;
            }
            const std::string_view name = source.substr(at, end - at);
            if (!field && is_name(name) && std::find(names.begin(), names.end(), name) == names.end()) {
                names.emplace_back(name);
            }
            field = false;
            at = end;
        } else {
            if (std::isspace(static_cast<unsigned char>(source[at])) == 0) {
                field = source[at] == ':' || (source[at] == '.' && (at == 0 || source[at - 1] != '.'));
            }
            ++at;
        }
    }
    return names;
}

std::string quoted(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            result += {'\\', c};
        } else if (c == '\n') {
            result += "\\n";
        } else {
            result += std::iscntrl(byte) != 0 ? fmt::format("\\{:03}", static_cast<int>(byte)) : std::string(1, c);
        }
    }
    return result + "\"";
}

std::string number_text(double number) {
    if (std::isnan(number)) {
        return "0/0";
    }
    if (std::isinf(number)) {
        return number > 0 ? "math.huge" : "-math.huge";
    }
    const std::string text = fmt::format("{}", number);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace dinal
