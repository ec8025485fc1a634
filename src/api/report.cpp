#include "api/report.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "api/lab_course.hpp"
#include "files/file.hpp"
#include "lua/interrupt.hpp"
#include "plots/svg_words.hpp"
#include "text/characters.hpp"
#include "text/html.hpp"
#include "text/words.hpp"

namespace dinal::api {
namespace {

constexpr std::size_t most_table_rows = 1000;
constexpr std::ptrdiff_t most_lines_together =
    30;  // on one sheet of paper; what is longer would leave half of one empty

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

/// Paragraphs of a text that empty lines separate.
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

void replace_all(std::string& text, std::string_view what, std::string_view by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
        text.replace(at, what.size(), by);
    }
}

/// From <svg on, and with names of its own: on a page with several pictures they would else be mixed up.
std::string svg_in_page(const std::string& svg, std::size_t number) {
    std::string own = svg;
    for (const char* mark : {" id=\"", " id='", "href=\"#", "href='#", "url(#"}) {
        replace_all(own, mark, fmt::format("{}p{}-", mark, number));
    }
    return own;
}

struct HtmlWriter {
    std::string page;
    std::size_t pictures = 0;

    void operator()(const ReportHeading& item) { page += "<h2>" + text::html(item.text) + "</h2>\n"; }
    void operator()(const ReportText& item) {
        for (const std::string_view one : paragraphs(item.text)) page += "<p>" + text::html(one) + "</p>\n";
    }
    void operator()(const ReportLines& item) {
        const bool fits = std::count(item.text.begin(), item.text.end(), '\n') < most_lines_together;
        const std::string lines = (fits ? "<pre>" : "<pre class=\"long\">") + text::html(item.text) + "</pre>\n";
        page += item.caption.empty()
                    ? lines
                    : "<details open><summary>" + text::html(item.caption) + "</summary>\n" + lines + "</details>\n";
    }
    void operator()(const ReportPicture& item) {
        page += item.svg.empty() ? "<pre>" + text::html(item.text) + "</pre>\n"
                                 : "<figure>\n" + svg_in_page(item.svg, ++pictures) + "</figure>\n";
    }
    void operator()(const DataHandle& item) { page += html_of(*item, most_table_rows); }
};

/// As many backquotes as no line of the text has.
std::string fence(std::string_view text) {
    std::string marks = "```";
    while (text.find(marks) != std::string_view::npos) marks += '`';
    return marks;
}

/// The text with its lines and tabs, and no other character that steers what shows it.
std::string lines_shown(std::string_view text) {
    std::string all;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find_first_of("\n\t"), text.size());
        all += text::displayable(text.substr(0, end));
        if (end < text.size()) all += text[end];
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return all;
}

/// A line that Markdown would read as something else than text stays text.
std::string plain_markdown(std::string_view text) {
    return text::markdown(lines_shown(text), "\\`*_{}[]#|");
}

struct MarkdownWriter {
    MarkdownReport report;
    const std::string& stem;

    void operator()(const ReportHeading& item) {
        report.text += "## " + plain_markdown(text::displayable(item.text)) + "\n\n";
    }
    void operator()(const ReportText& item) {
        for (const std::string_view one : paragraphs(item.text)) report.text += plain_markdown(one) + "\n\n";
    }
    void operator()(const ReportLines& item) {
        const std::string marks = fence(item.text);
        report.text += (item.caption.empty() ? "" : plain_markdown(item.caption) + ":\n\n") + marks + "\n" +
                       lines_shown(item.text) + "\n" + marks + "\n\n";
    }
    void operator()(const ReportPicture& item) {
        if (item.svg.empty()) {
            (*this)(ReportLines{item.text});
            return;
        }
        const std::string name = fmt::format("{}-{}.svg", stem, report.pictures.size() + 1);
        report.pictures.emplace_back(name, item.svg);
        report.text += fmt::format("![{}]({})\n\n", plain_markdown(item.title), name.substr(name.rfind('/') + 1));
    }
    void operator()(const DataHandle& item) { report.text += markdown_of(*item) + "\n\n"; }
};

}  // namespace

ReportPicture drawn(const Picture& picture) {
    auto svg = svg_of(picture);
    return {svg ? std::move(svg).value() : "", text_of_picture(picture), plots::title_of(picture.figures)};
}

ReportPicture drawn(const Animation& animation) {
    return {animation.svg, animation.title, animation.title};
}

std::string html_of(const Report& report) {
    HtmlWriter writer{fmt::format(page_head, text::html(report.title))};
    if (!report.author.empty()) writer.page += "<p class=\"author\">" + text::html(report.author) + "</p>\n";
    for (const ReportItem& item : report.items) std::visit(writer, item);
    return writer.page + "</body>\n</html>\n";
}

MarkdownReport markdown_of(const Report& report, const std::string& stem) {
    MarkdownWriter writer{{}, stem};
    writer.report.text = "# " + plain_markdown(text::displayable(report.title)) + "\n\n";
    if (!report.author.empty()) writer.report.text += plain_markdown(report.author) + "\n\n";
    for (const ReportItem& item : report.items) std::visit(writer, item);
    return std::move(writer.report);
}

namespace {

ScriptReport* picture_taker = nullptr;

/// While it lives, files are read and written to their end although the script was stopped.
class InSpiteOfStop {
public:
    InSpiteOfStop() { files::set_stop_question(nullptr); }
    ~InSpiteOfStop() { files::set_stop_question(lua::interrupt_requested); }
    InSpiteOfStop(const InSpiteOfStop&) = delete;
    InSpiteOfStop& operator=(const InSpiteOfStop&) = delete;
};

std::string stem_of(const std::string& script) {
    const std::string name = script.substr(script.rfind('/') + 1);
    if (name == "-") return "stdin";
    const std::string ending = text::ending_of(name);
    return ending == ".lua" ? name.substr(0, name.size() - ending.size()) : name;
}

/// The answers that were judged, as a table; null if there are none.
DataHandle verdicts_of_session() {
    const std::vector<LabMark>& answers = lab_answers();
    if (answers.empty()) return nullptr;
    std::vector<std::string> questions, verdicts, said;
    std::vector<double> numbers, tries, values;
    for (const LabMark& answer : answers) {
        numbers.push_back(static_cast<double>(answer.number));
        questions.push_back(answer.question);
        values.push_back(answer.value);
        verdicts.push_back(answer.verdict);
        tries.push_back(answer.tries);
        said.push_back(answer.said);
    }
    Data table;
    table.columns = {column_of("number", std::move(numbers)), column_of("question", std::move(questions)),
                     column_of("value", std::move(values)),   column_of("verdict", std::move(verdicts)),
                     column_of("tries", std::move(tries)),    column_of("said", std::move(said))};
    return std::make_shared<const Data>(std::move(table));
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
    const InSpiteOfStop going_on;
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

}  // namespace dinal::api
