// Steady motions that a map of theta and velocity over a period of M does not tell: of runs with states, events, a belt
// or a base, and limit cycles, whose period nothing prescribes. They are fixed points of a return map of theta,
// velocity and the states: from one period to the next, or from one passage of theta through a section to the next.
// docs/theory.md, section 10.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "algebra/decompositions.hpp"
#include "analysis/branch.hpp"
#include "analysis/closed_search.hpp"
#include "analysis/steady_facts.hpp"
#include "model/controller.hpp"
#include "motion/stillness.hpp"

namespace dinal::analysis {
namespace {

using Vector = Eigen::VectorXd;
using motion::Trajectory;

/// Everything that decides how the motion goes on.
struct Moment {
    model::State state;
    std::vector<double> states = {};
    std::vector<bool> relays = {};  ///< of each relay: it is switched on
    bool stuck = false;             ///< its velocity is that of what it stands on, to the last bit
};

/// What of a moment is no number that may change a little.
struct Mode {
    std::vector<bool> relays = {};
    std::optional<double> held = {};  ///< the velocity of a mass that is stuck
    friend bool operator==(const Mode&, const Mode&) = default;
};
Mode mode_of(const Moment& moment) {
    return {moment.relays, moment.stuck ? std::optional(moment.state.velocity) : std::nullopt};
}

/// A value of theta that a cycle passes, upwards (way = 1) or downwards (-1).
struct Section {
    double theta = 0, way = 1;
};

/// Passes zero upwards where theta passes the section.
class Passage final : public model::UserFunction {
public:
    explicit Passage(const Section& section) : section_(section) {}
    double value(double /*t*/, const model::State& state) override {
        return section_.way * (state.theta - section_.theta);
    }

private:
    Section section_;
};

std::vector<bool> relays_of(const model::Excitation& excitation) {
    std::vector<bool> on;
    for (const model::Component& c : excitation.components()) {
        const auto* relay = model::controller_of<model::RelayController>(c);
        if (relay != nullptr) on.push_back(relay->starts_on);
    }
    return on;
}

/// M with relays that begin so.
model::Excitation with_relays(const model::Excitation& excitation, const std::vector<bool>& on) {
    if (on.empty()) return excitation;
    std::size_t next = 0;
    return excitation.with_functions([&](const std::shared_ptr<model::UserFunction>& function) {
        const auto* relay = dynamic_cast<const model::RelayController*>(function.get());
        if (relay == nullptr) return function;
        auto own = model::copied(*relay, relay->function);
        own->starts_on = on[next++];
        return std::shared_ptr<model::UserFunction>(std::move(own));
    });
}

bool has_acts(const model::Extras& extras) {
    return std::any_of(extras.events.begin(), extras.events.end(),
                       [](const model::WantedEvent& event) { return event.act != nullptr; });
}

/// Runs of the question that begin at any moment.
class Runs {
public:
    Runs(const SteadyQuestion& question, const motion::Monitor& monitor)
        : question_(question),
          monitor_(monitor),
          plain_(!question.extras.any() && !question.system.walls() && !model::has_memory(question.excitation)),
          integrator_(motion::integrator_for(question.system, question.excitation, question.extras)) {}

    [[nodiscard]] const SteadyQuestion& question() const { return question_; }
    [[nodiscard]] std::size_t state_count() const { return question_.extras.states.size(); }
    [[nodiscard]] const std::optional<model::Contradiction>& contradiction() const { return contradiction_; }

    [[nodiscard]] Moment first() const {
        Moment moment{.state = question_.initial, .relays = relays_of(question_.excitation)};
        for (const model::OwnState& state : question_.extras.states) moment.states.push_back(state.start);
        return moment;
    }

    /// The question whose run begins at this moment.
    [[nodiscard]] SteadyQuestion from(const Moment& moment, double start) const {
        SteadyQuestion asked = question_;
        asked.excitation = with_relays(question_.excitation, moment.relays);
        asked.drive.start = start;
        asked.initial = moment.state;
        for (std::size_t i = 0; i < moment.states.size(); ++i) asked.extras.states[i].start = moment.states[i];
        return asked;
    }

    [[nodiscard]] Trajectory run(const Moment& from, double start, double end, const motion::Grid& rows, bool dense,
                                 std::optional<Section> section = {}) {
        const SteadyQuestion asked = this->from(from, start);
        motion::Limits limits;
        limits.dense = dense;
        const model::Extras extras = section ? section_extras(asked, *section) : asked.extras;
        auto result = motion::simulate(asked.system, asked.excitation, asked.initial, {start, end}, rows, integrator_,
                                       monitor_, limits, extras);
        if (!result) {
            Trajectory none;
            none.outcome = model::Outcome::state_not_finite;
            return none;
        }
        if (result->contradiction) contradiction_ = result->contradiction;
        return std::move(result).value();
    }

