#include "plots/text_drawing.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "plots/bands.hpp"
#include "plots/shades.hpp"

namespace dinal::plots {
namespace {

constexpr std::size_t most_glyphs = 200;  // more points than this are dots
constexpr std::size_t alphabet_size = 52;
constexpr std::string_view alphabet = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

struct Dashing {
    int on, period;
};

/// Solid, dotted, dashed ...: with more curves than that only letters help.
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

/// Every second dot of every second row between the curve and its base.
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
    constexpr double gap = 4;     // dots from one to the next
    constexpr double most = 1e4;  // a window far from the origin sees no more than a piece of a line
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

/// Only where no curve runs: it is not to be hidden.
void draw_dead_zone(Canvas& canvas, Interval zone, const Projection& projection, std::string_view sign) {
    const int row = nearest_dot(projection.y(0));
    const double from = std::max(projection.x(zone.low), 0.0);
    const double to = std::min(projection.x(zone.high), projection.box.width - 1);
    for (int x = nearest_dot(from); x <= to; ++x) {
        canvas.glyph_if_free(x, row, sign);
    }
}

/// Each letter further along its curve than the one before, so that they stand apart where the curves do not.
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

/// A character for the value at the middle of each cell, but where curves are.
void draw_shades(Canvas& canvas, const Shades& shades, const Projection& projection, Charset charset) {
    const std::vector<ShadeBand> bands = bands_of(shades, most_text_bands);
    const std::vector<double> x = edges_between(shades.x, projection.view.x.logarithmic());
    const std::vector<double> y = edges_between(shades.y, projection.view.y.logarithmic());
    const auto place = [](const std::vector<double>& edges, double value) {
        return static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), value) - edges.begin());
    };
    const int wide = canvas.width() / canvas.columns(), high = canvas.height() / canvas.rows();
    for (int row = 0; row < canvas.rows(); ++row) {
        const double dot_y = (row + 0.5) * high - 0.5;
        const std::size_t j = place(y, projection.view.y.at(1 - dot_y / (projection.box.height - 1)));
        for (int column = 0; column < canvas.columns(); ++column) {
            const double dot_x = (column + 0.5) * wide - 0.5;
            const std::size_t i = place(x, projection.view.x.at(dot_x / (projection.box.width - 1)));
            if (i == 0 || j == 0 || i > shades.x.size() || j > shades.y.size()) continue;
            if (const auto band = band_of(bands, shades.at(i - 1, j - 1))) {
                canvas.glyph_if_free(column * wide, row * high, shade_letter(bands, *band, charset == Charset::ascii));
            }
        }
    }
}

}  // namespace

Signs signs(Charset charset) {
    return charset == Charset::braille ? Signs{{"○", "●", "◆", "◇"}, "×", "━"} : Signs{{"o", "@", "#", "%"}, "x", "="};
}

char letter(std::size_t ink) {
    return alphabet[(ink - 1) % alphabet_size];
}

bool uses_letters(const Figure& figure) {
    return figure.curves.size() > 1;
}

bool letters_at_ends(const Figure& figure) {
    return uses_letters(figure) && figure.curves.size() <= 4;
}

std::uint8_t ink_of(std::size_t curve) {
    return static_cast<std::uint8_t>(curve % 255 + 1);
}

void draw(Canvas& canvas, const Figure& figure, const Projection& projection, const std::vector<double>& circles,
          Charset charset) {
    if (figure.axes) {
        draw_background(canvas, figure, projection, circles);
    }
    // Who comes first to a cell has it: what is behind comes last.
    std::vector<std::size_t> order = drawing_order(figure);
    const auto front =
        std::find_if(order.begin(), order.end(), [&](std::size_t i) { return !figure.curves[i].behind; });
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

}  // namespace dinal::plots
