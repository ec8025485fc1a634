// M at many times at once, for stepping loops.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "model/excitation.hpp"

namespace dinal::model {
namespace {

template <class T>
std::size_t add(const T& term, const Component& c, std::span<const double> times, std::span<double> out,
                const Spread* spread) {
    const std::size_t n = times.size();
    if (spread == nullptr && c.from == -never && c.to == never) {
        for (std::size_t i = 0; i < n; ++i) {
            out[i] += c.gain * term.value(times[i]);
        }
        return n;
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (times[i] >= c.from && times[i] < c.to) {
            out[i] += c.gain * terms::value_near(term, times[i], spread == nullptr ? 0 : spread->rests[i]);
        }
    }
    return n;
}

/// Returns whether the times are `spacing` apart to within their rounding.
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

/// The addition theorem for a sine, limited to its peak as sin() is: a load of amplitude Re exceeded by rounding would
/// end a stick.
struct SineOfSum {
    double sine, cosine, peak;
    SineOfSum(double amplitude, const terms::Angle& angle) : peak(std::fabs(amplitude)) {
        const double s = std::sin(angle.rounded), c = std::cos(angle.rounded);
        sine = amplitude * (s + angle.lack * c), cosine = amplitude * (c - angle.lack * s);
    }
    double at(double sine_of, double cosine_of) const {
        return std::clamp(sine * cosine_of + cosine * sine_of, -peak, peak);
    }
};

/// Adds a sine at times about a middle, with tabulated sines of the distances. The end points, which adjacent panels
/// share, are evaluated directly so that both agree.
std::size_t add_about(const Harmonic& h, const Component& c, std::span<const double> times, std::span<double> out,
                      Spread& spread) {
    const Spread::Turn& turn = spread.turn(h.omega);
    const SineOfSum sum(c.gain * h.amplitude, terms::angle_at(spread.middle, spread.rest, h.omega, h.at, h.phase));
    const std::size_t last = spread.places.size() - 1, n = times.size();
    std::size_t i = 0, end = n;
    if (spread.first == 0) out[0] += c.gain * h.value(times[0]), i = 1;
    if (spread.first + n - 1 == last) --end, out[end] += c.gain * h.value(times[end]);
    const double *sine = turn.sine.data() + spread.first, *cosine = turn.cosine.data() + spread.first;
    for (; i < end; ++i) out[i] += sum.at(sine[i], cosine[i]);
    return n;
}

/// At evenly spaced times a sine costs two products by the addition theorem: sin(a + b) with `a` at every sixteenth
/// time and `b` from a table of sixteen. Accurate to the rounding of the times.
std::size_t add(const Harmonic& h, const Component& c, std::span<const double> times, std::span<double> out,
                Spread* spread) {
    constexpr std::size_t stride = 16;
    const std::size_t n = times.size();
    const bool always = c.from == -never && c.to == never;
    if (always && spread != nullptr && n > 1) return add_about(h, c, times, out, *spread);
    const double spacing = n > 1 ? (times[n - 1] - times[0]) / static_cast<double>(n - 1) : 0;
    if (n < 2 * stride || !always || !evenly_spaced(times, spacing)) {
        return add<Harmonic>(h, c, times, out, spread);
    }
    std::array<double, stride> sine{}, cosine{};
    for (std::size_t j = 0; j < stride; ++j) {
        sine[j] = std::sin(h.omega * (static_cast<double>(j) * spacing));
        cosine[j] = std::cos(h.omega * (static_cast<double>(j) * spacing));
    }
    for (std::size_t i = 0; i < n; i += stride) {
        const SineOfSum sum(c.gain * h.amplitude, {h.angle(times[i]), 0});
        const std::size_t count = std::min(stride, n - i);
        for (std::size_t j = 0; j < count; ++j) {
            out[i + j] += sum.at(sine[j], cosine[j]);
        }
    }
    return n;
}

/// Evaluates in blocks small enough for the stack.
std::size_t add(const Scripted& script, const Component& c, std::span<const double> times, std::span<double> out,
                const Spread* /*spread*/) {
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

/// Evaluates both scripts at one time after the other, so that neither is called for times after the other has failed.
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

const Spread::Turn& Spread::turn(double omega) {
    if (next_turn == turns.size()) turns.emplace_back();
    Turn& turn = turns[next_turn++];
    if (turn.omega == omega && turn.half == half && !turn.sine.empty()) return turn;
    const std::size_t n = places.size();
    turn.omega = omega, turn.half = half;
    turn.sine.resize(n), turn.cosine.resize(n);
    for (std::size_t j = 0; 2 * j < n; ++j) {
        const double angle = omega * (half * places[j]), s = std::sin(angle), c = std::cos(angle);
        turn.sine[j] = s, turn.sine[n - 1 - j] = -s;
        turn.cosine[j] = turn.cosine[n - 1 - j] = c;
    }
    return turn;
}

std::size_t Excitation::fill(std::span<const double> times, std::span<double> out, Spread* spread) const {
    std::size_t n = times.size();
    if (script_count(components()) > 1) {
        return fill_in_turn(*this, times, out);
    }
    std::fill_n(out.begin(), n, 0.0);
    if (spread != nullptr) spread->next_turn = 0;
    for (const Component& c : components()) {
        if (c.gain != 0) {
            n = std::visit([&](const auto& term) { return add(term, c, times.first(n), out.first(n), spread); },
                           c.term);
        }
    }
    const auto filled = out.first(n);
    double nothing = 0;
    for (const double value : filled) nothing += 0 * value;
    if (nothing == 0) return n;
    const auto bad = std::find_if(filled.begin(), filled.end(), [](double x) { return !std::isfinite(x); });
    return static_cast<std::size_t>(bad - filled.begin());
}

}  // namespace dinal::model
