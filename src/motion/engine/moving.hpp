// Bodies that are moved: the velocity of a given angle, and the rigid joints that move them.
#pragma once

#include "model/drive.hpp"
#include "model/system.hpp"

namespace dinal::motion::engine {

/// A system in which each body that is moved is held by a rigid joint behind all others, as on a belt of its velocity.
struct Moving {
    model::System system;
    model::Drive drive;

    /// `pace` is how long one may look at given angles at first, time units.
    Moving(const model::System& given, const model::Drive& asked, double start, double pace);
};

}  // namespace dinal::motion::engine
