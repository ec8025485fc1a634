// A report: text, values, tables and pictures in their order, as one page of HTML or as Markdown.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/animate.hpp"
#include "api/data.hpp"
#include "api/picture.hpp"
#include "text/expected.hpp"

namespace dinal::lab {

struct ReportHeading {
    std::string text;
};
/// Empty lines separate paragraphs.
struct ReportText {
    std::string text;
};
/// Lines that stay as they are: what was printed, a value, a script.
struct ReportLines {
    std::string text;
    std::string caption = {};  ///< for what is long: it is folded under this
};
struct ReportPicture {
    std::string svg;   ///< empty when it was not drawn
    std::string text;  ///< the same for those who see no pictures
    std::string title = {};
};
using ReportItem = std::variant<ReportHeading, ReportText, ReportLines, ReportPicture, api::DataHandle>;

struct Report {
    std::string title;
    std::string author = {};
    std::vector<ReportItem> items = {};
};
using ReportHandle = std::shared_ptr<Report>;

/// report{ ... }.
void register_report(lua_State* L);
extern const lua::Class report_functions;
extern const lua::Class report_class;

/// Calls this with each report that is saved, which then writes no file: --report puts its parts into the page of the
/// script.
void take_saved_reports_by(void (*take)(const Report& report));

/// The picture as a report keeps it.
ReportPicture drawn(const api::Picture& picture);
ReportPicture drawn(const api::Animation& animation);

/// One page that needs nothing else: pictures are SVG in it, and it prints on A4.
std::string html_of(const Report& report);

/// The text, and the pictures as files beside it, with their names: `stem`-1.svg ...
struct MarkdownReport {
    std::string text;
    std::vector<std::pair<std::string, std::string>> pictures;
};
MarkdownReport markdown_of(const Report& report, const std::string& stem);

// --report: what a script prints and draws becomes a page to hand in.

/// While it lives, what is printed on standard output and the pictures that are shown go into a report, in their order.
class ScriptReport {
public:
    /// The script, and what it says on standard error, which is collected elsewhere meanwhile.
    ScriptReport(std::string script, const std::string& errors);
    ~ScriptReport();
    ScriptReport(const ScriptReport&) = delete;
    ScriptReport& operator=(const ScriptReport&) = delete;

    /// Writes it into the current folder: lab.html for ../lab.lua, with the script and what went wrong, if anything, at
    /// its end. Returns the name. Standard output is what it was from then on.
    text::Expected<std::string> save();

private:
    void take_printed();
    void give_back();

    Report report_;
    std::string script_;
    const std::string& errors_;
    int output_;   // the standard output of before
    int printed_;  // a file without a name
    std::size_t taken_ = 0;
};

}  // namespace dinal::lab
