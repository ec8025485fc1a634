#include "api/response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "analysis/response_curve.hpp"
#include "analysis/steady_facts.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/steady_answer.hpp"
#include "model/lowered.hpp"
#include "text/words.hpp"
#include "theory/forced.hpp"

namespace dinal::api {

// Additional data of a response: its jumps, special points and closed-form curves.

/// The name and unit of a varied column, and the unit of theta.
struct VariedColumn {
    std::string name, unit = {}, theta = {};
};

/// A response over one parameter; over two, its part at a value of the first.
struct ResponsePart {
    double beside = 0;
    std::size_t branches_before = 0;  ///< number of branches in the parts before
    analysis::ResponseCurve curve = {};
};

/// A sweep of the frequency, omega or period of a harmonic M, or of its amplitude at one frequency.
struct HarmonicSweep {
    model::Oscillator system;
    VariedColumn column;
    double low = 0, high = 0;
    std::optional<double> frequency = {};  ///< none: the frequency is varied
    double amplitude = 1;                  ///< torque, if the frequency is varied

    double frequency_at(double x) const {
        if (frequency) return *frequency;
        return column.name == "omega" ? x / (2 * std::numbers::pi) : column.name == "period" ? 1 / x : x;
    }
};

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t curve_points = 400;

/// A closed form at one point: amplitude in units of M0/k and lag in rad.
using ClosedCurve = std::optional<theory::Harmonic_motion> (*)(double r, double zeta, double gamma, double breakaway);

std::optional<theory::Harmonic_motion> linearised_at(double r, double zeta, double gamma, double) {
    return theory::linearised_friction(r, zeta, gamma);
}

std::optional<theory::Harmonic_motion> den_hartog_at(double r, double zeta, double gamma, double breakaway) {
    if (!(r >= theory::DenHartog::slowest) || r > theory::DenHartog::fastest) return {};
    const auto motion = theory::DenHartog(r, zeta).motion(gamma, breakaway);
    if (!motion) return {};
    return theory::Harmonic_motion{motion->amplitude, motion->fundamental_lag};
}

Data closed_curve(const HarmonicSweep& sweep, ClosedCurve curve) {
    const model::Oscillator& system = sweep.system;
    const double Rd = system.friction().sliding(model::Motion::forward, 0);
    const double Re = system.friction().holding(model::Motion::forward);
    struct CurvePoint {
        double x, amplitude, lag;
    };
    std::vector<CurvePoint> points;
    for (std::size_t i = 0; i < curve_points; ++i) {
        const double x = sweep.low + (sweep.high - sweep.low) * static_cast<double>(i) / (curve_points - 1);
        const double M0 = std::fabs(sweep.frequency ? x : sweep.amplitude);
        const double r = sweep.frequency_at(x) * system.natural_period();
        const auto motion = M0 > 0 ? curve(r, system.damping_ratio(), Rd / M0, Re / M0) : std::nullopt;
        points.push_back(
            {x, motion ? motion->amplitude * M0 / system.stiffness() : no_number, motion ? motion->lag : no_number});
    }
    return table_of(points, ListColumn{sweep.column.name, &CurvePoint::x, sweep.column.unit},
                    ListColumn{"amplitude", &CurvePoint::amplitude, sweep.column.theta},
                    ListColumn{"lag", &CurvePoint::lag, "rad"});
}

struct LocatedPoint {
    double beside = 0, branch = 0;
    analysis::BranchPoint at = {};
    double curve = 0;
};

/// Connects points to numbered curves. A point continues the curve of the nearest point of its kind at the previous
/// value of the first parameter, if that is near and has no nearer one. `points` are sorted by that parameter.
void number_curves(std::vector<LocatedPoint>& points, double range) {
    constexpr double near = 0.5;  // relative to the range and to the amplitude
    const auto distance = [range](const LocatedPoint& a, const LocatedPoint& b) {
        const double larger = std::max({a.at.motion.amplitude, b.at.motion.amplitude, 1e-300});
        return a.at.kind != b.at.kind ? std::numeric_limits<double>::infinity()
                                      : std::fabs(a.at.parameter - b.at.parameter) / range +
                                            std::fabs(a.at.motion.amplitude - b.at.motion.amplitude) / larger;
    };
    const auto nearest = [&](const LocatedPoint& to, auto from, auto until) {
        return std::min_element(from, until,
                                [&](const auto& a, const auto& b) { return distance(to, a) < distance(to, b); });
    };
    double curves = 0;
    for (auto begin = points.begin(), before = begin; begin != points.end();) {
        const auto end = std::find_if(begin, points.end(), [&](const auto& p) { return p.beside != begin->beside; });
        for (auto point = begin; point != end; ++point) {
            const auto last = nearest(*point, before, begin);
            const bool goes_on = last != begin && distance(*point, *last) < near && nearest(*last, begin, end) == point;
            point->curve = goes_on ? last->curve : ++curves;
        }
        before = begin;
        begin = end;
    }
}

}  // namespace

