// The product of finite complex numbers.
#pragma once

#include <complex>

namespace dinal::motion {

/// Returns the product without the checks of std::complex for infinities.
inline std::complex<double> product(std::complex<double> a, std::complex<double> b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace dinal::motion
