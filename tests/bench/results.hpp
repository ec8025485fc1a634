// The measurements by group and item, from which the table and the bars are made.
#pragma once

#include <benchmark/benchmark.h>

#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace bench {

struct Item {
    std::string group, name;
    std::vector<double> seconds;  ///< of one iteration, one for each repetition
    double error = -1;            ///< max |u - truth| in units of Mc/k; negative: not computed
    double count = 0;             ///< number of units named by `per` in one iteration
    std::string per;              ///< "step", "row", "call"; empty: the whole only
    double calls = 0;             ///< calls of a Lua function M in one iteration, if counted

    [[nodiscard]] double median() const;
};

/// How often rk4 calls a Lua function M in 1e6 steps.
struct LuaCalls {
    double on_w3 = 0;
    double events_on_w3 = 0;
    double without_events = 0;
    double spectral_on_w3 = 0;
};

class Results {
public:
    Item& of(const std::string& group, const std::string& name);
    [[nodiscard]] const Item* find(std::string_view group, std::string_view name) const;
    [[nodiscard]] const std::deque<Item>& items() const { return items_; }

    LuaCalls lua_calls;

private:
    std::deque<Item> items_;  // whose elements stay where they are
};

/// What a bar is of: a time for one of what an item counts, or calls of M.
enum class Figure { microseconds, seconds, calls };

/// A benchmark that is a Lua script, with its bar for one of what `per` names.
struct LuaRow {
    std::string_view name, per;
    double most;
    Figure figure;
    const char* script;
};
const std::vector<LuaRow>& lua_rows();

/// Collects the repetitions and shows how far it is; prints nothing else.
class Collector : public benchmark::BenchmarkReporter {
public:
    explicit Collector(Results& results) : results_(results) {}
    bool ReportContext(const Context& context) override;
    void ReportRuns(const std::vector<Run>& runs) override;
    [[nodiscard]] bool failed() const { return failed_; }

private:
    Results& results_;
    bool failed_ = false;
};

/// The one table: item, time, ratio to the hand-inlined RK4, error.
void print_table(const Results& results);
/// The bars this version has to reach, each met or not.
void print_bars(const Results& results);

// Names that the table's bars refer to.
inline constexpr std::string_view closed_forms_group = "closed forms", samples_item = "exact, 1e6 samples, 1e4 T0",
                                  harmonics_item = "exact, harmonics of amplitude 1/i^2: ";
inline constexpr std::string_view analysis_group = "questions", steady_native = "steady, 200 x 200 points, native",
                                  sweep_one_worker = "steady, 200 x 200 points, sweep in Lua",
                                  sweep_two_workers = "the same, two workers",
                                  sweep_of_nothing = "a sweep of one point with nothing to do",
                                  response_300 = "response, 300 points",
                                  identify_1000 = "identify, free decay, 1000 samples";
inline constexpr std::string_view rows_group = "rows", files_group = "files", lua_group = "Lua", plots_group = "plots",
                                  start_group = "start", systems_group = "Lua, more in it";
inline constexpr std::string_view csv_in_memory = "CSV, 1e6 rows of W4, file in memory",
                                  csv_on_disk = "CSV, 1e6 rows of W4, file on the disk",
                                  csv_read = "CSV, 1e6 rows of W4, file in memory read";
inline constexpr std::string_view terminal_response = "terminal, W4 over time",
                                  terminal_phase = "terminal, phase plane of W4", svg_response = "SVG, W4 over time",
                                  svg_phase = "SVG, phase plane of W4", report_figures = "all figures of the report";

}  // namespace bench
