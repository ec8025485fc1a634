// identify{ system = ..., free = { ... } }: parameters of any system, and of tables that a user's functions read,
// fitted from a guess to measured angles, velocities or accelerations.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "analysis/general_fit.hpp"
#include "analysis/turning_points.hpp"
#include "api/identify_options.hpp"
#include "api/run.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/user_function.hpp"
#include "lua/vector.hpp"
#include "model/controller.hpp"
#include "model/laws/asymmetric.hpp"
#include "model/laws/bristle.hpp"
#include "model/laws/stribeck.hpp"
#include "model/springs/polynomial_spring.hpp"

namespace dinal::api {
namespace {

/// A number of a system: where it stands in a copy, and its range.
struct NumberPlace {
    double* value = nullptr;
    bool positive = false, may_be_negative = false;
};

/// The number of that name in a law; none when it has none.
template <class Law>
bool with_number(model::Friction& friction, std::span<const text::Option> rows, std::string_view name,
                 const std::function<void(NumberPlace)>& change) {
    const Law* law = friction.as<Law>();
    if (law == nullptr) return false;
    for (const text::Option& row : rows) {
        if (row.name != name) continue;
        Law changed = *law;
        const text::OptionValue now = row.filled.get(&changed);
        if (!std::holds_alternative<double>(now)) return false;
        double number = std::get<double>(now);
        change({&number, row.range.must == text::positive.must, false});
        row.filled.set(&changed, number);
        friction = changed;
        return true;
    }
    return false;
}

bool with_number_of_law(model::Friction& friction, std::string_view name,
                        const std::function<void(NumberPlace)>& change) {
    using namespace model::laws;
    if (const auto* law = friction.as<AsymmetricCoulomb>()) {
        AsymmetricCoulomb changed = *law;
        for (const auto& [way, own] :
             {std::pair{"forward.", &changed.forward}, std::pair{"backward.", &changed.backward}}) {
            if (name == std::string(way) + "Rd") return change({&own->kinetic}), friction = changed, true;
            if (name == std::string(way) + "Re") return change({&own->breakaway}), friction = changed, true;
        }
        return false;
    }
    const auto* bristle = friction.as<Bristle>();
    return with_number<Stribeck>(friction, stribeck_options, name, change) ||
           with_number<Bristle>(
               friction,
               bristle != nullptr && bristle->dahl ? std::span<const text::Option>(dahl_options) : lugre_options, name,
               change);
}

/// The system whose numbers are changed: one mass, or a system of one body whose friction has more to it.
struct Guess {
    std::optional<model::OscillatorParameters> plain = {};
    std::optional<model::Assembly> rig = {};

