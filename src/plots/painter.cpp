#include "plots/painter.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <new>
#include <numbers>
#include <optional>
#include <vector>

#include "plots/shades.hpp"
#include "plots/svg_words.hpp"
#include "plots/thinning.hpp"
#include "text/characters.hpp"

namespace dinal::plots {

namespace {

constexpr double line_width = 1.3;  // pixels of 1/96 inch, the unit of all lengths here

constexpr std::uint32_t ink_colour = 0x444444, grey = 0xB0B0B0;

// The colour-blind safe palette of Okabe and Ito, without yellow, which is pale on paper.
constexpr std::array<std::uint32_t, 7> palette{0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7, 0x000000, 0xE69F00, 0x56B4E9};

// With six patterns and seven colours a pair repeats after 42 curves.
const std::array<std::vector<double>, 6> dash_patterns{std::vector<double>{}, {5, 2},     {1.3, 1.7},
                                                       {5, 1.7, 1.3, 1.7},    {2.6, 1.7}, {5, 1.7, 1.3, 1.7, 1.3, 1.7}};

struct Release {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, Release>;
using Context = std::unique_ptr<cairo_t, Release>;

void set_colour(cairo_t* to, std::uint32_t colour, double opacity = 1) {
    const auto part = [colour](unsigned shift) { return ((colour >> shift) & 255U) / 255.0; };
    cairo_set_source_rgba(to, part(16), part(8), part(0), opacity);
}

void stroke(cairo_t* to, double width, std::uint32_t colour) {
    set_colour(to, colour);
    cairo_set_line_width(to, width);
    cairo_stroke(to);
}

void fill(cairo_t* to, std::uint32_t colour, double opacity = 1) {
    set_colour(to, colour, opacity);
    cairo_fill(to);
}

/// A part of the sheet as pixels, 0xAARRGGBB. Allocated with `new`, so it counts as memory of the script.
class Image {
public:
    Image(Point corner, Box size, double dots_per_pixel)
        : corner_(corner),
          scale_(dots_per_pixel),
          width(static_cast<int>(std::ceil(size.width * scale_))),
          height(static_cast<int>(std::ceil(size.height * scale_))),
          dots(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
          surface(cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(dots.data()),
                                                      CAIRO_FORMAT_ARGB32, width, height, 4 * width)) {}

    /// A drawing context in the coordinates of the sheet.
    Context context() const {
        Context context(cairo_create(surface.get()));
        cairo_scale(context.get(), scale_, scale_);
        cairo_translate(context.get(), -corner_.x, -corner_.y);
        return context;
    }
    /// The pixel at this position of the sheet, or nullptr outside.
    [[nodiscard]] std::uint32_t* at(Point place) {
        const double x = (place.x - corner_.x) * scale_, y = (place.y - corner_.y) * scale_;
        return x >= 0 && y >= 0 && x < width && y < height ? &pixel(y, x) : nullptr;
    }
    void set(int row, int column, std::uint32_t colour) { pixel(row, column) = 0xFF000000U | colour; }
    void put(cairo_t* to) const {
        cairo_surface_mark_dirty(surface.get());
        cairo_save(to);
        cairo_translate(to, corner_.x, corner_.y);
        cairo_scale(to, 1 / scale_, 1 / scale_);
        cairo_set_source_surface(to, surface.get(), 0, 0);
        cairo_pattern_set_filter(cairo_get_source(to), CAIRO_FILTER_NEAREST);
        cairo_paint(to);
        cairo_restore(to);
    }

private:
    [[nodiscard]] std::uint32_t& pixel(double row, double column) {
        return dots[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
    }

    Point corner_;
    double scale_;

public:
    const int width, height;
    std::vector<std::uint32_t> dots;
    const Surface surface;
};

/// A polygon, a star of spokes, or without corners a circle.
struct Shape {
    int corners = 0;
    double first = 0;  // degrees
    bool spokes = false;
};
constexpr Shape circle{}, diamond{4, 0};
constexpr std::array<Shape, 5> point_shapes{circle, {4, 45, true}, {3, -90}, {4, 45}, {4, 0, true}};

void outline(cairo_t* to, Shape shape, Point middle, double radius) {
    if (shape.corners == 0) cairo_arc(to, middle.x, middle.y, radius, 0, 2 * std::numbers::pi);
    for (int i = 0; i < shape.corners; ++i) {
        const double angle = (shape.first / 180 + 2.0 * i / shape.corners) * std::numbers::pi;
        if (shape.spokes) cairo_move_to(to, middle.x, middle.y);
        cairo_line_to(to, middle.x + radius * std::cos(angle), middle.y + radius * std::sin(angle));
    }
    if (!shape.spokes) cairo_close_path(to);
}

constexpr double bar = 0.3 * em;                   // height of the bars for dead zone and sticking
constexpr double below_ticks = 0.45 * em;          // distance of the sticking bars from the axis
constexpr double density = 0.25;                   // opacity of an area's colour
constexpr std::size_t most_separate_points = 500;  // number of points whose shapes would hide each other
// resolution of images, in pixels per pixel of the sheet; lines are wider than two of them
constexpr double resolution = 2;

enum class Align { left, centre, right };

struct Page {
    cairo_t* to;
    bool svg;
    const std::function<bool()>& go_on;
    std::string texts = {};  ///< SVG only: collected <text> elements; no font needed

