#include "analysis/rig_steady.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "algebra/decompositions.hpp"
#include "analysis/closed_search.hpp"
#include "analysis/steady_facts.hpp"
#include "model/controller.hpp"
#include "text/sentences.hpp"

namespace dinal::analysis {
namespace {

namespace engine = motion::engine;

bool has_acts(const engine::Drive& drive) {
    return std::any_of(drive.events.begin(), drive.events.end(),
                       [](const model::WantedEvent& event) { return event.act != nullptr; });
}

/// What of a moment is no number that may change a little.
struct RigMode {
    engine::Mode mode;
    std::vector<std::vector<engine::Signal::Memory>> controllers;

    friend bool operator==(const RigMode& a, const RigMode& b) {
        for (std::size_t j = 0; j < a.mode.friction.size(); ++j) {
            const engine::Slipping &x = a.mode.friction[j], &y = b.mode.friction[j];
            if (x.way != y.way || x.riding != y.riding) return false;
        }
        if (a.mode.leans != b.mode.leans) return false;
        for (std::size_t i = 0; i < a.controllers.size(); ++i) {
            for (std::size_t c = 0; c < a.controllers[i].size(); ++c) {
                if (a.controllers[i][c].on != b.controllers[i][c].on) return false;
            }
        }
        return true;
    }
};

/// Everything that decides how the motion goes on: all of y, and the mode; none at the very beginning.
struct RigMoment {
    Eigen::VectorXd y;
    std::optional<RigMode> mode = {};
};

class RigRuns {
public:
    RigRuns(const RigQuestion& question, const motion::Monitor& monitor) : question_(question), monitor_(monitor) {}

    [[nodiscard]] const RigQuestion& question() const { return question_; }
    [[nodiscard]] const model::Assembly& system() const { return *question_.system; }
    [[nodiscard]] Eigen::Index bodies() const { return static_cast<Eigen::Index>(system().bodies.size()); }
    [[nodiscard]] const std::optional<model::Contradiction>& contradiction() const { return contradiction_; }

    [[nodiscard]] RigMoment first() const {
        std::vector<double> y = question_.drive.theta0;
        y.insert(y.end(), question_.drive.velocity0.begin(), question_.drive.velocity0.end());
        for (const model::OwnState& state : question_.drive.states) y.push_back(state.start);
        for (const model::Joint& joint : system().joints) {
            if (joint.friction.bristle() != nullptr) y.push_back(0);
        }
        return {Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size()))};
    }

    /// The drive of a run that begins at this moment.
    [[nodiscard]] engine::Drive from(const RigMoment& moment) const {
        engine::Drive drive = question_.drive;
        const Eigen::Index n = bodies();
        for (Eigen::Index i = 0; i < n; ++i) {
            drive.theta0[static_cast<std::size_t>(i)] = moment.y[i];
            drive.velocity0[static_cast<std::size_t>(i)] = moment.y[n + i];
        }
        for (std::size_t k = 0; k < drive.states.size(); ++k) {
            drive.states[k].start = moment.y[2 * n + static_cast<Eigen::Index>(k)];
        }
        return drive;
    }

    engine::AssemblyRun run(const RigMoment& from, double start, double end, const motion::Grid& rows, bool dense,
                            const std::shared_ptr<model::UserFunction>& section = {}) {
        engine::Drive drive = this->from(from);
        if (section) {
            drive.events.push_back({.name = "", .when = section, .direction = model::Crossing::up, .stop = true});
        }
        std::shared_ptr<engine::Carry> before;
        if (from.mode) {
            before = std::make_shared<engine::Carry>();
            before->y.assign(from.y.data(), from.y.data() + from.y.size());
            before->mode = from.mode->mode, before->controllers = from.mode->controllers;
        }
        motion::Limits limits;
        limits.dense = dense;
        const motion::Window window{start, end};
        engine::AssemblyRun result =
            engine::run({system(), drive, window, rows.within(window).value(), monitor_, limits, before});
        if (result.contradiction) contradiction_ = result.contradiction;
        return result;
    }

    /// From where another run ended, with all that its controllers and delays remember; none: from the start.
    engine::AssemblyRun go_on(std::shared_ptr<const engine::Carry> before, double start, double end,
                              const motion::Grid& rows) {
        const motion::Window window{start, end};
        engine::AssemblyRun result = engine::run({system(), question_.drive, window, rows.within(window).value(),
                                                  monitor_, motion::Limits{}, std::move(before)});
        if (result.contradiction) contradiction_ = result.contradiction;
        return result;
    }

    static RigMoment at_stop(const engine::AssemblyRun& run) {
        const engine::Carry& carry = *run.carry;
        return {Eigen::Map<const Eigen::VectorXd>(carry.y.data(), static_cast<Eigen::Index>(carry.y.size())),
                RigMode{carry.mode, carry.controllers}};
    }

