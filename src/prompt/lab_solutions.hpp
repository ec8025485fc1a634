// dinal --lab-solutions NUMBER: the answers of the lab, for those who have the text of the course.
#pragma once

#include <string>

#include "text/expected.hpp"

namespace dinal::prompt {

/// Fails with a sentence when this user has no file of the instructor, or that of another version.
text::Expected<std::string> solutions_of(const std::string& student);

}  // namespace dinal::prompt
