#include "analysis/short_slides.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/forced_search.hpp"

namespace dinal::analysis {
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

/// Released from -y, the mass advances beyond 0. The derivative is the fraction of a shift that remains, with the sign
/// of the opposite place.
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

/// The fraction of a shift of the start that decays within x of free motion, which is the response to a constant load
/// of 1.
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
