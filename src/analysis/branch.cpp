#include "analysis/branch.hpp"

#include <algorithm>
#include <cmath>

#include "algebra/decompositions.hpp"

namespace dinal::analysis {
namespace {

// Lengths along the curve: the unknowns are scaled by the motion's size, the parameter by its range.
constexpr double first_step = 0.01, longest_step = 0.08, shortest_step = 1e-9;
constexpr double closes = 1e-11;  // residual of a branch point, relative to the motion
constexpr double nearly_closes = 1e-9;
constexpr double straight = 0.9;      // least cosine of the angle between tangents of one step
constexpr double corner_step = 1e-3;  // a step this short indicates a corner, such as the onset of stops
constexpr double creeping = 1e-4;     // the walk ends after many steps this short
constexpr int most_creeps = 40;
constexpr int most_corners = 10;      // in a row: the walk is at the edge of a family, not of a curve
constexpr double least_slope = 1e-7;  // least |dp/ds| beside a fold
constexpr double upright = 1e-6;      // error of dp/ds; below it the branch is vertical
constexpr double dying = 1e-2;        // smallest unit, relative to the greatest motion
constexpr double vanishes = 1e-3;     // a cycle smaller than this counts as a rest
constexpr double boundless = 1e8;     // a motion grown by this factor is at a resonance without a periodic motion

/// A test function that is zero where a multiplier is -1; the next one is zero where a pair is on the unit circle.
double doubling_test(const Eigen::MatrixXd& D) {
    return algebra::determinant(D + Eigen::MatrixXd::Identity(D.rows(), D.cols()));
}
double pair_test(const Eigen::MatrixXd& D) {
    if (D.rows() == 2) return algebra::determinant(D) - 1;
    const Eigen::VectorXcd m = algebra::eigenvalues(D);
    std::complex<double> product = 1;
    for (Eigen::Index i = 0; i < m.size(); ++i) {
        for (Eigen::Index j = 0; j < i; ++j) product *= m[i] * m[j] - 1.0;
    }
    return product.real();
}

/// Returns whether the two multipliers whose product is nearest to 1 are complex, as at a torus point.
bool has_complex_pair(const Eigen::MatrixXd& D) {
    const Eigen::VectorXcd m = algebra::eigenvalues(D);
    double least = 0.1;
    bool complex = false;
    for (Eigen::Index i = 0; i < m.size(); ++i) {
        for (Eigen::Index j = 0; j < i; ++j) {
            const double off = std::abs(m[i] * m[j] - 1.0);
            if (off < least) least = off, complex = std::fabs(m[i].imag()) > 1e-6;
        }
    }
    return complex;
}

/// The number of complex multipliers outside of the unit circle.
int growing_in_pairs(const Eigen::MatrixXd& D) {
    int growing = 0;
    for (const std::complex<double>& m : algebra::eigenvalues(D)) {
        if (std::fabs(m.imag()) > 1e-6 && std::abs(m) > 1) ++growing;
    }
    return growing;
}

/// Returns whether a branch becomes symmetric: three branches meet at such a corner, and the symmetric one continues
/// both ways.
bool becomes_symmetric(const SteadyMotion& from, const SteadyMotion& to) {
    const auto is_even = [](const SteadyMotion& motion) {
        return std::fabs(motion.high + motion.low) < 1e-6 * (motion.high - motion.low);
    };
    return is_even(to) && !is_even(from);
}

class PeriodCircuit final : public Circuit {
public:
    PeriodCircuit(const Family& family, double p, const SteadyMotion& motion, int periods,
                  const motion::Monitor& monitor)
        : family_(family), monitor_(monitor), periods_(periods) {
        half_ = motion.symmetric;
        const SteadyQuestion question = family_(p);
        first_ = map(question).place(motion.start);
    }

    Lap lap(const Eigen::VectorXd& x, double p) override {
        const SteadyQuestion question = family_(p);
        const PeriodMap map = this->map(question);
        Lap lap{.to = {}, .step = map.step(Place(x))};
        lap.to = sign() * lap.step.to;
        lap.finished = lap.step.finished;
        if (lap.step.differentiable) lap.derivative = sign() * lap.step.derivative;
        note_outcome(lap.step.outcome, map.contradiction());
        return lap;
    }

    SteadyMotion motion(const Eigen::VectorXd& x, double p, const Lap& lap,
                        const Eigen::MatrixXd& derivative) override {
        const SteadyQuestion question = family_(p);
        MapStep step = lap.step;
        step.derivative = sign() * derivative;
        step.differentiable = true;
        return facts_of(question, map(question), step, Place(x), periods_);
    }

    Eigen::VectorXd units(const Eigen::VectorXd& x, const Lap& lap, const SteadyMotion& /*motion*/) const override {
        return Eigen::Vector2d::Constant(PeriodMap::size_of(Place(x), lap.step));
    }
    double difference() const override { return 1e-6; }

private:
    double sign() const { return half_ ? -1 : 1; }
    PeriodMap map(const SteadyQuestion& question) const {
        return half_ ? PeriodMap::half(question, monitor_) : PeriodMap(question, periods_, monitor_);
    }

