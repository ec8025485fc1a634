#include "motion/engine/newton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "motion/complex_product.hpp"

namespace dinal::motion::engine {

namespace {

constexpr double clear_of_noise = 1e4;                             // factor by which differences must exceed noise
constexpr double least_difference = 1e-8, most_difference = 1e-4;  // increment of differences, relative to the variable
constexpr std::size_t most_factors = 24;
constexpr Eigen::Index few_unknowns = 8;    // with so few unknowns matrices are dense, even for a chain
constexpr Eigen::Index many_unknowns = 64;  // with so many unknowns even wide bands are not inverted
using Complex = std::complex<double>;

/// Solves with the LU factors of a banded matrix; the diagonal holds the inverse pivots.
void solve_band(const Complex* rows, Eigen::Index size, Eigen::Index band, Complex* x) {
    const Eigen::Index wide = 2 * band + 1;
    for (Eigen::Index r = 1; r < size; ++r) {
        const Complex* const row = rows + r * wide + band - r;
        for (Eigen::Index c = std::max<Eigen::Index>(0, r - band); c < r; ++c) x[r] -= product(row[c], x[c]);
    }
    for (Eigen::Index r = size; r-- > 0;) {
        const Complex* const row = rows + r * wide + band - r;
        for (Eigen::Index c = r + 1; c <= std::min(size - 1, r + band); ++c) x[r] -= product(row[c], x[c]);
        x[r] = product(row[r], x[r]);
    }
}

/// Factors a banded matrix into L and U without pivoting, which springs and dampers do not need. Returns false if a
/// pivot is tiny.
bool eliminate_band(Complex* rows, Eigen::Index size, Eigen::Index band) {
    const Eigen::Index wide = 2 * band + 1;
    const auto at = [=](Eigen::Index r, Eigen::Index c) -> Complex& { return rows[r * wide + band + c - r]; };
    constexpr double nothing = 1e-6;
    for (Eigen::Index k = 0; k < size; ++k) {
        const Eigen::Index last = std::min(size - 1, k + band);
        double greatest = 0;
        for (Eigen::Index c = k; c <= last; ++c) greatest = std::max(greatest, std::norm(at(k, c)));
        if (!(std::norm(at(k, k)) > nothing * nothing * greatest)) return false;
        at(k, k) = 1.0 / at(k, k);
        for (Eigen::Index r = k + 1; r <= last; ++r) {
            const Complex part = at(r, k) = product(at(r, k), at(k, k));
            for (Eigen::Index c = k + 1; c <= last; ++c) at(r, c) -= product(part, at(k, c));
        }
    }
    return true;
}

/// Row i: the integral from -1 to node i of the polynomial through values at the nodes.
using Integration = Eigen::Matrix<double, node_count, node_count>;
const Integration& integration() {
    static const Integration weights = [] {
        Integration rows = Integration::Zero();
        for (std::size_t j = 0; j < node_count; ++j) {
            Nodes unit{};
            unit[j] = 1;
            const auto F = cheb::integral(cheb::fit(unit), 0.0);
            for (std::size_t i = 1; i < node_count; ++i) {
                rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = cheb::value(F, cheb::nodes[i]);
            }
        }
        return rows;
    }();
    return weights;
}

/// The eigenvalues (one of each conjugate pair) of the matrix that integrates from the first node to the others, and
/// the transformation to its eigenvectors and back. Each eigenvalue has a coefficient; its real and imaginary parts are
/// adjacent.
struct IntegrationModes {
    using Matrix = Eigen::Matrix<double, node_count - 1, node_count - 1>;
    std::vector<std::complex<double>> values{};
    /// indices of real and imaginary part; the second is -1 for a real coefficient
    std::vector<std::pair<int, int>> places{};
    Matrix from_nodes, to_nodes;
};
const IntegrationModes& integration_modes() {
    static const IntegrationModes modes = [] {
        IntegrationModes made;
        const IntegrationModes::Matrix once = integration().bottomRightCorner<node_count - 1, node_count - 1>();
        const algebra::Eigenpairs pairs = algebra::eigenpairs(once);
        int column = 0;
        for (int i = 0; i < once.rows(); ++i) {
            const std::complex<double> value = pairs.values(i);
            if (value.imag() < 0) continue;
            made.values.push_back(value);
            made.places.emplace_back(column, value.imag() > 0 ? column + 1 : -1);
            made.to_nodes.col(column++) = pairs.vectors.col(i).real();
            if (value.imag() > 0) made.to_nodes.col(column++) = -pairs.vectors.col(i).imag();
        }
        made.from_nodes = algebra::inverse(Eigen::MatrixXd(made.to_nodes));
        return made;
    }();
    return modes;
}

/// Multiplies a column-major matrix of `inner` rows by a vector.
DINAL_WIDE void multiply(const double* matrix, const double* vector, std::size_t columns, double* product) {
    cheb::add_rows<inner / 4>(matrix, vector, columns, product);
}

/// The inverse of a matrix by elimination with pivoting. A general decomposition takes six times as long.
using Inner = Eigen::Matrix<double, inner, inner>;
DINAL_WIDE Inner inverse_of(Inner A) {
    std::array<std::size_t, inner> pivots{};
    const auto column = [&A](std::size_t k) { return A.data() + k * inner; };
    for (std::size_t k = 0; k < inner; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < inner; ++i) {
            if (std::fabs(column(i)[k]) > std::fabs(column(pivot)[k])) pivot = i;
        }
        pivots[k] = pivot;
        if (pivot != k) std::swap_ranges(column(k), column(k) + inner, column(pivot));
        std::array<double, inner> own;
        std::copy(column(k), column(k) + inner, own.begin());
        const double by = 1 / own[k];
        own[k] = 1;
        for (double& each : own) each *= by;
        for (std::size_t i = 0; i < inner; ++i) {
            double* const other = column(i);
            const double part = other[k];
            other[k] = 0;
            for (std::size_t j = 0; j < inner && i != k; ++j) other[j] -= part * own[j];
        }
        std::copy(own.begin(), own.end(), column(k));
    }
    for (std::size_t k = inner; k-- > 0;) {
        if (pivots[k] == k) continue;
        for (std::size_t i = 0; i < inner; ++i) std::swap(column(i)[k], column(i)[pivots[k]]);
    }
    return A;
}

/// Returns the greatest column sum of magnitudes (the 1-norm).
template <class Matrix>
double norm_of(const Matrix& A) {
    return A.cwiseAbs().colwise().sum().maxCoeff();
}

/// Returns twice the norm of A minus the unit matrix, plus rounding, if the inverse is accurate to rounding; otherwise
/// 0.
template <class Matrix>
double off_if_accurate(const Matrix& A, const Matrix& inverse) {
    // limit of condition per row: the error of an inverse is at most its condition times rounding
    constexpr double well = 18.75;
    if (!(norm_of(A) * norm_of(inverse) < well * static_cast<double>(A.rows()))) return 0;
    return 2 * norm_of(Matrix(A - Matrix::Identity(A.rows(), A.cols()))) + rounding;
}

}  // namespace