    /// Calls with the number of that name; false when there is none.
    bool with(std::string_view name, const std::function<void(NumberPlace)>& change) {
        constexpr std::string_view of_law = "friction.", of_spring = "spring.", of_walls = "walls.";
        model::Joint* joint = rig ? rig->joints.data() : nullptr;
        if (name == "I") return change({plain ? &plain->inertia : &rig->bodies[0].inertia, true}), true;
        if (name == "k") return change({plain ? &plain->stiffness : &joint->stiffness}), true;
        if (name == "C") return change({plain ? &plain->damping : &joint->damping}), true;
        if (name.starts_with(of_law)) {
            if (plain && !plain->friction) return false;
            model::Friction& law = plain ? *plain->friction : joint->friction.law;
            return with_number_of_law(law, name.substr(of_law.size()), change);
        }
        if (name.starts_with(of_spring)) {
            model::Spring& spring = plain ? plain->spring : joint->spring;
            const auto* polynomial = spring.as<model::springs::PolynomialSpring>();
            if (polynomial == nullptr) return false;
            model::springs::PolynomialSpring changed = *polynomial;
            for (auto& [power, coefficient] : changed.terms) {
                if (std::to_string(power) != name.substr(of_spring.size())) continue;
                change({&coefficient, false, true});
                spring = changed;
                return true;
            }
            return false;
        }
        if (name.starts_with(of_walls) && (plain ? plain->walls : joint->walls)) {
            model::Walls& walls = plain ? *plain->walls : *joint->walls;
            if (name == "walls.lower") return change({&walls.lower, false, true}), true;
            if (name == "walls.upper") return change({&walls.upper, false, true}), true;
            if (name == "walls.restitution") return change({&walls.restitution}), true;
        }
        if (!plain || plain->friction) return false;
        if (name == "Rd") return change({&plain->kinetic_friction}), true;
        if (name == "Re") {
            double Re = plain->breakaway.value_or(plain->kinetic_friction);
            change({&Re});
            plain->breakaway = Re;
            return true;
        }
        return false;
    }
};

/// What is fitted.
struct Fitted {
    enum class Of { system, table, theta0, velocity0, offset };
    std::string name;
    Of of = Of::system;
    int table = 0;         ///< its place on the stack
    std::string key = {};  ///< in it
    double start = 0, typical = 0, least = -1e300;
};

enum class Measure { theta, velocity, acceleration };
constexpr const char* measure_names[] = {"theta", "velocity", "acceleration"};
struct MeasuredColumn {
    Measure quantity;
    std::vector<double> numbers;
    double size = 1;  ///< in whose units it is fitted: its noise, or a small part of its range
};

class AnyFit {
public:
    AnyFit(lua_State* L, const lua::Options& options, const IdentifyOptions& asked)
        : L_(L), options_(options), asked_(asked) {
        luaL_checkstack(L, 200, "for a fit");
        take_system();
        take_columns();
        take_free();
    }

    FittedParts found() {
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
            const bool number = one.of == Fitted::Of::system || one.of == Fitted::Of::table;
            question.may_be_doubled.push_back(number && one.start != 0);
        }
        std::vector<double> all;
        for (std::size_t row = 0; row < t_.size(); ++row) {
            for (std::size_t j = 0; j < columns_.size(); ++j) {
                if (std::isnan(columns_[j].numbers[row])) continue;
                all.push_back(columns_[j].numbers[row] / columns_[j].size);
                question.columns.push_back(static_cast<int>(j));
            }
            known_until_.push_back(static_cast<Eigen::Index>(all.size()));
        }
        if (all.size() < free_.size() + 4) {
            options_.fail({fmt::format("{} numbers are too few to fit {} parameters", all.size(), free_.size())});
        }
        question.measured = Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
        constexpr double first = 2.2;
        double length = first * swing_;
        while (t_.front() + length < t_.back()) {
            const auto rows = std::upper_bound(t_.begin(), t_.end(), t_.front() + length) - t_.begin();
            const Eigen::Index count = known_until_[static_cast<std::size_t>(rows) - 1];
            if (count > n + 4) question.stages.push_back(count);
            length *= 2;
        }
        question.model = [this](const Eigen::VectorXd& p, Eigen::Index count) { return predicted(p, count); };
        const auto found = analysis::general_fit(question);
        restore();
        if (!found) {
            options_.fail({failure_.empty() ? "no run of this system reaches the end of the record" : failure_});
        }
        return answer(*found);
    }

private:
    void take_system() {
        options_.push("system");
        if (const auto* plain = lua::test<model::Oscillator>(L_, -1)) {
            guess_.plain = plain->parameters();
        } else if (const auto* rig = lua::test<model::AssemblyHandle>(L_, -1); rig != nullptr && !(*rig)->named) {
            guess_.rig = **rig;
        } else {
            options_.wrong("system", options_.row("system").wanted);
        }
        lua_pop(L_, 1);
        for (const char* name : {"I", "k", "C", "Rd", "Re"}) {
            if (options_.has(name))
                options_.fail(name, fmt::format("{} is part of the first guess, system = ...", name));
        }
    }

