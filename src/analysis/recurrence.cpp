#include "analysis/recurrence.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "motion/stillness.hpp"
#include "text/words.hpp"

namespace dinal::analysis {

std::vector<Stretch> stretches(const motion::Run& run) {
    std::vector<Stretch> list;
    list.reserve(run.events.size() + 1);
    Stretch now{.from = run.t_start, .begin = run.initial, .stuck = run.began_stuck};
    for (const model::Event& event : run.events) {
        const bool lets_go = event.kind == model::EventKind::opened && now.stuck;
        if (event.kind > model::EventKind::impact && !lets_go) continue;
        now.to = event.t;
        now.end = {event.theta, event.velocity};
        now.ended_by = event;
        list.push_back(now);
        now = {.from = event.t, .begin = now.end, .begun_by = event};
        if (event.kind == model::EventKind::impact) now.begin.velocity *= -run.restitution;
        now.stuck = model::is_stop(event.kind);
    }
    now.to = std::max(run.t_stop, now.from);
    now.end = now.stuck && run.left == nullptr ? now.begin : run.state_at_stop;
    list.push_back(now);
    return list;
}

double time_open(const motion::Run& run) {
    bool open = run.began_open;
    double since = run.t_start, time = 0;
    for (const model::Event& event : run.events) {
        if (event.kind != model::EventKind::opened && event.kind != model::EventKind::closed) continue;
        if (open) time += event.t - since;
        open = event.kind == model::EventKind::opened, since = event.t;
    }
    return open ? time + (run.t_stop - since) : time;
}

std::vector<Stretch> half_cycles(const motion::Run& run) {
    if (!run.on_belt) return stretches(run);
    motion::Run swings = run;
    swings.events = motion::Growing<model::Event>(motion::turns_on_belt(run));
    swings.began_stuck = false;
    return stretches(swings);
}

namespace {

constexpr std::size_t most_events = 400;  // events in a period; more are not accepted as periodic
constexpr double same = 1e-7;             // amplitudes: above the rounding of events, below any real change
constexpr double near_enough = 1e-4;      // amplitudes: distance of a steady motion from its limit
constexpr double settling = 0.1;          // amplitudes: distance of a settling motion from its limit

model::EventKind kind_of(const model::Event& event) {
    // A rest is a stick that the end of the run cut off.
    return event.kind == model::EventKind::rest ? model::EventKind::stick : event.kind;
}

/// Tests a period of m events on the last three of them.
class Attempt {
public:
    Attempt(std::span<const model::Event> events, std::size_t m, bool drifting) : events_(events), m_(m) {
        const model::Event& last = events.back();
        const model::Event& before = events[events.size() - 1 - m];
        period_ = last.t - before.t;
        if (drifting) drift_ = last.theta - before.theta;
        const auto [low, high] =
            std::minmax_element(events.end() - 1 - static_cast<std::ptrdiff_t>(m), events.end(),
                                [](const model::Event& a, const model::Event& b) { return a.theta < b.theta; });
        amplitude_ = (high->theta - low->theta) / 2;
        centre_ = low->theta + amplitude_;
    }
    /// The deviation of event i from the event a period before; `never` if the kinds differ.
    double off(std::size_t i) const {
        const model::Event &now = events_[i], &then = events_[i - m_];
        if (kind_of(now) != kind_of(then) || !(amplitude_ > 0) || !(period_ > 0)) return never;
        return std::max(std::fabs(now.theta - then.theta - drift_) / amplitude_,
                        std::fabs(now.t - then.t - period_) / period_);
    }
    /// The worst deviation among the m events before events_[last].
    double worst(std::size_t last, double limit) const {
        double worst = 0;
        for (std::size_t i = last; i > last - m_ && worst <= limit; --i) worst = std::max(worst, off(i - 1));
        return worst;
    }
    std::optional<Recurrence> judge(double allowed) const {
        const std::size_t n = events_.size();
        const double change = worst(n, allowed);
        if (change > allowed) return {};
        const double before = worst(n - m_, never);
        // The geometric series of differences that shrink by change/before each period.
        const double left = change < before ? change / (1 - change / before) : never;
        if (change > same && left > allowed) return {};
        if (drift_ != 0 && (change > same || before > same || std::fabs(drift_) <= near_enough * amplitude_)) return {};
        Recurrence found{.steady = change <= same || left <= near_enough, .period = period_, .drift = drift_};
        found.amplitude = amplitude_;
        found.centre = centre_;
        found.change = change;
        found.until = events_.back().t;
        std::size_t first = n - m_;
        while (first > m_ && off(first - 1) <= 1e-3) --first;
        found.since = events_[first - m_].t;
        count_stops(found);
        return found;
    }

private:
    void count_stops(Recurrence& found) const {
        const std::size_t n = events_.size();
        for (std::size_t i = n - 1 - m_; i + 1 < n; ++i) {
            if (kind_of(events_[i]) != model::EventKind::stick) continue;
            ++found.stops;
            found.stuck += (events_[i + 1].t - events_[i].t) / period_;
        }
    }

