#include "motion/engine/moving.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "motion/belt_slope.hpp"
#include "motion/engine/nodes.hpp"
#include "motion/engine/unseen.hpp"

namespace dinal::motion::engine {

/// The derivative of a prescribed angle, by series on pieces that a polynomial resolves to rounding. The pieces are
/// halvings of equal parts between breaks, so they depend on the angle only and not on the order of evaluation:
/// leftover tiny pieces would differentiate rounding errors. No stretch of a run passes the end of a piece.
class VelocityOfAngle final : public model::UserFunction {
public:
    VelocityOfAngle(model::Excitation angle, double start, double longest)
        : angle_(std::move(angle)), longest_(longest), breaks_{start} {}

    double value(double t, const model::State& /*state*/) override {
        const auto& [from, own] = piece_at(t);
        return cheb::value(own.slope, (t - from) / own.h - 1);
    }
    double next_break(double t) override { return angle_.next_break(t); }
    double known_until(double t) override {
        constexpr double beside = 1e-9;  // fraction of a piece: a time this close to its end belongs to the next one
        const auto& [from, own] = piece_at(t);
        return own.to - t > beside * own.h ? own.to : piece_at(own.to).second.to;
    }
    /// The longest distance of two samples between which a function is not proven to follow the series.
    double gap() const { return gap_; }

private:
    struct Piece {
        double to = 0, h = 0;
        cheb::Series<node_count - 1> slope{};
    };

    /// Returns the piece that contains t, with the time at which it begins.
    const std::pair<const double, Piece>& piece_at(double t) {
        const auto next = pieces_.upper_bound(t);
        if (next != pieces_.begin() && t < std::prev(next)->second.to) return *std::prev(next);
        const auto [from, made] = make(t);
        return *pieces_.insert_or_assign(from, made).first;
    }

    /// The part around t without breaks, no longer than the longest piece, and the next break.
    std::array<double, 3> part_around(double t) {
        while (breaks_.back() <= t) breaks_.push_back(angle_.next_break(breaks_.back()));
        const auto next = std::upper_bound(breaks_.begin(), breaks_.end(), t);
        const double begin = next == breaks_.begin() ? *next : *std::prev(next);
        const bool ends = next != breaks_.begin() && *next < model::never;
        const double length = ends ? (*next - begin) / std::ceil((*next - begin) / longest_) : longest_;
        double part = std::floor((t - begin) / length);
        if (begin + (part + 1) * length <= t) ++part;  // correction for a rounded quotient
        const double from = begin + part * length, to = begin + (part + 1) * length;
        return {from, ends && !(to < *next) ? *next : to, *next};
    }

    std::pair<double, Piece> make(double t) {
        constexpr double enough = 8;  // multiple of the rounding of angles and of the times of evaluation
        constexpr int most_looks = 40, patience = 12;
        const std::array<double, 3> part = part_around(t);
        double from = part[0], to = part[1];
        const double next = part[2];
        const auto halve = [&, t] {
            const double middle = from + (to - from) / 2;
            (t < middle ? to : from) = middle;
        };
        while ((to - from) * cheb::widest_gap > angle_.finest_detail(from, to).apart) halve();
        std::pair<double, Piece> best;
        double least = model::never;
        Agreement agreement = Agreement::unknown;
        for (int look = 0, in_vain = 0; look < most_looks && in_vain < patience; ++look) {
            const double h = (to - from) / 2;
            if (look > 0 && (!(from + h > from) || !(from + h < to))) break;
            Nodes angles{};
            for (std::size_t j = 0; j < node_count; ++j) {
                const double at = from + h * (1 + cheb::nodes[j]);
                angles[j] = j == 0       ? belt_from(angle_, from)
                            : at >= next ? angle_.value_before(next)
                                         : angle_.value(at);
            }
            const Series series = cheb::fit(angles);
            const double tail = cheb::tail(series), size = cheb::size(series);
            const double late = std::max(std::fabs(from), std::fabs(to));
            const double allowed = enough * (rounding * size + lost_in_time(series, late, h, size)) + smallest;
            const bool smooth = tail <= allowed || tail <= allowed + enough * rounded_at(from + h);
            if (agreement == Agreement::strays)
                least = model::never;  // a series that missed a detail is not a reference
            ++in_vain;
            const double off = smooth ? 0 : tail / size;
            if (!std::isfinite(size) || smooth || off < least / 2) {
                least = off, in_vain = 0;
                cheb::Series<node_count - 1> slope = cheb::derivative(series);
                for (double& c : slope) c /= h;
                best = {from, {to, h, slope}};
            }
            agreement = smooth ? agreement_with(series, from, h) : Agreement::unknown;
            if (!std::isfinite(size) || (smooth && agreement != Agreement::strays)) break;
            halve();
        }
        if (agreement != Agreement::proven) gap_ = std::max(gap_, 2 * best.second.h * cheb::widest_gap);
        return best;
    }

