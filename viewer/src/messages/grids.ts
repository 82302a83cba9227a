// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { CdrReader } from "./cdr_reader";

/** dermis_msgs/TaxelStatus.msg. */
export const TaxelStatus = { ok: 0, saturated: 1, aboveRange: 2, dead: 3, lineFault: 4, invalid: 5 } as const;

/** Values of all taxels, row-major. Read again and again into the same arrays. */
export interface CountsFrame {
  stampS: number;
  rows: number;
  cols: number;
  values: Float32Array<ArrayBuffer>;
}

export interface GridFrame extends CountsFrame {
  sigmas: Float32Array<ArrayBuffer>;
  statuses: Uint8Array<ArrayBuffer>;
}

const MOST_LINES = 1024;
const reader = new CdrReader();

export function emptyGrid(): GridFrame {
  return {
    stampS: 0,
    rows: 0,
    cols: 0,
    values: new Float32Array(0),
    sigmas: new Float32Array(0),
    statuses: new Uint8Array(0),
  };
}

function resize(frame: GridFrame, rows: number, cols: number): void {
  if (rows < 1 || cols < 1 || rows > MOST_LINES || cols > MOST_LINES) throw new RangeError(`${rows}x${cols} taxels`);
  frame.rows = rows;
  frame.cols = cols;
  if (frame.values.length === rows * cols) return;
  frame.values = new Float32Array(rows * cols);
  frame.sigmas = new Float32Array(rows * cols);
  frame.statuses = new Uint8Array(rows * cols);
}

/** The time of any message with a header. */
export function stampOf(message: DataView): number {
  return reader.begin(message).header();
}

/** sensor_msgs/msg/Image of counts: 16UC1 or 32FC1. */
export function readCounts(message: DataView, frame: GridFrame): void {
  frame.stampS = reader.begin(message).header();
  const rows = reader.uint32();
  const cols = reader.uint32();
  const isFloat = reader.textIs("32FC1");
  const littleEndian = !reader.bool();
  const step = reader.uint32();
  const length = reader.uint32();
  resize(frame, rows, cols);
  const begin = reader.position;
  if (length < step * rows) throw new RangeError("the image is shorter than its size says");
  for (let row = 0, index = 0; row < rows; ++row) {
    for (let col = 0; col < cols; ++col, ++index) {
      const at = begin + row * step + col * (isFloat ? 4 : 2);
      frame.values[index] = isFloat ? message.getFloat32(at, littleEndian) : message.getUint16(at, littleEndian);
    }
  }
}

/** foxglove_msgs/msg/Grid with the fields value (float32), its sigma (float32), status (uint8), in that order. */
export function readGrid(message: DataView, frame: GridFrame): void {
  frame.stampS = reader.begin(message).header();
  reader.skip(7, 8);
  const cols = reader.uint32();
  reader.skip(2, 8);
  const rowStride = reader.uint32();
  const cellStride = reader.uint32();
  const fields = reader.uint32();
  if (fields !== 3) throw new RangeError(`a grid of ${fields} fields`);
  const valueAt = readFieldOffset();
  const sigmaAt = readFieldOffset();
  const statusAt = readFieldOffset();
  const length = reader.uint32();
  const begin = reader.position;
  resize(frame, Math.floor(length / rowStride), cols);
  for (let row = 0, index = 0; row < frame.rows; ++row) {
    for (let col = 0; col < cols; ++col, ++index) {
      const cell = begin + row * rowStride + col * cellStride;
      frame.values[index] = message.getFloat32(cell + valueAt, true);
      frame.sigmas[index] = message.getFloat32(cell + sigmaAt, true);
      frame.statuses[index] = message.getUint8(cell + statusAt);
    }
  }
}

function readFieldOffset(): number {
  reader.skipText();
  const offset = reader.uint32();
  reader.skip(1, 1);
  return offset;
}

/** Force and status of every taxel of the suit. */
export interface PointsFrame {
  stampS: number;
  newtons: Float32Array<ArrayBuffer>;
  statuses: Uint8Array<ArrayBuffer>;
}

const MOST_POINTS = 1 << 20;

/** sensor_msgs/msg/PointCloud2 with newtons (float32) and status (uint8) among its fields. */
export function readPoints(message: DataView, frame: PointsFrame): void {
  frame.stampS = reader.begin(message).header();
  const count = reader.uint32() * reader.uint32();
  let newtonsAt = -1;
  let statusAt = -1;
  for (let left = reader.uint32(); left > 0; --left) {
    const mark = reader.position;
    if (reader.textIs("newtons")) newtonsAt = reader.uint32();
    else if (reader.rewind(mark).textIs("status")) statusAt = reader.uint32();
    else reader.skip(1, 4);
    reader.skip(1, 1);
    reader.skip(1, 4);
  }
  reader.bool();
  const stride = reader.uint32();
  reader.skip(1, 4);
  const length = reader.uint32();
  const begin = reader.position;
  if (newtonsAt < 0 || statusAt < 0 || count > MOST_POINTS || length < count * stride) {
    throw new RangeError("the points hold no newtons and status");
  }
  if (frame.newtons.length !== count) {
    frame.newtons = new Float32Array(count);
    frame.statuses = new Uint8Array(count);
  }
  for (let index = 0; index < count; ++index) {
    frame.newtons[index] = message.getFloat32(begin + index * stride + newtonsAt, true);
    frame.statuses[index] = message.getUint8(begin + index * stride + statusAt);
  }
}