    const Family& family_;
    const motion::Monitor& monitor_;
    int periods_;
};

class BranchWalk {
public:
    /// `values` of the parameter: increasing, at least two. All arguments must outlive the walk.
    BranchWalk(Circuit& circuit, std::span<const double> values)
        : circuit_(circuit), values_(values), range_(values.back() - values.front()), slack_(1e-12 * range_) {}

    /// Walks from the circuit's first place at this parameter towards greater (way = 1) or smaller (-1) values.
    BranchPath walk(double parameter, double way) {
        const auto first = begun(parameter);
        if (!first) return path_;
        return followed(*first, tangent(*first, way * across()));
    }

    /// Switches to the branch that begins at this parameter, such as that of a doubling with a circuit of twice the
    /// periods.
    BranchPath walk_aside(double parameter) {
        const auto first = begun(parameter);
        if (!first) return path_;
        // The direction of the disturbance that persists.
        const Eigen::Index n = units_.size();
        const Slopes slopes = scaled(first->slopes).leftCols(n);
        Vector aside = Vector::Zero(n + 1);
        aside.head(n) = algebra::most_shortened(slopes);
        constexpr double away = 1e-2;
        const Vector guess = scaled(*first) + away * aside;
        const auto there = spot_at(guess);  // the slopes on the old branch do not determine the new one
        auto next = there ? correct(guess, aside, there->slopes) : std::nullopt;
        if (!next) {
            path_.end = WalkEnd::lost;
            return path_;
        }
        find_motion(*next);
        add(*next, BranchKind::point);
        return followed(*next, tangent(*next, scaled(*next) - scaled(*first)));
    }

    /// Walks from a limit cycle towards larger ones.
    BranchPath walk_up(double parameter) {
        const auto first = begun(parameter);
        if (!first) return path_;
        Vector ahead = Vector::Zero(units_.size() + 1);
        ahead.head(units_.size()) = circuit_.growth().cwiseQuotient(units_);
        return followed(*first, tangent(*first, ahead));
    }

private:
    using Vector = Eigen::VectorXd;
    using Slopes = Eigen::MatrixXd;  // derivatives of the residual with respect to x and p

    /// A fixed point, with the derivatives of the residual.
    struct Spot {
        Vector x = {};
        double p = 0;
        Circuit::Lap lap = {};
        Slopes slopes = {};
        SteadyMotion motion = {};
        Slopes derivative() const { return slopes.leftCols(x.size()) + Slopes::Identity(x.size(), x.size()); }
    };
    using Test = std::function<double(const Spot&)>;
    struct Special {
        Spot spot;
        BranchKind kind;
    };
    /// A point before the present one.
    struct Passed {
        Vector x = {}, slope = {};  // slope with respect to p
        double p = 0;
    };
    struct Progress {
        const Spot& first;
        const Vector& first_ahead;
        Spot now;
        Vector ahead;                       // tangent at `now`, in the direction of the walk
        double longest = first_step;        // limit of the next step
        int creeps = 0;                     // short steps since the last long one
        int corners = 0;                    // corners rounded since the last step that was longer than one
        std::optional<Passed> passed = {};  // none after a corner
        bool recentred = false;             // whether `first` lies on a section that the walk has left
    };
    struct Step {
        double target, left;  // the next requested parameter value, and the distance to it in ranges
        bool reaches;         // whether the step ends there
        double length;
    };
    /// The last point at which a test function exceeded its rounding.
    struct Anchor {
        Spot spot;
        double value = 0;
    };

    Vector scaled(const Spot& spot) const {
        Vector y(spot.x.size() + 1);
        y << spot.x.cwiseQuotient(units_), spot.p / range_;
        return y;
    }
    /// The derivatives of the scaled residual with respect to the scaled unknowns.
    Slopes scaled(const Slopes& slopes) const {
        Vector columns(units_.size() + 1);
        columns << units_, range_;
        return units_.cwiseInverse().asDiagonal() * slopes * columns.asDiagonal();
    }

