#include "motion/engine/unseen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

namespace dinal::motion::engine {

namespace {

using model::bounds::Disc;
using model::bounds::Interval;

// A disc with three times the radius of a stretch contains a Bernstein ellipse with foci at both ends and half axes
// that add up to rho. If a function differs there from its value in the middle by at most r, it differs on the stretch
// from its polynomial of degree n by at most 4 r rho^-n / (rho - 1) (Trefethen, Approximation Theory and Approximation
// Practice, theorem 8.2).
constexpr double rho = 5.82842712474619, greatest_power = 6.16227766016838;  // 3 + sqrt(3^2 - 1) and 3 + sqrt(3^2 + 1)

constexpr double power(double x, std::size_t n) {
    return n == 0 ? 1 : x * power(x, n - 1);
}
constexpr double decay_of_error(std::size_t n) {
    return 4 / (power(rho, n) * (rho - 1));
}

/// The maximum of |Tk(z) - Tk(0)| in that disc, reached at z = 3 i.
constexpr Series growth = [] {
    Series most{};
    for (std::size_t k = 1; k < node_count; ++k) {
        const double e = power(greatest_power, k);
        most[k] = k % 2 == 0 ? (e + 1 / e) / 2 - 1 : (e - 1 / e) / 2;
    }
    return most;
}();

/// A bound of the deviation of a polynomial in the disc from its value in the middle. Trailing terms that may be
/// rounding are dropped, as they would grow.
double deviation_in_disc(const Series& series) {
    const double noise = 4 * rounding * cheb::size(series);
    std::size_t last = node_count - 1;
    while (last > 0 && std::fabs(series[last]) <= noise) --last;
    double sum = 0;
    for (std::size_t k = 1; k <= last; ++k) sum += std::fabs(series[k]) * growth[k];
    return sum;
}

Interval range(const Series& series) {
    const double way = cheb::size(series) - std::fabs(series[0]);
    return {series[0] - way, series[0] + way};
}

/// The series on a part of the stretch; for the whole stretch the same series.
Series on_part(const Series& series, double middle, double half) {
    if (half == 1) return series;
    Nodes values;
    for (std::size_t j = 0; j < node_count; ++j) values[j] = cheb::value(series, middle + half * cheb::nodes[j]);
    return cheb::fit(values);
}

}  // namespace

bool Unseen::certainly_follows(double allowed, double part) {
    constexpr double close = 1e-9;
    // conditions that do not depend on the motion change at breaks only
    const bool ranges = piece_ == nullptr && formula_->has_conditions_of_motion();
    walk_.begin(*formula_, piece_, ranges);
    for (const Input& input : inputs_) {
        walk_.set(input.place, {cheb::value(input.series, 0), deviation_in_disc(input.series)},
                  ranges ? range(input.series) : Interval{});
    }
    const auto enclosure = walk_.run();
    return decay_of_error(cheb::degree) * enclosure.disc.r <= std::max(allowed, part * std::fabs(enclosure.disc.c)) &&
           enclosure.apart <= allowed && decay_of_error(cheb::degree) * walk_.greatest_relative_radius() <= close;
}

/// The disc of a value grows by the rounding of each step.
double Unseen::rounded(std::optional<std::size_t> condition) {
    walk_.begin(*formula_, piece_, false);
    // A condition may be decided by a small difference, in which the rounding of the arguments remains.
    const double of_arguments = condition ? model::bounds::roundings_of_a_step * rounding : 0;
    for (const Input& input : inputs_) {
        walk_.set(input.place, {cheb::value(input.series, 0), of_arguments * cheb::size(input.series)}, Interval{});
    }
    return walk_.run(condition).disc.r / model::bounds::roundings_of_a_step;
}

double Unseen::value(double x) {
    for (const Input& input : inputs_) walk_.set(input.place, cheb::value(input.series, x));
    return walk_.run(condition_).disc.c;
}

void Unseen::sample() {
    walk_.begin(*formula_, piece_, true);
    Nodes values;
    for (std::size_t j = 0; j < node_count; ++j) values[j] = value(cheb::nodes[j]);
    series_ = cheb::fit(values);
}

/// Returns a bound of the deviation in this part, 0 if it is allowed; sets `place` if a sample deviates by more.
double Unseen::deviation_on(const Part& part, double allowed, std::optional<double>& place) {
    const auto deviates_at = [&](double x, double found) {
        const bool deviates = std::fabs(found - cheb::value(series_, x)) > allowed;
        if (deviates) place = x;
        return deviates;
    };
    for (const Input& input : inputs_) {
        const Series own = on_part(input.series, part.middle, part.half);
        walk_.set(input.place, {cheb::value(own, 0), deviation_in_disc(own)}, range(own));
    }
    const auto enclosure = walk_.run(condition_);
    const bool decided = enclosure.disc.c == enclosure.disc.c;
    if (deviates_at(part.middle, decided ? enclosure.disc.c : value(part.middle))) return model::never;
    const Series own = on_part(series_, part.middle, part.half);
    const Interval known = range(own);
    const double off = std::max(enclosure.range.hi - known.lo, known.hi - enclosure.range.lo);
    if (off <= allowed) return 0;
    const bool whole = part.half == 1;
    const double r = enclosure.disc.r + (whole ? 0 : deviation_in_disc(own));
    for (const std::size_t n : {std::size_t{4}, std::size_t{8}, std::size_t{16}}) {
        if ((whole && n < cheb::degree) || !(decay_of_error(n) * r <= allowed && enclosure.apart <= allowed)) continue;
        for (std::size_t j = 0; j < node_count && !whole; j += cheb::degree / n) {
            const double x = part.middle + part.half * cheb::nodes[j];
            if (deviates_at(x, value(x))) return model::never;
        }
        return 0;
    }
    const double apart = enclosure.apart + decay_of_error(cheb::degree) * r;
    const double most = apart < off ? apart : off;
    if (std::isnan(most)) return model::never;
    return most;
}

Unseen::Found Unseen::search(double allowed, int budget) {
    constexpr double finest = 1e-14;
    Found found{.proven = true};
    std::priority_queue<Part> open;
    int looks = 0;
    const auto add = [&](double middle, double half) {
        if (found.place) return;
        Part part{middle, half, 0};
        ++looks;
        part.off = deviation_on(part, allowed, found.place);
        if (part.off > 0) open.push(part);
    };
    add(0, 1);
    while (!open.empty() && !found.place) {
        const Part part = open.top();
        if (looks >= budget || part.half < finest) break;
        open.pop();
        add(part.middle - part.half / 2, part.half / 2);
        add(part.middle + part.half / 2, part.half / 2);
    }
    found.proven = open.empty() && !found.place;
    return found;
}

namespace {

constexpr double clearly = 64, of_last_iteration = 1e-9;

/// The proofs for one stretch, or a part of it.
class StretchProof {
public:
    StretchProof(const Mechanics& mechanics, Unseen& unseen, Segment& s, const Mode& mode, const Proofs::Beside& beside,
                 int budget, double until)
        : mechanics_(mechanics),
          unseen_(unseen),
          s_(s),
          mode_(mode),
          beside_(beside),
          n_(mechanics.bodies()),
          budget_(budget),
          middle_((until - 1) / 2),
          half_((until + 1) / 2),
          late_(std::max(std::fabs(s.start.hi), std::fabs(s.end))) {}

