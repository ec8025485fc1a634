#include "model/formula.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "model/bounds.hpp"

namespace dinal::model {
namespace {

constexpr double whole_numbers = 0x1p53;  // all below it are doubles

std::uint64_t bits(double x) {
    return std::bit_cast<std::uint64_t>(x);
}

/// Modulo as Lua defines it: the sign is that of the divisor.
double float_modulo(double a, double b) {
    const double rest = std::fmod(a, b);
    return (rest > 0 ? b < 0 : rest < 0 && b > 0) ? rest + b : rest;
}
/// Stores a whole number, without the sign of -0. Returns false if Lua has a number that a double may not hold.
bool exactly(double x, double& to) {
    to = x + 0.0;
    return std::fabs(x) < whole_numbers;
}

/// Applies any operation except conditions. Operations on floats are tested first, as they are the most frequent.
[[gnu::always_inline]] inline bool operate(Op op, double a, double b, double& to) {
    switch (op) {
        case Op::move:
            to = a;
            return true;
        case Op::add:
            to = a + b;
            return true;
        case Op::subtract:
            to = a - b;
            return true;
        case Op::multiply:
            to = a * b;
            return true;
        case Op::divide:
            to = a / b;
            return true;
        case Op::modulo:
            to = float_modulo(a, b);
            return true;
        case Op::floor_divide:
            to = std::floor(a / b);
            return true;
        case Op::power:
            to = b == 2 ? a * a : std::pow(a, b);
            return true;
        case Op::negate:
            to = -a;
            return true;
        case Op::sin:
            to = std::sin(a);
            return true;
        case Op::cos:
            to = std::cos(a);
            return true;
        case Op::tan:
            to = std::tan(a);
            return true;
        case Op::asin:
            to = std::asin(a);
            return true;
        case Op::acos:
            to = std::acos(a);
            return true;
        case Op::atan2:
            to = std::atan2(a, b);
            return true;
        case Op::exp:
            to = std::exp(a);
            return true;
        case Op::log:
            to = std::log(a);
            return true;
        case Op::log2:
            to = std::log2(a);
            return true;
        case Op::log10:
            to = std::log10(a);
            return true;
        case Op::sqrt:
            to = std::sqrt(a);
            return true;
        case Op::abs:
            to = std::fabs(a);
            return true;
        case Op::fmod:
            to = std::fmod(a, b);
            return true;
        case Op::native:
            if (!std::isfinite(a)) return false;
            to = to_excitation(b).value(a);
            return true;
        case Op::floor:
            return exactly(std::floor(a), to);
        case Op::ceil:
            return exactly(std::ceil(a), to);
        default:
            return op == Op::exact && exactly(a, to);
    }
}

bool holds(Op op, double a, double b) {
    switch (op) {
        case Op::less:
            return a < b;
        case Op::less_equal:
            return a <= b;
        default:
            return a == b;
    }
}

constexpr double failure = std::numeric_limits<double>::quiet_NaN();

}  // namespace

bool apply(Op op, double a, double b, double& to) {
    if (is_comparison(op)) return holds(op, a, b);
    return operate(op, a, b, to);
}

double decision_of(Op op, double a, double b, double result) {
    if (is_comparison(op)) return holds(op, a, b) ? 1 : 0;
    switch (op) {
        case Op::abs:
            return a < 0 ? -1 : 1;
        case Op::modulo:
        case Op::fmod:
            return std::nearbyint((a - result) / b);
        default:
            return result;
    }
}

Formula::Formula(std::vector<Step> steps, std::vector<double> registers, bool motion, std::size_t states,
                 std::size_t state_count, bool timeless, Excitations excitations)
    : steps_(std::move(steps)),
      registers_(std::move(registers)),
      excitations_(std::move(excitations)),
      motion_(motion),
      states_(states),
      state_count_(state_count),
      timeless_(timeless),
      has_conditions_(!excitations_.empty() || std::any_of(steps_.begin(), steps_.end(), [](const Step& s) {
          return is_comparison(s.op) || is_fold(s.op);
      })) {
    const auto decides = [](Op op) { return is_comparison(op) || is_fold(op); };
    std::vector<std::uint64_t> time(registers_.size());
    time[0] = 1;
    of_motion_ = has_conditions_ && depends_on(sources(), decides);
    of_time_ = !excitations_.empty() || (has_conditions_ && depends_on(std::move(time), decides));
    if (of_motion_) find_levels();
}

void Formula::start(double t, const State& state, std::span<const double> states) {
    registers_[0] = t;
    if (motion_) registers_[1] = state.theta, registers_[2] = state.velocity;
    std::copy(states.begin(), states.end(), registers_.begin() + static_cast<std::ptrdiff_t>(states_));
}

namespace {

/// Runs the program. `held` is called before each step with its operands; it may execute the step itself and then
/// returns the next step, otherwise null.
template <class Held>
double run(const Formula::Step* first, double* r, const Held& held) {
    for (const Formula::Step* s = first;;) {
        const double a = r[s->a], b = r[s->b];
        if (const Formula::Step* next = held(s, a, b)) {
            s = next;
            continue;
        }
        switch (s->op) {
            case Op::less:
                s = first + (a < b ? s->yes : s->no);
                continue;
            case Op::less_equal:
                s = first + (a <= b ? s->yes : s->no);
                continue;
            case Op::equal:
                s = first + (a == b ? s->yes : s->no);
                continue;
            case Op::jump:
                s = first + s->yes;
                continue;
            case Op::give:
                return a;
            default:
                if (!operate(s->op, a, b, r[s->to])) return failure;
                ++s;
        }
    }
}

}  // namespace

double Formula::value(double t, const State& state, std::span<const double> states) {
    start(t, state, states);
    return run(steps_.data(), registers_.data(), [](const Step*, double, double) -> const Step* { return nullptr; });
}

// ---- conditions of the motion

namespace {

/// Returns whether the result is piecewise constant whatever the operands are.
bool is_staircase(Op op) {
    return op == Op::floor || op == Op::ceil || op == Op::floor_divide;
}

/// Returns the sources (a bit mask of arguments) of a result from those of its operands.
std::uint64_t sources_of(Op op, std::uint64_t a, std::uint64_t b) {
    return is_staircase(op) ? 0 : a | b;
}

/// The result of a fold whose decision is fixed, also beyond its piece.
double result_on(Op op, double a, double b, double decision) {
    switch (op) {
        case Op::abs:
            return decision < 0 ? -a : a;
        case Op::modulo:
        case Op::fmod:
            return std::fma(-decision, b, a);  // exact, as the operation itself is
        default:
            return decision;
    }
}

/// The number of conditions that end a piece: one, or two (below and above). Unequal values have none, because they
/// become equal only at isolated times.
int conditions_of(Op op, double decision) {
    return is_comparison(op) ? (op == Op::equal && decision == 0 ? 0 : 1) : op == Op::abs ? 1 : 2;
}

/// The distance to the end of the piece behind which the decision is `beyond`; an equality ends as soon as the two
/// differ.
double margin_of(Op op, double a, double b, double decision, double beyond) {
    const bool below = beyond < decision;
    switch (op) {
        case Op::less:
        case Op::less_equal:
            return decision != 0 ? b - a : a - b;
        case Op::equal:
            return -std::fabs(a - b);
        case Op::abs:
            return decision * a;
        case Op::floor:
            return below ? a - (beyond + 1) : beyond - a;
        case Op::ceil:
            return below ? a - beyond : beyond - 1 - a;
        case Op::fmod:
            return below ? a / b - (decision > 0 ? decision : beyond) : (decision < 0 ? decision : beyond) - a / b;
        default:
            return below ? a / b - (beyond + 1) : beyond - a / b;
    }
}

}  // namespace

/// The sources of each register at the start, as bit masks.
std::vector<std::uint64_t> Formula::sources() const {
    std::vector<std::uint64_t> of(registers_.size());
    std::uint64_t bit = 1;
    if (timeless_) of[0] = std::uint64_t{1} << 63U;
    if (motion_) of[1] = 1, of[2] = 2, bit = 4;
    for (std::size_t k = 0; k < state_count_; ++k, bit = std::max(bit, bit << 1U)) of[states_ + k] = bit;
    return of;
}

/// Returns whether a step with a `wanted` operation depends on a register that is not 0 in `of`.
bool Formula::depends_on(std::vector<std::uint64_t> of, bool (*wanted)(Op op)) const {
    using Sources = std::vector<std::uint64_t>;
    std::map<std::size_t, Sources> ways;  // the sources with which a step is reached
    const auto lead = [&](std::size_t to) {
        Sources& there = ways.try_emplace(to, of).first->second;
        for (std::size_t i = 0; i < of.size(); ++i) there[i] |= of[i];
    };
    lead(0);
    while (!ways.empty()) {
        std::size_t at = 0;
        std::tie(at, of) = std::move(*ways.begin());
        ways.erase(ways.begin());
        const Step& s = steps_[at];
        const std::uint64_t both = of[s.a] | of[s.b];
        if (wanted(s.op) && both != 0) return true;
        if (is_comparison(s.op)) lead(s.no);
        if (is_comparison(s.op) || s.op == Op::jump) {
            lead(s.yes);
        } else if (s.op < Op::give) {
            of[s.to] = sources_of(s.op, of[s.a], of[s.b]);
            lead(at + 1);
        }
    }
    return false;
}

/// Finds the levels of each staircase whose result is only compared with constants: the first whole numbers behind
/// which a comparison changes. Between them a condition at each step would cut the motion without need.
void Formula::find_levels() {
    std::vector<char> is_constant(registers_.size(), 1);
    is_constant[0] = 0;
    if (motion_) is_constant[1] = is_constant[2] = 0;
    std::fill_n(is_constant.begin() + static_cast<std::ptrdiff_t>(states_), state_count_, 0);
    std::vector<std::size_t> stairs;
    for (std::size_t at = 0; at < steps_.size(); ++at) {
        const Step& s = steps_[at];
        if (!is_comparison(s.op) && s.op < Op::jump) is_constant[s.to] = 0;
        constexpr std::size_t most = 64;
        if (is_staircase(s.op) && stairs.size() < most) stairs.push_back(at), levels_[at];
    }
    const auto each = [&](std::uint64_t of, const auto& call) {
        for (std::size_t i = 0; i < stairs.size(); ++i) {
            if ((of >> i & 1U) != 0) call(stairs[i]);
        }
    };
    const auto use = [&](std::uint64_t of) { each(of, [&](std::size_t at) { levels_.erase(at); }); };
    const auto compare = [&](std::uint64_t of, Op op, std::size_t with, bool left) {
        if (!is_constant[with]) return use(of);
        const double level = registers_[with];
        const bool equals = op == Op::equal, strict = op == Op::less;
        each(of, [&](std::size_t at) {
            const auto found = levels_.find(at);
            if (found == levels_.end()) return;
            if (equals || strict == left) found->second.push_back(std::ceil(level));
            if (equals || strict != left) found->second.push_back(std::floor(level) + 1);
        });
    };
    std::map<std::size_t, std::vector<std::uint64_t>> ways;  // the staircases that registers may hold at a step
    ways[0].resize(registers_.size());
    while (!ways.empty() && !levels_.empty()) {
        const auto node = ways.extract(ways.begin());
        std::vector<std::uint64_t> of = node.mapped();
        const Step& s = steps_[node.key()];
        const auto lead = [&](std::size_t to) {
            std::vector<std::uint64_t>& there = ways.try_emplace(to, of).first->second;
            for (std::size_t i = 0; i < of.size(); ++i) there[i] |= of[i];
        };
        if (is_comparison(s.op)) {
            if (of[s.a] != 0) compare(of[s.a], s.op, s.b, true);
            if (of[s.b] != 0) compare(of[s.b], s.op, s.a, false);
            lead(s.yes), lead(s.no);
        } else if (s.op == Op::jump) {
            lead(s.yes);
        } else {
            const bool passes = s.op == Op::move || s.op == Op::exact;
            if (!passes) use(of[s.a] | of[s.b]);
            if (s.op >= Op::give) continue;
            const auto stair = std::find(stairs.begin(), stairs.end(), node.key());
            of[s.to] = passes                  ? of[s.a]
                       : stair == stairs.end() ? 0
                                               : std::uint64_t{1} << static_cast<unsigned>(stair - stairs.begin());
            lead(node.key() + 1);
        }
    }
}

/// The decisions on the other sides of the one or two conditions of a step.
std::pair<double, double> Formula::beyond(std::size_t at, double decision) const {
    const Op op = steps_[at].op;
    if (is_comparison(op)) return {1 - decision, never};
    if (op == Op::abs) return {-decision, never};
    const auto found = levels_.find(at);
    if (found == levels_.end()) return {decision - 1, decision + 1};
    std::pair<double, double> ends{-never, never};
    for (const double level : found->second) {
        if (level <= decision) ends.first = std::max(ends.first, level - 1);
        if (level > decision) ends.second = std::min(ends.second, level);
    }
    return ends;
}

namespace {

/// Returns whether a condition of this step was crossed.
bool is_crossed(const terms::Piece& piece, std::size_t at) {
    return std::any_of(piece.conditions.begin(), piece.conditions.end(), [&](const auto& condition) {
        return condition.step == at && condition.beyond == piece.decisions[at];
    });
}

/// Returns whether the operands of this step are clearly beyond the piece.
bool is_beyond(const terms::Piece& piece, std::size_t at, Op op, double a, double b) {
    constexpr double clearly = 1e-9;
    return std::any_of(piece.conditions.begin(), piece.conditions.end(), [&](const auto& condition) {
        return condition.step == at &&
               margin_of(op, a, b, piece.decisions[at], condition.beyond) < -clearly * (std::fabs(a) + std::fabs(b));
    });
}

}  // namespace

void Formula::decide(terms::Piece& piece, double t, const State& state, std::span<const double> states,
                     std::uint64_t again) {
    terms::Piece made{.decisions = std::vector<double>(steps_.size(), std::numeric_limits<double>::quiet_NaN()),
                      .owner = piece.owner};
    start(t, state, states);
    std::vector<std::uint64_t> of = sources();
    std::vector<std::uint64_t> jumps_with = of;  // sources that also pass through staircases
    // Values jump where a condition was just crossed; later conditions on them are decided again.
    std::vector<char> jumps(of.size(), 0);
    bool other_way = false;
    double* const r = registers_.data();
    for (std::size_t at = 0; steps_[at].op < Op::give;) {
        const Step& s = steps_[at];
        const double a = r[s.a], b = r[s.b];
        const std::uint64_t both = of[s.a] | of[s.b], all = jumps_with[s.a] | jumps_with[s.b];
        const bool compares = is_comparison(s.op);
        bool jumped = (jumps[s.a] | jumps[s.b]) != 0;
        double result = 0;
        if (!compares && s.op != Op::jump && !operate(s.op, a, b, result)) break;
        if (both != 0 && (compares || is_fold(s.op))) {
            double decision = decision_of(s.op, a, b, result);
            const double before = piece.decisions.empty() ? decision : piece.decisions[at];
            // A value that has jumped by more than one step left its old piece.
            const bool is_beside = s.op == Op::abs || std::fabs(decision - before) <= 1;
            const bool anew = jumped && is_beyond(piece, at, s.op, a, b);
            if ((all & again) == 0 && before == before && is_beside && !anew) decision = before;
            jumped = jumped || is_crossed(piece, at);
            if (std::fabs(decision) < whole_numbers) {
                made.decisions[at] = decision;
                const int conditions = conditions_of(s.op, decision);
                const auto [below, above] = beyond(at, decision);
                if (conditions > 0 && std::isfinite(below)) made.conditions.push_back({at, below, all});
                if (conditions > 1 && std::isfinite(above)) made.conditions.push_back({at, above, all});
                if (!compares) result = result_on(s.op, a, b, decision);
            }
        }
        if (compares) {
            other_way = other_way || jumped;
            const double decision = made.decisions[at];
            at = (decision == decision ? decision != 0 : holds(s.op, a, b)) ? s.yes : s.no;
        } else if (s.op == Op::jump) {
            at = s.yes;
        } else {
            r[s.to] = result;
            of[s.to] = sources_of(s.op, of[s.a], of[s.b]);
            jumps_with[s.to] = all;
            jumps[s.to] = jumped || other_way ? 1 : 0;
            ++at;
        }
    }
    piece = std::move(made);
}

double Formula::value_on(const terms::Piece& piece, double t, const State& state, std::span<const double> states,
                         std::vector<double>* margins) {
    start(t, state, states);
    if (margins != nullptr) margins->clear();
    const Step* const first = steps_.data();
    double* const r = registers_.data();
    return run(first, r, [&](const Step* s, double a, double b) -> const Step* {
        const double decision = piece.decisions[static_cast<std::size_t>(s - first)];
        if (decision != decision) return nullptr;
        const auto is_of = [&](std::size_t c) {
            return c < piece.conditions.size() && first + piece.conditions[c].step == s;
        };
        while (margins != nullptr && is_of(margins->size())) {
            margins->push_back(margin_of(s->op, a, b, decision, piece.conditions[margins->size()].beyond));
        }
        if (is_comparison(s->op)) return first + (decision != 0 ? s->yes : s->no);
        r[s->to] = result_on(s->op, a, b, decision);
        return s + 1;
    });
}

namespace {

/// The rate of a result that is not folded, from the rates of its operands.
double rate_of(Op op, double a, double b, double da, double db) {
    switch (op) {
        case Op::move:
        case Op::exact:
            return da;
        case Op::add:
            return da + db;
        case Op::subtract:
            return da - db;
        case Op::multiply:
            return da * b + a * db;
        case Op::divide:
            return (da - a / b * db) / b;
        case Op::modulo:
            return da - std::floor(a / b) * db;
        case Op::fmod:
            return da - std::trunc(a / b) * db;
        case Op::power:
            return (da == 0 ? 0 : b * std::pow(a, b - 1) * da) + (db == 0 ? 0 : std::pow(a, b) * std::log(a) * db);
        case Op::negate:
            return -da;
        case Op::sin:
            return std::cos(a) * da;
        case Op::cos:
            return -std::sin(a) * da;
        case Op::tan:
            return da / (std::cos(a) * std::cos(a));
        case Op::asin:
            return da / std::sqrt(1 - a * a);
        case Op::acos:
            return -da / std::sqrt(1 - a * a);
        case Op::atan2:
            return (b * da - a * db) / (a * a + b * b);
        case Op::exp:
            return std::exp(a) * da;
        case Op::log:
            return da / a;
        case Op::log2:
            return da / (a * std::numbers::ln2);
        case Op::log10:
            return da / (a * std::numbers::ln10);
        case Op::sqrt:
            return da / (2 * std::sqrt(a));
        case Op::abs:
            return a < 0 ? -da : da;
        case Op::native:
            return failure;
        default:
            return 0;  // floor and ceil
    }
}

/// The rate of a fold that keeps its decision.
double rate_on(Op op, double da, double db, double decision) {
    if (op == Op::abs) return decision < 0 ? -da : da;
    return op == Op::modulo || op == Op::fmod ? da - decision * db : 0;
}

}  // namespace

namespace {

double rate_of_margin(Op op, double a, double b, double da, double db, double decision, double beyond) {
    const double sign = beyond < decision ? 1 : -1;
    switch (op) {
        case Op::less:
        case Op::less_equal:
        case Op::abs:
            return margin_of(op, da, db, decision, beyond);  // linear
        case Op::floor:
        case Op::ceil:
            return sign * da;
        case Op::equal:
            return failure;
        default:
            return sign * rate_of(Op::divide, a, b, da, db);
    }
}

}  // namespace

double Formula::margin_rate(const terms::Piece& piece, std::size_t condition, double t, const State& state,
                            std::span<const double> states, const State& rate, std::span<const double> rates) {
    start(t, state, states);
    std::vector<double> dot(registers_.size(), 0);
    dot[0] = 1;
    if (motion_) dot[1] = rate.theta, dot[2] = rate.velocity;
    std::copy(rates.begin(), rates.end(), dot.begin() + static_cast<std::ptrdiff_t>(states_));
    double found = failure;
    const terms::Piece::Condition& wanted = piece.conditions[condition];
    const Step* const first = steps_.data();
    double* const r = registers_.data();
    run(first, r, [&](const Step* s, double a, double b) -> const Step* {
        const double decision = piece.decisions[static_cast<std::size_t>(s - first)];
        const double da = dot[s->a], db = dot[s->b];
        if (decision != decision) {
            if (!is_comparison(s->op) && s->op < Op::jump) dot[s->to] = rate_of(s->op, a, b, da, db);
            return nullptr;
        }
        if (first + wanted.step == s) found = rate_of_margin(s->op, a, b, da, db, decision, wanted.beyond);
        if (is_comparison(s->op)) return first + (decision != 0 ? s->yes : s->no);
        r[s->to] = result_on(s->op, a, b, decision);
        dot[s->to] = rate_on(s->op, da, db, decision);
        return s + 1;
    });
    return found;
}

// ---- conditions of t

/// The values that a register may have while t goes through an interval.
struct Formula::Range : bounds::Interval {
    bool of_motion = false;   ///< whether it depends on theta, velocity or a state
    bool folds = false;       ///< whether a jump or kink lies within
    std::uint64_t piece = 0;  ///< hash of the fold pieces that it is made of; 0: none

