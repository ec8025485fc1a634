// identify{ ... } and the class of its result.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>

#include "analysis/fit_starts.hpp"
#include "analysis/general_fit.hpp"
#include "analysis/identification.hpp"
#include "analysis/misfit.hpp"
#include "api/bind_excitation.hpp"
#include "api/bodies.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/drive_options.hpp"
#include "api/lua_run.hpp"
#include "api/picture.hpp"
#include "api/steady_answer.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "lua/values.hpp"
#include "lua/vector.hpp"
#include "model/controller.hpp"
#include "model/laws/bristle.hpp"
#include "model/laws/coulomb.hpp"
#include "model/laws/stribeck.hpp"
#include "model/springs.hpp"
#include "model/system.hpp"
#include "text/option.hpp"
#include "text/suggest.hpp"
#include "text/words.hpp"

namespace dinal::api {

// The options of identify{ ... }.

struct IdentifyOptions {
    std::optional<std::string> t = {}, theta = {};
    std::optional<double> I = {}, k = {}, C = {}, Rd = {}, Re = {};
};

inline constexpr const char* not_fitted = "known, and so not fitted";
inline constexpr const char* not_fitted_by_body = "known, and so not fitted; of several bodies by name: { load = 0 }";
inline constexpr text::Range positive_k{
    "be positive: identify needs a spring; without one give a k so small that the record is far shorter than a swing",
    text::positive.holds};
inline constexpr text::Option own_identify_options[] = {
    {.name = "data",
     .otherwise = text::needed,
     .meaning = "the record: data, a run, or a table with the columns t and theta; rows with a gap (nan) are left out"},
    text::option<&IdentifyOptions::t>("t", "the name of the column of times",
                                      {.otherwise = "\"t\", \"time\" or the first column"}),
    text::option<&IdentifyOptions::theta>("theta", "the name of the column of angles",
                                          {.otherwise = "\"theta\", \"x\" or the second column"}),
    {.name = "M",
     .unit = "torque",
     .otherwise = "none: a free decay",
     .meaning =
         "the excitation, in the time of the record: a Lua function, or an excitation such as excitation.samples; of "
         "several bodies by name, as in sys:simulate",
     .object = "excitation"},
    {.name = "free",
     .otherwise = "all that are not given",
     .meaning =
         "the values to fit, from I, k, C, Rd, Re and offset; the others are 0, and Re is Rd, unless they are given. "
         "With system: any number of it, such as friction.speed, spring.3 or walls.restitution, or of a table that a "
         "function of the run uses, such as p.Kp; of several bodies and links with their names, such as load.Rd. The start is "
         "always fitted unless it is given",
     .wanted = "a list such as { \"k\", \"Rd\" }"},
    {.name = "system",
     .meaning = "a first guess, of one body or several",
     .object = "system",
     .wanted = "a system such as system{ I = 1, k = 4, Rd = 0.3 }"},
    {.name = "measured",
     .otherwise = "\"theta\"",
     .meaning =
         "with system: \"theta\", \"velocity\" or \"acceleration\", a list of them, or a table with the names of "
         "their columns, { velocity = \"v\" }; gaps (nan) are left out. Needed for several bodies and links, with their "
         "names: { \"load.theta\", [\"motor.velocity\"] = \"w\" }",
     .wanted = "\"theta\", \"velocity\" or \"acceleration\", a list of these, or { velocity = \"v\" }"},
    text::option<&IdentifyOptions::I>("I", not_fitted, {.range = text::positive}),
    text::option<&IdentifyOptions::k>("k", not_fitted, {.range = positive_k}),
    text::option<&IdentifyOptions::C>("C", not_fitted, {.range = text::not_negative}),
    text::option<&IdentifyOptions::Rd>("Rd", not_fitted, {.range = text::not_negative}),
    text::option<&IdentifyOptions::Re>("Re", not_fitted, {.range = text::not_negative}),
    {.name = "theta0", .unit = "rad", .meaning = not_fitted_by_body, .wanted = by_body_wanted},
    {.name = "velocity0", .unit = "rad per time unit", .meaning = not_fitted_by_body, .wanted = by_body_wanted},
    {.name = "offset",
     .unit = "rad",
     .meaning = "the reading where the spring is relaxed, if known; of several bodies by name",
     .wanted = by_body_wanted},
};
inline constexpr auto identify_options = text::joined(own_identify_options, states_option, moved_options);
inline constexpr text::Call identify_call{"identify", "identify{ data = run }", identify_options};

namespace {

using analysis::Unknown;

struct FitAnswer {
    analysis::IdentifyQuestion question;
    analysis::Identified found;
    std::vector<std::pair<std::string, double>> values, errors, errors_if_right;
    /// parameters that the record does not determine, and their bounds
    std::vector<std::pair<std::string, std::vector<double>>> silent;
    std::optional<model::System> system;
    bool from_guess = false;  ///< whether a system was given
    model::Units units;       ///< units of the record; without a unit for M if only ratios to I are found
};
using FitHandle = std::shared_ptr<const FitAnswer>;

/// Replaces the error of a fitted value if the model is wrong.
constexpr double withheld = std::numeric_limits<double>::quiet_NaN();

// The record passed to identify{ ... }, and the choice of fitted parameters.

Data record_of(lua_State* L, const lua::Options& options) {
    Data record;
    options.push("data");
    const int place = lua_gettop(L);
    if (const auto* data = lua::test<DataHandle>(L, place)) {
        record.columns = (*data)->columns;
    } else if (const auto* run = lua::test<RunHandle>(L, place)) {
        if ((*run)->of_all() && !options.has("system")) {
            options.fail("data", "a run of several bodies needs system = ..., or data = run.{} alone",
                         (*run)->system().joints.front().name);
        }
        record = rows_of(*run);
    } else if (lua_istable(L, place)) {
        for (const std::string& name : lua::text_keys(L, place)) {
            lua_getfield(L, place, name.c_str());
            record.columns.push_back(column_of(name, lua::numbers_with_gaps_at(L, -1, "identify", "data." + name)));
            lua_pop(L, 1);
        }
    } else if (lua_isnil(L, place)) {
        options.missing("data");
    } else {
        options.wrong("data", lua_type(L, place) == LUA_TSTRING
                                  ? "what load gives for that file (or a run, or a table of columns)"
                                  : "data, a run, or a table of columns");
    }
    lua_pop(L, 1);
    return record;
}

/// The numbers of the requested column, otherwise of the first with one of these names, otherwise of the column at
/// `place`; nan marks a gap.
std::span<const double> record_numbers(lua_State* L, const lua::Options& options, const Data& record,
                                       const std::optional<std::string>& asked,
                                       std::initializer_list<std::string_view> names, std::size_t place) {
    const DataColumn* found = asked ? &data_functions::column_or_fail(L, record, "identify", *asked) : nullptr;
    for (const std::string_view name : names) found = found == nullptr ? record.find(name) : found;
    if (found == nullptr && place < record.columns.size()) found = &record.columns[place];
    if (found == nullptr) {
        options.fail(text::error("the record has {}; times and angles are needed",
                                 text::counted(record.columns.size(), "column")));
    }
    if (found->numbers() == nullptr) {
        options.fail(text::error("the column '{}' of the record holds words, such as {}", found->name,
                                 first_word(found->words())));
    }
    return found->numbers()->values();
}

/// The units of the record according to its columns.
model::Units units_of_record(const Data& record) {
    model::Units units;
    for (const auto& [name, unit] : {std::pair{"theta", &units.theta}, {"t", &units.t}, {"M", &units.M}}) {
        const DataColumn* column = record.find(name);
        if (column != nullptr && !column->unit.empty()) *unit = column->unit;
    }
    return units;
}

/// Sets times and angles of the question, without gaps. Raises an error if there is no such record.
void take_record(lua_State* L, const lua::Options& options, const IdentifyOptions& asked, const Data& record,
                 analysis::IdentifyQuestion& question) {
    const auto t = record_numbers(L, options, record, asked.t, {"t", "time"}, 0);
    const auto theta = record_numbers(L, options, record, asked.theta, {"theta", "x", "angle"}, 1);
    if (t.size() != theta.size()) {
        options.fail(text::error("the record has {} times, but {} angles", t.size(), theta.size()));
    }
    for (std::size_t i = 0; i < t.size(); ++i) {
        if (std::isnan(t[i]) || std::isnan(theta[i])) continue;
        question.t.push_back(t[i]);
        question.theta.push_back(theta[i]);
    }
}

/// The names in `free`; raises an error if there are none.
std::vector<std::string> free_names(lua_State* L, const lua::Options& options) {
    options.push("free");
    const auto names = lua_istable(L, -1) ? lua::strings_at(L, -1) : std::nullopt;
    if (!names || names->empty()) options.wrong("free");
    lua_pop(L, 1);
    return *names;
}

/// Sets the given parameters: those with a value, and those that are not free. Requires the M of the question.
void take_given(lua_State* L, const lua::Options& options, const IdentifyOptions& asked,
                analysis::IdentifyQuestion& question) {
    if (asked.Re && asked.Rd && *asked.Re < *asked.Rd) {
        options.fail(text::error("Re = {:.6g} must be at least Rd = {:.6g}", *asked.Re, *asked.Rd));
    }
    const auto number = [&](const char* name) {
        return options.has(name) ? std::optional(options.number(name)) : std::nullopt;
    };
    question.given = {asked.I,         asked.k, asked.C, asked.Rd, asked.Re, number("theta0"), number("velocity0"),
                      number("offset")};
    if (!options.has("free")) return;
    analysis::OfEach<bool> is_free;
    for (const std::string& name : free_names(L, options)) {
        const auto* const known = std::ranges::find(analysis::unknown_names, name);
        if (known == analysis::unknown_names.end()) {
            options.fail({.sentence = fmt::format("free has {}, but what can be fitted is {}", name,
                                                  fmt::join(analysis::unknown_names, ", ")),
                          .option = "free",
                          .culprit = name,
                          .cure = text::did_you_mean(name, analysis::unknown_names)});
        }
        const Unknown which = analysis::all_unknowns[static_cast<std::size_t>(known - analysis::unknown_names.begin())];
        if (question.gives(which)) options.fail(text::error("{} is given, so it cannot be fitted", name));
        at(is_free, which) = true;
    }
    for (const Unknown which : {Unknown::I, Unknown::k, Unknown::C, Unknown::Rd, Unknown::Re, Unknown::offset}) {
        if (at(is_free, which) || question.gives(which)) continue;
        if (which != Unknown::I && which != Unknown::k) {
            at(question.given, which) = 0;  // for Re, 0 means Rd
        } else if (question.M) {
            options.fail(text::error("{} is neither given nor in free", analysis::name(which)));
        }
    }
}

// identify{ system = ..., free = { ... } }: fits parameters of any system, and fields of tables that user functions
// read, to measured angles, velocities or accelerations, from a guess.

enum class Sign { any, not_negative, positive };
/// Receives a number with its name and may change it. Returns whether it did.
using Change = std::function<bool(const std::string& name, double& number, Sign sign)>;

/// Visits Rd and Re. If both were equal and only Rd changes, Re stays equal to it.
void change_torques(model::laws::Coulomb& law, const std::string& before, const Change& change) {
    const bool one_number = law.kinetic == law.breakaway;
    change(before + "Rd", law.kinetic, Sign::not_negative);
    const bool own = change(before + "Re", law.breakaway, Sign::not_negative);
    law.breakaway = one_number && !own ? law.kinetic : std::max(law.kinetic, law.breakaway);
}

template <class Law>
void change_rows(Law& law, std::span<const text::Option> rows, const Change& change) {
    double Rd = 0;  // set by the first row
    for (const text::Option& row : rows) {
        text::OptionValue now = row.filled.get(&law);
        auto* number = std::get_if<double>(&now);
        if (number == nullptr) continue;
        const std::string_view name = row.name;
        change(fmt::format("friction.{}", name), *number,
               row.range.must == text::positive.must ? Sign::positive : Sign::not_negative);
        if (name == "Rd") Rd = *number;
        if (name == "Re") *number = std::max(*number, Rd);
        row.filled.set(&law, now);
    }
}

model::Friction changed_law(const model::Friction& friction, const Change& change) {
    using namespace model::laws;
    if (const auto* own = friction.as<AsymmetricCoulomb>()) {
        AsymmetricCoulomb law = *own;
        change_torques(law.forward, "friction.forward.", change);
        change_torques(law.backward, "friction.backward.", change);
        return law;
    }
    if (const auto* own = friction.as<Stribeck>()) {
        Stribeck law = *own;
        change_rows(law, stribeck_options, change);
        return law;
    }
    if (const auto* own = friction.as<Bristle>()) {
        Bristle law = *own;
        change_rows(law, law.dahl ? std::span<const text::Option>(dahl_options) : lugre_options, change);
        return law;
    }
    const auto* own = friction.as<Coulomb>();
    if (own == nullptr && !friction.under(1).none()) return friction;
    Coulomb law = own != nullptr ? *own : Coulomb{};
    change_torques(law, "", change);
    return law.breakaway > 0 ? model::Friction(law) : model::Friction();
}

/// The prefix of names for this body or link: "load.".
std::string before_names(const model::System& system, std::size_t joint) {
    return system.named ? system.joints[joint].name + "." : "";
}

/// Returns "load." for "load.Rd"; empty for a single unnamed body.
std::string body_of_value(const FitAnswer& fit, std::string_view name) {
    for (std::size_t j = 0; fit.system && j < fit.system->joints.size(); ++j) {
        std::string before = before_names(*fit.system, j);
        if (name.starts_with(before)) return before;
    }
    return "";
}

/// Visits each fittable number of the body or link by its name in identify: "load.Rd", or "Rd" for a single body.
void change_numbers(model::System& system, std::size_t j, const Change& change_named) {
    const std::string before = before_names(system, j);
    const Change change = [&](const std::string& own, double& number, Sign sign) {
        return change_named(before + own, number, sign);
    };
    model::Joint& joint = system.joints[j];
    if (!system.is_link(j)) change("I", system.bodies[j].inertia, Sign::positive);
    change("k", joint.stiffness, Sign::not_negative);
    change("C", joint.damping, Sign::not_negative);
    model::ContactFriction& contact = joint.friction;
    if (!contact.function && !contact.sliding[0] && !contact.holding[0]) {
        contact.law = changed_law(contact.law, change).under(contact.law.normal());
    }
    if (const auto* own = joint.spring.as<model::springs::PolynomialSpring>()) {
        model::springs::PolynomialSpring spring = *own;
        for (auto& [power, coefficient] : spring.terms) {
            change(fmt::format("spring.{}", power), coefficient, Sign::any);
        }
        joint.spring = spring;
    }
    if (joint.stops) {
        change("walls.lower", joint.stops->lower, Sign::any);
        change("walls.upper", joint.stops->upper, Sign::any);
        change("walls.stiffness", joint.stops->stiffness, Sign::positive);
        change("walls.damping", joint.stops->damping, Sign::not_negative);
    }
    if (joint.walls) {
        change("walls.lower", joint.walls->lower, Sign::any);
        change("walls.upper", joint.walls->upper, Sign::any);
        change("walls.restitution", joint.walls->restitution, Sign::not_negative);
    }
}

/// Pushes the system, or raises the error in its numbers.
int push_with_numbers(lua_State* L, const model::System& system) {
    if (!system.named) return push_alone(L, "identify", system, 0);
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        if (!system.is_link(j) && system.bodies[j].moved) continue;
        push_alone(L, "identify", system, j);
        lua_pop(L, 1);
    }
    lua::push<model::SystemHandle>(L, std::make_shared<const model::System>(system));
    return 1;
}

/// Runs a system; receives it and the options of the run.
int run_with_numbers(lua_State* L) {
    push_with_numbers(L, *static_cast<const model::System*>(lua_touserdata(L, 1)));
    lua_getfield(L, -1, "simulate");
    lua_insert(L, -2);
    lua_pushvalue(L, 2);
    lua_call(L, 2, 1);
    return 1;
}

struct Fitted {
    std::string name;
    double start = 0, typical = 0, least = -1e300;
    std::vector<double> other_starts = {};
    int table = 0;         ///< stack index of its table; 0: none
    std::string key = {};  ///< key in that table
};

enum class Measure { theta, velocity, acceleration };
constexpr const char* measure_names[] = {"theta", "velocity", "acceleration"};
struct MeasuredColumn {
    Measure quantity;
    std::size_t joint;
    std::string name;  ///< column name in a run
    std::vector<double> numbers = {};
    double range = 0;
    double size = 1;  ///< unit in the fit: the noise, or a small fraction of the range
};

class AnyFit {
public:
    AnyFit(lua_State* L, const lua::Options& options, const IdentifyOptions& asked, const Data& record)
        : L_(L), options_(options), asked_(asked), record_(record) {
        luaL_checkstack(L, 200, "for a fit");
        take_system();
        take_columns();
        take_free();
    }

