// The columns of a run, each declared once: rows, files, plots, units, help and Python read these tables.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "model/oscillator.hpp"
#include "model/units.hpp"

namespace dinal::motion {

/// A body or link at the time of a row: the arguments from which its columns are computed.
struct AtRow {
    double t = 0;
    model::State y = {};
    double torque = 0;  ///< the load M of a body; the torque that a link transmits
    double friction = 0;
    double damping = 0;  ///< the coefficient C
};

struct ColumnKind {
    /// The data needed to compute the column between the rows.
    enum class By { time, motion, load, contact };

    std::string_view name, symbol;
    model::Quantity quantity = model::Quantity::other;
    By by = By::contact;
    double (*value)(const AtRow& at) = nullptr;
    const char *signature = "", *summary = "", *example = "";  ///< documentation of the field of a run
};

namespace column {

using By = ColumnKind::By;
using model::Quantity;

inline constexpr ColumnKind t{
    "t",
    "t",
    Quantity::time,
    By::time,
    [](const AtRow& at) { return at.t; },
    "run.t -> vector",
    "The times of the rows, time units.",
    "run = nondimensional{}:simulate{ M = 3, theta0 = 1, t_end = 2, dt = 0.5 }\n"
    "print(run.t[2])  --> 0.5",
};
inline constexpr ColumnKind theta{
    "theta",
    "θ",
    Quantity::angle,
    By::motion,
    [](const AtRow& at) { return at.y.theta; },
    "run.theta -> vector",
    "The angle, rad.",
    "run = nondimensional{}:simulate{ M = 3, theta0 = 1, t_end = 2, dt = 0.5 }\n"
    "print(run.theta[1])  --> 1.0",
};
inline constexpr ColumnKind velocity{
    "velocity",
    "θ'",
    Quantity::speed,
    By::motion,
    [](const AtRow& at) { return at.y.velocity; },
    "run.velocity -> vector",
    "The velocity, rad per time unit; exactly 0 while the mass sticks.",
    "run = nondimensional{}:simulate{ M = 3, theta0 = 1, t_end = 2, dt = 0.5 }\n"
    "print(run.velocity[1])  --> 0.0",
};
inline constexpr ColumnKind M{
    "M",
    "M",
    Quantity::torque,
    By::load,
    [](const AtRow& at) { return at.torque; },
    "run.M -> vector",
    "The excitation: the torque M on the mass.",
    "run = nondimensional{}:simulate{ M = 3, theta0 = 1, t_end = 2, dt = 0.5 }\n"
    "print(run.M:max())  --> 3.0",
};
inline constexpr ColumnKind friction{
    "friction",
    "friction",
    Quantity::torque,
    By::contact,
    [](const AtRow& at) { return at.friction; },
    "run.friction -> vector",
    "The torque of dry friction on the mass: -Rd sgn(velocity) while it moves, -(M - k theta) while it sticks.",
    "run = system{ I = 1, k = 1, Rd = 2 }:simulate{ theta0 = 1, t_end = 1, dt = 1 }\n"
    "print(run.friction)  --> vector{ 1, 1 }",
};
inline constexpr ColumnKind damping{
    "damping",
    "damping",
    Quantity::torque,
    By::motion,
    [](const AtRow& at) { return 0.0 - at.damping * at.y.velocity; },  // 0 - x: never -0
    "run.damping -> vector",
    "The torque of viscous damping on the mass, -C velocity.",
    "run = system{ I = 1, k = 1, C = 3 }:simulate{ velocity0 = 1, t_end = 1, dt = 1 }\n"
    "print(run.damping[1])  --> -3.0",
};
/// A column of links, and of bodies whose motion is prescribed.
inline constexpr ColumnKind torque{"torque", "torque", Quantity::torque, By::contact,
                                   [](const AtRow& at) { return at.torque; }};

}  // namespace column

inline constexpr std::array body_columns{column::t, column::theta,    column::velocity,
                                         column::M, column::friction, column::damping};
inline constexpr std::array link_columns{column::t, column::theta, column::velocity, column::torque, column::friction};

constexpr std::span<const ColumnKind> columns_of(bool is_link) {
    if (is_link) return link_columns;
    return body_columns;
}

/// The indices in body_columns of the columns that code refers to.
enum class Column : int { t, theta, velocity, M, friction, damping };
inline constexpr int column_count = body_columns.size();

/// The column of this name; otherwise nullptr.
constexpr const ColumnKind* find_column_kind(std::string_view name) {
    if (name == column::torque.name) return &column::torque;
    for (const ColumnKind& kind : body_columns) {
        if (kind.name == name) return &kind;
    }
    return nullptr;
}

/// Calls put(place, value) for each of `columns`; `value` computes the column and is inlined, also in a loop over rows.
template <const auto& columns, class Put>
constexpr void for_each_column(Put&& put) {
    [&]<std::size_t... c>(std::index_sequence<c...>) {
        (put(c,
             [](const AtRow& at) {
                 constexpr auto value = columns[c].value;
                 return value(at);
             }),
         ...);
    }
    (std::make_index_sequence<columns.size()>());
}

}  // namespace dinal::motion
