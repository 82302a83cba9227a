# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Makes the wheel and the archive of the sources (PEP 517). CMake builds the module for the Python that runs this, and
the package is zipped. CMAKE_ARGS has further options of cmake."""

import base64
import gzip
import hashlib
import importlib.util
import io
import os
import re
import shlex
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/wheel"
# Names by which cmake remembers the Python of an earlier wheel.
OF_PYTHON = ("Python*", "PYTHON*", "_Python*", "pybind11*", "PYBIND11*")


def version():
    return re.search(r"project\(dermis VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


def info():
    return f"dermis-{version()}.dist-info"


def metadata():
    return (
        f"Metadata-Version: 2.1\nName: dermis\nVersion: {version()}\n"
        "Summary: Calibrated force from resistive tactile arrays\n"
        "License: Apache-2.0\nRequires-Python: >=3.9\nRequires-Dist: numpy\n"
    )


def configure(*options):
    forget = [word for names in OF_PYTHON for word in ("-U", names)]
    options = [*forget, *options, *shlex.split(os.environ.get("CMAKE_ARGS", ""))]
    try:
        subprocess.run(["cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", *options], check=True)
    except (FileNotFoundError, subprocess.CalledProcessError):
        sys.exit("dermis cannot be built: cmake, a compiler or a library is missing; scripts/setup build installs them")


def headers_of_pybind11():
    """Those of this Python where it has some of version 2, else Debian's."""
    if not importlib.util.find_spec("pybind11"):
        return []
    import pybind11

    if pybind11.version_info[0] != 2:
        print(f"pybind11 {pybind11.__version__} is not taken: dermis is built with version 2", file=sys.stderr)
        return []
    return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]


def build_package():
    configure(
        *headers_of_pybind11(),
        "-DCMAKE_BUILD_TYPE=Release",
        "-DDERMIS_UNITY_BUILD=ON",
        "-DDERMIS_BUILD_PYTHON=ON",
        "-DDERMIS_BUILD_TESTS=OFF",
        f"-DPython3_EXECUTABLE={sys.executable}",
    )
    package = BUILD / "python" / "dermis"
    for earlier in package.glob("_dermis*.so"):
        earlier.unlink()
    subprocess.run(["cmake", "--build", BUILD, "--target", "dermis_python"], check=True)
    return package


def record_line(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def get_requires_for_build_wheel(config_settings=None):
    """Debian's pybind11 knows Python 3.11 and what came before."""
    tools = (ROOT / "packaging/wheels/requirements.txt").read_text()
    return re.findall(r"^pybind11==\S+", tools, re.MULTILINE) if sys.version_info >= (3, 12) else []


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """So pip asks for numpy before it builds for minutes."""
    folder = Path(metadata_directory) / info()
    folder.mkdir()
    (folder / "METADATA").write_text(metadata())
    return info()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    return pack_wheel(build_package(), wheel_directory)


def pack_wheel(package, wheel_directory, licenses=None):
    """`licenses`: name -> text, of the libraries that will be inside."""
    tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{tag}-{tag}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
    files = {f"dermis/{file.name}": file.read_bytes() for file in sorted(package.iterdir()) if file.is_file()}
    files[f"{info()}/METADATA"] = metadata().encode()
    files[f"{info()}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: dermis\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    for library, text in (licenses or {}).items():
        files[f"{info()}/licenses/{library}"] = text
    record = "".join(record_line(name, content) for name, content in files.items()) + f"{info()}/RECORD,,\n"
    files[f"{info()}/RECORD"] = record.encode()
    name = f"dermis-{version()}-{tag}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as wheel:
        for place, content in files.items():
            wheel.writestr(place, content)
    return name


def source_files():
    """All that is in git; all files in an archive of the sources, which has no git."""
    if (ROOT / "PKG-INFO").exists():
        return sorted(
            path.relative_to(ROOT) for path in ROOT.rglob("*") if path.is_file() and BUILD not in path.parents
        )
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return sorted(Path(name) for name in listed.split("\0") if name and (ROOT / name).exists())


def build_sdist(sdist_directory, config_settings=None):
    """The same sources give the same bytes."""
    folder = f"dermis-{version()}"
    name = f"{folder}.tar.gz"
    with (
        open(os.path.join(sdist_directory, name), "wb") as file,
        gzip.GzipFile(filename="", mode="wb", fileobj=file, mtime=0) as packed,
        tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive,
    ):
        for path in source_files():
            entry = archive.gettarinfo(ROOT / path, f"{folder}/{path}")
            entry.uid, entry.gid, entry.uname, entry.gname, entry.mtime = 0, 0, "", "", 0
            if entry.isreg():
                with open(ROOT / path, "rb") as content:
                    archive.addfile(entry, content)
            else:
                archive.addfile(entry)
        if not (ROOT / "PKG-INFO").exists():
            entry = tarfile.TarInfo(f"{folder}/PKG-INFO")
            entry.size = len(metadata().encode())
            archive.addfile(entry, io.BytesIO(metadata().encode()))
    return name
