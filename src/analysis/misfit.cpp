#include "analysis/misfit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "algebra/decompositions.hpp"
#include "analysis/least_squares.hpp"
#include "analysis/noise_memory.hpp"
#include "model/terms/polyline.hpp"

namespace dinal::analysis {

namespace {

double greatest(std::span<const double> values) {
    double most = std::numeric_limits<double>::min();
    for (const double x : values) most = std::max(most, std::fabs(x));
    return most;
}

double sign_of(double x) {
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

/// The changes of angle and velocity caused by each of the torques, advanced from one time to the next.
class Response {
public:
    using Row = MissingTorques::Row;

    Response(const model::Oscillator& system, const model::Excitation& M)
        : I_(system.inertia()),
          k_(system.stiffness()),
          C_(system.damping()),
          Rd_(system.kinetic_friction()),
          M_(M),
          omega0_(system.natural_frequency()) {}

    const Row& angle() const { return angle_; }

    /// Advances by h, while the torques change linearly.
    void move(double h, const Row& from, const Row& to) {
        if (!(h > 0)) return;
        set_step(h);
        const Row slope = (to - from) / (h * k_), start = (from - C_ * slope) / k_;
        const Row y = angle_ - start, u = velocity_ - slope;
        angle_ = start + h * slope + kept_ * y + passed_ * u;
        velocity_ = slope + back_ * y + left_ * u;
    }
    void stop() { velocity_.setZero(); }
    /// Passes a turn: `way` is the direction before it, after which friction reverses.
    void turn(double pull, double way) {
        const double before = pull - Rd_ * way, after = pull + Rd_ * way;
        if (before != 0) velocity_ *= after / before;
    }
    /// Starts in direction `way` when the pull reaches Re: a helping torque makes the mass start earlier.
    void start(double t, double pull, double way, const Row& torques) {
        const double h = 1e-5 / omega0_, rise = (M_.value(t + h) - M_.value(t - h)) / (2 * h);
        if (rise * way > 0) velocity_ = (pull - Rd_ * way) / (I_ * rise) * (torques - k_ * angle_);
    }

private:
    /// Computes the free motion over h.
    void set_step(double h) {
        constexpr double same = 1e-12;
        if (std::fabs(h - step_) <= same * h) return;
        step_ = h;
        const double decay = C_ / (2 * I_), q = omega0_ * omega0_ - decay * decay, rate = std::sqrt(std::fabs(q));
        double c = 0, s = 0;
        constexpr double least_decay = 1e-6;
        if (rate * h < least_decay) {
            c = std::exp(-decay * h), s = h * c;
        } else if (q > 0) {
            const double kept = std::exp(-decay * h);
            c = kept * std::cos(rate * h), s = kept * std::sin(rate * h) / rate;
        } else {
            const double slow = std::exp((rate - decay) * h), fast = std::exp(-(rate + decay) * h);
            c = (slow + fast) / 2, s = (slow - fast) / (2 * rate);
        }
        kept_ = c + decay * s, passed_ = s, back_ = -omega0_ * omega0_ * s, left_ = c - decay * s;
    }

    double I_, k_, C_, Rd_;
    const model::Excitation& M_;
    double omega0_;
    Row angle_ = Row::Zero(), velocity_ = Row::Zero();
    double step_ = 0, kept_ = 1, passed_ = 0, back_ = 0, left_ = 1;
};

}  // namespace

MissingTorques::MissingTorques(std::span<const double> theta, std::span<const double> velocity)
    : far_(greatest(theta)), fast_(greatest(velocity)) {}

MissingTorques::Row MissingTorques::at(double theta, double velocity, double way) const {
    const double x = theta / far_, v = velocity / fast_;
    const auto slow = [&](double speed) { return way * std::exp(-(v * v) / (speed * speed)); };
    // fractions of the greatest speed below which friction may fall
    constexpr double slowest = 0.1, slower = 0.25, half = 0.6;
    Row row;
    row << v, way, slow(slowest), slow(slower), slow(half), x, x * x, x * x * x;
    return row;
}

MissingTorques::Path MissingTorques::along(std::span<const double> times, std::span<const double> theta,
                                           std::span<const double> velocity) const {
    constexpr std::size_t enough = 1000, most = 4;  // points in all, and between two samples
    const std::size_t n = times.size(), parts = std::clamp<std::size_t>(enough / n, 1, most);
    Path path;
    const auto add = [&](double t, double angle, double speed, double way) {
        path.t.push_back(t);
        path.torques.push_back(at(angle, speed, way));
    };
    add(times[0], theta[0], velocity[0], sign_of(velocity[0]));
    for (std::size_t i = 0; i + 1 < n; ++i) {
        // A cubic with the angles and velocities of both samples.
        const double h = times[i + 1] - times[i], rise = theta[i + 1] - theta[i], v = h * velocity[i],
                     bend = 3 * rise - 2 * v - h * velocity[i + 1], twist = v + h * velocity[i + 1] - 2 * rise;
        const auto angle = [&](double x) { return theta[i] + x * (v + x * (bend + x * twist)); };
        double before = 0, speed = velocity[i];
        for (std::size_t part = 1; part <= parts; ++part) {
            const bool is_last = part == parts;
            const double x = static_cast<double>(part) / static_cast<double>(parts),
                         next = is_last ? velocity[i + 1] : (v + x * (2 * bend + 3 * x * twist)) / h;
            if (speed * next < 0) {
                constexpr double beside = 1e-6;
                const double turn = before + (x - before) * speed / (speed - next);
                add(times[i] + (turn - beside) * h, angle(turn), 0, sign_of(speed));
                add(times[i] + (turn + beside) * h, angle(turn), 0, sign_of(next));
            }
            add(is_last ? times[i + 1] : times[i] + x * h, is_last ? theta[i + 1] : angle(x), next, sign_of(next));
            before = x, speed = next;
        }
    }
    // A turn just at a sample would give two points at one time.
    for (std::size_t i = 1; i < path.t.size(); ++i) {
        path.t[i] = std::max(path.t[i], std::nextafter(path.t[i - 1], std::numeric_limits<double>::infinity()));
    }
    return path;
}

Eigen::MatrixXd responses(const model::Oscillator& system, const model::Excitation& M, const motion::Run& run,
                          std::span<const double> times) {
    using model::EventKind;
    const Eigen::VectorXd theta = run.column(motion::Column::theta), velocity = run.column(motion::Column::velocity);
    const Eigen::Index n = theta.size();
    const MissingTorques torques({theta.data(), times.size()}, {velocity.data(), times.size()});
    const double k = system.stiffness();
    double way = run.began_stuck ? 0 : sign_of(velocity[0] != 0 ? velocity[0] : M.value(times[0]) - k * theta[0]);
    double t = times[0];
    MissingTorques::Row now = torques.at(theta[0], velocity[0], way);
    Response response(system, M);
    Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(n, velocity_torques + theta_torques);
    auto event = run.events.begin();
    for (Eigen::Index i = 1; i < n; ++i) {
        const double until = times[static_cast<std::size_t>(i)];
        for (; event != run.events.end() && event->t <= until; ++event) {
            const double pull = event->M - k * event->theta;
            if (way != 0) response.move(event->t - t, now, torques.at(event->theta, 0, way));
            t = event->t;
            if (event->kind == EventKind::turn) {
                response.turn(pull, way);
                way = -way;
            } else if (event->kind == EventKind::slip) {
                way = sign_of(pull);
                response.start(t, pull, way, torques.at(event->theta, 0, 0));
            } else if (event->kind == EventKind::stick || event->kind == EventKind::rest) {
                response.stop();
                way = 0;
            }
            now = torques.at(event->theta, 0, way);
        }
        const MissingTorques::Row next = torques.at(theta[i], velocity[i], way);
        if (way != 0) response.move(until - t, now, next);
        t = until;
        now = next;
        changes.row(i) = response.angle();
    }
    return changes;
}

std::optional<Eigen::MatrixXd> responses(const Pushed& pushed, const MissingTorques::Path& path, double whole,
                                         double noise) {
    const auto here = pushed(model::Excitation());
    if (!here) return {};
    constexpr Eigen::Index all = velocity_torques + theta_torques;
    Eigen::MatrixXd columns(here->size(), all);
    constexpr double first = 1e-6;  // the part of `typical` that derivative() tries first
    double step = 1e-3 * whole;
    for (Eigen::Index i = 0; i < all; ++i) {
        const Prediction changed = [&](const Eigen::VectorXd& coefficient) -> std::optional<Eigen::VectorXd> {
            if (coefficient[0] == 0) return here;
            auto samples = std::make_shared<model::terms::Samples>();
            samples->t = path.t;
            for (const auto& torques : path.torques) samples->M.push_back(coefficient[0] * torques[i]);
            return pushed(model::Excitation::make(model::terms::Polyline(std::move(samples))).value());
        };
        const auto one = [](double x) { return Eigen::VectorXd::Constant(1, x); };
        const auto column = derivative(changed, one(0), {one(step / first), one(-1e300), one(whole), one(0)}, noise);
        if (!column) return {};
        columns.col(i) = *column;
        step = std::clamp(noise / std::max(column->norm(), 1e-300), 1e-9 * whole, whole);
    }
    return columns;
}

namespace {

/// The matrix of inner products of columns. Columns can be eliminated one by one; the products are then those of the
/// components orthogonal to them.
class Products {
public:
    explicit Products(const Eigen::MatrixXd& all) : left_(all.transpose() * all), whole_(left_.diagonal()) {}

