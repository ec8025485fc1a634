// The spectrum against the sum that defines it, and the spectrum of a sine under each window.
#include "analysis/spectrum.hpp"

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "support/catch.hpp"
#include "support/within.hpp"

namespace dinal::spectrum_test {

using dinal::within;
using namespace dinal::analysis;

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

TEST_CASE("the transform equals the sum that defines it", "[spectrum]") {
    for (const std::size_t n : {8U, 97U, 101U, 103U, 254U, 1021U}) {
        std::vector<double> values(n);
        for (std::size_t i = 0; i < n; ++i) values[i] = std::sin(static_cast<double>(i * i % 37));
        const Spectrum s = spectrum_of(values, 1, SpectrumWindow::rectangle);
        for (std::size_t k = 1; 2 * k < n; ++k) {
            std::complex<double> sum;
            for (std::size_t i = 0; i < n; ++i) {
                sum += std::polar(values[i], -2 * pi * static_cast<double>(i * k % n) / static_cast<double>(n));
            }
            REQUIRE(s.amplitude[k] == within(2 * std::abs(sum) / static_cast<double>(n), 1e-13));
        }
        // By Parseval's theorem the density of one whole segment adds up to the variance.
        const Eigen::Map<const Eigen::ArrayXd> all(values.data(), static_cast<Eigen::Index>(n));
        const Spectrum d = density_of(values, 0.1, SpectrumWindow::rectangle, n);
        const double sum = std::accumulate(d.amplitude.begin(), d.amplitude.end(), 0.0);
        CHECK(sum * d.frequency[1] == within((all - all.mean()).square().mean(), 1e-13));
    }
}

}  // namespace dinal::spectrum_test
