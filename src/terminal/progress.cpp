#include "terminal/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <mutex>
#include <vector>

#include "terminal/display.hpp"

namespace dinal::terminal {

namespace {

constexpr long first_ms = 500;
constexpr long period_ms = 100;
constexpr long never_ms = std::numeric_limits<long>::max();

std::vector<Progress*> under_way;  // the outermost first
long next_ms = never_ms;           // when the line is drawn next
std::size_t drawn = 0;             // columns of the line that stands there, or more; 0: there is none
bool within_line = false;          // the script has written a part of a line
std::mutex drawing;                // what threads beside that of the progress write erases the line, too
thread_local bool hides_progress = false;

/// Some milliseconds coarse and very quick: a stepping loop asks for it.
long now_ms() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC_COARSE, &now);
    return static_cast<long>(now.tv_sec) * 1000 + now.tv_nsec / 1'000'000;
}

void write_line(const std::string& text) {
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
    static_cast<void>(std::fflush(stderr));
}

void erase() {
    if (drawn > 0) {
        write_line(obeys_escapes() ? "\r\x1b[K" : "\r" + std::string(drawn, ' ') + "\r");
        drawn = 0;
    }
}

}  // namespace

/// Of what is under way at that place of the stack, what lies within included. Less than 0: nobody knows.
double fraction_from(std::size_t place) {
    const Progress& own = *under_way[place];
    if (!std::isfinite(own.end_)) {
        return -1;
    }
    const bool counts = own.kind_ == Progress::Kind::steps && place + 1 < under_way.size();
    const double within = counts ? std::max(fraction_from(place + 1), 0.0) : 0.0;
    const double whole = own.end_ - own.start_;
    return whole > 0 ? std::clamp((own.reached_ - own.start_ + within) / whole, 0.0, 1.0) : 1.0;
}

ProgressFacts facts() {
    const Progress& outermost = *under_way.front();
    const double seconds = static_cast<double>(std::max(now_ms() - outermost.began_ms_, 1L)) / 1000;
    const double fraction = fraction_from(0);
    const bool steps = outermost.kind_ == Progress::Kind::steps;
    const double done = fraction < 0 ? outermost.reached_ : fraction * (outermost.end_ - outermost.start_);
    return {.label = outermost.label_,
            .fraction = fraction,
            .done = fraction < 0
                        ? fmt::format("{:.15g}", outermost.reached_)
                        : fmt::format("{}{:.4g} of {:.6g}", steps ? "" : "t = ", outermost.reached_, outermost.end_),
            .rate = fmt::format("{:.3g}/s", done / seconds),
            .seconds_left = fraction > 0 ? seconds * (1 - fraction) / fraction : 1e9};
}

Progress::Progress(std::string label, double start, double end, Kind kind)
    : label_(std::move(label)),
      start_(start),
      end_(end),
      reached_(start),
      kind_(kind),
      began_ms_(now_ms()),
      hidden_(hides_progress) {
    if (hidden_) {
        return;
    }
    if (under_way.empty()) {
        next_ms = began_ms_ + first_ms;
    }
    under_way.push_back(this);
}

Progress::~Progress() {
    if (hidden_) {
        return;
    }
    const bool outermost = !under_way.empty() && under_way.front() == this;
    under_way.erase(std::remove(under_way.begin(), under_way.end(), this), under_way.end());
    if (outermost) {
        const std::lock_guard lock(drawing);
        erase();
    }
}

void Progress::advance(double reached) {
    reached_ = reached;
    if (hidden_) {
        return;
    }
    const long now = now_ms();
    if (now < next_ms || under_way.empty()) {
        return;
    }
    next_ms = isatty(STDERR_FILENO) != 0 ? now + period_ms : never_ms;
    const std::lock_guard lock(drawing);
    if (next_ms == never_ms || within_line) {
        return;
    }
    const Display screen = display_of(STDERR_FILENO);
    // Without the last column, in which some terminals go on to the next line.
    const auto columns = static_cast<std::size_t>(screen.columns) - 1;
    const std::string text = progress_text(facts(), columns, screen.draws ? Letters::utf8 : Letters::ascii);
    erase();
    write_line(text + "\r");  // at its beginning, so that the ^C of the terminal is not put behind it and wraps
    drawn = columns;
}

void show_no_progress_here() {
    hides_progress = true;
}

void make_way_for_output(bool ends_line) {
    const std::lock_guard lock(drawing);
    erase();
    within_line = !ends_line;
}

void end_progress() {
    const std::lock_guard lock(drawing);
    erase();
    under_way.clear();
    within_line = false;
}

}  // namespace dinal::terminal
