#include "motion/engine/modes.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>

#include "algebra/decompositions.hpp"
#include "motion/engine/balance.hpp"
#include "motion/engine/mechanics.hpp"
#include "motion/engine/moving.hpp"

namespace dinal::motion::engine {

std::vector<model::Oscillator> modes_of(const model::System& system) {
    const auto n = static_cast<Eigen::Index>(system.bodies.size());
    // y' = A y for all angles followed by all velocities.
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    A.topRightCorner(n, n).setIdentity();
    for (const model::Joint& joint : system.joints) {
        for (const model::Weight& on : joint.of) {
            const auto row = n + static_cast<Eigen::Index>(on.body);
            if (system.bodies[on.body].moved) continue;
            for (const model::Weight& turned : joint.of) {
                const auto column = static_cast<Eigen::Index>(turned.body);
                const double share = -on.by * turned.by / system.bodies[on.body].inertia;
                A(row, column) += share * joint.stiffness;
                A(row, n + column) += share * joint.damping;
            }
        }
    }
    std::vector<model::Oscillator> modes;
    for (const std::complex<double>& value : algebra::eigenvalues(A)) {
        if (value.imag() < 0) continue;
        const bool swings = value.imag() > 0;
        const auto mode = model::Oscillator::make({.inertia = 1,
                                                   .stiffness = swings ? std::norm(value) : 0,
                                                   .damping = std::max(0.0, (swings ? -2 : -1) * value.real())});
        if (mode) modes.push_back(*mode);
    }
    return modes;
}

/// Uses the greatest row sum of stiffness over inertia (Gershgorin).
text::Expected<model::Oscillator> no_slower_than_modes(const model::System& system) {
    std::vector<double> sums(system.bodies.size(), 0);
    for (const model::Joint& joint : system.joints) {
        double all = 0;
        for (const model::Weight& turned : joint.of) all += std::fabs(turned.by);
        for (const model::Weight& on : joint.of) {
            if (system.bodies[on.body].moved) continue;
            sums[on.body] += std::fabs(on.by) * all * joint.stiffness / system.bodies[on.body].inertia;
        }
    }
    const double most = sums.empty() ? 0 : *std::max_element(sums.begin(), sums.end());
    return model::Oscillator::make({.inertia = 1, .stiffness = most});
}

namespace {

using model::Motion;

/// A system near a steady motion, as a function of the coordinates of its groups and states.
class Beside {
public:
    explicit Beside(const Moving& given)
        : given_(given),
          convention_{.named = given.system.named,
                      .passed = 2 * given.system.bodies.size() + given.drive.states.size()},
          mechanics_(given.system, given.drive, convention_) {
        const std::size_t joints = mechanics_.joints();
        y_ = given.drive.theta0;
        y_.insert(y_.end(), given.drive.velocity0.begin(), given.drive.velocity0.end());
        for (const model::OwnState& state : given.drive.states) y_.push_back(state.start);
        y_.resize(2 * bodies() + mechanics_.states(), 0);
        mode_.friction.resize(joints), mode_.leans.assign(joints, 0), mode_.presses.assign(joints, 0);
        mode_.sliders.assign(mechanics_.sliders().size(), Motion::stuck);
        mode_.rubs = mechanics_.rubbing();
        for (std::size_t j = 0; j < joints; ++j) {
            const model::Joint& joint = given.system.joints[j];
            mode_.rigid.push_back(joint.rigid ? 1 : 0);
            belts_.push_back(mechanics_.belt(j, 0, Side::after));
            if (mechanics_.may_open(j) && mechanics_.pressing(j, here(y_)) <= 0) mode_.rubs[j] = 0;
            if (mode_.rubs[j] == 0 || joint.rigid || slip(j) == 0) continue;
            mode_.friction[j].way = model::motion_of(slip(j));
            mode_.friction[j].range = mechanics_.range_of(j, std::fabs(slip(j)));
            slowest_ = std::min(slowest_, std::fabs(slip(j)));
        }
        frame_.emplace(given.system, mode_);
        std::vector<double> offsets;
        frame_->offsets(belts_, mode_, offsets);
        for (std::size_t i = 0; i < bodies(); ++i) y_[bodies() + i] = offsets[i];
        mechanics_.set_law_directions(mode_);
        // The deflections of bristles without slip and of slider springs follow their joints' angles.
        for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) free_.push_back(2 * bodies() + k);
        for (std::size_t b = 0; b < mechanics_.bristles().size(); ++b) {
            const std::size_t joint = mechanics_.bristles()[b], k = 2 * bodies() + mechanics_.states_of_user() + b;
            if (belts_[joint] == 0) {
                bends_.emplace_back(k, joint);
            } else {
                free_.push_back(k);
                slowest_ = std::min(slowest_, std::fabs(belts_[joint]));
            }
        }
        // On a belt sliders slide, and their springs keep their bend.
        for (std::size_t s = 0; s < mechanics_.sliders().size(); ++s) {
            const Mechanics::Slider& slider = mechanics_.sliders()[s];
            if (slip(slider.joint) == 0) {
                bends_.emplace_back(slider.bend, slider.joint);
            } else {
                mode_.sliders[s] = model::motion_of(slip(slider.joint));
                y_[slider.bend] = model::sign_of(mode_.sliders[s]) * slider.limit / slider.stiffness;
            }
        }
    }

