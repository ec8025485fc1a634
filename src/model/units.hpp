// The units of a user's angle, time and torque: words for cards, columns and axes. No number depends on them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "text/option.hpp"

namespace dinal::model {

/// What a number measures, which determines its unit.
enum class Quantity { time, angle, speed, torque, other };

struct Units {
    std::string theta = "rad";
    std::string t = {};  ///< empty: time units
    std::string M = {};  ///< empty: a torque without unit

    /// Returns whether no units were given: the angle in rad, the rest unnamed.
    bool usual() const { return theta == "rad" && t.empty() && M.empty(); }
    /// An error if a unit cannot appear in a line of text.
    [[nodiscard]] std::optional<text::Error> complaint() const;

    // Derived units; those that need M are empty without it.
    std::string speed() const;
    std::string frequency() const;
    std::string inertia() const;
    std::string damping() const;
    std::string stiffness() const;
    std::string energy() const;
    /// The unit of such numbers; empty if it has no name.
    std::string of(Quantity quantity) const;
    /// "s", or "time units"
    std::string times() const { return t.empty() ? "time units" : t; }

    /// "theta in m, t in s, M in N"; empty for the usual units.
    std::string in_words() const;
    /// "{ theta = \"m\", t = \"s\" }"
    std::string lua_text() const;
    /// The line that stores the units in a file.
    std::string in_file() const;
    /// Reads that line among these lines; returns the usual units if there is none.
    static Units from_file(std::span<const std::string> lines);
};

/// "1.5 s", or "1.5"
std::string with_unit(std::string number, std::string_view unit);
/// "period, s", or "period"
std::string name_with_unit(std::string name, std::string_view unit);

inline constexpr text::Option unit_options[] = {
    text::option<&Units::theta>("theta", "unit of angle or displacement", {.otherwise = "\"rad\""}),
    text::option<&Units::t>("t", "unit of time"),
    text::option<&Units::M>("M", "unit of torque or force"),
};
inline constexpr text::Call units_call{"units", "units = { theta = \"m\", t = \"s\", M = \"N\" }", unit_options};
inline constexpr text::Option units_option[] = {
    {.name = "units",
     .meaning = "names of the units, for cards, columns and axes: { theta = \"m\", t = \"s\", M = \"N\" }",
     .wanted = "a table such as { theta = \"m\", t = \"s\", M = \"N\" }",
     .fields = {&units_call}},
};

}  // namespace dinal::model
