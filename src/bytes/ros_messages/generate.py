# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Usage: generate.py MSG_FOLDER OUT.cpp

Writes the types of messages (ros_messages.hpp, live_messages.hpp) from their .msg files, and the assertions that the
enumerations of C++ are those of the files.
"""

import hashlib
import json
import pathlib
import re
import sys

FUNCTIONS = {
    "image_type": "sensor_msgs/Image",
    "temperature_type": "sensor_msgs/Temperature",
    "grid_type": "foxglove_msgs/Grid",
    "acquisition_type": "dermis_msgs/Acquisition",
    "frame_status_type": "dermis_msgs/FrameStatus",
    "raw_frame_type": "dermis_msgs/RawFrame",
    "point_cloud_type": "sensor_msgs/PointCloud2",
    "contacts_type": "dermis_msgs/Contacts",
    "statistics_type": "dermis_msgs/Statistics",
    "calibration_state_type": "dermis_msgs/CalibrationState",
    "diagnostics_type": "diagnostic_msgs/DiagnosticArray",
    "transforms_type": "tf2_msgs/TFMessage",
    "classification_type": "vision_msgs/Classification",
    "threat_type": "dermis_msgs/Threat",
    "mark_type": "dermis_msgs/Mark",
    "wrench_type": "geometry_msgs/WrenchStamped",
}

# Whose constants are the enumerators, in lower case.
ENUMERATIONS = {
    "dermis_msgs/CalibrationHint": "CalibrationState::Hint",
    "dermis_msgs/CalibrationState": "CalibrationState::Stage",
    "dermis_msgs/Contact": "ContactPhase",
    "dermis_msgs/FrameStatus": "FrameStatus",
    "dermis_msgs/TaxelStatus": "TaxelStatus",
    "dermis_msgs/Threat": "Threat::State",
    "diagnostic_msgs/DiagnosticStatus": "Diagnosis::Level",
    "foxglove_msgs/PackedElementField": "PackedElementType",
    "sensor_msgs/PointField": "PointFieldType",
}
SPELLED_OUT = {"warn": "warning"}
UNNAMED = {"FrameStatus": ["FrameStatus::ok"]}  # no flag

CONSTANT = re.compile(r"^(?:uint8|uint16|byte) ([A-Z]\w*)=(\d+)", re.MULTILINE)
MEMBER_TYPE = re.compile(r"^(\w+/\w+)", re.MULTILINE)
MEMBER = re.compile(r"^([\w/]+)(\[\])? (\w+)(?: *#.*)?$", re.MULTILINE)

# Values of type_description_interfaces/FieldType, from which type hashes are made.
NESTED_TYPE = 1
TYPE_IDS = {
    "int8": 2,
    "uint8": 3,
    "int16": 4,
    "uint16": 5,
    "int32": 6,
    "uint32": 7,
    "int64": 8,
    "uint64": 9,
    "float32": 10,
    "float64": 11,
    "bool": 15,
    "byte": 16,
    "string": 17,
}
SEQUENCE = 144  # more than the type of its elements


def with_dependencies(name, texts):
    """The names of the type and of all that it is made of: depth first, types of ROS before ours."""
    found = []

    def visit(used):
        if used in found:
            return
        found.append(used)
        for member in MEMBER_TYPE.findall(texts[used]):
            visit(member)

    visit(name)
    return found[:1] + sorted(found[1:], key=lambda used: used.startswith("dermis_msgs/"))


def definition(name, texts):
    first, *others = with_dependencies(name, texts)
    return texts[first] + "".join(f"{'=' * 80}\nMSG: {other}\n{texts[other]}" for other in others)


def full_name(message):
    return message.replace("/", "/msg/")


def described(message, texts):
    """The type as ROS 2 describes it for its hash."""
    fields = []
    for used, sequence, name in MEMBER.findall(texts[message]):
        type_id = TYPE_IDS.get(used, NESTED_TYPE) + (SEQUENCE if sequence else 0)
        nested = full_name(used) if used not in TYPE_IDS else ""
        fields.append(
            {
                "name": name,
                "type": {"type_id": type_id, "capacity": 0, "string_capacity": 0, "nested_type_name": nested},
            }
        )
    return {"type_name": full_name(message), "fields": fields}


def type_hash(message, texts):
    """RIHS01 of REP 2016."""
    others = sorted(with_dependencies(message, texts)[1:], key=full_name)
    description = {
        "type_description": described(message, texts),
        "referenced_type_descriptions": [described(other, texts) for other in others],
    }
    return "RIHS01_" + hashlib.sha256(json.dumps(description).encode()).hexdigest()


def function(name, message, texts):
    return f"""const MessageType& {name}() {{
  static const MessageType kType{{"{full_name(message)}", R"({definition(message, texts)})",
                                 "{type_hash(message, texts)}"}};
  return kType;
}}
"""


def assertions(message, enumeration, texts):
    """The values are the same, and (by -Wswitch) no enumerator lacks its constant."""
    constants = [(name.lower(), value) for name, value in CONSTANT.findall(texts[message])]
    enumerators = [(f"{enumeration}::{SPELLED_OUT.get(name, name)}", value) for name, value in constants]
    cases = [name for name, _ in enumerators] + UNNAMED.get(enumeration, [])
    return "\n".join(
        [
            f"// {message}.msg",
            *(f"static_assert({name} == {enumeration}{{{value}}});" for name, value in enumerators),
            f"[[maybe_unused]] constexpr void assert_all_are_there({enumeration} value) {{",
            "  switch (value) {",
            *(f"    case {case}:" for case in cases),
            "      break;",
            "  }",
            "}",
            "",
        ]
    )


def source(texts):
    parts = [assertions(*item, texts) for item in ENUMERATIONS.items()]
    functions = [function(*item, texts) for item in FUNCTIONS.items()]
    return f"""// Written by src/bytes/ros_messages/generate.py.
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "bytes/ros_messages/grid.hpp"
#include "bytes/ros_messages/point_field.hpp"

namespace dermis::bytes::ros_messages {{
namespace {{

{chr(10).join(parts)}
}}  // namespace

{chr(10).join(functions)}
}}  // namespace dermis::bytes::ros_messages
"""


if __name__ == "__main__":
    folder, out = map(pathlib.Path, sys.argv[1:])
    files = {path.relative_to(folder).with_suffix("").as_posix(): path.read_text() for path in folder.glob("*/*.msg")}
    out.write_text(source(files))
