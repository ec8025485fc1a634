// The table and the bars, as they are printed.
#include <fmt/format.h>

#include <optional>
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

/// One line: what was found, and whether that is at most `most`; nothing is `found` of what was filtered away.
void bar(const std::string& what, std::optional<double> found, double most, std::string_view unit) {
    if (!found) {
        fmt::print("{:<66}not measured\n", what);
        return;
    }
    fmt::print("{:<66}{:>8.3g} {:<5}{:>8.3g}   {}\n", what, *found, unit, most, *found <= most ? "met" : "NOT MET");
}

/// The time of one item in those of another.
std::optional<double> ratio(const Item* item, const Item* against) {
    if (item == nullptr || against == nullptr) return {};
    return item->median() / against->median();
}

/// For one of what the item counts, in its unit.
std::optional<double> found_in(const Results& results, const Item& item) {
    const Item* measured = results.find(item.group, item.name);
    if (measured == nullptr) return {};
    if (item.unit == "x") return ratio(measured, results.find(item.against.first, item.against.second));
    const double units = item.unit == "ns" ? 1e9 : item.unit == "us" ? 1e6 : item.unit == "ms" ? 1e3 : 1;
    return item.median() / item.count * units;
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

void print_bars(const Results& results) {
    fmt::print("\n{:<66}{:>8} {:<5}{:>8}\n", "bar", "measured", "", "at most");
    struct Bar {
        const Peer& peer;
        std::string_view work;
        double time, error;
    };
    // Against closed forms written by hand for this one load: the yardstick of honesty.
    for (const Bar& b : {Bar{dinal_exact, "W1", 0.7, 1e-11},
                         {dinal_exact, "W2", 0.7, 1e-12},
                         {dinal_exact, "W3", 0.7, 1e-12},
                         {dinal_exact, "W4", 0.7, 1e-12},
                         {dinal_spectral, "W3", 2, 1e-11},
                         {dinal_spectral, "W4", 2, 1e-11}}) {
        const Item* item = results.find(b.work, b.peer.name);
        const std::string name = fmt::format("{}: {}, ", b.peer.name, b.work);
        bar(name + "time against closed-form arcs by hand", ratio(item, results.find(b.work, arcs_peer.name)), b.time,
            "x");
        bar(name + "error", item == nullptr ? std::optional<double>() : item->error, b.error, "");
    }
    for (const Peer* peer : {&dinal_rk4, &dinal_1989}) {
        for (const auto& [work, most] : {std::pair{"W1", 0.2}, {"W3", 1.}, {"W4", 1.}}) {
            bar(fmt::format("{}: {}, time against the hand-inlined RK4", peer->name, work),
                ratio(results.find(work, peer->name), results.find(work, baseline)), most, "x");
        }
    }
    for (const Item& item : results.items()) {
        if (item.most == 0) continue;
        const std::string one = item.unit == "x" ? ", against " + item.against.second : ": a " + item.per;
        bar(item.name + one, found_in(results, item), item.most, item.unit);
    }
}

}  // namespace bench
