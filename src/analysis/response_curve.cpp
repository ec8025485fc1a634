#include "analysis/response_curve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace dinal::analysis {
namespace {

class CurveSearch {
public:
    CurveSearch(const CurveQuestion& question, const motion::Monitor& monitor)
        : question_(question),
          monitor_(monitor),
          sorted_(question.values),
          way_(question.values.back() > question.values.front() ? 1 : -1) {
        std::ranges::sort(sorted_);
        range_ = sorted_.back() - sorted_.front();
        const auto& v = question.values;
        walkable_ = v.size() > 1;
        for (std::size_t i = 1; i < v.size(); ++i) walkable_ = walkable_ && (v[i] - v[i - 1]) * way_ > 0;
    }

    ResponseCurve found() {
        sweep();
        for (std::size_t i = 0; i < curve_.jumps.size() && i < most_jumps && !stopped(); ++i) go_on_from(i);
        follow_new_branches();
        if (walked_ && !stopped()) search_from_far_end();
        follow_new_branches();
        std::ranges::stable_sort(curve_.jumps, {}, &MotionJump::parameter);
        return std::move(curve_);
    }

private:
    static constexpr std::size_t most_jumps = 12, most_born = 32;

    bool stopped() const { return stopped_; }

    /// Searches from the start of the previous motion, or from the requested start.
    SteadyMotion motion_at(double p, const std::optional<SteadyMotion>& before, bool near) {
        SteadyQuestion question = question_.family(p);
        // The start of a limit cycle is arbitrary and useless for another one: so each search uses the requested start.
        if (question.is_timeless()) return motion_of(question, near);
        if (!before && question.is_plain()) question.drive.start_at(question_.start);
        if (before) question = from_motion(std::move(question), *before, false);
        return motion_of(question, near);
    }

    /// The motion at p, started from a motion at another value.
    SteadyMotion motion_after(double p, const SteadyMotion& before, bool near) {
        return motion_of(from_motion(question_.family(p), before, true), near);
    }

    [[nodiscard]] static SteadyQuestion from_motion(SteadyQuestion question, const SteadyMotion& motion, bool states) {
        if (!question.is_plain()) {
            if (!motion.by_returns.drive) return question;
            question.drive.theta0 = motion.by_returns.drive->theta0;
            question.drive.velocity0 = motion.by_returns.drive->velocity0;
            if (states) question.drive.states = motion.by_returns.drive->states;
            return question;
        }
        question.drive.start_at(motion.start);
        if (states && motion.by_returns.question) {
            question.drive.velocity0 = motion.by_returns.question->drive.velocity0;
            for (std::size_t i = 0; i < question.drive.states.size(); ++i) {
                question.drive.states[i].start = motion.by_returns.question->drive.states[i].start;
            }
        }
        return question;
    }

    SteadyMotion motion_of(const SteadyQuestion& question, bool near) {
        SteadyMotion motion = near ? steady_motion_near(question, monitor_) : steady_motion(question, monitor_);
        if (motion.contradiction) curve_.contradiction = motion.contradiction;
        stopped_ = stopped_ || motion.contradiction || motion.outcome == model::Outcome::interrupted ||
                   motion.outcome == model::Outcome::excitation_not_finite;
        return motion;
    }

    /// The circuit of a motion that may not be unique; null if there is no circuit.
    std::unique_ptr<Circuit> circuit_of(double p, const SteadyMotion& motion, int periods) {
        const bool slides = motion.status == SteadyStatus::rest && motion.by_returns.question && motion.stuck == 0;
        if (!walkable_ || (motion.status != SteadyStatus::steady && !slides)) return {};
        if (std::isnan(motion.amplitude)) return {};  // it rotates: no amplitude
        const SteadyQuestion question = question_.family(p);
        if (!question.is_plain() && (question.settles >= 0 || contracts(question))) return {};
        if (contracts(question) && question.drive.states.empty() && question.drive.events.empty()) return {};
        SteadyMotion begun = motion;
        begun.symmetric = motion.symmetric && periods == 1 && family_is_symmetric();
        if (PeriodMap::applies_to(question)) return circuit_of_periods(question_.family, p, begun, periods, monitor_);
        return circuit_of_returns(question_.family, p, begun, periods, monitor_);
    }

