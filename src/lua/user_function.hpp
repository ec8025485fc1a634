// A user's Lua function as a term of an excitation, and the Lua call during which such functions may be asked.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lua/bind.hpp"
#include "lua/formula_reader.hpp"
#include "model/drive.hpp"

namespace dinal::lua {

/// While it lives, user functions run on `L`: the state of the call in progress, which is a coroutine as often as not.
/// One on the C++ stack of every binding that may ask an excitation (simulate, e:value, run:at). They nest.
class CallState {
public:
    /// Raises when they nest too deep: each may be an integration on the C++ stack, which is smaller than Lua thinks.
    explicit CallState(lua_State* L);
    ~CallState();
    CallState(const CallState&) = delete;
    CallState& operator=(const CallState&) = delete;

    /// A user function has failed during this call. From then on none is called, all give NaN, until may_go_on().
    [[nodiscard]] bool failed() const { return failed_ || failed_before_; }
    /// From now on functions get their states as a table with these names, their fourth argument.
    void name_states(const std::vector<std::string>& names);
    /// From now on functions get theta and velocity as tables with these names, out of the first of their states.
    void name_bodies(const std::vector<std::string>& names);

    /// How long a time is of interest, when that is known: conditions that change far more often are noise.
    void set_span(double span) { span_ = span; }

    /// Raises what the user function raised, unchanged, or the sentence about what it returned. Only when failed().
    [[noreturn]] void raise_error();
    void check() {
        if (failed()) raise_error();
    }

private:
    friend class LuaFunction;
    friend class LuaAction;
    friend class LuaMemory;
    void keep_error_on_top();
    /// Angles and velocities of several bodies stand before the states.
    [[nodiscard]] bool has_bodies(std::span<const double> states) const {
        return !bodies_.empty() && states.size() == 2 * bodies_.size() + names_.size();
    }
    /// Pushes theta, velocity and, where there are some, the states; returns how many that are.
    int push_motion(const model::State& state, std::span<const double> states) const;
    void push_states(std::span<const double> states) const;
    /// What a user has made of them.
    [[nodiscard]] bool read_states(std::span<double> states) const;
    [[nodiscard]] bool read_motion(std::span<double> states) const;
    void push_table(int table, std::span<const int> names, std::span<const double> values) const;
    [[nodiscard]] bool read_table(int table, std::span<const int> names, std::span<double> values) const;
    [[nodiscard]] std::vector<int> kept_names(const std::vector<std::string>& names) const;

    lua_State* L_;
    CallState* outer_;
    int depth_;
    std::uint64_t number_;  // of all such calls
    std::vector<std::string> state_names_;
    double span_ = 1;
    int state_table_ = LUA_NOREF;  // kept in the registry, as the names of the states
    std::vector<int> names_;
    int theta_table_ = LUA_NOREF, velocity_table_ = LUA_NOREF;
    std::vector<std::string> body_names_;
    std::vector<int> bodies_;
    bool failed_ = false;         // and nobody has said that it may go on
    bool failed_before_ = false;  // the error is kept all the same
};

/// What a function stands for, in sentences: "friction returned nil at speed = 0.3".
struct FunctionRole {
    std::string name = "M";
    const char* argument = "t";
    bool may_be_negative = true;
    enum class Motion {
        by_parameters,  ///< it is called with theta and velocity, too, when it has two or more
        never,
        always,
    } motion = Motion::by_parameters;
    bool of_speed = false;  ///< it is called with a speed first, which is the first of its states
};

/// The table to which a sampled controller writes in one run.
class LuaMemory final : public model::terms::Memory {
public:
    LuaMemory(lua_State* main, int reference) : main_(main), reference_(reference) {}
    ~LuaMemory() override;
    /// A copy of the table on the top of the stack of the present call, or of the one that the function there returns.
    /// It is popped. None when that failed.
    static std::shared_ptr<model::terms::Memory> from_top();
    [[nodiscard]] std::shared_ptr<model::terms::Memory> copy() const override;
    void push(lua_State* L) const { lua_rawgeti(L, LUA_REGISTRYINDEX, reference_); }

private:
    lua_State* main_;
    int reference_;
};

class LuaFunction final : public model::UserFunction {
public:
    /// Of the callable value at `index`, which the registry keeps from now on.
    LuaFunction(lua_State* L, int index, FunctionRole role = {});
    ~LuaFunction() override;

