# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Tactile columns for a dataset of LeRobot v3 that exists. The library makes a dataset at the times of its steps, whose
columns, features and statistics are then put beside those that are there."""

import contextlib
import functools
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
TACTILE = "meta/tactile.json"
LINKED = ("videos", "images")  # folders of large files that nobody changes
LONGEST_S = 1e9  # of a timestamp


def parquet_module():
    try:
        return importlib.import_module("pyarrow.parquet")
    except ImportError:
        raise Failed("extend_lerobot() reads Parquet by pyarrow, which is not installed: pip install pyarrow") from None


def read_json(path):
    """An object of JSON."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: is no JSON of LeRobot: {error}") from None
    if not isinstance(content, dict):
        raise BadInput(f"{path}: is no JSON of LeRobot: no object")
    return content


def read_info(old):
    info = read_json(old / INFO)
    if not str(info.get("codebase_version", "")).startswith("v3."):
        raise BadInput(f"{old}: is no dataset of LeRobot v3")
    if not isinstance(info.get("features"), dict):
        raise BadInput(f"{old / INFO}: has no features")
    fps = info.get("fps")
    if isinstance(fps, bool) or not isinstance(fps, (int, float)) or not 0 < fps < np.inf:
        raise BadInput(f"{old / INFO}: fps is no number of steps a second")
    return info


@contextlib.contextmanager
def reading(path):
    """A damaged file is named in one line, whatever pyarrow says of it."""
    arrow = importlib.import_module("pyarrow")
    try:
        yield
    except (arrow.ArrowException, OSError, ValueError) as error:
        said = [*str(error).splitlines(), type(error).__name__]
        raise BadInput(f"{path}: is no Parquet of LeRobot: {said[0]}") from None


def tables(root, folder):
    """Parquet files in the order of LeRobot."""
    return sorted((root / folder).glob("*/*.parquet"))


def numbers_of(table, name, kind):
    """A column without gaps."""
    if name not in table.column_names:
        raise ValueError(f"has no column {name}")
    numbers = table[name].cast(kind)
    if numbers.null_count:
        raise ValueError(f"has a row without {name}")
    return numbers.to_numpy()


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
        while have < count or not pieces:
            batch = next(self.batches, None)
            if batch is None:
                raise Failed("the rows of the dataset became more while it was read")
            pieces.append(self.arrow.Table.from_batches([batch]).select(self.names))
            have += pieces[-1].num_rows
        table = self.arrow.concat_tables(pieces)
        self.left = table.slice(count)
        return table.slice(0, count)


def with_columns(table, more):
    for name in more.column_names:
        table = table.append_column(more.schema.field(name), more[name])
    return table


def row_groups(parquet, path):
    """As tables; an empty one where there is none."""
    with reading(path), parquet.ParquetFile(path) as file:
        for group in range(file.num_row_groups):
            yield file.read_row_group(group)
        if not file.num_row_groups:
            yield file.read()


def copy_table(parquet, old, new, extended):
    """Row group by row group. `extended` makes a table from each."""
    new.parent.mkdir(parents=True, exist_ok=True)
    writer = None
    for table in map(extended, row_groups(parquet, old)):
        writer = writer or parquet.ParquetWriter(new, table.schema, compression="zstd")
        writer.write_table(table)
    writer.close()


def steps_of_episodes(parquet, old, fps):
    """The time [s] of each step of each episode, in the order of the rows."""
    files = tables(old, DATA)
    if not files:
        raise BadInput(f"{old}: has no {DATA}/*/*.parquet")
    columns = {"episode_index": "int64", "frame_index": "int64", "timestamp": "float64"}
    read = []
    for file in files:
        with reading(file), parquet.ParquetFile(file) as opened:
            table = opened.read(columns=list(columns))
            read.append([numbers_of(table, name, kind) for name, kind in columns.items()])
    episodes, frames, stamps = (np.concatenate(pieces) for pieces in zip(*read))
    if not len(stamps):
        raise BadInput(f"{old}: has no step")
    if not (np.abs(stamps) < LONGEST_S).all():
        raise BadInput(f"{old}: has a timestamp that is no time")
    # LeRobot stores float32: a step that is on the clock of the frames lies there without rounding.
    on_clock = frames / fps
    is_on_clock = np.abs(on_clock - stamps) <= 2 * np.spacing(np.abs(stamps).astype(np.float32))
    begins = np.flatnonzero(np.diff(episodes, prepend=episodes[:1] - 1))
    numbers = episodes[begins]
    if (np.diff(numbers) <= 0).any():
        raise BadInput(f"{old}: its episodes are not in order")
    return numbers, np.split(np.where(is_on_clock, on_clock, stamps), begins[1:])


