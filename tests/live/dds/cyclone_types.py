# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""cyclone_types.py MSG_FOLDER... OUT: what Cyclone DDS knows of the messages, from their .msg files alone.

OUT/ros.idl is for its IDL compiler; OUT/print_ros.h prints what comes as JSON, arrays of bytes as text in hex."""

import re
import sys
from pathlib import Path

IDL = {
    "bool": "boolean",
    "byte": "octet",
    "uint8": "octet",
    "uint16": "unsigned short",
    "uint32": "unsigned long",
    "uint64": "unsigned long long",
    "int32": "long",
    "int64": "long long",
    "float32": "float",
    "float64": "double",
    "string": "string",
}
PRINT = {
    "string": "print_text",
    "float32": "print_number",
    "float64": "print_number",
    "bool": "print_bool",
    "uint64": "print_unsigned",
}
FIELD = re.compile(r"^([\w/]+)(\[\])? (\w+)\s*(?:#.*)?$", re.MULTILINE)


def dds_name(message, separator):
    package, name = message.split("/")
    return separator.join([package, "msg", "dds_", name + "_"])


def in_order(texts):
    """Each after those that it is made of."""
    found = []

    def visit(message):
        if message in found:
            return
        for used, _, _ in FIELD.findall(texts[message]):
            if "/" in used:
                visit(used)
        found.append(message)

    for message in sorted(texts):
        visit(message)
    return [message for message in found if FIELD.search(texts[message])]


def idl(message, text):
    """Fields have other names than in ROS: for IDL, `contacts_` is `Contacts_`. Names are not on the wire."""
    package, name = message.split("/")
    fields = ""
    for used, sequence, field in FIELD.findall(text):
        kind = IDL.get(used) or dds_name(used, "::")
        fields += f"      {f'sequence<{kind}>' if sequence else kind} {field}_value;\n"
    struct = f"    @final struct {name}_ {{\n{fields}    }};\n"
    return f"module {package} {{ module msg {{ module dds_ {{\n{struct}}}; }}; }};\n"


def c_printer(message, text):
    name = dds_name(message, "_")
    lines = []
    for k, (used, sequence, field) in enumerate(FIELD.findall(text)):
        print_one = PRINT.get(used, "print_integer") if "/" not in used else "print_" + dds_name(used, "_")
        by_address = "&" if "/" in used else ""
        lines.append(f'  fputs("{"," if k else ""}\\"{field}\\":", stdout);')
        if sequence and used in ("uint8", "byte"):
            lines.append(f"  print_bytes(value->{field}_value._buffer, value->{field}_value._length);")
        elif sequence:
            lines += [
                "  putchar('[');",
                f"  for (uint32_t i = 0; i < value->{field}_value._length; ++i) {{",
                "    if (i) putchar(',');",
                f"    {print_one}({by_address}value->{field}_value._buffer[i]);",
                "  }",
                "  putchar(']');",
            ]
        else:
            lines.append(f"  {print_one}({by_address}value->{field}_value);")
    body = "\n".join(lines)
    return (
        f"static void print_{name}(const void* of) {{\n  const {name}* const value = of;\n"
        f"  putchar('{{');\n{body}\n  putchar('}}');\n}}\n"
    )


if __name__ == "__main__":
    *folders, out = map(Path, sys.argv[1:])
    texts = {
        path.relative_to(folder).with_suffix("").as_posix(): path.read_text()
        for folder in folders
        for path in folder.glob("*/*.msg")
    }
    messages = in_order(texts)
    (out / "ros.idl").write_text("".join(idl(message, texts[message]) for message in messages))
    rows = "".join(
        f'    {{"{dds_name(message, "::")}", &{dds_name(message, "_")}_desc, print_{dds_name(message, "_")}}},\n'
        for message in messages
    )
    (out / "print_ros.h").write_text(
        "".join(c_printer(message, texts[message]) for message in messages)
        + f"static const struct type types[] = {{\n{rows}}};\n"
    )
