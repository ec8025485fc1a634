#include "api/script_report.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "api/lab_course.hpp"
#include "files/file.hpp"
#include "lua/interrupt.hpp"
#include "text/words.hpp"

namespace dinal::api {
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
