// The rules of one contact at velocity zero, by themselves: the razor's edge, the creep, the events of decisions.
#include "motion/contact.hpp"

#include <limits>
#include <vector>

#include "model/event.hpp"
#include "support/catch.hpp"

namespace dinal::contact_test {

namespace {

using namespace dinal::motion::contact;
using model::EventKind;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace

TEST_CASE("a pull at its limit holds, and so does one beyond it by less than the rounding of the angle") {
    const double k = 3, limit = 0.7;
    const auto beyond = [&](double theta) {
        return model::pull_on_spring(limit, k, 0, theta, 0, Motion::backward).beyond;
    };
    CHECK(beyond(0.7 / 3) <= 0);
    CHECK(beyond(0.7 / 3 * (1 + 1e-15)) > 0);
    CHECK(beyond(0.2) < 0);
}

TEST_CASE("a contact that has stopped sticks, turns or slips on, depending on its pull") {
    const Before slid{.slid = Motion::forward};
    const Verdict holds = decide(slid, {0, Motion::backward});
    CHECK(holds.way == Motion::stuck);
    CHECK(holds.told == EventKind::stick);
    const Verdict turns = decide(slid, {0.1, Motion::backward});
    CHECK(turns.way == Motion::backward);
    CHECK(turns.told == EventKind::turn);
    const Verdict goes_on = decide(slid, {0.1, Motion::forward});
    CHECK(goes_on.way == Motion::forward);
    CHECK_FALSE(goes_on.told);
}

TEST_CASE("a contact that held slips beyond its limit; one that was released and holds again sticks") {
    CHECK(decide({.held = true}, {0.1, Motion::forward}).told == EventKind::slip);
    CHECK_FALSE(decide({.held = true}, {-0.1, Motion::forward}).told);
    CHECK(decide({}, {-0.1, Motion::forward}).told == EventKind::stick);
}

TEST_CASE("a creep continues in balance, becomes a slip without an event, and sticks when it is pulled back") {
    const double sliding = 0.5, holding = 0.8, torques = 2;
    const auto within = creeps_within(-0.5, Motion::backward, sliding, holding, torques);
    REQUIRE(within);
    CHECK(*within < 1e-12);
    CHECK_FALSE(creeps_within(-0.5 + 1e-9, Motion::backward, sliding, holding, torques));
    CHECK_FALSE(creeps_within(-0.5, Motion::backward, sliding, sliding, torques));
    const Before crept{.creeps = Motion::backward};
    const auto after = [&](double pull) {
        return decide(crept, pull_on_creep(pull, Motion::backward, sliding, *within));
    };
    CHECK(after(-0.5).creeps);
    const Verdict speeds_up = after(-0.6);
    CHECK(speeds_up.way == Motion::backward);
    CHECK_FALSE(speeds_up.told);
    const Verdict sticks = after(-0.4);
    CHECK(sticks.way == Motion::stuck);
    CHECK(sticks.told == EventKind::stick);
}

TEST_CASE("a stop beyond the limit by rounding is moved to the limit, any other stays where it is") {
    const double k = 4, limit = 0.5, M = 0.1;
    const auto place = [&](double theta) {
        const model::Pull pull = model::pull_on_spring(limit, k, M, theta, 0, Motion::backward);
        return place_at_limit(pull, limit, k, M, theta, 1);
    };
    const double edge = 0.15 * (1 + 100 * epsilon);
    CHECK(place(edge) < edge);
    CHECK(model::pull_on_spring(limit, k, M, place(edge), 0, Motion::backward).beyond <= 0);
    CHECK(place(0.15001) == 0.15001);
    CHECK(place(0.1) == 0.1);
}

TEST_CASE("a stick that the next slip ends at once, under a pull that hardly changed, is withdrawn") {
    const model::Event stick{.t = 1, .kind = EventKind::stick}, slip{.t = 1 + 1e-9, .kind = EventKind::slip};
    const auto events_after = [&](const Released& released) {
        std::vector<model::Event> events{stick};
        if (!only_touched(events, released, 1)) events.push_back(released.slip);
        return events;
    };
    CHECK(events_after({slip, Motion::forward, Motion::forward, 1e-8, 1}).empty());
    const auto turned = events_after({slip, Motion::forward, Motion::backward, 1e-8, 1});
    REQUIRE(turned.size() == 1);
    CHECK(turned[0].kind == EventKind::turn);
    CHECK(events_after({slip, Motion::forward, Motion::forward, 1e-3, 1}).size() == 2);
    CHECK(events_after({slip, Motion::stuck, Motion::forward, 1e-8, 1}).size() == 2);
}

}  // namespace dinal::contact_test
