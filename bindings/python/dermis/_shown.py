# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""How objects show themselves: one line for repr(), a heat map in notebooks, as a picture and as HTML."""

from html import escape

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


_PIXELS = 240  # of the longer side of a map
_MOST_TAXELS = 4096  # more would be a page of a megabyte
# Red, green and blue of nothing, half and the most, between which a taxel stands.
_COLOURS = numpy.array([[13, 17, 48], [188, 55, 84], [252, 230, 150]])


def _colour(share):
    low = min(int(2 * share), 1)
    red, green, blue = _COLOURS[low] + (2 * share - low) * (_COLOURS[low + 1] - _COLOURS[low])
    return f"#{int(red):02x}{int(green):02x}{int(blue):02x}"


def _map_svg(values, unit):
    """A rectangle for each taxel, with its value as a title; grey where there is none."""
    rows, cols = values.shape
    if rows * cols > _MOST_TAXELS:
        return ""
    there = values[numpy.isfinite(values)]
    least, most = (float(there.min()), float(there.max())) if there.size else (0.0, 0.0)
    span = most - least or 1.0
    cells = "".join(
        f'<rect x="{col}" y="{row}" width="1" height="1" fill="{_colour((value - least) / span)}">'
        f"<title>r{row}c{col}: {value:.4g} {unit}</title></rect>"
        if numpy.isfinite(value)
        else f'<rect x="{col}" y="{row}" width="1" height="1" fill="#888"><title>r{row}c{col}</title></rect>'
        for row, line in enumerate(values.tolist())
        for col, value in enumerate(line)
    )
    scale = _PIXELS / max(rows, cols)
    caption = f"<figcaption>{least:.4g} to {most:.4g} {unit}</figcaption>" if there.size else ""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{cols * scale:.0f}" height="{rows * scale:.0f}" '
        f'viewBox="0 0 {cols} {rows}" shape-rendering="crispEdges">{cells}</svg>{caption}'
    )


def _html(line, values=None, unit=""):
    drawn = "" if values is None else _map_svg(numpy.asarray(values), unit)
    return f"<figure><code>{escape(line)}</code><br>{drawn}</figure>"


def _counts_html(self):
    return _html(repr(self), self.counts, "counts")


def _force_html(self):
    return _html(repr(self), self.newtons, "N")


def _recording_html(self):
    """The span of the counts of each taxel: where it was touched."""
    if not len(self.counts):
        return _html(repr(self))
    return _html(repr(self), numpy.ptp(self.counts, axis=0), "counts, greatest less least")


def _pipeline_html(self):
    """Its taxels: it keeps no frame."""
    array = self.model.array
    return _html(f"{self!r}, {array.circuit}", numpy.full((array.rows, array.cols), numpy.nan))


def show_well():
    """Gives the classes of the module their __repr__, pictures and HTML."""
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
        _dermis.Server: lambda server: f"<dermis.Server at {server.url.partition('?')[0]}>",
    }
    for kind, line in lines.items():
        kind.__repr__ = line
    for kind, picture in (
        (_dermis.RawFrame, _counts_png),
        (_dermis.ForceFrame, _force_png),
        (_dermis.Forces, _forces_png),
    ):
        kind._repr_png_ = picture
    for kind, page in (
        (_dermis.RawFrame, _counts_html),
        (_dermis.ForceFrame, _force_html),
        (_dermis.Recording, _recording_html),
        (_dermis.Pipeline, _pipeline_html),
    ):
        kind._repr_html_ = page