    void fit(FitAnswer& fit) {
        analysis::GeneralQuestion question;
        const auto n = static_cast<Eigen::Index>(free_.size());
        question.start.resize(n);
        question.scale = {Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd::Zero(n)};
        for (Eigen::Index i = 0; i < n; ++i) {
            const Fitted& one = free_[static_cast<std::size_t>(i)];
            question.start[i] = one.start;
            question.scale.typical[i] = one.typical;
            question.scale.least[i] = one.least;
            question.scale.whole[i] = std::max(10 * one.typical, std::fabs(one.start));
            question.other_starts.push_back(one.other_starts);
            question.zeros.push_back(column_with_zero(one.name));
        }
        std::vector<double> all;
        for (std::size_t row = 0; row < t_.size(); ++row) {
            for (std::size_t j = 0; j < columns_.size(); ++j) {
                if (std::isnan(columns_[j].numbers[row])) continue;
                all.push_back(columns_[j].numbers[row] / columns_[j].size);
                column_of_.push_back(static_cast<int>(j));
                time_of_.push_back(t_[row]);
            }
            known_until_.push_back(static_cast<Eigen::Index>(all.size()));
        }
        if (all.size() < free_.size() + 4) {
            options_.fail(text::error("{} numbers are too few to fit {} parameters", all.size(), free_.size()));
        }
        question.columns = column_of_, question.times = time_of_;
        question.measured = Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
        constexpr double first = 2.2;
        double length = first * swing_;
        while (t_.front() + length < t_.back()) {
            const auto rows = std::ranges::upper_bound(t_, t_.front() + length) - t_.begin();
            const Eigen::Index count = known_until_[static_cast<std::size_t>(rows) - 1];
            if (count > n + 4) question.stages.push_back(count);
            length *= 2;
        }
        question.model = [this](const Eigen::VectorXd& p, Eigen::Index count) { return predicted(p, count); };
        question.structures = [this](const Eigen::VectorXd& p, double noise, bool is_white) {
            return structures(p, noise, is_white);
        };
        constexpr double rounding = 1e-7;
        for (const MeasuredColumn& column : columns_) {
            std::vector<double> known;
            std::ranges::copy_if(column.numbers, std::back_inserter(known), [](double x) { return !std::isnan(x); });
            question.steps.push_back(analysis::step_of_instrument(known) / column.size);
            question.least_noise = std::max(question.least_noise, rounding * column.range / column.size);
        }
        const auto found = analysis::general_fit(question);
        restore();
        if (!found) {
            options_.fail({failure_.empty() ? "no run of this system reaches the end of the record" : failure_});
        }
        answer(*found, fit);
    }

private:
    void take_system() {
        options_.push("system");
        const auto* system = lua::test<model::SystemHandle>(L_, -1);
        if (system == nullptr) options_.wrong("system");
        system_ = **system;
        lua_pop(L_, 1);
        for (const char* name : {"I", "k", "C", "Rd", "Re"}) {
            if (options_.has(name)) options_.fail(name, "{} is part of the first guess, system = ...", name);
        }
    }