/// c.linearised and c.den_hartog, for a linear spring and Coulomb friction; otherwise empty.
std::vector<DataCompanion> closed_curves(const HarmonicSweep& sweep) {
    const model::Oscillator& system = sweep.system;
    const model::Lowered lowered(system);
    const bool even = lowered.braking(model::Motion::forward) == -lowered.braking(model::Motion::backward) &&
                      lowered.holding(model::Motion::forward) == lowered.holding(model::Motion::backward);
    if (!system.has_linear_spring() || lowered.has_remainder() || system.walls() || !even) return {};
    return {{"linearised", [sweep] { return closed_curve(sweep, linearised_at); }},
            {"den_hartog", [sweep] { return closed_curve(sweep, den_hartog_at); }}};
}

/// c.jumps, over one or two parameters.
DataCompanion jumps_of(const std::vector<ResponsePart>& parts, const std::vector<VariedColumn>& over) {
    const VariedColumn& column = over.back();
    struct Jump {
        double beside;
        analysis::MotionJump at;
    };
    std::vector<Jump> list;
    for (const ResponsePart& part : parts) {
        for (const analysis::MotionJump& jump : part.curve.jumps) list.push_back({part.beside, jump});
    }
    Data jumps = table_of(list, ListColumn{column.name, [](const Jump& j) { return j.at.parameter; }, column.unit},
                          ListColumn{"sweep", [](const Jump& j) { return j.at.rising ? "up" : "down"; }},
                          ListColumn{"from", [](const Jump& j) { return j.at.from; }, column.theta},
                          ListColumn{"to", [](const Jump& j) { return j.at.to; }, column.theta},
                          ListColumn{"status", [](const Jump& j) { return analysis::name(j.at.landed.status); }});
    if (over.size() > 1) {
        const ListColumn beside{over.front().name, &Jump::beside, over.front().unit};
        jumps.columns.insert(jumps.columns.begin(), beside.column_from(list));
    }
    const auto drawn = [list, column = column] {
        std::vector<double> x, amplitude;
        for (const Jump& jump : list) {
            x.insert(x.end(), {jump.at.parameter, jump.at.parameter, no_number});
            amplitude.insert(amplitude.end(), {jump.at.from, jump.at.to, no_number});
        }
        return Data{.columns = {column_of(column.name, std::move(x), column.unit),
                                column_of("amplitude", std::move(amplitude), column.theta)}};
    };
    return {"jumps", [jumps] { return Data(jumps); }, drawn};
}

/// c.points: folds and points where other branches begin. Over two parameters they form curves.
DataCompanion points_of(const std::vector<ResponsePart>& parts, const std::vector<VariedColumn>& over) {
    std::vector<LocatedPoint> located;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const ResponsePart& part : parts) {
        for (std::size_t i = 0; i < part.curve.branches.size(); ++i) {
            for (const analysis::BranchPoint& point : part.curve.branches[i]) {
                low = std::min(low, point.parameter), high = std::max(high, point.parameter);
                if (point.kind == analysis::BranchKind::point) continue;
                located.push_back({part.beside, static_cast<double>(part.branches_before + i + 1), point});
            }
        }
    }
    const bool is_plane = over.size() > 1;
    if (is_plane) {
        number_curves(located, high - low);
        std::ranges::stable_sort(located, {}, &LocatedPoint::curve);
    }
    const VariedColumn& column = over.back();
    Data points = table_of(
        located, ListColumn{column.name, [](const LocatedPoint& p) { return p.at.parameter; }, column.unit},
        ListColumn{"kind", [](const LocatedPoint& p) { return analysis::name(p.at.kind); }},
        ListColumn{"amplitude", [](const LocatedPoint& p) { return p.at.motion.amplitude; }, column.theta},
        ListColumn{"period",
                   [](const LocatedPoint& p) { return p.at.motion.period > 0 ? p.at.motion.period : no_number; }},
        ListColumn{"branch", &LocatedPoint::branch});
    if (!is_plane) return {"points", [points] { return Data(points); }};
    const ListColumn beside{over.front().name, &LocatedPoint::beside, over.front().unit};
    points.columns.insert(points.columns.begin(), beside.column_from(located));
    points.columns.push_back(ListColumn{"curve", &LocatedPoint::curve}.column_from(located));
    points.pieces_of = "curve";
    const auto drawn = [over, located] {
        std::vector<double> x, y;
        std::vector<std::string> kind;
        for (std::size_t i = 0; i < located.size(); ++i) {
            const auto put = [&](double across, double at) {
                x.push_back(across), y.push_back(at), kind.emplace_back(analysis::name(located[i].at.kind));
            };
            if (i > 0 && located[i].curve != located[i - 1].curve) put(no_number, no_number);
            put(located[i].beside, located[i].at.parameter);
        }
        return Data{.columns = {column_of(over.front().name, std::move(x)), column_of(over.back().name, std::move(y)),
                                column_of("kind", std::move(kind))}};
    };
    return {"points", [points] { return Data(points); }, drawn};
}

