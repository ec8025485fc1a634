#include "plots/gnuplot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "plots/gnuplot_script.hpp"
#include "plots/paper_layout.hpp"
#include "plots/svg_words.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace dinal::gnuplot_test {

using namespace dinal::plots;

namespace {

Figure wave(std::size_t n = 200) {
    std::vector<double> t, y;
    for (std::size_t i = 0; i < n; ++i) {
        t.push_back(100.0 * static_cast<double>(i) / static_cast<double>(n));
        y.push_back(std::exp(-0.01 * t.back()) * std::cos(5 * t.back()));
    }
    Figure figure;
    figure.curves.push_back({Numbers::own(t), Numbers::own(y), "θ"});
    figure.x.label = "t";
    figure.y.label = "θ, rad";
    return figure;
}

Figure spiral(std::size_t n) {
    std::vector<double> x, y;
    for (std::size_t i = 0; i < n; ++i) {
        const double s = static_cast<double>(i) / static_cast<double>(n);
        x.push_back((1 - s) * std::cos(5000 * s));
        y.push_back((1 - s) * std::sin(5000 * s));
    }
    Figure figure;
    figure.curves.push_back({Numbers::own(x), Numbers::own(y)});
    figure.equal = figure.circles = true;
    figure.dead_zone = Interval{-0.1, 0.1};
    figure.marks = {{1, 0, MarkKind::start}, {0, 0, MarkKind::end}};
    return figure;
}

std::string svg(const Figure& figure) {
    const auto picture = run_gnuplot(gnuplot_input({&figure, 1}, Terminal::svg, {}));
    if (!picture) {
        FAIL(picture.error().sentence);
    }
    return *picture;
}

}  // namespace

TEST_CASE("no word of a user becomes a command of gnuplot or of a shell", "[gnuplot]") {
    const testing::TemporaryFolder folder;
    const std::string victim = folder.file("victim");
    for (const std::string& attack :
         {"`touch " + victim + "`", "'; system('touch " + victim + "'); '", "'\nsystem 'touch " + victim + "'\n'",
          "\n!touch " + victim + "\n", "\"`touch " + victim + "`\"", "'.system('touch " + victim + "').'",
          "\\'\nsystem 'touch " + victim + "' #", "$(touch " + victim + ")", "\r!touch " + victim,
          std::string("@x ^{2} {/Symbol q} % %s </text><script>")}) {
        Figure figure = wave();
        figure.title = figure.x.label = figure.y.label = figure.curves[0].label = attack;
        const std::string picture = svg(figure);
        CHECK(picture.find("</svg>") != std::string::npos);
        CHECK(picture.find("<script") == std::string::npos);
        testing::put_text(folder.file("figure.gp"), gnuplot_file({&figure, 1}, {}));
        const auto again = run_gnuplot(gnuplot_file({&figure, 1}, {}));
        CHECK(static_cast<bool>(again));
        CHECK(!std::filesystem::exists(victim));
    }
}

TEST_CASE("any words stand in a picture as they were written", "[gnuplot]") {
    for (const char* words : {"I θ'' + C θ'", "''", "'''a", "a\\'", "'quoted'", "x\\n", "100 %s", "@a_b^{c} ~"}) {
        Figure figure = wave();
        figure.title = figure.x.label = figure.curves[0].label = words;
        CAPTURE(words);
        CHECK(svg(figure).find(std::string("<text>") + words + "</text>") != std::string::npos);
        CHECK(static_cast<bool>(run_gnuplot(gnuplot_file({&figure, 1}, {}))));
    }
}

TEST_CASE("what a user has told gnuplot by the environment changes no picture", "[gnuplot]") {
    const std::string before = svg(wave());
    for (const char* name : {"GNUTERM", "GNUPLOT_LIB", "GNUPLOT_DRIVER_DIR"}) ::setenv(name, "nonsense", 1);
    CHECK(svg(wave()) == before);
    for (const char* name : {"GNUTERM", "GNUPLOT_LIB", "GNUPLOT_DRIVER_DIR"}) ::unsetenv(name);
}

