#include "motion/engine/slide.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace dinal::motion::engine {

using Which = Piecewise::Slide::Side;

/// How the motion leaves the surface while the load is that of one side.
Slides::Side Slides::on(Piecewise& function, Which which, const Moment& at) const {
    const std::size_t n = mechanics_.bodies();
    const Which before = std::exchange(function.sliding().asked, which);
    std::vector<double> loads, torques;
    mechanics_.loads_of_time(at.t, at.side, loads);
    mechanics_.torques(at, mode_, std::vector<double>(mechanics_.joints()), loads, torques);
    const Frame& frame = frames_.of(mode_);
    std::vector<double> of_group(frame.groups());
    Side side;
    side.rates.assign(at.y.size(), 0);
    for (std::size_t i = 0; i < n; ++i) {
        for (const auto& [group, by] : frame.bodies[i]) of_group[group] += by * torques[i];
    }
    for (std::size_t i = 0; i < n; ++i) {
        side.rates[i] = at.y[n + i];
        for (const auto& [group, by] : frame.bodies[i]) {
            side.rates[n + i] += by * (of_group[group] / frame.inertia[group]);
        }
    }
    if (mechanics_.states() > 0) mechanics_.rates(at, side.rates.data() + 2 * n, &mode_);
    function.sliding().asked = before;
    std::tie(side.margin, side.rate) = function.margin(at, side.rates);
    return side;
}

bool Slides::drives_back(const Side& own, const Side& beyond) {
    return beyond.rate - own.rate > 1e-9 * (std::fabs(own.rate) + std::fabs(beyond.rate));
}

/// What rounding has moved off the surface comes back.
double Slides::share(Piecewise& function, const Moment& at) const {
    const double back = 4 / unit_;
    const Side own = on(function, Which::own, at), beyond = on(function, Which::beyond, at);
    // Where contacts hold the velocities of the surface, the motion leaves it to one side.
    if (!drives_back(own, beyond)) return own.rate < 0 ? 1 : 0;
    return (own.rate + back * own.margin) / (own.rate - beyond.rate);
}

std::optional<Slides::Sliding> Slides::owner_of(Piecewise& function, double t) const {
    std::optional<Sliding> owner;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        mechanics_.loads()[j].for_each_piecewise(t, [&](Piecewise& each) {
            if (&each == &function) owner = {&function, j};
        });
    }
    if (mechanics_.state_of(function)) owner = {&function, std::nullopt};
    return owner;
}

/// Moves velocities and states the way in which both sides differ.
void Slides::put_on_surface(const Side& own, const Side& beyond, Now& now, double& work) const {
    const std::size_t n = mechanics_.bodies();
    const double by = own.margin / (beyond.rate - own.rate);
    for (std::size_t k = n; k < now.y.size(); ++k) {
        const double change = -by * (beyond.rates[k] - own.rates[k]);
        if (k < 2 * n) work += mechanics_.own_inertia(k - n) * change * (now.y[k] + change / 2);
        now.y[k] += change;
    }
}

std::optional<Slides::Begun> Slides::begin(Piecewise& function, double jump, Now& now) {
    constexpr std::size_t most = 2;    // each asks the others
    constexpr double clearly = 1e-12;  // of the difference between both sides
    constexpr double near = 1e-9;      // part of a time unit
    if (mechanics_.has_belts() || sliding_.size() >= most) return {};
    const auto owner = owner_of(function, now.t.hi);
    if (!owner) return {};
    const Piecewise before = function;
    const auto share_at = [this, &function](const Moment& at) { return share(function, at); };
    const auto no = [&] {
        function = before;
        return std::nullopt;
    };
    const std::size_t n = mechanics_.bodies();
    std::vector<double> one_side = now.y, other_side = now.y;
    const auto apart = [&](std::size_t k, double by) {
        const double away = near * unit_ * by * jump;
        one_side[k] += away, other_side[k] -= away;
    };
    if (owner->joint) {
        for (const auto& [body, by] : mechanics_.system().joints[*owner->joint].of) {
            apart(n + body, by / mechanics_.system().bodies[body].inertia);
        }
    } else {
        apart(2 * n + *mechanics_.state_of(function), 1);
    }
    const Moment here = now.here();
    if (!function.slide({here.t, here.side, one_side}, {here.t, here.side, other_side}, share_at)) return no();
    mode_ = now.mode;
    const Side own = on(function, Which::own, now.here()), beyond = on(function, Which::beyond, now.here());
    // Both rates are those of the margin of one side: there it must fall, and beyond the surface it must rise.
    const double least = clearly * (std::fabs(own.rate) + std::fabs(beyond.rate));
    if (!(own.rate < -least && beyond.rate > least)) return no();
    Begun begun{owner->joint, 0};
    put_on_surface(own, beyond, now, begun.work);
    function.watch_others(now.here(), near * unit_ * std::max(-own.rate, beyond.rate));
    sliding_.push_back(*owner);
    return begun;
}

std::optional<SlideChange> Slides::leave(Piecewise& function, std::size_t condition) {
    const auto found = std::find_if(sliding_.begin(), sliding_.end(),
                                    [&](const Sliding& sliding) { return sliding.function == &function; });
    if (found == sliding_.end()) return {};
    function.leave(condition);
    const SlideChange change{found->joint, false};
    sliding_.erase(found);
    return change;
}

bool Slides::lost(const Moment& here) const {
    return std::any_of(sliding_.begin(), sliding_.end(), [&](const Sliding& sliding) {
        return !drives_back(on(*sliding.function, Which::own, here), on(*sliding.function, Which::beyond, here));
    });
}

std::vector<SlideChange> Slides::end() {
    std::vector<SlideChange> changes;
    for (const Sliding& sliding : sliding_) sliding.function->let_go(), changes.push_back({sliding.joint, false});
    sliding_.clear();
    return changes;
}

}  // namespace dinal::motion::engine