    /// Returns whether the problem is symmetric at all parameter values. Otherwise a map over half a period, valid for
    /// a symmetric motion at the start of a branch, would be wrong at other points of it.
    bool family_is_symmetric() {
        if (!family_is_symmetric_) {
            family_is_symmetric_ = std::ranges::all_of(
                sorted_, [&](double value) { return is_symmetric_problem(question_.family(value)); });
        }
        return *family_is_symmetric_;
    }

    void note_outcome(const Circuit& circuit) {
        if (circuit.contradiction()) curve_.contradiction = circuit.contradiction();
        stopped_ = stopped_ || circuit.stopped();
    }

    void sweep() {
        const std::vector<double>& values = question_.values;
        std::optional<SteadyMotion> last;
        std::vector<BranchPoint> row;
        bool near = false;
        for (std::size_t i = 0; i < values.size() && !stopped();) {
            const SteadyMotion motion = motion_at(values[i], last, near);
            const bool moves = motion.status == SteadyStatus::steady;
            const auto circuit = circuit_of(values[i], motion, motion.periods);
            if (!circuit) {
                near = moves;
                if (moves) last = motion;
                row.push_back({values[i], motion, true});
                ++i;
                continue;
            }
            std::vector<BranchPoint>& added = add_branch(*circuit, values[i], motion, i > 0);
            if (!row.empty()) {
                if (joins(row.back(), added.front(), motion.amplitude)) {
                    added.insert(added.begin(), row.begin(), row.end() - 1);
                } else {
                    if (added.front().motion.amplitude > 1e-3 * motion.amplitude)
                        note_leap(row.back(), {values[i], motion});
                    curve_.branches.insert(curve_.branches.end() - 1, std::move(row));
                }
                row.clear();
            }
            const std::vector<BranchPoint>& branch = curve_.branches.back();
            double farthest = values[i];
            for (const BranchPoint& point : branch) {
                if ((point.parameter - farthest) * way_ > 0) farthest = point.parameter;
            }
            last = branch.back().motion;
            near = true;
            while (i < values.size() && (values[i] - farthest) * way_ <= 0) ++i;
        }
        if (!row.empty()) curve_.branches.push_back(std::move(row));
    }

    /// Follows the branches that begin at points of others: limit cycles and, if requested, doublings.
    void follow_new_branches() {
        for (; seen_ < std::min(curve_.branches.size(), most_born); ++seen_) {
            const std::vector<BranchPoint> points = curve_.branches[seen_];
            for (const BranchPoint& point : points) {
                if (stopped()) return;
                if (point.kind == BranchKind::hopf && !ends_at(point)) {
                    const auto circuit =
                        circuit_of_first_cycles(question_.family, point.parameter, point.motion, monitor_);
                    if (circuit) add_new_branch(point, *circuit, walk_up(*circuit, sorted_, point.parameter));
                }
                if (point.kind == BranchKind::doubling && question_.doubled) {
                    const auto circuit = circuit_of(point.parameter, point.motion, 2 * point.motion.periods);
                    if (circuit) add_new_branch(point, *circuit, walk_aside(*circuit, sorted_, point.parameter));
                }
            }
        }
    }
    void add_new_branch(const BranchPoint& point, const Circuit& circuit, BranchPath path) {
        note_outcome(circuit);
        if (path.points.size() < 2) return;
        // The smallest cycles practically coincide with the Hopf point.
        BranchPoint& first = path.points.front();
        constexpr double small = 1e-2;
        if (first.kind == BranchKind::fold && point.kind == BranchKind::hopf) {
            const double most = std::ranges::max_element(path.points, [](const auto& a, const auto& b) {
                                    return a.motion.amplitude < b.motion.amplitude;
                                })->motion.amplitude;
            if (first.motion.amplitude < small * most) path.points.erase(path.points.begin());
        }
        path.points.insert(path.points.begin(), {point.parameter, point.motion});
        if (path.end == WalkEnd::lost) note_end(path.points, path.points.size() - 1, -1);
        note_folds(path.points);
        curve_.branches.push_back(std::move(path.points));
    }
    /// Returns whether a branch of limit cycles ended at this Hopf point.
    bool ends_at(const BranchPoint& hopf) const {
        constexpr double near = 1e-3, small = 1e-2;
        return std::ranges::any_of(curve_.branches, [&](const auto& branch) {
            double most = 0;
            for (const BranchPoint& point : branch) most = std::max(most, point.motion.amplitude);
            return std::ranges::any_of(branch, [&](const BranchPoint& end) {
                return end.motion.period > 0 && end.motion.amplitude < small * most &&
                       std::fabs(end.parameter - hopf.parameter) < near * range_;
            });
        });
    }

