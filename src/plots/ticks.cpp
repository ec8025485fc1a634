#include "plots/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dinal::plots {
namespace {

constexpr int most_digits = 6;  // digits of a label; longer ones use another notation
constexpr double most_divisions = 1000;

/// The decimal exponent, 3 for 1000 to 9999; from the text, because log10(1000) may round to 2.999...
int exponent_of(double value) {
    const std::string text = fmt::format("{:.0e}", value);
    return std::stoi(text.substr(text.find('e') + 1));
}

/// The smallest 1, 2 or 5 times a power of ten that is at least `least`.
double round_step(double least) {
    const int exponent = exponent_of(least) - 1;
    for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0}) {
        const double step = factor * std::pow(10.0, exponent);
        if (step >= least * (1 - 1e-9)) {
            return step;
        }
    }
    return least;
}

std::vector<double> multiples(double step, Interval range) {
    const double slack = 1e-9 * range.length();
    const double first = std::ceil((range.low - slack) / step);
    const double last = std::floor((range.high + slack) / step);
    const double count = std::clamp(last - first + 1, 0.0, most_divisions + 2);
    std::vector<double> at(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < at.size(); ++i) {
        at[i] = (first + static_cast<double>(i)) * step + 0.0;  // no minus zero
    }
    return at;
}

std::vector<double> powers_of_ten(Interval range, int most) {
    const int low = static_cast<int>(std::ceil(std::log10(range.low) - 1e-9));
    const int high = static_cast<int>(std::floor(std::log10(range.high) + 1e-9));
    std::vector<double> at;
    const int stride = std::max(1, (high - low + most - 1) / std::max(most, 1));
    for (int exponent = low; exponent <= high; ++exponent) {
        if ((exponent - low) % stride == 0) {
            at.push_back(std::pow(10.0, exponent));
        }
    }
    if (at.size() > 2 || stride > 1) {
        return at;
    }
    for (int exponent = low - 1; exponent <= high; ++exponent) {
        for (const double factor : {2.0, 5.0}) {
            at.push_back(factor * std::pow(10.0, exponent));
        }
    }
    std::ranges::sort(at);
    at.erase(std::remove_if(at.begin(), at.end(),
                            [range](double x) { return x < range.low * (1 - 1e-9) || x > range.high * (1 + 1e-9); }),
             at.end());
    return at.size() > 2 ? at : multiples(round_step(range.length() / most), range);
}

/// "2e-9" rather than 2e-09, "1.5e6" rather than 1.500e+06.
std::string scientific(double value, int digits) {
    const std::string text = fmt::format("{:.{}e}", value, std::max(digits, 0));
    const std::size_t e = text.find('e');
    std::string head = text.substr(0, e);
    if (head.find('.') != std::string::npos) {
        head.erase(head.find_last_not_of('0') + 1);
        if (head.back() == '.') {
            head.pop_back();
        }
    }
    return fmt::format("{}e{}", head, std::stoi(text.substr(e + 1)));
}

/// The numbers with a fixed number of decimals.
std::vector<std::string> fixed(const std::vector<double>& at, int decimals) {
    std::vector<std::string> text;
    text.reserve(at.size());
    for (const double value : at) {
        text.push_back(fmt::format("{:.{}f}", value, decimals));
    }
    return text;
}

std::vector<std::string> in_powers(const std::vector<double>& at, int finest) {
    std::vector<std::string> text;
    text.reserve(at.size());
    for (const double value : at) {
        text.push_back(value == 0 ? "0" : scientific(value, exponent_of(std::fabs(value)) - finest));
    }
    return text;
}