    /// Directions in which a moment may be disturbed without leaving its mode: orthonormal columns.
    [[nodiscard]] Eigen::MatrixXd allowed(const RigMode& mode, Eigen::Index size) const {
        const Eigen::Index n = bodies();
        std::vector<Eigen::VectorXd> fixed;
        for (std::size_t j = 0; j < system().joints.size(); ++j) {
            const model::Joint& joint = system().joints[j];
            for (const Eigen::Index from : {Eigen::Index{0}, n}) {
                const bool riding = mode.mode.friction[j].riding;
                const bool holds = from == 0 ? mode.mode.leans[j] != 0 : mode.mode.holds(j) || riding;
                if (!holds) continue;
                fixed.emplace_back(Eigen::VectorXd::Zero(size));
                fixed.back()[from + joint.first] = 1;
                if (joint.second >= 0) fixed.back()[from + joint.second] = -1;
            }
        }
        if (fixed.empty()) return Eigen::MatrixXd::Identity(size, size);
        Eigen::MatrixXd across(size, static_cast<Eigen::Index>(fixed.size()));
        for (std::size_t k = 0; k < fixed.size(); ++k) across.col(static_cast<Eigen::Index>(k)) = fixed[k];
        const algebra::Basis basis = algebra::orthonormal_basis(across);
        return basis.columns.rightCols(size - basis.rank);
    }

private:
    const RigQuestion& question_;
    const motion::Monitor& monitor_;
    std::optional<model::Contradiction> contradiction_;
};

/// How the state is measured where the motion returns: angles of bodies that go round are those from another body.
class Chart {
public:
    /// `from` of each body: the body from which its angle is measured; -1: the ground; itself: not at all.
    explicit Chart(std::vector<Eigen::Index> from) : from_(std::move(from)) {}

    [[nodiscard]] bool measures(Eigen::Index k) const {
        return k >= static_cast<Eigen::Index>(from_.size()) || from_[static_cast<std::size_t>(k)] != k;
    }
    [[nodiscard]] bool goes_round(Eigen::Index body) const { return from_[static_cast<std::size_t>(body)] >= 0; }
    [[nodiscard]] bool any_goes_round() const {
        return std::any_of(from_.begin(), from_.end(), [](Eigen::Index from) { return from >= 0; });
    }
    /// Of all of y: angles from another body where they are measured so, and 0 where not at all.
    [[nodiscard]] Eigen::VectorXd measured(const Eigen::VectorXd& y) const {
        Eigen::VectorXd x = y;
        for (std::size_t i = 0; i < from_.size(); ++i) {
            if (from_[i] >= 0) x[static_cast<Eigen::Index>(i)] -= y[from_[i]];
        }
        return x;
    }
    /// The reverse, for bodies from which others are measured at these angles.
    [[nodiscard]] Eigen::VectorXd state(const Eigen::VectorXd& x, const Eigen::VectorXd& there) const {
        Eigen::VectorXd y = x;
        for (std::size_t i = 0; i < from_.size(); ++i) {
            if (from_[i] >= 0) y[static_cast<Eigen::Index>(i)] += there[from_[i]];
        }
        return y;
    }
    [[nodiscard]] double value(Eigen::Index k, std::span<const double> y) const {
        const auto i = static_cast<std::size_t>(k);
        return i < from_.size() && from_[i] >= 0 ? y[i] - y[static_cast<std::size_t>(from_[i])] : y[i];
    }

private:
    std::vector<Eigen::Index> from_;
};

/// Passes zero where a measured number passes this place.
class PassageOfRig final : public model::UserFunction {
public:
    PassageOfRig(const Chart& chart, Eigen::Index measured, double place, bool named)
        : chart_(chart), measured_(measured), place_(place), named_(named) {}
    double value(double /*t*/, const model::State& state) override { return state.theta - place_; }
    double value_with(double /*t*/, const model::State& state, std::span<const double> states) override {
        if (named_) return chart_.value(measured_, states) - place_;
        return (measured_ == 0 ? state.theta : state.velocity) - place_;
    }

private:
    const Chart& chart_;
    Eigen::Index measured_;
    double place_;
    bool named_;
};

/// From one return of the motion to the next.
class RigReturns {
public:
    struct Return {
        Eigen::VectorXd to;
        double time = 0;
        bool finished = false;
        model::Outcome outcome = model::Outcome::reached_end;
        RigMode mode = {};
    };
    struct Section {
        Eigen::Index measured;
        double place;
    };

    RigReturns(RigRuns& runs, const Chart& chart, double start, double length, std::optional<Section> section,
               Eigen::VectorXd units, Eigen::VectorXd there)
        : runs_(runs),
          chart_(chart),
          start_(start),
          length_(length),
          section_(section),
          units_(std::move(units)),
          there_(std::move(there)) {
        for (Eigen::Index k = 0; k < units_.size(); ++k) {
            if (chart.measures(k) && !(section && section->measured == k)) own_.push_back(k);
        }
        if (section) {
            passage_ = std::make_shared<PassageOfRig>(chart, section->measured, section->place, runs.system().named);
        }
    }

    [[nodiscard]] Eigen::VectorXd place(const Eigen::VectorXd& y) const {
        return chart_.measured(y).cwiseQuotient(units_)(own_);
    }
    [[nodiscard]] RigMoment moment(const Eigen::VectorXd& place, const RigMode& mode) const {
        Eigen::VectorXd x = chart_.measured(there_);
        for (std::size_t k = 0; k < own_.size(); ++k) {
            x[own_[k]] = place[static_cast<Eigen::Index>(k)] * units_[own_[k]];
        }
        if (section_) x[section_->measured] = section_->place;
        return {chart_.state(x, there_), mode};
    }

