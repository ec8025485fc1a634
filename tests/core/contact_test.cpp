// The rules of one contact at velocity zero, by themselves: the creep.
#include "motion/contact.hpp"

#include "model/event.hpp"
#include "support/catch.hpp"

namespace dinal::contact_test {

namespace {

using namespace dinal::motion::contact;
using model::EventKind;

}  // namespace

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
    CHECK_FALSE(speeds_up.event);
    const Verdict sticks = after(-0.4);
    CHECK(sticks.way == Motion::stuck);
    CHECK(sticks.event == EventKind::stick);
}

}  // namespace dinal::contact_test