    void line(Point from, Point end, double width, std::uint32_t colour) const {
        cairo_move_to(to, from.x, from.y);
        cairo_line_to(to, end.x, end.y);
        stroke(to, width, colour);
    }

    void rectangle(Point from, Point end, std::uint32_t colour, double opacity = 1) const {
        cairo_rectangle(to, from.x, from.y, end.x - from.x, end.y - from.y);
        fill(to, colour, opacity);
    }

    /// Writes words whose vertical centre is at the point.
    void words(const Words& words, Align align = Align::centre, bool upwards = false) {
        constexpr double middle = 0.35;  // relative to the height of letters above their base line
        const std::string shown = text::displayable(words.text);
        if (shown.empty()) return;
        if (svg) {
            constexpr std::array anchors{"start", "middle", "end"};
            texts +=
                fmt::format("<text transform=\"translate({:.2f} {:.2f}){}\" dy=\"{}em\" text-anchor=\"{}\">{}</text>\n",
                            words.x, words.y, upwards ? " rotate(-90)" : "", middle,
                            anchors[static_cast<std::size_t>(align)], text::html(shown));
            return;
        }
        cairo_select_font_face(to, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
        cairo_set_font_size(to, em);
        cairo_text_extents_t extents;
        cairo_text_extents(to, shown.c_str(), &extents);
        cairo_save(to);
        cairo_translate(to, words.x, words.y);
        if (upwards) cairo_rotate(to, -std::numbers::pi / 2);
        cairo_move_to(to, -extents.x_advance * static_cast<double>(align) / 2, middle * em);
        set_colour(to, ink_colour);
        cairo_show_text(to, shown.c_str());
        cairo_new_path(to);  // otherwise the next shape would continue from the words
        cairo_restore(to);
    }
};

class PanelPainter {
public:
    PanelPainter(Page& page, const PaperPanel& panel, double most_corners)
        : page_(page), panel_(panel), figure_(*panel.figure), most_corners_(most_corners) {}

    void paint() {
        if (figure_.axes) add_grid();
        if (figure_.shades != nullptr) add_shades();
        if (figure_.dead_zone) {
            const Interval seen = panel_.view.x.range();
            add_bar({std::max(figure_.dead_zone->low, seen.low), std::min(figure_.dead_zone->high, seen.high)},
                    y_of(0) - bar / 2, grey);
        }
        add_curves();
        for (const Mark& mark : figure_.marks) {
            if (sees(mark.x, mark.y)) add_mark(mark.kind, {x_of(mark.x), y_of(mark.y)});
        }
        if (figure_.axes) add_axes();
        add_stuck();
        for (const LegendEntry& entry : panel_.legend) add_to_legend(entry);
        add_colour_bar();
        add_end_names();
        page_.words(panel_.title);
    }

private:
    double x_of(double value) const { return panel_.left + panel_.view.x(value) * size_.width; }
    double y_of(double value) const { return panel_.bottom - panel_.view.y(value) * size_.height; }
    bool sees(double x, double y) const {
        const double right = panel_.view.x(x), up = panel_.view.y(y);
        return right >= 0 && right <= 1 && up >= 0 && up <= 1;
    }

