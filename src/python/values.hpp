// Conversion of values between Lua and Python.
#pragma once

#include "lua/bind.hpp"
#include "lua/vector.hpp"
#include "python/state.hpp"

namespace dinal::python {

/// The type of Lua objects without a Python equivalent. Python defines a subclass for each class of Lua.
PyTypeObject* reference_type();

/// An array on the vector's memory, which it keeps alive.
py::object numbers_to_python(const lua::Vector& vector);

/// The value at `index`; a vector becomes such an array.
py::object to_python(lua_State* L, int index);

/// Pushes the value. Throws Python's exceptions.
void to_lua(lua_State* L, py::handle value, int depth = 0);

/// Pushes a table with list entries and fields.
void table_to_lua(lua_State* L, const py::tuple& list, const py::dict& fields, int depth = 0);

}  // namespace dinal::python
