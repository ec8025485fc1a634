#include "analysis/steady_facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/repetition.hpp"
#include "analysis/returns.hpp"
#include "model/controller.hpp"
#include "model/lowered.hpp"
#include "motion/simulate.hpp"
#include "motion/spectral/spectral.hpp"
#include "motion/stillness.hpp"

namespace dinal::analysis {
namespace {

using model::Motion;

/// Returns whether friction is the same in both directions.
bool acts_evenly(const model::Friction& law) {
    const auto is_even = [&law](double speed) {
        return law.sliding(Motion::forward, speed) == law.sliding(Motion::backward, speed);
    };
    return is_even(0) && law.holding(Motion::forward) == law.holding(Motion::backward) &&
           (!law.depends_on_speed() || (is_even(1e-3) && is_even(0.1) && is_even(1) && is_even(10)));
}

/// The error of multipliers after a stop: a disturbance is only multiplied by factors such as cosines, nearly without
/// error.
constexpr double kept_within = 1e-12;

std::vector<std::complex<double>> eigenvalues(const Eigen::Matrix2d& D) {
    const double mean = (D(0, 0) + D(1, 1)) / 2, half = (D(0, 0) - D(1, 1)) / 2;
    const double square = half * half + D(0, 1) * D(1, 0);
    if (square < 0) {
        const double turn = std::sqrt(-square);
        return {std::complex(mean, turn), std::complex(mean, -turn)};
    }
    // The greater eigenvalue comes first, so that the other is a quotient instead of a difference of near numbers.
    const double first = mean + std::copysign(std::sqrt(square), mean);
    const double determinant = D(0, 0) * D(1, 1) - D(0, 1) * D(1, 0);
    return {std::complex(first), std::complex(first == 0 ? 0 : determinant / first)};
}

/// Returns whether the torque against the motion never falls as the motion grows.
bool is_monotone(const model::Friction& law, const model::Spring& spring, const std::optional<model::Walls>& walls) {
    const auto even = [&law](Motion way) { return law.holding(way) == law.sliding(way, 0); };
    return spring.none() && !walls && !law.depends_on_speed() && even(Motion::forward) && even(Motion::backward);
}

/// The farthest angle in this direction at which friction holds against the springs throughout the period.
double edge_of_rest(const model::Lowered& system, double here, double way, const TorqueRange& M) {
    const double least = M.high - system.holding(Motion::forward), most = M.low + system.holding(Motion::backward);
    const auto holds = [&](double d) {
        const double torque = system.pull_back(here + way * d);
        return torque >= least && torque <= most;
    };
    double inside = 0, outside = 1e-9 * std::max(std::fabs(here), 1e-9);
    for (int i = 0; holds(outside); ++i) {
        constexpr int farthest = 200;
        if (i == farthest) return here;  // no spring limits the angle
        inside = outside, outside *= 2;
    }
    while (outside - inside > 1e-15 * (std::fabs(here) + outside)) {
        const double middle = inside + (outside - inside) / 2;
        if (!(middle > inside && middle < outside)) break;
        (holds(middle) ? inside : outside) = middle;
    }
    return here + way * inside;
}

std::pair<double, double> rest_without_walls(const SteadyQuestion& question, double here) {
    const model::Lowered system(question.body);
    const double k = system.stiffness();
    const bool own_spring = !question.body.spring().none();
    if (question.load().has_feedback() || (!(k > 0) && !own_spring)) return {here, here};
    const model::Excitation& base = question.drive.base;
    const model::Excitation loads =
        base.components().empty() ? question.load() : question.load() + base.scaled(-question.body.inertia());
    const double now = loads.value(question.repeats.start);
    const TorqueRange M = question.is_timeless() ? TorqueRange{now, now} : extremes(loads, question.repeats);
    if (own_spring) return {edge_of_rest(system, here, -1, M), edge_of_rest(system, here, 1, M)};
    const double low = (M.high - system.holding(Motion::forward)) / k;
    const double high = (M.low + system.holding(Motion::backward)) / k;
    return low <= high ? std::pair(low, high) : std::pair(here, here);
}

}  // namespace

bool contracts(const SteadyQuestion& question) {
    if (question.is_plain()) {
        const model::Oscillator& body = question.body;
        const auto acts = [](const model::WantedEvent& event) { return event.act != nullptr; };
        return is_monotone(body.friction(), body.spring(), body.walls()) && !question.drive.M().has_feedback() &&
               std::ranges::none_of(question.drive.events, acts);
    }
    const model::Drive& drive = question.drive;
    const auto asks = [](const model::Excitation& of) { return of.has_feedback() || model::has_memory(of); };
    const auto& joints = question.system->joints;
    return drive.states.empty() && drive.events.empty() && !asks(drive.base) &&
           std::ranges::none_of(drive.loads, asks) && std::ranges::none_of(drive.belts, asks) &&
           std::ranges::all_of(joints, [](const model::Joint& joint) {
               return joint.is_plain() && is_monotone(joint.friction.law, joint.spring, joint.walls);
           });
}

double distance_from_one(const std::vector<std::complex<double>>& multipliers) {
    double least = model::never;
    // a multiplier within this distance of the unit circle means that a disturbance persists
    constexpr double far = 1e-3;
    constexpr int most = 32;
    for (const std::complex<double>& multiplier : multipliers) {
        const bool stays = std::fabs(std::abs(multiplier) - 1) <= far;
        std::complex<double> power = 1;
        for (int n = 1; n <= (stays ? most : 1); ++n) least = std::min(least, std::abs((power *= multiplier) - 1.0));
    }
    return least;
}

bool is_symmetric_problem(const SteadyQuestion& question) {
    const model::Drive& drive = question.drive;
    if (question.is_timeless() || !drive.states.empty() || !drive.events.empty()) return false;
    const bool by_numbers = question.is_plain();  // only then can feedback be evaluated at the opposite state
    const auto turns = [&](const model::Excitation& what) {
        if (what.components().empty()) return true;
        return !model::has_memory(what) && (by_numbers || !what.has_feedback()) &&
               is_antisymmetric(what, question.repeats);
    };
    const auto& joints = question.system->joints;
    return turns(drive.base) && std::ranges::all_of(drive.belts, turns) &&
           std::ranges::all_of(joints,
                               [](const model::Joint& joint) {
                                   return joint.is_plain() && acts_evenly(joint.friction.law) &&
                                          joint.spring.is_odd() && (!joint.walls || joint.walls->alike());
                               }) &&
           std::ranges::all_of(drive.loads, turns);
}

std::complex<double> start_around(int i, double farthest, std::size_t body) {
    const double turn = (0.3 + i) * std::numbers::pi / 2 + 2.4 * static_cast<double>(body);
    return std::polar(farthest * std::exp2(-0.5 * i), turn);
}

void judge(const SteadyQuestion& question, std::vector<std::complex<double>> multipliers, const Judged& by,
           SteadyMotion& motion) {
    motion.multipliers = std::move(multipliers);
    motion.differentiable = true;
    double largest = 0;
    for (const std::complex<double>& multiplier : motion.multipliers) largest = std::max(largest, std::abs(multiplier));
    motion.stable = largest <= largest_stable;
    const double misses = distance_from_one(motion.multipliers);
    if (by.alone && contracts(question)) {
        motion.unique = misses > by.error;
    } else if (misses < neutral_within) {
        motion.unique = false;
    }
}

SteadyMotion facts_of(const SteadyQuestion& question, const PeriodMap& map, const MapStep& step, const Place& from,
                      int periods) {
    SteadyMotion motion;
    motion.status = step.moved ? SteadyStatus::steady : SteadyStatus::adheres;
    motion.outcome = step.outcome;
    motion.periods = periods;
    motion.period = map.is_half() ? 2 * map.length() : map.length();
    motion.start = map.state(from);
    motion.low = step.low;
    motion.high = step.high;
    motion.t_high = step.t_high;
    if (map.is_half()) {
        motion.low = std::min(step.low, -step.high);
        motion.high = -motion.low;
        if (-step.low > step.high) motion.t_high = step.t_low + map.length();
    }
    motion.amplitude = (motion.high - motion.low) / 2 + 0.0;  // + 0.0 turns -0 into 0
    motion.stops = map.is_half() ? 2 * step.stops : step.stops;
    motion.stuck = step.moved ? std::min(1.0, step.stuck / map.length()) : 1;
    motion.symmetric = map.is_half();
    if (!step.moved || step.has_corner) motion.stable = true;
    if (!step.differentiable) return motion;
    std::vector<std::complex<double>> multipliers = eigenvalues(step.derivative);
    if (map.is_half()) {
        for (std::complex<double>& value : multipliers) value *= value;
    }
    const Judged by{.alone = step.moved && !step.on_edge, .error = step.stuck > 0 ? kept_within : neutral_within};
    judge(question, std::move(multipliers), by, motion);
    if (!step.moved) motion.stable = true, motion.unique.reset();
    return motion;
}

std::pair<double, double> rest_of(const SteadyQuestion& question, double here) {
    const auto [low, high] = rest_without_walls(question, here);
    const auto& walls = question.body.walls();
    if (!walls) return {low, high};
    // A wall holds against a pull towards it.
    return {std::clamp(low, walls->lower, walls->upper), std::clamp(high, walls->lower, walls->upper)};
}

SteadyQuestion for_returns(const SteadyQuestion& question) {
    SteadyQuestion asked = question;
    if (!question.is_plain()) return asked;
    const model::Oscillator& body = question.body;
    if (body.has_spring()) asked.longest = motion::spectral::longest_panel * body.natural_period();
    asked.settles = settles_after(asked).value_or(question.repeats.period);
    return asked;
}

std::shared_ptr<const SteadyQuestion> begun_at(const SteadyQuestion& question, const model::Drive& drive,
                                               double start) {
    auto asked = std::make_shared<SteadyQuestion>(question);
    asked->drive = drive;
    asked->repeats.start = start;
    return asked;
}

void fill_from_run(const SteadyQuestion& question, const motion::Run& run, SteadyMotion& motion) {
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
    motion.stuck = moves || time_open(run) > 0 ? std::min(1.0, stuck / length) : 1;
    if (!moves) motion.rest = rest_of(question, motion.start.theta);
}

SteadyMotion seen_from(const SteadyQuestion& question, const SteadyMotion& whole,
                       std::shared_ptr<const motion::Run> run) {
    const model::System& system = *question.system;
    const std::size_t joint = question.joint.value_or(0);
    const model::Joint& seen = system.joints[joint];
    const bool alone = system.is_alone();
    const auto of = [&](auto number) {
        double sum = 0;
        for (const auto& [body, by] : seen.of) sum += by * number(whole.bodies[body]);
        return sum;
    };
    SteadyMotion facts = whole;
    if (run) {
        fill_from_run(question, *run, facts);
        double size = 0;
        for (const BodyMotion& body : whole.bodies) size = std::max(size, body.high - body.low);
        // The difference of two angles held together is only rounding.
        if (system.is_link(joint) && facts.high - facts.low <= 1e-13 * size) {
            facts.status = SteadyStatus::adheres;
            facts.amplitude = 0;
            if (time_open(*run) == 0) facts.stuck = 1;
        }
        if (!alone) facts.rest = {facts.low, facts.low};
        if (whole.by_returns.drive)
            facts.by_returns.question = begun_at(question, *whole.by_returns.drive, run->t_start);
        facts.by_returns.run = std::move(run);
    } else if (whole.is_found()) {
        facts.amplitude = 0;
        facts.low = facts.high = of([](const BodyMotion& body) { return body.begin; });
        facts.start = {facts.low, of([](const BodyMotion& body) { return body.turned; })};
        facts.rest = alone && facts.start.velocity == 0 && facts.stuck == 1 ? rest_of(question, facts.low)
                                                                            : std::pair(facts.low, facts.low);
        if (alone) facts.unique = facts.rest.first < facts.rest.second ? std::optional(false) : std::nullopt;
        if (whole.by_returns.drive)
            facts.by_returns.question = begun_at(question, *whole.by_returns.drive, question.repeats.start);
    }
    // The angle of a rotating body is not periodic.
    const double turned = facts.is_found() ? of([](const BodyMotion& body) { return body.turned; }) : 0;
    if (facts.is_found() && std::fabs(turned) > 1e-6 * std::fabs(whole.bodies[seen.first()].turned)) {
        facts.amplitude = facts.low = facts.high = facts.start.theta = std::numeric_limits<double>::quiet_NaN();
    }
    return facts;
}

SteadyMotion seen_from(const SteadyQuestion& question, const SteadyMotion& motion) {
    std::shared_ptr<const motion::Run> run;
    if (const auto& period = motion.by_returns.of_bodies) {
        run = std::make_shared<const motion::Run>(
            motion::part_of(*question.system, period->drive, period->run, question.joint.value_or(0)));
    }
    return seen_from(question, motion, std::move(run));
}

}  // namespace dinal::analysis
