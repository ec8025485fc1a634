#include "motion/engine/decide.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace dinal::motion::engine {

namespace {

using model::EventKind;
using model::Joint;
using model::Motion;

constexpr double no_motion = 1e-9;      // relative to the acceleration that the torques at a joint could cause
constexpr double near_limit = 1e-10;    // relative to the torques; the slopes of belts are no more accurate
constexpr double clearly_jumps = 1e-9;  // relative to the torques
constexpr double little_more = 1e-7;    // relative to the torques; limits of released joints are lowered by this much

/// The work of one decision.
class Decider {
public:
    /// `made` initially holds the present and receives the result.
    Decider(const Evaluation& by, const Cause& cause, Decision& made)
        : by_(by),
          mechanics_(by.mechanics),
          released_(cause.released),
          reports_(cause.reports),
          made_(made),
          cases_(by.room.cases),
          found_(by.room.balance) {}
    /// Decides. Returns false if a value is not finite.
    bool decide();

private:
    using Case = DecisionRoom::Case;
    struct Worst {
        std::size_t joint;
        Motion way;
    };
    enum class Ways { right, changed, round };
    /// The effect on a sticking joint of the loads on both sides of slip 0.
    struct BothSides {
        double backward = 0, forward = 0;  ///< pull with the loads of each side
        bool drive_back = false;
        double beyond = -model::never;  ///< greatest excess over a limit, on the side `towards`
        Motion towards = Motion::forward;
    };
    struct Box;

    void find_joints_at_rest();
    bool settle(bool all_used);
    bool ride_along(const Frame& frame);
    std::optional<Worst> farthest_beyond();
    double excess_on_both_sides(std::size_t joint, double otherwise, Motion& towards, bool may_go);
    [[nodiscard]] bool stands(std::size_t joint) const;
    /// A state beside slip 0: the velocity of each body at slip 1, and the slip; without a slip the angle differs
    /// instead.
    struct Probe {
        const std::vector<double>& slip;
        std::optional<double> speed;
        double gained = 0;  ///< greatest speed that joints at standstill may have gained since
    };
    std::optional<BothSides> both_sides(std::size_t joint, const Probe& probe, const Moment& here);
    void let_go(const Worst& worst);
    Ways take_back();
    void settle_at_limit(std::size_t joint);
    void creep(std::size_t joint, Motion way, double pull);
    std::array<double, 2> driven_back(std::size_t joint, const Balance& at_rest);
    bool box_of(const std::vector<std::size_t>& held, Box& box);
    bool decide_together();
    bool share_loops();
    [[nodiscard]] bool moves_as_one(std::size_t joint, const Frame& frame) const;
    void report();
    void report(std::size_t joint);

    [[nodiscard]] std::size_t joints() const { return mechanics_.joints(); }
    [[nodiscard]] const Joint& joint_at(std::size_t j) const { return mechanics_.system().joints[j]; }
    [[nodiscard]] const Frame& frame() { return by_.frames.of(mode()); }
    [[nodiscard]] Now& now() { return made_.now; }
    [[nodiscard]] const Now& now() const { return made_.now; }
    [[nodiscard]] Mode& mode() { return made_.now.mode; }
    [[nodiscard]] const Mode& mode() const { return made_.now.mode; }
    [[nodiscard]] Contacts& memory() { return made_.contacts; }
    [[nodiscard]] double size(std::size_t joint) const { return by_.room.sizes.on(joint_at(joint)); }
    [[nodiscard]] double belt(std::size_t joint) const { return mechanics_.belt(joint, now().t.hi, now().side()); }
    void slide(std::size_t joint, Motion way, bool leaving) { memory().slide(mechanics_, now(), joint, way, leaving); }
    /// Projects velocities onto a frame, once, because nothing else in a decision changes them.
    void project(const Frame& frame) {
        if (projected_ != &frame) by_.projection.apply(now(), frame, now().side());
        projected_ = &frame;
    }
    void report_event(EventKind kind, std::size_t joint) {
        made_.reported.push_back({.event = event_at(mechanics_, now(), kind, joint)});
    }