// The response.

namespace {

inline constexpr text::Option system_at_option[] = {
    {.name = "system", .meaning = "the system at this point", .object = "system", .wanted = "a system"},
};
inline constexpr auto at_options = text::joined(drive_options, period_options, more_drive_options, system_at_option);
inline constexpr text::Call at_call{"sys:response: at", "at = function(p) return { belt = p.speed } end", at_options};

class ResponseCall {
public:
    ResponseCall(lua_State* L, SystemHandle system, const lua::Options& options)
        : L_(L), system_(std::move(system)), options_(options) {
        options.fill(asked_);
        if (!asked_.of.empty()) {
            joint_ = joint_named(L, asked_.of, *system_, "sys:response: of: this system", system_class);
        }
        choose();
        function_ = options.has("at");
        if (system_->named && !function_) {
            options.fail("at",
                         "a system with named bodies needs at, such as at = function(p) return {{ M = {{ "
                         "{} = excitation.harmonic{{ frequency = p.f }} }} }} end",
                         system_->joints.front().name);
        }
        if (function_) place_ = push_function(L, options, "at");
        if (function_) {
            refuse_harmonic();
        } else {
            check_harmonic();
        }
        if (over_frequency() && harmonic() && !is_plane() && asked_.between && system_->is_plain()) add_resonance();
    }

    /// Returns whether there are two parameters: the second is varied at each value of the first.
    bool is_plane() const { return parameters_.size() > 1; }
    /// The values of the first of two parameters; a dummy value if there is one parameter.
    std::vector<double> beside_values() const {
        if (!is_plane()) return {0};
        const auto values = parameters_.front().numbers()->values();
        return {values.begin(), values.end()};
    }
    /// Sets the first of two parameters.
    void set_beside(double value) { beside_ = value; }

