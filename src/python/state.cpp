#include "python/state.hpp"

#include <stdio_ext.h>
#include <unistd.h>
#include <csignal>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "help/library.hpp"
#include "lua/bind.hpp"
#include "lua/error_memory.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "terminal/progress.hpp"
#include "text/not_copied.hpp"

namespace dinal::python {
namespace {

// Protected by Python's lock (the GIL), except for the signal handler.
lua_State* running = nullptr;
std::vector<int> released;
std::vector<PyObject*> to_drop;  // values that the owner's thread has dropped while others run
unsigned long owner_thread = 0;  // thread of the present Lua call; 0: none
int calls_within = 0;            // nesting depth of its calls
bool is_torn = false;            // whether this process was forked during a call of another thread
unsigned long main_thread = 0;
PyThreadState* unlocked = nullptr;              // state of the owner's thread while others run
auto* const last_exception = new py::object();  // exception of a function in the present call
std::mutex waiting;
std::condition_variable left;

std::atomic<bool> main_is_in_lua = false;
std::atomic<void (*)(int)> handler_of_python = nullptr;

extern "C" void on_interrupt(int signal) {
    if (main_is_in_lua) lua::request_stop(lua::Stop::interrupted);
    if (auto* next = handler_of_python.load()) next(signal);
}

/// Installs dinal's handler before Python's, which only records the signal. Repeated at each call, because
/// signal.signal() replaces it.
void watch_interrupts() {
    struct sigaction now {};
    sigaction(SIGINT, nullptr, &now);
    const bool special = (now.sa_flags & SA_SIGINFO) != 0;
    if (special || now.sa_handler == SIG_DFL || now.sa_handler == SIG_IGN || now.sa_handler == on_interrupt) return;
    handler_of_python = now.sa_handler;
    now.sa_handler = on_interrupt;
    sigaction(SIGINT, &now, nullptr);
}

void flush_python() {
    PyObject* out = PySys_GetObject("stdout");  // borrowed reference
    PyObject* done = out == nullptr || out == Py_None ? nullptr : PyObject_CallMethod(out, "flush", nullptr);
    if (PyErr_Occurred() != nullptr) PyErr_WriteUnraisable(out);
    Py_XDECREF(done);
}

/// Lets one thread at a time into Lua: a Python function called by Lua may let other Python threads run.
class Turn : text::NotCopied {
public:
    Turn() {
        const unsigned long self = PyThread_get_thread_ident();
        while (owner_thread != 0 && owner_thread != self) wait();
        owner_thread = self;
        if (++calls_within > 1) return;
        if (self == main_thread) watch_interrupts();
        main_is_in_lua = self == main_thread;
        scope_.emplace(running);
    }
    ~Turn() {
        if (--calls_within > 0) return;
        const py::object dropped = std::move(*last_exception);  // releases the frames that it keeps
        flush_output();
        scope_.reset();
        main_is_in_lua = false;
        owner_thread = 0;
        left.notify_one();
    }

private:
    /// Keeps the order of Lua's and Python's output.
    static void flush_output() {
        if (__fpending(stdout) == 0) return;
        flush_python();
        static_cast<void>(std::fflush(stdout));
    }
    static void wait() {
        if (is_torn) {
            PyErr_SetString(PyExc_RuntimeError,
                            "dinal cannot be used here: this process was forked while another thread was in a call of "
                            "dinal; fork before that, or use multiprocessing's method \"spawn\"");
        } else {
            EndsHere guard;
            PyThreadState* self = PyEval_SaveThread();
            std::unique_lock lock(waiting);
            left.wait_for(lock, std::chrono::milliseconds(20));
            lock.unlock();
            PyEval_RestoreThread(self);
            guard.passed();
        }
        if (is_torn || PyErr_CheckSignals() != 0) throw py::error_already_set();
    }

