#include "motion/engine/collocation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/break_search.hpp"
#include "motion/interpolation.hpp"
#include "motion/roughness.hpp"

namespace dinal::motion::engine {

namespace {

constexpr int most_iterations = 40;
constexpr int many_iterations = 4;         // slopes that need so many no longer serve, and are asked anew
constexpr double most_left_over = 1e-6;    // of the equation; a stiff rate multiplies the rounding of its steps
constexpr double clear_of_noise = 1e4;     // differences over so much motion tell a slope
constexpr double of_tail = 8;              // noise at single nodes is up to so many times its last coefficients
constexpr double most_noise_of_rate = 64;  // times the tolerance; of what is noisier than that the run says so
constexpr double gross = 1e3;              // not resolved by more than this factor: it may be a break
constexpr std::size_t most_factors = 24;
constexpr Eigen::Index many_unknowns = 8;  // their matrix is sparse
/// The widest gaps between nodes, by the node before. Users' functions are asked in the middle of these, too.
constexpr std::array<std::size_t, 3> looked_into{7, 8, 9};
/// In units of the longest stretch: on one shorter than this no pulse can hide.
constexpr double too_short_to_look = 1e-6;
const double smallest = std::numeric_limits<double>::min() / rounding;

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

/// The eigenvalues of the matrix that integrates values at the nodes but the first, one of each conjugate pair, and the
/// change to the basis of its eigenvectors and back. There each eigenvalue has a coefficient; real and imaginary parts
/// of the complex ones stand next to each other.
struct IntegrationModes {
    using Matrix = Eigen::Matrix<double, node_count - 1, node_count - 1>;
    std::vector<std::complex<double>> values{};
    std::vector<std::pair<int, int>> places{};  ///< of both parts of a coefficient; the second is -1 where it is real
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

}  // namespace

namespace {

/// Returns the weighted sum of what the groups have that move a body.
template <class Value>
double sum_of_groups(const Frame::Shape& shape, const Value& value) {
    double sum = 0;
    for (const auto& [group, by] : shape) sum += by * value(group);
    return sum;
}

}  // namespace

/// A matrix of `inner` rows, column after column, times a vector.
void Collocation::multiply(const double* matrix, const double* vector, std::size_t columns, double* product) {
    using Column = Eigen::Matrix<double, inner, 1>;
    Column sums = Column::Zero();
    for (std::size_t j = 0; j < columns; ++j) sums += vector[j] * Eigen::Map<const Column>(matrix + j * inner);
    Eigen::Map<Column> result(product);
    result = sums;
}

/// The integral from the first node to each, of what has these values.
void Collocation::integrate(const Nodes& values, double h, Nodes& sums) {
    static const Eigen::Matrix<double, inner, node_count> rows = integration().bottomRows<inner>();
    multiply(rows.data(), values.data(), node_count, sums.data() + 1);
    sums[0] = 0;
    for (double& sum : sums) sum *= h;
}

Collocation::Collocation(const Mechanics& mechanics, double tolerance, double longest, double step)
    : mechanics_(mechanics),
      tolerance_(tolerance),
      longest_(longest),
      step_length_(step),
      n_(mechanics.bodies()),
      m_(mechanics.states()),
      fastest_belt_(mechanics.joints()),
      fastest_rate_(m_),
      allowed_(n_),
      floor_{std::vector<double>(n_ + m_), std::vector<double>(n_ + m_)},
      stalled_(n_ + m_),
      may_be_rough_(n_ + m_, 1),
      offset_(n_),
      offset_rate_(n_),
      offset_way_(n_),
      rate_(m_) {
    mechanics.for_each_signal([this](const Signal& s) { tells_rests_ = tells_rests_ && s.tells_rests(); });
    may_be_rough_.assign(n_ + m_, 0);
    std::fill(may_be_rough_.begin() + static_cast<std::ptrdiff_t>(n_), may_be_rough_.end(), 1);
    for (std::size_t j = 0; j < mechanics.joints(); ++j) {
        const model::Joint& joint = mechanics.system().joints[j];
        if (!mechanics.loads()[j].asks_functions() && joint.spring.none() && joint.friction.function == nullptr &&
            !joint.friction.law.depends_on_speed())
            continue;
        for (const model::Weight& weight : joint.of) may_be_rough_[weight.body] = 1;
    }
}

void Collocation::make_room(Segment& s) const {
    if (!s.y.empty()) return;
    for (auto of : {&Segment::y, &Segment::f, &Segment::series, &Segment::rates}) (s.*of).resize(2 * n_ + m_);
    for (auto of : {&Segment::moved, &Segment::torques}) (s.*of).resize(n_);
    for (auto of : {&Segment::loads, &Segment::driven, &Segment::belts, &Segment::belt_rates, &Segment::holding})
        (s.*of).resize(mechanics_.joints());
}

/// All that depends on the time alone. False when one of the user's functions has failed.
bool Collocation::sample(Segment& s, const Mode& mode, const Frame& frame, const std::vector<double>& begin) {
    const std::size_t joints = mechanics_.joints();
    make_room(s);
    for (Nodes& way : s.moved) way.fill(0);
    for (std::size_t j = 0; j < node_count; ++j) {
        s.times[j] = s.time(cheb::nodes[j]);
        s.rests[j] = s.h * (1 + cheb::nodes[j]) - s.start.until(s.times[j]);
    }
    for (std::size_t k = 0; k < s.y.size(); ++k) s.y[k].fill(begin[k]);
    for (std::size_t i = 0; i < n_; ++i) offset_[i] = {}, offset_rate_[i] = {}, offset_way_[i] = {};
    mechanics_.sample_loads(s, s.loads);
    std::size_t good = node_count;
    for (const Nodes& load : s.loads) {
        const auto* const bad = std::find_if(load.begin(), load.end(), [](double M) { return !std::isfinite(M); });
        good = std::min(good, static_cast<std::size_t>(bad - load.begin()));
    }
    if (good < node_count) {
        bad_time_ = s.times[good];
        return false;
    }
    if (!mechanics_.has_belts()) {
        for (std::size_t joint = 0; joint < joints; ++joint) s.belts[joint] = s.belt_rates[joint] = {};
        return true;
    }
    for (std::size_t joint = 0; joint < joints; ++joint) {
        s.belts[joint] = s.belt_rates[joint] = {};
        if (!mechanics_.has_belt(joint)) continue;
        for (std::size_t j = 0; j < node_count; ++j) {
            s.belts[joint][j] = mechanics_.belt(joint, s.times[j], s.side(j));
            if (std::isfinite(s.belts[joint][j])) continue;
            bad_time_ = s.times[j];
            return false;
        }
        fastest_belt_[joint] = std::max(fastest_belt_[joint], greatest(s.belts[joint]));
        // On a segment so short its values tell no slope any more.
        constexpr double too_short_for_slopes = 1e-7, stretch = 1e-4;
        if (2 * s.h < too_short_for_slopes * longest_) {
            const double within = std::min(stretch * longest_, (mechanics_.next_break(s.start.hi) - s.start.hi) / 2);
            s.belt_rates[joint].fill(mechanics_.belt_slope(joint, s.start.hi, within).rate);
            continue;
        }
        const auto slope = cheb::derivative(cheb::fit(s.belts[joint]));
        for (std::size_t j = 0; j < node_count; ++j) s.belt_rates[joint][j] = cheb::value(slope, cheb::nodes[j]) / s.h;
    }
    if (frame.edges.empty()) return true;
    belt_.resize(joints);
    for (std::size_t j = 0; j < node_count; ++j) {
        for (std::size_t joint = 0; joint < joints; ++joint) belt_[joint] = s.belts[joint][j];
        frame.offsets(belt_, mode, torque_);
        for (std::size_t i = 0; i < n_; ++i) offset_[i][j] = torque_[i];
        for (std::size_t joint = 0; joint < joints; ++joint) belt_[joint] = s.belt_rates[joint][j];
        frame.offsets(belt_, mode, torque_);
        for (std::size_t i = 0; i < n_; ++i) offset_rate_[i][j] = torque_[i];
    }
    for (std::size_t i = 0; i < n_; ++i) integrate(offset_[i], s.h, offset_way_[i]);
    return true;
}

/// Torques and rates from the node `first` to before `end`; new accelerations of the groups. Functions of the motion
/// are asked at `departing` where that is given, else at the motion of the segment.
bool Collocation::evaluate(Segment& s, const Mode& mode, const Frame& frame, std::size_t first, std::size_t end,
                           const std::vector<double>* departing) {
    bool good = true;
    bool placed = false;
    const auto each_node = [&](auto&& at_node) {
        for (std::size_t j = first; j < end && !placed; ++j) {
            points_[j].resize(s.y.size());
            for (std::size_t k = 0; k < s.y.size(); ++k) points_[j][k] = departing ? (*departing)[k] : s.y[k][j];
        }
        placed = true;
        for (std::size_t j = first; j < end; ++j) at_node(j, Moment{s.times[j], s.side(j), points_[j]});
    };
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        std::copy(s.loads[i].data() + first, s.loads[i].data() + end, s.driven[i].data() + first);
        const Signal& load = mechanics_.loads()[i];
        if (load.asks_the_motion()) {
            each_node([&](std::size_t j, const Moment& at) { s.driven[i][j] += load.of_motion(at); });
        }
        if (i < n_) std::copy(s.driven[i].data() + first, s.driven[i].data() + end, s.torques[i].data() + first);
    }
    for (std::size_t joint = 0; joint < mechanics_.joints(); ++joint) {
        const model::Joint& own = mechanics_.system().joints[joint];
        Nodes torque;
        if (mechanics_.is_native(joint) && mode.leans[joint] == 0) {
            mechanics_.native_torques(joint, mode, s.y, s.belts[joint], first, end, torque);
        } else {
            each_node([&](std::size_t j, const Moment& at) {
                torque[j] = mechanics_.joint_torque(joint, at, mode, s.belts[joint][j]);
            });
        }
        // Of the digits that the angles have rounded off the stiffness takes notice.
        for (const auto& [body, by] : own.of) {
            const double k = by * own.stiffness;
            if (k == 0) continue;
            const Nodes &y = s.y[body], &moved = s.moved[body];
            const double low = s.low[body];
            for (std::size_t j = first; j < end; ++j) torque[j] += k * (low + (moved[j] - (y[j] - y[0])));
        }
        for (std::size_t j = first; j < end && joint >= n_; ++j) torque[j] -= s.driven[joint][j];
        for (const auto& [body, by] : own.of) {
            Nodes& on_body = s.torques[body];
            for (std::size_t j = first; j < end; ++j) on_body[j] -= by * torque[j];
        }
    }
    for (std::size_t g = 0; g < frame.groups(); ++g) std::fill(found_[g].data() + first, found_[g].data() + end, 0.0);
    for (std::size_t i = 0; i < n_; ++i) {
        const Nodes& torque = s.torques[i];
        double sum = 0;
        for (std::size_t j = first; j < end; ++j) sum += torque[j];
        good = good && std::isfinite(sum);
        const double inertia = mechanics_.system().bodies[i].inertia;
        for (const auto& [group, by] : frame.bodies[i]) {
            Nodes& found = found_[group];
            const double share = by / frame.inertia[group];
            for (std::size_t j = first; j < end; ++j) found[j] += share * (torque[j] - inertia * offset_rate_[i][j]);
        }
    }
    if (m_ > 0) {
        each_node([&](std::size_t j, const Moment& at) {
            mechanics_.rates(at, rate_.data(), &mode);
            for (std::size_t k = 0; k < m_; ++k) {
                found_[frame.groups() + k][j] = rate_[k];
                good = good && std::isfinite(rate_[k]);
            }
        });
    }
    for (std::size_t j = first; j < end && !good; ++j) {
        bool here = true;
        for (std::size_t i = 0; i < n_; ++i) here = here && std::isfinite(s.torques[i][j]);
        for (std::size_t k = 0; k < m_; ++k) here = here && std::isfinite(found_[frame.groups() + k][j]);
        bad_time_ = s.times[j];
        if (!here) break;
    }
    return good;
}

/// The first guess: accelerations and rates stay as they are at the first node.
void Collocation::guess(Segment& s, const Frame& frame) {
    const auto since = [&s](std::size_t j) { return s.h * (1 + cheb::nodes[j]); };
    for (std::size_t i = 0; i < n_; ++i) {
        const Frame::Shape& shape = frame.bodies[i];
        Nodes &way = s.moved[i], &p = s.y[i], &v = s.y[n_ + i];
        const Nodes &offset = offset_[i], &offset_way = offset_way_[i];
        const double v0 = shape.empty() ? 0 : v[0] - offset[0], p0 = p[0];
        const double a = sum_of_groups(shape, [this](std::size_t g) { return unknown_[g][0]; });
        for (std::size_t j = 1; j < node_count; ++j) {
            way[j] = since(j) * (v0 + since(j) * a / 2) + offset_way[j];
            p[j] = p0 + way[j];
            v[j] = v0 + since(j) * a + offset[j];
        }
    }
    for (std::size_t k = 0; k < m_; ++k) {
        Nodes& z = s.y[2 * n_ + k];
        for (std::size_t j = 1; j < node_count; ++j) z[j] = z[0] + since(j) * unknown_[frame.groups() + k][0];
    }
}

/// The first guess where a smooth motion goes on: accelerations and rates do as they did. Whether it does.
bool Collocation::go_on(const Segment& s, const Frame& frame) {
    constexpr double nearly = 1e-6, longer = 4;
    const bool follows = end_.t == s.start.hi && !s.from_break && end_.groups == frame.bodies;
    if (!follows || !(s.h <= longer * end_.h)) return false;
    for (std::size_t k = 0; k < end_.unknowns.size(); ++k) {
        const auto& [value, first, second, third] = end_.unknowns[k];
        const double now = unknown_[k][0], most = std::fabs(value) + s.h * std::fabs(first);
        if (!(std::fabs(now - value) <= nearly * most)) return false;
        for (std::size_t j = 1; j < node_count; ++j) {
            const double t = s.h * (1 + cheb::nodes[j]);
            unknown_[k][j] = now + t * (first + t / 2 * (second + t / 3 * third));
        }
    }
    return true;
}

void Collocation::remember_end(const Segment& s, const Frame& frame) {
    end_.t = s.end, end_.h = s.h, end_.groups = frame.bodies;
    end_.unknowns.resize(unknown_.size());
    for (std::size_t k = 0; k < unknown_.size(); ++k) {
        const Series series = cheb::fit(unknown_[k]);
        std::array<double, 4>& end = end_.unknowns[k];
        end = {};
        for (std::size_t i = 0; i < node_count; ++i) {
            const auto i2 = static_cast<double>(i * i);
            double of_power = series[i];
            end[0] += of_power;
            end[1] += of_power *= i2 / s.h;
            end[2] += of_power *= (i2 - 1) / (3 * s.h);
            end[3] += of_power * (i2 - 4) / (5 * s.h);
        }
    }
}

/// Velocities and angles from the accelerations of the groups, states from their rates.
void Collocation::place(Segment& s, const Frame& frame) {
    Nodes velocity{}, way{};
    of_groups_.resize(frame.groups());
    for (std::size_t g = 0; g < frame.groups(); ++g) integrate(unknown_[g], s.h, of_groups_[g]);
    placed_.assign(n_, 0);
    for (std::size_t i = 0; i < n_; ++i) {
        if (placed_[i] != 0) continue;
        const Frame::Shape& shape = frame.bodies[i];
        velocity = {}, way = {};
        for (const auto& [group, by] : shape) add(velocity, of_groups_[group], by);
        if (!shape.empty()) {
            const double first = s.y[n_ + i][0] - offset_[i][0];
            for (double& v : velocity) v += first;
            integrate(velocity, s.h, way);
        }
        for (std::size_t b = i; b < n_; ++b) {
            if (frame.bodies[b] != shape) continue;
            placed_[b] = 1;
            for (std::size_t j = 1; j < node_count; ++j) {
                s.moved[b][j] = way[j] + offset_way_[b][j];
                s.y[b][j] = s.y[b][0] + s.moved[b][j];
                s.y[n_ + b][j] = velocity[j] + offset_[b][j];
            }
        }
    }
    for (std::size_t k = 0; k < m_; ++k) {
        Nodes& z = s.y[2 * n_ + k];
        integrate(unknown_[frame.groups() + k], s.h, way);
        for (std::size_t j = 1; j < node_count; ++j) z[j] = z[0] + way[j];
    }
}

/// How accelerations of the groups and rates depend on angles and velocities of the groups and on states.
bool Collocation::find_slopes(const Segment& s, const Mode& mode, const Frame& frame, std::size_t node) {
    const std::size_t groups = frame.groups(), rows = groups + m_, columns = 2 * groups + m_;
    slopes_.setZero(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    factors_.clear(), last_factors_ = nullptr;
    slopes_known_ = true;
    if (!mechanics_.nonlinear()) {
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
        return true;
    }
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
        for (std::size_t i = 0; i < n_; ++i) {
            for (const auto& [group, by] : frame.bodies[i]) out[group] += by * of_bodies[i];
        }
        for (std::size_t g = 0; g < groups; ++g) out[g] /= frame.inertia[g];
        mechanics_.rates(at, out.data() + groups, &mode);
        return std::all_of(out.begin(), out.end(), [](double x) { return std::isfinite(x); });
    };
    std::vector<double> above, below;
    for (std::size_t c = 0; c < columns; ++c) {
        // Which of y go together, and how widely they move on the segment.
        std::vector<std::pair<std::size_t, double>> moved;
        if (c < 2 * groups) {
            const std::size_t from = c < groups ? 0 : n_;
            for (std::size_t i = 0; i < n_; ++i) {
                for (const auto& [group, by] : frame.bodies[i]) {
                    if (group == c % groups) moved.emplace_back(from + i, by);
                }
            }
        } else {
            moved.emplace_back(2 * n_ + (c - 2 * groups), 1);
        }
        double spread = 0;
        for (const auto& [k, by] : moved) {
            const double rate = k < n_ ? s.y[n_ + k][node] : s.f[k][node];
            spread = std::max(spread, (std::fabs(y[k]) + s.h * std::fabs(rate)) / std::fabs(by));
        }
        const double rough =
            c < 2 * groups ? s.h * noise() / frame.inertia[c % groups] : s.h * floor_.noise[n_ + (c - 2 * groups)];
        const double d =
            spread > 0 ? std::max(1e-4 * spread, clear_of_noise * (c < groups ? s.h * rough : rough)) : 1e-9;
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

void Collocation::Factors::solve(const Eigen::VectorXd& right, Eigen::VectorXd& left) const {
    left.resize(right.size());
    if (inverse.rows() == static_cast<Eigen::Index>(inner)) {
        multiply(inverse.data(), right.data(), inner, left.data());
        return;
    }
    if (inverse.size() > 0) {
        left.noalias() = inverse * right;
        return;
    }
    if (sparse != nullptr) {
        sparse->solve(right, left);
        return;
    }
    const IntegrationModes& each = integration_modes();
    constexpr auto size = static_cast<Eigen::Index>(inner);
    const Eigen::Index rows = right.size() / size;
    for (Eigen::Index r = 0; r < rows; ++r) {
        multiply(each.from_nodes.data(), right.data() + r * size, inner, left.data() + r * size);
    }
    Eigen::Matrix<std::complex<double>, Eigen::Dynamic, 1, 0, many_unknowns, 1> of_mode(rows);
    for (std::size_t i = 0; i < each.values.size(); ++i) {
        const Eigen::Index real = each.places[i].first, imaginary = each.places[i].second;
        for (Eigen::Index r = 0; r < rows; ++r) {
            of_mode(r) = {left(r * size + real), imaginary < 0 ? 0 : left(r * size + imaginary)};
        }
        const std::complex<double>* matrix = of_modes.data() + static_cast<Eigen::Index>(i) * rows * rows;
        for (Eigen::Index r = 0; r < rows; ++r) {
            std::complex<double> sum = 0;
            for (Eigen::Index c = 0; c < rows; ++c) sum += matrix[c * rows + r] * of_mode(c);
            left(r * size + real) = sum.real();
            if (imaginary >= 0) left(r * size + imaginary) = sum.imag();
        }
    }
    for (Eigen::Index r = 0; r < rows; ++r) {
        multiply(each.to_nodes.data(), left.data() + r * size, inner, left.data() + r * size);
    }
}

const Collocation::Factors& Collocation::newton_matrix(double h, const Frame& frame) {
    constexpr Eigen::Index few = 3;
    constexpr int often = 4;
    const bool linear = slopes_.rows() <= few && !mechanics_.nonlinear();
    const auto serves = [h, linear](std::pair<const double, Factors>& of) {
        if (std::fabs(of.first - h) > 1e-6 * h) return false;
        return !linear || of.second.inverse.size() > 0 || ++of.second.asked < often;
    };
    if (last_factors_ != nullptr && serves(*last_factors_)) return last_factors_->second;
    auto found = factors_.lower_bound(h * (1 - 1e-6));
    if (found != factors_.end() && serves(*found)) {
        last_factors_ = &*found;
        return found->second;
    }
    using Inner = Eigen::Matrix<double, inner, inner>;
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
    const auto empty = [&](Eigen::Index r, Eigen::Index c) {
        return r != c && (c >= groups || slopes_(r, c) == 0) && slopes_(r, groups + c) == 0;
    };
    const bool known = found != factors_.end() && std::fabs(found->first - h) <= 1e-6 * h;
    if (!known) {
        if (factors_.size() >= most_factors) factors_.clear();
        found = factors_.try_emplace(h).first;
    }
    Factors& made = found->second;
    last_factors_ = &*found;
    if (linear && known) {
        Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size * rows, size * rows);
        for (Eigen::Index r = 0; r < rows; ++r) {
            for (Eigen::Index c = 0; c < rows; ++c) {
                if (!empty(r, c)) A.block<inner, inner>(r * size, c * size) = block(r, c);
            }
        }
        made.inverse = algebra::inverse(A);
        return made;
    }
    if (rows < many_unknowns) {
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
        return made;
    }
    std::vector<algebra::Entry> entries;
    for (Eigen::Index r = 0; r < rows; ++r) {
        for (Eigen::Index c = 0; c < rows; ++c) {
            if (empty(r, c)) continue;
            const Inner own = block(r, c);
            for (Eigen::Index i = 0; i < size; ++i) {
                for (Eigen::Index k = 0; k < size; ++k) entries.push_back({r * size + i, c * size + k, own(i, k)});
            }
        }
    }
    made.sparse = algebra::factored_sparse(size * rows, entries);
    return made;
}

double Collocation::size_at(std::size_t joint) const {
    double size = 0;
    for (const auto& [body, by] : mechanics_.system().joints[joint].of) {
        size = std::max(size, sizes_[body] / std::fabs(by));
    }
    return size;
}

void Collocation::find_sizes(const Segment& s) {
    for (std::size_t i = 0; i < n_; ++i) sizes_[i] = sizes_at_start_[i] + greatest(s.torques[i]);
}

void Collocation::find_sizes_at_start(const Segment& s, const std::vector<double>& begin) {
    sizes_at_start_.resize(n_), sizes_.resize(n_);
    for (std::size_t i = 0; i < n_; ++i) sizes_at_start_[i] = greatest(s.loads[i]);
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const model::Joint& joint = mechanics_.system().joints[j];
        const double size = mechanics_.size_of(j, {s.times[0], s.side(0), begin}) + (j < n_ ? 0 : greatest(s.loads[j]));
        for (const auto& [body, by] : joint.of) sizes_at_start_[body] += std::fabs(by) * size;
    }
}

Collocation::Attempt Collocation::iterate(Segment& s, const Mode& mode, const Frame& frame,
                                          const std::vector<double>& departing) {
    const std::size_t groups = frame.groups(), count = groups + m_;
    unknown_.resize(count), found_.resize(count);
    residual_.resize(static_cast<Eigen::Index>(inner * count));
    if (slopes_of_ != frame.bodies || slopes_pressed_ != mode.presses || slopes_sliding_ != mode.sliders) {
        slopes_known_ = false, slopes_of_ = frame.bodies, slopes_pressed_ = mode.presses,
        slopes_sliding_ = mode.sliders;
    }
    enum class Slopes { known, here, none };
    // Beside a jump of a rate differences tell a slope that is none; where a segment is short it does without any.
    for (const Slopes slopes : {Slopes::known, Slopes::here, Slopes::none}) {
        if (!evaluate(s, mode, frame, 0, 1, &departing)) return Attempt::failed;
        for (std::size_t k = 0; k < count; ++k) unknown_[k].fill(found_[k][0]);
        for (std::size_t i = 0; i < n_; ++i) {
            s.f[n_ + i].fill(sum_of_groups(frame.bodies[i], [this](std::size_t g) { return unknown_[g][0]; }));
        }
        for (std::size_t k = 0; k < m_; ++k) s.f[2 * n_ + k].fill(found_[groups + k][0]);
        if (slopes == Slopes::known && mechanics_.nonlinear() && go_on(s, frame)) {
            place(s, frame);
        } else {
            guess(s, frame);
        }
        double before = std::numeric_limits<double>::infinity();
        for (int i = 0; i < most_iterations; ++i) {
            if (!evaluate(s, mode, frame, 1, node_count, nullptr)) {
                slopes_known_ = false;  // they may be those of a state far away
                return Attempt::failed;
            }
            if (count == 0) return Attempt::resolved;
            if (slopes != Slopes::none && !slopes_known_ && !find_slopes(s, mode, frame, node_count / 2)) {
                slopes_known_ = false;
                return Attempt::failed;
            }
            double left = 0, stalls = 1e-12;
            find_sizes(s);
            scales_.resize(count);
            for (std::size_t k = 0; k < count; ++k) {
                double moves = 0, most = 0;
                if (k < groups) {
                    for (std::size_t b = 0; b < n_; ++b) {
                        for (const auto& [group, by] : frame.bodies[b]) {
                            if (group != k) continue;
                            const double share = std::fabs(by);
                            moves = std::max(
                                moves, greatest(s.y[n_ + b]) / share + s.h * share / frame.inertia[k] * sizes_[b]);
                        }
                    }
                } else {
                    moves = greatest(s.y[2 * n_ + (k - groups)]) + s.h * greatest(unknown_[k]);
                }
                scales_[k] = moves + smallest;
                const double rough = k < groups ? noise() / frame.inertia[k] : floor_.noise[n_ + (k - groups)];
                stalls = std::max(stalls, of_tail * s.h * rough / scales_[k]);
                for (std::size_t j = 1; j < node_count; ++j) {
                    const double rest = found_[k][j] - unknown_[k][j];
                    residual_(static_cast<Eigen::Index>(k * inner + j - 1)) = rest;
                    most = std::max(most, std::fabs(rest));
                }
                left = std::max(left, s.h * most / scales_[k]);
            }
            if (i > 0 && left <= 4 * rounding) return Attempt::resolved;
            if (slopes == Slopes::none) {
                step_ = residual_;
            } else {
                newton_matrix(s.h, frame).solve(residual_, step_);
            }
            double change = 0;
            for (std::size_t k = 0; k < count; ++k) {
                double most = 0;
                for (std::size_t j = 1; j < node_count; ++j) {
                    const double step = step_(static_cast<Eigen::Index>(k * inner + j - 1));
                    unknown_[k][j] += step;
                    most = std::max(most, std::fabs(step));
                }
                change = std::max(change, s.h * most / scales_[k]);
            }
            place(s, frame);
            if (!std::isfinite(change + left)) break;
            const double rate = before < std::numeric_limits<double>::infinity() ? change / before : 1;
            const bool converged = change <= 16 * rounding || (i >= 1 && change * rate <= 4 * rounding) ||
                                   (i >= 2 && change <= stalls && rate > 0.3);
            if (converged && left <= std::max(most_left_over, stalls)) {
                if (i >= many_iterations) slopes_known_ = false;
                return Attempt::resolved;
            }
            if (i >= 3 && rate > 0.7) break;
            before = change;
        }
        if (slopes == Slopes::known && !find_slopes(s, mode, frame, 0)) break;
        if (!mechanics_.nonlinear() && slopes == Slopes::here) break;
    }
    slopes_known_ = false;
    return Attempt::shorten;
}

/// One step for the groups and states. In between, angles are a polynomial that has the angles, velocities and
/// accelerations of both ends, and states one that has values and rates.
Collocation::Attempt Collocation::runge_kutta(Segment& s, const Mode& mode, const Frame& frame,
                                              const std::vector<double>& departing) {
    constexpr std::size_t middle = node_count / 2, last = node_count - 1;
    const double h = 2 * s.h;
    const std::size_t groups = frame.groups(), size = 2 * groups + m_;
    unknown_.resize(groups + m_), found_.resize(groups + m_);
    const std::vector<double> none(size, 0);
    std::vector<double> speeds(groups, 0);  // of the groups, at the start
    for (std::size_t i = 0; i < n_; ++i) {
        const double v = s.y[n_ + i][0] - offset_[i][0], momentum = mechanics_.system().bodies[i].inertia * v;
        for (const auto& [group, by] : frame.bodies[i]) speeds[group] += by * momentum / frame.inertia[group];
    }
    for (std::size_t i = 0; i < n_; ++i) {
        const Frame::Shape& shape = frame.bodies[i];
        if (shape.size() == 1) speeds[shape[0].group] = (s.y[n_ + i][0] - offset_[i][0]) / shape[0].by;
    }
    /// Of groups the way and the change of velocity, of states the change.
    const auto rates = [&](std::size_t node, const std::vector<double>& change, const std::vector<double>* asked,
                           std::vector<double>& out) {
        for (std::size_t i = 0; i < n_; ++i) {
            const Frame::Shape& shape = frame.bodies[i];
            const double first = shape.empty() ? 0 : s.y[n_ + i][0] - offset_[i][0];
            s.moved[i][node] = offset_way_[i][node] + sum_of_groups(shape, [&](std::size_t g) { return change[g]; });
            s.y[i][node] = s.y[i][0] + s.moved[i][node];
            if (node == 0) continue;
            s.y[n_ + i][node] =
                offset_[i][node] + (first + sum_of_groups(shape, [&](std::size_t g) { return change[groups + g]; }));
        }
        for (std::size_t k = 0; k < m_; ++k) s.y[2 * n_ + k][node] = s.y[2 * n_ + k][0] + change[2 * groups + k];
        if (!evaluate(s, mode, frame, node, node + 1, asked)) return false;
        out.resize(size);
        for (std::size_t g = 0; g < groups; ++g) out[g] = speeds[g] + change[groups + g];
        for (std::size_t k = 0; k < groups + m_; ++k) out[groups + k] = found_[k][node];
        return true;
    };
    const auto along = [&](double length, const std::vector<double>& slope) {
        std::vector<double> change(size);
        for (std::size_t k = 0; k < size; ++k) change[k] = length * slope[k];
        return change;
    };
    std::vector<double> a, b, c, d, e, z(size);
    if (!rates(0, none, &departing, a) || !rates(middle, along(h / 2, a), nullptr, b) ||
        !rates(middle, along(h / 2, b), nullptr, c) || !rates(last, along(h, c), nullptr, d)) {
        return Attempt::failed;
    }
    for (std::size_t k = 0; k < size; ++k) z[k] = h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    if (!rates(last, z, nullptr, e)) return Attempt::failed;
    // In a small part of a step the places differ by rounding, of which no velocity can be made.
    const bool small = h < 1e-3 * step_length_;
    const auto cubic = [&](std::size_t k, double x) {
        const double v0 = h * a[k], v1 = h * e[k];
        return x * (v0 + x * ((3 * z[k] - 2 * v0 - v1) + x * (v0 + v1 - 2 * z[k])));
    };
    std::vector<double> change(size);
    for (std::size_t j = 1; j < last; ++j) {
        const double x = (1 + cheb::nodes[j]) / 2;
        for (std::size_t k = 0; k < size; ++k) change[k] = cubic(k, x);
        for (std::size_t g = 0; g < groups && !small; ++g) {
            const std::size_t v = groups + g;
            const StepInterpolant motion(h, {0, a[g]}, a[v], {z[g], e[g]}, e[v]);
            const model::State between = motion(x * h);
            change[g] = between.theta, change[v] = between.velocity - a[g];
        }
        if (!rates(j, change, nullptr, d)) return Attempt::failed;
    }
    unknown_ = found_;
    return Attempt::resolved;
}

Collocation::Attempt Collocation::solve(Segment& s, const Mode& mode, const Frame& frame,
                                        const std::vector<double>& begin, const std::vector<double>& departing) {
    unresolved_ = std::numeric_limits<double>::infinity();
    if (!sample(s, mode, frame, begin)) return Attempt::failed;
    find_sizes_at_start(s, begin);
    const bool stepping = step_length_ > 0;
    const Attempt attempt = stepping ? runge_kutta(s, mode, frame, departing) : iterate(s, mode, frame, departing);
    if (attempt != Attempt::resolved) return attempt;
    const std::size_t groups = frame.groups();
    for (std::size_t i = 0; i < n_; ++i) {
        for (std::size_t j = 0; j < node_count; ++j) {
            s.f[n_ + i][j] =
                sum_of_groups(frame.bodies[i], [&](std::size_t g) { return unknown_[g][j]; }) + offset_rate_[i][j];
        }
    }
    for (std::size_t k = 0; k < m_; ++k) s.f[2 * n_ + k] = unknown_[groups + k];
    fit_series(s, frame, begin);
    for (const Series& series : s.series) {
        if (!std::isfinite(cheb::size(series))) return Attempt::failed;
    }
    find_holding(s, mode, frame);
    find_limits(s, mode);
    judge(s, mode, frame);
    s.proven = !stepping || !mechanics_.has_functions();
    if (stepping) return Attempt::resolved;
    if (unresolved_ <= 1 && !agrees_between(s, mode, frame)) unresolved_ = 2;
    if (unresolved_ <= 1 && !hides_nothing(s, mode)) unresolved_ = 2;
    if (unresolved_ <= 1 && mechanics_.nonlinear()) remember_end(s, frame);
    for (std::size_t k = 0; k < n_ + m_ && unresolved_ <= 1; ++k) {
        if (may_be_rough_[k] != 0) floor_.greatest[k] = std::max(floor_.greatest[k], greatest(acting(s, k)));
    }
    return unresolved_ <= 1 ? Attempt::resolved : Attempt::shorten;
}

/// Integrates the series of the accelerations, which is cheaper than a fit of velocities and angles. Terms beyond the
/// last one are added to those that they equal at the nodes.
void Collocation::fit_series(Segment& s, const Frame& frame, const std::vector<double>& begin) {
    for (std::size_t k = n_; k < s.f.size(); ++k) s.rates[k] = cheb::fit(s.f[k]);
    const bool integrated = step_length_ == 0 && !mechanics_.has_belts();
    for (std::size_t i = 0; i < n_ && integrated; ++i) {
        auto w = s.rates[n_ + i];
        for (double& c : w) c *= s.h;
        auto v = cheb::integral(w, 0.0);
        s.series[n_ + i] = cheb::folded(v);
        v[0] += begin[n_ + i];
        for (double& c : v) c *= s.h;
        s.series[i] = frame.bodies[i].empty() ? Series{} : cheb::folded(cheb::integral(v, 0.0));
    }
    for (std::size_t k = integrated ? 2 * n_ : 0; k < s.y.size(); ++k) {
        Nodes change{};
        for (std::size_t j = 0; j < node_count; ++j) change[j] = k < n_ ? s.moved[k][j] : s.y[k][j] - begin[k];
        s.series[k] = cheb::fit(change);
    }
}

void Collocation::find_holding(Segment& s, const Mode& mode, const Frame& frame) const {
    if (frame.edges.empty()) return;
    thread_local std::vector<double> lacking, held;
    lacking.resize(n_), held.assign(mechanics_.joints(), 0);
    for (std::size_t j = 0; j < node_count; ++j) {
        for (std::size_t i = 0; i < n_; ++i) {
            lacking[i] = mechanics_.system().bodies[i].inertia * s.f[n_ + i][j] - s.torques[i][j];
        }
        frame.multipliers(lacking, held);
        for (std::size_t joint = 0; joint < held.size(); ++joint) {
            if (mode.holds(joint)) s.holding[joint][j] = held[joint];
        }
    }
}

namespace {

/// Returns the factor by which a stretch with this series may be longer and still be resolved. The coefficients fall by
/// some factor per degree until all that follow are below `allowed`, and a longer stretch divides this factor. If the
/// last coefficients promise more, they decide.
double longer_by(const Series& series, double allowed) {
    std::size_t d = cheb::degree;
    while (d > 1 && std::fabs(series[d - 1]) <= allowed) --d;
    const double size = cheb::size(series), tail = std::max(cheb::tail(series), 1e-16 * allowed);
    const double by_decay =
        size > allowed ? std::pow(size / allowed, 1.0 / static_cast<double>(d) - 1.0 / cheb::degree) : model::never;
    return std::max(by_decay, std::pow(allowed / tail, 1.0 / cheb::degree));
}

}  // namespace

/// The noise of what moves a value makes all rough that this value acts on: of each group and state, how much by h.
/// Nothing where there is no noise.
std::vector<double> Collocation::passed_on(const Segment& s, const Frame& frame) const {
    const std::size_t groups = frame.groups(), count = groups + m_;
    const bool known = slopes_of_ == frame.bodies && slopes_.rows() == static_cast<Eigen::Index>(count);
    if (!known || std::all_of(floor_.noise.begin(), floor_.noise.end(), [](double x) { return x == 0; })) return {};
    std::vector<double> rough(count);
    Eigen::VectorXd off(static_cast<Eigen::Index>(count));
    for (std::size_t k = 0; k < count; ++k) {
        off(static_cast<Eigen::Index>(k)) =
            s.h * (k < groups ? noise() / frame.inertia[k] : floor_.noise[n_ + (k - groups)]);
    }
    const Eigen::MatrixXd by = slopes_.rightCols(static_cast<Eigen::Index>(count)).cwiseAbs();
    const Eigen::VectorXd once = by * off, twice = once + s.h * (by * once);
    for (std::size_t k = 0; k < count; ++k) rough[k] = s.h * twice(static_cast<Eigen::Index>(k));
    return rough;
}

/// The last coefficients of what drives each value, against what that value is and how it changes.
void Collocation::judge(const Segment& s, const Mode& mode, const Frame& frame) {
    unresolved_ = 0, growth_ = model::never;
    const auto note = [this](const Series& series, double scale, double allowed) {
        unresolved_ = std::max(unresolved_, scale * cheb::tail(series) / allowed);
        growth_ = std::min(growth_, longer_by(series, allowed / scale));
    };
    allowed_.assign(n_, 0);
    find_sizes(s);
    const std::vector<double> by_others = passed_on(s, frame);
    const auto from_others = [&](std::size_t k) { return by_others.empty() ? 0 : by_others[k]; };
    const double h = s.h, late = std::max(std::fabs(s.start.hi), std::fabs(s.end));
    lost_by_belts_ = 0;
    for (std::size_t joint = 0; joint < mechanics_.joints(); ++joint) {
        if (!mechanics_.has_belt(joint)) continue;
        const double lost = lost_in_time(cheb::fit(s.belts[joint]), late, h, fastest_belt_[joint]);
        lost_by_belts_ = std::max(lost_by_belts_, lost);
    }
    for (std::size_t i = 0; i < n_; ++i) {
        const double torques = sizes_[i];
        const auto lost = [&] {
            double sum = 0;
            for (std::size_t j = 0; j < mechanics_.joints() && !tells_rests_; ++j) {
                const bool acts = j == i || (!mechanics_.loads()[j].none() && mechanics_.system().joints[j].is_on(i));
                if (acts) sum += lost_in_time(cheb::fit(s.loads[j]), late, h, torques);
            }
            return sum;
        };
        if (const Frame::Shape& shape = frame.bodies[i]; !shape.empty()) {
            double per_torque = 0, others = 0;
            for (const auto& [group, by] : shape) {
                per_torque += h * by * by / frame.inertia[group], others += std::fabs(by) * from_others(group);
            }
            const Series& series = s.rates[n_ + i];
            const double size = h * cheb::size(series), tail = h * cheb::tail(series);
            double allowed = tolerance_ * std::max(greatest(s.y[n_ + i]), size) +
                             64 * rounding * (size + per_torque * torques) + smallest / h;
            if (tail > allowed || mechanics_.nonlinear()) allowed += per_torque * lost();
            allowed += per_torque * noise() + others;
            note(series, h, allowed);
            allowed_[i] = allowed / h;
        } else {
            const Series series = cheb::fit(s.torques[i]);
            double allowed = (tolerance_ + 16 * rounding) * torques + noise() + smallest;
            if (cheb::tail(series) > allowed) allowed += lost();
            note(series, 1, allowed);
        }
    }
    double held = 0;  // what rigid joints pass on
    for (std::size_t joint = 0; joint < mechanics_.joints(); ++joint) {
        if (mode.rigid[joint] != 0) held = std::max(held, greatest(s.holding[joint]));
    }
    for (std::size_t joint = 0; joint < mechanics_.joints(); ++joint) {
        // What a limit is compared with must be known as well as the motion, and what moves a body is its input.
        if (mode.holds(joint) && (mode.rigid[joint] == 0 || mechanics_.has_belt(joint))) {
            const Series series = cheb::fit(s.holding[joint]);
            const double torques = std::max(size_at(joint), held),
                         lost = (tells_rests_ ? 0 : lost_in_time(series, late, h, torques)) + noise();
            note(series, 1, (tolerance_ + 64 * rounding) * torques + lost + blurred_by_belts(s) + smallest);
            for (std::size_t way = 0; way < 2 && mechanics_.limits_change(joint, mode); ++way) {
                const Series limit = cheb::fit(s.limits[joint][way]);
                const double most = greatest(s.limits[joint][way]) + torques;  // it is compared with these
                const double allowed =
                    (tolerance_ + 64 * rounding) * most + lost_in_time(limit, late, h, most) + smallest;
                note(limit, 1, allowed);
            }
        }
        if (!mechanics_.has_belt(joint)) continue;
        const Series belt = cheb::fit(s.belts[joint]);
        const double allowed = (tolerance_ + 16 * rounding) * greatest(s.belts[joint]) +
                               16 * rounding * fastest_belt_[joint] +
                               lost_in_time(belt, late, h, fastest_belt_[joint]) + smallest;
        note(belt, 1, allowed);
    }
    double rough = 0;  // what noise in M may be of what it moves
    for (std::size_t i = 0; i < n_; ++i) {
        rough = std::max(rough, floor_.noise[i] / (std::max(sizes_[i], floor_.greatest[i]) + smallest));
    }
    for (std::size_t k = 0; k < m_; ++k) {
        Series series = s.rates[2 * n_ + k];
        for (double& c : series) c *= h;
        fastest_rate_[k] = std::max(fastest_rate_[k], greatest(s.f[2 * n_ + k]));
        const double allowed =
            (tolerance_ + rough + 64 * rounding) * std::max(greatest(s.y[2 * n_ + k]), cheb::size(series)) +
            64 * rounding * h * fastest_rate_[k] + lost_in_time(series, late, h, h * fastest_rate_[k]) +
            h * floor_.noise[n_ + k] + from_others(frame.groups() + k);
        note(series, 1, allowed + smallest);
    }
}

void Collocation::find_limits(Segment& s, const Mode& mode) const {
    s.limits.resize(mechanics_.joints());
    std::vector<double> y;
    for (std::size_t joint = 0; joint < s.limits.size(); ++joint) {
        if (!mechanics_.limits_change(joint, mode)) continue;
        for (std::size_t j = 0; j < node_count; ++j) {
            const Moment at = s.moment(j, y);
            s.limits[joint][0][j] = mechanics_.holding(joint, model::Motion::backward, at);
            s.limits[joint][1][j] = mechanics_.holding(joint, model::Motion::forward, at);
        }
    }
}

double Collocation::blurred_by_belts(const Segment& s) const {
    if (!mechanics_.has_belts()) return 0;
    double fastest = 0, inertia = 0;
    for (const double belt : fastest_belt_) fastest = std::max(fastest, belt);
    for (const model::Body& body : mechanics_.system().bodies) inertia += body.inertia;
    return inertia * (256 * rounding * fastest + lost_by_belts_) / s.h;
}

/// Right before a body turns, where it is farthest: a spring or a law of friction may act there for a short while.
void Collocation::add_turns(const Segment& s, std::vector<double>& places) const {
    constexpr double before = 1e-9;
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        const model::Joint& joint = mechanics_.system().joints[i];
        const model::Friction& law = joint.friction.law;
        const bool users = joint.friction.function != nullptr ||
                           (joint.friction.bristle() == nullptr && law.depends_on_speed() && law.ranges() == 0);
        if (joint.spring.none() && !users) continue;
        const Nodes velocity = mechanics_.slips(i, s.y, users ? s.belts[i] : Nodes{});
        const Series series = cheb::fit(velocity);
        for (std::size_t j = 0; j + 1 < node_count; ++j) {
            if (!(velocity[j] * velocity[j + 1] < 0)) continue;
            const double sign = velocity[j + 1] > 0 ? 1 : -1;
            const auto rising = [&](double x) { return sign * cheb::value(series, x); };
            places.push_back(first_positive(rising, cheb::nodes[j], sign * velocity[j], cheb::nodes[j + 1],
                                            sign * velocity[j + 1], before / 4)
                                 .first -
                             before);
            if (!joint.friction.none()) break;  // beyond a stop there is another motion
        }
    }
}

