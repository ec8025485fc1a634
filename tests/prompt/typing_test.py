"""What is seen while a line is typed: completion, hints, history, paste. Usage: typing_test.py PROGRAM"""

import sys
import unittest

sys.dont_write_bytecode = True  # no folder __pycache__ in the source tree

from home import HAS_READLINE, AtHome
from screen import CTRL_C, CTRL_R, ENTER, LEFT, TAB, UP

SYSTEM = "sys = system{ I = 1, k = 40, Rd = 2 }"


class Typing(AtHome):
    def setUp(self):
        if not HAS_READLINE:
            self.skipTest("built without readline")
        super().setUp()

    def completes(self, terminal, typed, whole):
        terminal.type(typed + TAB)
        terminal.wait(lambda: terminal.row().startswith("> " + whole.rstrip()))
        terminal.type(CTRL_C)
        terminal.wait(lambda: terminal.row() == ">")

    def offers(self, terminal, typed, names):
        terminal.screen.reset()
        terminal.type(typed + TAB + TAB)
        terminal.wait(lambda: len(terminal.lines()) > 1 and terminal.lines()[-1].startswith("> "))
        seen = terminal.text().replace(" = ", " ").replace("{ ", " ").replace("(", " ").split()
        for name in names:
            self.assertIn(name, seen)
        terminal.type(CTRL_C)
        terminal.wait(lambda: terminal.row() == ">")
        return seen