    /// Draws clipped to the box with a small margin.
    template <class Draw>
    void clipped(cairo_t* to, const Draw& draw) const {
        constexpr double around = line_width / 2;
        cairo_save(to);
        cairo_rectangle(to, panel_.left - around, panel_.top - around, size_.width + 2 * around,
                        size_.height + 2 * around);
        cairo_clip(to);
        draw();
        cairo_restore(to);
    }

    Image image() const {
        constexpr double most = 4e6;  // pixels
        return {{panel_.left, panel_.top}, size_, std::min(resolution, std::sqrt(most / (size_.width * size_.height)))};
    }

    void add_grid() const {
        constexpr std::uint32_t faint = 0xE4E4E4, zero = 0xA0A0A0, round = 0xC8C8C8;
        const auto across = [this](double y, double width, std::uint32_t colour) {
            page_.line({panel_.left, y_of(y)}, {panel_.right, y_of(y)}, width, colour);
        };
        const auto up = [this](double x, double width, std::uint32_t colour) {
            page_.line({x_of(x), panel_.bottom}, {x_of(x), panel_.top}, width, colour);
        };
        const Scale& x = panel_.view.x;
        const Scale& y = panel_.view.y;
        for (const double tick : panel_.x_ticks.at) up(tick, 0.5, faint);
        for (const double tick : panel_.y_ticks.at) across(tick, 0.5, faint);
        if (!y.logarithmic() && y(0) >= 0 && y(0) <= 1) across(0, 0.7, zero);
        if (!figure_.circles) return;
        if (!x.logarithmic() && x(0) >= 0 && x(0) <= 1) up(0, 0.7, zero);
        clipped(page_.to, [&] {
            for (const double radius : circles_of(figure_, panel_.x_ticks, panel_.y_ticks)) {
                cairo_save(page_.to);
                cairo_translate(page_.to, x_of(0), y_of(0));
                cairo_scale(page_.to, x_of(radius) - x_of(0), y_of(radius) - y_of(0));
                outline(page_.to, circle, {0, 0}, 1);
                cairo_restore(page_.to);
                stroke(page_.to, 0.6, round);
            }
        });
    }

    /// Hatching for places without a value: stripes on white, or on grey in the other direction.
    static std::uint32_t hatch(int row, int column, bool nothing) {
        constexpr int apart = 12, wide = 2;
        constexpr std::uint32_t stripe = 0xA8A8A8, light = 0xECECEC, white = 0xFFFFFF;
        const int across = nothing ? column - row : column + row;
        return ((across % apart) + apart) % apart < wide ? stripe : nothing ? light : white;
    }

    /// Draws the map as an image, because it may have any number of cells.
    void add_shades() const {
        const Shades& shades = *figure_.shades;
        const std::vector<ShadeBand> bands = bands_of(shades, most_paper_bands);
        const std::optional<Interval> range = colour_range(shades);
        const Absences absent = absences_of(shades);
        const std::vector<double> right = edges_between(shades.x, panel_.view.x.logarithmic());
        const std::vector<double> up = edges_between(shades.y, panel_.view.y.logarithmic());
        Image map = image();
        for (int row = 0; row < map.height; ++row) {
            const auto j = value_at(up, panel_.view.y.at(1 - (row + 0.5) / map.height));
            for (int column = 0; column < map.width && j; ++column) {
                const auto i = value_at(right, panel_.view.x.at((column + 0.5) / map.width));
                if (!i) continue;
                const double z = shades.at(*i, *j);
                const auto band = band_of(bands, z);
                const bool nothing = absent.nothing && z == 0;
                std::uint32_t colour = hatch(row, column, nothing);
                if (band && !nothing) {
                    colour = range ? continuous_colour((z - range->low) / range->length())
                                   : shade_colour(*band, bands.size());
                }
                map.set(row, column, colour);
            }
        }
        map.put(page_.to);
    }

