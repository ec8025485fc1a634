#include "plots/text_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "plots/figure.hpp"
#include "plots/shades.hpp"
#include "plots/ticks.hpp"
#include "text/characters.hpp"

namespace dinal::plots {

namespace {

// Unicode numbers the dots of a braille cell down the left column, down the right one, and then along the lowest row.
constexpr std::array<std::array<std::uint8_t, 4>, 2> braille_bits{{{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}}};

std::string braille(std::uint8_t dots) {  // U+2800 + dots
    return {'\xE2', static_cast<char>(0xA0U | (dots >> 6U)), static_cast<char>(0x80U | (dots & 0x3FU))};
}

constexpr double dot_reach = 0.49;  // tolerance in dots: a value at the limit must not be lost by rounding

}  // namespace

Canvas::Canvas(int columns, int rows, Charset charset)
    : columns_(columns),
      rows_(rows),
      charset_(charset),
      cell_width_(charset == Charset::braille ? 2 : 1),
      cell_height_(charset == Charset::braille ? 4 : 2),
      cells_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

std::size_t Canvas::place(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
}

const Canvas::Cell& Canvas::cell(int column, int row) const {
    return cells_[place(column, row)];
}

bool Canvas::has_ink() const {
    return std::ranges::any_of(cells_, [](const Cell& cell) { return cell.ink != 0; });
}

Canvas::Cell* Canvas::cell_of_dot(int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < width() && y < height();
    return inside ? &cells_[place(x / cell_width_, y / cell_height_)] : nullptr;
}

void Canvas::dot(int x, int y, std::uint8_t ink) {
    Cell* const cell = cell_of_dot(x, y);
    if (cell == nullptr) {
        return;
    }
    const std::uint8_t bit =
        braille_bits[static_cast<std::size_t>(x % cell_width_)][static_cast<std::size_t>(y % cell_height_)];
    if (ink == 0) {
        cell->behind = static_cast<std::uint8_t>(cell->behind | bit);
        return;
    }
    cell->dots = static_cast<std::uint8_t>(cell->dots | bit);
    if (cell->ink == 0) {
        cell->ink = ink;
    }
}

void Canvas::glyph(int x, int y, std::string_view character, std::uint8_t ink) {
    if (Cell* const cell = cell_of_dot(x, y)) {
        cell->glyph = character;
        cell->ink = ink;
    }
}

void Canvas::glyph_if_free(int x, int y, std::string_view character) {
    Cell* const cell = cell_of_dot(x, y);
    if (cell != nullptr && cell->dots == 0) {
        cell->glyph = character;
    }
}

std::string Canvas::text(const Cell& cell, char mark, char behind) const {
    if (!cell.glyph.empty()) {
        return std::string(cell.glyph);
    }
    if (charset_ == Charset::braille) {
        return braille(static_cast<std::uint8_t>(cell.dots | cell.behind));
    }
    if (cell.dots != 0 && mark != 0) {
        return {mark};
    }
    constexpr std::array<char, 4> halves{' ', '\'', '.', ':'};
    return {cell.dots != 0 ? halves[cell.dots & 3U] : cell.behind != 0 ? behind : ' '};
}

void Pen::to(double x, double y) {
    if (std::isnan(x) || std::isnan(y)) {
        down_ = false;
        return;
    }
    if (down_ && std::fabs(x - last_x_) < dot_reach && std::fabs(y - last_y_) < dot_reach && last_x_ >= 0) {
        x_ = x;
        y_ = y;
        return;  // this is the usual case for a million points
    }
    // A clamped point this far away has almost the same direction; without clamping, clipping would lose all digits.
    constexpr double far = 1e7;
    x = std::clamp(x, -far, far);
    y = std::clamp(y, -far, far);
    const double from_x = std::exchange(x_, x);
    const double from_y = std::exchange(y_, y);
    Line line{{down_ ? from_x : x, down_ ? from_y : y}, {x, y}};
    down_ = true;
    if (clip(line, {canvas_.width() - 1.0, canvas_.height() - 1.0}, dot_reach)) {
        this->line(nearest_dot(line.from.x), nearest_dot(line.from.y), nearest_dot(line.to.x), nearest_dot(line.to.y));
    }
}

void Pen::step(int x, int y) {
    if (x == last_x_ && y == last_y_) {
        return;
    }
    last_x_ = x;
    last_y_ = y;
    if (count_ < on_) {
        canvas_.dot(x, y, ink_);
    }
    count_ = (count_ + 1) % period_;
}

void Pen::line(int x, int y, int to_x, int to_y) {  // Bresenham's algorithm
    const int dx = std::abs(to_x - x);
    const int dy = -std::abs(to_y - y);
    const int step_x = x < to_x ? 1 : -1;
    const int step_y = y < to_y ? 1 : -1;
    int error = dx + dy;
    for (;;) {
        step(x, y);
        if (x == to_x && y == to_y) {
            return;
        }
        const int twice = 2 * error;
        if (twice >= dy) {
            error += dy;
            x += step_x;
        }
        if (twice <= dx) {
            error += dx;
            y += step_y;
        }
    }
}
namespace {

// ---- The curves of a figure on a canvas, without the frame.

/// Maps values to dots of the canvas.
struct Projection {
    View view;
    Box box;  // size in dots between the edges
    double x(double value) const { return view.x.has(value) ? view.x(value) * (box.width - 1) : std::nan(""); }
    double y(double value) const { return view.y.has(value) ? (1 - view.y(value)) * (box.height - 1) : std::nan(""); }
};

struct Signs {
    std::array<std::string_view, 4> marks;  ///< by MarkKind
    std::string_view point, dead_zone;
};

constexpr std::size_t most_glyphs = 200;  // more points are drawn as dots
constexpr std::size_t alphabet_size = 52;
constexpr std::string_view alphabet = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

/// The letter of curve 1, 2, ...
char letter(std::size_t ink) {
    return alphabet[(ink - 1) % alphabet_size];
}

/// Returns whether letters identify the curves: if there are at least two.
bool uses_letters(const Figure& figure) {
    return figure.curves.size() > 1;
}

/// Returns whether letters are placed at the right ends of the curves; with many curves they are placed along these.
bool letters_at_ends(const Figure& figure) {
    return uses_letters(figure) && figure.curves.size() <= 4;
}

/// The ink of curve 0, 1, ...
std::uint8_t ink_of(std::size_t curve) {
    return static_cast<std::uint8_t>(curve % 255 + 1);
}

struct Dashing {
    int on, period;
};

/// The dash pattern of a curve; beyond four, only letters distinguish them.
Dashing stroke_of(const Figure& figure, std::size_t curve, Charset charset) {
    constexpr std::array<Dashing, 4> strokes{{{1, 1}, {1, 2}, {5, 8}, {1, 4}}};
    if (charset == Charset::ascii && uses_letters(figure)) {
        return strokes[0];  // each dot is the letter of its curve
    }
    switch (figure.curves[curve].dashes) {
        case Dashes::solid:
            return strokes[0];
        case Dashes::dashed:
            return strokes[2];
        case Dashes::dotted:
            return strokes[1];
        case Dashes::dash_dotted:
            return strokes[3];
        case Dashes::by_place:
            break;
    }
    return figure.curves.size() <= strokes.size() ? strokes[curve] : strokes[0];
}

void draw_line(Pen pen, const Curve& curve, const Projection& projection) {
    const double* x = curve.x.values.data();
    const double* y = curve.y.values.data();
    const std::size_t n = curve.size();
    for (std::size_t i = 0; i < n; ++i) {
        pen.to(projection.x(x[i]), projection.y(y[i]));
    }
}

void draw_points(Canvas& canvas, const Curve& curve, const Projection& projection, std::uint8_t ink,
                 std::string_view glyph) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const double x = projection.x(curve.x.values[i]);
        const double y = projection.y(curve.y.values[i]);
        if (x > -0.5 && y > -0.5 && x < projection.box.width && y < projection.box.height) {
            const int column = nearest_dot(x);
            const int row = nearest_dot(y);
            if (curve.size() <= most_glyphs) {
                canvas.glyph(column, row, glyph, ink);
            } else {
                canvas.dot(column, row, ink);
            }
        }
    }
}

