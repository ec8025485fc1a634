// The record of a run: its events, rows and history.
#pragma once

#include <memory>
#include <vector>

#include "motion/engine/balance.hpp"
#include "motion/engine/decide.hpp"
#include "motion/engine/history.hpp"
#include "motion/engine/run.hpp"

namespace dinal::motion::engine {

/// Records events, rows and history. All events are reported here; no decision is made.
class Recorder {
public:
    Recorder(const Request& problem, const Mechanics& mechanics, Run& result, const Now& start, double unit);

    struct Stretch {
        const Now& now;
        const Segment& segment;
        const Frame& frame;
        Balances& balances;
        SampledLoads& sampled;
    };

    // Events. Recent events are held back, because later ones may withdraw them: a released joint does not move, a
    // slide ends at once, a stick is shorter than rounding, or the run gets stuck. They are written when a clearly
    // later event arrives.
    void report_event(const Reported& reported);
    void report_event(const Now& now, model::EventKind kind, std::size_t where, int user = -1) {
        report_event({.event = event_at(mechanics_, now, kind, where, user)});
    }
    /// Reports a user's event, once for each joint with the joint's angle and velocity.
    void report_user_event(const Now& now, std::size_t event);
    bool has_user_event_at(double t) const {
        return !recent_.empty() && recent_.back().user >= 0 && recent_.back().t == t;
    }
    /// Reports that a load, or the rate of a state (for all joints), begins or ends to slide along a condition. A begin
    /// and an end at the same instant cancel; none is reported at the start of a run.
    void report_slide(const Now& now, const SlideChange& change);
    /// Withdraws the slip of a joint that was released at this time but did not move.
    void withdraw_slip(std::size_t joint, double t) { withdraw(model::EventKind::slip, joint, t); }
    /// Records the turns of bodies without dry friction, which do not affect the motion. `sizes` and `noise` of the
    /// torques determine which velocities count as zero.
    void record_turns(const Stretch& of, double until, const TorqueSizes& sizes, double noise);

    /// The direction of motion of each body without dry friction.
    const std::vector<model::Motion>& heading() const { return heading_; }
    void set_heading(std::size_t body, double velocity) { heading_[body] = model::motion_of(velocity); }
    void set_headings(const std::vector<model::Motion>& heading) { heading_ = heading; }

    // Rows.
    /// Writes the rows of a stretch until `end`. Returns false, like the others, if a value is not finite.
    bool rows_until(const Stretch& of, double end, bool to_the_end);
    /// Writes the rows up to the present time with the present state, at the end of a run.
    bool rows_at_end(const Stretch& of);
    std::size_t next_row() const { return next_row_; }
    double next_row_time() const {
        return next_row_ < problem_.rows.count() ? problem_.rows.time(next_row_) : model::never;
    }
    /// Writes the row of a plain step of one body.
    void put_row(double t, const model::State& y, double M, double friction, std::span<const double> states);

    // History.
    /// Stores the used part of a stretch.
    void keep(const Now& now, const Segment& segment, double length, double longest_delay);
    void keep(Kept kept) { history_->add(std::move(kept), true, model::never); }
    void add_jump(double t, std::size_t joint, const Work& work) { history_->add_jump(t, joint, work); }
    const std::shared_ptr<History>& history() const { return history_; }

    // Beginning and end.
    void begin(const Now& now) { left_->start = now.y, left_->begun = now.mode; }
    /// Notes that contacts were released at the very start, which no event reports.
    void begin_released(const Mode& mode) { left_->begun = mode; }
    void finish(const Now& now, const Contacts& contacts, std::shared_ptr<const Carry> carry);

private:
    void end_events(model::Outcome outcome, const Mode& mode, const Contacts& contacts);
    bool withdraw(model::EventKind kind, std::size_t joint, double t);
    void write_recent();
    /// Writes the row at the point x of the segment; x = -2 means the present.
    bool put_row(const Stretch& of, double t, double x);
    double friction(const Now& now, std::size_t joint, const Moment& at, const Balance& balance) const;
    double held_by_load(const Now& now, std::size_t joint, const Moment& at, const Balance& balance) const;
    std::vector<Kept::JointTorques> acting(const Now& now, const Segment& segment);
    void add_springs(const Now& now, const Segment& segment, std::size_t joint, Kept::JointTorques& acting) const;
    void add_friction(const Now& now, const Segment& segment, std::size_t joint, Kept::JointTorques& acting);
    void record_turns(std::size_t body, const Segment& segment, double until, double nothing, SampledLoads& sampled,
                      std::vector<model::Event>& turns);

    std::size_t n() const { return mechanics_.bodies(); }
    /// The number of joints without the last ones, which impose prescribed motions.

    const Request& problem_;
    const Mechanics& mechanics_;
    Run& result_;
    std::shared_ptr<History> history_;
    std::vector<model::Event> events_, recent_;
    double* cells_ = nullptr;  ///< the values of the rows
    std::shared_ptr<Left> left_ = std::make_shared<Left>();
    double unit_;  ///< time scale of the motion
    std::vector<model::Motion> heading_;
    std::size_t next_row_ = 0;
    Balance balance_;
    std::vector<double> row_, point_;
    /// Storage that is reused, to avoid allocation in each stretch.
    struct {
        std::vector<char> rubs;  ///< whether each body has dry friction
        std::vector<model::Event> turns;
        std::vector<double> zeros, y;
    } room_;
};

}  // namespace dinal::motion::engine
