#include "errors/habits.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "errors/misspelling.hpp"
#include "lua/safe_mode.hpp"
#include "lua/standard_globals.hpp"
#include "lua/tokens.hpp"

namespace dinal::errors {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 51> foreign_names = {{
    {"echo", "; did you mean 'print'?"},
    {"disp", "; did you mean 'print'?"},
    {"display", "; did you mean 'print'?"},
    {"puts", "; did you mean 'print'?"},
    {"println", "; did you mean 'print'?"},
    {"True", "; did you mean 'true'?"},
    {"False", "; did you mean 'false'?"},
    {"None", "; did you mean 'nil'?"},
    {"null", "; did you mean 'nil'?"},
    {"NULL", "; did you mean 'nil'?"},
    {"t", "; a value that depends on t is a function: function(t) return 2*t end"},
    {"range", "; a loop is: for i = 1, 10 do ... end"},
    {"len", "; the length of x is #x"},
    {"length", "; the length of x is #x"},
    {"str", "; did you mean 'tostring'?"},
    {"int", "; did you mean 'math.floor'?"},
    {"float", "; did you mean 'tonumber'?"},
    {"ln", "; did you mean 'math.log'?"},
    {"log10", "; did you mean 'math.log(x, 10)'?"},
    {"log2", "; did you mean 'math.log(x, 2)'?"},
    {"printf", "; a format is filled by string.format: print(string.format(\"%.3f\", x))"},
    {"sprintf", "; did you mean 'string.format'?"},
    {"round", "; rounding is math.floor(x + 0.5), or string.format(\"%.3f\", x)"},
    {"abs", "; did you mean 'math.abs', or of a vector v:abs()?"},
    {"append", "; appending is list[#list + 1] = x"},
    {"enumerate", "; a loop over a list is: for i, x in ipairs(list) do ... end"},
    {"np", "; vectors are made by vector.linspace, vector{ ... }; see ?vector"},
    {"input", "; input is read by io.read()"},
    {"exit", "; os.exit() ends a script, :quit or Ctrl-D a session"},
    {"quit", "; os.exit() ends a script, :quit or Ctrl-D a session"},
    {"bye", "; os.exit() ends a script, :quit or Ctrl-D a session"},
    {"fprintf", "; a format is filled by string.format: print(string.format(\"%.3f\", x))"},
    {"zeros", "; n zeros are vector.linspace(0, 0, n)"},
    {"ones", "; n ones are vector.linspace(1, 1, n)"},
    {"size", "; the length of x is #x"},
    {"numel", "; the length of x is #x"},
    {"lsim", "; a run is made by sys:simulate{ M = M, t_end = 20 }"},
    {"ode45", "; a run is made by sys:simulate{ M = M, t_end = 20 }"},
    {"solve_ivp", "; a run is made by sys:simulate{ M = M, t_end = 20 }"},
    {"odeint", "; a run is made by sys:simulate{ M = M, t_end = 20 }"},
    {"fft", "; a spectrum is run:spectrum()"},
    {"bode", "; a response curve is sys:response{ over = { frequency = vector.linspace(0.1, 2, 200) } }"},
    {"title", "; a title is an option: plot{ { x, y }, title = \"...\" }"},
    {"xlabel", "; labels are options: plot{ { x, y, label = \"a\" }, xlabel = \"t\", ylabel = \"theta\" }"},
    {"ylabel", "; labels are options: plot{ { x, y, label = \"a\" }, xlabel = \"t\", ylabel = \"theta\" }"},
    {"legend", "; labels are options: plot{ { x, y, label = \"a\" }, xlabel = \"t\", ylabel = \"theta\" }"},
    {"plt", "; a plot is plot(x, y), or run:plot()"},
    {"pd", "; a CSV file is read by load(\"file.csv\")"},
    {"tic", "; :time code prints the time that code takes"},
    {"toc", "; :time code prints the time that code takes"},
    {"save", "; a run is saved by run:save(\"run.csv\")"},
}};

/// What tokens say in other languages. A word of a pattern is a token; n stands for any name, 1 for any name or number,
/// s for a string, ^ for the beginning.
struct ForeignTokens {
    std::string_view pattern;
    bool compiles;  // so Lua complains of it only when it runs
    std::string_view cure;
};
constexpr std::string_view slice_cure =
    "; a part of a vector is v:slice(first, last), of a list table.unpack(list, first, last)";
constexpr std::string_view lambda_cure = "; a function is written: function(x) return 2*x end";
constexpr std::string_view format_cure = "; values go into a text by string.format(\"x = %.3f\", x)";
constexpr std::string_view append_cure = "; appending is list[#list + 1] = x; vectors are joined by v .. w";
constexpr std::string_view last_cure = "; the last element of v is v[#v]";
constexpr std::string_view elements_cure = "; * / and ^ act on each element of a vector";
constexpr std::string_view conditions_cure =
    "; in Lua and, or and not are words; several conditions are v[v:find(function(x) return x > 0 and x < 1 end)]";
constexpr std::array<ForeignTokens, 24> foreign = {{
    {"1 : 1 : 1", false, "; evenly spaced values are vector.range(0, 1, 0.1) or vector.linspace(0, 1, 11)"},
    {"^ % %", false, "; dinal has no magic commands; :time code prints the time that code takes"},
    {"^ % matplotlib", false, "; dinal has no magic commands: run:plot() shows its picture in the page"},
    {"^ ! n", false, "; dinal has no shell commands"},
    {"load n .", false, "; write the name of a file in quotes: load \"file.csv\""},
    {"[ end ]", false, last_cure},
    {"( end )", false, last_cure},
    {". *", false, elements_cure},
    {". /", false, elements_cure},
    {". ^", false, elements_cure},
    {"[ 1 :", false, slice_cure},
    {"[ : ", false, slice_cure},
    {"[ - 1 :", false, slice_cure},
    {"lambda n", false, lambda_cure},
    {"lambda :", false, lambda_cure},
    {"n =>", false, lambda_cure},
    {"< >", false, "; in Lua 'not equal' is ~="},
    {"1 for n in", false,
     "; a list is filled by a loop: for i = 1, 10 do list[i] = i^2 end; a vector by v:map(function(x) return x^2 end)"},
    {"^ # n", true, "; a comment begins with --"},
    {"s %", true, format_cure},
    {"f s", true, format_cure},
    {". append", true, append_cure},
    {": append", true, append_cure},
    {". shape", true, "; the length of a vector, list or run is #v"},
}};

constexpr std::array<std::string_view, 8> file_endings = {"csv", "dat", "txt", "svg", "png", "pdf", "gp", "lua"};

bool fits(const lua::Token& token, std::string_view wanted) {
    const bool name = token.kind == lua::TokenKind::name;
    if (wanted == "n") return name;
    if (wanted == "1") return name || token.kind == lua::TokenKind::number;
    if (wanted == "s") return token.kind == lua::TokenKind::string;
    return token.is(wanted);
}

bool fits_at(const std::vector<lua::Token>& all, std::size_t place, std::string_view pattern) {
    if (pattern.starts_with("^ ")) {
        if (place > 0) return false;
        pattern.remove_prefix(2);
    }
    while (!pattern.empty()) {
        const std::string_view word = pattern.substr(0, pattern.find(' '));
        if (place >= all.size() || !fits(all[place], word)) return false;
        pattern.remove_prefix(std::min(word.size() + 1, pattern.size()));
        ++place;
    }
    return true;
}

/// "k = 0,5" in braces is two entries of a table, f(1,43) two arguments.
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

/// run:save(run.csv); `name` is what was not found.
std::string file_without_quotes(std::string_view name, std::string_view statement) {
    const std::vector<lua::Token> all = lua::tokens(statement);
    for (std::size_t i = 2; i < all.size(); ++i) {
        const bool ending = std::find(file_endings.begin(), file_endings.end(), all[i].text) != file_endings.end();
        if (ending && all[i - 1].is(".") && all[i - 2].kind == lua::TokenKind::name &&
            (all[i].text == name || all[i - 2].text == name)) {
            return "; write the name of a file in quotes: \"" + std::string(all[i - 2].text) + "." +
                   std::string(all[i].text) + "\"";
        }
    }
    return "";
}

/// A number, a string, a list that is called.
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
    const bool simple = message.type == "number" || message.type == "string" || message.type == "boolean";
    return simple ? "; it is a value and no function: leave out the parentheses" : "";
}

