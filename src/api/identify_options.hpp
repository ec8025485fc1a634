// What identify{ ... } is told.
#pragma once

#include <optional>
#include <string>

#include "analysis/identification.hpp"
#include "lua/options.hpp"
#include "text/option.hpp"

namespace dinal::api {

struct IdentifyOptions {
    std::optional<std::string> t = {}, theta = {};
    std::optional<double> I = {}, k = {}, C = {}, Rd = {}, Re = {}, theta0 = {}, velocity0 = {}, offset = {};
};

inline constexpr const char* not_fitted = "known, and so not fitted";
inline constexpr text::Range positive_k{
    "be positive: identify needs a spring; without one give a k so small that the record is far shorter than a swing",
    text::positive.holds};
inline constexpr text::Option identify_options[] = {
    {.name = "data",
     .otherwise = text::needed,
     .meaning = "the record: data, a run, or a table with the columns t and theta; rows with a gap (nan) are left out"},
    {.name = "t",
     .otherwise = "\"t\", \"time\" or the first column",
     .meaning = "the name of the column of times",
     .filled = text::fills<&IdentifyOptions::t>},
    {.name = "theta",
     .otherwise = "\"theta\", \"x\" or the second column",
     .meaning = "the name of the column of angles",
     .filled = text::fills<&IdentifyOptions::theta>},
    {.name = "M",
     .unit = "torque",
     .otherwise = "none: a free decay",
     .meaning = "what drove it, in the time of the record: a Lua function, or an excitation such as "
                "excitation.samples",
     .object = "excitation"},
    {.name = "free",
     .otherwise = "all that are not given",
     .meaning = "a list of those of I, k, C, Rd, Re and offset that are fitted; the others are 0, and Re is Rd, unless "
                "they are given. The start is always fitted unless it is given"},
    {.name = "I", .range = text::positive, .meaning = not_fitted, .filled = text::fills<&IdentifyOptions::I>},
    {.name = "k", .range = positive_k, .meaning = not_fitted, .filled = text::fills<&IdentifyOptions::k>},
    {.name = "C", .range = text::not_negative, .meaning = not_fitted, .filled = text::fills<&IdentifyOptions::C>},
    {.name = "Rd", .range = text::not_negative, .meaning = not_fitted, .filled = text::fills<&IdentifyOptions::Rd>},
    {.name = "Re", .range = text::not_negative, .meaning = not_fitted, .filled = text::fills<&IdentifyOptions::Re>},
    {.name = "theta0", .unit = "rad", .meaning = not_fitted, .filled = text::fills<&IdentifyOptions::theta0>},
    {.name = "velocity0",
     .unit = "rad per time unit",
     .meaning = not_fitted,
     .filled = text::fills<&IdentifyOptions::velocity0>},
    {.name = "offset",
     .unit = "rad",
     .meaning = "what the record shows where the spring is relaxed; when it is known",
     .filled = text::fills<&IdentifyOptions::offset>},
};
inline constexpr text::Call identify_call{"identify", "identify{ data = run }", identify_options};

/// Fills times and angles of the question, without gaps. Raises when there is no such record.
void take_record(lua_State* L, const lua::Options& options, const IdentifyOptions& asked,
                 analysis::IdentifyQuestion& question);
/// What the record is measured in, where its run or its columns say it.
model::Units units_of_record(lua_State* L, const lua::Options& options);
/// Fills what is given, by value or by not being free. The M of the question must be there already.
void take_given(lua_State* L, const lua::Options& options, const IdentifyOptions& asked,
                analysis::IdentifyQuestion& question);

}  // namespace dinal::api