    // ---- curves

    /// Draws curves; those with too many corners for an SVG become images.
    void add_curves() {
        const Paper paper{panel_.view, {size_.width * resolution, size_.height * resolution}};
        std::vector<std::vector<std::size_t>> traces;
        double corners = 0;
        bool any = figure_.shades != nullptr || !figure_.marks.empty();
        for (const Curve& curve : figure_.curves) {
            if (!page_.go_on()) return;
            const std::vector<std::size_t>& kept = traces.emplace_back(thinned(curve, paper));
            const double each = curve.style == Style::line ? 1 : is_crowd(curve) || curve.style == Style::fill ? 2 : 10;
            corners += each * static_cast<double>(kept.size());
            any = any || std::ranges::any_of(kept, [&](std::size_t place) { return has(curve, place); });
        }
        if (!any) page_.words({"(no points)", (panel_.left + panel_.right) / 2, (panel_.bottom + panel_.top) / 2});
        const bool too_many = corners > most_corners_;
        Image dense = too_many ? image() : Image({}, {1, 1}, 1);
        const Context on_image = dense.context();
        for (const std::size_t i : drawing_order(figure_)) {
            add_curve(too_many ? on_image.get() : page_.to, i, traces[i], too_many ? &dense : nullptr);
        }
        if (too_many && page_.go_on()) dense.put(page_.to);
    }

    static bool is_crowd(const Curve& curve) {
        return curve.style == Style::points && curve.size() > most_separate_points;
    }

    std::uint32_t colour_of(std::size_t curve) const {
        const int own = figure_.curves[curve].colour;
        return palette[(own > 0 ? static_cast<std::size_t>(own - 1) : curve) % palette.size()];
    }

    /// A point of a curve on the page. Far points are moved nearer, as cairo uses 32-bit coordinates.
    Point at(const Curve& curve, std::size_t place) const {
        constexpr double far = 700;  // lengths of the axes
        return {panel_.left + std::clamp(panel_.view.x(curve.x.values[place]), -far, far) * size_.width,
                panel_.bottom - std::clamp(panel_.view.y(curve.y.values[place]), -far, far) * size_.height};
    }

    bool has(const Curve& curve, std::size_t place) const {
        return panel_.view.x.has(curve.x.values[place]) && panel_.view.y.has(curve.y.values[place]) &&
               (!curve.base || panel_.view.y.has(curve.base->values[place]));
    }

    void add_curve(cairo_t* to, std::size_t i, const std::vector<std::size_t>& places, Image* dense) const {
        const Curve& curve = figure_.curves[i];
        if (is_crowd(curve) && dense != nullptr) {
            add_cloud(to, i);
        } else if (curve.style == Style::points) {
            for (const std::size_t place : places) add_point(to, i, at(curve, place));
        } else if (curve.style == Style::fill) {
            clipped(to, [&] { add_area(to, i, places); });
        } else {
            std::vector<std::size_t> dots;
            clipped(to, [&] { dots = add_line(to, i, places, dense); });
            for (const std::size_t place : dots) {
                const Point point = at(curve, place);
                if (!sees(curve.x.values[place], curve.y.values[place])) continue;
                outline(to, circle, point, line_width);
                fill(to, colour_of(i));
            }
        }
    }

