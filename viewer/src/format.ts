// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

const NONE = "\u2013";
const MINUS = "\u2212";

/** A number with so many digits after the point; a dash where there is none. */
export function fixed(value: number, digits: number): string {
  if (!Number.isFinite(value)) return value === Infinity ? "\u221e" : NONE;
  const text = Math.abs(value).toFixed(digits);
  return value < 0 && Number(text) !== 0 ? MINUS + text : text;
}

const PREFIXES: readonly (readonly [number, string])[] = [
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "\u00b5"],
  [1e-9, "n"],
];

/** Four digits and the prefix of its size: "12.34 k\u2126". */
export function engineering(value: number, unit: string): string {
  if (!Number.isFinite(value)) return `${fixed(value, 0)} ${unit}`;
  const size = Math.abs(value);
  const [factor, prefix] = PREFIXES.find(([limit]) => size >= 0.99995 * limit) ?? [1e-9, "n"];
  const scaled = value / factor;
  const digits = Math.abs(scaled) >= 999.95 ? 0 : Math.abs(scaled) >= 99.995 ? 1 : Math.abs(scaled) >= 9.9995 ? 2 : 3;
  return value === 0 ? `0 ${unit}` : `${fixed(scaled, digits)} ${prefix}${unit}`;
}

/** Seconds as m:ss.t */
export function clock(seconds: number): string {
  const tenths = Math.max(0, Math.round(seconds * 10));
  const minutes = Math.floor(tenths / 600);
  const rest = ((tenths % 600) / 10).toFixed(1).padStart(4, "0");
  return `${minutes}:${rest}`;
}

export function count(value: number): string {
  return value.toLocaleString("en").replaceAll(",", "\u202f");
}

/** A force, pressure or rate of force, with what it is measured in: kPa for Pa. */
export function withUnit(value: number, unit: string): string {
  return unit === "Pa" ? `${fixed(1e-3 * value, 1)} kPa` : `${fixed(value, 1)} ${unit}`;
}

/** Seconds since 1970, or since a recording began, as hh:mm:ss.mmm of the day (UTC). */
export function timeOfDay(seconds: number): string {
  return new Date(1000 * seconds).toISOString().slice(11, 23);
}

/** Seconds since 1970 as "2026-11-28 05:00:00 UTC". */
export function dateAndTime(seconds: number): string {
  return `${new Date(1000 * seconds).toISOString().slice(0, 19).replace("T", " ")} UTC`;
}

/** The words of what was thrown. */
export function errorText(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

export const STATUS_WORDS = ["ok", "saturated", "above range", "dead", "line fault", "invalid"] as const;

export function statusWord(status: number): string {
  return STATUS_WORDS[status] ?? `status ${status}`;
}
