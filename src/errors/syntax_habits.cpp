// Habits from other languages that Lua does not compile. A rule looks at the message, at the token over which the
// parser stumbled, and at the one before it.
#include <algorithm>
#include <array>
#include <cctype>
#include <utility>
#include <vector>

#include "errors/habits.hpp"
#include "lua/tokens.hpp"
#include "text/suggest.hpp"

namespace dinal::errors {
namespace {

using Cure = std::pair<std::string_view, std::string_view>;

constexpr std::array<Cure, 20> symptoms = {{
    {"near '!'", "; in Lua 'not equal' is ~= and 'not' is a word"},
    {"near '+'", "; in Lua that is x = x + 1"},
    {"syntax error near '-'", "; in Lua that is x = x - 1"},
    {"syntax error near '*'", "; in Lua that is x = x * 2"},
    {"syntax error near '/'", "; in Lua that is x = x / 2"},
    {"near '&'", "; in Lua that is the word and"},
    {"near '|'", "; in Lua that is the word or"},
    {"near '?'", "; in Lua that is: condition and this or that"},
    {"near '#'", "; a remark begins with --"},
    {"unexpected symbol near '/", "; a remark begins with --"},
    {"unexpected symbol near '*'", "; a power is x^2"},
    {"unexpected symbol near '>'", "; in Lua 'not equal' is ~="},
    {"symbol near '['", "; a list is { 1, 2, 3 }"},
    {"'then' expected near '='", "; comparing is =="},
    {"'do' expected near '='", "; comparing is =="},
    {"'do' expected near '", "; a loop is: for i = 1, 10 do ... end, or: while x < 3 do ... end"},
    {"')' expected near '='", "; named options stand in braces: system{ I = 1, k = 4 }"},
    {"unfinished string", "; its closing quote is missing"},
    {"'}' expected near", "; is a comma missing there?"},
    {"expected (to close '{' at line", "; is a comma missing there, or a brace?"},
}};

/// What stands before a name in other languages: "def f", "var x", "import math".
constexpr std::array<Cure, 19> leading_words = {{
    {"def", "; a function is written: function f(x) return 2*x end"},
    {"func", "; a function is written: function f(x) return 2*x end"},
    {"fn", "; a function is written: function f(x) return 2*x end"},
    {"lambda", "; a function is written: function(x) return 2*x end"},
    {"var", "; a variable needs no word before it: x = 1"},
    {"let", "; a variable needs no word before it: x = 1"},
    {"const", "; a variable needs no word before it: x = 1"},
    {"int", "; a variable needs no word before it: x = 1"},
    {"float", "; a variable needs no word before it: x = 1"},
    {"double", "; a variable needs no word before it: x = 1"},
    {"global", "; a variable needs no word before it: x = 1"},
    {"import", "; math and all of dinal are there already, other modules come with require"},
    {"from", "; math and all of dinal are there already, other modules come with require"},
    {"using", "; math and all of dinal are there already, other modules come with require"},
    {"include", "; math and all of dinal are there already, other modules come with require"},
    {"elif", "; did you mean 'elseif'?"},
    {"elsif", "; did you mean 'elseif'?"},
    {"is", "; comparing is =="},
    {"help", "; write ?name, or help \"name\""},
}};

/// Letters and signs that word processors and books put in place of those that Lua knows.
constexpr std::array<Cure, 14> printed_signs = {{
    {"“", "\""},
    {"”", "\""},
    {"„", "\""},
    {"«", "\""},
    {"»", "\""},
    {"‘", "'"},
    {"’", "'"},
    {"−", "-"},
    {"–", "-"},
    {"×", "*"},
    {"·", "*"},
    {"²", "^2"},
    {"≤", "<="},
    {"≥", ">="},
}};

template <std::size_t count>
std::string_view cure(const std::array<Cure, count>& cures, std::string_view word) {
    const auto* const found =
        std::find_if(cures.begin(), cures.end(), [word](const Cure& c) { return c.first == word; });
    return found == cures.end() ? std::string_view() : found->second;
}

/// "didn't expect" and where: the message, the token, what stands before it.
struct Stumble {
    std::string_view words;
    std::vector<lua::Token> all = {};
    std::size_t at = 0;  ///< of the token in `all`; 0 when it is not known or the first

