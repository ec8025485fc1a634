// Finds the steady motion that a run leads to as a fixed point of its return map. docs/theory.md, section 10.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "analysis/forced_search.hpp"
#include "analysis/returns.hpp"
#include "analysis/steady_facts.hpp"
#include "model/controller.hpp"
#include "motion/engine/modes.hpp"

namespace dinal::analysis {

namespace engine = motion::engine;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double rows_of_period = 400;

bool has_acts(const model::Drive& drive) {
    return std::ranges::any_of(drive.events, [](const model::WantedEvent& event) { return event.act != nullptr; });
}

double longest_delay(const model::Excitation& excitation) {
    double most = 0;
    for (const model::Component& c : excitation.components()) {
        if (const auto* delayed = model::controller_of<model::DelayedController>(c)) most = std::max(most, delayed->by);
    }
    return most;
}

double shortest_sampling(const model::Excitation& excitation) {
    double least = model::never;
    for (const model::Component& c : excitation.components()) {
        if (const auto* sampled = model::controller_of<model::SampledController>(c))
            least = std::min(least, sampled->every);
    }
    return least;
}

/// The greatest range among the first `count` numbers.
double greatest(const Reach& reach, Index count) {
    return reach.range().head(count).cwiseAbs().maxCoeff();
}

/// Finds the motion that a run from the start of the question leads to.
class ReturnSearch final : public ForcedSearch {
public:
    ReturnSearch(const SteadyQuestion& question, const motion::Monitor& monitor)
        : runs_(question, monitor), chart_(chart_of(runs_)) {}

    SteadyMotion found();

private:
    Map& map() override { return *returns_; }
    std::optional<Map::Return> begin() override;
    std::optional<Map::Return> measured(const Map::Return& from) override {
        return measured_at(returns_->full_state(from.to, from.mode));
    }
    std::optional<Map::Return> measured_at(const FullState& moment);
    double range() const override { return range_; }
    double size_at(const Map::Return& place) const override;
    bool complete(const Closed& found, bool any) override { return complete_closed(*returns_, found, any); }
    bool is_bounded() const override { return false; }
    bool is_free() const override {
        if (chart_.any_rotates()) return true;
        return question().is_alone() && chart_.measures(0) && !(runs_.natural_period() > 0) &&
               question().body.spring().none() && !question().body.walls();
    }

    /// Completes the answer for a motion of facts_.period that begins at this moment. Returns its state half a period
    /// later; empty if it cannot be run: the search then continues.
    std::optional<VectorXd> complete(FullState moment, double start);
    /// The run of a period that does not move at all, from a place beside this moment; empty if there is none.
    std::optional<motion::Run> standing_beside(const motion::Run& run, FullState& moment, double start);
    /// Like complete(), for a run that has settled up to its end and repeats after facts_.period.
    std::optional<VectorXd> complete_settled(const motion::Run& so_far);
    std::optional<VectorXd> complete_period(const FullState& from, motion::Run run, double period);
    /// Completes the answer for bodies that rest or rotate steadily; `stands` tells whether friction holds all of them.
    void complete_rest(const motion::Run& run, bool stands);
    [[nodiscard]] bool grows_beside(const FullState& rest, double t) const;
    [[nodiscard]] bool is_moving(const FullState& now) const {
        return now.y.segment(n(), n()).cwiseAbs().maxCoeff() > std::max(1e-9 * largest_, rounding_of(now));
    }
    /// Returns how far a body may move by rounding while a load holds it at a jump.
    [[nodiscard]] double rounding_of(const FullState& now) const {
        return 64 * motion::engine::rounding * std::max(largest_, now.y.head(n()).cwiseAbs().maxCoeff());
    }

    [[nodiscard]] bool measures_any_angle() const {
        for (Eigen::Index i = 0; i < n(); ++i) {
            if (chart_.measures(i)) return true;
        }
        return false;
    }

    const SteadyQuestion& question() const { return runs_.question(); }
    Eigen::Index n() const { return runs_.bodies(); }
    /// The period of M, or the slowest natural period.
    double pace() const;

