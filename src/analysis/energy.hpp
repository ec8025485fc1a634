// Where the energy of a run goes: what M puts in, what is stored, what the two frictions take; and how well it adds up.
//
//     input = change of kinetic + change of spring + viscous + dry
//
// A run on a moving surface, on a shaking support, or whose user acts at events has their work beside the input; one
// with walls what impacts took beside the two frictions.
//
// The work of M is the integral of M theta' dt, viscous friction takes that of C theta'^2 and dry friction Rd times the
// way. All are integrated over the legs in which the motion was computed, by the integrator and so as exactly; the
// stored energies come from theta and velocity. Nothing is made to add up: the error says how well it does.
#pragma once

#include <vector>

#include "model/units.hpp"
#include "motion/trajectory.hpp"
#include "text/expected.hpp"

namespace dinal::analysis {

/// Energies in torque times rad.
struct Stored {
    double kinetic = 0;  ///< I theta'^2 / 2
    double spring = 0;   ///< k theta^2 / 2, and what a spring of its own has
};

using motion::Work;

struct Balance {
    Work work;
    Stored change;
    Balance() = default;
    /// What springs with a memory store is told by the work on them.
    Balance(const Work& done, const Stored& by_state) : work(done), change(by_state) { change.spring += done.kept; }
    /// What does not add up: input - (kinetic + spring + viscous + dry + impacts).
    [[nodiscard]] double error() const {
        const double given = work.belt + work.base + work.acts;
        return work.input + given - work.viscous - work.dry - work.impacts - (change.kinetic + change.spring);
    }
};

/// The motion from one velocity zero to the next; the first and the last one may be cut off by the ends of the run.
struct HalfCycle {
    double t_start = 0, t_end = 0;
    double theta_start = 0, theta_end = 0;
    Balance balance;
};

/// A link has no mass.
enum class Whose { all, body, link };

struct Energy {
    double t_start = 0, t_end = 0;
    Stored start, finish;
    Balance total;
    /// The energy that flowed: what M put in and what the spring and the moving mass gave, half cycle by half cycle.
    double flow = 0;
    std::vector<HalfCycle> half_cycles;
    /// Whose: of a body or a link among others what does not add up is the work of the others on it.
    Whose whose = Whose::all;

    /// |error| as a part of the energy that flowed; 0 when none did.
    [[nodiscard]] double closure() const;
};

/// Fails with a sentence when the run has not kept its motion.
text::Expected<Energy> energy_of(const motion::Trajectory& trajectory, Whose whose = Whose::all);

/// That of a whole run from those of its joints: what the others do on each of them cancels. Its half cycles are known
/// if there is only one joint.
Energy sum_of(std::vector<Energy> joints);

/// The same at the rows: work done since t_start and energy stored at each. Only after energy_of() has succeeded.
enum class EnergyColumn : int { input, kinetic, spring, viscous, dry, error, belt, base, acts, impacts };
inline constexpr int energy_column_count = 10;
Eigen::MatrixXd energy_columns(const motion::Trajectory& trajectory, Whose whose = Whose::all);

/// The balance as a small table, for people.
std::string text(const Energy& energy, const model::Units& units = {});

}  // namespace dinal::analysis
