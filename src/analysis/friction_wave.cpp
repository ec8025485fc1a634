#include "analysis/friction_wave.hpp"

#include <cmath>
#include <numbers>

#include "analysis/stretches.hpp"
#include "model/lowered.hpp"

namespace dinal::analysis {

bool is_linear_but_for_friction(const SteadyQuestion& question) {
    const model::Lowered system(question.body);
    return question.body.has_linear_spring() && system.stiffness() > 0 && !system.has_remainder() &&
           !question.body.walls() && !question.load().has_feedback();
}

std::optional<Fundamental> by_friction(const SteadyQuestion& question, const SteadyMotion& motion,
                                       const motion::Run& run, std::complex<double> M_wave) {
    const model::Lowered system(question.body);
    const Repetition& repeats = question.repeats;
    const double omega = 2 * std::numbers::pi / repeats.period, length = run.t_stop - run.t_start;
    const auto wave = [&](double t) { return std::polar(1.0, -omega * (t - repeats.start)); };
    double sum = 0;
    std::complex<double> sum_wave;
    for (const Stretch& s : stretches(run)) {
        if (!(s.lasts() > 0)) continue;
        const std::complex<double> between =
            (wave(s.to) - wave(s.from)) * std::complex<double>(0, 1 / omega);  // integral of e^(-i omega t)
        if (s.stuck) {
            const double held = -system.stiffness() * s.begin.theta;
            const double piece = std::min(repeats.period / 64, s.lasts() / 12);
            sum += held * s.lasts();
            sum_wave += held * between;
            sum += integral(question.load(), s.from, s.to, piece, [&](double t) { return question.load().value(t); });
            sum_wave += integral(question.load(), s.from, s.to, piece,
                                 [&](double t) { return question.load().value(t) * wave(t); });
        } else {
            const double braking =
                system.braking(s.end.theta > s.begin.theta ? model::Motion::forward : model::Motion::backward);
            sum += braking * s.lasts();
            sum_wave += braking * between;
        }
    }
    const std::complex<double> left = M_wave - sum_wave * (2 / length);
    constexpr double least_left = 0.02;  // fraction of M: an error of 1e-14 of M stays below 1e-12 of theta
    if (!(std::abs(left) > least_left * std::abs(M_wave))) return {};
    Fundamental found;
    found.wave =
        left / std::complex<double>(system.stiffness() - system.inertia() * omega * omega, system.damping() * omega);
    if (!motion.symmetric) {
        const double mean_M = integral(question.load(), run.t_start, run.t_stop, repeats.period / 64,
                                       [&](double t) { return question.load().value(t); }) /
                              length;
        found.mean = (mean_M - sum / length) / system.stiffness();
    }
    return found;
}

}  // namespace dinal::analysis