    std::optional<motion::Run> stretch(const FullState& from, double start, double length, Reach& reach);
    Eigen::VectorXd units_of(const Reach& reach) const;
    class Settling;
    void cycle();
    [[nodiscard]] static Returns::Section section(const Reach& reach, Eigen::Index measured) {
        return {measured, reach.low[measured] + section_at * (reach.high[measured] - reach.low[measured])};
    }
    bool closes_from(const FullState& now, const Reach& reach, double length, int i);
    bool rests(const motion::Run& run, const Eigen::VectorXd& range, const Eigen::VectorXd& most_changed);
    void note_rest(const motion::Run& run, bool stands);
    bool complete_closed(Returns& map, const Closed& found, bool any);
    void note_symmetry(const Eigen::VectorXd& begin, const Eigen::VectorXd& middle);

    Runs runs_;
    Chart chart_;
    std::optional<Returns> returns_;  // map from period to period
    double start_ = 0;                // time at which these periods start
    double range_ = 0;                // range of angles in the last measured period
    double farthest_ = 0;             // greatest range of angles in a measured period
    double largest_ = 0;              // greatest angle or velocity of a settling run
};

double ReturnSearch::pace() const {
    if (question().repeats.period > 0) return question().repeats.period;
    const double natural = runs_.natural_period();
    return natural > 0 ? natural : 1;
}

/// Runs a stretch; none if it failed, with the reason in the answer.
std::optional<motion::Run> ReturnSearch::stretch(const FullState& from, double start, double length, Reach& reach) {
    motion::Run run = runs_.run(from, start, start + length, motion::Grid::none(), true);
    facts_.outcome = run.outcome;
    reach = reach_of(run, chart_);
    constexpr double beyond = 1e100, no_number = 1e50;  // above no_number the motion is blamed for a NaN in M
    const double greatest = analysis::greatest(reach, 2 * n());
    const bool whole = model::is_whole(run.outcome) || run.outcome == model::Outcome::stopped;
    if (whole && greatest < beyond) return run;
    if (whole || (run.outcome == model::Outcome::excitation_not_finite && greatest > no_number)) {
        facts_.outcome = model::Outcome::state_not_finite;
    }
    if (facts_.outcome == model::Outcome::state_not_finite) facts_.status = SteadyStatus::grows;
    return {};
}

/// Scales of the numbers of a place, never zero.
VectorXd ReturnSearch::units_of(const Reach& reach) const {
    VectorXd units = reach.range();
    const VectorXd most = reach.high.cwiseAbs().cwiseMax(reach.low.cwiseAbs());
    const double angles = std::max(units.head(n()).maxCoeff(), 1e-300);
    const double speeds = std::max(units.segment(n(), n()).maxCoeff(), 1e-300);
    for (Index k = 0; k < units.size(); ++k) {
        if (units[k] > 1e-9 * most[k]) continue;
        units[k] = std::max(most[k], k < n() ? angles : k < 2 * n() ? speeds : 0.0);
        if (!(units[k] > 0)) units[k] = 1;
    }
    return units;
}

// ---- with a period

std::optional<Map::Return> ReturnSearch::begin() {
    const double period = question().repeats.period;
    // An action at the very beginning of a run would be lost, so returns begin at a time without actions.
    constexpr double irrational_part = 0.3819660112501051;
    start_ = question().repeats.start;
    Reach reach;
    FullState now = runs_.first();
    if (has_acts(question().drive)) {
        const auto run = stretch(now, start_, irrational_part * period, reach);
        if (!run) return {};
        now = Runs::at_stop(*run);
        start_ += irrational_part * period;
    }
    return measured_at(now);
}

/// Begins one period later, where the mode is known.
std::optional<Map::Return> ReturnSearch::measured_at(const FullState& moment) {
    Reach reach;
    const auto run = stretch(moment, start_, question().repeats.period, reach);
    if (!run) return {};
    const FullState now = Runs::at_stop(*run);
    returns_.emplace(runs_, chart_, start_, question().repeats.period, std::nullopt, units_of(reach), now.y);
    range_ = greatest(reach, n());
    farthest_ = std::max(farthest_, range_);
    return Map::Return{.to = returns_->place(now.y), .finished = true, .mode = now.mode};
}

double ReturnSearch::size_at(const Map::Return& place) const {
    const VectorXd y = chart_.measured(returns_->full_state(place.to, place.mode).y).cwiseAbs();
    const double natural = runs_.natural_period(), pace = natural > 0 ? natural / (2 * std::numbers::pi) : 1;
    const double size = y.segment(n(), n()).maxCoeff() * pace;
    return natural > 0 || is_free() ? std::max(size, y.head(n()).maxCoeff()) : size;
}

// ---- sampled or delayed controllers

/// Continues the run until it repeats: from period to period of drive and sampling, or with a delay but no period from
/// passage to passage.
class ReturnSearch::Settling {
public:
    explicit Settling(ReturnSearch& search)
        : s_(search),
          length_(search.question().settles),
          timeless_(search.question().repeats.period == 0),
          t_(search.question().repeats.start) {
        for (const model::Excitation& load : s_.question().drive.loads) {
            delay_ = std::max(delay_, longest_delay(load));
            if (length_ > 0) beside_ = std::min(beside_, shortest_sampling(load) / 2);
        }
        if (beside_ == model::never) beside_ = 0;
        stretch_ = 2 * std::max(s_.pace(), delay_);
    }

