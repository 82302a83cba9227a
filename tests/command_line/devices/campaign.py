# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Plays an emulated device to `dermis record` and compares what was recorded with what the device measured."""

import contextlib
import math
import os
import random
import signal
import subprocess
import time
from array import array
from dataclasses import dataclass, field

from devices.emulators import Piece
from devices.lines import Stored, open_line
from devices.recordings import read_frames

# A shell makes what it starts in the background ignore SIGINT; what is started from here is to heed it.
signal.signal(signal.SIGINT, signal.default_int_handler)


@dataclass
class Outcome:
    name: str
    sent: int = 0
    equal: int = 0
    lost: list = field(default_factory=list)  # numbers of undamaged frames that were not recorded
    damaged: int = 0  # frames with a changed byte
    wrong: list = field(
        default_factory=list
    )  # (place in the recording, taxels that differ from the nearest damaged frame)
    resynchronisation: int = 0  # most undamaged frames lost in a row
    out_of_order: int = 0  # doubled, or older than the one before
    misreported: int = 0  # equal frames with another number, time, temperature or supply than the device sent
    lost_before: int = 0  # by the recording: frames that the device says it could not send
    expected_lost_before: int = 0
    worst_delay: float = 0.0
    rate: float = 0.0  # bytes per second
    status: int = None
    says: str = ""

    def failures(self, checksum):
        if self.status != 0:
            yield f"status {self.status}"
        if self.lost and not self.damaged:
            yield f"{len(self.lost)} lost, first {self.lost[:5]}"
        if self.damaged and self.resynchronisation > 2:
            yield f"{self.resynchronisation} undamaged frames lost in a row, {len(self.lost)} in all: {self.lost[:20]}"
        if self.wrong and (checksum or not self.damaged):
            yield f"{len(self.wrong)} wrong, first {self.wrong[:5]}"
        if len(self.wrong) > self.damaged:
            yield f"{len(self.wrong)} wrong frames of {self.damaged} damaged ones"
        if self.misreported:
            yield f"{self.misreported} with another number, time, temperature or supply"
        if self.out_of_order:
            yield f"{self.out_of_order} doubled or out of order"
        if not self.damaged and self.lost_before != self.expected_lost_before:
            yield f"{self.lost_before} reported lost, not {self.expected_lost_before}"


def damage(pieces, generator, share):
    """The pieces with that share of their bytes dropped, inserted or flipped, and the frames that it hit."""

    def gap():
        return int(math.log(1.0 - generator.random()) / math.log(1.0 - share))

    changed, hit, until = [], set(), gap()
    for piece in pieces:
        data, places = bytearray(piece.data), []
        while until < len(piece.data):
            places.append(until)
            until += gap() + 1
        until -= len(piece.data)
        for place in reversed(places):
            kind = generator.choice(("drop", "insert", "flip"))
            if kind == "drop":
                del data[place]
            elif kind == "insert":
                data.insert(place, generator.randrange(256))
            else:
                data[place] ^= generator.randrange(1, 256)
            if kind != "insert" or place > 0:  # what is inserted between two frames damages neither
                hit.update(piece.frames)
        changed.append(Piece(bytes(data), piece.frames))
    return changed, hit


def join_in_the_middle(pieces, generator):
    """The pieces of a device that has been sending for a while: the first one is cut. And the frames that it hit."""
    first = next(number for number, piece in enumerate(pieces) if piece.frames)
    cut = generator.randrange(1, len(pieces[first].data))
    return [Piece(pieces[first].data[cut:], pieces[first].frames), *pieces[first + 1 :]], set(pieces[first].frames)


def key(counts):
    """Readings as bytes, in which all that are not a number are equal."""
    return array("f", [value if value == value else math.nan for value in counts]).tobytes()


def is_reported(frame, record):
    """The recording says of a frame what the device said."""
    acquisition = record.acquisition
    supply = acquisition["supply_v"] if acquisition["has_supply_v"] else None
    sequence = acquisition["sequence_number"] if acquisition["has_sequence_number"] else None
    time = acquisition["device_time_ns"] if acquisition["has_device_time"] else None
    return (
        all(
            said is None or (heard is not None and abs(said - heard) < 1e-9)
            for said, heard in ((frame.temperature, record.temperature), (frame.supply, supply))
        )
        and frame.sequence in (None, sequence)
        and frame.device_time in (None, time)
    )


