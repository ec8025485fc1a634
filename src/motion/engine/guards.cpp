#include "motion/engine/guards.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/contact.hpp"

namespace dinal::motion::engine {

using model::Joint;
using model::Motion;

/// All kinds of ends in the order in which they are watched for each joint. If several are at the same point, the first
/// one counts. Conditions and user events come last, because very close to a standstill they count as later.
const std::array<Guards::Row, 11> Guards::table{{
    {Per::joint, By::release, &Guards::watch_release},
    {Per::joint, By::slip, &Guards::watch_slip},
    {Per::joint, By::corner, &Guards::watch_corner},
    {Per::joint, By::wall, &Guards::watch_wall},
    {Per::joint, By::stop, &Guards::watch_stop},
    {Per::joint, By::kink, &Guards::watch_normal},
    {Per::joint, By::bend, &Guards::watch_bristles},
    {Per::slider, By::slider, &Guards::watch_slider},
    {Per::load, By::relay, &Guards::watch_relays},
    {Per::motion, By::condition, &Guards::watch_conditions},
    {Per::motion, By::user, &Guards::watch_users},
}};

std::size_t Guards::count(Per per) const {
    switch (per) {
        case Per::joint:
        case Per::load:
            return mechanics_.joints();
        case Per::slider:
            return now_.mode.sliders.size();
        case Per::motion:
            return 1;
    }
    return 0;
}

Ending Guards::first() {
    for (Contacts::Contact& each : parts_.contacts.of) each.crept = false;
    for (const Per per : {Per::joint, Per::slider, Per::load, Per::motion}) {
        for (which_ = 0; which_ < count(per); ++which_) {
            for (const Row& row : table) {
                if (row.per != per) continue;
                by_ = row.by;
                (this->*row.watch)(which_);
            }
        }
    }
    return ending_;
}

void Guards::end_at(std::optional<double> x, int side) {
    if (x && *x < ending_.x) ending_ = {*x, by_, which_, side};
}

void Guards::watch(const Series& left, double floor, bool zero, int side, double slope_floor) {
    cheb::Bounded<node_count> curve(1, left, cheb::derivative(left));
    curve.raise_floor(floor);
    curve.raise_slope_floor(slope_floor);
    end_at(cheb::first_below(curve, -1, zero), side);
}

bool Guards::slides(std::size_t joint) const {
    const Slipping& how = now_.mode.friction[joint];
    return now_.rubs(joint) && how.way != Motion::stuck && !how.riding;
}

/// Returns the magnitude of the velocities whose difference is the slip of a joint.
double Guards::fastest(std::size_t joint) const {
    double sum = greatest(segment_.belts[joint]);
    for (const auto& [body, by] : joint_at(joint).of) sum += std::fabs(by) * greatest(segment_.y[n() + body]);
    return sum;
}

/// Returns the inertia of a joint's lightest body, as the joint feels it.
double Guards::least_inertia(std::size_t joint) const {
    double inertia = model::never;
    for (const auto& [body, by] : joint_at(joint).of) {
        inertia = std::min(inertia, mechanics_.system().bodies[body].inertia / (by * by));
    }
    return inertia;
}

/// Returns the possible error of a joint's velocity. A motion that begins at slip 0, or at the limit of a slider, may
/// be wrong by more than it moves at first.
double Guards::uncertain(std::size_t joint) const {
    double sum = 0;
    for (const auto& [body, by] : joint_at(joint).of) sum += std::fabs(by) * parts_.solver.uncertain(body, segment_);
    return sum;
}

/// Returns whether all joints that leave slip 0 were released by less than the rounding of their torques, and so do not
/// move.
bool Guards::none_leaves() const {
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!now_.mode.friction[j].leaving) continue;
        Nodes slips = mechanics_.slips(j, segment_.y, segment_.belts[j]);
        for (const double first = slips[0]; double& slip : slips) slip -= first;
        const double by_rounding = 2 * segment_.h / least_inertia(j) * rounding * parts_.sizes.on(joint_at(j));
        constexpr double few = 4;
        if (now_.mode.leans[j] != 0 || greatest(slips) > few * by_rounding) return false;
    }
    return true;
}

