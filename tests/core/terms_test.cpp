#include "model/terms.hpp"

#include "model/forcing.hpp"
#include "support/excitations.hpp"
#include "support/within.hpp"

namespace dinal::terms_test {

using namespace dinal::model;
using namespace dinal::excitations;

TEST_CASE("a constant and a harmonic have the values of their formulas", "[excitation]") {
    CHECK(made(Constant{-2.5}).value(1e9) == -2.5);
    const Excitation M = made(Harmonic{2, 2 * pi, pi / 6});
    CHECK(M.value(0) == near(1));
    CHECK(M.value(0.25) == near(2 * std::cos(pi / 6)));
    CHECK(M.next_break(0) == never);
    CHECK(M.constant_from() == never);
    CHECK(made(Harmonic{0, 1, 0}).constant_from() == -never);
    CHECK(made(Harmonic{1, 0, 1}).constant_from() == -never);
}

TEST_CASE("a step and a pulse switch at their break and not one double earlier", "[excitation]") {
    const Excitation step = made(Step{3, 0.3});
    CHECK(step.value(just_before(0.3)) == 0);
    CHECK(step.value(0.3) == 3);
    CHECK(step.value_before(0.3) == 0);
    CHECK(step.value_after(0.3) == 3);
    CHECK(step.constant_from() == 0.3);
    const Excitation pulse = made(Pulse{2, 0.1, 0.2});
    const double end = 0.1 + 0.2;
    CHECK(breaks_of(pulse, -1, 9) == std::vector<double>{0.1, end});
    CHECK(pulse.value(0.1) == 2);
    CHECK(pulse.value(just_before(end)) == 2);
    CHECK(pulse.value(end) == 0);
    CHECK(pulse.constant_from() == end);
}

TEST_CASE("a half sine is one half wave and a ramp stops rising", "[excitation]") {
    const Excitation half = made(HalfSine{4, 1, 2});
    CHECK(half.value(0.99) == 0);
    CHECK(half.value(1 + 1.0 / 3) == near(2));
    CHECK(half.value(2) == near(4));
    CHECK(half.value(3) == 0);
    CHECK(breaks_of(half, 0, 9) == std::vector<double>{1, 3});
    const Excitation ramp = made(Ramp{2, 1, 0.5});
    CHECK(ramp.value(0.5) == 0);
    CHECK(ramp.value(1.25) == 0.5);
    CHECK(ramp.value(7) == 1);
    CHECK(breaks_of(ramp, 0, 9) == std::vector<double>{1, 1.5});
    CHECK(ramp.constant_from() == 1.5);
    const Excitation endless = made(Ramp{2, 1});
    CHECK(endless.value(1001) == 2000);
    CHECK(breaks_of(endless, 0, 1e9) == std::vector<double>{1});
    CHECK(endless.constant_from() == never);
}

TEST_CASE("the periodic terms have their corners where their formulas say", "[excitation]") {
    const Excitation square = made(Square{2, 4, 0.25, 1});
    CHECK(square.value(1) == 2);
    CHECK(square.value(1.999) == 2);
    CHECK(square.value(2) == -2);
    CHECK(square.value(4.999) == -2);
    CHECK(square.value(0) == -2);
    CHECK(square.value(-2.5) == 2);
    CHECK(breaks_of(square, -3, 6) == std::vector<double>{-2, 1, 2, 5, 6});
    const Excitation saw = made(Sawtooth{2, 4, 1});
    CHECK(saw.value(1) == -2);
    CHECK(saw.value(3) == 0);
    CHECK(saw.value(4) == 1);
    CHECK(saw.value_before(5) == near(2));
    CHECK(breaks_of(saw, 0, 9) == std::vector<double>{1, 5, 9});
    const Excitation triangle = made(Triangle{2, 4, 1});
    CHECK(triangle.value(1) == 0);
    CHECK(triangle.value(1.5) == 1);
    CHECK(triangle.value(2) == 2);
    CHECK(triangle.value(3) == 0);
    CHECK(triangle.value(4) == -2);
    CHECK(triangle.value(0) == -2);
    CHECK(breaks_of(triangle, 0, 7) == std::vector<double>{2, 4, 6});
}

TEST_CASE("a chirp sweeps linearly and its phase never jumps", "[excitation]") {
    const double from = 0.5;
    const double to = 2.5;
    const Excitation M = made(Chirp{3, from, to, 4, 1, 0.3});
    CHECK(M.value(1) == near(3 * std::sin(0.3)));
    CHECK(M.value(0) == near(3 * std::sin(0.3 - 2 * pi * from)));
    const double cycles = from * 3 + (to - from) * 9 / 8;  // the integral of the frequency over 3 time units
    CHECK(M.value(4) == near(3 * std::sin(0.3 + 2 * pi * cycles)));
    const double all = 4 * (from + to) / 2;
    CHECK(M.value(5.3) == near(3 * std::sin(0.3 + 2 * pi * (all + to * 0.3))));
    for (const double corner : breaks_of(M, -9, 99)) {
        // Slope at most 2 pi * 2.5 * 3 = 47 over two steps of 1e-9.
        CHECK(M.value(corner - 1e-9) == within(M.value(corner + 1e-9), 1e-7));
    }
    CHECK(breaks_of(M, -9, 99) == std::vector<double>{1, 5});
    CHECK(made(Chirp{1, 1, 0, 4}).constant_from() == 4);
}

TEST_CASE("an exponential starts at its break, a polynomial is taken in t - at", "[excitation]") {
    const Excitation decay = made(Exponential{2, 0.5, 1});
    CHECK(decay.value(0.999) == 0);
    CHECK(decay.value(1) == 2);
    CHECK(decay.value(1.5) == near(2 * std::exp(-1.0)));
    CHECK(made(Exponential{1, -1, 0}).value(2) == near(std::exp(2.0)));
    CHECK(breaks_of(decay, 0, 9) == std::vector<double>{1});
    const Excitation cubic = made(Polynomial{{1, -2, 0, 3}, 2});
    CHECK(cubic.value(2) == 1);
    CHECK(cubic.value(4) == 1 - 4 + 24);
    CHECK(cubic.value(1) == 1 + 2 - 3);
    CHECK(cubic.constant_from() == never);
    CHECK(made(Polynomial{{7, 0, 0}}).constant_from() == -never);
}

TEST_CASE("samples are joined by straight lines and hold outside", "[excitation]") {
    const Excitation M = made(table({0, 1, 1.5, 4}, {1, 3, -1, 0}));
    CHECK(M.value(-5) == 1);
    CHECK(M.value(0.5) == 2);
    CHECK(M.value(1) == 3);
    CHECK(M.value(1.25) == 1);
    CHECK(M.value(2.75) == -0.5);
    CHECK(M.value(4) == 0);
    CHECK(M.value(99) == 0);
    CHECK(breaks_of(M, -9, 9) == std::vector<double>{0, 1, 1.5, 4});
    CHECK(M.constant_from() == 4);
    CHECK(made(table({2}, {5})).constant_from() == -never);
    CHECK(made(table({2}, {5})).value(0) == 5);
}

TEST_CASE("every sample of an uneven record is hit exactly, in order and out of order", "[excitation]") {
    std::vector<double> t;
    std::vector<double> values;
    for (int i = 0; i < 1000; ++i) {
        t.push_back(0.01 * i + 0.004 * std::sin(7.0 * i));
        values.push_back(std::cos(3.0 * i));
    }
    const Excitation M = made(table(t, values));
    for (std::size_t i = 0; i < t.size(); ++i) {
        const std::size_t k = i * 617 % t.size();
        REQUIRE(M.value(t[k]) == values[k]);
        REQUIRE(M.value_before(t[k]) == within(values[k], 1e-10));  // an ulp of t times a slope of about 1e3
    }
    CHECK(breaks_of(M, -1, 99) == t);
}

TEST_CASE("after a delay of any size, each jump sits exactly on the break that is announced", "[excitation]") {
    const double delay = GENERATE(0.0, 0.1, 0.3, 1e3 + 0.1, -7.7);
    const double level = 2;
    const Excitation step = made(Step{level, 0.3}).delayed(delay);
    const Excitation pulse = made(Pulse{level, 0.1, 0.7}).delayed(delay);
    const Excitation window = made(Constant{level}).windowed(0.1, 0.3).delayed(delay);
    for (const Excitation& M : {step, pulse, window}) {
        double old = 0;
        for (const double b : breaks_of(M, -1e6, 1e6)) {
            CHECK(M.value(just_before(b)) == old);
            CHECK(M.value_before(b) == old);
            CHECK(M.value(b) == level - old);
            CHECK(M.value_after(b) == level - old);
            old = level - old;
        }
    }
    CHECK(breaks_of(pulse, -1e6, 1e6).size() == 2);
}

TEST_CASE("a square wave is exact at each of a hundred thousand edges", "[excitation]") {
    const double delay = GENERATE(0.0, 0.1, 1e3 + 0.1);
    const Excitation M = made(Square{1, 0.3, 0.3, 0.1}).delayed(delay);
    double t = -50;
    double level = M.value(t);
    int wrong = 0;
    for (int i = 0; i < 100000; ++i) {
        const double next = M.next_break(t);
        wrong += !(next > t);
        wrong += M.value(just_before(next)) != level;
        wrong += M.value(next) != -level;
        wrong += M.value(0.5 * (t + next)) != level;
        t = next;
        level = -level;
    }
    CHECK(wrong == 0);
    // 50000 periods on; both ends are rounded, and the sum is of order 1e4.
    CHECK(t == within(-50 + 50000 * 0.3, 0.3));
}

TEST_CASE("a sawtooth and a triangle are exact at each of their corners", "[excitation]") {
    const Excitation saw = made(Sawtooth{1, 0.3, 0.1});
    const Excitation triangle = made(Triangle{1, 0.3, 0.1});
    int wrong = 0;
    double t = -50;
    for (int i = 0; i < 100000; ++i) {
        t = saw.next_break(t);
        wrong += saw.value(t) != -1;
        // One ulp of t = 3e4 is 4e-12, on a slope of 2/0.3.
        wrong += std::fabs(saw.value_before(t) - 1) > 1e-10;
    }
    t = triangle.next_break(-50);
    double corner = triangle.value(t);
    for (int i = 0; i < 100000; ++i) {
        wrong += std::fabs(corner) != 1;
        t = triangle.next_break(t);
        wrong += triangle.value(t) != -corner;
        corner = -corner;
    }
    CHECK(wrong == 0);
}

TEST_CASE("breaks lead on even where the period is below the resolution of time", "[excitation]") {
    const Excitation M = made(Square{1, 1e-20}) + made(Triangle{1, 1e-20}) + made(Sawtooth{1, 1e-20});
    for (const double t : {0.0, 1.0, 1e5, -3.0}) {
        CHECK(M.next_break(t) > t);
        CHECK(std::fabs(M.value(t)) <= 3);
    }
}

TEST_CASE("next_break strictly increases and no jump or kink is without a break", "[excitation]") {
    for (const Excitation& M : one_of_each()) {
        for (const Excitation& shifted : {M, M.delayed(0.1), M.delayed(1e3 + 0.1), M.windowed(0.2, 0.9)}) {
            const double origin = shifted.value(0) == M.value(0) ? 0 : 1e3;
            double t = origin - 1;
            while (t < origin + 3) {
                const double next = shifted.next_break(t);
                REQUIRE(next > t);
                // Between breaks M is smooth: its third differences over 1/1000 of the gap are far below any kink.
                const double end = std::min(next, origin + 3);
                const double h = (end - t) / 1000;
                double worst = 0;
                for (int i = 0; i < 997; ++i) {
                    const auto at = [&](int j) { return shifted.value(t + (i + j) * h); };
                    worst = std::max(worst, std::fabs(at(3) - 3 * at(2) + 3 * at(1) - at(0)));
                }
                // |M'''| <= 2 (2 pi 3)^3 for the chirp; a kink of slope 1 would show as h. Rounding of t adds 1e-9.
                CHECK(worst <= 1.4e4 * h * h * h + 1e-9);
                t = next;
            }
        }
    }
}

TEST_CASE("the greatest value and the period that a term tells are its own", "[excitation]") {
    for (const Excitation& M : one_of_each()) {
        const Term& term = M.components()[0].term;
        CAPTURE(term.index());
        double peak = 0;
        for (int i = 0; i <= 20000; ++i) peak = std::max(peak, std::fabs(M.value(-5 + 0.0025 * i)));
        const bool bounded = !std::holds_alternative<Polynomial>(term) && !std::holds_alternative<Scripted>(term);
        CHECK((M.most() < never) == bounded);
        CHECK(peak <= M.most());
        if (bounded) CHECK(peak > 0.9 * M.most());  // the steepest record passes its peak between two of these times
        CHECK(M.scaled(-0.5).most() == 0.5 * M.most());
        CHECK((M + M).most() == 2 * M.most());
        CHECK(M.scaled(0).most() == 0);

        const double period = period_from(M, -9);
        const bool repeats = std::holds_alternative<Harmonic>(term) || std::holds_alternative<Square>(term) ||
                             std::holds_alternative<Sawtooth>(term) || std::holds_alternative<Triangle>(term);
        CHECK((period > 0) == (repeats || std::holds_alternative<Scripted>(term)));
        if (!repeats) continue;
        double change = 0, difference = 0;
        for (const double t : {0.013, 0.117, 0.29}) {
            difference = std::max(difference, std::fabs(M.value(t + period) - M.value(t)));
            change = std::max(change, std::fabs(M.value(t + period / 2) - M.value(t)));
        }
        CHECK(difference < 1e-12);  // roundings of t on slopes up to 30
        CHECK(change > 1);
    }
    CHECK(made(Exponential{2, -1, 0}).most() == never);
    CHECK(made(Exponential{0, -1, 0}).most() == 0);
    CHECK(made(Polynomial{{-3}}).most() == 3);
    CHECK(made(Ramp{0, 1}).most() == 0);
    CHECK(made(Ramp{-2, 1}).most() == never);
}

}  // namespace dinal::terms_test
