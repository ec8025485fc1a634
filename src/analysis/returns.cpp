#include "analysis/returns.hpp"

#include <algorithm>
#include <cmath>

#include "algebra/decompositions.hpp"
#include "analysis/steady_facts.hpp"
#include "model/controller.hpp"

namespace dinal::analysis {

namespace engine = motion::engine;
using Eigen::Index;
using Eigen::VectorXd;

VectorXd vector_of(const std::vector<double>& values) {
    return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

namespace {

/// An event function that is zero at the section.
class Passage final : public model::UserFunction {
public:
    Passage(const Chart& chart, const Returns::Section& section, bool named)
        : chart_(chart), section_(section), named_(named) {}
    double value(double t, const model::State& state) override { return value_with(t, state, {}); }
    double value_with(double /*t*/, const model::State& state, std::span<const double> states) override {
        const double own = section_.measured == 0 ? state.theta : state.velocity;
        return section_.way * ((named_ ? chart_.value(section_.measured, states) : own) - section_.place);
    }

private:
    const Chart& chart_;
    Returns::Section section_;
    bool named_;
};

/// The mode of the opposite motion.
HeldMode opposite(HeldMode held) {
    const auto reverse = [](model::Motion& way) { way = static_cast<model::Motion>(-static_cast<int>(way)); };
    for (engine::Slipping& contact : held.mode.friction) reverse(contact.way), reverse(contact.creeps);
    for (model::Motion& slider : held.mode.sliders) reverse(slider);
    for (int& leans : held.mode.leans) leans = -leans;
    for (int& presses : held.mode.presses) presses = -presses;
    return held;
}

/// Returns whether a shift of the initial state shifts the whole run by the same amount.
bool shifts_as_a_whole(Runs& runs, const Eigen::VectorXd& shift, double length) {
    constexpr double part_of_shift = 0.73;
    const double start = runs.question().repeats.start;
    FullState plain = runs.first(), shifted = plain;
    shifted.y += part_of_shift * shift;
    const auto end = [&](const FullState& from) {
        return Runs::at_stop(runs.run(from, start, start + length, motion::Grid::none(), false)).y;
    };
    const Eigen::VectorXd off = end(shifted) - part_of_shift * shift - end(plain);
    return off.cwiseAbs().maxCoeff() <= 1e-9 * std::max(1.0, plain.y.cwiseAbs().maxCoeff());
}

}  // namespace

Chart chart_of(Runs& runs) {
    const SteadyQuestion& question = runs.question();
    const bool under_M_alone = question.is_alone() && !question.is_timeless() && !question.drive.has_more();
    if (under_M_alone && !question.advances) return Chart({-1});
    const double period = runs.question().repeats.period, natural = runs.natural_period();
    const double length = period > 0 ? period : natural > 0 ? natural : 1;
    const model::System& system = runs.system();
    const Index n = runs.bodies();
    std::vector<Index> part(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = static_cast<Index>(i);
    std::vector<bool> grounded(part.size(), false);
    const auto root = [&](Index i) {
        while (part[static_cast<std::size_t>(i)] != i) i = part[static_cast<std::size_t>(i)];
        return i;
    };
    for (const model::Joint& joint : system.joints) {
        const bool asks = joint.stiffness != 0 || !joint.spring.none() || joint.any_walls() != nullptr;
        for (const model::Weight& other : joint.of) {
            const Index a = root(static_cast<Index>(joint.first())), b = root(static_cast<Index>(other.body));
            if (asks) part[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
        }
    }
    for (const model::Joint& joint : system.joints) {
        const bool asks = joint.stiffness != 0 || !joint.spring.none() || joint.any_walls() != nullptr;
        const Index own = root(static_cast<Index>(joint.first()));
        if (asks && joint.of.size() == 1) grounded[static_cast<std::size_t>(own)] = true;
    }
    std::vector<Index> from(part.size(), -1);
    for (Index of = 0; of < n; ++of) {
        if (root(of) != of || grounded[static_cast<std::size_t>(of)]) continue;
        VectorXd shift = VectorXd::Zero(runs.first().y.size());
        for (Index i = 0; i < n; ++i) shift[i] = root(i) == of ? 1 : 0;
        if (!shifts_as_a_whole(runs, shift, length)) continue;
        for (Index i = 0; i < n; ++i) {
            if (root(i) == of) from[static_cast<std::size_t>(i)] = of;
        }
    }
    return Chart(std::move(from));
}

model::WantedEvent passage(const Chart& chart, const Returns::Section& section, bool named) {
    return {.name = "",
            .when = std::make_shared<Passage>(chart, section, named),
            .direction = model::Direction::up,
            .stop = true};
}

bool operator==(const HeldMode& a, const HeldMode& b) {
    for (std::size_t j = 0; j < a.mode.friction.size(); ++j) {
        const engine::Slipping &x = a.mode.friction[j], &y = b.mode.friction[j];
        if (x.way != y.way || x.riding != y.riding) return false;
    }
    if (a.mode.leans != b.mode.leans || a.mode.rubs != b.mode.rubs) return false;
    if (a.mode.sliders != b.mode.sliders || a.mode.presses != b.mode.presses) return false;
    for (std::size_t i = 0; i < a.controllers.size(); ++i) {
        for (std::size_t c = 0; c < a.controllers[i].size(); ++c) {
            if (a.controllers[i][c].on != b.controllers[i][c].on) return false;
        }
    }
    return true;
}

FullState Runs::first() const {
    std::vector<double> y = question_.drive.theta0;
    y.insert(y.end(), question_.drive.velocity0.begin(), question_.drive.velocity0.end());
    for (const model::OwnState& state : question_.drive.states) y.push_back(state.start);
    for (const model::Joint& joint : system().joints) {
        if (joint.friction.bending() != nullptr) y.push_back(0);
    }
    return {vector_of(y)};
}

std::vector<bool> relays_of(const model::Excitation& excitation) {
    std::vector<bool> on;
    for (const model::Component& component : excitation.components()) {
        const auto* relay = model::controller_of<model::RelayController>(component);
        if (relay != nullptr) on.push_back(relay->starts_on);
    }
    return on;
}

model::Excitation with_relays(const model::Excitation& excitation, const std::vector<bool>& on) {
    if (on.empty()) return excitation;
    std::size_t next = 0;
    return excitation.with_functions([&](const std::shared_ptr<model::UserFunction>& function) {
        const auto* relay = dynamic_cast<const model::RelayController*>(function.get());
        if (relay == nullptr) return function;
        auto own = model::copied(*relay, relay->function);
        own->starts_on = on[next++];
        return std::shared_ptr<model::UserFunction>(std::move(own));
    });
}

model::Drive Runs::from(const FullState& moment, double start) const {
    model::Drive drive = question_.drive;
    const Index n = bodies();
    for (Index i = 0; i < n; ++i) {
        drive.theta0[static_cast<std::size_t>(i)] = moment.y[i];
        drive.velocity0[static_cast<std::size_t>(i)] = moment.y[n + i];
    }
    for (std::size_t k = 0; k < drive.states.size(); ++k) {
        drive.states[k].start = moment.y[2 * n + static_cast<Index>(k)];
    }
    if (!moment.mode) return drive;
    // A held body must have exactly the velocity of its support, otherwise it would slip first.
    for (std::size_t j = 0; j < static_cast<std::size_t>(n); ++j) {
        const int leans = moment.mode->mode.leans[j];
        if (!moment.mode->mode.holds(j)) continue;
        if (leans != 0) drive.theta0[j] = leans > 0 ? system().joints[j].walls->upper : system().joints[j].walls->lower;
        drive.velocity0[j] = leans != 0 ? 0 : motion::belt_from(drive.belts[j], start);
    }
    for (std::size_t i = 0; i < drive.loads.size(); ++i) {
        std::vector<bool> on;
        const auto components = drive.loads[i].components();
        for (std::size_t c = 0; c < components.size(); ++c) {
            const bool relay = model::controller_of<model::RelayController>(components[c]) != nullptr;
            if (relay) on.push_back(moment.mode->controllers[i][c].on);
        }
        drive.loads[i] = with_relays(drive.loads[i], on);
    }
    return drive;
}

motion::Run Runs::run(const FullState& from, double start, double end, const motion::Grid& rows, bool dense,
                      const std::optional<model::WantedEvent>& section) {
    model::Drive drive = this->from(from, start);
    if (section) drive.events.push_back(*section);
    std::shared_ptr<engine::Carry> before;
    if (from.mode) {
        before = std::make_shared<engine::Carry>();
        before->y.assign(from.y.data(), from.y.data() + from.y.size());
        before->mode = from.mode->mode, before->controllers = from.mode->controllers, before->floor = floor_;
    }
    return run(drive, start, end, rows, dense, before);
}

motion::Run Runs::continued(const motion::Run& before, double start, double end, const motion::Grid& rows,
                            const std::optional<model::WantedEvent>& section) {
    if (!section) {
        return run(question_.drive, start, end, rows, true, before.left == nullptr ? nullptr : before.left->carry);
    }
    model::Drive drive = question_.drive;
    drive.events.push_back(*section);
    const auto unwatched = [](const engine::Carry& carry) {  // removes the user's events, which other runs do not have
        auto copy = std::make_shared<engine::Carry>(carry);
        copy->watches.clear();
        return copy;
    };
    motion::Run result = run(drive, start, end, rows, true, unwatched(*before.left->carry));
    auto left = std::make_shared<engine::Left>(*result.left);
    left->carry = unwatched(*left->carry);
    result.left = std::move(left);
    return result;
}

motion::Run Runs::run(const model::Drive& drive, double start, double end, const motion::Grid& rows, bool dense,
                      std::shared_ptr<const engine::Carry> before) {
    motion::Limits limits;
    limits.dense = dense;
    const motion::Window window{start, end};
    const motion::Grid grid = rows.within(window).value();
    motion::Run result = engine::run({.system = system(),
                                      .drive = drive,
                                      .window = window,
                                      .rows = grid,
                                      .monitor = monitor_,
                                      .limits = limits,
                                      .before = std::move(before),
                                      .longest = question_.longest,
                                      .keeps_torques = grid.count() > 0});  // torques are shown with rows only
    if (result.contradiction) contradiction_ = result.contradiction;
    // A spring may overflow in a diverging motion; failures of functions have been reported already.
    const bool flew_away = result.outcome == model::Outcome::excitation_not_finite && question_.is_plain() &&
                           !question_.body.spring().none() && !question_.drive.M().has_feedback() &&
                           question_.drive.states.empty();
    if (flew_away) result.outcome = model::Outcome::state_not_finite;
    floor_ = result.left->carry->floor;
    return result;
}

FullState Runs::at_stop(const motion::Run& run) {
    return {vector_of(run.left->carry->y), HeldMode{run.left->carry->mode, run.left->carry->controllers}};
}

double Runs::natural_period() const {
    double longest = 0;
    for (const double period : system().natural_periods()) {
        if (std::isfinite(period)) longest = std::max(longest, period);
    }
    return longest;
}

Eigen::MatrixXd Runs::allowed(const HeldMode& mode, Index size) const {
    const Index n = bodies();
    std::vector<VectorXd> fixed;
    for (std::size_t j = 0; j < system().joints.size(); ++j) {
        const model::Joint& joint = system().joints[j];
        for (const Index from : {Index{0}, n}) {
            const bool riding = mode.mode.friction[j].riding;
            const bool holds = from == 0 ? mode.mode.keeps_place(j) : mode.mode.holds(j) || riding;
            if (!holds) continue;
            fixed.emplace_back(VectorXd::Zero(size));
            for (const auto& [body, by] : joint.of) fixed.back()[from + static_cast<Index>(body)] = by;
        }
    }
    if (fixed.empty()) return Eigen::MatrixXd::Identity(size, size);
    Eigen::MatrixXd across(size, static_cast<Index>(fixed.size()));
    for (std::size_t k = 0; k < fixed.size(); ++k) across.col(static_cast<Index>(k)) = fixed[k];
    const algebra::Basis basis = algebra::orthonormal_basis(across);
    return basis.columns.rightCols(size - basis.rank);
}

bool Chart::any_rotates() const {
    return std::ranges::any_of(from_, [](Index from) { return from >= 0; });
}

VectorXd Chart::measured(const VectorXd& y) const {
    VectorXd x = y;
    for (std::size_t i = 0; i < from_.size(); ++i) {
        if (from_[i] >= 0) x[static_cast<Index>(i)] -= y[from_[i]];
    }
    return x;
}

VectorXd Chart::state(const VectorXd& x, const VectorXd& there) const {
    VectorXd y = x;
    for (std::size_t i = 0; i < from_.size(); ++i) {
        if (from_[i] >= 0) y[static_cast<Index>(i)] += there[from_[i]];
    }
    return y;
}

double Chart::value(Index k, std::span<const double> y) const {
    const auto i = static_cast<std::size_t>(k);
    return i < from_.size() && from_[i] >= 0 ? y[i] - y[static_cast<std::size_t>(from_[i])] : y[i];
}

Returns::Returns(Runs& runs, const Chart& chart, double start, double length, const std::optional<Section>& section,
                 VectorXd units, VectorXd there)
    : runs_(runs),
      chart_(chart),
      start_(start),
      length_(length),
      section_(section),
      units_(std::move(units)),
      there_(std::move(there)) {
    for (Index k = 0; k < units_.size(); ++k) {
        if (chart.measures(k) && !(section && section->measured == k)) own_.push_back(k);
    }
    if (section) passage_ = passage(chart, *section, runs.system().named);
}

void Returns::hold(const std::vector<Index>& bodies) {
    held_ = bodies;
    const Index n = runs_.bodies();
    std::erase_if(own_, [&](Index k) { return k < 2 * n && std::ranges::find(held_, k % n) != held_.end(); });
}

VectorXd Returns::place(const VectorXd& y) const {
    return chart_.measured(y).cwiseQuotient(units_)(own_);
}

FullState Returns::full_state(const VectorXd& place, const std::optional<HeldMode>& mode) const {
    VectorXd x = chart_.measured(there_);
    for (std::size_t k = 0; k < own_.size(); ++k) x[own_[k]] = place[static_cast<Index>(k)] * units_[own_[k]];
    if (section_) x[section_->measured] = section_->place;
    FullState moment{chart_.state(x, there_), mode};
    for (const model::Joint& joint : runs_.system().joints) {
        double& theta = moment.y[static_cast<Index>(joint.first())];
        if (joint.walls && joint.of.size() == 1) theta = std::clamp(theta, joint.walls->lower, joint.walls->upper);
    }
    return moment;
}

Returns::Return Returns::operator()(const VectorXd& from, const std::optional<HeldMode>& mode, int returns) {
    Return sum{.to = from, .finished = true, .mode = mode};
    for (int i = 0; i < returns && sum.finished; ++i) once(full_state(sum.to, sum.mode), sum);
    return sum;
}

Returns::Return Returns::arrival(const FullState& from) {
    Return sum{.to = {}, .finished = true};
    once(from, sum);
    return sum;
}

std::optional<Map::Derivative> Returns::derivative(const VectorXd& at, const std::optional<HeldMode>& mode, int returns,
                                                   int order) {
    const Index n = at.size();
    Eigen::MatrixXd to_place = Eigen::MatrixXd::Zero(n, units_.size());
    for (Index k = 0; k < units_.size(); ++k) to_place.col(k) = place(VectorXd::Unit(units_.size(), k));
    const Eigen::MatrixXd allowed =
        mode ? runs_.allowed(*mode, units_.size()) : Eigen::MatrixXd::Identity(units_.size(), units_.size());
    Derivative found{Eigen::MatrixXd::Zero(n, n)};
    if (allowed.cols() == 0) return found;
    // An orthonormal basis of the allowed directions, within the section and in units of places.
    const algebra::Basis basis = algebra::orthonormal_basis(to_place * allowed);
    const double h = order == 2 ? 1e-5 : 3e-4;
    for (Index i = 0; i < basis.rank; ++i) {
        const VectorXd direction = basis.columns.col(i);
        struct Slope {
            VectorXd value;
            double bend;
            bool alike;  // whether the motions on both sides have the same events
        };
        const auto slope = [&](double step) -> std::optional<Slope> {
            const Return ahead = (*this)(at + step * direction, mode, returns);
            const Return behind = (*this)(at - step * direction, mode, returns);
            if (!ahead.finished || !behind.finished) return {};
            return Slope{(ahead.to - behind.to) / (2 * step), size_of_step(ahead.to + behind.to - 2 * at) / (2 * step),
                         ahead.events == behind.events};
        };
        constexpr double least = 3e-8, little = 0.01;
        const auto differ = [](const Slope& s) { return !s.alike && s.bend > little; };
        double step = h;
        std::optional<Slope> near = slope(step), far = order == 2 ? near : slope(2 * step);
        // Where the map is smooth, its slope hardly depends on the step. A kink of the map that only one of the two
        // sides reaches changes the slope, although both sides have the same events.
        constexpr double close = 1e-5, noise = 1e-12;
        const auto disagree = [&] {
            const VectorXd apart = near->value - far->value;
            return size_of_step(apart) > close * (1 + size_of_step(near->value)) + noise / step;
        };
        // If the events differ, a grazing, a stop or a switch lies between both sides.
        while (order != 2 && near && far && (differ(*near) || differ(*far) || disagree())) {
            step /= 10;
            if (step < least) return {};
            near = slope(step), far = slope(2 * step);
        }
        if (!near || !far) return {};
        found.bend = std::max({found.bend, near->bend, far->bend});
        const VectorXd value = order == 2 ? near->value : VectorXd((4 * near->value - far->value) / 3);
        found.by_place += value * direction.transpose();
    }
    return found;
}

void Returns::once(const FullState& from, Return& sum) {
    const motion::Run run = runs_.run(from, start_, start_ + length_, motion::Grid::none(), false, passage_);
    sum.outcome = run.outcome;
    sum.finished = section_ ? run.outcome == model::Outcome::stopped : model::is_whole(run.outcome);
    sum.time += run.t_stop - start_;
    if (!sum.finished) return;
    for (const model::Event& e : run.events) {
        if (e.kind != model::EventKind::user) sum.events.emplace_back(e.kind, e.where);
    }
    FullState at = Runs::at_stop(run);
    sum.mode = sign_ < 0 ? opposite(std::move(*at.mode)) : std::move(at.mode);
    sum.to = sign_ * place(at.y);
    sum.finished = sum.to.allFinite() &&
                   std::ranges::all_of(held_, [&](Index body) { return sign_ * at.y[body] == there_[body]; });
}

Reach reach_of(const motion::Run& run, const Chart& chart, int looks) {
    Reach reach;
    for (int i = 0; i <= looks; ++i) {
        const double part = static_cast<double>(i) / looks;
        const VectorXd x =
            chart.measured(vector_of(run.left->history->at(run.t_start + part * (run.t_stop - run.t_start))));
        reach.low = i == 0 ? x : VectorXd(reach.low.cwiseMin(x));
        reach.high = i == 0 ? x : VectorXd(reach.high.cwiseMax(x));
    }
    return reach;
}

Reach reach_of_rows(const motion::Run& run, const Chart& chart) {
    const auto n = static_cast<Index>(chart.bodies());
    Reach reach;
    VectorXd y(2 * n);
    for (std::size_t row = 0; row < run.rows.table().size(); ++row) {
        for (Index i = 0; i < n; ++i) {
            const std::size_t theta = 1 + engine::columns_of_body * static_cast<std::size_t>(i);
            y[i] = run.rows.table()(row, theta);
            y[n + i] = run.rows.table()(row, theta + 1);
        }
        const VectorXd x = chart.measured(y);
        if (row == 0) reach = {x, x};
        reach.low = reach.low.cwiseMin(x);
        reach.high = reach.high.cwiseMax(x);
    }
    // Events are included because turns may lie between the rows.
    for (const model::Event& event : run.events) {
        if (reach.low.size() == 0 || event.t < run.t_start || event.t > run.t_stop) continue;
        const VectorXd x = chart.measured(vector_of(run.left->history->at(event.t))).head(2 * n);
        reach.low.head(n) = reach.low.head(n).cwiseMin(x.head(n));
        reach.high.head(n) = reach.high.head(n).cwiseMax(x.head(n));
    }
    return reach;
}

Index widest_of(const Reach& reach, const Chart& chart, Index bodies) {
    const VectorXd range = reach.range();
    Index widest = -1;
    for (const Index from : {Index{0}, bodies}) {
        for (Index k = from; k < from + bodies && (widest < 0 || widest >= from); ++k) {
            const double most = std::max(std::fabs(reach.low[k]), std::fabs(reach.high[k]));
            if (!chart.measures(k) || !(range[k] > 1e-9 * most)) continue;
            if (widest < 0 || range[k] > range[widest]) widest = k;
        }
        if (widest >= 0) break;
    }
    return widest;
}

std::vector<BodyMotion> bodies_of(const motion::Run& run, const Chart& chart, const Reach& reach) {
    const std::vector<double> before = run.left->history->at(run.t_start);
    const auto n = static_cast<Index>(chart.bodies());
    std::vector<BodyMotion> bodies;
    for (Index i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double fastest = std::max(std::fabs(reach.low[n + i]), std::fabs(reach.high[n + i]));
        const double turned = chart.rotates(i) ? run.left->carry->y[k] - before[k] : 0;
        const bool turns = std::fabs(turned) > 1e-6 * (run.t_stop - run.t_start) * fastest;
        bodies.push_back({reach.low[i], reach.high[i], turns ? turned : 0, before[k]});
    }
    return bodies;
}

std::vector<BodyMotion> bodies_at(const VectorXd& y, const Chart& chart, Index n) {
    const VectorXd at = chart.measured(y);
    std::vector<BodyMotion> bodies;
    for (Index i = 0; i < n; ++i) bodies.push_back({at[i], at[i], chart.rotates(i) ? y[n + i] : 0, y[i]});
    return bodies;
}

std::vector<std::complex<double>> multipliers_of(const Eigen::MatrixXd& derivative) {
    const Eigen::VectorXcd values = algebra::eigenvalues(derivative);
    std::vector<std::complex<double>> sorted(values.data(), values.data() + values.size());
    std::ranges::sort(sorted, [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
    return sorted;
}

void note_family(SteadyMotion& motion) {
    if (distance_from_one(motion.multipliers) < neutral_within) motion.unique = false;
}

}  // namespace dinal::analysis
