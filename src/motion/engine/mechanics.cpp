#include "motion/engine/mechanics.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "algebra/decompositions.hpp"
#include "model/functions.hpp"
#include "model/springs.hpp"

namespace dinal::motion::engine {

namespace {

using model::Joint;
using model::Motion;
namespace laws = model::laws;

void add_shape(Frame::Shape& to, const Frame::Shape& what, double by) {
    for (const Frame::Share& share : what) {
        const auto same =
            std::find_if(to.begin(), to.end(), [&](const Frame::Share& s) { return s.group == share.group; });
        if (same == to.end()) {
            to.push_back({share.group, by * share.by});
        } else {
            same->by += by * share.by;
        }
    }
}

/// Drops shares that are below the rounding of terms of this size.
void drop_rounding(Frame::Shape& shape, double terms) {
    constexpr double nothing = 1e-13;
    const auto is_nothing = [terms](const Frame::Share& share) { return !(std::fabs(share.by) > nothing * terms); };
    shape.erase(std::remove_if(shape.begin(), shape.end(), is_nothing), shape.end());
}

double greatest_share(const Frame::Shape& shape) {
    double most = 0;
    for (const Frame::Share& share : shape) most = std::max(most, std::fabs(share.by));
    return most;
}

/// Returns how the groups turn a joint through its bodies, leaving out the body `without`.
Frame::Shape turned_by(const Joint& joint, const std::vector<Frame::Shape>& bodies,
                       std::size_t without = ~std::size_t{0}) {
    Frame::Shape shape;
    double terms = 0;
    for (const auto& [body, by] : joint.of) {
        if (body == without) continue;
        add_shape(shape, bodies[body], by);
        terms += std::fabs(by) * greatest_share(bodies[body]);
    }
    drop_rounding(shape, terms);
    return shape;
}

}  // namespace

Frame::Frame(const model::System& system, const Mode& mode)
    : bodies(system.bodies.size()), joints(system.joints.size()), system_(&system) {
    const std::size_t n = system.bodies.size();
    std::vector<std::size_t> held;
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        if (mode.holds(j)) held.push_back(j);
    }
    // Proceeds outwards from the ground, then from the first free body: a holding joint ties one more body to those
    // reached.
    std::vector<char> reached(n, 0), used(system.joints.size(), 0);
    const auto grow = [&] {
        for (bool grown = true; grown;) {
            grown = false;
            for (const std::size_t j : held) {
                if (used[j] != 0) continue;
                const std::vector<model::Weight>& of = system.joints[j].of;
                const auto is_new = [&](const model::Weight& weight) { return reached[weight.body] == 0; };
                const auto child = std::find_if(of.begin(), of.end(), is_new);
                if (child == of.end() || std::any_of(child + 1, of.end(), is_new)) continue;
                add_shape(bodies[child->body], turned_by(system.joints[j], bodies, child->body), -1 / child->by);
                edges.push_back({j, child->body, child->by});
                reached[child->body] = used[j] = 1;
                grown = true;
            }
        }
    };
    grow();
    for (std::size_t i = 0; i < n; ++i) {
        if (reached[i] != 0) continue;
        bodies[i] = {{leads_.size(), 1}};
        leads_.push_back(i);
        reached[i] = 1;
        grow();
    }
    std::copy_if(held.begin(), held.end(), std::back_inserter(closing), [&](std::size_t j) { return used[j] == 0; });
    if (!closing.empty()) {
        const auto rows = static_cast<Eigen::Index>(closing.size()), leads = static_cast<Eigen::Index>(leads_.size());
        Eigen::MatrixXd stops = Eigen::MatrixXd::Zero(rows, leads + rows);
        stops.rightCols(rows).setIdentity();
        for (Eigen::Index c = 0; c < rows; ++c) {
            for (const auto& [lead, by] : turned_by(system.joints[closing[static_cast<std::size_t>(c)]], bodies)) {
                stops(c, static_cast<Eigen::Index>(lead)) = by;
            }
        }
        close_loops(std::move(stops));
    }
    separate(system);
    for (std::size_t j = 0; j < joints.size(); ++j) joints[j] = turned_by(system.joints[j], bodies);
    if (closing.empty()) return;
    // In loops torques are shared as by Engine::share_loops: the least sum of squares, each torque weighted by the
    // acceleration it causes.
    for (const Edge& edge : edges) sharing_of.push_back(edge.joint);
    std::sort(sharing_of.begin(), sharing_of.end());
    sharing_of.insert(sharing_of.end(), closing.begin(), closing.end());
    Eigen::MatrixXd on_bodies =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(sharing_of.size()));
    Eigen::VectorXd weakness(on_bodies.cols());
    for (Eigen::Index c = 0; c < on_bodies.cols(); ++c) {
        const Joint& joint = system.joints[sharing_of[static_cast<std::size_t>(c)]];
        weakness(c) = 1 / std::sqrt(joint.lightness(system.bodies));
        for (const auto& [body, by] : joint.of) on_bodies(static_cast<Eigen::Index>(body), c) = by * weakness(c);
    }
    sharing = weakness.asDiagonal() * algebra::pseudo_inverse(on_bodies);
}

