#include "analysis/explain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "analysis/recurrence.hpp"
#include "model/excitation.hpp"
#include "model/laws/coulomb.hpp"
#include "model/laws/stribeck.hpp"
#include "model/sticking.hpp"
#include "motion/belt_slope.hpp"
#include "motion/engine/part.hpp"
#include "motion/stillness.hpp"
#include "text/words.hpp"

namespace dinal::analysis {
namespace {

constexpr std::size_t most_stops = 5;                   // the most stops that are all reported one by one
constexpr std::size_t first_stops = 2, last_stops = 2;  // numbers of first and last stops reported otherwise
constexpr std::size_t most_turns = 4, most_slides = 3;

constexpr const char* base_text =
    "The support accelerates by a: theta is relative to it, and the torque -I a acts on the mass.";

bool several(const RunToDescribe& whole) {
    return whole.system.joints.size() > 1;
}

bool covers_all_bodies(const RunToDescribe& whole) {
    return several(whole) && !whole.joint;
}

const model::Excitation& load_on(const RunToDescribe& whole, std::size_t joint) {
    return whole.drive.loads[joint];
}

/// A time scale: the natural period of an undisturbed joint, otherwise the shortest of the system.
double time_scale(const RunToDescribe& whole, const model::Oscillator& seen, bool undisturbed) {
    if (undisturbed) return seen.has_spring() ? seen.natural_period() : 1;
    const double shortest = whole.system.shortest_natural_period();
    const motion::Run& run = *whole.parts.front();
    return std::isfinite(shortest) ? shortest : run.t_stop - run.t_start;
}

/// Builds the text on one body or link, in sentences and paragraphs.
class Story : protected text::Prose {
public:
    /// The arguments must outlive the story. `seen` is the joint as a one-body system.
    Story(const RunToDescribe& whole, std::size_t joint, const model::Oscillator& seen)
        : whole_(whole),
          joint_(whole.system.joints[joint]),
          is_link_(whole.system.is_link(joint)),
          undisturbed_(!is_link_ && !whole.system.is_linked(joint)),
          run_(*whole.parts[joint]),
          system_(seen),
          excitation_(load_on(whole, joint)),
          belt_(whole.drive.belts[joint]),
          own_rule_(whole.method.own_rule()),
          stretches_(stretches(run_)),
          swings_(analysis::half_cycles(run_)),
          events_(events_of_motion(run_, whole.drive.events)),
          on_base_(!whole.drive.base.components().empty()),
          on_belt_(!belt_.components().empty() && !is_smooth()),
          steady_belt_(belt_.constant_from() <= run_.t_start),
          T0_(time_scale(whole, seen, undisturbed_)),
          constant_from_(excitation_.has_feedback() || on_base_ || on_belt_ || !knows_all_torques()
                             ? model::never
                             : excitation_.constant_from()) {
        for (const Stretch& s : stretches_) {
            if (s.stuck) stuck_ += s.lasts();
            if (s.stuck && s.begun_by) stops_.push_back(&s);
        }
        if ((stretches_.size() == 1 && stuck_ > 0) || (run_.on_belt && run_.course == nullptr))
            return;  // the turns are unknown
        const auto before = [](const model::Event& event, double t) { return event.t < t; };
        for (const Stretch& s : swings_) {
            half_cycles_ += s.stuck ? 0 : 1;
            if (!run_.on_belt || !s.ended_by) continue;
            const double near = 1e-9 * T0_;
            const auto end = run_.events.end(), next = std::lower_bound(run_.events.begin(), end, s.to - near, before);
            // otherwise the end is that event
            if (next == end || next->t > s.to + near) events_.push_back(*s.ended_by);
        }
        std::ranges::sort(events_, [&](const auto& a, const auto& b) { return before(a, b.t); });
    }

    std::string build_text() {
        if (joint_.rigid) return describe_rigid();
        if (!is_link_ && whole_.system.bodies[joint_.first()].moved) return describe_moved();
        describe_setting();
        describe_start();
        describe_counts();
        describe_sliders();
        describe_open();
        describe_slides();
        describe_turns();
        describe_stops();
        describe_end();
        return std::move(text_);
    }

private:
    bool named() const { return whole_.system.named; }
    std::string name_or(const char* otherwise) const { return named() ? joint_.name : otherwise; }
    /// Returns whether nothing rubs on the joint.
    bool is_smooth() const { return joint_.friction.none() && joint_.friction.sliders.empty(); }
    /// Returns whether all torques on a standing mass and its friction limit are known.
    bool knows_all_torques() const { return undisturbed_ && joint_.is_plain(); }
    std::string at(double t) const { return text::time_text(t, T0_); }
    /// The angle at the end of a stretch.
    [[nodiscard]] static std::string place(const Stretch& s) {
        return text::number_text(s.end.theta, std::max(std::fabs(s.begin.theta), std::fabs(s.end.theta)));
    }
    /// Returns whether a torque on a mass at rest equals the limit, within the accuracy of M, k theta and the time.
    bool at_limit(double torque, const model::Event& event) const {
        const double Re = limit(torque);
        const double known = Re + std::fabs(event.M) + system_.stiffness() * std::fabs(event.theta) +
                             std::fabs(system_.spring().torque(event.theta));
        const double late = std::numeric_limits<double>::epsilon() * std::fabs(event.t) / T0_;
        return std::fabs(std::fabs(torque) - Re) <= (1e-9 + 64 * late) * known;
    }