    /// The quantities and the names of their columns: "velocity", { "theta", "velocity" } or { theta = "x" }.
    std::vector<std::pair<Measure, std::string>> asked_columns() {
        std::vector<std::pair<Measure, std::string>> asked;
        const auto add = [&](const std::string& quantity, const std::string& column) {
            const auto* known = std::find(std::begin(measure_names), std::end(measure_names), quantity);
            if (known == std::end(measure_names)) options_.wrong("measured", options_.row("measured").wanted);
            asked.emplace_back(static_cast<Measure>(known - std::begin(measure_names)), column);
        };
        options_.push("measured");
        if (lua_isnil(L_, -1)) {
            add("theta", asked_.theta.value_or("theta"));
        } else if (lua_type(L_, -1) == LUA_TSTRING) {
            add(lua_tostring(L_, -1), lua_tostring(L_, -1));
        } else if (lua_istable(L_, -1)) {
            for (lua_pushnil(L_); lua_next(L_, -2) != 0; lua_pop(L_, 1)) {
                if (lua_type(L_, -1) != LUA_TSTRING) options_.wrong("measured", options_.row("measured").wanted);
                add(lua_type(L_, -2) == LUA_TSTRING ? lua_tostring(L_, -2) : lua_tostring(L_, -1),
                    lua_tostring(L_, -1));
            }
        } else {
            options_.wrong("measured", options_.row("measured").wanted);
        }
        lua_pop(L_, 1);
        std::sort(asked.begin(), asked.end());
        return asked;
    }

    void take_columns() {
        std::vector<double> t = record_numbers(L_, options_, asked_.t.value_or("t"), "t");
        for (auto& [quantity, name] : asked_columns()) {
            columns_.push_back({quantity, record_numbers(L_, options_, name, "measured")});
            if (columns_.back().numbers.size() != t.size()) {
                options_.fail({fmt::format("the record has {} times, but {} numbers in the column '{}'", t.size(),
                                           columns_.back().numbers.size(), name)});
            }
        }
        std::vector<std::size_t> rows;
        for (std::size_t i = 0; i < t.size(); ++i) {
            const bool known = std::any_of(columns_.begin(), columns_.end(), [i](const MeasuredColumn& column) {
                return !std::isnan(column.numbers[i]);
            });
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
            const auto [low, high] = std::minmax_element(known.begin(), known.end());
            if (!(*high > *low)) options_.fail({"a measured column is constant: there is no motion in it"});
            column.size = std::max(analysis::noise_of(known), 1e-6 * (*high - *low));
            range_[static_cast<std::size_t>(column.quantity)] = *high - *low;
        }
        for (std::size_t i = 0; i + 1 < t_.size(); ++i) {
            if (!(t_[i] < t_[i + 1])) {
                options_.fail(
                    {fmt::format("times must increase, but t = {:.6g} is followed by {:.6g}", t_[i], t_[i + 1])});
            }
        }
    }

    /// How far things are from each other in this record, for parameters that begin at 0.
    void take_scales() {
        double I = 1, k = 0;
        guess_.with("I", [&](NumberPlace place) { I = *place.value; });
        guess_.with("k", [&](NumberPlace place) { k = *place.value; });
        constexpr double swings = 10;
        const double span = t_.back() - t_.front();
        swing_ = k > 0 ? 2 * std::numbers::pi * std::sqrt(I / k) : span / swings;
        const double time = swing_ / (2 * std::numbers::pi);
        angle_ = range_[0] > 0 ? range_[0] : range_[1] > 0 ? range_[1] * time : range_[2] * time * time;
        speed_ = range_[1] > 0 ? range_[1] : angle_ / time;
        torque_ = I * speed_ / time;
    }

