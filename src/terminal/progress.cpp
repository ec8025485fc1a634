#include "terminal/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <mutex>
#include <string_view>
#include <vector>

#include "terminal/display.hpp"
#include "text/characters.hpp"

namespace dinal::terminal {

namespace {

constexpr long first_ms = 500;
constexpr long period_ms = 100;
constexpr long never_ms = std::numeric_limits<long>::max();

std::vector<Progress*> under_way;  // the outermost first
long next_ms = never_ms;           // time of the next redraw
std::size_t drawn = 0;             // columns of the line on the screen, or more; 0: no line
bool within_line = false;          // whether the script has written part of a line
std::mutex drawing;                // output of other threads erases the line, too
thread_local bool hides_progress = false;
ProgressViewer viewer = nullptr;  // replaces the terminal if set

/// A clock with a resolution of some milliseconds, cheap enough for a stepping loop.
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
    if (drawn > 0 && viewer != nullptr) {
        viewer("");
        drawn = 0;
    }
    if (drawn > 0) {
        write_line(obeys_escapes() ? "\r\x1b[K" : "\r" + std::string(drawn, ' ') + "\r");
        drawn = 0;
    }
}

}  // namespace

/// The fraction done of the task at `place` of the stack, including the tasks inside it. Negative if unknown.
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
    next_ms = viewer != nullptr || isatty(STDERR_FILENO) != 0 ? now + period_ms : never_ms;
    const std::lock_guard lock(drawing);
    if (viewer != nullptr) {
        constexpr std::size_t page = 79;  // columns that a web page shows without wrapping
        viewer(progress_text(facts(), page, Letters::utf8));
        drawn = page;
        return;
    }
    if (next_ms == never_ms || within_line) {
        return;
    }
    const Display screen = display_of(STDERR_FILENO);
    // The last column stays empty: some terminals wrap after writing it.
    const auto columns = static_cast<std::size_t>(screen.columns) - 1;
    const std::string text = progress_text(facts(), columns, screen.draws ? Letters::utf8 : Letters::ascii);
    erase();
    write_line(text + "\r");  // to the start, so that the terminal's ^C does not wrap the line
    drawn = columns;
}

void show_progress_by(ProgressViewer new_viewer) {
    viewer = new_viewer;
}

void show_no_progress_here() {
    hides_progress = true;
}

void make_way_for_output(bool ends_line) {
    if (viewer != nullptr) return;
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

namespace {

constexpr std::size_t longest_bar = 30;  // columns between its ends
constexpr std::size_t shortest_bar = 6;

/// A text and its width in columns.
struct MeasuredText {
    std::string text;
    std::size_t width = 0;
};

MeasuredText ascii_piece(std::string text) {
    const std::size_t width = text.size();
    return {std::move(text), width};
}

/// The label, cut to `columns`.
MeasuredText label_piece(const std::string& label, std::size_t columns, Letters letters) {
    const std::string clean = text::displayable(label);
    const std::string shown = letters == Letters::utf8 ? clean : text::in_ascii(clean);
    if (text::columns(shown) <= columns) {
        return {shown, text::columns(shown)};
    }
    const std::string_view dots = letters == Letters::utf8 ? "…" : ".";
    const std::string cut = columns > 0 ? std::string(text::cut_to_columns(shown, columns - 1)).append(dots) : "";
    return {cut, text::columns(cut)};
}

/// A bar of `columns` including its ends.
MeasuredText bar_piece(double fraction, std::size_t columns, Letters letters) {
    constexpr std::array<const char*, 8> parts{"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
    const std::size_t inner = columns - 2;
    const double filled = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(inner);
    const auto whole = static_cast<std::size_t>(filled);
    std::string text = letters == Letters::utf8 ? "▕" : "[";
    for (std::size_t i = 0; i < whole; ++i) {
        text += letters == Letters::utf8 ? "█" : "#";
    }
    std::size_t rest = inner - whole;
    if (letters == Letters::utf8 && rest > 0) {
        const std::string_view part = parts.at(static_cast<std::size_t>((filled - std::floor(filled)) * 8));
        text += part;
        rest -= part.empty() ? 0 : 1;
    }
    text.append(rest, letters == Letters::utf8 ? ' ' : '.').append(letters == Letters::utf8 ? "▏" : "]");
    return {text, columns};
}

/// Joins pieces by blanks; empty ones take no space.
MeasuredText joined(const std::vector<MeasuredText>& pieces) {
    MeasuredText result;
    for (const MeasuredText& piece : pieces) {
        if (piece.width > 0) {
            result.text += (result.width > 0 ? " " : "") + piece.text;
            result.width += (result.width > 0 ? 1 : 0) + piece.width;
        }
    }
    return result;
}

MeasuredText listed(const std::vector<std::string>& facts) {
    std::vector<std::string_view> there(facts.begin(), facts.end());
    there.erase(std::remove(there.begin(), there.end(), ""), there.end());
    return ascii_piece(fmt::format("{}", fmt::join(there, ", ")));
}

}  // namespace

std::string progress_text(const ProgressFacts& facts, std::size_t columns, Letters letters) {
    const bool known = facts.fraction >= 0;
    const MeasuredText label = label_piece(facts.label, columns / 3, letters);
    // Rounded down: 100% must not appear before the end.
    const MeasuredText percent = ascii_piece(known ? fmt::format("{:3.0f}%", std::floor(100 * facts.fraction)) : "");
    const std::string left = known ? duration_text(facts.seconds_left) + " left" : "";
    const std::array<std::vector<std::string>, 4> choices{
        {{facts.done, facts.rate, left}, {facts.rate, left}, {left}, {}}};
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const MeasuredText tail = listed(choices.at(i));
        const std::size_t taken = joined({label, percent, tail}).width + (known ? 1 : 0);
        const std::size_t room = columns > taken ? columns - taken : 0;
        const std::size_t least = (i == 0 ? 2 : 1) * shortest_bar + 2;
        if (known && room >= least) {
            return joined({label, percent, bar_piece(facts.fraction, std::min(room, longest_bar + 2), letters), tail})
                .text;
        }
        const bool without_bar = taken <= columns && (!known || i >= 2);
        if (without_bar) {
            return joined({label, percent, tail}).text;
        }
    }
    return percent.width <= columns ? percent.text : "";
}

std::string duration_text(double seconds) {
    constexpr double longest = 360'000;  // 100 hours
    if (!(seconds < longest)) {
        return fmt::format("{:.0f} days", seconds < 1e9 ? seconds / 86'400 : 1e6);
    }
    const auto whole = static_cast<int>(std::ceil(seconds));
    if (whole < 60) {
        return fmt::format("{} s", whole);
    }
    return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                        : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace dinal::terminal
