#include "motion/roughness.hpp"

#include <algorithm>
#include <cmath>

#include "motion/chebyshev.hpp"

namespace dinal::motion {

Roughness roughness(const std::function<double(double)>& function, const std::array<double, 3>& starts, double length) {
    namespace cheb = chebyshev;
    Roughness found;
    std::array<double, 3> tails{};
    std::size_t stretch = 0;
    for (const double start : starts) {
        cheb::Samples values{};
        for (std::size_t j = 0; j < cheb::points; ++j) {
            values[j] = function(start + length * (1 + cheb::nodes[j]) / 2);
            if (!std::isfinite(values[j])) return {};
            found.size = std::max(found.size, std::fabs(values[j]));
        }
        tails.at(stretch++) = cheb::tail(cheb::fit(values));
    }
    std::sort(tails.begin(), tails.end());
    found.usual = tails[1], found.most = tails[2];
    return found;
}

}  // namespace dinal::motion
