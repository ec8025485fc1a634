// What spectral sees of a function between its nodes, and what it makes of one that is rough on every scale.
#include <bit>
#include <cmath>
#include <cstdint>

#include "motion/integrators.hpp"
#include "motion/simulate.hpp"
#include "support/catch.hpp"
#include "support/excitations.hpp"
#include "support/random_case.hpp"

namespace dinal::spectral_look_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::excitations;

namespace {

constexpr double length = 10;  // of runs, natural periods

Oscillator nondimensional(double zeta, double friction_ratio) {
    const double k = 4 * pi * pi;
    return Oscillator::make(
               {.inertia = 1, .stiffness = k, .damping = 4 * pi * zeta, .kinetic_friction = friction_ratio * k})
        .value();
}

struct Seen {
    Run run;
    int calls;
};

Seen look(const Oscillator& system, std::function<double(double)> f, const State& initial, const Spectral& method = {},
          double end = length) {
    const auto function = probe(std::move(f));
    auto run = simulate(system, {made(Scripted{.function = function}), initial}, {0, end}, Grid::none(), method);
    if (!run) FAIL(run.error().sentence);
    return {std::move(run).value(), function->calls};
}

/// A pulse that moves the mass by much more than any error.
auto pulse(double at, double width) {
    return [=](double t) { return t >= at && t < at + width ? 50.0 : 0.0; };
}

bool differs(const Run& a, const Run& b) {
    return a.events.size() != b.events.size() || std::fabs(a.state_at_stop.theta - b.state_at_stop.theta) > 1e-9 ||
           std::fabs(a.state_at_stop.velocity - b.state_at_stop.velocity) > 1e-9;
}

/// Deterministic bits of a time between -1/2 and 1/2: noise that is a function.
double noise(double t) {
    auto x = std::bit_cast<std::uint64_t>(t) * 0x9E3779B97F4A7C15U;
    x ^= x >> 29U;
    x *= 0xBF58476D1CE4E5B9U;
    x ^= x >> 32U;
    return static_cast<double>(x >> 11U) * 0x1p-53 - 0.5;
}

double smooth(double t) {
    return 20 * std::sin(5 * t);
}

}  // namespace

TEST_CASE("few single pulses between the nodes are missed, moving or at rest", "[spectral][look][long]") {
    truth::Lot lot(11);
    for (const bool resting : {false, true}) {
        const Oscillator system = nondimensional(0.05, resting ? 0.3 : 0);
        const State initial{resting ? 0.0 : 1.0, 0};
        const Seen nothing = look(
            system, [](double) { return 0.0; }, initial);
        // 17 panels of 16 new nodes each, a fifth of that more, and what is asked again at the end.
        CHECK(nothing.calls <= 1.2 * 17 * 16 + 20);
        constexpr int pulses = 75;
        for (const auto& [width, most] : {std::pair{0.07, 0.0}, {0.05, 0.02}, {0.03, 0.2}, {0.01, 0.75}}) {
            int missed = 0;
            for (int i = 0; i < pulses; ++i) {
                const Seen one = look(system, pulse(lot.between(0, length - width), width), initial);
                if (!differs(one.run, nothing.run)) ++missed;
            }
            CAPTURE(resting, width, missed);
            // Three deviations of the lot's own on top.
            const double n = pulses;
            CHECK(missed <= most * n + 3 * std::sqrt(most * (1 - most) * n));
        }
    }
}

TEST_CASE("no pulse of the width that a user names is missed", "[spectral][look][long]") {
    truth::Lot lot(12);
    for (int i = 0; i < 35; ++i) {
        const bool resting = i % 2 == 0;
        const Oscillator system = nondimensional(0.05, resting ? 0.3 : 0.02);
        const State initial{resting ? 0.0 : 1.0, 0};
        const double width = 0.002 * std::pow(30, lot.between(0, 1));
        const Spectral method{.narrowest = width};
        const double at = lot.between(0, length - width);
        CAPTURE(i, width, at);
        const Seen nothing = look(
            system, [](double) { return 0.0; }, initial, method);
        const Seen one = look(system, pulse(at, width), initial, method);
        REQUIRE(differs(one.run, nothing.run));
        REQUIRE(one.run.gap <= width);
        // And where it is: a native pulse says so itself.
        auto native = simulate(system, {made(Pulse{50, at, width}), initial}, {0, length}, Grid::none(), method);
        REQUIRE(native);
        REQUIRE(!differs(one.run, *native));
    }
}

