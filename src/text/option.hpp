// The named options of a call as data: one row an option, written beside the struct that it fills and nowhere else.
// The check of a user's table, the signature, Tab, help, the manual and the text of a value read the same rows.
//
//     struct Pulse { double amplitude = 1, at = 0, width = 0; };
//     inline constexpr text::Option pulse_options[] = {
//         {.name = "amplitude", .unit = "torque", .meaning = "the height", .filled = text::fills<&Pulse::amplitude>},
//         {.name = "at", .unit = "time units", .meaning = "where it begins", .filled = text::fills<&Pulse::at>},
//         {.name = "width", .unit = "time units", .otherwise = text::needed, .range = text::positive,
//          .meaning = "how long it lasts", .filled = text::fills<&Pulse::width>},
//     };
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "text/expected.hpp"

namespace dinal::text {

/// Which numbers an option may have, and how the sentence goes on that refuses another: "width = -1 must be positive".
struct Range {
    const char* must;        ///< after "must "
    bool (*holds)(double);   ///< asked of numbers that are not nan
    bool unlimited = false;  ///< inf and -inf are asked, too; else a number must be finite first
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

/// What a user writes: nothing; a number; true or false; one of the choices, by its place; text; numbers.
using OptionValue = std::variant<std::monostate, double, bool, std::size_t, std::string, std::vector<double>>;

/// In the order of OptionValue. `other` is read by the call itself: a system, the name of a column.
enum class OptionKind { other, number, flag, choice, text, numbers };

/// Where the value of an option goes. fills<&Pulse::width> and sets<set_frequency> make it.
struct OptionTarget {
    OptionKind kind = OptionKind::other;
    const void* owner = nullptr;  ///< &owner_tag<Pulse>
    void (*set)(void* object, OptionValue value) = nullptr;
    OptionValue (*get)(const void* object) = nullptr;  ///< none: another option tells the same
    OptionValue (*initial)() = nullptr;                ///< what a new object has
};

/// Values of Option::otherwise, which is else the Lua text of the default: "0.6 T0", the name of another option.
inline constexpr const char* needed = nullptr;
inline constexpr const char* its_own = "";  ///< what a new object has; nothing to tell when that is infinite or absent

struct Call;

/// An option that is a table with named fields of its own, as walls = { lower = -1 }: what they are, and where.
struct Fields {
    enum class Place {
        itself,   ///< { lower = -1 }
        listed,   ///< a list of such tables: { { when = f } }
        by_name,  ///< such tables under names of the user's: { e = { rate = f } }
    };
    const Call* call = nullptr;  ///< that describes them; none: the option is no such table
    Place place = Place::itself;
};

struct Option {
    const char* name = "";
    const char* unit = "";
    const char* otherwise = its_own;
    Range range = any_finite;  ///< of a number, and of each number of a list
    const char* meaning = "";  ///< a few words without a full stop
    OptionTarget filled = {};
    std::span<const char* const> choices = {};  ///< Lua strings, in the order of the enumerators
    bool instead_of_previous = false;           ///< frequency | omega | period: one of them is given, never two
    const char* object = "";                    ///< the class of Lua whose constructors Tab offers: "integrator"
    const char* wanted = "";                    ///< of a kind `other`: "a system such as system{ I = 1, k = 39.5 }"
    Fields fields = {};
};

/// A call that takes one table of named options.
struct Call {
    const char* name;     ///< heads all sentences: "excitation.pulse"
    const char* example;  ///< a right one: "excitation.pulse{ at = 1, width = 0.2 }"
    std::span<const Option> options = {};
    bool may_be_bare = false;         ///< run:continue() without a table is as good as with an empty one
    const Call* neighbour = nullptr;  ///< whose options are given to this one by mistake
    const char* bare_value = "";      ///< the option that a number or a string stands for: run:continue(40)
};

/// "width = -1 must be positive", "breaks[2] = inf must be finite"; none when the value may stand.
std::optional<Error> complaint(const Option& option, const OptionValue& value);

namespace detail {
template <std::size_t n>
std::array<char, n> row_count(const Option (&)[n]);
template <std::size_t n>
std::array<char, n> row_count(const std::array<Option, n>&);
template <class Rows>
inline constexpr std::size_t rows_in = std::tuple_size_v<decltype(row_count(std::declval<const Rows&>()))>;
}  // namespace detail

/// Rows one after another, for calls that share some.
template <class... Rows>
constexpr std::array<Option, (detail::rows_in<Rows> + ...)> joined(const Rows&... parts) {
    std::array<Option, (detail::rows_in<Rows> + ...)> all{};
    auto place = all.begin();
    ((place = std::copy(std::begin(parts), std::end(parts), place)), ...);
    return all;
}

/// The Lua text of the default: "1", "\"listing\"", "Rd"; empty when there is none to tell: of an option that
/// is needed, or stands instead of another.
std::string default_text(const Option& option);

/// A number as Lua reads it back exactly; "1" and not "1.0", since all options are numbers of the one kind.
std::string number_literal(double x);

/// "{ 1, 2.5 }"
std::string list_literal(std::span<const double> numbers);

/// Options that have their default, in the text of a value.
enum class Defaults {
    left_out,
    written,
    told,  ///< also what is without limit, in the words of its row, which need not be Lua: "max_panel = 0.6 T0"
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
OptionValue told(const Value& value) {
    constexpr auto place = static_cast<std::size_t>(kind_of<Value>());
    if constexpr (!std::is_same_v<Value, typename Inner<Value>::Type>) {
        return value ? told(*value) : OptionValue();
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
        [](const void* object) { return told(static_cast<const Owner*>(object)->*member); },
        [] { return told(Owner{}.*member); }};
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

/// The option is this member: a number, bool, enumeration, string, vector of numbers, or one of them that is optional.
template <auto member>
inline constexpr OptionTarget fills = detail::member_target<member>();

/// The option is told to this function, void(T&, double), which fills what another option fills, too.
template <auto function>
inline constexpr OptionTarget sets = detail::function_target<function>();

/// The first option of the object that is out of its range: "width = -1 must be positive".
template <class T>
std::optional<Error> complaint(std::span<const Option> options, const T& object) {
    return detail::complaint(options, &detail::owner_tag<T>, &object);
}

/// The Lua text that makes the object again: "excitation.pulse{ amplitude = 1, at = 1.5, width = 0.2 }". What is
/// without limit, or absent, is left out.
template <class T>
std::string lua_text(std::string_view call, std::span<const Option> options, const T& object, Defaults defaults) {
    return detail::lua_text(call, options, &object, defaults);
}

}  // namespace dinal::text