    const Evaluation& by_;
    const Mechanics& mechanics_;
    std::optional<Cause::Released> released_;
    bool reports_;
    Decision& made_;
    std::vector<Case>& cases_;
    Balance& found_;
    const Frame* projected_ = nullptr;  ///< the frame to which velocities were projected last
    std::vector<std::size_t> full_{};   ///< joints that have reached their limits at this instant
    bool found_at_stop_ = false;        ///< whether found_ is the balance at the stop of the only joint, which sticks
    double between_ = 0;                ///< rounding of the released joint's torque due to the rounding of the time
};

bool Decider::decide() {
    find_joints_at_rest();
    by_.room.entered = mode().friction;
    found_.holding.assign(joints(), 0);
    const bool free = std::none_of(cases_.begin(), cases_.end(), [](const Case& one) { return one.at_rest; });
    const Frame& all_hold = frame();
    if (free && all_hold.edges.empty()) return true;
    project(all_hold);
    by_.room.sizes.find(mechanics_, by_.last, now().here());
    const bool loops = !all_hold.closing.empty();
    // At one instant several joints of a loop reach their limits or fail to leave: torques can no longer be shared.
    const bool all_used = loops && memory().last_full_at == now().t.hi;
    if (released_ || all_used) {
        full_ = all_used ? memory().last_full : std::vector<std::size_t>{};
        if (released_) full_.push_back(released_->joint);
        if (loops) memory().last_full_at = now().t.hi, memory().last_full = full_;
    }
    if (loops && !all_used && !share_loops()) return false;
    for (std::size_t j = 0; j < joints() && reports_; ++j) {
        if (cases_[j].before.slid != Motion::stuck) settle_at_limit(j);
    }
    if (released_) {
        const Series& series = by_.last.holding_series[released_->joint];
        between_ = lost_in_time(series, std::fabs(now().t.hi), by_.last.h, model::never);
    }
    if (!settle(all_used)) return false;
    project(frame());
    report();
    return true;
}

/// Finds the joints at slip 0. Initially all of them stick.
void Decider::find_joints_at_rest() {
    cases_.assign(joints(), {});
    for (std::size_t j = 0; j < joints(); ++j) {
        cases_[j].leant = mode().leans[j];
        if (!now().rubs(j)) continue;
        Slipping& how = mode().friction[j];
        Motion& arrived_as = memory().of[j].arrived;
        if (mode().leans[j] != 0 && how.leaving) continue;
        if (const double heading = now().belt_heading(mechanics_, j); mode().leans[j] != 0 && heading != 0) {
            const Motion way = model::motion_of(-heading);
            if (how.way != way) slide(j, way, false);
            continue;
        }
        if (mode().leans[j] != 0) {  // wall and friction hold the joint together
            how.way = Motion::stuck, how.riding = false;
            arrived_as = Motion::stuck;
            continue;
        }
        const bool arrived = arrived_as != Motion::stuck;
        if (how.way != Motion::stuck && !how.riding && !arrived && !how.leaving) continue;
        cases_[j] = {.at_rest = true,
                     .before = {.slid = arrived ? arrived_as : Motion::stuck,
                                .held = !arrived && !(how.leaving && !how.riding),
                                .creeps = how.creeps},
                     .let_go = released_ && how.leaving && !how.riding && !arrived ? how.way : Motion::stuck};
        how.way = Motion::stuck, how.riding = how.leaving = false;
    }
}

/// Repeats until the state of each joint agrees with its torques. Returns false if a value is not finite.
bool Decider::settle(bool all_used) {
    const int most = 8 * static_cast<int>(joints()) + 16;
    for (int i = 0;; ++i) {
        if (all_used || i > most) return decide_together();
        const Frame& present = frame();
        if (ride_along(present)) {
            project(frame());
            continue;
        }
        const bool found = std::exchange(found_at_stop_, false);
        if (!found && !by_.balances.at_present(now(), present, by_.last, found_)) return false;
        for (std::size_t j = 0; j < joints(); ++j) {
            if (memory().of[j].crept && cases_[j].before.slid != Motion::stuck && mode().holds(j))
                creep(j, cases_[j].before.slid, -found_.holding[j]);
        }
        const std::optional<Worst> worst = farthest_beyond();
        if (!made_.good) return false;
        if (worst) {
            let_go(*worst);
            continue;
        }
        const Ways ways = take_back();
        if (ways == Ways::right) return true;
        if (ways == Ways::round) return decide_together();
    }
}

/// Makes joints whose bodies are held together by other joints ride at slip 0. Returns whether one of them was sliding.
bool Decider::ride_along(const Frame& frame) {
    bool grown = false;
    for (std::size_t j = 0; j < joints(); ++j) {
        Slipping& how = mode().friction[j];
        const bool together = moves_as_one(j, frame);
        if (how.riding && !together) slide(j, how.way, true);
        const bool slides = now().rubs(j) && how.way != Motion::stuck && !how.riding && mode().leans[j] == 0;
        if (slides && together && how.leaving) how.riding = true, how.leaving = false;
        if (!slides || !together || how.riding || belt(j) != 0) continue;
        cases_[j].before.slid = how.way, cases_[j].at_rest = true, grown = true;
        how.way = Motion::stuck;
    }
    return grown;
}

/// Returns the joint that exceeds its limit the most. A joint seen to reach its limit at this instant takes precedence.
std::optional<Decider::Worst> Decider::farthest_beyond() {
    std::optional<Worst> worst;
    double most_beyond = 0;
    for (std::size_t j = 0; j < joints(); ++j) {
        if (!mode().holds(j)) continue;
        Motion towards = Motion::stuck;
        mode().friction[j].driven_back = false;
        double beyond = excess(mechanics_, j, found_, mode(), now().here(), towards);
        const bool own = released_ && released_->joint == j, may_go = own || cases_[j].let_go != Motion::stuck;
        if (by_.balances.has_feedback() && (beyond > 0 || may_go || mode().friction[j].beside > 0))
            beyond = excess_on_both_sides(j, beyond, towards, may_go);
        if (std::isnan(beyond)) {
            made_.good = false;
            return {};
        }
        const double rounded = mechanics_.bodies() > 1 ? 8 * rounding * size(j) : 0;
        if (may_go && std::fabs(beyond) <= near_limit * size(j) + 2 * found_.blurred + between_) {
            worst = {j, own ? released_->way : cases_[j].let_go}, most_beyond = model::never;
            continue;
        }
        if (!(beyond > rounded)) continue;
        const double size = joints() > 1 ? mechanics_.size_of(j, now().here()) : 1;
        const double part = beyond / (size + std::numeric_limits<double>::min());
        if (!worst || part > most_beyond) worst = {j, towards}, most_beyond = part;
    }
    return worst;
}

/// Returns the excess of a sticking joint whose loads may jump at slip 0 or at its place, or whose slip is rounding and
/// stays so. If the loads of both sides drive the joint back, a mixture of them holds it (Filippov). At standstill the
/// loads at slip 0 count first: if they hold the joint, only their limit matters; if not, it leaves as soon as sliding
/// friction no longer drives it back. `may_go` says whether it was seen to reach its limit.
double Decider::excess_on_both_sides(std::size_t j, double otherwise, Motion& towards, bool may_go) {
    Slipping& how = mode().friction[j];
    how.beside = 0, how.driven_back = false;
    if (!now().rubs(j) || mode().keeps_place(j) || how.way != Motion::stuck) return otherwise;
    constexpr double later = 1e-9;  // in time units of the motion
    const double rounded = 64 * rounding * size(j) * by_.unit * joint_at(j).lightness(mechanics_.system().bodies);
    // A surface on which a load jumps may move on: with a belt, with other bodies, or with states.
    std::vector<double> soon = now().y, rates(mechanics_.states());
    const std::size_t n = mechanics_.bodies();
    mechanics_.rates(now().here(), rates.data(), &mode());
    double gained = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double change = later * by_.unit * found_.accelerations[i];
        soon[i] += later * by_.unit * soon[n + i], soon[n + i] += change;
        gained = std::max(gained, std::fabs(change));
    }
    for (std::size_t k = 0; k < rates.size(); ++k) soon[2 * n + k] += later * by_.unit * rates[k];
    const std::vector<double> slip = slip_alone(mechanics_, mode(), j);
    for (const double speed : {std::numeric_limits<double>::min(), rounded}) {
        auto both = both_sides(j, {slip, speed}, now().here());
        if (!both || !both->drive_back) continue;
        const auto of_place = both_sides(j, {slip, {}}, now().here());
        // On a moving joint the side on which loads are evaluated at slip 0 is a matter of rounding.
        how.driven_back = speed != rounded && stands(j) && !(of_place && of_place->drive_back);
        if (how.driven_back) both = both_sides(j, {slip, speed}, now().here());
        const auto then = both_sides(j, {slip, speed, gained}, {now().t.hi + later * by_.unit, Side::at, soon});
        if (!then || !then->drive_back) continue;
        if (how.driven_back && !(otherwise > (may_go ? -near_limit * size(j) : 0))) break;
        if (how.driven_back && !may_go) both->beyond = std::min(otherwise, both->beyond - 64 * rounding * size(j));
        how.beside = speed, towards = both->towards;
        return both->beyond;
    }
    how.driven_back = false;
    return otherwise;
}