    void loads();
    void rates();
    void events();
    void contact(std::size_t joint, const Moment& middle);
    /// Returns false once a function is found to deviate.
    [[nodiscard]] bool good() const { return !place_; }
    [[nodiscard]] double place() const { return middle_ + half_ * *place_; }

private:
    [[nodiscard]] Series whole(std::size_t k) const {
        Series series = s_.series[k];
        series[0] += s_.y[k][0];
        return on_part(series, middle_, half_);
    }
    [[nodiscard]] Series time(double delay) const;
    bool give_motion(const model::Formula& formula, const Series* speed = nullptr,
                     const std::vector<Series>* past = nullptr);
    bool begin(const Mechanics::UserPiece& own, const Series& first, const Series* speed = nullptr);
    void test(double size, double allowed, double part);
    void test_signal(const Signal& signal, double size, double noise);
    void test_delayed(const Signal& signal, double size, double noise);
    [[nodiscard]] bool found(const Unseen::Found& what);
    /// The scale for errors of torques on a body: the torques, and its momentum per half stretch.
    [[nodiscard]] double size_on(std::size_t body) const {
        return beside_.torques[body] + inertia(body) * greatest(s_.y[n_ + body]) / s_.h;
    }
    [[nodiscard]] double inertia(std::size_t body) const { return mechanics_.system().bodies[body].inertia; }
    /// The roughness to tolerate. In a decayed motion the rounding of earlier torques remains.
    [[nodiscard]] double rough(std::size_t k) const {
        return std::max(beside_.floor.noise[k], rounding * beside_.floor.greatest[k]);
    }

