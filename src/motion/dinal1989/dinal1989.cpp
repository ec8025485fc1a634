// The program DINAL of 1989, statement by statement, in double precision. A museum piece: keep its stop rule, its stale
// small velocities and its friction column. Nothing else in dinal may use it.
//
// Names are the listing's: U = k theta/Mc, V = k T0 theta'/Mc (Mc = k here, as in the report, so U = theta), T = t/T0,
// K = h/T0, A = 4 pi zeta, B = 4 pi^2 Rd/Mc, C = 4 pi^2, Z = F = 4 pi^2 M*. F at the end of a step is reused at the
// beginning of the next; without dry friction the four stages, then linear, are summed in advance.
#include "motion/dinal1989/dinal1989.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>

#include "model/excitation.hpp"
#include "model/laws/coulomb.hpp"
#include "model/oscillator.hpp"
#include "motion/interpolation.hpp"
#include "motion/rows.hpp"

namespace dinal::motion::dinal1989 {

namespace {

constexpr double PI2 = 6.28318530718;  // as printed: 2 pi to twelve digits

double SG(double x) {
    return x == 0 ? 0.0 : std::copysign(1.0, x);
}

/// The variables of the loop DO 80.
struct Loop {
    std::size_t step = 0;
    double U = 0, V = 0, T = 0;
    double Z = 0;         ///< F at T
    bool frozen = false;  ///< whether the stop rule undid the last step
};

class Dinal {
public:
    static constexpr std::size_t block_steps = 128;

    Dinal(const model::Oscillator& system, const model::Excitation& excitation, const Dinal1989& options,
          double t_start)
        : system_(system),
          excitation_(excitation),
          options_(options),
          t_start_(t_start),
          feedback_(excitation.has_feedback()),
          T0(PI2 * std::sqrt(system_.inertia() / system_.stiffness())),
          K(options.h / T0),
          A(2 * system_.damping_ratio() * PI2),
          B(system_.kinetic_friction() / system_.stiffness() * (PI2 * PI2)),
          limit_(system_.breakaway() * (PI2 * PI2) / system_.stiffness()) {
        if (B == 0) {
            linear_ = Linear{increment(1, 0, 0, 0, 0), increment(0, 1, 0, 0, 0), increment(0, 0, 1, 0, 0),
                             increment(0, 0, 0, 1, 0)};
        }
    }

    Loop start(const model::State& initial) const {
        Loop p{.U = initial.theta, .V = T0 * initial.velocity};
        p.Z = F(p.T, p.U, p.V);
        return p;
    }

    /// Computes F in the middle and at the end of the steps after p; returns how many are finite.
    std::size_t sample(const Loop& p, std::size_t count) {
        if (feedback_) return 0;
        double T = p.T;
        for (std::size_t i = 0; i < count; ++i) {
            times_[2 * i] = t_start_ + (T + K / 2) * T0;
            times_[2 * i + 1] = t_start_ + (T + K) * T0;
            T = T + K;
        }
        count = excitation_.fill({times_.data(), 2 * count}, {Z_.data(), 2 * count}) / 2;
        for (std::size_t i = 0; i < 2 * count; ++i) Z_[i] = C * (Z_[i] / system_.stiffness());
        return count;
    }

    /// One pass of the loop DO 80, with sample i of the block.
    Loop step(const Loop& p, std::size_t i) const {
        if (feedback_) return judged(p, feedback_increment(p), 0);
        return judged(p,
                      linear_ ? sum(*linear_, p.U, p.V, p.Z, Z_[2 * i], Z_[2 * i + 1])
                              : increment(p.U, p.V, p.Z, Z_[2 * i], Z_[2 * i + 1]),
                      Z_[2 * i + 1]);
    }
    /// One pass without prepared samples.
    [[nodiscard]] Loop step(const Loop& p) {
        if (!feedback_) {
            for (const int end : {0, 1}) {
                Z_[static_cast<std::size_t>(end)] = F(end == 0 ? p.T + K / 2 : p.T + K, 0, 0);
            }
        }
        return step(p, 0);
    }