/// Fills with every second dot in every second row between the curve and its base.
void draw_fill(Canvas& canvas, const Curve& curve, const Projection& projection, std::uint8_t ink) {
    const double zero = projection.view.y.logarithmic() ? projection.box.height : projection.y(0);
    const auto base = [&](std::size_t i) { return curve.base ? projection.y(curve.base->values[i]) : zero; };
    for (std::size_t i = 1; i < curve.size(); ++i) {
        double x0 = projection.x(curve.x.values[i - 1]);
        double x1 = projection.x(curve.x.values[i]);
        double y0 = projection.y(curve.y.values[i - 1]), b0 = base(i - 1);
        double y1 = projection.y(curve.y.values[i]), b1 = base(i);
        if (std::isnan(x0 + x1 + y0 + y1 + b0 + b1)) {
            continue;
        }
        if (x1 < x0) {
            std::swap(x0, x1);
            std::swap(y0, y1);
            std::swap(b0, b1);
        }
        const int last = static_cast<int>(std::clamp(x1, -1.0, projection.box.width - 1));
        for (int x = static_cast<int>(std::ceil(std::clamp(x0, 0.0, projection.box.width))); x <= last; ++x) {
            const double part = x1 > x0 ? (x - x0) / (x1 - x0) : 0;
            const double y = y0 + part * (y1 - y0);
            const double b = b0 + part * (b1 - b0);
            const int bottom = static_cast<int>(std::clamp(std::max(y, b), -1.0, projection.box.height - 1));
            for (int dot = static_cast<int>(std::ceil(std::clamp(std::min(y, b), 0.0, projection.box.height)));
                 dot <= bottom; ++dot) {
                if (x % 2 == 0 && dot % 2 == 0) {
                    canvas.dot(x, dot, ink);
                }
            }
        }
    }
    draw_line(Pen(canvas, ink), curve, projection);
}

