// What can be known about M without asking for its values: that it is constant, its period, that it depends on motion.
#pragma once

#include "model/excitation.hpp"

namespace dinal::model {

/// The shortest period that all terms have in common from time t on; 0 when a term has none, or none is known, or M is
/// constant from then on. A feedback counts by the period that its user has named.
double period_from(const Excitation& excitation, double t);

}  // namespace dinal::model
