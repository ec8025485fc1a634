// A user's function, of Lua or of another language such as Python, as a term of an excitation, and the Lua call during
// which it may be evaluated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lua/bind.hpp"
#include "lua/formula_reader.hpp"
#include "lua/lua_headers.hpp"
#include "model/drive.hpp"
#include "text/not_copied.hpp"

namespace dinal::lua {

/// The first upvalue of the C function that makes the call; owned by the Lua state in which it was made.
struct Foreign {
    std::shared_ptr<void> function;
    int parameters = 1;         ///< number of required parameters
    const char* language = "";  ///< "Python"
    std::uint64_t number = 0;   ///< unique in this process
};

/// Pushes the C function `call` with this upvalue and assigns its number.
void push_foreign(lua_State* L, Foreign function, lua_CFunction call);

/// The Foreign of the function at `index`, or nullptr.
[[nodiscard]] const Foreign* foreign(lua_State* L, int index);

/// The Foreign of the running C function; requires push_foreign().
[[nodiscard]] inline const Foreign& foreign_here(lua_State* L) {
    return *static_cast<const Foreign*>(lua_touserdata(L, lua_upvalueindex(1)));
}

/// While this object lives, user functions run on `L`, the state of the present call, often a coroutine. Create one in
/// every binding that may evaluate an excitation (simulate, e:value, run:at). They nest.
class CallState : text::NotCopied {
public:
    /// Raises an error if calls nest too deep, because each may be an integration on the C++ stack, which is smaller
    /// than Lua assumes.
    explicit CallState(lua_State* L);
    ~CallState();

    /// Returns whether a user function has failed during this call. From then on all functions return NaN, until
    /// may_go_on().
    bool failed() const { return failed_ || failed_before_; }
    /// Makes functions receive their states in a table with these names, as fourth argument.
    void name_states(const std::vector<std::string>& names);
    /// Makes functions receive theta and velocity as tables with these names, filled from the first states.
    void name_bodies(const std::vector<std::string>& names);

    /// Sets the time span of interest, if known; conditions that change very often within it count as noise.
    void set_span(double span) { span_ = span; }

    /// Raises the user function's error unchanged, or an error about its result. Requires failed().
    [[noreturn]] void raise_error();
    void check() {
        if (failed()) raise_error();
    }

private:
    friend class LuaFunction;
    friend class LuaAction;
    friend class LuaMemory;
    void keep_error_on_top();
    /// Returns whether angles and velocities of several bodies precede the states.
    bool has_bodies(std::span<const double> states) const {
        return !bodies_.empty() && states.size() == 2 * bodies_.size() + names_.size();
    }
    /// Pushes theta, velocity and, if any, the states; returns how many values.
    int push_motion(const model::State& state, std::span<const double> states) const;
    void push_states(std::span<const double> states) const;
    /// Reads the states back after a user's action; returns false if one is invalid.
    bool read_states(std::span<double> states) const;
    bool read_motion(std::span<double> states) const;
    void push_table(int table, std::span<const int> names, std::span<const double> values) const;
    bool read_table(int table, std::span<const int> names, std::span<double> values) const;
    std::vector<int> kept_names(const std::vector<std::string>& names) const;

    lua_State* L_;
    CallState* outer_;
    int depth_;
    std::uint64_t number_;  // unique among such calls
    std::vector<std::string> state_names_;
    double span_ = 1;
    int state_table_ = LUA_NOREF;  // registry references of the tables of states
    std::vector<int> names_;
    int theta_table_ = LUA_NOREF, velocity_table_ = LUA_NOREF;
    std::vector<std::string> body_names_;
    std::vector<int> bodies_;
    bool failed_ = false;         // whether a function failed since may_go_on()
    bool failed_before_ = false;  // an earlier failure, whose error is kept
};

/// The quantity that a function provides, for sentences: "friction returned nil at speed = 0.3".
struct FunctionRole {
    std::string name = "M";
    const char* argument = "t";
    bool may_be_negative = true;
    enum class Motion {
        by_parameters,  ///< it is called with theta and velocity if it has two or more parameters
        never,
        always,
    } motion = Motion::by_parameters;
    bool of_speed = false;  ///< whether its first argument is a speed, which is passed as the first state
};

/// The table that a sampled controller modifies in one run.
class LuaMemory final : public model::terms::FunctionMemory {
public:
    LuaMemory(lua_State* main, int reference) : main_(main), reference_(reference) {}
    ~LuaMemory() override;
    /// A copy of the table on the top, or of the table that the function on the top returns; pops it. Null on failure.
    static std::shared_ptr<model::terms::FunctionMemory> from_top();
    std::shared_ptr<model::terms::FunctionMemory> copy() const override;
    void push(lua_State* L) const { lua_rawgeti(L, LUA_REGISTRYINDEX, reference_); }

private:
    lua_State* main_;
    int reference_;
};

class LuaFunction final : public model::UserFunction {
public:
    /// Takes the callable value at `index` and keeps it in the registry.
    LuaFunction(lua_State* L, int index, FunctionRole role = {});
    ~LuaFunction() override;

