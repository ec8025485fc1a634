#include "analysis/single_sine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "analysis/forced_search.hpp"
#include "model/lowered.hpp"
#include "motion/complex_product.hpp"
#include "theory/forced.hpp"

namespace dinal::analysis {

std::optional<SingleSine> single_sine(const SteadyQuestion& question) {
    const auto components = question.drive.M().components();
    const model::Oscillator& system = question.body;
    if (components.size() != 1 || !system.has_linear_spring() || system.walls()) return {};
    const model::Component& only = components.front();
    const auto* sine = std::get_if<model::Harmonic>(&only.term);
    if (sine == nullptr || std::isfinite(only.from) || std::isfinite(only.to)) return {};
    const model::Lowered lowered(system);
    const double Rd = lowered.braking(model::Motion::forward), Re = lowered.holding(model::Motion::forward);
    const bool even = Rd == -lowered.braking(model::Motion::backward) && Re == lowered.holding(model::Motion::backward);
    const double load = only.gain * sine->amplitude, M0 = std::fabs(load);
    SingleSine own{.zeta = system.damping_ratio(), .omega0 = system.natural_frequency()};
    own.r = sine->omega / own.omega0;
    if (!(M0 > 0) || !even || lowered.has_remainder() || !(own.r > theory::DenHartog::slowest) ||
        !(own.r < theory::DenHartog::fastest)) {
        return {};
    }
    own.sliding = Rd / M0, own.holding = Re / M0;
    own.spare = (M0 - Re) / M0;
    own.unit = M0 / system.stiffness();
    own.phase = sine->angle(question.repeats.start) + (load < 0 ? std::numbers::pi : 0);
    return own;
}

namespace {

using motion::product;

std::complex<double> phasor(double angle) {
    return {std::cos(angle), std::sin(angle)};
}

/// Slides of a SingleSine between standstills.
class SineArcs {
public:
    /// Requires that applies_to() is true.
    explicit SineArcs(const SingleSine& sine)
        : sine_(sine),
          root_(-sine.zeta, theory::Modes(sine.zeta).rate()),
          step_(0.3 * std::min(1.0, 1 / sine.r)),
          forced_turn_(phasor(sine.r * step_)),
          free_turn_(std::exp(-sine.zeta * step_) * phasor(root_.imag() * step_)),
          answer_(theory::magnification(sine.r, sine.zeta) * phasor(-theory::phase_lag(sine.r, sine.zeta))) {}
    static bool applies_to(const SingleSine& sine) {
        constexpr double most_damping = 0.99, resonant = 1e-6;  // beyond these, other closed forms would be needed
        return sine.zeta < most_damping && (sine.zeta > resonant || std::fabs(sine.r - 1) > resonant);
    }

    /// Starts from velocity 0 at this place and phase of the load; way is +1 or -1.
    void leave(double phase, double y, double way) {
        way_ = way;
        forced_ = product(answer_, phasor(phase));
        const double apart = y - (forced_.imag() - way * sine_.sliding), slower = -sine_.r * forced_.real();
        free_ = {apart, -(slower + sine_.zeta * apart) / root_.imag()};
    }

    struct Sliding {
        theory::Motion2 motion;
        double slope;  ///< slope of the velocity
    };
    Sliding at(double x) const {
        const Complex load = product(forced_, phasor(sine_.r * x));
        const Complex own = product(free_, std::exp(root_.real() * x) * phasor(root_.imag() * x));
        const Complex rate = product(root_, own);
        return {{load.imag() + own.real() - way_ * sine_.sliding, sine_.r * load.real() + rate.real()},
                -sine_.r * sine_.r * load.imag() + product(root_, rate).real()};
    }