    const std::vector<double>& values() const { return values_; }
    const model::System& system() const { return *system_; }
    /// Returns whether rows are wanted at the given values only.
    bool is_list() const { return !asked_.between; }
    bool doubled() const { return asked_.doubled; }
    model::State start() const { return {asked_.theta0, asked_.velocity0}; }
    /// Returns whether M is harmonic, so that closed forms exist for comparison.
    bool harmonic() const { return !function_; }
    bool over_amplitude() const { return varied_ == "amplitude"; }
    bool over_frequency() const { return varied_ == "frequency"; }
    double frequency_at(double x) const {
        const auto given = [&](const char* name, const std::optional<double>& option) {
            const auto varied = varied_value(name, x);
            return varied ? varied : option;
        };
        if (const auto frequency = given("frequency", asked_.frequency)) return *frequency;
        if (const auto omega = given("omega", asked_.omega)) return *omega / (2 * std::numbers::pi);
        return 1 / given("period", asked_.period).value_or(1);
    }
    double amplitude_at(double x) const { return varied_value("amplitude", x).value_or(asked_.amplitude); }
    /// One column for each parameter.
    std::vector<VariedColumn> columns() const {
        const ColumnUnits in(system_->units);
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

    analysis::SteadyQuestion question(double x) const { return function_ ? question_by_user(x) : question_of_sine(x); }

private:
    /// Pushes the table returned by `at`.
    void push_point(double x) const {
        lua_pushvalue(L_, place_);
        lua_newtable(L_);
        if (is_plane()) lua::set_number(L_, parameters_.front().name.c_str(), beside_);
        lua::set_number(L_, varied_.c_str(), x);
        lua_call(L_, 1, 1);
        if (lua_istable(L_, -1)) return;
        options_.fail("at",
                      "at returned {} for {} = {:.6g}; it must return a table of options of sys:steady, "
                      "such as {{ belt = {} }}",
                      lua::describe(L_, -1), varied_, x, system_->named ? "{ load = p.speed }" : "p.speed");
    }

    analysis::SteadyQuestion question_of_sine(double x) const {
        const double frequency = frequency_at(x);
        auto M = options_.value_or_fail(model::Excitation::make(
            model::Harmonic{.amplitude = amplitude_at(x), .omega = 2 * std::numbers::pi * frequency}));
        const bool plain = system_->is_plain();
        auto question = options_.value_or_fail(analysis::SteadyQuestion::of(
            system_, {std::move(M), start()}, plain ? std::nullopt : std::optional(joint_)));
        question.repeats =
            plain ? analysis::Repetition{0, 1 / frequency} : repetition_at(x, options_, question, 1 / frequency);
        if (!plain) question.settles = settles_or_fail(options_, question);
        return question;
    }

    analysis::SteadyQuestion question_by_user(double x) const {
        push_point(x);
        const lua::Options own(L_, lua_gettop(L_), at_call);
        const auto* changed = own.object<SystemHandle>("system");
        const SystemHandle system = changed != nullptr ? *changed : system_;
        const auto names_alike = [](const model::Joint& a, const model::Joint& b) { return a.name == b.name; };
        if (!std::ranges::equal(system_->joints, system->joints, names_alike)) {
            options_.fail("at", "at must return systems with the same bodies and links");
        }
        SteadyOptions asked;
        own.fill(asked);
        const std::optional<double> period = asked_period(own);
        model::Drive drive = asked_drive(L_, own, *system);
        if (!system->named && !own.has("theta0")) drive.theta0 = {asked_.theta0};
        if (!system->named && !own.has("velocity0")) drive.velocity0 = {asked_.velocity0};
        auto question = own.value_or_fail(analysis::SteadyQuestion::of(
            system, std::move(drive), system->is_plain() ? std::nullopt : std::optional(joint_)));
        question.periods = asked.periods.value_or(0);
        question.repeats = repetition_at(x, own, question, period);
        if (!system->is_plain()) question.settles = settles_or_fail(own, question);
        lua_pop(L_, 1);
        return question;
    }

    analysis::Repetition repetition_at(double x, const lua::Options& own, const analysis::SteadyQuestion& question,
                                       const std::optional<double>& period) const {
        const bool is_value = text::contains(values_, x);
        // Between the values, M counts as periodic as at the values.
        std::optional<analysis::Repetition> known;
        if (!is_value)
            call_checked(L_, question, [&](const motion::Monitor&) { known = analysis::repetition_of(question); });
        if (known) return {known->start, period.value_or(known->period)};
        return repetition_or_fail(L_, own, question, period);
    }

    /// Adds the resonance with unbounded motion: a curve without it would show a finite peak.
    void add_resonance() {
        const model::Oscillator body = oscillator_of(*system_).value();
        if (!body.has_linear_spring()) return;
        const double f = 1 / body.natural_period(), from = values_.front();
        const auto next = std::ranges::find_if(values_, [&](double x) { return (x - f) * (from - f) < 0; });
        const auto is_it = [f](double x) { return std::fabs(x / f - 1) < 1e-12; };
        if (next == values_.end() || std::ranges::any_of(values_, is_it)) return;
        const auto there = question(f);
        if (contracts(there) && steady_motion(there).status == analysis::SteadyStatus::grows) values_.insert(next, f);
    }

    /// The value of this parameter when the last one is x; none if it is not varied.
    std::optional<double> varied_value(std::string_view name, double x) const {
        if (name == varied_) return x;
        return is_plane() && name == parameters_.front().name ? std::optional(beside_) : std::nullopt;
    }

    /// Reads the names in `over` and their values.
    void choose() {
        parameters_ = varied_in(L_, options_);
        for (const DataColumn& parameter : parameters_) check_name(parameter.name);
        varied_ = parameters_.back().name;
        const auto values = parameters_.back().numbers()->values();
        values_.assign(values.begin(), values.end());
        beside_ = beside_values().front();
    }

    /// Checks a parameter's name; with named bodies and links most columns have a prefix.
    void check_name(std::string_view name) const {
        const bool named = system_->named;
        for (const char* column : {"stable", "branch", "status", "lag", "peak", "stops", "stuck", "amplitude"}) {
            const std::string_view known = column;
            const bool own = known == "stable" || known == "branch" || known == "status";
            // its column is called M0, so there is no conflict
            const bool harmonic = known == "amplitude" && !options_.has("at");
            if (name != known || (named && !own) || harmonic) continue;
            options_.fail("over", "'{}' is a column of the result: give the parameter another name", column);
        }
    }

    /// M is what `at` returns, so options of a harmonic M would have no effect.
    void refuse_harmonic() const {
        for (const char* option : {"amplitude", "frequency", "omega", "period"}) {
            if (options_.has(option)) options_.fail(option, "{} and at exclude each other", option);
        }
    }

    /// Checks that a harmonic M has exactly one frequency, varied or given, and an amplitude.
    void check_harmonic() const {
        const int given = (asked_.frequency ? 1 : 0) + (asked_.omega ? 1 : 0) + (asked_.period ? 1 : 0);
        int in_time = 0;
        for (const DataColumn& parameter : parameters_) {
            const std::string& name = parameter.name;
            const bool times = name == "frequency" || name == "omega" || name == "period";
            if (!times && name != "amplitude") {
                options_.fail("at", "over.{} needs at, a function such as {}", name, at_call.example);
            }
            if (times ? given > 0 : options_.has("amplitude")) {
                options_.fail("over", "{} is varied, and cannot be given as well", name);
            }
            if (!times) continue;
            ++in_time;
            for (const double x : parameter.numbers()->values()) {
                if (x > 0) continue;
                options_.fail(name, "{} = {} must be positive", name, x);
            }
        }
        if (in_time > 1) options_.fail("over", "frequency, omega and period exclude each other; vary one of them");
        if (in_time == 0 && given != 1) {
            options_.fail("frequency", "if the amplitude is varied give one of frequency, omega and period");
        }
    }

    lua_State* L_;
    SystemHandle system_;
    std::size_t joint_ = 0;
    const lua::Options& options_;
    ResponseOptions asked_;
    std::vector<DataColumn> parameters_;  // one or two
    std::string varied_;                  // name of the last parameter
    std::vector<double> values_;          // values of the last parameter
    double beside_ = 0;                   // present value of the first of two parameters
    bool function_ = false;
    int place_ = 0;
};

/// The results for one body or link at a point.
struct RowOfJoint {
    analysis::SteadyMotion motion;
    std::optional<double> lag;
};

struct ResponseRow {
    double beside, varied;
    std::size_t branch;
    bool asked;
    analysis::SteadyStatus status;  ///< status of the whole motion
    std::vector<RowOfJoint> joints;

