#include "motion/spectral/spectral.hpp"

#include <algorithm>

#include "motion/engine/part.hpp"
#include "motion/simulate.hpp"

namespace dinal::motion::spectral {

Resolution Spectral::resolution(const model::Oscillator& system) const {
    constexpr double parts = chebyshev::degree;
    const double own = longest_panel * system.natural_period();
    const double asked = narrowest / chebyshev::widest_gap;
    if (asked < std::min(max_panel, own)) return {"narrowest", asked / parts, false};
    return max_panel < own ? Resolution{"max_panel/16", max_panel / parts, false}
                           : Resolution{"T0/27", own / parts, false};
}

double Spectral::widest_looks() const {
    // No pulse may fit between the samples at both ends of the widest gap.
    constexpr double within = chebyshev::widest_gap * (1 + 1e-9);
    return narrowest / within;
}

double Spectral::longest(const Problem& problem) const {
    const model::Oscillator& system = problem.system;
    const double most = problem.drive.M().has_script() ? std::min(max_panel, widest_looks()) : max_panel;
    return std::min(most, system.has_spring() ? longest_panel * system.natural_period()
                                              : part_of_run * (problem.window.end - problem.window.start));
}

Run Spectral::run(const Problem& problem) const {
    return engine::run(problem, {.tolerance = tolerance, .longest = longest(problem)});
}

}  // namespace dinal::motion::spectral
