// The motion of an exact run as its arcs; the initial values of each determine its closed form.
#pragma once

#include <vector>

#include "model/excitation.hpp"
#include "motion/clock.hpp"
#include "motion/course.hpp"

namespace dinal::motion::exact {

/// An arc of a run, or a rest.
struct KeptArc {
    Clock start;
    double length = 0;
    double asked = 0;  ///< requested length, which affects the choice of the closed form
    model::State begin;
    double theta_rest = 0;  ///< rounding error of theta at the start
    double pull = 0;        ///< M - k theta minus the braking of friction, at the start
    model::Motion motion = model::Motion::stuck;
    bool rests = true;
};

/// All arcs of a run, in order and without gaps.
class Arcs final : public Course {
public:
    /// `most_bytes` limits the memory; later arcs are dropped.
    Arcs(const model::Oscillator& system, const model::Excitation& excitation, std::size_t most_bytes)
        : Course(system), excitation_(excitation), most_(most_bytes / sizeof(KeptArc)) {
        constexpr std::size_t few = 8;
        arcs_.reserve(few);
    }

    void add(const KeptArc& arc) {
        if (arcs_.size() >= most_) complete_ = false;
        if (complete_) arcs_.push_back(arc);
    }

    [[nodiscard]] text::Expected<model::State> at(double t) const override;
    [[nodiscard]] double whole_until() const override;
    void legs(const std::function<void(const Leg&)>& visit) const override;
    [[nodiscard]] std::size_t bytes() const override { return arcs_.size() * sizeof(KeptArc); }

private:
    [[nodiscard]] double end() const { return arcs_.back().start.after(arcs_.back().length); }

    model::Excitation excitation_;
    std::size_t most_;
    bool complete_ = true;
    std::vector<KeptArc> arcs_;
};

}  // namespace dinal::motion::exact