    /// The measured quantities and their columns: "velocity", { "theta", "velocity" } or { theta = "x" }.
    std::vector<std::pair<MeasuredColumn, std::string>> asked_columns() {
        std::vector<std::pair<MeasuredColumn, std::string>> asked;
        const std::string_view wanted = system_.named
                                            ? "a table such as { \"load.theta\", [\"motor.velocity\"] = \"w\" }"
                                            : options_.row("measured").wanted;
        const auto add = [&](const std::string& name, const std::string& column) {
            std::vector<std::string> known;
            for (std::size_t j = 0; j < system_.joints.size(); ++j) {
                for (const char* quantity : measure_names) known.push_back(before_names(system_, j) + quantity);
            }
            const auto found = std::ranges::find(known, name);
            if (found == known.end()) {
                options_.fail({.sentence = fmt::format("measured must be {}, got \"{}\"", wanted, name),
                               .option = "measured",
                               .culprit = name,
                               .cure = text::did_you_mean(name, known)});
            }
            const auto place = static_cast<std::size_t>(found - known.begin());
            constexpr std::size_t count = std::size(measure_names);
            asked.push_back({{static_cast<Measure>(place % count), place / count, name}, column});
        };
        options_.push("measured");
        if (lua_isnil(L_, -1) && !system_.named) {
            add("theta", asked_.theta.value_or("theta"));
        } else if (lua_type(L_, -1) == LUA_TSTRING) {
            add(lua_tostring(L_, -1), lua_tostring(L_, -1));
        } else if (lua_istable(L_, -1)) {
            for (lua_pushnil(L_); lua_next(L_, -2) != 0; lua_pop(L_, 1)) {
                if (lua_type(L_, -1) != LUA_TSTRING) options_.wrong("measured", wanted);
                add(lua_type(L_, -2) == LUA_TSTRING ? lua_tostring(L_, -2) : lua_tostring(L_, -1),
                    lua_tostring(L_, -1));
            }
        }
        if (asked.empty()) options_.wrong("measured", wanted);
        lua_pop(L_, 1);
        std::ranges::sort(asked, [](const auto& a, const auto& b) {
            return std::tie(a.first.quantity, a.first.joint, a.second) <
                   std::tie(b.first.quantity, b.first.joint, b.second);
        });
        return asked;
    }

    void take_columns() {
        const auto t = record_numbers(L_, options_, record_, asked_.t.value_or("t"), {}, 0);
        for (auto& [column, name] : asked_columns()) {
            const auto numbers = record_numbers(L_, options_, record_, name, {}, 0);
            if (numbers.size() != t.size()) {
                options_.fail(text::error("the record has {} times, but {} numbers in the column '{}'", t.size(),
                                          numbers.size(), name));
            }
            column.numbers.assign(numbers.begin(), numbers.end());
            columns_.push_back(std::move(column));
        }
        std::vector<std::size_t> rows;
        for (std::size_t i = 0; i < t.size(); ++i) {
            const bool known = std::ranges::any_of(
                columns_, [i](const MeasuredColumn& column) { return !std::isnan(column.numbers[i]); });
            if (known && !std::isnan(t[i])) rows.push_back(i);
        }
        for (const std::size_t i : rows) t_.push_back(t[i]);
        for (MeasuredColumn& column : columns_) {
            std::vector<double> kept, known;
            for (const std::size_t i : rows) {
                kept.push_back(column.numbers[i]);
                if (!std::isnan(kept.back())) known.push_back(kept.back());
            }
            column.numbers = std::move(kept);
            if (known.size() < 8) options_.fail({"a measured column needs at least 8 numbers"});
            const auto [low, high] = std::ranges::minmax_element(known);
            if (!(*high > *low)) options_.fail({"a measured column is constant: there is no motion in it"});
            column.range = *high - *low;
            column.size = std::max(analysis::noise_of(known), 1e-6 * column.range);
        }
        for (std::size_t i = 0; i + 1 < t_.size(); ++i) {
            if (!(t_[i] < t_[i + 1])) {
                options_.fail(
                    text::error("times must increase, but t = {:.6g} is followed by {:.6g}", t_[i], t_[i + 1]));
            }
        }
    }

    /// Sets typical sizes in this record, for parameters that start at 0.
    void take_scales() {
        constexpr double swings = 10;
        const double period = system_.shortest_natural_period(), span = t_.back() - t_.front();
        swing_ = std::isfinite(period) ? period : span / swings;
        time_ = swing_ / (2 * std::numbers::pi);
        std::array<double, 3> range{};
        for (const MeasuredColumn& column : columns_) {
            double& widest = range.at(static_cast<std::size_t>(column.quantity));
            widest = std::max(widest, column.range);
        }
        angle_ = range[0] > 0 ? range[0] : range[1] > 0 ? range[1] * time_ : range[2] * time_ * time_;
        speed_ = range[1] > 0 ? range[1] : angle_ / time_;
    }

    void take_free() {
        take_scales();
        theta0_ = given("theta0"), velocity0_ = given("velocity0"), offset_ = given("offset");
        for (const std::string& name : free_names(L_, options_)) add_free(name);
        for (std::size_t body = 0; body < system_.bodies.size(); ++body) {
            const std::string before = before_names(system_, body);
            if (!theta0_[body] && initial_angle_matters(body)) {
                const MeasuredColumn* theta = measured(body, Measure::theta);
                const double begins = theta == nullptr || std::isnan(theta->numbers[0]) ? 0 : theta->numbers[0];
                free_.push_back({.name = before + "theta0", .start = begins, .typical = 0.1 * angle_});
            }
            if (velocity0_[body]) continue;
            Fitted one{.name = before + "velocity0", .start = first_velocity(body), .typical = 0.1 * speed_};
            // At rest under friction the derivative with respect to the velocity is zero.
            const bool is_measured = measured(body, Measure::theta) != nullptr || one.start != 0;
            if (!is_measured) one.other_starts = {speed_, -speed_};
            free_.push_back(std::move(one));
        }
    }

