// The motion between the rows of a run as its integrator leaves it: evaluated anywhere, told in legs for its energy.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "model/excitation.hpp"
#include "model/oscillator.hpp"
#include "text/expected.hpp"

namespace dinal::motion {

/// Torque times rad.
struct Work {
    double input = 0;    ///< of M on the mass
    double viscous = 0;  ///< lost to viscous damping
    double dry = 0;      ///< lost to dry friction
    double belt = 0;     ///< of the moving surface on the mass
    double base = 0;     ///< of the shaking support
    double acts = 0;     ///< of what a user did at his events
    double impacts = 0;  ///< lost at walls
    double kept = 0;     ///< stored in the springs of sliders
};

/// A stretch of smooth motion, integrated as exactly as it was computed. Times are counted from its beginning.
class Leg {
public:
    [[nodiscard]] virtual double length() const = 0;
    [[nodiscard]] virtual double since_start(double t) const = 0;
    /// The work done until then; none before the beginning, all of it after the end.
    [[nodiscard]] virtual Work work(double since_start) const = 0;

protected:
    Leg() = default;
    Leg(const Leg&) = default;
    Leg& operator=(const Leg&) = default;
    ~Leg() = default;
};

class Course {
public:
    explicit Course(const model::Oscillator& system) : system_(system) {}
    Course(const Course&) = delete;
    Course& operator=(const Course&) = delete;
    virtual ~Course() = default;

    [[nodiscard]] const model::Oscillator& system() const { return system_; }
    /// theta and velocity at a time of the run, at the accuracy of its integrator.
    [[nodiscard]] virtual text::Expected<model::State> at(double t) const = 0;

    /// The states of a run that has some, at a time of the run.
    [[nodiscard]] virtual std::vector<double> states_at(double /*t*/) const { return {}; }

    /// Up to this time the motion is kept whole: at() need not ask M again, and legs() tells it. `never` when that is
    /// all of the run; an integrator that only keeps where to begin again has no such time.
    [[nodiscard]] virtual double whole_until() const { return -model::never; }
    /// Times between which the kept motion is smooth, in order: acts and conditions on the motion are among them. Empty
    /// if the events and the breaks of M are all such times.
    [[nodiscard]] virtual std::vector<double> piece_ends() const { return {}; }
    /// In order and without gaps.
    virtual void legs(const std::function<void(const Leg&)>& /*told*/) const {}
    /// What it takes of the memory for the motion between the rows.
    [[nodiscard]] virtual std::size_t bytes() const { return 0; }

private:
    model::Oscillator system_;
};

/// Of a run that went on at the time `from`. None unless both parts have theirs.
std::shared_ptr<const Course> joined(const std::shared_ptr<const Course>& before, double from,
                                     std::shared_ptr<const Course> after);

}  // namespace dinal::motion
