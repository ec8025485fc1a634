#include "api/response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/response_curve.hpp"
#include "analysis/steady_facts.hpp"
#include "api/bind_excitation.hpp"
#include "api/data.hpp"
#include "api/response_companions.hpp"
#include "api/steady_answer.hpp"
#include "api/sweep_parameters.hpp"
#include "text/sentences.hpp"

namespace dinal::api {
namespace {

constexpr double nan_number = std::numeric_limits<double>::quiet_NaN();

inline constexpr text::Option system_at_option[] = {
    {.name = "system", .meaning = "the system at this point", .object = "system", .wanted = "a system"},
};
inline constexpr auto at_options =
    text::joined(drive_options, period_options, start_options, extras_options, system_at_option);
inline constexpr text::Call at_call{"sys:response: at", "at = function(p) return { belt = p.speed } end", at_options};

constexpr const char* new_form = "over = { frequency = vector.linspace(0.05, 3, 200) }";

/// Names the new form of what a call said once.
void refuse_old_forms(lua_State* L) {
    if (!lua_istable(L, 2)) return;
    const auto type_of = [L](const char* name) {
        const int type = lua_getfield(L, 2, name);
        lua_pop(L, 1);
        return type;
    };
    const auto fail = [L](const char* name, std::string sentence) {
        lua::raise(L, {.sentence = fmt::format("sys:response: {}", sentence), .call = "sys:response", .option = name});
    };
    if (type_of("M") != LUA_TNIL) {
        fail(
            "M",
            "instead of M = function(x) ... give over = { NAME = values } and at = function(p) return { M = ... } end");
    }
    for (const char* name : {"points", "name"}) {
        if (type_of(name) != LUA_TNIL)
            fail(name, fmt::format("there is no {}; a list of values has a name: {}", name, new_form));
    }
    for (const char* name : {"frequency", "amplitude"}) {
        const int type = type_of(name);
        if (type != LUA_TTABLE && type != LUA_TUSERDATA) continue;
        fail(name, fmt::format("{0} = values is now over = {{ {0} = values }}, with every value in the list: "
                               "vector.linspace(from, to, count) makes one",
                               name));
    }
}

/// What a call of sys:response asks.
class ResponseCall {
public:
    ResponseCall(lua_State* L, const model::Oscillator& system, const lua::Options& options)
        : L_(L), system_(system), options_(options) {
        options.fill(asked_);
        choose();
        options.push("at");
        place_ = lua_gettop(L);
        function_ = !lua_isnil(L, -1);
        if (function_ && !lua::is_callable(L, place_)) options.wrong("at", options.row("at").wanted);
        if (!function_) check_harmonic();
        extras_ = question(values_.front()).extras;
        if (over_frequency() && !function_ && !is_plane() && asked_.between) add_resonance();
    }

    /// Over two parameters: the second one is varied at each value of the first.
    [[nodiscard]] bool is_plane() const { return parameters_.size() > 1; }
    /// The values of the first of two parameters; one without a meaning if there is one parameter.
    [[nodiscard]] std::vector<double> beside_values() const {
        if (!is_plane()) return {0};
        const auto values = parameters_.front().numbers()->values();
        return {values.begin(), values.end()};
    }
    /// From now on the first of two parameters is this.
    void set_beside(double value) { beside_ = value; }

