// Polynomials on a panel -1 <= x <= 1 as Chebyshev series c[0] T0 + c[1] T1 + ...: sampled, integrated, evaluated.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

/// Marks a function that is also compiled for AVX2 and selected by the loader. Sums keep their order, and so their
/// digits. Address sanitizers do not support the selection.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define DINAL_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define DINAL_WIDE
#endif

namespace dinal::motion::chebyshev {

/// Panels are sampled at degree + 1 Chebyshev-Lobatto points; 16 resolves 0.6 natural periods to rounding.
inline constexpr std::size_t degree = 16;
inline constexpr std::size_t points = degree + 1;

template <std::size_t n>
using Series = std::array<double, n>;
using Samples = std::array<double, points>;

/// Four numbers in one register.
using Four __attribute__((vector_size(32))) = double;
/// Sums the rows of a matrix, weighted by the entries of a vector. A row has 4 * `wide` numbers.
template <std::size_t wide>
[[gnu::always_inline]] inline void add_rows(const double* matrix, const double* weights, std::size_t rows,
                                            double* sums) {
    std::array<Four, wide> all{};
    for (std::size_t j = 0; j < rows; ++j) {
        for (std::size_t i = 0; i < wide; ++i, matrix += 4) {
            Four row;
            std::memcpy(&row, matrix, sizeof row);
            all[i] += weights[j] * row;
        }
    }
    std::memcpy(sums, all.data(), sizeof all);
}

/// cos(pi j/16) for any j.
constexpr double cosine(std::size_t j) {
    constexpr std::array<double, 9> quarter = {1,
                                               0.98078528040323044913,
                                               0.92387953251128675613,
                                               0.83146961230254523708,
                                               0.70710678118654752440,
                                               0.55557023301960222474,
                                               0.38268343236508977173,
                                               0.19509032201612826785,
                                               0};
    const std::size_t turn = j % (2 * degree);
    const std::size_t half = turn <= degree ? turn : 2 * degree - turn;
    return half <= degree / 2 ? quarter[half] : -quarter[degree - half];
}

/// The points of a panel, from -1 to 1.
inline constexpr Samples nodes = [] {
    Samples x{};
    for (std::size_t j = 0; j <= degree; ++j) x[j] = -cosine(j);
    return x;
}();

/// The greatest distance between two nodes, as a part of the panel.
inline constexpr double widest_gap = (nodes[degree / 2 + 1] - nodes[degree / 2]) / 2;

/// The polynomial through values at the nodes. Equal values give a constant, exactly.
Series<points> fit(const Samples& f);
Samples at_nodes(const Series<points>& c);

/// The series of degree 16 with the same values at the nodes as a longer one, because T17 = T15 and T18 = T14 there.
template <std::size_t n>
Series<points> folded(const Series<n>& c) {
    static_assert(n > points && n <= 2 * degree);
    Series<points> low{};
    for (std::size_t k = 0; k < points; ++k) low[k] = c[k];
    for (std::size_t k = points; k < n; ++k) low[2 * degree - k] += c[k];
    return low;
}
template <std::size_t n>
Samples at_nodes(const Series<n>& c) {
    return at_nodes(folded(c));
}

/// Clenshaw's sum, for even and odd terms separately: T(2k) = Tk(y) and T(2k+1) = x Pk(y) with y = 2 x^2 - 1, P0 = 1,
/// P1 = 2 y - 1 and the recurrence of Tk. The two chains of half the length run in parallel.
template <std::size_t n>
double value(const Series<n>& c, double x) {
    const double y = 2 * x * x - 1, twice = 2 * y;
    double even = 0, even_before = 0, odd = 0, odd_before = 0;
    constexpr std::size_t pairs = n / 2;
    if constexpr (n % 2 != 0) even = c[n - 1];
    for (std::size_t k = pairs; k > 0; --k) {
        const double next_odd = (c[2 * k - 1] - odd_before) + twice * odd;
        odd_before = odd, odd = next_odd;
        if (k == 1) break;
        const double next_even = (c[2 * k - 2] - even_before) + twice * even;
        even_before = even, even = next_even;
    }
    return ((c[0] - even_before) + y * even) + x * (odd - odd_before);
}

/// f(0) + f(1) + ... + f(n - 1), in four independent partial sums that the processor adds in parallel.
template <std::size_t n, class F>
double sum_of(F f) {
    std::array<double, 4> sums{};
    std::size_t k = 0;
    for (; k + 4 <= n; k += 4) {
        for (std::size_t i = 0; i < 4; ++i) sums[i] += f(k + i);
    }
    for (; k < n; ++k) sums[k % 4] += f(k);
    return (sums[0] + sums[2]) + (sums[1] + sums[3]);
}

/// 1/(2 k).
template <std::size_t n>
inline constexpr Series<n> half_inverses = [] {
    Series<n> all{};
    for (std::size_t k = 1; k < n; ++k) all[k] = 0.5 / static_cast<double>(k);
    return all;
}();

/// The antiderivative that has the value `at_left` at x = -1.
template <std::size_t n>
Series<n + 1> integral(const Series<n>& f, double at_left) {
    Series<n + 1> F{};
    F[1] = f[0] - f[2] / 2;
    for (std::size_t k = 2; k + 1 < n; ++k) F[k] = (f[k - 1] - f[k + 1]) * half_inverses<n + 1>[k];
    for (std::size_t k = n - 1; k <= n; ++k) F[k] = f[k - 1] * half_inverses<n + 1>[k];
    F[0] = at_left - sum_of<n>([&](std::size_t k) { return k % 2 == 0 ? -F[k + 1] : F[k + 1]; });
    return F;
}

template <std::size_t n>
Series<n - 1> derivative(const Series<n>& f) {
    Series<n - 1> d{};
    for (std::size_t k = n - 1; k > 0; --k) {
        d[k - 1] = 2 * static_cast<double>(k) * f[k] + (k + 1 < n - 1 ? d[k + 1] : 0);
    }
    d[0] /= 2;
    return d;
}

/// The exact product, from Tj Tk = (T(j+k) + T|j-k|)/2.
template <std::size_t n, std::size_t m>
Series<n + m - 1> product(const Series<n>& f, const Series<m>& g) {
    Series<n + m - 1> c{};
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < m; ++k) {
            const double half = f[j] * g[k] / 2;
            c[j + k] += half;
            c[j > k ? j - k : k - j] += half;
        }
    }
    return c;
}

