#include "python/state.hpp"

#include <pybind11/numpy.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "lua/lua_text.hpp"
#include "lua/user_function.hpp"
#include "lua/vector.hpp"
#include "text/not_copied.hpp"

namespace dinal::python {
namespace {

struct Reference {
    PyObject_HEAD   // a macro with its own semicolon
        int place;  // in the registry
};

void forget_reference(PyObject* self) {
    PyTypeObject* type = Py_TYPE(self);
    release(reinterpret_cast<Reference*>(self)->place);
    type->tp_free(self);
    Py_DECREF(type);
}

py::object reference_to(lua_State* L, int index) {
    const lua::Class* owner = lua::documented(L, index).owner;
    const char* name = lua_isfunction(L, index) ? "function" : owner != nullptr ? owner->name : "";
    auto* type = reinterpret_cast<PyTypeObject*>(hooks().attr("type_for")(name).ptr());
    auto made = py::reinterpret_steal<py::object>(type->tp_alloc(type, 0));
    if (!made) throw py::error_already_set();
    luaL_checkstack(L, 2, "too many values");
    lua_pushvalue(L, index);
    reinterpret_cast<Reference*>(made.ptr())->place = luaL_ref(L, LUA_REGISTRYINDEX);
    return made;
}

// ---- from Lua

/// Limits the depth of conversions, which use the C++ stack.
void check_depth(int depth) {
    constexpr int deepest = 100;
    if (depth <= deepest) return;
    PyErr_SetString(PyExc_ValueError,
                    "a value within more than 100 others is too deep to pass between Lua and Python: make it flatter");
    throw py::error_already_set();
}

using Seen = std::unordered_map<const void*, py::object>;  // tables that may contain themselves
py::object value_to_python(lua_State* L, int index, Seen& seen, int depth);

/// Fills a record in a fixed order, unlike Lua's: first that of `names` in the metatable, as for rows of data, then
/// numbers, then names alphabetically.
void fill_record(lua_State* L, int index, py::object& record, Seen& seen, int depth) {
    const int top = lua_gettop(L);
    if (luaL_getmetafield(L, index, "names") == LUA_TTABLE) {
        for (lua_Integer i = 1; lua_rawgeti(L, top + 1, i) == LUA_TSTRING; ++i, lua_settop(L, top + 1)) {
            lua_pushvalue(L, -1);
            if (lua_rawget(L, index) != LUA_TNIL) {
                record[value_to_python(L, -2, seen, depth)] = value_to_python(L, -1, seen, depth);
            }
        }
    }
    lua_settop(L, top);
    struct Field {
        int rank;
        double number;
        std::string_view name;
        py::object key, value;
    };
    std::vector<Field> others;
    for (lua_pushnil(L); lua_next(L, index) != 0; lua_pop(L, 1)) {
        const bool is_number = lua_type(L, -2) == LUA_TNUMBER, is_name = lua_type(L, -2) == LUA_TSTRING;
        py::object key = value_to_python(L, -2, seen, depth);
        if (is_name && record.contains(key)) continue;
        others.push_back({is_number ? 0
                          : is_name ? 1
                                    : 2,
                          is_number ? lua_tonumber(L, -2) : 0, is_name ? lua::text_at(L, -2) : std::string_view(),
                          std::move(key), value_to_python(L, -1, seen, depth)});
    }
    std::ranges::stable_sort(others, [](const Field& a, const Field& b) {
        return std::tie(a.rank, a.number, a.name) < std::tie(b.rank, b.number, b.name);
    });
    for (const Field& field : others) record[field.key] = field.value;
}

/// A list if the table has no other fields, otherwise a Record.
py::object table_to_python(lua_State* L, int index, Seen& seen, int depth) {
    check_depth(depth);
    luaL_checkstack(L, LUA_MINSTACK, "too many tables in tables");
    const void* identity = lua_topointer(L, index);
    if (const auto found = seen.find(identity); found != seen.end()) return found->second;
    index = lua_absindex(L, index);
    const auto length = static_cast<py::ssize_t>(lua_rawlen(L, index));
    py::ssize_t listed = 0;
    bool is_list = length > 0;
    for (lua_pushnil(L); lua_next(L, index) != 0; lua_pop(L, 1), ++listed) {
        const lua_Integer key = lua_isinteger(L, -2) != 0 ? lua_tointeger(L, -2) : 0;
        is_list = is_list && key >= 1 && key <= length;
    }
    if (is_list && listed == length) {
        py::list list;
        seen[identity] = list;
        for (py::ssize_t i = 1; i <= length; ++i, lua_pop(L, 1)) {
            lua_rawgeti(L, index, i);
            list.append(value_to_python(L, -1, seen, depth + 1));
        }
        return list;
    }
    py::object record = seen[identity] = hooks().attr("Record")();
    fill_record(L, index, record, seen, depth + 1);
    return record;
}

py::object value_to_python(lua_State* L, int index, Seen& seen, int depth) {
    switch (lua_type(L, index)) {
        case LUA_TNONE:
        case LUA_TNIL:
            return py::none();
        case LUA_TBOOLEAN:
            return py::bool_(lua_toboolean(L, index) != 0);
        case LUA_TNUMBER:
            if (lua_isinteger(L, index) != 0) return py::int_(lua_tointeger(L, index));
            return py::float_(lua_tonumber(L, index));
        case LUA_TSTRING: {
            const std::string_view text = lua::text_at(L, index);
            return py::reinterpret_steal<py::object>(
                PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "surrogateescape"));
        }
        case LUA_TTABLE:
            return table_to_python(L, index, seen, depth);
        default:
            break;
    }
    if (const lua::Foreign* own = lua::foreign(L, index)) {
        return py::reinterpret_borrow<py::object>(static_cast<PyObject*>(own->function.get()));
    }
    if (const auto* vector = lua::test<lua::Vector>(L, index)) return numbers_to_python(*vector);
    const auto* own = lua::test<Held>(L, index);
    return own != nullptr ? own->value : reference_to(L, index);
}

// ---- Python functions in Lua

/// The arguments of a call; the place before them is for Python's use.
struct Arguments : text::NotCopied {
    static constexpr int most = 16;
    std::array<PyObject*, most + 1> places;  // uninitialised, because a call of M must be fast
    int count = 0;