    /// M - k theta minus the torque of other springs, plus the effect of support and belt on a mass at rest.
    double pull(const model::Event& event) const { return pull_at(event.theta, event.M, event.t); }
    double pull_at(double theta, double M, double t) const {
        return std::fma(-system_.stiffness(), theta, M + around(t) - system_.spring().torque(theta));
    }
    /// The torque of a moving support and belt on a mass at rest, -I a - I vb' - C vb; limits from the right.
    double around(double t) const {
        double torque = on_base_ ? -system_.inertia() * whole_.drive.base.value_after(t) : 0;
        if (!on_belt_) return torque;
        const double rate = motion::belt_slope(belt_, t, motion::belt_stretch * T0_).rate;
        torque -= system_.damping() * motion::belt_from(belt_, t) + system_.inertia() * rate;
        return torque;
    }

    /// The value of Re that acts against a pull in this direction.
    double limit(double pull) const {
        return system_.friction().holding(pull < 0 ? model::Motion::backward : model::Motion::forward);
    }
    /// "|M - k theta| = 0.155 <= Re = 0.167"
    std::string reason(double pull) const {
        return fmt::format("|{}| = {}", pull_name(), text::against_limit(std::fabs(pull), limit(pull)));
    }
    std::string pull_name() const {
        std::string name = "M";
        if (on_base_) name += " - I a";
        if (on_belt_ && !steady_belt_) name += " - I vb'";
        if (on_belt_ && system_.damping() > 0) name += " - C vb";
        if (system_.spring().none() || system_.has_spring()) name += " - k theta";
        return name + (system_.spring().none() ? "" : " - spring");
    }
    /// Returns whether a wall carries the pull at this angle.
    bool at_wall(double theta) const {
        const auto& walls = system_.walls();
        return walls && (theta == walls->lower || theta == walls->upper);
    }
    void describe_surroundings() {
        if (on_base_ && !several(whole_)) say("{}", base_text);
        if (!belt_.components().empty() && is_smooth()) say("The belt has no effect, as there is no dry friction.");
        if (!on_belt_) return;
        if (steady_belt_) {
            say("{} rubs on a belt that moves with velocity vb = {:.5g}.", name_or("The mass"),
                motion::belt_from(belt_, run_.t_start));
        } else {
            say("{} rubs on a belt of velocity vb.", name_or("The mass"));
        }
    }

    std::string describe_moved() {
        const auto torque = run_.find("torque");
        say("{} is moved by its {}", joint_.name,
            whole_.system.bodies[joint_.first()].moved->by_angle ? "angle" : "velocity");
        if (torque && run_.size() > 0) {
            const auto column = run_.rows.col(*torque);
            add(", which takes torques from {:.5g} to {:.5g} at the rows", column.minCoeff(), column.maxCoeff());
        }
        add(".");
        end_paragraph();
        return std::move(text_);
    }

    std::string describe_rigid() {
        say("{} is rigid: it keeps the angle {} at {:.5g}.", joint_.name, whole_.system.angle_in_words(joint_),
            run_.initial.theta);
        const auto redundant = motion::engine::redundant_rigid(whole_.system);
        const auto own = static_cast<std::size_t>(&joint_ - whole_.system.joints.data());
        if (text::contains(redundant, own)) {
            say("It closes a loop of rigid links: the motion does not determine how they share their torques, so those "
                "with the least sum of squares are given.");
        }
        end_paragraph();
        return std::move(text_);
    }

    void describe_walls() {
        const model::Walls* walls = joint_.any_walls();
        if (walls == nullptr) return;
        const bool both = std::isfinite(walls->lower) && std::isfinite(walls->upper);
        say("{} at theta = {}", both ? "There are walls" : "There is a wall",
            both ? fmt::format("{:.5g} and {:.5g}", walls->lower, walls->upper)
                 : fmt::format("{:.5g}", std::isfinite(walls->lower) ? walls->lower : walls->upper));
        if (walls->is_elastic()) {
            add(" that push{} back with stiffness {:.5g} and damping {:.5g}.", both ? "" : "es", walls->stiffness,
                walls->damping);
        } else if (walls->restitution == 0) {
            add(", where an impact stops the mass.");
        } else {
            add("; an impact keeps {} of the speed.", text::percent(walls->restitution));
        }
    }

    void describe_impacts() {
        std::size_t impacts = 0;
        const model::Event *first = nullptr, *hardest = nullptr;
        for (const model::Event& event : run_.events) {
            if (event.kind != model::EventKind::impact) continue;
            ++impacts;
            if (first == nullptr) first = &event;
            if (hardest == nullptr || std::fabs(event.velocity) > std::fabs(hardest->velocity)) hardest = &event;
        }
        if (impacts == 0) return;
        say("It hit {} {}, first at t = {}",
            std::isfinite(joint_.any_walls()->lower) && std::isfinite(joint_.any_walls()->upper) ? "the walls"
                                                                                                 : "the wall",
            text::counted(impacts, "time"), at(first->t));
        add("; the hardest impact had velocity {:.5g}, at t = {}.", hardest->velocity, at(hardest->t));
    }

