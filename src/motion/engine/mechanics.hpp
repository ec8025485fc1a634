// The torques on each body of a system, the modes of its contacts, and what these decide where nothing slips.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "model/system.hpp"
#include "motion/belt_slope.hpp"
#include "motion/engine/signal.hpp"
#include "motion/simulate.hpp"

namespace dinal::motion::engine {

constexpr std::size_t index(int place) {
    return static_cast<std::size_t>(place);
}

/// The rounding of a run: that of the torques on each body, and behind them that of the rate of each state.
struct Floor {
    std::vector<double> noise;     ///< how rough it was found to be
    std::vector<double> greatest;  ///< so far; no more than a small part of it is taken for noise
};

/// How the friction of a joint acts.
struct Slipping {
    model::Motion way = model::Motion::stuck;
    bool leaving = false;   ///< at slip 0, and about to leave it
    bool riding = false;    ///< at slip 0 because others hold, while this one gives all that it can
    std::size_t range = 0;  ///< of its law, while it slides
    double blunt = 0;       ///< what the pull must pass its limit by, after it was let go and did not leave
    /// Which way it creeps, slower than rounding; stuck: it does not. While it creeps `way` is stuck, and the joint
    /// holds as long as its pull stays within `apart` of what the friction of sliding balances.
    model::Motion creeps = model::Motion::stuck;
    double apart = 0;
};

struct Mode {
    std::vector<Slipping> friction;  ///< of each joint
    std::vector<int> leans;          ///< of each joint: 1 at its upper wall, -1 at its lower one, else 0

    [[nodiscard]] bool holds(std::size_t joint) const {
        return keeps_place(joint) || (friction[joint].way == model::Motion::stuck && rubs[joint]);
    }
    /// Returns whether the joint holds an angle, not only a velocity.
    [[nodiscard]] bool keeps_place(std::size_t joint) const { return leans[joint] != 0 || rigid[joint] != 0; }
    std::vector<char> rubs;                   ///< of each joint: it has dry friction, and something presses on it
    std::vector<char> rigid;                  ///< of each joint: it holds for ever
    std::vector<model::Motion> sliders = {};  ///< of each slider: which way it slides
    std::vector<int> presses;  ///< of each joint: 1 on its upper elastic wall, -1 on its lower one, else 0
};

/// The ways in which bodies can move while the joints that hold in a mode hold. A group is such a way: its bodies move
/// in fixed proportions. A body may take part in several groups, as in a planetary gear; these are orthogonal with
/// respect to the inertias, so that each group has an acceleration of its own.
struct Frame {
    struct Share {
        std::size_t group;
        double by;
        bool operator==(const Share&) const = default;
    };
    using Shape = std::vector<Share>;  ///< how the groups move a body, or turn a joint; empty: not at all
    struct Edge {
        std::size_t joint, child;  ///< the body whose motion the joint ties to that of its others
        double by;                 ///< the weight of the child
    };
    Frame(const model::System& system, const Mode& mode);

    std::vector<Shape> bodies, joints;
    std::vector<double> inertia;          ///< of each group
    std::vector<Edge> edges;              ///< each after those whose children its others are
    std::vector<std::size_t> closing;     ///< joints that hold, and close loops
    std::vector<std::size_t> redundant;   ///< those of them that follow from the others
    Eigen::MatrixXd sharing;              ///< with loops: what each joint that holds takes of the torques on bodies
    std::vector<std::size_t> sharing_of;  ///< its rows

    [[nodiscard]] std::size_t groups() const { return inertia.size(); }
    /// Returns whether the joints that hold keep the angle of this one.
    [[nodiscard]] bool keeps(std::size_t joint) const { return joints[joint].empty(); }
    /// Of each body, what it has more than its group, from what each joint has: the velocities of belts.
    void offsets(const std::vector<double>& of_joints, const Mode& mode, std::vector<double>& of_bodies) const;
    /// What each joint that holds takes: the torque on its angle. From what each body lacks, I a - torque.
    void multipliers(const std::vector<double>& lacking, std::vector<double>& of_joints) const;

private:
    void go_along(const std::vector<double>& of_joints, const Mode& mode, std::vector<double>& of_bodies) const;
    void close_loops(Eigen::MatrixXd rows);
    void separate(const model::System& system);

