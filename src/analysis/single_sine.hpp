// A linear spring and symmetric Coulomb friction under one sine, with closed forms between events: they provide the
// start of a search, which is then one return from its end.
//
// Dimensionless: y = theta k/M0, x = w0 t, so that y'' + 2 zeta y' + y = sin p - friction; the phase p of the load
// advances by r for each x.
#pragma once

#include <array>
#include <complex>
#include <numbers>
#include <optional>

#include "analysis/forced_search.hpp"
#include "analysis/steady.hpp"
#include "theory/theory_free.hpp"

namespace dinal::analysis {

inline constexpr double half_load = std::numbers::pi;  ///< half a period of the load, as a phase

struct SingleSine {
    double r = 0, zeta = 0;
    double sliding = 0, holding = 0;  ///< Rd/M0 and Re/M0
    double spare = 0;                 ///< 1 - Re/M0 without loss of digits
    double phase = 0;                 ///< phase of the load when the drive starts
    double unit = 1, omega0 = 1;      ///< M0/k and w0

    model::State state(const theory::Motion2& y) const { return {unit * y.y, unit * omega0 * y.dy}; }
};

/// Empty for other systems or other M, or if r is out of the range of the closed forms.
std::optional<SingleSine> single_sine(const SteadyQuestion& question);

/// The state of the steady motion when the drive starts, usually accurate to rounding. The search may step over a short
/// reversal, so callers must verify the state. Empty if the closed forms find no motion, the mass never moves, or half
/// periods are not opposite.
std::optional<model::State> sine_start(const SingleSine& sine);

/// The map of a load that barely exceeds friction: it releases the mass briefly about its crest in each half period.
/// Such a slide is a power series about the release, which keeps its digits however small the slide is; sums of load,
/// friction and spring torques, as in a run, would lose them. Maps a place of rest to the opposite of the next one.
class ShortSlides final : public Map {
public:
    /// Returns the map at its fixed point; empty if the slides are not short, or the motion may not be unique (Re >
    /// Rd).
    static std::optional<ShortSlides> closed(const SteadyQuestion& question);

    Return operator()(const Eigen::VectorXd& from, const std::optional<HeldMode>& mode, int returns) override;
    std::optional<Derivative> derivative(const Eigen::VectorXd& at, const std::optional<HeldMode>& mode, int returns,
                                         int order) override {
        (void)at, (void)mode, (void)returns, (void)order;
        return {};
    }

    /// The facts about the motion, except those that follow from multipliers.
    SteadyMotion motion(const SteadyQuestion& question) const;
    std::vector<std::complex<double>> multipliers() const;
    /// The amplitude and phase of theta's fundamental, counted from the start of the drive.
    std::complex<double> fundamental() const;

private:
    static constexpr std::size_t terms = 44;
    using Series = std::array<double, terms>;  // coefficients of powers of x

    explicit ShortSlides(const SingleSine& sine) : sine_(sine) {}
    /// Computes the slide from a place of rest; returns false if it is not short.
    bool slide(double rest);
    bool start(double spare);
    [[nodiscard]] bool find_end();
    bool is_short() const;
    double way(double x) const;
    double speed_by_square(double x) const;
    double forgets(double x) const;

    SingleSine sine_;
    double unit_ = 1;     ///< unit of places of rest
    double rest_ = 0;     ///< the mass is released forward from -rest_
    double release_ = 0;  ///< phase of the release
    double end_ = 0;      ///< end of the slide, x since the release
    Series series_{};     ///< displacement since the release
    Series speed_{};      ///< speed since the release, times x
};

}  // namespace dinal::analysis
