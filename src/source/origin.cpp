#include "source/origin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lua/user_function.hpp"
#include "motion/witness.hpp"
#include "source/describe.hpp"
#include "text/characters.hpp"
#include "text/version.hpp"
#include "text/words.hpp"

namespace dinal::source {

namespace {

void append_lines(std::vector<std::string>& lines, std::string_view text) {
    for (const std::string_view line : text::split(text, '\n')) lines.emplace_back(line);
}

/// The text of an excitation; if it is only a function, the author's text.
std::string excitation_text(lua_State* L, const model::Excitation& excitation, ValueText& writer) {
    const lua::LuaFunction* function = function_alone(excitation);
    if (function == nullptr) return lua_text(L, excitation, &writer);
    function->push(L);
    std::string text = writer.expression(-1);
    lua_pop(L, 1);
    return text;
}

/// "dt = 0.01", or the times, ten a line.
std::string rows_text(const motion::Grid& rows) {
    if (rows.dt() != 0) {
        return fmt::format("dt = {}", rows.dt());
    }
    std::string text = "times = {";
    for (std::size_t i = 0; i < rows.times().size(); ++i) {
        text += fmt::format("{} {},", i % 10 == 9 ? "\n" : "", rows.times()[i]);
    }
    return text + " }";
}

/// Appends "local states = { ... }" and "local events = { ... }" if there are any.
void append_states_and_events(std::vector<std::string>& lines, lua_State* L, const model::Drive& drive,
                              ValueText& writer) {
    if (!drive.states.empty()) {
        std::string text;
        for (const model::OwnState& state : drive.states) {
            text += fmt::format("{} {} = {{ start = {}, rate = {} }}", text.empty() ? "" : ",", state.name, state.start,
                                function_text(L, *state.rate, &writer));
        }
        lines.push_back("local states = {" + text + " }");
    }
    if (!drive.events.empty()) {
        std::string text;
        for (const model::WantedEvent& wanted : drive.events) {
            text += fmt::format("{} {{ when = {}", text.empty() ? "" : ",", function_text(L, *wanted.when, &writer));
            if (wanted.direction != model::Direction::both) {
                text += fmt::format(", direction = \"{}\"", wanted.direction == model::Direction::up ? "up" : "down");
            }
            text += wanted.stop ? ", stop = true" : "";
            text += wanted.name.empty() ? "" : ", name = " + text::quoted(wanted.name);
            if (const auto* action = dynamic_cast<const lua::LuaAction*>(wanted.act.get())) {
                action->push(L);
                text += ", act = " + writer.expression(-1);
                lua_pop(L, 1);
            }
            text += " }";
        }
        lines.push_back("local events = {" + text + " }");
    }
}

/// "{ a = 1, b = 2 }", or for one unnamed body its number.
std::string by_body(const model::System& system, const std::vector<double>& numbers) {
    if (!system.named) return fmt::format("{}", numbers.front());
    std::string text;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        text += fmt::format("{} {} = {}", text.empty() ? "" : ",", system.bodies[i].name, numbers[i]);
    }
    return "{" + text + " }";
}

/// Appends "local M = ..." by body or joint, if anything acts.
void append_acting(std::vector<std::string>& lines, lua_State* L, const char* name, const model::System& system,
                   const std::vector<model::Excitation>& acting, ValueText& writer) {
    std::string text;
    for (std::size_t j = 0; j < acting.size(); ++j) {
        if (acting[j].components().empty()) continue;
        const std::string own = excitation_text(L, acting[j], writer);
        text += system.named ? fmt::format("{} {} = {}", text.empty() ? "" : ",", system.joints[j].name, own) : own;
    }
    if (text.empty()) return;
    lines.push_back(fmt::format("local {} = {}", name, system.named ? "{" + text + " }" : text));
}

bool acts(const std::vector<model::Excitation>& acting) {
    return std::ranges::any_of(acting, [](const auto& one) { return !one.components().empty(); });
}

/// The lines that construct a system and its drive. L may be null if there are no user functions.
std::vector<std::string> set_up_lines(lua_State* L, const model::System& system, const model::Drive& drive) {
    std::vector<std::string> lines;
    lines.emplace_back("-- dinal " DINAL_VERSION ": without the \"# \" before them, these lines repeat the run");
    if (!system.units.usual()) lines.push_back(system.units.in_file());
    ValueText writer(L);
    std::vector<std::string> declarations;
    append_acting(declarations, L, "M", system, drive.loads, writer);
    append_states_and_events(declarations, L, drive, writer);
    append_acting(declarations, L, "belt", system, drive.belts, writer);
    if (!drive.base.components().empty()) {
        declarations.push_back("local base = " + excitation_text(L, drive.base, writer));
    }
    declarations.push_back("local sys = " + lua_text(L, system, &writer));
    for (const auto* texts : {&writer.remarks(), &writer.globals(), &std::as_const(declarations)}) {
        for (const std::string& text : *texts) append_lines(lines, text);
    }
    return lines;
}

}  // namespace

Origin origin_of(lua_State* L, Task task) {
    std::vector<std::string> set_up;
    if (!task.system->is_plain() || motion::has_functions(*task.system, task.drive)) {
        set_up = set_up_lines(L, *task.system, task.drive);
    }
    return {std::move(task), std::move(set_up)};
}

std::vector<std::string> repeat_lines(const Origin& origin) {
    const model::System& system = *origin.system;
    const model::Drive& drive = origin.drive;
    std::vector<std::string> lines = origin.set_up.empty() ? set_up_lines(nullptr, system, drive) : origin.set_up;
    std::string options;
    for (const auto& [name, given] : {std::pair("M", acts(drive.loads)), std::pair("states", !drive.states.empty()),
                                      std::pair("events", !drive.events.empty()), std::pair("belt", acts(drive.belts)),
                                      std::pair("base", !drive.base.components().empty())}) {
        if (given) options += fmt::format("{0} = {0}, ", name);
    }
    append_lines(lines, fmt::format("run = sys:simulate{{ {}theta0 = {}, velocity0 = {}, t_start = {}, t_end = {}, {}, "
                                    "integrator = {} }}",
                                    options, by_body(system, drive.theta0), by_body(system, drive.velocity0),
                                    origin.window.start, origin.window.end, rows_text(origin.rows),
                                    lua_text(origin.integrator)));
    return lines;
}

}  // namespace dinal::source