/// Closes loops: each sticking joint whose angle the others leave free removes a degree of freedom. A row has the
/// joint's coefficients of the leads, followed by the combination of joints it consists of.
void Frame::close_loops(Eigen::MatrixXd rows) {
    const auto leads = static_cast<Eigen::Index>(leads_.size());
    std::map<Eigen::Index, Eigen::Index> stopped;  // each dependent lead, and the row that determines it
    constexpr double nothing = 1e-12;
    for (Eigen::Index r = 0; r < rows.rows(); ++r) {
        const double size = std::max(1.0, rows.row(r).tail(rows.rows()).cwiseAbs().maxCoeff());
        Eigen::Index lead = 0;
        if (leads == 0 || !(rows.row(r).head(leads).cwiseAbs().maxCoeff(&lead) > nothing * size)) {
            redundant.push_back(closing[static_cast<std::size_t>(r)]);
            continue;
        }
        rows.row(r) /= rows(r, lead);
        for (Eigen::Index other = 0; other < rows.rows(); ++other) {
            if (other != r) rows.row(other) -= Eigen::RowVectorXd(rows(other, lead) * rows.row(r));
        }
        stopped[lead] = r;
    }
    if (stopped.empty()) return;
    anchor_ = Eigen::MatrixXd::Zero(leads, rows.rows());
    std::vector<Shape> of_leads(leads_.size());
    std::size_t free = 0;
    for (Eigen::Index k = 0; k < leads; ++k) {
        if (!stopped.contains(k)) of_leads[static_cast<std::size_t>(k)] = {{free++, 1}};
    }
    for (const auto& [lead, row] : stopped) {
        anchor_.row(lead) = rows.row(row).tail(rows.rows());
        Shape& own = of_leads[static_cast<std::size_t>(lead)];
        for (Eigen::Index k = 0; k < leads; ++k) {
            if (!stopped.contains(k)) add_shape(own, of_leads[static_cast<std::size_t>(k)], -rows(row, k));
        }
        drop_rounding(own, 1);
    }
    for (Shape& shape : bodies) {
        Shape made;
        double terms = 0;
        for (const Share& share : shape) {
            add_shape(made, of_leads[share.group], share.by);
            terms += std::fabs(share.by) * greatest_share(of_leads[share.group]);
        }
        drop_rounding(made, terms);
        shape = std::move(made);
    }
}

/// Makes groups that share bodies orthogonal, and computes the inertia of each.
void Frame::separate(const model::System& system) {
    std::size_t count = 0;
    bool coupled = false;
    for (const Shape& shape : bodies) {
        for (const Share& share : shape) count = std::max(count, share.group + 1);
        coupled = coupled || shape.size() > 1;
    }
    if (coupled) {
        const auto n = static_cast<Eigen::Index>(bodies.size());
        Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(count));
        Eigen::VectorXd weights(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            weights(i) = system.bodies[static_cast<std::size_t>(i)].inertia;
            for (const auto& [group, by] : bodies[static_cast<std::size_t>(i)]) {
                columns(i, static_cast<Eigen::Index>(group)) = by;
            }
        }
        constexpr double nothing = 1e-14;
        for (Eigen::Index g = 1; g < columns.cols(); ++g) {
            for (int again = 0; again < 2; ++again) {
                for (Eigen::Index h = 0; h < g; ++h) {
                    const Eigen::VectorXd other = weights.cwiseProduct(columns.col(h));
                    const double common = other.dot(columns.col(g));
                    if (common != 0) columns.col(g) -= common / other.dot(columns.col(h)) * columns.col(h);
                }
            }
        }
        for (Eigen::Index i = 0; i < n; ++i) {
            Shape& shape = bodies[static_cast<std::size_t>(i)];
            shape.clear();
            for (Eigen::Index g = 0; g < columns.cols(); ++g) {
                if (std::fabs(columns(i, g)) > nothing) shape.push_back({static_cast<std::size_t>(g), columns(i, g)});
            }
        }
    }
    inertia.assign(count, 0);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        for (const auto& [group, by] : bodies[i]) inertia[group] += system.bodies[i].inertia * by * by;
    }
}

/// Computes body velocities outwards from the ground and the leads, in the order of the edges.
void Frame::go_along(const std::vector<double>& of_joints, const Mode& mode, std::vector<double>& of_bodies) const {
    for (const Edge& edge : edges) {
        double left = mode.leans[edge.joint] != 0 ? 0 : of_joints[edge.joint];
        for (const auto& [body, by] : system_->joints[edge.joint].of) {
            if (body != edge.child) left -= by * of_bodies[body];
        }
        of_bodies[edge.child] = left / edge.by;
    }
}

