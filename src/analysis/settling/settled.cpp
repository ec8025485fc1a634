#include "analysis/settling/settled.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/fixed_point.hpp"
#include "analysis/steady_facts.hpp"
#include "model/controller.hpp"

namespace dinal::analysis::settling {
namespace {

double longest_delay(const model::Excitation& excitation) {
    double most = 0;
    for (const model::Component& c : excitation.components()) {
        if (const auto* delayed = model::controller_of<model::DelayedController>(c)) {
            most = std::max(most, delayed->by);
        }
    }
    return most;
}

class Settling {
public:
    Settling(const SteadyQuestion& question, const motion::Monitor& monitor)
        : question_(question),
          map_(question.system, question.excitation, question.drive.start, question.drive.period, monitor),
          integrator_(motion::integrator_for(question.system, question.excitation)),
          monitor_(monitor),
          past_(static_cast<std::size_t>(
              std::ceil(std::min(longest_delay(question.excitation) / question.drive.period, 1e6)))) {}

    SteadyMotion found() {
        answer_.period = question_.drive.period;
        const std::size_t most = std::clamp(std::max(4 * past_, 8 * static_cast<std::size_t>(question_.periods)),
                                            most_periods, 4 * most_periods);
        for (std::size_t until = least_periods; periods_ < most; until += std::max(least_periods, until / 4)) {
            if (!goes_on_until(std::min(until, most))) return answer_;
            if (const int m = comes_back(settled); m > 0 && tells(m)) return answer_;
        }
        if (const int m = comes_back(alike); m > 0 && tells(m)) return answer_;
        const std::size_t half = sizes_.size() / 2;
        constexpr double clearly = 1.3;  // more than a motion that wanders between bounds
        if (sizes_.back() >= clearly * sizes_[half]) {
            answer_.status = SteadyStatus::grows;
            answer_.growth = (sizes_.back() - sizes_[half]) / static_cast<double>(sizes_.size() - 1 - half);
        }
        return answer_;
    }

private:
    static constexpr std::size_t looks = 64;          // at a period of M: what differs within it is seen
    static constexpr std::size_t least_periods = 16;  // between two looks back
    static constexpr std::size_t most_periods = 4096;
    static constexpr int longest = 32;        // periods of M in one of the motion
    static constexpr double settled = 1e-10;  // sizes that a motion may still be from its limit
    static constexpr double alike = 1e-7;     // sizes: what is no nearer after all periods is not told as periodic
    static constexpr double finest = 1e-12;   // sizes: of rounding in runs

    [[nodiscard]] double time_of(std::size_t look) const {
        return question_.drive.start +
               question_.drive.period * (static_cast<double>(look) / static_cast<double>(looks));
    }

    /// Runs on to the end of so many periods of M, and looks.
    bool goes_on_until(std::size_t periods) {
        std::vector<double> times;
        for (std::size_t look = periods_ * looks + 1; look <= periods * looks; ++look) times.push_back(time_of(look));
        const bool whole = run(times.back(), motion::Grid::at(times), false);
        const auto theta = run_.column(motion::Column::theta), velocity = run_.column(motion::Column::velocity);
        for (Eigen::Index i = 0; i < run_.size(); ++i) seen_.emplace_back(theta[i], velocity[i] / map_.omega());
        periods_ = seen_.size() / looks;
        for (std::size_t period = sizes_.size(); period < periods_; ++period) {
            double size = 0;
            for (std::size_t i = 0; i < looks; ++i) size = std::max(size, length_of(seen_[period * looks + i]));
            sizes_.push_back(size);
        }
        answer_.maps = static_cast<int>(periods_);
        // Also an M of the motion has no number for what goes beyond all bounds.
        constexpr double beyond = 1e100;
        if (!whole && !seen_.empty() && run_.outcome == model::Outcome::excitation_not_finite &&
            length_of(seen_.back()) > beyond) {
            run_.outcome = answer_.outcome = model::Outcome::state_not_finite;
        }
        if (run_.outcome == model::Outcome::state_not_finite) {
            answer_.status = SteadyStatus::grows;
            answer_.growth = periods_ > 1 ? sizes_[periods_ - 1] - sizes_[periods_ - 2] : 0;
        }
        return whole;
    }

    bool run(double until, const motion::Grid& rows, bool dense) {
        motion::Limits limits;
        limits.dense = dense;
        auto more = begun_ ? motion::go_on(question_.system, question_.excitation, run_, until, rows, integrator_,
                                           monitor_, limits)
                           : motion::simulate(question_.system, question_.excitation, question_.initial,
                                              {question_.drive.start, until}, rows, integrator_, monitor_, limits);
        if (!more) {
            run_.outcome = answer_.outcome = model::Outcome::state_not_finite;
            return false;
        }
        run_ = std::move(more).value();
        begun_ = true;
        answer_.outcome = run_.outcome;
        answer_.contradiction = run_.contradiction;
        return model::is_whole(run_.outcome);
    }

