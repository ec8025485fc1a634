// One piece of a motion with more in it: theta, velocity and the states over a stretch without a jump, found by
// collocation at Chebyshev points (or a step of Runge-Kutta), and judged.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "model/slide.hpp"
#include "motion/clock.hpp"
#include "motion/exact/free_motion.hpp"
#include "motion/hybrid/field.hpp"
#include "motion/spectral/chebyshev.hpp"

namespace dinal::motion::hybrid {

namespace cheb = spectral::chebyshev;
using engine::greatest, engine::node_count, engine::Nodes, engine::rounding, engine::Series;

/// How a run is cut into pieces: by what resolves it, or evenly (h > 0).
struct Cut {
    double tolerance = 1e-12;
    double longest = 0;  ///< piece, time units
    double h = 0;        ///< of Runge-Kutta
};

/// theta, velocity, states in this order.
using Values = std::vector<double>;

struct Solved {
    Clock start;
    double h = 0;    ///< half its length
    double end = 0;  ///< exactly
    model::Motion way = model::Motion::stuck;
    bool leans = false;            ///< stuck at a wall, whatever the belt does
    model::SpeedRange friction{};  ///< if straight, friction is along it on all of the piece
    double origin = 0;  ///< theta is this and y[0]: a wall that was hit, so that small bounces keep their digits
    bool from_break = false, to_break = false;
    bool to_the_end = false;  ///< it ends at `end` to the letter, be that a little earlier or later than 2 h
    bool passed = false;      ///< over a jump that nobody announced
    bool held = false;        ///< nothing that acts on the mass but itself changes: M is M[0], and nothing pushes
    Nodes times{};
    std::vector<Nodes> y{}, f{};  ///< of each value: at the nodes, and its rate
    Nodes M{}, push{}, belt{}, belt_rate{};
    std::vector<Series> series{};  ///< of each value less its first

    [[nodiscard]] double time(double x) const { return start.after(h * (1 + x)); }
    [[nodiscard]] double theta_at(std::size_t node) const { return origin + y[0][node]; }
    [[nodiscard]] double theta(double x) const { return origin + at(0, x); }
    /// The velocity of what the mass stands on while it is stuck.
    [[nodiscard]] double carrier(std::size_t node) const { return leans ? 0 : belt[node]; }
    [[nodiscard]] double at(std::size_t value, double x) const {
        return x >= 1 ? y[value][node_count - 1] : y[value][0] + spectral::chebyshev::value(series[value], x);
    }
    [[nodiscard]] Side side(std::size_t node) const {
        return node == 0 && from_break ? Side::after : node + 1 == node_count && to_break ? Side::before : Side::at;
    }
};

class Solver {
public:
    enum class Attempt { resolved, shorten, failed };
    Solver(const Problem& problem, const Field& field, const Cut& cut);

    /// The piece from `start` up to `end`, 2 h later, under friction of `way`; `stuck` rests on the belt or at a wall.
    /// A feedback is asked at `departing` at its beginning, theta without the origin. failed: something is not finite
    /// at bad_time().
    Attempt solve(Solved& piece, const Values& begin, const model::State& departing);
    [[nodiscard]] double bad_time() const { return bad_time_; }
    /// Over 1: by how much the last piece was not resolved.
    [[nodiscard]] double unresolved() const { return unresolved_; }
    /// The greatest speed of the belt so far.
    [[nodiscard]] double fastest_belt() const { return fastest_belt_; }
    /// Of the linear part.
    [[nodiscard]] const exact::LinearMotion& free() const { return free_; }
    /// The friction of the next piece that moves.
    [[nodiscard]] model::Slide& slide() { return slide_; }
    [[nodiscard]] const model::Slide& slide() const { return slide_; }
    /// Where the belt jumps on a piece, and nobody announced it; `never` when it does not.
    [[nodiscard]] double jump_of_belt(const Solved& piece) const;
    /// A piece too short to matter is a straight line.
    void pass_over(Solved& piece) const;

private:
    static constexpr std::size_t inner = node_count - 1;
    /// How the linear part goes on from a velocity of 1 or an acceleration of 1, from theta = 0, over a piece.
    struct Swing {
        double h = 0;
        bool resolved = false;  ///< by the polynomials
        struct Course {
            Nodes nodes{};
            Series series{};
        };
        Course slowed{};  ///< what the velocity of 1 has changed by
        Course moved{};   ///< theta of the velocity of 1, or the velocity of the acceleration of 1
        Course driven{};  ///< theta of the acceleration of 1
        /// What accelerations at the nodes, 0 at the first, do to the velocities there. Empty until it is needed.
        Eigen::MatrixXd answer{};
    };
    bool evaluate(Solved& piece, std::size_t node, const model::State& asked);
    bool rates_of(const Solved& piece, double t, Side side, const model::State& asked, const Values& y,
                  double belt_rate, double* out, double& M, double push, double belt) const;
    Attempt collocate(Solved& piece, const model::State& departing);

    // solver_linear.cpp: what needs no iterations.
    [[nodiscard]] Swing& swing_over(Solved& piece);
    void swing_on(Solved& piece, const Swing& swing) const;
    Attempt go_on_held(Solved& piece, const Swing* swing);
    Attempt follow_load(Solved& piece, Swing& swing);
    void prepare_answer(Swing& swing) const;
    void end_in_time(Solved& piece) const;

    Attempt runge_kutta(Solved& piece, const model::State& departing);
    bool sample_surroundings(Solved& piece);
    bool estimate_jacobian(const Solved& piece, std::size_t node);
    void take_newton_step(const Solved& piece);
    void place(Solved& piece) const;
    [[nodiscard]] double accelerated(double torque, double theta, double velocity) const;
    /// Theta is the integral of the velocity, and that of a mass at rest is its surface's.
    [[nodiscard]] std::size_t first_unknown(const Solved& piece) const { return moves(piece) ? 1 : 2; }
    [[nodiscard]] double torques_of(const Solved& piece, double M) const;
    void judge(const Solved& piece);
    void look_at_corners(const Solved& piece);
    [[nodiscard]] bool moves(const Solved& piece) const { return piece.way != model::Motion::stuck; }

    model::Lowered system_;
    exact::LinearMotion free_;
    model::Slide slide_;
    const Field& field_;
    Cut cut_;
    std::size_t n_;  // values
    bool linear_;    // without a remainder, states and functions of the motion
    double bad_time_ = 0, unresolved_ = 0, uncertain_ = 0;
    double fastest_belt_ = 0;  // so far
    Values fastest_;           // rates of the states, so far

    /// Newton's matrix for the lengths of some pieces that were: most pieces of a run have one of a few lengths.
    struct Linear {
        struct Matrix {
            double h = 0;
            int steps = 0;  ///< taken with it
            Eigen::PartialPivLU<Eigen::MatrixXd> factors{};
            Eigen::MatrixXd inverse{};  ///< of one that comes again and again
        };
        Eigen::MatrixXd jacobian;
        std::array<Matrix, 8> of_lengths{};
        std::size_t next = 0;  // to be replaced
        bool known = false;
    };
    Linear::Matrix& newton_matrix(const Solved& piece);
    Linear moving_, standing_;
    std::array<Swing, 8> swings_;  // of some lengths that were
    std::size_t next_swing_ = 0;
    Eigen::VectorXd residual_, step_;
    Values point_, rate_, other_rate_;
};

}  // namespace dinal::motion::hybrid