void Frame::offsets(const std::vector<double>& of_joints, const Mode& mode, std::vector<double>& of_bodies) const {
    of_bodies.assign(bodies.size(), 0);
    go_along(of_joints, mode, of_bodies);
    if (anchor_.size() == 0) return;
    Eigen::VectorXd lacks(anchor_.cols());
    for (Eigen::Index c = 0; c < lacks.size(); ++c) {
        const std::size_t j = closing[static_cast<std::size_t>(c)];
        lacks(c) = (mode.leans[j] != 0 ? 0 : of_joints[j]) - system_->joints[j].sum(of_bodies);
    }
    const Eigen::VectorXd more = anchor_ * lacks;
    for (std::size_t k = 0; k < leads_.size(); ++k) of_bodies[leads_[k]] = more(static_cast<Eigen::Index>(k));
    go_along(of_joints, mode, of_bodies);
}

void Frame::multipliers(const std::vector<double>& lacking, std::vector<double>& of_joints) const {
    if (!closing.empty()) {
        const Eigen::Map<const Eigen::VectorXd> r(lacking.data(), static_cast<Eigen::Index>(lacking.size()));
        const Eigen::VectorXd shared = sharing * r;
        for (std::size_t c = 0; c < sharing_of.size(); ++c) {
            of_joints[sharing_of[c]] = shared(static_cast<Eigen::Index>(c));
        }
        return;
    }
    thread_local std::vector<double> behind;
    behind = lacking;
    for (std::size_t e = edges.size(); e-- > 0;) {
        const Edge& edge = edges[e];
        const double torque = of_joints[edge.joint] = behind[edge.child] / edge.by;
        for (const auto& [body, by] : system_->joints[edge.joint].of) {
            if (body != edge.child) behind[body] -= by * torque;
        }
    }
}

void Frame::multipliers(std::vector<Nodes>& lacking, std::vector<Nodes>& of_joints) const {
    if (!closing.empty()) {
        Eigen::VectorXd r(static_cast<Eigen::Index>(lacking.size()));
        for (std::size_t j = 0; j < node_count; ++j) {
            for (std::size_t i = 0; i < lacking.size(); ++i) r(static_cast<Eigen::Index>(i)) = lacking[i][j];
            const Eigen::VectorXd shared = sharing * r;
            for (std::size_t c = 0; c < sharing_of.size(); ++c) {
                of_joints[sharing_of[c]][j] = shared(static_cast<Eigen::Index>(c));
            }
        }
        return;
    }
    for (std::size_t e = edges.size(); e-- > 0;) {
        const Edge& edge = edges[e];
        Nodes& torque = of_joints[edge.joint];
        for (std::size_t j = 0; j < node_count; ++j) torque[j] = lacking[edge.child][j] / edge.by;
        for (const auto& [body, by] : system_->joints[edge.joint].of) {
            if (body != edge.child) add(lacking[body], torque, -by);
        }
    }
}

std::vector<std::size_t> redundant_rigid(const model::System& system) {
    Mode mode;
    const std::size_t joints = system.joints.size();
    mode.friction.resize(joints), mode.leans.resize(joints), mode.rubs.resize(joints);
    for (const Joint& joint : system.joints) mode.rigid.push_back(joint.rigid ? 1 : 0);
    return Frame(system, mode).redundant;
}

/// Solves by exchanging all variables that violate a condition at once, or one at a time if that cycles.
Eigen::VectorXd least_in_box(const Eigen::MatrixXd& G, const Eigen::VectorXd& g, const Eigen::VectorXd& low,
                             const Eigen::VectorXd& high) {
    const Eigen::Index n = g.size();
    std::vector<int> at(static_cast<std::size_t>(n), 0);  // 0 free, -1 at its lower bound, 1 at the upper one
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    Eigen::Index fewest = n + 1;
    int patience = 10;
    const int most = 50 + 20 * static_cast<int>(n);
    for (int i = 0; i < most; ++i) {
        std::vector<Eigen::Index> free;
        for (Eigen::Index k = 0; k < n; ++k) {
            const int bound = at[static_cast<std::size_t>(k)];
            if (bound == 0) free.push_back(k);
            x(k) = bound < 0 ? low(k) : bound > 0 ? high(k) : 0;
        }
        if (!free.empty()) {
            const Eigen::VectorXd rest = -(g + G * x);
            const Eigen::VectorXd of_free = rest(free);
            const Eigen::MatrixXd among = G(free, free);
            const Eigen::VectorXd found = algebra::solve_symmetric(among, of_free);
            x(free) = found;
        }
        const Eigen::VectorXd slope = G * x + g;
        std::vector<std::pair<Eigen::Index, int>> wrong;
        for (Eigen::Index k = 0; k < n; ++k) {
            const int bound = at[static_cast<std::size_t>(k)];
            if (bound == 0 && x(k) < low(k)) wrong.emplace_back(k, -1);
            if (bound == 0 && x(k) > high(k)) wrong.emplace_back(k, 1);
            if (bound * slope(k) > 0) wrong.emplace_back(k, 0);
        }
        if (wrong.empty()) break;
        const auto count = static_cast<Eigen::Index>(wrong.size());
        if (count < fewest) {
            fewest = count, patience = 10;
        } else if (--patience < 0) {
            wrong.erase(wrong.begin(), wrong.end() - 1);
        }
        for (const auto& [k, bound] : wrong) at[static_cast<std::size_t>(k)] = bound;
    }
    return x.cwiseMax(low).cwiseMin(high);
}

