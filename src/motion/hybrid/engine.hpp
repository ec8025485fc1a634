// A run with more in it: piece after piece, each up to the first event in it, whoever watches for that. What happens
// where the mass stands on its surface, or at a wall, is for the Standstill to say, as in every other integrator.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "motion/hybrid/crossing.hpp"
#include "motion/hybrid/pieces.hpp"
#include "motion/spectral/corner_watch.hpp"
#include "motion/standstill.hpp"

namespace dinal::motion::hybrid {

/// What a run with more in it leaves to the one that goes on from there.
struct Left final : Carried {
    std::vector<ControllerMemory> controllers;
    std::vector<Watch> watches;
    std::vector<std::pair<double, int>> echoes;
    std::shared_ptr<const Pieces> past;
    double born = 0;
};

/// Runs the problem, which has extras. The columns of its states stand behind the others.
Trajectory run(const Problem& problem, const Cut& cut);

class Engine {
public:
    Engine(const Problem& problem, const Cut& cut, Trajectory& trajectory, std::vector<model::Event>& events,
           const std::shared_ptr<Pieces>& pieces);
    model::Outcome run();
    void leave(Trajectory& trajectory) const;

private:
    /// Whose event ends a piece.
    enum class By { nobody, surface, corner, wall, relay, user };
    struct Ending {
        double x = 1;
        By by = By::nobody;
        std::size_t which = 0;                         ///< of the relays
        model::Motion towards = model::Motion::stuck;  ///< of a release, or the way into a wall
        std::vector<std::size_t> users = {};           ///< events of the user at this instant, in the order written
    };
    /// What follows each other within a time, so often that it goes on for ever.
    struct Storm {
        double last = -model::never;
        int count = 0;
        bool after(double t, double within) {
            constexpr int most = 200;
            count = t - last <= within ? count + 1 : 0;
            last = t;
            return count > most;
        }
    };
    /// Of a mass that a user threw: from where, and on which side of it that is; 0 when it is none that is soon back.
    struct Flight {
        double from = 0;
        int side = 0;
    };
    struct Bounces {
        double once = 0, all = 0;
    };

    // engine.cpp
    bool begin();
    bool advance();
    bool choose();
    void again(Solver::Attempt attempt);
    bool end_piece(double x);
    void keep(double length);

    // engine_noise.cpp
    bool get_nowhere(model::Outcome outcome);

    // engine_rows.cpp
    bool rows_until(double end, bool to_the_end);
    bool put_row(double t, double x);

    // engine_events.cpp
    void watch(Ending& ending);
    bool handle(const Ending& ending);
    [[nodiscard]] double least_time() const;
    [[nodiscard]] bool before_jump() const;
    bool find_jump_here();
    bool belt_jumps(double before);
    bool ask();
    bool release(model::Motion towards);
    void tell(model::EventKind kind, int user = -1);
    bool too_often();
    void echo(double t, int generation);
    [[nodiscard]] MotionPoint point(double x) const;
    [[nodiscard]] MotionPoint point_at(std::size_t node) const;
    [[nodiscard]] std::optional<double> first_switch(std::size_t relay) const;
    [[nodiscard]] std::optional<double> first_switch(std::size_t relay, std::size_t place, double until) const;

    // engine_surface.cpp
    [[nodiscard]] std::optional<double> first_standstill() const;
    [[nodiscard]] std::optional<double> turn_of_held(const Series& velocity) const;
    [[nodiscard]] bool creeps() const;
    bool creep();
    [[nodiscard]] std::pair<double, model::Motion> first_release() const;
    void record_turns(double until);
    [[nodiscard]] bool keeps_its_way() const;
    /// Corners of a law are passed at sight where pieces are right to rounding.
    [[nodiscard]] bool watches_corners() const {
        return cut_.h == 0 && solver_.slide().has_corners() && !standstill_.stuck() && !standstill_.passes();
    }
    [[nodiscard]] Series slip_series() const;
    [[nodiscard]] double longest_under_friction() const;
    [[nodiscard]] std::optional<spectral::CornerWatch::Corner> first_corner(double until) const;
    void go_over(const spectral::CornerWatch::Corner& corner);

    // engine_acts.cpp
    void watch_users(Ending& ending);
    bool act_all(const std::vector<std::size_t>& told);
    bool act(std::size_t which, const std::vector<std::size_t>& told);
    void come_again(std::size_t event);
    [[nodiscard]] bool passes_on(std::size_t event) const;
    void throw_from_here();
    [[nodiscard]] double rounding_of(std::size_t event) const;
    void stand_where_put(const std::vector<double>& before, const std::vector<std::size_t>& told);
    [[nodiscard]] std::vector<double> watched_values(double x) const;

