// One panel of the spectral integrator: how long it is, what M is on it, the motion it carries, and whether both are
// resolved. It knows nothing of what came before but how long the last panels were, and nothing of events.
//
// A panel is a stretch of time in which M is smooth and friction keeps its sign. It ends at a break of M, at the end of
// the window, or where M or the motion could not be resolved any longer.
#pragma once

#include <span>
#include <vector>

#include "model/lowered.hpp"
#include "model/slide.hpp"
#include "motion/simulate.hpp"
#include "motion/spectral/break_search.hpp"
#include "motion/spectral/edge_search.hpp"
#include "motion/spectral/panel_equation.hpp"
#include "motion/spectral/panels.hpp"
#include "motion/spectral/spectral.hpp"

namespace dinal::motion::spectral {

/// Where the run stands: a panel begins there.
struct Present {
    Clock clock;
    model::State y;
    double theta_rest = 0;  ///< what was rounded off theta, so that a thousand stops do not add up
    double M = 0;           ///< from the right
    bool M_sampled = true;  ///< M is a value of M, not of its series
};

/// A panel with all that was computed on it. While the mass is stuck the motion is without meaning.
struct SolvedPanel : Panel {
    enum class End {
        inside,  ///< of a stretch that goes on
        window,  ///< exactly there
        at_break,
    };
    double end = 0;
    End ends = End::inside;
    model::SpeedRange friction{};                  ///< if straight, what friction is along it, beyond its ends, too
    chebyshev::Samples times{}, samples{};         ///< M as it was given, at the nodes
    chebyshev::Samples rests{};                    ///< what was rounded off the times
    chebyshev::Series<chebyshev::points + 1> v{};  ///< h theta'
    chebyshev::Series<chebyshev::points + 2> p{};  ///< theta - begin.theta

    [[nodiscard]] double time(double at_x) const { return start.after(h * (1 + at_x)); }
};

/// A torque on a short way, by the time since its beginning.
struct Parabola {
    double value = 0, slope = 0, bend = 0;
    [[nodiscard]] double at(double since) const { return value + since * (slope + since * bend / 2); }
};

class PanelSolver {
public:
    enum class Attempt {
        resolved,
        shorten,  ///< the next one will be shorter
        ended,    ///< the run cannot go on: outcome() says why
    };
    PanelSolver(const Problem& problem, const Spectral& options);

    /// A panel on which the mass stands.
    Attempt stand(const Present& now);
    /// A panel on which it moves under the friction of `way`. A feedback is asked at `departing` at its beginning.
    Attempt move(const Present& now, model::Motion way, const model::State& departing);
    [[nodiscard]] const SolvedPanel& panel() const { return panel_; }
    [[nodiscard]] model::Outcome outcome() const { return outcome_; }
    /// The run has come to the end of the panel.
    void passed();

    /// The size of the torques that are at play on the panel.
    [[nodiscard]] double torques() const {
        return chebyshev::size(panel_.M) + system_.greatest_holding() +
               system_.stiffness() * std::fabs(panel_.begin.theta) + own_spring_;
    }
    /// What h^2 theta'' is off by at least, as a difference of torques that may balance each other.
    [[nodiscard]] double least_rounding() const {
        return panel_.h * (panel_.h / system_.inertia()) *
               (64 * std::numeric_limits<double>::epsilon() * torques() + lost_in_time() + no_torque_ + noise_);
    }
    /// What h^2 theta'' may differ by because its torques are rounded, and the times at which M was asked.
    [[nodiscard]] double rounding() const { return rounding_of_motion(lost_in_time() + no_torque_ + noise_); }
    /// The torques on the panel depend on the motion, which was found by iteration.
    [[nodiscard]] bool iterates() const { return feedback_ || follows_; }
    /// M on the panel is a function of time alone, and its series holds for a mass at rest, too.
    [[nodiscard]] bool M_of_time() const { return !feedback_; }
    /// The friction of the next panel that moves.
    [[nodiscard]] model::Slide& slide() { return slide_; }
    [[nodiscard]] const model::Slide& slide() const { return slide_; }
    /// The longest time on the panel between two looks at a function of the user, of those between the nodes, too.
    [[nodiscard]] double gap() const;
    /// What keeps M from being smooth on any scale, torque; 0 when nothing was seen.
    [[nodiscard]] double noise() const { return noise_; }
    /// How many jumps of a feedback were passed where they are.
    [[nodiscard]] std::size_t jumps() const { return steps_.count; }

private:
    static constexpr std::size_t points = chebyshev::points;
    using Series = chebyshev::Series<points>;

    // panel_solver.cpp
    void choose(const Present& now, model::Motion way);
    void lay(const Present& now, model::Motion way, double h, double end);
    /// The next break of M that is known.
    [[nodiscard]] double break_after(double t) const;
    [[nodiscard]] double sampled(std::size_t node, const model::State& state) const;
    bool sample_all(const Present& now);
    bool bad_at(std::size_t node);
    Attempt before_failure();
    Attempt end_with(model::Outcome outcome) {
        outcome_ = outcome;
        return Attempt::ended;
    }
    void solve_for(const Series& torque);
    [[nodiscard]] bool within_range() const;
    /// What is not in the linear part, its constant and the line of friction.
    [[nodiscard]] double remainder(const model::State& state) const {
        const double friction = panel_.friction.straight ? 0 : system_.friction_remainder(panel_.motion, state);
        return friction + system_.spring(state.theta);
    }
    /// What a line of friction adds to the damping.
    [[nodiscard]] double slope_of_line() const { return panel_.friction.straight ? panel_.friction.slope : 0; }

