// The return map as the map of a branch: for several bodies, for runs with states, events, belts or a base, for an M
// with a memory, and for limit cycles of unknown period.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "algebra/decompositions.hpp"
#include "analysis/branch.hpp"
#include "analysis/returns.hpp"
#include "analysis/steady_facts.hpp"
#include "motion/simulate.hpp"

namespace dinal::analysis {
namespace {

using Eigen::VectorXd;

/// A return map on a branch. A place has angles, velocities and states from period to period, or all but one of them
/// from passage to passage.
class ReturnCircuit final : public Circuit {
public:
    ReturnCircuit(const Family& family, double p, const SteadyMotion& motion, int periods,
                  const motion::Monitor& monitor, const std::optional<Returns::Section>& section = {})
        : family_(family), monitor_(monitor), periods_(periods) {
        const SteadyQuestion asked = for_returns(*motion.by_returns.question);
        for (const model::Excitation& load : asked.drive.loads) relays_.push_back(relays_of(load));
        Here& here = at(p);
        chart_.emplace(chart_of(here.runs));
        timeless_ = here.question.is_timeless();
        half_ = motion.symmetric;
        stands_ = timeless_ && motion.period == 0;
        cycles_ = timeless_ && !stands_;
        offset_ = motion.by_returns.question->repeats.start - here.question.repeats.start;
        period_ = motion.period;
        FullState begin = Runs(asked, monitor).first();
        if (const auto& period = motion.by_returns.of_bodies) {
            begin.y = vector_of(period->run.left->history->at(period->run.t_start));
        }
        begin.y = there_ = chart_->measured(begin.y);  // rotating bodies begin at 0, where angles are exact
        held_ = held_in(motion);
        if (!cycles_) {
            first_ = returns(here, section_).place(there_);
            return;
        }
        const auto found = section ? section : section_of(motion);
        if (!found) return;
        section_ = *found;
        // A passage against the belt's direction slides.
        const auto n = here.runs.bodies();
        const model::Excitation& belt = here.question.drive.belts[static_cast<std::size_t>(section_.measured % n)];
        if (!belt.components().empty() && belt.value(here.question.repeats.start) > 0) section_.way = -1;
        Returns map = returns(here, section_);
        Returns::Return arrival = map.arrival(begin);
        if (!arrival.finished) return;
        first_ = arrival.to;
        // A cycle may pass the section several times in its period.
        int passages = 0;
        for (double left = (1 - 1e-6) * period_; left > 0 && arrival.finished; ++passages) {
            arrival = map(arrival.to, {}, 1);
            left -= arrival.time;
            if (arrival.time < shortest_passage * period_) arrival.finished = false;
        }
        if (!arrival.finished) first_.resize(0);
        passages_ = passages * periods;
    }

    Lap lap(const VectorXd& x, double p) override {
        Here& here = at(p);
        const Returns::Return back = returns(here, section_)(x, {}, passages_);
        Lap lap{.to = back.to, .finished = back.finished};
        lap.time = back.time;
        if (back.time < shortest_passage * period_) lap.finished = false;
        if (back.mode) lap.mode = std::make_shared<const HeldMode>(*back.mode);
        note_outcome(back.outcome, here.runs.contradiction());
        return lap;
    }

