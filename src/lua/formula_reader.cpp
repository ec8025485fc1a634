#include "lua/formula_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <tuple>

#include "lua/bind.hpp"
#include "lua/prototype.hpp"
#include "lua/standard_globals.hpp"
#include "model/formula.hpp"

namespace dinal::lua {
namespace {

using model::Op;

/// The opcodes in lopcodes.h of Lua 5.4, all 83.
enum class Code : std::uint32_t {
    move,
    loadi,
    loadf,
    loadk,
    loadkx,
    loadfalse,
    lfalseskip,
    loadtrue,
    loadnil,
    getupval,
    setupval,
    gettabup,
    gettable,
    geti,
    getfield,
    settabup,
    settable,
    seti,
    setfield,
    newtable,
    self,
    addi,
    addk,
    subk,
    mulk,
    modk,
    powk,
    divk,
    idivk,
    bandk,
    bork,
    bxork,
    shri,
    shli,
    add,
    sub,
    mul,
    mod,
    pow,
    div,
    idiv,
    band,
    bor,
    bxor,
    shl,
    shr,
    mmbin,
    mmbini,
    mmbink,
    unm,
    bnot,
    not_,
    len,
    concat,
    close,
    tbc,
    jmp,
    eq,
    lt,
    le,
    eqk,
    eqi,
    lti,
    lei,
    gti,
    gei,
    test,
    testset,
    call,
    tailcall,
    return_,
    return0,
    return1,
    forloop,
    forprep,
    tforprep,
    tforcall,
    tforloop,
    setlist,
    closure,
    vararg,
    varargprep,
    extraarg
};
static_assert(static_cast<int>(Code::extraarg) == 82);

struct Instruction {
    std::uint32_t bits;
    [[nodiscard]] Code code() const { return static_cast<Code>(bits & 0x7fU); }
    [[nodiscard]] int a() const { return static_cast<int>(bits >> 7U & 0xffU); }
    [[nodiscard]] int b() const { return static_cast<int>(bits >> 16U & 0xffU); }
    [[nodiscard]] int c() const { return static_cast<int>(bits >> 24U); }
    [[nodiscard]] bool k() const { return (bits >> 15U & 1U) != 0; }
    [[nodiscard]] int bx() const { return static_cast<int>(bits >> 15U); }
    [[nodiscard]] int signed_b() const { return b() - 127; }
    [[nodiscard]] int signed_c() const { return c() - 127; }
    [[nodiscard]] int signed_bx() const { return bx() - 65535; }
    [[nodiscard]] int jump() const { return static_cast<int>(bits >> 7U) - 16777215; }
};

std::uint64_t bits_of(double x) {
    return std::bit_cast<std::uint64_t>(x);
}

/// What the reader knows about a Lua register. A number that is not constant is in the formula's register with the same
/// index.
struct Known {
    enum class Kind : std::uint8_t { unknown, nil, no, yes, object, states, whole, number } kind = Kind::unknown;
    bool constant = true;
    double value = 0;  ///< of a constant number
    int object = 0;    ///< index in the list of values

    [[nodiscard]] bool is_number() const { return kind == Kind::whole || kind == Kind::number; }
    [[nodiscard]] bool is_false() const { return kind == Kind::nil || kind == Kind::no; }
    bool operator==(const Known& other) const {
        return same_type(other) && constant == other.constant && bits_of(value) == bits_of(other.value);
    }
    [[nodiscard]] bool same_type(const Known& other) const { return kind == other.kind && object == other.object; }
};
constexpr Known nil{.kind = Known::Kind::nil};
Known constant_number(double x) {
    return {.kind = Known::Kind::number, .value = x};
}

/// The code of one function.
struct Function {
    std::string dumped;
    Prototype code;
    std::string file;
    std::vector<bool> is_target;  ///< whether each instruction is the target of a jump, where branches may meet

    void note_targets() {
        const auto note = [this](std::size_t at) {
            if (at < is_target.size()) is_target[at] = true;
        };
        is_target.resize(code.size());
        for (std::size_t at = 0; at < code.size(); ++at) {
            const Instruction i{code.instruction(at)};
            const auto to = [&](int distance) { return at + 1 + static_cast<std::size_t>(distance); };
            if (i.code() == Code::jmp) note(to(i.jump()));
            if (i.code() == Code::forloop) note(to(0)), note(to(-i.bx()));
            if (i.code() == Code::forprep) note(to(i.bx() + 1));
            if (i.code() == Code::lfalseskip) note(to(1));
        }
    }
};

/// A `for` loop that is being unrolled.
struct Loop {
    int control;             ///< index of the first of its four registers
    std::size_t start, end;  ///< instruction after its preparation, and the one that jumps back
    std::size_t round = 0;
};

struct Frame {
    int closure;
    std::shared_ptr<const Function> function;
    std::size_t at = 0;
    std::size_t jumps_back = 0;  ///< number of backward jumps of other loops
    std::vector<Loop> loops = {};
    int base = 0, results = 1;
};

/// The reason why a function is not read.
struct Obstacle {
    std::string why;
};

Known constant_whole(lua_Integer x) {
    const auto value = static_cast<double>(x);
    if (!(std::fabs(value) < 0x1p53)) throw Obstacle{"it has a whole number beyond 2^53"};
    return {.kind = Known::Kind::whole, .value = value};
}

/// A branch of execution: its position in the code, and what is known there.
struct Way {
    std::vector<Frame> frames;
    std::vector<Known> registers;
    int top = 0;         ///< end of the values of an open list; 0: none
    int arguments = -1;  ///< number of arguments left of an unfinished call of math.max; -1: none