    std::string slip_from_wall(const model::Event& event) const {
        if (!knows_all_torques()) return "it left the wall";
        const char* way = event.theta == system_.walls()->upper ? "backward" : "forward";
        if (system_.friction().none()) return fmt::format("{} pulled it off the wall {}", pull_name(), way);
        return fmt::format("{} pulled it off the wall {} with more than Re = {:.5g}", pull_name(), way,
                           system_.friction().holding(*way == 'b' ? model::Motion::backward : model::Motion::forward));
    }

    /// Returns whether M is constant throughout the run.
    bool free() const { return constant_from_ <= run_.t_start; }

    // ---- beginning and course

    void describe_setting() {
        const std::string who = name_or("The system");
        const std::string friction = " and " + friction_text() + ".";
        if (!undisturbed_) {
            describe_numbers();
        } else if (system_.has_linear_spring()) {
            say("{} has T0 = {:.5g}, zeta = {:.4g} ({}){}", who, T0_, system_.damping_ratio(),
                model::name(system_.regime()), friction);
        } else if (system_.has_spring()) {
            say("{} has a second spring besides k theta (T0 = {:.5g} and zeta = {:.4g} are for k alone){}", who, T0_,
                system_.damping_ratio(), friction);
        } else {
            say("{} is a block {}", who, system_.spring().none() ? "without a spring" : "on a nonlinear spring");
            add(", with ");
            if (system_.damping() > 0) add("viscous damping C = {:.5g} and ", system_.damping());
            add("{}.", friction_text());
        }
        describe_law();
        describe_walls();
        if (!covers_all_bodies(whole_) && !system_.units().usual()) say("Units: {}.", system_.units().in_words());
        if (!is_link_) describe_load();
        describe_surroundings();
        if (own_rule_) say("{}", own_rule_->setting);
        end_paragraph();
    }

    /// Describes T0 and zeta; links and linked bodies have none of their own.
    void describe_numbers() {
        std::string numbers;
        const auto number = [&](const char* name, double value) {
            if (value > 0) numbers += fmt::format("{}{} = {:.5g}", numbers.empty() ? "" : ", ", name, value);
        };
        if (is_link_) {
            if (joint_.is_difference()) {
                say("{} links {} and {}.", joint_.name, whole_.system.bodies[joint_.of[0].body].name,
                    whole_.system.bodies[joint_.of[1].body].name);
            } else {
                say("The angle of {} is {}.", joint_.name, whole_.system.angle_in_words(joint_));
            }
        } else {
            number("I", system_.inertia());
        }
        number("k", joint_.stiffness), number("C", joint_.damping);
        if (!joint_.spring.none()) numbers += numbers.empty() ? "a nonlinear spring" : ", a nonlinear spring";
        say("{} has {}{}{}.", is_link_ ? "It" : joint_.name, numbers, numbers.empty() ? "" : " and ", friction_text());
    }

    void describe_load() {
        const double period = model::period_from(excitation_, run_.t_start);
        if (excitation_.components().empty()) {
            if (!several(whole_)) say("There is no M{}", on_base_ || on_belt_ ? "." : ": the motion is free.");
        } else if (excitation_.has_feedback()) {
            say("M is a feedback: it depends on the motion.");
        } else if (excitation_.constant_from() <= run_.t_start) {
            say("M is constant{}",
                free() && system_.has_linear_spring() ? ": the motion is free, about theta = M/k." : ".");
        } else if (period > 0) {
            say("M has the period {:.5g}", period);
            if (undisturbed_ && system_.has_spring()) add(" ({:.4g} T0)", period / T0_);
            add(".");
        } else if (constant_from_ < run_.t_stop) {
            say("M is constant from t = {} on.", at(constant_from_));
        }
    }

    std::string friction_text() const {
        const model::Friction& law = joint_.friction.law;
        const bool stribeck = law.as<model::laws::Stribeck>() != nullptr;
        const auto Rd = [&](model::Motion way) { return stribeck ? law.kinetic() : law.sliding(way, 0); };
        const auto Re = [&](model::Motion way) { return law.holding(way); };
        using enum model::Motion;
        if (joint_.friction.bending() != nullptr) return "friction of bristles, which neither stick nor slip";
        if (law.is_one_way()) return fmt::format("a freewheel with Rd = {:.5g}", Rd(forward));
        if (!joint_.friction.sliders.empty()) {
            return fmt::format("{} behind springs{}", text::counted(joint_.friction.sliders.size(), "dry slider"),
                               law.none() ? "" : " beside dry friction");
        }
        if (!joint_.friction.is_constant()) return "dry friction that varies";
        if (law.none()) return "no dry friction";
        if (Rd(forward) != Rd(backward) || Re(forward) != Re(backward)) {
            return fmt::format(
                "dry friction: Rd = {:.5g} while sliding forward and {:.5g} backward; breakaway takes Re = {:.5g} "
                "forward and {:.5g} backward",
                Rd(forward), Rd(backward), Re(forward), Re(backward));
        }
        if (Rd(forward) == Re(forward)) return fmt::format("dry friction Rd = Re = {:.5g}", Rd(forward));
        return fmt::format("dry friction: Rd = {:.5g} while sliding, Re = {:.5g} to break away", Rd(forward),
                           Re(forward));
    }