    double value(double t, const model::State& state) override { return value_with(t, state, {}); }
    double value_with(double t, const model::State& state, std::span<const double> states) override;
    std::size_t fill(std::span<const double> times, std::span<double> out) override;
    model::Formula* read() override;
    double next_break(double t) override { return next_break(t, &model::Formula::next_break); }
    /// Like next_break(), but without the breaks of excitations that the function evaluates.
    [[nodiscard]] double next_condition(double t) { return next_break(t, &model::Formula::next_condition); }
    bool has_pieces() override;
    void decide(model::terms::Piece& piece, double t, const model::State& state, std::span<const double> states,
                std::uint64_t again) override;
    double value_on(const model::terms::Piece& piece, double t, const model::State& state,
                    std::span<const double> states, std::vector<double>* margins) override;
    bool may_go_on() override;
    void forget_failure() override;
    std::shared_ptr<model::terms::FunctionMemory> new_memory() override;
    void use(const std::shared_ptr<model::terms::FunctionMemory>& memory) override { memory_ = memory; }

    /// Makes each run begin with the table that the function at `index` returns, as fifth argument.
    void remember_from(lua_State* L, int index);
    /// Pushes that function; returns false, and pushes nothing, if there is none.
    bool push_start(lua_State* L) const;

    /// Returns whether it receives theta and velocity: a Lua function (or __call) of two or more parameters, or with
    /// `...`.
    bool feedback() const { return feedback_; }
    const FunctionRole& role() const { return role_; }
    /// Reads the function as a formula, unless done in this call. Returns why that fails; empty if it succeeds.
    std::string obstacle();
    const std::string& last_obstacle() const { return reading_->obstacle; }
    /// The formula if it has been read, otherwise null.
    model::Formula* formula() const { return reading_->formula ? &*reading_->formula : nullptr; }
    /// Pushes the function itself.
    void push(lua_State* L) const;

private:
    static int fill_protected(lua_State* L);
    double next_break(double t, double (model::Formula::*next)(double));
    /// The formula if reading it is worthwhile for this many values (`many` for breaks), otherwise null.
    model::Formula* formula(const CallState& call, std::size_t values);
    static constexpr std::size_t many = std::size_t{1} << 20U;
    void read_again(const CallState& call);
    bool agrees(double read, CallState& call, double t, const model::State& state, std::span<const double> states);
    Arguments arguments_in(const CallState& call) const;
    /// Returns whether the formula expects these states.
    bool fits(std::span<const double> states) const;
    /// Returns whether the function is a friction law: smooth between its conditions, and never called with negative
    /// speeds in Lua.
    bool is_law() const { return !role_.may_be_negative && role_.motion != FunctionRole::Motion::by_parameters; }
    double evaluate(CallState& call, double t, const model::State& state, std::span<const double> states);
    std::size_t evaluate(CallState& call, std::span<const double> times, std::span<double> out);
    bool is_allowed(double result) const;
    double fail(CallState& call, int status, double t) const;
    bool is_good(lua_State* L, double& result) const;

    lua_State* main_;  // for the destructor, which the garbage collector calls at any time
    int reference_;
    int start_ = LUA_NOREF;  // function that returns a new memory
    std::shared_ptr<model::terms::FunctionMemory> memory_ = {};
    FunctionRole role_;
    bool feedback_;

    // The formula and data on its validity. Reading is worthwhile only after some values, so Lua evaluates the first
    // ones, and all of them if other functions run in between.
    std::shared_ptr<Reading> reading_ = std::make_shared<Reading>();
    std::uint64_t seen_ = 0;       // `change_counter` at the last comparison with the assumed constants
    std::uint64_t tried_in_ = 0;   // the call in which it was read last
    std::uint64_t values_ = 0;     // values computed by the formula since then
    std::uint64_t patience_ = 12;  // values to be evaluated by Lua before the next reading
    std::uint64_t pause_ = 4;      // last pause between readings; it grows while few values come between them
};

/// A user's action at an event: a Lua function of t, theta, velocity, states. Returns theta, velocity, or nothing to
/// keep them.
class LuaAction final : public model::EventAction {
public:
    LuaAction(lua_State* L, int index, std::string name);
    ~LuaAction() override;
    bool act(double t, model::State& state, std::span<double> states) override;
    void push(lua_State* L) const { lua_rawgeti(L, LUA_REGISTRYINDEX, reference_); }

private:
    lua_State* main_;
    int reference_;
    std::string name_;
};

}  // namespace dinal::lua