    Known& operator[](int i) {
        if (i < 0 || static_cast<std::size_t>(i) >= registers.size()) throw Obstacle{"its code is of another Lua"};
        return registers[static_cast<std::size_t>(i)];
    }
    /// Numbers that increase along every branch, to order positions: rounds within a loop, and instructions within a
    /// call before those after it.
    [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> place() const {
        std::vector<std::pair<std::size_t, std::size_t>> numbers;
        for (const Frame& frame : frames) {
            numbers.emplace_back(0, frame.jumps_back);
            for (const Loop& loop : frame.loops) numbers.emplace_back(loop.start, loop.round);
            numbers.emplace_back(frame.at, 0);
        }
        return numbers;
    }
    [[nodiscard]] bool is_before(const Way& other) const {
        const auto own = place(), others = other.place();
        const auto [a, b] = std::mismatch(own.begin(), own.end(), others.begin(), others.end());
        return a == own.end() || b == others.end() ? own.size() > others.size() : *a < *b;
    }
    [[nodiscard]] bool same_place(const Way& other) const {
        return top == other.top && arguments == other.arguments && place() == other.place() &&
               std::equal(frames.begin(), frames.end(), other.frames.begin(), other.frames.end(),
                          [](const Frame& a, const Frame& b) {
                              return std::tie(a.closure, a.base, a.results) == std::tie(b.closure, b.base, b.results);
                          });
    }
    [[nodiscard]] bool same_types(const Way& other) const {
        return std::equal(registers.begin(), registers.end(), other.registers.begin(), other.registers.end(),
                          [](const Known& a, const Known& b) { return a.same_type(b); });
    }
};

/// A jump target of a step that is not known yet.
struct Loose {
    std::size_t step;
    std::uint32_t model::Formula::Step::*field;
};
struct Waiting {
    Way way;
    std::vector<Loose> loose;
    bool settled = false;  ///< whether no other branch will be merged with it
};

// Registers of the formula: those of Lua, and the following kinds, which are numbered after them at the end.
constexpr int most_registers = 240, first_state = 0x1000, first_constant = 0x4000;
constexpr std::size_t most_steps = 3000, most_versions = 3, most_waiting = 200, deepest_calls = 30;
constexpr int most_followed = 20000;

/// In the order of Lua's instructions.
constexpr std::array<Op, 7> arithmetic_of = {Op::add,   Op::subtract, Op::multiply,    Op::modulo,
                                             Op::power, Op::divide,   Op::floor_divide};

/// Functions of Lua's libraries. Those of math without an operation are translated in library().
struct Standard {
    const char *module, *name;
    Op op = Op::fail;
};
constexpr Standard standard[] = {{"math", "sin", Op::sin},
                                 {"math", "cos", Op::cos},
                                 {"math", "tan", Op::tan},
                                 {"math", "asin", Op::asin},
                                 {"math", "acos", Op::acos},
                                 {"math", "exp", Op::exp},
                                 {"math", "log", Op::log},
                                 {"math", "sqrt", Op::sqrt},
                                 {"math", "abs", Op::abs},
                                 {"math", "floor", Op::floor},
                                 {"math", "ceil", Op::ceil},
                                 {"math", "max"},
                                 {"math", "min"},
                                 {"math", "fmod"},
                                 {"math", "atan"},
                                 {"math", "rad"},
                                 {"math", "deg"},
                                 {"math", "tointeger"},
                                 {nullptr, "error"},
                                 {nullptr, "assert"}};

class Reader {
public:
    /// Values from outside are stored in the table at index `values`, the top of the stack.
    Reader(lua_State* L, const Arguments& arguments, int values) : L_(L), arguments_(arguments), values_(values) {}

    Reading read(int index) {
        Reading reading;
        Way way;
        try {
            start(way, index);
            follow(std::move(way), {});
            while (!waiting_.empty()) follow_next();
            reading.formula = formula();
            if (reading.formula->moves_excitations()) {
                reading.formula.reset(), place_ = {};
                throw Obstacle{"it evaluates an excitation at a time that depends on the motion"};
            }
        } catch (const Obstacle& obstacle) {
            const auto& [function, at] = place_;
            const bool known = function != nullptr && at < function->code.lines.size();
            reading.obstacle =
                known ? fmt::format("{}:{}: {}", function->file, function->code.lines[at], obstacle.why) : obstacle.why;
        }
        reading.outside = std::move(outside_);
        reading.arguments = arguments_;
        return reading;
    }

private:
    // ---- values from outside

    /// Pops the value on the top of the stack and returns its index in the list of values.
    int keep() {
        const void* identity = lua_topointer(L_, -1);
        const auto known = kept_.find(identity);
        if (identity != nullptr && known != kept_.end()) {
            lua_pop(L_, 1);
            return known->second;
        }
        const int place = ++count_;
        lua_rawseti(L_, values_, place);
        if (identity != nullptr) kept_[identity] = place;
        return place;
    }
    int push_kept(int place) { return lua_rawgeti(L_, values_, place); }
    /// The value in this place of the list, as the content of a register.
    Known known(int place) {
        Known made{.kind = Known::Kind::object, .object = place};
        switch (push_kept(place)) {
            case LUA_TNIL:
                made = nil;
                break;
            case LUA_TBOOLEAN:
                made = {.kind = lua_toboolean(L_, -1) != 0 ? Known::Kind::yes : Known::Kind::no};
                break;
            case LUA_TNUMBER:
                made = lua_isinteger(L_, -1) != 0 ? constant_whole(lua_tointeger(L_, -1))
                                                  : constant_number(lua_tonumber(L_, -1));
                break;
            default:
                break;
        }
        lua_pop(L_, 1);
        return made;
    }
    Known outside(OutsideValue::Kind kind, int holder, std::int64_t key) {
        for (const OutsideValue& met : outside_) {
            if (met.kind == kind && met.holder == holder && met.key == key) return known(met.value);
        }
        const int type = push_kept(holder);
        lua_replace(L_, values_ + 1);
        lua_settop(L_, values_ + 1);
        // If an obstacle follows, the entry keeps the holder as its value. No look-up returns the holder, so the
        // reading is not reused although the obstacle may have disappeared.
        outside_.push_back({kind, holder, key, holder});
        if (kind != OutsideValue::Kind::variable && type != LUA_TTABLE)
            throw Obstacle{"it indexes a value that is not a table"};
        if (!push_outside(L_, values_, values_ + 1, kind, key))
            throw Obstacle{"it looks into a table with a metatable"};
        const int value = keep();
        lua_settop(L_, values_ + 1);
        outside_.back().value = value;
        return known(value);
    }

public:
    /// Pushes the value that the holder at the index has under this key, also through metatables that are tables.
    /// Returns false if a metamethod would decide.
    static bool push_outside(lua_State* L, int values, int holder, OutsideValue::Kind kind, std::int64_t key) {
        if (kind == OutsideValue::Kind::variable) return lua_getupvalue(L, holder, static_cast<int>(key)) != nullptr;
        if (kind == OutsideValue::Kind::length) {
            lua_pushinteger(L, static_cast<lua_Integer>(lua_rawlen(L, holder)));
            return luaL_getmetafield(L, holder, "__len") == LUA_TNIL;
        }
        for (int depth = 0; depth < 4 && lua_istable(L, holder); ++depth) {
            kind == OutsideValue::Kind::field ? lua_rawgeti(L, values, key) : (lua_pushinteger(L, key), 0);
            if (lua_rawget(L, holder) != LUA_TNIL) return true;
            if (luaL_getmetafield(L, holder, "__index") == LUA_TNIL) return true;
            holder = lua_gettop(L);
        }
        return false;
    }

private:
    Known element(const Known& table, const Known& key) {
        if (table.kind != Known::Kind::object) throw Obstacle{"it indexes a value that is not a table"};
        if (key.kind == Known::Kind::object) {
            const bool is_text = push_kept(key.object) == LUA_TSTRING;
            lua_pop(L_, 1);
            if (is_text) return outside(OutsideValue::Kind::field, table.object, key.object);
        }
        if (key.is_number() && key.constant) {
            if (key.value == std::floor(key.value) && std::fabs(key.value) < 0x1p53) {
                return outside(OutsideValue::Kind::element, table.object, static_cast<std::int64_t>(key.value));
            }
        }
        throw Obstacle{"it looks up a place in a table that is not known beforehand"};
    }
    Known text(std::string_view word) {
        lua_pushlstring(L_, word.data(), word.size());
        const int place = keep();
        return {.kind = Known::Kind::object, .object = place};
    }
    Known constant(const Function& function, int number) {
        const auto place = static_cast<std::size_t>(number);
        if (place >= function.code.constants.size()) throw Obstacle{"its code is of another Lua"};
        const Prototype::Constant& found = function.code.constants[place];
        double value = 0;
        if (found.number.size() == sizeof value) std::memcpy(&value, found.number.data(), sizeof value);
        switch (found.type) {
            case Prototype::integer_number:
                return constant_whole(std::bit_cast<lua_Integer>(value));
            case Prototype::float_number:
                return constant_number(value);
            case Prototype::no:
                return {.kind = Known::Kind::no};
            case Prototype::yes:
                return {.kind = Known::Kind::yes};
            case Prototype::short_text:
            case Prototype::long_text:
                return text(found.text);
            default:
                return nil;
        }
    }

