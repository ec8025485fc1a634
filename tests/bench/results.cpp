#include "results.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bench {

double Item::median() const {
    std::vector<double> sorted = seconds;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t n = sorted.size();
    return n == 0 ? 0 : (sorted[(n - 1) / 2] + sorted[n / 2]) / 2;
}

Item& Results::of(const std::string& group, const std::string& name) {
    for (Item& item : items_) {
        if (item.group == group && item.name == name) {
            return item;
        }
    }
    items_.emplace_back();
    items_.back().group = group, items_.back().name = name;
    return items_.back();
}

const Item* Results::find(std::string_view group, std::string_view name) const {
    for (const Item& item : items_) {
        if (item.group == group && item.name == name && !item.seconds.empty()) {
            return &item;
        }
    }
    return nullptr;
}

bool Collector::ReportContext(const Context& context) {
    fmt::print(stderr, "{} cores, load {:.1f}\n", context.cpu_info.num_cpus,
               context.cpu_info.load_avg.empty() ? 0 : context.cpu_info.load_avg[0]);
    return true;
}

void Collector::ReportRuns(const std::vector<Run>& runs) {
    for (const Run& run : runs) {
        if (run.run_type != Run::RT_Iteration) {
            continue;
        }
        const std::string& full = run.run_name.function_name;
        const std::size_t slash = full.find('/');
        if (run.error_occurred) {
            fmt::print(stderr, "{}: {}\n", full, run.error_message);
            failed_ = true;
            continue;
        }
        // Processor time, because the machine is shared; what is not done by this thread is timed by the wall clock.
        const bool by_clock = !run.run_name.time_type.empty();
        const double total = by_clock ? run.real_accumulated_time : run.cpu_accumulated_time;
        results_.of(full.substr(0, slash), full.substr(slash + 1))
            .seconds.push_back(total / static_cast<double>(run.iterations));
    }
}

}  // namespace bench