    /// Draws all points into an image in which several points make a pixel darker.
    void add_cloud(cairo_t* to, std::size_t i) const {
        const Curve& curve = figure_.curves[i];
        Image cloud = image();
        for (std::size_t place = 0; place < curve.size(); ++place) {
            if (!has(curve, place)) continue;
            if (std::uint32_t* dot = cloud.at(at(curve, place))) ++*dot;
        }
        for (std::uint32_t& dot : cloud.dots) {
            constexpr std::array<std::uint32_t, 5> opacities{0, 128, 180, 220, 255};
            const std::uint32_t opacity = opacities[std::min<std::size_t>(dot, opacities.size() - 1)];
            dot = opacity << 24U;
            for (const unsigned shift : {16U, 8U, 0U}) {  // cairo expects premultiplied colours
                dot |= ((colour_of(i) >> shift) & 255U) * opacity / 255 << shift;
            }
        }
        cloud.put(to);
    }

    void add_point(cairo_t* to, std::size_t i, Point place) const {
        if (is_crowd(figure_.curves[i])) {
            constexpr double side = 0.8;
            cairo_rectangle(to, place.x - side / 2, place.y - side / 2, side, side);
            fill(to, colour_of(i));
        } else {
            outline(to, point_shapes[i % point_shapes.size()], place, 2.2);
            stroke(to, 0.6, colour_of(i));
        }
    }

    /// Draws a line; returns the first indices of pieces too short to leave ink.
    std::vector<std::size_t> add_line(cairo_t* to, std::size_t i, const std::vector<std::size_t>& places,
                                      Image* dense) const {
        const Curve& curve = figure_.curves[i];
        if (dense == nullptr) set_dashes(to, i);
        cairo_set_line_join(to, CAIRO_LINE_JOIN_ROUND);
        std::vector<std::size_t> dots;
        std::optional<Point> last;
        double length = 0;
        std::size_t waiting = 0;
        for (const std::size_t place : places) {
            if (!has(curve, place)) {
                last.reset();
                continue;
            }
            const Point point = at(curve, place);
            if (!last) {
                if (!dots.empty() && length >= line_width) dots.pop_back();
                dots.push_back(place);
                length = 0;
            }
            const bool adds = last && (dense == nullptr || !is_inked(*dense, *last, point, colour_of(i)));
            (adds ? cairo_line_to : cairo_move_to)(to, point.x, point.y);
            if (last) length += std::hypot(point.x - last->x, point.y - last->y);
            last = point;
            // number of corners per stroke, because cairo's time grows with the square
            constexpr std::size_t batch = 20;
            if (dense == nullptr || ++waiting % batch != 0) continue;
            if (!page_.go_on()) return {};
            stroke(to, line_width, colour_of(i));
            cairo_move_to(to, point.x, point.y);
        }
        if (!dots.empty() && length >= line_width) dots.pop_back();
        // a white edge keeps the line visible on a map of any shade
        if (figure_.shades != nullptr && dense == nullptr) {
            cairo_set_dash(to, nullptr, 0, 0);
            set_colour(to, 0xFFFFFF);
            cairo_set_line_width(to, line_width + 1.6);
            cairo_stroke_preserve(to);
            set_dashes(to, i);
        }
        stroke(to, line_width, colour_of(i));
        cairo_set_dash(to, nullptr, 0, 0);
        return dots;
    }

    void set_dashes(cairo_t* to, std::size_t i) const {
        const Dashes own = figure_.curves[i].dashes;
        const auto& pattern =
            dash_patterns[own == Dashes::by_place ? i % dash_patterns.size() : static_cast<std::size_t>(own) - 1];
        cairo_set_dash(to, pattern.data(), static_cast<int>(pattern.size()), 0);
    }

    /// Returns whether the line is already drawn, as are most of a million overlapping lines.
    static bool is_inked(Image& image, Point from, Point to, std::uint32_t colour) {
        const int steps = 1 + static_cast<int>(std::max(std::fabs(to.x - from.x), std::fabs(to.y - from.y)));
        for (int step = 0; step <= steps; ++step) {
            const double part = static_cast<double>(step) / steps;
            const std::uint32_t* dot = image.at({from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)});
            if (dot != nullptr && *dot != (0xFF000000U | colour)) return false;
        }
        return true;
    }