    SteadyMotion motion(const VectorXd& x, double p, const Lap& lap, const Eigen::MatrixXd& derivative) override {
        Here& here = at(p);
        // The mode at the return is that at the beginning.
        FullState begin = full_state(x, p);
        if (!stands_ && lap.mode) begin.mode = *lap.mode;
        const model::System& system = here.runs.system();
        SteadyMotion motion;
        motion.multipliers = multipliers_of(half_ ? Eigen::MatrixXd(derivative * derivative) : derivative);
        motion.symmetric = half_;
        motion.differentiable = true;
        motion.stable = motion.multipliers.empty() || std::abs(motion.multipliers.front()) <= largest_stable;
        motion.by_returns.drive = std::make_shared<const model::Drive>(here.runs.from(begin, start(here)));
        if (stands_) {
            const auto velocity = begin.y.segment(here.runs.bodies(), here.runs.bodies());
            const bool rotates = chart_->any_rotates() && velocity.cwiseAbs().maxCoeff() > 0;
            motion.status = rotates ? SteadyStatus::steady : SteadyStatus::rest;
            motion.bodies = bodies_at(begin.y, *chart_, here.runs.bodies());
            motion = seen_from(here.question, motion, {});
            motion.by_returns.question = begun_at(here.question, *motion.by_returns.drive, start(here));
            return motion;
        }
        motion.periods = periods_;
        motion.period = period_ = half_ ? 2 * lap.time : lap.time;
        note_family(motion);
        if (!held_.empty()) motion.unique = false;
        constexpr int rows = 64;  // the range is read from them, and turns are searched between them
        auto period = std::make_shared<PeriodOfBodies>(PeriodOfBodies{*motion.by_returns.drive, {}});
        period->run = motion::completed(system, period->drive,
                                        here.runs.run(begin, start(here), start(here) + motion.period,
                                                      motion::Grid::every(motion.period / rows), true));
        const motion::Run& run = period->run;
        if (run.contradiction) motion.contradiction = run.contradiction;
        if (!model::is_whole(run.outcome)) return motion;
        motion.outcome = run.outcome;
        motion.bodies = bodies_of(run, *chart_, reach_of_rows(run, *chart_));
        const auto seen = std::make_shared<const motion::Run>(
            motion::part_of(system, period->drive, run, here.question.joint.value_or(0)));
        motion.by_returns.of_bodies = std::move(period);
        return seen_from(here.question, motion, seen);
    }

    VectorXd units(const VectorXd& x, const Lap& /*lap*/, const SteadyMotion& motion) const override {
        VectorXd units = VectorXd::Zero(x.size());
        const std::vector<Eigen::Index> own = returns(*here_, section_).own();
        if (motion.by_returns.of_bodies) units = reach_of(motion.by_returns.of_bodies->run, *chart_, 64).range()(own);
        const auto n = here_->runs.bodies();
        if (stands_) {
            const double natural = here_->runs.natural_period(),
                         omega = natural > 0 ? 2 * std::numbers::pi / natural : 1;
            const model::Drive& drive = here_->question.drive;
            double size = 0;
            for (const model::Excitation& belt : drive.belts) {
                size = std::max(size, std::fabs(belt.value(start(*here_))) / omega);
            }
            for (std::size_t i = 0; i < own.size() && own[i] < n; ++i) {
                const double at = x[static_cast<Eigen::Index>(i)];
                size = std::max({size, std::fabs(at), std::fabs(drive.theta0[static_cast<std::size_t>(own[i])] - at)});
            }
            for (const double velocity : drive.velocity0) size = std::max(size, std::fabs(velocity) / omega);
            for (std::size_t i = 0; i < own.size(); ++i) {
                const auto place = static_cast<Eigen::Index>(i);
                const auto state = static_cast<std::size_t>(std::max<Eigen::Index>(own[i] - 2 * n, 0));
                if (own[i] < 2 * n) {
                    units[place] = own[i] < n ? size : size * omega;
                } else if (state < drive.states.size()) {
                    // A state that has decayed by the end of the motion gives no scale.
                    units[place] = std::max(std::fabs(x[place]), std::fabs(drive.states[state].start));
                    if (!(units[place] > 1e-9 * size)) units[place] = size;
                }
            }
        }
        for (Eigen::Index i = 0; i < x.size(); ++i) {
            if (!(units[i] > 1e-9 * std::fabs(x[i]))) units[i] = x[i] == 0 ? 1 : std::fabs(x[i]);
        }
        return units;
    }

