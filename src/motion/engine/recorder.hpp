// The record of a run: its events, rows and history.
#pragma once

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
    Recorder(const Request& problem, const Mechanics& mechanics, Run& result, const Now& start, double unit);

    struct Stretch {
        const Now& now;
        const Segment& segment;
        const Frame& frame;
        Balances& balances;
        SampledLoads& sampled;
    };

    // Events. The last ones wait, because what follows may show that they are none: a joint that is let go does not
    // leave, a load ceases to slide at once, a stick lasts for no more than rounding, or the run gets nowhere. When
    // one comes clearly later they are written, and stay.
    void tell(const Told& told);
    void tell(const Now& now, model::EventKind kind, std::size_t where, int user = -1) {
        tell({.event = event_at(mechanics_, now, kind, where, user)});
    }
    /// An event of the user concerns every joint: each gets one, with its own angle and velocity.
    void tell_user(const Now& now, std::size_t event);
    [[nodiscard]] bool told_user_at(double t) const {
        return !recent_.empty() && recent_.back().user >= 0 && recent_.back().t == t;
    }
    /// A load, or the rate of a state, which concerns all joints, begins or ceases to slide along a condition. Both at
    /// one instant are no event, nor does a slide begin where a run goes on.
    void tell_slide(const Now& now, const SlideChange& change);
    /// A joint that was let go at this time did not leave.
    void tell_no_slip(std::size_t joint, double t) { is_none(model::EventKind::slip, joint, t); }
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
    [[nodiscard]] double next_row_time() const {
        return next_row_ < problem_.rows.count() ? problem_.rows.time(next_row_) : model::never;
    }
    /// The row of a plain step of one body.
    void put_row(double t, const model::State& y, double M, double friction, std::span<const double> states);

    // History.
    /// Keeps what was used of a stretch.
    void keep(const Now& now, const Segment& segment, double length, double longest_delay);
    void keep(Kept kept) { history_->add(std::move(kept), true, model::never); }
    void add_jump(double t, std::size_t joint, const Work& work) { history_->add_jump(t, joint, work); }
    [[nodiscard]] const std::shared_ptr<History>& history() const { return history_; }

    // The beginning and the end.
    void begin(const Now& now) { left_->start = now.y, left_->begun = now.mode; }
    void finish(const Now& now, const Contacts& contacts, std::shared_ptr<const Carry> carry);

private:
    void end_events(model::Outcome outcome, const Mode& mode, const Contacts& contacts);
    bool is_none(model::EventKind kind, std::size_t joint, double t);
    void write_recent();
    /// The place x of the segment; -2 is the present.
    bool put_row(const Stretch& of, double t, double x);
    [[nodiscard]] double friction(const Now& now, std::size_t joint, const Moment& at, const Balance& balance) const;
    [[nodiscard]] double held_by_load(const Now& now, std::size_t joint, const Moment& at,
                                      const Balance& balance) const;
    std::vector<Kept::Acting> acting(const Now& now, const Segment& segment);
    void add_springs(const Now& now, const Segment& segment, std::size_t joint, Kept::Acting& acting) const;
    void add_friction(const Now& now, const Segment& segment, std::size_t joint, Kept::Acting& acting);
    void record_turns(std::size_t body, const Segment& segment, double until, double nothing, SampledLoads& sampled,
                      std::vector<model::Event>& turns);

    [[nodiscard]] std::size_t n() const { return mechanics_.bodies(); }
    /// The joints behind these move bodies.
    [[nodiscard]] std::size_t told_joints() const { return mechanics_.joints() - problem_.hidden; }
    [[nodiscard]] std::size_t moved_body(std::size_t hidden) const { return problem_.system.joints[hidden].first(); }

    const Request& problem_;
    const Mechanics& mechanics_;
    Run& result_;
    std::shared_ptr<History> history_;
    std::vector<model::Event> events_, recent_;
    double* cells_ = nullptr;  ///< the table of the rows
    std::shared_ptr<Left> left_ = std::make_shared<Left>();
    double unit_;  ///< of time
    std::vector<model::Motion> heading_;
    std::size_t next_row_ = 0;
    Balance balance_;
    std::vector<double> row_, point_;
    /// Room, so that a stretch need not allocate it.
    struct {
        std::vector<char> rubs;  ///< of each body
        std::vector<model::Event> turns;
        std::vector<double> zeros, y;
    } room_;
};

}  // namespace dinal::motion::engine
