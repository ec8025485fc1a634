"""The batch job of docs/many-machines.md on a real SLURM of one node, which the test starts and ends.

    python3 slurm_test.py SOURCE, with PYTHONPATH set to the module's folder

Only for root, with the packages slurmctld, slurmd and munge, and if DINAL_SLURM is set: scripts/test slurm does that. Else it is skipped.
"""

import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE = [*sys.argv, ""][1]
SKIPPED = 77
CONFIGURATION = """
ClusterName=one
SlurmctldHost={host}
SlurmUser=root
SlurmdUser=root
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
StateSaveLocation={folder}
SlurmdSpoolDir={folder}/node
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
AuthInfo=socket={folder}/munge/socket
NodeName={host} CPUs=2
PartitionName=all Nodes=ALL Default=YES
"""


class Job(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="dinal-slurm-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        os.chdir(self.folder)
        munge, key = self.folder / "munge", self.folder / "munge/key"
        munge.mkdir()
        (self.folder / "node").mkdir()
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        self.folder.chmod(0o755)
        self.start("munged", "--foreground", f"--key-file={key}", f"--socket={munge}/socket", f"--pid-file={munge}/pid",
                   f"--log-file={munge}/log", f"--seed-file={munge}/seed")
        configuration = self.folder / "slurm.conf"
        configuration.write_text(CONFIGURATION.format(host=socket.gethostname().partition(".")[0], folder=self.folder))
        os.environ["SLURM_CONF"] = str(configuration)
        self.wait_for(lambda: (munge / "socket").exists())
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D")
        self.wait_for(lambda: "idle" in subprocess.run(["sinfo", "-h", "-o", "%t"], capture_output=True, text=True).stdout)

    def start(self, *command):
        log = open(self.folder / f"{command[0]}.out", "w", encoding="utf-8")
        server = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT)
        self.addCleanup(log.close)
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)

    def wait_for(self, condition):
        for _ in range(300):
            if condition():
                return
            time.sleep(.1)
        self.fail("\n".join(f"{log.name}: {log.read_text()[-2000:]}" for log in self.folder.glob("*.[lo][ou][gt]")))

    def test_the_batch_job_of_the_page(self):
        page = (pathlib.Path(SOURCE) / "docs/many-machines.md").read_text(encoding="utf-8")
        script, job = re.search("```python\n(.*?)```", page, re.S)[1], re.search("## SLURM.*?```sh\n(.*?)```", page, re.S)[1]
        pathlib.Path("map.py").write_text(script.replace("400", "20").replace("200", "10"))
        job = job.replace("--ntasks=64", "--ntasks=2").replace("mpirun ", "mpirun --allow-run-as-root ").replace("python3 ", sys.executable + " ")
        pathlib.Path("job.sh").write_text(job)
        done = subprocess.run(["sbatch", "--wait", "--output=job.out", "job.sh"], capture_output=True, text=True, timeout=200)
        shown = pathlib.Path("job.out").read_text() if os.path.exists("job.out") else ""
        self.assertEqual(done.returncode, 0, done.stderr + shown)
        under_slurm = pathlib.Path("map.csv").read_bytes()
        self.assertTrue(os.path.exists("stops.svg"))
        os.remove("map.csv")
        subprocess.run([sys.executable, "map.py", "processes"], check=True, timeout=200)
        self.assertEqual(pathlib.Path("map.csv").read_bytes(), under_slurm)


if __name__ == "__main__":
    wanted = ("slurmctld", "slurmd", "munged", "mpirun")
    if "DINAL_SLURM" not in os.environ or os.geteuid() != 0 or not all(map(shutil.which, wanted)):
        sys.exit(SKIPPED)
    unittest.main(argv=sys.argv[:1])
