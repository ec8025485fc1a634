#include "help/help_text.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "help/library.hpp"
#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "lua/standard_globals.hpp"
#include "terminal/display.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::help {

namespace {

std::size_t text_width(const terminal::Display& screen) {
    return std::min(screen.width - 1, text::readable_width);
}

std::string first_sentence(std::string_view summary) {
    const std::size_t stop = summary.find(". ");
    return std::string(stop == std::string_view::npos ? summary : summary.substr(0, stop + 1));
}

/// A line of Lua in rows of `width`: broken before -->, otherwise between tokens.
std::string code_in_rows(std::string_view line, std::size_t width) {
    constexpr std::size_t indent = 4;
    std::string rows;
    for (std::size_t room = width; text::columns(line) > room; room = width - indent) {
        const std::size_t arrow = line.find("-->");
        std::size_t cut = arrow != std::string_view::npos && arrow > 0 ? arrow : 0;
        if (cut == 0 || cut > room) {
            cut = 0;
            for (const lua::Token& token : lua::tokens(line)) {
                const bool fits = token.end() <= room && token.end() < line.size() && line[token.end()] == ' ';
                cut = fits ? token.end() : cut;
            }
        }
        if (cut == 0) {
            break;
        }
        const std::size_t end = line.find_last_not_of(' ', cut - 1) + 1;
        rows.append(line.substr(0, end)).append("\n").append(indent, ' ');
        line.remove_prefix(std::min(line.find_first_not_of(' ', cut), line.size()));
    }
    return rows.append(line);
}

std::string indented(std::string_view text, std::size_t width) {
    constexpr std::string_view margin = "    ";
    std::string result;
    for (const std::string_view line : text::split(text, '\n')) {
        const std::string rows = code_in_rows(line, width - margin.size());
        result.append(result.empty() ? "" : "\n").append(margin).append(text::indented(rows, margin.size()));
    }
    return result;
}

/// A name and its text: in two columns, or one below the other on a narrow screen.
std::string two_columns(std::string_view name, std::string_view about, std::size_t indent,
                        const terminal::Display& screen) {
    const std::size_t width = text_width(screen);
    const bool narrow = width < indent + 24;
    const bool below = narrow || name.size() + 3 > indent;
    const std::size_t margin = narrow ? 4 : indent;
    const std::string text = text::indented(text::wrapped(about, width - margin), margin);
    return below ? fmt::format("  {}\n{:{}}{}\n", name, "", margin, text)
                 : fmt::format("  {:<{}} {}\n", name, indent - 3, text);
}

std::string options_text(const lua::Doc& doc, const terminal::Display& screen) {
    constexpr std::size_t widest_name = 24;
    std::string text;
    for (const text::Call* call : calls_of(doc)) {
        const std::vector<OptionLine> lines = option_lines(call->options);
        std::size_t indent = 0;
        for (const OptionLine& line : lines) indent = std::max(indent, std::min(line.name.size(), widest_name) + 4);
        if (!lines.empty()) text += "\n";
        for (const OptionLine& line : lines) text += two_columns(line.name, line.meaning, indent, screen);
    }
    return text;
}

std::string doc_text(const lua::Doc& doc, const terminal::Display& screen) {
    const std::size_t width = text_width(screen);
    return terminal::spelled(
        fmt::format("{}\n\n{}\n{}\n{}\n", text::wrapped(signature(doc), width), text::wrapped(doc.summary, width),
                    options_text(doc, screen), indented(doc.example, width)),
        screen);
}

/// Returns whether the text contains the name as a whole name.
bool mentions(std::string_view text, std::string_view name) {
    for (std::size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
        const std::size_t end = at + name.size();
        const bool begins =
            at == 0 || (!text::is_name_char(text[at - 1]) && text[at - 1] != '.' && text[at - 1] != ':');
        if (begins && (end == text.size() || !text::is_name_char(text[end]))) {
            return true;
        }
    }
    return false;
}

class Names {
public:
    void add(const std::string& name) {
        constexpr std::size_t most = 5;
        if (list.size() < most && !text::contains(list, name)) {
            list.push_back(name);
        }
    }
    std::vector<std::string> list;
};

/// Returns whether a name is specific enough for a mention to count: not a single plain word such as "system" or "v".
bool is_specific(std::string_view name) {
    return name.find_first_of(".:") != std::string_view::npos;
}

}  // namespace

