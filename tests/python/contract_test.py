# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""One contract: Python, C and the messages have the names, units and defaults of the C++ headers."""

import ast
import inspect
import re
import sys
import unittest
from pathlib import Path

import dermis

ROOT = Path(__file__).parents[2]
INCLUDE = ROOT / "include/dermis"
C_HEADER = (ROOT / "bindings/c/dermis.h").read_text()
STUB = ast.parse((ROOT / "bindings/python/dermis/__init__.pyi").read_text())


def block(text, opening):
    """What stands between the braces behind `opening`."""
    found = re.search(rf"{opening}[^{{;]*\{{(?:([^\n]*)\}}|(.*?)\n\}})", text, re.DOTALL)
    return found[1] or found[2]


def cpp_struct(header, name):
    """The fields: name, type, default, and the units that its comment gives."""
    text = block((INCLUDE / header).read_text(), rf"struct {name}\b")
    fields = re.findall(
        r"^  ([\w:<>, ]+?) (\w+)(?:\{\}| = ([^;]+)|);(?: *///<([^\n]*(?:\n +///<[^\n]*)*))?", text, re.MULTILINE
    )
    return {field: (kind, default, re.findall(r"\[([\w/ ]+)\]", comment)) for kind, field, default, comment in fields}


def cpp_enumerators(header, name):
    """In their order, with the values that are given; shifts are calculated."""
    values, last = {}, -1
    for enumerator, value in re.findall(
        r"(\w+)(?: = ([^,\n]+))?,?(?= |\n|$)",
        re.sub(r"///.*", "", block((INCLUDE / header).read_text(), rf"enum class {name} : std::uint\d+_t")),
    ):
        last = eval(value.replace("U", "")) if value else last + 1
        values[enumerator.upper()] = last
    return values


def c_enumerators(prefix):
    return {name: int(value) for name, value in re.findall(rf"\bDERMIS_{prefix}(\w+) = (\d+)", C_HEADER)}


def c_struct(name):
    text = re.sub(r"/\*.*?\*/", "", block(C_HEADER, f"typedef struct {name}"), flags=re.DOTALL)
    return [
        field
        for line in re.findall(r"^ +(?:const )?\w+\*? ([\w, ]+);", text, re.MULTILINE)
        for field in line.split(", ")
    ]


def message(name):
    text = (ROOT / f"src/bytes/ros_messages/msg/dermis_msgs/{name}.msg").read_text()
    constants = {
        constant: int(value) for constant, value in re.findall(r"^uint\d+ ([A-Z_]+)=(\d+)", text, re.MULTILINE)
    }
    return constants, re.findall(r"^[\w/]+(?:\[\])? ([a-z]\w*)", text, re.MULTILINE), text


def python_properties(name):
    [node] = [node for node in STUB.body if isinstance(node, ast.ClassDef) and node.name == name]
    return [
        member.name
        for member in node.body
        if isinstance(member, ast.FunctionDef)
        and any(getattr(decorator, "id", "") == "property" for decorator in member.decorator_list)
    ]


def python_defaults(name, owner=None):
    body = next(node for node in STUB.body if getattr(node, "name", "") == owner).body if owner else STUB.body
    [function] = [node for node in body if isinstance(node, ast.FunctionDef) and node.name == name]
    return {
        argument.arg: ast.literal_eval(default)
        for argument, default in zip(function.args.kwonlyargs, function.args.kw_defaults)
        if default is not None
    }


class Enumerations(unittest.TestCase):
    def test_the_status_of_a_taxel(self):
        expected = cpp_enumerators("touch/frames/frames.hpp", "TaxelStatus")
        self.assertEqual(len(expected), 6)
        self.assertEqual({member.name: member.value for member in dermis.TaxelStatus}, expected)
        self.assertEqual(c_enumerators("TAXEL_"), expected)
        self.assertEqual(message("TaxelStatus")[0], expected)

    def test_the_status_of_a_frame(self):
        expected = cpp_enumerators("touch/frames/frames.hpp", "FrameStatus")
        self.assertEqual(expected.pop("OK"), 0)
        self.assertEqual(len(expected), 11)
        self.assertEqual({member.name: member.value for member in dermis.FrameStatus if member}, expected)
        self.assertEqual(dermis.FrameStatus.OK, 0)
        self.assertEqual(c_enumerators("FRAME_"), expected)
        self.assertEqual(message("FrameStatus")[0], expected)

    def test_the_phase_of_a_contact(self):
        expected = cpp_enumerators("touch/frames/contacts.hpp", "ContactPhase")
        self.assertEqual(expected, {"ONSET": 0, "HELD": 1, "RELEASE": 2})
        self.assertEqual({name: c_enumerators("")[name] for name in expected}, expected)
        self.assertEqual(message("Contact")[0], expected)


