// The progress line: on standard error when that is a terminal, after half a second, ten times a second, erased in the
// end.
//
// What is under way is a stack: a run within a loop within a loop. The line is that of the outermost, and what lies
// within it counts as the part of a step that is done.
#pragma once

#include <string>

#include "terminal/progress_text.hpp"

namespace dinal::terminal {

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

/// From now on nothing that is under way on this thread is shown: it is a part of what another thread waits for.
void show_no_progress_here();

/// Something else is about to be written to the terminal: the line goes, until there is something new to say.
/// `ends_line` is false when what is written leaves the cursor within a line, which nothing may then write over.
void make_way_for_output(bool ends_line);

/// What ran has ended, however it ended: the line goes, and what was under way is forgotten.
void end_progress();

}  // namespace dinal::terminal
