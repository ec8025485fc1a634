#include "analysis/identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <tuple>
#include <utility>

#include "algebra/decompositions.hpp"
#include "analysis/fit_starts.hpp"
#include "analysis/least_squares.hpp"
#include "analysis/misfit.hpp"
#include "analysis/noise_memory.hpp"
#include "motion/integrators.hpp"
#include "theory/theory_free.hpp"

namespace dinal::analysis {
namespace {

/// Returns whether the parameter is fitted. A free decay does not determine I, which sets the unit of torque, nor Re,
/// which acts only at the final rest.
bool is_sought(const IdentifyQuestion& question, Unknown which) {
    if (question.gives(which)) return false;
    if (question.M) return true;
    return which != Unknown::Re && (which != Unknown::I || question.given.k);
}

/// Two fits count as one if their sums of squares differ by no more than this part.
constexpr double same_fit = 1e-6;
bool is_same(const LeastSquares& a, const LeastSquares& b) {
    return std::fabs(a.sum - b.sum) <= same_fit * a.sum;
}

/// Number of standard deviations of neighbour correlation above which a fit is retried from other starts.
constexpr double suspected = 3;

/// Smaller residuals, relative to the range of the record, count as rounding.
constexpr double least_noise = 1e-7;

/// The weight in FitScale::hold that fixes a parameter.
constexpr double firm_weight = 1e8;

/// A fit of a free decay with a prescribed turn of rest; without one, friction stops the mass.
struct Rest {
    LeastSquares fit;
    double breakaway = 0;  // Re/k; 0: it equals Rd/k
    std::optional<double> turn = {};
    Covariance covariance = {};
    Eigen::MatrixXd slopes = {};
};

/// The best fit so far, with the parameters it was begun from, which include those that are not fitted.
struct Best : LeastSquares {
    FitScale scale;
    Parameters base;
    double breakaway = 0;  // as in Rest
    std::optional<double> rest = {};

    void take(const LeastSquares& fit) { LeastSquares::operator=(fit); }
};

double omega0_of(const Parameters& p) {
    return std::sqrt(p.k / p.I);
}
double zeta_of(const Parameters& p) {
    return p.C / (2 * std::sqrt(p.I * p.k));
}
double dry_of(const Parameters& p) {
    return p.Rd / p.k;
}

/// The parameters of the half-cycle map of a decay; empty if the system does not oscillate.
struct Decay {
    theory::Extreme first;
    double extremes = 0;  // number of extremes; infinite if it never stops
    double zeta = 0, shift = 0;

    /// The amplitude at a turn at which the mass may be made to rest; negative if the turn lies beyond the middle.
    double size_at(double turn) const {
        const double theta = theory::HalfCycles(zeta, shift).after(turn, first.theta);
        const bool below = (first.theta < 0) != (std::fmod(turn, 2) != 0);
        return below ? -theta : theta;
    }
};

std::optional<Decay> decay_of(const Parameters& p) {
    const auto system =
        model::Oscillator::make({.inertia = p.I, .stiffness = p.k, .damping = p.C, .kinetic_friction = p.Rd});
    constexpr double most_damping = 0.99;
    if (!system || system->damping_ratio() > most_damping) return {};
    const theory::FreeMotion motion(*system, {p.theta0, p.velocity0});
    return Decay{motion.extreme(0), motion.extremes(), system->damping_ratio(), p.Rd / p.k};
}

/// Fits from several starts and keeps the best result.
class Identification {
public:
    Identification(const IdentifyQuestion& question, const motion::Monitor& monitor)
        : question_(question),
          monitor_(monitor),
          record_(question),
          starts_(question, record_),
          columns_(question.t.size(), 0) {
        choose_unknowns();
    }

    text::Expected<Identified> identified() {
        std::vector<Parameters> starts = starts_.all();
        for (left_out_ = 0; left_out_ < (question_.M ? 1U : 3U); ++left_out_) {
            for (const Parameters& start : starts) {
                if (stopped_ || (best_ && (is_settled() || (agreed_ > 1 && !leaves_pattern(suspected))))) break;
                try_from(start);
            }
        }
        if (!best_) return text::Error{"no motion of such a system comes near this record"};
        if (!question_.M && !stopped_ && leaves_pattern(suspected)) try_from_rest(starts);
        if (!question_.M && !stopped_) try_rests();
        if (question_.M) {
            starts.insert(starts.begin(), filled_best());
            try_from_rest(starts);
        }
        if (question_.M && !stopped_) try_jumps();
        if (question_.M && !stopped_ && leaves_pattern(suspected)) try_other_valleys();
        if (question_.M) distinguish_stops_from_cuts();
        if (seeks_Re_ && !stopped_) try_zero(Unknown::Re, 0.1);
        if (question_.M && is_sought(question_, Unknown::velocity0) && !stopped_) try_zero(Unknown::velocity0, 1e-4);
        return result();
    }

private:
    void choose_unknowns() {
        std::ranges::copy_if(all_unknowns, std::back_inserter(unknowns_),
                             [this](Unknown which) { return is_sought(question_, which); });
        seeks_Re_ = is_sought(question_, Unknown::Re);
    }

    Parameters filled(const Eigen::VectorXd& p) const {
        Parameters all = base_;
        for (std::size_t i = 0; i < unknowns_.size(); ++i) at(all, unknowns_[i]) = p[static_cast<Eigen::Index>(i)];
        if (seeks_Re_) all.Re += all.Rd;
        return all;
    }
    /// Extracts the fitted parameters. Re is fitted as Re - Rd, because values below Rd have no effect.
    Eigen::VectorXd fitted_of(const Parameters& all) const {
        Eigen::VectorXd p(count());
        for (std::size_t i = 0; i < unknowns_.size(); ++i) p[static_cast<Eigen::Index>(i)] = at(all, unknowns_[i]);
        if (seeks_Re_) p[place_of(Unknown::Re)] = std::max(0.0, all.Re - all.Rd);
        return p;
    }
    Eigen::Index place_of(Unknown which) const { return std::ranges::find(unknowns_, which) - unknowns_.begin(); }

    /// Returns whether the record resolves the motion: each swing has samples, and the initial velocity is not too
    /// high. A search may leave this region, where runs take too long and fits are meaningless.
    bool is_resolved(const Parameters& p) const {
        const double highest = record_.highest_omega0();
        constexpr double most = 10;  // greatest way between two samples, in ranges of the record
        const bool seeks_omega0 = is_sought(question_, Unknown::I) || is_sought(question_, Unknown::k);
        return (!seeks_omega0 || p.k <= highest * highest * p.I) &&
               (question_.given.velocity0 || std::fabs(p.velocity0) <= most * record_.range * highest);
    }

    /// The motion with these parameters, clipped like the record.
    [[nodiscard]] std::optional<Eigen::VectorXd> predicted(const Parameters& p, std::size_t rows) {
        return shown(moved(p, rows));
    }
    std::optional<Eigen::VectorXd> shown(std::optional<Eigen::VectorXd> theta) const {
        if (theta && record_.cut.at_low > 0) *theta = theta->cwiseMax(record_.cut.low);
        if (theta && record_.cut.at_high > 0) *theta = theta->cwiseMin(record_.cut.high);
        return theta;
    }

