// The class of runs: columns as vectors, events, the motion between rows, continuation, files. run:energy is in
// bind_energy.cpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/explain.hpp"
#include "analysis/recurrence.hpp"
#include "analysis/repetition.hpp"
#include "analysis/spectrum.hpp"
#include "api/animate.hpp"
#include "api/bind_simulate.hpp"
#include "api/bodies.hpp"
#include "api/cards.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/lua_run.hpp"
#include "api/picture.hpp"
#include "api/steady_answer.hpp"
#include "files/csv.hpp"
#include "files/record1989.hpp"
#include "lua/bind.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/memory_limit.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "lua/values.hpp"
#include "lua/vector.hpp"
#include "lua/worker_state.hpp"
#include "model/controller.hpp"
#include "model/lowered.hpp"
#include "motion/simulate.hpp"
#include "motion/stillness.hpp"
#include "text/characters.hpp"
#include "text/option.hpp"
#include "text/suggest.hpp"
#include "text/words.hpp"

namespace dinal::api {

RunCall::RunCall(lua_State* L, const LuaRun& run) : CallState(L) {
    if (run.origin) name_functions(*this, run.system(), run.origin->drive);
}

std::string line_of(const LuaRun& run) {
    if (!run.of_all()) return motion::summary(run.result);
    const model::System& system = run.system();
    if (system.joints.size() == 1) {
        return motion::summary(motion::part_of(system, run.origin->drive, run.result, 0));
    }
    return text::counted(system.bodies.size(), "body") + ", " + motion::summary(run.result);
}

std::string story_of_run(lua_State* L, const RunHandle& handle) {
    const LuaRun& run = *handle;
    RunCall call(L, run);  // user functions of spring, belt and base may be called
    const std::string text = run.origin ? story_of_simulated(L, handle) : analysis::explain_rows(run.result, run.units);
    call.check();
    return run.readings.empty() ? text : text + '\n' + text::wrapped(run.readings);
}

namespace {

// ---- Methods beyond the columns: run:spectrum, run:poincare.

enum class SpectrumMethod { amplitude, welch };

constexpr const char* method_names[] = {"amplitude", "welch"};

struct SpectrumOptions {
    std::string of = "theta";
    SpectrumMethod method = SpectrumMethod::amplitude;
    double segments = 8;
    analysis::SpectrumWindow window = analysis::SpectrumWindow::hann;
    std::optional<double> from = {};
};

constexpr const char* window_names[] = {"hann", "rectangle", "flat top"};

constexpr text::Option spectrum_options[] = {
    text::option<&SpectrumOptions::of>("of", "the column"),
    text::option<&SpectrumOptions::method>(
        "method", "amplitude of the whole record, or welch: power density, the mean over segments that overlap by half",
        {.choices = method_names}),
    text::option<&SpectrumOptions::segments>(
        "segments", "for method welch: more segments make the result smoother, and coarser in frequency",
        {.range = {"be a whole number from 1 to 10000", [](double x) { return text::is_whole(x, 1, 1e4); }}}),
    text::option<&SpectrumOptions::window>(
        "window",
        "the weights of the samples: hann in general, rectangle for whole periods, flat top for "
        "amplitudes",
        {.choices = window_names}),
    text::option<&SpectrumOptions::from>("from", "what is before this time (the transient) is left out",
                                         {.unit = "time units", .otherwise = "the beginning"}),
};

constexpr text::Call spectrum_call{
    "run:spectrum", "run:spectrum{ of = \"theta\", window = \"hann\" }", spectrum_options, true, nullptr, "of"};

struct PoincareOptions {
    std::optional<double> from = {};
};

constexpr text::Option poincare_period[] = {
    period_row("time between samples; needed if the period of M is not known, as for a Lua function", "that of M"),
};
constexpr text::Option poincare_from[] = {
    text::option<&PoincareOptions::from>("from",
                                         "the time of the first sample, after the transient; it also chooses the phase",
                                         {.unit = "time units", .otherwise = "the beginning"}),
};
constexpr auto poincare_options = text::joined(poincare_period, instead_of_period, poincare_from);

constexpr text::Call poincare_call{"run:poincare", "run:poincare{ period = 1 }", poincare_options};

constexpr lua::Doc spectrum_doc{
    "run:spectrum{ OPTIONS } -> data",
    "The one-sided amplitude spectrum of a column: frequency (cycles per time unit) and amplitude (of a sine). theta, "
    "velocity, damping and states are sampled from the motion between the rows, evenly, at 2^n times (at most 2^21): at "
    "least as densely as the rows, and 40 times in each natural period and period of M. Other columns, and all columns "
    "of a run that kept only its rows (dense = false, rk4, dinal1989, files), use the rows, which need one dt. A sine of "
    "whole periods has its amplitude in any window; one midway between two frequencies has 64 % of it in rectangle, 85 % "
    "in hann and 99.9 % in flat top. The "
    "mean is at frequency 0. With method = \"welch\" the second column is density: its sum times the step of "
    "frequency is the variance. run:spectrum(\"theta\", { OPTIONS }) is the same with of = \"theta\".",
    "run = nondimensional{}:simulate{ theta0 = 1, t_end = 16, dt = 0.125 }\n"
    "s = run:spectrum{ of = \"theta\", window = \"rectangle\" }\n"
    "i = s.amplitude:argmax()\n"
    "print(string.format(\"%.2f %.2f\", s.frequency[i], s.amplitude[i]))  --> 1.00 1.00",
    {&spectrum_call}};

constexpr lua::Doc poincare_doc{
    "run:poincare{ OPTIONS } -> data",
    "The motion sampled once a period: t, theta and velocity. A periodic motion gives one point, a subharmonic "
    "one several, an irregular one a cloud; the plot shows velocity over theta.",
    "run = nondimensional{ zeta = 0.2 }:simulate{ M = excitation.harmonic{ frequency = 0.5 }, t_end = 60, dt = 1 }\n"
    "d = run:poincare{ from = 40 }\n"
    "print(#d, d.theta:max() - d.theta:min() < 1e-9)  --> 11\ttrue",
    {&poincare_call}};

std::span<const double> column_values(const motion::Run& result, Eigen::Index column) {
    const auto values = result.rows.col(column);
    return {values.data(), static_cast<std::size_t>(values.size())};
}

/// Returns whether the last value repeats the first: whole periods with one row too many.
bool closes(std::span<const double> values) {
    constexpr double same = 1e-9;  // relative to the range of the values
    const auto [low, high] = std::ranges::minmax_element(values);
    return *high > *low && std::fabs(values.front() - values.back()) <= same * (*high - *low);
}

/// The period of M if it is known, otherwise 0.
double period_of_run(const LuaRun& run) {
    const auto drive = run.of_body()
                           ? analysis::repetition_of(run.terms ? *run.terms : run.origin->drive.loads[run.place()], 0)
                           : std::nullopt;
    return drive ? drive->period : 0;
}

/// Evenly spaced values of a column, for its spectrum.
struct EvenSamples {
    std::vector<double> values = {};
    double dt = 0;
    const char* kind = "rows";
};
constexpr std::size_t fewest_samples = 8;

/// Samples of the motion from this time on, close enough for its fastest part.
EvenSamples samples_of_motion(const LuaRun& run, const motion::BetweenRows& between, std::size_t place, double from) {
    constexpr double a_period = 40, an_event = 20, least = 1024, most = 1 << 21;
    const motion::Run& result = run.result;
    const double length = result.t_stop - from, part = length / (result.t_stop - result.t_start);
    double period = result.course->system().natural_period();
    if (const double own = period_of_run(run); own > 0) period = std::min(period, own);
    const std::span<const model::Component> M =
        run.of_body() ? (run.terms ? *run.terms : run.origin->drive.loads[run.place()]).components()
                      : std::span<const model::Component>();
    for (const model::Component& component : M) {
        if (const auto* sine = std::get_if<model::Harmonic>(&component.term)) {
            period = std::min(period, 2 * std::numbers::pi / std::fabs(sine->omega));
        }
    }
    const double wanted = std::max({least, a_period * length / period, part * static_cast<double>(result.size()),
                                    an_event * part * static_cast<double>(result.events.size())});
    const std::size_t count = std::bit_ceil(static_cast<std::size_t>(std::min(wanted, most)));
    EvenSamples samples{.values = {}, .dt = length / static_cast<double>(count), .kind = "samples of the motion"};
    samples.values.reserve(count);
    std::vector<double> at_once;
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 1024 == 0 && lua::interrupt_requested()) break;
        at_once.clear();
        between.append_values(from + static_cast<double>(i) * samples.dt, at_once);
        samples.values.push_back(at_once[place]);
    }
    return samples;
}

