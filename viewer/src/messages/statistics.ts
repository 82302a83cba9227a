// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { CdrReader } from "./cdr_reader";

/** The levels of diagnostic_msgs/DiagnosticStatus.msg. */
export const DiagnosticLevel = { ok: 0, warn: 1, error: 2, stale: 3 } as const;

const MOST_ARRAYS = 4096;
const MOST_VALUES = 65536;
const reader = new CdrReader();

function readMany<T>(most: number, readOne: () => T): T[] {
  const count = reader.uint32();
  if (count > most) throw new RangeError(`a sequence of ${count}`);
  return Array.from({ length: count }, readOne);
}

/** dermis_msgs/Statistics.msg. */
export function readStatistics(message: DataView) {
  return {
    stampS: reader.begin(message).header(),
    arrays: readMany(MOST_ARRAYS, readArrayStatistics),
    recording: reader.bool(),
    recordingFile: reader.text(),
    recordingFrames: reader.uint64(),
    clients: reader.uint32(),
    clientDrops: reader.uint64(),
    recordingLeftOut: reader.uint64(),
    framesNotStreamed: reader.uint64(),
  };
}

export type Statistics = ReturnType<typeof readStatistics>;

function readArrayStatistics() {
  return {
    name: reader.text(),
    ended: reader.bool(),
    error: reader.text(),
    frames: reader.uint64(),
    rejected: reader.uint64(),
    lost: reader.uint64(),
    damaged: reader.uint64(),
    rateHz: reader.float64(),
    jitterS: reader.float64(),
    latencyP50S: reader.float64(),
    latencyP99S: reader.float64(),
    temperatureCelsius: reader.float64(),
    supplyV: reader.float64(),
    skipped: reader.uint64(),
  };
}

export type ArrayStatistics = ReturnType<typeof readArrayStatistics>;

/** diagnostic_msgs/DiagnosticArray.msg: `status`, without the identifiers of the hardware. */
export function readHealth(message: DataView) {
  reader.begin(message).header();
  return readMany(MOST_ARRAYS, () => {
    const level = reader.uint8();
    const name = reader.text();
    const text = reader.text();
    reader.skipText();
    const values = readMany(MOST_VALUES, () => ({ key: reader.text(), value: reader.text() }));
    return { level, name, message: text, values };
  });
}

export type HealthStatus = ReturnType<typeof readHealth>[number];
