#include "analysis/settling/settled.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
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

/// The motion before a part of a run, which nobody needs any more.
class Forgotten final : public motion::Course {
public:
    Forgotten(const model::Oscillator& system, double until) : Course(system), until_(until) {}
    [[nodiscard]] text::Expected<model::State> at(double /*t*/) const override {
        return text::Error{"this part of the run was not kept"};
    }
    [[nodiscard]] double whole_until() const override { return until_; }

private:
    double until_;
};

/// A run goes on from where it ended: the second part alone.
text::Expected<motion::Trajectory> continued(const SteadyQuestion& question, const motion::Trajectory& so_far,
                                             double until, const motion::Grid& rows,
                                             const motion::Integrator& integrator, const motion::Monitor& monitor,
                                             bool dense) {
    motion::Limits limits;
    limits.dense = dense;
    motion::Trajectory end;
    end.t_start = end.t_stop = so_far.t_stop;
    end.initial = end.state_at_stop = so_far.state_at_stop;
    end.motion_at_stop = so_far.motion_at_stop;
    end.began_stuck = so_far.motion_at_stop == model::Motion::stuck;
    end.carried = so_far.carried;
    if (dense) end.course = std::make_shared<Forgotten>(question.system, so_far.t_stop);
    return motion::resume(question.system, question.excitation, end, until, rows, integrator, monitor, limits,
                          question.extras);
}

/// `periods` of what samples, so that all of them sample in it; 0 when their instants have nothing in common.
double sampling_period(const model::Excitation& excitation) {
    std::vector<double> periods;
    for (const model::Component& c : excitation.components()) {
        if (const auto* sampled = model::controller_of<model::SampledController>(c)) periods.push_back(sampled->every);
    }
    if (periods.empty()) return 0;
    const double longest = *std::max_element(periods.begin(), periods.end());
    constexpr int most = 60;
    for (int n = 1; n <= most; ++n) {
        const bool fit = std::all_of(periods.begin(), periods.end(), [&](double period) {
            const double count = n * longest / period;
            return std::fabs(count - std::round(count)) <= 1e-9 * count;
        });
        if (fit) return n * longest;
    }
    return 0;
}

class Settling {
public:
    /// How often a period is looked at, and how many periods one of the motion may have.
    struct Fineness {
        std::size_t looks = 64;  // what differs within it is seen
        int longest = 32;
        std::size_t most_periods = 4096;
        bool timeless = false;  // the period is that of the samples: the motion may die out
    };
    Settling(const SteadyQuestion& question, const motion::Monitor& monitor, const Fineness& fineness)
        : question_(question),
          looks(fineness.looks),
          most_periods(fineness.most_periods),
          longest(fineness.longest),
          timeless_(fineness.timeless),
          map_(question.system, question.excitation, question.drive.start, question.drive.period, monitor),
          integrator_(motion::integrator_for(question.system, question.excitation, question.extras)),
          monitor_(monitor),
          past_(static_cast<std::size_t>(
              std::ceil(std::min(longest_delay(question.excitation) / question.drive.period, 1e6)))) {}

    SteadyMotion found() {
        answer_.period = question_.drive.period;
        const std::size_t most = std::clamp(std::max(4 * past_, 8 * static_cast<std::size_t>(question_.periods)),
                                            most_periods, 4 * most_periods);
        for (std::size_t until = least_periods; periods_ < most; until += std::max(least_periods, until / 4)) {
            if (!goes_on_until(std::min(until, most))) return answer_;
            if (timeless_ && dies_out()) return answer_;
            if (const int m = comes_back(settled); m > 0 && tells(m)) return answer_;
        }
        if (const int m = comes_back(alike); m > 0 && tells(m)) return answer_;
        // A motion that beats is as large in the first half as in the second.
        const auto half = sizes_.begin() + static_cast<std::ptrdiff_t>(sizes_.size() / 2);
        const double before = *std::max_element(sizes_.begin(), half + 1), last = *std::max_element(half, sizes_.end());
        constexpr double clearly = 1.3;
        if (last >= clearly * before) {
            answer_.status = SteadyStatus::grows;
            answer_.growth = (last - before) / static_cast<double>(sizes_.end() - 1 - half);
        }
        return answer_;
    }

private:
    static constexpr std::size_t least_periods = 16;  // between two looks back
    static constexpr double settled = 1e-10;          // sizes that a motion may still be from its limit
    static constexpr double alike = 1e-7;    // sizes: what is no nearer after all periods is not told as periodic
    static constexpr double finest = 1e-12;  // sizes: of rounding in runs

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