def checked_starts(starts_ns, count):
    try:
        starts = np.asarray(list(starts_ns), np.int64)
    except (TypeError, ValueError, OverflowError):
        raise BadInput("starts_ns: is no list of nanoseconds") from None
    if starts.shape != (count,):
        raise BadInput(f"starts_ns: has {len(starts)} times for {count} episodes")
    return starts


def times_of_steps(recordings, numbers, stamps, starts_ns, fps):
    """Nanoseconds on the clock of the recording of each episode. Without starts, frames lie between steps."""
    if starts_ns is None:
        starts = [_dermis._first_step_ns(recording, fps) for recording in recordings]
    else:
        starts = checked_starts(starts_ns, len(stamps))
    times = [start + np.round(of_episode * 1e9).astype(np.int64) for start, of_episode in zip(starts, stamps)]
    for number, of_episode in zip(numbers, times):
        if (np.diff(of_episode) <= 0).any():
            raise BadInput(f"episode {number}: its timestamps do not rise")
    return times


def files_in(folder, above=()):
    """All files, also behind links. A link to a folder that it lies in ends there."""
    place = folder.resolve()
    if place in above:
        return
    for path in sorted(folder.iterdir()):
        if path.is_dir():
            yield from files_in(path, (*above, place))
        else:
            yield path


def copy_others(old, new):
    """All but what is extended. Videos and images are links where the disk can."""
    extended = {old / INFO, old / STATS, *tables(old, DATA), *tables(old, EPISODES)}
    for path in files_in(old):
        if path in extended:
            continue
        name = path.relative_to(old)
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
        copy_table(
            parquet, file, new / file.relative_to(old), lambda table: with_columns(table, rows.take(table.num_rows))
        )


def extend_episodes(parquet, old, new, tactile, numbers):
    """Statistics of each episode, where there are some of other columns."""
    (made,) = [parquet.read_table(file) for file in tables(tactile, EPISODES)]
    made = made.select([name for name in made.column_names if name.startswith(f"stats/{PREFIX}")])
    place = {number: row for row, number in enumerate(numbers.tolist())}

    def extended(file, table):
        if not any(name.startswith("stats/") for name in table.column_names):
            return table
        with reading(file):
            episodes = numbers_of(table, "episode_index", "int64").tolist()
            if others := [number for number in episodes if number not in place]:
                raise ValueError(f"has episode {others[0]}, of which there is no step")
        return with_columns(table, made.take([place[number] for number in episodes]))

    for file in tables(old, EPISODES):
        copy_table(parquet, file, new / file.relative_to(old), functools.partial(extended, file))


def extend(old, new, recordings, *, model, window, columns, flat, starts_ns):
    parquet = parquet_module()
    old, new = Path(old), Path(new)
    if new.exists():
        raise BadInput(f"{new}: exists; name a new folder")
    if new.resolve().is_relative_to(old.resolve()):
        raise BadInput(f"{new}: lies within {old}; name a folder outside")
    info = read_info(old)
    stats = read_json(old / STATS) if (old / STATS).exists() else {}
    numbers, stamps = steps_of_episodes(parquet, old, info["fps"])
    recordings = [recordings] if isinstance(recordings, (str, os.PathLike)) else list(recordings)
    is_one = len(recordings) == 1 and starts_ns is not None
    if len(recordings) != len(stamps) and not is_one:
        raise BadInput(
            f"{old}: has {len(stamps)} episodes, and there are {len(recordings)} recordings; give one for "
            "each, or one for all with starts_ns"
        )
    times = times_of_steps(recordings, numbers, stamps, starts_ns, info["fps"])
    dataset = _dermis.Dataset(
        recordings,
        model=model,
        fps=info["fps"],
        window=window,
        columns=columns,
        flat=flat,
        state=(),
        times_ns=times,
    )
    try:
        put_together(parquet, dataset, old, new, numbers, info, stats)
    except OSError as error:
        raise Failed(f"{error.filename or new}: {error.strerror or error}") from None


def put_together(parquet, dataset, old, new, numbers, info, stats):
    """The new dataset, which is there as a whole or not at all."""
    new.absolute().parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{new.name}.", dir=new.absolute().parent) as work:
        made, tactile = Path(work) / "made", Path(work) / "tactile"
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
        stats.update({name: of for name, of in read_json(tactile / STATS).items() if name in features})
        (made / INFO).parent.mkdir(exist_ok=True)
        shutil.copyfile(tactile / TACTILE, made / TACTILE)
        (made / INFO).write_text(json.dumps(info, indent=4, ensure_ascii=False), encoding="utf-8")
        (made / STATS).write_text(json.dumps(stats, indent=4), encoding="utf-8")
        made.rename(new)
