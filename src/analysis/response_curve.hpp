// The steady motions met by a parameter sweep in both directions: branches, and jumps between them.
#pragma once

#include "analysis/branch.hpp"

namespace dinal::analysis {

struct CurveQuestion {
    Family family;
    std::vector<double> values;  ///< parameter values in the order of the sweep
    model::State start = {};     ///< start of the first search
    bool doubled = false;        ///< whether to follow motions of twice the period from doublings
};

/// The end of the motion that a sweep follows, and the motion that replaces it.
struct MotionJump {
    double parameter = 0;
    bool rising = true;        ///< direction of the sweep that meets it
    double from = 0, to = 0;   ///< amplitudes
    SteadyMotion landed = {};  ///< status none: no periodic motion
};

struct ResponseCurve {
    std::vector<std::vector<BranchPoint>> branches;  ///< each in its order; the status marks values without a motion
    std::vector<MotionJump> jumps;                   ///< sorted by parameter
    std::optional<model::Contradiction> contradiction = {};
};

/// If the motion at each value is unique, each search starts from the one before. Otherwise walks branches round their
/// folds from the first value, from the landing of each jump, and from the last value.
// NOTE: an isolated branch that none of these reaches is missed; use another start for it.
ResponseCurve response_curve(const CurveQuestion& question, const motion::Monitor& monitor = {});

}  // namespace dinal::analysis
