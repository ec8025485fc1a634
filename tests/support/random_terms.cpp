// Random native terms and user functions, each with independent formulas for the independent integrator.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/random_case.hpp"
#include "support/written.hpp"

namespace dinal::truth {

namespace {

constexpr real pi = std::numbers::pi_v<real>;

/// A function of time: `shape(t, inside)` for double and for long double.
template <class Shape>
Load load_of(Shape shape, std::vector<double> breaks = {}) {
    return {[shape](real t, real inside, const MixedPoint&) -> real { return shape(t, inside); }, std::move(breaks)};
}

/// A native term, with the Lua text that makes it as its description.
template <class Term>
Ingredient term_of(const Term& term, Load load) {
    return {text::lua_text(Term::about.call.name, Term::about.call.options, term, text::Defaults::written),
            native(term), std::move(load)};
}

Ingredient sine_of(double a, double omega, double phase) {
    return term_of(model::Harmonic{a, omega, phase},
                   load_of([=](auto t, auto) -> real { return a * std::sin(omega * static_cast<real>(t) + phase); }));
}

Ingredient exponential_of(double a, double tau, double at) {
    return term_of(model::Exponential{a, tau, at},
                   load_of([=](auto t, auto in) -> real { return in < at ? 0 : a * std::exp(-(t - at) / tau); }, {at}));
}

/// from, from + step, ... throughout the window, also after a later delay.
std::vector<double> every(double from, double step, const Units& u, std::vector<double> parts = {0}) {
    std::vector<double> times;
    const double margin = 3 * u.period + step;
    const double first = std::floor((u.window.start - margin - from) / step);
    for (double n = first; from + n * step < u.window.end + margin; n += 1) {
        for (const double part : parts) times.push_back(from + (n + part) * step);
    }
    return times;
}

template <class Shape>
model::Excitation script_of(Shape shape, std::vector<double> breaks = {}) {
    return native(
        model::Scripted{.function = written([shape](double t, const model::State&, auto) { return shape(t, t); }),
                        .breaks = std::move(breaks)});
}

/// n times in the window, at least `apart` from each other.
std::vector<double> scattered(Lot& lot, const Units& u, int n, double apart) {
    std::vector<double> times;
    double t = u.window.start;
    for (int i = 0; i < n; ++i) {
        t += apart + lot.between(0, 1.5 * (u.window.end - u.window.start) / n);
        times.push_back(t);
    }
    return times;
}

/// The index of the stretch between `edges` that contains t.
template <class T>
std::size_t stretch_of(const std::vector<double>& edges, T t) {
    return static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), t) - edges.begin());
}

Ingredient short_term(Lot& lot, const Units& u) {
    const double a = u.torque * lot.between(-1.5, 1.5);
    const double at = lot.between(u.window.start - u.period, u.window.end);
    const double width = u.period * lot.power_of_ten(-3, 0.3);
    switch (lot.of(6)) {
        case 0:
            return term_of(model::Constant{a}, load_of([=](auto, auto) { return a; }));
        case 1:
            return term_of(model::Step{a, at}, load_of([=](auto, auto inside) { return inside < at ? 0 : a; }, {at}));
        case 2:
            return term_of(
                model::Pulse{a, at, width},
                load_of([=](auto, auto in) { return in < at || in >= at + width ? 0 : a; }, {at, at + width}));
        case 3:
            return term_of(model::HalfSine{a, at, width},
                           load_of(
                               [=](auto t, auto in) -> real {
                                   return in < at || in >= at + width ? 0 : a * std::sin(pi * (t - at) / width);
                               },
                               {at, at + width}));
        case 4: {
            const double slope = a / width;
            return term_of(model::Ramp{slope, at, width},
                           load_of(
                               [=](auto t, auto in) -> real {
                                   return in < at ? 0 : slope * (in < at + width ? t - at : static_cast<real>(width));
                               },
                               {at, at + width}));
        }
        default: {
            const double tau = u.period * (lot.once_in(4) ? -lot.between(8, 20) : lot.power_of_ten(-1.5, 1));
            return exponential_of(a, tau, at);
        }
    }
}