    struct Arrival {
        Moment at;
        double t = 0;
        bool arrived = false;
        model::Outcome outcome = model::Outcome::reached_end;
    };
    /// The first passage of theta through the section within this time.
    [[nodiscard]] Arrival passage(const Moment& from, double start, double limit, const Section& section) {
        if (plain_) return passage_between_rows(from, start, limit, section);
        const Trajectory run = this->run(from, start, start + limit, motion::Grid::none(), false, section);
        Arrival arrival{.at = {}, .outcome = run.outcome};
        arrival.arrived = run.outcome == model::Outcome::stopped && !run.events.empty();
        if (!arrival.arrived) return arrival;
        arrival.at = at_stop(run, from, run.events.back().M);
        arrival.t = run.t_stop;
        return arrival;
    }

    /// Where a run of a moment ended, at which M was this.
    [[nodiscard]] Moment at_stop(const Trajectory& run, const Moment& from, double M) {
        Moment moment{
            .state = run.state_at_stop, .relays = from.relays, .stuck = run.motion_at_stop == model::Motion::stuck};
        if (run.carried) moment.states = run.carried->states;
        find_relays(moment, M);
        return moment;
    }

private:
    static model::Extras section_extras(const SteadyQuestion& question, const Section& section) {
        model::Extras extras = question.extras;
        extras.events.push_back(
            {.name = "", .when = std::make_shared<Passage>(section), .direction = model::Crossing::up, .stop = true});
        return extras;
    }

    /// A run without anything else to watch for takes its own integrator.
    [[nodiscard]] Arrival passage_between_rows(const Moment& from, double start, double limit, const Section& section) {
        constexpr double looks = 256, longer = 1.05;
        double length = expected_ > 0 ? std::min(longer * expected_, limit) : std::min(limit, longer * limit / 8);
        while (true) {
            const Trajectory run = this->run(from, start, start + length, motion::Grid::every(length / looks), true);
            Arrival arrival{.at = {}, .outcome = run.outcome};
            for (Eigen::Index i = 0; i + 1 < run.size(); ++i) {
                const auto beyond = [&](Eigen::Index row) { return section.way * (run.rows(row, 1) - section.theta); };
                if (!(beyond(i) < 0 && beyond(i + 1) >= 0)) continue;
                arrival.t = passed(run, section, run.rows(i, 0), run.rows(i + 1, 0));
                arrival.at.state = {section.theta, run.at(arrival.t).value().velocity};
                arrival.arrived = true;
                expected_ = arrival.t - start;
                return arrival;
            }
            if (!model::is_whole(run.outcome) || length >= limit) return arrival;
            length = std::min(2 * length, limit);
        }
    }

    static double passed(const Trajectory& run, const Section& section, double below, double above) {
        double t = (below + above) / 2;
        constexpr int most = 80;
        for (int i = 0; i < most; ++i) {
            const model::State there = run.at(t).value();
            const double off = there.theta - section.theta;
            (section.way * off < 0 ? below : above) = t;
            double next = t - off / there.velocity;
            if (!(next > below && next < above)) next = below + (above - below) / 2;
            if (std::fabs(next - t) <= 2e-16 * std::fabs(t) || off == 0) return next;
            t = next;
        }
        return t;
    }

    /// The levels of relays follow from M: those with which a run that begins here has this M.
    void find_relays(Moment& moment, double M) {
        const std::size_t relays = moment.relays.size();
        if (relays == 0) return;
        const std::vector<bool> guess = moment.relays;
        std::vector<bool> best = guess;
        double least = model::never;
        const double start = question_.drive.start, blink = 1e-9 * std::max(1.0, std::fabs(start));
        for (std::size_t pattern = 0; pattern < (std::size_t{1} << relays); ++pattern) {
            for (std::size_t i = 0; i < relays; ++i) moment.relays[i] = guess[i] != (((pattern >> i) & 1U) != 0);
            const Trajectory look = run(moment, start, start + blink, motion::Grid::at({start}), false);
            if (look.size() == 0) continue;
            const double off = std::fabs(look.column(motion::Column::M)[0] - M);
            if (off < least) least = off, best = moment.relays;
            if (off <= 1e-9 * std::fabs(M)) break;
        }
        moment.relays = best;
    }

    const SteadyQuestion& question_;
    const motion::Monitor& monitor_;
    bool plain_;
    motion::Integrator integrator_;
    double expected_ = 0;  // until the next passage
    std::optional<model::Contradiction> contradiction_;
};

/// From one return of the motion to the next. A place is what a moment has besides what is known of all returns, each
/// number in units of how much the motion changes it.
class ReturnMap {
public:
    struct Return {
        Vector to;
        double time = 0;
        bool finished = false;
        model::Outcome outcome = model::Outcome::reached_end;
        Mode mode = {};
    };

    /// By a period from `start` on.
    static ReturnMap of_period(Runs& runs, double start, Vector scale) {
        return {runs, start, runs.question().drive.period, {}, std::move(scale)};
    }
    /// By the next passage of the section upwards, which must come within `limit`.
    static ReturnMap of_section(Runs& runs, double section, double limit, Vector scale) {
        return {runs, runs.question().drive.start, limit, section, std::move(scale)};
    }

