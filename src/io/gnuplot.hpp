// The program gnuplot as a filter: commands in, a picture out.
#pragma once

#include <string>
#include <string_view>

#include "core/expected.hpp"

namespace dinal {

/// What gnuplot writes to its standard output for these commands. It never learns the name of a file, and reads no
/// settings of its user. Fails when it is not installed, and with its own words when it complains.
Expected<std::string> run_gnuplot(std::string_view commands);

}  // namespace dinal