    /// Makes several passes at once while the result of the stop rule and the sign of the velocity stay the same.
    std::size_t plain_steps(Loop& p, std::size_t i, std::size_t stop) const {
        const auto plain = [&](auto&& change) {
            double U = p.U, V = p.V, T = p.T, Z = p.Z;
            std::size_t n = i;
            for (; n < stop; ++n) {
                const double Z1 = Z_[2 * n + 1];
                const Change d = change(U, V, Z, Z_[2 * n], Z1);
                const double U1 = U + d.U, V1 = V + d.V;
                const bool stopped = stops(V, V1, U1, Z1);
                if (stopped != p.frozen || !(std::fabs(U1) < model::never)) break;
                if (!stopped) {
                    if (!(V * V1 > 0)) break;
                    U = U1, V = V1;
                }
                Z = Z1, T = T + K;
            }
            p = {p.step + (n - i), U, V, T, Z, p.frozen};
            return n;
        };
        if (feedback_) return i;
        return linear_ ? plain([&, m = *linear_](double U, double V, double Z, double Zm, double Z1) {
            return sum(m, U, V, Z, Zm, Z1);
        })
                       : plain([&](double U, double V, double Z, double Zm, double Z1) {
                             return increment(U, V, Z, Zm, Z1);
                         });
    }

    /// theta and velocity, in the user's units.
    model::State state(const Loop& p) const { return {p.U, p.V / T0}; }
    double M(const Loop& p) const { return system_.stiffness() * (p.Z / C); }
    /// -Rd sgn(V), as printed, also while frozen.
    double friction(const Loop& p) const { return 0.0 - system_.kinetic_friction() * SG(p.V); }
    double time(const Loop& p) const { return t_start_ + p.T * T0; }
    double acceleration(const Loop& p) const { return (p.Z - A * p.V - B * SG(p.V) - C * p.U) / (T0 * T0); }
    const model::Excitation& excitation() const { return excitation_; }

private:
    struct Change {
        double U, V;
    };
    /// The change in one step for unit U, V, Z and Zm; Z1 adds K/6 to the change of V.
    struct Linear {
        Change U, V, Z, Zm;
    };

    double F(double T, double U, double V) const {
        return C * (excitation_.value(t_start_ + T * T0, model::State{U, V / T0}) / system_.stiffness());
    }

    /// B SG(Y)
    double dry_friction_term(double Y) const { return Y == 0 ? 0 : std::copysign(B, Y); }
    // NOTE: the sum is grouped so as to shorten the chain of dependent operations.
    double Q2(double X, double Y, double Z) const { return K * ((Z - C * X) - (dry_friction_term(Y) + A * Y)); }

    /// The four stages; `f(stage, X, Y)` returns F.
    template <class Force>
    Change stages(double U, double V, Force&& f) const {
        const double Q11 = K * V, Q21 = Q2(U, V, f(1, U, V));
        double X = U + Q11 / 2, Y = V + Q21 / 2;
        const double Q12 = K * Y, Q22 = Q2(X, Y, f(2, X, Y));
        X = U + Q12 / 2, Y = V + (options_.slip ? Q21 : Q22) / 2;
        const double Q13 = K * Y, Q23 = Q2(X, Y, f(3, X, Y));
        X = U + Q13, Y = V + Q23;
        const double Q14 = K * Y, Q24 = Q2(X, Y, f(4, X, Y));
        return {(Q11 + 2 * Q12 + 2 * Q13 + Q14) / 6, (Q21 + 2 * Q22 + 2 * Q23 + Q24) / 6};
    }
    Change increment(double U, double V, double Z, double Zm, double Z1) const {
        return stages(U, V, [=](int stage, double, double) { return stage == 1 ? Z : stage == 4 ? Z1 : Zm; });
    }
    Change feedback_increment(const Loop& p) const {
        return stages(p.U, p.V, [&](int stage, double X, double Y) {
            return stage == 1 ? p.Z : F(p.T + (stage == 4 ? K : K / 2), X, Y);
        });
    }
    Change sum(const Linear& m, double U, double V, double Z, double Zm, double Z1) const {
        return {m.U.U * U + m.V.U * V + (m.Z.U * Z + m.Zm.U * Zm),
                m.U.V * U + m.V.V * V + (m.Z.V * Z + m.Zm.V * Zm + K / 6 * Z1)};
    }

    /// The stop rule, after a step from V to V1.
    bool stops(double V, double V1, double U1, double Z1) const {
        const double change = std::fabs(V - V1);
        const bool slow =
            options_.stop == Dinal1989::Stop::listing ? std::fabs(V1) <= change : std::fabs(V1) < change / 2;
        return slow && std::fabs(Z1 - C * U1) <= limit_;
    }
    Loop judged(const Loop& p, const Change& d, double Z1) const {
        Loop next{p.step + 1, p.U + d.U, p.V + d.V, p.T + K, Z1, false};
        if (feedback_) next.Z = F(next.T, next.U, next.V);
        if (stops(p.V, next.V, next.U, next.Z)) {
            next.U = p.U;
            next.V = p.V;
            next.frozen = true;
        }
        return next;
    }

