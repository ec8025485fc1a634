// The energy balance of a run: input of M, stored energy, losses by both frictions, and the closure error.
//
//     input = change of kinetic + change of spring + viscous + dry
//
// A moving surface, a shaking support and users' actions add their work to the input; walls add the loss of impacts to
// the frictions.
//
// M does the work integral of M theta' dt, viscous friction takes C theta'^2 dt and dry friction Rd times the way. All
// are integrated over the integrator's own legs, with the accuracy of the motion; stored energies come from theta and
// velocity. Nothing is adjusted, so the error is a true check.
#pragma once

#include <vector>

#include "model/units.hpp"
#include "motion/run.hpp"
#include "text/expected.hpp"

namespace dinal::analysis {

/// Energies in torque times rad.
struct Stored {
    double kinetic = 0;  ///< I theta'^2 / 2
    double spring = 0;   ///< k theta^2 / 2 plus the energy of a nonlinear spring
};

using motion::Work;

struct EnergyBalance {
    Work work;
    Stored change;
    EnergyBalance() = default;
    /// The springs of sliders store the work `kept`, as their energy does not follow from the state.
    EnergyBalance(const Work& done, const Stored& by_state) : work(done), change(by_state) {
        change.spring += done.kept;
    }
    /// The closure error: input - (kinetic + spring + viscous + dry + impacts).
    double error() const {
        const double given = work.belt + work.base + work.acts;
        return work.input + given - work.viscous - work.dry - work.impacts - (change.kinetic + change.spring);
    }
};

/// The motion between two zeros of the velocity; the ends of the run may cut the first and the last one.
struct HalfCycle {
    double t_start = 0, t_end = 0;
    double theta_start = 0, theta_end = 0;
    EnergyBalance balance;
};

/// The subject of a balance; a link has no inertia.
enum class Whose { all, body, link };

struct Energy {
    double t_start = 0, t_end = 0;
    Stored start, finish;
    EnergyBalance total;
    /// The energy flow: M's input and energy released by spring and mass, summed over half cycles.
    double flow = 0;
    std::vector<HalfCycle> half_cycles;
    /// For one body or link of several, the closure error is the work of the others on it.
    Whose whose = Whose::all;

    /// |error| relative to the flow; 0 without any flow.
    double closure() const;
};

/// Fails if the run has not kept its motion.
text::Expected<Energy> energy_of(const motion::Run& run, Whose whose = Whose::all);

/// The balance of a whole run from those of its joints; the work between joints cancels. Has half cycles only for a
/// single joint.
Energy sum_of(std::vector<Energy> joints);

/// The balance at each row: work since t_start and stored energy. Requires that energy_of() succeeded.
enum class EnergyColumn : int { input, kinetic, spring, viscous, dry, error, belt, base, acts, impacts };
inline constexpr int energy_column_count = 10;
Eigen::MatrixXd energy_columns(const motion::Run& run, Whose whose = Whose::all);

/// The balance as a small table, for people.
std::string text(const Energy& energy, const model::Units& units = {});

}  // namespace dinal::analysis
