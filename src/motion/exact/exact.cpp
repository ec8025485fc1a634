#include "motion/exact/exact.hpp"

#include <algorithm>
#include <memory>
#include <type_traits>
#include <variant>

#include "model/closed_form.hpp"
#include "motion/exact/exact_engine.hpp"

namespace dinal::motion::exact {

bool Exact::goes_slowly(const model::Oscillator& system, const model::Excitation& excitation) {
    constexpr double most_damped = 200;
    if (!(system.damping_ratio() > most_damped)) return false;
    const auto& components = excitation.components();
    return std::any_of(components.begin(), components.end(), [](const model::Component& c) {
        return std::visit(
            [](const auto& term) {
                using Term = std::decay_t<decltype(term)>;
                return std::is_same_v<Term, model::Polyline> || std::is_same_v<Term, model::Polynomial> ||
                       std::is_same_v<Term, model::Ramp> || std::is_same_v<Term, model::Sawtooth> ||
                       std::is_same_v<Term, model::Triangle>;
            },
            c.term);
    });
}

std::optional<text::Error> Exact::wrong_for(const model::Oscillator& system,
                                            const model::Excitation& excitation) const {
    if (system.walls()) {
        return text::Error{.sentence = "integrator.exact{} does not support walls: use integrator.spectral{}",
                           .option = "integrator"};
    }
    if (!system.spring().none()) {
        return text::Error{.sentence = "integrator.exact{} supports only the spring k theta: use integrator.spectral{}",
                           .option = "integrator"};
    }
    if (system.friction().depends_on_speed()) {
        return text::Error{.sentence =
                               "integrator.exact{} supports only dry friction that does not depend on speed: use "
                               "integrator.spectral{}",
                           .option = "integrator"};
    }
    if (!system.has_spring()) {
        return text::Error{.sentence = "integrator.exact{} needs a spring: use integrator.spectral{} for k = 0",
                           .option = "integrator"};
    }
    if (!model::has_closed_form(excitation)) {
        return text::Error{.sentence =
                               "integrator.exact{} supports only native terms other than chirp and gaussian: use "
                               "integrator.spectral{}, which supports every M",
                           .option = "integrator"};
    }
    return std::nullopt;
}

Resolution Exact::resolution(const model::Oscillator& system) const {
    constexpr double looks = 8;
    return {"T0/8", system.natural_period() / looks, false};
}

Run Exact::run(const Problem& problem) const {
    Run run;
    RowWriter rows(problem.system, problem.rows, run);
    std::shared_ptr<Arcs> arcs;
    if (problem.limits.dense) {
        arcs = std::make_shared<Arcs>(problem.system, problem.drive.M(), problem.course_bytes);
    }
    std::vector<model::Event> events;
    constexpr std::size_t few = 8;
    events.reserve(few);
    ExactEngine engine(problem, rows, events, arcs.get());
    run_whole(engine, problem, rows, events, std::move(arcs), run);
    return run;
}

}  // namespace dinal::motion::exact
