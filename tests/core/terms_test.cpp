// Where terms break, to the last bit; oracle_test.cpp has their values by lot.
#include "model/terms.hpp"

#include "model/excitation.hpp"
#include "support/excitations.hpp"
#include "support/within.hpp"

namespace dinal::terms_test {

using namespace dinal::model;
using namespace dinal::excitations;

TEST_CASE("each term breaks where its formula does, and is constant from where its formula is", "[excitation]") {
    struct Case {
        Term term;
        double constant_from;
        std::vector<double> breaks;  // after -3, up to 9
    };
    const std::vector<Case> cases = {
        {Constant{-2.5}, -never, {}},
        {Harmonic{2, 2 * pi, pi / 6}, never, {}},
        {Harmonic{0, 1, 0}, -never, {}},
        {Harmonic{1, 0, 1}, -never, {}},
        {Step{3, 0.3}, 0.3, {0.3}},
        {Pulse{2, 0.1, 0.2}, 0.1 + 0.2, {0.1, 0.1 + 0.2}},
        {HalfSine{4, 1, 2}, 3, {1, 3}},
        {Ramp{2, 1, 0.5}, 1.5, {1, 1.5}},
        {Ramp{2, 1}, never, {1}},
        {Square{2, 4, 0.25, 1}, never, {-2, 1, 2, 5, 6, 9}},
        {Sawtooth{2, 4, 1}, never, {1, 5, 9}},
        {Triangle{2, 4, 1}, never, {-2, 0, 2, 4, 6, 8}},
        {Chirp{3, 0.5, 2.5, 4, 1, 0.3}, never, {1, 5}},
        {Chirp{1, 1, 0, 4}, 4, {0, 4}},
        {Exponential{2, 0.5, 1}, never, {1}},
        {Polynomial{{1, -2, 0, 3}, 2}, never, {}},
        {Polynomial{{7, 0, 0}}, -never, {}},
        {table({0, 1, 1.5, 4}, {1, 3, -1, 0}), 4, {0, 1, 1.5, 4}},
        {table({2}, {5}), -never, {}},
    };
    for (const Case& c : cases) {
        CAPTURE(c.term.index());
        const Excitation M = made(c.term);
        CHECK(M.constant_from() == c.constant_from);
        CHECK(breaks_of(M, -3, 9) == c.breaks);
    }
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

TEST_CASE("breaks keep increasing even if the period is below the resolution of time", "[excitation]") {
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

TEST_CASE("the greatest value and the period of a term are those of its formula", "[excitation]") {
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
