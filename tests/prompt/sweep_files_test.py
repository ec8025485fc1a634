"""Sweeps in files: killed and gone on with, damaged, locked. Usage: sweep_files_test.py PROGRAM"""

import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True  # no folder __pycache__ in the source tree

from home import PROGRAM, AtHome

check = unittest.TestCase()
equal = check.assertEqual

# No clock decides how long anything may take: a process has so much processor time, and ends by a signal beyond it.
MOST_SECONDS = 120

POINTS = 600  # in chunks of three
SCRIPT = """
local map = sweep{{ over = {{ r = vector.linspace(0.1, 2, 30), g = vector.linspace(0, 1, 20) }}, file = "map.csv", workers = {workers},
    run = function(p)
        local t, wait = os.clock(), tonumber(os.getenv("WAIT")) or 0 -- in a process that is to be killed in the middle
        while os.clock() - t < wait do end
        if os.getenv("HOLD") and p.r > 0.2 and p.r < 0.25 and p.g > 0.05 and p.g < 0.1 then -- point 33 of 600
            io.open(os.getenv("HOLD"), "w"):close()
            while true do end
        end
        if p.r > 1.9 and p.g > 0.9 then error("far \\"away\\", at " .. p.r) end
        return {{ y = math.sin(p.r)/(p.g + 0.1), chance = math.random(), infinite = p.g == 0 and 1/0 or nil }}
    end }}
local sum = 0
for _, row in ipairs(map) do sum = sum + (row.error == "" and row.y + row.chance or 0) end
print(#map, string.format("%.17g", sum))
"""
BLOCK = re.compile(rb"# \d+ bytes, [0-9a-f]{16}\n")


