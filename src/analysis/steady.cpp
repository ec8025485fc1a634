#include "analysis/steady.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "analysis/period_map.hpp"
#include "analysis/steady_facts.hpp"
#include "model/controller.hpp"

namespace dinal::analysis {
text::Expected<SteadyQuestion> SteadyQuestion::of(model::SystemHandle system, model::Drive drive,
                                                  std::optional<std::size_t> joint) {
    if (system->has_moved()) {
        return text::Error{"a body is moved by its theta or velocity: simulate does that, steady motions do not yet"};
    }
    auto body = model::oscillator_at(*system, joint.value_or(0));
    if (!body) return body.error();
    return SteadyQuestion{
        .system = std::move(system), .drive = std::move(drive), .body = std::move(body).value(), .joint = joint};
}

SteadyQuestion SteadyQuestion::of(const model::Oscillator& body, model::Drive drive, const Repetition& repeats) {
    return {.system = std::make_shared<const model::System>(model::as_system(body)),
            .drive = std::move(drive),
            .body = body,
            .repeats = repeats};
}

SteadyQuestion SteadyQuestion::seen_at(std::size_t which) const {
    SteadyQuestion own = *this;
    own.joint = which;
    own.body = model::oscillator_at(*system, which).value();
    return own;
}

const model::Excitation& SteadyQuestion::load() const {
    static const model::Excitation nothing;
    if (is_plain()) return drive.M();
    if (!joint || system->is_link(*joint)) return nothing;
    const model::Excitation& own = drive.loads[*joint];
    return own.has_feedback() || model::has_memory(own) ? nothing : own;
}

namespace {

SteadyQuestion advancing(SteadyQuestion question) {
    question.advances = true;
    return question;
}

/// Returns whether nothing restores the angle of a plain body, on which M alone acts.
bool is_free_block(const SteadyQuestion& question) {
    return question.is_alone() && !question.is_timeless() && !question.drive.has_more() &&
           !(question.body.stiffness() > 0) && question.body.spring().none() && !question.body.walls();
}

SteadyMotion motion_of(const SteadyQuestion& question, bool near, const motion::Monitor& monitor) {
    if (question.advances || !PeriodMap::applies_to(question)) return motion_by_returns(question, monitor);
    return motion_by_periods(question, near, monitor);
}

/// A free block may repeat its velocity while its angle advances: that is not growth.
SteadyMotion motion_or_advance(const SteadyQuestion& question, bool near, const motion::Monitor& monitor) {
    SteadyMotion motion = motion_of(question, near, monitor);
    const bool drifts = motion.status == SteadyStatus::grows || motion.status == SteadyStatus::none;
    if (!drifts || !is_free_block(question)) return motion;
    SteadyMotion advance = motion_of(advancing(question), near, monitor);
    return advance.is_found() ? advance : motion;
}

}  // namespace

SteadyMotion steady_motion(const SteadyQuestion& question, const motion::Monitor& monitor) {
    return motion_or_advance(question, false, monitor);
}

SteadyMotion steady_motion_near(const SteadyQuestion& question, const motion::Monitor& monitor) {
    return motion_or_advance(question, true, monitor);
}

namespace {

/// Returns whether the motions are equal; a mirror image is different. `free`: nothing restores the angle, so all rests
/// count as equal.
bool are_alike(const SteadyMotion& a, const SteadyMotion& b, double size, bool free) {
    if (a.stands() && b.stands()) {
        if (free) return true;
        const double within = 1e-6 * size;
        return b.start.theta >= a.rest.first - within && b.start.theta <= a.rest.second + within;
    }
    if (a.status != b.status) return false;
    if (a.status != SteadyStatus::steady) return true;
    const double apart = std::fabs(a.high - b.high) + std::fabs(a.low - b.low);
    return std::fabs(a.amplitude - b.amplitude) <= 1e-6 * size && apart <= 2e-6 * size;
}

std::vector<SteadyQuestion> questions_around(const SteadyQuestion& question, const SteadyMotion& known, double size) {
    const double period = known.period > 0 ? known.period : 2 * std::numbers::pi;
    const double omega =
        question.body.stiffness() > 0 ? question.body.natural_frequency() : 2 * std::numbers::pi / period;
    // Near resonance a motion may be far larger than the known one, and the mass may also adhere.
    const bool asks = question.drive.M().has_feedback() || question.is_timeless();
    const auto M = asks ? TorqueRange{} : extremes(question.drive.M(), question.repeats);
    const double stiff = question.body.inertia() * omega * omega;
    const double soft = std::max(question.body.damping() * omega, 0.01 * stiff);
    const double widest = std::max(2.5 * size, (M.high - M.low) / 2 / soft);
    std::vector<SteadyQuestion> questions(other_starts, question);
    for (int i = 0; i < other_starts; ++i) {
        const auto spot = i == 0 ? (M.high + M.low) / 2 / stiff : start_around(i, widest);
        const Place start = inside(question.body, Place(spot.real(), spot.imag()));
        SteadyQuestion& other = questions[static_cast<std::size_t>(i)];
        other.periods = 0;
        other.drive.start_at({start[0], start[1] * omega});
    }
    return questions;
}

}  // namespace

namespace {

// A rest at 0, searched from 0, gives no scale for other motions.
constexpr double smallest_size = 1e-200, default_size = 1;

std::vector<OtherMotion> others_of_one(const SteadyQuestion& question, const SteadyMotion& known,
                                       const motion::Monitor& monitor) {
    const bool family = known.status == SteadyStatus::steady && known.unique.has_value();
    if (!known.is_found() || known.unique.value_or(false) || family) return {};
    double size = std::max({std::fabs(known.low), std::fabs(known.high), std::fabs(known.rest.second)});
    // At rest only the initial state indicates the size of other motions.
    if (known.stands())
        size = std::max({size, std::fabs(question.drive.start().theta), std::fabs(question.drive.start().velocity)});
    if (!(size > smallest_size)) size = default_size;
    const bool free = !(question.body.stiffness() > 0) && question.body.spring().none();
    const auto alike = [size, free](const SteadyMotion& a, const SteadyMotion& b) {
        return are_alike(a, b, size, free);
    };
    return others_from(questions_around(question, known, size), known, alike, monitor);
}

std::vector<OtherMotion> others_of_all(const SteadyQuestion& question, const SteadyMotion& known,
                                       const motion::Monitor& monitor) {
    const bool alone = known.unique.has_value() && known.status == SteadyStatus::steady;
    if (!known.is_found() || alone) return {};
    const std::size_t n = question.system->bodies.size();
    const auto farthest = [](const BodyMotion& body) { return std::max(std::fabs(body.high), std::fabs(body.low)); };
    double size = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const BodyMotion& body = known.bodies[i];
        const double speed = known.period == 0 ? std::fabs(body.turned) : 0;
        size = std::max({size, body.high - body.low, farthest(body), speed});
        if (!known.stands()) continue;
        size = std::max({size, std::fabs(question.drive.theta0[i]), std::fabs(question.drive.velocity0[i])});
    }
    if (!(size > smallest_size)) size = default_size;
    const auto alike = [&](const SteadyMotion& a, const SteadyMotion& b) {
        if (a.stands() && b.stands()) return true;
        if (a.status != b.status) return false;
        const auto moves_alike = [&](const BodyMotion& x, const BodyMotion& y) {
            return std::fabs(x.high - y.high) <= 1e-4 * size && std::fabs(x.low - y.low) <= 1e-4 * size &&
                   std::fabs(x.turned - y.turned) <= 1e-4 * std::fabs(x.turned);
        };
        return a.status != SteadyStatus::steady ||
               std::equal(a.bodies.begin(), a.bodies.end(), b.bodies.begin(), moves_alike);
    };
    const double period = known.period > 0 ? known.period : 2 * std::numbers::pi;
    std::vector<SteadyQuestion> questions(other_starts, question);
    for (int s = 0; s < other_starts; ++s) {
        SteadyQuestion& other = questions[static_cast<std::size_t>(s)];
        other.periods = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const auto spot = start_around(s, 2.5 * size, i);
            double& theta = other.drive.theta0[i];
            theta = spot.real();
            if (const auto& walls = question.system->joints[i].walls) {
                theta = std::clamp(theta, walls->lower, walls->upper);
            }
            other.drive.velocity0[i] = spot.imag() * 2 * std::numbers::pi / period;
        }
        const auto crosses = [&](const model::Joint& joint) {
            if (!joint.walls || joint.of.size() == 1) return false;
            return joint.walls->crossed_by(joint.sum(other.drive.theta0)).has_value();
        };
        if (std::ranges::any_of(question.system->joints, crosses)) {
            other.drive.theta0 = question.drive.theta0;
        }
    }
    return others_from(questions, known, alike, monitor);
}

}  // namespace

std::vector<OtherMotion> other_motions(const SteadyQuestion& question, const SteadyMotion& known,
                                       const motion::Monitor& monitor) {
    if (!question.is_plain()) return others_of_all(question, known, monitor);
    return std::isnan(known.amplitude) ? others_of_all(advancing(question), known, monitor)
                                       : others_of_one(question, known, monitor);
}

}  // namespace dinal::analysis
