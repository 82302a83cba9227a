# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Shapes are (rows, cols), row-major. A path is a str or an os.PathLike."""

import enum
import os
from collections.abc import AsyncIterator, Callable, Iterable, Iterator, Sequence
from types import TracebackType
from typing import Any, TypeAlias, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dermis import circuit as circuit

_Path: TypeAlias = str | os.PathLike[str]

__version__: str

class Error(Exception):
    """One line that names the place and the mend."""

class BadInput(Error, ValueError):
    """A file, an argument or a device said something that cannot be used."""

class Failed(Error, RuntimeError):
    """The work itself could not be done: a full disk, a device that was unplugged."""

class FrameStatus(enum.IntFlag):
    OK = 0
    REJECTED = 1  # wrong shape, not a number, out of the ADC's range, an absurd supply, time going backwards
    SATURATED = 2  # at least one taxel
    ABOVE_RANGE = 4  # at least one taxel is beyond its heaviest calibrated load
    DEAD_TAXELS = 8
    TEMPERATURE_UNKNOWN = 16  # the mean of the calibration is taken
    TEMPERATURE_CLAMPED = 32  # outside the calibrated temperatures
    NOT_CONVERGED = 64  # the crosstalk inversion
    LINE_FAULT = 128  # a line or taxel is faulty and masked
    SUPPLY_CLAMPED = 256  # outside the supplies of the calibration: the nearest is used
    SUPPLY_IMPLAUSIBLE = 512  # more than 20 % from nominal, too: that is used
    DOUBTFUL = 1024  # a reading jumped, and may be no press: the sigma of its force says so

class TaxelStatus(enum.IntEnum):
    OK = 0
    SATURATED = 1  # the force is at least the one given
    ABOVE_RANGE = 2  # extrapolated
    DEAD = 3  # no force (NaN)
    LINE_FAULT = 4  # no force (NaN)
    INVALID = 5  # no force (NaN)

