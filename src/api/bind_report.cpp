// report{ ... }: what a student hands in, collected piece by piece and saved as one file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/classes.hpp"
#include "api/report.hpp"
#include "api/run.hpp"
#include "files/file.hpp"
#include "lua/options.hpp"
#include "lua/worker_state.hpp"
#include "source/value_text.hpp"
#include "text/words.hpp"

namespace dinal::api {
namespace {

const ReportHandle& report_self(lua_State* L, const char* call) {
    return lua::self<ReportHandle>(L, 1, call);
}

struct ReportOptions {
    std::string title, author;
};
constexpr text::Option report_options[] = {
    {.name = "title", .otherwise = text::needed, .meaning = "title", .filled = text::fills<&ReportOptions::title>},
    {.name = "author", .meaning = "author", .filled = text::fills<&ReportOptions::author>},
};
constexpr text::Call report_call{"report", "report{ title = \"Free decay\", author = \"A. Student\" }", report_options};

int new_report(lua_State* L) {
    auto asked = lua::read<ReportOptions>(L, 1, report_call);
    if (text::trimmed(asked.title).empty()) {
        lua::raise(L, {.sentence = "report: the title is empty", .call = "report", .option = "title"});
    }
    lua::push<ReportHandle>(L, std::make_shared<Report>(Report{std::move(asked.title), std::move(asked.author)}));
    return 1;
}

/// As print shows it; a table of the user's with what is in it.
std::string printed(lua_State* L, int index) {
    const bool says_itself = luaL_getmetafield(L, index, "__tostring") != LUA_TNIL;
    lua_pop(L, says_itself ? 1 : 0);
    if (lua_istable(L, index) && !says_itself) {
        source::ValueText writer(L);
        std::string text = writer.expression(index);
        if (!writer.remarks().empty()) {
            lua::raise(L,
                       {.sentence = "r:add: this table contains values that cannot be shown: add its parts one by one",
                        .call = "r:add"});
        }
        return text;
    }
    std::size_t size = 0;
    luaL_tolstring(L, index, &size);
    std::string text(lua_tostring(L, -1), size);
    lua_pop(L, 1);
    return text;
}

/// A string or a number; all else is an error of the call.
std::string words_at(lua_State* L, int index, const char* call, const char* what) {
    if (lua_type(L, index) != LUA_TSTRING && lua_type(L, index) != LUA_TNUMBER) {
        lua::raise_got(L, index, call, fmt::format("{}: {} must be text", call, what));
    }
    return printed(L, index);
}

int add_text(lua_State* L) {
    report_self(L, "r:text")->items.emplace_back(ReportText{words_at(L, 2, "r:text", "what is added")});
    return 0;
}

int add_heading(lua_State* L) {
    report_self(L, "r:heading")->items.emplace_back(ReportHeading{words_at(L, 2, "r:heading", "the heading")});
    return 0;
}

void add_lines(Report& report, const std::string& lines) {
    auto* last = report.items.empty() ? nullptr : std::get_if<ReportLines>(&report.items.back());
    if (last != nullptr && last->caption.empty()) {
        last->text += "\n" + lines;
    } else {
        report.items.emplace_back(ReportLines{lines});
    }
}

int add_value(lua_State* L) {
    const ReportHandle report = report_self(L, "r:add");
    if (lua_gettop(L) == 3) {
        const std::string name = words_at(L, 2, "r:add", "the name of the value");
        add_lines(*report, name + " = " + printed(L, 3));
        return 0;
    }
    if (lua_gettop(L) != 2 || lua_isnil(L, 2)) {
        lua::raise_got(L, 2, "r:add", "r:add takes a run, data, a picture or another value, or a name and a value");
    }
    if (const auto* picture = lua::test<Picture>(L, 2)) {
        report->items.emplace_back(drawn(*picture));
    } else if (const auto* data = lua::test<DataHandle>(L, 2)) {
        report->items.emplace_back(*data);
    } else if (const auto* run = lua::test<RunHandle>(L, 2)) {
        const RunHandle kept = *run;
        const std::string story = story_of_run(L, *kept);
        add_lines(*report, printed(L, 2));
        report->items.emplace_back(ReportText{story});
        if (kept->origin) {
            report->items.emplace_back(ReportLines{
                fmt::format("{}", fmt::join(source::repeat_lines(*kept->origin), "\n")), "How to repeat this run"});
        }
    } else {
        add_lines(*report, printed(L, 2));
    }
    return 0;
}

int add_table(lua_State* L) {
    const ReportHandle report = report_self(L, "r:table");
    const auto* data = lua::test<DataHandle>(L, 2);
    if (data == nullptr) {
        lua::raise_got(L, 2, "r:table", "r:table takes data, such as data{ r = { 1, 2 }, A = { 3, 4 } }");
    }
    report->items.emplace_back(*data);
    return 0;
}

/// r:plot{ ... } takes what plot takes, or a picture.
int add_plot(lua_State* L) {
    const ReportHandle report = report_self(L, "r:plot");
    if (const auto* picture = lua::test<Picture>(L, 2)) {
        report->items.emplace_back(drawn(*picture));
        return 0;
    }
    if (!lua_istable(L, 2) || lua_gettop(L) != 2) {
        lua::raise_got(L, 2, "r:plot",
                       "r:plot takes what plot{ ... } takes, or a picture such as run:plot{ show = false }");
    }
    lua_newtable(L);
    lua_pushnil(L);
    while (lua_next(L, 2) != 0) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_settable(L, 3);
    }
    lua_pushboolean(L, 0);
    lua_setfield(L, 3, "show");
    lua_pushcfunction(L, lua::guarded<plot_vectors>);
    lua_pushvalue(L, 3);
    lua_call(L, 1, 1);
    report->items.emplace_back(drawn(*lua::test<Picture>(L, -1)));
    return 0;
}

int add_animation(lua_State* L) {
    const ReportHandle report = report_self(L, "r:animate");
    if (lua::test<RunHandle>(L, 2) == nullptr) lua::raise_got(L, 2, "r:animate", "r:animate takes a run");
    report->items.emplace_back(drawn(animation_at(L, 2)));
    return 0;
}

/// The script that runs, as text; nothing at the prompt.
std::string running_script(lua_State* L) {
    lua_pushglobaltable(L);
    lua_pushliteral(L, "arg");
    lua_rawget(L, -2);
    std::string name;
    if (lua_istable(L, -1)) {
        lua_rawgeti(L, -1, 0);
        if (lua_type(L, -1) == LUA_TSTRING && text::ending_of(lua_tostring(L, -1)) == ".lua") {
            name = lua_tostring(L, -1);
        }
        lua_pop(L, 1);
    }
    lua_pop(L, 2);
    auto read = files::read_file(name);
    return name.empty() || !read ? "" : std::move(read).value();
}

void (*taker)(const Report& report) = nullptr;  // set by --report, before the script runs

int save_report(lua_State* L) {
    lua::refuse_in_worker(L, "r:save");
    Report report = *report_self(L, "r:save");
    const std::string name = words_at(L, 2, "r:save", "the name of the file");
    const std::string ending = text::ending_of(name);
    if (ending != ".html" && ending != ".md") {
        lua::raise(L,
                   {.sentence = fmt::format("r:save: the name '{}' must end in .html (one page with its pictures) or "
                                            ".md (Markdown, with pictures beside it)",
                                            name),
                    .call = "r:save",
                    .culprit = name});
    }
    if (taker != nullptr) {
        taker(report);
        return 0;
    }
    if (std::string script = running_script(L); !script.empty()) {
        report.items.emplace_back(ReportLines{std::move(script), "The script"});
    }
    if (ending == ".html") {
        lua::value_or_raise(L, "r:save", files::write_file(name, html_of(report)));
        return 0;
    }
    const MarkdownReport written = markdown_of(report, name.substr(0, name.size() - ending.size()));
    for (const auto& [picture, svg] : written.pictures) {
        lua::value_or_raise(L, "r:save", files::write_file(picture, svg));
    }
    lua::value_or_raise(L, "r:save", files::write_file(name, written.text));
    return 0;
}

int report_text(lua_State* L) {
    const Report& report = *report_self(L, "tostring(r)");
    return lua::push_text(L, fmt::format("report \"{}\" with {} part{}", report.title, report.items.size(),
                                         report.items.size() == 1 ? "" : "s"));
}

#define DINAL_REPORT "r = report{ title = \"Free decay\", author = \"A. Student\" }\n"

constexpr lua::Member report_functions_members[] = {
    {lua::a_function<new_report>,
     {"report{ OPTIONS } -> r",
      "Starts a report to hand in: text, values, tables and pictures in the order in which you add them.",
      DINAL_REPORT "print(r)  --> report \"Free decay\" with 0 parts",
      {&report_call}}},
};

constexpr lua::Member report_members[] = {
    {lua::a_method<add_heading>,
     {"r:heading(text)", "Begins a section.",
      DINAL_REPORT "r:heading(\"Results\")\nprint(r)  --> report \"Free decay\" with 1 part"}},
    {lua::a_method<add_text>,
     {"r:text(text)", "Adds text; empty lines separate paragraphs.",
      DINAL_REPORT "r:text(\"The crests lie on a straight line.\")\nprint(r)  --> report \"Free decay\" with 1 part"}},
    {lua::a_method<add_value>,
     {"r:add(value), r:add(name, value)",
      "Adds a value as print shows it, alone or with a name. A run is added with its description and the lines "
      "that repeat it.",
      DINAL_REPORT "run = nondimensional{ friction_ratio = 0.1 }:simulate{ theta0 = 1, t_end = 3, dt = 0.01 }\n"
                   "r:add(run)\nr:add(\"turns\", #run.events)\nprint(r)  --> report \"Free decay\" with 4 parts"}},
    {lua::a_method<add_table>,
     {"r:table(data)", "Adds data as a table, a thousand rows at most.",
      DINAL_REPORT "r:table(data{ n = { 1, 2 }, A = { 0.9, 0.8 } })\nprint(r)  --> report \"Free decay\" with 1 part"}},
    {lua::a_method<add_plot>,
     {"r:plot{ ... }, r:plot(picture)",
      "Adds a plot: what plot{ ... } takes, or a picture such as run:plot{ show = false }.",
      DINAL_REPORT "x = vector.linspace(0, 6, 61)\nr:plot{ { x, x:sin() }, xlabel = \"x\" }\n"
                   "print(r)  --> report \"Free decay\" with 1 part"}},
    {lua::a_method<add_animation>,
     {"r:animate(run, { OPTIONS })",
      "Adds a run in motion, as run:animate shows it: a browser plays it, on paper its start stands.",
      DINAL_REPORT "run = nondimensional{ friction_ratio = 0.1 }:simulate{ theta0 = 1, t_end = 3, dt = 0.01 }\n"
                   "r:animate(run, { speed = 0.5 })\nprint(r)  --> report \"Free decay\" with 1 part",
      {&report_animate_call}}},
    {lua::a_method<save_report>,
     {"r:save(file)",
      "Writes the report, with the script appended: .html is one page with its pictures, .md is Markdown with the "
      "pictures as separate files. A report made at the prompt has no script: hand in the file of :save "
      "session.lua with it. Under dinal --report the parts go into the page of the script instead.",
      DINAL_REPORT "name = os.tmpname() .. \".html\"\nr:save(name)\n"
                   "print(io.open(name):read(\"l\"))  --> <!DOCTYPE html>"}},
    {lua::a_metamethod<report_text>("__tostring"),
     {"tostring(r) -> string", "Its title, and how many parts it has.",
      DINAL_REPORT "print(tostring(r))  --> report \"Free decay\" with 0 parts"}},
};

#undef DINAL_REPORT

}  // namespace

const lua::Class report_functions = {
    "report",
    {"report{ ... } -> r", "Collects a report to hand in.", "print(report ~= nil)  --> true"},
    report_functions_members};

const lua::Class report_class = {
    "report",
    {"report{ ... } -> r",
     "A report: text, values, tables, pictures and, from a script, the script itself, saved as one file.",
     "r = report{ title = \"Free decay\" }\nprint(r)  --> report \"Free decay\" with 0 parts"},
    report_members};

void take_saved_reports_by(void (*take)(const Report& report)) {
    taker = take;
}

void register_report(lua_State* L) {
    lua::add_class<ReportHandle>(L, report_class);
    lua::add_functions(L, report_functions);
}

}  // namespace dinal::api
