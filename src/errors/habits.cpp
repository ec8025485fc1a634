#include "errors/advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "lua/safe_mode.hpp"
#include "lua/standard_globals.hpp"
#include "text/suggest.hpp"
#include "text/words.hpp"

namespace dinal::errors {

namespace {

constexpr std::string_view loop_cure = "; a loop is: for i = 1, 10 do ... end";
constexpr std::string_view print_cure = "; a value is shown by print(x)";
constexpr std::string_view slice_cure =
    "; a part of a vector is v:slice(first, last), of a list table.unpack(list, first, last)";
constexpr std::string_view lambda_cure = "; a function is written: function(x) return 2*x end";
constexpr std::string_view format_cure = "; values go into a text by string.format(\"x = %.3f\", x)";
constexpr std::string_view last_cure = "; the last element of v is v[#v]";
constexpr std::string_view then_cure = "; in Lua: if x > 3 then ... end";
constexpr std::string_view comment_cure = "; a comment begins with --";
constexpr std::string_view folder_cure = "; :cd folder changes the current folder";
constexpr std::string_view files_cure = "; :ls lists the files of the current folder";

/// A pattern of another language, and the remark with Lua's equivalent. Each word of a pattern is a token, or several
/// to choose from: def|fn. n stands for any name, # for any number, 1 for either, w for any word, s for a string, ? for
/// any token, ... for any number of them, ^ for the beginning, $ for the end. word+ is followed by the next token
/// without a blank, word_ with one. In the cure {0}, {1} etc. stand for the matched tokens.
struct Habit {
    std::string_view pattern, cure;
};
constexpr Habit first_habits[] = {
    {"1 : 1 : 1", "; evenly spaced values are vector.range(0, 1, 0.1) or vector.linspace(0, 1, 11)"},
    {"^ % %", "; dinal has no magic commands; :time code prints the time that code takes"},
    {"^ % matplotlib", "; dinal has no magic commands: run:plot() shows its picture in the page"},
    {"load n .", "; write the name of a file in quotes: load \"file.csv\""},
    {"[ end ]", last_cure},
    {"( end )", last_cure},
    {". *|/|^", "; * / and ^ act on each element of a vector"},
    {"[ 1 :", slice_cure},
    {"[ :", slice_cure},
    {"[ - 1 :", slice_cure},
    {"lambda n|:", lambda_cure},
    {"if|elseif|while|and|or n = >", "; in Lua 'at least' is >="},
    {"n = >", lambda_cure},
    {"< >", "; in Lua 'not equal' is ~="},
    {"1 for n in",
     "; a list is filled by a loop: for i = 1, 10 do list[i] = i^2 end; a vector by v:map(function(x) return x^2 end)"},
    {"* *", "; a power is x^2"},
    {"^ >", "; leave out the prompt > that stands in front"},
    {"^ >>", "; leave out the prompt >> that stands in front"},
    {"check ( #", "; write the name of a question in quotes: check(\"{2}\", 3.2)"},
    {"check #", "; write the name of a question in quotes: check(\"{1}\", 3.2)"},
    {"def|func|fn 1", "; a function is written: function f(x) return 2*x end"},
    {"var|let|const|int|float|double|global 1", "; a variable needs no word before it: x = 1"},
    {"import|from|using|include 1", "; math and all of dinal are there already, other modules come with require"},
    {"elif|elsif w", "; did you mean 'elseif'?"},
    {"DO 1", loop_cure},
    {"CALL 1", "; a call needs parentheses and no word before it: f(x)"},
    {"PRINT w", print_cure},
    {"^ PRINT|WRITE", print_cure},
    {"^ cd w", folder_cure},
    {"^ ls w|*", files_cure},
    {"clear w", "; :reset deletes your variables"},
    {"close w", "; nothing needs to be closed: each plot is a picture of its own"},
    {"hold w", "; several curves are one picture: plot{ { x, y }, { x, z } }"},
    {"save w", "; a run is saved by run:save(\"run.csv\"), your inputs by :save lab.lua"},
    {"help w", "; write ?name, or help \"name\""},
};
constexpr Habit last_habits[] = {
    {"n : =", "; assigning is ="}, {"n : #|s", "; a named value is written with =, I = 1"},
    {"for (", loop_cure},          {"^ n ( n ) =", "; a function is written: {0} = function(t) return ... end"},
    {"== =", "; comparing is =="}, {") {", "; a block has no braces and ends with end"},
};
constexpr Habit between_habits[] = {
    {"n #", "; is an operator missing there, such as *, or ( ), as in f({1})?"},
    {"# 1", "; is an operator missing there, such as *?"},
};
constexpr Habit running_habits[] = {
    {"^ hash n", comment_cure},
    {"s %", format_cure},
    {"f s", format_cure},
    {".|: append", "; appending is list[#list + 1] = x; vectors are joined by v .. w"},
    {". shape", "; the length of a vector, list or run is #v"},
    {"^ cd /", folder_cure},
    {"^ ls -|/", files_cure},
};
constexpr Habit number_habits[] = {
    {"= # , #", "; a decimal point is a point: {1}.{3}"},
    {",|( #+ ,+ #", "; a decimal point is a point: {1}.{3}"},
};
constexpr Habit named_habits[] = {
    {"n . csv|dat|txt|svg|png|pdf|gp|lua", "; write the name of a file in quotes: \"{0}.{2}\""},
};
constexpr Habit safe_habits[] = {
    {"io . n", "; safe mode has no io.{2}: load reads files, and save methods write them"},
    {"os|debug|string|package . n", "; safe mode leaves it out: see docs/safe-mode.md"},
    {"dofile|loadfile", "; safe mode has no {0}: a script is one file"},
};
constexpr Habit said_habits[] = {
    {"^ attempt to mod a 'string'", format_cure},
    {"^ attempt to perform bitwise operation",
     "; in Lua and, or and not are words; several conditions are v[v:find(function(x) return x > 0 and x < 1 end)]"},
    {"^ attempt to perform arithmetic on a row",
     "; a row has several values, of which one is meant, as in run.events[1].theta"},
    {"^ attempt to perform arithmetic on a table value ( ? s",
     "; a table has no arithmetic, a vector has: vector({10})"},
    {"^ attempt to perform arithmetic on a table", "; a table has no arithmetic, a vector has: vector(list)"},
    {"^ attempt to add a 'string' with", "; texts are joined with .."},
    {"^ attempt to add a 'number' with a 'string'", "; texts are joined with .."},
    {"^ attempt to call a number value ( for iterator", "; counting is: for i = 1, 10 do"},
    {"^ attempt to call a ? value ( for iterator", "; going through a list is: for i, x in ipairs(list) do"},
    {"^ attempt to call a vector|table", "; its elements are in brackets: v[1]"},
    {"^ attempt to call a number|string|boolean", "; it is a value and no function: leave out the parentheses"},
    {"to close '{'", "; is a comma missing there, or a brace?"},
    {"near '!'", "; in Lua 'not equal' is ~= and 'not' is a word"},
    {"near '+'", "; in Lua that is x = x + 1"},
    {"^ syntax error near '-'", "; in Lua that is x = x - 1"},
    {"^ syntax error near '*'", "; in Lua that is x = x * 2"},
    {"^ syntax error near '/'", "; in Lua that is x = x / 2"},
    {"near '&'", "; in Lua that is the word and"},
    {"near bar", "; in Lua that is the word or"},
    {"near '?'", "; in Lua that is: condition and this or that"},
    {"near '#'", comment_cure},
    {"^ unexpected symbol near '/'|'//'|'%'", comment_cure},
    {"^ unexpected symbol near '@'", "; a function is written: function(t) return 2*t end"},
    {"^ unexpected symbol near '>'", "; in Lua 'not equal' is ~="},
    {"^ unexpected symbol near '['", "; a list is { 1, 2, 3 }"},
    {"^ 'then'|'do' expected near '='|'is'", "; comparing is =="},
    {"^ 'then' expected near '{'|':'", then_cure},
    {"^ 'do' expected", "; a loop is: for i = 1, 10 do ... end, or: while x < 3 do ... end"},
    {"^ ',' expected near ':'", loop_cure},
    {"^ ')' expected ... near '='", "; write named options in braces: system{ I = 1, k = 4 }"},
    {"^ unfinished string", "; its closing quote is missing"},
    {"^ '}' expected", "; is a comma missing there?"},
};
constexpr Habit unknown_habits[] = {
    {"echo|disp|display|puts|println", "; did you mean 'print'?"},
    {"True", "; did you mean 'true'?"},
    {"False", "; did you mean 'false'?"},
    {"None|null|NULL", "; did you mean 'nil'?"},
    {"t", "; a value that depends on t is a function: function(t) return 2*t end"},
    {"range", loop_cure},
    {"len|length|size|numel", "; the length of x is #x"},
    {"str", "; did you mean 'tostring'?"},
    {"int", "; did you mean 'math.floor'?"},
    {"float", "; did you mean 'tonumber'?"},
    {"ln", "; did you mean 'math.log'?"},
    {"log10", "; did you mean 'math.log(x, 10)'?"},
    {"log2", "; did you mean 'math.log(x, 2)'?"},
    {"printf|fprintf", "; a format is filled by string.format: print(string.format(\"%.3f\", x))"},
    {"sprintf", "; did you mean 'string.format'?"},
    {"round", "; rounding is math.floor(x + 0.5), or string.format(\"%.3f\", x)"},
    {"abs", "; did you mean 'math.abs', or of a vector v:abs()?"},
    {"append", "; appending is list[#list + 1] = x"},
    {"enumerate", "; a loop over a list is: for i, x in ipairs(list) do ... end"},
    {"np", "; vectors are made by vector.linspace, vector{ ... }; see ?vector"},
    {"input", "; input is read by io.read()"},
    {"ayuda", "; help() starts a tour, ?name explains a name"},
    {"exit|quit|bye|salir", "; os.exit() ends a script, :quit or Ctrl-D a session"},
    {"zeros", "; n zeros are vector.linspace(0, 0, n)"},
    {"ones", "; n ones are vector.linspace(1, 1, n)"},
    {"lsim|ode45|solve_ivp|odeint", "; a run is made by sys:simulate{ M = M, t_end = 20 }"},
    {"fft", "; a spectrum is run:spectrum()"},
    {"bode", "; a response curve is sys:response{ over = { frequency = vector.linspace(0.1, 2, 200) } }"},
    {"title", "; a title is an option: plot{ { x, y }, title = \"...\" }"},
    {"xlabel|ylabel|legend",
     "; labels are options: plot{ { x, y, label = \"a\" }, xlabel = \"t\", ylabel = \"theta\" }"},
    {"plt", "; a plot is plot(x, y), or run:plot()"},
    {"pd", "; a CSV file is read by load(\"file.csv\")"},
    {"tic|toc", "; :time code prints the time that code takes"},
    {"dir", "; Tab after a name and a point lists its fields, help(name) explains them, :who lists variables"},
    {"save", "; a run is saved by run:save(\"run.csv\")"},
};
constexpr Habit typed_habits[] = {
    {"exit|quit|q|bye|logout|ende|beenden|salir|quitter|esci", "; :quit or Ctrl-D leaves"},
    {"clear|cls|clc", "; Ctrl-L clears the screen, :reset forgets your variables"},
    {"who|whos|dir",
     "; :who lists your variables; Tab after a name and a point lists its fields, help(name) explains them"},
    {"_", "; ans holds the last value that was computed"},
    {"ls", "; :ls lists the files of the current folder"},
    {"cd|pwd", "; :cd folder changes the current folder, :pwd shows it"},
    {"man", "; help \"name\" explains a name"},
    {"history", "; the up arrow brings earlier lines back, Ctrl-R searches them, and :save writes them to a script"},
    {"save", "; :save lab.lua writes your inputs to a script, run:save(\"run.csv\") writes a run"},
    {"reset", "; :reset forgets your variables"},
    {"hilfe|ayuda|aide|aiuto|hallo|hello|hola", "; help() starts a tour, and ?name explains a name"},
};
constexpr Habit unfinished_habits[] = {
    {"^ for ... :_ ?", loop_cure},
    {"^ while ... :_ ?", "; a loop is: while x < 3 do ... end"},
    {"^ if ... :_ ?", then_cure},
    {"^ cd ?", folder_cure},
    {"^ ls ?", "; :ls folder lists the files of a folder"},
    {"#+ % $", "; % is the remainder of a division; {0} percent are {0}/100"},
};
constexpr Habit complete_habits[] = {
    {"^ n = #+ ,+ # $", "; {2},{4} are two numbers, and {0} is the first; a decimal point is a point: {2}.{4}"},
};
/// By Seen.
constexpr std::span<const Habit> habits[] = {first_habits,   last_habits,  between_habits,    running_habits,
                                             number_habits,  named_habits, safe_habits,       said_habits,
                                             unknown_habits, typed_habits, unfinished_habits, complete_habits};

bool fits(const lua::Token& token, std::string_view wanted) {
    if (const std::size_t end = wanted.find('|'); end != std::string_view::npos) {
        return fits(token, wanted.substr(0, end)) || fits(token, wanted.substr(end + 1));
    }
    const bool name = token.kind == lua::TokenKind::name, number = token.kind == lua::TokenKind::number;
    return wanted == "n"      ? name
           : wanted == "#"    ? number
           : wanted == "1"    ? name || number
           : wanted == "w"    ? token.kind != lua::TokenKind::symbol
           : wanted == "hash" ? token.is("#")
           : wanted == "bar"  ? token.text == "'|'"
           : wanted == "s"    ? token.kind == lua::TokenKind::string
                              : wanted == "?" || token.is(wanted) || (wanted.front() == '\'' && token.text == wanted);
}

/// The tokens that match the pattern, the first of them at the beginning; none if they do not.
std::optional<std::vector<std::string_view>> matched(std::span<const lua::Token> all, std::string_view pattern) {
    if (pattern.empty() || (pattern == "$" && all.empty())) return std::vector<std::string_view>();
    std::string_view word = pattern.substr(0, pattern.find(' '));
    const std::string_view rest = pattern.substr(std::min(word.size() + 1, pattern.size()));
    if (word == "...") {
        for (; !all.empty(); all = all.subspan(1)) {
            if (auto found = matched(all, rest)) return found;
        }
    }
    const bool close = word.size() > 1 && word.back() == '+', apart = word.size() > 1 && word.back() == '_';
    if (close || apart) word.remove_suffix(1);
    if (all.empty() || !fits(all.front(), word)) return {};
    if ((close || apart) && (all.size() < 2 || (all[0].end() == all[1].at) != close)) return {};
    auto found = matched(all.subspan(1), rest);
    if (found) found->insert(found->begin(), text::trimmed(all.front().text, "'"));
    return found;
}

/// Remark on a name of dinal with another value that is called, or on a module.
std::string called_name(lua_State* L, std::string_view name, std::string_view type) {
    if (lua::is_overwritten(L, name) && lua::is_of_dinal(L, name)) {
        return fmt::format("; {0} is a name of dinal, but now has another value: {0} = dinal.{0} restores it", name);
    }
    return type == name ? fmt::format("; it is a module: help({}) lists its functions", name) : "";
}

/// Remark on run.energy.total: a field is read from a function that should be called.
std::string uncalled_function(lua_State* L, const lua::LuaMessage& message, std::string_view statement) {
    const lua::Tokens all = lua::tokens(statement);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i].is(message.name)) continue;
        std::string name(message.name);
        if (i > 1 && all[i - 1].is(".")) {
            lua::push_global(L, all[i - 2].text);
            name.insert(0, std::string(all[i - 2].text) + (lua_isuserdata(L, -1) != 0 ? ":" : "."));
            lua_pop(L, 1);
        }
        return "; " + name + " is a function: call it first";
    }
    return "";
}

