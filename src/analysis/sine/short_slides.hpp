// The steady motion of a load that barely exceeds friction: it releases the mass briefly about its crest in each half
// period. Such a slide is a power series about the release, which keeps its digits however small the slide is; sums of
// load, friction and spring torques would lose them.
#pragma once

#include <array>
#include <complex>
#include <optional>

#include "analysis/sine/sine.hpp"
#include "analysis/steady.hpp"

namespace dinal::analysis::sine {

class ShortSlides {
public:
    /// None if the slides are not short, or the motion may not be unique (Re > Rd).
    static std::optional<ShortSlides> of(const SteadyQuestion& question);

    [[nodiscard]] SteadyMotion motion(const SteadyQuestion& question) const;
    /// The amplitude and phase of theta's fundamental, counted from the start of the drive.
    [[nodiscard]] std::complex<double> fundamental() const;

private:
    static constexpr std::size_t terms = 44;
    using Series = std::array<double, terms>;  // coefficients of powers of x

    explicit ShortSlides(const SingleSine& sine) : sine_(sine) {}
    bool solve();
    bool start(double spare);
    [[nodiscard]] bool find_end();
    [[nodiscard]] bool is_short() const;
    [[nodiscard]] double way(double x) const;
    [[nodiscard]] double speed_by_square(double x) const;
    [[nodiscard]] double forgets(double x) const;

    SingleSine sine_;
    double rest_ = 0;     ///< the mass is released forward from -rest_
    double release_ = 0;  ///< phase of the release
    double end_ = 0;      ///< end of the slide, x since the release
    Series series_{};     ///< way since the release,
    Series speed_{};      ///< and its speed times x
};

}  // namespace dinal::analysis::sine