    /// The numbers in this option for each body or link; a single unnamed body has one number.
    std::vector<std::optional<double>> given(const char* option) {
        std::vector<std::optional<double>> numbers(system_.joints.size());
        if (!options_.has(option)) return numbers;
        if (!system_.named) return numbers[0] = options_.number(option), numbers;
        options_.push(option);
        if (!lua_istable(L_, -1)) options_.wrong(option);
        for (lua_pushnil(L_); lua_next(L_, -2) != 0; lua_pop(L_, 1)) {
            const bool number = lua_type(L_, -1) == LUA_TNUMBER && std::isfinite(lua_tonumber(L_, -1));
            if (!number || lua_type(L_, -2) != LUA_TSTRING) options_.wrong(option);
            const std::string what = fmt::format("identify: {}: the system", option);
            const std::size_t joint = joint_named(L_, lua_tostring(L_, -2), system_, what.c_str(), system_class);
            if (system_.is_link(joint) && std::string_view(option) != "offset") options_.wrong(option);
            numbers[joint] = lua_tonumber(L_, -1);
        }
        lua_pop(L_, 1);
        return numbers;
    }

    /// The first column that measures this quantity, or nullptr.
    const MeasuredColumn* measured(std::size_t joint, Measure quantity) const {
        const auto found = std::ranges::find_if(columns_, [&](const MeasuredColumn& column) {
            return column.joint == joint && column.quantity == quantity;
        });
        return found == columns_.end() ? nullptr : &*found;
    }

    /// The measured column of angles whose zero has this name.
    std::optional<int> column_with_zero(std::string_view name) const {
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const bool is_angle = columns_[i].quantity == Measure::theta;
            if (is_angle && before_names(system_, columns_[i].joint) + "offset" == name) return static_cast<int>(i);
        }
        return {};
    }

    /// Returns whether the initial angle matters: without a spring, no velocity depends on it.
    bool initial_angle_matters(std::size_t body) const {
        for (std::size_t j = 0; j < system_.joints.size(); ++j) {
            const model::Joint& joint = system_.joints[j];
            if (!joint.is_on(body)) continue;
            if (joint.stiffness != 0 || measured(j, Measure::theta) != nullptr) return true;
        }
        return false;
    }

    double first_velocity(std::size_t body) const {
        const MeasuredColumn* velocity = measured(body, Measure::velocity);
        if (velocity != nullptr && !std::isnan(velocity->numbers[0])) return velocity->numbers[0];
        const MeasuredColumn* theta = measured(body, Measure::theta);
        if (theta == nullptr) return 0;
        const std::size_t last = std::min<std::size_t>(4, t_.size() - 1);
        const double rise = theta->numbers[last] - theta->numbers[0];
        return std::isfinite(rise) ? rise / (t_[last] - t_[0]) : 0;
    }

    void add_free(const std::string& name) {
        Fitted one{.name = name};
        std::vector<std::string> known;
        bool found = false;
        for (std::size_t j = 0; j < system_.joints.size(); ++j) {
            const std::string before = before_names(system_, j);
            const bool of_start = name == before + "theta0" || name == before + "velocity0";
            if (of_start && !system_.is_link(j)) return;  // the start is fitted unless given
            if (name == before + "offset") one.typical = 0.1 * angle_, found = true;
            change_numbers(system_, j, [&](const std::string& own, double& number, Sign sign) {
                known.push_back(own);
                if (own != name || !std::isfinite(number)) return false;
                const double torque = system_.bodies[system_.joints[j].first()].inertia * speed_ / time_;
                found = true, one.start = number;
                one.least = sign == Sign::any ? -1e300 : sign == Sign::positive ? 1e-6 * one.start : 0;
                one.typical = name == before + "C" ? 0.01 * torque / speed_ : 0.01 * torque;
                return false;
            });
        }
        if (!found) find_table(name, known, one);
        if (one.start != 0) one.typical = std::fabs(one.start), one.other_starts = {0.5 * one.start, 2 * one.start};
        free_.push_back(std::move(one));
    }

    /// Returns whether this parameter is a function or an excitation.
    bool is_function(std::string_view name) const {
        for (std::size_t j = 0; j < system_.joints.size(); ++j) {
            const model::Joint& joint = system_.joints[j];
            const model::ContactFriction& friction = joint.friction;
            const bool polynomial = joint.spring.as<model::springs::PolynomialSpring>() != nullptr;
            const std::pair<const char*, bool> functions[] = {{"friction", friction.function != nullptr},
                                                              {"Rd", friction.sliding[0].has_value()},
                                                              {"Re", friction.holding[0].has_value()},
                                                              {"normal", friction.normal.has_value()},
                                                              {"spring", !joint.spring.none() && !polynomial}};
            for (const auto& [own, is] : functions) {
                if (is && name.starts_with(before_names(system_, j) + own)) return true;
            }
        }
        return false;
    }

    /// Resolves a name such as "p.Kp": p is an upvalue of a function in M, belt, base or a rate of a state, or else a
    /// global.
    void find_table(const std::string& name, const std::vector<std::string>& known, Fitted& one) {
        const std::size_t dot = name.find('.');
        const std::string variable = name.substr(0, dot);
        bool found = false;
        for (const char* option : {"M", "belt", "base", "states"}) {
            if (found || dot == std::string::npos) break;
            options_.push(option);
            found = push_variable(variable, 0);
            found ? lua_remove(L_, -2) : lua_pop(L_, 1);
        }
        if (!found && dot != std::string::npos) {
            lua_getglobal(L_, variable.c_str());
            found = lua_istable(L_, -1);
            if (!found) lua_pop(L_, 1);
        }
        one.table = lua_gettop(L_);
        one.key = dot == std::string::npos ? "" : name.substr(dot + 1);
        if (found && push_field(one) == LUA_TNUMBER) {
            one.start = lua_tonumber(L_, -1);
            one.typical = 1;
            lua_pop(L_, 1);
            return;
        }
        if (is_function(name)) {
            options_.fail("free", "free has '{}', but that is a function: only numbers can be fitted", name);
        }
        options_.fail(
            {.sentence = fmt::format("free has '{}', which is no number of the system, such as {}, and none of "
                                     "a table that M uses, such as p.Kp",
                                     name, system_.named ? known.front() : "k or friction.speed"),
             .option = "free",
             .culprit = name,
             .cure = text::did_you_mean(name, known)});
    }

    /// Pushes a field without metamethods, because a strict table may raise errors for unknown names.
    int push_field(const Fitted& one) {
        lua_pushstring(L_, one.key.c_str());
        return lua_rawget(L_, one.table);
    }

    /// Pushes the table that functions inside the value on the top use under this name. Returns false if there is none.
    bool push_variable(const std::string& variable, int depth) {
        const int value = lua_gettop(L_);
        if (const auto* excitation = lua::test<model::Excitation>(L_, value)) {
            for (const model::Component& component : excitation->components()) {
                const auto* script = std::get_if<model::Scripted>(&component.term);
                const auto* controller = model::controller_of(component);
                const auto* function =
                    dynamic_cast<const lua::LuaFunction*>(controller != nullptr ? controller->function.get()
                                                          : script != nullptr   ? script->function.get()
                                                                                : nullptr);
                if (function == nullptr) continue;
                function->push(L_);
                if (push_variable(variable, depth)) return lua_remove(L_, value + 1), true;
                lua_pop(L_, 1);
            }
            return false;
        }
        if (lua_type(L_, value) == LUA_TFUNCTION && lua_iscfunction(L_, value) == 0) {
            for (int i = 1; const char* known = lua_getupvalue(L_, value, i); ++i) {
                if (known == variable && lua_istable(L_, -1)) return true;
                lua_pop(L_, 1);
            }
        }
        if (lua_istable(L_, value) && depth < 3) {
            for (lua_pushnil(L_); lua_next(L_, value) != 0; lua_pop(L_, 1)) {
                if (!push_variable(variable, depth + 1)) continue;
                lua_replace(L_, value + 1);
                lua_settop(L_, value + 1);
                return true;
            }
        }
        return false;
    }

    void set_number(const Fitted& one, double value) const {
        lua_pushnumber(L_, value);
        lua_setfield(L_, one.table, one.key.c_str());
    }

