// Properties of M that are known without its values: the common period.
#pragma once

#include "model/excitation.hpp"

namespace dinal::model {

/// The shortest common period of all terms from time t on; 0 if there is none, it is unknown, or M is constant from t
/// on. A feedback has the period that its user declared.
double period_from(const Excitation& excitation, double t);

}  // namespace dinal::model