    static constexpr double C = PI2 * PI2;
    const model::Oscillator& system_;
    const model::Excitation& excitation_;
    Dinal1989 options_;
    double t_start_;
    bool feedback_;
    double T0, K, A, B;
    double limit_;                  // the listing's Re 4 pi^2/Mc
    std::optional<Linear> linear_;  // without dry friction
    std::array<double, 2 * block_steps> times_{};
    std::array<double, 2 * block_steps> Z_{};  // F in the middle and at the end of each step of the block
};

/// The motion between two steps, which the program of 1989 did not compute: interpolated, or at rest when frozen.
model::State between(const Dinal& dinal, const Loop& a, const Loop& b, double t) {
    if (b.frozen) return dinal.state(a);
    const double t0 = dinal.time(a);
    return StepInterpolant(dinal.time(b) - t0, dinal.state(a), dinal.acceleration(a), dinal.state(b),
                           dinal.acceleration(b))(t - t0);
}

/// Returns whether the next row falls on this step, so that it shows the listing's own numbers. (The last row, at
/// t_end, may not.)
bool on_step(const RowWriter& rows, double t_start, double h, std::size_t step, std::size_t steps_per_row) {
    if (steps_per_row == 0 || rows.next_row() * steps_per_row != step) return false;
    return std::fabs(rows.next_time() - (t_start + static_cast<double>(step) * h)) < 0.5e-9 * h;
}

/// Returns a step up to which no row is due; if rows and steps do not coincide, not necessarily the last such step.
std::size_t step_before_row(const RowWriter& rows, double t_start, double h, std::size_t steps_per_row) {
    if (rows.next_time() == model::never) return std::numeric_limits<std::size_t>::max();
    const std::size_t row_step = rows.next_row() * steps_per_row;
    if (on_step(rows, t_start, h, row_step, steps_per_row)) return row_step;
    return static_cast<std::size_t>(std::max((rows.next_time() - t_start) / h - 2, 0.0));
}

/// Writes the rows before the step to b; returns false if M is not finite at one of them.
bool rows_between(RowWriter& rows, const Dinal& dinal, const Loop& a, const Loop& b) {
    const double end = dinal.time(b);
    while (rows.next_time() < end) {
        const double t = rows.next_time();
        const model::State y = between(dinal, a, b, t);
        const double M = dinal.excitation().value(t, y);
        if (!std::isfinite(M) || !std::isfinite(y.theta) || !std::isfinite(y.velocity)) return false;
        rows.put(y, M, dinal.friction(a));
    }
    return true;
}

/// Derives an event from the stop rule and the sign of V, at the step that detects it.
void record_event(std::vector<model::Event>& events, const Dinal& dinal, const Loop& a, const Loop& b) {
    std::optional<model::EventKind> kind;
    if (b.frozen != a.frozen) {
        kind = b.frozen ? model::EventKind::stick : model::EventKind::slip;
    } else if (a.V * b.V < 0) {
        kind = model::EventKind::turn;
    }
    if (kind) events.push_back({dinal.time(b), *kind, b.U, dinal.M(b)});
}

model::Outcome not_finite(const Loop& p) {
    return std::isfinite(p.Z) ? model::Outcome::state_not_finite : model::Outcome::excitation_not_finite;
}

bool finite(const Loop& p) {
    return std::isfinite(p.U) && std::isfinite(p.V) && std::isfinite(p.Z);
}

/// The motion between the rows, computed by repeating steps.
class Replay final : public Course {
public:
    Replay(const Problem& problem, const Dinal1989& options, std::size_t steps)
        : Course(problem.system),
          checkpoints(steps),
          excitation_(problem.drive.M()),
          options_(options),
          t_start_(problem.window.start) {}

    text::Expected<model::State> at(double t) const override {
        Dinal dinal(system(), excitation_, options_, t_start_);
        const auto step = static_cast<std::size_t>(std::max((t - t_start_) / options_.h - 1, 0.0));
        Loop a = checkpoints.before(step);
        for (;;) {
            const Loop b = dinal.step(a);
            if (dinal.time(b) > t || !finite(b)) return finite(b) ? between(dinal, a, b, t) : dinal.state(a);
            a = b;
        }
    }

