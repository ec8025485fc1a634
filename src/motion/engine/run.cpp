#include "motion/engine/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include "model/springs/user_spring.hpp"
#include "model/sticking.hpp"
#include "motion/engine/breaks.hpp"
#include "motion/engine/collocation.hpp"
#include "motion/engine/conditions.hpp"
#include "motion/engine/crossing.hpp"
#include "motion/engine/ending.hpp"
#include "motion/engine/frames.hpp"
#include "motion/engine/history.hpp"
#include "motion/engine/moving.hpp"
#include "motion/engine/now.hpp"
#include "motion/engine/pace.hpp"
#include "motion/engine/torque_sizes.hpp"
#include "motion/first_below.hpp"
#include "motion/roughness.hpp"
#include "motion/witness.hpp"

namespace dinal::motion::engine {

namespace {

using model::Event;
using model::EventKind;
using model::Joint;
using model::Motion;
using model::Outcome;

// In units of the pace, T0 or all of a run that is shorter.
constexpr double shortest = 1e-13;     // what cannot be seen in the motion
constexpr double near_failure = 1e-9;  // how near a run comes to where a function fails
constexpr int most_attempts = 20000;
constexpr int most_attempts_sampled = 3000;  // where a function of the motion is asked that may do anything
constexpr double last_bounces = 1e-7, shortest_bounce = 1e-10;
constexpr double most_blunt = 1e-9;   // of the torques: what passes its limit by more is no rounding
constexpr double no_motion = 1e-9;    // of the acceleration that the torques at a joint could give
constexpr double little_more = 1e-7;  // of the torques: what a joint that comes to its limit will be short of next
constexpr std::size_t most_passages = 200;
constexpr double at_zero = 1e-12;  // this part of what it was on the stretch stands at zero
constexpr double huge = 1e100;     // a function that is no number at such a state says nothing about itself
constexpr double beyond_all = std::numeric_limits<double>::max() / 1e7;  // bounds of a series are so much greater
constexpr double part_of_run = 1.0 / 16;

/// How long a polynomial of degree 16 can follow a motion under a law of friction from this speed on, about: along a
/// line that makes it grow or die out fast, and along a curve until the speed has changed by its scale. `first` is the
/// change of the speed by time, `second` the size of what that changes by.
double longest_step(const model::Friction& law, const model::SpeedRange& range, double speed, double first,
                    double second, double C, double I) {
    constexpr double any = std::numeric_limits<double>::infinity();
    constexpr double steepest = 4;  // what exp(-a t) may have for a t: degree 16 follows it then
    if (range.straight) {
        const double a = (C + range.slope) / I;
        const bool begins = speed == range.from || speed == range.to;
        return a < 0 || begins ? steepest / std::fabs(a) : any;
    }
    // Towards greater speeds a law becomes straighter; towards smaller ones what counts is where the step ends.
    double change = law.scale(speed);
    if (first < 0) {
        for (int i = 0; i < 4; ++i) change = law.scale(std::max(0.0, speed - change));
    }
    second += std::fabs(law.slope(speed) * first) / I;
    const double root = std::sqrt(first * first + 2 * second * change) + std::fabs(first);
    return root > 0 ? 2 * change / root : any;
}

class Engine {
public:
    Engine(const Request& problem, Run& result);
    void run();

private:
    /// What an exact look at a moment tells.
    struct Look {
        std::vector<double> loads, torques, accelerations, holding;
        double blurred = 0;  ///< what torques may be off by because the slopes of belts are differences
    };

    // The loop.
    void begin();
    bool advance();
    bool stands_for_good();
    bool rest();
    void choose(const Frame& frame);
    double longest_under_friction(const Frame& frame);
    double until_wall(const Frame& frame);
    void again(Collocation::Attempt attempt);
    [[nodiscard]] bool a_belt_jumps_at(double t) const;
    bool belt_jump_found();
    void explain_end();
    void forget_chatter();
    std::string state_driven_back();
    bool end_at(double x);
    bool ask_after_break();
    void go_to(double x);
    void keep(double length);
    std::vector<Kept::Acting> acting();
    [[nodiscard]] double energy_at(std::size_t joint, const std::vector<double>& y) const;
    bool handle(const Ending& ending);

    // Decisions.
    bool decide(bool told, std::optional<Ending> released = {});
    void creep(std::size_t joint, Motion way, double pull, double size);
    [[nodiscard]] bool may_creep(std::size_t joint) const;
    bool share_loops(const std::optional<Ending>& released, const TorqueSizes& sizes);
    struct Box;
    bool box_of(const std::vector<std::size_t>& held, Box& box);
    bool decide_together(std::size_t full, const TorqueSizes& sizes);
    void project(Side when);
    [[nodiscard]] double angle_given(std::size_t body, Side when) const;
    [[nodiscard]] double kinetic_energy() const;
    enum class Loads { asked, sampled };
    bool look(const Moment& at, const Mode& mode, const Frame& frame, Look& result, std::optional<double> x = {},
              Loads from = Loads::asked);
    std::optional<double> sampled_load(std::size_t body, double x);
    [[nodiscard]] double excess(std::size_t joint, const Look& look, const Mode& mode, const Moment& at,
                                Motion& towards) const;
    void slide(std::size_t joint, Motion way, bool leaving);
    [[nodiscard]] bool moves_as_one(std::size_t joint, const Frame& frame) const;
    /// The part of a pull that is right whatever states of the user's are wrong by.
    [[nodiscard]] double known() const { return mechanics_.states_of_user() > 0 ? 1 - 3e-12 : 1; }
    void find_belt_slopes(std::optional<double> x);
    [[nodiscard]] bool nothing_presses(std::size_t joint) const;
    bool open_and_close();
    enum class Because { impact, act, belt };
    bool restart_contacts(Because why, std::size_t at = 0);

    // Guards.
    void watch(const Frame& frame, Ending& ending);
    void watch_slip(std::size_t joint, double torques, Ending& ending);
    bool take_back_slip(std::size_t joint);
    void settle_at_limit(std::size_t joint, double size);
    bool only_touched(std::size_t joint, Motion way, double size);
    void watch_release(std::size_t joint, const Frame& frame, double torques, Ending& ending);
    void watch_walls(std::size_t joint, const model::Walls& walls, By by, Ending& ending) const;
    void watch_stop(std::size_t joint, Ending& ending) const;
    void watch_slider(std::size_t slider, Ending& ending) const;
    void let_slide(std::size_t slider, Motion way);
    bool turn_sliders();
    void press(std::size_t joint, int side);
    void catch_freewheels();
    /// What an impulse along a joint leaves of each velocity where the joint turns no more, and how much of a relative
    /// velocity each body takes. It conserves momentum, and what is linked rigidly takes its part.
    struct Thrown {
        double lightness = 0;
        std::vector<std::pair<double, double>> velocities = {};
    };
    Thrown thrown_along(std::size_t joint);
    void throw_to(const Thrown& thrown, double relative);
    void watch_corner(std::size_t joint, Ending& ending) const;
    void watch_normal(std::size_t joint, Ending& ending);
    void watch_bristles(std::size_t joint, Ending& ending);
    void watch_relays(Ending& ending);
    void watch_users(Ending& ending);
    bool ends_before(double x);
    void record_turns(const Frame& frame, double until);
    [[nodiscard]] bool rubs_somewhere(std::size_t body) const;

    struct Bounces {
        double once = model::never, all = model::never;
    };
    [[nodiscard]] std::optional<Bounces> next_bounces(std::size_t joint, int wall, double speed);
    bool hit(std::size_t joint, int wall);
    void leave_walls();
    bool act_all(const std::vector<std::size_t>& told);
    bool act(std::size_t event, const std::vector<std::size_t>& told);
    void touch_walls();
    bool press_stops();
    void keep_within_walls(std::vector<double>& y) const;
    void see_flight();
    [[nodiscard]] double watched(std::size_t event, const Moment& at) const;
    [[nodiscard]] double rounding_of(std::size_t event) const;
    [[nodiscard]] bool passes_on(std::size_t event);
    void stand_where_put(const std::vector<double>& before, const std::vector<std::size_t>& told);
    void come_again(std::size_t event);
    void tell(EventKind kind, int where, int user = -1);
    void tell_user(std::size_t event);
    [[nodiscard]] Event event_at(EventKind kind, int where, int user) const;
    bool too_often(int most = most_at_once) { return chatter_.too_often(now_.t.hi, most); }
    bool put_row(double t, double x);
    [[nodiscard]] double friction(std::size_t joint, const Moment& at, const Look& look) const;
    bool rows_until(double end, bool to_the_end);
    bool fail(Outcome outcome) {
        outcome_ = outcome;
        return false;
    }
    /// Nothing that contacts do is an event at the start.
    [[nodiscard]] bool begun() const { return now_.t.hi > problem_.window.start || problem_.before != nullptr; }
    [[nodiscard]] std::size_t n() const { return mechanics_.bodies(); }
    /// Those that were asked for: behind them are the joints that move bodies.
    [[nodiscard]] std::size_t told_joints() const { return mechanics_.joints() - problem_.hidden; }
    [[nodiscard]] std::size_t moved_body(std::size_t hidden) const { return problem_.system.joints[hidden].first(); }
    [[nodiscard]] TorqueSizes torque_sizes() const { return {mechanics_, segment_, now_.here()}; }
    [[nodiscard]] const Joint& joint_at(std::size_t joint) const { return problem_.system.joints[joint]; }

    const Request& problem_;
    Run& result_;
    Asking asking_;
    Mechanics mechanics_;
    std::shared_ptr<History> history_;
    double inertia_ = 0;  ///< of all bodies
    Pace pace_;
    Chatter chatter_;
    Breaks breaks_;
    std::optional<Collocation> solver_;
    std::optional<Frames> frames_;

