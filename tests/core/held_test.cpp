// Controllers that hold what they give: between their instants, and between the switches of a relay, the motion is a
// damped oscillation about a place that stays. Against matrix exponentials in long double, and against arcs by hand.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "analysis/energy.hpp"
#include "model/extras.hpp"
#include "support/catch.hpp"
#include "support/linear_truth.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"
#include "support/written.hpp"

namespace dinal::held_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

/// A plant in units of about 1, and a controller that asks for what is written in `law`; torques and inertia are
/// `scale` times as great, which changes no motion.
struct Plant {
    const char* name;
    double I, k, C, Rd, Re;
    double every, delay;
    double P, D;
    double scale = 1;
};

/// What M is besides the controller: of x = (theta, velocity, output, sine, cosine, exponential, line, slope, 1).
struct Beside {
    double sine = 0, omega = 0.7;
    double fading = 0;  ///< times exp(-t/5)
    bool samples = false;
};
enum Place { at_theta, at_velocity, at_output, at_sine, at_cosine, at_exponential, at_line, at_slope, at_one, places };

const double sample_times[] = {0, 1.3, 2.9, 5.1, 8, 20}, sample_values[] = {0.1, 0.4, -0.3, 0.2, -0.1, 0.3};

std::shared_ptr<SampledController> controller_of(const Plant& p) {
    auto controller = std::make_shared<SampledController>();
    controller->every = p.every, controller->delay = p.delay;
    controller->function =
        written([p](double, const State& y, auto) { return p.scale * (-p.P * y.theta - p.D * y.velocity); });
    return controller;
}

Excitation load_of(const Plant& p, const Beside& beside) {
    Excitation M = Excitation::make(Scripted{.function = controller_of(p), .feedback = true}).value();
    if (beside.sine != 0) M = M + Excitation::make(Harmonic{p.scale * beside.sine, beside.omega}).value();
    if (beside.fading != 0) {
        const auto fades = [a = p.scale * beside.fading](double t, const State&, auto) { return a * std::exp(-t / 5); };
        M = M + Excitation::make(Scripted{.function = written(fades)}).value();
    }
    if (beside.samples) {
        Samples samples;
        samples.t.assign(std::begin(sample_times), std::end(sample_times));
        for (const double m : sample_values) samples.M.push_back(p.scale * m);
        M = M + Excitation::make(Polyline{std::make_shared<const Samples>(std::move(samples))}).value();
    }
    return M;
}

LinearTruth truth_of(const Plant& p, const Beside& beside, State start) {
    const auto real = [](double x) { return static_cast<long double>(x); };
    Matrix sliding = Matrix::Zero(places, places);
    sliding(at_theta, at_velocity) = 1;
    const long double per = 1 / real(p.I);
    sliding(at_velocity, at_theta) = -real(p.k) * per, sliding(at_velocity, at_velocity) = -real(p.C) * per;
    Form pull = Form::Zero(places), slip = Form::Zero(places);
    pull(at_theta) = -real(p.k), slip(at_velocity) = 1;
    for (const Place place : {at_output, at_sine, at_exponential, at_line})
        sliding(at_velocity, place) = per, pull(place) = 1;
    sliding(at_sine, at_cosine) = real(beside.omega), sliding(at_cosine, at_sine) = -real(beside.omega);
    sliding(at_exponential, at_exponential) = -1 / 5.0L;
    sliding(at_line, at_slope) = 1;
    Matrix stuck = sliding;
    stuck.row(at_theta).setZero(), stuck.row(at_velocity).setZero();
    Matrix forward = sliding, backward = sliding;
    forward(at_velocity, at_one) = -real(p.Rd) * per, backward(at_velocity, at_one) = real(p.Rd) * per;
    Vector x = Vector::Zero(places);
    x(at_theta) = real(start.theta), x(at_velocity) = real(start.velocity), x(at_one) = 1;
    x(at_cosine) = real(beside.sine), x(at_exponential) = real(beside.fading);
    return {{forward, backward, stuck, slip, pull, real(p.Re)}, x, 0.05L};
}

