// Identification: finds the parameters whose exact motion is nearest to measured angles, and their errors.
//
// A free decay needs no guess: its extremes determine the period and the loss of each swing. With a known M, the weak
// form of the equation of motion (multiplied by bumps and integrated by parts, so that nothing is differentiated) is
// linear in I, C, k and Rd. From this start the method of Levenberg and Marquardt fits exact motions.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "analysis/misfit.hpp"
#include "model/excitation.hpp"
#include "motion/simulate.hpp"
#include "text/expected.hpp"

namespace dinal::analysis {

/// The parameters that a record may determine. The last three describe the measured angle, theta + offset, at its first
/// time.
enum class Unknown : int { I, k, C, Rd, Re, theta0, velocity0, offset };
inline constexpr int unknown_count = 8;
inline constexpr std::array<std::string_view, unknown_count> unknown_names{"I",  "k",      "C",         "Rd",
                                                                           "Re", "theta0", "velocity0", "offset"};

inline constexpr std::array<Unknown, unknown_count> all_unknowns{
    Unknown::I, Unknown::k, Unknown::C, Unknown::Rd, Unknown::Re, Unknown::theta0, Unknown::velocity0, Unknown::offset};

/// A value for each of these parameters.
template <class T>
struct OfEach {
    T I{}, k{}, C{}, Rd{}, Re{}, theta0{}, velocity0{}, offset{};
};
template <class Values>
auto& at(Values& all, Unknown which) {
    constexpr std::array members{&Values::I,  &Values::k,      &Values::C,         &Values::Rd,
                                 &Values::Re, &Values::theta0, &Values::velocity0, &Values::offset};
    return all.*members[static_cast<std::size_t>(which)];
}
constexpr std::string_view name(Unknown which) {
    return unknown_names[static_cast<std::size_t>(which)];
}

struct IdentifyQuestion {
    std::vector<double> t, theta;  ///< times increase; at least eight samples, and as many as unknowns
    /// none: a free decay, which determines ratios only: I = 1 unless I or k is given
    std::optional<model::Excitation> M = {};
    OfEach<std::optional<double>> given = {};  ///< values of parameters that are not fitted

    bool gives(Unknown which) const { return at(given, which).has_value(); }
};

struct IdentifiedRatio {
    double value = 0, error = 0;  ///< error: one standard deviation
    double if_right = 0;          ///< the error if the model is right
};

struct Identified {
    /// error: one standard deviation, 0 for given parameters; it includes how far a wrong model moves the value if the
    /// record shows that or cannot exclude it
    OfEach<double> value, error;
    OfEach<double> if_right;  ///< the error if the model is right
    OfEach<bool> silent;      ///< silent: not determined by the record
    /// for silent parameters: values from low to high fit about equally well
    OfEach<double> low, high;
    IdentifiedRatio omega0{}, zeta{}, Rd_over_k{};  ///< determined by a free decay
    std::array<IdentifiedRatio*, 3> ratios() { return {&omega0, &zeta, &Rd_over_k}; }
    std::vector<double> predicted;  ///< at the times of the record
    double noise = 0;               ///< standard deviation of the residual
    /// numbers of samples at the least and greatest value if these clip the record
    std::size_t cut_low = 0, cut_high = 0;
    double scatter = 0;            ///< differences of neighbouring samples that a smooth motion would not have
    double widening = 1;           ///< factor of the errors due to correlated residuals
    bool noise_is_uneven = false;  ///< whether the errors are wider because noise is stronger where it matters
    bool M_is_noisy = false;       ///< whether M is noisy, which the errors ignore
    bool is_noise = false;         ///< whether the fit explains no more than it would of pure noise
    /// whether much of the record is unexplained, and the residual is not noise
    bool is_unexplained = false;
    /// what the residual follows if the model is wrong: the best explanation, then those that are about as good
    std::vector<Follows> misfit = {};
    /// standard deviation of the residual without that pattern, or that of the record itself if less
    double noise_without_misfit = 0;
    bool has_errors = true;                ///< false if the model is so wrong that errors are meaningless
    std::optional<std::size_t> wild = {};  ///< index of a sample that makes up more than half of the sum of squares
};

/// Fails if the record is unusable: too short, constant, or with times that do not increase.
text::Expected<Identified> identify(const IdentifyQuestion& question, const motion::Monitor& monitor = {});

}  // namespace dinal::analysis
