#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The folders with sources in C++, for formatters, linters, checks of words and rules of architecture. Prints all, for
scripts in bash."""

# Of each plugin, the room that loads it: its header is all that the plugin knows of the project, beside frames.
PLUGINS = {
    "dds": "live/dds",
    "hdf5": "bytes/recordings",
    "modbus": "live/buses",
    "mpi": "paper",
    "nats": "live/fleet",
    "pictures": "out/report",
}
PRODUCTION = ("include", "src", "apps", "bindings", "plugins")
ALL = (*PRODUCTION, "examples", "benchmarks", "fuzz", "tests")

if __name__ == "__main__":
    print(*ALL, sep="\n")