Mechanics::Mechanics(const model::System& system, const model::Drive& drive, const CallConvention& convention)
    : system_(system), drive_(drive), base_(drive.base, &convention) {
    for (std::size_t j = 0; j < joints(); ++j) {
        loads_.emplace_back(j < drive.loads.size() ? drive.loads[j] : model::Excitation(), &convention);
        nonlinear_ |= loads_.back().depends_on_motion();
    }
    for (const model::OwnState& state : drive.states) rates_.emplace_back(&convention, state.rate.get(), 0);
    for (const model::WantedEvent& event : drive.events) whens_.emplace_back(&convention, event.when.get(), 0);
    nonlinear_ |= !drive.states.empty();
    all_linear_ = !nonlinear_;
    bristles_.reserve(joints());
    for (std::size_t j = 0; j < joints(); ++j) {
        const Joint& joint = system.joints[j];
        const model::ContactFriction& friction = joint.friction;
        Contact contact;
        for (const std::size_t side : {0U, 1U}) {
            if (friction.sliding[side]) contact.sliding[side] = Signal(*friction.sliding[side], &convention);
            if (friction.holding[side]) contact.holding[side] = Signal(*friction.holding[side], &convention);
            nonlinear_ |= contact.sliding[side].depends_on_motion();
            contact.varies |= !contact.holding[side].none() && contact.holding[side].constant_from() == model::never;
        }
        if (friction.normal) contact.normal = Signal(*friction.normal, &convention);
        contact.varies |= !friction.is_constant();
        nonlinear_ |= contact.normal.depends_on_motion() || friction.function != nullptr ||
                      friction.law.depends_on_speed() || !joint.spring.none() || joint.stops ||
                      !friction.sliders.empty();
        const auto* user = friction.law.as<laws::UserLaw>();
        const auto slip = [this, j](const Moment& at) { return velocity(j, at.y) - belt(j, at.t, at.side); };
        if (friction.function != nullptr) {
            contact.law.emplace(&convention, friction.function.get(), Piecewise::Law{false, slip});
        } else if (user != nullptr && user->function->has_pieces()) {
            contact.law.emplace(&convention, user->function.get(), Piecewise::Law{true, slip});
        }
        const auto* spring = joint.spring.as<model::springs::UserSpring>();
        if (spring != nullptr && spring->function->has_pieces()) {
            const auto turned = [this, j](const Moment& at) { return angle(j, at.y); };
            const auto speed = [this, j](const Moment& at) { return clear_speed(j, at.y); };
            contact.spring.emplace(&convention, spring->function.get(), Piecewise::Law{true, turned, 1, speed});
        }
        contact.bristle = friction.bending();
        const bool bends = contact.bristle != nullptr, steady = !friction.law.depends_on_speed();
        contact.native = friction.is_constant() && !contact.law && friction.sliders.empty();
        const auto varies = [](const Signal& limit) { return !limit.none(); };
        contact.may_open =
            !contact.normal.none() || std::all_of(contact.sliding.begin(), contact.sliding.end(), varies);
        if (contact.native && steady && !bends) {
            const auto& law = friction.law;
            contact.constant = {{law.holding(Motion::backward), law.holding(Motion::forward)},
                                {law.sliding(Motion::backward, 0), law.sliding(Motion::forward, 0)}};
        }
        all_linear_ = all_linear_ && contact.native && steady && joint.spring.none() && !joint.stops;
        contacts_.push_back(std::move(contact));
        if (bends) bristles_.push_back(j);
        rubs_.push_back(friction.none() || bends ? 0 : 1);
        const bool touches = rubs_.back() != 0 || bends || !friction.sliders.empty() || joint.rigid;
        const bool stands = drive.belts[j].most() == 0;
        belts_.emplace_back(touches && !stands ? drive.belts[j] : model::Excitation(), &convention);
        has_belts_ |= !belts_.back().none();
    }
    for (std::size_t j = 0; j < joints(); ++j) {
        for (const laws::Jenkins& one : system.joints[j].friction.sliders) {
            const double limit = one.kinetic * system.joints[j].friction.law.normal();
            sliders_.push_back({j, 2 * bodies() + states(), one.stiffness, limit});
        }
    }
    const auto add = [this](Signal& s) {
        if (!s.none()) signals_.push_back(&s);
    };
    for (Signal& s : loads_) add(s);
    for (Signal& s : belts_) add(s);
    for (Contact& c : contacts_) {
        for (Signal& s : c.sliding) add(s);
        for (Signal& s : c.holding) add(s);
        add(c.normal);
    }
    add(base_);
    has_functions_ = samples_functions() || !rates_.empty() || !whens_.empty();
    for (std::size_t j = 0; j < joints(); ++j)
        has_functions_ =
            has_functions_ || spring_function(j).function != nullptr || law_function(j).function != nullptr;
}

