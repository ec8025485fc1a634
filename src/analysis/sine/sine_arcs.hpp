// The slides of a SingleSine from standstill to standstill, in closed form. Their ends are looked for in steps, which
// may step over a short reversal: what is found here is a start for those who prove.
#pragma once

#include <complex>
#include <optional>

#include "analysis/sine/single_sine.hpp"

namespace dinal::analysis::sine {

class SineArcs {
public:
    /// Only where applies_to() says so.
    explicit SineArcs(const SingleSine& sine);
    static bool applies_to(const SingleSine& sine);

    /// Takes leave from velocity 0 at this place and phase of the load; way is +1 or -1.
    void leave(double phase, double y, double way);
    /// For how long it slides before its velocity is zero again; none when it does not get under way, or goes on beyond
    /// `most` of x.
    [[nodiscard]] std::optional<double> first_zero(double most) const;
    [[nodiscard]] theory::Motion2 at(double x) const;

private:
    using Complex = std::complex<double>;
    struct Speed {
        double v, slope;
    };
    [[nodiscard]] Speed speed(double x) const;
    [[nodiscard]] double zero_between(double from, double to, double x) const;

    SingleSine sine_;
    Complex root_;   // of the free motion, -zeta + iq
    double answer_;  // the amplitude of the answer to the load, and its lag
    double lag_;
    double step_;                      // of the search
    Complex forced_turn_, free_turn_;  // by a step
    double way_ = 1;
    Complex forced_ = 0, free_ = 0;  // at the leave: y = Im forced + Re free - way Rd/M0
};

}  // namespace dinal::analysis::sine
