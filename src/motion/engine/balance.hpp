// The balance of a system at one moment: torques, accelerations, and the torques of sticking contacts.
#pragma once

#include <optional>
#include <vector>

#include "motion/engine/conditions.hpp"
#include "motion/engine/flow.hpp"
#include "motion/engine/now.hpp"

namespace dinal::motion::engine {

struct Balance {
    std::vector<double> loads, torques, accelerations, holding;
    double blurred = 0;  ///< possible error of the torques from the numerical slopes of belts
};

/// Evaluates the time-only loads of a stretch by their series, so that they need not be evaluated for every row.
class SampledLoads {
public:
    SampledLoads(const Mechanics& mechanics, const Segment& segment) : mechanics_(mechanics), segment_(segment) {}
    /// The load of the body at the point x; empty if the load has no series and must be evaluated.
    [[nodiscard]] std::optional<double> at(std::size_t body, double x);

private:
    const Mechanics& mechanics_;
    const Segment& segment_;
    std::vector<Series> series_;
};

/// Evaluates balances. Changes nothing except that conditions without a decision get one.
class Balances {
public:
    Balances(const Mechanics& mechanics, Conditions& conditions, const Flow& solver);
    /// The total inertia of all bodies.
    double inertia() const { return inertia_; }

    /// Computes the present balance; a contact about to slip counts as slipping. All these functions return false if a
    /// value is not finite.
    bool at_present(const Now& now, const Frame& frame, const Segment& last, Balance& result) {
        const std::vector<double>& departing = now.departing(mechanics_.system(), departing_);
        return at_present({now.t.hi, now.side(), departing}, now, now.mode, frame, last, result);
    }
    /// Computes the balance at `at` in `mode`; the slopes of belts are those of `now`.
    bool at_present(const Moment& at, const Now& now, const Mode& mode, const Frame& frame, const Segment& last,
                    Balance& result);
    /// The balance at the point x of a stretch; `sampled`, if given, supplies its loads.
    bool on_stretch(const Segment& segment, double x, const Moment& at, const Mode& mode, const Frame& frame,
                    Balance& result, SampledLoads* sampled = nullptr);

    /// Returns whether any load depends on the motion, or a spring may jump.
    bool has_feedback() const { return has_feedback_; }

private:
    template <class Rate, class Known>
    bool find(const Moment& at, const Mode& mode, const Frame& frame, const Rate& rate, const Known& known,
              Balance& result);

    const Mechanics& mechanics_;
    Conditions& conditions_;
    const Flow& solver_;
    double inertia_ = 0;  ///< total inertia of all bodies
    bool has_feedback_;
    std::vector<double> belts_, rates_, offsets_, of_group_, lacking_, departing_;
};

/// A state near that of a joint at slip 0.
struct Nearby {
    model::Motion side;         ///< side to which the angle differs
    model::Motion way;          ///< direction of the slip; stuck: slip 0
    double far = 0, speed = 0;  ///< differences of angle and slip
    double gained = 0;          ///< greatest speed that joints at standstill may have gained since
};

/// Returns the velocity of each body if this joint slips at speed 1 and all others hold. If these do not let it slip,
/// only its own bodies move, by their weights.
std::vector<double> slip_alone(const Mechanics& mechanics, Mode mode, std::size_t joint);

/// Returns the moment of this nearby state; each difference is at least the smallest one that survives rounding. `slip`
/// is from slip_alone(); `y` is storage for the state.
Moment just_beside(const Moment& at, const std::vector<double>& slip, const Nearby& there, std::vector<double>& y);

/// Returns by how much the torque on a sticking joint exceeds the holding limit, and sets the direction of breakaway.
/// Only the part of the pull that exceeds the errors of users' states counts, so that touching a limit is not a
/// breakaway.
double excess(const Mechanics& mechanics, std::size_t joint, const Balance& balance, const Mode& mode, const Moment& at,
              model::Motion& towards);

/// The fraction of a pull that remains after subtracting the possible errors of users' states.
inline double known_part(const Mechanics& mechanics) {
    return mechanics.states_of_user() > 0 ? 1 - 3e-12 : 1;
}

}  // namespace dinal::motion::engine
