#include "motion/hybrid/field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/closed_form.hpp"
#include "motion/hybrid/solver.hpp"

namespace dinal::motion::hybrid {

namespace {

double value_on(const model::Excitation& excitation, double t, Side side) {
    return side == Side::before  ? excitation.value_before(t)
           : side == Side::after ? excitation.value_after(t)
                                 : excitation.value(t);
}

}  // namespace

Field::Field(const Problem& problem, const Past& past)
    : excitation_(problem.excitation),
      extras_(*problem.extras),
      past_(past),
      inertia_(problem.system.inertia()),
      rubs_(!extras_.belt.components().empty() && model::Lowered(problem.system).dry()),
      short_stretch_(belt_stretch * pace_of(problem)),
      initial_(problem.initial),
      memory_(problem.excitation.components().size()) {
    kinds_.reserve(memory_.size());
    for (const model::Component& c : excitation_.components()) {
        Kind kind{.sampled = model::controller_of<model::SampledController>(c),
                  .relay = model::controller_of<model::RelayController>(c),
                  .delayed = model::controller_of<model::DelayedController>(c)};
        if (kind.is_native()) kind.function = std::get_if<model::Scripted>(&c.term);
        if (kind.delayed != nullptr) delays_.push_back(kind.delayed->by);
        kinds_.push_back(kind);
    }
}

/// Of a component that is not native.
double Field::asked(std::size_t component, const MotionPoint& at) const {
    const Kind& kind = kinds_[component];
    if (kind.function != nullptr) {
        return kind.function->function->value_with(towards(at.t - kind.function->delay, at.side), at.y, at.states);
    }
    if (kind.relay != nullptr) return kind.relay->levels[memory_[component].on ? 0 : 1];
    if (kind.sampled != nullptr) return memory_[component].output;
    // A jump comes back at a time that is rounded: on its sides the past is asked beside it.
    const double asked_at = towards(at.t, at.side);
    return kind.delayed->function->value_with(asked_at, past_.at(asked_at - kind.delayed->by, at.side), at.states);
}

bool Field::asks_the_motion() const {
    return std::any_of(kinds_.begin(), kinds_.end(),
                       [](const Kind& kind) { return kind.function != nullptr && kind.function->feedback; });
}

bool Field::asks_functions() const {
    return std::any_of(kinds_.begin(), kinds_.end(), [](const Kind& kind) {
        return kind.function != nullptr || kind.delayed != nullptr ||
               (kind.relay != nullptr && kind.relay->of == model::RelayController::Of::function);
    });
}

bool Field::is_held(double inside) const {
    if (has_surroundings()) return false;
    for (std::size_t i = 0; i < kinds_.size(); ++i) {
        if (kinds_[i].sampled != nullptr || kinds_[i].relay != nullptr) continue;
        if (!model::stays_as_it_is(excitation_.components()[i], inside)) return false;
    }
    return true;
}

double Field::load(const MotionPoint& at) const {
    const double native_t = at.side == Side::before ? std::nextafter(at.t, -model::never) : at.t;
    double sum = 0;
    const auto components = excitation_.components();
    for (std::size_t i = 0; i < components.size(); ++i) {
        const model::Component& c = components[i];
        if (c.gain == 0 || native_t < c.from || native_t >= c.to) continue;
        double value = 0;
        if (!kinds_[i].is_native()) {
            value = asked(i, at);
            if (std::isnan(value)) return value;
        } else {
            value = std::visit(
                [native_t](const auto& term) {
                    if constexpr (model::terms::NativeTerm<std::decay_t<decltype(term)>>) {
                        return term.value(native_t);
                    } else {
                        return 0.0;
                    }
                },
                c.term);
        }
        sum += c.gain * value;
    }
    return sum;
}

double Field::push(double t, Side side) const {
    return extras_.base.components().empty() ? 0 : -inertia_ * value_on(extras_.base, t, side);
}

/// Where it does not break it is asked at t itself: a hair beside that it may be off by less than any rounding, and the
/// mass would slide on a belt that has its velocity.
double Field::belt(double t, Side side) const {
    if (!has_belt()) return 0;
    return value_on(extras_.belt, t, side == Side::at || belt_breaks(t) ? side : Side::at);
}

double Field::belt_heading(double t, Side side) const {
    constexpr double soon = 1e-4, nothing = 1e-10;
    if (!has_belt()) return 0;
    const double now = belt(t, side);
    const double ahead = belt(t + std::min(soon * short_stretch_, (extras_.belt.next_break(t) - t) / 2), Side::at);
    return std::fabs(now) <= nothing * std::fabs(ahead) ? std::copysign(hair, ahead) : now;
}

BeltSlope Field::belt_slope(double t) const {
    return has_belt() ? motion::belt_slope(extras_.belt, t, short_stretch_) : BeltSlope{0, 0};
}

void Field::rates(const MotionPoint& at, double* out) const {
    MotionPoint asked = at;
    asked.t = towards(at.t, at.side);
    for (std::size_t i = 0; i < extras_.states.size(); ++i) {
        out[i] = extras_.states[i].rate->value_with(asked.t, asked.y, asked.states);
    }
}

double Field::next_break(double t) const {
    double first = std::min({excitation_.next_break(t), extras_.belt.next_break(t), extras_.base.next_break(t)});
    for (std::size_t i = 0; i < kinds_.size(); ++i) {
        const auto* sampled = kinds_[i].sampled;
        if (sampled == nullptr) continue;
        first = std::min(first, instant(*sampled, memory_[i].instant));
        if (!memory_[i].pending.empty()) first = std::min(first, memory_[i].pending.front().first);
    }
    return first;
}

double Field::shortest_delay() const {
    double least = model::never;
    for (const double delay : delays_) least = std::min(least, delay);
    return least;
}

double Field::view(double t, double spacing) const {
    return std::min({excitation_.view(t, spacing), extras_.belt.view(t, spacing), extras_.base.view(t, spacing)});
}

void Field::begin(const MotionPoint& at) {
    for (std::size_t i = 0; i < memory_.size(); ++i) {
        if (const auto* sampled = kinds_[i].sampled) {
            const double n = std::ceil((at.t - sampled->at) / sampled->every - 1e-9);
            memory_[i].instant = static_cast<std::int64_t>(std::max(n, 0.0));
            if (instant(*sampled, memory_[i].instant) < at.t) ++memory_[i].instant;
            memory_[i].own = sampled->function->new_memory();
        } else if (const auto* relay = kinds_[i].relay) {
            memory_[i].on = relay->starts_on;
            if (until_switch(i, at) < 0) memory_[i].on = !memory_[i].on;
        }
    }
}

bool Field::arrive(const MotionPoint& at) {
    for (std::size_t i = 0; i < memory_.size(); ++i) {
        const auto* sampled = kinds_[i].sampled;
        if (sampled == nullptr) continue;
        ControllerMemory& memory = memory_[i];
        const auto take = [&] {
            while (!memory.pending.empty() && memory.pending.front().first <= at.t) {
                memory.output = memory.pending.front().second;
                memory.pending.pop_front();
            }
        };
        take();
        while (instant(*sampled, memory.instant) <= at.t) {
            sampled->function->use(memory.own);
            const double output = sampled->function->value_with(at.t, at.y, at.states);
            if (!std::isfinite(output)) return false;
            memory.pending.emplace_back(instant(*sampled, memory.instant) + sampled->delay, output);
            ++memory.instant;
        }
        take();
    }
    return true;
}

bool Field::may_go_on() const {
    for (const Kind& kind : kinds_) {
        if (kind.function != nullptr && !kind.function->function->may_go_on()) return false;
    }
    if (!extras_.belt.may_go_on() || !extras_.base.may_go_on()) return false;
    return std::all_of(extras_.states.begin(), extras_.states.end(),
                       [](const model::OwnState& state) { return state.rate->may_go_on(); });
}

Field::Threshold Field::threshold(std::size_t component) const {
    const model::RelayController& own = *relay(component);
    const double way = own.off > own.on ? 1 : -1;
    return memory_[component].on ? Threshold{-way, own.off} : Threshold{way, own.on};
}

std::optional<std::size_t> Field::looks_at(std::size_t component) const {
    using Of = model::RelayController::Of;
    const model::RelayController& own = *relay(component);
    if (own.of == Of::function) return {};
    std::size_t place = own.of == Of::velocity ? 1 : 0;
    for (std::size_t i = 0; own.of == Of::state && i < extras_.states.size(); ++i) {
        if (extras_.states[i].name == own.state) place = 2 + i;
    }
    return place;
}

double Field::until_switch(std::size_t component, const MotionPoint& at) const {
    const auto [sign, level] = threshold(component);
    const auto place = looks_at(component);
    if (!place) return sign * (relay(component)->function->value_with(at.t, at.y, at.states) - level);
    return sign * ((*place == 0 ? at.y.theta : *place == 1 ? at.y.velocity : at.states[*place - 2]) - level);
}

}  // namespace dinal::motion::hybrid
