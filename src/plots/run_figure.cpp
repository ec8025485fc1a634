#include "plots/run_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "analysis/recurrence.hpp"
#include "files/csv.hpp"
#include "motion/columns.hpp"
#include "text/words.hpp"

namespace dinal::plots {

namespace {

using model::Quantity;

struct Symbol {
    std::string_view name, symbol;
    Quantity quantity;  ///< curves of one quantity share an axis
};

constexpr std::array<Symbol, 7> ratios{{{"velocity/omega0", "θ'/ω₀", Quantity::angle},
                                        {"velocity_over_omega0", "θ'/ω₀", Quantity::angle},
                                        {"M/k", "M/k", Quantity::angle},
                                        {"M_over_k", "M/k", Quantity::angle},
                                        {"friction_over_k", "friction/k", Quantity::angle},
                                        {"damping_over_k", "damping/k", Quantity::angle},
                                        {"omega", "ω", Quantity::other}}};

/// The symbol of a column; the name of the body is ignored.
Symbol symbol_of(std::string_view name) {
    const std::string_view inner = name.substr(name.rfind('.') + 1);
    if (const motion::ColumnKind* kind = motion::find_column_kind(inner)) {
        return {kind->name, kind->symbol, kind->quantity};
    }
    const auto* found = std::ranges::find(ratios, inner, &Symbol::name);
    return found != ratios.end() ? *found
                                 : Symbol{name, name, name.ends_with("/k") ? Quantity::angle : Quantity::other};
}

/// The symbol with the body or link before it: "load θ'".
std::string full_symbol(std::string_view name) {
    const Symbol symbol = symbol_of(name);
    const std::size_t point = name.rfind('.');
    const bool named = point != std::string_view::npos && symbol.symbol != name;
    return named ? fmt::format("{} {}", name.substr(0, point), symbol.symbol) : std::string(symbol.symbol);
}

std::string axis_label(const RunData& run, std::string_view name) {
    return model::name_with_unit(full_symbol(name), run.units.of(symbol_of(name).quantity));
}

text::Expected<Numbers> plain_column(const RunData& run, std::string_view name) {
    const auto column = files::find_column(run.result->names(), name);
    if (!column) {
        return column.error();
    }
    const auto values = run.result->rows.col(*column);
    return Numbers{run.owner, {values.data(), static_cast<std::size_t>(values.size())}};
}

/// The divisor in "M/k" etc.; none for other names.
std::optional<double> divisor(const RunData& run, std::string_view name) {
    const std::size_t slash = name.find('/');
    if (slash == std::string_view::npos || !run.system || !run.system->has_spring()) {
        return std::nullopt;
    }
    const std::string_view by = name.substr(slash + 1);
    if (by == "k") {
        return run.system->stiffness();
    }
    return by == "omega0" ? std::optional(run.system->natural_frequency()) : std::nullopt;
}

text::Expected<Numbers> column(const RunData& run, std::string_view name) {
    const std::optional<double> by = divisor(run, name);
    if (!by) {
        return plain_column(run, name);
    }
    auto plain = plain_column(run, name.substr(0, name.find('/')));
    if (!plain) {
        return plain;
    }
    std::vector<double> scaled(plain->values.size());
    std::ranges::transform(plain->values, scaled.begin(), [&by](double x) { return x / *by; });
    return Numbers::own(std::move(scaled));
}

bool has(const RunData& run, std::string_view name) {
    return run.result->find(name).has_value();
}

bool is_excited(const RunData& run, std::string_view name) {
    const auto M = run.result->find(name);
    return M && run.result->size() > 0 && run.result->rows.col(*M).cwiseAbs().maxCoeff() > 0;
}

/// The columns of y by default: theta, and M/k if M acts; in a table without theta, the first column other than x.
std::vector<std::string> usual_columns(const RunData& run, std::string_view x) {
    if (!has(run, "theta")) {
        const auto& names = run.result->names();
        const auto other = std::ranges::find_if(names, [x](const std::string& name) { return name != x; });
        return {other != names.end() ? *other : std::string(x)};
    }
    std::vector<std::string> names{"theta"};
    if (run.system && run.system->has_spring() && is_excited(run, "M")) {
        names.emplace_back("M/k");
    } else if (is_excited(run, "M_over_k")) {
        names.emplace_back("M_over_k");
    }
    return names;
}

}  // namespace

std::string symbol_for(std::string_view column) {
    return full_symbol(column);
}

std::vector<Interval> stuck_intervals(const motion::Run& run) {
    std::vector<Interval> intervals;
    for (const analysis::Stretch& stretch : analysis::stretches(run)) {
        if (stretch.stuck && stretch.begun_by && !intervals.empty() && intervals.back().high == stretch.from) {
            intervals.back().high = stretch.to;  // the mass stuck repeatedly before it came to rest
        } else if (stretch.stuck) {
            intervals.push_back({stretch.from, stretch.to});
        }
    }
    return intervals;
}

namespace {

/// Impacts and relay switches on the curve of theta, without those too close to be distinguished.
std::vector<Mark> marks_of_events(const motion::Run& run) {
    constexpr double apart = 1.0 / 200;  // fraction of the duration of the run
    std::vector<Mark> marks;
    for (const auto& [event, kind] : {std::pair{model::EventKind::impact, MarkKind::impact},
                                      std::pair{model::EventKind::switched, MarkKind::switched},
                                      std::pair{model::EventKind::slide_begins, MarkKind::switched},
                                      std::pair{model::EventKind::slide_ends, MarkKind::switched}}) {
        double last = -model::never;
        for (const model::Event& e : run.events) {
            if (e.kind != event || e.t - last < apart * (run.t_stop - run.t_start)) {
                continue;
            }
            marks.push_back({e.t, e.theta, kind});
            last = e.t;
        }
    }
    return marks;
}

/// Groups names by quantity, in the order of their first members.
std::vector<std::vector<std::string>> by_quantity(const std::vector<std::string>& names) {
    std::vector<std::vector<std::string>> groups;
    for (const std::string& name : names) {
        const Quantity quantity = symbol_of(name).quantity;
        const auto same = std::ranges::find_if(groups, [quantity](const std::vector<std::string>& group) {
            return symbol_of(group.front()).quantity == quantity;
        });
        same != groups.end() ? same->push_back(name) : groups.push_back({name});
    }
    return groups;
}

text::Expected<Figure> figure_of_columns(const RunData& run, const std::string& across, const Numbers& x,
                                         const std::vector<std::string>& names) {
    Figure figure;
    figure.x.label = axis_label(run, across);
    const bool with_theta = text::contains(names, "theta");
    for (const std::string& name : names) {
        const auto values = column(run, name);
        if (!values) {
            return values.error();
        }
        const bool is_load = name == "M/k" || name == "M_over_k";
        figure.curves.push_back({.x = x,
                                 .y = *values,
                                 .label = names.size() > 1 ? full_symbol(name) : "",
                                 .behind = is_load && with_theta});
    }
    const Symbol first = symbol_of(names.front());
    const bool alike = std::ranges::all_of(
        names, [&first](const std::string& name) { return symbol_of(name).symbol == first.symbol; });
    if (names.size() == 1) {
        figure.y.label = axis_label(run, names.front());
    } else if (alike) {
        figure.y.label = model::name_with_unit(std::string(first.symbol), run.units.of(first.quantity));
    } else {
        figure.y.label = first.quantity == Quantity::torque ? model::name_with_unit("torque", run.units.M)
                                                            : run.units.of(first.quantity);
        figure.y.names_curves = first.quantity != Quantity::torque;
    }
    if (across == "t") {
        figure.stuck = stuck_intervals(*run.result);
        if (with_theta) {
            figure.marks = marks_of_events(*run.result);
        }
    }
    return figure;
}

}  // namespace

text::Expected<std::vector<Figure>> column_figures(const RunData& run, const ColumnsToDraw& asked) {
    if (run.result->names().empty()) {
        return text::Error{"the run has no columns to draw"};
    }
    const std::string across = !asked.x.empty() ? asked.x : has(run, "t") ? "t" : run.result->names().front();
    const std::vector<std::string> names = asked.ys.empty() ? usual_columns(run, across) : asked.ys;
    const auto x_values = column(run, across);
    if (!x_values) {
        return x_values.error();
    }
    std::vector<Figure> figures;
    const std::vector<std::vector<std::string>> all{names};
    for (const std::vector<std::string>& group : asked.axes == Axes::one ? all : by_quantity(names)) {
        auto figure = figure_of_columns(run, across, *x_values, group);
        if (!figure) {
            return figure.error();
        }
        figures.push_back(std::move(figure).value());
        figures.back().below = figures.size() > 1;
        for (std::size_t i = 0; i < group.size(); ++i) {
            const auto place = std::ranges::find(names, group[i]) - names.begin();
            if (place < static_cast<std::ptrdiff_t>(asked.labels.size())) {
                figures.back().curves[i].label = asked.labels[static_cast<std::size_t>(place)];
            }
        }
    }
    for (std::size_t i = 0; i + 1 < figures.size(); ++i) {  // shared elements appear once, at the lowest figure
        figures[i].x.label.clear();
        figures[i].stuck.clear();
    }
    return figures;
}

namespace {

/// Adds the corners between rows to a phase curve: impacts, relay switches, opened and closed contacts. Divides
/// velocities by `by`.
void add_corners(Curve& curve, const motion::Run& run, double by) {
    const auto is_corner = [](const model::Event& e) {
        return e.kind > model::EventKind::rest && e.kind != model::EventKind::user;
    };
    const auto times = run.find("t");
    if (!times || std::ranges::none_of(run.events, is_corner)) {
        return;
    }
    std::vector<double> x, y;
    const auto put = [&x, &y](double theta, double velocity) {
        x.push_back(theta);
        y.push_back(velocity);
    };
    auto event = run.events.begin();
    for (std::size_t i = 0; i < curve.size(); ++i) {
        for (; event != run.events.end() && event->t <= run.rows.col(*times)[static_cast<Eigen::Index>(i)]; ++event) {
            if (!is_corner(*event)) continue;
            put(event->theta, event->velocity / by);
            if (event->kind == model::EventKind::impact) {
                put(event->theta, -run.restitution * event->velocity / by);
            }
        }
        put(curve.x.values[i], curve.y.values[i]);
    }
    curve.x = Numbers::own(std::move(x));
    curve.y = Numbers::own(std::move(y));
}

}  // namespace

text::Expected<Figure> phase_figure(const RunData& run) {
    const bool record = !run.system && has(run, "velocity_over_omega0");
    if (!run.system && !record) {
        return text::Error{
            "the phase plane needs omega0, which a run read from a .csv file does not have; use run:plot{ x = "
            "\"theta\", y = \"velocity\" }"};
    }
    const bool scaled = record || run.system->has_spring();  // without k there is no omega0
    const char* velocity = record ? "velocity_over_omega0" : scaled ? "velocity/omega0" : "velocity";
    auto figures = column_figures(run, {.x = "theta", .ys = {velocity}});
    if (!figures) {
        return figures.error();
    }
    Figure plane = std::move(figures).value().front();
    plane.equal = scaled;
    plane.circles = record || run.system->has_linear_spring();
    if (!record) {
        add_corners(plane.curves.front(), *run.result, scaled ? run.system->natural_frequency() : 1);
    }
    const Curve& motion = plane.curves.front();
    if (const std::size_t rows = motion.size(); rows > 0) {
        plane.marks = {{motion.x.values[0], motion.y.values[0], MarkKind::start},
                       {motion.x.values[rows - 1], motion.y.values[rows - 1], MarkKind::end}};
    }
    if (run.load && run.system && run.system->has_linear_spring() && run.system->dead_zone() > 0) {
        const double centre = *run.load / run.system->stiffness();
        const auto [lowest, highest] = run.system->resting_places();
        Interval zone{centre + lowest, centre + highest};
        if (const auto& walls = run.system->walls()) {
            zone = {std::max(zone.low, walls->lower), std::min(zone.high, walls->upper)};
        }
        if (zone.low < zone.high) plane.dead_zone = zone;
    }
    return plane;
}

namespace {

using Pair = std::pair<std::size_t, std::size_t>;

/// Returns how well a body begins the row: 2 for an end of a chain that is never second in a link, 1 for another end,
/// otherwise 0.
int merit(std::size_t body, std::span<const Pair> links) {
    const auto named =
        std::ranges::count_if(links, [body](const Pair& link) { return link.first == body || link.second == body; });
    const bool driven = text::contains(links, body, &Pair::second);
    return named > 1 ? 0 : driven ? 1 : 2;
}

}  // namespace

std::vector<std::size_t> neighbours(std::size_t count, std::span<const Pair> links) {
    std::vector<std::size_t> row;
    std::vector<bool> placed(count, false);
    const auto put = [&](std::size_t body) {
        placed[body] = true;
        row.push_back(body);
    };
    while (row.size() < count) {
        std::size_t next = count;
        for (std::size_t i = 0; i < count; ++i) {
            if (!placed[i] && (next == count || merit(i, links) > merit(next, links))) next = i;
        }
        put(next);
        for (bool found = true; found;) {
            const auto link = std::ranges::find_if(links, [&](const Pair& pair) {
                return (pair.first == row.back() && !placed[pair.second]) ||
                       (pair.second == row.back() && !placed[pair.first]);
            });
            found = link != links.end();
            if (found) put(link->first == row.back() ? link->second : link->first);
        }
    }
    return row;
}

}  // namespace dinal::plots
