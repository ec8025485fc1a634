#include "plots/run_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "analysis/stretches.hpp"
#include "files/table.hpp"

namespace dinal::plots {
namespace {

struct Symbol {
    std::string_view name, symbol, unit;
};

constexpr std::array<Symbol, 8> symbols{{{"theta", "θ", "rad"},
                                         {"velocity", "θ'", "rad/time"},
                                         {"velocity/omega0", "θ'/ω₀", "rad"},
                                         {"velocity_over_omega0", "θ'/ω₀", "rad"},
                                         {"M/k", "M/k", "rad"},
                                         {"M_over_k", "M/k", "rad"},
                                         {"friction_over_k", "friction/k", "rad"},
                                         {"damping_over_k", "damping/k", "rad"}}};

Symbol symbol_of(std::string_view name) {
    const auto* found =
        std::find_if(symbols.begin(), symbols.end(), [name](const Symbol& symbol) { return symbol.name == name; });
    return found != symbols.end() ? *found : Symbol{name, name, name.ends_with("/k") ? "rad" : ""};
}

std::string axis_label(std::string_view name) {
    const Symbol symbol = symbol_of(name);
    return std::string(symbol.symbol) + (symbol.unit.empty() ? "" : ", " + std::string(symbol.unit));
}

text::Expected<Numbers> plain_column(const RunData& run, std::string_view name) {
    const auto column = files::find_column(run.trajectory->names, name);
    if (!column) {
        return column.error();
    }
    const auto values = run.trajectory->rows.col(*column);
    return Numbers{run.owner, {values.data(), static_cast<std::size_t>(values.size())}};
}

/// "M/k" and its like; nothing when the name is none of these.
std::optional<double> divisor(const RunData& run, std::string_view name) {
    const std::size_t slash = name.find('/');
    if (slash == std::string_view::npos || run.system == nullptr || !run.system->has_spring()) {
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
    std::transform(plain->values.begin(), plain->values.end(), scaled.begin(), [&by](double x) { return x / *by; });
    return Numbers::own(std::move(scaled));
}

bool has(const RunData& run, std::string_view name) {
    return run.trajectory->find(name).has_value();
}

bool is_excited(const RunData& run, std::string_view name) {
    const auto M = run.trajectory->find(name);
    return M && run.trajectory->size() > 0 && run.trajectory->rows.col(*M).cwiseAbs().maxCoeff() > 0;
}

/// Any other table of numbers: the second column over the first.
std::vector<std::string> usual_columns(const RunData& run, std::string_view x) {
    if (!has(run, "theta")) {
        const auto& names = run.trajectory->names;
        const auto other = std::find_if(names.begin(), names.end(), [x](const std::string& name) { return name != x; });
        return {other != names.end() ? *other : std::string(x)};
    }
    std::vector<std::string> names{"theta"};
    if (run.system != nullptr && run.system->has_spring() && is_excited(run, "M")) {
        names.emplace_back("M/k");
    } else if (is_excited(run, "M_over_k")) {
        names.emplace_back("M_over_k");
    }
    return names;
}

}  // namespace

std::vector<Interval> stuck_intervals(const motion::Trajectory& trajectory) {
    std::vector<Interval> intervals;
    for (const analysis::Stretch& stretch : analysis::stretches(trajectory)) {
        if (stretch.stuck && stretch.begun_by && !intervals.empty() && intervals.back().high == stretch.from) {
            intervals.back().high = stretch.to;  // it stuck, and then it came to rest
        } else if (stretch.stuck) {
            intervals.push_back({stretch.from, stretch.to});
        }
    }
    return intervals;
}

namespace {

/// Impacts and switches of relays on the curve of theta; of those that nobody could tell apart, one.
std::vector<Mark> marks_of_events(const motion::Trajectory& trajectory) {
    constexpr double apart = 1.0 / 200;  // of the run
    std::vector<Mark> marks;
    for (const auto& [event, kind] : {std::pair{model::EventKind::impact, MarkKind::impact},
                                      std::pair{model::EventKind::switched, MarkKind::switched}}) {
        double last = -model::never;
        for (const model::Event& e : trajectory.events) {
            if (e.kind != event || e.t - last < apart * (trajectory.t_stop - trajectory.t_start)) {
                continue;
            }
            marks.push_back({e.t, e.theta, kind});
            last = e.t;
        }
    }
    return marks;
}

}  // namespace

text::Expected<Figure> column_figure(const RunData& run, std::string_view x, const std::vector<std::string>& ys) {
    if (run.trajectory->names.empty()) {
        return text::Error{"the run has no columns to draw"};
    }
    const std::string across = !x.empty() ? std::string(x) : has(run, "t") ? "t" : run.trajectory->names.front();
    const std::vector<std::string> names = ys.empty() ? usual_columns(run, across) : ys;
    const auto x_values = column(run, across);
    if (!x_values) {
        return x_values.error();
    }
    Figure figure;
    figure.x.label = axis_label(across);
    for (const std::string& name : names) {
        const auto values = column(run, name);
        if (!values) {
            return values.error();
        }
        figure.curves.push_back({*x_values, *values, names.size() > 1 ? std::string(symbol_of(name).symbol) : ""});
    }
    const std::string_view unit = symbol_of(names.front()).unit;
    if (names.size() == 1) {
        figure.y.label = axis_label(names.front());
    } else if (std::all_of(names.begin(), names.end(),
                           [unit](const std::string& name) { return symbol_of(name).unit == unit; })) {
        figure.y.label = unit;
    }
    if (across == "t") {
        figure.stuck = stuck_intervals(*run.trajectory);
        if (std::find(names.begin(), names.end(), "theta") != names.end()) {
            figure.marks = marks_of_events(*run.trajectory);
        }
    }
    return figure;
}

text::Expected<Figure> phase_figure(const RunData& run) {
    const bool record = run.system == nullptr && has(run, "velocity_over_omega0");
    if (run.system == nullptr && !record) {
        return text::Error{
            "the phase plane needs omega0, which a run that was read from a .csv file no longer has; use run:plot{ x = "
            "\"theta\", y = \"velocity\" }"};
    }
    auto figure = column_figure(run, "theta", {record ? "velocity_over_omega0" : "velocity/omega0"});
    if (!figure) {
        return figure;
    }
    Figure plane = std::move(figure).value();
    plane.equal = true;
    plane.circles = true;
    const Curve& motion = plane.curves.front();
    if (const std::size_t rows = motion.size(); rows > 0) {
        plane.marks = {{motion.x.values[0], motion.y.values[0], MarkKind::start},
                       {motion.x.values[rows - 1], motion.y.values[rows - 1], MarkKind::end}};
    }
    if (run.system != nullptr && run.system->has_linear_spring() && run.system->dead_zone() > 0) {
        const auto [lowest, highest] = run.system->resting_places();
        plane.dead_zone = Interval{lowest, highest};
    }
    return plane;
}

}  // namespace dinal::plots
