#include "motion/engine/balance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/contact.hpp"

namespace dinal::motion::engine {

using model::Motion;

std::optional<double> SampledLoads::at(std::size_t body, double x) {
    if (!(x > -1) || !mechanics_.loads()[body].is_sampled() || mechanics_.has_base()) return {};
    if (series_.empty()) {
        for (const Nodes& load : segment_.loads) series_.push_back(cheb::fit(load));
    }
    return cheb::value(series_[body], x);
}

Balances::Balances(const Mechanics& mechanics, Conditions& conditions, const Flow& solver)
    : mechanics_(mechanics), conditions_(conditions), solver_(solver) {
    has_feedback_ = std::any_of(mechanics.loads().begin(), mechanics.loads().end(),
                                [](const Signal& load) { return load.depends_on_motion(); });
    for (std::size_t j = 0; j < mechanics.joints(); ++j) has_feedback_ |= mechanics.spring_may_jump(j);
    for (const model::Body& body : mechanics.system().bodies) inertia_ += body.inertia;
    belts_.assign(mechanics.joints(), 0), rates_ = belts_, offsets_.assign(mechanics.bodies(), 0);
}

bool Balances::at_present(const Moment& at, const Now& now, const Mode& mode, const Frame& frame, const Segment& last,
                          Balance& result) {
    if (!at.freely) conditions_.decide(at, mode, last);
    result.blurred = 0;
    const auto rate = [&](std::size_t j) {
        const BeltSlope slope = now.belt_slopes[j];
        result.blurred = std::max(result.blurred, inertia_ * slope.doubt);
        return slope.rate;
    };
    return find(
        at, mode, frame, rate, [](std::size_t) { return std::optional<double>(); }, result);
}

bool Balances::on_stretch(const Segment& segment, double x, const Moment& at, const Mode& mode, const Frame& frame,
                          Balance& result, SampledLoads* sampled) {
    result.blurred = mechanics_.has_belts() ? solver_.blurred_by_belts(segment) : 0;
    const auto rate = [&](std::size_t j) { return cheb::value(cheb::fit(segment.belt_rates[j]), x); };
    const auto known = [&](std::size_t i) { return sampled != nullptr ? sampled->at(i, x) : std::nullopt; };
    return find(at, mode, frame, rate, known, result);
}

namespace {

/// Sets all values to 0, and avoids the call of resize if the size is right.
void clear(std::vector<double>& values, std::size_t size) {
    if (values.size() != size) values.resize(size);
    std::fill(values.begin(), values.end(), 0.0);
}

}  // namespace

template <class Rate, class Known>
bool Balances::find(const Moment& at, const Mode& mode, const Frame& frame, const Rate& rate, const Known& known,
                    Balance& result) {
    const std::size_t joints = mechanics_.joints(), n = mechanics_.bodies();
    for (std::size_t j = 0; j < joints && mechanics_.has_belts(); ++j) {
        belts_[j] = mechanics_.belt(j, at.t, at.side);
        if (mechanics_.has_belt(j)) rates_[j] = rate(j);
    }
    mechanics_.loads_of_time(at.t, at.side, result.loads, known);
    mechanics_.torques(at, mode, belts_, result.loads, result.torques);
    if (mechanics_.has_belts()) frame.offsets(rates_, mode, offsets_);
    clear(of_group_, frame.groups()), clear(lacking_, n);
    for (std::size_t i = 0; i < n; ++i) {
        const double own = mechanics_.system().bodies[i].inertia * offsets_[i];
        for (const auto& [group, by] : frame.bodies[i]) of_group_[group] += by * (result.torques[i] - own);
    }
    clear(result.accelerations, n);
    bool good = true;
    for (std::size_t i = 0; i < n; ++i) {
        result.accelerations[i] = offsets_[i];
        for (const auto& [group, by] : frame.bodies[i]) {
            result.accelerations[i] += by * (of_group_[group] / frame.inertia[group]);
        }
        lacking_[i] = mechanics_.system().bodies[i].inertia * result.accelerations[i] - result.torques[i];
        good = good && std::isfinite(lacking_[i]);
    }
    clear(result.holding, joints);
    frame.multipliers(lacking_, result.holding);
    return good;
}

std::vector<double> slip_alone(const Mechanics& mechanics, Mode mode, std::size_t joint) {
    const std::size_t n = mechanics.bodies();
    mode.leans[joint] = 0;
    mode.friction[joint] = {.way = model::Motion::forward};
    const Frame frame(mechanics.system(), mode);
    std::vector<double> of_group(frame.groups()), slip(n);
    double lightness = 0;
    for (const auto& [group, by] : frame.joints[joint]) {
        of_group[group] += by / frame.inertia[group];
        lightness += by * by / frame.inertia[group];
    }
    if (lightness == 0) {
        for (const auto& [body, by] : mechanics.system().joints[joint].of) slip[body] = by;
        return slip;
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (const auto& [group, by] : frame.bodies[i]) slip[i] += by * of_group[group] / lightness;
    }
    return slip;
}

Moment just_beside(const Moment& at, const std::vector<double>& slip, const Nearby& there, std::vector<double>& y) {
    y.assign(at.y.begin(), at.y.end());
    const auto move = [](double& value, double by, double amount) {
        if (by == 0) return;
        constexpr double least = std::numeric_limits<double>::min();
        value += std::copysign(std::max({4 * rounding * std::fabs(value), std::fabs(by) * amount, least}), by);
    };
    for (std::size_t i = 0; i < slip.size(); ++i) {
        move(y[i], model::sign_of(there.side) * slip[i], there.far);
        move(y[slip.size() + i], model::sign_of(there.way) * slip[i], there.speed);
    }
    constexpr double clearly = 1e3;
    return {at.t, at.side, y, true, there.speed > 0 ? clearly * std::max(there.speed, there.gained) : model::never};
}

double excess(const Mechanics& mechanics, std::size_t joint, const Balance& balance, const Mode& mode, const Moment& at,
              Motion& towards) {
    if (mode.rigid[joint] != 0) return -model::never;
    const double pull = -balance.holding[joint] * known_part(mechanics);
    if (const int wall = mode.leans[joint]; wall != 0) {
        towards = wall > 0 ? Motion::backward : Motion::forward;
        const bool sticks = mode.rubs[joint] != 0 && mode.friction[joint].way == Motion::stuck;
        return -wall * pull - (sticks ? mechanics.holding(joint, towards, at) : 0) - mode.friction[joint].margin;
    }
    if (const Slipping& how = mode.friction[joint]; how.creeps != Motion::stuck) {
        const double sliding = mechanics.sliding(joint, {.way = how.creeps}, 0, at);
        const model::Pull off = contact::pull_on_creep(pull, how.creeps, sliding, how.apart);
        towards = off.towards;
        return off.beyond;
    }
    towards = pull > 0 ? Motion::forward : Motion::backward;
    const double holding = mechanics.limit_at_rest(joint, mode, towards, at) + mode.friction[joint].margin;
    if (std::isinf(holding)) {  // a freewheel only leaves forward
        towards = Motion::forward;
        return pull - balance.blurred - mechanics.limit_at_rest(joint, mode, towards, at) - mode.friction[joint].margin;
    }
    if (mechanics.bodies() > 1 || !mechanics.is_native(joint) || mechanics.has_belts() || mechanics.states() > 0 ||
        mode.presses[joint] != 0) {
        return std::fabs(pull) - balance.blurred - holding;
    }
    const model::Joint& own = mechanics.system().joints[joint];
    const double theta = at.y[0], spring = own.spring.torque(theta);
    return model::pull_on_spring(holding, own.stiffness, balance.loads[0], theta, spring, towards).beyond;
}

}  // namespace dinal::motion::engine