    Now now_;
    std::vector<double> origin_, reach_;  ///< of each joint: the wall that it hit last, and how far it went from there
    std::optional<Frame> rigid_;          ///< what moves where nothing but rigid joints hold
    Mode entered_, left_;                 ///< when the decision in progress began, and before a release
    /// What a decision knows of a joint.
    struct Asked {
        bool asked = false;  ///< it is at slip 0
        bool taken_back = false, was_held = false, was_creeping = false;
        Motion slid = Motion::stuck;    ///< which way it slid until now; stuck: it did not
        Motion let_go = Motion::stuck;  ///< the way of what came to its limit at this instant, too
        int leant = 0;
        double pull = 0;  ///< what it was let go by
    };
    std::vector<Asked> asked_;
    /// How a joint came to stick, the last time: which way it slid, and what pulled it then.
    struct Arrival {
        Motion slid = Motion::stuck;
        double pull = 0;
    };
    std::vector<Arrival> arrivals_;
    double size_at_stop_ = 0;                    ///< of the torques, where a joint came to slip 0 the last time
    std::vector<char> crept_;                    ///< of each joint: it has come down to rounding, and may creep
    std::map<std::size_t, Event> crept_events_;  ///< the sticking of what creeps, told when nothing moves it
    std::vector<Motion> arrived_;                ///< of each joint: which way it slid until now; stuck: it did not
    std::vector<int> edge_;         ///< of each joint: the corner that its speed is at, 1 the upper one of its range
    std::vector<char> at_wall_;     ///< of each joint: it begins at a wall, and leaves it
    std::vector<char> leaned_;      ///< of each joint: it came to stand at a wall, which was told
    std::vector<int> normal_half_;  ///< of each joint: the sign of its normal load
    std::vector<Motion> heading_;   ///< of each body without dry friction
    std::vector<Watch> watches_;    ///< of the events of the user
    std::vector<Half> came_from_;   ///< the events of the user that were told last
    bool has_walls_ = false;
    std::optional<Conditions> conditions_;
    bool samples_ = false;  ///< another function of the motion, which may jump anywhere
    Segment segment_;
    double last_full_at_ = -model::never;
    std::pair<std::size_t, int> last_hit_{0, 0};  ///< the joint and its wall
    std::size_t next_row_ = 0, last_full_ = 0;    ///< the joint of a loop that came to its limit last, at last_full_at_
    Outcome outcome_ = Outcome::reached_end;
    Look look_, decided_;
    std::vector<double> row_;                       ///< of put_row()
    std::vector<Series> sampled_;                   ///< of the loads on the stretch, if somebody wanted them
    std::array<std::vector<double>, 5> scratch_;    ///< of look()
    std::array<std::vector<double>, 4> projected_;  ///< of project()
    std::vector<char> seen_, alike_;                ///< of project()
    mutable std::vector<double> point_;
};

Engine::Engine(const Request& problem, Run& result)
    : problem_(problem),
      result_(result),
      asking_{.named = problem.system.named, .told = 2 * problem.system.bodies.size() + problem.drive.states.size()},
      mechanics_(problem.system, problem.drive, asking_),
      breaks_(mechanics_),
      now_{.t = {problem.window.start, 0}} {
    const std::size_t joints = mechanics_.joints();
    now_.y = problem.drive.theta0;
    now_.y.insert(now_.y.end(), problem.drive.velocity0.begin(), problem.drive.velocity0.end());
    for (const model::OwnState& state : problem.drive.states) now_.y.push_back(state.start);
    now_.y.resize(2 * n() + mechanics_.states(), 0);
    now_.mode.friction.resize(joints), now_.mode.leans.assign(joints, 0);
    now_.low.assign(n(), 0), origin_.assign(joints, 0), reach_.assign(joints, 0);
    now_.mode.presses.assign(joints, 0), now_.mode.sliders.assign(mechanics_.sliders().size(), Motion::stuck);
    now_.mode.rubs = mechanics_.rubbing(), now_.mode.rigid.assign(joints, 0), now_.rigid_at.assign(joints, 0);
    for (std::size_t j = 0; j < joints; ++j) now_.mode.rigid[j] = problem.system.joints[j].rigid ? 1 : 0;
    arrived_.assign(joints, Motion::stuck), crept_.assign(joints, 0);
    edge_.assign(joints, 0), at_wall_.assign(joints, 0), leaned_.assign(joints, 0), normal_half_.assign(joints, 0);
    heading_.assign(n(), Motion::stuck);
    watches_.resize(problem.drive.events.size()), arrivals_.resize(joints);
    if (problem.before != nullptr) {
        now_.y = problem.before->y;
        if (!problem.before->low.empty()) now_.low = problem.before->low;
        now_.mode = problem.before->mode;
        for (std::size_t j = 0; j < joints; ++j) leaned_[j] = now_.mode.leans[j] != 0 ? 1 : 0;
        for (std::size_t j = 0; j < joints; ++j) mechanics_.loads()[j].remember(problem.before->controllers[j]);
        breaks_.go_on_with(problem.before->echoes);
        if (!problem.before->watches.empty()) watches_ = problem.before->watches;
        if (!problem.before->heading.empty()) heading_ = problem.before->heading;
    }
    now_.keep_rigid_places(problem_.system);
    std::vector<Joint> weights;
    for (const Joint& joint : problem.system.joints) {
        weights.push_back({.name = {}, .of = joint.of, .damping = joint.damping, .stops = joint.stops});
        has_walls_ |= joint.any_walls() != nullptr;
    }
    history_ = std::make_shared<History>(std::move(weights), n(), now_.y, now_.t.hi,
                                         problem.before ? problem.before->past : nullptr, problem.history_bytes);
    for (const model::Body& body : problem.system.bodies) inertia_ += body.inertia;
    samples_ = mechanics_.samples_the_motion();
    pace_.born = problem.before ? problem.before->born : now_.t.hi;
    asking_.past = [this](double t, Side side) { return history_->at(t, side); };
    const double run = problem.window.end - problem.window.start;
    Mode free = now_.mode;
    for (std::size_t j = 0; j < joints; ++j) free.friction[j].way = Motion::forward, free.leans[j] = 0;
    const double w = mechanics_.fastest(Frame(problem.system, free));
    pace_.period = w > 0 ? 2 * std::numbers::pi / w : model::never;
    pace_.unit = std::min(pace_.period, run);
    pace_.longest = std::min(problem.longest, w > 0 ? longest_in_periods * pace_.period : part_of_run * run);
    frames_.emplace(mechanics_, problem.longest, pace_.longest);
    pace_.h = pace_.longest / 2;
    chatter_ = {now_.t.hi, pace_.unit};
    conditions_.emplace(mechanics_, asking_.told, now_.t.hi, pace_.unit);
    solver_.emplace(mechanics_, problem.tolerance, pace_.longest, problem.step);
    if (problem.before != nullptr) solver_->know(problem.before->floor);
    const std::size_t columns = 1 + columns_of_body * n() + columns_of_link * (told_joints() - n()) + problem.hidden +
                                mechanics_.states_of_user() - (problem.joined_elsewhere ? n() : 0);
    result_.table = Growing<double>(problem.rows.count(), columns);
}

// ---- decisions

/// Torques, accelerations and what holds, at a moment, which may be at x of the stretch. False when something is not
/// finite.
bool Engine::look(const Moment& at, const Mode& mode, const Frame& frame, Look& result, std::optional<double> x,
                  Loads from) {
    const std::size_t joints = mechanics_.joints();
    if (!x) conditions_->decide(at, mode, segment_);
    auto& [belts, rates, offsets, of_group, lacking] = scratch_;
    auto& loads = result.loads;
    belts.assign(joints, 0), rates.assign(joints, 0);
    result.blurred = x && mechanics_.has_belts() ? solver_->blurred_by_belts(segment_) : 0;
    for (std::size_t j = 0; j < joints; ++j) {
        belts[j] = mechanics_.belt(j, at.t, at.side);
        if (!mechanics_.has_belt(j)) continue;
        if (x) {
            rates[j] = cheb::value(cheb::fit(segment_.belt_rates[j]), *x);
        } else {
            const BeltSlope slope = now_.belt_slopes[j];
            rates[j] = slope.rate;
            result.blurred = std::max(result.blurred, inertia_ * slope.doubt);
        }
    }
    mechanics_.loads_of_time(at.t, at.side, loads, [&](std::size_t i) {
        return x && from == Loads::sampled ? sampled_load(i, *x) : std::nullopt;
    });
    mechanics_.torques(at, mode, belts, loads, result.torques);
    frame.offsets(rates, mode, offsets);
    of_group.assign(frame.groups(), 0), lacking.resize(n());
    for (std::size_t i = 0; i < n(); ++i) {
        const double own = problem_.system.bodies[i].inertia * offsets[i];
        for (const auto& [group, by] : frame.bodies[i]) of_group[group] += by * (result.torques[i] - own);
    }
    result.accelerations.resize(n());
    bool good = true;
    for (std::size_t i = 0; i < n(); ++i) {
        result.accelerations[i] = offsets[i];
        for (const auto& [group, by] : frame.bodies[i]) {
            result.accelerations[i] += by * (of_group[group] / frame.inertia[group]);
        }
        lacking[i] = problem_.system.bodies[i].inertia * result.accelerations[i] - result.torques[i];
        good = good && std::isfinite(lacking[i]);
    }
    result.holding.assign(joints, 0);
    frame.multipliers(lacking, result.holding);
    return good;
}

/// What a function of the time is at x of the stretch, by its series, so that it need not be asked for every row; none
/// where it is to be asked.
std::optional<double> Engine::sampled_load(std::size_t body, double x) {
    if (!(x > -1) || !mechanics_.loads()[body].is_sampled() || mechanics_.has_base()) return {};
    if (sampled_.empty()) {
        for (const Nodes& load : segment_.loads) sampled_.push_back(cheb::fit(load));
    }
    return cheb::value(sampled_[body], x);
}

/// How far what holds a joint is beyond what it can hold, and which way it would go.
double Engine::excess(std::size_t joint, const Look& look, const Mode& mode, const Moment& at, Motion& towards) const {
    if (mode.rigid[joint] != 0) return -model::never;
    const double pull = -look.holding[joint] * known();  // what only touches a limit holds
    if (const int wall = mode.leans[joint]; wall != 0) {
        towards = wall > 0 ? Motion::backward : Motion::forward;
        const bool sticks = mode.rubs[joint] != 0 && mode.friction[joint].way == Motion::stuck;
        return -wall * pull - (sticks ? mechanics_.holding(joint, towards, at) : 0) - mode.friction[joint].blunt;
    }
    if (const Slipping& how = mode.friction[joint]; how.creeps != Motion::stuck) {
        const double off = pull - model::sign_of(how.creeps) * mechanics_.sliding(joint, {.way = how.creeps}, 0, at);
        towards = off > 0 ? Motion::forward : Motion::backward;
        return std::fabs(off) - how.apart;
    }
    towards = pull > 0 ? Motion::forward : Motion::backward;
    const double holding = mechanics_.holding(joint, towards, at) + mode.friction[joint].blunt;
    if (std::isinf(holding)) return -model::never;  // a freewheel, backward
    if (n() > 1 || !mechanics_.is_native(joint) || mechanics_.has_belts() || mechanics_.states() > 0 ||
        mode.presses[joint] != 0) {
        return std::fabs(pull) - look.blurred - holding;
    }
    // The limit is a razor's edge. The angle stands for all that are within half a unit of its last place.
    const Joint& own = problem_.system.joints[joint];
    const double theta = at.y[0], spring = own.spring.torque(theta);
    const double beyond =
        model::excess_over(holding, own.stiffness, look.loads[0] - spring, theta, model::sign_of(towards));
    constexpr double few = 8;  // roundings that a formula of the user makes
    const double grace = rounding / 2 * (std::fabs(own.stiffness * theta) + few * std::fabs(spring));
    return beyond < grace ? std::min(beyond, 0.0) : beyond;
}

/// At x of the last stretch; at a break from the right, where nothing tells them but the belts.
void Engine::find_belt_slopes(std::optional<double> x) {
    now_.belt_slopes.assign(mechanics_.joints(), {0, 0});
    for (std::size_t j = 0; mechanics_.has_belts() && j < now_.belt_slopes.size(); ++j) {
        if (!mechanics_.has_belt(j)) continue;
        now_.belt_slopes[j] = x ? BeltSlope{cheb::value(cheb::fit(segment_.belt_rates[j]), *x),
                                            solver_->blurred_by_belts(segment_) / inertia_}
                                : mechanics_.belt_slope(j, towards(now_.t.hi, now_.side()), belt_stretch * pace_.unit);
    }
}

/// Others hold its bodies together, so that it does not slip, and will not. Two that are held by belts of different
/// velocities slip.
bool Engine::moves_as_one(std::size_t joint, const Frame& frame) const {
    const Joint& own = problem_.system.joints[joint];
    if (!frame.keeps(joint)) return false;
    if (!mechanics_.has_belts()) return true;
    const auto alike = [&](const std::vector<double>& of_joints, double nearly) {
        std::vector<double> offsets;
        frame.offsets(of_joints, now_.mode, offsets);
        double size = 0;
        for (const auto& [body, by] : own.of) size += std::fabs(by * offsets[body]);
        return std::fabs(own.sum(offsets) - of_joints[joint]) <= nearly * size;
    };
    std::vector<double> belts(mechanics_.joints()), rates(mechanics_.joints());
    for (std::size_t j = 0; j < belts.size(); ++j) {
        belts[j] = mechanics_.belt(j, now_.t.hi, now_.side()), rates[j] = now_.belt_slopes[j].rate;
    }
    constexpr double of_slopes = 1e-6;  // which are differences
    return alike(belts, 64 * rounding) && alike(rates, of_slopes);
}

void Engine::slide(std::size_t joint, Motion way, bool leaving) {
    Slipping& how = now_.mode.friction[joint];
    how.way = way, how.leaving = leaving, how.riding = false, how.creeps = Motion::stuck;
    edge_[joint] = 0;
    const model::Friction& law = problem_.system.joints[joint].friction.law;
    if (law.ranges() > 0) {
        const double speed = leaving ? 0 : std::max(0.0, model::sign_of(way) * now_.slip(mechanics_, joint));
        how.range = mechanics_.range_of(joint, speed);
        if (speed > 0 && law.range(how.range).from == speed) edge_[joint] = -1;
    }
}

/// What all joints at slip 0 do, at once: what can hold holds; of what can not, the one that is farthest beyond its
/// limit goes, and the others are asked again; what would not go the way on which it was let go holds after all. What
/// was seen to come to its limit is `released` first.
bool Engine::decide(bool told, std::optional<Ending> released) {
    told = told && begun();
    const std::size_t joints = mechanics_.joints();
    asked_.assign(joints, {});
    for (std::size_t j = 0; j < joints; ++j) {
        asked_[j].leant = now_.mode.leans[j];
        if (!now_.rubs(j)) continue;
        Slipping& how = now_.mode.friction[j];
        if (now_.mode.leans[j] != 0 && how.leaving) continue;
        if (const double heading = now_.belt_heading(mechanics_, j); now_.mode.leans[j] != 0 && heading != 0) {
            const Motion way = model::motion_of(-heading);
            if (how.way != way) slide(j, way, false);
            continue;
        }
        if (now_.mode.leans[j] != 0) {  // wall and friction hold it together
            how.way = Motion::stuck, how.riding = false;
            arrived_[j] = Motion::stuck;
            continue;
        }
        const bool arrived = arrived_[j] != Motion::stuck;
        if (how.way != Motion::stuck && !how.riding && !arrived && !how.leaving) continue;
        asked_[j] = {.asked = true,
                     .was_held = !arrived && !(how.leaving && !how.riding),
                     .was_creeping = how.creeps != Motion::stuck,
                     .slid = arrived ? arrived_[j] : Motion::stuck,
                     .let_go = released && how.leaving && !how.riding && !arrived ? how.way : Motion::stuck};
        how.way = Motion::stuck, how.riding = how.leaving = false;
    }
    entered_ = now_.mode;
    const bool free = std::none_of(asked_.begin(), asked_.end(), [](const Asked& one) { return one.asked; });
    if (free && frames_->of(now_.mode).edges.empty()) return true;
    project(now_.side());
    const bool loops = !frames_->of(now_.mode).closing.empty();
    const TorqueSizes sizes = torque_sizes();
    // One after the other comes to its limit now, or can not go: no sharing holds any longer.
    const bool all_used = loops && last_full_at_ == now_.t.hi;
    if (loops && released) last_full_at_ = now_.t.hi, last_full_ = released->which;
    const std::size_t full = released ? released->which : all_used ? last_full_ : joints;
    if (loops && !all_used && !share_loops(released, sizes)) return false;
    for (std::size_t j = 0; j < joints && told; ++j) {
        if (asked_[j].slid != Motion::stuck) settle_at_limit(j, sizes.on(joint_at(j)));
    }
    Look& found = decided_;
    // What was released is so between two doubles of the time.
    const double late = std::fabs(now_.t.hi);
    const double between =
        released ? lost_in_time(cheb::fit(segment_.holding[released->which]), late, segment_.h, model::never) : 0;
    const int most = 8 * static_cast<int>(joints) + 16;
    for (int i = 0;; ++i) {
        if (all_used || i > most) {
            if (!decide_together(full, sizes)) return false;
            break;
        }
        const Frame& present = frames_->of(now_.mode);
        bool grown = false;
        for (std::size_t j = 0; j < joints; ++j) {
            Slipping& how = now_.mode.friction[j];
            const bool together = moves_as_one(j, present);
            if (how.riding && !together) slide(j, how.way, true);
            // What others hold together stands at slip 0 with them.
            const bool slides = now_.rubs(j) && how.way != Motion::stuck && !how.riding && now_.mode.leans[j] == 0;
            if (slides && together && how.leaving) how.riding = true, how.leaving = false;
            if (!slides || !together || how.riding || mechanics_.belt(j, now_.t.hi, now_.side()) != 0) continue;
            asked_[j].slid = how.way, asked_[j].asked = true, grown = true;
            how.way = Motion::stuck;
        }
        if (grown) {
            project(now_.side());
            continue;
        }
        if (!look({now_.t.hi, now_.side(), now_.departing(problem_.system)}, now_.mode, present, found))
            return fail(Outcome::excitation_not_finite);
        for (std::size_t j = 0; j < joints; ++j) {
            if (crept_[j] != 0 && asked_[j].slid != Motion::stuck && now_.mode.holds(j))
                creep(j, asked_[j].slid, -found.holding[j], sizes.on(joint_at(j)));
        }
        constexpr double nearly = 1e-10;  // of the torques: what differences tell of a belt is known no better
        std::size_t worst = joints;
        double most_beyond = 0;
        Motion way = Motion::stuck;
        for (std::size_t j = 0; j < joints; ++j) {
            if (!now_.mode.holds(j)) continue;
            Motion towards = Motion::stuck;
            const double beyond = excess(j, found, now_.mode, now_.here(), towards);
            if (std::isnan(beyond)) return fail(Outcome::excitation_not_finite);
            const double size = n() > 1 ? 8 * rounding * sizes.on(joint_at(j)) : 0;
            const bool own = released && released->which == j;
            if ((own || asked_[j].let_go != Motion::stuck) &&
                std::fabs(beyond) <= nearly * sizes.on(joint_at(j)) + 2 * found.blurred + between) {
                worst = j, most_beyond = model::never,
                way = own ? static_cast<Motion>(released->side) : asked_[j].let_go;
                continue;
            }
            if (!(beyond > size)) continue;
            const double part = beyond / (mechanics_.size_of(j, now_.here()) + std::numeric_limits<double>::min());
            if (worst == joints || part > most_beyond) worst = j, most_beyond = part, way = towards;
        }
        if (worst < joints) {
            if (released && released->which == worst) released.reset();
            asked_[worst].pull = -found.holding[worst];
            asked_[worst].let_go = Motion::stuck;
            if (Slipping& how = now_.mode.friction[worst]; how.creeps != Motion::stuck && way != how.creeps) {
                how.creeps = Motion::stuck;
                if (told) tell(EventKind::stick, static_cast<int>(worst));
                continue;
            }
            if (now_.mode.friction[worst].creeps != Motion::stuck) asked_[worst].was_held = false;
            if (now_.mode.leans[worst] != 0) {
                now_.mode.leans[worst] = 0, at_wall_[worst] = 1;
                const Motion slides = now_.mode.friction[worst].way;
                if (now_.rubs(worst) && slides == Motion::stuck) {
                    slide(worst, way, true);
                } else if (now_.rubs(worst) && now_.belt_sets_off(mechanics_, worst)) {
                    now_.mode.friction[worst].way = Motion::stuck;  // it may go with the belt
                }
            } else {
                slide(worst, way, true);
                // In a loop others may hold on, while this one gives all that it can.
                if (moves_as_one(worst, frames_->of(now_.mode))) {
                    now_.mode.friction[worst].riding = true, now_.mode.friction[worst].leaving = false;
                }
            }
            continue;
        }
        bool changed = false, goes_round = false;
        for (std::size_t j = 0; j < joints && !changed; ++j) {
            Slipping& how = now_.mode.friction[j];
            const bool lifted = asked_[j].leant != 0 && now_.mode.leans[j] == 0;
            if (!how.leaving && !lifted) continue;
            const Joint& joint = problem_.system.joints[j];
            double rate = joint.sum(found.accelerations);
            const double I = problem_.system.bodies[joint.first()].inertia / std::fabs(joint.of.front().by);
            const double nothing = 64 * rounding * sizes.on(joint_at(j)) + between;
            goes_round = goes_round || (lifted && asked_[j].leant * rate * I > nothing);
            if (mechanics_.has_belt(j)) rate -= now_.belt_slopes[j].rate;
            if (!how.leaving || model::sign_of(how.way) * rate * I >= -nothing) continue;
            if (asked_[j].taken_back) {
                goes_round = true;
                continue;
            }
            asked_[j].taken_back = true;
            how.way = Motion::stuck, how.leaving = false;
            changed = true;
        }
        if (changed) continue;
        if (goes_round && !decide_together(full, sizes)) return false;
        break;
    }
    project(now_.side());
    for (std::size_t j = 0; j < joints; ++j) {
        if (asked_[j].leant != 0 || now_.mode.leans[j] != 0) {
            if (told && leaned_[j] != 0 && now_.mode.leans[j] == 0) tell(EventKind::slip, static_cast<int>(j));
            if (now_.mode.leans[j] == 0) leaned_[j] = 0;
            arrived_[j] = Motion::stuck;
            continue;
        }
        if (!asked_[j].asked) continue;
        const Slipping& how = now_.mode.friction[j];
        const bool slides = how.way != Motion::stuck && !how.riding;
        crept_[j] = 0;
        if (how.creeps != Motion::stuck) {
            arrived_[j] = Motion::stuck;
            continue;
        }
        if (told && asked_[j].slid != Motion::stuck) {
            if (!slides) {
                tell(EventKind::stick, static_cast<int>(j));
                arrivals_[j] = {asked_[j].slid, -found.holding[j]};
            } else if (how.way != asked_[j].slid) {
                tell(EventKind::turn, static_cast<int>(j));
            }
        } else if (told && asked_[j].was_held && slides) {
            if (!only_touched(j, how.way, sizes.on(joint_at(j)))) tell(EventKind::slip, static_cast<int>(j));
        } else if (told && !asked_[j].was_held && !asked_[j].was_creeping && !slides && !take_back_slip(j)) {
            tell(EventKind::stick, static_cast<int>(j));
        }
        arrived_[j] = Motion::stuck;
    }
    return true;
}

/// A mass that comes to a stop beyond the limit of sticking by no more than the roundings of its way is at the limit.
void Engine::settle_at_limit(std::size_t joint, double size) {
    const Joint& own = problem_.system.joints[joint];
    const double before = std::exchange(size_at_stop_, size);
    const bool alone = n() == 1 && mechanics_.all_linear() && !mechanics_.has_belts() && now_.mode.leans[joint] == 0;
    if (!alone || own.stiffness == 0) return;
    if (!look({now_.t.hi, now_.side(), now_.departing(problem_.system)}, now_.mode, frames_->of(now_.mode), decided_))
        return;
    constexpr double roundings = 1024 * rounding;
    Motion towards = Motion::stuck;
    const double beyond = excess(joint, decided_, now_.mode, now_.here(), towards);
    if (!(beyond > 0) || beyond > roundings * std::max(size_at_stop_, before)) return;
    const double way = model::sign_of(towards), limit = mechanics_.holding(joint, towards, now_.here());
    double place = (decided_.loads[0] - way * limit) / own.stiffness;
    while (model::excess_over(limit, own.stiffness, decided_.loads[0], place, way) > 0) {
        place = std::nextafter(place, way * model::never);
    }
    now_.y[0] = place, now_.low[0] = 0;
}

/// Whether the stick that ends now was none: the joint came to slip 0 right at the limit, and friction withheld an
/// impulse below rounding while the pull passed it. Which side of the limit it was on is for rounding to say. Then it
/// is told no more, or is a turn.
bool Engine::only_touched(std::size_t joint, Motion way, double size) {
    constexpr double briefly = 1e-3, withheld = 64 * rounding;
    if (result_.events.empty() || arrivals_[joint].slid == Motion::stuck) return false;
    Event& last = result_.events.back();
    const double part = (now_.t.hi - last.t) / pace_.unit;
    if (last.kind != EventKind::stick || last.where != static_cast<int>(joint) || part > briefly) return false;
    const double impulse = std::fabs(asked_[joint].pull - arrivals_[joint].pull) * (2 * std::numbers::pi * part);
    if (!(impulse <= withheld * size)) return false;
    if (way == arrivals_[joint].slid) {
        result_.events.pop_back();
    } else {
        last.kind = EventKind::turn;
    }
    return true;
}

/// Whether what has come down to rounding is on its way still, because no more than the friction of sliding balances
/// its pull, and more would hold it.
void Engine::creep(std::size_t joint, Motion way, double pull, double size) {
    Slipping& how = now_.mode.friction[joint];
    const double level = mechanics_.sliding(joint, {.way = way}, 0, now_.here());
    if (how.creeps != Motion::stuck || !(mechanics_.holding(joint, way, now_.here()) > level)) return;
    const double off = std::fabs(model::sign_of(way) * pull - level);
    constexpr double balances = 1024 * rounding;  // of the torques
    if (!(off <= balances * size)) return;
    how.creeps = way, how.apart = 2 * off + 64 * rounding * size;
    crept_events_[joint] = event_at(EventKind::stick, static_cast<int>(joint), -1);
}

/// The torques of joints at slip 0 on their angles, within their limits, as a problem of least squares: G times
/// the torques, plus slope, are the accelerations by which the joints slip.
struct Engine::Box {
    Eigen::MatrixXd G;
    Eigen::VectorXd slope, low, high;
};

/// Of these joints, which hold in the present mode.
bool Engine::box_of(const std::vector<std::size_t>& held, Box& box) {
    const Frame& present = frames_->of(now_.mode);
    Look found;
    if (!look({now_.t.hi, now_.side(), now_.departing(problem_.system)}, now_.mode, present, found))
        return fail(Outcome::excitation_not_finite);
    const auto count = static_cast<Eigen::Index>(held.size());
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n()), count);
    box.low.resize(count), box.high.resize(count), box.slope.resize(count);
    for (Eigen::Index c = 0; c < count; ++c) {
        const std::size_t j = held[static_cast<std::size_t>(c)];
        const Joint& joint = problem_.system.joints[j];
        for (const auto& [body, by] : joint.of) D(static_cast<Eigen::Index>(body), c) = by;
        const bool sticks = now_.rubs(j) && now_.mode.friction[j].way == Motion::stuck;
        constexpr double wall = 1e30;
        box.low(c) = sticks ? -mechanics_.holding(j, Motion::forward, now_.here()) : 0;
        box.high(c) = sticks ? std::min(wall, mechanics_.holding(j, Motion::backward, now_.here())) : 0;
        if (now_.mode.leans[j] > 0 || now_.mode.rigid[j] != 0) box.low(c) = -wall;
        if (now_.mode.leans[j] < 0 || now_.mode.rigid[j] != 0) box.high(c) = wall;
        box.slope(c) = now_.mode.leans[j] == 0 ? -now_.belt_slopes[j].rate : 0;
    }
    Eigen::VectorXd lightness(static_cast<Eigen::Index>(n())), torques(static_cast<Eigen::Index>(n()));
    for (std::size_t i = 0; i < n(); ++i) {
        lightness(static_cast<Eigen::Index>(i)) = 1 / problem_.system.bodies[i].inertia;
        torques(static_cast<Eigen::Index>(i)) = found.torques[i];
    }
    box.G = D.transpose() * lightness.asDiagonal() * D;
    constexpr double little = 1e-10;  // what makes the smallest torques the solution
    box.G.diagonal() += little * box.G.diagonal();
    box.slope += D.transpose() * lightness.cwiseProduct(torques);
    return true;
}

