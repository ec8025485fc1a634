// Runs with more in them against matrix exponentials: states, a moving belt, a shaking base, controllers that sample.
#include <cmath>
#include <functional>

#include "analysis/energy.hpp"
#include "model/extras.hpp"
#include "support/catch.hpp"
#include "support/linear_truth.hpp"
#include "support/measure.hpp"
#include "support/random_mixed.hpp"
#include "support/within.hpp"
#include "support/written.hpp"

namespace dinal::hybrid_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

/// Every row and every event. A time is the error of a velocity over its slope.
void check(const Trajectory& run, LinearTruth& truth, double tolerance,
           const std::function<void(LinearTruth&, double)>& go) {
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        const double t = run.rows(i, 0);
        go(truth, t);
        CAPTURE(i, t);
        CHECK(run.rows(i, 1) == within(static_cast<double>(truth.x()(0)), tolerance));
        CHECK(run.rows(i, 2) == within(static_cast<double>(truth.x()(1)), tolerance));
        for (Eigen::Index k = 6; k < run.rows.cols(); ++k) {
            CHECK(run.rows(i, k) == within(static_cast<double>(truth.x()(k - 4)), tolerance));
        }
    }
    std::string expected, found;
    for (const LinearEvent& event : truth.events) expected += event.kind + " ";
    for (const Event& event : run.events) {
        if (event.kind != EventKind::user) {
            found += std::string(event.kind == EventKind::rest ? "stick" : name(event.kind)) + " ";
        }
    }
    REQUIRE(found == expected);
    for (std::size_t i = 0; i < run.events.size(); ++i) {
        CAPTURE(i);
        CHECK(run.events[i].t == within(static_cast<double>(truth.events[i].t), 40 * tolerance));
        CHECK(run.events[i].theta == within(static_cast<double>(truth.events[i].theta), tolerance));
    }
}
void go_straight(LinearTruth& truth, double t) {
    truth.go(t);
}

Matrix rows(std::initializer_list<std::initializer_list<long double>> values) {
    const auto n = static_cast<Eigen::Index>(values.size());
    Matrix A = Matrix::Zero(n, n);
    Eigen::Index i = 0;
    for (const auto& row : values) {
        Eigen::Index j = 0;
        for (const long double x : row) A(i, j++) = x;
        ++i;
    }
    return A;
}
Form form(std::initializer_list<long double> values) {
    Form f(static_cast<Eigen::Index>(values.size()));
    Eigen::Index i = 0;
    for (const long double x : values) f(i++) = x;
    return f;
}
Vector vector_of(std::initializer_list<long double> values) {
    return form(values).transpose();
}

struct Integrated {
    const char* name;
    Integrator integrator;
    double tolerance;
};
/// rk4 by (w h)^4/120 over the run; a breakaway that comes a little later makes more of it.
const Integrated methods[] = {{"spectral", Spectral{}, 1e-11}, {"rk4", Rk4{0.002}, 1e-7}};

}  // namespace

TEST_CASE("a PID controller with its integral as a state hunts as matrix exponentials say", "[long][hybrid]") {
    const Oscillator block =
        Oscillator::make({.inertia = 1, .stiffness = 0, .kinetic_friction = 0.3, .breakaway = 0.5}).value();
    const Excitation M = feedback([](double, const State& y, std::span<const double> z) {
        return 8 * (1 - y.theta) - 2 * y.velocity + 3 * z[0];
    });
    Extras extras;
    extras.states.push_back(
        {.name = "e", .start = 0, .rate = written([](double, const State& y, auto) { return 1 - y.theta; })});
    const auto sliding = [](long double friction) {
        return rows({{0, 1, 0, 0}, {-8, -2, 3, 8 - friction}, {-1, 0, 0, 1}, {0, 0, 0, 0}});
    };
    for (const Integrated& method : methods) {
        CAPTURE(method.name);
        LinearTruth truth({sliding(0.3L), sliding(-0.3L), rows({{}, {}, {-1, 0, 0, 1}, {}}), form({0, 1, 0, 0}),
                           form({-8, 0, 3, 8}), 0.5L},
                          vector_of({0, 0, 0, 1}), 0.01L);
        const Trajectory run = run_more(block, M, {0, 0}, 150, 0.97, method.integrator, extras);
        check(run, truth, method.tolerance, go_straight);
        CHECK(run.events.size() > 6);  // the integral lets it go again and again
        CHECK(run.names().back() == "e");
        const auto z = run.course->states_at(17.123);
        truth = LinearTruth({sliding(0.3L), sliding(-0.3L), rows({{}, {}, {-1, 0, 0, 1}, {}}), form({0, 1, 0, 0}),
                             form({-8, 0, 3, 8}), 0.5L},
                            vector_of({0, 0, 0, 1}), 0.01L);
        truth.go(17.123);
        REQUIRE(z.size() == 1);
        CHECK(z[0] == within(static_cast<double>(truth.x()(2)), method.tolerance));
    }
}

