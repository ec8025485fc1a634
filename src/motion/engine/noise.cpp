#include "motion/engine/noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/chebyshev.hpp"
#include "motion/engine/unseen.hpp"

namespace dinal::motion::engine {

Roughness roughness(const std::function<double(double)>& function, const std::array<double, 3>& starts, double length) {
    namespace cheb = chebyshev;
    Roughness found;
    std::array<double, 3> tails{};
    std::size_t stretch = 0;
    for (const double start : starts) {
        cheb::Samples values{};
        for (std::size_t j = 0; j < cheb::points; ++j) {
            values[j] = function(start + length * (1 + cheb::nodes[j]) / 2);
            if (!std::isfinite(values[j])) return {};
            found.size = std::max(found.size, std::fabs(values[j]));
        }
        tails.at(stretch++) = cheb::tail(cheb::fit(values));
    }
    std::sort(tails.begin(), tails.end());
    found.usual = tails[1], found.most = tails[2];
    return found;
}

namespace {

constexpr double most_noise_of_rate = 64;  // multiple of the tolerance; a rougher rate ends the run with a message

}  // namespace

Noise::Noise(const Mechanics& mechanics) : mechanics_(mechanics) {
    const std::size_t n = mechanics.bodies(), all = n + mechanics.states();
    floor_.noise.resize(all), floor_.greatest.resize(all), stalled_.resize(all);
    tolerated_.assign(all, 0), found_on_.assign(all, model::never);
    may_be_rough_.assign(all, 0);
    std::fill(may_be_rough_.begin() + static_cast<std::ptrdiff_t>(n), may_be_rough_.end(), 1);
    for (std::size_t j = 0; j < mechanics.joints(); ++j) {
        const model::Joint& joint = mechanics.system().joints[j];
        if (!mechanics.loads()[j].samples_functions() && joint.spring.none() && joint.friction.is_constant() &&
            !joint.friction.law.depends_on_speed())
            continue;
        for (const model::Weight& weight : joint.of) may_be_rough_[weight.body] = 1;
    }
}

void Noise::note_resolved(const Segment& s) {
    for (std::size_t k = 0; k < may_be_rough_.size(); ++k) {
        if (may_be_rough_[k] == 0) continue;
        floor_.greatest[k] = std::max(floor_.greatest[k], greatest(acting(s, k)));
        // Noise found in a short pulse does not belong to the motion after it.
        constexpr double much_longer = 16, far_below = 1.0 / 64;
        double& noise = floor_.noise[k];
        if (!(noise > 0) || !(s.h > much_longer * found_on_[k])) continue;
        const double tail = cheb::tail(cheb::fit(acting(s, k)));
        if (tail < far_below * noise) noise = 2 * tail, found_on_[k] = s.h;
    }
}

double Noise::notable(double tolerance) const {
    double most = 0;
    for (std::size_t i = 0; i < mechanics_.bodies(); ++i) {
        const double noise = std::max(tolerated_[i], floor_.noise[i]);
        if (noise > tolerance * floor_.greatest[i]) most = std::max(most, noise);
    }
    return most;
}

bool Noise::found(const Segment& s, const Mode& mode, double tolerance, const std::vector<double>& sizes,
                  Proofs& proofs) {
    const Unresolved stretch{s, mode, tolerance, sizes, proofs};
    std::vector<double> known;
    bool any = false;
    for (std::size_t i = 0; i < may_be_rough_.size(); ++i) {
        if (may_be_rough_[i] == 0) continue;
        const auto noise = measured(i, stretch, known);
        if (!noise) continue;
        floor_.noise[i] = *noise, found_on_[i] = s.h, tolerated_[i] = std::max(tolerated_[i], *noise);
        any = true;
    }
    return any;
}

/// Returns the torque on a body, or its load alone if `of_time`, or the rate of a state.
double Noise::value(std::size_t of, bool of_time, const Unresolved& stretch, double t) const {
    const std::size_t n = mechanics_.bodies();
    std::vector<double> y, loads, belts(mechanics_.joints()), torques, rates(mechanics_.states());
    stretch.segment.state(stretch.segment.start.until(t) / stretch.segment.h - 1, y);
    const Moment at{t, Side::at, y};
    if (of >= n) {
        mechanics_.rates(at, rates.data(), &stretch.mode);
        return rates[of - n];
    }
    mechanics_.loads_of_time(t, Side::at, loads);
    if (of_time) return loads[of];
    for (std::size_t joint = 0; joint < belts.size(); ++joint) belts[joint] = mechanics_.belt(joint, t, Side::at);
    mechanics_.torques(at, stretch.mode, belts, loads, torques);
    return torques[of];
}

/// Returns the noise of a body's torque or a state's rate if the stretch shows more than is known. `known` receives the
/// rounding of formulas when it is first needed.
std::optional<double> Noise::measured(std::size_t i, const Unresolved& stretch, std::vector<double>& known) {
    constexpr double stays = 0.3, alike = 0.1, varies = 8, above = 3, few_roundings = 16;
    constexpr double of_numbers = 64 * rounding;
    const Segment& s = stretch.segment;
    const std::size_t n = mechanics_.bodies();
    const double of_all = cheb::tail(cheb::fit(acting(s, i)));
    const bool of_time = i < n && mechanics_.loads()[i].samples_functions() &&
                         !mechanics_.loads()[i].depends_on_motion() && 2 * cheb::tail(cheb::fit(s.driven[i])) >= of_all;
    const Nodes& values = of_time ? s.driven[i] : acting(s, i);
    const double tail = of_time ? cheb::tail(cheb::fit(values)) : of_all;
    const Stalled before = std::exchange(stalled_[i], {s.start.hi, s.h, tail});
    const double size = i < n ? stretch.sizes[i] : greatest(values);
    // When a motion decays, the rounding of the terms in its torques remains.
    const double ever = std::max(greatest(values), floor_.greatest[i]);
    const double most = of_time ? most_noise * size
                        : i < n ? most_noise_of_motion * ever
                                : most_noise_of_rate * stretch.tolerance * ever;
    const double noise = floor_.noise[i];
    // A motion that leaves its rest is judged by the rounding of its torques.
    if (!(tail > std::min(stretch.tolerance, few_roundings * rounding) * size)) return {};
    // The motion may be negligible against the numbers that its functions calculate with.
    const auto is_rounding = [&] {
        if (known.empty()) known = stretch.proofs.roundings(s, stretch.mode);
        return tail <= few_roundings * known[i] && noise < 2 * tail;
    };
    const auto here = [&](double t) { return value(i, of_time, stretch, t); };
    const bool stalls = before.from == s.start.hi && s.h < 0.95 * before.h && tail > stays * before.tail;
    // A function that is not a formula may calculate with numbers about 1, however small the motion is, and then rounds
    // in steps of that size everywhere.
    const auto is_hidden = [&] {
        if (!stalls || tail > of_numbers || noise >= 2 * tail) return false;
        return tail <= rounding ||
               roughness(here, {s.time(-0.9), s.time(-0.2), s.time(0.5)}, 0.4 * s.h).usual > alike * tail;
    };
    if (!(tail <= most)) {
        if (is_rounding()) return std::max(2 * tail, known[i]);
        return is_hidden() ? std::optional(above * tail) : std::nullopt;
    }
    if (noise > 0 && 2 * tail <= noise) return {};
    if (!stalls) return {};  // otherwise a stretch that is only too long would raise the noise again and again
    if (noise > 0 && tail <= varies * noise) return 2 * tail;
    // Rounding also has steps, between which short stretches are smooth. A function that is not a formula may round
    // like the greatest value so far.
    if (tail <= rounding * ever || is_rounding()) return std::max(2 * tail, known.empty() ? 0 : known[i]);
    const Roughness rough = roughness(here, {s.time(-0.9), s.time(0.1), s.time(0.8)}, rough_stretch * 2 * s.h);
    if (!(rough.usual > alike * tail)) return {};
    return above * std::max(tail, rough.most);
}

}  // namespace dinal::motion::engine
