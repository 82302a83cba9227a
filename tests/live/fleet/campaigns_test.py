# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The campaigns of examples/fleet: on a Ray cluster of two nodes of which a worker and a node are killed, by GNU
parallel, and as the tasks of a Slurm array. The long gate runs this. Usage: campaigns_test.py DERMIS"""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from types import SimpleNamespace

ROOT = Path(__file__).resolve().parents[3]
sys.path += [str(ROOT / "scripts"), str(ROOT / "examples/fleet")]
sys.dont_write_bytecode = True
import ray_campaign  # noqa: E402  after its path
from served_suit import free_port  # noqa: E402

DERMIS = Path(sys.argv.pop(1)).resolve()
EXAMPLES = ROOT / "examples/fleet"
RECORDINGS = 8
MOST_SECONDS = 300


def dermis(folder, *words):
    subprocess.run([DERMIS, *map(str, words)], cwd=folder, check=True, capture_output=True)


def files_in(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def command_of(process):
    try:
        return Path(f"/proc/{process}/cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
    except OSError:
        return ""  # it has ended


def children_of(process):
    try:
        listed = "".join(task.read_text() for task in Path(f"/proc/{process}/task").glob("*/children"))
    except OSError:
        return []
    children = [int(child) for child in listed.split()]
    return children + [below for child in children for below in children_of(child)]


class Campaign(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(made.cleanup)
        cls.folder = Path(made.name)
        shutil.copy(ROOT / "examples/chest/array.toml", cls.folder)
        for k in range(RECORDINGS):
            dermis(cls.folder, "simulate", "--array", "array.toml", "--scene", "calibration", "--seed", k, "--out", "s")
            dermis(cls.folder, "convert", "s/frames.csv", f"{k}.mcap")
            (cls.folder / "s/loads.csv").rename(cls.folder / f"{k}.loads.csv")
            shutil.rmtree(cls.folder / "s")
        words = ["--array", "array.toml", "--frames", "0.mcap", "--loads", "0.loads.csv"]
        dermis(cls.folder, "calibrate", *words, "--out", "model.safetensors")
        cls.recordings = [cls.folder / f"{k}.mcap" for k in range(RECORDINGS)]


class Ray(Campaign):
    """Two nodes with a core each."""

    def setUp(self):
        self.out = self.folder / self.id()
        self.home = tempfile.TemporaryDirectory(prefix="ray")
        self.addCleanup(self.home.cleanup)
        self.environment = {
            **os.environ,
            "HOME": self.home.name,
            "RAY_USAGE_STATS_ENABLED": "0",
            "RAY_ADDRESS": f"127.0.0.1:{free_port()}",
        }
        address = self.environment["RAY_ADDRESS"]
        head = ["--head", "--node-ip-address=127.0.0.1", f"--port={address.split(':')[1]}", "--include-dashboard=false"]
        self.nodes = [self.start_node(*head, f"--temp-dir={self.home.name}")]
        self.wait_until(lambda: self.ray("status").returncode == 0)
        self.nodes.append(self.start_node(f"--address={address}", "--node-ip-address=127.0.0.1"))
        self.wait_until(lambda: "/2.0 CPU" in self.ray("status").stdout)

    def ray(self, *words):
        return subprocess.run(
            [sys.executable, "-m", "ray.scripts.scripts", *words],
            env=self.environment,
            capture_output=True,
            text=True,
            check=False,
        )

    def start_node(self, *words):
        command = [sys.executable, "-m", "ray.scripts.scripts", "start", "--block", "--num-cpus=1", *words]
        with open(Path(self.home.name) / "log", "ab") as log:
            node = subprocess.Popen(command, env=self.environment, stdout=log, stderr=log)
        self.addCleanup(self.kill_node, node)
        return node

    def kill_node(self, node):
        for process in [*children_of(node.pid), node.pid]:
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
        node.wait()

    def wait_until(self, is_so, campaign=None):
        end = time.monotonic() + MOST_SECONDS
        while not is_so():
            self.assertFalse(campaign and campaign.poll() is not None, "the campaign has ended before")
            self.assertLess(time.monotonic(), end, (Path(self.home.name) / "log").read_text())
            time.sleep(0.05)

    def workers(self, node):
        """Processes of a node that do work now."""
        return [process for process in children_of(node.pid) if command_of(process).startswith("ray::do")]

    def start(self, *words):
        command = [sys.executable, EXAMPLES / "ray_campaign.py", *words, "--out", self.out]
        return subprocess.Popen(
            list(map(str, [*command, *self.recordings])),
            cwd=self.folder,
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def expect_all_done(self, campaign):
        said, errors = campaign.communicate(timeout=MOST_SECONDS)
        self.assertEqual(campaign.returncode, 0, errors)
        self.assertEqual(said.splitlines()[-1], f"{RECORDINGS} of {RECORDINGS} are done")  # after what Ray says

    def expect_outputs_of(self, work, suffix, **options):
        """They are what the package makes here, and nothing else is there."""
        alone = self.folder / f"{self.id()}.alone"
        alone.mkdir()
        for recording in self.recordings:
            ray_campaign.do(recording, SimpleNamespace(work=work, **options), alone / (recording.stem + suffix))
        made, expected = files_in(self.out), files_in(alone)
        self.assertEqual({name for name in made if not name.startswith(".")}, set(expected))
        for name, content in expected.items():
            self.assertEqual(made[name], content, name)

    def test_work_of_a_killed_worker_is_done_by_another(self):
        campaign = self.start("calibrate", "--array", "array.toml")
        self.wait_until(lambda: any(map(self.workers, self.nodes)), campaign)
        os.kill(next(process for node in self.nodes for process in self.workers(node)), signal.SIGKILL)
        self.expect_all_done(campaign)
        self.expect_outputs_of("calibrate", ".safetensors", array=self.folder / "array.toml")

    def test_work_of_a_killed_node_is_done_by_another(self):
        campaign = self.start("calibrate", "--array", "array.toml")
        self.wait_until(lambda: self.workers(self.nodes[1]), campaign)
        self.kill_node(self.nodes[1])
        self.expect_all_done(campaign)
        self.expect_outputs_of("calibrate", ".safetensors", array=self.folder / "array.toml")

    def test_every_kind_of_work(self):
        model = self.folder / "model.safetensors"
        for work, suffix, options in (
            ("evaluate", ".json", {"model": model}),
            ("convert", ".csv", {"ending": ".csv"}),
            ("dataset", "", {"model": model, "format": "zarr"}),
        ):
            words = [word for name, value in options.items() for word in (f"--{name}", value)]
            self.expect_all_done(self.start(work, *words))
            self.expect_outputs_of(work, suffix, **options)
            for folder in (self.out, self.folder / f"{self.id()}.alone"):
                shutil.rmtree(folder)

    def test_an_error_is_final_and_names_the_recording(self):
        (self.folder / "bad.mcap").write_text("no recording")
        self.addCleanup((self.folder / "bad.mcap").unlink)
        self.recordings = [self.folder / "bad.mcap", self.folder / "0.mcap"]
        campaign = self.start("convert")
        said, errors = campaign.communicate(timeout=MOST_SECONDS)
        self.assertEqual((campaign.returncode, said.splitlines()[-1]), (1, "1 of 2 are done"), errors)
        self.assertIn(f"{self.recordings[0]}: ", errors)


class Lines(Campaign):
    """jobs.txt, a line a job."""

    def setUp(self):
        self.out = self.folder / "out"
        self.out.mkdir()
        self.addCleanup(shutil.rmtree, self.out)
        for name, number in (("monday", 0), ("tuesday", 1)):
            for ending in ("mcap", "loads.csv"):
                shutil.copy(self.folder / f"{number}.{ending}", self.folder / f"{name}.{ending}")
        shutil.copy(self.folder / "model.safetensors", self.folder / "chest.safetensors")
        self.environment = {**os.environ, "PATH": f"{DERMIS.parent}:{os.environ['PATH']}"}

    def expect_outputs(self):
        names = {path.name for path in self.out.iterdir()}
        self.assertEqual(names, {"monday.safetensors", "tuesday.report", "tuesday.h5", "tuesday"})

    def test_gnu_parallel_does_them(self):
        if shutil.which("parallel") is None:
            self.skipTest("GNU parallel is not installed")
        command = ["parallel", "--will-cite", "--joblog", "log", "--colsep", " ", "-a", EXAMPLES / "jobs.txt", "dermis"]
        subprocess.run(command, cwd=self.folder, env=self.environment, check=True)
        self.expect_outputs()

    def test_the_tasks_of_a_slurm_array_do_one_each(self):
        for task in range(1, len((EXAMPLES / "jobs.txt").read_text().splitlines()) + 1):
            subprocess.run(
                ["bash", EXAMPLES / "slurm_array.sh", EXAMPLES / "jobs.txt"],
                cwd=self.folder,
                env={**self.environment, "SLURM_ARRAY_TASK_ID": str(task)},
                check=True,
            )
        self.expect_outputs()


if __name__ == "__main__":
    unittest.main()