    // engine_walls.cpp
    void touch_wall(bool goes_on);
    void watch_walls(Ending& ending) const;
    void stand_at(double wall) { origin_ = wall, y_[0] = 0, reach_ = 0; }
    [[nodiscard]] double blurred_gap(double wall) const;
    void touch();
    [[nodiscard]] bool belt_turns_at_wall();
    [[nodiscard]] double acceleration() const;
    [[nodiscard]] double until(int side, double place, double a) const;
    [[nodiscard]] double until_wall() const;
    bool hit(model::Motion into);
    void come_to_lean(model::Motion against);
    void go_from_wall();
    [[nodiscard]] Bounces bounces(model::Motion into) const;
    [[nodiscard]] double sliding_at_wall(double belt) const;
    [[nodiscard]] double belt_at_wall(double belt) const;
    [[nodiscard]] double belt_at_wall() const;

    [[nodiscard]] double belt() const { return field_.belt(now_.hi, after_break_ ? Side::after : Side::at); }
    [[nodiscard]] MotionPoint here() const {
        return {now_.hi, after_break_ ? Side::after : Side::at, {theta(), y_[1]}, {y_.data() + 2, y_.size() - 2}};
    }
    [[nodiscard]] double theta() const { return origin_ + y_[0]; }
    void set_theta(double theta) { origin_ = 0, y_[0] = theta, reach_ = std::fabs(theta); }
    /// The mass stands at a wall.
    [[nodiscard]] bool leans() const { return standstill_.stuck() && standstill_.leans() != model::Motion::stuck; }
    [[nodiscard]] double belt_heading() const {
        return field_.belt_heading(now_.hi, after_break_ ? Side::after : Side::at);
    }
    /// The velocity of what a mass at rest stands on: the belt, or the wall.
    [[nodiscard]] double carrier() const { return standstill_.leans() != model::Motion::stuck ? 0 : belt(); }
    /// All that pulls at a mass which rests on its surface, or at a wall, but for the springs.
    [[nodiscard]] double pull(double M) const {
        const double loads = M + field_.push(now_.hi, after_break_ ? Side::after : Side::at);
        if (standstill_.leans() != model::Motion::stuck) return loads + belt_at_wall();
        return loads - system_.inertia() * field_.belt_slope(now_.hi).sure() - system_.damping() * belt();
    }
    /// What states of the user's may be wrong by, as a part of the torques that come from them.
    [[nodiscard]] double blurred() const { return y_.size() > 2 ? 3e-12 : 0; }
    /// A pull at a mass that rests, nearer to that of its springs by so much: what only touches a limit holds.
    [[nodiscard]] double surely(double pull, double at) const {
        return pull - blurred() * (pull - system_.pull_back(at));
    }
    bool fail(model::Outcome outcome) {
        outcome_ = outcome;
        return false;
    }
    /// Which way friction acts; without any, one is as good as the other.
    [[nodiscard]] model::Motion way() const {
        if (standstill_.passes()) return model::Motion::forward;
        return standstill_.stuck() ? model::Motion::stuck : standstill_.motion();
    }

    const Problem& problem_;
    const model::Extras& extras_;
    model::Lowered system_;
    std::vector<model::Event>& events_;
    std::shared_ptr<Pieces> pieces_;
    Field field_;
    Cut cut_;
    Solver solver_;
    spectral::CornerWatch corners_;
    Standstill standstill_;

    Clock now_;
    double origin_ = 0;  // theta is this and y_[0]: the wall that was hit last
    double reach_ = 0;   // how far from there the mass has been since, or from 0
    Values y_;
    mutable Values point_states_;
    bool after_break_ = false;
    Solved piece_;
    std::vector<Watch> watches_;                  // of the events of the user
    std::vector<std::pair<double, int>> echoes_;  // breaks that delays bring back, and how often they did, in order
    double h_, pace_;
    double gap_ = 0;  // the longest between two looks at M
    double bad_time_ = model::never;
    double belt_turns_ = model::never;  // while the mass stands at a wall
    double belt_jump_ = model::never;   // where nobody announced it
    Flight flight_;
    double born_;  // when the run began that goes on here
    int attempts_ = 0, too_short_ = 0;
    double attempts_since_ = 0;
    Storm storm_, impacts_;
    std::vector<Half> came_from_;  // the events of the user that were told last
    std::size_t next_row_ = 0;
    double* column_ = nullptr;
    model::Outcome outcome_ = model::Outcome::reached_end;
    std::optional<Rough> rough_;
};

}  // namespace dinal::motion::hybrid