double Collocation::gap(const Segment& s) const {
    constexpr double widest_left = (cheb::nodes[7] - cheb::nodes[6]) / 2;
    if (step_length_ > 0) return s.h;
    return 2 * s.h * (2 * s.h > too_short_to_look * longest_ ? widest_left : cheb::widest_gap);
}

/// Asks between the nodes. A pulse of a function may be there that no node has met, or a bend of a law.
bool Collocation::agrees_between(const Segment& s, const Mode& mode, const Frame& frame) {
    constexpr double clearly = 64;
    if (2 * s.h <= too_short_to_look * longest_) return true;
    const bool seen = s.start.until(seen_) > 0 && seen_ < s.end;
    const bool scripts = std::any_of(mechanics_.loads().begin(), mechanics_.loads().end(), [&](const Signal& load) {
        return load.asks_in_time() && (seen || unproven_in_a_row_ > 0 || !load.is_read());
    });
    if (!scripts && !mechanics_.nonlinear()) return true;
    std::vector<Series> loads(mechanics_.joints());
    std::vector<Series> accelerations(mechanics_.nonlinear() ? n_ : 0);
    for (std::size_t i = 0; i < loads.size(); ++i) loads[i] = cheb::fit(s.loads[i]);
    for (std::size_t i = 0; i < accelerations.size(); ++i) accelerations[i] = s.rates[n_ + i];
    std::vector<double> y, belts(mechanics_.joints()), torques;
    std::vector<double> places;
    if (seen) places.push_back(s.start.until(seen_) / s.h - 1);
    for (const std::size_t j : looked_into) places.push_back((cheb::nodes[j] + cheb::nodes[j + 1]) / 2);
    add_turns(s, places);
    for (const double x : places) {
        const double t = s.time(x);
        mechanics_.loads_of_time(t, Side::at, load_);
        for (std::size_t i = 0; i < loads.size(); ++i) {
            if (!mechanics_.loads()[i].asks_in_time()) continue;
            const double size = size_at(i), lost = lost_in_time(loads[i], std::fabs(s.end), s.h, size);
            const double noise = floor_.noise[mechanics_.system().joints[i].first()];
            const double allowed = (tolerance_ + 4 * rounding) * size + noise + lost + smallest;
            if (std::fabs(load_[i] - cheb::value(loads[i], x)) <= clearly * allowed) continue;
            seen_ = t;
            return false;
        }
        if (!mechanics_.nonlinear()) continue;
        for (std::size_t joint = 0; joint < belts.size(); ++joint) belts[joint] = mechanics_.belt(joint, t, Side::at);
        s.state(x, y);
        mechanics_.torques({t, Side::at, y}, mode, belts, load_, torques);
        for (std::size_t g = 0; g < frame.groups(); ++g) {
            double torque = 0, found = 0, allowed = 0;
            for (std::size_t i = 0; i < n_; ++i) {
                const double I = mechanics_.system().bodies[i].inertia;
                for (const auto& [group, by] : frame.bodies[i]) {
                    if (group != g) continue;
                    torque += by * torques[i];
                    found += by * I * cheb::value(accelerations[i], x);
                    allowed += std::fabs(by) * I * allowed_[i];
                }
            }
            if (!(std::fabs(torque - found) <= clearly * allowed)) return false;
        }
    }
    return true;
}

