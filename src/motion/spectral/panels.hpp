// The motion of a spectral run as the panels it was computed on: evaluated anywhere, integrated for its energy.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "model/friction.hpp"
#include "model/oscillator.hpp"
#include "motion/clock.hpp"
#include "motion/course.hpp"
#include "motion/spectral/chebyshev.hpp"

namespace dinal::motion::spectral {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// The motion over one panel, or its beginning when an event ended it there.
struct Panel {
    Clock start;
    double h = 0;       ///< half the length of the panel on which the series live, time units
    double length = 0;  ///< how much of it was used, at most 2 h
    model::State begin;
    model::Motion motion = model::Motion::stuck;
    std::int32_t line = -1;  ///< of the ranges of the law of friction, if friction is straight on it: this one
    chebyshev::Series<chebyshev::points> w{};  ///< h^2 theta''; without meaning while stuck
    chebyshev::Series<chebyshev::points> M{};

    [[nodiscard]] double x(double t) const { return start.until(t) / h - 1; }
    /// h theta'.
    [[nodiscard]] auto velocity() const { return chebyshev::integral(w, h * begin.velocity); }
    /// theta and velocity at -1 <= x <= 1.
    [[nodiscard]] model::State at(double x) const;
};

/// All panels of a run, in order and without gaps. Kept in chunks, so that growing copies nothing; small ones at first,
/// because most runs at a prompt are short.
class Panels final : public Course {
public:
    /// `most_bytes` is what they may take; what comes later is not kept.
    Panels(const model::Oscillator& system, std::size_t most_bytes)
        : Course(system), most_(most_bytes / sizeof(Panel)) {}

    void add(const Panel& panel);
    [[nodiscard]] std::size_t size() const { return size_; }

    [[nodiscard]] text::Expected<model::State> at(double t) const override;
    [[nodiscard]] double whole_until() const override;
    void legs(const std::function<void(const Leg&)>& told) const override;
    [[nodiscard]] std::size_t bytes() const override { return size_ * sizeof(Panel); }

private:
    // Chunks of 4, 4, 8, 16 ... panels, from some size on all alike: below the size from which memory comes from the
    // system, untouched.
    static constexpr std::size_t first_chunk = 4, last_chunk = 128;
    static std::size_t chunk_of(std::size_t panel) {
        if (panel >= last_chunk) return panel / last_chunk + chunk_of(last_chunk - 1);
        return panel < first_chunk ? 0 : static_cast<std::size_t>(std::bit_width(panel / first_chunk));
    }
    static std::size_t begin_of(std::size_t panel) {
        if (panel >= last_chunk) return panel / last_chunk * last_chunk;
        return panel < first_chunk ? 0 : std::bit_floor(panel);
    }
    [[nodiscard]] const Panel& panel(std::size_t i) const { return chunks_[chunk_of(i)][i - begin_of(i)]; }
    [[nodiscard]] double end() const;

    std::size_t most_;
    std::size_t size_ = 0;
    bool complete_ = true;
    std::vector<std::vector<Panel>> chunks_;
};

}  // namespace dinal::motion::spectral