EvenSamples samples_of(lua_State* L, const lua::Options& options, const LuaRun& run, Eigen::Index column,
                       const std::optional<double>& from) {
    const motion::Run& result = run.result;
    const motion::BetweenRows between(result, nullptr);
    const auto place = std::ranges::find(between.columns(), column);
    if (place != between.columns().end()) {
        const double begin = std::max(from.value_or(result.t_start), result.t_start);
        if (!(begin < result.t_stop)) {
            options.fail("from", "from = {:.6g} must be before the end of the run, t = {:.6g}", begin, result.t_stop);
        }
        RunCall call(L, run);
        EvenSamples samples =
            samples_of_motion(run, between, static_cast<std::size_t>(place - between.columns().begin()), begin);
        if (lua::interrupt_requested()) lua::raise_interrupted(L);
        call.check();
        return samples;
    }
    const auto time = result.find("t");
    if (!time) options.fail({"the run has no column t, so its rows have no times"});
    std::span<const double> t = column_values(result, *time), values = column_values(result, column);
    const auto first =
        static_cast<std::size_t>(std::ranges::lower_bound(t, from.value_or(t.empty() ? 0 : t.front())) - t.begin());
    t = t.subspan(first);
    values = values.subspan(first);
    const std::size_t even = analysis::evenly_spaced(t);
    if (even < fewest_samples || even + 1 < t.size()) {
        options.fail({even < fewest_samples && even == t.size()
                          ? fmt::format("{} rows are too few, {} are needed at least", t.size(), fewest_samples)
                          : fmt::format("rows must be evenly spaced, but row {} is not; simulate with dt = ...",
                                        first + even + 1)});
    }
    const bool twice = closes(values.first(even));
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(twice ? even - 1 : even);
    return {.values = {values.begin(), end}, .dt = (t[even - 1] - t[0]) / static_cast<double>(even - 1)};
}

/// The joint of a column such as "load.theta"; a state belongs to every joint. None for other columns of the whole run.
std::optional<std::size_t> joint_of_column(const LuaRun& run, std::string_view column) {
    if (!run.of_all()) return {};
    const auto& states = run.origin->drive.states;
    if (text::contains(states, column, &model::OwnState::name)) return 0;
    return run.system().joint_named(column.substr(0, column.find('.')));
}

int spectrum_of_run(lua_State* L) {
    RunHandle run = lua::self<RunHandle>(L, 1, spectrum_call.example);
    const bool positional = lua_gettop(L) > 1 && !lua_istable(L, 2);
    if (positional && lua_type(L, 2) != LUA_TSTRING) {
        lua::fail(L, "run:spectrum",
                  {.sentence = fmt::format("the name of a column must be a string, got {}; for example "
                                           "{}",
                                           lua::describe(L, 2), spectrum_call.example),
                   .culprit = lua::written(L, 2)});
    }
    const lua::Options options(L, positional ? 3 : 2, spectrum_call);
    SpectrumOptions asked;
    options.fill(asked);
    if (positional && options.has("of")) options.fail("of", "the column is named twice, before the options and by of");
    if (asked.method != SpectrumMethod::welch && options.has("segments")) {
        options.fail("segments", "segments are of method = \"welch\"");
    }
    const std::string name = positional ? std::string(lua_tostring(L, 2)) : asked.of;
    std::string_view own_name = name;
    if (const auto joint = joint_of_column(*run, name)) {
        run = part_of(run, *joint);
        own_name.remove_prefix(name.find('.') + 1);
    }
    const auto column = files::find_column(run->result.names(), own_name);
    if (!column && run->of_all() && part_of(run, 0)->result.find(name)) check_one(L, *run, "." + name);
    if (!column) options.fail(column.error());
    const auto [values, dt, kind] = samples_of(L, options, *run, *column, asked.from);
    const std::size_t rows = values.size();
    const ColumnUnits in(units_of(*run));
    Data data{.columns = {}, .is_spectrum = true};
    const bool welch = asked.method == SpectrumMethod::welch;
    const auto segments = static_cast<std::size_t>(asked.segments);
    const std::size_t length = 2 * rows / (segments + 1);
    if (welch && length < fewest_samples) {
        options.fail("segments", "{} {} are too few for {} segments, which need {} each", rows, kind, segments,
                     fewest_samples);
    }
    analysis::Spectrum found = welch ? analysis::density_of(values, dt, asked.window, length)
                                     : analysis::spectrum_of(values, dt, asked.window);
    data.heading = fmt::format("{} of {}: {} {},{} {} window", welch ? "power density" : "spectrum", name, rows, kind,
                               welch ? fmt::format(" {} of {},", text::counted(segments, "segment"), length) : "",
                               window_names[static_cast<std::size_t>(asked.window)]);
    data.columns = {column_of("frequency", std::move(found.frequency), in.frequency),
                    column_of(welch ? "density" : "amplitude", std::move(found.amplitude), welch ? "" : in.of(name))};
    return push_data(L, std::move(data));
}

