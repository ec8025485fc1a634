// The integrators that a user can choose from, one row each; the first is the one that a run takes which names none.
#pragma once

#include <variant>

#include "motion/dinal1989/dinal1989.hpp"
#include "motion/rk4/rk4.hpp"
#include "motion/spectral/spectral.hpp"
#include "text/fixed_text.hpp"

namespace dinal::motion {

using dinal1989::Dinal1989;
using rk4::Rk4;
using spectral::Spectral;

using Integrator = std::variant<Spectral,  //
                                Rk4,       //
                                Dinal1989>;

/// The Lua text of Integrator().
inline constexpr text::FixedText<64> default_integrator{std::variant_alternative_t<0, Integrator>::about.call.name,
                                                        "{}"};

}  // namespace dinal::motion
