# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Usage: check_compile_fail.py SOURCE COMPILER [FLAGS...]
The source compiles as it is; with MISTAKE defined it must not, with the error of its line "// expected error:
REGEX"."""

import re
import subprocess
import sys
from pathlib import Path

source, *command = sys.argv[1:]
expected = re.search(r"^// expected error: (.*)$", Path(source).read_text(), re.MULTILINE).group(1)

right = subprocess.run(command + [source], capture_output=True, text=True)
if right.returncode != 0:
    sys.exit(f"the right code does not compile:\n{right.stderr}")
wrong = subprocess.run(command + ["-DMISTAKE", source], capture_output=True, text=True)
if wrong.returncode == 0:
    sys.exit("the mistake compiles")
if not re.search(expected, wrong.stderr):
    sys.exit(f"expected an error like '{expected}', got:\n{wrong.stderr}")