    /// Writes fitted values to the tables, and returns the system with the fitted parameters.
    model::System with(const Eigen::VectorXd& p) {
        model::System system = system_;
        for (std::size_t j = 0; j < system.joints.size(); ++j) {
            change_numbers(system, j, [&](const std::string& name, double& number, Sign /*sign*/) {
                const auto value = fitted(p, name);
                number = value.value_or(number);
                return value.has_value();
            });
        }
        for (std::size_t i = 0; i < free_.size(); ++i) {
            if (free_[i].table > 0) set_number(free_[i], p[static_cast<Eigen::Index>(i)]);
        }
        return system;
    }

    std::optional<Eigen::VectorXd> predicted(const Eigen::VectorXd& p, Eigen::Index count) {
        const int top = lua_gettop(L_);
        const auto rows =
            static_cast<std::size_t>(std::ranges::lower_bound(known_until_, count) - known_until_.begin() + 1);
        std::optional<Eigen::VectorXd> found;
        if (push_run(p, rows)) found = stacked(p, rows);
        lua_settop(L_, top);
        return found;
    }

    /// Pushes a run with these parameters that has all these rows. Returns whether there is one.
    bool push_run(const Eigen::VectorXd& p, std::size_t rows) {
        model::System system = with(p);
        lua_pushcfunction(L_, lua::guarded<run_with_numbers>);
        lua_pushlightuserdata(L_, &system);
        push_options(p, rows);
        const bool good = lua_pcall(L_, 2, 1, 0) == LUA_OK;
        if (!good && lua::interrupt_requested()) lua_error(L_);
        if (!good) failure_ = lua::text_at(L_, -1);
        const auto* run = good ? lua::test<RunHandle>(L_, -1) : nullptr;
        return run != nullptr && static_cast<std::size_t>((*run)->result.size()) == rows;
    }

    // ---- torques that the model may lack

    /// A torque added to M on a body or link.
    struct Added {
        std::size_t joint;
        model::Excitation torque;
    };

    /// Possible missing torques at joints that are measured or have a fitted parameter, and drifts of measured zeros.
    std::vector<analysis::Structure> structures(const Eigen::VectorXd& p, double noise, bool is_white) {
        std::vector<analysis::Structure> found;
        for (std::size_t j = 0; j < columns_.size(); ++j) {
            found.push_back(analysis::drift(time_of_, column_of_, static_cast<int>(j), is_white));
        }
        for (std::size_t j = 0; j < system_.joints.size(); ++j) {
            const std::string before = before_names(system_, j);
            const bool is_fitted =
                std::ranges::any_of(free_, [&](const Fitted& one) { return one.name.starts_with(before); });
            const bool is_measured = text::contains(columns_, j, &MeasuredColumn::joint);
            if (is_fitted || is_measured) add_missing_torques(j, p, noise, found);
        }
        return found;
    }

    void add_missing_torques(std::size_t joint, const Eigen::VectorXd& p, double noise,
                             std::vector<analysis::Structure>& found) {
        const auto path = [&](const char* quantity) {
            std::vector<double> numbers;
            lua_getfield(L_, -1, (before_names(system_, joint) + quantity).c_str());
            if (const auto* vector = lua::test<lua::Vector>(L_, -1)) numbers.assign(vector->begin(), vector->end());
            lua_pop(L_, 1);
            return numbers;
        };
        const int top = lua_gettop(L_);
        const bool runs = push_run(p, t_.size());
        const auto theta = runs ? path("theta") : std::vector<double>(), velocity = runs ? path("velocity") : theta;
        lua_settop(L_, top);
        if (theta.size() != t_.size() || velocity.size() != t_.size()) return;
        const analysis::Pushed pushed = [&](const model::Excitation& added) {
            added_ = {{joint, added}};
            auto changed = predicted(p, known_until_.back());
            added_.reset();
            return changed;
        };
        const double whole = system_.bodies[system_.joints[joint].first()].inertia * speed_ / time_;
        const auto torques = analysis::MissingTorques(theta, velocity).along(t_, theta, velocity);
        const auto changes = analysis::responses(pushed, torques, whole, noise);
        if (!changes) return;
        const model::System fitted = with(p);
        const model::Joint& own = fitted.joints[joint];
        const auto* dry = own.friction.law.as<model::laws::Coulomb>();
        const auto [low, high] = std::ranges::minmax_element(theta);
        found.push_back({analysis::Follows::velocity,
                         changes->leftCols(analysis::velocity_torques),
                         {},
                         analysis::plausible_friction(dry != nullptr ? dry->kinetic : 0)});
        found.push_back({analysis::Follows::theta,
                         changes->rightCols(analysis::theta_torques),
                         {},
                         analysis::plausible_spring(own.spring.none() ? own.stiffness * (*high - *low) / 4 : 0)});
    }

    /// Pushes M plus the added torque.
    void push_excitation() {
        options_.push("M");
        if (!added_) return;
        const auto push_sum = [this] {
            model::Excitation M = added_->torque;
            if (!lua_isnil(L_, -1)) M = to_excitation(L_, -1, "identify: M", "M") + M;
            lua_pop(L_, 1);
            lua::push<model::Excitation>(L_, M);
        };
        if (!system_.named) return push_sum();
        const int old = lua_gettop(L_);
        lua_newtable(L_);
        for (lua_pushnil(L_); lua_istable(L_, old) && lua_next(L_, old) != 0;) {
            lua_pushvalue(L_, -2);
            lua_insert(L_, -2);
            lua_settable(L_, old + 1);
        }
        lua_settop(L_, old + 1);
        const char* name = system_.joints[added_->joint].name.c_str();
        lua_getfield(L_, -1, name);
        push_sum();
        lua_setfield(L_, -2, name);
        lua_remove(L_, old);
    }

    void push_options(const Eigen::VectorXd& p, std::size_t rows) {
        lua_createtable(L_, 0, 8);
        push_excitation();
        lua_setfield(L_, -2, "M");
        for (const char* name : {"belt", "base", "states"}) {
            options_.push(name);
            lua_setfield(L_, -2, name);
        }
        for (const auto& [option, known] : {std::pair("theta0", &theta0_), std::pair("velocity0", &velocity0_)}) {
            std::map<std::string, double> values;
            for (std::size_t i = 0; i < system_.bodies.size(); ++i) {
                const auto value = fitted(p, before_names(system_, i) + option);
                values[system_.bodies[i].name] = value.value_or((*known)[i].value_or(0));
            }
            system_.named ? lua::set_value(L_, option, values) : lua::set_value(L_, option, values.begin()->second);
        }
        lua::set_value(L_, "t_start", t_.front());
        lua::push_vector(L_, {t_.begin(), t_.begin() + static_cast<std::ptrdiff_t>(rows)});
        lua_setfield(L_, -2, "times");
    }

    /// The parameter of this name if it is fitted.
    std::optional<double> fitted(const Eigen::VectorXd& p, std::string_view name) const {
        for (std::size_t i = 0; i < free_.size(); ++i) {
            if (free_[i].name == name) return p[static_cast<Eigen::Index>(i)];
        }
        return {};
    }

    /// The measured quantities of the run on the top of the stack, as one vector.
    std::optional<Eigen::VectorXd> stacked(const Eigen::VectorXd& p, std::size_t rows) {
        std::vector<double> all;
        std::vector<std::vector<double>> columns;
        for (const MeasuredColumn& column : columns_) {
            lua_getfield(L_, -1, column.name.c_str());
            const auto* vector = lua::test<lua::Vector>(L_, -1);
            if (vector == nullptr) options_.fail(text::error("the runs of this system have no {}", column.name));
            std::vector<double>& numbers = columns.emplace_back(vector->begin(), vector->end());
            lua_pop(L_, 1);
            if (column.quantity != Measure::theta) continue;
            const auto offset = fitted(p, before_names(system_, column.joint) + "offset");
            for (double& theta : numbers) theta += offset.value_or(offset_[column.joint].value_or(0));
        }
        for (std::size_t i = 0; i < rows; ++i) {
            for (std::size_t j = 0; j < columns_.size(); ++j) {
                if (!std::isnan(columns_[j].numbers[i])) all.push_back(columns[j][i] / columns_[j].size);
            }
        }
        Eigen::VectorXd stacked = Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
        return stacked.allFinite() ? std::optional(std::move(stacked)) : std::nullopt;
    }

    /// Restores the user's tables.
    void restore() {
        for (const Fitted& one : free_) {
            if (one.table > 0) set_number(one, one.start);
        }
    }

