// Torques on the bodies of a system, and the modes of its contacts.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "model/system.hpp"
#include "motion/belt_slope.hpp"
#include "motion/engine/signal.hpp"
#include "motion/simulate.hpp"
#include "text/not_copied.hpp"

namespace dinal::motion::engine {

constexpr std::size_t index(int place) {
    return static_cast<std::size_t>(place);
}

/// The noise level of a run: of the torque on each body, followed by the rate of each state.
struct Floor {
    std::vector<double> noise;     ///< detected roughness
    std::vector<double> greatest;  ///< greatest value so far; only a small part of it is accepted as noise
    /// Returns the greatest noise of the torques on the n bodies.
    double noise_of_torques(std::size_t n) const {
        return *std::max_element(noise.begin(), noise.begin() + static_cast<std::ptrdiff_t>(n));
    }
};

/// The friction state of a joint.
struct Slipping {
    model::Motion way = model::Motion::stuck;
    bool leaving = false;   ///< at slip 0, about to slip
    bool riding = false;    ///< at slip 0 because other joints hold; its friction is at the limit
    std::size_t range = 0;  ///< speed range of its law while it slides
    double margin = 0;      ///< excess over the limit needed for the next release, after a release without motion
    /// The slip for which loads are evaluated on both sides, if loads that jump at slip 0 drive the joint back from
    /// both; otherwise 0. The limit of each direction then applies to the loads at this slip in that direction.
    double beside = 0;
    /// Whether the loads at slip 0 would release the joint, so that it leaves when the loads of one side overcome
    /// sliding friction.
    bool driven_back = false;
    /// The direction of a creep, a slip slower than rounding, or `stuck`. During a creep `way` is stuck, and the joint
    /// holds while its pull stays within `apart` of its balance with sliding friction.
    model::Motion creeps = model::Motion::stuck;
    double apart = 0;
};

struct Mode {
    std::vector<Slipping> friction;  ///< friction state of each joint
    std::vector<int> leans;          ///< each joint: 1 at its upper wall, -1 at its lower one, otherwise 0

    bool holds(std::size_t joint) const {
        return keeps_place(joint) || (friction[joint].way == model::Motion::stuck && rubs[joint]);
    }
    /// Returns whether the joint holds its angle, not only its velocity.
    bool keeps_place(std::size_t joint) const { return leans[joint] != 0 || rigid[joint] != 0; }
    std::vector<char> rubs;                   ///< each joint: whether it has dry friction and is pressed together
    std::vector<char> rigid;                  ///< each joint: whether it is rigid
    std::vector<model::Motion> sliders = {};  ///< direction of sliding of each slider
    std::vector<int> presses;  ///< each joint: 1 on its upper elastic wall, -1 on its lower one, otherwise 0
};

/// The degrees of freedom of the bodies in a mode. A group is one degree of freedom: its bodies move in fixed
/// proportions. A body may belong to several groups, as in a planetary gear; groups are orthogonal with respect to
/// inertia, so that each has its own acceleration.
struct Frame {
    struct Share {
        std::size_t group;
        double by;
        bool operator==(const Share&) const = default;
    };
    using Shape = std::vector<Share>;  ///< share of each group in the motion of a body or joint; empty: no motion
    struct Edge {
        std::size_t joint, child;  ///< the body tied to the other bodies of the joint
        double by;                 ///< the weight of the child
    };
    Frame(const model::System& system, const Mode& mode);

    std::vector<Shape> bodies, joints;
    std::vector<double> inertia;          ///< inertia of each group
    std::vector<Edge> edges;              ///< ordered: the other bodies of an edge come first
    std::vector<std::size_t> closing;     ///< holding joints that close loops
    std::vector<std::size_t> redundant;   ///< those of `closing` that are linearly dependent
    Eigen::MatrixXd sharing;              ///< with loops: share of each holding joint in the torques on bodies
    std::vector<std::size_t> sharing_of;  ///< joints of the rows of `sharing`
    double longest = model::never;        ///< longest stretch that resolves the vibrations of its groups, time units

