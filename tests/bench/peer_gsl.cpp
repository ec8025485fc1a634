// Peer: GSL, Prince-Dormand 8(9); velocity zero by stepping again with a shorter step.
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include <memory>

#include "peers.hpp"
#include "standstill.hpp"

namespace bench {
namespace {

template <class Load>
struct Motion {
    const Workload& work;
    Load load;
    int sign;

    static int slope(double t, const double x[], double d[], void* self) {
        const Motion& m = *static_cast<const Motion*>(self);
        d[0] = x[1];
        d[1] = omega0 * omega0 * (m.load(t) - x[0] - m.sign * m.work.friction_ratio) - 2 * m.work.zeta * omega0 * x[1];
        return GSL_SUCCESS;
    }
};

struct Solver {
    static constexpr double tolerance = 1e-12;
    std::unique_ptr<gsl_odeiv2_step, decltype(&gsl_odeiv2_step_free)> step{
        gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk8pd, 2), gsl_odeiv2_step_free};
    std::unique_ptr<gsl_odeiv2_control, decltype(&gsl_odeiv2_control_free)> control{
        gsl_odeiv2_control_y_new(tolerance, tolerance), gsl_odeiv2_control_free};
    std::unique_ptr<gsl_odeiv2_evolve, decltype(&gsl_odeiv2_evolve_free)> evolve{gsl_odeiv2_evolve_alloc(2),
                                                                                 gsl_odeiv2_evolve_free};

    void restart() const {
        gsl_odeiv2_step_reset(step.get());
        gsl_odeiv2_evolve_reset(evolve.get());
    }
    void single(const gsl_odeiv2_system& system, double t, double h, const double from[], double to[]) const {
        double error[2];
        to[0] = from[0], to[1] = from[1];
        gsl_odeiv2_step_reset(step.get());
        gsl_odeiv2_step_apply(step.get(), t, h, to, error, nullptr, nullptr, &system);
    }
};

template <class Load, class Watch>
double rk8pd(const Workload& work, Load load, Watch& watch) {
    const Solver solver;
    double x[2] = {work.u0, work.v0}, before[2];
    Motion<Load> motion{work, load, x[1] != 0 ? (x[1] > 0 ? 1 : -1) : direction_from_standstill(work, load(0), x[0])};
    const gsl_odeiv2_system system{Motion<Load>::slope, nullptr, 2, &motion};
    double t = 0, h = 1e-2;
    watch(0, x[0]);
    while (t < work.length) {
        if (motion.sign == 0) {
            t = release_time(work, load, t, x[0]);
            motion.sign = load(t) > x[0] ? 1 : -1;
            watch(t, x[0]);
            continue;
        }
        before[0] = x[0], before[1] = x[1];
        const double t_before = t;
        gsl_odeiv2_evolve_apply(solver.evolve.get(), solver.control.get(), solver.step.get(), &system, &t, work.length,
                                &h, x);
        if (motion.sign * x[1] < 0) {
            double at[2];
            const auto velocity = [&](double part) {
                solver.single(system, t_before, part, before, at);
                return at[1];
            };
            const double whole = t - t_before, lo = before[1] == 0 ? whole * 1e-3 : 0;
            const double part = root_between(lo, before[1] == 0 ? velocity(lo) : before[1], whole, x[1], velocity);
            if (work.friction_ratio == 0) {
                motion.sign = -motion.sign;  // a turn is only found then; nothing restarts
            } else {
                velocity(part);
                x[0] = at[0], x[1] = 0;
                t = t_before + part;
                motion.sign = direction_from_standstill(work, load(t), x[0]);
                solver.restart();
            }
        }
        watch(t, x[0]);
    }
    return x[0];
}

template <class Watch>
double integrate(const Workload& work, Watch& watch) {
    return with_load(work, [&](auto load) { return rk8pd(work, load, watch); });
}

}  // namespace

BENCH_PEER(gsl_peer, "GSL rk8pd", integrate);

}  // namespace bench