Ingredient periodic_term(Lot& lot, const Units& u) {
    const double a = u.torque * lot.between(-1.2, 1.2);
    const double at = lot.between(u.window.start - u.period, u.window.end);
    const double period = u.period * lot.power_of_ten(-0.6, 0.8);
    const auto cycle = [=](real in) { return std::floor((in - at) / period); };
    switch (lot.of(3)) {
        case 0: {
            const double duty = lot.between(0.05, 0.95);
            return term_of(model::Square{a, period, duty, at},
                           load_of([=](auto, auto in) { return (in - at) / period - cycle(in) < duty ? a : -a; },
                                   every(at, period, u, {0, duty})));
        }
        case 1:
            return term_of(
                model::Sawtooth{a, period, at},
                load_of([=](auto t, auto in) -> real { return -a + 2 * a * ((t - at) / period - cycle(in)); },
                        every(at, period, u)));
        default:
            return term_of(model::Triangle{a, period, at}, load_of(
                                                               [=](auto t, auto in) -> real {
                                                                   const real x = (t - at) / period - cycle(in),
                                                                              middle = (in - at) / period - cycle(in);
                                                                   return middle < 0.25L   ? 4 * a * x
                                                                          : middle < 0.75L ? a * (2 - 4 * x)
                                                                                           : a * (4 * x - 4);
                                                               },
                                                               every(at, period, u, {0.25, 0.75})));
    }
}

Ingredient chirp(Lot& lot, const Units& u) {
    const double a = u.torque * lot.between(-1, 1);
    const double at = lot.between(u.window.start - u.period, u.window.end), duration = u.period * lot.between(1, 12);
    const double f0 = lot.between(0, 2) / u.period, f1 = lot.between(0, 2) / u.period, phase = lot.between(0, 6.2);
    const auto shape = [=](auto t, auto in) -> real {
        const real x = t - at;
        const real cycles = in < at              ? f0 * x
                            : in < at + duration ? x * (f0 + (f1 - f0) * x / (2 * duration))
                                                 : duration * ((f0 + f1) / 2) + f1 * (x - duration);
        return a * std::sin(2 * pi * cycles + phase);
    };
    return term_of(model::Chirp{a, f0, f1, duration, at, phase}, load_of(shape, {at, at + duration}));
}

Ingredient polynomial(Lot& lot, const Units& u) {
    const double at = lot.between(u.window.start, u.window.end), length = u.window.end - u.window.start;
    std::vector<double> c;
    for (int i = 0; i <= lot.of(4); ++i) c.push_back(u.torque * lot.between(-1, 1) / std::pow(length, i));
    const auto shape = [=](auto t, auto) -> real {
        real sum = 0;
        for (auto x = c.rbegin(); x != c.rend(); ++x) sum = sum * (t - at) + *x;
        return sum;
    };
    return term_of(model::Polynomial{c, at}, load_of(shape));
}

Ingredient table(Lot& lot, const Units& u) {
    const int n = 2 + lot.of(30);
    std::vector<double> t = scattered(lot, u, n, 1e-3 * u.period), M;
    for (int i = 0; i < n; ++i) M.push_back(u.torque * lot.between(-1, 1));
    const auto shape = [t, M](auto x, auto in) -> real {
        const std::size_t i = stretch_of(t, in);
        if (i == 0) return M.front();
        if (i == t.size()) return M.back();
        return M[i - 1] +
               (static_cast<real>(M[i]) - M[i - 1]) * ((x - t[i - 1]) / (static_cast<real>(t[i]) - t[i - 1]));
    };
    return {fmt::format("samples t {:.17g} M {:.17g}", fmt::join(t, ", "), fmt::join(M, ", ")),
            native(std::make_shared<const model::Samples>(model::Samples{t, M})), load_of(shape, t)};
}

