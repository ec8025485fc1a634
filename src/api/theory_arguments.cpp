#include "api/theory_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>

#include "model/laws/coulomb.hpp"

namespace dinal::api {

TheoryArguments::TheoryArguments(lua_State* L, const text::Call& call) : L_(L), call_(call), options_(L, 1, call) {
    luaL_checkstack(L, 10, "too many values");
}

const model::Oscillator* TheoryArguments::system() const {
    const auto* system = options_.object<model::Oscillator>("system");
    if (system == nullptr) {
        return system;
    }
    if (!system->has_spring()) {
        options_.fail({.sentence = "the closed forms are about a mass on a spring, and this system has k = 0",
                       .option = "system"});
    }
    if (system->walls()) {
        options_.fail(
            {.sentence = "the closed forms know no walls, and this system has some; simulate it", .option = "system"});
    }
    if (!system->spring().none()) {
        options_.fail({.sentence =
                           "the closed forms know the spring k theta only, and this system has another beside it; "
                           "simulate it",
                       .option = "system"});
    }
    if (!system->friction().none() && system->friction().as<model::laws::Coulomb>() == nullptr) {
        options_.fail({.sentence = "the closed forms know Coulomb's friction only, with one Rd and one Re for both "
                                   "ways; simulate this system",
                       .option = "system"});
    }
    return system;
}

Quantity TheoryArguments::quantity(std::string_view name, Quantity otherwise) {
    return options_.has(name) ? given(name) : otherwise;
}

Quantity TheoryArguments::quantity(std::string_view name) {
    if (options_.has(name)) {
        return given(name);
    }
    const char* otherwise = options_.row(name).otherwise;
    if (otherwise == text::needed) {
        options_.missing(name);
    }
    double number = 0;
    const auto read = std::from_chars(otherwise, otherwise + std::strlen(otherwise), number);
    return read.ptr != otherwise ? Quantity(number) : quantity(otherwise);
}

Quantity TheoryArguments::given(std::string_view name) {
    const text::Range& range = options_.row(name).range;
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
    return remembered(Quantity(options_.number(name)));
}

void TheoryArguments::refuse(std::string_view name, std::size_t i, double value, std::string_view must) const {
    options_.push(name);
    const bool is_number = lua_type(L_, -1) == LUA_TNUMBER || lua_isnil(L_, -1);
    const std::string element = is_number ? "" : fmt::format("[{}]", i + 1);
    options_.fail(name, fmt::format("{}{} = {:.6g} {}", name, element, value, must));
}

void TheoryArguments::check_size(std::string_view name, std::size_t size) {
    if (!sized_by_.empty() && size != size_) {
        options_.fail(name, fmt::format("{} and {} have {} and {} numbers; they must be equally long", sized_by_, name,
                                        size_, size));
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