    void describe_law() {
        const model::Friction& law = system_.friction();
        if (!joint_.friction.is_constant()) return;
        if (law.normal() != 1 && !law.none()) say("These are the torques under the normal load {:.5g}.", law.normal());
        if (!law.depends_on_speed()) return;
        say("{}", law.as<model::laws::Stribeck>() != nullptr
                      ? "Friction falls from Re at rest to Rd at high speed."
                      : "These values hold near speed zero: friction depends on the speed.");
    }

    void describe_start() {
        const model::State& y = run_.initial;
        const Stretch& first = stretches_.front();
        say("{} started at t = {} from theta = {:.5g} with velocity {:.5g}", name_or("The mass"), at(run_.t_start),
            y.theta, y.velocity);
        const bool known = knows_all_torques() && run_.size() > 0 && run_.column(motion::Column::t)[0] == run_.t_start;
        const bool stands = first.stuck || motion::belt_from(belt_, run_.t_start) == 0;
        const bool has_torque =
            y.velocity == 0 && stands && !system_.friction().none() && !own_rule_ && known && first.lasts() > 0;
        if (first.stuck && first.lasts() > 0) {
            add(" and stuck {}", is_link_ ? "together" : on_belt_ && !at_wall(y.theta) ? "to the belt" : "there");
        }
        if (has_torque && first.stuck && at_wall(y.theta)) {
            add(" at the wall");
        } else if (has_torque) {
            const double torque = pull_at(y.theta, run_.column(motion::Column::M)[0], run_.t_start);
            const double Re = limit(torque);
            if (!first.stuck && std::fabs(torque) <= Re) {  // at its limit it moves off as the torque increases
                add(" and moved off because |{}| exceeded Re = {:.5g}", pull_name(), Re);
            } else {
                add("{} because {}", first.stuck ? "" : " and moved off", reason(torque));
            }
        }
        if (first.stuck && first.ended_by && !(first.lasts() > 0)) {
            add("; {} at once.", slip(*first.ended_by, has_torque));
        } else if (first.stuck && first.ended_by) {
            add("{} until t = {}, when {}.", has_torque ? "," : "", at(first.to), slip(*first.ended_by, has_torque));
        } else {
            add(".");
        }
        if (first.stuck && !first.ended_by) {
            const bool carried = is_link_ || (on_belt_ && !at_wall(y.theta));
            say("Nothing {}{} it{} until the end of the run, t = {}.", run_.gap > 0 ? "that was seen " : "",
                carried ? "made" : "moved", carried ? " slip" : "", at(run_.t_stop));
            describe_stillness();
        }
        end_paragraph();
    }

    void describe_counts() {
        if (half_cycles_ == 0 || stretches_.back().to == run_.t_start) return;
        if (run_.events.empty() && swings_.size() == 1) {
            const model::State &begin = run_.initial, &end = run_.state_at_stop;
            const double rounded = 64 * std::numeric_limits<double>::epsilon() * std::fabs(begin.theta);
            const bool stayed =
                begin.velocity == 0 && motion::stands_at_stop(run_) && std::fabs(begin.theta - end.theta) <= rounded;
            // A linked body that starts from rest may stand until a contact closes.
            const bool may_stand = !undisturbed_ && begin.velocity == 0;
            say("{}", stayed      ? "It stayed there: M and the spring are in balance."
                      : may_stand ? "It moved in one direction."
                                  : "It moved in one direction all the time.");
            return;
        }
        const auto turns = static_cast<std::size_t>(std::ranges::count_if(
            swings_, [](const Stretch& s) { return s.ended_by && s.ended_by->kind == model::EventKind::turn; }));
        say("It made {} with {} and {}", text::counted(half_cycles_, "half cycle"), text::counted(turns, "turn"),
            text::counted(stops_.size(), "stop"));
        if (stuck_ > 0) {
            const double all = run_.t_stop - run_.t_start;
            add("; it was stuck for {} of {} {} ({})", at(stuck_), at(all), system_.units().times(),
                text::percent(stuck_ / all));
        }
        add(".");
        describe_impacts();
    }

    /// Describes open contacts.
    void describe_open() {
        const double open = time_open(run_), all = run_.t_stop - run_.t_start;
        if (open >= all && all > 0) {
            say("It was open all the time.");
        } else if (open > 0) {
            say("It was open for {} of the time.", text::percent(open / all));
        }
    }

    /// Counts the events of dry sliders behind springs, which are not events of the mass.
    void describe_sliders() {
        const auto count = [this](model::EventKind kind) {
            const auto is = [kind](const model::Event& event) { return event.kind == kind; };
            return static_cast<std::size_t>(std::ranges::count_if(run_.events, is));
        };
        const std::size_t sliders = joint_.friction.sliders.size(), slips = count(model::EventKind::slider_slips);
        if (sliders == 0) return;
        const std::string who = sliders == 1 ? "Its slider" : "Its sliders";
        if (slips == 0) {
            say("{} never slipped.", who);
            return;
        }
        say("{} slipped {} and stuck again {}.", who, text::counted(slips, "time"),
            text::counted(count(model::EventKind::slider_sticks), "time"));
    }

