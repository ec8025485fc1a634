#include "analysis/period_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "theory/theory_free.hpp"

namespace dinal::analysis {

namespace {

double omega_of(const model::Oscillator& system, double period) {
    return system.stiffness() > 0 ? system.natural_frequency() : 2 * std::numbers::pi / period;
}

}  // namespace

bool PeriodMap::applies_to(const SteadyQuestion& question) {
    const model::Excitation& M = question.drive.M();
    return question.is_plain() && !question.is_timeless() && !question.drive.has_more() && !model::has_memory(M) &&
           !M.has_feedback() && !model::Lowered(question.body).has_remainder();
}

PeriodMap::PeriodMap(const SteadyQuestion& question, double length, double sign, const motion::Monitor& monitor)
    : system_(question.body),
      lowered_(system_),
      drive_(question.drive.M()),
      integrator_(motion::integrator_for(system_, drive_)),
      start_(question.repeats.start),
      length_(length),
      sign_(sign),
      omega_(omega_of(system_, question.repeats.period)),
      monitor_(monitor) {}

PeriodMap::PeriodMap(const SteadyQuestion& question, double periods, const motion::Monitor& monitor)
    : PeriodMap(question, periods * question.repeats.period, 1, monitor) {}

PeriodMap PeriodMap::half(const SteadyQuestion& question, const motion::Monitor& monitor) {
    return {question, question.repeats.period / 2, -1, monitor};
}

double PeriodMap::rounding_of_place() const {
    constexpr double few = 4 * std::numeric_limits<double>::epsilon();
    return system_.has_linear_spring() ? few * lowered_.greatest_holding() / lowered_.stiffness() : 0;
}

double PeriodMap::size_of(const Place& from, const MapStep& step) {
    return std::max({length_of(from), length_of(step.to), step.high - step.low, 1e-300});
}

Map::Return PeriodMap::measured(const Place& from) {
    const MapStep first = step(from);
    unit_ = size_of(from, first);
    return {.to = from / unit_, .finished = first.finished, .outcome = first.outcome};
}

Map::Return PeriodMap::operator()(const Eigen::VectorXd& from, const std::optional<HeldMode>& /*mode*/, int returns) {
    Return sum{.to = from, .finished = true};
    for (int i = 0; i < returns && sum.finished; ++i) {
        const MapStep next = step(place(sum.to));
        sum.to = sign_ * next.to / unit_;
        sum.time += length_;
        sum.finished = next.finished && sum.to.allFinite();
        sum.outcome = next.outcome;
        if (!next.differentiable || (i > 0 && !sum.derivative)) {
            sum.derivative.reset();
            continue;
        }
        const Eigen::Matrix2d own = sign_ * next.derivative;
        sum.derivative = i == 0 ? own : Eigen::Matrix2d(own * *sum.derivative);
    }
    return sum;
}

std::optional<Map::Derivative> PeriodMap::derivative(const Eigen::VectorXd& at, const std::optional<HeldMode>& mode,
                                                     int returns, int /*order*/) {
    constexpr double h = 1e-6;
    Derivative found{Eigen::MatrixXd(2, 2)};
    const Place here = place(at);
    for (int i = 0; i < 2; ++i) {
        const Place aside = h * unit_ * Place::Unit(i);
        const Place up = inside(system_, here + aside), down = inside(system_, here - aside);
        const Return ahead = (*this)(up / unit_, mode, returns), behind = (*this)(down / unit_, mode, returns);
        if (!ahead.finished || !behind.finished) return {};
        found.by_place.col(i) = (ahead.to - behind.to) * (unit_ / (up - down)[i]);
    }
    return found;
}

MapStep PeriodMap::step(const Place& from) const {
    if (!last_ || last_->first != from) last_ = {from, computed(from)};
    return last_->second;
}

MapStep PeriodMap::computed(const Place& from) const {
    MapStep step;
    step.outcome = model::Outcome::state_not_finite;
    if (from.allFinite()) {
        drive_.start_at(state(from));
        const auto run =
            motion::simulate(system_, drive_, {start_, start_ + length_}, motion::Grid::none(), integrator_, monitor_);
        if (run && run->contradiction) contradiction_ = run->contradiction;
        if (run) step.outcome = run->outcome;
        if (model::is_whole(step.outcome)) {
            const std::vector<Stretch> parts = stretches(*run);
            step = step_of_run(*run, parts);
            differentiate(parts, step);
            return step;
        }
    }
    step.to = from;
    step.finished = step.differentiable = false;
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
        if (event.kind == model::EventKind::slip) continue;  // the mass stood there before
        if (event.theta < step.low) {
            step.low = event.theta;
            step.t_low = event.t;
        }
        if (event.theta > step.high) {
            step.high = event.theta;
            step.t_high = event.t;
        }
    }
    // A mass that rests at the start has stopped earlier, as it does at the end of the period, even if a jump of M
    // releases it at once.
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

/// M at a time that may be outside of the run: a user's function need not have values there, so M is continued by its
/// period.
double PeriodMap::M_around(double t) const {
    const double later = t < start_ ? length_ : t > start_ + length_ ? -length_ : 0;
    return (later == 0 ? 1 : sign_) * drive_.M().value(t + later);
}

/// The limit from the left of M', which determines a breakaway at t.
double PeriodMap::slope_before(double t) const {
    const double h = 1e-5 * std::min(length_, 2 * std::numbers::pi / omega_);
    const double now = drive_.M().value_before(t), one = M_around(t - h), two = M_around(t - 2 * h);
    return (3 * now - 4 * one + two) / (2 * h);
}

/// Returns whether M jumps within reach of differences around t; `pull` is the size of torques there.
bool PeriodMap::jumps_at(double t, double pull) const {
    const double reach = 1e-9 * length_, clearly = 1e-6 * (std::fabs(pull) + system_.breakaway());
    return std::fabs(M_around(t + reach) - M_around(t - reach)) > clearly;
}

void PeriodMap::differentiate(const std::vector<Stretch>& parts, MapStep& step) const {
    const model::Lowered& system = lowered_;
    Eigen::Matrix2d total = Eigen::Matrix2d::Identity();
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
                const double before = pull - system.braking(way);
                const double after = pull - system.braking(back);
                step.has_corner = step.has_corner || jumps_at(event.t, pull);
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

}  // namespace dinal::analysis