    static constexpr double never = 1e300;
    std::span<const model::Event> events_;
    std::size_t m_;
    double period_ = 0, drift_ = 0, amplitude_ = 0, centre_ = 0;
};

}  // namespace

std::vector<model::Event> events_of_motion(const motion::Run& run, const std::vector<model::WantedEvent>& wanted) {
    std::vector<model::Event> events(run.events.begin(), run.events.end());
    std::erase_if(events, [&wanted](const model::Event& e) {
        return e.user >= 0 && wanted[static_cast<std::size_t>(e.user)].act == nullptr;
    });
    return events;
}

std::optional<Recurrence> recurrence(std::span<const model::Event> events) {
    const std::size_t most = std::min(events.size() / 3, most_events);
    for (const double allowed : {near_enough, settling}) {
        for (std::size_t m = 2; m <= most; ++m) {
            if (const auto found = Attempt(events, m, false).judge(allowed)) return found;
            if (const auto found = Attempt(events, m, true).judge(near_enough)) return found;
        }
    }
    return {};
}

Swings swings(const std::vector<Stretch>& stretches, double period) {
    std::vector<const Stretch*> whole;
    for (const Stretch& s : stretches) {
        if (!s.stuck && s.ended_by && s.lasts() > 0) whole.push_back(&s);
    }
    Swings result;
    if (whole.empty()) return result;
    const auto at_least = [&](std::size_t n) { return whole.size() >= n; };
    if (!(period > 0) && at_least(2)) period = whole.back()->to - (*(whole.end() - 2))->from;
    result.span = period;
    std::array<int, 3> count{};
    const double end = whole.back()->to;
    for (const Stretch* s : whole) {
        const double age = (end - s->to) / period;
        if (!(age < 2.999)) continue;
        const auto i = static_cast<std::size_t>(2 - static_cast<int>(age + 1e-3));
        result.amplitudes[i] = std::max(result.amplitudes[i], std::fabs(s->end.theta - s->begin.theta) / 2);
        ++count[i];
    }
    if (text::contains(count, 0)) return result;
    const auto& [a, b, c] = result.amplitudes;
    const double least = 1e-9 * std::max({a, b, c});
    result.trend = b - a > least && c - b > least   ? Trend::growing
                   : a - b > least && b - c > least ? Trend::shrinking
                                                    : Trend::irregular;
    return result;
}

// The phase lag of a motion.

namespace {

constexpr double pi = std::numbers::pi;
constexpr int samples = 4096;         // samples of a period, for its Fourier integral
constexpr int least_rows = 100;       // rows in a period, if only rows are available
constexpr double least_share = 1e-6;  // a relatively smaller fundamental counts as rounding

/// M between rows, by linear interpolation.
double M_between_rows(const motion::Run& run, double t) {
    const auto times = run.column(motion::Column::t), M = run.column(motion::Column::M);
    const double* begin = times.data();
    const Eigen::Index n = times.size();
    const Eigen::Index i = std::clamp<Eigen::Index>(std::upper_bound(begin, begin + n, t) - begin, 1, n - 1);
    const double s = (t - times[i - 1]) / (times[i] - times[i - 1]);
    return M[i - 1] + s * (M[i] - M[i - 1]);
}

bool rows_cover(const motion::Run& run, double from, double until) {
    const auto t = run.column(motion::Column::t);
    const Eigen::Index n = t.size();
    if (n < 2 || t[0] > from || t[n - 1] < until) return false;
    const double* begin = t.data();
    return std::upper_bound(begin, begin + n, until) - std::lower_bound(begin, begin + n, from) >= least_rows;
}

}  // namespace

std::optional<double> phase_lag(const motion::Run& run, const model::Excitation& excitation, double period,
                                double until) {
    if (excitation.has_feedback()) return {};
    const double from = std::max(until - period, run.t_start);
    const bool kept = run.course && run.course->whole_until() == model::never;
    if ((!kept || excitation.has_script()) && !rows_cover(run, from, until)) return {};
    std::complex<double> theta_sum, M_sum;
    double theta_size = 0, M_size = 0;
    for (int i = 0; i < samples; ++i) {
        const double phase = (i + 0.5) / samples;
        const double t = std::min(from + phase * period, until);
        const double theta = (kept ? run.course->at(t) : motion::between_rows(run, t))->theta;
        const double M = excitation.has_script() ? M_between_rows(run, t) : excitation.value(t);
        const auto wave = std::polar(1.0, -2 * pi * phase);
        theta_sum += theta * wave, M_sum += M * wave;
        theta_size += std::fabs(theta), M_size += std::fabs(M);
    }
    if (!(std::abs(theta_sum) > least_share * theta_size) || !(std::abs(M_sum) > least_share * M_size)) return {};
    const double lag = std::arg(M_sum) - std::arg(theta_sum), turn = 2 * pi;
    return lag - turn * std::floor((lag + pi / 2) / turn);
}

}  // namespace dinal::analysis