    void take_free() {
        take_scales();
        options_.push("free");
        if (!lua_istable(L_, -1) || lua_rawlen(L_, -1) == 0) options_.wrong("free", options_.row("free").wanted);
        const int list = lua_gettop(L_);
        for (lua_Integer i = 1; i <= static_cast<lua_Integer>(lua_rawlen(L_, list)); ++i) {
            lua_rawgeti(L_, list, i);
            const std::string name = lua_type(L_, -1) == LUA_TSTRING ? lua_tostring(L_, -1) : lua::describe(L_, -1);
            lua_pop(L_, 1);
            add_free(name);
        }
        const MeasuredColumn& first = columns_.front();
        const double begins = std::isnan(first.numbers[0]) ? 0 : first.numbers[0];
        const bool rolls = [&] {
            double k = 0;
            guess_.with("k", [&](NumberPlace place) { k = *place.value; });
            return k == 0;
        }();
        initial_ = {asked_.theta0.value_or(0), asked_.velocity0.value_or(0)};
        // Without a spring no velocity depends on where it began.
        const bool place_counts = first.quantity == Measure::theta || !rolls;
        if (!asked_.theta0 && place_counts) {
            free_.push_back(
                {"theta0", Fitted::Of::theta0, 0, "", first.quantity == Measure::theta ? begins : 0, 0.1 * angle_});
        }
        if (!asked_.velocity0) {
            free_.push_back({"velocity0", Fitted::Of::velocity0, 0, "", first_velocity(), 0.1 * speed_});
        }
    }

    double first_velocity() const {
        for (const MeasuredColumn& column : columns_) {
            if (column.quantity == Measure::velocity && !std::isnan(column.numbers[0])) return column.numbers[0];
        }
        const MeasuredColumn& column = columns_.front();
        const std::size_t last = std::min<std::size_t>(4, t_.size() - 1);
        const double rise = column.numbers[last] - column.numbers[0];
        return column.quantity == Measure::theta && std::isfinite(rise) ? rise / (t_[last] - t_[0]) : 0;
    }

    void add_free(const std::string& name) {
        Fitted one{.name = name};
        if (name == "offset") {
            one.of = Fitted::Of::offset, one.typical = 0.1 * angle_;
        } else if (name == "theta0" || name == "velocity0") {
            return;  // fitted unless given
        } else if (!guess_.with(name, [&](NumberPlace place) {
                       one.start = *place.value;
                       one.least = place.may_be_negative ? -1e300 : place.positive ? 1e-6 * one.start : 0;
                       one.typical = name == "C" ? 0.01 * torque_ / speed_ : 0.01 * torque_;
                   })) {
            find_table(name, one);
        }
        one.typical = one.start != 0 ? std::fabs(one.start) : one.typical;
        free_.push_back(std::move(one));
    }

    /// "p.Kp": the variable p of a function of M, belt, base or a state's rate, or the global p.
    void find_table(const std::string& name, Fitted& one) {
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
        one.of = Fitted::Of::table;
        one.table = lua_gettop(L_);
        one.key = dot == std::string::npos ? "" : name.substr(dot + 1);
        if (found && push_field(one) == LUA_TNUMBER) {
            one.start = lua_tonumber(L_, -1);
            one.typical = 1;
            lua_pop(L_, 1);
            return;
        }
        options_.fail({.sentence = fmt::format("free has '{}', which is no number of the system, such as k or "
                                               "friction.speed, and none of a table that M uses, such as p.Kp",
                                               name),
                       .option = "free",
                       .culprit = name});
    }

    /// Without metamethods: a library has names that it refuses.
    int push_field(const Fitted& one) {
        lua_pushstring(L_, one.key.c_str());
        return lua_rawget(L_, one.table);
    }

    /// Pushes the table that functions in the value on the top of the stack know by this name.
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

