// The spectral integrator at work: panel after panel, each solved to rounding (panel_solver.hpp), up to the first event
// in it, where the friction law is asked (standstill.hpp).
#pragma once

#include <optional>
#include <vector>

#include "motion/rows.hpp"
#include "motion/spectral/corner_watch.hpp"
#include "motion/spectral/panel_solver.hpp"
#include "motion/spectral/spectral.hpp"
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
        trajectory.t_stop = now_.clock.hi;
        trajectory.state_at_stop = now_.y;
        trajectory.motion_at_stop = standstill_.motion();
        trajectory.began_stuck = standstill_.began_stuck();
        trajectory.gap = gap_;
        const bool lost = outcome_ == model::Outcome::unresolved || outcome_ == model::Outcome::chattering;
        trajectory.noise = lost ? 0 : solver_.noise();
        trajectory.jumps = solver_.jumps();
    }

private:
    static constexpr std::size_t points = chebyshev::points;
    static constexpr double nowhere = 2;  // an x beyond every panel
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

    // spectral_corners.cpp: laws of friction that name their corners.
    [[nodiscard]] std::optional<CornerWatch::Corner> first_corner(double until) const;
    bool cross(const CornerWatch::Corner& corner);

    [[nodiscard]] Standstill::Moment moment() const { return {now_.clock.hi, now_.y.theta, now_.M}; }
    /// What the mass does that has come to velocity zero.
    bool ask() {
        if (const double theta = standstill_.arrived_at(moment()); theta != now_.y.theta)
            now_.y.theta = theta, now_.theta_rest = 0;
        return standstill_.ask(moment());
    }
    /// After a word with the standstill, which may have seen enough.
    bool go_on(bool sane) { return sane || fail(model::Outcome::chattering); }
    /// Which friction acts on a panel from here: without any, the same both ways.
    [[nodiscard]] model::Motion sliding() const {
        return standstill_.passes() ? model::Motion::forward : standstill_.motion();
    }

    // The present at the end of a piece, which reaches to x in the panel; 1 is exactly the end of the panel.
    void end_piece(double x, model::State state, double M);
    bool rows_until(double length);
    void keep(double length);
    [[nodiscard]] double M_at(double x, const model::State& state) const;
    [[nodiscard]] double M_at_end() const;
    void put_row(double M) { rows_.put(now_.y, M, model::friction_torque(system_, standstill_.motion(), M, now_.y)); }
    bool fail(model::Outcome outcome) {
        outcome_ = outcome;
        return false;
    }
    /// After an attempt that did not resolve its panel: whether there may be another.
    bool again(PanelSolver::Attempt attempt) {
        return attempt != PanelSolver::Attempt::ended || fail(solver_.outcome());
    }

    // spectral_stuck.cpp: the mass at rest.
    bool stay();
    [[nodiscard]] std::pair<double, model::Motion> first_release(double from) const;
    [[nodiscard]] double release_towards(model::Motion side, double from) const;
    [[nodiscard]] double greatest_sample(model::Motion side, double from) const;
    [[nodiscard]] bool lets_go(double x, model::Motion side) const;
    [[nodiscard]] double moment_of_release(double x, double off, double from, model::Motion side) const;
    bool release_at(double x, model::Motion direction);

    model::Lowered system_;
    const model::Excitation& excitation_;
    const Monitor& monitor_;
    Window window_;
    RowWriter& rows_;
    Panels* panels_;
    double T0_;

    Present now_;
    Standstill standstill_;
    PanelSolver solver_;
    CornerWatch corners_;
    double standing_from_ = nowhere;  // from here on the panel's M serves a mass that came to a stop in it
    unsigned pieces_ = 0;
    double gap_ = 0;  // the longest between two looks at a function of the user
    model::Outcome outcome_ = model::Outcome::reached_end;
};

}  // namespace dinal::motion::spectral