    const analysis::SteadyMotion& motion() const { return joints.front().motion; }
};

/// The motion of each body and link at this point, without its run.
ResponseRow row_of(const analysis::BranchPoint& point, double beside, std::size_t branch,
                   const analysis::SteadyQuestion& question, const motion::Monitor& monitor) {
    ResponseRow row{beside, point.parameter, branch, point.asked, point.motion.status, {}};
    if (question.is_plain()) {
        row.joints.push_back({point.motion, analysis::shape_of(question, point.motion, monitor).lag});
    } else {
        for (std::size_t j = 0; j < question.system->joints.size(); ++j) {
            const analysis::SteadyQuestion own = question.seen_at(j);
            const analysis::SteadyMotion motion = analysis::seen_from(own, point.motion);
            row.joints.push_back({motion, analysis::shape_of(own, motion, monitor).lag});
        }
    }
    const auto moves = [](const RowOfJoint& joint) { return joint.motion.status == analysis::SteadyStatus::steady; };
    if (std::ranges::any_of(row.joints, moves)) row.status = analysis::SteadyStatus::steady;
    for (RowOfJoint& joint : row.joints) joint.motion.by_returns.run = {}, joint.motion.by_returns.of_bodies = {};
    return row;
}

Data response_data(const std::vector<ResponseRow>& rows, const std::vector<VariedColumn>& over,
                   const model::System& system) {
    using analysis::SteadyStatus;
    const VariedColumn& of = over.back();
    const auto found = [&](const analysis::SteadyMotion& motion, double value, bool may_grow = false) {
        const bool grows = may_grow && motion.status == SteadyStatus::grows;
        return motion.is_found() ? value : grows ? std::numeric_limits<double>::infinity() : no_number;
    };
    Data data = table_of(rows, ListColumn{of.name, &ResponseRow::varied, of.unit});
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        const std::string name = system.named ? system.joints[j].name + "." : "";
        const auto motion = [j](const ResponseRow& row) -> const analysis::SteadyMotion& {
            return row.joints[j].motion;
        };
        Data own = table_of(
            rows,
            ListColumn{name + "amplitude",
                       [&](const auto& row) { return found(motion(row), motion(row).amplitude, true); }, of.theta},
            ListColumn{name + "lag", [j](const auto& row) { return row.joints[j].lag.value_or(no_number); }, "rad"},
            ListColumn{name + "peak",
                       [&](const auto& row) { return found(motion(row), greatest_angle(motion(row)), true); },
                       of.theta},
            ListColumn{name + "stops",
                       [&](const auto& row) {
                           return motion(row).status == SteadyStatus::steady ? static_cast<double>(motion(row).stops)
                                                                             : no_number;
                       }},
            ListColumn{name + "stuck", [&](const auto& row) { return found(motion(row), motion(row).stuck); }});
        std::move(own.columns.begin(), own.columns.end(), std::back_inserter(data.columns));
    }
    Data rest = table_of(
        rows, ListColumn{"stable", [&](const auto& row) { return row.motion().is_found() && row.motion().stable; }},
        ListColumn{"branch", &ResponseRow::branch},
        ListColumn{"status", [](const auto& row) { return analysis::name(row.status); }});
    std::move(rest.columns.begin(), rest.columns.end(), std::back_inserter(data.columns));
    if (over.size() > 1) {
        const ListColumn beside{over.front().name, &ResponseRow::beside, over.front().unit};
        data.columns.insert(data.columns.begin(), beside.column_from(rows));
        data.parameters = {over.front().name, of.name};
    }
    data.pieces_of = "branch";
    data.dotted_of = "stable";
    return data;
}

}  // namespace

