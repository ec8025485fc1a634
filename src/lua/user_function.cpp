#include "lua/user_function.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lua/bind.hpp"
#include "lua/error_memory.hpp"
#include "lua/formula_reader.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_message.hpp"
#include "lua/lua_text.hpp"
#include "lua/vector.hpp"

namespace dinal::lua {

namespace {

const Class foreign_class = {"function of another language", {"", "", ""}, std::span<const Member>()};

}  // namespace

void push_foreign(lua_State* L, Foreign function, lua_CFunction call) {
    static std::atomic<std::uint64_t> last_number = 0;
    luaL_checkstack(L, 4, "too many values");
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &detail::type_key<Foreign>) == LUA_TNIL) {
        add_class<Foreign>(L, foreign_class);
    }
    lua_pop(L, 1);
    function.number = ++last_number;
    push(L, std::move(function));
    lua_pushcclosure(L, call, 1);
}

const Foreign* foreign(lua_State* L, int index) {
    if (lua_iscfunction(L, index) == 0 || lua_getupvalue(L, index, 1) == nullptr) return nullptr;
    const auto* found = test<Foreign>(L, -1);
    lua_pop(L, 1);
    return found;
}

namespace {

// ---- The table through which functions receive the states of a run: the same throughout, with a fixed set of fields.

/// Raises an error for an unknown state.
int no_such_state(lua_State* L) {
    const std::vector<std::string> names = text_keys(L, 1);
    lua_settop(L, 2);
    const std::string wanted = written(L, 2);
    raise(L, {.sentence = fmt::format("there is no {} '{}'; there is {}", lua_tostring(L, lua_upvalueindex(1)), wanted,
                                      fmt::join(names, ", ")),
              .culprit = wanted,
              .cure = text::did_you_mean(wanted, names)});
}

/// Pushes a table with a number in each of these fields; other names raise an error: "there is no state 'x'; there is
/// e".
void push_state_table(lua_State* L, std::span<const std::string> names, const char* what = "state") {
    lua_createtable(L, 0, static_cast<int>(names.size()));
    lua_createtable(L, 0, 2);
    for (const char* other : {"__index", "__newindex"}) {
        lua_pushstring(L, what);
        lua_pushcclosure(L, guarded<no_such_state>, 1);
        lua_setfield(L, -2, other);
    }
    lua_setmetatable(L, -2);
    for (const std::string& name : names) {
        lua_pushlstring(L, name.data(), name.size());
        lua_pushnumber(L, 0);
        lua_rawset(L, -3);
    }
}

// Thread local, as a Lua state belongs to one thread; a function called on another thread finds none and returns NaN.
thread_local CallState* current = nullptr;

/// The first counter of a thread: threads that use one Lua state in turn have different numbers.
std::uint64_t counters_of_thread() {
    static std::atomic<std::uint64_t> threads = 0;
    return (threads++ << 40U) + 1;
}

// Increases whenever Lua code may have run on this thread: while it is constant, no variable has changed.
thread_local std::uint64_t change_counter = counters_of_thread();
thread_local std::uint64_t calls = change_counter;

constexpr double failure = std::numeric_limits<double>::quiet_NaN();

lua_State* main_thread(lua_State* L) {
    lua_rawgeti(L, LUA_REGISTRYINDEX, LUA_RIDX_MAINTHREAD);
    lua_State* main = lua_tothread(L, -1);
    lua_pop(L, 1);
    return main;
}

/// The number of parameters of the function at `index`; large for `...`, one for a C function.
int parameter_count(lua_State* L, int index) {
    constexpr int many = 256;
    if (lua_iscfunction(L, index) != 0) {
        const Foreign* other = foreign(L, index);
        return other != nullptr ? other->parameters : 1;
    }
    lua_Debug about{};
    lua_pushvalue(L, index);
    lua_getinfo(L, ">u", &about);
    return about.isvararg != 0 ? many : about.nparams;
}

bool wants_state(lua_State* L, int index) {
    if (lua_type(L, index) == LUA_TFUNCTION) {
        return parameter_count(L, index) >= 2;
    }
    bool wants = false;
    if (luaL_getmetafield(L, index, "__call") != LUA_TNIL) {
        wants = lua_type(L, -1) == LUA_TFUNCTION && parameter_count(L, -1) >= 3;  // self is the first parameter
        lua_pop(L, 1);
    }
    return wants;
}

/// "FILE:LINE: " of the definition of the function on the top (popped); for a C function that of its caller.
std::string definition(lua_State* L) {
    if (lua_type(L, -1) != LUA_TFUNCTION) {
        luaL_getmetafield(L, -1, "__call");
        lua_remove(L, -2);
    }
    if (lua_type(L, -1) != LUA_TFUNCTION || lua_iscfunction(L, -1) != 0) {
        lua_pop(L, 1);
        return where(L);
    }
    lua_Debug about{};
    lua_getinfo(L, ">S", &about);
    return fmt::format("{}:{}: ", about.short_src, about.linedefined);
}

}  // namespace

