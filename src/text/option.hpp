// The named options of a call as data: one row for each option, next to the struct that it fills. The check of the
// user's table, the signature, Tab, help, the manual and printed values all read these rows.
//
//     struct Pulse { double amplitude = 1, at = 0, width = 0; };
//     inline constexpr text::Option pulse_options[] = {
//         text::option<&Pulse::amplitude>("amplitude", "the height", {.unit = "torque"}),
//         text::option<&Pulse::at>("at", "where it begins", {.unit = "time units"}),
//         text::option<&Pulse::width>("width", "how long it lasts",
//                                     {.unit = "time units", .otherwise = text::needed, .range = text::positive}),
//     };
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "text/expected.hpp"

namespace dinal::text {

/// The allowed numbers of an option, and the end of the sentence that rejects others: "width = -1 must be positive".
struct Range {
    const char* must;        ///< after "must "
    bool (*holds)(double);   ///< called for numbers other than nan
    bool unlimited = false;  ///< whether inf and -inf are passed to `holds`; otherwise a number must be finite
};
constexpr bool is_whole(double x, double least, double most) {
    return x >= least && x <= most && x == static_cast<double>(static_cast<int>(x));
}
inline constexpr Range any_finite{"be finite", [](double) { return true; }};
inline constexpr Range positive{"be positive", [](double x) { return x > 0; }};
inline constexpr Range positive_or_infinite{"be positive", [](double x) { return x > 0; }, true};
inline constexpr Range not_negative{"not be negative", [](double x) { return x >= 0; }};
inline constexpr Range not_zero{"not be zero", [](double x) { return x != 0; }};
inline constexpr Range between_0_and_1{"lie between 0 and 1", [](double x) { return x > 0 && x < 1; }};

/// The value given by a user: absent; a number; true or false; a choice, by its index; text; numbers.
using OptionValue = std::variant<std::monostate, double, bool, std::size_t, std::string, std::vector<double>>;

/// In the order of OptionValue. `other` is read by the call itself: a system, a column name.
enum class OptionKind { other, number, flag, choice, text, numbers };

/// The destination of an option's value, made by option<&Pulse::width>, fills<...> or sets<set_frequency>.
struct OptionTarget {
    OptionKind kind = OptionKind::other;
    const void* owner = nullptr;  ///< &owner_tag<Pulse>
    void (*set)(void* object, OptionValue value) = nullptr;
    OptionValue (*get)(const void* object) = nullptr;  ///< null: another option shows the same value
    OptionValue (*initial)() = nullptr;                ///< the value in a new object
};

/// Special values of Option::otherwise, which is normally the Lua text of the default: "0.6 T0", the name of another
/// option.
inline constexpr const char* needed = nullptr;
inline constexpr const char* its_own = "";  ///< the value of a new object; not shown if infinite or absent

struct Call;

/// An option that is a table with named fields, as walls = { lower = -1 }.
struct Fields {
    enum class Place {
        itself,   ///< { lower = -1 }
        listed,   ///< a list of such tables: { { when = f } }
        by_name,  ///< tables under names that the user chooses: { e = { rate = f } }
    };
    const Call* call = nullptr;  ///< describes the fields; null: the option is not a table
    Place place = Place::itself;
};

struct Option {
    const char* name = "";
    const char* unit = "";
    const char* otherwise = its_own;
    Range range = any_finite;  ///< for a number, and for each number of a list
    const char* meaning = "";  ///< a few words without a full stop
    OptionTarget filled = {};
    std::span<const char* const> choices = {};  ///< as Lua strings, in the order of the enumerators
    bool instead_of_previous = false;           ///< exactly one of a group may be given: frequency | omega | period
    const char* object = "";                    ///< the Lua class whose constructors Tab offers: "integrator"
    const char* wanted = "";                    ///< for `other`: "a system such as system{ I = 1, k = 39.5 }"
    Fields fields = {};
};

/// A call that takes one table of named options.
struct Call {
    const char* name;     ///< begins all its error sentences: "excitation.pulse"
    const char* example;  ///< a valid call: "excitation.pulse{ at = 1, width = 0.2 }"
    std::span<const Option> options = {};
    bool may_be_bare = false;         ///< whether the table may be omitted, as in run:continue()
    const Call* neighbour = nullptr;  ///< a call whose options users often give to this one
    const char* bare_value = "";      ///< the option that a bare number or string sets: run:continue(40)
};

/// Returns an error such as "width = -1 must be positive", "breaks[2] = inf must be finite"; none if the value is
/// valid.
std::optional<Error> complaint(const Option& option, const OptionValue& value);

namespace detail {
template <class Row, std::size_t n>
std::array<char, n> row_count(const Row (&)[n]);
template <class Row, std::size_t n>
std::array<char, n> row_count(const std::array<Row, n>&);
template <class Rows>
inline constexpr std::size_t rows_in = std::tuple_size_v<decltype(row_count(std::declval<const Rows&>()))>;
}  // namespace detail

/// Concatenates rows, such as the options of calls that share some.
template <class... Rows>
constexpr auto joined(const Rows&... parts) {
    std::array<std::common_type_t<std::ranges::range_value_t<Rows>...>, (detail::rows_in<Rows> + ...)> all{};
    auto place = all.begin();
    ((place = std::copy(std::begin(parts), std::end(parts), place)), ...);
    return all;
}

/// Returns the Lua text of the default: "1", "\"listing\"", "Rd"; empty for options that are required or have
/// alternatives.
std::string default_text(const Option& option);

/// Returns a number as Lua text that reads back exactly; "1" rather than "1.0", since all options are floats.
std::string number_literal(double x);

/// "{ 1, 2.5 }"
std::string list_literal(std::span<const double> numbers);

/// The treatment of options at their default in the text of a value.
enum class Defaults {
    left_out,
    written,
    described,  ///< includes infinite values, in the words of their row, which need not be Lua: "max_panel = 0.6 T0"
};

namespace detail {

template <class T>
inline constexpr char owner_tag = 0;

template <class T>
struct PartsOf;
template <class T, class Value>
struct PartsOf<Value T::*> {
    using Owner = T;
    using Type = Value;
};
template <class T, class Value>
struct PartsOf<void (*)(T&, Value)> {
    using Owner = T;
    using Type = Value;
};

template <class T>
struct Inner {
    using Type = T;
};
template <class T>
struct Inner<std::optional<T>> {
    using Type = T;
};

template <class Value>
constexpr OptionKind kind_of() {
    using T = typename Inner<Value>::Type;
    return std::is_same_v<T, bool>                  ? OptionKind::flag
           : std::is_enum_v<T>                      ? OptionKind::choice
           : std::is_arithmetic_v<T>                ? OptionKind::number
           : std::is_same_v<T, std::string>         ? OptionKind::text
           : std::is_same_v<T, std::vector<double>> ? OptionKind::numbers
                                                    : OptionKind::other;
}

template <class Value>
Value taken(OptionValue value) {
    using T = typename Inner<Value>::Type;
    constexpr auto place = static_cast<std::size_t>(kind_of<Value>());
    if constexpr (std::is_enum_v<T> || (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>)) {
        return static_cast<T>(std::get<place>(value));
    } else {
        return std::get<place>(std::move(value));
    }
}

template <class Value>
OptionValue as_option_value(const Value& value) {
    constexpr auto place = static_cast<std::size_t>(kind_of<Value>());
    if constexpr (!std::is_same_v<Value, typename Inner<Value>::Type>) {
        return value ? as_option_value(*value) : OptionValue();
    } else if constexpr (std::is_enum_v<Value>) {
        return OptionValue(std::in_place_index<place>, static_cast<std::size_t>(value));
    } else {
        return OptionValue(std::in_place_index<place>, value);
    }
}

template <auto member>
constexpr OptionTarget member_target() {
    using Parts = PartsOf<decltype(member)>;
    using Owner = typename Parts::Owner;
    using Value = typename Parts::Type;
    static_assert(kind_of<Value>() != OptionKind::other, "no kind of option has this type");
    return {
        kind_of<Value>(), &owner_tag<Owner>,
        [](void* object, OptionValue value) { static_cast<Owner*>(object)->*member = taken<Value>(std::move(value)); },
        [](const void* object) { return as_option_value(static_cast<const Owner*>(object)->*member); },
        [] { return as_option_value(Owner{}.*member); }};
}

template <auto function>
constexpr OptionTarget function_target() {
    using Parts = PartsOf<decltype(function)>;
    using Owner = typename Parts::Owner;
    using Value = typename Parts::Type;
    return {
        kind_of<Value>(), &owner_tag<Owner>,
        [](void* object, OptionValue value) { function(*static_cast<Owner*>(object), taken<Value>(std::move(value))); },
        nullptr, nullptr};
}

std::optional<Error> complaint(std::span<const Option> options, const void* owner, const void* object);
std::string lua_text(std::string_view call, std::span<const Option> options, const void* object, Defaults defaults);

}  // namespace detail

/// Target: this member, a number, bool, enumeration, string, vector of numbers, or an optional one of these.
template <auto member>
inline constexpr OptionTarget fills = detail::member_target<member>();

/// The row of an option that fills this member; `others` are its other properties.
template <auto member>
constexpr Option option(const char* name, const char* meaning, Option others = {}) {
    others.name = name;
    others.meaning = meaning;
    others.filled = fills<member>;
    return others;
}

/// Target: a function void(T&, double) that converts the value and sets a member shared with another option.
template <auto function>
inline constexpr OptionTarget sets = detail::function_target<function>();

/// Returns the error of the object's first invalid option: "width = -1 must be positive".
template <class T>
std::optional<Error> complaint(std::span<const Option> options, const T& object) {
    return detail::complaint(options, &detail::owner_tag<T>, &object);
}

/// Returns the Lua text that constructs the object: "excitation.pulse{ amplitude = 1, at = 1.5, width = 0.2 }".
/// Infinite and absent values are omitted.
template <class T>
std::string lua_text(std::string_view call, std::span<const Option> options, const T& object, Defaults defaults) {
    return detail::lua_text(call, options, &object, defaults);
}

}  // namespace dinal::text
