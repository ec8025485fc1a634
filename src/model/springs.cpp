#include "model/springs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "text/option.hpp"

namespace dinal::model::springs {

namespace {

double power(double x, int n) {
    double result = 1;
    for (; n > 0; n /= 2) {
        if (n % 2 == 1) result *= x;
        x *= x;
    }
    return result;
}

}  // namespace

/// Horner's scheme from the highest power down, over the nonzero terms.
double PolynomialSpring::torque(double theta) const {
    double sum = 0;
    for (std::size_t i = terms.size(); i-- > 0;) {
        const int below = i == 0 ? 0 : terms[i - 1].first;
        sum = (sum + terms[i].second) * power(theta, terms[i].first - below);
    }
    return sum;
}

double PolynomialSpring::energy(double theta) const {
    double sum = 0;
    for (std::size_t i = terms.size(); i-- > 0;) {
        const int below = i == 0 ? -1 : terms[i - 1].first;
        sum = (sum + terms[i].second / (terms[i].first + 1)) * power(theta, terms[i].first - below);
    }
    return sum;
}

std::optional<text::Error> PolynomialSpring::complaint() const {
    for (const auto& [n, c] : terms) {
        if (std::isfinite(c)) continue;
        return text::Error{.sentence = fmt::format("[{}] = {} must be a finite number", n, c),
                           .option = fmt::format("[{}]", n)};
    }
    return std::nullopt;
}

bool PolynomialSpring::is_odd() const {
    return std::ranges::all_of(terms, [](const auto& term) { return term.first % 2 == 1; });
}

std::string PolynomialSpring::lua_text() const {
    std::string text;
    for (const auto& [n, c] : terms) {
        text += fmt::format("{}[{}] = {}", text.empty() ? "" : ", ", n, text::number_literal(c));
    }
    return "spring.polynomial{ " + text + " }";
}

namespace {

/// Lobatto's rule with seven points, exact to degree 11. It includes both ends, so that a corner just before an end
/// shows.
constexpr std::array<double, 4> inner_nodes = {0, 0.468848793470714213803771881907, 0.830223896278566929872032213968,
                                               1};
constexpr std::array<double, 4> inner_weights = {0.487619047619047619047619047619, 0.43174538120986262341787102228,
                                                 0.27682604736156594801070040629, 0.047619047619047619047619047619};
/// The limit of divisions around a kink; the remaining error is negligible.
constexpr int most_divisions = 64;
/// An interval is divided here, off its middle, because the samples of a staircase may be symmetric about that.
constexpr double first_part = 0.45;

double over(terms::UserFunction& torque, double a, double b) {
    const double middle = a + (b - a) / 2, half = (b - a) / 2;
    double sum = inner_weights[0] * torque.value(middle, {});
    for (std::size_t i = 1; i < inner_nodes.size(); ++i) {
        const double off = half * inner_nodes[i];
        sum += inner_weights[i] * (torque.value(middle - off, {}) + torque.value(middle + off, {}));
    }
    return half * sum;
}

/// Adaptive quadrature: compares the whole with its two parts and divides again if they differ by more than `allowed`.
/// The limit does not shrink with the parts: the rounding of the torque, which does not fade, would divide them all.
double refined_over(terms::UserFunction& torque, double a, double b, double whole, double allowed, int divisions) {
    const double within = a + first_part * (b - a);
    const double left = over(torque, a, within), right = over(torque, within, b);
    const double sum = left + right;
    if (!(std::fabs(sum - whole) > allowed) || divisions == 0) return sum;
    return refined_over(torque, a, within, left, allowed, divisions - 1) +
           refined_over(torque, within, b, right, allowed, divisions - 1);
}

}  // namespace

double UserSpring::energy(double theta) const {
    const double whole = over(*function, 0, theta);
    const double size = std::fabs(theta) * std::fabs(torque(theta)) + std::fabs(whole);
    return refined_over(*function, 0, theta, whole, std::numeric_limits<double>::epsilon() / 2 * size, most_divisions);
}

}  // namespace dinal::model::springs