    /// The fraction of a column's length that is orthogonal to the eliminated columns.
    double own(Eigen::Index i) const { return std::sqrt(std::max(0.0, left_(i, i)) / whole_[i]); }
    [[nodiscard]] double operator()(Eigen::Index i, Eigen::Index j) const { return left_(i, j); }
    void eliminate(Eigen::Index i) {
        constexpr double dependent = 1e-6;
        if (!(own(i) > dependent)) return;
        const Eigen::VectorXd column = left_.col(i);
        left_ -= column * (column.transpose() / column[i]);
        ++taken_;
    }
    int taken() const { return taken_; }

private:
    Eigen::MatrixXd left_;
    Eigen::VectorXd whole_;
    int taken_ = 0;
};

/// Significance in standard deviations: from the first a term adds to the errors, from the second it counts as present.
constexpr double possible = 2.2, beyond_chance = 3.5;

/// The matrix [a b]; missing rows are zero.
Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    Eigen::MatrixXd both(std::max(a.rows(), b.rows()), a.cols() + b.cols());
    if (a.cols() > 0) both.leftCols(a.cols()) = a;
    if (b.cols() > 0) both.rightCols(b.cols()) = b;
    return both;
}

/// Coefficients of the columns in y, and the remainder.
struct Regression {
    Eigen::VectorXd parts, rest;
};
Regression regression(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y) {
    const Eigen::VectorXd lengths = columns.colwise().norm().cwiseMax(1e-300);
    const Eigen::MatrixXd units = columns * lengths.cwiseInverse().asDiagonal();
    const Eigen::VectorXd parts = algebra::solve_least_squares(units, y);
    return {parts.cwiseQuotient(lengths), y - units * parts};
}

/// The standard deviation of the numbers around each place.
Eigen::VectorXd local_deviation(const Eigen::VectorXd& numbers) {
    constexpr Eigen::Index around = 20;
    const Eigen::Index n = numbers.size();
    Eigen::VectorXd found(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Index first = std::max<Eigen::Index>(0, i - around), last = std::min(n - 1, i + around);
        const auto near = numbers.segment(first, last - first + 1);
        found[i] = std::max(near.norm() / std::sqrt(static_cast<double>(near.size())), 1e-300);
    }
    return found;
}

/// Searches the terms of a structure that explain more of a residual than noise could: the most significant one first,
/// then further ones. Each is tested in addition to the slopes, so that effects which the parameters can imitate do not
/// count.
class Search {
public:
    Search(const Eigen::VectorXd& residual, const NoiseKind& noise, std::span<const int> columns,
           const Eigen::MatrixXd& slopes, const Structure& structure)
        : size_(residual.size()),
          first_(slopes.cols()),
          terms_(structure.columns.cols()),
          last_(first_ + terms_ + structure.faster.cols()),
          products_(products(residual, noise, columns, slopes, structure)) {
        for (Eigen::Index i = 0; i < first_; ++i) products_.eliminate(i);
        double squares = 0;
        for (Eigen::Index i = first_ + terms_; i < last_; ++i) squares += score(i) * score(i);
        const auto fast = static_cast<double>(structure.faster.cols());
        const double unit = fast > 0 ? std::max(1.0, std::sqrt(squares / fast)) : 1;
        for (double most = 0;;) {
            Eigen::Index which = -1;
            most = possible;
            for (Eigen::Index i = first_; i < first_ + terms_; ++i) {
                if (score(i) / unit > most) most = score(i) / unit, which = i;
            }
            if (which < 0) break;
            if (found_.empty()) most_ = most;
            found_.push_back(which - first_);
            products_.eliminate(which);
        }
    }