    void add_area(cairo_t* to, std::size_t i, const std::vector<std::size_t>& places) const {
        const Curve& curve = figure_.curves[i];
        Curve other = curve;
        const double zero = panel_.view.y.logarithmic() ? panel_.view.y.range().low : 0;
        other.y = curve.base ? *curve.base : Numbers::own(std::vector<double>(curve.size(), zero));
        const auto missing = [&](std::size_t place) { return !has(curve, place); };
        for (auto from = places.begin(); from != places.end();) {
            const auto end = std::find_if(from, places.end(), missing);
            std::vector<Point> corners;
            for (auto place = from; place != end; ++place) corners.push_back(at(curve, *place));
            for (auto place = end; place != from;) corners.push_back(at(other, *--place));
            cairo_new_sub_path(to);
            for (const Point& corner : corners) cairo_line_to(to, corner.x, corner.y);
            cairo_close_path(to);
            from = std::find_if_not(end, places.end(), missing);
        }
        fill(to, colour_of(i), density);
    }

    void add_mark(MarkKind kind, Point place) const {
        const bool is_event = kind == MarkKind::impact || kind == MarkKind::switched;
        outline(page_.to, is_event ? diamond : circle, place, 2.8);
        if (kind == MarkKind::end || kind == MarkKind::impact) {
            fill(page_.to, ink_colour);
        } else {
            stroke(page_.to, 0.8, ink_colour);
        }
    }

    // ---- around the box

    void add_axes() {
        constexpr double tick = 0.3 * em;
        page_.line({panel_.left, panel_.top}, {panel_.left, panel_.bottom}, 0.8, ink_colour);
        page_.line({panel_.left, panel_.bottom}, {panel_.right, panel_.bottom}, 0.8, ink_colour);
        const double below = figure_.stuck.empty() ? 1.1 * em : 1.5 * em;
        for (std::size_t i = 0; i < panel_.x_ticks.at.size(); ++i) {
            const double x = x_of(panel_.x_ticks.at[i]);
            page_.line({x, panel_.bottom}, {x, panel_.bottom + tick}, 0.8, ink_colour);
            page_.words({typeset(panel_.x_ticks.text[i]), x, panel_.bottom + below});
        }
        for (std::size_t i = 0; i < panel_.y_ticks.at.size(); ++i) {
            const double y = y_of(panel_.y_ticks.at[i]);
            page_.line({panel_.left, y}, {panel_.left - tick, y}, 0.8, ink_colour);
            page_.words({typeset(panel_.y_ticks.text[i]), panel_.left - 0.5 * em, y}, Align::right);
        }
        page_.words(panel_.x_label);
        page_.words(panel_.y_label, Align::centre, true);
    }

    void add_bar(Interval x, double top, std::uint32_t colour) const {
        if (x.low < x.high) page_.rectangle({x_of(x.low), top}, {x_of(x.high), top + bar}, colour);
    }

    /// Bars below the ticks of the time axis; stops too close to be distinguished are merged.
    void add_stuck() const {
        const Interval seen = panel_.view.x.range();
        const double finest = seen.length() / (2 * size_.width);
        Interval all{seen.high, seen.high};
        for (const Interval& span : figure_.stuck) {
            const double low = std::max(span.low, seen.low);
            const double high = std::min(std::max(span.high, low + finest), seen.high);
            if (low > high || span.high < seen.low) continue;
            if (low - all.high <= finest && all.high > all.low) {
                all.high = std::max(all.high, high);
                continue;
            }
            add_bar(all, panel_.bottom + below_ticks, ink_colour);
            all = {low, high};
        }
        add_bar(all, panel_.bottom + below_ticks, ink_colour);
    }

    void add_hatched_sample(const LegendEntry& entry, double end) const {
        Image sample({entry.x, entry.y - 0.4 * em}, {end - entry.x, 0.8 * em}, resolution);
        for (int row = 0; row < sample.height; ++row) {
            for (int column = 0; column < sample.width; ++column) {
                sample.set(row, column, hatch(row, column, entry.sample == Sample::nothing));
            }
        }
        sample.put(page_.to);
    }

