#include "model/excitation.hpp"

#include <array>

#include "model/term_bounds.hpp"
#include "model/terms.hpp"

namespace dinal::model {
namespace {

enum class Side { before, at, after };

/// A step to the side that is small against every number the function may have computed with, but that rounding in
/// its own arithmetic (t - delay, t % period) can not swallow.
double hair(double t, double delay) {
    constexpr double few_ulps = 4 * std::numeric_limits<double>::epsilon();
    constexpr double smallest = 1e-300;  // at t = 0: still a normal number, so that sin(w t) / t is exact there
    return std::max(smallest, few_ulps * std::max({std::fabs(t), std::fabs(t - delay), std::fabs(delay)}));
}

double ask(const Scripted& s, double t, const State& state, Side side) {
    const double own_time = t - s.delay;
    switch (side) {
        case Side::before:
            return s.function->value(own_time - hair(t, s.delay), state);
        case Side::at:
            return s.function->value(own_time, state);
        case Side::after:
            return s.function->value(own_time + hair(t, s.delay), state);
    }
    return 0;
}

/// The sum of all components. A component that is off (gain 0, outside its window) is not asked; a failed script ends
/// the sum, so that no other script is called after it.
template <Side side>
double sum_of(const std::vector<Component>& components, double t, const State& state) {
    const double native_t = side == Side::before ? std::nextafter(t, -never) : t;
    double sum = 0;
    for (const Component& c : components) {
        if (c.gain == 0 || native_t < c.from || native_t >= c.to) {
            continue;
        }
        if (const auto* script = std::get_if<Scripted>(&c.term)) {
            const double value = ask(*script, t, state, side);
            if (std::isnan(value)) {
                return value;
            }
            sum += c.gain * value;
            continue;
        }
        sum += c.gain * std::visit(
                            [native_t](const auto& term) {
                                if constexpr (std::is_same_v<std::decay_t<decltype(term)>, Scripted>) {
                                    return 0.0;
                                } else {
                                    return terms::value(term, native_t);
                                }
                            },
                            c.term);
    }
    return sum;
}

template <class T>
std::size_t add(const T& term, const Component& c, std::span<const double> times, std::span<double> out) {
    const std::size_t n = times.size();
    if (c.from == -never && c.to == never) {
        for (std::size_t i = 0; i < n; ++i) {
            out[i] += c.gain * terms::value(term, times[i]);
        }
        return n;
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (times[i] >= c.from && times[i] < c.to) {
            out[i] += c.gain * terms::value(term, times[i]);
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
std::size_t add(const Harmonic& h, const Component& c, std::span<const double> times, std::span<double> out) {
    constexpr std::size_t stride = 16;
    const std::size_t n = times.size();
    const double spacing = n > 1 ? (times[n - 1] - times[0]) / static_cast<double>(n - 1) : 0;
    if (n < 2 * stride || c.from != -never || c.to != never || !evenly_spaced(times, spacing)) {
        return add<Harmonic>(h, c, times, out);
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
std::size_t add(const Scripted& script, const Component& c, std::span<const double> times, std::span<double> out) {
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

bool is_script(const Component& c) {
    return std::holds_alternative<Scripted>(c.term);
}

auto script_count(const std::vector<Component>& components) {
    return std::count_if(components.begin(), components.end(), is_script);
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

double next_break(const Component& c, double t) {
    if (c.gain == 0 || t >= c.to) {
        return never;
    }
    if (t < c.from) {
        return c.from;
    }
    return std::min(c.to, std::visit([t](const auto& term) { return terms::next_break(term, t); }, c.term));
}

double constant_from(const Component& c) {
    if (c.gain == 0) {
        return -never;
    }
    const double settled = std::visit([](const auto& term) { return terms::constant_from(term); }, c.term);
    const bool at_zero = std::visit([](const auto& term) { return terms::ends_at_zero(term); }, c.term);
    if (c.to < never) {
        return at_zero ? std::min(c.to, settled) : c.to;
    }
    return at_zero ? settled : std::max(c.from, settled);
}

}  // namespace

double Excitation::value(double t, const State& state) const {
    return sum_of<Side::at>(components_, t, state);
}

double Excitation::value_before(double t, const State& state) const {
    return sum_of<Side::before>(components_, t, state);
}

double Excitation::value_after(double t, const State& state) const {
    return sum_of<Side::after>(components_, t, state);
}

double Excitation::next_break(double t) const {
    double first = never;
    for (const Component& c : components_) {
        first = std::min(first, model::next_break(c, t));
    }
    return first;
}

double Excitation::constant_from() const {
    double last = -never;
    for (const Component& c : components_) {
        last = std::max(last, model::constant_from(c));
    }
    return last;
}

double Excitation::most() const {
    double sum = 0;
    for (const Component& c : components_) {
        if (c.gain != 0)
            sum += std::fabs(c.gain) * std::visit([](const auto& term) { return terms::most(term); }, c.term);
    }
    return sum;
}

bool Excitation::has_feedback() const {
    return std::any_of(components_.begin(), components_.end(), [](const Component& c) {
        const auto* script = std::get_if<Scripted>(&c.term);
        return script != nullptr && script->feedback;
    });
}

bool Excitation::has_script() const {
    return std::any_of(components_.begin(), components_.end(), is_script);
}

bool Excitation::may_go_on() const {
    return std::all_of(components_.begin(), components_.end(), [](const Component& c) {
        const auto* script = std::get_if<Scripted>(&c.term);
        return script == nullptr || script->function->may_go_on();
    });
}

std::size_t Excitation::fill(std::span<const double> times, std::span<double> out) const {
    std::size_t n = times.size();
    if (script_count(components_) > 1) {
        return fill_in_turn(*this, times, out);
    }
    std::fill_n(out.begin(), n, 0.0);
    for (const Component& c : components_) {
        if (c.gain != 0) {
            n = std::visit([&](const auto& term) { return add(term, c, times.first(n), out.first(n)); }, c.term);
        }
    }
    const auto filled = out.first(n);
    const auto bad = std::find_if(filled.begin(), filled.end(), [](double x) { return !std::isfinite(x); });
    return static_cast<std::size_t>(bad - filled.begin());
}

Excitation Excitation::scaled(double gain) const {
    Excitation result = *this;
    for (Component& c : result.components_) {
        c.gain *= gain;
    }
    return result;
}

Excitation Excitation::delayed(double delay) const {
    Excitation result = *this;
    for (Component& c : result.components_) {
        std::visit([delay](auto& term) { terms::shift(term, delay); }, c.term);
        c.from += delay;
        c.to += delay;
    }
    return result;
}

Excitation Excitation::windowed(double from, double to) const {
    Excitation result = *this;
    for (Component& c : result.components_) {
        c.from = std::max(c.from, from);
        c.to = std::min(c.to, to);
    }
    std::erase_if(result.components_, [](const Component& c) { return !(c.from < c.to); });
    return result;
}

Excitation operator+(Excitation a, const Excitation& b) {
    a.components_.insert(a.components_.end(), b.components_.begin(), b.components_.end());
    return a;
}

}  // namespace dinal::model
