#include "motion/integrators.hpp"

namespace dinal::motion {

Integrator integrator_for(const model::Oscillator& system, const model::Drive& drive) {
    constexpr Exact exact;
    if (!drive.has_more() && !exact.wrong_for(system, drive.M()) && !Exact::goes_slowly(system, drive.M()))
        return exact;
    return Spectral{};
}

}  // namespace dinal::motion
