// What identify{ ... } is told.
#pragma once

#include <optional>
#include <string>

#include "analysis/identification.hpp"
#include "api/extras_options.hpp"
#include "lua/options.hpp"
#include "model/assembly.hpp"
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
inline constexpr text::Option own_identify_options[] = {
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
     .meaning =
         "the excitation, in the time of the record: a Lua function, or an excitation such as excitation.samples",
     .object = "excitation"},
    {.name = "free",
     .otherwise = "all that are not given",
     .meaning =
         "the values to fit, from I, k, C, Rd, Re and offset; the others are 0, and Re is Rd, unless they are given. "
         "With system: any number of it, such as friction.speed, spring.3 or walls.restitution, or of a table that a "
         "function of the run uses, such as p.Kp. The start is always fitted unless it is given",
     .wanted = "a list such as { \"k\", \"Rd\" }"},
    {.name = "system",
     .meaning = "a first guess, a system of one body",
     .object = "system",
     .wanted = "a system such as system{ I = 1, k = 4, Rd = 0.3 }"},
    {.name = "measured",
     .otherwise = "\"theta\"",
     .meaning =
         "with system: \"theta\", \"velocity\" or \"acceleration\", a list of them, or a table with the names of "
         "their columns, { velocity = \"v\" }; gaps (nan) are left out",
     .wanted = "\"theta\", \"velocity\" or \"acceleration\", a list of these, or { velocity = \"v\" }"},
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
     .meaning = "the reading where the spring is relaxed, if known",
     .filled = text::fills<&IdentifyOptions::offset>},
};
inline constexpr text::Option extras_of_record[] = {extras_options[0], extras_options[2], extras_options[3]};
inline constexpr auto identify_options = text::joined(own_identify_options, extras_of_record);
inline constexpr text::Call identify_call{"identify", "identify{ data = run }", identify_options};

/// Fills times and angles of the question, without gaps. Raises when there is no such record.
void take_record(lua_State* L, const lua::Options& options, const IdentifyOptions& asked,
                 analysis::IdentifyQuestion& question);
/// The numbers of this column of the record, nan where there is none.
std::vector<double> record_numbers(lua_State* L, const lua::Options& options, const std::string& name,
                                   const char* option);

/// What was fitted to the record with a system as the guess.
struct FittedParts {
    std::vector<std::pair<std::string, double>> values = {}, errors = {};
    std::vector<std::string> silent = {};
    std::vector<double> t = {}, measured = {}, predicted = {};  ///< of the first measured quantity
    double noise = 0;
    std::string remark = {};
    std::optional<model::Oscillator> system = {};
    model::AssemblyHandle rig = {};
};
FittedParts fit_any(lua_State* L, const lua::Options& options, const IdentifyOptions& asked);

/// What the record is measured in, where its run or its columns say it.
model::Units units_of_record(lua_State* L, const lua::Options& options);
/// Fills what is given, by value or by not being free. The M of the question must be there already.
void take_given(lua_State* L, const lua::Options& options, const IdentifyOptions& asked,
                analysis::IdentifyQuestion& question);

}  // namespace dinal::api
