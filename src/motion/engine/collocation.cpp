#include "motion/engine/collocation.hpp"

#include <algorithm>
#include <cmath>

namespace dinal::motion::engine {

namespace {

constexpr int most_iterations = 40;
constexpr int many_iterations = 4;  // after so many iterations the slopes are recomputed for the next stretch
constexpr double much = 16;
// limit of the relative residual; a stiff rate multiplies the rounding of its steps
constexpr double most_left_over = 1e-6;
constexpr double least_stall = 1e-12;  // changes below this are rounding

}  // namespace

Flow::Attempt Collocation::accept(Segment& s, const Mode& mode, const Frame& frame) {
    judge(s, mode, frame);
    s.proven = true;
    const Attempt attempt = look_between(s, mode, frame);
    if (attempt == Attempt::resolved && mechanics_.nonlinear()) remember_end(s, frame);
    return attempt;
}

/// The initial guess: accelerations and rates are constant, equal to those of the first node.
void Collocation::guess(Segment& s, const Frame& frame) {
    const auto since = [&s](std::size_t j) { return s.h * (1 + cheb::nodes[j]); };
    for (std::size_t i = 0; i < n_; ++i) {
        const Frame::Shape& shape = frame.bodies[i];
        Nodes &way = s.moved[i], &p = s.y[i], &v = s.y[n_ + i];
        const Nodes &offset = offsets_.velocities[i], &offset_way = offsets_.ways[i];
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

/// The initial guess after a smooth stretch: extrapolates accelerations and rates. Returns false if no smooth stretch
/// precedes.
bool Collocation::extrapolate(const Segment& s, const Frame& frame) {
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

/// Computes velocities and angles from the accelerations of the groups, and states from their rates.
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
            const double first = s.y[n_ + i][0] - offsets_.velocities[i][0];
            for (double& v : velocity) v += first;
            integrate(velocity, s.h, way);
        }
        for (std::size_t b = i; b < n_; ++b) {
            if (b > i && frame.bodies[b] != shape) continue;
            placed_[b] = 1;
            Nodes moves = velocity, moved = way, angles{};
            if (mechanics_.has_belts()) add(moves, offsets_.velocities[b], 1), add(moved, offsets_.ways[b], 1);
            moves[0] = s.y[n_ + b][0], moved[0] = 0;
            for (std::size_t j = 0; j < node_count; ++j) angles[j] = s.y[b][0] + moved[j];
            s.y[b] = angles, s.y[n_ + b] = moves, s.moved[b] = moved;
        }
    }
    for (std::size_t k = 0; k < m_; ++k) {
        Nodes& z = s.y[2 * n_ + k];
        integrate(unknown_[frame.groups() + k], s.h, way);
        for (std::size_t j = 1; j < node_count; ++j) z[j] = z[0] + way[j];
    }
}

Flow::Attempt Collocation::find(Segment& s, const Mode& mode, const Frame& frame,
                                const std::vector<double>& departing) {
    const std::size_t count = frame.groups() + m_;
    unknown_.resize(count), found_.resize(count);
    residual_.resize(static_cast<Eigen::Index>(inner * count));
    if (count > 0) newton_.begin(mode, frame);  // keeps the slopes if everything stands still
    if (!mechanics_.nonlinear() && m_ == 0 && (count == 0 || newton_.knows_inverse(s, mode, frame, noise_.floor())))
        return find_at_once(s, mode, frame);
    // Near a jump of a rate, differences give a wrong slope; on a short segment the iteration converges without
    // slopes.
    for (const Slopes slopes : {Slopes::known, Slopes::here, Slopes::none}) {
        if (!evaluate(s, mode, frame, 0, 1, &departing)) return Attempt::failed;
        begin_at_first_node(s, frame);
        if (slopes == Slopes::known && mechanics_.nonlinear() && extrapolate(s, frame)) {
            place(s, frame);
        } else {
            guess(s, frame);
        }
        const Attempt attempt = iterate(s, mode, frame, slopes);
        if (attempt != Attempt::shorten) return attempt;
        if (slopes == Slopes::known && !newton_.find(s, mode, frame, 0, noise_.floor())) break;
        if (!mechanics_.nonlinear() && slopes == Slopes::here) break;
    }
    newton_.forget();
    return Attempt::shorten;
}

/// Solves a linear system exactly in one Newton step. It starts from a motion without acceleration, whose torques are
/// evaluated at all nodes.
Flow::Attempt Collocation::find_at_once(Segment& s, const Mode& mode, const Frame& frame) {
    for (Nodes& a : unknown_) a.fill(0);
    if (!follow_native(s, mode, frame)) {
        guess(s, frame);
        if (!evaluate(s, mode, frame)) return Attempt::failed;
    }
    const std::size_t groups = frame.groups();
    for (std::size_t g = 0; g < groups; ++g) unknown_[g][0] = found_[g][0];
    if (groups == 0) return Attempt::resolved;
    const Eigen::MatrixXd& slopes = *newton_.slopes(frame);
    for (std::size_t g = 0; g < groups; ++g) {
        Nodes& rest = found_[g];
        const double begin = rest[0];
        for (double& a : rest) a -= begin;
        for (std::size_t c = 0; c < groups; ++c) {
            const double of_angle = slopes(static_cast<Eigen::Index>(g), static_cast<Eigen::Index>(c));
            const double of_velocity = slopes(static_cast<Eigen::Index>(g), static_cast<Eigen::Index>(groups + c));
            if (of_angle == 0 && of_velocity == 0) continue;
            const double first = of_velocity * unknown_[c][0], second = of_angle * unknown_[c][0] / 2;
            for (std::size_t j = 0; j < node_count; ++j) {
                const double since = s.h * (1 + cheb::nodes[j]);
                rest[j] += since * (first + since * second);
            }
        }
        std::copy(rest.begin() + 1, rest.end(), residual_.data() + g * inner);
    }
    newton_.solve(s.h, frame, residual_, step_);
    for (std::size_t g = 0; g < groups; ++g) {
        for (std::size_t j = 1; j < node_count; ++j) {
            unknown_[g][j] = unknown_[g][0] + step_.data()[g * inner + j - 1];
        }
    }
    place(s, frame);
    double moves = 0, most = 0;
    for (const double step : step_) moves = std::max(moves, std::fabs(step));
    for (const Nodes& a : unknown_) most = std::max(most, greatest(a));
    if (newton_.error_of_length(s.h) * moves > 4 * rounding * most) return iterate(s, mode, frame, Slopes::known);
    const bool holds = !frame.edges.empty() || !frame.closing.empty();
    if (holds) return evaluate(s, mode, frame) ? Attempt::resolved : Attempt::failed;
    for (std::size_t i = 0; i < n_; ++i) {
        Nodes torque{};
        for (const auto& [group, by] : frame.bodies[i]) add(torque, unknown_[group], by * frame.inertia[group]);
        s.torques[i] = torque;
    }
    return Attempt::resolved;
}

/// Evaluates the torques of a motion without acceleration if all are native: those at the first node, changed by the
/// loads and the displacement. Returns false if other torques act.
bool Collocation::follow_native(Segment& s, const Mode& mode, const Frame& frame) {
    if (!mechanics_.all_linear() || mechanics_.has_belts()) return false;
    const std::size_t joints = mechanics_.joints();
    room_.load.resize(joints), room_.belt.resize(joints);
    for (std::size_t j = 0; j < joints; ++j) room_.load[j] = s.loads[j][0];
    const Moment begin = s.moment(0, room_.points[0]);
    mechanics_.torques(begin, mode, room_.belt, room_.load, room_.torque);
    for (std::size_t i = 0; i < n_; ++i) s.torques[i].fill(room_.torque[i]);
    for (std::size_t j = 0; j < joints; ++j) {
        const model::Joint& joint = mechanics_.system().joints[j];
        const double low = joint.stiffness * joint.sum(s.low);
        const double rate = joint.stiffness * mechanics_.velocity(j, begin.y) * s.h;
        Nodes change = s.loads[j];
        for (double& each : change) each -= room_.load[j] + low;
        for (std::size_t node = 0; node < node_count; ++node) change[node] -= rate * (1 + cheb::nodes[node]);
        for (const auto& [body, by] : joint.of) add(s.torques[body], change, by);
    }
    for (Nodes& found : found_) found.fill(0);
    for (std::size_t i = 0; i < n_; ++i) {
        for (const auto& [group, by] : frame.bodies[i]) add(found_[group], s.torques[i], by / frame.inertia[group]);
    }
    return std::all_of(room_.torque.begin(), room_.torque.end(), [](double torque) { return std::isfinite(torque); });
}

/// Sets all accelerations and rates to those of the first node.
void Collocation::begin_at_first_node(Segment& s, const Frame& frame) {
    for (std::size_t k = 0; k < unknown_.size(); ++k) unknown_[k].fill(found_[k][0]);
    for (std::size_t i = 0; i < n_; ++i) {
        s.f[n_ + i].fill(sum_of_groups(frame.bodies[i], [this](std::size_t g) { return unknown_[g][0]; }));
    }
    for (std::size_t k = 0; k < m_; ++k) s.f[2 * n_ + k].fill(found_[frame.groups() + k][0]);
}

/// Newton's iteration with these slopes. Returns `shorten` if it does not converge.
Flow::Attempt Collocation::iterate(Segment& s, const Mode& mode, const Frame& frame, Slopes slopes) {
    const std::size_t count = unknown_.size();
    const bool from_before = slopes == Slopes::known && newton_.known();
    double before = std::numeric_limits<double>::infinity();
    for (int i = 0; i < most_iterations; ++i) {
        if (!evaluate(s, mode, frame, 1)) {
            newton_.forget();  // the slopes may belong to a distant state
            strayed_ = std::any_of(s.y.begin(), s.y.end(), [](const Nodes& y) {
                return !std::all_of(y.begin(), y.end(), [](double x) { return std::isfinite(x); });
            });
            return Attempt::failed;
        }
        if (count == 0) return Attempt::resolved;
        if (slopes != Slopes::none && !newton_.known() &&
            !newton_.find(s, mode, frame, node_count / 2, noise_.floor())) {
            newton_.forget();
            strayed_ = true;
            return Attempt::failed;
        }
        const auto [left, small] = find_residual(s, frame);
        if (i > 0 && left <= 4 * rounding) return Attempt::resolved;
        if (slopes == Slopes::none) {
            step_ = residual_;
        } else {
            newton_.solve(s.h, frame, residual_, step_);
        }
        const auto [change, is_noise] = take_step(s.h);
        place(s, frame);
        if (!std::isfinite(change + left)) return Attempt::shorten;
        const double rate = before < std::numeric_limits<double>::infinity() ? change / before : 1;
        const bool converged =
            change <= 16 * rounding || (i >= 1 && change * rate <= 4 * rounding) || (i >= 2 && is_noise && rate > 0.3);
        // Slopes that are too large, such as those of a function's previous piece, make every Newton step too small.
        const bool doubtful = from_before && left > std::max(much * change, tolerance_);
        if (converged && doubtful) return Attempt::shorten;
        if (converged && small) {
            if (i >= many_iterations) newton_.forget();
            return Attempt::resolved;
        }
        if (i >= 3 && rate > 0.7) return Attempt::shorten;
        before = change;
    }
    return Attempt::shorten;
}

/// Computes the range of motion of each group and state, and the residual of its equation relative to that range.
Collocation::Residual Collocation::find_residual(const Segment& s, const Frame& frame) {
    const std::size_t groups = frame.groups(), count = unknown_.size();
    Residual found;
    find_sizes(s);
    scales_.resize(count), stalls_.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        double moves = 0, most = 0;
        if (k < groups) {
            for (std::size_t b = 0; b < n_; ++b) {
                for (const auto& [group, by] : frame.bodies[b]) {
                    if (group != k) continue;
                    const double share = std::fabs(by);
                    moves =
                        std::max(moves, greatest(s.y[n_ + b]) / share + s.h * share / frame.inertia[k] * sizes_.all[b]);
                }
            }
        } else {
            moves = greatest(s.y[2 * n_ + (k - groups)]) + s.h * greatest(unknown_[k]);
        }
        scales_[k] = moves + smallest;
        const double rough =
            k < groups ? noise_.of_torques() / frame.inertia[k] : noise_.floor().noise[n_ + (k - groups)];
        stalls_[k] = std::max(least_stall, of_tail * s.h * rough / scales_[k]);
        for (std::size_t j = 1; j < node_count; ++j) {
            const double rest = found_[k][j] - unknown_[k][j];
            residual_(static_cast<Eigen::Index>(k * inner + j - 1)) = rest;
            most = std::max(most, std::fabs(rest));
        }
        const double left = s.h * most / scales_[k];
        found.left = std::max(found.left, left);
        found.small = found.small && left <= std::max(most_left_over, stalls_[k]);
    }
    return found;
}

/// Applies the Newton step.
Collocation::Change Collocation::take_step(double h) {
    Change change;
    for (std::size_t k = 0; k < unknown_.size(); ++k) {
        double most = 0;
        for (std::size_t j = 1; j < node_count; ++j) {
            const double step = step_(static_cast<Eigen::Index>(k * inner + j - 1));
            unknown_[k][j] += step;
            most = std::max(most, std::fabs(step));
        }
        const double own = h * most / scales_[k];
        change.most = std::max(change.most, own);
        change.is_noise = change.is_noise && own <= stalls_[k];
    }
    return change;
}

}  // namespace dinal::motion::engine
