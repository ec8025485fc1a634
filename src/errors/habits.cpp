#include "errors/habits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
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
constexpr std::string_view question_cure = "; write the name of a question in quotes: check(\"{#}\", 3.2)";
constexpr std::string_view slice_cure =
    "; a part of a vector is v:slice(first, last), of a list table.unpack(list, first, last)";
constexpr std::string_view lambda_cure = "; a function is written: function(x) return 2*x end";
constexpr std::string_view format_cure = "; values go into a text by string.format(\"x = %.3f\", x)";
constexpr std::string_view last_cure = "; the last element of v is v[#v]";
constexpr std::string_view folder_cure = "; :cd folder changes the current folder";
constexpr std::string_view files_cure = "; :ls lists the files of the current folder";

/// Words and signs of other languages. Each word of a pattern is a token, or several to choose from: def|fn. n stands
/// for any name, # for any number, 1 for either, w for any word, s for a string, ^ for the beginning. In the cure {n}
/// etc. stand for the matched text.
struct Habit {
    std::string_view pattern;
    Seen seen;
    std::string_view cure;
};
constexpr Habit habits[] = {
    {"echo|disp|display|puts|println", Seen::unknown, "; did you mean 'print'?"},
    {"True", Seen::unknown, "; did you mean 'true'?"},
    {"False", Seen::unknown, "; did you mean 'false'?"},
    {"None|null|NULL", Seen::unknown, "; did you mean 'nil'?"},
    {"t", Seen::unknown, "; a value that depends on t is a function: function(t) return 2*t end"},
    {"range", Seen::unknown, "; a loop is: for i = 1, 10 do ... end"},
    {"len|length|size|numel", Seen::unknown, "; the length of x is #x"},
    {"str", Seen::unknown, "; did you mean 'tostring'?"},
    {"int", Seen::unknown, "; did you mean 'math.floor'?"},
    {"float", Seen::unknown, "; did you mean 'tonumber'?"},
    {"ln", Seen::unknown, "; did you mean 'math.log'?"},
    {"log10", Seen::unknown, "; did you mean 'math.log(x, 10)'?"},
    {"log2", Seen::unknown, "; did you mean 'math.log(x, 2)'?"},
    {"printf|fprintf", Seen::unknown, "; a format is filled by string.format: print(string.format(\"%.3f\", x))"},
    {"sprintf", Seen::unknown, "; did you mean 'string.format'?"},
    {"round", Seen::unknown, "; rounding is math.floor(x + 0.5), or string.format(\"%.3f\", x)"},
    {"abs", Seen::unknown, "; did you mean 'math.abs', or of a vector v:abs()?"},
    {"append", Seen::unknown, "; appending is list[#list + 1] = x"},
    {"enumerate", Seen::unknown, "; a loop over a list is: for i, x in ipairs(list) do ... end"},
    {"np", Seen::unknown, "; vectors are made by vector.linspace, vector{ ... }; see ?vector"},
    {"input", Seen::unknown, "; input is read by io.read()"},
    {"ayuda", Seen::unknown, "; help() starts a tour, ?name explains a name"},
    {"exit|quit|bye|salir", Seen::unknown, "; os.exit() ends a script, :quit or Ctrl-D a session"},
    {"zeros", Seen::unknown, "; n zeros are vector.linspace(0, 0, n)"},
    {"ones", Seen::unknown, "; n ones are vector.linspace(1, 1, n)"},
    {"lsim|ode45|solve_ivp|odeint", Seen::unknown, "; a run is made by sys:simulate{ M = M, t_end = 20 }"},
    {"fft", Seen::unknown, "; a spectrum is run:spectrum()"},
    {"bode", Seen::unknown,
     "; a response curve is sys:response{ over = { frequency = vector.linspace(0.1, 2, 200) } }"},
    {"title", Seen::unknown, "; a title is an option: plot{ { x, y }, title = \"...\" }"},
    {"xlabel|ylabel|legend", Seen::unknown,
     "; labels are options: plot{ { x, y, label = \"a\" }, xlabel = \"t\", ylabel = \"theta\" }"},
    {"plt", Seen::unknown, "; a plot is plot(x, y), or run:plot()"},
    {"pd", Seen::unknown, "; a CSV file is read by load(\"file.csv\")"},
    {"tic|toc", Seen::unknown, "; :time code prints the time that code takes"},
    {"dir", Seen::unknown,
     "; Tab after a name and a point lists its fields, help(name) explains them, :who lists variables"},
    {"save", Seen::unknown, "; a run is saved by run:save(\"run.csv\")"},
    {"exit|quit|q|bye|logout|ende|beenden|salir|quitter|esci", Seen::typed, "; :quit or Ctrl-D leaves"},
    {"clear|cls|clc", Seen::typed, "; Ctrl-L clears the screen, :reset forgets your variables"},
    {"who|whos|dir", Seen::typed,
     "; :who lists your variables; Tab after a name and a point lists its fields, help(name) explains them"},
    {"_", Seen::typed, "; ans holds the last value that was computed"},
    {"ls", Seen::typed, "; :ls lists the files of the current folder"},
    {"cd|pwd", Seen::typed, "; :cd folder changes the current folder, :pwd shows it"},
    {"man", Seen::typed, "; help \"name\" explains a name"},
    {"history", Seen::typed,
     "; the up arrow brings earlier lines back, Ctrl-R searches them, and :save writes them to a script"},
    {"save", Seen::typed, "; :save lab.lua writes your inputs to a script, run:save(\"run.csv\") writes a run"},
    {"reset", Seen::typed, "; :reset forgets your variables"},
    {"hilfe|ayuda|aide|aiuto|hallo|hello|hola", Seen::typed, "; help() starts a tour, and ?name explains a name"},
    {"1 : 1 : 1", Seen::first, "; evenly spaced values are vector.range(0, 1, 0.1) or vector.linspace(0, 1, 11)"},
    {"^ % %", Seen::first, "; dinal has no magic commands; :time code prints the time that code takes"},
    {"^ % matplotlib", Seen::first, "; dinal has no magic commands: run:plot() shows its picture in the page"},
    {"load n .", Seen::first, "; write the name of a file in quotes: load \"file.csv\""},
    {"[ end ]", Seen::first, last_cure},
    {"( end )", Seen::first, last_cure},
    {". *|/|^", Seen::first, "; * / and ^ act on each element of a vector"},
    {"[ 1 :", Seen::first, slice_cure},
    {"[ :", Seen::first, slice_cure},
    {"[ - 1 :", Seen::first, slice_cure},
    {"lambda n|:", Seen::first, lambda_cure},
    {"if|elseif|while|and|or n = >", Seen::first, "; in Lua 'at least' is >="},
    {"n = >", Seen::first, lambda_cure},
    {"< >", Seen::first, "; in Lua 'not equal' is ~="},
    {"1 for n in", Seen::first,
     "; a list is filled by a loop: for i = 1, 10 do list[i] = i^2 end; a vector by v:map(function(x) return x^2 end)"},
    {"^ hash n", Seen::running, "; a comment begins with --"},
    {"s %", Seen::running, format_cure},
    {"f s", Seen::running, format_cure},
    {".|: append", Seen::running, "; appending is list[#list + 1] = x; vectors are joined by v .. w"},
    {". shape", Seen::running, "; the length of a vector, list or run is #v"},
    {"* *", Seen::first, "; a power is x^2"},
    {"^ >", Seen::first, "; leave out the prompt > that stands in front"},
    {"^ >>", Seen::first, "; leave out the prompt >> that stands in front"},
    {"check ( #", Seen::first, question_cure},
    {"check #", Seen::first, question_cure},
    {"def|func|fn 1", Seen::first, "; a function is written: function f(x) return 2*x end"},
    {"var|let|const|int|float|double|global 1", Seen::first, "; a variable needs no word before it: x = 1"},
    {"import|from|using|include 1", Seen::first,
     "; math and all of dinal are there already, other modules come with require"},
    {"elif|elsif w", Seen::first, "; did you mean 'elseif'?"},
    {"DO 1", Seen::first, loop_cure},
    {"CALL 1", Seen::first, "; a call needs parentheses and no word before it: f(x)"},
    {"PRINT w", Seen::first, print_cure},
    {"^ PRINT|WRITE", Seen::first, print_cure},
    {"^ cd w", Seen::first, folder_cure},
    {"^ cd /", Seen::running, folder_cure},
    {"^ ls w|*", Seen::first, files_cure},
    {"^ ls -|/", Seen::running, files_cure},
    {"clear w", Seen::first, "; :reset deletes your variables"},
    {"close w", Seen::first, "; nothing needs to be closed: each plot is a picture of its own"},
    {"hold w", Seen::first, "; several curves are one picture: plot{ { x, y }, { x, z } }"},
    {"save w", Seen::first, "; a run is saved by run:save(\"run.csv\"), your inputs by :save lab.lua"},
    {"help w", Seen::first, "; write ?name, or help \"name\""},
    {"n : =", Seen::last, "; assigning is ="},
    {"n : #|s", Seen::last, "; a named value is written with =, I = 1"},
    {"for (", Seen::last, loop_cure},
    {"^ n ( n ) =", Seen::last, "; a function is written: {n} = function(t) return ... end"},
    {"== =", Seen::last, "; comparing is =="},
    {"n #", Seen::between, "; is an operator missing there, such as *, or ( ), as in f({#})?"},
    {"# 1", Seen::between, "; is an operator missing there, such as *?"},
    {") {", Seen::last, "; a block has no braces and ends with end"},
};