    std::size_t bodies() const { return mechanics_.bodies(); }
    Eigen::Index groups() const { return static_cast<Eigen::Index>(frame_->groups()); }
    Eigen::Index states() const { return static_cast<Eigen::Index>(free_.size()); }

    /// Finds the state in which all accelerations and rates are zero.
    [[nodiscard]] std::optional<text::Error> settle() {
        constexpr int most = 60;
        constexpr double nearly = 1e-11;
        Eigen::VectorXd x = Eigen::VectorXd::Zero(2 * groups() + states());
        if (x.size() == 0) return holds();
        for (int i = 0; i < most; ++i) {
            press(state_at(x));
            const Eigen::VectorXd rest = at(x);
            if (!rest.allFinite()) return text::Error{"a torque is not finite beside the rest"};
            Eigen::MatrixXd slopes = slopes_at(x);
            slopes.middleCols(groups(), groups()).setZero();
            const double size = rest.cwiseAbs().maxCoeff(), rounded = 64 * rounding * size / of_difference;
            if (mechanics_.nonlinear()) slopes = (slopes.array().abs() > rounded).select(slopes, 0);
            const Eigen::VectorXd step = algebra::pseudo_inverse(slopes) * rest;
            const double left = (rest - slopes * step).cwiseAbs().maxCoeff();
            if (left > 1e-6 * size && size > nearly * torque_scale()) {
                if (!mechanics_.nonlinear())
                    return text::Error{"there is no rest: nothing holds the bodies against what acts on them"};
                x.head(groups()) += rest.head(groups());  // a nonlinear spring may begin without a slope
                continue;
            }
            x -= step;
            x.segment(groups(), groups()).setZero();
            if (step.cwiseAbs().maxCoeff() <= nearly * std::max(1.0, x.cwiseAbs().maxCoeff())) {
                y_ = state_at(x);
                return holds();
            }
        }
        return text::Error{"no rest was found near theta0"};
    }

    [[nodiscard]] std::vector<EigenMode> modes() {
        const Eigen::Index G = groups(), m = states(), size = 2 * G + m;
        if (size == 0) return {};
        const Eigen::MatrixXd slopes = slopes_at(Eigen::VectorXd::Zero(size));
        Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size);
        A.block(0, G, G, G).setIdentity();
        A.bottomRows(G + m) = slopes;
        const algebra::Eigenpairs pairs = algebra::eigenpairs(A);
        std::vector<EigenMode> all;
        for (Eigen::Index k = 0; k < size; ++k) {
            if (pairs.values(k).imag() < 0) continue;
            EigenMode mode{pairs.values(k)};
            std::complex<double> greatest = 0;
            for (std::size_t i = 0; i < bodies(); ++i) {
                std::complex<double> turned = 0;
                for (const auto& [group, by] : frame_->bodies[i]) {
                    turned += by * pairs.vectors(static_cast<Eigen::Index>(group), k);
                }
                mode.shape.push_back(turned);
                if (std::abs(turned) > std::abs(greatest) * (1 + 1e-9)) greatest = turned;
            }
            for (auto& turned : mode.shape) turned = greatest == 0.0 ? 0 : turned / greatest;
            all.push_back(std::move(mode));
        }
        std::sort(all.begin(), all.end(), [](const EigenMode& a, const EigenMode& b) {
            return std::pair(a.value.imag(), a.value.real()) < std::pair(b.value.imag(), b.value.real());
        });
        return all;
    }

private:
    static constexpr double of_difference = 1e-3;  ///< the step of differences where torques are nonlinear