    /// Scaled slopes below this are rounding.
    static double noise_of(const Spot& spot) {
        constexpr double of_derivatives = 1e-12, of_differences = 1e-7;
        return spot.lap.derivative ? of_derivatives : of_differences;
    }
    /// The scaled slopes with rows of length 1; a row below the noise is 0.
    Slopes normalised(const Spot& spot) const {
        Slopes slopes = scaled(spot.slopes);
        for (Eigen::Index i = 0; i < slopes.rows(); ++i) {
            const double size = slopes.row(i).norm();
            slopes.row(i) /= size > noise_of(spot) ? size : model::never;
        }
        return slopes;
    }
    /// Returns whether fixed points form a surface here, as where a body may rest anywhere.
    bool is_family(const Spot& spot) const {
        return !(std::fabs(algebra::free_direction(normalised(spot)).last_pivot) > noise_of(spot));
    }
    /// The unit tangent of the curve in the direction of `before`; of a surface, the shortest way to other parameters.
    Vector tangent(const Spot& spot, const Vector& before) const {
        const Slopes slopes = normalised(spot);
        const algebra::FreeDirection free = algebra::free_direction(slopes);
        const Eigen::Index n = slopes.rows();
        if (!(std::fabs(free.last_pivot) > noise_of(spot))) {
            Vector along(n + 1);
            along << algebra::solve_by_singular_values(slopes.leftCols(n), -slopes.col(n), noise_of(spot)), 1;
            return along.normalized() * (before[n] < 0 ? -1 : 1);
        }
        const Vector& t = free.direction;
        return t * (t.dot(before) < 0 ? -1 : 1);
    }

    Vector across() const { return Vector::Unit(units_.size() + 1, units_.size()); }

    BranchPath followed(const Spot& first, const Vector& first_ahead) {
        Progress walk{.first = first, .first_ahead = first_ahead, .now = first, .ahead = first_ahead};
        const double smallest = units_.maxCoeff();
        orientation_ = orientation(first.slopes, first_ahead);
        specials_before(first, first_ahead);  // sets the anchors
        const std::size_t most_points = 2000 + 20 * values_.size();
        path_.end = WalkEnd::lost;
        while (path_.points.size() < most_points) {
            rescale(walk.now, walk.ahead);
            if (greatest_.maxCoeff() > boundless * smallest) return ended(WalkEnd::vanished);
            const Step step = next_step(walk);
            if (step.left * range_ <= slack_) return ended(WalkEnd::range);
            auto spot = end_of_step(walk, step);
            if (circuit_.stopped()) return ended(WalkEnd::stopped);
            const Vector moved = spot ? Vector(scaled(*spot) - scaled(walk.now)) : Vector::Zero(walk.now.x.size() + 1);
            const Vector on = spot ? tangent(*spot, moved) : walk.ahead;
            const bool close =
                spot && moved.norm() <= 2 * step.length && moved.dot(walk.ahead) > straight / 2 * moved.norm();
            if (!close || on.dot(walk.ahead) <= straight) {
                const Bend bend = handle_bend(walk, step.length, close);
                if (bend == Bend::lost) return path_;
                if (bend == Bend::retry) continue;
            }
            if (step.length > corner_step) orientation_ = orientation(spot->slopes, on), walk.corners = 0;
            walk.creeps = step.length < creeping ? walk.creeps + 1 : 0;
            walk.longest = std::min(longest_step, 1.5 * walk.longest);
            find_motion(*spot);
            if (!circuit_.is_half() && becomes_symmetric(walk.now.motion, spot->motion)) return path_;
            const bool moves = spot->motion.status == SteadyStatus::steady;
            if (moves && is_family(*spot) != is_family(walk.now)) return path_;
            if (!add_step(walk, *spot, specials_of_step(walk, *spot, on, moved))) return ended(WalkEnd::range);
            if (handle_met_point()) return path_;
            if (is_closed(walk, *spot, on, step.length)) return ended(WalkEnd::closed);
            if (has_vanished(*spot)) return ended(WalkEnd::vanished);
            walk.passed = Passed{walk.now.x, slope_by_p(walk.ahead), walk.now.p};
            walk.ahead = on;
            if (!recentre(walk, *spot)) return path_;
            walk.now = std::move(*spot);
        }
        return path_;
    }

    BranchPath ended(WalkEnd end) {
        path_.end = end;
        return path_;
    }

    Step next_step(const Progress& walk) const {
        const double by_p = walk.ahead[walk.now.x.size()];
        const double target = next_value(walk.now.p, by_p);
        const double left = std::fabs(target - walk.now.p) / range_;
        const bool reaches = left <= walk.longest * std::fabs(by_p);
        return {target, left, reaches, reaches ? left / std::fabs(by_p) : walk.longest};
    }

    /// The point of the branch at the end of a step; none if the correction of the guess fails.
    std::optional<Spot> end_of_step(const Progress& walk, const Step& step) {
        reach_ = step.length;
        Vector guess = scaled(walk.now) + step.length * walk.ahead;
        if (step.reaches) {
            if (walk.passed) curve_on(guess, *walk.passed, walk.now, walk.ahead, step.target);
            guess[walk.now.x.size()] = step.target / range_;
        }
        rough_ = true;
        auto spot = correct(guess, step.reaches ? across() : walk.ahead, walk.now.slopes);
        rough_ = false;
        return spot;
    }

