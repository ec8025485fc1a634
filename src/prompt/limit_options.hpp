// --max-memory and --max-time: from the words of the command line to limits.
#pragma once

#include <optional>
#include <string_view>

#include "lua/limits.hpp"
#include "text/expected.hpp"

namespace dinal::prompt {

/// Which of the two a word is, "--max-time" also for "--max-time=10"; empty when it is none.
std::string_view limit_option(std::string_view word);

/// Fails with a sentence about a value that is no size or no time.
std::optional<text::Error> set_limit(lua::ScriptLimits& limits, std::string_view option, std::string_view value);

/// What safe mode allows where the user has not said otherwise.
void complete_safe_limits(lua::ScriptLimits& limits);

}  // namespace dinal::prompt
