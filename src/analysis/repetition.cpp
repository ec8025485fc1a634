#include "analysis/repetition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "analysis/returns.hpp"
#include "model/controller.hpp"
#include "model/excitation.hpp"

namespace dinal::analysis {
namespace {

constexpr double golden = 0.6180339887498949;  // its multiples modulo 1 fill a period evenly

/// Time number i of a sequence that fills the period evenly.
double probe(const Repetition& repeats, int i) {
    const double place = (i + 0.5) * golden;
    return repeats.start + repeats.period * (place - std::floor(place));
}

/// Returns times across the period, and some in each piece of half a period without a break of M in either half, so
/// that a difference on a short piece is detected; empty if there are too many pieces.
std::optional<std::vector<double>> probes_of_halves(const model::Excitation& excitation, const Repetition& repeats) {
    constexpr int spread = 24;
    constexpr std::size_t most_breaks = 20000;
    std::vector<double> times(spread);
    for (int i = 0; i < spread; ++i) times[static_cast<std::size_t>(i)] = probe(repeats, i);
    const double half = repeats.period / 2;
    std::vector<double> breaks{0, half};
    double t = excitation.next_break(repeats.start);
    while (t < repeats.start + repeats.period) {
        const double since = t - repeats.start;
        breaks.push_back(since < half ? since : since - half);
        if (breaks.size() > most_breaks) return {};
        t = excitation.next_break(t);
    }
    if (breaks.size() == 2) return times;
    std::ranges::sort(breaks);
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const double length = breaks[i + 1] - breaks[i];
        constexpr double rounding = 1e-12;
        if (!(length > rounding * (std::fabs(repeats.start) + repeats.period))) continue;
        for (const double part : {0.21, 0.5, 0.83}) times.push_back(repeats.start + breaks[i] + part * length);
    }
    return times;
}

/// Returns the extreme of sign * M, bracketed by a and b.
double refined(const model::Excitation& excitation, double sign, double a, double b) {
    for (int i = 0; i < 60 && b - a > 1e-9 * (std::fabs(a) + b - a); ++i) {
        const double x = b - golden * (b - a), y = a + golden * (b - a);
        sign* excitation.value(x) > sign* excitation.value(y) ? b = y : a = x;
    }
    return sign * excitation.value((a + b) / 2);
}

/// The harmonic number of a component that is one sine for all times; none for others.
std::optional<double> harmonic_number(const model::Component& component, const Repetition& repeats) {
    const auto* sine = std::get_if<model::Harmonic>(&component.term);
    if (sine == nullptr || std::isfinite(component.from) || std::isfinite(component.to)) return {};
    const double number = sine->omega * repeats.period / (2 * std::numbers::pi), whole = std::round(number);
    if (std::fabs(number - whole) > 1e-12 * std::max(1.0, whole)) return {};
    return whole;
}

bool is_odd(double whole) {
    return std::fmod(whole, 2) != 0;
}

/// The extremes if M is a single sine.
std::optional<TorqueRange> extremes_of_sine(const model::Excitation& excitation, const Repetition& repeats) {
    double swing = 0;
    int sines = 0;
    for (const model::Component& c : excitation.components()) {
        const auto number = harmonic_number(c, repeats);
        if (!number || *number == 0) return {};
        swing = std::fabs(c.gain * std::get<model::Harmonic>(c.term).amplitude);
        ++sines;
    }
    return sines == 1 ? std::optional(TorqueRange{-swing, swing}) : std::nullopt;
}

}  // namespace

std::optional<Repetition> repetition_of(const model::Excitation& excitation, double otherwise) {
    const auto repeats_from = [&](double from) -> std::optional<Repetition> {
        if (excitation.constant_from() <= from) return Repetition{from, otherwise};
        const double period = model::period_from(excitation, from);
        return period > 0 ? std::optional(Repetition{from, period}) : std::nullopt;
    };
    double from = 0;
    if (const auto at_once = repeats_from(from)) return at_once;
    for (const model::Component& c : excitation.components()) {
        for (const double t : {c.from, model::constant_from(c)}) {
            if (std::isfinite(t)) from = std::max(from, t);
        }
    }
    return repeats_from(from);
}

