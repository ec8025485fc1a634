// Peer: RK4 by hand with the sign of friction frozen and the step cut where the velocity is zero.
#include "peers.hpp"
#include "standstill.hpp"

namespace bench {
namespace {

struct Point {
    double u, v;
};

template <class Load>
struct Slope {
    const Workload& work;
    Load load;
    int sign;

    double operator()(double M, double u, double v) const {
        return omega0 * omega0 * (M - u - sign * work.friction_ratio) - 2 * work.zeta * omega0 * v;
    }
    Point step(double t, Point x, double h) const {
        const double m1 = load(t), m2 = load(t + h / 2), m3 = load(t + h);
        const double a1 = (*this)(m1, x.u, x.v), v2 = x.v + h / 2 * a1;
        const double a2 = (*this)(m2, x.u + h / 2 * x.v, v2), v3 = x.v + h / 2 * a2;
        const double a3 = (*this)(m2, x.u + h / 2 * v2, v3), v4 = x.v + h * a3;
        const double a4 = (*this)(m3, x.u + h * v3, v4);
        return {x.u + h / 6 * (x.v + 2 * v2 + 2 * v3 + v4), x.v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)};
    }
    /// How much of a step that ends at `y`, behind the standstill, is to be taken: its velocity is then zero.
    double cut(double t, Point x, Point y, double h) const {
        const auto velocity = [&](double part) { return step(t, x, part).v; };
        // A step that begins at a standstill leaves it first: the zero wanted is the second one.
        const double lo = x.v == 0 ? h * 1e-3 : 0;
        return root_between(lo, x.v == 0 ? velocity(lo) : x.v, h, y.v, velocity);
    }
};

template <class Load, class Watch>
double cut_steps(const Workload& work, Load load, double h, Watch& watch) {
    Point x{work.u0, work.v0};
    double t = 0, t_piece = 0;
    long steps = 0;  // in this piece: t is never summed up over many steps
    const auto new_piece = [&](double at) { t = t_piece = at, steps = 0; };
    Slope<Load> slope{work, load, x.v != 0 ? (x.v > 0 ? 1 : -1) : direction_from_standstill(work, load(0), x.u)};
    watch(0, x.u);
    while (t < work.length) {
        if (slope.sign == 0) {
            new_piece(release_time(work, load, t, x.u));
            watch(t, x.u);
            slope.sign = load(t) > x.u ? 1 : -1;
            continue;
        }
        const double taken = std::min(h, work.length - t);
        const Point y = slope.step(t, x, taken);
        if (slope.sign * y.v > 0 || taken < 1e-9) {
            x = y;
            t = taken < h ? work.length : t_piece + static_cast<double>(++steps) * h;
        } else if (work.friction_ratio == 0) {
            x = y;  // a turn changes nothing then
            slope.sign = -slope.sign;
            t = t_piece + static_cast<double>(++steps) * h;
        } else {
            const double part = slope.cut(t, x, y, taken);
            x = {slope.step(t, x, part).u, 0};
            new_piece(t + part);
            slope.sign = direction_from_standstill(work, load(t), x.u);
        }
        watch(t, x.u);
    }
    return x.u;
}

template <class Watch>
double integrate_fine(const Workload& work, Watch& watch) {
    return with_load(work, [&](auto load) { return cut_steps(work, load, 0.001, watch); });
}
template <class Watch>
double integrate_coarse(const Workload& work, Watch& watch) {
    return with_load(work, [&](auto load) { return cut_steps(work, load, 0.01, watch); });
}

}  // namespace

BENCH_PEER(cut_peer, "step-cut RK4 by hand, h = .001", integrate_fine);
BENCH_PEER(cut_peer_coarse, "step-cut RK4 by hand, h = .01", integrate_coarse);

}  // namespace bench
