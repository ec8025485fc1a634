#include "api/theory_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dinal::api {

TheoryArguments::TheoryArguments(lua_State* L, std::string_view call, std::string_view example,
                                 std::initializer_list<std::string_view> names)
    : L_(L), options_(L, 1, call, example, names) {
    luaL_checkstack(L, 10, "too many values");
}

Quantity TheoryArguments::quantity(std::string_view name, const text::Range& range) {
    options_.push(name);
    if (const auto* vector = lua::test<lua::Vector>(L_, -1)) {
        lua_pop(L_, 1);  // the table of options holds it on
        check_size(name, vector->size());
        check(name, range, vector->values());
        return remembered(Quantity(vector->values()));
    }
    const bool is_table = lua_type(L_, -1) == LUA_TTABLE;
    if (!is_table && lua_type(L_, -1) != LUA_TNUMBER && !lua_isnil(L_, -1)) {
        options_.wrong(name, "a finite number or a vector");
    }
    lua_pop(L_, 1);
    if (is_table) {
        tables_.push_back(options_.numbers(name));
        check_size(name, tables_.back().size());
        check(name, range, tables_.back());
        return remembered(Quantity(tables_.back()));
    }
    const double number = options_.number(name);
    if (!range.holds(number)) {
        options_.fail(fmt::format("{} = {:.6g} must {}", name, number, range.must));
    }
    return remembered(Quantity(number));
}

Quantity TheoryArguments::quantity(std::string_view name, const text::Range& range, double otherwise) {
    return options_.has(name) ? quantity(name, range) : Quantity(otherwise);
}

const model::Oscillator* TheoryArguments::optional_system() const {
    if (!options_.has("system")) {
        return nullptr;
    }
    options_.push("system");
    const auto* system = lua::test<model::Oscillator>(L_, -1);
    if (system == nullptr) {
        options_.wrong("system", "a system such as system{ I = 1, k = 39.5 }");
    }
    lua_pop(L_, 1);  // the table of options holds it on
    return system;
}

const model::Oscillator& TheoryArguments::system() const {
    const model::Oscillator* system = optional_system();
    if (system == nullptr) {
        options_.missing("system");
    }
    return *system;
}

void TheoryArguments::refuse(std::string_view name, std::size_t i, double value, std::string_view must) const {
    options_.push(name);
    const bool is_number = lua_type(L_, -1) == LUA_TNUMBER || lua_isnil(L_, -1);
    const std::string element = is_number ? "" : fmt::format("[{}]", i + 1);
    options_.fail(fmt::format("{}{} = {:.6g} {}", name, element, value, must));
}

void TheoryArguments::check_size(std::string_view name, std::size_t size) {
    if (!sized_by_.empty() && size != size_) {
        options_.fail(
            fmt::format("{} and {} have {} and {} numbers; they must be equally long", sized_by_, name, size_, size));
    }
    size_ = size;
    sized_by_ = name;
}

void TheoryArguments::check(std::string_view name, const text::Range& range, std::span<const double> values) const {
    const auto bad =
        std::find_if(values.begin(), values.end(), [&](double x) { return !std::isnan(x) && !range.holds(x); });
    if (bad != values.end()) {
        refuse(name, static_cast<std::size_t>(bad - values.begin()), *bad, fmt::format("must {}", range.must));
    }
}

Quantity TheoryArguments::remembered(const Quantity& quantity) {
    quantities_.push_back(quantity);
    return quantity;
}

bool TheoryArguments::has_nan(std::size_t i) const {
    return std::any_of(quantities_.begin(), quantities_.end(), [&](const Quantity& x) { return std::isnan(x[i]); });
}

}  // namespace dinal::api
