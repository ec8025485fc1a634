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
#include "motion/break_search.hpp"
#include "motion/engine/collocation.hpp"
#include "motion/engine/crossing.hpp"
#include "motion/engine/history.hpp"
#include "motion/engine/moving.hpp"
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
constexpr double at_once = 1e-9;       // events that follow each other within it, so often, go on for ever
constexpr int most_at_once = 200, most_short = 400, most_attempts = 20000;
constexpr int most_attempts_sampled = 3000;  // where a function of the motion is asked that may do anything
constexpr double short_part = 1e-3;          // shorter than this part of the longest stretch is short
constexpr double slightly = 16;  // times the tolerance: such an error limits the length of the next stretches
constexpr int limited_stretches = 12;
constexpr double last_bounces = 1e-7, shortest_bounce = 1e-10;
constexpr double most_blunt = 1e-9;   // of the torques: what passes its limit by more is no rounding
constexpr double no_motion = 1e-9;    // of the acceleration that the torques at a joint could give
constexpr double little_more = 1e-7;  // of the torques: what a joint that comes to its limit will be short of next
constexpr int most_echoes = 8;
constexpr std::size_t most_found_breaks = 50;
constexpr std::size_t most_passages = 200;
constexpr double one_instant = 64 * rounding;  // passages of user events that are so near to each other are one
constexpr double beside_standstill = 1e-12;    // one that is so near to a standstill, or a release, is told after it
constexpr double at_zero = 1e-12;              // this part of what it was on the stretch stands at zero
constexpr double huge = 1e100;                 // a function that is no number at such a state says nothing about itself
constexpr double beyond_all = std::numeric_limits<double>::max() / 1e7;  // bounds of a series are so much greater
constexpr double longest_in_periods = 0.6, part_of_run = 1.0 / 16;

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
    enum class By { nobody, slip, release, wall, stop, slider, corner, relay, user, kink, stays, condition };
    struct Ending {
        double x = 1;
        By by = By::nobody;
        std::size_t which = 0;  ///< the joint, or the body of a relay
        int side = 0;  ///< of a wall, a stop (0: it is left) or a corner, or the way of a release; or which relay
        std::vector<std::size_t> users = {};  ///< events of the user at this instant, in the order written
        std::vector<std::pair<Piecewise*, std::size_t>> conditions = {};  ///< of functions that were read
    };
    /// What an exact look at a moment tells.
    struct Look {
        std::vector<double> loads, torques, accelerations, holding;
        double blurred = 0;  ///< what torques may be off by because the slopes of belts are differences
    };

    // The loop.
    void begin();
    bool advance();
    [[nodiscard]] double greatest_of_state() const;
    bool stands_for_good();
    bool rest();
    void choose();
    double longest_under_friction();
    double until_wall();
    void again(Collocation::Attempt attempt);
    [[nodiscard]] bool a_belt_jumps_at(double t) const;
    bool belt_jump_found();
    void explain_end();
    void forget_chatter();
    std::string state_driven_back();
    bool end_at(double x);
    bool arrive();
    bool ask_after_break();
    void foresee_break();
    void go_to(double x);
    [[nodiscard]] double gap(std::size_t joint, double place) const;
    void keep(double length);
    std::vector<Kept::Acting> acting();
    [[nodiscard]] double energy_at(std::size_t joint, const std::vector<double>& y) const;
    bool handle(const Ending& ending);
    const Frame& frame();

    // Decisions.
    bool decide(bool told, std::optional<Ending> released = {});
    void creep(std::size_t joint, Motion way, double pull);
    [[nodiscard]] bool may_creep(std::size_t joint) const;
    bool share_loops(const std::optional<Ending>& released);
    struct Box;
    bool box_of(const std::vector<std::size_t>& held, Box& box);
    bool decide_together(std::size_t full);
    void project(Side when);
    void keep_rigid_places();
    [[nodiscard]] double angle_given(std::size_t body, Side when) const;
    [[nodiscard]] double kinetic_energy() const;
    void put_child(std::size_t joint, std::size_t child, double weight, double place);
    enum class Loads { asked, sampled };
    bool look(const Moment& at, const Mode& mode, const Frame& frame, Look& result, std::optional<double> x = {},
              Loads from = Loads::asked);
    std::optional<double> sampled_load(std::size_t body, double x);
    [[nodiscard]] const std::vector<double>& departing() const;
    [[nodiscard]] double slip(std::size_t joint) const {
        return mechanics_.velocity(joint, y_) - mechanics_.belt(joint, now_.hi, side());
    }
    [[nodiscard]] double excess(std::size_t joint, const Look& look, const Mode& mode, const Moment& at,
                                Motion& towards) const;
    void slide(std::size_t joint, Motion way, bool leaving);
    [[nodiscard]] bool moves_as_one(std::size_t joint, const Frame& frame) const;
    /// The part of a pull that is right whatever states of the user's are wrong by.
    [[nodiscard]] double known() const { return mechanics_.states_of_user() > 0 ? 1 - 3e-12 : 1; }
    [[nodiscard]] double belt_heading(std::size_t joint) const;
    [[nodiscard]] BeltSlope belt_slope(std::size_t joint) const { return slopes_[joint]; }
    [[nodiscard]] bool belt_sets_off(std::size_t joint) const;
    void find_belt_slopes(std::optional<double> x);
    /// It has dry friction, and is not open.
    [[nodiscard]] bool rubs(std::size_t joint) const { return mode_.rubs[joint] != 0; }
    [[nodiscard]] bool nothing_presses(std::size_t joint) const;
    bool open_and_close();
    enum class Because { impact, act, belt };
    bool restart_contacts(Because why, std::size_t at = 0);

    // Guards.
    void watch(Ending& ending);
    void watch_slip(std::size_t joint, Ending& ending);
    bool take_back_slip(std::size_t joint);
    void settle_at_limit(std::size_t joint);
    bool only_touched(std::size_t joint, Motion way);
    void watch_release(std::size_t joint, Ending& ending);
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
    void watch_conditions(Ending& ending);
    bool cross(const Ending& ending);
    bool ends_before(double x);
    void decide_conditions(const Moment& at, const Mode& mode);
    void record_turns(double until);
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
    bool too_often(int most = most_at_once);
    void echo(double t, int generation);
    bool put_row(double t, double x);
    [[nodiscard]] double friction(std::size_t joint, const Moment& at, const Look& look) const;
    bool rows_until(double end, bool to_the_end);
    bool fail(Outcome outcome) {
        outcome_ = outcome;
        return false;
    }
    [[nodiscard]] Side side() const { return after_break_ ? Side::after : Side::at; }
    /// Nothing that contacts do is an event at the start.
    [[nodiscard]] bool begun() const { return now_.hi > problem_.window.start || problem_.before != nullptr; }
    [[nodiscard]] Moment here() const { return {now_.hi, side(), y_}; }
    [[nodiscard]] std::size_t n() const { return mechanics_.bodies(); }
    /// Those that were asked for: behind them are the joints that move bodies.
    [[nodiscard]] std::size_t told_joints() const { return mechanics_.joints() - problem_.hidden; }
    [[nodiscard]] std::size_t moved_body(std::size_t hidden) const { return problem_.system.joints[hidden].first(); }
    [[nodiscard]] double torque_size(std::size_t joint) const;

    const Request& problem_;
    Run& result_;
    Asking asking_;
    Mechanics mechanics_;
    std::shared_ptr<History> history_;
    double inertia_ = 0;  ///< of all bodies
    double period_ = model::never, pace_ = 1, longest_all_ = 1, longest_ = 1;
    std::optional<Collocation> solver_;
    std::map<std::pair<std::vector<char>, std::vector<int>>, std::pair<Frame, double>> frames_;
    const Frame* frame_ = nullptr;
    std::pair<std::vector<char>, std::vector<int>> frame_of_;  ///< which joints hold, and at which walls

    Clock now_;
    std::vector<double> y_, low_;         ///< what the angles have rounded off
    std::vector<double> origin_, reach_;  ///< of each joint: the wall that it hit last, and how far it went from there
    std::vector<double> rigid_at_;        ///< the angle that a rigid joint keeps
    std::optional<Frame> rigid_;          ///< what moves where nothing but rigid joints hold
    Mode mode_, entered_, left_;          ///< now, when the decision in progress began, and before a release
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
    std::vector<int> edge_;          ///< of each joint: the corner that its speed is at, 1 the upper one of its range
    std::vector<char> at_wall_;      ///< of each joint: it begins at a wall, and leaves it
    std::vector<char> leaned_;       ///< of each joint: it came to stand at a wall, which was told
    std::vector<int> normal_half_;   ///< of each joint: the sign of its normal load
    std::vector<Motion> heading_;    ///< of each body without dry friction
    std::vector<Watch> watches_;     ///< of the events of the user
    std::vector<Half> came_from_;    ///< the events of the user that were told last
    std::vector<BeltSlope> slopes_;  ///< of the belts, now
    bool after_break_ = false, has_walls_ = false;
    bool has_pieces_ = false;             ///< of a function of the motion whose conditions are known
    bool samples_ = false;                ///< another function of the motion, which may jump anywhere
    bool has_jumped_ = true;              ///< all conditions are to be decided anew
    double crossing_at_ = -model::never;  ///< a break where a condition passes zero, and is not decided by rounding
    struct {
        const Piecewise* function = nullptr;
        std::size_t step = 0;
        double from = 0, t = -model::never;  ///< the decision that it had until then
        double within = 0;                   ///< so near to zero it was taken to be
    } crossed_last_;
    double crossed_within_ = 0;  ///< of what is about to be crossed
    int to_and_fro_ = 0;         ///< crossings of one condition, each soon after the one before
    int small_in_a_row_ = 0;     ///< jumps at conditions
    double greatest_crossed_ = 0;
    std::vector<double> soon_;   ///< what moves, where a velocity that leaves 0 has left
    std::vector<int> standing_;  ///< of each body: 0 it moves, 1 a contact holds it, 2 and 3 it is about to leave
    Segment segment_;
    std::vector<double> breaks_;  ///< found, and still ahead
    PassedBreaks passed_breaks_;
    std::vector<std::pair<double, int>> echoes_;  ///< breaks that delays bring back
    double h_ = 1, bad_time_ = model::never, searched_from_ = model::never, searched_h_ = 0;
    double attempts_since_ = 0, last_event_ = -model::never, last_full_at_ = -model::never, born_ = 0;
    double shortest_delay_ = model::never, longest_delay_ = 0;
    std::pair<std::size_t, int> last_hit_{0, 0};  ///< the joint and its wall
    double short_enough_ = 0;                     ///< half the length that replaced one with a slightly too large error
    int limited_for_ = 0;                         ///< so many of the next stretches are not longer than that
    int attempts_ = 0, too_short_ = 0, at_once_in_a_row_ = 0;
    std::size_t next_row_ = 0, last_full_ = 0;  ///< the joint of a loop that came to its limit last, at last_full_at_
    Outcome outcome_ = Outcome::reached_end;
    Look look_, decided_;
    std::vector<double> row_;                       ///< of put_row()
    std::vector<Series> sampled_;                   ///< of the loads on the stretch, if somebody wanted them
    std::array<std::vector<double>, 5> scratch_;    ///< of look()
    std::array<std::vector<double>, 4> projected_;  ///< of project()
    std::vector<char> seen_, alike_;                ///< of project()
    mutable std::vector<double> point_, departing_;
    mutable std::vector<double> sizes_;  ///< of each body: how great the torques on it are, at a time
    mutable double sizes_at_ = -model::never;
};

