// The list of everything that Lua sees: the list in api/classes.hpp, then the rooms above.
#include "help/library.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "api/classes.hpp"
#include "errors/error_remarks.hpp"
#include "help/help_text.hpp"
#include "lab/lab_course.hpp"
#include "lab/report.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/standard_globals.hpp"
#include "lua/worker_state.hpp"
#include "sweep/sweep_run.hpp"
#include "text/version.hpp"
#include "text/words.hpp"

namespace dinal::help {

namespace {

// Plain fields of the table: documented here, set by open_library() and sys:simulate.
constexpr lua::Member library_members[] = {
    {{nullptr, lua::Kind::field},
     {"dinal.partial -> run, data or nil",
      "The finished part of the last run that Ctrl-C or an error in M stopped: a run like any other. Of a sweep "
      "stopped by Ctrl-C, the finished points.",
      "pcall(function()\n"
      "    nondimensional{}:simulate{ M = function(t) assert(t < 0.5) return 1 end, t_end = 1, dt = 0.1 }\n"
      "end)\n"
      "print(#dinal.partial)  --> 5"}},
    {{nullptr, lua::Kind::field},
     {"dinal.on_interrupt",
      "A function of yours that is called with dinal.partial (or nil) when Ctrl-C ends a script, to save or print "
      "it. pcall does not catch Ctrl-C. Not called at the prompt and in notebooks.",
      "dinal.on_interrupt = function(partial) if partial then partial:save(\"partial.csv\") end end"}},
    {{nullptr, lua::Kind::field},
     {"dinal.version -> string", "The version of the program.",
      "print(dinal.version == \"" DINAL_VERSION "\")  --> true"}},
};

const lua::Class library_class = {
    "dinal",
    {"dinal.NAME, or NAME alone",
     "The table of all names of dinal. Its members are also globals, which you may overwrite, except the "
     "following ones.",
     "print(dinal.system == system)  --> true"},
    library_members};

constexpr Section sections_above[] = {
    {"Sweeps", "", &sweep::sweep_functions},
    {"Reports", "", &lab::report_functions},
    {"A report", "r", &lab::report_class},
    {"The lab", "lab", &lab::lab_module},
    {"Answers in the lab", "", &lab::check_functions},
    {"Help", "", &help_functions},
    {"The table dinal", "dinal", &library_class},
};
constexpr auto all_sections = text::joined(api::sections, sections_above);

// dinal.partial is nil until a run fails, so it must not be an unknown name.
int unknown_name(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING || std::string_view(lua_tostring(L, 2)) == "partial") {
        return 0;
    }
    const std::string_view wrong = lua_tostring(L, 2);
    lua::raise(L, {.sentence = "there is no dinal." + std::string(wrong),
                   .call = "dinal",
                   .culprit = std::string(wrong),
                   .cure = text::did_you_mean(wrong, lua::text_keys(L, 1))});
}

}  // namespace

std::span<const Section> sections() {
    return all_sections;
}

void open_library(lua_State* L) {
    lua::set_library(open_library);  // for workers of a sweep
    lua::set_witness(L, errors::first_remarks);
    lua::open_coroutines(L);
    lua::open_terminal_output(L);
    lua::make_dinal_table(L);
    for (const Section& section : all_sections) {
        if (section.description->add != nullptr) section.description->add(L, *section.description);
    }
    lua_pushglobaltable(L);
    lua::copy_fields(L);
    lua_pop(L, 1);
    lua::note_standard_globals(L);
    lua_newtable(L);
    lua_pushcfunction(L, lua::guarded<unknown_name>);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
    lua_pushliteral(L, DINAL_VERSION);
    lua_setfield(L, -2, "version");
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
    lua_pushvalue(L, -2);
    lua_setfield(L, -2, "dinal");
    lua_pop(L, 1);
    lua_setglobal(L, "dinal");
}

namespace {

constexpr std::string_view options_mark = "OPTIONS";

std::string with_default(const text::Option& option) {
    const std::string otherwise = text::default_text(option);
    return otherwise.empty() ? option.name : fmt::format("{} = {}", option.name, otherwise);
}

bool is_class_of_objects(const Section& section) {
    return !text::contains(section.description->members, lua::Kind::function, &lua::Member::kind);
}

}  // namespace