    [[nodiscard]] Vector place(const Moment& moment) const {
        Vector place(scale_.size());
        Eigen::Index i = 0;
        if (!section_) place[i++] = moment.state.theta;
        place[i++] = moment.state.velocity;
        for (const double z : moment.states) place[i++] = z;
        return place.cwiseQuotient(scale_);
    }

    [[nodiscard]] Moment moment(const Vector& place, const Mode& mode) const {
        const Vector x = place.cwiseProduct(scale_);
        Moment moment{.state = {}, .relays = mode.relays, .stuck = mode.held.has_value()};
        Eigen::Index i = 0;
        moment.state.theta = section_ ? *section_ : x[i++];
        moment.state.velocity = mode.held.value_or(x[i]);
        for (++i; i < x.size(); ++i) moment.states.push_back(x[i]);
        if (const auto& walls = runs_.question().system.walls()) {
            moment.state.theta = std::clamp(moment.state.theta, walls->lower, walls->upper);
        }
        return moment;
    }

    /// Some returns on.
    [[nodiscard]] Return operator()(const Vector& from, const Mode& mode, int returns = 1) {
        Return sum{.to = from, .finished = true, .mode = mode};
        for (int i = 0; i < returns && sum.finished; ++i) once(sum);
        return sum;
    }

    /// The first return after a moment that need not be one.
    [[nodiscard]] Return arrival(const Moment& from) {
        Return sum{.to = {}, .finished = true, .mode = mode_of(from)};
        once_from(from, sum);
        return sum;
    }

    /// D of the map of so many returns, by differences of this order.
    [[nodiscard]] std::optional<Eigen::MatrixXd> derivative(const Vector& at, const Mode& mode, int returns,
                                                            int order) {
        const Eigen::Index n = at.size(), velocity = section_ ? 0 : 1;
        Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n);
        const double h = order == 2 ? 1e-5 : 3e-4;
        for (Eigen::Index i = 0; i < n; ++i) {
            if (i == velocity && mode.held) continue;  // what is stuck has no other velocity
            const auto slope = [&](double step) -> std::optional<Vector> {
                const Vector up = at + step * Vector::Unit(n, i), down = at - step * Vector::Unit(n, i);
                const Return ahead = (*this)(up, mode, returns), behind = (*this)(down, mode, returns);
                if (!ahead.finished || !behind.finished) return {};
                return (ahead.to - behind.to) / (2 * step);
            };
            const auto near = slope(h);
            const auto far = order == 2 ? near : slope(2 * h);
            if (!near || !far) return {};
            D.col(i) = order == 2 ? *near : Vector((4 * *near - *far) / 3);
        }
        return D;
    }

    [[nodiscard]] double start() const { return start_; }
    [[nodiscard]] Runs& runs() const { return runs_; }

private:
    ReturnMap(Runs& runs, double start, double length, std::optional<double> section, Vector scale)
        : runs_(runs), start_(start), length_(length), section_(section), scale_(std::move(scale)) {}

    void once(Return& sum) { once_from(moment(sum.to, sum.mode), sum); }

    void once_from(const Moment& from, Return& sum) {
        if (section_) {
            const Runs::Arrival arrival = runs_.passage(from, start_, length_, {*section_});
            sum.outcome = arrival.outcome;
            sum.finished = arrival.arrived;
            sum.time += arrival.t - start_;
            if (sum.finished) arrive(arrival.at, sum);
            return;
        }
        const Trajectory run = runs_.run(from, start_, start_ + length_, motion::Grid::none(), false);
        sum.outcome = run.outcome;
        sum.finished = model::is_whole(run.outcome);
        sum.time += length_;
        if (sum.finished) arrive(runs_.at_stop(run, from, 0), sum);
    }

    void arrive(const Moment& at, Return& sum) const {
        sum.mode = mode_of(at);
        sum.to = place(at);
        sum.finished = sum.to.allFinite();
    }

    Runs& runs_;
    double start_, length_;
    std::optional<double> section_;
    Vector scale_;
};

constexpr double largest_stable = 1 + 1e-5;  // multiplier

/// The greatest one first.
std::vector<std::complex<double>> sorted_eigenvalues(const Eigen::MatrixXd& D) {
    const Eigen::VectorXcd values = algebra::eigenvalues(D);
    std::vector<std::complex<double>> sorted(values.data(), values.data() + values.size());
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
    return sorted;
}

/// The facts that a run of the motion's period from this moment tells; false when it fails.
bool tell_period(Runs& runs, const Moment& moment, double start, SteadyMotion& motion, double rows = 400) {
    Trajectory run = runs.run(moment, start, start + motion.period, motion::Grid::every(motion.period / rows), true);
    if (!model::is_whole(run.outcome)) return false;
    motion.outcome = run.outcome;
    if (!motion.multipliers.empty() && std::abs(std::abs(motion.multipliers.front()) - 1) < neutral_within) {
        motion.unique = false;
    }
    motion.asked = std::make_shared<const SteadyQuestion>(runs.from(moment, start));
    tell_of_run(runs.question(), run, motion);
    motion.settled = std::make_shared<const Trajectory>(std::move(run));
    return true;
}

class ReturnSearch {
public:
    ReturnSearch(const SteadyQuestion& question, const motion::Monitor& monitor)
        : question_(question), runs_(question, monitor) {}

