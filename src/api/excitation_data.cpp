// excitation.samples and excitation.scripted: the terms that bring a table, a file or a function.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "api/bind_excitation.hpp"
#include "files/csv.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "text/characters.hpp"

namespace dinal::api::excitation_functions {

namespace {

constexpr const char* file_example = "excitation.samples(\"record.csv\", { time = \"t\", value = \"M\" })";

template <class T>
T value_or_raise(lua_State* L, const std::string& file, text::Expected<T> expected) {
    if (!expected) {
        const text::Error error = file.empty() ? expected.error() : text::in_call(file, expected.error());
        lua::raise(L, text::in_call("excitation.samples", error));
    }
    return std::move(expected).value();
}

/// The column that an option names or numbers; none when the option is absent.
std::optional<Eigen::Index> asked_column(lua_State* L, const lua::Options& options, std::string_view option,
                                         const files::Table& table, const std::string& file) {
    options.push(option);
    const int type = lua_type(L, -1);
    if (type == LUA_TNIL) {
        lua_pop(L, 1);
        return std::nullopt;
    }
    if (type != LUA_TSTRING && lua_isinteger(L, -1) == 0) {
        options.wrong(option, "the name or the number of a column");
    }
    auto found = type == LUA_TSTRING ? files::find_column(table, lua_tostring(L, -1))
                                     : files::find_column(table, lua_tointeger(L, -1));
    lua_pop(L, 1);
    return value_or_raise(L, file, std::move(found));
}

Eigen::Index column_called(const files::Table& table, std::initializer_list<std::string_view> names,
                           Eigen::Index otherwise) {
    for (const std::string_view name : names) {
        const auto found = std::find(table.names.begin(), table.names.end(), name);
        if (found != table.names.end()) {
            return found - table.names.begin();
        }
    }
    return otherwise;
}

/// In files, times are counted by the row, not by the index of a table.
void check_times(lua_State* L, const std::string& file, const files::Table& table, Eigen::Index column) {
    const auto t = table.values.col(column);
    for (Eigen::Index i = 1; i < t.size(); ++i) {
        if (!(t[i] > t[i - 1])) {
            lua::raise(L, {.sentence = fmt::format(
                               "excitation.samples: {}: row {} of the numbers has {} = {}, which is not after {} in "
                               "the row before; times must increase",
                               file, i + 1, table.names[static_cast<std::size_t>(column)], t[i], t[i - 1]),
                           .call = "excitation.samples"});
        }
    }
}

std::vector<double> column_values(const files::Table& table, Eigen::Index column) {
    const auto values = table.values.col(column);
    return {values.data(), values.data() + values.size()};
}

int samples_from_file(lua_State* L) {
    const std::string file = lua_tostring(L, 1);
    const lua::Options options(L, 2, "excitation.samples", file_example, {"time", "value"}, true);
    auto read = files::read_csv(file);
    if (lua::interrupt_requested()) {
        lua::raise_interrupted(L);  // what was read is not all
    }
    const files::Table table = value_or_raise(L, "", std::move(read));
    if (table.values.rows() == 0) {
        lua::raise(L, {.sentence = fmt::format("excitation.samples: {} has names but no rows of numbers", file),
                       .call = "excitation.samples"});
    }
    if (table.values.cols() < 2) {
        lua::raise(
            L, {.sentence = fmt::format("excitation.samples: {} has only one column; times and values are two", file),
                .call = "excitation.samples"});
    }
    const auto asked_time = asked_column(L, options, "time", table, file);
    const auto asked_value = asked_column(L, options, "value", table, file);
    const Eigen::Index time = asked_time ? *asked_time : column_called(table, {"t", "time"}, 0);
    const Eigen::Index value = asked_value ? *asked_value : column_called(table, {"M"}, time == 1 ? 0 : 1);
    check_times(L, file, table, time);
    // The columns by name, so that the text still means the same when the file gets another one; numbers where it has
    // no names are found by these names, too.
    const auto name = [&](Eigen::Index column) { return text::quoted(table.names[static_cast<std::size_t>(column)]); };
    return push_term(
        L, std::make_shared<const model::Samples>(model::Samples{
               .t = column_values(table, time),
               .M = column_values(table, value),
               .origin = fmt::format("{}, {{ time = {}, value = {} }}", text::quoted(file), name(time), name(value))}));
}

int samples_from_table(lua_State* L) {
    const lua::Options options(L, 1, "excitation.samples", "excitation.samples{ t = { 0, 1, 2 }, M = { 0, 3, 0 } }",
                               {"t", "M"});
    for (const char* name : {"t", "M"}) {
        if (!options.has(name)) {
            options.missing(name);
        }
    }
    return push_term(L, std::make_shared<const model::Samples>(
                            model::Samples{.t = options.numbers("t"), .M = options.numbers("M")}));
}

}  // namespace

int samples(lua_State* L) {
    if (lua_type(L, 1) == LUA_TSTRING) {
        return samples_from_file(L);
    }
    if (lua_type(L, 1) != LUA_TTABLE) {
        lua::raise(L, {.sentence = fmt::format(
                           "excitation.samples takes the name of a file or a table of points, got {}; for example {}",
                           lua::describe(L, 1), file_example),
                       .call = "excitation.samples",
                       .culprit = lua::written(L, 1)});
    }
    return samples_from_table(L);
}

int scripted(lua_State* L) {
    constexpr const char* example = "excitation.scripted(f, { breaks = { 0.5, 2 }, period = 3 })";
    if (!lua::is_callable(L, 1) || lua::test<model::Excitation>(L, 1) != nullptr) {
        lua::raise(L, {.sentence = fmt::format("excitation.scripted needs a function, got {}; for example {}",
                                               lua::describe(L, 1), example),
                       .call = "excitation.scripted",
                       .culprit = lua::written(L, 1)});
    }
    const lua::Options options(L, 2, "excitation.scripted", example, {"breaks", "period"}, true);
    const std::optional<double> period = options.optional_number("period");
    if (period && *period <= 0) {
        options.fail(fmt::format("period = {} must be positive", *period));
    }
    const auto function = std::make_shared<lua::LuaFunction>(L, 1);
    return push_term(L, model::Scripted{.function = function,
                                        .feedback = function->feedback(),
                                        .breaks = options.numbers("breaks"),
                                        .period = period.value_or(0)});
}

}  // namespace dinal::api::excitation_functions