    /// The time until the velocity is zero; empty if the slide does not start, or takes longer than `most` (in x).
    std::optional<double> first_zero(double most) const {
        Complex load = forced_, own = free_;
        double before = 0, v_before = 0;
        for (int i = 1; before < most; ++i) {
            load = product(load, forced_turn_);
            own = product(own, free_turn_);
            const double x = i * step_;
            const double v = way_ * (sine_.r * load.real() + root_.real() * own.real() - root_.imag() * own.imag());
            if (!(v > 0)) {
                constexpr int finer = 5;
                double part = x;
                for (int j = 0; before == 0 && j < finer; ++j) {
                    part /= 4;
                    v_before = way_ * at(part).motion.dy;
                    if (v_before > 0) before = part;
                }
                if (before == 0) return {};
                return zero_between(before, x, before + (x - before) * (v_before / (v_before - v)));
            }
            before = x, v_before = v;
        }
        return {};
    }

private:
    using Complex = std::complex<double>;

    /// Newton's method between a point of the slide and one after its end.
    double zero_between(double from, double to, double x) const {
        constexpr int most_steps = 60;
        constexpr double nearly = 1e-6;  // the next step reduces the error to rounding
        const auto newton = [](double x0, const Sliding& now) { return x0 - now.motion.dy / now.slope; };
        for (int i = 0; i < most_steps; ++i) {
            const Sliding now = at(x);
            (way_ * now.motion.dy > 0 ? from : to) = x;
            double next = newton(x, now);
            if (!(next > from && next < to)) next = (from + to) / 2;
            const double moved = std::fabs(next - x);
            x = next;
            if (moved <= nearly * x) return newton(x, at(x));
        }
        return x;
    }

    SingleSine sine_;
    Complex root_;                     // root of the free motion, -zeta + iq
    double step_;                      // step of the search
    Complex forced_turn_, free_turn_;  // factors for one step
    Complex answer_;                   // response to the load
    double way_ = 1;
    Complex forced_ = 0, free_ = 0;  // at the start: y = Im forced + Re free - way Rd/M0
};

/// The start from Den Hartog's closed form of a motion without stops; none if a quick check shows that it would stop.
std::optional<model::State> sliding_start(const SingleSine& sine) {
    const double r = sine.r, half = half_load / r;
    const auto motion = theory::DenHartog(r, sine.zeta).without_stops(sine.sliding);
    if (!motion || !(motion->amplitude > 0)) return {};
    // The load is greatest at the phase pi/2, theta later by its lag; half a period later the motion is opposite.
    const double crest = half_load / 2 + motion->lag;
    if (sine.sliding > 0 && SineArcs::applies_to(sine)) {
        SineArcs slide(sine);
        slide.leave(crest, motion->amplitude, -1);
        constexpr double nearly = 1e-6;  // a stop just before the turn is left to the search
        const auto end = slide.first_zero(half * (1 + nearly));
        if (!end || *end < half * (1 - nearly)) return {};
    }
    const double phase = sine.phase - crest;
    const double halves = std::floor(phase / half_load);
    const double since = (phase / half_load - halves) * half;  // since the last turn
    const double sign = std::fmod(halves, 2) == 0 ? 1 : -1;
    const double phi = theory::magnification(r, sine.zeta), lag = theory::phase_lag(r, sine.zeta);
    const auto forced = [&](double x) {
        const double angle = r * x + crest - lag;
        return theory::Motion2{phi * std::sin(angle), phi * r * std::cos(angle)};
    };
    const theory::Motion2 at_turn = forced(0), now = forced(since);
    const theory::Motion2 free = theory::free_motion(
        theory::Modes(sine.zeta), {motion->amplitude - at_turn.y - sine.sliding, -at_turn.dy}, since);
    const model::State start = sine.state({sign * (now.y + sine.sliding + free.y), sign * (now.dy + free.dy)});
    if (!std::isfinite(start.theta) || !std::isfinite(start.velocity)) return {};
    return start;
}

/// The first of the phases base + 2 pi n at or after `now`.
double next_of(double base, double now) {
    return base + 2 * half_load * std::ceil((now - base) / (2 * half_load));
}

/// Finds a motion with stops. It is determined by the place of rest: a root of off().
class StoppingSearch {
public:
    explicit StoppingSearch(const SingleSine& sine) : sine_(sine), arcs_(sine) {}

