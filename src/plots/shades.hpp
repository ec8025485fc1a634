// Values over a grid, seen from above: areas of one shade each, and lines of equal value.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plots/figure.hpp"

namespace dinal::plots {

struct Shades {
    std::vector<double> x, y;  ///< where the values are, increasing
    std::vector<double> z;     ///< of x[i] and y[j] at j * x.size() + i; nan where there is nothing
    std::string label = {};
    std::optional<Interval> limits = {};  ///< beyond them all values have the first and the last shade

    [[nodiscard]] double at(std::size_t i, std::size_t j) const { return z[j * x.size() + i]; }
};

/// The values from <= z < to have one shade; the ends of the first and the last are open.
struct ShadeBand {
    double from, to;
    std::string text;  ///< "3", "0.2 to 0.4"
};

/// A band for each value when these are a few whole numbers; else at most `most`, between round numbers. A few very
/// large or very small values, as near a resonance, do not take the shades from all others.
std::vector<ShadeBand> bands_of(const Shades& shades, int most);
/// Which band has the value; none for nan, and for an infinite value where each band is one number.
std::optional<std::size_t> band_of(const std::vector<ShadeBand>& bands, double z);

/// The values from the first to the last colour of a map on paper, whose colours flow; nothing where each value has a
/// band of its own, or there is one value only.
std::optional<Interval> colour_range(const Shades& shades);

/// What has no colour on paper: places without a value, and where a quantity that is positive elsewhere is 0.
struct Absences {
    bool nothing = false, no_value = false;
};
Absences absences_of(const Shades& shades);

/// Half way between the values, and as far beyond the first and the last.
std::vector<double> edges_between(const std::vector<double>& values, bool logarithmic);

/// The line along which z has this value, with nan between its pieces.
Curve contour(const Shades& shades, double level);

/// 0x440154 to 0xFDE725: from dark to bright, also for the colour-blind and in grey print.
std::uint32_t shade_colour(std::size_t band, std::size_t count);
/// The same for a part of the way, 0 to 1, between the ten.
std::uint32_t flowing_colour(double part);
/// A character for the band: its digit when all are digits, else a shade.
std::string_view shade_letter(const std::vector<ShadeBand>& bands, std::size_t band, bool ascii);
inline constexpr int most_text_bands = 5, most_paper_bands = 10;

}  // namespace dinal::plots
