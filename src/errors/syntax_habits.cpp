// Habits from other languages that Lua does not compile. A rule looks at the message, at the token over which the
// parser stumbled, and at the one before it.
#include <algorithm>
#include <array>
#include <cctype>
#include <utility>
#include <vector>

#include "errors/habits.hpp"
#include "lua/bind.hpp"
#include "lua/tokens.hpp"
#include "text/suggest.hpp"
#include "text/words.hpp"

namespace dinal::errors {
namespace {

using Cure = std::pair<std::string_view, std::string_view>;

/// What Lua complains of, "" for anything, and near what: "" for any word.
struct Symptom {
    std::string_view complaint;
    std::string_view near;
    std::string_view cure;
};

constexpr std::array<Symptom, 22> symptoms = {{
    {"", "!", "; in Lua 'not equal' is ~= and 'not' is a word"},
    {"", "+", "; in Lua that is x = x + 1"},
    {"syntax error", "-", "; in Lua that is x = x - 1"},
    {"syntax error", "*", "; in Lua that is x = x * 2"},
    {"syntax error", "/", "; in Lua that is x = x / 2"},
    {"", "&", "; in Lua that is the word and"},
    {"", "|", "; in Lua that is the word or"},
    {"", "?", "; in Lua that is: condition and this or that"},
    {"", "#", "; a comment begins with --"},
    {"unexpected symbol", "/", "; a comment begins with --"},
    {"unexpected symbol", "//", "; a comment begins with --"},
    {"unexpected symbol", "%", "; a comment begins with --"},
    {"unexpected symbol", "@", "; a function is written: function(t) return 2*t end"},
    {"unexpected symbol", ">", "; in Lua 'not equal' is ~="},
    {"unexpected symbol", "[", "; a list is { 1, 2, 3 }"},
    {"'then' expected", "=", "; comparing is =="},
    {"'do' expected", "=", "; comparing is =="},
    {"'do' expected", "", "; a loop is: for i = 1, 10 do ... end, or: while x < 3 do ... end"},
    {"',' expected", ":", "; a loop is: for i = 1, 10 do ... end"},
    {"')' expected", "=", "; write named options in braces: system{ I = 1, k = 4 }"},
    {"unfinished string", "", "; its closing quote is missing"},
    {"'}' expected", "", "; is a comma missing there?"},
}};

/// What stands before a name in other languages: "def f", "var x", "import math".
constexpr std::array<Cure, 26> leading_words = {{
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
    {"DO", "; a loop is: for i = 1, 10 do ... end"},
    {"CALL", "; a call needs parentheses and no word before it: f(x)"},
    {"PRINT", "; a value is shown by print(x)"},
    {"clear", "; :reset deletes your variables"},
    {"close", "; nothing needs to be closed: each plot is a picture of its own"},
    {"hold", "; several curves are one picture: plot{ { x, y }, { x, z } }"},
    {"save", "; a run is saved by run:save(\"run.csv\"), your inputs by :save lab.lua"},
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
    const lua::SyntaxMessage& message;
    std::vector<lua::Token> all = {};
    std::size_t at = 0;  ///< of the token in `all`; 0 when it is not known or the first

    [[nodiscard]] const lua::Token& token() const { return all[at]; }
    [[nodiscard]] const lua::Token& before() const { return all[at - 1]; }
};

bool is_operand(const lua::Token& token) {
    return token.kind == lua::TokenKind::name || token.kind == lua::TokenKind::number;
}

/// The token of that text that is likeliest: the last one right behind a name or a number, else the first.
Stumble stumble_in(const lua::SyntaxMessage& message, std::string_view statement) {
    Stumble stumble{message, lua::tokens(statement)};
    for (std::size_t i = 1; i < stumble.all.size(); ++i) {
        if (stumble.all[i].text == message.near &&
            (stumble.at == 0 || (is_operand(stumble.all[i]) && is_operand(stumble.all[i - 1])))) {
            stumble.at = i;
        }
    }
    return stumble;
}

std::string printed_sign(const lua::SyntaxMessage& message, std::string_view statement) {
    if (!message.near.starts_with("<\\")) return "";
    for (const auto& [sign, meant] : printed_signs) {
        if (statement.find(sign) != std::string_view::npos) {
            return "; instead of " + std::string(sign) + " write " + std::string(meant);
        }
    }
    return "; names and signs of Lua are in plain letters: theta, pi, omega";
}

/// "x**2", and a prompt that was copied along with what stands behind it.
std::string doubled_sign(const Stumble& stumble) {
    const auto& all = stumble.all;
    for (std::size_t i = 1; i < all.size(); ++i) {
        if (all[i].is("*") && all[i - 1].is("*") && all[i].at == all[i - 1].end()) {
            return "; a power is x^2";
        }
    }
    const bool prompt = !all.empty() && (all.front().is(">") || all.front().is(">>"));
    return prompt ? "; leave out the prompt " + std::string(all.front().text) + " that stands in front" : "";
}

/// How the function on the top of the stack is called: with its options in braces, or in parentheses.
std::string called_as(lua_State* L, std::string_view name) {
    const lua::Documented found = lua::documented(L, -1);
    const lua::Doc* doc = found.member != nullptr ? &found.member->doc : nullptr;
    const std::string_view signature = doc != nullptr ? std::string_view(doc->signature) : std::string_view();
    const std::size_t bracket = signature.find_first_of("({");
    const bool braces = bracket != std::string_view::npos && signature[bracket] == '{';
    return braces ? "; write its options in braces: " + std::string(name) + "{ ... }"
                  : "; a call needs parentheses: " + std::string(name) + "(...)";
}

/// The same for a global function; "" when there is none of that name.
std::string call_of_global(lua_State* L, std::string_view name) {
    lua_pushglobaltable(L);
    lua_pushlstring(L, name.data(), name.size());
    lua_rawget(L, -2);
    std::string call = lua_isfunction(L, -1) ? called_as(L, name) : "";
    lua_pop(L, 2);
    return call;
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
    if (stumble.message.complaint == "function arguments expected") {
        return "; a method is called with parentheses: " + std::string(first) + "(...)";
    }
    if (std::string call = call_of_global(L, first); !call.empty()) {
        return call;
    }
    const bool long_enough = first.size() > 2;
    return long_enough && stumble.message.complaint == "syntax error" ? text::did_you_mean(first, lua::keywords()) : "";
}

/// "if x then" with a slip in `then`; "fucntion(x)", which is a call, so that its end comes as a surprise.
std::string misspelt_keyword(const Stumble& stumble) {
    if (stumble.at > 0 && !stumble.message.expected.empty()) {
        const std::array<std::string_view, 1> wanted = {stumble.message.expected};
        return text::did_you_mean(stumble.token().text, wanted);
    }
    if (stumble.message.complaint == "<eof> expected" && stumble.message.near == "end") {
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

/// check(1a, 3): functions that are called with a name that looks like a number.
std::string name_without_quotes(const Stumble& stumble) {
    constexpr std::array<Cure, 1> called = {{{"check", "; write the name of a question in quotes: check(\""}}};
    for (std::size_t i = 1; i < stumble.all.size(); ++i) {
        const lua::Token& token = stumble.all[i];
        const lua::Token& function = stumble.all[i - (i > 1 && stumble.all[i - 1].is("(") ? 2 : 1)];
        const std::string_view known = cure(called, function.text);
        if (!known.empty() && token.kind == lua::TokenKind::number && !token.text.empty() &&
            std::isalpha(static_cast<unsigned char>(token.text.back())) != 0) {
            return std::string(known) + std::string(token.text) + "\", 3.2)";
        }
    }
    return "";
}

/// "3t", "2pi"
std::string missing_star(const Stumble& stumble) {
    if (stumble.message.complaint != "malformed number") return "";
    std::string_view word = stumble.message.near;
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

/// "function(t) 3*t end"
std::string missing_return(const Stumble& stumble) {
    const auto& all = stumble.all;
    const std::string_view complaint = stumble.message.complaint;
    if (complaint != "unexpected symbol" && complaint != "syntax error") return "";
    std::size_t body = 0;  // of the innermost function before the place
    for (std::size_t i = 0; i < stumble.at; ++i) {
        if (!all[i].is("function")) continue;
        while (i < stumble.at && !all[i].is(")")) ++i;
        body = i + 1;
    }
    if (body == 0 || body > stumble.at || (stumble.at + 1 < all.size() && all[stumble.at + 1].is("="))) return "";
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(body);
    const auto place = all.begin() + static_cast<std::ptrdiff_t>(stumble.at);
    const lua::Token& token = stumble.token();
    const bool value = token.kind == lua::TokenKind::number || token.kind == lua::TokenKind::string;
    const bool sign = token.kind == lua::TokenKind::symbol &&
                      (std::string_view("+-*/^%<>").find(token.text.front()) != std::string_view::npos ||
                       token.is("..") || token.is("==") || token.is("~="));
    const bool expression = (value || sign) && std::none_of(first, place, [](const lua::Token& other) {
                                return other.kind == lua::TokenKind::keyword || other.is("=") || other.is(";");
                            });
    return expression ? "; is the word return missing there?" : "";
}

/// What the tokens around the place tell: braces and colons of other languages, "I : 1", "M(t) = 2*t".
std::string other_grammar(const Stumble& stumble) {
    if (stumble.at == 0) return "";
    const lua::Token& token = stumble.token();
    const lua::Token& before = stumble.before();
    const auto& all = stumble.all;
    const std::string_view complaint = stumble.message.complaint;
    if (all.front().is("WRITE") || all.front().is("PRINT")) {  // WRITE(*,*) X
        return "; a value is shown by print(x)";
    }
    if (complaint == "<name> expected" && before.is(":")) {
        return token.is("=") ? "; assigning is =" : "; a named value is written with =, I = 1";
    }
    if (complaint == "<name> expected" && token.is("(") && before.is("for")) {
        return "; a loop is: for i = 1, 10 do ... end";
    }
    if (stumble.message.expected == "then" && (token.is("{") || token.is(":"))) {
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
    const bool expression = stumble.message.expected.empty() || stumble.message.expected == ")";
    if (expression && number && is_operand(token) && is_operand(before)) {
        const bool call = before.kind == lua::TokenKind::name && token.kind == lua::TokenKind::number;
        return "; is an operator missing there, such as *" +
               (call ? ", or ( ), as in f(" + std::string(token.text) + ")?" : "?");
    }
    return "";
}

}  // namespace

std::string syntax_habit(lua_State* L, const lua::SyntaxMessage& message, std::string_view statement) {
    luaL_checkstack(L, LUA_MINSTACK, "for the habits of others");
    const Stumble stumble = stumble_in(message, statement);
    for (std::string advice :
         {foreign_tokens(statement, false), printed_sign(message, statement), doubled_sign(stumble),
          name_without_quotes(stumble), two_words(L, stumble), misspelt_keyword(stumble), missing_star(stumble),
          missing_return(stumble), other_grammar(stumble)}) {
        if (!advice.empty()) {
            return advice;
        }
    }
    if (message.opened == "{") {
        return "; is a comma missing there, or a brace?";
    }
    const auto* const symptom = std::find_if(symptoms.begin(), symptoms.end(), [&message](const Symptom& s) {
        return (s.complaint.empty() || s.complaint == message.complaint) && (s.near.empty() || s.near == message.near);
    });
    return symptom == symptoms.end() ? "" : std::string(symptom->cure);
}

}  // namespace dinal::errors
