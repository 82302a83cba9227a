# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Recordings in formats whose libraries are packages of PyPI: Parquet of LeRobot and zarr. Their numbers go to the
library as an archive of NumPy, which knows axes and times."""

import contextlib
import importlib
import json
import os
import tempfile
from pathlib import Path

import numpy as np

from dermis import BadInput, Failed

TIMES = ("time_ns", "time_s", "timestamps", "timestamp", "time", "t")
INFO = "meta/info.json"  # of a dataset of LeRobot
ZARR = ("zarr.json", ".zgroup", ".zarray")  # one of them is in its folder


def module_of(name, package):
    try:
        return importlib.import_module(name)
    except ImportError:
        raise Failed(
            f"Recording.read() needs {package} for this file, which is not installed: pip install {package}"
        ) from None


def split(text):
    """ "data.parquet#touch[..., 2]" as ("data.parquet", "touch", "[..., 2]")."""
    path, _, choice = text.partition("#") if not os.path.exists(text) else (text, "", "")
    name, bracket, axes = choice.partition("[")
    return path.rstrip("/"), name.strip("/"), bracket + axes


def reader_of(text):
    """The function that reads the numbers of a file; None: the library reads it."""
    path = split(text)[0]
    if path.endswith(".parquet") or os.path.isfile(os.path.join(path, INFO)):
        return numbers_in_parquet
    if path.endswith(".zarr") or any(os.path.isfile(os.path.join(path, name)) for name in ZARR):
        return numbers_in_zarr
    return None


def part_of(path, counts, episode):
    """The rows of one episode among those of `counts` rows each."""
    if episode is None and len(counts) == 1:
        episode = 0
    if episode is None or not 0 <= episode < len(counts):
        raise BadInput(f"{path}: has {len(counts)} episodes; give episode=, of 0 to {len(counts) - 1}")
    begin = int(np.sum(counts[:episode]))
    return slice(begin, begin + int(counts[episode]))


def features_of(path):
    """Shapes of the columns, where the file lies in a dataset of LeRobot."""
    for folder in (path, *path.parents):
        if (folder / INFO).is_file():
            features = json.loads((folder / INFO).read_text(encoding="utf-8")).get("features", {})
            return {name: tuple(feature.get("shape") or ()) for name, feature in features.items()}
    return {}


def array_of(column, name, shape):
    """Frames x rows x cols; one row where nothing tells the rows."""
    try:
        values = np.asarray(column.to_pylist(), dtype=np.float64)
    except (TypeError, ValueError):
        raise BadInput(f"column {name!r} is no table of numbers") from None
    if values.ndim == 2 and len(shape) > 1 and np.prod(shape) == values.shape[1]:
        return values.reshape(-1, *shape)
    return values[:, None, :] if values.ndim == 2 else values


def choose(path, name, names):
    if name in names or (not name and len(names) == 1):
        return name or min(names)
    which = f"has no {name!r}" if name else "name what holds the readings"
    example = f", as '{path}#{min(names)}'" if names else ""
    raise BadInput(f"{path}: {which}{example}; it has: {', '.join(map(repr, sorted(names))) or 'nothing'}")


def numbers_in_parquet(path, name, episode):
    parquet, arrow = module_of("pyarrow.parquet", "pyarrow"), module_of("pyarrow", "pyarrow")
    files = [path] if path.is_file() else sorted((path / "data").rglob("*.parquet"))
    try:
        table = arrow.concat_tables([parquet.read_table(file) for file in files])
    except (OSError, arrow.ArrowException) as error:
        raise BadInput(f"{path}: cannot be read: {str(error).splitlines()[0]}") from None
    lists = {field.name for field in table.schema if "list" in str(field.type)}
    column = choose(path, name, lists)
    values = array_of(table[column], column, features_of(path).get(column, ()))
    beside = {key: np.asarray(table[key].to_pylist(), dtype=float) for key in TIMES if key in table.column_names}
    rows = slice(None)
    if "episode_index" in table.column_names:
        index = np.asarray(table["episode_index"].to_pylist())
        episodes, counts = np.unique(index, return_counts=True)
        if episode is not None and episode in episodes:
            episode = int(np.flatnonzero(episodes == episode)[0])
        rows = part_of(path, counts[np.argsort(episodes)], episode)
    return values[rows], {key: times[rows] for key, times in beside.items()}


def numbers_in_zarr(path, name, episode):
    zarr = module_of("zarr", "zarr")
    try:
        root = zarr.open(str(path), mode="r")
    except Exception as error:
        raise BadInput(f"{path}: cannot be read: {str(error).splitlines()[0]}") from None
    arrays = arrays_in(root)
    chosen = "" if "" in arrays else choose(path, name, {key for key, array in arrays.items() if array.ndim > 1})
    group = chosen.rpartition("/")[0]
    rows = slice(None)
    ends = arrays.get("meta/episode_ends")
    if ends is not None:
        rows = part_of(path, np.diff(np.asarray(ends[:]), prepend=0), episode)
    places = [(key, f"{group}/{key}".lstrip("/")) for key in TIMES] + [(key, key) for key in TIMES]
    beside = {key: np.asarray(arrays[place][rows]) for key, place in reversed(places) if place in arrays}
    return np.asarray(arrays[chosen][rows]), beside


def arrays_in(node, prefix=""):
    """Arrays by their paths; "" where the file is an array itself."""
    if hasattr(node, "ndim"):
        return {prefix: node}
    found = {}
    for key in node:
        found.update(arrays_in(node[key], f"{prefix}/{key}".lstrip("/")))
    return found


def read_by(reader, read, text, rate_hz, episode):
    """`read` is that of the library."""
    path, name, axes = split(text)
    values, beside = reader(Path(path), name, episode)
    if values.dtype == bool or not np.issubdtype(values.dtype, np.number):
        raise BadInput(f"{path}: {name!r} holds no numbers")
    if values.dtype == np.float16:
        values = values.astype(np.float32)
    with tempfile.TemporaryDirectory() as folder:
        archive = f"{folder}/numbers.npz"
        times = {key: np.asarray(one).reshape(-1) for key, one in beside.items() if len(one) == len(values)}
        np.savez(archive, readings=values, **times)
        with told_of(path + ("#" + name if name else ""), archive):
            return read(f"{archive}#readings{axes}", rate_hz=rate_hz)


@contextlib.contextmanager
def told_of(place, archive):
    """Errors name the file that was asked for."""
    try:
        yield
    except (BadInput, Failed) as error:
        said = str(error).replace(f"{archive}#readings", place).replace(archive, place)
        raise type(error)(said) from None


def read_others(recording):
    """Recording.read() that knows these formats, too."""
    library = recording.read

    def read(path, *, rate_hz=None, episode=None):
        text = os.fspath(path) if isinstance(path, (str, os.PathLike)) else ""
        reader = reader_of(text) if isinstance(text, str) else None
        if reader is not None:
            return read_by(reader, library, text, rate_hz, episode)
        if episode is not None:
            raise BadInput(f"{text}: episode: is of datasets of LeRobot and zarr alone")
        return library(path, rate_hz=rate_hz)

    recording.read = staticmethod(read)