    // panel_friction.cpp: laws that name their corners.
    void foresee_friction(const Present& now, model::Motion way);
    [[nodiscard]] bool follow_friction(const Present& now);

    // panel_feedback.cpp: torques that depend on the motion.
    enum class Iteration { converged, diverges, failed };
    Iteration iterate(const model::State& departing);
    [[nodiscard]] bool well_conditioned() const;
    void take_M(const Series& iterated);
    void estimate_slopes();

    // panel_steps.cpp: a feedback that jumps along the motion.
    void missed_step();
    void go_on_from(const Present& now, model::Motion way);
    [[nodiscard]] double line(double since) const;
    [[nodiscard]] double finest_edge(double t) const;
    [[nodiscard]] static double surely_behind(const Edge& edge, const model::State& there);
    [[nodiscard]] bool is_behind_step(double M, double since) const;
    bool predict(const model::State& departing);
    bool follow_line();
    bool follow(const Parabola& other);
    [[nodiscard]] double direction() const;
    [[nodiscard]] model::State state_at(double x) const;
    [[nodiscard]] double guessed_step() const;
    double sought_step();
    bool foresee(const Present& now, model::Motion way, const model::State& departing);
    bool cross_step(const Present& now, model::Motion way, const model::State& departing);
    void remember_step(double jump, const Edge& edge);

    // panel_stride.cpp: many of them, in one panel each.
    bool stride(const Present& now, model::Motion way, const model::State& departing);

    // panel_judge.cpp: resolved?
    /// What is none. A bump that wakes a mass at rest begins with less.
    [[nodiscard]] static double no_torque(const model::Excitation& excitation);
    /// What M may differ by because times far from t = 0 are rounded.
    [[nodiscard]] double lost_in_time() const;
    [[nodiscard]] double unresolved_load() const;
    [[nodiscard]] double unresolved_motion() const;
    [[nodiscard]] double rounding_of_motion(double uncertain) const;
    bool found_break();
    void foresee_break();
    bool find_break_among(std::span<const double> times, std::span<const double> values);
    Attempt pass_over();
    Attempt judge(double unresolved);
    Attempt accept();
    bool crawls();
    void lengthen(double unresolved);

    // panel_look.cpp: M where no node is, and on every scale.
    enum class Look { agrees, differs, failed };
    Look look_between();
    Look look_at_corners();
    Attempt looked(Look look);
    bool found_noise();
    /// Of a run that gets nowhere: whose fault it is.
    [[nodiscard]] model::Outcome never_ending() const {
        return feedback_ ? model::Outcome::chattering : model::Outcome::unresolved;
    }

    model::Lowered system_;
    model::Slide slide_;
    const model::Excitation& excitation_;
    double end_of_run_;
    double tolerance_;
    double pace_;  // what short times are measured in: T0, or all of a run that is shorter
    double no_torque_;
    double h_max_;  // half the length of the longest panel
    bool feedback_, script_, tells_rests_;
    bool follows_ = false;  // the present panel goes along a friction that bends, and nothing else is iterated
    const model::Oscillator& oscillator_;  // whose functions may fail as M may

    double h_;                          // half the length of the next panel
    std::vector<double> found_breaks_;  // of a function that did not announce them, in order
    PassedBreaks passed_breaks_;
    struct {
        double from = model::never, h = 0;
    } searched_;                      // where one was looked for last
    double bad_time_ = model::never;  // M is known to fail here
    double seen_ = model::never;      // here it was seen to do what its series does not
    double noise_ = 0;
    struct {
        double from = model::never, h = 0, tail = 0;
    } stalled_;  // of the last panel that was too long for its M
    struct {
        double theta = 0, velocity = 0;
    } falls_;  // -dM/dtheta and -dM/dvelocity of a feedback: solved for, not iterated
    struct {
        bool expected = false;                    // M has jumped, or seems to have
        int quiet = 0;                            // panels since then
        double stop = model::never, left = 0;     // where the panel ends before the next one, and how long before
        double slope = 0, bend = 0;               // of M at the beginning of the panel: its derivatives by time
        double other_slope = 0, other_bend = 0;   // of what friction and springs do, after the last of the strides
        bool predicted = false, sampled = false;  // the panel has a motion already, and M on it
        bool guessed = false;                     // the next one is where it is if they are evenly spaced
        int trust = 0;                            // in guesses; none below 0
        double part = 1;                          // of the way, by how much more than usual is left for the crossing
        double theta = 0, direction = 0, last = -model::never;  // where the last one was, which way, and when
        double apart = 0, spacing = 0, jump = 0;  // from one to the next: rad, time units; and how high, torque
        int ways = 0;                             // of which that is the mean
        bool strides = false;                     // the panel reaches from one to the next
        int walks = 0;                            // so many more panels do not try to
        std::size_t count = 0;                    // of all there were
    } steps_;
    SolvedPanel panel_;
    model::Spread spread_{.places = chebyshev::nodes};  // its times, for M
    double theta_rest_ = 0;                             // of its beginning
    double own_spring_ = 0;                             // the torque there of a spring besides k theta, without sign
    PanelEquation equation_;
    struct {
        int unresolved = 0, too_short = 0;  // panels in a row
        int shortened = 0;                  // panels, since then:
        double since = 0;
    } patience_;
    model::Outcome outcome_ = model::Outcome::reached_end;
};

}  // namespace dinal::motion::spectral