    SteadyMotion found() {
        answer_.period = question_.drive.period;
        question_.drive.period > 0 ? forced() : cycle();
        if (runs_.contradiction()) {
            answer_.contradiction = runs_.contradiction();
            answer_.outcome = model::Outcome::not_a_function;
            answer_.status = SteadyStatus::none;
        }
        return answer_;
    }

private:
    /// How far one stretch of the run gets.
    struct Reach {
        double low = 0, high = 0, t = 0;
        Vector scale;  // of theta, velocity and the states: from their least to their greatest
        [[nodiscard]] double range() const { return high - low; }
    };

    [[nodiscard]] static Reach reach_of(const Trajectory& run) {
        const Eigen::Index n = run.size(), states = static_cast<Eigen::Index>(run.state_count());
        Reach reach{.low = run.initial.theta, .high = run.initial.theta, .t = run.t_stop, .scale = Vector(2 + states)};
        for (Eigen::Index k = 0; k < 2 + states; ++k) {
            const Eigen::Index column = k < 2 ? k + 1 : static_cast<Eigen::Index>(motion::column_count) + k - 2;
            reach.scale[k] = n == 0 ? 0 : run.rows.col(column).maxCoeff() - run.rows.col(column).minCoeff();
        }
        if (n > 0) {
            reach.low = std::min(reach.low, run.rows.col(1).minCoeff());
            reach.high = std::max(reach.high, run.rows.col(1).maxCoeff());
        }
        for (const model::Event& event : run.events) {
            reach.low = std::min(reach.low, event.theta);
            reach.high = std::max(reach.high, event.theta);
        }
        reach.scale[0] = reach.range();
        return reach;
    }

    /// Units of places: never zero.
    [[nodiscard]] static Vector units_of(const Reach& reach, const Moment& moment) {
        Vector units = reach.scale;
        const double size = std::max({reach.range(), std::fabs(moment.state.theta), 1e-300});
        if (!(units[0] > 0)) units[0] = size;
        if (!(units[1] > 0)) units[1] = std::max(std::fabs(moment.state.velocity), size);
        for (Eigen::Index k = 2; k < units.size(); ++k) {
            const double now = std::fabs(moment.states[static_cast<std::size_t>(k) - 2]);
            if (!(units[k] > 1e-9 * now)) units[k] = now > 0 ? now : 1;
        }
        return units;
    }

    /// A stretch of the run, with rows enough to see how far it gets; none when it failed, and the answer says how.
    std::optional<Trajectory> stretch(const Moment& from, double start, double length) {
        constexpr int looks = 256;
        Trajectory run = runs_.run(from, start, start + length, motion::Grid::every(length / looks), false);
        answer_.outcome = run.outcome;
        if (model::is_whole(run.outcome) || run.outcome == model::Outcome::stopped) {
            constexpr double beyond = 1e100;
            if (std::fabs(run.state_at_stop.theta) < beyond) return run;
            answer_.outcome = model::Outcome::state_not_finite;
        }
        if (answer_.outcome == model::Outcome::excitation_not_finite && run.size() > 0 &&
            run.rows.col(1).cwiseAbs().maxCoeff() > 1e50) {
            answer_.outcome = model::Outcome::state_not_finite;
        }
        if (answer_.outcome == model::Outcome::state_not_finite) answer_.status = SteadyStatus::grows;
        return {};
    }

    // ---- with a period

