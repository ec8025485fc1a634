#include "api/response.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "api/bind_excitation.hpp"
#include "api/data.hpp"
#include "api/steady_answer.hpp"

namespace dinal::api {
namespace {

constexpr double nan_number = std::numeric_limits<double>::quiet_NaN();

std::vector<double> asked_frequencies(const lua::Options& options, const ResponseOptions& asked) {
    const std::vector<double>& given = asked.frequency;
    if (given.size() < 2) options.fail({"frequency must be { from, to }, or a list of frequencies"});
    for (const double f : given) {
        if (!(f > 0))
            options.fail({.sentence = fmt::format("frequency = {} must be positive", f), .option = "frequency"});
    }
    if (given.size() > 2) return given;
    if (given[0] == given[1]) {
        options.fail({.sentence = fmt::format("frequency goes from {} to {}, which is no range", given[0], given[1]),
                      .option = "frequency"});
    }
    const auto n = static_cast<std::size_t>(asked.points);
    std::vector<double> list(n);
    for (std::size_t i = 0; i < n; ++i) {
        list[i] = given[0] + (given[1] - given[0]) * (static_cast<double>(i) / static_cast<double>(n - 1));
    }
    return list;
}

/// M at this frequency: of the user's function on the top of the stack, which stays; else a harmonic.
model::Excitation excitation_at(lua_State* L, const ResponseOptions& asked, bool harmonic, double frequency) {
    if (harmonic) {
        return model::Excitation::make(
                   model::Harmonic{.amplitude = asked.amplitude, .omega = 2 * std::numbers::pi * frequency})
            .value();
    }
    lua_pushvalue(L, -1);
    lua_pushnumber(L, frequency);
    lua_call(L, 1, 1);
    model::Excitation made = to_excitation(L, -1, fmt::format("sys:response: M({:.6g})", frequency), "M");
    lua_pop(L, 1);
    return made;
}

struct ResponseColumns {
    std::vector<double> frequency, amplitude, lag, peak, stops, stuck, stable;
    std::vector<std::string> status;

    void add(double f, const analysis::SteadyMotion& motion, const std::optional<double>& angle) {
        const bool found =
            motion.status == analysis::SteadyStatus::steady || motion.status == analysis::SteadyStatus::adheres;
        const bool grows = motion.status == analysis::SteadyStatus::grows;
        const double otherwise = grows ? std::numeric_limits<double>::infinity() : nan_number;
        frequency.push_back(f);
        amplitude.push_back(found ? motion.amplitude : otherwise);
        lag.push_back(angle.value_or(nan_number));
        peak.push_back(found ? std::max(std::fabs(motion.low), std::fabs(motion.high)) : otherwise);
        stops.push_back(found ? static_cast<double>(motion.stops) : nan_number);
        stuck.push_back(found ? motion.stuck : nan_number);
        stable.push_back(found && motion.stable ? 1 : 0);
        status.emplace_back(analysis::name(motion.status));
    }
};

}  // namespace

int response_of_system(lua_State* L) {
    const model::Oscillator system = lua::self<model::Oscillator>(L, 1, response_call.example);
    const lua::Options options(L, 2, response_call);
    ResponseOptions asked;
    options.fill(asked);
    const bool harmonic = !options.has("M");
    const std::vector<double> frequencies = asked_frequencies(options, asked);
    options.push("M");
    if (!harmonic && !lua::is_callable(L, -1)) {
        options.wrong("M", "a function of the frequency that returns an excitation");
    }
    ResponseColumns columns;
    model::State start{asked.theta0, asked.velocity0};
    bool warm = false;
    for (const double frequency : frequencies) {
        analysis::SteadyQuestion question{.system = system,
                                          .excitation = excitation_at(L, asked, harmonic, frequency),
                                          .drive = {0, 1 / frequency},
                                          .initial = start};
        if (!harmonic) {
            const bool known = analysis::drive_of(question.excitation, 1 / frequency).has_value();
            question.drive =
                drive_or_fail(L, options, system, question.excitation,
                              known && !question.excitation.has_script() ? std::nullopt : std::optional(1 / frequency));
        }
        analysis::SteadyMotion motion;
        std::optional<double> lag;
        asking(L, [&](const motion::Monitor& monitor) {
            motion =
                warm ? analysis::steady_motion_near(question, monitor) : analysis::steady_motion(question, monitor);
            lag = analysis::shape_of(question, motion, monitor).lag;
        });
        check_function(options, motion);
        warm = motion.status == analysis::SteadyStatus::steady;
        if (warm) start = motion.start;
        columns.add(frequency, motion, lag);
    }
    Data data;
    data.columns = {column_of("frequency", std::move(columns.frequency)),
                    column_of("amplitude", std::move(columns.amplitude)),
                    column_of("lag", std::move(columns.lag)),
                    column_of("peak", std::move(columns.peak)),
                    column_of("stops", std::move(columns.stops)),
                    column_of("stuck", std::move(columns.stuck)),
                    column_of("stable", std::move(columns.stable)),
                    column_of("status", std::move(columns.status))};
    push_data(L, std::move(data));
    return 1;
}

}  // namespace dinal::api
