// The spectral integrator at work: panel after panel, each solved to rounding, up to the first event in it.
//
// A panel is a stretch of time in which M is smooth and friction keeps its sign. It ends at a break of M, at the end of
// the window, where M or the motion could not be resolved any longer, or at an event, where the friction law is asked.
#pragma once

#include <optional>
#include <vector>

#include "motion/rows.hpp"
#include "motion/spectral/panel_equation.hpp"
#include "motion/spectral/panels.hpp"
#include "motion/standstill.hpp"

namespace dinal::motion::spectral {

class SpectralEngine {
public:
    /// `panels` may be null: then only the rows remain of the motion.
    SpectralEngine(const Problem& problem, const Spectral& options, RowWriter& rows, std::vector<model::Event>& events,
                   Panels* panels);

    model::Outcome run();
    /// Tells how far it came, and in which state.
    void leave(Trajectory& trajectory) const {
        trajectory.t_stop = clock_.hi;
        trajectory.state_at_stop = y_;
        trajectory.motion_at_stop = standstill_.motion();
        trajectory.began_stuck = standstill_.began_stuck();
    }

private:
    static constexpr std::size_t points = chebyshev::points;
    static constexpr double nowhere = 2;  // an x beyond every panel
    static constexpr double rounding_left_by_iteration = 100;
    using Series = chebyshev::Series<points>;

    // One piece of the motion after the other. What returns false has ended the run.
    void begin();
    bool advance();
    bool move();
    void finish();
    bool rest_until_end();
    [[nodiscard]] std::optional<double> first_standstill() const;
    [[nodiscard]] bool creeps() const;
    void settle();
    void record_turns();
    [[nodiscard]] Standstill::Moment moment() const { return {clock_.hi, y_.theta, M_}; }
    /// After a word with the standstill, which may have seen enough.
    bool go_on(bool sane) { return sane || fail(model::Outcome::chattering); }
    /// Which friction acts on a panel from here: without any, the same both ways.
    [[nodiscard]] model::Motion sliding() const {
        return standstill_.passes() ? model::Motion::forward : standstill_.motion();
    }

    // The present at the end of a piece, which reaches to x in the panel; 1 is exactly the end of the panel.
    void end_piece(double x, model::State state, double M);
    bool rows_until(double length);
    [[nodiscard]] double time_at(double x) const { return panel_.start.after(panel_.h * (1 + x)); }
    void put_row(double M) { rows_.put(y_, M, model::friction_torque(system_, standstill_.motion(), M, y_)); }
    bool fail(model::Outcome outcome) {
        outcome_ = outcome;
        return false;
    }

    // spectral_stuck.cpp: the mass at rest.
    bool stay();
    [[nodiscard]] std::pair<double, model::Motion> first_release(double from) const;
    [[nodiscard]] double release_towards(model::Motion side, double from) const;
    [[nodiscard]] bool lets_go(double x, model::Motion side) const;
    [[nodiscard]] double moment_of_release(double x, double off, double from, model::Motion side) const;
    bool release_at(double x, model::Motion direction);

    /// Of a run that gets nowhere: whose fault it is.
    [[nodiscard]] model::Outcome never_ending() const {
        return feedback_ ? model::Outcome::chattering : model::Outcome::unresolved;
    }

    // spectral_panel.cpp: choosing, sampling and solving a panel.
    enum class Attempt {
        resolved,
        shorten,  ///< the next one will be shorter
        ended,    ///< the run can not go on
    };
    void choose_panel();
    Attempt sample_standing();
    Attempt solve();
    [[nodiscard]] double next_break() const;
    [[nodiscard]] double sampled(std::size_t node, const model::State& state) const;
    bool sample_all(const model::State& state);
    bool bad_at(std::size_t node);
    Attempt before_failure();
    void solve_for(const Series& torque);
    [[nodiscard]] bool within_range() const;
    enum class Iteration { converged, diverges, failed };
    Iteration iterate();
    [[nodiscard]] bool well_conditioned() const;
    void take_M(const Series& iterated);
    /// The friction that is not in the linear part and its constant.
    [[nodiscard]] double remainder(const model::State& state) const { return system_.remainder(panel_.motion, state); }
    void estimate_slopes();
    /// The size of the torques that are at play on the panel.
    [[nodiscard]] double torques() const {
        return chebyshev::size(panel_.M) + system_.greatest_holding() + system_.stiffness() * std::fabs(y_.theta);
    }
    /// What M may differ by because times far from t = 0 are rounded.
    [[nodiscard]] double lost_in_time() const;
    [[nodiscard]] double unresolved_load() const;
    [[nodiscard]] double unresolved_motion() const;
    [[nodiscard]] double rounding_of_motion(double uncertain) const;
    bool found_break();
    Attempt pass_over();
    Attempt judge(double unresolved);
    bool crawls();
    void lengthen(double unresolved);

    model::Lowered system_;
    const model::Excitation& excitation_;
    const Monitor& monitor_;
    Window window_;
    RowWriter& rows_;
    Panels* panels_;

    double tolerance_;
    double w0_, T0_;
    double pace_;  ///< what short times are measured in: T0, or all of a run that is shorter
    double h_max_;
    bool feedback_, script_;

    Clock clock_;  // the present: time, state, M (from the right), motion
    model::State y_;
    double theta_rest_ = 0;  // what was rounded off theta, so that a thousand stops do not add up
    double M_ = 0;
    bool M_sampled_ = true;  // M_ is a value of M, not of its series
    Standstill standstill_;

    double h_;                                              // half the length of the next panel
    std::vector<double> found_breaks_;                      // of a function that did not announce them, in order
    double searched_from_ = model::never, searched_h_ = 0;  // where one was looked for last
    double bad_time_ = model::never;                        // M is known to fail here
    double chi_ = 0, kappa_ = 0;  // -dM/dvelocity and -dM/dtheta of a feedback: solved for, not iterated

    Panel panel_;  // the one at work
    double end_ = 0;
    bool to_limit_ = false;  // it ends at a break or with the window, exactly
    bool break_at_end_ = false;
    double standing_from_ = nowhere;  // from here on its M serves a mass that came to a stop in it
    chebyshev::Samples times_{}, samples_{};
    chebyshev::Series<points + 1> v_{};
    chebyshev::Series<points + 2> p_{};
    PanelEquation equation_;

    int unresolved_in_a_row_ = 0;
    int short_in_a_row_ = 0;
    int shortened_ = 0;  // panels, since then:
    double shortened_since_;
    unsigned pieces_ = 0;
    model::Outcome outcome_ = model::Outcome::reached_end;
};

}  // namespace dinal::motion::spectral