int poincare_of_run(lua_State* L) {
    const RunHandle run = lua::self<RunHandle>(L, 1, poincare_call.example);
    const lua::Options options(L, 2, poincare_call);
    check_one(L, *run, ":poincare");
    PoincareOptions asked;
    options.fill(asked);
    const motion::Run& result = run->result;
    const double period = asked_period(options).value_or(period_of_run(*run));
    if (!(period > 0)) {
        options.fail("period", "give a period: the M of this run has no known one");
    }
    const double from = asked.from.value_or(result.t_start);
    if (from < result.t_start || from > result.t_stop) {
        options.fail("from", "from = {:.6g} is not in the run, t {:.6g} ... {:.6g}", from, result.t_start,
                     result.t_stop);
    }
    const double looks = std::floor((result.t_stop - from) / period * (1 + 1e-12)) + 1;
    constexpr double most = 1e7;
    if (looks > most) options.fail(text::error("{:.3g} samples are more than {:.3g}", looks, most));
    std::vector<std::pair<double, model::State>> samples;
    RunCall call(L, *run);
    for (std::size_t i = 0; i < static_cast<std::size_t>(looks); ++i) {
        const double at = std::min(from + static_cast<double>(i) * period, result.t_stop);
        const auto state = result.at(at);
        call.check();
        samples.emplace_back(at, options.value_or_fail(state));
    }
    using Sample = std::pair<double, model::State>;
    const ColumnUnits in(units_of(*run));
    Data data = table_of(samples, ListColumn{"t", &Sample::first, in.t},
                         ListColumn{"theta", [](const Sample& s) { return s.second.theta; }, in.theta},
                         ListColumn{"velocity", [](const Sample& s) { return s.second.velocity; }, in.speed});
    data.points_of = "velocity", data.points_over = "theta";
    return push_data(L, std::move(data));
}

const RunHandle& run_self(lua_State* L, const char* call) {
    return lua::self<RunHandle>(L, 1, call);
}

void push_column(lua_State* L, const RunHandle& run, Eigen::Index column) {
    lua::push(L, view_of(run, run->result.rows.col(column)));
}

int column_by_name(lua_State* L, const char* name) {
    const RunHandle& run = run_self(L, "run.theta");
    const motion::Run& result = run->result;
    const auto column = result.find(name);
    if (!column && run->of_all()) joint_named(L, name, run->system(), "this run", run_class);  // raises an error
    if (!column) {
        raise_unknown_name(
            L, fmt::format("this run has no field '{}'; its columns are {}", name, fmt::join(result.names(), ", ")),
            name, result.names(), run_class);
    }
    push_column(L, run, *column);
    return 1;
}

template <std::size_t place>
int column_field(lua_State* L) {
    const std::string& name = motion::column_names()[place];
    if (place > 0) check_one(L, *run_self(L, "run.theta"), "." + name);  // all have t
    return column_by_name(L, name.c_str());
}

template <std::size_t... place>
constexpr std::array<lua::Member, sizeof...(place)> column_fields(std::index_sequence<place...> /*places*/) {
    using motion::body_columns;
    return {lua::Member{lua::a_field<column_field<place>>,
                        {body_columns[place].signature, body_columns[place].summary, body_columns[place].example}}...};
}

/// A method of data applied to the rows of the run.
template <lua_CFunction method>
int as_data(lua_State* L) {
    push_data(L, rows_of(run_self(L, "run:select(\"t\")")));
    lua_replace(L, 1);
    return method(L);
}

int other_column(lua_State* L) {
    if (lua_isinteger(L, 2) != 0) {
        const RunHandle& run = run_self(L, "run[1]");
        const lua_Integer i = lua_tointeger(L, 2);
        if (i < 1 || i > run->result.size()) {
            lua_pushnil(L);
            return 1;
        }
        push_data(L, rows_of(run));
        push_row(L, lua_gettop(L), **lua::test<DataHandle>(L, -1), static_cast<std::size_t>(i) - 1);
        return 1;
    }
    if (lua_type(L, 2) != LUA_TSTRING) {
        return 0;
    }
    return column_by_name(L, lua_tostring(L, 2));
}

/// run.load: pushes the run of a body or link.
int body_or_link(lua_State* L) {
    const RunHandle run = run_self(L, "run.load");
    if (!run->of_all()) return 0;
    const std::string_view name = lua_tostring(L, 2);
    const auto& joints = run->system().joints;
    const auto own = std::ranges::find(joints, name, &model::Joint::name);
    if (own == joints.end()) return 0;
    push_run(L, part_of(run, static_cast<std::size_t>(own - joints.begin())));
    return 1;
}

int columns(lua_State* L) {
    const RunHandle run = run_self(L, "run:columns(\"t\", \"theta\")");
    const auto& names = run->result.names();
    const int asked = lua_gettop(L) - 1;
    if (asked == 0) {
        luaL_checkstack(L, static_cast<int>(names.size()) + 5, "too many columns");
        for (std::size_t i = 0; i < names.size(); ++i) {
            push_column(L, run, static_cast<Eigen::Index>(i));
        }
        return static_cast<int>(names.size());
    }
    luaL_checkstack(L, asked + 5, "too many columns");
    for (int i = 2; i <= asked + 1; ++i) {
        const auto column = column_at(L, i, names, fmt::format("argument {}", i - 1));
        push_column(L, run, lua::value_or_raise(L, "run:columns", column));
    }
    return asked;
}

int data_of_run(lua_State* L) {
    return push_data(L, rows_of(run_self(L, "run:data()")));
}

lua::Pushed events(lua_State* L, const RunHandle& run) {
    push_events(L, run->result.events_once(), run->result.event_names, units_of(*run),
                run->of_all() ? &run->system() : nullptr);
    return {};
}

}  // namespace

