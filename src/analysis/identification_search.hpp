// The search of identify(): a record, its unknowns, and fits from several starts of which the best one is kept.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "analysis/identification.hpp"
#include "analysis/least_squares.hpp"
#include "analysis/turning_points.hpp"
#include "motion/integrators.hpp"

namespace dinal::analysis {

using Parameters = std::array<double, unknown_count>;

inline double& at(Parameters& p, Unknown which) {
    return p[static_cast<std::size_t>(which)];
}
inline double at(const Parameters& p, Unknown which) {
    return p[static_cast<std::size_t>(which)];
}

inline constexpr std::array<Unknown, unknown_count> all_unknowns{
    Unknown::I, Unknown::k, Unknown::C, Unknown::Rd, Unknown::Re, Unknown::theta0, Unknown::velocity0, Unknown::offset};

/// It is not given, and the record may tell it: in a free decay I sets the unit of torque, and Re shows nowhere but
/// where the mass rests.
bool is_sought(const IdentifyQuestion& question, Unknown which);

/// By so much of the sum of squares two fits may differ that are one.
inline constexpr double same_fit = 1e-6;
inline bool is_same(const LeastSquares& a, const LeastSquares& b) {
    return std::fabs(a.sum - b.sum) <= same_fit * a.sum;
}

/// In standard deviations of noise: what is left after a fit that is so much more alike from sample to sample is looked
/// at again.
inline constexpr double suspected = 3;

/// What is held so stays where it is.
inline constexpr double firmly = 1e8;

/// A fit of a free decay that rests at a turn; without one, where its own friction stops it.
struct Rest {
    LeastSquares fit;
    double breakaway = 0;  // Re/k; 0: Rd/k
    std::optional<double> turn = {};
    Covariance covariance = {};
};

class Identification {
public:
    Identification(const IdentifyQuestion& question, const motion::Monitor& monitor)
        : question_(question), monitor_(monitor), measured_(question.theta.size()) {
        std::copy(question.theta.begin(), question.theta.end(), measured_.data());
        const auto [low, high] = std::minmax_element(question.theta.begin(), question.theta.end());
        range_ = *high - *low;
        span_ = question.t.back() - question.t.front();
        cut_ = cut_off(question.theta);
        noise_ = noise_of(question.theta);
        turns_ = turning_points(question.theta, std::clamp(6 * noise_, 0.04 * range_, 0.4 * range_));
        choose_unknowns();
    }

    text::Expected<Identified> identified();

private:
    [[nodiscard]] bool is_given(Unknown which) const {
        return question_.given[static_cast<std::size_t>(which)].has_value();
    }
    [[nodiscard]] double given(Unknown which, double otherwise) const {
        return question_.given[static_cast<std::size_t>(which)].value_or(otherwise);
    }

    void choose_unknowns();

    [[nodiscard]] Parameters filled(const Eigen::VectorXd& p) const {
        Parameters all = base_;
        for (std::size_t i = 0; i < unknowns_.size(); ++i) at(all, unknowns_[i]) = p[static_cast<Eigen::Index>(i)];
        if (seeks_Re_) at(all, Unknown::Re) += at(all, Unknown::Rd);
        return all;
    }
    /// What is fitted of these parameters. Of Re that is what it exceeds Rd by: below Rd nothing would depend on it.
    [[nodiscard]] Eigen::VectorXd fitted_of(const Parameters& all) const {
        Eigen::VectorXd p(count());
        for (std::size_t i = 0; i < unknowns_.size(); ++i) p[static_cast<Eigen::Index>(i)] = at(all, unknowns_[i]);
        if (seeks_Re_) p[place_of(Unknown::Re)] = std::max(0.0, at(all, Unknown::Re) - at(all, Unknown::Rd));
        return p;
    }
    [[nodiscard]] Eigen::Index place_of(Unknown which) const {
        return std::find(unknowns_.begin(), unknowns_.end(), which) - unknowns_.begin();
    }

    /// Each swing has samples, and the first velocity is one that the samples show: beyond that, where a search may fly
    /// to, runs have no end and fits no meaning.
    [[nodiscard]] bool is_seen(const Parameters& p) const;
    [[nodiscard]] double highest_omega0() const {
        constexpr double a_sample = 2 * std::numbers::pi;
        return a_sample * static_cast<double>(question_.t.size() - 1) / span_;
    }
    /// What the instrument shows of the motion with these parameters.
    [[nodiscard]] std::optional<Eigen::VectorXd> predicted(const Parameters& p, std::size_t rows);
    [[nodiscard]] std::optional<Eigen::VectorXd> moved(const Parameters& p, std::size_t rows);

    [[nodiscard]] std::optional<model::Oscillator> system_of(const Parameters& p) const;
    [[nodiscard]] FitScale scale_of(const Parameters& start) const;

