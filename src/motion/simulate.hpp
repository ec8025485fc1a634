// The entry point of the core: simulates a system under a drive with an integrator; returns a run.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "model/drive.hpp"
#include "model/excitation.hpp"
#include "model/oscillator.hpp"
#include "model/system.hpp"
#include "motion/growing.hpp"
#include "motion/method.hpp"
#include "motion/run.hpp"
#include "text/expected.hpp"

namespace dinal::motion {

/// The time span of a run; start < end, both finite.
struct Window {
    double start = 0;
    double end = 0;

    /// An error if the window is invalid, or so long that powers of its length overflow.
    [[nodiscard]] std::optional<text::Error> complaint() const;
};

/// The times of the requested rows.
class Grid {
public:
    /// start, start + dt, ... and always end as the last row, exactly.
    static Grid every(double dt) { return Grid(true, dt, {}); }
    /// Rows at these times, strictly increasing and within the window; may be empty.
    static Grid at(std::vector<double> times) { return Grid(false, 0, Growing<double>(std::move(times))); }
    static Grid none() { return Grid(false, 0, {}); }

    /// A list of times: the first `kept` of this grid, which are already rows, followed by `more`.
    Grid followed_by(std::size_t kept, std::vector<double> more) const;

    /// Fails if dt is not positive, or times do not increase or leave the window.
    text::Expected<Grid> within(const Window& window) const;
    double dt() const { return dt_; }
    std::span<const double> times() const { return times_; }

    // Requires a grid from within():
    const Window& window() const { return window_; }
    std::size_t count() const { return count_; }
    double time(std::size_t row) const {
        if (!spaced_) return list_[row];
        // A signed number is converted by one instruction.
        return row + 1 == count_ ? window_.end : window_.start + static_cast<double>(static_cast<long long>(row)) * dt_;
    }

private:
    Grid(bool spaced, double dt, Growing<double> times) : spaced_(spaced), dt_(dt), times_(std::move(times)) {}

    bool spaced_;
    double dt_;
    Growing<double> times_;
    std::size_t known_ = 0;  // number of times that have been checked
    Window window_;
    std::size_t count_ = 0;
    const double* list_ = nullptr;  // the times
};

/// Called now and then with the time reached; returns false to stop the run, which keeps its results
/// (Outcome::interrupted).
using Monitor = std::function<bool(double t)>;

struct Limits {
    std::size_t memory = std::size_t{4} << 30;  ///< bytes for the rows; a quarter of it for the course
    bool dense = true;                          ///< whether to keep the course, the motion between the rows
};

/// An error if the method cannot run this system, M or window, for example if its steps would miss a detail of M.
[[nodiscard]] std::optional<text::Error> wrong_method(MethodView method, const model::Oscillator& system,
                                                      const model::Excitation& excitation, const Window& window);

/// An error if the rows need more memory than allowed, or are closer than the rounding of times. Requires a grid from
/// within().
[[nodiscard]] std::optional<text::Error> wrong_rows(const Grid& grid, std::size_t columns, const Limits& limits);

/// A validated run as its integrator sees it.
struct Problem {
    const model::Oscillator& system;
    const model::Drive& drive;
    Window window;
    const Grid& rows;
    const Monitor& monitor;
    const Limits& limits;
    std::optional<model::Motion> before = {};  ///< motion at the end of the run that is continued
    std::size_t course_bytes = 0;              ///< memory limit of the course
    bool more = false;  ///< whether there are walls, controllers, or a drive in addition to M, such as a belt
    const engine::Left* left = nullptr;  ///< state at the end of the run that is continued
};

/// Runs from the drive's initial state at window.start. Fails before the first step if the window, the grid or the
/// integrator's options are invalid or the rows do not fit; later failures are outcomes of the run.
text::Expected<Run> simulate(const model::Oscillator& system, const model::Drive& drive, const Window& window,
                             const Grid& rows, MethodView method, const Monitor& monitor = {},
                             const Limits& limits = {});

/// The same for any system. If its bodies have names, the rows have the columns of all bodies and links, and only the
/// views of single parts have a course.
text::Expected<Run> simulate(const model::System& system, const model::Drive& drive, const Window& window,
                             const Grid& rows, MethodView method, const Monitor& monitor = {},
                             const Limits& limits = {});

/// Continues `so_far` from its end to t_end, as if it had not been interrupted. Returns the joined run, which shares
/// the data of `so_far`. `rows` covers both parts; `so_far` already has the first of them, and perhaps one more at its
/// end. Fails like simulate().
text::Expected<Run> resume(const model::Oscillator& system, const model::Drive& drive, const Run& so_far, double t_end,
                           const Grid& rows, MethodView method, const Monitor& monitor = {}, const Limits& limits = {});

text::Expected<Run> resume(const model::System& system, const model::Drive& drive, const Run& so_far, double t_end,
                           const Grid& rows, MethodView method, const Monitor& monitor = {}, const Limits& limits = {});

/// Turns the run of the general engine into that of an unnamed body if the system is plain.
Run completed(const model::System& system, const model::Drive& drive, Run run);
/// The run as one body or link sees it, as a view; the run itself for an unnamed body.
Run part_of(const model::System& system, const model::Drive& drive, const Run& run, std::size_t joint);
/// The number of columns of a run's rows.
std::size_t columns_of(const model::System& system, const model::Drive& drive);

// ---- a continued run: the rows that exist, and those still to be computed

/// All rows of a run continued to t_end. Fails as simulate() does.
text::Expected<Grid> grid_of_both(const Run& so_far, double t_end, const Grid& rows, std::size_t columns,
                                  const Limits& limits);

struct RowsToCome {
    std::size_t kept;  ///< rows of the first part that remain
    std::vector<double> times;
};
RowsToCome rows_to_come(const Run& so_far, const Grid& grid);

}  // namespace dinal::motion