    [[nodiscard]] std::optional<Eigen::VectorXd> moved(const Parameters& p, std::size_t rows) {
        const auto system = system_of(p);
        if (!system || !is_resolved(p)) return {};
        const model::State initial{p.theta0, p.velocity0};
        if (!question_.M) {
            stopped_ = stopped_ || (monitor_ && !monitor_(question_.t.front()));
            if (stopped_) return {};
            std::optional<double> rests_at = rests_at_;
            if (rests_at) *rests_at -= turns_before(p);
            if (rests_at && *rests_at < 0) return {};
            Eigen::VectorXd theta(static_cast<Eigen::Index>(rows));
            theory::free_decay(*system, initial, std::span(question_.t).first(rows), rests_at, {theta.data(), rows});
            theta.array() += p.offset;
            return theta.allFinite() ? std::optional(std::move(theta)) : std::nullopt;
        }
        const auto run = driven(*system, *question_.M, initial, rows);
        if (!run) return {};
        return Eigen::VectorXd(run->column(motion::Column::theta).array() + p.offset);
    }

    /// A run with a row at each of the first `rows` samples; empty if it ends early.
    [[nodiscard]] std::optional<motion::Run> driven(const model::Oscillator& system, const model::Excitation& M,
                                                    const model::State& initial, std::size_t rows) {
        const std::vector<double> times(question_.t.begin(), question_.t.begin() + static_cast<std::ptrdiff_t>(rows));
        motion::Limits limits;
        limits.dense = false;
        auto run = motion::simulate(system, {M, initial}, {times.front(), times.back()}, motion::Grid::at(times),
                                    motion::integrator_for(system, M), monitor_, limits);
        if (!run || static_cast<std::size_t>(run->size()) != rows) {
            stopped_ = stopped_ || (run && (run->outcome == model::Outcome::interrupted ||
                                            run->outcome == model::Outcome::excitation_not_finite));
            return {};
        }
        return std::move(run).value();
    }

    std::optional<model::Oscillator> system_of(const Parameters& p) const {
        model::OscillatorParameters parts;
        parts.inertia = p.I;
        parts.stiffness = p.k;
        parts.damping = p.C;
        parts.kinetic_friction = p.Rd;
        const bool own_breakaway = question_.given.Re || question_.M || breakaway_ > 0;
        if (own_breakaway) {
            const double Re = question_.M || question_.given.Re ? p.Re : breakaway_ * parts.stiffness;
            parts.breakaway = std::max(Re, parts.kinetic_friction);
        }
        const auto system = model::Oscillator::make(parts);
        return system ? std::optional(*system) : std::nullopt;
    }

    FitScale scale_of(const Parameters& start) const {
        FitScale scale{Eigen::VectorXd(count()), Eigen::VectorXd::Constant(count(), -1e300), Eigen::VectorXd(count()),
                       Eigen::VectorXd::Zero(count())};
        const double k = start.k, omega = std::sqrt(k / start.I);
        constexpr double loose_factor = 3;
        for (Eigen::Index i = 0; i < count(); ++i) {
            const Unknown which = unknowns_[static_cast<std::size_t>(i)];
            switch (which) {
                case Unknown::I:
                    scale.typical[i] = scale.least[i] = 1e-6 * start.I;
                    scale.whole[i] = at(start, which);
                    break;
                case Unknown::k:
                    scale.typical[i] = scale.least[i] = 1e-6 * k;
                    scale.whole[i] = k;
                    break;
                case Unknown::C:
                    scale.typical[i] = 0.01 * k / omega;
                    scale.least[i] = 0;
                    scale.whole[i] = std::max(2 * k / omega, at(start, which));  // critical damping
                    break;
                case Unknown::Rd:
                case Unknown::Re:
                    scale.typical[i] = 0.01 * k * record_.range;
                    scale.least[i] = 0;
                    scale.whole[i] = question_.M ? std::max(k * record_.range, at(start, which)) : k * record_.range;
                    break;
                case Unknown::theta0:
                case Unknown::offset:
                    scale.typical[i] = 0.1 * record_.range;
                    scale.hold[i] = record_.noise / (loose_factor * record_.range);
                    scale.whole[i] = record_.range;
                    break;
                case Unknown::velocity0:
                    scale.typical[i] = 0.1 * record_.range * omega;
                    scale.whole[i] = std::max(record_.range * omega, std::fabs(at(start, which)));
                    break;
            }
        }
        return scale;
    }

    /// Fits the beginning of the record first, so that no swing is mistaken for its neighbour, and then all of it.
    void try_from(const Parameters& start) {
        base_ = start;
        Eigen::VectorXd p = fitted_of(start);
        const double period = 2 * std::numbers::pi * std::sqrt(start.I / start.k);
        const FitScale scale = scale_of(start);
        const std::size_t least = unknowns_.size() + 4;
        std::size_t done = least;
        std::optional<LeastSquares> some;
        for (const std::size_t rows : stages(period)) {
            if (rows < done || rows >= question_.t.size()) continue;
            some = fit(p, rows, scale, 12);
            if (some) p = some->parameters;
            done = rows + 1;
        }
        const std::optional<LeastSquares> all = fit(p, question_.t.size(), scale, 40);
        if (all && best_ && std::fabs(all->sum - best_->sum) <= same_fit * best_->sum) ++agreed_;
        keep_if_better(all, scale);
        if (some && (!moving_ || (all && best_ && all->sum <= best_->sum))) moving_ = some->parameters;
    }

    /// Also searches from initial velocity 0, because a search may end at a velocity that decays between two samples.
    void try_from_rest(const std::vector<Parameters>& starts) {
        if (question_.given.velocity0) return;
        const Eigen::Index place = place_of(Unknown::velocity0);
        for (const Parameters& start : starts) {
            if (stopped_ || !((question_.M && &start == starts.data()) || leaves_pattern(suspected))) return;
            base_ = start;
            base_.velocity0 = 0;
            const FitScale scale = scale_of(base_);
            FitScale held = scale;
            held.hold[place] = firm_weight * record_.range / scale.typical[place];
            const auto let_go = fit(fitted_of(base_), question_.t.size(), held, 40);
            const auto all = let_go ? fit(let_go->parameters, question_.t.size(), scale, 40) : std::nullopt;
            if (all && all->sum < best_->sum) moving_ = all->parameters;
            keep_if_better(all, scale);
        }
    }

    void keep_if_better(const std::optional<LeastSquares>& all, const FitScale& scale) {
        if (all && question_.M) seen_.emplace_back(all->sum, filled(all->parameters));
        if (!all || (best_ && !(all->sum < best_->sum))) return;
        if (best_ && all->sum < (1 - same_fit) * best_->sum) agreed_ = 0;
        best_ = Best{*all, scale, base_, breakaway_};
    }

    /// The numbers of samples to fit, one after another. Each fit starts from that of a shorter part, so no swing is
    /// mistaken for its neighbour. A free decay ends at its last turn, after which it may rest.
    std::vector<std::size_t> stages(double period) const {
        std::vector<std::size_t> rows;
        const double first = question_.t.front();
        double length = 2.2 * period;
        while (first + length < question_.t.back()) {
            const auto until = std::ranges::upper_bound(question_.t, first + length);
            rows.push_back(static_cast<std::size_t>(until - question_.t.begin()));
            if (!question_.M) break;
            length *= 2;
        }
        if (!question_.M && record_.turns.size() > left_out_)
            rows.push_back(record_.turns[record_.turns.size() - 1 - left_out_] + 1);
        return rows;
    }

