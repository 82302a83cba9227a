# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The paper's bank on the ranks of a real mpirun: the same bytes as of one process, whatever ends a rank."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "command_line"))

import support
from support import SmallArray, dermis, error_lines

MPIRUN = ("mpirun", "--oversubscribe", "-n")
# As root, in a sandbox, on one machine.
ENVIRONMENT = {
    **os.environ,
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_hwloc_base_binding_policy": "none",
}
MEMORY = re.compile(r"each of (\d) ranks takes at most (\d+) MB of memory")
STEPS = 600


def peak_of(process_number):
    """The most memory that a process has had [MB]; 0 where it has ended."""
    try:
        status = Path(f"/proc/{process_number}/status").read_text()
    except OSError:
        return 0
    found = re.search(r"VmHWM:\s+(\d+) kB", status)
    return int(found[1]) * 1024 / 1e6 if found else 0


def children_of(process_number):
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == process_number:
            found.append(int(stat.parent.name))
    return sorted(found)


class Mpirun(SmallArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        if shutil.which("mpirun") is None:
            print("skipped: mpirun is not installed (scripts/setup test)")
            raise support.unittest.SkipTest("mpirun is not installed")
        # A network of this array has 8,385 unknowns, which are in panels.
        cls.wide = cls.root / "wide.toml"
        cls.wide.write_text(support.ARRAY.replace("rows = 4", "rows = 8").replace("cols = 5", "cols = 8"))
        cls.presses = cls.root / "presses"
        scene = ("--scene", "paper_calibration", "--out", cls.presses)
        dermis("simulate", "--array", cls.wide, *scene).check_returncode()
        cls.alone = cls.root / "alone"
        dermis(*cls.train(cls.alone)).check_returncode()

    @classmethod
    def train(cls, bank, *arguments, steps=STEPS, loads=None):
        files = ("--array", cls.wide, "--frames", cls.presses / "frames.csv")
        files += ("--loads", loads or cls.presses / "loads.csv")
        return ("paper", "calibrate", *files, "--bank", bank, "--steps", steps, *arguments)

    def on_ranks(self, count, *arguments):
        return dermis(*arguments, prefix=(*MPIRUN, str(count)), env=ENVIRONMENT)

    def start(self, count, *arguments):
        process = subprocess.Popen(
            [*MPIRUN, str(count), support.BINARY, *map(str, arguments)],
            env=ENVIRONMENT,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def test_any_number_of_ranks_gives_the_bytes_of_one_process(self):
        for count in (1, 2, 3, 4):
            with self.subTest(count=count):
                bank = self.work / f"bank{count}"
                result = self.on_ranks(count, *self.train(bank))
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(bank.read_bytes(), self.alone.read_bytes())
                self.assertEqual(result.stdout.count("\n"), 1)  # one rank speaks
                self.assertEqual(result.stderr.count("bank: 100 %"), 1)

    def test_small_networks_which_share_vectors_give_them_too(self):
        paths = ("--array", self.array, "--frames", self.calibration / "frames.csv")
        paths += ("--loads", self.calibration / "loads.csv", "--bank")
        dermis("paper", "calibrate", *paths, self.work / "alone").check_returncode()
        for count in (3, 4):
            result = self.on_ranks(count, "paper", "calibrate", *paths, self.work / "bank")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual((self.work / "bank").read_bytes(), (self.work / "alone").read_bytes())

    def test_no_rank_takes_more_memory_than_it_said_before(self):
        for count in (2, 3):
            process = self.start(count, *self.train(self.work / "bank"))
            peaks = {}
            while process.poll() is None:
                for child in children_of(process.pid):
                    peaks[child] = max(peaks.get(child, 0), peak_of(child))
                time.sleep(0.01)
            errors = process.communicate()[1]
            said = MEMORY.search(errors)
            self.assertIsNotNone(said, errors)
            self.assertEqual(int(said[1]), count)
            self.assertEqual(len(peaks), count)
            self.assertLessEqual(max(peaks.values()), int(said[2]))
            self.assertGreater(min(peaks.values()), 0.5 * int(said[2]))

    def test_a_rank_that_is_killed_ends_the_job_and_the_checkpoint_stands(self):
        for victim, ranks_after in ((0, 2), (1, 3), (2, 1)):
            with self.subTest(victim=victim):
                bank, checkpoint = self.work / f"bank{victim}", self.work / f"checkpoint{victim}"
                command = self.train(bank, "--checkpoint", checkpoint, "--interval", 50)
                process = self.start(3, *command)
                while not checkpoint.exists():
                    self.assertIsNone(process.poll(), "it ended before its first checkpoint")
                    time.sleep(0.002)
                os.kill(children_of(process.pid)[victim], signal.SIGKILL)
                output, errors = process.communicate(timeout=60)
                self.assertNotEqual(process.returncode, 0)
                self.assertEqual(output, "")
                ends = [line for line in errors.splitlines() if "on signal 9 (Killed)" in line]
                self.assertEqual(len(ends), 1, errors)
                self.assertIn(f"rank {victim} ", ends[0])
                own = [line for line in errors.splitlines() if line.startswith("dermis: ")]
                said = "dermis: interrupted; the last checkpoint stands"
                # mpirun may not wait for what a rank says at its end.
                self.assertIn(own, ([], [said]))
                self.assertFalse(bank.exists())
                result = self.on_ranks(ranks_after, *command)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertRegex(result.stdout, r"went on from step \d*[05]0 ")
                self.assertEqual(bank.read_bytes(), self.alone.read_bytes())
                self.assertFalse(checkpoint.exists())
        self.assertEqual(list(self.work.glob("*.tmp")), [])

    def test_one_rank_says_what_is_wrong(self):
        loads = self.written("loads.csv", "frame,kind,where,value\n0,force,r99c0,1\n")
        for command, words in (
            (self.train(self.work / "bank", loads=loads), "r99c0"),
            (self.train(self.work / "bank", steps=0), "--steps: must be 1 or more"),
            (self.train(self.work / "absent" / "bank"), "absent"),
            (self.train(self.work / "bank", "--checkpoint", self.work / "gone" / "checkpoint"), "gone"),
        ):
            result = self.on_ranks(3, *command)
            self.assertNotEqual(result.returncode, 0)
            own = [line for line in error_lines(result) if line.startswith("dermis: ")]
            self.assertEqual(len(own), 1, result.stderr)
            self.assertIn(words, own[0])

    def test_who_is_not_started_by_mpirun_loads_nothing_of_mpi(self):
        result = dermis(*self.train(self.work / "bank", steps=1), env={**os.environ, "LD_DEBUG": "libs"})
        self.assertEqual(result.returncode, 0)
        loaded = set(re.findall(r"calling init: \S*/(lib\w+)", result.stderr))
        self.assertIn("libfmt", loaded)
        self.assertEqual({name for name in loaded if "mpi" in name}, set())

    def test_a_plugin_that_is_missing_is_named(self):
        binary = self.work / "dermis"
        plugin = b"libdermis_mpi.so"
        content = Path(support.BINARY).read_bytes()
        self.assertIn(plugin, content)
        binary.write_bytes(content.replace(plugin, b"libdermis_no.so\0"))
        binary.chmod(0o755)
        environment = {**os.environ, "OMPI_COMM_WORLD_SIZE": "2"}
        result = dermis(*self.train(self.work / "bank", steps=1), executable=binary, env=environment)
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, r"^dermis: mpirun needs libdermis_no\.so .* \(Debian: libopenmpi3\): .*\n$")


if __name__ == "__main__":
    support.main()