void Guards::watch_slip(std::size_t joint) {
    if (!slides(joint)) return;
    const Joint& own = joint_at(joint);
    const Slipping& how = now_.mode.friction[joint];
    const double sign = model::sign_of(how.way), torques = parts_.sizes.on(own);
    const Nodes& belt = segment_.belts[joint];
    const bool leans = now_.mode.leans[joint] != 0;
    const Nodes turns = leans ? Nodes{} : mechanics_.between(joint, std::span(segment_.y).subspan(n()));
    const double first = how.leaving ? 0 : turns[0] - belt[0];
    Series series{};
    if (!leans) series = mechanics_.between(joint, std::span(segment_.series).subspan(n()));
    if (mechanics_.has_belt(joint)) {
        Nodes change{};
        for (std::size_t j = 0; j < node_count; ++j) change[j] = belt[j] - belt[0];
        series = difference(series, cheb::fit(change));
    }
    series[0] += first;
    const double fastest = this->fastest(joint);
    const double inertia = least_inertia(joint);
    // The joint may creep if its motion over the stretch is slower than rounding of its torques explains, or too small
    // to change the angle.
    const double drive = fastest * (own.damping + inertia / (2 * segment_.h)) / (rounding * torques);
    const bool no_way = fastest * 2 * segment_.h <= rounding / 2 * std::fabs(mechanics_.angle(joint, now_.y));
    const bool crept = drive <= (no_way ? 256 : 4) && may_creep(joint);
    if (crept) {
        parts_.contacts.of[joint].crept = true;
        if (!how.leaving && ending_.by == By::nobody) ending_ = {1, by_, joint};
        if (!how.leaving) return;
    }
    if (!how.leaving && stays_above_zero(sign, series, fastest)) return;
    Nodes slips{};
    for (std::size_t j = 0; j < node_count; ++j) {
        slips[j] = -(belt[j] - belt[0]);
    }
    for (const auto& [body, by] : own.of) {
        const Nodes& v = segment_.y[n() + body];
        for (std::size_t j = 0; j < node_count && !leans; ++j) slips[j] += by * (v[j] - v[0]);
    }
    for (double& slip : slips) {
        slip = sign * (first + slip);
    }
    cheb::Bounded<node_count> curve(sign, series, cheb::derivative(series), slips);
    if (own.of.size() > 1 || mechanics_.has_belt(joint)) curve.raise_floor(16 * rounding * fastest);
    curve.raise_slope_floor(segment_.h / inertia * 64 * rounding * torques);
    const auto always = [](double) { return true; };
    auto zero = cheb::first_below(curve, -1, how.leaving, always);
    if (how.leaving && zero && *zero <= -1 &&
        !mechanics_.has_belt(joint)) {  // the error of the motion may exceed its rounding
        curve.raise_floor(uncertain(joint));
        zero = cheb::first_below(curve, -1, true, always);
    }
    if (how.leaving && none_leaves()) zero = -1;
    // A zero beyond the end by no more than the rounding of the time is at the end. A joint that has just been released
    // when the run ends has not returned to zero.
    const double late = segment_.to_the_end ? 64 * rounding * std::fabs(segment_.end) / segment_.h : 0;
    const bool departs = how.leaving && segment_.to_the_end && curve.slope(1) >= 0;
    if (!zero && !departs && curve(1) <= std::max(curve.floor(), -curve.slope(1) * late)) zero = 1;
    // A slip that only touches zero counts at its lowest point.
    if (zero && *zero > -1 && *zero < 1) {
        if (const double lowest = curve.lowest_near(*zero); curve(lowest) >= -curve.floor()) zero = lowest;
    }
    if (!zero || *zero > ending_.x) return;
    const bool stays = how.leaving && *zero <= -1;
    ending_ = {*zero, stays ? By::stays : by_, joint};
    if (stays) stay_.push_back(joint);
}

