#include "analysis/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace dinal::analysis {
namespace {

using Wave = std::complex<double>;

/// Returns whether n has small prime factors only: Eigen's transform costs n times their sum.
bool is_fast(std::size_t n) {
    for (const std::size_t factor : {2U, 3U, 5U, 7U, 11U, 13U}) {
        while (n % factor == 0) n /= factor;
    }
    return n < 100;
}

/// The transform for a number of values with a large prime factor, as a convolution of another length (Bluestein 1970):
/// the product i k in the exponent is (i^2 + k^2 - (i - k)^2)/2.
std::vector<Wave> transform_by_chirp(const std::vector<double>& values) {
    const std::size_t n = values.size(), length = std::bit_ceil(2 * n);
    std::vector<Wave> chirp(n), left(length), right(length);
    for (std::size_t i = 0; i < n; ++i) {
        // Removes whole turns in integer arithmetic: i^2 as a double would lose digits.
        const auto turns = static_cast<double>(std::uint64_t{i} * i % (2 * n)) / static_cast<double>(n);
        chirp[i] = std::polar(1.0, -std::numbers::pi * turns);
        left[i] = values[i] * chirp[i];
        right[i] = right[(length - i) % length] = std::conj(chirp[i]);
    }
    Eigen::FFT<double> fft;
    std::vector<Wave> left_waves, right_waves, sum;
    fft.fwd(left_waves, left);
    fft.fwd(right_waves, right);
    for (std::size_t i = 0; i < length; ++i) left_waves[i] *= right_waves[i];
    fft.inv(sum, left_waves);
    for (std::size_t i = 0; i < n; ++i) chirp[i] *= sum[i];
    return chirp;
}

std::vector<Wave> transform(const std::vector<double>& values) {
    if (!is_fast(values.size())) return transform_by_chirp(values);
    std::vector<Wave> waves;
    Eigen::FFT<double>().fwd(waves, values);
    return waves;
}

double weight(SpectrumWindow window, double phase) {
    const auto wave = [phase](double n) { return std::cos(2 * std::numbers::pi * n * phase); };
    switch (window) {
        case SpectrumWindow::hann:
            return 0.5 - 0.5 * wave(1);
        case SpectrumWindow::flat_top:  // from ISO 18431-2
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
    // Late times are rounded, and so is their difference.
    const double rounding =
        2 * std::numeric_limits<double>::epsilon() * std::max(std::fabs(times[0]), std::fabs(times.back()));
    std::size_t n = 2;
    for (; n < times.size(); ++n) {
        const auto steps = static_cast<double>(n);
        if (!(std::fabs(times[n] - times[0] - steps * step) <= 1e-6 * step + steps * rounding)) break;
    }
    return n;
}

Spectrum density_of(std::span<const double> values, double dt, SpectrumWindow window, std::size_t length) {
    Spectrum result;
    const std::size_t step = std::max<std::size_t>(1, length / 2);
    std::vector<double> weights(length), weighted(length);
    double squares = 0;
    for (std::size_t i = 0; i < length; ++i) {
        weights[i] = weight(window, static_cast<double>(i) / static_cast<double>(length));
        squares += weights[i] * weights[i];
    }
    result.frequency.resize(length / 2 + 1);
    result.amplitude.resize(length / 2 + 1);
    std::size_t segments = 0;
    for (std::size_t first = 0; first + length <= values.size(); first += step, ++segments) {
        double mean = 0;
        for (std::size_t i = 0; i < length; ++i) mean += values[first + i] / static_cast<double>(length);
        for (std::size_t i = 0; i < length; ++i) weighted[i] = weights[i] * (values[first + i] - mean);
        const std::vector<Wave> waves = transform(weighted);
        for (std::size_t i = 0; i <= length / 2; ++i) {
            const double sides = i == 0 || 2 * i == length ? 1 : 2;
            result.amplitude[i] += sides * std::norm(waves[i]) * dt / squares;
        }
    }
    for (std::size_t i = 0; i <= length / 2; ++i) {
        result.frequency[i] = static_cast<double>(i) / (static_cast<double>(length) * dt);
        result.amplitude[i] /= static_cast<double>(segments);
    }
    return result;
}

Spectrum spectrum_of(std::span<const double> values, double dt, SpectrumWindow window) {
    const std::size_t n = values.size();
    std::vector<double> weighted(n);
    double weights = 0, sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        weighted[i] = weight(window, static_cast<double>(i) / static_cast<double>(n));
        weights += weighted[i];
        sum += weighted[i] * values[i];
    }
    const double mean = sum / weights;
    for (std::size_t i = 0; i < n; ++i) weighted[i] *= values[i] - mean;
    const std::vector<Wave> waves = transform(weighted);
    Spectrum result;
    for (std::size_t i = 0; i <= n / 2; ++i) {
        const double sides = i == 0 || 2 * i == n ? 1 : 2;
        result.frequency.push_back(static_cast<double>(i) / (static_cast<double>(n) * dt));
        result.amplitude.push_back(i == 0 ? std::fabs(mean) : sides * std::abs(waves[i]) / weights);
    }
    return result;
}

}  // namespace dinal::analysis
