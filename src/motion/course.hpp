// The motion between the rows of a run as its integrator computed it: evaluated at any time, and in legs for its
// energy.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "model/excitation.hpp"
#include "model/oscillator.hpp"
#include "text/expected.hpp"
#include "text/not_copied.hpp"

namespace dinal::motion {

/// Torque times rad.
struct Work {
    double input = 0;    ///< work of M on the mass
    double viscous = 0;  ///< lost to viscous damping
    double dry = 0;      ///< lost to dry friction
    double belt = 0;     ///< work of the moving surface on the mass
    double base = 0;     ///< work of the shaking support
    double acts = 0;     ///< energy added by a user's actions at events
    double impacts = 0;  ///< lost at walls
    double kept = 0;     ///< stored in the springs of sliders
};

/// A smooth part of the motion whose work is integrated with the accuracy of the integrator. Times are counted from the
/// start of the leg.
class Leg {
public:
    virtual double length() const = 0;
    virtual double since_start(double t) const = 0;
    /// The work done from the start of the leg up to the time `since_start`, clamped to the leg.
    virtual Work work(double since_start) const = 0;

protected:
    Leg() = default;
    Leg(const Leg&) = default;
    Leg& operator=(const Leg&) = default;
    ~Leg() = default;
};

class Course : text::NotCopied {
public:
    explicit Course(const model::Oscillator& system) : system_(system) {}
    virtual ~Course() = default;

    const model::Oscillator& system() const { return system_; }
    /// theta and velocity at a time of the run, with the accuracy of its integrator.
    virtual text::Expected<model::State> at(double t) const = 0;

    /// The run's own states at a time; empty if it has none.
    virtual std::vector<double> states_at(double /*t*/) const { return {}; }

    /// The time up to which the motion is stored completely, so that at() need not evaluate M and legs() covers it:
    /// `never` if all of it is. Integrators that only store checkpoints return -never.
    virtual double whole_until() const { return -model::never; }
    /// The ends of smooth pieces, in order; besides events they include user actions and switches of conditions on the
    /// motion. Empty if only events and breaks of M divide the motion.
    virtual std::vector<double> piece_ends() const { return {}; }
    /// Visits the legs in order, without gaps.
    virtual void legs(const std::function<void(const Leg&)>& /*visit*/) const {}
    /// The memory used for the motion between the rows.
    virtual std::size_t bytes() const { return 0; }

private:
    model::Oscillator system_;
};

/// The course of a run and its continuation from the time `from`; null if either is missing.
std::shared_ptr<const Course> joined(const std::shared_ptr<const Course>& before, double from,
                                     std::shared_ptr<const Course> after);

}  // namespace dinal::motion
