// The response to a sine near resonance, relative to the resonant motion.
#pragma once

#include <cmath>
#include <complex>

namespace dinal::motion::exact {

using Complex = std::complex<double>;

/// The product of finite numbers, without the checks of std::complex.
inline Complex times(Complex a, Complex b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
/// The imaginary part of a g + b u.
inline double imaginary(Complex a, Complex g, Complex b, Complex u) {
    return (a.real() * g.imag() + a.imag() * g.real()) + (b.real() * u.imag() + b.imag() * u.real());
}
/// An upper bound of |z|, at most 1.42 |z|.
inline double length_of(Complex z) {
    return std::fabs(z.real()) + std::fabs(z.imag());
}

/// Near resonance the response to exp(mu tau) is the divided difference (exp(mu tau) - exp(lambda tau)) / (mu -
/// lambda), which is tau exp(lambda tau) at resonance, rather than two large numbers that nearly cancel.
struct Resonance {
    Complex mu, from_root;                          ///< mu - lambda
    Complex growing, turning;                       ///< the curve is Im(growing g(tau) + turning exp(mu tau))
    Complex way_growing = 0, way_turning = 0;       ///< coefficients of the integral, if the curve is a velocity
    Complex slope_growing = 0, slope_turning = 0;   ///< coefficients of the derivative
    double fourth_growing = 0, fourth_turning = 0;  ///< bounds for the fourth derivative

    /// g(tau), given exp(lambda tau).
    [[nodiscard]] Complex difference(double tau, Complex root_turned) const {
        const Complex z = from_root * tau;
        const double size = length_of(z);
        if (size == 0) return tau * root_turned;
        if (size < 0.05) {
            // (exp(z) - 1)/z: the first omitted term is z^3/24, or z^9/10!.
            Complex series = 1;
            for (int n = size < 1e-6 ? 3 : 9; n >= 2; --n) series = 1.0 + times(series, z) / static_cast<double>(n);
            return tau * times(series, root_turned);
        }
        // exp(x + i y) - 1 without a difference of nearly equal numbers.
        const double half = std::sin(z.imag() / 2), grown = std::expm1(z.real());
        const Complex less_one{grown * std::cos(z.imag()) - 2 * half * half, (grown + 1) * std::sin(z.imag())};
        return times(root_turned, less_one) / from_root;
    }
};

}  // namespace dinal::motion::exact
