// How far a computation has come, as one line that fits the window.
#pragma once

#include <cstddef>
#include <string>

namespace dinal::terminal {

enum class Letters { ascii, utf8 };

struct ProgressFacts {
    std::string label;        ///< the user's; anything may be in it
    double fraction = 0;      ///< 0 to 1; less than 0 when nobody knows
    std::string done;         ///< "3 of 10"
    std::string rate;         ///< "12/s"
    double seconds_left = 0;  ///< only when there is a fraction
};

/// "sweep   42% [########............] 42 of 100, 3.2/s, 0:18 left" in at most so many columns. What does not fit goes,
/// the least important first: `done`, most of the bar, the rate, all of the bar, the time, the end of the label.
std::string progress_text(const ProgressFacts& facts, std::size_t columns, Letters letters);

/// "8 s", "2:05", "1:02:05"
std::string duration_text(double seconds);

}  // namespace dinal::terminal