/// The exponent of the last digit needed to show all ticks. At most four digits after the first of the axis's length
/// are shown, since a user's own ticks may need any number of digits: pi/2 is 1.5708 on an axis of length 5.
int finest_digit(const std::vector<double>& at, double length) {
    const int least = exponent_of(length) - 4;
    for (int digit = exponent_of(length) + 1; digit > least; --digit) {
        const double unit = std::pow(10.0, digit);
        if (std::ranges::all_of(at, [unit, length](double x) {
                const double rounding = std::max(1e-6 * length, 1e-15 * std::fabs(x));
                return std::fabs(std::round(x / unit) * unit - x) <= rounding;
            })) {
            return digit;
        }
    }
    return least;
}

void label_linear(Ticks& ticks, Interval range) {
    const int finest = finest_digit(ticks.at, range.length());
    double largest = 0;
    for (const double value : ticks.at) {
        largest = std::max(largest, std::fabs(value));
    }
    const int leading = largest > 0 ? exponent_of(largest) : 0;
    if (leading - finest > most_digits + 1) {
        const double unit = std::pow(10.0, exponent_of(range.length()) + 1);
        const double offset = std::round((range.low / 2 + range.high / 2) / unit) * unit;
        std::vector<double> rest = ticks.at;
        for (double& value : rest) {
            const double digit = std::pow(10.0, finest);
            value = std::round((value - offset) / digit) * digit + 0.0;  // rounds off the errors of large numbers
        }
        ticks.offset = fmt::format("{:+.15g}", offset);
        ticks.text = finest < -5 ? in_powers(rest, finest) : fixed(rest, std::max(0, -finest));
    } else if (leading < most_digits + (leading - finest > 4 ? 2 : 0) && finest >= -5) {  // 1000002, not 1.000002e6
        ticks.text = fixed(ticks.at, std::max(0, -finest));
    } else {
        ticks.text = in_powers(ticks.at, finest);
    }
}

/// Plain numbers if all are of moderate size, otherwise powers of ten except for 1.
std::vector<std::string> logarithmic(const std::vector<double>& at) {
    const bool plain = std::ranges::all_of(at, [](double value) { return value >= 1e-3 && value < 1e5; });
    std::vector<std::string> text;
    text.reserve(at.size());
    for (const double value : at) {
        text.push_back(plain || value == 1 ? fmt::format("{:.6g}", value) : scientific(value, 5));
    }
    return text;
}

}  // namespace

Ticks ticks_of(const Axis& axis, const Scale& scale, int most) {
    Ticks ticks;
    const Interval range = scale.range();
    if (!axis.ticks.empty()) {
        std::ranges::copy_if(axis.ticks, std::back_inserter(ticks.at),
                             [range](double x) { return x >= range.low && x <= range.high; });
        std::ranges::sort(ticks.at);
    } else if (axis.division && range.length() / *axis.division < most_divisions) {
        ticks.at = multiples(*axis.division, range);
    } else if (scale.logarithmic()) {
        ticks.at = powers_of_ten(range, most);
    } else {
        // A single tick does not show the scale.
        double least = range.length() / std::max(most, 1);
        do {
            ticks.at = multiples(round_step(least), range);
            least /= 2;
        } while (ticks.at.size() < 2);
    }
    if (scale.logarithmic()) {
        ticks.text = logarithmic(ticks.at);
    } else {
        label_linear(ticks, range);
    }
    return ticks;
}

std::vector<double> circles_of(const Figure& figure, const Ticks& x, const Ticks& y) {
    const auto radii = [](const Ticks& ticks) {
        std::vector<double> list;
        for (const double at : ticks.at) {
            const double radius = std::fabs(at);
            if (radius > 0 && std::ranges::none_of(list, [radius](double known) {
                    return std::fabs(known - radius) <= 1e-9 * radius;
                })) {
                list.push_back(radius);
            }
        }
        std::ranges::sort(list);
        return list;
    };
    if (!figure.circles || !figure.axes) {
        return {};
    }
    std::vector<double> by_x = radii(x);
    std::vector<double> by_y = radii(y);
    return by_x.size() >= by_y.size() ? by_x : by_y;
}

}  // namespace dinal::plots
