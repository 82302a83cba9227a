# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The arrays of a suit.toml at work."""

from dermis import _dermis  # type: ignore[attr-defined]  # it has no stub


class SuitArray:
    """One array of a suit: its source, its model, and what they give."""

    __slots__ = ("name", "model", "source", "pipeline", "contacts")

    def __init__(self, name, model, source):
        self.name, self.model, self.source = name, model, source
        self.pipeline, self.contacts = _dermis.Pipeline(model), _dermis.ContactTracker(model)

    def latest(self, timeout_s=None):
        raw = self.source.latest(timeout_s)
        return None if raw is None else self.pipeline.process(raw)

    def __repr__(self):
        return f"<dermis.SuitArray '{self.name}' {self.model.array.rows}x{self.model.array.cols}>"


class Suit:
    """All arrays of a suit, by their names. Devices are read in the background."""

    def __init__(self, path, recording=None):
        self.arrays = {}
        models = {}
        try:
            for name, uri, model_path in _dermis.read_suit(path):
                if model_path not in models:
                    models[model_path] = _dermis.read_model(model_path)
                model = models[model_path]
                source = _dermis.open(uri if recording is None else f"{recording}#{name}", model.array)
                self.arrays[name] = SuitArray(name, model, source)
        except BaseException:
            self.close()
            raise

    def __getitem__(self, name):
        return self.arrays[name]

    def __iter__(self):
        return iter(self.arrays.values())

    def __len__(self):
        return len(self.arrays)

    def latest(self, timeout_s=None):
        forces = {array.name: array.latest(timeout_s) for array in self}
        return {name: force for name, force in forces.items() if force is not None}

    def tare(self, *, force=False):
        for array in self:
            array.pipeline.tare(force=force)

    def close(self):
        for array in self:
            array.source.close()

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.close()

    def __repr__(self):
        return f"<dermis.Suit of {', '.join(self.arrays)}>"
