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
#include "text/sentences.hpp"

namespace dinal::api {
namespace {

constexpr double nan_number = std::numeric_limits<double>::quiet_NaN();

/// What a call of sys:response asks: one of the three is varied.
class ResponseCall {
public:
    ResponseCall(lua_State* L, const model::Oscillator& system, const lua::Options& options)
        : L_(L), system_(system), options_(options) {
        options.fill(asked_);
        function_ = options.has("M");
        choose();
        options.push("M");
        place_ = lua_gettop(L);
        if (function_ && !lua::is_callable(L, place_)) {
            options.wrong("M", fmt::format("a function of the {} that returns an excitation", varied_));
        }
        if (!function_ && varied_ == "over") options.fail("over", "over needs M, a function of what it varies");
        if (!function_ && over_frequency() && !list_) add_resonance();
    }

    [[nodiscard]] const std::vector<double>& values() const { return values_; }
    /// A list has rows for its values only.
    [[nodiscard]] bool is_list() const { return list_; }
    [[nodiscard]] model::State start() const { return {asked_.theta0, asked_.velocity0}; }
    [[nodiscard]] bool harmonic() const { return !function_; }
    [[nodiscard]] bool over_frequency() const { return varied_ == "frequency"; }
    [[nodiscard]] double frequency_at(double x) const { return over_frequency() ? x : frequency_.value_or(0); }
    [[nodiscard]] double amplitude_at(double x) const { return varied_ == "amplitude" ? x : amplitude_; }
    [[nodiscard]] VariedColumn column() const {
        const ColumnUnits in(system_.units());
        return {.name = asked_.name.value_or(over_frequency()         ? "frequency"
                                             : varied_ == "amplitude" ? "M0"
                                                                      : "parameter"),
                .unit = over_frequency()         ? in.frequency
                        : varied_ == "amplitude" ? in.M
                                                 : "",
                .theta = in.theta};
    }

    [[nodiscard]] analysis::SteadyQuestion question(double x) const {
        analysis::SteadyQuestion question{.system = system_, .excitation = {}, .drive = {}, .initial = start()};
        const std::optional<double> period = over_frequency() ? std::optional(1 / x)
                                             : frequency_     ? std::optional(1 / *frequency_)
                                                              : std::nullopt;
        if (!function_) {
            question.excitation = options_.value_or_fail(model::Excitation::make(
                model::Harmonic{.amplitude = amplitude_at(x), .omega = 2 * std::numbers::pi * frequency_at(x)}));
            question.drive = {0, *period};
            return question;
        }
        lua_pushvalue(L_, place_);
        lua_pushnumber(L_, x);
        lua_call(L_, 1, 2);
        if (lua_isnil(L_, -2)) {
            options_.fail("M", fmt::format("M({:.6g}) returned nil; it must return an excitation", x));
        }
        question.excitation = to_excitation(L_, -2, fmt::format("sys:response: M({:.6g})", x), "M");
        if (const auto* own = lua::test<model::Oscillator>(L_, -1)) {
            question.system = *own;
        } else if (!lua_isnil(L_, -1)) {
            options_.fail("M", fmt::format("M({:.6g}) returned {} after the excitation, where a system may stand", x,
                                           lua::describe(L_, -1)));
        }
        lua_pop(L_, 2);
        const auto known = analysis::drive_of(question.excitation, period.value_or(1));
        const bool asked = std::find(values_.begin(), values_.end(), x) != values_.end();
        // Between the values asked for M is taken for what it is at them.
        if (asked || !known) {
            question.drive = drive_or_fail(L_, options_, question,
                                           known && !question.excitation.has_script() ? std::nullopt : period);
        } else {
            question.drive = {known->start, question.excitation.has_script() && period ? *period : known->period};
        }
        return question;
    }

private:
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

    /// The numbers under an option; none when it is no list.
    [[nodiscard]] std::vector<double> list_of(const char* option) const {
        options_.push(option);
        const bool single = lua_type(L_, -1) == LUA_TNUMBER || lua_isnil(L_, -1);
        lua_pop(L_, 1);
        return single ? std::vector<double>() : options_.numbers(option);
    }

    void choose() {
        for (const char* option : {"over", "frequency", "amplitude"}) {
            const std::vector<double> given = list_of(option);
            if (given.empty()) continue;
            if (!values_.empty()) {
                options_.fail(option, fmt::format("{} and {} are both lists; one of them is varied", varied_, option));
            }
            varied_ = option;
            spread(given);
        }
        if (options_.has("over") && varied_ != "over") {
            options_.wrong("over", "{ from, to } or a list of numbers");
        }
        if (options_.has("frequency") && !over_frequency()) {
            frequency_ = options_.number("frequency");
            check_frequency(*frequency_);
        }
        if (options_.has("amplitude") && varied_ != "amplitude") amplitude_ = options_.number("amplitude");
        if (values_.empty()) {
            if (options_.has("frequency")) {
                options_.fail(
                    {"frequency must be { from, to }, or a list of frequencies, unless amplitude or over is"});
            }
            options_.missing("frequency");
        }
        if (function_ && options_.has("amplitude")) {
            options_.fail("amplitude", "amplitude is that of the harmonic M: with a function M use over");
        }
        if (!function_ && varied_ == "amplitude" && !frequency_) {
            options_.fail("frequency", "frequency must be given where the amplitude is varied");
        }
    }