Data rows_of(const RunHandle& run) {
    const ColumnUnits in(units_of(*run));
    Data data;
    for (const std::string& name : run->result.names()) {
        const auto numbers = run->result.rows.col(static_cast<Eigen::Index>(data.columns.size()));
        data.columns.push_back({name, view_of(run, numbers), in.of(name)});
    }
    return data;
}

void check_one(lua_State* L, const LuaRun& run, std::string_view member) {
    if (!run.of_all()) return;
    const std::string name(member.substr(1));
    lua::raise(L, {.sentence = fmt::format("{} is of one body or link: run.{}{}", name,
                                           run.system().joints.front().name, member),
                   .culprit = name});
}

std::vector<RunHandle> parts_of(const RunHandle& run) {
    if (!run->of_all()) return {run};
    std::vector<RunHandle> parts;
    for (std::size_t j = 0; j < run->system().joints.size(); ++j) parts.push_back(part_of(run, j));
    return parts;
}

std::optional<model::Oscillator> alone(const LuaRun& run) {
    if (run.origin == nullptr || run.of_all()) return {};
    const auto made = model::oscillator_at(run.system(), run.place());
    return made ? std::optional(made.value()) : std::nullopt;
}

RunHandle part_of(const RunHandle& run, std::size_t joint) {
    if (!run->of_all()) return run;
    run->parts.resize(run->system().joints.size());
    if (RunHandle known = run->parts[joint].lock()) return known;
    auto seen = std::make_shared<LuaRun>();
    seen->result = motion::part_of(run->system(), run->origin->drive, run->result, joint);
    seen->origin = run->origin, seen->joint = joint, seen->whole = run;
    seen->readings = run->readings, seen->terms = run->terms;
    run->parts[joint] = seen;
    return seen;
}

std::vector<std::string> repeat_lines(const LuaRun& run) {
    return run.origin ? source::repeat_lines(*run.origin) : run.comments;
}

void raise_unknown_name(lua_State* L, std::string sentence, std::string_view wrong,
                        const std::vector<std::string>& known, const lua::Class& of) {
    std::vector<std::string_view> names(known.begin(), known.end());
    for (const lua::Member& member : of.members) {
        const bool is_known = text::contains(known, member.name);
        if (member.kind != lua::Kind::metamethod && !is_known) names.push_back(member.name);
    }
    std::string cure = text::did_you_mean(wrong, names);
    const bool listed = std::ranges::all_of(
        known, [&sentence](const std::string& name) { return sentence.find(name) != std::string::npos; });
    if (listed) names.erase(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(known.size()));
    lua::raise(L, {.sentence = std::move(sentence),
                   .culprit = std::string(wrong),
                   .cure = std::move(cure),
                   .instead = fmt::format("; it {}has {}", listed ? "also " : "", fmt::join(names, ", "))});
}

std::string_view status_word(model::Outcome outcome) {
    switch (outcome) {
        case model::Outcome::reached_end:
            return "end";
        case model::Outcome::at_rest:
            return "rest";
        case model::Outcome::stuck_at_end:
            return "stuck";
        case model::Outcome::stopped:
            return "event";
        case model::Outcome::interrupted:
            return "interrupted";
        default:
            return "failed";
    }
}