class Fields(unittest.TestCase):
    """Names outside C++ end in the unit where the type of C++ or its comment says it."""

    def named(self, fields):
        """As Python names them."""
        names = []
        for field, (kind, _, units) in fields.items():
            unit = "ns" if kind in ("Nanos", "std::optional<Nanos>") else ""
            if kind == "PlaneVector":
                [unit] = [unit.replace("/", "_") for unit in units]
            names.append(field if not unit or field.endswith(f"_{unit}") else f"{field}_{unit}")
        return names

    def test_a_contact(self):
        fields = cpp_struct("touch/frames/contacts.hpp", "Contact")
        names = self.named(fields)
        self.assertEqual(len(names), 15)
        self.assertEqual(python_properties("Contact"), names)
        flat = []
        for name in names:
            for axis in (
                "xy" if fields.get(name, fields.get(re.sub(r"_m(_s)?$", "", name), [""]))[0] == "PlaneVector" else [""]
            ):
                flat.append(name.replace("position", axis).replace("velocity", f"velocity_{axis}") if axis else name)
        in_c = c_struct("dermis_contact")
        self.assertEqual(in_c, [name for name in flat if name in in_c])
        self.assertGreaterEqual(len(in_c), 13)
        flat[flat.index("onset_ns")] = "onset_time"  # ONSET is a phase
        in_message = [re.sub(r"^((?:sigma_|velocity_)?[xy])_m(_s)?$", r"\1", name) for name in flat]
        self.assertEqual(message("Contact")[1], [*in_message, "position", "normal", "velocity"])

    def test_units_of_a_message_stand_beside_its_fields(self):
        text = message("Contact")[2]
        self.assertRegex(text, r"float64 x +# .*metres")
        self.assertRegex(text, r"float64 velocity_x +# metres per second")

    def test_a_frame_of_counts(self):
        names = self.named(
            {
                name: field
                for name, field in cpp_struct("touch/frames/frames.hpp", "RawFrame").items()
                if name not in ("acquisition", "sensor_celsius")  # C has one temperature
            }
        )
        self.assertEqual(names, ["time_ns", "temperature_celsius", "supply_v", "counts"])
        self.assertEqual(python_properties("RawFrame")[:4], names)
        self.assertEqual(c_struct("dermis_raw_frame"), [*names, "count"])

    def test_a_frame_of_forces(self):
        names = self.named(
            {
                name: field
                for name, field in cpp_struct("touch/frames/frames.hpp", "ForceFrame").items()
                if name != "sums"
            }
        )
        self.assertEqual(len(names), 6)
        self.assertEqual(sorted(python_properties("ForceFrame")), sorted([*names, "total", "total_sigma"]))
        self.assertEqual(sorted(c_struct("dermis_force_frame")), sorted([*names, "count"]))

    def test_a_sum_of_forces(self):
        self.assertEqual(c_struct("dermis_total"), list(cpp_struct("touch/frames/force_sums.hpp", "TotalForce")))

    def test_how_a_frame_was_acquired(self):
        fields = cpp_struct("touch/frames/frames.hpp", "Acquisition") | {
            name: field
            for name, field in cpp_struct("touch/frames/frames.hpp", "RawFrame").items()
            if name in ("time", "supply_v")
        }
        expected = set()
        for field, name in zip(fields, self.named(fields)):
            expected |= {name, f"has_{field}"} if fields[field][0].startswith("std::optional") else {name}
        # Compilers of IDL know `sequence` as a word of their own.
        expected = {re.sub(r"\bsequence|(?<=has_)sequence", "sequence_number", name) for name in expected}
        self.assertEqual(set(message("Acquisition")[1]), expected)


class Defaults(unittest.TestCase):
    def expect(self, found, header, struct, names=None):
        fields = cpp_struct(header, struct)
        defaults = {
            name: ast.literal_eval(default)
            for name, (_, default, _) in fields.items()
            if default and (names is None or name in names)
        }
        self.assertEqual(found, defaults)

    def test_of_contacts(self):
        self.expect(
            python_defaults("__init__", "ContactTracker"), "touch/contacts/contact_tracker.hpp", "ContactOptions"
        )

    def test_of_a_server(self):
        found = {name: value for name, value in python_defaults("serve").items() if value is not None}
        self.expect(
            {name: found[name] for name in ("host", "port")},
            "out/websocket/server.hpp",
            "ServerOptions",
            ("host", "port"),
        )
        self.assertEqual(found["token"], "")

    def test_the_stub_has_the_arguments_of_the_module(self):
        for name in python_defaults("serve"):
            self.assertIn(f"{name}:", inspect.getdoc(dermis.serve))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
