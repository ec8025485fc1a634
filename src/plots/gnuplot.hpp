// The program gnuplot as a filter: commands in, a picture out.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "text/expected.hpp"

namespace dinal::plots {

struct GnuplotLimits {
    std::function<bool()> go_on = {};  ///< asked now and then, and after each signal; gnuplot is killed when it says no
    std::size_t memory = 0;            ///< bytes above what gnuplot itself needs; 0: no limit
};

/// What gnuplot writes to its standard output for these commands. It never learns the name of a file, and reads no
/// settings of its user. Fails when it is not installed, and with its own words when it complains.
text::Expected<std::string> run_gnuplot(std::string_view commands, const GnuplotLimits& limits = {});

}  // namespace dinal::plots
