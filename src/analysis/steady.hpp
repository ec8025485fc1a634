// The periodic motion of a system under a periodic M: a fixed point of the period map, found by Newton's method, by
// waiting where that does not lead on, and by recurrence where the motion is subharmonic. docs/theory.md, section 10.
#pragma once

#include <array>
#include <complex>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/period_map.hpp"
#include "analysis/repetition.hpp"
#include "model/drive.hpp"
#include "motion/engine/run.hpp"

namespace dinal::analysis {

enum class SteadyStatus { steady, adheres, rest, grows, none };
constexpr std::string_view name(SteadyStatus status) {
    constexpr std::array<std::string_view, 5> names{"steady", "adheres", "rest", "grows", "none"};
    return names[static_cast<std::size_t>(status)];
}

struct RigQuestion;

struct SteadyQuestion {
    model::Oscillator system;
    model::Drive drive;
    Repetition repeats;  ///< period 0: nothing depends on the time, and the period of a cycle is to be found
    int periods = 0;     ///< of M in one of the motion; 0: as many as it takes
    /// Of one of several bodies or links: what is asked of all of them. The system is that of this one alone, and the
    /// excitation is looked at for its harmonics only.
    std::shared_ptr<const RigQuestion> whole = {};
    std::size_t joint = 0;

    [[nodiscard]] bool is_timeless() const { return repeats.period == 0; }
};

/// How one of several bodies moves.
struct BodyMotion {
    double low = 0, high = 0;  ///< of its angle, from that of another body where they go round
    double turned = 0;         ///< how far it goes round in a period, or in a time unit where nothing has a period
    double begin = 0;          ///< its angle at the start
};

/// One period of several bodies.
struct PeriodOfBodies {
    model::Drive drive;
    motion::engine::AssemblyRun run;
};

struct SteadyMotion {
    SteadyStatus status = SteadyStatus::none;
    int periods = 1;     ///< of M in one of the motion
    double period = 0;   ///< of the motion
    model::State start;  ///< at the beginning of M's period
    double amplitude = 0, low = 0, high = 0, t_high = 0;
    std::size_t stops = 0;
    double stuck = 0;  ///< part of a period
    std::vector<std::complex<double>> multipliers = {};
    bool differentiable = false;  ///< else there are no multipliers
    bool stable = false, symmetric = false;
    std::optional<bool> unique;                              ///< none: other starts must tell
    std::pair<double, double> rest;                          ///< where it may stand, when it adheres
    double growth = 0;                                       ///< of the amplitude, in a period of M
    int maps = 0;                                            ///< periods that were run
    double residual = 0;                                     ///< what is left of the fixed point, in amplitudes
    model::Outcome outcome = model::Outcome::reached_end;    ///< of the last run
    std::optional<model::Contradiction> contradiction = {};  ///< of Outcome::not_a_function
    std::shared_ptr<const motion::Trajectory> settled = {};  ///< one period, of a motion that has more than a state
    std::shared_ptr<const SteadyQuestion> asked = {};        ///< whose run `settled` is; none: the last part of a run
    // Of motions that return:
    std::vector<BodyMotion> bodies = {};
    std::shared_ptr<const PeriodOfBodies> of_bodies = {};  ///< none at rest
    std::shared_ptr<const model::Drive> begun = {};        ///< of a run that is the motion from its start on

    /// Whether there is a motion or a rest, and so facts about it.
    [[nodiscard]] bool is_found() const { return status != SteadyStatus::grows && status != SteadyStatus::none; }
    [[nodiscard]] bool stands() const { return status == SteadyStatus::adheres || status == SteadyStatus::rest; }
};

/// Where the motion from `initial` leads.
SteadyMotion steady_motion(const SteadyQuestion& question, const motion::Monitor& monitor = {});

/// The same from a place near the answer, as when a parameter has changed a little.
SteadyMotion steady_motion_near(const SteadyQuestion& question, const motion::Monitor& monitor = {});

/// The motions from other starts that are not this one, each once, with the question whose start leads to it. None is
/// looked for where no motion was found, or it is known to be the only one, or one of a family.
template <class Question>
struct Other {
    Question question;
    SteadyMotion motion;
};
using OtherMotion = Other<SteadyQuestion>;
inline constexpr int other_starts = 16;
std::vector<OtherMotion> other_motions(const SteadyQuestion& question, const SteadyMotion& known,
                                       const motion::Monitor& monitor = {});

/// What the motion is besides its extremes: integrals over its period, which take a look at all of it.
struct SteadyShape {
    double mean = 0;                      ///< of theta, by time
    std::optional<double> lag = {};       ///< of the fundamental behind that of M, rad in (-pi, pi]
    std::optional<double> peak_lag = {};  ///< of the highest theta behind the maximum of the fundamental of M
    double fundamental = 0;               ///< its amplitude
};
SteadyShape shape_of(const SteadyQuestion& question, const SteadyMotion& motion, const motion::Monitor& monitor = {});

/// The answer in sentences.
std::string told(const SteadyQuestion& question, const SteadyMotion& motion, const SteadyShape& shape,
                 const std::vector<OtherMotion>& others);

}  // namespace dinal::analysis
