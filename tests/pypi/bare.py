# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A wheel in a virtual environment that has nothing else but numpy and, for an example, h5py. No compiler is in its
path."""

import subprocess
from pathlib import Path

import numpy
from support import SmallArray, dermis

GLIBC = ("ld-linux", "libc.", "libgcc_s.", "libm.", "libpthread.", "libdl.", "librt.", "libresolv.", "libutil.")
PROGRAM = """
import bisect, bz2, lzma, random, zlib  # parts of Python with libraries of their own
import sys
import numpy
before = {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}
import dermis
pipeline = dermis.Pipeline(dermis.read_model(sys.argv[1]))
newtons = pipeline.run(dermis.Recording.read(sys.argv[2])).newtons
numpy.save(sys.argv[3], newtons)
force = pipeline.process(dermis.Recording.read(sys.argv[2])[5])
assert len(force._repr_png_()) > 1000 and "<svg" in force._repr_html_()
after = {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}
print("\\n".join(sorted(after - before)))
"""


def run(*command, **environment):
    done = subprocess.run(
        list(map(str, command)),
        env={key: str(value) for key, value in environment.items()},
        capture_output=True,
        text=True,
        cwd="/",
    )
    if done.returncode:
        raise AssertionError(f"{command}:\n{done.stdout}{done.stderr}")
    return done.stdout


def environment(python, numpy_version, folder):
    """Its Python. numpy is put there once."""
    installed = folder / "numpy.txt"
    if not installed.exists() or installed.read_text() != numpy_version:
        subprocess.run([python, "-m", "venv", "--clear", folder], check=True)
        subprocess.run([folder / "bin/pip", "install", "--quiet", f"numpy=={numpy_version}", "h5py"], check=True)
        installed.write_text(numpy_version)
    return folder / "bin/python"


def install(python, wheel):
    run(python, "-m", "pip", "install", "--quiet", "--no-index", "--force-reinstall", "--no-deps", wheel)


class BareTest(SmallArray):
    def assert_gives_the_bits_of_the_command(self, python):
        """With its own libraries."""
        frames, out = self.contacts / "frames.csv", self.work / "newtons.npy"
        loaded = run(python, "-c", PROGRAM, self.model, frames, out).splitlines()
        own = (str(python.parents[1]), str(python.resolve().parents[1]))  # of the environment and of its Python
        others = [path for path in loaded if not path.startswith(own)]
        self.assertEqual([path for path in others if not Path(path).name.startswith(GLIBC)], [])
        expected = self.work / "expected.csv"
        self.assertEqual(dermis("run", "--model", self.model, "--in", frames, "--out", expected).returncode, 0)
        table = numpy.genfromtxt(expected, delimiter=",", skip_header=1)[:, 2:].astype("f4")  # behind time and status
        newtons = numpy.load(out)
        self.assertEqual(newtons.reshape(table.shape).tobytes(), table.tobytes())
