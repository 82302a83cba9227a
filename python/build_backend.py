# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Makes the wheel (PEP 517): CMake builds the module for the Python that runs this, and the package is zipped."""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / f"wheel-{sysconfig.get_config_var('SOABI')}"


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
    try:
        subprocess.run(["cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", *options], check=True)
    except (FileNotFoundError, subprocess.CalledProcessError):
        sys.exit("dermis cannot be built: cmake, a compiler or a library is missing; scripts/setup build installs them")


def build_package():
    configure(
        "-DCMAKE_BUILD_TYPE=Release",
        "-DDERMIS_UNITY_BUILD=ON",
        "-DDERMIS_BUILD_PYTHON=ON",
        "-DDERMIS_BUILD_TESTS=OFF",
        f"-DPython3_EXECUTABLE={sys.executable}",
    )
    subprocess.run(["cmake", "--build", BUILD, "--target", "dermis_python"], check=True)
    return BUILD / "python" / "dermis"


def record_line(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """So pip asks for numpy before it builds for minutes."""
    folder = Path(metadata_directory) / info()
    folder.mkdir()
    (folder / "METADATA").write_text(metadata())
    return info()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    package = build_package()
    tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{tag}-{tag}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
    files = {f"dermis/{file.name}": file.read_bytes() for file in sorted(package.iterdir()) if file.is_file()}
    files[f"{info()}/METADATA"] = metadata().encode()
    files[f"{info()}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: dermis\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    record = "".join(record_line(name, content) for name, content in files.items()) + f"{info()}/RECORD,,\n"
    files[f"{info()}/RECORD"] = record.encode()
    name = f"dermis-{version()}-{tag}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as wheel:
        for place, content in files.items():
            wheel.writestr(place, content)
    return name


def build_sdist(sdist_directory, config_settings=None):
    raise NotImplementedError("the sources of dermis are its repository; install from a clone of it")
