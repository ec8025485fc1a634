
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/laws/coulomb.hpp"
#include "model/laws/stribeck.hpp"
#include "model/laws/tabulated.hpp"
#include "model/laws/user_law.hpp"
#include "model/springs.hpp"
#include "support/kinds.hpp"
#include "support/random_case.hpp"
#include "support/systems.hpp"
#include "support/written.hpp"

namespace dinal::truth {

namespace {

/// A perturbation of the load, to measure a case's sensitivity to errors.
constexpr double mixed_nudge = 1e-8;

template <class... T>
void say(RandomCase& c, std::string_view words, const T&... values) {
    c.story += fmt::vformat(words, fmt::make_format_args(values...)) + "; ";
}

/// A formula of t, theta, velocity and z for both sides.
template <class Formula>
std::shared_ptr<model::UserFunction> ours(Formula f) {
    return written([f](double t, const model::State& y, std::span<const double> z) {
        return static_cast<double>(f(t, y.theta, y.velocity, z.empty() ? 0.0 : z[0]));
    });
}
template <class Formula>
MixedSystem::F<real> theirs(Formula f) {
    return [f](real t, const MixedPoint& y) -> real { return f(t, y.theta, y.velocity, y.z); };
}

model::Excitation driven(const std::shared_ptr<model::UserFunction>& function, bool feedback = true) {
    return model::Excitation::make(model::Scripted{.function = function, .feedback = feedback}).value();
}

template <class Torque>
void give_spring(RandomCase& c, Torque torque) {
    c.parameters.spring = model::springs::UserSpring{
        written([torque](double x, const model::State&, std::span<const double>) { return torque(x); })};
    c.truth.spring = torque;
}

void draw_spring(Lot& lot, RandomCase& c) {
    const double a = lot.between(0.2, 1), b = lot.between(-0.2, 0.2), well = -c.parameters.stiffness - a;
    const auto powers = [&c](const std::vector<std::pair<int, double>>& terms) {
        c.parameters.spring = model::springs::PolynomialSpring{terms};
        c.truth.spring = [terms](real x) {
            real sum = 0;
            for (const auto& [power, factor] : terms) sum += factor * std::pow(x, static_cast<real>(power));
            return sum;
        };
    };
    const int kind = lot.of(4);
    if (kind == 0) powers({{3, a}});
    if (kind == 1) powers({{1, well}, {2, b}, {3, a + 0.2}});  // a double well, held together by its cubic part
    if (kind == 2) give_spring(c, [a](auto x) { return a * std::sin(x); });
    if (kind == 3) give_spring(c, [a](auto x) { return a * std::sinh(x); });
    say(c, "spring {} (cubic, well, pendulum, progressive) {:.17g} {:.17g}", kind, a, b);
}

void draw_system(Lot& lot, RandomCase& c) {
    model::OscillatorParameters& p = c.parameters;
    p.inertia = lot.between(0.5, 2), p.stiffness = lot.once_in(4) ? 0 : lot.between(0.3, 2);
    p.damping = lot.once_in(3) ? 0 : lot.between(0, 0.3);
    c.truth.I = p.inertia, c.truth.k = p.stiffness, c.truth.C = p.damping;
    say(c, "I {:.17g} k {:.17g} C {:.17g}", p.inertia, p.stiffness, p.damping);
    if (lot.once_in(3)) draw_spring(lot, c);
    const double Rd = lot.between(0.05, 0.3), Re = lot.once_in(3) ? Rd : Rd * lot.between(1, 1.6);
    c.truth.holding = {Re, Re};
    switch (lot.of(6)) {
        case 0: {
            const double other = Rd * lot.between(0.3, 1), holds = other * lot.between(1, 2);
            p.friction = model::laws::AsymmetricCoulomb{.forward = {Rd, Re}, .backward = {other, holds}};
            c.truth.holding[0] = holds;
            c.truth.sliding = {{[=](int way, real) -> real { return way > 0 ? Rd : other; }}};
            say(c, "forward Rd {:.17g} Re {:.17g}, backward Rd {:.17g} Re {:.17g}", Rd, Re, other, holds);
            break;
        }
        case 1: {
            const double speed = lot.power_of_ten(-1.7, -0.2);
            const int shape = 1 + lot.of(3);
            p.friction = model::laws::Stribeck{
                .kinetic = Rd, .breakaway = Re, .speed = speed, .shape = static_cast<double>(shape)};
            // Below speed 0 the same formula continues smoothly.
            const auto torque = [=](int, real v) -> real {
                return Rd + (static_cast<real>(Re) - Rd) * std::exp(-std::pow(v / static_cast<real>(speed), shape));
            };
            c.truth.sliding = {{torque, 1 / static_cast<real>(speed)}};
            say(c, "stribeck Rd {:.17g} Re {:.17g} speed {:.17g} shape {}", Rd, Re, speed, shape);
            break;
        }
        case 2: {
            const double rise = lot.between(0, 0.3);
            p.friction = model::laws::UserLaw{
                .function = written([=](double v, const model::State&, auto) { return Rd + rise * v / (1 + v); }),
                .at_zero = Rd,
                .breakaway = Re};
            // Below speed 0 the law is the point reflection at its value at 0.
            c.truth.sliding = {{[=](int, real v) -> real { return Rd + rise * v / (1 + std::fabs(v)); }}};
            say(c, "law Rd {:.17g} rise {:.17g} Re {:.17g}", Rd, rise, Re);
            break;
        }
        case 3: {
            model::laws::Tabulated table{.speed = {0}, .torque = {Rd}, .breakaway = Re};
            for (int corners = 1 + lot.of(5); corners > 0; --corners) {
                table.speed.push_back(table.speed.back() + lot.power_of_ten(-3, 0));
                table.torque.push_back(lot.between(0, 0.6));
            }
            c.truth.sliding = lines_through(table.speed, table.torque);
            c.corners = true;
            say(c, "{}", table.lua_text());
            p.friction = std::move(table);
            break;
        }
        default:
            p.kinetic_friction = Rd, p.breakaway = Re;
            c.truth.sliding = {{[=](int, real) -> real { return Rd; }}};
            say(c, "Rd {:.17g} Re {:.17g}", Rd, Re);
    }
    if (lot.once_in(4)) {
        model::Walls walls{-lot.between(0.3, 1.2), lot.between(0.3, 1.2), lot.once_in(3) ? 0 : lot.between(0.3, 1)};
        if (lot.once_in(3)) walls.lower = -model::never;
        p.walls = walls;
        c.truth.walls = true;
        c.truth.lower = walls.lower, c.truth.upper = walls.upper, c.truth.restitution = walls.restitution;
        c.drive.theta0 = {lot.between(std::max(walls.lower, -1.0), walls.upper)};
        say(c, "walls {}", walls.lua_text());
    }
}

/// Draws M as a function of time: a sine, alone or with a record, a window of it, or announced or unannounced jumps.
void draw_course(Lot& lot, RandomCase& c) {
    const double a = lot.between(0.2, 1.2), w = lot.between(0.4, 2.5), phase = lot.between(0, 6);
    const double level = lot.between(-0.3, 0.3), from = lot.between(0.5, 3), length = lot.between(0.3, 4);
    const auto sine = [=](real t) { return a * std::sin(static_cast<real>(w) * t + static_cast<real>(phase)); };
    const int kind = lot.of(5);
    const bool in_window = kind == 2;
    c.drive.loads = {in_window ? harmonic(a, w, phase).windowed(from, from + length) : harmonic(a, w, phase)};
    c.drive.loads = {c.drive.M() + native(model::Constant{level})};
    c.truth.M = [=](real t, const MixedPoint&) -> real { return static_cast<real>(level) + (in_window ? 0 : sine(t)); };
    if (in_window) {
        c.truth.breaks = {from, static_cast<real>(from + length)};
        c.truth.broken = [=](real t, real inside, const MixedPoint&) -> real {
            return inside > from && inside < static_cast<real>(from + length) ? sine(t) : 0;
        };
    }
    if (kind == 3) {
        auto record = std::make_shared<model::Samples>();
        for (double t = from; t < 40; t += lot.between(0.05, 1.5)) {
            record->t.push_back(t), record->M.push_back(lot.between(-1, 1));
        }
        c.drive.loads = {c.drive.M() + native(std::shared_ptr<const model::Samples>(record))};
        c.truth.breaks.assign(record->t.begin(), record->t.end());
        c.truth.broken = [record](real t, real inside, const MixedPoint&) -> real {
            const auto& at = record->t;
            const auto next = std::upper_bound(at.begin(), at.end(), static_cast<double>(inside)) - at.begin();
            if (next == 0) return record->M.front();
            const auto i = static_cast<std::size_t>(next);
            const real part = (t - at[i - 1]) / (static_cast<real>(at[i]) - at[i - 1]);
            return record->M[i - 1] + part * (static_cast<real>(record->M[i]) - record->M[i - 1]);
        };
    }
    if (kind == 4) {
        const bool announced = lot.once_in(2);
        const auto high = [=](double t) {
            return t < from ? -level : std::fmod(t - from, length) < length / 2 ? 0.5 : -0.5;
        };
        if (announced) {
            for (double t = from, before = -level; t < 40; t += length / 2) {
                const double now = high(t + length / 4);
                c.drive.loads = {c.drive.M() + native(model::Step{now - before, t})};
                before = now;
            }
            c.drive.loads = {c.drive.M() + native(model::Constant{-level})};
        } else {
            c.drive.loads = {c.drive.M() +
                             driven(written([=](double t, const model::State&, auto) { return high(t); }), false)};
            c.untold = true;
        }
        for (int i = 0; from + i * length / 2 < 40; ++i)
            c.truth.breaks.push_back(from + static_cast<real>(i) * length / 2);
        c.truth.broken = [=](real, real inside, const MixedPoint&) -> real {
            return high(static_cast<double>(inside));
        };
    }
    say(c, "M {:.17g} sin({:.17g} t + {:.17g}) + {:.17g}, {} (2 window, 3 record, 4 jumps{}) from {:.17g} by {:.17g}",
        a, w, phase, level, kind, c.untold ? ", not told" : "", from, length);
}

/// Draws M without a memory, which may depend on the motion and on a state.
void draw_load(Lot& lot, RandomCase& c) {
    draw_course(lot, c);
    const bool loop = lot.once_in(3), has_state = lot.once_in(2);
    const double P = loop ? lot.between(0.2, 3) : 0, D = loop ? lot.between(0, 1) : 0;
    const double Z = has_state ? lot.between(-0.8, 0.8) : 0;
    say(c, "less {:.17g} theta, {:.17g} velocity, and {:.17g} z", P, D, Z);
    const auto feedback_part = [=](auto, auto theta, auto velocity, auto z) {
        return Z * z - P * theta - D * velocity;
    };
    if (loop || has_state) c.drive.loads = {c.drive.M() + driven(ours(feedback_part))};
    c.truth.M = [=, course = c.truth.M](real t, const MixedPoint& y) -> real {
        return course(t, y) + feedback_part(t, y.theta, y.velocity, y.z);
    };
    if (!has_state) return;
    const double own = lot.once_in(4) ? 0 : lot.power_of_ten(-1, 1), of_theta = lot.between(-1, 1);
    const auto rate = [=](auto t, auto theta, auto velocity, auto z) {
        return of_theta * theta + 0.2 * velocity - own * z + 0.3 * std::cos(t);
    };
    c.z0 = lot.between(-0.5, 0.5);
    c.drive.states.push_back({.name = "z", .start = c.z0, .rate = ours(rate)});
    c.truth.rate = theirs(rate);
    say(c, "z' = {:.17g} theta + .2 velocity - {:.17g} z + .3 cos t from {:.17g}", of_theta, own, c.z0);
}

void draw_controller(Lot& lot, RandomCase& c) {
    const double P = lot.between(0.1, 0.8), D = lot.between(0, 0.4);
    const auto law = [=](auto t, auto theta, auto velocity, auto z) {
        return 0.1 * std::sin(t) - P * theta - D * velocity + 0.1 * z;
    };
    const int kind = lot.of(4);
    c.remembers = kind < 3;
    switch (kind) {
        case 0: {
            auto controller = std::make_shared<model::SampledController>();
            controller->function = ours(law);
            controller->every = lot.between(0.05, 0.7);
            controller->delay = lot.once_in(2) ? 0 : controller->every * lot.between(0.1, 2.5);
            c.truth.sampled = theirs(law), c.truth.every = controller->every, c.truth.delay = controller->delay;
            say(c, "sampled every {:.17g} delay {:.17g} P {:.17g} D {:.17g}", controller->every, controller->delay, P,
                D);
            c.drive.loads = {c.drive.M() + driven(controller)};
            return;
        }
        case 1: {
            auto relay = std::make_shared<model::RelayController>();
            relay->on = lot.between(-0.3, 0.1), relay->off = relay->on + lot.between(0.05, 0.4);
            if (lot.once_in(2)) std::swap(relay->on, relay->off);
            relay->levels = {lot.between(-0.6, 0.6), lot.between(-0.6, 0.6)};
            const auto mixed = [](auto, auto theta, auto velocity, auto) { return theta + 0.3 * velocity; };
            const bool state = !c.drive.states.empty();
            switch (lot.of(state ? 4 : 3)) {
                case 0:
                    c.truth.relay_of = [](real, const MixedPoint& y) { return y.theta; };
                    break;
                case 1:
                    relay->of = model::RelayController::Of::velocity;
                    c.truth.relay_of = [](real, const MixedPoint& y) { return y.velocity; };
                    break;
                case 2:
                    relay->of = model::RelayController::Of::function, relay->function = ours(mixed);
                    c.truth.relay_of = theirs(mixed);
                    break;
                default:
                    relay->of = model::RelayController::Of::state, relay->state = "z";
                    c.truth.relay_of = [](real, const MixedPoint& y) { return y.z; };
            }
            c.truth.on = relay->on, c.truth.off = relay->off;
            c.truth.levels = {relay->levels[0], relay->levels[1]};
            say(c, "relay of {} on {:.17g} off {:.17g} levels {:.17g} {:.17g}", static_cast<int>(relay->of), relay->on,
                relay->off, relay->levels[0], relay->levels[1]);
            c.drive.loads = {c.drive.M() + driven(relay)};
            return;
        }
        case 2: {
            auto delayed = std::make_shared<model::DelayedController>();
            const auto back = [=](auto, auto theta, auto velocity, auto) { return -P * theta - D * velocity; };
            delayed->function = ours(back);
            delayed->by = lot.once_in(3) ? lot.between(0.02, 0.1) : lot.between(0.1, 9);
            c.truth.delayed = theirs(back), c.truth.by = delayed->by;
            say(c, "delayed by {:.17g} P {:.17g} D {:.17g}", delayed->by, P, D);
            c.drive.loads = {c.drive.M() + driven(delayed)};
            return;
        }
        default:
            return;
    }
}

void draw_surroundings(Lot& lot, RandomCase& c) {
    const double a = lot.between(-0.4, 0.4), w = lot.between(0.3, 2), mean = lot.between(-0.4, 0.4);
    switch (lot.of(6)) {
        case 0:
            c.drive.belts = {model::Excitation::make(model::Constant{mean}).value()};
            c.truth.belt = [=](real) -> real { return mean; };
            c.truth.belt_rate = [](real) -> real { return 0; };
            say(c, "belt {:.17g}", mean);
            break;
        case 1:
        case 2: {
            const auto velocity = [=](auto t, auto, auto, auto) { return mean + a * std::sin(w * t); };
            c.drive.belts = {lot.once_in(2) ? model::Excitation::make(model::Constant{mean}).value() + harmonic(a, w)
                                            : driven(ours(velocity), false)};
            c.truth.belt = [=](real t) -> real { return velocity(t, 0, 0, 0); };
            c.truth.belt_rate = [=](real t) -> real { return a * w * std::cos(w * t); };
            say(c, "belt {:.17g} + {:.17g} sin({:.17g} t)", mean, a, w);
            break;
        }
        default:
            break;
    }
    if (lot.once_in(5)) {
        c.drive.base = harmonic(a, w);
        c.truth.base = [=](real t) -> real { return a * std::sin(static_cast<real>(w) * t); };
        say(c, "base {:.17g} sin({:.17g} t)", a, w);
    }
}

struct Bounce final : model::EventAction {
    explicit Bounce(double part) : part_(part) {}
    bool act(double /*t*/, model::State& y, std::span<double> /*z*/) override {
        y.velocity *= part_;
        return true;
    }

private:
    double part_;
};

void draw_event(Lot& lot, RandomCase& c) {
    if (!lot.once_in(3)) return;
    const double level = lot.between(-0.5, 0.5), part = lot.once_in(2) ? 1 : lot.between(-0.9, 0.9);
    const auto passes = [=](auto, auto theta, auto, auto) { return theta - level; };
    model::WantedEvent event{.name = "level", .when = ours(passes), .direction = model::Direction::up};
    if (part != 1) event.act = std::make_shared<Bounce>(part);
    c.drive.events.push_back(event);
    c.truth.when = theirs(passes), c.truth.kept_velocity = part;
    say(c, "event theta up past {:.17g} leaves {:.17g} of the velocity", level, part);
}

}  // namespace

RandomCase random_case_of_all_kinds(std::uint64_t number) {
    Lot lot(number * 0x2545f4914f6cdd1dU + 17);
    RandomCase c;
    c.drive.start_at({lot.between(-1, 1), lot.once_in(3) ? 0 : lot.between(-1.2, 1.2)});
    draw_system(lot, c);
    draw_load(lot, c);
    draw_controller(lot, c);
    draw_surroundings(lot, c);
    draw_event(lot, c);
    c.window = {0, lot.between(4, 16)};
    say(c, "from {:.17g} {:.17g} to {:.17g}", c.drive.start().theta, c.drive.start().velocity, c.window.end);
    constexpr int places = 10;
    for (int i = 0; i < places; ++i) c.times.push_back(c.window.end * (i + lot.between(0, 1)) / places);
    return c;
}

namespace {

std::string kinds_of_all(const std::vector<MixedEvent>& events) {
    std::string text;
    for (const MixedEvent& event : events) text += event.kind + ' ';
    return text;
}

/// What the second opinion says of a case, and what it says if the load is off by mixed_nudge.
struct Opinion {
    MixedTruth truth, beside;