/// Functions that are read do nothing between the nodes that their series do not. Whether that is proven is told in the
/// stretch.
bool Collocation::hides_nothing(Segment& s, const Mode& mode) {
    constexpr double clearly = 64, hair = 16, of_last_iteration = 1e-9;
    constexpr int thorough = 64, tired = 4;
    const double late = std::max(std::fabs(s.start.hi), std::fabs(s.end));
    if (s.h <= 64 * rounding * late) return true;
    const int budget = unproven_in_a_row_ < tired ? thorough : 1;
    const bool named = mechanics_.system().named;
    const std::size_t told = 2 * n_ + mechanics_.states_of_user();
    const auto whole = [&](std::size_t k) {
        Series series = s.series[k];
        series[0] += s.y[k][0];
        return series;
    };
    // A stretch between breaks does not reach them.
    const auto time = [&](double delay) {
        Series t{};
        t[0] = s.start.hi + s.h - delay, t[1] = s.h;
        if (s.from_break || s.to_break) t[1] -= hair * rounding * late;
        return t;
    };
    const auto give_motion = [&](const model::Formula& formula, const Series* speed = nullptr) {
        if (formula.takes_motion() && !named) unseen_.give(1, whole(0)), unseen_.give(2, whole(n_));
        const std::size_t count = formula.state_count(), from = named ? 0 : 2, more = speed != nullptr ? 1 : 0;
        if (count == 0) return true;
        if (count != told - from + more) {
            s.proven = false;
            return false;
        }
        if (speed != nullptr) unseen_.give(formula.first_state(), *speed);
        for (std::size_t k = from; k < told; ++k) unseen_.give(formula.first_state() + more + k - from, whole(k));
        return true;
    };
    const auto found = [&](const Unseen::Found& what) {
        s.proven = s.proven && what.proven;
        if (what.place) seen_ = s.time(*what.place);
        return what.place.has_value();
    };
    bool good = true;
    /// `size` is what it acts beside, `allowed` how much of that, or of what it is itself, need not be known.
    const auto look = [&](double size, double allowed, double part) {
        if (unseen_.is_told(allowed, part)) return;
        std::optional<std::size_t> last;
        const auto* piece = unseen_.piece();
        for (std::size_t k = 0; piece != nullptr && k < piece->conditions.size() && good; ++k) {
            const std::size_t step = piece->conditions[k].step;
            if (std::exchange(last, step) == step) continue;
            const auto close = [&](const Series& series) { return of_last_iteration * cheb::size(series) + smallest; };
            good = !found(unseen_.search(step, budget, close));
        }
        if (!good) return;
        good = !found(unseen_.search({}, budget, [&](const Series& series) {
            return std::max(allowed, part * cheb::size(series)) + clearly * lost_in_time(series, late, s.h, size);
        }));
    };
    constexpr double always = clearly * 4 * rounding;
    const auto part_of = [&](const model::Formula& formula) {
        return std::max(clearly * tolerance_ + always, formula.takes_motion() ? of_last_iteration : 0);
    };
    const auto look_at_signal = [&](const Signal& signal, double size, double noise) {
        signal.for_each_read(s.time(0),
                             [&](model::Formula& formula, const model::terms::Piece* piece, double delay, double gain) {
                                 if (!good) return;
                                 unseen_.begin(formula, piece);
                                 unseen_.give(0, time(delay));
                                 if (!give_motion(formula)) return;
                                 const double own = size / std::fabs(gain);
                                 look(own, part_of(formula) * own + (clearly * noise + smallest) / std::fabs(gain), 0);
                             });
    };
    /// The function is given the motion and, before all states, a speed.
    const auto begin = [&](const Mechanics::Asked& asked, const Series& first, const Series* speed) {
        model::Formula* formula = good && asked.function != nullptr ? asked.function->read() : nullptr;
        if (formula == nullptr) return false;
        unseen_.begin(*formula, asked.piece);
        unseen_.give(0, first);
        return give_motion(*formula, speed);
    };
    // Beside the other torques, and what the body has in its motion.
    const auto beside = [&](std::size_t i) {
        return sizes_[i] + mechanics_.system().bodies[i].inertia * greatest(s.y[n_ + i]) / s.h;
    };
    // When a motion has died out, only the rounding of what has acted is left.
    const auto rough = [&](std::size_t k) { return std::max(floor_.noise[k], rounding * floor_.greatest[k]); };
    double slowest = model::never;
    for (std::size_t i = 0; i < n_; ++i) {
        slowest = std::min(slowest, beside(i) / mechanics_.system().bodies[i].inertia);
    }
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const model::Weight& first = mechanics_.system().joints[j].of.front();
        look_at_signal(mechanics_.loads()[j], beside(first.body) / std::fabs(first.by), rough(first.body));
    }
    look_at_signal(mechanics_.base_signal(), slowest, 0);
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) {
        if (!begin(mechanics_.asked_rate(k), time(0), nullptr)) continue;
        const double size = std::max({greatest(s.y[2 * n_ + k]) / s.h, greatest(s.f[2 * n_ + k]), fastest_rate_[k]});
        look(size, of_last_iteration * size + clearly * rough(n_ + k) + smallest, 0);
    }
    for (std::size_t e = 0; e < mechanics_.events(); ++e) {
        if (begin(mechanics_.asked_when(e), time(0), nullptr)) look(0, smallest, of_last_iteration);
    }
    for (const Signal& load : mechanics_.loads()) {
        load.for_each_relay_function([&](model::UserFunction& function) {
            const model::Formula* formula = function.read();
            if (formula == nullptr || formula->has_conditions_of_motion()) return;
            if (begin({&function}, time(0), nullptr)) look(0, smallest, of_last_iteration);
        });
    }
    for (std::size_t j = 0; j < mechanics_.joints() && good; ++j) {
        const model::Joint& joint = mechanics_.system().joints[j];
        const std::size_t body = joint.first();
        const auto between = [&](std::size_t from) {
            Series sum{};
            for (const auto& [of, by] : joint.of) add(sum, whole(from + of), by);
            return sum;
        };
        const double size = beside(body);
        if (mechanics_.has_belt(j)) {
            look_at_signal(mechanics_.belt_signal(j), std::max(fastest_belt_[j], greatest(s.y[n_ + body])), 0);
        }
        mechanics_.for_each_friction(j, mode, s.moment(node_count / 2, points_[0]),
                                     [&](const Signal& signal, double torque) {
                                         look_at_signal(signal, torque > 0 ? size / torque : model::never, 0);
                                     });
        const double allowed = of_last_iteration * size + clearly * rough(body) + smallest;
        if (begin(mechanics_.asked_spring(j), between(0), nullptr)) look(size, allowed, 0);
        const Slipping& how = mode.friction[j];
        const Mechanics::Asked law = mechanics_.asked_law(j);
        if (law.function == nullptr || how.way == model::Motion::stuck || mode.leans[j] != 0 || how.riding) continue;
        Series speed = difference(between(n_), cheb::fit(s.belts[j]));
        for (double& c : speed) c *= model::sign_of(how.way);
        const bool alone = joint.friction.function == nullptr;
        if (begin(law, alone ? speed : time(0), alone ? nullptr : &speed)) look(size, allowed, 0);
    }
    if (good) unproven_in_a_row_ = s.proven ? 0 : unproven_in_a_row_ + 1;
    return good;
}

