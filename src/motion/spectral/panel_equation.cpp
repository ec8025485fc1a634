#include "motion/spectral/panel_equation.hpp"

namespace dinal::motion::spectral {

using chebyshev::degree;
using chebyshev::Series;

namespace {

constexpr std::size_t n = chebyshev::points;

/// What the unit series w = T_j contributes to v and p at x = -1 and to their lowest coefficients.
struct EndWeights {
    Series<n> v_sum{};  ///< sum over k >= 1 of (-1)^k v[k]: v[0] is v0 minus this
    Series<n> p_sum{};  ///< sum over k >= 2 of (-1)^k p[k]
    Series<n> v1{}, v2{};
};
constexpr EndWeights end_weights = [] {
    EndWeights e{};
    for (std::size_t j = 0; j < n; ++j) {
        std::array<double, n + 3> w{}, v{};
        w[j] = 1;
        for (std::size_t k = 1; k <= n; ++k) {
            const double below = k == 1 ? 2 * w[0] : w[k - 1];
            v[k] = (below - w[k + 1]) / (2 * static_cast<double>(k));
            e.v_sum[j] += k % 2 == 0 ? v[k] : -v[k];
        }
        for (std::size_t k = 2; k <= n + 1; ++k) {
            const double p = (v[k - 1] - v[k + 1]) / (2 * static_cast<double>(k));
            e.p_sum[j] += k % 2 == 0 ? p : -p;
        }
        e.v1[j] = v[1];
        e.v2[j] = v[2];
    }
    return e;
}();

double dot(const Series<n>& x, const Series<n>& y) {
    return chebyshev::sum_of<n>([&](std::size_t k) { return x[k] * y[k]; });
}

}  // namespace

// Row k >= 2 of the equation, from v[k] = (w[k-1] - w[k+1])/(2k) applied twice, is pentadiagonal:
//     A w[k-2] + B w[k-1] + D w[k] - B w[k+1] + E w[k+2] = r[k].
// The rows are eliminated from the highest down: there they are dominated by their diagonal, and every pivot is a sum
// of positive terms (a enters by its square only), so nothing needs to be exchanged, however stiff the system is.
void PanelEquation::prepare(double a, double b) {
    if (ready_ && a == a_ && b == b_) return;
    a_ = a, b_ = b, ready_ = true;
    double beta1 = 0, gamma1 = 0, beta2 = 0, gamma2 = 0;  // of rows k + 1 and k + 2
    for (std::size_t k = degree; k >= 2; --k) {
        const auto x = static_cast<double>(k);
        const double A = k == 2 ? b / 4 : b / (4 * x * (x - 1));
        const double B = a / (2 * x);
        const double D = 1 - b / (2 * (x * x - 1));
        const double E = b / (4 * x * (x + 1));
        const double F = -B + E * beta2;
        const double inverse = 1 / (D + E * gamma2 + F * beta1);
        inverse_[k] = inverse;
        upper1_[k] = F * inverse, upper2_[k] = E * inverse;
        beta_[k] = -(B + F * gamma1) * inverse;
        gamma_[k] = -A * inverse;
        beta2 = beta1, gamma2 = gamma1, beta1 = beta_[k], gamma1 = gamma_[k];
    }
    from_w0_[0] = 1, from_w0_[1] = 0, from_w1_[0] = 0, from_w1_[1] = 1;
    for (std::size_t k = 2; k < n; ++k) {
        from_w0_[k] = beta_[k] * from_w0_[k - 1] + gamma_[k] * from_w0_[k - 2];
        from_w1_[k] = beta_[k] * from_w1_[k - 1] + gamma_[k] * from_w1_[k - 2];
    }
    // Row 1: w1 + a v1 + b p1 with p1 = v[0] - v2/2, and row 0: w0 + a v[0] + b p[0] with p[0] = p1 - p_sum.
    for (std::size_t j = 0; j < n; ++j) {
        const double p1 = -end_weights.v_sum[j] - end_weights.v2[j] / 2;
        row0_[j] = (j == 0 ? 1 : 0) - a * end_weights.v_sum[j] + b * (p1 - end_weights.p_sum[j]);
        row1_[j] = (j == 1 ? 1 : 0) + a * end_weights.v1[j] + b * p1;
    }
    const double r00 = dot(row0_, from_w0_), r01 = dot(row0_, from_w1_);
    const double r10 = dot(row1_, from_w0_), r11 = dot(row1_, from_w1_);
    const double determinant = r00 * r11 - r01 * r10;
    m00_ = r11 / determinant, m01_ = -r01 / determinant, m10_ = -r10 / determinant, m11_ = r00 / determinant;
}

Series<n> PanelEquation::solve(const Series<n>& r, double v0, double relative) const {
    Series<n> w{};
    double alpha1 = 0, alpha2 = 0;
    for (std::size_t k = degree; k >= 2; --k) {
        w[k] = (inverse_[k] * r[k] - upper2_[k] * alpha2) - upper1_[k] * alpha1;
        alpha2 = alpha1, alpha1 = w[k];
    }
    for (std::size_t k = 3; k < n; ++k) w[k] += beta_[k] * w[k - 1] + gamma_[k] * (k == 3 ? 0 : w[k - 2]);
    const double s0 = r[0] - ((a_ - relative) + b_) * v0 - dot(row0_, w);
    const double s1 = r[1] - b_ * v0 - dot(row1_, w);
    const double w0 = m00_ * s0 + m01_ * s1, w1 = m10_ * s0 + m11_ * s1;
    for (std::size_t k = 0; k < n; ++k) w[k] += w0 * from_w0_[k] + w1 * from_w1_[k];
    return w;
}

}  // namespace dinal::motion::spectral