void integrate(const Nodes& values, double h, Nodes& sums) {
    static const Eigen::Matrix<double, inner, node_count> rows = integration().bottomRows<inner>();
    multiply(rows.data(), values.data(), node_count, sums.data() + 1);
    sums[0] = 0;
    for (double& sum : sums) sum *= h;
}

void Newton::begin(const Mode& mode, const Frame& frame) {
    if (of_ == frame.bodies && pressed_ == mode.presses && sliding_ == mode.sliders) return;
    known_ = false, of_ = frame.bodies, pressed_ = mode.presses, sliding_ = mode.sliders;
}

bool Newton::find(const Segment& s, const Mode& mode, const Frame& frame, std::size_t node, const Floor& floor) {
    const std::size_t n = mechanics_.bodies(), m = mechanics_.states();
    const std::size_t groups = frame.groups(), rows = groups + m, columns = 2 * groups + m;
    slopes_.setZero(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    factors_.clear(), last_factors_ = nullptr, order_.clear();
    known_ = true;
    if (!mechanics_.nonlinear()) {
        find_linear(frame);
        return true;
    }
    const double noise = floor.noise_of_torques(n);
    std::vector<double> y(s.y.size());
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = s.y[k][node];
    const auto torques = [&](std::vector<double>& out) {
        std::vector<double> belts(mechanics_.joints()), loads(mechanics_.joints()), of_bodies;
        for (std::size_t joint = 0; joint < belts.size(); ++joint) {
            belts[joint] = s.belts[joint][node], loads[joint] = s.loads[joint][node];
        }
        const Moment at{s.times[node], s.side(node), y};
        mechanics_.torques(at, mode, belts, loads, of_bodies);
        out.assign(rows, 0);
        for (std::size_t i = 0; i < n; ++i) {
            for (const auto& [group, by] : frame.bodies[i]) out[group] += by * of_bodies[i];
        }
        for (std::size_t g = 0; g < groups; ++g) out[g] /= frame.inertia[g];
        mechanics_.rates(at, out.data() + groups, &mode);
        return std::all_of(out.begin(), out.end(), [](double x) { return std::isfinite(x); });
    };
    std::vector<double> above, below;
    for (std::size_t c = 0; c < columns; ++c) {
        // The entries of y that move together, and their range of motion on the segment.
        std::vector<std::pair<std::size_t, double>> moved;
        if (c < 2 * groups) {
            const std::size_t from = c < groups ? 0 : n;
            for (std::size_t i = 0; i < n; ++i) {
                for (const auto& [group, by] : frame.bodies[i]) {
                    if (group == c % groups) moved.emplace_back(from + i, by);
                }
            }
        } else {
            moved.emplace_back(2 * n + (c - 2 * groups), 1);
        }
        double spread = 0, way = 0;
        for (const auto& [k, by] : moved) {
            const double rate = k < n ? s.y[n + k][node] : s.f[k][node];
            way = std::max(way, s.h * std::fabs(rate) / std::fabs(by));
            spread = std::max(spread, (std::fabs(y[k]) + s.h * std::fabs(rate)) / std::fabs(by));
        }
        // The increment stays within the motion of the stretch: farther away the function may differ, as in a narrow
        // pulse.
        const double clear = std::clamp(way, least_difference * spread, most_difference * spread);
        const double rough =
            c < 2 * groups ? s.h * noise / frame.inertia[c % groups] : s.h * floor.noise[n + (c - 2 * groups)];
        const double d =
            spread > 0 ? std::max({clear, clear_of_noise * (c < groups ? s.h * rough : rough), smallest}) : 1e-9;
        const std::vector<double> kept = y;
        for (const auto& [k, by] : moved) y[k] = kept[k] + by * d;
        if (!torques(above)) return false;
        for (const auto& [k, by] : moved) y[k] = kept[k] - by * d;
        if (!torques(below)) return false;
        y = kept;
        for (std::size_t r = 0; r < rows; ++r) {
            slopes_(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = (above[r] - below[r]) / (2 * d);
        }
    }
    return true;
}

void Newton::find_linear(const Frame& frame) {
    const std::size_t groups = frame.groups();
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const model::Joint& joint = mechanics_.system().joints[j];
        for (const auto& [on, by] : frame.joints[j]) {
            const auto row = static_cast<Eigen::Index>(on);
            const double I = frame.inertia[on];
            for (const auto& [group, turned] : frame.joints[j]) {
                const auto c = static_cast<Eigen::Index>(group);
                slopes_(row, c) -= by * turned * joint.stiffness / I;
                slopes_(row, static_cast<Eigen::Index>(groups) + c) -= by * turned * joint.damping / I;
            }
        }
    }
}

void Newton::Factors::solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& solution) const {
    solution.resize(rhs.size());
    if (inverse.rows() == static_cast<Eigen::Index>(inner)) {
        multiply(inverse.data(), rhs.data(), inner, solution.data());
        return;
    }
    if (inverse.size() > 0) {
        solution.noalias() = inverse * rhs;
        return;
    }
    const IntegrationModes& each = integration_modes();
    constexpr auto size = static_cast<Eigen::Index>(inner);
    const Eigen::Index rows = rhs.size() / size;
    for (Eigen::Index r = 0; r < rows; ++r) {
        multiply(each.from_nodes.data(), rhs.data() + r * size, inner, solution.data() + r * size);
    }
    thread_local std::vector<Complex> in_order;
    in_order.resize(static_cast<std::size_t>(rows));
    for (std::size_t i = 0; i < each.values.size() && band >= 0; ++i) {
        const Eigen::Index real = each.places[i].first, imaginary = each.places[i].second;
        for (std::size_t k = 0; k < order.size(); ++k) {
            const Eigen::Index at = order[k] * size;
            in_order[k] = {solution(at + real), imaginary < 0 ? 0 : solution(at + imaginary)};
        }
        const Eigen::Index numbers = rows * (2 * band + 1);
        solve_band(of_modes.data() + static_cast<Eigen::Index>(i) * numbers, rows, band, in_order.data());
        for (std::size_t k = 0; k < order.size(); ++k) {
            const Eigen::Index at = order[k] * size;
            solution(at + real) = in_order[k].real();
            if (imaginary >= 0) solution(at + imaginary) = in_order[k].imag();
        }
    }
    for (std::size_t i = 0; i < each.values.size() && band < 0; ++i) {
        const Eigen::Index real = each.places[i].first, imaginary = each.places[i].second;
        for (Eigen::Index r = 0; r < rows; ++r) {
            in_order[static_cast<std::size_t>(r)] = {solution(r * size + real),
                                                     imaginary < 0 ? 0 : solution(r * size + imaginary)};
        }
        const std::complex<double>* matrix = of_modes.data() + static_cast<Eigen::Index>(i) * rows * rows;
        for (Eigen::Index r = 0; r < rows; ++r) {
            std::complex<double> sum = 0;
            for (Eigen::Index c = 0; c < rows; ++c) {
                sum += matrix[c * rows + r] * in_order[static_cast<std::size_t>(c)];
            }
            solution(r * size + real) = sum.real();
            if (imaginary >= 0) solution(r * size + imaginary) = sum.imag();
        }
    }
    for (Eigen::Index r = 0; r < rows; ++r) {
        multiply(each.to_nodes.data(), solution.data() + r * size, inner, solution.data() + r * size);
    }
}

