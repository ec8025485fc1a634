#include "motion/integrators.hpp"

namespace dinal::motion {

Integrator integrator_for(const model::Oscillator& system, const model::Excitation& excitation,
                          const model::Extras& extras) {
    constexpr Exact exact;
    if (!extras.any() && !exact.wrong_for(system, excitation) && !Exact::goes_slowly(system, excitation)) return exact;
    return Spectral{};
}

}  // namespace dinal::motion