    void forced() {
        const double period = question_.drive.period;
        // An act at the very beginning of a run would not happen: returns are looked at where nothing does.
        const bool offset = has_acts(question_.extras);
        constexpr double nowhere = 0.3819660112501051;
        Moment now = runs_.first();
        double start = question_.drive.start;
        if (offset) {
            const auto run = stretch(now, start, nowhere * period);
            if (!run) return;
            now = runs_.at_stop(*run, now, 0);
            start += nowhere * period;
        }
        const auto first = stretch(now, start, period);
        if (!first) return;
        Reach reach = reach_of(*first);
        std::vector<double> ranges{reach.range()};  // of single periods
        std::vector<double> sizes;  // of the first batch of returns, and of both halves of the second one
        const double omega = question_.system.stiffness() > 0 ? question_.system.natural_frequency() : 1;
        const int longest = question_.periods > 0 ? question_.periods : 32;
        for (const auto& counts : {std::vector<int>{3, 8, 24}, std::vector<int>{40, 120, 320}}) {
            ReturnMap map = ReturnMap::of_period(runs_, start, units_of(reach, now));
            ClosedSearch<ReturnMap> search(map, answer_.maps, longest);
            const auto found = search.follow({.to = map.place(now), .finished = true, .mode = mode_of(now)}, counts);
            if (found && tells(map, *found)) return;
            if (search.failed()) {
                answer_.outcome = *search.failed();
                if (answer_.outcome == model::Outcome::state_not_finite) answer_.status = SteadyStatus::grows;
                return;
            }
            const auto& seen = search.seen();
            const auto largest = [&](std::size_t from, std::size_t until) {
                double size = 0;
                for (std::size_t i = from; i < until; ++i) {
                    const model::State y = map.moment(seen[i].to, seen[i].mode).state;
                    // A mass that nothing pulls back may drift without an end.
                    const double theta = question_.system.stiffness() > 0 ? std::fabs(y.theta) : 0;
                    size = std::max({size, theta, std::fabs(y.velocity) / omega});
                }
                return size;
            };
            const std::size_t half = sizes.empty() ? seen.size() : seen.size() / 2;
            sizes.push_back(largest(0, half));
            if (half < seen.size()) sizes.push_back(largest(half, seen.size()));
            now = map.moment(seen.back().to, seen.back().mode);
            const auto last = stretch(now, start, period);
            if (!last) return;
            reach = reach_of(*last);
            ranges.push_back(reach.range());
        }
        // A motion that beats is as large in one half as in the other, and one that creeps has the same range.
        const bool widens = ranges[2] > 1.3 * ranges[1] && ranges[1] > 1.1 * ranges[0];
        if (widens && sizes[2] > 1.15 * sizes[1] && sizes[1] > 1.1 * sizes[0]) {
            answer_.status = SteadyStatus::grows;
            answer_.growth = (sizes[2] - sizes[1]) / 160;
        }
    }

    // ---- without

    void cycle() {
        const model::Oscillator& system = question_.system;
        const double base = system.stiffness() > 0 ? system.natural_period() : 1, start = question_.drive.start;
        Moment now = runs_.first();
        double length = base, time = 0, largest = 0;
        std::size_t events = 0;
        std::vector<std::pair<double, double>> ranges;  // time, range
        constexpr int most_stretches = 40;
        for (int i = 0; i < most_stretches; ++i) {
            const auto run = stretch(now, start, length);
            if (!run) return;
            const Reach reach = reach_of(*run);
            time += length;
            events += run->events.size();
            largest = std::max({largest, reach.range(), std::fabs(reach.low), std::fabs(reach.high)});
            ranges.emplace_back(time, reach.range());
            if (i == 0) most_changed_ = reach.scale;
            most_changed_ = most_changed_.cwiseMax(reach.scale);
            const double M = run->size() > 0 ? run->column(motion::Column::M)[run->size() - 1] : 0;
            const Moment before = now;
            now = runs_.at_stop(*run, before, M);
            if (rests(*run, reach, largest)) {
                answer_.asked = std::make_shared<const SteadyQuestion>(runs_.from(now, start));
                return;
            }
            constexpr double nothing = 1e-9;
            if (reach.range() > nothing * largest && closes_from(now, reach, length, i)) return;
            constexpr std::size_t many_events = 6000;
            const bool cheap = !(system.stiffness() > 0) && events < 200;
            if (events > many_events || (!cheap && time > 3000 * base)) break;
            length *= 1.5;
        }
        judge_growth(ranges);
    }

    bool closes_from(const Moment& now, const Reach& reach, double length, int i) {
        constexpr double place = 0.42;  // off the middle, where many motions have an end of something
        const double section = reach.low + place * reach.range();
        Vector units = units_of(reach, now).tail(reach.scale.size() - 1);
        ReturnMap map = ReturnMap::of_section(runs_, section, 3 * length, std::move(units));
        const ReturnMap::Return first = map.arrival(now);
        if (!first.finished) return false;
        ClosedSearch<ReturnMap> search(map, answer_.maps, 16);
        const std::vector<int> counts = i < 4 ? std::vector<int>{3, 6} : std::vector<int>{3, 8, 24, 60};
        const auto found = search.follow(first, counts);
        return found && tells(map, *found);
    }

    /// Nothing depends on the time: what stands, and leaves everything as it is, stands for ever.
    bool rests(const Trajectory& run, const Reach& reach, double largest) {
        const bool stuck = run.motion_at_stop == model::Motion::stuck;
        const bool same_states = [&] {
            for (Eigen::Index k = 2; k < reach.scale.size(); ++k) {
                if (reach.scale[k] > 1e-8 * most_changed_[k]) return false;
            }
            return true;
        }();
        const bool moves = run.state_at_stop.velocity != 0;
        const bool stands = stuck && !moves && reach.scale.size() == 2;
        const bool still = reach.range() <= 1e-11 * largest && same_states;
        if (stuck && moves && same_states && run.events.empty() && !(question_.system.stiffness() > 0) &&
            !question_.excitation.has_feedback() && question_.system.spring().none()) {
            answer_.status = SteadyStatus::adheres;  // to the belt, which takes it along
        } else if (stands || still) {
            answer_.status = SteadyStatus::rest;
        } else {
            return false;
        }
        const double theta = run.state_at_stop.theta;
        answer_.period = 0;
        answer_.start = {theta, answer_.status == SteadyStatus::rest ? 0 : run.state_at_stop.velocity};
        answer_.low = answer_.high = theta;
        answer_.amplitude = 0;
        answer_.stuck = stuck ? 1 : 0;
        answer_.stable = true;
        answer_.rest = {theta, theta};
        if (stuck && !moves && answer_.status == SteadyStatus::rest) answer_.rest = rest_of(question_, theta);
        if (answer_.rest.first < answer_.rest.second) answer_.unique = false;
        return true;
    }

