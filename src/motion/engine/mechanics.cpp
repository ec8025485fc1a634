#include "motion/engine/mechanics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "algebra/decompositions.hpp"
#include "model/laws/user_law.hpp"
#include "model/springs/user_spring.hpp"

namespace dinal::motion::engine {

namespace {

using model::Joint;
using model::Motion;
namespace laws = model::laws;

std::size_t side_of(Motion way) {
    return way == Motion::forward ? 1 : 0;
}

/// Which bodies are held together, with the ground behind the last one.
class Union {
public:
    explicit Union(std::size_t bodies) : parent_(bodies + 1) { std::iota(parent_.begin(), parent_.end(), 0U); }
    std::size_t root(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// False when they were together already.
    bool join(std::size_t a, std::size_t b) {
        a = root(a), b = root(b);
        if (a == b) return false;
        parent_[std::min(a, b)] = std::max(a, b);  // the ground stays a root
        return true;
    }

private:
    std::vector<std::size_t> parent_;
};

}  // namespace

Frame::Frame(const model::Assembly& system, const Mode& mode) : group(system.bodies.size(), grounded) {
    const std::size_t n = system.bodies.size();
    Union together(n);
    std::vector<std::size_t> tree;
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        if (!mode.holds(j)) continue;
        const Joint& joint = system.joints[j];
        const std::size_t second = joint.second < 0 ? n : index(joint.second);
        (together.join(index(joint.first), second) ? tree : closing).push_back(j);
    }
    std::vector<int> of_root(n + 1, grounded);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t root = together.root(i);
        if (root == together.root(n)) continue;
        if (of_root[root] == grounded) {
            of_root[root] = static_cast<int>(inertia.size());
            inertia.push_back(0);
        }
        group[i] = of_root[root];
        inertia[index(group[i])] += system.bodies[i].inertia;
    }
    // From the ground, and then from the first body of each group, outwards.
    std::vector<char> reached(n, 0);
    const auto grow = [&] {
        for (bool grown = true; grown;) {
            grown = false;
            for (const std::size_t j : tree) {
                const Joint& joint = system.joints[j];
                const bool first = reached[index(joint.first)] != 0;
                const bool second = joint.second < 0 || reached[index(joint.second)] != 0;
                if (first == second) continue;
                edges.push_back(first ? Edge{j, joint.second, joint.first, -1} : Edge{j, joint.first, joint.second, 1});
                reached[index(edges.back().child)] = 1;
                grown = true;
            }
        }
    };
    grow();
    for (std::size_t i = 0; i < n; ++i) {
        if (reached[i] != 0) continue;
        reached[i] = 1;
        grow();
    }
    if (closing.empty()) return;
    // In loops torques are shared as Engine::share_loops shares them: the least sum of squares, of each by how much it
    // accelerates its two bodies.
    sharing_of = tree;
    sharing_of.insert(sharing_of.end(), closing.begin(), closing.end());
    Eigen::MatrixXd on_bodies =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(sharing_of.size()));
    Eigen::VectorXd weakness(on_bodies.cols());
    for (Eigen::Index c = 0; c < on_bodies.cols(); ++c) {
        const Joint& joint = system.joints[sharing_of[static_cast<std::size_t>(c)]];
        double lightness = 1 / system.bodies[index(joint.first)].inertia;
        if (joint.second >= 0) lightness += 1 / system.bodies[index(joint.second)].inertia;
        weakness(c) = 1 / std::sqrt(lightness);
        on_bodies(joint.first, c) = weakness(c);
        if (joint.second >= 0) on_bodies(joint.second, c) = -weakness(c);
    }
    sharing = weakness.asDiagonal() * algebra::pseudo_inverse(on_bodies);
}

void Frame::offsets(const std::vector<double>& of_joints, const Mode& mode, std::vector<double>& of_bodies) const {
    of_bodies.assign(group.size(), 0);
    for (const Edge& edge : edges) {
        const double own = mode.leans[edge.joint] != 0 ? 0 : of_joints[edge.joint];
        const double before = edge.parent < 0 ? 0 : of_bodies[index(edge.parent)];
        of_bodies[index(edge.child)] = before + edge.sign * own;
    }
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
        of_joints[edge.joint] = edge.sign * behind[index(edge.child)];
        if (edge.parent >= 0) behind[index(edge.parent)] += behind[index(edge.child)];
    }
}

