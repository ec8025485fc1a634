// A report: text, values, tables and pictures in their order, as one page of HTML.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "api/animate.hpp"
#include "api/data.hpp"
#include "api/picture.hpp"
#include "text/expected.hpp"
#include "text/not_copied.hpp"

namespace dinal::lab {

struct ReportHeading {
    std::string text;
};
/// Paragraphs are separated by empty lines.
struct ReportText {
    std::string text;
};
/// Preformatted lines: output, a value, a script.
struct ReportLines {
    std::string text;
    std::string caption = {};  ///< for long texts, which are folded under it
};
struct ReportPicture {
    std::string svg;   ///< empty if not drawn
    std::string text;  ///< the picture as text
};
using ReportItem = std::variant<ReportHeading, ReportText, ReportLines, ReportPicture, api::DataHandle>;

struct Report {
    std::string title;
    std::string author = {};
    std::vector<ReportItem> items = {};
};
using ReportHandle = std::shared_ptr<Report>;

extern const lua::Class report_functions;
extern const lua::Class report_class;

/// Redirects saved reports to this function instead of files: --report adds their parts to the page of the script.
void take_saved_reports_by(void (*take)(const Report& report));

ReportPicture drawn(const api::Picture& picture);
ReportPicture drawn(const api::Animation& animation);

/// A self-contained page: pictures are inline SVG, printed on A4.
std::string html_of(const Report& report);

// --report: turns the output and pictures of a script into a page.

/// While this object lives, standard output and shown pictures are collected in a report, in their order.
class ScriptReport : text::NotCopied {
public:
    /// `errors`: the script's standard error, collected elsewhere.
    ScriptReport(std::string script, const std::string& errors);
    ~ScriptReport();

    /// Writes the page into the current folder: lab.html for ../lab.lua, with the script and errors at its end, and
    /// restores standard output. Returns the file name.
    text::Expected<std::string> save();

private:
    void take_printed();
    void give_back();

    Report report_;
    std::string script_;
    const std::string& errors_;
    int output_;   // original standard output
    int printed_;  // an anonymous temporary file
    std::size_t taken_ = 0;
};

}  // namespace dinal::lab
