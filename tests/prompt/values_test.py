"""What the prompt shows: values, notices, help, commands, at 80 and 40 columns, in UTF-8 and ASCII, with and without
readline. Usage: values_test.py PROGRAM"""

import os
import re
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True  # no folder __pycache__ in the source tree

import pexpect

from home import PROGRAM, AtHome

check = unittest.TestCase()
equal, contained = check.assertEqual, check.assertIn

SYSTEM = "sys = system{ I = 1, k = 40, Rd = 2 }"
RUN = "run = sys:simulate{ theta0 = 1, t_end = 5, dt = 0.01 }"


class Values(AtHome):
    def test_a_system_is_a_card(self):
        terminal = self.terminal()
        terminal.enter(SYSTEM)
        card = terminal.enter("sys")
        for piece in ["I θ'' + C θ' + Rd sgn θ' + k θ = M(t)", "omega0     6.32456    natural frequency",
                      "zeta       0          damping ratio: undamped", "dead_zone  0.05       the mass can rest"]:
            contained(piece, card)

    def test_a_card_has_the_friction_that_was_given_and_its_factor(self):
        card = self.terminal().enter("system{ I = 1, k = 4, Rd = 0.5, Re = 0.6, normal = 2 }")
        for piece in ["Rd         0.5 ", "Re         0.6 ", "normal     2 "]:
            contained(piece, card)

    def test_a_card_says_the_units_and_what_follows_from_them(self):
        terminal = self.terminal(width=100)
        terminal.enter('block = system{ I = 2, k = 800, C = 3, Rd = 3, units = { theta = "m", t = "s", M = "N" } }')
        card = terminal.enter("block")
        for piece in ["I          2          inertia, N s^2/m", "stiffness, N/m", "viscous damping, N s/m", "while sliding, N",
                      "breakaway torque, N", "units      theta in m, t in s, M in N", "natural frequency, rad per s",
                      "natural period, s", "|θ| <= this, m"]:
            contained(piece, card)
        terminal.enter("run = block:simulate{ theta0 = 1, t_end = 1, dt = 0.1 }")
        contained("theta in m, t in s, M in N", terminal.enter("run").replace("\n", " "))
        contained("  i      t, s  kind   theta, m  M, N  velocity, m/s\n  1   0.15719  turn", terminal.enter("run.events"))
        contained("steady: period 1 s", terminal.enter("block:steady{ M = excitation.harmonic{ amplitude = 9, frequency = 1 } }"))

    def test_the_numbers_of_a_card_are_the_fields_of_its_names(self):
        terminal = self.terminal(width=100)
        terminal.enter("soft = system{ I = 2, k = 40, C = 0.3, Rd = 0.5, Re = 0.7, normal = 2 }")
        terminal.enter("run = soft:simulate{ M = 1, theta0 = 1, velocity0 = 2, t_end = 6, dt = 0.02 }")
        terminal.enter("noise = vector.normal{ n = #run, seed = 1, std = 1e-3 }")
        terminal.enter("fit = identify{ data = { t = run.t, theta = run.theta + noise }, I = 2 }")
        for name, least, form in [("soft", 9, "%.6g"), ("fit", 9, "%.6g"), ("run:energy().total", 5, "%.6g")]:
            card = terminal.enter(name.replace(".total", ""))
            rows = re.findall(r"^  (\w+) +(-?\d[\d.e-]*)(?: +\+- (\S+))?", card, re.MULTILINE)
            self.assertGreaterEqual(len(rows), least, card)
            for field, number, error in rows:
                if field != "error":
                    equal(terminal.enter(f"('{form}'):format({name}.{field})").strip('"'), number, card)
                if error:
                    equal(terminal.enter(f"('%.2g'):format({name}.std_error.{field})").strip('"'), error, card)

    def test_an_excitation_is_a_formula_and_its_breaks(self):
        terminal = self.terminal()
        shown = terminal.enter("3*excitation.pulse{ at = 1.5, width = 0.2 } - excitation.harmonic{ omega = 2 }")
        equal(shown.splitlines(), ["excitation  M(t) =", "    3 for 1.5 <= t < 1.7", "  - sin(2 t)",
                                   "  jumps or kinks at t = 1.5, 1.7"])
        contained("jumps or kinks at t = 0, 1, 2, 3, 4, 5, ...", terminal.enter("excitation.square{ period = 2 }"))
        for term, formula in [("polynomial{ coefficients = { -1, -0.5, 2 }, at = 0.3 }", "    -1 - 0.5 (t - 0.3) + 2 (t - 0.3)^2"),
                              ("ramp{ slope = 3, at = -1, duration = 2 }", "    3 (t + 1) for -1 <= t < 1, then 6"),
                              ("ramp{ slope = -2, at = 1 }", "  - 2 (t - 1) for t >= 1"),
                              ("harmonic{ amplitude = -2, omega = 3, phase = -0.4 }", "  - 2 sin(3 t - 0.4)"),
                              ("gaussian{ amplitude = 3, at = 1, sigma = 0.2 }", "    3 exp(-((t - 1)/0.2)^2/2)"),
                              ("exponential{ amplitude = 2, tau = 0.5, at = -0.5 }", "    2 exp(-(t + 0.5)/0.5) for t >= -0.5"),
                              ("half_sine{ at = 1, width = 0.5 }", "    sin(pi (t - 1)/0.5) for 1 <= t < 1.5"),
                              ("square{ period = 1.5, duty = 0.25, at = 1 }",
                               "    1 square wave of period 1.5 that begins at 1, positive for 0.25 of it"),
                              ("chirp{ amplitude = 2, from = 1, to = 3, duration = 4, at = 1 }",
                               "    2 sine of frequency 1 ... 3 for 1 <= t < 5")]:
            equal(terminal.enter("excitation." + term).splitlines()[1], formula)
        contained("    function(t) return 2*t end", terminal.enter("excitation.scripted(function(t) return 2*t end)"))

    def test_a_run_its_columns_and_events(self):
        terminal = self.terminal()
        terminal.enter(SYSTEM)
        terminal.enter(RUN)
        self.assertRegex(terminal.enter("run"), r"^501 rows, t 0 … 5; \d+ events? \(.*rest\).*; by\s+exact$")
        self.assertRegex(terminal.enter("run.theta"), r"^vector\{ 1, 0\.\d+, .*\.\.\., .* \}  -- 501 numbers$")
        self.assertRegex(terminal.enter("run.events"), r"^\d+ events: .*1 rest.*\n +i +t +kind +theta +M +velocity\n +1 ")
        self.assertRegex(terminal.enter("run.events[1]"), r'^\{ t = 0\.\d+, kind = "turn", theta = -?0\.\d+, M = 0, velocity = 0 \}$')
        equal(terminal.enter("run.integrator"), "integrator.exact{}")
        self.assertRegex(terminal.enter("integrator.spectral{}"), r"(?s)^integrator\.spectral\{ tolerance = 1e-12, .* \}$")

    def test_functions_show_their_text_or_how_they_are_called(self):
        terminal = self.terminal()
        equal(terminal.enter("function(t) return 3*t end"), "function(t) return 3*t end")
        equal(terminal.enter("math.sin"), "function math.sin of Lua")
        equal(terminal.enter("nondimensional").split("{")[0], "function nondimensional")
        self.assertTrue(terminal.enter("excitation").startswith("excitation: constant, harmonic,"))

    def test_a_long_table_says_how_many_items_are_left_out(self):
        terminal = self.terminal()
        terminal.enter("t = {} for i = 1, 5000 do t[i] = i end")
        *_, last, left, _ = terminal.enter("t").splitlines()
        equal(left, f"  ... {5000 - int(last.rstrip(',').split()[-1])} more")
        contained("  b = 0.12345678901\n", terminal.enter("{ a = { 1/3, 1/7, 1/9, 1/11, 1/13, 1/17, 1/19 }, b = 0.12345678901 }"))

    def test_everything_fits_in_forty_columns(self):
        terminal = self.terminal(width=40, height=50)
        terminal.enter("s = nondimensional{ zeta = 0.1 }")
        terminal.enter("r = s:simulate{ theta0=1,", prompt=">>")
        terminal.enter("t_end = 9, dt = 0.01 }")
        for text in ["s", "r", "r.theta", "r.events", "r:energy()", "r:explain()", "excitation", "nondimensional", "theory.step_limit",
                     "r.integrator", "excitation.square{ period = 2 } + excitation.harmonic{ frequency = 3 }", "theory", "{ 1, { 2, 3 }, x = 'a long text, rather' }",
                     "{ s, r, r.t }"]:
            shown = terminal.enter(text)
            self.assertTrue(shown)
            # A line of 40 characters would go on in the next row.
            self.assertTrue(all(len(line) < 40 for line in shown.splitlines()), shown)

    def test_ascii_where_the_locale_has_nothing_else(self):
        terminal = self.terminal(LC_ALL="C")
        terminal.enter(SYSTEM)
        terminal.enter(RUN)
        for text in ["sys", "run", "'\\u{3b8}'", "help(sys.dead_zone)", "excitation.scripted(function(t, x) return 1 end)"]:
            shown = terminal.enter(text)
            self.assertTrue(shown and shown.isascii(), shown)
        contained("theta''", terminal.enter("sys"))

    def test_a_semicolon_keeps_quiet_and_ans_is_kept(self):
        terminal = self.terminal()
        equal(terminal.enter("6 * 7;"), "")
        equal(terminal.enter("ans"), "42")
        equal(terminal.enter("6 * 8 ; -- remark"), "")
        equal(terminal.enter("return ans"), "48")


