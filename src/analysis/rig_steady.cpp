#include "analysis/rig_steady.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/steady_facts.hpp"
#include "model/controller.hpp"

namespace dinal::analysis {
namespace {

namespace engine = motion::engine;

/// A run from a start that is shifted is the same, shifted.
bool is_alike(Runs& runs, const Eigen::VectorXd& shift, double length) {
    constexpr double by = 0.73;
    const double start = runs.question().repeats.start;
    Moment plain = runs.first(), shifted = plain;
    shifted.y += by * shift;
    const auto end = [&](const Moment& from) {
        return Runs::at_stop(runs.run(from, start, start + length, motion::Grid::none(), false)).y;
    };
    const Eigen::VectorXd off = end(shifted) - by * shift - end(plain);
    return off.cwiseAbs().maxCoeff() <= 1e-9 * std::max(1.0, plain.y.cwiseAbs().maxCoeff());
}

/// Bodies between which nothing depends on where they are go round together.
Chart chart_of(Runs& runs, double length) {
    const model::Assembly& system = runs.system();
    const Eigen::Index n = runs.bodies();
    std::vector<Eigen::Index> part(static_cast<std::size_t>(n));
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
    for (Eigen::Index of = 0; of < n; ++of) {
        if (root(of) != of || grounded[static_cast<std::size_t>(of)]) continue;
        Eigen::VectorXd shift = Eigen::VectorXd::Zero(runs.first().y.size());
        for (Eigen::Index i = 0; i < n; ++i) shift[i] = root(i) == of ? 1 : 0;
        if (!is_alike(runs, shift, length)) continue;
        for (Eigen::Index i = 0; i < n; ++i) {
            if (root(i) == of) from[static_cast<std::size_t>(i)] = of;
        }
    }
    return Chart(std::move(from));
}

/// Measures bodies that go round from each other.
Chart chart_of(const RigQuestion& question, const motion::Monitor& monitor) {
    Runs runs(question, monitor);
    const double natural = runs.natural_period();
    return chart_of(runs, question.repeats.period > 0 ? question.repeats.period : natural > 0 ? natural : 1);
}

class RigSearch final : public ReturnSearch {
public:
    RigSearch(const RigQuestion& question, const motion::Monitor& monitor)
        : ReturnSearch(question, chart_of(question, monitor), monitor) {}

    SteadyMotion found() {
        search();
        return std::move(facts_);
    }

private:
    std::optional<Eigen::VectorXd> tells(const Moment& moment, double start) override {
        const double period = facts_.period;
        constexpr double rows = 400;
        engine::AssemblyRun run = runs_.run(moment, start, start + period, motion::Grid::every(period / rows), true);
        if (!model::is_whole(run.outcome)) return {};
        return tell_period(moment, std::move(run), period);
    }

    std::optional<Eigen::VectorXd> tell_settled(const engine::AssemblyRun& so_far) override {
        const double period = facts_.period, t = so_far.t_stop;
        constexpr double rows = 400;
        engine::AssemblyRun run = runs_.go_on(so_far.carry, t, t + period, motion::Grid::every(period / rows));
        if (!model::is_whole(run.outcome)) return {};
        return tell_period(Runs::at_stop(so_far), std::move(run), period);
    }

    void tell_rest(const engine::AssemblyRun& run, bool stands) override {
        const Moment now = Runs::at_stop(run);
        const auto velocity = now.y.segment(n(), n());
        const bool moves = velocity.cwiseAbs().maxCoeff() > 1e-9 * largest_;
        if (moves && chart_.any_goes_round()) facts_.status = SteadyStatus::steady;
        if (stands) facts_.unique = false;
        const Eigen::VectorXd at = chart_.measured(now.y);
        for (Eigen::Index i = 0; i < n(); ++i) {
            facts_.bodies.push_back({at[i], at[i], chart_.goes_round(i) ? velocity[i] : 0, now.y[i]});
        }
    }

