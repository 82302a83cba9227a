# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A dataset of LeRobot v3 gets tactile columns, as pyarrow and datasets read it.
Usage: extend_lerobot_test.py DERMIS"""

import hashlib
import importlib.util
import json
import shutil
import sys
import unittest.mock
from pathlib import Path

import datasets
import numpy
import pandas
import pyarrow
import pyarrow.parquet

sys.path.append(str(Path(__file__).resolve().parents[1] / "python"))
import workspace

import dermis

FPS = 20
STEPS = (25, 30, 18)  # of each episode
FILES = ((0, 1), (2,))  # the episodes of each file of data
WINDOW = 3
START = 1_760_000_000_000_000_000
OWN = ("timestamp", "frame_index", "episode_index", "index", "task_index")


def digest(folder):
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def data_of(folder):
    files = sorted((folder / "data").glob("*/*.parquet"))
    return pyarrow.concat_tables([pyarrow.parquet.read_table(file) for file in files])


def values_of(table, name):
    return numpy.asarray(table[name].to_pylist())


def statistics(values, name):
    """Those of all elements of a kind, at each element: contacts have five kinds, other columns one."""
    shape = values.shape[1:]
    values = numpy.where(numpy.isfinite(values), values, numpy.nan).astype(numpy.float64)
    values = values.reshape((-1, 5) if name.endswith("_contacts") else -1)
    reduced = {"min": numpy.nanmin, "max": numpy.nanmax, "mean": numpy.nanmean, "std": numpy.nanstd}
    return {key: numpy.broadcast_to(of(values, 0), shape) for key, of in reduced.items()}


class ExtendedDatasets(workspace.CalibratedArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        frames = dermis.Recording.read(cls.frames)
        cls.recordings = []
        for episode in range(len(STEPS)):
            recording = cls.folder / f"touch{episode}.mcap"
            times = START + episode * 60 * 10**9 + numpy.arange(len(frames)) * 10**9 // 35
            dermis.Recording(frames.counts[:, ::-1], time_ns=times, array=cls.array).write(recording)
            cls.recordings.append(recording)
        cls.old = cls.folder / "old"
        cls.write_old()
        cls.before = digest(cls.old)

    @classmethod
    def write_old(cls):
        """As LeRobot writes it: by `datasets`, with statistics of its own and a video."""
        random = numpy.random.default_rng(1)
        features = datasets.Features(
            {
                "action": datasets.Sequence(datasets.Value("float32"), length=2),
                "timestamp": datasets.Value("float32"),
                **{name: datasets.Value("int64") for name in OWN[1:]},
            }
        )
        rows = []
        for episode, steps in enumerate(STEPS):
            for step in range(steps):
                own = (numpy.float32(step / FPS), step, episode, len(rows), 0)
                rows.append({"action": random.normal(size=2).astype("float32"), **dict(zip(OWN, own, strict=True))})
        (cls.old / "meta/episodes/chunk-000").mkdir(parents=True)
        for file, episodes in enumerate(FILES):
            table = datasets.Dataset.from_list(
                [row for row in rows if row["episode_index"] in episodes], features=features
            )
            (cls.old / "data/chunk-000").mkdir(parents=True, exist_ok=True)
            table.to_parquet(cls.old / f"data/chunk-000/file-{file:03}.parquet", batch_size=20)
        episodes = {"episode_index": list(range(len(STEPS))), "length": list(STEPS)}
        episodes["stats/action/q01"] = [[0.0, 0.1]] * len(STEPS)
        pyarrow.parquet.write_table(pyarrow.table(episodes), cls.old / "meta/episodes/chunk-000/file-000.parquet")
        pandas.DataFrame({"task_index": [0]}, index=["push"]).to_parquet(cls.old / "meta/tasks.parquet")
        (cls.old / "meta/stats.json").write_text(json.dumps({"action": {"q01": [0.0, 0.1]}}))
        shapes = {"action": ("float32", [2]), "timestamp": ("float32", [1]), **dict.fromkeys(OWN[1:], ("int64", [1]))}
        info = {"codebase_version": "v3.0", "fps": FPS, "total_frames": len(rows), "robot_type": "so101"}
        info["features"] = {
            name: {"dtype": dtype, "shape": shape, "names": None} for name, (dtype, shape) in shapes.items()
        }
        (cls.old / "meta/info.json").write_text(json.dumps(info))
        video = cls.old / "videos/front/chunk-000/file-000.mp4"
        video.parent.mkdir(parents=True)
        video.write_bytes(b"no real pictures")

    def extend(self, recordings, **options):
        new = self.folder / f"new-{self.id()}"
        dermis.extend_lerobot(self.old, new, recordings, model=self.model, window=WINDOW, **options)
        self.assertEqual(digest(self.old), self.before)
        self.assertFalse(list(self.folder.glob(f".{new.name}*")))
        return new

    def expected(self, recordings, starts):
        """The same columns of a dataset that is made at these times."""
        times = [
            start + numpy.round(numpy.arange(steps) / FPS * 1e9).astype(numpy.int64)
            for start, steps in zip(starts, STEPS, strict=True)
        ]
        made = dermis.Dataset(recordings, model=self.model, window=WINDOW, times_ns=times)
        episodes = [made[episode] for episode in range(len(made))]
        return {
            f"observation.tactile.{name}": [episode[name] for episode in episodes]
            for name in episodes[0]
            if name.startswith("pad")
        }

    def check(self, new, expected):
        old, table = data_of(self.old), data_of(new)
        self.assertEqual(table.column_names, [*old.column_names, *expected])
        for name in old.column_names:
            self.assertTrue(table[name].equals(old[name]), name)
        stats = json.loads((new / "meta/stats.json").read_text())
        episodes = pyarrow.parquet.read_table(new / "meta/episodes/chunk-000/file-000.parquet")
        self.assertEqual(episodes["stats/action/q01"].to_pylist(), [[0.0, 0.1]] * len(STEPS))
        self.assertEqual(stats["action"], {"q01": [0.0, 0.1]})
        for name, of_episodes in expected.items():
            numpy.testing.assert_array_equal(values_of(table, name), numpy.concatenate(of_episodes), name)
            self.expect_statistics(stats[name], numpy.concatenate(of_episodes), name)
            for row, values in enumerate(of_episodes):
                keys = ("min", "max", "mean", "std", "count")
                got = {key: episodes[f"stats/{name}/{key}"][row].as_py() for key in keys}
                self.expect_statistics(got, values, name)

    def expect_statistics(self, got, values, name):
        self.assertEqual(got["count"], [len(values)])
        for key, value in statistics(values, name).items():
            numpy.testing.assert_allclose(
                numpy.asarray(got[key]).reshape(value.shape), value, rtol=1e-6, atol=1e-7, err_msg=f"{name} {key}"
            )

    def test_columns_have_the_times_of_the_steps_from_the_first_frame_on(self):
        new = self.extend(self.recordings)
        half_a_frame = 10**9 // 35 // 2
        starts = [START + k * 60 * 10**9 + half_a_frame for k in range(len(STEPS))]
        self.check(new, self.expected(self.recordings, starts))
        video = Path("videos/front/chunk-000/file-000.mp4")
        self.assertTrue((new / video).samefile(self.old / video))
        self.assertEqual((new / "meta/tasks.parquet").read_bytes(), (self.old / "meta/tasks.parquet").read_bytes())

    def test_frames_at_the_times_of_the_steps_are_all_in_windows(self):
        frames = dermis.Recording.read(self.frames)
        counts = numpy.resize(frames.counts, (5 * max(STEPS), *frames.counts.shape[1:]))
        even = self.folder / "even.mcap"
        times = START + numpy.arange(len(counts)) * 10**9 // (5 * FPS)
        dermis.Recording(counts, time_ns=times, array=self.array).write(even)
        new = self.folder / "even"
        dermis.extend_lerobot(self.old, new, [even] * len(STEPS), window=5, columns=["fresh"])
        fresh = values_of(data_of(new), "observation.tactile.pad_fresh")
        first = numpy.cumsum((0, *STEPS[:-1]))
        self.assertEqual(set(fresh[first]), {1})
        self.assertEqual(set(numpy.delete(fresh, first)), {5})

    def test_one_recording_has_all_episodes_where_they_begin(self):
        long = self.folder / "long.mcap"
        frames = dermis.Recording.read(self.frames)
        times = START + numpy.arange(len(frames)) * 10**8
        dermis.Recording(frames.counts, time_ns=times, array=self.array).write(long)
        starts = [START + 5 * 10**8, START + 2 * 10**9, START + 45 * 10**8]
        new = self.extend(long, starts_ns=starts)
        self.check(new, self.expected([long] * len(STEPS), starts))
        self.refuse("must rise", self.old, long, starts_ns=[*starts[:2], starts[1]])

    def test_datasets_loads_the_features_of_info(self):
        new = self.extend(self.recordings, columns=["forces", "age"])
        info = json.loads((new / "meta/info.json").read_text())
        self.assertEqual(info["robot_type"], "so101")
        forces = info["features"]["observation.tactile.pad"]
        self.assertEqual(forces, {"dtype": "float32", "shape": [WINDOW, 5, 4], "names": ["window", "rows", "cols"]})
        paths = [str(path) for path in sorted((new / "data").glob("*/*.parquet"))]
        features = datasets.Features(
            {
                "action": datasets.Sequence(datasets.Value("float32"), length=2),
                "timestamp": datasets.Value("float32"),
                **{name: datasets.Value("int64") for name in OWN[1:]},
                "observation.tactile.pad": datasets.Array3D((WINDOW, 5, 4), "float32"),
                "observation.tactile.pad_age": datasets.Sequence(datasets.Value("float32"), length=WINDOW),
            }
        )
        for how in ({"features": features}, {}):
            cache = self.folder / f"cache{len(how)}"
            loaded = datasets.Dataset.from_parquet(paths, cache_dir=str(cache), keep_in_memory=True, **how)
            batch = loaded.with_format("numpy")[:7]["observation.tactile.pad"]
            self.assertEqual(numpy.asarray(batch).shape, (7, WINDOW, 5, 4))

    def lerobot_dataset(self):
        from lerobot.datasets.lerobot_dataset import LeRobotDataset

        features = {
            "action": {"dtype": "float32", "shape": (2,), "names": ["elbow", "wrist"]},
            "observation.images.front": {
                "dtype": "image",
                "shape": (8, 8, 3),
                "names": ["height", "width", "channels"],
            },
        }
        old = LeRobotDataset.create("dermis/old", FPS, features, root=self.folder / "lerobot", use_videos=False)
        random = numpy.random.default_rng(1)
        for steps in STEPS:
            for _ in range(steps):
                picture = random.integers(0, 255, (8, 8, 3), dtype=numpy.uint8)
                action = random.normal(size=2).astype(numpy.float32)
                old.add_frame({"action": action, "observation.images.front": picture, "task": "push"})
            old.save_episode()
        old.finalize()
        return LeRobotDataset("dermis/old", root=old.root)

    @unittest.skipUnless(
        importlib.util.find_spec("lerobot"), "lerobot is not installed: torch is too large for the gate"
    )
    def test_lerobot_itself_loads_and_splits_its_own_dataset_with_touch(self):
        from lerobot.datasets.dataset_tools import delete_episodes
        from lerobot.datasets.lerobot_dataset import LeRobotDataset

        old, new = self.lerobot_dataset(), self.folder / "lerobot_touch"
        dermis.extend_lerobot(old.root, new, self.recordings, model=self.model, window=WINDOW, flat=True)
        extended = LeRobotDataset("dermis/new", root=new)
        self.assertEqual((len(extended), extended.num_episodes), (sum(STEPS), len(STEPS)))
        forces = []
        for before, after in zip(old, extended, strict=True):
            for name, value in before.items():
                self.assertEqual(repr(value), repr(after[name]), name)
            forces.append(after["observation.tactile.pad"].numpy())
        less = delete_episodes(extended, [1], output_dir=self.folder / "less", repo_id="dermis/less")
        left = numpy.array(forces[: STEPS[0]] + forces[-STEPS[2] :])
        self.assertEqual(len(less), len(left))
        self.expect_statistics(less.meta.stats["observation.tactile.pad"], left, "observation.tactile.pad")

    def refuse(self, part, old, recordings, **options):
        new = self.folder / "refused"
        with self.assertRaises(dermis.BadInput) as raised:
            dermis.extend_lerobot(old, new, recordings, model=self.model, **options)
        self.assertIn(part, str(raised.exception))
        self.assertFalse(new.exists())
        self.assertFalse(list(self.folder.glob(f".{new.name}*")))

    def test_what_cannot_be_is_refused(self):
        self.refuse("has 3 episodes, and there are 2 recordings", self.old, self.recordings[:2])
        self.refuse("no JSON of LeRobot", self.folder / "calibration", self.recordings)
        self.refuse("has 2 times for 3 episodes", self.old, self.recordings, starts_ns=[0, 1])
        for wrong in (5, [[0], [1], [2]], [2**70] * 3, ["a"] * 3):
            self.refuse("starts_ns: ", self.old, self.recordings, starts_ns=wrong)
        starts = [START + k * 60 * 10**9 for k in range(len(STEPS))]
        self.refuse("begins after the last step of episode 0", self.old, self.recordings, starts_ns=[0, *starts[1:]])
        self.refuse(
            "ends before the first step of episode 2",
            self.old,
            self.recordings,
            starts_ns=[*starts[:2], starts[2] + 10**10],
        )
        with self.assertRaisesRegex(dermis.BadInput, "lies within .*; name a folder outside"):
            dermis.extend_lerobot(self.old, self.old / "more/touch", self.recordings)
        self.assertEqual(digest(self.old), self.before)
        self.assertFalse((self.old / "more").exists())
        twice = self.extend(self.recordings)
        self.refuse("has observation.tactile.pad already", twice, self.recordings)
        with self.assertRaisesRegex(dermis.BadInput, "exists; name a new folder"):
            dermis.extend_lerobot(self.old, twice, self.recordings)

    def damaged(self):
        """A copy of the dataset, to be damaged."""
        copy = self.folder / f"damaged-{self.id()}"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(self.old, copy)
        return copy

    def test_damaged_json_is_named(self):
        info = json.loads((self.old / "meta/info.json").read_text())
        for part, content in (
            ("info.json: is no JSON", []),
            ("is no dataset of LeRobot v3", {**info, "codebase_version": "v2.1"}),
            ("info.json: has no features", {**info, "features": None}),
            ("info.json: fps is no number", {**info, "fps": "20"}),
            ("info.json: fps is no number", {name: value for name, value in info.items() if name != "fps"}),
        ):
            copy = self.damaged()
            (copy / "meta/info.json").write_text(json.dumps(content))
            self.refuse(part, copy, self.recordings)
        copy = self.damaged()
        (copy / "meta/stats.json").write_text("[]")
        self.refuse("stats.json: is no JSON", copy, self.recordings)

    def test_damaged_parquet_is_named(self):
        data, episodes = "data/chunk-000/file-001.parquet", "meta/episodes/chunk-000/file-000.parquet"
        for name in (data, episodes):
            copy = self.damaged()
            (copy / name).write_bytes((copy / name).read_bytes()[:-20])
            self.refuse(f"{name}: is no Parquet of LeRobot", copy, self.recordings)
        for name, column in (
            (data, "timestamp"),
            (data, "frame_index"),
            (data, "episode_index"),
            (episodes, "episode_index"),
        ):
            copy = self.damaged()
            table = pyarrow.parquet.read_table(copy / name)
            pyarrow.parquet.write_table(table.drop_columns([column]), copy / name)
            self.refuse(f"{name}: is no Parquet of LeRobot: has no column {column}", copy, self.recordings)
            place = table.column_names.index(column)
            words = pyarrow.array(["word"] * len(table))
            pyarrow.parquet.write_table(table.set_column(place, column, words), copy / name)
            self.refuse(f"{name}: is no Parquet of LeRobot", copy, self.recordings)
            gaps = pyarrow.nulls(len(table), pyarrow.float32())
            pyarrow.parquet.write_table(table.set_column(place, column, gaps), copy / name)
            self.refuse(f"has a row without {column}", copy, self.recordings)
        copy = self.damaged()
        table = pyarrow.parquet.read_table(copy / episodes)
        numbers = pyarrow.array([0, 1, 7])
        pyarrow.parquet.write_table(table.set_column(0, "episode_index", numbers), copy / episodes)
        self.refuse("has episode 7, of which there is no step", copy, self.recordings)

    def test_videos_behind_links_and_files_without_rows_come_along(self):
        copy = self.damaged()
        (copy / "videos").rename(self.folder / "elsewhere")
        (copy / "videos").symlink_to(self.folder / "elsewhere")
        (copy / "videos/loop").symlink_to(self.folder / "elsewhere")
        empty = "data/chunk-000/file-002.parquet"
        table = pyarrow.parquet.read_table(copy / "data/chunk-000/file-001.parquet")
        with pyarrow.parquet.ParquetWriter(copy / empty, table.schema):
            pass
        for path in ("tasks.parquet", "stats.json"):
            (copy / "meta" / path).unlink()
        shutil.rmtree(copy / "meta/episodes")  # which leaves nothing but info.json
        new = self.folder / "linked"
        dermis.extend_lerobot(copy, new, self.recordings, columns=["age"])
        self.assertEqual(
            (new / "videos/front/chunk-000/file-000.mp4").read_bytes(),
            (self.old / "videos/front/chunk-000/file-000.mp4").read_bytes(),
        )
        self.assertFalse((new / "videos/loop").exists())
        added = pyarrow.parquet.read_table(new / empty)
        self.assertEqual(added.num_rows, 0)
        self.assertIn("observation.tactile.pad_age", added.column_names)

    def test_a_machine_without_pyarrow_is_told_so(self):
        without = unittest.mock.patch.dict(sys.modules, {"pyarrow.parquet": None})
        with without, self.assertRaisesRegex(dermis.Failed, "pip install pyarrow"):
            dermis.extend_lerobot(self.old, self.folder / "none", self.recordings)


if __name__ == "__main__":
    workspace.main()