namespace {

lua::Pushed cycle_of_run(lua_State* L, const RunHandle& run) {
    check_one(L, *run, ":cycle");
    const motion::Run& result = run->result;
    RunCall call(L, *run);
    std::vector<model::WantedEvent> wanted;
    if (run->origin) wanted = run->origin->drive.events;
    std::vector<model::Event> events = analysis::events_of_motion(result, wanted);
    if (result.on_belt) {  // extremes of theta on a belt are not events
        const std::vector<model::Event> turns = motion::turns_on_belt(result);
        events.insert(events.end(), turns.begin(), turns.end());
        std::ranges::stable_sort(events, {}, &model::Event::t);
    }
    call.check();
    const auto found = analysis::recurrence(events);
    if (!found) {
        lua_pushnil(L);
        return {};
    }
    lua::push_value(L, lua::NamedNumbers{{"period", found->period},
                                         {"amplitude", found->amplitude},
                                         {"middle", found->centre},
                                         {"stuck", found->stuck},
                                         {"drift", found->drift},
                                         {"change", found->change},
                                         {"since", found->since}});
    lua::set_value(L, "stops", found->stops);
    lua::set_value(L, "steady", found->steady);
    return {};
}

/// The simulated system; nil if the run was read from a file.
lua::Pushed system_of_run(lua_State* L, const RunHandle& run) {
    if (run->origin == nullptr) {
        lua_pushnil(L);
    } else if (run->joint) {
        push_alone(L, "run.system", run->system(), *run->joint);
    } else {
        lua::push(L, run->origin->system);
    }
    return {};
}

std::optional<model::Excitation> excitation_of_run(lua_State* L, const RunHandle& run) {
    if (run->origin == nullptr) return {};
    if (run->system().joints.size() > 1) check_one(L, *run, ".excitation");
    const model::Excitation& load = run->origin->drive.loads[run->place()];
    return !run->system().is_link(run->place()) || !load.components().empty() ? std::optional(load) : std::nullopt;
}

std::optional<motion::Integrator> integrator_of_run(const LuaRun& run) {
    return run.origin ? std::optional(run.origin->integrator) : std::nullopt;
}

#define DINAL_RUN "run = nondimensional{}:simulate{ M = 3, theta0 = 1, t_end = 2, dt = 0.5 }\n"

constexpr text::FixedText<160> integrator_example{DINAL_RUN "print(run.integrator)  --> ",
                                                  motion::usual_integrator.c_str()};

constexpr lua::Member run_methods[] = {
    {lua::a_method<run_at>,
     {"run:at(t) -> theta, velocity, z",
      "Angle (rad) and velocity (rad per time unit) at any time of the run, at the accuracy of the integrator; in "
      "a run with states also the table z. Of several bodies tables by body. For a vector of times all are vectors. A run "
      "read from a file is interpolated by cubics.",
      DINAL_RUN "print(string.format(\"%.6f %.6f\", run:at(0.75)))  --> 3.000000 -12.566371"}},
    {lua::a_method<columns>,
     {"run:columns(name, ...) -> vector, ...",
      "The columns with these names or numbers (t is 1); all of them without arguments.",
      DINAL_RUN "t, M = run:columns(\"t\", \"M\")\nprint(t, M[5])  --> vector{ 0, 0.5, 1, 1.5, 2 }\t3.0"}},
    {lua::a_method<data_of_run>,
     {"run:data() -> data", "All columns and rows, as data that can be filtered, joined with others and plotted.",
      DINAL_RUN "print(run:data().names[2])  --> theta"}},
    {lua::a_method<as_data<data_functions::column>>,
     {"run:column(name) -> vector", "The column of this name, also if the run has a member of that name.",
      DINAL_RUN "print(run:column(\"theta\") == run.theta)  --> true"}},
    {lua::a_method<as_data<data_functions::filter>>,
     {"run:filter(f) -> data", "The rows for which f(row) is true, as d:filter does.",
      DINAL_RUN "print(#run:filter(function(row) return row.theta > 2 end))  --> 2"}},
    {lua::a_method<as_data<data_functions::select>>,
     {"run:select(name, ...) -> data", "These columns, in this order.",
      DINAL_RUN "print(#run:select(\"t\", \"theta\").names, run[2].t)  --> 2\t0.5"}},
    {lua::a_method<as_data<data_functions::sort>>,
     {"run:sort(name, { descending = false }) -> data", "The rows in the order of a column, as d:sort does.",
      DINAL_RUN "print(run:sort(\"theta\").theta[1])  --> 1.0"}},
    {lua::a_method<as_data<data_functions::markdown>>,
     {"run:markdown() -> string", "All rows as a table in Markdown.",
      DINAL_RUN "print(run:markdown():match(\"| t, T0 | theta, Mc/k\"))  --> | t, T0 | theta, Mc/k"}},
    {lua::a_method<continue_run>,
     {"run:continue{ OPTIONS } -> run",
      "A new run that continues this one from its end, also after Ctrl-C or an error in M, with the same rows as "
      "if it had never stopped. A run with dt keeps its dt. run:continue(40) is run:continue{ t_end = 40 }.",
      DINAL_RUN "longer = run:continue(3)\n"
                "print(#longer, longer.t_end, string.format(\"%.6f\", longer:at(3)))  --> 7\t3.0\t1.000000",
      {&continue_call}}},
    {lua::a_question<RunHandle, energy_of_run>,
     {"run:energy() -> energy",
      "The energy balance: work of M, stored energy, losses; in total, for each half cycle and at the rows; of several "
      "bodies the sum, and that of each body and link. Only for runs by integrator.exact, spectral and dopri5.",
      "run = system{ I = 1, k = 1, Rd = 0.12 }:simulate{ theta0 = 1, t_end = 20, dt = 5 }\n"
      "print(string.format(\"%.6f\", run:energy().total.dry))  --> 0.499200"}},
    {lua::a_question<RunHandle, story_of_run>,
     {"run:explain() -> string",
      "Describes the run in sentences: half cycles, where, when and why the mass stopped and "
      "slipped (|M - k theta| against Re), and the end: rest, or a steady motion with its "
      "period, amplitude, lag and stops. Of several bodies: how each moved, when each contact held, where the energy "
      "went.",
      DINAL_RUN "print(run:explain():match(\"It made[^.]*\"))  --> It made 4 half cycles with 3 turns and 0 stops"}},
    {lua::a_method<save_run>,
     {"run:save(file, { OPTIONS })",
      "Writes the rows: file.csv gets a comment block with the Lua text that repeats the run, a line of names and the "
      "rows; file.dat gets the record of 1989 (NPUNT, then t, theta, velocity/omega0, M/k, friction/k, damping/k). "
      "Both read back exactly with load. A run of several bodies is saved as .csv, with names such as load.theta.",
      DINAL_RUN "file = os.tmpname() .. \".csv\"\n"
                "run:save(file, { columns = { \"t\", \"theta\" } })\n"
                "print(#load(file))  --> 5\n"
                "os.remove(file)",
      {&save_call}}},
    {lua::a_method<spectrum_of_run>, spectrum_doc},
    {lua::a_method<poincare_of_run>, poincare_doc},
    {lua::a_method<steady_of_run>, steady_run_doc},
    {lua::a_method<plot_run>, plot_run_doc},
    {lua::a_method<phase_plot_run>, phase_plot_run_doc},
    {lua::a_method<animate_run>, animate_doc},
};

constexpr lua::Member run_values[] = {
    {lua::a_value<RunHandle, run_states>,
     {"run.states -> table", "The columns of the states by name: vectors.",
      "run = nondimensional{}:simulate{ theta0 = 1, t_end = 1, dt = 0.25,\n"
      "    states = { way = { rate = function(t, theta, velocity) return math.abs(velocity) end } } }\n"
      "print(string.format(\"%.6f\", run.states.way[5]))  --> 4.000000"}},
    {lua::a_kept_value<RunHandle, events>,
     {"run.events -> data",
      "The events in order of time: the columns t, kind, theta, M and velocity, and by number { t, kind, theta, M, "
      "velocity }. kind is \"turn\" (the motion reverses), \"stick\", \"slip\" (the mass breaks away), \"rest\" "
      "(nothing can move it any more), \"impact\" (at a wall; velocity is that before it), \"switch\" (of a relay), "
      "\"open\" and \"close\" (of a contact whose normal load falls to 0, and rises again) "
      "or \"user\" (of the option `events`, which adds a column name). Of several bodies the third column is where: the "
      "body or link; M acts on its first body. At t_start only an impact is recorded. Empty in a run read from a file.",
      "run = nondimensional{}:simulate{ theta0 = 1, t_end = 1.2, dt = 0.1 }\n"
      "for _, e in ipairs(run.events) do print(e.kind, string.format(\"%.4f %.4f\", e.t, e.theta)) end\n"
      "--> turn\t0.5000 -1.0000\n"
      "--> turn\t1.0000 1.0000"}},
    {lua::a_value<RunHandle, run_acceleration>,
     {"run.acceleration -> vector or nil",
      "The angular acceleration at the rows, rad per time unit^2, from the equation of motion, relative to the "
      "base. For a run read from a file: its column of this name, or nil.",
      "run = system{ I = 2, k = 3 }:simulate{ theta0 = 1, t_end = 1 }\nprint(run.acceleration[1])  --> -1.5"}},
    {lua::a_question<RunHandle, cycle_of_run>,
     {"run:cycle() -> table or nil",
      "The periodic motion at the end of the run, measured from its events: period, amplitude, middle (of the "
      "extremes), stops, stuck (fraction of a period), drift (of theta in a period), change (from the period "
      "before, in amplitudes), since (the time when it had settled to a thousandth), steady (false while it is "
      "settling). nil if nothing repeats. run:steady() computes the limit.",
      "run = system{ I = 1, k = 4, Rd = 0.3, Re = 0.6 }:simulate{ belt = 0.1, t_end = 60 }\n"
      "c = run:cycle()\n"
      "print(string.format(\"%.6f %d\", c.period, c.stops), c.steady)  --> 3.658799 1\ttrue"}},
    {lua::a_value<RunHandle, [](const LuaRun& run) { return run.result.t_start; }>,
     {"run.t_start -> number", "The time at which the run began.", DINAL_RUN "print(run.t_start)  --> 0.0"}},
    {lua::a_value<RunHandle, [](const LuaRun& run) { return run.result.t_stop; }>,
     {"run.t_end -> number", "The time at which the run ended: the given t_end, or earlier if it was stopped.",
      DINAL_RUN "print(run.t_end)  --> 2.0"}},
    {lua::a_value<RunHandle,
                  [](const LuaRun& run) {
                      return run.origin ? std::optional(status_word(run.result.outcome)) : std::nullopt;
                  }>,
     {"run.status -> string or nil",
      "How the run ended, in one word: \"end\" (moving), \"rest\", \"stuck\", \"event\" (with stop = true), "
      "\"interrupted\" or \"failed\"; run.outcome is the sentence. nil for a run read from a file.",
      DINAL_RUN "print(run.status)  --> end"}},
    {lua::a_value<RunHandle,
                  [](const LuaRun& run) { return run.origin ? motion::outcome_text(run.result) : "read from a file"; }>,
     {"run.outcome -> string",
      "How the run ended: \"reached the end\" (moving), \"at rest\" (nothing can move it any more), \"stuck at the "
      "end\" (M may still move it), \"interrupted\", or the error. A pulse of a function M that is shorter than "
      "run.gap may have been missed.",
      DINAL_RUN "print(run.outcome)  --> reached the end"}},
    {lua::a_value<RunHandle,
                  [](const LuaRun& run) {
                      return (run.result.gap > 0) ? std::optional(run.result.gap) : std::nullopt;
                  }>,
     {"run.gap -> number or nil",
      "The longest duration of a pulse of a Lua function that may have been missed. If all functions are read, it is "
      "the longest stretch on which the absence of such a pulse was not proven; nil if there is none. Otherwise it "
      "is the longest time between two samples: a longer pulse was found (see breaks of excitation.scripted and "
      "narrowest of integrator.spectral).",
      "run = nondimensional{}:simulate{ M = math.sin, t_end = 2, dt = 1, integrator = integrator.rk4{ h = 0.01 } }\n"
      "print(run.gap)  --> 0.005"}},
    {lua::a_value<RunHandle, [](const LuaRun& run) { return run.result.names(); }>,
     {"run.names -> table", "The names of the columns.", DINAL_RUN "print(run.names[2])  --> theta"}},
    {lua::a_value<RunHandle, system_of_run>,
     {"run.system -> system or nil", "The system; nil for a run read from a file. That of run.load is run.system.load.",
      DINAL_RUN "print(run.system.T0)  --> 1.0"}},
    {lua::a_value<RunHandle, [](const LuaRun& run) { return units_by_name(units_of(run)); }>,
     {"run.units -> table", "The names of the units of theta, t and M; nil for those without one.",
      DINAL_RUN "print(run.units.theta, run.units.t)  --> Mc/k\tT0"}},
    {lua::a_value<RunHandle, excitation_of_run>,
     {"run.excitation -> excitation or nil", "The excitation M; nil for a link and for a run read from a file.",
      DINAL_RUN "print(run.excitation)  --> excitation.constant{ amplitude = 3 }"}},
    {lua::a_value<RunHandle, integrator_of_run>,
     {"run.integrator -> integrator or nil", "The integrator; nil for a run read from a file.",
      integrator_example.c_str()}},
    {lua::a_length<RunHandle, [](const LuaRun& run) { return run.result.size(); }>,
     {"#run -> number", "The number of rows; run[1] is the first one.", DINAL_RUN "print(#run)  --> 5"}},
    {lua::a_text<RunHandle, line_of>,
     {"tostring(run) -> string", "A summary in one line.",
      "print(nondimensional{}:simulate{ theta0 = 1, t_end = 1.2, dt = 0.1 })\n"
      "--> 13 rows, t 0 … 1.2; 2 events (2 turns); moving at the end; peak |theta| 1"}},
};

constexpr auto run_members =
    text::joined(run_methods, column_fields(std::make_index_sequence<motion::body_columns.size()>()), run_values);

}  // namespace

