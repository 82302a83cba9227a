# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Readout circuits: conductances to readings, and back (docs/circuit-drawings.md)."""

from dermis import _dermis


class Inversion:
    """siemens (rows, cols): conductances [S]; solved: the readings have a solution; residual_ratio: its certificate."""

    __slots__ = ("siemens", "solved", "residual_ratio")

    def __init__(self, siemens, solved, residual_ratio):
        self.siemens, self.solved, self.residual_ratio = siemens, solved, residual_ratio


def forward(array, siemens):
    """Readings over the supply (rows, cols) that the circuit gives for conductances (rows, cols) [S]."""
    return _dermis.circuit_forward(array, siemens)


def invert(array, ratio):
    """The Inversion of readings over the supply (rows, cols)."""
    return Inversion(*_dermis.circuit_invert(array, ratio))