/// sum |c[k]|, which is at least max |f|.
template <std::size_t n>
double size(const Series<n>& c) {
    return sum_of<n>([&](std::size_t k) { return std::fabs(c[k]); });
}

/// A lower bound of f.
template <std::size_t n>
double least_bound(const Series<n>& c) {
    return c[0] - (size(c) - std::fabs(c[0]));
}

/// The size of the last two coefficients, about the error of a series that has decayed. Evenly spaced jumps make every
/// second coefficient zero, sometimes the last one; so the two before are included, which are far smaller for a smooth
/// function.
inline double tail(const Series<points>& c) {
    constexpr double by_far = 1e-4;
    const double before = std::max(std::fabs(c[degree - 3]), std::fabs(c[degree - 2]));
    return std::max(std::max(std::fabs(c[degree - 1]), std::fabs(c[degree])), by_far * before);
}

/// Bounds of |Tk'|, k^2, of |Tk''|, k^2 (k^2 - 1)/3, and of |Tk'''|, k^2 (k^2 - 1)(k^2 - 4)/15.
template <std::size_t n>
inline constexpr std::array<Series<n>, 3> derivative_bounds = [] {
    std::array<Series<n>, 3> all{};
    for (std::size_t k = 0; k < n; ++k) {
        const auto k2 = static_cast<double>(k * k);
        all[0][k] = k2;
        all[1][k] = k2 * (k2 - 1) / 3;
        all[2][k] = k < 3 ? 0 : k2 * (k2 - 1) * (k2 - 4) / 15;
    }
    return all;
}();

/// A bound of |f'|, |f''| or |f'''|.
template <std::size_t order, std::size_t n>
double derivative_bound(const Series<n>& c) {
    static_assert(order >= 1 && order <= 3);
    return sum_of<n>([&](std::size_t k) { return std::fabs(c[k]) * derivative_bounds<n>[order - 1][k]; });
}

}  // namespace dinal::motion::chebyshev
