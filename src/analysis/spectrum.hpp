// The one-sided amplitude spectrum of evenly spaced values.
#pragma once

#include <span>
#include <vector>

namespace dinal::analysis {

enum class SpectrumWindow { hann, rectangle, flat_top };

struct Spectrum {
    std::vector<double> frequency, amplitude;  ///< cycles per time unit; amplitude of a sine in the unit of the values
};

/// The amplitude spectrum of at least 8 values with spacing dt. The mean, weighted by the window, is at frequency 0 and
/// is subtracted first. A sine of amplitude A with a whole number of periods gives A at its frequency with any window.
Spectrum spectrum_of(std::span<const double> values, double dt, SpectrumWindow window);

/// Welch's power density (1967): the mean over segments of this length that overlap by half, each without its mean. Its
/// unit is the square of the values' unit per frequency; the sum times the frequency step is the variance.
Spectrum density_of(std::span<const double> values, double dt, SpectrumWindow window, std::size_t length);

/// The number of times, from the first on, that are evenly spaced.
std::size_t evenly_spaced(std::span<const double> times);

}  // namespace dinal::analysis