    /// It creeps or swings towards a rest, ever more slowly.
    bool dies_out() {
        constexpr double nothing = 1e-11;  // of the largest motion
        const double largest = *std::max_element(sizes_.begin(), sizes_.end());
        const bool alone = question_.extras.states.empty() && run_.motion_at_stop != model::Motion::stuck;
        if (!alone || seen_.size() < least_periods * looks) return false;
        for (auto look = seen_.end() - static_cast<std::ptrdiff_t>(least_periods * looks); look != seen_.end();
             ++look) {
            if (length_of(*look - Place(seen_.back()[0], 0)) > nothing * largest) return false;
        }
        const double theta = seen_.back()[0];
        answer_.status = SteadyStatus::rest;
        answer_.period = 0;
        answer_.start = {theta, 0};
        answer_.low = answer_.high = theta;
        answer_.rest = {theta, theta};
        answer_.stable = true;
        return true;
    }

    bool run(double until, const motion::Grid& rows, bool dense) {
        motion::Limits limits;
        limits.dense = dense;
        auto more = begun_ ? continued(question_, run_, until, rows, integrator_, monitor_, dense)
                           : motion::simulate(question_.system, question_.excitation, question_.initial,
                                              {question_.drive.start, until}, rows, integrator_, monitor_, limits,
                                              question_.extras);
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
        tell_of_run(question_, run_, answer_);
        answer_.periods = m;
        answer_.period = length;
        const Place end_place = place_of(run_.state_at_stop, map_.omega());
        answer_.residual = length_of(end_place - seen_.back()) / std::max(sizes_.back(), 1e-300);
        answer_.stable = true;  // a run came to it
        answer_.symmetric = m == 1 && looks % 2 == 0 && is_the_opposite_half_a_period_later();
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
    std::size_t looks, most_periods;
    int longest;
    bool timeless_;
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

/// A cycle behind a dead time, of which nothing prescribes the period: the run goes on until its passages through a
/// section, as many as the dead time reaches back to, repeat themselves.
class DelayedCycle {
public:
    DelayedCycle(const SteadyQuestion& question, const motion::Monitor& monitor)
        : question_(question),
          integrator_(motion::integrator_for(question.system, question.excitation, question.extras)),
          monitor_(monitor),
          delay_(longest_delay(question.excitation)) {}

    SteadyMotion found() {
        const model::Oscillator& system = question_.system;
        const double base = std::max(system.stiffness() > 0 ? system.natural_period() : 1, delay_);
        double length = 2 * base;
        constexpr int most_parts = 300;
        for (int part = 0; part < most_parts; ++part) {
            if (!runs_on(length)) return answer_;
            if (rests()) return answer_;
            if (passages_.size() < 6 && part < 24) length *= 1.3;
            if (const int m = comes_back(); m > 0 && tells(m)) return answer_;
        }
        return answer_;
    }

private:
    struct Pass {
        double t = 0, velocity = 0;
    };

    bool runs_on(double length) {
        const double start = begun_ ? run_.t_stop : question_.drive.start;
        constexpr int looks = 256;
        const motion::Grid rows = motion::Grid::every(length / looks);
        auto more = begun_
                        ? continued(question_, run_, start + length, rows, integrator_, monitor_, true)
                        : motion::simulate(question_.system, question_.excitation, question_.initial,
                                           {start, start + length}, rows, integrator_, monitor_, {}, question_.extras);
        answer_.outcome = more ? more->outcome : model::Outcome::state_not_finite;
        if (answer_.outcome == model::Outcome::state_not_finite) answer_.status = SteadyStatus::grows;
        if (!more) return false;
        answer_.contradiction = more->contradiction;
        run_ = std::move(more).value();
        begun_ = true;
        ++answer_.maps;
        if (!model::is_whole(run_.outcome)) return false;
        low_ = run_.rows.col(1).minCoeff(), high_ = run_.rows.col(1).maxCoeff();
        largest_ = std::max({largest_, std::fabs(low_), std::fabs(high_), high_ - low_});
        constexpr double beyond = 1e100;
        if (largest_ > beyond) {
            answer_.status = SteadyStatus::grows;
            return false;
        }
        const double range = high_ - low_;
        if (!(section_ > low_ + 0.2 * range && section_ < high_ - 0.2 * range)) {
            constexpr double place = 0.42;
            section_ = low_ + place * range;
            passages_.clear();
        }
        for (Eigen::Index i = 0; i + 1 < run_.size(); ++i) {
            if (run_.rows(i, 1) < section_ && run_.rows(i + 1, 1) >= section_)
                pass(run_.rows(i, 0), run_.rows(i + 1, 0));
        }
        return true;
    }

    void pass(double below, double above) {
        model::State there;
        constexpr int halvings = 60;
        for (int i = 0; i < halvings; ++i) {
            const double middle = below + (above - below) / 2;
            const auto state = run_.at(middle);
            if (!state) return;
            there = *state;
            (there.theta < section_ ? below : above) = middle;
        }
        passages_.push_back({above, there.velocity});
    }

    bool rests() {
        const bool still = high_ - low_ <= 1e-11 * largest_ && question_.extras.states.empty();
        if (!still) return false;
        answer_.status = SteadyStatus::rest;
        const double theta = run_.state_at_stop.theta;
        answer_.start = {theta, 0};
        answer_.low = answer_.high = theta;
        answer_.rest = {theta, theta};
        answer_.stuck = run_.motion_at_stop == model::Motion::stuck ? 1 : 0;
        answer_.stable = true;
        return true;
    }

    /// How far the last passages are from those m before them.
    [[nodiscard]] double off(std::size_t m, std::size_t back) const {
        const std::size_t last = passages_.size() - 1;
        if (last < back + 2 * m) return model::never;
        const std::size_t end = last - back;
        const double period = passages_[end].t - passages_[end - m].t;
        double most = 0, speed = 0;
        for (std::size_t i = end; i >= m && passages_[end].t - passages_[i].t <= delay_ + period; --i) {
            speed = std::max(speed, std::fabs(passages_[i].velocity));
            const double apart = std::fabs(passages_[i].velocity - passages_[i - m].velocity);
            const double late = std::fabs(passages_[i].t - passages_[i - m].t - period);
            most = std::max({most, apart / speed, late / period});
            if (i == m && passages_[end].t - passages_[i].t < delay_) return model::never;
        }
        return most;
    }

    [[nodiscard]] int comes_back() const {
        constexpr std::size_t most = 16;
        constexpr double alike = 1e-7, settled = 1e-11, finest = 2e-12;
        for (std::size_t m = 1; m <= most && 6 * m < passages_.size(); ++m) {
            const double now = off(m, 0), before = off(m, 4 * m);
            if (!(now <= alike) || before == model::never) continue;
            const double kept = std::pow(now / before, 0.25), left = kept < 1 ? now / (1 - kept) : model::never;
            if (now > finest && left > settled) continue;
            return static_cast<int>(m);
        }
        return 0;
    }

    bool tells(int m) {
        const Pass& last = passages_.back();
        const std::size_t before = passages_.size() - 1 - static_cast<std::size_t>(m);
        const double period = last.t - passages_[before].t, start = run_.t_stop;
        constexpr double rows = 400;
        auto more =
            continued(question_, run_, start + period, motion::Grid::every(period / rows), integrator_, monitor_, true);
        if (!more || !model::is_whole(more->outcome)) return false;
        run_ = std::move(more).value();
        tell_of_run(question_, run_, answer_);
        answer_.period = period;
        answer_.residual = off(static_cast<std::size_t>(m), 0);
        answer_.stable = true;
        answer_.settled = std::make_shared<const motion::Trajectory>(run_);
        return true;
    }

    const SteadyQuestion& question_;
    motion::Integrator integrator_;
    const motion::Monitor& monitor_;
    double delay_, low_ = 0, high_ = 0, largest_ = 0, section_ = model::never;
    bool begun_ = false;
    motion::Trajectory run_;
    std::vector<Pass> passages_;
    SteadyMotion answer_;
};

}  // namespace

SteadyMotion settled_motion(const SteadyQuestion& question, const motion::Monitor& monitor) {
    if (!question.is_timeless()) return Settling(question, monitor, {}).found();
    const double sampling = sampling_period(question.excitation);
    if (!(sampling > 0)) return DelayedCycle(question, monitor).found();
    SteadyQuestion on_grid = question;
    on_grid.drive.period = sampling;
    SteadyMotion motion =
        Settling(on_grid, monitor, {.looks = 4, .longest = 2048, .most_periods = 20000, .timeless = true}).found();
    motion.periods = 1;
    return motion;
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
