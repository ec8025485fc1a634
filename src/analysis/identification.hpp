// Identification of the system behind a record: the parameters whose exact motion is nearest to measured angles, and
// their errors.
//
// A free decay needs no guess: its extremes say how long a swing lasts and what each one loses. With a known M the weak
// form of the equation of motion (multiplied by bumps and integrated by parts, so that nothing is differentiated) is
// linear in I, C, k and Rd. From there Levenberg and Marquardt's method goes on with exact motions.
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

/// The parameters that a record may determine. The last three are of the measured angle, theta + offset, at its first
/// time.
enum class Unknown : int { I, k, C, Rd, Re, theta0, velocity0, offset };
inline constexpr int unknown_count = 8;
inline constexpr std::array<std::string_view, unknown_count> unknown_names{"I",  "k",      "C",         "Rd",
                                                                           "Re", "theta0", "velocity0", "offset"};

struct IdentifyQuestion {
    std::vector<double> t, theta;             ///< times increase; at least as many as unknowns, and eight
    std::optional<model::Excitation> M = {};  ///< none: a free decay, which tells ratios: I = 1 unless I or k is given
    std::array<std::optional<double>, unknown_count> given = {};  ///< of those that are not fitted
};

struct IdentifiedRatio {
    double value = 0, error = 0;  ///< error: one standard deviation
};

struct Identified {
    std::array<double, unknown_count> value{}, error{};  ///< error: of one standard deviation; 0 of what was given
    std::array<bool, unknown_count> fitted{}, silent{};  ///< silent: the record says nothing about it
    std::array<double, unknown_count> low{}, high{};  ///< of what is silent: values from low to high fit about as well
    IdentifiedRatio omega0{}, zeta{}, Rd_over_k{};    ///< a free decay determines these
    std::vector<double> predicted;                    ///< at the times of the record
    double noise = 0;                                 ///< standard deviation of what is left
    std::size_t cut_low = 0, cut_high = 0;  ///< samples at the least and the greatest value, where those cut it off
    double scatter = 0;                     ///< what neighbouring samples differ by that a smooth motion would not
    double widening = 1;                    ///< of the errors, because the residual is alike from sample to sample
    bool M_is_noisy = false;                ///< which the errors ignore
    bool is_noise = false;                  ///< it explains no more of the record than it would of noise
    bool is_unexplained = false;            ///< it leaves much of the record, and what it leaves is not noise
    std::optional<Follows> misfit = {};     ///< the pattern that a wrong model leaves in the residual
    double noise_without_misfit = 0;       ///< standard deviation without that pattern, or by the record itself if less
    bool has_errors = true;                ///< false: the model is so wrong that nothing is known of them
    std::optional<std::size_t> wild = {};  ///< the sample that makes more than half of the sum of squares
    int runs = 0;                          ///< motions that were compared with the record
};

/// Fails when the record cannot be one: too short, constant, times that do not increase.
text::Expected<Identified> identify(const IdentifyQuestion& question, const motion::Monitor& monitor = {});

}  // namespace dinal::analysis