std::string option_list(std::span<const text::Option> options) {
    std::string list;
    for (const text::Option& option : options) {
        list += list.empty() ? "" : option.instead_of_previous ? " | " : ", ";
        list += with_default(option);
    }
    return list;
}

std::string signature(const lua::Doc& doc) {
    std::string text = doc.signature;
    for (const text::Call* call : calls_of(doc)) {
        const bool none = call->options.empty();  // then the blanks around OPTIONS go, too
        const std::size_t place = text.find(options_mark) - (none ? 1 : 0);
        text.replace(place, options_mark.size() + (none ? 2 : 0), option_list(call->options));
    }
    return text;
}

const text::Call* call_with(const lua::Doc& doc, Braces braces) {
    const std::vector<const text::Call*> calls = calls_of(doc);
    std::size_t next = 0;
    int parentheses = 0;
    int depth = 0;
    for (const lua::Token& token : lua::tokens(doc.signature)) {
        parentheses += token.is("(") ? 1 : token.is(")") ? -1 : 0;
        depth += token.is("{") ? 1 : token.is("}") ? -1 : 0;
        if (token.is(options_mark)) {
            const bool asked = (parentheses > 0) == (braces == Braces::in_parentheses);
            if (asked && depth == (braces == Braces::nested ? 2 : 1)) {
                return calls[next];
            }
            ++next;
        }
    }
    return nullptr;
}

std::vector<const text::Call*> calls_of(const lua::Doc& doc) {
    std::vector<const text::Call*> calls(doc.calls.begin(), doc.calls.end());
    std::erase(calls, nullptr);
    return calls;
}

std::vector<OptionLine> option_lines(std::span<const text::Option> options) {
    std::vector<OptionLine> lines;
    for (std::size_t i = 0; i < options.size(); ++i) {
        const text::Option& option = options[i];
        std::vector<std::string> facts;
        if (*option.unit != '\0') {
            facts.emplace_back(option.unit);
        }
        std::string others;
        for (std::size_t j = i + 1; j < options.size() && options[j].instead_of_previous; ++j) {
            others += fmt::format(" or {}", options[j].name);
        }
        if (option.instead_of_previous) {
            std::size_t first = i - 1;
            while (options[first].instead_of_previous) --first;
            facts.push_back(fmt::format("instead of {}", options[first].name));
        } else if (option.otherwise == text::needed) {
            facts.push_back(others.empty() ? "needed" : fmt::format("this{} is needed", others));
        }
        if (option.range.must != std::string_view(text::any_finite.must)) {
            const std::string_view must = option.range.must;
            facts.push_back(fmt::format("must {}", must.substr(0, must.find(':'))));  // without the reason
        }
        if (!option.choices.empty()) {
            facts.push_back(fmt::format("\"{}\"", fmt::join(option.choices, "\", \"")));
        }
        lines.push_back(
            {option.name, with_default(option),
             facts.empty() ? option.meaning : fmt::format("{} ({})", option.meaning, fmt::join(facts, ", "))});
    }
    return lines;
}

std::string parameters(std::string_view signature) {
    const std::size_t open = signature.find_first_of("({");
    const std::size_t close = signature.substr(0, signature.find("->")).find_last_of(")}");
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) {
        return "";
    }
    return std::string(text::trimmed(signature.substr(open + 1, close - open - 1), " "));
}

char call_bracket(std::string_view signature) {
    const std::size_t open = signature.substr(0, signature.find("->")).find_first_of("({");
    return open == std::string_view::npos ? ' ' : signature[open];
}

const Section* section_of_result(std::string_view signature) {
    const std::size_t arrow = signature.find("-> ");
    if (arrow == std::string_view::npos) {
        return nullptr;
    }
    const std::string_view result = signature.substr(arrow + 3);
    const std::string_view name = result.substr(0, result.find_first_of(" ,"));
    for (const Section& section : sections()) {
        if ((name == section.description->name || name == section.prefix) && is_class_of_objects(section)) {
            return &section;
        }
    }
    return nullptr;
}

}  // namespace dinal::help
