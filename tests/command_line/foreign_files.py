# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Files of other systems, made as their programs write them: all hold the same frames."""

import bz2
import struct
import zlib

import numpy

ROWS, COLS, FRAMES, RATE = 4, 5, 60, 50.0


def counts():
    """A weight of 3x3 taxels, whole numbers of kilopascals, that comes after a third of the frames."""
    frames = numpy.zeros((FRAMES, ROWS, COLS))
    frames[FRAMES // 3 :, 0:3, 1:4] = [[20, 30, 20], [30, 50, 30], [20, 30, 20]]
    return frames


def lines(frame, separator=","):
    return "".join(separator.join(f"{value:g}" for value in row) + "\n" for row in frame)


def text_matrix(path):
    path.write_text("\n".join(lines(frame, "\t") for frame in counts()))


def tekscan(path):
    head = f"DATA_TYPE MOVIE\nROWS {ROWS}\nCOLS {COLS}\nSECONDS_PER_FRAME {1 / RATE}\nUNITS kPa\nASCII_DATA @@\n\n"
    path.write_text(head + "\n".join(f"Frame {k}\n{lines(frame)}" for k, frame in enumerate(counts())) + "@@\n")


def xsensor(path):
    text = '"File:","C:\\\\a,b.XSN"\n"Units:","kPa"\n\n'
    for k, frame in enumerate(counts()):
        text += f'"FRAME","{k}"\n"Time","{k / RATE}"\n"SENSOR","mat"\n"Rows","{ROWS}"\n"Columns","{COLS}"\n"SENSELS"\n'
        text += lines(frame) + "\n"
    path.write_text(text)


def novel(path):
    text = f"Time per picture:  {1000 / RATE:.2f} [ms]\n"
    for k, frame in enumerate(counts()):
        text += f"Page {k}\nPict-No.: {k}\n\n\t" + "\t".join(str(c + 1) for c in range(COLS)) + "\tForce\n"
        text += "".join(f"{r + 1}\t" + "\t".join(f"{v:.1f}" for v in row) + "\t0\n" for r, row in enumerate(frame))
        text += "Force\t0\n\n\x0c\n"
    path.write_text(text)


def dsa(path):
    def number(value):
        return struct.pack(">f", value).hex().upper()

    text = f"<root><sensor><matrix><cells_x>{COLS}</cells_x><cells_y>{ROWS}</cells_y></matrix></sensor><data>"
    for k, frame in enumerate(counts()):
        code = "".join(number(value) if value else number(-1) for value in frame.flat)
        text += f"<frame><time_stamp>{round(1000 * k / RATE)}</time_stamp><frame_data>{code}</frame_data></frame>"
    path.write_bytes(bz2.compress((text + "</data></root>").encode()))


def png(path):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    path.mkdir()
    for k, frame in enumerate(counts()):
        raw = b"".join(b"\0" + bytes(int(value) for value in row) for row in frame)
        header = struct.pack(">IIBBBBB", COLS, ROWS, 8, 0, 0, 0, 0)
        (path / f"{k}.png").write_bytes(
            b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")
        )


def packed10(path):
    bits = "".join(f"{int(value):010b}" for frame in counts() for value in frame.flat)  # 20 readings: 25 bytes
    path.write_bytes(int(bits, 2).to_bytes(len(bits) // 8, "big"))


def matlab(path):
    """Version 5, as MATLAB compresses it; the second size counts the frames."""

    def element(kind, content):
        return struct.pack("<II", kind, len(content)) + content + bytes(-len(content) % 8)

    def variable(name, array):
        sizes = struct.pack(f"<{array.ndim}i", *array.shape)
        flags = struct.pack("<II", 6, 0)
        matrix = element(6, flags) + element(5, sizes) + element(1, name) + element(9, array.tobytes(order="F"))
        packed = zlib.compress(struct.pack("<II", 14, len(matrix)) + matrix)
        return struct.pack("<II", 15, len(packed)) + packed

    header = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"
    rate = numpy.full((1, 1), RATE)
    path.write_bytes(header + variable(b"data", counts().transpose(1, 0, 2)) + variable(b"fs", rate))


TIMED = {
    "a.asf": tekscan,
    "tekscan.csv": tekscan,
    "xsensor.csv": xsensor,
    "a.lst": novel,
    "a.dsa": dsa,
    "a.mat": matlab,
}
UNTIMED = {
    "a.txt": text_matrix,
    "matrix.csv": text_matrix,
    "pictures": png,
    "a.packed10": packed10,
    "a.npz": lambda path: numpy.savez_compressed(path, counts()),
    "b.npz": lambda path: numpy.savez(path, counts().astype(numpy.uint8)),
}
ALL = TIMED | UNTIMED