/// What all joints at slip 0 do where asking one after the other goes round: the torques that solve the whole problem.
/// What slips at the limit of holding has the torque of sliding, and with that the problem is solved again. The joint
/// that came to its limit, if one did, is short of a little already.
bool Engine::decide_together(std::size_t full, const TorqueSizes& sizes) {
    now_.mode = entered_;
    std::vector<std::size_t> held;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (asked_[j].asked || now_.mode.keeps_place(j)) held.push_back(j);
    }
    Box box;
    if (!box_of(held, box)) return false;
    for (std::size_t k = 0; k < held.size(); ++k) {
        if (held[k] != full) continue;
        const double room = little_more * sizes.on(joint_at(full));
        box.low(static_cast<Eigen::Index>(k)) += room, box.high(static_cast<Eigen::Index>(k)) -= room;
    }
    std::vector<char> slips(held.size(), 0);
    Eigen::VectorXd torque, rate;
    for (bool grown = true; grown;) {
        grown = false;
        torque = least_in_box(box.G, box.slope, box.low, box.high);
        rate = box.G * torque + box.slope;
        for (Eigen::Index c = 0; c < torque.size(); ++c) {
            const std::size_t k = static_cast<std::size_t>(c), j = held[k];
            const bool at_limit = torque(c) <= box.low(c) || torque(c) >= box.high(c);
            if (slips[k] != 0 || !at_limit || !now_.rubs(j) || now_.mode.friction[j].way != Motion::stuck) continue;
            if (!(std::fabs(rate(c)) > no_motion * box.G(c, c) * sizes.on(joint_at(j))))
                continue;  // others hold it, too
            slips[k] = 1, grown = true;
            if (now_.mode.leans[j] <= 0) box.low(c) = -mechanics_.sliding(j, {.way = Motion::forward}, 0, now_.here());
            if (now_.mode.leans[j] >= 0) box.high(c) = mechanics_.sliding(j, {.way = Motion::backward}, 0, now_.here());
        }
    }
    std::vector<std::size_t> gone;
    for (Eigen::Index c = 0; c < torque.size(); ++c) {
        const std::size_t j = held[static_cast<std::size_t>(c)];
        const bool at_low = torque(c) <= box.low(c), at_high = torque(c) >= box.high(c);
        if (!at_low && !at_high) continue;
        if (now_.mode.leans[j] != 0) now_.mode.leans[j] = 0, at_wall_[j] = 1;
        if (!now_.rubs(j)) continue;
        if (now_.mode.friction[j].way == Motion::stuck) {
            // What can hold nothing is at both of its limits.
            slide(j, at_low && !(at_high && rate(c) < 0) ? Motion::forward : Motion::backward, true);
            gone.push_back(j);
        } else if (mechanics_.belt(j, now_.t.hi, now_.side()) == 0) {
            now_.mode.friction[j].way = Motion::stuck;  // it may go with the belt, which sets off
        }
    }
    for (const std::size_t j : gone) {
        if (!moves_as_one(j, frames_->of(now_.mode))) continue;
        now_.mode.friction[j].riding = true, now_.mode.friction[j].leaving = false;
    }
    return true;
}

/// Where joints that hold close loops, their torques are not known from the motion. What they can hold together they
/// do: the accelerations are the least that torques within their limits leave (Gauss), and of all such torques they
/// have the smallest. A joint at its limit rides along, or slides when the others do not hold.
bool Engine::share_loops(const std::optional<Ending>& released, const TorqueSizes& sizes) {
    const std::vector<std::size_t> held = frames_->of(now_.mode).sharing_of;
    Box box;
    if (!box_of(held, box)) return false;
    Eigen::Index full = -1;  // the joint that came to its limit
    for (std::size_t c = 0; released && c < held.size(); ++c) {
        if (released->which == held[c]) full = static_cast<Eigen::Index>(c);
    }
    const double size = full < 0 ? 0 : sizes.on(joint_at(held[static_cast<std::size_t>(full)]));
    Eigen::VectorXd torque;
    bool still = false;
    const auto share = [&](double part) {
        Eigen::VectorXd lower = box.low, higher = box.high;
        if (full >= 0) lower(full) += part * size, higher(full) -= part * size;
        torque = least_in_box(box.G, box.slope, lower, higher);
        still = full >= 0 && (box.G * torque + box.slope).cwiseAbs().maxCoeff() <= no_motion * box.G(full, full) * size;
        if (full >= 0 && torque(full) <= lower(full)) torque(full) = box.low(full);
        if (full >= 0 && torque(full) >= higher(full)) torque(full) = box.high(full);
    };
    // What comes to its limit rides from now on, and the others take the rest. Others may stand at a limit just now and
    // leave it next: when they have room for a little more than the rest, nothing moves, and that little tells which.
    share(little_more);
    if (!still) share(64 * rounding);
    for (Eigen::Index c = 0; c < torque.size(); ++c) {
        const std::size_t j = held[static_cast<std::size_t>(c)];
        const bool at_low = torque(c) <= box.low(c), at_high = torque(c) >= box.high(c);
        if (!at_low && !at_high) continue;
        if (now_.mode.leans[j] != 0) now_.mode.leans[j] = 0, at_wall_[j] = 1;
        if (!now_.rubs(j) || now_.mode.friction[j].way != Motion::stuck) continue;
        slide(j, at_low ? Motion::forward : Motion::backward, false);
        now_.mode.friction[j].riding = true;
    }
    return true;
}

/// What is held together has one velocity, to the letter; what leans is at its wall.
void Engine::project(Side when) {
    const Frame& present = frames_->of(now_.mode);
    if (present.edges.empty()) return;
    auto& [belts, offsets, momentum, first] = projected_;
    belts.resize(mechanics_.joints());
    for (std::size_t j = 0; j < belts.size(); ++j) belts[j] = mechanics_.belt(j, now_.t.hi, when);
    present.offsets(belts, now_.mode, offsets);
    momentum.assign(present.groups(), 0), first.resize(present.groups());
    seen_.assign(present.groups(), 0), alike_.assign(present.groups(), 1);
    for (std::size_t i = 0; i < n(); ++i) {
        const double v = now_.y[n() + i] - offsets[i];
        for (const auto& [group, by] : present.bodies[i]) {
            momentum[group] += by * problem_.system.bodies[i].inertia * v;
            if (seen_[group] == 0) first[group] = v / by, seen_[group] = 1;
            if (v != by * first[group] || present.bodies[i].size() > 1) alike_[group] = 0;
        }
    }
    for (std::size_t i = 0; i < n(); ++i) {
        const Frame::Shape& shape = present.bodies[i];
        if (std::all_of(shape.begin(), shape.end(), [this](const auto& share) { return alike_[share.group] != 0; })) {
            if (shape.empty()) now_.y[n() + i] = offsets[i];
            continue;
        }
        double v = 0;
        for (const auto& [group, by] : shape) v += by * (momentum[group] / present.inertia[group]);
        now_.y[n() + i] = v + offsets[i];
    }
    for (const Frame::Edge& edge : present.edges) {
        if (!now_.mode.keeps_place(edge.joint)) continue;
        const bool moved = edge.joint >= told_joints();
        if (moved && !problem_.system.bodies[moved_body(edge.joint)].moved->by_angle) continue;
        if (moved) now_.rigid_at[edge.joint] = angle_given(moved_body(edge.joint), when);
        const int wall = now_.mode.leans[edge.joint];
        now_.put_child(problem_.system.joints[edge.joint], edge.child, edge.by,
                       wall != 0 ? problem_.system.joints[edge.joint].walls->at(wall) : now_.rigid_at[edge.joint]);
    }
}

/// The angle that a body is moved to, now.
double Engine::angle_given(std::size_t body, Side when) const {
    const model::Excitation& angle = problem_.system.bodies[body].moved->motion;
    const bool breaks = when != Side::at && angle.next_break(std::nextafter(now_.t.hi, -model::never)) == now_.t.hi;
    return !breaks                ? angle.value(now_.t.hi)
           : when == Side::before ? angle.value_before(now_.t.hi)
                                  : angle.value_after(now_.t.hi);
}

/// Neither now nor a little later: a load that only touches zero opens nothing, nor does one that is no number.
bool Engine::nothing_presses(std::size_t joint) const {
    constexpr double later = 1e-9;
    // Where the load was found to fall below zero it may still be its rounding.
    if (normal_half_[joint] >= 0 && !(mechanics_.pressing(joint, now_.here()) <= 0)) return false;
    std::vector<double> y = now_.y;
    const double h = later * pace_.unit;
    for (std::size_t i = 0; i < n(); ++i) y[i] += h * y[n() + i];
    return mechanics_.pressing(joint, {now_.t.hi + h, Side::at, y}) <= 0;
}

/// A contact on which nothing presses is open: it neither sticks nor slips. True when one has opened or closed.
bool Engine::open_and_close() {
    bool changed = false;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!mechanics_.may_open(j)) continue;
        const bool opens = nothing_presses(j);
        if (opens != now_.rubs(j)) continue;
        changed = true;
        now_.mode.rubs[j] = opens ? 0 : 1;
        now_.mode.friction[j] = {};
        arrived_[j] = Motion::stuck;
        normal_half_[j] = opens ? -1 : 1;
        const Joint& joint = problem_.system.joints[j];
        double fastest = std::fabs(mechanics_.belt(j, now_.t.hi, now_.side()));
        for (const auto& [body, by] : joint.of) {
            const double v = now_.y[n() + body];
            fastest = std::max(fastest, std::fabs(by * v));
            if (opens) heading_[body] = model::motion_of(v);
        }
        if (!opens && std::fabs(now_.slip(mechanics_, j)) > 16 * rounding * fastest) {
            slide(j, model::motion_of(now_.slip(mechanics_, j)), false);
        } else if (!opens && now_.mode.leans[j] == 0) {
            slide(j, Motion::forward, true);  // if it sticks from now on, that is told
        }
        if (begun()) tell(opens ? EventKind::opened : EventKind::closed, static_cast<int>(j));
    }
    return changed;
}

/// After velocities were changed at once, by an impact at a joint, a user, or the jump of a belt: how each slides now.
bool Engine::restart_contacts(Because why, std::size_t at) {
    open_and_close();
    catch_freewheels();
    press_stops();
    turn_sliders();
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!now_.rubs(j) || now_.mode.leans[j] != 0) continue;
        Slipping& how = now_.mode.friction[j];
        const double s = now_.slip(mechanics_, j);
        const double belt = mechanics_.belt(j, now_.t.hi, now_.side());
        const bool weighted = problem_.system.joints[j].is_weighted();
        const double known = weighted ? mechanics_.speed_scale(j, now_.y) : std::fabs(mechanics_.velocity(j, now_.y));
        double corner = 4 * rounding * (known + std::fabs(belt));
        if (why == Because::belt && mechanics_.has_belt(j)) {
            // Where it only turns a corner its values differ by rounding, and by what it does in a hair of time.
            double rate = std::fabs(now_.belt_slopes[j].rate);
            if (!segment_.belt_rates.empty()) rate = std::max(rate, std::fabs(segment_.belt_rates[j][node_count - 1]));
            corner = 16 * corner + rate * 64 * rounding * std::fabs(now_.t.hi);
        }
        if (std::fabs(s) <= corner) {
            if (how.way == Motion::stuck || how.riding) continue;
            if (why == Because::act) {
                how.leaving = true;  // what a user stopped did not come to a standstill of its own
            } else {
                arrived_[j] = how.way;
            }
            continue;
        }
        const Motion way = model::motion_of(s);
        const bool held = how.way == Motion::stuck || how.riding;
        how.leaving = false;
        if (held || how.way != way) {
            const bool told = begun() && (why == Because::belt || (why == Because::impact && j != at));
            if (held && told) tell(EventKind::slip, static_cast<int>(j));
            if (!held && why == Because::belt) tell(EventKind::turn, static_cast<int>(j));
            slide(j, way, false);
        } else if (const model::Friction& law = problem_.system.joints[j].friction.law; law.ranges() > 0) {
            const model::SpeedRange range = law.range(how.range);  // the speed may have jumped out of it
            const double speed = std::fabs(s);
            if (speed < range.from - corner || speed > range.to + corner) slide(j, way, false);
        }
    }
    return decide(true);
}