Engine::Engine(const Request& problem, Run& result)
    : problem_(problem),
      result_(result),
      asking_{.named = problem.system.named, .told = 2 * problem.system.bodies.size() + problem.drive.states.size()},
      mechanics_(problem.system, problem.drive, asking_),
      now_{problem.window.start, 0} {
    const std::size_t joints = mechanics_.joints();
    y_ = problem.drive.theta0;
    y_.insert(y_.end(), problem.drive.velocity0.begin(), problem.drive.velocity0.end());
    for (const model::OwnState& state : problem.drive.states) y_.push_back(state.start);
    y_.resize(2 * n() + mechanics_.states(), 0);
    mode_.friction.resize(joints), mode_.leans.assign(joints, 0);
    low_.assign(n(), 0), origin_.assign(joints, 0), reach_.assign(joints, 0);
    mode_.presses.assign(joints, 0), mode_.sliders.assign(mechanics_.sliders().size(), Motion::stuck);
    mode_.rubs = mechanics_.rubbing(), mode_.rigid.assign(joints, 0), rigid_at_.assign(joints, 0);
    for (std::size_t j = 0; j < joints; ++j) mode_.rigid[j] = problem.system.joints[j].rigid ? 1 : 0;
    arrived_.assign(joints, Motion::stuck), crept_.assign(joints, 0);
    edge_.assign(joints, 0), at_wall_.assign(joints, 0), leaned_.assign(joints, 0), normal_half_.assign(joints, 0);
    heading_.assign(n(), Motion::stuck);
    watches_.resize(problem.drive.events.size()), arrivals_.resize(joints);
    if (problem.before != nullptr) {
        y_ = problem.before->y;
        if (!problem.before->low.empty()) low_ = problem.before->low;
        mode_ = problem.before->mode;
        for (std::size_t j = 0; j < joints; ++j) leaned_[j] = mode_.leans[j] != 0 ? 1 : 0;
        for (std::size_t j = 0; j < joints; ++j) mechanics_.loads()[j].remember(problem.before->controllers[j]);
        echoes_ = problem.before->echoes;
        if (!problem.before->watches.empty()) watches_ = problem.before->watches;
        if (!problem.before->heading.empty()) heading_ = problem.before->heading;
    }
    keep_rigid_places();
    std::vector<Joint> weights;
    for (const Joint& joint : problem.system.joints) {
        weights.push_back({.name = {}, .of = joint.of, .damping = joint.damping, .stops = joint.stops});
        has_walls_ |= joint.any_walls() != nullptr;
    }
    history_ = std::make_shared<History>(std::move(weights), n(), y_, now_.hi,
                                         problem.before ? problem.before->past : nullptr, problem.history_bytes);
    mechanics_.for_each_signal([&](const Signal& s) {
        for (const double by : s.delays()) {
            shortest_delay_ = std::min(shortest_delay_, by), longest_delay_ = std::max(longest_delay_, by);
        }
    });
    for (const model::Body& body : problem.system.bodies) inertia_ += body.inertia;
    mechanics_.for_each_piecewise(now_.hi, [this](Piecewise&) { has_pieces_ = true; });
    samples_ = mechanics_.samples_the_motion();
    born_ = problem.before ? problem.before->born : now_.hi;
    asking_.past = [this](double t, Side side) { return history_->at(t, side); };
    const double run = problem.window.end - problem.window.start;
    Mode free = mode_;
    for (std::size_t j = 0; j < joints; ++j) free.friction[j].way = Motion::forward, free.leans[j] = 0;
    const double w = mechanics_.fastest(Frame(problem.system, free));
    period_ = w > 0 ? 2 * std::numbers::pi / w : model::never;
    pace_ = std::min(period_, run);
    longest_all_ = std::min(problem.longest, w > 0 ? longest_in_periods * period_ : part_of_run * run);
    longest_ = longest_all_;
    h_ = longest_ / 2;
    attempts_since_ = now_.hi;
    solver_.emplace(mechanics_, problem.tolerance, longest_all_, problem.step);
    if (problem.before != nullptr) solver_->know(problem.before->floor);
    const std::size_t columns = 1 + columns_of_body * n() + columns_of_link * (told_joints() - n()) + problem.hidden +
                                mechanics_.states_of_user() - (problem.joined_elsewhere ? n() : 0);
    result_.table = Growing<double>(problem.rows.count(), columns);
}

const Frame& Engine::frame() {
    bool same = frame_ != nullptr && frame_of_.second == mode_.leans;
    for (std::size_t j = 0; same && j < mechanics_.joints(); ++j) same = mode_.holds(j) == (frame_of_.first[j] != 0);
    if (same) return *frame_;
    frame_of_.first.resize(mechanics_.joints());
    for (std::size_t j = 0; j < frame_of_.first.size(); ++j) frame_of_.first[j] = mode_.holds(j) ? 1 : 0;
    frame_of_.second = mode_.leans;
    auto found = frames_.find(frame_of_);
    if (found == frames_.end()) {
        constexpr std::size_t most_frames = 512;
        if (frames_.size() >= most_frames) frames_.clear();
        Frame made(problem_.system, mode_);
        const double w = mechanics_.fastest(made);
        const double longest =
            w > 0 ? std::min(problem_.longest, longest_in_periods * 2 * std::numbers::pi / w) : longest_all_;
        found = frames_.emplace(frame_of_, std::pair(std::move(made), longest)).first;
    }
    longest_ = found->second.second;
    frame_ = &found->second.first;
    return *frame_;
}

/// How great the torques at its bodies are, as torques on its angle.
double Engine::torque_size(std::size_t joint) const {
    if (sizes_at_ != now_.hi || sizes_.empty()) {
        sizes_.assign(n(), 0);
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            const Joint& own = problem_.system.joints[j];
            double load = segment_.loads.empty() ? 0 : greatest(segment_.loads[j]);
            // What depends on the motion may be 0 here, and would be a little later.
            if (!segment_.loads.empty() && mechanics_.loads()[j].asks_the_motion()) {
                load = std::max(load, greatest(segment_.driven[j]));
            }
            const double size = load + mechanics_.size_of(j, here());
            for (const auto& [body, by] : own.of) sizes_[body] += std::fabs(by) * size;
        }
        sizes_at_ = now_.hi;
    }
    double size = 0;
    for (const auto& [body, by] : problem_.system.joints[joint].of) size += sizes_[body] / std::fabs(by);
    return size;
}

// ---- decisions

/// The state at which functions that jump at slip 0 are asked: a hair of velocity on the way of what leaves.
const std::vector<double>& Engine::departing() const {
    const auto leaves = [this](std::size_t j) { return mode_.friction[j].leaving && mode_.leans[j] == 0; };
    bool any = false;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) any = any || leaves(j);
    if (!any) return y_;
    departing_ = y_;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!leaves(j)) continue;
        const model::Weight& first = problem_.system.joints[j].of.front();
        double& v = departing_[n() + first.body];
        if (v == 0)
            v = std::copysign(std::numeric_limits<double>::min(), model::sign_of(mode_.friction[j].way) * first.by);
    }
    return departing_;
}