    const Mechanics& mechanics_;
    Unseen& unseen_;
    Segment& s_;
    const Mode& mode_;
    const Proofs::Beside& beside_;
    std::size_t n_;
    int budget_;
    double middle_, half_;  ///< middle and half length of the part under test
    double late_;
    std::optional<double> place_;
    std::vector<double> point_ = {};
};

/// The series of the time minus a delay. A stretch next to a break is shortened so as not to touch it.
Series StretchProof::time(double delay) const {
    constexpr double roundings_inside = 16;
    Series t{};
    t[0] = s_.start.hi + s_.h * (1 + middle_) - delay, t[1] = s_.h * half_;
    if (s_.from_break || s_.to_break) t[1] -= roundings_inside * rounding * late_;
    return t;
}

/// Gives a formula the present or past motion and, before the states, a speed. Returns false if the formula expects
/// other states.
bool StretchProof::give_motion(const model::Formula& formula, const Series* speed, const std::vector<Series>* past) {
    const auto of = [&](std::size_t k) { return past != nullptr ? (*past)[k] : whole(k); };
    const bool named = mechanics_.system().named;
    const std::size_t values = 2 * n_ + mechanics_.states_of_user();
    if (formula.takes_motion() && !named) unseen_.give(1, of(0)), unseen_.give(2, of(n_));
    const std::size_t count = formula.state_count(), from = named ? 0 : 2, more = speed != nullptr ? 1 : 0;
    if (count == 0) return true;
    if (count != values - from + more) {
        s_.proven = false;
        return false;
    }
    if (speed != nullptr) unseen_.give(formula.first_state(), *speed);
    for (std::size_t k = from; k < values; ++k) unseen_.give(formula.first_state() + more + k - from, of(k));
    return true;
}

/// Prepares the test of a function known as a formula. `first` is its first argument.
bool StretchProof::begin(const Mechanics::UserPiece& own, const Series& first, const Series* speed) {
    model::Formula* formula = good() && own.function != nullptr ? own.function->read() : nullptr;
    if (formula == nullptr) return false;
    unseen_.begin(*formula, own.piece);
    unseen_.give(0, first);
    return give_motion(*formula, speed);
}

bool StretchProof::found(const Unseen::Found& what) {
    s_.proven = s_.proven && what.proven;
    if (what.place) place_ = what.place;
    return what.place.has_value();
}

/// Tests the prepared formula. The error may be `allowed` or the fraction `part` of the value; `size` scales the
/// rounding of time.
void StretchProof::test(double size, double allowed, double part) {
    if (unseen_.certainly_follows(allowed, part)) return;
    // In a decayed motion the function's own constants still round.
    constexpr double few_roundings = 16;
    const double rounded = few_roundings * unseen_.rounded();
    if (std::isfinite(rounded)) allowed += rounded;
    std::optional<std::size_t> last;
    const auto* piece = unseen_.piece();
    for (std::size_t k = 0; piece != nullptr && k < piece->conditions.size() && good(); ++k) {
        const std::size_t step = piece->conditions[k].step;
        if (std::exchange(last, step) == step) continue;
        double noise = smallest;
        const auto close = [&](const Series& series) { return of_last_iteration * cheb::size(series) + noise; };
        Unseen::Found what = unseen_.search(step, budget_, close);
        if (what.place) {  // the compared values may differ by their rounding only
            const double of_operands = few_roundings * unseen_.rounded(step);
            if (std::isfinite(of_operands)) noise += of_operands;
            what = unseen_.search(step, budget_, close);
        }
        if (found(what)) return;
    }
    (void)found(unseen_.search({}, budget_, [&](const Series& series) {
        return std::max(allowed, part * cheb::size(series)) + clearly * lost_in_time(series, late_, s_.h, size);
    }));
}

void StretchProof::test_signal(const Signal& signal, double size, double noise) {
    constexpr double always = clearly * 4 * rounding;
    signal.for_each_read(
        s_.time(0), [&](model::Formula& formula, const model::terms::Piece* piece, double delay, double gain) {
            if (!good()) return;
            unseen_.begin(formula, piece);
            unseen_.give(0, time(delay));
            if (!give_motion(formula)) return;
            const double own = size / std::fabs(gain);
            const double part =
                std::max(clearly * beside_.tolerance + always, formula.takes_motion() ? of_last_iteration : 0);
            test(own, part * own + (clearly * noise + smallest) / std::fabs(gain), 0);
        });
}

/// Tests functions of the past motion. It is smooth on a stretch, because its breaks are repeated as breaks.
void StretchProof::test_delayed(const Signal& signal, double size, double noise) {
    signal.for_each_delayed(s_.time(0), [&](model::Formula& formula, double gain, const auto& past_at) {
        if (!good()) return;
        std::vector<Nodes> values;
        for (std::size_t j = 0; j < node_count; ++j) {
            const std::vector<double> y = past_at(s_.time(middle_ + half_ * cheb::nodes[j]));
            values.resize(y.size());
            for (std::size_t k = 0; k < y.size(); ++k) values[k][j] = y[k];
        }
        std::vector<Series> past;
        past.reserve(values.size());
        for (const Nodes& each : values) past.push_back(cheb::fit(each));
        unseen_.begin(formula, nullptr);
        unseen_.give(0, time(0));
        if (!give_motion(formula, nullptr, &past)) return;
        test(size / std::fabs(gain),
             of_last_iteration * size / std::fabs(gain) + (clearly * noise + smallest) / std::fabs(gain), 0);
    });
}

void StretchProof::loads() {
    double slowest = model::never;
    for (std::size_t i = 0; i < n_; ++i) slowest = std::min(slowest, size_on(i) / inertia(i));
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const model::Weight& first = mechanics_.system().joints[j].of.front();
        const double size = size_on(first.body) / std::fabs(first.by);
        test_signal(mechanics_.loads()[j], size, rough(first.body));
        test_delayed(mechanics_.loads()[j], size, rough(first.body));
    }
    test_signal(mechanics_.base_signal(), slowest, 0);
}

void StretchProof::rates() {
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) {
        const double size =
            std::max({greatest(s_.y[2 * n_ + k]) / s_.h, greatest(s_.f[2 * n_ + k]), beside_.fastest_rate[k]});
        const double allowed = of_last_iteration * size + clearly * rough(n_ + k) + smallest;
        if (begin(mechanics_.rate_function(k), time(0))) test(size, allowed, 0);
        const Mechanics::UserPiece beyond = mechanics_.rate_function_beyond(k);
        if (beyond.piece != nullptr && begin(beyond, time(0))) test(size, allowed, 0);
    }
}