    void judge_growth(const std::vector<std::pair<double, double>>& ranges) {
        const std::size_t n = ranges.size();
        if (n < 4 || !(ranges[n - 1].second > 1.2 * ranges[n - 2].second) ||
            !(ranges[n - 2].second > 1.2 * ranges[n - 3].second)) {
            return;
        }
        answer_.status = SteadyStatus::grows;
        const double base = question_.system.stiffness() > 0 ? question_.system.natural_period() : 1;
        answer_.growth =
            (ranges[n - 1].second - ranges[n - 2].second) / 2 / ((ranges[n - 1].first - ranges[n - 2].first) / base);
    }

    /// The facts about a motion that closes; false when no run stays with it.
    bool tells(ReturnMap& map, const Closed<Mode>& found) {
        const auto D = map.derivative(found.x, found.mode, found.returns, 4);
        answer_.maps += 4 * found.returns * static_cast<int>(found.x.size());
        std::vector<std::complex<double>> multipliers;
        if (D) multipliers = sorted_eigenvalues(*D);
        if (D && !multipliers.empty() && std::abs(multipliers.front()) > largest_stable) return false;
        const bool forced = question_.drive.period > 0;
        answer_.periods = forced ? found.returns : 1;
        answer_.period = forced ? found.returns * question_.drive.period : found.period;
        answer_.multipliers = std::move(multipliers);
        answer_.differentiable = D.has_value();
        answer_.stable = true;
        answer_.residual = found.residual;
        return tell_period(runs_, map.moment(found.x, found.mode), map.start(), answer_);
    }

    const SteadyQuestion& question_;
    Runs runs_;
    Vector most_changed_;  // in any stretch: theta, velocity and the states
    SteadyMotion answer_;
};

/// The return map of a branch: its places are theta, velocity and the states from period to period, or all but theta
/// from passage to passage.
class ReturnCircuit final : public Circuit {
public:
    ReturnCircuit(const Family& family, double p, const SteadyMotion& motion, int periods,
                  const motion::Monitor& monitor)
        : family_(family), monitor_(monitor), periods_(periods) {
        Runs& runs = this->runs(p);
        const SteadyQuestion& question = runs.question();
        timeless_ = question.is_timeless();
        stands_ = timeless_ && motion.status == SteadyStatus::rest;
        cycles_ = timeless_ && !stands_;
        offset_ = motion.asked->drive.start - question.drive.start;
        period_ = motion.period;
        Moment moment{.state = motion.asked->initial, .relays = relays_of(motion.asked->excitation)};
        for (const model::OwnState& state : motion.asked->extras.states) moment.states.push_back(state.start);
        relays_ = moment.relays;
        if (!cycles_) {
            first_ = place(moment);
            return;
        }
        section_ = section_of(motion);
        // A passage against the way of the belt slides.
        const model::Excitation& belt = question.extras.belt;
        if (!belt.components().empty() && belt.value(question.drive.start) > 0) section_.way = -1;
        Runs::Arrival arrival = runs.passage(moment, start(runs), 3 * period_, section_);
        if (!arrival.arrived) return;
        first_ = place(arrival.at);
        // It may pass more than once in its period.
        int passages = 0;
        for (double left = (1 - 1e-6) * period_; left > 0 && arrival.arrived; ++passages) {
            arrival = runs.passage(arrival.at, start(runs), 3 * period_, section_);
            left -= arrival.t - start(runs);
        }
        passages_ = passages * periods;
    }

    Lap lap(const Eigen::VectorXd& x, double p) override {
        Runs& runs = this->runs(p);
        const Moment from = moment(x, runs);
        Lap lap;
        model::Outcome outcome = model::Outcome::reached_end;
        if (cycles_) {
            Moment now = from;
            lap.finished = true;
            for (int i = 0; i < passages_ && lap.finished; ++i) {
                const Runs::Arrival arrival = runs.passage(now, start(runs), 3 * period_, section_);
                outcome = arrival.outcome;
                lap.finished = arrival.arrived;
                lap.time += arrival.t - start(runs);
                now = arrival.at;
            }
            if (lap.finished) lap.to = place(now);
        } else {
            lap.time = length(runs);
            const Trajectory run = runs.run(from, start(runs), start(runs) + lap.time, motion::Grid::none(), false);
            outcome = run.outcome;
            lap.finished = model::is_whole(outcome);
            if (lap.finished) lap.to = place(runs.at_stop(run, {.state = {}}, 0));
        }
        lap.finished = lap.finished && lap.to.allFinite();
        see(outcome, runs.contradiction());
        return lap;
    }