    std::optional<model::State> found() {
        constexpr std::size_t most = 24;
        std::array<Stick, most> sticks{};
        const auto first = released_from(0);
        if (!first) return {};
        sticks[0] = *first;
        for (std::size_t i = 1; i < most; ++i) {
            const auto next = this->next(sticks[i - 1]);
            if (!next) return {};
            sticks[i] = *next;
            for (std::size_t n = 1; n <= i; ++n) {
                const Stick &a = sticks[i - n], &b = sticks[i];
                constexpr double secant_range = 0.3;  // close enough for the secant method
                if (a.way == b.way || !(std::fabs(b.release - a.release - half_load) < secant_range)) continue;
                if (const auto y = place_of_rest(a, b, n)) return at_start(*y, n);
                break;
            }
        }
        return {};
    }

private:
    /// A mass at rest that is released when the load reaches the phase `release`.
    struct Stick {
        double y = 0, release = 0;
        double way = 1;  ///< direction of the release
    };

    /// The release forward from y; empty if the load is too small.
    std::optional<Stick> released_from(double y) const {
        const double needed = y + sine_.holding;
        if (!(std::fabs(needed) < 1)) return {};
        return Stick{y, std::asin(needed), 1};
    }

    /// The next place of rest; empty if the mass slides for three periods.
    std::optional<Stick> next(const Stick& from) {
        double phase = from.release, y = from.y, way = from.way;
        const double latest = phase + 6 * half_load;
        while (phase < latest) {
            arcs_.leave(phase, y, way);
            const auto slide = arcs_.first_zero((latest - phase) / sine_.r);
            if (!slide) return {};
            const double end = phase + sine_.r * *slide;
            if (wanted_ >= phase && wanted_ <= end) found_ = arcs_.at((wanted_ - phase) / sine_.r).motion;
            y = arcs_.at(*slide).motion.y;
            const double pull = std::sin(end) - y;
            if (std::fabs(pull) <= sine_.holding) return at_rest(y, end);
            phase = end;
            way = pull > 0 ? 1 : -1;
        }
        return {};
    }

    std::optional<Stick> at_rest(double y, double since) {
        const double up = y + sine_.holding, down = y - sine_.holding;
        constexpr double never = 1e300;
        const double forward = up < 1 ? next_of(std::asin(std::max(up, -1.0)), since) : never;
        const double backward = down > -1 ? next_of(half_load - std::asin(std::min(down, 1.0)), since) : never;
        const Stick stick{y, std::min(forward, backward), forward < backward ? 1.0 : -1.0};
        if (wanted_ >= since && wanted_ <= stick.release) found_ = theory::Motion2{y, 0};
        return stick.release < never ? std::optional(stick) : std::nullopt;
    }

    /// The deviation of the place of rest n stops later from the opposite one; empty unless that is half a period
    /// later.
    std::optional<double> off(double y, std::size_t n) {
        auto stick = released_from(y);
        const double begin = stick ? stick->release : 0;
        for (std::size_t i = 0; i < n && stick; ++i) stick = next(*stick);
        if (!stick || stick->way > 0 || !(std::fabs(stick->release - begin - half_load) < 1)) return {};
        return -stick->y - y;
    }

    /// Finds the root of off() by secants; empty if the search is slow. The last step is not checked, as its error is a
    /// product of the last two residuals, and callers prove the result.
    std::optional<double> place_of_rest(const Stick& a, const Stick& b, std::size_t n) {
        constexpr double rounding = 1e-17;
        constexpr int most = 12;
        double y0 = a.way * a.y, off0 = b.way * b.y - y0;
        double y1 = y0 + off0;
        for (int i = 0; i < most; ++i) {
            const auto off1 = off(y1, n);
            if (!off1) return {};
            const double y2 = *off1 == off0 ? y1 : y1 - *off1 * (y1 - y0) / (*off1 - off0);
            if (std::fabs(*off1 * off0) <= rounding) return y2;
            y0 = y1, off0 = *off1, y1 = y2;
        }
        return {};
    }