    // ---- steps of the formula

    std::size_t emit(Op op, int to, int a, int b) {
        if (steps_.size() >= most_steps) throw Obstacle{"it is too long"};
        steps_.push_back(
            {op, static_cast<std::uint16_t>(to), static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b)});
        return steps_.size() - 1;
    }
    int constant_register(double value) {
        const auto [place, is_new] = constant_places_.try_emplace(bits_of(value), first_constant + constants_.size());
        if (is_new) constants_.push_back(value);
        return static_cast<int>(place->second);
    }
    /// Returns the register of a number: that of the constant, or `place`.
    int register_of(const Known& known, int place) {
        if (!known.is_number()) throw Obstacle{"it calculates with a value that is not a number"};
        return known.constant ? constant_register(known.value) : place;
    }
    /// Stores the result of the operation in the register; operations on constants are evaluated here.
    void calculate(Way& way, Op op, int to, int a, int b, Known::Kind kind) {
        const bool whole = kind == Known::Kind::whole;
        if (a >= first_constant && b >= first_constant) {
            Known made{.kind = kind};
            const bool good = model::apply(op, constant_in(a), constant_in(b), made.value);
            if (!good || (whole && !model::apply(Op::exact, made.value, made.value, made.value)))
                throw Obstacle{"it divides by zero, or has a whole number beyond 2^53"};
            way[to] = made;
            return;
        }
        emit(op, to, a, b);
        if (whole && op != Op::floor && op != Op::ceil) emit(Op::exact, to, to, to);
        way[to] = {.kind = kind, .constant = false};
    }
    double constant_in(int place) const { return constants_[static_cast<std::size_t>(place - first_constant)]; }
    void copy(Way& way, int to, int from) {
        const Known known = way[from];
        if (!known.constant && to != from) emit(Op::move, to, from, from);
        way[to] = known;
    }

    struct Operand {
        Known known;
        int place;
    };
    void arithmetic(Way& way, std::size_t which, int to, const Operand& x, const Operand& y) {
        const Op op = arithmetic_of[which];
        const bool whole = x.known.kind == Known::Kind::whole && y.known.kind == Known::Kind::whole &&
                           op != Op::power && op != Op::divide;
        calculate(way, op, to, register_of(x.known, x.place), register_of(y.known, y.place),
                  whole ? Known::Kind::whole : Known::Kind::number);
    }

    // ---- conditions

    /// A comparison that is decided while reading, or the step that decides it at run time.
    struct Condition {
        std::optional<bool> decided;
        std::size_t step = 0;
    };
    Condition compare(Op op, const Operand& x, const Operand& y) {
        if (!x.known.is_number() || !y.known.is_number()) {
            if (op != Op::equal) throw Obstacle{"it compares values that are not numbers"};
            return {equal_objects(x.known, y.known)};
        }
        double unused = 0;
        if (x.known.constant && y.known.constant) return {model::apply(op, x.known.value, y.known.value, unused)};
        return {std::nullopt, emit(op, 0, register_of(x.known, x.place), register_of(y.known, y.place))};
    }
    bool equal_objects(const Known& x, const Known& y) {
        if (x.kind != y.kind) return false;
        if (x.kind != Known::Kind::object || x.object == y.object) return true;
        const bool texts = push_kept(x.object) == LUA_TSTRING && push_kept(y.object) == LUA_TSTRING;
        // Lua keeps one copy of a short string, but may have several of a long one.
        const bool same = texts && lua_rawequal(L_, -1, -2) != 0;
        lua_settop(L_, values_ + 1);
        if (!texts) throw Obstacle{"it compares tables"};
        return same;
    }
    void jump(Way& way) {
        Frame& frame = way.frames.back();
        const Instruction next{frame.function->code.instruction(frame.at)};
        const int distance = next.jump();
        if (distance < 0) ++frame.jumps_back;
        frame.at += 1 + static_cast<std::size_t>(distance);
    }
    void take(Way& way, bool jumps) { jumps ? jump(way) : static_cast<void>(++way.frames.back().at); }
    /// Takes the jump that follows if the condition is `wanted`. If it is not decided, both branches wait, and the
    /// result is false.
    bool branch_on(Way& way, const Condition& condition, bool wanted) {
        if (condition.decided) {
            take(way, *condition.decided == wanted);
            return true;
        }
        Way other = way;
        take(way, wanted);
        take(other, !wanted);
        wait(std::move(way), {{condition.step, &model::Formula::Step::yes}});
        wait(std::move(other), {{condition.step, &model::Formula::Step::no}});
        return false;
    }
    void wait(Way way, std::vector<Loose> loose) {
        if (waiting_.size() >= most_waiting) throw Obstacle{"it has too many cases"};
        leave_loops(way);
        waiting_.push_back({std::move(way), std::move(loose)});
    }

