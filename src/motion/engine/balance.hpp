// The balance of a system at a moment: its torques, accelerations, and the torques that hold contacts.
#pragma once

#include <optional>
#include <vector>

#include "motion/engine/conditions.hpp"
#include "motion/engine/flow.hpp"
#include "motion/engine/now.hpp"

namespace dinal::motion::engine {

struct Balance {
    std::vector<double> loads, torques, accelerations, holding;
    double blurred = 0;  ///< the possible error of torques because the slopes of belts are differences
};

/// The loads of a stretch that are functions of the time alone, by their series, so that they are not evaluated for
/// every row.
class SampledLoads {
public:
    SampledLoads(const Mechanics& mechanics, const Segment& segment) : mechanics_(mechanics), segment_(segment) {}
    /// Returns none if the load is to be evaluated.
    [[nodiscard]] std::optional<double> at(std::size_t body, double x);

private:
    const Mechanics& mechanics_;
    const Segment& segment_;
    std::vector<Series> series_;
};

/// Evaluates balances. It decides conditions at the present, and changes nothing else.
class Balances {
public:
    Balances(const Mechanics& mechanics, Conditions& conditions, const Flow& solver);
    /// Returns the inertia of all bodies.
    [[nodiscard]] double inertia() const { return inertia_; }

    /// At the present, as contacts are about to move. Returns false if something is not finite; so do the others.
    bool at_present(const Now& now, const Frame& frame, const Segment& last, Balance& result) {
        const std::vector<double>& departing = now.departing(mechanics_.system(), departing_);
        return at_present({now.t.hi, now.side(), departing}, now, now.mode, frame, last, result);
    }
    /// At a moment of the present, in a mode.
    bool at_present(const Moment& at, const Now& now, const Mode& mode, const Frame& frame, const Segment& last,
                    Balance& result);
    /// At the place x of a stretch, with sampled loads if they are given.
    bool on_stretch(const Segment& segment, double x, const Moment& at, const Mode& mode, const Frame& frame,
                    Balance& result, SampledLoads* sampled = nullptr);

    /// Returns whether some load depends on the motion.
    [[nodiscard]] bool has_feedback() const { return has_feedback_; }

private:
    template <class Rate, class Known>
    bool find(const Moment& at, const Mode& mode, const Frame& frame, const Rate& rate, const Known& known,
              Balance& result);

    const Mechanics& mechanics_;
    Conditions& conditions_;
    const Flow& solver_;
    double inertia_ = 0;  ///< of all bodies
    bool has_feedback_;
    std::vector<double> belts_, rates_, offsets_, of_group_, lacking_, departing_;
};

/// A motion beside that of a joint at slip 0.
struct Nearby {
    model::Motion side;  ///< of the angle
    model::Motion way;   ///< of the slip; stuck: none
    double far = 0, speed = 0;
};

/// Returns the moment at which a joint would be there, or as near as is not lost in rounding; `y` is room for its
/// state.
Moment just_beside(const Mechanics& mechanics, const Moment& at, std::size_t joint, const Nearby& there,
                   std::vector<double>& y);

/// Returns how far the torque that holds a joint is beyond what the joint can hold, and which way it would go. Only the
/// part of a pull counts that is right whatever users' states are wrong by: what only touches a limit holds.
double excess(const Mechanics& mechanics, std::size_t joint, const Balance& balance, const Mode& mode, const Moment& at,
              model::Motion& towards);

/// The part of a pull that is right whatever states of the user's are wrong by.
inline double known_part(const Mechanics& mechanics) {
    return mechanics.states_of_user() > 0 ? 1 - 3e-12 : 1;
}

}  // namespace dinal::motion::engine
