#include "model/oscillator.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "model/laws/coulomb.hpp"

namespace dinal::model {

std::string_view name(Regime regime) {
    switch (regime) {
        case Regime::undamped:
            return "undamped";
        case Regime::underdamped:
            return "underdamped";
        case Regime::critical:
            return "critical";
        case Regime::overdamped:
            return "overdamped";
    }
    return "";
}

text::Expected<Oscillator> Oscillator::make(const OscillatorParameters& p) {
    if (auto wrong = text::complaint(oscillator_options, p)) return *wrong;
    const Friction friction =
        p.friction.value_or(laws::Coulomb{p.kinetic_friction, p.breakaway.value_or(p.kinetic_friction)});
    if (auto wrong = friction.complaint()) return *wrong;
    Oscillator o;
    o.inertia_ = p.inertia;
    o.stiffness_ = p.stiffness;
    o.damping_ = p.damping;
    o.friction_ = friction.under(p.normal);
    if (auto wrong = p.spring.complaint()) return *wrong;
    o.spring_ = p.spring;
    if (p.walls) {
        if (auto wrong = p.walls->complaint()) return *wrong;
    }
    o.walls_ = p.walls;
    if (auto wrong = p.units.complaint()) return *wrong;
    if (!p.units.usual()) o.units_ = std::make_shared<const Units>(p.units);
    // Margin against overflow when angles are added.
    constexpr double room = 1e6;
    const double from = o.has_spring() ? o.stiffness() : o.inertia();
    if (!std::isfinite(room * o.breakaway() / from) || !std::isfinite(room * o.kinetic_friction() / from)) {
        return text::Error{.sentence = fmt::format("friction of {:.6g} and {} = {:.6g} are too far apart for double "
                                                   "precision: choose other units",
                                                   o.breakaway(), o.has_spring() ? "k" : "I", from)};
    }
    if (!o.has_spring()) {
        if (std::isfinite(o.damping() / o.inertia())) return o;
        return text::Error{
            .sentence = fmt::format("I = {:.6g} and C = {:.6g} are too far apart for double precision: choose other "
                                    "units",
                                    p.inertia, p.damping),
            .option = "I"};
    }
    // The integrators compute the fourth power of the frequency.
    if (!std::isnormal(std::pow(o.natural_frequency(), 4)) || !std::isnormal(std::pow(o.natural_period(), 4)) ||
        !std::isfinite(o.damping() / o.inertia()) || !std::isfinite(o.dead_zone()) ||
        !std::isfinite(o.damping_ratio())) {
        return text::Error{.sentence = fmt::format(
                               "I = {:.6g} and k = {:.6g} are too far apart for double precision: choose other units",
                               p.inertia, p.stiffness),
                           .option = "I"};
    }
    return o;
}

const Units& Oscillator::units() const {
    static const Units usual;
    return units_ ? *units_ : usual;
}

double Oscillator::natural_frequency() const {
    return std::sqrt(stiffness_ / inertia_);
}

double Oscillator::natural_period() const {
    return 2 * std::numbers::pi / natural_frequency();
}

// sqrt(I) sqrt(k) rather than sqrt(I k): the product may overflow although its root does not. If I k is a perfect
// square, the single root is exact and a critical system shows zeta = 1.
double Oscillator::damping_ratio() const {
    if (!has_spring()) return damping_ > 0 ? unlimited : 0;
    const double product = inertia_ * stiffness_;
    const double root = std::isnormal(product) ? std::sqrt(product) : std::sqrt(inertia_) * std::sqrt(stiffness_);
    return damping_ / 2 / root;
}

std::optional<double> Oscillator::damped_frequency() const {
    const double zeta = damping_ratio();
    if (!has_spring() || regime() == Regime::critical || regime() == Regime::overdamped) return {};
    return natural_frequency() * std::sqrt((1 - zeta) * (1 + zeta));
}

Regime Oscillator::regime() const {
    if (damping_ == 0) return Regime::undamped;
    if (!has_spring()) return Regime::overdamped;
    // Compares C/2 with I (k/(C/2)): the squares could overflow or vanish.
    const double half = damping_ / 2;
    const double square = half * half;
    const double product = inertia_ * stiffness_;
    if (std::isnormal(square) && std::isnormal(product)) {
        if (square == product) return Regime::critical;
        return square < product ? Regime::underdamped : Regime::overdamped;
    }
    const double zeta = damping_ratio();
    if (zeta == 1) return Regime::critical;
    return zeta < 1 ? Regime::underdamped : Regime::overdamped;
}

double Oscillator::friction_ratio(double characteristic_torque) const {
    return kinetic_friction() / std::fabs(characteristic_torque);
}

double Oscillator::characteristic_torque(const State& initial) const {
    return stiffness_ * std::hypot(initial.theta, initial.velocity / natural_frequency());
}

OscillatorParameters Oscillator::parameters() const {
    OscillatorParameters p{.inertia = inertia_,
                           .stiffness = stiffness_,
                           .damping = damping_,
                           .normal = friction_.normal(),
                           .spring = spring_,
                           .walls = walls_,
                           .units = units()};
    if (const auto* law = friction_.as<laws::Coulomb>()) {
        p.kinetic_friction = law->kinetic;
        p.breakaway = law->breakaway;
    } else {
        p.friction = friction_.under(1);
    }
    return p;
}

}  // namespace dinal::model
