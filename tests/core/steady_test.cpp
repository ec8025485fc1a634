// Steady motions against Den Hartog's closed form, numbers of 80 digits, linear theory, and motions that were waited
// for.
#include "analysis/steady.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"
#include "theory/forced.hpp"

namespace dinal::steady_test {

using namespace dinal::analysis;
using namespace dinal::model;

namespace {

constexpr double pi = std::numbers::pi;

SteadyQuestion driven(double r, double gamma, double zeta = 0, double breakaway_factor = 1) {
    return SteadyQuestion::of(truth::nondimensional(zeta, gamma, breakaway_factor * gamma),
                              truth::harmonic(1, 2 * pi * r), {0, 1 / r});
}

/// The amplitude after `periods` of M, by rk4 with steps of a ten-thousandth: another integrator and no map.
double waited_for(const SteadyQuestion& question, int periods) {
    const double T = question.repeats.period;
    const auto run = truth::must_run(question.body, question.drive.M(), question.drive.start(), {0, periods * T},
                                     motion::Grid::none(), motion::Rk4{std::min(T, 1.0) / 2000});
    double low = 1e300, high = -1e300;
    for (const Event& event : run.events) {
        if (event.t < (periods - 1.5) * T) continue;
        low = std::min(low, event.theta);
        high = std::max(high, event.theta);
    }
    return (high - low) / 2;
}

}  // namespace

TEST_CASE("the steady motion without stops is Den Hartog's, amplitude and lag, all over the plane", "[steady]") {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    int compared = 0;
    for (int i = 0; i < 300; ++i) {
        const double r = 0.3 * std::pow(12, unit(random)), gamma = 0.8 * unit(random);
        const double zeta = i % 3 == 0 ? 0 : 0.4 * unit(random);
        const auto exact = theory::DenHartog(r, zeta).motion(gamma, gamma);
        if (!exact) continue;
        const SteadyQuestion question = driven(r, gamma, zeta);
        const SteadyMotion found = steady_motion(question);
        INFO("r = " << r << ", gamma = " << gamma << ", zeta = " << zeta);
        REQUIRE(found.status == SteadyStatus::steady);
        // The closed form loses digits near r = 1, where amplitudes of tens are a difference of terms.
        CHECK(found.amplitude == within(exact->amplitude, 1e-11 * std::max(1.0, exact->amplitude)));
        CHECK(found.stops == 0);
        CHECK(found.symmetric);
        CHECK(found.stable);
        const SteadyShape shape = shape_of(question, found);
        REQUIRE(shape.lag);
        CHECK(*shape.lag == within(exact->fundamental_lag, 1e-11));
        // The time of the crest is a turn, known to the root of nothing: 1e-9 of a degree is 3e-12 of a period.
        REQUIRE(shape.peak_lag);
        CHECK(*shape.peak_lag == within(exact->lag, 1e-10));
        CHECK(std::fabs(shape.mean) < 1e-11);
        ++compared;
    }
    CHECK(compared > 150);
}

TEST_CASE("steady motions with stops have the amplitudes of an 80-digit computation, and the right number of stops",
          "[steady]") {
    const SteadyMotion stopping = steady_motion(driven(1, 0.836));
    CHECK(stopping.amplitude == within(0.1291703518, 5e-11));
    CHECK(stopping.stops == 2);
    // Stuck from n/2 + 0.45017942 to (n + 1)/2 + 0.12493764.
    CHECK(stopping.stuck == within(2 * (0.62493764 - 0.45017942), 2e-8));
    CHECK(steady_motion(driven(1, 0.418, 0.119)).amplitude == within(1.9611201772, 5e-11));
    const std::vector<std::pair<double, std::size_t>> stops{{0.10, 6}, {0.15, 4}, {0.20, 4}, {0.25, 2},
                                                            {0.30, 2}, {0.45, 2}, {0.55, 0}};
    for (const auto& [r, count] : stops) {
        INFO("r = " << r);
        CHECK(steady_motion(driven(r, 0.4)).stops == count);
    }
}

TEST_CASE("the steady motion is the limit of a long run", "[steady]") {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 12; ++i) {
        SteadyQuestion question =
            driven(0.25 + unit(random), 0.2 + 0.6 * unit(random), 0.1 + 0.2 * unit(random), i % 2 == 0 ? 1 : 1.2);
        const double second = 0.5 * unit(random), T = question.repeats.period;
        question.drive.loads = {question.drive.M() + truth::harmonic(second, 4 * pi / T, 1)};
        const SteadyMotion found = steady_motion(question);
        if (found.status != SteadyStatus::steady) continue;
        INFO(i);
        // rk4 with this step is right to 1e-9; what is left of the transient is less.
        CHECK(found.amplitude == within(waited_for(question, 60), 1e-8));
    }
}