CallState::CallState(lua_State* L)
    : L_(L), outer_(current), depth_(outer_ == nullptr ? 1 : outer_->depth_ + 1), number_(++calls) {
    ++change_counter;
    constexpr int deepest = 50;
    if (depth_ > deepest) {
        raise(L,
              "functions of M, friction or a spring evaluate runs or other functions of this kind {} levels deep, "
              "which is too much",
              deepest);
    }
    luaL_checkstack(L, LUA_MINSTACK, "for the call of a user function");  // once, rather than for each value
    current = this;
}

CallState::~CallState() {
    current = outer_;
    lua_pushnil(L_);  // forgets the stored error
    lua_rawsetp(L_, LUA_REGISTRYINDEX, this);
    for (const int kept : {state_table_, theta_table_, velocity_table_}) luaL_unref(L_, LUA_REGISTRYINDEX, kept);
    for (const int name : names_) luaL_unref(L_, LUA_REGISTRYINDEX, name);
    for (const int name : bodies_) luaL_unref(L_, LUA_REGISTRYINDEX, name);
}

std::vector<int> CallState::kept_names(const std::vector<std::string>& names) const {
    std::vector<int> kept;
    kept.reserve(names.size());
    for (const std::string& name : names) {
        lua_pushlstring(L_, name.data(), name.size());
        kept.push_back(luaL_ref(L_, LUA_REGISTRYINDEX));
    }
    return kept;
}

void CallState::name_states(const std::vector<std::string>& names) {
    state_names_ = names;
    push_state_table(L_, names);
    state_table_ = luaL_ref(L_, LUA_REGISTRYINDEX);
    names_ = kept_names(names);
}

void CallState::name_bodies(const std::vector<std::string>& names) {
    for (int* table : {&theta_table_, &velocity_table_}) {
        push_state_table(L_, names, "body");
        *table = luaL_ref(L_, LUA_REGISTRYINDEX);
    }
    body_names_ = names;
    bodies_ = kept_names(names);
}

/// Reuses one table, so that a call needs no memory.
void CallState::push_table(int table, std::span<const int> names, std::span<const double> values) const {
    lua_rawgeti(L_, LUA_REGISTRYINDEX, table);
    for (std::size_t i = 0; i < values.size(); ++i) {
        lua_rawgeti(L_, LUA_REGISTRYINDEX, names[i]);
        lua_pushnumber(L_, values[i]);
        lua_rawset(L_, -3);
    }
}

void CallState::push_states(std::span<const double> states) const {
    push_table(state_table_, names_, states);
}

int CallState::push_motion(const model::State& state, std::span<const double> states) const {
    const std::size_t bodies = bodies_.size();
    if (has_bodies(states)) {
        push_table(theta_table_, bodies_, states.first(bodies));
        push_table(velocity_table_, bodies_, states.subspan(bodies, bodies));
        states = states.subspan(2 * bodies);
    } else {
        lua_pushnumber(L_, state.theta);
        lua_pushnumber(L_, state.velocity);
    }
    if (states.empty() || states.size() != names_.size()) return 2;
    push_states(states);
    return 3;
}