    void search() {
        const auto periods = static_cast<std::size_t>(s_.question().periods);
        const auto reaches_back = static_cast<std::size_t>(std::min(4 * delay_ / s_.pace(), 1e6));
        const std::size_t least = !timeless_ ? 4096 : length_ > 0 ? 20000 : 2048;
        const std::size_t most = std::clamp(std::max(reaches_back, 8 * periods), least, 4 * least);
        constexpr std::size_t least_returns = 16;
        for (std::size_t until = least_returns; sizes_.size() < most; until += std::max(least_returns, until / 4)) {
            until = std::min(until, most);
            for (; sizes_.size() < until; ++s_.facts_.maps) {
                if (!makes_return()) return;
            }
            const bool alone = timeless_ && s_.question().drive.states.empty();
            if (alone && small_ >= least_returns && run_.motion_at_stop != model::Motion::stuck) {
                s_.note_rest(run_, false);
                return;
            }
            constexpr double settled = 1e-10;  // relative distance from the limit
            std::size_t m = returns_until_repeat(settled);
            if (m == 0 && sizes_.size() >= most) m = returns_until_repeat(alike);
            if (m == 0) continue;
            finish(m);
            return;
        }
        judge_growth();
    }

private:
    // relative: a larger difference at the end of the search counts as not periodic
    static constexpr double alike = 1e-7;
    static constexpr double finest = 1e-12;  // relative rounding of runs

    /// Makes one more return; returns false at the end of the search.
    bool makes_return() {
        const double start = t_;
        t_ = length_ > 0 ? s_.question().repeats.start + beside_ + static_cast<double>(sizes_.size() + 1) * length_
                         : start + stretch_;
        run_ = s_.runs_.continued(run_, start, t_, motion::Grid::none(), passage_);
        SteadyMotion& facts = s_.facts_;
        facts.outcome = run_.outcome;
        const Reach reach = reach_of(run_, s_.chart_, timeless_ && length_ > 0 ? 4 : 64);
        const double size = greatest(reach, 2 * s_.n());
        constexpr double beyond = 1e50;
        if (!(size < beyond)) facts.outcome = model::Outcome::state_not_finite;
        if (!model::is_whole(facts.outcome) && !(passage_ && facts.outcome == model::Outcome::stopped)) {
            if (facts.outcome != model::Outcome::state_not_finite) return false;
            facts.status = SteadyStatus::grows;
            facts.growth = model::never;
            return false;
        }
        s_.largest_ = std::max(s_.largest_, size);
        sizes_.push_back(size);
        constexpr double dead = 1e-11;  // relative to the greatest motion: a smaller one dies out
        small_ = size <= dead * s_.largest_ ? small_ + 1 : 0;
        if (length_ == 0 && run_.outcome != model::Outcome::stopped) return try_other_section(reach);
        t_ = run_.t_stop;
        times_.push_back(t_);
        seen_.push_back(seen(t_ - start));
        const VectorXd units = s_.units_of(reach);
        size_ = seen_.back().cwiseAbs().cwiseMax(std::numeric_limits<double>::min());
        constexpr double nothing = 1e-12;  // lower limit of the scale of a motion that dies out
        size_.head(units.size()) = units.cwiseMax(nothing * s_.largest_);
        // A controller's output may be mere rounding: scale it by the torque that moves the bodies.
        const auto others = size_.segment(units.size(), size_.size() - units.size() - 1);
        size_.segment(units.size(), others.size()) = others.cwiseMax(torque_of(reach));
        return true;
    }