TEST_CASE("a load that hardly exceeds friction moves the mass a little twice a period", "[steady]") {
    struct Truth {
        double r, gamma, zeta, amplitude, lag, stuck, multiplier;
    };
    // From release to rest in closed form with 34 digits, by a program of its own.
    for (const Truth& truth : {
             Truth{0.32959798658976, 0.99999, 0, 2.07167794557593802e-09, 90.2049825518561761, 0.995729211909474055,
                   0.9983438228467979},
             Truth{1, 1 - 1e-7, 0.05, 2.24987990811004456e-14, 90.0204981422755282, 0.999572947219737218,
                   0.99999820015},
             Truth{0.05, 0.9999, 0, 1.0107932331529254e-05, 90.6399041563079777, 0.986185447255688796,
                   0.41777935204290279},
         }) {
        INFO("r = " << truth.r << ", gamma = 1 - " << 1 - truth.gamma);
        for (const bool in_two : {false, true}) {
            SteadyQuestion question = driven(truth.r, truth.gamma, truth.zeta);
            const auto half = truth::harmonic(0.5, 2 * pi * truth.r);
            if (in_two) question.drive.loads = {half + half};  // which has no closed form of its own
            const SteadyMotion found = steady_motion(question);
            REQUIRE(found.status == SteadyStatus::steady);
            // What is found by runs is no better than a place at which torques of 1 hold each other.
            CHECK(found.amplitude == within(truth.amplitude, in_two ? 1e-15 : 1e-13 * truth.amplitude));
            CHECK(found.stops == 2);
            CHECK(found.symmetric);
            CHECK(found.unique == std::optional(true));
            CHECK(std::abs(found.multipliers[0]) == within(truth.multiplier, 1e-9));
            CHECK(found.stuck == within(truth.stuck, in_two ? 1e-7 : 1e-13));
            if (!in_two) CHECK(*shape_of(question, found).lag == within(truth.lag * pi / 180, 2e-12));
        }
    }
    // Begun within a slide, half a period later and at the crest: the same motion.
    SteadyQuestion question = driven(0.7, 0.995, 0.1);
    const double amplitude = steady_motion(question).amplitude;
    for (const double phase : {pi / 2, -pi / 2, pi / 2 + 0.1, 3.0}) {
        INFO("phase " << phase);
        question.drive = truth::harmonic(1, 2 * pi * 0.7, phase);
        const SteadyMotion found = steady_motion(question);
        CHECK(found.amplitude == within(amplitude, 1e-15));
        const auto run = truth::must_run(question.body, question.drive.M(), found.start, {0, 1 / 0.7},
                                         motion::Grid::none(), motion::Spectral{});
        CHECK(run.state_at_stop.theta == within(found.start.theta, 1e-13));
        CHECK(run.state_at_stop.velocity == within(found.start.velocity, 1e-12));
    }
}

TEST_CASE("a square wave whose parts differ by a thousandth of the period is not taken for symmetric", "[steady]") {
    for (const double duty : {0.5, 0.499, 0.51}) {
        INFO("duty " << duty);
        SteadyQuestion question = driven(0.4, 0.2, 0.1);
        question.drive.loads = {*Excitation::make(Square{.amplitude = 1, .period = 2.5, .duty = duty})};
        const SteadyMotion found = steady_motion(question);
        REQUIRE(found.status == SteadyStatus::steady);
        CHECK(found.symmetric == (duty == 0.5));
        CHECK(found.amplitude == within(waited_for(question, 60), 1e-8));
        // All of the friction is in the two halves, which last as long as each other but for some 1e-3.
        CHECK(shape_of(question, found).mean == within(2 * duty - 1, 0.3 * std::fabs(2 * duty - 1)));
    }
}

}  // namespace dinal::steady_test