/// Torques, accelerations and what holds, at a moment, which may be at x of the stretch. False when something is not
/// finite.
bool Engine::look(const Moment& at, const Mode& mode, const Frame& frame, Look& result, std::optional<double> x,
                  Loads from) {
    const std::size_t joints = mechanics_.joints();
    if (!x) decide_conditions(at, mode);
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
            const BeltSlope slope = belt_slope(j);
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

/// The velocity of the belt; where it passes zero, a hair of velocity that way on which it goes.
double Engine::belt_heading(std::size_t joint) const {
    const double v = mechanics_.belt(joint, now_.hi, side());
    if (v != 0 || !mechanics_.has_belt(joint)) return v;
    const double rate = belt_slope(joint).sure();
    return rate == 0 ? 0 : std::copysign(std::numeric_limits<double>::min(), rate);
}

/// Its velocity is 0, or what it has become in the roundings of the time.
bool Engine::belt_sets_off(std::size_t joint) const {
    const double v = mechanics_.belt(joint, now_.hi, side());
    return std::fabs(v) <= 16 * rounding * std::fabs(now_.hi * belt_slope(joint).rate);
}

/// At x of the last stretch; at a break from the right, where nothing tells them but the belts.
void Engine::find_belt_slopes(std::optional<double> x) {
    slopes_.assign(mechanics_.joints(), {0, 0});
    for (std::size_t j = 0; mechanics_.has_belts() && j < slopes_.size(); ++j) {
        if (!mechanics_.has_belt(j)) continue;
        slopes_[j] = x ? BeltSlope{cheb::value(cheb::fit(segment_.belt_rates[j]), *x),
                                   solver_->blurred_by_belts(segment_) / inertia_}
                       : mechanics_.belt_slope(j, towards(now_.hi, side()), belt_stretch * pace_);
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
        frame.offsets(of_joints, mode_, offsets);
        double size = 0;
        for (const auto& [body, by] : own.of) size += std::fabs(by * offsets[body]);
        return std::fabs(own.sum(offsets) - of_joints[joint]) <= nearly * size;
    };
    std::vector<double> belts(mechanics_.joints()), rates(mechanics_.joints());
    for (std::size_t j = 0; j < belts.size(); ++j) {
        belts[j] = mechanics_.belt(j, now_.hi, side()), rates[j] = belt_slope(j).rate;
    }
    constexpr double of_slopes = 1e-6;  // which are differences
    return alike(belts, 64 * rounding) && alike(rates, of_slopes);
}

void Engine::slide(std::size_t joint, Motion way, bool leaving) {
    Slipping& how = mode_.friction[joint];
    how.way = way, how.leaving = leaving, how.riding = false, how.creeps = Motion::stuck;
    edge_[joint] = 0;
    const model::Friction& law = problem_.system.joints[joint].friction.law;
    if (law.ranges() > 0) {
        const double speed = leaving ? 0 : std::max(0.0, model::sign_of(way) * slip(joint));
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
        asked_[j].leant = mode_.leans[j];
        if (!rubs(j)) continue;
        Slipping& how = mode_.friction[j];
        if (mode_.leans[j] != 0 && how.leaving) continue;
        if (const double heading = belt_heading(j); mode_.leans[j] != 0 && heading != 0) {
            const Motion way = model::motion_of(-heading);
            if (how.way != way) slide(j, way, false);
            continue;
        }
        if (mode_.leans[j] != 0) {  // wall and friction hold it together
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
    entered_ = mode_;
    const bool free = std::none_of(asked_.begin(), asked_.end(), [](const Asked& one) { return one.asked; });
    if (free && frame().edges.empty()) return true;
    project(side());
    const bool loops = !frame().closing.empty();
    // One after the other comes to its limit now, or can not go: no sharing holds any longer.
    const bool all_used = loops && last_full_at_ == now_.hi;
    if (loops && released) last_full_at_ = now_.hi, last_full_ = released->which;
    const std::size_t full = released ? released->which : all_used ? last_full_ : joints;
    if (loops && !all_used && !share_loops(released)) return false;
    for (std::size_t j = 0; j < joints && told; ++j) {
        if (asked_[j].slid != Motion::stuck) settle_at_limit(j);
    }
    Look& found = decided_;
    // What was released is so between two doubles of the time.
    const double late = std::fabs(now_.hi);
    const double between =
        released ? lost_in_time(cheb::fit(segment_.holding[released->which]), late, segment_.h, model::never) : 0;
    const int most = 8 * static_cast<int>(joints) + 16;
    for (int i = 0;; ++i) {
        if (all_used || i > most) {
            if (!decide_together(full)) return false;
            break;
        }
        const Frame& present = frame();
        bool grown = false;
        for (std::size_t j = 0; j < joints; ++j) {
            Slipping& how = mode_.friction[j];
            const bool together = moves_as_one(j, present);
            if (how.riding && !together) slide(j, how.way, true);
            // What others hold together stands at slip 0 with them.
            const bool slides = rubs(j) && how.way != Motion::stuck && !how.riding && mode_.leans[j] == 0;
            if (slides && together && how.leaving) how.riding = true, how.leaving = false;
            if (!slides || !together || how.riding || mechanics_.belt(j, now_.hi, side()) != 0) continue;
            asked_[j].slid = how.way, asked_[j].asked = true, grown = true;
            how.way = Motion::stuck;
        }
        if (grown) {
            project(side());
            continue;
        }
        if (!look({now_.hi, side(), departing()}, mode_, present, found)) return fail(Outcome::excitation_not_finite);
        for (std::size_t j = 0; j < joints; ++j) {
            if (crept_[j] != 0 && asked_[j].slid != Motion::stuck && mode_.holds(j))
                creep(j, asked_[j].slid, -found.holding[j]);
        }
        constexpr double nearly = 1e-10;  // of the torques: what differences tell of a belt is known no better
        std::size_t worst = joints;
        double most_beyond = 0;
        Motion way = Motion::stuck;
        for (std::size_t j = 0; j < joints; ++j) {
            if (!mode_.holds(j)) continue;
            Motion towards = Motion::stuck;
            const double beyond = excess(j, found, mode_, here(), towards);
            if (std::isnan(beyond)) return fail(Outcome::excitation_not_finite);
            const double size = n() > 1 ? 8 * rounding * torque_size(j) : 0;
            const bool own = released && released->which == j;
            if ((own || asked_[j].let_go != Motion::stuck) &&
                std::fabs(beyond) <= nearly * torque_size(j) + 2 * found.blurred + between) {
                worst = j, most_beyond = model::never,
                way = own ? static_cast<Motion>(released->side) : asked_[j].let_go;
                continue;
            }
            if (!(beyond > size)) continue;
            const double part = beyond / (mechanics_.size_of(j, here()) + std::numeric_limits<double>::min());
            if (worst == joints || part > most_beyond) worst = j, most_beyond = part, way = towards;
        }
        if (worst < joints) {
            if (released && released->which == worst) released.reset();
            asked_[worst].pull = -found.holding[worst];
            asked_[worst].let_go = Motion::stuck;
            if (Slipping& how = mode_.friction[worst]; how.creeps != Motion::stuck && way != how.creeps) {
                how.creeps = Motion::stuck;
                if (told) tell(EventKind::stick, static_cast<int>(worst));
                continue;
            }
            if (mode_.friction[worst].creeps != Motion::stuck) asked_[worst].was_held = false;
            if (mode_.leans[worst] != 0) {
                mode_.leans[worst] = 0, at_wall_[worst] = 1;
                const Motion slides = mode_.friction[worst].way;
                if (rubs(worst) && slides == Motion::stuck) {
                    slide(worst, way, true);
                } else if (rubs(worst) && belt_sets_off(worst)) {
                    mode_.friction[worst].way = Motion::stuck;  // it may go with the belt
                }
            } else {
                slide(worst, way, true);
                // In a loop others may hold on, while this one gives all that it can.
                if (moves_as_one(worst, frame())) {
                    mode_.friction[worst].riding = true, mode_.friction[worst].leaving = false;
                }
            }
            continue;
        }
        bool changed = false, goes_round = false;
        for (std::size_t j = 0; j < joints && !changed; ++j) {
            Slipping& how = mode_.friction[j];
            const bool lifted = asked_[j].leant != 0 && mode_.leans[j] == 0;
            if (!how.leaving && !lifted) continue;
            const Joint& joint = problem_.system.joints[j];
            double rate = joint.sum(found.accelerations);
            const double I = problem_.system.bodies[joint.first()].inertia / std::fabs(joint.of.front().by);
            const double nothing = 64 * rounding * torque_size(j) + between;
            goes_round = goes_round || (lifted && asked_[j].leant * rate * I > nothing);
            if (mechanics_.has_belt(j)) rate -= belt_slope(j).rate;
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
        if (goes_round && !decide_together(full)) return false;
        break;
    }
    project(side());
    for (std::size_t j = 0; j < joints; ++j) {
        if (asked_[j].leant != 0 || mode_.leans[j] != 0) {
            if (told && leaned_[j] != 0 && mode_.leans[j] == 0) tell(EventKind::slip, static_cast<int>(j));
            if (mode_.leans[j] == 0) leaned_[j] = 0;
            arrived_[j] = Motion::stuck;
            continue;
        }
        if (!asked_[j].asked) continue;
        const Slipping& how = mode_.friction[j];
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
            if (!only_touched(j, how.way)) tell(EventKind::slip, static_cast<int>(j));
        } else if (told && !asked_[j].was_held && !asked_[j].was_creeping && !slides && !take_back_slip(j)) {
            tell(EventKind::stick, static_cast<int>(j));
        }
        arrived_[j] = Motion::stuck;
    }
    return true;
}

/// A mass that comes to a stop beyond the limit of sticking by no more than the roundings of its way is at the limit.
void Engine::settle_at_limit(std::size_t joint) {
    const Joint& own = problem_.system.joints[joint];
    const double before = std::exchange(size_at_stop_, torque_size(joint));
    const bool alone = n() == 1 && mechanics_.all_linear() && !mechanics_.has_belts() && mode_.leans[joint] == 0;
    if (!alone || own.stiffness == 0) return;
    if (!look({now_.hi, side(), departing()}, mode_, frame(), decided_)) return;
    constexpr double roundings = 1024 * rounding;
    Motion towards = Motion::stuck;
    const double beyond = excess(joint, decided_, mode_, here(), towards);
    if (!(beyond > 0) || beyond > roundings * std::max(size_at_stop_, before)) return;
    const double way = model::sign_of(towards), limit = mechanics_.holding(joint, towards, here());
    double place = (decided_.loads[0] - way * limit) / own.stiffness;
    while (model::excess_over(limit, own.stiffness, decided_.loads[0], place, way) > 0) {
        place = std::nextafter(place, way * model::never);
    }
    y_[0] = place, low_[0] = 0;
}

/// Whether the stick that ends now was none: the joint came to slip 0 right at the limit, and friction withheld an
/// impulse below rounding while the pull passed it. Which side of the limit it was on is for rounding to say. Then it
/// is told no more, or is a turn.
bool Engine::only_touched(std::size_t joint, Motion way) {
    constexpr double briefly = 1e-3, withheld = 64 * rounding;
    if (result_.events.empty() || arrivals_[joint].slid == Motion::stuck) return false;
    Event& last = result_.events.back();
    const double part = (now_.hi - last.t) / pace_;
    if (last.kind != EventKind::stick || last.where != static_cast<int>(joint) || part > briefly) return false;
    const double impulse = std::fabs(asked_[joint].pull - arrivals_[joint].pull) * (2 * std::numbers::pi * part);
    if (!(impulse <= withheld * torque_size(joint))) return false;
    if (way == arrivals_[joint].slid) {
        result_.events.pop_back();
    } else {
        last.kind = EventKind::turn;
    }
    return true;
}

/// Whether what has come down to rounding is on its way still, because no more than the friction of sliding balances
/// its pull, and more would hold it.
void Engine::creep(std::size_t joint, Motion way, double pull) {
    Slipping& how = mode_.friction[joint];
    const double level = mechanics_.sliding(joint, {.way = way}, 0, here()), size = torque_size(joint);
    if (how.creeps != Motion::stuck || !(mechanics_.holding(joint, way, here()) > level)) return;
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
    const Frame present = frame();
    Look found;
    if (!look({now_.hi, side(), departing()}, mode_, present, found)) return fail(Outcome::excitation_not_finite);
    const auto count = static_cast<Eigen::Index>(held.size());
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n()), count);
    box.low.resize(count), box.high.resize(count), box.slope.resize(count);
    for (Eigen::Index c = 0; c < count; ++c) {
        const std::size_t j = held[static_cast<std::size_t>(c)];
        const Joint& joint = problem_.system.joints[j];
        for (const auto& [body, by] : joint.of) D(static_cast<Eigen::Index>(body), c) = by;
        const bool sticks = rubs(j) && mode_.friction[j].way == Motion::stuck;
        constexpr double wall = 1e30;
        box.low(c) = sticks ? -mechanics_.holding(j, Motion::forward, here()) : 0;
        box.high(c) = sticks ? std::min(wall, mechanics_.holding(j, Motion::backward, here())) : 0;
        if (mode_.leans[j] > 0 || mode_.rigid[j] != 0) box.low(c) = -wall;
        if (mode_.leans[j] < 0 || mode_.rigid[j] != 0) box.high(c) = wall;
        box.slope(c) = mode_.leans[j] == 0 ? -belt_slope(j).rate : 0;
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
bool Engine::decide_together(std::size_t full) {
    mode_ = entered_;
    std::vector<std::size_t> held;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (asked_[j].asked || mode_.keeps_place(j)) held.push_back(j);
    }
    Box box;
    if (!box_of(held, box)) return false;
    for (std::size_t k = 0; k < held.size(); ++k) {
        if (held[k] != full) continue;
        const double room = little_more * torque_size(full);
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
            if (slips[k] != 0 || !at_limit || !rubs(j) || mode_.friction[j].way != Motion::stuck) continue;
            if (!(std::fabs(rate(c)) > no_motion * box.G(c, c) * torque_size(j))) continue;  // others hold it, too
            slips[k] = 1, grown = true;
            if (mode_.leans[j] <= 0) box.low(c) = -mechanics_.sliding(j, {.way = Motion::forward}, 0, here());
            if (mode_.leans[j] >= 0) box.high(c) = mechanics_.sliding(j, {.way = Motion::backward}, 0, here());
        }
    }
    std::vector<std::size_t> gone;
    for (Eigen::Index c = 0; c < torque.size(); ++c) {
        const std::size_t j = held[static_cast<std::size_t>(c)];
        const bool at_low = torque(c) <= box.low(c), at_high = torque(c) >= box.high(c);
        if (!at_low && !at_high) continue;
        if (mode_.leans[j] != 0) mode_.leans[j] = 0, at_wall_[j] = 1;
        if (!rubs(j)) continue;
        if (mode_.friction[j].way == Motion::stuck) {
            // What can hold nothing is at both of its limits.
            slide(j, at_low && !(at_high && rate(c) < 0) ? Motion::forward : Motion::backward, true);
            gone.push_back(j);
        } else if (mechanics_.belt(j, now_.hi, side()) == 0) {
            mode_.friction[j].way = Motion::stuck;  // it may go with the belt, which sets off
        }
    }
    for (const std::size_t j : gone) {
        if (!moves_as_one(j, frame())) continue;
        mode_.friction[j].riding = true, mode_.friction[j].leaving = false;
    }
    return true;
}

/// Where joints that hold close loops, their torques are not known from the motion. What they can hold together they
/// do: the accelerations are the least that torques within their limits leave (Gauss), and of all such torques they
/// have the smallest. A joint at its limit rides along, or slides when the others do not hold.
bool Engine::share_loops(const std::optional<Ending>& released) {
    const std::vector<std::size_t> held = frame().sharing_of;
    Box box;
    if (!box_of(held, box)) return false;
    Eigen::Index full = -1;  // the joint that came to its limit
    for (std::size_t c = 0; released && c < held.size(); ++c) {
        if (released->which == held[c]) full = static_cast<Eigen::Index>(c);
    }
    const double size = full < 0 ? 0 : torque_size(held[static_cast<std::size_t>(full)]);
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
        if (mode_.leans[j] != 0) mode_.leans[j] = 0, at_wall_[j] = 1;
        if (!rubs(j) || mode_.friction[j].way != Motion::stuck) continue;
        slide(j, at_low ? Motion::forward : Motion::backward, false);
        mode_.friction[j].riding = true;
    }
    return true;
}

/// What is held together has one velocity, to the letter; what leans is at its wall.
void Engine::project(Side when) {
    const Frame& present = frame();
    if (present.edges.empty()) return;
    auto& [belts, offsets, momentum, first] = projected_;
    belts.resize(mechanics_.joints());
    for (std::size_t j = 0; j < belts.size(); ++j) belts[j] = mechanics_.belt(j, now_.hi, when);
    present.offsets(belts, mode_, offsets);
    momentum.assign(present.groups(), 0), first.resize(present.groups());
    seen_.assign(present.groups(), 0), alike_.assign(present.groups(), 1);
    for (std::size_t i = 0; i < n(); ++i) {
        const double v = y_[n() + i] - offsets[i];
        for (const auto& [group, by] : present.bodies[i]) {
            momentum[group] += by * problem_.system.bodies[i].inertia * v;
            if (seen_[group] == 0) first[group] = v / by, seen_[group] = 1;
            if (v != by * first[group] || present.bodies[i].size() > 1) alike_[group] = 0;
        }
    }
    for (std::size_t i = 0; i < n(); ++i) {
        const Frame::Shape& shape = present.bodies[i];
        if (std::all_of(shape.begin(), shape.end(), [this](const auto& share) { return alike_[share.group] != 0; })) {
            if (shape.empty()) y_[n() + i] = offsets[i];
            continue;
        }
        double v = 0;
        for (const auto& [group, by] : shape) v += by * (momentum[group] / present.inertia[group]);
        y_[n() + i] = v + offsets[i];
    }
    for (const Frame::Edge& edge : present.edges) {
        if (!mode_.keeps_place(edge.joint)) continue;
        const bool moved = edge.joint >= told_joints();
        if (moved && !problem_.system.bodies[moved_body(edge.joint)].moved->by_angle) continue;
        if (moved) rigid_at_[edge.joint] = angle_given(moved_body(edge.joint), when);
        const int wall = mode_.leans[edge.joint];
        put_child(edge.joint, edge.child, edge.by,
                  wall != 0 ? problem_.system.joints[edge.joint].walls->at(wall) : rigid_at_[edge.joint]);
    }
}

