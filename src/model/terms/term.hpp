// The interface of an excitation's terms, and code that they share. A term is one struct in one of the files
// here and one row in model/terms.hpp.
//
// The invariant of this room: `next_break` returns exactly the double that `value` compares with. So value(b) is the
// new level and value(nextafter(b, -inf)) the old one, however a delay or the ten thousandth period is rounded.
#pragma once

#include <cmath>
#include <concepts>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>

#include "text/expected.hpp"
#include "text/option.hpp"

namespace dinal::model {

inline constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace dinal::model

namespace dinal::model::terms {

inline constexpr double two_pi = 2 * std::numbers::pi;

/// A detail of a smooth term that a large step could miss: for from <= t <= to, sample at most `apart` apart.
struct Detail {
    double from = never, to = never, apart = never;
};

/// The documentation of a term, and its options.
struct TermText {
    text::Call call;      ///< its constructor in Lua: "excitation.pulse"
    const char* summary;  ///< sentences, units included
    const char* example;  ///< Lua that runs; `-->` precedes the output
};

/// The interface of a term that is a function of time alone. `about` has the ranges of its options. Optional:
///     std::optional<text::Error> complaint() const;   an error that ranges cannot express
///     void closed_form(double inside, Sum& sum) const;   adds its formula to any Sum (closed_form.hpp)
///     double value(double t, double rest = 0) const;   at t + rest, for terms so quick that the rounding of t matters
///     double repeats_after() const;   its period, if it has one
///     Detail detail() const;   if a large step could miss it
///     void delay_by(double d);   if adding d to `at` does not delay it
template <class T>
concept NativeTerm = requires(const T& term, double x) {
    { term.value(x) } -> std::same_as<double>;
    /// The first time after x at which it or a derivative of it jumps; `never` if there is none.
    { term.next_break(x) } -> std::same_as<double>;
    /// The time from which it is constant: -never if always, `never` if never. A zero amplitude is not considered.
    { term.constant_from() } -> std::same_as<double>;
    /// An upper bound of |value|; `never` if unknown.
    { term.most() } -> std::same_as<double>;
    /// The term times x > 0 as text: "2 sin(3 t)".
    { term.formula(x) } -> std::same_as<std::string>;
    { T::about } -> std::same_as<const TermText&>;
};

/// The value at t + rest, as far as the term resolves rest.
template <NativeTerm T>
double value_near(const T& term, double t, double rest) {
    if constexpr (requires { term.value(t, rest); }) {
        return term.value(t, rest);
    } else {
        return term.value(t);
    }
}

/// The period of a term; 0 if it has none.
template <class T>
double period_of(const T& term) {
    if constexpr (requires { term.repeats_after(); }) {
        return term.repeats_after();
    } else {
        return 0;
    }
}

template <class T>
Detail detail_of(const T& term) {
    if constexpr (requires { term.detail(); }) {
        return term.detail();
    } else {
        return {};
    }
}

template <class T>
void delay(T& term, double d) {
    if constexpr (requires { term.delay_by(d); }) {
        term.delay_by(d);
    } else {
        term.at += d;
    }
}

/// x, or at least the next double after t: breaks must advance.
inline double later(double t, double x) {
    return x > t ? x : std::nextafter(t, never);
}

inline double first_after(double t, std::initializer_list<double> sorted) {
    for (const double x : sorted) {
        if (x > t) {
            return x;
        }
    }
    return never;
}

/// The largest n with edge(n) <= t, for the edges of a periodic term.
// NOTE: rounding can put floor() of the quotient off by one, so the edges themselves decide. The corrections are
// limited, because far out (t / period > 2^53) the edges are no longer distinct.
template <class Edge>
double cycle_at(double t, double quotient, const Edge& edge) {
    constexpr int most_corrections = 4;
    double n = std::floor(quotient);
    for (int i = 0; i < most_corrections && edge(n) > t; ++i) {
        n -= 1;
    }
    for (int i = 0; i < most_corrections && edge(n + 1) <= t; ++i) {
        n += 1;
    }
    return n;
}

/// The fraction of the way from `from` to `to` at t.
inline double fraction(double t, double from, double to) {
    return to > from ? (t - from) / (to - from) : 0;
}

// ---- parts of descriptions

/// "t[3] = 1 is not after t[2] = 2; times must increase", or none.
std::optional<text::Error> not_increasing(const char* option, std::span<const double> times);

/// "2"
std::string number(double x);
/// A number as a factor: "2 ", and nothing for 1.
std::string factor(double x);
/// The time since `at`: "t", "(t - 2)" or "(t + 2)".
std::string since(double at);
/// " for t >= 2"
std::string from_on(double at);
/// " for 1 <= t < 2"
std::string between(double first, double last);
/// "2 sawtooth of period 3 that begins at 1"
std::string wave(const char* shape, double amplitude, double period, double at);

// ---- options shared by terms

namespace rows {

inline constexpr const char* torque = "torque";
inline constexpr const char* time = "time units";
inline constexpr const char* cycles = "cycles per time unit";
inline constexpr const char* where_a_period_begins = "start of a period";

template <class T>
constexpr text::Option amplitude(const char* meaning = "greatest value") {
    return text::option<&T::amplitude>("amplitude", meaning, {.unit = torque});
}
template <class T>
constexpr text::Option at(const char* meaning = "start") {
    return text::option<&T::at>("at", meaning, {.unit = time});
}
template <class T>
constexpr text::Option width(const char* meaning = "duration") {
    return {"width", time, text::needed, text::positive, meaning, text::fills<&T::width>};
}
template <class T>
constexpr text::Option period() {
    return {"period", time, text::needed, text::positive, "period of repetition", text::fills<&T::period>};
}
template <class T>
void set_frequency(T& term, double frequency) {
    term.period = 1 / frequency;
}
/// An alternative to the period in the previous row.
template <class T>
constexpr text::Option frequency() {
    return {.name = "frequency",
            .unit = cycles,
            .otherwise = text::needed,
            .range = text::positive,
            .meaning = "1 / period",
            .filled = text::sets<set_frequency<T>>,
            .instead_of_previous = true};
}
template <class T>
void set_omega(T& term, double omega) {
    term.period = two_pi / omega;
}
template <class T>
constexpr text::Option omega() {
    return {.name = "omega",
            .unit = "rad per time unit",
            .otherwise = text::needed,
            .range = text::positive,
            .meaning = "2 pi/period",
            .filled = text::sets<set_omega<T>>,
            .instead_of_previous = true};
}

}  // namespace rows

}  // namespace dinal::model::terms