/// Except at breaks the belt is evaluated at t itself: a small step aside could change it within rounding, and a mass
/// with the velocity of its belt would slide.
double Mechanics::belt(std::size_t joint, double t, Side side) const {
    if (belts_[joint].none()) return 0;
    const bool breaks = side != Side::at && (belts_[joint].next_break(std::nextafter(t, -model::never)) == t ||
                                             std::binary_search(jumps_.begin(), jumps_.end(), t));
    return belts_[joint].value({t, breaks ? side : Side::at, {}});
}

void Mechanics::sample_loads(const NodeTimes& when, std::vector<Nodes>& loads) const {
    Nodes push{};
    if (!base_.none()) base_.sample(when, push);
    for (std::size_t i = 0; i < joints(); ++i) {
        if (loads_[i].none()) {
            loads[i].fill(0);
        } else {
            loads_[i].sample(when, loads[i]);
        }
        for (std::size_t j = 0; j < node_count && i < bodies() && !base_.none(); ++j)
            loads[i][j] -= system_.bodies[i].inertia * push[j];
    }
}

double Mechanics::angle(std::size_t joint, std::span<const double> y) const {
    return system_.joints[joint].sum(y);
}

double Mechanics::velocity(std::size_t joint, std::span<const double> y) const {
    return angle(joint, y.subspan(bodies()));
}

double Mechanics::clear_speed(std::size_t joint, std::span<const double> y) const {
    const double speed = std::fabs(velocity(joint, y));
    return speed > 16 * rounding * speed_scale(joint, y) ? speed : 0;
}

double Mechanics::speed_scale(std::size_t joint, std::span<const double> y) const {
    return system_.joints[joint].size(y.subspan(bodies()));
}

double Mechanics::sliding(std::size_t joint, const Slipping& how, double slip, const Moment& at) const {
    const Contact& contact = contacts_[joint];
    if (contact.constant) return contact.constant->sliding[side_of(how.way)];
    return sliding_per_load(joint, how, slip, at) * load_on(joint, at);
}

double Mechanics::holding(std::size_t joint, Motion way, const Moment& at) const {
    const Contact& contact = contacts_[joint];
    if (contact.constant) return contact.constant->holding[side_of(way)];
    return holding_per_load(joint, way, at) * load_on(joint, at);
}

double Mechanics::load_on(std::size_t joint, const Moment& at) const {
    const Signal& normal = contacts_[joint].normal;
    return normal.none() ? 1 : std::max(0.0, normal.value(at));
}

double Mechanics::sliding_per_load(std::size_t joint, const Slipping& how, double slip, const Moment& at) const {
    const model::ContactFriction& friction = system_.joints[joint].friction;
    const Contact& contact = contacts_[joint];
    const double speed = model::sign_of(how.way) * slip;
    const Signal& own = contact.sliding[side_of(how.way)];
    double torque = 0;
    if (contact.law) {
        const Piecewise& law = *contact.law;
        torque = speed >= 0 || law.is_held() ? law.value(at, speed) : model::never;
        if (speed < 0) {
            // If the law is undefined below speed 0, or grows without bound, extrapolate by point reflection at 0.
            constexpr double far = 4;
            const double at_zero = law.value(at, 0), mirrored = law.value(at, -speed);
            const double beside = 2 * at_zero - mirrored;
            if (!(std::fabs(torque - beside) <= far * (std::fabs(at_zero) + std::fabs(mirrored)))) torque = beside;
        }
        torque *= friction.law.normal();
    } else if (!own.none()) {
        torque = own.value(at);
    } else if (friction.law.ranges() > 0) {
        const model::SpeedRange range = friction.law.range(how.range);
        torque = range.straight ? range.at(speed) : friction.law.sliding(how.way, speed);
    } else {
        torque = friction.law.sliding(how.way, speed);
    }
    return torque;
}

double Mechanics::holding_per_load(std::size_t joint, Motion way, const Moment& at) const {
    const model::ContactFriction& friction = system_.joints[joint].friction;
    const Signal &own = contacts_[joint].holding[side_of(way)], &sliding_own = contacts_[joint].sliding[side_of(way)];
    if (!own.none()) return own.value(at);
    if (friction.function != nullptr) return sliding_per_load(joint, {.way = way}, 0, at);
    return sliding_own.none() ? friction.law.holding(way) : sliding_own.value(at);
}