    SteadyMotion motion(const Eigen::VectorXd& x, double p, const Lap& lap,
                        const Eigen::MatrixXd& derivative) override {
        Runs& runs = this->runs(p);
        const Moment moment = this->moment(x, runs);
        SteadyMotion motion;
        motion.multipliers = sorted_eigenvalues(derivative);
        motion.differentiable = true;
        motion.stable = motion.multipliers.empty() || std::abs(motion.multipliers.front()) <= largest_stable;
        if (stands_) {
            motion.status = SteadyStatus::rest;
            motion.start = {moment.state.theta, 0};
            motion.low = motion.high = moment.state.theta;
            motion.rest = {moment.state.theta, moment.state.theta};
            motion.asked = std::make_shared<const SteadyQuestion>(runs.from(moment, start(runs)));
            return motion;
        }
        motion.periods = periods_;
        motion.period = lap.time;
        period_ = lap.time;
        constexpr double rows = 64;  // they tell how far it goes, and turns are looked for between them
        if (!tell_period(runs, moment, start(runs), motion, rows)) motion.status = SteadyStatus::none;
        return motion;
    }

    [[nodiscard]] Eigen::VectorXd units(const Eigen::VectorXd& x, const Lap& /*lap*/,
                                        const SteadyMotion& motion) const override {
        Eigen::VectorXd units = Eigen::VectorXd::Zero(x.size());
        if (motion.settled) {
            const Trajectory& run = *motion.settled;
            const Eigen::Index first = cycles_ ? 1 : 0;
            for (Eigen::Index i = 0; i < x.size(); ++i) {
                const Eigen::Index k = i + first;
                const Eigen::Index column = k < 2 ? k + 1 : static_cast<Eigen::Index>(motion::column_count) + k - 2;
                units[i] = run.rows.col(column).maxCoeff() - run.rows.col(column).minCoeff();
            }
        }
        if (stands_) {
            const model::Oscillator& system = here_->question.system;
            const double omega = system.stiffness() > 0 ? system.natural_frequency() : 1;
            const double belt = here_->question.extras.belt.value(start(here_->runs));
            const model::State& asked = here_->question.initial;
            units[0] = std::max({std::fabs(belt) / omega, std::fabs(x[0]), std::fabs(asked.theta - x[0]),
                                 std::fabs(asked.velocity) / omega});
            units[1] = units[0] * omega;
        }
        for (Eigen::Index i = 0; i < x.size(); ++i) {
            if (!(units[i] > 1e-9 * std::fabs(x[i]))) units[i] = x[i] == 0 ? 1 : std::fabs(x[i]);
        }
        return units;
    }

    std::optional<std::vector<Eigen::VectorXd>> recentred(
        const SteadyMotion& motion, const std::vector<std::pair<Eigen::VectorXd, double>>& places) override {
        const double at = (section_.theta - motion.low) / (motion.high - motion.low);
        if (!cycles_ || (at > 0.3 && at < 0.54)) return {};
        Section next = section_of(motion);
        next.way = section_.way;
        std::vector<Eigen::VectorXd> moved;
        for (const auto& [x, p] : places) {
            Runs& runs = this->runs(p);
            const Runs::Arrival arrival = runs.passage(moment(x, runs), start(runs), 3 * period_, next);
            if (!arrival.arrived) return {};
            moved.push_back(place(arrival.at));
        }
        section_ = next;
        return moved;
    }

private:
    struct Here {
        double p;
        SteadyQuestion question;
        Runs runs;
        Here(double at, SteadyQuestion asked, const motion::Monitor& monitor)
            : p(at), question(std::move(asked)), runs(question, monitor) {}
    };

    [[nodiscard]] static Section section_of(const SteadyMotion& motion) {
        constexpr double place = 0.42;  // off the middle, where many motions have an end of something
        return {motion.low + place * (motion.high - motion.low)};
    }
    /// Of the question at this parameter.
    Runs& runs(double p) {
        if (!here_ || here_->p != p) here_ = std::make_unique<Here>(p, family_(p), monitor_);
        return here_->runs;
    }
    [[nodiscard]] double start(const Runs& runs) const { return runs.question().drive.start + offset_; }
    [[nodiscard]] double length(const Runs& runs) const {
        if (!timeless_) return periods_ * runs.question().drive.period;
        const model::Oscillator& system = runs.question().system;
        return system.stiffness() > 0 ? system.natural_period() / 4 : 1;
    }
    [[nodiscard]] Eigen::VectorXd place(const Moment& moment) const {
        Eigen::VectorXd x((cycles_ ? 1 : 2) + static_cast<Eigen::Index>(moment.states.size()));
        Eigen::Index i = 0;
        if (!cycles_) x[i++] = moment.state.theta;
        x[i++] = moment.state.velocity;
        for (const double z : moment.states) x[i++] = z;
        return x;
    }
    [[nodiscard]] Moment moment(const Eigen::VectorXd& x, const Runs& runs) const {
        Moment moment{.state = {}, .relays = relays_};
        Eigen::Index i = 0;
        moment.state.theta = cycles_ ? section_.theta : x[i++];
        moment.state.velocity = x[i++];
        for (; i < x.size(); ++i) moment.states.push_back(x[i]);
        if (const auto& walls = runs.question().system.walls()) {
            moment.state.theta = std::clamp(moment.state.theta, walls->lower, walls->upper);
        }
        return moment;
    }

