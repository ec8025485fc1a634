// Whether a motion repeats itself, for made-up events, and the limits of that decision.
#include "analysis/recurrence.hpp"

#include <cmath>
#include <numbers>

#include "support/catch.hpp"
#include "support/systems.hpp"
#include "support/within.hpp"

namespace dinal::recurrence_test {

using namespace dinal::analysis;
using namespace dinal::model;
using truth::harmonic;
using truth::nondimensional;

namespace {

/// Turns half a time unit apart, at +-(1 + part q^n).
std::vector<Event> settling_turns(std::size_t count, double part, double q) {
    std::vector<Event> events;
    for (std::size_t n = 0; n < count; ++n) {
        const double X = 1 + part * std::pow(q, static_cast<double>(n));
        events.push_back({0.5 * static_cast<double>(n), EventKind::turn, n % 2 == 0 ? X : -X, 0});
    }
    return events;
}

/// Half cycles of one time unit each, with these amplitudes.
std::vector<Stretch> half_cycles(const std::vector<double>& amplitudes) {
    std::vector<Stretch> list;
    double t = 0, sign = 1;
    for (const double a : amplitudes) {
        list.push_back({.from = t, .to = t + 1, .begin = {-sign * a, 0}, .end = {sign * a, 0}});
        list.back().ended_by = Event{t + 1, EventKind::turn, sign * a, 0};
        t += 1, sign = -sign;
    }
    return list;
}

}  // namespace

TEST_CASE("a motion is steady when it is within a part in ten thousand of its limit", "[recurrence]") {
    // What is left after n turns is 0.5^n; after the last two of 30, 2e-9.
    const auto steady = recurrence(settling_turns(30, 1, 0.5));
    REQUIRE(steady);
    CHECK(steady->steady);
    CHECK(steady->period == 1);
    CHECK(steady->amplitude == within(1, 1e-8));
    // 0.7^20 = 8e-4 is left of the last amplitudes: it repeats itself nearly, and settles.
    const auto nearly = recurrence(settling_turns(20, 1, 0.7));
    REQUIRE(nearly);
    CHECK_FALSE(nearly->steady);
    // Left after the last period are 0.7^26 = 9.4e-5, and 0.7^25 = 1.3e-4.
    CHECK(recurrence(settling_turns(30, 1, 0.7))->steady);
    CHECK_FALSE(recurrence(settling_turns(29, 1, 0.7))->steady);
}

TEST_CASE("a motion is periodic from the first turn that is repeated to a thousandth one period later",
          "[recurrence]") {
    const auto events = settling_turns(40, 1, 0.5);
    const auto found = recurrence(events);
    REQUIRE(found);
    // Turn n and the one two before differ by 0.5^n (4 - 1), less than 1e-3 from n = 12 on: the period before it
    // counts.
    CHECK(found->since == events[10].t);
}

TEST_CASE("a motion that changes by a tenth in a period is not periodic", "[recurrence]") {
    // It changes by 0.19 q^n part; what is left of that must be below a tenth, too.
    CHECK(recurrence(settling_turns(12, 0.05, 0.9)));
    CHECK_FALSE(recurrence(settling_turns(12, 0.5, 0.9)));
}

TEST_CASE("the trend of the last swings ignores relative differences below 1e-9", "[recurrence]") {
    const auto trend = [](double step) {
        return swings(half_cycles({1, 1 + step, 1 + 2 * step, 1 + 3 * step}), 1).trend;
    };
    CHECK(trend(3e-9) == Trend::growing);
    CHECK(trend(-3e-9) == Trend::shrinking);
    CHECK(trend(3e-10) == Trend::irregular);
    CHECK(swings(half_cycles({1, 0.5, 0.8, 0.6}), 1).trend == Trend::irregular);
}

TEST_CASE("the lag of a steady motion does not depend on where M is in its period", "[phase_lag]") {
    const double zeta = 0.05, r = 2, pi = std::numbers::pi;
    const double lag = std::atan2(2 * zeta * r, 1 - r * r);
    for (int degrees = 0; degrees < 360; degrees += 20) {
        const Excitation M = harmonic(1, 2 * pi * r, degrees * pi / 180);
        // exp(-zeta 2 pi 120) = 4e-17 is left of how it began.
        const auto run =
            truth::must_run(nondimensional(zeta, 0), M, {0, 0}, {0, 120}, motion::Grid::none(), motion::Spectral{});
        const auto found = phase_lag(run, M, 0.5, 119.3 + degrees / 720.0);
        CAPTURE(degrees);
        REQUIRE(found);
        CHECK(*found == within(lag, 2e-8));
    }
}

}  // namespace dinal::recurrence_test
