// What is known of a steady motion before it is looked for, and what one look at a period of it tells.
#pragma once

#include <utility>

#include "analysis/fixed_point.hpp"
#include "analysis/returns.hpp"
#include "analysis/steady.hpp"

namespace dinal::analysis {

/// Sliding and holding torque are the same each way, there are no walls, and M, belt and base depend on the time alone:
/// the map brings no two states farther apart, so there is one motion, or a family of them. Of several bodies the
/// energy of the difference of two motions cannot grow in any joint.
bool contracts(const SteadyQuestion& question);

/// By how much these multipliers miss 1, in one period or in some: others beside the motion are periodic, too, where
/// they do not.
double miss_one(const std::vector<std::complex<double>>& multipliers);

/// Half a period later everything is the same the other way round: friction, springs, walls and M.
bool is_alike_both_ways(const SteadyQuestion& question);

/// Of a multiplier, by how much it may miss 1.
inline constexpr double neutral_within = 1e-6;

inline Place place_of(const model::State& state, double omega) {
    return {state.theta, state.velocity / omega};
}

/// One of the starts all around a motion, the nearest of them within a hundredth of the farthest: angle, and velocity
/// over a frequency.
std::complex<double> start_around(int i, double farthest, std::size_t body = 0);

/// The motions that the questions lead to, each once, but for those that are alike to the known one.
template <class Alike>
std::vector<OtherMotion> others_from(const std::vector<SteadyQuestion>& questions, const SteadyMotion& known,
                                     const Alike& alike, const motion::Monitor& monitor) {
    std::vector<OtherMotion> others;
    for (const SteadyQuestion& question : questions) {
        SteadyMotion found = steady_motion(question, monitor);
        if (found.outcome == model::Outcome::interrupted) break;
        const auto is_it = [&](const OtherMotion& seen) { return alike(seen.motion, found); };
        if (found.status == SteadyStatus::none || alike(known, found)) continue;
        if (std::none_of(others.begin(), others.end(), is_it)) others.push_back({question, std::move(found)});
    }
    return others;
}

/// From where to where friction holds the mass through all of the period, about the place where it was found at rest.
std::pair<double, double> rest_of(const SteadyQuestion& question, double here);

/// The facts about the motion through a fixed point of the map over `periods` of M, or of its half (periods = 1), whose
/// opposite it repeats. Where the mass may rest, and whether another motion is there, are not among them.
SteadyMotion facts_of(const SteadyQuestion& question, const PeriodMap& map, const FixedPointSearch::Try& found,
                      int periods, bool half);

/// The facts that one period as a run tells: its extremes and stops, and whether anything moves.
void tell_of_run(const SteadyQuestion& question, const motion::Trajectory& run, SteadyMotion& motion);

/// The question whose run begins so.
std::shared_ptr<const SteadyQuestion> begun_at(const SteadyQuestion& question, const model::Drive& drive, double start);

/// The motion as seen from the body or link of the question; `run` is the run of its period as seen from there, none at
/// rest.
SteadyMotion seen_from(const SteadyQuestion& question, const SteadyMotion& whole,
                       std::shared_ptr<const motion::Trajectory> run);
/// The same of a motion that was seen from any: the run is that of its period.
SteadyMotion seen_from(const SteadyQuestion& question, const SteadyMotion& motion);

/// The motion of a run with more in it or of an M with a memory, or a limit cycle, that a run from `initial` leads to.
SteadyMotion returning_motion(const SteadyQuestion& question, const motion::Monitor& monitor);

/// Whether a motion that was found by theta and velocity alone goes on like this in one run of some periods.
bool goes_on(const SteadyQuestion& question, const SteadyMotion& motion, const motion::Monitor& monitor);

}  // namespace dinal::analysis
