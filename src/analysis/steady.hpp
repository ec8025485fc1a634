// Steady motions: fixed points of a map from one return of the motion to the next (forced_search.hpp). docs/theory.md,
// section 10.
#pragma once

#include <array>
#include <complex>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/repetition.hpp"
#include "model/drive.hpp"
#include "model/oscillator.hpp"
#include "model/system.hpp"
#include "motion/run.hpp"
#include "motion/simulate.hpp"
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
    /// the body, or the one of interest, as an oscillator
    model::Oscillator body;
    Repetition repeats = {};  ///< period 0: nothing depends on time, so the period of a cycle is unknown
    int periods = 0;          ///< how many periods of M one period of the motion lasts; 0: as many as needed
    std::optional<std::size_t> joint = {};  ///< the body or link of interest; none: all named ones
    /// For sampled or delayed controllers: the time after which drive and sampling repeat; 0: arbitrary; -1: there are
    /// no such controllers.
    double settles = -1;
    double longest = model::never;  ///< longest stretch of its runs, time units
    /// whether the angle of a plain body under M may advance from period to period, as that of named bodies may
    bool advances = false;

    /// A question about one plain body, or about all or one of several. Fails if a body's motion is prescribed.
    static text::Expected<SteadyQuestion> of(model::SystemHandle system, model::Drive drive,
                                             std::optional<std::size_t> joint = {});

    /// A question about one plain body.
    static SteadyQuestion of(const model::Oscillator& body, model::Drive drive, const Repetition& repeats);
    /// This question as seen from another body or link.
    SteadyQuestion seen_at(std::size_t which) const;

    bool is_timeless() const { return repeats.period == 0; }
    bool is_plain() const { return system->is_plain(); }
    /// Returns whether the system is one body, named or not.
    bool is_alone() const { return system->joints.size() == 1; }
    /// The excitation of the body of interest; with several bodies the part that depends on time only.
    const model::Excitation& load() const;
};

/// The motion of one of several bodies.
struct BodyMotion {
    double low = 0, high = 0;  ///< range of its angle, measured from another body if they rotate
    double turned = 0;         ///< rotation in a period, or in a time unit if nothing has a period
    double begin = 0;          ///< its angle at the start
};

struct PeriodOfBodies {
    model::Drive drive;
    motion::Run run;
};

/// The runs of a motion found by returns; empty for any other.
struct FoundByReturns {
    std::shared_ptr<const motion::Run> run = {};  ///< one period of the body or link of interest
    /// the question whose start lies on the motion; null: `run` ends a longer run
    std::shared_ptr<const SteadyQuestion> question = {};
    std::shared_ptr<const model::Drive> drive = {};        ///< the drive of a run that is periodic from its start
    std::shared_ptr<const PeriodOfBodies> of_bodies = {};  ///< null at rest
};

struct SteadyMotion {
    SteadyStatus status = SteadyStatus::none;
    int periods = 1;     ///< how many periods of M one period of the motion lasts
    double period = 0;   ///< period of the motion
    model::State start;  ///< at the beginning of M's period
    double amplitude = 0, low = 0, high = 0, t_high = 0;
    std::size_t stops = 0;
    double stuck = 0;  ///< part of a period
    std::vector<std::complex<double>> multipliers = {};
    bool differentiable = false;  ///< whether there are multipliers
    bool stable = false, symmetric = false;
    std::optional<bool> unique;      ///< none: unknown, search from other starts
    std::pair<double, double> rest;  ///< range of angles at which it may rest, if it adheres
    double growth = 0;               ///< growth of the amplitude in a period of M; infinite if not even
    int maps = 0;                    ///< number of periods that were run
    /// if no motion was found: greatest change of the last periods from earlier ones, in amplitudes, if they nearly
    /// repeat
    std::optional<double> change = {};
    model::Outcome outcome = model::Outcome::reached_end;    ///< outcome of the last run
    std::optional<model::Contradiction> contradiction = {};  ///< cause of Outcome::not_a_function
    std::vector<BodyMotion> bodies = {};                     ///< set for motions found by returns
    FoundByReturns by_returns = {};

    /// Returns whether a motion or a rest was found.
    bool is_found() const { return status != SteadyStatus::grows && status != SteadyStatus::none; }
    bool stands() const { return status == SteadyStatus::adheres || status == SteadyStatus::rest; }
};

/// The steady motion that a run from the start of the question leads to, as seen from its joint.
SteadyMotion steady_motion(const SteadyQuestion& question, const motion::Monitor& monitor = {});

/// Like steady_motion(), from a start near the answer, such as the motion before a small change of a parameter.
SteadyMotion steady_motion_near(const SteadyQuestion& question, const motion::Monitor& monitor = {});

/// Other motions, found from other starts, each with a question whose start leads to it. Empty if `known` is not a
/// motion, is unique, or belongs to a family.
struct OtherMotion {
    SteadyQuestion question;
    SteadyMotion motion;
};
inline constexpr int other_starts = 16;
std::vector<OtherMotion> other_motions(const SteadyQuestion& question, const SteadyMotion& known,
                                       const motion::Monitor& monitor = {});

/// Integrals over the period of a motion, which need another run.
struct SteadyShape {
    double mean = 0;                      ///< time average of theta
    std::optional<double> lag = {};       ///< lag of the fundamental behind that of M, rad in (-pi, pi]
    std::optional<double> peak_lag = {};  ///< lag of theta's maximum behind that of M's fundamental, rad
    double fundamental = 0;               ///< amplitude of theta's fundamental
};
SteadyShape shape_of(const SteadyQuestion& question, const SteadyMotion& motion, const motion::Monitor& monitor = {});

/// Describes the answer in sentences.
std::string description_of(const SteadyQuestion& question, const SteadyMotion& motion, const SteadyShape& shape,
                           const std::vector<OtherMotion>& others);
/// Describes the motion of all bodies.
std::string description_of(const SteadyQuestion& question, const SteadyMotion& motion, std::size_t others);

}  // namespace dinal::analysis