    void check_frequency(double f) const {
        if (f > 0) return;
        options_.fail({.sentence = fmt::format("frequency = {} must be positive", f), .option = "frequency"});
    }

    void spread(const std::vector<double>& given) {
        if (given.size() < 2) {
            options_.fail({.sentence = fmt::format("{} must be {{ from, to }}, or a list", varied_),
                           .option = std::string(varied_)});
        }
        if (over_frequency()) std::for_each(given.begin(), given.end(), [this](double f) { check_frequency(f); });
        list_ = given.size() > 2;
        if (!list_ && given[0] == given[1]) {
            options_.fail(
                {.sentence = fmt::format("{} goes from {} to {}, which is no range", varied_, given[0], given[1]),
                 .option = std::string(varied_)});
        }
        values_ = given;
        if (list_) return;
        const auto n = static_cast<std::size_t>(asked_.points);
        values_.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            values_[i] = given[0] + (given[1] - given[0]) * (static_cast<double>(i) / static_cast<double>(n - 1));
        }
        values_.back() = given[1];
    }

    lua_State* L_;
    const model::Oscillator& system_;
    const lua::Options& options_;
    ResponseOptions asked_;
    std::string_view varied_ = "frequency";
    std::vector<double> values_;
    std::optional<double> frequency_;
    double amplitude_ = 1;
    bool list_ = false, function_ = false;
    int place_ = 0;
};

struct ResponseColumns {
    std::vector<double> varied, amplitude, lag, peak, stops, stuck, stable, branch;
    std::vector<std::string> status;

    void add(double x, std::size_t piece, const analysis::SteadyMotion& motion, const std::optional<double>& angle) {
        const bool found =
            motion.status == analysis::SteadyStatus::steady || motion.status == analysis::SteadyStatus::adheres;
        const bool grows = motion.status == analysis::SteadyStatus::grows;
        const double otherwise = grows ? std::numeric_limits<double>::infinity() : nan_number;
        varied.push_back(x);
        amplitude.push_back(found ? motion.amplitude : otherwise);
        lag.push_back(angle.value_or(nan_number));
        peak.push_back(found ? std::max(std::fabs(motion.low), std::fabs(motion.high)) : otherwise);
        stops.push_back(found && motion.stuck < 1 ? static_cast<double>(motion.stops) : nan_number);
        stuck.push_back(found ? motion.stuck : nan_number);
        stable.push_back(found && motion.stable ? 1 : 0);
        branch.push_back(static_cast<double>(piece));
        status.emplace_back(analysis::name(motion.status));
    }
    Data data(const VariedColumn& of) && {
        Data data;
        data.columns = {
            column_of(of.name, std::move(varied), of.unit), column_of("amplitude", std::move(amplitude), of.theta),
            column_of("lag", std::move(lag), "rad"),        column_of("peak", std::move(peak), of.theta),
            column_of("stops", std::move(stops)),           column_of("stuck", std::move(stuck)),
            column_of("stable", std::move(stable)),         column_of("branch", std::move(branch)),
            column_of("status", std::move(status))};
        data.pieces_of = "branch";
        data.dotted_of = "stable";
        return data;
    }
};

}  // namespace

int response_of_system(lua_State* L) {
    const model::Oscillator system = lua::self<model::Oscillator>(L, 1, response_call.example);
    const lua::Options options(L, 2, response_call);
    const ResponseCall call(L, system, options);
    const analysis::CurveQuestion question{
        .family = [&call](double x) { return call.question(x); }, .values = call.values(), .start = call.start()};
    analysis::ResponseCurve curve;
    ResponseColumns columns;
    asking(L, [&](const motion::Monitor& monitor) {
        curve = analysis::response_curve(question, monitor);
        std::size_t piece = 0;
        for (const auto& branch : curve.branches) {
            ++piece;
            for (const analysis::BranchPoint& point : branch) {
                if (call.is_list() && !point.asked) continue;
                const auto shape = analysis::shape_of(call.question(point.parameter), point.motion, monitor);
                columns.add(point.parameter, piece, point.motion, shape.lag);
            }
        }
    });
    if (curve.contradiction) options.fail({model::sentence_with_cure(*curve.contradiction)});
    Data data = std::move(columns).data(call.column());
    data.companions.push_back(jumps_of(curve, call.column()));
    if (call.harmonic()) {
        const auto [low, high] = std::minmax_element(call.values().begin(), call.values().end());
        const HarmonicSweep sweep{
            .system = system,
            .column = call.column(),
            .low = *low,
            .high = *high,
            .frequency = call.over_frequency() ? std::nullopt : std::optional(call.frequency_at(0)),
            .amplitude = call.amplitude_at(1)};
        for (DataCompanion& companion : closed_curves(sweep)) data.companions.push_back(std::move(companion));
    }
    if (!curve.jumps.empty()) {
        data.heading =
            fmt::format("response: {} on {}, {} (c.jumps)", text::counted(data.size(), "row"),
                        curve.branches.size() == 1 ? "1 branch" : fmt::format("{} branches", curve.branches.size()),
                        text::counted(curve.jumps.size(), "jump"));
    }
    push_data(L, std::move(data));
    return 1;
}

}  // namespace dinal::api