    Arguments() { places[0] = nullptr; }  // NOLINT(cppcoreguidelines-pro-type-member-init)
    ~Arguments() {
        while (count > 0) Py_DECREF(places[static_cast<std::size_t>(count--)]);
    }
    void add(py::object value) { places[static_cast<std::size_t>(++count)] = value.release().ptr(); }
};

/// Copies changes that the function made to its copy back to the table at `index`: an action sets states.
void give_back(lua_State* L, int index, py::handle copy) {
    lua_Integer place = 0;
    for (const py::handle key_or_item : copy) {
        const bool is_list = PyList_Check(copy.ptr()) != 0;
        is_list ? lua_pushinteger(L, ++place) : to_lua(L, key_or_item);
        to_lua(L, is_list ? py::reinterpret_borrow<py::object>(key_or_item) : copy[key_or_item]);
        lua_settable(L, index);
    }
}

int push_results(lua_State* L, const py::object& result) {
    if (result.is_none()) return 0;
    if (PyTuple_Check(result.ptr()) == 0) {
        to_lua(L, result);
        return 1;
    }
    const auto several = py::reinterpret_borrow<py::tuple>(result);
    luaL_checkstack(L, static_cast<int>(several.size()) + LUA_MINSTACK, "too many results");
    for (const py::handle one : several) to_lua(L, one);
    return static_cast<int>(several.size());
}

/// Passes exactly the required number of arguments, like Lua: ignores additional ones, and fills with nil.
int call_function(lua_State* L, const lua::Foreign& foreign) {
    Arguments arguments;
    const int given = lua_gettop(L);
    const int wanted = std::min(foreign.parameters > Arguments::most ? given : foreign.parameters, Arguments::most);
    for (int i = 1; i <= wanted; ++i) arguments.add(to_python(L, i));
    EndsHere guard;
    const auto result = py::reinterpret_steal<py::object>(
        PyObject_Vectorcall(static_cast<PyObject*>(foreign.function.get()), arguments.places.data() + 1,
                            static_cast<std::size_t>(wanted) | PY_VECTORCALL_ARGUMENTS_OFFSET, nullptr));
    guard.passed();
    if (!result) throw py::error_already_set();
    for (int i = 1; i <= wanted; ++i) {
        if (lua_istable(L, i)) give_back(L, i, arguments.places.at(static_cast<std::size_t>(i)));
    }
    return push_results(L, result);
}

/// Lets no Python exception escape: Lua's C++ code would take it for an unknown error.
int call_from_lua(lua_State* L) {
    need_python();
    const RunningOn note(L);
    try {
        return call_function(L, lua::foreign_here(L));
    } catch (const py::error_already_set& raised) {
        raise_exception(L, raised);
    }
}

void function_to_lua(lua_State* L, py::handle function) {
    const auto parameters = hooks().attr("parameters_of")(function).cast<int>();
    const std::shared_ptr<void> kept(function.inc_ref().ptr(), [](void* own) {
        Held(py::reinterpret_steal<py::object>(static_cast<PyObject*>(own)));
    });
    lua::push_foreign(L, {kept, parameters, "Python"}, lua::guarded<call_from_lua>);
}

// ---- to Lua

void integer_to_lua(lua_State* L, PyObject* value) {
    int too_large = 0;
    const long long number = PyLong_AsLongLongAndOverflow(value, &too_large);
    if (too_large == 0) return lua_pushinteger(L, number);
    const double real = PyLong_AsDouble(value);
    if (PyErr_Occurred() != nullptr) throw py::error_already_set();
    lua_pushnumber(L, real);
}

void text_to_lua(lua_State* L, PyObject* value) {
    Py_ssize_t size = 0;
    const char* text = PyUnicode_AsUTF8AndSize(value, &size);
    if (text != nullptr) return static_cast<void>(lua_pushlstring(L, text, static_cast<std::size_t>(size)));
    PyErr_Clear();  // it is not valid Unicode
    const auto bytes = py::reinterpret_steal<py::object>(PyUnicode_AsEncodedString(value, "utf-8", "surrogateescape"));
    if (!bytes) throw py::error_already_set();
    to_lua(L, bytes);
}

/// Other types than Python's own numbers, texts, lists and dictionaries.
void other_to_lua(lua_State* L, py::handle value, int depth) {
    const bool is_array = py::isinstance<py::array_t<double>>(value) && !py::hasattr(value, "filled");  // not masked
    if (is_array && py::reinterpret_borrow<py::array>(value).ndim() == 1) {
        const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(value);
        if (!array) throw py::error_already_set();
        std::vector<double> numbers = lua::new_numbers(L, static_cast<std::size_t>(array.size()));
        std::copy_n(array.data(), array.size(), numbers.begin());
        return static_cast<void>(lua::push_vector(L, std::move(numbers)));
    }
    const py::object plain = hooks().attr("plain")(value);
    if (!plain.is(value)) return to_lua(L, plain, depth + 1);
    if (PyCallable_Check(value.ptr()) != 0) return function_to_lua(L, value);
    lua::push(L, Held(plain));
}

/// A tuple with a final dictionary also has named entries: ("motor", "load", dict(k=90)), (x, y, dict(label="y")).
void list_to_lua(lua_State* L, const py::tuple& list, bool is_tuple, int depth) {
    const std::size_t last = list.empty() ? 0 : list.size() - 1;
    const bool named = is_tuple && last > 0 && PyDict_Check(list[last].ptr()) != 0 && PyDict_Check(list[0].ptr()) == 0;
    table_to_lua(L, named ? py::tuple(list[py::slice(0, static_cast<py::ssize_t>(last), 1)]) : list,
                 named ? py::dict(list[last]) : py::dict(), depth);
}

}  // namespace

