// The motion of a spectral run as the panels it was computed on: evaluated anywhere, integrated for its energy.
#pragma once

#include <memory>
#include <vector>

#include "model/friction.hpp"
#include "model/oscillator.hpp"
#include "motion/spectral/chebyshev.hpp"
#include "motion/spectral/clock.hpp"

namespace dinal::motion::spectral {

/// The motion over one panel, or its beginning when an event ended it there.
struct Panel {
    Clock start;
    double h = 0;       ///< half the length of the panel on which the series live, time units
    double length = 0;  ///< how much of it was used, at most 2 h
    model::State begin;
    model::Motion motion = model::Motion::stuck;
    chebyshev::Series<chebyshev::points> w{};  ///< h^2 theta''; without meaning while stuck
    chebyshev::Series<chebyshev::points> M{};

    [[nodiscard]] double x(double t) const { return start.until(t) / h - 1; }
    /// h theta'.
    [[nodiscard]] auto velocity() const { return chebyshev::integral(w, h * begin.velocity); }
    /// theta and velocity at -1 <= x <= 1.
    [[nodiscard]] model::State at(double x) const;
};

/// All panels of a run, in order and without gaps. Kept in chunks, so that growing copies nothing.
class Panels {
public:
    /// `most_bytes` is what they may take; what comes later is not kept.
    Panels(const model::Oscillator& system, std::size_t most_bytes)
        : system_(system), most_(most_bytes / sizeof(Panel)) {}

    Panels(const Panels& other) : system_(other.system_), most_(other.most_) { append(other); }
    Panels& operator=(const Panels&) = delete;
    ~Panels() = default;

    void add(const Panel& panel);
    void append(const Panels& later);
    [[nodiscard]] const model::Oscillator& system() const { return system_; }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] const Panel& operator[](std::size_t i) const { return (*chunks_[i / chunk])[i % chunk]; }
    /// Until when there are panels; before that time `complete` is not the question.
    [[nodiscard]] double end() const;
    /// Whether none had to be left out.
    [[nodiscard]] bool complete() const { return complete_; }
    /// theta and velocity at a time that the panels cover.
    [[nodiscard]] model::State at(double t) const;

private:
    static constexpr std::size_t chunk = 128;  // below the size from which memory comes from the system, untouched
    using Chunk = std::array<Panel, chunk>;

    model::Oscillator system_;
    std::size_t most_;
    std::size_t size_ = 0;
    bool complete_ = true;
    std::vector<std::unique_ptr<Chunk>> chunks_;
};

}  // namespace dinal::motion::spectral
