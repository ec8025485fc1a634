// The fields of a line of comma separated values, whatever separates them, for the readers of this folder.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dinal::files {

enum class Separator : char { comma = ',', semicolon = ';', tab = '\t', blanks = ' ' };

/// The first of these that stands in the line outside of quotes; nothing in a line of one field.
std::optional<Separator> separator_in(std::string_view line);

/// The fields of a line, without the blanks around them; quotes stay.
void split(std::string_view line, Separator separator, std::vector<std::string_view>& fields);

/// Whether a field of the line begins with a quote that the line does not close. (One within a word is an inch.)
bool is_left_open(std::string_view line);

/// The word in a field: without its quotes, doubled quotes inside made single. The number of the field when it is
/// empty.
std::string name_in(std::string_view field, std::size_t number);

}  // namespace dinal::files
