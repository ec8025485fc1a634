// The story of a run while it is being told, sentence by sentence, paragraph by paragraph; explain() is the way in.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/prose.hpp"
#include "analysis/recurrence.hpp"
#include "model/excitation.hpp"
#include "model/extras.hpp"
#include "motion/method.hpp"
#include "text/sentences.hpp"

namespace dinal::analysis {

class Story : protected Prose {
public:
    /// All of it must outlive the story.
    Story(const motion::Trajectory& trajectory, const model::Oscillator& system, const model::Excitation& excitation,
          motion::MethodView method, const model::Extras& extras);
    std::string told();

private:
    [[nodiscard]] std::string at(double t) const { return text::time_text(t, T0_); }
    /// Where a stretch ended.
    [[nodiscard]] static std::string place(const Stretch& s) {
        return text::number_text(s.end.theta, std::max(std::fabs(s.begin.theta), std::fabs(s.end.theta)));
    }
    [[nodiscard]] bool at_limit(double torque, const model::Event& event) const;
    /// M - k theta, less what another spring pulls back with, and with what the support and a belt do to a mass at
    /// rest.
    [[nodiscard]] double pull(const model::Event& event) const { return pull_at(event.theta, event.M, event.t); }
    [[nodiscard]] double pull_at(double theta, double M, double t) const {
        return std::fma(-system_.stiffness(), theta, M + around(t) - system_.spring().torque(theta));
    }
    /// -I a - I vb' - C vb, from the right.
    [[nodiscard]] double around(double t) const;
    /// Re, against a pull this way.
    [[nodiscard]] double limit(double pull) const {
        return system_.friction().holding(pull < 0 ? model::Motion::backward : model::Motion::forward);
    }
    /// "|M - k theta| = 0.155 <= Re = 0.167"
    [[nodiscard]] std::string reason(double pull) const {
        return fmt::format("|{}| = {}", pull_name(), text::against_limit(std::fabs(pull), limit(pull)));
    }
    [[nodiscard]] std::string pull_name() const {
        std::string name = "M";
        if (on_base_) name += " - I a";
        if (on_belt_ && !steady_belt_) name += " - I vb'";
        if (on_belt_ && system_.damping() > 0) name += " - C vb";
        if (system_.spring().none() || system_.has_spring()) name += " - k theta";
        return name + (system_.spring().none() ? "" : " - spring");
    }
    /// At a wall, which carries what pulls against it.
    [[nodiscard]] bool at_wall(double theta) const {
        const auto& walls = system_.walls();
        return walls && (theta == walls->lower || theta == walls->upper);
    }
    void tell_surroundings();
    void tell_walls();
    void tell_impacts();
    [[nodiscard]] std::string slip_from_wall(const model::Event& event) const;
    /// M never changes.
    [[nodiscard]] bool free() const { return constant_from_ <= run_.t_start; }

    // How it began and went on, in story.cpp.
    void tell_setting();
    void tell_friction();
    void tell_start();
    void tell_counts();
    void tell_turns();
    void tell_decay();
    void tell_stops();
    void tell_stop(const Stretch& stop);
    [[nodiscard]] std::string slip(const model::Event& event, bool told) const;
    // What became of it, in story_end.cpp.
    void tell_end();
    void tell_stillness();
    [[nodiscard]] bool held_at_most() const;
    void tell_recurrence(const Recurrence& motion);
    void tell_period(const Recurrence& motion);
    void tell_trend();
    void tell_step(const Swings& last);
    void tell_outcome();

    const motion::Trajectory& run_;
    const model::Oscillator& system_;
    const model::Excitation& excitation_;
    std::optional<motion::OwnRule> own_rule_;  // of stops, which are not the law's then
    std::vector<Stretch> stretches_, swings_;  // the same but on a belt: against the belt, and of theta
    std::vector<model::Event> events_;         // with the extremes of theta on a belt
    std::vector<const Stretch*> stops_;
    const model::Extras& extras_;
    bool on_base_, on_belt_, steady_belt_;
    double T0_, constant_from_;
    double stuck_ = 0;
    std::size_t half_cycles_ = 0;
    bool decay_told_ = false;  // by its closed form
    bool still_ = false;       // for good, under a periodic M
};

}  // namespace dinal::analysis