    std::optional<lua::InterruptScope> scope_;
};

struct Job {
    py::object (*body)(lua_State* L, const void* data);
    const void* data;
    py::object result = {};
    std::optional<py::error_already_set> failure = {};
};

int do_job(lua_State* L) {
    auto& job = *static_cast<Job*>(lua_touserdata(L, 1));
    lua_settop(L, 0);
    for (const int reference : released) luaL_unref(L, LUA_REGISTRYINDEX, reference);
    released.clear();
    EndsHere guard;
    try {
        job.result = job.body(L, job.data);
        guard.passed();
        return 0;
    } catch (const py::error_already_set& raised) {
        job.failure = raised;
        guard.passed();
        return 0;
    } catch (const py::builtin_exception& raised) {
        raised.set_error();
    } catch (const std::exception& raised) {
        PyErr_SetString(PyExc_RuntimeError, raised.what());
    }
    job.failure = py::error_already_set();
    guard.passed();
    return 0;
}

[[noreturn]] void throw_exception(const py::object& exception) {
    PyErr_Restore(py::type::of(exception).inc_ref().ptr(), exception.inc_ref().ptr(),
                  PyException_GetTraceback(exception.ptr()));
    throw py::error_already_set();
}

[[noreturn]] void throw_interrupt() {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (*last_exception && !py::isinstance(*last_exception, py::handle(PyExc_Exception)))
        throw_exception(*last_exception);
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
}

/// Converts an error value to the exception that Python raises; receives the value and a py::object.
int take_exception(lua_State* L) {
    auto& exception = *static_cast<py::object*>(lua_touserdata(L, 2));
    lua_settop(L, 1);
    const lua::Remarks* remarks = lua::remembered_remarks(L, 1);
    const std::string during = remarks != nullptr ? remarks->during : "";
    if (auto* own = lua::test<Held>(L, 1); own != nullptr && PyExceptionInstance_Check(own->value.ptr()) != 0) {
        exception = hooks().attr("noted")(own->value, during);
        own->value = py::none();  // Lua may keep the error for long, and an exception keeps all variables of its frames
        return 0;
    }
    luaL_tolstring(L, 1, nullptr);
    const std::string message(lua::text_at(L, -1));
    const text::Error* facts = lua::facts_of(L, message);
    const text::Error known = facts != nullptr ? *facts : text::Error{};
    const py::object cause = *last_exception ? *last_exception : py::none();
    exception = hooks().attr("error_of")(cause, facts != nullptr, py::bytes(message + during), py::bytes(known.call),
                                         py::bytes(known.option), py::bytes(known.culprit));
    return 0;
}

int object_text(lua_State* L) {
    need_python();
    const auto* own = lua::test<Held>(L, 1);
    if (own == nullptr) return lua::push_text(L, "?");
    if (PyExceptionInstance_Check(own->value.ptr()) == 0)
        return lua::push_text(L, py::repr(own->value).cast<std::string>());
    const auto name = py::type::of(own->value).attr("__name__").cast<std::string>();
    const auto words = py::str(own->value).cast<std::string>();
    return lua::push_text(L, words.empty() ? name : name + ": " + words);
}

constexpr lua::Member object_members[] = {{lua::a_metamethod<object_text>("__tostring"), {"", "", ""}}};
const lua::Class object_class = {"Python object", {"", "", ""}, object_members};

/// os.exit like sys.exit, because a plain exit() would skip `finally` and atexit.
int exit_of_python(lua_State* L) {
    need_python();
    const lua_Integer code = lua_isboolean(L, 1) ? 1 - lua_toboolean(L, 1) : luaL_optinteger(L, 1, 0);
    PyErr_SetObject(PyExc_SystemExit, py::int_(code).ptr());
    raise_exception(L, py::error_already_set());
}

/// Calls Lua's print, its upvalue, which writes at once, after flushing Python's output.
int print_after_python(lua_State* L) {
    need_python();
    flush_python();
    terminal::make_way_for_output(true);
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, lua_gettop(L) - 1, 0);
    return 0;
}

int open(lua_State* L) {
    luaL_openlibs(L);
    lua_getglobal(L, "print");
    lua_pushcclosure(L, lua::guarded<print_after_python>, 1);
    lua_setglobal(L, "print");
    lua_getglobal(L, LUA_OSLIBNAME);
    lua_pushcfunction(L, lua::guarded<exit_of_python>);
    lua_setfield(L, -2, "exit");
    help::open_library(L);
    lua::add_class<Held>(L, object_class);
    lua_gc(L, LUA_GCGEN, 0, 0);
    return 0;
}

}  // namespace

