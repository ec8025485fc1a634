#include "analysis/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>

namespace dinal::analysis {
namespace {

/// The transform takes n times the sum of the prime factors of n.
bool is_fast(std::size_t n) {
    for (const std::size_t factor : {2U, 3U, 5U, 7U, 11U, 13U}) {
        while (n % factor == 0) n /= factor;
    }
    return n < 100;
}

double weight(SpectrumWindow window, double phase) {
    const auto wave = [phase](double n) { return std::cos(2 * std::numbers::pi * n * phase); };
    switch (window) {
        case SpectrumWindow::hann:
            return 0.5 - 0.5 * wave(1);
        case SpectrumWindow::flat_top:  // of ISO 18431-2
            return 1 - 1.933 * wave(1) + 1.286 * wave(2) - 0.388 * wave(3) + 0.0322 * wave(4);
        case SpectrumWindow::rectangle:
            break;
    }
    return 1;
}

}  // namespace

std::size_t evenly_spaced(std::span<const double> times) {
    if (times.size() < 3) return times.size();
    const double step = times[1] - times[0];
    std::size_t n = 2;
    while (n < times.size() && std::fabs(times[n] - times[0] - static_cast<double>(n) * step) <= 1e-6 * step) ++n;
    return n;
}

Spectrum spectrum_of(std::span<const double> values, double dt, SpectrumWindow window) {
    std::size_t n = values.size();
    while (!is_fast(n)) --n;
    const std::span<const double> last = values.last(n);
    const double mean = std::accumulate(last.begin(), last.end(), 0.0) / static_cast<double>(n);
    std::vector<double> weighted(n);
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double w = weight(window, static_cast<double>(i) / static_cast<double>(n));
        weighted[i] = w * (last[i] - mean);
        sum += w;
    }
    std::vector<std::complex<double>> waves;
    Eigen::FFT<double>().fwd(waves, weighted);
    Spectrum result;
    result.used = n;
    for (std::size_t i = 0; i <= n / 2; ++i) {
        const double sides = i == 0 || 2 * i == n ? 1 : 2;
        result.frequency.push_back(static_cast<double>(i) / (static_cast<double>(n) * dt));
        result.amplitude.push_back(i == 0 ? std::fabs(mean) : sides * std::abs(waves[i]) / sum);
    }
    return result;
}

}  // namespace dinal::analysis
