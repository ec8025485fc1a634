// What a response brings along: its jumps, and the curves of theory that can be drawn over it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/response_curve.hpp"
#include "api/data.hpp"

namespace dinal::api {

/// The column of what is varied; its unit, and that of theta.
struct VariedColumn {
    std::string name, unit = {}, theta = {};
};

/// A response over one parameter, which over two is that at a value of the first.
struct ResponsePart {
    double beside = 0;
    std::size_t branches_before = 0;  ///< in the parts before this one
    analysis::ResponseCurve curve = {};
};

/// c.jumps, over the one or two parameters.
DataCompanion jumps_of(const std::vector<ResponsePart>& parts, const std::vector<VariedColumn>& over);

/// c.points: where a branch turns back, or another one begins. Over two parameters they form curves.
DataCompanion points_of(const std::vector<ResponsePart>& parts, const std::vector<VariedColumn>& over);

/// A sweep of the frequency of a harmonic M, or at one frequency of its amplitude.
struct HarmonicSweep {
    model::Oscillator system;
    VariedColumn column;
    double low = 0, high = 0;
    std::optional<double> frequency = {};  ///< none: that is what is varied
    double amplitude = 1;                  ///< torque, where the frequency is varied
};
/// c.linearised and c.den_hartog, for a linear spring and the friction of Coulomb; else none.
std::vector<DataCompanion> closed_curves(const HarmonicSweep& sweep);

}  // namespace dinal::api