bool Decider::stands(std::size_t j) const {
    const auto& of = joint_at(j).of;
    return !mechanics_.has_belt(j) && std::all_of(of.begin(), of.end(), [&](const model::Weight& weight) {
        return now().y[mechanics_.bodies() + weight.body] == 0;
    });
}

/// Returns the loads on both sides of slip 0, or of the present angle; empty if a value is not finite.
std::optional<Decider::BothSides> Decider::both_sides(std::size_t j, const Probe& probe, const Moment& here) {
    BothSides both;
    std::vector<double> y;
    for (const Motion side : {Motion::backward, Motion::forward}) {
        Balance beside;
        const Motion way = probe.speed ? side : Motion::stuck;
        const Moment at = just_beside(here, probe.slip, {side, way, 0, probe.speed.value_or(0), probe.gained}, y);
        if (!by_.balances.at_present(at, now(), mode(), frame(), by_.last, beside)) return {};
        (side == Motion::forward ? both.forward : both.backward) = -beside.holding[j];
        Motion towards = Motion::stuck;
        const double beyond = excess(mechanics_, j, beside, mode(), now().here(), towards);
        if (towards == side && beyond > both.beyond) both.beyond = beyond, both.towards = side;
    }
    both.drive_back = both.backward - both.forward > clearly_jumps * size(j);
    return both;
}