    [[nodiscard]] Return operator()(const Eigen::VectorXd& from, const RigMode& mode, int returns = 1) {
        Return sum{.to = from, .finished = true, .mode = mode};
        for (int i = 0; i < returns && sum.finished; ++i) once(moment(sum.to, sum.mode), sum);
        return sum;
    }
    /// The first return after a moment that need not be one.
    [[nodiscard]] Return arrival(const RigMoment& from) {
        Return sum{.to = {}, .finished = true};
        once(from, sum);
        return sum;
    }

    /// D of the map of so many returns, by differences of this order in what the mode allows.
    [[nodiscard]] std::optional<Eigen::MatrixXd> derivative(const Eigen::VectorXd& at, const RigMode& mode, int returns,
                                                            int order) {
        const Eigen::Index n = at.size();
        Eigen::MatrixXd to_place = Eigen::MatrixXd::Zero(n, units_.size());
        for (Eigen::Index k = 0; k < units_.size(); ++k) {
            to_place.col(k) = place(Eigen::VectorXd::Unit(units_.size(), k));
        }
        // Orthonormal among places, of those directions that keep the section as well.
        const Eigen::MatrixXd allowed = kept(to_place * runs_.allowed(mode, units_.size()));
        Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n);
        const double h = order == 2 ? 1e-5 : 3e-4;
        for (Eigen::Index i = 0; i < allowed.cols(); ++i) {
            const Eigen::VectorXd direction = allowed.col(i);
            const auto slope = [&](double step) -> std::optional<Eigen::VectorXd> {
                const Return ahead = (*this)(at + step * direction, mode, returns);
                const Return behind = (*this)(at - step * direction, mode, returns);
                if (!ahead.finished || !behind.finished) return {};
                return (ahead.to - behind.to) / (2 * step);
            };
            const auto near = slope(h);
            const auto far = order == 2 ? near : slope(2 * h);
            if (!near || !far) return {};
            D += (order == 2 ? *near : Eigen::VectorXd((4 * *near - *far) / 3)) * direction.transpose();
        }
        return D;
    }

    [[nodiscard]] double start() const { return start_; }

private:
    static Eigen::MatrixXd kept(const Eigen::MatrixXd& directions) {
        const algebra::Basis basis = algebra::orthonormal_basis(directions);
        return basis.columns.leftCols(basis.rank);
    }

    void once(const RigMoment& from, Return& sum) {
        const engine::AssemblyRun run =
            runs_.run(from, start_, start_ + length_, motion::Grid::none(), false, passage_);
        sum.outcome = run.outcome;
        sum.finished = section_ ? run.outcome == model::Outcome::stopped : model::is_whole(run.outcome);
        sum.time += run.t_stop - start_;
        if (!sum.finished) return;
        RigMoment at = RigRuns::at_stop(run);
        sum.mode = std::move(*at.mode);
        sum.to = place(at.y);
        sum.finished = sum.to.allFinite();
    }

    RigRuns& runs_;
    const Chart& chart_;
    double start_, length_;
    std::optional<Section> section_;
    Eigen::VectorXd units_, there_;
    std::vector<Eigen::Index> own_;  // of all of y: what a place has
    std::shared_ptr<model::UserFunction> passage_;
};

/// How far one stretch of a run gets: of each measured number.
struct RigReach {
    Eigen::VectorXd low, high;
    [[nodiscard]] Eigen::VectorXd range() const { return high - low; }
};

class RigSearch {
public:
    RigSearch(const RigQuestion& question, const motion::Monitor& monitor)
        : question_(question), runs_(question, monitor), chart_(chart()) {}

    RigMotion found() {
        SteadyMotion& facts = answer_.facts;
        facts.period = question_.repeats.period;
        question_.settles > 0 ? settle() : question_.repeats.period > 0 ? forced() : cycle();
        if (runs_.contradiction()) {
            facts.contradiction = runs_.contradiction();
            facts.outcome = model::Outcome::not_a_function;
            facts.status = SteadyStatus::none;
        }
        return std::move(answer_);
    }

private:
    [[nodiscard]] Eigen::Index n() const { return runs_.bodies(); }

