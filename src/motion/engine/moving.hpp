// Bodies with prescribed motion: the velocity of a prescribed angle, and the rigid joints that impose it.
#pragma once

#include <memory>
#include <vector>

#include "model/drive.hpp"
#include "model/system.hpp"

namespace dinal::motion::engine {

class VelocityOfAngle;

/// A system whose prescribed motions are imposed by extra rigid joints with moving belts, placed after all other
/// joints.
struct Moving {
    model::System system;
    model::Drive drive;

    /// `longest` is the longest piece over which prescribed angles are sampled, time units.
    Moving(const model::System& given, const model::Drive& its_drive, double start, double longest);
    /// The widest distance of two samples of a prescribed angle between which its motion is not proven, time units; 0
    /// if none.
    double gap() const;

private:
    std::vector<std::shared_ptr<const VelocityOfAngle>> velocities_;
};

}  // namespace dinal::motion::engine