    /// The size of the torque needed for this motion.
    double torque_of(const Reach& reach) const {
        double torque = 0;
        const auto& bodies = s_.runs_.system().bodies;
        for (Index i = 0; i < s_.n(); ++i) {
            const double change = reach.high[s_.n() + i] - reach.low[s_.n() + i];
            torque = std::max(torque, bodies[static_cast<std::size_t>(i)].inertia * change / s_.pace());
        }
        return torque;
    }

    /// Chooses another section after a stretch without a passage; returns false if the motion rests or the tries are
    /// used up.
    bool try_other_section(const Reach& reach) {
        constexpr int most_tries = 40, most_longer = 24;
        const bool rests = small_ > 0 && s_.question().drive.states.empty();
        if (rests) s_.note_rest(run_, false);
        if (rests || ++tried_ > most_tries) return false;
        const Index widest = widest_of(reach, s_.chart_, s_.n());
        if (widest >= 0) passage_ = passage(s_.chart_, section(reach, widest), s_.runs_.system().named);
        if (tried_ <= most_longer) stretch_ *= 1.3;
        seen_.clear();
        times_.clear();
        return true;
    }

    /// The observed numbers: measured angles and velocities, states, outputs of controllers, and the duration of the
    /// return. Other memory of controllers is not observed, so more than one return must agree.
    VectorXd seen(double time) const {
        const VectorXd y = s_.chart_.measured(vector_of(run_.left->carry->y));
        std::vector<double> all(y.begin(), y.end());
        for (const auto& controllers : run_.left->carry->controllers) {
            for (const engine::Signal::Memory& memory : controllers) all.push_back(memory.output);
        }
        all.push_back(length_ > 0 ? 1 : time);
        return vector_of(all);
    }

    /// The difference between all observed numbers and those m returns before, evaluated `back` returns before the end.
    double off(std::size_t m, std::size_t back) const {
        std::size_t past = 1;  // number of returns within the delay
        while (past < times_.size() && times_.back() - times_[times_.size() - 1 - past] < delay_) ++past;
        const std::size_t span = std::max(m, past + 1) + 1;
        if (seen_.size() < back + m + span) return model::never;
        double worst = 0;
        for (std::size_t i = seen_.size() - back - span; i < seen_.size() - back; ++i) {
            worst = std::max(worst, (seen_[i] - seen_[i - m]).cwiseQuotient(size_).cwiseAbs().maxCoeff());
            if (worst > alike) break;
        }
        return worst;
    }

    /// The smallest number of returns after which it repeats to this tolerance; 0: none.
    std::size_t returns_until_repeat(double within) const {
        const auto periods = static_cast<std::size_t>(s_.question().periods);
        const std::size_t first = std::max<std::size_t>(periods, 1), longest = !timeless_    ? 32
                                                                               : length_ > 0 ? 2048
                                                                                             : 16;
        for (std::size_t m = first; m <= (periods > 0 ? first : longest); ++m) {
            const double now = off(m, 0);
            if (!(now <= alike)) continue;
            // The geometric series of differences that shrink at this rate.
            const double kept = std::pow(now / off(m, 4 * m), 0.25), left = kept < 1 ? now / (1 - kept) : model::never;
            if (now > finest && left > within) continue;
            // A slowly rotating approach repeats sooner after several periods than after one.
            for (std::size_t fewer = first; fewer < m; ++fewer) {
                if (off(fewer, 0) <= alike) return fewer;
            }
            return m;
        }
        return 0;
    }