/// The angle that a body is moved to, now.
double Engine::angle_given(std::size_t body, Side when) const {
    const model::Excitation& angle = problem_.system.bodies[body].moved->motion;
    const bool breaks = when != Side::at && angle.next_break(std::nextafter(now_.hi, -model::never)) == now_.hi;
    return !breaks                ? angle.value(now_.hi)
           : when == Side::before ? angle.value_before(now_.hi)
                                  : angle.value_after(now_.hi);
}

/// Rigid joints keep the angles that they have now.
void Engine::keep_rigid_places() {
    for (std::size_t j = 0; j < rigid_at_.size(); ++j) {
        if (mode_.rigid[j] != 0) rigid_at_[j] = mechanics_.angle(j, y_) + problem_.system.joints[j].sum(low_);
    }
}

/// Puts a body where the angle of a joint is at this place.
void Engine::put_child(std::size_t joint, std::size_t child, double weight, double place) {
    double low = 0;
    for (const auto& [body, by] : problem_.system.joints[joint].of) {
        if (body != child) place -= by * y_[body], low -= by * low_[body];
    }
    y_[child] = place / weight, low_[child] = low / weight;
}

/// Neither now nor a little later: a load that only touches zero opens nothing, nor does one that is no number.
bool Engine::nothing_presses(std::size_t joint) const {
    constexpr double later = 1e-9;
    // Where the load was found to fall below zero it may still be its rounding.
    if (normal_half_[joint] >= 0 && !(mechanics_.pressing(joint, here()) <= 0)) return false;
    std::vector<double> y = y_;
    const double h = later * pace_;
    for (std::size_t i = 0; i < n(); ++i) y[i] += h * y[n() + i];
    return mechanics_.pressing(joint, {now_.hi + h, Side::at, y}) <= 0;
}

/// A contact on which nothing presses is open: it neither sticks nor slips. True when one has opened or closed.
bool Engine::open_and_close() {
    bool changed = false;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!mechanics_.may_open(j)) continue;
        const bool opens = nothing_presses(j);
        if (opens != rubs(j)) continue;
        changed = true;
        mode_.rubs[j] = opens ? 0 : 1;
        mode_.friction[j] = {};
        arrived_[j] = Motion::stuck;
        normal_half_[j] = opens ? -1 : 1;
        const Joint& joint = problem_.system.joints[j];
        double fastest = std::fabs(mechanics_.belt(j, now_.hi, side()));
        for (const auto& [body, by] : joint.of) {
            const double v = y_[n() + body];
            fastest = std::max(fastest, std::fabs(by * v));
            if (opens) heading_[body] = model::motion_of(v);
        }
        if (!opens && std::fabs(slip(j)) > 16 * rounding * fastest) {
            slide(j, model::motion_of(slip(j)), false);
        } else if (!opens && mode_.leans[j] == 0) {
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
        if (!rubs(j) || mode_.leans[j] != 0) continue;
        Slipping& how = mode_.friction[j];
        const double s = slip(j);
        const double belt = mechanics_.belt(j, now_.hi, side());
        const bool weighted = problem_.system.joints[j].is_weighted();
        const double known = weighted ? mechanics_.speed_scale(j, y_) : std::fabs(mechanics_.velocity(j, y_));
        double corner = 4 * rounding * (known + std::fabs(belt));
        if (why == Because::belt && mechanics_.has_belt(j)) {
            // Where it only turns a corner its values differ by rounding, and by what it does in a hair of time.
            double rate = std::fabs(belt_slope(j).rate);
            if (!segment_.belt_rates.empty()) rate = std::max(rate, std::fabs(segment_.belt_rates[j][node_count - 1]));
            corner = 16 * corner + rate * 64 * rounding * std::fabs(now_.hi);
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
    after_break_ = mechanics_.next_break(std::nextafter(now_.hi, -model::never)) == now_.hi;
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
        mechanics_.for_each_signal([&](Signal& s) { s.begin(here(), names); });
        if (!arrive()) fail(Outcome::excitation_not_finite);
        echo(now_.hi, 1);
        open_and_close();
        press_stops();
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            if (!rubs(j)) continue;
            const double s = slip(j);
            const bool weighted = problem_.system.joints[j].is_weighted();
            if (std::fabs(s) > (weighted ? 4 * rounding * mechanics_.speed_scale(j, y_) : 0)) {
                slide(j, model::motion_of(s), false);
            } else {
                mode_.friction[j].way = Motion::stuck;
            }
        }
        touch_walls();
        if (outcome_ == Outcome::reached_end) decide(false);
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) leaned_[j] = mode_.leans[j] != 0 ? 1 : 0;
    } else {
        project(side());
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            if (mode_.friction[j].creeps == Motion::stuck) continue;
            crept_events_[j] = event_at(EventKind::stick, static_cast<int>(j), -1);
        }
        if (after_break_) ask_after_break();
    }
    result_.begun = mode_;
    result_.initial = y_;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) reach_[j] = std::fabs(mechanics_.angle(j, y_));
}

void Engine::run() {
    begin();
    unsigned pieces = 0;
    constexpr unsigned between_questions = 16;
    bool alive = outcome_ == Outcome::reached_end;
    while (alive && now_.hi < problem_.window.end) {
        if (pieces++ % between_questions == 0 && problem_.monitor && !problem_.monitor(now_.hi)) {
            outcome_ = Outcome::interrupted;
            break;
        }
        alive = advance();
    }
    if (outcome_ == Outcome::unresolved || outcome_ == Outcome::chattering) explain_end();
    const bool stands_at_now = outcome_ != Outcome::excitation_not_finite && outcome_ != Outcome::unresolved;
    if (stands_at_now) {
        while (next_row_ < problem_.rows.count() && problem_.rows.time(next_row_) <= now_.hi && put_row(now_.hi, -2)) {
        }
    }
    for (const auto& [joint, event] : crept_events_) {  // nothing came that would have moved it
        if (outcome_ != Outcome::reached_end || mode_.friction[joint].creeps == Motion::stuck) continue;
        const auto later = std::upper_bound(result_.events.begin(), result_.events.end(), event,
                                            [](const Event& a, const Event& b) { return a.t < b.t; });
        result_.events.insert(later, event);
    }
    if (outcome_ == Outcome::reached_end) {
        const Frame& present = frame();
        bool still = true, for_good = !mechanics_.asks_functions() && !problem_.joined_elsewhere;
        for (std::size_t i = 0; i < n(); ++i) {
            still = still && present.bodies[i].empty() && (y_[n() + i] == 0 || problem_.joined_elsewhere);
        }
        mechanics_.for_each_signal([&](const Signal& s) { for_good = for_good && s.constant_from() <= now_.hi; });
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
    if (mode_.friction[0].way != Motion::stuck && !mode_.holds(0)) result_.motion_at_stop = mode_.friction[0].way;
    if (!rubs(0) && mode_.leans[0] == 0) result_.motion_at_stop = heading_[0];
    if (mode_.friction[0].creeps != Motion::stuck) result_.motion_at_stop = mode_.friction[0].creeps;
    result_.outcome = outcome_;
    result_.located = has_pieces_;
    const bool lost = outcome_ == Outcome::unresolved || outcome_ == Outcome::chattering;
    result_.noise = lost ? 0 : solver_->clear_noise();
    if (outcome_ == Outcome::chattering) forget_chatter();
    keep_within_walls(y_);  // beside a wall its distance has digits that theta has not
    result_.t_start = problem_.window.start;
    result_.t_stop = now_.hi;
    if (next_row_ < problem_.rows.count()) result_.table = result_.table.first(next_row_);
    history_->close(now_, y_);
    result_.history = history_;
    auto carry = std::make_shared<Carry>();
    carry->y = y_, carry->low = low_, carry->mode = mode_, carry->watches = watches_, carry->echoes = echoes_,
    carry->heading = heading_, carry->born = born_, carry->floor = solver_->floor();
    if (longest_delay_ > 0 || !problem_.joined_elsewhere) carry->past = history_;
    for (const Signal& load : mechanics_.loads()) carry->controllers.push_back(load.memory());
    result_.carry = std::move(carry);
}

/// Of stops and slips that follow each other at once, and lead nowhere, the first one is told.
void Engine::forget_chatter() {
    constexpr double soon = 1e-6;
    std::vector<Event>& events = result_.events;
    const auto follows = [&](const Event& e, const Event& before) {
        return e.kind <= EventKind::rest && e.t - before.t <= soon * pace_;
    };
    while (events.size() > 1 && follows(events.back(), *(events.end() - 2))) events.pop_back();
}

void Engine::choose() {
    frame();
    double breaks = std::min(mechanics_.next_break(now_.hi), echoes_.empty() ? model::never : echoes_.front().first);
    if (!breaks_.empty()) breaks = std::min(breaks, breaks_.front());
    for (const model::WantedEvent& event : problem_.drive.events) {
        breaks = std::min(breaks, event.when->next_break(now_.hi));
    }
    double limit = std::min(problem_.window.end, breaks);
    if (problem_.step > 0) {
        // A break that rounding puts beside a step's end is that end.
        const double beside = std::max(1e-9 * problem_.step, 4 * rounding * std::fabs(now_.hi));
        const double steps = std::floor((now_.hi - problem_.window.start + beside) / problem_.step) + 1;
        const double step_end = problem_.window.start + steps * problem_.step;
        if (step_end < limit - beside) limit = step_end;
    }
    double h = std::min(
        {rung(h_, longest_ / 2), mechanics_.view(now_.hi, cheb::widest_gap) / 2, shortest_delay_ / 2 * (1 - 1e-12)});
    if (bad_time_ < model::never) h = std::min(h, now_.until(bad_time_) / 4);
    if (problem_.step == 0) h = std::min(h, longest_under_friction() / 2);
    // As long as it takes to a wall, or back to it, and a little more: a small bounce is to be seen.
    if (has_walls_) h = std::min(h, std::max(0.6 * until_wall(), 1e-9 * pace_));
    const double remaining = now_.until(limit);
    const bool to_limit = remaining <= 2 * h * (1 + 1e-9);
    segment_.start = now_;
    segment_.h = to_limit ? remaining / 2 : remaining < 4 * h ? remaining / 4 : h;
    segment_.end = to_limit ? limit : now_.after(2 * segment_.h);
    segment_.from_break = after_break_;
    segment_.to_break = to_limit && limit == breaks;
    segment_.to_the_end = to_limit && (segment_.to_break || limit == problem_.window.end || problem_.step == 0);
}

/// How long it takes to the next wall, if all accelerations stay as they are.
double Engine::until_wall() {
    double first = model::never;
    if (!look({now_.hi, side(), departing()}, mode_, *frame_, look_)) return first;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const Joint& joint = problem_.system.joints[j];
        const model::Walls* walls = joint.any_walls();
        if (walls == nullptr || mode_.holds(j) || mode_.presses[j] != 0) continue;
        const double rate = joint.sum(look_.accelerations);
        for (const int wall : {1, -1}) {
            const double apart = std::max(0.0, wall * gap(j, walls->at(wall)));
            const double v = wall * mechanics_.velocity(j, y_);
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
double Engine::longest_under_friction() {
    double longest = model::never;
    bool looked = false;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const Joint& joint = problem_.system.joints[j];
        const model::Friction& law = joint.friction.law;
        const Slipping& how = mode_.friction[j];
        if (law.ranges() == 0 || how.way == Motion::stuck || how.riding || mode_.leans[j] != 0) continue;
        if (!looked && !look({now_.hi, side(), departing()}, mode_, *frame_, look_)) return longest;
        looked = true;
        const double sign = model::sign_of(how.way);
        const double lightness = joint.lightness(problem_.system.bodies), first = joint.sum(look_.accelerations);
        const double C = joint.damping, v = mechanics_.velocity(j, y_);
        const double second = (std::fabs(joint.stiffness * v) + std::fabs(C * first)) * lightness;
        longest = std::min(longest, longest_step(law, law.range(how.range), std::max(0.0, sign * slip(j)), sign * first,
                                                 second, C, 1 / lightness));
    }
    return longest;
}

void Engine::again(Collocation::Attempt attempt) {
    const int most = samples_ ? most_attempts_sampled : most_attempts;
    if (++attempts_ >= most) {
        if (now_.hi - attempts_since_ < 1e-7 * most * pace_) {
            fail(samples_ ? Outcome::chattering : Outcome::unresolved);
            return;
        }
        attempts_ = 0, attempts_since_ = now_.hi;
    }
    if (attempt == Collocation::Attempt::failed) {
        bad_time_ = solver_->bad_time();
        const double near = std::max(near_failure * pace_, 64 * rounding * std::fabs(now_.hi));
        if (problem_.step > 0 || now_.until(bad_time_) <= near || !mechanics_.may_go_on())
            fail(greatest_of_state() > huge ? Outcome::state_not_finite : Outcome::excitation_not_finite);
        h_ = segment_.h / 2;
        return;
    }
    if (solver_->found_noise(segment_, mode_)) return;
    const bool searched = searched_from_ == now_.hi && segment_.h > 0.1 * searched_h_;
    if (!searched && breaks_.size() < most_found_breaks) {
        searched_from_ = now_.hi, searched_h_ = segment_.h;
        if (const auto found = solver_->found_break(segment_); found && *found > now_.hi) {
            const auto place = std::lower_bound(breaks_.begin(), breaks_.end(), *found);
            if (place == breaks_.end() || *place != *found) {
                breaks_.insert(place, *found);
                if (a_belt_jumps_at(*found)) mechanics_.jumps_at(*found);
                return;
            }
        }
    }
    const double unresolved = solver_->unresolved();
    const double factor = unresolved < model::never ? 0.9 * std::pow(unresolved, -1.0 / 16) : 0;
    h_ = segment_.h * std::clamp(factor, 0.5, 0.9);
    if (unresolved <= slightly && h_ > short_part * longest_) short_enough_ = h_, limited_for_ = limited_stretches;
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
    if (now_.until(*first) < right_behind * segment_.h) {  // it is behind this moment, and was before it
        if (after_break_) return false;
        after_break_ = true;
        mechanics_.jumps_at(now_.hi);
        find_belt_slopes({});
        restart_contacts(Because::belt);
        return true;
    }
    const auto place = std::lower_bound(breaks_.begin(), breaks_.end(), *first);
    if (place != breaks_.end() && *place == *first) return false;
    breaks_.insert(place, *first);
    mechanics_.jumps_at(*first);
    return true;
}

/// The name of a state that has come to where its rate jumps, and drives it back from both sides; empty where none has.
std::string Engine::state_driven_back() {
    constexpr double near = 1e-9, steep = 1e6;
    mechanics_.for_each_piecewise(now_.hi, [](Piecewise& function) { function.let_go(); });
    std::vector<double> y = y_, rates(mechanics_.states());
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) {
        const auto rate = [&](double by) {
            y[2 * n() + k] = y_[2 * n() + k] + by;
            mechanics_.rates({now_.hi, side(), y}, rates.data());
            return rates[k];
        };
        const double own = std::max(std::fabs(rate(0)), std::fabs(rate(near * std::fabs(y_[2 * n() + k]))));
        const double d = near * std::max(own * pace_, std::fabs(y_[2 * n() + k])) + std::numeric_limits<double>::min();
        const double least = std::min(-rate(d), rate(-d));
        y[2 * n() + k] = y_[2 * n() + k];
        if (least * pace_ > steep * d) return problem_.drive.states[k].name;
    }
    return {};
}

/// The run got nowhere: if something that acts in it is rough on every scale, that is why.
void Engine::explain_end() {
    const double most = std::min({pace_, problem_.window.end - now_.hi, shortest_delay_});
    const double from = now_.hi, length = std::min(rough_stretch * pace_, most / 8);
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
        const auto load = [this, i](double t) { return mechanics_.load(i, {t, Side::at, y_}); };
        sources.push_back({of("M", problem_.system.joints[i].name), load, mechanics_.size_of(i, here())});
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
            mechanics_.rates({t, Side::at, y_}, rates.data());
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

double Engine::greatest_of_state() const {
    double most = 0;
    for (const double value : y_) most = std::max(most, std::fabs(value));
    return most;
}

/// Whether nothing that may still come moves any body.
bool Engine::stands_for_good() {
    const Frame& present = frame();
    if (present.groups() > 0 || !present.closing.empty() || mechanics_.states() > 0 || mechanics_.has_base())
        return false;
    if (mechanics_.has_belts() || !problem_.drive.events.empty()) return false;
    bool constant = true;
    mechanics_.for_each_signal([&](const Signal& s) { constant = constant && s.constant_from() <= now_.hi; });
    std::vector<double> greatest_pull(mechanics_.joints()), lacking(n()), held(mechanics_.joints());
    std::vector<double> none(mechanics_.joints()), torques;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!mechanics_.is_native(j) || mode_.friction[j].riding) return false;
        if (!constant && (mode_.leans[j] != 0 || mode_.friction[j].creeps != Motion::stuck)) return false;
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
    mechanics_.torques(here(), mode_, std::vector<double>(mechanics_.joints()), none, torques);
    for (std::size_t i = 0; i < n(); ++i) lacking[i] = -torques[i];
    present.multipliers(lacking, held);
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!mode_.holds(j) || mode_.rigid[j] != 0) continue;
        if (!(greatest_pull[j] - held[j] <= mechanics_.holding(j, Motion::forward, here()))) return false;
        if (!(greatest_pull[j] + held[j] <= mechanics_.holding(j, Motion::backward, here()))) return false;
    }
    return true;
}

