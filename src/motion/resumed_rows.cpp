#include "motion/resumed_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dinal::motion {

text::Expected<Grid> grid_of_both(const Run& so_far, double t_end, const Grid& rows, std::size_t columns,
                                  const Limits& limits) {
    if (!(t_end > so_far.t_stop)) {
        return text::Error{
            .sentence = fmt::format("t_end = {} must be after t = {}, where the run ended", t_end, so_far.t_stop),
            .option = "t_end"};
    }
    const Window all{so_far.t_start, t_end};
    if (auto wrong = all.complaint()) return *wrong;
    auto grid = rows.within(all);
    if (!grid) return grid.error();
    if (auto wrong = wrong_rows(*grid, columns, limits)) return *wrong;
    return grid;
}

RowsToCome rows_to_come(const Run& so_far, const Grid& grid) {
    // The last row of the first part is dropped if it existed only because of the old t_end.
    RowsToCome rows{std::min(static_cast<std::size_t>(so_far.size()), grid.count()), {}};
    if (rows.kept > 0 && so_far.rows(static_cast<Eigen::Index>(rows.kept) - 1, 0) != grid.time(rows.kept - 1)) {
        --rows.kept;
    }
    rows.times.reserve(grid.count() - rows.kept);
    for (std::size_t i = rows.kept; i < grid.count(); ++i) {
        // The old t_end may be a requested row and differ from it by rounding.
        const double t = grid.time(i), stop = so_far.t_stop;
        if (t >= stop || std::fabs(t - stop) <= 4e-16 * std::fabs(stop)) rows.times.push_back(std::max(t, stop));
    }
    return rows;
}

}  // namespace dinal::motion
