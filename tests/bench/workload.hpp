// The four pieces of work that every peer and dinal do, in the report's nondimensional form.
//
//     u'' = w0^2 (M*(t) - u - gamma sgn u') - 2 zeta w0 u',   w0 = 2 pi,   M* = 0 or sin 2 pi t,   Re = Rd
#pragma once

#include <array>
#include <cmath>
#include <string_view>

namespace bench {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double omega0 = 2 * pi;

struct Workload {
    std::string_view name;
    double zeta;
    double friction_ratio;
    bool driven;
    double u0, v0;
    double length;  ///< in natural periods
};

inline constexpr std::array<Workload, 4> workloads = {{
    {"W1", 1e-4, 0, false, 0, 2 * pi, 1e4},
    {"W2", 0, 0.167, false, 0, 2 * pi, 3},
    {"W3", 0, 0.836, true, 1, 0, 1000},
    {"W4", 0.119, 0.418, true, 1, 0, 1000},
}};

struct NoLoad {
    double operator()(double) const { return 0; }
};
struct SineLoad {
    double operator()(double t) const { return std::sin(omega0 * t); }
};

/// Calls run(load) with the load as its own type, so that a free motion does not pay for a sine.
template <class Run>
double with_load(const Workload& work, Run run) {
    return work.driven ? run(SineLoad{}) : run(NoLoad{});
}

/// Looks at nothing: what a peer is timed with. `Comparison` is what its error is found with.
struct NoWatch {
    void operator()(double, double) const {}
};

}  // namespace bench
