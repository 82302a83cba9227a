# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The Parquet files of a LeRobot dataset, written by pyarrow. dermis starts this text as a program. It sends lines of
JSON: the columns, blocks of steps with their bytes behind them, ends of episodes, the tasks at the end. The standard
input is a socket, on which "ready" and "done" go back, or why there is none."""

import json
import math
import os
import sys
from pathlib import Path

TYPES = {"float32": 4, "int64": 8, "bool": 1}
WAITING_BYTES = 32 << 20  # of a group of rows


def answer(line):
    os.write(0, line.encode() + b"\n")


try:
    import pyarrow
    import pyarrow.compute
    import pyarrow.parquet
except ImportError as error:
    answer(f"{sys.executable} has no pyarrow ({error}): pip install pyarrow")
    sys.exit(1)

FIRST = pyarrow.array([0], pyarrow.int32())  # the offset of the first list


class Data:
    """Files of steps; a new one begins with the episode after the one that fills it."""

    def __init__(self, folder, plan):
        self.folder, self.plan, self.index, self.writer = folder, plan, 0, None
        self.waiting = [bytearray() for _ in plan["columns"]]
        self.schema = pyarrow.schema([(column["name"], self.type_of(column)) for column in plan["columns"]])

    @staticmethod
    def type_of(column):
        made = getattr(pyarrow, {"bool": "bool_"}.get(column["type"], column["type"]))()
        for _ in column["shape"]:
            made = pyarrow.list_(made)
        return made

    def place(self):
        return divmod(self.index, self.plan["files_of_chunk"])

    def write(self, steps):
        for column, waiting in zip(self.plan["columns"], self.waiting):
            waiting += block_of(steps, column)
        if sum(map(len, self.waiting)) > WAITING_BYTES:
            self.flush()

    @staticmethod
    def array(column, block):
        kind = pyarrow.uint8() if column["type"] == "bool" else getattr(pyarrow, column["type"])()
        count = len(block) // TYPES[column["type"]]
        made = pyarrow.Array.from_buffers(kind, count, [None, pyarrow.py_buffer(block)])
        made = made.cast(pyarrow.bool_()) if column["type"] == "bool" else made
        for size in reversed(column["shape"]):
            sizes = pyarrow.repeat(pyarrow.scalar(size, pyarrow.int32()), len(made) // size)
            offsets = pyarrow.compute.cumulative_sum(pyarrow.concat_arrays([FIRST, sizes]))
            made = pyarrow.ListArray.from_arrays(offsets, made)
        return made

    def flush(self):
        if self.writer is None:
            chunk, file = self.place()
            path = self.folder / f"data/chunk-{chunk:03}/file-{file:03}.parquet"
            path.parent.mkdir(parents=True, exist_ok=True)
            self.file = open(path, "wb")  # noqa: SIM115  close() closes it
            self.writer = pyarrow.parquet.ParquetWriter(
                self.file, self.schema, compression="zstd", use_dictionary=False
            )
        arrays = [self.array(column, block) for column, block in zip(self.plan["columns"], self.waiting)]
        self.writer.write_table(pyarrow.Table.from_arrays(arrays, schema=self.schema))
        self.waiting = [bytearray() for _ in self.waiting]

    def end_episode(self):
        if self.waiting[0]:
            self.flush()
        if self.file.tell() > self.plan["bytes_of_file"]:
            self.close()

    def close(self):
        if self.writer is not None:
            self.writer.close()
            self.file.close()
            self.writer = None
            self.index += 1


def nested(values, shape):
    for size in reversed(shape[1:]):
        values = [values[k : k + size] for k in range(0, len(values), size)]
    return values


def episode_row(episode, data, plan):
    chunk, file = data.place()
    row = {
        "episode_index": episode["index"],
        "length": episode["length"],
        "data/chunk_index": chunk,
        "data/file_index": file,
        "dataset_from_index": episode["from"],
        "dataset_to_index": episode["from"] + episode["length"],
        "meta/episodes/chunk_index": 0,
        "meta/episodes/file_index": 0,
        "tasks": episode["tasks"],
    }
    for column, statistics in zip(plan["columns"], episode["statistics"]):
        for name, values in statistics.items():
            shape = column["shape"] or [1]  # the values are of each kind of the elements
            row[f"stats/{column['name']}/{name}"] = nested(values * (math.prod(shape) // len(values)), shape)
        row[f"stats/{column['name']}/count"] = [episode["length"]]
    return row


class Episodes:
    """meta/episodes: where each episode is, and the statistics of its columns."""

    def __init__(self, folder):
        self.path, self.rows, self.writer = folder / "meta/episodes/chunk-000/file-000.parquet", [], None
        self.path.parent.mkdir(parents=True, exist_ok=True)

    def add(self, row):
        self.rows.append(row)
        if len(self.rows) == 100:
            self.flush()

    def flush(self):
        table = pyarrow.Table.from_pylist(self.rows, self.writer and self.writer.schema)
        self.writer = self.writer or pyarrow.parquet.ParquetWriter(self.path, table.schema, compression="zstd")
        self.writer.write_table(table)
        self.rows = []

    def close(self):
        if self.rows:
            self.flush()
        if self.writer is not None:
            self.writer.close()


def write_tasks(folder, tasks):
    """A table of pandas whose index are the sentences."""
    kinds = {"task_index": ("int64", "int64"), "task": ("unicode", "object")}
    pandas = {
        "index_columns": ["task"],
        "column_indexes": [],
        "columns": [
            {"name": name, "field_name": name, "pandas_type": kind, "numpy_type": numpy, "metadata": None}
            for name, (kind, numpy) in kinds.items()
        ],
        "pandas_version": "2.0.0",
    }
    schema = pyarrow.schema([("task_index", pyarrow.int64()), ("task", pyarrow.string())])
    table = pyarrow.table([list(range(len(tasks))), tasks], schema=schema.with_metadata({"pandas": json.dumps(pandas)}))
    pyarrow.parquet.write_table(table, folder / "meta/tasks.parquet", compression="zstd")


def block_of(steps, column):
    size = steps * TYPES[column["type"]]
    for extent in column["shape"]:
        size *= extent
    block = sys.stdin.buffer.read(size)
    if len(block) < size:
        sys.exit(1)  # dermis has ended
    return block


def main():
    folder = Path(sys.argv[1])
    answer("ready")
    plan = json.loads(sys.stdin.buffer.readline())
    data, episodes = Data(folder, plan), Episodes(folder)
    for line in sys.stdin.buffer:
        message = json.loads(line)
        if "steps" in message:
            data.write(message["steps"])
        elif "episode" in message:
            row = episode_row(message["episode"], data, plan)
            data.end_episode()
            episodes.add(row)
        else:
            data.close()
            episodes.close()
            write_tasks(folder, message["tasks"])
            answer("done")


try:
    main()
except (OSError, ValueError, pyarrow.ArrowException) as error:
    answer(" ".join(str(error).split()) or type(error).__name__)
    sys.exit(1)
