#include "model/excitation.hpp"

#include <algorithm>

#include "support/excitations.hpp"
#include "support/within.hpp"

namespace dinal::excitation_test {

using namespace dinal::model;
using namespace dinal::excitations;

TEST_CASE("a block has the same values as single evaluations", "[excitation]") {
    std::vector<double> times;
    for (int i = -50; i < 300; ++i) {
        times.push_back(0.01 * i);
    }
    Excitation all;
    for (const Excitation& M : one_of_each()) {
        for (const Excitation& variant : {M, M.scaled(-0.7), M.delayed(0.3), M.windowed(0.2, 0.9), M.scaled(0)}) {
            all = all + variant;
            for (const Excitation* e : {&variant, static_cast<const Excitation*>(&all)}) {
                std::vector<double> out(times.size(), 99);
                REQUIRE(e->fill(times, out) == times.size());
                double worst = 0;
                for (std::size_t i = 0; i < times.size(); ++i) {
                    worst = std::max(worst, std::fabs(out[i] - e->value(times[i])));
                }
                // Only sines in a block are computed in another way; their sums here are below 100.
                CHECK(worst <= (std::holds_alternative<Harmonic>(M.components()[0].term) || e == &all ? 1e-13 : 0));
            }
        }
    }
}

TEST_CASE("a block of a sine is accurate to the rounding of its times, however late", "[excitation]") {
    const double start = GENERATE(0.0, 1000.0, -1e6);
    const double omega = 2 * pi;
    const double amplitude = 3;
    const double phase = 0.7;
    const Excitation M = made(Harmonic{amplitude, omega, phase});
    std::vector<double> even;
    std::vector<double> uneven;
    for (int i = 0; i < 1000; ++i) {
        even.push_back(start + 0.0005 * i);
        uneven.push_back(start + 0.0005 * i + 1e-6 * std::sin(i));
    }
    for (const auto& times : {even, uneven}) {
        std::vector<double> out(times.size());
        REQUIRE(M.fill(times, out) == times.size());
        double worst = 0;
        for (std::size_t i = 0; i < times.size(); ++i) {
            const auto exact = std::sin(static_cast<long double>(omega) * times[i] + phase) * amplitude;
            worst = std::max(worst, std::fabs(static_cast<double>(out[i] - exact)));
        }
        // Half an ulp for each of omega t, the sum with the phase and the spacing, and a few of the result.
        const double ulp = std::numeric_limits<double>::epsilon();
        CHECK(worst <= amplitude * ulp * (2 * omega * (std::fabs(start) + 1) + 4));
    }
}

TEST_CASE("a window of a delayed excitation and a delay of a windowed one differ", "[excitation]") {
    const Excitation M = made(Constant{1});
    CHECK(breaks_of(M.delayed(2).windowed(0, 1), -9, 9) == std::vector<double>{0, 1});
    CHECK(breaks_of(M.windowed(0, 1).delayed(2), -9, 9) == std::vector<double>{2, 3});
    const Excitation ramp = made(Ramp{1, 0});
    CHECK(ramp.delayed(2).windowed(0, 3).value(2.5) == 0.5);
    CHECK(ramp.windowed(0, 3).delayed(2).value(2.5) == 0.5);
    CHECK(ramp.delayed(2).windowed(0, 3).value(3.5) == 0);
    CHECK(ramp.windowed(0, 3).delayed(2).value(3.5) == 1.5);
    CHECK(breaks_of(M.windowed(0, 5).windowed(1, 9), -9, 99) == std::vector<double>{1, 5});
    CHECK(M.windowed(0, 1).windowed(2, 3).components().empty());
}

TEST_CASE("the time from which M is constant is known for sums, gains and windows", "[excitation]") {
    const Excitation step = made(Step{1, 2});
    const Excitation pulse = made(Pulse{1, 1, 4});
    const Excitation sine = made(Harmonic{1, 1, 0});
    CHECK((step + pulse).constant_from() == 5);
    CHECK((step + sine).constant_from() == never);
    CHECK((step + sine.scaled(0)).constant_from() == 2);
    CHECK(sine.windowed(0, 7).constant_from() == 7);
    CHECK(pulse.windowed(0, 7).constant_from() == 5);
    CHECK(pulse.windowed(0, 3).constant_from() == 3);
    CHECK(step.windowed(4, never).constant_from() == 4);
    CHECK(step.windowed(0, 7).constant_from() == 7);
    CHECK(made(Pulse{0, 1, 4}).constant_from() == -never);
    for (const Excitation& M : one_of_each()) {
        const double from = M.constant_from();
        if (from < never) {
            CHECK(M.next_break(from) == never);
            CHECK(M.value(std::max(from, -1e6)) == M.value(1e6));
        }
    }
}

TEST_CASE("a script is called at its delayed time, with the state, and not outside its window", "[excitation]") {
    const auto f =
        std::make_shared<Probe>([](double t, const State& s) { return t + 10 * s.theta + 100 * s.velocity; });
    const Excitation M = made(Scripted{.function = f, .feedback = true});
    CHECK(M.has_script());
    CHECK(M.has_feedback());
    CHECK(M.value(3, {.theta = 1, .velocity = 2}) == 213);
    CHECK(M.delayed(0.5).value(3) == 2.5);
    CHECK(M.scaled(2).value(3) == 6);
    f->calls = 0;
    CHECK(M.windowed(0, 1).value(3) == 0);
    CHECK(M.scaled(0).value(3) == 0);
    CHECK(f->calls == 0);
    CHECK(M.constant_from() == never);
    CHECK_FALSE(made(Scripted{.function = f}).has_feedback());
}

TEST_CASE("announced breaks of a script are delayed with it and repeat with its period", "[excitation]") {
    const auto f = probe([](double) { return 1.0; });
    const Excitation once = made(Scripted{.function = f, .breaks = {0.5, 2}});
    CHECK(breaks_of(once, -9, 9) == std::vector<double>{0.5, 2});
    CHECK(breaks_of(once.delayed(1), -9, 9) == std::vector<double>{1.5, 3});
    const Excitation periodic = made(Scripted{.function = f, .breaks = {0.5, 2}, .period = 3});
    CHECK(breaks_of(periodic, -1.5, 7) == std::vector<double>{-1, 0.5, 2, 3.5, 5, 6.5});
    const Excitation closed = made(Scripted{.function = f, .breaks = {0, 0.1, 0.3}, .period = 0.3});
    double t = 0;
    for (int i = 0; i < 20000; ++i) {
        const double next = closed.next_break(t);
        REQUIRE(next - t > 0.09);  // never two copies of the corner that 0.3 and 0.3 + 0 share
        t = next;
    }
    CHECK(made(Scripted{.function = f, .period = 3}).next_break(0) == never);
}

TEST_CASE("both sides of a scripted jump are found, whether it is written with > or >=", "[excitation]") {
    const bool inclusive = GENERATE(true, false);
    const double delay = GENERATE(0.0, 0.1, 1e3 + 0.1);
    const double at = GENERATE(0.0, 0.5, 0.3);
    const auto jump = probe([=](double t) { return (inclusive ? t >= at : t > at) ? 1.0 : 0.0; });
    const Excitation M = made(Scripted{.function = jump, .breaks = {at}}).delayed(delay);
    const double b = M.next_break(-1);
    CHECK(M.value_before(b) == 0);
    CHECK(M.value_after(b) == 1);
}

TEST_CASE("two sums that extend the same one do not share their new terms", "[excitation]") {
    const Excitation common = made(Constant{1}) + made(Constant{2}) + made(Constant{4});
    const Excitation one = common + made(Constant{8}), other = common + made(Constant{16});
    const Excitation left = made(Constant{32}) + common, far_left = made(Constant{64}) + common;
    CHECK(common.value(0) == 7);
    CHECK(one.value(0) == 15);
    CHECK(other.value(0) == 23);
    CHECK(left.value(0) == 39);
    CHECK(far_left.value(0) == 71);
    CHECK((one + other).value(0) == 38);
    CHECK((common + common + common).value(0) == 21);
    CHECK((left + one).components().size() == 8);
    CHECK(std::get<Constant>((left + one).components()[0].term).amplitude == 32);
    CHECK(std::get<Constant>((left + one).components()[7].term).amplitude == 8);
    CHECK((Excitation() + one).value(0) == 15);
    CHECK((one + Excitation()).value(0) == 15);
}

}  // namespace dinal::excitation_test
