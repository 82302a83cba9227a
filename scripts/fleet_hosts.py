# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Hosts for a fleet on one machine: network namespaces with a bridge, or all on the loopback; for scripts that measure.

As a program it is a wire between hosts: fleet_hosts.py taps DELAY_MS LOSS_PERCENT TAP TAP, where the kernel has no
netem, or fleet_hosts.py tcp PORT TARGET_PORT."""

import collections
import contextlib
import fcntl
import os
import random
import select
import shutil
import signal
import socket
import struct
import subprocess
import sys
import threading
import time

from served_suit import free_port

HUB = "hub"
HUB_ADDRESS = "10.77.0.1"
TUNSETIFF = 0x400454CA
IFF_TAP, IFF_NO_PI = 0x0002, 0x1000
FRAME_BYTES = 65536


def ip(*words):
    subprocess.run(["ip", *words], check=True, capture_output=True, text=True)


def start_wire(*words):
    return subprocess.Popen([sys.executable, __file__, *map(str, words)])


class Namespaces:
    """A namespace for the hub, in which a bridge is, and one for each robot. Needs the rights of root."""

    def __init__(self, robots, delay_ms, loss_percent):
        self.prefix = f"dermis{os.getpid()}"
        self.made, self.wires, self.netem = [], [], shutil.which("tc") is not None
        self.delay_ms, self.loss_percent = delay_ms, loss_percent
        self.hub_address = HUB_ADDRESS
        self.add(HUB)
        ip("-n", self.name_of(HUB), "link", "add", "br0", "type", "bridge")
        self.bring_up(HUB, "br0", f"{HUB_ADDRESS}/16")
        for number, robot in enumerate(robots):
            self.add(robot)
            self.join(robot, number)

    def name_of(self, host):
        return f"{self.prefix}-{host}"

    def add(self, host):
        ip("netns", "add", self.name_of(host))
        self.made.append(host)
        ip("-n", self.name_of(host), "link", "set", "lo", "up")

    def bring_up(self, host, device, address):
        ip("-n", self.name_of(host), "addr", "add", address, "dev", device)
        ip("-n", self.name_of(host), "link", "set", device, "up")

    def join(self, robot, number):
        """The robot to the bridge, by a pair of devices or by a wire of ours."""
        ours, hubs = f"d{os.getpid()}r{number}", f"d{os.getpid()}h{number}"
        is_slow = self.delay_ms > 0 or self.loss_percent > 0
        if is_slow and not self.has_netem():
            self.wires.append(start_wire("taps", self.delay_ms, self.loss_percent, ours, hubs))
            wait_for_devices(ours, hubs)
        else:
            ip("link", "add", ours, "type", "veth", "peer", "name", hubs)
        for host, device, name in ((robot, ours, "eth0"), (HUB, hubs, f"robot{number}")):
            ip("link", "set", device, "netns", self.name_of(host))
            ip("-n", self.name_of(host), "link", "set", device, "name", name)
            if is_slow and self.has_netem():
                self.slow_down(host, name)
        ip("-n", self.name_of(HUB), "link", "set", f"robot{number}", "master", "br0", "up")
        self.bring_up(robot, "eth0", f"10.77.{1 + number // 200}.{1 + number % 200}/16")

    def slow_down(self, host, device):
        rule = ["delay", f"{self.delay_ms}ms", "loss", f"{self.loss_percent}%"]
        command = ["tc", "-n", self.name_of(host), "qdisc", "add", "dev", device, "root", "netem", *rule]
        return subprocess.run(command, capture_output=True, check=False).returncode == 0

    def has_netem(self):
        """Of the kernel; asked by a rule for the loopback of the hub, which delays nothing."""
        if self.netem:
            command = ["tc", "-n", self.name_of(HUB), "qdisc", "replace", "dev", "lo", "root", "netem", "delay", "0ms"]
            self.netem = subprocess.run(command, capture_output=True, check=False).returncode == 0
        return self.netem

    def said(self):
        line = f"hosts: {len(self.made)} network namespaces and a bridge"
        if not self.wires and not self.delay_ms and not self.loss_percent:
            return line
        how = "a wire of the script, as the kernel has no netem" if self.wires else "netem"
        return f"{line}; each way {self.delay_ms:g} ms and {self.loss_percent:g} % lost, by {how}"

    def command(self, host, words):
        return ["ip", "netns", "exec", self.name_of(host), *map(str, words)]

    def port(self, _host, usual):
        return usual

    def target_port(self, _robot, port):
        return port

    def cut(self, robot):
        ip("-n", self.name_of(robot), "link", "set", "eth0", "down")

    def mend(self, robot):
        ip("-n", self.name_of(robot), "link", "set", "eth0", "up")

    def close(self):
        for wire in self.wires:
            wire.kill()
        for host in self.made:
            subprocess.run(["ip", "netns", "delete", self.name_of(host)], check=False)


class Loopback:
    """All hosts share this machine. Each robot reaches the hub by a relay, which stops where the link is cut."""

    hub_address = "127.0.0.1"

    def __init__(self):
        self.relays, self.ports = {}, {}

    def said(self):
        return "hosts: the loopback, as network namespaces need the rights of root; a cut link is a relay that stops"

    def command(self, _host, words):
        return [str(word) for word in words]

    def port(self, host, usual):
        return self.ports.setdefault((host, usual), free_port())

    def target_port(self, robot, port):
        """Of the robot's relay."""
        relay = free_port()
        self.relays[robot] = start_wire("tcp", relay, port)
        return relay

    def cut(self, robot):
        self.relays[robot].send_signal(signal.SIGSTOP)

    def mend(self, robot):
        self.relays[robot].send_signal(signal.SIGCONT)

    def close(self):
        for relay in self.relays.values():
            relay.kill()