TEST_CASE("a run with states goes on as if it had not been interrupted", "[hybrid]") {
    const Oscillator system =
        Oscillator::make({.inertia = 1, .stiffness = 1, .kinetic_friction = 0.1, .breakaway = 0.2}).value();
    const Excitation M =
        feedback([](double t, const State&, std::span<const double> z) { return std::sin(0.7 * t) + z[0]; });
    Extras extras;
    extras.states.push_back({.name = "a", .start = 0.3, .rate = written([](double, const State& y, auto z) {
                                                            return -0.5 * z[0] - 0.2 * y.velocity;
                                                        })});
    const Trajectory whole = run_more(system, M, {1, 0}, 30, 0.5, Spectral{}, extras);
    const Trajectory first = run_more(system, M, {1, 0}, 11.3, 0.5, Spectral{}, extras);
    const auto both = resume(system, M, first, 30, Grid::every(0.5), Spectral{}, {}, {}, extras);
    REQUIRE(both);
    REQUIRE(both->size() == whole.size());
    CHECK((both->rows.matrix() - whole.rows.matrix()).cwiseAbs().maxCoeff() < 1e-12);
    CHECK(both->events.size() == whole.events.size());
}

TEST_CASE("a stiff state, the lag of an actuator, costs no accuracy", "[hybrid]") {
    const Oscillator system = Oscillator::make({.inertia = 1, .stiffness = 1, .damping = 0.1}).value();
    const Excitation M = feedback([](double, const State&, std::span<const double> z) { return z[0]; });
    Extras extras;
    constexpr double lag = 6e-4;  // 1e-4 T0
    extras.states.push_back({.name = "u", .start = 0, .rate = written([](double, const State& y, auto z) {
                                                          return (-0.5 * y.velocity - z[0]) / lag;
                                                      })});
    const Matrix A = rows({{0, 1, 0}, {-1, -0.1L, 1}, {0, -0.5L / 6e-4L, -1 / 6e-4L}});
    const Trajectory run = run_more(system, M, {1, 0}, 20, 0.5, Spectral{}, extras);
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        const Vector x = exponential(A * static_cast<long double>(run.rows(i, 0))) * vector_of({1, 0, 0});
        CHECK(run.rows(i, 1) == within(static_cast<double>(x(0)), 1e-11));
        CHECK(run.rows(i, 6) == within(static_cast<double>(x(2)), 1e-10));
    }
}

TEST_CASE("a mass on a belt sticks to it and is torn off as matrix exponentials say", "[long][hybrid]") {
    const Oscillator system =
        Oscillator::make({.inertia = 1, .stiffness = 4, .damping = 0.1, .kinetic_friction = 0.3, .breakaway = 0.6})
            .value();
    // vb = 0.2 + 0.15 sin 3t as two more entries of x.
    for (const long double swing : {0.0L, 0.15L}) {
        Extras extras;
        extras.belt = Excitation::make(Constant{0.2}).value();
        if (swing > 0) extras.belt = extras.belt + Excitation::make(Harmonic{0.15, 3}).value();
        const auto sliding = [&](long double friction) {
            return rows(
                {{0, 1, 0, 0, 0}, {-4, -0.1L, 0, 0, -friction}, {0, 0, 0, 3, 0}, {0, 0, -3, 0, 0}, {0, 0, 0, 0, 0}});
        };
        const Matrix stuck =
            rows({{0, 0, swing, 0, 0.2L}, {0, 0, 0, 3 * swing, 0}, {0, 0, 0, 3, 0}, {0, 0, -3, 0, 0}, {0, 0, 0, 0, 0}});
        for (const Integrated& method : methods) {
            CAPTURE(method.name, static_cast<double>(swing));
            LinearTruth truth({sliding(0.3L), sliding(-0.3L), stuck, form({0, 1, -swing, 0, -0.2L}),
                               form({-4, 0, -0.1L * swing, -3 * swing, -0.02L}), 0.6L},
                              vector_of({0.3L, 0, 0, 1, 1}), 0.01L);
            const Trajectory run = run_more(system, {}, {0.3, 0}, 30, 0.37, method.integrator, extras);
            check(run, truth, method.tolerance, go_straight);
            CHECK(run.events.size() > 8);
        }
        const Trajectory run = run_more(system, {}, {0.3, 0}, 30, 0.37, Spectral{}, extras);
        const auto energy = analysis::energy_of(run);
        REQUIRE(energy);
        CHECK(std::fabs(energy->total.error()) < 1e-12);
        CHECK(energy->total.work.belt > 0.1);
        CHECK(energy->total.work.input == 0);
        const auto columns = analysis::energy_columns(run);
        CHECK(columns.col(static_cast<Eigen::Index>(analysis::EnergyColumn::error)).cwiseAbs().maxCoeff() < 1e-12);
    }
}

