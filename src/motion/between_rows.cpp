#include "motion/between_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "text/words.hpp"

namespace dinal::motion {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Returns both ends, evenly spaced times between them, events, and the times just before events, where velocity and M
/// may jump.
std::vector<double> first_times(const Run& run, double from, double to) {
    constexpr int intervals = 1000;
    std::vector<double> times;
    for (int i = 0; i <= intervals; ++i) times.push_back(std::lerp(from, to, static_cast<double>(i) / intervals));
    for (const model::Event& event : run.events) {
        if (!(event.t > from && event.t < to)) continue;
        times.push_back(event.t);
        if (event.kind != model::EventKind::turn) times.push_back(std::nextafter(event.t, from));
    }
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

/// Returns the deviation of each column that is too small to see in a plot.
std::vector<double> invisible(const std::vector<double>& values, std::size_t width) {
    constexpr double part = 1e-3, rounding = 1e-12;
    std::vector<double> all;
    for (std::size_t c = 0; c < width; ++c) {
        double low = values[c], high = low;
        for (std::size_t i = c; i < values.size(); i += width) {
            low = std::min(low, values[i]);
            high = std::max(high, values[i]);
        }
        all.push_back(part * (high - low) + rounding * std::max(std::fabs(low), std::fabs(high)));
    }
    return all;
}

}  // namespace

BetweenRows::BetweenRows(const Run& run, const model::Excitation* M) : run_(run), M_(M) {
    if (!run.course || !(run.course->whole_until() >= run.t_stop) || !(run.t_stop > run.t_start)) return;
    const std::vector<std::string>& names = run.names();
    for (Eigen::Index c = 0; c < static_cast<Eigen::Index>(names.size()); ++c) {
        using By = ColumnKind::By;
        const bool is_state = c >= static_cast<Eigen::Index>(run.first_state());
        const ColumnKind* kind = is_state ? nullptr : find_column_kind(names[static_cast<std::size_t>(c)]);
        const bool known =
            kind != nullptr && (kind->by == By::motion || (kind->by == By::load && M != nullptr && agrees_with_rows()));
        if (is_state || known) columns_.push_back(c), kinds_.push_back(kind);
    }
}

/// Returns whether M still gives the M of the rows. A user's function may read a variable that has changed since.
bool BetweenRows::agrees_with_rows() const {
    if (!M_->has_script()) return true;
    constexpr Eigen::Index looks = 20;
    constexpr double same = 1e-9;
    const Rows& rows = run_.rows;
    const auto column = static_cast<Eigen::Index>(Column::M);
    if (rows.rows() == 0) return false;
    const double size = rows.col(column).cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < rows.rows(); i += std::max<Eigen::Index>(1, rows.rows() / looks)) {
        const double M = M_->value(rows(i, 0), {rows(i, 1), rows(i, 2)});
        if (!(std::fabs(M - rows(i, column)) <= same * size)) return false;
    }
    return true;
}

void BetweenRows::append_values(double t, std::vector<double>& values) const {
    const auto state = run_.course->at(t);
    const model::State y = state ? *state : model::State{unknown, unknown};
    const std::vector<double> states = run_.states > 0 ? run_.course->states_at(t) : std::vector<double>();
    const auto first_state = static_cast<Eigen::Index>(run_.first_state());
    const bool load = std::ranges::any_of(
        kinds_, [](const ColumnKind* kind) { return kind != nullptr && kind->by == ColumnKind::By::load; });
    const AtRow at{t, y, load ? M_->value(t, y) : unknown, unknown, run_.course->system().damping()};
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        values.push_back(kinds_[i] != nullptr ? kinds_[i]->value(at)
                                              : states[static_cast<std::size_t>(columns_[i] - first_state)]);
    }
}

double BetweenRows::interpolated(Eigen::Index column, double t) const {
    const auto times = run_.rows.col(0);
    if (times.size() == 0) return unknown;
    const Eigen::Index after = std::ranges::upper_bound(times, t) - times.begin();
    if (after == 0 || after == times.size()) return run_.rows(std::max<Eigen::Index>(after - 1, 0), column);
    const double part = (t - times[after - 1]) / (times[after] - times[after - 1]);
    return std::lerp(run_.rows(after - 1, column), run_.rows(after, column), part);
}

Run BetweenRows::drawn(double from, double to, const Monitor& monitor) const {
    constexpr std::size_t enough = 100'000;  // limit of times; one more pass may double their number
    constexpr double part = 0.381966;        // the golden section avoids aliasing with the motion
    const double shortest = 1e-5 * (to - from);
    const std::size_t width = columns_.size();
    std::vector<double> times = first_times(run_, from, to), values;
    const auto goes_on = [&](std::size_t i) { return i % 1024 != 0 || monitor(times[i]); };
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (!goes_on(i)) return run_;
        append_values(times[i], values);
    }
    const std::vector<double> small = invisible(values, width);
    std::vector<char> straight(times.size(), 0);  // whether each interval is drawn straight
    straight.back() = 1;
    while (times.size() < enough && text::contains(straight, 0)) {
        std::vector<double> more_times, more_values;
        std::vector<char> more_straight;
        for (std::size_t i = 0; i < times.size(); ++i) {
            if (!goes_on(i)) return run_;
            const auto here = values.begin() + static_cast<std::ptrdiff_t>(i * width);
            more_times.push_back(times[i]);
            more_values.insert(more_values.end(), here, here + static_cast<std::ptrdiff_t>(width));
            more_straight.push_back(1);
            if (straight[i] != 0 || times[i + 1] - times[i] < shortest) continue;
            more_times.push_back(std::lerp(times[i], times[i + 1], part));
            append_values(more_times.back(), more_values);
            for (std::size_t c = 0; c < width; ++c) {
                const double chord = std::lerp(values[i * width + c], values[(i + 1) * width + c], part);
                if (std::fabs(more_values[more_values.size() - width + c] - chord) > small[c]) more_straight.back() = 0;
            }
            more_straight.push_back(more_straight.back());
        }
        times = std::move(more_times), values = std::move(more_values), straight = std::move(more_straight);
    }
    const std::vector<std::string>& names = run_.names();
    Growing<double> table(times.size(), names.size());
    for (std::size_t c = 0; c < names.size(); ++c) {
        const auto column = static_cast<Eigen::Index>(c);
        const auto place = std::ranges::find(columns_, column);
        for (std::size_t i = 0; i < times.size(); ++i) {
            table.writable_values()[c * times.size() + i] =
                names[c] == "t"           ? times[i]
                : place != columns_.end() ? values[i * width + static_cast<std::size_t>(place - columns_.begin())]
                                          : interpolated(column, times[i]);
        }
    }
    Run drawn = run_;
    drawn.rows = Rows(std::move(table));
    return drawn;
}

}  // namespace dinal::motion
