// Pictures in files: positions read from the dots of a PNG or from the text of an SVG.
#include "plots/painter.hpp"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>

#include "plots/shades.hpp"
#include "plots/svg_words.hpp"
#include "support/catch.hpp"

namespace dinal::painter_test {

using namespace dinal::plots;

namespace {

const double nan = std::nan("");
constexpr std::uint32_t blue = 0x0072B2, white = 0xFFFFFF;

Figure curve_of(std::vector<double> x, std::vector<double> y, Style style = Style::line) {
    Figure figure;
    figure.curves.push_back({Numbers::own(std::move(x)), Numbers::own(std::move(y)), "", style});
    return figure;
}

Figure wave(std::size_t n = 200) {
    std::vector<double> t, y;
    for (std::size_t i = 0; i < n; ++i) {
        t.push_back(100.0 * static_cast<double>(i) / static_cast<double>(n));
        y.push_back(std::exp(-0.01 * t.back()) * std::cos(5 * t.back()));
    }
    Figure figure = curve_of(t, y);
    figure.curves[0].label = "θ";
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
    Figure figure = curve_of(x, y);
    figure.equal = figure.circles = true;
    figure.dead_zone = Interval{-0.1, 0.1};
    figure.marks = {{1, 0, MarkKind::start}, {0, 0, MarkKind::end}};
    return figure;
}

/// Numbers from 0 to 1 (Knuth's MMIX).
class Random {
public:
    double operator()() {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;
        return static_cast<double>(state_ >> 11U) / 9007199254740992.0;
    }

private:
    std::uint64_t state_ = 1;
};

std::string drawn(const Figure& figure, PictureKind kind, PaperSize size = {}) {
    const auto picture = paint({&figure, 1}, kind, size);
    if (!picture) FAIL(picture.error().sentence);
    return *picture;
}
std::string svg(const Figure& figure) {
    return drawn(figure, PictureKind::svg);
}

/// The number of pixels of the image in a picture.
double pixels_of(const std::string& picture) {
    const std::size_t at = picture.find("<image ");
    if (at == std::string::npos) FAIL("no image");
    double pixels = 1;
    for (const char* side : {" width=\"", " height=\""}) {
        pixels *= std::stod(picture.substr(picture.find(side, at) + std::string(side).size()));
    }
    return pixels;
}

/// A PNG whose dots are looked up by the values that stand there.
class Dots {
public:
    explicit Dots(const Figure& figure) : panel_(lay_out({&figure, 1}, {}).panels[0]) {
        const std::string bytes = drawn(figure, PictureKind::png);
        const char* next = bytes.data();
        const auto read = [](void* from, unsigned char* to, unsigned int count) {
            const char*& place = *static_cast<const char**>(from);
            std::memcpy(to, place, count);
            place += count;
            return CAIRO_STATUS_SUCCESS;
        };
        image_.reset(cairo_image_surface_create_from_png_stream(read, &next));
        REQUIRE(cairo_surface_status(image_.get()) == CAIRO_STATUS_SUCCESS);
    }

    /// 0xRRGGBB
    [[nodiscard]] std::uint32_t at(double x, double y) const {
        return at_fractions(panel_.view.x(x), panel_.view.y(y));
    }
    [[nodiscard]] std::uint32_t at_fractions(double x, double y) const {
        return at_pixel(panel_.left + x * (panel_.right - panel_.left),
                        panel_.bottom - y * (panel_.bottom - panel_.top));
    }
    /// From the left and from the top of the sheet.
    [[nodiscard]] std::uint32_t at_pixel(double x, double y) const {
        constexpr double dots = 3;  // to the pixel
        const auto right = static_cast<std::ptrdiff_t>(dots * x), down = static_cast<std::ptrdiff_t>(dots * y);
        std::uint32_t dot = 0;
        std::memcpy(&dot,
                    cairo_image_surface_get_data(image_.get()) + down * cairo_image_surface_get_stride(image_.get()) +
                        4 * right,
                    sizeof(dot));
        return dot & 0xFFFFFFU;
    }
    /// The part of the dots that are not white.
    [[nodiscard]] double ink(Interval x, Interval y) const {
        int count = 0, inked = 0;
        for (double i = x.low; i < x.high; i += x.length() / 100) {
            for (double j = y.low; j < y.high; j += y.length() / 100) {
                ++count;
                inked += at(i, j) == white ? 0 : 1;
            }
        }
        return static_cast<double>(inked) / count;
    }

