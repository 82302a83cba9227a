# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The package as a wheel runs in a bare virtual environment, and gives the bits of the command.

Usage: wheel_test.py DERMIS PACKAGE VENV, the last of which is kept"""

import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "command_line"))
sys.path.append(str(Path(__file__).resolve().parents[2] / "python"))
sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
import build_backend
import numpy
import support
import wheels
from support import SmallArray, dermis

ROOT = Path(__file__).resolve().parents[2]
PACKAGE, VENV = (Path(sys.argv.pop(2)) for _ in range(2))
NUMPY = "1.26.4"  # the last before numpy 2, with which the other tests run
# Libraries of glibc and the compiler, which every machine has.
EVERYWHERE = ("ld-linux", "libc.", "libm.", "libgcc_s.", "libstdc++.", "libpthread.", "libdl.", "librt.", "libresolv.")
PROGRAM = """
import bz2, lzma  # with libraries of their own
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


def run(*command):
    """In an environment without anything."""
    return subprocess.run(list(map(str, command)), env={}, check=True, capture_output=True, text=True, cwd="/").stdout


def bare_environment():
    """With nothing but numpy, which is put there once."""
    installed = VENV / "numpy.txt"
    if not installed.exists() or installed.read_text() != NUMPY:
        subprocess.run([sys.executable, "-m", "venv", "--clear", VENV], check=True)
        subprocess.run([VENV / "bin/pip", "install", "--quiet", f"numpy=={NUMPY}"], check=True)
        installed.write_text(NUMPY)
    return VENV / "bin/python"


class Wheel(SmallArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        raw = build_backend.pack_wheel(PACKAGE, cls.root, wheels.licenses_of(PACKAGE))
        cls.wheel = wheels.repair(Path(sys.prefix), cls.root / raw, cls.root / "repaired")
        cls.python = bare_environment()
        pip = (cls.python, "-m", "pip", "install", "--quiet", "--no-index", "--force-reinstall", "--no-deps")
        run(*pip, cls.wheel)

    def test_its_libraries_are_inside_and_it_gives_the_bits_of_the_command(self):
        frames, out = self.contacts / "frames.csv", self.work / "newtons.npy"
        loaded = run(self.python, "-c", PROGRAM, self.model, frames, out).splitlines()
        others = [path for path in loaded if not path.startswith(str(VENV))]
        self.assertGreater(len(loaded) - len(others), 10)
        self.assertEqual([path for path in others if not Path(path).name.startswith(EVERYWHERE)], [])
        expected = self.work / "expected.csv"
        self.assertEqual(dermis("run", "--model", self.model, "--in", frames, "--out", expected).returncode, 0)
        table = numpy.genfromtxt(expected, delimiter=",", skip_header=1)[:, 2:].astype("f4")  # behind time and status
        newtons = numpy.load(out)
        self.assertEqual(newtons.reshape(table.shape).tobytes(), table.tobytes())

    def test_it_has_the_licenses_of_its_libraries(self):
        names = zipfile.ZipFile(self.wheel).namelist()
        licenses = {name.split("/")[-1] for name in names if "/licenses/" in name}
        self.assertLessEqual({"libhdf5-103-1", "libtbb12", "libcairo2"}, licenses)

    def test_the_archive_of_the_sources_has_what_git_has(self):
        with tarfile.open(self.work / build_backend.build_sdist(self.work)) as archive:
            names = {name.split("/", 1)[1] for name in archive.getnames()}
            about = archive.extractfile(f"dermis-{build_backend.version()}/PKG-INFO").read().decode()
        listed = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
        self.assertEqual(names - {"PKG-INFO"}, {name for name in listed.splitlines() if (ROOT / name).exists()})
        self.assertIn("Name: dermis", about)


if __name__ == "__main__":
    support.main()