def compare(outcome, frames, hit, recorded):
    numbers = {key(frame.counts): number for number, frame in enumerate(frames)}
    outcome.sent, outcome.damaged = len(frames), len(hit)
    seen, last, unknown = set(), -1, []
    for place, record in enumerate(recorded):
        number = numbers.get(key(record.counts))
        if number is None:
            unknown.append((place, last + 1, record.counts))
        elif number <= last:
            outcome.out_of_order += 1
        else:
            seen.add(number)
            last = number
            outcome.misreported += not is_reported(frames[number], record)
    outcome.equal = len(seen)
    outcome.lost = [number for number in range(len(frames)) if number not in seen and number not in hit]
    run = 0
    for number in range(len(frames)):
        run = 0 if number in seen else run + (number not in hit)
        outcome.resynchronisation = max(outcome.resynchronisation, run)
    for place, begin, counts in unknown:
        end = next((number for number in range(begin, len(frames)) if number in seen), len(frames))
        candidates = [number for number in range(begin, end) if number in hit][:100]
        near = [sum(a != b for a, b in zip(counts, frames[number].counts)) for number in candidates]
        outcome.wrong.append((place, min(near, default=len(counts))))
    outcome.lost_before = sum(record.acquisition["lost_before"] for record in recorded)
    outcome.expected_lost_before = sum(frame.lost_before for frame in frames)


class Recorder:
    """`dermis record` at work."""

    def __init__(self, binary, uri, out, *arguments, **options):
        self.process = subprocess.Popen(
            [binary, "record", "--from", uri, "--out", str(out), *map(str, arguments)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            **options,
        )

    def is_running(self):
        return self.process.poll() is None

    def kill(self):
        """Ends it without a word, where it still runs."""
        self.process.kill()
        self.process.wait()
        self.process.stderr.close()

    def finish(self, patience, interrupt=False):
        """Its status and what it said; it is interrupted where it does not end by itself in that time."""
        if interrupt:
            self.process.send_signal(signal.SIGINT)
        try:
            says = self.process.communicate(timeout=patience)[1]
        except subprocess.TimeoutExpired:
            if not interrupt:
                status, says = self.finish(patience, interrupt=True)
                return -signal.SIGINT if status == 0 else status, f"{says}(interrupted: it did not end by itself)"
            self.process.kill()
            says = self.process.communicate()[1] + "(killed)"
        return self.process.returncode, says


def serve_requests(line, device, pieces, is_running, seconds):
    """Answers requests. Returns how many pieces were sent."""
    end, heard = time.monotonic() + seconds, b""
    while device.request not in heard:
        heard += line.read(0.1)
        if not is_running() or time.monotonic() > end:
            return 0
    if not device.request_per_frame:
        # the board never reads its input again (pressure-mat, main.c): what is sent to it fills its buffer
        line.play(pieces, device.bytes_per_second, is_running)
        return len(pieces)
    waiting = heard.count(device.request)
    for number, piece in enumerate(pieces):
        while not waiting:
            waiting = line.read(0.05).count(device.request)
            if not is_running() or time.monotonic() > end:
                return number
        waiting -= 1
        line.play([piece], device.bytes_per_second, is_running)
    return len(pieces)


def record(
    binary,
    folder,
    device,
    transport,
    seconds=None,
    count=None,
    corrupt=False,
    auto=False,
    joined=False,
    seed=1,
    share=1e-4,
):
    """One run: the device is played on the transport while dermis records it."""
    generator = random.Random(f"{device.name} {transport} {seed}")
    frames, pieces = device.stream(generator, seconds, count)
    hit = set()
    if joined:
        pieces, hit = join_in_the_middle(pieces, generator)
    if corrupt:
        pieces, spoilt = damage(pieces, generator, share)
        hit |= spoilt
    name = f"{device.name} {transport}{' auto' if auto else ''}{' corrupt' if corrupt else ''}"
    outcome = Outcome(name.replace(",", "").replace(" ", "_"), rate=device.bytes_per_second)
    out = folder / f"{outcome.name}.mcap"
    if transport == "file":
        place = folder / f"{outcome.name}.bin"
        place.write_bytes(b"".join(piece.data for piece in pieces))
        recorder = Recorder(binary, Stored(place).uri(device.parameters(auto, shape=joined)), out)
        outcome.status, outcome.says = recorder.finish(120)
    else:
        ends_by_itself = transport in ("serial", "udp") and not corrupt
        with contextlib.closing(open_line(transport, device)) as line:
            recorder = Recorder(
                binary,
                line.uri(device.parameters(auto, shape=joined)),
                out,
                *(("--frames", len(frames)) if ends_by_itself else ()),
            )
            try:
                line.wait_for_reader(recorder.is_running)
                if device.request and transport == "serial":
                    sent = serve_requests(line, device, pieces, recorder.is_running, 2 * (seconds or 10) + 20)
                    if corrupt and sent < len(pieces):
                        frames = frames[:sent]
                        hit = {number for number in hit if number < sent}
                else:
                    line.play(pieces, device.bytes_per_second, recorder.is_running)
            except OSError as error:
                outcome.says = f"({error}) "
            outcome.worst_delay = line.worst_delay
            if transport in ("tcp", "tcp-listen"):
                line.close()
            interrupt = corrupt and transport == "serial"
            if interrupt:
                time.sleep(1)
            outcome.status, says = recorder.finish(20, interrupt)
            outcome.says += says
    compare(outcome, frames, hit, read_frames(out) if os.path.exists(out) else [])
    return outcome
