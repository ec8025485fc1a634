#include "api/run_questions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/drive.hpp"
#include "api/data.hpp"
#include "api/run.hpp"
#include "api/steady_answer.hpp"
#include "api/units_option.hpp"
#include "files/table.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "text/sentences.hpp"

namespace dinal::api {
namespace {

std::span<const double> column_values(const motion::Trajectory& trajectory, Eigen::Index column) {
    const auto values = trajectory.rows.col(column);
    return {values.data(), static_cast<std::size_t>(values.size())};
}

/// The last of the values is the first one again: one period, or several, and a row too many.
bool closes(std::span<const double> values) {
    constexpr double same = 1e-9;  // of what they go through
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return *high > *low && std::fabs(values.front() - values.back()) <= same * (*high - *low);
}

/// That of M, where it knows one; else 0.
double period_of_run(const Run& run) {
    const auto drive =
        run.origin ? analysis::drive_of(run.terms ? *run.terms : run.origin->excitation, 0) : std::nullopt;
    return drive ? drive->period : 0;
}

}  // namespace

int spectrum_of_run(lua_State* L) {
    const RunHandle run = lua::self<RunHandle>(L, 1, spectrum_call.example);
    const motion::Trajectory& trajectory = run->trajectory;
    const bool positional = lua_gettop(L) > 1 && !lua_istable(L, 2);
    if (positional && lua_type(L, 2) != LUA_TSTRING) {
        lua::raise(L,
                   {.sentence = fmt::format("run:spectrum: the name of a column must be a string, got {}; for example "
                                            "{}",
                                            lua::describe(L, 2), spectrum_call.example),
                    .call = "run:spectrum",
                    .culprit = lua::written(L, 2)});
    }
    const lua::Options options(L, positional ? 3 : 2, spectrum_call);
    SpectrumOptions asked;
    options.fill(asked);
    const std::string name = positional ? std::string(lua_tostring(L, 2)) : asked.of;
    const auto column = files::find_column(trajectory.names(), std::string_view(name));
    if (!column) options.fail(column.error());
    const auto time = trajectory.find("t");
    if (!time) options.fail({"the run has no column t, so its rows have no times"});
    std::span<const double> t = column_values(trajectory, *time), values = column_values(trajectory, *column);
    const auto first = static_cast<std::size_t>(
        std::lower_bound(t.begin(), t.end(), asked.from.value_or(t.empty() ? 0 : t.front())) - t.begin());
    t = t.subspan(first);
    values = values.subspan(first);
    const std::size_t even = analysis::evenly_spaced(t);
    constexpr std::size_t least = 8;
    if (even < least || even + 1 < t.size()) {
        options.fail({even < least && even == t.size()
                          ? fmt::format("{} rows are too few, {} are needed at least", t.size(), least)
                          : fmt::format("rows must be evenly spaced, but row {} is not; simulate with dt = ...",
                                        first + even + 1)});
    }
    const bool twice = closes(values.first(even));
    const std::size_t rows = twice ? even - 1 : even;
    const double dt = (t[even - 1] - t[0]) / static_cast<double>(even - 1);
    const ColumnUnits in(units_of(*run));
    Data data{.columns = {}, .is_spectrum = true};
    const char* window = window_names[static_cast<std::size_t>(asked.window)];
    if (asked.method == SpectrumMethod::welch) {
        const auto segments = static_cast<std::size_t>(asked.segments);
        const std::size_t length = 2 * rows / (segments + 1);
        if (length < least) {
            options.fail({.sentence = fmt::format("{} rows are too few for {} segments of at least {} rows", rows,
                                                  segments, least),
                          .option = "segments"});
        }
        analysis::Spectrum found = analysis::density_of(values.first(rows), dt, asked.window, length);
        data.heading = fmt::format("power density of {}: {} rows, {} of {}, {} window", name, rows,
                                   text::counted(segments, "segment"), length, window);
        data.columns = {column_of("frequency", std::move(found.frequency), in.frequency),
                        column_of("density", std::move(found.amplitude))};
        push_data(L, std::move(data));
        return 1;
    }
    analysis::Spectrum found = analysis::spectrum_of(values.first(rows), dt, asked.window);
    data.heading = fmt::format("spectrum of {}: {} rows, {} window", name, rows, window);
    data.columns = {column_of("frequency", std::move(found.frequency), in.frequency),
                    column_of("amplitude", std::move(found.amplitude), in.of(name))};
    push_data(L, std::move(data));
    return 1;
}

int poincare_of_run(lua_State* L) {
    const RunHandle run = lua::self<RunHandle>(L, 1, poincare_call.example);
    const lua::Options options(L, 2, poincare_call);
    PoincareOptions asked;
    options.fill(asked);
    const motion::Trajectory& trajectory = run->trajectory;
    const double period =
        period_or_fail(options, asked.period, asked.frequency, asked.omega).value_or(period_of_run(*run));
    if (!(period > 0)) {
        options.fail({.sentence = "give a period: the M of this run has no known one", .option = "period"});
    }
    const double from = asked.from.value_or(trajectory.t_start);
    if (from < trajectory.t_start || from > trajectory.t_stop) {
        options.fail({.sentence = fmt::format("from = {:.6g} is not in the run, t {:.6g} ... {:.6g}", from,
                                              trajectory.t_start, trajectory.t_stop),
                      .option = "from"});
    }
    const double looks = std::floor((trajectory.t_stop - from) / period * (1 + 1e-12)) + 1;
    constexpr double most = 1e7;
    if (looks > most) options.fail({fmt::format("{:.3g} samples are more than {:.3g}", looks, most)});
    std::vector<double> t, theta, velocity;
    lua::CallState call(L);
    for (std::size_t i = 0; i < static_cast<std::size_t>(looks); ++i) {
        const double at = std::min(from + static_cast<double>(i) * period, trajectory.t_stop);
        const auto state = trajectory.at(at);
        if (call.failed()) call.raise_error();
        if (!state) options.fail(state.error());
        t.push_back(at);
        theta.push_back(state->theta);
        velocity.push_back(state->velocity);
    }
    Data data{.columns = {}, .points_of = "velocity", .points_over = "theta"};
    const ColumnUnits in(units_of(*run));
    data.columns = {column_of("t", std::move(t), in.t), column_of("theta", std::move(theta), in.theta),
                    column_of("velocity", std::move(velocity), in.speed)};
    push_data(L, std::move(data));
    return 1;
}

}  // namespace dinal::api
