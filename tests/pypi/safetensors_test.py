# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The package safetensors of PyPI reads a model file. Usage: safetensors_test.py MODEL"""

import json
import subprocess
import sys
import unittest
from pathlib import Path

from safetensors import safe_open

READER = Path(__file__).resolve().parent.parent / "bytes/files/read_safetensors.py"
MODEL = sys.argv.pop()
NAMES = {"float32": "F32", "float64": "F64", "uint8": "U8", "int64": "I64"}


class ModelFile(unittest.TestCase):
    def test_every_tensor_is_read_as_our_own_reader_reads_it(self):
        expected = json.loads(subprocess.run([sys.executable, READER, MODEL], check=True, capture_output=True).stdout)
        with safe_open(MODEL, "numpy") as model:
            tensors = {name: model.get_tensor(name) for name in model.keys()}  # noqa: SIM118  no dict
            self.assertEqual(model.metadata(), expected["metadata"])
        self.assertGreater(len(tensors), 10)
        self.assertEqual(
            {
                name: {
                    "dtype": NAMES[str(values.dtype)],
                    "shape": list(values.shape),
                    "values": values.ravel().tolist(),
                }
                for name, values in tensors.items()
            },
            expected["tensors"],
        )


if __name__ == "__main__":
    unittest.main()