/// Opens the Lua state. It is never closed: Python may keep its objects until the process ends.
void open_state() {
    running = luaL_newstate();
    if (running == nullptr) throw std::bad_alloc();
    lua_pushcfunction(running, open);
    if (lua_pcall(running, 0, 0, 0) != LUA_OK) throw std::runtime_error(std::string(lua::text_at(running, -1)));
    lua_settop(running, 0);
    lua::install_stop_handlers();
    main_thread = py::module_::import("threading").attr("main_thread")().attr("ident").cast<unsigned long>();
}

void after_fork() {
    is_torn = owner_thread != 0 && owner_thread != PyThread_get_thread_ident();
    new (&waiting) std::mutex;  // its owner is not in this process
    new (&left) std::condition_variable;
}

Unlocked::Unlocked() {
    unlocked = PyEval_SaveThread();
}

Unlocked::~Unlocked() {
    need_python();
}

void need_python() {
    if (owner_thread != PyThread_get_thread_ident() || unlocked == nullptr) return;
    EndsHere guard;
    PyEval_RestoreThread(std::exchange(unlocked, nullptr));
    guard.passed();
    for (PyObject* value : std::exchange(to_drop, {})) Py_DECREF(value);
}

void drop(py::object&& value) {
    if (owner_thread == PyThread_get_thread_ident() && unlocked != nullptr) {
        to_drop.push_back(value.release().ptr());
    } else {
        const py::object last = std::move(value);
    }
}

py::object call_protected(py::object (*body)(lua_State* L, const void* data), const void* data) {
    need_python();
    const Turn turn;
    lua_State* L = running;
    if (lua_checkstack(L, LUA_MINSTACK) == 0) throw std::bad_alloc();
    Job job{body, data};
    lua_pushcfunction(L, do_job);
    lua_pushlightuserdata(L, &job);
    if (lua_pcall(L, 1, 0, 0) == LUA_OK) {
        if (job.failure) throw py::error_already_set(*job.failure);
        return std::move(job.result);
    }
    py::object exception;
    lua_pushcfunction(L, lua::guarded<take_exception>);
    lua_insert(L, -2);
    lua_pushlightuserdata(L, &exception);
    const bool interrupted = lua::stop_requested() == lua::Stop::interrupted;
    const bool taken = !interrupted && lua_pcall(L, 2, 0, 0) == LUA_OK;
    if (!taken) lua_pop(L, interrupted ? 3 : 1);
    if (interrupted) throw_interrupt();
    if (!taken || !exception) throw std::bad_alloc();
    throw_exception(exception);
}

EndsHere::~EndsHere() {
    while (!passed_ && std::uncaught_exceptions() == exceptions_) ::pause();
}

RunningOn::RunningOn(lua_State* L) : before_(running) {
    running = L;
}

RunningOn::~RunningOn() {
    running = before_;
}

void raise_exception(lua_State* L, const py::error_already_set& raised) {
    *last_exception = raised.value();
    if (raised.trace()) PyException_SetTraceback(last_exception->ptr(), raised.trace().ptr());
    // SystemExit and KeyboardInterrupt stop everything: neither pcall nor a point of a sweep may catch them.
    if (!py::isinstance(*last_exception, py::handle(PyExc_Exception))) lua::request_stop(lua::Stop::interrupted);
    luaL_checkstack(L, 3, "for an exception");
    lua::push(L, Held(*last_exception));
    lua_error(L);
    std::terminate();  // unreachable
}

void release(int reference) {
    released.push_back(reference);
}

}  // namespace dinal::python
