// The exact integrator: arcs in closed form (arc.hpp), each up to its first event. first_exit.hpp proves that no
// earlier event exists; contact.hpp decides at velocity zero.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "model/closed_form.hpp"
#include "motion/exact/arc.hpp"
#include "motion/exact/first_exit.hpp"
#include "motion/exact/free_motion.hpp"
#include "motion/lone_contact.hpp"
#include "motion/rows.hpp"

namespace dinal::motion::exact {

/// The motion under a torque that is linear in time, over a short time: one line of a record of samples.
/// I q'' + C q' + k q = pull + slope t with q(0) = 0: linear in the initial velocity, pull and slope. Caches the
/// factors for one length, because records are usually sampled evenly.
class LineStep {
public:
    LineStep(const model::Lowered& system, const LinearMotion& free)
        : inertia_(system.inertia()),
          damping_(system.damping()),
          stiffness_(system.stiffness()),
          per_inertia_(1 / inertia_),
          per_w0_(1 / free.w0()),
          longest_(short_of / free.fastest()) {}

    /// The initial values of the interval.
    struct Start {
        double velocity, pull, slope;
    };
    struct End {
        double way, velocity;
        double bend;  ///< bound of |the second derivative of the velocity| on the interval
    };
    /// Returns whether the factors are those of this length. Relative differences up to 1e-9, due to the rounding of
    /// times, are corrected in over().
    bool is_made_for(double length) const {
        constexpr double nearly = 1e-9;
        return std::fabs(length - length_) <= nearly * length_;
    }
    /// Returns whether an interval is short enough (some tenths of a radian), and computes its factors if necessary.
    bool takes(double length) {
        if (is_made_for(length)) return true;
        if (!(length <= longest_)) return false;
        make(length);
        return true;
    }
    /// The values at the end of an interval. Requires takes(length).
    End over(double length, const Start& start) const {
        const auto& [v, P, S] = start;
        const double more = length - length_;
        const double way = (v * way_[0] + S * way_[2]) + P * way_[1];  // this order: the pull is known last
        const double velocity = (v * velocity_[0] + S * velocity_[2]) + P * velocity_[1];
        const double torque = P + S * length_ - damping_ * velocity - stiffness_ * way;
        const double first = (P - damping_ * v) * per_inertia_;
        const double second = (S - damping_ * first - stiffness_ * v) * per_inertia_;
        const double third = (damping_ * second + stiffness_ * first) * per_inertia_;
        // The second derivative is a free motion, whose energy does not grow.
        return {way + more * velocity, velocity + more * (torque * per_inertia_),
                std::fabs(second) + std::fabs(third) * per_w0_};
    }

private:
    static constexpr double short_of = 0.3;
    void make(double length);

    double inertia_, damping_, stiffness_, per_inertia_, per_w0_, longest_;
    double length_ = 0;
    std::array<double, 3> way_{}, velocity_{};  // responses to unit velocity, pull and slope
};

class ExactEngine {
public:
    /// `arcs` may be null; then only the rows are stored.
    ExactEngine(const Problem& problem, RowWriter& rows, std::vector<model::Event>& events, Arcs* arcs);

