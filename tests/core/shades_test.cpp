// Shades of maps: which values share one.
#include "plots/shades.hpp"
#include "support/catch.hpp"

#include <cmath>

namespace dinal::shades_test {

using namespace dinal::plots;

namespace {

/// z = f(x, y) at n x n places of [-1, 1] x [-1, 1].
template <class Function>
Shades shades_over(int n, Function f) {
    Shades shades;
    for (int i = 0; i < n; ++i) {
        shades.x.push_back(-1 + 2.0 * i / (n - 1));
    }
    shades.y = shades.x;
    for (const double y : shades.y) {
        for (const double x : shades.x) {
            shades.z.push_back(f(x, y));
        }
    }
    return shades;
}

}  // namespace

TEST_CASE("infinity has no shade if each shade is a single number", "[shades]") {
    const std::vector<ShadeBand> bands = bands_of(shades_over(3, [](double x, double) { return x; }), 5);
    REQUIRE(bands.size() == 3);
    CHECK(!band_of(bands, INFINITY));
    CHECK(!band_of(bands, -INFINITY));
    CHECK(band_of(bands, 1) == 2u);
}

TEST_CASE("a few whole numbers have a shade each, other values round bands", "[shades]") {
    const Shades stops = shades_over(9, [](double x, double y) { return std::floor(2 * (x * x + y * y)); });
    std::string all;
    for (const ShadeBand& band : bands_of(stops, 5)) {
        all += band.text + " ";
    }
    CHECK(all == "0 1 2 3 4 ");
    const auto bands = bands_of(shades_over(41, [](double x, double) { return x; }), 5);
    CHECK(bands.size() >= 3);
    for (double stretch = 0.5; stretch < 30; stretch *= 1.1) {
        const Shades shades = shades_over(41, [stretch](double x, double) { return stretch * (x + 0.1); });
        for (const int most : {5, 10}) CHECK(static_cast<int>(bands_of(shades, most).size()) <= most + 1);
    }
    CHECK(bands[*band_of(bands, 0.6)].from <= 0.6);
    CHECK(bands[*band_of(bands, 0.6)].to > 0.6);
    CHECK(*band_of(bands, -1e9) == 0);
    CHECK(*band_of(bands, INFINITY) == bands.size() - 1);
    CHECK(!band_of(bands, std::nan("")));
    CHECK(bands_of(shades_over(3, [](double, double) { return NAN; }), 5).empty());
    CHECK(bands_of(shades_over(3, [](double, double) { return 0.3; }), 5).size() == 1);
}

TEST_CASE("a resonance does not use up the shades of all other values", "[shades]") {
    const auto bands = bands_of(shades_over(101, [](double x, double) { return 1 / std::fabs(x + 1e-6); }), 8);
    CHECK(bands.back().from < 20);  // the largest value is a million
    CHECK(bands.size() >= 3);
}

TEST_CASE("edges lie half way between the values, on logarithmic axes by ratio", "[shades]") {
    CHECK(edges_between({0, 1, 3}, false) == std::vector<double>{-0.5, 0.5, 2, 4});
    const auto edges = edges_between({1, 100}, true);
    CHECK(std::fabs(edges[1] - 10) < 1e-12);
    CHECK(edges_between({4}, false) == std::vector<double>{3, 5});
}

}  // namespace dinal::shades_test
