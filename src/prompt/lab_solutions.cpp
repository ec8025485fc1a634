#include "prompt/lab_solutions.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "api/lab_course.hpp"
#include "files/file.hpp"
#include "prompt/user_files.hpp"
#include "text/words.hpp"

namespace dinal::prompt {

// NOTE: the file is the very text that is built in. Who has it can read the answers out of it, so nothing is lost by
// showing them; who has not cannot make it.
text::Expected<std::string> solutions_of(const std::string& student) {
    const std::string file = lab_course_file();
    const auto text = files::read_file(file);
    if (!text) {
        return text::Error{"--lab-solutions is for instructors: it needs their file " +
                           (file.empty() ? "~/.config/dinal/lab-course.lua" : file) + " (docs/lab/instructor.md)"};
    }
    if (*text != api::lab_course_text()) {
        return text::Error{file + " is not the course of this program: make it again, as docs/lab/instructor.md says"};
    }
    return api::lab_solutions(student);
}

std::optional<text::Error> add_sheets(const std::string& folder) {
    std::error_code wrong;
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder, wrong)) {
        const std::string name = entry.path().filename();
        if (text::ending_of(name) == ".lua" && name != "template.lua") names.push_back(entry.path());
    }
    if (wrong || names.empty()) {
        return text::Error{"--sheets: there is no sheet in '" + folder + "'" + (wrong ? ": " + wrong.message() : "")};
    }
    std::sort(names.begin(), names.end());
    std::vector<api::LabSheet> sheets;
    for (const std::string& name : names) {
        auto text = files::read_file(name);
        if (!text) return text.error();
        sheets.push_back({name, std::move(text).value()});
    }
    api::add_lab_sheets(std::move(sheets));
    return std::nullopt;
}

text::Expected<std::string> test_sheet(const std::string& file) {
    auto text = files::read_file(file);
    if (!text) return text.error();
    api::add_lab_sheets({{file, std::move(text).value()}});
    return api::lab_sheet_test();
}

}  // namespace dinal::prompt