void CallState::keep_error_on_top() {
    lua_rawsetp(L_, LUA_REGISTRYINDEX, this);
    failed_ = true;
}

void CallState::raise_error() {
    if (outer_ != nullptr) {
        keep_remarks(L_);
    }
    lua_rawgetp(L_, LUA_REGISTRYINDEX, this);
    lua_error(L_);
    std::terminate();  // lua_error does not return, but is not declared so
}

bool is_callable(lua_State* L, int index) {
    if (lua_type(L, index) == LUA_TFUNCTION) {
        return true;
    }
    if (luaL_getmetafield(L, index, "__call") == LUA_TNIL) {
        return false;
    }
    lua_pop(L, 1);
    return true;
}

bool CallState::read_table(int table, std::span<const int> names, std::span<double> values) const {
    lua_rawgeti(L_, LUA_REGISTRYINDEX, table);
    bool good = true;
    for (std::size_t i = 0; i < values.size(); ++i) {
        lua_rawgeti(L_, LUA_REGISTRYINDEX, names[i]);
        lua_rawget(L_, -2);
        values[i] = lua_tonumber(L_, -1);
        good = good && lua_type(L_, -1) == LUA_TNUMBER && std::isfinite(values[i]);
        lua_pop(L_, 1);
    }
    lua_pop(L_, 1);
    return good;
}

bool CallState::read_states(std::span<double> states) const {
    return read_table(state_table_, names_, states);
}

/// Reads back angles, velocities and states; with several bodies the user may have assigned angles and velocities.
bool CallState::read_motion(std::span<double> states) const {
    const std::size_t bodies = bodies_.size();
    if (bodies == 0) return read_states(states);
    const bool angles = read_table(theta_table_, bodies_, states.first(bodies));
    const bool velocities = read_table(velocity_table_, bodies_, states.subspan(bodies, bodies));
    const std::span<double> own = states.subspan(2 * bodies);
    return angles && velocities && (own.empty() || read_states(own));
}

LuaAction::LuaAction(lua_State* L, int index, std::string name) : main_(main_thread(L)), name_(std::move(name)) {
    lua_pushvalue(L, index);
    reference_ = luaL_ref(L, LUA_REGISTRYINDEX);
}

LuaAction::~LuaAction() {
    luaL_unref(main_, LUA_REGISTRYINDEX, reference_);
}

bool LuaAction::act(double t, model::State& state, std::span<double> states) {
    CallState* call = current;
    if (call == nullptr || call->failed_) {
        return false;
    }
    lua_State* L = call->L_;
    const int top = lua_gettop(L);
    lua_pushcfunction(L, guarded<witness_error>);
    push(L);
    lua_pushnumber(L, t);
    const int arguments = 1 + call->push_motion(state, states);
    const int status = lua_pcall(L, arguments, 2, top + 1);
    ++change_counter;
    if (status != LUA_OK) {
        remember_argument(L, name_.c_str(), "t", t);
        call->keep_error_on_top();
        lua_settop(L, top);
        return false;
    }
    const bool nothing = lua_isnil(L, -2) && lua_isnil(L, -1);
    const bool numbers = lua_type(L, -2) == LUA_TNUMBER && lua_type(L, -1) == LUA_TNUMBER;
    const model::State next =
        nothing ? state : model::State{.theta = lua_tonumber(L, -2), .velocity = lua_tonumber(L, -1)};
    const bool of_bodies = call->has_bodies(states);  // whether angles and velocities are fields of the tables
    const bool good = nothing || (numbers && !of_bodies && std::isfinite(next.theta) && std::isfinite(next.velocity));
    std::string wrong;
    if (!good) {
        wrong =
            fmt::format("{} returned {} and {} at t = {:.14g}; it must {}", name_, describe(L, -2), describe(L, -1), t,
                        of_bodies ? "change the fields of theta and velocity, and return nothing"
                                  : "return theta and velocity as finite numbers, or nothing");
    }
    lua_settop(L, top);
    if (good && call->read_motion(states)) {
        state = next;
        return true;
    }
    if (good) {
        wrong = fmt::format("{} gave a state a value that is not a finite number at t = {:.14g}", name_, t);
    }
    push(L);
    const std::string message = definition(L) + wrong;
    lua_pushlstring(L, message.data(), message.size());
    call->keep_error_on_top();
    return false;
}