bool is_number(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789.") == std::string_view::npos;
}

}  // namespace

std::string foreign_tokens(std::string_view statement, Seen seen, std::optional<std::string_view> culprit) {
    const lua::Tokens all = lua::tokens(statement);
    for (const Habit& one : habits[static_cast<std::size_t>(seen)]) {
        const bool begins = one.pattern.starts_with("^ ");
        for (std::size_t i = 0; i < (begins ? 1 : all.size()); ++i) {
            const auto found = matched(std::span(all).subspan(i), one.pattern.substr(begins ? 2 : 0));
            if (!found || (culprit && !text::contains(*found, *culprit))) continue;
            std::string cure(one.cure);
            for (std::size_t k = 0; k < found->size(); ++k) {
                const std::string mark = fmt::format("{{{}}}", k);
                for (std::size_t at = 0; (at = cure.find(mark)) != std::string::npos;) {
                    cure.replace(at, mark.size(), (*found)[k]);
                }
            }
            return cure;
        }
    }
    return "";
}

std::string running_habit(const text::Error& error, std::string_view statement) {
    if (error.option.empty() && is_number(error.culprit)) return foreign_tokens(statement, Seen::number);
    const bool known = error.culprit == "append" || error.culprit == "shape";
    return known ? foreign_tokens(statement, Seen::running) : foreign_tokens(statement, Seen::named, error.culprit);
}