    std::size_t groups() const { return inertia.size(); }
    /// Returns whether the holding joints fix the angle of this one.
    bool keeps(std::size_t joint) const { return joints[joint].empty(); }
    /// Computes the velocity of each body relative to its groups from the velocities of the joints' belts.
    void offsets(const std::vector<double>& of_joints, const Mode& mode, std::vector<double>& of_bodies) const;
    /// Computes the torque of each sticking joint from the missing torque of each body, I a - torque.
    void multipliers(const std::vector<double>& lacking, std::vector<double>& of_joints) const;
    /// The same at all nodes of a stretch. Overwrites `lacking`.
    void multipliers(std::vector<Nodes>& lacking, std::vector<Nodes>& of_joints) const;

private:
    void go_along(const std::vector<double>& of_joints, const Mode& mode, std::vector<double>& of_bodies) const;
    void close_loops(Eigen::MatrixXd rows);
    void separate(const model::System& system);

    const model::System* system_;
    Eigen::MatrixXd anchor_;          ///< correction of the leads for the mismatch in closed loops
    std::vector<std::size_t> leads_;  ///< the first body of each degree of freedom, before loops were closed
};

/// Returns the indices of rigid links that are implied by other rigid links.
std::vector<std::size_t> redundant_rigid(const model::System& system);

/// The minimum of x G x / 2 + g x within a box; G is symmetric and regular.
Eigen::VectorXd least_in_box(const Eigen::MatrixXd& G, const Eigen::VectorXd& g, const Eigen::VectorXd& low,
                             const Eigen::VectorXd& high);

class Mechanics : text::NotCopied {
public:
    Mechanics(const model::System& system, const model::Drive& drive, const CallConvention& convention);
    ~Mechanics() = default;

    const model::System& system() const { return system_; }
    std::size_t bodies() const { return system_.bodies.size(); }
    std::size_t joints() const { return system_.joints.size(); }
    /// The number of states: the user's, each joint's bristle deflection, and each slider's spring.
    std::size_t states() const { return drive_.states.size() + bristles_.size() + sliders_.size(); }
    std::size_t states_of_user() const { return drive_.states.size(); }
    std::size_t events() const { return drive_.events.size(); }
    /// The law of a joint if it has an internal state, or nullptr.
    const model::BendingLaw* bristle(std::size_t joint) const { return contacts_[joint].bristle; }
    const std::vector<std::size_t>& bristles() const { return bristles_; }
    /// A Jenkins element: a dry slider behind a spring.
    struct Slider {
        std::size_t joint, bend;  ///< index of its deflection in y
        double stiffness, limit;
    };
    const std::vector<Slider>& sliders() const { return sliders_; }
    /// The torque of its sliders' springs on a joint.
    double slider_torque(std::size_t joint, std::span<const double> y) const {
        double torque = 0;
        for (const Slider& slider : sliders_) {
            if (slider.joint == joint) torque += slider.stiffness * y[slider.bend];
        }
        return torque;
    }
    /// The torque of a joint's bristles; 0 without bristles.
    double bristle_torque(std::size_t joint, const Moment& at, double belt) const;
    /// The inertia of a body; 0 if its motion is prescribed without inertia.
    double own_inertia(std::size_t body) const {
        const auto& moved = system_.bodies[body].moved;
        return moved && moved->without_inertia ? 0 : system_.bodies[body].inertia;
    }
    /// Returns whether torques or rates depend on the motion other than through constant coefficients.
    bool nonlinear() const { return nonlinear_; }
    /// Returns whether the joint's friction law is native and has constant parameters.
    bool is_native(std::size_t joint) const { return contacts_[joint].native; }
    /// Returns whether the spring is a user's function with known conditions, which may jump.
    bool spring_may_jump(std::size_t joint) const { return contacts_[joint].spring.has_value(); }
    bool spring_slides(std::size_t joint) const { return contacts_[joint].spring && contacts_[joint].spring->slides(); }
    /// Returns whether all joint torques are linear in angle and velocity, except for friction that depends on the
    /// direction only, and nothing else depends on the motion.
    bool all_linear() const { return all_linear_; }
    bool rubs(std::size_t joint) const { return rubs_[joint] != 0; }
    const std::vector<char>& rubbing() const { return rubs_; }
    bool has_belts() const { return has_belts_; }
    bool has_belt(std::size_t joint) const { return !belts_[joint].none(); }
    double belt(std::size_t joint, double t, Side side) const;
    /// The belt's acceleration at t from the right, differentiated over `stretch` time units.
    BeltSlope belt_slope(std::size_t joint, double t, double stretch) const {
        return belts_[joint].none() ? BeltSlope{0, 0} : motion::belt_slope(drive_.belts[joint], t, stretch);
    }
    double base(double t, Side side) const { return base_.value({t, side, {}}); }
    bool has_base() const { return !base_.none(); }
    /// The friction torque on the joint's first body if the joint does not hold.
    double friction(std::size_t joint, const Moment& at, const Mode& mode, double belt) const;
    /// Registers an unannounced jump found at this time.
    void jumps_at(double t) { jumps_.insert(std::upper_bound(jumps_.begin(), jumps_.end(), t), t); }
    /// Drops registered jumps before this time.
    void forget_jumps(double t) { jumps_.erase(jumps_.begin(), std::lower_bound(jumps_.begin(), jumps_.end(), t)); }