    /// The significance of the first term, in standard deviations of chance; 0 if there is none.
    double most() const { return most_; }
    const std::vector<Eigen::Index>& found() const { return found_; }

private:
    /// The products of slopes, terms, faster terms and, last, the residual, filtered if the residual has a memory.
    static Products products(const Eigen::VectorXd& residual, const NoiseKind& noise, std::span<const int> columns,
                             const Eigen::MatrixXd& slopes, const Structure& structure) {
        const Eigen::MatrixXd known = beside(slopes, structure.columns);
        Eigen::MatrixXd all = beside(beside(known, structure.faster), residual);
        if (!noise.is_white) {
            // A longer memory would also take a nearly periodic misfit for noise.
            all = NoiseMemory(regression(known, residual).rest, columns, known, 1).whitened(all);
        }
        if (noise.is_uneven) all = local_deviation(all.col(all.cols() - 1)).cwiseInverse().asDiagonal() * all;
        return Products(all);
    }

    /// The significance of a column in the residual, in standard deviations.
    double score(Eigen::Index i) const {
        constexpr double least_own_share = 0.02, least_spare = 8;
        if (!(products_.own(i) > least_own_share)) return 0;
        const double along = products_(i, last_), square = along * along / products_(i, i);
        const double spare = static_cast<double>(size_ - products_.taken() - 1),
                     left = products_(last_, last_) - square;
        return spare < least_spare || !(left > 0) ? 0 : std::sqrt(square * spare / left);
    }

