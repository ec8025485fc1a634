#include "motion/engine/conditions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/engine/crossing.hpp"

namespace dinal::motion::engine {

namespace {

bool is_known(double v) {
    return std::isfinite(v);
}

/// Searches a stretch for conditions that change their decision.
class ConditionSearch {
public:
    struct Crossing {
        double x;
        Piecewise* function;
        std::size_t condition;
        double within;
        /// whether its margin was clear of rounding at the start
        bool blurred;
    };
    /// A condition, its margins at the nodes, their change caused by rounding, and where the stretch ends otherwise.
    struct Margin {
        Piecewise* function;
        std::size_t condition;
        Nodes values;
        double rounded, before;
    };
    explicit ConditionSearch(const Segment& segment) : segment_(segment) {}

    void watch(const Margin& margin) {
        if (!watch(margin, {})) not_finite_.push_back(margin);
    }
    /// Watches the conditions whose margin is not finite at all nodes: a piece's formula may have no value beyond the
    /// end of the piece, as sqrt(|theta|), evaluated as sqrt(theta), has none for theta < 0. Such a condition is
    /// watched up to the first crossing of another one, or as far as its margin is finite.
    void watch_not_finite();
    const std::vector<Crossing>& crossings() const { return crossings_; }
    double earliest() const { return earliest_; }

private:
    struct Part {
        double first = -1, last = 1;
        double place(double x) const { return first + (x + 1) * (last - first) / 2; }
    };
    bool watch(Margin margin, Part part);

