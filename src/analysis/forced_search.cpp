#include "analysis/forced_search.hpp"

#include <algorithm>

namespace dinal::analysis {

std::optional<Map::Return> ForcedSearch::search(const SteadyQuestion& question, bool at_once) {
    auto now = begin();
    if (!now) return {};
    const int periods = std::max(1, question.periods);
    if (at_once) {
        const auto found = ClosedSearch(map(), facts_.maps, periods).at_once(*now, periods, true);
        if (found && complete(*found, false)) return {};
    }
    std::vector<double> ranges{range()};  // of single periods
    std::vector<double> sizes;            // of the first batch of returns and both halves of the second
    constexpr int longest = 32;
    for (const auto& counts : {std::vector<int>{3, 8, 24}, std::vector<int>{40, 120, 320}}) {
        ClosedSearch search(map(), facts_.maps, question.periods > 0 ? periods : longest);
        const auto found = search.follow(*now, counts);
        if (found && complete(*found, false)) return {};
        const auto& seen = search.seen();
        if (search.failed()) {
            note_failure(*search.failed(), seen);
            return {};
        }
        const std::size_t half = sizes.empty() ? seen.size() : seen.size() / 2;
        sizes.push_back(largest(seen, 0, half));
        if (half < seen.size()) {
            sizes.push_back(largest(seen, half, seen.size()));
            facts_.growth = growth_of(seen);
        }
        now = measured(seen.back());
        if (!now) return {};
        ranges.push_back(range());
    }
    // Beats have equal maxima in both halves; a creeping motion has equal ranges.
    const bool widens = ranges[2] > 1.3 * ranges[1] && ranges[1] > 1.1 * ranges[0];
    const bool grows = widens && sizes[2] > 1.15 * sizes[1] && sizes[1] > 1.1 * sizes[0];
    if (is_free() ? facts_.growth > 0 : grows && !is_bounded()) {
        facts_.status = SteadyStatus::grows;
        return {};
    }
    facts_.growth = 0;
    return now;
}

/// The growth over one of the last periods. For a free body it is 0 unless it has grown as fast before.
double ForcedSearch::growth_of(const std::vector<Map::Return>& seen) const {
    constexpr std::size_t span = 20;
    const std::size_t n = seen.size();
    const double growth = largest(seen, n - span, n) - largest(seen, n - 2 * span, n - span);
    const double end = size_at(seen[n - 1]), middle = size_at(seen[n / 2]), start = size_at(seen[0]);
    const bool steadily = middle > start && end - middle > 0.9 * (middle - start) && end - middle > 1e-3 * end;
    return is_free() && !steadily ? 0 : growth / static_cast<double>(span);
}

void ForcedSearch::look_beside(const Map::Return& last, int periods) {
    const int returns = std::max(1, periods);
    const auto found_from = [&](const Map::Return& from) {
        const auto found = ClosedSearch(map(), facts_.maps, returns).at_once(from, returns, true);
        return found && complete(*found, periods > 0);
    };
    if (found_from(last) || periods == 0) return;
    if (const auto first = begin()) found_from(*first);
}

double ForcedSearch::largest(const std::vector<Map::Return>& seen, std::size_t from, std::size_t until) const {
    double size = 0;
    for (std::size_t i = from; i < until; ++i) size = std::max(size, size_at(seen[i]));
    return size;
}

void ForcedSearch::note_failure(model::Outcome outcome, const std::vector<Map::Return>& seen) {
    facts_.outcome = outcome;
    if (outcome != model::Outcome::state_not_finite) return;
    facts_.status = SteadyStatus::grows;
    const std::size_t n = seen.size();
    if (n > 1) facts_.growth = size_at(seen[n - 1]) - size_at(seen[n - 2]);
}

}  // namespace dinal::analysis