TEST_CASE("a picture says what it shows to those who do not see it", "[gnuplot]") {
    Figure figure = wave();
    figure.stuck = {{10, 20}};
    const std::string picture = with_words(svg(figure), {&figure, 1});
    CHECK(picture.find("<title>θ over t</title>") != std::string::npos);
    CHECK(picture.find(" role=\"img\" aria-label=\"θ over t\"") != std::string::npos);
    CHECK(picture.find("<desc>Across: t, 0 to 99.5. Up: θ, rad, -0.9381 to 1.092. θ: from 1 to ") != std::string::npos);
    CHECK(picture.find(" half swings that ") != std::string::npos);
    CHECK(picture.find(". Stuck from 10 to 20.</desc>") != std::string::npos);
    CHECK(picture.find("Gnuplot") == std::string::npos);
    figure.title = "a < b & 'c'";
    CHECK(with_words(svg(figure), {&figure, 1}).find("<title>a &lt; b &amp; ") != std::string::npos);
}

TEST_CASE("the description of a picture says what each curve does", "[gnuplot]") {
    const auto described = [](std::vector<double> x, std::vector<double> y, Style style = Style::line) {
        Figure figure;
        figure.curves.push_back({Numbers::own(std::move(x)), Numbers::own(std::move(y)), "A", style});
        const std::string words = with_words("<svg><title></title><desc></desc></svg>", {&figure, 1});
        const std::size_t from = words.find("A: ");
        return words.substr(from, words.find("</desc>") - from);
    };
    CHECK(described({0, 1, 2}, {1, 2, 5}) == "A: rises from 1 to 5.");
    CHECK(described({0, 1, 2}, {5, 2, 1}) == "A: falls from 5 to 1.");
    CHECK(described({0, 1, 2}, {3, 3, 3}) == "A: constant at 3.");
    CHECK(described({0, 1, 2}, {0, 4, 1}) == "A: from 0 to 1, greatest 4 at 1, least 0 at 0.");
    CHECK(described({0, 1, 2, 3, 4, 5}, {1, -2, 3, -4, 5, 0}) ==
          "A: from 1 to 0, greatest 5 at 4, least -4 at 3, 5 half swings that grow.");
    CHECK(described({0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, -1, 2, -2, 1, -1, 0})
              .ends_with("7 half swings that grow and decay."));
    CHECK(described({0, 1, 0}, {1, 0, -1}) == "A: a path from (0, 1) to (0, -1), across from 0 to 1, up from -1 to 1.");
    CHECK(described({2, 1}, {4, 3}, Style::points) == "A: 2 points, across from 1 to 2, up from 3 to 4.");
    CHECK(described({1, 2, 3}, {0, std::nan(""), 1}) == "A: rises from 0 to 1.");
    CHECK(described({1, 2}, {4, 5}, Style::fill) == "A: an area across from 1 to 2, up from 0 to 5.");
}

TEST_CASE("the title of a picture of many curves names its axes", "[gnuplot]") {
    Figure figure = wave();
    figure.curves.assign(4, figure.curves.front());
    CHECK(title_of({&figure, 1}) == "θ over t");
    figure.y.label = "";
    CHECK(title_of({&figure, 1}) == "θ, θ, θ and 1 more over t");
}

TEST_CASE("an SVG names fonts for machines without Arial", "[gnuplot]") {
    const Figure figure = wave();
    const std::string picture = with_words(svg(figure), {&figure, 1});
    CHECK(picture.find("font-family=\"Arial\"") == std::string::npos);
    CHECK(picture.find("font-family=\"Arial, Helvetica, sans-serif\"") != std::string::npos);
}

TEST_CASE("the file to be restyled draws the same picture as the pipe", "[gnuplot]") {
    const Figure figure = wave();
    const auto again = run_gnuplot(gnuplot_file({&figure, 1}, {}));
    REQUIRE(again);
    CHECK(*again == svg(figure));
}