    // ---- branches

    void land(const std::vector<Loose>& loose) {
        const bool here = loose.size() == 1 && loose[0].step + 1 == steps_.size() && steps_.back().op == Op::jump;
        if (here) return steps_.pop_back();
        for (const Loose& end : loose) steps_[end.step].*end.field = static_cast<std::uint32_t>(steps_.size());
    }
    std::vector<Loose> jump_from_here() { return {{emit(Op::jump, 0, 0, 0), &model::Formula::Step::yes}}; }

    /// Continues the earliest waiting branch. Branches at the same position are merged first if they are equal, or too
    /// many.
    void follow_next() {
        const auto first = std::min_element(waiting_.begin(), waiting_.end(),
                                            [](const Waiting& a, const Waiting& b) { return a.way.is_before(b.way); });
        if (!first->settled) {
            std::vector<Waiting> here{std::move(*first)};
            waiting_.erase(first);
            for (std::size_t i = 0; i < waiting_.size();) {
                if (waiting_[i].way.same_place(here.front().way)) {
                    here.push_back(std::move(waiting_[i]));
                    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
                } else {
                    ++i;
                }
            }
            unite(here);
            if (here.size() > most_versions) generalise(here);
            for (Waiting& one : here) one.settled = true;
            waiting_.insert(waiting_.begin(), std::make_move_iterator(here.begin()),
                            std::make_move_iterator(here.end()));
            return;
        }
        Waiting next = std::move(*first);
        waiting_.erase(first);
        follow(std::move(next.way), next.loose);
    }
    static void unite(std::vector<Waiting>& here) {
        for (std::size_t i = 0; i < here.size(); ++i) {
            for (std::size_t j = i + 1; j < here.size();) {
                if (here[i].way.registers == here[j].way.registers) {
                    here[i].loose.insert(here[i].loose.end(), here[j].loose.begin(), here[j].loose.end());
                    here.erase(here.begin() + static_cast<std::ptrdiff_t>(j));
                } else {
                    ++j;
                }
            }
        }
    }
    /// Merges branches by moving constants that differ into registers.
    void generalise(std::vector<Waiting>& here) {
        std::vector<Waiting> general;
        for (const Waiting& one : here) {
            const auto same = std::find_if(general.begin(), general.end(),
                                           [&](const Waiting& g) { return g.way.same_types(one.way); });
            if (same == general.end()) {
                general.push_back({one.way, {}});
                continue;
            }
            for (std::size_t i = 0; i < one.way.registers.size(); ++i) {
                Known& joined = same->way.registers[i];
                if (!(joined == one.way.registers[i])) joined.constant = false, joined.value = 0;
            }
        }
        for (const Waiting& one : here) {
            Waiting& same = *std::find_if(general.begin(), general.end(),
                                          [&](const Waiting& g) { return g.way.same_types(one.way); });
            land(one.loose);
            for (std::size_t i = 0; i < one.way.registers.size(); ++i) {
                const Known& own = one.way.registers[i];
                if (!own.constant || same.way.registers[i].constant) continue;
                const int from = constant_register(own.value);
                emit(Op::move, static_cast<int>(i), from, from);
            }
            const auto loose = jump_from_here();
            same.loose.insert(same.loose.end(), loose.begin(), loose.end());
        }
        here = std::move(general);
    }

    // ---- calls

    std::shared_ptr<const Function> function_at(int place) {
        push_kept(place);
        auto& known = functions_[place];
        if (known == nullptr) {
            auto made = std::make_shared<Function>();
            made->dumped = dumped_function(L_, -1);
            auto code = prototype_in(made->dumped);
            if (!code || code->lines.size() != code->size()) throw Obstacle{"its code is of another Lua"};
            made->code = std::move(*code);
            made->note_targets();
            lua_Debug about{};
            lua_pushvalue(L_, -1);
            lua_getinfo(L_, ">S", &about);
            made->file = static_cast<const char*>(about.short_src);
            known = std::move(made);
        }
        lua_pop(L_, 1);
        return known;
    }
    /// Enters a Lua function with this number of arguments, which begin at register `base`.
    void enter(Way& way, int closure, int base, int arguments, int results) {
        Frame frame{.closure = closure, .function = function_at(closure), .base = base, .results = results};
        const Prototype& code = frame.function->code;
        if (way.frames.empty()) place_ = {frame.function, 0};
        if (code.frame[1] != 0) throw Obstacle{"it takes any number of arguments (...)"};
        const int parameters = static_cast<std::uint8_t>(code.frame[0]),
                  size = static_cast<std::uint8_t>(code.frame[2]);
        if (base + size > most_registers || way.frames.size() >= deepest_calls) throw Obstacle{"it calls too deep"};
        way.registers.resize(static_cast<std::size_t>(std::max(base + size, base + parameters)));
        used_ = std::max(used_, static_cast<int>(way.registers.size()));
        for (int i = arguments; i < parameters; ++i) way[base + i] = nil;
        for (int i = parameters; i < size; ++i) way[base + i] = {};
        way.frames.push_back(std::move(frame));
    }
    void start(Way& way, int index) {
        lua_pushvalue(L_, index);
        lua_insert(L_, values_ + 1);
        lua_settop(L_, values_ + 1);
        if (lua_type(L_, -1) != LUA_TFUNCTION || lua_iscfunction(L_, -1) != 0)
            throw Obstacle{"it is not a Lua function"};
        lua_pushvalue(L_, -1);
        const int closure = keep();
        const int before = arguments_.of_speed ? 1 : 0, count = before + arguments_.count;
        const Known number{.kind = Known::Kind::number, .constant = false};
        way.registers.resize(5);
        way[0] = number;
        for (int i = 0; i < arguments_.count; ++i) {
            const bool table = i == 3 || (i > 0 && !arguments_.bodies.empty());
            way[before + i] = table ? Known{.kind = Known::Kind::states, .object = i % 3} : number;
        }
        if (arguments_.of_speed) {  // t, theta and velocity move up to make room for the speed
            used_ = 4;
            for (const int i : {3, 2, 1}) emit(Op::move, i, i - 1, i - 1);
            emit(Op::move, 0, first_state, first_state);
        }
        enter(way, closure, 0, count, 1);
    }
    /// Returns from the innermost function with `count` values that begin at register `from`.
    void leave(Way& way, int from, int count) {
        const Frame left = way.frames.back();
        if (way.frames.size() == 1) {
            const Known given = count > 0 ? way[from] : nil;
            const int place = given.is_number() ? register_of(given, from) : 0;
            emit(given.is_number() ? Op::give : Op::fail, 0, place, place);
            way.frames.clear();
            return;
        }
        const int function = left.base - 1;
        for (int i = 0; i < count; ++i) copy(way, function + i, from + i);
        way.frames.pop_back();
        deliver(way, function, count, left.results);
    }
    /// Adjusts `count` results from register `place` on to the `wanted` number; -1: all.
    void deliver(Way& way, int place, int count, int wanted) {
        const Frame& frame = way.frames.back();
        const int size = frame.base + static_cast<std::uint8_t>(frame.function->code.frame[2]);
        way.top = wanted < 0 ? place + count : 0;
        way.registers.resize(static_cast<std::size_t>(std::max(size, place + std::max(count, wanted))));
        for (int i = count; i < wanted; ++i) way[place + i] = nil;
        const int first_free = place + (wanted < 0 ? count : wanted);
        for (auto i = static_cast<std::size_t>(first_free); i < way.registers.size(); ++i) {
            way.registers[i] = {};
        }
    }