TEST_CASE("an unannounced jump costs at most 70 values of M more than an announced one", "[spectral][look]") {
    truth::Lot lot(13);
    const Oscillator system = nondimensional(0.05, 0.05);
    const auto calls = [&](double at, const std::vector<double>& breaks) {
        const auto function = probe([at](double t) { return smooth(t) + (t >= at ? 10.0 : 0.0); });
        REQUIRE(simulate(system, {made(Scripted{.function = function, .breaks = breaks}), {1, 0}}, {0, length},
                         Grid::none(), Spectral{}));
        return function->calls;
    };
    int more = 0;
    constexpr int jumps = 60;
    for (int i = 0; i < jumps; ++i) {
        const double at = lot.between(1, 9);
        more += calls(at, {}) - calls(at, {at});
    }
    CHECK(more <= 70 * jumps);
}

TEST_CASE("evenly spaced unannounced jumps are predicted: at most 40 values of M for each step of a staircase",
          "[spectral][look]") {
    const Oscillator system = nondimensional(0.05, 0.05);
    struct Case {
        const char* name;
        double period;
        int jumps;  // in it
        double most;
        std::function<double(double)> M;
        std::vector<double> breaks;  // of the first period
    };
    const auto stairs = [](double width) { return [width](double t) { return width * std::floor(t / width); }; };
    // The mass turns on most steps of the last two, which is a panel more each time.
    const std::vector<Case> cases = {
        {"many steps", 0.0371, 1, 40, stairs(0.0371), {0.0371}},
        {"few steps, the last one at the very end", 0.25, 1, 40, stairs(0.25), {0.25}},
        {"a square wave", 0.3, 2, 60, [](double t) { return std::fmod(t, 0.3) < 0.2 ? 1.0 : -1.0; }, {0.2, 0.3}},
        {"three in turn",
         0.5,
         3,
         75,
         [](double t) {
             const double since = std::fmod(t, 0.5);
             return since < 0.1 ? 1.0 : since < 0.2 ? 0.3 : -1.0;
         },
         {0.1, 0.2, 0.5}},
    };
    for (const Case& c : cases) {
        CAPTURE(c.name);
        const auto run = [&](const std::vector<double>& breaks) {
            const auto function = probe(c.M);
            const auto made_of = made(Scripted{.function = function, .breaks = breaks});
            const auto result = simulate(system, {made_of, {0.1, 0}}, {0, length}, Grid::none(), Spectral{});
            REQUIRE(result);
            return std::pair{*result, function->calls};
        };
        std::vector<double> all;
        for (int i = 0; i * c.period < length; ++i) {
            for (const double at : c.breaks) all.push_back(i * c.period + at);
        }
        const auto [found, calls] = run({});
        const auto announced = run(all).first;
        CHECK(calls <= c.most * c.jumps * length / c.period);
        REQUIRE(found.events.size() == announced.events.size());
        // Both know a jump to the rounding of its time, some 1e-15, and a turn's time follows it.
        CHECK(std::fabs(found.state_at_stop.theta - announced.state_at_stop.theta) < 1e-12);
    }
}

TEST_CASE("an M that fails after the end of the run is not searched there for its next jump", "[spectral][look]") {
    double last = 0;
    const auto function = probe([&](double t) { return last = std::max(last, t), 0.25 * std::floor(t / 0.25); });
    REQUIRE(simulate(nondimensional(0.05, 0.05), {made(Scripted{.function = function, .breaks = {}}), {1, 0}}, {0, 2.5},
                     Grid::none(), Spectral{}));
    CHECK(last == 2.5);
}