// ---- the loop

void Engine::begin() {
    now_.after_break = mechanics_.next_break(std::nextafter(now_.t.hi, -model::never)) == now_.t.hi;
    find_belt_slopes({});
    std::vector<std::string> names;
    if (problem_.system.named) {
        for (const char* kind : {"theta.", "velocity."}) {
            for (const model::Body& body : problem_.system.bodies) names.push_back(kind + body.name);
        }
    } else {
        names = {"theta", "velocity"};
    }
    for (const model::OwnState& state : problem_.drive.states) names.push_back(state.name);
    if (problem_.before == nullptr) {
        mechanics_.for_each_signal([&](Signal& s) { s.begin(now_.here(), names); });
        bool good = true;
        mechanics_.for_each_signal([&](Signal& s) { good = good && s.arrive(now_.here()); });
        if (!good) fail(Outcome::excitation_not_finite);
        breaks_.echo(now_.t.hi, 1);
        open_and_close();
        press_stops();
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            if (!now_.rubs(j)) continue;
            const double s = now_.slip(mechanics_, j);
            const bool weighted = problem_.system.joints[j].is_weighted();
            if (std::fabs(s) > (weighted ? 4 * rounding * mechanics_.speed_scale(j, now_.y) : 0)) {
                slide(j, model::motion_of(s), false);
            } else {
                now_.mode.friction[j].way = Motion::stuck;
            }
        }
        touch_walls();
        if (outcome_ == Outcome::reached_end) decide(false);
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) leaned_[j] = now_.mode.leans[j] != 0 ? 1 : 0;
    } else {
        project(now_.side());
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            if (now_.mode.friction[j].creeps == Motion::stuck) continue;
            crept_events_[j] = event_at(EventKind::stick, static_cast<int>(j), -1);
        }
        if (now_.after_break) ask_after_break();
    }
    result_.begun = now_.mode;
    result_.initial = now_.y;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) reach_[j] = std::fabs(mechanics_.angle(j, now_.y));
}

void Engine::run() {
    begin();
    unsigned pieces = 0;
    constexpr unsigned between_questions = 16;
    bool alive = outcome_ == Outcome::reached_end;
    while (alive && now_.t.hi < problem_.window.end) {
        if (pieces++ % between_questions == 0 && problem_.monitor && !problem_.monitor(now_.t.hi)) {
            outcome_ = Outcome::interrupted;
            break;
        }
        alive = advance();
    }
    if (outcome_ == Outcome::unresolved || outcome_ == Outcome::chattering) explain_end();
    const bool stands_at_now = outcome_ != Outcome::excitation_not_finite && outcome_ != Outcome::unresolved;
    if (stands_at_now) {
        while (next_row_ < problem_.rows.count() && problem_.rows.time(next_row_) <= now_.t.hi &&
               put_row(now_.t.hi, -2)) {
        }
    }
    for (const auto& [joint, event] : crept_events_) {  // nothing came that would have moved it
        if (outcome_ != Outcome::reached_end || now_.mode.friction[joint].creeps == Motion::stuck) continue;
        const auto later = std::upper_bound(result_.events.begin(), result_.events.end(), event,
                                            [](const Event& a, const Event& b) { return a.t < b.t; });
        result_.events.insert(later, event);
    }
    if (outcome_ == Outcome::reached_end) {
        const Frame& present = frames_->of(now_.mode);
        bool still = true, for_good = !mechanics_.asks_functions() && !problem_.joined_elsewhere;
        for (std::size_t i = 0; i < n(); ++i) {
            still = still && present.bodies[i].empty() && (now_.y[n() + i] == 0 || problem_.joined_elsewhere);
        }
        mechanics_.for_each_signal([&](const Signal& s) { for_good = for_good && s.constant_from() <= now_.t.hi; });
        for_good = for_good && mechanics_.states() == 0;
        for (const model::WantedEvent& event : problem_.drive.events) for_good = for_good && event.act == nullptr;
        for (const Joint& joint : problem_.system.joints) {
            for_good = for_good && (joint.friction.function == nullptr || joint.friction.holding[0]);
        }
        if (still) outcome_ = for_good ? Outcome::at_rest : Outcome::stuck_at_end;
        if (still && for_good) {
            auto last = std::find_if(result_.events.rbegin(), result_.events.rend(),
                                     [](const Event& e) { return e.kind == EventKind::stick; });
            if (last != result_.events.rend()) last->kind = EventKind::rest;
        }
    }
    if (now_.mode.friction[0].way != Motion::stuck && !now_.mode.holds(0))
        result_.motion_at_stop = now_.mode.friction[0].way;
    if (!now_.rubs(0) && now_.mode.leans[0] == 0) result_.motion_at_stop = heading_[0];
    if (now_.mode.friction[0].creeps != Motion::stuck) result_.motion_at_stop = now_.mode.friction[0].creeps;
    result_.outcome = outcome_;
    result_.located = conditions_->any();
    const bool lost = outcome_ == Outcome::unresolved || outcome_ == Outcome::chattering;
    result_.noise = lost ? 0 : solver_->clear_noise();
    if (outcome_ == Outcome::chattering) forget_chatter();
    keep_within_walls(now_.y);  // beside a wall its distance has digits that theta has not
    result_.t_start = problem_.window.start;
    result_.t_stop = now_.t.hi;
    if (next_row_ < problem_.rows.count()) result_.table = result_.table.first(next_row_);
    history_->close(now_.t, now_.y);
    result_.history = history_;
    auto carry = std::make_shared<Carry>();
    carry->y = now_.y, carry->low = now_.low, carry->mode = now_.mode, carry->watches = watches_,
    carry->echoes = breaks_.echoes(), carry->heading = heading_, carry->born = pace_.born,
    carry->floor = solver_->floor();
    if (breaks_.longest_delay() > 0 || !problem_.joined_elsewhere) carry->past = history_;
    for (const Signal& load : mechanics_.loads()) carry->controllers.push_back(load.memory());
    result_.carry = std::move(carry);
}

/// Of stops and slips that follow each other at once, and lead nowhere, the first one is told.
void Engine::forget_chatter() {
    constexpr double soon = 1e-6;
    std::vector<Event>& events = result_.events;
    const auto follows = [&](const Event& e, const Event& before) {
        return e.kind <= EventKind::rest && e.t - before.t <= soon * pace_.unit;
    };
    while (events.size() > 1 && follows(events.back(), *(events.end() - 2))) events.pop_back();
}

void Engine::choose(const Frame& frame) {
    double breaks = std::min(mechanics_.next_break(now_.t.hi), breaks_.next());
    for (const model::WantedEvent& event : problem_.drive.events) {
        breaks = std::min(breaks, event.when->next_break(now_.t.hi));
    }
    double limit = std::min(problem_.window.end, breaks);
    if (problem_.step > 0) {
        // A break that rounding puts beside a step's end is that end.
        const double beside = std::max(1e-9 * problem_.step, 4 * rounding * std::fabs(now_.t.hi));
        const double steps = std::floor((now_.t.hi - problem_.window.start + beside) / problem_.step) + 1;
        const double step_end = problem_.window.start + steps * problem_.step;
        if (step_end < limit - beside) limit = step_end;
    }
    double h = std::min({rung(pace_.h, frames_->longest(now_.mode) / 2),
                         mechanics_.view(now_.t.hi, cheb::widest_gap) / 2, breaks_.shortest_delay() / 2 * (1 - 1e-12)});
    if (pace_.bad_time < model::never) h = std::min(h, now_.t.until(pace_.bad_time) / 4);
    if (problem_.step == 0) h = std::min(h, longest_under_friction(frame) / 2);
    // As long as it takes to a wall, or back to it, and a little more: a small bounce is to be seen.
    if (has_walls_) h = std::min(h, std::max(0.6 * until_wall(frame), 1e-9 * pace_.unit));
    const double remaining = now_.t.until(limit);
    const bool to_limit = remaining <= 2 * h * (1 + 1e-9);
    segment_.start = now_.t;
    segment_.h = to_limit ? remaining / 2 : remaining < 4 * h ? remaining / 4 : h;
    segment_.end = to_limit ? limit : now_.t.after(2 * segment_.h);
    segment_.from_break = now_.after_break;
    segment_.to_break = to_limit && limit == breaks;
    segment_.to_the_end = to_limit && (segment_.to_break || limit == problem_.window.end || problem_.step == 0);
}

/// How long it takes to the next wall, if all accelerations stay as they are.
double Engine::until_wall(const Frame& frame) {
    double first = model::never;
    if (!look({now_.t.hi, now_.side(), now_.departing(problem_.system)}, now_.mode, frame, look_)) return first;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const Joint& joint = problem_.system.joints[j];
        const model::Walls* walls = joint.any_walls();
        if (walls == nullptr || now_.mode.holds(j) || now_.mode.presses[j] != 0) continue;
        const double rate = joint.sum(look_.accelerations);
        for (const int wall : {1, -1}) {
            const double apart = std::max(0.0, wall * now_.gap(problem_.system.joints[j], walls->at(wall)));
            const double v = wall * mechanics_.velocity(j, now_.y);
            const double a = wall * rate, root = v * v + 2 * a * apart;
            if (!(root >= 0) || !(apart < model::never)) continue;
            const double t = v > 0   ? 2 * apart / (v + std::sqrt(root))
                             : a > 0 ? (std::sqrt(root) - v) / a
                                     : model::never;
            if (t > 0) first = std::min(first, t);
        }
    }
    return first;
}

/// How long a stretch may be under laws of friction that bend with the speed.
double Engine::longest_under_friction(const Frame& frame) {
    double longest = model::never;
    bool looked = false;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const Joint& joint = problem_.system.joints[j];
        const model::Friction& law = joint.friction.law;
        const Slipping& how = now_.mode.friction[j];
        if (law.ranges() == 0 || how.way == Motion::stuck || how.riding || now_.mode.leans[j] != 0) continue;
        if (!looked && !look({now_.t.hi, now_.side(), now_.departing(problem_.system)}, now_.mode, frame, look_))
            return longest;
        looked = true;
        const double sign = model::sign_of(how.way);
        const double lightness = joint.lightness(problem_.system.bodies), first = joint.sum(look_.accelerations);
        const double C = joint.damping, v = mechanics_.velocity(j, now_.y);
        const double second = (std::fabs(joint.stiffness * v) + std::fabs(C * first)) * lightness;
        longest =
            std::min(longest, longest_step(law, law.range(how.range), std::max(0.0, sign * now_.slip(mechanics_, j)),
                                           sign * first, second, C, 1 / lightness));
    }
    return longest;
}

void Engine::again(Collocation::Attempt attempt) {
    const int most = samples_ ? most_attempts_sampled : most_attempts;
    if (chatter_.too_many_attempts(now_.t.hi, most)) {
        fail(samples_ ? Outcome::chattering : Outcome::unresolved);
        return;
    }
    if (attempt == Collocation::Attempt::failed) {
        pace_.bad_time = solver_->bad_time();
        const double near = std::max(near_failure * pace_.unit, 64 * rounding * std::fabs(now_.t.hi));
        if (problem_.step > 0 || now_.t.until(pace_.bad_time) <= near || !mechanics_.may_go_on())
            fail(now_.greatest_of_state() > huge ? Outcome::state_not_finite : Outcome::excitation_not_finite);
        pace_.h = segment_.h / 2;
        return;
    }
    if (solver_->found_noise(segment_, now_.mode)) return;
    if (!breaks_.many() && pace_.may_search(now_.t.hi, segment_.h)) {
        const auto found = solver_->found_break(segment_);
        if (found && *found > now_.t.hi && breaks_.add(*found)) {
            if (a_belt_jumps_at(*found)) mechanics_.jumps_at(*found);
            return;
        }
    }
    pace_.shorten(segment_.h, solver_->unresolved(), frames_->longest(now_.mode));
}

bool Engine::a_belt_jumps_at(double t) const {
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (solver_->belt_jumps(segment_, j, t)) return true;
    }
    return false;
}

/// On a step, of which nobody asks whether it was resolved.
bool Engine::belt_jump_found() {
    std::optional<double> first;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const auto found = solver_->jump_of_belt(segment_, j);
        if (found && (!first || *found < *first)) first = found;
    }
    if (!first) return false;
    constexpr double right_behind = 1e-6;
    if (now_.t.until(*first) < right_behind * segment_.h) {  // it is behind this moment, and was before it
        if (now_.after_break) return false;
        now_.after_break = true;
        mechanics_.jumps_at(now_.t.hi);
        find_belt_slopes({});
        restart_contacts(Because::belt);
        return true;
    }
    if (!breaks_.add(*first)) return false;
    mechanics_.jumps_at(*first);
    return true;
}

/// The name of a state that has come to where its rate jumps, and drives it back from both sides; empty where none has.
std::string Engine::state_driven_back() {
    constexpr double near = 1e-9, steep = 1e6;
    mechanics_.for_each_piecewise(now_.t.hi, [](Piecewise& function) { function.let_go(); });
    std::vector<double> y = now_.y, rates(mechanics_.states());
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) {
        const auto rate = [&](double by) {
            y[2 * n() + k] = now_.y[2 * n() + k] + by;
            mechanics_.rates({now_.t.hi, now_.side(), y}, rates.data());
            return rates[k];
        };
        const double own = std::max(std::fabs(rate(0)), std::fabs(rate(near * std::fabs(now_.y[2 * n() + k]))));
        const double d =
            near * std::max(own * pace_.unit, std::fabs(now_.y[2 * n() + k])) + std::numeric_limits<double>::min();
        const double least = std::min(-rate(d), rate(-d));
        y[2 * n() + k] = now_.y[2 * n() + k];
        if (least * pace_.unit > steep * d) return problem_.drive.states[k].name;
    }
    return {};
}

/// The run got nowhere: if something that acts in it is rough on every scale, that is why.
void Engine::explain_end() {
    const double most = std::min({pace_.unit, problem_.window.end - now_.t.hi, breaks_.shortest_delay()});
    const double from = now_.t.hi, length = std::min(rough_stretch * pace_.unit, most / 8);
    struct Source {
        std::string name;
        std::function<double(double)> value;
        double beside;  ///< how great is what it is added to
    };
    std::vector<Source> sources;
    const auto of = [&](const char* what, const std::string& who) {
        return problem_.system.named ? fmt::format("{} of {}", what, who) : std::string(what);
    };
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        const auto load = [this, i](double t) { return mechanics_.load(i, {t, Side::at, now_.y}); };
        sources.push_back({of("M", problem_.system.joints[i].name), load, mechanics_.size_of(i, now_.here())});
    }
    sources.push_back({"the base", [&](double t) { return mechanics_.base(t, Side::at); }, 0});
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!mechanics_.has_belt(j)) continue;
        const auto belt = [this, j](double t) { return mechanics_.belt(j, t, Side::at); };
        sources.push_back({of("the belt", problem_.system.joints[j].name), belt, 0});
    }
    std::vector<double> rates(mechanics_.states());
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) {
        const auto rate = [this, k, &rates](double t) {
            mechanics_.rates({t, Side::at, now_.y}, rates.data());
            return rates[k];
        };
        sources.push_back({"the rate of " + problem_.drive.states[k].name, rate, 0});
    }
    double worst = 64 * rounding;
    for (const Source& source : sources) {
        const Roughness look = roughness(source.value, {from, from + 2 * length, from + 5 * length}, length);
        const double part = look.most / (look.size + source.beside);
        if (!look.is_noise() || !(part > worst)) continue;
        worst = part;
        result_.rough = Rough{source.name, look.most, part};
        outcome_ = Outcome::unresolved;
    }
    const std::string state = result_.rough ? "" : state_driven_back();
    if (state.empty()) return;
    result_.rough = Rough{"the rate of " + state};
    outcome_ = Outcome::chattering;
}

