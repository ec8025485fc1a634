#include "fuzz/lua_writer.hpp"

#include <array>
#include <string_view>

namespace {

using Texts = std::span<const std::string_view>;

// In a template, a letter after $ stands for a value of that kind:
//   $n number  $t time or span  $v vector  $e excitation  $i integrator  $s system  $r run  $f function
//   $w word in quotes  $g global variable  $h theory  $a any value  $x statement
constexpr std::array<std::string_view, 34> numbers{
    "0",         "1",    "-1",    "2",         "0.5",     "0.1",      "1e-3",     "3",
    "10",        "100",  "1e6",   "1e15",      "1e-9",    "1e308",    "-1e308",   "5e-324",
    "0/0",       "1/0",  "-1/0",  "math.pi",   "2^53",    "-0.0",     "1000",     "$g",
    "#$v",       "#$r",  "$v[1]", "($n + $n)", "$n * $n", "$v:max()", "$v:sum()", "math.mininteger",
    "$r:at($t)", "$s.T0"};
constexpr std::array<std::string_view, 13> theories{
    "theory.free_response{ t = $v, theta0 = $n, velocity0 = $n, system = $s }",
    "theory.extremes{ system = $s, theta0 = $n, count = $n }",
    "theory.time_to_rest{ system = $s, theta0 = $n, velocity0 = $n }",
    "theory.rest_position{ system = $s, theta0 = $n }",
    "theory.logarithmic_decrement{ zeta = $n }",
    "theory.identify{ X0 = $n, X1 = $n, X2 = $n }",
    "theory.magnification{ r = $v, zeta = $n }",
    "theory.phase_lag{ r = $v, zeta = $v }",
    "theory.linearised{ r = $n, friction_ratio = $n, zeta = $n }",
    "theory.den_hartog{ r = $n, friction_ratio = $n, zeta = $n, breakaway_ratio = $n }",
    "theory.den_hartog_fundamental{ r = $v, friction_ratio = $n }",
    "theory.stop_boundary{ r = $n, zeta = $n, Re_over_Rd = $n }",
    "theory.step_limit{ system = $s }"};

constexpr std::array<std::string_view, 18> times{"1",  "0",   "0.5",   "2",   "3",   "0.25", "0.1", "1e-3", "10",
                                                 "-1", "1e9", "1e-12", "0/0", "1/0", "$n",   "2.5", "$g",   "0.7"};
constexpr std::array<std::string_view, 17> vectors{"vector{ 1, 2, 3 }",
                                                   "vector.linspace($n, $n, $n)",
                                                   "vector.linspace(0, 3, 10)",
                                                   "vector{}",
                                                   "vector{ $n, $n }",
                                                   "($v + $v)",
                                                   "$v * $n",
                                                   "-$v",
                                                   "$v ^ $n",
                                                   "$v:slice($n, $n, $n)",
                                                   "$v:slice(1, 2)",
                                                   "$v:sin()",
                                                   "$v:exp()",
                                                   "$r.theta",
                                                   "$r.t",
                                                   "$e:values($v)",
                                                   "$g"};
constexpr std::array<std::string_view, 27> excitations{
    "excitation.constant{ amplitude = $n }",
    "excitation.harmonic{ amplitude = $n, frequency = $n }",
    "excitation.harmonic{ omega = $n, phase = $n }",
    "excitation.step{ amplitude = $n, at = $t }",
    "excitation.pulse{ at = $t, width = $t }",
    "excitation.pulse{ amplitude = $n, at = $t, width = $n }",
    "excitation.half_sine{ amplitude = $n, at = $t, width = $t }",
    "excitation.gaussian{ amplitude = $n, at = $t, sigma = $t }",
    "excitation.ramp{ slope = $n, at = $t, duration = $t }",
    "excitation.square{ amplitude = $n, period = $t, duty = $n, at = $t }",
    "excitation.square{ frequency = $n }",
    "excitation.sawtooth{ period = $t, at = $t }",
    "excitation.triangle{ amplitude = $n, period = $t, at = $t }",
    "excitation.chirp{ from = $n, to = $n, duration = $t }",
    "excitation.samples{ t = { 0, $t, 3 }, M = { $n, $n, $n } }",
    "excitation.samples{ t = $v, M = $v }",
    "excitation.samples('run.csv', { time = $w, value = $w })",
    "excitation.scripted($f, { breaks = { $t, $t }, period = $t })",
    "excitation.scripted($f)",
    "($e + $e)",
    "($e - $e)",
    "$n * $e",
    "-$e",
    "$e:delay($t)",
    "$e:next_break($t)",
    "$e:window($t, $t)",
    "$g"};
constexpr std::array<std::string_view, 9> integrators{"integrator.rk4{ h = 0.01 }",
                                                      "integrator.rk4{ h = $t }",
                                                      "integrator.dinal1989{ h = 0.01 }",
                                                      "integrator.dinal1989{ h = $t }",
                                                      "integrator.spectral{}",
                                                      "integrator.spectral{ tolerance = $n }",
                                                      "integrator.dopri5{ tolerance = $n }",
                                                      "nil",
                                                      "$g"};
constexpr std::array<std::string_view, 11> systems{
    "nondimensional{}",
    "nondimensional{ zeta = $n }",
    "nondimensional{ friction_ratio = $n }",
    "nondimensional{ zeta = 0.1, friction_ratio = 0.2, breakaway_ratio = 0.3 }",
    "system{ I = $n, k = $n }",
    "system{ I = 1, k = 4, C = $n, Rd = $n, Re = $n }",
    "system{ I = 1, k = 1, Rd = 0.1 }",
    "system{ I = 1, k = $n, spring = spring.polynomial{ [3] = $n }, walls = { lower = -2, upper = 2, restitution = $n } }",
    "system{ I = 1, k = 1, Rd = 0.1, spring = $f, walls = { upper = 1.5, restitution = 0.5 } }",
    "$r.system",
    "$g"};
constexpr std::array<std::string_view, 12> runs{
    "$s:simulate{ theta0 = 1, t_end = 2, dt = 0.1 }",
    "$s:simulate{ M = $e, theta0 = $n, velocity0 = $n, t_end = $t, dt = $t }",
    "$s:simulate{ M = $f, t_end = 2, dt = 0.1, integrator = $i }",
    "$s:simulate{ M = $e, t_start = $t, t_end = $t, times = {} }",
    "$s:simulate{ M = $e, theta0 = $n, times = $v, integrator = $i }",
    "$s:simulate{ M = $n, t_end = 3, dt = $t, integrator = $i }",
    "$s:simulate{ M = $e + $e, velocity0 = 5, t_end = 3, dt = 0.05, integrator = $i }",
    "$s:simulate{ M = $f, theta0 = 1, t_end = 1, times = $v }",
    "load 'run.csv'",
    "load 'run.dat'",
    "dinal.partial",
    "$g"};
constexpr std::array<std::string_view, 14> functions{
    "function(t) return $n end",
    "function(t) return math.sin(t) end",
    "function(t, theta, velocity) return -$n * velocity end",
    "function(t, theta) return theta end",
    "function(t) return t < $t and 1 or $n end",
    "function(t) if t > $t then error 'late' end return 1 end",
    "function(t) return $e(t) end",
    "function(t) $x return 1 end",
    "function(t) return $a end",
    "function(...) return ... end",
    "function(t) return $r:at(t) end",
    "coroutine.wrap(function(t) while true do t = coroutine.yield($n) end end)",
    "math.sin",
    "$g"};
constexpr std::array<std::string_view, 14> words{"'t'",       "'theta'",      "'M'",    "'velocity'",  "'rk4'",
                                                 "'1'",       "''",           "'x'",    "'friction'",  "('x'):rep($n)",
                                                 "'run.csv'", "tostring($a)", "'%s%d'", "\"\\0\\xff\""};
constexpr std::array<std::string_view, 6> globals{"a", "b", "c", "d", "e", "f"};
constexpr std::array<std::string_view, 23> any_values{
    "$n",
    "$h",
    "$v",
    "$e",
    "$s",
    "$r",
    "$f",
    "$i",
    "$w",
    "$g",
    "nil",
    "true",
    "{}",
    "{ $a, $a }",
    "{ [$w] = $a }",
    "$r.events",
    "$r.names",
    "setmetatable({ $n }, { __index = $f, __call = $f, __len = $f, __tostring = $f })",
    "_G",
    "dinal",
    "print",
    "{ t = $v, M = $v }",
    "select(2, pcall($f, $n))"};
constexpr std::array<std::string_view, 42> statements{
    "$g = $n",
    "$g = $v",
    "$g = $e",
    "$g = $s",
    "$g = $r",
    "$g = $f",
    "$g = $i",
    "$g = $a",
    "print($a, $a)",
    "tostring($a)",
    "$r:save('run.csv')",
    "$r:save('run.dat')",
    "$r:save('run.csv', { columns = { $w, $n } })",
    "print($r:at($t), $r:columns($w))",
    "for i in progress($n, $w) do if i > 3 then break end $x end",
    "for i, x in progress($v) do $x if i > 3 then break end end",
    "pcall(function() $x end)",
    "pcall($a, $a, $a)",
    "coroutine.wrap(function() $x coroutine.yield($a) end)()",
    "local x <close> = setmetatable({}, { __close = function() $x end })",
    "for i = 1, 20 do $x end",
    "help($a)",
    "assert($v == $v, $v < $n)",
    "print($h)",
    "$g = $r:continue{ t_end = $t }",
    "$g = $r:energy()",
    "local e = $r:energy() print(e, e.total, e.half_cycles, e.dry - e.input)",
    "print($r:explain())",
    "$g = $r:plot{ x = $w, y = { $w, $w }, ascii = true, width = $n, height = $n, show = false } print($g)",
    "print($r:plot{ y = 'velocity', xlim = { $n, $n }, xticks = $n, ascii = true, show = false })",
    "print($r:phase_plot{ equal = true, ascii = $a, show = false })",
    "print(plot{ { $v, $v, style = 'points' }, { $v, $v, base = $a }, ylim = { $n, $n }, yticks = $v, show = false })",
    "print(plot{ { $v, $v, label = $w }, xlog = true, ylog = $a, title = $w, width = $n, show = false })",
    "$r:plot{ file = 'p.txt', size = { $n, $n } } $r:plot{ file = 'p.svg', title = $w, xlabel = $w }",
    "print(plot{ $g, $r:plot{ show = false }, show = false })",
    "$g = $a .. $w",
    "$g = $a + $a",
    "$g = ($a)[$a]",
    "$g = ($a)($a)",
    "load(tostring($w))",
    "error($a)",
    "$g, $g = $g, $a"};

class Writer {
public:
    explicit Writer(std::span<const std::uint8_t> choices) : choices_(choices) {}

