// Arguments and results of closed forms: each option a number or a vector, and results of the same shape.
#pragma once

#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "lua/interrupt.hpp"
#include "lua/options.hpp"
#include "lua/vector.hpp"
#include "model/oscillator.hpp"
#include "text/option.hpp"

namespace dinal::api {

/// What a closed form returns where it does not hold: nil for numbers, nan in a vector.
inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// A number, or the numbers of a vector.
class Quantity {
public:
    explicit Quantity(double number) : number_(number) {}
    explicit Quantity(std::span<const double> values) : values_(values.data()) {}
    double operator[](std::size_t i) const { return values_ != nullptr ? values_[i] : number_; }

private:
    const double* values_ = nullptr;
    double number_ = 0;
};

class TheoryArguments {
public:
    TheoryArguments(lua_State* L, const text::Call& call);

    [[nodiscard]] const lua::Options& options() const { return options_; }

    /// A number or a vector in the range of its row. Vectors and tables of numbers must be equally long. A nan in a
    /// vector passes: its result is nan. What is absent is the default of its row, a number or another option.
    Quantity quantity(std::string_view name);
    Quantity quantity(std::string_view name, Quantity otherwise);
    /// All options of a call that takes nothing else.
    template <std::size_t n>
    std::array<Quantity, n> quantities() {
        return quantities(std::make_index_sequence<n>());
    }
    /// The system; nullptr when there is none and none is needed.
    /// Raises when no closed form is known for it.
    [[nodiscard]] const model::Oscillator* system() const;

    /// Raises "CALL: NAME[i] = VALUE MUST" for element i from 0 (without [i] when NAME is a number).
    [[noreturn]] void refuse(std::string_view name, std::size_t i, double value, std::string_view must) const;

    /// Pushes f(i) for each element, i from 0: an array of doubles, one for each result. A number when all options are
    /// numbers, otherwise a vector.
    template <class Function>
    int push_results(Function f) const;
    /// The same for a function with one result.
    template <class Function>
    int push_result(Function f) const {
        return push_results([&](std::size_t i) { return std::array{static_cast<double>(f(i))}; });
    }

private:
    template <std::size_t... i>
    std::array<Quantity, sizeof...(i)> quantities(std::index_sequence<i...> /*places*/) {
        return {quantity(call_.options[i].name)...};
    }
    Quantity given(std::string_view name);
    Quantity remembered(const Quantity& quantity);
    [[nodiscard]] bool has_nan(std::size_t i) const;
    void check_size(std::string_view name, std::size_t size);
    void check(std::string_view name, const text::Range& range, std::span<const double> values) const;

    lua_State* L_;
    const text::Call& call_;
    lua::Options options_;
    std::deque<std::vector<double>> tables_;  // numbers of Lua tables; a deque does not move them
    std::vector<Quantity> quantities_;
    std::size_t size_ = 1;
    std::string_view sized_by_;  // the first option that is a vector
};

template <class Function>
int TheoryArguments::push_results(Function f) const {
    constexpr std::size_t count = std::tuple_size_v<decltype(f(0))>;
    std::array<std::vector<double>, count> columns;
    for (auto& column : columns) column.resize(size_, no_value);
    for (std::size_t i = 0; i < size_; ++i) {
        if (lua::interrupt_requested()) lua::raise_interrupted(L_);
        if (has_nan(i)) continue;
        const auto results = f(i);
        for (std::size_t j = 0; j < count; ++j) columns[j][i] = results[j];
    }
    for (auto& column : columns) {
        if (!sized_by_.empty()) {
            lua::push_vector(L_, std::move(column));
        } else if (std::isnan(column[0])) {
            lua_pushnil(L_);
        } else {
            lua_pushnumber(L_, column[0]);
        }
    }
    return static_cast<int>(count);
}

/// theory.NAME for a function of as many numbers as the call has options, in their order; its result is a number or
/// an array of them.
template <const text::Call& call, auto function>
int closed_form(lua_State* L) {
    TheoryArguments arguments(L, call);
    const auto quantities = arguments.quantities<call.options.size()>();
    return arguments.push_results([&](std::size_t i) {
        const auto result = std::apply([i](const auto&... quantity) { return function(quantity[i]...); }, quantities);
        if constexpr (std::is_arithmetic_v<std::decay_t<decltype(result)>>) {
            return std::array{static_cast<double>(result)};
        } else {
            return result;
        }
    });
}

}  // namespace dinal::api