/// Returns whether the torques at a joint are accurate to rounding: everything is linear, there is no belt, and no
/// wall.
bool Guards::may_creep(std::size_t joint) const {
    return mechanics_.all_linear() && !mechanics_.has_belt(joint) && now_.mode.leans[joint] == 0;
}

/// Watches whether the torque of a sticking joint exceeds its limit.
void Guards::watch_release(std::size_t joint) {
    if (!now_.mode.holds(joint) || now_.mode.rigid[joint] != 0) return;
    const double beside_zero = now_.mode.friction[joint].beside;
    const bool between = beside_zero > 0, constant = !mechanics_.limits_change(joint, now_.mode);
    const int wall = now_.mode.leans[joint];
    const double torques = parts_.sizes.on(joint_at(joint));
    const std::vector<double> slip = between ? slip_alone(mechanics_, now_.mode, joint) : std::vector<double>{};
    Nodes pull{};
    Series series = segment_.holding_series[joint];  // series of the pull
    for (std::size_t j = 0; j < node_count; ++j) pull[j] = -segment_.holding[joint][j], series[j] = -series[j];
    for (const Motion side : {Motion::forward, Motion::backward}) {
        const double sign = model::sign_of(side);
        if (wall * sign > 0) continue;
        const Nodes most = limit(joint, side);
        if (std::isnan(most[0])) {
            good_ = false;
            return;
        }
        if (std::isinf(most[0])) continue;  // the backward side of a freewheel
        const auto find_balance = [&](double x, const Moment& at, Balance& found) {
            std::vector<double> beside;
            return parts_.balances.on_stretch(
                segment_, x, between ? just_beside(at, slip, {side, side, 0, beside_zero}, beside) : at, now_.mode,
                frame_, found);
        };
        if (between) {
            for (std::size_t j = 0; j < node_count; ++j) {
                Balance found;
                if (!find_balance(cheb::nodes[j], segment_.moment(j, point_), found)) good_ = false;
                pull[j] = -found.holding[joint];
            }
            if (!good_) return;
            // If loads jump only at the first instant, and the joint holds there, its holding torque is the pull at the
            // start.
            constexpr double hardly = 1e-9;
            bool instant = -sign * segment_.holding[joint][0] <= most[0] + hardly * torques;
            for (std::size_t j = 1; j < node_count; ++j) {
                instant = instant && std::fabs(pull[j] + segment_.holding[joint][j]) <= 64 * rounding * torques;
            }
            if (instant) pull[0] = -segment_.holding[joint][0];
            series = cheb::fit(pull);
        }
        const double margin = now_.mode.friction[joint].margin;
        Series left = constant ? Series{most[0]} : cheb::fit(most);
        const double doubt =
            8 * (rounding * (greatest(most) + torques) + cheb::tail(series) + (constant ? 0 : cheb::tail(left))) +
            parts_.solver.blurred_by_belts(segment_) + (1 - known_part(mechanics_)) * greatest(pull);
        left[0] += margin;
        for (std::size_t k = 0; k < node_count; ++k) left[k] -= sign * series[k];
        if (cheb::least_bound(left) > 2 * doubt) continue;
        Nodes values{};
        for (std::size_t j = 0; j < node_count; ++j) values[j] = most[j] - sign * pull[j] + margin;
        left = cheb::fit(values);  // near zero this has more digits than the difference of two series
        cheb::Bounded<node_count> curve(1, left, cheb::derivative(left), values);
        curve.raise_floor(doubt);
        const auto lets_go = [&](double x) {
            std::vector<double> y;
            segment_.state(x, y);
            const Moment at{segment_.time(x), x <= -1 ? segment_.side(0) : Side::at, y};
            Balance found;
            if (!find_balance(x, at, found)) return false;
            Motion towards = Motion::stuck;
            return excess(mechanics_, joint, found, now_.mode, at, towards) > 0 && towards == side;
        };
        std::optional<double> touch;
        const auto touches = [&](double x) {
            if (margin > 0) return false;
            for (const double place : {x, curve.lowest_near(x)}) {
                if (!touch && lets_go(place)) touch = place;
            }
            return touch.has_value();
        };
        // An undetected jump may have taken the torque far beyond its limit.
        auto x = values[0] < -doubt ? std::optional(-1.0) : cheb::first_below(curve, -1, false, touches);
        if (x && touch) x = first_true(lets_go, *touch);
        if (x && segment_.time(*x) < segment_.end) end_at(x, static_cast<int>(side));
    }
}

