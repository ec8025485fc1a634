#include "motion/engine/history.hpp"

#include <algorithm>
#include <optional>

namespace dinal::motion::engine {

namespace {

/// The energy of a stretch, from exact integrals of products of series.
class StretchLeg final : public JointLeg {
public:
    StretchLeg(const std::vector<model::Joint>& joints, std::size_t bodies, const Kept& kept)
        : joints_(joints), bodies_(bodies), kept_(kept), works_(joints.size()) {}
    double length() const override { return kept_.length; }
    /// A row at the end time of the stretch may be slightly later than the stretch.
    double since_start(double t) const override {
        const double since = kept_.start.until(t);
        return t >= kept_.start.later(kept_.length).hi ? std::max(since, kept_.length) : since;
    }
    Work work(std::size_t joint, double since_start) const override {
        if (!(since_start > 0)) return {};
        if (kept_.remade != nullptr) {
            if (!remade_) remade_ = kept_.remade->works();
            return remade_(std::min(since_start, kept_.length));
        }
        if (!works_[joint]) works_[joint] = integrals(joint);
        const Integrals& own = *works_[joint];
        const double x = std::min(std::min(since_start, kept_.length) / kept_.h - 1, 1.0);
        return {cheb::value(own.input, x), cheb::value(own.viscous, x), cheb::value(own.dry, x),
                cheb::value(own.belt, x),  cheb::value(own.base, x),    0,
                cheb::value(own.stop, x),  cheb::value(own.kept, x)};
    }

private:
    using Integral = cheb::Series<2 * node_count>;
    struct Integrals {
        Integral input{}, viscous{}, dry{}, belt{}, base{}, stop{}, kept{};
    };
    Series whole(std::size_t k) const {
        Series series = kept_.y[k].change;
        series[0] += kept_.y[k].begin;
        return series;
    }
    Integrals integrals(std::size_t joint) const {
        const model::Joint& own = joints_[joint];
        const Kept::JointTorques& at_nodes = kept_.acting[joint];
        const Series friction = cheb::fit(at_nodes.friction);
        const Series belt = at_nodes.belt != nullptr ? cheb::fit(*at_nodes.belt) : Series{};
        Series v{};
        for (const auto& [body, by] : own.of) add(v, whole(bodies_ + body), by);
        Integrals sums;
        const auto work = [&](const Series& torque, const Series& speed) {
            Integral sum = cheb::integral(cheb::product(torque, speed), 0);
            for (double& c : sum) c *= kept_.h;
            return sum;
        };
        if (joint < bodies_ || greatest(at_nodes.M) > 0) {
            sums.input = work(cheb::fit(at_nodes.M), v);
            if (at_nodes.push != nullptr) sums.base = work(cheb::fit(*at_nodes.push), v);
        }
        Series damping = v;
        for (double& c : damping) c *= own.damping;
        sums.viscous = work(damping, v);
        const Series slip = difference(v, belt);
        if (at_nodes.springs != nullptr) sums.kept = work(cheb::fit(*at_nodes.springs), at_nodes.presses ? v : slip);
        if (at_nodes.presses) {
            sums.stop = work(v, v);
            for (double& c : sums.stop) c *= own.stops->damping;
        }
        if (!at_nodes.holds) sums.dry = work(friction, difference(belt, v));
        Series sliders{};  // torques of the sliders, which are not part of friction
        if (at_nodes.springs != nullptr && !at_nodes.presses) sliders = cheb::fit(*at_nodes.springs);
        if (at_nodes.slides != 0) {
            Series torque{};
            torque[0] = at_nodes.slides;
            const Integral more = work(torque, slip);
            for (std::size_t k = 0; k < more.size(); ++k) sums.dry[k] += more[k];
            sliders[0] += at_nodes.slides;
        }
        if (at_nodes.belt != nullptr) sums.belt = work(difference(friction, sliders), belt);
        return sums;
    }

    const std::vector<model::Joint>& joints_;
    std::size_t bodies_;
    const Kept& kept_;
    mutable std::vector<std::optional<Integrals>> works_;
    mutable std::function<Work(double)> remade_;
};

/// An energy change that takes no time.
class JumpLeg final : public JointLeg {
public:
    JumpLeg(double t, std::size_t joint, const Work& done) : t_(t), joint_(joint), work_(done) {}
    double length() const override { return 0; }
    double since_start(double t) const override { return t - t_; }
    Work work(std::size_t joint, double since_start) const override {
        return since_start < 0 || joint != joint_ ? Work{} : work_;
    }

private:
    double t_;
    std::size_t joint_;
    Work work_;
};

}  // namespace

void History::add(Kept kept, bool for_good, double past) {
    const std::size_t bytes = sizeof(Kept) + (kept.remade != nullptr ? kept.remade->bytes() : 0) +
                              kept.y.size() * sizeof(Kept::Value) + kept.acting.size() * sizeof(Kept::JointTorques);
    if (for_good && bytes_ + bytes > most_) whole_until_ = std::min(whole_until_, kept.start.hi);
    for_good = for_good && whole_until_ == std::numeric_limits<double>::infinity();
    if (!for_good && !(kept.start.after(kept.length) >= past)) return;
    list_.push_back(std::move(kept));
    if (for_good) {
        bytes_ += bytes, ++for_good_;
        return;
    }
    const auto first = list_.begin() + static_cast<std::ptrdiff_t>(for_good_);
    const auto later =
        std::partition_point(first, list_.end(), [past](const Kept& k) { return k.start.after(k.length) < past; });
    constexpr std::ptrdiff_t worth_it = 256;
    if (later - first >= worth_it) list_.erase(first, later);
}

void History::close(const Clock& end, const std::vector<double>& y) {
    Kept last{.start = end, .h = 1};
    for (const double value : y) last.y.push_back({value});
    list_.push_back(std::move(last));
}

std::vector<double> History::at(double t, Side side) const {
    // The last stretch that begins at or before t, compared as doubles; for a limit from the left, before t.
    const auto after = std::partition_point(list_.begin(), list_.end(), [t, side](const Kept& kept) {
        return side == Side::before ? kept.start.hi < t : kept.start.hi <= t;
    });
    const bool earlier = t < t_start_ || (t == t_start_ && side == Side::before);
    if (after == list_.begin() || earlier) return before_ != nullptr ? before_->at(t, side) : initial_;
    const Kept& kept = *(after - 1);
    if (kept.remade != nullptr) return kept.remade->at(kept.start.until(t));
    std::vector<double> y(kept.y.size());
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = kept.value(k, kept.x(t));
    return y;
}

std::vector<double> History::ends() const {
    std::vector<double> times;
    for (const Kept& kept : list_) times.push_back(kept.start.later(kept.length).hi);
    return times;
}

void History::legs_since(double start, const std::function<void(const JointLeg&)>& visit) const {
    if (before_ != nullptr && start < t_start_) before_->legs_since(start, visit);
    legs(visit);
}

void History::legs(const std::function<void(const JointLeg&)>& visit) const {
    auto jump = jumps_.begin();
    for (std::size_t i = 0; i <= for_good_; ++i) {
        for (; jump != jumps_.end() && jump->stretch == i; ++jump) visit(JumpLeg(jump->t, jump->joint, jump->work));
        if (i < for_good_) visit(StretchLeg(joints_, bodies_, list_[i]));
    }
}

}  // namespace dinal::motion::engine
