#include "source/origin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lua/user_function.hpp"
#include "motion/witness.hpp"
#include "source/describe.hpp"
#include "source/value_text.hpp"
#include "text/characters.hpp"
#include "text/version.hpp"

namespace dinal::source {

namespace {

void append_lines(std::vector<std::string>& lines, std::string_view text) {
    for (;;) {
        const std::size_t end = text.find('\n');
        lines.emplace_back(text.substr(0, end));
        if (end == std::string_view::npos) {
            return;
        }
        text.remove_prefix(end + 1);
    }
}

/// As its author wrote it, where M is nothing but a function.
std::string excitation_text(lua_State* L, const model::Excitation& excitation, ValueText& writer) {
    const lua::LuaFunction* function = function_alone(excitation);
    if (function == nullptr) return describe(L, excitation, &writer);
    function->push(L);
    std::string text = writer.expression(-1);
    lua_pop(L, 1);
    return text;
}

/// "dt = 0.01", or the times themselves, ten to a line.
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

/// "local states = { ... }" and so on, for what the run has.
std::vector<std::string> extras_lines(lua_State* L, const model::Extras& extras, ValueText& writer) {
    std::vector<std::string> lines;
    if (!extras.states.empty()) {
        std::string text;
        for (const model::OwnState& state : extras.states) {
            text += fmt::format("{} {} = {{ start = {}, rate = {} }}", text.empty() ? "" : ",", state.name, state.start,
                                function_text(L, *state.rate, &writer));
        }
        lines.push_back("local states = {" + text + " }");
    }
    if (!extras.events.empty()) {
        std::string text;
        for (const model::WantedEvent& wanted : extras.events) {
            text += fmt::format("{} {{ when = {}", text.empty() ? "" : ",", function_text(L, *wanted.when, &writer));
            if (wanted.direction != model::Crossing::both) {
                text += fmt::format(", direction = \"{}\"", wanted.direction == model::Crossing::up ? "up" : "down");
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
    for (const auto& [name, motion] : {std::pair{"belt", &extras.belt}, std::pair{"base", &extras.base}}) {
        if (!motion->components().empty()) {
            lines.push_back(fmt::format("local {} = {}", name, excitation_text(L, *motion, writer)));
        }
    }
    return lines;
}

/// "states = states, ": what the run had besides M.
std::string extras_text(const model::Extras& extras) {
    std::string text;
    text += extras.states.empty() ? "" : "states = states, ";
    text += extras.events.empty() ? "" : "events = events, ";
    text += extras.belt.components().empty() ? "" : "belt = belt, ";
    text += extras.base.components().empty() ? "" : "base = base, ";
    return text;
}

/// The head of the lines and, behind all that the functions among them use, the declarations that `made` gives.
template <class Made>
std::vector<std::string> set_up_lines(lua_State* L, const model::Units& units, Made made) {
    std::vector<std::string> lines;
    lines.emplace_back("-- dinal " DINAL_VERSION ": without the \"# \" before them, these lines repeat the run");
    if (!units.usual()) lines.push_back(units.in_file());
    ValueText writer(L);
    const std::vector<std::string> declarations = made(writer);
    for (const auto* texts : {&writer.remarks(), &writer.globals(), &declarations}) {
        for (const std::string& text : *texts) append_lines(lines, text);
    }
    return lines;
}

/// Without functions of a user Lua is not asked, and may be null.
std::vector<std::string> set_up_lines(lua_State* L, const Task& task) {
    return set_up_lines(L, task.system.units(), [&](ValueText& writer) {
        std::vector<std::string> lines;
        if (!task.excitation.components().empty()) {
            lines.push_back("local M = " + excitation_text(L, task.excitation, writer));
        }
        for (std::string& line : extras_lines(L, task.extras, writer)) lines.push_back(std::move(line));
        lines.push_back("local sys = " + lua_text(L, task.system, &writer));
        return lines;
    });
}

/// "{ a = 1, b = 2 }", or of one body without a name its number.
std::string by_body(const model::Assembly& system, const std::vector<double>& numbers) {
    if (!system.named) return fmt::format("{}", numbers.front());
    std::string text;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        text += fmt::format("{} {} = {}", text.empty() ? "" : ",", system.bodies[i].name, numbers[i]);
    }
    return "{" + text + " }";
}

/// The line "local M = ..." by body or joint; none where nothing acts.
void append_acting(std::vector<std::string>& lines, lua_State* L, const char* name, const model::Assembly& system,
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
    return std::any_of(acting.begin(), acting.end(), [](const auto& one) { return !one.components().empty(); });
}

}  // namespace

Origin origin_of(lua_State* L, Task task) {
    std::vector<std::string> set_up;
    if (motion::has_functions(task.system, task.excitation, task.extras)) set_up = set_up_lines(L, task);
    return {std::move(task), std::move(set_up)};
}

std::vector<std::string> repeat_lines(const Origin& origin) {
    std::vector<std::string> lines = origin.set_up.empty() ? set_up_lines(nullptr, origin) : origin.set_up;
    append_lines(lines,
                 fmt::format("run = sys:simulate{{ {}{}theta0 = {}, velocity0 = {}, t_start = {}, t_end = {}, {}, "
                             "integrator = {} }}",
                             origin.excitation.components().empty() ? "" : "M = M, ", extras_text(origin.extras),
                             origin.initial.theta, origin.initial.velocity, origin.window.start, origin.window.end,
                             rows_text(origin.rows), lua_text(origin.integrator)));
    return lines;
}

std::vector<std::string> set_up_lines(lua_State* L, const model::Assembly& system, const motion::engine::Drive& drive) {
    return set_up_lines(L, system.units, [&](ValueText& writer) {
        std::vector<std::string> lines;
        append_acting(lines, L, "M", system, drive.loads, writer);
        append_acting(lines, L, "belt", system, drive.belts, writer);
        for (std::string& line : extras_lines(L, {drive.states, drive.events, {}, drive.base}, writer)) {
            lines.push_back(std::move(line));
        }
        lines.push_back("local sys = " + lua_text(L, system, &writer));
        return lines;
    });
}

std::string repeat_line(const model::Assembly& system, const motion::engine::Drive& drive, const motion::Window& window,
                        const motion::Grid& rows, const motion::Integrator& integrator) {
    const std::string by = lua_text(integrator);
    const bool usual = by == lua_text(motion::Integrator(motion::Spectral{}));
    return fmt::format("run = sys:simulate{{ {}{}{}theta0 = {}, velocity0 = {}, t_start = {}, t_end = {}, {}{} }}",
                       acts(drive.loads) ? "M = M, " : "", acts(drive.belts) ? "belt = belt, " : "",
                       extras_text({drive.states, drive.events, {}, drive.base}), by_body(system, drive.theta0),
                       by_body(system, drive.velocity0), window.start, window.end, rows_text(rows),
                       usual ? "" : ", integrator = " + by);
}

}  // namespace dinal::source