    [[nodiscard]] const std::vector<double>& values() const { return values_; }
    [[nodiscard]] const model::Extras& extras() const { return extras_; }
    /// Rows for the values only.
    [[nodiscard]] bool is_list() const { return !asked_.between; }
    [[nodiscard]] bool doubled() const { return asked_.doubled; }
    [[nodiscard]] model::State start() const { return {asked_.theta0, asked_.velocity0}; }
    /// There are closed forms beside it.
    [[nodiscard]] bool harmonic() const { return !function_ && (over_frequency() || varied_ == "amplitude"); }
    [[nodiscard]] bool over_frequency() const { return varied_ == "frequency"; }
    [[nodiscard]] double frequency_at(double x) const {
        const auto given = [&](const char* name, const std::optional<double>& option) {
            const auto varied = varied_value(name, x);
            return varied ? varied : option;
        };
        if (const auto frequency = given("frequency", asked_.frequency)) return *frequency;
        if (const auto omega = given("omega", asked_.omega)) return *omega / (2 * std::numbers::pi);
        return 1 / given("period", asked_.period).value_or(1);
    }
    [[nodiscard]] double amplitude_at(double x) const {
        return varied_value("amplitude", x).value_or(asked_.amplitude);
    }
    /// Of each parameter.
    [[nodiscard]] std::vector<VariedColumn> columns() const {
        const ColumnUnits in(system_.units());
        std::vector<VariedColumn> columns;
        for (const DataColumn& parameter : parameters_) {
            const std::string& name = parameter.name;
            VariedColumn column{.name = name, .unit = "", .theta = in.theta};
            if (!function_ && name == "amplitude") column.name = "M0", column.unit = in.M;
            if (!function_ && name == "frequency") column.unit = in.frequency;
            if (!function_ && name == "period") column.unit = in.t;
            if (!function_ && name == "omega" && !in.t.empty()) column.unit = "rad/" + in.t;
            columns.push_back(column);
        }
        return columns;
    }

    [[nodiscard]] analysis::SteadyQuestion question(double x) const {
        analysis::SteadyQuestion question{.system = system_, .excitation = {}, .drive = {}, .initial = start()};
        if (!function_) {
            const double frequency = frequency_at(x);
            question.excitation = options_.value_or_fail(model::Excitation::make(
                model::Harmonic{.amplitude = amplitude_at(x), .omega = 2 * std::numbers::pi * frequency}));
            question.drive = {0, 1 / frequency};
            return question;
        }
        lua_pushvalue(L_, place_);
        lua_newtable(L_);
        if (is_plane()) lua::set_number(L_, parameters_.front().name.c_str(), beside_);
        lua::set_number(L_, varied_.c_str(), x);
        lua_call(L_, 1, 1);
        if (!lua_istable(L_, -1)) {
            options_.fail("at", fmt::format("at returned {} for {} = {:.6g}; it must return a table of options of "
                                            "sys:steady, such as {{ belt = p.speed }}",
                                            lua::describe(L_, -1), varied_, x));
        }
        const lua::Options own(L_, lua_gettop(L_), at_call);
        SteadyOptions asked{.theta0 = asked_.theta0, .velocity0 = asked_.velocity0};
        own.fill(asked);
        asked.period = period_or_fail(own, asked.period, asked.frequency, asked.omega);
        if (const auto* system = own.object<model::Oscillator>("system")) question.system = *system;
        own.push("M");
        question.excitation = to_excitation(L_, -1, "sys:response: at: M", "M");
        lua_pop(L_, 1);
        question.initial = {asked.theta0, asked.velocity0};
        question.periods = asked.periods.value_or(0);
        question.extras = read_extras(L_, own);
        check_relays(own, question.excitation, question.extras);
        const bool is_value = std::find(values_.begin(), values_.end(), x) != values_.end();
        // Between the values M is taken for what it is at them.
        const auto known = is_value ? std::nullopt : drive_between(question);
        if (known) {
            question.drive = {known->start, asked.period.value_or(known->period)};
        } else {
            question.drive = drive_or_fail(L_, own, question, asked.period);
        }
        lua_pop(L_, 1);
        return question;
    }

private:
    [[nodiscard]] std::optional<analysis::Drive> drive_between(const analysis::SteadyQuestion& question) const {
        std::optional<analysis::Drive> drive;
        asking(L_, question.extras, [&](const motion::Monitor&) {
            drive = analysis::drive_of(question.excitation, question.extras, question.initial);
        });
        return drive;
    }

    /// Adds the resonance where the motion grows: a curve past it would show a finite peak.
    void add_resonance() {
        if (!system_.has_linear_spring()) return;
        const double f = 1 / system_.natural_period(), from = values_.front();
        const auto next =
            std::find_if(values_.begin(), values_.end(), [&](double x) { return (x - f) * (from - f) < 0; });
        const auto is_it = [f](double x) { return std::fabs(x / f - 1) < 1e-12; };
        if (next == values_.end() || std::any_of(values_.begin(), values_.end(), is_it)) return;
        const auto there = question(f);
        if (contracts(there) && steady_motion(there).status == analysis::SteadyStatus::grows) values_.insert(next, f);
    }