void StretchProof::events() {
    for (std::size_t e = 0; e < mechanics_.events(); ++e) {
        if (begin(mechanics_.when_function(e), time(0))) test(0, smallest, of_last_iteration);
    }
    for (const Signal& load : mechanics_.loads()) {
        load.for_each_relay_function([&](model::UserFunction& function) {
            const model::Formula* formula = function.read();
            if (formula == nullptr || formula->has_conditions_of_motion()) return;
            if (begin({&function}, time(0))) test(0, smallest, of_last_iteration);
        });
    }
}

/// Tests the belt, friction and spring of a joint.
void StretchProof::contact(std::size_t j, const Moment& middle) {
    const model::Joint& joint = mechanics_.system().joints[j];
    const std::size_t body = joint.first();
    const auto between = [&](std::size_t from) {
        Series sum{};
        for (const auto& [of, by] : joint.of) add(sum, whole(from + of), by);
        return sum;
    };
    const double size = size_on(body);
    if (mechanics_.has_belt(j)) {
        test_signal(mechanics_.belt_signal(j), std::max(beside_.fastest_belt[j], greatest(s_.y[n_ + body])), 0);
    }
    const bool open = mechanics_.may_open(j) && mode_.rubs[j] == 0;
    mechanics_.for_each_friction(j, mode_, middle, [&](const Signal& signal, double torque) {
        // An open contact may have no torque to compare with: what counts is whether it stays open.
        const auto value = [&](const Moment& at) { return signal.value(at); };
        const double own = open ? greatest(s_.at_nodes(value, point_)) : 0;
        test_signal(signal, torque > 0 ? std::max(size / torque, own) : model::never, 0);
    });
    const double allowed = of_last_iteration * size + clearly * rough(body) + smallest;
    if (begin(mechanics_.spring_function(j), between(0))) test(size, allowed, 0);
    const Slipping& how = mode_.friction[j];
    const Mechanics::UserPiece law = mechanics_.law_function(j);
    if (law.function == nullptr || mode_.leans[j] != 0 || how.riding) return;
    // While the contact sticks, its limit is the law at speed 0.
    const bool alone = joint.friction.function == nullptr, sticks = how.way == model::Motion::stuck;
    if (alone && sticks) return;
    Series speed = sticks ? Series{} : between(n_);
    if (mechanics_.has_belt(j) && !sticks) speed = difference(speed, on_part(cheb::fit(s_.belts[j]), middle_, half_));
    for (double& c : speed) c *= model::sign_of(how.way);
    if (begin(law, alone ? speed : time(0), alone ? nullptr : &speed)) test(size, allowed, 0);
}

}  // namespace