    [[nodiscard]] std::optional<LeastSquares> fit(const Eigen::VectorXd& p, std::size_t rows, const FitScale& scale,
                                                  int steps) {
        const auto model = [this, rows](const Eigen::VectorXd& q) { return predicted(filled(q), rows); };
        return least_squares(model, record_.theta.head(static_cast<Eigen::Index>(rows)), p, scale, steps);
    }

    double deviation() const {
        const auto told =
            record_.theta.size() - static_cast<Eigen::Index>(record_.cut.at_low + record_.cut.at_high) - count();
        return std::sqrt(best_->sum / static_cast<double>(std::max<Eigen::Index>(1, told)));
    }
    /// Returns whether the residual is no larger than the noise, whose estimate is accurate to a few percent for such a
    /// record.
    bool is_settled() const { return deviation() <= std::max(1.06 * record_.noise, 1e-9 * record_.range); }
    Eigen::Index count() const { return static_cast<Eigen::Index>(unknowns_.size()); }

    // ---- the turn at which a free decay comes to rest
    //
    // Each number of swings before rest is a separate valley of the sum of squares, with steep walls due to the many
    // samples at rest. With a prescribed number, the place of rest is a smooth function of the parameters. So each
    // number near the best one is fitted separately. It counts if some Re >= Rd lets the mass pass the previous turn
    // and holds it at this one. Besides the sum of squares the prior probability matters: a way to rest that needs a
    // tiny part of the parameter space is unlikely. So each is weighted by exp(-sum / 2 noise^2) times the volume of
    // its errors.

    void try_rests() {
        if (!record_.ends_at_rest()) return;
        number_turns(filled_best());
        try_rest_at(std::numeric_limits<double>::infinity());
        const auto decay = decay_of(filled_best());
        if (!decay) return;
        // The mass may rest at the earliest at the last turn that exceeds the noise.
        const double seen = std::max(0.0, static_cast<double>(record_.turns.size()) - 2);
        const double middle = std::isfinite(decay->extremes) ? decay->extremes - 1 + turns_before(filled_best()) : seen;
        // Tries turns to both sides as far as the record permits, and a few more.
        constexpr double clearly_worse = 12;
        constexpr int most_tries = 25;
        try_rest_at(middle, true);
        for (const double way : {1.0, -1.0}) {
            int beyond = 0;
            for (int tries = 1; tries <= most_tries && !stopped_; ++tries) {
                const double turn = middle + way * tries;
                if (turn < 0) break;
                const double sum = try_rest_at(turn);
                beyond = sum > best_->sum + clearly_worse * deviation() * deviation() ? beyond + 1 : 0;
                if (beyond > 1 && (way > 0 || turn < seen)) break;
            }
        }
    }

    void number_turns(const Parameters& p) {
        const double swift = p.velocity0 * std::sqrt(p.I / p.k);
        starts_at_turn_ = std::fabs(swift) < std::fabs(p.theta0);
    }

    /// A turn near the start has number 0, whether it comes just after or just before it. So the numbers do not change
    /// if the fitted initial velocity, nearly 0, changes its sign.
    double turns_before(const Parameters& p) const { return starts_at_turn_ && p.theta0 * p.velocity0 < 0 ? 1 : 0; }

    /// Fits with the mass resting at this turn, or never if it is infinite; if `goes_on`, starts from the best fit as
    /// well. If no friction permits such a rest, continues the fit without it. Returns the sum of squares, or infinity.
    double try_rest_at(double turn, bool goes_on = false) {
        rests_at_ = turn;
        auto found = fit(moving_.value_or(best_->parameters), question_.t.size(), best_->scale, 30);
        if (goes_on) {
            const auto other = fit(best_->parameters, question_.t.size(), best_->scale, 30);
            if (other && (!found || other->sum < found->sum)) found = other;
        }
        constexpr double few = 4, much = 0.02;  // with less noise the fit of the moving part is a sufficient start
        const bool is_open = turn <= few && record_.noise > much * record_.range;
        for (const Parameters& start : is_open ? shares_of_loss() : std::vector<Parameters>()) {
            const auto other = fit(fitted_of(start), question_.t.size(), best_->scale, 30);
            if (other && (!found || other->sum < found->sum)) found = other;
        }
        rests_at_.reset();
        if (!found) return std::numeric_limits<double>::infinity();
        const double sum = found->sum;
        const std::optional<double> breakaway = holding(filled(found->parameters), turn);
        breakaway_ = breakaway.value_or(0);
        if (!breakaway) found = fit(found->parameters, question_.t.size(), best_->scale, 15);
        if (!found) return std::numeric_limits<double>::infinity();
        const Rest rest{*found, breakaway_, breakaway ? std::optional(turn) : std::nullopt, {}};
        if (found->sum < best_->sum || is_same(*found, *best_)) {
            keep_if_better(found, best_->scale);
            best_->rest = rest.turn;
        }
        breakaway_ = best_->breakaway;
        const auto is_it = [&](const Rest& other) { return is_same(other.fit, *found); };
        if (std::ranges::none_of(rests_, is_it)) rests_.push_back(rest);
        return breakaway ? sum : std::numeric_limits<double>::infinity();
    }

    /// Starting values with the first loss of the best fit, split differently between viscous and dry friction. A short
    /// record that rests one turn earlier or later may belong to one of these, which the search cannot reach from the
    /// best fit.
    [[nodiscard]] std::vector<Parameters> shares_of_loss() {
        const Parameters best = filled_best();
        const auto decay = decay_of(best);
        if (!decay) return {};
        const double whole = std::fabs(decay->first.theta), least = 0.05 * whole, most = 0.95 * whole;
        const double lost = std::clamp(whole - decay->size_at(1), least, most);
        const double omega0 = std::sqrt(best.k / best.I);
        std::vector<Parameters> starts;
        for (const double dry : {0.2, 0.5, 0.8}) {
            const double q = 1 - (1 - dry) * lost / whole, ratio = -std::log(q) / std::numbers::pi;
            starts.push_back(
                starts_.completed(omega0, ratio / std::hypot(1, ratio), dry * lost / (1 + q), best.offset));
        }
        return starts;
    }

    /// The Re/k that makes a free decay rest at this turn and not earlier; 0 if Rd does, empty if no value does.
    std::optional<double> holding(const Parameters& p, double turn) const {
        const auto decay = std::isfinite(turn) ? decay_of(p) : std::nullopt;
        turn -= turns_before(p);
        if (!decay || turn < 0) return {};
        const double here = std::fabs(decay->size_at(turn)), least = std::max(decay->shift, here);
        const double most = turn > 0 ? decay->size_at(turn - 1) : 3 * least;
        if (!(least < most)) return {};
        if (question_.given.Re) {
            const double holds = std::max(p.Re / p.k, decay->shift);
            return holds >= here && holds < most ? std::optional(0.0) : std::nullopt;
        }
        return here <= decay->shift ? 0 : (least + most) / 2;
    }

    [[nodiscard]] Parameters filled_best() {
        base_ = best_->base;
        return filled(best_->parameters);
    }

    // ---- steps of the sum of squares in a driven motion
    //
    // Re matters only at rest, so the sum of squares has steps: at some Re a stop appears, lasts over a whole swing of
    // M, or vanishes. A gradient does not lead across steps. So the whole range of Re is sampled, and fits continue
    // from the best values. The derivatives then underestimate the errors: every sampled motion that fits about as well
    // shows how far the parameters may be off.