    /// Sets the tables, and gives the system; none where there is no such system.
    std::optional<Guess> with(const Eigen::VectorXd& p) {
        Guess guess = guess_;
        const bool own_Re = std::any_of(free_.begin(), free_.end(), [](const Fitted& one) { return one.name == "Re"; });
        for (std::size_t i = 0; i < free_.size(); ++i) {
            const double value = p[static_cast<Eigen::Index>(i)];
            if (free_[i].of == Fitted::Of::system) {
                guess.with(free_[i].name, [value](NumberPlace place) { *place.value = value; });
            } else if (free_[i].of == Fitted::Of::table) {
                lua_pushnumber(L_, value);
                lua_setfield(L_, free_[i].table, free_[i].key.c_str());
            }
        }
        if (guess.plain && !guess.plain->friction) {
            const auto& old = *guess_.plain;
            const bool one_number = !own_Re && old.breakaway.value_or(old.kinetic_friction) == old.kinetic_friction;
            const double Rd = guess.plain->kinetic_friction;
            guess.plain->breakaway = one_number ? Rd : std::max(Rd, guess.plain->breakaway.value_or(Rd));
        }
        // Breakaway takes at least the friction of motion.
        for (const char* way : {"", "forward.", "backward."}) {
            double Rd = 0;
            guess.with(fmt::format("friction.{}Rd", way), [&](NumberPlace place) { Rd = *place.value; });
            guess.with(fmt::format("friction.{}Re", way),
                       [&](NumberPlace place) { *place.value = std::max(*place.value, Rd); });
        }
        return guess;
    }

    bool push_system(const Guess& guess) {
        if (guess.plain) {
            auto made = model::Oscillator::make(*guess.plain);
            if (!made) return failure_ = made.error().sentence, false;
            lua::push(L_, std::move(made).value());
        } else {
            if (auto wrong = guess.rig->joints[0].friction.law.complaint()) return failure_ = wrong->sentence, false;
            lua::push<model::AssemblyHandle>(L_, std::make_shared<const model::Assembly>(*guess.rig));
        }
        return true;
    }

    std::optional<Eigen::VectorXd> predicted(const Eigen::VectorXd& p, Eigen::Index count) {
        const int top = lua_gettop(L_);
        const auto guess = with(p);
        const auto rows = static_cast<std::size_t>(std::lower_bound(known_until_.begin(), known_until_.end(), count) -
                                                   known_until_.begin() + 1);
        if (!guess || !push_system(*guess)) return lua_settop(L_, top), std::nullopt;
        lua_getfield(L_, -1, "simulate");
        lua_insert(L_, -2);
        push_options(p, rows);
        const bool good = lua_pcall(L_, 2, 1, 0) == LUA_OK;
        if (!good && lua::interrupt_requested()) lua_error(L_);
        const auto* run = good ? lua::test<RunHandle>(L_, -1) : nullptr;
        std::optional<Eigen::VectorXd> found;
        if (!good) {
            failure_ = lua::text_at(L_, -1);
        } else if (run != nullptr && static_cast<std::size_t>((*run)->trajectory.size()) == rows) {
            found = stacked(*run, p, rows);
        }
        lua_settop(L_, top);
        return found;
    }

    void push_options(const Eigen::VectorXd& p, std::size_t rows) {
        lua_createtable(L_, 0, 8);
        for (const char* name : {"M", "belt", "base", "states"}) {
            options_.push(name);
            lua_setfield(L_, -2, name);
        }
        const auto set = [this](const char* name, double value) {
            lua_pushnumber(L_, value);
            lua_setfield(L_, -2, name);
        };
        set("theta0", value_of(p, Fitted::Of::theta0, initial_.theta));
        set("velocity0", value_of(p, Fitted::Of::velocity0, initial_.velocity));
        set("t_start", t_.front());
        lua::push_vector(L_, {t_.begin(), t_.begin() + static_cast<std::ptrdiff_t>(rows)});
        lua_setfield(L_, -2, "times");
    }

    double value_of(const Eigen::VectorXd& p, Fitted::Of of, double otherwise) const {
        for (std::size_t i = 0; i < free_.size(); ++i) {
            if (free_[i].of == of) return p[static_cast<Eigen::Index>(i)];
        }
        return otherwise;
    }

