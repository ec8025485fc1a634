// The free motions of y'' + 2 zeta y' + y = 0 for any zeta >= 0, without loss of digits between the regimes.
#pragma once

namespace dinal::theory {

/// Time is x = w0 t. With q = sqrt(1 - zeta^2), or k = sqrt(zeta^2 - 1) when overdamped, the fundamental solutions are
/// built from e^(-zeta x) cos qx and e^(-zeta x) (sin qx)/q, whose limits q -> 0 are e^(-x) and x e^(-x).
class Modes {
public:
    explicit Modes(double zeta);

    [[nodiscard]] double zeta() const { return zeta_; }
    [[nodiscard]] bool swings() const { return zeta_ < 1; }
    /// q, or k when overdamped.
    [[nodiscard]] double rate() const { return rate_; }
    /// The decay rates of an overdamped motion: 1/(zeta + k), and zeta + k.
    [[nodiscard]] double slow_root() const { return 1 / fast_root(); }
    [[nodiscard]] double fast_root() const { return swings() ? 1 : zeta_ + rate_; }

    /// e^(-zeta x) cos qx.
    [[nodiscard]] double damped_cosine(double x) const;
    /// y(0) = 0, y'(0) = 1: e^(-zeta x) (sin qx)/q.
    [[nodiscard]] double pushed(double x) const;
    struct Answers {
        double released;                 ///< y(0) = 1, y'(0) = 0; its velocity is -pushed
        double pushed, pushed_velocity;  ///< y(0) = 0, y'(0) = 1
    };
    [[nodiscard]] Answers after(double x) const;

private:
    double zeta_;
    double rate_;
};

/// An angle (or y) and its derivative at x = w0 t, from the values at x = 0.
struct Motion2 {
    double y = 0;
    double dy = 0;  ///< derivative with respect to x
};
inline Motion2 free_motion(const Modes& modes, const Motion2& start, double x) {
    const auto [released, pushed, pushed_velocity] = modes.after(x);
    return {start.y * released + start.dy * pushed, start.dy * pushed_velocity - start.y * pushed};
}

}  // namespace dinal::theory
