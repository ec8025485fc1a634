// The search for a kink of a function from its values.
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "motion/break_search.hpp"
#include "support/catch.hpp"

namespace dinal::break_search_test {

using motion::find_break;

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

}  // namespace

TEST_CASE("a kink is found to rounding, and a smooth function has neither jump nor kink") {
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

}  // namespace dinal::break_search_test
