// Where a function jumps or kinks, found from its values; and where it does so next.
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "motion/break_search.hpp"
#include "support/catch.hpp"

namespace dinal::break_search_test {

using motion::find_break;
using motion::PassedBreaks;

namespace {

constexpr std::size_t count = 9;
using Function = std::function<double(double)>;

std::optional<double> found_in(const Function& f) {
    std::array<double, count> times{}, values{};
    for (std::size_t i = 0; i < count; ++i) {
        times[i] = 1 + 0.125 * static_cast<double>(i);
        values[i] = f(times[i]);
    }
    return find_break(times, values, f);
}

Function jumps_at(double place) {
    return [place](double t) { return std::sin(t) + (t < place ? 0 : 1); };
}

}  // namespace

TEST_CASE("a jump anywhere between samples is found, to the double at which the new value begins", "[spectral]") {
    for (const double place : {1.0625, 1.06, 1.3, 1.5, 1.7, 1.999, 2.0}) {
        CAPTURE(place);
        const auto found = found_in(jumps_at(place));
        REQUIRE(found);
        CHECK(*found == place);
    }
}

TEST_CASE("a kink is found to rounding, and a smooth function has neither jump nor kink", "[spectral]") {
    for (const double place : {1.1, 1.3, 1.55, 1.9}) {
        CAPTURE(place);
        const auto found = found_in([place](double t) { return std::cos(t) + std::fabs(t - place); });
        REQUIRE(found);
        // It bends by its distance; that of a few roundings of the values, 1e-15, is not seen.
        CHECK(std::fabs(*found - place) < 1e-13);
    }
    CHECK_FALSE(found_in([](double t) { return std::exp(t); }));
    CHECK_FALSE(found_in([](double) { return 3.0; }));
    CHECK_FALSE(found_in([](double t) { return 1 / (1 + 30 * (t - 1.5) * (t - 1.5)); }));
}

TEST_CASE("the next jump is predicted if the last ones were evenly spaced, alone or alternating, and otherwise not",
          "[spectral]") {
    const auto square = [](double t) { return std::fmod(t, 0.25) < 0.0625 ? 1.0 : 0.0; };
    PassedBreaks passed;
    CHECK_FALSE(passed.next(10, square));
    for (const double t : {0.25, 0.3125, 0.5, 0.5625}) passed.pass(t);
    CHECK_FALSE(passed.next(10, square));  // two turns and one more make two equal periods
    passed.pass(0.75);
    REQUIRE(passed.next(10, square));
    CHECK(*passed.next(10, square) == 0.8125);
    CHECK(*passed.next(0.8125, square) == 0.8125);
    CHECK_FALSE(passed.next(0.8, square));
    CHECK_FALSE(passed.next(10, [](double) { return 1.0; }));  // it goes on without a jump
    CHECK_FALSE(passed.next(10, [](double t) { return t; }));
    PassedBreaks uneven;
    for (const double t : {0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.76}) uneven.pass(t);
    CHECK_FALSE(uneven.next(10, square));
}

}  // namespace dinal::break_search_test