/// From jump to jump: instants, outputs that come late, corners of the samples.
class Followed {
public:
    Followed(const Plant& p, const Beside& beside, State start)
        : p_(p), beside_(beside), truth_(truth_of(p, beside, start)) {}
    LinearTruth& at(double t) {
        for (;;) {
            const double sample = p_.every * instant_, comes = p_.every * output_ + p_.delay;
            const double corner = beside_.samples ? sample_times[corner_] : never;
            const double next = std::min({sample, comes, corner});
            if (next > t) break;
            truth_.go(static_cast<long double>(next));
            if (next == corner) turn_corner();
            if (next == sample) {
                const auto& x = truth_.x();
                asked_.push_back(-static_cast<long double>(p_.P) * x(at_theta) -
                                 static_cast<long double>(p_.D) * x(at_velocity));
                ++instant_;
            }
            if (next == comes && output_ < instant_) {
                const long double output = asked_[static_cast<std::size_t>(output_++)];
                truth_.change([output](Vector& x, LinearSystem&) { x(at_output) = output; });
            }
        }
        truth_.go(static_cast<long double>(t));
        return truth_;
    }

private:
    void turn_corner() {
        const std::size_t i = corner_++;
        const long double length =
            static_cast<long double>(sample_times[i + 1]) - static_cast<long double>(sample_times[i]);
        const long double level = static_cast<long double>(sample_values[i]);
        const long double slope = (static_cast<long double>(sample_values[i + 1]) - level) / length;
        truth_.change([=](Vector& x, LinearSystem&) { x(at_line) = level, x(at_slope) = slope; });
    }
    Plant p_;
    Beside beside_;
    LinearTruth truth_;
    int instant_ = 0, output_ = 0;
    std::size_t corner_ = 0;
    std::vector<long double> asked_;
};

Oscillator system_of(const Plant& p) {
    return Oscillator::make({.inertia = p.scale * p.I,
                             .stiffness = p.scale * p.k,
                             .damping = p.scale * p.C,
                             .kinetic_friction = p.scale * p.Rd,
                             .breakaway = p.scale * p.Re})
        .value();
}

std::string kinds(const Trajectory& run) {
    std::string all;
    for (const Event& event : run.events) {
        all += std::string(event.kind == EventKind::rest ? "stick" : name(event.kind)) + " ";
    }
    return all;
}

/// Rows, events, the motion between the rows, and the energy.
void check(const Plant& p, const Beside& beside, State start, double t_end) {
    CAPTURE(p.name, p.scale);
    // Some hundred pieces, each right to rounding, of motions of size 1.
    constexpr double tolerance = 2e-13, of_time = 5e-12;
    const Oscillator system = system_of(p);
    const Excitation M = load_of(p, beside);
    const Trajectory run = run_more(system, M, start, t_end, 0.0917, Spectral{}, {});
    Followed truth(p, beside, start);
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        const double t = run.rows(i, 0);
        const auto& x = truth.at(t).x();
        CAPTURE(i, t);
        CHECK(run.rows(i, 1) == within(static_cast<double>(x(at_theta)), tolerance));
        CHECK(run.rows(i, 2) == within(static_cast<double>(x(at_velocity)), tolerance));
        const double load = static_cast<double>(x(at_output) + x(at_sine) + x(at_exponential) + x(at_line));
        CHECK(run.rows(i, 3) / p.scale == within(load, 4 * tolerance));
    }
    // What the first instant sets in motion is no event.
    std::vector<LinearEvent> expected = truth.at(t_end).events;
    if (!expected.empty() && expected.front().t == 0) expected.erase(expected.begin());
    std::string told;
    for (const LinearEvent& event : expected) told += event.kind + " ";
    REQUIRE(kinds(run) == told);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i);
        CHECK(run.events[i].t == within(static_cast<double>(expected[i].t), of_time));
        CHECK(run.events[i].theta == within(static_cast<double>(expected[i].theta), tolerance));
    }
    Followed again(p, beside, start);
    for (const double t : {0.123, 1.7, 4.44, 0.77 * t_end}) {
        const auto y = run.course->at(t);
        REQUIRE(y);
        CHECK(y->theta == within(static_cast<double>(again.at(t).x()(at_theta)), tolerance));
        CHECK(y->velocity == within(static_cast<double>(again.at(t).x()(at_velocity)), tolerance));
    }
    const auto energy = analysis::energy_of(run);
    REQUIRE(energy);
    CHECK(std::fabs(energy->total.error()) / p.scale < 1e-12);
    // Interrupted, and gone on with.
    const Trajectory first = run_more(system, M, start, 0.43 * t_end, 0.0917, Spectral{}, {});
    const auto both = resume(system, M, first, t_end, Grid::every(0.0917), Spectral{});
    REQUIRE(both);
    CHECK((both->rows.matrix().middleCols(1, 2) - run.rows.matrix().middleCols(1, 2)).cwiseAbs().maxCoeff() <
          tolerance);
    CHECK(kinds(*both) == kinds(run));
}

}  // namespace