/// Whether nothing that may still come moves any body.
bool Engine::stands_for_good() {
    const Frame& present = frames_->of(now_.mode);
    if (present.groups() > 0 || !present.closing.empty() || mechanics_.states() > 0 || mechanics_.has_base())
        return false;
    if (mechanics_.has_belts() || !problem_.drive.events.empty()) return false;
    bool constant = true;
    mechanics_.for_each_signal([&](const Signal& s) { constant = constant && s.constant_from() <= now_.t.hi; });
    std::vector<double> greatest_pull(mechanics_.joints()), lacking(n()), held(mechanics_.joints());
    std::vector<double> none(mechanics_.joints()), torques;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!mechanics_.is_native(j) || now_.mode.friction[j].riding) return false;
        if (!constant && (now_.mode.leans[j] != 0 || now_.mode.friction[j].creeps != Motion::stuck)) return false;
    }
    if (constant) return true;
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        const double most = mechanics_.loads()[i].most();
        if (!(most < model::never)) return false;
        lacking.assign(n(), 0);
        for (const auto& [body, by] : problem_.system.joints[i].of) lacking[body] = by;
        present.multipliers(lacking, held);
        for (std::size_t j = 0; j < held.size(); ++j) greatest_pull[j] += most * std::fabs(held[j]);
    }
    mechanics_.torques(now_.here(), now_.mode, std::vector<double>(mechanics_.joints()), none, torques);
    for (std::size_t i = 0; i < n(); ++i) lacking[i] = -torques[i];
    present.multipliers(lacking, held);
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!now_.mode.holds(j) || now_.mode.rigid[j] != 0) continue;
        if (!(greatest_pull[j] - held[j] <= mechanics_.holding(j, Motion::forward, now_.here()))) return false;
        if (!(greatest_pull[j] + held[j] <= mechanics_.holding(j, Motion::backward, now_.here()))) return false;
    }
    return true;
}

/// There is nothing to compute but the loads at the rows, of which there may be many.
bool Engine::rest() {
    constexpr std::size_t rows_at_once = 1U << 12U;
    const bool many = problem_.rows.count() - next_row_ > rows_at_once;
    segment_.start = now_.t;
    segment_.end = many ? problem_.rows.time(next_row_ + rows_at_once) : problem_.window.end;
    segment_.h = now_.t.until(segment_.end) / 2;
    segment_.from_break = segment_.to_break = false, segment_.to_the_end = true;
    solver_->stand_still(segment_, now_.y);
    sampled_.clear();
    return end_at(1);
}

bool Engine::advance() {
    if (now_.greatest_of_state() > beyond_all) return fail(Outcome::state_not_finite);
    if (stands_for_good()) return rest();
    const Frame& present = frames_->of(now_.mode);
    const double longest = frames_->longest(now_.mode);
    choose(present);
    if (!(segment_.h > 0)) return fail(Outcome::chattering);
    conditions_->decide({now_.t.hi, now_.side(), now_.departing(problem_.system)}, now_.mode, segment_);
    segment_.low = now_.low, sampled_.clear();
    const auto attempt = solver_->solve(segment_, now_.mode, present, now_.y, now_.departing(problem_.system));
    const double late = std::max(std::fabs(now_.t.hi), std::fabs(segment_.end));
    if (problem_.step > 0 && attempt == Collocation::Attempt::resolved && mechanics_.has_belts() && belt_jump_found()) {
        return outcome_ == Outcome::reached_end;
    }
    if (attempt == Collocation::Attempt::shorten && !solver_->tells_rests() &&
        2 * segment_.h <= std::max(shortest * pace_.unit, 16 * rounding * late)) {
        if (chatter_.too_many_short()) return fail(Outcome::chattering);
        solver_->pass_over(segment_);
        solver_->find_limits(segment_, now_.mode);
        pace_.h = 64 * segment_.h;
    } else if (attempt != Collocation::Attempt::resolved) {
        again(attempt);
        return outcome_ == Outcome::reached_end;
    } else {
        chatter_.stretch_of(2 * segment_.h);
        const double least = segment_.h < short_part * longest ? 2 : 0;
        const double factor =
            problem_.step > 0 ? longest / segment_.h : std::clamp(0.9 * solver_->growth(), least, samples_ ? 2.0 : 8.0);
        pace_.lengthen(segment_.h, factor, longest);
    }
    Ending ending;
    watch(present, ending);
    if (outcome_ != Outcome::reached_end) return false;
    if (ending.by == By::condition && ends_before(ending.x)) return true;
    record_turns(present, ending.x);
    if (!end_at(ending.x)) return false;
    return handle(ending);
}

/// The stretch ends at x: its rows, and the present.
bool Engine::end_at(double x) {
    const bool whole = x >= 1;
    const double length = whole ? 2 * segment_.h : segment_.h * (1 + x);
    if (!rows_until(whole ? segment_.end : segment_.start.later(length).hi, whole)) {
        return fail(Outcome::excitation_not_finite);
    }
    keep(length);
    const double between = std::min(length, solver_->gap(segment_));
    if (mechanics_.has_functions()) result_.gap = std::max(result_.gap, between);
    if (!segment_.proven) result_.unproven = std::max(result_.unproven, problem_.step > 0 ? between : length);
    if (x > -1) go_to(x);
    now_.t = whole && segment_.to_the_end ? Clock{segment_.end, 0} : segment_.start.later(length);
    now_.after_break = whole && segment_.to_break && now_.t.hi < problem_.window.end;
    if (now_.after_break) conditions_->pass_break(now_.t.hi);
    mechanics_.forget_jumps(now_.t.hi);
    if (pace_.bad_time <= now_.t.hi) pace_.bad_time = model::never, mechanics_.forget_failure();
    breaks_.pass(now_.t.hi, problem_.window.end);
    if (length > 0) {
        for (Slipping& how : now_.mode.friction) how.leaving = false;
        if (whole) {
            for (Slipping& how : now_.mode.friction) how.blunt = 0;
        }
        std::fill(edge_.begin(), edge_.end(), 0);
        std::fill(at_wall_.begin(), at_wall_.end(), 0);
    }
    const bool echoed = breaks_.pass_echoes(now_.t.hi);
    if (!whole || (now_.after_break && !echoed)) breaks_.echo(now_.t.hi, 1);
    find_belt_slopes(now_.after_break ? std::nullopt : std::optional(x));
    project(now_.after_break ? Side::before : Side::at);
    bool good = true;
    mechanics_.for_each_signal([&](Signal& s) { good = good && s.arrive(now_.here()); });
    if (!good) return fail(Outcome::excitation_not_finite);
    const bool changed = open_and_close();
    if (now_.after_break) return ask_after_break();
    return !changed || (decide(true) && (!too_often() || fail(Outcome::chattering)));
}

/// Loads, limits and belts may have jumped: what holds is asked again.
bool Engine::ask_after_break() {
    if (!mechanics_.has_belts()) return decide(true);
    // What is moved with a new velocity at once throws all that is rigidly linked to it.
    const std::vector<double> before = now_.y;
    const double energy = kinetic_energy();
    if (problem_.hidden > 0) project(now_.side());
    for (std::size_t j = told_joints(); j < mechanics_.joints(); ++j) {
        const std::size_t body = moved_body(j);
        const double v = now_.y[n() + body], jump = v - before[n() + body];
        if (!(std::fabs(jump) > 64 * rounding * (std::fabs(v) + std::fabs(before[n() + body])))) continue;
        history_->add_jump(now_.t.hi, body, {.input = kinetic_energy() - energy});
        heading_[body] = model::motion_of(v);
        conditions_->forget();
        tell(EventKind::impact, static_cast<int>(body));
        break;
    }
    return restart_contacts(Because::belt);
}

double Engine::kinetic_energy() const {
    double sum = 0;
    for (std::size_t i = 0; i < n() && problem_.hidden > 0; ++i) {
        sum += mechanics_.own_inertia(i) * now_.y[n() + i] * now_.y[n() + i] / 2;
    }
    return sum;
}

/// The present is at x of the stretch. What is rounded off the angles is kept: beside a wall it is seen.
void Engine::go_to(double x) {
    const std::vector<double> begin = now_.y;
    segment_.state(x, now_.y);
    for (std::size_t i = 0; i < n(); ++i) {
        const double moved =
            (x >= 1 ? segment_.moved[i][node_count - 1] : cheb::value(segment_.series[i], x)) + now_.low[i];
        now_.y[i] = begin[i] + moved;
        const double added = now_.y[i] - begin[i];
        now_.low[i] = (begin[i] - (now_.y[i] - added)) + (moved - added);
    }
    for (std::size_t j = 0; has_walls_ && j < mechanics_.joints(); ++j) {
        if (problem_.system.joints[j].any_walls() != nullptr)
            reach_[j] = std::max(reach_[j], std::fabs(now_.gap(problem_.system.joints[j], origin_[j])));
    }
}

void Engine::keep(double length) {
    if (!(length > 0) || (!problem_.limits.dense && breaks_.longest_delay() == 0)) return;
    Kept kept{.start = segment_.start, .h = segment_.h, .length = length, .begin = now_.y, .series = segment_.series};
    // For the legs of its course.
    if (problem_.limits.dense && problem_.keeps_torques) kept.acting = acting();
    const double past = breaks_.longest_delay() > 0 ? now_.t.hi - 2 * breaks_.longest_delay() : model::never;
    history_->add(std::move(kept), problem_.limits.dense, past);
}

/// What acts at each joint on the stretch.
std::vector<Kept::Acting> Engine::acting() {
    std::vector<Kept::Acting> all(mechanics_.joints());
    for (std::size_t j = 0; j < all.size(); ++j) {
        all[j].M = segment_.driven[j];
        // What depends on the motion was evaluated before the last step of the iteration.
        for (std::size_t node = 0; node < node_count && mechanics_.loads()[j].asks_the_motion(); ++node) {
            all[j].M[node] = segment_.loads[j][node] + mechanics_.loads()[j].of_motion(segment_.moment(node, point_));
        }
        if (j < n()) {
            if (mechanics_.has_base()) all[j].push = std::make_unique<Nodes>();
            for (std::size_t node = 0; node < node_count && mechanics_.has_base(); ++node) {
                double& push = (*all[j].push)[node];
                push = -problem_.system.bodies[j].inertia * mechanics_.base(segment_.times[node], segment_.side(node));
                all[j].M[node] -= push;
            }
        }
        all[j].holds = now_.rubs(j) && now_.mode.leans[j] == 0 && now_.mode.friction[j].way == Motion::stuck;
        if (j >= told_joints()) {  // what moves a body is its input
            const std::size_t body = moved_body(j);
            const double more = mechanics_.own_inertia(body) - problem_.system.bodies[body].inertia;
            for (std::size_t node = 0; node < node_count; ++node) {
                all[body].M[node] += segment_.holding[j][node] + more * segment_.f[n() + body][node];
            }
            continue;
        }
        Nodes springs{};
        all[j].presses = now_.mode.presses[j] != 0;
        if (all[j].presses) {
            const model::Walls& stops = *problem_.system.joints[j].stops;
            springs = mechanics_.between(j, segment_.y);
            for (double& q : springs) q = stops.torque(now_.mode.presses[j], q, 0);
        }
        for (std::size_t s = 0; s < now_.mode.sliders.size(); ++s) {
            const Mechanics::Slider& slider = mechanics_.sliders()[s];
            if (slider.joint != j) continue;
            if (now_.mode.sliders[s] == Motion::stuck) {
                add(springs, segment_.y[slider.bend], slider.stiffness);
            } else {
                all[j].slides += slider.stiffness * segment_.y[slider.bend][0];
            }
        }
        if (greatest(springs) > 0) all[j].springs = std::make_unique<Nodes>(springs);
        if (mechanics_.has_belt(j)) all[j].belt = std::make_unique<Nodes>(segment_.belts[j]);
        if (all[j].holds) {
            all[j].friction = segment_.holding[j];
        } else if (mechanics_.is_native(j) && now_.rubs(j) && now_.mode.leans[j] == 0) {
            const Nodes slips = mechanics_.slips(j, segment_.y, segment_.belts[j]);
            mechanics_.add_native_friction(j, now_.mode, slips, 0, node_count, all[j].friction);
            for (double& torque : all[j].friction) torque = -torque;
        } else if (now_.rubs(j) || mechanics_.bristle(j) != nullptr) {
            for (std::size_t node = 0; node < node_count; ++node) {
                const Moment at = segment_.moment(node, point_);
                all[j].friction[node] =
                    mechanics_.friction(j, at, now_.mode, segment_.belts[j][node]) + mechanics_.slider_torque(j, at.y);
            }
        }
    }
    return all;
}

/// What a joint stores, with its body's kinetic energy where it is that of a body with the ground.
double Engine::energy_at(std::size_t joint, const std::vector<double>& y) const {
    const Joint& own = problem_.system.joints[joint];
    const double q = mechanics_.angle(joint, y);
    const double kinetic =
        joint < n() ? problem_.system.bodies[joint].inertia * y[n() + joint] * y[n() + joint] / 2 : 0;
    return kinetic + own.stiffness * q * q / 2 + own.spring.energy(q);
}

bool Engine::handle(const Ending& ending) {
    const std::size_t j = ending.which;
    switch (ending.by) {
        case By::nobody:
        case By::kink:
            return true;
        case By::stays:
            return decide(true);
        case By::slip: {
            const double fastest = std::fabs(mechanics_.belt(j, now_.t.hi, now_.side())) + greatest(segment_.y[n()]);
            // What passed zero because the belt jumped has not come to a standstill.
            constexpr double clearly = 1e-6;
            if (mechanics_.has_belt(j) && std::fabs(now_.slip(mechanics_, j)) > clearly * fastest &&
                now_.mode.leans[j] == 0) {
                return restart_contacts(Because::belt) && (!too_often() || fail(Outcome::chattering));
            }
            for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
                const Slipping& how = now_.mode.friction[i];
                if (!now_.rubs(i) || how.way == Motion::stuck || how.riding || now_.mode.leans[i] != 0) continue;
                const model::Weight& first = problem_.system.joints[i].of.front();
                const double size = std::max(fastest, std::fabs(first.by) * greatest(segment_.y[n() + first.body]));
                if (i == j || std::fabs(now_.slip(mechanics_, i)) <= 64 * rounding * size) arrived_[i] = how.way;
            }
            if (now_.mode.leans[j] != 0) {  // the belt turns along a mass at a wall
                slide(j, now_.mode.friction[j].way == Motion::forward ? Motion::backward : Motion::forward, true);
                arrived_[j] = Motion::stuck;
            }
            return decide(true) && (!too_often() || fail(Outcome::chattering));
        }
        case By::release: {
            left_ = now_.mode;
            const double blunt = now_.mode.friction[j].blunt;
            if (!decide(true, ending)) return false;
            bool same = now_.mode.leans == left_.leans;
            for (std::size_t i = 0; i < mechanics_.joints() && same; ++i) {
                same = now_.mode.friction[i].way == left_.friction[i].way &&
                       now_.mode.friction[i].riding == left_.friction[i].riding &&
                       now_.mode.friction[i].creeps == left_.friction[i].creeps;
            }
            // What only touched its limit must pass it clearly the next time.
            if (same) {
                Slipping& how = now_.mode.friction[j];
                const double size = torque_sizes().on(joint_at(j));
                how.blunt = std::max(2 * blunt, 64 * rounding * size);
                if (how.blunt > most_blunt * size) return fail(Outcome::chattering);
            }
            return !too_often() || fail(Outcome::chattering);
        }
        case By::wall:
            return hit(j, ending.side);
        case By::stop: {
            const model::Walls& stops = *problem_.system.joints[j].stops;
            const int side = ending.side != 0 ? ending.side : now_.mode.presses[j];
            origin_[j] = stops.at(side), reach_[j] = 0;
            const bool there =
                std::fabs(now_.gap(problem_.system.joints[j], origin_[j])) <= 64 * rounding * std::fabs(origin_[j]);
            at_wall_[j] = ending.side == 0 && there ? 1 : 0;
            press(j, ending.side);
            breaks_.echo(now_.t.hi, 1);
            return decide(true) && (!too_often() || fail(Outcome::chattering));
        }
        case By::slider:
            if (static_cast<Motion>(ending.side) == Motion::stuck) {
                // What its slip has left, and its spring beyond its limit, is rounding: it would slide again at once.
                const Mechanics::Slider& own = mechanics_.sliders()[j];
                const model::Weight& first = problem_.system.joints[own.joint].of.front();
                now_.y[n() + first.body] -= now_.slip(mechanics_, own.joint) / first.by;
                now_.y[own.bend] *= 1 - 8 * rounding;
            }
            let_slide(j, static_cast<Motion>(ending.side));
            return decide(true) && (!too_often() || fail(Outcome::chattering));
        case By::corner: {
            Slipping& how = now_.mode.friction[j];
            how.range = ending.side > 0 ? how.range + 1 : how.range - 1;
            edge_[j] = -ending.side;
            return !too_often() || fail(Outcome::chattering);
        }
        case By::condition: {
            const Conditions::Crossed crossed = conditions_->cross(ending, now_.here(), too_often());
            result_.jumps += crossed.count;
            if (crossed.endless && crossed.jumps) return fail(Outcome::chattering);
            return decide(true);
        }
        case By::relay:
            mechanics_.loads()[j].toggle(index(ending.side));
            tell(EventKind::switched, static_cast<int>(j));
            if (!decide(true)) return false;
            return !too_often() || fail(Outcome::chattering);
        case By::user:
            return act_all(ending.users);
    }
    return true;
}