namespace {

/// Replaces the value on the top by a deep copy. The table at `seen` maps tables to their copies; metatables are
/// shared.
void copy_value(lua_State* L, int seen, int depth) {
    constexpr int deepest = 100;
    const int type = lua_type(L, -1);
    const bool immutable = type == LUA_TNIL || type == LUA_TBOOLEAN || type == LUA_TNUMBER || type == LUA_TSTRING;
    if (immutable || test<Vector>(L, -1) != nullptr) return;
    if (type != LUA_TTABLE || depth > deepest) {
        const std::string found = type == LUA_TTABLE ? "tables 100 deep" : describe(L, -1);
        raise(L,
              {.sentence = fmt::format("the memory of a sampled controller holds numbers, strings, booleans, vectors "
                                       "and tables of these, got {}",
                                       found),
               .option = "start"});
    }
    luaL_checkstack(L, LUA_MINSTACK, "for the memory of a controller");
    lua_pushvalue(L, -1);
    if (lua_rawget(L, seen) != LUA_TNIL) return lua_remove(L, -2);
    lua_pop(L, 1);
    lua_createtable(L, 0, 0);
    const int table = lua_gettop(L) - 1, copy = table + 1;
    lua_pushvalue(L, table);
    lua_pushvalue(L, copy);
    lua_rawset(L, seen);
    for (lua_pushnil(L); lua_next(L, table) != 0;) {
        lua_pushvalue(L, -2);
        copy_value(L, seen, depth + 1);
        lua_insert(L, -2);
        copy_value(L, seen, depth + 1);
        lua_rawset(L, copy);
    }
    if (lua_getmetatable(L, table) != 0) lua_setmetatable(L, copy);
    lua_remove(L, table);
}

/// Returns a copy of its argument, a table, or of the table that its argument, a function, returns.
int copied_table(lua_State* L) {
    if (lua_type(L, 1) != LUA_TTABLE) {
        lua_call(L, 0, 1);
        if (lua_type(L, 1) != LUA_TTABLE) {
            raise(L, {.sentence = fmt::format("start of excitation.sampled returned {}; it must return the memory of a "
                                              "run, a table",
                                              describe(L, 1)),
                      .option = "start"});
        }
    }
    lua_createtable(L, 0, 0);
    lua_insert(L, 1);
    copy_value(L, 1, 0);
    return 1;
}

}  // namespace

std::shared_ptr<model::terms::FunctionMemory> LuaMemory::from_top() {
    lua_State* L = current->L_;
    const int handler = lua_gettop(L);
    lua_pushcfunction(L, guarded<witness_error>);
    lua_pushcfunction(L, guarded<copied_table>);
    lua_rotate(L, handler, 2);
    const int status = lua_pcall(L, 1, 1, handler);
    ++change_counter;
    std::shared_ptr<LuaMemory> memory;
    if (status == LUA_OK) {
        memory = std::make_shared<LuaMemory>(main_thread(L), luaL_ref(L, LUA_REGISTRYINDEX));
    } else {
        current->keep_error_on_top();
    }
    lua_settop(L, handler - 1);
    return memory;
}

LuaMemory::~LuaMemory() {
    luaL_unref(main_, LUA_REGISTRYINDEX, reference_);
}

std::shared_ptr<model::terms::FunctionMemory> LuaMemory::copy() const {
    if (current == nullptr || current->failed_) return nullptr;
    push(current->L_);
    return from_top();
}

LuaFunction::LuaFunction(lua_State* L, int index, FunctionRole role)
    : main_(main_thread(L)),
      role_(std::move(role)),
      feedback_(role_.motion == FunctionRole::Motion::always ||
                (role_.motion == FunctionRole::Motion::by_parameters && wants_state(L, index))) {
    lua_pushvalue(L, index);
    reference_ = luaL_ref(L, LUA_REGISTRYINDEX);
}