    /// Handles a step that turned too far, or found no point: continues behind a corner, or shortens the step.
    /// `stands`: a short step across a corner that was not rounded is kept.
    enum class Bend { stands, retry, lost };
    Bend handle_bend(Progress& walk, double length, bool close) {
        const bool corner = close && length < corner_step;
        const bool stalls = length / 2 <= shortest_step || walk.creeps > most_creeps;
        if ((corner || stalls) && walk.corners < most_corners && round_corner(walk.now, walk.ahead, length)) {
            ++walk.corners;
            walk.longest = first_step, walk.creeps = 0;
            walk.passed.reset();
            return Bend::retry;
        }
        if (stalls) return Bend::lost;
        walk.longest = length / 2;
        return corner ? Bend::stands : Bend::retry;
    }

    /// The special points of a step to `spot`, where the tangent is `on`, in order.
    std::vector<Special> specials_of_step(const Progress& walk, const Spot& spot, const Vector& on,
                                          const Vector& moved) {
        const Vector& ahead = walk.ahead;
        const Eigen::Index n = spot.x.size();
        std::vector<Special> specials = specials_before(spot, ahead);
        // At a Hopf point the branch is vertical, and the sign of its slope is rounding.
        const bool turns = on[n] * ahead[n] < 0 && std::max(std::fabs(on[n]), std::fabs(ahead[n])) > upright;
        if (!turns) return specials;
        const Test slope = [&](const Spot& at) { return tangent(at, moved)[n]; };
        if (auto fold = zero_between(walk.now, spot, ahead[n], on[n], slope)) {
            const auto after = std::ranges::find_if(
                specials, [&](const Special& special) { return ahead.dot(scaled(special.spot) - scaled(*fold)) > 0; });
            specials.insert(after, {std::move(*fold), BranchKind::fold});
        }
        return specials;
    }

    /// Adds the points of a step. Returns whether the branch continues inside the range.
    bool add_step(const Progress& walk, const Spot& spot, const std::vector<Special>& specials) {
        bool inside = true;
        const Spot* from = &walk.now;
        for (const Special& special : specials) {
            if (walk.ahead.dot(scaled(special.spot) - scaled(walk.now)) < 0) {  // at the present point, to rounding
                add(special.spot, special.kind);
                continue;
            }
            inside = inside && add_way(*from, special.spot, special.kind);
            from = &special.spot;
        }
        return inside && add_way(*from, spot, BranchKind::point);
    }

    /// Returns whether the walk is back at its first point.
    bool is_closed(const Progress& walk, const Spot& spot, const Vector& on, double length) const {
        return !walk.recentred && path_.points.size() > 10 && (scaled(spot) - scaled(walk.first)).norm() < length &&
               on.dot(walk.first_ahead) > straight;
    }

    bool has_vanished(const Spot& spot) const {
        return circuit_.cycles() &&
               circuit_.units(spot.x, spot.lap, spot.motion).cwiseQuotient(greatest_).maxCoeff() < vanishes;
    }

    /// Moves the section of a cycle if the motion has drifted away from it. Returns false if the motion cannot be
    /// continued there.
    bool recentre(Progress& walk, Spot& spot) {
        const auto places = circuit_.recentred(spot.motion, {{walk.now.x, walk.now.p}, {spot.x, spot.p}});
        if (!places) return true;
        walk.recentred = true;
        seen_.clear();
        walk.passed.reset();
        anchors_.clear();
        walk.now.x = places->front();
        const Vector before = scaled(walk.now);
        spot.x = places->back();
        spot.lap = circuit_.lap(spot.x, spot.p);
        if (!spot.lap.finished) return false;
        differentiate(spot);
        if (spot.slopes.size() == 0) return false;
        walk.ahead = tangent(spot, scaled(spot) - before);
        specials_before(spot, walk.ahead);
        return true;
    }

    Vector slope_by_p(const Vector& tangent) const {
        const Eigen::Index n = units_.size();
        return tangent.head(n).cwiseProduct(units_) / (tangent[n] * range_);
    }

    /// Improves the guess at this parameter by the cubic through two points and their slopes, unless it bends away.
    void curve_on(Vector& guess, const Passed& before, const Spot& now, const Vector& ahead, double target) const {
        const double length = now.p - before.p, t = 1 + (target - now.p) / length;
        constexpr double farthest = 3, bent = 0.3;
        if (!(t > 1 && t < farthest)) return;
        const Vector x = (1 + t * t * (2 * t - 3)) * before.x + t * (1 - t) * (1 - t) * length * before.slope +
                         t * t * (3 - 2 * t) * now.x + t * t * (t - 1) * length * slope_by_p(ahead);
        const Eigen::Index n = units_.size();
        const Vector moved = x.cwiseQuotient(units_) - guess.head(n);
        if (moved.norm() < bent * (t - 1) * std::fabs(length) / range_) guess.head(n) += moved;
    }