    void answer(const analysis::GeneralFit& found, FitAnswer& fit) {
        model::System system = with(found.value);
        restore();
        fit.system = system;
        for (std::size_t i = 0; i < free_.size(); ++i) {
            const auto place = static_cast<Eigen::Index>(i);
            double value = found.value[place];  // rounding may make the fitted Re smaller than Rd
            for (std::size_t j = 0; j < system.joints.size(); ++j) {
                change_numbers(system, j, [&](const std::string& name, const double& number, Sign /*sign*/) {
                    if (name == free_[i].name) value = number;
                    return false;
                });
            }
            fit.values.emplace_back(free_[i].name, value);
            const bool is_silent = found.silent[i], is_known = !found.is_wrong() || found.misfit->leaves_errors();
            const auto told = [&](double error) { return is_silent ? 0 : is_known ? error : withheld; };
            fit.errors.emplace_back(free_[i].name, told(found.error[place]));
            fit.errors_if_right.emplace_back(free_[i].name, found.is_wrong() ? withheld : told(found.if_right[place]));
            if (is_silent) add_bounds(free_[i], value, found, place, fit);
        }
        if (found.is_wrong()) {
            fit.found.misfit = found.misfit->follows;
            fit.found.noise_without_misfit = std::min(found.misfit->noise, 1.0) * columns_.front().size;
            fit.found.has_errors = found.misfit->leaves_errors();
        }
        const MeasuredColumn& first = columns_.front();
        Eigen::Index next = 0;
        for (std::size_t row = 0; row < t_.size(); ++row) {
            if (!std::isnan(first.numbers[row])) {  // the first number of its row
                fit.question.t.push_back(t_[row]);
                fit.question.theta.push_back(first.numbers[row]);
                fit.found.predicted.push_back(found.predicted[next] * first.size);
            }
            next = known_until_[row];
        }
        fit.found.noise = found.noise * first.size;
        constexpr double rounding = 1e-7;
        if (fit.found.noise > rounding * first.range) fit.found.widening = found.widening;
        fit.found.noise_is_uneven = found.noise_is_uneven;
    }

    /// Sets bounds of two standard errors. A parameter that does not affect the motion is only bounded by its least
    /// value.
    void add_bounds(const Fitted& one, double value, const analysis::GeneralFit& found, Eigen::Index place,
                    FitAnswer& fit) {
        const double error = found.open[static_cast<std::size_t>(place)] ? INFINITY : 2 * found.error[place];
        double low = value - error;
        const std::string before = body_of_value(fit, one.name);
        for (std::size_t j = 0; one.name == before + "Re" && j < fit.system->joints.size(); ++j) {
            change_numbers(*fit.system, j, [&](const std::string& name, const double& number, Sign /*sign*/) {
                if (name == before + "Rd") low = std::max(low, number);  // Rd may also be given
                return false;
            });
        }
        fit.silent.push_back({one.name, {std::max(low, one.least == -1e300 ? low : 0.0), value + error}});
    }

    lua_State* L_;
    const lua::Options& options_;
    const IdentifyOptions& asked_;
    const Data& record_;
    model::System system_;
    std::vector<Fitted> free_;
    std::vector<MeasuredColumn> columns_;
    std::vector<double> t_;
    std::vector<double> time_of_;                                     ///< time of each measured value
    std::vector<int> column_of_;                                      ///< column of each measured value
    std::vector<Eigen::Index> known_until_;                           ///< number of measured values up to each row
    std::vector<std::optional<double>> theta0_, velocity0_, offset_;  ///< given values, by body or link
    double swing_ = 1, time_ = 1, angle_ = 1, speed_ = 1;
    std::optional<Added> added_;  ///< torques added to M
    std::string failure_;         ///< error of the last run
};

// The result.

void name_values(FitAnswer& fit) {
    const analysis::Identified& found = fit.found;
    const auto add = [&fit](std::string_view name, double value, double error, double if_right) {
        fit.values.emplace_back(name, value);
        const auto told = [&](double known) {
            const double least = 1e-15 * std::fabs(value);  // a few ulps
            return !(known > 0) ? 0 : fit.found.has_errors ? std::max(known, least) : withheld;
        };
        fit.errors.emplace_back(name, told(error));
        fit.errors_if_right.emplace_back(name, fit.found.misfit.empty() ? told(if_right) : withheld);
    };
    const bool absolute = fit.question.M || fit.question.given.I || fit.question.given.k;
    if (!absolute) fit.units.M.clear();
    add("omega0", found.omega0.value, found.omega0.error, found.omega0.if_right);
    add("zeta", found.zeta.value, found.zeta.error, found.zeta.if_right);
    add("Rd_over_k", found.Rd_over_k.value, found.Rd_over_k.error, found.Rd_over_k.if_right);
    for (const Unknown which : analysis::all_unknowns) {
        if (!absolute && which < Unknown::theta0) continue;
        add(analysis::name(which), at(found.value, which), at(found.error, which), at(found.if_right, which));
    }
    if (absolute && found.is_noise) {
        for (const char* name : {"omega0", "zeta", "Rd_over_k"}) fit.silent.push_back({name, {0, INFINITY}});
    }
    const double k = found.value.k;
    for (const Unknown which : analysis::all_unknowns) {
        if (!at(found.silent, which)) continue;
        std::string name(analysis::name(which));
        double low = at(found.low, which), high = at(found.high, which);
        if (!absolute && name == "k") name = "omega0", low = std::sqrt(low), high = std::sqrt(high);
        if (!absolute && name == "C") name = "zeta", low /= 2 * std::sqrt(k), high /= 2 * std::sqrt(k);
        if (!absolute && name == "Rd") name = "Rd_over_k", low /= k, high /= k;
        fit.silent.push_back({name, {low, high}});
    }
    auto system = model::Oscillator::make({.inertia = found.value.I,
                                           .stiffness = k,
                                           .damping = found.value.C,
                                           .kinetic_friction = found.value.Rd,
                                           .breakaway = std::max(found.value.Re, found.value.Rd),
                                           .units = fit.units});
    if (system) fit.system = model::as_system(system.value());
}

int identify_record(lua_State* L) {
    const lua::Options options(L, 1, identify_call);
    IdentifyOptions asked;
    options.fill(asked);
    auto fit = std::make_shared<FitAnswer>();
    const Data record = record_of(L, options);
    fit->units = units_of_record(record);
    if (options.has("system")) {
        AnyFit(L, options, asked, record).fit(*fit);
        fit->from_guess = true;
        lua::push<FitHandle>(L, std::move(fit));
        return 1;
    }
    for (const char* name : {"measured", "belt", "base", "states"}) {
        if (!options.has(name)) continue;
        options.push(name);
        options.fail(name, "{} ({}) needs a guess: system = system{{ ... }} and free", name, lua::describe(L, -1));
    }
    take_record(L, options, asked, record, fit->question);
    if (options.has("M")) {
        options.push("M");
        fit->question.M = to_excitation(L, -1, "identify: M", "M");
        lua_pop(L, 1);
    }
    take_given(L, options, asked, fit->question);
    std::optional<text::Error> wrong;
    auto question = fit->question;
    if (question.M && !question.t.empty()) {
        if (auto terms = terms_alone(L, *question.M, question.t.front(), question.t.back())) question.M = terms;
    }
    call_checked(L, [&](const motion::Monitor& monitor) {
        auto found = analysis::identify(question, monitor);
        if (found) {
            fit->found = std::move(found).value();
        } else {
            wrong = found.error();
        }
    });
    if (wrong) options.fail(*wrong);
    name_values(*fit);
    lua::push<FitHandle>(L, std::move(fit));
    return 1;
}

// ---- the answer

std::vector<std::string> names_of_pairs(const auto& pairs) {
    std::vector<std::string> names;
    for (const auto& pair : pairs) names.push_back(pair.first);
    return names;
}

std::vector<std::string> names_of_fit(const FitAnswer& fit) {
    return names_of_pairs(fit.values);
}

int fit_value(lua_State* L) {
    const FitHandle& fit = lua::self<FitHandle>(L, 1, "fit.omega0");
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const std::string_view name = lua_tostring(L, 2);
    for (const auto& [known, value] : fit->values) {
        if (known != name) continue;
        lua_pushnumber(L, value);
        return 1;
    }
    if (!fit->from_guess && text::contains(analysis::unknown_names, name)) {
        lua::raise(L, {.sentence = fmt::format(
                           "a free decay determines only ratios, so there is no {}: give I or k to identify", name),
                       .culprit = std::string(name)});
    }
    raise_unknown_name(L, fmt::format("a fit has no field '{}'", name), name, names_of_fit(*fit), fit_class);
}

lua::Pushed fit_system(lua_State* L, const FitHandle& fit) {
    fit->system ? static_cast<void>(push_with_numbers(L, *fit->system)) : lua_pushnil(L);
    return {};
}

std::vector<double> residual_of(const FitAnswer& fit) {
    std::vector<double> residual(fit.question.t.size());
    for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = fit.question.theta[i] - fit.found.predicted[i];
    return residual;
}