std::string running_habit(lua_State* L, const lua::LuaMessage& message, std::string_view statement) {
    const bool nil = message.type == "nil", global = message.calls && message.kind == "global";
    for (std::string remark :
         {nil && lua::safe_mode() ? foreign_tokens(statement, Seen::safe, message.name) : "",
          nil || message.type == "string" ? foreign_tokens(statement, Seen::running) : "",
          global ? called_name(L, message.name, message.type) : "", foreign_tokens(message.words, Seen::said),
          message.type == "function" && !message.calculates ? uncalled_function(L, message, statement) : "",
          message.calls ? "" : foreign_tokens(statement, Seen::named, message.name)}) {
        if (!remark.empty()) return remark;
    }
    return "";
}

// Habits from other languages that do not compile.

namespace {

/// Typographic characters, and those of Lua that they replace.
constexpr std::string_view printed_signs[][2] = {{"“", "\""}, {"”", "\""}, {"„", "\""}, {"«", "\""}, {"»", "\""},
                                                 {"‘", "'"},  {"’", "'"},  {"−", "-"},  {"–", "-"},  {"×", "*"},
                                                 {"·", "*"},  {"²", "^2"}, {"≤", "<="}, {"≥", ">="}};

/// The message with the rejected token and its context.
struct Stumble {
    const lua::SyntaxMessage& message;
    lua::Tokens all = {};
    std::size_t at = 0;  ///< index of the rejected token in `all`; 0 if unknown or the first