    std::optional<Spot> begun(double parameter) {
        path_ = {};
        anchors_.clear();
        greatest_ = {};
        reach_ = 1;
        Spot spot{.x = circuit_.first(), .p = parameter};
        spot.lap = circuit_.lap(spot.x, spot.p);
        if (spot.lap.finished && !circuit_.stopped()) {
            const Eigen::Index n = spot.x.size();
            units_ = Vector::Ones(n);
            spot.motion = circuit_.motion(spot.x, spot.p, spot.lap, Slopes::Zero(n, n));
            units_ = circuit_.units(spot.x, spot.lap, spot.motion);
            constexpr double astray = 1e-5;
            if ((spot.lap.to - spot.x).cwiseQuotient(units_).norm() < astray) differentiate(spot);
        }
        if (spot.slopes.size() > 0 && !circuit_.stopped()) {
            find_motion(spot);
            return spot;
        }
        path_.end = circuit_.stopped() ? WalkEnd::stopped : WalkEnd::lost;
        return {};
    }

    void differentiate(Spot& spot) {
        const Eigen::Index n = spot.x.size();
        bool good = true;
        const auto slope = [&](double h, const auto& moved) -> Vector {
            const auto at = [&](double step) -> Vector {
                const auto [x, p] = moved(step);
                const Circuit::Lap lap = circuit_.lap(x, p);
                good = good && lap.finished;
                return good ? Vector(lap.to - x) : Vector::Zero(n);
            };
            Vector central = (at(h) - at(-h)) / (2 * h);
            if (!sharp_) return central;
            return (4 * central - (at(2 * h) - at(-2 * h)) / (4 * h)) / 3;
        };
        spot.slopes.resize(n, n + 1);
        if (spot.lap.derivative) {
            spot.slopes.leftCols(n) = *spot.lap.derivative - Slopes::Identity(n, n);
        } else {
            const double h = sharp_ ? 3e-4 : std::clamp(reach_ / 4, 1e-8, circuit_.difference());
            for (Eigen::Index i = 0; i < n; ++i) {
                spot.slopes.col(i) = slope(h * units_[i], [&](double step) {
                    return std::pair(Vector(spot.x + step * Vector::Unit(n, i)), spot.p);
                });
            }
        }
        // At the ends of the range, differences stay inside.
        const double h = std::clamp(reach_ / 4, 1e-8, 1e-6) * range_,
                     p = std::clamp(spot.p, values_.front() + h, values_.back() - h);
        if (rough_) {
            const double inside = spot.p + h > values_.back() ? -h : h;
            const Circuit::Lap lap = circuit_.lap(spot.x, spot.p + inside);
            good = good && lap.finished;
            if (good) spot.slopes.col(n) = (lap.to - spot.lap.to) / inside;
        } else {
            const bool sharp = std::exchange(sharp_, false);
            spot.slopes.col(n) = slope(h, [&](double step) { return std::pair(spot.x, p + step); });
            sharp_ = sharp;
        }
        if (!good) spot.slopes.resize(0, 0);
    }

    /// Corrects a guess to the nearest point of the curve in the plane normal to `normal`.
    std::optional<Spot> correct(const Vector& guess, const Vector& normal, Slopes slopes) {
        constexpr int most_steps = 12;
        const Eigen::Index n = units_.size();
        slopes = scaled(slopes);
        Vector y = guess, last;
        bool renewed = false;
        for (int i = 0; i <= most_steps; ++i) {
            const double p = y[n] * range_;
            if (!y.allFinite() || p < values_.front() - slack_ || p > values_.back() + slack_) return {};
            Spot spot{.x = units_.cwiseProduct(y.head(n)), .p = value_near(p)};
            spot.lap = circuit_.lap(spot.x, spot.p);
            if (!spot.lap.finished || circuit_.stopped()) return {};
            const Vector off = (spot.lap.to - spot.x).cwiseQuotient(units_);
            // Broyden's update with the residual of the last step.
            if (i > 0 && !renewed) slopes += off * last.transpose() / std::max(last.squaredNorm(), 1e-300);
            renewed = false;
            if (off.norm() <= closes || (i > 3 && off.norm() <= nearly_closes)) {
                differentiate(spot);
                return spot.slopes.size() > 0 && !circuit_.stopped() ? std::optional(spot) : std::nullopt;
            }
            if (i == 4) {
                differentiate(spot);
                if (spot.slopes.size() == 0) return {};
                slopes = scaled(spot.slopes);
                renewed = true;
            }
            Slopes all(n + 1, n + 1);
            all << slopes, normal.transpose();
            Vector rest(n + 1);
            rest << -off, normal.dot(guess - y);
            last = algebra::solve_by_singular_values(all, rest, 1e-10);
            y += last;
            if ((y - guess).norm() > 0.5) return {};
        }
        return {};
    }