TEST_CASE("between the instants of a controller that samples the motion is a free one, at every damping",
          "[long][hybrid][held]") {
    const double hair = 1e-12;
    for (const Plant& p : {
             Plant{"dry", 1, 1, 0.1, 0.05, 0.08, 0.0628, 0, 0.5, 0.2},
             Plant{"no damping", 1.3, 2, 0, 0.1, 0.15, 0.11, 0, 0.7, 0},
             Plant{"late", 1, 1, 0.1, 0.05, 0.08, 0.25, 0.1, 0.9, 0.3},
             Plant{"later than the next instant", 1, 1, 0.1, 0.05, 0.08, 0.2, 0.31, 0.2, 0.1},
             Plant{"just below critical", 1, 1, 2 - 2 * hair, 0.02, 0.05, 0.13, 0, 3, 0.1},
             Plant{"critical", 1, 1, 2, 0.02, 0.05, 0.13, 0, 3, 0.1},
             Plant{"just above critical", 1, 1, 2 + 2 * hair, 0.02, 0.05, 0.13, 0, 3, 0.1},
             Plant{"far above critical", 1, 1, 9, 0.02, 0.05, 0.13, 0, 3, 0.1},
             Plant{"no spring", 1, 0, 0.2, 0.05, 0.09, 0.21, 0.02, 0.8, 0.4},
             Plant{"no spring, no damping", 1, 0, 0, 0.05, 0.09, 0.21, 0, 0.8, 0.4},
             Plant{"holds what it brakes", 1, 1, 0.05, 0.1, 0.1, 0.17, 0, 0.4, 0.1},
             Plant{"no friction", 1, 1, 0.05, 0, 0, 0.17, 0, 0.4, 0.1},
             Plant{"slow instants", 1, 1, 0.05, 0.03, 0.05, 5.3, 1.1, 0.4, 0.1},
         }) {
        check(p, {}, {1, 0}, 15);
        check(p, {}, {0.3, -0.6}, 15);
    }
}

TEST_CASE("the units of a torque change nothing where a controller samples", "[hybrid][held]") {
    for (const double scale : {1e-12, 1e12}) {
        check({"scaled", 1, 1, 0.1, 0.05, 0.08, 0.25, 0.1, 0.9, 0.3, scale}, {}, {1, 0}, 12);
        check({"scaled, no spring", 1, 0, 0.1, 0.05, 0.08, 0.25, 0.1, 0.9, 0.3, scale}, {}, {1, 0}, 12);
    }
}

TEST_CASE("a controller that samples adds to a harmonic, to samples and to a Lua function", "[long][hybrid][held]") {
    const Plant dry{"dry", 1, 1, 0.1, 0.05, 0.08, 0.1, 0.03, 0.5, 0.2},
        free{"free", 1, 1, 0.1, 0, 0, 0.1, 0.03, 0.5, 0.2},
        floating{"floating", 1, 0, 0.1, 0.05, 0.08, 0.1, 0, 0.5, 0.2};
    for (const Plant& p : {dry, free, floating}) {
        check(p, {.sine = 0.8}, {1, 0}, 15);
        check(p, {.fading = 0.6}, {1, 0}, 15);
        check(p, {.samples = true}, {1, 0}, 15);
        check(p, {.sine = 0.4, .fading = -0.5, .samples = true}, {0.2, 0.4}, 15);
    }
}

TEST_CASE("a mass at rest is let go at the instant that a held torque passes Re", "[hybrid][held]") {
    // 0.2, 0.4, ... at 0, 1, ...: what passes Re = 0.5 comes at t = 2, delayed by 0.25. Then parabolas.
    const Oscillator block =
        Oscillator::make({.inertia = 1, .stiffness = 0, .kinetic_friction = 0.1, .breakaway = 0.5}).value();
    auto controller = std::make_shared<SampledController>();
    controller->every = 1, controller->delay = 0.25;
    controller->function = written([](double t, const State&, auto) { return t < 3 ? 0.2 * (1 + t) : -0.9; });
    const Excitation M = Excitation::make(Scripted{.function = controller, .feedback = true}).value();
    const Trajectory run = run_more(block, M, {0, 0}, 5, 0.5, Spectral{}, {});
    REQUIRE(run.events.size() >= 2);
    CHECK(kinds(run).substr(0, 10) == "slip turn ");
    CHECK(run.events[0].t == 2.25);
    // At t = 3.25 the velocity is 0.5, then it loses 1 a time unit: it turns, as 0.9 is more than Re.
    CHECK(run.events[1].t == within(3.75, 1e-14));
    CHECK(run.events[1].theta == within(0.375, 1e-14));
    CHECK(run.outcome == Outcome::reached_end);
}

