// Runs any system: the general engine runs everything except one plain body.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <utility>

#include "model/drive.hpp"
#include "motion/engine/modes.hpp"
#include "motion/engine/part.hpp"
#include "motion/engine/run.hpp"
#include "motion/simulate.hpp"
#include "motion/stillness.hpp"

namespace dinal::motion {

namespace {

/// Passes theta and velocity of the only body to a function that expects the named bodies' motion as states.
class OnlyBody final : public model::UserFunction {
public:
    explicit OnlyBody(std::shared_ptr<model::UserFunction> function) : function_(std::move(function)) {}

    double value(double t, const model::State& state) override {
        const std::array<double, 2> motion{state.theta, state.velocity};
        return function_->value_with(t, state, motion);
    }
    double next_break(double t) override { return function_->next_break(t); }
    bool may_go_on() override { return function_->may_go_on(); }
    void forget_failure() override { function_->forget_failure(); }

    /// The drive with the functions of M wrapped. Controllers are not wrapped, as no such method supports them.
    [[nodiscard]] static model::Drive drive(model::Drive drive) {
        const auto asked = [](const std::shared_ptr<model::UserFunction>& function) {
            const bool controls = dynamic_cast<const model::Controller*>(function.get()) != nullptr;
            return controls ? function : std::make_shared<OnlyBody>(function);
        };
        if (drive.M().has_feedback()) drive.loads.front() = drive.M().with_functions(asked);
        return drive;
    }

private:
    std::shared_ptr<model::UserFunction> function_;
};

/// An error if the method does not support systems of bodies, or is unsuitable for one of their modes. Contacts that
/// stick are ignored, because they only make modes faster.
std::optional<text::Error> wrong_for_bodies(MethodView method, const model::System& system, const model::Drive& drive,
                                            const Window& window) {
    if (!method.cut()) {
        return text::Error{.sentence = fmt::format("{} is for one body with constant friction: use "
                                                   "integrator.spectral or rk4",
                                                   method.about().call.name),
                           .option = "integrator"};
    }
    const auto resolves = [&](const model::Oscillator& mode) {
        return std::ranges::none_of(drive.loads, [&](const model::Excitation& load) {
            return wrong_method(method, mode, load, window).has_value();
        });
    };
    // Collocation resolves every mode slower than one that it resolves. Fixed steps may still be too long for a
    // damped mode.
    const bool takes_steps = method.cut()->step > 0 || method.cut()->pair != nullptr;
    if (const auto fast = engine::no_slower_than_modes(system); !takes_steps && fast && resolves(*fast)) return {};
    for (const model::Oscillator& mode : engine::modes_of(system)) {
        for (const model::Excitation& load : drive.loads) {
            if (auto wrong = wrong_method(method, mode, load, window)) return wrong;
        }
    }
    return {};
}

text::Expected<Run> run_of(const model::System& system, const model::Drive& drive, const Window& window,
                           const Grid& rows, MethodView method, const Monitor& monitor, const Limits& limits,
                           std::shared_ptr<const engine::Carry> before = {}) {
    if (auto wrong = window.complaint()) return *wrong;
    const auto grid = rows.within(window);
    if (!grid) return grid.error();
    if (auto wrong = wrong_rows(*grid, columns_of(system, drive), limits)) return *wrong;
    if (auto wrong = wrong_for_bodies(method, system, drive, window)) return *wrong;
    const Cut cut = *method.cut();
    return engine::run({.system = system,
                        .drive = drive,
                        .window = window,
                        .rows = *grid,
                        .monitor = monitor,
                        .limits = limits,
                        .before = std::move(before),
                        .tolerance = cut.tolerance,
                        .longest = cut.longest,
                        .step = cut.step,
                        .pair = cut.pair,
                        .keeps_torques = true});
}

/// The oscillator of a joint by itself, for a run that has kept its motion; otherwise empty.
std::optional<model::Oscillator> oscillator_if_dense(const model::System& system, const Run& run, std::size_t joint) {
    if (!run.left->is_dense(run)) return {};
    auto made = model::oscillator_at(system, joint);
    return made ? std::optional(std::move(made).value()) : std::nullopt;
}

/// Returns whether the run is computed for an oscillator: a plain system, or a method with its own engine for one body.
bool runs_alone(const model::System& system, const model::Drive& drive, MethodView method) {
    const auto cut = method.cut();
    const bool more = drive.has_more() || system.joints.front().walls || model::has_memory(drive.M());
    return system.is_plain() || (system.is_alone() && (!cut || (cut->step > 0 && !more)));
}

/// Runs the only body of a system as an unnamed oscillator.
template <class Make>
text::Expected<Run> run_alone(const model::System& system, const model::Drive& drive, const Make& make) {
    const auto alone = model::oscillator_at(system, 0);
    if (!alone) return alone.error();
    if (!system.named) return make(*alone, drive);
    auto run = make(*alone, OnlyBody::drive(drive));
    if (run) run.value().own_names = engine::column_names_of(system, drive);
    return run;
}

}  // namespace

std::size_t columns_of(const model::System& system, const model::Drive& drive) {
    return system.is_plain() ? static_cast<std::size_t>(column_count)
                             : engine::column_names_of(system, drive).size() + system.bodies.size();
}

bool Run::is_dense() const {
    return course != nullptr || (left != nullptr && left->is_dense(*this));
}

Run completed(const model::System& system, const model::Drive& drive, Run run) {
    std::optional<model::Oscillator> seen;
    if (!system.named) seen = oscillator_if_dense(system, run, 0);
    engine::complete(run, system, drive, seen);
    if (system.is_alone()) {
        if (const auto alone = model::oscillator_at(system, 0)) settle(run, *alone, drive);
    }
    if (run.rough) run.rough->other_integrators = false;
    return run;
}

Run part_of(const model::System& system, const model::Drive& drive, const Run& run, std::size_t joint) {
    if (!system.named) return run;
    if (run.left != nullptr) {
        return engine::part_of(system, drive, run, joint, oscillator_if_dense(system, run, joint));
    }
    Run part = run;
    part.own_names.clear();
    return part;
}

text::Expected<Run> simulate(const model::System& system, const model::Drive& drive, const Window& window,
                             const Grid& rows, MethodView method, const Monitor& monitor, const Limits& limits) {
    if (runs_alone(system, drive, method)) {
        return run_alone(system, drive, [&](const model::Oscillator& body, const model::Drive& its) {
            return simulate(body, its, window, rows, method, monitor, limits);
        });
    }
    auto run = run_of(system, drive, window, rows, method, monitor, limits);
    if (!run) return run.error();
    return completed(system, drive, std::move(run).value());
}

text::Expected<Run> resume(const model::System& system, const model::Drive& drive, const Run& so_far, double t_end,
                           const Grid& rows, MethodView method, const Monitor& monitor, const Limits& limits) {
    if (runs_alone(system, drive, method)) {
        return run_alone(system, drive, [&](const model::Oscillator& body, const model::Drive& its) {
            return resume(body, its, so_far, t_end, rows, method, monitor, limits);
        });
    }
    const std::size_t columns = columns_of(system, drive);
    const auto grid = grid_of_both(so_far, t_end, rows, columns, limits);
    if (!grid) return grid.error();
    auto [kept, times] = rows_to_come(so_far, *grid);
    auto second = run_of(system, drive, {so_far.t_stop, t_end}, Grid::at(std::move(times)), method, monitor, limits,
                         so_far.left->carry);
    if (!second) return second.error();
    Run whole = std::move(second).value();
    const std::size_t most = limits.memory / (columns * sizeof(double));
    whole.rows = Rows(so_far.rows.table().followed_by(kept, whole.rows.table(), most));
    whole.events =
        so_far.events.followed_by(so_far.events.size(), whole.events, std::numeric_limits<std::size_t>::max());
    auto left = std::make_shared<engine::Left>(*whole.left);
    left->start = so_far.left->start, left->begun = so_far.left->begun;
    whole.left = std::move(left);
    whole.t_start = so_far.t_start;
    whole.gap = std::max(so_far.gap, whole.gap);
    whole.unproven = std::max(so_far.unproven, whole.unproven);
    whole.noise = std::max(so_far.noise, whole.noise);
    whole.jumps += so_far.jumps;
    return completed(system, drive, std::move(whole));
}

}  // namespace dinal::motion