    const model::System* system_;
    Eigen::MatrixXd anchor_;          ///< what leads have more, by what loops lack that stop one way to move
    std::vector<std::size_t> leads_;  ///< the first body of each way to move, before loops were closed
};

/// Returns the rigid links that other rigid links make redundant.
std::vector<std::size_t> redundant_rigid(const model::System& system);

/// The least of x G x / 2 + g x within a box; G is symmetric, and not singular.
Eigen::VectorXd least_in_box(const Eigen::MatrixXd& G, const Eigen::VectorXd& g, const Eigen::VectorXd& low,
                             const Eigen::VectorXd& high);

class Mechanics {
public:
    Mechanics(const model::System& system, const model::Drive& drive, const Asking& asking);
    Mechanics(const Mechanics&) = delete;
    Mechanics& operator=(const Mechanics&) = delete;
    ~Mechanics() = default;

    [[nodiscard]] const model::System& system() const { return system_; }
    [[nodiscard]] std::size_t bodies() const { return system_.bodies.size(); }
    [[nodiscard]] std::size_t joints() const { return system_.joints.size(); }
    /// Those of the user's, and behind them the bend of each joint's bristles, and of the spring of each slider.
    [[nodiscard]] std::size_t states() const { return drive_.states.size() + bristles_.size() + sliders_.size(); }
    [[nodiscard]] std::size_t states_of_user() const { return drive_.states.size(); }
    [[nodiscard]] std::size_t events() const { return drive_.events.size(); }
    /// The bristles of a joint; null where it has none.
    [[nodiscard]] const model::laws::Bristle* bristle(std::size_t joint) const { return contacts_[joint].bristle; }
    /// The joints with bristles.
    [[nodiscard]] const std::vector<std::size_t>& bristles() const { return bristles_; }
    /// A Jenkins element: a dry slider behind a spring.
    struct Slider {
        std::size_t joint, bend;  ///< where its bend stands in the state
        double stiffness, limit;
    };
    [[nodiscard]] const std::vector<Slider>& sliders() const { return sliders_; }
    /// The torque of its sliders' springs on a joint.
    [[nodiscard]] double slider_torque(std::size_t joint, std::span<const double> y) const {
        double torque = 0;
        for (const Slider& slider : sliders_) {
            if (slider.joint == joint) torque += slider.stiffness * y[slider.bend];
        }
        return torque;
    }
    /// The torque of its bristles on a joint; 0 where it has none.
    [[nodiscard]] double bristle_torque(std::size_t joint, const Moment& at, double belt) const;
    /// The inertia of a body; 0 where a body that is moved has none.
    [[nodiscard]] double own_inertia(std::size_t body) const {
        const auto& moved = system_.bodies[body].moved;
        return moved && moved->without_inertia ? 0 : system_.bodies[body].inertia;
    }
    [[nodiscard]] std::size_t size() const { return 2 * bodies() + states(); }
    /// Torques or rates depend on the motion otherwise than by constants.
    [[nodiscard]] bool nonlinear() const { return nonlinear_; }
    /// It has a law of friction that is ours, and nothing else of it changes.
    [[nodiscard]] bool is_native(std::size_t joint) const { return contacts_[joint].native; }
    /// The torques of all joints are sums of terms in angle and velocity, and of a friction that only its way changes,
    /// and nothing else asks for the motion.
    [[nodiscard]] bool all_linear() const { return all_linear_; }
    [[nodiscard]] bool rubs(std::size_t joint) const { return rubs_[joint] != 0; }
    [[nodiscard]] const std::vector<char>& rubbing() const { return rubs_; }
    [[nodiscard]] bool has_belts() const { return has_belts_; }
    [[nodiscard]] bool has_belt(std::size_t joint) const { return !belts_[joint].none(); }
    [[nodiscard]] double belt(std::size_t joint, double t, Side side) const;
    /// How fast that changes, from the right; it is differentiated within this part of time.
    [[nodiscard]] BeltSlope belt_slope(std::size_t joint, double t, double stretch) const {
        return belts_[joint].none() ? BeltSlope{0, 0} : motion::belt_slope(drive_.belts[joint], t, stretch);
    }
    [[nodiscard]] double base(double t, Side side) const { return base_.value({t, side, {}}); }
    [[nodiscard]] bool has_base() const { return !base_.none(); }
    /// What friction does to its first body where it does not hold.
    [[nodiscard]] double friction(std::size_t joint, const Moment& at, const Mode& mode, double belt) const;
    /// At this time somebody found a jump that nobody announced.
    void jumps_at(double t) { jumps_.insert(std::upper_bound(jumps_.begin(), jumps_.end(), t), t); }
    /// Jumps before this time are behind.
    void forget_jumps(double t) { jumps_.erase(jumps_.begin(), std::lower_bound(jumps_.begin(), jumps_.end(), t)); }

