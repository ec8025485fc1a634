// Peer: Boost.odeint, dopri5 with dense output, bisection for velocity zero.
#include <boost/numeric/odeint.hpp>

#include "peers.hpp"
#include "standstill.hpp"

namespace bench {
namespace {

namespace odeint = boost::numeric::odeint;
using Point = std::array<double, 2>;

template <class Stepper>
double bisect_standstill(Stepper& stepper, double lo, double hi, int sign) {
    Point at{};
    while (hi - lo > 1e-15 * (1 + hi)) {
        const double middle = (lo + hi) / 2;
        if (middle <= lo || middle >= hi) {
            break;
        }
        stepper.calc_state(middle, at);
        (sign * at[1] > 0 ? lo : hi) = middle;
    }
    return hi;
}

template <class Load, class Watch>
double dopri5(const Workload& work, Load load, Watch& watch) {
    const double tolerance = 1e-10, first_step = 1e-3;
    Point x{work.u0, work.v0};
    int sign = x[1] != 0 ? (x[1] > 0 ? 1 : -1) : direction_from_standstill(work, load(0), x[0]);
    const auto slope = [&](const Point& p, Point& d, double t) {
        d[0] = p[1];
        d[1] = omega0 * omega0 * (load(t) - p[0] - sign * work.friction_ratio) - 2 * work.zeta * omega0 * p[1];
    };
    auto stepper = odeint::make_dense_output(tolerance, tolerance, odeint::runge_kutta_dopri5<Point>());
    double t = 0;
    stepper.initialize(x, t, first_step);
    watch(0, x[0]);
    while (t < work.length) {
        if (sign == 0) {
            t = release_time(work, load, t, x[0]);
            sign = load(t) > x[0] ? 1 : -1;
            stepper.initialize(x, t, first_step);
            watch(t, x[0]);
            continue;
        }
        stepper.do_step(slope);
        t = stepper.current_time();
        if (t >= work.length) {
            t = work.length;
        }
        stepper.calc_state(t, x);
        if (sign * x[1] < 0) {
            const double event = bisect_standstill(stepper, stepper.previous_time(), t, sign);
            if (work.friction_ratio == 0) {
                sign = -sign;  // a turn is only found then; nothing restarts
            } else {
                stepper.calc_state(event, x);
                x[1] = 0;
                t = event;
                sign = direction_from_standstill(work, load(t), x[0]);
                stepper.initialize(x, t, first_step);
            }
        }
        watch(t, x[0]);
    }
    return x[0];
}

template <class Watch>
double integrate(const Workload& work, Watch& watch) {
    return with_load(work, [&](auto load) { return dopri5(work, load, watch); });
}

}  // namespace

BENCH_PEER(odeint_peer, "Boost.odeint dopri5 + bisection", integrate);

}  // namespace bench
