// The progress line: on standard error if that is a terminal, shown after half a second, redrawn ten times a second and
// erased at the end. Other front ends, such as a notebook, get the same line through a function.
//
// Tasks form a stack: a run within a loop within a loop. The line shows the outermost; progress of the inner ones
// counts as part of its current step.
#pragma once

#include <cstddef>
#include <string>

#include "text/not_copied.hpp"

namespace dinal::terminal {

// The progress of a computation as one line that fits the window.

enum class Letters { ascii, utf8 };

struct ProgressFacts {
    std::string label;        ///< given by the user; may contain any bytes
    double fraction = 0;      ///< 0 to 1; negative if unknown
    std::string done;         ///< "3 of 10"
    std::string rate;         ///< "12/s"
    double seconds_left = 0;  ///< valid if the fraction is known
};

/// "sweep   42% [########............] 42 of 100, 3.2/s, 0:18 left" in at most `columns`. If it is too long, parts are
/// dropped in this order: `done`, most of the bar, the rate, all of the bar, the time, the end of the label.
std::string progress_text(const ProgressFacts& facts, std::size_t columns, Letters letters);

/// "8 s", "2:05", "1:02:05"
std::string duration_text(double seconds);

class Progress : text::NotCopied {
public:
    /// A loop of `total` steps; infinity if their number is unknown.
    static Progress of_steps(std::string label, double total) { return {std::move(label), 0, total, Kind::steps}; }
    /// A run from one time to another.
    static Progress of_time(double start, double end) { return {"", start, end, Kind::time}; }
    ~Progress();

    /// Reports the number of steps done, or the time reached. Cheap: call it often.
    void advance(double reached);

private:
    enum class Kind { steps, time };
    Progress(std::string label, double start, double end, Kind kind);
    friend double fraction_from(std::size_t place);
    friend ProgressFacts facts();

    std::string label_;
    double start_, end_, reached_;
    Kind kind_;
    long began_ms_;
    bool hidden_;
};

/// Redirects each line to this function instead of the terminal; "" means that the line disappears. The function is
/// called on the progress thread. nullptr: the terminal again.
using ProgressViewer = void (*)(const std::string& line);
void show_progress_by(ProgressViewer viewer);

/// Hides all progress of this thread, because another thread reports the progress of its task.
void show_no_progress_here();

/// Removes the line before other output; the next progress shows it again. `ends_line`: whether that output ends its
/// line; otherwise nothing may be written over it.
void make_way_for_output(bool ends_line);

/// Removes the line and clears the stack, however the task ended.
void end_progress();

}  // namespace dinal::terminal