    /// How far all that is remembered, and a whole period of the motion, is from what it was m periods before, looked
    /// at from `back` periods before the end.
    [[nodiscard]] double off(std::size_t m, std::size_t back) const {
        const std::size_t span = looks * std::max(m, past_ + 1);
        if (seen_.size() < looks * (back + m) + span) return model::never;
        const std::size_t end = seen_.size() - looks * back;
        double most = 0;
        for (std::size_t i = end - span; i < end; ++i) {
            most = std::max(most, length_of(seen_[i] - seen_[i - looks * m]));
        }
        return most;
    }

    /// The fewest periods of M after which the motion comes back to this part of its size; 0: it does not.
    [[nodiscard]] int comes_back(double within) const {
        const double size = std::max(*std::max_element(sizes_.end() - least_periods, sizes_.end()), 1e-300);
        const int first = std::max(question_.periods, 1), last = question_.periods > 0 ? first : longest;
        for (int m = first; m <= last; ++m) {
            const auto n = static_cast<std::size_t>(m);
            const double now = off(n, 0), before = off(n, 4 * n);
            if (!(now <= alike * size)) continue;
            // Differences that shrink by so much in a period of the motion add up to this.
            const double kept = std::pow(now / before, 0.25), left = kept < 1 ? now / (1 - kept) : model::never;
            if (now > finest * size && left > within * size) continue;
            // What turns slowly on its way to a motion comes near to it sooner after some periods than after one.
            for (int fewer = first; fewer < m; ++fewer) {
                if (off(static_cast<std::size_t>(fewer), 0) <= alike * size) return fewer;
            }
            return m;
        }
        return 0;
    }

    /// One more period of the motion, and what it is.
    bool tells(int m) {
        const double length = m * question_.drive.period, start = run_.t_stop;
        constexpr double rows = 400;
        const double end = time_of((periods_ + static_cast<std::size_t>(m)) * looks);
        if (!run(end, motion::Grid::every((end - start) / rows), true)) return false;
        const MapStep step = map_.told(run_, stretches(run_));
        if (!step.finished) return false;
        const bool moves = step.high > step.low || run_.motion_at_stop != model::Motion::stuck;
        answer_.status = moves ? SteadyStatus::steady : SteadyStatus::adheres;
        answer_.periods = m;
        answer_.period = length;
        answer_.start = run_.initial;
        answer_.low = step.low;
        answer_.high = step.high;
        answer_.t_high = step.t_high;
        answer_.amplitude = (step.high - step.low) / 2 + 0.0;
        answer_.stops = step.stops;
        answer_.stuck = moves ? std::min(1.0, step.stuck / length) : 1;
        answer_.residual = length_of(step.to - seen_.back()) / std::max(sizes_.back(), 1e-300);
        answer_.stable = true;  // a run came to it
        answer_.symmetric = m == 1 && is_the_opposite_half_a_period_later();
        if (!moves) answer_.rest = rest_of(question_, answer_.start.theta);
        answer_.settled = std::make_shared<const motion::Trajectory>(run_);
        return true;
    }

    [[nodiscard]] bool is_the_opposite_half_a_period_later() const {
        double most = 0;
        for (std::size_t i = seen_.size() - looks; i < seen_.size(); ++i) {
            most = std::max(most, length_of(seen_[i] + seen_[i - looks / 2]));
        }
        return most <= alike * sizes_.back();
    }

    const SteadyQuestion& question_;
    PeriodMap map_;
    motion::Integrator integrator_;
    const motion::Monitor& monitor_;
    std::size_t past_, periods_ = 0;  // of M: remembered, run
    bool begun_ = false;
    motion::Trajectory run_;     // its last part
    std::vector<Place> seen_;    // at every look but the first one
    std::vector<double> sizes_;  // of the periods
    SteadyMotion answer_;
};

}  // namespace

SteadyMotion settled_motion(const SteadyQuestion& question, const motion::Monitor& monitor) {
    return Settling(question, monitor).found();
}

bool goes_on(const SteadyQuestion& question, const SteadyMotion& motion, const motion::Monitor& monitor) {
    if (motion.status != SteadyStatus::steady && motion.status != SteadyStatus::adheres) return false;
    constexpr double periods = 4;
    const PeriodMap map(question.system, question.excitation, question.drive.start, periods * motion.period, monitor);
    const Place start = place_of(motion.start, map.omega());
    const MapStep step = map(start);
    const double size = std::max({std::fabs(motion.low), std::fabs(motion.high), length_of(start)});
    constexpr double same = 1e-8;
    return step.finished && length_of(step.to - start) <= same * size &&
           std::fabs(step.high - motion.high) + std::fabs(step.low - motion.low) <= same * size;
}

}  // namespace dinal::analysis::settling