    /// Bodies between which nothing depends on where they are go round together.
    [[nodiscard]] Chart chart() {
        const model::Assembly& system = runs_.system();
        std::vector<Eigen::Index> part(static_cast<std::size_t>(n()));
        for (std::size_t i = 0; i < part.size(); ++i) part[i] = static_cast<Eigen::Index>(i);
        std::vector<bool> grounded(part.size(), false);
        const auto root = [&](Eigen::Index i) {
            while (part[static_cast<std::size_t>(i)] != i) i = part[static_cast<std::size_t>(i)];
            return i;
        };
        for (const model::Joint& joint : system.joints) {
            const bool asks = joint.stiffness != 0 || !joint.spring.none() || joint.walls.has_value();
            if (!asks || joint.second < 0) continue;
            const Eigen::Index a = root(joint.first), b = root(joint.second);
            part[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
        }
        for (const model::Joint& joint : system.joints) {
            const bool asks = joint.stiffness != 0 || !joint.spring.none() || joint.walls.has_value();
            if (asks && joint.second < 0) grounded[static_cast<std::size_t>(root(joint.first))] = true;
        }
        std::vector<Eigen::Index> from(part.size(), -1);
        for (Eigen::Index of = 0; of < n(); ++of) {
            if (root(of) != of || grounded[static_cast<std::size_t>(of)]) continue;
            Eigen::VectorXd shift = Eigen::VectorXd::Zero(runs_.first().y.size());
            for (Eigen::Index i = 0; i < n(); ++i) shift[i] = root(i) == of ? 1 : 0;
            if (!is_alike(shift)) continue;
            for (Eigen::Index i = 0; i < n(); ++i) {
                if (root(i) == of) from[static_cast<std::size_t>(i)] = of;
            }
        }
        return Chart(std::move(from));
    }

    /// A run from a start that is shifted is the same, shifted.
    [[nodiscard]] bool is_alike(const Eigen::VectorXd& shift) {
        constexpr double by = 0.73;
        const double start = question_.repeats.start, length = pace();
        RigMoment plain = runs_.first(), shifted = plain;
        shifted.y += by * shift;
        const auto end = [&](const RigMoment& from) {
            return RigRuns::at_stop(runs_.run(from, start, start + length, motion::Grid::none(), false)).y;
        };
        const Eigen::VectorXd off = end(shifted) - by * shift - end(plain);
        return off.cwiseAbs().maxCoeff() <= 1e-9 * std::max(1.0, plain.y.cwiseAbs().maxCoeff());
    }

    /// The period of M, or of the fastest body on the stiffness around it.
    [[nodiscard]] double pace() const {
        if (question_.repeats.period > 0) return question_.repeats.period;
        std::vector<double> stiffness(static_cast<std::size_t>(n()), 0);
        for (const model::Joint& joint : runs_.system().joints) {
            stiffness[static_cast<std::size_t>(joint.first)] += joint.stiffness;
            if (joint.second >= 0) stiffness[static_cast<std::size_t>(joint.second)] += joint.stiffness;
        }
        double slowest = 0;
        for (std::size_t i = 0; i < stiffness.size(); ++i) {
            slowest = std::max(slowest,
                               stiffness[i] > 0
                                   ? 2 * std::numbers::pi * std::sqrt(runs_.system().bodies[i].inertia / stiffness[i])
                                   : 0);
        }
        return slowest > 0 ? slowest : 1;
    }

    /// A stretch of the run; none when it failed, and the answer says how.
    std::optional<engine::AssemblyRun> stretch(const RigMoment& from, double start, double length, RigReach& reach) {
        engine::AssemblyRun run = runs_.run(from, start, start + length, motion::Grid::none(), true);
        SteadyMotion& facts = answer_.facts;
        facts.outcome = run.outcome;
        if (!model::is_whole(run.outcome) && run.outcome != model::Outcome::stopped) return {};
        reach = reach_of(run);
        constexpr double beyond = 1e100;
        if (reach.range().head(2 * n()).cwiseAbs().maxCoeff() < beyond) return run;
        facts.outcome = model::Outcome::state_not_finite;
        facts.status = SteadyStatus::grows;
        return {};
    }

    [[nodiscard]] RigReach reach_of(const engine::AssemblyRun& run) const {
        constexpr int looks = 512;
        RigReach reach;
        for (int i = 0; i <= looks; ++i) {
            const double part = static_cast<double>(i) / looks;
            const std::vector<double> y = run.history->at(run.t_start + part * (run.t_stop - run.t_start));
            const Eigen::VectorXd x =
                chart_.measured(Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size())));
            reach.low = i == 0 ? x : Eigen::VectorXd(reach.low.cwiseMin(x));
            reach.high = i == 0 ? x : Eigen::VectorXd(reach.high.cwiseMax(x));
        }
        return reach;
    }

    /// Units of places: never zero.
    [[nodiscard]] Eigen::VectorXd units_of(const RigReach& reach) const {
        Eigen::VectorXd units = reach.range();
        const Eigen::VectorXd most = reach.high.cwiseAbs().cwiseMax(reach.low.cwiseAbs());
        const double angles = std::max(units.head(n()).maxCoeff(), 1e-300);
        const double speeds = std::max(units.segment(n(), n()).maxCoeff(), 1e-300);
        for (Eigen::Index k = 0; k < units.size(); ++k) {
            if (units[k] > 1e-9 * most[k]) continue;
            units[k] = std::max(most[k], k < n() ? angles : k < 2 * n() ? speeds : 0.0);
            if (!(units[k] > 0)) units[k] = 1;
        }
        return units;
    }

    // ---- with a period

    void forced() {
        const double period = question_.repeats.period;
        // An act at the very beginning of a run would not happen: returns are looked at where nothing does.
        constexpr double nowhere = 0.3819660112501051;
        RigMoment now = runs_.first();
        double start = question_.repeats.start;
        RigReach reach;
        if (has_acts(question_.drive)) {
            const auto run = stretch(now, start, nowhere * period, reach);
            if (!run) return;
            now = RigRuns::at_stop(*run);
            start += nowhere * period;
        }
        auto first = stretch(now, start, period, reach);
        if (!first) return;
        now = RigRuns::at_stop(*first);
        std::vector<double> sizes{reach.range().head(n()).maxCoeff()};
        const int longest = question_.periods > 0 ? question_.periods : 32;
        for (const auto& counts : {std::vector<int>{3, 8, 24}, std::vector<int>{40, 120, 320}}) {
            RigReturns map(runs_, chart_, start, period, {}, units_of(reach), now.y);
            ClosedSearch<RigReturns> search(map, answer_.facts.maps, longest);
            const auto found = search.follow({.to = map.place(now.y), .finished = true, .mode = *now.mode}, counts);
            if (found && tells(map, *found)) return;
            if (search.failed()) {
                answer_.facts.outcome = *search.failed();
                if (answer_.facts.outcome == model::Outcome::state_not_finite) {
                    answer_.facts.status = SteadyStatus::grows;
                }
                return;
            }
            const auto& seen = search.seen();
            now = map.moment(seen.back().to, seen.back().mode);
            if (!stretch(now, start, period, reach)) return;
            sizes.push_back(reach.range().head(n()).maxCoeff());
        }
        if (sizes[2] > 1.3 * sizes[1] && sizes[1] > 1.1 * sizes[0]) {
            answer_.facts.status = SteadyStatus::grows;
            answer_.facts.growth = (sizes[2] - sizes[1]) / 640;
        }
    }

    // ---- with controllers that sample or wait

    /// Angles and velocities as they are measured, states, and what the controllers give. What they remember besides is
    /// not seen, so a motion must return twice.
    [[nodiscard]] Eigen::VectorXd seen_at(const engine::Carry& carry) const {
        std::vector<double> all(carry.y.size());
        Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size())) = chart_.measured(
            Eigen::Map<const Eigen::VectorXd>(carry.y.data(), static_cast<Eigen::Index>(carry.y.size())));
        for (const auto& controllers : carry.controllers) {
            for (const engine::Signal::Memory& memory : controllers) all.push_back(memory.output);
        }
        return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
    }

    /// The run itself goes on until it repeats itself.
    void settle() {
        constexpr int most_returns = 3000;
        constexpr std::size_t most_in_one = 64;
        constexpr double there = 1e-11, near = 1e-8;
        const double length = question_.settles, start = question_.repeats.start;
        SteadyMotion& facts = answer_.facts;
        std::shared_ptr<const engine::Carry> carry;
        std::vector<Eigen::VectorXd> seen;
        Eigen::VectorXd size;
        for (int k = 0; k < most_returns; ++k) {
            const double from = start + k * length;
            const engine::AssemblyRun run = runs_.go_on(carry, from, from + length, motion::Grid::none());
            ++facts.maps;
            facts.outcome = run.outcome;
            if (!model::is_whole(run.outcome)) {
                if (run.outcome == model::Outcome::state_not_finite) facts.status = SteadyStatus::grows;
                return;
            }
            carry = run.carry;
            seen.push_back(seen_at(*carry));
            const RigReach reach = reach_of(run);
            constexpr double beyond = 1e50;
            if (!(reach.range().head(2 * n()).maxCoeff() < beyond)) {
                facts.status = SteadyStatus::grows;
                return;
            }
            const Eigen::VectorXd now = units_of(reach);
            size = seen.back().cwiseAbs().cwiseMax(std::numeric_limits<double>::min());
            largest_ = std::max(largest_, reach.range().head(2 * n()).maxCoeff());
            constexpr double nothing = 1e-12;  // of what it was: it dies out
            size.head(now.size()) = now.cwiseMax(nothing * largest_);
            const auto off = [&](std::size_t last, std::size_t m) {
                return (seen[last] - seen[last - m]).cwiseQuotient(size).cwiseAbs().maxCoeff();
            };
            const std::size_t last = seen.size() - 1;
            const auto shortest = [&](std::size_t of) {  // what alternates comes back after two sooner than after one
                std::size_t m = 1;
                while (m < of && (of % m != 0 || off(last, m) > near)) ++m;
                return m;
            };
            for (std::size_t m = 1; m <= most_in_one && 2 * m + 1 <= last; ++m) {
                const double one = off(last, m), before = off(last - 1, m);
                // What comes no nearer any more is there as far as rounding lets it.
                const bool as_near = last > 20 + m && one <= near && one >= 0.5 * off(last - 20, m);
                if (!(one <= there && before <= there) && !as_near) continue;
                const double period = static_cast<double>(shortest(m)) * length, t = from + length;
                constexpr double rows = 400;
                engine::AssemblyRun settled = runs_.go_on(carry, t, t + period, motion::Grid::every(period / rows));
                if (!model::is_whole(settled.outcome)) return;
                facts.residual = one;
                facts.periods =
                    question_.repeats.period > 0 ? static_cast<int>(std::round(period / question_.repeats.period)) : 1;
                tell_period(RigRuns::at_stop(run).y, std::move(settled), period);
                return;
            }
        }
    }

    // ---- without

    void cycle() {
        const double base = pace(), start = question_.repeats.start;
        RigMoment now = runs_.first();
        double length = base, time = 0, largest = 0;
        std::size_t events = 0;
        std::vector<double> ranges;
        Eigen::VectorXd most_changed;
        constexpr int most_stretches = 40;
        for (int i = 0; i < most_stretches; ++i) {
            RigReach reach;
            const auto run = stretch(now, start, length, reach);
            if (!run) return;
            time += length;
            events += run->events.size();
            const Eigen::VectorXd range = reach.range();
            most_changed = i == 0 ? range : Eigen::VectorXd(most_changed.cwiseMax(range));
            largest = std::max({largest, reach.high.head(n()).cwiseAbs().maxCoeff(),
                                reach.low.head(n()).cwiseAbs().maxCoeff(), range.head(n()).maxCoeff()});
            ranges.push_back(range.head(n()).maxCoeff());
            now = RigRuns::at_stop(*run);
            if (rests(*run, range, most_changed)) return;
            if (closes_from(now, reach, length, i)) return;
            constexpr std::size_t many_events = 6000;
            if (events > many_events || time > 3000 * base) break;
            length *= 1.5;
        }
        const std::size_t last = ranges.size() - 1;
        if (last >= 2 && ranges[last] > 1.2 * ranges[last - 1] && ranges[last - 1] > 1.2 * ranges[last - 2]) {
            answer_.facts.status = SteadyStatus::grows;
        }
    }

    bool closes_from(const RigMoment& now, const RigReach& reach, double length, int i) {
        // The angle that changes most beside its size, or a velocity where no angle is measured.
        const Eigen::VectorXd range = reach.range();
        Eigen::Index widest = -1;
        for (const Eigen::Index from : {Eigen::Index{0}, n()}) {
            for (Eigen::Index k = from; k < from + n() && (widest < 0 || widest >= from); ++k) {
                const double most = std::max(std::fabs(reach.low[k]), std::fabs(reach.high[k]));
                if (!chart_.measures(k) || !(range[k] > 1e-9 * most)) continue;
                if (widest < 0 || range[k] > range[widest]) widest = k;
            }
            if (widest >= 0) break;
        }
        if (widest < 0) return false;
        constexpr double place = 0.42;  // off the middle, where many motions have an end of something
        const RigReturns::Section section{widest, reach.low[widest] + place * range[widest]};
        RigReturns map(runs_, chart_, question_.repeats.start, 3 * length, section, units_of(reach), now.y);
        const RigReturns::Return first = map.arrival(now);
        if (!first.finished) return false;
        ClosedSearch<RigReturns> search(map, answer_.facts.maps, 16);
        const std::vector<int> counts = i < 4 ? std::vector<int>{3, 6} : std::vector<int>{3, 8, 24, 60};
        const auto found = search.follow(first, counts);
        return found && tells(map, *found);
    }

    /// Nothing depends on the time: what stands, or goes round evenly, and leaves everything as it is, does so for
    /// ever.
    bool rests(const engine::AssemblyRun& run, const Eigen::VectorXd& range, const Eigen::VectorXd& most_changed) {
        const Eigen::VectorXd y = RigRuns::at_stop(run).y;
        const bool stands = run.outcome == model::Outcome::at_rest ||
                            (run.outcome == model::Outcome::stuck_at_end && question_.drive.states.empty());
        bool still = true;
        for (Eigen::Index k = 0; k < range.size(); ++k) {
            if (chart_.measures(k)) still = still && range[k] <= 1e-11 * std::max(most_changed[k], std::fabs(y[k]));
        }
        if (!stands && !still) return false;
        const bool moves = y.segment(n(), n()).cwiseAbs().maxCoeff() > 1e-9 * most_changed.segment(n(), n()).maxCoeff();
        SteadyMotion& facts = answer_.facts;
        facts.status = moves && chart_.any_goes_round() ? SteadyStatus::steady : SteadyStatus::rest;
        facts.period = 0;
        facts.stable = true;
        if (stands) facts.unique = false;
        answer_.rest.assign(y.data(), y.data() + n());
        answer_.drive = runs_.from({y});
        answer_.low = answer_.high = answer_.rest;
        for (Eigen::Index i = 0; i < n(); ++i) answer_.turned.push_back(chart_.goes_round(i) ? y[n() + i] : 0);
        return true;
    }

    /// The facts about a motion that closes; false when no run stays with it.
    bool tells(RigReturns& map, const Closed<RigMode>& found) {
        SteadyMotion& facts = answer_.facts;
        const auto D = map.derivative(found.x, found.mode, found.returns, 4);
        facts.maps += 4 * found.returns * static_cast<int>(found.x.size());
        std::vector<std::complex<double>> multipliers;
        if (D) {
            const Eigen::VectorXcd values = algebra::eigenvalues(*D);
            multipliers.assign(values.data(), values.data() + values.size());
            std::sort(multipliers.begin(), multipliers.end(),
                      [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
        }
        constexpr double slack = 1e-5;
        if (!multipliers.empty() && std::abs(multipliers.front()) > 1 + slack) return false;
        const bool forced = question_.repeats.period > 0;
        const double period = forced ? found.returns * question_.repeats.period : found.period;
        const RigMoment moment = map.moment(found.x, found.mode);
        constexpr double rows = 400;
        engine::AssemblyRun run =
            runs_.run(moment, map.start(), map.start() + period, motion::Grid::every(period / rows), true);
        if (!model::is_whole(run.outcome)) return false;
        facts.periods = forced ? found.returns : 1;
        facts.multipliers = std::move(multipliers);
        facts.differentiable = D.has_value();
        const bool neutral = !facts.multipliers.empty() && std::abs(facts.multipliers.front()) > 1 - neutral_within;
        if (neutral) facts.unique = false;
        facts.residual = found.residual;
        tell_period(moment.y, std::move(run), period);
        return true;
    }

    /// From this state on the run is the motion.
    void tell_period(const Eigen::VectorXd& from, engine::AssemblyRun run, double period) {
        SteadyMotion& facts = answer_.facts;
        const RigReach reach = reach_of(run);
        constexpr double nothing = 1e-11;
        const bool moves = reach.range().head(2 * n()).maxCoeff() > nothing * largest_;
        facts.outcome = run.outcome;
        facts.status = moves                          ? SteadyStatus::steady
                       : question_.repeats.period > 0 ? SteadyStatus::adheres
                                                      : SteadyStatus::rest;
        facts.period = moves || question_.repeats.period > 0 ? period : 0;
        facts.stable = true;
        answer_.drive = runs_.from({from});
        answer_.run = std::move(run);
        answer_.low.assign(reach.low.data(), reach.low.data() + n());
        answer_.high.assign(reach.high.data(), reach.high.data() + n());
        answer_.rest.assign(from.data(), from.data() + n());
        const Eigen::VectorXd after = RigRuns::at_stop(answer_.run).y;
        for (Eigen::Index i = 0; i < n(); ++i) {
            const double fastest = std::max(std::fabs(reach.low[n() + i]), std::fabs(reach.high[n() + i]));
            const double turned = chart_.goes_round(i) ? after[i] - from[i] : 0;
            answer_.turned.push_back(std::fabs(turned) > 1e-6 * period * fastest ? turned : 0);
        }
    }

    const RigQuestion& question_;
    RigRuns runs_;
    Chart chart_;
    RigMotion answer_;
    double largest_ = 0;  // how far any number went, where a run settles
};

/// All that drives a run as if it were one excitation, whose functions take y as states.
std::pair<model::Excitation, model::Extras> together(const RigQuestion& question) {
    const engine::Drive& drive = question.drive;
    model::Excitation all;
    for (const model::Excitation& load : drive.loads) all = all + load;
    for (const model::Joint& joint : question.system->joints) {
        const model::ContactFriction& friction = joint.friction;
        if (friction.sliding[0]) all = all + *friction.sliding[0];
        if (friction.holding[0]) all = all + *friction.holding[0];
        if (friction.normal) all = all + *friction.normal;
    }
    model::Extras extras;
    for (const model::Excitation& belt : drive.belts) extras.belt = extras.belt + belt;
    extras.base = drive.base;
    extras.events = drive.events;
    struct Still final : model::UserFunction {
        double value(double /*t*/, const model::State& /*state*/) override { return 0; }
    };
    if (question.system->named) {
        const auto still = std::make_shared<Still>();
        for (const auto* starts : {&drive.theta0, &drive.velocity0}) {
            for (const double start : *starts) extras.states.push_back({"", start, still});
        }
    }
    extras.states.insert(extras.states.end(), drive.states.begin(), drive.states.end());
    return {std::move(all), std::move(extras)};
}

}  // namespace

