// Three columns of data as a map: one in shades over the grid of the two others.
#pragma once

#include <array>
#include <string>

#include "lua/options.hpp"
#include "plots/figure.hpp"

namespace dinal::api {

/// Of x, y and z, with zlim and contours as the options say. Fails when x and y form no grid.
plots::Figure figure_of_map(const lua::Options& options, const std::array<std::string, 3>& names,
                            const std::array<plots::Numbers, 3>& columns);

}  // namespace dinal::api