/// The rounding of functions that are read, at the beginning of the stretch: of the torques on each body and of the
/// rate of each state.
std::vector<double> Collocation::roundings(const Segment& s, const Mode& mode) {
    std::vector<double> of(n_ + m_);
    const bool named = mechanics_.system().named;
    const std::size_t told = 2 * n_ + mechanics_.states_of_user(), from = named ? 0 : 2;
    const auto constant = [](double x) { return Series{x}; };
    const auto add_of = [&](std::size_t k, double gain, model::Formula& formula, const model::terms::Piece* piece,
                            double first, const double* speed) {
        unseen_.begin(formula, piece);
        unseen_.give(0, constant(first));
        if (formula.takes_motion() && !named) {
            unseen_.give(1, constant(s.y[0][0])), unseen_.give(2, constant(s.y[n_][0]));
        }
        std::size_t place = formula.first_state();
        const std::size_t behind = place + formula.state_count();
        if (speed != nullptr && place < behind) unseen_.give(place++, constant(*speed));
        for (std::size_t i = from; i < told && place < behind; ++i) unseen_.give(place++, constant(s.y[i][0]));
        const double rounded = std::fabs(gain) * unseen_.rounded();
        if (std::isfinite(rounded)) of[k] += rounded;
    };
    const auto add_asked = [&](std::size_t k, const Mechanics::Asked& asked, double first, const double* speed) {
        model::Formula* formula = asked.function != nullptr ? asked.function->read() : nullptr;
        if (formula != nullptr) add_of(k, 1, *formula, asked.piece, first, speed);
    };
    const double t = s.start.hi;
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) {
        add_asked(n_ + k, mechanics_.asked_rate(k), t, nullptr);
    }
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const model::Joint& joint = mechanics_.system().joints[j];
        double angle = 0, slip = -s.belts[j][0];
        for (const auto& [body, by] : joint.of) angle += by * s.y[body][0], slip += by * s.y[n_ + body][0];
        slip *= model::sign_of(mode.friction[j].way);
        const bool alone = joint.friction.function == nullptr;
        for (const auto& [body, by] : joint.of) {
            mechanics_.loads()[j].for_each_read(
                t, [&, k = body, per = by](model::Formula& formula, const auto* piece, double delay, double gain) {
                    add_of(k, per * gain, formula, piece, t - delay, nullptr);
                });
            add_asked(body, mechanics_.asked_spring(j), angle, nullptr);
            if (mode.friction[j].way != model::Motion::stuck)
                add_asked(body, mechanics_.asked_law(j), alone ? slip : t, alone ? nullptr : &slip);
        }
    }
    return of;
}

