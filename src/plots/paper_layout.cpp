#include "plots/painter.hpp"

#include <algorithm>
#include <cmath>

#include "plots/shades.hpp"
#include "text/characters.hpp"

namespace dinal::plots {
namespace {

constexpr double letter_width = 0.55 * em;  // average of the usual fonts
constexpr double digit_width = 0.62 * em;
constexpr double line_height = 1.35 * em;
constexpr double between_entries = 1.2 * em;

double width_of(std::string_view text) {
    return letter_width * static_cast<double>(text::columns(text));
}

double digits_width(const std::string& number) {
    return digit_width * static_cast<double>(text::columns(typeset(number)));
}

/// Cuts a text that is too long, and marks the cut.
std::string cut(const std::string& text, double width) {
    std::string shown = text::displayable(text);
    if (width_of(shown) <= width) {
        return shown;
    }
    return std::string(text::cut_to_columns(shown, static_cast<std::size_t>(std::max(1.0, width / letter_width - 1)))) +
           "…";
}

double widest(const std::vector<std::string>& texts) {
    double width = 0;
    for (const std::string& text : texts) {
        width = std::max(width, digits_width(text));
    }
    return width;
}

std::string with_offset(const std::string& label, const Ticks& ticks) {
    return ticks.offset.empty() ? label : label + " (" + typeset(ticks.offset) + ")";
}

/// Returns whether the curve's name is at its end. A curve without points exists for the legend only.
bool ends_with_name(const Figure& figure, const Curve& curve) {
    const auto& y = curve.y.values;
    return figure.ends && curve.style == Style::line && !curve.label.empty() &&
           std::ranges::any_of(y, [](double value) { return std::isfinite(value); });
}

std::vector<LegendEntry> legend_of(const Figure& figure) {
    std::vector<LegendEntry> entries;
    for (std::size_t i = 0; i < figure.curves.size(); ++i) {
        if (!figure.curves[i].label.empty() && !ends_with_name(figure, figure.curves[i])) {
            entries.push_back({Sample::curve, i, figure.curves[i].label});
        }
    }
    constexpr std::size_t most = 42;  // number of distinct styles
    if (entries.size() > most) {
        const std::string rest = "+ " + std::to_string(entries.size() - most) + " more";
        entries.resize(most);
        entries.push_back({Sample::none, 0, rest});
    }
    for (const MarkKind kind : kinds_of(figure.marks)) {
        const auto place = static_cast<std::size_t>(kind);
        entries.push_back({Sample::mark, place, mark_names[place]});
    }
    if (figure.dead_zone) {
        entries.push_back({Sample::dead_zone, 0, "dead zone"});
    }
    if (!figure.stuck.empty()) {
        entries.push_back({Sample::stuck, 0, "stuck"});
    }
    if (figure.shades != nullptr) {
        const Absences absent = absences_of(*figure.shades);
        if (absent.nothing) entries.push_back({Sample::nothing, 0, figure.shades->label + " = 0"});
        if (absent.no_value) entries.push_back({Sample::no_value, 0, "no value"});
    }
    return entries;
}

/// Arranges the entries in lines of this width: a few in one line, many in columns, read downwards. Their y is
/// negative, 0 at the top. Returns the number of lines.
int arrange_in_lines(std::vector<LegendEntry>& entries, double width) {
    if (entries.empty()) {
        return 0;
    }
    double most = 0;
    for (const LegendEntry& entry : entries) {
        most = std::max(most, sample_width(entry.sample) + after_sample + width_of(entry.text) + between_entries);
    }
    most = std::min(most, width + between_entries);
    constexpr int few = 4;
    const int count = static_cast<int>(entries.size());
    const int columns = std::max(1, static_cast<int>((width + between_entries) / most));
    const int column_length = count > few ? (count + columns - 1) / columns : 0;
    double x = 0;
    int line = 0;
    for (int i = 0; i < count; ++i) {
        LegendEntry& entry = entries[static_cast<std::size_t>(i)];
        entry.text = cut(entry.text, width - sample_width(entry.sample) - after_sample);
        const double own = sample_width(entry.sample) + after_sample + width_of(entry.text);
        if (column_length > 0) {
            const auto column = i / column_length;
            x = column * most;
            line = i % column_length;
        } else if (x > 0 && x + own > width) {
            x = 0;
            ++line;
        }
        entry.x = x;
        entry.y = -(line + 0.5) * line_height;
        x += own + between_entries;
    }
    return std::max(column_length, line + 1);
}

constexpr int most_ticks = 12;  // maximum number of ticks per axis, also on a large poster

int x_tick_count(const PaperPanel& panel, double em_each) {
    return std::clamp(static_cast<int>((panel.right - panel.left) / (em_each * em)), 2, most_ticks);
}

/// Sets the ticks below the box; the last label must not exceed `limit`.
void set_x_ticks(PaperPanel& panel, double limit) {
    const Figure& figure = *panel.figure;
    const bool free = figure.x.ticks.empty() && !figure.x.division;
    for (int attempt = 0; attempt < 2; ++attempt) {
        constexpr double closest = 3;  // em between ticks
        panel.x_ticks = ticks_of(figure.x, panel.view.x, x_tick_count(panel, closest));
        const double room = widest(panel.x_ticks.text) + em;
        if (free && room > closest * em) {
            panel.x_ticks = ticks_of(figure.x, panel.view.x, x_tick_count(panel, room / em));
        }
        if (panel.x_ticks.at.empty() || figure.equal) {
            return;
        }
        const double place = panel.left + panel.view.x(panel.x_ticks.at.back()) * (panel.right - panel.left);
        const double over = place + digits_width(panel.x_ticks.text.back()) / 2 - limit;
        if (over <= 0) {
            return;
        }
        panel.right -= over;
    }
}

constexpr double bar_gap = 1.0 * em, bar_width = 1.1 * em, bar_ticks = 0.5 * em;

/// The labels of a colour bar: round numbers beside continuous colours; bands of a single number have it in the middle.
ColourBar bar_of(const Shades& shades) {
    const auto range = colour_range(shades);
    if (!range) {
        const std::vector<ShadeBand> bands = bands_of(shades, most_paper_bands);
        ColourBar colours{.cells = bands.size()};
        for (std::size_t i = 0; i < bands.size(); ++i) {
            colours.labels.emplace_back(static_cast<double>(i) + 0.5, typeset(bands[i].text));
        }
        return colours;
    }
    constexpr std::size_t fine = 64;
    const Ticks ticks = ticks_of(Axis{}, Scale(*range, false), 6);
    ColourBar colours{.cells = fine, .continuous = true};
    for (std::size_t i = 0; i < ticks.at.size(); ++i) {
        const double place = fine * (ticks.at[i] - range->low) / range->length();
        if (place > -0.5 && place < fine + 0.5) colours.labels.emplace_back(place, typeset(ticks.text[i]));
    }
    return colours;
}

/// "θ, M/k, m": the curves' names in front of a unit.
std::string y_label_of(const Figure& figure) {
    if (!figure.y.names_curves) return figure.y.label;
    std::string label;
    for (const Curve& curve : figure.curves) {
        if (!curve.label.empty()) label += (label.empty() ? "" : ", ") + curve.label;
    }
    return label.empty() || figure.y.label.empty() ? label + figure.y.label : label + ", " + figure.y.label;
}

/// Computes the margins of a panel, its ticks, and its box, which begins at least `inset` from the left. `beside` has
/// margins that keep neighbouring boxes equally high.
void place(PaperPanel& panel, double left, double width, double height, double inset, const PaperPanel& beside) {
    const Figure& figure = *panel.figure;
    const auto y_ticks = [&](double high) {
        return ticks_of(figure.y, panel.view.y, std::clamp(static_cast<int>(high / (2.6 * em)), 2, most_ticks));
    };
    panel.y_ticks = y_ticks(height);
    panel.y_label.text = with_offset(y_label_of(figure), panel.y_ticks);
    const double label_room = panel.y_label.text.empty() ? 0 : 1.6 * em;
    panel.left = left + 0.4 * em + (figure.axes ? label_room + widest(panel.y_ticks.text) + 0.9 * em : 0);
    panel.left = std::max(panel.left, left + inset);
    panel.right = left + width - (figure.axes ? 1.0 : 0.4) * em;
    if (figure.shades != nullptr) {
        panel.bar = bar_of(*figure.shades);
        double numbers = 0;
        for (const auto& [place, text] : panel.bar.labels) numbers = std::max(numbers, width_of(text));
        panel.bar_label.text = figure.shades->label;
        panel.bar_label.x = panel.right - 0.3 * em;
        panel.right -= bar_gap + bar_width + bar_ticks + numbers + (panel.bar_label.text.empty() ? 0 : 1.2 * em);
    }
    double names = 0;
    for (const NamedEnd& end : named_ends(figure, panel.view)) {
        if (end.outside()) names = std::max(names, width_of(figure.curves[end.curve].label));
    }
    if (names > 0) panel.right -= to_end_name + names - (figure.axes ? 0.7 : 0) * em;
    const double bars = figure.stuck.empty() ? 0 : 0.6 * em;
    panel.bottom = figure.axes ? 2.1 * em + bars + (figure.x.label.empty() ? 0 : 1.5 * em) : 0.4 * em;
    panel.bottom = panel.below = std::max(panel.bottom, beside.below);
    panel.right = std::max(panel.right, panel.left + 2 * em);
    panel.legend = legend_of(figure);
    const double title = figure.title.empty() ? 0 : 1.5 * em;
    double above = 0.5 * em + arrange_in_lines(panel.legend, panel.right - panel.left) * line_height + title;
    // on a sheet too small for both, the legend is dropped rather than the curves
    if (height - above < panel.bottom + 3 * em) {
        panel.legend.clear();
        above = 0.5 * em + title;
    }
    const double own_above = above;
    above = panel.above = std::max(above, beside.above);
    panel.top = std::max(height - above, panel.bottom + 2 * em);
    const double legend_left = panel.left;
    if (figure.equal) {
        const Box room{panel.right - panel.left, panel.top - panel.bottom};
        const Box box = equal_box(panel.view, room);
        panel.left += (room.width - box.width) / 2;
        panel.right = panel.left + box.width;
        panel.unused = room.height - box.height;
        panel.top = panel.bottom + box.height;
    }
    panel.y_ticks = y_ticks(panel.top - panel.bottom);
    set_x_ticks(panel, figure.shades != nullptr ? panel.right + bar_gap : left + width - 0.2 * em);
    panel.bar.left = panel.right + bar_gap;
    panel.bar.right = panel.bar.left + bar_width;
    for (LegendEntry& entry : panel.legend) {
        entry.x += std::min(legend_left, panel.left);
        entry.y += panel.top + own_above - 0.1 * em - title;
    }
    const double whole_width =
        2 * std::min((panel.left + panel.right) / 2 - left, left + width - (panel.left + panel.right) / 2);
    // Titles of neighbouring panels are aligned regardless of their legends, except over a square box, which may be far
    // below.
    const double title_above = figure.equal ? own_above : above;
    panel.title = {cut(figure.title, whole_width), (panel.left + panel.right) / 2, panel.top + title_above - 0.7 * em};
    panel.x_label.text = cut(with_offset(figure.x.label, panel.x_ticks), whole_width);
    panel.x_label.x = (panel.left + panel.right) / 2;
    panel.x_label.y = panel.bottom - 2.85 * em - bars;
    panel.y_label.text =
        cut(panel.y_label.text, 2 * std::min((panel.bottom + panel.top) / 2, height - (panel.bottom + panel.top) / 2));
    panel.y_label.x = panel.left - widest(panel.y_ticks.text) - 1.7 * em;
    panel.y_label.y = panel.bar_label.y = (panel.bottom + panel.top) / 2;
}

double share_of(const Figure& figure) {
    return figure.equal ? 1 : 1.4;
}

/// Figures side by side, each with those below it.
using Pile = std::vector<const Figure*>;
std::vector<Pile> piles_of(std::span<const Figure> figures) {
    std::vector<Pile> piles;
    for (const Figure& figure : figures) {
        if (!figure.below || piles.empty()) {
            piles.emplace_back();
        }
        piles.back().push_back(&figure);
    }
    return piles;
}

PaperSize complete(PaperSize size, const std::vector<Pile>& piles) {
    const bool single = piles.size() == 1;
    if (size.width <= 0) {
        size.width = single ? 8.5 : 17;
    }
    if (size.height <= 0) {
        double most = 0;
        for (const Pile& pile : piles) {
            double all = 0;
            for (const Figure* figure : pile) {
                // A long legend gets additional space.
                std::vector<LegendEntry> entries = legend_of(*figure);
                const double width = size.width * pixels_per_cm / static_cast<double>(piles.size()) - 6 * em;
                const double legend = arrange_in_lines(entries, width) * line_height / pixels_per_cm;
                all += (pile.size() > 1 ? 4.4 : single && figure->equal ? 7.6 : 5.6) + legend;
            }
            most = std::max(most, all);
        }
        size.height = single ? most : most + 0.5;
    }
    return size;
}

/// All vertical positions in a panel, which are counted from below.
std::vector<double*> heights_of(PaperPanel& panel) {
    std::vector<double*> all{&panel.bottom,    &panel.top,       &panel.title.y,
                             &panel.x_label.y, &panel.y_label.y, &panel.bar_label.y};
    for (LegendEntry& entry : panel.legend) all.push_back(&entry.y);
    return all;
}

/// Places figures one below the other with aligned axes.
void place_pile(std::vector<PaperPanel>& panels, const Pile& pile, double left, double width, double whole,
                const PaperPanel& beside) {
    const double height = whole / static_cast<double>(pile.size());
    double inset = 0;
    std::vector<PaperPanel> placed;
    for (int attempt = 0; attempt < 2; ++attempt) {
        placed.clear();
        for (std::size_t i = 0; i < pile.size(); ++i) {
            placed.push_back({.figure = pile[i], .view = view_of(*pile[i])});
            place(placed.back(), left, width, height, inset, beside);
            for (double* y : heights_of(placed.back())) *y += whole - static_cast<double>(i + 1) * height;
        }
        if (pile.size() == 1) {
            break;
        }
        for (const PaperPanel& panel : placed) {
            inset = std::max(inset, panel.left - left);
        }
    }
    panels.insert(panels.end(), placed.begin(), placed.end());
}

}  // namespace

std::vector<NamedEnd> named_ends(const Figure& figure, const View& view) {
    std::vector<NamedEnd> ends;
    for (std::size_t i = 0; i < figure.curves.size(); ++i) {
        const Curve& curve = figure.curves[i];
        if (!ends_with_name(figure, curve)) continue;
        for (std::size_t place = curve.size(); place-- > 0;) {
            const NamedEnd end{i, view.x(curve.x.values[place]), view.y(curve.y.values[place])};
            if (end.right >= 0 && end.right <= 1 && end.up >= 0 && end.up <= 1) {
                ends.push_back(end);
                break;
            }
        }
    }
    return ends;
}

Sheet lay_out(std::span<const Figure> figures, PaperSize size) {
    const bool any_height = size.height <= 0;
    const std::vector<Pile> piles = piles_of(figures);
    size = complete(size, piles);
    Sheet sheet{size.width * pixels_per_cm, size.height * pixels_per_cm, {}};
    double shares = 0;
    for (const Pile& pile : piles) {
        shares += share_of(*pile.front());
    }
    // Boxes side by side have equal heights: their margins are the greatest of all, known after a first placement.
    PaperPanel beside{.figure = nullptr, .view = view_of(figures.front())};
    const bool row = piles.size() > 1 && piles.size() == figures.size();
    for (int attempt = 0; attempt < (row ? 2 : 1); ++attempt) {
        sheet.panels.clear();
        double left = 0;
        for (const Pile& pile : piles) {
            const double width = sheet.width * share_of(*pile.front()) / shares;
            place_pile(sheet.panels, pile, left, width, sheet.height, beside);
            left += width;
        }
        for (const PaperPanel& panel : sheet.panels) {
            beside.above = std::max(beside.above, panel.above);
            beside.below = std::max(beside.below, panel.below);
        }
    }
    if (any_height && figures.size() == 1 && sheet.panels.front().unused > 1) {
        return lay_out(figures, {size.width, size.height - sheet.panels.front().unused / pixels_per_cm});
    }
    for (PaperPanel& panel : sheet.panels) {
        for (double* y : heights_of(panel)) *y = sheet.height - *y;
    }
    return sheet;
}

std::string typeset(const std::string& number) {
    constexpr std::string_view raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string result;
    bool in_power = false;
    for (const char c : number) {
        if (c == 'e') {
            if (result == "1" || result == "−1") {
                result.pop_back();
            } else {
                result += "·";
            }
            result += "10";
            in_power = true;
        } else if (c == '-') {
            result += in_power ? "⁻" : "−";
        } else if (in_power && c >= '0' && c <= '9') {
            result += raised[c - '0'];
        } else if (!(in_power && c == '+')) {
            result += c;
        }
    }
    return result;
}

}  // namespace dinal::plots