std::string written_name(const Section& section, const lua::Member& member) {
    const std::string_view prefix = section.prefix;
    const std::string_view separator = prefix.empty() ? "" : member.kind == lua::Kind::method ? ":" : ".";
    return fmt::format("{}{}{}", prefix, separator, member.name);
}

std::string listed_name(const Section& section, const lua::Member& member) {
    if (member.kind == lua::Kind::metamethod) {
        const std::string_view signature = member.doc.signature;
        return std::string(signature.substr(0, signature.find(" ->")));
    }
    return written_name(section, member);
}

// Names that the entry mentions, its result's class, entries that mention it, and its neighbours; derived, so that no
// list needs maintenance.
std::vector<std::string> see_also(const Section& section, const lua::Member& member) {
    Names names;
    const std::string own = written_name(section, member);
    std::vector<std::string> mentioning;
    std::vector<std::string> alike;  // members after this one, followed by those before it
    std::size_t before = 0;
    for (const Section& other_section : sections()) {
        for (const lua::Member& other : other_section.description->members) {
            const std::string name = written_name(other_section, other);
            if (other.kind == lua::Kind::metamethod || name == own) {
                continue;
            }
            if (is_specific(name) && mentions(member.doc.summary, name)) {
                names.add(name);
            } else if (is_specific(own) && mentions(other.doc.summary, own)) {
                mentioning.push_back(name);
            } else if (&section == &other_section && other.kind == member.kind) {
                alike.push_back(name);
                before += &other < &member ? 1U : 0U;
            }
        }
    }
    const Section* result = section_of_result(member.doc.signature);
    if (result != nullptr && result->description != section.description) {
        names.add(result->description->name);
    }
    std::for_each(mentioning.begin(), mentioning.end(), [&names](const std::string& name) { names.add(name); });
    std::rotate(alike.begin(), alike.begin() + static_cast<std::ptrdiff_t>(before), alike.end());
    constexpr std::size_t enough = 3;
    for (std::size_t i = 0; i < alike.size() && names.list.size() < enough; ++i) {
        names.add(alike[i]);
    }
    return names.list;
}

std::string member_text(const Section& section, const lua::Member& member, const terminal::Display& screen) {
    std::string text = doc_text(member.doc, screen);
    if (const auto names = see_also(section, member); !names.empty()) {
        text += "\n" + text::wrapped(fmt::format("See also: {}", fmt::join(names, ", ")), text_width(screen)) + "\n";
    }
    return text;
}

std::string line_about(std::string_view name, std::string_view summary, const terminal::Display& screen) {
    return terminal::spelled(two_columns(name, first_sentence(summary), 28, screen), screen);
}

std::string class_text(const Section& section, const terminal::Display& screen) {
    std::string text = doc_text(section.description->doc, screen) + "\n";
    for (const lua::Member& member : section.description->members) {
        text += line_about(listed_name(section, member), member.doc.summary, screen);
    }
    return text;
}

