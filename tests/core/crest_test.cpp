// Loads and speeds that pass a limit by next to nothing: slips that end at once, or none, and stops that are none.
#include <cmath>
#include <numbers>

#include "support/catch.hpp"
#include "support/excitations.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"

namespace dinal::crest_test {

namespace {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;
using excitations::made;

struct Crest {
    double Re, above, omega, zeta;  ///< above: the crest over Re, as a part of Re
    [[nodiscard]] Oscillator system() const {
        return system_of({.inertia = 1, .stiffness = 1, .damping = 2 * zeta, .kinetic_friction = Re});
    }
    [[nodiscard]] double amplitude() const { return Re * (1 + above); }
    [[nodiscard]] double end() const { return 5.5 * std::numbers::pi / omega; }  // the sixth crest, just
};

/// Slip and stick in turn, as many slips as crests at most for each period that the load is beyond the limit, and the
/// mass is no farther than M - Re can have drawn it.
void check_pairs(const Crest& crest, const Excitation& M, const Integrator& method) {
    CAPTURE(method.index());
    const auto run = simulate(crest.system(), {M, {}}, {0, crest.end()}, Grid::none(), method,
                              [asked = 0](double) mutable { return ++asked < 20000; });  // or it leads nowhere
    REQUIRE(run);
    CHECK(model::is_whole(run->outcome));
    bool moving = false;
    for (const Event& event : run->events) {
        CHECK((event.kind == EventKind::slip) == !moving);
        moving = event.kind == EventKind::slip;
        // Past a limit of rounding width the mass may be drawn twice as far as M - Re.
        CHECK(std::fabs(event.theta) <= 6 * crest.Re * (crest.above + 1e-14));
    }
    CHECK(run->events.size() <= 40);
    // Five crests and the sixth just begun.
    if (crest.above >= 1e-9) CHECK(run->events.size() >= 11);
}

}  // namespace

TEST_CASE(
    "a crest of M that passes the limit by rounding or little more slips and sticks, or holds, and the run continues",
    "[long][exact][spectral][rk4][crest]") {
    for (const double Re : {0.3, 1.0, 1e-9}) {
        for (const double above : {1e-16, 4e-15, 1e-13, 1e-11, 1e-9, 1e-7}) {
            for (const double omega : {0.1, 0.013, 1.0}) {
                for (const double zeta : {0.0, 0.05, 1.0}) {
                    const Crest crest{Re, above, omega, zeta};
                    CAPTURE(Re, above, omega, zeta);
                    const auto sine = [&](double t) { return crest.amplitude() * std::sin(omega * t); };
                    for (const Integrator& method :
                         std::vector<Integrator>{Exact{}, Spectral{}, Spectral{.tolerance = 1e-9}}) {
                        check_pairs(crest, harmonic(crest.amplitude(), omega), method);
                        if (std::holds_alternative<Exact>(method)) continue;
                        const auto function = excitations::probe(sine);
                        check_pairs(crest, made(Scripted{.function = function}), method);
                        CHECK(function->calls < 40000);
                    }
                }
            }
        }
    }
}

TEST_CASE("a block drawn with Re = Rd slows down to velocity zero once a period, and never stops",
          "[long][exact][spectral]") {
    struct Case {
        double k, Re, speed;
    };
    // theta' = V (1 - cos w0 t) after the slip: it only touches zero, so one event is true.
    for (const Case& c : std::vector<Case>{{4000, 32.7, 0.01},
                                           {1, 32.7, 1.0 / 3},
                                           {37.5, 0.3, 0.01},
                                           {1e-3, 0.3, 2.7e-5},
                                           {4000, 1e-6, 1.0 / 3},
                                           {1, 19.62, 2.7e-5}}) {
        const Oscillator system = system_of({.inertia = 10, .stiffness = c.k, .kinetic_friction = c.Re});
        const double T0 = system.natural_period(), starts = c.Re / (c.k * c.speed);
        CAPTURE(c.k, c.Re, c.speed);
        for (const Integrator& method : std::vector<Integrator>{Exact{}, Spectral{}}) {
            CAPTURE(method.index());
            const Run run =
                must_run(system, made(Ramp{.slope = c.k * c.speed}), {}, {0, starts + 9.4 * T0}, Grid::none(), method);
            REQUIRE(run.events.size() == 1);
            CHECK(run.events[0].kind == EventKind::slip);
            CHECK(run.events[0].t == within(starts, 1e-12 * (starts + T0)));
            CHECK(run.outcome == Outcome::reached_end);
        }
    }
}

}  // namespace dinal::crest_test