double Mechanics::pressing(std::size_t joint, const Moment& at) const {
    const Contact& contact = contacts_[joint];
    if (!contact.normal.none()) return contact.normal.value(at);
    double most = 0;
    for (const auto* limits : {&contact.sliding, &contact.holding}) {
        for (const Signal& limit : *limits) {
            if (!limit.none()) most = std::max(most, std::fabs(limit.value(at)));
        }
    }
    return most;
}

std::size_t Mechanics::range_of(std::size_t joint, double speed) const {
    const model::Friction& law = system_.joints[joint].friction.law;
    return law.ranges() > 0 ? law.range_of(speed) : 0;
}

double Mechanics::friction(std::size_t joint, const Moment& at, const Mode& mode, double belt) const {
    return law_friction(joint, at, mode, belt) - slider_torque(joint, at.y);
}

double Mechanics::law_friction(std::size_t joint, const Moment& at, const Mode& mode, double belt) const {
    if (bristle(joint) != nullptr) return -bristle_torque(joint, at, belt);
    const Slipping& how = mode.friction[joint];
    if (how.riding) return -model::sign_of(how.way) * holding(joint, how.way, at);
    if (how.way == Motion::stuck || !rubs(joint)) return 0;
    if (const auto& constant = contacts_[joint].constant)
        return -model::sign_of(how.way) * constant->sliding[side_of(how.way)];
    Slipping present = how;
    // No guard watches the corners of the law at a wall, so the range is chosen here.
    if (mode.leans[joint] != 0) present.range = range_of(joint, std::fabs(belt));
    return -model::sign_of(how.way) * sliding(joint, present, velocity(joint, at.y) - belt, at);
}

Mechanics::UserPiece Mechanics::spring_function(std::size_t joint) const {
    const auto* spring = system_.joints[joint].spring.as<model::springs::UserSpring>();
    const auto& held = contacts_[joint].spring;
    return spring == nullptr ? UserPiece{} : UserPiece{spring->function.get(), held ? held->piece() : nullptr};
}

Mechanics::UserPiece Mechanics::law_function(std::size_t joint) const {
    const model::ContactFriction& friction = system_.joints[joint].friction;
    const auto* user = model::user_law(friction.law);
    const auto& held = contacts_[joint].law;
    return {friction.function != nullptr ? friction.function.get()
            : user != nullptr            ? user->function.get()
                                         : nullptr,
            held ? held->piece() : nullptr};
}

double Mechanics::spring_torque(std::size_t joint, const Moment& at) const {
    const auto& held = contacts_[joint].spring;
    return held ? held->value(at) : system_.joints[joint].spring.torque(angle(joint, at.y));
}

double Mechanics::spring_torque(std::size_t joint, double angle) const {
    const auto& held = contacts_[joint].spring;
    return held ? held->value({}, angle) : system_.joints[joint].spring.torque(angle);
}

double Mechanics::joint_torque(std::size_t joint, const Moment& at, const Mode& mode, double belt) const {
    const Joint& own = system_.joints[joint];
    const double q = angle(joint, at.y), s = velocity(joint, at.y);
    double torque = -friction(joint, at, mode, belt);
    if (own.damping != 0) torque += own.damping * s;
    if (own.stiffness != 0) torque += own.stiffness * q;
    if (!own.spring.none()) torque += spring_torque(joint, at);
    if (mode.presses[joint] != 0) torque += own.stops->torque(mode.presses[joint], q, s);
    return torque;
}

void Mechanics::native_torques(std::size_t joint, const Mode& mode, const std::vector<Nodes>& y, const Nodes& belt,
                               std::size_t first, std::size_t end, Nodes& out) const {
    const Joint& own = system_.joints[joint];
    const double C = own.damping, k = own.stiffness;
    const Nodes angle = between(joint, y), velocity = between(joint, std::span(y).subspan(bodies()));
    for (std::size_t j = 0; j < node_count; ++j) out[j] = C * velocity[j] + k * angle[j];
    const model::Friction& law = own.friction.law;
    if (const Slipping& how = mode.friction[joint];
        own.spring.none() && mode.presses[joint] == 0 && !law.depends_on_speed()) {
        if (how.way == Motion::stuck || !rubs(joint)) return;
        const double most = how.riding ? law.holding(how.way) : law.sliding(how.way, 0);
        const double torque = model::sign_of(how.way) * most;
        for (double& each : out) each += torque;
        return;
    }
    if (!own.spring.none()) {
        for (std::size_t j = first; j < end; ++j) out[j] += spring_torque(joint, angle[j]);
    }
    if (const int side = mode.presses[joint]; side != 0) {
        for (std::size_t j = first; j < end; ++j) out[j] += own.stops->torque(side, angle[j], velocity[j]);
    }
    add_native_friction(joint, mode, has_belt(joint) ? difference(velocity, belt) : velocity, first, end, out);
}