namespace {

/// The states passed to functions: for named bodies all angles and velocities, followed by the run's own states.
std::vector<double> states_of(const SteadyQuestion& question) {
    const model::Drive& drive = question.drive;
    std::vector<double> states;
    if (question.system->named) {
        states = drive.theta0;
        states.insert(states.end(), drive.velocity0.begin(), drive.velocity0.end());
    }
    for (const model::OwnState& state : drive.states) states.push_back(state.start);
    return states;
}

/// The function that a term evaluates at arbitrary times; null for sampled controllers.
std::shared_ptr<model::UserFunction> function_of(const model::Scripted& script) {
    if (const auto* controller = dynamic_cast<const model::Controller*>(script.function.get())) {
        const bool sampled = dynamic_cast<const model::SampledController*>(controller) != nullptr;
        return sampled ? nullptr : controller->function;
    }
    return script.function;
}

bool same_value(double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

/// Returns whether the function gives the same bits at unrelated times.
bool is_timeless(model::UserFunction& function, const model::State& initial, const std::vector<double>& states) {
    constexpr int probes = 40;
    double now = 0.1234567;
    for (int i = 0; i < probes; ++i) {
        const model::State y{initial.theta + 1e-3 * (i % 5 - 2), initial.velocity + 1e-3 * (i % 3 - 1)};
        std::vector<double> z = states;
        for (double& value : z) value += 1e-3 * (i % 7 - 3);
        if (!same_value(function.value_with(0, y, z), function.value_with(now, y, z))) return false;
        now = 1.27 * now + 0.0137;
    }
    return true;
}

/// The time from which this component does not depend on time itself.
double timeless_from(const model::Component& c, const model::State& initial, const std::vector<double>& states) {
    const auto* script = std::get_if<model::Scripted>(&c.term);
    if (script == nullptr) return model::constant_from(c);
    if (!script->breaks.empty()) return model::never;
    const auto function = function_of(*script);
    if (function != nullptr && !is_timeless(*function, initial, states)) return model::never;
    if (std::isfinite(c.to)) return c.to;
    return std::isfinite(c.from) ? c.from : 0;
}

/// An excitation of this component only.
model::Excitation alone(const model::Component& c) {
    auto made = model::Excitation::make(c.term);
    if (!made) return {};
    const bool whole = !std::isfinite(c.from) && !std::isfinite(c.to);
    return (whole ? made.value() : made.value().windowed(c.from, c.to)).scaled(c.gain);
}

/// The value of an excitation with own states, without controllers.
double value_of(const model::Excitation& excitation, double t, const model::State& y, const std::vector<double>& z) {
    double sum = 0;
    for (const model::Component& c : excitation.components()) {
        const auto* script = std::get_if<model::Scripted>(&c.term);
        if (script == nullptr) {
            sum += alone(c).value(t);
        } else if (model::controller_of(c) == nullptr && t >= c.from && t < c.to) {
            sum += c.gain * script->function->value_with(t - script->delay, y, z);
        }
    }
    return sum;
}

}  // namespace

std::vector<Acting> acting_in(const SteadyQuestion& question) {
    std::vector<Acting> all;
    for (const model::Excitation& load : question.drive.loads) all.push_back({"M", &load});
    for (const model::Joint& joint : question.system->joints) {
        const model::ContactFriction& friction = joint.friction;
        if (friction.sliding[0]) all.push_back({"Rd", &*friction.sliding[0]});
        if (friction.holding[0]) all.push_back({"Re", &*friction.holding[0]});
        if (friction.normal) all.push_back({"normal", &*friction.normal});
    }
    for (const model::Excitation& belt : question.drive.belts) all.push_back({"belt", &belt});
    all.push_back({"base", &question.drive.base});
    return all;
}

std::string timed_in(const SteadyQuestion& question) {
    const std::vector<double> states = states_of(question);
    const model::State initial{question.drive.theta0.front(), question.drive.velocity0.front()};
    for (const Acting& acting : acting_in(question)) {
        const auto& components = acting.what->components();
        const auto timed = [&](const model::Component& c) { return timeless_from(c, initial, states) > 0; };
        if (std::ranges::any_of(components, timed)) return acting.name;
    }
    const auto timed = [&](const model::OwnState& state) { return !is_timeless(*state.rate, initial, states); };
    const auto found = std::ranges::find_if(question.drive.states, timed);
    return found == question.drive.states.end() ? "" : "the rate of " + found->name;
}

std::optional<Repetition> repetition_of(const SteadyQuestion& question) {
    const std::vector<double> states = states_of(question);
    const model::State initial{question.drive.theta0.front(), question.drive.velocity0.front()};
    double start = 0;
    model::Excitation driven;
    for (const Acting& acting : acting_in(question)) {
        for (const model::Component& c : acting.what->components()) {
            const double from = timeless_from(c, initial, states);
            from < model::never ? void(start = std::max(start, from)) : void(driven = driven + alone(c));
        }
    }
    if (!driven.components().empty()) {
        const auto repeats = repetition_of(driven, 0);
        if (repeats) return Repetition{std::max(start, repeats->start), repeats->period};
        return {};
    }
    for (const model::OwnState& state : question.drive.states) {
        if (!is_timeless(*state.rate, initial, states)) return {};
    }
    for (const model::WantedEvent& event : question.drive.events) {
        if (event.act != nullptr && !is_timeless(*event.when, initial, states)) return {};
    }
    return Repetition{start, 0};
}

std::optional<text::Error> not_periodic(const SteadyQuestion& question, const Repetition& repeats) {
    const std::vector<double> states = states_of(question);
    const auto differs = [&](const std::string& name, auto&& value) -> std::optional<text::Error> {
        constexpr int probes = 50;
        double most = 0, worst = 0, at = 0, before = 0, after = 0;
        for (int i = 0; i < probes; ++i) {
            const double t = probe(repeats, i);
            const model::State y{0.1 * (i % 5), 0.1 * (i % 3)};
            const double now = value(t, y), later = value(t + repeats.period, y);
            if (!std::isfinite(now) || !std::isfinite(later)) return {};  // the runs report the error
            most = std::max({most, std::fabs(now), std::fabs(later)});
            if (std::fabs(now - later) > worst) worst = std::fabs(now - later), at = t, before = now, after = later;
        }
        if (!(worst > 1e-9 * most)) return {};
        return text::Error{
            .sentence = fmt::format("{} does not repeat itself after period = {:.10g}: it is {:.6g} at t = {:.6g}, and "
                                    "{:.6g} at t = {:.6g}",
                                    name, repeats.period, before, at, after, at + repeats.period),
            .option = "period"};
    };
    for (const Acting& acting : acting_in(question)) {
        auto wrong =
            differs(acting.name, [&](double t, const model::State& y) { return value_of(*acting.what, t, y, states); });
        if (wrong) return wrong;
    }
    for (const model::OwnState& state : question.drive.states) {
        auto wrong = differs("states." + state.name + ".rate",
                             [&](double t, const model::State& y) { return state.rate->value_with(t, y, states); });
        if (wrong) return wrong;
    }
    return {};
}

bool is_antisymmetric(const model::Excitation& excitation, const Repetition& repeats) {
    const auto components = excitation.components();
    if (std::ranges::all_of(components, [&](const model::Component& c) {
            const auto number = harmonic_number(c, repeats);
            return number && is_odd(*number);
        })) {
        return true;
    }
    const auto times = probes_of_halves(excitation, repeats);
    if (!times) return false;
    double greatest = 0, worst = 0;
    for (std::size_t j = 0; j < times->size(); ++j) {
        const double t = (*times)[j];
        const int i = static_cast<int>(j % 35);
        const model::State y{0.13 * (i % 5 - 2), 0.17 * (i % 7 - 3)}, opposite{-y.theta, -y.velocity};
        const double now = excitation.value(t, y), half = excitation.value(t + repeats.period / 2, opposite);
        if (!std::isfinite(now) || !std::isfinite(half)) return false;
        const double size = std::fabs(now) + std::fabs(half);
        greatest = std::max(greatest, size);
        worst = std::max(worst, std::fabs(now + half) - 1e-12 * size);
    }
    // Terms that cancel leave the rounding of the greatest term. The greatest term of a function is unknown, so its
    // values count.
    const double most = excitation.most();
    return worst <= 1e-13 * (std::isfinite(most) ? most : greatest);
}

std::complex<double> harmonic_of(const model::Excitation& excitation, const Repetition& repeats, double n) {
    const double omega = 2 * std::numbers::pi * n / repeats.period;
    const auto components = excitation.components();
    // a sin(w t + p) = a cos(w t + p - pi/2), summed over sines of this harmonic.
    std::complex<double> known;
    const bool sines = std::ranges::all_of(components, [&](const model::Component& c) {
        const auto number = harmonic_number(c, repeats);
        if (number == n && n > 0) {
            const auto& sine = std::get<model::Harmonic>(c.term);
            known += std::polar(1.0, sine.angle(repeats.start) - std::numbers::pi / 2) * (c.gain * sine.amplitude);
        }
        return number.has_value() && n > 0;
    });
    if (sines) return known;
    const auto sum =
        integral(excitation, repeats.start, repeats.start + repeats.period, repeats.period / 64,
                 [&](double t) { return excitation.value(t) * std::polar(1.0, -omega * (t - repeats.start)); });
    return sum * (2 / repeats.period);
}

TorqueRange extremes(const model::Excitation& excitation, const Repetition& repeats) {
    if (const auto sine = extremes_of_sine(excitation, repeats)) return *sine;
    constexpr int pieces = 512;
    const double end = repeats.start + repeats.period, h = repeats.period / pieces;
    TorqueRange range{excitation.value(repeats.start), excitation.value(repeats.start)};
    const auto see = [&range](double value) {
        range.low = std::min(range.low, value);
        range.high = std::max(range.high, value);
    };
    double jump = excitation.next_break(repeats.start);
    const double behind_end = end + 1e-12 * (std::fabs(end) + repeats.period);  // a jump at the end counts
    while (jump < behind_end) {
        see(excitation.value(jump));
        see(excitation.value_before(jump));
        jump = excitation.next_break(jump);
    }
    // A user's function need not have values before the start.
    double before = excitation.value(repeats.start), now = excitation.value(repeats.start + h);
    for (int i = 1; i <= pieces; ++i) {
        const double t = repeats.start + i * h, next = excitation.value(t + h);
        see(now);
        if (now >= before && now >= next && now > range.high - 1e-3 * (range.high - range.low)) {
            see(refined(excitation, 1, t - h, t + h));
        }
        if (now <= before && now <= next && now < range.low + 1e-3 * (range.high - range.low)) {
            see(-refined(excitation, -1, t - h, t + h));
        }
        before = now;
        now = next;
    }
    return range;
}

}  // namespace dinal::analysis
