// The progress line: on standard error when that is a terminal, after half a second, ten times a second, erased in the
// end. A program that is not a terminal, such as a notebook, gets the same line by a function of its own.
//
// What is under way is a stack: a run within a loop within a loop. The line is that of the outermost, and what lies
// within it counts as the part of a step that is done.
#pragma once

#include <cstddef>
#include <string>

namespace dinal::terminal {

// How far a computation has come, as one line that fits the window.

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

class Progress {
public:
    /// Of a loop: `total` steps, infinity when nobody knows.
    static Progress of_steps(std::string label, double total) { return {std::move(label), 0, total, Kind::steps}; }
    /// Of a run from one time to another.
    static Progress of_time(double start, double end) { return {"", start, end, Kind::time}; }
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// To be called often, with the number of steps that are done, or the time reached.
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

/// From now on this function gets each line in place of the terminal, and "" when the line goes. It is called on the
/// thread of the progress, and what scripts print needs no room from it. nullptr: the terminal again.
using ProgressViewer = void (*)(const std::string& line);
void show_progress_by(ProgressViewer viewer);

/// From now on nothing that is under way on this thread is shown: it is a part of what another thread waits for.
void show_no_progress_here();

/// Something else is about to be written to the terminal: the line goes, until there is something new to say.
/// `ends_line` is false when what is written leaves the cursor within a line, which nothing may then write over.
void make_way_for_output(bool ends_line);

/// What ran has ended, however it ended: the line goes, and what was under way is forgotten.
void end_progress();

}  // namespace dinal::terminal