    Eigen::Index size_, first_, terms_, last_;
    Products products_;
    double most_ = 0;
    std::vector<Eigen::Index> found_ = {};
};

/// Converts chi squared into standard deviations of a Gaussian (cube root of Wilson and Hilferty).
double deviations(double chi_squared, int more) {
    const double spread = 2.0 / (9 * more);
    return (std::cbrt(chi_squared / more) - (1 - spread)) / std::sqrt(spread);
}

double correlated(std::span<const double> x, std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < x.size(); ++i) sum += x[i] * x[i + lag];
    return sum;
}

}  // namespace

Structure drift(std::span<const double> times, std::span<const int> columns, int column, bool is_white) {
    constexpr Eigen::Index slow = 4, most = 32;
    const auto n = static_cast<Eigen::Index>(times.size());
    const Eigen::Index all = slow + (is_white ? 0 : std::min<Eigen::Index>(most, n / 8));
    Eigen::MatrixXd drifts = Eigen::MatrixXd::Zero(n, all);
    const double span = times.back() - times.front();
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto place = static_cast<std::size_t>(i);
        if (columns[place] != column) continue;
        // The drift is 0 at the first time, because the fitted zero refers to it.
        const double angle = std::numbers::pi * (times[place] - times.front()) / span, twice = 2 * std::cos(angle);
        drifts(i, 0) = angle;
        double before = 1, now = twice / 2;
        for (Eigen::Index j = 1; j < all; ++j) {
            before = std::exchange(now, twice * now - before);
            drifts(i, j) = 1 - now;
        }
    }
    return {Follows::time, drifts.leftCols(slow), drifts.rightCols(all - slow)};
}

