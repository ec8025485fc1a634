// Where the mass stands: at which turn a free decay comes to rest, and what stops make of a driven fit.
//
// Whether one more swing comes about depends on the parameters, and each number of swings is a valley of its own, whose
// walls the many samples at rest make steep. When the number is prescribed the place of rest is a smooth function of
// the parameters: so each number near the best one is fitted by itself, and counts when some Re >= Rd lets the mass
// move at the turn before and holds it at this one. What the sum of squares says for a way to come to rest is not all:
// one that is possible in a tiny part of the space of parameters only was a tiny part as likely before, so each counts
// by exp(-sum / 2 noise^2) times the volume that its errors leave open.
#include <optional>

#include "algebra/decompositions.hpp"
#include "analysis/identification_search.hpp"
#include "theory/theory_free.hpp"

namespace dinal::analysis {
namespace {

/// The decay as the half-cycle map has it; none where nothing swings.
struct Decay {
    theory::Extreme first;
    double extremes = 0;  // infinity when it swings for ever
    double zeta = 0, shift = 0;

    /// How far out the turn is, at which the mass may be made to rest; below 0 on the other side.
    [[nodiscard]] double size_at(double turn) const {
        const double theta = theory::HalfCycles(zeta, shift).after(turn, first.theta);
        const bool below = (first.theta < 0) != (std::fmod(turn, 2) != 0);
        return below ? -theta : theta;
    }
};

std::optional<Decay> decay_of(const Parameters& p) {
    const auto system = model::Oscillator::make({.inertia = at(p, Unknown::I),
                                                 .stiffness = at(p, Unknown::k),
                                                 .damping = at(p, Unknown::C),
                                                 .kinetic_friction = at(p, Unknown::Rd)});
    constexpr double swings = 0.99;
    if (!system || system->damping_ratio() > swings) return {};
    const theory::FreeMotion motion(*system, {at(p, Unknown::theta0), at(p, Unknown::velocity0)});
    return Decay{motion.extreme(0), motion.extremes(), system->damping_ratio(), at(p, Unknown::Rd) / at(p, Unknown::k)};
}

}  // namespace

/// Fits with the mass at rest at this turn, or moving on where it is infinite; also from the best fit when it goes on.
/// Where no friction could do that, the fit goes on from there without that.
double Identification::try_rest_at(double turn, bool goes_on) {
    rests_at_ = turn;
    auto found = fit(moving_.value_or(best_->parameters), question_.t.size(), best_scale_, 30);
    if (goes_on) {
        const auto other = fit(best_->parameters, question_.t.size(), best_scale_, 30);
        if (other && (!found || other->sum < found->sum)) found = other;
    }
    constexpr double few = 4, much = 0.02;  // with less noise the moving part leads to the right one
    const bool is_open = turn <= few && noise_ > much * range_;
    for (const Parameters& start : is_open ? shares_of_loss() : std::vector<Parameters>()) {
        const auto other = fit(fitted_of(start), question_.t.size(), best_scale_, 30);
        if (other && (!found || other->sum < found->sum)) found = other;
    }
    rests_at_.reset();
    if (!found) return std::numeric_limits<double>::infinity();
    const double sum = found->sum;
    const std::optional<double> breakaway = holding(filled(found->parameters), turn);
    breakaway_ = breakaway.value_or(0);
    if (!breakaway) found = fit(found->parameters, question_.t.size(), best_scale_, 15);
    if (!found) return std::numeric_limits<double>::infinity();
    const Rest rest{*found, breakaway_, breakaway ? std::optional(turn) : std::nullopt, {}};
    if (found->sum < best_->sum || is_same(*found, *best_)) {
        keep_if_better(found, best_scale_);
        best_rest_ = rest.turn;
    }
    breakaway_ = best_breakaway_;
    const auto is_it = [&](const Rest& other) { return is_same(other.fit, *found); };
    if (std::none_of(rests_.begin(), rests_.end(), is_it)) rests_.push_back(rest);
    return breakaway ? sum : std::numeric_limits<double>::infinity();
}

/// Systems whose first half swing loses as much as that of the best fit, more or less of it by dry friction. A record
/// of a few swings that rests a turn sooner or later may be one of these, to which no slope leads from the best fit.
std::vector<Parameters> Identification::shares_of_loss() {
    const Parameters best = filled_best();
    const auto decay = decay_of(best);
    if (!decay) return {};
    const double whole = std::fabs(decay->first.theta), least = 0.05 * whole, most = 0.95 * whole;
    const double lost = std::clamp(whole - decay->size_at(1), least, most);
    const double omega0 = std::sqrt(at(best, Unknown::k) / at(best, Unknown::I));
    std::vector<Parameters> starts;
    for (const double dry : {0.2, 0.5, 0.8}) {
        const double q = 1 - (1 - dry) * lost / whole, ratio = -std::log(q) / std::numbers::pi;
        starts.push_back(
            common_start(omega0, ratio / std::hypot(1, ratio), dry * lost / (1 + q), at(best, Unknown::offset)));
    }
    return starts;
}

/// The Re/k that lets a free decay rest at this turn and not before; 0 when Rd does, none when nothing can.
std::optional<double> Identification::holding(const Parameters& p, double turn) const {
    const auto decay = std::isfinite(turn) ? decay_of(p) : std::nullopt;
    turn -= turns_before(p);
    if (!decay || turn < 0) return {};
    const double here = std::fabs(decay->size_at(turn)), least = std::max(decay->shift, here);
    const double most = turn > 0 ? decay->size_at(turn - 1) : 3 * least;
    if (!(least < most)) return {};
    if (is_given(Unknown::Re)) {
        const double holds = std::max(at(p, Unknown::Re) / at(p, Unknown::k), decay->shift);
        return holds >= here && holds < most ? std::optional(0.0) : std::nullopt;
    }
    return here <= decay->shift ? 0 : (least + most) / 2;
}

/// Where the start is near a turn, that one has number 0, whether it is still to come or has just been: so no number
/// changes where the velocity of a mass that was let go is found to be a little more or a little less than none.
double Identification::turns_before(const Parameters& p) const {
    return starts_at_turn_ && at(p, Unknown::theta0) * at(p, Unknown::velocity0) < 0 ? 1 : 0;
}

void Identification::number_turns(const Parameters& p) {
    const double swift = at(p, Unknown::velocity0) * std::sqrt(at(p, Unknown::I) / at(p, Unknown::k));
    starts_at_turn_ = std::fabs(swift) < std::fabs(at(p, Unknown::theta0));
}

void Identification::try_rests() {
    if (!ends_at_rest()) return;
    number_turns(filled_best());
    try_rest_at(std::numeric_limits<double>::infinity());
    const auto decay = decay_of(filled_best());
    if (!decay) return;
    // The last turn that stands out of the noise is the first where it may rest.
    const double seen = std::max(0.0, static_cast<double>(turns_.size()) - 2);
    const double middle = std::isfinite(decay->extremes) ? decay->extremes - 1 + turns_before(filled_best()) : seen;
    // As far to both sides as the record leaves it open, and some turns more.
    constexpr double open = 12;
    constexpr int most_tries = 25;
    try_rest_at(middle, true);
    for (const double way : {1.0, -1.0}) {
        int beyond = 0;
        for (int tries = 1; tries <= most_tries && !stopped_; ++tries) {
            const double turn = middle + way * tries;
            if (turn < 0) break;
            const double sum = try_rest_at(turn);
            beyond = sum > best_->sum + open * deviation() * deviation() ? beyond + 1 : 0;
            if (beyond > 1 && (way > 0 || turn < seen)) break;
        }
    }
}

// ---- how likely each of them is

/// The turn at which these parameters come to rest, or behind which nothing of the motion can be seen.
std::optional<double> Identification::resting_turn(const Parameters& p, double noise) const {
    const auto system = question_.M ? std::nullopt : system_of(p);
    if (!system || !theory::Modes(system->damping_ratio()).swings()) return {};
    const theory::FreeMotion motion(*system, {at(p, Unknown::theta0), at(p, Unknown::velocity0)});
    constexpr double unseen = 0.01;
    const double shift = system->kinetic_friction() / system->stiffness();
    const double last = theory::HalfCycles(system->damping_ratio(), shift)
                            .until_within(std::max(shift, unseen * noise), motion.extreme(0).theta);
    return std::min(motion.extremes() - 1, last) + turns_before(p);
}

/// Where a small change would add or take away a swing slopes by differences say nothing: the turn of rest is kept.
Covariance Identification::covariance_at(const Rest& rest, double noise) {
    breakaway_ = rest.breakaway;
    const Parameters p = filled(rest.fit.parameters);
    rests_at_ = rest.turn ? rest.turn : resting_turn(p, noise);
    const FitScale scale = scale_of(p);
    const auto J = derivative([this](const Eigen::VectorXd& q) { return predicted(filled(q), question_.t.size()); },
                              rest.fit.parameters, scale, noise);
    rests_at_.reset();
    return covariance_of(J.value_or(Eigen::MatrixXd::Zero(measured_.size(), count())), scale.whole, noise);
}

Covariance Identification::weigh_rests() {
    base_ = best_base_;
    const double noise = deviation(), least = best_->sum;
    Rest best{freest_.value_or(*best_), best_breakaway_, best_rest_, {}};
    best.covariance = covariance_at(best, noise);
    if (freest_ && noise > 0) {
        const Eigen::VectorXd apart = (freest_->parameters - best_->parameters) / noise;
        best.covariance.matrix += apart * apart.transpose();
        const Covariance held = covariance_at({*best_, best_breakaway_, best_rest_, {}}, noise);
        best.covariance.matrix.diagonal() = best.covariance.matrix.diagonal().cwiseMax(held.matrix.diagonal());
    }
    if (rests_.empty() || !(noise > 0)) return best.covariance;
    constexpr double unlikely = 40;
    std::vector<Rest> ways{best};
    for (Rest& rest : rests_) {
        if (rest.fit.sum > least + unlikely * noise * noise || is_same(rest.fit, *best_)) continue;
        rest.covariance = covariance_at(rest, noise);
        ways.push_back(rest);
    }
    const auto evidence = [&](const Rest& rest) {
        return (least - rest.fit.sum) / (2 * noise * noise) + rest.covariance.log_volume;
    };
    for (const Rest& rest : ways) best = evidence(rest) > evidence(best) ? rest : best;
    best_ = best.fit;
    best_breakaway_ = best.breakaway;
    Covariance all{Eigen::MatrixXd::Zero(count(), count()), best.covariance.silent, 0};
    double odds = 0;
    for (const Rest& rest : ways) {
        const double share = std::exp(evidence(rest) - evidence(best));
        const Eigen::VectorXd apart = (rest.fit.parameters - best.fit.parameters) / noise;
        all.matrix += share * (rest.covariance.matrix + apart * apart.transpose());
        odds += share;
    }
    all.matrix /= odds;
    return all;
}

// ---- what no slope leads to in a driven motion
//
// Re counts only where the mass stands, so the sum of squares has steps: at some Re a stop comes about, lasts over a
// whole swing of M, or is no more. No slope leads over a step. So the whole range of Re is looked at, and fits go on
// from wherever that is best. What the slopes there say of the errors is not all, then: each motion that was looked at
// and is about as near to the record shows how far off the parameters may be.

/// What no slope leads to, as long as it makes the fit better.
void Identification::try_jumps() {
    constexpr int rounds = 3;
    bool better = true;
    for (int round = 0; round < rounds && better && !stopped_; ++round) {
        better = try_other_beginnings();
        better = (seeks_Re_ && try_other_breakaways()) || better;
        better = (!stopped_ && try_beyond_steps()) || better;
    }
}

/// Looks at Re from Rd to four times that, or to what holds the mass anywhere in the record, and goes on from the two
/// best. True when one of them is better.
bool Identification::try_other_breakaways() {
    const Parameters best = filled_best();
    const double before = best_->sum, Rd = at(best, Unknown::Rd);
    const double whole = std::max(4 * Rd, 0.5 * at(best, Unknown::k) * range_);
    std::vector<std::pair<double, double>> sums;
    constexpr int looks = 24;
    for (int i = 0; i <= looks && !stopped_; ++i) {
        Parameters p = best;
        const double part = static_cast<double>(i) / looks;
        at(p, Unknown::Re) = Rd + whole * part * part;
        const auto theta = predicted(p, question_.t.size());
        if (!theta) continue;
        sums.emplace_back((measured_ - *theta).squaredNorm(), at(p, Unknown::Re));
        seen_.emplace_back(sums.back().first, p);
    }
    std::sort(sums.begin(), sums.end());
    constexpr std::size_t tries = 2;
    for (std::size_t i = 0; i < std::min(tries, sums.size()) && !stopped_; ++i) {
        Parameters p = best;
        at(p, Unknown::Re) = sums[i].second;
        base_ = p;
        const FitScale scale = scale_of(p);
        keep_if_better(fit(fitted_of(p), question_.t.size(), scale, 30), scale);
    }
    return best_->sum < (1 - same_fit) * before;
}

/// Small steps of the sum of squares stop a search by slopes in the midst of a valley; differences over as much as the
/// noise lead on.
bool Identification::try_beyond_steps() {
    const double noise = deviation(), before = best_->sum;
    base_ = best_base_;
    const auto J = derivative([this](const Eigen::VectorXd& q) { return predicted(filled(q), question_.t.size()); },
                              best_->parameters, best_scale_, noise);
    if (!J || count() == 0) return false;
    const auto units = best_scale_.whole.asDiagonal();
    const Eigen::VectorXd way = units * algebra::solve_least_squares(*J * units, best_->residual);
    if (!way.allFinite()) return false;
    for (const double part : {1.0, 0.5, 0.25}) {
        const Eigen::VectorXd p = (best_->parameters + part * way).cwiseMax(best_scale_.least);
        const auto theta = stopped_ ? std::nullopt : predicted(filled(p), question_.t.size());
        if (!theta || !((measured_ - *theta).squaredNorm() < before - 0.01 * noise * noise)) continue;
        keep_if_better(fit(p, question_.t.size(), best_scale_, 30), best_scale_);
        break;
    }
    return best_->sum < (1 - same_fit) * before;
}

/// A motion that never stands says nothing about Re but that a greater one would have held it, and one that stands at
/// first nothing about its velocity. Where nothing depends on what Re exceeds Rd by, or on the velocity, about 0, and 0
/// is as good as the noise can tell, no stop that another value makes is believed, nor what it does to other
/// parameters. But how sure those are is what the fit leaves open to which it was free.
void Identification::try_none(Unknown which, double little) {
    const LeastSquares best = *best_;
    base_ = best_base_;
    const Eigen::Index place = place_of(which);
    FitScale scale = best_scale_;
    scale.hold[place] = firmly * range_ / scale.typical[place];
    Eigen::VectorXd start = best.parameters;
    start[place] = 0;
    const auto without = fit(start, question_.t.size(), scale, 40);
    if (!without) return;
    seen_.emplace_back(without->sum, filled(without->parameters));
    const double variance = deviation() * deviation(), rise = without->sum - best.sum;
    constexpr double telling = 4;  // two standard errors
    if (rise > telling * variance) return;
    constexpr double same = 1e-8;
    Eigen::VectorXd more = without->parameters;
    more[place] = little * scale.typical[place];
    const auto theta = predicted(filled(more), question_.t.size());
    const bool is_flat = theta && (measured_ - *theta - without->residual).cwiseAbs().maxCoeff() <= same * range_;
    if (rise > 0 && !is_flat) return;
    if (!freest_) freest_ = best;
    best_ = without;
    best_->parameters[place] = 0;  // from which it was held but for roundings
    tells_nothing_[static_cast<std::size_t>(which)] = is_flat;
    if (is_flat && which == Unknown::velocity0 && !is_given(Unknown::theta0)) see_short_beginnings();
}

/// A record that stands at its least or greatest value may be cut off there, or show where the mass stood: then the
/// fit goes beyond it nowhere.
void Identification::tell_stops_from_cuts() {
    if (cut_.at_low + cut_.at_high == 0) return;
    const auto whole = moved(filled_best(), question_.t.size());
    if (!whole) return;
    const double beyond = 3 * deviation() + 1e-6 * range_;
    if (whole->maxCoeff() < cut_.high + beyond) cut_.at_high = 0;
    if (whole->minCoeff() > cut_.low - beyond) cut_.at_low = 0;
    if (cut_.at_low + cut_.at_high > 0) return;
    if (const auto uncut = fit(best_->parameters, question_.t.size(), best_scale_, 15)) best_ = uncut;
}

/// Were the sum of squares a parabola, a motion that is so far from the best fit, by so little worse, would show the
/// standard error.
double Identification::least_error(const std::function<double(const Parameters&)>& value) const {
    const double noise = deviation(), best = value(best_filled_);
    constexpr double possible = 16;
    double least = 0;
    for (const auto& [sum, p] : seen_) {
        const double rise = (sum - best_->sum) / (noise * noise);
        if (rise < possible) least = std::max(least, std::fabs(value(p) - best) / std::sqrt(std::max(1.0, rise)));
    }
    return least;
}

}  // namespace dinal::analysis
