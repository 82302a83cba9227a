# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Holds the shared libraries of a program that runs forces to a list. Usage: check_links.py PROGRAM"""

import re
import subprocess
import sys

# Highway chooses the instruction set, toml++ reads array.toml; the others are those of every C++ program.
ALLOWED = {"linux-vdso", "ld-linux", "libc", "libgcc_s", "libm", "libstdc++", "libhwy", "libtomlplusplus"}

listing = subprocess.run(["ldd", sys.argv[1]], check=True, capture_output=True, text=True).stdout
linked = {re.split(r"\.so|-x86-64|-aarch64", line.split()[0].rsplit("/", 1)[-1])[0] for line in listing.splitlines()}
print(", ".join(sorted(linked)))
sys.exit(f"also links {', '.join(sorted(linked - ALLOWED))}" if linked - ALLOWED else 0)