    void finish(std::size_t m) {
        SteadyMotion& facts = s_.facts_;
        facts.period = length_ > 0 ? static_cast<double>(m) * length_ : t_ - times_[times_.size() - 1 - m];
        facts.periods = timeless_ ? 1 : static_cast<int>(std::round(facts.period / s_.question().repeats.period));
        facts.stable = true;
        if (beside_ > 0) run_ = s_.runs_.continued(run_, t_, t_ - beside_ + length_, motion::Grid::none());
        if (const auto middle = s_.complete_settled(run_)) s_.note_symmetry(Runs::at_stop(run_).y, *middle);
    }

    /// Detects growth. A beating motion has equal maxima in both halves.
    void judge_growth() {
        const auto half = sizes_.begin() + static_cast<std::ptrdiff_t>(sizes_.size() / 2);
        const double before = *std::max_element(sizes_.begin(), half + 1);
        const double last = *std::max_element(half, sizes_.end());
        constexpr double clearly = 1.3;
        if (last < clearly * before) return;
        s_.facts_.status = SteadyStatus::grows;
        const double evenly = (last - before) / static_cast<double>(sizes_.end() - 1 - half);
        s_.facts_.growth = last > faster * before ? model::never : evenly;
    }

    ReturnSearch& s_;
    double length_;     // duration of a return; 0 if it ends at a passage
    double delay_ = 0;  // greatest delay
    double stretch_;    // length of a run to a passage
    /// The offset of observations from common sampling instants, because rounding scatters the samples around these.
    /// Half of the shortest interval later no controller samples.
    double beside_ = model::never;
    bool timeless_;
    double t_;
    std::optional<model::WantedEvent> passage_;
    int tried_ = 0;               // number of sections tried
    motion::Run run_;             // the last run
    std::vector<double> sizes_;   // sizes of all runs
    std::size_t small_ = 0;       // number of successive runs, up to the last, with hardly any motion
    std::vector<VectorXd> seen_;  // observed numbers at each return
    std::vector<double> times_;   // time of each return
    VectorXd size_;               // scale of the observed numbers
};

// ---- without a period

void ReturnSearch::cycle() {
    const double natural = runs_.natural_period(), base = pace(), start = question().repeats.start;
    FullState now = runs_.first();
    double length = base, time = 0;
    std::size_t events = 0;
    std::vector<std::pair<double, double>> ranges;  // time, range
    VectorXd most_changed;
    constexpr int most_stretches = 40;
    for (int i = 0; i < most_stretches; ++i) {
        Reach reach;
        const auto run = stretch(now, start, length, reach);
        if (!run) return;
        time += length;
        events += run->events.size();
        const VectorXd range = reach.range();
        most_changed = i == 0 ? range : VectorXd(most_changed.cwiseMax(range));
        // Velocities show whether rotating bodies are driven faster and faster.
        ranges.emplace_back(time, greatest(reach, chart_.any_rotates() ? 2 * n() : n()));
        largest_ = std::max(largest_, greatest(reach, 2 * n()));
        now = Runs::at_stop(*run);
        if (rests(*run, range, most_changed)) return;
        if (closes_from(now, reach, length, i)) return;
        constexpr std::size_t many_events = 6000, few_events = 200;
        const bool cheap = !(natural > 0) && events < few_events;
        if (events > many_events || (!cheap && time > 3000 * base)) break;
        length *= 1.5;
    }
    const auto last = ranges.rbegin();
    if (ranges.size() < 4 || !(last[0].second > 1.2 * last[1].second) || !(last[1].second > 1.2 * last[2].second)) {
        return;
    }
    facts_.status = SteadyStatus::grows;
    facts_.growth = (last[0].second - last[1].second) / 2 / ((last[0].first - last[1].first) / base);
}

bool ReturnSearch::closes_from(const FullState& now, const Reach& reach, double length, int i) {
    const Index widest = widest_of(reach, chart_, n());
    if (widest < 0) return false;
    Returns map(runs_, chart_, question().repeats.start, 3 * length, section(reach, widest), units_of(reach), now.y);
    const Returns::Return first = map.arrival(now);
    if (!first.finished) return false;
    ClosedSearch search(map, facts_.maps, 16);
    const std::vector<int> counts = i < 4 ? std::vector<int>{3, 6} : std::vector<int>{3, 8, 24, 60};
    const auto found = search.follow(first, counts);
    return found && complete_closed(map, *found, false);
}

/// Detects a rest of an autonomous system: standing, or steady rotation with all other numbers constant.
bool ReturnSearch::rests(const motion::Run& run, const VectorXd& range, const VectorXd& most_changed) {
    const auto& y = run.left->carry->y;
    const auto velocities = std::span(y).subspan(static_cast<std::size_t>(n()), static_cast<std::size_t>(n()));
    const bool moves =
        std::any_of(velocities.begin(), velocities.end(), [](double v) { return v != 0; });  // with belts
    const bool stands = run.outcome == model::Outcome::at_rest ||
                        (run.outcome == model::Outcome::stuck_at_end && !moves && question().drive.states.empty());
    bool still = true, still_states = true;
    const double rounded = rounding_of(Runs::at_stop(run));
    for (Index k = 0; k < range.size(); ++k) {
        const double size = std::max(most_changed[k], std::fabs(y[static_cast<std::size_t>(k)]));
        const bool own = !chart_.measures(k) || range[k] <= std::max(1e-11 * size, k < 2 * n() ? rounded : 0);
        still = still && own;
        if (k >= 2 * n()) still_states = still_states && own;
    }
    const bool rides = n() == 1 && still_states && run.motion_at_stop == model::Motion::stuck && run.events.empty() &&
                       !(runs_.natural_period() > 0) && runs_.system().joints.front().spring.none() &&
                       runs_.system().joints.front().any_walls() == nullptr &&
                       !question().drive.loads.front().has_feedback();
    if (stands || still || rides) note_rest(run, stands);
    return stands || still || rides;
}

void ReturnSearch::note_rest(const motion::Run& run, bool stands) {
    facts_.period = 0;
    facts_.stable = true;
    facts_.status = SteadyStatus::rest;
    complete_rest(run, stands);
}

/// Completes the answer for a closed motion; returns false if it cannot be run, or no run stays on it and `any` is
/// false.
bool ReturnSearch::complete_closed(Returns& map, const Closed& found, bool any) {
    // An immediate passage: the motion has nearly stopped, or what is measured is only rounding.
    constexpr double shortest_cycle = 1e-6;
    if (!(found.period > shortest_cycle * pace())) return false;
    const auto D = map.derivative(found.x, found.mode, found.returns, 4);
    facts_.maps += 4 * found.returns * static_cast<int>(found.x.size());
    const bool forced = question().repeats.period > 0;
    SteadyMotion facts;
    facts.maps = facts_.maps;
    facts.periods = forced ? found.returns : 1;
    facts.period = forced ? found.returns * question().repeats.period : found.period;
    facts.stable = true;
    constexpr double smooth = 0.01;
    const bool alone = forced && !chart_.any_rotates();
    if (D) judge(question(), multipliers_of(D->by_place), {.alone = alone && D->bend < smooth}, facts);
    if (!facts.stable && !any) return false;
    const SteadyMotion before = std::exchange(facts_, std::move(facts));
    const FullState moment = map.full_state(found.x, found.mode);
    const auto middle = complete(moment, map.start());
    if (middle) {
        note_symmetry(moment.y, *middle);
    } else {
        const auto outcome = facts_.outcome;
        facts_ = before, facts_.outcome = outcome;
    }
    return middle.has_value();
}

/// Sets `symmetric` if all angles and velocities are opposite half a period later.
void ReturnSearch::note_symmetry(const VectorXd& begin, const VectorXd& middle) {
    if (question().repeats.period == 0 || facts_.periods != 1 || chart_.any_rotates()) return;
    VectorXd units = VectorXd::Ones(2 * n());
    units.tail(n()).fill(2 * std::numbers::pi / facts_.period);
    const auto size = [&](const VectorXd& y) { return y.cwiseQuotient(units).cwiseAbs().maxCoeff(); };
    const VectorXd before = begin.head(2 * n());
    constexpr double alike = 1e-7;
    facts_.symmetric = size(before + middle.head(2 * n())) <= alike * size(before);
}

SteadyMotion ReturnSearch::found() {
    facts_.period = question().repeats.period;
    if (question().settles >= 0) {
        Settling(*this).search();
    } else if (question().repeats.period > 0) {
        const auto last = search(question(), contracts(question()));
        if (last) look_beside(*last, question().periods);
        if (facts_.status == SteadyStatus::grows && chart_.any_rotates()) facts_.growth = model::never;
    } else {
        cycle();
    }
    if (runs_.contradiction()) {
        facts_.contradiction = runs_.contradiction();
        facts_.outcome = model::Outcome::not_a_function;
        facts_.status = SteadyStatus::none;
    }
    return std::move(facts_);
}

// ---- the answer

std::optional<VectorXd> ReturnSearch::complete(FullState moment, double start) {
    const double period = facts_.period;
    motion::Run run = runs_.run(moment, start, start + period, motion::Grid::every(period / rows_of_period), true);
    if (!model::is_whole(run.outcome)) return {};
    if (auto still = standing_beside(run, moment, start)) run = std::move(*still);
    facts_.by_returns.drive = std::make_shared<const model::Drive>(runs_.from(moment, start));
    return complete_period(moment, std::move(run), period);
}

/// A mass that friction holds a little longer in each period adheres in the limit, which no number of periods reaches.
std::optional<motion::Run> ReturnSearch::standing_beside(const motion::Run& run, FullState& moment, double start) {
    constexpr double tiny = 1e-8, nearest = 1e-8, farthest = 1e-3;  // relative to the motion before
    const bool by_numbers = n() == 1 && runs_.system().joints.front().friction.is_of_numbers();
    const bool creeps = by_numbers && question().repeats.period > 0 && !run.events.empty() &&
                        reach_of_rows(run, chart_).range()[0] <= tiny * farthest_;
    for (double by = nearest; creeps && by < farthest; by *= 10) {
        for (const double aside : {-by, by}) {
            FullState beside{moment.y};
            beside.y[0] += aside * farthest_, beside.y[1] = 0;
            const double end = start + facts_.period;
            motion::Run still =
                runs_.run(beside, start, end, motion::Grid::every(facts_.period / rows_of_period), true);
            if (!still.events.empty() || still.motion_at_stop != model::Motion::stuck) continue;
            moment = std::move(beside);
            return still;
        }
    }
    return {};
}

std::optional<VectorXd> ReturnSearch::complete_settled(const motion::Run& so_far) {
    const double period = facts_.period, t = so_far.t_stop;
    motion::Run run = runs_.continued(so_far, t, t + period, motion::Grid::every(period / rows_of_period));
    if (!model::is_whole(run.outcome)) return {};
    return complete_period(Runs::at_stop(so_far), std::move(run), period);
}

/// Returns whether a small disturbance of a rest grows; false if it has no modes, as at a wall or with a memory.
bool ReturnSearch::grows_beside(const FullState& rest, double t) const {
    const auto& loads = question().drive.loads;
    if (std::ranges::any_of(loads, [](const model::Excitation& load) { return model::has_memory(load); })) return false;
    const std::vector<double> y(rest.y.begin(), rest.y.end());
    const auto is_at_wall = [&](const model::Joint& joint) {
        constexpr double near = 1e-9;
        const double angle = joint.sum(y);
        return joint.walls && !(angle > joint.walls->lower + near && angle < joint.walls->upper - near);
    };
    if (std::ranges::any_of(runs_.system().joints, is_at_wall)) return false;
    const auto modes = engine::modes_beside(runs_.system(), runs_.from(rest, t));
    if (!modes) return false;
    constexpr double marginal = 1e-7;  // relative accuracy of the eigenvalues
    double fastest = 0, growth = 0;
    for (const engine::EigenMode& mode : modes.value()) {
        fastest = std::max(fastest, std::abs(mode.value)), growth = std::max(growth, mode.value.real());
    }
    return growth > marginal * fastest;
}

void ReturnSearch::complete_rest(const motion::Run& run, bool stands) {
    const FullState now = Runs::at_stop(run);
    if (!stands && grows_beside(now, run.t_stop)) facts_.stable = false;
    const bool moves = is_moving(now);
    const bool stuck = n() == 1 && run.motion_at_stop == model::Motion::stuck;
    if (moves && (stuck || chart_.any_rotates()))
        facts_.status = SteadyStatus::steady;  // for example carried by a belt
    if (stands) facts_.unique = false;
    facts_.stuck = (n() == 1 ? stuck : stands) ? 1 : 0;
    if (question().settles < 0)
        facts_.by_returns.drive = std::make_shared<const model::Drive>(runs_.from(now, run.t_stop));
    facts_.bodies = bodies_at(now.y, chart_, n());
}

/// Completes the answer with a run that is one period from this moment.
std::optional<VectorXd> ReturnSearch::complete_period(const FullState& from, motion::Run run, double period) {
    const Reach reach = reach_of_rows(run, chart_);
    constexpr double nothing = 1e-11, creep = 1e-8;
    const bool forced = question().repeats.period > 0;
    // Bodies that slip a little less in each period come to a place where they adhere.
    const bool creeps = forced && n() > 1 && run.outcome == model::Outcome::stuck_at_end && !run.events.empty() &&
                        greatest(reach, n()) <= creep * farthest_;
    // Without a period, only a motion of angles is a cycle: the last of a decay may pass a place twice by rounding.
    const Index widest = widest_of(reach, chart_, n());
    const bool cycles = forced || question().settles >= 0 || !measures_any_angle() || (widest >= 0 && widest < n());
    const bool moves = !creeps && cycles && reach.range().head(2 * n()).maxCoeff() > nothing * largest_;
    const bool rotates = !moves && is_moving(from);
    if (!moves && !forced && question().settles < 0) return {};  // not a cycle: a further run decides how it ends
    facts_.outcome = run.outcome;
    facts_.status = moves || rotates ? SteadyStatus::steady : forced ? SteadyStatus::adheres : SteadyStatus::rest;
    facts_.period = moves || forced ? period : 0;
    facts_.bodies = bodies_of(run, chart_, reach);
    const std::vector<double> middle = run.left->history->at(run.t_start + period / 2);
    auto whole = std::make_shared<PeriodOfBodies>();
    whole->drive = runs_.from(from, run.t_start);
    whole->run = motion::completed(runs_.system(), whole->drive, std::move(run));
    facts_.by_returns.of_bodies = std::move(whole);
    return vector_of(middle);
}

}  // namespace

