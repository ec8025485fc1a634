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
#include "model/oscillator.hpp"
#include "model/system.hpp"
#include "motion/engine/run.hpp"
#include "text/expected.hpp"

namespace dinal::analysis {

enum class SteadyStatus { steady, adheres, rest, grows, none };
constexpr std::string_view name(SteadyStatus status) {
    constexpr std::array<std::string_view, 5> names{"steady", "adheres", "rest", "grows", "none"};
    return names[static_cast<std::size_t>(status)];
}

struct SteadyQuestion {
    model::SystemHandle system;
    model::Drive drive;
    /// The body, or of several the one that is looked at, as an oscillator with its formulas.
    model::Oscillator body;
    Repetition repeats = {};  ///< period 0: nothing depends on the time, and the period of a cycle is to be found
    int periods = 0;          ///< of M in one of the motion; 0: as many as it takes
    std::optional<std::size_t> joint = {};  ///< the body or link whose motion is told; none: of all that have names
    /// Controllers sample or wait, and all that drives the bodies repeats after this time; 0: after any; -1: there are
    /// none.
    double settles = -1;
    double longest = model::never;  ///< stretch of its runs, time units

    /// About one body without a name and with constant friction, or all or one of others.
    /// Fails where a body is moved by its theta or velocity.
    static text::Expected<SteadyQuestion> of(model::SystemHandle system, model::Drive drive,
                                             std::optional<std::size_t> joint = {});

    /// About one body without a name.
    static SteadyQuestion of(const model::Oscillator& body, model::Drive drive, const Repetition& repeats);
    /// The same about this body or link.
    [[nodiscard]] SteadyQuestion seen_at(std::size_t which) const;

    [[nodiscard]] bool is_timeless() const { return repeats.period == 0; }
    [[nodiscard]] bool is_plain() const { return system->is_plain(); }
    /// What acts on the body that is looked at: of several bodies as far as it depends on the time alone.
    [[nodiscard]] const model::Excitation& load() const;
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
    motion::engine::Run run;
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

/// Where the motion from the start of the question leads, as seen from its joint.
SteadyMotion steady_motion(const SteadyQuestion& question, const motion::Monitor& monitor = {});

/// The same from a place near the answer, as when a parameter has changed a little.
SteadyMotion steady_motion_near(const SteadyQuestion& question, const motion::Monitor& monitor = {});

/// The motions from other starts that are not this one, each once, with the question whose start leads to it. None is
/// looked for where no motion was found, or it is known to be the only one, or one of a family.
struct OtherMotion {
    SteadyQuestion question;
    SteadyMotion motion;
};
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
/// The same of all bodies.
std::string told(const SteadyQuestion& question, const SteadyMotion& motion, std::size_t others);

}  // namespace dinal::analysis
