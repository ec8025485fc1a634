// Steady motions of one body that a map of theta and velocity over a period of M does not tell: of runs with states,
// events, a belt or a base, of an M with a memory, and limit cycles, whose period nothing prescribes. docs/theory.md,
// section 10.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "algebra/decompositions.hpp"
#include "analysis/branch.hpp"
#include "analysis/returns.hpp"
#include "analysis/rig_steady.hpp"
#include "analysis/steady_facts.hpp"
#include "model/controller.hpp"
#include "motion/engine/one_body.hpp"
#include "motion/stillness.hpp"

namespace dinal::analysis {
namespace {

namespace engine = motion::engine;
using Eigen::VectorXd;
using motion::Trajectory;

const Chart& ground() {
    static const Chart chart({-1});
    return chart;
}

/// Of each relay: it is switched on, as M says or as it is remembered.
std::vector<bool> relays_of(const model::Excitation& excitation, const std::optional<HeldMode>& mode = {}) {
    std::vector<bool> on;
    const auto components = excitation.components();
    for (std::size_t i = 0; i < components.size(); ++i) {
        const auto* relay = model::controller_of<model::RelayController>(components[i]);
        if (relay != nullptr) on.push_back(mode ? mode->controllers.front()[i].on : relay->starts_on);
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

/// The question whose run begins at this moment.
SteadyQuestion begun_at(const SteadyQuestion& question, const Moment& moment, double start) {
    SteadyQuestion asked = question;
    if (moment.mode) asked.excitation = with_relays(question.excitation, relays_of(question.excitation, moment.mode));
    asked.drive.start = start;
    asked.initial = {moment.y[0], moment.y[1]};
    // A mass that is held has the velocity of what holds it to the last bit, else it would slip first.
    if (moment.mode && moment.mode->mode.holds(0)) {
        const int leans = moment.mode->mode.leans.front();
        const auto& walls = question.system.walls();
        if (leans != 0) asked.initial.theta = leans > 0 ? walls->upper : walls->lower;
        asked.initial.velocity = leans != 0 ? 0 : motion::belt_from(question.extras.belt, start);
    }
    for (std::size_t i = 0; i < asked.extras.states.size(); ++i) {
        asked.extras.states[i].start = moment.y[2 + static_cast<Eigen::Index>(i)];
    }
    return asked;
}

/// The facts that a run of the motion's period from this moment tells; false when it fails.
bool tell_period(const SteadyQuestion& question, const Moment& moment, double start, SteadyMotion& motion,
                 const motion::Monitor& monitor, double rows) {
    SteadyQuestion asked = begun_at(question, moment, start);
    auto run = motion::simulate(asked.system, asked.excitation, asked.initial, {start, start + motion.period},
                                motion::Grid::every(motion.period / rows),
                                motion::integrator_for(asked.system, asked.excitation, asked.extras), monitor, {},
                                asked.extras);
    if (run && run->contradiction) motion.contradiction = run->contradiction;
    if (!run || !model::is_whole(run->outcome)) return false;
    motion.outcome = run->outcome;
    motion.asked = std::make_shared<const SteadyQuestion>(std::move(asked));
    tell_of_run(question, *run, motion);
    motion.settled = std::make_shared<const Trajectory>(std::move(run).value());
    return true;
}

/// One period more of a run that has settled.
bool tell_next_period(const SteadyQuestion& question, const Runs::Run& so_far, SteadyMotion& motion,
                      const motion::Monitor& monitor) {
    constexpr double rows = 400;
    Trajectory end;
    end.t_stop = so_far.t_stop;
    end.state_at_stop = {so_far.carry->y[0], so_far.carry->y[1]};
    end.motion_at_stop = so_far.motion_at_stop;
    end.carried = engine::carried_by(so_far.carry);
    auto run = motion::go_on(question.system, question.excitation, end, end.t_stop + motion.period,
                             motion::Grid::every(motion.period / rows),
                             motion::integrator_for(question.system, question.excitation, question.extras), monitor, {},
                             question.extras);
    if (!run || !model::is_whole(run->outcome)) return false;
    motion.outcome = run->outcome;
    tell_of_run(question, *run, motion);
    motion.stable = true;  // a run came to it
    motion.settled = std::make_shared<const Trajectory>(std::move(run).value());
    return true;
}

class OneBodySearch final : public ReturnSearch {
public:
    OneBodySearch(const SteadyQuestion& question, const RigQuestion& assembly, const motion::Monitor& monitor)
        : ReturnSearch(assembly, ground(), monitor), one_(question), monitor_(monitor) {}

    SteadyMotion found() {
        search();
        return std::move(facts_);
    }

private:
    std::optional<VectorXd> tells(const Moment& moment, double start) override {
        constexpr double rows = 400;
        return tell_period(one_, moment, start, facts_, monitor_, rows) ? middle() : std::nullopt;
    }

    [[nodiscard]] std::optional<VectorXd> middle() const {
        const auto state = facts_.settled->at(facts_.settled->t_start + facts_.period / 2);
        if (!state) return {};
        return Eigen::Vector2d(state->theta, state->velocity);
    }

    std::optional<VectorXd> tell_settled(const Runs::Run& so_far) override {
        return tell_next_period(one_, so_far, facts_, monitor_) ? middle() : std::nullopt;
    }

    void tell_rest(const Runs::Run& run, bool /*stands*/) override {
        const Moment now = Runs::at_stop(run);
        const double theta = now.y[0], velocity = now.y[1];
        const bool stuck = run.motion_at_stop == model::Motion::stuck, rides = stuck && velocity != 0;
        if (rides) facts_.status = SteadyStatus::adheres;  // to the belt, which takes it along
        facts_.start = {theta, rides ? velocity : 0};
        facts_.low = facts_.high = theta;
        facts_.stuck = stuck ? 1 : 0;
        facts_.rest = stuck && !rides ? rest_of(one_, theta) : std::pair(theta, theta);
        if (facts_.rest.first < facts_.rest.second) facts_.unique = false;
        if (question().settles >= 0) return;
        facts_.asked = std::make_shared<const SteadyQuestion>(begun_at(one_, now, one_.drive.start));
    }

    const SteadyQuestion& one_;
    const motion::Monitor& monitor_;
};

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
            motion.asked = std::make_shared<const SteadyQuestion>(begun_at(here.question, moment, start(here)));
            return motion;
        }
        motion.periods = periods_;
        motion.period = period_ = lap.time;
        note_family(motion);
        constexpr double rows = 64;  // they tell how far it goes, and turns are looked for between them
        if (!tell_period(here.question, moment, start(here), motion, monitor_, rows)) {
            motion.status = SteadyStatus::none;
        }
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
                ground(),
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
    Returns::Section section_;
    std::vector<bool> relays_;
    VectorXd there_;
    std::unique_ptr<Here> here_;
};

}  // namespace

RigQuestion as_assembly(const SteadyQuestion& question) {
    const model::Oscillator& system = question.system;
    RigQuestion asked{.system = std::make_shared<const model::Assembly>(engine::assembly_of(system)),
                      .drive = engine::drive_of(question.excitation, question.extras, question.initial),
                      .repeats = question.drive,
                      .periods = question.periods};
    if (system.has_spring()) asked.longest = motion::spectral::longest_panel * system.natural_period();
    return asked;
}

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

namespace {

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

}  // namespace

SteadyMotion returning_motion(const SteadyQuestion& question, const motion::Monitor& monitor) {
    RigQuestion assembly = as_assembly(question);
    const bool delays = model::has_memory<model::DelayedController>(question.excitation);
    const bool sampled = model::has_memory<model::SampledController>(question.excitation);
    // A relay in a motion that returns through a section is a part of the section's state.
    if (delays || sampled || (!question.is_timeless() && model::has_memory(question.excitation))) {
        assembly.settles = question.is_timeless() ? sampling_period(question.excitation) : question.drive.period;
    }
    return OneBodySearch(question, assembly, monitor).found();
}

bool goes_on(const SteadyQuestion& question, const SteadyMotion& motion, const motion::Monitor& monitor) {
    if (motion.status != SteadyStatus::steady && motion.status != SteadyStatus::adheres) return false;
    constexpr double periods = 4;
    const PeriodMap map(question.system, question.excitation, question.drive.start, periods * motion.period, monitor);
    const Place start = place_of(motion.start, map.omega());
    const MapStep step = map(start);
    const double size = std::max({std::fabs(motion.low), std::fabs(motion.high), length_of(start)});
    constexpr double alike = 1e-8;
    return step.finished && length_of(step.to - start) <= alike * size &&
           std::fabs(step.high - motion.high) + std::fabs(step.low - motion.low) <= alike * size;
}

}  // namespace dinal::analysis
