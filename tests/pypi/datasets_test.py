# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The readers of LeRobot, h5py and zarr load datasets of episodes. Usage: datasets_test.py DERMIS

LeRobot itself needs torch, which is 8 GB with all that it brings. Where it is not installed, its loader is built here
of the packages that it is made of, `datasets` and `pyarrow`."""

import importlib.util
import json
import os
import subprocess
import sys
import unittest
from pathlib import Path

import datasets
import h5py
import numpy
import pandas
import pyarrow.parquet
import zarr
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

sys.path.append(str(Path(__file__).resolve().parents[1] / "python"))
from workspace import CalibratedArray, dermis, main

os.environ["PATH"] = f"{Path(sys.executable).parent}:{os.environ['PATH']}"  # the python3 with pyarrow
EPISODES = 3
FRAMES = 151
RATE_HZ = 150
FPS = 30
WINDOW = 5
TAXELS = (5, 4)
ORIGINS = ("time_ns", "index", "frame_index", "episode_index", "task_index")  # quantiles count from the first step


def table_of(path):
    return numpy.loadtxt(
        path, delimiter=",", skiprows=1, usecols=range(2, 2 + TAXELS[0] * TAXELS[1]), dtype=numpy.float32
    )


class Datasets(CalibratedArray):
    """Three recordings of 150 Hz, with jitter, and what a step must hold by the tables of `dermis run`."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.recordings = [cls.make_recording(episode) for episode in range(EPISODES)]
        cls.episodes = [cls.read_frames(recording) for recording in cls.recordings]
        cls.slow = cls.make_recording(EPISODES, rate_hz=50, gap_s=12)  # a tare takes a second
        cls.idle = cls.make_recording(EPISODES + 1, rate_hz=50, scene="idle")

    @classmethod
    def make_recording(cls, seed, rate_hz=RATE_HZ, gap_s=0, scene="multitouch"):
        simulated, recording = cls.folder / f"s{seed}", cls.folder / f"rec{seed}.mcap"
        dermis("simulate", "--array", cls.array, "--scene", scene, "--frames", FRAMES, "--out", simulated)
        lines = (simulated / "frames.csv").read_text().splitlines()
        jitter = numpy.random.default_rng(seed).uniform(-0.001, 0.001, FRAMES)
        times = numpy.arange(FRAMES) / rate_hz + jitter + 10 * seed + 1
        times[FRAMES * 2 // 3 :] += gap_s
        rows = [f"{time:.9f},{line.split(',', 1)[1]}" for time, line in zip(times, lines[1:], strict=True)]
        table = cls.folder / f"rec{seed}.csv"
        table.write_text("\n".join([lines[0], *rows]) + "\n")
        dermis("convert", table, recording, "--array", cls.array)
        return recording

    @classmethod
    def read_frames(cls, recording):
        """Times, counts, forces and sigma of each frame by other commands."""
        table = recording.with_suffix(".csv")
        raw = numpy.loadtxt(table, delimiter=",", skiprows=1)
        forces, sigma = cls.folder / "forces.csv", cls.folder / "sigma.csv"
        dermis("run", "--model", cls.model, "--in", recording, "--out", forces, "--sigma", sigma)
        frames = {"pad": table_of(forces), "pad_sigma": table_of(sigma), "pad_raw": raw[:, -20:].astype(numpy.float32)}
        frames["pad_valid"] = ~numpy.isnan(frames["pad"])
        frames = {
            name: numpy.where(numpy.isnan(values), 0, values).reshape(-1, *TAXELS) for name, values in frames.items()
        }
        return numpy.round(raw[:, 0] * 1e9).astype(numpy.int64), frames

    def make(self, layout, *more):
        out = self.folder / f"{self.id()}-{layout}"
        shape = ("--fps", FPS, "--window", WINDOW, "--model", self.model, *more)
        dermis("dataset", *self.recordings, "--out", out, "--format", layout, *shape)
        return out

    def check_episode(self, episode, values):
        """values: the columns of an episode by the names that HDF5 has for them."""
        times, frames = self.episodes[episode]
        steps = values["time_ns"].ravel()
        numpy.testing.assert_array_less(numpy.abs(numpy.diff(steps) - 1e9 / FPS), 1.5)
        self.assertGreaterEqual(steps[-1], times[-1])
        ends = numpy.searchsorted(times, steps, side="right")
        windows = [numpy.arange(end - WINDOW, end) for end in ends]
        for name, of_frame in frames.items():
            expected = numpy.stack(
                [of_frame[window] if window[0] >= 0 else self.filled(of_frame, window) for window in windows]
            )
            numpy.testing.assert_array_equal(values[name].astype(expected.dtype), expected, name)
        ages = numpy.stack([(step - times[window]) * 1e-9 for step, window in zip(steps, windows, strict=True)])
        numpy.testing.assert_allclose(values["pad_age"], ages, rtol=1e-6, atol=1e-9)
        fresh = values["pad_fresh"].ravel()
        numpy.testing.assert_array_equal(fresh, numpy.diff(ends, prepend=0))
        numpy.testing.assert_array_equal(fresh[:-1], WINDOW)  # none lost and none doubled
        self.assertEqual(fresh.sum(), FRAMES)

    @staticmethod
    def filled(of_frame, window):
        values = of_frame[numpy.maximum(window, 0)].copy()
        values[window < 0] = 0
        return values

    def test_h5py_reads_the_episodes_of_act(self):
        out = self.make("hdf5")
        self.assertEqual(len(list(out.glob("episode_*.hdf5"))), EPISODES)
        for episode in range(EPISODES):
            with h5py.File(out / f"episode_{episode}.hdf5") as root:
                self.assertIs(bool(root.attrs["sim"]), False)
                tactile = {name: values[:] for name, values in root["/observations/tactile"].items()}
                self.check_episode(episode, {**tactile, "time_ns": root["time_ns"][:]})

    def test_h5py_reads_the_demos_of_robomimic(self):
        with h5py.File(self.make("robomimic") / "demo.hdf5") as root:
            self.assertIn("env_name", json.loads(root["data"].attrs["env_args"]))
            self.assertEqual(len(root["data"]), EPISODES)
            for episode in range(EPISODES):
                demo = root[f"data/demo_{episode}"]
                values = {name.removeprefix("tactile_"): column[:] for name, column in demo["obs"].items()}
                self.check_episode(episode, {**values, "time_ns": demo["time_ns"][:]})
                self.assertEqual(demo.attrs["num_samples"], len(demo["time_ns"]))

    def test_zarr_reads_the_replay_buffer(self):
        root = zarr.open(str(self.make("zarr")), mode="r")
        ends = root["meta/episode_ends"][:]
        self.assertEqual(len(ends), EPISODES)
        columns = {name.removeprefix("tactile_"): values[:] for name, values in root["data"].arrays()}
        self.assertEqual({len(values) for values in columns.values()}, {ends[-1]})
        for episode, (begin, end) in enumerate(zip([0, *ends[:-1]], ends, strict=True)):
            self.check_episode(episode, {name: values[begin:end] for name, values in columns.items()})

    def test_forces_with_tare_and_drift_are_those_of_run(self):
        forced = ("--tare-force", "--follow-drift")
        cases = [(self.slow, options) for options in ((), ("--tare",), forced, ("--follow-drift",))]
        for recording, options in (*cases, (self.idle, ("--tare",))):
            with self.subTest(recording=recording.stem, options=options):
                forces = self.folder / "tared.csv"
                ran = subprocess.run(
                    [sys.argv[1], "run", "--model", self.model, "--in", recording, "--out", forces, *options],
                    capture_output=True,
                    text=True,
                )
                out = self.folder / f"{self.id()}{recording.stem}{''.join(options)}"
                made = subprocess.run(
                    [sys.argv[1], "dataset", recording, "--out", out, "--format", "zarr", "--model", self.model]
                    + ["--fps", str(FPS), "--window", str(WINDOW), *options],
                    capture_output=True,
                    text=True,
                )
                self.assertEqual(made.returncode, ran.returncode, made.stderr)
                is_refused = (recording, options) == (self.slow, ("--tare",))
                self.assertEqual(made.returncode, 1 if is_refused else 0)
                if is_refused:
                    self.assertIn("take it off and tare again", made.stderr)
                    self.assertFalse(out.exists())
                    continue
                data = zarr.open(str(out), mode="r")["data"]
                fresh = data["tactile_pad_fresh"][:].ravel()
                windows = data["tactile_pad"][:]
                frames = numpy.concatenate([window[WINDOW - n :] for window, n in zip(windows, fresh, strict=True)])
                expected = numpy.nan_to_num(table_of(forces)).reshape(-1, *TAXELS)
                numpy.testing.assert_array_equal(frames, expected)

    def test_each_layout_says_what_is_held_out(self):
        held = ("--hold-out", "0.34")
        masks = {}
        with h5py.File(self.make("robomimic", *held) / "demo.hdf5") as root:
            for name in ("train", "valid"):
                masks[name] = [demo.decode("utf-8") for demo in numpy.array(root[f"mask/{name}"][:])]
        self.assertEqual(masks, {"train": ["demo_0", "demo_1"], "valid": ["demo_2"]})
        splits = {"train": "0:2", "val": "2:3"}
        self.assertEqual(zarr.open(str(self.make("zarr", *held)), mode="r").attrs["splits"], splits)
        for layout, place in (
            ("hdf5", "tactile.json"),
            ("lerobot", "meta/tactile.json"),
            ("lerobot", "meta/info.json"),
        ):
            out = self.folder / f"{self.id()}-{layout}"
            out = out if out.exists() else self.make(layout, *held)
            self.assertEqual(json.loads((out / place).read_text())["splits"], splits)
            self.assertIn("First and last picture", (out / "summary.html").read_text())

    def marked(self):
        """The first two recordings with marks beside them."""
        marked = []
        for episode, rows in enumerate((("0.2,reach", "0.5,hold it", "0.8,"), ("0.3,lift", "0.6,hold it"))):
            recording = self.folder / f"{self.id()}{episode}.mcap"
            recording.write_bytes(self.recordings[episode].read_bytes())
            recording.with_suffix(".marks.csv").write_text("\n".join(["time_s,label", *rows]) + "\n")
            marked.append(recording)
        return marked

    @staticmethod
    def labels_at(times_ns, starts_ns, marks):
        """By numpy: the index of the last mark's label, -1 before the first."""
        indices = numpy.array([-1, *(label for _, label in marks)])
        return indices[numpy.searchsorted([second * 1e9 for second, _ in marks], times_ns - starts_ns, side="right")]

    MARKS = (((0.2, 0), (0.5, 1), (0.8, -1)), ((0.3, 2), (0.6, 1)))
    LABELS = ("reach", "hold it", "lift")

    def make_marked(self, layout, *more):
        out = self.folder / f"{self.id()}-{layout}{len(more)}"
        dermis("dataset", *self.marked(), "--out", out, "--format", layout, "--fps", FPS, *more)
        return out

    def expected_labels(self, times_ns, episode):
        return self.labels_at(times_ns, self.episodes[episode][0][0], self.MARKS[episode])

    def test_labels_are_the_tasks_of_lerobot(self):
        out = self.make_marked("lerobot", "--task", "pick the cube")
        info, loaded = self.load(out)
        columns = {name: numpy.asarray(values) for name, values in loaded.with_format("numpy")[:].items()}
        labels = numpy.concatenate(
            [self.expected_labels(columns["time_ns"][columns["episode_index"] == k], k) for k in (0, 1)]
        )
        self.assertEqual(set(labels), {-1, 0, 1, 2})
        numpy.testing.assert_array_equal(columns["label"], labels)
        numpy.testing.assert_array_equal(columns["task_index"], numpy.where(labels < 0, 3, labels))
        tasks = pandas.read_parquet(out / "meta/tasks.parquet")
        names = [*self.LABELS, "pick the cube"]
        self.assertEqual((list(tasks.index), list(tasks["task_index"])), (names, [0, 1, 2, 3]))
        self.assertEqual(info["total_tasks"], 4)
        episodes = pyarrow.parquet.read_table(out / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
        self.assertEqual(
            [row["tasks"] for row in episodes],
            [["reach", "hold it", "pick the cube"], ["hold it", "lift", "pick the cube"]],
        )

    def test_an_episode_that_a_label_cuts_has_its_task(self):
        out = self.make_marked("lerobot", "--cut")
        info, loaded = self.load(out)
        self.assertEqual((info["total_episodes"], info["total_tasks"]), (4, 3))
        episodes = pyarrow.parquet.read_table(out / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
        self.assertEqual([row["tasks"] for row in episodes], [["reach"], ["hold it"], ["lift"], ["hold it"]])
        columns = loaded.with_format("numpy")[:]
        numpy.testing.assert_array_equal(columns["label"], columns["task_index"])
        for row, recording in zip(episodes, (0, 0, 1, 1), strict=True):
            times = columns["time_ns"][row["dataset_from_index"] : row["dataset_to_index"]]
            expected = self.expected_labels(times, recording)
            self.assertEqual({self.LABELS[label] for label in expected}, set(row["tasks"]))
            self.assertAlmostEqual(len(times) / FPS, 0.3 if recording == 0 or row["tasks"] == ["lift"] else 0.4, 1)

    def test_labels_have_names_in_the_other_layouts(self):
        with h5py.File(self.make_marked("robomimic") / "demo.hdf5") as root:
            self.assertEqual(json.loads(root.attrs["labels"]), list(self.LABELS))
            for episode in (0, 1):
                demo = root[f"data/demo_{episode}"]
                expected = self.expected_labels(demo["time_ns"][:].ravel(), episode)
                numpy.testing.assert_array_equal(demo["label"][:].ravel(), expected)
        with h5py.File(self.make_marked("hdf5") / "episode_1.hdf5") as root:
            self.assertEqual(json.loads(root.attrs["labels"]), list(self.LABELS))
            self.assertIn("label", root)
        out = self.make_marked("zarr", "--cut")
        root = zarr.open(str(out), mode="r")
        self.assertEqual(root.attrs["labels"], list(self.LABELS))
        self.assertEqual(len(root["meta/episode_ends"][:]), 4)
        said = json.loads((out / "tactile.json").read_text())
        self.assertEqual(said["labels"], list(self.LABELS))
        self.assertEqual([episode["label"] for episode in said["episodes"]], ["reach", "hold it", "lift", "hold it"])

    @unittest.skipUnless(importlib.util.find_spec("dermis"), "the package of Python is not built")
    def test_python_cuts_like_the_command(self):
        module = importlib.import_module("dermis")
        dataset = module.Dataset(self.marked(), fps=FPS, cut=True)
        self.assertEqual((len(dataset), dataset.labels), (4, list(self.LABELS)))
        written = zarr.open(str(self.make_marked("zarr", "--cut")), mode="r")["data/tactile_pad_raw"][:]
        numpy.testing.assert_array_equal(numpy.concatenate([dataset[k]["pad_raw"] for k in range(4)]), written)
        with self.assertRaisesRegex(module.BadInput, "has no mark with a label"):
            len(module.Dataset(self.recordings, cut=True))

    def run_loading_example(self, out):
        example = Path(__file__).resolve().parents[2] / "examples/python/load_dataset.py"
        run = subprocess.run([sys.executable, example, out, "pad"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def test_the_example_iterates_over_the_replay_buffer(self):
        said = self.run_loading_example(self.make("zarr"))
        self.assertRegex(said, r"^93 steps, the last batch of the shape \(13, 5, 5, 4\)$")

    def features_of(self, info):
        """As lerobot.datasets makes them of info.json."""
        kinds = {2: datasets.Array2D, 3: datasets.Array3D}
        features = {}
        for name, feature in info["features"].items():
            shape, dtype = tuple(feature["shape"]), feature["dtype"]
            if shape == (1,):
                features[name] = datasets.Value(dtype)
            elif len(shape) == 1:
                features[name] = datasets.Sequence(datasets.Value(dtype), length=shape[0])
            else:
                features[name] = kinds[len(shape)](shape=shape, dtype=dtype)
        return datasets.Features(features)

    def load(self, out):
        info = json.loads((out / "meta/info.json").read_text())
        paths = sorted(str(path) for path in (out / "data").glob("*/*.parquet"))
        return info, datasets.Dataset.from_parquet(
            paths, features=self.features_of(info), cache_dir=str(self.folder / "cache"), keep_in_memory=True
        )

    def test_datasets_loads_what_lerobot_loads(self):
        out = self.make("lerobot", "--task", "pick the cube")
        info, loaded = self.load(out)
        columns = {name: numpy.asarray(values) for name, values in loaded.with_format("numpy")[:].items()}
        self.assertEqual((info["codebase_version"], info["fps"]), ("v3.0", FPS))
        self.assertEqual((info["total_episodes"], info["total_frames"]), (EPISODES, len(loaded)))
        numpy.testing.assert_array_equal(columns["index"], numpy.arange(len(loaded)))
        first = {name: float(values.flat[0]) for name, values in columns.items()}
        episodes = pyarrow.parquet.read_table(out / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
        for row in episodes:
            rows = slice(row["dataset_from_index"], row["dataset_to_index"])
            self.assertEqual((rows.stop - rows.start, row["tasks"]), (row["length"], ["pick the cube"]))
            numpy.testing.assert_array_equal(columns["episode_index"][rows], row["episode_index"])
            numpy.testing.assert_array_equal(columns["frame_index"][rows], numpy.arange(row["length"]))
            numpy.testing.assert_allclose(columns["timestamp"][rows], numpy.arange(row["length"]) / FPS, rtol=1e-6)
            tactile = {name.removeprefix("observation.tactile."): values[rows] for name, values in columns.items()}
            self.check_episode(row["episode_index"], tactile)
            stats = {name: {} for name in columns}
            for name, value in row.items():
                if name.startswith("stats/"):
                    stats[name.removeprefix("stats/").rsplit("/", 1)[0]][name.rsplit("/", 1)[1]] = value
            self.check_statistics(stats, {name: values[rows] for name, values in columns.items()}, first)
        # LeRobot's loader of this table infers the features, statistics included.
        table = datasets.Dataset.from_parquet(
            str(out / "meta/episodes/chunk-000/file-000.parquet"), cache_dir=str(self.folder / "cache")
        )
        self.assertEqual(list(table["length"]), [row["length"] for row in episodes])
        tasks = pandas.read_parquet(out / "meta/tasks.parquet")
        self.assertEqual((list(tasks.index), list(tasks["task_index"])), (["pick the cube"], [0]))
        stats = json.loads((out / "meta/stats.json").read_text())
        self.assertIn("element_std", stats["observation.tactile.pad"])
        self.check_statistics(stats, columns, first)

    def check_statistics(self, stats, columns, first):
        self.assertEqual(set(stats), set(columns))
        for name, values in columns.items():
            values = values.astype(numpy.float64)
            values[~numpy.isfinite(values)] = numpy.nan
            # Contacts have five quantities; all other elements of a tactile column are of one kind.
            kinds = 5 if name.endswith("_contacts") else None
            pooled = values.reshape(-1, kinds) if kinds else values.reshape(-1)
            whole = {
                "min": numpy.nanmin(pooled, 0),
                "max": numpy.nanmax(pooled, 0),
                "mean": numpy.nanmean(pooled, 0),
                "std": numpy.nanstd(pooled, 0),
            }
            for key, expected in whole.items():
                got = numpy.asarray(stats[name][key])
                self.assertEqual(got.shape, values.shape[1:] or (1,))
                expected = numpy.broadcast_to(expected, got.shape)
                numpy.testing.assert_allclose(got, expected, rtol=1e-5, atol=1e-7, err_msg=f"{name}, {key}")
            begin = first[name] if name in ORIGINS else 0
            for key, share in {"q01": 0.01, "q10": 0.1, "q50": 0.5, "q90": 0.9, "q99": 0.99}.items():
                got = numpy.asarray(stats[name][key])
                expected = numpy.nanquantile(pooled, share, 0, method="inverted_cdf")
                expected = numpy.broadcast_to(expected, got.shape)
                numpy.testing.assert_allclose(got - begin, expected - begin, rtol=2e-3, err_msg=f"{name}, {key}")
            if "element_std" in stats[name]:
                self.check_elements(stats[name], values)
            self.assertEqual(stats[name]["count"], [len(values)])

    def check_elements(self, stats, values):
        for key, of in {"min": numpy.nanmin, "max": numpy.nanmax, "mean": numpy.nanmean, "std": numpy.nanstd}.items():
            numpy.testing.assert_allclose(stats[f"element_{key}"], of(values, 0), rtol=1e-5, atol=1e-7, err_msg=key)

    def bag_with_joints(self, recording, times_ns, angles):
        """The frames of a recording beside joints, as ROS 2 records them."""
        store = get_typestore(Stores.ROS2_JAZZY)
        types = store.types
        stamp = types["builtin_interfaces/msg/Time"](sec=1, nanosec=2)
        header = types["std_msgs/msg/Header"](stamp=stamp, frame_id="base")
        joint_state, none = types["sensor_msgs/msg/JointState"], numpy.zeros(0)
        messages = []
        folder = self.folder / f"{self.id()}-{recording.stem}"
        with AnyReader([recording]) as reader, Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as bag:
            topics = {
                connection.id: bag.add_connection(connection.topic, connection.msgtype, typestore=reader.typestore)
                for connection in reader.connections
            }
            joints = bag.add_connection("/joint_states", joint_state.__msgtype__, typestore=store)
            messages = [(stamp, topics[connection.id], content) for connection, stamp, content in reader.messages()]
            for time, row in zip(times_ns, angles, strict=True):
                message = joint_state(header, ["elbow", "wrist"], row, none, none)
                messages.append((int(time), joints, store.serialize_cdr(message, joint_state.__msgtype__)))
            for stamp, topic, content in sorted(messages, key=lambda message: message[0]):
                bag.write(topic, stamp, content)
        (written,) = folder.glob("*.mcap")
        return written

    def test_joints_of_a_bag_are_the_state(self):
        times = self.episodes[0][0][0] + numpy.arange(100) * 10**7
        angles = numpy.random.default_rng(1).normal(size=(100, 2))
        bag = self.bag_with_joints(self.recordings[0], times, angles)
        out = self.folder / self.id()
        dermis("dataset", bag, "--out", out, "--fps", FPS, "--window", WINDOW)
        info, loaded = self.load(out)
        self.assertEqual(info["features"]["observation.state"]["names"], ["elbow", "wrist"])
        columns = loaded.with_format("numpy")[:]
        newest = numpy.maximum(numpy.searchsorted(times, columns["time_ns"], side="right") - 1, 0)
        numpy.testing.assert_array_equal(columns["observation.state"], angles[newest].astype(numpy.float32))

    @unittest.skipUnless(importlib.util.find_spec("dermis"), "the package of Python is not built")
    def test_python_warns_of_joints_that_differ_and_takes_none_when_told(self):
        module = importlib.import_module("dermis")
        times = self.episodes[0][0][0] + numpy.arange(2) * 10**7
        bags = [
            self.bag_with_joints(recording, times, numpy.array([[1.0, wrist]] * 2))
            for recording, wrist in zip(self.recordings[:2], (2.0, numpy.nan), strict=True)
        ]
        with self.assertWarnsRegex(UserWarning, "so there is no column of the state"):
            self.assertNotIn("state", module.Dataset(bags, fps=FPS)[0])
        self.assertEqual(module.Dataset(bags[0], fps=FPS)[0]["state"][0].tolist(), [1.0, 2.0])
        self.assertNotIn("state", module.Dataset(bags[0], fps=FPS, state=())[0])

    @unittest.skipUnless(importlib.util.find_spec("dermis"), "the package of Python is not built")
    def test_python_tares_and_holds_out_like_the_command(self):
        module = importlib.import_module("dermis")
        options = {"model": self.model, "fps": FPS, "window": WINDOW, "follow_drift": True, "tare_force": True}
        recording = self.slow
        dataset = module.Dataset([recording] * 3, hold_out=0.34, **options)
        self.assertEqual((len(dataset), dataset.held_out), (6, [4, 5]))
        out = self.folder / self.id()
        how = ("--fps", FPS, "--window", WINDOW, "--model", self.model, "--follow-drift", "--tare-force")
        dermis("dataset", recording, "--out", out, "--format", "zarr", *how)
        written = zarr.open(str(out), mode="r")["data/tactile_pad"][:]
        numpy.testing.assert_array_equal(numpy.concatenate([dataset[k]["pad"] for k in (0, 1)]), written)
        self.assertEqual(module.Dataset(self.recordings, hold_out=self.recordings[1]).held_out, [EPISODES - 1])

    def test_batches_in_any_order_have_one_shape(self):
        _, loaded = self.load(self.make("lerobot", "--flat"))
        sizes = set()
        for batch in loaded.shuffle(seed=1).with_format("numpy").iter(batch_size=16):
            sizes.add(numpy.asarray(batch["observation.tactile.pad"]).shape[1:])
        self.assertEqual(sizes, {(WINDOW * TAXELS[0] * TAXELS[1],)})

    @unittest.skipUnless(
        importlib.util.find_spec("lerobot"), "lerobot is not installed: torch is too large for the gate"
    )
    def test_lerobot_itself_iterates(self):
        import torch
        from lerobot.datasets.lerobot_dataset import LeRobotDataset

        out = self.make("lerobot")
        self.assertRegex(self.run_loading_example(out), r"^93 steps")
        dataset = LeRobotDataset("dermis/test", root=out)
        self.assertEqual((dataset.num_episodes, dataset.num_frames), (EPISODES, len(dataset)))
        _, loaded = self.load(out)
        for index in (0, len(dataset) - 1):
            tactile = dataset[index]["observation.tactile.pad"].numpy()
            numpy.testing.assert_array_equal(
                tactile, numpy.asarray(loaded[index]["observation.tactile.pad"], "float32")
            )
        steps = sum(len(batch["index"]) for batch in torch.utils.data.DataLoader(dataset, batch_size=8, shuffle=True))
        self.assertEqual(steps, len(dataset))


if __name__ == "__main__":
    main()