/// There is nothing to compute but the loads at the rows, of which there may be many.
bool Engine::rest() {
    constexpr std::size_t rows_at_once = 1U << 12U;
    const bool many = problem_.rows.count() - next_row_ > rows_at_once;
    segment_.start = now_;
    segment_.end = many ? problem_.rows.time(next_row_ + rows_at_once) : problem_.window.end;
    segment_.h = now_.until(segment_.end) / 2;
    segment_.from_break = segment_.to_break = false, segment_.to_the_end = true;
    solver_->stand_still(segment_, y_);
    sampled_.clear();
    return end_at(1);
}

bool Engine::advance() {
    if (greatest_of_state() > beyond_all) return fail(Outcome::state_not_finite);
    if (stands_for_good()) return rest();
    choose();
    if (!(segment_.h > 0)) return fail(Outcome::chattering);
    const Frame& present = *frame_;
    decide_conditions({now_.hi, side(), departing()}, mode_);
    segment_.low = low_, sampled_.clear();
    const auto attempt = solver_->solve(segment_, mode_, present, y_, departing());
    sizes_at_ = -model::never;  // they depend on the loads of the stretch
    const double late = std::max(std::fabs(now_.hi), std::fabs(segment_.end));
    if (problem_.step > 0 && attempt == Collocation::Attempt::resolved && mechanics_.has_belts() && belt_jump_found()) {
        return outcome_ == Outcome::reached_end;
    }
    if (attempt == Collocation::Attempt::shorten && !solver_->tells_rests() &&
        2 * segment_.h <= std::max(shortest * pace_, 16 * rounding * late)) {
        if (++too_short_ > most_short) return fail(Outcome::chattering);
        solver_->pass_over(segment_);
        solver_->find_limits(segment_, mode_);
        h_ = 64 * segment_.h;
    } else if (attempt != Collocation::Attempt::resolved) {
        again(attempt);
        return outcome_ == Outcome::reached_end;
    } else {
        if (2 * segment_.h > 1e-7 * pace_) too_short_ = 0;
        const double least = segment_.h < short_part * longest_ ? 2 : 0;
        const double longer = problem_.step > 0
                                  ? longest_
                                  : segment_.h * std::clamp(0.9 * solver_->growth(), least, samples_ ? 2.0 : 8.0);
        h_ = std::min(longest_ / 2, std::max(h_, longer));
        if (limited_for_ > 0 && --limited_for_ > 0) h_ = std::min(h_, short_enough_);
    }
    Ending ending;
    watch(ending);
    if (outcome_ != Outcome::reached_end) return false;
    if (ending.by == By::condition && ends_before(ending.x)) return true;
    record_turns(ending.x);
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
    now_ = whole && segment_.to_the_end ? Clock{segment_.end, 0} : segment_.start.later(length);
    after_break_ = whole && segment_.to_break && now_.hi < problem_.window.end;
    has_jumped_ = has_jumped_ || (after_break_ && now_.hi != crossing_at_);
    mechanics_.forget_jumps(now_.hi);
    if (bad_time_ <= now_.hi) bad_time_ = model::never, mechanics_.forget_failure();
    const std::size_t ahead = breaks_.size();
    while (!breaks_.empty() && breaks_.front() <= now_.hi) {
        passed_breaks_.pass(breaks_.front());
        breaks_.erase(breaks_.begin());
    }
    if (ahead > 0 && breaks_.empty()) foresee_break();
    if (length > 0) {
        for (Slipping& how : mode_.friction) how.leaving = false;
        if (whole) {
            for (Slipping& how : mode_.friction) how.blunt = 0;
        }
        std::fill(edge_.begin(), edge_.end(), 0);
        std::fill(at_wall_.begin(), at_wall_.end(), 0);
    }
    int generation = 0;
    while (!echoes_.empty() && echoes_.front().first <= now_.hi) {
        generation = std::max(generation, echoes_.front().second);
        echoes_.erase(echoes_.begin());
    }
    if (generation > 0) echo(now_.hi, generation + 1);
    if (!whole || (after_break_ && generation == 0)) echo(now_.hi, 1);
    find_belt_slopes(after_break_ ? std::nullopt : std::optional(x));
    project(after_break_ ? Side::before : Side::at);
    if (!arrive()) return fail(Outcome::excitation_not_finite);
    const bool changed = open_and_close();
    if (after_break_) return ask_after_break();
    return !changed || (decide(true) && (!too_often() || fail(Outcome::chattering)));
}

/// The controllers that sample do so now if it is time. False if one failed.
bool Engine::arrive() {
    bool samples = false, good = true;
    mechanics_.for_each_signal([&](const Signal& s) { samples = samples || s.has_sampled(); });
    if (!samples) return true;
    mechanics_.call_unread(here(), mode_);
    mechanics_.for_each_signal([&](Signal& s) { good = good && s.arrive(here()); });
    return good;
}

/// Loads, limits and belts may have jumped: what holds is asked again.
bool Engine::ask_after_break() {
    if (!mechanics_.has_belts()) return decide(true);
    // What is moved with a new velocity at once throws all that is rigidly linked to it.
    const std::vector<double> before = y_;
    const double energy = kinetic_energy();
    if (problem_.hidden > 0) project(side());
    for (std::size_t j = told_joints(); j < mechanics_.joints(); ++j) {
        const std::size_t body = moved_body(j);
        const double v = y_[n() + body], jump = v - before[n() + body];
        if (!(std::fabs(jump) > 64 * rounding * (std::fabs(v) + std::fabs(before[n() + body])))) continue;
        history_->add_jump(now_.hi, body, {.input = kinetic_energy() - energy});
        heading_[body] = model::motion_of(v);
        has_jumped_ = true;
        tell(EventKind::impact, static_cast<int>(body));
        break;
    }
    return restart_contacts(Because::belt);
}

double Engine::kinetic_energy() const {
    double sum = 0;
    for (std::size_t i = 0; i < n() && problem_.hidden > 0; ++i) {
        sum += mechanics_.own_inertia(i) * y_[n() + i] * y_[n() + i] / 2;
    }
    return sum;
}

/// Where a function of the time has jumped evenly, its next jump is known before it is met.
void Engine::foresee_break() {
    for (const Signal& load : mechanics_.loads()) {
        if (!load.asks_in_time() || !breaks_.empty()) continue;
        const auto value = [&](double t) { return load.of_time({t, Side::at, {}}); };
        if (const auto next = passed_breaks_.next(problem_.window.end, value)) breaks_.push_back(*next);
    }
}

/// The present is at x of the stretch. What is rounded off the angles is kept: beside a wall it is seen.
void Engine::go_to(double x) {
    const std::vector<double> begin = y_;
    segment_.state(x, y_);
    for (std::size_t i = 0; i < n(); ++i) {
        const double moved =
            (x >= 1 ? segment_.moved[i][node_count - 1] : cheb::value(segment_.series[i], x)) + low_[i];
        y_[i] = begin[i] + moved;
        const double added = y_[i] - begin[i];
        low_[i] = (begin[i] - (y_[i] - added)) + (moved - added);
    }
    for (std::size_t j = 0; has_walls_ && j < mechanics_.joints(); ++j) {
        if (problem_.system.joints[j].any_walls() != nullptr)
            reach_[j] = std::max(reach_[j], std::fabs(gap(j, origin_[j])));
    }
}

