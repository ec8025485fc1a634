// sweep{ ... }: a function of a point asked at all points of a grid, by several threads.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <thread>

#include "api/classes.hpp"
#include "api/sweep_options.hpp"
#include "api/sweep_workers.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/options.hpp"
#include "lua/standard_globals.hpp"
#include "lua/user_function.hpp"
#include "source/fingerprint.hpp"
#include "text/characters.hpp"

namespace dinal::api {
namespace {

[[noreturn]] void fail_sweep(lua_State* L, text::Error error) {
    lua::raise(L, text::in_call("sweep", std::move(error)));
}

bool is_sweep_option(std::string_view name) {
    return std::any_of(std::begin(sweep_options), std::end(sweep_options),
                       [name](const text::Option& option) { return option.name == name; });
}

/// The values on the top of the stack.
DataColumn parameter_on_top(lua_State* L, const std::string& name) {
    bool of_words = false;
    if (lua_istable(L, -1)) {
        of_words = lua_rawgeti(L, -1, 1) == LUA_TSTRING;
        lua_pop(L, 1);
    }
    if (of_words) {
        std::vector<std::string> words;
        for (std::size_t i = 1; i <= lua_rawlen(L, -1); ++i) {
            if (lua_rawgeti(L, -1, static_cast<lua_Integer>(i)) != LUA_TSTRING) {
                fail_sweep(L, {.sentence = fmt::format("{}[{}] must be a string as those before, got {}", name, i,
                                                       lua::describe(L, -1)),
                               .option = name,
                               .culprit = lua::written(L, -1)});
            }
            words.emplace_back(lua::text_at(L, -1));
            lua_pop(L, 1);
        }
        return column_of(name, std::move(words));
    }
    if (!lua_istable(L, -1) && lua::test<lua::Vector>(L, -1) == nullptr) {
        std::vector<std::string_view> options;
        for (const text::Option& option : sweep_options) options.emplace_back(option.name);
        lua::raise(L,
                   {.sentence = fmt::format("sweep has no option '{}' among {}, and a parameter must be a vector or a "
                                            "table of values, got {}",
                                            name, fmt::join(options, ", "), lua::describe(L, -1)),
                    .call = "sweep",
                    .option = name,
                    .culprit = name,
                    .cure = text::did_you_mean(name, options)});
    }
    std::vector<double> numbers = lua::numbers_at(L, -1, "sweep", name);
    if (numbers.empty()) {
        fail_sweep(L, {.sentence = fmt::format("{} has no values: there is no point to ask", name), .option = name});
    }
    return column_of(name, std::move(numbers));
}

/// { "r", v } on the top of the stack, the place-th of them.
DataColumn listed_parameter(lua_State* L, lua_Integer place) {
    if (!lua_istable(L, -1) || lua_rawgeti(L, -1, 1) != LUA_TSTRING) {
        fail_sweep(L,
                   {fmt::format("item {} must be a name and its values, {{ \"r\", v }}; or name them, r = v", place)});
    }
    const std::string name(lua::text_at(L, -1));
    lua_pop(L, 1);
    lua_rawgeti(L, -1, 2);
    DataColumn parameter = parameter_on_top(L, name);
    lua_pop(L, 1);
    return parameter;
}

/// Takes the parameters out of the table at 1; the options stay, in a new table there.
std::vector<DataColumn> take_parameters(lua_State* L) {
    if (lua_gettop(L) != 1 || !lua_istable(L, 1)) {
        lua::raise(
            L, {.sentence = fmt::format("sweep takes one table, for example {}", sweep_call.example), .call = "sweep"});
    }
    std::vector<DataColumn> parameters;
    const auto listed = static_cast<lua_Integer>(lua_rawlen(L, 1));
    for (lua_Integer i = 1; i <= listed; ++i) {
        lua_rawgeti(L, 1, i);
        parameters.push_back(listed_parameter(L, i));
        lua_pop(L, 1);
    }
    std::set<std::string> names;
    lua_newtable(L);
    lua_pushnil(L);
    while (lua_next(L, 1) != 0) {
        const bool named = lua_type(L, -2) == LUA_TSTRING;
        if (named && is_sweep_option(lua_tostring(L, -2))) {
            lua_pushvalue(L, -2);
            lua_insert(L, -2);
            lua_rawset(L, 2);
            continue;
        }
        if (named) names.emplace(lua::text_at(L, -2));
        lua_pop(L, 1);
    }
    for (const std::string& name : names) {  // lua_next has no order
        lua::push_text(L, name);
        lua_rawget(L, 1);
        parameters.push_back(parameter_on_top(L, name));
        lua_pop(L, 1);
    }
    lua_remove(L, 1);
    return parameters;
}

void check_parameters(lua_State* L, const std::vector<DataColumn>& parameters) {
    if (parameters.empty()) {
        fail_sweep(L, {fmt::format("there is no parameter; for example {}", sweep_call.example)});
    }
    double points = 1;
    std::set<std::string> names;
    for (const DataColumn& parameter : parameters) {
        if (!names.insert(parameter.name).second || parameter.name == "error") {
            fail_sweep(L, {.sentence = parameter.name == "error"
                                           ? "'error' is the column of messages: give the parameter another name"
                                           : fmt::format("there are two parameters '{}'", parameter.name),
                           .option = parameter.name});
        }
        points *= static_cast<double>(parameter.size());
    }
    constexpr double most = 1e9;
    if (points > most) {
        fail_sweep(L, {fmt::format("{:.3g} points are more than the {:.0e} that one sweep can hold", points, most)});
    }
}

// ---- what Ctrl-C has broken off, for the same call to go on

const char unfinished_key = 0;  // in the registry

struct Unfinished {
    std::uint64_t asked = 0;
    std::shared_ptr<SweepResults> results = {};
};

std::shared_ptr<SweepResults> take_unfinished(lua_State* L, std::uint64_t asked) {
    std::shared_ptr<SweepResults> results;
    lua_rawgetp(L, LUA_REGISTRYINDEX, &unfinished_key);
    if (const auto* unfinished = lua::test<Unfinished>(L, -1); unfinished != nullptr && unfinished->asked == asked) {
        results = unfinished->results;
    }
    lua_pop(L, 1);
    return results;
}

void keep_unfinished(lua_State* L, std::uint64_t asked, const std::shared_ptr<SweepResults>& results) {
    results == nullptr ? lua_pushnil(L) : static_cast<void>(lua::push(L, Unfinished{asked, results}));
    lua_rawsetp(L, LUA_REGISTRYINDEX, &unfinished_key);
}

void set_partial_sweep(lua_State* L, const SweepGrid& grid, const SweepResults& results) {
    lua::push_dinal_table(L);
    push_data(L, results.data(grid, results.done_points()));
    lua_setfield(L, -2, "partial");
    lua_pop(L, 1);
}

// ----

std::uint64_t fingerprint_of(lua_State* L, int function, const SweepGrid& grid, double seed) {
    source::Fingerprint print(L);
    for (const DataColumn& parameter : grid.parameters()) {
        print.add(parameter.name);
        if (const lua::Vector* numbers = parameter.numbers()) {
            for (const double x : numbers->values()) print.add(x);
        } else {
            for (const std::string& word : *std::get<Words>(parameter.values)) print.add(word);
        }
    }
    print.add(seed);
    print.add_value(function);
    return print.number();
}

/// A mistake in the function makes all points fail; that is one error, and no map.
void raise_if_all_failed(lua_State* L, const SweepGrid& grid, const SweepResults& results) {
    if (results.failures().size() < results.size()) return;
    const auto& [point, message] = *results.failures().begin();
    lua::raise(L,
               {.sentence = grid.size() == 1 ? fmt::format("sweep: the point {} failed: {}", grid.text(point), message)
                                             : fmt::format("sweep: all {} points failed; the first one, {}: {}",
                                                           grid.size(), grid.text(point), message),
                .call = "sweep"});
}

/// What the first line of the map says when points have failed: nobody looks into a column that should be empty.
std::string heading_of_map(const SweepGrid& grid, const SweepResults& results) {
    if (results.failures().empty()) return "";
    const auto& [point, message] = *results.failures().begin();
    return text::wrapped(fmt::format("data: {} points, {} of them failed; the first one, {}: {}", grid.size(),
                                     results.failures().size(), grid.text(point), message));
}

std::size_t worker_count(const std::optional<double>& asked, std::size_t points) {
    const std::size_t cores = lua::in_worker() ? 1 : std::max(1U, std::thread::hardware_concurrency());
    return std::clamp<std::size_t>(asked ? static_cast<std::size_t>(*asked) : cores, 1,
                                   std::max<std::size_t>(points, 1));
}

int sweep(lua_State* L) {
    std::vector<DataColumn> parameters = take_parameters(L);
    const lua::Options options(L, 1, sweep_call);
    SweepOptions asked;
    options.fill(asked);
    options.push("run");
    if (lua_isnil(L, -1)) options.missing("run");
    if (!lua::is_callable(L, -1)) options.wrong("run", options.row("run").wanted);
    check_parameters(L, parameters);
    const int function = lua_gettop(L);

    const SweepGrid grid(std::move(parameters));
    const std::uint64_t print = fingerprint_of(L, function, grid, asked.seed);
    std::shared_ptr<SweepResults> results = take_unfinished(L, print);
    if (results == nullptr) results = std::make_shared<SweepResults>(grid.size());
    SweepWork work{.grid = grid, .results = *results, .points = {}, .seed = static_cast<long long>(asked.seed)};
    for (std::size_t point = 0; point < grid.size(); ++point) {
        if (!results->is_done(point)) work.points.push_back(point);
    }
    work.workers = worker_count(asked.workers, work.points.size());
    {
        SweepWorkers workers(L, function, work);
        workers.run(L);
    }
    if (lua::interrupt_requested()) {
        keep_unfinished(L, print, results);
        set_partial_sweep(L, grid, *results);
        lua::raise_interrupted(L);
    }
    keep_unfinished(L, 0, nullptr);
    raise_if_all_failed(L, grid, *results);
    Data map = results->data(grid, results->done_points());
    map.heading = heading_of_map(grid, *results);
    push_data(L, std::move(map));
    return 1;
}

constexpr lua::Member sweep_members[] = {
    {lua::a_function<sweep>, sweep_doc},
};

const lua::Class unfinished_class = {"unfinished sweep", {"", "", ""}, std::span<const lua::Member>()};

}  // namespace

const lua::Class sweep_functions = {
    "sweep",
    {"sweep{ ... } -> data", "Many points at once.",
     "print(#sweep{ x = { 1, 2, 3 }, run = function(p) return { y = p.x^2 } end })  --> 3"},
    sweep_members};

void register_sweep(lua_State* L) {
    lua::add_class<Unfinished>(L, unfinished_class);
    lua::add_functions(L, sweep_functions);
}

}  // namespace dinal::api