bool Collocation::found_noise(const Segment& s, const Mode& mode) {
    constexpr double stays = 0.3, alike = 0.1, varies = 8, above = 3, few_roundings = 16;
    bool found = false;
    std::vector<double> known;
    std::vector<double> y, loads, belts(mechanics_.joints()), torques, rates(m_);
    for (std::size_t i = 0; i < n_ + m_; ++i) {
        if (may_be_rough_[i] == 0) continue;
        const double of_all = cheb::tail(cheb::fit(acting(s, i)));
        const bool of_time = i < n_ && mechanics_.loads()[i].asks_functions() &&
                             !mechanics_.loads()[i].asks_the_motion() &&
                             2 * cheb::tail(cheb::fit(s.driven[i])) >= of_all;
        const Nodes& values = of_time ? s.driven[i] : acting(s, i);
        const double tail = of_time ? cheb::tail(cheb::fit(values)) : of_all;
        const Stalled before = std::exchange(stalled_[i], {s.start.hi, s.h, tail});
        const double size = i < n_ ? sizes_[i] : greatest(values);
        // A motion dies out, but the rounding of the terms that make its torques does not.
        const double ever = std::max(greatest(values), floor_.greatest[i]);
        const double most = of_time  ? most_noise * size
                            : i < n_ ? most_noise_of_motion * ever
                                     : most_noise_of_rate * tolerance_ * ever;
        double& noise = floor_.noise[i];
        if (!(tail > tolerance_ * size)) continue;
        if (!(tail <= most)) {  // of a motion that is nothing beside what its functions calculate with
            if (known.empty()) known = roundings(s, mode);
            if (tail <= few_roundings * known[i] && noise < 2 * tail)
                noise = std::max(2 * tail, known[i]), found = true;
            continue;
        }
        if (noise > 0 && tail <= varies * noise) {
            found = found || 2 * tail > noise;
            noise = std::max(noise, 2 * tail);
            continue;
        }
        if (before.from != s.start.hi || !(s.h < 0.95 * before.h) || !(tail > stays * before.tail)) continue;
        const auto here = [&](double t) {
            s.state(s.start.until(t) / s.h - 1, y);
            const Moment at{t, Side::at, y};
            if (i >= n_) {
                mechanics_.rates(at, rates.data(), &mode);
                return rates[i - n_];
            }
            mechanics_.loads_of_time(t, Side::at, loads);
            if (of_time) return loads[i];
            for (std::size_t joint = 0; joint < belts.size(); ++joint)
                belts[joint] = mechanics_.belt(joint, t, Side::at);
            mechanics_.torques(at, mode, belts, loads, torques);
            return torques[i];
        };
        const Roughness rough = roughness(here, {s.time(-0.9), s.time(0.1), s.time(0.8)}, rough_stretch * 2 * s.h);
        if (!(rough.usual > alike * tail)) continue;
        noise = above * std::max(tail, rough.most);
        found = true;
    }
    return found;
}

