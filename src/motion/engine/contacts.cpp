#include "motion/engine/contacts.hpp"

#include <algorithm>
#include <cmath>

namespace dinal::motion::engine {

using model::Motion;

void Contacts::slide(const Mechanics& mechanics, Now& now, std::size_t joint, Motion way, bool leaving) {
    Slipping& how = now.mode.friction[joint];
    how.way = way, how.leaving = leaving, how.riding = false, how.beside = 0, how.driven_back = false,
    how.creeps = Motion::stuck;
    of[joint].edge = 0;
    const model::Friction& law = mechanics.system().joints[joint].friction.law;
    if (law.ranges() > 0) {
        const double speed = leaving ? 0 : std::max(0.0, model::sign_of(way) * now.slip(mechanics, joint));
        how.range = mechanics.range_of(joint, speed);
        if (speed > 0 && law.range(how.range).from == speed) of[joint].edge = -1;
    }
}

void Projection::apply(Now& now, const Frame& frame, Side when) {
    if (frame.edges.empty()) return;
    const model::System& system = mechanics_.system();
    const std::size_t n = system.bodies.size();
    if (mechanics_.has_belts()) {
        belts_.resize(mechanics_.joints());
        for (std::size_t j = 0; j < belts_.size(); ++j) belts_[j] = mechanics_.belt(j, now.t.hi, when);
        frame.offsets(belts_, now.mode, offsets_);
    }
    momentum_.assign(frame.groups(), 0), first_.resize(frame.groups());
    seen_.assign(frame.groups(), 0), alike_.assign(frame.groups(), 1);
    for (std::size_t i = 0; i < n; ++i) {
        const double v = now.y[n + i] - offsets_[i];
        for (const auto& [group, by] : frame.bodies[i]) {
            momentum_[group] += by * system.bodies[i].inertia * v;
            if (seen_[group] == 0) first_[group] = v / by, seen_[group] = 1;
            if (v != by * first_[group] || frame.bodies[i].size() > 1) alike_[group] = 0;
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        const Frame::Shape& shape = frame.bodies[i];
        if (std::all_of(shape.begin(), shape.end(), [this](const auto& share) { return alike_[share.group] != 0; })) {
            if (shape.empty()) now.y[n + i] = offsets_[i];
            continue;
        }
        double v = 0;
        for (const auto& [group, by] : shape) v += by * (momentum_[group] / frame.inertia[group]);
        now.y[n + i] = v + offsets_[i];
    }
    for (const Frame::Edge& edge : frame.edges) {
        if (!now.mode.keeps_place(edge.joint)) continue;
        const model::Joint& joint = system.joints[edge.joint];
        if (edge.joint >= own_joints_) {
            if (!system.bodies[joint.first()].moved->by_angle) continue;
            now.rigid_at[edge.joint] = angle_given(joint.first(), now.t.hi, when);
        }
        const int wall = now.mode.leans[edge.joint];
        now.put_child(joint, edge.child, edge.by, wall != 0 ? joint.walls->at(wall) : now.rigid_at[edge.joint]);
    }
}

/// Returns the prescribed angle of a body.
double Projection::angle_given(std::size_t body, double t, Side when) const {
    const model::Excitation& angle = mechanics_.system().bodies[body].moved->motion;
    const bool breaks = when != Side::at && angle.next_break(std::nextafter(t, -model::never)) == t;
    return !breaks ? angle.value(t) : when == Side::before ? angle.value_before(t) : angle.value_after(t);
}

}  // namespace dinal::motion::engine
