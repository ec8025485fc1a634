// The record that identify{ ... } is given, and which of the unknowns are fitted.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/data.hpp"
#include "api/identify_options.hpp"
#include "api/units_option.hpp"
#include "lua/vector.hpp"

namespace dinal::api {
namespace {

struct RecordColumns {
    std::vector<std::string> names;
    std::vector<std::vector<double>> numbers;  // empty for words
};

void add_column(RecordColumns& record, const std::string& name, std::span<const double> numbers) {
    record.names.push_back(name);
    record.numbers.emplace_back(numbers.begin(), numbers.end());
}

/// The columns of what stands under `data`.
RecordColumns record_columns(lua_State* L, const lua::Options& options) {
    RecordColumns record;
    options.push("data");
    const int place = lua_gettop(L);
    if (const auto* data = lua::test<DataHandle>(L, place)) {
        for (const DataColumn& column : (*data)->columns) {
            add_column(record, column.name,
                       column.numbers() != nullptr ? column.numbers()->values() : std::span<const double>());
        }
    } else if (const auto* run = lua::test<RunHandle>(L, place)) {
        const motion::Trajectory& trajectory = (*run)->trajectory;
        for (std::size_t i = 0; i < trajectory.names().size(); ++i) {
            const auto values = trajectory.rows.col(static_cast<Eigen::Index>(i));
            add_column(record, trajectory.names()[i], {values.data(), static_cast<std::size_t>(values.size())});
        }
    } else if (lua_istable(L, place)) {
        lua_pushnil(L);
        while (lua_next(L, place) != 0) {
            if (lua_type(L, -2) == LUA_TSTRING) {
                const std::string name = lua_tostring(L, -2);
                add_column(record, name, lua::numbers_with_gaps_at(L, -1, "identify", "data." + name));
            }
            lua_pop(L, 1);
        }
    } else if (lua_isnil(L, place)) {
        options.missing("data");
    } else {
        options.wrong("data", lua_type(L, place) == LUA_TSTRING
                                  ? "what load gives for that file (or a run, or a table of columns)"
                                  : "data, a run, or a table of columns");
    }
    lua_pop(L, 1);
    return record;
}

/// The column asked for, or the first of these names, or the one in this place.
const std::vector<double>& record_column(const lua::Options& options, const RecordColumns& record,
                                         const std::optional<std::string>& asked,
                                         std::initializer_list<std::string_view> names, std::size_t place,
                                         const char* option) {
    std::size_t found = record.names.size();
    for (std::size_t i = 0; i < record.names.size(); ++i) {
        if (asked && record.names[i] == *asked) found = i;
    }
    if (asked && found == record.names.size()) {
        const std::vector<std::string_view> known(record.names.begin(), record.names.end());
        options.fail({.sentence = fmt::format("the record has no column '{}' among {}", *asked, fmt::join(known, ", ")),
                      .option = option,
                      .culprit = *asked,
                      .cure = text::did_you_mean(*asked, known)});
    }
    for (const std::string_view name : names) {
        const auto there = std::find(record.names.begin(), record.names.end(), name);
        if (found == record.names.size() && there != record.names.end()) {
            found = static_cast<std::size_t>(there - record.names.begin());
        }
    }
    if (found == record.names.size()) found = place;
    if (found >= record.names.size()) {
        options.fail({fmt::format("the record has {} column{}; times and angles are needed", record.names.size(),
                                  record.names.size() == 1 ? "" : "s")});
    }
    if (record.numbers[found].empty()) {
        options.fail({fmt::format("the column '{}' of the record has no numbers", record.names[found])});
    }
    return record.numbers[found];
}

}  // namespace

std::vector<double> record_numbers(lua_State* L, const lua::Options& options, const std::string& name,
                                   const char* option) {
    return record_column(options, record_columns(L, options), name, {}, 0, option);
}

model::Units units_of_record(lua_State* L, const lua::Options& options) {
    model::Units units;
    options.push("data");
    if (const auto* run = lua::test<RunHandle>(L, -1)) {
        units = units_of(**run);
    } else if (const auto* data = lua::test<DataHandle>(L, -1)) {
        for (const auto& [name, unit] : {std::pair{"theta", &units.theta}, {"t", &units.t}, {"M", &units.M}}) {
            const DataColumn* column = (*data)->find(name);
            if (column != nullptr && !column->unit.empty()) *unit = column->unit;
        }
    }
    lua_pop(L, 1);
    return units;
}

void take_record(lua_State* L, const lua::Options& options, const IdentifyOptions& asked,
                 analysis::IdentifyQuestion& question) {
    const RecordColumns record = record_columns(L, options);
    const std::vector<double>& t = record_column(options, record, asked.t, {"t", "time"}, 0, "t");
    const std::vector<double>& theta = record_column(options, record, asked.theta, {"theta", "x", "angle"}, 1, "theta");
    if (t.size() != theta.size()) {
        options.fail({fmt::format("the record has {} times, but {} angles", t.size(), theta.size())});
    }
    for (std::size_t i = 0; i < t.size(); ++i) {
        if (std::isnan(t[i]) || std::isnan(theta[i])) continue;
        question.t.push_back(t[i]);
        question.theta.push_back(theta[i]);
    }
}

void take_given(lua_State* L, const lua::Options& options, const IdentifyOptions& asked,
                analysis::IdentifyQuestion& question) {
    if (asked.Re && asked.Rd && *asked.Re < *asked.Rd) {
        options.fail({fmt::format("Re = {:.6g} must be at least Rd = {:.6g}", *asked.Re, *asked.Rd)});
    }
    question.given = {asked.I, asked.k, asked.C, asked.Rd, asked.Re, asked.theta0, asked.velocity0, asked.offset};
    options.push("free");
    if (lua_isnil(L, -1)) {
        lua_pop(L, 1);
        return;
    }
    if (!lua_istable(L, -1) || lua_rawlen(L, -1) == 0) options.wrong("free", "a list such as { \"k\", \"Rd\" }");
    std::array<bool, analysis::unknown_count> free{};
    for (lua_Integer i = 1; i <= static_cast<lua_Integer>(lua_rawlen(L, -1)); ++i) {
        lua_rawgeti(L, -1, i);
        const std::string name = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : lua::describe(L, -1);
        const auto* const known = std::find(analysis::unknown_names.begin(), analysis::unknown_names.end(), name);
        if (known == analysis::unknown_names.end()) {
            options.fail({.sentence = fmt::format("free[{}] is {}, but what can be fitted is {}", i, name,
                                                  fmt::join(analysis::unknown_names, ", ")),
                          .option = "free",
                          .culprit = name,
                          .cure = text::did_you_mean(name, analysis::unknown_names)});
        }
        const auto place = static_cast<std::size_t>(known - analysis::unknown_names.begin());
        if (question.given[place]) options.fail({fmt::format("{} is given, so it cannot be fitted", name)});
        free[place] = true;
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    for (const analysis::Unknown which : {analysis::Unknown::C, analysis::Unknown::Rd, analysis::Unknown::offset}) {
        const auto place = static_cast<std::size_t>(which);
        if (!free[place] && !question.given[place]) question.given[place] = 0;
    }
    for (const analysis::Unknown which : {analysis::Unknown::I, analysis::Unknown::k}) {
        const auto place = static_cast<std::size_t>(which);
        if (!free[place] && !question.given[place] && question.M) {
            options.fail({fmt::format("{} is neither given nor in free", analysis::unknown_names[place])});
        }
    }
    const auto Re = static_cast<std::size_t>(analysis::Unknown::Re);
    if (!free[Re] && !question.given[Re]) question.given[Re] = 0;  // less than Rd is Rd
}

}  // namespace dinal::api
