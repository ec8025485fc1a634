// The main loop of the general engine, from one event to the next.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/excitation.hpp"
#include "motion/engine/balance.hpp"
#include "motion/engine/breaks.hpp"
#include "motion/engine/chatter.hpp"
#include "motion/engine/conditions.hpp"
#include "motion/engine/contacts.hpp"
#include "motion/engine/decide.hpp"
#include "motion/engine/flow.hpp"
#include "motion/engine/frames.hpp"
#include "motion/engine/nodes.hpp"
#include "motion/engine/now.hpp"
#include "motion/engine/plain_steps.hpp"
#include "motion/engine/recorder.hpp"
#include "motion/engine/torque_sizes.hpp"
#include "motion/engine/user_events.hpp"
#include "motion/engine/walls.hpp"

namespace dinal::motion::engine {

constexpr double short_part = 1e-3;  // a stretch below this fraction of the longest one is short

/// Controls the length of the next stretch by error estimates; events end stretches elsewhere.
struct Pace {
    double period = model::never;  ///< shortest period of the system without friction
    double unit = 1;               ///< time scale: the period, or the duration of a shorter run
    double longest = 1;            ///< longest stretch of the system without contacts
    double h = 1;                  ///< half the length of the next stretch
    double born = 0;               ///< start time of the first of several continued runs
    double bad_time = model::never;

    /// Returns whether no break has been searched for at t with a similar length, and registers the search.
    bool may_search(double t, double half) {
        if (searched_from_ == t && half > 0.1 * searched_half_) return false;
        searched_from_ = t, searched_half_ = half;
        return true;
    }
    /// Shortens the next stretch after an unresolved one; `half` is half its length, `unresolved` its relative error.
    void shorten(double half, double unresolved, double longest_now);
    /// Lengthens the next stretch by `factor` after a resolved one, up to `longest_now`.
    void lengthen(double half, double factor, double longest_now);
    /// Repeats the present stretch with half length `part`, and keeps `half` for later.
    void make_again(double part, double half) { h = part, whole_ = std::max(whole_, half); }
    /// Returns to the remembered length.
    void resume_length() { h = std::max(h, std::exchange(whole_, 0)); }

private:
    double searched_from_ = model::never, searched_half_ = 0;
    double whole_ = 0;         ///< half length of the stretch that is being repeated in parts; 0: none
    double short_enough_ = 0;  ///< half length that replaced one with a slightly too large error
    int limited_for_ = 0;      ///< number of stretches that short_enough_ still limits
};

/// Owns the parts of a run and calls them in order. Each part changes only its own data.
class Engine {
public:
    Engine(const Request& problem, Run& result);
    void run();

private:
    // The loop (run.cpp).
    void begin();
    bool advance();
    [[nodiscard]] bool strays_from_prescribed(const Frame& frame) const;
    bool take_plain_steps();
    bool solve(const Frame& frame);
    bool stands_for_good(const Frame& present);
    bool rest(const Frame& present);
    bool a_belt_jumps_at(double t) const;
    bool belt_jump_found();
    Ending watch(const Frame& frame);
    void hold_again(std::size_t joint, double torques);
    bool ends_before(double x);
    bool repeat_if_early(const Ending& ending);
    bool end_at(double x, const Frame& frame, SampledLoads& sampled);
    bool arrive(double x, bool whole);
    bool sample_controllers();
    void align_rigid_velocities();
    bool decide_after_break();
    void go_to(double x);
    void find_belt_slopes(std::optional<double> x);
    double kinetic_energy() const;
    void add_work_of_moved(std::size_t joint, double before, double lost);

    // The length of the next stretch (choose.cpp).
    void set_pace();
    void choose(const Frame& frame);
    double longest_under_friction(const Frame& frame);
    double next_break() const;
    double until_wall(const Frame& frame);
    void retry(Flow::Attempt attempt);

    // The end (finish.cpp).
    bool handle_events_at_end();
    void finish();
    void rows_at_end(SampledLoads& sampled);
    [[nodiscard]] std::optional<model::Outcome> at_rest();
    void explain_end();
    std::string state_driven_back();

