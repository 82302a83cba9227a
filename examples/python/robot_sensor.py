# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""dermis behind the interface that robot-learning frameworks expect of a sensor: connect(), read(), disconnect().

Usage: robot_sensor.py sim:contacts?rate=100 chest.safetensors
"""

import argparse

import numpy as np
from numpy.typing import NDArray

import dermis


class TactileSensor:
    """The newest forces of an array."""

    def __init__(self, uri: str, model_path: str) -> None:
        self.uri = uri
        self.model = dermis.read_model(model_path)
        self._source: dermis.Source | None = None

    @property
    def features(self) -> dict[str, tuple[int, int]]:
        return {"newtons": (self.model.array.rows, self.model.array.cols)}

    @property
    def is_connected(self) -> bool:
        return self._source is not None

    def connect(self) -> None:
        self._source = dermis.open(self.uri, self.model.array)
        self._pipeline = dermis.Pipeline(self.model)

    def read(self, timeout_s: float = 1.0) -> NDArray[np.float32]:
        """Newtons (rows, cols) of the newest frame."""
        raw = self._source.latest(timeout_s) if self._source else None
        if raw is None:
            raise ConnectionError(f"{self.uri} has ended or is not connected")
        return self._pipeline.process(raw).newtons

    def disconnect(self) -> None:
        if self._source is None:
            return
        self._source.close()
        self._source = None


def main(uri: str, model_path: str) -> None:
    sensor = TactileSensor(uri, model_path)
    sensor.connect()
    print(sensor.features, f"{np.nansum(sensor.read()):.2f} N")
    sensor.disconnect()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("uri", help="of a device or of the simulator")
    parser.add_argument("model", help="model file of dermis calibrate")
    options = parser.parse_args()
    main(options.uri, options.model)
