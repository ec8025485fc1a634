#include "motion/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "model/controller.hpp"
#include "model/springs.hpp"
#include "motion/stillness.hpp"
#include "motion/witness.hpp"

namespace dinal::motion {

namespace {

/// The share of the allowed memory for the motion between the rows, in addition to the rows.
constexpr std::size_t share_of_course = 4;
constexpr std::size_t all_memory = std::numeric_limits<std::size_t>::max();

/// An error for the first invalid time of a list, or none. The first `known` have been checked before.
std::optional<text::Error> wrong_times(std::span<const double> times, std::size_t known, const Window& window) {
    for (std::size_t i = known; i < times.size(); ++i) {
        const double t = times[i];
        if (!std::isfinite(t))
            return text::Error{.sentence = fmt::format("times[{}] = {} must be a finite number", i + 1, t),
                               .option = "times"};
        if (i > 0 && !(t > times[i - 1])) {
            return text::Error{
                .sentence = fmt::format("times[{}] = {:.17g} is not after times[{}] = {:.17g}: times must increase",
                                        i + 1, t, i, times[i - 1]),
                .option = "times"};
        }
        if (t < window.start || t > window.end) {
            return text::Error{
                .sentence = fmt::format("times[{}] = {:.17g} is outside the run from t_start = {} to t_end = {}", i + 1,
                                        t, window.start, window.end),
                .option = "times"};
        }
    }
    return {};
}

/// "48 GB"
std::string memory_text(double bytes) {
    constexpr std::array<const char*, 5> units = {"kB", "MB", "GB", "TB", "PB"};
    std::size_t i = 0;
    for (bytes /= 1000; bytes >= 1000 && i + 1 < units.size(); ++i) bytes /= 1000;
    return fmt::format("{:.3g} {}", bytes, units[i]);
}

/// The number of rows with spacing dt: start + i dt before the end, and the end. A double, as it may overflow an
/// integer.
double row_count(const Window& window, double dt) {
    const double ratio = (window.end - window.start) / dt;
    const double whole = std::round(ratio), latest = std::max(std::fabs(window.start), std::fabs(window.end));
    // A last interval below the rounding of the division, or of the times, does not count.
    const double rounding = 4e-16 * whole + std::numeric_limits<double>::epsilon() * latest / dt;
    return std::fabs(ratio - whole) <= rounding ? whole + 1 : std::floor(ratio) + 2;
}

double latest_time(const Window& window) {
    return std::max(std::fabs(window.start), std::fabs(window.end));
}
/// The distance of neighbouring doubles near the latest time.
double rounding_of_time(const Window& window) {
    return std::numeric_limits<double>::epsilon() * latest_time(window);
}

/// An error unless the spacing is well above the rounding of times.
std::optional<text::Error> lost_in_time(const char* name, double spacing, const Window& window) {
    const double latest = latest_time(window), least = 16 * rounding_of_time(window);
    if (spacing >= least) return {};
    return text::Error{
        .sentence = fmt::format(
            "{} = {:.6g} is lost in the rounding of times near {:.6g}: use at least {:.2g}, or start nearer to t = 0",
            name, spacing, latest, 1.1 * least),
        .option = name};
}

/// An error if steps of this size could miss a detail of M.
std::optional<text::Error> stepped_over(const char* name, double step, const model::Excitation& M,
                                        const Window& window) {
    const auto [from, to, apart] = M.finest_detail(window.start, window.end);
    if (step <= apart * (1 + 1e-12)) return {};  // equal to the digits shown
    return text::error(
        "{} = {:.6g} is too long for the narrow bump of M between t = {:.6g} and {:.6g}: use {} <= {:.4g}, or "
        "integrator.spectral{{}}",
        name, step, from, to, name, 0.999 * apart);
}

/// An error for a sine with more than one turn between neighbouring times: its phase is undefined.
std::optional<text::Error> lost_sine(const model::Harmonic& sine, const Window& window) {
    const double omega = std::fabs(sine.omega), most = 2 * std::numbers::pi / rounding_of_time(window);
    if (omega <= most) return {};
    return text::Error{
        .sentence = fmt::format(
            "a sine of omega = {:.6g} is lost in the rounding of times near {:.6g}: use at most omega = {:.2g} "
            "(frequency "
            "= {:.2g}), or start nearer to t = 0",
            omega, latest_time(window), 0.9 * most, 0.9 * most / (2 * std::numbers::pi)),
        .option = "M"};
}

/// An error for a term of M whose period or delay is below the rounding of times.
std::optional<text::Error> lost_term(const model::Excitation& excitation, const Window& window) {
    for (const model::Component& c : excitation.components()) {
        if (const auto* sine = std::get_if<model::Harmonic>(&c.term)) {
            if (auto lost = lost_sine(*sine, window)) return lost;
            continue;
        }
        const auto* sampled = model::controller_of<model::SampledController>(c);
        const auto* delayed = model::controller_of<model::DelayedController>(c);
        const double period = std::visit([](const auto& term) { return model::terms::period_of(term); }, c.term);
        const char* name = sampled != nullptr ? "every" : delayed != nullptr ? "by" : "period";
        const double spacing = sampled != nullptr ? sampled->every : delayed != nullptr ? delayed->by : period;
        if (!(spacing > 0)) continue;
        if (auto lost = lost_in_time(name, spacing, window)) return lost;
    }
    return {};
}

}  // namespace

std::optional<text::Error> Window::complaint() const {
    constexpr double longest = 1e70;  // time units: bounds of motions use the fourth power
    if (!std::isfinite(start)) {
        return text::Error{.sentence = fmt::format("t_start = {} must be a finite number", start), .option = "t_start"};
    }
    if (!std::isfinite(end)) {
        return text::Error{.sentence = fmt::format("t_end = {} must be a finite number", end), .option = "t_end"};
    }
    if (!(end > start)) {
        return text::Error{.sentence = fmt::format("t_end = {} must be after t_start = {}", end, start),
                           .option = "t_end"};
    }
    if (!(end - start <= longest)) {
        return text::Error{.sentence = fmt::format("t_end = {} is more than {} after t_start = {}: choose a longer "
                                                   "unit of time",
                                                   end, longest, start),
                           .option = "t_end"};
    }
    return std::nullopt;
}

text::Expected<Grid> Grid::within(const Window& window) const {
    Grid grid = *this;
    grid.window_ = window;
    grid.count_ = times_.size();
    if (spaced_) {
        if (!(dt_ > 0) || !std::isfinite(dt_))
            return text::Error{.sentence = fmt::format("dt = {:.6g} must be positive and finite", dt_), .option = "dt"};
        grid.count_ = static_cast<std::size_t>(std::min(row_count(window, dt_), 1e18));
    } else {
        const std::span<const double> times = grid.times_;
        if (auto wrong = wrong_times(times, known_, window)) return *wrong;
        grid.known_ = times.size();
        grid.list_ = times.data();
    }
    return grid;
}

std::optional<text::Error> wrong_method(MethodView method, const model::Oscillator& system,
                                        const model::Excitation& excitation, const Window& window) {
    if (auto wrong = method.wrong(system, excitation)) return wrong;
    const auto [name, distance, is_step] = method.resolution(system);
    if (auto lost = lost_in_time(name, distance, window)) return lost;
    return is_step ? stepped_over(name, distance, excitation, window) : std::nullopt;
}

std::optional<text::Error> wrong_rows(const Grid& grid, std::size_t columns, const Limits& limits) {
    const Window& window = grid.window();
    const auto count = static_cast<double>(grid.count()), memory = static_cast<double>(limits.memory);
    const double row = static_cast<double>(columns) * sizeof(double);
    if (count * row > memory) {
        return text::error("{:.3g} rows need {} and {} are allowed: use dt >= {:.2g}, or times = {{...}}", count,
                           memory_text(count * row), memory_text(memory),
                           std::max(grid.dt(), (window.end - window.start) / (memory / row)));
    }
    return grid.dt() > 0 ? lost_in_time("dt", grid.dt(), window) : std::nullopt;
}

Grid Grid::followed_by(std::size_t kept, std::vector<double> more) const {
    Grid grid = *this;
    grid.times_ = times_.followed_by(kept, Growing<double>(std::move(more)), all_memory);
    grid.known_ = kept;
    return grid;
}

namespace {

/// The state of a run that is being continued.
struct Past {
    std::optional<model::Motion> motion;
    std::size_t course_bytes = 0;
    const engine::Left* left = nullptr;
};

text::Expected<Run> run_from(const Past& past, const model::Oscillator& system, const model::Drive& drive,
                             const Window& window, const Grid& rows, MethodView method, const Monitor& monitor,
                             const Limits& limits) {
    const model::State initial = drive.start();
    if (!std::isfinite(initial.theta))
        return text::Error{.sentence = fmt::format("theta0 = {} must be a finite number", initial.theta),
                           .option = "theta0"};
    if (!std::isfinite(initial.velocity))
        return text::Error{.sentence = fmt::format("velocity0 = {} must be a finite number", initial.velocity),
                           .option = "velocity0"};
    if (auto wrong = window.complaint()) return *wrong;
    if (system.walls()) {
        if (auto wrong = system.walls()->crossed_by(initial.theta)) return *wrong;
    }
    auto grid = rows.within(window);
    if (!grid) return grid.error();
    if (auto wrong = wrong_rows(*grid, column_count, limits)) return *wrong;
    for (const model::Excitation* terms : {&drive.M(), &drive.belt(), &drive.base}) {
        if (auto lost = lost_term(*terms, window)) return *lost;
    }
    if (auto wrong = wrong_method(method, system, drive.M(), window)) return *wrong;

    const std::size_t course_bytes = limits.memory / share_of_course;
    std::optional<UnderOath> oath;
    if (!method.evaluates_in_order() && has_functions(system, drive)) oath.emplace(system, drive);
    Problem problem{oath ? oath->system() : system,
                    oath ? oath->drive() : drive,
                    window,
                    *grid,
                    monitor,
                    limits,
                    past.motion,
                    course_bytes - std::min(course_bytes, past.course_bytes)};
    const bool more = drive.has_more() || system.walls() || model::has_memory(drive.M());
    if (more && !method.cut()) {
        return text::Error{
            .sentence = fmt::format("{} does not support states, events, belts, bases and controllers with memory: use "
                                    "integrator.spectral or rk4",
                                    method.about().call.name),
            .option = "integrator"};
    }
    problem.left = past.left;
    problem.more = more;
    Run run = method.run(problem);
    run.initial = initial;
    // A native M is always finite, so the spring torque overflowed: the motion diverged.
    const bool own_spring = system.spring().as<model::springs::PolynomialSpring>() != nullptr;
    if (run.outcome == model::Outcome::excitation_not_finite && own_spring && !drive.M().has_script() &&
        std::isfinite(drive.M().most())) {
        run.outcome = model::Outcome::state_not_finite;
    }
    if (oath) {
        const bool whole = model::is_whole(run.outcome) || run.outcome == model::Outcome::stopped;
        run.contradiction = oath->verdict(whole);
        if (run.contradiction) run.outcome = model::Outcome::not_a_function;
    }
    return run;
}

/// Returns whether the mass stood at the end, permanently or not.
bool stands(model::Outcome outcome) {
    return outcome == model::Outcome::at_rest || outcome == model::Outcome::stuck_at_end;
}

/// The events of both parts; a rest at the end of the first becomes a stick.
Growing<model::Event> joined(const Run& so_far, const Run& second) {
    const Growing<model::Event>& first = so_far.events;
    std::vector<model::Event> later;
    std::size_t kept = first.size();
    std::size_t stop = kept;  // a user's event may follow the stop
    while (stop > 0 && first[stop - 1].kind > model::EventKind::rest) --stop;
    const bool stopped = stop > 0 && model::is_stop(first[stop - 1].kind);
    const bool crept = stands(so_far.outcome) && so_far.motion_at_stop != model::Motion::stuck;
    if (stopped && (crept || first[stop - 1].kind == model::EventKind::rest)) {
        later.assign(first.begin() + static_cast<std::ptrdiff_t>(stop) - 1, first.end());
        kept = stop - 1;
        later.front().kind = model::EventKind::stick;
        if (crept) {  // the mass may still creep
            const bool still =
                stands(second.outcome) && second.events.size() == 1 && second.events.front().t == so_far.t_stop;
            if (still) return first.followed_by(kept, Growing<model::Event>(std::move(later)), all_memory);
            later.erase(later.begin());
        }
    }
    later.insert(later.end(), second.events.begin(), second.events.end());
    return first.followed_by(kept, Growing<model::Event>(std::move(later)), all_memory);
}

/// Appends the second part to the first `kept` rows of the first part.
Run joined(const Run& first, std::size_t kept, Run second, const Limits& limits) {
    const std::size_t most = limits.memory / (column_count * sizeof(double));
    second.rows = Rows(first.rows.table().followed_by(kept, second.rows.table(), most));
    second.events = joined(first, second);
    second.course = joined(first.course, second.t_start, std::move(second.course));
    second.initial = first.initial;
    second.began_stuck = first.began_stuck, second.began_open = first.began_open;
    second.t_start = first.t_start;
    second.gap = std::max(first.gap, second.gap);
    second.unproven = std::max(first.unproven, second.unproven);
    second.noise = std::max(first.noise, second.noise);
    second.jumps += first.jumps;
    return second;
}

}  // namespace

text::Expected<Run> simulate(const model::Oscillator& system, const model::Drive& drive, const Window& window,
                             const Grid& rows, MethodView method, const Monitor& monitor, const Limits& limits) {
    auto result = run_from({}, system, drive, window, rows, method, monitor, limits);
    if (result) settle(result.value(), system, drive);
    return result;
}

text::Expected<Run> resume(const model::Oscillator& system, const model::Drive& drive, const Run& so_far, double t_end,
                           const Grid& rows, MethodView method, const Monitor& monitor, const Limits& limits) {
    const auto grid = grid_of_both(so_far, t_end, rows, column_count, limits);
    if (!grid) return grid.error();
    const Window window{so_far.t_stop, t_end};
    auto [kept, times] = rows_to_come(so_far, *grid);
    const Past past{so_far.motion_at_stop, so_far.course ? so_far.course->bytes() : 0, so_far.left.get()};
    model::Drive from_there = drive;
    from_there.start_at(so_far.state_at_stop);
    auto second = run_from(past, system, from_there, window, Grid::at(std::move(times)), method, monitor, limits);
    if (!second) return second.error();
    Run whole = joined(so_far, kept, std::move(second).value(), limits);
    settle(whole, system, drive);
    return whole;
}

text::Expected<Grid> grid_of_both(const Run& so_far, double t_end, const Grid& rows, std::size_t columns,
                                  const Limits& limits) {
    if (!(t_end > so_far.t_stop)) {
        return text::Error{
            .sentence = fmt::format("t_end = {} must be after t = {}, where the run ended", t_end, so_far.t_stop),
            .option = "t_end"};
    }
    const Window all{so_far.t_start, t_end};
    if (auto wrong = all.complaint()) return *wrong;
    auto grid = rows.within(all);
    if (!grid) return grid.error();
    if (auto wrong = wrong_rows(*grid, columns, limits)) return *wrong;
    return grid;
}

RowsToCome rows_to_come(const Run& so_far, const Grid& grid) {
    // The last row of the first part is dropped if it existed only because of the old t_end.
    RowsToCome rows{std::min(static_cast<std::size_t>(so_far.size()), grid.count()), {}};
    if (rows.kept > 0 && so_far.rows(static_cast<Eigen::Index>(rows.kept) - 1, 0) != grid.time(rows.kept - 1)) {
        --rows.kept;
    }
    rows.times.reserve(grid.count() - rows.kept);
    for (std::size_t i = rows.kept; i < grid.count(); ++i) {
        // The old t_end may be a requested row and differ from it by rounding.
        const double t = grid.time(i), stop = so_far.t_stop;
        if (t >= stop || std::fabs(t - stop) <= 4e-16 * std::fabs(stop)) rows.times.push_back(std::max(t, stop));
    }
    return rows;
}

}  // namespace dinal::motion
