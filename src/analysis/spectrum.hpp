// The one-sided amplitude spectrum of evenly spaced values.
#pragma once

#include <span>
#include <vector>

namespace dinal::analysis {

enum class SpectrumWindow { hann, rectangle, flat_top };

struct Spectrum {
    std::vector<double> frequency, amplitude;  ///< cycles per time unit; of a sine in the unit of the values
};

/// Of values dt apart, at least 8, all of them. The mean with the window's weights stands at frequency 0, and is taken
/// away before the rest. A sine of amplitude A that goes into the time a whole number of times gives A at its
/// frequency, whatever the window.
Spectrum spectrum_of(std::span<const double> values, double dt, SpectrumWindow window);

/// Welch's power density (1967): the mean over segments of this length that overlap by half, the mean of each taken
/// away. In place of amplitudes: the square of the unit per frequency; the sum times the step of frequency is the
/// variance.
Spectrum density_of(std::span<const double> values, double dt, SpectrumWindow window, std::size_t length);

/// How many of the times, from the first one, are evenly spaced.
std::size_t evenly_spaced(std::span<const double> times);

}  // namespace dinal::analysis
