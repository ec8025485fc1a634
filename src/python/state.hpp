// The Lua state of the Python module, and calls into it.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <utility>

#include "lua/bind.hpp"
#include "lua/lua_headers.hpp"
#include "lua/vector.hpp"
#include "text/not_copied.hpp"

namespace dinal::python {

namespace py = pybind11;

/// The module dinal._objects, in Python. Never destroyed: Python ends before C++ does.
inline py::object& hooks() {
    static auto* module = new py::object();
    return *module;
}

void open_state();
/// Called in the child of a fork.
void after_fork();

/// Calls body(L, data) as a protected call and returns its result. A Lua error becomes dinal.Error; an exception of a
/// Python function called by Lua is raised again; Ctrl-C becomes KeyboardInterrupt.
py::object call_protected(py::object (*body)(lua_State* L, const void* data), const void* data);

template <class Body>
py::object in_lua(const Body& body) {
    return call_protected(
        [](lua_State* L, const void* data) -> py::object { return (*static_cast<const Body*>(data))(L); }, &body);
}

/// While this object lives, other Python threads run during a long call of Lua. Ends as soon as Lua needs Python.
class Unlocked : text::NotCopied {
public:
    Unlocked();
    ~Unlocked();
};
/// Call from Lua before touching Python. Keeps the lock until the Lua call ends: taking it for each call of an M would
/// be slow if other threads want it.
void need_python();

/// Drops a Python value, or keeps it until Lua next needs Python if others run.
void drop(py::object&& value);

/// A Python value in Lua, which may drop it at any time.
struct Held {
    py::object value;
    explicit Held(py::object own) : value(std::move(own)) {}
    Held(Held&&) noexcept = default;
    Held& operator=(Held&&) = delete;
    ~Held() {
        if (value) drop(std::move(value));
    }
};

/// Guards a call of Python. At its end the interpreter terminates other threads by pthread_exit, which unwinds the
/// stack; Lua's handlers would abort. So the thread waits here until the process ends.
class EndsHere : text::NotCopied {
public:
    EndsHere() = default;
    ~EndsHere();
    void passed() { passed_ = true; }

private:
    int exceptions_ = std::uncaught_exceptions();  // C++ exceptions may pass; a pthread_exit is not one
    bool passed_ = false;
};

/// While this object lives, calls from Python run on this Lua thread, perhaps a coroutine.
class RunningOn : text::NotCopied {
public:
    explicit RunningOn(lua_State* L);
    ~RunningOn();

private:
    lua_State* before_;
};

[[noreturn]] void raise_exception(lua_State* L, const py::error_already_set& raised);

/// Releases a registry value at the next call, as this may be any thread.
void release(int reference);

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
