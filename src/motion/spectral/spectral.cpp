#include "motion/spectral/spectral.hpp"

#include <algorithm>

#include "model/laws/user_law.hpp"
#include "motion/engine/one_body.hpp"
#include "motion/spectral/spectral_engine.hpp"

namespace dinal::motion::spectral {

namespace {

bool has_users_law(const model::Oscillator& system) {
    return system.friction().as<model::laws::UserLaw>() != nullptr;
}

/// Conditions of the motion that are known are located there.
bool compares_the_motion(const model::Excitation& excitation) {
    const auto& components = excitation.components();
    return std::any_of(components.begin(), components.end(), [](const model::Component& component) {
        const auto* script = std::get_if<model::Scripted>(&component.term);
        return script != nullptr && script->feedback && script->function->has_pieces();
    });
}

}  // namespace

Resolution Spectral::resolution(const model::Oscillator& system) const {
    constexpr double parts = chebyshev::degree;
    const double own = longest_panel * system.natural_period();
    const double asked = narrowest / chebyshev::widest_gap;
    if (asked < std::min(max_panel, own)) return {"narrowest", asked / parts, false};
    return max_panel < own ? Resolution{"max_panel/16", max_panel / parts, false}
                           : Resolution{"T0/27", own / parts, false};
}

double Spectral::longest(const Problem& problem) const {
    const model::Oscillator& system = problem.system;
    // The looks at both ends of the widest gap must not straddle a pulse.
    constexpr double within = chebyshev::widest_gap * (1 + 1e-9);
    const double most = problem.excitation.has_script() ? std::min(max_panel, narrowest / within) : max_panel;
    return std::min(most, system.has_spring() ? longest_panel * system.natural_period()
                                              : part_of_run * (problem.window.end - problem.window.start));
}

Trajectory Spectral::run(const Problem& problem) const {
    if (has_users_law(problem.system)) return run_more(problem);
    if (problem.extras != nullptr && compares_the_motion(problem.excitation)) {
        Trajectory located =
            engine::run(problem, {.tolerance = tolerance, .longest = longest(problem), .only_located = true});
        if (located.located) return located;
    }
    Trajectory trajectory;
    RowWriter rows(problem.system, problem.rows, trajectory);
    std::shared_ptr<Panels> panels;
    if (problem.limits.dense) panels = std::make_shared<Panels>(problem.system, problem.course_bytes);
    std::vector<model::Event> events;
    SpectralEngine engine(problem, *this, rows, events, panels.get());
    run_whole(engine, problem, rows, events, std::move(panels), trajectory);
    return trajectory;
}

Trajectory Spectral::run_more(const Problem& problem) const {
    return engine::run(problem, {.tolerance = tolerance, .longest = longest(problem)});
}

}  // namespace dinal::motion::spectral