    /// The state at the phase with which the drive starts.
    std::optional<model::State> at_start(double y, std::size_t n) {
        auto stick = released_from(y);
        if (!stick) return {};
        const double halves = std::floor((sine_.phase - stick->release) / half_load);
        const double sign = std::fmod(halves, 2) == 0 ? 1 : -1;
        wanted_ = sine_.phase - halves * half_load;
        for (std::size_t i = 0; i < n && stick; ++i) stick = next(*stick);
        if (!found_) return {};
        return sine_.state({sign * found_->y, sign * found_->dy});
    }

    SingleSine sine_;
    SineArcs arcs_;
    double wanted_ = -1e300;                // a phase of the load
    std::optional<theory::Motion2> found_;  // the state there, set when next() passes it
};

}  // namespace

std::optional<model::State> sine_start(const SingleSine& sine) {
    if (const auto start = sliding_start(sine)) return start;
    if (!SineArcs::applies_to(sine) || !(sine.holding > 0)) return {};
    return StoppingSearch(sine).found();
}

namespace {

constexpr double longest_slide = 3;  // in the shortest time scale: costs e^3 of the accuracy

}  // namespace

std::optional<ShortSlides> ShortSlides::closed(const SteadyQuestion& question) {
    const auto sine = single_sine(question);
    if (!sine || sine->holding != sine->sliding || !(sine->spare > 0)) return {};
    const double turns = sine->r * sine->omega0 * question.repeats.period / (2 * half_load);
    constexpr double rounding_of_turns = 1e-12;
    if (std::fabs(turns - 1) > rounding_of_turns) return {};
    ShortSlides slides(*sine);
    if (!slides.slide(0)) return {};
    slides.unit_ = slides.way(slides.end_) / 2;
    int maps = 0;
    const Return first{.to = Eigen::VectorXd::Ones(1), .finished = true};
    const auto found = ClosedSearch(slides, maps, 1).at_once(first, 1, true);
    if (!found || !slides.slide(slides.unit_ * found->x[0]) || !(slides.rest_ > 0)) return {};
    const double pull = std::sin(slides.release_ + sine->r * slides.end_) - slides.rest_;
    return std::fabs(pull) <= sine->holding ? std::optional(slides) : std::nullopt;
}

bool ShortSlides::slide(double rest) {
    rest_ = rest;
    return rest >= 0 && start(sine_.spare + rest) && find_end();
}

/// A mass released from -y advances beyond 0. The derivative is the fraction of a shift that remains, with the sign of
/// the opposite place.
Map::Return ShortSlides::operator()(const Eigen::VectorXd& from, const std::optional<HeldMode>& /*mode*/,
                                    int /*returns*/) {
    Return back{.to = from};
    back.finished = slide(unit_ * from[0]);
    if (!back.finished) return back;
    back.to[0] = way(end_) / unit_ - from[0];
    back.derivative = Eigen::MatrixXd::Constant(1, 1, forgets(end_) - 1);
    return back;
}

std::vector<std::complex<double>> ShortSlides::multipliers() const {
    const double kept = 1 - forgets(end_);
    return {kept * kept, 0};
}

/// Begins a slide from a place where the crest of the load exceeds the holding torque by `spare`. The release is d of
/// phase before the crest, where the load is cos d; x later it is cos d cos rx + sin d sin rx. Returns false if the
/// slide is not short.
bool ShortSlides::start(double spare) {
    const double d = 2 * std::asin(std::sqrt(spare / 2)), r = sine_.r;
    release_ = half_load / 2 - d;
    end_ = 3 * std::tan(d) / r;  // zero of the first two terms of the speed
    if (!is_short()) return false;
    const std::array<double, 4> turn{std::cos(d), std::sin(d), -std::cos(d), -std::sin(d)};
    double power = 1;
    series_[0] = series_[1] = 0;
    for (std::size_t n = 0; n + 2 < terms; ++n) {
        const auto number = static_cast<double>(n);
        if (n > 0) power *= r / number;
        const double load = n == 0 ? 0 : power * turn[n % 4];
        series_[n + 2] =
            (load - 2 * sine_.zeta * (number + 1) * series_[n + 1] - series_[n]) / ((number + 1) * (number + 2));
        speed_[n + 2] = (number + 2) * series_[n + 2];
    }
    return true;
}

bool ShortSlides::is_short() const {
    return end_ > 0 && end_ * std::max({1.0, sine_.r, 2 * sine_.zeta}) <= longest_slide;
}

/// Finds the end of the slide. The speed begins with x squared, so it is divided by that.
bool ShortSlides::find_end() {
    constexpr int most_steps = 40;
    double before = 0.9 * end_, value_before = speed_by_square(before);
    for (int i = 0; i < most_steps && is_short(); ++i) {
        const double value = speed_by_square(end_);
        if (value == value_before) return value == 0;
        const double step = value * (end_ - before) / (value - value_before);
        before = end_, value_before = value;
        end_ -= step;
        constexpr double nearly = 1e-15;
        if (std::fabs(step) <= nearly * end_) return is_short();
    }
    return false;
}

double ShortSlides::way(double x) const {
    double sum = 0;
    for (std::size_t n = terms; n-- > 0;) sum = sum * x + series_[n];
    return sum;
}

double ShortSlides::speed_by_square(double x) const {
    double sum = 0;
    for (std::size_t n = terms; n-- > 3;) sum = sum * x + speed_[n];
    return sum;
}

/// The fraction of a shift of the start that decays within x of free motion: the response to a constant load of 1.
double ShortSlides::forgets(double x) const {
    double before = 0, now = 0, sum = 0, power = 1;  // terms n and n + 1 of the series, and x^n
    for (std::size_t n = 0; n + 2 < terms; ++n) {
        const auto number = static_cast<double>(n);
        const double next =
            ((n == 0 ? 1 : 0) - 2 * sine_.zeta * (number + 1) * now - before) / ((number + 1) * (number + 2));
        power *= n == 0 ? x * x : x;
        sum += next * power;
        before = now, now = next;
    }
    return sum;
}

SteadyMotion ShortSlides::motion(const SteadyQuestion& question) const {
    const double halves = std::floor((sine_.phase - release_) / half_load);
    const double since = (sine_.phase - release_ - halves * half_load) / sine_.r;
    const double sign = std::fmod(halves, 2) == 0 ? 1 : -1;
    const bool slides = since < end_;
    SteadyMotion motion;
    motion.status = SteadyStatus::steady;
    motion.period = question.repeats.period;
    motion.start = sine_.state(
        {sign * (slides ? way(since) - rest_ : rest_), slides ? sign * speed_by_square(since) * since * since : 0.0});
    motion.amplitude = motion.high = sine_.unit * rest_;
    motion.low = -motion.high;
    const double stop = release_ + sine_.r * end_;
    motion.t_high = question.repeats.start + (stop - sine_.phase) / (sine_.r * sine_.omega0);
    motion.stops = 2;
    motion.stuck = 1 - sine_.r * end_ / half_load;
    motion.symmetric = true;
    return motion;
}

/// Integrates by parts: the speed is nonzero only in two opposite slides half a period apart.
std::complex<double> ShortSlides::fundamental() const {
    std::array<std::complex<double>, terms> wave{1.0};  // e^(-i r x)
    for (std::size_t n = 1; n < terms; ++n) {
        wave[n] = wave[n - 1] * std::complex<double>(0, -sine_.r / static_cast<double>(n));
    }
    std::complex<double> sum;
    double power = end_;
    for (std::size_t n = 0; n + 1 < terms; ++n) {
        std::complex<double> product;
        for (std::size_t m = 0; m <= n; ++m) product += static_cast<double>(m + 1) * series_[m + 1] * wave[n - m];
        sum += product * (power / static_cast<double>(n + 1));
        power *= end_;
    }
    return sine_.unit * std::complex<double>(0, -2 / half_load) * std::polar(1.0, sine_.phase - release_) * sum;
}

}  // namespace dinal::analysis