PyTypeObject* reference_type() {
    static PyTypeObject* const type = [] {
        static PyType_Slot slots[] = {{Py_tp_dealloc, reinterpret_cast<void*>(forget_reference)}, {0, nullptr}};
        static PyType_Spec spec = {"dinal._dinal.Reference", sizeof(Reference), 0,
                                   Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_DISALLOW_INSTANTIATION, slots};
        return reinterpret_cast<PyTypeObject*>(PyType_FromSpec(&spec));
    }();
    return type;
}

py::object numbers_to_python(const lua::Vector& vector) {
    const py::capsule keeps(new lua::Vector(vector), [](void* kept) { delete static_cast<lua::Vector*>(kept); });
    py::array_t<double> array(static_cast<py::ssize_t>(vector.size()), vector.begin(), keeps);
    array.attr("flags").attr("writeable") = false;
    return array;
}

py::object to_python(lua_State* L, int index) {
    if (lua_type(L, index) == LUA_TNUMBER && lua_isinteger(L, index) == 0) return py::float_(lua_tonumber(L, index));
    Seen seen;
    return value_to_python(L, index, seen, 0);
}

void to_lua(lua_State* L, py::handle value, int depth) {
    check_depth(depth);
    luaL_checkstack(L, LUA_MINSTACK, "too many values");
    PyObject* own = value.ptr();
    if (own == Py_None) return lua_pushnil(L);
    if (PyFloat_Check(own)) return lua_pushnumber(L, PyFloat_AS_DOUBLE(own));
    if (PyBool_Check(own)) return lua_pushboolean(L, own == Py_True ? 1 : 0);
    if (PyLong_Check(own)) return integer_to_lua(L, own);
    if (PyUnicode_Check(own)) return text_to_lua(L, own);
    if (PyBytes_Check(own)) {
        lua_pushlstring(L, PyBytes_AS_STRING(own), static_cast<std::size_t>(PyBytes_GET_SIZE(own)));
    } else if (PyObject_TypeCheck(own, reference_type())) {
        lua_rawgeti(L, LUA_REGISTRYINDEX, reinterpret_cast<Reference*>(own)->place);
    } else if (PyDict_Check(own)) {
        table_to_lua(L, py::tuple(), py::reinterpret_borrow<py::dict>(value), depth);
    } else if (PyList_Check(own) || PyTuple_Check(own)) {
        list_to_lua(L, py::tuple(py::reinterpret_borrow<py::object>(value)), PyTuple_Check(own) != 0, depth);
    } else {
        PyFunction_Check(own) ? function_to_lua(L, value) : other_to_lua(L, value, depth);
    }
}

void table_to_lua(lua_State* L, const py::tuple& list, const py::dict& fields, int depth) {
    lua_createtable(L, static_cast<int>(list.size()), static_cast<int>(fields.size()));
    lua_Integer place = 0;
    for (const py::handle item : list) {
        to_lua(L, item, depth + 1);
        lua_rawseti(L, -2, ++place);
    }
    for (const auto& [key, value] : fields) {
        const auto kept = py::reinterpret_borrow<py::object>(value);  // user code may change the dictionary meanwhile
        to_lua(L, py::reinterpret_borrow<py::object>(key), depth + 1);
        to_lua(L, kept, depth + 1);
        lua_settable(L, -3);  // raises an error for the key None or nan
    }
}

}  // namespace dinal::python