/// Returns the greatest torques with which a joint resists a pull to this side, at the nodes; NaN if a value is not
/// finite.
Nodes Guards::limit(std::size_t joint, Motion side) const {
    const Slipping& how = now_.mode.friction[joint];
    Nodes most{};
    if (mechanics_.limits_change(joint, now_.mode)) {
        most = segment_.limits[joint][side == Motion::forward ? 1 : 0];
        const bool good = std::all_of(most.begin(), most.end(), [](double x) { return std::isfinite(x); });
        if (!good) most.fill(std::numeric_limits<double>::quiet_NaN());
        if (!good) return most;
    } else {
        const bool sticks = now_.rubs(joint) && how.way == Motion::stuck;
        most.fill(sticks ? mechanics_.limit_at_rest(joint, now_.mode, side, now_.here()) : 0);
        if (std::isinf(most[0])) return most;
    }
    if (how.creeps != Motion::stuck) {
        const double level = mechanics_.sliding(joint, {.way = how.creeps}, 0, now_.here());
        most.fill(contact::limit_of_creep(side, how.creeps, level, how.apart));
    }
    return most;
}

void Guards::watch_wall(std::size_t joint) {
    const auto& walls = joint_at(joint).walls;
    if (walls && now_.mode.leans[joint] == 0) watch_walls(joint, *walls);
}

void Guards::watch_walls(std::size_t joint, const model::Walls& walls) {
    for (const int wall : {1, -1}) {
        const double place = walls.at(wall);
        if (!std::isfinite(place)) continue;
        const double begin = wall * now_.gap(mechanics_.system().joints[joint], place);
        Nodes change = mechanics_.between(joint, segment_.moved);
        constexpr double between_nodes = 3;  // bound of a series relative to its greatest value at the nodes
        if (begin > (between_nodes + 1) * greatest(change) && begin > 256 * rounding * parts_.walls.reach[joint])
            continue;
        for (double& way : change) way *= -wall;
        // A motion that begins at the wall has a gap equal to its displacement, so it is as accurate.
        const bool leaving =
            parts_.contacts.of[joint].leaves_wall && std::fabs(begin) <= 4 * rounding * std::fabs(place);
        const double far = leaving ? greatest(change)
                                   : std::max(parts_.walls.reach[joint], std::fabs(place - parts_.walls.origin[joint]));
        Series left = cheb::fit(change);
        if (!leaving) left[0] += begin;
        // The sum of the bodies' velocities has a rounding although their joint leaves the wall from slip 0.
        const double rounded = leaving ? segment_.h * 16 * rounding * fastest(joint) : 0;
        watch(left, 64 * rounding * far + rounded, leaving, wall, rounded);
    }
}