std::optional<double> Collocation::found_break(const Segment& s) const {
    if (!(unresolved_ > gross)) return {};
    std::vector<double> loads, begin;
    for (const Nodes& each : s.y) begin.push_back(each[0]);
    std::optional<double> first;
    const auto look = [&](const Nodes& values, double size, const auto& at) {
        if (!(cheb::tail(cheb::fit(values)) > gross * 1e-13 * size)) return;
        const auto found = find_break(s.times, values, at);
        if (!found || !(*found <= s.end) || s.start.until(*found) < 1e-6 * s.h) return;
        if (!first || *found < *first) first = *found;
    };
    // Functions of the motion are evaluated at one fixed state, so that only jumps in time are found.
    const auto of_motion = [&](const Signal& signal, double t, Side side) {
        return signal.samples_the_motion() ? signal.of_motion({t, side, begin}) : 0;
    };
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        const Signal& load = mechanics_.loads()[i];
        if (!load.has_script()) continue;
        Nodes values = s.loads[i];
        for (std::size_t j = 0; j < node_count; ++j) values[j] += of_motion(load, s.times[j], s.side(j));
        look(values, size_at(i), [&](double t) {
            mechanics_.loads_of_time(t, Side::at, loads);
            return loads[i] + of_motion(load, t, Side::at);
        });
    }
    mechanics_.for_each_signal([&](const Signal& signal) {
        const auto& of_bodies = mechanics_.loads();
        const bool looked =
            std::any_of(of_bodies.begin(), of_bodies.end(), [&](const Signal& load) { return &load == &signal; });
        if (looked || !signal.has_script() || (signal.asks_the_motion() && !signal.samples_the_motion())) return;
        const auto value = [&](double t, Side side) {
            return signal.of_time({t, side, {}}) + of_motion(signal, t, side);
        };
        Nodes values{};
        for (std::size_t j = 0; j < node_count; ++j) values[j] = value(s.times[j], s.side(j));
        look(values, greatest(values), [&](double t) { return value(t, Side::at); });
    });
    std::vector<double> rates(m_);
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) {
        const auto rate = [&](double t, Side side) {
            mechanics_.rates({t, side, begin}, rates.data());
            return rates[k];
        };
        Nodes values{};
        for (std::size_t j = 0; j < node_count; ++j) values[j] = rate(s.times[j], s.side(j));
        look(values, greatest(values), [&](double t) { return rate(t, Side::at); });
    }
    return first;
}

