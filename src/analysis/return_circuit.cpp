// The return map of one body as the map of a branch: of runs with states, events, a belt or a base, of an M with a
// memory, and of limit cycles, whose period nothing prescribes.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "algebra/decompositions.hpp"
#include "analysis/branch.hpp"
#include "analysis/returns.hpp"
#include "analysis/steady_facts.hpp"
#include "motion/engine/part.hpp"

namespace dinal::analysis {
namespace {

using Eigen::VectorXd;
using motion::Trajectory;

/// The return map of a branch: its places are theta, velocity and the states from period to period, or all but theta
/// from passage to passage.
class ReturnCircuit final : public Circuit {
public:
    ReturnCircuit(const Family& family, double p, const SteadyMotion& motion, int periods,
                  const motion::Monitor& monitor)
        : family_(family), monitor_(monitor), periods_(periods), relays_(relays_of(motion.asked->excitation)) {
        Here& here = at(p);
        timeless_ = here.question.is_timeless();
        stands_ = timeless_ && motion.status == SteadyStatus::rest;
        cycles_ = timeless_ && !stands_;
        offset_ = motion.asked->drive.start - here.question.drive.start;
        period_ = motion.period;
        const Moment begin = Here::begun_by(*motion.asked);
        there_ = begin.y;
        if (!cycles_) {
            first_ = there_;
            return;
        }
        section_ = section_of(motion);
        // A passage against the way of the belt slides.
        const model::Excitation& belt = here.question.extras.belt;
        if (!belt.components().empty() && belt.value(here.question.drive.start) > 0) section_.way = -1;
        Returns map = returns(here, section_);
        Returns::Return arrival = map.arrival(begin);
        if (!arrival.finished) return;
        first_ = arrival.to;
        // It may pass more than once in its period.
        int passages = 0;
        for (double left = (1 - 1e-6) * period_; left > 0 && arrival.finished; ++passages) {
            arrival = map(arrival.to, {});
            left -= arrival.time;
        }
        passages_ = passages * periods;
    }

    Lap lap(const Eigen::VectorXd& x, double p) override {
        Here& here = at(p);
        const Returns::Return back = returns(here, section_)(x, {}, passages_);
        Lap lap{.to = back.to, .finished = back.finished};
        lap.time = back.time;
        see(back.outcome, here.runs.contradiction());
        return lap;
    }

    SteadyMotion motion(const Eigen::VectorXd& x, double p, const Lap& lap,
                        const Eigen::MatrixXd& derivative) override {
        Here& here = at(p);
        const Moment moment = returns(here, section_).moment(x, {});
        SteadyMotion motion;
        motion.multipliers = multipliers_of(derivative);
        motion.differentiable = true;
        motion.stable = motion.multipliers.empty() || std::abs(motion.multipliers.front()) <= largest_stable;
        if (stands_) {
            motion.status = SteadyStatus::rest;
            motion.start = {moment.y[0], 0};
            motion.low = motion.high = moment.y[0];
            motion.rest = {moment.y[0], moment.y[0]};
            motion.asked = begun_at(here.question, here.runs.from(moment), start(here));
            return motion;
        }
        motion.periods = periods_;
        motion.period = period_ = lap.time;
        note_family(motion);
        constexpr double rows = 64;  // they tell how far it goes, and turns are looked for between them
        const Runs::Run run = here.runs.run(moment, start(here), start(here) + motion.period,
                                            motion::Grid::every(motion.period / rows), true);
        if (run.contradiction) motion.contradiction = run.contradiction;
        if (!model::is_whole(run.outcome)) {
            motion.status = SteadyStatus::none;
            return motion;
        }
        motion.outcome = run.outcome;
        const motion::engine::Drive drive = here.runs.from(moment);
        motion.asked = begun_at(here.question, drive, start(here));
        motion.settled = std::make_shared<const Trajectory>(
            motion::engine::part_with_rows(here.runs.system(), drive, run, 0, here.question.system));
        tell_of_run(here.question, *motion.settled, motion);
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
            const double belt = here_->question.extras.belt.value(start(*here_));
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
        const double at = (section_.place - motion.low) / (motion.high - motion.low);
        if (!cycles_ || (at > 0.3 && at < 0.54)) return {};
        Returns::Section next = section_of(motion);
        next.way = section_.way;
        std::vector<Eigen::VectorXd> moved;
        for (const auto& [x, p] : places) {
            Here& here = this->at(p);
            const Returns::Return arrival = returns(here, next).arrival(returns(here, section_).moment(x, {}));
            if (!arrival.finished) return {};
            moved.push_back(arrival.to);
        }
        section_ = next;
        return moved;
    }

private:
    struct Here {
        double p;
        SteadyQuestion question;
        RigQuestion assembly;
        Runs runs;
        Here(double value, SteadyQuestion asked, const motion::Monitor& monitor)
            : p(value), question(std::move(asked)), assembly(as_assembly(question)), runs(assembly, monitor) {}
        [[nodiscard]] static Moment begun_by(const SteadyQuestion& asked) {
            VectorXd y(2 + static_cast<Eigen::Index>(asked.extras.states.size()));
            y.head(2) << asked.initial.theta, asked.initial.velocity;
            for (Eigen::Index i = 2; i < y.size(); ++i)
                y[i] = asked.extras.states[static_cast<std::size_t>(i) - 2].start;
            return {y};
        }
    };

    [[nodiscard]] static Returns::Section section_of(const SteadyMotion& motion) {
        return {.place = motion.low + section_at * (motion.high - motion.low)};
    }
    /// The question at this parameter.
    Here& at(double p) {
        if (!here_ || here_->p != p) {
            SteadyQuestion question = family_(p);
            question.excitation = with_relays(question.excitation, relays_);
            here_ = std::make_unique<Here>(p, std::move(question), monitor_);
        }
        return *here_;
    }
    [[nodiscard]] double start(const Here& here) const { return here.question.drive.start + offset_; }
    [[nodiscard]] Returns returns(Here& here, const Returns::Section& section) const {
        const double natural = here.runs.natural_period();
        const double length = cycles_       ? 3 * period_
                              : !timeless_  ? periods_ * here.question.drive.period
                              : natural > 0 ? natural / 4
                                            : 1;
        return {here.runs,
                ground_,
                start(here),
                length,
                cycles_ ? std::optional(section) : std::nullopt,
                VectorXd::Ones(there_.size()),
                there_};
    }

    const Family& family_;
    const motion::Monitor& monitor_;
    int periods_, passages_ = 1;
    bool timeless_ = false;
    double offset_ = 0, period_ = 0;
    Chart ground_{{-1}};
    Returns::Section section_;
    std::vector<bool> relays_;
    VectorXd there_;
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
    const VectorXd x = still.first();
    const Circuit::Lap lap = still.lap(x, p);
    const VectorXd units = still.units(x, lap, rest);
    const Eigen::Index n = x.size();
    Eigen::MatrixXd D(n, n);  // of the scaled places
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
    constexpr double small = 1e-3;  // of the units: the cycle differs from the linearised motion by its square
    const Eigen::VectorXcd mode = small * vectors.col(best).normalized().cwiseProduct(units);
    const VectorXd begin = x + mode.real();
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

}  // namespace dinal::analysis
