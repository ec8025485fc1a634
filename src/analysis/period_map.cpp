#include "analysis/period_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "theory/theory_modes.hpp"

namespace dinal::analysis {

namespace {

double omega_of(const model::Oscillator& system, double length) {
    return system.stiffness() > 0 ? system.natural_frequency() : 2 * std::numbers::pi / length;
}

}  // namespace

PeriodMap::PeriodMap(const model::Oscillator& system, const model::Excitation& excitation, double start, double length,
                     const motion::Monitor& monitor)
    : system_(system),
      lowered_(system),
      drive_(excitation),
      integrator_(motion::integrator_for(system, excitation)),
      start_(start),
      length_(length),
      omega_(omega_of(system, length)),
      monitor_(monitor) {}

PeriodMap::PeriodMap(const PeriodMap& other, double length) : PeriodMap(other) {
    length_ = length;
    omega_ = omega_of(system_, length);
}

double PeriodMap::rounding() const {
    constexpr double few = 4 * std::numeric_limits<double>::epsilon();
    return system_.has_linear_spring() ? few * lowered_.greatest_holding() / lowered_.stiffness() : 0;
}

motion::Run PeriodMap::run(const Place& from, double length, bool dense) const {
    motion::Limits limits;
    limits.dense = dense;  // a stored series is faster to evaluate than a closed form
    drive_.start_at(state(from));
    auto result = motion::simulate(system_, drive_, {start_, start_ + length}, motion::Grid::none(),
                                   dense ? motion::Integrator(motion::Spectral{}) : integrator_, monitor_, limits);
    if (result && result->contradiction) contradiction_ = result->contradiction;
    if (result) return std::move(result).value();
    motion::Run none;
    none.outcome = model::Outcome::state_not_finite;
    return none;
}

MapStep PeriodMap::operator()(const Place& from) const {
    MapStep step;
    constexpr double most = 1e100;  // powers of larger motions would overflow
    const bool powers = lowered_.has_remainder() || drive_.M().has_feedback();
    const bool finite = from.allFinite() && !(powers && length_of(from) >= most);
    const motion::Run run = finite ? this->run(from, length_, false) : motion::Run{};
    // A nonlinear spring may overflow in a diverging motion. (An overflow of M has been reported by its function.)
    const bool flew_away =
        run.outcome == model::Outcome::excitation_not_finite && lowered_.has_remainder() && !drive_.M().has_feedback();
    step.outcome = finite && !flew_away ? run.outcome : model::Outcome::state_not_finite;
    step.finished = model::is_whole(step.outcome);
    if (!step.finished) {
        step.to = from;
        step.differentiable = false;
        return step;
    }
    const std::vector<Stretch> parts = stretches(run);
    step = step_of_run(run, parts);
    differentiate(parts, step);
    return step;
}

MapStep PeriodMap::step_of_run(const motion::Run& run, const std::vector<Stretch>& parts) const {
    MapStep step;
    step.outcome = run.outcome;
    const double begins = run.t_start, ends = run.t_stop, first = run.initial.theta;
    const model::State end = run.motion_at_stop == model::Motion::stuck && !run.events.empty()
                                 ? model::State{run.events.back().theta, 0}
                                 : run.state_at_stop;
    step.to = {end.theta, end.velocity / omega_};
    step.moved = !(run.began_stuck && run.events.empty());
    step.low = std::min(first, step.to[0]);
    step.high = std::max(first, step.to[0]);
    step.t_low = first <= step.to[0] ? begins : ends;
    step.t_high = first >= step.to[0] ? begins : ends;
    for (const model::Event& event : run.events) {
        if (event.kind == model::EventKind::slip) continue;  // it stood there before
        if (event.theta < step.low) {
            step.low = event.theta;
            step.t_low = event.t;
        }
        if (event.theta > step.high) {
            step.high = event.theta;
            step.t_high = event.t;
        }
    }
    // A mass that stands at the beginning came to a stop before, as it does at the end; also if M jumps just then and
    // releases it.
    const bool stands_on = run.motion_at_stop == model::Motion::stuck && !run.events.empty();
    if (stands_on) {
        const double since = run.events.back().t;
        for (double* t : {&step.t_low, &step.t_high}) {
            if (*t == begins) *t = since - (ends - begins);
            if (*t == ends) *t = since;
        }
    }
    for (const Stretch& s : parts) {
        if (!s.stuck) continue;
        step.stops += s.begun_by ? 1U : 0U;
        step.stuck += s.lasts();
    }
    return step;
}

/// exp(A L) of theta' = omega y, y' = -(k theta + C omega y)/(I omega).
Eigen::Matrix2d PeriodMap::free_motion(double length) const {
    Eigen::Matrix2d matrix;
    if (system_.stiffness() > 0) {
        const auto [released, pushed, velocity] = theory::Modes(system_.damping_ratio()).after(omega_ * length);
        matrix << released, pushed, -pushed, velocity;
        return matrix;
    }
    const double rate = system_.damping() / system_.inertia();
    const double way = rate > 0 ? -std::expm1(-rate * length) / rate : length;
    matrix << 1, omega_ * way, 0, std::exp(-rate * length);
    return matrix;
}

/// M' as the limit from the left, where the breakaway comes from.
double PeriodMap::slope_before(double t) const {
    const double h = 1e-5 * std::min(length_, 2 * std::numbers::pi / omega_);
    const double now = drive_.M().value_before(t), one = drive_.M().value(t - h), two = drive_.M().value(t - 2 * h);
    return (3 * now - 4 * one + two) / (2 * h);
}

void PeriodMap::differentiate(const std::vector<Stretch>& parts, MapStep& step) const {
    const model::Lowered& system = lowered_;
    Eigen::Matrix2d total = Eigen::Matrix2d::Identity();
    step.differentiable = !system.has_remainder() && !drive_.M().has_feedback();
    for (const Stretch& s : parts) {
        if (!step.differentiable) break;
        if (s.stuck) {
            total.row(1).setZero();
        } else {
            total = free_motion(s.lasts()) * total;
        }
        if (!s.ended_by) continue;
        const model::Event& event = *s.ended_by;
        const double pull = std::fma(-system.stiffness(), event.theta, event.M);
        switch (event.kind) {
            case model::EventKind::stick:
            case model::EventKind::rest: {
                const double held = system.holding(pull > 0 ? model::Motion::forward : model::Motion::backward);
                constexpr double within = 1e-9;
                step.on_edge = step.on_edge || held - std::fabs(pull) <= within * (held + std::fabs(event.M));
                break;
            }
            case model::EventKind::turn: {
                if (!system.dry()) break;
                const model::Motion way =
                    s.end.theta > s.begin.theta ? model::Motion::forward : model::Motion::backward;
                const model::Motion back =
                    way == model::Motion::forward ? model::Motion::backward : model::Motion::forward;
                const double before =
                    std::fma(-system.stiffness(), event.theta, drive_.M().value_before(event.t)) - system.braking(way);
                const double after = pull - system.braking(back);
                step.differentiable = before != 0;
                total.row(1) *= after / before;
                break;
            }
            case model::EventKind::slip: {
                const model::Motion way = pull < 0 ? model::Motion::backward : model::Motion::forward;
                const double after = pull - system.braking(way);
                const double jump = event.M - drive_.M().value_before(event.t);
                const double least = 1e-9 * system.greatest_holding();
                const double slope = std::fabs(after) <= least || std::fabs(jump) > least ? 0 : slope_before(event.t);
                const double turned =
                    slope == 0 ? 0 : -system.stiffness() * after / (system.inertia() * omega_ * slope);
                total.row(1) = turned * total.row(0);
                break;
            }
            default:
                step.differentiable = false;  // other kinds have no jump matrix here
        }
    }
    step.derivative = total;
    step.differentiable = step.differentiable && total.allFinite();
}

MapStep PeriodMap::with_derivative(const Place& from, double scale) const {
    MapStep step = (*this)(from);
    if (step.differentiable || !step.finished) return step;
    const double h = 1e-6 * std::max(scale, 1e-300);
    step.differentiable = true;
    for (int i = 0; i < 2; ++i) {
        const Place up = inside(system_, from + h * Place::Unit(i)), down = inside(system_, from - h * Place::Unit(i));
        const MapStep ahead = (*this)(up), behind = (*this)(down);
        step.differentiable = step.differentiable && ahead.finished && behind.finished;
        step.derivative.col(i) = (ahead.to - behind.to) / (up - down)[i];
    }
    return step;
}

}  // namespace dinal::analysis