    const Family& family_;
    const motion::Monitor& monitor_;
    int periods_, passages_ = 1;
    bool timeless_ = false;
    double offset_ = 0, period_ = 0;
    Section section_;
    std::vector<bool> relays_;
    std::unique_ptr<Here> here_;
};

}  // namespace

std::unique_ptr<Circuit> circuit_of_returns(const Family& family, double p, const SteadyMotion& motion, int periods,
                                            const motion::Monitor& monitor) {
    if (!motion.asked) return {};
    auto circuit = std::make_unique<ReturnCircuit>(family, p, motion, periods, monitor);
    if (circuit->first().size() == 0) return {};
    return circuit;
}

std::unique_ptr<Circuit> circuit_of_first_cycles(const Family& family, double p, const SteadyMotion& rest,
                                                 const motion::Monitor& monitor) {
    if (!rest.asked) return {};
    ReturnCircuit still(family, p, rest, 1, monitor);
    const Vector x = still.first();
    const Circuit::Lap lap = still.lap(x, p);
    const Vector units = still.units(x, lap, rest);
    const Eigen::Index n = x.size();
    Eigen::MatrixXd D(n, n);  // of the scaled places
    constexpr double h = 1e-4;
    for (Eigen::Index i = 0; i < n; ++i) {
        const Vector step = h * units[i] * Vector::Unit(n, i);
        const Circuit::Lap up = still.lap(x + step, p), down = still.lap(x - step, p);
        if (!up.finished || !down.finished) return {};
        D.col(i) = (up.to - down.to).cwiseQuotient(2 * h * units);
    }
    const auto [values, vectors] = algebra::eigenpairs(D);
    Eigen::Index best = 0;
    for (Eigen::Index i = 1; i < n; ++i) {
        if (std::abs(std::abs(values[i]) - 1) < std::abs(std::abs(values[best]) - 1)) best = i;
    }
    const double turn = std::fabs(std::arg(values[best]));
    if (!(turn > 1e-6)) return {};
    constexpr double small = 1e-3;  // of the units: the cycle differs from the linearised motion by its square
    const Eigen::VectorXcd mode = small * vectors.col(best).normalized().cwiseProduct(units);
    const Vector begin = x + mode.real();
    SteadyQuestion asked = *rest.asked;
    asked.initial = {begin[0], begin[1]};
    for (Eigen::Index i = 2; i < n; ++i) asked.extras.states[static_cast<std::size_t>(i) - 2].start = begin[i];
    SteadyMotion cycle;
    cycle.status = SteadyStatus::steady;
    cycle.period = 2 * std::numbers::pi * lap.time / turn;
    cycle.low = x[0] - std::abs(mode[0]);
    cycle.high = x[0] + std::abs(mode[0]);
    cycle.asked = std::make_shared<const SteadyQuestion>(std::move(asked));
    return circuit_of_returns(family, p, cycle, 1, monitor);
}

void tell_of_run(const SteadyQuestion& question, const Trajectory& run, SteadyMotion& motion) {
    motion.start = run.initial;
    motion.low = motion.high = run.initial.theta;
    motion.t_high = run.t_start;
    const auto see = [&motion](double t, double theta) {
        if (theta > motion.high) motion.high = theta, motion.t_high = t;
        motion.low = std::min(motion.low, theta);
    };
    for (const model::Event& event : run.events) {
        see(event.t, event.theta);
        if (event.kind != model::EventKind::user) continue;
        if (const auto thrown = run.at(event.t)) see(event.t, thrown->theta);
    }
    if (run.on_belt) {
        for (const model::Event& turn : motion::turns_on_belt(run)) see(turn.t, turn.theta);
    }
    see(run.t_stop, run.state_at_stop.theta);
    const double length = run.t_stop - run.t_start;
    double stuck = 0;
    motion.stops = 0;
    for (const Stretch& s : stretches(run)) {
        if (!s.stuck) continue;
        motion.stops += s.begun_by ? 1U : 0U;
        stuck += s.lasts();
    }
    const bool moves = motion.high > motion.low;
    motion.status = moves ? SteadyStatus::steady : SteadyStatus::adheres;
    motion.amplitude = (motion.high - motion.low) / 2 + 0.0;
    motion.stuck = moves ? std::min(1.0, stuck / length) : 1;
    if (!moves) motion.rest = rest_of(question, motion.start.theta);
}

SteadyMotion returning_motion(const SteadyQuestion& question, const motion::Monitor& monitor) {
    return ReturnSearch(question, monitor).found();
}

}  // namespace dinal::analysis