    /// Describes motions along a surface on which M, a spring or the rate of a state jumps.
    void describe_slides() {
        using enum model::EventKind;
        std::size_t n = 0;
        double from = run_.t_start, begun = run_.initial.theta, all = 0;
        bool slides = false, any = false;
        std::vector<std::string> may_jump;
        const auto reads = [](const model::Excitation& M) { return M.has_script(); };
        if (std::ranges::any_of(whole_.drive.loads, reads)) may_jump.emplace_back("M");
        const auto sprung = [](const model::Joint& joint) { return !joint.spring.none(); };
        if (std::ranges::any_of(whole_.system.joints, sprung)) may_jump.emplace_back("a spring");
        if (!whole_.drive.states.empty()) may_jump.emplace_back("the rate of a state");
        const auto add_slide = [&](double to, double theta, const std::string& why) {
            all += to - from, ++n;
            if (n > most_slides) return;
            constexpr double still = 1e-9;
            const auto [low, high] = reach();
            const std::string what = fmt::format("{}", fmt::join(may_jump, " or "));
            if (std::fabs(theta - begun) <= still * std::max(std::fabs(low), std::fabs(high))) {
                say("From t = {} to {} it stood at theta = {}: {} jumps there and drives it back from both sides{}.",
                    at(from), at(to), text::number_text(theta, high - low), what, why);
            } else {
                say("From t = {} to {} it slid along a surface on which {} jumps and drives it back from both sides{}.",
                    at(from), at(to), what, why);
            }
        };
        for (const model::Event& event : run_.events) {
            if (event.kind == slide_begins) from = event.t, begun = event.theta, slides = true;
            if (event.kind == slide_ends && (slides || !any)) {
                const bool stops = std::ranges::any_of(run_.events, [&](const model::Event& other) {
                    return other.t == event.t && (other.kind == stick || other.kind == rest || other.kind == impact);
                });
                add_slide(event.t, event.theta,
                          stops ? "; then a contact or a wall stopped it" : "; then one side no longer did");
                slides = false;
            }
            any = any || event.kind == slide_begins || event.kind == slide_ends;
        }
        if (slides) add_slide(run_.t_stop, run_.state_at_stop.theta, ", until the run ended");
        if (n > most_slides) say("There were {} such slides, which lasted {} in all.", n, at(all));
    }

    void describe_turns() {
        if (!undisturbed_) {
            describe_reach();
            return;
        }
        std::string places;
        std::size_t n = 0;
        for (const Stretch& s : stretches_) {
            if (!s.ended_by || s.ended_by->kind != model::EventKind::turn) continue;
            if (n < most_turns) places += fmt::format("{}{} (t = {})", n == 0 ? "" : ", ", place(s), at(s.to));
            ++n;
        }
        if (n > 0)
            say("{} at theta = {}{}", on_belt_ ? "The sliding reversed" : "It turned", places,
                n > most_turns ? " ..." : ".");
        describe_decay();
        end_paragraph();
    }

    /// The least and the greatest angle.
    std::pair<double, double> reach() const {
        double low = run_.initial.theta, high = low;
        for (const Stretch& swing : swings_) {
            low = std::min(low, swing.end.theta), high = std::max(high, swing.end.theta);
        }
        return {low, high};
    }

    /// Describes only the range if links disturb the turns.
    void describe_reach() {
        const auto [low, high] = reach();
        const double size = std::max(std::fabs(low), std::fabs(high));
        if (low < high) {
            say("theta was between {} and {}.", text::number_text(low, size), text::number_text(high, size));
        }
        end_paragraph();
    }

    /// Compares the turns of a free motion with its closed form.
    void describe_decay() {
        const bool swung = stretches_.size() > 1 && stretches_[1].begun_by->kind == model::EventKind::turn;
        const bool closed_form = system_.friction().none() || system_.friction().as<model::laws::Coulomb>() != nullptr;
        if (!free() || !knows_all_torques() || own_rule_ || !swung || !closed_form || !system_.has_linear_spring())
            return;
        decay_described_ = true;
        const double zeta = system_.damping_ratio(), step = 2 * system_.kinetic_friction() / system_.stiffness();
        const double factor = zeta < 1 ? std::exp(-std::numbers::pi * zeta / std::sqrt(1 - zeta * zeta)) : 0;
        if (zeta >= 1) {
            say("With zeta >= 1 it turns at most once and then creeps.");
        } else if (zeta == 0 && step == 0) {
            say("Without damping and friction every swing is as wide as the first.");
        } else if (zeta == 0) {
            say("Each extreme is 2 Rd/k = {:.5g} smaller than the one before: under dry friction the amplitude falls "
                "linearly, so the motion ends.",
                step);
        } else if (step == 0) {
            say("Each extreme is {:.5g} = exp(-pi zeta/sqrt(1 - zeta^2)) times the one before: under viscous damping the "
                "amplitude falls exponentially, {}.",
                factor, system_.friction().none() ? "so the motion never quite ends" : "until friction holds the mass");
        } else {
            say("Half a cycle takes an extreme X to qX - (1 + q)Rd/k with q = exp(-pi zeta/sqrt(1 - zeta^2)) = {:.5g} "
                "and Rd/k = {:.5g}: viscous damping removes a fraction of the amplitude, dry friction a fixed amount, "
                "which ends the motion.",
                factor, step / 2);
        }
    }