    [[nodiscard]] bool is_known() const { return !of_motion && is_one(); }
};

/// Evaluates the program over all t of an interval at once and records its branches, if these are the same for all t.
class Formula::Look {
public:
    Look(const Formula& formula, Breaks which) : formula_(formula), which_(which) {
        for (const double x : formula.registers_) ranges_.push_back({{x, x}});
        const Range unknown{{}, true};
        if (formula.motion_) ranges_[1] = ranges_[2] = unknown;
        std::fill_n(ranges_.begin() + static_cast<std::ptrdiff_t>(formula.states_), formula.state_count_, unknown);
    }

    /// A hash of the branches taken; empty if they differ within the interval or cannot be determined.
    std::optional<std::uint64_t> over(double from, double to) {
        seen_ = 0xcbf29ce484222325U;
        part_ = std::numeric_limits<double>::quiet_NaN();
        // The program writes each register before it reads it, so earlier values do no harm.
        const auto motion = std::pair(ranges_[1], ranges_[2]);
        ranges_[0] = {{from, to}};
        const bool same = follow(ranges_);
        if (formula_.motion_) std::tie(ranges_[1], ranges_[2]) = motion;
        return same ? std::optional(seen_) : std::nullopt;
    }
    /// After a result that was empty: the fraction of the interval at which a branch may change; NaN if unknown.
    [[nodiscard]] double part() const { return part_; }

private:
    /// Adds to a hash. The decisions of abs, -1 and 1, differ in the highest bit only, which a product leaves there: it
    /// is also taken lower, or two of them would cancel.
    static std::uint64_t mixed(std::uint64_t hash, std::uint64_t what) {
        const std::uint64_t product = (hash ^ what) * 0x100000001b3U;
        return product ^ product >> 29U;
    }
    void note(std::uint64_t what) { seen_ = mixed(seen_, what); }