    /// Computes the loads of each joint that depend on time only, including the push of the base. Skips loads with a
    /// known value.
    template <class Known>
    void loads_of_time(double t, Side side, std::vector<double>& loads, const Known& known) const {
        const double push = has_base() ? base(t, side) : 0;
        if (loads.size() != joints()) loads.resize(joints());
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
    /// M of a body or link.
    double load(std::size_t joint, const Moment& at) const { return loads_[joint].value(at); }
    /// Computes the torque on each body except that of holding joints; `belts` are velocities. Adds the loads that
    /// depend on the motion to `loads`.
    void torques(const Moment& at, const Mode& mode, const std::vector<double>& belts, std::vector<double>& loads,
                 std::vector<double>& of_bodies) const;
    /// The rates of all states. Those of sliders need the mode.
    void rates(const Moment& at, double* out, const Mode* mode = nullptr) const;
    /// The torque of a joint that does not hold.
    double joint_torque(std::size_t joint, const Moment& at, const Mode& mode, double belt) const;
    /// The torque of a native joint that is not at a wall, at the nodes `first` to `end` - 1. y has angles, velocities
    /// (and states), `belt` the velocity of its belt. The other nodes of `out` are undefined.
    void native_torques(std::size_t joint, const Mode& mode, const std::vector<Nodes>& y, const Nodes& belt,
                        std::size_t first, std::size_t end, Nodes& out) const;
    /// Adds the friction part of native_torques() at these nodes.
    void add_native_friction(std::size_t joint, const Mode& mode, const Nodes& slip, std::size_t first, std::size_t end,
                             Nodes& out) const;
    /// The magnitude of sliding friction.
    double sliding(std::size_t joint, const Slipping& how, double slip, const Moment& at) const;
    std::size_t range_of(std::size_t joint, double speed) const;
    /// The largest pull this way that sticking can hold.
    double holding(std::size_t joint, model::Motion way, const Moment& at) const;
    /// The pull in direction `way` at which a joint leaves slip 0 in this mode.
    double limit_at_rest(std::size_t joint, const Mode& mode, model::Motion way, const Moment& at) const {
        const double most = holding(joint, way, at);
        return mode.friction[joint].driven_back && std::isfinite(most) ? sliding(joint, {.way = way}, 0, at) : most;
    }
    /// Returns whether the holding limit depends on more than the direction.
    bool varies(std::size_t joint) const { return contacts_[joint].varies; }
    /// Returns whether the joint sticks with limits that may change along a stretch.
    bool limits_change(std::size_t joint, const Mode& mode) const {
        return varies(joint) && mode.rubs[joint] != 0 && mode.friction[joint].way == model::Motion::stuck;
    }
    bool has_normal(std::size_t joint) const { return !contacts_[joint].normal.none(); }
    /// Returns whether the contact may open: its normal load, or all of its limits, vary.
    bool may_open(std::size_t joint) const { return rubs(joint) && contacts_[joint].may_open; }
    /// The normal load of a contact, otherwise the greatest of its limits. The contact is open while this is <= 0.
    double pressing(std::size_t joint, const Moment& at) const;
    /// The function `when` of a user's event.
    double when(std::size_t event, const Moment& at) const { return whens_[event].value(at); }
    /// The size of the torques at a joint, those of springs and friction, as a scale of rounding.
    double size_of(std::size_t joint, const Moment& at) const;

    /// The weighted sum of a joint's body values, at nodes or as a series.
    Nodes between(std::size_t joint, std::span<const Nodes> of_bodies) const {
        const auto& of = system_.joints[joint].of;
        Nodes sum = of_bodies[of[0].body];
        if (of[0].by != 1) std::for_each(sum.begin(), sum.end(), [by = of[0].by](double& x) { x *= by; });
        for (std::size_t k = 1; k < of.size(); ++k) add(sum, of_bodies[of[k].body], of[k].by);
        return sum;
    }
    /// The slip velocity of a joint on its belt, at nodes.
    Nodes slips(std::size_t joint, const std::vector<Nodes>& y, const Nodes& belt) const {
        return difference(between(joint, std::span(y).subspan(bodies())), belt);
    }
    double angle(std::size_t joint, std::span<const double> y) const;
    double velocity(std::size_t joint, std::span<const double> y) const;
    /// Returns the size of the velocities whose sum is the joint's velocity; its rounding is relative to this.
    double speed_scale(std::size_t joint, std::span<const double> y) const;
    /// Returns the joint's speed; 0 if it may be rounding.
    double clear_speed(std::size_t joint, std::span<const double> y) const;

    double next_break(double t) const;
    /// The time after t at which a belt that turns at t, such as one that only touches velocity 0, has clearly moved
    /// on, before the next break. `unit` is the time scale of the motion.
    double after_turn(double t, double unit) const {
        constexpr double little_later = 1e-6;
        return t + std::min(little_later * unit, (next_break(t) - t) / 2);
    }
    double view(double t, double spacing) const;
    bool may_go_on() const;
    void forget_failure() const;
    bool samples_functions() const;
    /// Returns whether there is any user function.
    bool has_functions() const { return has_functions_; }
    /// The greatest natural frequency of a linear system with these groups, rad per time unit; 0 without springs. An
    /// upper bound of it if there are many groups.
    double fastest(const Frame& frame) const;

    template <class F>
    void for_each_signal(F f) {
        for (Signal* s : signals_) f(*s);
    }
    template <class F>
    void for_each_signal(F f) const {
        for (const Signal* s : signals_) f(*s);
    }
    /// Visits the user's piecewise functions of the motion at this time.
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
    /// Returns the user's state with this rate function; empty if there is none.
    std::optional<std::size_t> state_of(const Piecewise& rate) const {
        const auto found =
            std::find_if(rates_.begin(), rates_.end(), [&rate](const Piecewise& each) { return &each == &rate; });
        return found == rates_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - rates_.begin()));
    }
    /// Returns the joint of which this function is a load, a spring, a limit of friction or the normal load; empty if
    /// there is none.
    [[nodiscard]] std::optional<std::size_t> joint_of(const Piecewise& function, double t);
    /// Passes the direction of sliding to users' friction laws.
    void set_law_directions(const Mode& mode) {
        for (std::size_t j = 0; j < contacts_.size(); ++j) {
            const Slipping& how = mode.friction[j];
            if (contacts_[j].law) contacts_[j].law->set_direction(how.riding ? 0 : model::sign_of(how.way));
        }
    }
    /// Returns whether some user function of the motion has unknown pieces.
    bool samples_the_motion() const {
        bool samples = std::any_of(rates_.begin(), rates_.end(), [](const Piecewise& r) { return !r.has_pieces(); });
        for_each_signal([&](const Signal& s) { samples = samples || s.samples_the_motion(); });
        return samples;
    }
    /// Calls every function that is not known as a formula once in order, so that variables shared by these functions
    /// have the values of this moment.
    void call_unread(const Moment& at, const Mode& mode) const;
    /// A user function and its current piece, for the inspection of formulas.
    struct UserPiece {
        model::UserFunction* function = nullptr;
        const model::terms::Piece* piece = nullptr;
    };
    UserPiece rate_function(std::size_t k) const { return {drive_.states[k].rate.get(), rates_[k].piece()}; }
    /// The rate function on the other side of the surface along which the state slides.
    UserPiece rate_function_beyond(std::size_t k) const { return {drive_.states[k].rate.get(), rates_[k].beyond()}; }
    UserPiece when_function(std::size_t event) const {
        return {drive_.events[event].when.get(), whens_[event].piece()};
    }
    UserPiece spring_function(std::size_t joint) const;
    UserPiece law_function(std::size_t joint) const;
    const Signal& base_signal() const { return base_; }
    const Signal& belt_signal(std::size_t joint) const { return belts_[joint]; }
    /// Visits the signals that limit or drive a joint's friction in a mode, with the derivative of the torque with
    /// respect to each.
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
        if (c.normal.none()) return;
        const auto most = [&](model::Motion to) { return std::fabs(holding_per_load(joint, to, at)); };
        f(c.normal, slides && rubs(joint) ? std::fabs(sliding_per_load(joint, how, velocity(joint, at.y), at))
                                          : std::max(most(model::Motion::backward), most(model::Motion::forward)));
    }
    [[nodiscard]] std::vector<Signal>& loads() { return loads_; }
    const std::vector<Signal>& loads() const { return loads_; }