    explicit Opinion(const RandomCase& c)
        : truth(c.truth, start_of(c), length_of(c), times_of(c)),
          beside(nudged(c.truth), start_of(c), length_of(c), times_of(c)) {}
    bool is_clear() const {
        return !truth.doubtful && !beside.doubtful && kinds_of_all(truth.events) == kinds_of_all(beside.events);
    }

private:
    static MixedSystem nudged(MixedSystem system) {
        system.M = [f = system.M](real t, const MixedPoint& y) { return f(t, y) + static_cast<real>(mixed_nudge); };
        return system;
    }
    static MixedPoint start_of(const RandomCase& c) {
        const model::State y = c.drive.start();
        return {y.theta / c.angle, y.velocity * c.time / c.angle, c.z0};
    }
    static real length_of(const RandomCase& c) { return (static_cast<real>(c.window.end) - c.window.start) / c.time; }
    static std::vector<double> times_of(const RandomCase& c) {
        std::vector<double> times;
        for (const double t : c.times)
            times.push_back(static_cast<double>((t - static_cast<real>(c.window.start)) / c.time));
        return times;
    }
};

/// The fault of a run; empty if correct. Half of the places are compared as rows, the other half by run.at.
std::string fault_in(const RandomCase& c, motion::MethodView method, const Opinion& opinion, double accuracy) {
    std::vector<double> at_rows;
    for (std::size_t i = 0; i < c.times.size(); i += 2) at_rows.push_back(c.times[i]);
    // Whatever happens ends within this many questions, each of sixteen panels.
    const motion::Monitor patience = [asked = 0](double) mutable { return ++asked < 10000; };
    const auto run =
        motion::simulate(system_of(c.parameters), c.drive, c.window, motion::Grid::at(at_rows), method, patience);
    if (!run) return run.error().sentence;
    if (!model::is_whole(run->outcome)) return std::string(model::sentence(run->outcome));
    if (!run->rows.matrix().allFinite()) return "a row is not finite";
    std::string found;
    for (const model::Event& event : run->events) {
        found += event.kind == model::EventKind::user ? "user " : std::string(name(as_stop(event.kind))) + ' ';
    }
    const std::string expected = kinds_of_all(opinion.truth.events);
    if (found != expected) return "events " + found + "but they are " + expected;
    const auto wrong = [&](real is, real right, real moved, double late) {
        return !(std::fabs(is - right) <=
                 (accuracy + c.lost_in_time) * (10 + std::fabs(moved - right) / mixed_nudge) + late);
    };
    for (std::size_t i = 0; i < run->events.size(); ++i) {
        const MixedEvent &e = opinion.truth.events[i], &s = opinion.beside.events[i];
        const real t = (run->events[i].t - static_cast<real>(c.window.start)) / c.time;
        const real theta = run->events[i].theta / c.angle;
        if (!wrong(t, e.t, s.t, c.late) && !wrong(theta, e.theta, s.theta, 0)) continue;
        return fmt::format("event {}, {} at {:.15g}: off by {:.2e}, {:.2e}; moved {:.2e}", i, e.kind,
                           static_cast<double>(e.t), static_cast<double>(t - e.t), static_cast<double>(theta - e.theta),
                           static_cast<double>(s.t - e.t));
    }
    for (std::size_t i = 0; i < c.times.size(); ++i) {
        const real t = (c.times[i] - static_cast<real>(c.window.start)) / c.time;
        // A row next to a jump of the velocity may be on its other side.
        const bool beside_event =
            std::ranges::any_of(opinion.truth.events, [t](const MixedEvent& e) { return std::fabs(e.t - t) < 1e-6L; });
        if (beside_event) continue;
        const auto row = static_cast<Eigen::Index>(i / 2);
        const auto between = run->at(c.times[i]);
        if (!between) return between.error().sentence;
        const model::State y = i % 2 == 0 ? model::State{run->rows(row, 1), run->rows(row, 2)} : *between;
        const MixedPoint &e = opinion.truth.motions[i], &s = opinion.beside.motions[i];
        const real theta = y.theta / c.angle, velocity = y.velocity * c.time / c.angle;
        const bool z = i % 2 == 0 && !c.drive.states.empty() && wrong(run->rows(row, 6), e.z, s.z, 0);
        if (!z && !wrong(theta, e.theta, s.theta, 0) && !wrong(velocity, e.velocity, s.velocity, 0)) continue;
        return fmt::format("at {:.15g}: off by {:.2e}, {:.2e}{}; moved {:.2e}", c.times[i],
                           static_cast<double>(theta - e.theta), static_cast<double>(velocity - e.velocity),
                           z ? ", and z" : "", static_cast<double>(s.theta - e.theta));
    }
    return "";
}

}  // namespace

void check_cases(RandomCase (*random)(std::uint64_t number), const std::vector<Compared>& methods, long cases,
                 long clear) {
    cases = number_from("DINAL_ORACLE_CASES", cases);
    const long first = number_from("DINAL_ORACLE_FIRST", 0);
    long ambiguous = 0;
    for (long i = first; i < first + cases; ++i) {
        const auto number = static_cast<std::uint64_t>(i);
        const RandomCase c = random(number);
        const Opinion opinion(c);
        ambiguous += opinion.is_clear() ? 0 : 1;
        for (const auto& [method, accuracy, takes] : methods) {
            if (!opinion.is_clear() || (takes && !takes(c, number))) continue;
            const std::string fault = fault_in(c, method, opinion, accuracy);
            if (fault.empty()) continue;
            FAIL_CHECK("case " << i << " (DINAL_ORACLE_FIRST=" << i << " DINAL_ORACLE_CASES=1): "
                               << motion::MethodView(method).lua_text(text::Defaults::left_out) << ": " << fault << "\n"
                               << c.story);
        }
    }
    INFO(ambiguous << " ambiguous, of " << cases);
    CHECK(clear * ambiguous <= cases + clear);
}

}  // namespace dinal::truth
