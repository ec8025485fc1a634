#include "lua/habits.hpp"

#include <array>
#include <utility>
#include <vector>

#include "core/suggest.hpp"
#include "lua/tokens.hpp"

namespace dinal {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 10> habits = {{
    {"near '!'", "; in Lua 'not equal' is ~= and 'not' is a word"},
    {"near '+'", "; in Lua that is x = x + 1"},
    {"near '&'", "; in Lua that is the word and"},
    {"near '|'", "; in Lua that is the word or"},
    {"symbol near '['", "; a list is { 1, 2, 3 }"},
    {"'then' expected near '='", "; comparing is =="},
    {"'do' expected near '='", "; comparing is =="},
    {"')' expected near '='", "; named options stand in braces: system{ I = 1, k = 4 }"},
    {"'}' expected near", "; is a comma missing there?"},
    {"expected (to close '{' at line", "; is a comma missing there, or a brace?"},
}};

/// In "M = function(t) retrun math.sin(t) end" the parser stumbles over what stands behind the misspelt word.
std::string misspelt_keyword(std::string_view words, std::string_view statement) {
    const std::size_t near = words.find(" near '");
    if (near == std::string_view::npos) {
        return "";
    }
    const std::string_view stumbled = words.substr(near + 7, words.rfind('\'') - near - 7);
    const std::vector<Token> all = tokens(statement);
    for (std::size_t i = all.size(); i-- > 1;) {
        if (all[i].text == stumbled && all[i - 1].kind == TokenKind::name) {
            return did_you_mean(all[i - 1].text, keywords());
        }
    }
    return "";
}

/// "dt = 0,1" is two entries of a table.
std::string decimal_comma(std::string_view words, std::string_view statement) {
    if (words.find("named options only") == std::string_view::npos) {
        return "";
    }
    const std::vector<Token> all = tokens(statement);
    for (std::size_t i = 2; i < all.size(); ++i) {
        if (all[i].kind == TokenKind::number && all[i - 1].is(",") && all[i - 2].kind == TokenKind::number) {
            return "; a decimal point is a point: " + std::string(all[i - 2].text) + "." + std::string(all[i].text);
        }
    }
    return "";
}

}  // namespace

std::string habit_of_others(std::string_view words, std::string_view statement) {
    if (const std::string comma = decimal_comma(words, statement); !comma.empty()) {
        return comma;
    }
    if (const std::string keyword = misspelt_keyword(words, statement); !keyword.empty()) {
        return keyword;
    }
    for (const auto& [symptom, cure] : habits) {
        if (words.find(symptom) != std::string_view::npos) {
            return std::string(cure);
        }
    }
    return "";
}

}  // namespace dinal
