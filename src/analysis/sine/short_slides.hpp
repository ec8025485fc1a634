// The steady motion of a load that hardly exceeds friction: once in each half period it frees the mass for a moment
// about its crest. Such a slide is its power series about the release, and all of it is counted from there, so that it
// keeps its digits however small it is; sums of a load, friction and springs of about the same size would lose them.
#pragma once

#include <array>
#include <complex>
#include <optional>

#include "analysis/sine/sine.hpp"
#include "analysis/steady.hpp"

namespace dinal::analysis::sine {

class ShortSlides {
public:
    /// None where the slides are no short ones, or it is not sure that there is no other motion (Re > Rd).
    static std::optional<ShortSlides> of(const SteadyQuestion& question);

    [[nodiscard]] SteadyMotion motion(const SteadyQuestion& question) const;
    /// The amplitude and phase of theta's fundamental, counted from the beginning of the drive.
    [[nodiscard]] std::complex<double> fundamental() const;

private:
    static constexpr std::size_t terms = 44;
    using Series = std::array<double, terms>;  // of powers of x

    explicit ShortSlides(const SingleSine& sine) : sine_(sine) {}
    bool solve();
    bool start(double spare);
    [[nodiscard]] bool find_end();
    [[nodiscard]] bool is_short() const;
    [[nodiscard]] double way(double x) const;
    [[nodiscard]] double speed_by_square(double x) const;
    [[nodiscard]] double forgets(double x) const;

    SingleSine sine_;
    double rest_ = 0;     ///< the mass is released from -rest_ forward
    double release_ = 0;  ///< the phase of that
    double end_ = 0;      ///< of the slide, in x since then
    Series series_{};     ///< of the way since then,
    Series speed_{};      ///< and of its speed, times x
};

}  // namespace dinal::analysis::sine