    [[nodiscard]] const lua::Token& token() const { return all[at]; }
    [[nodiscard]] const lua::Token& before() const { return all[at - 1]; }
};

bool is_value(const lua::Token& token) {
    return token.kind == lua::TokenKind::name || token.kind == lua::TokenKind::number;
}

/// The token of that text that is likeliest: the last one right behind a name or a number, else the first.
Stumble stumble_in(std::string_view words, std::string_view statement) {
    Stumble stumble{words, lua::tokens(statement)};
    const std::size_t near = words.find(" near '");
    if (near == std::string_view::npos) {
        return stumble;
    }
    const std::string_view text = words.substr(near + 7, words.rfind('\'') - near - 7);
    for (std::size_t i = 1; i < stumble.all.size(); ++i) {
        if (stumble.all[i].text == text &&
            (stumble.at == 0 || (is_value(stumble.all[i]) && is_value(stumble.all[i - 1])))) {
            stumble.at = i;
        }
    }
    return stumble;
}

std::string printed_sign(std::string_view words, std::string_view statement) {
    if (words.find("near '<\\") == std::string_view::npos) {
        return "";
    }
    for (const auto& [sign, meant] : printed_signs) {
        if (statement.find(sign) != std::string_view::npos) {
            return "; instead of " + std::string(sign) + " write " + std::string(meant);
        }
    }
    return "; names and signs of Lua are in plain letters: theta, pi, omega";
}

bool is_function_of(lua_State* L, std::string_view name) {
    lua_pushglobaltable(L);
    lua_pushlstring(L, name.data(), name.size());
    lua_rawget(L, -2);
    const bool is = lua_isfunction(L, -1);
    lua_pop(L, 2);
    return is;
}

/// "print x", "run:save name", "retrun x", "def f", "2 x": two words where there should be one.
std::string two_words(lua_State* L, const Stumble& stumble) {
    if (stumble.at == 0 || stumble.token().kind == lua::TokenKind::symbol ||
        stumble.before().kind != lua::TokenKind::name) {
        return "";
    }
    const std::string_view first = stumble.before().text;
    if (const std::string_view known = cure(leading_words, first); !known.empty()) {
        return std::string(known);
    }
    if (stumble.words.starts_with("function arguments expected")) {
        return "; a method is called with parentheses: " + std::string(first) + "(...)";
    }
    if (is_function_of(L, first)) {
        return "; a call needs parentheses: " + std::string(first) + "(...)";
    }
    const bool long_enough = first.size() > 2;
    return long_enough && stumble.words.starts_with("syntax error") ? text::did_you_mean(first, lua::keywords()) : "";
}

/// "if x then" with a slip in `then`; "fucntion(x)", which is a call, so that its end comes as a surprise.
std::string misspelt_keyword(const Stumble& stumble) {
    if (stumble.at > 0 && stumble.words.starts_with('\'')) {
        const std::array<std::string_view, 1> wanted = {stumble.words.substr(1, stumble.words.find('\'', 1) - 1)};
        return text::did_you_mean(stumble.token().text, wanted);
    }
    if (stumble.words.starts_with("<eof> expected near 'end'") || stumble.words.starts_with("'<eof>' expected")) {
        constexpr std::array<std::string_view, 1> wanted = {"function"};
        for (std::size_t i = 0; i + 1 < stumble.all.size(); ++i) {
            const lua::Token& token = stumble.all[i];
            if (token.kind == lua::TokenKind::name && stumble.all[i + 1].is("(")) {
                if (std::string hint =
                        token.is("fun") ? "; did you mean 'function'?" : text::did_you_mean(token.text, wanted);
                    !hint.empty()) {
                    return hint;
                }
            }
        }
    }
    return "";
}

/// "3t", "2pi"
std::string missing_star(const Stumble& stumble) {
    constexpr std::string_view head = "malformed number near '";
    if (!stumble.words.starts_with(head)) {
        return "";
    }
    std::string_view word = stumble.words.substr(head.size(), stumble.words.rfind('\'') - head.size());
    for (const lua::Token& token : stumble.all) {  // the message breaks off at 2p
        word = token.kind == lua::TokenKind::number && token.text.starts_with(word) ? token.text : word;
    }
    const std::size_t digits = std::min(word.find_first_not_of("0123456789."), word.size());
    const std::string_view name = word.substr(digits);
    const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
    const bool product = digits > 0 && !name.empty() && is_letter(name.front()) && name != "e" && name != "E" &&
                         std::count(word.begin(), word.end(), '.') < 2;
    return product ? "; a product needs a star: " + std::string(word.substr(0, digits)) + "*" + std::string(name) : "";
}

/// What the tokens around the place tell: braces and colons of other languages, "I : 1", "M(t) = 2*t".
std::string other_grammar(const Stumble& stumble) {
    if (stumble.at == 0) {
        return "";
    }
    const lua::Token& token = stumble.token();
    const lua::Token& before = stumble.before();
    const auto& all = stumble.all;
    if (stumble.words.starts_with("<name> expected") && before.is(":")) {
        return token.is("=") ? "; assigning is =" : "; a named value is written with =, I = 1";
    }
    if (stumble.words.starts_with("<name> expected near '('") && before.is("for")) {
        return "; a loop is: for i = 1, 10 do ... end";
    }
    if (stumble.words.starts_with("'then' expected") && (token.is("{") || token.is(":"))) {
        return "; in Lua: if x > 3 then ... end";
    }
    if (token.is("{") && before.is(")")) {
        return "; a block has no braces and ends with end";
    }
    if (token.is("=") && (before.is("=") || before.is("=="))) {
        return "; comparing is ==";
    }
    if (token.is("=") && before.is(")") && all.size() > 2 && all[0].kind == lua::TokenKind::name && all[1].is("(")) {
        return "; a function is written: " + std::string(all[0].text) + " = function(t) return ... end";
    }
    const bool number = token.kind == lua::TokenKind::number || before.kind == lua::TokenKind::number;
    const bool expression = !stumble.words.starts_with('\'') || stumble.words.starts_with("')'");
    if (expression && number && is_value(token) && is_value(before)) {
        return "; is an operator missing there, such as *?";
    }
    return "";
}

}  // namespace

std::string syntax_habit(lua_State* L, std::string_view words, std::string_view statement) {
    luaL_checkstack(L, LUA_MINSTACK, "for the habits of others");
    const Stumble stumble = stumble_in(words, statement);
    for (std::string advice : {printed_sign(words, statement), two_words(L, stumble), misspelt_keyword(stumble),
                               missing_star(stumble), other_grammar(stumble)}) {
        if (!advice.empty()) {
            return advice;
        }
    }
    for (const auto& [symptom, advice] : symptoms) {
        if (words.find(symptom) != std::string_view::npos) {
            return std::string(advice);
        }
    }
    return "";
}

}  // namespace dinal::errors