/// run.energy.total: a function in which something is looked for, where what it gives was meant.
std::string uncalled_function(lua_State* L, const lua::LuaMessage& message, std::string_view statement) {
    const std::vector<lua::Token> all = lua::tokens(statement);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i].is(message.name)) continue;
        std::string name(message.name);
        if (i > 1 && all[i - 1].is(".")) {
            push_variable(L, nullptr, all[i - 2].text);
            name.insert(0, std::string(all[i - 2].text) + (lua_isuserdata(L, -1) != 0 ? ":" : "."));
            lua_pop(L, 1);
        }
        return "; " + name + " is a function: call it first";
    }
    return "";
}

/// What Lua has and safe mode has not.
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

std::string foreign_tokens(std::string_view statement, bool compiles) {
    const std::vector<lua::Token> all = lua::tokens(statement);
    for (const ForeignTokens& one : foreign) {
        for (std::size_t i = 0; one.compiles == compiles && i < all.size(); ++i) {
            if (fits_at(all, i, one.pattern)) return std::string(one.cure);
        }
    }
    return "";
}

std::string running_habit(const text::Error& error, std::string_view statement) {
    if (error.option.empty() && is_number(error.culprit)) {
        return decimal_comma(statement);
    }
    if (error.culprit == "append" || error.culprit == "shape") {
        return foreign_tokens(statement, true);
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
    if (std::string cure = of_nil_or_text ? foreign_tokens(statement, true) : ""; !cure.empty()) {
        return cure;
    }
    if (message.words.starts_with("attempt to perform bitwise operation")) {
        return std::string(conditions_cure);
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

std::string foreign_name(std::string_view name) {
    const auto* const found =
        std::find_if(foreign_names.begin(), foreign_names.end(), [name](const auto& n) { return n.first == name; });
    return found == foreign_names.end() ? "" : std::string(found->second);
}

}  // namespace dinal::errors
