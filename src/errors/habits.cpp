#include "errors/habits.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "lua/tokens.hpp"

namespace dinal::errors {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 20> foreign_names = {{
    {"echo", "; did you mean 'print'?"},
    {"disp", "; did you mean 'print'?"},
    {"puts", "; did you mean 'print'?"},
    {"println", "; did you mean 'print'?"},
    {"True", "; did you mean 'true'?"},
    {"False", "; did you mean 'false'?"},
    {"None", "; did you mean 'nil'?"},
    {"null", "; did you mean 'nil'?"},
    {"NULL", "; did you mean 'nil'?"},
    {"range", "; a loop is: for i = 1, 10 do ... end"},
    {"len", "; the length of x is #x"},
    {"length", "; the length of x is #x"},
    {"str", "; did you mean 'tostring'?"},
    {"int", "; did you mean 'math.floor'?"},
    {"float", "; did you mean 'tonumber'?"},
    {"ln", "; did you mean 'math.log'?"},
    {"log10", "; did you mean 'math.log'?"},
    {"exit", "; os.exit() ends a script, :quit or Ctrl-D a session"},
    {"quit", "; os.exit() ends a script, :quit or Ctrl-D a session"},
    {"bye", "; os.exit() ends a script, :quit or Ctrl-D a session"},
}};

constexpr std::array<std::string_view, 8> file_endings = {"csv", "dat", "txt", "svg", "png", "pdf", "gp", "lua"};

/// "k = 0,5" in braces is two entries of a table.
std::string decimal_comma(std::string_view words, const std::vector<lua::Token>& all) {
    if (words.find("named options only") == std::string_view::npos) {
        return "";
    }
    for (std::size_t i = 3; i < all.size(); ++i) {
        if (all[i].kind == lua::TokenKind::number && all[i - 1].is(",") && all[i - 2].kind == lua::TokenKind::number &&
            all[i - 3].is("=")) {
            return "; a decimal point is a point: " + std::string(all[i - 2].text) + "." + std::string(all[i].text);
        }
    }
    return "";
}

/// run:save(run.csv)
std::string file_without_quotes(std::string_view words, const std::vector<lua::Token>& all) {
    for (std::size_t i = 2; i < all.size(); ++i) {
        const bool ending = std::find(file_endings.begin(), file_endings.end(), all[i].text) != file_endings.end();
        const std::string key = "'" + std::string(all[i].text) + "'";
        const std::string owner = "'" + std::string(all[i - 2].text) + "'";
        if (ending && all[i - 1].is(".") && all[i - 2].kind == lua::TokenKind::name &&
            (words.find(key) != std::string_view::npos || words.find(owner) != std::string_view::npos)) {
            return "; the name of a file stands in quotes: \"" + std::string(all[i - 2].text) + "." +
                   std::string(all[i].text) + "\"";
        }
    }
    return "";
}

/// A number, a string, a list that is called.
std::string called_value(std::string_view words) {
    constexpr std::string_view head = "attempt to call a ";
    if (!words.starts_with(head)) {
        return "";
    }
    const std::string_view type = words.substr(head.size(), words.find(" value") - head.size());
    if (words.find("for iterator") != std::string_view::npos) {
        return type == "number" ? "; counting is: for i = 1, 10 do"
                                : "; going through a list is: for i, x in ipairs(list) do";
    }
    if (type == "vector" || type == "table") {
        return "; its elements are in brackets: v[1]";
    }
    const bool simple = type == "number" || type == "string" || type == "boolean";
    return simple ? "; it is a value and no function: leave out the parentheses" : "";
}

}  // namespace

std::string running_habit(std::string_view words, std::string_view statement) {
    const std::vector<lua::Token> all = lua::tokens(statement);
    if (words.starts_with("attempt to add a 'string' with a 'string'")) {
        return "; texts are joined with ..";
    }
    for (std::string advice : {decimal_comma(words, all), file_without_quotes(words, all), called_value(words)}) {
        if (!advice.empty()) {
            return advice;
        }
    }
    return "";
}

std::string foreign_name(std::string_view name) {
    const auto* const found =
        std::find_if(foreign_names.begin(), foreign_names.end(), [name](const auto& n) { return n.first == name; });
    return found == foreign_names.end() ? "" : std::string(found->second);
}

}  // namespace dinal::errors
