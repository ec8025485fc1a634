#include "motion/exact/arcs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "model/closed_form.hpp"
#include "motion/exact/arc.hpp"

namespace dinal::motion::exact {

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
        arc_.begin(M_, {kept.begin.velocity, kept.pull}, kept.asked);
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
    [[nodiscard]] double length() const override { return kept_.length; }
    [[nodiscard]] double since_start(double t) const override { return kept_.start.until(t); }
    [[nodiscard]] Work work(double since_start) const override {
        if (kept_.rests || !(since_start > 0)) return {};
        const double until = std::min(since_start, kept_.length);
        const auto whole = std::min(static_cast<std::size_t>(until / stretch_), done_.size() - 1);
        Work work = more(done_[whole], stretch_ * static_cast<double>(whole), until);
        work.dry = braking_ == 0 ? 0 : braking_ * arc_.at(until).way;
        return work;
    }

private:
    [[nodiscard]] Work more(Work work, double from, double until) const {
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
        return text::Error{fmt::format(
            "the motion was kept only up to t = {:.6g}, for lack of memory: ask for rows, or start a run there",
            end())};
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
    arc.begin(M, {kept.begin.velocity, kept.pull}, kept.asked);
    const Arc::Point y = arc.at(tau);
    return model::State{Clock{kept.begin.theta, kept.theta_rest}.later(y.way).hi, y.velocity};
}

void Arcs::legs(const std::function<void(const Leg&)>& visit) const {
    const model::Lowered lowered(system());
    for (const KeptArc& arc : arcs_) visit(ArcLeg(lowered, excitation_, arc));
}

}  // namespace dinal::motion::exact
