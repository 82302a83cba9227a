# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Makes the wheel and the archive of the sources (PEP 517). CMake builds and installs what a wheel has
(cmake/Wheel.cmake), and that is zipped. CMAKE_ARGS has further options of cmake."""

import base64
import gzip
import hashlib
import importlib.util
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/wheel"
MINORS = range(9, 15)  # of the Pythons that wheels are for


def version():
    return re.search(r"project\(dermis VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


def info():
    return f"dermis-{version()}.dist-info"


def pythons_of(minors):
    """As Requires-Python says it."""
    missing = [f"!=3.{minor}.*" for minor in range(min(minors), max(minors)) if minor not in minors]
    return ",".join([f">=3.{min(minors)}", *missing, f"<3.{max(minors) + 1}"])


def metadata(pythons=">=3.9"):
    return (
        f"Metadata-Version: 2.1\nName: dermis\nVersion: {version()}\n"
        "Summary: Calibrated force from resistive tactile arrays\n"
        f"License: Apache-2.0\nRequires-Python: {pythons}\nRequires-Dist: numpy\n"
    )


def headers_of_pybind11():
    """Those of this Python where it has some of version 2, else Debian's."""
    if not importlib.util.find_spec("pybind11"):
        return []
    import pybind11

    if pybind11.version_info[0] != 2:
        print(f"pybind11 {pybind11.__version__} is not taken: dermis is built with version 2", file=sys.stderr)
        return []
    return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]


def build(folder, headers, *options):
    """Builds in `folder`, with a module for each Python of whose headers a folder is given. Returns the folder that has
    what a wheel holds."""
    options = [
        "-DCMAKE_BUILD_TYPE=Release",
        "-DDERMIS_UNITY_BUILD=ON",
        "-DDERMIS_BUILD_PYTHON=ON",
        "-DDERMIS_BUILD_TESTS=OFF",
        "-DDERMIS_SHARED=ON",
        f"-DDERMIS_PYTHON_HEADERS={';'.join(map(str, headers))}",
        *headers_of_pybind11(),
        *options,
        *shlex.split(os.environ.get("CMAKE_ARGS", "")),
    ]
    try:
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", *options], check=True)
    except (FileNotFoundError, subprocess.CalledProcessError):
        sys.exit("dermis cannot be built: cmake, a compiler or a library is missing; scripts/setup build installs them")
    subprocess.run(["cmake", "--build", folder, "--target", "dermis_python", "dermis_cli"], check=True)
    contents = folder / "wheel"
    shutil.rmtree(contents, ignore_errors=True)
    install = ["cmake", "--install", folder, "--component", "wheel", "--strip", "--prefix", contents]
    subprocess.run(install, check=True, stdout=subprocess.DEVNULL)
    return contents


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
    tag = f"cp3{sys.version_info.minor}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    return pack_wheel(build(BUILD, [sysconfig.get_path("include")]), wheel_directory, f"{tag}-{tag}-{platform}")


def pack_wheel(contents, wheel_directory, tag, licenses=None, pythons=">=3.9"):
    """`licenses`: name -> text, of the libraries that are inside. The same contents give the same bytes."""
    paths = sorted(path for path in contents.rglob("*") if path.is_file())
    files = {str(path.relative_to(contents)): path.read_bytes() for path in paths}
    programs = {str(path.relative_to(contents)) for path in paths if os.access(path, os.X_OK)}
    files[f"{info()}/METADATA"] = metadata(pythons).encode()
    files[f"{info()}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: dermis\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    files[f"{info()}/licenses/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    for library, text in (licenses or {}).items():
        files[f"{info()}/licenses/{library}"] = text
    record = "".join(record_line(name, content) for name, content in files.items()) + f"{info()}/RECORD,,\n"
    files[f"{info()}/RECORD"] = record.encode()
    name = f"dermis-{version()}-{tag}.whl"
    path = os.path.join(wheel_directory, name)
    with zipfile.ZipFile(path + ".part", "w", zipfile.ZIP_DEFLATED, compresslevel=9) as wheel:
        for place, content in files.items():
            entry = zipfile.ZipInfo(place)  # of 1980
            entry.external_attr = (0o100755 if place in programs else 0o100644) << 16
            wheel.writestr(entry, content, zipfile.ZIP_DEFLATED, 9)
    os.replace(path + ".part", path)
    return name


def source_files():
    """All that is in git; all files in an archive of the sources, which has no git."""
    if (ROOT / "PKG-INFO").exists():
        found = (path for path in ROOT.rglob("*") if path.is_file() or path.is_symlink())
        return sorted(
            path.relative_to(ROOT) for path in found if path.name != "PKG-INFO" and ROOT / "build" not in path.parents
        )
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return sorted(Path(name) for name in listed.split("\0") if name and (ROOT / name).exists())


def archived(source, name):
    """The entry of a file or link, with nothing of this machine: no owner, no time, no umask."""
    entry = tarfile.TarInfo(name)
    if source.is_symlink():
        entry.type, entry.linkname = tarfile.SYMTYPE, os.readlink(source)
        return entry, b""
    content = source.read_bytes()
    entry.size, entry.mode = len(content), 0o755 if os.access(source, os.X_OK) else 0o644
    return entry, content


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
            entry, content = archived(ROOT / path, f"{folder}/{path}")
            archive.addfile(entry, io.BytesIO(content))
        entry = tarfile.TarInfo(f"{folder}/PKG-INFO")
        entry.size = len(metadata().encode())
        archive.addfile(entry, io.BytesIO(metadata().encode()))
    return name
