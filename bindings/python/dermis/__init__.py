# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Newtons from resistive tactile arrays: raw counts in, calibrated force per taxel out.

    import dermis
    pipeline = dermis.Pipeline(dermis.read_model("chest.safetensors"))
    for frame in dermis.open("serial:///dev/ttyACM0"):
        print(pipeline.process(frame).total)

Arrays are (rows, cols), row-major; row = driven line, col = sensed line. Units are SI; temperatures are in Celsius,
times in nanoseconds. The stub __init__.pyi says of every argument and result what it is; docs/python.md shows how they
go together.
"""

import enum as _enum

import numpy as _numpy  # noqa: F401  _dermis needs it: where it is missing, this line says so


class Error(Exception):
    """One line that names the place and the mend."""


class BadInput(Error, ValueError):
    """A file, an argument or a device said something that cannot be used."""


class Failed(Error, RuntimeError):
    """The work itself could not be done: a full disk, a device that was unplugged."""


class FrameStatus(_enum.IntFlag):
    """Outcome of a frame; OK is no flag."""

    OK = 0
    REJECTED = 1
    SATURATED = 2
    ABOVE_RANGE = 4
    DEAD_TAXELS = 8
    TEMPERATURE_UNKNOWN = 16
    TEMPERATURE_CLAMPED = 32
    NOT_CONVERGED = 64
    LINE_FAULT = 128
    SUPPLY_CLAMPED = 256
    SUPPLY_IMPLAUSIBLE = 512
    DOUBTFUL = 1024


class TaxelStatus(_enum.IntEnum):
    """The knowledge of one taxel in one frame."""

    OK = 0
    SATURATED = 1
    ABOVE_RANGE = 2
    DEAD = 3
    LINE_FAULT = 4
    INVALID = 5


from dermis import circuit
from dermis._copied import copy_well as _copy_well
from dermis._dermis import (
    ArrayDescription,
    CalibrationReport,
    Contact,
    ContactTracker,
    Dataset,
    ForceFrame,
    Forces,
    Load,
    Model,
    Pipeline,
    RawFrame,
    Recogniser,
    Recognition,
    Recording,
    Server,
    Source,
    Threat,
    ThreatMonitor,
    __version__,
    calibrate,
    evaluate_json as _evaluate_json,
    open,
    read_array,
    read_loads,
    read_model,
    serve,
)
from dermis._others import read_others as _read_others
from dermis._shown import show_well as _show_well
from dermis._suit import Suit, SuitArray

_copy_well()
_show_well()
_read_others(Recording)


async def _next_frame(source):
    import asyncio

    while (frame := await asyncio.to_thread(source._poll)) is None:
        pass
    return frame


Source.__aiter__ = lambda source: source
Source.__anext__ = _next_frame


def evaluate(model, frames, loads):
    """The output of `dermis evaluate --json`, as a dict."""
    import json

    return json.loads(_evaluate_json(model, frames, loads))


def extend_lerobot(old, new, recordings, *, model=None, window=1, columns=None, flat=False, starts_ns=None):
    """A copy of a dataset of LeRobot v3 with tactile columns at the times of its steps."""
    from dermis._lerobot import extend

    extend(old, new, recordings, model=model, window=window, columns=columns, flat=flat, starts_ns=starts_ns)


__all__ = [
    "ArrayDescription",
    "BadInput",
    "CalibrationReport",
    "Contact",
    "ContactTracker",
    "Dataset",
    "Error",
    "Failed",
    "ForceFrame",
    "Forces",
    "FrameStatus",
    "Load",
    "Model",
    "Pipeline",
    "RawFrame",
    "Recogniser",
    "Recognition",
    "Recording",
    "Server",
    "Source",
    "Suit",
    "SuitArray",
    "TaxelStatus",
    "Threat",
    "ThreatMonitor",
    "__version__",
    "calibrate",
    "circuit",
    "evaluate",
    "extend_lerobot",
    "open",
    "read_array",
    "read_loads",
    "read_model",
    "serve",
]
