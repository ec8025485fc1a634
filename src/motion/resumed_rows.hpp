// The rows of a continued run: those that exist, and those still to be computed.
#pragma once

#include <vector>

#include "motion/simulate.hpp"

namespace dinal::motion {

/// All rows of a run continued to t_end. Fails as simulate() does.
text::Expected<Grid> grid_of_both(const Run& so_far, double t_end, const Grid& rows, std::size_t columns,
                                  const Limits& limits);

struct RowsToCome {
    std::size_t kept;  ///< rows of the first part that remain
    std::vector<double> times;
};
RowsToCome rows_to_come(const Run& so_far, const Grid& grid);

}  // namespace dinal::motion