Ingredient sine(Lot& lot, const Units& u) {
    const double a = u.torque * lot.between(0.2, 1.5), phase = lot.once_in(2) ? 0 : lot.between(0, 6.2);
    const double omega = (lot.once_in(5) ? 1 : lot.between(0.05, 3)) * (6.283185307179586 / u.period);
    return sine_of(a, omega, phase);
}

}  // namespace

Ingredient random_native_term(Lot& lot, const Units& u) {
    switch (lot.of(10)) {
        case 0:
        case 1:
        case 2:
            return short_term(lot, u);
        case 3:
        case 4:
            return periodic_term(lot, u);
        case 5:
            return chirp(lot, u);
        case 6:
            return polynomial(lot, u);
        case 7:
            return table(lot, u);
        default:
            return sine(lot, u);
    }
}

Ingredient random_resonant_term(Lot& lot, const Units& u, double damping_ratio) {
    const double w0 = 6.283185307179586 / u.period, off = 1 + (lot.once_in(2) ? 1 : -1) * lot.power_of_ten(-15, -1);
    const double detuned = lot.once_in(4) ? 1 : off;
    if (damping_ratio < 1 && !lot.once_in(4)) {
        const double a = u.torque * lot.between(0.05, 0.5), phase = lot.between(0, 6.2);
        const double omega = w0 * detuned * std::sqrt((1 - damping_ratio) * (1 + damping_ratio));
        return sine_of(a, omega, phase);
    }
    const double zeta = damping_ratio, root = zeta > 1 ? std::sqrt((zeta - 1) * (zeta + 1)) : 0;
    const double rate = w0 * detuned * (root > 0 && lot.once_in(2) ? 1 / (zeta + root) : std::max(zeta + root, 0.1));
    const double a = u.torque * lot.between(-1, 1), at = u.window.start, tau = 1 / rate;
    return exponential_of(a, tau, at);
}

/// A bump; narrow ones are large enough to have an effect. For the independent integrator, which takes few steps
/// between breaks, it has additional breaks.
Ingredient random_bump(Lot& lot, const Units& u, double width) {
    const double felt = u.torque * std::max(1.0, u.period / (15 * width));
    const double a = felt * lot.between(-1.5, 1.5), at = lot.between(u.window.start, u.window.end);
    std::vector<double> steps;
    for (const double x : {-12, -9, -6, -4, -2, 0, 2, 4, 6, 9, 12}) steps.push_back(at + x * width);
    const auto shape = [=](auto t, auto) -> real {
        const real x = (t - at) / width;
        return a * std::exp(-x * x / 2);
    };
    return term_of(model::Gaussian{a, at, width}, load_of(shape, steps));
}

