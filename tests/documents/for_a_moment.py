#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Runs dermis as a reader of the guides does: the device is the simulator, ports are free ones. Somebody presses Ctrl-C
a second after a live command has given its first output. The threat of a watch ends it.

Usage: for_a_moment.py DERMIS ARGUMENT..."""

import re
import signal
import subprocess
import sys
import threading

DEVICES = re.compile(r"serial:///dev/ttyACM0|tcp://192\.168\.1\.20:7000")
MOMENT_S = 1
CROSSED = 3  # the status of a watch


def arguments_of(texts):
    arguments = [re.sub(DEVICES, "sim:contacts?rate=100", text).replace("8080", "0") for text in texts]
    return [*arguments, "--port", "0"] if texts[0] == "serve" and "--port" not in texts else arguments


def copy(stream, to, has_begun):
    try:
        while chunk := stream.read1(65536):
            to.write(chunk)
            to.flush()
            has_begun.set()
    except BrokenPipeError:
        stream.close()  # the command is told by its next output


def end_after_a_moment(command):
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    has_begun = threading.Event()
    streams = ((process.stdout, sys.stdout.buffer), (process.stderr, sys.stderr.buffer))
    copies = [threading.Thread(target=copy, args=(*pair, has_begun)) for pair in streams]
    for thread in copies:
        thread.start()
    has_begun.wait()
    try:
        process.wait(MOMENT_S)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGINT)
    for thread in copies:
        thread.join()
    return process.wait()


def main():
    command = [sys.argv[1], *arguments_of(sys.argv[2:])]
    if command[1] == "watch":
        return 0 if subprocess.run(command, check=False).returncode == CROSSED else 1
    if command[1] == "serve" or any(argument.startswith("sim:") for argument in command):
        return end_after_a_moment(command)
    return subprocess.run(command, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