    [[nodiscard]] static bool joins(const BranchPoint& a, const BranchPoint& b, double size) {
        return a.parameter == b.parameter && std::fabs(a.motion.amplitude - b.motion.amplitude) <= 1e-6 * size;
    }

    /// Adds the branch through this motion, in both directions unless it begins here.
    std::vector<BranchPoint>& add_branch(Circuit& circuit, double p, const SteadyMotion& motion, bool both) {
        walked_ = true;
        std::vector<BranchPoint> branch;
        WalkEnd back_end = WalkEnd::range;
        if (both) {
            BranchPath back = walk(circuit, sorted_, p, -way_);
            note_outcome(circuit);
            back_end = back.end;
            branch.assign(back.points.rbegin(), back.points.rend());
        }
        branch.push_back({p, motion, true});
        if (back_end != WalkEnd::closed && !stopped()) {
            BranchPath on = walk(circuit, sorted_, p, way_);
            note_outcome(circuit);
            branch.insert(branch.end(), on.points.begin(), on.points.end());
            if (on.end == WalkEnd::lost) note_end(branch, branch.size() - 1, -1);
        }
        if (back_end == WalkEnd::lost) note_end(branch, 0, 1);
        note_folds(branch);
        curve_.branches.push_back(std::move(branch));
        return curve_.branches.back();
    }

    void note_folds(const std::vector<BranchPoint>& branch) {
        for (std::size_t i = 1; i + 1 < branch.size() && !stopped(); ++i) {
            if (branch[i].kind != BranchKind::fold) continue;
            if (branch[i - 1].motion.stable == branch[i + 1].motion.stable) continue;
            const BranchPoint& before = branch[branch[i - 1].motion.stable ? i - 1 : i + 1];
            add_jump(branch[i], branch[i].parameter > before.parameter);
        }
    }

    /// Records the end of a branch, such as the onset of sticking with Re > Rd.
    void note_end(const std::vector<BranchPoint>& branch, std::size_t i, int inwards) {
        if (stopped() || branch.size() < 2) return;
        const BranchPoint& end = branch[i];
        const BranchPoint& inside = branch[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + inwards)];
        if (inside.motion.stable) add_jump(end, end.parameter > inside.parameter);
    }