    /// Translates a call. Returns false if the branch has ended or waits.
    bool call(Way& way, int function, int arguments, int results) {
        const Known called = way[function];
        if (const model::Excitation* excitation = excitation_at(called)) {
            return evaluate(way, *excitation, function, arguments, results);
        }
        if (called.kind != Known::Kind::object || push_kept(called.object) != LUA_TFUNCTION) {
            throw Obstacle{"it calls a value that is not a function"};
        }
        const bool of_lua = lua_iscfunction(L_, -1) == 0;
        lua_pop(L_, 1);
        if (of_lua) {
            enter(way, called.object, function + 1, arguments, results);
            return true;
        }
        const Standard* found = standard_at(called.object);
        if (found == nullptr) throw Obstacle{"it calls a function that is not written in Lua" + name_of(way)};
        const std::string_view name = found->name;
        if (found->module == nullptr) {
            if (name == "error" || arguments < 1 || way[function + 1].is_false()) {
                emit(Op::fail, 0, 0, 0);
                way.frames.clear();
                return false;
            }
            for (int i = 0; i < arguments; ++i) copy(way, function + i, function + 1 + i);
            deliver(way, function, arguments, results);
            return true;
        }
        if (arguments < 1) throw Obstacle{fmt::format("it calls math.{} without a number", name)};
        if (found->op == Op::fail) return library(way, name, function, arguments, results);
        if (found->op == Op::log && arguments == 2) return logarithm(way, function, results);
        one_argument(way, found->op, function);
        deliver(way, function, 1, results);
        return true;
    }
    /// The excitation if the object is one, otherwise null.
    const model::Excitation* excitation_at(const Known& known) {
        if (known.kind != Known::Kind::object) return nullptr;
        push_kept(known.object);
        const auto* found = test<model::Excitation>(L_, -1);
        lua_pop(L_, 1);
        return found;
    }
    /// Translates e(t) or e:value(t), whose arguments follow the register `function`.
    bool evaluate(Way& way, const model::Excitation& excitation, int function, int arguments, int results) {
        const bool by_name = arguments > 0 && way[function + 1] == way[function];
        const int time = function + (by_name ? 2 : 1);
        if (arguments != time - function) throw Obstacle{"it evaluates an excitation with more than the time"};
        if (excitation.has_script()) throw Obstacle{"it evaluates an excitation that has a function in it"};
        int& own = excitation_registers_[way[function].object];
        if (own == 0) {
            excitations_.push_back(std::make_shared<const model::Excitation>(excitation));
            own = constant_register(model::from_excitation(*excitations_.back()));
        }
        calculate(way, Op::native, function, register_of(way[time], time), own, Known::Kind::number);
        deliver(way, function, 1, results);
        return true;
    }
    /// " (print)", the name under which the function was looked up, if known.
    static std::string name_of(const Way& way) {
        const Frame& frame = way.frames.back();
        for (std::size_t at = frame.at; at-- > 0;) {
            const Instruction i{frame.function->code.instruction(at)};
            const bool by_name = i.code() == Code::gettabup || i.code() == Code::getfield;
            const bool is_call = i.code() == Code::call || i.code() == Code::tailcall;
            if (is_call && at + 1 != frame.at) break;
            const bool same = i.a() == Instruction{frame.function->code.instruction(frame.at - 1)}.a();
            const auto& constants = frame.function->code.constants;
            const auto place = static_cast<std::size_t>(i.c());
            if (by_name && same && place < constants.size()) return fmt::format(" ({})", constants[place].text);
        }
        return "";
    }
    /// Returns the entry of a library function if it is unchanged since the start; null for any other object.
    const Standard* standard_at(int object) {
        const auto [place, is_new] = standards_.try_emplace(object, nullptr);
        for (const Standard& one : standard) {
            if (!is_new || place->second != nullptr) break;
            push_standard_globals(L_);
            if (one.module != nullptr && lua_istable(L_, -1)) {
                push_standard_fields(L_);
                lua_getfield(L_, -2, one.module);
                lua_rawget(L_, -2);
            }
            if (lua_istable(L_, -1)) {
                push_field(L_, -1, one.name);
                push_kept(object);
                if (lua_rawequal(L_, -1, -2) != 0) place->second = &one;
            }
            lua_settop(L_, values_ + 1);
        }
        return place->second;
    }
    void one_argument(Way& way, Op op, int function) {
        const int from = function + 1, place = register_of(way[from], from);
        const bool rounds = op == Op::floor || op == Op::ceil, whole = way[from].kind == Known::Kind::whole;
        if (rounds && whole) return copy(way, function, from);
        calculate(way, op, function, place, place,
                  rounds || (whole && op == Op::abs) ? Known::Kind::whole : Known::Kind::number);
    }
    bool logarithm(Way& way, int function, int results) {
        const Known base = way[function + 2];
        const int below = register_of(base, function + 2);
        const bool known = base.constant && (base.value == 2 || base.value == 10);
        one_argument(way, known ? (base.value == 2 ? Op::log2 : Op::log10) : Op::log, function);
        if (!known) {
            const Known top = way[function];
            calculate(way, Op::log, function + 1, below, below, Known::Kind::number);
            arithmetic(way, 5, function, {top, function}, {way[function + 1], function + 1});
        }
        deliver(way, function, 1, results);
        return true;
    }
    bool library(Way& way, std::string_view name, int function, int arguments, int results) {
        const int first = function + 1, second = function + 2;
        const Known x = way[first];
        const int a = register_of(x, first);
        if (name == "max" || name == "min") {
            if (arguments == 1) {
                copy(way, function, first);
            } else {
                register_of(way[second], second);
                return choose(way, name == "max", function, arguments, results);
            }
        } else if (name == "atan" || name == "fmod") {
            const Known y = arguments > 1 ? way[second] : name == "atan" ? constant_number(1) : nil;
            if (name == "fmod" && x.kind == Known::Kind::whole && y.kind == Known::Kind::whole) {
                throw Obstacle{"it calls math.fmod with whole numbers"};
            }
            calculate(way, name == "atan" ? Op::atan2 : Op::fmod, function, a, register_of(y, second),
                      Known::Kind::number);
        } else if (name == "tointeger") {
            if (x.kind != Known::Kind::whole) throw Obstacle{"it calls math.tointeger with a float"};
            copy(way, function, first);
        } else {
            constexpr double pi = 3.141592653589793238462643383279502884;
            const double unit = name == "rad" ? pi / 180.0 : 180.0 / pi;
            arithmetic(way, 2, function, {x, first}, {constant_number(unit), 0});
        }
        deliver(way, function, 1, results);
        return true;
    }
    /// Translates one step of math.max or math.min: the first two arguments are replaced by the greater or the smaller.
    /// Returns false if both branches wait.
    bool choose(Way& way, bool greatest, int function, int arguments, int results) {
        const int first = function + 1, second = function + 2;
        const Operand x{way[first], first}, y{way[second], second};
        const Condition second_wins = greatest ? compare(Op::less, x, y) : compare(Op::less, y, x);
        const auto take_winner = [&](Way& chosen, int winner) {
            copy(chosen, first, winner);
            for (int i = 2; i < arguments; ++i) copy(chosen, function + i, function + i + 1);
            if (arguments == 2) {
                copy(chosen, function, first);
                deliver(chosen, function, 1, results);
            } else {
                chosen.arguments = arguments - 1;
                --chosen.frames.back().at;
            }
        };
        if (second_wins.decided) {
            take_winner(way, *second_wins.decided ? second : first);
            return true;
        }
        for (const auto field : {&model::Formula::Step::yes, &model::Formula::Step::no}) {
            Way chosen = way;
            land({{second_wins.step, field}});
            take_winner(chosen, field == &model::Formula::Step::yes ? second : first);
            wait(std::move(chosen), jump_from_here());
        }
        way.frames.clear();
        return false;
    }