class Notices(AtHome):
    def test_what_is_no_error_but_hardly_meant_is_noticed(self):
        terminal = self.terminal()
        terminal.enter(SYSTEM)
        terminal.enter("M = math.sin")
        terminal.enter("given = { theta0 = 1 }")
        for typed, notice in [("sys:simulate{ M = m, t_end = 1, dt = 0.5 };", "('m' is nil, so M is not given; did you mean 'M'?)"),
                              ("sys:simulate{ t_end = 1, dt = 0.5, integrator = rk4 };",
                               "('rk4' is nil, so integrator is not given; did you mean 'integrator.rk4'?)"),
                              ("sys:simulate{ theta0 = given.theta_0, t_end = 1, dt = 1 };",
                               "('given.theta_0' is nil, so theta0 is not given; did you mean 'theta0'?)"),
                              ("N = m", "('m' is nil; did you mean 'M'?)"),
                              ("x = 1,5", "(1,5 are two numbers, and x is the first; a decimal point is a point: 1.5)"),
                              ("x = pi", "('pi' is nil; did you mean 'math.pi'?)")]:
            equal(terminal.enter(typed).replace("\n", " "), notice)
        for typed in ["x = M", "y = { x, M }", "a, b = 1, 5", "x = nil", "f = function() x = later end", "f = function() n = m; return n end", "local n = 3 m = n",
                      "t = { [1] = M }", "w = qwertz"]:
            equal(terminal.enter(typed), "", typed)

    def test_a_local_variable_that_is_lost_is_noticed_each_time(self):
        terminal = self.terminal()
        notice = "(local variables end with the input: {} gone. To keep {}, leave out the word local)"
        for typed, words in [("local x = 3", ("x is", "it")), ("local given = lab.given", ("given is", "it")),
                             ("local a, b = 1, {}", ("a, b are", "them"))]:
            equal(terminal.enter(typed).replace("\n", " "), notice.format(*words), typed)
        with open(os.path.join(self.home, "script.lua"), "w", encoding="utf-8") as script:
            script.write("local sys = nondimensional{}\nrun = sys:simulate{ t_end = 1, dt = 1 }\n")
        equal(terminal.enter(":load script.lua").replace("\n", " "), notice.format("sys is", "it"))

    def test_history_and_edit(self):
        terminal = self.terminal(EDITOR="sed -i s/1/5/")
        terminal.enter("x = 1")
        terminal.enter("y = 2")
        equal(terminal.enter(":history").split(), ["1", "x", "=", "1", "2", "y", "=", "2"])
        equal(terminal.enter(":history 1").split(), ["2", "y", "=", "2"])
        equal(terminal.enter(":edit 1"), "x = 5")
        equal(terminal.enter(":history 1").split(), ["3", "x", "=", "5"])
        equal(terminal.enter("x"), "5")
        contained("from 1 to 4", terminal.enter(":edit 5"))

    def test_a_local_variable_that_is_used_is_not(self):
        terminal = self.terminal()
        equal(terminal.enter("local x = 3 print(x)"), "3")
        equal(terminal.enter("for i = 1, 2 do local z = i end"), "")

    def test_a_misspelt_variable_is_nil_with_a_word(self):
        terminal = self.terminal()
        terminal.enter("velocity = 3")
        equal(terminal.enter("velocty"), "nil\n(there is no variable 'velocty'; did you mean 'velocity'?)")
        terminal.enter("sys = nondimensional{}")
        terminal.enter("system{ I = 1, k = 1 }")  # is ans
        contained("did you mean 'sys.dead_zone'?", terminal.enter("dead_zone + 1").replace("\n", " "))
        equal(terminal.enter("xyzzy"), "nil")
        contained(":quit", terminal.enter("exit"))

    def test_a_colon_without_a_call_does_not_wait_for_more(self):
        terminal = self.terminal()
        terminal.enter(SYSTEM)
        terminal.enter(RUN)
        contained("write it with a point, run.events", terminal.enter("run:events"))
        contained("run:at(t) -> theta, velocity", terminal.enter("x = run:at"))
        contained("help() starts a tour", terminal.enter("help"))

    def test_a_run_that_failed_before_its_first_row_is_not_announced(self):
        terminal = self.terminal()
        terminal.enter(SYSTEM)
        shown = terminal.enter("sys:simulate{ M = function(t) return tt + 1 end, t_end = 1, dt = 0.1 }")
        contained("in M at t = 0", shown)
        self.assertNotIn("is in ans", shown)