namespace {

std::string text_about(const lua::Documented& found, const terminal::Display& screen) {
    std::string text;
    for (const Section& section : sections()) {
        if (section.description == found.owner) {
            text += found.member != nullptr ? member_text(section, *found.member, screen) : class_text(section, screen);
        }
    }
    return text;
}

std::string text_about_page(lua_State* L) {
    const lua_Integer page = lua_tointeger(L, 1);
    const auto last = static_cast<lua_Integer>(tour_pages());
    return page >= 1 && page <= last ? tour_page(static_cast<std::size_t>(page))
                                     : "the tour has pages 1 to " + std::to_string(last) + "\n";
}

/// "math.sin" for that Lua function, "" for other values.
std::string name_in_lua(lua_State* L, int index) {
    for (const std::string_view word : lua_words()) {
        const int top = lua_gettop(L);
        const std::size_t dot = word.find('.');
        lua_pushglobaltable(L);
        lua_pushlstring(L, word.data(), std::min(dot, word.size()));
        lua_rawget(L, -2);
        if (dot != std::string_view::npos && lua_istable(L, -1)) {
            lua_pushlstring(L, word.data() + dot + 1, word.size() - dot - 1);
            lua_rawget(L, -2);
        }
        const bool same = !lua_isnil(L, -1) && lua_rawequal(L, index, -1) != 0;
        lua_settop(L, top);
        if (same) return std::string(word);
    }
    return "";
}

std::string text_about_value(lua_State* L, const terminal::Display& screen) {
    if (lua_isnone(L, 1)) {
        return tour_page(1);
    }
    if (lua_isnil(L, 1)) {
        // help(undefined_name) also arrives here.
        return "nil has no help; put the name in quotes: help \"simulate\"\n";
    }
    if (lua_type(L, 1) == LUA_TSTRING) {
        const std::string_view words = lua_tostring(L, 1);
        return words.find_first_not_of(' ') == std::string_view::npos ? tour_page(1) : help_about(words, screen);
    }
    if (lua_isinteger(L, 1) != 0) {
        return text_about_page(L);
    }
    lua::push_dinal_table(L);
    const bool is_library = lua_rawequal(L, 1, -1) != 0;
    lua_pop(L, 1);
    if (is_library) {
        return help_about("contents", screen);
    }
    if (const lua::Documented found = lua::documented(L, 1); found.owner != nullptr) {
        return text_about(found, screen);
    }
    if (const std::string name = name_in_lua(L, 1); !lua_word(name).empty()) {
        return lua_word(name);
    }
    return lua::describe(L, 1) + " has no help of its own; put the name in quotes: help \"omega0\"\n";
}

int help(lua_State* L) {
    const std::string text = text_about_value(L, terminal::display_of(STDOUT_FILENO));
    terminal::show_in_pages(text);
    return 0;
}

constexpr lua::Member functions[] = {
    {lua::a_function<help>,
     {"help(x) or help \"words\"",
      "Explains a function, method, module or object, or a name in quotes. Other words are searched for in all "
      "names and descriptions. help() starts a tour.",
      "help(excitation.step)\nhelp \"dead zone\""}},
};

}  // namespace

const lua::Class help_functions = {"help",
                                   {"help(x) or help \"words\"", "The manual at the prompt.", "help \"dead zone\""},
                                   functions,
                                   lua::add_functions};

namespace {

// Lines have at most 77 columns and pages 20 lines, for a terminal of 80 by 24. A test types all of them.
constexpr std::array<std::string_view, 6> pages = {
    R"(A mass on a spring, with viscous damping C and dry friction: Rd is the
torque while it slides, Re breakaway torque.

    > sys = system{ I = 1, k = 4*math.pi^2, C = 1.5, Rd = 16.5, Re = 18 }
    > sys

The names on the left are fields: sys.T0 is the natural period. Tab
completes names, and lists the options inside { }. The last value that was
computed is in ans; a name alone only shows what it holds.

help(sys) says more about it, help "dead zone" searches, ? is short for help,
and help "contents" lists all there is.
)",
    R"(The excitation is the torque M(t) on the mass: any function of Lua.

    > M = function(t) return 30*math.sin(2*math.pi*t) end

Ready-made terms add and scale, and know where they jump:

    > pulse = excitation.pulse{ at = 1.5, width = 0.2 }
    > 3*pulse + excitation.harmonic{ amplitude = 30, frequency = 1 }
)",
    R"(A run: the system, driven by M, from t = 0 to t_end, with a row every dt.

    > run = sys:simulate{ M = M, theta0 = 1, t_end = 20, dt = 0.01 }
    > run

Mind the colon. A wrong name is answered by the right one; try it:

    > sys:simulate{ M = M, theta_0 = 1, t_end = 20, dt = 0.01 }
)",
    R"(What is in a run: columns, events, and the motion between the rows.

    > run.theta
    > run.theta:max(), run.theta[1]
    > run.events
    > run:at(3.21)
    > run:plot()
    > run:explain()

turn: the motion reverses; stick: the mass stays; slip: it breaks away;
rest: it stops, and nothing can move it any more.
)",
    R"(Change one number and look again. A ; at the end hides the value.

    > for _, Rd in ipairs{ 5, 15, 25, 35 } do
    >   local s = sys:with{ Rd = Rd, Re = 1.1*Rd }
    >   local r = s:simulate{ M = M, theta0 = 1, t_end = 20, dt = 0.01 }
    >   print(Rd, #r.events, r.outcome)
    > end

A block goes on until its last end. The arrow up brings it back whole.
)",
    R"(Keep what you did:

    > run:save("run.csv")
    > :save "tour.lua"