    // ---- loops

    /// Prepares a loop with constant bounds. Returns false if it has no rounds.
    static bool prepare(Way& way, int a) {
        for (int i = 0; i < 3; ++i) {
            if (!way[a + i].is_number() || !way[a + i].constant) throw Obstacle{"its loop has no constant bounds"};
        }
        const Known start = way[a], limit = way[a + 1], step = way[a + 2];
        if (start.kind != Known::Kind::whole || limit.kind != Known::Kind::whole || step.kind != Known::Kind::whole) {
            throw Obstacle{"its loop does not count in whole numbers"};
        }
        const double from = start.value, to = limit.value, by = step.value;
        if (by == 0) throw Obstacle{"its loop has the step 0"};
        if (by > 0 ? from > to : from < to) return false;
        way[a + 1].value = std::floor((to - from) / by);
        way[a + 3] = start;
        return true;
    }
    static bool loops(Way& way, int a) {
        if (!way[a].constant || !way[a + 1].constant) throw Obstacle{"its loop has no constant bounds"};
        if (way[a + 1].value == 0) return false;
        --way[a + 1].value;
        way[a].value += way[a + 2].value;
        way[a + 3] = way[a];
        return true;
    }

    // ---- instructions

    void follow(Way way, const std::vector<Loose>& loose) {
        if (!loose.empty()) land(loose);
        for (bool first = true;; first = false) {
            if (++followed_ > most_followed) throw Obstacle{"it is too long"};
            const Frame& frame = way.frames.back();
            leave_loops(way);
            if (frame.at >= frame.function->code.size()) throw Obstacle{"its code is of another Lua"};
            if (!first && !waiting_.empty() && (frame.function->is_target[frame.at] || has_returned_)) {
                has_returned_ = false;
                return wait(std::move(way), jump_from_here());
            }
            has_returned_ = false;
            place_ = {frame.function, frame.at};
            if (!step(way)) return;
        }
    }

    /// Clears the registers of loops that have ended.
    static void leave_loops(Way& way) {
        Frame& frame = way.frames.back();
        while (!frame.loops.empty() && frame.at > frame.loops.back().end) {
            for (int i = 0; i < 4; ++i) way[frame.loops.back().control + i] = {};
            frame.loops.pop_back();
        }
    }

    [[noreturn]] static void refuse(Code code) {
        using enum Code;
        switch (code) {
            case setupval:
                throw Obstacle{"it assigns to a variable outside of it"};
            case settabup:
                throw Obstacle{"it assigns to a global"};
            case settable:
            case seti:
            case setfield:
                throw Obstacle{"it writes into a table"};
            case newtable:
                throw Obstacle{"it makes a table"};
            case self:
                throw Obstacle{"it calls a method"};
            case concat:
            case len:
                throw Obstacle{"it works with text"};
            case closure:
                throw Obstacle{"it makes a function"};
            case tforprep:
                throw Obstacle{"it goes through a table with pairs or ipairs"};
            default:
                throw Obstacle{"it does what only Lua can do"};
        }
    }

    /// An instruction and its operands.
    struct Decoded {
        Way& way;
        const Function& function;
        Instruction i;
        std::size_t& at;  ///< index of the next instruction
        int closure, a, b, c;

        [[nodiscard]] Operand in_register(int place) const { return {way[place], place}; }
    };
    static Decoded decoded(Way& way, const Function& function) {
        Frame& frame = way.frames.back();
        const Instruction i{function.code.instruction(frame.at++)};
        const int base = frame.base;
        return {way, function, i, frame.at, frame.closure, base + i.a(), base + i.b(), base + i.c()};
    }
    Operand constant_of(const Decoded& now, int number) { return {constant(now.function, number), 0}; }
    static Operand immediate(int value) { return {constant_whole(value), 0}; }

