// What is known of a term of an excitation for all time: from when on it is constant, and what it never exceeds.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "model/terms.hpp"

namespace dinal::model::terms {

// ---- from when on a term is constant; -never when it always is

inline double settles(double amplitude, double time) {
    return amplitude == 0 ? -never : time;
}
inline double constant_from(const Constant&) {
    return -never;
}
inline double constant_from(const Harmonic& h) {
    return h.omega == 0 ? -never : settles(h.amplitude, never);
}
inline double constant_from(const Step& s) {
    return settles(s.level, s.at);
}
inline double constant_from(const Pulse& p) {
    return settles(p.amplitude, p.at + p.width);
}
inline double constant_from(const HalfSine& h) {
    return settles(h.amplitude, h.at + h.width);
}
inline double constant_from(const Ramp& r) {
    return settles(r.slope, r.at + r.width);
}
inline double constant_from(const Square& s) {
    return settles(s.amplitude, never);
}
inline double constant_from(const Sawtooth& s) {
    return settles(s.amplitude, never);
}
inline double constant_from(const Triangle& s) {
    return settles(s.amplitude, never);
}
inline double constant_from(const Chirp& c) {
    return settles(c.amplitude, c.to > 0 ? never : c.from > 0 ? c.at + c.duration : -never);
}
inline double constant_from(const Exponential& e) {
    return settles(e.amplitude, never);
}
inline double constant_from(const Polynomial& p) {
    const auto varies = [](double c) { return c != 0; };
    return p.coefficients.size() < 2 || std::none_of(p.coefficients.begin() + 1, p.coefficients.end(), varies) ? -never
                                                                                                               : never;
}
inline double constant_from(const std::shared_ptr<const Samples>& s) {
    return s->t.size() == 1 ? -never : s->t.back();
}
inline double constant_from(const Scripted&) {
    return never;
}

// ---- the most that |term| ever is; `never` when nothing is known

inline double most(const Constant& c) {
    return std::fabs(c.level);
}
inline double most(const Harmonic& h) {
    return std::fabs(h.amplitude);
}
inline double most(const Step& s) {
    return std::fabs(s.level);
}
inline double most(const Ramp& r) {
    return r.slope == 0 ? 0 : std::fabs(r.slope * r.width);
}
inline double most(const Exponential& e) {
    return e.amplitude == 0 ? 0 : e.tau > 0 ? std::fabs(e.amplitude) : never;
}
inline double most(const Polynomial& p) {
    return p.coefficients.size() < 2 ? std::fabs(value(p, 0)) : never;
}
inline double most(const std::shared_ptr<const Samples>& s) {
    double peak = 0;
    for (const double M : s->M) peak = std::max(peak, std::fabs(M));
    return peak;
}
inline double most(const Scripted&) {
    return never;
}
template <class T>
double most(const T& term) {
    return std::fabs(term.amplitude);
}

/// Once constant, these are zero.
inline constexpr bool ends_at_zero(const Pulse&) {
    return true;
}
inline constexpr bool ends_at_zero(const HalfSine&) {
    return true;
}
template <class T>
constexpr bool ends_at_zero(const T&) {
    return false;
}

}  // namespace dinal::model::terms