void Decider::let_go(const Worst& worst) {
    const auto [j, way] = worst;
    if (released_ && released_->joint == j) released_.reset();
    cases_[j].pull = -found_.holding[j];
    cases_[j].let_go = Motion::stuck;
    Slipping& how = mode().friction[j];
    if (how.creeps != Motion::stuck && way != how.creeps) {
        how.creeps = Motion::stuck;
        if (reports_) report_event(EventKind::stick, j);
        return;
    }
    if (how.creeps != Motion::stuck) cases_[j].before.held = false;
    if (mode().leans[j] == 0) {
        slide(j, way, true);
        // In a loop other joints may still hold while this one is at its limit.
        if (moves_as_one(j, frame())) how.riding = true, how.leaving = false;
        return;
    }
    mode().leans[j] = 0, memory().of[j].leaves_wall = true;
    if (now().rubs(j) && how.way == Motion::stuck) {
        slide(j, way, true);
    } else if (now().rubs(j) && now().belt_sets_off(mechanics_, j)) {
        how.way = Motion::stuck;  // it may move with the belt
    }
}

/// Restores sticking for the first released joint that would not move in its direction.
Decider::Ways Decider::take_back() {
    bool goes_round = false;
    for (std::size_t j = 0; j < joints(); ++j) {
        Slipping& how = mode().friction[j];
        const bool lifted = cases_[j].leant != 0 && mode().leans[j] == 0;
        if (!how.leaving && !lifted) continue;
        const Joint& joint = joint_at(j);
        double rate = joint.sum(found_.accelerations);
        const double I = mechanics_.system().bodies[joint.first()].inertia / std::fabs(joint.of.front().by);
        const double nothing = 64 * rounding * size(j) + between_ + smallest;
        goes_round = goes_round || (lifted && cases_[j].leant * rate * I > nothing);
        if (mechanics_.has_belt(j)) rate -= now().belt_slopes[j].rate;
        // A joint that was let go at this instant without leaving, and has not just reached its limit, must leave
        // clearly.
        const double least = how.margin > 0 && full_.empty() ? nothing : -nothing;
        if (!how.leaving || model::sign_of(how.way) * rate * I >= least) continue;
        if (cases_[j].taken_back) {
            goes_round = true;
            continue;
        }
        cases_[j].taken_back = true;
        how.way = Motion::stuck, how.leaving = false;
        return Ways::changed;
    }
    return goes_round ? Ways::round : Ways::right;
}