class ArrayDescription:
    """An array.toml (docs/array-toml.md)."""

    @staticmethod
    def from_toml(text: str) -> ArrayDescription: ...
    def to_toml(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def rows(self) -> int: ...
    @property
    def cols(self) -> int: ...
    @property
    def row_pitch_m(self) -> float: ...
    @property
    def col_pitch_m(self) -> float: ...
    @property
    def taxel_area_m2(self) -> float | None: ...
    @property
    def circuit(self) -> str: ...
    @property
    def adc_bits(self) -> int: ...
    def taxel_name(self, row: int, col: int) -> str: ...

class Model:
    """Turns the counts of one array into newtons: a model file of `dermis calibrate`."""

    @property
    def array(self) -> ArrayDescription: ...
    @property
    def provenance(self) -> dict[str, str]: ...
    def write(self, path: _Path, *, force: bool = False) -> None:
        """Raises BadInput where the file exists, unless `force`."""

def read_array(path: _Path) -> ArrayDescription: ...
def read_model(path: _Path) -> Model:
    """Warns of a file from before there were checksums: damage to it does not show."""

class RawFrame:
    """Counts of one frame. `counts` is a view (rows, cols); it keeps the frame alive."""

    @property
    def time_ns(self) -> int: ...
    @property
    def temperature_celsius(self) -> float | None: ...
    @property
    def supply_v(self) -> float | None: ...
    @property
    def counts(self) -> NDArray[np.float32]: ...
    @property
    def sensor_celsius(self) -> NDArray[np.float32]:
        """Temperatures of the sensors of the array; empty where there is one temperature."""
    @property
    def sequence(self) -> int | None: ...
    @property
    def lost_before(self) -> int: ...
    def _repr_png_(self) -> bytes | None: ...
    def _repr_html_(self) -> str: ...

class ForceFrame:
    """Forces of one frame. The arrays are views (rows, cols); they keep the frame alive."""

    @property
    def time_ns(self) -> int: ...
    @property
    def status(self) -> FrameStatus: ...
    @property
    def newtons(self) -> NDArray[np.float32]: ...
    @property
    def sigma_newtons(self) -> NDArray[np.float32]: ...
    @property
    def signal_to_noise(self) -> NDArray[np.float32]: ...
    @property
    def taxels(self) -> NDArray[np.uint8]: ...
    @property
    def total(self) -> float:
        """Force on the whole array [N], in place of newtons.sum(), in which noise does not cancel. It leaves out taxels
        without a force, and is NaN without any."""
    @property
    def total_sigma(self) -> float:
        """Its standard deviation, with the errors that taxels share."""
    def total_of(self, mask: ArrayLike) -> tuple[float, float]:
        """The same of the taxels where mask (rows, cols) is true: newtons, standard deviation."""
    def _repr_html_(self) -> str: ...
    def _repr_png_(self) -> bytes | None: ...

class Recording:
    """Frames of one array in memory, from and to any file of frames: .mcap, .csv, .h5, .npy and more.

    counts: (frames, rows, cols). Give rate_hz, or time_ns (frames,), which does not go back. temperature_celsius [C]
    and supply_v [V] are (frames,), one number for all frames, or None; NaN stands for a frame without. sensor_celsius
    [C] is (frames, sensors), where the array has several sensors of temperature.
    """

    def __init__(
        self,
        counts: ArrayLike,
        *,
        time_ns: ArrayLike | None = None,
        rate_hz: float | None = None,
        temperature_celsius: ArrayLike | None = None,
        sensor_celsius: ArrayLike | None = None,
        supply_v: ArrayLike | None = None,
        array: ArrayDescription | _Path | None = None,
    ) -> None: ...
    @staticmethod
    def read(path: _Path, *, rate_hz: float | None = None, episode: int | None = None) -> Recording:
        """Also of Parquet and datasets of LeRobot (pyarrow) and of zarr (zarr), with their column or array behind '#'.
        `episode`: which of several."""
    def write(self, path: _Path, *, force: bool = False) -> None:
        """Raises BadInput where the file exists, unless `force`."""

    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, index: int, /) -> RawFrame: ...
    @overload
    def __getitem__(self, frames: slice, /) -> Recording: ...
    @property
    def name(self) -> str: ...
    @property
    def model_hash(self) -> str: ...
    @property
    def simulation(self) -> str: ...
    @property
    def array(self) -> ArrayDescription | None: ...
    @property
    def time_ns(self) -> NDArray[np.int64]: ...
    @property
    def temperature_celsius(self) -> NDArray[np.float64]: ...
    @property
    def sensor_celsius(self) -> NDArray[np.float32]: ...
    @property
    def supply_v(self) -> NDArray[np.float64]: ...
    @property
    def counts(self) -> NDArray[np.float32]: ...
    def _repr_html_(self) -> str: ...

class Forces:
    """Forces of many frames: newtons, sigma_newtons [N] and taxels (TaxelStatus) are (frames, rows, cols), status
    (FrameStatus) and time_ns (frames,)."""

    def __len__(self) -> int: ...
    def __getitem__(self, frames: slice, /) -> Forces: ...
    def _repr_png_(self) -> bytes | None:
        """The strongest frame, for notebooks."""
    @property
    def time_ns(self) -> NDArray[np.int64]: ...
    @property
    def status(self) -> NDArray[np.uint16]: ...
    @property
    def newtons(self) -> NDArray[np.float32]: ...
    @property
    def sigma_newtons(self) -> NDArray[np.float32]: ...
    @property
    def taxels(self) -> NDArray[np.uint8]: ...
    @property
    def total(self) -> NDArray[np.float64]:
        """Force on the whole array in each frame [N] (frames,); see ForceFrame.total."""
    @property
    def total_sigma(self) -> NDArray[np.float64]: ...

