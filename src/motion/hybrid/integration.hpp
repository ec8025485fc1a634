// The integrals of polynomials through values at the nodes of a piece, as a matrix.
#pragma once

#include <Eigen/Dense>

#include "motion/spectral/chebyshev.hpp"

namespace dinal::motion::hybrid {

/// Row i: the integral from -1 to node i of the polynomial through values at the nodes.
using Integration = Eigen::Matrix<double, spectral::chebyshev::points, spectral::chebyshev::points>;
const Integration& integration();

}  // namespace dinal::motion::hybrid
