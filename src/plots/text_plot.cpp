#include "plots/text_plot.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "plots/bands.hpp"
#include "plots/shades.hpp"
#include "plots/text_drawing.hpp"
#include "plots/ticks.hpp"
#include "text/characters.hpp"

namespace dinal::plots {
namespace {

// ---- lines of text with known widths and colours

/// A colour is 0 for none, 1, 2, ... for the palette of curves.
class TextLine {
public:
    explicit TextLine(bool colours) : colours_(colours) {}
    void add(std::string_view text, std::uint8_t colour = 0);
    void append(const TextLine& line);
    /// Blanks up to this width; nothing when it is wider already.
    void pad(std::size_t width);
    [[nodiscard]] std::size_t width() const { return width_; }
    [[nodiscard]] std::string text() const;

private:
    bool colours_;
    std::uint8_t colour_ = 0;
    std::size_t width_ = 0;
    std::string text_;
};

using TextBlock = std::vector<TextLine>;

// The terminal's own colours: it knows its background. The first curve is plain; none of the others needs a good eye
// for red and green, since letters tell the curves apart, too.
constexpr std::array<std::string_view, 6> escapes{"\x1b[39m", "\x1b[36m", "\x1b[33m",
                                                  "\x1b[35m", "\x1b[32m", "\x1b[31m"};
constexpr std::string_view reset = "\x1b[0m";

std::size_t place(std::uint8_t colour) {
    return colour == 0 ? 0 : (colour - 1U) % escapes.size();
}

void TextLine::add(std::string_view text, std::uint8_t colour) {
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

void TextLine::append(const TextLine& line) {
    text_ += line.text_;
    if (colours_ && place(line.colour_) != 0) {
        text_ += reset;
    }
    width_ += line.width();
}

void TextLine::pad(std::size_t width) {
    if (width > width_) {
        add(std::string(width - width_, ' '));
    }
}

std::string TextLine::text() const {
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

/// Blocks beside each other, two columns between them.
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

/// All lines, each ended by a newline and without blanks at its end.
std::string text_of(const TextBlock& block) {
    std::string text;
    for (const TextLine& line : block) {
        text += line.text() + '\n';
    }
    return text;
}

// ---- the legend

/// Words as such a text can show them.
std::string shown_in(Charset charset, std::string_view words) {
    const std::string clean = text::displayable(words);
    return charset == Charset::braille ? clean : text::in_ascii(clean);
}

/// A line of the legend: what a letter, sign or shade stands for.
struct TextEntry {
    std::string text;
    std::uint8_t ink;  ///< of its curve; 0 for what is none
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

constexpr int narrowest_panel = 38;  // columns; what has less stands under its neighbour
constexpr int letters_at_end = 3;    // columns to the right of the canvas for the letters of curves

constexpr std::size_t most_legend_lines = 5;

struct Frame {
    std::string_view side, tick, corner, floor, floor_tick, stuck;
};

Frame frame_of(Charset charset) {
    return charset == Charset::braille ? Frame{"│", "┤", "└", "─", "┬", "━"} : Frame{"|", "+", "+", "-", "+", "="};
}

class TextPlot {
public:
    /// With at least `label_room` columns for the numbers of the vertical axis.
    TextPlot(const Figure& figure, const TextFormat& format, std::size_t label_room = 0)
        : figure_(figure),
          format_(format),
          seen_(view_of(figure)),
          view_(seen_),
          frame_(frame_of(format.charset)),
          label_room_(label_room) {}

    /// How many columns those need.
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
    [[nodiscard]] TextLine empty_line() const { return TextLine(format_.colours); }
    [[nodiscard]] std::string shown(std::string_view text) const { return shown_in(format_.charset, text); }

    /// The room depends on the tick labels, and how many ticks there are on the room: again until both agree.
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

    [[nodiscard]] bool long_x_label() const { return text::columns(x_label()) > letters_at_end - 1; }
    [[nodiscard]] std::string x_label() const {
        return shown(figure_.x.label + (x_ticks_.offset.empty() ? "" : " (" + x_ticks_.offset + ")"));
    }
    [[nodiscard]] std::string y_label() const {
        return shown(figure_.y.label + (y_ticks_.offset.empty() ? "" : " (" + y_ticks_.offset + ")"));
    }

    /// The label of the vertical axis and the legend, on as few lines as they need, but not on many.
    [[nodiscard]] TextBlock head_lines() const {
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

    [[nodiscard]] TextLine centred(const std::string& words) const {
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

    /// The letters at the right edge, where the curves end.
    [[nodiscard]] std::vector<std::vector<std::uint8_t>> letters_of_rows(const Projection& projection) const {
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

    [[nodiscard]] std::size_t row_of(double dot) const {
        return static_cast<std::size_t>(std::max(0, nearest_dot(dot))) / (format_.charset == Charset::braille ? 4 : 2);
    }
    [[nodiscard]] std::size_t column_of(double dot) const {
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
            if (fits && (numbers.width() == 0 || start > numbers.width())) {  // else it would touch its neighbour
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

    [[nodiscard]] TextLine stuck_line() const {
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
    const View seen_;  // of the figure
    View view_;        // on the canvas
    Frame frame_;
    Ticks x_ticks_, y_ticks_;
    TextBlock head_;
    std::size_t label_room_;
    std::size_t label_width_ = 0;
    int columns_ = 0, rows_ = 0;  // of the canvas
    Box box_{1, 1};               // of the canvas in dots
};

/// Figures one below the other, their axes, too.
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
    constexpr double dots = 2;  // of a column, in braille
    const std::vector<Figure> figures = with_bands(given, dots * format.columns);
    TextFormat each = format;
    const auto piles =
        std::count_if(figures.begin(), figures.end(), [](const Figure& figure) { return !figure.below; });
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