TEST_CASE("a relay of the velocity that switches at zero does so at each turn", "[hybrid][held]") {
    const Oscillator system =
        Oscillator::make({.inertia = 1, .stiffness = 1, .kinetic_friction = 0.05, .breakaway = 0.07}).value();
    auto relay = std::make_shared<RelayController>();
    relay->of = RelayController::Of::velocity;
    relay->on = 0.2, relay->off = 0, relay->levels = {0.3, -0.3};
    const Excitation M = Excitation::make(Scripted{.function = relay, .feedback = true}).value();
    const Trajectory run = run_more(system, M, {-1, 0.1}, 6, 0.1, Spectral{}, {});
    // Under 0.3 - 0.05 about the place 0.25 until the velocity is zero, which is where the relay switches, too.
    const double place = 0.25, amplitude = std::hypot(1 + place, 0.1);
    const double turn = std::numbers::pi - std::atan2(0.1, 1 + place);
    REQUIRE(run.events.size() >= 2);
    CHECK(run.events[0].t == within(turn, 1e-14));
    CHECK(run.events[1].t == within(turn, 1e-13));
    CHECK(run.events[0].theta == within(place + amplitude, 1e-14));
    const std::string first = kinds(run).substr(0, 12);
    CHECK((first == "turn switch " || first == "switch turn "));
    // Then under -0.3 + 0.05 about -0.25.
    const double back = place + amplitude + 0.25, t = turn + 1.2;
    const auto y = run.course->at(t);
    REQUIRE(y);
    CHECK(y->theta == within(-0.25 + back * std::cos(1.2), 1e-13));
    CHECK(y->velocity == within(-back * std::sin(1.2), 1e-13));
}

TEST_CASE("a relay makes the limit cycle that arcs by hand make", "[hybrid][held]") {
    // Without damping: about the place of each level less friction the motion is a circle in (theta, velocity).
    for (const double Rd : {0.0, 0.02}) {
        CAPTURE(Rd);
        const Oscillator system =
            Oscillator::make({.inertia = 1, .stiffness = 1, .kinetic_friction = Rd, .breakaway = 1.5 * Rd}).value();
        auto relay = std::make_shared<RelayController>();
        relay->on = -0.1, relay->off = 0.1, relay->levels = {0.4, -0.4};
        const Excitation M = Excitation::make(Scripted{.function = relay, .feedback = true}).value();
        const Trajectory run = run_more(system, M, {-0.05, 0.5}, 40, 0.25, Spectral{}, {});
        long double t = 0, theta = -0.05L, v = 0.5L, level = 0.4L;
        std::size_t event = 0;
        int switches = 0;
        for (;; ++event) {
            const long double way = v > 0 || (v == 0 && level > theta) ? 1 : -1;
            const long double place = level - way * static_cast<long double>(Rd), radius = std::hypot(theta - place, v);
            // theta = place + radius cos(phase - t), up to the turn, or to where the relay looks.
            const long double phase = std::atan2(v, theta - place), limit = level > 0 ? 0.1L : -0.1L;
            // Switched on it looks up, switched off down; and goes that far.
            const bool looks = way * level > 0 && way * (limit - theta) > 0,
                       passes = looks && way * (place - limit) + radius > 0;
            const long double off = passes ? (limit - place) / radius : way;
            t += phase - way * std::acos(off);
            if (t >= 40) break;
            theta = place + radius * off;
            v = passes ? way * radius * std::sqrt(1 - off * off) : 0;
            REQUIRE(event < run.events.size());
            CAPTURE(event, static_cast<double>(t));
            CHECK(run.events[event].kind == (passes ? EventKind::switched : EventKind::turn));
            // Errors of the phase add up.
            CHECK(run.events[event].t == within(static_cast<double>(t), 2e-13));
            CHECK(run.events[event].theta == within(static_cast<double>(theta), 2e-14));
            if (passes) level = -level, ++switches;
        }
        CHECK(event == run.events.size());
        CHECK(switches > 10);
        const auto energy = analysis::energy_of(run);
        REQUIRE(energy);
        CHECK(std::fabs(energy->total.error()) < 1e-12);
    }
}

}  // namespace dinal::held_test
