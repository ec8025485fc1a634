// Peer: what a programmer writes first. The scheme of 1989 in double precision, all inlined, sgn at every stage.
#include "peers.hpp"

namespace bench {
namespace {

double sgn(double x) {
    return static_cast<double>((x > 0) - (x < 0));
}

template <class Load, class Watch>
double rk4_of_1989(const Workload& work, Load load, Watch& watch) {
    const double h = 0.001;
    const double a = 2 * work.zeta * omega0, c = omega0 * omega0, b = work.friction_ratio * c;
    const auto steps = static_cast<long>(std::lround(work.length / h));
    double u = work.u0, v = work.v0;
    watch(0, u);
    for (long i = 0; i < steps; ++i) {
        const double t = static_cast<double>(i) * h;
        const double f1 = c * load(t), f2 = c * load(t + h / 2), f3 = c * load(t + h);
        const double p1 = h * v, q1 = h * (f1 - c * u - b * sgn(v) - a * v);
        const double v2 = v + q1 / 2;
        const double p2 = h * v2, q2 = h * (f2 - c * (u + p1 / 2) - b * sgn(v2) - a * v2);
        const double v3 = v + q2 / 2;
        const double p3 = h * v3, q3 = h * (f2 - c * (u + p2 / 2) - b * sgn(v3) - a * v3);
        const double v4 = v + q3;
        const double p4 = h * v4, q4 = h * (f3 - c * (u + p3) - b * sgn(v4) - a * v4);
        const double u_old = u, v_old = v;
        u += (p1 + 2 * p2 + 2 * p3 + p4) / 6;
        v += (q1 + 2 * q2 + 2 * q3 + q4) / 6;
        if (std::fabs(v) <= std::fabs(v_old - v) && std::fabs(f3 - c * u) <= b) {
            u = u_old;
            v = v_old;
        }
        watch(static_cast<double>(i + 1) * h, u);
    }
    return u;
}

template <class Watch>
double integrate(const Workload& work, Watch& watch) {
    return with_load(work, [&](auto load) { return rk4_of_1989(work, load, watch); });
}

}  // namespace

BENCH_PEER(inlined_peer, baseline, integrate);

}  // namespace bench
