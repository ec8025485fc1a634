// Properties of a measured motion before any fit: noise, turning points, clipping, initial slope.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace dinal::analysis {

/// The standard deviation of the noise of a smooth, about evenly sampled motion, from fourth differences.
double noise_of(std::span<const double> theta);
/// Returns whether the values are noisy: if every second sample of a smooth curve is left out, its apparent noise grows
/// a lot.
bool is_noisy(std::span<const double> values);

/// Detects a clipped record: the numbers of samples exactly at its least and greatest value, in rows of four or more. A
/// final rest does not count.
struct CutOff {
    double low = 0, high = 0;
    std::size_t at_low = 0, at_high = 0;
};
CutOff cut_off(std::span<const double> theta);

/// The indices of turning points, between which theta moves by at least `least`.
std::vector<std::size_t> turning_points(std::span<const double> theta, double least);

/// The straight line through the first `count` points: its value at the first one, and its slope.
struct Tangent {
    double value = 0, slope = 0;
};
Tangent first_tangent(std::span<const double> t, std::span<const double> theta, std::size_t count);

}  // namespace dinal::analysis
