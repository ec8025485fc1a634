#include "motion/engine/one_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace dinal::motion::engine {

namespace {

/// What a run leaves to the one that goes on from there.
struct Left final : Carried {
    std::shared_ptr<const Carry> carry;
};

class OneBodyLeg final : public Leg {
public:
    explicit OneBodyLeg(const JointLeg& leg) : leg_(leg) {}
    [[nodiscard]] double length() const override { return leg_.length(); }
    [[nodiscard]] double since_start(double t) const override { return leg_.since_start(t); }
    [[nodiscard]] Work work(double since_start) const override { return leg_.work(0, since_start); }

private:
    const JointLeg& leg_;
};

class OneBodyCourse final : public Course {
public:
    OneBodyCourse(const model::Oscillator& system, std::shared_ptr<const History> history)
        : Course(system), history_(std::move(history)) {}
    [[nodiscard]] text::Expected<model::State> at(double t) const override {
        if (t > history_->whole_until()) {
            return text::Error{fmt::format(
                "the motion was kept only up to t = {:.6g}, for lack of memory: ask for rows, or start a run there",
                history_->whole_until())};
        }
        const std::vector<double> y = history_->at(t);
        const auto& walls = system().walls();
        return model::State{walls ? std::clamp(y[0], walls->lower, walls->upper) : y[0], y[1]};
    }
    [[nodiscard]] std::vector<double> states_at(double t) const override {
        const std::vector<double> y = history_->at(t);
        return {y.begin() + 2, y.end()};
    }
    [[nodiscard]] double whole_until() const override { return history_->whole_until(); }
    [[nodiscard]] std::vector<double> piece_ends() const override { return history_->ends(); }
    void legs(const std::function<void(const Leg&)>& told) const override {
        history_->legs([&](const JointLeg& leg) { told(OneBodyLeg(leg)); });
    }
    [[nodiscard]] std::size_t bytes() const override { return history_->bytes(); }

private:
    std::shared_ptr<const History> history_;
};

}  // namespace

model::Assembly assembly_of(const model::Oscillator& system) {
    model::Joint ground;
    ground.stiffness = system.stiffness(), ground.damping = system.damping();
    ground.spring = system.spring(), ground.friction.law = system.friction(), ground.walls = system.walls();
    return {.bodies = {{"", system.inertia()}}, .joints = {ground}, .named = false, .units = {}};
}

Drive drive_of(const model::Excitation& excitation, const model::Extras& extras, const model::State& initial) {
    return {.loads = {excitation},
            .belts = {extras.belt},
            .base = extras.base,
            .states = extras.states,
            .events = extras.events,
            .theta0 = {initial.theta},
            .velocity0 = {initial.velocity}};
}

std::shared_ptr<const Carried> carried_by(const std::shared_ptr<const Carry>& carry) {
    auto carried = std::make_shared<Left>();
    carried->states.assign(carry->y.begin() + 2, carry->y.end());
    carried->carry = carry;
    return carried;
}

Trajectory run(const Problem& problem, const Cut& cut) {
    const model::Assembly system = assembly_of(problem.system);
    const model::Extras& extras = *problem.extras;
    const Drive drive = drive_of(problem.excitation, extras, problem.initial);
    const auto* left = dynamic_cast<const Left*>(problem.carried);
    AssemblyRun run = run_plain({.system = system,
                                 .drive = drive,
                                 .window = problem.window,
                                 .rows = problem.rows,
                                 .monitor = problem.monitor,
                                 .limits = problem.limits,
                                 .before = left != nullptr ? left->carry : nullptr,
                                 .tolerance = cut.tolerance,
                                 .longest = cut.longest,
                                 .step = cut.step,
                                 .keeps_torques = true,
                                 .history_bytes = problem.course_bytes,
                                 .joined_elsewhere = true});
    Trajectory trajectory;
    if (!extras.states.empty()) trajectory.own_names = column_names();
    for (const model::OwnState& state : extras.states) trajectory.own_names.push_back(state.name);
    trajectory.rows = Rows(std::move(run.table));
    trajectory.events = Growing<model::Event>(std::move(run.events));
    trajectory.outcome = run.outcome;
    trajectory.t_start = run.t_start;
    trajectory.t_stop = run.t_stop;
    trajectory.state_at_stop = {run.carry->y[0], run.carry->y[1]};
    trajectory.motion_at_stop = run.motion_at_stop;
    trajectory.began_stuck = run.began_stuck;
    trajectory.rough = run.rough;
    trajectory.located = run.located;
    trajectory.jumps = run.jumps;
    trajectory.noise = run.noise;
    trajectory.gap = run.gap;
    for (const model::WantedEvent& wanted : extras.events) trajectory.event_names.push_back(wanted.name);
    trajectory.carried = carried_by(run.carry);
    if (problem.limits.dense) trajectory.course = std::make_shared<OneBodyCourse>(problem.system, run.history);
    return trajectory;
}

}  // namespace dinal::motion::engine