void Decider::report() {
    for (std::size_t j = 0; j < joints(); ++j) {
        if (cases_[j].leant != 0 || mode().leans[j] != 0) {
            if (reports_ && memory().of[j].leaned && mode().leans[j] == 0) report_event(EventKind::slip, j);
            if (mode().leans[j] == 0) memory().of[j].leaned = false;
            memory().of[j].arrived = Motion::stuck;
        } else if (cases_[j].at_rest) {
            memory().of[j].crept = false;
            if (reports_ && mode().friction[j].creeps == Motion::stuck) report(j);
            memory().of[j].arrived = Motion::stuck;
        }
    }
}

/// Reports the new state of a joint at slip 0 if it has changed.
void Decider::report(std::size_t j) {
    const Slipping& how = mode().friction[j];
    const Motion way = how.riding ? Motion::stuck : how.way;
    Contacts::Arrival& arrival = memory().of[j].arrival;
    const Case& own = cases_[j];
    const auto kind = contact::event_of(own.before, way);
    if (!kind) return;
    report_event(*kind, j);
    Reported& event = made_.reported.back();
    if (*kind == EventKind::slip) {
        event.slid = arrival.slid, event.way = way;
        event.off = std::fabs(own.pull - arrival.pull), event.size = size(j);
    } else if (*kind == EventKind::stick && own.before.slid != Motion::stuck) {
        arrival = {own.before.slid, -found_.holding[j]};
    } else if (*kind == EventKind::stick) {
        event.holds_again = true;
    }
}

/// Returns whether other joints, or surfaces on which loads jump, hold the joint's bodies together, so that it cannot
/// slip. Two joints held by belts of different velocities do slip.
bool Decider::moves_as_one(std::size_t joint, const Frame& frame) const {
    const Joint& own = joint_at(joint);
    if (!frame.keeps(joint)) return by_.slides.holds_slip(joint, mode(), frame, now().here());
    if (!mechanics_.has_belts()) return true;
    const auto alike = [&](const std::vector<double>& of_joints, double nearly) {
        std::vector<double> offsets;
        frame.offsets(of_joints, mode(), offsets);
        return std::fabs(own.sum(offsets) - of_joints[joint]) <= nearly * own.size(offsets);
    };
    std::vector<double> belts(joints()), rates(joints());
    for (std::size_t j = 0; j < belts.size(); ++j) belts[j] = belt(j), rates[j] = now().belt_slopes[j].rate;
    constexpr double of_slopes = 1e-6;  // accuracy of the numerical slopes
    return alike(belts, 64 * rounding) && alike(rates, of_slopes);
}