/// Watches an elastic wall, which pushes while depth and torque are both positive. The depth becomes positive first,
/// except when a wall was left while still deformed: then the torque does.
void Guards::watch_stop(std::size_t joint) {
    if (!joint_at(joint).stops) return;
    const Moment first = segment_.moment(0, point_);
    if (parts_.conditions.slides().holds_slip(joint, now_.mode, frame_, first)) return;
    const model::Walls& stops = *mechanics_.system().joints[joint].stops;
    const double begin = mechanics_.angle(joint, first.y);
    const int pressed = now_.mode.presses[joint];
    const int deep = pressed != 0 ? pressed : begin > stops.upper ? 1 : begin < stops.lower ? -1 : 0;
    if (deep == 0 || (pressed == 0 && parts_.contacts.of[joint].leaves_wall)) return watch_walls(joint, stops);
    if (pressed == 0) {  // it may reach the opposite wall first
        model::Walls other = stops;
        (deep > 0 ? other.upper : other.lower) = deep * model::never;
        watch_walls(joint, other);
    }
    const auto value = [&](const Moment& at) {
        const double q = mechanics_.angle(joint, at.y);
        const double torque = deep * stops.torque(deep, q, mechanics_.velocity(joint, at.y));
        return pressed != 0 ? torque : std::min(torque, stops.stiffness * deep * (q - stops.at(deep)));
    };
    Half half = pressed != 0 ? 1 : -1;
    const double rounded = 64 * rounding * stops.stiffness * std::fabs(stops.at(deep));
    end_at(leaves(segment_.at_nodes(value, point_), value, half, rounded), pressed != 0 ? 0 : deep);
}

/// Returns whether other joints hold this one, so that its slip is only rounding. Belts and moved bodies may still turn
/// the held bodies.
bool Guards::is_kept(std::size_t joint) const {
    if (!frame_.keeps(joint)) return false;
    double fastest = this->fastest(joint);
    for (std::size_t i = 0; i < n(); ++i) fastest = std::max(fastest, greatest(segment_.y[n() + i]));
    return greatest(mechanics_.slips(joint, segment_.y, segment_.belts[joint])) <= 64 * rounding * fastest;
}

/// Watches whether a sticking slider reaches its limit, or the slip of a sliding one reverses. The direction of a
/// contact with dry friction is that of its mode, which reverses by watch_slip() only.
void Guards::watch_slider(std::size_t slider) {
    const Mechanics::Slider& own = mechanics_.sliders()[slider];
    if (is_kept(own.joint)) return;
    const Motion slides_to = now_.mode.sliders[slider];
    const bool known = now_.rubs(own.joint);
    const Motion moves_to = known ? now_.mode.friction[own.joint].way : Motion::stuck;
    Half half = 1;
    if (slides_to != Motion::stuck) {
        half = static_cast<int>(slides_to);
        if (!known) end_at(slip_leaves(own.joint, half), static_cast<int>(Motion::stuck));
        if (known && moves_to != Motion::stuck && moves_to != slides_to) end_at(-1, static_cast<int>(Motion::stuck));
        return;
    }
    const double rounded = own.stiffness * 2 * segment_.h * uncertain(own.joint);
    for (const Motion way : {Motion::forward, Motion::backward}) {
        if (known && way != moves_to) continue;
        const auto left = [&](const Moment& at) {
            return own.limit - model::sign_of(way) * own.stiffness * at.y[own.bend];
        };
        end_at(leaves(segment_.at_nodes(left, point_), left, half, rounded), static_cast<int>(way));
    }
}

/// Watches whether the speed leaves the present range of the friction law.
void Guards::watch_corner(std::size_t joint) {
    const Joint& own = mechanics_.system().joints[joint];
    const model::Friction& law = own.friction.law;
    const Slipping& how = now_.mode.friction[joint];
    if (!slides(joint) || law.ranges() < 2 || own.friction.function != nullptr || now_.mode.leans[joint] != 0) return;
    const model::SpeedRange range = law.range(how.range);
    const double sign = model::sign_of(how.way);
    Series series = cheb::fit(mechanics_.slips(joint, segment_.y, segment_.belts[joint]));
    for (double& c : series) c *= sign;
    for (const int side : {1, -1}) {
        const double corner = side > 0 ? range.to : range.from;
        if (!(corner > 0 && corner < model::never)) continue;
        Series left = series;
        for (double& c : left) c *= -side;
        left[0] += side * corner;
        const bool there = parts_.contacts.of[joint].edge == side;
        watch(left, 16 * rounding * fastest(joint), there, side);
    }
}