    using Ranges = std::vector<Range>;

    /// Follows all branches that conditions on the motion may take. Many of them are followed in the order of the
    /// steps, so that they meet again and can be united.
    bool follow(Ranges& r) {
        count_ = 0;
        for (std::size_t at = 0;;) {
            const Step& s = formula_.steps_[at];
            const Range a = r[s.a], b = r[s.b];
            bool ends = false;
            if (is_comparison(s.op)) {
                if (a.of_motion || b.of_motion) {
                    if (!open(s.yes, r)) return false;
                    at = s.no;
                } else {
                    const auto found = decide(s.op, a, b);
                    if (!found) return false;
                    note(at + at + (*found ? 1 : 0));
                    at = *found ? s.yes : s.no;
                }
            } else if (s.op == Op::jump) {
                at = s.yes;
            } else if (s.op >= Op::give) {
                note(at);
                if (s.op != Op::fail) note(a.piece);
                if (s.op != Op::fail && a.folds) return false;
                ends = true;
            } else {
                fails_ = false;
                Range result = of(s.op, a, b);
                if (fails_) note(at), ends = true;
                result.of_motion = a.of_motion || b.of_motion;
                result.folds = result.folds || a.folds || b.folds;
                // The index of the step is mixed in, or equal pieces of both operands would cancel.
                if (a.piece != 0 || b.piece != 0) {
                    for (const std::uint64_t piece : {at + 1, a.piece, b.piece}) {
                        result.piece = mixed(result.piece, piece);
                    }
                }
                r[s.to] = result;
                ++at;
            }
            if (ends && count_ == 0) return true;
            if (!ends && (count_ <= few_branches || next_ > at)) continue;
            if (!ends && !open(at, r)) return false;
            at = next_;
            resume(r);
        }
    }
    /// Adds a branch that continues at a step. Returns false if there are too many.
    bool open(std::size_t at, const Ranges& r) {
        constexpr std::size_t most_branches = 64;
        if (count_ > few_branches && read_later_.empty()) find_read_registers();
        for (std::size_t k = 0; k < count_ && count_ > few_branches; ++k) {
            if (open_[k].at == at && unite(open_[k].ranges, r, read_later_[at])) return true;
        }
        if (count_ == open_.size()) open_.emplace_back();
        open_[count_].at = at, open_[count_].ranges = r;
        next_ = count_ == 0 ? at : std::min(next_, at);
        return ++count_ <= most_branches;
    }
    /// Continues the branch that is first; its storage is kept for later ones.
    void resume(Ranges& r) {
        std::size_t k = 0;
        while (open_[k].at != next_) ++k;
        std::swap(r, open_[k].ranges);
        std::swap(open_[k], open_[--count_]);
        next_ = never_opened;
        for (std::size_t i = 0; i < count_; ++i) next_ = std::min(next_, open_[i].at);
    }
    /// A register whose value is read after a step.
    struct Later {
        std::size_t place;
        bool decides;  ///< whether a decision depends on it
    };
    /// Unites a branch with another one that continues at the same step, unless a value that changes in time and that
    /// later decisions depend on differs.
    static bool unite(Ranges& one, const Ranges& other, const std::vector<Later>& later) {
        const auto same = [&](std::size_t i) {
            const Range &x = one[i], &y = other[i];
            return bits(x.lo) == bits(y.lo) && bits(x.hi) == bits(y.hi) && x.of_motion == y.of_motion &&
                   x.folds == y.folds && x.piece == y.piece;
        };
        const auto changes = [](const Range& x) { return !x.of_motion && !x.is_one(); };
        for (const auto& [i, decides] : later) {
            if (decides && (changes(one[i]) || changes(other[i])) && !same(i)) return false;
        }
        for (const auto& [i, decides] : later) {
            if (same(i)) continue;
            const Range &x = one[i], &y = other[i];
            one[i] = {{}, true, x.folds || y.folds, mixed(mixed(i + 1, x.piece), y.piece)};
        }
        return true;
    }
    /// Finds the registers that are read from each step on.
    void find_read_registers() {
        const std::vector<Step>& steps = formula_.steps_;
        read_later_.resize(steps.size());
        enum : char { no, yes, decides };
        std::vector<std::vector<char>> at_step(steps.size(), std::vector<char>(ranges_.size(), no));
        for (std::size_t at = steps.size(); at-- > 0;) {
            const Step& s = steps[at];
            std::vector<char>& here = at_step[at];
            const auto read = [&](std::size_t place, char how) { here[place] = std::max(here[place], how); };
            if (s.op >= Op::give) {
                read(s.a, yes);
            } else if (s.op == Op::jump) {
                here = at_step[s.yes];
            } else {
                here = at_step[is_comparison(s.op) ? s.yes : at + 1];
                // A step that rounds or needs exact numbers may fail, which is also a decision.
                char how = is_comparison(s.op) || is_fold(s.op) || s.op >= Op::native ? decides : no;
                if (is_comparison(s.op)) {
                    for (std::size_t i = 0; i < here.size(); ++i) read(i, at_step[s.no][i]);
                } else {
                    how = std::max(how, std::exchange(here[s.to], char{no}));
                }
                read(s.a, how), read(s.b, how);
            }
            for (std::size_t i = 0; i < here.size(); ++i) {
                if (here[i] != no) read_later_[at].push_back({i, here[i] == decides});
            }
        }
    }

