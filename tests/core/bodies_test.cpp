// Several bodies against a plain time stepping, and at other tolerances.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <random>
#include <string>

#include "model/laws/coulomb.hpp"
#include "motion/engine/run.hpp"
#include "support/catch.hpp"
#include "support/systems.hpp"

namespace dinal::bodies_test {

using namespace dinal::model;
using namespace dinal::motion;
using truth::harmonic;

namespace {

struct Rig {
    System system;
    model::Drive drive;
};

class Lot {
public:
    explicit Lot(unsigned seed) : random_(seed) {}
    double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
    bool chance(double part) { return between(0, 1) < part; }

private:
    std::mt19937 random_;
};

/// Bodies on the ground and in a chain, most of which rub; with Re > Rd in half of the contacts when `sticky`.
Rig random_chain(unsigned seed, bool sticky) {
    Lot lot(seed);
    Rig rig;
    const int n = 2 + static_cast<int>(lot.between(0, 4));
    const auto joint = [&](std::vector<model::Weight> of, double rubs) {
        Joint made;
        made.of = std::move(of);
        if (lot.chance(0.6)) made.stiffness = lot.between(0.5, 10);
        if (lot.chance(0.4)) made.damping = lot.between(0, 0.5);
        if (lot.chance(rubs)) {
            laws::Coulomb law{lot.between(0.1, 1), 0};
            law.breakaway = sticky && lot.chance(0.5) ? law.kinetic * lot.between(1, 1.6) : law.kinetic;
            made.friction.law = law;
        }
        return made;
    };
    for (int i = 0; i < n; ++i) rig.system.bodies.push_back({"b" + std::to_string(i), lot.between(0.3, 3)});
    rig.drive = model::Drive::at_rest(0, 0);
    for (int i = 0; i < n; ++i) {
        rig.system.joints.push_back(joint({{static_cast<std::size_t>(i), 1}}, 0.7));
        const bool driven = lot.chance(0.7);
        rig.drive.loads.push_back(driven ? harmonic(lot.between(0.5, 4), lot.between(0.3, 3), lot.between(0, 6))
                                         : Excitation());
        rig.drive.theta0.push_back(lot.between(-1, 1));
        rig.drive.velocity0.push_back(lot.chance(0.3) ? 0 : lot.between(-1, 1));
    }
    for (int i = 0; i + 1 < n; ++i)
        rig.system.joints.push_back(
            joint({{static_cast<std::size_t>(i), 1}, {static_cast<std::size_t>(i) + 1, -1}}, 0.5));
    rig.drive.belts.resize(rig.system.joints.size());
    return rig;
}

/// A chain that starts at rest, with freewheels, contacts on moving belts, and a gear between three bodies.
Rig random_machine(unsigned seed) {
    Rig rig = random_chain(seed, false);
    Lot lot(seed);
    std::fill(rig.drive.velocity0.begin(), rig.drive.velocity0.end(), 0);
    for (std::size_t j = 0; j < rig.system.joints.size(); ++j) {
        ContactFriction& friction = rig.system.joints[j].friction;
        if (friction.none()) continue;
        if (lot.chance(0.3)) {
            friction.law = laws::Freewheel{lot.chance(0.5) ? 0 : friction.law.sliding(Motion::forward, 0)};
        } else if (lot.chance(0.4)) {
            rig.drive.belts[j] = harmonic(lot.between(0.1, 0.7), lot.between(0.5, 4), 0);
        }
    }
    if (rig.system.bodies.size() > 2 && lot.chance(0.5)) {
        Joint gear;
        gear.of = {{0, 1}, {1, lot.between(0.5, 2)}, {2, -lot.between(0.5, 2)}};
        gear.rigid = true;
        rig.system.joints.push_back(gear);
        rig.drive.belts.emplace_back();
    }
    return rig;
}

Run run(const Rig& rig, double tolerance = 1e-12, double longest = never) {
    const Window window{0, 10};
    const Grid grid = Grid::every(0.25).within(window).value();
    return engine::run({rig.system, rig.drive, window, grid, {}, {}, {}, tolerance, longest});
}

/// Moreau's time stepping: impulses of friction within their bounds, found by going round, and nothing else. It knows
/// no sticking and no events, and is wrong by its step.
Eigen::VectorXd by_time_stepping(const Rig& rig, double end, double dt) {
    const auto n = static_cast<Eigen::Index>(rig.system.bodies.size());
    const std::size_t joints = rig.system.joints.size();
    Eigen::VectorXd q(n), v(n), I(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        q(i) = rig.drive.theta0[k], v(i) = rig.drive.velocity0[k], I(i) = rig.system.bodies[k].inertia;
    }
    const auto difference = [](const Joint& joint, const Eigen::VectorXd& of) {
        double sum = 0;
        for (const auto& [body, weight] : joint.of) sum += weight * of(static_cast<Eigen::Index>(body));
        return sum;
    };
    std::vector<double> impulse(joints, 0);
    const auto push = [&](const Joint& joint, double by, Eigen::VectorXd& velocity) {
        for (const auto& [body, weight] : joint.of) {
            const auto k = static_cast<Eigen::Index>(body);
            velocity(k) += weight * by / I(k);
        }
    };
    for (double t = 0; t < end - dt / 2; t += dt) {
        const Eigen::VectorXd middle = q + dt / 2 * v;
        Eigen::VectorXd next = v;
        for (Eigen::Index i = 0; i < n; ++i) {
            next(i) += dt * rig.drive.loads[static_cast<std::size_t>(i)].value(t + dt / 2) / I(i);
        }
        for (const Joint& joint : rig.system.joints) {
            const double torque = joint.stiffness * difference(joint, middle) + joint.damping * difference(joint, v);
            push(joint, -dt * torque, next);
        }
        for (std::size_t j = 0; j < joints; ++j) push(rig.system.joints[j], impulse[j], next);
        for (int round = 0; round < 1000; ++round) {
            double change = 0;
            for (std::size_t j = 0; j < joints; ++j) {
                const Joint& joint = rig.system.joints[j];
                if (joint.friction.none() && !joint.rigid) continue;
                const double most = joint.rigid ? never : joint.friction.law.sliding(Motion::forward, 0) * dt;
                const double lightness = joint.lightness(rig.system.bodies);
                const double slip = difference(joint, next) - rig.drive.belts[j].value(t + dt);
                const double wanted =
                    std::clamp(impulse[j] - slip / lightness, -most, joint.friction.law.is_one_way() ? never : most) -
                    impulse[j];
                impulse[j] += wanted;
                push(joint, wanted, next);
                change = std::max(change, std::fabs(wanted));
            }
            if (change < 1e-14) break;
        }
        q = middle + dt / 2 * next, v = next;
    }
    return q;
}

/// The same events; those of one moment in any order.
bool alike(const Run& a, const Run& b) {
    const auto same = [](const model::Event& x, const model::Event& y) {
        return x.kind == y.kind && x.where == y.where && std::fabs(x.t - y.t) <= 1e-9;
    };
    return std::is_permutation(a.events.begin(), a.events.end(), b.events.begin(), b.events.end(), same);
}

}  // namespace

TEST_CASE("random chains with friction move the same at another tolerance, and as a plain time stepping computes",
          "[bodies]") {
    struct Group {
        std::vector<unsigned> seeds;
        bool sticky;
        std::size_t judged;  // the first of them: it takes its time
        double dt, near;
    };
    std::vector<unsigned> any(25);
    std::iota(any.begin(), any.end(), 1);
    const Group groups[] = {
        {any, false, 12, 5e-4, 3e-3},
        {any, true, 0, 0, 0},
        // A contact of a loop that comes to its limit leaves the rest to the others.
        {{44, 206, 343, 448, 775, 1144, 10035, 10576, 12635, 13375}, false, 10, 2e-3, 1e-2},
        {{632, 769, 813, 1164, 1230, 1369, 5357, 5370}, true, 0, 0, 0},
    };
    for (const Group& group : groups) {
        for (std::size_t number = 0; number < group.seeds.size(); ++number) {
            CAPTURE(group.seeds[number], group.sticky);
            const Rig rig = random_chain(group.seeds[number], group.sticky);
            const Run found = run(rig), finer = run(rig, 1e-10, 0.05);
            REQUIRE(is_whole(found.outcome));
            REQUIRE(found.size() == finer.size());
            CHECK(alike(found, finer));
            const bool judges = number < group.judged;
            const Eigen::VectorXd judged = judges ? by_time_stepping(rig, 10, group.dt) : Eigen::VectorXd();
            for (std::size_t i = 0; i < rig.system.bodies.size(); ++i) {
                const auto column = static_cast<Eigen::Index>(1 + engine::columns_of_body * i);
                const double theta = found.rows(found.size() - 1, column);
                CHECK(std::fabs(theta - finer.rows(finer.size() - 1, column)) <= 1e-11);
                if (judges) CHECK(std::fabs(theta - judged(static_cast<Eigen::Index>(i))) <= group.near);
            }
        }
    }
}

TEST_CASE("random machines with freewheels, belts and a gear move as a plain time stepping computes", "[bodies]") {
    // Contacts without a torque of their own, held by a gear, a freewheel, or a belt whose velocity passes 0.
    for (const unsigned seed :
         std::initializer_list<unsigned>{1, 2, 3, 4, 323, 355, 460, 561, 1320, 1887, 1888, 3315, 3564, 3594, 4120}) {
        CAPTURE(seed);
        const Rig rig = random_machine(seed);
        const Run found = run(rig);
        CHECK(is_whole(found.outcome));
        const Eigen::VectorXd judged = by_time_stepping(rig, 10, 4e-3);
        for (std::size_t i = 0; i < rig.system.bodies.size(); ++i) {
            const auto column = static_cast<Eigen::Index>(1 + engine::columns_of_body * i);
            CHECK(std::fabs(found.rows(found.size() - 1, column) - judged(static_cast<Eigen::Index>(i))) <= 1e-2);
        }
    }
}

TEST_CASE("the minimum in a box is the free one inside, and lies on the bound that excludes it", "[bodies]") {
    Eigen::MatrixXd G(2, 2);
    G << 2, 1, 1, 3;
    const Eigen::Vector2d g(-3, -4), wide(10, 10), narrow(0.5, 10);
    const Eigen::VectorXd inside = engine::least_in_box(G, g, -wide, wide);
    CHECK((G * inside + g).cwiseAbs().maxCoeff() <= 1e-14);
    const Eigen::VectorXd bound = engine::least_in_box(G, g, -wide, narrow);
    CHECK(bound(0) == 0.5);
    CHECK(std::fabs(bound(1) - (4 - 0.5) / 3) <= 1e-14);
}

}  // namespace dinal::bodies_test