    void find_motion(Spot& spot) { spot.motion = circuit_.motion(spot.x, spot.p, spot.lap, spot.derivative()); }
    std::optional<Spot> at_value(const Spot& a, const Spot& b, double p) {
        const double part = (p - a.p) / (b.p - a.p);
        Vector guess = (1 - part) * scaled(a) + part * scaled(b);
        guess[units_.size()] = p / range_;
        auto spot = correct(guess, across(), part < 0.5 ? a.slopes : b.slopes);
        if (spot) find_motion(*spot);
        return spot;
    }

    /// The zero of f between two points at which it has opposite signs.
    std::optional<Spot> zero_between(const Spot& a, const Spot& b, double f_a, double f_b, const Test& f) {
        const Vector begin = scaled(a), way = scaled(b) - begin;
        double low = 0, high = 1, f_low = f_a, f_high = f_b;
        std::optional<Spot> best;
        int side = 0;
        for (int i = 0; i < 40 && high - low > 1e-9; ++i) {
            const double at = (low * f_high - high * f_low) / (f_high - f_low);
            auto spot = correct(begin + at * way, way.normalized(), at < 0.5 ? a.slopes : b.slopes);
            if (!spot) break;
            const double value = f(*spot);
            best = std::move(spot);
            if (std::fabs(value) < least_slope * std::max({std::fabs(f_a), std::fabs(f_b), 1e-3})) break;
            // Illinois: halve the value at an end that stays.
            if (value * f_high > 0) {
                high = at, f_high = value;
                if (side == 1) f_low /= 2;
                side = 1;
            } else {
                low = at, f_low = value;
                if (side == -1) f_high /= 2;
                side = -1;
            }
        }
        if (best) find_motion(*best);
        return best;
    }

    /// The orientation of a tangent relative to the branch; constant along it, also across corners.
    double orientation(const Slopes& slopes, const Vector& tangent) const {
        const Eigen::Index n = units_.size();
        Slopes all(n + 1, n + 1);
        all << scaled(slopes), tangent.transpose();
        return algebra::determinant(all);
    }

    /// The first point behind a corner of the branch, such as the onset of stops.
    std::optional<Spot> beyond_corner(const Spot& now, const Vector& ahead) {
        constexpr double beyond = 1e-3, near = 1e-5;
        reach_ = beyond;
        const auto there = spot_at(scaled(now) + beyond * ahead);
        if (!there) return {};
        Vector way = tangent(*there, ahead);
        if (orientation(there->slopes, way) * orientation_ < 0) way = -way;
        reach_ = near / 10;
        auto spot = correct(scaled(now) + near * way, way, there->slopes);
        const Vector moved = spot ? Vector(scaled(*spot) - scaled(now)) : Vector::Zero(units_.size() + 1);
        if (!spot || !(moved.dot(way) > straight * moved.norm()) || moved.norm() > 2 * near) return {};
        return spot;
    }

    /// Continues behind a corner that is about `distance` away; returns false if that fails.
    bool round_corner(Spot& now, Vector& ahead, double distance) {
        Spot before = now;
        reach_ = distance / 10;
        differentiate(before);
        if (before.slopes.size() == 0) return false;
        const Vector here = tangent(before, ahead);
        auto beyond = beyond_corner(before, here);
        if (!beyond) return false;
        find_motion(*beyond);
        if (becomes_symmetric(now.motion, beyond->motion)) return false;
        const Vector beside = tangent(*beyond, scaled(*beyond) - scaled(before));
        const Eigen::Index n = units_.size();
        if (beside[n] * here[n] < 0) {
            if (const auto fold = corner_between(before, here, *beyond, beside)) add(*fold, BranchKind::fold);
        }
        add(*beyond, BranchKind::point);
        anchors_.clear();
        specials_before(*beyond, beside);
        now = std::move(*beyond);
        ahead = beside;
        return true;
    }

    /// The intersection of the tangents on both sides of a corner.
    std::optional<Spot> corner_between(const Spot& a, const Vector& on_a, const Spot& b, const Vector& on_b) {
        Slopes ways(units_.size() + 1, 2);
        ways << on_a, on_b;
        const Vector parts = algebra::solve_least_squares(ways, scaled(b) - scaled(a));
        auto corner = spot_at(scaled(a) + parts[0] * on_a);
        if (corner) find_motion(*corner);
        return corner;
    }

    /// A place, not necessarily on the branch, with its derivatives; none outside of the range.
    std::optional<Spot> spot_at(const Vector& y) {
        const Eigen::Index n = units_.size();
        Spot spot{.x = units_.cwiseProduct(y.head(n)), .p = y[n] * range_};
        if (!(spot.p >= values_.front() && spot.p <= values_.back())) return {};
        spot.lap = circuit_.lap(spot.x, spot.p);
        if (spot.lap.finished) differentiate(spot);
        return spot.slopes.size() > 0 ? std::optional(std::move(spot)) : std::nullopt;
    }

