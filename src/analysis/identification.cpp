#include "analysis/identification.hpp"

#include <fmt/format.h>

#include <iterator>

#include "analysis/free_decay.hpp"
#include "analysis/identification_search.hpp"

namespace dinal::analysis {
namespace {

double omega0_of(const Parameters& p) {
    return std::sqrt(at(p, Unknown::k) / at(p, Unknown::I));
}
double zeta_of(const Parameters& p) {
    return at(p, Unknown::C) / (2 * std::sqrt(at(p, Unknown::I) * at(p, Unknown::k)));
}
double dry_of(const Parameters& p) {
    return at(p, Unknown::Rd) / at(p, Unknown::k);
}

}  // namespace

text::Expected<Identified> Identification::identified() {
    std::vector<Parameters> starts = question_.M ? forced_starts() : free_starts();
    for (left_out_ = 0; left_out_ < (question_.M ? 1U : 3U); ++left_out_) {
        for (const Parameters& start : starts) {
            if (stopped_ || (best_ && (is_settled() || (agreed_ > 1 && !leaves_pattern(suspected))))) break;
            try_from(start);
        }
    }
    if (!best_) return text::Error{"no motion of such a system comes near this record"};
    if (!question_.M && !stopped_ && leaves_pattern(suspected)) try_let_go(starts);
    if (!question_.M && !stopped_) try_rests();
    if (question_.M) {
        starts.insert(starts.begin(), filled_best());
        try_let_go(starts);
    }
    if (question_.M && !stopped_) try_jumps();
    if (question_.M && !stopped_ && leaves_pattern(suspected)) try_other_valleys();
    if (question_.M) tell_stops_from_cuts();
    if (seeks_Re_ && !stopped_) try_none(Unknown::Re, 0.1);
    if (question_.M && is_sought(question_, Unknown::velocity0) && !stopped_) try_none(Unknown::velocity0, 1e-4);
    return result();
}

bool is_sought(const IdentifyQuestion& question, Unknown which) {
    const auto is_given = [&](Unknown one) { return question.given[static_cast<std::size_t>(one)].has_value(); };
    if (is_given(which)) return false;
    if (question.M) return true;
    return which != Unknown::Re && (which != Unknown::I || is_given(Unknown::k));
}

void Identification::choose_unknowns() {
    std::copy_if(all_unknowns.begin(), all_unknowns.end(), std::back_inserter(unknowns_),
                 [this](Unknown which) { return is_sought(question_, which); });
    seeks_Re_ = is_sought(question_, Unknown::Re);
}

std::optional<Eigen::VectorXd> Identification::predicted(const Parameters& p, std::size_t rows) {
    auto theta = moved(p, rows);
    if (theta && cut_.at_low > 0) *theta = theta->cwiseMax(cut_.low);
    if (theta && cut_.at_high > 0) *theta = theta->cwiseMin(cut_.high);
    return theta;
}

std::optional<model::Oscillator> Identification::system_of(const Parameters& p) const {
    model::OscillatorParameters parts;
    parts.inertia = at(p, Unknown::I);
    parts.stiffness = at(p, Unknown::k);
    parts.damping = at(p, Unknown::C);
    parts.kinetic_friction = at(p, Unknown::Rd);
    const bool own_breakaway = is_given(Unknown::Re) || question_.M || breakaway_ > 0;
    if (own_breakaway) {
        const double Re = question_.M || is_given(Unknown::Re) ? at(p, Unknown::Re) : breakaway_ * parts.stiffness;
        parts.breakaway = std::max(Re, parts.kinetic_friction);
    }
    const auto system = model::Oscillator::make(parts);
    return system ? std::optional(*system) : std::nullopt;
}

bool Identification::is_seen(const Parameters& p) const {
    const double highest = highest_omega0();
    constexpr double most = 10;  // ranges of the record from one sample to the next
    const bool seeks_omega0 = is_sought(question_, Unknown::I) || is_sought(question_, Unknown::k);
    return (!seeks_omega0 || at(p, Unknown::k) <= highest * highest * at(p, Unknown::I)) &&
           (is_given(Unknown::velocity0) || std::fabs(at(p, Unknown::velocity0)) <= most * range_ * highest);
}

std::optional<Eigen::VectorXd> Identification::moved(const Parameters& p, std::size_t rows) {
    ++runs_;
    const auto system = system_of(p);
    if (!system || !is_seen(p)) return {};
    const model::State initial{at(p, Unknown::theta0), at(p, Unknown::velocity0)};
    if (!question_.M) {
        stopped_ = stopped_ || (monitor_ && !monitor_(question_.t.front()));
        if (stopped_) return {};
        std::optional<double> rests_at = rests_at_;
        if (rests_at) *rests_at -= turns_before(p);
        if (rests_at && *rests_at < 0) return {};
        Eigen::VectorXd decay = free_decay(*system, initial, std::span(question_.t).first(rows), rests_at);
        decay.array() += at(p, Unknown::offset);
        return decay.allFinite() ? std::optional(std::move(decay)) : std::nullopt;
    }
    const std::vector<double> times(question_.t.begin(), question_.t.begin() + static_cast<std::ptrdiff_t>(rows));
    motion::Limits limits;
    limits.dense = false;
    const auto run =
        motion::simulate(*system, *question_.M, initial, {times.front(), times.back()}, motion::Grid::at(times),
                         motion::integrator_for(*system, *question_.M), monitor_, limits);
    if (!run || static_cast<std::size_t>(run->size()) != rows) {
        stopped_ = stopped_ || (run && (run->outcome == model::Outcome::interrupted ||
                                        run->outcome == model::Outcome::excitation_not_finite));
        return {};
    }
    return Eigen::VectorXd(run->column(motion::Column::theta).array() + at(p, Unknown::offset));
}

FitScale Identification::scale_of(const Parameters& start) const {
    FitScale scale{Eigen::VectorXd(count()), Eigen::VectorXd::Constant(count(), -1e300), Eigen::VectorXd(count()),
                   Eigen::VectorXd::Zero(count())};
    const double k = at(start, Unknown::k), omega = std::sqrt(k / at(start, Unknown::I));
    constexpr double loosely = 3;
    for (Eigen::Index i = 0; i < count(); ++i) {
        const Unknown which = unknowns_[static_cast<std::size_t>(i)];
        switch (which) {
            case Unknown::I:
                scale.typical[i] = scale.least[i] = 1e-6 * at(start, Unknown::I);
                scale.whole[i] = at(start, which);
                break;
            case Unknown::k:
                scale.typical[i] = scale.least[i] = 1e-6 * k;
                scale.whole[i] = k;
                break;
            case Unknown::C:
                scale.typical[i] = 0.01 * k / omega;
                scale.least[i] = 0;
                scale.whole[i] = std::max(2 * k / omega, at(start, which));  // critical
                break;
            case Unknown::Rd:
            case Unknown::Re:
                scale.typical[i] = 0.01 * k * range_;
                scale.least[i] = 0;
                scale.whole[i] = question_.M ? std::max(k * range_, at(start, which)) : k * range_;
                break;
            case Unknown::theta0:
            case Unknown::offset:
                scale.typical[i] = 0.1 * range_;
                scale.hold[i] = noise_ / (loosely * range_);
                scale.whole[i] = range_;
                break;
            case Unknown::velocity0:
                scale.typical[i] = 0.1 * range_ * omega;
                scale.whole[i] = std::max(range_ * omega, std::fabs(at(start, which)));
                break;
        }
    }
    return scale;
}

void Identification::try_from(const Parameters& start) {
    base_ = start;
    Eigen::VectorXd p = fitted_of(start);
    const double period = 2 * std::numbers::pi * std::sqrt(at(start, Unknown::I) / at(start, Unknown::k));
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

/// A swing cannot be taken for the next one where what came before is known already.
std::vector<std::size_t> Identification::stages(double period) const {
    std::vector<std::size_t> rows;
    const double first = question_.t.front();
    double length = 2.2 * period;
    while (first + length < question_.t.back()) {
        const auto until = std::upper_bound(question_.t.begin(), question_.t.end(), first + length);
        rows.push_back(static_cast<std::size_t>(until - question_.t.begin()));
        if (!question_.M) break;
        length *= 2;
    }
    if (!question_.M && turns_.size() > left_out_) rows.push_back(turns_[turns_.size() - 1 - left_out_] + 1);
    return rows;
}

void Identification::keep_if_better(const std::optional<LeastSquares>& all, const FitScale& scale) {
    if (all && question_.M) seen_.emplace_back(all->sum, filled(all->parameters));
    if (!all || (best_ && !(all->sum < best_->sum))) return;
    if (best_ && all->sum < (1 - same_fit) * best_->sum) agreed_ = 0;
    best_ = all;
    best_base_ = base_;
    best_rest_.reset();
    best_scale_ = scale;
    best_breakaway_ = breakaway_;
}

std::optional<LeastSquares> Identification::fit(const Eigen::VectorXd& p, std::size_t rows, const FitScale& scale,
                                                int steps) {
    const auto model = [this, rows](const Eigen::VectorXd& q) { return predicted(filled(q), rows); };
    return least_squares(model, measured_.head(static_cast<Eigen::Index>(rows)), p, scale, steps);
}

/// The last samples differ by no more than noise makes them.
bool Identification::ends_at_rest() const {
    const Eigen::Index n = measured_.size();
    const auto tail = measured_.tail(std::min(n, std::max<Eigen::Index>(8, n / 30)));
    return tail.maxCoeff() - tail.minCoeff() <= 8 * noise_ + 1e-6 * range_;
}

Identified Identification::result() {
    Identified found;
    const Covariance covariance = weigh_rests();
    breakaway_ = best_breakaway_;
    found.value = best_filled_ = filled_best();
    if (!question_.M && !is_given(Unknown::Re)) {
        at(found.value, Unknown::Re) = std::max(at(found.value, Unknown::Rd), breakaway_ * at(found.value, Unknown::k));
        found.silent[static_cast<std::size_t>(Unknown::Re)] = true;
    }
    found.noise = deviation();
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(unknown_count, unknown_count);
    for (Eigen::Index i = 0; i < count(); ++i) {
        const auto which = static_cast<std::size_t>(unknowns_[static_cast<std::size_t>(i)]);
        found.fitted[which] = true;
        found.silent[which] = covariance.silent[static_cast<std::size_t>(i)] || tells_nothing_[which];
        for (Eigen::Index j = 0; j < count(); ++j) {
            full(static_cast<Eigen::Index>(which), static_cast<Eigen::Index>(unknowns_[static_cast<std::size_t>(j)])) =
                covariance.matrix(i, j);
        }
    }
    if (seeks_Re_) {  // Rd and what Re exceeds it by
        constexpr auto Rd = static_cast<Eigen::Index>(Unknown::Rd), Re = static_cast<Eigen::Index>(Unknown::Re);
        full.row(Re) += full.row(Rd);
        full.col(Re) += full.col(Rd);
    }
    for (const Unknown which : unknowns_) {
        const auto i = static_cast<std::size_t>(which);
        const auto place = static_cast<Eigen::Index>(which);
        const double open = least_error([which](const Parameters& p) { return at(p, which); });
        found.error[i] = found.silent[i] ? 0 : std::max(open, found.noise * std::sqrt(full(place, place)));
    }
    ratios(full, found);
    judge(found);
    if (found.is_noise) {  // the errors are those of a motion, and there may be none
        found.error.fill(0);
        found.omega0_error = found.zeta_error = found.Rd_over_k_error = 0;
        for (const Unknown which : unknowns_) found.silent[static_cast<std::size_t>(which)] = true;
    }
    const Eigen::VectorXd predicted_all = measured_ - best_->residual;
    found.predicted.assign(predicted_all.begin(), predicted_all.end());
    found.runs = runs_;
    found.cut_low = cut_.at_low;
    found.cut_high = cut_.at_high;
    return found;
}

/// What noise leaves at a sample has nothing to do with what it leaves at the next one: in square the differences of
/// neighbours are then twice as large, with a standard deviation of 2/sqrt(n).
bool Identification::leaves_pattern(double deviations) const {
    const Eigen::VectorXd& left = best_->residual;
    const Eigen::Index n = left.size() - 1;
    const double ratio = (left.tail(n) - left.head(n)).squaredNorm() / left.squaredNorm();
    return ratio < 2 - deviations * 2 / std::sqrt(static_cast<double>(n));
}

/// Whether the fit explains the record. A search among noise finds a motion, too: it takes some ten squares of it.
void Identification::judge(Identified& found) const {
    const double all = (measured_.array() - measured_.mean()).square().sum(), left = best_->sum;
    constexpr double by_search = 2;
    const double some = question_.M ? 20 : 12;  // measured: one record of noise in some hundred explains more
    const double by_chance = by_search * std::log(static_cast<double>(measured_.size())) + some;
    found.is_noise = all - left < by_chance * found.noise * found.noise;
    double step = range_;  // of an instrument that shows steps; without them next to none
    for (Eigen::Index i = 1; i < measured_.size(); ++i) {
        const double apart = std::fabs(measured_[i] - measured_[i - 1]);
        if (apart > 0) step = std::min(step, apart);
    }
    found.scatter = std::max(noise_, step);
    constexpr double much = 5, part = 0.01;
    constexpr double more = 1.25, little = 1e-4, sure = 5;
    found.is_unexplained = (found.noise > much * found.scatter && left > part * all) ||
                           (found.noise > more * found.scatter && left > little * all && leaves_pattern(sure));
    if (question_.M && !question_.M->has_feedback()) {
        std::vector<double> M;
        for (const double t : question_.t) M.push_back(question_.M->value(t));
        found.M_is_noisy = is_noisy(M);
    }
    Eigen::Index which = 0;
    const double most = best_->residual.cwiseAbs().maxCoeff(&which);
    if (2 * most * most > left) found.wild = static_cast<std::size_t>(which);
}

void Identification::ratios(const Eigen::MatrixXd& covariance, Identified& found) const {
    const double I = at(found.value, Unknown::I), k = at(found.value, Unknown::k);
    const double Rd = at(found.value, Unknown::Rd);
    found.omega0 = omega0_of(found.value);
    found.zeta = zeta_of(found.value);
    found.Rd_over_k = dry_of(found.value);
    using Value = double (*)(const Parameters&);
    const auto error = [&](Unknown told, Value value, double by_I, double by_k, double by_C, double by_Rd) {
        if (!question_.M && found.silent[static_cast<std::size_t>(told)]) return 0.0;
        Eigen::VectorXd by = Eigen::VectorXd::Zero(unknown_count);
        by.head(4) << by_I, by_k, by_C, by_Rd;
        return std::max(least_error(value), found.noise * std::sqrt(std::max(0.0, by.dot(covariance * by))));
    };
    found.omega0_error = error(Unknown::k, omega0_of, -found.omega0 / (2 * I), found.omega0 / (2 * k), 0, 0);
    found.zeta_error =
        error(Unknown::C, zeta_of, -found.zeta / (2 * I), -found.zeta / (2 * k), 1 / (2 * std::sqrt(I * k)), 0);
    found.Rd_over_k_error = error(Unknown::Rd, dry_of, 0, -Rd / (k * k), 0, 1 / k);
}

text::Expected<Identified> identify(const IdentifyQuestion& question, const motion::Monitor& monitor) {
    const std::size_t n = question.t.size();
    const auto unknowns = static_cast<std::size_t>(std::count_if(
        all_unknowns.begin(), all_unknowns.end(), [&](Unknown which) { return is_sought(question, which); }));
    const std::size_t least = std::max<std::size_t>(8, unknowns + 1);
    if (n < least || question.theta.size() != n) {
        return text::Error{
            fmt::format("the record has {} samples; for {} unknowns at least {} are needed", n, unknowns, least)};
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (!std::isfinite(question.t[i]) || !std::isfinite(question.theta[i])) {
            return text::Error{fmt::format("sample {} of the record is not a finite number", i + 1)};
        }
        if (i > 0 && !(question.t[i] > question.t[i - 1])) {
            return text::Error{
                fmt::format("the times of the record must increase, but sample {} at t = {:.6g} is not "
                            "after sample {} at t = {:.6g}",
                            i + 1, question.t[i], i, question.t[i - 1])};
        }
    }
    const auto [low, high] = std::minmax_element(question.theta.begin(), question.theta.end());
    if (*low == *high) {
        return text::Error{fmt::format("nothing moves in the record: all samples are {:.6g}", *low)};
    }
    return Identification(question, monitor).identified();
}

}  // namespace dinal::analysis
