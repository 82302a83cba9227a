# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Recording.read() of Parquet and datasets of LeRobot (pyarrow) and of zarr, as these packages of PyPI write them."""

import json
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np
import pyarrow
import pyarrow.parquet
import zarr

import dermis

COUNTS = np.arange(60)[:, None, None] % 20 + np.arange(12.0).reshape(3, 4)
TIMES = np.arange(60) % 20 / 50
EPISODES = np.arange(60) // 20


class Others(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def parquet(self, path, **columns):
        path.parent.mkdir(parents=True, exist_ok=True)
        pyarrow.parquet.write_table(pyarrow.table({key: pyarrow.array(one) for key, one in columns.items()}), path)
        return path

    def test_a_column_of_lists_is_frames_with_the_times_beside_it(self):
        path = self.parquet(self.folder / "a.parquet", touch=COUNTS[:20].tolist(), timestamp=TIMES[:20].tolist())
        recording = dermis.Recording.read(path)
        np.testing.assert_array_equal(recording.counts, COUNTS[:20])
        np.testing.assert_allclose(recording.time_ns / 1e9, TIMES[:20])
        np.testing.assert_array_equal(dermis.Recording.read(f"{path}#touch", rate_hz=10).counts, COUNTS[:20])
        with self.assertRaisesRegex(dermis.BadInput, "has no 'palm'.*'touch'"):
            dermis.Recording.read(f"{path}#palm")

    def test_a_dataset_of_lerobot_has_episodes_and_shapes(self):
        info = {"codebase_version": "v3.0", "features": {"touch": {"shape": [3, 4]}}}
        flat = COUNTS.reshape(60, 12).tolist()
        self.parquet(
            self.folder / "set/data/chunk-000/file-000.parquet",
            touch=flat,
            timestamp=TIMES.tolist(),
            episode_index=EPISODES.tolist(),
        )
        (self.folder / "set/meta").mkdir()
        (self.folder / "set/meta/info.json").write_text(json.dumps(info))
        with self.assertRaisesRegex(dermis.BadInput, "3 episodes; give episode="):
            dermis.Recording.read(self.folder / "set#touch")
        recording = dermis.Recording.read(f"{self.folder / 'set'}#touch", episode=1)
        np.testing.assert_array_equal(recording.counts, COUNTS[20:40])
        np.testing.assert_allclose(recording.time_ns / 1e9, TIMES[20:40])

    def test_arrays_of_zarr_are_frames(self):
        for version in (2, 3):
            path = self.folder / f"{version}.zarr"
            root = zarr.create_group(path, zarr_format=version)
            root.create_array("data/touch", data=np.stack([COUNTS, COUNTS + 1], axis=-1))
            root.create_array("data/timestamps", data=TIMES)
            root.create_array("meta/episode_ends", data=np.array([20, 40, 60]))
            recording = dermis.Recording.read(f"{path}#data/touch[..., 1]", episode=2)
            np.testing.assert_array_equal(recording.counts, COUNTS[40:] + 1)
            np.testing.assert_allclose(recording.time_ns / 1e9, TIMES[40:])
            with self.assertRaisesRegex(dermis.BadInput, r"zarr#data/touch\[:, 0\]'"):
                dermis.Recording.read(f"{path}#data/touch", episode=0)

    def test_a_library_that_is_missing_is_named(self):
        path = self.parquet(self.folder / "a.parquet", touch=COUNTS.tolist())
        is_missing = mock.patch.dict("sys.modules", {"pyarrow.parquet": None})
        with is_missing, self.assertRaisesRegex(dermis.Failed, "pip install pyarrow"):
            dermis.Recording.read(path)
        path.write_bytes(b"PAR1 no more")
        with self.assertRaisesRegex(dermis.BadInput, "cannot be read"):
            dermis.Recording.read(path)


if __name__ == "__main__":
    unittest.main()
