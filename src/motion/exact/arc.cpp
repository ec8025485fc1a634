#include "motion/exact/arc.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "model/closed_form.hpp"

namespace dinal::motion::exact {

namespace {

/// Arcs below this many radians of the fastest part use the Taylor series.
constexpr double short_of = 0.3;
/// The largest factor by which cancellation in the closed form may enlarge rounding.
constexpr double most_cancelled = 256;
/// The distance from resonance, as a part of k, below which a sine uses the resonant form.
constexpr double near_resonance = 1.0 / 64;
/// The longest arc in natural periods, or in periods of the fastest part if that is slower.
constexpr double most_turns = 16;

}  // namespace

double Arc::fastest_rate(const model::ClosedForm& M) const {
    return std::max(free_.fastest(), M.fastest());
}

double Arc::longest(const model::ClosedForm& M) const {
    return most_turns * 2 * std::numbers::pi / std::min(free_.w0(), lasting_rate(M));
}

double Arc::begin(const model::ClosedForm& M, const Start& start, double length) {
    const double rate = fastest_rate(M);
    if (rate * length > short_of) {
        if (begin_closed(M, start, length)) {
            velocity_.begin();
            return length;
        }
        length = short_of / rate;
    }
    begin_series(M, start, length, rate);
    velocity_.begin();
    return length;
}

/// Begins with particular solutions and the remaining free motion. Returns false if these would cancel.
bool Arc::begin_closed(const model::ClosedForm& M, const Start& start, double length) {
    const double I = system_.inertia(), C = system_.damping(), k = system_.stiffness();
    velocity_.clear();
    double theta = 0, velocity = start.velocity;  // initial values of the free motion

    double still = start.pull;
    for (const auto& sine : M.sines()) still -= sine.quadrature;
    for (const auto& exponential : M.exponentials()) still -= exponential.amount;
    if (M.powers().size() == 1) {
        still /= k;
        velocity_.add_way_power(still);
        theta -= still;
    } else if (!begin_powers(M, still, length, theta, velocity)) {
        return false;
    }

    for (const auto& [r, amount] : M.exponentials()) {
        const double held = I * r * r + C * r + k;
        if (std::fabs(held) * most_cancelled < I * r * r + C * std::fabs(r) + k) return false;
        const double way = amount / held;
        velocity_.add_exponential(r, r * way);
        theta -= way;
        velocity -= r * way;
    }

    std::size_t j = 0;
    for (const auto& [omega, in_phase, quadrature] : M.sines()) {
        if (j >= answers_.size() || answers_[j].omega != omega) answer(j, omega);
        const Answer& to = answers_[j++];
        const Complex F{in_phase, quadrature};
        if (to.resonant) {
            // F (g(mu, lambda) - g(mu, conj lambda)) / (2 i w1 I), where only the first is near resonance.
            const Complex root = free_.root(), growing = product(F, to.gain), turning = product(growing, to.other_gain);
            const Complex up = product(growing, root);
            const Complex held{growing.real() - omega * turning.imag(), growing.imag() + omega * turning.real()};
            const double size = length_of(up), square = omega * omega;
            velocity_.add_resonance(
                {.mu = {0, omega},
                 .from_root = to.from_root,
                 .growing = up,
                 .turning = held,
                 .way_growing = growing,
                 .way_turning = turning,
                 .slope_growing = product(up, root),
                 .slope_turning = {up.real() - omega * held.imag(), up.imag() + omega * held.real()},
                 .fourth_growing = size * to.fourth_growing,
                 .fourth_turning = size * to.fourth_turning + length_of(held) * (square * square)});
            theta -= turning.imag();
            velocity -= turning.imag() * root.real() - turning.real() * root.imag();  // Im(turning conj lambda)
            continue;
        }
        const Complex way = product(F, to.gain);
        velocity_.add_sine(omega, {-omega * way.imag(), omega * way.real()});
        theta -= way.imag();
        velocity -= omega * way.real();
    }
    velocity_.add_free(theta, velocity);
    return true;
}

/// Adds the particular solution of the powers; the constant one is `still`.
bool Arc::begin_powers(const model::ClosedForm& M, double still, double length, double& theta, double& velocity) {
    const double I = system_.inertia(), C = system_.damping(), k = system_.stiffness();
    // Powers: from the highest down, k b_n = c_n - C (n + 1) b_(n+1) - I (n + 2) (n + 1) b_(n+2).
    way_.assign(M.powers().begin(), M.powers().end());
    way_[0] = still;
    const double span = std::min(length, 2 * std::numbers::pi / free_.lasting());
    double load = 0;
    for (std::size_t i = way_.size(); i-- > 0;) load = load * span + std::fabs(way_[i]);
    for (std::size_t i = way_.size(); i-- > 0;) {
        const auto n = static_cast<double>(i);
        if (i + 1 < way_.size()) way_[i] -= C * (n + 1) * way_[i + 1];
        if (i + 2 < way_.size()) way_[i] -= I * (n + 2) * (n + 1) * way_[i + 2];
        way_[i] /= k;
    }
    if (k * (std::fabs(way_[0]) + std::fabs(way_[1]) / free_.lasting()) > most_cancelled * load) {
        return false;
    }
    for (std::size_t i = 0; i < way_.size(); ++i) {
        velocity_.add_way_power(way_[i]);
        if (i > 0) velocity_.add_power(static_cast<double>(i) * way_[i]);
    }
    theta -= way_[0];
    velocity -= way_[1];
    return true;
}

/// Computes the response to the j-th sine, usually unchanged from the previous arc.
void Arc::answer(std::size_t j, double omega) {
    const double I = system_.inertia(), C = system_.damping(), k = system_.stiffness(), w1 = free_.root().imag();
    const Complex root = free_.root(), i(0, 1), held{std::fma(-I * omega, omega, k), C * omega}, mu(0, omega);
    if (answers_.size() <= j) answers_.resize(j + 1);
    Answer& to = answers_[j];
    to = {.omega = omega};
    to.resonant = free_.swings() && std::abs(held) < near_resonance * k;
    if (!to.resonant) {
        to.gain = 1.0 / held;
        return;
    }
    to.gain = 1.0 / (2.0 * i * w1 * I);
    to.other_gain = -1.0 / (mu - std::conj(root));
    to.from_root = free_.from_root(omega);
    // (g exp)' = root g + exp, so f'''' contains root^4 of g, and the remainder of exp(mu tau).
    to.fourth_growing = std::norm(root * root);
    to.fourth_turning = std::abs((root + mu) * (root * root + mu * mu));
}

/// Uses the Taylor series of the motion, for short arcs or closed forms that would cancel.
void Arc::begin_series(const model::ClosedForm& M, const Start& start, double length, double rate) {
    const double I = system_.inertia(), C = system_.damping(), k = system_.stiffness(), x = rate * length;
    std::size_t order = 2;
    double left = x * x / 2;
    while (left > 1e-18 && order < 40) left *= x / static_cast<double>(++order);
    order = std::max(order, M.powers().size() + 2);

    load_.assign(order, 0.0);
    std::copy(M.powers().begin(), M.powers().end(), load_.begin());
    load_[0] = start.pull;
    for (const auto& [omega, in_phase, quadrature] : M.sines()) {
        double p = in_phase, q = quadrature;
        for (std::size_t n = 1; n < order; ++n) {
            const double by = omega / static_cast<double>(n), next = p * by;
            p = -q * by;
            q = next;
            load_[n] += q;
        }
    }
    for (const auto& [rate_of_part, amount] : M.exponentials()) {
        double a = amount;
        for (std::size_t n = 1; n < order; ++n) load_[n] += a *= rate_of_part / static_cast<double>(n);
    }
    velocity_.clear();
    way_.assign(order + 2, 0.0);
    way_[1] = start.velocity;
    velocity_.add_way_power(0);
    for (std::size_t i = 0; i < order; ++i) {
        const auto n = static_cast<double>(i);
        way_[i + 2] = (load_[i] - C * (n + 1) * way_[i + 1] - k * way_[i]) / (I * (n + 1) * (n + 2));
        velocity_.add_way_power(way_[i + 1]);
        velocity_.add_power((n + 1) * way_[i + 1]);
    }
    velocity_.add_way_power(way_[order + 1]);
    velocity_.add_power(static_cast<double>(order + 1) * way_[order + 1]);
}

namespace {

/// Gauss's positive nodes and weights on (-1, 1): sixteen points integrate polynomials of degree 31.
constexpr std::array<std::array<double, 2>, 8> gauss{{{0.0950125098376374402, 0.1894506104550684963},
                                                      {0.2816035507792589132, 0.1826034150449235889},
                                                      {0.4580167776572273863, 0.1691565193950025382},
                                                      {0.6178762444026437484, 0.1495959888165767321},
                                                      {0.7554044083550030339, 0.1246289712555338720},
                                                      {0.8656312023878317439, 0.0951585116824927848},
                                                      {0.9445750230732325761, 0.0622535239386478929},
                                                      {0.9894009349916499326, 0.0271524594117540949}}};
/// The length of an integration interval in radians of the fastest part.
constexpr double stretch_radians = 3;

/// The work on an arc. Gauss's rule integrates products of closed forms to rounding.
class ArcLeg final : public Leg {
public:
    ArcLeg(const model::Lowered& system, const model::Excitation& excitation, const KeptArc& kept)
        : kept_(kept), damping_(system.damping()), braking_(system.braking(kept.motion)), arc_(system) {
        if (kept.rests) return;
        model::closed_form(excitation, kept.start.hi, kept.start.lo, M_);
        arc_.begin(M_, {kept.begin.velocity, kept.pull}, kept.requested);
        const double fastest = std::max(arc_.free().fastest(), M_.fastest());
        const double count = std::ceil(fastest * kept.length / stretch_radians);
        constexpr double most = 1e6;
        stretch_ = kept.length / std::clamp(count, 1.0, most);
        done_.push_back({});
        double from = 0;
        while (from < kept.length * (1 - 1e-9)) {
            done_.push_back(more(done_.back(), from, from + stretch_));
            from = stretch_ * static_cast<double>(done_.size() - 1);
        }
    }
    double length() const override { return kept_.length; }
    double since_start(double t) const override { return kept_.start.until(t); }
    Work work(double since_start) const override {
        if (kept_.rests || !(since_start > 0)) return {};
        const double until = std::min(since_start, kept_.length);
        const auto whole = std::min(static_cast<std::size_t>(until / stretch_), done_.size() - 1);
        Work work = more(done_[whole], stretch_ * static_cast<double>(whole), until);
        work.dry = braking_ == 0 ? 0 : braking_ * arc_.at(until).way;
        return work;
    }

private:
    Work more(Work work, double from, double until) const {
        const double middle = (from + until) / 2, half = (until - from) / 2;
        double input = 0, squared = 0;
        for (const auto& [place, weight] : gauss) {
            for (const double tau : {middle - half * place, middle + half * place}) {
                const double v = arc_.at(tau).velocity;
                input += weight * (M_.value(tau) * v);
                squared += weight * (v * v);
            }
        }
        work.input += half * input;
        work.viscous += damping_ == 0 ? 0 : damping_ * (half * squared);
        return work;
    }

