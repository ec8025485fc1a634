#include "analysis/forced_search.hpp"

#include <algorithm>
#include <cmath>

#include "algebra/decompositions.hpp"

namespace dinal::analysis {

std::optional<Map::Return> ForcedSearch::search(const SteadyQuestion& question, bool at_once) {
    auto now = begin();
    if (!now) return {};
    const int periods = std::max(1, question.periods);
    if (at_once) {
        const auto found = ClosedSearch(map(), facts_.maps, periods).at_once(*now, periods, true);
        if (found && complete(*found, false)) return {};
    }
    std::vector<double> ranges{range()};  // ranges of single periods
    std::vector<double> sizes;            // ranges of the first batch of returns and of both halves of the second
    constexpr int longest = 32;
    for (const auto& counts : {std::vector<int>{3, 8, 24}, std::vector<int>{40, 120, 320}}) {
        ClosedSearch search(map(), facts_.maps, question.periods > 0 ? periods : longest);
        const auto found = search.follow(*now, counts);
        if (found && complete(*found, false)) return {};
        const auto& seen = search.seen();
        if (search.failed()) {
            note_failure(*search.failed());
            return {};
        }
        facts_.change = search.nearest_repeat();
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
        if (sizes[2] > faster * sizes[1]) facts_.growth = model::never;
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

void ForcedSearch::note_failure(model::Outcome outcome) {
    facts_.outcome = outcome;
    if (outcome != model::Outcome::state_not_finite) return;
    facts_.status = SteadyStatus::grows;
    facts_.growth = model::never;
}

using Eigen::VectorXd;

namespace {

constexpr double to_rounding = 1e-11;  // limit of residuals that no step reduces, due to differences

/// The shortest Newton step; it has no component in the null space of I - D.
VectorXd newton_step(const Eigen::MatrixXd& D, const VectorXd& off) {
    const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(off.size(), off.size()) - D;
    if (off.size() == 2) {
        const double determinant = left(0, 0) * left(1, 1) - left(0, 1) * left(1, 0);
        if (std::fabs(determinant) > 1e-6 * left.squaredNorm()) {
            const Eigen::Vector2d step(left(1, 1) * off[0] - left(0, 1) * off[1],
                                       left(0, 0) * off[1] - left(1, 0) * off[0]);
            return step / determinant;
        }
    }
    return algebra::solve_by_singular_values(left, off, 1e-9);
}

}  // namespace

double size_of_step(const VectorXd& step) {
    return step.size() == 0 ? 0 : step.cwiseAbs().maxCoeff();
}

std::optional<Closed> ClosedSearch::at_once(const Return& from, int returns, bool waits) {
    constexpr double any_distance = 1e6;
    return newton(from, returns, any_distance, waits);
}

std::optional<Closed> ClosedSearch::follow(Return first, const std::vector<int>& counts) {
    seen_ = {std::move(first)};
    for (const int until : counts) {
        while (static_cast<int>(seen_.size()) <= until) {
            Return next = map_(seen_.back().to, seen_.back().mode, 1);
            ++maps_;
            if (!next.finished) {
                failed_ = next.outcome;
                return {};
            }
            seen_.push_back(std::move(next));
        }
        for (const double near : {1e-5, 5e-2}) {
            if (auto found = find_closed(near)) return found;
        }
    }
    return {};
}

std::optional<Closed> ClosedSearch::find_closed(double near) {
    const std::size_t last = seen_.size() - 1;
    int tries = 0;  // chaotic motions come near to themselves repeatedly
    for (std::size_t m = 1; tries < 4 && m <= static_cast<std::size_t>(longest_) && 2 * m <= last; ++m) {
        if (seen_[last].mode != seen_[last - m].mode) continue;
        const double off = size_of_step(seen_[last].to - seen_[last - m].to);
        if (!is_within(off, near)) continue;
        ++tries;
        constexpr double short_distance = 1;
        auto found = newton(seen_[last], static_cast<int>(m), short_distance, false);
        if (found && approaches(found->x, m)) return shortest(*found);
        if (found || !is_within(off, to_rounding)) continue;
        return itself(seen_[last], static_cast<int>(m));
    }
    return {};
}

std::optional<double> ClosedSearch::nearest_repeat() const {
    constexpr std::size_t in_a_row = 32;  // an irregular motion comes near to itself once, not for so long
    constexpr double nearly = 1e-2;
    double nearest = model::never;
    for (std::size_t m = 1; m <= static_cast<std::size_t>(longest_) && m + in_a_row < seen_.size(); ++m) {
        double farthest = 0;
        for (std::size_t i = seen_.size() - in_a_row; i < seen_.size(); ++i) {
            farthest = std::max(farthest, size_of_step(seen_[i].to - seen_[i - m].to));
        }
        nearest = std::min(nearest, farthest);
    }
    return nearest < nearly ? std::optional(nearest) : std::nullopt;
}

/// The motion with the smallest number of returns; slow decay can make a multiple look closer.
Closed ClosedSearch::shortest(Closed found) {
    for (int m = 1; m < found.returns; ++m) {
        if (found.returns % m != 0) continue;
        const Return back = map_(found.x, found.mode, m);
        maps_ += m;
        constexpr double same_point = 1e-10;
        const double off = back.finished ? size_of_step(back.to - found.x) : 1;
        if (!back.finished || back.mode != found.mode || !is_within(off, std::max(same_point, 10 * found.residual))) {
            continue;
        }
        found.returns = m, found.period = back.time, found.residual = off;
        break;
    }
    return found;
}

/// Returns whether the run keeps approaching x and will soon be there.
bool ClosedSearch::approaches(const VectorXd& x, std::size_t m) const {
    const std::size_t last = seen_.size() - 1;
    const double now = size_of_step(seen_[last].to - x), before = size_of_step(seen_[last - m].to - x);
    constexpr double arrived = 1e-7, close = 0.3;
    return is_within(now, arrived) || (now <= close && now < 0.98 * before);
}

/// Accepts a return that is exact to rounding, where differences are useless.
std::optional<Closed> ClosedSearch::itself(const Return& from, int m) {
    const Return back = map_(from.to, from.mode, m);
    maps_ += m;
    if (!back.finished) return {};
    return Closed{from.to, from.mode, m, back.time, size_of_step(back.to - from.to)};
}

std::optional<ClosedSearch::Try> ClosedSearch::at(const VectorXd& x, const std::optional<HeldMode>& mode, int m) {
    Try result{.x = x, .mode = mode, .back = map_(x, mode, m)};
    maps_ += m;
    if (!result.back.finished) return {};
    result.off = result.back.to - x;
    result.residual = size_of_step(result.off);
    return result;
}

std::optional<ClosedSearch::Try> ClosedSearch::nearer(const Try& now, const VectorXd& step, int m) {
    for (const double part : {1.0, 0.25, 0.0625}) {
        auto next = at(now.x + part * step, now.mode, m);
        if (next && next->keeps_mode() && next->residual <= (1 - part / 2) * now.residual) return next;
        if (now.residual <= to_rounding) break;
    }
    return {};
}

std::optional<Closed> ClosedSearch::newton(const Return& from, int m, double farthest, bool waits) {
    constexpr double exactly = 2e-15;  // smaller residuals and steps are rounding,
    constexpr double nothing = 1e-14;
    constexpr double enough = 1e-9;  // acceptable if rounding prevents smaller ones
    auto now = at(from.to, from.mode, m);
    std::optional<Eigen::MatrixXd> D;
    for (int i = 0, most = waits ? 60 : 14; now && i < most && now->residual > exactly; ++i) {
        const bool kept = !now->back.derivative && D;  // whether the derivative is that of an earlier place
        if (now->back.derivative) {
            D = now->back.derivative;
        } else if (!D && now->keeps_mode()) {
            const auto found = map_.derivative(now->x, now->mode, m, 2);
            maps_ += 2 * m * static_cast<int>(now->x.size());
            if (found) D = found->by_place;
        }
        std::optional<Try> next;
        if (D && now->keeps_mode()) {
            const VectorXd step = newton_step(*D, now->off);
            const double length = size_of_step(step);
            if (length <= nothing) break;
            if (step.allFinite()) next = nearer(*now, step * std::min(1.0, farthest / length), m);
        }
        if (!next && is_within(now->residual, to_rounding)) break;
        if (!next && !kept && !waits) break;
        if (!next && !kept) next = at(now->back.to, now->back.mode, m);
        if (!next || next->residual > 0.1 * now->residual) D.reset();
        if (next || !kept) now = std::move(next);
    }
    if (!now || !now->keeps_mode() || !is_within(now->residual, enough)) return {};
    return Closed{now->x, now->mode, m, now->back.time, now->residual};
}

}  // namespace dinal::analysis
