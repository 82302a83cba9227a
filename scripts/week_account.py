# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Where each frame of scripts/week is: in a recording, on the hub, or among those that the next frame tells as lost."""

import struct
import sys
from dataclasses import dataclass, field

from served_suit import ROOT

sys.path.insert(0, str(ROOT / "tests/command_line"))

from devices.recordings import read_messages
from week_devices import COLS, ROWS

LOST_BEFORE = 56  # offset in an Acquisition; four bytes of CDR come before
IMAGE_BYTES = 2 * ROWS * COLS  # the last ones of an Image

HELD, TOLD = 1, 2


def frames_in(path):
    """(array, bits, frames lost before it) of each frame, in the order of the file."""
    lost = {}
    for topic, _, message in read_messages(path.read_bytes()):
        _, array, kind = f"{topic}//".split("/")[:3]
        if kind == "acquisition":
            lost[array] = struct.unpack_from("<I", message, 4 + LOST_BEFORE)[0]
        elif kind == "raw":
            yield array, message[-IMAGE_BYTES:], lost.pop(array)


@dataclass
class Place:
    """What one place says of the frames of one device."""

    states: bytearray = field(default_factory=bytearray)  # of each frame: HELD or TOLD
    faults: list = field(default_factory=list)
    doubled: int = 0
    unknown: int = 0
    last: int = -1  # in the present file

    def begin_file(self):
        self.last = -1

    def take(self, number, lost_before):
        if number is None:
            self.unknown += 1
            return
        self.states.extend(bytes(max(0, number + 1 - len(self.states))))
        self.doubled += self.states[number] == HELD
        self.states[number] = HELD
        if self.last >= 0 and lost_before != number - self.last - 1:
            self.faults.append(f"between frames {self.last} and {number}: {lost_before} told as lost")
        elif self.last >= 0:
            self.states[self.last + 1 : number] = bytes([TOLD]) * lost_before
        self.last = number


class Account:
    """Of all devices, in the recordings and on the hub."""

    def __init__(self, devices):
        self.devices = {device.name: device for device in devices}
        self.recorded = {device.name: Place() for device in devices}
        self.on_hub = {device.name: Place() for device in devices}

    def take_file(self, path, places):
        """A file of several arrays, or of the one whose place is given."""
        for place in places.values():
            place.begin_file()
        for array, bits, lost_before in frames_in(path):
            places[array].take(self.devices[array].frames.number_in(bits), lost_before)

    def state(self, places, name, number):
        states = places[name].states
        return states[number] if number < len(states) else 0

    def without(self, name):
        """Frames that have gone out, and of which neither place knows anything."""
        device = self.devices[name]
        return [
            number
            for number in range(device.number)
            if device.whole[number]
            and not self.state(self.recorded, name, number)
            and not self.state(self.on_hub, name, number)
        ]

    def counts(self, places):
        """(held, told, neither) of the frames that have gone out."""
        counts = [0, 0, 0]
        for name, device in self.devices.items():
            for number in range(device.number):
                if device.whole[number]:
                    counts[{HELD: 0, TOLD: 1, 0: 2}[self.state(places, name, number)]] += 1
        return counts

    def faults(self):
        for what, places in (("recordings", self.recorded), ("hub", self.on_hub)):
            for name, place in places.items():
                yield from (f"{name}, {what}: {fault}" for fault in place.faults[:5])
                if len(place.faults) > 5:
                    yield f"{name}, {what}: and {len(place.faults) - 5} more"
                if place.doubled or place.unknown:
                    yield f"{name}, {what}: {place.doubled} frames twice, {place.unknown} with other bits"
        for name in self.devices:
            if missing := self.without(name):
                yield f"{name}: {len(missing)} frames without an account, first {missing[:5]}"