/// Moves a mass that stopped beyond the limit of sticking by no more than accumulated rounding to the limit.
void Decider::settle_at_limit(std::size_t joint) {
    const Joint& own = joint_at(joint);
    const double before = std::exchange(memory().size_at_stop, size(joint));
    const bool alone =
        mechanics_.bodies() == 1 && mechanics_.all_linear() && !mechanics_.has_belts() && mode().leans[joint] == 0;
    if (!alone || own.stiffness == 0) return;
    if (!by_.balances.at_present(now(), frame(), by_.last, found_)) return;
    model::Pull pull{0, Motion::stuck};
    pull.beyond = excess(mechanics_, joint, found_, mode(), now().here(), pull.towards);
    const double limit = mechanics_.holding(joint, pull.towards, now().here());
    const double place = contact::place_at_limit(pull, limit, own.stiffness, found_.loads[0], now().y[0],
                                                 std::max(memory().size_at_stop, before));
    found_at_stop_ = joints() == 1 && place == now().y[0];
    if (place != now().y[0]) now().y[0] = place, now().low[0] = 0;
}

void Decider::creep(std::size_t joint, Motion way, double pull) {
    Slipping& how = mode().friction[joint];
    if (how.creeps != Motion::stuck) return;
    const double sliding = mechanics_.sliding(joint, {.way = way}, 0, now().here());
    const double holding = mechanics_.holding(joint, way, now().here());
    const auto within = contact::creeps_within(pull, way, sliding, holding, size(joint));
    if (!within) return;
    how.creeps = way, how.apart = *within;
    memory().of[joint].creeping = event_at(mechanics_, now(), EventKind::stick, joint);
}

/// The problem for the torques of joints at slip 0: the slip accelerations are G times the torques plus `slope`, and
/// each torque is between `low` and `high`.
struct Decider::Box {
    Eigen::MatrixXd G;
    Eigen::VectorXd slope, low, high;
    std::vector<std::array<double, 2>> driven_back;  ///< result of driven_back() for each joint
};

/// Returns the torques with which loads that jump at slip 0 drive a joint at standstill back when it slips forward and
/// backward.
std::array<double, 2> Decider::driven_back(std::size_t j, const Balance& at_rest) {
    std::array<double, 2> back{};
    if (!by_.balances.has_feedback() || !now().rubs(j) || !stands(j)) return back;
    const std::vector<double> slip = slip_alone(mechanics_, mode(), j);
    std::vector<double> y;
    for (const Motion side : {Motion::forward, Motion::backward}) {
        Balance beside;
        const Moment at = just_beside(now().here(), slip, {side, side, 0, std::numeric_limits<double>::min()}, y);
        if (!by_.balances.at_present(at, now(), mode(), frame(), by_.last, beside)) return {};
        double change = 0;
        for (std::size_t i = 0; i < slip.size(); ++i) change += slip[i] * (at_rest.torques[i] - beside.torques[i]);
        const double torque = model::sign_of(side) * change;
        if (torque > clearly_jumps * size(j)) back[side == Motion::forward ? 0 : 1] = torque;
    }
    return back;
}

