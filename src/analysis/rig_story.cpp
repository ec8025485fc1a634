#include "analysis/rig_story.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/prose.hpp"
#include "analysis/stretches.hpp"
#include "motion/stillness.hpp"

namespace dinal::analysis {
namespace {

namespace engine = motion::engine;

class RigStory : protected Prose {
public:
    RigStory(const model::Assembly& system, const engine::Drive& drive, const engine::AssemblyRun& run,
             const std::vector<const motion::Trajectory*>& parts)
        : system_(system), drive_(drive), run_(run), parts_(parts) {}

    std::string told(const std::vector<Energy>& energies) {
        tell_setting();
        for (std::size_t j = 0; j < system_.joints.size(); ++j) {
            system_.is_link(j) ? tell_link(j) : tell_body(j);
        }
        if (!energies.empty()) tell_energy(energies);
        say("The run {} at t = {}.", run_.outcome == model::Outcome::reached_end ? "reached its end" : "ended",
            time(run_.t_stop));
        if (run_.outcome != model::Outcome::reached_end) add(" Outcome: {}.", motion::outcome_text(*parts_.front()));
        end_paragraph();
        return std::move(text_);
    }

private:
    [[nodiscard]] std::string time(double t) const { return text::time_text(t, run_.t_stop - run_.t_start); }
    [[nodiscard]] double lasted() const { return run_.t_stop - run_.t_start; }
    [[nodiscard]] const std::string& name(std::size_t joint) const { return system_.joints[joint].name; }

    void tell_setting() {
        const std::size_t n = system_.bodies.size(), links = system_.joints.size() - n;
        if (system_.named) {
            say("{} and {}, from t = {} to {}.", text::counted(n, "body"), text::counted(links, "link"),
                time(run_.t_start), time(run_.t_stop));
        }
        const auto names = [this](const std::vector<model::Excitation>& acting) {
            std::vector<std::string> list;
            for (std::size_t j = 0; j < acting.size(); ++j) {
                if (!acting[j].components().empty()) list.push_back(system_.named ? name(j) : "the body");
            }
            return list;
        };
        const auto driven = names(drive_.loads), belts = names(drive_.belts);
        const bool base = !drive_.base.components().empty();
        if (driven.empty()) {
            say("There is no M{}", belts.empty() && !base ? ": the motion is free." : ".");
        } else if (system_.named) {
            say("M acts on {}.", fmt::join(driven, " and "));
        }
        if (!belts.empty()) say("A belt moves under {}.", fmt::join(belts, " and "));
        if (base) say("The base moves.");
        end_paragraph();
    }

    /// The extremes of the angle on the way, its ends included.
    [[nodiscard]] std::pair<double, double> reach(const motion::Trajectory& part) const {
        double low = std::min(part.initial.theta, part.state_at_stop.theta);
        double high = std::max(part.initial.theta, part.state_at_stop.theta);
        const auto see = [&](double theta) { low = std::min(low, theta), high = std::max(high, theta); };
        for (const model::Event& e : part.events) see(e.theta);
        for (const model::Event& e : motion::turns_on_belt(part)) see(e.theta);
        return {low, high};
    }

    void tell_body(std::size_t j) {
        const motion::Trajectory& part = *parts_[j];
        const auto [low, high] = reach(part);
        const double size = std::max(std::fabs(low), std::fabs(high));
        const auto number = [size](double x) { return text::number_text(x, size); };
        const std::string who = system_.named ? name(j) : "The body";
        if (low == high) {
            say("{} never moved: it stayed at theta = {}.", who, number(low));
        } else if (low == std::min(part.initial.theta, part.state_at_stop.theta) &&
                   high == std::max(part.initial.theta, part.state_at_stop.theta)) {
            say("{} moved from theta = {} to {}.", who, number(part.initial.theta), number(part.state_at_stop.theta));
        } else {
            say("{} swung between theta = {} and {}, and ended at {}.", who, number(low), number(high),
                number(part.state_at_stop.theta));
        }
        if (low != high) {
            const double v = part.state_at_stop.velocity;
            v == 0 ? say("It was at rest at the end.") : say("At the end its velocity was {:.5g}.", v);
        }
        const bool belt = !drive_.belts[j].components().empty();
        tell_contact(j, belt ? "to its belt" : "to the ground");
        end_paragraph();
    }