    Checkpoints<Loop> checkpoints;

private:
    model::Excitation excitation_;
    Dinal1989 options_;
    double t_start_;
};

}  // namespace

OwnRule Dinal1989::own_rule() const {
    return {fmt::format(
                "The run was integrated as in 1989, in steps of h = {:.5g}: events are detected at the ends of steps, "
                "and the stop rule of the listing decides what is a stop.",
                h),
            "the listing released it at"};
}

/// Returns an error unless the system has only what the program of 1989 read: I, k, C, Rd, Re and Mc.
std::optional<text::Error> Dinal1989::wrong_for(const model::Oscillator& system,
                                                const model::Excitation& /*excitation*/) const {
    if (!system.has_spring()) {
        return text::Error{.sentence = "integrator.dinal1989 divides by k: for k = 0 use integrator.spectral or rk4",
                           .option = "integrator"};
    }
    if (system.walls()) {
        return text::Error{.sentence = "integrator.dinal1989 does not support walls: use integrator.spectral or rk4",
                           .option = "integrator"};
    }
    if (!system.spring().none()) {
        return text::Error{
            .sentence = "integrator.dinal1989 supports only the spring k theta: use integrator.spectral or rk4",
            .option = "integrator"};
    }
    if (system.friction().none() || system.friction().as<model::laws::Coulomb>() != nullptr) return std::nullopt;
    return text::Error{
        .sentence = "integrator.dinal1989 supports only Coulomb friction, Rd and Re: use integrator.spectral or rk4",
        .option = "integrator"};
}

Run Dinal1989::run(const Problem& problem) const {
    Run run;
    RowWriter rows(problem.system, problem.rows, run);
    // A step that would begin within rounding of the end is omitted.
    const double covering = std::min((problem.window.end - problem.window.start) / h, 1e18);
    const auto steps = static_cast<std::size_t>(std::ceil(covering - 1e-9));
    const auto replay = std::make_shared<Replay>(problem, *this, steps);
    std::vector<model::Event> events;
    Dinal dinal(problem.system, problem.drive.M(), *this, problem.window.start);
    const std::size_t steps_per_row = rows.steps_per_row(h);
    Loop now = dinal.start(problem.drive.start());
    std::size_t block = 0, block_end = 0, sampled = 0;
    while (finite(now)) {
        if (on_step(rows, problem.window.start, h, now.step, steps_per_row))
            rows.put(dinal.state(now), dinal.M(now), dinal.friction(now));
        if (now.step == steps) break;
        if (now.step == block_end) {
            replay->checkpoints.add(now);
            if (problem.monitor && !problem.monitor(dinal.time(now))) {
                run.outcome = model::Outcome::interrupted;
                break;
            }
            block = now.step;
            block_end = std::min(block + Dinal::block_steps, steps);
            sampled = dinal.sample(now, block_end - block);
        }
        const std::size_t i = now.step - block;
        const auto before_row = step_before_row(rows, problem.window.start, h, steps_per_row);
        const std::size_t until = std::min(block + sampled, before_row);
        if (block + i < until && dinal.plain_steps(now, i, until - block) > i) continue;

        const Loop next = i < sampled ? dinal.step(now, i) : dinal.step(now);
        if (finite(next)) {
            const bool row_at_end = on_step(rows, problem.window.start, h, next.step, steps_per_row);
            if (!row_at_end && !rows_between(rows, dinal, now, next)) {
                run.outcome = model::Outcome::excitation_not_finite;
                break;
            }
            record_event(events, dinal, now, next);
        }
        now = next;
    }
    if (!finite(now)) run.outcome = not_finite(now);
    run.t_start = problem.window.start;
    run.t_stop = std::min(dinal.time(now), problem.window.end);
    if (run.outcome == model::Outcome::reached_end) {
        while (rows.next_time() < model::never) rows.put(dinal.state(now), dinal.M(now), dinal.friction(now));
        run.t_stop = problem.window.end;
        if (now.frozen) run.outcome = model::Outcome::stuck_at_end;
    }
    rows.finish();
    if (problem.drive.M().has_script()) run.gap = run.unproven = h / 2;
    run.state_at_stop = dinal.state(now);
    run.motion_at_stop = now.frozen ? model::Motion::stuck : model::motion_of(run.state_at_stop.velocity);
    run.events = Growing<model::Event>(std::move(events));
    if (problem.limits.dense) run.course = replay;
    return run;
}

}  // namespace dinal::motion::dinal1989