/// From the angle of a joint to a place.
double Engine::gap(std::size_t joint, double place) const {
    return (place - mechanics_.angle(joint, y_)) - problem_.system.joints[joint].sum(low_);
}

void Engine::keep(double length) {
    if (!(length > 0) || (!problem_.limits.dense && longest_delay_ == 0)) return;
    Kept kept{.start = segment_.start, .h = segment_.h, .length = length, .begin = y_, .series = segment_.series};
    // For the legs of its course.
    if (problem_.limits.dense && problem_.keeps_torques) kept.acting = acting();
    const double past = longest_delay_ > 0 ? now_.hi - 2 * longest_delay_ : model::never;
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
        all[j].holds = rubs(j) && mode_.leans[j] == 0 && mode_.friction[j].way == Motion::stuck;
        if (j >= told_joints()) {  // what moves a body is its input
            const std::size_t body = moved_body(j);
            const double more = mechanics_.own_inertia(body) - problem_.system.bodies[body].inertia;
            for (std::size_t node = 0; node < node_count; ++node) {
                all[body].M[node] += segment_.holding[j][node] + more * segment_.f[n() + body][node];
            }
            continue;
        }
        Nodes springs{};
        all[j].presses = mode_.presses[j] != 0;
        if (all[j].presses) {
            const model::Walls& stops = *problem_.system.joints[j].stops;
            springs = mechanics_.between(j, segment_.y);
            for (double& q : springs) q = stops.torque(mode_.presses[j], q, 0);
        }
        for (std::size_t s = 0; s < mode_.sliders.size(); ++s) {
            const Mechanics::Slider& slider = mechanics_.sliders()[s];
            if (slider.joint != j) continue;
            if (mode_.sliders[s] == Motion::stuck) {
                add(springs, segment_.y[slider.bend], slider.stiffness);
            } else {
                all[j].slides += slider.stiffness * segment_.y[slider.bend][0];
            }
        }
        if (greatest(springs) > 0) all[j].springs = std::make_unique<Nodes>(springs);
        if (mechanics_.has_belt(j)) all[j].belt = std::make_unique<Nodes>(segment_.belts[j]);
        if (all[j].holds) {
            all[j].friction = segment_.holding[j];
        } else if (mechanics_.is_native(j) && rubs(j) && mode_.leans[j] == 0) {
            const Nodes slips = mechanics_.slips(j, segment_.y, segment_.belts[j]);
            mechanics_.add_native_friction(j, mode_, slips, 0, node_count, all[j].friction);
            for (double& torque : all[j].friction) torque = -torque;
        } else if (rubs(j) || mechanics_.bristle(j) != nullptr) {
            for (std::size_t node = 0; node < node_count; ++node) {
                const Moment at = segment_.moment(node, point_);
                all[j].friction[node] =
                    mechanics_.friction(j, at, mode_, segment_.belts[j][node]) + mechanics_.slider_torque(j, at.y);
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
            const double fastest = std::fabs(mechanics_.belt(j, now_.hi, side())) + greatest(segment_.y[n()]);
            // What passed zero because the belt jumped has not come to a standstill.
            constexpr double clearly = 1e-6;
            if (mechanics_.has_belt(j) && std::fabs(slip(j)) > clearly * fastest && mode_.leans[j] == 0) {
                return restart_contacts(Because::belt) && (!too_often() || fail(Outcome::chattering));
            }
            for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
                const Slipping& how = mode_.friction[i];
                if (!rubs(i) || how.way == Motion::stuck || how.riding || mode_.leans[i] != 0) continue;
                const model::Weight& first = problem_.system.joints[i].of.front();
                const double size = std::max(fastest, std::fabs(first.by) * greatest(segment_.y[n() + first.body]));
                if (i == j || std::fabs(slip(i)) <= 64 * rounding * size) arrived_[i] = how.way;
            }
            if (mode_.leans[j] != 0) {  // the belt turns along a mass at a wall
                slide(j, mode_.friction[j].way == Motion::forward ? Motion::backward : Motion::forward, true);
                arrived_[j] = Motion::stuck;
            }
            return decide(true) && (!too_often() || fail(Outcome::chattering));
        }
        case By::release: {
            left_ = mode_;
            const double blunt = mode_.friction[j].blunt;
            if (!decide(true, ending)) return false;
            bool same = mode_.leans == left_.leans;
            for (std::size_t i = 0; i < mechanics_.joints() && same; ++i) {
                same = mode_.friction[i].way == left_.friction[i].way &&
                       mode_.friction[i].riding == left_.friction[i].riding &&
                       mode_.friction[i].creeps == left_.friction[i].creeps;
            }
            // What only touched its limit must pass it clearly the next time.
            if (same) {
                Slipping& how = mode_.friction[j];
                how.blunt = std::max(2 * blunt, 64 * rounding * torque_size(j));
                if (how.blunt > most_blunt * torque_size(j)) return fail(Outcome::chattering);
            }
            return !too_often() || fail(Outcome::chattering);
        }
        case By::wall:
            return hit(j, ending.side);
        case By::stop: {
            const model::Walls& stops = *problem_.system.joints[j].stops;
            const int side = ending.side != 0 ? ending.side : mode_.presses[j];
            origin_[j] = stops.at(side), reach_[j] = 0;
            const bool there = std::fabs(gap(j, origin_[j])) <= 64 * rounding * std::fabs(origin_[j]);
            at_wall_[j] = ending.side == 0 && there ? 1 : 0;
            press(j, ending.side);
            echo(now_.hi, 1);
            return decide(true) && (!too_often() || fail(Outcome::chattering));
        }
        case By::slider:
            if (static_cast<Motion>(ending.side) == Motion::stuck) {
                // What its slip has left, and its spring beyond its limit, is rounding: it would slide again at once.
                const Mechanics::Slider& own = mechanics_.sliders()[j];
                const model::Weight& first = problem_.system.joints[own.joint].of.front();
                y_[n() + first.body] -= slip(own.joint) / first.by;
                y_[own.bend] *= 1 - 8 * rounding;
            }
            let_slide(j, static_cast<Motion>(ending.side));
            return decide(true) && (!too_often() || fail(Outcome::chattering));
        case By::corner: {
            Slipping& how = mode_.friction[j];
            how.range = ending.side > 0 ? how.range + 1 : how.range - 1;
            edge_[j] = -ending.side;
            return !too_often() || fail(Outcome::chattering);
        }
        case By::condition:
            return cross(ending) && decide(true);
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

bool Engine::too_often(int most) {
    at_once_in_a_row_ = now_.hi - last_event_ <= at_once * pace_ ? at_once_in_a_row_ + 1 : 0;
    last_event_ = now_.hi;
    return at_once_in_a_row_ > most;
}

void Engine::echo(double t, int generation) {
    if (generation > most_echoes) return;
    mechanics_.for_each_signal([&](const Signal& s) {
        for (const double by : s.delays()) {
            const std::pair<double, int> back{t + by, generation};
            echoes_.insert(std::lower_bound(echoes_.begin(), echoes_.end(), back), back);
        }
    });
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
    return {.t = now_.hi,
            .kind = kind,
            .theta = mechanics_.angle(joint, y_),
            .M = mechanics_.load(loaded, here()),
            .user = user,
            .where = where,
            .velocity = mechanics_.velocity(joint, y_)};
}

// ---- guards

void Engine::watch(Ending& ending) {
    std::fill(crept_.begin(), crept_.end(), 0);
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (mode_.holds(j) && mode_.rigid[j] == 0) watch_release(j, ending);
        if (rubs(j) && mode_.friction[j].way != Motion::stuck && !mode_.friction[j].riding) {
            watch_slip(j, ending);
            watch_corner(j, ending);
        }
        const auto& [walls, stops] = std::tie(problem_.system.joints[j].walls, problem_.system.joints[j].stops);
        if (walls && mode_.leans[j] == 0) watch_walls(j, *walls, By::wall, ending);
        if (stops) watch_stop(j, ending);
        if (mechanics_.has_normal(j) || (mechanics_.may_open(j) && !rubs(j))) watch_normal(j, ending);
        if (mechanics_.bristle(j) != nullptr) watch_bristles(j, ending);
    }
    for (std::size_t s = 0; s < mode_.sliders.size(); ++s) {
        // Where others hold its contact, what is left of the slip is rounding.
        if (!frame_->keeps(mechanics_.sliders()[s].joint)) watch_slider(s, ending);
    }
    watch_relays(ending);
    if (has_pieces_) watch_conditions(ending);
    watch_users(ending);
    if (ending.x > -1 && ending.x < 1 && segment_.time(ending.x) >= segment_.end) ending.x = 1;
}

void Engine::watch_slip(std::size_t joint, Ending& ending) {
    const Joint& own = problem_.system.joints[joint];
    const Slipping& how = mode_.friction[joint];
    const double sign = model::sign_of(how.way);
    const Nodes& belt = segment_.belts[joint];
    const bool leans = mode_.leans[joint] != 0;
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
    const double torques = torque_size(joint);
    for (const auto& [body, by] : own.of) {
        fastest += std::fabs(by) * greatest(segment_.y[n() + body]);
        inertia = std::min(inertia, problem_.system.bodies[body].inertia / (by * by));
    }
    // All that goes on in the stretch is slower than the rounding of its torques could make it, or leaves no trace in
    // the angle.
    const double drive = fastest * (own.damping + inertia / (2 * segment_.h)) / (rounding * torques);
    const bool no_way = fastest * 2 * segment_.h <= rounding / 2 * std::fabs(mechanics_.angle(joint, y_));
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
    Slipping& stays = mode_.friction[joint];
    stays.way = Motion::stuck, stays.leaving = false;
    stays.blunt = std::max(2 * stays.blunt, 64 * rounding * torques);
    if (too_often() || stays.blunt > most_blunt * torques) fail(Outcome::chattering);
}

/// It has no belt, and nothing asks for its motion: what it is under is known as well as the rounding.
bool Engine::may_creep(std::size_t joint) const {
    return mechanics_.all_linear() && !mechanics_.has_belt(joint) && mode_.leans[joint] == 0;
}

/// What was told to slip right now, and did not. Whether there was such an event.
bool Engine::take_back_slip(std::size_t joint) {
    auto told = std::find_if(result_.events.rbegin(), result_.events.rend(), [&](const Event& e) {
        return e.where == static_cast<int>(joint) && e.kind == EventKind::slip && e.t == now_.hi;
    });
    if (told == result_.events.rend()) return false;
    result_.events.erase(std::next(told).base());
    return true;
}