    /// The loads that depend on the time alone, of each joint, the push of the base among them. Those that somebody
    /// knows are not asked for.
    template <class Known>
    void loads_of_time(double t, Side side, std::vector<double>& loads, const Known& known) const {
        const double push = base(t, side);
        loads.resize(joints());
        for (std::size_t i = 0; i < loads.size(); ++i) {
            const std::optional<double> load = known(i);
            loads[i] = load ? *load : loads_[i].of_time({t, side, {}});
            if (has_base() && i < bodies()) loads[i] -= system_.bodies[i].inertia * push;
        }
    }
    void loads_of_time(double t, Side side, std::vector<double>& loads) const {
        loads_of_time(t, side, loads, [](std::size_t) { return std::optional<double>(); });
    }
    void sample_loads(const NodeTimes& when, std::vector<Nodes>& loads) const;
    /// M of each body or link.
    [[nodiscard]] double load(std::size_t joint, const Moment& at) const { return loads_[joint].value(at); }
    /// All torques on each body but those of what holds; `belts` are the velocities of each joint's. What of the loads
    /// depends on the motion is added to them.
    void torques(const Moment& at, const Mode& mode, const std::vector<double>& belts, std::vector<double>& loads,
                 std::vector<double>& of_bodies) const;
    /// Those of sliders need the mode.
    void rates(const Moment& at, double* out, const Mode* mode = nullptr) const;
    /// Of each joint, without what holds.
    [[nodiscard]] double joint_torque(std::size_t joint, const Moment& at, const Mode& mode, double belt) const;
    /// The same at nodes, of a native joint that does not lean, with these angles and velocities of bodies (and states)
    /// and this velocity of its belt.
    void native_torques(std::size_t joint, const Mode& mode, const std::vector<Nodes>& y, const Nodes& belt,
                        std::size_t first, std::size_t end, Nodes& out) const;
    /// Adds the part of native_torques() that is friction.
    void add_native_friction(std::size_t joint, const Mode& mode, const Nodes& slip, std::size_t first, std::size_t end,
                             Nodes& out) const;
    /// What friction takes while it slides, without sign.
    [[nodiscard]] double sliding(std::size_t joint, const Slipping& how, double slip, const Moment& at) const;
    [[nodiscard]] std::size_t range_of(std::size_t joint, double speed) const;
    /// What sticking holds at most against a pull this way.
    [[nodiscard]] double holding(std::size_t joint, model::Motion way, const Moment& at) const;
    /// The limit of holding depends on more than the way.
    [[nodiscard]] bool varies(std::size_t joint) const { return contacts_[joint].varies; }
    /// The joint sticks, and its limits may change along a stretch.
    [[nodiscard]] bool limits_change(std::size_t joint, const Mode& mode) const {
        return varies(joint) && mode.rubs[joint] != 0 && mode.friction[joint].way == model::Motion::stuck;
    }
    [[nodiscard]] bool has_normal(std::size_t joint) const { return !contacts_[joint].normal.none(); }
    /// The contact may be open for a while: its normal load, or all of its limits, change.
    [[nodiscard]] bool may_open(std::size_t joint) const { return rubs(joint) && contacts_[joint].may_open; }
    /// The normal load of a contact, or else the greatest of its limits. The contact is open while this is 0 or less.
    [[nodiscard]] double pressing(std::size_t joint, const Moment& at) const;
    /// The function of an event of the user.
    [[nodiscard]] double when(std::size_t event, const Moment& at) const { return whens_[event].value(at); }
    /// How great torques are at a joint: of its springs and its friction.
    [[nodiscard]] double size_of(std::size_t joint, const Moment& at) const;