namespace {

int response_of(lua_State* L, const lua::Options& options, ResponseCall call) {
    const analysis::CurveQuestion question{.family = [&call](double x) { return call.question(x); },
                                           .values = call.values(),
                                           .start = call.start(),
                                           .doubled = call.doubled()};
    std::vector<ResponsePart> parts;
    std::vector<ResponseRow> rows;
    std::size_t pieces = 0, jumps = 0;
    const auto work = [&](const motion::Monitor& monitor) {
        for (const double beside : call.beside_values()) {
            call.set_beside(beside);
            parts.push_back({beside, pieces, analysis::response_curve(question, monitor)});
            const analysis::ResponseCurve& curve = parts.back().curve;
            if (curve.contradiction) return;
            jumps += curve.jumps.size();
            for (const auto& branch : curve.branches) {
                ++pieces;
                for (const analysis::BranchPoint& point : branch) {
                    rows.push_back(row_of(point, beside, pieces, call.question(point.parameter), monitor));
                }
            }
        }
    };
    call_checked(L, call.question(call.values().front()), work);
    if (parts.back().curve.contradiction) options.fail({model::sentence_with_cure(*parts.back().curve.contradiction)});
    const std::vector<VariedColumn> over = call.columns();
    Data data = response_data(rows, over, call.system());
    if (call.is_list()) {
        const auto between = std::make_shared<const Data>(std::move(data));
        std::erase_if(rows, [](const ResponseRow& row) { return !row.asked; });
        data = response_data(rows, over, call.system());
        data.between = between;
    }
    data.companions.push_back(jumps_of(parts, over));
    data.companions.push_back(points_of(parts, over));
    if (call.harmonic() && !call.is_plane() && call.system().is_plain()) {
        const auto [low, high] = std::ranges::minmax_element(call.values());
        const HarmonicSweep sweep{
            .system = oscillator_of(call.system()).value(),
            .column = over.back(),
            .low = *low,
            .high = *high,
            .frequency = call.over_amplitude() ? std::optional(call.frequency_at(1)) : std::nullopt,
            .amplitude = call.amplitude_at(1)};
        for (DataCompanion& companion : closed_curves(sweep)) data.companions.push_back(std::move(companion));
    }
    if (jumps > 0) {
        data.heading =
            fmt::format("response: {} on {}, {} (c.jumps)", text::counted(data.size(), "row"),
                        pieces == 1 ? "1 branch" : fmt::format("{} branches", pieces), text::counted(jumps, "jump"));
    }
    return push_data(L, std::move(data));
}

}  // namespace

int response_of_system(lua_State* L) {
    const SystemHandle system = lua::self<SystemHandle>(L, 1, response_call.example);
    const lua::Options options(L, 2, response_call);
    return response_of(L, options, ResponseCall(L, system, options));
}

}  // namespace dinal::api
