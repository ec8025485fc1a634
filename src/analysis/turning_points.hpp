// A measured motion before anything is fitted to it: its noise, its turning points, its swings.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace dinal::analysis {

/// The standard deviation of the noise of a smooth motion that is sampled about evenly, from fourth differences.
double noise_of(std::span<const double> theta);
/// Half the samples of a smooth curve would show far more of it.
bool is_noisy(std::span<const double> values);

/// How many samples of a free decay stand exactly at its least and at its greatest value, four and more in a row: there
/// its instrument could show no more. Where it comes to rest is no such row.
struct CutOff {
    double low = 0, high = 0;
    std::size_t at_low = 0, at_high = 0;
};
CutOff cut_off(std::span<const double> theta);

/// Indices of the turning points: from one to the next the motion gets at least `least` far, and back.
std::vector<std::size_t> turning_points(std::span<const double> theta, double least);

/// The slope of a straight line through the first `count` points, and its value at the first one.
struct Tangent {
    double value = 0, slope = 0;
};
Tangent first_tangent(std::span<const double> t, std::span<const double> theta, std::size_t count);

}  // namespace dinal::analysis