class Completion(Typing):
    def test_globals_fields_methods_and_keywords(self):
        terminal = self.terminal(TERM="dumb")
        terminal.enter(SYSTEM)
        terminal.enter("run = sys:simulate{ theta0 = 1, t_end = 1, dt = 0.1 }")
        terminal.enter("lab = { inner = { depth = 1 }, ['no name'] = 2, ['by hand'] = sys }")
        for typed, whole in [("nond", "nondimensional{ "), ("excitation.har", "excitation.harmonic{ "),
                             ("sys:sim", "sys:simulate{ "), ("sys.dead", "sys.dead_zone"), ("run.th", "run.theta"),
                             ("run.theta:me", "run.theta:mean("), ("run:ener", "run:energy("),
                             ("run:energy().half", "run:energy().half_cycles"), ("run:cont", "run:continue{ "),
                             ("run:continue{}:exp", "run:continue{}:explain("), ("run:columns('t'):me", "run:columns('t'):mean("), ("theory.magn", "theory.magnification{ "),
                             ("vector{ 1 }:mea", "vector{ 1 }:mean("), ("run.system:sim", "run.system:simulate{ "),
                             ("math.fl", "math.floor("), ("lab.in", "lab.inner"), ("lab.inner.", "lab.inner.depth"),
                             ('lab["inner"].de', 'lab["inner"].depth'),
                             ("lab['by hand']:sim", "lab['by hand']:simulate{ "),
                             ("x = whi", "x = while"), ("sys:simulate{ dt = 1 }:sav", "sys:simulate{ dt = 1 }:save("),
                             ("excitation.step{}:win", "excitation.step{}:window("), ("('x'):low", "('x'):low")]:
            self.completes(terminal, typed, whole)

    def test_columns_values_of_a_fit_and_their_errors(self):
        terminal = self.terminal(TERM="dumb")
        terminal.enter("d = data{ radius = { 1 }, ['no name'] = { 2 } }")
        terminal.enter("run = system{ I = 1, k = 40, Rd = 0.8 }:simulate{ theta0 = 1, t_end = 8, dt = 0.02 }")
        terminal.enter("fit = identify{ data = run, velocity0 = 0 }")
        terminal.enter("balance = run:energy()")
        for typed, whole in [("d.rad", "d.radius"), ("fit.om", "fit.omega0"), ("fit.std_error.Rd", "fit.std_error.Rd_over_k"),
                             ("run.events.ki", "run.events.kind"), ("balance.half_cycles[1].vis", "balance.half_cycles[1].viscous"),
                             ("dinal.part", "dinal.partial"),
                             ('run:plot{ y = "vel', 'run:plot{ y = "velocity"'), ('d:plot{ x = "ra', 'd:plot{ x = "radius"')]:
            self.completes(terminal, typed, whole)

    def test_laws_are_offered_for_friction_and_no_files_where_a_text_is_no_file(self):
        (self.home / "record.csv").write_text("")
        terminal = self.terminal(TERM="dumb")
        self.completes(terminal, "system{ friction = ", "system{ friction = friction.")
        terminal.type('check("re' + TAB + "x")
        terminal.wait(lambda: 'check("rex' in terminal.text())
        terminal.type(CTRL_C)
        terminal.wait(lambda: terminal.row() == ">")
        self.completes(terminal, 'plot{ file = "re', 'plot{ file = "record.csv"')

    def test_options_inside_the_braces_of_a_known_call_without_those_that_are_there(self):
        terminal = self.terminal(TERM="dumb")
        terminal.enter(SYSTEM)
        self.completes(terminal, "sys:simulate{ th", "sys:simulate{ theta0 = ")
        self.completes(terminal, "sys:simulate{ theta0 = 1, ve", "sys:simulate{ theta0 = 1, velocity0 = ")
        seen = self.offers(terminal, "sys:simulate{ M = function(t) return 1 end, t_start = 0, ",
                           ["theta0", "velocity0", "t_end", "dt", "times", "integrator"])
        self.assertNotIn("print", seen)
        self.assertEqual(seen.count("t_start"), 2)  # the line, twice on the screen; not in the list
        self.offers(terminal, "excitation.samples('a.csv', { ", ["time", "value"])
        self.offers(terminal, "excitation.samples{ ", ["t", "M"])
        self.offers(terminal, "excitation.scripted(print, { ", ["breaks", "period"])
        seen = self.offers(terminal, "plot{ title = 'x', ", ["xlabel", "file", "ascii"])
        self.assertNotIn("dashes", seen)
        self.completes(terminal, "plot{ { v, w, da", "plot{ { v, w, dashes = ")
        self.completes(terminal, "sys:simulate{ M = excitation.pulse{ wi", "sys:simulate{ M = excitation.pulse{ width = ")
        self.completes(terminal, "sys:simulate{ integrator = integrator.rk", "sys:simulate{ integrator = integrator.rk4{ ")

    def test_names_of_bodies_and_links(self):
        terminal = self.terminal(TERM="dumb")
        terminal.enter("rig = system{ bodies = { motor = { I = 1 }, load = { I = 3 } }, links = { shaft = { 'motor', 'load', k = 6 } } }")
        terminal.enter("run = rig:simulate{ velocity0 = { motor = 1 }, t_end = 1 }")
        for typed, whole in [("rig.mot", "rig.motor"), ("rig.sha", "rig.shaft"), ("run.lo", "run.load"),
                             ("run.shaft.to", "run.shaft.torque"),
                             ("rig:simulate{ theta0 = { lo", "rig:simulate{ theta0 = { load ="),
                             ("rig:simulate{ velocity0 = { load = 1, ", "rig:simulate{ velocity0 = { load = 1, motor ="),
                             ("rig:simulate{ M = { sh", "rig:simulate{ M = { shaft ="),
                             ("system{ bodies = { a = { fri", "system{ bodies = { a = { friction ="),
                             ("rig:with{ links = { shaft = { rig", "rig:with{ links = { shaft = { rigid =")]:
            self.completes(terminal, typed, whole)

    def test_fields_of_tables_within_options(self):
        terminal = self.terminal(TERM="dumb")
        terminal.enter(SYSTEM)
        seen = self.offers(terminal, "system{ I = 1, walls = { lower = -1, ", ["upper", "restitution"])
        self.assertEqual(seen.count("lower"), 2)  # the line, twice on the screen; not in the list
        self.offers(terminal, "sys:simulate{ events = { { when = f }, { ", ["when", "direction", "stop", "name", "act"])
        self.completes(terminal, "sys:simulate{ events = { { direction = \"bo",
                       "sys:simulate{ events = { { direction = \"both\"")
        self.offers(terminal, "sys:simulate{ states = { e = { ", ["start", "rate"])
        self.offers(terminal, "friction.asymmetric{ forward = { R", ["Rd", "Re"])
        self.offers(terminal, "sys:with{ units = { ", ["theta", "t", "M"])
        for typed, whole in [("system{ walls = ", "system{ walls = {"),
                             ("sys:simulate{ events = { ", "sys:simulate{ events = { {"),
                             ("f({ g = 1 }, sys:simulate{ states = { e = { ra",
                              "f({ g = 1 }, sys:simulate{ states = { e = { rate =")]:
            self.completes(terminal, typed, whole)
        terminal.enter("run = sys:simulate{ theta0 = 1, t_end = 1, dt = 0.1 }")
        self.completes(terminal, 'run:plot{ y = { "theta", "vel', 'run:plot{ y = { "theta", "velocity"')
        for typed in ["sys:simulate{ walls = { ", "sys:simulate{ M = function(t) local walls = { ", "x = { walls = { "]:
            self.assertNotIn("upper", self.offers(terminal, typed, ["print"]))

    def test_options_on_a_later_line_and_the_key_that_indents(self):
        terminal = self.terminal(TERM="dumb")
        terminal.enter(SYSTEM)
        terminal.enter("sys:simulate{", prompt=">>")
        terminal.type(TAB + "th" + TAB)
        terminal.wait(lambda: terminal.row().startswith(">>   theta0 ="))

    def test_names_of_files_inside_quotes_and_of_entries_after_help(self):
        (self.home / "record.csv").write_text("")
        terminal = self.terminal(TERM="dumb")
        self.completes(terminal, "load('rec", "load('record.csv'")
        self.completes(terminal, 'help "excitation.har', 'help "excitation.harmonic"')
        self.completes(terminal, "?sys.dead", "?sys.dead_zone")
        self.completes(terminal, ":load rec", ":load record.csv")
        self.completes(terminal, ":hist", ":history")
        self.completes(terminal, "help(excitation.har", "help(excitation.harmonic")

    def test_it_never_runs_code_of_the_user(self):
        terminal = self.terminal(TERM="dumb")
        terminal.enter("t = setmetatable({}, { __index = function() ran = true return { deep = 1 } end })")
        terminal.enter("setmetatable(_G, { __index = function() ran = true end })")
        terminal.type("t.x." + TAB + TAB + "nowhere." + TAB + TAB)
        terminal.type(CTRL_C)
        terminal.wait(lambda: terminal.row() == ">")
        self.assertEqual(terminal.enter("rawget(_G, 'ran')"), "nil")

    def test_nothing_is_offered_in_comments_and_numbers(self):
        terminal = self.terminal(TERM="dumb")
        terminal.type("-- pri" + TAB + TAB + "x" + ENTER)
        terminal.wait(lambda: "> -- prix" in terminal.text())
        terminal.type("0xpri" + TAB)
        terminal.wait(lambda: terminal.row() == "> 0xpri")


