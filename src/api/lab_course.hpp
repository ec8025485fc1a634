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

#include "lua/bind.hpp"
#include "lua/memory_limit.hpp"

namespace dinal::api {

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
    lua::MemoryCharge charge_;  // its allocator is Lua's own, which does not count
};

/// Whether there can be a student of that number.
[[nodiscard]] bool is_student_number(std::int64_t number) noexcept;
constexpr std::int64_t greatest_student_number = 999'999'999;

/// The text of the course as it was built into the program.
std::string lab_course_text();

/// All answers of a number, for instructors. Fails when there is no such number.
text::Expected<std::string> lab_solutions(std::string_view number);

/// From now on each answer that is judged is noted at the end of that file, for this script; the first line says that
/// it has begun. Says why that cannot be done, if so.
std::optional<text::Error> note_lab_answers(const std::string& file, const std::string& script);

/// Why an answer could not be noted; nothing when all are.
std::optional<text::Error> lost_lab_mark();

/// A line of that file: what became of a question. Nothing without note_lab_answers.
struct LabMark {
    std::int64_t number = 0;
    std::string_view question = {};
    std::string_view verdict = {};  ///< "right", "wrong", "begun"
    int tries = 0;
    double value = 0;
};
void note_lab_mark(const LabMark& mark);

}  // namespace dinal::api