/// Where what holds a joint passes what it can hold.
void Engine::watch_release(std::size_t joint, Ending& ending) {
    Nodes pull{};
    for (std::size_t j = 0; j < node_count; ++j) pull[j] = -segment_.holding[joint][j];
    const Series series = cheb::fit(pull);
    const int wall = mode_.leans[joint];
    const double largest = torque_size(joint);
    for (const Motion side : {Motion::forward, Motion::backward}) {
        const double sign = model::sign_of(side);
        if (wall * sign > 0) continue;
        const bool sticks = rubs(joint) && mode_.friction[joint].way == Motion::stuck;
        Nodes limit{};
        if (mechanics_.limits_change(joint, mode_)) {
            limit = segment_.limits[joint][side == Motion::forward ? 1 : 0];
            if (!std::all_of(limit.begin(), limit.end(), [](double x) { return std::isfinite(x); })) {
                fail(Outcome::excitation_not_finite);
                return;
            }
        } else {
            limit.fill(sticks ? mechanics_.holding(joint, side, here()) : 0);
            if (std::isinf(limit[0])) continue;  // a freewheel, backward
        }
        if (const Slipping& how = mode_.friction[joint]; how.creeps != Motion::stuck) {
            const double level = mechanics_.sliding(joint, {.way = how.creeps}, 0, here());
            limit.fill(side == how.creeps ? how.apart + level : how.apart - level);
        }
        Nodes values{};
        const double blunt = mode_.friction[joint].blunt;
        for (std::size_t j = 0; j < node_count; ++j) values[j] = limit[j] - sign * pull[j] + blunt;
        const Series left = cheb::fit(values);
        cheb::Bounded<node_count> curve(1, left, cheb::derivative(left), values);
        const double doubt = 8 * (rounding * (greatest(limit) + largest) + cheb::tail(series) +
                                  (mechanics_.varies(joint) ? cheb::tail(cheb::fit(limit)) : 0)) +
                             solver_->blurred_by_belts(segment_) + (1 - known()) * greatest(pull);
        curve.raise_floor(doubt);
        const auto lets_go = [&](double x) {
            std::vector<double> y;
            segment_.state(x, y);
            const Moment at{segment_.time(x), x <= -1 ? segment_.side(0) : Side::at, y};
            Look found;
            if (!look(at, mode_, *frame_, found, x)) return false;
            Motion towards = Motion::stuck;
            return excess(joint, found, mode_, at, towards) > 0 && towards == side;
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
        const double begin = wall * gap(joint, place);
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
    const int pressed = mode_.presses[joint];
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
    const Slipping& how = mode_.friction[joint];
    if (law.ranges() < 2 || own.friction.function != nullptr || mode_.leans[joint] != 0) return;
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
    if (mechanics_.rubs(joint) && !rubs(joint)) {
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

/// A velocity that a contact holds, or that is about to leave 0, is exact: when that begins, conditions of it are
/// decided by what it is. Other decisions stay, for rounding would turn over what has just passed zero.
/// One that leaves is taken a little later: a condition may lose the first digits, as floor(10 + velocity) does.
void Engine::decide_conditions(const Moment& at, const Mode& mode) {
    if (!has_pieces_) return;
    constexpr double little_later = 1e-9;
    std::vector<double>& y = soon_;
    y.assign(at.y.begin(), at.y.end());
    std::uint64_t again = has_jumped_ ? ~std::uint64_t{0} : 0;
    standing_.resize(n());
    for (std::size_t i = 0; i < n(); ++i) {
        const Slipping& how = mode.friction[i];
        const bool leaves = mode.rubs[i] != 0 && how.leaving && mode.leans[i] == 0;
        const int now = leaves ? model::sign_of(how.way) > 0 ? 2 : 3 : mode.holds(i) || how.riding ? 1 : 0;
        const std::size_t bit = problem_.system.named ? n() + i : 1;
        if (now != 0 && now != standing_[i] && bit < 64) again |= std::uint64_t{1} << bit;
        standing_[i] = now;
        double& v = y[n() + i];
        if (leaves && std::fabs(v) <= std::numeric_limits<double>::min()) {
            const double speed = little_later * pace_ * torque_size(i) / problem_.system.bodies[i].inertia;
            v = model::sign_of(how.way) * std::max(std::numeric_limits<double>::min(), speed);
        }
    }
    mechanics_.let_laws_act(mode);
    mechanics_.for_each_piecewise(at.t, [&](Piecewise& function) { function.decide({at.t, at.side, y}, again); });
    has_jumped_ = false;
}

/// Where a condition of a function that was read changes.
void Engine::watch_conditions(Ending& ending) {
    const bool at_standstill = ending.by == By::slip || ending.by == By::release || ending.by == By::stays;
    const double before = ending.x - (at_standstill ? beside_standstill : 0);
    struct Crossing {
        double x;
        Piecewise* function;
        std::size_t condition;
        double within;
    };
    std::vector<Crossing> crossings;
    double earliest = std::min(1.0, before);
    std::vector<double> y, margins;
    struct Part {
        double first = -1, last = 1;
        [[nodiscard]] double place(double x) const { return first + (x + 1) * (last - first) / 2; }
    };
    const auto is_known = [](double v) { return std::isfinite(v); };
    // False if it has not a value everywhere in this part.
    const auto watch = [&](Piecewise& function, std::size_t c, Nodes values, double rounded, Part part) {
        const bool whole = part.first == -1 && part.last == 1;
        const auto exact = [&](double x) {
            const double at = whole ? x : part.place(x);
            segment_.state(at, y);
            function.margins({segment_.time(at), Side::at, y}, margins);
            return margins[c];
        };
        if (!whole) std::transform(cheb::nodes.begin(), cheb::nodes.end(), values.begin(), exact);
        if (!std::all_of(values.begin(), values.end(), is_known)) return false;
        // What M drives back may be on the wrong side already, by no more than rounding.
        const double within = 64 * rounding * greatest(values), beyond = std::max(within, 16 * rounded);
        const auto* const clear =
            std::find_if(values.begin(), values.end(), [beyond](double v) { return std::fabs(v) > beyond; });
        const bool is_back = values[0] < -rounded && clear != values.end() && *clear < 0;
        Half half = 1;
        auto x = is_back ? std::optional(-1.0) : Watched(values, exact, rounded).leaves(half, -1);
        if (x && !whole) x = part.place(*x);
        if (x && *x < before) {
            crossings.push_back({*x, &function, c, within});
            earliest = std::min(earliest, *x);
        }
        return true;
    };
    struct Unknown {
        Piecewise* function;
        std::size_t condition;
        Nodes values;
        double rounded;
    };
    std::vector<Unknown> not_finite;
    mechanics_.for_each_piecewise(now_.hi, [&](Piecewise& function) {
        const std::size_t count = function.conditions().size();
        if (count == 0) return;
        std::vector<Nodes> values(count);
        for (std::size_t j = 0; j < node_count; ++j) {
            function.margins(segment_.moment(j, y), margins);
            for (std::size_t c = 0; c < count; ++c) values[c][j] = margins[c];
        }
        // What some ulps of the motion change in them is rounding.
        std::vector<double> rounded(count, 0);
        y = y_;
        for (std::size_t k = 0; k < asking_.told; ++k) {
            y[k] = y_[k] * (1 + 4 * rounding);
            function.margins({segment_.times[0], segment_.side(0), y}, margins);
            for (std::size_t c = 0; c < count; ++c) {
                const double change = std::fabs(margins[c] - values[c][0]);
                if (is_known(change)) rounded[c] += change;
            }
            y[k] = y_[k];
        }
        // What has just been crossed is as near to zero as it was then, also in a stretch that is shorter.
        for (std::size_t c = 0; c < count && crossed_last_.function == &function && crossed_last_.t == now_.hi; ++c) {
            if (function.conditions()[c].step == crossed_last_.step)
                rounded[c] = std::max(rounded[c], crossed_last_.within);
        }
        for (std::size_t c = 0; c < count; ++c) {
            if (!watch(function, c, values[c], rounded[c], {})) {
                not_finite.push_back({&function, c, values[c], rounded[c]});
            }
        }
    });
    // The formula of a piece may have no value beyond its ends, as the square root of what was |theta|: such a
    // condition is watched between the ends of the piece by the others, or as far as it has a value.
    const double end_of_others = earliest;
    for (const Unknown& u : not_finite) {
        constexpr double within = 1e-12;
        const auto* const begin = u.values.begin() + (is_known(u.values[0]) ? 0 : 1);
        const auto* const bad = std::find_if_not(begin, u.values.end(), is_known);
        if (bad == begin) continue;
        const double first = begin == u.values.begin() ? -1 : -1 + within;
        const double known = cheb::nodes[static_cast<std::size_t>(bad - u.values.begin()) - 1];
        const double last = std::min(end_of_others - within, 1.0);
        if (!(last > first)) continue;
        if (watch(*u.function, u.condition, u.values, u.rounded, {first, last}) || known >= last) continue;
        watch(*u.function, u.condition, u.values, u.rounded, {first, known});
    }
    if (crossings.empty()) return;
    ending = {earliest, By::condition};
    crossed_within_ = 0;
    // Of a function the first step only: what follows from it, as |v| > 0 from the sign of v, may not change at all.
    std::vector<std::pair<Piecewise*, std::size_t>>& first = ending.conditions;
    for (const auto& [x, function, condition, within] : crossings) {
        if (x > earliest + one_instant) continue;
        crossed_within_ = std::max(crossed_within_, within);
        const auto same =
            std::find_if(first.begin(), first.end(), [f = function](const auto& c) { return c.first == f; });
        if (same == first.end()) {
            first.emplace_back(function, condition);
        } else {
            same->second = std::min(same->second, condition);
        }
    }
}

/// Something that is sampled may jump along with a condition, as a limit that two functions share: then the stretch is
/// made again, up to there.
bool Engine::ends_before(double x) {
    constexpr double beside_end = 1e-6;
    if (!samples_ || 1 + x < beside_end || 1 - x < beside_end) return false;
    const double t = segment_.time(x), nothing = 64 * rounding * std::fabs(t);
    if (t - now_.hi <= nothing || segment_.end - t <= nothing) return false;
    breaks_.insert(std::lower_bound(breaks_.begin(), breaks_.end(), t), t);
    crossing_at_ = t;
    return true;
}

/// Jumps that are next to nothing, one after the other, are digits that somebody has cut off: noise, and no events.
/// Then the conditions are let go, and M is sampled from there on; so it is beside a kink that rounding turns over.
bool Engine::cross(const Ending& ending) {
    constexpr double small = 1e-5, nothing = 1e-13;
    constexpr int most_small = 30, most_to_and_fro = 200;
    constexpr double soon = 1e-6;
    bool all_small = true, jumps = false;
    for (const auto& [function, condition] : ending.conditions) {
        const auto [step, beyond, of] = function->conditions()[condition];
        const bool back = crossed_last_.function == function && crossed_last_.step == step &&
                          crossed_last_.from == beyond && now_.hi - crossed_last_.t <= soon * pace_;
        to_and_fro_ = back ? to_and_fro_ + 1 : 0;
        crossed_last_ = {function, step, function->decision(step), now_.hi, crossed_within_};
        const double before = function->value(here());
        function->cross(condition);
        const double jump = std::fabs(function->value(here()) - before);
        greatest_crossed_ = std::max({greatest_crossed_, std::fabs(before), jump});
        const bool clear = jump > nothing * greatest_crossed_;
        jumps = jumps || clear;
        if (clear && !function->is_law()) ++result_.jumps;
        all_small = all_small && clear && jump < small * greatest_crossed_;
    }
    small_in_a_row_ = all_small ? small_in_a_row_ + 1 : 0;
    const bool endless = too_often() || to_and_fro_ >= most_to_and_fro;
    if (!endless && small_in_a_row_ < most_small) return true;
    if (endless && jumps) return fail(Outcome::chattering);
    mechanics_.for_each_piecewise(now_.hi, [](Piecewise& function) { function.let_go(); });
    has_pieces_ = false;
    return true;
}

double Engine::watched(std::size_t event, const Moment& at) const {
    return mechanics_.when(event, at);
}

/// Events of the user, if one of them comes before the end that is known so far.
void Engine::watch_users(Ending& ending) {
    const bool at_standstill = ending.by == By::slip || ending.by == By::release || ending.by == By::stays;
    const double before = ending.x - (at_standstill ? beside_standstill : 0);
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
    const bool told = !result_.events.empty() && result_.events.back().user >= 0 && result_.events.back().t == now_.hi;
    if (!told) tell_user(event);
    fail(Outcome::chattering);
}

bool Engine::rubs_somewhere(std::size_t body) const {
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (problem_.system.joints[j].is_on(body) && rubs(j)) return true;
    }
    return false;
}

/// Without dry friction nothing happens at a turn, it is only told.
void Engine::record_turns(double until) {
    const auto told = static_cast<std::ptrdiff_t>(result_.events.size());
    for (std::size_t i = 0; i < n(); ++i) {
        if (rubs_somewhere(i) || frame_->bodies[i].empty()) continue;
        const Nodes& v = segment_.y[n() + i];
        const double moving = greatest(v);
        const auto exact = [&](double x) { return segment_.at(n() + i, x); };
        const double torques = torque_size(i);
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
        Mode thrown = mode_;
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            if (!rubs(j)) continue;
            if (slip(j) != 0) thrown.friction[j].way = model::motion_of(slip(j));
            // Friction acts against the sliding: out and back again, or, on a belt, the same way all the time.
            const bool turns = j == joint && mechanics_.belt(j, now_.hi, side()) == 0;
            if (turns) thrown.friction[j].way = (wall > 0) == out ? Motion::backward : Motion::forward;
        }
        Look found;
        if (!look(here(), thrown, Frame(problem_.system, thrown), found)) return -model::never;
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
    put_child(joint, own.first(), own.of.front().by, place);
    origin_[joint] = place, reach_[joint] = 0;
    const double before = std::max(0.0, wall * mechanics_.velocity(joint, y_));
    at_wall_[joint] = 1;
    const auto stands = [&] {
        if (mode_.leans[joint] != wall || leaned_[joint] != 0) return;
        tell(EventKind::stick, static_cast<int>(joint));
        leaned_[joint] = 1;
    };
    if (stayed && before == 0) {
        mode_.leans[joint] = wall;
        Slipping& how = mode_.friction[joint];
        how.leaving = false;
        how.blunt = std::max(2 * how.blunt, 64 * rounding * torque_size(joint));  // it went, and did not get away
        if (!decide(true)) return false;
        stands();
        return !too_often() || fail(Outcome::chattering);
    }
    tell(EventKind::impact, static_cast<int>(joint));
    const Thrown thrown = thrown_along(joint);
    const auto velocity = [&](double relative) { throw_to(thrown, relative); };
    velocity(-wall * e * before);
    has_jumped_ = true;
    bool rests = e * before == 0;
    double rest = 0;
    if (!rests) {
        const auto bounces = next_bounces(joint, wall, e * before);
        if (!bounces) return fail(Outcome::excitation_not_finite);
        // Without a spring the run so far tells what is short: not its end, so that one may stop anywhere and go on.
        const double pace = std::min(period_, now_.hi - born_);
        rests = bounces->all <= last_bounces * pace || bounces->once <= shortest_bounce * pace;
        rest = bounces->all < model::never ? bounces->all : bounces->once;
    }
    const double after = rests ? 0 : e * before;
    history_->add_jump(now_.hi, joint, {.impacts = (before - after) * (before + after) / thrown.lightness / 2});
    echo(now_.hi, 1);
    for (std::size_t i = 0; i < n(); ++i) {
        if (thrown.velocities[i].second != 0) heading_[i] = model::motion_of(rests ? 0 : y_[n() + i]);
    }
    if (rests) {
        velocity(0);
        has_jumped_ = true;
        if (rest > 0 && now_.after(rest) < std::min(mechanics_.next_break(now_.hi), problem_.window.end)) {
            std::vector<double> rates(mechanics_.states());
            mechanics_.rates(here(), rates.data(), &mode_);
            for (std::size_t k = 0; k < rates.size(); ++k) y_[2 * n() + k] += rest * rates[k];
            now_ = now_.later(rest);
        }
        mode_.leans[joint] = wall;
        if (rubs(joint)) {
            Slipping& how = mode_.friction[joint];
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
        const double v = mechanics_.velocity(j, y_);
        if (mode_.leans[j] == 0 || v == 0) continue;
        if (leaned_[j] != 0 && mode_.leans[j] * v < 0) tell(EventKind::slip, static_cast<int>(j));
        mode_.leans[j] = 0, leaned_[j] = 0, at_wall_[j] = 1;
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
        const std::vector<double> before = y_;
        std::vector<double> values;
        for (std::size_t e = 0; e < watches_.size(); ++e) values.push_back(watched(e, here()));
        model::State state{y_[0], y_[n()]};
        const bool named = problem_.system.named;
        const std::span<double> all(y_);
        const std::span<double> given = all.first(asking_.told);
        mechanics_.call_unread(here(), mode_);
        if (!wanted.act->act(now_.hi, state, named ? given : given.subspan(2 * n()))) {
            return fail(Outcome::excitation_not_finite);
        }
        if (!named) y_[0] = state.theta, y_[1] = state.velocity;
        keep_within_walls(y_);
        has_jumped_ = true;
        if (y_ != before) low_.assign(n(), 0);  // what the user was given is what he goes on from
        keep_rigid_places();
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            const double work = energy_at(j, y_) - energy_at(j, before);
            if (work != 0 || j == 0) history_->add_jump(now_.hi, j, {.acts = work});
        }
        echo(now_.hi, 1);
        const bool moved = !std::equal(y_.begin(), y_.begin() + static_cast<std::ptrdiff_t>(2 * n()), before.begin());
        if (moved) {
            std::fill(mode_.leans.begin(), mode_.leans.end(), 0);
            for (std::size_t i = 0; i < n(); ++i) heading_[i] = model::motion_of(y_[n() + i]);
            touch_walls();
            if (!restart_contacts(Because::act)) return false;
            see_flight();
        }
        stand_where_put(values, y_ != before ? told : std::vector<std::size_t>());
        if (moved && watches_[event].fading.after(now_.hi) && !wanted.stop) return fail(Outcome::chattering);
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
        const double q = mechanics_.angle(j, y_), v = mechanics_.velocity(j, y_);
        int side = 0;
        for (const int wall : {1, -1}) {
            if (!std::isfinite(stops->at(wall))) continue;
            const double nothing = 64 * rounding * std::fabs(stops->at(wall));
            const double depth = wall * (q - stops->at(wall)), torque = wall * stops->torque(wall, q, v);
            const bool before = mode_.presses[j] == wall;
            const double least = before ? -nothing : nothing;
            if (depth > least && torque > least * stops->stiffness) side = wall;
        }
        if (side == mode_.presses[j]) continue;
        changed = true;
        if (begun()) {
            press(j, side);
        } else {
            mode_.presses[j] = side;
        }
    }
    return changed;
}

/// What an elastic wall stores when it is left is lost.
void Engine::press(std::size_t joint, int side) {
    const model::Walls& stops = *problem_.system.joints[joint].stops;
    const int wall = side != 0 ? side : mode_.presses[joint];
    const double depth = mechanics_.angle(joint, y_) - stops.at(wall);
    const double stored = (side != 0 ? -1 : 1) * stops.stiffness * depth * depth / 2;
    history_->add_jump(now_.hi, joint, {.impacts = stored, .kept = -stored});
    mode_.presses[joint] = side;
    has_jumped_ = true;
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
    if (mode_.sliders[slider] != Motion::stuck) {
        const double sign = model::sign_of(mode_.sliders[slider]);
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
    mode_.sliders[slider] = way;
    if (way != Motion::stuck) y_[own.bend] = model::sign_of(way) * own.limit / own.stiffness;
    tell(way == Motion::stuck ? EventKind::slider_sticks : EventKind::slider_slips, static_cast<int>(own.joint));
}

/// After velocities have jumped: sliders whose slip has turned stick.
bool Engine::turn_sliders() {
    bool turned = false;
    for (std::size_t s = 0; s < mode_.sliders.size(); ++s) {
        const double way = model::sign_of(mode_.sliders[s]);
        const std::size_t joint = mechanics_.sliders()[s].joint;
        if (!(way * slip(joint) < -16 * rounding * mechanics_.speed_scale(joint, y_))) continue;
        let_slide(s, Motion::stuck);
        turned = true;
    }
    return turned;
}

Engine::Thrown Engine::thrown_along(std::size_t joint) {
    if (!rigid_) {
        Mode free = mode_;
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) free.leans[j] = 0, free.rubs[j] = 0;
        rigid_.emplace(problem_.system, free);
    }
    Thrown thrown;
    for (const auto& [group, by] : rigid_->joints[joint]) thrown.lightness += by * by / rigid_->inertia[group];
    const double speed = mechanics_.velocity(joint, y_);
    for (std::size_t i = 0; i < n(); ++i) {
        double share = 0;
        for (const auto& [group, by] : rigid_->bodies[i]) {
            for (const auto& [own_group, turned] : rigid_->joints[joint]) {
                if (own_group == group) share += by * turned / rigid_->inertia[group] / thrown.lightness;
            }
        }
        thrown.velocities.emplace_back(y_[n() + i] - share * speed, share);
    }
    return thrown;
}

void Engine::throw_to(const Thrown& thrown, double relative) {
    for (std::size_t i = 0; i < n(); ++i) {
        const auto& [still, share] = thrown.velocities[i];
        if (share != 0) y_[n() + i] = still + share * relative;
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
            const bool one_way = problem_.system.joints[j].friction.law.is_one_way() && rubs(j);
            if (!one_way && mode_.leans[j] == 0) continue;
            const double v = one_way ? slip(j) : -mode_.leans[j] * mechanics_.velocity(j, y_);
            if (v < -16 * rounding * mechanics_.speed_scale(j, y_) && v < least) worst = j, least = v;
        }
        if (worst == mechanics_.joints()) return;
        const Thrown thrown = thrown_along(worst);
        if (!(thrown.lightness > 0)) return;
        const double before = mechanics_.velocity(worst, y_);
        const double after = mode_.leans[worst] != 0 ? 0 : mechanics_.belt(worst, now_.hi, side());
        throw_to(thrown, after);
        history_->add_jump(now_.hi, worst, {.impacts = (before - after) * (before + after) / thrown.lightness / 2});
    }
}

/// What stands at a wall, and does not move away from it, leans there.
void Engine::touch_walls() {
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const Joint& joint = problem_.system.joints[j];
        if (!joint.walls) continue;
        for (const int wall : {1, -1}) {
            if (mechanics_.angle(j, y_) != joint.walls->at(wall)) continue;
            at_wall_[j] = 1;
            if (mechanics_.velocity(j, y_) == 0) mode_.leans[j] = wall;
        }
    }
}

/// A body that was thrown, and is soon back, is to be seen on its way.
void Engine::see_flight() {
    if (!look({now_.hi, side(), departing()}, mode_, frame(), look_)) return;
    for (std::size_t i = 0; i < n(); ++i) {
        const double v = y_[n() + i], a = look_.accelerations[i];
        if (!(v * a < 0) || !(std::fabs(v) < std::fabs(a) * longest_)) continue;
        h_ = std::min(h_, std::max(1.2 * std::fabs(v / a), 1e-9 * pace_));
    }
}

/// How far a watched value goes when what it is made of changes by some ulps.
double Engine::rounding_of(std::size_t event) const {
    constexpr double ulps = 1 + 4 * rounding;
    std::vector<double> y = y_;
    const double own = watched(event, {now_.hi, side(), y});
    double most = 0;
    for (std::size_t k = 0; k < 2 * n(); ++k) {
        y[k] = y_[k] * ulps;
        most = std::max(most, std::fabs(watched(event, {now_.hi, side(), y}) - own));
        y[k] = y_[k];
    }
    return most;
}

/// Whether a value at zero goes on to the side to which it has come, now that the user has acted, as it does at once;
/// else he threw it back, or stopped it.
bool Engine::passes_on(std::size_t event) {
    constexpr double soon = 1e-4;
    const double step = soon * h_;
    if (!look({now_.hi, side(), departing()}, mode_, frame(), look_)) return true;
    std::vector<double> rates(mechanics_.states()), y = y_;
    mechanics_.rates(here(), rates.data(), &mode_);
    const auto value = [&](double after) {
        for (std::size_t i = 0; i < n(); ++i) {
            y[i] = y_[i] + after * y_[n() + i];
            y[n() + i] = y_[n() + i] + after * look_.accelerations[i];
        }
        for (std::size_t k = 0; k < rates.size(); ++k) y[2 * n() + k] = y_[2 * n() + k] + after * rates[k];
        return watched(event, {now_.hi + after, Side::at, y});
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
        const double now = watched(e, here());
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
    y = y_;
    if (x > -1) segment_.state(x, y);
    keep_within_walls(y);
    const Moment at{t, x <= -1 ? side() : Side::at, y};
    bool needs_look = !problem_.joined_elsewhere;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) needs_look = needs_look || mode_.holds(j);
    const auto place = x > -1 ? std::optional(x) : std::nullopt;
    if (needs_look && !look(at, mode_, frame(), look_, place, Loads::sampled)) return false;
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
        double torque = -mechanics_.joint_torque(j, at, mode_, belt);
        if (!mechanics_.loads()[j].none()) torque += mechanics_.load(j, at);
        if (mode_.holds(j)) torque += look_.holding[j];
        const bool kept = mode_.rigid[j] != 0;  // to the letter
        good = put(kept ? rigid_at_[j] : mechanics_.angle(j, y)) && good;
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
    if (rubs(joint) && mode_.friction[joint].way == Motion::stuck) {
        const double held = look.holding[joint] - mechanics_.slider_torque(joint, at.y);
        return mode_.leans[joint] != 0 && mode_.leans[joint] * held <= 0 ? 0.0 : held;
    }
    return mechanics_.friction(joint, at, mode_, mechanics_.belt(joint, at.t, at.side));
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
