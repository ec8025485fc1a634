#include "motion/hybrid/integration.hpp"

#include <cstddef>

namespace dinal::motion::hybrid {

const Integration& integration() {
    namespace chebyshev = spectral::chebyshev;
    static const Integration weights = [] {
        Integration rows = Integration::Zero();
        for (std::size_t j = 0; j < chebyshev::points; ++j) {
            chebyshev::Samples unit{};
            unit[j] = 1;
            const auto F = chebyshev::integral(chebyshev::fit(unit), 0.0);
            for (std::size_t i = 1; i < chebyshev::points; ++i) {
                rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                    chebyshev::value(F, chebyshev::nodes[i]);
            }
        }
        return rows;
    }();
    return weights;
}

}  // namespace dinal::motion::hybrid
