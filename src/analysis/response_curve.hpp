// All that a sweep of a parameter and its way back meet: branches of steady motions, and the jumps between them.
#pragma once

#include "analysis/branch.hpp"

namespace dinal::analysis {

struct CurveQuestion {
    Family family;
    std::vector<double> values;  ///< of the parameter, in the order of the sweep
    model::State start = {};     ///< of the first search
    bool doubled = false;        ///< also follows the motions of twice the period that begin at doublings
};

/// Where the motion that a sweep follows ends, and what becomes of it.
struct MotionJump {
    double parameter = 0;
    bool rising = true;        ///< the parameter, in the sweep that meets it
    double from = 0, to = 0;   ///< amplitudes
    SteadyMotion landed = {};  ///< status none: on nothing periodic
};

struct ResponseCurve {
    std::vector<std::vector<BranchPoint>> branches;  ///< each in its order; where none was found status says so
    std::vector<MotionJump> jumps;                   ///< by parameter
    std::optional<model::Contradiction> contradiction = {};
};

/// Where no two motions can be at one value they are found one from the other; else branches are walked, round their
/// folds, from the first value, from where a jump lands, and from the last value.
// NOTE: a branch that none of these meets, as an island, is not seen; another start may lie on it.
ResponseCurve response_curve(const CurveQuestion& question, const motion::Monitor& monitor = {});

}  // namespace dinal::analysis
