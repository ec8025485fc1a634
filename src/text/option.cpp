#include "text/option.hpp"

#include <fmt/format.h>

namespace dinal::text {
namespace {

bool fits(const Range& range, double x) {
    return !std::isnan(x) && (range.unlimited || !std::isinf(x)) && range.holds(x);
}

std::string complaint(const Range& range, double x, const std::string& name) {
    if (std::isnan(x) || (!range.unlimited && std::isinf(x))) {
        return fmt::format("{} = {} must be {}", name, std::isnan(x) ? "nan" : fmt::format("{}", x),
                           range.unlimited ? "a number" : "finite");
    }
    return fmt::format("{} = {:.6g} must {}", name, x, range.must);
}

/// Returns the value as Lua text; empty if it is absent or an infinite number.
std::string literal(const Option& option, const OptionValue& value) {
    switch (static_cast<OptionKind>(value.index())) {
        case OptionKind::other:
            return "";
        case OptionKind::number: {
            const double x = std::get<double>(value);
            return std::isinf(x) && option.range.unlimited ? "" : number_literal(x);
        }
        case OptionKind::flag:
            return std::get<bool>(value) ? "true" : "false";
        case OptionKind::choice:
            return fmt::format("\"{}\"", option.choices[std::get<std::size_t>(value)]);
        case OptionKind::text:
            return fmt::format("\"{}\"", std::get<std::string>(value));
        case OptionKind::numbers:
            return list_literal(std::get<std::vector<double>>(value));
    }
    return "";
}

}  // namespace

std::optional<Error> complaint(const Option& option, const OptionValue& value) {
    std::optional<std::string> wrong;
    if (const double* number = std::get_if<double>(&value)) {
        if (fits(option.range, *number)) return std::nullopt;
        wrong = complaint(option.range, *number, option.name);
    }
    if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
        for (std::size_t i = 0; i < numbers->size() && !wrong; ++i) {  // the user counts from 1
            const double x = (*numbers)[i];
            if (!fits(option.range, x)) wrong = complaint(option.range, x, fmt::format("{}[{}]", option.name, i + 1));
        }
    }
    return wrong ? std::optional(Error{.sentence = *wrong, .option = option.name}) : std::nullopt;
}

std::string default_text(const Option& option) {
    if (option.otherwise == needed || option.instead_of_previous) {
        return "";
    }
    if (*option.otherwise != '\0' || option.filled.initial == nullptr) {
        return option.otherwise;
    }
    const OptionValue value = option.filled.initial();
    const auto* text = std::get_if<std::string>(&value);
    // A default outside the option's range means "absent".
    return complaint(option, value) || (text != nullptr && text->empty()) ? "" : literal(option, value);
}

std::string number_literal(double x) {
    if (std::isinf(x)) {
        return x > 0 ? "math.huge" : "-math.huge";
    }
    return fmt::format("{}", x);
}

std::string list_literal(std::span<const double> numbers) {
    std::string text = "{ ";
    for (const double x : numbers) {
        text += (text.size() > 2 ? ", " : "") + number_literal(x);
    }
    return numbers.empty() ? "{}" : text + " }";
}

namespace detail {

std::optional<Error> complaint(std::span<const Option> options, const void* owner, const void* object) {
    for (const Option& option : options) {
        if (option.filled.owner == owner && option.filled.get != nullptr) {
            if (auto wrong = text::complaint(option, option.filled.get(object))) {
                return wrong;
            }
        }
    }
    return std::nullopt;
}

std::string lua_text(std::string_view call, std::span<const Option> options, const void* object, Defaults defaults) {
    std::string list;
    for (const Option& option : options) {
        if (option.filled.get == nullptr) {
            continue;
        }
        const OptionValue value = option.filled.get(object);
        const bool same = option.otherwise != needed && value == option.filled.initial();
        std::string text = defaults == Defaults::left_out && same ? "" : literal(option, value);
        if (text.empty() && defaults == Defaults::described) text = default_text(option);
        if (!text.empty()) {
            list += fmt::format("{}{} = {}", list.empty() ? "" : ", ", option.name, text);
        }
    }
    return list.empty() ? fmt::format("{}{{}}", call) : fmt::format("{}{{ {} }}", call, list);
}

}  // namespace detail

}  // namespace dinal::text