def make_hosts(robots, delay_ms=0.0, loss_percent=0.0):
    """Namespaces where they can be made."""
    if shutil.which("ip") is None or os.geteuid() != 0:
        return Loopback()
    probe = f"dermis{os.getpid()}-probe"
    if subprocess.run(["ip", "netns", "add", probe], capture_output=True, check=False).returncode != 0:
        return Loopback()
    subprocess.run(["ip", "netns", "delete", probe], check=True)
    return Namespaces(robots, delay_ms, loss_percent)


def wait_for_devices(*devices):
    while not all(os.path.exists(f"/sys/class/net/{device}") for device in devices):
        time.sleep(0.02)


def open_tap(device):
    tap = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(tap, TUNSETIFF, struct.pack("16sH", device.encode(), IFF_TAP | IFF_NO_PI))
    return tap


def join_taps(delay_s, loss, devices):
    """Carries frames of Ethernet both ways, later, and without some."""
    taps = [open_tap(device) for device in devices]
    on_the_way = collections.deque()
    chance = random.Random(1)
    while True:
        wait = max(0.0, on_the_way[0][0] - time.monotonic()) if on_the_way else None
        for tap in select.select(taps, [], [], wait)[0]:
            with contextlib.suppress(OSError):  # the device is down
                frame = os.read(tap, FRAME_BYTES)
                if chance.random() >= loss:
                    on_the_way.append((time.monotonic() + delay_s, taps[tap == taps[0]], frame))
        while on_the_way and on_the_way[0][0] <= time.monotonic():
            _, tap, frame = on_the_way.popleft()
            with contextlib.suppress(OSError):
                os.write(tap, frame)


def carry(origin, target):
    with contextlib.suppress(OSError):
        while piece := origin.recv(FRAME_BYTES):
            target.sendall(piece)
    for end in (origin, target):
        with contextlib.suppress(OSError):
            end.shutdown(socket.SHUT_RDWR)


def relay(port, target_port):
    """Each connection by a thread each way. One whose target does not answer is closed."""
    with socket.create_server(("127.0.0.1", port)) as listener:
        while True:
            client, _ = listener.accept()
            try:
                server = socket.create_connection(("127.0.0.1", target_port))
            except OSError:
                client.close()
                continue
            for ends in ((client, server), (server, client)):
                threading.Thread(target=carry, args=ends, daemon=True).start()


if __name__ == "__main__":
    if sys.argv[1] == "taps":
        join_taps(float(sys.argv[2]) / 1000, float(sys.argv[3]) / 100, sys.argv[4:])
    else:
        relay(int(sys.argv[2]), int(sys.argv[3]))