    [[nodiscard]] const PaperPanel& panel() const { return panel_; }

private:
    PaperPanel panel_;
    std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> image_{nullptr, cairo_surface_destroy};
};

}  // namespace

TEST_CASE("an image has four million pixels on a large sheet, and not more", "[painter]") {
    const double pixels = pixels_of(drawn(spiral(200000), PictureKind::svg, {1600, 1300}));
    CHECK(pixels == Approx(4e6).epsilon(0.01));
}

TEST_CASE("any text appears in a picture as it was written", "[painter]") {
    for (const char* words : {"I θ″ + C θ′", "a\\ b", "x\\n", "100 %s", "@a_b^{c} ~", "`ls` $(ls)"}) {
        Figure figure = wave();
        figure.title = figure.x.label = figure.curves[0].label = words;
        CAPTURE(words);
        const std::string picture = svg(figure), text = std::string(">") + words + "</text>";
        CHECK(picture.find(text, picture.find(text, picture.find(text) + 1) + 1) != std::string::npos);
        CHECK(drawn(figure, PictureKind::pdf).substr(0, 4) == "%PDF");
    }
    Figure figure = wave();
    figure.title = "</text><script>\xff\n'\"&";
    CHECK(svg(figure).find(">&lt;/text&gt;&lt;script&gt;\uFFFD &#39;&quot;&amp;</text>") != std::string::npos);
}

TEST_CASE("a picture has a description for readers who cannot see it", "[painter]") {
    Figure figure = wave();
    figure.stuck = {{10, 20}};
    const std::string picture = svg(figure);
    CHECK(picture.find("<title>θ over t</title>") != std::string::npos);
    CHECK(picture.find(" role=\"img\" aria-label=\"θ over t\"") != std::string::npos);
    CHECK(picture.find("<desc>Across: t, 0 to 99.5. Up: θ, rad, -0.9381 to 1.092. θ: from 1 to ") != std::string::npos);
    CHECK(picture.find(" half swings that ") != std::string::npos);
    CHECK(picture.find(". Stuck from 10 to 20.</desc>") != std::string::npos);
    figure.title = "a < b & 'c'";
    CHECK(svg(figure).find("<title>a &lt; b &amp; ") != std::string::npos);
}

TEST_CASE("the description of a picture says what each curve does", "[painter]") {
    const auto described = [](std::vector<double> x, std::vector<double> y, Style style = Style::line) {
        Figure figure = curve_of(std::move(x), std::move(y), style);
        figure.curves[0].label = "A";
        const std::string words = with_words("<svg></svg>", {&figure, 1});
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
    CHECK(described({1, 2, 3}, {0, nan, 1}) == "A: rises from 0 to 1.");
    CHECK(described({1, 2}, {4, 5}, Style::fill) == "A: an area across from 1 to 2, up from 0 to 5.");
}

TEST_CASE("the title of a picture of many curves names its axes", "[painter]") {
    Figure figure = wave();
    figure.curves.assign(4, figure.curves.front());
    CHECK(title_of({&figure, 1}) == "θ over t");
    figure.y.label = "";
    CHECK(title_of({&figure, 1}) == "θ, θ, θ and 1 more over t");
}

TEST_CASE("pictures on one page have different element ids, and no other differences", "[painter]") {
    const std::string picture = svg(wave());
    CHECK(picture == svg(wave()));
    Figure other = wave();
    other.y.limits = Interval{-0.5, 0.5};
    const auto names = [](const std::string& text) {
        std::vector<std::string> all;
        for (std::size_t at = text.find("id=\""); at != std::string::npos; at = text.find("id=\"", at + 1)) {
            all.push_back(text.substr(at, text.find('"', at + 4) - at));
        }
        return all;
    };
    const auto first = names(element_of(picture)), second = names(element_of(svg(other)));
    REQUIRE_FALSE(first.empty());  // cairo 1.16 names the sheet and a clip, 1.18 only the clip
    CHECK(std::find_first_of(first.begin(), first.end(), second.begin(), second.end()) == first.end());
    CHECK(element_of(picture).starts_with("<svg"));
}

TEST_CASE("an SVG of a million points is smaller than 200 kB", "[painter][long]") {
    CHECK(svg(wave(1'000'000)).size() < 200'000);
    CHECK(svg(spiral(1'000'000)).size() < 200'000);
    Figure many;
    for (int i = 0; i < 20; ++i) many.curves.push_back(wave(100'000).curves[0]);
    CHECK(svg(many).size() < 200'000);
}

TEST_CASE("an SVG of many random points or lines is smaller than 200 kB", "[painter][long]") {
    Random random;
    for (const std::size_t count : {5'000U, 100'000U}) {
        std::vector<double> x(count), y(count);
        std::generate(x.begin(), x.end(), std::ref(random));
        std::generate(y.begin(), y.end(), std::ref(random));
        for (const Style style : {Style::line, Style::points}) {
            const std::string picture = svg(curve_of(x, y, style));
            CAPTURE(count, style);
            CHECK(picture.size() < 200'000);
            CHECK(picture.size() > 5'000);
        }
    }
}

TEST_CASE("a line is drawn at its coordinates, on all axes", "[painter]") {
    const Dots straight(curve_of({0, 10}, {-1, 1}));
    CHECK(straight.at(2.5, -0.5) == blue);
    CHECK(straight.at(2.5, -0.3) == white);
    Figure figure = curve_of({1, 1e4}, {1e-3, 1e3});
    figure.x.logarithmic = figure.y.logarithmic = true;
    const Dots logarithmic(figure);
    CHECK(logarithmic.at(std::pow(10, 1.7), std::pow(10, -0.45)) == blue);
    CHECK(logarithmic.at(std::pow(10, 1.7), 3) == white);
}

TEST_CASE("a point between gaps is drawn as a dot, and so is a curve shorter than a pixel", "[painter]") {
    const Dots gaps(curve_of({0, 1, 2, 3, 4}, {0, 1, nan, 2, nan}));
    CHECK(gaps.at(3, 2) == blue);
    CHECK(gaps.at(0.5, 0.5) == blue);
    CHECK(gaps.at(2.4, 1.7) == white);
    CHECK(Dots(curve_of({7}, {7})).at(7, 7) == blue);
    CHECK(Dots(curve_of({1, 1 + 1e-15}, {1, 1 + 1e-15})).at(1, 1) == blue);
}

TEST_CASE("an area extends to its other edge, and has a gap if either edge has one", "[painter]") {
    Figure figure = curve_of({0, 1, 2, 3, 4, 5, 6, 7, 8}, {3, 3, nan, 3, 3, 3, 3, 3, 3}, Style::fill);
    const Dots to_zero(figure);
    CHECK(to_zero.at(5.7, 0.2) != white);
    figure.curves[0].base = Numbers::own({1, 1, 1, 1, 1, nan, 1, 1, 1});
    const Dots between(figure);
    for (const double x : {0.7, 3.3, 6.7}) {
        CHECK(between.at(x, 2) != white);
        CHECK(between.at(x, 0.8) == white);
    }
    for (const double x : {1.7, 2.3, 4.7, 5.3}) CHECK(between.at(x, 2.2) == white);
}

TEST_CASE("curves far outside the window are clipped", "[painter]") {
    for (const double far : {100.0, 1e12, 1e300}) {
        Figure figure = curve_of({0, 1, 2, 3, 4}, {0.5, far, 0.5, -far, 0.5});
        figure.y.limits = Interval{0, 1};
        const Dots line(figure);
        CAPTURE(far);
        CHECK(line.at(3.998, 0.3) == blue);
        CHECK(line.at(2, 0.7) == blue);
        CHECK(line.at(0.9, 0.7) == white);
        CHECK(line.at(2.9, 0.7) == white);
        CHECK(line.at_fractions(0.25, 1.02) == white);
    }
    Figure area = curve_of({0, 1, 2}, {0, 4, 0}, Style::fill);
    area.y.limits = Interval{0, 1};
    const Dots dots(area);
    CHECK(dots.at(0.23, 0.9) != white);  // its edge is at 0.225 there
    CHECK(dots.at(0.22, 0.9) == white);
    CHECK(dots.at(1.77, 0.9) != white);
}

TEST_CASE("a crowd of points is darker in denser places", "[painter]") {
    // 40000 points, three in four of them in the left tenth.
    std::vector<double> x, y;
    Random random;
    for (int i = 0; i < 40'000; ++i) {
        x.push_back(random() * (i % 4 == 0 ? 1 : 0.1));
        y.push_back(random());
    }
    const Dots dots(curve_of(x, y, Style::points));
    CHECK(dots.ink({0.01, 0.09}, {0.01, 0.99}) > 4 * dots.ink({0.2, 0.99}, {0.01, 0.99}));
    CHECK(dots.ink({0.2, 0.99}, {0.01, 0.99}) > 0.02);
}

TEST_CASE("a map has the shade of each value at its coordinates", "[painter]") {
    Figure figure;
    figure.shades = std::make_shared<Shades>(Shades{{0, 1}, {1, 10, 100}, {0, 1, 2, 3, nan, 4}});
    figure.y.logarithmic = true;
    const Dots dots(figure);
    CHECK(dots.at(0.2, 2) == shade_colour(0, 5));
    CHECK(dots.at(0.8, 2) == shade_colour(1, 5));
    CHECK(dots.at(0.2, 7) == shade_colour(2, 5));
    CHECK(dots.at(0.8, 70) == shade_colour(4, 5));
    const auto empty = dots.at(0.2, 70);
    CHECK((empty == white || empty == 0xA8A8A8));  // stripes
}

TEST_CASE("the colours of a map are continuous, and zeros of a positive quantity are striped", "[painter]") {
    Figure figure;
    figure.shades = std::make_shared<Shades>(Shades{{0, 1}, {0, 1}, {0, 0.5, 1, 2.5}});
    const Dots dots(figure);
    CHECK(dots.at(1, 0) == continuous_colour(0.2));
    CHECK(dots.at(0, 1) == continuous_colour(0.4));
    CHECK(dots.at(1, 1) == continuous_colour(1));
    const auto nothing = dots.at(0, 0);
    CHECK((nothing == 0xECECEC || nothing == 0xA8A8A8));
}

TEST_CASE("marks, the dead zone and bars for sticking are at their coordinates", "[painter]") {
    Figure figure = curve_of({-1, 1}, {-1, 1});
    figure.marks = {{0.5, -0.5, MarkKind::end}};
    figure.dead_zone = Interval{-0.6, -0.2};
    figure.stuck = {{0.5, 0.7}};
    const Dots dots(figure);
    CHECK(dots.at(0.5, -0.5) == 0x444444);
    CHECK(dots.at(-0.4, 0) == 0xB0B0B0);
    CHECK(dots.at(-0.7, 0) != 0xB0B0B0);
    const double below = -6.5 / 180;  // of the height of the box: between the axis and the numbers
    CHECK(dots.at_fractions(0.82, below) == 0x444444);
    CHECK(dots.at_fractions(0.65, below) == white);
}

TEST_CASE("no line joins a word of the legend with its sample", "[painter]") {
    Figure figure = curve_of({-1, 0, 1}, {-1, 0, 1}, Style::points);
    figure.curves[0].label = "points";
    figure.marks = {
        {0, 0, MarkKind::start}, {0, 1, MarkKind::end}, {1, 0, MarkKind::impact}, {1, 1, MarkKind::switched}};
    const Dots dots(figure);
    REQUIRE(dots.panel().legend.size() == 5);
    for (const LegendEntry& entry : dots.panel().legend) {
        const double end = entry.x + sample_width(entry.sample);
        CAPTURE(entry.text);
        for (double y = entry.y - 3; y < entry.y + 3; y += 0.3)
            CHECK(dots.at_pixel(end + after_sample / 2, y) == white);
    }
}

TEST_CASE("the size of the sheet is the requested one, in cm", "[painter]") {
    const Figure figure = wave();
    const std::string picture = drawn(figure, PictureKind::svg, {12.7, 5.08});
    CHECK(picture.find("width=\"480px\" height=\"192px\"") != std::string::npos);  // 5 and 2 inches of 96 pixels
    const std::string png = drawn(figure, PictureKind::png, {12.7, 5.08});
    CHECK(png.substr(16, 8) == std::string("\0\0\x05\xA0\0\0\x02\x40", 8));  // 1440 and 576 dots: 288 to the inch
}

TEST_CASE("gaps, one point, no points, constants and extremes of range are drawn without complaint", "[painter]") {
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
            const std::string picture = svg(curve_of(x, y, style));
            const bool none = x.empty() || std::isnan(x[0]);
            CHECK((picture.find("(no points)") != std::string::npos) == none);
        }
    }
    Figure figure = curve_of({1e-300, 1e300}, {5e-324, 1e300});
    figure.x.logarithmic = figure.y.logarithmic = true;
    CHECK(svg(figure).ends_with("</svg>\n"));
}

TEST_CASE("ticks on the ends of an axis are drawn", "[painter]") {
    Figure figure = curve_of({10, 100}, {0.3, 0.6});
    figure.x.logarithmic = true;
    figure.y.limits = Interval{0.3, 0.6};
    const std::string picture = svg(figure);
    for (const char* tick : {">10<", ">100<", ">0.3", ">0.6"}) CHECK(picture.find(tick) != std::string::npos);
}

TEST_CASE("a phase plane that is flat or steep gets a sheet that fits it", "[painter]") {
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

TEST_CASE("drawing ends on request", "[painter]") {
    int calls = 0;
    const Figure figure = spiral(100'000);
    const auto picture = paint({&figure, 1}, PictureKind::svg, {}, [&calls] { return ++calls < 10; });
    REQUIRE(!picture);
    CHECK(picture.error().sentence == "the picture was not drawn: drawing was interrupted");
}

}  // namespace dinal::painter_test
