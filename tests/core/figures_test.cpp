#include "plots/figure.hpp"

#include <cmath>
#include <numbers>

#include "plots/painter.hpp"
#include "plots/shades.hpp"
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

TEST_CASE("curves in the background are drawn first, and dense oscillations as a band", "[plots]") {
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
            CHECK(band.x.values.back() == figure.curves[0].x.values.back());
        }
    }
}

TEST_CASE("figures below others have their boxes exactly below, of equal width", "[plots]") {
    std::vector<Figure> figures{decay(100), decay(100), decay(100)};
    figures[1].below = true;
    figures[1].y.limits = Interval{-123456, 123456};
    const Sheet sheet = lay_out(figures, {});
    CHECK(sheet.panels[1].top > sheet.panels[0].bottom);
    CHECK(sheet.panels[1].left == sheet.panels[0].left);
    CHECK(sheet.panels[1].right == sheet.panels[0].right);
    CHECK(sheet.panels[2].left > sheet.panels[0].right);
    CHECK(sheet.panels[2].bottom > sheet.panels[1].top);
}

TEST_CASE("boxes side by side have equal heights and one base line", "[plots]") {
    std::vector<Figure> figures{decay(100), decay(100), decay(100)};
    figures[0].stuck = {{1, 2}};
    figures[0].x.label = "t";
    figures[1].title = "a title";
    figures[2].equal = true;
    const Sheet sheet = lay_out(figures, {});
    CHECK(sheet.panels[1].bottom == sheet.panels[0].bottom);
    CHECK(sheet.panels[1].top == sheet.panels[0].top);
    CHECK(sheet.panels[2].bottom == sheet.panels[0].bottom);
}

TEST_CASE("a curve denser than the columns of a text is drawn as its envelope", "[plots]") {
    constexpr std::size_t columns = 70;
    constexpr int points = 8000;
    for (const int swings : {10, 13, 16, 34, 300}) {  // two turns each
        std::vector<double> t, y;
        for (int i = 0; i < points; ++i) {
            t.push_back(i);
            y.push_back((1 + static_cast<double>(i) / points) * std::sin(2 * std::numbers::pi * swings * i / points));
        }
        Figure figure;
        figure.curves.push_back({Numbers::own(t), Numbers::own(y)});
        const Curve drawn = with_envelopes({&figure, 1}, columns)[0].curves[0];
        CAPTURE(swings);
        REQUIRE((drawn.size() == 2 * columns) == (swings > 14));
        for (std::size_t i = 0; i < drawn.size() && drawn.size() == 2 * columns; i += 2) {
            const double grown = 1 + drawn.x.values[i] / points, near = 0.02 + 1.0 / swings;
            CHECK(std::fabs(drawn.y.values[i] + grown) < near);
            CHECK(std::fabs(drawn.y.values[i + 1] - grown) < near);
        }
    }
    // Noise on a slow curve is no swing.
    std::vector<double> t, y;
    for (int i = 0; i < points; ++i) {
        t.push_back(i);
        y.push_back(i + (i % 2 == 0 ? 100 : -100));
    }
    Figure slow;
    slow.curves.push_back({Numbers::own(t), Numbers::own(y)});
    CHECK(with_envelopes({&slow, 1}, columns)[0].curves[0].size() == points);
    // A phase plane goes back in x, and stays what it is.
    Figure figure;
    figure.curves.push_back({Numbers::own({0, 1, 0, -1, 0, 1, 0}), Numbers::own({1, 0, -1, 0, 1, 0, -1})});
    CHECK(with_envelopes({&figure, 1}, 2)[0].curves[0].size() == 7);
}

TEST_CASE("titles side by side have one base line", "[plots]") {
    std::vector<Figure> figures{decay(100), decay(100)};
    figures[0].title = "with a long legend";
    figures[0].curves.assign(9, figures[0].curves.front());
    figures[1].title = "with a short one";
    const Sheet sheet = lay_out(figures, {});
    CHECK(sheet.panels[0].title.y == sheet.panels[1].title.y);
}

TEST_CASE("many entries of a legend are read downwards, in columns of one length", "[plots]") {
    Figure figure = decay(10);
    figure.curves.assign(10, figure.curves.front());
    const std::vector<LegendEntry> legend = lay_out({&figure, 1}, {12, 9}).panels[0].legend;
    REQUIRE(legend.size() == 10);
    CHECK(legend[1].x == legend[0].x);
    CHECK(legend[1].y > legend[0].y);
    CHECK(legend[9].x > legend[0].x);
}

TEST_CASE("a colour bar has a number between two colours or on each", "[plots]") {
    const auto labels = [](std::vector<double> z) {
        Figure figure;
        figure.shades = std::make_shared<const Shades>(Shades{{0, 1, 2}, {0, 1}, std::move(z), "A"});
        const ColourBar bar = lay_out({&figure, 1}, {}).panels[0].bar;
        std::string all;
        for (const auto& [place, text] : bar.labels) all += text + " at " + std::to_string(place).substr(0, 3) + "; ";
        return all;
    };
    CHECK(labels({0, 1, 2, 0, 1, 2}) == "0 at 0.5; 1 at 1.5; 2 at 2.5; ");
    CHECK(labels({0, 0.1, 0.2, 0.3, 0.4, 0.5}).starts_with("0.0 at 0.0; 0.1 at 12.; "));  // of 64 colours that flow
}

TEST_CASE("lines have their names at their ends on request, outside of the box at its right edge", "[plots]") {
    Figure figure = decay(10);
    figure.curves.assign(2, figure.curves.front());
    figure.curves[0].label = "first", figure.curves[1].label = "second";
    figure.curves[1].x = Numbers::own({0, 1, 2});
    figure.curves[1].y = Numbers::own({0, 0.5, 0.2});
    const PaperPanel legend = lay_out({&figure, 1}, {12, 9}).panels[0];
    CHECK(legend.legend.size() == 2);
    figure.ends = true;
    const PaperPanel ends = lay_out({&figure, 1}, {12, 9}).panels[0];
    CHECK(ends.legend.empty());
    CHECK(ends.right < legend.right);
    const std::vector<NamedEnd> named = named_ends(figure, ends.view);
    REQUIRE(named.size() == 2);
    CHECK(named[0].outside());
    CHECK(!named[1].outside());
    CHECK(std::fabs(named[1].right - ends.view.x(2)) < 1e-12);
}

TEST_CASE("an axis of several curves has their names before their unit", "[plots]") {
    Figure figure = decay(10);
    figure.curves.assign(2, figure.curves.front());
    figure.curves[0].label = "θ", figure.curves[1].label = "M/k";
    figure.y.label = "m";
    figure.y.names_curves = true;
    CHECK(lay_out({&figure, 1}, {}).panels[0].y_label.text == "θ, M/k, m");
    figure.y.label = "";
    CHECK(lay_out({&figure, 1}, {}).panels[0].y_label.text == "θ, M/k");
}

}  // namespace dinal::figures_test