    /// Translates one instruction. Returns false if the branch has ended or waits.
    bool step(Way& way) {
        using enum Code;
        const std::shared_ptr<const Function> function = way.frames.back().function;
        const Decoded now = decoded(way, *function);
        if (load(now) || look_up(now) || do_arithmetic(now) || branch(now)) return true;
        const auto& [i, a] = std::tie(now.i, now.a);
        if (const auto condition = comparison(now)) return branch_on(way, *condition, i.k());
        switch (const Code code = i.code()) {
            case Code::call:
            case tailcall: {
                const int given = way.arguments >= 0 ? way.arguments : i.b() > 0 ? i.b() - 1 : way.top - a - 1;
                way.arguments = -1;
                return this->call(way, a, given, code == tailcall ? -1 : i.c() - 1);
            }
            case return_:
                return leaves(way, a, i.b() > 0 ? i.b() - 1 : way.top - a);
            case return0:
                return leaves(way, a, 0);
            case return1:
                return leaves(way, a, 1);
            default:
                refuse(code);
        }
    }

    // Each of the following functions translates instructions of one kind, and returns false for any other.

    /// Puts constants into registers, or copies one register.
    bool load(const Decoded& now) {
        using enum Code;
        const auto& [way, i, a] = std::tie(now.way, now.i, now.a);
        switch (i.code()) {
            case move:
                copy(way, a, now.b);
                return true;
            case loadi:
                way[a] = constant_whole(i.signed_bx());
                return true;
            case loadf:
                way[a] = constant_number(i.signed_bx());
                return true;
            case loadk:
                way[a] = constant(now.function, i.bx());
                return true;
            case loadfalse:
                way[a] = {.kind = Known::Kind::no};
                return true;
            case lfalseskip:
                way[a] = {.kind = Known::Kind::no};
                ++now.at;
                return true;
            case loadtrue:
                way[a] = {.kind = Known::Kind::yes};
                return true;
            case loadnil:
                for (int j = 0; j <= i.b(); ++j) way[a + j] = nil;
                return true;
            default:
                return false;
        }
    }

    /// Reads variables from outside, and tables.
    bool look_up(const Decoded& now) {
        using enum Code;
        const auto& [way, i, a, b] = std::tie(now.way, now.i, now.a, now.b);
        switch (i.code()) {
            case getupval:
                way[a] = outside(OutsideValue::Kind::variable, now.closure, i.b() + 1);
                return true;
            case gettabup:
                way[a] = element(outside(OutsideValue::Kind::variable, now.closure, i.b() + 1),
                                 constant(now.function, i.c()));
                return true;
            case gettable:
                field(way, a, b, way[now.c]);
                return true;
            case geti:
                way[a] = element(way[b], constant_whole(i.c()));
                return true;
            case getfield:
                field(way, a, b, constant(now.function, i.c()));
                return true;
            case self: {
                // The excitation stands for its method, which receives the excitation again as argument.
                const Known name = i.k() ? constant(now.function, i.c()) : way[now.c], own = way[b];
                if (excitation_at(own) == nullptr || !(name == text("value"))) refuse(self);
                way[a] = way[a + 1] = own;
                return true;
            }
            case len:
                if (way[b].kind != Known::Kind::object) refuse(len);
                way[a] = outside(OutsideValue::Kind::length, way[b].object, 0);
                return true;
            default:
                return false;
        }
    }

    /// Arithmetic and negation. Binary operations are followed by an instruction for values that are not numbers, which
    /// is skipped.
    bool do_arithmetic(const Decoded& now) {
        using enum Code;
        const auto& [way, i, a, b] = std::tie(now.way, now.i, now.a, now.b);
        const auto behind = [&now](Code first) {
            return static_cast<std::size_t>(now.i.code()) - static_cast<std::size_t>(first);
        };
        switch (i.code()) {
            case addi:
                arithmetic(way, 0, a, now.in_register(b), immediate(i.signed_c()));
                ++now.at;
                return true;
            case addk:
            case subk:
            case mulk:
            case modk:
            case powk:
            case divk:
            case idivk:
                arithmetic(way, behind(addk), a, now.in_register(b), constant_of(now, i.c()));
                ++now.at;
                return true;
            case add:
            case sub:
            case mul:
            case mod:
            case pow:
            case div:
            case idiv:
                arithmetic(way, behind(add), a, now.in_register(b), now.in_register(now.c));
                ++now.at;
                return true;
            case unm: {
                const int from = register_of(way[b], b);
                calculate(way, Op::negate, a, from, from, way[b].kind);
                return true;
            }
            case not_:
                need_decided(way[b]);
                way[a] = {.kind = way[b].is_false() ? Known::Kind::yes : Known::Kind::no};
                return true;
            default:
                return false;
        }
    }

    /// Jumps, tests of one value, and `for` loops.
    bool branch(const Decoded& now) {
        using enum Code;
        const auto& [way, i, a, b] = std::tie(now.way, now.i, now.a, now.b);
        std::size_t& at = now.at;
        switch (i.code()) {
            case close:
                return true;
            case jmp:
                --at;
                jump(way);
                return true;
            case test:
                need_decided(way[a]);
                take(way, way[a].is_false() != i.k());
                return true;
            case testset:
                need_decided(way[b]);
                if (way[b].is_false() == i.k()) {
                    ++at;
                } else {
                    copy(way, a, b);
                    take(way, true);
                }
                return true;
            case forprep: {
                const std::size_t start = at, end = at + static_cast<std::size_t>(i.bx());
                if (prepare(way, a)) {
                    way.frames.back().loops.push_back({a, start, end});
                } else {
                    at = end + 1;
                }
                return true;
            }
            case forloop:
                if (loops(way, a)) at -= static_cast<std::size_t>(i.bx()), ++way.frames.back().loops.back().round;
                return true;
            default:
                return false;
        }
    }

    /// The condition of an instruction that compares two values; empty for any other.
    std::optional<Condition> comparison(const Decoded& now) {
        using enum Code;
        const auto& [i, a, b] = std::tie(now.i, now.a, now.b);
        switch (i.code()) {
            case eq:
                return compare(Op::equal, now.in_register(a), now.in_register(b));
            case lt:
                return compare(Op::less, now.in_register(a), now.in_register(b));
            case le:
                return compare(Op::less_equal, now.in_register(a), now.in_register(b));
            case eqk:
                return compare(Op::equal, now.in_register(a), constant_of(now, i.b()));
            case eqi:
                return compare(Op::equal, now.in_register(a), immediate(i.signed_b()));
            case lti:
                return compare(Op::less, now.in_register(a), immediate(i.signed_b()));
            case lei:
                return compare(Op::less_equal, now.in_register(a), immediate(i.signed_b()));
            case gti:
                return compare(Op::less, immediate(i.signed_b()), now.in_register(a));
            case gei:
                return compare(Op::less_equal, immediate(i.signed_b()), now.in_register(a));
            default:
                return std::nullopt;
        }
    }