// Works also while lua_close runs finalizers, because the registry is destroyed last.
LuaFunction::~LuaFunction() {
    luaL_unref(main_, LUA_REGISTRYINDEX, reference_);
    luaL_unref(main_, LUA_REGISTRYINDEX, start_);
}

void LuaFunction::remember_from(lua_State* L, int index) {
    lua_pushvalue(L, index);
    start_ = luaL_ref(L, LUA_REGISTRYINDEX);
}

bool LuaFunction::push_start(lua_State* L) const {
    if (start_ == LUA_NOREF) return false;
    lua_rawgeti(L, LUA_REGISTRYINDEX, start_);
    return true;
}

std::shared_ptr<model::terms::FunctionMemory> LuaFunction::new_memory() {
    const bool wanted = current != nullptr && !current->failed_ && push_start(current->L_);
    return wanted ? LuaMemory::from_top() : nullptr;
}

void LuaFunction::push(lua_State* L) const {
    lua_rawgeti(L, LUA_REGISTRYINDEX, reference_);
}

/// Accepts a finite number on the top; not a string that looks like one.
bool LuaFunction::is_good(lua_State* L, double& result) const {
    result = lua_tonumber(L, -1);
    return lua_type(L, -1) == LUA_TNUMBER && std::isfinite(result) && (role_.may_be_negative || result >= 0);
}

bool LuaFunction::is_allowed(double result) const {
    return std::isfinite(result) && (role_.may_be_negative || result >= 0);
}

/// The arguments with which the function is called in a run.
Arguments LuaFunction::arguments_in(const CallState& call) const {
    Arguments given{.count = feedback_ ? call.names_.empty() ? 3 : 4 : 1,
                    .of_speed = role_.of_speed,
                    .timeless = role_.motion == FunctionRole::Motion::never};
    if (feedback_) given.bodies = call.body_names_, given.states = call.state_names_;
    return given;
}

bool LuaFunction::fits(std::span<const double> states) const {
    const std::size_t count = reading_->arguments.state_count();
    return count == 0 || states.size() == count;
}

/// The formula if all variables that it treats as constant are unchanged. Null if Lua must be called, such as while a
/// hook is set.
model::Formula* LuaFunction::formula(const CallState& call, std::size_t values) {
    if (lua_gethook(call.L_) != nullptr || start_ != LUA_NOREF) return nullptr;
    const bool is_read = formula() != nullptr;
    if (is_read && seen_ == change_counter) return &*reading_->formula;
    if (!is_read && tried_in_ == call.number_) return nullptr;
    if (patience_ > values) {
        patience_ -= values;
        return nullptr;
    }
    read_again(call);
    return reading_->formula ? &*reading_->formula : nullptr;
}

void LuaFunction::read_again(const CallState& call) {
    constexpr std::uint64_t few = 8;
    constexpr std::uint64_t longest_pause = 1024;
    const bool new_call = tried_in_ != call.number_;
    pause_ = values_ < few ? std::min(2 * pause_, longest_pause) : 1;
    patience_ = pause_;
    values_ = 0;
    seen_ = change_counter;
    tried_in_ = call.number_;
    push(call.L_);
    reading_ = reading_of(call.L_, -1, arguments_in(call));
    lua_pop(call.L_, 1);
    if (new_call && reading_->formula) {
        reading_->formula->begin(call.span_);
        reading_->obstacle.clear();
    }
}

/// Compares the formula with Lua for the first values, and occasionally for later ones.
bool LuaFunction::agrees(double read, CallState& call, double t, const model::State& state,
                         std::span<const double> states) {
    constexpr std::uint64_t first = 3, between = 1024;
    if (++values_ > first && values_ % between != 0) return true;
    const double by_lua = evaluate(call, t, state, states);
    if (std::bit_cast<std::uint64_t>(by_lua) == std::bit_cast<std::uint64_t>(read)) return true;
    reading_->formula.reset();
    reading_->obstacle = "it gave another value than its formula";
    return false;
}

