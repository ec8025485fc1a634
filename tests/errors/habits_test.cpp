// Habits of users of other languages, and the answers to them: each row of the tables of habits.cpp.

#include <memory>
#include <string>

#include "errors/advice.hpp"
#include "errors/error_remarks.hpp"
#include "help/library.hpp"
#include "prompt/call.hpp"
#include "source/function_source.hpp"
#include "support/catch.hpp"

namespace {

struct Row {
    const char* written;
    const char* said;
};

/// The message of a chunk that fails, or the remark on one that does not compile.
std::string told(const std::string& chunk) {
    const std::unique_ptr<lua_State, void (*)(lua_State*)> state(luaL_newstate(), lua_close);
    lua_State* L = state.get();
    luaL_openlibs(L);
    dinal::help::open_library(L);
    dinal::source::keep_source(L, "=lab", chunk);
    if (luaL_loadbuffer(L, chunk.data(), chunk.size(), "=lab") != LUA_OK) {
        return dinal::errors::remarks_on_syntax(L, -1, nullptr).suggestion;
    }
    REQUIRE(dinal::prompt::call(L, 0, 0) == LUA_ERRRUN);
    return dinal::prompt::take_text(L);
}

void check(const Row& row) {
    INFO(row.written);
    CHECK_THAT(told(row.written), Catch::Matchers::Contains(row.said));
}

}  // namespace

TEST_CASE("a name from another language is answered with the function that does the same here", "[errors]") {
    for (const auto& [name, said] : std::initializer_list<Row>{{"disp", "'print'"},
                                                               {"True", "'true'"},
                                                               {"False", "'false'"},
                                                               {"null", "'nil'"},
                                                               {"t", "function(t)"},
                                                               {"range", "for i = 1, 10 do"},
                                                               {"numel", "is #x"},
                                                               {"str", "'tostring'"},
                                                               {"int", "'math.floor'"},
                                                               {"float", "'tonumber'"},
                                                               {"ln", "'math.log'"},
                                                               {"log10", "math.log(x, 10)"},
                                                               {"log2", "math.log(x, 2)"},
                                                               {"fprintf", "print(string.format("},
                                                               {"sprintf", "'string.format'"},
                                                               {"round", "math.floor(x + 0.5)"},
                                                               {"abs", "v:abs()"},
                                                               {"append", "list[#list + 1] = x"},
                                                               {"enumerate", "ipairs(list)"},
                                                               {"np", "vector.linspace"},
                                                               {"input", "io.read()"},
                                                               {"ayuda", "help()"},
                                                               {"bye", "os.exit()"},
                                                               {"zeros", "linspace(0, 0, n)"},
                                                               {"ones", "linspace(1, 1, n)"},
                                                               {"ode45", "sys:simulate{"},
                                                               {"fft", "run:spectrum()"},
                                                               {"bode", "sys:response{"},
                                                               {"title", "title ="},
                                                               {"legend", "label ="},
                                                               {"plt", "plot(x, y)"},
                                                               {"pd", "load("},
                                                               {"toc", ":time"},
                                                               {"dir", ":who"},
                                                               {"save", "run:save("}}) {
        check({(std::string(name) + "(1)").c_str(), said});
    }
    for (const auto& [name, said] : std::initializer_list<Row>{{"quitter", ":quit"},
                                                               {"clc", "Ctrl-L"},
                                                               {"whos", ":who"},
                                                               {"_", "ans"},
                                                               {"ls", ":ls"},
                                                               {"pwd", ":pwd"},
                                                               {"man", "help \"name\""},
                                                               {"history", "Ctrl-R"},
                                                               {"save", ":save"},
                                                               {"reset", ":reset"},
                                                               {"hola", "?name"}}) {
        CHECK_THAT(dinal::errors::foreign_tokens(name, dinal::errors::Seen::typed), Catch::Matchers::Contains(said));
    }
    CHECK_THAT(dinal::errors::foreign_tokens("cd /tmp", dinal::errors::Seen::running),
               Catch::Matchers::Contains(":cd"));
    CHECK_THAT(dinal::errors::foreign_tokens("ls -l", dinal::errors::Seen::running), Catch::Matchers::Contains(":ls"));
}