    void tell_link(std::size_t j) {
        const model::Joint& joint = system_.joints[j];
        say("{} links {} and {}.", name(j), system_.bodies[static_cast<std::size_t>(joint.first)].name,
            system_.bodies[static_cast<std::size_t>(joint.second)].name);
        const motion::Trajectory& part = *parts_[j];
        const auto [low, high] = reach(part);
        const double size = std::max(std::fabs(low), std::fabs(high));
        say("Its angle was between {} and {}.", text::number_text(low, size), text::number_text(high, size));
        tell_contact(j, "together");
        end_paragraph();
    }

    /// How a contact held: in which spells, for how long. And the impacts at its walls.
    void tell_contact(std::size_t j, const char* to_what) {
        const model::ContactFriction& friction = system_.joints[j].friction;
        const auto all = stretches(*parts_[j]);
        if (!friction.none() && friction.bristle() == nullptr) {
            double stuck = 0, from = 0;
            std::size_t spells = 0;
            for (std::size_t i = 0; i < all.size(); ++i) {
                if (!all[i].stuck) continue;
                if (i == 0 || !all[i - 1].stuck) ++spells, from = all[i].from;
                stuck += all[i].lasts();
            }
            const bool still = all.back().stuck;
            if (spells == 0) {
                say("It slipped all the time.");
            } else if (stuck >= lasted()) {
                say("It was stuck {} all the time.", to_what);
            } else {
                say("It was stuck {} for {} of the time", to_what, text::percent(stuck / lasted()));
                spells == 1 ? add(", ") : add(", in {} spells, ", spells);
                if (still) {
                    add("since t = {} until the end.", time(from));
                } else {
                    spells == 1 ? add("from t = {}.", time(from)) : add("the last one from t = {}.", time(from));
                }
            }
        }
        std::size_t impacts = 0;
        double hardest = 0, when = 0;
        for (const model::Event& e : parts_[j]->events) {
            if (e.kind != model::EventKind::impact) continue;
            ++impacts;
            if (std::fabs(e.velocity) > std::fabs(hardest)) hardest = e.velocity, when = e.t;
        }
        if (impacts > 0) {
            say("There {} {}, the hardest at t = {} with a velocity of {:.5g}.", impacts == 1 ? "was" : "were",
                text::counted(impacts, "impact"), time(when), hardest);
        }
    }

    void tell_energy(const std::vector<Energy>& energies) {
        const Energy whole = sum_of(energies);
        if (!(whole.flow > 0)) return;
        struct Share {
            double value;
            std::string what;
        };
        std::vector<Share> given, taken;
        const auto of = [this](const char* what, std::size_t j) {
            return system_.named ? fmt::format("{} of {}", what, name(j)) : std::string(what);
        };
        const auto note = [&](double value, const std::string& what) {
            if (value > 0) given.push_back({value, what});
            if (value < 0) taken.push_back({-value, what});
        };
        for (std::size_t j = 0; j < energies.size(); ++j) {
            const Work& work = energies[j].total.work;
            note(work.input, of("M", j));
            note(work.base, system_.named ? "the base under " + name(j) : "the base");
            note(work.belt, of("the belt", j));
            note(-work.viscous, of("the damping", j));
            note(-work.dry, of("the friction", j));
            note(-work.impacts, of("the impacts", j));
        }
        note(whole.total.work.acts, "acts at events");
        note(-whole.total.change.kinetic - whole.total.change.spring, "stored energy");
        for (auto* list : {&given, &taken}) {
            std::sort(list->begin(), list->end(), [](const Share& a, const Share& b) { return a.value > b.value; });
            const double all = std::accumulate(list->begin(), list->end(), 0.0,
                                               [](double so_far, const Share& share) { return so_far + share.value; });
            std::string text;
            list->erase(std::remove_if(list->begin(), list->end(),
                                       [all](const Share& share) { return share.value < 1e-3 * all; }),
                        list->end());
            for (const Share& share : *list) {
                text += fmt::format("{}{} {:.5g}", text.empty() ? "" : ", ", share.what, share.value);
                if (list->size() > 1) text += fmt::format(" ({})", text::percent(share.value / all));
            }
            if (!text.empty()) say("{}: {}.", list == &given ? "Energy came from" : "Energy went to", text);
        }
        end_paragraph();
    }

    const model::Assembly& system_;
    const engine::Drive& drive_;
    const engine::AssemblyRun& run_;
    const std::vector<const motion::Trajectory*>& parts_;
};

}  // namespace

std::string explain(const model::Assembly& system, const engine::Drive& drive, const engine::AssemblyRun& run,
                    const std::vector<const motion::Trajectory*>& parts, const std::vector<Energy>& energies) {
    return RigStory(system, drive, run, parts).told(energies);
}

}  // namespace dinal::analysis
