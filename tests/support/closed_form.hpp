// Reference solutions for tests: exact solutions between events, joined by the stick/slip law, in long double.
//
// Uses only type names of src: no Runge-Kutta, no friction.hpp, no excitation.cpp.
#pragma once

#include <cstddef>
#include <vector>

#include "model/event.hpp"
#include "model/oscillator.hpp"
#include "support/kinds.hpp"

namespace dinal::truth {

using real = long double;

/// M(t) = level + slope t + amplitude sin(omega t + phase), until the next piece begins.
struct Drive {
    real level = 0, slope = 0, amplitude = 0, omega = 0, phase = 0;
};
struct Piece {
    real from = 0;
    Drive drive;
};

struct Motion {
    real theta = 0, velocity = 0;
};
struct TrueEvent {
    real t = 0;
    model::EventKind kind = model::EventKind::turn;
    real theta = 0;
};

/// I theta'' + C theta' + k theta = drive - s Rd, solved exactly from a given moment: any damping, any resonance.
class Arc {
public:
    Arc(const model::Oscillator& system, const Drive& drive, int sign, real t0, const Motion& start);
    [[nodiscard]] Motion at(real t) const;
    [[nodiscard]] real acceleration(real t) const;
    [[nodiscard]] real start() const { return t0_; }

private:
    [[nodiscard]] Motion free(real tau, const Motion& y) const;
    [[nodiscard]] Motion particular(real tau) const;

    real I_, C_, k_, w0_, b_, disc_;  // b = C / 2I, disc = b^2 - w0^2
    Drive drive_;
    real t0_, p_, q_;  // p + q tau is the response to level and slope
    real load_;        // level - s Rd at t0
    Motion offset_;    // initial value of the free part
};

/// The whole motion, arc by arc, with its events.
class ExactMotion {
public:
    /// The first of `drives` begins at or before t_start; the beginnings of later ones are the breaks of M.
    ExactMotion(const model::Oscillator& system, std::vector<Piece> drives, const model::State& initial, double t_start,
                double t_end);

    [[nodiscard]] Motion at(double t) const;
    /// In dinal's convention: none at t_start, and a stick that is never broken is a rest.
    [[nodiscard]] const std::vector<TrueEvent>& events() const& { return events_; }
    [[nodiscard]] std::size_t count(model::EventKind kind) const;
    [[nodiscard]] bool ends_stuck() const { return ends_stuck_; }
    [[nodiscard]] real excitation(double t) const;

private:
    struct Span {
        real from;
        bool stuck;
        Motion held;  // when stuck
        Arc arc;      // when moving
    };
    struct Cursor {
        real t;
        Motion y;
        int sign;  // 0: stuck
    };
    void advance(Cursor& now, const Drive& drive, real until);
    void move(Cursor& now, const Drive& drive, real until);
    void wait(Cursor& now, const Drive& drive, real until);
    [[nodiscard]] int from_standstill(const Drive& drive, real t, real theta) const;

    model::Oscillator system_;
    std::vector<Piece> drives_;
    real t_start_;
    real scan_;  // resolution of the search for zeros of the velocity or its derivative
    std::vector<Span> spans_;
    std::vector<TrueEvent> events_;
    bool ends_stuck_ = false;
};

}  // namespace dinal::truth