void Mechanics::add_native_friction(std::size_t joint, const Mode& mode, const Nodes& slip, std::size_t first,
                                    std::size_t end, Nodes& out) const {
    const Slipping& how = mode.friction[joint];
    if (how.way == Motion::stuck || !rubs(joint)) return;
    const model::Friction& law = system_.joints[joint].friction.law;
    const double sign = model::sign_of(how.way);
    if (how.riding || !law.depends_on_speed()) {
        const double torque = sign * (how.riding ? law.holding(how.way) : law.sliding(how.way, 0));
        for (std::size_t j = first; j < end; ++j) out[j] += torque;
        return;
    }
    const model::SpeedRange range = law.ranges() > 0 ? law.range(how.range) : model::SpeedRange{};
    for (std::size_t j = first; j < end; ++j) {
        const double speed = sign * slip[j];
        out[j] += sign * (range.straight ? range.at(speed) : law.sliding(how.way, speed));
    }
}

void Mechanics::torques(const Moment& at, const Mode& mode, const std::vector<double>& belts,
                        std::vector<double>& loads, std::vector<double>& of_bodies) const {
    for (std::size_t j = 0; j < joints(); ++j) {
        if (loads_[j].depends_on_motion()) loads[j] += loads_[j].of_motion(at);
    }
    of_bodies.assign(loads.begin(), loads.begin() + static_cast<std::ptrdiff_t>(bodies()));
    for (std::size_t j = 0; j < joints(); ++j) {
        double torque = joint_torque(j, at, mode, belts[j]);
        if (j >= bodies()) torque -= loads[j];
        if (torque == 0) continue;
        for (const auto& [body, by] : system_.joints[j].of) of_bodies[body] -= by * torque;
    }
}

void Mechanics::rates(const Moment& at, double* out, const Mode* mode) const {
    for (std::size_t s = 0; s < sliders_.size(); ++s) {
        const bool sticks = mode != nullptr && mode->sliders[s] == Motion::stuck;
        const std::size_t joint = sliders_[s].joint;
        // If the contact does not slip, the remaining slip is rounding, which no polynomial can represent.
        const double moving = belt(joint, at.t, at.side), slips = velocity(joint, at.y) - moving;
        const bool stands = std::fabs(slips) <= 16 * rounding * (speed_scale(joint, at.y) + std::fabs(moving));
        out[sliders_[s].bend - 2 * bodies()] = sticks && !stands ? slips : 0;
    }
    for (std::size_t k = 0; k < drive_.states.size(); ++k) out[k] = rates_[k].value(at);
    for (std::size_t b = 0; b < bristles_.size(); ++b) {
        const std::size_t joint = bristles_[b], k = drive_.states.size() + b;
        const double slips = velocity(joint, at.y) - belt(joint, at.t, at.side);
        out[k] = bristle(joint)->bend_rate(slips, at.y[2 * bodies() + k]);
    }
}

double Mechanics::bristle_torque(std::size_t joint, const Moment& at, double belt) const {
    const model::BendingLaw* own = bristle(joint);
    if (own == nullptr) return 0;
    const auto place = std::find(bristles_.begin(), bristles_.end(), joint) - bristles_.begin();
    const double z = at.y[2 * bodies() + drive_.states.size() + static_cast<std::size_t>(place)];
    return own->torque(velocity(joint, at.y) - belt, z) * load_on(joint, at);
}

double Mechanics::size_of(std::size_t joint, const Moment& at) const {
    const Joint& own = system_.joints[joint];
    const double q = angle(joint, at.y), known = own.size(at.y);  // q has the rounding of its parts
    double size = std::fabs(own.stiffness * q);
    if (!own.spring.none()) size += std::fabs(spring_torque(joint, at));
    if (own.stops) {
        const double deep = std::max(own.stops->lower - q, q - own.stops->upper), v = velocity(joint, at.y);
        // The depth is a difference of angles and has their rounding, also where it should be 0.
        if (deep >= -4 * rounding * known)
            size += own.stops->stiffness * (known + std::fabs(deep)) + own.stops->damping * std::fabs(v);
    }
    if (own.of.size() > 1) {  // a sum of angles is as accurate as its parts
        size += own.stiffness * known + own.damping * speed_scale(joint, at.y);
        const auto by_steepness = [&](double part) {
            return std::fabs(spring_torque(joint, q + part * known) - spring_torque(joint, q - part * known)) /
                   (2 * part);
        };
        // A jump does not count as steepness: over a wider interval it is far less steep.
        constexpr double ulps = 1024 * rounding, wider = 1e-4;
        if (!own.spring.none()) size += std::min(by_steepness(ulps), by_steepness(wider));
    }
    if (rubs(joint)) {
        const double forward = std::fabs(holding(joint, Motion::forward, at));
        size += own.friction.law.is_one_way() ? forward
                                              : std::max(forward, std::fabs(holding(joint, Motion::backward, at)));
    }
    for (const Slider& slider : sliders_) {
        if (slider.joint == joint) size += slider.limit;
    }
    return size;
}

