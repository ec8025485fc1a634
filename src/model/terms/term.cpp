#include "model/terms/term.hpp"

#include <fmt/format.h>

namespace dinal::model::terms {

std::optional<text::Error> not_increasing(const char* option, std::span<const double> times) {
    for (std::size_t i = 1; i < times.size(); ++i) {
        if (!(times[i] > times[i - 1])) {
            return text::Error{
                .sentence = fmt::format("{0}[{1}] = {2} is not after {0}[{3}] = {4}; times must increase", option,
                                        i + 1, times[i], i, times[i - 1]),
                .option = option};
        }
    }
    return std::nullopt;
}

std::string number(double x) {
    return fmt::format("{:.6g}", x);
}

std::string factor(double x) {
    return x == 1 ? "" : number(x) + " ";
}

std::string since(double at) {
    return at == 0 ? "t" : fmt::format("(t {} {:.6g})", at < 0 ? '+' : '-', std::fabs(at));
}

std::string from_on(double at) {
    return at == -never ? "" : " for t >= " + number(at);
}

std::string between(double first, double last) {
    return fmt::format(" for {:.6g} <= t < {:.6g}", first, last);
}

std::string wave(const char* shape, double amplitude, double period, double at) {
    const std::string begin = at == 0 ? "" : " that begins at " + number(at);
    return fmt::format("{:.6g} {} of period {:.6g}{}", amplitude, shape, period, begin);
}

}  // namespace dinal::model::terms