    std::optional<std::vector<VectorXd>> recentred(const SteadyMotion& motion,
                                                   const std::vector<std::pair<VectorXd, double>>& places) override {
        if (!cycles_) return {};
        const auto [low, high] = range_of(motion, section_.measured);
        const double at = (section_.place - low) / (high - low);
        if (at > 0.3 && at < 0.54) return {};
        auto next = section_of(motion);
        if (!next || next->measured != section_.measured) return {};
        next->way = section_.way;
        std::vector<VectorXd> moved;
        for (const auto& [x, p] : places) {
            const Returns::Return arrival = returns(this->at(p), *next).arrival(full_state(x, p));
            if (!arrival.finished) return {};
            moved.push_back(arrival.to);
        }
        section_ = *next;
        return moved;
    }

    VectorXd growth() const override { return growth_; }
    /// Marks a cycle that began as a disturbance of this rest.
    void begins_at(const VectorXd& rest) { growth_ = first_ - returns(*here_, section_).place(rest); }
    /// The moment that corresponds to a place.
    [[nodiscard]] FullState full_state(const VectorXd& x, double p) {
        return returns(at(p), section_).full_state(x, {});
    }
    std::vector<Eigen::Index> own() const { return returns(*here_, section_).own(); }
    [[nodiscard]] std::shared_ptr<const SteadyQuestion> question_from(const VectorXd& x, double p) {
        return begun_at(at(p).question, at(p).runs.from(full_state(x, p), start(at(p))), start(at(p)));
    }

private:
    struct Here {
        double p;
        SteadyQuestion question;
        Runs runs;
        Here(double value, const SteadyQuestion& asked, const std::vector<std::vector<bool>>& relays,
             const motion::Monitor& monitor)
            : p(value), question(for_returns(asked)), runs(question, monitor) {
            for (std::size_t i = 0; i < relays.size(); ++i) {
                question.drive.loads[i] = with_relays(question.drive.loads[i], relays[i]);
            }
        }
    };

    /// The bodies that friction with the ground holds throughout the motion. They may stand at other places, too: with
    /// their places as unknowns, the motions would form a surface instead of a curve.
    std::vector<Eigen::Index> held_in(const SteadyMotion& motion) const {
        if (stands_ || !motion.by_returns.of_bodies) return {};
        const motion::Run& run = motion.by_returns.of_bodies->run;
        const VectorXd range = reach_of(run, *chart_, 64).range().head(here_->runs.bodies());
        // A body that creeps to the place where friction can hold it moves less and less.
        constexpr double creep = 1e-6;
        const auto& joints = here_->runs.system().joints;
        std::vector<Eigen::Index> held;
        for (std::size_t j = 0; j < joints.size(); ++j) {
            const auto body = static_cast<Eigen::Index>(joints[j].first());
            const bool sticks = joints[j].of.size() == 1 && run.left->carry->mode.holds(j);
            if (sticks && !chart_->rotates(body) && range[body] <= creep * range.maxCoeff()) held.push_back(body);
        }
        return held;
    }
    /// The range of a measured number.
    std::pair<double, double> range_of(const SteadyMotion& motion, Eigen::Index measured) const {
        if (chart_->bodies() == 1 && measured == 0) return {motion.low, motion.high};
        const Reach reach = reach_of(motion.by_returns.of_bodies->run, *chart_, 64);
        return {reach.low[measured], reach.high[measured]};
    }
    std::optional<Returns::Section> section_of(const SteadyMotion& motion) const {
        Eigen::Index measured = 0;
        if (chart_->bodies() > 1 || !chart_->measures(0)) {
            const auto n = static_cast<Eigen::Index>(chart_->bodies());
            measured = motion.by_returns.of_bodies
                           ? widest_of(reach_of(motion.by_returns.of_bodies->run, *chart_, 64), *chart_, n)
                           : -1;
        }
        if (measured < 0) return {};
        const auto [low, high] = range_of(motion, measured);
        return Returns::Section{.measured = measured, .place = low + section_at * (high - low)};
    }
    /// The question at this parameter, cached.
    Here& at(double p) {
        if (!here_ || here_->p != p) here_ = std::make_unique<Here>(p, family_(p), relays_, monitor_);
        return *here_;
    }
    double start(const Here& here) const { return here.question.repeats.start + offset_; }
    Returns returns(Here& here, const Returns::Section& section) const {
        // For a rest a quarter of the fastest natural period: short enough to see each disturbance's rotation.
        const double natural = here.runs.system().shortest_natural_period();
        const double length = cycles_                  ? 3 * period_
                              : half_                  ? here.question.repeats.period / 2
                              : !timeless_             ? periods_ * here.question.repeats.period
                              : std::isfinite(natural) ? natural / 4
                                                       : 1;
        const auto passed = cycles_ ? std::optional(section) : std::nullopt;
        Returns map(here.runs, *chart_, start(here), length, passed, VectorXd::Ones(there_.size()), there_);
        map.hold(held_);
        if (half_) map.end_at_opposites();
        return map;
    }

