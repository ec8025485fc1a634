// Why a run with more in it got nowhere: what of all that acts in it is rough on every scale.
#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "motion/hybrid/engine.hpp"
#include "motion/roughness.hpp"

namespace dinal::motion::hybrid {

bool Engine::get_nowhere(model::Outcome outcome) {
    const double most = std::min({pace_, problem_.window.end - now_.hi, field_.shortest_delay()});
    const double from = now_.hi, length = std::min(rough_stretch * pace_, most / 8);
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
        const Roughness look = roughness(source.value, from, length);
        const double part = look.most / (look.size + source.beside);
        if (!look.is_noise() || !(part > worst)) continue;
        worst = part;
        const double by = source.name == "the base" ? look.most / system_.inertia() : look.most;
        rough_ = Rough{source.name, by, part};
        outcome = model::Outcome::unresolved;
    }
    return fail(outcome);
}

}  // namespace dinal::motion::hybrid
