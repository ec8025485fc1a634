// The exact engine for a record of samples: advances line by line while no event is possible.
#include <algorithm>
#include <cmath>

#include "motion/exact/exact_engine.hpp"

namespace dinal::motion::exact {

namespace {

/// The record if it is all of M, otherwise nullptr.
const model::Component* record_of(const model::Excitation& excitation) {
    const model::Component* record = nullptr;
    for (const model::Component& component : excitation.components()) {
        if (component.gain == 0) continue;
        if (record != nullptr || !std::holds_alternative<model::Polyline>(component.term)) return nullptr;
        record = &component;
    }
    return record;
}

}  // namespace

void LineStep::make(double length) {
    // The Taylor series of the motion: the equation yields its coefficients one by one.
    constexpr std::size_t order = 16;
    length_ = length;
    for (std::size_t unit = 0; unit < way_.size(); ++unit) {
        std::array<double, order + 1> c{};
        if (unit == 0) c[1] = 1;
        for (std::size_t i = 0; i + 2 <= order; ++i) {
            const auto n = static_cast<double>(i);
            const double load = unit == i + 1 ? 1 : 0;
            c[i + 2] = (load - damping_ * (n + 1) * c[i + 1] - stiffness_ * c[i]) / (inertia_ * (n + 1) * (n + 2));
        }
        double way = 0, velocity = 0;
        for (std::size_t i = order + 1; i-- > 0;) {
            velocity = velocity * length + way;
            way = way * length + c[i];
        }
        way_[unit] = way, velocity_[unit] = velocity;
    }
}

void ExactEngine::find_record() {
    const model::Component* component = record_of(excitation_);
    if (component == nullptr) return;
    const model::Samples& samples = *std::get<model::Polyline>(component->term).samples;
    if (samples.interpolation != model::Interpolation::linear) return;
    record_ = {&samples, component->gain, component->from, component->to};
}

/// Advances from sample to sample as far as possible. Returns false if it did not advance.
bool ExactEngine::along_lines() {
    using Phase = LoneContact::Phase;
    if (record_.samples == nullptr || clock_.lo != 0) return false;
    const bool standing = contact_.phase() == Phase::stuck;
    if (!standing && contact_.phase() != Phase::moving) return false;
    const std::vector<double>& times = record_.samples->t;
    std::size_t& i = record_.place;
    if (i >= times.size() || times[i] != clock_.hi) {
        i = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), clock_.hi) - times.begin());
        if (i == times.size() || times[i] != clock_.hi) return false;
    }
    if (clock_.hi < record_.from) return false;
    const double began = clock_.hi, until = std::min(window_.end, record_.to);
    standing ? rest_along(until) : move_along(until);
    if (clock_.hi == began) return false;
    if (standing && arcs_ != nullptr) arcs_->add({.start = {began, 0}, .length = clock_.hi - began, .begin = y_});
    update_M();
    return true;
}

/// Advances a mass at rest: a line within the limits at both ends is within them throughout.
void ExactEngine::rest_along(double until) {
    const double k_theta = system_.stiffness() * y_.theta;
    const double rounding = 64 * epsilon * (system_.greatest_holding() + std::fabs(k_theta));
    const double low = k_theta - system_.holding(model::Motion::backward) + rounding;
    const double high = k_theta + system_.holding(model::Motion::forward) - rounding;
    if (!(M_ > low && M_ < high)) return;
    for (; record_.goes_on(until) && !cost_.is_due(); ++record_.place) {
        const double M = record_.torque(1);
        if (!(M > low && M < high) || !end_line(record_.length(), M, y_, true)) return;
        cost_.spent += Cost::of_a_line;
    }
}

/// Advances a mass in motion: its velocity deviates from its chord by at most h^2/8 times the bound of its second
/// derivative.
void ExactEngine::move_along(double until) {
    // The rounding error of the angle is added every few lines; until then it is below the rounding of the torque.
    constexpr std::size_t lines_between_roundings = 16;
    const model::Motion motion = contact_.motion();
    const double sign = model::sign_of(motion), braking = system_.braking(motion), k = system_.stiffness();
    const bool kept = arcs_ != nullptr;
    const double *t = record_.samples->t.data(), *samples = record_.samples->M.data();
    const std::size_t count = record_.samples->t.size(), began = record_.place;
    const double affordable = std::ceil(std::max((Cost::between_calls - cost_.spent) / Cost::of_a_line, 0.0));
    const std::size_t last = std::min(count - 1, began + static_cast<std::size_t>(affordable));
    double theta = y_.theta, rest = theta_rest_, velocity = y_.velocity, M = M_, next_row = rows_.next_time();
    const auto round = [&] {
        const Clock whole = Clock{theta, 0}.later(rest);
        theta = whole.hi, rest = whole.lo;
    };
    std::size_t i = began;
    const auto stand = [&] {
        round();
        y_ = {theta, velocity};
        theta_rest_ = rest;
        M_ = M;
        clock_ = {t[i], 0};
        record_.place = i;
    };
    for (; i < last && t[i + 1] <= until; ++i) {
        const double h = t[i + 1] - t[i], next_M = record_.gain * samples[i + 1];
        if (!line_.takes(h)) break;
        const auto y = line_.over(h, {velocity, (M - braking) - k * theta, (next_M - M) / h});
        const double least = std::min(sign * velocity, sign * y.velocity);
        if (!(least > h * h / 4 * y.bend && std::isfinite(y.velocity))) break;
        if (kept || next_row < t[i + 1]) {
            stand();
            const double end = Clock{theta, rest}.later(y.way).hi;
            if (!write_line_of_record(h, next_M, {end, y.velocity}, pull_of(k, theta, M, braking))) return;
            next_row = rows_.next_time();
        }
        // The angle is the sum of all displacements; `rest` collects their rounding errors.
        const double sum = theta + y.way, part = sum - theta;
        rest += (theta - (sum - part)) + (y.way - part);
        theta = sum, velocity = y.velocity, M = next_M;
        if (i % lines_between_roundings == 0) round();
    }
    cost_.spent += static_cast<double>(i - began) * Cost::of_a_line;
    stand();
}

/// Writes the rows on a line in motion, and stores its arc.
bool ExactEngine::write_line_of_record(double h, double M, model::State end, double start_pull) {
    requested_ = h;
    if (rows_.next_time() < record_.time(1)) {
        model::closed_form(excitation_, clock_.hi, 0, formula_);
        arc_.begin(formula_, {y_.velocity, start_pull}, h);
    }
    return end_line(h, M, end, false, start_pull);
}

/// Writes the rows and stores the arc of any line. Returns false if the run ends.
bool ExactEngine::end_line(double h, double M, model::State state, bool standing, double start_pull) {
    double tau = h;
    if (rows_.next_time() < record_.time(1) && !rows_until(tau, state, standing)) {
        return fail(model::Outcome::excitation_not_finite);
    }
    if (arcs_ != nullptr && !standing) keep(tau, start_pull, false);
    y_ = state;
    M_ = M;
    clock_ = tau < h ? clock_.later(tau) : Clock{record_.time(1), 0};
    return outcome_ != model::Outcome::interrupted;
}

}  // namespace dinal::motion::exact