class SweepFiles(AtHome):
    def setUp(self):
        super().setUp()
        self.part = self.home / "map.csv.part"
        self.write(workers=2)

    def write(self, text=SCRIPT, **values):
        (self.home / "map.lua").write_text(text.format(**values))

    def command(self, **variables):
        return {"cwd": self.home, "env": {**os.environ, **variables}, "text": True,
                "preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS, MOST_SECONDS))}

    def start(self, **variables):
        return self.started([PROGRAM, "map.lua"], **variables)

    def started(self, command, **variables):
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **self.command(**variables))
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def run_script(self, **variables):
        done = subprocess.run([PROGRAM, "map.lua"], capture_output=True, **self.command(**variables))
        return done.returncode, done.stdout, done.stderr

    def expected(self):
        """What one process gives, in a folder of its own: the file and what is printed."""
        with tempfile.TemporaryDirectory() as folder:
            shutil.copy(self.home / "map.lua", folder)
            out = subprocess.run([PROGRAM, "map.lua"], capture_output=True, check=True,
                                 **{**self.command(), "cwd": folder}).stdout
            return (pathlib.Path(folder) / "map.csv").read_bytes(), out

    def check_result(self, out):
        file, printed = self.expected()
        equal(out, printed)
        equal((self.home / "map.csv").read_bytes(), file)
        equal(sorted(entry.name for entry in self.home.iterdir()), ["map.csv", "map.lua"])

    def wait_for(self, process, sign):
        """Waits until sign() is true; the process must not end before."""
        while not sign():
            self.assertIsNone(process.poll(), "it ended too early")
            time.sleep(0.005)

    def blocks(self):
        return len(BLOCK.findall(self.part.read_bytes())) if self.part.exists() else 0

    def killed_after(self, blocks, **variables):
        process = self.start(WAIT="0.003", **variables)
        self.wait_for(process, lambda: self.blocks() >= blocks)
        process.kill()
        process.wait()
        self.assertFalse((self.home / "map.csv").exists())

    def test_the_result_is_a_file_and_the_same_call_reads_it(self):
        code, out, err = self.run_script()
        equal((code, err), (0, ""))
        self.check_result(out)
        mark = (self.home / "map.csv").stat().st_mtime_ns
        equal(self.run_script(), (0, out, ""))
        equal((self.home / "map.csv").stat().st_mtime_ns, mark)

    def test_what_was_killed_goes_on(self):
        for count in (5, 20):
            self.killed_after(count)
        self.assertGreaterEqual(self.blocks(), 20)
        code, out, _ = self.run_script()
        equal(code, 0)
        self.check_result(out)

    def test_what_was_cut_off_or_changed_is_done_anew(self):
        """A machine that loses its power leaves any part; each place is tried at which a line, a field or a number ends."""
        self.killed_after(8)
        whole = self.part.read_bytes()
        file, out = self.expected()
        places = [found.end() for found in re.finditer(rb"[\n,\"]", whole)]
        for length in [0, 1, *random.Random(1).sample(places, 20)]:
            with self.subTest(length):
                self.part.write_bytes(whole[:length])
                equal(self.run_script(), (0, out, ""))
                equal((self.home / "map.csv").read_bytes(), file)
                (self.home / "map.csv").unlink()
        place = whole.index(b"0.", len(whole) // 2)
        self.part.write_bytes(whole[:place] + b"7" + whole[place + 1:])
        equal(self.run_script(), (0, out, ""))
        self.check_result(out)
        (self.home / "map.csv").write_bytes(file[:-3])
        self.assertIn("has been changed since it was written", self.run_script()[2])

    def test_what_is_no_journal_is_not_touched(self):
        (self.home / "other").write_text("mine")
        for make in (lambda: self.part.symlink_to("other"), lambda: os.mkfifo(self.part), lambda: self.part.write_text("mine"),
                     lambda: self.part.write_text("sweep 1234\n")):
            make()
            code, _, err = self.run_script()
            equal(code, 1)
            self.assertRegex(err, "sweep: 'map.csv.part' (is not a regular file|holds the points of another sweep).*; remove it, or give another file")
            equal((self.home / "other").read_text(), "mine")
            self.part.unlink()

    def test_two_at_once(self):
        first = self.start(WAIT="0.003")
        self.wait_for(first, lambda: self.blocks() >= 2)
        code, _, err = self.run_script()
        equal(code, 1)
        self.assertIn("another process is at the same sweep and writes 'map.csv.part': wait for it, or give another file", err)
        out = first.communicate()[0]
        self.check_result(out)

    def test_ctrl_c_keeps_every_point(self):
        # One worker is held at the third point of the eleventh chunk: ten whole chunks are kept, and two points of this one.
        self.write(workers=1)
        with tempfile.TemporaryDirectory() as folder:
            held = os.path.join(folder, "held")
            process = self.start(HOLD=held)
            self.wait_for(process, lambda: os.path.exists(held))
            process.send_signal(signal.SIGINT)
            equal(process.wait(), 130)
        equal(len(re.findall(rb"^\d+,", self.part.read_bytes(), re.M)), 32)
        code, out, _ = self.run_script()
        equal(code, 0)
        self.check_result(out)

    def test_another_sweep_is_refused(self):
        self.killed_after(2)
        other = SCRIPT.replace("math.sin", "math.cos")
        self.write(other, workers=2)
        code, _, err = self.run_script()
        equal(code, 1)
        self.assertIn("map.lua:2: sweep: 'map.csv.part' holds the points of another sweep", err)
        self.part.unlink()
        equal(self.run_script()[0], 0)
        for old, new in (("0.1, 2, 30", "0.1, 3, 30"), ("file =", "seed = 2, file =")):
            self.write(other.replace(old, new), workers=2)
            code, _, err = self.run_script()
            equal(code, 1)
            self.assertIn("'map.csv' is there, and is not the result of this sweep; remove it, or give another file", err)

    def test_lines_may_move_and_the_sweep_is_the_same(self):
        code, out, _ = self.run_script()
        equal(code, 0)
        self.write("-- a remark\n\n" + SCRIPT, workers=1)
        equal(self.run_script()[:2], (0, out))

    def test_what_fails_everywhere_leaves_nothing(self):
        self.write(SCRIPT.replace("math.sin", "math.sine"), workers=2)
        code, _, err = self.run_script()
        equal(code, 1)
        self.assertIn("all 600 points failed", err)
        equal([entry.name for entry in self.home.iterdir()], ["map.lua"])

    def test_a_place_that_cannot_be_written_is_told_at_once(self):
        self.write(SCRIPT.replace("map.csv", "nowhere/map.csv"), workers=2)
        code, _, err = self.run_script()
        equal(code, 1)
        self.assertIn("sweep: cannot write 'nowhere/map.csv.part': No such file or directory", err)
        self.write(SCRIPT.replace("map.csv", "map.txt"), workers=2)
        self.assertIn("must end in .csv", self.run_script()[2])

    def test_a_full_disk_keeps_what_is_done(self):
        self.write(workers=1)
        command = self.command()
        limit = command["preexec_fn"]

        def full():
            limit()
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # or the program would be killed, as no full disk does
            resource.setrlimit(resource.RLIMIT_FSIZE, (8000, 8000))

        done = subprocess.run([PROGRAM, "map.lua"], capture_output=True, **{**command, "preexec_fn": full})
        equal(done.returncode, 1)
        self.assertRegex(done.stderr, r"cannot write 'map\.csv\.part': File too large; finished points are kept in 'map\.csv\.part'")
        self.assertGreater(self.blocks(), 20)
        self.assertFalse((self.home / "map.csv").exists())
        code, out, _ = self.run_script()
        equal(code, 0)
        self.check_result(out)

    def test_the_variables_of_a_launcher_are_not_looked_at(self):
        for script in (SCRIPT, SCRIPT.replace('file = "map.csv", ', "")):
            self.write(script, workers=1)
            printed = self.run_script()[1]
            (self.home / "map.csv").unlink(missing_ok=True)
            equal(self.run_script(SLURM_PROCID="1", OMPI_COMM_WORLD_RANK="1", SLURM_ARRAY_TASK_ID="7"), (0, printed, ""))


if __name__ == "__main__":
    unittest.main()