std::optional<Drive> drive_of(const RigQuestion& question) {
    const auto [all, extras] = together(question);
    return drive_of(all, extras, {question.drive.theta0.front(), question.drive.velocity0.front()});
}

std::optional<double> common_period(const RigQuestion& question) {
    double common = question.repeats.period;
    for (const model::Excitation& load : question.drive.loads) {
        for (const model::Component& component : load.components()) {
            const auto* sampled = model::controller_of<model::SampledController>(component);
            if (sampled == nullptr) continue;
            if (common == 0) common = sampled->every;
            const auto is_whole = [&](int times) {
                const double instants = times * common / sampled->every;
                return std::fabs(instants - std::round(instants)) <= 1e-9 * instants && instants > 0.5;
            };
            constexpr int most = 1000;
            int times = 1;
            while (times <= most && !is_whole(times)) ++times;
            if (times > most) return {};
            common *= times;
        }
    }
    return common > 0 ? std::optional(common) : std::nullopt;
}

std::optional<text::Error> not_periodic(const RigQuestion& question, const Drive& drive) {
    const auto [all, extras] = together(question);
    return not_periodic(all, extras, drive);
}

RigMotion steady_motion(const RigQuestion& question, const motion::Monitor& monitor) {
    return RigSearch(question, monitor).found();
}