run.csv begins with the Lua text that makes the run again, and tour.lua holds
what you typed as a script. :help lists such commands, :quit leaves.

That was all. Next: docs/tutorial.md, and examples/ with one idea each.
)"};

}  // namespace

std::size_t tour_pages() {
    return pages.size();
}

std::string tour_page(std::size_t page) {
    const std::string_view text = pages.at(page - 1);
    if (page == 1) {
        return fmt::format(
            "dinal, a laboratory for oscillators with dry friction. Here is a tour of two\n"
            "minutes: type the lines that stand after >, then help(2) for page 2 of {}.\n\n{}",
            pages.size(), text);
    }
    const std::string next = page < pages.size() ? fmt::format("\nhelp({}) is the next page.\n", page + 1) : "";
    return fmt::format("Page {} of {}\n\n{}{}", page, pages.size(), text, next);
}

namespace {

struct Word {
    std::string_view names;  // the first is Lua's spelling
    std::string_view signature;
    std::string_view meaning;
    std::string_view example;  // lines of Lua; their output, joined by ", ", follows -->
};

constexpr std::array<Word, 65> vocabulary = {{
    {"for loop loops", "for i = 1, 10 do ... end; for i, x in ipairs(list) do ... end",
     "Repeats a block for numbers, or for the elements of a list. A third number is the step: for i "
     "= 10, 1, -1.",
     "for i = 1, 3 do print(i*i) end  --> 1, 4, 9"},
    {"while", "while condition do ... end", "Repeats a block while the condition holds.",
     "x = 1 while x < 100 do x = 2*x end print(x)  --> 128"},
    {"repeat until", "repeat ... until condition", "Repeats a block until the condition holds; runs it at least once.",
     "x = 1 repeat x = 2*x until x > 100 print(x)  --> 128"},
    {"break", "break", "Leaves the innermost loop. Lua has no continue: put the rest of the block into an if.",
     "for i = 1, 10 do if i > 2 then break end print(i) end  --> 1, 2"},
    {"goto", "goto name ... ::name::", "Jumps to a label in the same function, for example to the end of a loop.",
     "for i = 1, 3 do if i == 2 then goto next end print(i) ::next:: end  --> 1, 3"},
    {"if then else elseif", "if condition then ... elseif condition then ... else ... end",
     "Chooses. Only nil and false count as false; 0 and \"\" count as true. Comparisons are == ~= < <= "
     "> >=.",
     "x = 3 if x > 2 then print \"large\" else print \"small\" end  --> large"},
    {"local", "local x = 1",
     "Makes a variable that exists only in its block: a script, a function, a loop. At the prompt "
     "each input is a block of its own, so leave local out there; in scripts use it.",
     "do local x = 1 print(x) end  --> 1"},
    {"function return", "function f(x) return 2*x end; f = function(x) return 2*x end",
     "Makes a function. It returns what follows return; without return it returns nil.",
     "f = function(x) return 2*x end print(f(4))  --> 8"},
    {"do end", "do ... end", "Begins a block; end closes do, then, function. Indentation means nothing.",
     "do print \"inside\" end  --> inside"},
    {"and or not", "a and b, a or b, not a",
     "Logic. \"x or 5\" is x, or 5 if x is nil or false; \"a and b or c\" is like Python's b if a else "
     "c.",
     "print(nil or 5, 3 > 2 and \"yes\" or \"no\")  --> 5\tyes"},
    {"nil", "nil", "The value of an undefined variable or a missing field. Python's None.",
     "print(undefined_name, ({}).field)  --> nil\tnil"},
    {"true false", "true, false", "The truth values. Comparisons return them.",
     "print(1 < 2, not true)  --> true\tfalse"},
    {"in", "for i, x in ipairs(list) do ... end", "Used in loops over a list (ipairs), a table (pairs) or data:rows().",
     "for i, x in ipairs{ \"a\", \"b\" } do print(i, x) end  --> 1\ta, 2\tb"},
    {"table tables list lists dict dictionary array", "list = { 10, 20 }; t = { I = 1, k = 4 }",
     "The one container of Lua: a list, counted from 1, or named fields, or both. #list is the "
     "length, list[#list + 1] = x appends. A table has no arithmetic: vector(list) has.",
     "list = { 10, 20 } list[#list + 1] = 30 print(list[1], #list)  --> 10\t3"},
    {"string strings text", "\"text\", 'text', [[text]]",
     "Text. .. joins, #s is the length in bytes, s:upper() and its like are methods; string.format "
     "puts in numbers.",
     "name = \"theta\" print(name .. \"0\", #name)  --> theta0\t5"},
    {"number numbers integer float", "1, 0.5, 1e-3, 2^10, 7 // 2, 7 % 3",
     "Numbers are integers or doubles; / always divides as doubles, // rounds down, ^ is the power, "
     "% the remainder.",
     "print(7/2, 7 // 2, 2^10)  --> 3.5\t3\t1024.0"},
    {"comment comments remark --", "-- a comment", "A comment runs from -- to the end of the line.",
     "print(1) -- not this  --> 1"},
    {"print", "print(a, b)", "Prints values with tabs between them. At the prompt a value alone is shown, too.",
     "print(1.5, \"rad\")  --> 1.5\trad"},
    {"type", "type(x) -> string",
     "The type of a value: number, string, table, function, nil, boolean or userdata (the objects of "
     "dinal).",
     "print(type(1), type{})  --> number\ttable"},
    {"pairs", "pairs(t)", "Loops over all fields of a table, in no particular order.",
     "for name, value in pairs{ k = 4 } do print(name, value) end  --> k\t4"},
    {"ipairs", "ipairs(list)", "Loops over a list from 1 to its end.",
     "for i, x in ipairs{ 5, 6 } do print(i, x) end  --> 1\t5, 2\t6"},
    {"tostring", "tostring(x) -> string", "The value as text, as print shows it.",
     "print(\"T0 = \" .. tostring(0.5))  --> T0 = 0.5"},
    {"tonumber", "tonumber(text) -> number", "The number that a text holds, or nil.",
     "print(tonumber \"0.5\" + 1, tonumber \"abc\")  --> 1.5\tnil"},
    {"error", "error(message)", "Stops with a message.", "print(pcall(error, \"stop\", 0))  --> false\tstop"},
    {"assert", "assert(value, message)", "Returns the value, or stops with the message if it is nil or false.",
     "print((assert(5, \"no value\")))  --> 5"},
    {"pcall", "pcall(f, ...) -> ok, result or message", "Calls a function and catches its errors: Python's try.",
     "print(pcall(function() return 5 end))  --> true\t5"},
    {"require", "require \"name\"", "Loads a module, a Lua file of that name. math and all of dinal are there already.",
     "print(require \"math\" == math)  --> true"},
    {"load", "load(text) -> function", "Makes a function of the text of a program.",
     "print(load \"return 6*7\" ())  --> 42"},
    {"dofile", "dofile \"file.lua\"", "Runs a script; its global variables stay.",
     "name = os.tmpname() io.open(name, \"w\"):write(\"x = 5\"):close() dofile(name) print(x)  --> 5"},
    {"select", "select(n, ...), select(\"#\", ...)", "The values from the n-th on, or how many there are.",
     "print(select(2, \"a\", \"b\", \"c\"))  --> b\tc"},
    {"math.sin math.cos math.tan", "math.sin(x), math.cos(x), math.tan(x) -> number",
     "Sine, cosine and tangent of a number in radians. Of a vector: v:sin().", "print(math.sin(math.pi/2))  --> 1.0"},
    {"math.asin math.acos math.atan math.atan2", "math.asin(x), math.acos(x), math.atan(y, x) -> number",
     "Inverse functions, in radians; math.atan(y, x) is the angle of the point (x, y).",
     "print(math.deg(math.atan(1, 1)))  --> 45.0"},
    {"math.exp math.log math.log10 math.pow math.ldexp math.frexp math.sinh math.cosh math.tanh",
     "math.exp(x), math.log(x), math.log(x, base) -> number",
     "Exponential function and logarithm, natural without a base. Of a vector: v:exp(), v:log().",
     "print(math.log(100, 10))  --> 2.0"},
    {"math.sqrt", "math.sqrt(x) -> number", "The square root. Of a vector: v:sqrt().", "print(math.sqrt(16))  --> 4.0"},
    {"math.abs", "math.abs(x) -> number", "The absolute value. Of a vector: v:abs().", "print(math.abs(-3))  --> 3"},
    {"math.max math.min", "math.max(a, b, ...), math.min(a, b, ...) -> number",
     "The greatest and the least of some numbers. Of a vector: v:max(), v:min().", "print(math.max(1, 5, 3))  --> 5"},
    {"math.floor math.ceil math.round round rounding", "math.floor(x), math.ceil(x) -> integer",
     "Rounds down, or up. Rounding to the nearest is math.floor(x + 0.5); to three digits: "
     "string.format(\"%.3f\", x).",
     "print(math.floor(2.7), math.ceil(2.2), math.floor(2.7 + 0.5))  --> 2\t3\t3"},
    {"math.pi", "math.pi", "3.14159...", "print(string.format(\"%.5f\", math.pi))  --> 3.14159"},
    {"math.huge", "math.huge", "Infinity, as for an event that never happens.", "print(-math.huge < 0)  --> true"},
    {"math.rad math.deg", "math.rad(degrees), math.deg(radians) -> number",
     "Degrees to radians and back. Angles in dinal are in radians.",
     "print(math.deg(math.pi), math.rad(180) == math.pi)  --> 180.0\ttrue"},
    {"math.random math.randomseed", "math.random(), math.random(n), math.random(m, n)",
     "A random number from 0 to 1, or a whole one. vector.random and vector.normal make many at "
     "once, with a seed.",
     "print(math.random() < 1)  --> true"},
    {"math.fmod math.modf math.tointeger math.type math.ult",
     "math.fmod(x, y), math.modf(x), math.tointeger(x), math.type(x)",
     "Remainder, whole and fractional part, conversion to an integer, \"integer\" or \"float\".",
     "print(math.fmod(7, 3), math.type(2))  --> 1\tinteger"},
    {"math.maxinteger math.mininteger", "math.maxinteger, math.mininteger", "The greatest and the least integer.",
     "print(math.maxinteger > 2^62)  --> true"},
    {"math", "math.NAME",
     "Lua's mathematics of numbers: sin, cos, tan, asin, acos, atan, exp, log, sqrt, abs, max, min, "
     "floor, ceil, rad, deg, random, pi, huge.",
     "print(math.sqrt(2)^2 > 1.99)  --> true"},
    {"string.format format f-string", "string.format(format, ...) -> string",
     "Puts values into a text, as Python's % does: %d whole number, %.3f three decimals, %g short, "
     "%s anything.",
     "print(string.format(\"T0 = %.3f s, %d turns\", 0.5, 3))  --> T0 = 0.500 s, 3 turns"},
    {"string.rep string.sub string.len string.upper string.lower string.reverse",
     "s:rep(n), s:sub(first, last), s:upper(), s:lower(), #s",
     "Repeats, cuts out, changes the case of a text. Positions are counted from 1; -1 is the last.",
     "print((\"theta\"):sub(1, 2), (\"ab\"):rep(3))  --> th\tababab"},
    {"string.find string.match string.gmatch string.gsub", "s:find(p), s:match(p), s:gmatch(p), s:gsub(p, new)",
     "Search and replace with patterns: %d a digit, %a a letter, . any character, + one or more, ( ) "
     "what is returned.",
     "print((\"run12.csv\"):match \"%d+\", (\"a-b\"):gsub(\"-\", \"_\"))  --> 12\ta_b\t1"},
    {"string.byte string.char string.pack string.unpack string.packsize string.dump", "s:byte(i), string.char(n)",
     "Characters and their numbers; binary data.", "print((\"A\"):byte(), string.char(66))  --> 65\tB"},
    {"table.insert append push", "table.insert(list, x), list[#list + 1] = x",
     "Appends to a list; table.insert(list, 1, x) inserts at the beginning.",
     "list = { 1 } table.insert(list, 2) print(#list)  --> 2"},
    {"table.remove pop", "table.remove(list) -> value",
     "Removes the last element, or the one at a position, and returns it.",
     "list = { 1, 2 } print(table.remove(list), #list)  --> 2\t1"},
    {"table.concat join", "table.concat(list, separator) -> string", "Joins a list of strings or numbers.",
     "print(table.concat({ 1, 2, 3 }, \", \"))  --> 1, 2, 3"},
    {"table.sort sort sorted", "table.sort(list), table.sort(list, function(a, b) return a > b end)",
     "Sorts a list in place.", "list = { 3, 1, 2 } table.sort(list) print(table.concat(list, \" \"))  --> 1 2 3"},
    {"table.unpack unpack table.pack table.move", "table.unpack(list) -> values",
     "The elements of a list as separate values: Python's *list.", "print(math.max(table.unpack{ 1, 5, 3 }))  --> 5"},
    {"io.open io.lines io.read io.write io", "io.open(name), io.lines(name), io.write(...)",
     "Files as text. For columns of numbers use load \"file.csv\".",
     "io.write(\"no newline\") print()  --> no newline"},
    {"os.time os.date os.clock os.exit os.getenv os.tmpname os.remove os.rename os",
     "os.clock(), os.date(), os.exit(code)",
     "Time, date, files, and the end of a script. :time code measures at the prompt.",
     "print(os.clock() > 0)  --> true"},
    {"ans _", "ans", "At the prompt: the value that was shown last. Not in scripts.", "print(ans)  --> nil"},
    {"setmetatable getmetatable metatable class classes", "setmetatable(t, { __index = parent })",
     "Gives a table operators and inherited fields. Scripts of dinal rarely need it.",
     "t = setmetatable({}, { __index = { x = 5 } }) print(t.x)  --> 5"},
    {"coroutine", "coroutine.wrap(function() coroutine.yield(1) end)",
     "A function that pauses and continues: Python's generator.",
     "next_value = coroutine.wrap(function() for i = 1, 2 do coroutine.yield(i) end end) "
     "print(next_value(), next_value())  --> 1\t2"},
    {"utf8", "utf8.len(s), utf8.char(n), utf8.codes(s)", "Text beyond ASCII: Greek letters and accents.",
     "print(utf8.len \"θ0\")  --> 2"},
    {"lambda def", "function(x) return 2*x end", "Lua's lambda and def are both written with function.",
     "print((function(x) return 2*x end)(4))  --> 8"},
    {"import", "require \"name\"", "math and all of dinal are there already; other modules come with require.",
     "print(require \"string\" == string)  --> true"},
    {"len length size", "#v", "The length of a list, vector, string, run or data.",
     "print(#{ 5, 6 }, #\"abc\")  --> 2\t3"},
    {"range", "for i = 1, 10, 2 do ... end; vector.range(1, 10, 2)",
     "Loops count by themselves; vector.range and vector.linspace make vectors.",
     "for i = 1, 5, 2 do print(i) end  --> 1, 3, 5"},
    {"slice slices", "v:slice(first, last, step); table.unpack(list, first, last)",
     "A part of a vector, both ends included. Of data: d:head(10), d:filter(function(row) ... end).",
     "print(vector{ 5, 6, 7 }:slice(2, 3))  --> vector{ 6, 7 }"},
    {"mask masks where", "v[v > 0]; v[v:find(function(x) return x > 0 and x < 1 end)]",
     "The elements of a vector for which a comparison holds. Write one comparison in the brackets; "
     "use find for more.",
     "v = vector{ -1, 2, 3 } print(v[v > 0])  --> vector{ 2, 3 }"},
}};

std::string shown(const Word& word) {
    return std::string(word.signature) + "\n\n" + text::wrapped(word.meaning) + "\n\n    " + std::string(word.example) +
           "\n\nFor those who know Python: docs/lua-for-python.md.\n";
}

}  // namespace

std::string lua_word(std::string_view word) {
    for (const Word& one : vocabulary) {
        const std::string names = " " + std::string(one.names) + " ";
        if (names.find(" " + std::string(word) + " ") != std::string::npos) return shown(one);
    }
    return "";
}

std::vector<std::string_view> lua_words() {
    std::vector<std::string_view> all;
    for (const Word& one : vocabulary) {
        const std::vector<std::string_view> names = text::split(one.names, ' ');
        all.insert(all.end(), names.begin(), names.end());
    }
    return all;
}

}  // namespace dinal::help
