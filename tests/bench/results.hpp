// The measurements by group and item, from which the table and the bars are made.
#pragma once

#include <benchmark/benchmark.h>

#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bench {

struct Item {
    std::string group, name;
    std::vector<double> seconds;                  ///< of one iteration, one for each repetition
    double error = -1;                            ///< max |u - truth| in units of Mc/k; negative: not computed
    double count = 0;                             ///< number of units named by `per` in one iteration
    std::string per;                              ///< "step", "row", "call"; empty: the whole only
    std::string unit;                             ///< of `most`: of a time, or "x" times `against`; or empty
    double most = 0;                              ///< the bar of one unit
    std::pair<std::string, std::string> against;  ///< group and name of another item

    [[nodiscard]] double median() const;
};

class Results {
public:
    Item& of(const std::string& group, const std::string& name);
    [[nodiscard]] const Item* find(std::string_view group, std::string_view name) const;
    [[nodiscard]] const std::deque<Item>& items() const { return items_; }

private:
    std::deque<Item> items_;  // whose elements stay where they are
};

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

}  // namespace bench