std::optional<Misfit> misfit_of(const Eigen::VectorXd& residual, const NoiseKind& noise, std::span<const int> columns,
                                const Eigen::MatrixXd& slopes, std::span<const Structure> structures) {
    struct Found {
        Search search;
        const Structure* structure;
    };
    std::vector<Found> found;
    double most = 0;
    for (const Structure& structure : structures) {
        Search search(residual, noise, columns, slopes, structure);
        most = std::max(most, search.most());
        if (search.most() > 0) found.push_back({std::move(search), &structure});
    }
    if (found.empty()) return {};
    const auto better = [](const Found& a, const Found& b) { return a.search.most() > b.search.most(); };
    std::ranges::sort(found, better);
    const Found& best = found.front();
    Misfit worst{.follows = {best.structure->what}};
    const double odds = 2 * std::log(20.0);
    for (const Found& other : found) {
        const bool is_told = std::ranges::count(worst.follows, other.structure->what) > 0;
        if (is_told || best.search.most() * best.search.most() > other.search.most() * other.search.most() + odds)
            continue;
        worst.follows.push_back(other.structure->what);
    }
    Eigen::MatrixXd all = slopes;
    for (const Eigen::Index i : best.search.found()) all = beside(all, best.structure->columns.col(i));
    const Regression without = regression(all, residual);
    worst.is_sure = most > beyond_chance;
    worst.share = 1 - without.rest.squaredNorm() / residual.squaredNorm();
    worst.noise = without.rest.norm() / std::sqrt(std::max(1.0, static_cast<double>(all.rows() - all.cols())));
    worst.shift = without.parts.head(slopes.cols());
    return worst;
}

Nuisance nuisance(const Eigen::VectorXd& term, double size, const Eigen::VectorXd& residual, const NoiseMemory& memory,
                  const Eigen::MatrixXd& slopes, const Eigen::VectorXd& whole, double noise) {
    const Eigen::Index n = slopes.cols();
    Eigen::VectorXd sizes(n + 1);
    sizes << whole, size / widest_error;
    const Eigen::MatrixXd all = beside(slopes, term);
    return {(covariance_of(all, sizes, noise).matrix * (all.transpose() * residual)).head(n),
            remembered_covariance(memory, all, sizes, noise).topLeftCorner(n, n)};
}

Plausible plausible_friction(double Rd) {
    Plausible friction{Eigen::VectorXd::Zero(velocity_torques), true};
    friction.sizes.tail(velocity_torques - first_falling).setConstant(Rd);
    return friction;
}

Plausible plausible_spring(double bend) {
    Plausible spring{Eigen::VectorXd::Zero(theta_torques), false};
    spring.sizes.tail(theta_torques - first_bent).setConstant(bend);
    return spring;
}