    /// The weighted sum of what the bodies of a joint have, at nodes or as a series.
    [[nodiscard]] Nodes between(std::size_t joint, std::span<const Nodes> of_bodies) const {
        const auto& of = system_.joints[joint].of;
        Nodes sum = of_bodies[of[0].body];
        if (of[0].by != 1) std::for_each(sum.begin(), sum.end(), [by = of[0].by](double& x) { x *= by; });
        for (std::size_t k = 1; k < of.size(); ++k) add(sum, of_bodies[of[k].body], of[k].by);
        return sum;
    }
    /// How fast a joint slips on its belt, at nodes.
    [[nodiscard]] Nodes slips(std::size_t joint, const std::vector<Nodes>& y, const Nodes& belt) const {
        return difference(between(joint, std::span(y).subspan(bodies())), belt);
    }
    [[nodiscard]] double angle(std::size_t joint, std::span<const double> y) const;
    [[nodiscard]] double velocity(std::size_t joint, std::span<const double> y) const;
    /// Returns how great the velocities are of whose sum a joint's is made; it is known no better than their rounding.
    [[nodiscard]] double speed_scale(std::size_t joint, std::span<const double> y) const;

    [[nodiscard]] double next_break(double t) const;
    [[nodiscard]] double view(double t, double spacing) const;
    [[nodiscard]] bool may_go_on() const;
    void forget_failure() const;
    [[nodiscard]] bool asks_functions() const;
    /// There is any function of the user's.
    [[nodiscard]] bool has_functions() const;
    /// The greatest natural frequency of a linear system with these groups, rad per time unit; 0 without springs.
    [[nodiscard]] double fastest(const Frame& frame) const;

