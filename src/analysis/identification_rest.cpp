// At which turn a free decay comes to rest.
//
// Whether one more swing comes about depends on the parameters, and each number of swings is a valley of its own, whose
// walls the many samples at rest make steep. When the number is prescribed the place of rest is a smooth function of
// the parameters: so each number near the best one is fitted by itself, and counts when some Re >= Rd lets the mass
// move at the turn before and holds it at this one.
#include <optional>

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

/// Fits with the mass at rest at this turn, or moving on where it is infinite. Where no friction could do that, the fit
/// goes on from there without that.
double Identification::try_rest_at(double turn) {
    rests_at_ = turn;
    auto found = fit(moving_.value_or(best_->parameters), question_.t.size(), best_scale_, 30);
    rests_at_.reset();
    if (!found) return std::numeric_limits<double>::infinity();
    const double sum = found->sum;
    const std::optional<double> breakaway = holding(filled(found->parameters), turn);
    breakaway_ = breakaway.value_or(0);
    if (!breakaway) found = fit(found->parameters, question_.t.size(), best_scale_, 15);
    keep_if_better(found, best_scale_);
    breakaway_ = best_breakaway_;
    const auto is_it = [&](const LeastSquares& rest) {
        return std::fabs(rest.sum - found->sum) <= same_fit * rest.sum;
    };
    if (found && std::none_of(rests_.begin(), rests_.end(), is_it)) rests_.push_back(*found);
    return breakaway ? sum : std::numeric_limits<double>::infinity();
}

/// The Re/k that lets a free decay rest at this turn and not before; 0 when Rd does, none when nothing can.
std::optional<double> Identification::holding(const Parameters& p, double turn) const {
    const auto decay = std::isfinite(turn) ? decay_of(p) : std::nullopt;
    if (!decay) return {};
    const double here = std::fabs(decay->size_at(turn)), least = std::max(decay->shift, here);
    const double most = turn > 0 ? decay->size_at(turn - 1) : 3 * least;
    if (!(least < most)) return {};
    if (is_given(Unknown::Re)) {
        const double holds = std::max(at(p, Unknown::Re) / at(p, Unknown::k), decay->shift);
        return holds >= here && holds < most ? std::optional(0.0) : std::nullopt;
    }
    return here <= decay->shift ? 0 : (least + most) / 2;
}

void Identification::try_rests() {
    if (!ends_at_rest()) return;
    try_rest_at(std::numeric_limits<double>::infinity());
    const auto decay = decay_of(filled_best());
    if (!decay) return;
    // The last turn that stands out of the noise is the first where it may rest.
    const double seen = std::max(0.0, static_cast<double>(turns_.size()) - 2);
    const double middle = std::isfinite(decay->extremes) ? decay->extremes - 1 : seen;
    // As far to both sides as the record leaves it open, and some turns more.
    constexpr double open = 12;
    constexpr int most_tries = 25;
    try_rest_at(middle);
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

void Identification::add_other_rests(Eigen::MatrixXd& covariance) const {
    const double variance = deviation() * deviation();
    if (!(variance > 0)) return;
    const auto odds_of = [&](const LeastSquares& rest) { return std::exp((best_->sum - rest.sum) / (2 * variance)); };
    double all = 1;  // the best one
    for (const LeastSquares& rest : rests_) all += rest.sum > best_->sum ? odds_of(rest) : 0;
    for (const LeastSquares& rest : rests_) {
        const Eigen::VectorXd apart = rest.parameters - best_->parameters;
        for (Eigen::Index i = 0; i < count(); ++i) {
            for (Eigen::Index j = 0; j < count(); ++j) {
                covariance(static_cast<Eigen::Index>(unknowns_[static_cast<std::size_t>(i)]),
                           static_cast<Eigen::Index>(unknowns_[static_cast<std::size_t>(j)])) +=
                    odds_of(rest) / all * apart[i] * apart[j] / variance;
            }
        }
    }
}

}  // namespace dinal::analysis