    /// Tries systems that gradients do not reach, as long as the fit improves.
    void try_jumps() {
        constexpr int rounds = 3;
        bool better = true;
        for (int round = 0; round < rounds && better && !stopped_; ++round) {
            better = try_other_beginnings();
            better = (seeks_Re_ && try_other_breakaways()) || better;
            better = (!stopped_ && try_beyond_steps()) || better;
        }
    }

    // ---- the start of a driven mass
    //
    // A mass that M cannot move at first stops at once for every small velocity, so near 0 nothing depends on the
    // velocity. Therefore the beginning of the record is fitted from velocities of all sizes, and then the whole record
    // from the best ones.

    /// Fits the initial angle and velocity to the beginning of the record with the other parameters fixed, from
    /// velocities of both signs and all sizes, or from several angles if the velocity is given. Continues from the best
    /// results. Returns whether the fit has improved.
    [[nodiscard]] bool try_other_beginnings() {
        std::vector<Unknown> first;
        for (const Unknown which : {Unknown::velocity0, Unknown::theta0}) {
            if (!question_.gives(which)) first.push_back(which);
        }
        if (first.empty()) return false;
        const Parameters best = filled_best();
        const double before = best_->sum;
        const FitScale scale = scale_of(best);
        const auto size = static_cast<Eigen::Index>(first.size());
        FitScale of_first{Eigen::VectorXd(size), Eigen::VectorXd::Constant(size, -1e300), Eigen::VectorXd(size),
                          Eigen::VectorXd::Zero(size)};
        Eigen::VectorXd now(size);
        for (Eigen::Index i = 0; i < size; ++i) {
            const Unknown which = first[static_cast<std::size_t>(i)];
            of_first.typical[i] = scale.typical[place_of(which)];
            now[i] = at(best, which);
        }
        const auto with = [&](const Eigen::VectorXd& q) {
            Parameters p = best;
            for (Eigen::Index i = 0; i < size; ++i) at(p, first[static_cast<std::size_t>(i)]) = q[i];
            return p;
        };
        const double half = std::numbers::pi * std::sqrt(best.I / best.k);
        const auto until = std::ranges::upper_bound(question_.t, question_.t.front() + half);
        constexpr std::ptrdiff_t least_rows = 8;
        const auto rows = static_cast<std::size_t>(std::max(until - question_.t.begin(), least_rows));
        const Prediction model = [&](const Eigen::VectorXd& q) { return predicted(with(q), rows); };
        const auto head = static_cast<Eigen::Index>(rows);
        const double whole = scale.whole[place_of(first.front())];
        std::vector<LeastSquares> found;
        for (const double part : {0.03, -0.03, 0.1, -0.1, 0.3, -0.3, 1.0, -1.0}) {
            Eigen::VectorXd q = now;
            q[0] = part * whole + (first.front() == Unknown::theta0 ? now[0] : 0);
            constexpr int steps = 10;
            auto one = least_squares(model, record_.theta.head(head), q, of_first, steps);
            if (one) found.push_back(std::move(*one));
        }
        std::ranges::sort(found, [](const auto& a, const auto& b) { return a.sum < b.sum; });
        const double told = best_->residual.head(head).squaredNorm();
        constexpr std::size_t tries = 2;
        for (std::size_t i = 0; i < std::min(tries, found.size()) && !stopped_; ++i) {
            if (is_settled() && found[i].sum > told - record_.noise * record_.noise) break;
            if (i > 0 && is_same(found[i], found[i - 1])) continue;
            base_ = with(found[i].parameters);
            const FitScale from = scale_of(base_);
            keep_if_better(fit(fitted_of(base_), question_.t.size(), from, 30), from);
        }
        return best_->sum < (1 - same_fit) * before;
    }

    /// Samples Re from Rd to four times that, or to the value that holds the mass anywhere in the record, and continues
    /// from the two best. Returns whether the fit has improved.
    [[nodiscard]] bool try_other_breakaways() {
        const Parameters best = filled_best();
        const double before = best_->sum, Rd = best.Rd;
        const double whole = std::max(4 * Rd, 0.5 * best.k * record_.range);
        std::vector<std::pair<double, double>> sums;
        constexpr int looks = 24;
        for (int i = 0; i <= looks && !stopped_; ++i) {
            Parameters p = best;
            const double part = static_cast<double>(i) / looks;
            p.Re = Rd + whole * part * part;
            const auto theta = predicted(p, question_.t.size());
            if (!theta) continue;
            sums.emplace_back((record_.theta - *theta).squaredNorm(), p.Re);
            seen_.emplace_back(sums.back().first, p);
        }
        std::ranges::sort(sums);
        constexpr std::size_t tries = 2;
        for (std::size_t i = 0; i < std::min(tries, sums.size()) && !stopped_; ++i) {
            Parameters p = best;
            p.Re = sums[i].second;
            base_ = p;
            const FitScale scale = scale_of(p);
            keep_if_better(fit(fitted_of(p), question_.t.size(), scale, 30), scale);
        }
        return best_->sum < (1 - same_fit) * before;
    }

    /// Continues a search that small steps of the sum of squares have stopped inside a valley, with differences as
    /// large as the noise. Returns whether the fit has improved.
    [[nodiscard]] bool try_beyond_steps() {
        const double noise = deviation(), before = best_->sum;
        base_ = best_->base;
        const auto J = derivative([this](const Eigen::VectorXd& q) { return predicted(filled(q), question_.t.size()); },
                                  best_->parameters, best_->scale, noise);
        if (!J || count() == 0) return false;
        const auto units = best_->scale.whole.asDiagonal();
        const Eigen::VectorXd way = units * algebra::solve_least_squares(*J * units, best_->residual);
        if (!way.allFinite()) return false;
        for (const double part : {1.0, 0.5, 0.25}) {
            const Eigen::VectorXd p = (best_->parameters + part * way).cwiseMax(best_->scale.least);
            const auto theta = stopped_ ? std::nullopt : predicted(filled(p), question_.t.size());
            if (!theta || !((record_.theta - *theta).squaredNorm() < before - 0.01 * noise * noise)) continue;
            keep_if_better(fit(p, question_.t.size(), best_->scale, 30), best_->scale);
            break;
        }
        return best_->sum < (1 - same_fit) * before;
    }

    // ---- another valley
    //
    // Dry and viscous friction dissipate similar amounts at one amplitude, and a stuck mass rests under many loads. So
    // a search may end in a wrong valley, or in one where nothing moves. A pattern in the residual shows this.

