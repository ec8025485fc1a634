#include "support/random_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "model/closed_form.hpp"
#include "support/written.hpp"

namespace dinal::truth {

namespace {

/// Sometimes changes gain, delay or window.
Ingredient altered(Lot& lot, const Units& u, Ingredient x) {
    if (lot.once_in(4)) {
        const double gain = lot.between(-1.5, 1.5);
        x.story += fmt::format(" times {:.17g}", gain);
        x.excitation = x.excitation.scaled(gain);
        x.load.torque = [f = x.load.torque, gain](real t, real in, const MixedPoint& y) { return gain * f(t, in, y); };
    }
    if (lot.once_in(4)) {
        const double delay = u.period * lot.between(-1, 2);
        x.story += fmt::format(" delayed by {:.17g}", delay);
        x.excitation = x.excitation.delayed(delay);
        x.load.torque = [f = x.load.torque, delay](real t, real in, const MixedPoint& y) {
            return f(t - delay, in - delay, y);
        };
        for (double& b : x.load.breaks) b += delay;
    }
    if (lot.once_in(5)) {
        const double from = lot.between(u.window.start - u.period, u.window.end);
        const double to = from + u.period * lot.between(0.1, 8);
        x.story += fmt::format(" from {:.17g} to {:.17g}", from, to);
        x.excitation = x.excitation.windowed(from, to);
        x.load.torque = [f = x.load.torque, from, to](real t, real in, const MixedPoint& y) -> real {
            return in < from || in >= to ? 0 : f(t, in, y);
        };
        x.load.breaks.insert(x.load.breaks.end(), {from, to});
    }
    return x;
}

/// A case, and the sum of what drives it.
struct Driven {
    RandomCase c;
    Load load = {[](real, real, const MixedPoint&) -> real { return 0; }};

