# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A workspace of ROS 2 that Debian's packages build: dermis_msgs, and a reader of our messages.

Debian has the generators of ROS 2 but no messages, so those of others that ours use are packages of their .msg files
here. `rosidl_default_generators` and `rosidl_default_runtime` are packages here, too: they name what Debian has."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MESSAGES = ROOT / "src/bytes/ros_messages/msg"
READER = Path(__file__).resolve().parent / "reader"
STAND_INS = {
    "rosidl_default_generators": "rosidl_cmake rosidl_generator_cpp rosidl_typesupport_introspection_cpp",
    "rosidl_default_runtime": "rosidl_runtime_cpp rosidl_typesupport_interface rosidl_typesupport_introspection_cpp",
}
PACKAGE_XML = """<?xml version="1.0"?>
<package format="3">
  <name>{name}</name>
  <version>0.0.0</version>
  <description>For a test of dermis</description>
  <maintainer email="authors@dermis.invalid">The dermis authors</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  {depends}
  {group}
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
GROUP = "<member_of_group>rosidl_interface_packages</member_of_group>"
STAND_IN_CMAKE = """cmake_minimum_required(VERSION 3.16)
project({name} NONE)
find_package(ament_cmake REQUIRED)
ament_export_dependencies({exported})
ament_package()
"""
MESSAGES_CMAKE = """cmake_minimum_required(VERSION 3.16)
project({name} C CXX)
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
{finds}
file(GLOB messages RELATIVE ${{CMAKE_CURRENT_SOURCE_DIR}} msg/*.msg)
rosidl_generate_interfaces(${{PROJECT_NAME}} ${{messages}} {dependencies})
ament_export_dependencies(rosidl_default_runtime)
ament_package()
"""


def write(path, text):
    """Only what has changed, so that a second build has nothing to do."""
    if not path.exists() or path.read_text() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def package_xml(name, depends, group=""):
    lines = "\n  ".join(f"<depend>{package}</depend>" for package in depends)
    return PACKAGE_XML.format(name=name, depends=lines, group=group)


def used_by(package):
    texts = [path.read_text() for path in (MESSAGES / package).glob("*.msg")]
    used = {name for text in texts for name in re.findall(r"^(\w+)/", text, re.MULTILINE)}
    return sorted(used - {package})


def write_messages(package, folder):
    used = used_by(package)
    write(folder / "package.xml", package_xml(package, [*used, *STAND_INS], GROUP))
    finds = "\n".join(f"find_package({name} REQUIRED)" for name in used)
    dependencies = f"DEPENDENCIES {' '.join(used)}" if used else ""
    write(folder / "CMakeLists.txt", MESSAGES_CMAKE.format(name=package, finds=finds, dependencies=dependencies))
    for path in (MESSAGES / package).glob("*.msg"):
        write(folder / "msg" / path.name, path.read_text())


def names_in(packages):
    return sorted(f"{package}/{path.stem}" for package in packages for path in (MESSAGES / package).glob("*.msg"))


def has_fields(message):
    return re.search(r"^[\w/]+(?:\[\])? \w+\s*(?:#.*)?$", (MESSAGES / f"{message}.msg").read_text(), re.MULTILINE)


def write_reader(packages, folder):
    shutil.copytree(READER, folder, dirs_exist_ok=True)
    write(folder / "package.xml", package_xml("dermis_reader", packages))
    messages = [message for message in names_in(packages) if has_fields(message)]
    rows = "".join(f"HANDLE({message.replace('/', ', ')})\n" for message in messages)
    write(folder / "handles.inc", rows)
    write(folder / "packages.cmake", f"set(packages {' '.join(packages)})\n")


def write_sources(dermis_msgs, sources):
    packages = sorted(path.name for path in MESSAGES.iterdir())
    for name, exported in STAND_INS.items():
        write(sources / name / "package.xml", package_xml(name, []))
        write(sources / name / "CMakeLists.txt", STAND_IN_CMAKE.format(name=name, exported=exported))
    for package in packages:
        if package != "dermis_msgs":
            write_messages(package, sources / package)
    link = sources / "dermis_msgs"
    link.unlink(missing_ok=True)
    link.symlink_to(dermis_msgs.resolve())
    write_reader(packages, sources / "dermis_reader")


def build(dermis_msgs, workspace):
    """With the package `dermis_msgs`. Returns the program tests/ros/reader."""
    write_sources(dermis_msgs, workspace / "src")
    launcher = [f"-DCMAKE_{language}_COMPILER_LAUNCHER=ccache" for language in ("C", "CXX") if shutil.which("ccache")]
    # Debian's Python, as its modules are for that.
    environment = {**os.environ, "PATH": f"/usr/bin:{os.environ['PATH']}"}
    built = subprocess.run(
        ["colcon", "build", "--cmake-args", "-GNinja", "-DBUILD_TESTING=OFF", *launcher],
        cwd=workspace,
        env=environment,
        capture_output=True,
        text=True,
    )
    if built.returncode:
        sys.exit(f"{built.stdout[-4000:]}\n{built.stderr[-4000:]}")
    return workspace / "build/dermis_reader/dermis_reader"