double LuaFunction::value_with(double t, const model::State& state, std::span<const double> states) {
    CallState* call = current;
    if (call == nullptr || call->failed_) return failure;
    if (model::Formula* read = formula(*call, 1); read != nullptr && fits(states)) {
        const double M = read->value(t, state, states.first(reading_->arguments.state_count()));
        if (is_allowed(M) && agrees(M, *call, t, state, states)) return M;
    }
    const double M = evaluate(*call, t, state, states);
    if (!formula()) ++change_counter;
    return M;
}

// Uses lua_pcall although Lua's errors would unwind the integrator as well: the rows so far must be kept.
double LuaFunction::evaluate(CallState& call, double t, const model::State& state, std::span<const double> states) {
    lua_State* L = call.L_;
    lua_pushcfunction(L, guarded<witness_error>);
    const int handler = lua_gettop(L);
    push(L);
    int arguments = 1;
    if (role_.of_speed) {
        lua_pushnumber(L, states.front());
        states = states.subspan(1);
        ++arguments;
    }
    lua_pushnumber(L, t);
    if (feedback_) arguments += call.push_motion(state, states);
    if (const auto* memory = dynamic_cast<const LuaMemory*>(memory_.get())) {
        lua_settop(L, handler + 5);  // without states the fourth argument is nil
        memory->push(L);
        arguments = 5;
    }
    const int status = lua_pcall(L, arguments, 1, handler);
    double M = 0;
    if (status == LUA_OK && is_good(L, M)) {
        lua_settop(L, handler - 1);
        return M;
    }
    lua_remove(L, handler);
    return fail(call, status, t);
}

std::string LuaFunction::obstacle() {
    return read() != nullptr || !reading_->obstacle.empty() ? reading_->obstacle : "a debug hook is set";
}

model::Formula* LuaFunction::read() {
    return current == nullptr || current->failed_ ? nullptr : formula(*current, many);
}

double LuaFunction::next_break(double t, double (model::Formula::*next)(double)) {
    model::Formula* formula = read();
    if (formula == nullptr) return model::never;
    const double found = (formula->*next)(t);
    if (formula->gave_up()) reading_->obstacle = "its conditions change at too many times to find them";
    return found;
}

bool LuaFunction::has_pieces() {
    const model::Formula* formula = read();
    return formula != nullptr && (is_law() || formula->has_conditions_of_motion()) && !formula->gave_up();
}

void LuaFunction::decide(model::terms::Piece& piece, double t, const model::State& state,
                         std::span<const double> states, std::uint64_t again) {
    if (piece.owner != reading_) piece = {};
    const bool good = has_pieces() && fits(states) && std::isfinite(value_with(t, state, states)) && reading_->formula;
    if (!good || piece.owner != reading_) piece = {};
    if (!good) return;
    piece.owner = reading_;
    reading_->formula->decide(piece, t, state, states.first(reading_->arguments.state_count()), again);
}

/// Calls the Lua function if the formula has no value beyond its piece.
double LuaFunction::value_on(const model::terms::Piece& piece, double t, const model::State& state,
                             std::span<const double> states, std::vector<double>* margins) {
    double M = failure;
    if (piece.owner == reading_ && reading_->formula && fits(states)) {
        const std::span<const double> own = states.first(reading_->arguments.state_count());
        M = piece.conditions.empty() ? reading_->formula->value(t, state, own)
                                     : reading_->formula->value_on(piece, t, state, own, margins);
    } else if (margins != nullptr) {
        margins->clear();
    }
    if (margins != nullptr) margins->resize(piece.conditions.size(), model::never);
    if (!is_law()) return std::isfinite(M) ? M : value_with(t, state, states);
    // Below speed 0 only the formula can continue the law. Above, a piece may be negative beyond its end.
    const double speed = role_.of_speed ? states.front() : t;
    if (speed < 0 || is_allowed(M)) return M;
    const double own = value_with(t, state, states);
    return std::isfinite(M) && std::isfinite(own) ? M : own;
}

