#include "model/slide.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dinal::model {

double longest_step(const Friction& law, const SpeedRange& range, double speed, double first, double second, double C,
                    double I) {
    constexpr double any = std::numeric_limits<double>::infinity();
    constexpr double steepest = 4;  // what exp(-a t) may have for a t: degree 16 follows it then
    if (range.straight) {
        const double a = (C + range.slope) / I;
        const bool begins = speed == range.from || speed == range.to;
        return a < 0 || begins ? steepest / std::fabs(a) : any;
    }
    // Towards greater speeds a law becomes straighter; towards smaller ones what counts is where the step ends.
    double change = law.scale(speed);
    if (first < 0) {
        for (int i = 0; i < 4; ++i) change = law.scale(std::max(0.0, speed - change));
    }
    second += std::fabs(law.slope(speed) * first) / I;
    const double root = std::sqrt(first * first + 2 * second * change) + std::fabs(first);
    return root > 0 ? 2 * change / root : any;
}

}  // namespace dinal::model
