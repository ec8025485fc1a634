// The equation of motion on one panel, solved as a Chebyshev series in a time that grows with its length.
#pragma once

#include "motion/spectral/chebyshev.hpp"

namespace dinal::motion::spectral {

/// w + a v + b p = r on -1 <= x <= 1, with v' = w, p' = v and p(-1) = 0, v(-1) = v0: the tau method.
///
/// For a panel of 2 h time units, w = h^2 theta'', v = h theta', p = theta - theta0, and then a = h C/I, b = h^2 k/I,
/// r = h^2 (M - s Rd - k theta0)/I. b <= 4 (h w0 <= 2) keeps the elimination well-conditioned; a may be anything.
class PanelEquation {
public:
    /// The elimination depends on a and b alone and is kept while they stay the same.
    void prepare(double a, double b);
    /// w. Of a, the part `relative` acts on v - v0 only: a steep line of friction is known from where it begins.
    [[nodiscard]] chebyshev::Series<chebyshev::points> solve(const chebyshev::Series<chebyshev::points>& r, double v0,
                                                             double relative = 0) const;

private:
    static constexpr std::size_t n = chebyshev::points;
    template <std::size_t size>
    using Series = chebyshev::Series<size>;

    double a_ = 0, b_ = 0;
    bool ready_ = false;
    // Row k, once the higher coefficients are eliminated: w[k] = alpha[k] + beta[k] w[k-1] + gamma[k] w[k-2], and
    // alpha[k] = inverse[k] r[k] - upper1[k] alpha[k+1] - upper2[k] alpha[k+2].
    Series<n> inverse_{}, upper1_{}, upper2_{}, beta_{}, gamma_{};
    Series<n> from_w0_{}, from_w1_{};               // the solutions of w[0] = 1 and of w[1] = 1 without load
    Series<n> row0_{}, row1_{};                     // the first two rows, with the values at x = -1 put in
    double m00_ = 0, m01_ = 0, m10_ = 0, m11_ = 0;  // inverse of what they become for w[0] and w[1]
};

}  // namespace dinal::motion::spectral