    /// First the beginning of the record, so that no swing is taken for the next one, then all of it.
    void try_from(const Parameters& start);
    void try_let_go(const std::vector<Parameters>& starts);
    void keep_if_better(const std::optional<LeastSquares>& all, const FitScale& scale);
    /// How many samples are fitted one after another; the last of a free decay end at its last turn, for behind it the
    /// motion may end.
    [[nodiscard]] std::vector<std::size_t> stages(double period) const;
    [[nodiscard]] std::optional<LeastSquares> fit(const Eigen::VectorXd& p, std::size_t rows, const FitScale& scale,
                                                  int steps);
    [[nodiscard]] double deviation() const {
        const auto told = measured_.size() - static_cast<Eigen::Index>(cut_.at_low + cut_.at_high) - count();
        return std::sqrt(best_->sum / static_cast<double>(std::max<Eigen::Index>(1, told)));
    }
    /// As good as the noise, which is known to a few parts of its root from a record of this length.
    [[nodiscard]] bool is_settled() const { return deviation() <= std::max(1.06 * noise_, 1e-9 * range_); }
    [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(unknowns_.size()); }

    // ---- where to start, in identification_starts.cpp

    [[nodiscard]] Parameters common_start(double omega0, double zeta, double dry, double zero) const;
    [[nodiscard]] Parameters start_of(double q, double dry, double omega1) const;
    [[nodiscard]] std::vector<Parameters> free_starts() const;
    [[nodiscard]] std::vector<Parameters> forced_starts() const;
    [[nodiscard]] Parameters weak_form() const;
    void add_window(std::size_t first, std::size_t last, double sign, std::vector<std::array<double, 6>>& rows) const;

    // ---- at which turn a free decay comes to rest, in identification_rest.cpp

    [[nodiscard]] bool ends_at_rest() const;
    void try_rests();
    void number_turns(const Parameters& p);
    [[nodiscard]] double turns_before(const Parameters& p) const;
    double try_rest_at(double turn, bool goes_on = false);
    [[nodiscard]] std::vector<Parameters> shares_of_loss();
    [[nodiscard]] std::optional<double> holding(const Parameters& p, double turn) const;
    [[nodiscard]] Parameters filled_best() {
        base_ = best_base_;
        return filled(best_->parameters);
    }

    // ---- what no slope leads to in a driven motion, there, too, and in identification_starts.cpp

    void try_jumps();
    [[nodiscard]] bool try_other_beginnings();
    [[nodiscard]] bool try_other_breakaways();
    [[nodiscard]] bool try_beyond_steps();
    void try_other_valleys();
    void try_none(Unknown which, double little);
    void see_short_beginnings();
    void tell_stops_from_cuts();
    [[nodiscard]] double least_error(const std::function<double(const Parameters&)>& value) const;

    // ---- how sure it is

    [[nodiscard]] std::optional<double> resting_turn(const Parameters& p, double noise) const;
    [[nodiscard]] Covariance covariance_at(const Rest& rest, double noise);
    /// Takes the likeliest of the ways in which the record may have come to rest; in units of noise squared, with what
    /// is not sure because the others are possible, too.
    [[nodiscard]] Covariance weigh_rests();
    [[nodiscard]] Identified result();
    [[nodiscard]] bool leaves_pattern(double deviations) const;
    void judge(Identified& found) const;
    /// omega0, zeta and Rd/k, with the errors that their parts have together.
    void ratios(const Eigen::MatrixXd& covariance, Identified& found) const;

    const IdentifyQuestion& question_;
    const motion::Monitor& monitor_;
    Eigen::VectorXd measured_;
    CutOff cut_;
    double range_ = 0, span_ = 0, noise_ = 0;
    std::vector<std::size_t> turns_;
    std::vector<Unknown> unknowns_;
    bool seeks_Re_ = false;
    Parameters base_{}, best_base_{};
    double breakaway_ = 0, best_breakaway_ = 0;  // Re/k of a free decay; 0: Rd/k
    std::optional<double> rests_at_ = {};        // the turn at which a free decay is made to rest
    bool starts_at_turn_ = false;                // how turns are numbered
    std::vector<Rest> rests_ = {};               // the best fit of each such turn
    std::optional<double> best_rest_ = {};
    std::optional<LeastSquares> best_;
    std::optional<LeastSquares> freest_;  // before the best one was made to do without what tells nothing
    std::array<bool, unknown_count> tells_nothing_{};
    std::vector<std::pair<double, Parameters>> seen_;  // of a driven motion: sums of squares, and what has them
    Parameters best_filled_{};
    std::optional<Eigen::VectorXd> moving_;  // what the moving part of a free decay says by itself
    FitScale best_scale_;
    std::size_t left_out_ = 0;  // of the last turns of a free decay: noise, or the motion's end, may have made them
    int runs_ = 0;
    int agreed_ = 0;  // other fits that came to the best one: what is given may leave nothing nearer to the record
    bool stopped_ = false;
};

}  // namespace dinal::analysis
