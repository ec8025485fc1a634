#include "motion/spectral/panels.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/lowered.hpp"

namespace dinal::motion::spectral {

namespace {

/// Integrals of products of series are exact.
class PanelLeg final : public Leg {
public:
    PanelLeg(const model::Lowered& system, const Panel& panel) : panel_(panel) {
        if (standing()) return;
        const auto v = panel.velocity();
        input_ = chebyshev::integral(chebyshev::product(panel.M, v), 0);
        way_ = chebyshev::integral(v, 0);
        dry_ = system.braking(panel.motion);
        if (panel.line >= 0) {
            add_line(system.law_with_corners()->range(static_cast<std::size_t>(panel.line)), v);
        } else if (system.has_friction_remainder()) {
            add_remainder(system, v);
        }
        if (system.damping() == 0) return;
        squared_ = chebyshev::integral(chebyshev::product(v, v), 0);
        viscous_ = system.damping() / panel.h;
    }
    [[nodiscard]] double length() const override { return panel_.length; }
    [[nodiscard]] double since_start(double t) const override { return panel_.start.until(t); }
    [[nodiscard]] Work work(double since_start) const override {
        if (standing() || !(since_start > 0)) return {};
        const double x = std::min(std::min(since_start, panel_.length) / panel_.h - 1, 1.0);
        return {chebyshev::value(input_, x), viscous_ == 0 ? 0 : viscous_ * chebyshev::value(squared_, x),
                (dry_ == 0 ? 0 : dry_ * chebyshev::value(way_, x)) + (changes_ ? chebyshev::value(changing_, x) : 0)};
    }

private:
    static constexpr std::size_t points = chebyshev::points;
    [[nodiscard]] bool standing() const { return panel_.motion == model::Motion::stuck; }

    /// All of a friction that is a line.
    void add_line(const model::SpeedRange& line, const chebyshev::Series<points + 1>& v) {
        const double sign = model::sign_of(panel_.motion);
        dry_ = sign * line.torque;
        auto above = v;
        above[0] -= sign * line.from * panel_.h;
        for (double& c : above) c *= line.slope / panel_.h;
        changing_ = chebyshev::integral(chebyshev::product(above, v), 0);
        changes_ = true;
    }
    /// The part of the friction that changes with speed.
    void add_remainder(const model::Lowered& system, const chebyshev::Series<points + 1>& v) {
        const auto v_at = chebyshev::at_nodes(v), theta_at = chebyshev::at_nodes(way_);
        chebyshev::Samples friction{};
        for (std::size_t j = 0; j < points; ++j) {
            friction[j] =
                system.friction_remainder(panel_.motion, {panel_.begin.theta + theta_at[j], v_at[j] / panel_.h});
        }
        const auto work = chebyshev::integral(chebyshev::product(chebyshev::fit(friction), v), 0);
        std::copy(work.begin(), work.end(), changing_.begin());
        changes_ = true;
    }

    const Panel& panel_;
    double dry_ = 0, viscous_ = 0;
    bool changes_ = false;
    chebyshev::Series<2 * points + 1> input_{};     // of M v
    chebyshev::Series<2 * points + 2> changing_{};  // of the changing part of friction and v
    chebyshev::Series<2 * points + 2> squared_{};   // of v^2
    chebyshev::Series<points + 2> way_{};
};

}  // namespace

model::State Panel::at(double x) const {
    if (motion == model::Motion::stuck && begin.velocity == 0) return begin;
    if (x <= -1) return begin;
    const auto v = velocity();
    return {begin.theta + chebyshev::value(chebyshev::integral(v, 0), x), chebyshev::value(v, x) / h};
}

void Panels::add(const Panel& panel) {
    if (size_ == most_) complete_ = false;
    if (!complete_) return;
    if (begin_of(size_) == size_) chunks_.emplace_back().reserve(std::clamp(size_, first_chunk, last_chunk));
    chunks_.back().push_back(panel);
    ++size_;
}

double Panels::end() const {
    const Panel& last = panel(size_ - 1);
    return last.start.after(last.length);
}

double Panels::whole_until() const {
    if (complete_) return model::never;
    return size_ == 0 ? -model::never : end();
}

text::Expected<model::State> Panels::at(double t) const {
    if (size_ == 0) return text::Error{"the run has no motion to evaluate: it ended where it started"};
    if (t > end() && !complete_) {
        return text::Error{fmt::format(
            "the motion was kept only up to t = {:.6g}, for lack of memory: ask for rows, or start a run there",
            end())};
    }
    // The last panel that begins at or before t.
    std::size_t low = 0, high = size_;
    while (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        (panel(middle).start.until(t) >= 0 ? low : high) = middle;
    }
    return panel(low).at(std::min(panel(low).x(t), 1.0));
}

void Panels::legs(const std::function<void(const Leg&)>& told) const {
    const model::Lowered lowered(system());
    for (std::size_t i = 0; i < size_; ++i) told(PanelLeg(lowered, panel(i)));
}

}  // namespace dinal::motion::spectral
