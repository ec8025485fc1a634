#include "analysis/sine/sine_arcs.hpp"

#include <algorithm>
#include <cmath>

#include "theory/theory_forced.hpp"

namespace dinal::analysis::sine {
namespace {

/// The product as it is for finite numbers.
std::complex<double> product(std::complex<double> a, std::complex<double> b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
std::complex<double> phasor(double angle) {
    return {std::cos(angle), std::sin(angle)};
}

}  // namespace

bool SineArcs::applies_to(const SingleSine& sine) {
    constexpr double heavy = 0.99, resonant = 1e-6;  // where forms of other kinds would be needed
    return sine.zeta < heavy && (sine.zeta > resonant || std::fabs(sine.r - 1) > resonant);
}

SineArcs::SineArcs(const SingleSine& sine)
    : sine_(sine),
      root_(-sine.zeta, theory::Modes(sine.zeta).rate()),
      answer_(theory::magnification(sine.r, sine.zeta)),
      lag_(theory::phase_lag(sine.r, sine.zeta)),
      step_(0.3 * std::min(1.0, 1 / sine.r)),
      forced_turn_(phasor(sine.r * step_)),
      free_turn_(std::exp(-sine.zeta * step_) * phasor(root_.imag() * step_)) {}

void SineArcs::leave(double phase, double y, double way) {
    way_ = way;
    forced_ = answer_ * phasor(phase - lag_);
    const double apart = y - (forced_.imag() - way * sine_.sliding), slower = -sine_.r * forced_.real();
    free_ = {apart, -(slower + sine_.zeta * apart) / root_.imag()};
}

theory::Motion2 SineArcs::at(double x) const {
    const Complex load = product(forced_, phasor(sine_.r * x));
    const Complex own = product(free_, std::exp(root_.real() * x) * phasor(root_.imag() * x));
    return {load.imag() + own.real() - way_ * sine_.sliding, sine_.r * load.real() + product(root_, own).real()};
}

SineArcs::Speed SineArcs::speed(double x) const {
    const Complex load = product(forced_, phasor(sine_.r * x));
    const Complex own = product(free_, std::exp(root_.real() * x) * phasor(root_.imag() * x));
    const Complex rate = product(root_, own);
    return {way_ * (sine_.r * load.real() + rate.real()),
            way_ * (-sine_.r * sine_.r * load.imag() + product(root_, rate).real())};
}

std::optional<double> SineArcs::first_zero(double most) const {
    Complex load = forced_, own = free_;
    double before = 0, v_before = 0;
    for (int i = 1; before < most; ++i) {
        load = product(load, forced_turn_);
        own = product(own, free_turn_);
        const double x = i * step_;
        const double v = way_ * (sine_.r * load.real() + root_.real() * own.real() - root_.imag() * own.imag());
        if (!(v > 0)) {
            constexpr int finer = 5;
            double part = x;
            for (int j = 0; before == 0 && j < finer; ++j) {
                part /= 4;
                v_before = speed(part).v;
                if (v_before > 0) before = part;
            }
            if (before == 0) return {};
            return zero_between(before, x, before + (x - before) * (v_before / (v_before - v)));
        }
        before = x, v_before = v;
    }
    return {};
}

/// Newton's method from a place where it still slides to one where it would slide back, kept between them.
double SineArcs::zero_between(double from, double to, double x) const {
    constexpr int most_steps = 60;
    constexpr double nearly = 1e-6;  // from there the next step leaves about rounding
    for (int i = 0; i < most_steps; ++i) {
        const Speed now = speed(x);
        (now.v > 0 ? from : to) = x;
        const double newton = x - now.v / now.slope;
        const double next = newton > from && newton < to ? newton : (from + to) / 2;
        const double moved = std::fabs(next - x);
        x = next;
        if (moved <= nearly * x) return x - speed(x).v / now.slope;
    }
    return x;
}

}  // namespace dinal::analysis::sine