const lua::Class run_class = {
    "run",
    {"sys:simulate{ ... } or load(file) -> run",
     "The result of a simulation: columns (vectors), events, the outcome, and the motion between the rows. A run "
     "read from a file has the columns of its file as fields. Of a run of several bodies, run.load is the run as seen "
     "from the body `load`, with its theta, velocity, M, friction, damping, its events, at(t), energy and plots; "
     "run.shaft that of a link: theta (first less second), velocity, torque (on the first) and friction. Columns of all "
     "are run:column(\"load.theta\").",
     "rig = system{ bodies = { a = { I = 1, k = 4 }, b = { I = 1 } }, links = { rod = { \"a\", \"b\", k = 2 } } }\n"
     "run = rig:simulate{ theta0 = { a = 1 }, t_end = 3 }\nprint(run.a.theta[1], run.rod.torque[1])  --> 1.0\t-2.0"},
    run_members,
    lua::add_class<RunHandle>,
    other_column,
    run_card,
    body_or_link};

#undef DINAL_RUN

text::Expected<Eigen::Index> column_at(lua_State* L, int index, std::span<const std::string> names,
                                       std::string_view what) {
    if (lua_type(L, index) == LUA_TSTRING) {
        return files::find_column(names, std::string_view(lua_tostring(L, index)));
    }
    if (lua_isinteger(L, index) != 0) {
        return files::find_column(names, std::int64_t{lua_tointeger(L, index)});
    }
    return text::Error{
        .sentence = fmt::format("{} must be the name or the number of a column, got {}", what, lua::describe(L, index)),
        .culprit = lua::written(L, index)};
}

void push_run(lua_State* L, RunHandle run) {
    const std::size_t bytes = run->result.rows.table().own_bytes();
    lua::push<RunHandle>(L, std::move(run));
    lua::note_external_memory(L, bytes);
}

// run:at(t), and the columns of a run's own states.

