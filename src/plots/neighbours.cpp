#include "plots/neighbours.hpp"

#include <algorithm>

namespace dinal::plots {
namespace {

using Pair = std::pair<std::size_t, std::size_t>;

/// Rates a body as the first of the row: 2 if it is an end that is never second in a link, 1 if it is an end.
int merit(std::size_t body, std::span<const Pair> links) {
    const auto named =
        std::ranges::count_if(links, [body](const Pair& link) { return link.first == body || link.second == body; });
    const bool driven = std::ranges::any_of(links, [body](const Pair& link) { return link.second == body; });
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
