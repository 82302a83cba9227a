# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""bindings/ros/dermis_msgs is a package of ROS 2 whose messages are those that dermis is built from; the launch file
launches."""

import re
import runpy
import shutil
import subprocess
import sys
import tempfile
import types
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import cyclone_types

ROOT = Path(__file__).parents[3]
PACKAGE = ROOT / "bindings/ros/dermis_msgs"
MESSAGES = ROOT / "src/bytes/ros_messages/msg/dermis_msgs"
# The grammar of ROS 2, but for what we do not use: bounds, defaults and arrays of fixed size.
FIELD = re.compile(
    r"(?:bool|byte|u?int(?:8|16|32|64)|float(?:32|64)|string|[a-z][a-z0-9_]*/[A-Z][A-Za-z0-9]*)(?:\[\])? "
    r"[a-z](?:_?[a-z0-9]+)*"
)
CONSTANT = re.compile(r"uint(?:8|16) [A-Z](?:_?[A-Z0-9]+)*=\d+")


class Package(unittest.TestCase):
    def test_the_messages_are_those_of_dermis(self):
        ours = {path.name: path.read_text() for path in MESSAGES.iterdir()}
        self.assertEqual({path.name: path.read_text() for path in (PACKAGE / "msg").iterdir()}, ours)
        self.assertGreater(len(ours), 5)

    def test_every_line_is_one_of_ros(self):
        for path in MESSAGES.iterdir():
            self.assertRegex(path.name, r"^[A-Z][A-Za-z0-9]*\.msg$")
            for line in path.read_text().splitlines():
                line = line.split("#")[0].strip()
                self.assertTrue(not line or FIELD.fullmatch(line) or CONSTANT.fullmatch(line), f"{path.name}: {line}")

    def test_names_differ_from_one_another_in_more_than_case(self):
        for path in MESSAGES.iterdir():
            lines = [line.split("#")[0].split() for line in path.read_text().splitlines()]
            names = [path.stem, *(words[1].split("=")[0] for words in lines if words)]
            self.assertEqual(len({name.lower() for name in names}), len(names), f"{path.name}: {names}")

    @unittest.skipUnless(shutil.which("idlc"), "idlc is not installed")
    def test_a_compiler_of_idl_that_ignores_case_takes_the_messages(self):
        folders = [MESSAGES, *(MESSAGES.parent / name for name in ("builtin_interfaces", "geometry_msgs", "std_msgs"))]
        every = {f"{folder.name}/{path.stem}": path.read_text() for folder in folders for path in folder.glob("*.msg")}
        idl = "".join(cyclone_types.idl(name, every[name]) for name in cyclone_types.in_order(every))
        # The names of ROS again, where those of DDS end in '_'.
        idl = re.sub(r"(?<=\w)_(?!\w)", "", idl.replace("_value;", ";"))
        self.assertIn("struct Contacts {", idl)
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "ros.idl").write_text(idl)
            compiled = subprocess.run(["idlc", "-l", "c", "ros.idl"], cwd=folder, capture_output=True, text=True)
        self.assertEqual(compiled.returncode, 0, compiled.stderr)

    def test_the_package_depends_on_what_its_messages_use(self):
        used = {
            package for path in MESSAGES.iterdir() for package in re.findall(r"^(\w+)/", path.read_text(), re.MULTILINE)
        }
        used.discard("dermis_msgs")
        package = ElementTree.parse(PACKAGE / "package.xml").getroot()
        self.assertEqual({element.text for element in package.iter("depend")}, used)
        cmake = (PACKAGE / "CMakeLists.txt").read_text()
        self.assertEqual(set(re.search(r"DEPENDENCIES ([^)]*)\)", cmake)[1].split()), used)
        self.assertLessEqual(used, set(re.findall(r"find_package\((\w+) REQUIRED\)", cmake)))

    def test_the_version_is_that_of_dermis(self):
        version = re.search(r"project\(dermis VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertEqual(ElementTree.parse(PACKAGE / "package.xml").getroot().findtext("version"), version)


class Launch(unittest.TestCase):
    """With stand-ins for the modules of ROS, which is not here."""

    def test_the_launch_file_starts_the_server_for_ros(self):
        started = []
        stand_ins = {
            "launch": {"LaunchDescription": list},
            "launch.actions": {
                "DeclareLaunchArgument": lambda name, **_: name,
                "ExecuteProcess": lambda cmd, **_: started.append(cmd),
            },
            "launch.conditions": {"IfCondition": str},
            "launch.substitutions": {"LaunchConfiguration": lambda name: f"<{name}>"},
        }
        for name, members in stand_ins.items():
            sys.modules[name] = types.ModuleType(name)
            vars(sys.modules[name]).update(members)
            self.addCleanup(sys.modules.pop, name)
        described = runpy.run_path(str(ROOT / "examples/ros/suit.launch.py"))["generate_launch_description"]()
        self.assertEqual(described[:3], ["suit", "port", "rviz"])
        self.assertEqual(started[0], ["dermis", "serve", "--suit", "<suit>", "--port", "<port>", "--dds"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