/// Finds the order of Cuthill and McKee: the neighbours of each unknown follow it, those with few neighbours first.
void Newton::find_order(Eigen::Index groups) {
    const Eigen::Index rows = slopes_.rows();
    const auto count = static_cast<std::size_t>(rows);
    std::vector<std::vector<Eigen::Index>> neighbours(count);
    for (Eigen::Index r = 0; r < rows; ++r) {
        for (Eigen::Index c = 0; c < r; ++c) {
            const auto acts = [&](Eigen::Index on, Eigen::Index of) {
                return (of < groups && slopes_(on, of) != 0) || slopes_(on, groups + of) != 0;
            };
            if (!acts(r, c) && !acts(c, r)) continue;
            neighbours[static_cast<std::size_t>(r)].push_back(c), neighbours[static_cast<std::size_t>(c)].push_back(r);
        }
    }
    const auto fewer = [&](Eigen::Index a, Eigen::Index b) {
        return neighbours[static_cast<std::size_t>(a)].size() < neighbours[static_cast<std::size_t>(b)].size();
    };
    std::vector<Eigen::Index> place(count, -1), firsts(count);
    for (Eigen::Index r = 0; r < rows; ++r) firsts[static_cast<std::size_t>(r)] = r;
    std::stable_sort(firsts.begin(), firsts.end(), fewer);
    order_.clear();
    const auto take = [&](Eigen::Index r) {
        if (place[static_cast<std::size_t>(r)] >= 0) return;
        place[static_cast<std::size_t>(r)] = static_cast<Eigen::Index>(order_.size());
        order_.push_back(r);
    };
    for (const Eigen::Index first : firsts) {
        std::size_t next = order_.size();
        for (take(first); next < order_.size(); ++next) {
            std::vector<Eigen::Index>& near = neighbours[static_cast<std::size_t>(order_[next])];
            std::stable_sort(near.begin(), near.end(), fewer);
            std::for_each(near.begin(), near.end(), take);
        }
    }
    band_ = 0;
    for (std::size_t r = 0; r < count; ++r) {
        for (const Eigen::Index c : neighbours[r]) {
            band_ = std::max(band_, place[r] - place[static_cast<std::size_t>(c)]);
        }
    }
}