class Pipeline:
    """Counts in, newtons out. One for each stream of frames, in their order; raises where two threads use it at once.
    A copy, also by pickle, is made anew of the model: it has not been tared and remembers nothing."""

    def __init__(self, model: Model | _Path) -> None:
        """A model, or the path of its file."""
    @property
    def model(self) -> Model: ...
    @overload
    def process(self, frame: RawFrame) -> ForceFrame: ...
    @overload
    def process(
        self,
        counts: ArrayLike,
        temperature: float | ArrayLike | None = None,
        supply: float | None = None,
        time_ns: int | None = None,
    ) -> ForceFrame:
        """counts (rows, cols); temperature [C], one or one of each sensor; supply [V]; time_ns: now, by the host's
        clock, where it is None."""
    def run(
        self,
        frames: Recording | _Path | ArrayLike,
        *,
        time_ns: ArrayLike | None = None,
        rate_hz: float | None = None,
        temperature_celsius: ArrayLike | None = None,
        supply_v: ArrayLike | None = None,
    ) -> Forces:
        """All frames. Other threads run meanwhile. Counts (frames, rows, cols) need their times or their rate, as in
        Recording, and may have what else stands here."""
    @property
    def why_rejected(self) -> str:
        """The error of the last frame, and the expected value; '' where it was not rejected."""
    def tare(self, *, force: bool = False) -> None:
        """Takes the next second, at least 10 frames, for unloaded. Under a load the tare is refused, with a
        UserWarning; force takes whatever load stands there as zero."""
    def undo_tare(self) -> None:
        """Back to the zero before the last tare."""
    @property
    def taring(self) -> bool:
        """The second is not over yet."""
    def follow_drift(self, follow: bool = True) -> None:
        """Follows the offsets of idle taxels slowly (docs/tare-and-drift.md). Off at first."""
    def _repr_html_(self) -> str: ...