    /// Signals of all kinds, for what must be told to each, or asked of each.
    template <class F>
    void for_each_signal(F f) {
        for (Signal* s : signals_) f(*s);
    }
    template <class F>
    void for_each_signal(F f) const {
        for (const Signal* s : signals_) f(*s);
    }
    /// The user's functions of the motion that are held to pieces at this time.
    template <class F>
    void for_each_piecewise(double t, F f) {
        for_each_signal([&](Signal& s) { s.for_each_piecewise(t, f); });
        for (Piecewise& rate : rates_) {
            if (rate.has_pieces()) f(rate);
        }
        for (Contact& contact : contacts_) {
            if (contact.law && contact.law->has_pieces()) f(*contact.law);
            if (contact.spring) f(*contact.spring);
        }
        for (Piecewise& when : whens_) {
            if (when.has_pieces()) f(when);
        }
    }
    /// From now on users' laws of friction act as the mode says.
    void let_laws_act(const Mode& mode) {
        for (std::size_t j = 0; j < contacts_.size(); ++j) {
            const Slipping& how = mode.friction[j];
            if (contacts_[j].law) contacts_[j].law->act(how.riding ? 0 : model::sign_of(how.way));
        }
    }
    /// One of them has no pieces that are known.
    [[nodiscard]] bool samples_the_motion() const {
        bool samples = std::any_of(rates_.begin(), rates_.end(), [](const Piecewise& r) { return !r.has_pieces(); });
        for_each_signal([&](const Signal& s) { samples = samples || s.samples_the_motion(); });
        return samples;
    }
    /// Calls every function that is not read: variables that several functions share are of this moment then, as what
    /// is called once, in order, expects.
    void call_unread(const Moment& at, const Mode& mode) const;
    /// A user's function, and the piece that it is held to: for those who look at what is read.
    struct Asked {
        model::UserFunction* function = nullptr;
        const model::terms::Piece* piece = nullptr;
    };
    [[nodiscard]] Asked asked_rate(std::size_t k) const { return {drive_.states[k].rate.get(), rates_[k].piece()}; }
    [[nodiscard]] Asked asked_when(std::size_t event) const {
        return {drive_.events[event].when.get(), whens_[event].piece()};
    }
    [[nodiscard]] Asked asked_spring(std::size_t joint) const;
    [[nodiscard]] Asked asked_law(std::size_t joint) const;
    [[nodiscard]] const Signal& base_signal() const { return base_; }
    [[nodiscard]] const Signal& belt_signal(std::size_t joint) const { return belts_[joint]; }
    /// Calls it with what limits or drives the friction of a joint in a mode, and what torque one unit of it makes.
    template <class F>
    void for_each_friction(std::size_t joint, const Mode& mode, const Moment& at, F f) const {
        const Contact& c = contacts_[joint];
        if (c.native && c.normal.none()) return;
        const Slipping& how = mode.friction[joint];
        const double pressed = c.normal.none() ? 1 : std::fabs(c.normal.value(at));
        const std::size_t way = how.way == model::Motion::forward ? 1 : 0;
        const bool slides = how.way != model::Motion::stuck && !how.riding;
        for (const std::size_t side : {0U, 1U}) {
            if (slides && side != way) continue;
            f(slides || c.holding[side].none() ? c.sliding[side] : c.holding[side], pressed > 0 ? pressed : 1);
        }
        if (c.normal.none() || !rubs(joint)) return;
        const double torque =
            std::fabs(slides ? sliding(joint, how, velocity(joint, at.y), at) : holding(joint, how.way, at));
        f(c.normal, pressed > 0 ? torque / pressed : 1);
    }
    [[nodiscard]] std::vector<Signal>& loads() { return loads_; }
    [[nodiscard]] const std::vector<Signal>& loads() const { return loads_; }

private:
    struct Contact {
        std::array<Signal, 2> sliding, holding;
        Signal normal;
        const model::laws::Bristle* bristle = nullptr;
        std::optional<Piecewise> law = {};     ///< the user's function
        std::optional<Piecewise> spring = {};  ///< the user's, if it has conditions
        bool varies = false, native = false, may_open = false;
    };

    [[nodiscard]] double spring_torque(std::size_t joint, double angle) const;
    [[nodiscard]] double law_friction(std::size_t joint, const Moment& at, const Mode& mode, double belt) const;
    /// Calls it with each function of the user's.
    void each_function(const std::function<void(model::UserFunction&)>& call) const;

    const model::System& system_;
    const model::Drive& drive_;
    std::vector<Signal> loads_, belts_;
    Signal base_;
    std::vector<Contact> contacts_;
    std::vector<Signal*> signals_;  ///< all that are there
    std::vector<char> rubs_;
    std::vector<std::size_t> bristles_;
    std::vector<Slider> sliders_;
    std::vector<Piecewise> rates_;  ///< of the states of the user
    std::vector<Piecewise> whens_;  ///< of the events of the user
    std::vector<double> jumps_;     ///< found, of belts
    bool nonlinear_ = false, all_linear_ = true, has_belts_ = false;
};

}  // namespace dinal::motion::engine
