#include "model/terms/spline.hpp"

#include <cstddef>

namespace dinal::model::terms {
namespace {

/// Solves below[i] x[i - 1] + here[i] x[i] + above[i] x[i + 1] = right[i] in place of `right`. A spline's equations
/// need no pivoting.
void solve_tridiagonal(const std::vector<double>& below, std::vector<double> here, const std::vector<double>& above,
                       std::vector<double>& right) {
    const std::size_t n = here.size();
    for (std::size_t i = 1; i < n; ++i) {
        const double factor = below[i] / here[i - 1];
        here[i] -= factor * above[i - 1];
        right[i] -= factor * right[i - 1];
    }
    right[n - 1] /= here[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) right[i] = (right[i] - above[i] * right[i + 1]) / here[i];
}

}  // namespace

std::vector<double> spline_slopes(std::span<const double> t, std::span<const double> values) {
    const std::size_t n = t.size();
    if (n < 2) return std::vector<double>(n, 0.0);
    std::vector<double> h(n - 1), rise(n - 1);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        h[i] = t[i + 1] - t[i];
        rise[i] = (values[i + 1] - values[i]) / h[i];
    }
    if (n == 2) return {rise[0], rise[0]};
    if (n == 3) {
        const double bend = (rise[1] - rise[0]) / (h[0] + h[1]);
        return {rise[0] - bend * h[0], rise[0] + bend * h[0], rise[1] + bend * h[1]};
    }
    std::vector<double> below(n, 0.0), here(n), above(n, 0.0), right(n);
    const double first = h[0] + h[1], last = h[n - 2] + h[n - 3];
    here[0] = h[1], above[0] = first;
    right[0] = ((h[0] + 2 * first) * h[1] * rise[0] + h[0] * h[0] * rise[1]) / first;
    for (std::size_t i = 1; i + 1 < n; ++i) {
        below[i] = h[i], here[i] = 2 * (h[i - 1] + h[i]), above[i] = h[i - 1];
        right[i] = 3 * (h[i] * rise[i - 1] + h[i - 1] * rise[i]);
    }
    below[n - 1] = last, here[n - 1] = h[n - 3];
    right[n - 1] = (h[n - 2] * h[n - 2] * rise[n - 3] + (2 * last + h[n - 2]) * h[n - 3] * rise[n - 2]) / last;
    solve_tridiagonal(below, here, above, right);
    return right;
}

std::vector<double> periodic_spline_slopes(std::span<const double> t, std::span<const double> values, double period) {
    const std::size_t n = t.size();
    if (n < 2) return std::vector<double>(n, 0.0);
    std::vector<double> h(n), rise(n);
    for (std::size_t i = 0; i < n; ++i) {
        const bool ends = i + 1 == n;
        h[i] = (ends ? t[0] + period : t[i + 1]) - t[i];
        rise[i] = ((ends ? values[0] : values[i + 1]) - values[i]) / h[i];
    }
    std::vector<double> below(n), here(n), above(n), right(n);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t before = (i + n - 1) % n;
        below[i] = h[i], here[i] = 2 * (h[before] + h[i]), above[i] = h[before];
        right[i] = 3 * (h[i] * rise[before] + h[before] * rise[i]);
    }
    if (n == 2) {
        // With two points, both neighbours of a point are the same.
        const double side = below[0] + above[0], other = below[1] + above[1];
        const double determinant = here[0] * here[1] - side * other;
        return {(right[0] * here[1] - side * right[1]) / determinant,
                (here[0] * right[1] - other * right[0]) / determinant};
    }
    // The corners of the matrix are a rank-one correction (Sherman and Morrison).
    const double corner = -here[0], ratio = below[0] / corner;
    std::vector<double> border(n, 0.0), diagonal = here;
    border[0] = corner, border[n - 1] = above[n - 1];
    diagonal[0] -= corner;
    diagonal[n - 1] -= above[n - 1] * ratio;
    solve_tridiagonal(below, diagonal, above, right);
    solve_tridiagonal(below, diagonal, above, border);
    const double part = (right[0] + ratio * right[n - 1]) / (1 + border[0] + ratio * border[n - 1]);
    for (std::size_t i = 0; i < n; ++i) right[i] -= part * border[i];
    return right;
}

}  // namespace dinal::model::terms