TEST_CASE("a belt that starts with a jerk leaves the mass behind", "[hybrid]") {
    // The mass lies still until the belt jumps to 1, then slips backward on it: theta'' = Rd, until it is as fast.
    const Oscillator block =
        Oscillator::make({.inertia = 1, .stiffness = 0, .kinetic_friction = 0.25, .breakaway = 0.5}).value();
    Extras extras;
    extras.belt = Excitation::make(Step{1, 2}).value();
    for (const Integrated& method : methods) {
        const Trajectory run = run_more(block, {}, {0, 0}, 10, 1, method.integrator, extras);
        CAPTURE(method.name);
        REQUIRE(run.events.size() == 2);
        CHECK(run.events[0].kind == EventKind::slip);
        CHECK(run.events[0].t == 2);
        CHECK(run.events[1].t == within(6, 1e-12));
        CHECK(run.events[1].theta == within(2, 1e-12));
        CHECK(run.events[1].velocity == within(1, 1e-12));
        CHECK(run.state_at_stop.theta == within(6, 1e-12));
    }
}

TEST_CASE("a base that shakes is a load of -I a(t), and does its own work", "[hybrid]") {
    const Oscillator system =
        Oscillator::make({.inertia = 2, .stiffness = 3, .damping = 0.1, .kinetic_friction = 0.2, .breakaway = 0.4})
            .value();
    Extras extras;
    extras.base = Excitation::make(Harmonic{0.7, 1.3}).value();
    const Trajectory shaken = run_more(system, {}, {0.1, 0}, 40, 0.5, Spectral{}, extras);
    const Trajectory driven = must_run(system, extras.base.scaled(-2), {0.1, 0}, {0, 40}, Grid::every(0.5), Spectral{});
    REQUIRE(shaken.events.size() == driven.events.size());
    for (const Column column : {Column::theta, Column::velocity, Column::friction}) {
        CHECK((shaken.column(column) - driven.column(column)).cwiseAbs().maxCoeff() < 1e-11);
    }
    CHECK(shaken.column(Column::M).cwiseAbs().maxCoeff() == 0);
    const auto a = analysis::energy_of(shaken), b = analysis::energy_of(driven);
    REQUIRE((a && b));
    CHECK(a->total.work.base == within(b->total.work.input, 1e-11));
    CHECK(std::fabs(a->total.error()) < 1e-12);
}

TEST_CASE("a controller that samples is called once an instant, in order, and its output is held", "[hybrid]") {
    const Oscillator system =
        Oscillator::make({.inertia = 1, .stiffness = 1, .kinetic_friction = 0.05, .breakaway = 0.1}).value();
    constexpr double every = 0.25, delay = 0.1;
    std::vector<double> asked;
    auto controller = std::make_shared<SampledController>();
    controller->every = every, controller->delay = delay;
    controller->function = written([&](double t, const State& y, auto) {
        asked.push_back(t);
        return -0.9 * y.theta - 0.3 * y.velocity;
    });
    const Excitation M = Excitation::make(Scripted{.function = controller, .feedback = true}).value();
    const auto sliding = [](long double friction) {
        return rows({{0, 1, 0, 0}, {-1, 0, 1, -friction}, {0, 0, 0, 0}, {0, 0, 0, 0}});
    };
    for (const Integrated& method : methods) {
        CAPTURE(method.name);
        asked.clear();
        const Trajectory run = run_more(system, M, {1, 0}, 12, 0.05, method.integrator, {});
        REQUIRE(asked.size() == 49);
        for (std::size_t i = 0; i < asked.size(); ++i) CHECK(asked[i] == every * static_cast<double>(i));
        LinearTruth truth(
            {sliding(0.05L), sliding(-0.05L), Matrix::Zero(4, 4), form({0, 1, 0, 0}), form({-1, 0, 1, 0}), 0.1L},
            vector_of({1, 0, 0, 1}), 0.01L);
        int instant = 0;
        long double output = 0;
        const auto go = [&](LinearTruth& motion, double t) {
            for (;;) {
                const long double sample = static_cast<long double>(every) * (instant / 2);
                const long double next = instant % 2 == 0 ? sample : sample + static_cast<long double>(delay);
                if (next > static_cast<long double>(t)) break;
                motion.go(next);
                if (instant % 2 == 0) {
                    output = -0.9L * motion.x()(0) - 0.3L * motion.x()(1);
                } else {
                    motion.change([&](Vector& x, LinearSystem&) { x(2) = output; });
                }
                ++instant;
            }
            motion.go(t);
        };
        check(run, truth, method.tolerance, go);
        // Going on calls no instant again.
        asked.clear();
        const Trajectory first = run_more(system, M, {1, 0}, 5, 0.05, method.integrator, {});
        const auto both = resume(system, M, first, 12, Grid::every(0.05), method.integrator);
        REQUIRE(both);
        CHECK(asked.size() == 49);
        CHECK((both->rows.matrix() - run.rows.matrix()).cwiseAbs().maxCoeff() < method.tolerance);
    }
}

TEST_CASE("systems of all kinds by lot agree with an independent integrator, event by event", "[long][hybrid][mixed]") {
    check_random_mixed(300);
}

}  // namespace dinal::hybrid_test