std::vector<RigMotion> other_motions(const RigQuestion& question, const RigMotion& known,
                                     const motion::Monitor& monitor) {
    std::vector<RigMotion> others;
    if (known.facts.unique.has_value() && known.facts.status == SteadyStatus::steady) return others;
    const std::size_t n = question.system->bodies.size();
    const auto stands = [](const RigMotion& motion) {
        return motion.facts.status == SteadyStatus::adheres || motion.facts.status == SteadyStatus::rest;
    };
    double size = 1e-300;
    for (std::size_t i = 0; i < n; ++i) {
        size = std::max({size, known.high[i] - known.low[i], std::fabs(known.high[i]), std::fabs(known.low[i])});
        if (!stands(known)) continue;
        size = std::max({size, std::fabs(question.drive.theta0[i]), std::fabs(question.drive.velocity0[i])});
    }
    const auto same_motion = [&](const RigMotion& a, const RigMotion& b) {
        if (stands(a) && stands(b)) return true;
        if (a.facts.status != b.facts.status) return false;
        if (a.facts.status != SteadyStatus::steady) return true;
        bool equal = true;
        for (std::size_t i = 0; i < n; ++i) {
            const double ways_a = a.high[i] - a.low[i], ways_b = b.high[i] - b.low[i];
            const double ends_a = std::max(std::fabs(a.high[i]), std::fabs(a.low[i]));
            const double ends_b = std::max(std::fabs(b.high[i]), std::fabs(b.low[i]));
            equal = equal && std::fabs(ways_a - ways_b) <= 1e-4 * size && std::fabs(ends_a - ends_b) <= 1e-4 * size;
        }
        return equal;
    };
    const double period = known.facts.period > 0 ? known.facts.period : 2 * std::numbers::pi;
    constexpr int starts = 8;
    for (int s = 0; s < starts; ++s) {
        RigQuestion other = question;
        other.periods = 0;
        const double radius = 2.5 * size * std::exp2(-s);
        for (std::size_t i = 0; i < n; ++i) {
            const double turn = (0.3 + s) * std::numbers::pi / 2 + 2.4 * static_cast<double>(i);
            double& theta = other.drive.theta0[i];
            theta = radius * std::cos(turn);
            if (const auto& walls = question.system->joints[i].walls) {
                theta = std::clamp(theta, walls->lower, walls->upper);
            }
            other.drive.velocity0[i] = radius * std::sin(turn) * 2 * std::numbers::pi / period;
        }
        const auto crosses = [&](const model::Joint& joint) {
            if (!joint.walls || joint.second < 0) return false;
            return joint.walls
                ->crossed_by(other.drive.theta0[static_cast<std::size_t>(joint.first)] -
                             other.drive.theta0[static_cast<std::size_t>(joint.second)])
                .has_value();
        };
        if (std::any_of(question.system->joints.begin(), question.system->joints.end(), crosses)) {
            other.drive.theta0 = question.drive.theta0;
        }
        RigMotion found = steady_motion(other, monitor);
        if (found.facts.outcome == model::Outcome::interrupted) break;
        const auto is_it = [&](const RigMotion& seen) { return same_motion(seen, found); };
        if (found.facts.status == SteadyStatus::none || same_motion(known, found) ||
            std::any_of(others.begin(), others.end(), is_it)) {
            continue;
        }
        others.push_back(std::move(found));
    }
    return others;
}