private:
    struct Contact {
        std::array<Signal, 2> sliding, holding;
        Signal normal;
        const model::BendingLaw* bristle = nullptr;
        std::optional<Piecewise> law = {};     ///< the user's friction law
        std::optional<Piecewise> spring = {};  ///< the user's spring, if it has conditions
        bool varies = false, native = false, may_open = false;
        /// Torques that depend on the direction only.
        struct FixedTorques {
            std::array<double, 2> holding, sliding;
        };
        std::optional<FixedTorques> constant = {};
    };

    double bound_of_fastest(const Frame& frame) const;
    double spring_torque(std::size_t joint, const Moment& at) const;
    /// The same on the present piece of a user's function, also where the joint slides along its jump.
    double spring_torque(std::size_t joint, double angle) const;
    double law_friction(std::size_t joint, const Moment& at, const Mode& mode, double belt) const;
    /// The factor by which a contact's load multiplies its friction.
    double load_on(std::size_t joint, const Moment& at) const;
    double sliding_per_load(std::size_t joint, const Slipping& how, double slip, const Moment& at) const;
    double holding_per_load(std::size_t joint, model::Motion way, const Moment& at) const;
    void each_function(const std::function<void(model::UserFunction&)>& call) const;

    const model::System& system_;
    const model::Drive& drive_;
    std::vector<Signal> loads_, belts_;
    Signal base_;
    std::vector<Contact> contacts_;
    std::vector<Signal*> signals_;  ///< all signals except empty ones
    std::vector<char> rubs_;
    std::vector<std::size_t> bristles_;
    std::vector<Slider> sliders_;
    std::vector<Piecewise> rates_;  ///< rates of the user's states
    std::vector<Piecewise> whens_;  ///< functions `when` of the user's events
    std::vector<double> jumps_;     ///< times of jumps found in belts
    bool nonlinear_ = false, all_linear_ = true, has_belts_ = false, has_functions_ = false;
};

}  // namespace dinal::motion::engine