    /// The value of a parameter of this name where the last one is x; none if it is not varied.
    [[nodiscard]] std::optional<double> varied_value(std::string_view name, double x) const {
        if (name == varied_) return x;
        return is_plane() && name == parameters_.front().name ? std::optional(beside_) : std::nullopt;
    }

    /// The names under `over`, and their values.
    void choose() {
        options_.push("over");
        if (lua_isnil(L_, -1)) options_.missing("over");
        if (!lua_istable(L_, -1)) options_.wrong("over", options_.row("over").wanted);
        parameters_ = parameters_in(L_, lua_gettop(L_), response_call);
        lua_pop(L_, 1);
        if (parameters_.empty()) options_.wrong("over", options_.row("over").wanted);
        if (parameters_.size() > 2) {
            options_.fail("over", fmt::format("over has {} names: a response varies one or two, and sweep varies more",
                                              parameters_.size()));
        }
        check_parameters(L_, response_call, parameters_);
        for (const DataColumn& parameter : parameters_) {
            if (parameter.numbers() == nullptr) {
                options_.fail("over", fmt::format("over.{} must be a list of numbers", parameter.name));
            }
            check_name(parameter.name);
        }
        varied_ = parameters_.back().name;
        const auto values = parameters_.back().numbers()->values();
        values_.assign(values.begin(), values.end());
        beside_ = beside_values().front();
    }

    void check_name(std::string_view name) const {
        for (const char* column : {"lag", "peak", "stops", "stuck", "stable", "branch", "status"}) {
            if (name != column) continue;
            options_.fail("over",
                          fmt::format("'{}' is a column of the result: give the parameter another name", column));
        }
        if (name == "amplitude" && options_.has("at")) {
            options_.fail("over", "'amplitude' is a column of the result: give the parameter another name");
        }
    }

    /// A harmonic M has one frequency, varied or given, and an amplitude.
    void check_harmonic() const {
        const int given = (asked_.frequency ? 1 : 0) + (asked_.omega ? 1 : 0) + (asked_.period ? 1 : 0);
        int in_time = 0;
        for (const DataColumn& parameter : parameters_) {
            const std::string& name = parameter.name;
            const bool times = name == "frequency" || name == "omega" || name == "period";
            if (!times && name != "amplitude") {
                options_.fail("at", fmt::format("over.{} needs at, a function such as {}", name, at_call.example));
            }
            if (!times) continue;
            ++in_time;
            if (given > 0) options_.fail("over", fmt::format("{} is varied, and cannot be given as well", name));
            for (const double x : parameter.numbers()->values()) {
                if (x > 0) continue;
                options_.fail({.sentence = fmt::format("{} = {} must be positive", name, x), .option = name});
            }
        }
        if (in_time > 1) options_.fail("over", "frequency, omega and period exclude each other; vary one of them");
        if (in_time == 0 && given != 1) {
            options_.fail("frequency", "if the amplitude is varied give one of frequency, omega and period");
        }
    }

    lua_State* L_;
    const model::Oscillator& system_;
    const lua::Options& options_;
    ResponseOptions asked_;
    std::vector<DataColumn> parameters_;  // one or two
    std::string varied_;                  // the last of them
    std::vector<double> values_;          // its values
    double beside_ = 0;                   // the present value of the first of two
    model::Extras extras_;
    bool function_ = false;
    int place_ = 0;
};

struct ResponseColumns {
    std::vector<double> beside, varied, amplitude, lag, peak, stops, stuck, stable, branch;
    std::vector<std::string> status;