class Help(AtHome):
    def test_question_marks_before_and_behind(self):
        terminal = self.terminal()
        terminal.enter(SYSTEM)
        entry = terminal.enter("help(sys.simulate)")
        contained("See also:", entry)
        for same in ["?sys.simulate", "sys.simulate?", "? sys.simulate", "?sys:simulate", "help 'sys:simulate'", ":help sys:simulate"]:
            equal(terminal.enter(same), entry)
        contained("The natural period", terminal.enter("?sys.T0"))
        contained("did you mean 'harmonic'?", terminal.enter("harmonc?"))
        contained("now 3", terminal.enter("x = 3") + terminal.enter("x?"))

    def test_the_tour_can_be_typed(self):
        terminal = self.terminal(height=40)
        pages = 0
        page = terminal.enter("?")
        while page:
            pages += 1
            lines = page.splitlines()
            self.assertLess(len(lines), 22)
            self.assertTrue(all(len(line) < 78 for line in lines))
            typed = [line[6:] for line in lines if line.startswith("    > ")]
            depth = 0
            for line in typed:
                depth += len(re.findall(r"\b(do|function)\b", line)) - len(re.findall(r"\bend\b", line))
                shown = terminal.enter(line, prompt=">>" if depth > 0 else ">")
                if "theta_0" in line:
                    contained("did you mean 'theta0'?", shown.replace("\n", " "))
                else:
                    self.assertNotIn("stdin:", shown)
            following = re.search(r"help\(\d\)", page)
            page = terminal.enter(following[0]) if following else ""
        equal(pages, 6)
        self.assertTrue((self.home / "run.csv").exists())
        done = subprocess.run([PROGRAM, "tour.lua"], cwd=self.home, capture_output=True, text=True)
        equal(done.stderr, "")
        contained("2001 rows", done.stdout)


