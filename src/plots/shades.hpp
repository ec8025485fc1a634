// Maps: values over a grid as areas of one shade each.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plots/figure.hpp"

namespace dinal::plots {

struct Shades {
    std::vector<double> x, y;  ///< increasing coordinates of the values
    std::vector<double> z;     ///< value at x[i] and y[j] in z[j * x.size() + i]; nan: none
    std::string label = {};
    std::optional<Interval> limits = {};  ///< values beyond have the first or last shade

    double at(std::size_t i, std::size_t j) const { return z[j * x.size() + i]; }
};

/// The range from <= z < to of one shade; the first and last are open.
struct ShadeBand {
    double from, to;
    std::string text;  ///< "3", "0.2 to 0.4"
};

/// A band for each value if these are a few whole numbers; otherwise about `most` bands between round numbers, chosen
/// so that a few extreme values, such as near a resonance, do not use up the shades.
std::vector<ShadeBand> bands_of(const Shades& shades, int most);
/// The index of the value's band; none for nan, or for an infinite value among single numbers.
std::optional<std::size_t> band_of(const std::vector<ShadeBand>& bands, double z);

/// The range of continuous colours on paper; none if each value has its own band, or there is only one value.
std::optional<Interval> colour_range(const Shades& shades);

/// Places without colour on paper: those without a value, and zeros of an otherwise positive quantity.
struct Absences {
    bool nothing = false, no_value = false;
};
Absences absences_of(const Shades& shades);

/// The midpoints between values, and one edge beyond each end.
std::vector<double> edges_between(const std::vector<double>& values, bool logarithmic);
/// The index of the value whose edges enclose the place; none outside.
std::optional<std::size_t> value_at(const std::vector<double>& edges, double place);

/// From dark 0x440154 to bright 0xFDE725; legible for the colour-blind and in greyscale.
std::uint32_t shade_colour(std::size_t band, std::size_t count);
/// The colour for a fraction from 0 to 1, by interpolation.
std::uint32_t continuous_colour(double part);
/// The character of a band: its digit if all are digits, otherwise a shade.
std::string_view shade_letter(const std::vector<ShadeBand>& bands, std::size_t band, bool ascii);
inline constexpr int most_text_bands = 5, most_paper_bands = 10;

}  // namespace dinal::plots
