#include "motion/chebyshev.hpp"

#include <algorithm>

namespace dinal::motion::chebyshev {

namespace {

constexpr std::size_t half = degree / 2;

// Terms of even k are even functions, those of odd k odd ones: each transform splits into two of half the size.

template <std::size_t rows, std::size_t columns>
using Matrix = std::array<std::array<double, columns>, rows>;

/// Row j: T_{2i + parity} at the node j from the left, i = 0, 1, ...
template <std::size_t columns>
constexpr Matrix<half + 1, columns> polynomials(std::size_t parity) {
    Matrix<half + 1, columns> m{};
    for (std::size_t j = 0; j <= half; ++j) {
        for (std::size_t i = 0; i < columns; ++i) {
            const double T = cosine((2 * i + parity) * j);
            m[j][i] = parity == 0 ? T : -T;  // nodes run from -1
        }
    }
    return m;
}
constexpr auto even_terms = polynomials<half + 1>(0);
constexpr auto odd_terms = polynomials<half>(1);

/// Transposes: row i holds one term at all nodes.
template <std::size_t columns>
constexpr Matrix<columns, half + 1> turned(const Matrix<half + 1, columns>& terms) {
    Matrix<columns, half + 1> m{};
    for (std::size_t j = 0; j <= half; ++j) {
        for (std::size_t i = 0; i < columns; ++i) m[i][j] = terms[j][i];
    }
    return m;
}
constexpr auto even_at = turned(even_terms);
constexpr auto odd_at = turned(odd_terms);

/// Row j: the weights of f(x_j) + f(-x_j), or of the difference if odd, in the coefficients of that parity, in `wide`
/// columns.
template <std::size_t wide, std::size_t columns>
constexpr Matrix<half + 1, wide> weights(const Matrix<half + 1, columns>& terms, std::size_t parity) {
    Matrix<half + 1, wide> m{};
    for (std::size_t j = 0; j <= half; ++j) {
        for (std::size_t i = 0; i < columns; ++i) {
            const std::size_t k = 2 * i + parity;
            // Both end points count half in the sum over all points; f(x) + f(-x) contains the middle twice.
            const double share = (j == 0 || j == half ? 1.0 : 2.0) * (k == 0 || k == degree ? 0.5 : 1.0);
            m[j][i] = share * terms[j][i] / static_cast<double>(degree);
        }
    }
    return m;
}
constexpr auto even_weights = weights<half + 4>(even_terms, 0);
constexpr auto odd_weights = weights<half>(odd_terms, 1);

}  // namespace

DINAL_WIDE Series<points> fit(const Samples& f) {
    Series<points> c{};
    if (std::all_of(f.begin(), f.end(), [&](double x) { return x == f[0]; })) {
        c[0] = f[0];
        return c;
    }
    std::array<double, half + 1> sums, differences;
    for (std::size_t j = 0; j <= half; ++j) sums[j] = f[j] + f[degree - j], differences[j] = f[j] - f[degree - j];
    std::array<double, half + 4> even;
    std::array<double, half> odd;
    add_rows<half / 4 + 1>(even_weights[0].data(), sums.data(), half + 1, even.data());
    add_rows<half / 4>(odd_weights[0].data(), differences.data(), half + 1, odd.data());
    for (std::size_t i = 0; i < half; ++i) {
        c[2 * i] = even[i];
        c[2 * i + 1] = odd[i];
    }
    c[degree] = even[half];
    return c;
}

DINAL_WIDE Samples at_nodes(const Series<points>& c) {
    // Loops over all nodes innermost, so that the compiler vectorises.
    std::array<double, half + 1> even{}, odd{};
    for (std::size_t i = 0; i < half; ++i) {
        for (std::size_t j = 0; j <= half; ++j) {
            even[j] += c[2 * i] * even_at[i][j];
            odd[j] += c[2 * i + 1] * odd_at[i][j];
        }
    }
    Samples f{};
    for (std::size_t j = 0; j <= half; ++j) {
        const double whole = even[j] + c[degree] * even_at[half][j];
        f[j] = whole + odd[j];
        f[degree - j] = whole - odd[j];
    }
    return f;
}

}  // namespace dinal::motion::chebyshev