    /// Returns the rounding of the angle's formulas at t. It is large in the foot of a narrow peak: the relative
    /// rounding of exp(-576) is 576 times that of 1.
    double rounded_at(double t) {
        double sum = 0;
        for (const model::Component& c : angle_.components()) {
            const auto* script = std::get_if<model::Scripted>(&c.term);
            model::Formula* formula = script != nullptr ? script->function->read() : nullptr;
            if (formula == nullptr || formula->gave_up()) continue;
            unseen_.begin(*formula, nullptr);
            unseen_.give(0, {t - script->delay});
            const double rounded = std::fabs(c.gain) * unseen_.rounded();
            if (std::isfinite(rounded)) sum += rounded;
        }
        return sum;
    }

    enum class Agreement { unknown, strays, proven };
    /// Decides whether the functions of the angle follow the series between its nodes.
    Agreement agreement_with(const Series& series, double from, double h) {
        constexpr double clearly = 64, roundings_inside = 16, few_roundings = 16;
        constexpr int search_budget = 64;
        const double late = std::max(std::fabs(from), std::fabs(from + 2 * h));
        Agreement agreement = Agreement::proven;
        for (const model::Component& c : angle_.components()) {
            const auto* script = std::get_if<model::Scripted>(&c.term);
            if (script == nullptr || c.gain == 0 || agreement == Agreement::strays) continue;
            model::Formula* formula = script->function->read();
            if (formula == nullptr || formula->gave_up()) {
                agreement = Agreement::unknown;
                continue;
            }
            unseen_.begin(*formula, nullptr);
            unseen_.give(0, {from + h - script->delay, h - roundings_inside * rounding * late});
            const double size = cheb::size(series);
            double allowed =
                (clearly * (4 * rounding * size + lost_in_time(series, late, h, size)) + smallest) / std::fabs(c.gain);
            if (const double rounded = unseen_.rounded(); std::isfinite(rounded)) allowed += few_roundings * rounded;
            if (unseen_.certainly_follows(allowed, 0)) continue;
            const auto found = unseen_.search({}, search_budget, [=](const Series&) { return allowed; });
            if (found.place) agreement = Agreement::strays;
            if (!found.place && !found.proven) agreement = Agreement::unknown;
        }
        return agreement;
    }

    model::Excitation angle_;
    double longest_, gap_ = 0;
    Unseen unseen_;
    std::vector<double> breaks_;      // known breaks; the first is the start
    std::map<double, Piece> pieces_;  // by the time at which they begin
};

Moving::Moving(const model::System& given, const model::Drive& its_drive, double start, double longest)
    : system(given), drive(its_drive) {
    drive.loads.resize(system.joints.size());
    for (std::size_t i = 0; i < given.bodies.size(); ++i) {
        const auto& moved = given.bodies[i].moved;
        if (!moved) continue;
        model::Joint joint;
        joint.name = given.bodies[i].name, joint.of = {{i, 1}}, joint.rigid = true;
        system.joints.push_back(std::move(joint));
        drive.loads.emplace_back();
        drive.belts.push_back(moved->by_angle ? model::Excitation() : moved->motion);
        if (moved->by_angle && moved->motion.constant_from() > -model::never) {
            const auto velocity = std::make_shared<VelocityOfAngle>(moved->motion, start, longest);
            model::Scripted script;
            script.function = velocity;
            drive.belts.back() = model::Excitation::make(script).value();
            velocities_.push_back(velocity);
        }
        if (moved->by_angle) drive.theta0[i] = belt_from(moved->motion, start);
        drive.velocity0[i] = belt_from(drive.belts.back(), start);
        // the motion is prescribed, so its inertia is arbitrary
        if (system.bodies[i].inertia == 0) system.bodies[i].inertia = 1;
    }
}

double Moving::gap() const {
    double gap = 0;
    for (const auto& velocity : velocities_) gap = std::max(gap, velocity->gap());
    return gap;
}

}  // namespace dinal::motion::engine
