// Peer: SUNDIALS CVODE, Adams with fixed-point iteration and its own root finding.
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "peers.hpp"
#include "standstill.hpp"

namespace bench {
namespace {

template <class Load>
struct Motion {
    const Workload& work;
    Load load;
    int sign;

    static int slope(realtype t, N_Vector x, N_Vector d, void* self) {
        const Motion& m = *static_cast<const Motion*>(self);
        const double* p = N_VGetArrayPointer(x);
        double* q = N_VGetArrayPointer(d);
        q[0] = p[1];
        q[1] = omega0 * omega0 * (m.load(t) - p[0] - m.sign * m.work.friction_ratio) - 2 * m.work.zeta * omega0 * p[1];
        return 0;
    }
    static int velocity(realtype, N_Vector x, realtype* g, void*) {
        *g = N_VGetArrayPointer(x)[1];
        return 0;
    }
};

class Solver {
public:
    Solver(double u, double v, CVRhsFn slope, CVRootFn root, void* user) {
        SUNContext_Create(nullptr, &context_);
        x_ = N_VNew_Serial(2, context_);
        N_VGetArrayPointer(x_)[0] = u;
        N_VGetArrayPointer(x_)[1] = v;
        memory_ = CVodeCreate(CV_ADAMS, context_);
        CVodeInit(memory_, slope, 0, x_);
        CVodeSStolerances(memory_, 1e-10, 1e-12);
        CVodeSetUserData(memory_, user);
        CVodeSetMaxNumSteps(memory_, -1);
        iteration_ = SUNNonlinSol_FixedPoint(x_, 0, context_);
        CVodeSetNonlinearSolver(memory_, iteration_);
        CVodeRootInit(memory_, 1, root);
        CVodeSetNoInactiveRootWarn(memory_);
    }
    Solver(const Solver&) = delete;
    Solver& operator=(const Solver&) = delete;
    ~Solver() {
        CVodeFree(&memory_);
        SUNNonlinSolFree(iteration_);
        N_VDestroy(x_);
        SUNContext_Free(&context_);
    }

    double& u() { return N_VGetArrayPointer(x_)[0]; }
    double& v() { return N_VGetArrayPointer(x_)[1]; }
    void restart(double t, double end) {
        CVodeReInit(memory_, t, x_);
        CVodeSetStopTime(memory_, end);
    }
    /// One internal step, or less of it up to a root. True when it ended at a root.
    bool step(double end, double& t) { return CVode(memory_, end, x_, &t, CV_ONE_STEP) == CV_ROOT_RETURN; }

private:
    SUNContext context_ = nullptr;
    N_Vector x_ = nullptr;
    void* memory_ = nullptr;
    SUNNonlinearSolver iteration_ = nullptr;
};

template <class Load, class Watch>
double adams(const Workload& work, Load load, Watch& watch) {
    const double v0 = work.v0;
    Motion<Load> motion{work, load, v0 != 0 ? (v0 > 0 ? 1 : -1) : direction_from_standstill(work, load(0), work.u0)};
    Solver solver(work.u0, v0, Motion<Load>::slope, Motion<Load>::velocity, &motion);
    solver.restart(0, work.length);
    double t = 0;
    watch(0, work.u0);
    while (t < work.length) {
        if (motion.sign == 0) {
            t = release_time(work, load, t, solver.u());
            motion.sign = load(t) > solver.u() ? 1 : -1;
            if (t < work.length) {
                solver.restart(t, work.length);
            }
            watch(t, solver.u());
            continue;
        }
        // A turn without friction is only found: nothing restarts.
        if (solver.step(work.length, t) && work.friction_ratio != 0) {
            solver.v() = 0;
            motion.sign = direction_from_standstill(work, load(t), solver.u());
            if (motion.sign != 0) {
                solver.restart(t, work.length);
            }
        }
        watch(t, solver.u());
    }
    return solver.u();
}

template <class Watch>
double integrate(const Workload& work, Watch& watch) {
    return with_load(work, [&](auto load) { return adams(work, load, watch); });
}

}  // namespace

BENCH_PEER(cvode_peer, "CVODE Adams + roots", integrate);

}  // namespace bench