    /// A point at which one more pair grows, between two others that differ by two growing pairs; none if it is not
    /// found.
    std::optional<Spot> between_pairs(const Spot& a, const Spot& b) {
        if (a.x.size() < 4) return {};
        const int at_a = growing_in_pairs(a.derivative()), at_b = growing_in_pairs(b.derivative());
        if (std::abs(at_a - at_b) != 4) return {};
        const Vector begin = scaled(a), way = scaled(b) - begin;
        constexpr int most = 12;
        double low = 0, high = 1;
        for (int i = 0; i < most; ++i) {
            const double at = (low + high) / 2;
            auto spot = correct(begin + at * way, way.normalized(), at < 0.5 ? a.slopes : b.slopes);
            if (!spot) return {};
            const int here = growing_in_pairs(spot->derivative());
            if (here == (at_a + at_b) / 2) return spot;
            (here == at_a ? low : high) = at;
        }
        return {};
    }

    /// The zeros of the test functions between their anchors and this point, in order.
    std::vector<Special> specials_before(const Spot& spot, const Vector& ahead) {
        struct Kind {
            double (*test)(const Eigen::MatrixXd&);
            BranchKind kind;
        };
        const BranchKind of_minus_one = circuit_.is_half() ? BranchKind::pitchfork : BranchKind::doubling;
        const BranchKind of_pair = circuit_.stands() ? BranchKind::hopf : BranchKind::torus;
        const std::array<Kind, 2> kinds{{{doubling_test, of_minus_one}, {pair_test, of_pair}}};
        anchors_.resize(kinds.size());
        std::vector<Special> found;
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            const Kind kind = kinds[i];
            const Test f = [kind](const Spot& at) { return kind.test(at.derivative()); };
            const double value = f(spot);
            constexpr double rounding = 1e-7;
            if (!(std::fabs(value) > rounding)) continue;
            const std::optional<Anchor> from = std::exchange(anchors_[i], Anchor{spot, value});
            if (!from || (i == 1 && spot.x.size() < 2)) continue;
            const auto look = [&](const Spot& a, const Spot& b, double at_a, double at_b) {
                sharp_ = true;
                auto zero = zero_between(a, b, at_a, at_b, f);
                sharp_ = false;
                // At a corner f jumps across zero.
                if (!zero || std::fabs(f(*zero)) > 1e-4 * std::max(std::fabs(at_a), std::fabs(at_b))) return;
                if (i == 1 && !has_complex_pair(zero->derivative())) return;
                found.push_back({std::move(*zero), kind.kind});
            };
            if (from->value * value < 0) {
                look(from->spot, spot, from->value, value);
            } else if (const auto middle = i == 1 ? between_pairs(from->spot, spot) : std::nullopt) {
                look(from->spot, *middle, from->value, f(*middle));
                look(*middle, spot, f(*middle), value);
            }
        }
        const Vector here = scaled(spot);
        std::ranges::sort(found, [&](const Special& a, const Special& b) {
            return ahead.dot(scaled(a.spot) - here) < ahead.dot(scaled(b.spot) - here);
        });
        return found;
    }

    /// Next requested parameter value after p towards `way`, otherwise the range's end.
    double next_value(double p, double way) const {
        if (way > 0) {
            const auto next = std::ranges::upper_bound(values_, p + slack_);
            return next == values_.end() ? values_.back() : *next;
        }
        const auto next = std::ranges::lower_bound(values_, p - slack_);
        return next == values_.begin() ? values_.front() : *(next - 1);
    }

    /// Adds the points at requested values between two points, then the second point unless it is outside of the range.
    /// Returns whether the branch continues inside the range.
    bool add_way(const Spot& a, const Spot& b, BranchKind kind) {
        const double way = b.p - a.p;
        double p = next_value(a.p, way);
        while ((b.p - p) * way > slack_ * std::fabs(way)) {
            if (std::fabs(p - a.p) <= slack_) break;  // the end of the range
            if (const auto between = at_value(a, b, p)) add(*between, BranchKind::point);
            if (p == values_.front() || p == values_.back()) break;
            p = next_value(p, way);
        }
        add(b, kind);
        return (way > 0 ? values_.back() - b.p : b.p - values_.front()) > slack_;
    }

    /// Handles a walk that met one of its own points. If it has passed a fold, it went back the same way: the points
    /// since the fold are removed. Returns false if it met none.
    bool handle_met_point() {
        if (!met_again_) return false;
        std::vector<BranchPoint>& points = path_.points;
        const auto is_fold = [](const BranchPoint& point) { return point.kind == BranchKind::fold; };
        const auto fold = std::find_if(points.rbegin(), points.rend(), is_fold);
        if (fold == points.rend()) path_.end = WalkEnd::closed;
        if (fold != points.rend()) points.erase(fold.base(), points.end());
        return true;
    }

