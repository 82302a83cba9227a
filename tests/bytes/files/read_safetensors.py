# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Reads a safetensors file with nothing but the standard library and prints it as JSON: an independent reader."""

import array
import json
import struct
import sys

TYPES = {"F32": "f", "F64": "d", "U8": "B", "I64": "q"}

with open(sys.argv[1], "rb") as file:
    content = file.read()
(length,) = struct.unpack("<Q", content[:8])
header = json.loads(content[8 : 8 + length])
data = content[8 + length :]
result = {"metadata": header.pop("__metadata__", {}), "tensors": {}}
for name, entry in header.items():
    begin, end = entry["data_offsets"]
    values = array.array(TYPES[entry["dtype"]])
    assert (8 + length + begin) % values.itemsize == 0, f"{name} is not aligned"
    values.frombytes(data[begin:end])
    result["tensors"][name] = {"dtype": entry["dtype"], "shape": entry["shape"], "values": values.tolist()}
print(json.dumps(result, sort_keys=True, separators=(",", ":")))
