// The Lua state of the module: who may use it, and how Python calls into it.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <utility>

#include "lua/lua_headers.hpp"

namespace dinal::python {

namespace py = pybind11;

/// The module dinal._objects, in Python. Never destroyed: Python ends before C++ does.
inline py::object& hooks() {
    static auto* module = new py::object();
    return *module;
}

void open_state();
/// In the child of a fork.
void after_fork();

/// Calls body(L, data) as a protected call and returns what it returns. An error of Lua becomes dinal.Error, one of a
/// Python function that Lua called that exception again, Ctrl-C KeyboardInterrupt.
py::object call_protected(py::object (*body)(lua_State* L, const void* data), const void* data);

template <class Body>
py::object in_lua(const Body& body) {
    return call_protected(
        [](lua_State* L, const void* data) -> py::object { return (*static_cast<const Body*>(data))(L); }, &body);
}

/// While it lives, other threads of Python run: Lua is in a call that may be long. It ends as soon as Lua needs Python.
class Unlocked {
public:
    Unlocked();
    ~Unlocked();
    Unlocked(const Unlocked&) = delete;
    Unlocked& operator=(const Unlocked&) = delete;
};
/// To be called by whatever Lua calls before it touches Python. The lock is then kept until the call of Lua ends: to
/// take it anew for each call of an M would be slow where other threads want it, too.
void need_python();

/// A value of Python in Lua, which may drop it at any time.
struct Held {
    py::object value;
    explicit Held(py::object own) : value(std::move(own)) {}
    Held(Held&&) noexcept = default;
    Held& operator=(Held&&) = delete;
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;
    ~Held() {
        if (value) need_python();
    }
};

/// Around a call of Python. When the interpreter ends, it ends other threads by pthread_exit, which unwinds the stack,
/// and Lua's handlers would stop that with an abort. So the thread stays here, and ends with the process.
class EndsHere {
public:
    EndsHere() = default;
    ~EndsHere();
    EndsHere(const EndsHere&) = delete;
    EndsHere& operator=(const EndsHere&) = delete;
    void passed() { passed_ = true; }

private:
    int exceptions_ = std::uncaught_exceptions();  // those of C++ may pass; a pthread_exit is none of them
    bool passed_ = false;
};

/// While it lives, calls from Python continue on this thread of Lua, perhaps a coroutine.
class RunningOn {
public:
    explicit RunningOn(lua_State* L);
    ~RunningOn();
    RunningOn(const RunningOn&) = delete;
    RunningOn& operator=(const RunningOn&) = delete;

private:
    lua_State* before_;
};

/// Raises the exception of Python as a Lua error.
[[noreturn]] void raise_exception(lua_State* L, const py::error_already_set& raised);

/// A value in the registry that Python needs no more. It is given back at the next call: this may be any thread.
void release(int reference);

}  // namespace dinal::python
