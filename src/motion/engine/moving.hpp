// Bodies that are moved: the velocity of a given angle, and the rigid joints that move them.
#pragma once

#include <memory>
#include <vector>

#include "model/drive.hpp"
#include "model/system.hpp"

namespace dinal::motion::engine {

class VelocityOfAngle;

/// A system in which each body that is moved is held by a rigid joint behind all others, as on a belt of its velocity.
struct Moving {
    model::System system;
    model::Drive drive;

    /// No look at a given angle is longer than `longest`, time units.
    Moving(const model::System& given, const model::Drive& asked, double start, double longest);
    /// The longest between two looks at an angle of which nobody knows what it does between them; 0 without such.
    [[nodiscard]] double gap() const;

private:
    std::vector<std::shared_ptr<const VelocityOfAngle>> velocities_;
};

}  // namespace dinal::motion::engine
