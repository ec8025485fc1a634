// What an excitation asks of each of its terms, and what terms share. A term is one file here and one row in
// model/terms.hpp.
//
// The invariant of this room: `next_break` returns exactly the double that `value` compares with. So value(b) is the
// new level and value(nextafter(b, -inf)) the old one, whatever a delay or the ten thousandth period was rounded to.
#pragma once

#include <algorithm>
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

/// Where a smooth term must be looked at closely, lest it be stepped over: for from <= t <= to at times at most
/// `apart`.
struct Detail {
    double from = never, to = never, apart = never;
};
inline constexpr Detail no_detail{};

/// What people read about a term, and the options that make one.
struct TermText {
    text::Call call;      ///< of Lua: "excitation.pulse"
    const char* summary;  ///< sentences, units included
    const char* example;  ///< Lua that runs; `-->` is followed by what the line prints
};

/// The answers of a term that is a function of time alone. The ranges of its options are in `about`; it may also have
///     std::optional<text::Error> complaint() const;   what is wrong with it besides
///     void closed_form(double inside, Sum& sum) const;   for any Sum: says what it is, as a formula (closed_form.hpp)
///     double value(double t, double rest = 0) const;   at t + rest, where t is that rounded: what it does may be so
///     quick that rounded times are too far apart for it
template <class T>
concept NativeTerm = requires(const T& term, T& own, double x) {
    { term.value(x) } -> std::same_as<double>;
    /// The first time after x at which it or a derivative of it jumps; `never` if there is none.
    { term.next_break(x) } -> std::same_as<double>;
    /// From when on it is constant, if it is not always 0: -never when it always is, `never` when it never is.
    { term.constant_from() } -> std::same_as<double>;
    /// What |value| never exceeds; `never` when nothing is known.
    { term.most() } -> std::same_as<double>;
    /// Its period; 0 when it has none.
    { term.repeats_after() } -> std::same_as<double>;
    { term.detail() } -> std::same_as<Detail>;
    /// Makes it the same term, later by x.
    own.delay_by(x);
    /// x times the term for the eye, x > 0: "2 sin(3 t)".
    { term.formula(x) } -> std::same_as<std::string>;
    { T::about } -> std::same_as<const TermText&>;
};

/// At t + rest, if the term can tell that from t.
template <NativeTerm T>
double value_near(const T& term, double t, double rest) {
    if constexpr (requires { term.value(t, rest); }) {
        return term.value(t, rest);
    } else {
        return term.value(t);
    }
}

/// x, or at least the next double after t: a break must always lead on.
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
// NOTE: floor() of the quotient is a guess that rounding can put off by one; the edges themselves decide. The
// corrections are counted, because far out (t / period > 2^53) the edges are no longer distinct.
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

/// How far t is from `from` to `to`, as a fraction.
inline double fraction(double t, double from, double to) {
    return to > from ? (t - from) / (to - from) : 0;
}

// ---- pieces of descriptions

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

// ---- options that more than one term has

namespace rows {

inline constexpr const char* torque = "torque";
inline constexpr const char* time = "time units";
inline constexpr const char* cycles = "cycles per time unit";
inline constexpr const char* where_a_period_begins = "start of a period";

template <class T>
constexpr text::Option amplitude(const char* meaning = "greatest value") {
    return {.name = "amplitude", .unit = torque, .meaning = meaning, .filled = text::fills<&T::amplitude>};
}
template <class T>
constexpr text::Option at(const char* meaning = "start") {
    return {.name = "at", .unit = time, .meaning = meaning, .filled = text::fills<&T::at>};
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
/// In place of the period, the row before.
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