constexpr std::array<std::string_view, 8> file_endings = {"csv", "dat", "txt", "svg", "png", "pdf", "gp", "lua"};

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
           : wanted == "s"    ? token.kind == lua::TokenKind::string
                              : token.is(wanted);
}

/// The cure if the pattern matches at this place.
std::string cure_at(const std::vector<lua::Token>& all, std::size_t place, const Habit& one) {
    std::string_view pattern = one.pattern;
    if (pattern.starts_with("^ ")) {
        if (place > 0) return "";
        pattern.remove_prefix(2);
    }
    std::string cure(one.cure);
    for (; !pattern.empty(); ++place) {
        const std::string_view word = pattern.substr(0, pattern.find(' '));
        if (place >= all.size() || !fits(all[place], word)) return "";
        const std::string mark = fmt::format("{{{}}}", word);
        if (const std::size_t at = cure.find(mark); at != std::string::npos)
            cure.replace(at, mark.size(), all[place].text);
        pattern.remove_prefix(std::min(word.size() + 1, pattern.size()));
    }
    return cure;
}

/// Remark on a decimal comma, which Lua reads as two values; empty if none.
std::string decimal_comma(std::string_view statement) {
    const std::vector<lua::Token> all = lua::tokens(statement);
    for (std::size_t i = 3; i < all.size(); ++i) {
        const bool close = all[i - 2].end() + 1 == all[i].at;
        if (all[i].kind == lua::TokenKind::number && all[i - 1].is(",") && all[i - 2].kind == lua::TokenKind::number &&
            (all[i - 3].is("=") || (close && (all[i - 3].is(",") || all[i - 3].is("("))))) {
            return "; a decimal point is a point: " + std::string(all[i - 2].text) + "." + std::string(all[i].text);
        }
    }
    return "";
}