    void describe_stops() {
        const std::size_t n = stops_.size();
        for (std::size_t i = 0; i < n; ++i) {
            if (n > most_stops && i == first_stops) {
                i = n - last_stops;
                say("... {} more ...", i - first_stops);
                end_paragraph();
            }
            describe_stop(*stops_[i]);
        }
    }

    void describe_stop(const Stretch& stop) {
        const model::Event& begun = *stop.begun_by;
        if (at_wall(begun.theta)) {
            say("It came to rest at the wall, theta = {:.5g}, at t = {}", begun.theta, at(begun.t));
        } else {
            say("It {} at t = {} at theta = {}",
                is_link_   ? "locked"
                : on_belt_ ? "stuck to the belt"
                           : "stopped",
                at(begun.t), place(*(&stop - 1)));
            const double torque = pull(begun);
            const bool sprung = !system_.spring().none(), fed_back = excitation_.has_feedback();
            const bool driven_back =
                (fed_back || sprung) && std::fabs(torque) > limit(torque) && !at_limit(torque, begun);
            if (knows_all_torques()) {
                add(" because {}", !driven_back ? reason(torque)
                                   : !sprung    ? "M drives it back from both sides of velocity 0"
                                   : !fed_back  ? "the spring jumps there and drives it back from both sides"
                                                : "M or the spring jumps there and drives it back from both sides");
            }
        }
        if (stop.ended_by) {
            add("; it stuck for {:.5g}, until {}.", stop.lasts(), slip(*stop.ended_by, !at_wall(begun.theta)));
        } else if (constant_from_ <= run_.t_stop) {
            add(".");
            say("M is constant from {} on, so it stays at rest.",
                constant_from_ <= begun.t ? "then" : "t = " + at(constant_from_));
        } else {
            add(", and was still stuck when the run ended at t = {}.", at(run_.t_stop));
            describe_stillness();
        }
        end_paragraph();
    }

    /// Explains why and in which direction it slipped. `has_torque`: a sentence about |M - k theta| precedes
    /// ("this torque").
    std::string slip(const model::Event& event, bool has_torque) const {
        if (event.kind == model::EventKind::opened) return "its contact opened";
        if (at_wall(event.theta)) return slip_from_wall(event);
        if (!knows_all_torques()) return "it slipped";
        if (on_belt_) {
            const double vb = motion::belt_from(belt_, event.t), slides = event.velocity - vb;
            constexpr double clearly = 1e-6;
            if (std::fabs(slides) > clearly * (std::fabs(vb) + std::fabs(event.velocity))) {
                return fmt::format("vb jumped to {:.5g} and it slipped {}", vb, slides < 0 ? "backward" : "forward");
            }
        }
        const double torque = pull(event);
        std::string why = fmt::format("{} jumped so that {},", on_base_ || on_belt_ ? "the pull" : "M", reason(torque));
        if (own_rule_) {
            why = fmt::format("{} {}", own_rule_->release, reason(torque));
        } else if (at_limit(torque, event)) {
            why = fmt::format("{} exceeded Re", has_torque ? "this torque" : fmt::format("|{}|", pull_name()));
        }
        return fmt::format("{} and it slipped {}", why, torque < 0 ? "backward" : "forward");
    }

    // ---- the end

    void describe_end() {
        const bool over = still_ || (stretches_.back().stuck && excitation_.constant_from() <= run_.t_stop);
        const bool failed = !model::is_whole(run_.outcome);
        if (half_cycles_ > 0 && !over) {
            if (const auto motion = recurrence(events_)) {
                describe_recurrence(*motion);
            } else if (!decay_described_ && undisturbed_) {
                describe_trend();
            }
        }
        if (const Stretch& last = stretches_.back(); !failed && !last.stuck) {
            say("At the end, t = {}, theta = {} and velocity = {:.5g}.", at(run_.t_stop), place(last),
                motion::stands_at_stop(run_) ? 0 : last.end.velocity);
        }
        end_paragraph();
    }

    /// Explains why a mass stuck at the end stays, if known.
    void describe_stillness() {
        still_ = run_.outcome == model::Outcome::at_rest;
        if (!still_) return;
        if (on_base_ || on_belt_ || !knows_all_torques()) {
            say("It stays at rest.");
            return;
        }
        if (constant_from_ <= run_.t_stop) {
            say("M is constant{}, so it stays at rest.",
                free() ? "" : fmt::format(" from t = {} on", at(constant_from_)));
        } else if (std::isfinite(excitation_.most()) && held_at_most()) {
            say("|M| never exceeds {:.5g}, which is too little to move it: it stays at rest.", excitation_.most());
        } else {
            say("A whole period of M did not move it, so it stays at rest.");
        }
    }

    bool held_at_most() const {
        return model::cannot_break_away(model::Lowered(system_), excitation_.most(), run_.state_at_stop.theta);
    }

