// Loads that come up to the limit of sticking and pass it by next to nothing: slips that end at once, or none.
#include <cmath>
#include <memory>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/written.hpp"

namespace dinal::crest_test {

namespace {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

/// A function of time that the integrator cannot look into. It counts how often it is asked.
class Sine : public UserFunction {
public:
    Sine(double amplitude, double omega) : amplitude_(amplitude), omega_(omega) {}
    double value(double t, const State& /*state*/) override {
        ++calls;
        return amplitude_ * std::sin(omega_ * t);
    }
    long calls = 0;

private:
    double amplitude_, omega_;
};

struct Crest {
    double Re, above, omega, zeta;  ///< above: the crest over Re, as a part of Re
    [[nodiscard]] Oscillator system() const {
        return system_of({.inertia = 1, .stiffness = 1, .damping = 2 * zeta, .kinetic_friction = Re});
    }
    [[nodiscard]] double amplitude() const { return Re * (1 + above); }
    [[nodiscard]] double end() const { return 5.5 * 3.14159265358979 / omega; }  // the sixth crest, just
};

/// The run, unless the monitor was asked so often that it leads nowhere.
Trajectory run_over(const Crest& crest, const Excitation& M, const Integrator& method, const Extras& extras = {}) {
    long asked = 0;
    auto run = simulate(
        crest.system(), M, {}, {0, crest.end()}, Grid::none(), method, [&asked](double) { return ++asked < 20000; }, {},
        extras);
    REQUIRE(run);
    return std::move(run).value();
}

/// Slip and stick in turn, as many slips as crests at most for each period that the load is beyond the limit, and the
/// mass is no farther than M - Re can have drawn it.
void check_pairs(const Trajectory& run, const Crest& crest) {
    CHECK(model::is_whole(run.outcome));
    bool moving = false;
    for (const Event& event : run.events) {
        CHECK((event.kind == EventKind::slip) == !moving);
        moving = event.kind == EventKind::slip;
        // Past a limit of rounding width the mass may be drawn twice as far as M - Re.
        CHECK(std::fabs(event.theta) <= 6 * crest.Re * (crest.above + 1e-14));
    }
    CHECK(run.events.size() <= 40);
    // Five crests and the sixth just begun.
    if (crest.above >= 1e-9) CHECK(run.events.size() >= 11);
}

}  // namespace

TEST_CASE("a crest that passes the limit by rounding or little more slips and sticks, or holds, and the run goes on",
          "[long][exact][spectral][rk4][crest]") {
    for (const double Re : {0.3, 1.0, 1e-9}) {
        for (const double above : {1e-16, 3e-15, 4e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-7}) {
            for (const double omega : {0.1, 0.013, 1.0}) {
                for (const double zeta : {0.0, 0.05, 1.0}) {
                    const Crest crest{Re, above, omega, zeta};
                    CAPTURE(Re, above, omega, zeta);
                    const Excitation native =
                        Excitation::make(Harmonic{.amplitude = crest.amplitude(), .omega = omega}).value();
                    for (const Integrator& method :
                         std::vector<Integrator>{Exact{}, Spectral{}, Spectral{.tolerance = 1e-9}}) {
                        CAPTURE(method.index());
                        check_pairs(run_over(crest, native, method), crest);
                    }
                    // With an event of a user, which never comes: another way through the house.
                    Extras watched;
                    watched.events.push_back(
                        {.name = "never", .when = written([](double t, const State&, auto) { return t + 1; })});
                    check_pairs(run_over(crest, native, Spectral{}, watched), crest);
                    for (const Integrator& method : std::vector<Integrator>{Spectral{}, Spectral{.tolerance = 1e-9}}) {
                        const auto sine = std::make_shared<Sine>(crest.amplitude(), omega);
                        CAPTURE(method.index());
                        const Trajectory run =
                            run_over(crest, Excitation::make(Scripted{.function = sine}).value(), method);
                        check_pairs(run, crest);
                        CHECK(sine->calls < 40000);
                    }
                }
            }
        }
    }
}

}  // namespace dinal::crest_test