/// Remark on missing quotes: run:save(run.csv). `name` is the missing variable.
std::string file_without_quotes(std::string_view name, std::string_view statement) {
    const std::vector<lua::Token> all = lua::tokens(statement);
    for (std::size_t i = 2; i < all.size(); ++i) {
        const bool ending = text::contains(file_endings, all[i].text);
        if (ending && all[i - 1].is(".") && all[i - 2].kind == lua::TokenKind::name &&
            (all[i].text == name || all[i - 2].text == name)) {
            return "; write the name of a file in quotes: \"" + std::string(all[i - 2].text) + "." +
                   std::string(all[i].text) + "\"";
        }
    }
    return "";
}

/// Remark on a number, a string or a list that is called.
std::string called_value(lua_State* L, const lua::LuaMessage& message) {
    if (message.kind == "global" && lua::is_overwritten(L, message.name) && lua::is_of_dinal(L, message.name)) {
        const std::string name(message.name);
        return "; " + name + " is a name of dinal, but now has another value: " + name + " = dinal." + name +
               " restores it";
    }
    if (message.kind == "for iterator") {
        return message.type == "number" ? "; counting is: for i = 1, 10 do"
                                        : "; going through a list is: for i, x in ipairs(list) do";
    }
    if (message.type == "vector" || message.type == "table") {
        return "; its elements are in brackets: v[1]";
    }
    if (message.kind == "global" && message.type == message.name) {
        return fmt::format("; it is a module: help({}) lists its functions", message.name);
    }
    const bool simple = message.type == "number" || message.type == "string" || message.type == "boolean";
    return simple ? "; it is a value and no function: leave out the parentheses" : "";
}

