#include "prompt/lab_solutions.hpp"

#include "api/lab_course.hpp"
#include "files/file.hpp"
#include "prompt/user_files.hpp"

namespace dinal::prompt {

// NOTE: the file is the very text that is built in. Who has it can read the answers out of it, so nothing is lost by
// showing them; who has not cannot make it.
text::Expected<std::string> solutions_of(const std::string& student) {
    const std::string file = lab_course_file();
    const auto text = files::read_file(file);
    if (!text) {
        return text::Error{"--lab-solutions is for instructors: it needs their file " +
                           (file.empty() ? "~/.config/dinal/lab-course.lua" : file) +
                           ", which docs/lab/instructor.md tells of"};
    }
    if (*text != api::lab_course_text()) {
        return text::Error{file + " is not the course of this program; make it again, as docs/lab/instructor.md says"};
    }
    return api::lab_solutions(student);
}

}  // namespace dinal::prompt