    const lua::Token& token() const { return all[at]; }
    const lua::Token& before() const { return all[at - 1]; }
};

bool is_operand(const lua::Token& token) {
    return token.kind == lua::TokenKind::name || token.kind == lua::TokenKind::number;
}

/// The likeliest token with that text: the last one right behind a name or number, otherwise the first.
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
    if (statement.starts_with("\xFF\xFE") || statement.starts_with("\xFE\xFF")) {
        return "; the file is text in UTF-16: save it in UTF-8";
    }
    for (const auto& [sign, meant] : printed_signs) {
        if (statement.find(sign) != std::string_view::npos) {
            return fmt::format("; instead of {} write {}", sign, meant);
        }
    }
    return "; names and signs of Lua are in plain letters: theta, pi, omega";
}

/// The remark that a global function takes its options in braces, or needs parentheses; "" if no such function exists.
std::string call_of_global(lua_State* L, std::string_view name) {
    const bool is_function = lua::push_global(L, name) == LUA_TFUNCTION;
    const lua::Documented found = lua::documented(L, -1);
    lua_pop(L, 1);
    if (!is_function) return "";
    const std::string_view signature = found.member != nullptr ? found.member->doc.signature : "";
    const std::size_t bracket = signature.find_first_of("({");
    return bracket != std::string_view::npos && signature[bracket] == '{'
               ? fmt::format("; write its options in braces: {}{{ ... }}", name)
               : fmt::format("; a call needs parentheses: {}(...)", name);
}

