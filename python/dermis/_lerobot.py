# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Tactile columns for a dataset of LeRobot v3 that exists. The library makes a dataset at the times of its steps, whose
columns, features and statistics are then put beside those that are there."""

import importlib
import json
import os
import shutil
import tempfile
from pathlib import Path

import numpy as np

from dermis import BadInput, Failed, _dermis  # type: ignore[attr-defined]  # it has no stub

PREFIX = "observation.tactile."
INFO, STATS, EPISODES, DATA = "meta/info.json", "meta/stats.json", "meta/episodes", "data"
LINKED = ("videos", "images")  # folders of large files that nobody changes


def parquet_module():
    try:
        return importlib.import_module("pyarrow.parquet")
    except ImportError:
        raise Failed("extend_lerobot() reads Parquet by pyarrow, which is not installed: pip install pyarrow") from None


def read_json(path):
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: is no JSON of LeRobot: {error}") from None


def tables(root, folder):
    """Parquet files in the order of LeRobot."""
    return sorted((root / folder).glob("*/*.parquet"))


class Rows:
    """The rows of several files as one table, which is taken piece by piece."""

    def __init__(self, parquet, files, names):
        self.names = names
        self.arrow = importlib.import_module("pyarrow")
        self.batches = (batch for file in files for batch in parquet.ParquetFile(file).iter_batches(batch_size=256))
        self.left = None

    def take(self, count):
        pieces = [self.left] if self.left is not None else []
        have = sum(piece.num_rows for piece in pieces)
        while have < count:
            pieces.append(self.arrow.Table.from_batches([next(self.batches)]).select(self.names))
            have += pieces[-1].num_rows
        table = self.arrow.concat_tables(pieces)
        self.left = table.slice(count)
        return table.slice(0, count)


def with_columns(table, more):
    for name in more.column_names:
        table = table.append_column(more.schema.field(name), more[name])
    return table


def steps_of_episodes(parquet, old):
    """The timestamps [s] of each episode, in the order of the rows."""
    files = tables(old, DATA)
    if not files:
        raise BadInput(f"{old}: has no {DATA}/*/*.parquet")
    read = [parquet.read_table(file, columns=["episode_index", "timestamp"]) for file in files]
    episodes = np.concatenate([table["episode_index"].to_numpy() for table in read])
    stamps = np.concatenate([table["timestamp"].to_numpy() for table in read]).astype(np.float64)
    begins = np.flatnonzero(np.diff(episodes, prepend=episodes[:1] - 1))
    numbers = episodes[begins]
    if (np.diff(numbers) <= 0).any():
        raise BadInput(f"{old}: its episodes are not in order")
    return numbers, np.split(stamps, begins[1:])


def times_of_steps(recordings, numbers, stamps, starts_ns):
    """Nanoseconds on the clock of the recording of each episode."""
    if starts_ns is None:
        starts_ns = [_dermis._first_time_ns(recording) for recording in recordings]
    if len(starts_ns) != len(stamps):
        raise BadInput(f"starts_ns: has {len(starts_ns)} times for {len(stamps)} episodes")
    times = [int(start) + np.round(of_episode * 1e9).astype(np.int64) for start, of_episode in zip(starts_ns, stamps)]
    for number, of_episode, recording in zip(numbers, times, recordings):
        if (np.diff(of_episode) <= 0).any():
            raise BadInput(f"episode {number}: its timestamps do not rise")
        if of_episode[-1] < _dermis._first_time_ns(recording):
            raise BadInput(f"episode {number}: ends before the first frame of {recording}; mend its start in starts_ns")
    return times


def copy_others(old, new):
    """All but what is extended. Videos and images are links where the disk can."""
    for path in sorted(old.rglob("*")):
        name = path.relative_to(old)
        is_extended = str(name) in (INFO, STATS) or (path.suffix == ".parquet" and name.parts[0] == DATA)
        if path.is_dir() or is_extended or name.is_relative_to(EPISODES):
            continue
        (new / name).parent.mkdir(parents=True, exist_ok=True)
        if name.parts[0] in LINKED:
            try:
                os.link(path.resolve(), new / name)
                continue
            except OSError:
                pass  # another disk
        shutil.copyfile(path, new / name)


def extend_data(parquet, old, new, tactile, names):
    rows = Rows(parquet, tables(tactile, DATA), names)
    for file in tables(old, DATA):
        place = new / file.relative_to(old)
        place.parent.mkdir(parents=True, exist_ok=True)
        writer = None
        with parquet.ParquetFile(file) as before:
            for group in range(before.num_row_groups):
                table = before.read_row_group(group)
                table = with_columns(table, rows.take(table.num_rows))
                writer = writer or parquet.ParquetWriter(place, table.schema, compression="zstd")
                writer.write_table(table)
        if writer:
            writer.close()


def extend_episodes(parquet, old, new, tactile, numbers):
    """Statistics of each episode, where there are some of other columns."""
    (made,) = [parquet.read_table(file) for file in tables(tactile, EPISODES)]
    made = made.select([name for name in made.column_names if name.startswith(f"stats/{PREFIX}")])
    place = {number: row for row, number in enumerate(numbers.tolist())}
    for file in tables(old, EPISODES):
        table = parquet.read_table(file)
        if any(name.startswith("stats/") for name in table.column_names):
            table = with_columns(table, made.take([place[number] for number in table["episode_index"].to_pylist()]))
        (new / file.relative_to(old)).parent.mkdir(parents=True, exist_ok=True)
        parquet.write_table(table, new / file.relative_to(old), compression="zstd")


def extend(old, new, recordings, *, model, window, columns, flat, starts_ns):
    parquet = parquet_module()
    old, new = Path(old), Path(new)
    if new.exists():
        raise BadInput(f"{new}: exists; name a new folder")
    info = read_json(old / INFO)
    if not str(info.get("codebase_version", "")).startswith("v3."):
        raise BadInput(f"{old}: is no dataset of LeRobot v3")
    numbers, stamps = steps_of_episodes(parquet, old)
    recordings = [recordings] if isinstance(recordings, (str, os.PathLike)) else list(recordings)
    is_one = len(recordings) == 1 and starts_ns is not None
    if len(recordings) != len(stamps) and not is_one:
        raise BadInput(
            f"{old}: has {len(stamps)} episodes, and there are {len(recordings)} recordings; give one for "
            "each, or one for all with starts_ns"
        )
    times = times_of_steps(recordings * len(stamps) if is_one else recordings, numbers, stamps, starts_ns)
    new.absolute().parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{new.name}.", dir=new.absolute().parent) as work:
        made, tactile = Path(work) / "made", Path(work) / "tactile"
        dataset = _dermis.Dataset(
            recordings, model=model, fps=info["fps"], window=window, columns=columns, flat=flat, state=(), times_ns=times
        )
        dataset.write(tactile)
        features = {
            name: feature for name, feature in read_json(tactile / INFO)["features"].items() if name.startswith(PREFIX)
        }
        if twice := sorted(features.keys() & info["features"].keys()):
            raise BadInput(f"{old}: has {twice[0]} already")
        copy_others(old, made)
        extend_data(parquet, old, made, tactile, list(features))
        extend_episodes(parquet, old, made, tactile, numbers)
        info["features"].update(features)
        stats = read_json(old / STATS) if (old / STATS).exists() else {}
        stats.update({name: of for name, of in read_json(tactile / STATS).items() if name in features})
        (made / INFO).write_text(json.dumps(info, indent=4, ensure_ascii=False))
        (made / STATS).write_text(json.dumps(stats, indent=4))
        made.rename(new)
