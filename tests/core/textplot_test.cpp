#include "plots/text_plot.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "plots/ticks.hpp"
#include "support/catch.hpp"
#include "text/characters.hpp"

namespace dinal::textplot_test {

using namespace dinal::plots;
using namespace dinal::text;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Curve curve(std::vector<double> x, std::vector<double> y, std::string label = "") {
    return {Numbers::own(std::move(x)), Numbers::own(std::move(y)), std::move(label)};
}

Figure figure(Curve content) {
    Figure result;
    result.curves.push_back(std::move(content));
    return result;
}

std::string drawn(const Figure& content, int columns, int rows, Charset charset = Charset::braille) {
    return text_plot({&content, 1}, {.columns = columns, .rows = rows, .charset = charset});
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

std::vector<std::string> canvas_lines(const Canvas& canvas) {
    std::vector<std::string> lines;
    for (int row = 0; row < canvas.rows(); ++row) {
        std::string line;
        for (int column = 0; column < canvas.columns(); ++column) {
            line += canvas.text(canvas.cell(column, row), 0, '-');
        }
        lines.push_back(line);
    }
    return lines;
}

std::vector<double> even(double from, double to, int n) {
    std::vector<double> values;
    for (int i = 0; i < n; ++i) {
        values.push_back(from + (to - from) * i / (n - 1));
    }
    return values;
}

std::vector<std::string> tick_texts(double low, double high, int most) {
    return ticks_of({}, Scale({low, high}, false), most).text;
}

using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE("a braille cell has two by four dots, an ASCII cell one by two", "[textplot]") {
    Canvas braille(2, 1, Charset::braille);
    Pen(braille, 1).to(0, 0);
    Pen diagonal(braille, 1);
    diagonal.to(0, 0);
    diagonal.to(3, 3);
    CHECK(canvas_lines(braille) == Texts{"⠑⢄"});
    Canvas ascii(3, 1, Charset::ascii);
    ascii.dot(0, 0, 1);
    ascii.dot(1, 1, 1);
    ascii.dot(2, 0, 1);
    ascii.dot(2, 1, 1);
    CHECK(canvas_lines(ascii) == Texts{"'.:"});
}

TEST_CASE("a pen draws only inside of the canvas", "[textplot]") {
    Canvas canvas(2, 1, Charset::braille);
    Pen pen(canvas, 1);
    pen.to(-1e200, 1);
    pen.to(1e200, 1);
    CHECK(canvas_lines(canvas) == Texts{"⠒⠒"});
    Canvas empty(2, 1, Charset::braille);
    Pen outside(empty, 1);
    outside.to(-5, 0);
    outside.to(-1, -5);
    outside.to(20, -5);
    CHECK(canvas_lines(empty) == Texts{"⠀⠀"});
}

TEST_CASE("nan lifts the pen", "[textplot]") {
    Canvas canvas(3, 1, Charset::braille);
    Pen pen(canvas, 1);
    pen.to(0, 0);
    pen.to(1, 0);
    pen.to(not_a_number, 0);
    pen.to(4, 0);
    pen.to(5, 0);
    CHECK(canvas_lines(canvas) == Texts{"⠉⠀⠉"});
}

TEST_CASE("a small picture is correct to the last character", "[textplot]") {
    Figure line = figure(curve({0, 1, 2}, {0, 1, 0}));
    line.x.label = "t";
    line.y.label = "y";
    CHECK(lines_of(drawn(line, 24, 8, Charset::ascii)) == Texts{" y",                     //
                                                                "1 +        .'.",         //
                                                                "  |      .'   '.",       //
                                                                "  |    .'       :",      //
                                                                "  |  .'          '.",    //
                                                                "0 +.'- - - - - - - '.",  //
                                                                "  ++--------+-------+",  //
                                                                "   0        1       2 t"});
}

TEST_CASE("a picture has colours only on request", "[textplot]") {
    Figure two = figure(curve({0, 1}, {0, 1}, "a"));
    two.curves.push_back(curve({0, 1}, {1, 0}, "b"));
    CHECK(drawn(two, 60, 12).find('\x1b') == std::string::npos);
    const std::string coloured = text_plot({&two, 1}, {.columns = 60, .rows = 12, .colours = true});
    CHECK(coloured.find("\x1b[36m") != std::string::npos);
    Figure six = figure(curve({0, 1}, {0, 1}, "a"));
    for (const double y : {1, 2, 3, 4, 5}) six.curves.push_back(curve({0, 1}, {y, y}, "b"));
    const std::string rainbow = text_plot({&six, 1}, {.columns = 60, .rows = 12, .colours = true});
    for (const char* colour : {"\x1b[36m", "\x1b[33m", "\x1b[35m", "\x1b[32m", "\x1b[31m"}) {
        CHECK(rainbow.find(colour) != std::string::npos);
    }
    for (const std::string& line : lines_of(coloured)) {  // no line leaves the terminal coloured
        const std::size_t last = line.rfind("\x1b[");
        CHECK((last == std::string::npos || line.compare(last, 4, "\x1b[0m") == 0));
    }
}

TEST_CASE("no line is wider than requested, and there are no more lines", "[textplot]") {
    Figure family;
    for (int i = 0; i < 20; ++i) {
        family.curves.push_back(curve(even(0, 1, 50), even(0, i, 50), "curve number " + std::to_string(i)));
    }
    family.title = std::string(200, 'T');
    family.x.label = std::string(200, 'x');
    family.y.label = std::string(200, 'y');
    family.curves.push_back(curve({-1e-300, 1e300}, {0, 1.234567e-123}));
    for (const int columns : {20, 21, 22, 23, 24, 40, 79, 200}) {
        for (const Charset charset : {Charset::braille, Charset::ascii}) {
            const auto lines = lines_of(drawn(family, columns, 24, charset));
            CHECK(lines.size() <= 24);
            for (const std::string& line : lines) {
                CHECK(text::columns(line) <= static_cast<std::size_t>(columns));
            }
        }
    }
}

TEST_CASE("control sequences in a user's text do not reach the terminal", "[textplot]") {
    Figure hostile = figure(curve({0, 1}, {0, 1}, "\x1b]0;title\x07\n\x7f\xc2\23331m\xff"));
    hostile.title = hostile.x.label = hostile.y.label = hostile.curves[0].label;
    hostile.curves.push_back(hostile.curves[0]);
    for (const Charset charset : {Charset::braille, Charset::ascii}) {
        for (const std::string& line : lines_of(drawn(hostile, 79, 22, charset))) {
            CHECK(displayable(line) == line);
        }
    }
}

TEST_CASE("a circle is round: as many dots high as wide", "[textplot]") {
    std::vector<double> x, y;
    for (int i = 0; i <= 200; ++i) {
        x.push_back(std::cos(0.01 * i * 3.14159265));
        y.push_back(std::sin(0.01 * i * 3.14159265));
    }
    Figure circle = figure(curve(x, y));
    circle.equal = true;
    circle.axes = false;
    const auto lines = lines_of(drawn(circle, 79, 20));
    REQUIRE(lines.size() == 20);  // 80 dots high
    std::size_t widest = 0;
    for (const std::string& line : lines) {
        widest = std::max(widest, text::columns(line));
    }
    // The box has 6 % of air to the left and right but 5 above and below, so it is a little wider than 40 cells; the
    // right air is cut off as blanks.
    CHECK(widest >= 37);
    CHECK(widest <= 41);
}

TEST_CASE("stuck intervals are bars below the time axis, even the shortest", "[textplot]") {
    Figure run = figure(curve(even(0, 10, 50), even(0, 1, 50)));
    run.stuck = {{0, 0}, {5, 10}};
    const auto lines = lines_of(drawn(run, 50, 12, Charset::ascii));
    const auto bar =
        std::find_if(lines.begin(), lines.end(), [](const auto& line) { return line.starts_with("stuck"); });
    REQUIRE(bar != lines.end());
    CHECK(bar->substr(7, 3) == "=  ");
    const auto marks = std::count(bar->begin(), bar->end(), '=');
    CHECK(marks >= 20);  // half of 40 columns and the one at 0
    CHECK(marks <= 22);
}

TEST_CASE("letters distinguish curves without colours", "[textplot]") {
    Figure two = figure(curve(even(0, 1, 9), even(0, 1, 9), "up"));
    two.curves.push_back(curve(even(0, 1, 9), even(1, 0, 9), "down"));
    const std::string text = drawn(two, 40, 10);
    CHECK(text.find("a up   b down") != std::string::npos);
    const auto lines = lines_of(text);
    CHECK(lines[1].ends_with("a"));
    CHECK(lines[lines.size() - 3].ends_with("b"));
}

TEST_CASE("an empty curve, one point and a constant are drawn", "[textplot]") {
    CHECK(drawn(figure(curve({}, {})), 40, 10).find("(no points)") != std::string::npos);
    CHECK(drawn(figure(curve({not_a_number}, {not_a_number})), 40, 10).find("1.0") != std::string::npos);
    const std::string point = drawn(figure(curve({1}, {2})), 40, 12);
    CHECK(point.find("2.0") != std::string::npos);
    CHECK(point.find("1.0") != std::string::npos);
    CHECK(point.find("×") != std::string::npos);
    CHECK(drawn(figure(curve({0, 1}, {3.7, 3.7})), 40, 10).find("4.0") != std::string::npos);
    CHECK(drawn(figure(curve({0, 1}, {1e308, -1e308})), 40, 10).size() > 100);
}

TEST_CASE("the smallest and the largest numbers are drawn like others", "[textplot]") {
    CHECK(drawn(figure(curve({0, 5e-324, 1e-323}, {0, 5e-324, 0})), 40, 10).find("0 ┤") != std::string::npos);
    CHECK(drawn(figure(curve({0, 1e-300}, {0, 1e-300})), 40, 10).find("1e-300") != std::string::npos);
    CHECK(drawn(figure(curve({0, 1e300}, {-1e300, 1e300})), 40, 10).find("-1e300") != std::string::npos);
    Figure wide = figure(curve({1e-300, 1, 1e300}, {5e-324, 1, 1e300}));
    wide.x.logarithmic = wide.y.logarithmic = true;
    CHECK(drawn(wide, 40, 10).find("1e") != std::string::npos);
    for (const double value : {5e-324, 1e-310, 1e-300, 1.0, 1e300}) {
        CHECK(drawn(figure(curve({value}, {value})), 40, 10).size() > 100);
        Figure equal = figure(curve({0, value}, {0, 1}));
        equal.equal = equal.circles = true;
        CHECK(drawn(equal, 40, 10).size() > 100);
    }
}

TEST_CASE("infinity is a gap", "[textplot]") {
    const double infinity = std::numeric_limits<double>::infinity();
    Figure broken = figure(curve({0, 1, 2, 3}, {0, 1, infinity, 1}));
    CHECK(view_of(broken).y.range().high == Approx(1.05));
}

TEST_CASE("a picture of a part of the time shows the values in that part", "[textplot]") {
    Figure zoomed = figure(curve({0, 1, 2, 3}, {100, 1, 2, 100}));
    zoomed.x.limits = Interval{1, 2};
    CHECK(view_of(zoomed).y.range().high == Approx(2.05));
}

TEST_CASE("a window far away from the curves is drawn, too", "[textplot]") {
    for (const double far : {-1e9, 1e9, 1e200}) {
        for (const Style style : {Style::line, Style::points, Style::fill}) {
            Figure far_off = figure(curve({0, 1, 0.5}, {0, 1, 2}));
            far_off.curves[0].style = style;
            far_off.marks = {{1, 1, MarkKind::start}};
            far_off.stuck = {{0, 1}};
            far_off.dead_zone = Interval{-1, 1};
            far_off.equal = far_off.circles = true;
            for (Axis* axis : {&far_off.x, &far_off.y}) {
                axis->limits = Interval{far, far + std::fabs(far) / 1000};
                CHECK(drawn(far_off, 40, 12).find("(no points)") != std::string::npos);
            }
        }
    }
}

TEST_CASE("ticks are round numbers with as many digits as they need", "[ticks]") {
    CHECK(tick_texts(0, 20, 6) == Texts{"0", "5", "10", "15", "20"});
    CHECK(tick_texts(-1, 1, 4) == Texts{"-1.0", "-0.5", "0.0", "0.5", "1.0"});
    CHECK(tick_texts(0, 1e-9, 5) == Texts{"0", "2e-10", "4e-10", "6e-10", "8e-10", "1e-9"});
    CHECK(tick_texts(0, 1e6, 5) == Texts{"0", "2e5", "4e5", "6e5", "8e5", "1e6"});
    CHECK(tick_texts(0, 5e4, 5) == Texts{"0", "10000", "20000", "30000", "40000", "50000"});
    CHECK(tick_texts(-0.3, 0.3, 2) == Texts{"-0.2", "0.0", "0.2"});  // one tick alone would give no scale
}

TEST_CASE("ticks that begin alike show the difference, and the label the offset", "[ticks]") {
    const Ticks ticks = ticks_of({}, Scale({1e6, 1e6 + 1e-3}, false), 5);
    CHECK(ticks.offset == "+1000000");
    CHECK(ticks.text.front() == "0.0000");
    CHECK(ticks.text.back() == "0.0010");
}

TEST_CASE("the offset of ticks is the round number in their middle", "[ticks]") {
    const Ticks about = ticks_of({}, Scale({1e9 - 1.1e-3, 1e9 + 1.1e-3}, false), 3);
    CHECK(about.offset == "+1000000000");
    CHECK(about.text == Texts{"-0.001", "0.000", "0.001"});
    const Ticks below = ticks_of({}, Scale({-273.15 - 1.1e-6, -273.15 + 1.1e-6}, false), 3);
    CHECK(below.offset == "-273.15");
    CHECK(below.text == Texts{"-1e-6", "0", "1e-6"});
}

TEST_CASE("ticks are as exact as the numbers they stand for", "[ticks]") {
    const Ticks ticks = ticks_of({}, Scale({1e9 - 1.1e-3, 1e9 + 1.1e-3}, false), 5);
    CHECK(ticks.text == Texts{"-0.0010", "-0.0005", "0.0000", "0.0005", "0.0010"});
}

TEST_CASE("ticks can be given by their distance or one by one", "[ticks]") {
    Axis axis;
    axis.division = 0.25;
    CHECK(ticks_of(axis, Scale({0, 0.6}, false), 3).text == Texts{"0.00", "0.25", "0.50"});
    axis.ticks = {0, 1.5707963267948966, 3.14159265358979, 99};
    CHECK(ticks_of(axis, Scale({0, 5}, false), 3).text == Texts{"0.0000", "1.5708", "3.1416"});
}

TEST_CASE("a logarithmic axis has powers of ten, or less round numbers when it is short", "[ticks]") {
    CHECK(ticks_of({}, Scale({1e-4, 1e2}, true), 6).text == Texts{"1e-4", "1e-3", "1e-2", "1e-1", "1", "1e1", "1e2"});
    CHECK(ticks_of({}, Scale({1e-12, 1}, true), 4).text == Texts{"1e-12", "1e-9", "1e-6", "1e-3", "1"});
    CHECK(ticks_of({}, Scale({1, 10}, true), 5).text == Texts{"1", "2", "5", "10"});
}

TEST_CASE("text without UTF-8 spells Greek letters", "[textplot]") {
    CHECK(in_ascii("θ'/ω₀, rad") == "theta'/omega0, rad");
    CHECK(text::columns("θ'/ω₀") == 5);
    CHECK(cut_to_columns("θθθ", 2) == "θθ");
    CHECK(displayable("a\nb\xff") == "a b\xEF\xBF\xBD");
}

}  // namespace dinal::textplot_test