constexpr text::Call fit_plot_call{"fit:plot", "fit:plot{ file = \"fit.svg\" }", target_options, true};

int fit_plot(lua_State* L) {
    const FitHandle fit = lua::self<FitHandle>(L, 1, "fit:plot()");
    const lua::Options options(L, 2, fit_plot_call);
    const auto curve = [&fit](std::vector<double> y, const char* label, plots::Style style) {
        plots::Curve made;
        made.x = plots::Numbers::own(fit->question.t);
        made.y = plots::Numbers::own(std::move(y));
        made.label = label;
        made.style = style;
        return made;
    };
    std::vector<plots::Figure> figures(2);
    figures[0].curves = {curve(fit->question.theta, "record", plots::Style::points),
                         curve(fit->found.predicted, "fit", plots::Style::line)};
    figures[1].curves = {curve(residual_of(*fit), "", plots::Style::points)};
    figures[1].title = "record - fit";
    const ColumnUnits in(fit->units);
    for (plots::Figure& figure : figures) {
        figure.x.label = model::name_with_unit("t", in.t);
        if (!in.theta.empty()) figure.y.label = model::name_with_unit("θ", in.theta);
    }
    return deliver(L, options, std::move(figures));
}

/// The unit of a value of this name; empty if unknown.
std::string unit_of_value(const model::Units& units, std::string_view name) {
    if (units.usual()) return "";
    if (name == "omega0") return units.t.empty() ? "" : "rad/" + units.t;
    if (name == "velocity0") return units.speed();
    if (name == "Rd_over_k" || name == "theta0" || name == "offset") return units.theta;
    return name == "I"                    ? units.inertia()
           : name == "k"                  ? units.stiffness()
           : name == "C"                  ? units.damping()
           : name == "Rd" || name == "Re" ? units.M
                                          : "";
}

/// The bounds of a value that the record does not determine.
std::string text_of_bounds(const std::vector<double>& bounds, const std::string& unit) {
    const auto number = [&unit](double x) { return model::with_unit(fmt::format("{:.4g}", x), unit); };
    const double low = bounds[0], high = bounds[1];
    const bool is_bounded = std::isfinite(low) && (low != 0 || std::isfinite(high));
    const std::string known = is_bounded && std::isfinite(high)
                                  ? fmt::format("between {:.4g} and {}, ", low, number(high))
                              : is_bounded          ? fmt::format(">= {}, ", number(low))
                              : std::isfinite(high) ? fmt::format("<= {}, ", number(high))
                                                    : "";
    return known + "not determined by this record";
}

/// Possible causes of a residual that follows velocity, theta or time.
constexpr std::array<const char*, 3> causes{
    "is the law of friction another one, such as friction.stribeck, or a given C or Rd wrong?",
    "is the spring nonlinear, or a given k wrong?", "does the zero of the instrument drift, or a parameter change?"};

/// The sentences about the reliability of the fit.
std::vector<std::string> notes_of_fit(const FitAnswer& fit) {
    std::vector<std::string> notes;
    const analysis::Identified& found = fit.found;
    const double Rd = found.value.Rd, Re = fit.question.given.Re.value_or(Rd);
    if (Re < Rd * (1 - 1e-9) - 3 * found.error.Rd) {  // tolerance for rounding in a record without noise
        notes.push_back(fmt::format(
            "Re = {:.6g} is given, but the fitted Rd is greater: Re cannot be less than Rd, so the fit has Re = "
            "Rd; leave Re out, or give Rd as well",
            Re));
    }
    if (found.is_noise) {
        notes.emplace_back("it fits the record no better than it would fit noise, so there may be no motion in it");
    } else if (!found.misfit.empty()) {
        std::vector<std::string> names, questions;
        for (const analysis::Follows what : found.misfit) {
            const auto i = static_cast<std::size_t>(what);
            names.push_back(what == analysis::Follows::theta ? "theta"
                                                             : fmt::format("the {}", analysis::follows_names[i]));
            questions.emplace_back(causes[i]);
        }
        notes.push_back(fmt::format("the residual is {:.2g} times the noise and follows {}: {}",
                                    found.noise / found.noise_without_misfit, fmt::join(names, " or "),
                                    fmt::join(questions, " Or ")));
    } else if (found.is_unexplained) {
        notes.push_back(fmt::format(
            "neighbouring samples scatter by {:.3g} only, so the residual is not noise: another kind of system "
            "made this record, a given value is wrong, or the best fit was not found",
            found.scatter));
        if (const auto wild = found.wild) {
            notes.back() += fmt::format("; sample {} at t = {:.6g} causes more than half of it: is it an outlier?",
                                        *wild + 1, fit.question.t[*wild]);
        }
    }
    if (!found.has_errors && !found.is_noise) {
        notes.emplace_back("standard errors are left out: they hold only if the model is right");
    } else if (!found.misfit.empty()) {
        notes.emplace_back("the errors include how far this moves the values");
    }
    constexpr double alike = 1.3;
    if (found.widening > alike && found.has_errors && !found.is_noise) {
        notes.push_back(fmt::format(
            "the residual is correlated from sample to sample (noise with a memory or in M, another law of friction "
            "or a wrong guess); the errors are {:.2g} times wider because of that",
            found.widening));
    }
    if (found.noise_is_uneven && found.has_errors && !found.is_noise) {
        notes.emplace_back("the noise is stronger in some parts of the record than in others; the errors include that");
    }
    if (found.M_is_noisy) notes.emplace_back("the errors ignore the noise of M: they may be far too small");
    if (fit.question.given.offset == 0.0) notes.emplace_back("offset is held at 0");
    if (const std::size_t cut = found.cut_low + found.cut_high; cut > 0) {
        notes.push_back(
            fmt::format("{} samples have the extreme values of the record, as if it were clipped there", cut));
    }
    return notes;
}

std::string fit_summary(const FitAnswer& fit) {
    std::string text = fmt::format("fit of {} samples, {:.3g} of noise:", fit.question.t.size(), fit.found.noise);
    std::size_t width = 10;
    for (const auto& value : fit.values) width = std::max(width, value.first.size());
    auto unlisted = fit.silent;
    bool is_wider = false;
    for (std::size_t i = 0; i < fit.values.size(); ++i) {
        const auto& [name, value] = fit.values[i];
        const double error = fit.errors[i].second;
        const std::string unit = unit_of_value(fit.units, name.substr(body_of_value(fit, name).size()));
        const auto silent =
            std::ranges::find_if(unlisted, [&known = name](const auto& one) { return one.first == known; });
        if (silent != unlisted.end()) {
            text += fmt::format("\n  {:<{}} {}", name, width, text_of_bounds(silent->second, unit));
            unlisted.erase(silent);
            continue;
        }
        text += fmt::format("\n  {:<{}} {:<12.6g}", name, width, value);
        text += error > 0 ? fmt::format(" +- {:.2g}", error) : "";
        text.erase(text.find_last_not_of(' ') + 1);
        text = model::with_unit(std::move(text), unit);
        constexpr double much = 1.5;
        if (const double if_right = fit.errors_if_right[i].second; error > much * if_right && if_right > 0) {
            text += fmt::format(" ({:.2g} if the model is right)", if_right);
            is_wider = true;
        }
    }
    const double k = fit.found.value.k;
    for (const auto& [name, bounds] : unlisted) {
        if (name == "Re" && !fit.found.is_noise) {  // a free decay with I = 1 determines only the ratio
            const std::vector<double> ratios{bounds[0] / k, bounds[1] / k};
            text += fmt::format("\n  {:<{}} {}", "Re_over_k", width,
                                text_of_bounds(ratios, unit_of_value(fit.units, "Rd_over_k")));
        } else {
            text += fmt::format("\n  the record says nothing about {}", name);
        }
    }
    if (is_wider) {
        text +=
            "\n  the wider errors allow for friction that falls with the speed and a bent spring, unseen in this record";
    }
    for (const std::string& note : notes_of_fit(fit)) text += "\n  " + note;
    return text;
}

std::vector<std::string> silent_names(const FitAnswer& fit) {
    return names_of_pairs(fit.silent);
}

/// The errors that are not withheld, of values that the record determines.
std::vector<std::pair<std::string, double>> known_errors(const FitAnswer& fit,
                                                         std::vector<std::pair<std::string, double>> errors) {
    std::erase_if(errors, [&fit](const auto& error) {
        return std::isnan(error.second) ||
               std::ranges::any_of(fit.silent, [&error](const auto& one) { return one.first == error.first; });
    });
    return errors;
}