    /// Returns whether this fold undoes one at the same place, where rounding made the branch turn more than once; the
    /// earlier one is then no fold either.
    bool undoes_fold(const Spot& spot) {
        constexpr double there = 1e-5;
        const auto before = std::find_if(path_.points.rbegin(), path_.points.rend(),
                                         [](const BranchPoint& point) { return point.kind == BranchKind::fold; });
        if (before == path_.points.rend() || std::fabs(before->parameter - spot.p) > there * range_) return false;
        if (std::fabs(before->motion.amplitude - spot.motion.amplitude) > there * greatest_.maxCoeff()) return false;
        before->kind = BranchKind::point;
        return true;
    }

    /// Returns whether the walk has passed this fold before: taken the wrong way, a corner leads back onto the path.
    bool repeats_fold(const Spot& spot) const {
        constexpr double there = 1e-6;
        return std::ranges::any_of(path_.points, [&](const BranchPoint& point) {
            return point.kind == BranchKind::fold && std::fabs(point.parameter - spot.p) <= there * range_ &&
                   std::fabs(point.motion.amplitude - spot.motion.amplitude) <= there * spot.motion.amplitude;
        });
    }

    void add(const Spot& spot, BranchKind kind) {
        if (kind == BranchKind::fold && undoes_fold(spot)) {
            kind = BranchKind::point;
        } else if (kind == BranchKind::fold && repeats_fold(spot)) {
            kind = BranchKind::point, met_again_ = true;
        }
        const bool asked = std::binary_search(values_.begin(), values_.end(), spot.p);
        if (asked) {
            constexpr double there = 1e-6;
            const auto is_here = [&](const auto& seen) {
                return seen.first == spot.p && (seen.second - spot.x).cwiseQuotient(units_).norm() < there;
            };
            met_again_ = met_again_ || std::ranges::any_of(seen_, is_here);
            seen_.emplace_back(spot.p, spot.x);
        }
        // Points between requested values serve plots only: keep few.
        std::vector<BranchPoint>& points = path_.points;
        const auto is_between = [](const BranchPoint& point) {
            return !point.asked && point.kind == BranchKind::point;
        };
        if (points.size() > 1 && is_between(points.back())) {
            const BranchPoint& before = points[points.size() - 2];
            const double way = std::hypot((spot.p - before.parameter) / range_,
                                          (spot.motion.amplitude - before.motion.amplitude) / greatest_.maxCoeff());
            if (way < first_step && spot.motion.stable == before.motion.stable) points.pop_back();
        }
        points.push_back({spot.p, spot.motion, asked, kind});
    }

    /// Adapts the units to the motion, down to a part of its greatest size.
    void rescale(const Spot& spot, Vector& ahead) {
        Vector units = circuit_.units(spot.x, spot.lap, spot.motion);
        if (greatest_.size() == 0) greatest_ = units;
        units = units.cwiseMax(dying * greatest_);
        greatest_ = greatest_.cwiseMax(units);
        const auto ratio = units.cwiseQuotient(units_).array();
        if (ratio.maxCoeff() <= 1.2 && ratio.minCoeff() >= 1 / 1.2) return;
        const Eigen::Index n = units.size();
        ahead.head(n) = ahead.head(n).cwiseProduct(units_).cwiseQuotient(units).eval();
        units_ = units;
        ahead = tangent(spot, ahead);
    }

    /// The requested value that equals p to rounding, otherwise p.
    double value_near(double p) const {
        const auto near = std::ranges::lower_bound(values_, p - slack_);
        return near != values_.end() && *near <= p + slack_ ? *near : p;
    }

    Circuit& circuit_;
    std::span<const double> values_;
    double range_, slack_;
    Vector units_, greatest_;
    bool sharp_ = false;      // whether differences are of higher order
    bool rough_ = false;      // whether a one-sided difference in p is accurate enough, as for a guess
    double orientation_ = 0;  // orientation of the walk's tangents
    double reach_ = 1;        // the present step: differences must not cross a corner beyond it
    std::vector<std::optional<Anchor>> anchors_;
    std::vector<std::pair<double, Vector>> seen_;  // parameter and place of points at requested values
    bool met_again_ = false;                       // whether a point of the walk was visited before
    BranchPath path_;
};

}  // namespace

std::unique_ptr<Circuit> circuit_of_periods(const Family& family, double p, const SteadyMotion& motion, int periods,
                                            const motion::Monitor& monitor) {
    return std::make_unique<PeriodCircuit>(family, p, motion, periods, monitor);
}

BranchPath walk(Circuit& circuit, std::span<const double> values, double parameter, double way) {
    return BranchWalk(circuit, values).walk(parameter, way);
}

BranchPath walk_aside(Circuit& circuit, std::span<const double> values, double parameter) {
    return BranchWalk(circuit, values).walk_aside(parameter);
}

BranchPath walk_up(Circuit& circuit, std::span<const double> values, double parameter) {
    return BranchWalk(circuit, values).walk_up(parameter);
}

}  // namespace dinal::analysis
