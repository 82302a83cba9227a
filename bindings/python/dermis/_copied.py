# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Models and pipelines can be copied and pickled: to other processes, too."""

import copyreg
import os
import tempfile

from dermis import _dermis  # type: ignore[attr-defined]  # it has no stub


def _bytes_of(model):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "model")
        model.write(path)
        with open(path, "rb") as file:
            return file.read()


def _model_from(data):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "model")
        with open(path, "wb") as file:
            file.write(data)
        return _dermis.read_model(path)


def _reduced(self, protocol):
    """By protocols 0 and 1 Python makes an object of pybind11's own class, for which pybind11 ends the process."""
    return object.__reduce_ex__(self, max(protocol, 2))


def copy_well():
    """A pipeline is made anew of its model: its copy has not been tared and remembers nothing."""
    for kind in vars(_dermis).values():
        if isinstance(kind, type):
            kind.__reduce_ex__ = _reduced
    copyreg.pickle(_dermis.Model, lambda model: (_model_from, (_bytes_of(model),)))
    copyreg.pickle(_dermis.Pipeline, lambda pipeline: (_dermis.Pipeline, (pipeline.model,)))
