#include "support/linear_truth.hpp"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

namespace dinal::truth {

Matrix exponential(const Matrix& A) {
    return A.exp();
}

LinearTruth::LinearTruth(LinearSystem system, Vector x, long double dt)
    : s_(std::move(system)), x_(std::move(x)), dt_(dt) {
    decide("");
}

bool LinearTruth::slips() const {
    return std::fabs((s_.slip * x_)(0)) > 1e-15L;
}

bool LinearTruth::ends(const Vector& x) const {
    if (way_ == 0) return std::fabs((s_.pull * x)(0)) > s_.Re;
    const long double v = way_ * (s_.slip * x)(0);
    return v < 0;
}

void LinearTruth::decide(const char* told) {
    if (slips()) {
        way_ = (s_.slip * x_)(0) > 0 ? 1 : -1;
        return;
    }
    x_(1) -= (s_.slip * x_)(0);
    const long double pull = (s_.pull * x_)(0);
    way_ = std::fabs(pull) <= s_.Re ? 0 : pull > 0 ? 1 : -1;
    if (told != nullptr && *told != '\0' && way_ != 0) events.push_back({t_, told, x_(0)});
}

Matrix LinearTruth::propagator(long double h) const {
    const Matrix& A = way_ > 0 ? s_.forward : way_ < 0 ? s_.backward : s_.stuck;
    return exponential(A * h);
}

void LinearTruth::change(const std::function<void(Vector& x, LinearSystem& s)>& how) {
    how(x_, s_);
    const int before = way_;
    way_ = 0;
    decide(before == 0 ? "slip" : "");
    if (before != 0 && slips()) way_ = before;
}

void LinearTruth::go(long double until) {
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

}  // namespace dinal::truth