void draw_circle(Canvas& canvas, const Projection& projection, double radius) {
    const double size = radius / projection.view.x.range().length() * (projection.box.width - 1);
    constexpr double gap = 4;     // dots between circles
    constexpr double most = 1e4;  // if the window is far from the origin, only an arc is visible
    const int count = static_cast<int>(std::min(2 * std::numbers::pi * size / gap, most));
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        canvas.dot(nearest_dot(projection.x(radius * std::cos(angle))),
                   nearest_dot(projection.y(radius * std::sin(angle))), 0);
    }
}

bool inside(const Scale& scale, double value) {
    return value > scale.range().low && value < scale.range().high;
}

void draw_background(Canvas& canvas, const Figure& figure, const Projection& projection,
                     const std::vector<double>& circles) {
    if (!projection.view.y.logarithmic() && inside(projection.view.y, 0)) {
        const int row = nearest_dot(projection.y(0));
        for (int x = 0; x < projection.box.width; x += 2) {
            canvas.dot(x, row, 0);
        }
    }
    if (figure.circles) {
        for (const double radius : circles) {
            draw_circle(canvas, projection, radius);
        }
        const int column = nearest_dot(projection.x(0));
        for (int y = 0; inside(projection.view.x, 0) && y < projection.box.height; y += 2) {
            canvas.dot(column, y, 0);
        }
    }
}

/// Draws the dead zone where no curve is.
void draw_dead_zone(Canvas& canvas, Interval zone, const Projection& projection, std::string_view sign) {
    const int row = nearest_dot(projection.y(0));
    const double from = std::max(projection.x(zone.low), 0.0);
    const double to = std::min(projection.x(zone.high), projection.box.width - 1);
    for (int x = nearest_dot(from); x <= to; ++x) {
        canvas.glyph_if_free(x, row, sign);
    }
}

/// Places one letter on each curve, each farther along than the previous one, so that letters are apart even if curves
/// are not.
void draw_letters(Canvas& canvas, const Figure& figure, const Projection& projection) {
    for (std::size_t i = 0; i < figure.curves.size(); ++i) {
        const Curve& curve = figure.curves[i];
        for (std::size_t n = (i + 1) * curve.size() / (figure.curves.size() + 1); n < curve.size(); ++n) {
            const double x = projection.x(curve.x.values[n]) + 0.5;
            const double y = projection.y(curve.y.values[n]) + 0.5;
            if (x >= 0 && y >= 0 && x < projection.box.width && y < projection.box.height) {
                canvas.glyph(static_cast<int>(x), static_cast<int>(y), alphabet.substr(i % alphabet_size, 1),
                             ink_of(i));
                break;
            }
        }
    }
}

