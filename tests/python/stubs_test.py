# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The stubs say what is there: mypy holds them to the module, and the examples to the stubs."""

import ast
import re
import subprocess
import sys
import unittest
from pathlib import Path

import dermis

ROOT = Path(__file__).parents[2]


class Stubs(unittest.TestCase):
    def run_mypy(self, *arguments):
        run = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    def test_every_name_is_in_the_stubs_and_in_the_module(self):
        self.run_mypy("mypy.stubtest", "dermis", "--allowlist", str(Path(__file__).with_name("stubtest_allowed.txt")))

    def test_examples_agree_with_the_stubs(self):
        self.run_mypy(
            "mypy", "--strict", "--ignore-missing-imports", *map(str, sorted((ROOT / "examples/python").glob("*.py")))
        )

    def test_defaults_of_the_stubs_are_those_of_the_library(self):
        compared = 0
        for function, owner in functions(ast.parse((ROOT / "bindings/python/dermis/__init__.pyi").read_text())):
            bound = getattr(getattr(dermis, owner) if owner else dermis, function.name)
            defaults = [
                *zip(function.args.args[::-1], function.args.defaults[::-1]),
                *zip(function.args.kwonlyargs, function.args.kw_defaults),
            ]
            for argument, default in defaults:
                if default is None or not isinstance(bound.__doc__, str) or "->" not in bound.__doc__:
                    continue
                said = re.findall(rf"\b{argument.arg}: [^=]+? = ([^,)]+)", bound.__doc__)
                self.assertIn(
                    ast.literal_eval(default), [ast.literal_eval(value) for value in said], f"{owner} {function.name}"
                )
                compared += 1
        self.assertGreater(compared, 20)


def functions(module):
    """Each function of the stub with the name of its class."""
    for node in module.body:
        if isinstance(node, ast.FunctionDef):
            yield node, None
        elif isinstance(node, ast.ClassDef):
            yield from ((member, node.name) for member in node.body if isinstance(member, ast.FunctionDef))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