void Engine::tell(EventKind kind, int where, int user) {
    result_.events.push_back(event_at(kind, where, user));
}

/// An event of the user concerns every joint: each gets one, with its own angle and velocity.
void Engine::tell_user(std::size_t event) {
    for (std::size_t j = 0; j < told_joints(); ++j) {
        tell(EventKind::user, static_cast<int>(j), static_cast<int>(event));
    }
}

Event Engine::event_at(EventKind kind, int where, int user) const {
    const std::size_t joint = index(where);
    const std::size_t loaded = kind == EventKind::switched ? joint : problem_.system.joints[joint].first();
    return {.t = now_.t.hi,
            .kind = kind,
            .theta = mechanics_.angle(joint, now_.y),
            .M = mechanics_.load(loaded, now_.here()),
            .user = user,
            .where = where,
            .velocity = mechanics_.velocity(joint, now_.y)};
}

// ---- guards

void Engine::watch(const Frame& frame, Ending& ending) {
    const TorqueSizes sizes = torque_sizes();
    std::fill(crept_.begin(), crept_.end(), 0);
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (now_.mode.holds(j) && now_.mode.rigid[j] == 0) watch_release(j, frame, sizes.on(joint_at(j)), ending);
        if (now_.rubs(j) && now_.mode.friction[j].way != Motion::stuck && !now_.mode.friction[j].riding) {
            watch_slip(j, sizes.on(joint_at(j)), ending);
            watch_corner(j, ending);
        }
        const auto& [walls, stops] = std::tie(problem_.system.joints[j].walls, problem_.system.joints[j].stops);
        if (walls && now_.mode.leans[j] == 0) watch_walls(j, *walls, By::wall, ending);
        if (stops) watch_stop(j, ending);
        if (mechanics_.has_normal(j) || (mechanics_.may_open(j) && !now_.rubs(j))) watch_normal(j, ending);
        if (mechanics_.bristle(j) != nullptr) watch_bristles(j, ending);
    }
    for (std::size_t s = 0; s < now_.mode.sliders.size(); ++s) {
        // Where others hold its contact, what is left of the slip is rounding.
        if (!frame.keeps(mechanics_.sliders()[s].joint)) watch_slider(s, ending);
    }
    watch_relays(ending);
    if (conditions_->any()) conditions_->watch(segment_, now_.y, now_.t.hi, ending);
    watch_users(ending);
    if (ending.x > -1 && ending.x < 1 && segment_.time(ending.x) >= segment_.end) ending.x = 1;
}

void Engine::watch_slip(std::size_t joint, double torques, Ending& ending) {
    const Joint& own = problem_.system.joints[joint];
    const Slipping& how = now_.mode.friction[joint];
    const double sign = model::sign_of(how.way);
    const Nodes& belt = segment_.belts[joint];
    const bool leans = now_.mode.leans[joint] != 0;
    const Nodes turns = leans ? Nodes{} : mechanics_.between(joint, std::span(segment_.y).subspan(n()));
    const double first = how.leaving ? 0 : turns[0] - belt[0];
    Series series{};
    if (!leans) series = mechanics_.between(joint, std::span(segment_.series).subspan(n()));
    if (mechanics_.has_belt(joint)) {
        Nodes change{};
        for (std::size_t j = 0; j < node_count; ++j) change[j] = belt[j] - belt[0];
        series = difference(series, cheb::fit(change));
    }
    series[0] += first;
    double fastest = greatest(belt), inertia = model::never;
    for (const auto& [body, by] : own.of) {
        fastest += std::fabs(by) * greatest(segment_.y[n() + body]);
        inertia = std::min(inertia, problem_.system.bodies[body].inertia / (by * by));
    }
    // All that goes on in the stretch is slower than the rounding of its torques could make it, or leaves no trace in
    // the angle.
    const double drive = fastest * (own.damping + inertia / (2 * segment_.h)) / (rounding * torques);
    const bool no_way = fastest * 2 * segment_.h <= rounding / 2 * std::fabs(mechanics_.angle(joint, now_.y));
    const bool crept = drive <= (no_way ? 256 : 4) && may_creep(joint);
    if (crept) {
        crept_[joint] = 1;
        if (!how.leaving && ending.by == By::nobody) ending = {1, By::slip, joint};
        if (!how.leaving) return;
    }
    if (!how.leaving && stays_above_zero(sign, series, fastest)) return;
    Nodes slips{};
    for (std::size_t j = 0; j < node_count; ++j) {
        slips[j] = -(belt[j] - belt[0]);
    }
    for (const auto& [body, by] : own.of) {
        const Nodes& v = segment_.y[n() + body];
        for (std::size_t j = 0; j < node_count && !leans; ++j) slips[j] += by * (v[j] - v[0]);
    }
    for (double& slip : slips) {
        slip = sign * (first + slip);
    }
    cheb::Bounded<node_count> curve(sign, series, cheb::derivative(series), slips);
    if (own.of.size() > 1 || mechanics_.has_belt(joint)) curve.raise_floor(16 * rounding * fastest);
    curve.raise_slope_floor(segment_.h / inertia * 64 * rounding * torques);
    const auto always = [](double) { return true; };
    const auto start = how.leaving ? cheb::LeftEnd::leaving : cheb::LeftEnd::anywhere;
    auto zero = cheb::first_below(curve, -1, start, always);
    if (how.leaving && zero && *zero <= -1 &&
        !mechanics_.has_belt(joint)) {  // the motion may be known less well than it is rounded
        curve.raise_floor(std::fabs(own.of.front().by) * solver_->uncertain(own.first(), segment_));
        zero = cheb::first_below(curve, -1, start, always);
    }
    if (!zero && curve(1) <= curve.floor()) zero = 1;
    // What only touches zero does so where it is lowest.
    if (zero && *zero > -1 && *zero < 1) {
        if (const double lowest = curve.lowest_near(*zero); curve(lowest) >= -curve.floor()) zero = lowest;
    }
    if (!zero || *zero > ending.x) return;
    ending = {*zero, By::slip, joint};
    if (!how.leaving || *zero > -1) return;
    // It was let go and does not leave: what is told of that was none, and it must be pulled clearly farther.
    ending.by = By::stays;
    take_back_slip(joint);
    Slipping& stays = now_.mode.friction[joint];
    stays.way = Motion::stuck, stays.leaving = false;
    stays.blunt = std::max(2 * stays.blunt, 64 * rounding * torques);
    if (too_often() || stays.blunt > most_blunt * torques) fail(Outcome::chattering);
}

/// It has no belt, and nothing asks for its motion: what it is under is known as well as the rounding.
bool Engine::may_creep(std::size_t joint) const {
    return mechanics_.all_linear() && !mechanics_.has_belt(joint) && now_.mode.leans[joint] == 0;
}

/// What was told to slip right now, and did not. Whether there was such an event.
bool Engine::take_back_slip(std::size_t joint) {
    auto told = std::find_if(result_.events.rbegin(), result_.events.rend(), [&](const Event& e) {
        return e.where == static_cast<int>(joint) && e.kind == EventKind::slip && e.t == now_.t.hi;
    });
    if (told == result_.events.rend()) return false;
    result_.events.erase(std::next(told).base());
    return true;
}

/// Where what holds a joint passes what it can hold.
void Engine::watch_release(std::size_t joint, const Frame& frame, double torques, Ending& ending) {
    Nodes pull{};
    for (std::size_t j = 0; j < node_count; ++j) pull[j] = -segment_.holding[joint][j];
    const Series series = cheb::fit(pull);
    const int wall = now_.mode.leans[joint];
    for (const Motion side : {Motion::forward, Motion::backward}) {
        const double sign = model::sign_of(side);
        if (wall * sign > 0) continue;
        const bool sticks = now_.rubs(joint) && now_.mode.friction[joint].way == Motion::stuck;
        Nodes limit{};
        if (mechanics_.limits_change(joint, now_.mode)) {
            limit = segment_.limits[joint][side == Motion::forward ? 1 : 0];
            if (!std::all_of(limit.begin(), limit.end(), [](double x) { return std::isfinite(x); })) {
                fail(Outcome::excitation_not_finite);
                return;
            }
        } else {
            limit.fill(sticks ? mechanics_.holding(joint, side, now_.here()) : 0);
            if (std::isinf(limit[0])) continue;  // a freewheel, backward
        }
        if (const Slipping& how = now_.mode.friction[joint]; how.creeps != Motion::stuck) {
            const double level = mechanics_.sliding(joint, {.way = how.creeps}, 0, now_.here());
            limit.fill(side == how.creeps ? how.apart + level : how.apart - level);
        }
        Nodes values{};
        const double blunt = now_.mode.friction[joint].blunt;
        for (std::size_t j = 0; j < node_count; ++j) values[j] = limit[j] - sign * pull[j] + blunt;
        const Series left = cheb::fit(values);
        cheb::Bounded<node_count> curve(1, left, cheb::derivative(left), values);
        const double doubt = 8 * (rounding * (greatest(limit) + torques) + cheb::tail(series) +
                                  (mechanics_.varies(joint) ? cheb::tail(cheb::fit(limit)) : 0)) +
                             solver_->blurred_by_belts(segment_) + (1 - known()) * greatest(pull);
        curve.raise_floor(doubt);
        const auto lets_go = [&](double x) {
            std::vector<double> y;
            segment_.state(x, y);
            const Moment at{segment_.time(x), x <= -1 ? segment_.side(0) : Side::at, y};
            Look found;
            if (!look(at, now_.mode, frame, found, x)) return false;
            Motion towards = Motion::stuck;
            return excess(joint, found, now_.mode, at, towards) > 0 && towards == side;
        };
        std::optional<double> touch;
        const auto touches = [&](double x) {
            if (blunt > 0) return false;
            for (const double place : {x, curve.lowest_near(x)}) {
                if (!touch && lets_go(place)) touch = place;
            }
            return touch.has_value();
        };
        // A jump that was passed over may have taken it far beyond.
        auto x =
            values[0] < -doubt ? std::optional(-1.0) : cheb::first_below(curve, -1, cheb::LeftEnd::anywhere, touches);
        if (x && touch) x = first_true(lets_go, *touch);
        if (!x || !(*x < ending.x) || !(segment_.time(*x) < segment_.end)) continue;
        ending = {*x, By::release, joint, static_cast<int>(side)};
    }
}

void Engine::watch_walls(std::size_t joint, const model::Walls& walls, By by, Ending& ending) const {
    const auto no = [](double) { return false; };
    for (const int wall : {1, -1}) {
        const double place = walls.at(wall);
        if (!std::isfinite(place)) continue;
        const double begin = wall * now_.gap(problem_.system.joints[joint], place);
        Nodes change = mechanics_.between(joint, segment_.moved);
        for (double& way : change) way *= -wall;
        // What begins at the wall is known as well as its way from there.
        const bool leaving = at_wall_[joint] != 0 && std::fabs(begin) <= 4 * rounding * std::fabs(place);
        const double far = leaving ? greatest(change) : std::max(reach_[joint], std::fabs(place - origin_[joint]));
        Series left = cheb::fit(change);
        if (!leaving) left[0] += begin;
        cheb::Bounded<node_count> curve(1, left, cheb::derivative(left));
        curve.raise_floor(64 * rounding * far);
        const auto x = cheb::first_below(curve, -1, leaving ? cheb::LeftEnd::leaving : cheb::LeftEnd::anywhere, no);
        if (x && *x < ending.x) ending = {*x, by, joint, wall};
    }
}

/// An elastic wall is pressed while its depth and its torque are both positive. Before it is, the depth is, or, where
/// it was left before the motion came back to its place, the torque will be.
void Engine::watch_stop(std::size_t joint, Ending& ending) const {
    const model::Walls& stops = *problem_.system.joints[joint].stops;
    const Nodes angle = mechanics_.between(joint, segment_.y),
                velocity = mechanics_.between(joint, std::span(segment_.y).subspan(n()));
    const int pressed = now_.mode.presses[joint];
    const int deep = pressed != 0 ? pressed : angle[0] > stops.upper ? 1 : angle[0] < stops.lower ? -1 : 0;
    if (deep == 0 || (pressed == 0 && at_wall_[joint] != 0)) return watch_walls(joint, stops, By::stop, ending);
    if (pressed == 0) {  // it may come to the other wall before
        model::Walls other = stops;
        (deep > 0 ? other.upper : other.lower) = deep * model::never;
        watch_walls(joint, other, By::stop, ending);
    }
    std::vector<double> y;
    const auto value = [&](double q, double v) {
        const double torque = deep * stops.torque(deep, q, v);
        return pressed != 0 ? torque : std::min(torque, stops.stiffness * deep * (q - stops.at(deep)));
    };
    const auto exact = [&](double x) {
        segment_.state(x, y);
        return value(mechanics_.angle(joint, y), mechanics_.velocity(joint, y));
    };
    Nodes values{};
    for (std::size_t j = 0; j < node_count; ++j) values[j] = value(angle[j], velocity[j]);
    Half half = pressed != 0 ? 1 : -1;
    const double rounded = 64 * rounding * stops.stiffness * std::fabs(stops.at(deep));
    const auto x = Watched(values, exact, pressed != 0 ? 0 : rounded).leaves(half, -1);
    if (x && *x < ending.x) ending = {*x, By::stop, joint, pressed != 0 ? 0 : deep};
}

/// Where a law of friction goes on with another formula.
void Engine::watch_corner(std::size_t joint, Ending& ending) const {
    const Joint& own = problem_.system.joints[joint];
    const model::Friction& law = own.friction.law;
    const Slipping& how = now_.mode.friction[joint];
    if (law.ranges() < 2 || own.friction.function != nullptr || now_.mode.leans[joint] != 0) return;
    const model::SpeedRange range = law.range(how.range);
    const double sign = model::sign_of(how.way);
    double fastest = greatest(segment_.belts[joint]);
    for (const auto& [body, by] : own.of) fastest += std::fabs(by) * greatest(segment_.y[n() + body]);
    Series series = cheb::fit(mechanics_.slips(joint, segment_.y, segment_.belts[joint]));
    for (double& c : series) c *= sign;
    const auto no = [](double) { return false; };
    for (const int side : {1, -1}) {
        const double corner = side > 0 ? range.to : range.from;
        if (!(corner > 0 && corner < model::never)) continue;
        Series left = series;
        for (double& c : left) c *= -side;
        left[0] += side * corner;
        cheb::Bounded<node_count> curve(1, left, cheb::derivative(left));
        curve.raise_floor(16 * rounding * fastest);
        const bool there = edge_[joint] == side;
        const auto x = cheb::first_below(curve, -1, there ? cheb::LeftEnd::leaving : cheb::LeftEnd::anywhere, no);
        if (x && *x < ending.x) ending = {*x, By::corner, joint, side};
    }
}

/// The rate of bristles has a corner where the slip is 0: a stretch ends there.
void Engine::watch_bristles(std::size_t joint, Ending& ending) {
    const Nodes values = mechanics_.slips(joint, segment_.y, segment_.belts[joint]);
    std::vector<double> y;
    const auto exact = [&](double x) {
        segment_.state(x, y);
        return mechanics_.velocity(joint, y) - mechanics_.belt(joint, segment_.time(x), Side::at);
    };
    const Watched watched(values, exact);
    Half half = normal_half_[joint];
    const auto x = watched.leaves(half, -1);
    normal_half_[joint] = half;
    if (!x || *x >= ending.x) return;
    if (*x > -1) ending = {*x, By::kink, joint};
    normal_half_[joint] = -half;
}

/// A normal load that passes zero ends a stretch: what is negative counts as none.
void Engine::watch_normal(std::size_t joint, Ending& ending) {
    Nodes values{};
    for (std::size_t j = 0; j < node_count; ++j) {
        values[j] = mechanics_.pressing(joint, segment_.moment(j, point_));
    }
    std::vector<double> y;
    const auto exact = [&](double x) {
        segment_.state(x, y);
        return mechanics_.pressing(joint, {segment_.time(x), Side::at, y});
    };
    if (mechanics_.rubs(joint) && !now_.rubs(joint)) {
        // Nothing presses at the start, where the load may be its rounding, or 0 for long.
        const auto* const presses = std::find_if(values.begin() + 1, values.end(), [](double N) { return N > 0; });
        if (presses == values.end()) return;
        const double x = first_true([&](double at) { return exact(at) > 0; },
                                    cheb::nodes[static_cast<std::size_t>(presses - values.begin())]);
        if (x < ending.x) ending = {x, By::kink, joint};
        return;
    }
    Half half = normal_half_[joint];
    const Watched watched(values, exact);
    const auto x = watched.leaves(half, -1);
    if (!x || *x >= ending.x) {
        normal_half_[joint] = half;
        return;
    }
    ending = {*x, By::kink, joint};
    normal_half_[joint] = -half;
}

