// M at many times at once, as stepping loops want it.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "model/excitation.hpp"

namespace dinal::model {
namespace {

template <class T>
std::size_t add(const T& term, const Component& c, std::span<const double> times, std::span<double> out,
                std::span<const double> rests) {
    const std::size_t n = times.size();
    if (rests.empty() && c.from == -never && c.to == never) {
        for (std::size_t i = 0; i < n; ++i) {
            out[i] += c.gain * term.value(times[i]);
        }
        return n;
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (times[i] >= c.from && times[i] < c.to) {
            out[i] += c.gain * terms::value_near(term, times[i], rests.empty() ? 0 : rests[i]);
        }
    }
    return n;
}

/// Whether the times lie `spacing` apart to within their own rounding.
bool evenly_spaced(std::span<const double> times, double spacing) {
    const double first = times.front();
    const double rounding =
        2 * std::numeric_limits<double>::epsilon() * std::max(std::fabs(first), std::fabs(times.back()));
    double worst = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        worst = std::max(worst, std::fabs(times[i] - (first + static_cast<double>(i) * spacing)));
    }
    return worst <= rounding;
}

/// At evenly spaced times, as a stepping loop has them, a sine costs two products by the addition theorem:
/// sin(a + b) with `a` at every sixteenth time and `b` from a table of sixteen. Good to the rounding of the times.
// NOTE: but never above the amplitude, as sin() itself: a load of amplitude Re that rounding lifted would end a stick.
std::size_t add(const Harmonic& h, const Component& c, std::span<const double> times, std::span<double> out,
                std::span<const double> rests) {
    constexpr std::size_t stride = 16;
    const std::size_t n = times.size();
    const double spacing = n > 1 ? (times[n - 1] - times[0]) / static_cast<double>(n - 1) : 0;
    if (n < 2 * stride || c.from != -never || c.to != never || !evenly_spaced(times, spacing)) {
        return add<Harmonic>(h, c, times, out, rests);
    }
    std::array<double, stride> sine{}, cosine{};
    for (std::size_t j = 0; j < stride; ++j) {
        sine[j] = std::sin(h.omega * (static_cast<double>(j) * spacing));
        cosine[j] = std::cos(h.omega * (static_cast<double>(j) * spacing));
    }
    const double peak = std::fabs(c.gain * h.amplitude);
    for (std::size_t i = 0; i < n; i += stride) {
        const double angle = h.omega * times[i] + h.phase;
        const double s = c.gain * h.amplitude * std::sin(angle), k = c.gain * h.amplitude * std::cos(angle);
        const std::size_t count = std::min(stride, n - i);
        for (std::size_t j = 0; j < count; ++j) {
            out[i + j] += std::clamp(s * cosine[j] + k * sine[j], -peak, peak);
        }
    }
    return n;
}

/// In blocks, which are short enough for the stack.
std::size_t add(const Scripted& script, const Component& c, std::span<const double> times, std::span<double> out,
                std::span<const double> /*rests*/) {
    constexpr std::size_t block = 128;
    std::array<double, block> own_times;
    std::array<double, block> values;
    const auto outside = [&c](double t) { return t < c.from || t >= c.to; };
    std::size_t i = 0;
    while (i < times.size()) {
        if (outside(times[i])) {
            ++i;
            continue;
        }
        std::size_t n = 0;
        for (; n < block && i + n < times.size() && !outside(times[i + n]); ++n) {
            own_times[n] = times[i + n] - script.delay;
        }
        const std::size_t good = script.function->fill({own_times.data(), n}, {values.data(), n});
        for (std::size_t j = 0; j < good; ++j) {
            out[i + j] += c.gain * values[j];
        }
        if (good < n) {
            out[i + good] = values[good];
            return i + good;
        }
        i += n;
    }
    return times.size();
}

auto script_count(std::span<const Component> components) {
    return std::count_if(components.begin(), components.end(),
                         [](const Component& c) { return std::holds_alternative<Scripted>(c.term); });
}

/// Two scripts take turns, so that neither is called for times after the other has failed.
std::size_t fill_in_turn(const Excitation& excitation, std::span<const double> times, std::span<double> out) {
    for (std::size_t i = 0; i < times.size(); ++i) {
        out[i] = excitation.value(times[i]);
        if (!std::isfinite(out[i])) {
            return i;
        }
    }
    return times.size();
}

}  // namespace

std::size_t Excitation::fill(std::span<const double> times, std::span<double> out,
                             std::span<const double> rests) const {
    std::size_t n = times.size();
    if (script_count(components()) > 1) {
        return fill_in_turn(*this, times, out);
    }
    std::fill_n(out.begin(), n, 0.0);
    for (const Component& c : components()) {
        if (c.gain != 0) {
            n = std::visit([&](const auto& term) { return add(term, c, times.first(n), out.first(n), rests); }, c.term);
        }
    }
    const auto filled = out.first(n);
    const auto bad = std::find_if(filled.begin(), filled.end(), [](double x) { return !std::isfinite(x); });
    return static_cast<std::size_t>(bad - filled.begin());
}

}  // namespace dinal::model
