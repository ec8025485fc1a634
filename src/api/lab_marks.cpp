// The verdicts on answers, kept where no script can touch them: in the file of --lab-marks for the instructor, in a
// file of the user so that wrong values count in the next session, and in memory for --report.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "api/lab_course.hpp"
#include "files/journal.hpp"

namespace dinal::api {
namespace {

struct LabJournal {
    files::Journal file;
    std::string script;
};

std::optional<LabJournal> journal;      // set once, before any script runs
std::string (*tries_file)() = nullptr;  // the same
std::optional<text::Error> lost_mark;   // the first line that could not be written
std::vector<LabMark> session_answers;

constexpr const char* trial_question = "0";  // for trying check out: never kept

/// A field of CSV: in quotes, with quotes doubled and without an end of line, so that no file name breaks a line.
std::string quoted_field(std::string_view text) {
    std::string field = "\"";
    for (const char c : text) {
        field += c == '"' ? "\"\"" : std::string(1, c == '\n' || c == '\r' ? ' ' : c);
    }
    return field + '"';
}

std::string beginning_of(std::int64_t number, std::string_view question) {
    return fmt::format("{},{},", number, question);
}

void keep_wrong_value(const LabMark& mark) {
    const auto file = tries_file != nullptr ? files::Journal::open(tries_file()) : text::Error{};
    if (file) static_cast<void>(file->add(fmt::format("{}{}", beginning_of(mark.number, mark.question), mark.value)));
}

void remember(const LabMark& mark) {
    const auto found = std::find_if(session_answers.begin(), session_answers.end(), [&](const LabMark& answer) {
        return answer.number == mark.number && answer.question == mark.question;
    });
    found != session_answers.end() ? * found = mark : session_answers.emplace_back(mark);
}

}  // namespace

std::optional<text::Error> note_lab_answers(const std::string& file, const std::string& script) {
    auto opened = files::Journal::open(file);
    if (!opened) {
        return opened.error();
    }
    journal = LabJournal{std::move(opened).value(), script};
    note_lab_mark({.verdict = "begun"});
    return lost_mark;
}

void keep_lab_tries(std::string (*file)()) {
    tries_file = file;
}

std::optional<text::Error> lost_lab_mark() {
    return lost_mark;
}

void note_lab_mark(const LabMark& mark) {
    if (mark.verdict != "begun") remember(mark);
    if (mark.verdict == "wrong" && mark.question != trial_question) keep_wrong_value(mark);
    if (journal) {
        const auto wrong = journal->file.add(fmt::format("{},{},{},{},{},{},{}", quoted_field(journal->script),
                                                         mark.number, mark.question, mark.verdict, mark.tries,
                                                         mark.value, quoted_field(mark.said)));
        if (!lost_mark) lost_mark = wrong;  // the script goes on: the fault is not its own
    }
}

const std::vector<LabMark>& lab_answers() {
    return session_answers;
}

std::vector<double> earlier_wrong_values(std::int64_t number, const std::string& question) {
    std::vector<double> values;
    std::ifstream lines(tries_file != nullptr ? tries_file() : "");  // outside of what a confined script can read
    const std::string beginning = beginning_of(number, question);
    for (std::string line; std::getline(lines, line);) {
        double value = 0;
        if (!line.starts_with(beginning)) continue;
        const auto parsed = std::from_chars(line.data() + beginning.size(), line.data() + line.size(), value);
        if (parsed.ec == std::errc()) values.push_back(value);
    }
    return values;
}

}  // namespace dinal::api
