# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""dermis behind the interface that robot-learning frameworks expect of a sensor: connect(), read(), disconnect().

    robot_sensor.py sim:contacts?rate=100 chest.safetensors
"""
import sys
import threading

import numpy as np
from numpy.typing import NDArray

import dermis


class TactileSensor:
    """The newest forces of an array, read in the background."""

    def __init__(self, uri: str, model_path: str) -> None:
        self.uri = uri
        self.model = dermis.read_model(model_path)
        self._newest: dermis.ForceFrame | None = None
        self._has_frame = threading.Event()
        self._source: dermis.Source | None = None

    @property
    def features(self) -> dict[str, tuple[int, int]]:
        return {"newtons": (self.model.array.rows, self.model.array.cols)}

    @property
    def is_connected(self) -> bool:
        return self._source is not None

    def connect(self) -> None:
        self._stop = False
        self._source = dermis.open(self.uri, self.model.array)
        self._reader = threading.Thread(target=self._read_all, args=(self._source,), daemon=True)
        self._reader.start()

    def _read_all(self, source: dermis.Source) -> None:
        pipeline = dermis.Pipeline(self.model)
        for raw in source:
            self._newest = pipeline.process(raw)
            self._has_frame.set()
            if self._stop:
                break

    def read(self, timeout_s: float = 1.0) -> NDArray[np.float32]:
        """Newtons (rows, cols) of the newest frame."""
        if not self._has_frame.wait(timeout_s) or self._newest is None:
            raise TimeoutError(f"no frame of {self.uri} within {timeout_s} s")
        return self._newest.newtons

    def disconnect(self) -> None:
        if self._source is None:
            return
        self._stop = True
        self._reader.join()
        self._source.close()
        self._source = None


def main(uri: str, model_path: str) -> None:
    sensor = TactileSensor(uri, model_path)
    sensor.connect()
    print(sensor.features, f"{np.nansum(sensor.read()):.2f} N")
    sensor.disconnect()


if __name__ == "__main__":
    main(*sys.argv[1:])
