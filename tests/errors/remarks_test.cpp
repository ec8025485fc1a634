// The remarks on an error come from its facts, not from the words of its sentence: the sentences here do not occur in
// the program.
#include "errors/error_remarks.hpp"

#include <memory>
#include <string>

#include "help/library.hpp"
#include "lua/bind.hpp"
#include "prompt/call.hpp"
#include "source/function_source.hpp"
#include "support/catch.hpp"

using dinal::text::Error;

namespace {

int refuse(lua_State* L) {
    dinal::lua::raise(L, *static_cast<const Error*>(lua_touserdata(L, lua_upvalueindex(1))));
}

/// What the user reads when he runs the chunk, in which any call of make() or sys:ask() raises the error.
std::string told(const Error& error, const std::string& chunk) {
    const std::unique_ptr<lua_State, void (*)(lua_State*)> state(luaL_newstate(), lua_close);
    lua_State* L = state.get();
    luaL_openlibs(L);
    dinal::help::open_library(L);
    lua_pushlightuserdata(L, const_cast<Error*>(&error));  // never written through
    lua_pushcclosure(L, dinal::lua::guarded<refuse>, 1);
    lua_setglobal(L, "make");
    REQUIRE(luaL_dostring(L, "sys = { ask = make }") == LUA_OK);
    dinal::source::keep_source(L, "=lab", chunk);
    REQUIRE(luaL_loadbuffer(L, chunk.data(), chunk.size(), "=lab") == LUA_OK);
    REQUIRE(dinal::prompt::call(L, 0, 0) == LUA_ERRRUN);
    return dinal::prompt::take_text(L);
}

}  // namespace

TEST_CASE("a sentence in other words leaves the mark where it is: below the option", "[errors]") {
    for (const char* sentence : {"make: I = -1 must be positive", "nothing weighs less than nothing",
                                 "'k' and 'make': I have no idea what 'is' wrong with k"}) {
        const Error error{.sentence = sentence, .call = "make", .option = "I", .culprit = "-1"};
        CHECK(told(error, "local is = 1\nlocal a = make{ k = is,\n    I = -1 }\n") ==
              "lab:2: " + std::string(sentence) + "\n   3 | I = -1 }\n     | ^");
    }
}

TEST_CASE("a name that does not exist is marked as it stands: alone or in quotes", "[errors]") {
    const Error error{.sentence = "what is that", .call = "sys:ask", .culprit = "thta"};
    CHECK(told(error, "local a = 1\nsys:ask{ thta = 1 }") ==
          "lab:2: what is that\n   2 | sys:ask{ thta = 1 }\n     |          ^^^^");
    CHECK(told(error, "local a = 1\nsys:ask{ columns = \"thta\" }") ==
          "lab:2: what is that\n   2 | sys:ask{ columns = \"thta\" }\n     |                    ^^^^^^");
    CHECK(told(error, "local a = 1\nlocal b = sys.ask(a)") ==
          "lab:2: what is that\n   2 | local b = sys.ask(a)\n     |           ^^^");
}

TEST_CASE("a value that stands once in the line is marked; if it stands twice, the call is marked", "[errors]") {
    const Error error{.sentence = "not so", .call = "make", .culprit = "4"};
    CHECK(told(error, "local a = 1\nmake(1, 4)") == "lab:2: not so\n   2 | make(1, 4)\n     |         ^");
    CHECK(told(error, "local a = 1\nmake(4, 4)") == "lab:2: not so\n   2 | make(4, 4)\n     | ^^^^");
}

TEST_CASE("the global that is nil is found for the option that is missing, and for no other", "[errors]") {
    const Error error{.sentence = "say when", .call = "make", .option = "t_end", .culprit = "nil"};
    CHECK(
        told(error, "tEnd = 3\nmake{ M = nothing, t_end = tend }") ==
        "lab:2: say when; 'tend' is nil; did you mean 'tEnd'?\n   2 | make{ M = nothing, t_end = tend }\n     |          "
        "                  ^^^^");
    CHECK(told(error, "tEnd = 3\nmake{ M = nothing }") == "lab:2: say when\n   2 | make{ M = nothing }\n     | ^^^^");
}

