// The table and the bars, as they are printed.
#include <fmt/format.h>

#include <string>

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

void bar(std::string_view what, double value, double limit, std::string_view unit) {
    fmt::print("{:<66}{:>8.3g} {:<3}{:>8.3g}   {}\n", what, value, unit, limit, value <= limit ? "met" : "NOT MET");
}

// A bar whose items were filtered away says so instead of a number.
template <class Value>
void bar_of(const Results& results, std::initializer_list<std::pair<std::string_view, std::string_view>> items,
            std::string_view what, double limit, std::string_view unit, Value value) {
    for (const auto& [group, name] : items) {
        if (results.find(group, name) == nullptr) {
            fmt::print("{:<66}not measured\n", what);
            return;
        }
    }
    bar(what, value(), limit, unit);
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
        bar_of(results, {{b.work, b.peer.name}, {b.work, arcs_peer.name}},
               fmt::format("{}: {}, time against closed-form arcs by hand", b.peer.name, b.work), b.time, "x",
               [&] { return median(results, b.work, b.peer.name) / median(results, b.work, arcs_peer.name); });
        bar_of(results, {{b.work, b.peer.name}}, fmt::format("{}: {}, error", b.peer.name, b.work), b.error, "",
               [&] { return results.find(b.work, b.peer.name)->error; });
    }
    bar_of(results, {{closed_forms_group, samples_item}}, "dinal exact: a sample of a record", 20, "ns",
           [&] { return median(results, closed_forms_group, samples_item) / 1e6 * 1e9; });
    for (const auto& [harmonics, most] : {std::pair{10, 30.}, {100, 300.}, {1000, 10000.}}) {
        const std::string name = std::string(harmonics_item) + std::to_string(harmonics);
        bar_of(results, {{closed_forms_group, name}}, fmt::format("dinal exact: a period of {} harmonics", harmonics),
               most, "us",
               [&] { return median(results, closed_forms_group, name) / (harmonics == 1000 ? 20 : 100) * 1e6; });
    }
}

static void print_spectral_bars(const Results& results) {
    const std::string_view in_lua = "spectral on W3, M in Lua", bare = "the same number of bare calls";
    bar_of(results, {{lua_group, in_lua}, {"W3", arcs_peer.name}},
           "spectral with a Lua function: W3, time against arcs by hand", 3.5, "x",
           [&] { return median(results, lua_group, in_lua) / median(results, "W3", arcs_peer.name); });
    bar_of(results, {{lua_group, bare}}, "spectral with a Lua function: W3, calls of M a period", 70, "",
           [&] { return results.lua_calls.spectral_on_w3 / 1000; });
}

static void print_question_bars(const Results& results) {
    struct Bar {
        std::string_view item, what;
        double most;
        std::string_view unit;
        double factor;
    };
    for (const Bar& b : {Bar{steady_native, "steady motion, native: a point", 5, "us", 1e6 / 40000},
                         {sweep_one_worker, "steady motion, sweep in Lua: a point", 25, "us", 1e6 / 40000},
                         {sweep_of_nothing, "a sweep: setting it up", 5, "ms", 1e3},
                         {response_300, "response, 300 points", 5, "ms", 1e3},
                         {identify_1000, "identify, free decay of 1000 samples", 10, "ms", 1e3}}) {
        bar_of(results, {{analysis_group, b.item}}, b.what, b.most, b.unit,
               [&] { return median(results, analysis_group, b.item) * b.factor; });
    }
    bar_of(results, {{analysis_group, sweep_one_worker}, {analysis_group, sweep_two_workers}},
           "sweep: time with two workers against one", 1 / 1.8, "x", [&] {
               return median(results, analysis_group, sweep_two_workers) /
                      median(results, analysis_group, sweep_one_worker);
           });
}

static void print_systems_bars(const Results& results) {
    for (const LuaRow& row : lua_rows()) {
        bar_of(results, {{systems_group, row.name}}, fmt::format("{}: a {}", row.name, row.per), row.most,
               row.figure == Figure::microseconds ? "us"
               : row.figure == Figure::seconds    ? "s"
                                                  : "",
               [&] {
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
    print_spectral_bars(results);
    print_question_bars(results);
    print_systems_bars(results);
    for (const Peer* peer : {&dinal_rk4, &dinal_1989}) {
        bar_of(results, {{"W1", peer->name}, {"W1", baseline}},
               fmt::format("{}: W1, time against the hand-inlined RK4", peer->name), 0.2, "x",
               [&] { return median(results, "W1", peer->name) / median(results, "W1", baseline); });
        for (const std::string_view work : {"W3", "W4"}) {
            bar_of(results, {{work, peer->name}, {work, baseline}}, fmt::format("{}: {}, the same", peer->name, work),
                   1, "x", [&] { return median(results, work, peer->name) / median(results, work, baseline); });
        }
    }
    const std::string_view in_lua = "rk4 on W3, M in Lua", bare = "the same number of bare calls";
    const LuaCalls& calls = results.lua_calls;
    // The first value belongs to no step; what locating an event takes is told on a line of its own.
    bar_of(results, {{lua_group, bare}}, "rk4 with a Lua function: calls of M a step without an event", 2, "",
           [&] { return (calls.without_events - 1) / 1e6; });
    bar_of(results, {{lua_group, in_lua}, {lua_group, bare}}, "rk4 with a Lua function: time against the bare calls",
           1.3, "x", [&] { return median(results, lua_group, in_lua) / median(results, lua_group, bare); });
    if (calls.events_on_w3 > 0) {
        fmt::print("    (W3: {:.0f} calls in 1e6 steps, {:.1f} more for each of its {:.0f} events)\n", calls.on_w3,
                   (calls.on_w3 - calls.without_events) / calls.events_on_w3, calls.events_on_w3);
    }
    bar_of(results, {{rows_group, "W1 with a row a step"}, {rows_group, "W1 without rows"}},
           "six columns kept, memory warm: a row on top of its step", 5, "ns", [&] {
               return (median(results, rows_group, "W1 with a row a step") -
                       median(results, rows_group, "W1 without rows")) /
                      1e7 * 1e9;
           });
    for (const auto& [item, most] : {std::pair{csv_in_memory, 300.}, {csv_on_disk, 300.}, {csv_read, 250.}}) {
        const std::string_view csv = item;
        bar_of(results, {{files_group, csv}}, fmt::format("{}: a row", csv), most, "ns",
               [&, csv] { return median(results, files_group, csv) / 1e6 * 1e9; });
    }
    for (const std::string_view plot : {terminal_response, terminal_phase}) {
        bar_of(results, {{plots_group, plot}}, fmt::format("plot of 1e6 rows, {}", plot), 50, "ms",
               [&] { return median(results, plots_group, plot) * 1e3; });
    }
    for (const std::string_view plot : {svg_response, svg_phase}) {
        bar_of(results, {{plots_group, plot}}, fmt::format("plot of 1e6 rows, {}", plot), 1, "s",
               [&] { return median(results, plots_group, plot); });
    }
    bar_of(results, {{plots_group, report_figures}}, report_figures, 30, "s",
           [&] { return median(results, plots_group, report_figures); });
    for (const std::string_view start : {"to the end of -e \"\"", "to the end of an empty script", "to the prompt"}) {
        bar_of(results, {{start_group, start}}, fmt::format("start {}", start), 20, "ms",
               [&] { return median(results, start_group, start) * 1e3; });
    }
}

}  // namespace bench