/// Returns the point at which the slip of a joint leaves this half.
std::optional<double> Guards::slip_leaves(std::size_t joint, Half& half) {
    const auto slip = [&](const Moment& at) {
        return mechanics_.velocity(joint, at.y) - mechanics_.belt(joint, at.t, at.side);
    };
    return leaves(mechanics_.slips(joint, segment_.y, segment_.belts[joint]), slip, half, uncertain(joint));
}

/// Ends the stretch at slip 0, where the rate of bristles has a corner.
void Guards::watch_bristles(std::size_t joint) {
    if (mechanics_.bristle(joint) == nullptr) return;
    Half& half = parts_.contacts.of[joint].bristle_sign;
    const auto x = slip_leaves(joint, half);
    if (x && *x <= -1) {
        half = -half;
    } else {
        end_at(x, -half);
    }
}

/// Ends the stretch where the normal load crosses zero, because negative loads count as zero.
void Guards::watch_normal(std::size_t joint) {
    if (!mechanics_.has_normal(joint) && (!mechanics_.may_open(joint) || now_.rubs(joint))) return;
    const auto pressing = [&](const Moment& at) { return mechanics_.pressing(joint, at); };
    const Nodes values = segment_.at_nodes(pressing, point_);
    if (mechanics_.rubs(joint) && !now_.rubs(joint)) {
        // The contact is open at the start, where the load may be rounding or 0 for some time.
        const auto* const presses = std::find_if(values.begin() + 1, values.end(), [](double N) { return N > 0; });
        if (presses == values.end()) return;
        const auto exact = segment_.function_of_x(pressing, point_);
        const double x = first_true([&](double place) { return exact(place) > 0; },
                                    cheb::nodes[static_cast<std::size_t>(presses - values.begin())]);
        // A load that is only rounding at the time at which it opened the contact does not close it.
        constexpr double clearly = 1e-9;
        if (segment_.time(x) > now_.t.hi || values[0] > clearly * greatest(values)) end_at(x);
        return;
    }
    Half& half = parts_.contacts.of[joint].load_sign;
    const auto x = leaves(values, pressing, half);
    end_at(x, -half);
}

/// Returns the point at which an angle, velocity or state reaches a relay's level.
std::optional<double> Guards::switches(double sign, double level, std::size_t k) const {
    Nodes values = segment_.y[k];
    Series series = segment_.series[k];
    series[0] += values[0] - level;
    for (double& each : values) each = sign * (each - level);
    for (double& each : series) each *= sign;
    if (stays_above_zero(1, series, std::fabs(level))) return {};
    const auto exact = [&](double x) { return sign * (segment_.at(k, x) - level); };
    Half half = 1;
    return values[0] < 0 ? -1 : Watched(values, exact, 0, series).leaves(half, -1);
}

void Guards::watch_relays(std::size_t load) {
    const Signal& of = mechanics_.loads()[load];
    for (std::size_t r = 0; r < of.relays(); ++r) {
        if (const auto at = of.switching(r); at.place) {
            end_at(switches(at.sign, at.level, *at.place), static_cast<int>(r));
            continue;
        }
        const auto left = [&](const Moment& at) { return of.until_switch(r, at); };
        Nodes values = segment_.at_nodes(left, point_);
        // Where the function jumps past both thresholds, the rounding of the start must not switch it back.
        if (values[0] < 0) values[0] = segment_.function_of_x(left, point_)(soon(segment_));
        Half half = 1;
        end_at(values[0] < 0 ? -1 : leaves(values, left, half), static_cast<int>(r));
    }
}

void Guards::watch_conditions(std::size_t /*motion*/) {
    if (parts_.conditions.any()) parts_.conditions.watch(segment_, now_.y, now_.t.hi, ending_);
}

void Guards::watch_users(std::size_t /*motion*/) {
    const UserEvents::Seen seen = parts_.users.watch(segment_, ending_);
    good_ = good_ && seen.good;
    thrown_back_ = seen.again;
}

}  // namespace dinal::motion::engine