    const KeptArc& kept_;
    double damping_, braking_;
    model::ClosedForm M_;
    mutable Arc arc_;  // work space
    double stretch_ = 0;
    std::vector<Work> done_;  // work up to the start of each interval
};

}  // namespace

double Arcs::whole_until() const {
    if (complete_) return model::never;
    return arcs_.empty() ? -model::never : end();
}

text::Expected<model::State> Arcs::at(double t) const {
    if (arcs_.empty()) return text::Error{"the run has no motion to evaluate: it ended where it started"};
    if (t > end() && !complete_) {
        return text::error(
            "the motion was kept only up to t = {:.6g}, for lack of memory: ask for rows, or start a run there", end());
    }
    // The last arc that begins at or before t.
    const auto after = std::upper_bound(arcs_.begin() + 1, arcs_.end(), t,
                                        [](double time, const KeptArc& arc) { return arc.start.until(time) < 0; });
    const KeptArc& kept = *(after - 1);
    const double tau = std::min(kept.start.until(t), kept.length);
    if (kept.rests || !(tau > 0)) return kept.begin;
    const model::Lowered lowered(system());
    Arc arc(lowered);
    model::ClosedForm M;
    model::closed_form(excitation_, kept.start.hi, kept.start.lo, M);
    arc.begin(M, {kept.begin.velocity, kept.pull}, kept.requested);
    const Arc::Point y = arc.at(tau);
    return model::State{Clock{kept.begin.theta, kept.theta_rest}.later(y.way).hi, y.velocity};
}

void Arcs::legs(const std::function<void(const Leg&)>& visit) const {
    const model::Lowered lowered(system());
    for (const KeptArc& arc : arcs_) visit(ArcLeg(lowered, excitation_, arc));
}

}  // namespace dinal::motion::exact
