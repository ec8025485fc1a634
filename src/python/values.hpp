// Values of Lua in Python, and the other way round.
#pragma once

#include "lua/bind.hpp"
#include "lua/vector.hpp"
#include "python/state.hpp"

namespace dinal::python {

/// The type of whatever Lua has that Python has not. Its subclasses are made in Python, one for each class of Lua.
PyTypeObject* reference_type();

/// An array on the memory of the vector, which it keeps.
py::object numbers_to_python(const lua::Vector& vector);

/// The value at `index`; a vector is such an array.
py::object to_python(lua_State* L, int index);

/// Pushes the value. Throws what Python raises meanwhile.
void to_lua(lua_State* L, py::handle value, int depth = 0);

/// Pushes a table with a list and with fields.
void table_to_lua(lua_State* L, const py::tuple& list, const py::dict& fields, int depth = 0);

}  // namespace dinal::python
