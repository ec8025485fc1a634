#include "motion/engine/part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

namespace dinal::motion::engine {

namespace {

class PartLeg final : public Leg {
public:
    PartLeg(const JointLeg& leg, std::size_t joint) : leg_(leg), joint_(joint) {}
    double length() const override { return leg_.length(); }
    double since_start(double t) const override { return leg_.since_start(t); }
    Work work(double since_start) const override { return leg_.work(joint_, since_start); }

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
    model::State state(const std::vector<double>& y) const {
        return {weights.sum(y), weights.sum(std::span(y).subspan(bodies))};
    }
};

class PartCourse final : public Course {
public:
    PartCourse(const model::Oscillator& seen, const Place& place, std::size_t states, const Run& run)
        : Course(seen), place_(place), states_(states), t_start_(run.t_start), history_(run.left->history) {}
    text::Expected<model::State> at(double t) const override {
        if (t > history_->whole_until()) {
            return text::error(
                "the motion was kept only up to t = {:.6g}, for lack of memory: ask for rows, or start a run there",
                history_->whole_until());
        }
        model::State state = place_.state(history_->at(t));
        // Near a wall the stored motion has a rounding error.
        if (const auto& walls = system().walls()) state.theta = std::clamp(state.theta, walls->lower, walls->upper);
        return state;
    }
    std::vector<double> states_at(double t) const override {
        const std::vector<double> y = history_->at(t);
        const auto first = y.begin() + static_cast<std::ptrdiff_t>(2 * place_.bodies);
        // the bristles' states come last and are left out
        return {first, first + static_cast<std::ptrdiff_t>(states_)};
    }
    double whole_until() const override { return history_->whole_until(); }
    std::vector<double> piece_ends() const override { return history_->ends(); }
    void legs(const std::function<void(const Leg&)>& visit) const override {
        history_->legs_since(t_start_, [&](const JointLeg& leg) { visit(PartLeg(leg, place_.joint)); });
    }
    std::size_t bytes() const override { return history_->bytes(); }

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
    return !joint.friction.none() && joint.friction.bending() == nullptr;
}

/// Returns whether every turn of the joint's angle is an event. This fails on a belt, or for a body without dry
/// friction of its own that rubs elsewhere, as an impact at another joint may also reverse it.
bool turns_are_events(const model::System& system, const model::Drive& drive, std::size_t joint) {
    if (!drive.belts[joint].components().empty()) return false;
    const model::Joint& own = system.joints[joint];
    return std::all_of(system.joints.begin(), system.joints.end(), [&](const model::Joint& other) {
        if (&other == &own) return rubs(own) || !system.is_link(joint);
        const bool touches = other.is_on(own.first());
        return !other.walls && (rubs(own) || !(touches && rubs(other)));
    });
}

/// The names of a joint's columns, without the joint's name.
std::vector<std::string> names_at(const model::System& system, const model::Drive& drive, std::size_t joint) {
    const auto columns = columns_of(system.is_link(joint));
    std::vector<std::string> names;
    names.reserve(columns.size() + 1 + drive.states.size());
    for (const ColumnKind& kind : columns) names.emplace_back(kind.name);
    if (!system.is_link(joint) && system.bodies[joint].moved) names.emplace_back(column::torque.name);
    for (const model::OwnState& state : drive.states) names.push_back(state.name);
    return names;
}

/// The rows of a joint's columns, followed by the acceleration of a body if the run has a column of it.
Rows rows_at(const model::System& system, const Run& run, std::size_t joint, const std::vector<std::string>& names,
             std::size_t states) {
    const std::size_t rows = run.rows.table().size(), acceleration = run.names().size() + joint;
    const std::size_t more = !system.is_link(joint) && acceleration < run.rows.table().columns() ? 1 : 0;
    Growing<double> table(rows, names.size() + more);
    double* to = table.writable_values();
    const auto copy = [&](std::size_t column) {
        const auto from = run.rows.table().column(column);
        to = std::copy(from.begin(), from.end(), to);
    };
    for (std::size_t c = 0; c < names.size(); ++c) {
        const bool own = c > 0 && c + states < names.size();
        copy(static_cast<std::size_t>(run.find(own ? system.joints[joint].name + "." + names[c] : names[c]).value()));
    }
    if (more > 0) copy(acceleration);
    return Rows(std::move(table));
}

/// Fills in a joint's view of a run: the members from `initial` on.
void fill_view(Run& run, const model::System& system, const model::Drive& drive, std::size_t joint,
               const std::optional<model::Oscillator>& seen) {
    const Left& left = *run.left;
    const Place place(system, joint);
    run.initial = {place.weights.sum(drive.theta0), place.weights.sum(drive.velocity0)};
    if (system.has_moved()) run.initial = place.state(left.start);
    run.state_at_stop = place.state(left.carry->y);
    if (joint > 0) run.motion_at_stop = way_at_stop(left.carry->mode, joint);
    run.began_stuck = left.begun.holds(joint);
    run.began_open = rubs(system.joints[joint]) && left.begun.rubs[joint] == 0;
    run.on_belt = !turns_are_events(system, drive, joint);
    if (const auto& walls = system.joints[joint].walls) run.restitution = walls->restitution;
    if (system.joints[joint].stops) run.restitution = -1;  // an elastic wall does not change the velocity
    if (seen) run.course = std::make_shared<PartCourse>(*seen, place, drive.states.size(), run);
}

}  // namespace

void complete(Run& run, const model::System& system, const model::Drive& drive,
              const std::optional<model::Oscillator>& seen) {
    if (system.named || !drive.states.empty()) run.own_names = column_names_of(system, drive);
    run.states = drive.states.size();
    for (const model::WantedEvent& wanted : drive.events) run.event_names.push_back(wanted.name);
    fill_view(run, system, drive, 0, seen);
}

Run part_of(const model::System& system, const model::Drive& drive, const Run& run, std::size_t joint,
            const std::optional<model::Oscillator>& seen) {
    Run part = run;
    part.own_names = names_at(system, drive, joint);
    part.rows = rows_at(system, run, joint, part.own_names, drive.states.size());
    std::vector<model::Event> events;
    std::copy_if(run.events.begin(), run.events.end(), std::back_inserter(events),
                 [joint](const model::Event& e) { return e.where == static_cast<int>(joint); });
    part.events = Growing<model::Event>(std::move(events));
    part.computed = !system.is_link(joint);
    fill_view(part, system, drive, joint, seen);
    return part;
}

Run run(const Problem& problem, const Cut& cut) {
    const model::System system = model::as_system(problem.system);
    const model::Drive& drive = problem.drive;
    Run run = run_plain({.system = system,
                         .drive = drive,
                         .window = problem.window,
                         .rows = problem.rows,
                         .monitor = problem.monitor,
                         .limits = problem.limits,
                         .before = problem.left != nullptr ? problem.left->carry : nullptr,
                         .tolerance = cut.tolerance,
                         .longest = cut.longest,
                         .step = cut.step,
                         .pair = cut.pair,
                         .keeps_torques = true,
                         .history_bytes = problem.course_bytes,
                         .joined_elsewhere = true});
    complete(run, system, drive, problem.limits.dense ? std::optional(problem.system) : std::nullopt);
    return run;
}

}  // namespace dinal::motion::engine
