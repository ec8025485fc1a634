// The record of an identification: its noise, turning points, clipping and initial slope, and the values from which the
// search starts.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "analysis/identification.hpp"

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

/// A value for each unknown, fitted or given.
using Parameters = OfEach<double>;

/// The measured angles, with properties that need no model.
struct MeasuredAngles {
    explicit MeasuredAngles(const IdentifyQuestion& question);

    /// Returns whether the last samples are equal to within noise.
    bool ends_at_rest() const;
    /// The natural frequency of one full swing per sample.
    double highest_omega0() const;

    Eigen::VectorXd theta;
    CutOff cut;
    double range, span, noise;
    double step;                     ///< resolution of the instrument; 0 if none is visible
    std::vector<std::size_t> turns;  ///< indices of the turning points
};

/// Starting values: from the extremes of a free decay, or by the weak form of the driven equation. Given values are
/// kept.
class FitStarts {
public:
    FitStarts(const IdentifyQuestion& question, const MeasuredAngles& record) : question_(question), record_(record) {}

    std::vector<Parameters> all() const { return question_.M ? forced() : free(); }
    /// Solves the weak form of the driven equation; falls back on the scales of the record.
    Parameters weak_form() const;
    /// Completes the values by the first angles of the record. `dry` is Rd/k, `zero` the offset.
    Parameters completed(double omega0, double zeta, double dry, double zero) const;

private:
    std::vector<Parameters> free() const;
    std::vector<Parameters> forced() const;
    Parameters start_of(double q, double dry, double omega1) const;
    void add_window(std::size_t first, std::size_t last, double sign, std::vector<std::array<double, 6>>& rows) const;

    const IdentifyQuestion& question_;
    const MeasuredAngles& record_;
};

}  // namespace dinal::analysis