    std::optional<bool> decide(Op op, const Range& a, const Range& b) {
        if (a.is_known() && b.is_known()) return holds(op, a.lo, b.lo);
        if (a.is_anything() || b.is_anything()) return std::nullopt;
        if (const auto decision = bounds::decision_over(op, a, b)) return *decision != 0;
        if (!a.folds && !b.folds) {
            const double least = a.lo - b.hi, part = -least / (a.hi - b.lo - least);
            part_ = a.is_known() ? 1 - part : part;
        }
        return std::nullopt;
    }

    Range of(Op op, const Range& a, const Range& b) {
        if (a.of_motion || b.of_motion) return {};
        Range r;
        if (a.is_known() && b.is_known()) {
            fails_ = !operate(op, a.lo, b.lo, r.lo);
            r.hi = r.lo;
            if (is_fold(op)) r.piece = piece_of(decision_of(op, a.lo, b.lo, r.lo));
            if (op == Op::native && !fails_) fold(to_excitation(b.lo), a, r);
            return r;
        }
        if (op == Op::move) return {{a.lo, a.hi}};
        static_cast<bounds::Interval&>(r) = bounds::image(op, a, b);
        if (op == Op::native) fold(to_excitation(b.lo), a, r);
        if (!is_fold(op)) return r;
        if (const auto decision = bounds::decision_over(op, a, b)) {
            r.piece = piece_of(*decision);
            return r;
        }
        r.folds = true;
        double first = 0;
        const bool alone = op == Op::abs || op == Op::floor || op == Op::ceil;
        if (!a.folds && !a.is_anything() && (alone || b.is_one()) && operate(op, a.lo, b.lo, first)) {
            part_ = (next_fold(op, a.lo, b.lo, first) - a.lo) / (a.hi - a.lo);
        }
        return r;
    }
    /// The pieces of an excitation are the intervals between its breaks.
    void fold(const Excitation& excitation, const Range& time, Range& r) {
        constexpr double end_of_time = 1e300;
        if (which_ == Breaks::own) return;
        const double from = std::max(time.lo, -end_of_time), next = excitation.next_break(from);
        r.folds = next <= time.hi;
        r.piece = piece_of(next);
        if (r.folds && !time.folds) part_ = (next - from) / (time.hi - from);
    }
    static std::uint64_t piece_of(double decision) { return bits(decision + 0.0) + 1; }
    /// The value of the operand a, rising, at which its piece ends.
    static double next_fold(Op op, double a, double b, double result) {
        switch (op) {
            case Op::abs:
                return 0;
            case Op::modulo:
                return a - result + std::max(b, 0.0);
            case Op::fmod:
                return a - result + (a < 0 ? 0 : std::fabs(b));
            case Op::floor_divide:
                return b > 0 ? (result + 1) * b : result * b;
            case Op::ceil:
                return std::ceil(a);
            default:
                return std::floor(a) + 1;
        }
    }