/// Sets up the problem for these joints, which stick in the present mode. Returns false if a value is not finite.
bool Decider::box_of(const std::vector<std::size_t>& held, Box& box) {
    Balance found;
    if (!by_.balances.at_present(now(), frame(), by_.last, found)) return false;
    const model::System& system = mechanics_.system();
    const std::size_t n = system.bodies.size();
    const auto count = static_cast<Eigen::Index>(held.size()), bodies = static_cast<Eigen::Index>(n);
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(bodies, count);
    box.low.resize(count), box.high.resize(count), box.slope.resize(count);
    for (Eigen::Index c = 0; c < count; ++c) {
        const std::size_t j = held[static_cast<std::size_t>(c)];
        for (const auto& [body, by] : joint_at(j).of) D(static_cast<Eigen::Index>(body), c) = by;
        const bool sticks = now().rubs(j) && mode().friction[j].way == Motion::stuck;
        constexpr double wall = 1e30;
        const double margin = mode().friction[j].margin;
        box.low(c) = -margin - (sticks ? mechanics_.holding(j, Motion::forward, now().here()) : 0);
        box.high(c) = std::min(wall, margin + (sticks ? mechanics_.holding(j, Motion::backward, now().here()) : 0));
        box.driven_back.push_back(driven_back(j, found));
        box.low(c) -= box.driven_back.back()[0], box.high(c) += box.driven_back.back()[1];
        if (mode().leans[j] > 0 || mode().rigid[j] != 0) box.low(c) = -wall;
        if (mode().leans[j] < 0 || mode().rigid[j] != 0) box.high(c) = wall;
        box.slope(c) = mode().leans[j] == 0 ? -now().belt_slopes[j].rate : 0;
    }
    Eigen::VectorXd lightness(bodies), torques(bodies);
    for (std::size_t i = 0; i < n; ++i) {
        lightness(static_cast<Eigen::Index>(i)) = 1 / system.bodies[i].inertia;
        torques(static_cast<Eigen::Index>(i)) = found.torques[i];
    }
    box.G = D.transpose() * lightness.asDiagonal() * D;
    constexpr double little = 1e-10;  // regularisation that selects the smallest torques
    box.G.diagonal() += little * box.G.diagonal();
    box.slope += D.transpose() * lightness.cwiseProduct(torques);
    return true;
}

/// Decides all joints at slip 0 together, for use if deciding one after another cycles. Joints that turn out to slide
/// get their sliding torque as limit, and the problem is solved again. The limits of released joints are lowered
/// slightly.
bool Decider::decide_together() {
    mode().friction = by_.room.entered;
    for (std::size_t j = 0; j < joints(); ++j) mode().leans[j] = cases_[j].leant;
    std::vector<std::size_t> held;
    for (std::size_t j = 0; j < joints(); ++j) {
        if (cases_[j].at_rest || mode().keeps_place(j)) held.push_back(j);
    }
    Box box;
    if (!box_of(held, box)) return false;
    Eigen::VectorXd room = Eigen::VectorXd::Zero(box.low.size());
    for (Eigen::Index c = 0; c < room.size(); ++c) {
        const std::size_t j = held[static_cast<std::size_t>(c)];
        if (std::find(full_.begin(), full_.end(), j) != full_.end()) room(c) = little_more * size(j);
    }
    box.low += room, box.high -= room;
    std::vector<char> slips(held.size(), 0);
    Eigen::VectorXd torque, rate;
    for (bool grown = true; grown;) {
        grown = false;
        torque = least_in_box(box.G, box.slope, box.low, box.high);
        rate = box.G * torque + box.slope;
        for (Eigen::Index c = 0; c < torque.size(); ++c) {
            const std::size_t k = static_cast<std::size_t>(c), j = held[k];
            const bool at_limit = torque(c) <= box.low(c) || torque(c) >= box.high(c);
            if (slips[k] != 0 || !at_limit || !now().rubs(j) || mode().friction[j].way != Motion::stuck) continue;
            if (!(std::fabs(rate(c)) > no_motion * box.G(c, c) * size(j))) continue;  // other joints hold it as well
            slips[k] = 1, grown = true;
            const Moment here = now().here();
            const auto [ahead, behind] = box.driven_back[k];
            if (mode().leans[j] <= 0)
                box.low(c) = room(c) - mechanics_.sliding(j, {.way = Motion::forward}, 0, here) - ahead;
            const bool one_way = joint_at(j).friction.law.is_one_way();
            if (mode().leans[j] >= 0 && !one_way)
                box.high(c) = mechanics_.sliding(j, {.way = Motion::backward}, 0, here) - room(c) + behind;
        }
    }
    std::vector<std::size_t> gone;
    for (Eigen::Index c = 0; c < torque.size(); ++c) {
        const std::size_t j = held[static_cast<std::size_t>(c)];
        const bool at_low = torque(c) <= box.low(c), at_high = torque(c) >= box.high(c);
        if (!at_low && !at_high) continue;
        if (mode().leans[j] != 0) mode().leans[j] = 0, memory().of[j].leaves_wall = true;
        if (!now().rubs(j)) continue;
        if (mode().friction[j].way == Motion::stuck) {
            // A joint without friction is at both limits.
            slide(j, at_low && !(at_high && rate(c) < 0) ? Motion::forward : Motion::backward, true);
            gone.push_back(j);
        } else if (belt(j) == 0) {
            mode().friction[j].way = Motion::stuck;  // it may move with the belt, which starts to move
        }
    }
    for (const std::size_t j : gone) {
        if (!moves_as_one(j, frame())) continue;
        mode().friction[j].riding = true, mode().friction[j].leaving = false;
    }
    return true;
}