    static void need_decided(const Known& known) {
        if (known.kind == Known::Kind::unknown) throw Obstacle{"it uses a variable without a value"};
    }
    bool leaves(Way& way, int from, int count) {
        leave(way, from, count);
        has_returned_ = !way.frames.empty();
        return has_returned_;
    }
    void field(Way& way, int a, int b, const Known& name) {
        if (way[b].kind != Known::Kind::states) {
            way[a] = element(way[b], name);
            return;
        }
        if (name.kind != Known::Kind::object)
            throw Obstacle{"it reads a state or a body by something else than a name"};
        push_kept(name.object);
        const char* text = lua_tostring(L_, -1);
        const int table = way[b].object;  // 0: states, 1: theta, 2: velocity
        const std::vector<std::string>& names = table == 0 ? arguments_.states : arguments_.bodies;
        const auto found = std::find(names.begin(), names.end(), text == nullptr ? "" : text);
        lua_pop(L_, 1);
        if (found == names.end()) throw Obstacle{"it reads a state or a body that does not exist"};
        const std::size_t tables_before = table == 0 ? 2 : static_cast<std::size_t>(table - 1);
        const int state = first_state + (arguments_.of_speed ? 1 : 0) +
                          static_cast<int>(tables_before * arguments_.bodies.size()) +
                          static_cast<int>(found - names.begin());
        emit(Op::move, a, state, state);
        way[a] = {.kind = Known::Kind::number, .constant = false};
    }

    // ---- the resulting formula

    model::Formula formula() {
        const std::size_t states = arguments_.state_count();
        const bool motion = arguments_.count >= 3 && arguments_.bodies.empty();
        const auto used = static_cast<std::size_t>(std::max(used_, 3));
        std::vector<double> registers(used + states);
        registers.insert(registers.end(), constants_.begin(), constants_.end());
        const auto placed = [&](std::uint16_t place) -> std::uint16_t {
            if (place >= first_constant) return static_cast<std::uint16_t>(used + states + place - first_constant);
            if (place >= first_state) return static_cast<std::uint16_t>(used + place - first_state);
            return place;
        };
        for (auto& step : steps_) step.to = placed(step.to), step.a = placed(step.a), step.b = placed(step.b);
        return {std::move(steps_),   std::move(registers),   motion, used, states,
                arguments_.timeless, std::move(excitations_)};
    }

    lua_State* L_;
    const Arguments& arguments_;
    int values_, count_ = 0;
    std::map<const void*, int> kept_;
    std::vector<OutsideValue> outside_;
    std::map<int, std::shared_ptr<const Function>> functions_;
    std::map<int, const Standard*> standards_;
    std::vector<Waiting> waiting_;
    std::vector<model::Formula::Step> steps_;
    std::vector<double> constants_;
    model::Formula::Excitations excitations_;
    std::map<int, int> excitation_registers_;  ///< by index in the list of values
    std::map<std::uint64_t, std::size_t> constant_places_;
    int used_ = 0, followed_ = 0;
    bool has_returned_ = false;
    std::pair<std::shared_ptr<const Function>, std::size_t> place_;
};

/// Returns whether the two values on the top have the same type and bits.
bool is_same(lua_State* L) {
    const bool numbers = lua_type(L, -1) == LUA_TNUMBER && lua_type(L, -2) == LUA_TNUMBER;
    if (!numbers) return lua_rawequal(L, -1, -2) != 0;
    if (lua_isinteger(L, -1) != lua_isinteger(L, -2)) return false;
    if (lua_isinteger(L, -1) != 0) return lua_tointeger(L, -1) == lua_tointeger(L, -2);
    return bits_of(lua_tonumber(L, -1)) == bits_of(lua_tonumber(L, -2));
}

/// Returns whether all outside values are unchanged. `values` is the index of the list of values.
bool still_holds(lua_State* L, const Reading& reading, int values) {
    const bool same = std::all_of(reading.outside.begin(), reading.outside.end(), [&](const OutsideValue& one) {
        lua_settop(L, values);
        lua_rawgeti(L, values, one.holder);
        if (!Reader::push_outside(L, values, values + 1, one.kind, one.key)) return false;
        lua_rawgeti(L, values, one.value);
        return is_same(L);
    });
    lua_settop(L, values);
    return same;
}

using Shared = std::shared_ptr<Reading>;
const char readings_key = 0;  // registry key: function -> its reading, with weak keys
const char reading_class_key = 0;

int forget_reading(lua_State* L) {
    std::destroy_at(static_cast<Shared*>(lua_touserdata(L, 1)));
    return 0;
}

void push_reading_class(lua_State* L) {
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &reading_class_key) == LUA_TTABLE) return;
    lua_pop(L, 1);
    lua_newtable(L);
    lua_pushcfunction(L, forget_reading);
    lua_setfield(L, -2, "__gc");
    lua_pushvalue(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &reading_class_key);
}

}  // namespace

Shared reading_of(lua_State* L, int index, const Arguments& arguments) {
    luaL_checkstack(L, LUA_MINSTACK, "to read a function");
    const int top = lua_gettop(L), readings = top + 1, made = top + 2, values = top + 3;
    index = lua_absindex(L, index);
    push_weak_table(L, &readings_key);
    lua_pushvalue(L, index);
    if (lua_rawget(L, readings) == LUA_TUSERDATA) {
        Shared known = *static_cast<Shared*>(lua_touserdata(L, made));
        lua_getiuservalue(L, made, 1);
        if (known->arguments == arguments && still_holds(L, *known, values)) {
            lua_settop(L, top);
            return known;
        }
    }
    lua_settop(L, readings);
    auto* const place = static_cast<Shared*>(lua_newuserdatauv(L, sizeof(Shared), 1));
    std::construct_at(place);
    push_reading_class(L);
    lua_setmetatable(L, made);
    lua_newtable(L);
    Shared fresh = std::make_shared<Reading>(Reader(L, arguments, values).read(index));
    *place = fresh;
    lua_settop(L, values);
    lua_setiuservalue(L, made, 1);
    lua_pushvalue(L, index);
    lua_insert(L, made);
    lua_rawset(L, readings);
    lua_settop(L, top);
    return fresh;
}

}  // namespace dinal::lua
