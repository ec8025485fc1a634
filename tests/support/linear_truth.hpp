// The truth about linear systems with more in them: x' = A x with another matrix while the mass slips forward, slips
// backward or sticks, each propagated by the matrix exponential in long double; what ends a mode is a linear form of x.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

namespace dinal::truth {

using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
using Form = Eigen::Matrix<long double, 1, Eigen::Dynamic>;

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
    LinearTruth(LinearSystem system, Vector x, long double dt) : s_(std::move(system)), x_(std::move(x)), dt_(dt) {
        decide("");
    }
    /// A jump of M or of the state: the mode is looked up again.
    void change(const std::function<void(Vector& x, LinearSystem& s)>& how) {
        how(x_, s_);
        const int before = way_;
        way_ = 0;
        decide(before == 0 ? "slip" : "");
        if (before != 0 && slips()) way_ = before;
    }
    void go(long double until) {
        while (t_ < until) {
            const long double h = std::min(dt_, until - t_);
            const Matrix step = propagator(h);
            const Vector next = step * x_;
            if (!ends(next)) {
                x_ = next, t_ += h;
                if (until - t_ < 1e-17L * until) t_ = until;
                continue;
            }
            long double a = 0, b = h;
            for (int i = 0; i < 80; ++i) {
                const long double m = (a + b) / 2;
                (ends(propagator(m) * x_) ? b : a) = m;
            }
            x_ = propagator(b) * x_, t_ += b;
            if (way_ == 0) {
                way_ = (s_.pull * x_)(0) > 0 ? 1 : -1;
                events.push_back({t_, "slip", x_(0)});
            } else {
                const int before = way_;
                way_ = 0;
                decide(nullptr);
                events.push_back({t_, way_ == 0 ? "stick" : way_ != before ? "turn" : "", x_(0)});
                if (events.back().kind.empty()) events.pop_back();
            }
        }
    }
    [[nodiscard]] const Vector& x() const { return x_; }
    std::vector<LinearEvent> events;

private:
    [[nodiscard]] bool slips() const { return std::fabs((s_.slip * x_)(0)) > 1e-15L; }
    [[nodiscard]] bool ends(const Vector& x) {
        if (way_ == 0) return std::fabs((s_.pull * x)(0)) > s_.Re;
        const long double v = way_ * (s_.slip * x)(0);
        return v < 0;
    }
    void decide(const char* told) {
        if (slips()) {
            way_ = (s_.slip * x_)(0) > 0 ? 1 : -1;
            return;
        }
        x_(1) -= (s_.slip * x_)(0);
        const long double pull = (s_.pull * x_)(0);
        way_ = std::fabs(pull) <= s_.Re ? 0 : pull > 0 ? 1 : -1;
        if (told != nullptr && *told != '\0' && way_ != 0) events.push_back({t_, told, x_(0)});
    }
    [[nodiscard]] Matrix propagator(long double h) const {
        const Matrix& A = way_ > 0 ? s_.forward : way_ < 0 ? s_.backward : s_.stuck;
        return (A * h).exp();
    }

    LinearSystem s_;
    Vector x_;
    long double dt_, t_ = 0;
    int way_ = 0;
};

}  // namespace dinal::truth