void Engine::watch_relays(Ending& ending) {
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        const Signal& load = mechanics_.loads()[i];
        for (std::size_t r = 0; r < load.relays(); ++r) {
            Nodes values{};
            for (std::size_t j = 0; j < node_count; ++j) {
                values[j] = load.until_switch(r, segment_.moment(j, point_));
            }
            std::vector<double> y;
            const auto exact = [&](double x) {
                segment_.state(x, y);
                return load.until_switch(r, {segment_.time(x), Side::at, y});
            };
            Half half = 1;
            const auto x = values[0] < 0 ? std::optional(-1.0) : Watched(values, exact).leaves(half, -1);
            if (x && *x < ending.x) ending = {*x, By::relay, i, static_cast<int>(r)};
        }
    }
}

/// Something that is sampled may jump along with a condition, as a limit that two functions share: then the stretch is
/// made again, up to there.
bool Engine::ends_before(double x) {
    constexpr double beside_end = 1e-6;
    if (!samples_ || 1 + x < beside_end || 1 - x < beside_end) return false;
    const double t = segment_.time(x), nothing = 64 * rounding * std::fabs(t);
    if (t - now_.t.hi <= nothing || segment_.end - t <= nothing) return false;
    breaks_.add(t);
    conditions_->crosses_at(t);
    return true;
}

double Engine::watched(std::size_t event, const Moment& at) const {
    return mechanics_.when(event, at);
}

/// Events of the user, if one of them comes before the end that is known so far.
void Engine::watch_users(Ending& ending) {
    const double before = ending.before();
    std::vector<std::pair<std::size_t, double>> wanted_ones, unwanted;  // passages; the others only change the half
    std::vector<double> y;
    for (std::size_t e = 0; e < watches_.size(); ++e) {
        const model::WantedEvent& wanted = problem_.drive.events[e];
        Watch& watch = watches_[e];
        Nodes values{};
        for (std::size_t j = 0; j < node_count; ++j) {
            values[j] = watched(e, segment_.moment(j, point_));
            if (std::isfinite(values[j])) continue;
            fail(Outcome::excitation_not_finite);
            return;
        }
        const auto exact = [&](double x) {
            segment_.state(x, y);
            return watched(e, {segment_.time(x), Side::at, y});
        };
        const Watched curve(values, exact, watch.rounded);
        double from = -1;
        Half half = watch.half;
        while (const auto x = curve.leaves(half, from)) {
            if (!(*x < before)) break;
            if (watch.sent_back && !curve.is_clearly(half, *x)) return come_again(e);
            if (wanted.direction == model::Crossing::both || (half < 0) == (wanted.direction == model::Crossing::up)) {
                wanted_ones.emplace_back(e, *x);
                break;
            }
            if (unwanted.size() > most_passages) break;
            if (watch.half == 0) watch.half = half;
            unwanted.emplace_back(e, *x);
            half = -half;
            from = *x;
        }
        if (watch.half == 0) watch.half = half;
        if (watch.sent_back) watch.sent_back = !curve.is_clearly(watch.half, 1);
    }
    if (!wanted_ones.empty()) {
        double first = 1;
        for (const auto& [event, x] : wanted_ones) first = std::min(first, x);
        ending = {first, By::user};
        for (const auto& [event, x] : wanted_ones) {
            if (x <= first + one_instant) ending.users.push_back(event);
        }
    }
    for (const auto& [event, x] : unwanted) {
        if (x <= ending.x) watches_[event].half = -watches_[event].half;
    }
}

/// What an act threw back, or stopped, is through zero without having been beyond rounding on the side that it came
/// from: it would be thrown back again at once, and again.
void Engine::come_again(std::size_t event) {
    const bool told =
        !result_.events.empty() && result_.events.back().user >= 0 && result_.events.back().t == now_.t.hi;
    if (!told) tell_user(event);
    fail(Outcome::chattering);
}

bool Engine::rubs_somewhere(std::size_t body) const {
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (problem_.system.joints[j].is_on(body) && now_.rubs(j)) return true;
    }
    return false;
}

/// Without dry friction nothing happens at a turn, it is only told.
void Engine::record_turns(const Frame& frame, double until) {
    const auto told = static_cast<std::ptrdiff_t>(result_.events.size());
    const TorqueSizes sizes = torque_sizes();
    for (std::size_t i = 0; i < n(); ++i) {
        if (rubs_somewhere(i) || frame.bodies[i].empty()) continue;
        const Nodes& v = segment_.y[n() + i];
        const double moving = greatest(v);
        const auto exact = [&](double x) { return segment_.at(n() + i, x); };
        const double torques = sizes.on(joint_at(i));
        const double nothing =
            segment_.h / problem_.system.bodies[i].inertia * std::max(100 * rounding * torques, solver_->noise());
        constexpr double underflow = 1e-280;  // numbers so small lose their digits
        if (!(moving > std::max(nothing, underflow))) continue;
        Half half = static_cast<int>(heading_[i]);
        const Watched watched(v, exact);
        std::vector<double> zeros{-1};
        for (;;) {
            const auto x = watched.leaves(half, zeros.back());
            if (!x || *x >= until - 1e-12) break;
            zeros.push_back(*x);
            half = -half;
        }
        // Between two zeros it may be no more than the error of a series that fits what comes before or after.
        const auto moves = [&](std::size_t k) {
            const double from = zeros[k], to = k + 1 < zeros.size() ? zeros[k + 1] : until;
            double most = std::fabs(exact((from + to) / 2));
            for (std::size_t j = 0; j < node_count; ++j) {
                if (cheb::nodes[j] > from && cheb::nodes[j] < to) most = std::max(most, std::fabs(v[j]));
            }
            return most > 8 * problem_.tolerance * moving;
        };
        int way = static_cast<int>(heading_[i]);
        bool moved = false;  // on the stretch
        for (std::size_t k = 0; k < zeros.size(); ++k) {
            const int now = (zeros.size() - 1 - k) % 2 == 0 ? half : -half;
            const bool clear = moves(k), at_end = k + 1 == zeros.size() && moved;
            moved = moved || clear;
            if (now == way || !(clear || at_end)) continue;
            if (std::exchange(way, now) == 0) continue;
            const double x = zeros[k], t = segment_.time(x);
            if (!(t > problem_.window.start) && problem_.before == nullptr) continue;
            std::vector<double> y;
            segment_.state(x, y);
            const std::optional<double> sampled = sampled_load(i, x);
            const double M = sampled ? *sampled : mechanics_.load(i, {t, Side::at, y});
            result_.events.push_back({.t = t, .theta = y[i], .M = M, .where = static_cast<int>(i)});
        }
        heading_[i] = static_cast<Motion>(way);
    }
    std::stable_sort(result_.events.begin() + told, result_.events.end(),
                     [](const Event& a, const Event& b) { return a.t < b.t; });
}

// ---- impacts, acts, rows

/// How long the next bounces take that begin with this speed, under torques that stay as they are. None when one of
/// these is no number.
std::optional<Engine::Bounces> Engine::next_bounces(std::size_t joint, int wall, double speed) {
    const Joint& own = problem_.system.joints[joint];
    const auto back_in = [&](bool out) {
        Mode thrown = now_.mode;
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            if (!now_.rubs(j)) continue;
            if (now_.slip(mechanics_, j) != 0) thrown.friction[j].way = model::motion_of(now_.slip(mechanics_, j));
            // Friction acts against the sliding: out and back again, or, on a belt, the same way all the time.
            const bool turns = j == joint && mechanics_.belt(j, now_.t.hi, now_.side()) == 0;
            if (turns) thrown.friction[j].way = (wall > 0) == out ? Motion::backward : Motion::forward;
        }
        Look found;
        if (!look(now_.here(), thrown, Frame(problem_.system, thrown), found)) return -model::never;
        return wall * own.sum(found.accelerations);
    };
    const double out = back_in(true), back = back_in(false);
    if (out == -model::never || back == -model::never) return {};
    if (!(out > 0)) return Bounces{};
    if (!(back > 0)) return Bounces{speed / out, speed / out};  // friction holds it at the top of the bounce
    const double slower = std::sqrt(back / out), once = speed * (1 / out + slower / back);
    const double kept = own.walls->restitution * slower;
    return Bounces{once, kept < 1 ? once / (1 - kept) : model::never};
}

bool Engine::hit(std::size_t joint, int wall) {
    const Joint& own = problem_.system.joints[joint];
    const double place = own.walls->at(wall), e = own.walls->restitution;
    const bool stayed = at_wall_[joint] != 0;
    now_.put_child(own, own.first(), own.of.front().by, place);
    origin_[joint] = place, reach_[joint] = 0;
    const double before = std::max(0.0, wall * mechanics_.velocity(joint, now_.y));
    at_wall_[joint] = 1;
    const auto stands = [&] {
        if (now_.mode.leans[joint] != wall || leaned_[joint] != 0) return;
        tell(EventKind::stick, static_cast<int>(joint));
        leaned_[joint] = 1;
    };
    if (stayed && before == 0) {
        now_.mode.leans[joint] = wall;
        Slipping& how = now_.mode.friction[joint];
        how.leaving = false;
        how.blunt = std::max(2 * how.blunt, 64 * rounding * torque_sizes().on(own));  // it went, and did not get away
        if (!decide(true)) return false;
        stands();
        return !too_often() || fail(Outcome::chattering);
    }
    tell(EventKind::impact, static_cast<int>(joint));
    const Thrown thrown = thrown_along(joint);
    const auto velocity = [&](double relative) { throw_to(thrown, relative); };
    velocity(-wall * e * before);
    conditions_->forget();
    bool rests = e * before == 0;
    double rest = 0;
    if (!rests) {
        const auto bounces = next_bounces(joint, wall, e * before);
        if (!bounces) return fail(Outcome::excitation_not_finite);
        // Without a spring the run so far tells what is short: not its end, so that one may stop anywhere and go on.
        const double pace = std::min(pace_.period, now_.t.hi - pace_.born);
        rests = bounces->all <= last_bounces * pace || bounces->once <= shortest_bounce * pace;
        rest = bounces->all < model::never ? bounces->all : bounces->once;
    }
    const double after = rests ? 0 : e * before;
    history_->add_jump(now_.t.hi, joint, {.impacts = (before - after) * (before + after) / thrown.lightness / 2});
    breaks_.echo(now_.t.hi, 1);
    for (std::size_t i = 0; i < n(); ++i) {
        if (thrown.velocities[i].second != 0) heading_[i] = model::motion_of(rests ? 0 : now_.y[n() + i]);
    }
    if (rests) {
        velocity(0);
        conditions_->forget();
        if (rest > 0 && now_.t.after(rest) < std::min(mechanics_.next_break(now_.t.hi), problem_.window.end)) {
            std::vector<double> rates(mechanics_.states());
            mechanics_.rates(now_.here(), rates.data(), &now_.mode);
            for (std::size_t k = 0; k < rates.size(); ++k) now_.y[2 * n() + k] += rest * rates[k];
            now_.t = now_.t.later(rest);
        }
        now_.mode.leans[joint] = wall;
        if (now_.rubs(joint)) {
            Slipping& how = now_.mode.friction[joint];
            if (how.way != Motion::stuck) arrived_[joint] = how.way;
            how.leaving = false;
        }
    } else {
        leave_walls();
    }
    if (!restart_contacts(Because::impact, joint)) return false;
    if (rests) stands();
    // Bounces at one wall die out; to and fro between others they need not, and when they do it takes many.
    constexpr int most_to_and_fro = 5000;
    const bool other = last_hit_ != std::pair(joint, wall);
    last_hit_ = {joint, wall};
    return !other || !too_often(most_to_and_fro) || fail(Outcome::chattering);
}

/// What leans, and was struck, goes: away from its wall, or into it, which is an impact of its own.
void Engine::leave_walls() {
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const double v = mechanics_.velocity(j, now_.y);
        if (now_.mode.leans[j] == 0 || v == 0) continue;
        if (leaned_[j] != 0 && now_.mode.leans[j] * v < 0) tell(EventKind::slip, static_cast<int>(j));
        now_.mode.leans[j] = 0, leaned_[j] = 0, at_wall_[j] = 1;
    }
}

bool Engine::act_all(const std::vector<std::size_t>& told) {
    came_from_.clear();
    for (const Watch& watch : watches_) came_from_.push_back(watch.half);
    for (const std::size_t event : told) watches_[event].half = -watches_[event].half;
    if (!std::all_of(told.begin(), told.end(), [&](std::size_t event) { return act(event, told); })) return false;
    // What comes at the same instant is told before one of them stops the run: it would not be told when that goes on.
    const bool stops =
        std::any_of(told.begin(), told.end(), [&](std::size_t event) { return problem_.drive.events[event].stop; });
    return !stops || fail(Outcome::stopped);
}

bool Engine::act(std::size_t event, const std::vector<std::size_t>& told) {
    const model::WantedEvent& wanted = problem_.drive.events[event];
    tell_user(event);
    if (wanted.act != nullptr) {
        const std::vector<double> before = now_.y;
        std::vector<double> values;
        for (std::size_t e = 0; e < watches_.size(); ++e) values.push_back(watched(e, now_.here()));
        model::State state{now_.y[0], now_.y[n()]};
        const bool named = problem_.system.named;
        const std::span<double> all(now_.y);
        const std::span<double> given = all.first(asking_.told);
        if (!wanted.act->act(now_.t.hi, state, named ? given : given.subspan(2 * n()))) {
            return fail(Outcome::excitation_not_finite);
        }
        if (!named) now_.y[0] = state.theta, now_.y[1] = state.velocity;
        keep_within_walls(now_.y);
        conditions_->forget();
        if (now_.y != before) now_.low.assign(n(), 0);  // what the user was given is what he goes on from
        now_.keep_rigid_places(problem_.system);
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            const double work = energy_at(j, now_.y) - energy_at(j, before);
            if (work != 0 || j == 0) history_->add_jump(now_.t.hi, j, {.acts = work});
        }
        breaks_.echo(now_.t.hi, 1);
        const bool moved =
            !std::equal(now_.y.begin(), now_.y.begin() + static_cast<std::ptrdiff_t>(2 * n()), before.begin());
        if (moved) {
            std::fill(now_.mode.leans.begin(), now_.mode.leans.end(), 0);
            for (std::size_t i = 0; i < n(); ++i) heading_[i] = model::motion_of(now_.y[n() + i]);
            touch_walls();
            if (!restart_contacts(Because::act)) return false;
            see_flight();
        }
        stand_where_put(values, now_.y != before ? told : std::vector<std::size_t>());
        if (moved && watches_[event].fading.after(now_.t.hi) && !wanted.stop) return fail(Outcome::chattering);
    }
    return wanted.stop || !too_often() || fail(Outcome::chattering);
}

void Engine::keep_within_walls(std::vector<double>& y) const {
    for (std::size_t i = 0; i < n(); ++i) {
        if (const auto& walls = problem_.system.joints[i].walls) y[i] = std::clamp(y[i], walls->lower, walls->upper);
    }
}

/// Elastic walls that are pressed after the state was set, or velocities have jumped. Whether one has changed.
bool Engine::press_stops() {
    bool changed = false;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const auto& stops = problem_.system.joints[j].stops;
        if (!stops) continue;
        const double q = mechanics_.angle(j, now_.y), v = mechanics_.velocity(j, now_.y);
        int side = 0;
        for (const int wall : {1, -1}) {
            if (!std::isfinite(stops->at(wall))) continue;
            const double nothing = 64 * rounding * std::fabs(stops->at(wall));
            const double depth = wall * (q - stops->at(wall)), torque = wall * stops->torque(wall, q, v);
            const bool before = now_.mode.presses[j] == wall;
            const double least = before ? -nothing : nothing;
            if (depth > least && torque > least * stops->stiffness) side = wall;
        }
        if (side == now_.mode.presses[j]) continue;
        changed = true;
        if (begun()) {
            press(j, side);
        } else {
            now_.mode.presses[j] = side;
        }
    }
    return changed;
}

