#include "plots/shades.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "plots/ticks.hpp"

namespace dinal::plots {
namespace {

constexpr std::size_t most_values = 10;  // values with their own shades

std::vector<double> finite_values(const Shades& shades) {
    std::vector<double> values;
    std::ranges::copy_if(shades.z, std::back_inserter(values), [](double z) { return std::fabs(z) <= 1e300; });
    std::ranges::sort(values);
    return values;
}

/// The distinct values if they are a few whole numbers, otherwise empty.
std::vector<double> few_whole_numbers(const std::vector<double>& sorted) {
    std::vector<double> different;
    for (const double z : sorted) {
        if (z != std::floor(z) || std::fabs(z) > 1e6) return {};
        if (different.empty() || different.back() != z) different.push_back(z);
        if (different.size() > most_values) return {};
    }
    return different;
}

Interval range_of_shades(const std::vector<double>& sorted) {
    const auto part = [&sorted](double fraction) {
        return sorted[static_cast<std::size_t>(fraction * static_cast<double>(sorted.size() - 1))];
    };
    constexpr double tail = 0.1, much_longer = 3;
    const Interval all{sorted.front(), sorted.back()}, most{part(tail), part(1 - tail)};
    return most.length() > 0 && all.length() > much_longer * most.length() ? most : all;
}

}  // namespace

std::vector<ShadeBand> bands_of(const Shades& shades, int most) {
    constexpr double endless = std::numeric_limits<double>::infinity();
    const std::vector<double> sorted = finite_values(shades);
    if (sorted.empty()) return {};
    std::vector<ShadeBand> bands;
    if (const std::vector<double> whole = few_whole_numbers(sorted); !whole.empty() && !shades.limits) {
        for (const double z : whole) bands.push_back({z, z + 1, fmt::format("{:g}", z)});
        return bands;
    }
    const Interval range = shades.limits.value_or(range_of_shades(sorted));
    if (!(range.length() > 1e-12 * std::max(std::fabs(range.low), std::fabs(range.high)))) {
        return {{-endless, endless, fmt::format("{:.6g}", range.low)}};
    }
    const Ticks ticks = ticks_of(Axis{}, Scale(range, false), std::max(1, most - 2));
    for (std::size_t i = 0; i + 1 < ticks.at.size(); ++i) {
        bands.push_back({ticks.at[i], ticks.at[i + 1], fmt::format("{} to {}", ticks.text[i], ticks.text[i + 1])});
    }
    if (ticks.at.empty()) return {{-endless, endless, fmt::format("{:.4g} to {:.4g}", range.low, range.high)}};
    const auto below = [&](double z) { return !sorted.empty() && sorted.front() < z; };
    if (below(ticks.at.front())) {
        bands.insert(bands.begin(), {-endless, ticks.at.front(), "< " + ticks.text.front()});
    }
    if (sorted.back() >= ticks.at.back() || bands.empty()) {
        bands.push_back({ticks.at.back(), endless, "> " + ticks.text.back()});
    }
    return bands;
}

std::optional<Interval> colour_range(const Shades& shades) {
    const std::vector<double> sorted = finite_values(shades);
    if (sorted.empty() || (!shades.limits && !few_whole_numbers(sorted).empty())) return std::nullopt;
    const Interval range = shades.limits.value_or(range_of_shades(sorted));
    const bool wide = range.length() > 1e-12 * std::max(std::fabs(range.low), std::fabs(range.high));
    return wide ? std::optional(range) : std::nullopt;
}

Absences absences_of(const Shades& shades) {
    const std::vector<double> sorted = finite_values(shades);
    const bool some = !sorted.empty() && sorted.front() == 0 && sorted.back() > 0 && colour_range(shades).has_value();
    return {some, std::ranges::any_of(shades.z, [](double z) { return std::isnan(z); })};
}

std::optional<std::size_t> band_of(const std::vector<ShadeBand>& bands, double z) {
    if (std::isnan(z) || bands.empty()) return std::nullopt;
    const bool single = std::isfinite(bands.back().to);  // each band is one number
    if (single && std::isinf(z)) return std::nullopt;
    const auto next = std::ranges::upper_bound(bands, z, {}, &ShadeBand::from);
    return next == bands.begin() ? 0 : static_cast<std::size_t>(next - bands.begin()) - 1;
}

std::vector<double> edges_between(const std::vector<double>& values, bool logarithmic) {
    const auto forth = [logarithmic](double v) { return logarithmic ? std::log(v) : v; };
    const auto back = [logarithmic](double v) { return logarithmic ? std::exp(v) : v; };
    const std::size_t n = values.size();
    std::vector<double> edges(n + 1);
    for (std::size_t i = 1; i < n; ++i) edges[i] = back((forth(values[i - 1]) + forth(values[i])) / 2);
    if (n == 1) {
        const double half = values[0] == 0 ? 0.5 : std::fabs(values[0]) / 4;
        return {values[0] - half, values[0] + half};
    }
    edges[0] = back(1.5 * forth(values[0]) - 0.5 * forth(values[1]));
    edges[n] = back(1.5 * forth(values[n - 1]) - 0.5 * forth(values[n - 2]));
    return edges;
}

std::optional<std::size_t> value_at(const std::vector<double>& edges, double place) {
    const auto next = std::ranges::upper_bound(edges, place);
    if (next == edges.begin() || next == edges.end()) return std::nullopt;
    return static_cast<std::size_t>(next - edges.begin()) - 1;
}

namespace {
// every ninth part of matplotlib's viridis (van der Walt and Smith, 2015)
constexpr std::array<std::uint32_t, 10> viridis{0x440154, 0x482878, 0x3E4A89, 0x31688E, 0x26828E,
                                                0x1F9E89, 0x35B779, 0x6DCD59, 0xB4DE2C, 0xFDE725};
}  // namespace

std::uint32_t continuous_colour(double part) {
    const double place = std::clamp(part, 0.0, 1.0) * static_cast<double>(viridis.size() - 1);
    const std::size_t before = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
    const double weight = place - static_cast<double>(before);
    std::uint32_t mixed = 0;
    for (const unsigned shift : {16U, 8U, 0U}) {
        const double from = (viridis[before] >> shift) & 255U, to = (viridis[before + 1] >> shift) & 255U;
        mixed |= static_cast<std::uint32_t>(std::lround(from + weight * (to - from))) << shift;
    }
    return mixed;
}

std::uint32_t shade_colour(std::size_t band, std::size_t count) {
    const std::size_t place = count < 2 ? viridis.size() / 2 : band * (viridis.size() - 1) / (count - 1);
    return viridis[std::min(place, viridis.size() - 1)];
}

std::string_view shade_letter(const std::vector<ShadeBand>& bands, std::size_t band, bool ascii) {
    constexpr std::string_view digits = "0123456789";
    const bool are_digits = std::ranges::all_of(
        bands, [](const ShadeBand& b) { return b.text.size() == 1 && b.text[0] >= '0' && b.text[0] <= '9'; });
    if (are_digits) return digits.substr(static_cast<std::size_t>(bands[band].text[0] - '0'), 1);
    if (bands.size() > static_cast<std::size_t>(most_text_bands)) return digits.substr(band % digits.size(), 1);
    constexpr std::array<std::string_view, 5> shades{"·", "░", "▒", "▓", "█"};
    constexpr std::array<std::string_view, 5> plain{".", ":", "+", "*", "#"};
    const std::size_t place = bands.size() < 2 ? 2 : band * (shades.size() - 1) / (bands.size() - 1);
    return ascii ? plain[place] : shades[place];
}

}  // namespace dinal::plots