namespace {

/// Raises an error for an unknown state: __index of run.states.
int no_such_state(lua_State* L) {
    const std::string wanted(lua_type(L, 2) == LUA_TSTRING ? lua::text_at(L, 2) : luaL_typename(L, 2));
    const std::vector<std::string> names = lua::text_keys(L, 1);
    if (names.empty()) {
        lua::raise(L, "run.states has no '{}': the run has no states", wanted);
    }
    lua::raise(L, "run.states has no '{}', only {}{}", wanted, fmt::join(names, ", "),
               text::did_you_mean(wanted, names));
}

/// Pushes a table by name of the numbers from index `from` on.
template <class Named>
void push_by_name(lua_State* L, const std::vector<Named>& named, const std::vector<double>& numbers, std::size_t from) {
    lua_createtable(L, 0, static_cast<int>(named.size()));
    for (std::size_t i = 0; i < named.size(); ++i) lua::set_value(L, named[i].name.c_str(), numbers[from + i]);
}

}  // namespace

namespace {

int at_one_time(lua_State* L) {
    const RunHandle run =
        lua::self<RunHandle>(L, 1, "run:at(t)");  // a copy: the user's function may drop the last reference
    const double t = lua::finite_argument(L, 2, "run:at(t): t");
    RunCall call(L, *run);  // between rows the integrator evaluates the excitation
    const bool of_all = run->of_all();
    const auto state = part_of(run, 0)->result.at(t);
    call.check();
    if (!state) {
        lua::fail(L, "run:at(t)", state.error());
    }
    if (of_all) {
        const motion::Run& whole = run->result;
        const std::vector<double> y =
            whole.left != nullptr ? whole.left->history->at(t) : std::vector{state->theta, state->velocity};
        const std::size_t n = run->system().bodies.size();
        push_by_name(L, run->system().bodies, y, 0);
        push_by_name(L, run->system().bodies, y, n);
        if (run->origin->drive.states.empty()) return 2;
        push_by_name(L, run->origin->drive.states, y, 2 * n);
        return 3;
    }
    lua_pushnumber(L, state->theta);
    lua_pushnumber(L, state->velocity);
    const motion::Run& result = run->result;
    if (result.states == 0 || result.course == nullptr) {
        return 2;
    }
    const std::vector<double> states = result.course->states_at(t);
    lua_createtable(L, 0, static_cast<int>(states.size()));
    for (std::size_t i = 0; i < states.size(); ++i) {
        lua::set_value(L, result.names()[result.first_state() + i].c_str(), states[i]);
    }
    return 3;
}

}  // namespace

/// run:at for several times: returns vectors instead of numbers, also in tables by name.
int run_at(lua_State* L) {
    if (lua::test<lua::Vector>(L, 2) == nullptr && !lua_istable(L, 2)) return at_one_time(L);
    lua_settop(L, 2);
    std::map<std::pair<int, std::string>, std::vector<double>> found;  // by result index and name
    int results = 0;
    for (const double t : lua::numbers_at(L, 2, "run:at(t)", "t")) {
        lua_settop(L, 2);
        lua_pushcfunction(L, lua::guarded<at_one_time>);
        lua_pushvalue(L, 1);
        lua_pushnumber(L, t);
        lua_call(L, 2, LUA_MULTRET);
        results = lua_gettop(L) - 2;
        for (int i = 1; i <= results; ++i) {
            if (!lua_istable(L, i + 2)) found[{i, ""}].push_back(lua_tonumber(L, i + 2));
            for (const std::string& name :
                 lua_istable(L, i + 2) ? lua::text_keys(L, i + 2) : std::vector<std::string>()) {
                lua_getfield(L, i + 2, name.c_str());
                found[{i, name}].push_back(lua_tonumber(L, -1));
                lua_pop(L, 1);
            }
        }
    }
    lua_settop(L, 2);
    for (; found.empty() && results < 2; ++results) lua::push_vector(L, {});
    for (auto& [place, numbers] : found) {
        const bool is_first = lua_gettop(L) < place.first + 2;
        if (!place.second.empty() && is_first) lua_newtable(L);
        lua::push_vector(L, std::move(numbers));
        if (!place.second.empty()) lua_setfield(L, -2, place.second.c_str());
    }
    return results;
}

/// The acceleration at the rows, from the equation of motion.
lua::Pushed run_acceleration(lua_State* L, const RunHandle& run) {
    check_one(L, *run, ".acceleration");
    const motion::Run& result = run->result;
    const auto named = static_cast<Eigen::Index>(result.names().size());
    if (run->of_body() && result.rows.cols() > named) {
        lua::push(L, view_of(run, result.rows.col(named)));
        return {};
    }
    if (!run->of_body()) {
        const auto own = result.find("acceleration");
        own ? static_cast<void>(lua::push(L, view_of(run, result.rows.col(*own)))) : lua_pushnil(L);
        return {};
    }
    const source::Task& task = *run->origin;
    const model::Oscillator body = *alone(*run);
    const model::Lowered system(body);
    const auto& walls = body.walls();
    using motion::Column;
    const auto t = result.column(Column::t), theta = result.column(Column::theta),
               velocity = result.column(Column::velocity), M = result.column(Column::M),
               friction = result.column(Column::friction), damping = result.column(Column::damping);
    std::vector<double> values = lua::new_numbers(L, static_cast<std::size_t>(result.size()));
    RunCall call(L, *run);  // spring and base may be functions
    for (Eigen::Index i = 0; i < result.size(); ++i) {
        const bool leans = walls && velocity[i] == 0 && (theta[i] <= walls->lower || theta[i] >= walls->upper);
        const double torque = M[i] - system.pull_back(theta[i]) + friction[i] + damping[i];
        const double base = task.drive.base.components().empty() ? 0 : task.drive.base.value(t[i]);
        values[static_cast<std::size_t>(i)] = leans ? 0 : torque / body.inertia() - base + 0.0;
        call.check();
    }
    lua::push_vector(L, std::move(values));
    return {};
}

lua::Pushed run_states(lua_State* L, const RunHandle& run) {
    // In a file, columns after the standard ones count as states.
    const std::vector<std::string>& names = run->result.names();
    const std::vector<std::string>& always = motion::column_names();
    const bool has_all = names.size() >= always.size() && std::equal(always.begin(), always.end(), names.begin());
    const std::size_t first = run->origin ? run->result.first_state() : has_all ? always.size() : names.size();
    lua_createtable(L, 0, static_cast<int>(names.size() - first));
    for (std::size_t i = first; i < names.size(); ++i) {
        lua::set_value(L, names[i].c_str(), view_of(run, run->result.rows.col(static_cast<Eigen::Index>(i))));
    }
    lua_createtable(L, 0, 1);
    lua_pushcfunction(L, lua::guarded<no_such_state>);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
    return {};
}