std::string told(const RigQuestion& question, const RigMotion& motion, std::size_t others) {
    const SteadyMotion& facts = motion.facts;
    std::string text;
    const auto say = [&](std::string sentence) { text += (text.empty() ? "" : " ") + std::move(sentence); };
    const bool timeless = question.repeats.period == 0;
    switch (facts.status) {
        case SteadyStatus::steady:
            if (facts.period == 0) {
                say("All bodies rotate at constant speed.");
                return text;
            }
            say(timeless ? fmt::format("The motion is a limit cycle of period {:.6g}.", facts.period)
                         : fmt::format("The motion repeats itself every {:.6g}, {} of M.", facts.period,
                                       facts.periods == 1 ? "the period" : fmt::format("{} periods", facts.periods)));
            for (std::size_t i = 0; i < question.system->bodies.size(); ++i) {
                const double size = std::max(std::fabs(motion.low[i]), std::fabs(motion.high[i]));
                if (motion.turned[i] != 0) {
                    say(fmt::format("{} turns by {:.5g} in each period.", question.system->bodies[i].name,
                                    motion.turned[i]));
                } else if (question.system->named && motion.high[i] > motion.low[i]) {
                    say(fmt::format("{} swings between {} and {}.", question.system->bodies[i].name,
                                    text::number_text(motion.low[i], size), text::number_text(motion.high[i], size)));
                }
            }
            break;
        case SteadyStatus::adheres:
            say("Nothing moves: over a period M never exceeds what friction can hold.");
            break;
        case SteadyStatus::rest:
            say("The motion dies out: all bodies come to rest.");
            break;
        case SteadyStatus::grows:
            say("There is no steady motion: the amplitude grows without bound.");
            return text;
        case SteadyStatus::none:
            say(timeless
                    ? "No limit cycle was found: the motion is irregular, or it settles very slowly."
                    : fmt::format(
                          "No motion of up to 32 periods of M was found within {} periods: the motion is irregular, "
                          "or it settles very slowly.",
                          facts.maps));
            return text;
    }
    if (facts.differentiable) {
        double largest = 0;
        for (const std::complex<double>& value : facts.multipliers) largest = std::max(largest, std::abs(value));
        say(largest > 1 - 1e-6 ? "It is marginally stable: a disturbance neither grows nor decays."
            : largest < 1e-12
                ? "It is stable: a disturbance is gone after one period."
                : fmt::format("It is stable: {} of a disturbance remains after a period.", text::percent(largest)));
    }
    if (others > 0) {
        say(fmt::format("From other starts {} was seen.", text::counted(others, "other motion")));
    } else if (!facts.unique.has_value() && facts.status == SteadyStatus::steady) {
        say("8 other starts led to no other motion, which is no proof.");
    }
    return text;
}

}  // namespace dinal::analysis
