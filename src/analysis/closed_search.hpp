// Finds a place to which a map returns: by Newton's method, from a start or from successive returns that come near to
// themselves.
#pragma once

#include <optional>
#include <vector>

#include "analysis/map.hpp"

namespace dinal::analysis {

class ClosedSearch {
public:
    using Return = Map::Return;
    /// `maps` is increased by the number of returns computed; `longest` is the greatest number of returns after which a
    /// motion may close.
    ClosedSearch(Map& map, int& maps, int longest) : map_(map), maps_(maps), longest_(longest) {}

    /// Tries Newton's method from `from` for motions that close after `returns`. If `waits`, returns are computed when
    /// no Newton step helps, because each is closer in a contracting system.
    std::optional<Closed> at_once(const Return& from, int returns, bool waits);

    /// Makes returns until the motion closes; checks after each of `counts`.
    std::optional<Closed> follow(Return first, const std::vector<int>& counts);

    [[nodiscard]] const std::vector<Return>& seen() const { return seen_; }
    [[nodiscard]] std::optional<model::Outcome> failed() const { return failed_; }

private:
    /// A place, and its return.
    struct Try {
        Eigen::VectorXd x;
        std::optional<HeldMode> mode;
        Return back;
        Eigen::VectorXd off = {};
        double residual = 0;
        [[nodiscard]] bool keeps_mode() const { return back.mode == mode; }
    };

    std::optional<Closed> closes(double near);
    Closed shortest(Closed found);
    [[nodiscard]] bool approaches(const Eigen::VectorXd& x, std::size_t m) const;
    std::optional<Closed> itself(const Return& from, int m);
    std::optional<Closed> newton(const Return& from, int m, double farthest, bool waits);
    std::optional<Try> at(const Eigen::VectorXd& x, const std::optional<HeldMode>& mode, int m);
    /// Tries fractions of a Newton step; empty if none reduces the residual.
    std::optional<Try> nearer(const Try& now, const Eigen::VectorXd& step, int m);
    [[nodiscard]] bool is_within(double residual, double tolerance) const {
        return residual <= tolerance || residual <= map_.rounding();
    }

    Map& map_;
    int& maps_;
    int longest_;
    std::vector<Return> seen_;
    std::optional<model::Outcome> failed_;
};

}  // namespace dinal::analysis
