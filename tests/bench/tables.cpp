// The table and the bars, as they are printed.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "dinal_runs.hpp"
#include "results.hpp"

namespace bench {
namespace {

std::string time_text(double seconds) {
    const double ns = seconds * 1e9;
    return ns < 1e3   ? fmt::format("{:.3g} ns", ns)
           : ns < 1e6 ? fmt::format("{:.3g} us", ns / 1e3)
           : ns < 1e9 ? fmt::format("{:.3g} ms", ns / 1e6)
                      : fmt::format("{:.3g} s", ns / 1e9);
}

std::string describe(const Workload& work) {
    return fmt::format("{}: zeta = {}, gamma = {}, M* = {}, start {:.4g}, {:.4g}, {} T0", work.name, work.zeta,
                       work.friction_ratio, work.driven ? "sin 2 pi t" : "0", work.u0, work.v0, work.length);
}

std::string heading(const std::string& group) {
    for (const Workload& work : workloads) {
        if (work.name == group) {
            return describe(work);
        }
    }
    return group;
}

double median(const Results& results, std::string_view group, std::string_view name) {
    const Item* item = results.find(group, name);
    return item == nullptr ? 0 : item->median();
}

struct Place {
    std::string_view group, name;
};

/// A number of some items, which says so where these were filtered away.
template <class Value>
void bar(const Results& results, std::string_view what, double most, std::string_view unit,
         std::initializer_list<Place> items, Value value) {
    const bool measured = std::all_of(
        items.begin(), items.end(), [&](const Place& item) { return results.find(item.group, item.name) != nullptr; });
    if (!measured) {
        fmt::print("{:<66}not measured\n", what);
        return;
    }
    const double found = value();
    fmt::print("{:<66}{:>8.3g} {:<3}{:>8.3g}   {}\n", what, found, unit, most, found <= most ? "met" : "NOT MET");
}

/// A time in units of which a second has so many.
struct TimeBar {
    std::string what;
    double most;
    std::string_view unit;
    double units;
    Place item;
};

/// A time against another one.
struct RatioBar {
    std::string what;
    double most;
    Place item, against;
};

Place arcs_on(std::string_view work) {
    return {work, arcs_peer.name};
}

double time_of(const Results& results, const Place& item) {
    return median(results, item.group, item.name);
}

void print(const Results& results, const std::vector<TimeBar>& bars) {
    for (const TimeBar& b : bars) {
        bar(results, b.what, b.most, b.unit, {b.item}, [&] { return time_of(results, b.item) * b.units; });
    }
}

void print(const Results& results, const std::vector<RatioBar>& bars) {
    for (const RatioBar& b : bars) {
        bar(results, b.what, b.most, "x", {b.item, b.against},
            [&] { return time_of(results, b.item) / time_of(results, b.against); });
    }
}

}  // namespace

void print_table(const Results& results) {
    fmt::print("{:<44}{:>12}{:>12}{:>14}{:>10}{:>10}\n", "item", "time", "per step", "x hand-inl.", "x arcs", "error");
    std::string group;
    for (const Item& item : results.items()) {
        if (item.seconds.empty()) {
            continue;
        }
        if (item.group != group) {
            group = item.group;
            fmt::print("{}\n", heading(group));
        }
        const double reference = median(results, group, baseline);
        const double arcs = median(results, group, arcs_peer.name);
        std::string line = fmt::format("  {:<42}{:>12}{:>12}{:>14}{:>10}{:>10}", item.name, time_text(item.median()),
                                       item.per.empty() ? "" : time_text(item.median() / item.count),
                                       reference == 0 ? "" : fmt::format("{:.3g}", item.median() / reference),
                                       arcs == 0 ? "" : fmt::format("{:.3g}", item.median() / arcs),
                                       item.error < 0 ? "" : fmt::format("{:.1e}", item.error));
        fmt::print("{}\n", line.erase(line.find_last_not_of(' ') + 1));
    }
}

/// Against closed forms written by hand for this one load: the yardstick of honesty.
static void print_arcs_bars(const Results& results) {
    struct Bar {
        const Peer& peer;
        std::string_view work;
        double time, error;
    };
    for (const Bar& b : {Bar{dinal_exact, "W1", 0.7, 1e-11},
                         {dinal_exact, "W2", 0.7, 1e-12},
                         {dinal_exact, "W3", 0.7, 1e-12},
                         {dinal_exact, "W4", 0.7, 1e-12},
                         {dinal_spectral, "W3", 2, 1e-11},
                         {dinal_spectral, "W4", 2, 1e-11}}) {
        const std::string name = fmt::format("{}: {}, ", b.peer.name, b.work);
        const Place item{b.work, b.peer.name};
        print(results, {RatioBar{name + "time against closed-form arcs by hand", b.time, item, arcs_on(b.work)}});
        bar(results, name + "error", b.error, "", {item}, [&] { return results.find(b.work, b.peer.name)->error; });
    }
}

static void print_systems_bars(const Results& results) {
    for (const LuaRow& row : lua_rows()) {
        bar(results, fmt::format("{}: a {}", row.name, row.per), row.most,
            row.figure == Figure::microseconds ? "us"
            : row.figure == Figure::seconds    ? "s"
                                               : "",
            {{systems_group, row.name}}, [&] {
                const Item& item = *results.find(systems_group, row.name);
                const double all = row.figure == Figure::calls          ? item.calls
                                   : row.figure == Figure::microseconds ? item.median() * 1e6
                                                                        : item.median();
                return all / item.count;
            });
    }
}

void print_bars(const Results& results) {
    fmt::print("\n{:<66}{:>8} {:<3}{:>8}\n", "bar", "measured", "", "at most");
    print_arcs_bars(results);
    const Place spectral_in_lua{lua_group, "spectral on W3, M in Lua"}, rk4_in_lua{lua_group, "rk4 on W3, M in Lua"};
    const Place bare{lua_group, "the same number of bare calls"};
    const Place one_worker{analysis_group, sweep_one_worker};
    const auto harmonics = [](const std::string& n) { return std::string(harmonics_item) + n; };
    const std::string ten = harmonics("10"), hundred = harmonics("100"), thousand = harmonics("1000");
    print(results, std::vector<TimeBar>{
                       {"dinal exact: a sample of a record", 20, "ns", 1e3, {closed_forms_group, samples_item}},
                       {"dinal exact: a period of 10 harmonics", 30, "us", 1e4, {closed_forms_group, ten}},
                       {"dinal exact: a period of 100 harmonics", 300, "us", 1e4, {closed_forms_group, hundred}},
                       {"dinal exact: a period of 1000 harmonics", 10000, "us", 5e4, {closed_forms_group, thousand}},
                       {"steady motion, native: a point", 5, "us", 1e6 / 40000, {analysis_group, steady_native}},
                       {"steady motion, sweep in Lua: a point", 25, "us", 1e6 / 40000, one_worker},
                       {"a sweep: setting it up", 5, "ms", 1e3, {analysis_group, sweep_of_nothing}},
                       {"response, 300 points", 5, "ms", 1e3, {analysis_group, response_300}},
                       {"identify, free decay of 1000 samples", 10, "ms", 1e3, {analysis_group, identify_1000}},
                   });
    print(results,
          std::vector<RatioBar>{
              {"spectral with a Lua function: W3, time against arcs by hand", 3.5, spectral_in_lua, arcs_on("W3")},
              {"sweep: time with two workers against one", 1 / 1.8, {analysis_group, sweep_two_workers}, one_worker},
              {"rk4 with a Lua function: time against the bare calls", 1.3, rk4_in_lua, bare},
          });
    for (const Peer* peer : {&dinal_rk4, &dinal_1989}) {
        for (const auto& [work, most] : {std::pair{"W1", 0.2}, {"W3", 1.}, {"W4", 1.}}) {
            print(results, {RatioBar{fmt::format("{}: {}, time against the hand-inlined RK4", peer->name, work),
                                     most,
                                     {work, peer->name},
                                     {work, baseline}}});
        }
    }
    print_systems_bars(results);
    const LuaCalls& calls = results.lua_calls;
    bar(results, "spectral with a Lua function: W3, calls of M a period", 70, "", {bare},
        [&] { return calls.spectral_on_w3 / 1000; });
    // The first value belongs to no step; what locating an event takes is told on a line of its own.
    bar(results, "rk4 with a Lua function: calls of M a step without an event", 2, "", {bare},
        [&] { return (calls.without_events - 1) / 1e6; });
    if (calls.events_on_w3 > 0) {
        fmt::print("    (W3: {:.0f} calls in 1e6 steps, {:.1f} more for each of its {:.0f} events)\n", calls.on_w3,
                   (calls.on_w3 - calls.without_events) / calls.events_on_w3, calls.events_on_w3);
    }
    const Place with_rows{rows_group, "W1 with a row a step"}, without_rows{rows_group, "W1 without rows"};
    bar(results, "six columns kept, memory warm: a row on top of its step", 5, "ns", {with_rows, without_rows},
        [&] { return (time_of(results, with_rows) - time_of(results, without_rows)) / 1e7 * 1e9; });
    std::vector<TimeBar> others;
    for (const auto& [item, most] : {std::pair{csv_in_memory, 300.}, {csv_on_disk, 300.}, {csv_read, 250.}}) {
        others.push_back({fmt::format("{}: a row", item), most, "ns", 1e3, {files_group, item}});
    }
    for (const std::string_view plot : {terminal_response, terminal_phase}) {
        others.push_back({fmt::format("plot of 1e6 rows, {}", plot), 50, "ms", 1e3, {plots_group, plot}});
    }
    for (const std::string_view plot : {svg_response, svg_phase}) {
        others.push_back({fmt::format("plot of 1e6 rows, {}", plot), 1, "s", 1, {plots_group, plot}});
    }
    others.push_back({std::string(report_figures), 30, "s", 1, {plots_group, report_figures}});
    for (const std::string_view start : {"to the end of -e \"\"", "to the end of an empty script", "to the prompt"}) {
        others.push_back({fmt::format("start {}", start), 20, "ms", 1e3, {start_group, start}});
    }
    print(results, others);
}

}  // namespace bench