    double value(double t, const model::State& state) override { return value_with(t, state, {}); }
    double value_with(double t, const model::State& state, std::span<const double> states) override;
    std::size_t fill(std::span<const double> times, std::span<double> out) override;
    model::Formula* read() override;
    double next_break(double t) override { return next_break(t, &model::Formula::next_break); }
    /// The same without the breaks of excitations that it evaluates.
    [[nodiscard]] double next_condition(double t) { return next_break(t, &model::Formula::next_condition); }
    bool has_pieces() override;
    void decide(model::terms::Piece& piece, double t, const model::State& state, std::span<const double> states,
                std::uint64_t again) override;
    double value_on(const model::terms::Piece& piece, double t, const model::State& state,
                    std::span<const double> states, std::vector<double>* margins) override;
    bool may_go_on() override;
    void forget_failure() override;
    std::shared_ptr<model::terms::Memory> new_memory() override;
    void use(const std::shared_ptr<model::terms::Memory>& memory) override { memory_ = memory; }

    /// From now on each run begins with the table that the function at `index` returns, its fifth argument.
    void remember_from(lua_State* L, int index);
    /// Pushes that function; false, and nothing, when there is none.
    bool push_start(lua_State* L) const;

    /// It wants theta and velocity: a Lua function (or __call) of two or more parameters, or with `...`.
    [[nodiscard]] bool feedback() const { return feedback_; }
    [[nodiscard]] const FunctionRole& role() const { return role_; }
    /// Reads it, if that was not done in this call; why it could not be read, empty when it could.
    std::string obstacle();
    /// The same as it was found last.
    [[nodiscard]] const std::string& last_obstacle() const { return reading_->obstacle; }
    /// Its formula, when it is read.
    [[nodiscard]] model::Formula* formula() const { return reading_->formula ? &*reading_->formula : nullptr; }
    /// Pushes the function itself.
    void push(lua_State* L) const;

private:
    static int fill_protected(lua_State* L);
    double next_break(double t, double (model::Formula::*next)(double));
    /// For so many values, or for breaks.
    model::Formula* formula(const CallState& call, std::size_t values);
    static constexpr std::size_t many = std::size_t{1} << 20U;
    void look_again(const CallState& call);
    bool agrees(double read, CallState& call, double t, const model::State& state, std::span<const double> states);
    [[nodiscard]] Arguments arguments_in(const CallState& call) const;
    /// The states are those of its formula.
    [[nodiscard]] bool fits(std::span<const double> states) const;
    /// It is a law of friction, which is smooth between its conditions, and of which Lua sees no negative speed.
    [[nodiscard]] bool is_law() const { return !role_.may_be_negative; }
    double ask(CallState& call, double t, const model::State& state, std::span<const double> states);
    std::size_t ask(CallState& call, std::span<const double> times, std::span<double> out);
    [[nodiscard]] bool is_allowed(double result) const;
    double fail(CallState& call, int status, double t) const;
    bool is_good(lua_State* L, double& result) const;

    lua_State* main_;  // for the destructor, which runs when the collector pleases
    int reference_;
    int start_ = LUA_NOREF;  // returns a new memory
    std::shared_ptr<model::terms::Memory> memory_ = {};
    FunctionRole role_;
    bool feedback_;

    // How it was read, and whether that still holds. Reading pays after some values only, so the first ones are asked
    // for, and so is each value as long as other functions run between all of them.
    std::shared_ptr<Reading> reading_ = std::make_shared<Reading>();
    std::uint64_t seen_ = 0;       // what had run when the reading was compared with all that it holds for constant
    std::uint64_t tried_in_ = 0;   // the call in which that was done last
    std::uint64_t values_ = 0;     // that were read since then
    std::uint64_t patience_ = 12;  // values that are asked for before it is done again
    std::uint64_t pause_ = 4;      // what that was last; longer and longer while few values come between
};

/// What a user does at one of his events: a Lua function of t, theta, velocity, states that returns theta, velocity, or
/// nothing when they stay as they are.
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