/// Draws a character for the value at the middle of each cell, except on curves.
void draw_shades(Canvas& canvas, const Shades& shades, const Projection& projection, Charset charset) {
    const std::vector<ShadeBand> bands = bands_of(shades, most_text_bands);
    const std::vector<double> x = edges_between(shades.x, projection.view.x.logarithmic());
    const std::vector<double> y = edges_between(shades.y, projection.view.y.logarithmic());
    const int wide = canvas.width() / canvas.columns(), high = canvas.height() / canvas.rows();
    for (int row = 0; row < canvas.rows(); ++row) {
        const double dot_y = (row + 0.5) * high - 0.5;
        const auto j = value_at(y, projection.view.y.at(1 - dot_y / (projection.box.height - 1)));
        for (int column = 0; column < canvas.columns(); ++column) {
            const double dot_x = (column + 0.5) * wide - 0.5;
            const auto i = value_at(x, projection.view.x.at(dot_x / (projection.box.width - 1)));
            if (!i || !j) continue;
            if (const auto band = band_of(bands, shades.at(*i, *j))) {
                canvas.glyph_if_free(column * wide, row * high, shade_letter(bands, *band, charset == Charset::ascii));
            }
        }
    }
}

Signs signs(Charset charset) {
    return charset == Charset::braille ? Signs{{"○", "●", "◆", "◇"}, "×", "━"} : Signs{{"o", "@", "#", "%"}, "x", "="};
}

/// Draws zero lines, circles, curves and marks.
void draw(Canvas& canvas, const Figure& figure, const Projection& projection, const std::vector<double>& circles,
          Charset charset) {
    if (figure.axes) {
        draw_background(canvas, figure, projection, circles);
    }
    // The first curve drawn in a cell wins, so background curves come last.
    std::vector<std::size_t> order = drawing_order(figure);
    const auto front = std::ranges::find_if(order, [&](std::size_t i) { return !figure.curves[i].behind; });
    std::rotate(order.begin(), front, order.end());
    for (const std::size_t i : order) {
        const Curve& curve = figure.curves[i];
        const std::uint8_t ink = ink_of(i);
        if (curve.style == Style::points || curve.size() == 1) {
            const std::string_view own = alphabet.substr(i % alphabet_size, 1);
            draw_points(canvas, curve, projection, ink, uses_letters(figure) ? own : signs(charset).point);
        } else if (curve.style == Style::fill) {
            draw_fill(canvas, curve, projection, ink);
        } else {
            const Dashing stroke = stroke_of(figure, i, charset);
            draw_line(Pen(canvas, ink, stroke.on, stroke.period), curve, projection);
        }
    }
    if (figure.shades != nullptr) {
        draw_shades(canvas, *figure.shades, projection, charset);
    }
    if (uses_letters(figure) && !letters_at_ends(figure)) {
        draw_letters(canvas, figure, projection);
    }
    if (figure.dead_zone) {
        draw_dead_zone(canvas, *figure.dead_zone, projection, signs(charset).dead_zone);
    }
    for (const Mark& mark : figure.marks) {
        const Signs of = signs(charset);
        canvas.glyph(nearest_dot(projection.x(mark.x)), nearest_dot(projection.y(mark.y)),
                     of.marks[static_cast<std::size_t>(mark.kind)], 1);
    }
}

// ---- lines of text with known widths and colours

// The terminal's own colours, which suit its background. The first curve is plain; red and green come last, and letters
// identify the curves as well.
constexpr std::array<std::string_view, 6> escapes{"\x1b[39m", "\x1b[36m", "\x1b[33m",
                                                  "\x1b[35m", "\x1b[32m", "\x1b[31m"};
constexpr std::string_view reset = "\x1b[0m";

std::size_t place(std::uint8_t colour) {
    return colour == 0 ? 0 : (colour - 1U) % escapes.size();
}

/// A line of coloured text; colour 0 is none, 1, 2, ... the palette of curves.
class TextLine {
public:
    explicit TextLine(bool colours) : colours_(colours) {}
    void add(std::string_view text, std::uint8_t colour = 0) {
        if (text.empty()) {
            return;
        }
        if (colours_ && place(colour) != place(colour_)) {
            text_ += place(colour) == 0 ? reset : escapes[place(colour)];
        }
        colour_ = colour;
        text_ += text;
        width_ += text::columns(text);
    }