double Mechanics::next_break(double t) const {
    double first = model::never;
    for_each_signal([&](const Signal& s) { first = std::min(first, s.next_break(t)); });
    for (const Piecewise& rate : rates_) first = std::min(first, rate.next_break(t));
    for (const Contact& contact : contacts_) {
        if (contact.law) first = std::min(first, contact.law->next_break(t));
    }
    return first;
}

std::optional<std::size_t> Mechanics::joint_of(const Piecewise& function, double t) {
    for (std::size_t j = 0; j < joints(); ++j) {
        bool found = false;
        Contact& c = contacts_[j];
        for (Signal* s : {&loads_[j], &c.sliding[0], &c.sliding[1], &c.holding[0], &c.holding[1], &c.normal}) {
            s->for_each_piecewise(t, [&](const Piecewise& each) { found = found || &each == &function; });
        }
        if (found || (c.spring && &*c.spring == &function)) return j;
    }
    return {};
}

double Mechanics::view(double t, double spacing) const {
    double least = model::never;
    for_each_signal([&](const Signal& s) { least = std::min(least, s.view(t, spacing)); });
    return least;
}

void Mechanics::each_function(const std::function<void(model::UserFunction&)>& call) const {
    for_each_signal([&](const Signal& s) { s.each_function(call); });
    for (const model::OwnState& state : drive_.states) call(*state.rate);
    for (const Joint& joint : system_.joints) {
        if (const auto* spring = joint.spring.as<model::springs::UserSpring>()) call(*spring->function);
        if (const auto* law = model::user_law(joint.friction.law)) call(*law->function);
        if (joint.friction.function != nullptr) call(*joint.friction.function);
    }
}

void Mechanics::call_unread(const Moment& at, const Mode& mode) const {
    const auto is_unread = [](const UserPiece& own) {
        return own.function != nullptr && own.function->read() == nullptr;
    };
    for_each_signal([&](const Signal& s) { s.call_unread(at); });
    for (const model::Body& body : system_.bodies) {
        if (!body.moved) continue;
        body.moved->motion.each_function([&](model::UserFunction& function) {
            if (function.read() == nullptr) static_cast<void>(function.value(at.t, {}));
        });
    }
    for (std::size_t k = 0; k < rates_.size(); ++k) {
        if (is_unread(rate_function(k))) static_cast<void>(rates_[k].value(at));
    }
    for (std::size_t e = 0; e < whens_.size(); ++e) {
        if (is_unread(when_function(e))) static_cast<void>(when(e, at));
    }
    for (std::size_t j = 0; j < joints(); ++j) {
        if (!is_unread(spring_function(j)) && !is_unread(law_function(j))) continue;
        static_cast<void>(joint_torque(j, at, mode, belt(j, at.t, at.side)));
        const bool sticks = mode.rubs[j] != 0 && mode.friction[j].way == model::Motion::stuck;
        if (sticks && is_unread(law_function(j))) static_cast<void>(holding(j, model::Motion::forward, at));
    }
}

bool Mechanics::may_go_on() const {
    bool may = true;
    each_function([&](model::UserFunction& function) { may = may && function.may_go_on(); });
    return may;
}

void Mechanics::forget_failure() const {
    each_function([](model::UserFunction& function) { function.forget_failure(); });
}

bool Mechanics::samples_functions() const {
    bool asks = false;
    for_each_signal([&](const Signal& s) { asks = asks || s.samples_functions(); });
    return asks;
}

/// Bounds the square of the greatest frequency by the greatest row sum (Gershgorin). The eigenvalue itself would cost
/// the cube of the number of groups for each set of sticking joints.
double Mechanics::bound_of_fastest(const Frame& frame) const {
    std::vector<double> sums(frame.groups(), 0);
    for (std::size_t j = 0; j < joints(); ++j) {
        const double k = system_.joints[j].stiffness;
        for (const auto& [p, of_p] : frame.joints[j]) {
            for (const auto& [q, of_q] : frame.joints[j]) sums[p] += std::fabs(of_p * of_q) * k / frame.inertia[p];
        }
    }
    return std::sqrt(*std::max_element(sums.begin(), sums.end()));
}

double Mechanics::fastest(const Frame& frame) const {
    const auto n = static_cast<Eigen::Index>(frame.groups());
    if (n == 0) return 0;
    constexpr Eigen::Index few = 8;
    if (n > few) return bound_of_fastest(frame);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t j = 0; j < joints(); ++j) {
        const double k = system_.joints[j].stiffness;
        if (k == 0) continue;
        for (const auto& [p, of_p] : frame.joints[j]) {
            for (const auto& [q, of_q] : frame.joints[j]) {
                K(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(q)) +=
                    of_p * of_q * (k / std::sqrt(frame.inertia[p] * frame.inertia[q]));
            }
        }
    }
    if (n == 1) return std::sqrt(K(0, 0));
    return std::sqrt(std::max(0.0, algebra::largest_eigenvalue_of_symmetric(K)));
}

}  // namespace dinal::motion::engine
