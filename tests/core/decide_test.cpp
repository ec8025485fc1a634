// The decision of contacts at slip 0, by itself: the limits of friction, one joint after the other, and no memory.
#include "motion/engine/decide.hpp"
#include "motion/engine/collocation.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "model/laws/coulomb.hpp"
#include "model/terms/levels.hpp"
#include "support/catch.hpp"

namespace dinal::decide_test {

namespace {

using namespace dinal::motion::engine;
using model::EventKind;
using model::Motion;

model::Excitation constant(double level) {
    return model::Excitation::make(model::Constant{level}).value();
}

/// Blocks at rest at time 0: the first one rubs on the ground, each other one on the one before it.
struct Stack {
    struct Rubs {
        double kinetic, breakaway;
    };
    explicit Stack(const std::vector<Rubs>& contacts) {
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            system.bodies.push_back({"b" + std::to_string(i), i == 0 ? 1.0 : 2.0});
            model::Joint ground;
            ground.of = {{i, 1}};
            if (i == 0) ground.friction.law = model::laws::Coulomb{contacts[0].kinetic, contacts[0].breakaway};
            system.joints.push_back(ground);
        }
        for (std::size_t i = 1; i < contacts.size(); ++i) {
            model::Joint link;
            link.of = {{i, 1}, {i - 1, -1}};
            link.friction.law = model::laws::Coulomb{contacts[i].kinetic, contacts[i].breakaway};
            system.joints.push_back(link);
        }
        drive = model::Drive::at_rest(contacts.size(), system.joints.size());
    }
    model::System system;
    model::Drive drive = model::Drive::at_rest(0, 0);
};

/// Its present, with a constant torque on the last block.
class Present {
public:
    Present(Stack stack, double torque) : stack_(driven(std::move(stack), torque)) {
        const std::size_t joints = mechanics_.joints();
        now.y.assign(mechanics_.size(), 0), now.low.assign(mechanics_.bodies(), 0);
        now.mode.friction.resize(joints), now.mode.leans.assign(joints, 0), now.mode.presses.assign(joints, 0);
        now.mode.rubs = mechanics_.rubbing(), now.mode.rigid.assign(joints, 0);
        now.rigid_at.assign(joints, 0), now.belt_slopes.assign(joints, {0, 0});
        contacts.of.resize(joints);
    }
    Decision decide() {
        Now begin = now;
        Contacts memory = contacts;
        return dinal::motion::engine::decide({mechanics_, frames_, balances_, projection_, last_, room_, 1},
                                             std::move(begin), std::move(memory), {});
    }

    Now now;
    Contacts contacts;

private:
    static Stack driven(Stack stack, double torque) {
        stack.drive.loads[stack.system.bodies.size() - 1] = constant(torque);
        return stack;
    }

    Stack stack_;
    Asking asking_{.named = true, .told = 2 * stack_.system.bodies.size()};
    Mechanics mechanics_{stack_.system, stack_.drive, asking_};
    Frames frames_{mechanics_, 1, 1};
    Conditions conditions_{mechanics_, frames_, asking_.told, 0, 1};
    Collocation solver_{mechanics_, 1e-12, 1};
    Balances balances_{mechanics_, conditions_, solver_};
    Projection projection_{mechanics_, mechanics_.joints()};
    Segment last_{};
    DecisionRoom room_{};
};

std::string kinds(const Decision& made) {
    std::string all;
    for (const Told& told : made.told) all += std::string(all.empty() ? "" : " ") + std::string(name(told.event.kind));
    return all;
}

}  // namespace

TEST_CASE("a block that stops holds up to its breakaway torque, and beyond it turns or slips on") {
    const Stack one({{1, 1.5}});
    for (const double torque : {-1.6, -1.4, 0.0, 1.4, 1.6}) {
        Present present(one, torque);
        present.now.mode.friction[0].way = present.contacts.of[0].arrived = Motion::backward;
        const Decision made = present.decide();
        REQUIRE(made.good);
        const bool slides = std::fabs(torque) > 1.5;
        const Motion way = !slides ? Motion::stuck : torque > 0 ? Motion::forward : Motion::backward;
        CHECK(made.now.mode.friction[0].way == way);
        CHECK(kinds(made) == (!slides ? "stick" : torque > 0 ? "turn" : ""));
        CHECK(made.contacts.of[0].arrived == Motion::stuck);
    }
}

TEST_CASE("of two contacts in a row only the one beyond its limit is released") {
    for (const double torque : {0.7, 0.9, 3.0}) {  // the upper contact holds 0.8
        Present present(Stack({{1, 1.5}, {0.5, 0.8}}), torque);
        const Decision made = present.decide();
        CHECK(made.now.mode.friction[0].way == Motion::stuck);  // it carries 0.5 when the upper one slides
        CHECK(made.now.mode.friction[2].way == (torque > 0.8 ? Motion::forward : Motion::stuck));
        CHECK(kinds(made) == (torque > 0.8 ? "slip" : ""));
    }
}

TEST_CASE("blocks that stick together slip together") {
    Present present(Stack({{1, 1.5}, {5, 5}}), 3);
    const Decision made = present.decide();
    CHECK(made.now.mode.friction[0].way == Motion::forward);
    CHECK(made.now.mode.friction[2].way == Motion::stuck);
    CHECK(kinds(made) == "slip");
}

TEST_CASE("equal states have equal decisions, whatever was decided before") {
    Present present(Stack({{1, 1.5}, {0.5, 0.8}, {0.3, 0.3}}), 0.9);
    const Decision first = present.decide();
    const Now resting = present.now;
    for (Slipping& how : present.now.mode.friction) how.way = Motion::backward;
    for (Contacts::Of& each : present.contacts.of) each.arrived = Motion::backward;
    CHECK(kinds(present.decide()) != kinds(first));
    present.now = resting;
    for (Contacts::Of& each : present.contacts.of) each = {};
    const Decision again = present.decide();
    CHECK(kinds(again) == kinds(first));
    CHECK(again.now.y == first.now.y);
    for (std::size_t j = 0; j < again.now.mode.friction.size(); ++j) {
        CHECK(again.now.mode.friction[j].way == first.now.mode.friction[j].way);
    }
}

}  // namespace dinal::decide_test
