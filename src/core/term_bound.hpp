// The most that |term| ever is; `never` when nothing is known.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/terms.hpp"

namespace dinal::terms {

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

}  // namespace dinal::terms