/// Remark on run.energy.total: a field is read from a function that should be called.
std::string uncalled_function(lua_State* L, const lua::LuaMessage& message, std::string_view statement) {
    const std::vector<lua::Token> all = lua::tokens(statement);
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

/// Remark on functions of Lua that safe mode lacks.
std::string left_out_in_safe_mode(const lua::LuaMessage& message, std::string_view statement) {
    if (!lua::safe_mode() || message.type != "nil") {
        return "";
    }
    if (message.kind == "global" && (message.name == "dofile" || message.name == "loadfile")) {
        return "; safe mode has no " + std::string(message.name) + ": a script is one file";
    }
    const std::vector<lua::Token> all = lua::tokens(statement);
    for (std::size_t i = 2; i < all.size(); ++i) {
        if (!all[i].is(message.name) || !all[i - 1].is(".")) {
            continue;
        }
        const std::string_view library = all[i - 2].text;
        if (library == "io") {
            return "; safe mode has no io." + std::string(message.name) +
                   ": load reads files, and save methods write them";
        }
        if (library == "os" || library == "debug" || library == "string" || library == "package") {
            return "; safe mode leaves it out: see docs/safe-mode.md";
        }
    }
    return "";
}

bool is_number(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789.") == std::string_view::npos;
}

}  // namespace

std::string foreign_tokens(std::string_view statement, Seen seen) {
    const std::vector<lua::Token> all = lua::tokens(statement);
    for (const Habit& one : habits) {
        for (std::size_t i = 0; one.seen == seen && i < all.size(); ++i) {
            if (std::string cure = cure_at(all, i, one); !cure.empty()) return cure;
        }
    }
    return "";
}

std::string running_habit(const text::Error& error, std::string_view statement) {
    if (error.option.empty() && is_number(error.culprit)) {
        return decimal_comma(statement);
    }
    if (error.culprit == "append" || error.culprit == "shape") {
        return foreign_tokens(statement, Seen::running);
    }
    return file_without_quotes(error.culprit, statement);
}