TEST_CASE("an M that is rough on every scale is followed as accurately as possible, and the run says so",
          "[spectral][look]") {
    const Oscillator system = nondimensional(0.05, 0.05);
    const Seen clean = look(system, smooth, {1, 0});
    REQUIRE(clean.run.noise == 0);
    struct Case {
        const char* name;
        double size;
        std::function<double(double)> M;
    };
    const auto rounded = [](double step) { return [step](double t) { return std::round(smooth(t) / step) * step; }; };
    const std::vector<Case> cases = {
        {"single precision", 20 * 0x1p-24, [](double t) { return static_cast<double>(static_cast<float>(smooth(t))); }},
        {"noise of 1e-10", 20e-10, [](double t) { return smooth(t) * (1 + 1e-10 * noise(t)); }},
        {"noise of 1e-7", 1e-7, [](double t) { return smooth(t) + 1e-7 * noise(t); }},
        {"16 bit", 20 * 0x1p-15, rounded(20 * 0x1p-15)},
        {"24 bit", 20 * 0x1p-23, rounded(20 * 0x1p-23)},
    };
    const auto followed = [&](const Case& c) {
        CAPTURE(c.name);
        const Seen one = look(system, c.M, {1, 0});
        CHECK(one.run.outcome == Outcome::reached_end);
        CHECK(one.run.events.size() == clean.run.events.size());
        // The size of the noise, as a few coefficients tell it.
        CHECK(one.run.noise >= c.size / 30);
        CHECK(one.run.noise <= 10 * c.size);
        // A constant error of that size would move the mass by its own size over k, and it is not constant.
        CHECK(std::fabs(one.run.state_at_stop.theta - clean.run.state_at_stop.theta) <= c.size);
        CHECK(outcome_text(one.run).find("within the noise of the torques") != std::string::npos);
        return one.calls;
    };
    // Within a few panels, and then no slower than a smooth one.
    for (const Case& c : cases) CHECK(followed(c) <= 2.5 * clean.calls);
    // Where it becomes rough under way, chance has a say in how soon that is seen.
    constexpr int times = 40;
    long calls = 0;
    for (int i = 0; i < times; ++i) {
        const auto late = [from = 4.9 + 0.005 * i](double t) {
            return t < from ? smooth(t) : static_cast<double>(static_cast<float>(smooth(t)));
        };
        calls += followed({"only late", 20 * 0x1p-24, late});
    }
    CHECK(static_cast<double>(calls) <= 2.75 * clean.calls * times);
    // Below the tolerance nothing is noise, and few steps are jumps, each in its place.
    CHECK(look(system, [](double t) { return smooth(t) + 1e-12 * noise(t); }, {1, 0}).run.noise == 0);
    CHECK(look(system, rounded(20 * 0x1p-4), {1, 0}).run.noise == 0);
}

TEST_CASE(
    "a function that is rough at every scale ends the run soon with its own outcome, unless it is as small as noise",
    "[spectral][look][long]") {
    const double k = 4 * pi * pi;
    const Seen lost = look(nondimensional(0.05, 0.3), [&](double t) { return k * (noise(t) + 0.5); }, {0.3, 0});
    CHECK(lost.run.outcome == Outcome::unresolved);
    CHECK(lost.run.noise == 0);
    CHECK(lost.calls < 20000000);
    const auto staircase = [&](double t) {  // Cantor's: flat almost everywhere, and never smooth
        double x = t / (2 * length), sum = 0, weight = 0.5;
        for (int i = 0; i < 40; ++i) {
            x *= 3;
            const int digit = static_cast<int>(x);
            x -= digit;
            if (digit > 0) sum += weight;
            if (digit == 1) break;
            weight /= 2;
        }
        return k * sum;
    };
    // What is left of it on short stretches may be small enough to be taken for noise, or for nothing; it is chance
    // which. Either end is honest.
    for (const double friction_ratio : {0.0, 0.3}) {
        const Seen climb = look(nondimensional(0.05, friction_ratio), staircase, {0.3, 0}, {}, 1);
        CHECK((is_whole(climb.run.outcome) || climb.run.outcome == Outcome::unresolved));
        CHECK(climb.run.noise < 1e-4 * k);
        CHECK(climb.calls < 8000000);
    }
}

}  // namespace dinal::spectral_look_test
