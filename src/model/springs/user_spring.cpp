#include "model/springs/user_spring.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace dinal::model::springs {

namespace {

/// Lobatto's rule with seven points, exact to degree 11. It includes both ends, so that a corner just before an end
/// shows.
constexpr std::array<double, 4> inner_nodes = {0, 0.468848793470714213803771881907, 0.830223896278566929872032213968,
                                               1};
constexpr std::array<double, 4> inner_weights = {0.487619047619047619047619047619, 0.43174538120986262341787102228,
                                                 0.27682604736156594801070040629, 0.047619047619047619047619047619};
/// The limit of bisections around a kink; the remaining error is negligible.
constexpr int most_halvings = 48;

double over(terms::UserFunction& torque, double a, double b) {
    const double middle = a + (b - a) / 2, half = (b - a) / 2;
    double sum = inner_weights[0] * torque.value(middle, {});
    for (std::size_t i = 1; i < inner_nodes.size(); ++i) {
        const double off = half * inner_nodes[i];
        sum += inner_weights[i] * (torque.value(middle - off, {}) + torque.value(middle + off, {}));
    }
    return half * sum;
}

/// Adaptive quadrature: compares the whole with its two halves and bisects again if they differ by more than `allowed`.
double refined_over(terms::UserFunction& torque, double a, double b, double whole, double allowed, int halvings) {
    const double middle = a + (b - a) / 2;
    const double left = over(torque, a, middle), right = over(torque, middle, b);
    const double sum = left + right;
    if (!(std::fabs(sum - whole) > allowed) || halvings == 0) return sum;
    return refined_over(torque, a, middle, left, allowed / 2, halvings - 1) +
           refined_over(torque, middle, b, right, allowed / 2, halvings - 1);
}

}  // namespace

double UserSpring::energy(double theta) const {
    const double whole = over(*function, 0, theta);
    const double size = std::fabs(theta) * std::fabs(torque(theta)) + std::fabs(whole);
    return refined_over(*function, 0, theta, whole, 2 * std::numeric_limits<double>::epsilon() * size, most_halvings);
}

}  // namespace dinal::model::springs
