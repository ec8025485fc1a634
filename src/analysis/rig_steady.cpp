#include "analysis/rig_steady.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/prose.hpp"
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

    RigMotion found() {
        search();
        answer_.facts = std::move(facts_);
        return std::move(answer_);
    }

private:
    bool tells(const Moment& moment, double start) override {
        const double period = facts_.period;
        constexpr double rows = 400;
        engine::AssemblyRun run = runs_.run(moment, start, start + period, motion::Grid::every(period / rows), true);
        if (!model::is_whole(run.outcome)) return false;
        tell_period(moment, std::move(run), period);
        return true;
    }

    void tell_settled(const engine::AssemblyRun& so_far) override {
        const double period = facts_.period, t = so_far.t_stop;
        constexpr double rows = 400;
        engine::AssemblyRun run = runs_.go_on(so_far.carry, t, t + period, motion::Grid::every(period / rows));
        if (model::is_whole(run.outcome)) tell_period(Runs::at_stop(so_far), std::move(run), period);
    }

    void tell_rest(const engine::AssemblyRun& run, bool stands) override {
        const Moment now = Runs::at_stop(run);
        const auto velocity = now.y.segment(n(), n());
        const bool moves = velocity.cwiseAbs().maxCoeff() > 1e-9 * largest_;
        if (moves && chart_.any_goes_round()) facts_.status = SteadyStatus::steady;
        if (stands) facts_.unique = false;
        answer_.rest.assign(now.y.data(), now.y.data() + n());
        answer_.drive = runs_.from(now);
        const Eigen::VectorXd measured = chart_.measured(now.y);
        answer_.low.assign(measured.data(), measured.data() + n());
        answer_.high = answer_.low;
        for (Eigen::Index i = 0; i < n(); ++i) answer_.turned.push_back(chart_.goes_round(i) ? velocity[i] : 0);
    }

    /// From this moment on the run is the motion.
    void tell_period(const Moment& from, engine::AssemblyRun run, double period) {
        const Reach reach = reach_of(run, chart_);
        constexpr double nothing = 1e-11;
        const bool moves = reach.range().head(2 * n()).maxCoeff() > nothing * largest_;
        const bool forced = question().repeats.period > 0;
        facts_.outcome = run.outcome;
        facts_.status = moves ? SteadyStatus::steady : forced ? SteadyStatus::adheres : SteadyStatus::rest;
        facts_.period = moves || forced ? period : 0;
        facts_.stable = true;
        answer_.drive = runs_.from(from);
        answer_.run = std::move(run);
        answer_.low.assign(reach.low.data(), reach.low.data() + n());
        answer_.high.assign(reach.high.data(), reach.high.data() + n());
        answer_.rest.assign(from.y.data(), from.y.data() + n());
        const std::vector<double>& after = answer_.run.carry->y;
        for (Eigen::Index i = 0; i < n(); ++i) {
            const double fastest = std::max(std::fabs(reach.low[n() + i]), std::fabs(reach.high[n() + i]));
            const double turned = chart_.goes_round(i) ? after[static_cast<std::size_t>(i)] - from.y[i] : 0;
            answer_.turned.push_back(std::fabs(turned) > 1e-6 * period * fastest ? turned : 0);
        }
    }

    RigMotion answer_;
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
    const bool alone = known.facts.unique.has_value() && known.facts.status == SteadyStatus::steady;
    if (!known.facts.is_found() || alone) return others;
    const std::size_t n = question.system->bodies.size();
    const auto stands = [](const RigMotion& motion) {
        return motion.facts.status == SteadyStatus::adheres || motion.facts.status == SteadyStatus::rest;
    };
    double size = 1e-300;
    for (std::size_t i = 0; i < n; ++i) {
        const double speed = known.facts.period == 0 ? std::fabs(known.turned[i]) : 0;
        size = std::max({size, known.high[i] - known.low[i], std::fabs(known.high[i]), std::fabs(known.low[i]), speed});
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
            const double turned = std::fabs(a.turned[i]);
            equal = equal && std::fabs(ways_a - ways_b) <= 1e-4 * size && std::fabs(ends_a - ends_b) <= 1e-4 * size &&
                    std::fabs(a.turned[i] - b.turned[i]) <= 1e-4 * turned;
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

namespace {

class RigSteadyStory : protected SteadyProse {
public:
    std::string told(const RigQuestion& question, const RigMotion& motion, std::size_t others) {
        const SteadyMotion& facts = motion.facts;
        const bool timeless = question.repeats.period == 0;
        switch (facts.status) {
            case SteadyStatus::steady:
                if (facts.period == 0) return "All bodies rotate at constant speed.";
                tell_period(facts, timeless);
                tell_bodies(question, motion);
                break;
            case SteadyStatus::adheres:
                say("Nothing moves: over a period M never exceeds what friction can hold.");
                break;
            case SteadyStatus::rest:
                say("The motion dies out: all bodies come to rest.");
                break;
            case SteadyStatus::grows:
                tell_unbounded();
                return std::move(sentences_);
            case SteadyStatus::none:
                tell_none(facts, timeless);
                return std::move(sentences_);
        }
        tell_stability(facts);
        if (others > 0) {
            say("From other starts {} was seen.", text::counted(others, "other motion"));
        } else if (!facts.unique.has_value() && facts.status == SteadyStatus::steady) {
            say("8 other starts led to no other motion, which is no proof.");
        } else if (facts.unique.value_or(false)) {
            say("No other steady motion exists.");
        }
        return std::move(sentences_);
    }

private:
    void tell_bodies(const RigQuestion& question, const RigMotion& motion) {
        for (std::size_t i = 0; i < question.system->bodies.size(); ++i) {
            const std::string& name = question.system->bodies[i].name;
            const double size = std::max(std::fabs(motion.low[i]), std::fabs(motion.high[i]));
            if (motion.turned[i] != 0) {
                say("{} turns by {:.5g} in each period.", name, motion.turned[i]);
            } else if (question.system->named && motion.high[i] > motion.low[i]) {
                say("{} swings between {} and {}.", name, text::number_text(motion.low[i], size),
                    text::number_text(motion.high[i], size));
            }
        }
    }
};

}  // namespace

std::string told(const RigQuestion& question, const RigMotion& motion, std::size_t others) {
    return RigSteadyStory().told(question, motion, others);
}

}  // namespace dinal::analysis