class Contact:
    """A contact with the array in one place. Pairs are (x, y): x along the columns, y along the rows."""

    @property
    def id(self) -> int: ...
    @property
    def phase(self) -> str:
        """'onset', 'held' or 'release'."""
    @property
    def onset_ns(self) -> int: ...
    @property
    def position_m(self) -> tuple[float, float]: ...
    @property
    def sigma_position_m(self) -> tuple[float, float]: ...
    @property
    def velocity_m_s(self) -> tuple[float, float]: ...
    @property
    def force_n(self) -> float: ...
    @property
    def sigma_force_n(self) -> float: ...
    @property
    def area_m2(self) -> float: ...
    @property
    def peak_pressure_pa(self) -> float: ...
    @property
    def mean_pressure_pa(self) -> float: ...
    @property
    def major_axis_m(self) -> float: ...
    @property
    def minor_axis_m(self) -> float: ...
    @property
    def angle_rad(self) -> float: ...
    @property
    def taxels(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...

class ContactTracker:
    """Follows contacts from frame to frame (docs/contacts.md). `model`: a Model, or the array it is of."""

    def __init__(
        self,
        model: Model | ArrayDescription | _Path,
        *,
        onset_sigma: float = 5.0,
        onset_force_n: float = 0.1,
        release_share: float = 0.5,
        most_contacts: int = 32,
    ) -> None: ...
    def process(self, force: ForceFrame) -> list[Contact]: ...
    def forget(self) -> None: ...

class Threat:
    """A limit and how it stands. Values are in N, Pa or N/s, as the quantity is."""

    @property
    def name(self) -> str: ...
    @property
    def stands(self) -> bool: ...
    @property
    def quantity(self) -> str:
        """The name in threats.toml, such as 'contact_force'."""
    @property
    def limit(self) -> float: ...
    @property
    def value(self) -> float:
        """The value in the last frame,"""
    @property
    def sigma(self) -> float:
        """its standard deviation,"""
    @property
    def worst(self) -> float:
        """and the largest since the limit was crossed."""
    @property
    def position_m(self) -> tuple[float, float]:
        """(x, y) in the plane of the array."""
    @property
    def crossed_ns(self) -> int: ...

class ThreatMonitor:
    """Holds forces against the limits of a threats.toml (docs/threats.md). One for each stream of frames. `name`: of
    the array in the zones; that of the model where it is None."""

    def __init__(self, limits: _Path, model: Model, *, name: str | None = None) -> None: ...
    def process(self, force: ForceFrame) -> list[Threat]:
        """Threats that began or ended with this frame."""
    @property
    def standing(self) -> list[Threat]: ...
    def reset(self) -> None:
        """Ends latched threats; they come back where the limit is still exceeded."""

class Recognition:
    @property
    def name(self) -> str:
        """The class, or 'unknown'."""
    @property
    def likeliest(self) -> str: ...
    @property
    def probabilities(self) -> dict[str, float]: ...
    @property
    def unknown_score(self) -> float: ...
    @property
    def reason(self) -> str:
        """Why it is unknown; '' where it is not."""
    @property
    def frames(self) -> tuple[int, int]:
        """First and last of those that were given, from 0."""

class Recogniser:
    """Names poses and gestures by the classes of `dermis recognise learn --model`, from forces (docs/recognition.md).
    rate_hz: frames a second; that of the examples where it is None. Frames of a tare are better left out."""

    def __init__(self, classes: _Path, model: Model, *, rate_hz: float | None = None) -> None: ...
    def process(self, force: ForceFrame) -> Recognition | None:
        """A pose with every frame; a gesture once it is over, else None."""
    def finish(self) -> Recognition | None:
        """The gesture that has not ended when the stream does."""
    @property
    def names(self) -> list[str]: ...

class Dataset:
    """Recordings as episodes for learning (docs/datasets.md); each recording is one, and a gap of 10 s begins another.
    They are made when the first is asked for, and kept then.

    model: of the array, or the suit.toml of several; without it, those that the recordings hold. window: each step has
    so many of the last frames. columns: only these quantities. state, action: a topic of joints in the recordings, or a
    CSV with time_s for each. Without a state the only topic of joints is it; () is none. times_ns: the times of the
    steps of each recording, such as those of its images, in place of fps. Of a single recording they may be those of
    several episodes, one after the other. tare, tare_force, follow_drift: zero as `dermis run` has it. hold_out: a
    share of the episodes, or recordings, which then are the last episodes. cut: each span of a label in the marks of
    the recordings is an episode, and what has no label is left out.
    """

    def __init__(
        self,
        recordings: _Path | Sequence[_Path],
        *,
        model: _Path | None = None,
        fps: float = 30.0,
        window: int = 1,
        columns: Sequence[str] | None = None,
        flat: bool = False,
        state: _Path | Sequence[_Path] | None = None,
        action: _Path | Sequence[_Path] | None = None,
        times_ns: Sequence[ArrayLike] | None = None,
        tare: bool = False,
        tare_force: bool = False,
        follow_drift: bool = False,
        hold_out: float | _Path | Sequence[_Path] | None = None,
        cut: bool = False,
    ) -> None: ...
    def __len__(self) -> int: ...
    @property
    def held_out(self) -> list[int]:
        """Episodes that are not to be trained on."""
    @property
    def labels(self) -> list[str]:
        """Names of the values of the column "label", in which -1 has none; empty: the recordings have no marks."""
    def __getitem__(self, episode: int) -> dict[str, NDArray[Any]]:
        """Columns by name, "chest" and "chest_sigma" for example; the first axis are the steps."""
    def write(self, folder: _Path, *, format: str = "lerobot", task: str = "touch") -> None:
        """A dataset in a new folder, as "lerobot", "hdf5" (ACT), "robomimic" or "zarr"; memory stays the same."""

def extend_lerobot(
    old: _Path,
    new: _Path,
    recordings: _Path | Sequence[_Path],
    *,
    model: _Path | None = None,
    window: int = 1,
    columns: Sequence[str] | None = None,
    flat: bool = False,
    starts_ns: Sequence[int] | None = None,
) -> None:
    """A copy of a dataset of LeRobot v3 with tactile columns at the times of its steps; needs pyarrow. `old` stays as
    it is. recordings: one for each episode, or one for all. starts_ns: when each episode begins, on the clock of its
    recording; without them half a frame after its first one. The others: as of Dataset."""

class Load:
    """A load that was known while a frame was taken: newtons over all taxels of `where`, or pascals on each of them.

    where: (row, col), or (first_row, first_col, last_row, last_col), both ends inclusive.
    """

    def __init__(
        self,
        frame: int,
        where: tuple[int, int] | tuple[int, int, int, int],
        *,
        newtons: float | None = None,
        pascals: float | None = None,
    ) -> None: ...
    @property
    def frame(self) -> int: ...
    @property
    def where(self) -> tuple[int, int, int, int]: ...
    @property
    def newtons(self) -> float | None: ...
    @property
    def pascals(self) -> float | None: ...

class CalibrationReport:
    @property
    def frames(self) -> int: ...
    @property
    def frames_rejected(self) -> int: ...
    @property
    def first_rejection(self) -> str: ...
    @property
    def remarks(self) -> list[str]: ...
    @property
    def circuit(self) -> list[str]: ...
    @property
    def choice(self) -> str: ...
    @property
    def median_fit_error(self) -> float: ...
    @property
    def lightest_newtons(self) -> float: ...
    @property
    def heaviest_newtons(self) -> float: ...

def read_loads(path: _Path, array: ArrayDescription | _Path, frames: int) -> list[Load]:
    """The loads of a loads.csv; `frames`: of the recording that it labels."""

def calibrate(
    array: ArrayDescription | _Path,
    frames: Recording | _Path,
    loads: Iterable[Load] | _Path,
    *,
    settle_s: float = 0.0,
    progress: Callable[[str, float], Any] | None = None,
) -> tuple[Model, CalibrationReport]:
    """`dermis calibrate`. Frames that no load names are not labelled; progress(stage, share) hears how far it is."""

def evaluate(model: Model, frames: Recording | _Path, loads: Iterable[Load] | _Path) -> dict[str, Any]:
    """The output of `dermis evaluate --json`."""

class Source:
    """Frames of a device, a recording or the simulator, one after another. A device is read in the background: 4,096
    frames wait for a busy program, then the oldest are dropped. Ctrl-C ends a wait."""

    def __iter__(self) -> Iterator[RawFrame]: ...
    def __next__(self) -> RawFrame: ...
    def __aiter__(self) -> AsyncIterator[RawFrame]: ...
    async def __anext__(self) -> RawFrame: ...
    def latest(self, timeout_s: float | None = None) -> RawFrame | None:
        """The newest frame of a device; older ones that wait are passed over. Where none has come since the last call
        it waits, and raises TimeoutError after timeout_s. A file gives the next frame. None at the end."""
    def __enter__(self) -> Source: ...
    def __exit__(self, *error: type[BaseException] | BaseException | TracebackType | None) -> None: ...
    def close(self) -> None: ...
    @property
    def uri(self) -> str: ...
    @property
    def shape(self) -> tuple[int, int] | None:
        """(rows, cols); None where only the first frame will show it."""
    @property
    def is_live(self) -> bool: ...
    @property
    def dropped(self) -> int: ...
    def notices(self) -> Sequence[str]:
        """Notices for the user since the last call."""

def open(uri: _Path, array: ArrayDescription | _Path | None = None) -> Source:
    """A device or the simulator by its URI (docs/devices.md), or a file of frames by its path."""

class SuitArray:
    """One array of a suit: its source, its model, and what turns its frames into forces and contacts."""

    name: str
    model: Model
    source: Source
    pipeline: Pipeline
    contacts: ContactTracker
    def __init__(self, name: str, model: Model, source: Source) -> None: ...
    def latest(self, timeout_s: float | None = None) -> ForceFrame | None:
        """Does the same as Source.latest()."""

class Suit:
    """All arrays of a suit.toml (docs/suit.md), by their names. Devices are read in the background. `recording`: of
    the suit, in place of its sources."""

    arrays: dict[str, SuitArray]
    def __init__(self, path: _Path, recording: _Path | None = None) -> None: ...
    def __getitem__(self, name: str) -> SuitArray: ...
    def __iter__(self) -> Iterator[SuitArray]: ...
    def __len__(self) -> int: ...
    def latest(self, timeout_s: float | None = None) -> dict[str, ForceFrame]:
        """Forces of each array that has not ended; see Source.latest()."""
    def tare(self, *, force: bool = False) -> None:
        """All arrays: see Pipeline.tare()."""
    def close(self) -> None: ...
    def __enter__(self) -> Suit: ...
    def __exit__(self, *error: type[BaseException] | BaseException | TracebackType | None) -> None: ...

class Server:
    """`dermis serve` in the background of this process."""

    @property
    def port(self) -> int: ...
    @property
    def url(self) -> str: ...
    def stop(self) -> None: ...
    def __enter__(self) -> Server: ...
    def __exit__(self, *error: type[BaseException] | BaseException | TracebackType | None) -> None: ...

def serve(
    uri: _Path | None = None,
    model: _Path | None = None,
    *,
    suit: _Path | None = None,
    classes: _Path | None = None,
    threats: _Path | None = None,
    record: _Path | None = None,
    host: str = "127.0.0.1",
    port: int = 8080,
    token: str = "",
    dds: bool = False,
    domain: int | None = None,
) -> Server:
    """The page and the stream of an array (uri and model) or of a suit; port 0 is any that is free. Where `record`
    exists, the recording has the UTC time in its name. With `dds` nodes of ROS 2 hear its topics, in their `domain` or
    in that of ROS_DOMAIN_ID."""