/// Distributes the torques of sticking joints in closed loops, which the motion does not determine. They minimise the
/// accelerations within their limits (Gauss), and among these solutions their own size. A joint at its limit rides
/// along, or slides if the others do not hold.
bool Decider::share_loops() {
    const std::vector<std::size_t> held = frame().sharing_of;
    Box box;
    if (!box_of(held, box)) return false;
    Eigen::Index full = -1;  // index of the joint that reached its limit
    for (std::size_t c = 0; released_ && c < held.size(); ++c) {
        if (released_->joint == held[c]) full = static_cast<Eigen::Index>(c);
    }
    const double torques = full < 0 ? 0 : size(held[static_cast<std::size_t>(full)]);
    Eigen::VectorXd torque;
    bool still = false;
    const auto share = [&](double part) {
        Eigen::VectorXd lower = box.low, higher = box.high;
        if (full >= 0) lower(full) += part * torques, higher(full) -= part * torques;
        torque = least_in_box(box.G, box.slope, lower, higher);
        still =
            full >= 0 && (box.G * torque + box.slope).cwiseAbs().maxCoeff() <= no_motion * box.G(full, full) * torques;
        if (full >= 0 && torque(full) <= lower(full)) torque(full) = box.low(full);
        if (full >= 0 && torque(full) >= higher(full)) torque(full) = box.high(full);
    };
    // The released joint rides from now on, and the others take the rest of the torque. They may be at their limits as
    // well: the first attempt asks for slightly more than the rest, which shows whether they can take it.
    share(little_more);
    if (!still) share(64 * rounding);
    for (Eigen::Index c = 0; c < torque.size(); ++c) {
        const std::size_t j = held[static_cast<std::size_t>(c)];
        const bool at_low = torque(c) <= box.low(c), at_high = torque(c) >= box.high(c);
        if (!at_low && !at_high) continue;
        if (mode().leans[j] != 0) mode().leans[j] = 0, memory().of[j].leaves_wall = true;
        if (!now().rubs(j) || mode().friction[j].way != Motion::stuck) continue;
        slide(j, at_low ? Motion::forward : Motion::backward, false);
        mode().friction[j].riding = true;
    }
    return true;
}

}  // namespace

Decision decide(const Evaluation& by, Now&& now, Contacts&& contacts, const Cause& cause) {
    Decision made{.now = std::move(now), .contacts = std::move(contacts), .reported = std::move(by.room.reported)};
    made.reported.clear();
    made.good = Decider(by, cause, made).decide() && made.good;
    return made;
}

model::Event event_at(const Mechanics& mechanics, const Now& now, EventKind kind, std::size_t where, int user) {
    const bool of_load =
        kind == EventKind::switched || kind == EventKind::slide_begins || kind == EventKind::slide_ends;
    const std::size_t loaded = of_load ? where : mechanics.system().joints[where].first();
    return {.t = now.t.hi,
            .kind = kind,
            .theta = mechanics.angle(where, now.y),
            .M = mechanics.load(loaded, now.here()),
            .user = user,
            .where = static_cast<int>(where),
            .velocity = mechanics.velocity(where, now.y)};
}

}  // namespace dinal::motion::engine
