// The record of a run: its events, rows and history.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "motion/engine/balance.hpp"
#include "motion/engine/decide.hpp"
#include "motion/engine/history.hpp"
#include "motion/engine/run.hpp"

namespace dinal::motion::engine {

/// Writes down what has happened, and decides nothing. Events are reported here only.
class Recorder {
public:
    Recorder(const Request& problem, const Mechanics& mechanics, Run& result, const Now& start);

    struct Stretch {
        const Now& now;
        const Segment& segment;
        const Frame& frame;
        Balances& balances;
        SampledLoads& sampled;
    };

    // Events.
    void tell(const Now& now, model::EventKind kind, std::size_t where, int user = -1) {
        events_.push_back(event_at(mechanics_, now, kind, where, user));
    }
    /// An event of the user concerns every joint: each gets one, with its own angle and velocity.
    void tell_user(const Now& now, std::size_t event);
    [[nodiscard]] bool told_user_at(double t) const {
        return !events_.empty() && events_.back().user >= 0 && events_.back().t == t;
    }
    /// A load begins or ceases to slide along a condition. Both at one instant are no event, nor does a slide begin
    /// where a run goes on.
    void tell_slide(const Now& now, std::size_t joint);
    /// The events of a decision. `unit`: of time.
    void tell(const Decision& decision, double unit);
    /// A joint creeps: it sticks at this event unless something moves it before the end of the run.
    void creeps(std::size_t joint, const model::Event& event) { crept_[joint] = event; }
    /// Takes back the slip that was reported at the present, of a joint that did not leave. Returns whether there was
    /// one.
    bool take_back_slip(std::size_t joint, double t) { return take_back(model::EventKind::slip, joint, t); }
    bool take_back(model::EventKind kind, std::size_t joint, double t);
    /// Keeps only the first of stops and slips that follow each other at once and lead nowhere.
    void forget_chatter(double unit);
    /// The run has ended as it should: what creeps still sticks.
    void tell_crept(const Mode& mode);
    /// The last stick is the rest.
    void tell_rest();
    /// A turn of a body without dry friction changes nothing in its motion: it is recorded only. `sizes` and `noise`
    /// of the torques say which velocities are no motion.
    void record_turns(const Stretch& of, double until, const TorqueSizes& sizes, double noise);

    /// The direction in which each body moves that has no dry friction.
    [[nodiscard]] const std::vector<model::Motion>& heading() const { return heading_; }
    void head(std::size_t body, double velocity) { heading_[body] = model::motion_of(velocity); }
    void go_on_with(const std::vector<model::Motion>& heading) { heading_ = heading; }

    // Rows.
    /// The rows of a stretch until `end`. Returns false if a value is not finite; so do the others.
    bool rows_until(const Stretch& of, double end, bool to_the_end);
    /// The rows of the present, at the end of a run.
    bool rows_at_end(const Stretch& of);
    [[nodiscard]] std::size_t next_row() const { return next_row_; }

    // History.
    /// Keeps what was used of a stretch.
    void keep(const Now& now, const Segment& segment, double length, double longest_delay);
    void add_jump(double t, std::size_t joint, const Work& work) { history_->add_jump(t, joint, work); }
    [[nodiscard]] const std::shared_ptr<History>& history() const { return history_; }

    // The beginning and the end.
    void begin(const Now& now) { left_->start = now.y, left_->begun = now.mode; }
    void finish(const Now& now, std::shared_ptr<const Carry> carry);

private:
    bool only_touched(const Told& slip, double unit);
    /// The place x of the segment; -2 is the present.
    bool put_row(const Stretch& of, double t, double x);
    [[nodiscard]] double friction(const Now& now, std::size_t joint, const Moment& at, const Balance& balance) const;
    std::vector<Kept::Acting> acting(const Now& now, const Segment& segment);
    void add_springs(const Now& now, const Segment& segment, std::size_t joint, Kept::Acting& acting) const;
    void add_friction(const Now& now, const Segment& segment, std::size_t joint, Kept::Acting& acting);
    void record_turns(std::size_t body, const Segment& segment, double until, double nothing, SampledLoads& sampled);

    [[nodiscard]] std::size_t n() const { return mechanics_.bodies(); }
    /// The joints behind these move bodies.
    [[nodiscard]] std::size_t told_joints() const { return mechanics_.joints() - problem_.hidden; }
    [[nodiscard]] std::size_t moved_body(std::size_t hidden) const { return problem_.system.joints[hidden].first(); }

    const Request& problem_;
    const Mechanics& mechanics_;
    Run& result_;
    std::vector<model::Event> events_;
    double* cells_ = nullptr;  ///< the table of the rows
    std::shared_ptr<Left> left_ = std::make_shared<Left>();
    std::shared_ptr<History> history_;
    std::map<std::size_t, model::Event> crept_;
    std::vector<model::Motion> heading_;
    std::size_t next_row_ = 0;
    Balance balance_;
    std::vector<double> row_, point_;
    struct {
        double t = -model::never;
        std::size_t joint = 0;
    } last_slide_;
};

}  // namespace dinal::motion::engine
