# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
import numpy as np
from numpy.typing import ArrayLike, NDArray

from dermis import ArrayDescription, _Path

class Inversion:
    """siemens (rows, cols): conductances [S]; solved: the readings have a solution in this circuit; residual_ratio: no
    reading differs from that of the circuit by more."""

    siemens: NDArray[np.float64]
    solved: bool
    residual_ratio: float
    def __init__(self, siemens: NDArray[np.float64], solved: bool, residual_ratio: float) -> None: ...

def forward(array: ArrayDescription | _Path, siemens: ArrayLike) -> NDArray[np.float64]:
    """Readings over the supply (rows, cols) for conductances (rows, cols) [S]."""

def invert(array: ArrayDescription | _Path, ratio: ArrayLike) -> Inversion:
    """Conductances of readings over the supply (rows, cols)."""