bool Newton::factor_band(double h, Eigen::Index groups, Factors& made) const {
    const Eigen::Index rows = slopes_.rows(), wide = 2 * band_ + 1;
    const auto& values = integration_modes().values;
    made.of_modes.assign(values.size() * static_cast<std::size_t>(rows * wide), 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Complex once = h * values[i], twice = once * once;
        Complex* const own = made.of_modes.data() + static_cast<Eigen::Index>(i) * rows * wide;
        for (Eigen::Index r = 0; r < rows; ++r) {
            for (Eigen::Index c = std::max<Eigen::Index>(0, r - band_); c <= std::min(rows - 1, r + band_); ++c) {
                const Eigen::Index on = order_[static_cast<std::size_t>(r)], of = order_[static_cast<std::size_t>(c)];
                Complex sum = r == c ? 1 : 0;
                sum -= once * slopes_(on, groups + of);
                if (of < groups) sum -= twice * slopes_(on, of);
                own[r * wide + band_ + c - r] = sum;
            }
        }
        if (!eliminate_band(own, rows, band_)) return false;
    }
    made.band = band_, made.order = order_;
    return true;
}

/// Inverts a small matrix for each eigenvalue of the integration matrix.
void Newton::factor_modes(double h, Eigen::Index groups, Factors& made) const {
    const Eigen::Index rows = slopes_.rows();
    made.of_modes.clear();
    made.of_modes.reserve(integration_modes().values.size() * static_cast<std::size_t>(rows * rows));
    for (const std::complex<double>& value : integration_modes().values) {
        const std::complex<double> once_by = h * value, twice_by = once_by * once_by;
        if (rows == 1 && groups == 1) {
            made.of_modes.push_back(1.0 / (1.0 - once_by * slopes_(0, 1) - twice_by * slopes_(0, 0)));
            continue;
        }
        Eigen::MatrixXcd A = Eigen::MatrixXcd::Identity(rows, rows) - once_by * slopes_.rightCols(rows);
        A.leftCols(groups) -= twice_by * slopes_.leftCols(groups);
        const Eigen::MatrixXcd inverse = algebra::inverse(A);
        made.of_modes.insert(made.of_modes.end(), inverse.data(), inverse.data() + rows * rows);
    }
}

