# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The wheel of this processor, in virtual environments that have little else but numpy. The long gate runs this.

Usage: wheels_test.py DERMIS WHEEL FOLDER, which keeps the environments. It tries each Python of 3.9 to 3.14 that pyenv
or Debian has here."""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "command_line"))
sys.path.append(str(Path(__file__).resolve().parents[2] / "bindings/python"))
import bare
import build_backend
import support

TESTS = Path(__file__).resolve().parents[1]
WHEEL, FOLDER = (Path(sys.argv.pop(2)).resolve() for _ in range(2))
# The oldest and the newest that has a wheel for that Python.
NUMPYS = {
    9: ("1.26.*",),
    10: ("1.26.*", "2.*"),
    11: ("1.26.*", "2.*"),
    12: ("1.26.*", "2.*"),
    13: ("2.*",),
    14: ("2.*",),
}
# Threads, how frames show themselves, and the examples of docs/python.md.
OTHER_TESTS = ("threads", "everyday", "examples")
MEGABYTES = 12
NEWEST_GLIBC = (2, 31)


def pythons():
    """Minor version -> Python."""
    for minor in build_backend.MINORS:
        name = f"python3.{minor}"
        places = [*Path.home().glob(f".pyenv/versions/3.{minor}.*/bin/{name}"), Path("/usr/bin") / name]
        there = next((place for place in places if place.exists()), None)
        if there:
            yield minor, there
        else:
            print(f"skipped: Python 3.{minor} is not here")


def bare_environment(minor, python, numpy):
    inside = bare.environment(python, numpy, FOLDER / f"3.{minor}-{numpy.removesuffix('.*')}")
    bare.install(inside, WHEEL)
    return inside


class Wheels(bare.BareTest):
    def assert_has_the_command(self, python, command, **environment):
        version = f"{build_backend.version()}\n"
        self.assertEqual(bare.run(command, "--version", **environment), version)
        self.assertEqual(bare.run(python, "-m", "dermis", "--version", **environment), version)

    def assert_shows_newtons(self, command):
        server = subprocess.Popen(
            [command, "serve", "--from", "sim:contacts?rate=100", "--port", "0"],
            env={},
            cwd=self.work,
            stderr=subprocess.PIPE,
            text=True,
        )
        try:
            address = next(found[0] for line in server.stderr if (found := re.search(r"http://\S+/", line)))
            judge = ["node", TESTS / "viewer/newtons.mjs", address]
            shown = subprocess.run(judge, capture_output=True, text=True, timeout=300)
            self.assertRegex(shown.stdout, r"^\d+\.\d+", shown.stderr)
        finally:
            server.terminate()
            server.communicate()

    def check(self, minor, python, numpy):
        inside = bare_environment(minor, python, numpy)
        command = inside.parent / "dermis"
        self.assert_gives_the_bits_of_the_command(inside)
        self.assert_has_the_command(inside, command)
        self.assert_shows_newtons(command)
        for test in OTHER_TESTS:
            bare.run(inside, TESTS / f"python/{test}_test.py", command)

    def test_it_is_whole_in_each_python_with_each_numpy(self):
        for minor, python in pythons():
            for numpy in NUMPYS[minor]:
                with self.subTest(python=minor, numpy=numpy):
                    self.check(minor, python, numpy)

    def test_it_is_whole_where_else_pip_puts_it(self):
        minor, python = next(pythons())
        pip = ("-m", "pip", "install", "--quiet", "--no-index", "--no-deps")
        inside = bare_environment(minor, python, NUMPYS[minor][0])
        bare.run(inside, *pip, "--target", self.work / "target", WHEEL)
        self.assert_has_the_command(inside, self.work / "target/bin/dermis", PYTHONPATH=self.work / "target")
        user = {"PYTHONUSERBASE": self.work / "user"}
        bare.run(python, "-m", "pip", "install", "--quiet", "--user", "--ignore-installed", WHEEL, **user)
        self.assertEqual(bare.run(python, "-m", "dermis", "--version", **user), f"{build_backend.version()}\n")
        self.assert_has_the_command(python, self.work / "user/bin/dermis", **user)

    def test_it_has_what_a_user_looks_for_and_takes_it_away_again(self):
        minor, python = next(pythons())
        inside = bare_environment(minor, python, NUMPYS[minor][0])
        root = inside.parents[1]
        for place in (
            "bin/dermis",
            "share/man/man1/dermis-run.1",
            "share/bash-completion/completions/dermis",
            "share/zsh/site-functions/_dermis",
            "share/doc/dermis/examples/chest/array.toml",
            "share/doc/dermis/examples/python/live_view.py",
            "share/dermis/ros/dermis_msgs/package.xml",
        ):
            self.assertTrue((root / place).exists(), place)
        bare.run(inside, "-m", "pip", "uninstall", "--quiet", "--yes", "dermis")
        self.assertEqual([path for path in root.rglob("*dermis*") if not path.is_dir()], [])

    def test_it_reads_and_writes_hdf5(self):
        minor, python = next(pythons())
        inside = bare_environment(minor, python, NUMPYS[minor][0])
        frames, copy = self.contacts / "frames.csv", self.work / "copy.h5"
        bare.run(inside.parent / "dermis", "convert", frames, copy, "--array", self.array)
        read = "import sys, dermis; print(len(dermis.Recording.read(sys.argv[1])))"
        self.assertEqual(bare.run(inside, "-c", read, copy), bare.run(inside, "-c", read, frames))

    def test_it_is_small_and_names_the_licenses_of_its_libraries(self):
        self.assertLessEqual(WHEEL.stat().st_size, MEGABYTES * 1e6)
        licenses = {name.split("/")[-1] for name in zipfile.ZipFile(WHEEL).namelist() if "/licenses/" in name}
        self.assertLessEqual({"LICENSE", "hdf5", "zlib", "libzstd", "eigen3", "three"}, licenses)

    def test_it_asks_for_an_old_glibc_and_no_other_library(self):
        with zipfile.ZipFile(WHEEL) as wheel:
            wheel.extractall(self.work)
        programs = [path for path in self.work.rglob("*") if path.is_file() and path.read_bytes()[:4] == b"\x7fELF"]
        self.assertGreater(len(programs), len(list(pythons())))
        for program in programs:
            said = subprocess.run(["objdump", "-p", program], check=True, capture_output=True, text=True).stdout
            needed = set(re.findall(r"NEEDED +(\S+)", said)) - {path.name for path in programs}
            self.assertEqual([name for name in needed if not name.startswith(bare.GLIBC)], [], program.name)
            versions = [tuple(map(int, found.split("."))) for found in re.findall(r"GLIBC_([\d.]+)", said)]
            self.assertLessEqual(max(versions), NEWEST_GLIBC, program.name)


if __name__ == "__main__":
    support.main()
