#include "motion/contact.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace dinal::motion::contact {

namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();
/// The rounding that an angle accumulates in a long motion, relative to the torques.
constexpr double rounding_of_way = 1024 * rounding;

}  // namespace

std::optional<double> creeps_within(double pull, Motion way, double sliding, double holding, double torques) {
    if (!(holding > sliding)) return {};
    const double off = std::fabs(model::sign_of(way) * pull - sliding);
    if (!(off <= rounding_of_way * torques)) return {};
    return 2 * off + 64 * rounding * torques;
}

double place_at_limit(const Pull& pull, double limit, double k, double M, double theta, double torques) {
    if (!(pull.beyond > 0) || pull.beyond > rounding_of_way * torques) return theta;
    const double side = model::sign_of(pull.towards);
    double place = (M - side * limit) / k;
    while (model::pull_on_spring(limit, k, M, place, 0, pull.towards).beyond > 0) {
        place = std::nextafter(place, side * std::numeric_limits<double>::infinity());
    }
    return place;
}

std::optional<model::EventKind> event_of(const Before& before, Motion way) {
    using model::EventKind;
    if (before.slid != Motion::stuck) {
        if (way == Motion::stuck) return EventKind::stick;
        return way == before.slid ? std::nullopt : std::optional(EventKind::turn);
    }
    if (before.held) return way == Motion::stuck ? std::nullopt : std::optional(EventKind::slip);
    const bool rests = way == Motion::stuck && before.creeps == Motion::stuck;
    return rests ? std::optional(EventKind::stick) : std::nullopt;
}

Verdict decide(const Before& before, const Pull& pull) {
    const Motion way = pull.beyond > 0 ? pull.towards : Motion::stuck;
    if (before.creeps == Motion::stuck) return {way, event_of(before, way)};
    if (way == Motion::stuck) return {way, {}, true};
    if (way != before.creeps) return {Motion::stuck, model::EventKind::stick};
    return {way, event_of(before, way)};
}

bool only_touched(std::vector<model::Event>& events, const Released& released, double unit) {
    constexpr double briefly = 1e-3, withheld = 64 * rounding;
    if (events.empty() || released.slid == Motion::stuck) return false;
    model::Event& last = events.back();
    const double part = (released.slip.t - last.t) / unit;
    if (last.kind != model::EventKind::stick || last.where != released.slip.where || part > briefly) return false;
    if (!(released.off * (2 * std::numbers::pi * part) <= withheld * released.torques)) return false;
    if (released.way == released.slid) {
        events.pop_back();
    } else {
        last.kind = model::EventKind::turn;
    }
    return true;
}

}  // namespace dinal::motion::contact