    /// Samples systems with other natural frequencies, losses and shares of dry friction, and continues from the best
    /// one.
    void try_other_valleys() {
        const double before = best_->sum;
        std::vector<std::pair<double, Parameters>> looks;
        const std::size_t rows = question_.t.size();
        for (const Parameters& from : {filled_best(), starts_.weak_form()}) {
            const double I = from.I, k = from.k;
            for (const double faster : {0.6, 0.8, 1.0, 1.25, 1.6}) {
                Parameters p = from;
                if (!question_.given.I) p.I = I / (faster * faster);
                if (question_.given.I && !question_.given.k) p.k = k * faster * faster;
                const double omega0 = std::sqrt(p.k / p.I);
                const double speed =
                    record_.range * omega0 * std::numbers::pi / 8;  // mean speed of a swing over half the range
                const double least = 0.02 * k * record_.range, most = k * record_.range;
                const double lost = std::clamp(from.C * speed + from.Rd, least, most);
                for (const double more : {0.5, 1.0, 2.0}) {
                    for (const double dry : {0.05, 0.35, 0.65, 0.95}) {
                        for (const double breakaway : {1.05, 1.4}) {
                            p.Rd = question_.given.Rd.value_or(dry * more * lost);
                            p.C = question_.given.C.value_or((1 - dry) * more * lost / speed);
                            p.Re = question_.given.Re.value_or(breakaway * p.Rd);
                            const auto theta = stopped_ ? std::nullopt : predicted(p, rows);
                            if (theta) looks.emplace_back((record_.theta - *theta).squaredNorm(), p);
                        }
                    }
                }
            }
        }
        std::ranges::sort(looks, [](const auto& a, const auto& b) { return a.first < b.first; });
        constexpr std::size_t tries = 8;
        for (std::size_t i = 0; i < std::min(tries, looks.size()); ++i) {
            if (!stopped_ && leaves_pattern(suspected)) try_from(looks[i].second);
        }
        if (best_->sum < (1 - same_fit) * before && !stopped_) try_jumps();
    }

    /// Tries to set Re - Rd or the initial velocity to 0. A motion that never stops does not determine Re, except that
    /// it is not larger, and one that is stuck at first does not determine its velocity. If the prediction does not
    /// depend on the parameter near 0, and 0 fits within the noise, 0 is used, so that no stops are inferred from
    /// noise. The errors remain those of the fit with this parameter free.
    void try_zero(Unknown which, double little) {
        const LeastSquares best = *best_;
        base_ = best_->base;
        const Eigen::Index place = place_of(which);
        FitScale scale = best_->scale;
        scale.hold[place] = firm_weight * record_.range / scale.typical[place];
        Eigen::VectorXd start = best.parameters;
        start[place] = 0;
        const auto without = fit(start, question_.t.size(), scale, 40);
        if (!without) return;
        seen_.emplace_back(without->sum, filled(without->parameters));
        const double variance = deviation() * deviation(), rise = without->sum - best.sum;
        constexpr double significant = 4;  // two standard errors
        if (rise > significant * variance) return;
        constexpr double same = 1e-8;
        Eigen::VectorXd more = without->parameters;
        more[place] = little * scale.typical[place];
        const auto theta = predicted(filled(more), question_.t.size());
        const bool is_flat =
            theta && (record_.theta - *theta - without->residual).cwiseAbs().maxCoeff() <= same * record_.range;
        if (rise > 0 && !is_flat) return;
        if (!freest_) freest_ = best;
        best_->take(*without);
        best_->parameters[place] = 0;  // exactly 0; the fit has held it there except for rounding
        at(has_no_effect_, which) = is_flat;
        if (is_flat && which == Unknown::velocity0 && !question_.given.theta0) explore_short_beginnings();
    }

    /// Varies the initial velocity of a mass that stops before there are many samples; the fitted initial angles show
    /// the error of the angle.
    void explore_short_beginnings() {
        const Parameters best = filled_best();
        const FitScale scale = scale_of(best);
        const double whole = scale.whole[place_of(Unknown::velocity0)];
        FitScale of_angle{Eigen::VectorXd::Constant(1, scale.typical[place_of(Unknown::theta0)]),
                          Eigen::VectorXd::Constant(1, -1e300), Eigen::VectorXd(1), Eigen::VectorXd::Zero(1)};
        for (const double side : {1.0, -1.0}) {
            double angle = best.theta0;
            for (const double part : {0.02, 0.04, 0.06, 0.09, 0.13, 0.2}) {
                Parameters p = best;
                p.velocity0 = side * part * whole;
                const Prediction model = [&](const Eigen::VectorXd& q) {
                    p.theta0 = q[0];
                    return predicted(p, question_.t.size());
                };
                constexpr int steps = 4;
                const auto found =
                    least_squares(model, record_.theta, Eigen::VectorXd::Constant(1, angle), of_angle, steps);
                if (!found) break;
                p.theta0 = angle = found->parameters[0];
                seen_.emplace_back(found->sum, p);
                constexpr double possible = 16;
                if (found->sum > best_->sum + possible * deviation() * deviation()) break;
            }
        }
    }

    /// Decides whether a record is clipped at its extreme values or the mass rested there: in the latter case the fit
    /// does not exceed them.
    void distinguish_stops_from_cuts() {
        if (record_.cut.at_low + record_.cut.at_high == 0) return;
        const auto whole = moved(filled_best(), question_.t.size());
        if (!whole) return;
        const double beyond = 3 * deviation() + 1e-6 * record_.range;
        if (whole->maxCoeff() < record_.cut.high + beyond) record_.cut.at_high = 0;
        if (whole->minCoeff() > record_.cut.low - beyond) record_.cut.at_low = 0;
        if (record_.cut.at_low + record_.cut.at_high > 0) return;
        if (const auto uncut = fit(best_->parameters, question_.t.size(), best_->scale, 15)) best_->take(*uncut);
    }

    /// A lower bound of the standard error: for a parabolic sum of squares, each sampled motion that fits nearly as
    /// well indicates one.
    double least_error(const std::function<double(const Parameters&)>& value) const {
        const double noise = deviation(), best = value(best_filled_);
        constexpr double possible = 16;
        double least = 0;
        for (const auto& [sum, p] : seen_) {
            const double rise = (sum - best_->sum) / (noise * noise);
            if (rise < possible) least = std::max(least, std::fabs(value(p) - best) / std::sqrt(std::max(1.0, rise)));
        }
        return least;
    }

    // ---- probability of each way to rest

    /// The turn at which the motion rests, or after which it is too small to be seen.
    std::optional<double> resting_turn(const Parameters& p, double noise) const {
        const auto system = question_.M ? std::nullopt : system_of(p);
        if (!system || !theory::Modes(system->damping_ratio()).swings()) return {};
        const theory::FreeMotion motion(*system, {p.theta0, p.velocity0});
        constexpr double unseen = 0.01;
        const double shift = system->kinetic_friction() / system->stiffness();
        const double last = theory::HalfCycles(system->damping_ratio(), shift)
                                .until_within(std::max(shift, unseen * noise), motion.extreme(0).theta);
        return std::min(motion.extremes() - 1, last) + turns_before(p);
    }

    /// The derivatives with the turn of rest fixed, because differences across a change of that number are meaningless.
    [[nodiscard]] Eigen::MatrixXd slopes_at(const Rest& rest, double noise) {
        breakaway_ = rest.breakaway;
        const Parameters p = filled(rest.fit.parameters);
        rests_at_ = rest.turn ? rest.turn : resting_turn(p, noise);
        const auto J = derivative([this](const Eigen::VectorXd& q) { return predicted(filled(q), question_.t.size()); },
                                  rest.fit.parameters, scale_of(p), noise);
        rests_at_.reset();
        return J.value_or(Eigen::MatrixXd::Zero(record_.theta.size(), count()));
    }
    void find_covariance(Rest& rest, double noise) {
        rest.slopes = slopes_at(rest, noise);
        rest.covariance = covariance_of(rest.slopes, scale_of(filled(rest.fit.parameters)).whole, noise);
        add_steps(rest.slopes, record_.theta - rest.fit.residual, record_.step, noise, rest.covariance.matrix);
    }

