// A number to within a margin. Catch's Approx(x).margin(m) would forgive 1.2e-5 of x as well, whatever m is.
#pragma once

#include "support/catch.hpp"

namespace dinal {

inline Approx within(double x, double margin) {
    return Approx(x).epsilon(0).margin(margin);
}

}  // namespace dinal