TEST_CASE("a phrase of another language is answered by that of Lua", "[errors]") {
    for (const Row& row : std::initializer_list<Row>{{"x = 0:0.1:1", "vector.range("},
                                                     {"%% cell", ":time"},
                                                     {"%matplotlib inline", "run:plot()"},
                                                     {"load file.csv", "in quotes"},
                                                     {"x = v[end]", "v[#v]"},
                                                     {"x = v(end)", "v[#v]"},
                                                     {"x = v .* w", "each element"},
                                                     {"x = v[1:3]", "v:slice("},
                                                     {"x = v[:3]", "v:slice("},
                                                     {"x = v[-1:]", "v:slice("},
                                                     {"f = lambda x: x", "function(x)"},
                                                     {"f = x => x", "function(x)"},
                                                     {"if x => 1 then end", "is >="},
                                                     {"if x <> 1 then end", "~="},
                                                     {"x = [i for i in y]", "v:map("},
                                                     {"x = 'a' % 3", "string.format"},
                                                     {"x = f'{x}'", "string.format"},
                                                     {"list = {} list.append(1)", "#list + 1"},
                                                     {"v = nil print(v.shape[1])", "is #v"},
                                                     {"x = y**2", "x^2"},
                                                     {"> x = 1", "prompt > "},
                                                     {">> x = 1", "prompt >> "},
                                                     {"check(1a, 3)", "in quotes"},
                                                     {"def f(x)", "function f(x)"},
                                                     {"let x = 1", "x = 1"},
                                                     {"from math import pi", "require"},
                                                     {"if x then elif y then end", "'elseif'"},
                                                     {"print x", "print(...)"},
                                                     {"x = 1 PRINT x", "print(x)"},
                                                     {"x = 1 CALL f", "f(x)"},
                                                     {"DO 10", "for i = 1, 10 do"},
                                                     {"cd work", ":cd"},
                                                     {"ls work", ":ls"},
                                                     {"clear x", ":reset"},
                                                     {"close all", "picture of its own"},
                                                     {"hold on", "several curves"},
                                                     {"save x", "run:save("},
                                                     {"help plot", "?name"},
                                                     {"x := 1", "assigning is ="},
                                                     {"x = { I: 1 }", "I = 1"},
                                                     {"for (i = 0; i < 3; i++)", "for i = 1, 10 do"},
                                                     {"f(t) = 2", "f = function(t)"},
                                                     {"if x === 1 then end", "is =="},
                                                     {"x = y 2", "f(2)"},
                                                     {"x = 2 y", "missing there"},
                                                     {"if (x) { y() }", "ends with end"},
                                                     {"x = 2pi", "2*pi"},
                                                     {"x = 3t + 1", "3*t"},
                                                     {"x = 1.5theta", "1.5*theta"},
                                                     {"f = function(t) 3*t end", "return"},
                                                     {"if x thne y() end", "'then'"},
                                                     {"f = fun(x) return x end", "'function'"},
                                                     {"whlie x do end", "'while'"},
                                                     {"run:save x", "run:save"},
                                                     {"x = “a”", "instead of “ write \""},
                                                     {"x = 2×3", "instead of × write *"},
                                                     {"x = y²", "write ^2"},
                                                     {"x = θ", "plain letters"},
                                                     {"x != 1", "~="},
                                                     {"x += 1", "x + 1"},
                                                     {"x -= 1", "x - 1"},
                                                     {"x *= 2", "x * 2"},
                                                     {"x /= 2", "x / 2"},
                                                     {"if x && y then end", "word and"},
                                                     {"if x || y then end", "word or"},
                                                     {"x = y ? 1 : 2", "and this or that"},
                                                     {"x = 1 # one", "--"},
                                                     {"// one", "--"},
                                                     {"% one", "--"},
                                                     {"f = @(t) t", "function(t)"},
                                                     {"x = [1, 2]", "{ 1, 2, 3 }"},
                                                     {"if x = 1 then end", "is =="},
                                                     {"if x > 1: y() end", "if x > 3 then"},
                                                     {"if x is 1 then end", "is =="},
                                                     {"while x = 1 do end", "is =="},
                                                     {"while x: y() end", "while x < 3 do"},
                                                     {"for i in x: y() end", "for i = 1, 10"},
                                                     {"system(I = 1)", "in braces"},
                                                     {"x = 'a", "closing quote"},
                                                     {"x = { I = 1 k = 2 }", "comma"},
                                                     {"system { I = 1, k = 0,5 }", "0.5"},
                                                     {"x = 'a' + 'b'", "joined with .."},
                                                     {"x = {} + 1", "vector("},
                                                     {"for i in 10 do end", "for i = 1, 10 do"},
                                                     {"for i in { 1 } do end", "ipairs"},
                                                     {"x = 3 x()", "no function"},
                                                     {"v = vector { 1 } v(1)", "v[1]"},
                                                     {"theory()", "help(theory)"},
                                                     {"plot = 3 plot(1)", "dinal.plot"},
                                                     {"x = theory.identify.X0", "call it first"},
                                                     {"x = true & 1", "v:find("},
                                                     {"load(run.csv)", "\"run.csv\""}}) {
        check(row);
    }
}
