#include "motion/engine/part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

namespace dinal::motion::engine {

namespace {

class PartLeg final : public Leg {
public:
    PartLeg(const JointLeg& leg, std::size_t joint) : leg_(leg), joint_(joint) {}
    [[nodiscard]] double length() const override { return leg_.length(); }
    [[nodiscard]] double since_start(double t) const override { return leg_.since_start(t); }
    [[nodiscard]] Work work(double since_start) const override { return leg_.work(joint_, since_start); }

private:
    const JointLeg& leg_;
    std::size_t joint_;
};

/// Computes the state of a joint from that of its bodies.
struct Place {
    std::size_t bodies, joint;
    model::Joint weights;

    Place(const model::System& system, std::size_t which) : bodies(system.bodies.size()), joint(which) {
        weights.of = system.joints[which].of;
    }
    [[nodiscard]] model::State state(const std::vector<double>& y) const {
        return {weights.sum(y), weights.sum(std::span(y).subspan(bodies))};
    }
};

class PartCourse final : public Course {
public:
    PartCourse(const model::Oscillator& seen, const Place& place, std::size_t states, const Run& run)
        : Course(seen), place_(place), states_(states), t_start_(run.t_start), history_(run.history) {}
    [[nodiscard]] text::Expected<model::State> at(double t) const override {
        if (t > history_->whole_until()) {
            return text::Error{fmt::format(
                "the motion was kept only up to t = {:.6g}, for lack of memory: ask for rows, or start a run there",
                history_->whole_until())};
        }
        model::State state = place_.state(history_->at(t));
        // Near a wall the stored motion has a rounding error.
        if (const auto& walls = system().walls()) state.theta = std::clamp(state.theta, walls->lower, walls->upper);
        return state;
    }
    [[nodiscard]] std::vector<double> states_at(double t) const override {
        const std::vector<double> y = history_->at(t);
        const auto first = y.begin() + static_cast<std::ptrdiff_t>(2 * place_.bodies);
        return {first, first + static_cast<std::ptrdiff_t>(states_)};  // the states of bristles follow
    }
    [[nodiscard]] double whole_until() const override { return history_->whole_until(); }
    [[nodiscard]] std::vector<double> piece_ends() const override { return history_->ends(); }
    void legs(const std::function<void(const Leg&)>& visit) const override {
        history_->legs_since(t_start_, [&](const JointLeg& leg) { visit(PartLeg(leg, place_.joint)); });
    }
    [[nodiscard]] std::size_t bytes() const override { return history_->bytes(); }

private:
    Place place_;
    std::size_t states_;
    double t_start_;
    std::shared_ptr<const History> history_;
};

model::Motion way_at_stop(const Mode& mode, std::size_t joint) {
    if (mode.holds(joint)) return model::Motion::stuck;
    return mode.rubs[joint] != 0 ? mode.friction[joint].way : model::Motion::forward;
}

bool rubs(const model::Joint& joint) {
    return !joint.friction.none() && joint.friction.bristle() == nullptr;
}

/// Returns whether every turn of the joint's angle is an event. Not on a belt, nor without own dry friction if its
/// bodies rub elsewhere; an impact at another joint may also reverse this one.
bool turns_are_events(const model::System& system, const model::Drive& drive, std::size_t joint) {
    if (!drive.belts[joint].components().empty()) return false;
    const model::Joint& own = system.joints[joint];
    return std::all_of(system.joints.begin(), system.joints.end(), [&](const model::Joint& other) {
        if (&other == &own) return rubs(own) || !system.is_link(joint);
        const bool touches = other.is_on(own.first());
        return !other.walls && (rubs(own) || !(touches && rubs(other)));
    });
}

}  // namespace

Trajectory part_of(const model::System& system, const model::Drive& drive, const Run& run, std::size_t joint,
                   const std::optional<model::Oscillator>& seen) {
    const Place place(system, joint);
    Trajectory part;
    if (system.is_link(joint)) {
        part.own_names = {"t", "theta", "velocity", "torque", "friction"};
    } else if (!drive.states.empty() || system.bodies[joint].moved) {
        part.own_names = column_names();
        if (system.bodies[joint].moved) part.own_names.emplace_back("torque");
    }
    for (const model::OwnState& state : drive.states) part.own_names.push_back(state.name);
    const auto left = std::make_shared<Left>(run.carry, place.bodies);
    left->states.resize(drive.states.size());  // drops the states of bristles
    part.carried = left;
    std::vector<model::Event> events;
    for (const model::Event& e : run.events) {
        if (e.where == static_cast<int>(joint)) events.push_back(e);
    }
    part.events = Growing<model::Event>(std::move(events));
    for (const model::WantedEvent& wanted : drive.events) part.event_names.push_back(wanted.name);
    part.outcome = run.outcome;
    part.contradiction = run.contradiction;
    part.rough = run.rough;
    part.gap = run.gap;
    part.unproven = run.unproven;
    part.noise = run.noise;
    part.jumps = run.jumps;
    part.located = run.located;
    part.t_start = run.t_start;
    part.t_stop = run.t_stop;
    part.initial = {place.weights.sum(drive.theta0), place.weights.sum(drive.velocity0)};
    if (system.has_moved()) part.initial = place.state(run.initial);
    part.state_at_stop = place.state(run.carry->y);
    part.motion_at_stop = joint == 0 ? run.motion_at_stop : way_at_stop(run.carry->mode, joint);
    part.began_stuck = run.begun.holds(joint);
    part.began_open = rubs(system.joints[joint]) && run.begun.rubs[joint] == 0;
    part.on_belt = !turns_are_events(system, drive, joint);
    if (const auto& walls = system.joints[joint].walls) part.restitution = walls->restitution;
    if (system.joints[joint].stops) part.restitution = -1;  // at an elastic wall the velocity continues
    if (seen) part.course = std::make_shared<PartCourse>(*seen, place, drive.states.size(), run);
    return part;
}

Trajectory part_with_rows(const model::System& system, const model::Drive& drive, const Run& run, std::size_t joint,
                          const std::optional<model::Oscillator>& seen) {
    Trajectory part = part_of(system, drive, run, joint, seen);
    if (part.rough) part.rough->other_integrators = false;
    part.computed = !system.is_link(joint);
    const std::vector<std::string> all = column_names_of(system, drive);
    const std::vector<std::string>& names = part.names();
    const std::size_t rows = run.table.size();
    Growing<double> table(rows, names.size());
    for (std::size_t c = 0; c < names.size(); ++c) {
        const bool own = c > 0 && c < part.first_state() && system.named;
        const auto place =
            std::find(all.begin(), all.end(), own ? system.joints[joint].name + "." + names[c] : names[c]);
        const auto from = run.table.column(static_cast<std::size_t>(place - all.begin()));
        std::copy(from.begin(), from.end(), table.writable() + c * rows);
    }
    part.rows = Rows(std::move(table));
    return part;
}

}  // namespace dinal::motion::engine
