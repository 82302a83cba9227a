// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { CdrReader } from "./cdr_reader";

/** dermis_msgs/msg/ArrayStatistics; NaN: not known. */
export interface ArrayStatistics {
  name: string;
  ended: boolean;
  error: string;
  frames: number;
  rejected: number;
  lost: number;
  damaged: number;
  rateHz: number;
  jitterS: number;
  latencyP50S: number;
  latencyP99S: number;
  temperatureCelsius: number;
  supplyV: number;
}

/** dermis_msgs/msg/Statistics. */
export interface Statistics {
  stampS: number;
  arrays: ArrayStatistics[];
  recording: boolean;
  recordingFile: string;
  recordingFrames: number;
  clients: number;
  clientDrops: number;
}

/** diagnostic_msgs/msg/DiagnosticStatus. */
export interface HealthStatus {
  level: number;
  name: string;
  message: string;
  values: { key: string; value: string }[];
}

const MOST_ARRAYS = 4096;
const MOST_VALUES = 65536;
const reader = new CdrReader();

function readMany<T>(most: number, readOne: () => T): T[] {
  const count = reader.uint32();
  if (count > most) throw new RangeError(`a sequence of ${count}`);
  return Array.from({ length: count }, readOne);
}

export function readStatistics(message: DataView): Statistics {
  return {
    stampS: reader.begin(message).header(),
    arrays: readMany(MOST_ARRAYS, readArrayStatistics),
    recording: reader.bool(),
    recordingFile: reader.text(),
    recordingFrames: reader.uint64(),
    clients: reader.uint32(),
    clientDrops: reader.uint64(),
  };
}

function readArrayStatistics(): ArrayStatistics {
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
  };
}

/** diagnostic_msgs/msg/DiagnosticArray. */
export function readHealth(message: DataView): HealthStatus[] {
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
