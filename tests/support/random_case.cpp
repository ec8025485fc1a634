#include "support/random_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "model/closed_form.hpp"

namespace dinal::truth {

namespace {

/// Sometimes changes gain, delay or window.
Ingredient altered(Lot& lot, const Units& u, Ingredient x) {
    if (lot.once_in(4)) {
        const double gain = lot.between(-1.5, 1.5);
        x.story += fmt::format(" times {:.17g}", gain);
        x.excitation = x.excitation.scaled(gain);
        x.load.torque = [f = x.load.torque, gain](real t, real in, const Motion& y) { return gain * f(t, in, y); };
    }
    if (lot.once_in(4)) {
        const double delay = u.period * lot.between(-1, 2);
        x.story += fmt::format(" delayed by {:.17g}", delay);
        x.excitation = x.excitation.delayed(delay);
        x.load.torque = [f = x.load.torque, delay](real t, real in, const Motion& y) {
            return f(t - delay, in - delay, y);
        };
        for (double& b : x.load.breaks) b += delay;
    }
    if (lot.once_in(5)) {
        const double from = lot.between(u.window.start - u.period, u.window.end);
        const double to = from + u.period * lot.between(0.1, 8);
        x.story += fmt::format(" from {:.17g} to {:.17g}", from, to);
        x.excitation = x.excitation.windowed(from, to);
        x.load.torque = [f = x.load.torque, from, to](real t, real in, const Motion& y) -> real {
            return in < from || in >= to ? 0 : f(t, in, y);
        };
        x.load.breaks.insert(x.load.breaks.end(), {from, to});
    }
    return x;
}

void add(RandomCase& c, Ingredient x) {
    c.story += "; " + x.story;
    c.excitation = c.excitation + x.excitation;
    c.load.torque = [f = c.load.torque, g = x.load.torque](real t, real in, const Motion& y) {
        return f(t, in, y) + g(t, in, y);
    };
    c.load.breaks.insert(c.load.breaks.end(), x.load.breaks.begin(), x.load.breaks.end());
    c.load.quickest = std::max(c.load.quickest, x.load.quickest);
}

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
RandomCase undriven_case(Lot& lot, double (*damping)(Lot& lot) = damping_ratio) {
    const double I = lot.power_of_ten(-6, 5), k = lot.power_of_ten(-3, 3), angle = lot.power_of_ten(-9, 6);
    const double zeta = damping(lot);
    double Rd = lot.once_in(6) ? 0 : lot.between(0, 0.9), Re = lot.once_in(2) ? Rd : Rd * lot.between(1, 1.7);
    if (lot.once_in(10)) Re = lot.between(0.1, 0.6), Rd = 0;
    const double torque = k * angle;
    const model::Oscillator system = model::Oscillator::make({.inertia = I,
                                                              .stiffness = k,
                                                              .damping = 2 * zeta * std::sqrt(I * k),
                                                              .kinetic_friction = Rd * torque,
                                                              .breakaway = Re * torque})
                                         .value();
    const double T0 = system.natural_period();
    const double start = lot.once_in(2) ? 0 : T0 * lot.between(-30, 30);
    const motion::Window window{start, start + T0 * lot.between(2, 14)};
    const model::State initial{lot.once_in(4) ? 0 : angle * lot.between(-1.5, 1.5),
                               lot.once_in(3) ? 0 : angle * system.natural_frequency() * lot.between(-1.5, 1.5)};
    return {fmt::format("I {:.17g} k {:.17g} C {:.17g} Rd {:.17g} Re {:.17g} (zeta {:.3g}, Rd {:.3g}, Re {:.3g}; T0 "
                        "{:.6g}) theta {:.17g} velocity {:.17g} t {:.17g} to {:.17g}",
                        I, k, system.damping(), Rd * torque, Re * torque, zeta, Rd, Re, T0, initial.theta,
                        initial.velocity, window.start, window.end),
            system,
            {},
            {[](real, real, const Motion&) -> real { return 0; }},
            initial,
            window,
            angle,
            {}};
}

Units units_of(const RandomCase& c) {
    return {c.window, c.system.natural_period(), c.size, c.system.stiffness() * c.size};
}

void choose_times(Lot& lot, RandomCase& c) {
    constexpr int places = 24;
    const auto [start, end] = c.window;
    for (int i = 0; i < places; ++i) {
        c.times.push_back(start + (end - start) * (i + lot.between(0, 1)) / places);
    }
}

}  // namespace

RandomCase random_case(std::uint64_t number) {
    Lot lot(number * 0x632be59bd9b4e019U + 1);
    RandomCase c = undriven_case(lot);
    const Units units = units_of(c);
    for (int i = lot.of(4); i > 0; --i) add(c, altered(lot, units, random_native_term(lot, units)));
    if (lot.once_in(3)) add(c, altered(lot, units, random_function_of_time(lot, units)));
    if (lot.once_in(4)) add(c, altered(lot, units, random_feedback(lot, units)));
    std::sort(c.load.breaks.begin(), c.load.breaks.end());
    choose_times(lot, c);
    return c;
}

namespace {

double any_damping_ratio(Lot& lot) {
    return lot.once_in(4) ? 1 + (lot.once_in(2) ? 1 : -1) * lot.power_of_ten(-15, -2) : damping_ratio(lot);
}

}  // namespace

RandomCase random_case_of_closed_forms(std::uint64_t number) {
    Lot lot(number * 0x632be59bd9b4e019U + 11);
    RandomCase c = undriven_case(lot, any_damping_ratio);
    const Units units = units_of(c);
    for (int i = lot.of(4); i > 0; --i) {
        Ingredient term = random_native_term(lot, units);
        while (!model::has_closed_form(term.excitation)) term = random_native_term(lot, units);
        add(c, altered(lot, units, std::move(term)));
    }
    if (lot.once_in(2)) add(c, altered(lot, units, random_resonant_term(lot, units, c.system.damping_ratio())));
    std::sort(c.load.breaks.begin(), c.load.breaks.end());
    choose_times(lot, c);
    return c;
}

RandomCase random_case_of_bumps(std::uint64_t number) {
    Lot lot(number * 0x632be59bd9b4e019U + 7);
    RandomCase c = undriven_case(lot);
    const Units units = units_of(c);
    if (lot.once_in(2)) {
        c.story += ", but at rest";
        c.initial = {};
    }
    for (int i = 1 + lot.of(3); i > 0; --i) {
        const double width = units.period * lot.power_of_ten(-6, 1);
        add(c, altered(lot, units, random_bump(lot, units, width)));
        const double latest = std::max(std::fabs(c.window.start), std::fabs(c.window.end));
        c.lost_in_time = std::max(c.lost_in_time, 4 * std::numeric_limits<double>::epsilon() * latest / width);
    }
    c.late = 2e-11 * std::numbers::pi;  // spectral locates a release to 1e-11 T0
    if (lot.once_in(3)) add(c, altered(lot, units, random_native_term(lot, units)));
    std::sort(c.load.breaks.begin(), c.load.breaks.end());
    choose_times(lot, c);
    return c;
}

long number_from(const char* variable, long otherwise) {
    const char* text = std::getenv(variable);
    return text == nullptr ? otherwise : std::strtol(text, nullptr, 10);
}

}  // namespace dinal::truth