    void add(double other, double x, std::size_t piece, const analysis::SteadyMotion& motion,
             const std::optional<double>& angle) {
        using analysis::SteadyStatus;
        const bool found = motion.status == SteadyStatus::steady || motion.status == SteadyStatus::adheres ||
                           motion.status == SteadyStatus::rest;
        const bool grows = motion.status == analysis::SteadyStatus::grows;
        const double otherwise = grows ? std::numeric_limits<double>::infinity() : nan_number;
        beside.push_back(other);
        varied.push_back(x);
        amplitude.push_back(found ? motion.amplitude : otherwise);
        lag.push_back(angle.value_or(nan_number));
        peak.push_back(found ? std::max(std::fabs(motion.low), std::fabs(motion.high)) : otherwise);
        stops.push_back(motion.status == SteadyStatus::steady ? static_cast<double>(motion.stops) : nan_number);
        stuck.push_back(found ? motion.stuck : nan_number);
        stable.push_back(found && motion.stable ? 1 : 0);
        branch.push_back(static_cast<double>(piece));
        status.emplace_back(analysis::name(motion.status));
    }
    Data data(const std::vector<VariedColumn>& over) && {
        const VariedColumn& of = over.back();
        Data data;
        data.columns = {
            column_of(of.name, std::move(varied), of.unit), column_of("amplitude", std::move(amplitude), of.theta),
            column_of("lag", std::move(lag), "rad"),        column_of("peak", std::move(peak), of.theta),
            column_of("stops", std::move(stops)),           column_of("stuck", std::move(stuck)),
            column_of("stable", std::move(stable)),         column_of("branch", std::move(branch)),
            column_of("status", std::move(status))};
        if (over.size() > 1) {
            data.columns.insert(data.columns.begin(),
                                column_of(over.front().name, std::move(beside), over.front().unit));
            data.parameters = {over.front().name, of.name};
        }
        data.pieces_of = "branch";
        data.dotted_of = "stable";
        return data;
    }
};

}  // namespace

int response_of_system(lua_State* L) {
    const model::Oscillator system = lua::self<model::Oscillator>(L, 1, response_call.example);
    refuse_old_forms(L);
    const lua::Options options(L, 2, response_call);
    ResponseCall call(L, system, options);
    const analysis::CurveQuestion question{.family = [&call](double x) { return call.question(x); },
                                           .values = call.values(),
                                           .start = call.start(),
                                           .doubled = call.doubled()};
    std::vector<ResponsePart> parts;
    ResponseColumns columns;
    std::size_t pieces = 0, jumps = 0;
    asking(L, call.extras(), [&](const motion::Monitor& monitor) {
        for (const double beside : call.beside_values()) {
            call.set_beside(beside);
            parts.push_back({beside, pieces, analysis::response_curve(question, monitor)});
            const analysis::ResponseCurve& curve = parts.back().curve;
            if (curve.contradiction) return;
            jumps += curve.jumps.size();
            for (const auto& branch : curve.branches) {
                ++pieces;
                for (const analysis::BranchPoint& point : branch) {
                    if (call.is_list() && !point.asked) continue;
                    const auto shape = analysis::shape_of(call.question(point.parameter), point.motion, monitor);
                    columns.add(beside, point.parameter, pieces, point.motion, shape.lag);
                }
            }
        }
    });
    if (parts.back().curve.contradiction) options.fail({model::sentence_with_cure(*parts.back().curve.contradiction)});
    const std::vector<VariedColumn> over = call.columns();
    Data data = std::move(columns).data(over);
    data.companions.push_back(jumps_of(parts, over));
    data.companions.push_back(points_of(parts, over));
    if (call.harmonic() && !call.is_plane()) {
        const auto [low, high] = std::minmax_element(call.values().begin(), call.values().end());
        const HarmonicSweep sweep{
            .system = system,
            .column = over.back(),
            .low = *low,
            .high = *high,
            .frequency = call.over_frequency() ? std::nullopt : std::optional(call.frequency_at(1)),
            .amplitude = call.amplitude_at(1)};
        for (DataCompanion& companion : closed_curves(sweep)) data.companions.push_back(std::move(companion));
    }
    if (jumps > 0) {
        data.heading =
            fmt::format("response: {} on {}, {} (c.jumps)", text::counted(data.size(), "row"),
                        pieces == 1 ? "1 branch" : fmt::format("{} branches", pieces), text::counted(jumps, "jump"));
    }
    push_data(L, std::move(data));
    return 1;
}

}  // namespace dinal::api
