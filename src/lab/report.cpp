#include "lab/report.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "api/lua_run.hpp"
#include "files/file.hpp"
#include "lab/lab_course.hpp"
#include "lua/interrupt.hpp"
#include "lua/options.hpp"
#include "lua/values.hpp"
#include "lua/worker_state.hpp"
#include "plots/svg_words.hpp"
#include "source/describe.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::lab {

using namespace api;

namespace {

constexpr std::size_t most_table_rows = 1000;
constexpr std::ptrdiff_t most_lines_together = 30;  // fits on one page of A4; a longer text may be split

constexpr const char* page_head = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{0}</title>
<style>
:root {{ color-scheme: only light; }}
body {{ font: 11pt/1.45 "DejaVu Sans", Verdana, sans-serif; max-width: 46em; margin: 2em auto; padding: 0 1em; color: #222; background: #fff; overflow-wrap: anywhere; }}
h1 {{ font-size: 1.6em; margin-bottom: 0; }} h2 {{ font-size: 1.2em; margin-top: 1.6em; }}
.author {{ color: #555; margin-top: .2em; }}
pre {{ background: #f4f4f4; padding: .6em .8em; overflow-x: auto; font: 9.5pt/1.35 "DejaVu Sans Mono", monospace; }}
table {{ border-collapse: collapse; font-size: .92em; margin: 1em 0; }}
th, td {{ border-bottom: 1px solid #ccc; padding: .2em .8em; text-align: right; overflow-wrap: normal; }} th {{ border-bottom: 2px solid #888; }}
figure {{ margin: 1em 0; }} figure svg {{ max-width: 100%; height: auto; }}
details {{ margin-top: 1em; }} summary {{ cursor: pointer; color: #555; }}
@page {{ size: A4; margin: 2cm; }}
@media print {{
body {{ margin: 0; padding: 0; max-width: none; font-size: 10pt; }} h2, summary {{ break-after: avoid; }}
pre {{ white-space: pre-wrap; font-size: 8pt; orphans: 4; widows: 4; }} .table {{ overflow: visible !important; }} table {{ font-size: 8pt; }} th, td {{ padding: .15em .5em; overflow-wrap: anywhere; }}
figure, tr, pre {{ break-inside: avoid; }} pre.long {{ break-inside: auto; }}
table:not(:has(tr:nth-child(30))) {{ break-inside: avoid; }}
}}
</style>
</head>
<body>
<h1>{0}</h1>
)";

/// The paragraphs of a text, separated by empty lines.
std::vector<std::string_view> paragraphs(std::string_view text) {
    std::vector<std::string_view> all;
    while (!text.empty()) {
        const std::size_t end = text.find("\n\n");
        const std::string_view one = text.substr(0, end);
        if (one.find_first_not_of(" \n") != std::string_view::npos) all.push_back(one);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 2);
    }
    return all;
}

struct HtmlWriter {
    std::string page;

    void operator()(const ReportHeading& item) { page += "<h2>" + text::html(item.text) + "</h2>\n"; }
    void operator()(const ReportText& item) {
        for (const std::string_view one : paragraphs(item.text)) page += "<p>" + text::html(one) + "</p>\n";
    }
    void operator()(const ReportLines& item) {
        const bool fits = std::ranges::count(item.text, '\n') < most_lines_together;
        const std::string lines = (fits ? "<pre>" : "<pre class=\"long\">") + text::html(item.text) + "</pre>\n";
        page += item.caption.empty()
                    ? lines
                    : "<details open><summary>" + text::html(item.caption) + "</summary>\n" + lines + "</details>\n";
    }
    void operator()(const ReportPicture& item) {
        page += item.svg.empty() ? "<pre>" + text::html(item.text) + "</pre>\n"
                                 : "<figure>\n" + plots::element_of(item.svg) + "</figure>\n";
    }
    void operator()(const DataHandle& item) { page += html_of(*item, most_table_rows); }
};

}  // namespace

ReportPicture drawn(const Picture& picture) {
    auto svg = svg_of(picture);
    return {svg ? std::move(svg).value() : "", text_of_picture(picture)};
}

ReportPicture drawn(const Animation& animation) {
    return {animation.svg, animation.title};
}

std::string html_of(const Report& report) {
    HtmlWriter writer{fmt::format(page_head, text::html(report.title))};
    if (!report.author.empty()) writer.page += "<p class=\"author\">" + text::html(report.author) + "</p>\n";
    for (const ReportItem& item : report.items) std::visit(writer, item);
    return writer.page + "</body>\n</html>\n";
}

namespace {

ScriptReport* picture_taker = nullptr;

std::string stem_of(const std::string& script) {
    const std::string name = script.substr(script.rfind('/') + 1);
    if (name == "-") return "stdin";
    const std::string ending = text::ending_of(name);
    return ending == ".lua" ? name.substr(0, name.size() - ending.size()) : name;
}

/// The judged answers as a table; null if there are none.
DataHandle verdicts_of_session() {
    const std::vector<LabMark>& answers = lab_answers();
    if (answers.empty()) return nullptr;
    return std::make_shared<const Data>(
        table_of(answers, ListColumn{"number", &LabMark::number}, ListColumn{"question", &LabMark::question},
                 ListColumn{"value", &LabMark::value}, ListColumn{"verdict", &LabMark::verdict},
                 ListColumn{"tries", &LabMark::tries}, ListColumn{"said", &LabMark::said}));
}

}  // namespace

ScriptReport::ScriptReport(std::string script, const std::string& errors)
    : script_(std::move(script)),
      errors_(errors),
      output_(::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1)),
      printed_(::memfd_create("report", MFD_CLOEXEC)) {
    static_cast<void>(std::fflush(stdout));
    ::dup2(printed_, STDOUT_FILENO);
    picture_taker = this;
    show_pictures_by([](const Picture& picture, Shown /*where*/) {
        picture_taker->take_printed();
        picture_taker->report_.items.emplace_back(drawn(picture));
    });
    take_saved_reports_by([](const Report& saved) {
        picture_taker->take_printed();
        picture_taker->report_.author = saved.author;
        auto& items = picture_taker->report_.items;
        items.emplace_back(ReportHeading{saved.title});
        items.insert(items.end(), saved.items.begin(), saved.items.end());
    });
    show_animations_by([](const Animation& animation, Shown /*where*/) {
        picture_taker->take_printed();
        picture_taker->report_.items.emplace_back(drawn(animation));
    });
}

ScriptReport::~ScriptReport() {
    give_back();
    ::close(printed_);
}

void ScriptReport::give_back() {
    if (output_ < 0) return;
    static_cast<void>(std::fflush(stdout));
    ::dup2(output_, STDOUT_FILENO);
    ::close(output_);
    output_ = -1;
    picture_taker = nullptr;
    show_pictures_by(nullptr);
    take_saved_reports_by(nullptr);
    show_animations_by(nullptr);
}

void ScriptReport::take_printed() {
    static_cast<void>(std::fflush(stdout));
    std::string text;
    std::array<char, 1U << 16U> piece{};
    for (;;) {
        const ssize_t count = ::pread(printed_, piece.data(), piece.size(), static_cast<off_t>(taken_));
        if (count <= 0) break;
        text.append(piece.data(), static_cast<std::size_t>(count));
        taken_ += static_cast<std::size_t>(count);
    }
    if (text.ends_with('\n')) text.pop_back();
    if (!text.empty()) report_.items.emplace_back(ReportLines{std::move(text)});
}

text::Expected<std::string> ScriptReport::save() {
    const lua::InSpiteOfStop going_on;
    take_printed();
    give_back();
    const std::string stem = stem_of(script_);
    report_.title = stem;
    if (const auto verdicts = verdicts_of_session()) {
        report_.items.emplace_back(ReportHeading{"Answers"});
        report_.items.emplace_back(verdicts);
    }
    if (!errors_.empty()) report_.items.emplace_back(ReportLines{errors_, "It ended with an error"});
    if (auto source = files::read_file(script_)) {
        report_.items.emplace_back(ReportLines{std::move(source).value(), "The script"});
    }
    std::string name = stem + ".html";
    if (const auto written = files::write_file(name, html_of(report_)); !written) return written.error();
    return name;
}

// report{ ... }: a student's report, collected piece by piece and saved as one file.

namespace {

const ReportHandle& report_self(lua_State* L, const char* call) {
    return lua::self<ReportHandle>(L, 1, call);
}

struct ReportOptions {
    std::string title, author;
};
constexpr text::Option report_options[] = {
    text::option<&ReportOptions::title>("title", "title", {.otherwise = text::needed}),
    text::option<&ReportOptions::author>("author", "author"),
};
constexpr text::Call report_call{"report", "report{ title = \"Free decay\", author = \"A. Student\" }", report_options};

int new_report(lua_State* L) {
    auto asked = lua::read<ReportOptions>(L, 1, report_call);
    if (text::trimmed(asked.title).empty()) {
        lua::fail(L, "report", {.sentence = "the title is empty", .option = "title"});
    }
    lua::push<ReportHandle>(L, std::make_shared<Report>(Report{std::move(asked.title), std::move(asked.author)}));
    return 1;
}

/// The text of a value as print shows it; tables of the user include their contents.
std::string printed(lua_State* L, int index) {
    const bool says_itself = luaL_getmetafield(L, index, "__tostring") != LUA_TNIL;
    lua_pop(L, says_itself ? 1 : 0);
    if (lua_istable(L, index) && !says_itself) {
        source::ValueText writer(L);
        std::string text = writer.expression(index);
        if (!writer.remarks().empty()) {
            lua::fail(L, "r:add", {"this table contains values that cannot be shown: add its parts one by one"});
        }
        return text;
    }
    std::size_t size = 0;
    luaL_tolstring(L, index, &size);
    std::string text(lua_tostring(L, -1), size);
    lua_pop(L, 1);
    return text;
}

/// The string or number at `index`; raises an error for other values.
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
        const std::string story = story_of_run(L, kept);
        add_lines(*report, printed(L, 2));
        report->items.emplace_back(ReportText{story});
        if (kept->origin) {
            report->items.emplace_back(
                ReportLines{fmt::format("{}", fmt::join(repeat_lines(*kept), "\n")), "How to repeat this run"});
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

/// r:plot{ ... }: takes the arguments of plot, or a picture.
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
    lua::push_copy(L, 2);
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

/// The text of the running script; empty at the prompt.
std::string running_script(lua_State* L) {
    std::string name;
    if (lua::push_global(L, "arg") == LUA_TTABLE) {
        lua_rawgeti(L, -1, 0);
        if (lua_type(L, -1) == LUA_TSTRING && text::ending_of(lua_tostring(L, -1)) == ".lua") {
            name = lua_tostring(L, -1);
        }
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    auto read = files::read_file(name);
    return name.empty() || !read ? "" : std::move(read).value();
}

void (*taker)(const Report& report) = nullptr;  // set by --report before the script runs

int save_report(lua_State* L) {
    lua::refuse_in_worker(L, "r:save");
    Report report = *report_self(L, "r:save");
    const std::string name = words_at(L, 2, "r:save", "the name of the file");
    const std::string ending = text::ending_of(name);
    if (ending != ".html") {
        lua::fail(L, "r:save",
                  {.sentence = fmt::format("the name '{}' must end in .html, one page with its pictures", name),
                   .culprit = name});
    }
    if (taker != nullptr) {
        taker(report);
        return 0;
    }
    if (std::string script = running_script(L); !script.empty()) {
        report.items.emplace_back(ReportLines{std::move(script), "The script"});
    }
    lua::value_or_raise(L, "r:save", files::write_file(name, html_of(report)));
    return 0;
}

std::string report_text(const Report& report) {
    return fmt::format("report \"{}\" with {}", report.title, text::counted(report.items.size(), "part"));
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
      "Writes the report as file.html, one page with its pictures and, at its end, the script. A report made at the prompt has no script: hand in the file of :save "
      "session.lua with it. Under dinal --report the parts go into the page of the script instead.",
      DINAL_REPORT "name = os.tmpname() .. \".html\"\nr:save(name)\n"
                   "print(io.open(name):read(\"l\"))  --> <!DOCTYPE html>"}},
    {lua::a_text<ReportHandle, report_text>,
     {"tostring(r) -> string", "Its title, and how many parts it has.",
      DINAL_REPORT "print(tostring(r))  --> report \"Free decay\" with 0 parts"}},
};

#undef DINAL_REPORT

}  // namespace

const lua::Class report_functions = {
    "report",
    {"report{ ... } -> r", "Collects a report to hand in.", "print(report ~= nil)  --> true"},
    report_functions_members,
    lua::add_functions};

const lua::Class report_class = {
    "report",
    {"report{ ... } -> r",
     "A report: text, values, tables, pictures and, from a script, the script itself, saved as one file.",
     "r = report{ title = \"Free decay\" }\nprint(r)  --> report \"Free decay\" with 0 parts"},
    report_members,
    lua::add_class<ReportHandle>};

void take_saved_reports_by(void (*take)(const Report& report)) {
    taker = take;
}

}  // namespace dinal::lab
