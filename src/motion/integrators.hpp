// The integrators, one row each, and the default.
#pragma once

#include <variant>

#include "model/drive.hpp"
#include "motion/dinal1989/dinal1989.hpp"
#include "motion/dopri5/dopri5.hpp"
#include "motion/exact/exact.hpp"
#include "motion/rk4/rk4.hpp"
#include "motion/spectral/spectral.hpp"
#include "text/words.hpp"

namespace dinal::motion {

using dinal1989::Dinal1989;
using dopri5::Dopri5;
using exact::Exact;
using rk4::Rk4;
using spectral::Spectral;

using Integrator = std::variant<Spectral,  //
                                Exact,     //
                                Rk4,       //
                                Dopri5,    //
                                Dinal1989>;

/// The default integrator: exact if it applies, otherwise spectral, which supports everything.
Integrator integrator_for(const model::Oscillator& system, const model::Drive& drive);
/// The default integrator as its Lua expression.
inline constexpr text::FixedText<64> usual_integrator{Exact::about.call.name, "{}"};
inline constexpr text::FixedText<96> default_integrator{usual_integrator.c_str(), " if it supports M, otherwise ",
                                                        Spectral::about.call.name, "{}"};

}  // namespace dinal::motion