std::string running_habit(lua_State* L, const lua::LuaMessage& message, std::string_view statement) {
    if (std::string reason = left_out_in_safe_mode(message, statement); !reason.empty()) {
        return reason;
    }
    if (message.words.starts_with("attempt to mod a 'string'")) {
        return std::string(format_cure);
    }
    const bool of_nil_or_text = message.type == "nil" || message.type == "string";
    if (std::string cure = of_nil_or_text ? foreign_tokens(statement, Seen::running) : ""; !cure.empty()) {
        return cure;
    }
    if (message.words.starts_with("attempt to perform bitwise operation")) {
        return "; in Lua and, or and not are words; several conditions are v[v:find(function(x) return x > 0 and x < 1 end)]";
    }
    if (message.calculates && message.type == "row") {
        return "; a row has several values, of which one is meant, as in run.events[1].theta";
    }
    if (message.calculates && message.type == "table") {
        const std::string name(message.name.empty() ? "list" : message.name);
        return "; a table has no arithmetic, a vector has: vector(" + name + ")";
    }
    if (message.adds_texts) {
        return "; texts are joined with ..";
    }
    if (message.calls) {
        return called_value(L, message);
    }
    if (message.type == "function" && !message.calculates) {
        return uncalled_function(L, message, statement);
    }
    return file_without_quotes(message.name, statement);
}

// Habits from other languages that do not compile. A rule compares the message, the rejected token and the one before
// it.

namespace {

using Cure = std::pair<std::string_view, std::string_view>;

/// Lua's complaint ("" for any), and the rejected word ("" for any).
struct Symptom {
    std::string_view complaint;
    std::string_view near;
    std::string_view cure;
};

constexpr std::array<Symptom, 25> symptoms = {{
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
    {"'then' expected", "{", "; in Lua: if x > 3 then ... end"},
    {"'then' expected", ":", "; in Lua: if x > 3 then ... end"},
    {"'then' expected", "is", "; comparing is =="},
    {"'do' expected", "=", "; comparing is =="},
    {"'do' expected", "", "; a loop is: for i = 1, 10 do ... end, or: while x < 3 do ... end"},
    {"',' expected", ":", "; a loop is: for i = 1, 10 do ... end"},
    {"')' expected", "=", "; write named options in braces: system{ I = 1, k = 4 }"},
    {"unfinished string", "", "; its closing quote is missing"},
    {"'}' expected", "", "; is a comma missing there?"},
}};

/// Typographic characters that replace those of Lua.
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

/// The message with the rejected token and its context.
struct Stumble {
    const lua::SyntaxMessage& message;
    std::vector<lua::Token> all = {};
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
            return "; instead of " + std::string(sign) + " write " + std::string(meant);
        }
    }
    return "; names and signs of Lua are in plain letters: theta, pi, omega";
}

/// How the function on the top of the stack is called: with braces for options, or parentheses.
std::string called_as(lua_State* L, std::string_view name) {
    const lua::Documented found = lua::documented(L, -1);
    const lua::Doc* doc = found.member != nullptr ? &found.member->doc : nullptr;
    const std::string_view signature = doc != nullptr ? std::string_view(doc->signature) : std::string_view();
    const std::size_t bracket = signature.find_first_of("({");
    const bool braces = bracket != std::string_view::npos && signature[bracket] == '{';
    return braces ? "; write its options in braces: " + std::string(name) + "{ ... }"
                  : "; a call needs parentheses: " + std::string(name) + "(...)";
}

/// How a global function is called; "" if there is none.
std::string call_of_global(lua_State* L, std::string_view name) {
    std::string call = lua::push_global(L, name) == LUA_TFUNCTION ? called_as(L, name) : "";
    lua_pop(L, 1);
    return call;
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
          foreign_tokens(statement, Seen::last), expression ? foreign_tokens(statement, Seen::between) : ""}) {
        if (!advice.empty()) {
            return advice;
        }
    }
    if (message.opened == "{") {
        return "; is a comma missing there, or a brace?";
    }
    const auto* const symptom = std::ranges::find_if(symptoms, [&message](const Symptom& s) {
        return (s.complaint.empty() || s.complaint == message.complaint) && (s.near.empty() || s.near == message.near);
    });
    return symptom == symptoms.end() ? "" : std::string(symptom->cure);
}

}  // namespace dinal::errors