TEST_CASE("an SVG of a million points is smaller than 200 kB", "[gnuplot][long]") {
    CHECK(svg(wave(1'000'000)).size() < 200'000);
    CHECK(svg(spiral(1'000'000)).size() < 200'000);
    Figure many;
    for (int i = 0; i < 20; ++i) {
        many.curves.push_back(wave(100'000).curves[0]);
    }
    CHECK(svg(many).size() < 200'000);
}

TEST_CASE("an SVG of a million random points is smaller than 200 kB and shows all of the square", "[gnuplot][long]") {
    std::vector<double> x, y;
    std::uint64_t state = 1;
    const auto random = [&state] {  // Knuth's MMIX
        state = state * 6364136223846793005U + 1442695040888963407U;
        return static_cast<double>(state >> 11U) / 9007199254740992.0;
    };
    for (int i = 0; i < 1'000'000; ++i) {
        x.push_back(random());
        y.push_back(random());
    }
    for (const Style style : {Style::line, Style::points}) {
        Figure figure;
        figure.curves.push_back({Numbers::own(x), Numbers::own(y), "", style});
        const std::string picture = svg(figure);
        CHECK(picture.size() < 200'000);
        CHECK(picture.size() > 5'000);
    }
    Figure few;
    few.curves.push_back(
        {Numbers::own({x.begin(), x.begin() + 5000}), Numbers::own({y.begin(), y.begin() + 5000}), "", Style::points});
    CHECK(svg(few).size() < 200'000);
}

TEST_CASE("one point of a million that stands out reaches the top of the SVG", "[gnuplot]") {
    std::vector<double> x, y;
    for (int i = 0; i < 1'000'000; ++i) {
        x.push_back(i);
        y.push_back(std::sin(0.01 * i));
    }
    y[654'321] = 7;
    for (const bool over_time : {true, false}) {
        if (!over_time) {  // a phase plane of 1591 turns
            std::transform(x.begin(), x.end(), x.begin(), [](double i) { return std::cos(0.01 * i); });
            x[654'321] = 5;
        }
        Figure figure;
        figure.curves.push_back({Numbers::own(x), Numbers::own(y)});
        figure.y.limits = Interval{-2, 7};
        const Sheet sheet = lay_out({&figure, 1}, {});
        const std::string picture = svg(figure);
        CHECK(picture.size() < 200'000);
        const std::size_t curve = picture.find("<path stroke='rgb(  0, 114, 178)'");
        REQUIRE(curve != std::string::npos);
        double top = sheet.height;
        for (std::size_t at = picture.find(',', picture.find(" d='", curve)); at < picture.find("</g>", curve);
             at = picture.find(',', at + 1)) {
            top = std::min(top, std::stod(picture.substr(at + 1)));
        }
        // An SVG counts from above; the ink of a dense curve is in cells.
        CHECK(top == Approx(sheet.height - sheet.panels[0].top).margin(over_time ? 0.15 : 0.7));
    }
}

TEST_CASE("a point between gaps is drawn as a dot, and so is a curve shorter than a pixel", "[gnuplot]") {
    const double nan = std::nan("");
    const auto dots = [](std::vector<double> x, std::vector<double> y) {
        Figure figure;
        figure.curves.push_back({Numbers::own(std::move(x)), Numbers::own(std::move(y))});
        const std::string picture = svg(figure);
        std::size_t count = 0;
        for (std::size_t at = picture.find("<use"); at != std::string::npos; at = picture.find("<use", at + 1)) {
            count += picture.compare(at, 26, "<use xlink:href='#gpPt6' t") == 0 ? 1 : 0;
        }
        return count;
    };
    CHECK(dots({0, 1, 2, 3, 4}, {0, 1, nan, 3, nan}) == 1);
    CHECK(dots({0, 1, 2}, {1, nan, 3}) == 2);
    CHECK(dots({7}, {7}) == 1);
    CHECK(dots({1, 1 + 1e-15}, {1, 1 + 1e-15}) == 1);
    CHECK(dots({0, 1}, {0, 1}) == 0);
}

TEST_CASE("an area between two curves is interrupted where one of them is", "[gnuplot]") {
    const double nan = std::nan("");
    Figure figure;
    figure.curves.push_back(
        {Numbers::own({0, 1, 2, 3, 4, 5, 6, 7, 8}), Numbers::own({1, 1, nan, 1, 1, 1, 1, 1, 1}), "", Style::fill});
    figure.curves[0].base = Numbers::own({0, 0, 0, 0, 0, nan, 0, 0, 0});
    const std::string script = gnuplot_file({&figure, 1}, {});
    std::size_t areas = 0;
    for (std::size_t at = script.find("filledcurves"); at != std::string::npos;
         at = script.find("filledcurves", at + 1)) {
        ++areas;
    }
    CHECK(areas == 3);
}

TEST_CASE("the size of the sheet is what was asked, in cm", "[gnuplot]") {
    const Figure figure = wave();
    const auto picture = run_gnuplot(gnuplot_input({&figure, 1}, Terminal::svg, {12.7, 5.08}));
    REQUIRE(picture);
    CHECK(picture->find("width=\"480\" height=\"192\"") != std::string::npos);  // 5 and 2 inches of 96 pixels
}

TEST_CASE("gaps, one point, no points, constants and extremes of range are drawn without complaint", "[gnuplot]") {
    const double nan = std::nan("");
    for (const auto& [x, y] :
         std::vector<std::pair<std::vector<double>, std::vector<double>>>{{{}, {}},
                                                                          {{1}, {2}},
                                                                          {{nan}, {nan}},
                                                                          {{0, 1, 2, 3, 4}, {0, 1, nan, 1, 0}},
                                                                          {{0, 1}, {3.7, 3.7}},
                                                                          {{0, 1e-9}, {0, 1e6}},
                                                                          {{0, 1}, {-1e300, 1e300}},
                                                                          {{1e6, 1e6 + 1e-6}, {1, 2}}}) {
        for (const Style style : {Style::line, Style::points, Style::fill}) {
            Figure figure;
            figure.curves.push_back({Numbers::own(x), Numbers::own(y), "", style});
            CHECK(svg(figure).find("</svg>") != std::string::npos);
        }
    }
}

TEST_CASE("ticks on the ends of an axis are drawn", "[gnuplot]") {
    Figure figure;
    figure.curves.push_back({Numbers::own({10, 100}), Numbers::own({0.3, 0.6})});
    figure.x.logarithmic = true;
    figure.y.limits = Interval{0.3, 0.6};
    const std::string picture = svg(figure);
    for (const char* tick : {">10<", ">100<", ">0.3", ">0.6"}) {
        CHECK(picture.find(tick) != std::string::npos);
    }
}

TEST_CASE("logarithmic axes go to the end of the numbers", "[gnuplot]") {
    Figure figure;
    figure.curves.push_back({Numbers::own({1e-300, 1e300}), Numbers::own({5e-324, 1e300})});
    figure.x.logarithmic = figure.y.logarithmic = true;
    CHECK(svg(figure).find("</svg>") != std::string::npos);
}

TEST_CASE("a line that leaves the window by far is drawn within it", "[gnuplot]") {
    for (const double far : {100.0, 1e12, 1e300}) {
        Figure figure;
        figure.curves.push_back({Numbers::own({0, 1, 2, 3, 4}), Numbers::own({0.5, far, 0.5, -far, 0.5}), ""});
        figure.y.limits = Interval{0, 1};
        const std::string picture = svg(figure);
        const std::size_t curve = picture.find("<path stroke='rgb(  0, 114, 178)'");
        REQUIRE(curve != std::string::npos);  // up near 0, down near 2 and up near 4
        CHECK(picture.substr(curve, picture.find('>', curve) - curve).size() > 100);
    }
}

TEST_CASE("an area that leaves the window is cut where its edge does", "[gnuplot]") {
    Figure figure;
    figure.curves.push_back({Numbers::own({0, 1, 2}), Numbers::own({0, 4, 0}), "", Style::fill});
    figure.y.limits = Interval{0, 1};
    const std::string script = gnuplot_file({&figure, 1}, {});
    CHECK(script.find("$data1 << end\n0 0\n0.25 1\n1.75 1\n2 0\n") != std::string::npos);
}

TEST_CASE("a phase plane that is flat or steep gets a sheet that fits it", "[gnuplot]") {
    Figure figure = spiral(1000);
    const auto height = [&] {
        const std::string picture = svg(figure);
        return std::stoi(picture.substr(picture.find("height=\"") + 8));
    };
    const int round = height();
    figure.y.limits = Interval{-0.02, 0.02};
    const int flat = height();
    CHECK(round > 250);
    CHECK(flat < 0.7 * round);
    figure.y.limits = Interval{-20, 20};
    CHECK(height() >= round - 1);
}

}  // namespace dinal::gnuplot_test