bool Proofs::hides_nothing(Segment& s, const Mode& mode, const Beside& beside, double until) {
    constexpr int search_budget = 64, many_failures = 4;
    const double late = std::max(std::fabs(s.start.hi), std::fabs(s.end));
    if (!any_ || s.h <= 64 * rounding * late) return true;
    StretchProof proof(mechanics_, unseen_, s, mode, beside, failed_in_a_row_ < many_failures ? search_budget : 1,
                       until);
    proof.loads();
    proof.rates();
    proof.events();
    for (std::size_t j = 0; j < mechanics_.joints() && proof.good(); ++j) {
        proof.contact(j, s.moment(node_count / 2, point_));
    }
    if (!proof.good()) seen_ = s.time(proof.place());
    if (proof.good()) failed_in_a_row_ = s.proven ? 0 : failed_in_a_row_ + 1;
    return proof.good();
}

/// The rounding of a formula at a node of the stretch, or 0 if unknown. `first` is its first argument, and `speed` the
/// one before the states.
double Proofs::rounding_at(std::size_t node, const Segment& s, model::Formula& formula,
                           const model::terms::Piece* piece, double first, const double* speed) {
    const std::size_t n = mechanics_.bodies();
    const bool named = mechanics_.system().named;
    const std::size_t values = 2 * n + mechanics_.states_of_user(), from = named ? 0 : 2;
    const auto constant = [](double x) { return Series{x}; };
    unseen_.begin(formula, piece);
    unseen_.give(0, constant(first));
    if (formula.takes_motion() && !named) {
        unseen_.give(1, constant(s.y[0][node])), unseen_.give(2, constant(s.y[n][node]));
    }
    std::size_t place = formula.first_state();
    const std::size_t behind = place + formula.state_count();
    if (speed != nullptr && place < behind) unseen_.give(place++, constant(*speed));
    for (std::size_t i = from; i < values && place < behind; ++i) unseen_.give(place++, constant(s.y[i][node]));
    const double rounded = unseen_.rounded();
    return std::isfinite(rounded) ? rounded : 0;
}

