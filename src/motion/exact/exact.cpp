#include "motion/exact/exact.hpp"

#include <memory>

#include "model/closed_form.hpp"
#include "motion/exact/exact_engine.hpp"

namespace dinal::motion::exact {

std::optional<text::Error> Exact::wrong_for(const model::Oscillator& system,
                                            const model::Excitation& excitation) const {
    if (system.walls()) {
        return text::Error{.sentence = "integrator.exact{} knows no walls: use integrator.spectral{} for these",
                           .option = "integrator"};
    }
    if (!system.spring().none()) {
        return text::Error{.sentence =
                               "integrator.exact{} knows no spring but k theta: use integrator.spectral{} for this "
                               "one",
                           .option = "integrator"};
    }
    if (system.friction().depends_on_speed()) {
        return text::Error{.sentence =
                               "integrator.exact{} takes dry friction that does not depend on speed: use "
                               "integrator.spectral{} for this law",
                           .option = "integrator"};
    }
    if (!system.has_spring()) {
        return text::Error{.sentence =
                               "integrator.exact{} takes a system with a spring: use integrator.spectral{} for "
                               "k = 0",
                           .option = "integrator"};
    }
    if (!model::has_closed_form(excitation)) {
        return text::Error{.sentence =
                               "integrator.exact{} takes an M of native terms other than chirp and gaussian: "
                               "use integrator.spectral{}, which takes every M",
                           .option = "integrator"};
    }
    return std::nullopt;
}

Resolution Exact::resolution(const model::Oscillator& system) const {
    constexpr double looks = 8;
    return {"T0/8", system.natural_period() / looks, false};
}

Trajectory Exact::run(const Problem& problem) const {
    Trajectory trajectory;
    RowWriter rows(problem.system, problem.rows, trajectory);
    std::shared_ptr<Arcs> arcs;
    if (problem.limits.dense) {
        arcs = std::make_shared<Arcs>(problem.system, problem.excitation, problem.course_bytes);
    }
    std::vector<model::Event> events;
    constexpr std::size_t few = 8;
    events.reserve(few);
    ExactEngine engine(problem, rows, events, arcs.get());
    run_whole(engine, problem, rows, events, std::move(arcs), trajectory);
    return trajectory;
}

}  // namespace dinal::motion::exact