    /// The measured numbers of a run, which stands on the top of the stack.
    std::optional<Eigen::VectorXd> stacked(const RunHandle& run, const Eigen::VectorXd& p, std::size_t rows) {
        const double offset = value_of(p, Fitted::Of::offset, asked_.offset.value_or(0));
        std::vector<double> all;
        std::vector<std::vector<double>> columns;
        for (const MeasuredColumn& column : columns_) {
            std::vector<double>& numbers = columns.emplace_back(rows);
            if (column.quantity == Measure::acceleration) {
                lua_getfield(L_, -1, "acceleration");
                const auto* vector = lua::test<lua::Vector>(L_, -1);
                if (vector == nullptr) options_.fail({"the runs of this system have no acceleration"});
                std::copy(vector->begin(), vector->end(), numbers.begin());
                lua_pop(L_, 1);
                continue;
            }
            const bool theta = column.quantity == Measure::theta;
            const auto from = run->trajectory.column(theta ? motion::Column::theta : motion::Column::velocity);
            for (std::size_t i = 0; i < rows; ++i)
                numbers[i] = from[static_cast<Eigen::Index>(i)] + (theta ? offset : 0);
        }
        for (std::size_t i = 0; i < rows; ++i) {
            for (std::size_t j = 0; j < columns_.size(); ++j) {
                if (!std::isnan(columns_[j].numbers[i])) all.push_back(columns[j][i] / columns_[j].size);
            }
        }
        Eigen::VectorXd stacked = Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
        return stacked.allFinite() ? std::optional(std::move(stacked)) : std::nullopt;
    }

    /// The tables are the user's.
    void restore() {
        for (const Fitted& one : free_) {
            if (one.of != Fitted::Of::table) continue;
            lua_pushnumber(L_, one.start);
            lua_setfield(L_, one.table, one.key.c_str());
        }
    }

    FittedParts answer(const analysis::GeneralFit& found) {
        FittedParts parts;
        auto guess = with(found.value);
        restore();
        for (std::size_t i = 0; i < free_.size(); ++i) {
            const auto place = static_cast<Eigen::Index>(i);
            double value = found.value[place];  // what holds may have been less than what slides
            if (free_[i].of == Fitted::Of::system)
                guess->with(free_[i].name, [&](NumberPlace own) { value = *own.value; });
            parts.values.emplace_back(free_[i].name, value);
            parts.errors.emplace_back(free_[i].name, found.error[place]);
            if (found.silent[i]) parts.silent.push_back(free_[i].name);
        }
        if (guess->plain) {
            auto made = model::Oscillator::make(*guess->plain);
            if (made) parts.system = std::move(made).value();
        } else {
            parts.rig = std::make_shared<const model::Assembly>(*guess->rig);
        }
        const MeasuredColumn& first = columns_.front();
        Eigen::Index next = 0;
        for (std::size_t row = 0; row < t_.size(); ++row) {
            for (std::size_t j = 0; j < columns_.size(); ++j) {
                if (std::isnan(columns_[j].numbers[row])) continue;
                if (j == 0) {
                    parts.t.push_back(t_[row]);
                    parts.measured.push_back(first.numbers[row]);
                    parts.predicted.push_back(found.predicted[next] * first.size);
                }
                ++next;
            }
        }
        parts.noise = found.noise * first.size;
        constexpr double alike = 1.3, rounding = 1e-7;
        const double range = range_[static_cast<std::size_t>(first.quantity)];
        if (found.widening > alike && parts.noise > rounding * range) {
            parts.remark = fmt::format(
                "the residual is correlated from sample to sample (noise in M, another law of friction or a wrong "
                "guess); the errors are {:.2g} times wider because of that",
                found.widening);
        }
        return parts;
    }

    lua_State* L_;
    const lua::Options& options_;
    const IdentifyOptions& asked_;
    Guess guess_;
    std::vector<Fitted> free_;
    std::vector<MeasuredColumn> columns_;
    std::vector<double> t_;
    std::vector<Eigen::Index> known_until_;  ///< how many numbers there are up to each row
    std::array<double, 3> range_{};          ///< of each quantity, 0 where it is not measured
    model::State initial_;
    double swing_ = 1, angle_ = 1, speed_ = 1, torque_ = 1;
    std::string failure_;  ///< of the last run
};

}  // namespace

FittedParts fit_any(lua_State* L, const lua::Options& options, const IdentifyOptions& asked) {
    return AnyFit(L, options, asked).found();
}

}  // namespace dinal::api