    void add(Ingredient x) {
        c.story += "; " + x.story;
        c.drive.loads = {c.drive.M() + x.excitation};
        load.torque = [f = load.torque, g = x.load.torque](real t, real in, const MixedPoint& y) {
            return f(t, in, y) + g(t, in, y);
        };
        load.breaks.insert(load.breaks.end(), x.load.breaks.begin(), x.load.breaks.end());
    }
    Units units() const {
        return {c.window, 6.283185307179586 * static_cast<double>(c.time), static_cast<double>(c.angle),
                c.parameters.stiffness * static_cast<double>(c.angle)};
    }
    /// The case with its load in its own units, and output times.
    RandomCase complete(Lot& lot) {
        const double start = c.window.start, end = c.window.end;
        const real torque = c.parameters.stiffness * c.angle;
        c.truth.M = [](real, const MixedPoint&) -> real { return 0; };
        c.truth.broken = [=, f = load.torque, time = c.time, angle = c.angle](real t, real in, const MixedPoint& y) {
            return f(start + time * t, start + time * in, {angle * y.theta, angle / time * y.velocity}) / torque;
        };
        for (const double b : load.breaks) {
            if (b > start && b < end) c.truth.breaks.push_back((b - static_cast<real>(start)) / c.time);
        }
        constexpr int places = 24;
        for (int i = 0; i < places; ++i) c.times.push_back(start + (end - start) * (i + lot.between(0, 1)) / places);
        return c;
    }
};

double damping_ratio(Lot& lot) {
    switch (lot.of(8)) {
        case 0:
        case 1:
            return 0;
        case 2:
            return 1;
        case 3:
            return lot.between(0, 3);
        case 4:
            return lot.power_of_ten(0, 1.7);
        default:
            return lot.between(0, 0.4);
    }
}

}  // namespace

double Lot::power_of_ten(double a, double b) {
    return std::pow(10, between(a, b));
}

/// splitmix64
std::uint64_t Lot::next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

namespace {

/// A system, a start and a window, without a drive.
Driven undriven_case(Lot& lot, double zeta) {
    const double I = lot.power_of_ten(-6, 5), k = lot.power_of_ten(-3, 3), angle = lot.power_of_ten(-9, 6);
    double Rd = lot.once_in(6) ? 0 : lot.between(0, 0.9), Re = lot.once_in(2) ? Rd : Rd * lot.between(1, 1.7);
    if (lot.once_in(10)) Re = lot.between(0.1, 0.6), Rd = 0;
    const double torque = k * angle, w0 = std::sqrt(k / I), T0 = 6.283185307179586 / w0;
    Driven driven;
    RandomCase& c = driven.c;
    c.parameters = {.inertia = I,
                    .stiffness = k,
                    .damping = 2 * zeta * std::sqrt(I * k),
                    .kinetic_friction = Rd * torque,
                    .breakaway = Re * torque};
    const double start = lot.once_in(2) ? 0 : T0 * lot.between(-30, 30);
    c.window = {start, start + T0 * lot.between(2, 14)};
    const model::State initial{lot.once_in(4) ? 0 : angle * lot.between(-1.5, 1.5),
                               lot.once_in(3) ? 0 : angle * w0 * lot.between(-1.5, 1.5)};
    c.drive.start_at(initial);
    c.angle = angle, c.time = std::sqrt(static_cast<real>(I) / k);
    c.truth.C = c.parameters.damping / std::sqrt(static_cast<real>(I) * k);
    const real slides = c.parameters.kinetic_friction / (static_cast<real>(k) * angle),
               holds = Re * torque / (static_cast<real>(k) * angle);
    c.truth.sliding = {{[slides](int, real) { return slides; }}};
    c.truth.holding = {holds, holds};
    c.story = fmt::format(
        "I {:.17g} k {:.17g} C {:.17g} Rd {:.17g} Re {:.17g} (zeta {:.3g}, Rd {:.3g}, Re {:.3g}; T0 {:.6g}) theta "
        "{:.17g} velocity {:.17g} t {:.17g} to {:.17g}",
        I, k, c.parameters.damping, Rd * torque, Re * torque, zeta, Rd, Re, T0, initial.theta, initial.velocity,
        c.window.start, c.window.end);
    return driven;
}

double any_damping_ratio(Lot& lot) {
    return lot.once_in(4) ? 1 + (lot.once_in(2) ? 1 : -1) * lot.power_of_ten(-15, -2) : damping_ratio(lot);
}

}  // namespace

RandomCase random_case(std::uint64_t number) {
    Lot lot(number * 0x632be59bd9b4e019U + 1);
    Driven driven = undriven_case(lot, damping_ratio(lot));
    const Units units = driven.units();
    for (int i = lot.of(4); i > 0; --i) driven.add(altered(lot, units, random_native_term(lot, units)));
    if (lot.once_in(3)) driven.add(altered(lot, units, random_function_of_time(lot, units)));
    driven.c.truth.bends = lot.once_in(4);
    if (driven.c.truth.bends) driven.add(altered(lot, units, random_feedback(lot, units)));
    return driven.complete(lot);
}

RandomCase random_case_of_closed_forms(std::uint64_t number) {
    Lot lot(number * 0x632be59bd9b4e019U + 11);
    const double zeta = any_damping_ratio(lot);
    Driven driven = undriven_case(lot, zeta);
    const Units units = driven.units();
    for (int i = lot.of(4); i > 0; --i) {
        Ingredient term = random_native_term(lot, units);
        while (!model::has_closed_form(term.excitation)) term = random_native_term(lot, units);
        driven.add(altered(lot, units, std::move(term)));
    }
    if (lot.once_in(2)) driven.add(altered(lot, units, random_resonant_term(lot, units, zeta)));
    return driven.complete(lot);
}

RandomCase random_case_of_bumps(std::uint64_t number) {
    Lot lot(number * 0x632be59bd9b4e019U + 7);
    Driven driven = undriven_case(lot, damping_ratio(lot));
    const Units units = driven.units();
    RandomCase& c = driven.c;
    if (lot.once_in(2)) {
        c.story += ", but at rest";
        c.drive.start_at({});
    }
    for (int i = 1 + lot.of(3); i > 0; --i) {
        const double width = units.period * lot.power_of_ten(-6, 1);
        driven.add(altered(lot, units, random_bump(lot, units, width)));
        const double latest = std::max(std::fabs(c.window.start), std::fabs(c.window.end));
        c.lost_in_time = std::max(c.lost_in_time, 4 * std::numeric_limits<double>::epsilon() * latest / width);
    }
    c.late = 2e-11 * std::numbers::pi;  // spectral locates a release to 1e-11 T0
    if (lot.once_in(3)) driven.add(altered(lot, units, random_native_term(lot, units)));
    return driven.complete(lot);
}

long number_from(const char* variable, long otherwise) {
    const char* text = std::getenv(variable);
    return text == nullptr ? otherwise : std::strtol(text, nullptr, 10);
}

}  // namespace dinal::truth