    // Events that end a stretch (events.cpp). The functions return false if the run is over.
    bool handle(const Ending& ending);
    bool cross(const Ending& ending);
    bool come_to_a_stop(std::size_t joint);
    bool release(const Ending& ending);
    bool meet_stop(const Ending& ending);
    bool turn_slider(const Ending& ending);
    bool decide(bool reports, std::optional<Cause::Released> released = {});
    bool nothing_presses(std::size_t joint) const;
    bool open_and_close();
    enum class Because { impact, act, belt };
    bool restart_contacts(Because why, std::size_t at = 0);
    void restart_contact(std::size_t joint, Because why, std::size_t at, double caught);
    double rounding_of_slip(std::size_t joint, Because why) const;
    void let_slide(std::size_t slider, model::Motion way);
    bool turn_sliders();
    std::vector<double> catch_freewheels(bool at_start);
    double stop_together(const std::vector<char>& joints);
    bool press_stops();
    void press(std::size_t joint, int side);
    void touch_walls();

    // Rest on a surface at which a load jumps (settle.cpp).
    struct Passages {
        double leg = model::never, all = model::never;
    };
    enum class Settles { no, soon, now };
    Settles settle(const Conditions::Crossed::Back& back);
    [[nodiscard]] std::optional<Passages> next_passages(std::size_t joint, const Now& still, double speed, double far);
    [[nodiscard]] bool put_on_surface(const Conditions::Crossed::Back& back, std::size_t joint, Now& still, double far,
                                      double speed, double later);
    void wait(double rest);

    // Impacts and user actions (impacts.cpp).
    struct Bounces {
        double once = model::never, all = model::never;
    };
    [[nodiscard]] std::optional<Bounces> next_bounces(std::size_t joint, int wall, double speed);
    void switch_at_wall();
    bool hit(std::size_t joint, int wall);
    void lean(std::size_t joint, int wall);
    [[nodiscard]] bool is_driven(std::size_t joint, const Impulses::Thrown& thrown) const;
    [[nodiscard]] std::vector<char> stop_row(std::size_t joint, int wall, bool fades);
    void leave_walls(const std::vector<char>& stopped);
    bool act_all(const std::vector<std::size_t>& events);
    bool act(std::size_t event, const std::vector<std::size_t>& events);
    void shorten_for_flight();
    double energy_at(std::size_t joint, const std::vector<double>& y) const;

    bool fail(model::Outcome outcome) {
        outcome_ = outcome;
        return false;
    }
    /// Returns false, and ends the run, if events follow each other too often at one time.
    bool goes_on() { return !chatter_.too_often(now_.t.hi) || fail(model::Outcome::chattering); }
    void report_event(model::EventKind kind, std::size_t where) { recorder_->report_event(now_, kind, where); }
    void project(Side when) { projection_.apply(now_, frames_->of(now_.mode), when); }
    /// Returns whether the run is past its start; contacts have no events at the start.
    bool begun() const { return now_.t.hi > problem_.window.start || problem_.before != nullptr; }
    std::size_t n() const { return mechanics_.bodies(); }
    /// The number of joints without the last ones, which impose prescribed motions.
    /// Returns the magnitude of the present torques on the angle of a joint.
    [[nodiscard]] double torque_size(std::size_t joint) {
        sizes_.find(mechanics_, segment_, now_.here());
        return sizes_.on(joint_at(joint));
    }
    const model::Joint& joint_at(std::size_t joint) const { return problem_.system.joints[joint]; }

    // The motion.
    const Request& problem_;
    Run& result_;
    CallConvention convention_;
    Mechanics mechanics_;
    Now now_;
    Contacts contacts_;
    Segment segment_;  ///< the last stretch
    // The parts.
    Walls walls_;
    Pace pace_;
    Chatter chatter_;
    Breaks breaks_;
    Projection projection_;
    Impulses impulses_;
    UserEvents users_;
    std::optional<Frames> frames_;
    std::unique_ptr<Flow> solver_;
    std::optional<Conditions> conditions_;
    std::optional<Balances> balances_;
    std::optional<Recorder> recorder_;
    std::optional<PlainSteps> plain_steps_;
    // Storage that is reused, to avoid allocation in each stretch.
    DecisionRoom room_;
    TorqueSizes sizes_;
    struct {
        std::vector<double> departing;
        std::vector<int> leant;  ///< walls and friction before a release
        std::vector<Slipping> slid;
        struct {
            std::vector<double> greatest_pull, lacking, held, belts, loads, torques;
        } standing;
    } scratch_;
    model::Outcome outcome_ = model::Outcome::reached_end;
};

}  // namespace dinal::motion::engine