Eigen::MatrixXd unseen_covariance(std::span<const Structure> structures, const Eigen::VectorXd& residual,
                                  const NoiseMemory& memory, const Eigen::MatrixXd& slopes,
                                  const Eigen::VectorXd& whole, double noise) {
    const Eigen::MatrixXd white = memory.whitened(slopes),
                          taken = covariance_of(white, whole, noise).matrix * white.transpose(),
                          shifts = covariance_of(slopes, whole, noise).matrix * slopes.transpose();
    const Eigen::VectorXd left = memory.whitened(residual);
    const auto spare = static_cast<double>(std::max<Eigen::Index>(1, left.size() - slopes.cols()));
    const double variance = left.squaredNorm() / spare;
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(slopes.cols(), slopes.cols());
    for (const Structure& structure : structures) {
        const Eigen::VectorXd& sizes = structure.plausible.sizes;
        const auto count = static_cast<double>((sizes.array() > 0).count());
        double odds = 1;  // of all models to the fitted one
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(slopes.cols(), slopes.cols());
        for (Eigen::Index i = 0; i < sizes.size(); ++i) {
            if (!(sizes[i] > 0)) continue;
            const Eigen::VectorXd column = memory.whitened(structure.columns.col(i)),
                                  own = column - white * (taken * column), shift = shifts * structure.columns.col(i);
            // The coefficient is Gaussian before and after the record is seen, or the half of a Gaussian.
            const double known = 1 / (sizes[i] * sizes[i]) + own.squaredNorm() / variance,
                         mean = own.dot(left) / variance / known, spread = 1 / std::sqrt(known), ratio = mean / spread;
            constexpr double most = 700;  // of an exponent
            double weight = spread / sizes[i] * std::exp(std::min(most, ratio * ratio / 2)) / count,
                   square = mean * mean + spread * spread;
            if (structure.plausible.has_sign) {
                const double part = std::erfc(ratio / std::numbers::sqrt2) / 2,  // of the Gaussian that is not positive
                    height = std::exp(-ratio * ratio / 2) / std::sqrt(2 * std::numbers::pi);
                weight *= 2 * part;
                square = part > 0 ? square - mean * spread * height / part : 0;
            }
            odds += weight;
            sum += weight * square * shift * shift.transpose();
        }
        all += sum / odds;
    }
    return all;
}

bool is_white(std::span<const double> residual, double unusual) {
    const double square = correlated(residual, 0), n = static_cast<double>(residual.size());
    if (!(square > 0)) return true;
    const std::size_t lags = std::min<std::size_t>(40, residual.size() / 4);
    double sum = 0;
    for (std::size_t lag = 1; lag <= lags; ++lag) {
        const double part = correlated(residual, lag) / square;
        sum += n * (n + 2) * part * part / (n - static_cast<double>(lag));
    }
    return lags == 0 || deviations(sum, static_cast<int>(lags)) < unusual;
}

double smallest_step(std::span<const double> values) {
    double step = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < values.size(); ++i) {
        const double apart = std::fabs(values[i] - values[i - 1]);
        if (apart > 0) step = std::min(step, apart);
    }
    return step;
}

double step_of_instrument(std::span<const double> values) {
    const double step = smallest_step(values);
    constexpr double rounding = 1e-6;
    const bool is_even = std::ranges::all_of(values, [&](double x) {
        const double steps = (x - values.front()) / step;
        return std::fabs(steps - std::round(steps)) < rounding * std::max(1.0, std::fabs(steps));
    });
    return is_even ? step : 0;
}

void add_steps(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& path, double step, double noise,
               Eigen::MatrixXd& covariance) {
    const double variance = noise * noise, rounded = step * step / 12;
    if (step == 0) return;
    const double other = std::max(0.0, variance - rounded) * std::pow(2 * std::numbers::pi / step, 2);
    const double share = variance > 0 ? std::min(1.0, rounded / variance * std::exp(-other)) : 0;
    constexpr double little = 1e-3;
    if (share < little) return;
    Eigen::MatrixXd alike = Eigen::MatrixXd::Zero(slopes.cols(), slopes.cols());
    for (Eigen::Index first = 0, last = 0; first < path.size(); first = last) {
        while (last < path.size() && std::fabs(path[last] - path[first]) < step) ++last;
        const Eigen::VectorXd sum = slopes.middleRows(first, last - first).colwise().sum().transpose();
        alike += sum * sum.transpose();
    }
    covariance += share * covariance * (alike - slopes.transpose() * slopes) * covariance;
}

}  // namespace dinal::analysis
