// Bodies with prescribed motion: the velocity of a prescribed angle, and the rigid joints that impose it.
#pragma once

#include "model/drive.hpp"
#include "model/system.hpp"

namespace dinal::motion::engine {

/// A system in which a rigid joint, behind all others, imposes each prescribed motion like a belt of that velocity.
struct Moving {
    model::System system;
    model::Drive drive;

    /// `pace` is the initial length over which prescribed angles are sampled, time units.
    Moving(const model::System& given, const model::Drive& asked, double start, double pace);
};

}  // namespace dinal::motion::engine
