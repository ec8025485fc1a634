// The spectral engine's mass at rest: how long M holds it there, and its breakaway.
#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/spectral/first_below.hpp"
#include "motion/spectral/spectral_engine.hpp"

namespace dinal::motion::spectral {

/// Stuck, up to the first time that |M - k theta| > Re or the end of the panel.
bool SpectralEngine::stay() {
    double from = standing_from_;
    if (from == nowhere) {
        if (now_.M_sampled && standstill_.phase() != Standstill::Phase::held) {
            const model::Motion direction = standstill_.pulled(now_.M, now_.y.theta);
            if (direction != model::Motion::stuck) return release_at(nowhere, direction);
        }
        const auto attempt = solver_.stand(now_);
        if (attempt != PanelSolver::Attempt::resolved) return again(attempt);
        from = -1;
    }
    const auto [x, direction] = first_release(from);
    if (x < 1) return release_at(x, direction);
    end_piece(1, now_.y, 0);
    return std::isfinite(now_.M) || fail(model::Outcome::excitation_not_finite);
}

/// The first release in [from, 1] and its direction; else `nowhere`.
std::pair<double, model::Motion> SpectralEngine::first_release(double from) const {
    std::pair<double, model::Motion> first{nowhere, model::Motion::stuck};
    for (const model::Motion side : {model::Motion::forward, model::Motion::backward}) {
        if (const double x = release_towards(side, from); x < first.first) first = {x, side};
    }
    if (first.first != nowhere && solver_.panel().time(first.first) >= solver_.panel().end)
        first.first = nowhere;  // the next panel's business
    return first;
}

/// Where M passes the limit of this side. Its series tells, but where the two meet so gently that the error of the
/// series matters, M itself is asked: the limit is a razor's edge.
double SpectralEngine::release_towards(model::Motion side, double from) const {
    constexpr double exact_enough = 1e-11;  // natural periods
    const SolvedPanel& panel = solver_.panel();
    const double sign = model::sign_of(side), k_theta = system_.pull_back(now_.y.theta), Re = standstill_.limit(side);
    const double doubt = 8 * (epsilon * (Re + std::fabs(k_theta)) + chebyshev::tail(panel.M));
    const double varying = chebyshev::sum_of<points>([&](std::size_t k) { return k == 0 ? 0 : std::fabs(panel.M[k]); });
    const double mean = sign * (panel.M[0] - k_theta);
    if (mean + varying < Re - doubt) return nowhere;
    const bool sampled = varying > 0 && solver_.M_of_time();
    if (sampled) {
        // Between two nodes it does not come nearer to the limit than a curve so bent can.
        constexpr double width = 2 * chebyshev::widest_gap;
        const double hidden = chebyshev::derivative_bound<2>(panel.M) * (width * width) / 8;
        if (greatest_sample(side, from) + hidden < Re + sign * k_theta - doubt) return nowhere;
    }

    // What is left of the limit: Re - side (M - k theta).
    Series left{};
    chebyshev::Series<points - 1> slope = chebyshev::derivative(panel.M);
    for (std::size_t k = 1; k < points; ++k) left[k] = -sign * panel.M[k];
    for (double& c : slope) c *= -sign;
    const bool held = standstill_.phase() == Standstill::Phase::held;
    const double limit = held ? Re + standstill_.clearly_beyond({now_.clock.hi, now_.y.theta, now_.M}) : Re;
    left[0] = limit - mean;
    chebyshev::Samples at_nodes{};
    if (sampled) {
        for (std::size_t j = 0; j < points; ++j) at_nodes[j] = limit - sign * (panel.samples[j] - k_theta);
    } else {
        at_nodes = chebyshev::at_nodes(left);
    }
    chebyshev::Bounded<points> curve(1, left, slope, at_nodes);
    curve.raise_floor(doubt);
    std::optional<double> touch;
    const auto touches = [&](double x) {
        if (held) return false;
        for (const double place : {x, curve.lowest_near(x)}) {
            if (!lets_go(place, side)) continue;
            touch = place;
            return true;
        }
        return false;
    };
    const auto x = chebyshev::first_below(curve, from, chebyshev::LeftEnd::anywhere, touches);
    if (!x) return nowhere;
    const double off = doubt / std::fabs(curve.slope(*x));
    if (held || (!touch && off * panel.h <= exact_enough * T0_)) return *x;
    return moment_of_release(touch.value_or(*x), off, from, side);
}

/// The greatest M of this side at the nodes from there on, and at the one before.
double SpectralEngine::greatest_sample(model::Motion side, double from) const {
    const chebyshev::Samples& M = solver_.panel().samples;
    const double sign = model::sign_of(side);
    double greatest = sign * M[points - 1];
    for (std::size_t j = points - 1; j > 0 && chebyshev::nodes[j] > from; --j) {
        greatest = std::max(greatest, sign * M[j - 1]);
    }
    return greatest;
}

bool SpectralEngine::lets_go(double x, model::Motion side) const {
    return standstill_.pulled(excitation_.value(solver_.panel().time(x), now_.y), now_.y.theta) == side;
}

/// Between a place near x where M still holds and one where it lets go, by halving.
double SpectralEngine::moment_of_release(double x, double off, double from, model::Motion side) const {
    constexpr double finest = 1e-15;
    double held = x, gone = x;
    double step = std::clamp(off, 1e-12, 1e-3);
    const bool late = lets_go(x, side);
    while (held == gone) {
        if (late) {
            if (gone <= from) return from;
            held = std::max(from, gone - step);
            if (lets_go(held, side)) gone = held;
        } else {
            if (held >= 1) return nowhere;
            gone = std::min(1.0, held + step);
            if (!lets_go(gone, side)) held = gone;
        }
        step *= 2;
    }
    while (gone - held > finest) {
        const double middle = held + (gone - held) / 2;
        if (!(middle > held && middle < gone)) break;
        (lets_go(middle, side) ? gone : held) = middle;
    }
    return gone;
}

/// Breakaway at x of the panel, or, with `nowhere`, at once.
bool SpectralEngine::release_at(double x, model::Motion direction) {
    const bool at_once_only = x == nowhere;
    if (!at_once_only) {
        const bool asked = !solver_.M_of_time() && x > -1;
        const double M =
            asked ? excitation_.value(solver_.panel().time(x), now_.y) : chebyshev::value(solver_.panel().M, x);
        if (!std::isfinite(M)) return fail(model::Outcome::excitation_not_finite);
        end_piece(x, now_.y, M);
        if (!std::isfinite(now_.M)) return fail(model::Outcome::excitation_not_finite);
        standing_from_ = nowhere;
    }
    return go_on(standstill_.release(moment(), direction));
}

}  // namespace dinal::motion::spectral