std::optional<double> settles_after(const SteadyQuestion& question) {
    bool waits = false;
    double common = question.repeats.period;
    for (const model::Excitation& load : question.drive.loads) {
        for (const model::Component& component : load.components()) {
            const auto* sampled = model::controller_of<model::SampledController>(component);
            waits = waits || sampled != nullptr || model::controller_of<model::DelayedController>(component) != nullptr;
            if (sampled == nullptr) continue;
            if (common == 0) common = sampled->every;
            const auto is_whole = [&](int times) {
                const double instants = times * common / sampled->every;
                return std::fabs(instants - std::round(instants)) <= 1e-9 * instants && instants > 0.5;
            };
            constexpr int most = 1000;
            int times = 1;
            while (times <= most && !is_whole(times)) ++times;
            if (times > most) return question.repeats.period > 0 ? std::nullopt : std::optional<double>(0);
            common *= times;
        }
    }
    return waits ? common : -1;
}

SteadyMotion motion_by_returns(const SteadyQuestion& question, const motion::Monitor& monitor) {
    const SteadyQuestion asked = for_returns(question);
    const SteadyMotion motion = ReturnSearch(asked, monitor).found();
    return question.is_plain() || question.joint ? seen_from(question, motion) : motion;
}

}  // namespace dinal::analysis