bool Collocation::belt_jumps(const Segment& s, std::size_t joint, double t) const {
    if (!mechanics_.has_belt(joint)) return false;
    constexpr double clearly = 1e-6;
    const double before = mechanics_.belt(joint, towards(t, Side::before), Side::at);
    const double jump = std::fabs(mechanics_.belt(joint, towards(t, Side::after), Side::at) - before);
    return jump > clearly * std::max(fastest_belt_[joint], greatest(s.belts[joint]));
}

std::optional<double> Collocation::jump_of_belt(const Segment& s, std::size_t joint) const {
    if (!mechanics_.has_belt(joint)) return {};
    constexpr double clearly = 1e-6, near = 1e-3;
    const Nodes& belts = s.belts[joint];
    const double seen = clearly * std::max(fastest_belt_[joint], greatest(belts));
    const auto [least, most] = std::minmax_element(belts.begin(), belts.end());
    const double change = *most - *least;
    std::size_t first = 1;  // of the greatest differences
    const auto difference = [&](std::size_t j) { return std::fabs(belts[j] - belts[j - 1]); };
    for (std::size_t j = 2; j < node_count; ++j) {
        if (difference(j) > 2 * difference(first)) first = j;
    }
    if (!(change > seen) || !(difference(first) > change / 4)) return {};
    const auto belt = [&](double t) { return mechanics_.belt(joint, t, Side::at); };
    const std::size_t from = std::max<std::size_t>(first, 2) - 2;
    const auto found = find_break(std::span(s.times).subspan(from, 3), std::span(belts).subspan(from, 3), belt);
    if (!found || !(*found > s.start.hi)) return {};
    // Of noise a jump is no more than what lies beside it.
    const double right_before = std::min(std::nextafter(*found, -model::never), *found - nearest_jump * s.h);
    const double before = belt(std::max(right_before, s.start.hi)), after = belt(*found);
    const double jump = std::fabs(after - before);
    if (!(jump > seen)) return {};
    for (const double part : {0.25, 0.5, 1.0}) {
        const double by = part * near * s.h;
        const double off_before = std::fabs(belt(std::max(*found - by, s.start.hi)) - before);
        const double off_after = std::fabs(belt(std::min(*found + by, s.end)) - after);
        if (!(std::max(off_before, off_after) < jump / 4)) return {};
    }
    return found;
}