    const Formula& formula_;
    Breaks which_;
    std::vector<Range> ranges_{};
    double part_ = 0;
    std::uint64_t seen_ = 0;
    struct Branch {
        std::size_t at = 0;
        Ranges ranges{};
    };
    static constexpr std::size_t few_branches = 4;  // these are cheaper to follow than to unite
    static constexpr std::size_t never_opened = std::numeric_limits<std::size_t>::max();
    std::vector<Branch> open_{};  ///< the first `count_` continue later, the earliest one at the step `next_`
    std::size_t count_ = 0, next_ = never_opened;
    std::vector<std::vector<Later>> read_later_{};  ///< for each step, see find_read_registers()
    bool fails_ = false;
};

namespace {

/// Maps doubles to consecutive integers in the same order.
std::int64_t rank(double x) {
    const auto whole = std::bit_cast<std::int64_t>(x);
    return whole < 0 ? std::numeric_limits<std::int64_t>::min() - whole : whole;
}
double at_rank(std::int64_t rank) {
    return std::bit_cast<double>(rank < 0 ? std::numeric_limits<std::int64_t>::min() - rank : rank);
}

/// Returns where to divide an interval: just before or after the suspected change, and each third time in its middle.
double cut(double from, double to, double part, int turn) {
    constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
    const double place = from + (turn % 3 == 1 ? part : 1 - part) * (to - from);
    const double near = rounding * std::max(std::fabs(from), std::fabs(place));
    if (turn % 3 != 0 && to - from > 8 * near) {
        if (place - near > from && place - near < to) return place - near;
        if (place + near > from && place + near < to) return place + near;
    }
    return at_rank(std::midpoint(rank(from), rank(to)));
}

}  // namespace

double Formula::next_break(double t) {
    return next_break(t, Breaks::all);
}

double Formula::next_break(double t, Breaks which) {
    constexpr double end_of_time = 1e300;
    if (!of_time_ || gave_up_ || !(std::fabs(t) < end_of_time)) return never;
    const double found = search(t + 0.0, which);  // + 0.0 turns -0 into 0
    // A long series of breaks with tiny jumps comes from rounding or truncated digits: it counts as roughness, not
    // as events.
    constexpr int most_alike = 30;
    double last = t, next = found;
    for (int n = 0; is_dubious(last, next); ++n) {
        if (n == most_alike) gave_up_ = true;
        if (gave_up_) return never;
        last = next, next = search(next, which);
    }
    if (gave_up_) return never;
    return found;
}

/// Returns whether the break at `found` follows t too closely, or its jump is tiny although not rounding.
bool Formula::is_dubious(double t, double found) {
    constexpr double close = 1e-9, most_breaks = 50000, small = 1e-5, rounding = 1e-13;
    if (found == never || is_of_excitation(found)) return false;
    if (found - t < std::max(close * std::fabs(t), span_ / most_breaks)) return true;
    const double before = std::nextafter(found, -never);
    const auto change = [&](double from, double to) { return std::fabs(value(to, {}, {}) - value(from, {}, {})); };
    const double jump = change(before, found);
    // At a steep kink the value also changes between two doubles, as it does beside it.
    const double few = 8 * (found - before);
    if (!(jump > change(before - few, before) + change(found, found + few))) return false;
    constexpr int places = 50;
    for (int n = 0; n < places && !knows_greatest_; ++n) {
        const double there = std::fabs(value(found + span_ * n / places, {}, {}));
        if (std::isfinite(there)) greatest_ = std::max(greatest_, there);
    }
    knows_greatest_ = true;
    return jump < small * greatest_ && jump > rounding * greatest_;
}

/// Returns whether only an excitation breaks there, as declared by its author.
bool Formula::is_of_excitation(double found) const {
    if (excitations_.empty()) return false;
    Look look(*this, Breaks::own);
    const double before = std::nextafter(found, -never);
    return look.over(before, before) == look.over(found, found);
}

// Bisects the interval from t on, the earlier part first, until the program takes the same branches over each part.
double Formula::search(double t, Breaks which) {
    constexpr double end_of_time = 1e300, least = 1e-300, rounding = std::numeric_limits<double>::epsilon();
    constexpr int most_looks = 4000, most_unfinished = 20, most_flips = 60;
    std::map<double, double>& known = known_[which == Breaks::all ? 1 : 0];
    const auto behind = known.upper_bound(t);
    if (behind != known.begin() && std::prev(behind)->second > t) return std::prev(behind)->second;
    // A change within rounding of t counts as past, because rounding can make a comparison flicker near its change.
    const bool at_break = behind != known.begin() && std::prev(behind)->second == t;
    const double flicker = t + std::max(least, (at_break ? 64 : 4) * rounding * std::fabs(t));

    Look look(*this, which);
    std::optional<std::uint64_t> way = look.over(t, t);
    std::vector<std::pair<double, double>> parts{{t, end_of_time}};
    int looks = 0, flips = 0;
    double found = never;
    while (!parts.empty() && way) {
        const auto [from, to] = parts.back();
        parts.pop_back();
        const auto seen = look.over(from, to);
        if (seen == way) continue;
        if (!seen && ++looks < most_looks && from < to) {
            const double middle = cut(from, to, look.part(), looks);
            parts.emplace_back(std::nextafter(middle, never) + 0.0, to);
            parts.emplace_back(from, middle);
            continue;
        }
        if (seen && from <= flicker && ++flips < most_flips) {
            way = seen;
            continue;
        }
        found = std::fabs(from) < least ? 0 : from;
        const bool far = from - t > 1e-6 * std::fabs(from) && from != 0;
        gave_up_ = !seen && (!far || ++unfinished_ > most_unfinished);
        break;
    }
    if (!way || gave_up_) return gave_up_ = true, never;
    constexpr std::size_t most_known = 10000;
    if (known.size() > most_known) known.clear();
    return known[t] = found;
}

}  // namespace dinal::model