/// What an elastic wall stores when it is left is lost.
void Engine::press(std::size_t joint, int side) {
    const model::Walls& stops = *problem_.system.joints[joint].stops;
    const int wall = side != 0 ? side : now_.mode.presses[joint];
    const double depth = mechanics_.angle(joint, now_.y) - stops.at(wall);
    const double stored = (side != 0 ? -1 : 1) * stops.stiffness * depth * depth / 2;
    history_->add_jump(now_.t.hi, joint, {.impacts = stored, .kept = -stored});
    now_.mode.presses[joint] = side;
    conditions_->forget();
    tell(side != 0 ? EventKind::impact : EventKind::released, static_cast<int>(joint));
}

/// A slider that sticks slides where its spring comes to its limit; one that slides sticks where the slip turns.
void Engine::watch_slider(std::size_t slider, Ending& ending) const {
    const auto& [joint, bend, stiffness, limit] = mechanics_.sliders()[slider];
    std::vector<double> y;
    const auto look = [&](const Nodes& values, const auto& exact, Motion way) {
        Half half = 1;
        const auto x = Watched(values, exact).leaves(half, -1);
        if (x && *x < ending.x) ending = {*x, By::slider, slider, static_cast<int>(way)};
    };
    Nodes values{};
    if (now_.mode.sliders[slider] != Motion::stuck) {
        const double sign = model::sign_of(now_.mode.sliders[slider]);
        values = mechanics_.slips(joint, segment_.y, segment_.belts[joint]);
        for (double& value : values) value *= sign;
        const auto slip_at = [&, joint = joint](double x) {
            segment_.state(x, y);
            return sign * (mechanics_.velocity(joint, y) - mechanics_.belt(joint, segment_.time(x), Side::at));
        };
        return look(values, slip_at, Motion::stuck);
    }
    for (const Motion way : {Motion::forward, Motion::backward}) {
        const double sign = model::sign_of(way);
        for (std::size_t j = 0; j < node_count; ++j) values[j] = limit - sign * stiffness * segment_.y[bend][j];
        const auto left_at = [&, bend = bend, stiffness = stiffness, limit = limit](double x) {
            return limit - sign * stiffness * segment_.at(bend, x);
        };
        look(values, left_at, way);
    }
}

void Engine::let_slide(std::size_t slider, Motion way) {
    const Mechanics::Slider& own = mechanics_.sliders()[slider];
    now_.mode.sliders[slider] = way;
    if (way != Motion::stuck) now_.y[own.bend] = model::sign_of(way) * own.limit / own.stiffness;
    tell(way == Motion::stuck ? EventKind::slider_sticks : EventKind::slider_slips, static_cast<int>(own.joint));
}

/// After velocities have jumped: sliders whose slip has turned stick.
bool Engine::turn_sliders() {
    bool turned = false;
    for (std::size_t s = 0; s < now_.mode.sliders.size(); ++s) {
        const double way = model::sign_of(now_.mode.sliders[s]);
        const std::size_t joint = mechanics_.sliders()[s].joint;
        if (!(way * now_.slip(mechanics_, joint) < -16 * rounding * mechanics_.speed_scale(joint, now_.y))) continue;
        let_slide(s, Motion::stuck);
        turned = true;
    }
    return turned;
}

Engine::Thrown Engine::thrown_along(std::size_t joint) {
    if (!rigid_) {
        Mode free = now_.mode;
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) free.leans[j] = 0, free.rubs[j] = 0;
        rigid_.emplace(problem_.system, free);
    }
    Thrown thrown;
    for (const auto& [group, by] : rigid_->joints[joint]) thrown.lightness += by * by / rigid_->inertia[group];
    const double speed = mechanics_.velocity(joint, now_.y);
    for (std::size_t i = 0; i < n(); ++i) {
        double share = 0;
        for (const auto& [group, by] : rigid_->bodies[i]) {
            for (const auto& [own_group, turned] : rigid_->joints[joint]) {
                if (own_group == group) share += by * turned / rigid_->inertia[group] / thrown.lightness;
            }
        }
        thrown.velocities.emplace_back(now_.y[n() + i] - share * speed, share);
    }
    return thrown;
}

void Engine::throw_to(const Thrown& thrown, double relative) {
    for (std::size_t i = 0; i < n(); ++i) {
        const auto& [still, share] = thrown.velocities[i];
        if (share != 0) now_.y[n() + i] = still + share * relative;
    }
}

/// A freewheel that something throws backward stops, and so does what leans on a wall and is thrown into it: one after
/// the other, until all have.
void Engine::catch_freewheels() {
    bool any = false;
    for (const Joint& joint : problem_.system.joints) any = any || joint.friction.law.is_one_way();
    const std::size_t most = any ? 500 * mechanics_.joints() : 0;
    for (std::size_t k = 0; k < most; ++k) {
        std::size_t worst = mechanics_.joints();
        double least = 0;
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            const bool one_way = problem_.system.joints[j].friction.law.is_one_way() && now_.rubs(j);
            if (!one_way && now_.mode.leans[j] == 0) continue;
            const double v = one_way ? now_.slip(mechanics_, j) : -now_.mode.leans[j] * mechanics_.velocity(j, now_.y);
            if (v < -16 * rounding * mechanics_.speed_scale(j, now_.y) && v < least) worst = j, least = v;
        }
        if (worst == mechanics_.joints()) return;
        const Thrown thrown = thrown_along(worst);
        if (!(thrown.lightness > 0)) return;
        const double before = mechanics_.velocity(worst, now_.y);
        const double after = now_.mode.leans[worst] != 0 ? 0 : mechanics_.belt(worst, now_.t.hi, now_.side());
        throw_to(thrown, after);
        history_->add_jump(now_.t.hi, worst, {.impacts = (before - after) * (before + after) / thrown.lightness / 2});
    }
}

/// What stands at a wall, and does not move away from it, leans there.
void Engine::touch_walls() {
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const Joint& joint = problem_.system.joints[j];
        if (!joint.walls) continue;
        for (const int wall : {1, -1}) {
            if (mechanics_.angle(j, now_.y) != joint.walls->at(wall)) continue;
            at_wall_[j] = 1;
            if (mechanics_.velocity(j, now_.y) == 0) now_.mode.leans[j] = wall;
        }
    }
}

/// A body that was thrown, and is soon back, is to be seen on its way.
void Engine::see_flight() {
    if (!look({now_.t.hi, now_.side(), now_.departing(problem_.system)}, now_.mode, frames_->of(now_.mode), look_))
        return;
    for (std::size_t i = 0; i < n(); ++i) {
        const double v = now_.y[n() + i], a = look_.accelerations[i];
        if (!(v * a < 0) || !(std::fabs(v) < std::fabs(a) * frames_->longest(now_.mode))) continue;
        pace_.h = std::min(pace_.h, std::max(1.2 * std::fabs(v / a), 1e-9 * pace_.unit));
    }
}

/// How far a watched value goes when what it is made of changes by some ulps.
double Engine::rounding_of(std::size_t event) const {
    constexpr double ulps = 1 + 4 * rounding;
    std::vector<double> y = now_.y;
    const double own = watched(event, {now_.t.hi, now_.side(), y});
    double most = 0;
    for (std::size_t k = 0; k < 2 * n(); ++k) {
        y[k] = now_.y[k] * ulps;
        most = std::max(most, std::fabs(watched(event, {now_.t.hi, now_.side(), y}) - own));
        y[k] = now_.y[k];
    }
    return most;
}

/// Whether a value at zero goes on to the side to which it has come, now that the user has acted, as it does at once;
/// else he threw it back, or stopped it.
bool Engine::passes_on(std::size_t event) {
    constexpr double soon = 1e-4;
    const double step = soon * pace_.h;
    if (!look({now_.t.hi, now_.side(), now_.departing(problem_.system)}, now_.mode, frames_->of(now_.mode), look_))
        return true;
    std::vector<double> rates(mechanics_.states()), y = now_.y;
    mechanics_.rates(now_.here(), rates.data(), &now_.mode);
    const auto value = [&](double after) {
        for (std::size_t i = 0; i < n(); ++i) {
            y[i] = now_.y[i] + after * now_.y[n() + i];
            y[n() + i] = now_.y[n() + i] + after * look_.accelerations[i];
        }
        for (std::size_t k = 0; k < rates.size(); ++k) y[2 * n() + k] = now_.y[2 * n() + k] + after * rates[k];
        return watched(event, {now_.t.hi + after, Side::at, y});
    };
    return came_from_[event] * (value(step) - value(-step)) < -watches_[event].rounded;
}

/// What the user did may have put watched values on the other side of zero, which is no passing. A value that was told
/// stands at zero still when he changed something else, as a bounce does: its half is the one that it came from, or,
/// when it goes on, what it comes to next.
void Engine::stand_where_put(const std::vector<double>& before, const std::vector<std::size_t>& told) {
    std::vector<double> first, last;
    segment_.state(-1, first), segment_.state(1, last);
    for (std::size_t e = 0; e < watches_.size(); ++e) {
        Watch& watch = watches_[e];
        const double now = watched(e, now_.here());
        const double size = std::max({std::fabs(watched(e, {segment_.time(-1), Side::at, first})),
                                      std::fabs(watched(e, {segment_.end, Side::at, last})), std::fabs(now)});
        if (now == before[e]) {
            // One that an impact took past zero does not stand there.
            const bool stands = std::fabs(now) <= at_zero * size + 2 * rounding_of(e) + watch.rounded;
            if (!stands || std::find(told.begin(), told.end(), e) == told.end()) continue;
            watch.rounded = 2 * std::fabs(now) + rounding_of(e);
            watch.sent_back = !passes_on(e);
            watch.half = watch.sent_back ? came_from_[e] : 0;
            continue;
        }
        watch.half = std::fabs(now) <= at_zero * size ? 0 : now > 0 ? 1 : -1;
        watch.sent_back = false;
    }
}

bool Engine::rows_until(double end, bool to_the_end) {
    const Grid& rows = problem_.rows;
    while (next_row_ < rows.count()) {
        const double t = rows.time(next_row_);
        if (!(t < end) && !(to_the_end && t < segment_.end)) return true;
        if (!put_row(t, std::clamp(segment_.start.until(t) / segment_.h - 1, -1.0, 1.0))) return false;
    }
    return true;
}

/// At x of the segment; -2 is the present.
bool Engine::put_row(double t, double x) {
    std::vector<double>& y = row_;
    y = now_.y;
    if (x > -1) segment_.state(x, y);
    keep_within_walls(y);
    const Moment at{t, x <= -1 ? now_.side() : Side::at, y};
    bool needs_look = !problem_.joined_elsewhere;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) needs_look = needs_look || now_.mode.holds(j);
    const auto place = x > -1 ? std::optional(x) : std::nullopt;
    if (needs_look && !look(at, now_.mode, frames_->of(now_.mode), look_, place, Loads::sampled)) return false;
    double* cell = result_.table.writable() + next_row_;
    const std::size_t stride = problem_.rows.count();
    const auto put = [&](double value) {
        *cell = value == 0 ? 0 : value;
        cell += stride;
        return std::isfinite(value);
    };
    bool good = put(t);
    for (std::size_t i = 0; i < n(); ++i) {
        good = put(y[i]) && good;
        good = put(y[n() + i]) && good;
        const std::optional<double> sampled = sampled_load(i, x);
        good = put(sampled ? *sampled : mechanics_.load(i, at)) && good;
        good = put(friction(i, at, look_)) && good;
        good = put(-problem_.system.joints[i].damping * y[n() + i]) && good;
        if (!problem_.joined_elsewhere) good = put(look_.accelerations[i]) && good;
    }
    for (std::size_t j = n(); j < told_joints(); ++j) {
        const double belt = mechanics_.belt(j, t, at.side);
        double torque = -mechanics_.joint_torque(j, at, now_.mode, belt);
        if (!mechanics_.loads()[j].none()) torque += mechanics_.load(j, at);
        if (now_.mode.holds(j)) torque += look_.holding[j];
        const bool kept = now_.mode.rigid[j] != 0;  // to the letter
        good = put(kept ? now_.rigid_at[j] : mechanics_.angle(j, y)) && good;
        good = put(kept ? 0 : mechanics_.velocity(j, y)) && good;
        good = put(torque) && good;
        good = put(friction(j, at, look_)) && good;
    }
    for (std::size_t j = told_joints(); j < mechanics_.joints(); ++j) {
        const std::size_t body = moved_body(j);
        const double more = mechanics_.own_inertia(body) - problem_.system.bodies[body].inertia;
        good = put(look_.holding[j] + more * look_.accelerations[body]) && good;
    }
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) good = put(y[2 * n() + k]) && good;
    if (good) ++next_row_;
    return good;
}

/// The torque of a joint's friction on its first body.
double Engine::friction(std::size_t joint, const Moment& at, const Look& look) const {
    // The wall carries what presses against it, friction what pulls away from it.
    if (now_.rubs(joint) && now_.mode.friction[joint].way == Motion::stuck) {
        const double held = look.holding[joint] - mechanics_.slider_torque(joint, at.y);
        return now_.mode.leans[joint] != 0 && now_.mode.leans[joint] * held <= 0 ? 0.0 : held;
    }
    return mechanics_.friction(joint, at, now_.mode, mechanics_.belt(joint, at.t, at.side));
}

}  // namespace

std::vector<std::string> column_names_of(const model::System& system, const model::Drive& drive) {
    std::vector<std::string> names{"t"};
    const auto add = [&](const std::string& joint, std::initializer_list<const char*> columns) {
        for (const char* column : columns) names.push_back(joint.empty() ? column : joint + "." + column);
    };
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        const std::string& name = system.joints[j].name;
        system.is_link(j) ? add(name, {"theta", "velocity", "torque", "friction"})
                          : add(name, {"theta", "velocity", "M", "friction", "damping", "acceleration"});
    }
    for (const model::Body& body : system.bodies) {
        if (body.moved) add(body.name, {"torque"});
    }
    for (const model::OwnState& state : drive.states) names.push_back(state.name);
    return names;
}

Run run_plain(const Request& problem) {
    Run result;
    if (!problem.system.has_moved()) {
        Engine engine(problem, result);
        engine.run();
        return result;
    }
    const Moving moving(problem.system, problem.drive, problem.window.start,
                        (problem.window.end - problem.window.start) / 64);
    const Request held{.system = moving.system,
                       .drive = moving.drive,
                       .window = problem.window,
                       .rows = problem.rows,
                       .monitor = problem.monitor,
                       .limits = problem.limits,
                       .before = problem.before,
                       .tolerance = problem.tolerance,
                       .longest = problem.longest,
                       .step = problem.step,
                       .keeps_torques = problem.keeps_torques,
                       .history_bytes = problem.history_bytes,
                       .hidden = moving.system.joints.size() - problem.system.joints.size(),
                       .joined_elsewhere = problem.joined_elsewhere};
    Engine engine(held, result);
    engine.run();
    return result;
}

Run run(const Request& problem) {
    const std::size_t own = problem.drive.states.size();
    Witnesses witnesses(problem.system.named ? 2 * problem.system.bodies.size() + own : own);
    model::System system = problem.system;
    const auto of = [&](const char* what, std::size_t joint) {
        return system.named ? fmt::format("{}.{}", what, system.joints[joint].name) : std::string(what);
    };
    const model::Drive drive = witnesses.heard(problem.drive, of);
    for (std::size_t i = 0; i < system.bodies.size(); ++i) {
        if (auto& moved = system.bodies[i].moved) {
            moved->motion = witnesses.heard(moved->motion, of(moved->by_angle ? "theta" : "velocity", i));
        }
    }
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        model::Joint& joint = system.joints[j];
        for (auto& sliding : joint.friction.sliding) {
            if (sliding) sliding = witnesses.heard(*sliding, of("Rd", j));
        }
        for (auto& holding : joint.friction.holding) {
            if (holding) holding = witnesses.heard(*holding, of("Re", j));
        }
        if (joint.friction.normal) joint.friction.normal = witnesses.heard(*joint.friction.normal, of("normal", j));
        if (joint.friction.function != nullptr) {
            joint.friction.function = witnesses.heard(joint.friction.function, of("friction", j), "t", 1);
        }
        if (const auto* spring = joint.spring.as<model::springs::UserSpring>()) {
            joint.spring = model::springs::UserSpring{witnesses.heard(spring->function, of("spring", j), "theta")};
        }
    }
    const Request heard{.system = system,
                        .drive = drive,
                        .window = problem.window,
                        .rows = problem.rows,
                        .monitor = problem.monitor,
                        .limits = problem.limits,
                        .before = problem.before,
                        .tolerance = problem.tolerance,
                        .longest = problem.longest,
                        .step = problem.step,
                        .keeps_torques = problem.keeps_torques};
    Run result = run_plain(heard);
    const bool whole = model::is_whole(result.outcome) || result.outcome == Outcome::stopped;
    result.contradiction = witnesses.verdict(whole);
    if (result.contradiction) result.outcome = Outcome::not_a_function;
    return result;
}

}  // namespace dinal::motion::engine