    /// Selects the most probable way to rest. Its covariance, in units of noise squared, includes the uncertainty due
    /// to the other ways.
    [[nodiscard]] Rest choose_rest() {
        base_ = best_->base;
        const double noise = deviation(), least = best_->sum;
        Rest best{freest_.value_or(*best_), best_->breakaway, best_->rest};
        find_covariance(best, noise);
        if (freest_ && noise > 0) {
            const Eigen::VectorXd apart = (freest_->parameters - best_->parameters) / noise;
            best.covariance.matrix += apart * apart.transpose();
            Rest held{*best_, best_->breakaway, best_->rest};
            find_covariance(held, noise);
            best.covariance.matrix.diagonal() =
                best.covariance.matrix.diagonal().cwiseMax(held.covariance.matrix.diagonal());
            best.slopes = std::move(held.slopes);
        }
        if (rests_.empty() || !(noise > 0)) return best;
        constexpr double clearly_worse = 40;
        std::vector<Rest> ways{best};
        for (Rest& rest : rests_) {
            if (rest.fit.sum > least + clearly_worse * noise * noise || is_same(rest.fit, *best_)) continue;
            find_covariance(rest, noise);
            ways.push_back(rest);
        }
        const auto evidence = [&](const Rest& rest) {
            return (least - rest.fit.sum) / (2 * noise * noise) + rest.covariance.log_volume;
        };
        for (const Rest& rest : ways) best = evidence(rest) > evidence(best) ? rest : best;
        best_->take(best.fit);
        best_->breakaway = best.breakaway;
        Covariance all{Eigen::MatrixXd::Zero(count(), count()), best.covariance.silent, best.covariance.open, 0};
        double odds = 0;
        for (const Rest& rest : ways) {
            const double share = std::exp(evidence(rest) - evidence(best));
            const Eigen::VectorXd apart = (rest.fit.parameters - best.fit.parameters) / noise;
            all.matrix += share * (rest.covariance.matrix + apart * apart.transpose());
            odds += share;
        }
        all.matrix /= odds;
        best.covariance = std::move(all);
        return best;
    }

    // ---- signs of a wrong model

    /// Returns whether the residual is rounding, of the motion or of an instrument.
    bool is_rounding() const { return !(deviation() > least_noise * record_.range) || stopped_ || is_within_a_step(); }

    /// The changes of the best fit, with `run` as its motion, that each possibly missing torque would cause.
    [[nodiscard]] std::optional<Eigen::MatrixXd> responses_at_best(const model::Oscillator& system,
                                                                   const model::State& initial,
                                                                   const motion::Run& run) {
        const model::Excitation M = question_.M.value_or(model::Excitation());
        if (M.has_feedback()) {
            const std::size_t n = question_.t.size();
            const Pushed pushed = [&](const model::Excitation& added) -> std::optional<Eigen::VectorXd> {
                const auto other = driven(system, M + added, initial, n);
                if (!other) return {};
                return shown(Eigen::VectorXd(other->column(motion::Column::theta).array() + best_filled_.offset));
            };
            const Eigen::VectorXd theta = run.column(motion::Column::theta),
                                  velocity = run.column(motion::Column::velocity);
            const std::span<const double> angles(theta.data(), n), speeds(velocity.data(), n);
            return responses(pushed, MissingTorques(angles, speeds).along(question_.t, angles, speeds),
                             system.stiffness() * record_.range, deviation());
        }
        Eigen::MatrixXd changes = responses(system, M, run, question_.t);
        const Eigen::VectorXd seen = record_.theta - best_->residual;
        for (Eigen::Index i = 0; i < changes.rows(); ++i) {
            const bool is_cut = (record_.cut.at_low > 0 && seen[i] <= record_.cut.low) ||
                                (record_.cut.at_high > 0 && seen[i] >= record_.cut.high);
            if (is_cut) changes.row(i).setZero();
        }
        return changes;
    }

    /// The terms that the model may lack: a drift first, then torques that depend on the velocity and on theta.
    [[nodiscard]] std::vector<Structure> structures(bool is_white) {
        const auto system = system_of(best_filled_);
        if (!system) return {};
        const model::State initial{best_filled_.theta0, best_filled_.velocity0};
        const auto run = driven(*system, question_.M.value_or(model::Excitation()), initial, question_.t.size());
        if (!run) return {};
        std::vector<Structure> found{drift(question_.t, columns_, 0, is_white)};
        if (const auto changes = responses_at_best(*system, initial, *run)) {
            found.push_back(
                {Follows::velocity, changes->leftCols(velocity_torques), {}, plausible_friction(best_filled_.Rd)});
            found.push_back({Follows::theta,
                             changes->rightCols(theta_torques),
                             {},
                             plausible_spring(best_filled_.k * record_.range / 4)});
        }
        return found;
    }

    /// Returns whether the residual is within half a step of the instrument, which correlates errors if the motion is
    /// slow.
    bool is_within_a_step() const {
        constexpr double part = 0.5;
        return deviation() < part * record_.step;
    }
    /// The noise that determines the errors. Rounding to steps does not show in a resting mass, as the fitted zero
    /// absorbs it.
    double noise_of_errors() const {
        return is_within_a_step() ? std::max(deviation(), record_.step / std::sqrt(12.0)) : deviation();
    }

    [[nodiscard]] Identified result() {
        Identified found;
        const Rest weighed = choose_rest();
        Covariance covariance = weighed.covariance;
        breakaway_ = best_->breakaway;
        found.value = best_filled_ = filled_best();
        if (!question_.M && !question_.given.Re) {
            found.value.Re = std::max(found.value.Rd, breakaway_ * found.value.k);
            found.silent.Re = true;
        }
        found.noise = deviation();
        const Eigen::VectorXd& left = best_->residual;
        const NoiseMemory memory(left, columns_, weighed.slopes);
        judge(weighed.slopes, found);
        const double spread = noise_of_errors();
        Eigen::MatrixXd of_model = Eigen::MatrixXd::Zero(count(), count());
        if (!found.is_noise && !found.wild && !is_rounding() && count() > 0) {
            of_model = widen(weighed.slopes, memory, covariance, found);
        } else if (is_within_a_step() && deviation() > least_noise * record_.range) {
            found.widening = std::sqrt(correlation_length({left.data(), question_.t.size()}));
            covariance.matrix *= found.widening * found.widening;
            allow_for_drift(weighed.slopes, memory, Eigen::VectorXd::Ones(count()), covariance, found);
            of_model = unseen_covariance(structures(memory.none()), left, memory, weighed.slopes,
                                         scale_of(best_filled_).whole, spread) /
                       (spread * spread);
        }
        for (Eigen::Index i = 0; i < count(); ++i) {
            const auto place = static_cast<std::size_t>(i);
            at(found.silent, unknowns_[place]) = covariance.silent[place] || at(has_no_effect_, unknowns_[place]);
        }
        set_errors(full_of(covariance.matrix), spread, found);
        found.if_right = found.error;
        for (IdentifiedRatio* ratio : found.ratios()) ratio->if_right = ratio->error;
        const Eigen::MatrixXd full = full_of(covariance.matrix + of_model);
        set_errors(full, spread, found);
        if (found.is_unexplained && !found.wild) found.has_errors = false;
        for (const Unknown which : all_unknowns) set_bounds(which, spread, full, covariance.open, found);
        if (found.is_noise) {  // the errors assume a motion, and there may be none
            found.error = found.if_right = {};
            for (IdentifiedRatio* ratio : found.ratios()) ratio->error = ratio->if_right = 0;
            for (const Unknown which : unknowns_) at(found.silent, which) = true;
            for (const Unknown which : all_unknowns) {
                at(found.low, which) = -model::never, at(found.high, which) = model::never;
            }
        }
        const Eigen::VectorXd predicted_all = record_.theta - best_->residual;
        found.predicted.assign(predicted_all.begin(), predicted_all.end());
        found.cut_low = record_.cut.at_low;
        found.cut_high = record_.cut.at_high;
        return found;
    }

