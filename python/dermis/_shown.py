# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""How objects show themselves: one line for repr(), a heat map in notebooks."""

import numpy

from dermis import FrameStatus, _dermis  # type: ignore[attr-defined]  # _dermis has no stub


def _size(array):
    return f"{array.rows}x{array.cols}"


def _frames(many):
    rows, cols = many.shape[1:]
    return f"{len(many)} frames of {rows}x{cols}"


def _span(time_ns):
    return f"{(time_ns[-1] - time_ns[0]) * 1e-9:.3f} s" if len(time_ns) else "0 s"


def _of_recording(recording):
    name = f" '{recording.name}'" if recording.name else ""
    return f"<dermis.Recording{name}, {_frames(recording.counts)}, {_span(recording.time_ns)}>"


def _of_raw(raw):
    rows, cols = raw.counts.shape
    return f"<dermis.RawFrame {rows}x{cols}, {_extremes(raw.counts)} counts, at {raw.time_ns * 1e-9:.3f} s>"


def _extremes(values):
    there = values[numpy.isfinite(values)]
    return f"{there.min():.4g} to {there.max():.4g}" if there.size else "no"


def _of_force(force):
    rows, cols = force.newtons.shape
    status = force.status.name or force.status
    return f"<dermis.ForceFrame {rows}x{cols}, {force.total:.3g} \u00b1 {force.total_sigma:.2g} N, {status}>"


def _of_forces(forces):
    there = forces.total[numpy.isfinite(forces.total)]
    most = f"total at most {there.max():.3g} N" if there.size else "no force"
    rejected = numpy.count_nonzero(forces.status & FrameStatus.REJECTED)
    loss = f", {rejected} rejected" if rejected else ""
    return f"<dermis.Forces, {_frames(forces.newtons)}, {_span(forces.time_ns)}, {most}{loss}>"


def _of_source(source):
    size = "{}x{}".format(*source.shape) if source.shape else "size not known yet"
    return f"<dermis.Source '{source.uri}' {size}{', live' if source.is_live else ''}>"


def _of_load(load):
    first_row, first_col, last_row, last_col = load.where
    where = f"r{first_row}c{first_col}" + (f":r{last_row}c{last_col}" if load.where[:2] != load.where[2:] else "")
    value = f"{load.newtons:g} N" if load.newtons is not None else f"{load.pascals:g} Pa"
    return f"<dermis.Load {value} on {where} in frame {load.frame}>"


def _of_report(report):
    return (
        f"<dermis.CalibrationReport of {report.frames} frames, {report.lightest_newtons:.3g} to "
        f"{report.heaviest_newtons:.3g} N, fit {report.median_fit_error:.2%}>"
    )


def _counts_png(self):
    return _dermis.picture(self.counts, "counts", f"{self.time_ns * 1e-9:.3f} s", "counts")


def _force_png(self):
    return _dermis.picture(self.newtons, "forces", f"{self.time_ns * 1e-9:.3f} s, total {self.total:.3g} N", "N")


def _forces_png(self):
    """The strongest frame."""
    if not numpy.isfinite(self.total).any():
        return None
    k = int(numpy.nanargmax(self.total))
    total = f"frame {k} of {len(self)}, total {self.total[k]:.3g} N, the most"
    return _dermis.picture(self.newtons[k], "forces", total, "N")


def show_well():
    """Gives the classes of the module their __repr__ and pictures."""
    lines = {
        _dermis.Recording: _of_recording,
        _dermis.RawFrame: _of_raw,
        _dermis.ForceFrame: _of_force,
        _dermis.Forces: _of_forces,
        _dermis.Source: _of_source,
        _dermis.Load: _of_load,
        _dermis.CalibrationReport: _of_report,
        _dermis.Pipeline: lambda pipeline: (
            f"<dermis.Pipeline of '{pipeline.model.array.name}' {_size(pipeline.model.array)}>"
        ),
        _dermis.Server: lambda server: f"<dermis.Server at {server.url}>",
    }
    for kind, line in lines.items():
        kind.__repr__ = line
    for kind, picture in (
        (_dermis.RawFrame, _counts_png),
        (_dermis.ForceFrame, _force_png),
        (_dermis.Forces, _forces_png),
    ):
        kind._repr_png_ = picture