    void append(const TextLine& line) {
        text_ += line.text_;
        if (colours_ && place(line.colour_) != 0) {
            text_ += reset;
        }
        width_ += line.width();
    }
    /// Adds blanks up to this width.
    void pad(std::size_t width) {
        if (width > width_) {
            add(std::string(width - width_, ' '));
        }
    }

    std::size_t width() const { return width_; }
    std::string text() const {
        constexpr std::string_view empty_braille = "\xE2\xA0\x80";
        std::string_view text = text_;
        for (;;) {
            if (text.ends_with(' ')) {
                text.remove_suffix(1);
            } else if (text.ends_with(empty_braille)) {
                text.remove_suffix(empty_braille.size());
            } else {
                break;
            }
        }
        return std::string(text) + (colours_ && place(colour_) != 0 ? std::string(reset) : "");
    }

private:
    bool colours_;
    std::uint8_t colour_ = 0;
    std::size_t width_ = 0;
    std::string text_;
};

using TextBlock = std::vector<TextLine>;

/// Blocks side by side, two columns apart.
TextBlock beside(const std::vector<TextBlock>& blocks, bool colours) {
    std::size_t height = 0;
    for (const TextBlock& block : blocks) {
        height = std::max(height, block.size());
    }
    TextBlock all;
    for (std::size_t row = 0; row < height; ++row) {
        TextLine line(colours);
        std::size_t start = 0;
        for (const TextBlock& block : blocks) {
            std::size_t width = 0;
            for (const TextLine& each : block) {
                width = std::max(width, each.width());
            }
            line.pad(start);
            if (row < block.size()) {
                line.append(block[row]);
            }
            start += width + 2;
        }
        all.push_back(std::move(line));
    }
    return all;
}

/// All lines with newlines, without trailing blanks.
std::string text_of(const TextBlock& block) {
    std::string text;
    for (const TextLine& line : block) {
        text += line.text() + '\n';
    }
    return text;
}

// ---- the legend

/// Words in the charset of the text.
std::string shown_in(Charset charset, std::string_view words) {
    const std::string clean = text::displayable(words);
    return charset == Charset::braille ? clean : text::in_ascii(clean);
}

/// A line of the legend: a letter, sign or shade with its meaning.
struct TextEntry {
    std::string text;
    std::uint8_t ink;  ///< ink of its curve; 0: not a curve
};

std::vector<TextEntry> text_legend(const Figure& figure, Charset charset) {
    std::vector<TextEntry> list;
    if (figure.shades != nullptr) {
        if (!figure.shades->label.empty()) list.push_back({shown_in(charset, figure.shades->label + ":"), 0});
        const std::vector<ShadeBand> bands = bands_of(*figure.shades, most_text_bands);
        for (std::size_t i = 0; i < bands.size(); ++i) {
            const std::string_view sign = shade_letter(bands, i, charset == Charset::ascii);
            list.push_back({sign == bands[i].text ? bands[i].text : std::string(sign) + " " + bands[i].text, 0});
        }
    }
    for (std::size_t i = 0; i < figure.curves.size(); ++i) {
        if (!figure.curves[i].label.empty()) {
            const std::string mark = uses_letters(figure) ? std::string{letter(ink_of(i)), ' '} : "";
            list.push_back({mark + shown_in(charset, figure.curves[i].label), ink_of(i)});
        }
    }
    const Signs sign = signs(charset);
    for (const MarkKind kind : kinds_of(figure.marks)) {
        const auto place = static_cast<std::size_t>(kind);
        list.push_back({std::string(sign.marks[place]) + " " + mark_names[place], 0});
    }
    if (figure.dead_zone) {
        list.push_back({std::string(sign.dead_zone) + " dead zone", 0});
    }
    return list;
}

// ---- the picture

constexpr int narrowest_panel = 38;  // columns; narrower panels are stacked
constexpr int letters_at_end = 3;    // columns right of the canvas for letters of curves

constexpr std::size_t most_legend_lines = 5;

struct BoxSigns {
    std::string_view side, tick, corner, floor, floor_tick, stuck;
};

BoxSigns frame_of(Charset charset) {
    return charset == Charset::braille ? BoxSigns{"│", "┤", "└", "─", "┬", "━"}
                                       : BoxSigns{"|", "+", "+", "-", "+", "="};
}