    /// Names at the ends of lines; at the right edge outside of the box, one below the other.
    void add_end_names() {
        std::vector<NamedEnd> outside;
        for (const NamedEnd& end : named_ends(figure_, panel_.view)) {
            if (end.outside()) {
                outside.push_back(end);
                continue;
            }
            page_.words({figure_.curves[end.curve].label, panel_.left + end.right * size_.width + 0.4 * em,
                         panel_.bottom - end.up * size_.height - 0.6 * em},
                        Align::left);
        }
        std::ranges::stable_sort(outside, std::ranges::greater{}, &NamedEnd::up);
        constexpr double apart = 1.2 * em;
        std::vector<double> places;
        for (const NamedEnd& end : outside) {
            const double y = panel_.bottom - end.up * size_.height;
            places.push_back(places.empty() ? y : std::max(y, places.back() + apart));
        }
        double lowest = panel_.bottom;
        for (std::size_t i = places.size(); i-- > 0;) {
            places[i] = std::min(places[i], lowest);
            lowest = places[i] - apart;
        }
        for (std::size_t i = 0; i < outside.size(); ++i) {
            const double y = panel_.bottom - outside[i].up * size_.height;
            page_.line({panel_.right, y}, {panel_.right + 0.7 * em, places[i]}, 0.6, colour_of(outside[i].curve));
            page_.words({figure_.curves[outside[i].curve].label, panel_.right + to_end_name, places[i]}, Align::left);
        }
    }

    void add_to_legend(const LegendEntry& entry) {
        const double end = entry.x + sample_width(entry.sample);
        const Point middle{(entry.x + end) / 2, entry.y};
        const auto block = [&](double height, std::uint32_t colour, double opacity) {
            page_.rectangle({entry.x, entry.y - height / 2}, {end, entry.y + height / 2}, colour, opacity);
        };
        page_.words({entry.text, end + after_sample, entry.y}, Align::left);
        if (entry.sample == Sample::mark) add_mark(static_cast<MarkKind>(entry.curve), middle);
        if (entry.sample == Sample::dead_zone) block(bar, grey, 1);
        if (entry.sample == Sample::stuck) block(bar, ink_colour, 1);
        if (entry.sample == Sample::nothing || entry.sample == Sample::no_value) add_hatched_sample(entry, end);
        if (entry.sample != Sample::curve) return;
        const Style style = figure_.curves[entry.curve].style;
        if (style == Style::points) add_point(page_.to, entry.curve, middle);
        if (style == Style::fill) block(0.7 * em, colour_of(entry.curve), density);
        if (style != Style::line) return;
        set_dashes(page_.to, entry.curve);
        page_.line({entry.x, entry.y}, {end, entry.y}, line_width, colour_of(entry.curve));
        cairo_set_dash(page_.to, nullptr, 0, 0);
    }

    void add_colour_bar() {
        const ColourBar& colours = panel_.bar;
        const double cell = size_.height / std::max(1.0, static_cast<double>(colours.cells));
        for (std::size_t i = 0; i < colours.cells; ++i) {
            const double y = panel_.bottom - static_cast<double>(i) * cell;
            const double part = static_cast<double>(i) / std::max(1.0, static_cast<double>(colours.cells) - 1);
            const double below = colours.continuous && i > 0 ? 0.5 : 0;  // avoids seams
            page_.rectangle({colours.left, y - cell}, {colours.right, y + below},
                            colours.continuous ? continuous_colour(part) : shade_colour(i, colours.cells));
        }
        for (const auto& [place, text] : colours.labels) {
            page_.words({text, colours.right + 0.4 * em, panel_.bottom - place * cell}, Align::left);
        }
        page_.words(panel_.bar_label, Align::centre, true);
    }

    Page& page_;
    const PaperPanel& panel_;
    const Figure& figure_;
    double most_corners_;
    Box size_{panel_.right - panel_.left, panel_.bottom - panel_.top};
};

/// The bytes of the file. Exceptions must not pass through cairo, which is C.
struct Output {
    const std::function<bool()>& go_on;
    std::string bytes = {};