/// Remark on two words instead of one: "print x", "run:save name", "retrun x", "def f", "2 x".
std::string two_words(lua_State* L, const Stumble& stumble) {
    if (stumble.at == 0 || stumble.token().kind == lua::TokenKind::symbol ||
        stumble.before().kind != lua::TokenKind::name) {
        return "";
    }
    const std::string_view first = stumble.before().text;
    if (stumble.message.complaint == "function arguments expected") {
        return "; a method is called with parentheses: " + std::string(first) + "(...)";
    }
    if (std::string call = call_of_global(L, first); !call.empty()) {
        return call;
    }
    const bool long_enough = first.size() > 2;
    return long_enough && stumble.message.complaint == "syntax error" ? text::did_you_mean(first, lua::keywords()) : "";
}

/// Remark on a misspelt keyword: "if x then" with an error in `then`; "fucntion(x)", which is a call, so that its end
/// is unexpected.
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
                const std::string hint = text::did_you_mean(token.text, wanted);
                if (!hint.empty()) return hint;
            }
        }
    }
    return "";
}

/// Remark on a missing *: "3t", "2pi".
std::string missing_star(const Stumble& stumble) {
    if (stumble.message.complaint != "malformed number") return "";
    std::string_view word = stumble.message.near;
    for (const lua::Token& token : stumble.all) {  // the message is cut off at 2p
        word = token.kind == lua::TokenKind::number && token.text.starts_with(word) ? token.text : word;
    }
    const std::size_t digits = std::min(word.find_first_not_of("0123456789."), word.size());
    const std::string_view name = word.substr(digits);
    const bool product = digits > 0 && !name.empty() && text::is_name_char(name.front()) && name != "e" &&
                         name != "E" && std::ranges::count(word, '.') < 2;
    return product ? "; a product needs a star: " + std::string(word.substr(0, digits)) + "*" + std::string(name) : "";
}

/// Remark on a missing return: "function(t) 3*t end".
std::string missing_return(const Stumble& stumble) {
    const auto& all = stumble.all;
    const std::string_view complaint = stumble.message.complaint;
    if (complaint != "unexpected symbol" && complaint != "syntax error") return "";
    std::size_t body = 0;  // body of the innermost function around the place
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

}  // namespace

std::string syntax_habit(lua_State* L, const lua::SyntaxMessage& message, std::string_view statement) {
    luaL_checkstack(L, LUA_MINSTACK, "for the habits of others");
    const Stumble stumble = stumble_in(message, statement);
    const bool expression = message.expected.empty() || message.expected == ")";
    for (std::string advice :
         {foreign_tokens(statement, Seen::first), printed_sign(message, statement), two_words(L, stumble),
          misspelt_keyword(stumble), missing_star(stumble), missing_return(stumble),
          foreign_tokens(statement, Seen::last), expression ? foreign_tokens(statement, Seen::between) : "",
          foreign_tokens(message.words, Seen::said)}) {
        if (!advice.empty()) return advice;
    }
    return "";
}

}  // namespace dinal::errors
