// The module dinal._dinal: a Lua state with all of dinal, and tables that describe its members. The package in dinal/
// makes Python classes and functions of them.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "api/animate.hpp"
#include "api/data.hpp"
#include "api/picture.hpp"
#include "help/library.hpp"
#include "lua/standard_globals.hpp"
#include "python/state.hpp"
#include "source/describe.hpp"
#include "source/function_source.hpp"
#include "sweep/sweep_run.hpp"
#include "terminal/display.hpp"
#include "terminal/progress.hpp"
#include "text/version.hpp"

namespace dinal::python {
namespace {

/// The description of a member. `number` is its index in all_members().
py::dict description_of(const lua::Member& member, std::size_t number) {
    constexpr const char* kinds[] = {"function", "method", "field", "metamethod"};
    constexpr const char* option_kinds[] = {"other", "number", "flag", "choice", "text", "numbers"};
    const help::Section* result = help::section_of_result(member.doc.signature);
    py::list options;
    for (const text::Call* call : help::calls_of(member.doc)) {
        const auto lines = help::option_lines(call->options);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const text::Option& option = call->options[i];
            const bool others = i + 1 < lines.size() && call->options[i + 1].instead_of_previous;
            const bool needed = option.otherwise == text::needed && !option.instead_of_previous && !others;
            py::list choices;
            for (const char* choice : option.choices) choices.append(choice);
            options.append(py::make_tuple(lines[i].option, lines[i].name, lines[i].meaning, needed,
                                          option_kinds[static_cast<std::size_t>(option.filled.kind)], choices,
                                          option.wanted));
        }
    }
    py::dict described;
    described["number"] = number;
    described["name"] = std::string(member.name);
    described["kind"] = kinds[static_cast<std::size_t>(member.kind)];
    described["form"] = member.doc.signature;
    described["signature"] = help::signature(member.doc);
    described["summary"] = member.doc.summary;
    described["example"] = member.doc.example;
    described["result"] = result == nullptr ? "" : result->description->name;
    described["options"] = options;
    return described;
}

struct Numbered {
    const lua::Class* owner;
    const lua::Member* member;
    bool is_long;  ///< whether other Python threads may run during the call
};
std::vector<Numbered>& all_members() {
    static auto* all = new std::vector<Numbered>();
    return *all;
}

bool may_be_long(const lua::Member& member) {
    constexpr std::string_view options[] = {"M", "over", "data", "t_end", "period"};
    for (const text::Call* call : help::calls_of(member.doc)) {
        for (const text::Option& option : call->options) {
            if (std::find(std::begin(options), std::end(options), option.name) != std::end(options)) return true;
        }
    }
    return false;
}

/// A list of (title, name, signature, summary, example, prefix of members, members).
py::list sections() {
    py::list all;
    for (const help::Section& section : help::sections()) {
        const lua::Class& owner = *section.description;
        py::list members;
        for (const lua::Member& member : owner.members) {
            members.append(description_of(member, all_members().size()));
            all_members().push_back({&owner, &member, may_be_long(member)});
        }
        all.append(py::make_tuple(section.title, owner.name, owner.doc.signature, owner.doc.summary, owner.doc.example,
                                  section.prefix, members));
    }
    return all;
}

/// Calls the function at `first` with the values after it, these arguments, and the options as a table; or with a
/// single table of all of them, where a single list or dictionary is that table.
py::object call_at(lua_State* L, int first, const py::tuple& arguments, const py::dict& options, bool one_table,
                   bool is_long = true) {
    luaL_checkstack(L, static_cast<int>(arguments.size()) + LUA_MINSTACK, "too many arguments");
    const bool one = arguments.size() == 1;
    if (one_table && !(one && options.empty() && !PyObject_TypeCheck(arguments[0].ptr(), reference_type()))) {
        const bool is_list = one && (py::isinstance<py::list>(arguments[0]) || py::isinstance<py::tuple>(arguments[0]));
        table_to_lua(L, is_list ? py::tuple(arguments[0]) : arguments, options);
    } else {
        for (const py::handle argument : arguments) to_lua(L, argument);
        if (!options.empty()) table_to_lua(L, py::tuple(), options);
    }
    {
        std::optional<Unlocked> others;
        if (is_long) others.emplace();
        lua_call(L, lua_gettop(L) - first, LUA_MULTRET);
    }
    const int count = lua_gettop(L) - first + 1;
    if (count <= 1) return count == 1 ? to_python(L, first) : py::none();
    py::tuple several(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) several[static_cast<std::size_t>(i)] = to_python(L, first + i);
    return several;
}

/// Calls a member of a class on an object, or of a module with `self` None.
py::object call(std::size_t number, py::handle self, const py::tuple& arguments, const py::dict& options,
                bool one_table) {
    const Numbered called = all_members().at(number);
    return in_lua([&](lua_State* L) {
        lua_pushcfunction(L, called.member->call);
        if (!self.is_none()) {
            to_lua(L, self);
        } else if (called.member->kind == lua::Kind::metamethod) {
            lua::push_dinal_table(L);  // a member of the module's table
            lua_getfield(L, -1, called.owner->name);
            lua_remove(L, -2);
        }
        return call_at(L, 1, arguments, options, one_table, called.is_long);
    });
}

py::object call_value(py::handle self, const py::args& arguments, const py::kwargs& options) {
    return in_lua([&](lua_State* L) {
        to_lua(L, self);
        return call_at(L, 1, arguments, options, false);
    });
}

/// The result of a Lua operator, given by Lua's number or a word.
py::object operated(py::handle operation, py::handle left, py::handle right) {
    return in_lua([&](lua_State* L) -> py::object {
        to_lua(L, left);
        if (py::isinstance<py::int_>(operation)) {
            const auto number = operation.cast<int>();
            if (number != LUA_OPUNM) to_lua(L, right);
            lua_arith(L, number);
        } else if (const auto word = operation.cast<std::string>(); word == "element") {
            to_lua(L, right);
            lua_gettable(L, 1);
        } else if (word == "length") {
            return py::int_(luaL_len(L, 1));
        } else if (word == "global") {
            lua::push_dinal_table(L);
            lua_getfield(L, -1, lua_tostring(L, 1));
        } else {
            const lua::Class* owner = word == "card" ? lua::documented(L, 1).owner : nullptr;
            const bool has_card = owner != nullptr && owner->card != nullptr;
            has_card ? lua::push_text(L, owner->card(L, 1, {})) : (luaL_tolstring(L, 1, nullptr), 1);
        }
        return to_python(L, -1);
    });
}

/// HTML for a page: an <svg> of a picture, a table of data; otherwise None.
py::object drawn(py::handle self) {
    constexpr std::size_t rows_shown = 50;
    return in_lua([&](lua_State* L) -> py::object {
        to_lua(L, self);
        if (const auto* data = lua::test<api::DataHandle>(L, 1)) return py::str(api::html_of(**data, rows_shown));
        const auto* picture = lua::test<api::Picture>(L, 1);
        if (picture == nullptr) return py::none();
        const auto svg = api::svg_of(*picture);
        return svg ? py::object(py::str(svg.value())) : py::none();
    });
}

/// The figures of a picture for Matplotlib: title, axes, curves, sticking intervals, whether it is a map.
py::object figures(py::handle self) {
    return in_lua([&](lua_State* L) -> py::object {
        to_lua(L, self);
        const auto array = [](const plots::Numbers& numbers) {
            return py::array_t<double>(static_cast<py::ssize_t>(numbers.values.size()), numbers.values.data());
        };
        const auto axis = [](const plots::Axis& own) {
            const auto limits = own.limits ? py::object(py::make_tuple(own.limits->low, own.limits->high)) : py::none();
            return py::make_tuple(own.label, own.logarithmic, limits);
        };
        py::list all;
        for (const plots::Figure& figure : lua::self<api::Picture>(L, 1, "plot").figures) {
            py::list curves, stuck;
            for (const plots::Curve& curve : figure.curves) {
                curves.append(py::make_tuple(array(curve.x), array(curve.y), curve.label,
                                             plots::style_names[static_cast<std::size_t>(curve.style)],
                                             curve.base ? py::object(array(*curve.base)) : py::none()));
            }
            for (const plots::Interval& interval : figure.stuck)
                stuck.append(py::make_tuple(interval.low, interval.high));
            all.append(
                py::make_tuple(figure.title, axis(figure.x), axis(figure.y), curves, stuck, figure.shades != nullptr));
        }
        return all;
    });
}

/// Calls Lua's sweep with a table of options, or begins a sweep in parts, with the mark of a Python function.
template <lua_CFunction function>
py::object call_sweep(const py::dict& options, const std::string& mark) {
    return in_lua([&](lua_State* L) {
        lua_pushcfunction(L, lua::guarded<function>);
        return call_at(L, 1, mark.empty() ? py::make_tuple(options) : py::make_tuple(options, mark), py::dict(), false);
    });
}

/// The values of a piece of Lua, an expression if possible; `variables` are its local variables.
py::object run_text(const std::string& text, const py::dict& variables) {
    constexpr const char* name = "=dinal.lua";
    const auto names = py::str(", ").attr("join")(variables).cast<std::string>();
    const std::string before = names.empty() ? "" : fmt::format("local {} = ...; ", names);
    return in_lua([&](lua_State* L) {
        for (const std::string& chunk : {fmt::format("{}return {}", before, text), before + text}) {
            lua_settop(L, 0);
            if (luaL_loadbufferx(L, chunk.data(), chunk.size(), name, "t") != LUA_OK) continue;
            source::keep_source(L, name, chunk);
            return call_at(L, 1, py::tuple(variables.attr("values")()), py::dict(), false);
        }
        lua_error(L);
        return py::object();
    });
}

/// For pickle: Lua text that makes the value again, its variables, and the reason if there is no text.
py::object written(py::handle self) {
    return in_lua([&](lua_State* L) -> py::object {
        to_lua(L, self);
        py::dict variables;
        source::ValueText writer(L, [&](int index) -> std::string {
            if (lua_rawequal(L, index, 1) != 0) return "";  // the object itself has no text
            std::string name = fmt::format("python{}", variables.size() + 1);
            variables[name.c_str()] = to_python(L, index);
            return name;
        });
        const std::string expression = writer.expression(1);
        std::string text;
        for (const std::string& global : writer.globals()) text += fmt::format("local {}\n", global);
        const std::string why = writer.remarks().empty() ? "" : writer.remarks().front().substr(3);
        return py::make_tuple(text.empty() ? expression : text + "return " + expression, variables, why);
    });
}

/// For pickle: the columns of data as (name, values, unit), and other fields.
py::object parts(py::handle self) {
    return in_lua([&](lua_State* L) -> py::object {
        to_lua(L, self);
        const api::Data& data = *lua::self<api::DataHandle>(L, 1, "data");
        py::list columns;
        for (const api::DataColumn& column : data.columns) {
            const bool of_words = column.numbers() == nullptr;
            of_words ? columns.append(py::make_tuple(column.name, py::cast(column.words()), column.unit))
                     : columns.append(py::make_tuple(column.name, numbers_to_python(*column.numbers()), column.unit));
        }
        return py::make_tuple(
            columns, data.parameters,
            std::vector<std::string>{data.heading, data.points_of, data.points_over, data.pieces_of, data.dotted_of},
            data.is_spectrum);
    });
}
py::object joined(const py::list& columns, const std::vector<std::string>& parameters,
                  const std::vector<std::string>& words, bool is_spectrum) {
    return in_lua([&](lua_State* L) {
        api::Data data{.columns = {},
                       .heading = words[0],
                       .points_of = words[1],
                       .points_over = words[2],
                       .pieces_of = words[3],
                       .dotted_of = words[4],
                       .is_spectrum = is_spectrum,
                       .parameters = parameters};
        for (const py::handle column : columns) {
            const auto [name, values, unit] = column.cast<std::tuple<std::string, py::object, std::string>>();
            data.columns.push_back(py::isinstance<py::list>(values)
                                       ? api::column_of(name, values.cast<std::vector<std::string>>())
                                       : api::column_of(name, values.cast<std::vector<double>>(), unit));
        }
        api::push_data(L, std::move(data));
        return to_python(L, -1);
    });
}

/// Passes shown objects to a Python function; its errors go to standard error.
template <class Show>
void show(const Show& by_python) {
    try {
        in_lua(by_python);
    } catch (py::error_already_set& raised) {
        raised.discard_as_unraisable("dinal, which shows a picture");
    }
}

void show_picture(const api::Picture& picture, api::Shown where) {
    if (where == api::Shown::in_file) return;
    show([&](lua_State* L) {
        lua::push<api::Picture>(L, picture);
        return hooks().attr("show_picture")(to_python(L, -1));
    });
}

void show_animation(const api::Animation& animation, api::Shown where) {
    if (where == api::Shown::in_file) return;
    show([&](lua_State*) { return hooks().attr("show_animation")(animation.svg); });
}

void set_up(const py::object& objects, bool in_notebook) {
    hooks() = objects;
    api::show_pictures_by(show_picture);
    if (in_notebook) api::show_animations_by(show_animation);
}

}  // namespace

PYBIND11_MODULE(_dinal, module) {
    open_state();
    module.attr("__version__") = DINAL_VERSION;
    module.attr("Reference") = py::reinterpret_borrow<py::object>(reinterpret_cast<PyObject*>(reference_type()));
    module.attr("sections") = sections();
    module.def("call", call);
    module.def("call_value", call_value);
    module.def("operated", operated);
    module.def("drawn", drawn);
    module.def("figures", figures);
    module.def("sweep", [](const py::dict& options) { return call_sweep<sweep::run_sweep>(options, {}); });
    module.def("sweep_in_parts", call_sweep<sweep::sweep_in_parts>);
    module.def("run_text", run_text);
    module.def("written", written);
    module.def("parts", parts);
    module.def("joined", joined);
    module.def("set_up", set_up);
    module.def("after_fork", after_fork);
    module.def("show_no_progress_here", terminal::show_no_progress_here);
}

}  // namespace dinal::python