/// The quantity that the residual depends on; none if it looks like noise.
std::optional<std::string> misfit_of_fit(const FitAnswer& fit) {
    if (fit.found.is_noise) return {};
    const auto& misfit = fit.found.misfit;
    if (!misfit.empty()) return std::string(analysis::follows_names[static_cast<std::size_t>(misfit.front())]);
    return fit.found.is_unexplained ? std::optional<std::string>("something else") : std::nullopt;
}

#define DINAL_FIT                                               \
    "sys = system{ I = 1, k = 40, C = 0.3, Rd = 0.8 }\n"        \
    "run = sys:simulate{ theta0 = 1, t_end = 8, dt = 0.02 }\n"  \
    "noise = vector.normal{ n = #run, seed = 1, std = 0.01 }\n" \
    "fit = identify{ data = { t = run.t, theta = run.theta + noise }, velocity0 = 0 }\n"

constexpr lua::Member fit_members[] = {
    {lua::a_value<FitHandle, names_of_fit>,
     {"fit.names -> table", "The names of the values that it has.",
      DINAL_FIT "print(fit.names[1], fit[fit.names[1]] == fit.omega0)  --> omega0\ttrue"}},
    {lua::a_value<FitHandle, [](const FitAnswer& fit) { return known_errors(fit, fit.errors); }>,
     {"fit.std_error -> table",
      "The standard errors by name: the truth lies within two of them in 19 of 20 records. Given values have 0. They include "
      "how far values would be off if friction fell with the speed or the spring were nonlinear, as likely as the record leaves "
      "that, and what a residual that hints at it or at a drifting zero tells. "
      "They are nil if the model is so wrong that they would mean nothing (fit.misfit), and of the names in fit.silent. "
      "What no record shows they do not contain: friction that falls evenly with the speed looks like more Rd and less C.",
      DINAL_FIT "print(math.abs(fit.omega0 - sys.omega0) < 3 * fit.std_error.omega0)  --> true"}},
    {lua::a_value<FitHandle, [](const FitAnswer& fit) { return known_errors(fit, fit.errors_if_right); }>,
     {"fit.error_if_right -> table",
      "The standard errors if the model is right: constant friction, a linear spring, a zero that does not drift. They are "
      "nil if the residual shows that the model is wrong (fit.misfit).",
      DINAL_FIT "print(fit.error_if_right.zeta < fit.std_error.zeta)  --> true"}},
    {lua::a_value<FitHandle, silent_names>,
     {"fit.silent -> table",
      "The names of values that the record does not determine: Re of a free decay or of a motion without stops; "
      "Rd_over_k, theta0 and offset of a decay in one direction, which determines only their sums. The values "
      "given are possible ones; fit.bounds has their bounds.",
      DINAL_FIT "print(table.concat(fit.silent, \" \"))  --> Re"}},
    {lua::a_value<FitHandle, &FitAnswer::silent>,
     {"fit.bounds -> table",
      "Of each name in fit.silent the least and the greatest value that fit about as well, without an end -math.huge or "
      "math.huge. Re of a free decay must hold the mass where it rests and let it pass the turn before.",
      DINAL_FIT "low, high = table.unpack(fit.bounds.Re)\nprint(low < 0.9, high > 0.8)  --> true\ttrue"}},
    {lua::a_value<FitHandle, misfit_of_fit>,
     {"fit.misfit -> string or nil",
      "\"velocity\", \"theta\" or \"time\": the residual is not noise but follows this, so the model is wrong. Another law "
      "of friction follows the velocity, a nonlinear spring theta, a drifting zero the time. \"something else\" if the "
      "residual is far above the noise and follows none of them. Otherwise nil.",
      "bent = system{ I = 1, k = 4, C = 0.1, Rd = 0.1, spring = spring.polynomial{ [3] = 2 } }\n"
      "run = bent:simulate{ theta0 = 1, t_end = 20, dt = 0.05 }\n"
      "noise = vector.normal{ n = #run, seed = 1, std = 0.003 }\n"
      "fit = identify{ data = { t = run.t, theta = run.theta + noise } }\n"
      "print(fit.misfit, fit.std_error.zeta)  --> theta\tnil"}},
    {lua::a_value<FitHandle, notes_of_fit>,
     {"fit.notes -> table",
      "What tostring says about how far the fit can be believed: a list of sentences, empty if there is nothing to say.",
      DINAL_FIT "print(#fit.notes)  --> 0"}},
    {lua::a_value<FitHandle, fit_system>,
     {"fit.system -> system", "The fitted system; for a free decay without I and k, with I = 1.",
      DINAL_FIT "print(fit.system.I, math.abs(fit.system.k - 40) < 0.2)  --> 1.0\ttrue"}},
    {lua::a_value<FitHandle, [](const FitAnswer& fit) { return fit.found.noise; }>,
     {"fit.noise -> number", "The standard deviation of record minus fit.",
      DINAL_FIT "print(math.abs(fit.noise - 0.01) < 0.001)  --> true"}},
    {lua::a_value<FitHandle, [](const FitAnswer& fit) { return lua::Vector(residual_of(fit)); }>,
     {"fit.residual -> vector",
      "Record minus fit at each sample. It should look like noise. If several columns are measured, it is that of an angle if "
      "there is one, else of a velocity.",
      DINAL_FIT "print(#fit.residual == #run)  --> true"}},
    {lua::a_method<fit_plot>,
     {"fit:plot{ OPTIONS }",
      "Plots the record with the fit, and the residual.",
      DINAL_FIT "print(#tostring(fit:plot{ show = false }) > 500)  --> true",
      {&fit_plot_call}}},
    {lua::a_text<FitHandle, fit_summary>,
     {"tostring(fit) -> string",
      "All values with their standard errors, and a sentence where the fit does not explain the record.",
      DINAL_FIT "print(tostring(fit):match(\"^[^,]*\"))  --> fit of 401 samples"}},
};

#undef DINAL_FIT

std::string fit_card(lua_State* L, int index, const terminal::Display&) {
    return fit_summary(**lua::test<FitHandle>(L, index));
}

constexpr lua::Member identify_members[] = {
    {lua::a_function<identify_record>,
     {"identify{ OPTIONS } -> fit",
      "Finds the system that made a record. A free decay (no M) gives omega0, zeta, Rd_over_k and the start; with "
      "I or k also the others. With a known M it gives I, k, C, Rd, Re and the start. Given values are not "
      "fitted.\nWith system, a guess, and free it fits any numbers of any system, and of tables that M "
      "uses, to measured angles, velocities or accelerations, also on a belt, on a shaking base or with states: "
      "fit[\"friction.speed\"], or of several bodies and links fit[\"load.Rd\"]. Correlated residuals widen the errors, and "
      "the fit reports that.",
      "run = system{ I = 1, k = 40, C = 0.3, Rd = 0.8 }:simulate{ theta0 = 1, t_end = 8, dt = 0.02 }\n"
      "fit = identify{ data = run, I = 1 }\n"
      "print(string.format(\"%.4f %.4f %.4f\", fit.k, fit.C, fit.Rd))  --> 40.0000 0.3000 0.8000",
      {&identify_call}}},
};

}  // namespace

const lua::Class identify_functions = {
    "identify",
    {"identify{ ... } -> fit", "Finds the system behind a record.",
     "rig = system{ bodies = { motor = { I = 1 }, load = { I = 2, Rd = 0.4 } },\n"
     "    links = { shaft = { \"motor\", \"load\", k = 6 } } }\n"
     "run = rig:simulate{ velocity0 = { motor = 3 }, t_end = 10, dt = 0.05 }\n"
     "guess = rig:with{ bodies = { load = { Rd = 0.5 } }, links = { shaft = { k = 5 } } }\n"
     "fit = identify{ data = run, system = guess, free = { \"load.Rd\", \"shaft.k\" }, measured = { \"load.theta\" } }\n"
     "print(string.format(\"%.4f %.4f\", fit[\"load.Rd\"], fit[\"shaft.k\"]))  --> 0.4000 6.0000"},
    identify_members,
    lua::add_functions};

const lua::Class fit_class = {
    "fit",
    {"identify{ ... } -> fit",
     "The result of identify: fit.omega0, fit.zeta, fit.Rd_over_k, fit.theta0, fit.velocity0, fit.offset, and "
     "fit.I, fit.k, fit.C, fit.Rd, fit.Re where the record tells them.",
     "run = nondimensional{ friction_ratio = 0.05 }:simulate{ theta0 = 1, t_end = 6, dt = 0.05 }\n"
     "print(string.format(\"%.4f\", identify{ data = run }.Rd_over_k))  --> 0.0500"},
    fit_members,
    lua::add_class<FitHandle>,
    lua::guarded<fit_value>,
    fit_card};

}  // namespace dinal::api
