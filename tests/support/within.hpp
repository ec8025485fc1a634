// Comparison within an absolute margin. Catch's Approx(x).margin(m) would also allow 1.2e-5 of x, whatever m is.
#pragma once

#include "support/catch.hpp"

namespace dinal {

inline Approx within(double x, double margin) {
    return Approx(x).epsilon(0).margin(margin);
}

}  // namespace dinal
