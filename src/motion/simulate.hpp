// The one entry point of the core: a system, an excitation and an integrator go in, a trajectory comes out.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "model/drive.hpp"
#include "model/excitation.hpp"
#include "model/oscillator.hpp"
#include "model/system.hpp"
#include "motion/growing.hpp"
#include "motion/method.hpp"
#include "motion/trajectory.hpp"
#include "text/expected.hpp"

namespace dinal::motion {

/// The span of time of a run; start < end, both finite.
struct Window {
    double start = 0;
    double end = 0;

    /// A sentence when it is not that, or so long that powers of its length overflow.
    [[nodiscard]] std::optional<text::Error> complaint() const;
};

/// The times at which rows are wanted.
class Grid {
public:
    /// start, start + dt, ... and always end as the last row, exactly.
    static Grid every(double dt) { return Grid(true, dt, {}); }
    /// These times, strictly increasing and within the window; none at all is fine.
    static Grid at(std::vector<double> times) { return Grid(false, 0, Growing<double>(std::move(times))); }
    static Grid none() { return Grid(false, 0, {}); }

    /// Of a list of times of which `kept` were rows of a run: these, and then `more` of them.
    [[nodiscard]] Grid followed_by(std::size_t kept, std::vector<double> more) const;

    /// Fails when dt is not positive, the times do not increase or leave the window.
    [[nodiscard]] text::Expected<Grid> within(const Window& window) const;
    [[nodiscard]] double dt() const { return dt_; }
    [[nodiscard]] std::span<const double> times() const { return times_; }

    // Of a grid that went through within():
    [[nodiscard]] const Window& window() const { return window_; }
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] double time(std::size_t row) const {
        if (!spaced_) return list_[row];
        return row + 1 == count_ ? window_.end : window_.start + static_cast<double>(row) * dt_;
    }

private:
    Grid(bool spaced, double dt, Growing<double> times) : spaced_(spaced), dt_(dt), times_(std::move(times)) {}

    bool spaced_;
    double dt_;
    Growing<double> times_;
    std::size_t known_ = 0;  // so many of the times are right
    Window window_;
    std::size_t count_ = 0;
    const double* list_ = nullptr;  // the times
};

/// Called now and then with the time reached; false stops the run, which keeps what it has (Outcome::interrupted).
using Monitor = std::function<bool(double t)>;

struct Limits {
    std::size_t memory = std::size_t{4} << 30;  ///< bytes that the rows may take, and a quarter of it the course
    bool dense = true;                          ///< keep the course: what the motion between the rows needs
};

/// What this method cannot run: the system under this M, or a window in which its steps are lost or pass over a bump.
[[nodiscard]] std::optional<text::Error> wrong_method(MethodView method, const model::Oscillator& system,
                                                      const model::Excitation& excitation, const Window& window);

/// The reason why a run can not have these rows, in the user's options: more than memory may hold, or times that
/// doubles can not tell apart. The grid went through within().
[[nodiscard]] std::optional<text::Error> wrong_rows(const Grid& grid, std::size_t columns, const Limits& limits);

/// One run as its integrator sees it: all of it checked.
struct Problem {
    const model::Oscillator& system;
    const model::Drive& drive;
    Window window;
    const Grid& rows;
    const Monitor& monitor;
    const Limits& limits;
    std::optional<model::Motion> before = {};  ///< of a run that goes on: what the mass did until now
    std::size_t course_bytes = 0;              ///< what the course may take
    bool more = false;                 ///< the drive has more than M, or there are walls or controllers with a memory
    const Carried* carried = nullptr;  ///< of a run that goes on: what its integrator left
};

/// Runs from where the drive has its start, at window.start. Fails (before the first step) when the window, the grid or
/// the integrator's options are wrong or the rows would not fit; whatever happens later is told by the outcome of the
/// trajectory.
text::Expected<Trajectory> simulate(const model::Oscillator& system, const model::Drive& drive, const Window& window,
                                    const Grid& rows, MethodView method, const Monitor& monitor = {},
                                    const Limits& limits = {});

/// The same of any system: of one with names all columns, and no course, which is that of its parts.
text::Expected<Trajectory> simulate(const model::System& system, const model::Drive& drive, const Window& window,
                                    const Grid& rows, MethodView method, const Monitor& monitor = {},
                                    const Limits& limits = {});

/// Goes on from where `so_far` ended, to t_end, as if it had not been interrupted: the trajectory of both, which shares
/// with `so_far` what that has. `rows` are those of all of it; `so_far` has the first of them, and perhaps one at its
/// end. Fails like simulate().
text::Expected<Trajectory> resume(const model::Oscillator& system, const model::Drive& drive, const Trajectory& so_far,
                                  double t_end, const Grid& rows, MethodView method, const Monitor& monitor = {},
                                  const Limits& limits = {});

text::Expected<Trajectory> resume(const model::System& system, const model::Drive& drive, const Trajectory& so_far,
                                  double t_end, const Grid& rows, MethodView method, const Monitor& monitor = {},
                                  const Limits& limits = {});

/// The run of all bodies as a trajectory: of one with names all columns.
Trajectory trajectory_of(const model::System& system, const model::Drive& drive,
                         std::shared_ptr<const engine::Run> run);
/// As seen from this body or link.
Trajectory seen_from(const model::System& system, const model::Drive& drive, std::shared_ptr<const engine::Run> run,
                     std::size_t joint);
/// How many columns its rows have.
std::size_t columns_of(const model::System& system, const model::Drive& drive);
/// Whether the motion between the rows was kept.
bool is_dense(const Trajectory& trajectory);

}  // namespace dinal::motion