void Collocation::stand_still(Segment& s, const std::vector<double>& y) const {
    make_room(s);
    s.proven = true;
    for (std::size_t k = 0; k < s.y.size(); ++k) s.y[k].fill(y[k]), s.series[k] = {};
    for (auto of : {&Segment::moved, &Segment::driven, &Segment::belts, &Segment::belt_rates, &Segment::holding}) {
        for (Nodes& values : s.*of) values.fill(0);
    }
}

/// Nothing that happens here can be seen: all goes on as it begins.
void Collocation::pass_over(Segment& s) const {
    s.proven = true;
    for (std::size_t k = 0; k < s.y.size(); ++k) {
        Nodes change{};
        const double rate = k < n_ ? s.y[n_ + k][0] : s.f[k][0];
        for (std::size_t j = 1; j < node_count; ++j) {
            change[j] = s.h * (1 + cheb::nodes[j]) * (std::isfinite(rate) ? rate : 0);
            s.y[k][j] = s.y[k][0] + change[j];
        }
        s.series[k] = cheb::fit(change);
        if (k < n_) s.moved[k] = change;
        s.f[k].fill(s.f[k][0]);
    }
    for (auto of : {&Segment::torques, &Segment::driven, &Segment::loads}) {
        for (Nodes& values : s.*of) values.fill(values[0]);
    }
    for (Nodes& held : s.holding) held.fill(held[0]);
}

}  // namespace dinal::motion::engine
