// The map of a load that barely exceeds friction: it releases the mass briefly about its crest in each half period.
// Such a slide is a power series about the release, which keeps its digits however small the slide is; sums of load,
// friction and spring torques, as in a run, would lose them.
#pragma once

#include <array>
#include <complex>
#include <optional>

#include "analysis/map.hpp"
#include "analysis/sine_start.hpp"
#include "analysis/steady.hpp"

namespace dinal::analysis {

/// Maps a place of rest to the opposite of the next one.
class ShortSlides final : public Map {
public:
    /// Returns the map at its fixed point; none if the slides are not short, or the motion may not be unique (Re > Rd).
    static std::optional<ShortSlides> closed(const SteadyQuestion& question);

    Return operator()(const Eigen::VectorXd& from, const std::optional<HeldMode>& mode, int returns) override;
    std::optional<Derivative> derivative(const Eigen::VectorXd& at, const std::optional<HeldMode>& mode, int returns,
                                         int order) override {
        (void)at, (void)mode, (void)returns, (void)order;
        return {};
    }

    /// The facts about the motion, without those that follow from multipliers.
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
    Series series_{};     ///< displacement since the release,
    Series speed_{};      ///< and its speed times x
};

}  // namespace dinal::analysis