/// Sums the rounding of the formulas of a signal at a node.
double Proofs::rounding_at(std::size_t node, const Segment& s, const Signal& signal) {
    double sum = 0;
    const double t = s.times[node];
    signal.for_each_read(t, [&](model::Formula& formula, const auto* piece, double delay, double gain) {
        sum += std::fabs(gain) * rounding_at(node, s, formula, piece, t - delay, nullptr);
    });
    return sum;
}

namespace {

constexpr std::array<std::size_t, 3> looked_at{0, node_count / 2, node_count - 1};

}  // namespace

double Proofs::rounding_of_belt(const Segment& s, std::size_t joint) {
    double most = 0;
    for (const std::size_t node : looked_at) most = std::max(most, rounding_at(node, s, mechanics_.belt_signal(joint)));
    return most;
}

double Proofs::rounding_of_limit(const Segment& s, const Mode& mode, std::size_t joint) {
    double most = 0;
    const Mechanics::UserPiece law = mechanics_.law_function(joint);
    const bool alone = mechanics_.system().joints[joint].friction.function == nullptr;
    model::Formula* formula = law.function != nullptr && !alone ? law.function->read() : nullptr;
    for (const std::size_t node : looked_at) {
        double sum = 0;
        mechanics_.for_each_friction(joint, mode, s.moment(node, point_), [&](const Signal& signal, double torque) {
            sum += std::fabs(torque) * rounding_at(node, s, signal);
        });
        const double at_rest = 0;
        if (formula != nullptr) sum += rounding_at(node, s, *formula, law.piece, s.times[node], &at_rest);
        most = std::max(most, sum);
    }
    return most;
}

std::vector<double> Proofs::roundings(const Segment& s, const Mode& mode) {
    const std::size_t n = mechanics_.bodies();
    std::vector<double> of(n + mechanics_.states());
    const auto add_piece = [&](std::size_t k, const Mechanics::UserPiece& own, double first, const double* speed) {
        model::Formula* formula = own.function != nullptr ? own.function->read() : nullptr;
        if (formula != nullptr) of[k] += rounding_at(0, s, *formula, own.piece, first, speed);
    };
    const double t = s.start.hi;
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) {
        add_piece(n + k, mechanics_.rate_function(k), t, nullptr);
    }
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const model::Joint& joint = mechanics_.system().joints[j];
        double angle = 0, slip = -s.belts[j][0];
        for (const auto& [body, by] : joint.of) angle += by * s.y[body][0], slip += by * s.y[n + body][0];
        slip *= model::sign_of(mode.friction[j].way);
        const bool alone = joint.friction.function == nullptr, slides = mode.friction[j].way != model::Motion::stuck;
        for (const auto& [body, by] : joint.of) {
            const auto add_read = [&, k = body, per = by](const Signal& signal, double torque) {
                of[k] += std::fabs(per * torque) * rounding_at(0, s, signal);
            };
            add_read(mechanics_.loads()[j], 1);
            if (slides) mechanics_.for_each_friction(j, mode, s.moment(0, point_), add_read);
            add_piece(body, mechanics_.spring_function(j), angle, nullptr);
            if (slides) add_piece(body, mechanics_.law_function(j), alone ? slip : t, alone ? nullptr : &slip);
        }
    }
    return of;
}

}  // namespace dinal::motion::engine
