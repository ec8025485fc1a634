// A motion that comes back to itself: found from the returns that it makes, by Newton's method where these lead near.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "algebra/decompositions.hpp"
#include "model/outcome.hpp"

namespace dinal::analysis {

inline double size_of_step(const Eigen::VectorXd& step) {
    return step.size() == 0 ? 0 : step.cwiseAbs().maxCoeff();
}

/// A motion that comes back after some returns.
template <class Mode>
struct Closed {
    Eigen::VectorXd x;
    Mode mode;
    int returns = 1;
    double period = 0, residual = 0;
};

/// Looks for it with a map that has a Return { to, time, finished, outcome, mode }, the call map(place, mode, returns)
/// and map.derivative(place, mode, returns, order).
template <class Map>
class ClosedSearch {
public:
    using Return = typename Map::Return;
    using Found = Closed<decltype(Return::mode)>;
    ClosedSearch(Map& map, int& maps, int longest) : map_(map), maps_(maps), longest_(longest) {}

    /// What one return after the other leads to.
    std::optional<Found> follow(Return first, const std::vector<int>& counts) {
        seen_ = {std::move(first)};
        for (const int until : counts) {
            while (static_cast<int>(seen_.size()) <= until) {
                Return next = map_(seen_.back().to, seen_.back().mode);
                ++maps_;
                if (!next.finished) {
                    failed_ = next.outcome;
                    return {};
                }
                seen_.push_back(std::move(next));
            }
            for (const double near : {1e-5, 5e-2}) {
                if (auto found = closes(near)) return found;
            }
        }
        return {};
    }

    [[nodiscard]] const std::vector<Return>& seen() const { return seen_; }
    [[nodiscard]] std::optional<model::Outcome> failed() const { return failed_; }

private:
    static constexpr double to_rounding = 1e-11;

    std::optional<Found> closes(double near) {
        const std::size_t last = seen_.size() - 1;
        int tries = 0;  // chaos comes near to itself again and again
        for (std::size_t m = 1; tries < 4 && m <= static_cast<std::size_t>(longest_) && 2 * m <= last; ++m) {
            if (seen_[last].mode != seen_[last - m].mode) continue;
            const double off = size_of_step(seen_[last].to - seen_[last - m].to);
            if (off > near) continue;
            ++tries;
            auto found = newton(seen_[last], static_cast<int>(m));
            if (found && approaches(found->x, m)) return shortest(*found);
            if (found || off > to_rounding) continue;
            return itself(seen_[last], static_cast<int>(m));
        }
        return {};
    }

    /// It may have come back before: what dies out slowly is nearer to itself after more returns.
    Found shortest(Found found) {
        for (int m = 1; m < found.returns; ++m) {
            if (found.returns % m != 0) continue;
            const Return back = map_(found.x, found.mode, m);
            maps_ += m;
            constexpr double there = 1e-10;
            const double off = back.finished ? size_of_step(back.to - found.x) : 1;
            if (!back.finished || back.mode != found.mode || off > std::max(there, 10 * found.residual)) continue;
            found.returns = m, found.period = back.time, found.residual = off;
            break;
        }
        return found;
    }

    /// The run comes nearer to it all the time, and is there soon.
    [[nodiscard]] bool approaches(const Eigen::VectorXd& x, std::size_t m) const {
        const std::size_t last = seen_.size() - 1;
        const double now = size_of_step(seen_[last].to - x), before = size_of_step(seen_[last - m].to - x);
        constexpr double there = 1e-7, close = 0.3;
        return now <= there || (now <= close && now < 0.98 * before);
    }

    /// It has come back to rounding, and differences do not tell more.
    std::optional<Found> itself(const Return& from, int m) {
        const Return back = map_(from.to, from.mode, m);
        maps_ += m;
        if (!back.finished) return {};
        return Found{from.to, from.mode, m, back.time, size_of_step(back.to - from.to)};
    }

    std::optional<Found> newton(const Return& from, int m) {
        Eigen::VectorXd x = from.to;
        std::optional<Found> best;
        std::optional<Eigen::MatrixXd> D;
        constexpr int most = 14;
        for (int i = 0; i < most; ++i) {
            const Return there = map_(x, from.mode, m);
            maps_ += m;
            if (!there.finished || there.mode != from.mode) return good(best);
            const Eigen::VectorXd off = there.to - x;
            const double residual = size_of_step(off);
            const bool slower = best && residual > 0.1 * best->residual;
            if (best && residual >= best->residual && best->residual <= to_rounding) return best;
            if (!best || residual < best->residual) best = Found{x, from.mode, m, there.time, residual};
            if (residual <= 4 * std::numeric_limits<double>::epsilon()) return best;
            if (!D || slower) {
                D = map_.derivative(x, from.mode, m, 2);
                maps_ += 2 * m * static_cast<int>(x.size());
                if (!D) return good(best);
            }
            const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(x.size(), x.size()) - *D;
            const Eigen::VectorXd step = algebra::solve_shortest(left, off);
            if (!step.allFinite()) return good(best);
            constexpr double farthest = 1;
            x += step * std::min(1.0, farthest / std::max(size_of_step(step), 1e-300));
        }
        return good(best);
    }

    static std::optional<Found> good(const std::optional<Found>& best) {
        constexpr double enough = 1e-9;
        return best && best->residual <= enough ? best : std::nullopt;
    }

    Map& map_;
    int& maps_;
    int longest_;
    std::vector<Return> seen_;
    std::optional<model::Outcome> failed_;
};

}  // namespace dinal::analysis
