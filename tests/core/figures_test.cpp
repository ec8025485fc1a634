#include "plots/figure.hpp"

#include <cmath>
#include <numbers>

#include "plots/bands.hpp"
#include "plots/paper_layout.hpp"
#include "support/catch.hpp"

namespace dinal::figures_test {

using namespace dinal::plots;

namespace {

/// A slow decay over t = 0 ... 100.
Figure decay(std::size_t n) {
    std::vector<double> t, y;
    for (std::size_t i = 0; i < n; ++i) {
        t.push_back(100.0 * static_cast<double>(i) / static_cast<double>(n));
        y.push_back(std::exp(-0.01 * t.back()) * std::cos(t.back()));
    }
    Figure figure;
    figure.curves.push_back({Numbers::own(t), Numbers::own(y), "θ"});
    return figure;
}

}  // namespace

TEST_CASE("what stands behind is drawn first, and as a band where it swings densely", "[plots]") {
    for (const double swings : {5.0, 500.0}) {
        Figure figure = decay(20'000);
        std::vector<double> load;
        for (const double t : figure.curves[0].x.values)
            load.push_back(2 * std::sin(2 * std::numbers::pi * swings * t / 100));
        figure.curves.push_back({figure.curves[0].x, Numbers::own(load), "M/k", Style::line});
        figure.curves[1].behind = true;
        CHECK(drawing_order(figure) == std::vector<std::size_t>{1, 0});
        const std::vector<Figure> drawn = with_bands({&figure, 1}, 300);
        const Curve& band = drawn[0].curves[1];
        CHECK(drawn[0].curves[0].style == Style::line);
        REQUIRE((band.style == Style::fill) == (swings > 100));
        if (band.style == Style::fill) {
            for (std::size_t i = 0; i < band.size(); ++i) {
                CHECK(std::fabs(band.y.values[i] - 2) < 0.02);  // 40 points to a swing
                CHECK(std::fabs(band.base->values[i] + 2) < 0.02);
            }
            CHECK(band.x.values.front() == figure.curves[0].x.values.front());
        }
    }
}

TEST_CASE("figures below others have their boxes below theirs, as wide", "[plots]") {
    std::vector<Figure> figures{decay(100), decay(100), decay(100)};
    figures[1].below = true;
    figures[1].y.limits = Interval{-123456, 123456};
    const Sheet sheet = lay_out(figures, {});
    CHECK(sheet.panels[1].top < sheet.panels[0].bottom);
    CHECK(sheet.panels[1].left == sheet.panels[0].left);
    CHECK(sheet.panels[1].right == sheet.panels[0].right);
    CHECK(sheet.panels[2].left > sheet.panels[0].right);
    CHECK(sheet.panels[2].bottom < sheet.panels[1].top);
}

}  // namespace dinal::figures_test