    void describe_recurrence(const Recurrence& motion) {
        describe_period(motion);
        if (motion.drift != 0) {
            say("It advances by {:.5g} in each period: stick-slip.", motion.drift);
        } else {
            say("The amplitude is {:.5g} about theta = {}.", motion.amplitude,
                text::number_text(motion.centre, 1e7 * motion.amplitude));
        }
        // If the period of M is unknown, the period of the motion serves as one.
        const double known = model::period_from(excitation_, motion.since), period = known > 0 ? known : motion.period;
        if (std::fabs(motion.period / period - 1) <= 1e-3 && motion.drift == 0 && constant_from_ > motion.since) {
            if (const auto lag = phase_lag(run_, excitation_, period, motion.until)) {
                say("The fundamental of theta {} that of M by {:.3f} rad.", *lag < 0 ? "leads" : "lags behind",
                    std::fabs(*lag));
            }
        }
        if (motion.stops == 0) {
            if (!system_.friction().none()) say("It does not stop.");
        } else {
            say("It stops {} in each period and is stuck for {} of the time.",
                motion.stops == 1   ? "once"
                : motion.stops == 2 ? "twice"
                                    : fmt::format("{} times", motion.stops),
                text::percent(motion.stuck));
        }
        end_paragraph();
    }

    void describe_period(const Recurrence& motion) {
        const double period = model::period_from(excitation_, motion.since);
        const double ratio = period > 0 ? motion.period / period : 0, whole = std::round(ratio);
        std::string of =
            fmt::format("{:.5g} {}", motion.period / T0_, system_.has_spring() ? "T0" : system_.units().times());
        if (whole >= 1 && std::fabs(ratio - whole) <= 1e-3 * ratio) {
            of = whole == 1 ? "the period of M" : fmt::format("{} periods of M", whole);
        }
        if (!motion.steady) {
            say("The motion is settling: it nearly repeats itself every {} ({}), and the last two periods differ by {} "
                "of the amplitude.",
                at(motion.period), of, text::percent(motion.change));
            return;
        }
        const bool always = motion.since == events_.front().t;
        say("{} steady: it repeats itself every {} ({}).",
            always ? "The motion is" : fmt::format("From t = {} on the motion is", at(motion.since)), at(motion.period),
            of);
        if (period == 0 && excitation_.has_feedback()) say("This is a limit cycle if M depends on the motion alone.");
    }

    void describe_trend() {
        const double period = model::period_from(excitation_, stretches_.back().from);
        const Swings last = swings(swings_, period);
        if (last.trend == Trend::unknown) {
            if (!free() && run_.events.size() > 1)
                say("The run is too short to tell whether the motion becomes steady.");
            end_paragraph();
            return;
        }
        const auto& [a, b, c] = last.amplitudes;
        // The period of a base is unknown here, so a beat may look like growth.
        const bool grows = last.trend == Trend::growing && !on_base_, shrinks = last.trend == Trend::shrinking;
        say("The motion {}: amplitudes of {:.5g}, {:.5g} and {:.5g} in the last three {}",
            grows     ? "grows"
            : shrinks ? "decays"
                      : "is not periodic so far",
            a, b, c, period > 0 ? "periods of M" : fmt::format("spans of {}", at(last.span)));
        describe_step(last);
        add(".");
        end_paragraph();
    }

    /// Describes a regular change of the amplitude.
    void describe_step(const Swings& last) {
        if (last.trend == Trend::irregular) return;
        const auto& [a, b, c] = last.amplitudes;
        constexpr double most_irregular = 1e-3;
        const char* more = c > b ? "more" : "less";
        if (std::fabs((c - b) - (b - a)) <= most_irregular * std::fabs(c - b)) {
            add(", {:.5g} {} each time", std::fabs(c - b), more);
        } else if (std::fabs(c / b - b / a) <= most_irregular * std::fabs(c / b - 1)) {
            add(", {:.5g} times as much each time", c / b);
        }
    }

    const RunToDescribe& whole_;
    const model::Joint& joint_;
    bool is_link_;
    bool undisturbed_;  // whether no link disturbs it
    const motion::Run& run_;
    const model::Oscillator& system_;
    const model::Excitation& excitation_;
    const model::Excitation& belt_;
    std::optional<motion::OwnRule> own_rule_;  // a release rule other than the law's
    std::vector<Stretch> stretches_, swings_;  // relative to the belt, and of theta; equal without a belt
    std::vector<model::Event> events_;         // including the extremes of theta on a belt
    std::vector<const Stretch*> stops_;
    bool on_base_, on_belt_, steady_belt_;
    double T0_, constant_from_;
    double stuck_ = 0;
    std::size_t half_cycles_ = 0;
    bool decay_described_ = false;  // whether describe_decay() has described it
    bool still_ = false;            // whether it rests for good under a periodic M
};

/// Builds the text on the whole system around those on its bodies and links.
class WholeStory : protected text::Prose {
public:
    explicit WholeStory(const RunToDescribe& whole)
        : whole_(whole), system_(whole.system), run_(*whole.parts.front()) {}

    std::string build_text(const std::vector<Energy>& energies) {
        const bool all = covers_all_bodies(whole_);
        if (all) describe_setting();
        end_paragraph();
        for (std::size_t j = 0; j < system_.joints.size(); ++j) {
            if (whole_.joint && *whole_.joint != j) continue;
            // Joints with numbers out of range are skipped.
            const auto seen = model::oscillator_at(system_, j);
            if (seen) text_ += (text_.empty() ? "" : all ? "\n\n" : "\n") + Story(whole_, j, *seen).build_text();
        }
        if (all) text_ += "\n";
        if (all && !energies.empty()) describe_energy(energies);
        describe_doubts();
        describe_outcome();
        end_paragraph();
        return std::move(text_);
    }

private:
    std::string time(double t) const { return text::time_text(t, run_.t_stop - run_.t_start); }
    const std::string& name(std::size_t joint) const { return system_.joints[joint].name; }

