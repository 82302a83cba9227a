# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""What surrounds a suit in scripts/week: its clock, its disk, its network, its hub."""

import contextlib
import json
import mmap
import os
import shutil
import signal
import struct
import subprocess
import threading
import time
import urllib.request

from fleet_hosts import start_wire
from served_suit import ROOT, free_port

ROBOT = "anna"
DISK_BYTES = 512 << 20
START_S = 60
ROOM_BYTES = 256 << 10  # that a full disk still has


class Preloaded:
    """A library of this folder within a process, and the number that they share."""

    def __init__(self, folder, name):
        library, file = folder / f"{name}.so", folder / name
        source = ROOT / f"scripts/{name}.c"
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", library, source, "-ldl"], check=True)
        file.write_bytes(bytes(8))
        with file.open("r+b") as opened:
            self.place = mmap.mmap(opened.fileno(), 8)
        self.environment = {"LD_PRELOAD": str(library), name.upper(): str(file)}

    @property
    def number(self):
        return struct.unpack_from("<q", self.place)[0]

    @number.setter
    def number(self, number):
        struct.pack_into("<q", self.place, 0, number)


class SetClock(Preloaded):
    """The UTC clock of a process, which can be set."""

    def __init__(self, folder):
        super().__init__(folder, "stepping_clock")

    def step(self, seconds):
        self.number += round(seconds * 1e9)


class Disk:
    """A small one, in this process's namespace of mounts alone."""

    def __init__(self, folder):
        self.folder = folder
        folder.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={DISK_BYTES}", "tmpfs", folder], check=True)

    def fill(self):
        """Until nothing more can be written; but for a little that comes back."""
        with contextlib.suppress(OSError), open(self.folder / "filler", "ab", buffering=0) as filler:
            while True:
                os.posix_fallocate(filler.fileno(), filler.seek(0, os.SEEK_END), 1 << 16)

    def empty(self):
        (self.folder / "filler").unlink(missing_ok=True)

    def close(self):
        subprocess.run(["umount", "-l", self.folder], check=False)


class Hub:
    """A nats-server, which a robot reaches by a wire that can be cut."""

    def __init__(self, folder):
        self.folder = folder
        folder.mkdir()
        self.port, self.robots_port, self.monitor = free_port(), free_port(), free_port()
        self.url = f"nats://127.0.0.1:{self.port}"
        self.robots_url = f"nats://127.0.0.1:{self.robots_port}"
        self.wire = None
        self.start()
        self.connect()

    def start(self):
        command = ["nats-server", "-a", "127.0.0.1", "-p", self.port, "-m", self.monitor, "-js", "-sd", self.folder]
        with open(self.folder / "log", "ab") as log:
            self.process = subprocess.Popen([str(word) for word in command], stdout=log, stderr=log)

    def stop(self):
        self.process.kill()
        self.process.wait()

    @property
    def is_reached(self):
        return self.wire is not None and not self.is_stalled

    def connect(self):
        if self.wire is None:
            self.is_stalled = False
            self.wire = start_wire("tcp", self.robots_port, self.port)

    def cut(self):
        """Connections are reset, new ones refused."""
        if self.wire is not None:
            self.wire.kill()
            self.wire.wait()
        self.wire = None

    def stall(self):
        """Nothing comes through, nothing is closed."""
        if self.wire is not None:
            self.is_stalled = True
            self.wire.send_signal(signal.SIGSTOP)

    def flow(self):
        self.is_stalled = False
        if self.wire is not None:
            self.wire.send_signal(signal.SIGCONT)

    def messages(self):
        """Those of the robot's stream; None: the server does not answer."""
        with contextlib.suppress(OSError, KeyError, ValueError):
            with urllib.request.urlopen(f"http://127.0.0.1:{self.monitor}/jsz?streams=1", timeout=2) as answer:
                accounts = json.load(answer).get("account_details", [])
            streams = [stream for account in accounts for stream in account.get("stream_detail", [])]
            return sum(stream["state"]["messages"] for stream in streams if stream["name"] == f"dermis_{ROBOT}")
        return None

    def close(self):
        self.cut()
        self.stop()


class Models:
    """Two that fit and one that does not, which take turns."""

    def __init__(self, binary, hub, folder, arrays, fitting, unfit):
        self.binary, self.hub, self.folder, self.arrays = binary, hub, folder, arrays
        self.fitting, self.unfit = fitting, unfit
        self.pushes = self.refused = 0

    def run(self, *arguments):
        """In the background, as the hub may be away."""
        command = [self.binary, "fleet", *map(str, arguments)]
        threading.Thread(target=self.finish, args=(command,), daemon=True).start()

    def finish(self, command):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        self.pushes += done.returncode == 0
        self.refused += done.returncode != 0

    def for_each(self):
        return [word for array in self.arrays for word in ("--for", f"{ROBOT}/{array}")]

    def push(self, model):
        self.run("push", self.hub.url, model, *self.for_each())

    def push_unfit(self):
        self.run("push", self.hub.url, self.unfit, "--for", f"{ROBOT}/{self.arrays[0]}")

    def roll_back(self):
        self.run("rollback", self.hub.url, "--for", f"{ROBOT}/{self.arrays[0]}")


class Robot:
    """`dermis serve` at work on the arrays."""

    def __init__(self, binary, folder, disk, suit, hub, clock, sanitized):
        self.log = folder / "serve.log"
        self.reports = folder / "sanitizer"
        self.port = free_port()
        self.heap = None if sanitized else Preloaded(folder, "heap_in_use")
        environment = {**os.environ, **clock.environment}
        if self.heap:
            both = ":".join(part.environment["LD_PRELOAD"] for part in (clock, self.heap))
            environment |= self.heap.environment | {"LD_PRELOAD": both}
        else:
            options = f"log_path={self.reports}:exitcode=0"
            leaks = f"suppressions={ROOT / 'tests/leaks_of_others.txt'}:print_suppressions=0"
            environment |= {"ASAN_OPTIONS": options, "UBSAN_OPTIONS": f"{options}:print_stacktrace=1"}
            environment |= {"TSAN_OPTIONS": options, "LSAN_OPTIONS": leaks}
        command = [binary, "serve", "--suit", suit, "--record", disk.folder / "week.mcap", "--port", self.port]
        command += ["--publish", hub.robots_url, "--robot", ROBOT]
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen([str(word) for word in command], stderr=log, stdout=log, env=environment)

    def is_served(self):
        with contextlib.suppress(OSError):
            urllib.request.urlopen(f"http://127.0.0.1:{self.port}/", timeout=2).close()
            return True
        return False

    def wait(self):
        end = time.monotonic() + START_S
        while not self.is_served():
            if self.process.poll() is not None or time.monotonic() > end:
                raise RuntimeError(f"dermis serve: {self.log.read_text()}")
            time.sleep(0.2)

    def memory(self):
        """[bytes] that are the process's own: heap and stacks; those of the heap that are in use."""
        with open(f"/proc/{self.process.pid}/status") as status:
            own = next(1024 * int(line.split()[1]) for line in status if line.startswith("RssAnon"))
        return own, self.heap.number if self.heap else 0

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(120)

    def sanitizer_reports(self):
        return sorted(self.reports.parent.glob(f"{self.reports.name}.*"))

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()


def needs():
    """What is missing on this machine, in a sentence; empty: nothing."""
    missing = [program for program in ("nats-server", "cc", "mount") if shutil.which(program) is None]
    return f"{', '.join(missing)} not installed" if missing else ""
