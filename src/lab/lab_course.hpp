// The lab course (src/lab): what belongs to a student number, and the judging of answers, in a Lua state of its own.
//
// The build puts the course into the program scrambled, so that neither a look into the program nor a script shows an
// answer. It is no secret from those who read its source or take the program apart (docs/lab/instructor.md).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lua/bind.hpp"

namespace dinal::lab {

/// lab.NAME and check.
void register_lab(lua_State* L);
extern const lua::Class lab_module;
extern const lua::Class check_functions;

class LabCourse {
public:
    /// A new state with the course in it. Raises in L when there is no memory for it.
    explicit LabCourse(lua_State* L);

    /// Calls course.FUNCTION there with so many arguments from the top of L, which it takes, and puts the results in
    /// their stead; returns how many. Numbers, text, vectors, data and tables of these pass. Fails with the sentence of
    /// an error there.
    text::Expected<int> call(lua_State* L, const char* function, int arguments);

private:
    std::unique_ptr<lua_State, void (*)(lua_State*)> state_;
};

/// The student number that the script has set with lab.number; 0: none.
[[nodiscard]] std::int64_t lab_number_of(lua_State* L);

/// Whether there can be a student of that number.
[[nodiscard]] bool is_student_number(std::int64_t number) noexcept;
constexpr std::int64_t greatest_student_number = 999'999'999;

/// The text of the course as it was built into the program.
std::string lab_course_text();

/// A sheet that is not built in: the file's name and its text.
struct LabSheet {
    std::string name, text;
};
/// Every course that is opened from now on has these sheets as well.
void add_lab_sheets(std::vector<LabSheet> sheets);

/// Returns all answers of a number, for instructors. Fails when there is no such number.
text::Expected<std::string> lab_solutions(std::string_view number);

/// The script with which a student begins.
struct LabStart {
    std::string file, text;
    std::string said;  ///< about the file, in the language of the sheet
};
/// That of a sheet, "1" or "hoja-1", and a student number. Fails when there is no such sheet or number.
text::Expected<LabStart> lab_start(const std::string& sheet, std::string_view number);

/// Works the last sheet that was added with twenty student numbers. Returns what a student sees, or fails with the
/// first fault.
text::Expected<std::string> lab_sheet_test();

/// The names of all questions, "1a 1b ...".
text::Expected<std::string> lab_question_names();

/// Notes each judged answer at the end of that file from now on, for this script; the first line says that it has
/// begun. Returns the reason if the file cannot be written.
std::optional<text::Error> note_lab_answers(const std::string& file, const std::string& script);

/// Wrong values of earlier sessions stand in the file of that name; those of this one are added with Tries::write. If
/// it cannot be written they count in this session only.
enum class Tries { read, write };
void keep_lab_tries(std::string (*file)(), Tries use);

/// The reason why an answer could not be noted; nothing if all are noted.
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

/// The wrong values that earlier sessions kept for this question.
std::vector<double> earlier_wrong_values(std::int64_t number, const std::string& question);

}  // namespace dinal::lab