    /// Finds the motion beyond this point of the branch.
    void add_jump(const BranchPoint& end, bool rising) {
        const double beyond =
            std::clamp(end.parameter + (rising ? 1e-3 : -1e-3) * range_, sorted_.front(), sorted_.back());
        if (beyond == end.parameter) return;
        MotionJump jump{.parameter = end.parameter, .rising = rising, .from = end.motion.amplitude};
        jump.landed = motion_after(beyond, end.motion, false);
        if (jump.landed.status == SteadyStatus::steady && !stopped()) {
            const SteadyMotion here = motion_after(end.parameter, jump.landed, true);
            const bool alike = std::fabs(here.amplitude - jump.landed.amplitude) < 0.2 * jump.landed.amplitude;
            if (here.status == SteadyStatus::steady && alike) jump.landed = here;
        }
        jump.to = jump.landed.status == SteadyStatus::none ? std::nan("") : jump.landed.amplitude;
        // A branch that grows without bound has reached a resonance without a motion.
        constexpr double unbounded_ratio = 1e6;
        if (jump.landed.status == SteadyStatus::steady && jump.from > unbounded_ratio * jump.to) return;
        const double least = 1e-3 * std::max(jump.from, std::isnan(jump.to) ? 0 : jump.to);
        if (!stopped() && !(std::fabs(jump.from - jump.to) <= least)) curve_.jumps.push_back(jump);
    }

    /// Records a jump between two values if a resting mass has broken away.
    void note_leap(BranchPoint before, BranchPoint after) {
        if (before.motion.status != SteadyStatus::adheres) return;
        const bool rising = after.parameter > before.parameter;
        const double least = 0.05 * after.motion.amplitude;  // a smaller motion sets in gradually
        while (std::fabs(after.parameter - before.parameter) > 1e-10 * range_ && !stopped()) {
            const double middle = before.parameter + (after.parameter - before.parameter) / 2;
            BranchPoint point{middle, motion_at(middle, before.motion, true)};
            (point.motion.status == SteadyStatus::adheres ? before : after) = point;
        }
        if (after.motion.status != SteadyStatus::steady || after.motion.amplitude < least || stopped()) return;
        curve_.jumps.push_back({.parameter = after.parameter,
                                .rising = rising,
                                .from = before.motion.amplitude,
                                .to = after.motion.amplitude,
                                .landed = after.motion});
    }

    bool is_known(double p, const SteadyMotion& motion) const {
        for (const auto& branch : curve_.branches) {
            for (const BranchPoint& point : branch) {
                if (!point.asked || std::fabs(point.parameter - p) > 1e-9 * range_) continue;
                const double size = std::max(std::fabs(motion.low), std::fabs(motion.high));
                const double apart =
                    std::max(std::fabs(point.motion.low - motion.low), std::fabs(point.motion.high - motion.high));
                if (apart <= 1e-5 * size) return true;
            }
        }
        return false;
    }

    /// Follows the branch on which a jump lands, if it is new.
    void go_on_from(std::size_t i) {
        const MotionJump jump = curve_.jumps[i];
        const auto next = std::ranges::lower_bound(sorted_, jump.parameter);
        if (jump.rising ? next == sorted_.end() : next == sorted_.begin()) return;
        const double p = jump.rising ? *next : *(next - 1);
        add_unless_known(p, motion_after(p, jump.landed, true));
    }

    void add_unless_known(double p, const SteadyMotion& motion) {
        if (stopped() || is_known(p, motion)) return;
        if (const auto circuit = circuit_of(p, motion, motion.periods)) add_branch(*circuit, p, motion, true);
    }

    void search_from_far_end() {
        const double p = question_.values.back();
        add_unless_known(p, motion_at(p, {}, false));
        for (std::size_t i = 0; i < curve_.jumps.size() && i < most_jumps && !stopped(); ++i) go_on_from(i);
    }

    const CurveQuestion& question_;
    const motion::Monitor& monitor_;
    std::vector<double> sorted_;
    double way_, range_ = 0;
    std::size_t seen_ = 0;  // number of branches whose new branches were followed
    bool walkable_ = true, walked_ = false, stopped_ = false;
    std::optional<bool> family_is_symmetric_;  // empty until it is computed
    ResponseCurve curve_;
};

}  // namespace

ResponseCurve response_curve(const CurveQuestion& question, const motion::Monitor& monitor) {
    return CurveSearch(question, monitor).found();
}

}  // namespace dinal::analysis
