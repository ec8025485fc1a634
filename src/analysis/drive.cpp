#include "analysis/drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "model/forcing.hpp"

namespace dinal::analysis {
namespace {

constexpr double golden = 0.6180339887498949;  // multiples of it, less their whole parts, fill a period evenly

/// The i-th of times that are spread over the period.
double probe(const Drive& drive, int i) {
    const double place = (i + 0.5) * golden;
    return drive.start + drive.period * (place - std::floor(place));
}

/// Times all over the period, and some within each piece of half a period in which neither M nor what it is half a
/// period later breaks: a difference as short as that piece is seen. None where there are too many pieces to look at.
std::optional<std::vector<double>> probes_of_halves(const model::Excitation& excitation, const Drive& drive) {
    constexpr int spread = 24;
    constexpr std::size_t most_breaks = 20000;
    std::vector<double> times(spread);
    for (int i = 0; i < spread; ++i) times[static_cast<std::size_t>(i)] = probe(drive, i);
    const double half = drive.period / 2;
    std::vector<double> breaks{0, half};
    double t = excitation.next_break(drive.start);
    while (t < drive.start + drive.period) {
        const double since = t - drive.start;
        breaks.push_back(since < half ? since : since - half);
        if (breaks.size() > most_breaks) return {};
        t = excitation.next_break(t);
    }
    if (breaks.size() == 2) return times;
    std::sort(breaks.begin(), breaks.end());
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const double length = breaks[i + 1] - breaks[i];
        constexpr double rounding = 1e-12;
        if (!(length > rounding * (std::fabs(drive.start) + drive.period))) continue;
        for (const double part : {0.21, 0.5, 0.83}) times.push_back(drive.start + breaks[i] + part * length);
    }
    return times;
}

/// The extreme of sign * M near the middle one of three times, which has the greatest value of them.
double refined(const model::Excitation& excitation, double sign, double a, double b) {
    for (int i = 0; i < 60 && b - a > 1e-9 * (std::fabs(a) + b - a); ++i) {
        const double x = b - golden * (b - a), y = a + golden * (b - a);
        sign* excitation.value(x) > sign* excitation.value(y) ? b = y : a = x;
    }
    return sign * excitation.value((a + b) / 2);
}

/// The number of the harmonic of the period that a component is, where it is one sine for all times.
std::optional<double> harmonic_number(const model::Component& component, const Drive& drive) {
    const auto* sine = std::get_if<model::Harmonic>(&component.term);
    if (sine == nullptr || std::isfinite(component.from) || std::isfinite(component.to)) return {};
    const double number = sine->omega * drive.period / (2 * std::numbers::pi), whole = std::round(number);
    if (std::fabs(number - whole) > 1e-12 * std::max(1.0, whole)) return {};
    return whole;
}

bool is_odd(double whole) {
    return std::fmod(whole, 2) != 0;
}

/// Of one sine and nothing else.
std::optional<DriveRange> extremes_of_sine(const model::Excitation& excitation, const Drive& drive) {
    double swing = 0;
    int sines = 0;
    for (const model::Component& c : excitation.components()) {
        const auto number = harmonic_number(c, drive);
        if (!number || *number == 0) return {};
        swing = std::fabs(c.gain * std::get<model::Harmonic>(c.term).amplitude);
        ++sines;
    }
    return sines == 1 ? std::optional(DriveRange{-swing, swing}) : std::nullopt;
}

}  // namespace

std::optional<Drive> drive_of(const model::Excitation& excitation, double otherwise) {
    double from = 0;
    if (excitation.constant_from() <= from) return Drive{from, otherwise};
    if (const double period = model::period_from(excitation, from); period > 0) return Drive{from, period};
    for (const model::Component& c : excitation.components()) {
        for (const double t : {c.from, model::constant_from(c)}) {
            if (std::isfinite(t)) from = std::max(from, t);
        }
    }
    if (excitation.constant_from() <= from) return Drive{from, otherwise};
    if (const double period = model::period_from(excitation, from); period > 0) return Drive{from, period};
    return {};
}

