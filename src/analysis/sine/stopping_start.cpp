#include "analysis/sine/stopping_start.hpp"

#include <array>
#include <cmath>

#include "analysis/sine/sine_arcs.hpp"

namespace dinal::analysis::sine {
namespace {

/// At rest, and released when the load has reached this phase.
struct Stick {
    double y = 0, release = 0;
    double way = 1;  ///< of the release
};

/// The first of the phases base, base + 2 pi, ... and base - 2 pi, ... that is not before `now`.
double next_of(double base, double now) {
    return base + 2 * half_load * std::ceil((now - base) / (2 * half_load));
}

class StickToStick {
public:
    explicit StickToStick(const SingleSine& sine) : sine_(sine), arcs_(sine) {}

    /// Released forward from here; none where the load cannot do that.
    [[nodiscard]] std::optional<Stick> released_from(double y) const {
        const double needed = y + sine_.holding;
        if (!(std::fabs(needed) < 1)) return {};
        return Stick{y, std::asin(needed), 1};
    }

    /// The next place of rest; none when it has slid for three periods.
    std::optional<Stick> next(const Stick& from) {
        double phase = from.release, y = from.y, way = from.way;
        const double latest = phase + 6 * half_load;
        while (phase < latest) {
            arcs_.leave(phase, y, way);
            const auto slide = arcs_.first_zero((latest - phase) / sine_.r);
            if (!slide) return {};
            const double end = phase + sine_.r * *slide;
            if (wanted_ >= phase && wanted_ <= end) found_ = arcs_.at((wanted_ - phase) / sine_.r);
            y = arcs_.at(*slide).y;
            const double pull = std::sin(end) - y;
            if (std::fabs(pull) <= sine_.holding) return at_rest(y, end);
            phase = end;
            way = pull > 0 ? 1 : -1;
        }
        return {};
    }

    /// Where it is at this phase, while next() passes it.
    void look_out(double phase) { wanted_ = phase; }
    [[nodiscard]] const std::optional<theory::Motion2>& found() const { return found_; }

private:
    std::optional<Stick> at_rest(double y, double since) {
        const double up = y + sine_.holding, down = y - sine_.holding;
        constexpr double never = 1e300;
        const double forward = up < 1 ? next_of(std::asin(std::max(up, -1.0)), since) : never;
        const double backward = down > -1 ? next_of(half_load - std::asin(std::min(down, 1.0)), since) : never;
        const Stick stick{y, std::min(forward, backward), forward < backward ? 1.0 : -1.0};
        if (wanted_ >= since && wanted_ <= stick.release) found_ = theory::Motion2{y, 0};
        return stick.release < never ? std::optional(stick) : std::nullopt;
    }

    SingleSine sine_;
    SineArcs arcs_;
    double wanted_ = -1e300;
    std::optional<theory::Motion2> found_;
};

class StoppingSearch {
public:
    explicit StoppingSearch(const SingleSine& sine) : sine_(sine), motion_(sine) {}

    std::optional<model::State> found() {
        constexpr std::size_t most = 24;
        std::array<Stick, most> sticks{};
        const auto first = motion_.released_from(0);
        if (!first) return {};
        sticks[0] = *first;
        for (std::size_t i = 1; i < most; ++i) {
            const auto next = motion_.next(sticks[i - 1]);
            if (!next) return {};
            sticks[i] = *next;
            for (std::size_t n = 1; n <= i; ++n) {
                if (!are_half_a_period_apart(sticks[i - n], sticks[i])) continue;
                if (const auto y = place_of_rest(sticks[i - n], sticks[i], n)) return at_start(*y, n);
                break;
            }
        }
        return {};
    }

private:
    [[nodiscard]] static bool are_half_a_period_apart(const Stick& a, const Stick& b) {
        constexpr double about = 0.3;  // the secants lead on from there
        return a.way != b.way && std::fabs(b.release - a.release - half_load) < about;
    }

    /// By how much it is off half a period later, n stops on, less the sign.
    std::optional<double> off(double y, std::size_t n) {
        auto stick = motion_.released_from(y);
        const double begin = stick ? stick->release : 0;
        for (std::size_t i = 0; i < n && stick; ++i) stick = motion_.next(*stick);
        if (!stick || stick->way > 0 || !(std::fabs(stick->release - begin - half_load) < 1)) return {};
        return -stick->y - y;
    }

    /// The root of off(), by secants, the last of which need not be looked at: what it leaves is a product of what the
    /// last two were off. All is proven by others, so that a slow search is left to them.
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

    /// The motion from rest to rest at the phase that the drive starts with.
    std::optional<model::State> at_start(double y, std::size_t n) {
        auto stick = motion_.released_from(y);
        if (!stick) return {};
        const double halves = std::floor((sine_.phase - stick->release) / half_load);
        const double sign = std::fmod(halves, 2) == 0 ? 1 : -1;
        motion_.look_out(sine_.phase - halves * half_load);
        for (std::size_t i = 0; i < n && stick; ++i) stick = motion_.next(*stick);
        if (!motion_.found()) return {};
        return sine_.state({sign * motion_.found()->y, sign * motion_.found()->dy});
    }

    SingleSine sine_;
    StickToStick motion_;
};

}  // namespace

std::optional<model::State> stopping_start(const SingleSine& sine) {
    if (!SineArcs::applies_to(sine) || !(sine.holding > 0)) return {};
    return StoppingSearch(sine).found();
}

}  // namespace dinal::analysis::sine
