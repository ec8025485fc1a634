#include "model/springs/polynomial_spring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

}  // namespace dinal::model::springs