std::optional<text::Error> not_periodic(const model::Excitation& excitation, const Drive& drive) {
    constexpr int probes = 50;
    constexpr double allowed = 1e-9;
    double worst = 0, at = 0, most = 0;
    for (int i = 0; i < probes; ++i) {
        const double t = probe(drive, i);
        const model::State y{0.1 * (i % 5), 0.1 * (i % 3)};
        const double now = excitation.value(t, y), later = excitation.value(t + drive.period, y);
        if (!std::isfinite(now) || !std::isfinite(later)) return {};  // the runs will tell
        most = std::max({most, std::fabs(now), std::fabs(later)});
        if (std::fabs(now - later) > worst) {
            worst = std::fabs(now - later);
            at = t;
        }
    }
    if (!(worst > allowed * most)) return {};
    const double later = at + drive.period;
    return text::Error{
        .sentence = fmt::format("M does not repeat itself after period = {:.10g}: M({:.6g}) = {:.6g}, but "
                                "M({:.6g}) = {:.6g}",
                                drive.period, at, excitation.value(at), later, excitation.value(later)),
        .option = "period"};
}

bool is_antisymmetric(const model::Excitation& excitation, const Drive& drive) {
    const auto components = excitation.components();
    if (std::all_of(components.begin(), components.end(), [&](const model::Component& c) {
            const auto number = harmonic_number(c, drive);
            return number && is_odd(*number);
        })) {
        return true;
    }
    const auto times = probes_of_halves(excitation, drive);
    if (!times) return false;
    double greatest = 0, worst = 0;
    for (std::size_t j = 0; j < times->size(); ++j) {
        const double t = (*times)[j];
        const int i = static_cast<int>(j % 35);
        const model::State y{0.13 * (i % 5 - 2), 0.17 * (i % 7 - 3)}, opposite{-y.theta, -y.velocity};
        const double now = excitation.value(t, y), half = excitation.value(t + drive.period / 2, opposite);
        if (!std::isfinite(now) || !std::isfinite(half)) return false;
        const double size = std::fabs(now) + std::fabs(half);
        greatest = std::max(greatest, size);
        worst = std::max(worst, std::fabs(now + half) - 1e-12 * size);
    }
    // Terms that cancel leave the rounding of the greatest; of a function only its values are known.
    const double most = excitation.most();
    return worst <= 1e-13 * (std::isfinite(most) ? most : greatest);
}

std::complex<double> harmonic_of(const model::Excitation& excitation, const Drive& drive, double n) {
    const double omega = 2 * std::numbers::pi * n / drive.period;
    const auto components = excitation.components();
    // a sin(w t + p) = a cos(w t + p - pi/2): the sum of those of this number.
    std::complex<double> known;
    const bool sines = std::all_of(components.begin(), components.end(), [&](const model::Component& c) {
        const auto number = harmonic_number(c, drive);
        if (number == n && n > 0) {
            const auto& sine = std::get<model::Harmonic>(c.term);
            known += std::polar(1.0, sine.omega * drive.start + sine.phase - std::numbers::pi / 2) *
                     (c.gain * sine.amplitude);
        }
        return number.has_value() && n > 0;
    });
    if (sines) return known;
    const auto sum = integral(excitation, drive.start, drive.start + drive.period, drive.period / 64, [&](double t) {
        return excitation.value(t) * std::polar(1.0, -omega * (t - drive.start));
    });
    return sum * (2 / drive.period);
}

DriveRange extremes(const model::Excitation& excitation, const Drive& drive) {
    if (const auto sine = extremes_of_sine(excitation, drive)) return *sine;
    constexpr int pieces = 512;
    const double end = drive.start + drive.period, h = drive.period / pieces;
    DriveRange range{excitation.value(drive.start), excitation.value(drive.start)};
    const auto see = [&range](double value) {
        range.low = std::min(range.low, value);
        range.high = std::max(range.high, value);
    };
    double jump = excitation.next_break(drive.start);
    const double behind_end = end + 1e-12 * (std::fabs(end) + drive.period);  // where a period ends it may jump, too
    while (jump < behind_end) {
        see(excitation.value(jump));
        see(excitation.value_before(jump));
        jump = excitation.next_break(jump);
    }
    double before = excitation.value(drive.start - h), now = excitation.value(drive.start);
    for (int i = 0; i < pieces; ++i) {
        const double t = drive.start + i * h, next = excitation.value(t + h);
        see(now);
        if (now >= before && now >= next && now > range.high - 1e-3 * (range.high - range.low)) {
            see(refined(excitation, 1, t - h, t + h));
        }
        if (now <= before && now <= next && now < range.low + 1e-3 * (range.high - range.low)) {
            see(-refined(excitation, -1, t - h, t + h));
        }
        before = now;
        now = next;
    }
    return range;
}

}  // namespace dinal::analysis