    void describe_setting() {
        const std::size_t n = system_.bodies.size(), links = system_.joints.size() - n;
        say("{} and {}, from t = {} to {}.", text::counted(n, "body"), text::counted(links, "link"), time(run_.t_start),
            time(run_.t_stop));
        std::vector<std::string> driven;
        for (std::size_t i = 0; i < n + links; ++i) {
            if (!whole_.drive.loads[i].components().empty()) driven.push_back(name(i));
        }
        driven.empty() ? say("There is no M.") : say("M acts on {}.", fmt::join(driven, " and "));
        if (!whole_.drive.base.components().empty()) say("{}", base_text);
        if (!system_.units.usual()) say("Units: {}.", system_.units.in_words());
    }

    /// Describes events that the run may have missed, and causes of a long computation.
    void describe_doubts() {
        const double shortest = system_.shortest_natural_period(), scale = std::isfinite(shortest) ? shortest : 1;
        if (run_.gap > 0) {
            say("A pulse of a Lua function that is shorter than {} may have been missed.",
                text::number_text(run_.gap, scale));
        }
        if (run_.noise > 0) {
            say("The torques are noisy (about {:.2g}), which limits the accuracy of the motion.", run_.noise);
        }
        if (run_.jumps_often()) {
            say("M jumps {} times along the motion. Each jump was located, which takes at least six evaluations of M: "
                "fine steps, as of an encoder, make a run slow.",
                run_.jumps);
        }
    }

    void describe_energy(const std::vector<Energy>& energies) {
        const Energy whole = sum_of(energies);
        if (!(whole.flow > 0)) return;
        struct Share {
            double value;
            std::string what;
        };
        std::vector<Share> given, taken;
        const auto of = [this](const char* what, std::size_t j) { return fmt::format("{} of {}", what, name(j)); };
        const auto note = [&](double value, const std::string& what) {
            if (value > 0) given.push_back({value, what});
            if (value < 0) taken.push_back({-value, what});
        };
        for (std::size_t j = 0; j < energies.size(); ++j) {
            const Work& work = energies[j].total.work;
            const bool moved = j < system_.bodies.size() && system_.bodies[j].moved;
            note(work.input, of(moved ? "the prescribed motion" : "M", j));
            note(work.base, "the base under " + name(j));
            note(work.belt, of("the belt", j));
            note(-work.viscous, of("the damping", j));
            note(-work.dry, of("the friction", j));
            note(-work.impacts, of("the impacts", j));
        }
        note(whole.total.work.acts, "acts at events");
        note(-whole.total.change.kinetic - whole.total.change.spring, "stored energy");
        for (auto* list : {&given, &taken}) {
            std::ranges::sort(*list, std::ranges::greater{}, &Share::value);
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

    void describe_outcome() {
        if (model::is_whole(run_.outcome)) return;
        if (run_.outcome == model::Outcome::interrupted) {
            say("The run was interrupted at t = {}: the text covers the time until then.", time(run_.t_stop));
        } else {
            say("The run stopped early, at t = {}: {}.", time(run_.t_stop), motion::outcome_text(run_));
        }
    }

    const RunToDescribe& whole_;
    const model::System& system_;
    const motion::Run& run_;
};

}  // namespace

std::string explain(const RunToDescribe& run, const std::vector<Energy>& energies) {
    return WholeStory(run).build_text(energies);
}

std::string explain(const motion::Run& run, const model::Oscillator& system, const model::Drive& drive,
                    motion::MethodView method) {
    const auto whole = model::as_system(system);
    return explain({.system = whole, .drive = drive, .parts = {&run}, .method = method});
}

std::string explain_rows(const motion::Run& run, const model::Units& units) {
    const auto t = run.find("t"), theta = run.find("theta"), velocity = run.find("velocity");
    std::string text = fmt::format("This run was read from a file: {}", motion::summary(run)) + ".";
    if (!units.usual()) text += fmt::format(" It has {}.", units.in_words());
    if (theta && run.size() > 0) {
        Eigen::Index low = 0, high = 0;
        const auto column = run.rows.col(*theta);
        const double least = column.minCoeff(&low), most = column.maxCoeff(&high);
        const auto when = [&](Eigen::Index row) { return t ? fmt::format(" (t = {:.6g})", run.rows(row, *t)) : ""; };
        text += fmt::format(" theta goes from {:.5g}{} to {:.5g}{}.", least, when(low), most, when(high));
    }
    if (velocity && run.size() > 0) {
        const auto v = run.rows.col(*velocity);
        std::size_t changes = 0, still = 0;
        double before = 0;
        for (const double now : v) {
            if (before * now < 0) ++changes;
            if (now != 0) before = now;
            if (now == 0) ++still;
        }
        text += fmt::format(" The velocity changes sign {} and is exactly 0 in {}.", text::counted(changes, "time"),
                            text::counted(still, "row"));
    }
    text += " The rows do not contain events and their reasons: simulate again to see them.";
    return text::wrapped(text);
}

}  // namespace dinal::analysis