class Commands(AtHome):
    def test_a_saved_session_runs_again(self):
        terminal = self.terminal()
        for line in [SYSTEM, "sys.T0", "local lost = 1", "nowhere.field", "sys:friction_ratio(4);", "ans * 2 -- twice",
                     "x = 7;", "=x", "print('printed')", "1, 2", ":who", "nothing", "goto done ::done::"]:
            terminal.enter(line)
        terminal.enter(":save lab.lua")
        script = (self.home / "lab.lua").read_text()
        self.assertNotIn("nowhere", script)
        done = subprocess.run([PROGRAM, "lab.lua"], cwd=self.home, capture_output=True, text=True)
        equal((done.stderr, done.returncode), ("", 0))
        equal(done.stdout, "0.99345882657961\n1.0\n7\nprinted\n1\t2\nnil\n")
        equal(script.splitlines()[1:6], [SYSTEM, "print(sys.T0)", "do", "local lost = 1", "end"])

    def test_files_of_others_are_not_overwritten(self):
        (self.home / "mine.lua").write_text("precious")
        terminal = self.terminal()
        for command in (":save mine.lua", ":save 'mine.lua'"):
            contained("is there already", terminal.enter(command))
        equal((self.home / "mine.lua").read_text(), "precious")
        terminal.enter("x = 1")
        terminal.enter(":save lab.lua")
        terminal.enter("y = 2")
        terminal.enter(":save lab.lua")
        equal((self.home / "lab.lua").read_text().splitlines()[1:], ["x = 1", "y = 2"])
        contained("write :save file", terminal.enter(":save"))
        contained("no/lab.lua", terminal.enter(":save no/lab.lua"))

    def test_load_who_reset_and_time(self):
        (self.home / "lab.lua").write_text("w = 42\nfunction twice(x) return 2*x end\n")
        (self.home / "wrong.lua").write_text("x = = 1\n")
        terminal = self.terminal()
        terminal.enter(":load lab.lua")
        self.assertRegex(terminal.enter(":who"), r"^  twice +function\n  w +42$")
        contained("wrong.lua:1: unexpected symbol", terminal.enter(":load wrong.lua"))
        contained("cannot open", terminal.enter(":load missing.lua"))
        terminal.enter("system = 3 math = nil")
        terminal.enter(":save before.lua")
        terminal.enter(":reset")
        terminal.enter("y = 2")
        terminal.enter(":save after.lua")
        for name, lines in ("before", ['dofile("lab.lua")', "system = 3 math = nil"]), ("after", ["y = 2"]):
            equal((self.home / f"{name}.lua").read_text().splitlines()[1:], lines)
        terminal.enter("y = nil")
        contained("no variables", terminal.enter(":who"))
        equal(terminal.enter("w, type(system), math.pi > 3"), 'nil\t"function"\ttrue'.expandtabs())
        self.assertRegex(terminal.enter(":time 6 * 7"), r"^42\n[0-9.e-]+ s$")

    def test_names_may_be_short_and_wrong_ones_are_told(self):
        terminal = self.terminal()
        contained(":save file", terminal.enter(":he"))
        contained("did you mean 'quit'?", terminal.enter(":qiut"))
        contained(":help lists them", terminal.enter(":xyz"))
        contained("write :load file", terminal.enter(":load"))
        equal(terminal.enter("::label:: x = 5"), "")
        terminal.type(":q\r")
        terminal.child.expect(pexpect.EOF)
        terminal.child.close()
        equal(terminal.child.exitstatus, 0)

    def test_the_init_file_is_for_the_prompt_only(self):
        (self.home / ".config/dinal").mkdir(parents=True)
        (self.home / ".config/dinal/init.lua").write_text("g = 9.81\nif wrong then error('never') end\n")
        equal(self.terminal().enter("g"), "9.81")
        equal(self.terminal("--no-init").enter("g"), "nil")
        environment = {"HOME": str(self.home), "PATH": "/usr/bin:/bin"}
        done = subprocess.run([PROGRAM, "-e", "print(g)"], env=environment, capture_output=True, text=True)
        equal(done.stdout, "nil\n")
        (self.home / ".config/dinal/init.lua").write_text("x = 1\nerror('broken')\n")
        equal(self.terminal().enter("x"), "1")

    def test_a_safe_prompt_loads_no_bytecode_and_nothing_from_outside(self):
        (self.home / "lab").mkdir()
        (self.home / "outside.lua").write_text("print('reached')\n")
        (self.home / "lab" / "inside.lua").write_text("print('in' .. 'side')\n")
        subprocess.run([PROGRAM, "-e", "io.open('lab/code.lua', 'w'):write(string.dump(load 'print(1)')):close()"], cwd=self.home,
                       check=True, env={"HOME": str(self.home)})
        done = subprocess.run([PROGRAM, "--safe", "-i"], cwd=self.home / "lab", capture_output=True, text=True,
                              input=":load inside.lua\n:load ../outside.lua\n:load code.lua\n:save ../new.lua\n")
        equal(done.stdout.count("side"), 1)
        self.assertNotIn("reached", done.stdout)
        equal(done.stderr.count("in the current folder and below only"), 2, done.stderr)
        contained("bytecode", done.stderr)
        self.assertFalse((self.home / "new.lua").exists())

    def test_they_are_no_lua(self):
        (self.home / "lab.lua").write_text(":who\n")
        done = subprocess.run([PROGRAM, "lab.lua"], cwd=self.home, capture_output=True, text=True)
        equal(done.returncode, 1)
        done = subprocess.run([PROGRAM, "-i"], cwd=self.home, capture_output=True, text=True, input="x = 1\n:who\n?x\n:quit\nx\n")
        contained("  x         1\n", done.stdout)
        self.assertNotIn("\x1b", done.stdout)


if __name__ == "__main__":
    unittest.main()