const Newton::Factors& Newton::factors(double h, const Frame& frame) {
    constexpr Eigen::Index few = 3;
    constexpr int often = 4;
    const bool linear = slopes_.rows() <= few && !mechanics_.nonlinear();
    const auto serves = [h, linear](std::pair<const double, Factors>& of) {
        if (std::fabs(of.first - h) > 1e-6 * h) return false;
        return !linear || of.second.inverse.size() > 0 || ++of.second.uses < often;
    };
    if (last_factors_ != nullptr && serves(*last_factors_)) return last_factors_->second;
    auto found = factors_.lower_bound(h * (1 - 1e-6));
    if (found != factors_.end() && serves(*found)) {
        last_factors_ = &*found;
        return found->second;
    }
    static const Inner once = integration().bottomRightCorner<inner, inner>(), twice = once * once;
    const auto size = static_cast<Eigen::Index>(inner), rows = slopes_.rows(),
               groups = static_cast<Eigen::Index>(frame.groups());
    const auto block = [&](Eigen::Index r, Eigen::Index c) {
        Inner own = Inner::Zero();
        if (c < groups) own -= h * h * slopes_(r, c) * twice;
        own -= h * slopes_(r, groups + c) * once;
        if (r == c) own += Inner::Identity();
        return own;
    };
    const bool known = found != factors_.end() && std::fabs(found->first - h) <= 1e-6 * h;
    if (!known) {
        if (factors_.size() >= most_factors) factors_.clear();
        found = factors_.try_emplace(h).first;
    }
    Factors& made = found->second;
    last_factors_ = &*found;
    if (linear && rows == 1) {
        const Inner A = block(0, 0), inverse = inverse_of(A);
        made.inverse = inverse, made.off = off_if_accurate(A, inverse);
        return made;
    }
    if (linear && known) {
        Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size * rows, size * rows);
        for (Eigen::Index r = 0; r < rows; ++r) {
            for (Eigen::Index c = 0; c < rows; ++c) A.block<inner, inner>(r * size, c * size) = block(r, c);
        }
        made.inverse = algebra::inverse(A), made.off = off_if_accurate(A, made.inverse);
        return made;
    }
    if (rows >= few_unknowns && order_.empty()) find_order(groups);
    const bool banded = rows >= few_unknowns && (4 * band_ < rows || rows >= many_unknowns);
    if (!banded || !factor_band(h, groups, made)) factor_modes(h, groups, made);
    return made;
}

}  // namespace dinal::motion::engine