/// By exchanging at once all that are on the wrong side of their condition, and, where that goes round, one at a time.
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

Mechanics::Mechanics(const model::Assembly& system, const model::Drive& drive, const Asking& asking)
    : system_(system), drive_(drive), base_(drive.base, &asking) {
    for (const model::Excitation& load : drive.loads) {
        loads_.emplace_back(load, &asking);
        nonlinear_ |= loads_.back().asks_the_motion();
    }
    for (const model::OwnState& state : drive.states) rates_.emplace_back(&asking, state.rate.get(), 0);
    for (const model::WantedEvent& event : drive.events) whens_.emplace_back(&asking, event.when.get(), 0);
    nonlinear_ |= !drive.states.empty();
    all_linear_ = !nonlinear_;
    bristles_.reserve(joints());
    for (std::size_t j = 0; j < joints(); ++j) {
        const Joint& joint = system.joints[j];
        const model::ContactFriction& friction = joint.friction;
        Contact contact;
        for (const std::size_t side : {0U, 1U}) {
            if (friction.sliding[side]) contact.sliding[side] = Signal(*friction.sliding[side], &asking);
            if (friction.holding[side]) contact.holding[side] = Signal(*friction.holding[side], &asking);
            nonlinear_ |= contact.sliding[side].asks_the_motion();
            contact.varies |= !contact.holding[side].none() && contact.holding[side].constant_from() == model::never;
        }
        if (friction.normal) contact.normal = Signal(*friction.normal, &asking);
        contact.varies |= !friction.is_constant();
        nonlinear_ |= contact.normal.asks_the_motion() || friction.function != nullptr ||
                      friction.law.depends_on_speed() || !joint.spring.none();
        const auto* user = friction.law.as<laws::UserLaw>();
        const auto slip = [this, j](const Moment& at) { return velocity(j, at.y) - belt(j, at.t, at.side); };
        if (friction.function != nullptr) {
            contact.law.emplace(&asking, friction.function.get(), Piecewise::Law{false, slip});
        } else if (user != nullptr && user->function->has_pieces()) {
            contact.law.emplace(&asking, user->function.get(), Piecewise::Law{true, slip});
        }
        const auto* spring = joint.spring.as<model::springs::UserSpring>();
        if (spring != nullptr && spring->function->has_pieces()) {
            const auto turned = [this, j](const Moment& at) { return angle(j, at.y); };
            contact.spring.emplace(&asking, spring->function.get(), Piecewise::Law{true, turned, 1, true});
        }
        contact.bristle = friction.bristle();
        const bool bends = contact.bristle != nullptr;
        contact.native = friction.is_constant() && !contact.law;
        const auto varies = [](const Signal& limit) { return !limit.none(); };
        contact.may_open =
            !contact.normal.none() || std::all_of(contact.sliding.begin(), contact.sliding.end(), varies);
        all_linear_ = all_linear_ && contact.native && !friction.law.depends_on_speed() && joint.spring.none();
        contacts_.push_back(std::move(contact));
        if (bends) bristles_.push_back(j);
        rubs_.push_back(friction.none() || bends ? 0 : 1);
        belts_.emplace_back(rubs_.back() != 0 || bends ? drive.belts[j] : model::Excitation(), &asking);
        has_belts_ |= !belts_.back().none();
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
}

/// Where it does not break it is asked at t itself: a hair beside that it may be off by less than any rounding, and a
/// mass would slide on a belt that has its velocity.
double Mechanics::belt(std::size_t joint, double t, Side side) const {
    if (belts_[joint].none()) return 0;
    const bool breaks = side != Side::at && (belts_[joint].next_break(std::nextafter(t, -model::never)) == t ||
                                             std::binary_search(jumps_.begin(), jumps_.end(), t));
    return belts_[joint].value({t, breaks ? side : Side::at, {}});
}

void Mechanics::sample_loads(const NodeTimes& when, std::vector<Nodes>& loads) const {
    Nodes push{};
    if (!base_.none()) base_.sample(when, push);
    for (std::size_t i = 0; i < bodies(); ++i) {
        if (loads_[i].none()) {
            loads[i].fill(0);
        } else {
            loads_[i].sample(when, loads[i]);
        }
        for (std::size_t j = 0; j < node_count && !base_.none(); ++j)
            loads[i][j] -= system_.bodies[i].inertia * push[j];
    }
}

double Mechanics::angle(std::size_t joint, std::span<const double> y) const {
    const Joint& own = system_.joints[joint];
    return own.second < 0 ? y[index(own.first)] : y[index(own.first)] - y[index(own.second)];
}

double Mechanics::velocity(std::size_t joint, std::span<const double> y) const {
    return angle(joint, y.subspan(bodies()));
}

double Mechanics::sliding(std::size_t joint, const Slipping& how, double slip, const Moment& at) const {
    const model::ContactFriction& friction = system_.joints[joint].friction;
    const Contact& contact = contacts_[joint];
    const double speed = model::sign_of(how.way) * slip;
    const Signal& own = contact.sliding[side_of(how.way)];
    double torque = 0;
    if (contact.law) {
        const Piecewise& law = *contact.law;
        const double smooth = speed >= 0 || law.is_held() ? law.value(at, speed) : model::never;
        // Where nothing tells how it goes on below 0, with the slope that it has there.
        torque = speed >= 0 || std::isfinite(smooth) ? smooth : 2 * law.value(at, 0) - law.value(at, -speed);
        torque *= friction.law.normal();
    } else if (!own.none()) {
        torque = own.value(at);
    } else if (friction.law.ranges() > 0) {
        const model::SpeedRange range = friction.law.range(how.range);
        torque = range.straight ? range.at(speed) : friction.law.sliding(how.way, speed);
    } else {
        torque = friction.law.sliding(how.way, speed);
    }
    return contact.normal.none() ? torque : torque * std::max(0.0, contact.normal.value(at));
}

double Mechanics::holding(std::size_t joint, Motion way, const Moment& at) const {
    const model::ContactFriction& friction = system_.joints[joint].friction;
    const Contact& contact = contacts_[joint];
    const Signal &own = contact.holding[side_of(way)], &sliding_own = contact.sliding[side_of(way)];
    double torque = 0;
    if (!own.none()) {
        torque = own.value(at);
    } else if (friction.function != nullptr) {
        return sliding(joint, {.way = way}, 0, at);
    } else if (!sliding_own.none()) {
        torque = sliding_own.value(at);
    } else {
        torque = friction.law.holding(way);
    }
    return contact.normal.none() ? torque : torque * std::max(0.0, contact.normal.value(at));
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
    if (bristle(joint) != nullptr) return -bristle_torque(joint, at, belt);
    const Slipping& how = mode.friction[joint];
    if (how.riding) return -model::sign_of(how.way) * holding(joint, how.way, at);
    if (how.way == Motion::stuck || !rubs(joint)) return 0;
    Slipping present = how;
    // Along a wall nobody watches for the speeds at which a law changes its formula.
    if (mode.leans[joint] != 0) present.range = range_of(joint, std::fabs(belt));
    return -model::sign_of(how.way) * sliding(joint, present, velocity(joint, at.y) - belt, at);
}

Mechanics::Asked Mechanics::asked_spring(std::size_t joint) const {
    const auto* spring = system_.joints[joint].spring.as<model::springs::UserSpring>();
    const auto& held = contacts_[joint].spring;
    return spring == nullptr ? Asked{} : Asked{spring->function.get(), held ? held->piece() : nullptr};
}

Mechanics::Asked Mechanics::asked_law(std::size_t joint) const {
    const model::ContactFriction& friction = system_.joints[joint].friction;
    const auto* user = friction.law.as<laws::UserLaw>();
    const auto& held = contacts_[joint].law;
    return {friction.function != nullptr ? friction.function.get()
            : user != nullptr            ? user->function.get()
                                         : nullptr,
            held ? held->piece() : nullptr};
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
    if (!own.spring.none()) torque += spring_torque(joint, q);
    return torque;
}

void Mechanics::native_torques(std::size_t joint, const Mode& mode, const std::vector<Nodes>& y, const Nodes& belt,
                               std::size_t first, std::size_t end, Nodes& out) const {
    const Joint& own = system_.joints[joint];
    const double C = own.damping, k = own.stiffness;
    const Nodes angle = between(joint, y), velocity = between(joint, std::span(y).subspan(bodies()));
    for (std::size_t j = first; j < end; ++j) out[j] = C * velocity[j] + k * angle[j];
    if (!own.spring.none()) {
        for (std::size_t j = first; j < end; ++j) out[j] += spring_torque(joint, angle[j]);
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
    for (std::size_t i = 0; i < bodies(); ++i) {
        if (loads_[i].asks_the_motion()) loads[i] += loads_[i].of_motion(at);
    }
    of_bodies = loads;
    for (std::size_t j = 0; j < joints(); ++j) {
        const double torque = joint_torque(j, at, mode, belts[j]);
        if (torque == 0) continue;
        of_bodies[index(system_.joints[j].first)] -= torque;
        if (system_.joints[j].second >= 0) of_bodies[index(system_.joints[j].second)] += torque;
    }
}

void Mechanics::rates(const Moment& at, double* out) const {
    for (std::size_t k = 0; k < drive_.states.size(); ++k) out[k] = rates_[k].value(at);
    for (std::size_t b = 0; b < bristles_.size(); ++b) {
        const std::size_t joint = bristles_[b], k = drive_.states.size() + b;
        const double slips = velocity(joint, at.y) - belt(joint, at.t, at.side);
        out[k] = bristle(joint)->bend_rate(slips, at.y[2 * bodies() + k]);
    }
}

double Mechanics::bristle_torque(std::size_t joint, const Moment& at, double belt) const {
    const laws::Bristle* own = bristle(joint);
    if (own == nullptr) return 0;
    const auto place = std::find(bristles_.begin(), bristles_.end(), joint) - bristles_.begin();
    const double z = at.y[2 * bodies() + drive_.states.size() + static_cast<std::size_t>(place)];
    const double torque = own->torque(velocity(joint, at.y) - belt, z);
    const Signal& normal = contacts_[joint].normal;
    return normal.none() ? torque : torque * std::max(0.0, normal.value(at));
}

double Mechanics::size_of(std::size_t joint, const Moment& at) const {
    const Joint& own = system_.joints[joint];
    const double q = angle(joint, at.y);
    double size = std::fabs(own.stiffness * q) + std::fabs(own.spring.torque(q));
    if (own.second >= 0) {  // a difference of two angles is known as well as these
        const double known = std::fabs(at.y[index(own.first)]) + std::fabs(at.y[index(own.second)]);
        constexpr double ulps = 1024 * rounding;
        size += own.stiffness * known + own.damping * (std::fabs(at.y[bodies() + index(own.first)]) +
                                                       std::fabs(at.y[bodies() + index(own.second)]));
        if (!own.spring.none()) {
            size += std::fabs(own.spring.torque(q + ulps * known) - own.spring.torque(q - ulps * known)) / (2 * ulps);
        }
    }
    if (rubs(joint)) {
        size +=
            std::max(std::fabs(holding(joint, Motion::forward, at)), std::fabs(holding(joint, Motion::backward, at)));
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
        if (const auto* law = joint.friction.law.as<laws::UserLaw>()) call(*law->function);
        if (joint.friction.function != nullptr) call(*joint.friction.function);
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

bool Mechanics::asks_functions() const {
    bool asks = false;
    for_each_signal([&](const Signal& s) { asks = asks || s.asks_functions(); });
    return asks;
}

bool Mechanics::has_functions() const {
    bool has = asks_functions() || !rates_.empty() || !whens_.empty();
    for (std::size_t j = 0; j < joints(); ++j)
        has = has || asked_spring(j).function != nullptr || asked_law(j).function != nullptr;
    return has;
}

double Mechanics::fastest(const Frame& frame) const {
    const auto n = static_cast<Eigen::Index>(frame.groups());
    if (n == 0) return 0;
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    for (const Joint& joint : system_.joints) {
        if (joint.stiffness == 0) continue;
        const int a = frame.group[index(joint.first)];
        const int b = joint.second < 0 ? Frame::grounded : frame.group[index(joint.second)];
        if (a == b) continue;
        const auto scaled = [&](int p, int q) {
            return joint.stiffness / std::sqrt(frame.inertia[index(p)] * frame.inertia[index(q)]);
        };
        if (a >= 0) K(a, a) += scaled(a, a);
        if (b >= 0) K(b, b) += scaled(b, b);
        if (a >= 0 && b >= 0) K(a, b) -= scaled(a, b), K(b, a) -= scaled(a, b);
    }
    if (n == 1) return std::sqrt(K(0, 0));
    return std::sqrt(std::max(0.0, algebra::largest_eigenvalue_of_symmetric(K)));
}

}  // namespace dinal::motion::engine
