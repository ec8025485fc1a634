// The lab course (src/lab): tasks of a student number and judging of answers, in a Lua state of its own.
//
// The build scrambles the course, so that neither searching the program file nor a script reveals an answer. It is not
// secret from those who read the source or disassemble the program (docs/lab/instructor.md).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lua/bind.hpp"

namespace dinal::lab {

extern const lua::Class lab_module;
extern const lua::Class check_functions;

class LabCourse {
public:
    /// A new state with the course. Raises an error in L if memory is insufficient.
    explicit LabCourse(lua_State* L);

    /// Calls course.FUNCTION with arguments from the top of L, replaces them by the results and returns their number.
    /// Numbers, text, vectors, data and tables of these are converted. Fails with an error raised there.
    text::Expected<int> call(lua_State* L, const char* function, int arguments);

private:
    std::unique_ptr<lua_State, void (*)(lua_State*)> state_;
};

/// The student number set with lab.number; 0: none.
[[nodiscard]] std::int64_t lab_number_of(lua_State* L);

[[nodiscard]] bool is_student_number(std::int64_t number) noexcept;
constexpr std::int64_t greatest_student_number = 999'999'999;

std::string lab_course_text();

/// An additional sheet: file name and text.
struct LabSheet {
    std::string name, text;
};
/// Adds these sheets to every course opened from now on.
void add_lab_sheets(std::vector<LabSheet> sheets);

/// All answers for a student number, for instructors. Fails if the number is invalid.
text::Expected<std::string> lab_solutions(std::string_view number);

/// The initial script for a student.
struct LabStart {
    std::string file, text;
    std::string said;  ///< about the file, in the language of the sheet
};
/// The script for a sheet, "1" or "hoja-1", and a student number. Fails if either is invalid.
text::Expected<LabStart> lab_start(const std::string& sheet, std::string_view number);

/// Tests the last added sheet with twenty student numbers. Returns a student's view, or fails with the first fault.
text::Expected<std::string> lab_sheet_test();

/// The names of all questions, "1a 1b ...".
text::Expected<std::string> lab_question_names();

/// Appends each judged answer of this script to the file, after a first line for its start. Returns an error if the
/// file cannot be written.
std::optional<text::Error> start_answer_log(const std::string& file, const std::string& script);

/// Sets the file of wrong values from earlier sessions; Tries::write also adds those of this one. If the file cannot be
/// written, they count in this session only.
enum class Tries { read, write };
void keep_lab_tries(std::string (*file)(), Tries use);

/// The error if an answer could not be stored.
std::optional<text::Error> lost_lab_mark();

/// The verdict on one answer.
struct LabMark {
    std::int64_t number = 0;
    std::string question = {};
    std::string verdict = {};  ///< "right", "wrong", "begun"
    int tries = 0;
    double value = 0;
    std::string said = {};
};
void note_lab_mark(const LabMark& mark);

/// The answers of this session in the order in which they were first judged, each with its last verdict.
const std::vector<LabMark>& lab_answers();

std::vector<double> earlier_wrong_values(std::int64_t number, const std::string& question);

}  // namespace dinal::lab
