// The motion of a run with more in it, piece by piece: evaluated anywhere, integrated for its energy, and the past of
// what acts with a delay.
#pragma once

#include <memory>
#include <vector>

#include "motion/course.hpp"
#include "motion/hybrid/solver.hpp"

namespace dinal::motion::hybrid {

/// What is kept of a solved piece, or of its beginning when an event ended it there.
struct Piece {
    Clock start;
    double h = 0;
    double length = 0;  ///< how much of it was used, at most 2 h
    model::Motion way = model::Motion::stuck;
    bool leans = false;  ///< stuck at a wall
    Values begin{};
    std::vector<Series> series{};  ///< of each value less its first
    Series M{};
    model::SpeedRange friction{};  ///< if straight, what friction was along it, also beyond what was used
    struct Surroundings {
        Series push{}, belt{}, belt_rate{};
    };
    std::shared_ptr<const Surroundings> around = {};  ///< null without a belt and a base, as most are

    [[nodiscard]] const Surroundings& surroundings() const {
        static constexpr Surroundings still{};
        return around != nullptr ? *around : still;
    }
    [[nodiscard]] double value(std::size_t k, double x) const {
        return x <= -1 ? begin[k] : begin[k] + spectral::chebyshev::value(series[k], std::min(x, 1.0));
    }
    [[nodiscard]] double x(double t) const { return start.until(t) / h - 1; }
};

class Pieces final : public Course, public Past {
public:
    /// `before` is the past of a run that goes on; `whole` when pieces are the motion itself and not between steps.
    Pieces(const model::Oscillator& system, const model::State& initial, double t_start,
           std::shared_ptr<const Pieces> before, std::size_t most_bytes, bool whole);

    void add(Piece piece);
    /// What took no time: what a user did to the motion at one of his events, an impact.
    void add_jump(double t, const Work& work) { jumps_.push_back({list_.size(), t, work}); }
    /// Where the run has ended: what took no time then counts from there on.
    void close(const Clock& end, Values state);
    /// Keeps only what is later than this time.
    void forget(double t);

    [[nodiscard]] text::Expected<model::State> at(double t) const override;
    [[nodiscard]] std::vector<double> states_at(double t) const override;
    [[nodiscard]] double whole_until() const override { return whole_ && complete_ ? model::never : -model::never; }
    void legs(const std::function<void(const Leg&)>& told) const override;
    [[nodiscard]] std::size_t bytes() const override { return bytes_; }
    [[nodiscard]] model::State at(double t, Side side) const override;

private:
    [[nodiscard]] const Piece* piece_at(double t, Side side) const;

    model::State initial_;
    double t_start_;
    std::shared_ptr<const Pieces> before_;
    std::size_t most_, bytes_ = 0;
    bool whole_, complete_ = true;
    std::vector<Piece> list_;
    struct Jump {
        std::size_t piece;  // the one that comes after it
        double t;
        Work work;
    };
    std::vector<Jump> jumps_;
};

}  // namespace dinal::motion::hybrid