    /// Widens the errors by the memory and unevenness of the noise, and that of the offset at the first time by a
    /// steady drift. Returns what the model may lack adds to the covariance, in units of noise squared.
    [[nodiscard]] Eigen::MatrixXd widen(const Eigen::MatrixXd& J, const NoiseMemory& memory, Covariance& covariance,
                                        Identified& found) {
        const Eigen::VectorXd &left = best_->residual, whole = scale_of(best_filled_).whole;
        const Eigen::VectorXd by_memory = widened_by_memory(memory, J, whole, found.noise),
                              by_place = widened_by_uneven_noise(memory, left, J, whole, found.noise),
                              wider = by_memory.cwiseProduct(by_place);
        found.widening = std::max(1.0, by_memory.maxCoeff());
        found.noise_is_uneven = by_place.mean() > much_wider;
        covariance.matrix = wider.asDiagonal() * covariance.matrix * wider.asDiagonal();
        const std::vector<Structure> lacking = structures(memory.none());
        auto wrong = misfit_of(left, {memory.none(), found.noise_is_uneven}, columns_, J, lacking);
        const Eigen::VectorXd drift = allow_for_drift(J, memory, by_place, covariance, found);
        if (wrong && drift.size() > 0) wrong->shift -= drift;
        Eigen::MatrixXd more = unseen_covariance(lacking, left, memory, J, whole, found.noise);
        if (wrong) more += wrong->added_covariance();
        if (wrong && wrong->is_sure) {
            found.misfit = wrong->follows;
            found.noise_without_misfit = std::min(wrong->noise, found.scatter);
            found.has_errors = wrong->leaves_errors();
        }
        return more / (found.noise * found.noise);
    }

    /// Corrects the offset to its value at the first time, in case the zero drifts steadily, and widens its error.
    /// Returns the change of all parameters; empty if no offset is fitted.
    Eigen::VectorXd allow_for_drift(const Eigen::MatrixXd& J, const NoiseMemory& memory, const Eigen::VectorXd& wider,
                                    Covariance& covariance, Identified& found) const {
        const Eigen::Index zero = place_of(Unknown::offset);
        if (zero >= count() || covariance.silent[static_cast<std::size_t>(zero)]) return {};
        const Eigen::VectorXd ramp = drift(question_.t, columns_, 0, true).columns.col(0),
                              whole = scale_of(best_filled_).whole;
        const double noise = noise_of_errors();
        const Nuisance steady = nuisance(ramp, record_.range, best_->residual, memory, J, whole, noise);
        const double more = steady.covariance(zero, zero) - remembered_covariance(memory, J, whole, noise)(zero, zero);
        covariance.matrix(zero, zero) += wider[zero] * wider[zero] * more;
        found.value.offset += steady.shift[zero];
        Eigen::VectorXd change = Eigen::VectorXd::Zero(count());
        change[zero] = steady.shift[zero];
        return change;
    }

    /// The covariance matrix of all unknowns from that of the fitted ones.
    Eigen::MatrixXd full_of(const Eigen::MatrixXd& covariance) const {
        Eigen::MatrixXd full = Eigen::MatrixXd::Zero(unknown_count, unknown_count);
        const auto place = [&](Eigen::Index i) {
            return static_cast<Eigen::Index>(unknowns_[static_cast<std::size_t>(i)]);
        };
        for (Eigen::Index i = 0; i < count(); ++i) {
            for (Eigen::Index j = 0; j < count(); ++j) full(place(i), place(j)) = covariance(i, j);
        }
        if (seeks_Re_) {  // add the variance of Rd to that of Re - Rd
            constexpr auto Rd = static_cast<Eigen::Index>(Unknown::Rd), Re = static_cast<Eigen::Index>(Unknown::Re);
            full.row(Re) += full.row(Rd);
            full.col(Re) += full.col(Rd);
        }
        return full;
    }

    void set_errors(const Eigen::MatrixXd& full, double spread, Identified& found) const {
        for (const Unknown which : unknowns_) {
            const auto place = static_cast<Eigen::Index>(which);
            const double open = least_error([which](const Parameters& p) { return at(p, which); });
            at(found.error, which) =
                at(found.silent, which) ? 0 : std::max(open, spread * std::sqrt(full(place, place)));
        }
        ratios(full, spread, found);
    }

    // ---- bounds of parameters that the record does not determine

    void set_bounds(Unknown which, double spread, const Eigen::MatrixXd& covariance, const std::vector<bool>& open,
                    Identified& found) {
        if (!at(found.silent, which)) return;
        double &low = at(found.low, which) = at(found.value, which),
               &high = at(found.high, which) = at(found.value, which);
        if (which == Unknown::Re && !question_.M) {
            std::tie(low, high) = breakaways();
        } else if (at(has_no_effect_, which)) {
            constexpr double equally_good = 4;  // two standard errors
            for (const auto& [sum, p] : seen_) {
                if (sum > best_->sum + equally_good * spread * spread) continue;
                low = std::min(low, at(p, which)), high = std::max(high, at(p, which));
            }
            if (which != Unknown::Re) low = std::min(low, reach(which, -1, spread));
            high = std::max(high, reach(which, 1, spread));
        } else {
            const auto place = static_cast<Eigen::Index>(which);
            const bool is_open = open[static_cast<std::size_t>(place_of(which))];
            const double error = is_open ? INFINITY : 2 * spread * std::sqrt(covariance(place, place));
            low -= error, high += error;
        }
        if (which < Unknown::theta0) low = std::max(low, which == Unknown::Re ? found.value.Rd : 0.0);
    }

    /// The change of this parameter alone in direction `way` that worsens the fit by two standard errors.
    [[nodiscard]] double reach(Unknown which, double way, double spread) {
        const auto fits = [&](double step) {
            Parameters p = best_filled_;
            at(p, which) += way * step;
            const auto theta = predicted(p, question_.t.size());
            return theta && (record_.theta - *theta).squaredNorm() <= best_->sum + 4 * spread * spread;
        };
        const double whole = best_->scale.whole[place_of(which)];
        constexpr double small = 1.0 / 64, wide = 8;
        double step = small * whole;
        while (step < wide * whole && !stopped_ && fits(step)) step *= 2;
        if (step >= wide * whole) return way * INFINITY;
        constexpr int halvings = 5;
        double least = step > small * whole ? step / 2 : 0;
        for (int i = 0; i < halvings && !stopped_; ++i) {
            const double middle = (least + step) / 2;
            (fits(middle) ? least : step) = middle;
        }
        return at(best_filled_, which) + way * least;
    }

