// The one entry point of the core: a system, an excitation and an integrator go in, a trajectory comes out.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "model/excitation.hpp"
#include "model/oscillator.hpp"
#include "motion/integrator.hpp"
#include "motion/trajectory.hpp"
#include "text/expected.hpp"

namespace dinal::motion {

/// The span of time of a run; start < end, both finite.
struct Window {
    double start = 0;
    double end = 0;
};

/// The times at which rows are wanted.
class Grid {
public:
    /// start, start + dt, ... and always end as the last row, exactly.
    static Grid every(double dt) { return Grid(true, dt, {}); }
    /// These times, strictly increasing and within the window; none at all is fine.
    static Grid at(std::vector<double> times) { return Grid(false, 0, std::move(times)); }
    static Grid none() { return Grid(false, 0, {}); }

    /// Fails when dt is not positive, the times do not increase or leave the window.
    [[nodiscard]] text::Expected<Grid> within(const Window& window) const;
    [[nodiscard]] double dt() const { return dt_; }
    [[nodiscard]] const std::vector<double>& times() const { return times_; }

    // Of a grid that went through within():
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] double time(std::size_t row) const {
        if (!spaced_) return times_[row];
        return row + 1 == count_ ? window_.end : window_.start + static_cast<double>(row) * dt_;
    }

private:
    Grid(bool spaced, double dt, std::vector<double> times) : spaced_(spaced), dt_(dt), times_(std::move(times)) {}

    bool spaced_;
    double dt_;
    std::vector<double> times_;
    Window window_;
    std::size_t count_ = 0;
};

/// Called now and then with the time reached; false stops the run, which keeps what it has (Outcome::interrupted).
using Monitor = std::function<bool(double t)>;

struct Limits {
    std::size_t memory = std::size_t{4} << 30;  ///< bytes that the rows may take, and the motion between them
    bool dense = true;                          ///< keep what is needed to evaluate the motion between the rows
};

/// One run as its integrator sees it: all of it checked.
struct Problem {
    const model::Oscillator& system;
    const model::Excitation& excitation;
    model::State initial;
    Window window;
    const Grid& rows;
    const Monitor& monitor;
    const Limits& limits;
    std::optional<model::Motion> before =
        {};  ///< of a run that goes on: what the mass did until now; its start is an event
};

/// Runs from `initial` at window.start. Fails (before the first step) when the window, the grid or the integrator's
/// options are wrong or the rows would not fit; whatever happens later is told by the outcome of the trajectory.
text::Expected<Trajectory> simulate(const model::Oscillator& system, const model::Excitation& excitation,
                                    const model::State& initial, const Window& window, const Grid& rows,
                                    const Integrator& integrator, const Monitor& monitor = {},
                                    const Limits& limits = {});

/// Goes on from where `so_far` ended, to t_end, as if it had not been interrupted: the trajectory of both. `rows` are
/// those of all of it; the ones that `so_far` has are kept. Fails like simulate().
text::Expected<Trajectory> resume(const model::Oscillator& system, const model::Excitation& excitation,
                                  const Trajectory& so_far, double t_end, const Grid& rows,
                                  const Integrator& integrator, const Monitor& monitor = {}, const Limits& limits = {});

}  // namespace dinal::motion