    /// From this moment on the run is the motion.
    std::optional<Eigen::VectorXd> tell_period(const Moment& from, engine::AssemblyRun run, double period) {
        const Reach reach = reach_of(run, chart_);
        constexpr double nothing = 1e-11;
        const bool moves = reach.range().head(2 * n()).maxCoeff() > nothing * largest_;
        const bool forced = question().repeats.period > 0;
        if (!moves && !forced && question().settles < 0) return {};  // no cycle: a run will tell how it ends
        facts_.outcome = run.outcome;
        facts_.status = moves ? SteadyStatus::steady : forced ? SteadyStatus::adheres : SteadyStatus::rest;
        facts_.period = moves || forced ? period : 0;
        facts_.stable = true;
        const std::vector<double>& after = run.carry->y;
        for (Eigen::Index i = 0; i < n(); ++i) {
            const double fastest = std::max(std::fabs(reach.low[n() + i]), std::fabs(reach.high[n() + i]));
            const double turned = chart_.goes_round(i) ? after[static_cast<std::size_t>(i)] - from.y[i] : 0;
            const bool turns = std::fabs(turned) > 1e-6 * period * fastest;
            facts_.bodies.push_back({reach.low[i], reach.high[i], turns ? turned : 0, from.y[i]});
        }
        const std::vector<double> middle = run.history->at(run.t_start + period / 2);
        auto whole = std::make_shared<PeriodOfBodies>();
        whole->drive = runs_.from(from), whole->run = std::move(run);
        facts_.of_bodies = std::move(whole);
        return vector_of(middle);
    }
};

}  // namespace

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

SteadyMotion steady_motion(const RigQuestion& question, const motion::Monitor& monitor) {
    return RigSearch(question, monitor).found();
}

std::vector<Other<RigQuestion>> other_motions(const RigQuestion& question, const SteadyMotion& known,
                                              const motion::Monitor& monitor) {
    const bool alone = known.unique.has_value() && known.status == SteadyStatus::steady;
    if (!known.is_found() || alone) return {};
    const std::size_t n = question.system->bodies.size();
    const auto farthest = [](const BodyMotion& body) { return std::max(std::fabs(body.high), std::fabs(body.low)); };
    double size = 1e-300;
    for (std::size_t i = 0; i < n; ++i) {
        const BodyMotion& body = known.bodies[i];
        const double speed = known.period == 0 ? std::fabs(body.turned) : 0;
        size = std::max({size, body.high - body.low, farthest(body), speed});
        if (!known.stands()) continue;
        size = std::max({size, std::fabs(question.drive.theta0[i]), std::fabs(question.drive.velocity0[i])});
    }
    const auto alike = [&](const SteadyMotion& a, const SteadyMotion& b) {
        if (a.stands() && b.stands()) return true;
        if (a.status != b.status) return false;
        const auto moves_alike = [&](const BodyMotion& x, const BodyMotion& y) {
            return std::fabs((x.high - x.low) - (y.high - y.low)) <= 1e-4 * size &&
                   std::fabs(farthest(x) - farthest(y)) <= 1e-4 * size &&
                   std::fabs(x.turned - y.turned) <= 1e-4 * std::fabs(x.turned);
        };
        return a.status != SteadyStatus::steady ||
               std::equal(a.bodies.begin(), a.bodies.end(), b.bodies.begin(), moves_alike);
    };
    const double period = known.period > 0 ? known.period : 2 * std::numbers::pi;
    std::vector<RigQuestion> questions(other_starts, question);
    for (int s = 0; s < other_starts; ++s) {
        RigQuestion& other = questions[static_cast<std::size_t>(s)];
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
            if (!joint.walls || joint.second < 0) return false;
            return joint.walls
                ->crossed_by(other.drive.theta0[static_cast<std::size_t>(joint.first)] -
                             other.drive.theta0[static_cast<std::size_t>(joint.second)])
                .has_value();
        };
        if (std::any_of(question.system->joints.begin(), question.system->joints.end(), crosses)) {
            other.drive.theta0 = question.drive.theta0;
        }
    }
    return others_from(questions, known, alike, monitor);
}

}  // namespace dinal::analysis
