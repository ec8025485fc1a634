// The stick and slip logic that each of the general integrators needs beside it, written once for the peers.
#pragma once

#include <cmath>
#include <type_traits>

#include "workload.hpp"

namespace bench {

/// At velocity zero: 0 sticks, else the direction of the motion that follows.
inline int direction_from_standstill(const Workload& work, double M, double u) {
    const double torque = M - u;
    return std::fabs(torque) <= work.friction_ratio ? 0 : torque > 0 ? 1 : -1;
}

/// A root of f in [lo, hi], f(lo) and f(hi) of opposite signs: false position with the Illinois correction.
template <class F>
double root_between(double lo, double f_lo, double hi, double f_hi, F f) {
    double x = hi;
    for (int i = 0, side = 0; i < 100 && hi - lo > 1e-15 * (1 + std::fabs(hi)); ++i) {
        x = hi - f_hi * (hi - lo) / (f_hi - f_lo);
        const double fx = f(x);
        if (fx == 0) {
            break;
        }
        const int now = (fx > 0) == (f_hi > 0) ? 1 : -1;
        (now > 0 ? hi : lo) = x;
        (now > 0 ? f_hi : f_lo) = fx;
        if (now == side) {
            (now > 0 ? f_lo : f_hi) /= 2;
        }
        side = now;
        if (std::fabs(fx) < 1e-15) {
            break;
        }
    }
    return x;
}

/// When a mass stuck at u from t on breaks away: the first time |M - u| passes gamma, or the end of the work.
template <class Load>
double release_time(const Workload& work, Load load, double t, double u) {
    if constexpr (std::is_same_v<Load, NoLoad>) {
        return work.length;
    }
    const auto excess = [&](double at) { return std::fabs(load(at) - u) - work.friction_ratio; };
    const double look = 0.01;
    double before = excess(t);
    while (t < work.length) {
        const double after = excess(t + look);
        if (after > 0) {
            // Just behind the root, so that the torque there points the way the mass goes.
            return std::nextafter(root_between(t, before, t + look, after, excess), work.length);
        }
        t += look;
        before = after;
    }
    return work.length;
}

}  // namespace bench