    model::Outcome run();
    /// Stores the time and state reached.
    void leave(Run& run) const {
        run.t_stop = clock_.hi;
        run.state_at_stop = y_;
        run.motion_at_stop = contact_.motion();
        run.began_stuck = contact_.began_stuck();
    }

private:
    // The following functions return false if they ended the run.
    bool advance();
    bool comes_from_afar() const;
    bool move();
    bool rest_until_end();
    void finish();
    LoneContact::Standstill standstill() const { return {clock_.hi, y_.theta, M_}; }
    /// Lets the friction law decide about a mass at velocity zero.
    bool decide() {
        if (const double theta = contact_.place_at_stop(standstill()); theta != y_.theta)
            y_.theta = theta, theta_rest_ = 0;
        return contact_.decide(standstill());
    }
    /// Continues after a decision at velocity zero; `sane` is false after too many standstills in a row.
    bool continue_if(bool sane) { return sane || fail(model::Outcome::chattering); }
    bool asked_to_stop(double t);
    bool fail(model::Outcome outcome) {
        outcome_ = outcome;
        return false;
    }
    double pull() const { return pull_of(system_.stiffness(), y_.theta, M_, system_.braking(contact_.motion())); }
    /// M - k theta minus the braking of friction, rounded once: near the limit of sticking it is a small difference.
    [[nodiscard]] static double pull_of(double k, double theta, double M, double braking) {
        const double sum = M - braking;
        const double part = sum - M;
        const double rest = (M - (sum - part)) - (braking + part);
        return std::fma(-k, theta, sum) + rest;
    }
    WalkedCurve::End start_from_rest(double start_pull) const;
    /// Moves away from a standstill; returns false if the mass does not start.
    bool get_under_way(FirstExit& exit, double sign, double start_pull, double length);
    /// The first zero of the velocity, or the time at which a creep is detected.
    std::optional<double> stop(double start_pull, double length, bool& crept, bool& left);
    void record_turns(double start_pull, double length);
    void snap_to_equilibrium();

    // Advances the present to `tau` after the start of the arc.
    bool end_arc(double tau, model::State state, double start_pull);
    bool rows_until(double& tau, model::State& end, bool standing);
    void keep(double tau, double start_pull, bool standing);
    void update_M();
    void put_row() { rows_.put(y_, M_, model::friction_torque(system_, contact_.motion(), M_, y_)); }

    // exact_stuck.cpp: the mass at rest.
    bool stay();
    bool stay_held(double length);
    void make_load();
    bool release_at(double tau, model::Motion towards, bool crosses);

    // exact_lines.cpp: along a record of samples.
    void find_record();
    bool along_lines();
    void rest_along(double until);
    void move_along(double until);
    bool write_line_of_record(double h, double M, model::State end, double start_pull);
    bool end_line(double h, double M, model::State state, bool standing, double start_pull = 0);

    /// The cost of the arcs since the last call of the monitor, in radians of their parts; lines of a record are cheap.
    struct Cost {
        static constexpr double between_calls = 1e7, of_a_line = between_calls / 65536;
        double spent = std::numeric_limits<double>::infinity();
        bool is_due() const { return spent >= between_calls; }
    };
    /// The lengths of recent intervals, which the next ones are likely to repeat.
    struct Habits {
        std::array<Habit, 2> moves{}, rests{};  // backward and forward: intervals between standstills
        Habit swings{};                         // intervals between turns without friction
        Habit* rest = rests.data();             // habit of the present or next rest
    };
    /// Limits the growth of M on an arc, in e-folds: the bound at the end of an arc limits all its looks.
    static constexpr double growth_of_an_arc = 4;

    model::Lowered system_;
    const model::Excitation& excitation_;
    const Monitor& monitor_;
    Window window_;
    RowWriter& rows_;
    Arcs* arcs_;

    Clock clock_;
    model::State y_;
    double theta_rest_ = 0;  // rounding error of theta
    double M_ = 0;           // limit from the right
    double piece_end_;       // the next break of M, or the end of the run
    double requested_ = 0;   // requested length of the present arc
    Habits habits_;
    Creep creep_;
    double bound_ = 0;  // bound of the velocity's fourth derivative
    std::optional<double> pull_at_release_ = {};
    LoneContact contact_;
    model::ClosedForm formula_;
    struct Record {
        const model::Samples* samples = nullptr;  // the record if M is nothing else
        double gain = 0, from = 0, to = 0;
        std::size_t place = 0;  // index of the present sample
        double time(std::size_t ahead) const { return samples->t[place + ahead]; }
        double torque(std::size_t ahead) const { return gain * samples->M[place + ahead]; }
        double length() const { return time(1) - time(0); }
        bool goes_on(double until) const { return place + 1 < samples->t.size() && time(1) <= until; }
    };
    Record record_;
    Arc arc_;
    LineStep line_;
    WalkedCurve load_;
    Cost cost_;
    model::Outcome outcome_ = model::Outcome::reached_end;
};

}  // namespace dinal::motion::exact