// False after Ctrl-C, which stops everything.
bool LuaFunction::may_go_on() {
    if (current == nullptr || interrupt_requested()) {
        return false;
    }
    current->failed_before_ = current->failed();
    current->failed_ = false;
    return true;
}

void LuaFunction::forget_failure() {
    if (current != nullptr) current->failed_before_ = false;
}

namespace {
struct Block {
    const LuaFunction* function;
    std::span<const double> times;
    std::span<double> out;
    std::size_t filled = 0;
};
}  // namespace

/// Fills the Block that it receives; returns nothing, or the first invalid result.
int LuaFunction::fill_protected(lua_State* L) {
    auto& block = *static_cast<Block*>(lua_touserdata(L, 1));
    block.function->push(L);
    for (; block.filled < block.times.size(); ++block.filled) {
        lua_pushvalue(L, 2);
        lua_pushnumber(L, block.times[block.filled]);
        lua_call(L, 1, 1);
        if (!block.function->is_good(L, block.out[block.filled])) {
            return 1;
        }
        lua_pop(L, 1);
    }
    return 0;
}

std::size_t LuaFunction::fill(std::span<const double> times, std::span<double> out) {
    CallState* call = current;
    if (call == nullptr || call->failed_ || feedback_) return model::UserFunction::fill(times, out);
    std::size_t filled = 0;
    if (model::Formula* read = formula(*call, times.size()); read != nullptr && fits({})) {
        for (; filled < times.size(); ++filled) {
            out[filled] = read->value(times[filled], {}, {});
            if (!is_allowed(out[filled]) || !agrees(out[filled], *call, times[filled], {}, {})) break;
        }
    }
    if (filled == times.size() || call->failed_) return filled;
    filled += evaluate(*call, times.subspan(filled), out.subspan(filled));
    if (!formula()) ++change_counter;
    return filled;
}

// One lua_pcall for the block: it costs as much as the call of a short function.
std::size_t LuaFunction::evaluate(CallState& call, std::span<const double> times, std::span<double> out) {
    lua_State* L = call.L_;
    Block block{this, times, out};
    const int top = lua_gettop(L);
    lua_pushcfunction(L, guarded<witness_error>);
    lua_pushcfunction(L, fill_protected);
    lua_pushlightuserdata(L, &block);
    const int status = lua_pcall(L, 1, LUA_MULTRET, top + 1);
    lua_remove(L, top + 1);
    if (lua_gettop(L) > top) {
        out[block.filled] = fail(call, status, times[block.filled]);
    }
    return block.filled;
}

/// Stores the invalid result or error value on the top of the stack.
double LuaFunction::fail(CallState& call, int status, double t) const {
    lua_State* L = call.L_;
    text::Error error;
    if (status == LUA_OK) {
        const bool is_number = lua_type(L, -1) == LUA_TNUMBER && std::isfinite(lua_tonumber(L, -1));
        error.sentence = fmt::format("{} returned {} at {} = {:.14g}; it must return a finite number{}", role_.name,
                                     is_number ? fmt::format("{:.6g}", lua_tonumber(L, -1)) : describe(L, -1),
                                     role_.argument, t, role_.may_be_negative ? "" : " that is not negative");
        error.culprit = written(L, -1);
    } else if (lua_type(L, -1) == LUA_TSTRING && is_about_yield(lua_tostring(L, -1))) {
        error.sentence =
            fmt::format("{} cannot yield, as it did at {} = {:.14g} (attempt to yield across a C-call boundary)",
                        role_.name, role_.argument, t);
        error.culprit = "yield";
    }
    if (!error.sentence.empty()) {
        push(L);
        const std::string message = definition(L) + error.message();
        lua_pop(L, 1);
        remember_facts(L, error);
        push(L);
        lua_pushlstring(L, message.data(), message.size());
        witness_result(L, -2);
        lua_remove(L, -2);
    } else {
        remember_argument(L, role_.name.c_str(), role_.argument, t);
    }
    call.keep_error_on_top();
    return failure;
}

}  // namespace dinal::lua