// run:continue{ t_end }: continues a run from its end.

namespace {

/// The rows of the continued run: those so far and the new times; without new ones, the remaining times up to t_end.
motion::Grid asked_rows(const lua::Options& options, const MoreTime& asked, const motion::Run& so_far,
                        const source::Task& task, double t_end) {
    const std::span<const double> times = task.rows.times();
    std::vector<double> more = asked.times.value_or(std::vector<double>());
    if (!more.empty() && more.front() <= so_far.t_stop) {
        options.fail("times", "times[1] = {} must be after t = {}, where the run ended", more.front(), so_far.t_stop);
    }
    if (const auto wrong = motion::Grid::at(more).within({so_far.t_stop, t_end}); !wrong) {
        options.fail(wrong.error());
    }
    const double kept = asked.times ? so_far.t_stop : t_end;
    const auto end = std::ranges::upper_bound(times, kept);
    return task.rows.followed_by(static_cast<std::size_t>(end - times.begin()), std::move(more));
}

}  // namespace

double asked_end(const lua::Options& options, const MoreTime& asked, double stopped, double wanted) {
    if (asked.t_end) {
        return *asked.t_end;
    }
    if (asked.times && !asked.times->empty()) {
        return *std::ranges::max_element(*asked.times);
    }
    if (stopped < wanted) {
        return wanted;
    }
    options.fail("t_end", "the run reached its end at t = {:.6g}: give a later end, for example {}", stopped,
                 continue_call.example);
}

int continue_run(lua_State* L) {
    const RunHandle self = lua::self<RunHandle>(L, 1, continue_call.example);  // a copy: M may drop the last reference
    const RunHandle run = self->whole != nullptr ? self->whole : self;
    const lua::Options options(L, 2, continue_call);
    MoreTime asked;
    options.fill(asked);
    const motion::Run& so_far = run->result;
    if (!run->origin) {
        options.fail(
            {"a run read from a file cannot be continued; start one from its end with sys:simulate{ theta0, "
             "velocity0, t_start, ... }"});
    }
    source::Origin origin = *run->origin;
    for (const model::Excitation& load : origin.drive.loads) {
        for (const model::Component& component : load.components()) {
            const auto* sampled = model::controller_of<model::SampledController>(component);
            if (sampled != nullptr && sampled->first && sampled->latest != run.get()) {
                options.fail(
                    {"the function of excitation.sampled has been used in another run since: simulate this run again"});
            }
        }
    }
    const bool spaced = origin.rows.dt() > 0;
    if (spaced && asked.times) {
        options.fail("times", "this run has a row every dt = {:.6g} and keeps dt; times are for runs with times",
                     origin.rows.dt());
    }
    origin.window.end = asked_end(options, asked, so_far.t_stop, origin.window.end);
    if (!spaced) {
        origin.rows = asked_rows(options, asked, so_far, origin, origin.window.end);
    }
    const auto compute = [&so_far](const source::Task& task, const motion::Monitor& monitor,
                                   const motion::Limits& limits) {
        return motion::resume(*task.system, task.drive, so_far, task.window.end, task.rows, task.integrator, monitor,
                              limits);
    };
    run_task(L, options, std::move(origin), so_far.t_stop, so_far.is_dense(), compute);
    if (self->joint) push_run(L, part_of(*lua::test<RunHandle>(L, -1), *self->joint));
    return 1;
}

// ---- run:save(file): the kind of file, its columns, and the comments that repeat the run

namespace {

/// The columns in `columns = { name or number, ... }`, by default all.
std::vector<files::NamedColumn> asked_columns(lua_State* L, const lua::Options& options, const motion::Run& result) {
    std::vector<files::NamedColumn> all = files::named_columns(result.names(), result.rows.matrix());
    if (!options.has("columns")) {
        return all;
    }
    options.push("columns");
    if (!lua_istable(L, -1) || lua_rawlen(L, -1) == 0) {
        options.wrong("columns");
    }
    std::vector<files::NamedColumn> asked;
    for (lua_Integer i = 1; i <= static_cast<lua_Integer>(lua_rawlen(L, -1)); ++i) {
        lua_rawgeti(L, -1, i);
        const auto column = column_at(L, -1, result.names(), fmt::format("columns[{}]", i));
        const files::NamedColumn& one = all[static_cast<std::size_t>(options.value_or_fail(column))];
        if (text::contains(asked, one.name, &files::NamedColumn::name)) {
            options.fail("columns", "columns names '{}' twice; load reads no such file", one.name);
        }
        asked.push_back(one);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return asked;
}

text::Expected<files::Written> write_record(const std::string& file, const LuaRun& run) {
    if (run.origin && run.system().is_plain()) {
        return files::write_record1989(file, run.result, *alone(run));
    }
    if (run.result.names() == files::record1989_names()) {
        return files::write_record1989(file, run.result.rows.matrix());
    }
    if (run.origin) return text::Error{"a .dat file is of one body with constant Rd and Re; save it as .csv"};
    return text::Error{
        "a .dat file needs the system, which a run that was read from a file no longer has; save it as .csv"};
}

text::Expected<files::Written> write(lua_State* L, const lua::Options& options, const std::string& file,
                                     const LuaRun& run) {
    const std::string ending = text::ending_of(file);
    if (ending == ".csv") {
        return files::write_csv(file, asked_columns(L, options, run.result), repeat_lines(run));
    }
    if (ending != ".dat") {
        return text::Error{.sentence = fmt::format(
                               "the name '{}' must end in .csv (names and numbers) or .dat (the record of 1989)", file),
                           .culprit = file};
    }
    if (options.has("columns")) {
        return text::Error{
            .sentence = "the record of 1989 always has its six columns; save a choice of columns as .csv",
            .option = "columns"};
    }
    return write_record(file, run);
}

}  // namespace

int save_run(lua_State* L) {
    lua::refuse_in_worker(L, "run:save");
    const RunHandle run = lua::self<RunHandle>(L, 1, "run:save(\"run.csv\")");
    if (lua_type(L, 2) != LUA_TSTRING) {
        lua::raise_got(L, 2, "run:save", "run:save: the name of the file must be a string",
                       fmt::format("; for example {}", save_call.example));
    }
    const std::string file = lua_tostring(L, 2);
    const lua::Options options(L, 3, save_call);
    options.value_or_fail(write(L, options, file, *run));
    return 0;
}

}  // namespace dinal::api
