// Facts about a steady motion: those known in advance, and those from one run of a period.
#pragma once

#include <utility>

#include "analysis/period_map.hpp"
#include "analysis/returns.hpp"
#include "analysis/steady.hpp"

namespace dinal::analysis {

/// Returns whether the distance of two states never grows, so that there is one motion or a family. Requires equal
/// sliding and holding torques, no walls, and M, belt and base that depend on time only. For several bodies, the energy
/// of the difference of two motions cannot grow in any joint.
bool contracts(const SteadyQuestion& question);

/// The distance of these multipliers from 1, after one or several periods; at 0, neighbouring motions are also
/// periodic.
double distance_from_one(const std::vector<std::complex<double>>& multipliers);

/// Returns whether friction, springs, walls and M are antisymmetric half a period later.
bool is_symmetric_problem(const SteadyQuestion& question);

/// The tolerance of a multiplier that counts as 1.
inline constexpr double neutral_within = 1e-6;

/// Start number i around a motion, at distances from a hundredth of `farthest` up to `farthest`: angle, and velocity
/// over a frequency.
std::complex<double> start_around(int i, double farthest, std::size_t body = 0);

/// The distinct motions that the questions lead to, without those equal to the known one.
template <class Alike>
std::vector<OtherMotion> others_from(const std::vector<SteadyQuestion>& questions, const SteadyMotion& known,
                                     const Alike& alike, const motion::Monitor& monitor) {
    std::vector<OtherMotion> others;
    for (const SteadyQuestion& question : questions) {
        SteadyMotion found = steady_motion(question, monitor);
        if (found.outcome == model::Outcome::interrupted) break;
        const auto is_it = [&](const OtherMotion& seen) { return alike(seen.motion, found); };
        if (found.status == SteadyStatus::none || alike(known, found)) continue;
        if (std::ranges::none_of(others, is_it)) others.push_back({question, std::move(found)});
    }
    return others;
}

/// The range of angles around `here` in which friction holds the mass throughout the period.
std::pair<double, double> rest_of(const SteadyQuestion& question, double here);

/// The reliability of the multipliers of a motion.
struct Judged {
    /// whether they describe all disturbances, and there is no further freedom, such as a rotation
    bool alone = true;
    double error = 1e-5;  ///< error of the multipliers
};
/// Concludes from the multipliers whether the motion is stable, and whether there are others.
void judge(const SteadyQuestion& question, std::vector<std::complex<double>> multipliers, const Judged& by,
           SteadyMotion& motion);

/// The facts about the motion through this fixed point of the map over `periods` of M, or over half a period (periods =
/// 1) of a symmetric motion. Does not determine the range of rest, or other motions.
SteadyMotion facts_of(const SteadyQuestion& question, const PeriodMap& map, const MapStep& step, const Place& from,
                      int periods);

/// Fills in what a run of one period shows: extremes, stops, any movement.
void fill_from_run(const SteadyQuestion& question, const motion::Run& run, SteadyMotion& motion);

std::shared_ptr<const SteadyQuestion> begun_at(const SteadyQuestion& question, const model::Drive& drive, double start);

/// The motion as seen from the joint of the question; `run` is its period as seen from there, null at rest.
SteadyMotion seen_from(const SteadyQuestion& question, const SteadyMotion& whole,
                       std::shared_ptr<const motion::Run> run);
/// The same for a motion with a stored period.
SteadyMotion seen_from(const SteadyQuestion& question, const SteadyMotion& motion);

}  // namespace dinal::analysis
