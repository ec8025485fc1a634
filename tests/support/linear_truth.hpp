// The truth about linear systems with more in them: x' = A x with another matrix while the mass slips forward, slips
// backward or sticks, each propagated by the matrix exponential in long double; what ends a mode is a linear form of x.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace dinal::truth {

using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
using Form = Eigen::Matrix<long double, 1, Eigen::Dynamic>;

/// exp A.
Matrix exponential(const Matrix& A);

struct LinearSystem {
    Matrix forward, backward, stuck;  ///< the last entry of x is 1
    Form slip;                        ///< velocity against the surface
    Form pull;                        ///< what pulls at a sticking mass
    long double Re = 0;
};

struct LinearEvent {
    long double t;
    std::string kind;
    long double theta;
};

/// Steps of `dt` in which at most one thing happens; x[0] is theta, x[1] the velocity.
class LinearTruth {
public:
    LinearTruth(LinearSystem system, Vector x, long double dt);
    /// A jump of M or of the state: the mode is looked up again.
    void change(const std::function<void(Vector& x, LinearSystem& s)>& how);
    void go(long double until);
    [[nodiscard]] const Vector& x() const { return x_; }
    std::vector<LinearEvent> events;

private:
    [[nodiscard]] bool slips() const;
    [[nodiscard]] bool ends(const Vector& x) const;
    void decide(const char* told);
    [[nodiscard]] Matrix propagator(long double h) const;

    LinearSystem s_;
    Vector x_;
    long double dt_, t_ = 0;
    int way_ = 0;
};

}  // namespace dinal::truth
