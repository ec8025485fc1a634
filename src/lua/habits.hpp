// What people write who know other languages, or other decimal marks, and what to write instead.
#pragma once

#include <string>
#include <string_view>

namespace dinal {

/// The end of a sentence about an error, "; comparing is ==", or "". `statement` is where it happened.
std::string habit_of_others(std::string_view words, std::string_view statement);

}  // namespace dinal