    /// The range of Re of a free decay: Re holds the mass where it rests, but not at the previous turn.
    std::pair<double, double> breakaways() const {
        const double k = best_filled_.k, Rd = best_filled_.Rd;
        const auto decay = decay_of(best_filled_);
        if (!decay) return {Rd, INFINITY};
        const double half = std::numbers::pi / (omega0_of(best_filled_) * std::sqrt(1 - decay->zeta * decay->zeta));
        const double last = std::floor((record_.span - decay->first.t) / half);  // index of the last turn in the record
        const double rest = best_->rest ? *best_->rest - turns_before(best_filled_) : decay->extremes - 1;
        if (rest > last) return {Rd, last < 0 ? INFINITY : k * std::fabs(decay->size_at(last))};
        const double before = rest < 1 ? INFINITY : k * decay->size_at(rest - 1);
        return {std::max(Rd, k * std::fabs(decay->size_at(rest))), before};
    }

    /// Returns whether neighbours in the residual are more alike than in white noise. In white noise the mean square of
    /// differences is twice the mean square, with a standard deviation of 2/sqrt(n).
    bool leaves_pattern(double deviations) const {
        const Eigen::VectorXd& left = best_->residual;
        const Eigen::Index n = left.size() - 1;
        const double ratio = (left.tail(n) - left.head(n)).squaredNorm() / left.squaredNorm();
        return ratio < 2 - deviations * 2 / std::sqrt(static_cast<double>(n));
    }

    /// Returns whether the residual is noise with a memory of one step.
    bool has_only_memory(const Eigen::MatrixXd& J) const {
        const NoiseMemory memory(best_->residual, columns_, J, 1);
        const Eigen::MatrixXd white = memory.whitened(best_->residual);
        constexpr double very_unusual = 4;
        return is_white({white.data(), question_.t.size()}, very_unusual);
    }

    /// Judges whether the fit explains the record. The search also finds a motion in pure noise, which explains some
    /// ten times its variance.
    void judge(const Eigen::MatrixXd& J, Identified& found) const {
        const double all = (record_.theta.array() - record_.theta.mean()).square().sum(), left = best_->sum;
        constexpr double by_search = 2;
        const double some = question_.M ? 20 : 12;  // measured: about one of a hundred records of noise explains more
        const double by_chance = by_search * std::log(static_cast<double>(record_.theta.size())) + some;
        found.is_noise = all - left < by_chance * found.noise * found.noise;
        found.scatter = std::max(record_.noise, smallest_step(question_.theta));
        constexpr double much = 5, part = 0.01;
        constexpr double more = 1.25, little = 1e-4, sure = 5;
        found.is_unexplained =
            (found.noise > much * found.scatter && left > part * all) ||
            (found.noise > more * found.scatter && left > little * all && leaves_pattern(sure) && !has_only_memory(J));
        if (question_.M && !question_.M->has_feedback()) {
            std::vector<double> M;
            for (const double t : question_.t) M.push_back(question_.M->value(t));
            found.M_is_noisy = is_noisy(M);
        }
        Eigen::Index which = 0;
        const double most = best_->residual.cwiseAbs().maxCoeff(&which);
        const double others = left - most * most, usual = much * found.scatter;
        if (!(most * most > others)) return;
        found.wild = static_cast<std::size_t>(which);
        const bool explains_others = others < usual * usual * static_cast<double>(record_.theta.size());
        if (found.is_unexplained && !explains_others) found.has_errors = false;
    }

    /// Computes omega0, zeta and Rd/k, with errors that include the correlations of their parts.
    void ratios(const Eigen::MatrixXd& covariance, double spread, Identified& found) const {
        const double I = found.value.I, k = found.value.k;
        const double Rd = found.value.Rd;
        const double omega0 = omega0_of(found.value), zeta = zeta_of(found.value);
        using Value = double (*)(const Parameters&);
        const auto error = [&](Unknown told, Value value, double by_I, double by_k, double by_C, double by_Rd) {
            if (!question_.M && at(found.silent, told)) return 0.0;
            Eigen::VectorXd by = Eigen::VectorXd::Zero(unknown_count);
            by.head(4) << by_I, by_k, by_C, by_Rd;
            return std::max(least_error(value), spread * std::sqrt(std::max(0.0, by.dot(covariance * by))));
        };
        const auto set = [](IdentifiedRatio& ratio, double value, double its_error) {
            ratio.value = value, ratio.error = its_error;
        };
        set(found.omega0, omega0, error(Unknown::k, omega0_of, -omega0 / (2 * I), omega0 / (2 * k), 0, 0));
        set(found.zeta, zeta,
            error(Unknown::C, zeta_of, -zeta / (2 * I), -zeta / (2 * k), 1 / (2 * std::sqrt(I * k)), 0));
        set(found.Rd_over_k, dry_of(found.value), error(Unknown::Rd, dry_of, 0, -Rd / (k * k), 0, 1 / k));
    }

    const IdentifyQuestion& question_;
    const motion::Monitor& monitor_;
    MeasuredAngles record_;
    FitStarts starts_;
    std::vector<int> columns_;  // the measured column of each sample: there is one
    std::vector<Unknown> unknowns_;
    bool seeks_Re_ = false;
    Parameters base_{};
    double breakaway_ = 0;                 // Re/k of a free decay; 0: it equals Rd/k
    std::optional<double> rests_at_ = {};  // prescribed turn of rest of a free decay
    bool starts_at_turn_ = false;          // whether turn 0 may lie before the start, see turns_before()
    std::vector<Rest> rests_ = {};         // best fit for each turn of rest
    std::optional<Best> best_;
    std::optional<LeastSquares> freest_;  // best fit before undetermined parameters were set to 0
    OfEach<bool> has_no_effect_;
    // for a driven motion: sampled sums of squares and their parameters
    std::vector<std::pair<double, Parameters>> seen_;
    Parameters best_filled_{};
    std::optional<Eigen::VectorXd> moving_;  // fit of the moving part of a free decay
    std::size_t left_out_ = 0;  // number of last turns left out, which noise or the end of the motion may have caused
    int agreed_ = 0;  // number of other fits that ended at the best one, which suggests that no better one exists
    bool stopped_ = false;
};

}  // namespace

text::Expected<Identified> identify(const IdentifyQuestion& question, const motion::Monitor& monitor) {
    const std::size_t n = question.t.size();
    const auto unknowns = static_cast<std::size_t>(
        std::ranges::count_if(all_unknowns, [&](Unknown which) { return is_sought(question, which); }));
    const std::size_t least = std::max<std::size_t>(8, unknowns + 1);
    if (n < least || question.theta.size() != n) {
        return text::error("the record has {} samples; for {} unknowns at least {} are needed", n, unknowns, least);
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (!std::isfinite(question.t[i]) || !std::isfinite(question.theta[i])) {
            return text::error("sample {} of the record is not a finite number", i + 1);
        }
        if (i > 0 && !(question.t[i] > question.t[i - 1])) {
            return text::error(
                "the times of the record must increase, but sample {} at t = {:.6g} is not "
                "after sample {} at t = {:.6g}",
                i + 1, question.t[i], i, question.t[i - 1]);
        }
    }
    const auto [low, high] = std::ranges::minmax_element(question.theta);
    if (*low == *high) {
        return text::error("nothing moves in the record: all samples are {:.6g}", *low);
    }
    return Identification(question, monitor).identified();
}

}  // namespace dinal::analysis
