// Why a run with more in it got nowhere: what of all that acts in it is rough on every scale.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "motion/hybrid/engine.hpp"

namespace dinal::motion::hybrid {

namespace {

/// Of three short stretches: how great the last coefficients are at most, and on two of them, and the values.
struct Look {
    double most = 0, usual = 0, size = 0;
};

/// A stretch is this part of the pace. What is as rough on two of them is no jump.
constexpr double short_look = 1e-3, alike = 0.1;

Look look_at(const std::function<double(double)>& source, double from, double length) {
    Look look;
    std::array<double, 3> tails{};
    std::size_t stretch = 0;
    for (const double begin : {0.0, 2.0, 5.0}) {
        Nodes values{};
        for (std::size_t j = 0; j < node_count; ++j) {
            values[j] = source(from + length * (begin + (1 + cheb::nodes[j]) / 2));
            if (!std::isfinite(values[j])) return {};
        }
        tails.at(stretch++) = cheb::tail(cheb::fit(values));
        look.size = std::max(look.size, greatest(values));
    }
    std::sort(tails.begin(), tails.end());
    look.usual = tails[1], look.most = tails[2];
    return look;
}

}  // namespace

bool Engine::get_nowhere(model::Outcome outcome) {
    const double most = std::min({pace_, problem_.window.end - now_.hi, field_.shortest_delay()});
    const double from = now_.hi, length = std::min(short_look * pace_, most / 8);
    const double torques = system_.greatest_holding() + system_.stiffness() * std::fabs(theta());
    Values rates(y_.size());
    const auto now_at = [&](double t) {
        return MotionPoint{t, Side::at, {theta(), y_[1]}, {y_.data() + 2, y_.size() - 2}};
    };
    struct Source {
        std::string name;
        std::function<double(double)> value;
        double beside;  ///< how great is what it is added to
    };
    std::vector<Source> sources{{"M", [&](double t) { return field_.load(now_at(t)); }, torques},
                                {"the base", [&](double t) { return field_.push(t, Side::at); }, torques},
                                {"the belt", [&](double t) { return field_.belt(t, Side::at); }, 0}};
    for (std::size_t i = 0; i < extras_.states.size(); ++i) {
        const auto rate = [this, i, now_at, &rates](double t) {
            field_.rates(now_at(t), rates.data() + 2);
            return rates[2 + i];
        };
        sources.push_back({"the rate of " + extras_.states[i].name, rate, 0});
    }
    double worst = 64 * rounding;
    for (const Source& source : sources) {
        const Look look = look_at(source.value, from, length);
        const double part = look.most / (look.size + source.beside);
        if (!(look.usual > alike * look.most) || !(part > worst)) continue;
        worst = part;
        const double by = source.name == "the base" ? look.most / system_.inertia() : look.most;
        rough_ = Rough{source.name, by, part};
        outcome = model::Outcome::unresolved;
    }
    return fail(outcome);
}

}  // namespace dinal::motion::hybrid
