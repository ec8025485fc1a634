"""Sweeps in files: killed and gone on with, by several processes, under the real mpirun. Usage: sweep_files_test.py PROGRAM"""

import os
import pathlib
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
LAUNCHERS = ("DINAL_", "OMPI_", "PMI_", "SLURM_")


class SweepFiles(AtHome):
    def setUp(self):
        super().setUp()
        self.parts = self.home / "map.csv.parts"
        self.write(workers=2)

    def write(self, text=SCRIPT, **values):
        (self.home / "map.lua").write_text(text.format(**values))

    def command(self, **variables):
        clean = {name: value for name, value in os.environ.items() if not name.startswith(LAUNCHERS)}
        return {"cwd": self.home, "env": {**clean, **variables}, "text": True,
                "preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS, MOST_SECONDS))}

    def start(self, **variables):
        return self.started([PROGRAM, "map.lua"], **variables)

    def started(self, command, **variables):
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **self.command(**variables))
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def run_script(self, *launcher, **variables):
        done = subprocess.run([*launcher, PROGRAM, "map.lua"], capture_output=True, **self.command(**variables))
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
        self.assertEqual(out, printed)
        self.assertEqual((self.home / "map.csv").read_bytes(), file)
        self.assertEqual(sorted(entry.name for entry in self.home.iterdir()), ["map.csv", "map.lua"])

    def wait_for(self, process, sign):
        """Waits until sign() is true; the process must not end before."""
        while not sign():
            self.assertIsNone(process.poll(), "it ended too early")
            time.sleep(0.005)

    def wait_for_parts(self, process, count):
        self.wait_for(process, lambda: self.parts.exists() and len(list(self.parts.glob("*.csv"))) >= count)

    def test_the_result_is_a_file_and_the_same_call_reads_it(self):
        code, out, err = self.run_script()
        self.assertEqual((code, err), (0, ""))
        self.check_result(out)
        mark = (self.home / "map.csv").stat().st_mtime_ns
        self.assertEqual(self.run_script(), (0, out, ""))
        self.assertEqual((self.home / "map.csv").stat().st_mtime_ns, mark)

    def test_what_was_killed_goes_on(self):
        asked = []
        for count in (5, 20):
            process = self.start(WAIT="0.003")
            self.wait_for_parts(process, count)
            process.kill()
            process.wait()
            self.assertFalse((self.home / "map.csv").exists())
            asked.append(len(list(self.parts.glob("*.csv"))))
        self.assertGreaterEqual(asked[1], 20)
        code, out, _ = self.run_script()
        self.assertEqual(code, 0)
        self.check_result(out)

    def test_a_part_of_a_chunk_is_not_taken(self):
        # A machine that loses its power can leave it. Of the first chunk, whose points all fail, each field is cut.
        self.write(SCRIPT.replace("p.r > 1.9 and p.g > 0.9", "p.g < 0.04 and p.r < 0.4"), workers=1)
        process = self.start(WAIT="0.002")
        self.wait_for_parts(process, 8)
        process.kill()
        process.wait()
        kept, first = self.home.parent / (self.home.name + ".kept"), sorted(self.parts.glob("*.csv"))[0]
        whole = first.read_bytes()
        shutil.copytree(self.parts, kept)
        self.addCleanup(shutil.rmtree, kept)
        for length in [0, 1, len(whole) // 2, *(i + 1 for i, byte in enumerate(whole) if byte in b",\"")][:12]:
            with self.subTest(whole[:length]):
                shutil.rmtree(self.parts, ignore_errors=True)
                shutil.copytree(kept, self.parts)
                (self.parts / first.name).write_bytes(whole[:length])
                (self.home / "map.csv").unlink(missing_ok=True)
                code, out, err = self.run_script()
                self.assertEqual((code, err), (0, ""))
                if length == 0:
                    self.check_result(out)
                    file = (self.home / "map.csv").read_bytes()
                self.assertEqual((self.home / "map.csv").read_bytes(), file)
        (self.home / "map.csv").write_bytes(file[:-3])
        self.assertIn("has been changed since it was written", self.run_script()[2])

    def test_a_damaged_number_of_a_chunk_is_refused(self):
        process = self.start(WAIT="0.003")
        self.wait_for_parts(process, 3)
        process.kill()
        process.wait()
        first = sorted(self.parts.glob("*.csv"))[0]
        first.write_text(first.read_text().replace("0.", "0x", 1))
        code, _, err = self.run_script()
        self.assertEqual(code, 1)
        self.assertIn(f"'map.csv.parts/{first.name}' has been changed since it was written; remove it", err)

    def test_nothing_is_touched_through_a_link(self):
        other = self.home / "other"
        kept = ["000000.csv", "mark", ".dinal-1-1.tmp"]
        for name in ("map.csv.parts", "map.csv.parts.merging"):
            for finished in (False, True):
                with self.subTest(name, finished=finished):
                    if finished:
                        self.assertEqual(self.run_script()[0], 0)
                    other.mkdir()
                    for file in kept:
                        (other / file).write_text("mine")
                    (self.home / name).symlink_to("other")
                    code, _, err = self.run_script()
                    self.assertEqual(code, 1)
                    self.assertIn(f"sweep: '{name}' is not a folder; remove it, or give another file", err)
                    self.assertEqual(sorted(entry.name for entry in other.iterdir()), sorted(kept))
                    (self.home / name).unlink()
                    shutil.rmtree(other)
                    (self.home / "map.csv").unlink(missing_ok=True)
        for name in ("mark", "000003.csv"):
            with self.subTest(name):
                self.parts.mkdir()
                (self.parts / name).symlink_to(self.home / "map.lua")
                code, _, err = self.run_script()
                self.assertEqual(code, 1)
                self.assertIn(f"sweep: 'map.csv.parts/{name}' is not a regular file; remove it", err)
                shutil.rmtree(self.parts)

    def test_ctrl_c_keeps_every_point(self):
        # One worker is held at the third point of the eleventh chunk: ten whole chunks are kept, and two points of this one.
        self.write(workers=1)
        with tempfile.TemporaryDirectory() as folder:
            held = os.path.join(folder, "held")
            process = self.start(HOLD=held)
            self.wait_for(process, lambda: os.path.exists(held))
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(), 130)
        rows = sum(len(part.read_text().splitlines()) - 1 for part in self.parts.iterdir() if part.name != "mark")
        self.assertEqual(rows, 32)
        code, out, _ = self.run_script()
        self.assertEqual(code, 0)
        self.check_result(out)

    def test_another_sweep_is_refused(self):
        process = self.start(WAIT="0.003")
        self.wait_for_parts(process, 2)
        process.kill()
        process.wait()
        self.write(SCRIPT.replace("math.sin", "math.cos"), workers=2)
        code, _, err = self.run_script()
        self.assertEqual(code, 1)
        self.assertIn("map.lua:2: sweep: 'map.csv.parts' holds the chunks of another sweep", err)
        shutil.rmtree(self.parts)
        self.assertEqual(self.run_script()[0], 0)
        self.write(SCRIPT.replace("0.1, 2, 30", "0.1, 3, 30"), workers=2)
        code, _, err = self.run_script()
        self.assertEqual(code, 1)
        self.assertIn("'map.csv' is there, and is not the result of this sweep; remove it, or give another file", err)

    def test_lines_may_move_and_the_sweep_is_the_same(self):
        code, out, _ = self.run_script()
        self.assertEqual(code, 0)
        self.write("-- a remark\n\n" + SCRIPT, workers=1)
        self.assertEqual(self.run_script()[:2], (0, out))

    def test_what_fails_everywhere_leaves_nothing(self):
        self.write(SCRIPT.replace("math.sin", "math.sine"), workers=2)
        code, _, err = self.run_script()
        self.assertEqual(code, 1)
        self.assertIn("all 600 points failed", err)
        self.assertEqual([entry.name for entry in self.home.iterdir()], ["map.lua"])

    def test_a_place_that_cannot_be_written_is_told_at_once(self):
        self.write(SCRIPT.replace("map.csv", "nowhere/map.csv"), workers=2)
        code, _, err = self.run_script()
        self.assertEqual(code, 1)
        self.assertIn("sweep: cannot make the folder 'nowhere/map.csv.parts'", err)
        self.write(SCRIPT.replace("map.csv", "map.txt"), workers=2)
        self.assertIn("must end in .csv", self.run_script()[2])

    def test_a_full_disk_keeps_what_is_done(self):
        # No file may grow beyond 2 kB, which one chunk needs: its points fail with many words.
        self.write(SCRIPT.replace('"far ', '("far "):rep(1000) .. "'), workers=1)
        command = self.command()
        limit = command["preexec_fn"]

        def full():
            limit()
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # or the program would be killed, as no full disk does
            resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))

        done = subprocess.run([PROGRAM, "map.lua"], capture_output=True, **{**command, "preexec_fn": full})
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"cannot write '.*map\.csv\.parts.*': File too large")
        kept = {part.name: part.read_bytes() for part in self.parts.glob("*.csv")}
        self.assertGreater(len(kept), 150)
        self.assertFalse((self.home / "map.csv").exists())
        code, out, _ = self.run_script()
        self.assertEqual(code, 0)
        self.check_result(out)

    def test_processes_share_the_points_and_the_last_one_goes_on(self):
        for variables in [lambda rank: {"DINAL_RANK": str(rank), "DINAL_SIZE": "3"},
                          lambda rank: {"SLURM_PROCID": str(rank), "SLURM_STEP_NUM_TASKS": "3"},
                          lambda rank: {"SLURM_ARRAY_TASK_ID": str(10 + 5 * rank), "SLURM_ARRAY_TASK_COUNT": "3",
                                        "SLURM_ARRAY_TASK_MIN": "10", "SLURM_ARRAY_TASK_MAX": "20"}]:
            with self.subTest(variables(0)):
                for rank in (2, 0):
                    code, out, err = self.run_script(**variables(rank))
                    self.assertEqual((code, out), (0, ""))
                    self.assertIn(f"share {rank} of 3 is done", err)
                code, out, err = self.run_script(**variables(1))
                self.assertEqual((code, err), (0, ""))
                self.check_result(out)
                self.assertEqual(self.run_script(**variables(0)), (0, out, ""))
                code, again, err = self.run_script(**variables(2))
                self.assertEqual((code, again), (0, ""))
                self.assertIn("process 0 of 3 continues", err)
                (self.home / "map.csv").unlink()

    def test_processes_at_once_one_killed(self):
        self.write(workers=1)
        processes = [self.start(DINAL_RANK=str(rank), DINAL_SIZE="4", WAIT="0.003") for rank in range(4)]
        self.wait_for_parts(processes[0], 8)
        processes[2].kill()
        outs = [process.communicate()[0] for process in processes]
        self.assertEqual(outs, [""] * 4)
        code, out, _ = self.run_script(DINAL_RANK="2", DINAL_SIZE="4")
        self.assertEqual(code, 0)
        self.check_result(out)

    def test_a_rank_without_a_size_is_one_sentence(self):
        for name, size in [("DINAL_RANK", "DINAL_SIZE"), ("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"),
                           ("SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT")]:
            code, _, err = self.run_script(**{name: "1"})
            self.assertEqual(code, 1)
            self.assertIn(f"{name} = 1 says that this is one of several processes, but {size} does not say", err)
        code, _, err = self.run_script(DINAL_RANK="3", DINAL_SIZE="3")
        self.assertEqual(code, 1)
        self.assertIn("DINAL_RANK = 3 and DINAL_SIZE = 3 name no share", err)

    def test_the_shell_of_a_batch_job_is_one_process(self):
        batch = {"SLURM_JOB_ID": "7", "SLURM_PROCID": "0", "SLURM_NTASKS": "3"}
        for script in (SCRIPT, SCRIPT.replace('file = "map.csv", ', "")):
            self.write(script, workers=1)
            self.assertEqual(self.run_script(**batch), (0, self.run_script()[1], ""))
        self.write(workers=1)
        (self.home / "map.csv").unlink()
        code, out, err = self.run_script(**batch, SLURM_ARRAY_TASK_ID="1", SLURM_ARRAY_TASK_COUNT="2",
                                         SLURM_ARRAY_TASK_MIN="0", SLURM_ARRAY_TASK_MAX="1")
        self.assertEqual((code, out), (0, ""))
        self.assertIn("share 1 of 2 is done", err)

    def test_a_sweep_without_a_file_is_refused_under_a_launcher(self):
        self.write(SCRIPT.replace('file = "map.csv", ', ""), workers=1)
        code, _, err = self.run_script(DINAL_RANK="1", DINAL_SIZE="3")
        self.assertEqual(code, 1)
        self.assertIn('process 1 of 3, which share their work in a file: give one, file = "map.csv"', err)

    @unittest.skipUnless(shutil.which("mpirun"), "there is no mpirun: apt-get install openmpi-bin")
    def test_under_mpirun(self):
        self.write(workers=1)
        launcher = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "4"]
        code, out, err = self.run_script(*launcher, WAIT="0.002")
        self.assertEqual(code, 0, err)
        self.check_result(out)
        self.assertEqual(self.run_script(*launcher)[:2], (0, out))

    @unittest.skipUnless(shutil.which("mpirun"), "there is no mpirun: apt-get install openmpi-bin")
    def test_under_mpirun_killed_in_the_middle(self):
        self.write(workers=1)
        launcher = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "4"]
        process = self.started([*launcher, PROGRAM, "map.lua"], WAIT="0.01")
        self.wait_for_parts(process, 8)
        process.terminate()
        process.wait()
        self.assertFalse((self.home / "map.csv").exists())
        code, out, _ = self.run_script(*launcher)
        self.assertEqual(code, 0)
        self.check_result(out)


if __name__ == "__main__":
    unittest.main()