class TextPlot {
public:
    /// `label_room`: minimum columns for the numbers of the vertical axis.
    TextPlot(const Figure& figure, const TextFormat& format, std::size_t label_room = 0)
        : figure_(figure),
          format_(format),
          seen_(view_of(figure)),
          view_(seen_),
          frame_(frame_of(format.charset)),
          label_room_(label_room) {}

    /// The columns that these numbers need.
    [[nodiscard]] std::size_t label_width() {
        lay_out();
        return label_width_;
    }

    TextBlock block() {
        lay_out();
        Canvas canvas(columns_, rows_, format_.charset);
        const Projection projection{view_, box_};
        draw(canvas, figure_, projection, circles_of(figure_, x_ticks_, y_ticks_), format_.charset);
        TextBlock lines;
        if (!figure_.title.empty()) {
            lines.push_back(centred(figure_.title));
        }
        lines.insert(lines.end(), head_.begin(), head_.end());
        add_rows(lines, canvas, projection);
        if (figure_.axes) {
            add_foot(lines);
        }
        return lines;
    }

private:
    TextLine empty_line() const { return TextLine(format_.colours); }
    std::string shown(std::string_view text) const { return shown_in(format_.charset, text); }

    /// Label width and number of ticks depend on each other: repeats until they agree.
    void lay_out() {
        for (int attempt = 0; attempt < 4; ++attempt) {
            const std::size_t width_before = label_width_;
            const std::size_t height_before = head_.size();
            head_ = head_lines();
            set_canvas();
            y_ticks_ = ticks_of(figure_.y, view_.y, std::max(2, rows_ / 3));
            x_ticks_ = ticks_of(figure_.x, view_.x, std::max(2, columns_ / (figure_.equal ? 7 : 11)));
            label_width_ = std::max<std::size_t>(label_room_, figure_.axes && !figure_.stuck.empty() ? 5 : 0);
            for (const std::string& text : figure_.axes ? y_ticks_.text : std::vector<std::string>{}) {
                label_width_ = std::max(label_width_, text.size());
            }
            if (attempt > 0 && label_width_ == width_before && head_.size() == height_before) {
                break;
            }
        }
    }

    void set_canvas() {
        const int foot = figure_.axes ? 2 + (figure_.stuck.empty() ? 0 : 1) + (long_x_label() ? 1 : 0) : 0;
        const int around = figure_.axes ? static_cast<int>(label_width_) + 2 : 0;
        const int cell_width = format_.charset == Charset::braille ? 2 : 1;
        const int cell_height = 2 * cell_width;
        rows_ = std::max(3, format_.rows - foot - static_cast<int>(head_.size()) - (figure_.title.empty() ? 0 : 1));
        columns_ = std::max(2, format_.columns - around - letters_at_end);
        box_ = {static_cast<double>(columns_ * cell_width), static_cast<double>(rows_ * cell_height)};
        if (figure_.equal) {
            view_ = seen_;
            box_ = equal_box(view_, box_);
            columns_ = std::max(1, static_cast<int>(std::ceil(box_.width / cell_width - 1e-9)));
            rows_ = std::max(1, static_cast<int>(std::ceil(box_.height / cell_height - 1e-9)));
        }
    }

    bool long_x_label() const { return text::columns(x_label()) > letters_at_end - 1; }
    std::string x_label() const {
        return shown(figure_.x.label + (x_ticks_.offset.empty() ? "" : " (" + x_ticks_.offset + ")"));
    }
    std::string y_label() const {
        return shown(figure_.y.label + (y_ticks_.offset.empty() ? "" : " (" + y_ticks_.offset + ")"));
    }

    /// The label of the vertical axis and the legend, on a limited number of lines.
    TextBlock head_lines() const {
        TextBlock lines;
        TextLine line = empty_line();
        const std::string name = figure_.axes ? y_label() : "";
        const std::size_t start = figure_.axes ? label_width_ + 2 : 0;
        const auto width = static_cast<std::size_t>(format_.columns);
        line.pad(!name.empty() && text::columns(name) < start ? start - 1 - text::columns(name) : 0);
        line.add(text::cut_to_columns(name, width));
        const std::vector<TextEntry> list = text_legend(figure_, format_.charset);
        for (std::size_t i = 0; i < list.size(); ++i) {
            constexpr std::size_t gap = 3;
            if (line.width() > 0 && line.width() + gap + text::columns(list[i].text) > width) {
                lines.push_back(line);
                line = empty_line();
                if (lines.size() == most_legend_lines) {
                    line.pad(start);
                    line.add("+ " + std::to_string(list.size() - i) + " more");
                    break;
                }
            }
            line.pad(line.width() == 0 ? start : std::max(start, line.width() + gap));
            line.add(text::cut_to_columns(list[i].text, width > line.width() ? width - line.width() : 0), list[i].ink);
        }
        if (line.width() > 0) {
            lines.push_back(line);
        }
        return lines;
    }