class Hints(Typing):
    def test_a_hint_names_the_options_that_are_missing_and_goes_away(self):
        terminal = self.terminal()
        terminal.enter(SYSTEM)
        terminal.type("sys:simulate{")
        terminal.shows("sys:simulate{  M = 0, theta0 = 0")
        terminal.type(" M = 2,")
        terminal.shows("sys:simulate{ M = 2,  theta0 = 0")
        self.assertNotEqual(terminal.colour("theta0"), "default")
        terminal.type(" t_end = 1, dt = 0.5 };" + ENTER)
        terminal.wait(lambda: terminal.row() == ">")
        self.assertIn("> sys:simulate{ M = 2, t_end = 1, dt = 0.5 };", terminal.lines())

    def test_a_hint_that_just_fits_is_whole(self):
        terminal = self.terminal(width=len("> theory.logarithmic_decrement{  zeta") + 2)
        terminal.type("theory.logarithmic_decrement{")
        terminal.shows("theory.logarithmic_decrement{  zeta")

    def test_enter_and_ctrl_c_leave_no_hint_behind(self):
        terminal = self.terminal()
        terminal.type("system{")
        terminal.shows("system{  I, k")
        terminal.type(CTRL_C)
        terminal.wait(lambda: terminal.row() == ">")
        self.assertNotIn("I, k", terminal.text())
        terminal.type("system{")
        terminal.shows("system{  I, k")
        terminal.type(ENTER)
        terminal.wait(lambda: terminal.row() == ">> { of line 1 waits for }; Ctrl-C cancels it")
        self.assertNotIn("I, k", terminal.text())

    def test_a_hint_goes_away_when_the_line_becomes_another_one(self):
        terminal = self.terminal()
        terminal.enter("do", prompt=">>")
        terminal.enter("end")
        for keys in (UP, " I = 1, k = 40, C = 1, Rd = 2, Re = 3 } -- a remark that leaves no room for any hint"):
            terminal.screen.reset()
            terminal.type(CTRL_C + "system{")
            terminal.shows("system{  I, k")
            terminal.type(keys)
            terminal.wait(lambda: "end" in terminal.text() or "hint" in terminal.text())
            self.assertNotIn("I, k", terminal.text())

    def test_a_window_that_changes_its_width_shows_the_line_once(self):
        terminal = self.terminal()
        terminal.type("system{")
        terminal.shows("system{  I, k")
        for width in (40, 60, 30):
            terminal.resize(width)
            terminal.wait(lambda: terminal.row().startswith("> system{") and len(terminal.row()) > min(width, 40) - 12)
            self.assertEqual(terminal.text().count("system{"), 1)
        terminal.type(" I = 1, k = 40, Rd = 2, C = 0.5, Re = 3 }")
        terminal.wait(lambda: "Re = 3 }" in "".join(terminal.lines()))
        terminal.resize(80)
        terminal.type(";" + ENTER)
        terminal.wait(lambda: terminal.row() == ">")
        self.assertEqual(terminal.enter("ans.Re"), "3.0")

    def test_the_cursor_moves_within_a_painted_line(self):
        terminal = self.terminal()
        terminal.type("print('ac')" + LEFT * 3 + "b" + ENTER)
        terminal.wait(lambda: "abc" in terminal.lines())

    def test_wide_letters_and_long_lines_stay_whole(self):
        terminal = self.terminal(width=40)
        terminal.type("print('θ漢字' .. 'x')" + LEFT * 3 + "y" + ENTER)
        terminal.wait(lambda: "θ漢字yx" in terminal.text().replace(" ", "") and terminal.row() == ">")
        self.assertEqual(terminal.enter("('12345678901234567890' .. '12345678901234567890'):len()").splitlines()[-1], "40")

    def test_no_colours_where_they_are_not_wanted(self):
        for variables in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
            terminal = self.terminal(**variables)
            terminal.enter("x = 'text' + nowhere.field")
            self.assertNotIn(b"\x1b[3", terminal.raw)
            self.assertNotIn(b"\x1b[9", terminal.raw)


class Lines(Typing):
    def test_ctrl_r_finds_an_entry_of_several_lines_of_an_earlier_session(self):
        terminal = self.terminal()
        terminal.enter("for i = 1, 2 do", prompt=">>")
        terminal.enter("  print('again', i)", prompt=">>")
        terminal.enter("end")
        terminal.close()
        terminal = self.terminal()
        terminal.type(CTRL_R + "again")
        terminal.shows("print('again', i)")
        terminal.type(ENTER)
        terminal.wait(lambda: terminal.row() == ">")
        self.assertIn("again   2", terminal.text())

    def test_a_command_is_in_the_history(self):
        terminal = self.terminal()
        terminal.enter(":who")
        terminal.screen.reset()
        terminal.type(UP + ENTER)
        terminal.shows("no variables of your own")


if __name__ == "__main__":
    unittest.main()