TEST_CASE("a nil argument is reported with the name of the undefined global passed for it", "[errors]") {
    CHECK(
        told({.sentence = "a number, please", .call = "sys:ask(t)", .culprit = "nil"}, "local a = 1\nsys:ask(when)") ==
        "lab:2: a number, please; 'when' is nil\n   2 | sys:ask(when)\n     |         ^^^^");
    CHECK(told({.sentence = "a number, please", .call = "sys:ask(t)"}, "local a = 1\nsys:ask(when)") ==
          "lab:2: a number, please\n   2 | sys:ask(when)\n     | ^^^");
}

TEST_CASE("habits of other languages are recognised in the facts of an error: a decimal comma, a file without quotes",
          "[errors]") {
    CHECK_THAT(told({.sentence = "names, please", .call = "make", .culprit = "5"}, "local a = 1\nmake{ k = 0,5 }"),
               Catch::Contains("names, please; a decimal point is a point: 0.5\n"));
    CHECK_THAT(told({.sentence = "no such thing", .culprit = "csv"}, "run = {}\nmake(run.csv)"),
               Catch::Contains("no such thing; write the name of a file in quotes: \"run.csv\"\n"));
}

TEST_CASE("a cure given with an error ends its sentence, and no other remark is added", "[errors]") {
    const Error error{.sentence = "no", .call = "make", .culprit = "nil", .cure = "; did you mean 'x'?"};
    CHECK(told(error, "local a = 1\nmake(when)") == "lab:2: no; did you mean 'x'?\n   2 | make(when)\n     | ^^^^");
}

TEST_CASE("an error without facts is not searched for names", "[errors]") {
    CHECK(told({"make: I needs 'k', got nil: did 'you' mean there is no sys.ask"},
               "local I, k, you = 1, 2, 3\nlocal a = I + k + you, make(sys.aks)") ==
          "lab:2: make: I needs 'k', got nil: did 'you' mean there is no sys.ask"
          "\n   2 | local a = I + k + you, make(sys.aks)\n     | ^");
}

TEST_CASE("the facts go with the error when it is raised again", "[errors]") {
    const Error error{.sentence = "not so", .call = "make", .option = "I"};
    const std::string head = "local function f() make{ I = 1 } end ";
    const std::string mark = "\n     | " + std::string(head.find('I'), ' ') + "^";
    for (const char* again : {
             "local _, e = pcall(f) error(e, 0)",
             "local _, e = pcall(f) error(e)",
             "local _, e = xpcall(f, function(e) return e end) error(e, 0)",
             "local _, e = xpcall(f, debug.traceback) error(e, 0)",
             "local _, e = coroutine.resume(coroutine.create(f)) error(e, 0)",
             "coroutine.wrap(f)()",
             "local _, e = pcall(f) for i = 1, 10 do pcall(system) end error(e, 0)",
         }) {
        INFO(again);
        CHECK_THAT(told(error, head + again), Catch::Contains("lab:1: not so") && Catch::Contains(mark));
    }
    const std::string wrapped = "coroutine.wrap(f){ I = 2 }";
    CHECK(told(error, "local function f()\n    make{ I = 1 }\nend\n" + wrapped) ==
          "lab:4: lab:2: not so\n   4 | " + wrapped + "\n     | " + std::string(wrapped.find('I'), ' ') + "^");
}

TEST_CASE("an error is still reported with its remarks after many others were raised", "[errors]") {
    const Error error{.sentence = "not so", .option = "I"};
    const std::string kept = "local _, first = pcall(make, { I = 1 }) ";
    const std::string others = "for i = 1, 1000 do pcall(nondimensional, { zeta = -i }) end ";
    CHECK_THAT(told(error, kept + others + "error(first, 0)"), Catch::Contains("not so"));
}