    TextLine centred(const std::string& words) const {
        const std::string whole = shown(words);
        const std::string_view text = text::cut_to_columns(whole, static_cast<std::size_t>(format_.columns));
        const std::size_t before = figure_.axes ? label_width_ + 2 : 0;
        const std::size_t middle = before + static_cast<std::size_t>(columns_) / 2;
        const std::size_t width = text::columns(text);
        TextLine line = empty_line();
        line.pad(
            std::min(middle > width / 2 ? middle - width / 2 : 0, static_cast<std::size_t>(format_.columns) - width));
        line.add(text);
        return line;
    }

    /// The letters at the right edge at the ends of the curves.
    std::vector<std::vector<std::uint8_t>> letters_of_rows(const Projection& projection) const {
        std::vector<std::vector<std::uint8_t>> rows(static_cast<std::size_t>(rows_));
        for (std::size_t i = 0; letters_at_ends(figure_) && i < figure_.curves.size(); ++i) {
            const Curve& curve = figure_.curves[i];
            for (std::size_t n = curve.size(); n > 0; --n) {
                const double x = projection.x(curve.x.values[n - 1]);
                const double y = projection.y(curve.y.values[n - 1]);
                if (x < box_.width && y > -0.5 && y < box_.height) {
                    rows[std::min(rows.size() - 1, row_of(y))].push_back(ink_of(i));
                    break;
                }
            }
        }
        return rows;
    }

    std::size_t row_of(double dot) const {
        return static_cast<std::size_t>(std::max(0, nearest_dot(dot))) / (format_.charset == Charset::braille ? 4 : 2);
    }
    std::size_t column_of(double dot) const {
        return static_cast<std::size_t>(std::max(0, nearest_dot(dot))) / (format_.charset == Charset::braille ? 2 : 1);
    }

    void add_rows(TextBlock& lines, const Canvas& canvas, const Projection& projection) {
        std::vector<std::string> labels(static_cast<std::size_t>(rows_));
        for (std::size_t i = 0; i < y_ticks_.at.size(); ++i) {
            labels[std::min(labels.size() - 1, row_of(projection.y(y_ticks_.at[i])))] = y_ticks_.text[i];
        }
        const auto letters = letters_of_rows(projection);
        for (int row = 0; row < rows_; ++row) {
            TextLine line = empty_line();
            if (figure_.axes) {
                const std::string& label = labels[static_cast<std::size_t>(row)];
                line.pad(label_width_ > label.size() ? label_width_ - label.size() : 0);
                line.add(label);
                line.add(" ");
                line.add(label.empty() ? frame_.side : frame_.tick);
            }
            if (row == rows_ / 2 && !canvas.has_ink() && figure_.shades == nullptr) {
                line.add("  (no points)");
            } else {
                add_cells(line, canvas, row);
            }
            const auto& inks = letters[static_cast<std::size_t>(row)];
            for (std::size_t i = 0; i < std::min<std::size_t>(inks.size(), letters_at_end); ++i) {
                line.add(std::string{letter(inks[i])}, inks[i]);
            }
            lines.push_back(line);
        }
    }

    void add_cells(TextLine& line, const Canvas& canvas, int row) const {
        for (int column = 0; column < columns_; ++column) {
            const Canvas::Cell& cell = canvas.cell(column, row);
            const char mark = uses_letters(figure_) && cell.ink != 0 ? letter(cell.ink) : figure_.circles ? '*' : '\0';
            line.add(canvas.text(cell, mark, figure_.circles ? '.' : '-'), cell.ink);
        }
    }

