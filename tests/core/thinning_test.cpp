#include "plots/thinning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/catch.hpp"

namespace dinal::thinning_test {

using namespace dinal::plots;

namespace {

constexpr double pi = 3.14159265358979323846;

Curve sampled(int n, double (*x)(double), double (*y)(double)) {
    std::vector<double> xs, ys;
    for (int i = 0; i < n; ++i) {
        const double s = static_cast<double>(i) / (n - 1);
        xs.push_back(x(s));
        ys.push_back(y(s));
    }
    return {Numbers::own(xs), Numbers::own(ys)};
}

Paper paper_for(const Curve& curve, Box pixels) {
    Figure figure;
    figure.curves.push_back(curve);
    return {view_of(figure), pixels};
}

double distance(double px, double py, double ax, double ay, double bx, double by) {
    const double dx = bx - ax, dy = by - ay;
    const double square = dx * dx + dy * dy;
    const double part = square > 0 ? std::clamp(((px - ax) * dx + (py - ay) * dy) / square, 0.0, 1.0) : 0;
    return std::hypot(px - ax - part * dx, py - ay - part * dy);
}

}  // namespace

TEST_CASE("a million points over time are reduced to four for each column of pixels, and no extreme is lost",
          "[thinning]") {
    Curve curve = sampled(
        1'000'000, [](double s) { return 1000 * s; }, [](double s) { return std::exp(-3 * s) * std::cos(6283 * s); });
    std::vector<double> y(curve.y.values.begin(), curve.y.values.end());
    y[123'456] = 5;  // a single spike
    y[777'777] = -4;
    curve.y = Numbers::own(y);
    // The first 300 are left of the paper.
    const Paper paper{{Scale({300, 1000}, false), Scale({-1, 1}, false)}, {600, 400}};
    const auto kept = thinned(curve, paper);
    CHECK(kept.size() <= 4U * 602);
    CHECK(std::is_sorted(kept.begin(), kept.end()));
    CHECK(std::count(kept.begin(), kept.end(), 123'456U) == 1);
    CHECK(std::count(kept.begin(), kept.end(), 777'777U) == 1);
    CHECK(kept.front() == 0);
    CHECK(kept.back() == 999'999);
    // The highest and the lowest value of each column of pixels are those of all its points.
    std::vector<double> high(601, -1e9), low(601, 1e9), kept_high(601, -1e9), kept_low(601, 1e9);
    const auto note = [&](std::size_t i, std::vector<double>& highs, std::vector<double>& lows) {
        if (curve.x.values[i] < 300) return;
        const auto column = static_cast<std::size_t>((curve.x.values[i] - 300) / 700 * 600);
        highs[column] = std::max(highs[column], y[i]);
        lows[column] = std::min(lows[column], y[i]);
    };
    for (std::size_t i = 0; i < y.size(); ++i) {
        note(i, high, low);
    }
    for (const std::size_t i : kept) {
        note(i, kept_high, kept_low);
    }
    CHECK(high == kept_high);
    CHECK(low == kept_low);
}

TEST_CASE("gaps stay gaps", "[thinning]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Curve line{Numbers::own({0, 1, 2, 3, 4, 5}), Numbers::own({0, 1, nan, nan, 1, 0})};
    CHECK(thinned(line, paper_for(line, {100, 100})) == std::vector<std::size_t>{0, 1, 2, 3, 4, 5});
    const Curve loop{Numbers::own({0, 1, 0, nan, 1, 0}), Numbers::own({0, 1, 3, nan, 4, 8})};
    CHECK(thinned(loop, paper_for(loop, {100, 100})) == std::vector<std::size_t>{0, 1, 2, 3, 4, 5});
}

TEST_CASE("a phase plane keeps its shape to a fifth of a pixel", "[thinning]") {
    const Curve curve = sampled(
        20'000, [](double s) { return std::exp(-2 * s) * std::cos(40 * s); },
        [](double s) { return std::exp(-2 * s) * std::sin(40 * s); });
    const Paper paper = paper_for(curve, {500, 500});
    const auto kept = thinned(curve, paper);
    CHECK(kept.size() < 1500);
    const auto x = [&](std::size_t i) { return paper.view.x(curve.x.values[i]) * 500; };
    const auto y = [&](std::size_t i) { return paper.view.y(curve.y.values[i]) * 500; };
    double worst = 0;
    for (std::size_t n = 1; n < kept.size(); ++n) {
        for (std::size_t i = kept[n - 1]; i < kept[n]; ++i) {
            worst = std::max(worst, distance(x(i), y(i), x(kept[n - 1]), y(kept[n - 1]), x(kept[n]), y(kept[n])));
        }
    }
    // The cone of directions bounds the distance at each point by the tolerance times a little more, as a line may
    // leave the cone's middle; twice the tolerance of 0.2 is what can happen.
    CHECK(worst < 0.4);
}

TEST_CASE("a point that left its cycle once is drawn", "[thinning]") {
    std::vector<double> x, y;
    for (int i = 0; i < 1'000'000; ++i) {
        x.push_back(std::cos(0.0123 * i));
        y.push_back(std::sin(0.0123 * i));
    }
    x[654'321] = y[654'321] = 3;
    Curve curve{Numbers::own(x), Numbers::own(y)};
    const Paper paper = paper_for(curve, {500, 500});
    const auto kept = thinned(curve, paper);
    CHECK(std::count(kept.begin(), kept.end(), 654'321U) == 1);
}

TEST_CASE("of a cloud of points one remains for each pixel, in any order", "[thinning]") {
    // Ten points above each other in each of ten columns: as a line, only the ends of each column would be seen.
    std::vector<double> x, y;
    for (int column = 0; column < 10; ++column) {
        for (int row = 0; row < 10; ++row) {
            x.push_back(column);
            y.push_back(row);
        }
    }
    Curve cloud{Numbers::own(x), Numbers::own(y)};
    cloud.style = Style::points;
    CHECK(thinned(cloud, paper_for(cloud, {600, 400})).size() == 100);
    std::reverse(x.begin(), x.end());  // x falls: not the corners of a line either
    cloud.x = Numbers::own(x);
    CHECK(thinned(cloud, paper_for(cloud, {600, 400})).size() == 100);
}

TEST_CASE("points that cannot be seen, or have no place on an axis, are left out", "[thinning]") {
    Curve cloud{Numbers::own({0, 5, std::nan(""), 1, 0}), Numbers::own({0, 5, 0, 1, std::nan("")})};
    cloud.style = Style::points;
    const Paper paper{{Scale({0, 1}, false), Scale({0, 1}, false)}, {600, 400}};
    CHECK(thinned(cloud, paper) == std::vector<std::size_t>{0, 3});
}

}  // namespace dinal::thinning_test