/// Smooth, with jumps or with kinks; jumps may be announced or not.
Ingredient random_function_of_time(Lot& lot, const Units& u) {
    const double a = u.torque * lot.between(0.2, 1.5), w = lot.between(0.2, 8) / u.period, phase = lot.between(0, 6);
    const double first = u.window.start;
    switch (lot.of(5)) {
        case 0: {
            const double depth = lot.between(0.1, 1.5);
            const auto shape = [=](auto t, auto) {
                const auto x = w * (t - first) + phase;
                return a * std::sin(x + depth * std::sin(2 * x)) * std::exp(std::cos(x) - 1);
            };
            return {fmt::format("smooth a {:.17g} w {:.17g} phase {:.17g} depth {:.17g}", a, w, phase, depth),
                    script_of(shape), load_of(shape)};
        }
        case 1: {  // |sin|: kinks
            const auto shape = [=](auto t, auto in) {
                return std::copysign(a, std::sin(w * (in - first) + phase)) * std::sin(w * (t - first) + phase);
            };
            const double half = std::numbers::pi / w;
            return {fmt::format("rectified a {:.17g} w {:.17g} phase {:.17g}", a, w, phase), script_of(shape),
                    load_of(shape, every(first - phase / w, half, u))};
        }
        case 2: {  // a polygon
            const std::vector<double> edges = scattered(lot, u, 2 + lot.of(8), 0.15 * u.period);
            std::vector<double> slopes;
            for (std::size_t i = 0; i <= edges.size(); ++i) slopes.push_back(lot.between(-1, 1) * a / u.period);
            const auto shape = [=](auto t, auto in) {
                const std::size_t n = stretch_of(edges, in);
                auto sum = slopes[0] * (t - edges[0]);
                for (std::size_t i = 0; i < n; ++i) sum += (slopes[i + 1] - slopes[i]) * (t - edges[i]);
                return sum;
            };
            return {fmt::format("polygon at {:.17g} slopes {:.17g}", fmt::join(edges, ", "), fmt::join(slopes, ", ")),
                    script_of(shape), load_of(shape, edges)};
        }
        default: {
            const std::vector<double> edges = scattered(lot, u, 1 + lot.of(12), 0.15 * u.period);
            std::vector<double> levels;
            const double jump = lot.once_in(3) ? lot.power_of_ten(-9, 0) : 1;
            for (std::size_t i = 0; i <= edges.size(); ++i) levels.push_back(jump * lot.between(-1, 1) * a);
            const auto shape = [=](auto t, auto in) {
                return levels[stretch_of(edges, in)] + a / 2 * std::sin(w * (t - first) + phase);
            };
            const bool announced = lot.once_in(3);
            return {fmt::format("jumps{} at {:.17g} levels {:.17g} a/2 {:.17g} w {:.17g} phase {:.17g}",
                                announced ? " (announced)" : "", fmt::join(edges, ", "), fmt::join(levels, ", "), a / 2,
                                w, phase),
                    script_of(shape, announced ? edges : std::vector<double>{}), load_of(shape, edges)};
        }
    }
}

/// Controllers and nonlinear springs, smooth or with corners in theta.
Ingredient random_feedback(Lot& lot, const Units& u) {
    const double torque = u.torque, angle = u.angle, speed = 6.283185307179586 * angle / u.period;
    const double a = lot.between(0.05, 1.5), b = lot.between(0.05, 1), w = lot.between(0.5, 9) / u.period;
    const double first = u.window.start, at = lot.between(u.window.start, u.window.end);
    const int kind = lot.of(9);
    const auto shape = [=](auto t, auto in, auto theta, auto velocity) {
        const auto x = theta / angle, v = velocity / speed;
        using T = std::decay_t<decltype(x)>;
        switch (kind) {
            case 0:
                return -a * torque * x * x * x;
            case 1:
                return -a * torque * std::tanh(4 * b * v);
            case 2:
                return b * torque * v * (1 - x * x);
            case 3:
                return a * torque * std::sin(2 * x);
            case 4:
                return torque * ((0.5 - a) * x + (0.1 - b) * v);
            case 5:
                return b * torque * std::cos(w * (t - first)) * x;
            case 6:  // a controller with a dead zone
                return std::fabs(x) <= b ? 0 * x : -a * torque * (x - std::copysign(T(b), x));
            case 7:  // a controller that saturates
                return -torque * std::clamp(2 * a * x, T(-b), T(b));
            default:  // switched on
                return in < at ? 0 * x : -torque * (b * x + a * v);
        }
    };
    const auto function = written([shape](double t, const model::State& y, auto) {
        return static_cast<double>(shape(t, t, y.theta, y.velocity));
    });
    const Load load{[shape](real t, real in, const MixedPoint& y) -> real { return shape(t, in, y.theta, y.velocity); },
                    kind == 8 ? std::vector<double>{at} : std::vector<double>{}};
    return {
        fmt::format("feedback {} a {:.17g} b {:.17g} w {:.17g} at {:.17g} angle {:.17g} speed {:.17g} torque {:.17g}",
                    kind, a, b, w, at, angle, speed, torque),
        native(model::Scripted{.function = function, .feedback = true}), load};
}

}  // namespace dinal::truth