    static cairo_status_t write(void* output, const unsigned char* bytes, unsigned int count) {
        Output& own = *static_cast<Output*>(output);
        try {
            own.bytes.append(reinterpret_cast<const char*>(bytes), count);
        } catch (const std::bad_alloc&) {
            return CAIRO_STATUS_NO_MEMORY;
        }
        return own.go_on() ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
    }
};

void replace_all(std::string& text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
}

/// Renames surfaces, as cairo numbers them across the process and a picture must not depend on earlier ones.
std::string renamed(std::string svg) {
    const std::string mark = "id=\"";
    int count = 0;
    for (std::size_t at = svg.find(mark); at != std::string::npos; at = svg.find(mark, at + mark.size())) {
        const std::size_t begin = at + mark.size();
        const std::string name = svg.substr(begin, svg.find('"', begin) - begin);
        const std::string other = fmt::format("part{}", ++count);
        replace_all(svg, mark + name + '"', mark + other + '"');
        for (const char end : {'"', ')'}) replace_all(svg, '#' + name + end, '#' + other + end);
    }
    return svg;
}

}  // namespace

text::Expected<std::string> paint(std::span<const Figure> given, PictureKind kind, PaperSize size,
                                  const std::function<bool()>& go_on) {
    constexpr double usual = 8.5, box = 0.85;  // cm; ratio of height to width of the box
    const std::vector<Figure> figures = with_bands(given, box * pixels_per_cm * (size.width > 0 ? size.width : usual));
    const Sheet sheet = lay_out(figures, size);
    constexpr double points = 0.75;    // points in a pixel
    constexpr double most_dots = 4e7;  // limit of a PNG: 160 MB
    Output output{go_on};
    std::optional<Image> image;
    Surface surface;
    if (kind == PictureKind::png) {
        image.emplace(Point{0, 0}, Box{sheet.width, sheet.height},
                      std::min(3.0, std::sqrt(most_dots / (sheet.width * sheet.height))));
    } else if (kind == PictureKind::svg) {
        surface.reset(cairo_svg_surface_create_for_stream(Output::write, &output, sheet.width, sheet.height));
        cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PX);
    } else {
        surface.reset(
            cairo_pdf_surface_create_for_stream(Output::write, &output, sheet.width * points, sheet.height * points));
        cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, title_of(figures).c_str());
    }
    const Context context = image ? image->context() : Context(cairo_create(surface.get()));
    cairo_t* const to = context.get();
    if (kind == PictureKind::pdf) cairo_scale(to, points, points);
    set_colour(to, 0xFFFFFF);
    cairo_paint(to);
    constexpr double most_corners = 5'500;  // corners of curves in an SVG, 24 bytes each
    Page page{to, kind == PictureKind::svg, go_on};
    for (const PaperPanel& panel : sheet.panels) {
        PanelPainter(page, panel, most_corners / static_cast<double>(sheet.panels.size())).paint();
    }
    const text::Error interrupted{"the picture was not drawn: drawing was interrupted"};
    if (!go_on()) return interrupted;
    cairo_surface_finish(surface.get());
    const cairo_status_t drawn = cairo_status(to);
    const cairo_status_t written = image
                                       ? cairo_surface_write_to_png_stream(image->surface.get(), Output::write, &output)
                                       : cairo_surface_status(surface.get());
    if (!go_on()) return interrupted;
    for (const cairo_status_t status : {drawn, written}) {
        if (status == CAIRO_STATUS_SUCCESS) continue;
        return text::error("the picture was not drawn: {}", cairo_status_to_string(status));
    }
    if (kind != PictureKind::svg) return std::move(output.bytes);
    std::string svg = renamed(std::move(output.bytes));
    svg.insert(svg.rfind("</svg>"), fmt::format("<g font-family=\"Arial, Helvetica, sans-serif\" font-size=\"{:.2f}\" "
                                                "fill=\"#{:06X}\">\n{}</g>\n",
                                                em, ink_colour, page.texts));
    return with_words(std::move(svg), figures);
}

}  // namespace dinal::plots