    [[nodiscard]] static Moment here(std::span<const double> y) { return {0, Side::after, y}; }
    double slip(std::size_t joint) const {
        return given_.system.joints[joint].sum(given_.drive.velocity0) - belts_[joint];
    }
    double torque_scale() const {
        double most = std::numeric_limits<double>::min();
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) most = std::max(most, mechanics_.size_of(j, here(y_)));
        return most;
    }
    void press(const std::vector<double>& y) {
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            const auto& stops = given_.system.joints[j].stops;
            if (!stops) continue;
            const double q = mechanics_.angle(j, y);
            mode_.presses[j] = q > stops->upper ? 1 : q < stops->lower ? -1 : 0;
        }
    }
    std::vector<double> state_at(const Eigen::VectorXd& x) const {
        std::vector<double> y = y_;
        for (std::size_t i = 0; i < bodies(); ++i) {
            for (const auto& [group, by] : frame_->bodies[i]) {
                y[i] += by * x(static_cast<Eigen::Index>(group));
                y[bodies() + i] += by * x(groups() + static_cast<Eigen::Index>(group));
            }
        }
        for (std::size_t k = 0; k < free_.size(); ++k) y[free_[k]] += x(2 * groups() + static_cast<Eigen::Index>(k));
        for (const auto& [bend, joint] : bends_) {
            y[bend] = y_[bend] + mechanics_.angle(joint, y) - mechanics_.angle(joint, y_);
        }
        return y;
    }
    /// Accelerations of the groups and rates of the states.
    [[nodiscard]] Eigen::VectorXd at(const Eigen::VectorXd& x) {
        const std::vector<double> y = state_at(x);
        mechanics_.for_each_piecewise(0, [&](Piecewise& function) { function.decide(here(y), ~std::uint64_t{0}); });
        mechanics_.loads_of_time(0, Side::after, loads_);
        mechanics_.torques(here(y), mode_, belts_, loads_, torques_);
        Eigen::VectorXd out = Eigen::VectorXd::Zero(groups() + states());
        for (std::size_t i = 0; i < bodies(); ++i) {
            for (const auto& [group, by] : frame_->bodies[i]) {
                out(static_cast<Eigen::Index>(group)) += by * torques_[i] / frame_->inertia[group];
            }
        }
        std::vector<double> rates(mechanics_.states());
        mechanics_.rates(here(y), rates.data(), &mode_);
        for (std::size_t k = 0; k < free_.size(); ++k) {
            out(groups() + static_cast<Eigen::Index>(k)) = rates[free_[k] - 2 * bodies()];
        }
        return out;
    }
    /// The Jacobian by differences of fourth order; a linear system uses wide ones, which lose no digits.
    [[nodiscard]] Eigen::MatrixXd slopes_at(const Eigen::VectorXd& x) {
        const bool wide = !mechanics_.nonlinear();
        Eigen::MatrixXd slopes(groups() + states(), x.size());
        for (Eigen::Index c = 0; c < x.size(); ++c) {
            const bool is_speed = c >= groups() && c < 2 * groups();
            const double d = wide ? 1 : of_difference * (is_speed ? std::min(1.0, slowest_) : 1);
            const auto moved = [&](double by) {
                Eigen::VectorXd there = x;
                there(c) += by;
                return at(there);
            };
            slopes.col(c) = (8 * (moved(d) - moved(-d)) - (moved(2 * d) - moved(-2 * d))) / (12 * d);
        }
        return slopes;
    }
    /// The torques of holding joints, with the bodies at these angles.
    [[nodiscard]] std::vector<double> held_at(std::vector<double> y) {
        std::swap(y_, y);
        static_cast<void>(at(Eigen::VectorXd::Zero(2 * groups() + states())));
        std::swap(y_, y);
        std::vector<double> lacking(bodies()), held(mechanics_.joints());
        for (std::size_t i = 0; i < bodies(); ++i) lacking[i] = -torques_[i];
        frame_->multipliers(lacking, held);
        return held;
    }
    /// Checks that the rest is between the walls, and that the holding joints can hold.
    [[nodiscard]] std::optional<text::Error> holds() {
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            const model::Joint& joint = given_.system.joints[j];
            if (!joint.walls || !joint.walls->crossed_by(mechanics_.angle(j, y_))) continue;
            return text::error("there is no rest between the walls{}, against which it leans",
                               joint.name.empty() ? "" : " of " + joint.name);
        }
        std::vector<double> held = held_at(y_);
        for (std::size_t j = 0; j < held.size(); ++j) {
            if (!mode_.holds(j) || mode_.rigid[j] != 0) continue;
            const double limit = mechanics_.holding(j, held[j] < 0 ? Motion::forward : Motion::backward, here(y_));
            if (std::fabs(held[j]) <= limit * (1 + 1e-9)) continue;
            // A load or spring that jumps here and drives the joint back may hold it with any value in between.
            const std::vector<double> slip = slip_alone(mechanics_, mode_, j);
            std::array<double, 2> beside{};
            for (const Motion side : {Motion::backward, Motion::forward}) {
                std::vector<double> y;
                static_cast<void>(just_beside(here(y_), slip, {side, Motion::stuck}, y));
                beside[side == Motion::forward ? 1 : 0] = held_at(y)[j];
            }
            if (beside[0] < beside[1] && beside[0] <= limit && beside[1] >= -limit) continue;
            const std::string& name = given_.system.joints[j].name;
            return text::error("there is no rest: the friction{} would have to hold {:.6g}, but holds {:.6g}",
                               name.empty() ? "" : " of " + name, std::fabs(held[j]), limit);
        }
        return {};
    }

    const Moving& given_;
    CallConvention convention_;
    Mechanics mechanics_;
    Mode mode_;
    std::optional<Frame> frame_;
    std::vector<double> belts_, y_, loads_, torques_;
    std::vector<std::size_t> free_;  ///< indices of the independent states
    /// The deflections that follow the angle of a joint: their indices in y, and the joint.
    std::vector<std::pair<std::size_t, std::size_t>> bends_;
    double slowest_ = model::never;  ///< least speed of slip, also of bristles on a belt
};

}  // namespace

text::Expected<std::vector<EigenMode>> modes_beside(const model::System& system, const model::Drive& drive) {
    const Moving given(system, drive, 0, 1);
    Beside beside(given);
    if (auto wrong = beside.settle()) return *wrong;
    return beside.modes();
}

}  // namespace dinal::motion::engine
