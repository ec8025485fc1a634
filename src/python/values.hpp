// Values of Lua in Python, and the other way round.
#pragma once

#include "lua/bind.hpp"
#include "python/state.hpp"

namespace dinal::python {

/// The type of whatever Lua has that Python has not. Its subclasses are made in Python, one for each class of Lua.
PyTypeObject* reference_type();

/// The value at `index`. A vector is an array on its own memory, which it keeps.
py::object to_python(lua_State* L, int index);

/// Pushes the value. Throws what Python raises meanwhile.
void to_lua(lua_State* L, py::handle value, int depth = 0);

/// Pushes a table with a list and with fields.
void table_to_lua(lua_State* L, const py::tuple& list, const py::dict& fields, int depth = 0);

}  // namespace dinal::python