    std::string chunk() {
        std::string text;
        while (!choices_.empty() && text.size() < longest) {
            append(text, choose(statements), 0);
            text += '\n';
        }
        return text;
    }

private:
    static constexpr std::size_t longest = 4000;
    static constexpr int deepest = 6;

    /// The first choice, which is the simplest, when no bytes are left.
    std::size_t pick(std::size_t count) {
        if (choices_.empty()) {
            return 0;
        }
        const std::size_t chosen = choices_.front() % count;
        choices_ = choices_.subspan(1);
        return chosen;
    }
    std::string_view choose(Texts texts) { return texts[pick(texts.size())]; }

    static Texts texts_of(char kind) {
        switch (kind) {
            case 'n':
                return numbers;
            case 't':
                return times;
            case 'v':
                return vectors;
            case 'e':
                return excitations;
            case 'i':
                return integrators;
            case 's':
                return systems;
            case 'r':
                return runs;
            case 'f':
                return functions;
            case 'h':
                return theories;
            case 'w':
                return words;
            case 'g':
                return globals;
            case 'x':
                return statements;
            default:
                return any_values;
        }
    }

    /// One value in thirty is of another kind than it should be.
    std::string_view value(char kind, int depth) {
        if (depth >= deepest) {
            return texts_of(kind).front();
        }
        const bool wrong = kind != 'g' && kind != 'x' && pick(30) == 29;
        return choose(texts_of(wrong ? 'a' : kind));
    }

    void append(std::string& text, std::string_view pattern, int depth) {
        for (std::size_t i = 0; i < pattern.size(); ++i) {
            if (pattern[i] != '$') {
                text += pattern[i];
            } else if (const std::string_view chosen = value(pattern[++i], depth); depth > deepest) {
                text += chosen.find('$') == std::string_view::npos ? chosen : "1";
            } else {
                append(text, chosen, depth + 1);
            }
        }
    }

    std::span<const std::uint8_t> choices_;
};

}  // namespace

std::string write_lua(std::span<const std::uint8_t> choices) {
    return Writer(choices).chunk();
}