    static constexpr double shortest_passage = 1e-6;  // of a period: rounding causes a passage at the start

    const Family& family_;
    const motion::Monitor& monitor_;
    int periods_, passages_ = 1;
    bool timeless_ = false;
    double offset_ = 0, period_ = 0;
    std::optional<Chart> chart_;
    Returns::Section section_;
    std::vector<std::vector<bool>> relays_;  // switch positions for each load
    VectorXd there_, growth_;
    std::vector<Eigen::Index> held_;
    std::unique_ptr<Here> here_;
};

}  // namespace

std::unique_ptr<Circuit> circuit_of_returns(const Family& family, double p, const SteadyMotion& motion, int periods,
                                            const motion::Monitor& monitor) {
    if (!motion.by_returns.question) return {};
    auto circuit = std::make_unique<ReturnCircuit>(family, p, motion, periods, monitor);
    if (circuit->first().size() == 0) return {};
    return circuit;
}

std::unique_ptr<Circuit> circuit_of_first_cycles(const Family& family, double p, const SteadyMotion& rest,
                                                 const motion::Monitor& monitor) {
    // NOTE: the smallest cycles of several bodies are not followed: as the bodies turn, the section moves away.
    if (!rest.by_returns.question || !rest.by_returns.question->is_plain()) return {};
    ReturnCircuit still(family, p, rest, 1, monitor);
    const VectorXd x = still.first();
    const Circuit::Lap lap = still.lap(x, p);
    const VectorXd units = still.units(x, lap, rest);
    const Eigen::Index n = x.size();
    Eigen::MatrixXd D(n, n);  // derivative with respect to scaled places
    constexpr double h = 1e-4;
    for (Eigen::Index i = 0; i < n; ++i) {
        const VectorXd step = h * units[i] * VectorXd::Unit(n, i);
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
    constexpr double small = 1e-3;  // size in units: the cycle deviates from linear motion by its square
    const Eigen::VectorXcd mode = small * vectors.col(best).normalized().cwiseProduct(units);
    // The angle, or velocity if no angle is measured, with the largest swing.
    const std::vector<Eigen::Index> own = still.own();
    const auto bodies = static_cast<Eigen::Index>(rest.bodies.size());
    const Eigen::Index until = !own.empty() && own.front() < bodies ? bodies : 2 * bodies;
    Eigen::Index widest = 0;
    for (Eigen::Index i = 1; i < n && own[static_cast<std::size_t>(i)] < until; ++i) {
        if (std::abs(mode[i]) > std::abs(mode[widest])) widest = i;
    }
    const double swing = std::abs(mode[widest]), low = x[widest] - swing;
    SteadyMotion cycle;
    cycle.status = SteadyStatus::steady;
    cycle.period = 2 * std::numbers::pi * lap.time / turn;
    cycle.by_returns.question = still.question_from(x + mode.real(), p);
    auto circuit = std::make_unique<ReturnCircuit>(
        family, p, cycle, 1, monitor,
        Returns::Section{.measured = own[static_cast<std::size_t>(widest)], .place = low + section_at * 2 * swing});
    if (circuit->first().size() == 0) return {};
    circuit->begins_at(still.full_state(x, p).y);
    return circuit;
}

}  // namespace dinal::analysis
