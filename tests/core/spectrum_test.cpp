// The spectrum against the sum that defines it, and against what a window leaves of a sine.
#include "analysis/spectrum.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "support/catch.hpp"
#include "support/within.hpp"

namespace dinal::spectrum_test {

using dinal::within;
using namespace dinal::analysis;

namespace {

constexpr double pi = std::numbers::pi;

std::vector<double> cosine(std::size_t n, double cycles, double amplitude, double phase = 0, double mean = 0) {
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double turns = cycles * static_cast<double>(i) / static_cast<double>(n);
        values[i] = mean + amplitude * std::cos(2 * pi * turns + phase);
    }
    return values;
}

constexpr SpectrumWindow windows[] = {SpectrumWindow::hann, SpectrumWindow::rectangle, SpectrumWindow::flat_top};

}  // namespace

TEST_CASE("a cosine of whole periods has its amplitude, for any number of values", "[spectrum]") {
    // 101, 211 and 1018 = 2 x 509 have large prime factors and go another way.
    for (const std::size_t n : {64U, 65U, 99U, 101U, 211U, 1018U}) {
        for (const SpectrumWindow window : windows) {
            const Spectrum s = spectrum_of(cosine(n, 9, 3, 0.7, -2), 0.25, window);
            REQUIRE(s.frequency.size() == n / 2 + 1);
            CHECK(s.frequency[9] == within(9 / (0.25 * static_cast<double>(n)), 1e-12));
            CHECK(s.amplitude[9] == within(3, 1e-12));  // rounding of a thousand values
            CHECK(s.amplitude[0] == within(2, 1e-12));
            CHECK(s.amplitude[20] == within(0, 1e-12));
        }
    }
}

TEST_CASE("half a cycle per value is there for an even number of values, and counts once", "[spectrum]") {
    for (const std::size_t n : {64U, 202U}) {
        const Spectrum s = spectrum_of(cosine(n, static_cast<double>(n) / 2, 5), 0.5, SpectrumWindow::rectangle);
        CHECK(s.frequency.back() == 1);
        CHECK(s.amplitude.back() == within(5, 1e-12));
    }
    CHECK(spectrum_of(cosine(65, 3, 1), 0.5, SpectrumWindow::rectangle).frequency.back() < 1);
}

TEST_CASE("a sine midway between two frequencies has what the window leaves of it", "[spectrum]") {
    // The transform of each window, half a bin from its middle: 2/pi, 8/(3 pi), and the sum of the flat top's terms.
    const double flat = (1 + 1.933 / 3 - 1.286 / 15 + 0.388 / 35 - 0.0322 / 63) * 2 / pi;
    const double left[] = {8 / (3 * pi), 2 / pi, flat};
    for (const std::size_t n : {4096U, 4099U}) {
        for (std::size_t i = 0; i < std::size(windows); ++i) {
            const Spectrum s = spectrum_of(cosine(n, 1000.5, 1, 0.3), 1, windows[i]);
            // Leakage from the mirrored frequency, 2000 bins away, and of the sum for the integral: below 1/2000.
            CHECK(s.amplitude[1000] == within(left[i], 5e-4));
            CHECK(s.amplitude[1001] == within(left[i], 5e-4));
        }
    }
}

TEST_CASE("the transform is the sum that defines it", "[spectrum]") {
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
    }
}

TEST_CASE("a mean does not lean on a sine that is cut off", "[spectrum]") {
    // The plain mean of 10.5 periods of a sine is off by 2/(10.5 2 pi) of it, and would show in the first rows.
    const Spectrum s = spectrum_of(cosine(1000, 10.5, 1, pi / 2, 3), 1, SpectrumWindow::hann);
    CHECK(s.amplitude[0] == within(3, 1e-3));  // hann's leakage 10 bins away: 1/(2 pi 10^3)
    CHECK(s.amplitude[1] == within(0, 1e-3));
}

}  // namespace dinal::spectrum_test