    void add_foot(TextBlock& lines) {
        const auto width = static_cast<std::size_t>(columns_);
        std::vector<std::string_view> floor(width, frame_.floor);
        TextLine numbers = empty_line();
        for (std::size_t i = 0; i < x_ticks_.at.size(); ++i) {
            const std::size_t column = std::min(width - 1, column_of(view_.x(x_ticks_.at[i]) * (box_.width - 1)));
            floor[column] = frame_.floor_tick;
            const std::string& text = x_ticks_.text[i];
            const std::size_t middle = label_width_ + 2 + column;
            const std::size_t start = middle - std::min(middle, text.size() / 2);
            const bool fits = start + text.size() <= static_cast<std::size_t>(format_.columns);
            // A label that would touch its neighbour is left out.
            if (fits && (numbers.width() == 0 || start > numbers.width())) {
                numbers.pad(start);
                numbers.add(text);
            }
        }
        TextLine line = empty_line();
        line.pad(label_width_ + 1);
        line.add(frame_.corner);
        for (const std::string_view piece : floor) {
            line.add(piece);
        }
        lines.push_back(line);
        if (!figure_.stuck.empty()) {
            lines.push_back(stuck_line());
        }
        const std::string label = x_label();
        if (!long_x_label() && !label.empty()) {
            numbers.pad(std::max(numbers.width() + 1, label_width_ + 2 + width));
            numbers.add(label);
        }
        lines.push_back(numbers);
        if (long_x_label()) {
            lines.push_back(centred(figure_.x.label + (x_ticks_.offset.empty() ? "" : " (" + x_ticks_.offset + ")")));
        }
    }

    TextLine stuck_line() const {
        const auto width = static_cast<std::size_t>(columns_);
        std::vector<bool> stuck(width, false);
        for (const Interval& span : figure_.stuck) {
            const double from = std::max(view_.x(span.low), 0.0) * (box_.width - 1);
            const double to = std::min(view_.x(span.high), 1.0) * (box_.width - 1);
            for (std::size_t i = column_of(from); to >= from && i <= column_of(to) && i < width; ++i) {
                stuck[i] = true;
            }
        }
        TextLine line = empty_line();
        line.pad(label_width_ - 5);
        line.add("stuck  ");
        for (const bool here : stuck) {
            line.add(here ? frame_.stuck : " ");
        }
        return line;
    }

    const Figure& figure_;
    const TextFormat& format_;
    const View seen_;  // view of the figure
    View view_;        // view on the canvas
    BoxSigns frame_;
    Ticks x_ticks_, y_ticks_;
    TextBlock head_;
    std::size_t label_room_;
    std::size_t label_width_ = 0;
    int columns_ = 0, rows_ = 0;  // size of the canvas
    Box box_{1, 1};               // size of the canvas in dots
};

/// Figures one below the other with aligned axes.
TextBlock pile_of(std::span<const Figure> figures, TextFormat format) {
    constexpr int least_rows = 8;
    const int count = static_cast<int>(figures.size());
    std::size_t labels = 0;
    if (count > 1) {
        format.rows = std::max(least_rows, format.rows / count + 1);
        for (const Figure& figure : figures) {
            labels = std::max(labels, TextPlot(figure, format).label_width());
        }
    }
    TextBlock lines;
    for (const Figure& figure : figures) {
        const TextBlock own = TextPlot(figure, format, labels).block();
        lines.insert(lines.end(), own.begin(), own.end());
    }
    return lines;
}

}  // namespace

std::string text_plot(std::span<const Figure> given, const TextFormat& format) {
    constexpr double dots = 2;  // dots of a column in braille
    const std::vector<Figure> figures = with_envelopes(with_bands(given, dots * format.columns),
                                                       (format.charset == Charset::ascii ? 1 : dots) * format.columns);
    TextFormat each = format;
    const auto piles = std::ranges::count_if(figures, [](const Figure& figure) { return !figure.below; });
    const int count = std::max(1, static_cast<int>(piles));
    const bool together = (format.columns - 2 * (count - 1)) / count >= narrowest_panel;
    if (together) {
        each.columns = (format.columns - 2 * (count - 1)) / count;
    }
    std::vector<TextBlock> blocks;
    std::string text;
    for (auto from = figures.begin(); from != figures.end();) {
        const auto to = std::find_if(from + 1, figures.end(), [](const Figure& figure) { return !figure.below; });
        blocks.push_back(pile_of({from, to}, each));
        text += together ? "" : text_of(blocks.back());
        from = to;
    }
    return together ? text_of(beside(blocks, format.colours)) : text;
}

}  // namespace dinal::plots