    const Segment& segment_;
    double earliest_ = 1;
    std::vector<Crossing> crossings_;
    std::vector<Margin> not_finite_;
    std::vector<double> y_, margins_;
};

/// Returns false if the margin is not finite everywhere in this part.
bool ConditionSearch::watch(Margin margin, Part part) {
    auto& [function, c, values, rounded, before] = margin;
    const bool whole = part.first == -1 && part.last == 1;
    const auto exact = [&](double x) {
        const double at = whole ? x : part.place(x);
        segment_.state(at, y_);
        margin.function->margins({segment_.time(at), Side::at, y_}, margins_);
        return margins_[margin.condition];
    };
    if (!whole) std::transform(cheb::nodes.begin(), cheb::nodes.end(), values.begin(), exact);
    if (!std::all_of(values.begin(), values.end(), is_known)) return false;
    // A condition that M drives back may already be on the wrong side by rounding.
    const double within = 64 * rounding * greatest(values), beyond = std::max(within, 16 * rounded);
    const auto* const clear =
        std::find_if(values.begin(), values.end(), [beyond](double v) { return std::fabs(v) > beyond; });
    const bool is_back = values[0] < -rounded && clear != values.end() && *clear < 0;
    Half half = 1;
    auto x = is_back ? std::optional(-1.0) : Watched(values, exact, rounded).leaves(half, -1);
    if (x && !whole) x = part.place(*x);
    if (x && *x < before) {
        crossings_.push_back({*x, function, c, within, whole && values[0] > 16 * rounded});
        earliest_ = std::min(earliest_, *x);
    }
    return true;
}

void ConditionSearch::watch_not_finite() {
    const double end_of_others = earliest_;
    for (const Margin& u : not_finite_) {
        constexpr double within = 1e-12;
        const auto* const begin = u.values.begin() + (is_known(u.values[0]) ? 0 : 1);
        const auto* const bad = std::find_if_not(begin, u.values.end(), is_known);
        if (bad == begin) continue;
        const double first = begin == u.values.begin() ? -1 : -1 + within;
        const double known = cheb::nodes[static_cast<std::size_t>(bad - u.values.begin()) - 1];
        const double last = std::min({end_of_others - within, u.before, 1.0});
        if (!(last > first)) continue;
        if (watch(u, {first, last}) || known >= last) continue;
        watch(u, {first, known});
    }
}

}  // namespace

Conditions::Conditions(Mechanics& mechanics, Frames& frames, std::size_t passed, double start, double unit)
    : mechanics_(mechanics),
      passed_(passed),
      unit_(unit),
      samples_(mechanics.samples_the_motion()),
      slides_(mechanics, frames, unit) {
    mechanics.for_each_piecewise(start, [this](Piecewise&) { any_ = true; });
}

void Conditions::let_go(double t) {
    mechanics_.for_each_piecewise(t, [](Piecewise& function) { function.let_go(); });
    any_ = false;
    cease();
}

double Conditions::belt_of(std::size_t body, const Moment& at) const {
    return mechanics_.has_belt(body) ? mechanics_.belt(body, at.t, at.side) : 0;
}

/// Returns the smallest slip of a body on its belt that its velocity can represent.
double Conditions::least_slip(std::size_t body, const Moment& at) const {
    return std::max(std::numeric_limits<double>::min(), 4 * rounding * std::fabs(belt_of(body, at)));
}

void Conditions::decide(const Moment& at, const Mode& mode, const Segment& last) {
    if (!any_) return;
    if (slides_.any()) slides_.follow(mode);
    // If a velocity leaves 0, the state is taken slightly later, because a condition such as floor(10 + velocity) loses
    // small digits.
    constexpr double little_later = 1e-9;
    const std::size_t n = mechanics_.bodies();
    const double soon = at.t + little_later * unit_;
    double t = at.t;
    std::vector<double>& y = soon_;
    y.assign(at.y.begin(), at.y.end());
    if (forgotten_ && crossed_at_ == at.t) {
        // After an action at a crossing, rounding must not reverse the decision of the crossing.
        constexpr double past_rounding = 1e-12, few = 16;
        const double step = std::max(past_rounding * unit_, few * rounding * std::fabs(at.t));
        const std::vector<double> moving = slides_.free_rates(mode, at);
        for (std::size_t k = 0; k < y.size(); ++k) y[k] += step * moving[k];
        if (at.t + step < mechanics_.next_break(at.t)) t += step;
    }
    std::uint64_t again = forgotten_ ? ~std::uint64_t{0} : 0, of_leaving = 0;
    bool starts_with_belt = false;
    std::vector<double> rates;  // dy/dt; empty unless other bodies or belts move while one leaves
    const std::size_t joints = mechanics_.joints();
    standing_.resize(joints);
    for (std::size_t j = 0; j < joints; ++j) {
        const Slipping& how = mode.friction[j];
        const bool leaves = mode.rubs[j] != 0 && how.leaving && mode.leans[j] == 0;
        const int now = leaves ? model::sign_of(how.way) > 0 ? 2 : 3 : mode.holds(j) || how.riding ? 1 : 0;
        const model::Joint& joint = mechanics_.system().joints[j];
        // If a body begins to move while others or belts move, the rates decide its conditions.
        if (leaves && (n > 1 || mechanics_.has_belt(j)) && rates.empty()) rates = slides_.free_rates(mode, at);
        bool clear = j < n;  // a link that has just reached its limit has no rate yet and is not decided again
        if (leaves && !clear) {
            constexpr double clearly = 1e-6;
            sizes_.find(mechanics_, last, at);
            const double size = sizes_.on(joint) * joint.lightness(mechanics_.system().bodies);
            clear = model::sign_of(how.way) * slides_.slip_rate(j, rates, at) > clearly * size;
        }
        for (const model::Weight& weight : joint.of) {
            const std::size_t bit = mechanics_.system().named ? n + weight.body : 1;
            if (now == 0 || now == standing_[j] || !clear || bit >= 64) continue;
            (leaves ? of_leaving : again) |= std::uint64_t{1} << bit;
        }
        standing_[j] = now;
    }
    for (std::size_t i = 0; i < n; ++i) {
        const Slipping& how = mode.friction[i];
        const bool leaves = standing_[i] > 1;
        double& v = y[n + i];
        if (leaves && std::fabs(v - belt_of(i, at)) <= least_slip(i, at)) {
            sizes_.find(mechanics_, last, at);
            const double size = sizes_.on(mechanics_.system().joints[i]);
            double rate = size / mechanics_.system().bodies[i].inertia;
            starts_with_belt = starts_with_belt || mechanics_.has_belt(i);
            if (!rates.empty()) rate = std::max(0.0, model::sign_of(how.way) * slides_.slip_rate(i, rates, at));
            const double speed = little_later * unit_ * rate;
            t = mechanics_.next_break(at.t) <= soon ? at.t : soon;
            v = belt_of(i, {t, at.side, {}}) + model::sign_of(how.way) * std::max(least_slip(i, at), speed);
        }
    }
    for (std::size_t i = 0; i < n && !rates.empty(); ++i) {
        if (standing_[i] == 0) y[n + i] += little_later * unit_ * rates[n + i];
    }
    mechanics_.set_law_directions(mode);
    mechanics_.for_each_piecewise(at.t, [&](Piecewise& function) {
        // A condition that was just crossed at standstill, and so lets the velocity leave, keeps its decision.
        const bool just_crossed = has_just_crossed(function, of_leaving, at.t);
        const bool known = !forgotten_ && slides_.just_left(function, at.t);
        const std::uint64_t selected = known ? 0 : just_crossed ? again : again | of_leaving;
        if (of_leaving != 0 && !forgotten_ && !starts_with_belt && decide_clearly(function, at, selected)) return;
        function.decide({t, at.side, y}, selected);
        if (selected != 0 && !forgotten_) decide_by_rate(function, at, mode, selected);
    });
    forgotten_ = false;
}

/// Returns the change of each margin if the time changes by `later` and each variable of the state by a few ulps plus
/// its entry in `more`, which may be empty.
std::vector<double> Conditions::rounding_of(const Piecewise& function, const Moment& at,
                                            const std::vector<double>& margins, double later,
                                            const std::vector<double>& more) const {
    std::vector<double> rounded(margins.size(), 0), beside, y(at.y.begin(), at.y.end());
    const auto add = [&](double t) {
        function.margins({t, at.side, y}, beside);
        for (std::size_t c = 0; c < margins.size(); ++c) {
            const double change = std::fabs(beside[c] - margins[c]);
            if (is_known(change)) rounded[c] += change;
        }
    };
    for (std::size_t k = 0; k < passed_; ++k) {
        y[k] = at.y[k] * (1 + 4 * rounding) + (more.empty() ? 0 : more[k]);
        add(at.t);
        y[k] = at.y[k];
    }
    add(at.t + later);
    return rounded;
}

/// Decides the conditions at this moment. Returns false if the margin of a selected one may be zero by rounding.
bool Conditions::decide_clearly(Piecewise& function, const Moment& at, std::uint64_t selected) {
    if (function.is_friction() || function.is_spring() || function.slides()) return false;
    function.decide(at, selected);
    std::vector<double> margins;
    function.margins(at, margins);
    const std::vector<double> rounded =
        rounding_of(function, at, margins, 4 * rounding * (std::fabs(at.t) + unit_), {});
    for (std::size_t c = 0; c < margins.size(); ++c) {
        const bool is_selected = (function.conditions()[c].of & selected) != 0;
        if (is_selected && !(std::fabs(margins[c]) > 16 * rounded[c])) return false;
    }
    return true;
}

/// Decides conditions on a velocity that a contact holds or has just released. If a margin passes zero right now, its
/// value slightly later counts.
void Conditions::decide_by_rate(Piecewise& function, const Moment& at, const Mode& mode, std::uint64_t again) {
    constexpr double little_later = 1e-9, next_to_none = 1e-3;
    if (function.is_friction() || function.is_spring() || function.slides() || function.conditions().empty()) return;
    const std::size_t n = mechanics_.bodies();
    std::vector<double> y(at.y.begin(), at.y.end()), margins, then;
    for (std::size_t i = 0; i < n; ++i) {
        if (standing_[i] > 1) y[n + i] = belt_of(i, at) + (standing_[i] == 2 ? 1 : -1) * least_slip(i, at);
    }
    function.margins({at.t, at.side, y}, margins);
    const double h = little_later * unit_;
    const bool carried = mechanics_.has_belts();
    for (std::size_t i = 0; i < n && !carried; ++i) y[i] += h * y[n + i];
    const Moment later = carried ? slides_.advance_with_belts(at, mode, y) : Moment{at.t + h, at.side, y};
    function.margins(later, then);
    for (std::size_t c = 0; c < margins.size(); ++c) {
        const bool passes = std::fabs(margins[c]) < next_to_none * std::fabs(then[c]);
        if (passes && (function.conditions()[c].of & again) != 0) return function.decide(later, again);
    }
}

/// Returns whether a condition on one of these arguments was crossed at this time.
bool Conditions::has_just_crossed(const Piecewise& function, std::uint64_t arguments, double now) const {
    if (crossed_at_ != now) return false;
    const auto& conditions = function.conditions();
    return std::any_of(conditions.begin(), conditions.end(), [&](const auto& each) {
        return (each.of & arguments) != 0 && last_of(function, each.step).t == now;
    });
}

bool Conditions::stay_clear(const Ranges& ranges, const Moment& from) {
    if (!any_) return true;
    bool clear = !forgotten_;
    std::vector<double> margins;
    mechanics_.for_each_piecewise(from.t, [&](Piecewise& function) {
        if (!clear || function.conditions().empty()) return;
        clear = !function.is_friction();
        if (clear) function.margins(from, margins);
        for (std::size_t c = 0; clear && c < margins.size(); ++c) {
            clear = margins[c] > 0 && function.keeps(c, ranges, mechanics_.system().named);
        }
    });
    return clear;
}

void Conditions::watch(const Segment& segment, const std::vector<double>& begin, double now, Ending& ending) {
    ConditionSearch search(segment);
    // If a load jumps because another body passes a place at the instant of a release, that jump decides about the
    // release.
    const double beside_release = ending.by == By::release ? ending.x + one_instant : ending.before();
    std::vector<double> y, margins;
    const Moment start{segment.times[0], segment.side(0), begin};
    // A slide keeps the motion on its surface to the rounding of the torques.
    const std::size_t n = mechanics_.bodies();
    std::vector<double> held;
    if (slides_.any()) {
        const double length = 2 * segment.h;
        held.assign(begin.size(), 0);
        sizes_.find(mechanics_, segment, start);
        for (std::size_t i = 0; i < n; ++i) {
            held[n + i] = 64 * rounding * length * sizes_.on_body(i) / mechanics_.system().bodies[i].inertia;
            held[i] = length * held[n + i];
        }
    }
    mechanics_.for_each_piecewise(now, [&](Piecewise& function) {
        const std::size_t count = function.conditions().size();
        if (count == 0) return;
        std::vector<Nodes> values(count);
        for (std::size_t j = 0; j < node_count; ++j) {
            function.margins(segment.moment(j, y), margins);
            for (std::size_t c = 0; c < count; ++c) values[c][j] = margins[c];
        }
        // A change of the margin caused by a few ulps of the motion or of the time counts as rounding.
        std::vector<double> first(count);
        for (std::size_t c = 0; c < count; ++c) first[c] = values[c][0];
        std::vector<double> rounded = rounding_of(function, start, first, 4 * rounding * start.t, held);
        // The margin of a condition that was just crossed may be as large as it was then, also on a shorter stretch.
        for (std::size_t c = 0; c < count && crossed_at_ == now; ++c) {
            const LastCrossing& last = last_of(function, function.conditions()[c].step);
            if (last.t == now) rounded[c] = std::max(rounded[c], last.within);
        }
        for (std::size_t c = 0; c < count; ++c) {
            const bool of_place = is_of_place(function, function.conditions()[c].of);
            search.watch({&function, c, values[c], rounded[c], of_place ? beside_release : ending.before()});
        }
    });
    search.watch_not_finite();
    if (search.crossings().empty()) return;
    ending = {search.earliest(), By::condition};
    within_ = 0;
    // Only the first crossing of each function counts: later steps depend on it, as |v| > 0 depends on the sign of
    // v, and may not change at all.
    std::vector<std::pair<Piecewise*, std::size_t>>& first = ending.conditions;
    for (const auto& [x, function, condition, within, blurred] : search.crossings()) {
        if (x > ending.x + one_instant) continue;
        ending.blurred = ending.blurred || blurred || comes_back(*function, condition, now);
        within_ = std::max(within_, within);
        const auto same =
            std::find_if(first.begin(), first.end(), [f = function](const auto& c) { return c.first == f; });
        if (same == first.end()) {
            first.emplace_back(function, condition);
        } else {
            same->second = std::min(same->second, condition);
        }
    }
}

/// Returns whether a condition on angles was just crossed and crosses back at once. A jump of torques cannot turn the
/// motion so fast, so the crossing may be rounding of a long stretch.
bool Conditions::comes_back(const Piecewise& function, std::size_t condition, double now) const {
    const auto [step, beyond, of] = function.conditions()[condition];
    const bool of_place = is_of_place(function, of);
    return last_of(function, step).t == now && of_place;
}

Conditions::Crossed Conditions::cross(const Ending& ending, Now& now, Chatter& chatter) {
    constexpr double small = 1e-5, nothing = 1e-13;
    constexpr int most_small = 30;
    constexpr double soon = 1e-6, rather_soon = 1e-5;
    const bool often = chatter.too_often(now.t.hi);
    Crossed crossed;
    bool all_small = true;
    const Moment here = now.here();
    // If another surface is met at the same instant, it counts first: a slide along it may keep the shares within their
    // limits.
    const bool meets = std::any_of(ending.conditions.begin(), ending.conditions.end(),
                                   [](const auto& crossing) { return !crossing.first->slides(); });
    for (const auto& [function, condition] : ending.conditions) {
        if (condition <= 1 && function->slides() && meets) continue;
        const auto& done = crossed.changes.functions;
        if (std::find(done.begin(), done.end(), function) != done.end()) continue;
        if (slides_.leave(*function, condition, now, crossed.changes)) {
            crossed.jumps = true, all_small = false;
            continue;
        }
        const auto [step, beyond, of] = function->conditions()[condition];
        const bool several = ending.conditions.size() > 1;
        const LastCrossing last = last_of(*function, step);
        const double any_before = several ? crossed_at_ : crossed_.try_emplace(function, -model::never).first->second;
        const bool soon_again = here.t - any_before <= soon * unit_;
        const bool rises = beyond > function->decision(step);
        const bool back = here.t - last.t <= soon * unit_ && last.rises != rises;
        const double earlier = last.t < here.t ? last.t : last.earlier;
        // A motion that crosses back at the same instant stands on the surface.
        const double since = back && last.t == here.t ? 0 : here.t - earlier;
        if (here.t > last.t) crossed.since = std::min(crossed.since, here.t - last.t);
        chatter.crossed(back);
        last_[{function, step}] = {rises, here.t, within_, earlier};
        crossed_[function] = crossed_at_ = here.t;
        const double before = function->value(here);
        function->cross(condition);
        const double jump = std::fabs(function->value(here) - before);
        greatest_ = std::max({greatest_, std::fabs(before), jump});
        const bool clear = jump > nothing * greatest_;
        crossed.jumps = crossed.jumps || clear;
        if (clear && !function->is_friction()) ++crossed.count;
        all_small = all_small && clear && jump < small * greatest_;
        const bool rather_soon_again = since <= rather_soon * unit_;
        if (!clear || (several && !soon_again && !rather_soon_again)) continue;
        const bool driven_back = soon_again || slides_.stands(*function, now);
        const auto begun = driven_back ? slides_.begin(*function, {.jump = jump}, now) : std::nullopt;
        if (begun) {
            auto& [slides, functions] = crossed.changes;
            slides.insert(slides.end(), begun->changes.slides.begin(), begun->changes.slides.end());
            functions.insert(functions.end(), begun->changes.functions.begin(), begun->changes.functions.end());
            crossed.work = begun->work, chatter.crossed(false);
        } else if (rather_soon_again && !(crossed.back && crossed.back->jump > jump)) {
            crossed.back = {function, condition, since, jump};
        }
    }
    small_in_a_row_ = all_small ? small_in_a_row_ + 1 : 0;
    crossed.endless = often || chatter.to_and_fro_endlessly();
    const bool noise = crossed.endless ? !crossed.jumps : small_in_a_row_ >= most_small;
    if (noise) let_go(here.t), crossed.back.reset();
    return crossed;
}

}  // namespace dinal::motion::engine
