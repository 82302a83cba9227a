// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** Bytes from the first place to the one before the second, and what they hold. */
export type Part = readonly [begin: number, end: number, what: string];

/** Words that stand together: text as it is printed, other bytes as hexadecimal digits. */
export interface Piece {
  words: string;
  /** The kind of part that they are; empty: none. */
  what: string;
}

const KNOWN_CONTROLS = [0x09, 0x0a, 0x0d, 0x1b];
const SHARE_OF_TEXT = 0.85;

/** Cuts bytes, two hexadecimal digits each, where parts begin and end. */
export function piecesOf(hex: string, parts: readonly Part[]): Piece[] {
  const bytes = (hex.match(/../g) ?? []).map((byte) => Number.parseInt(byte, 16));
  const write = isText(bytes) ? writtenAsText : writtenAsNumbers;
  const pieces: Piece[] = [];
  let at = 0;
  const add = (end: number, what: string): void => {
    if (end > at) pieces.push({ words: write(bytes.slice(at, end)), what });
    at = Math.max(at, end);
  };
  for (const [begin, end, what] of parts) {
    add(Math.min(begin, bytes.length), "");
    add(Math.min(end, bytes.length), what);
  }
  add(bytes.length, "");
  return pieces;
}

function isText(bytes: readonly number[]): boolean {
  const letters = bytes.filter((byte) => (byte >= 0x20 && byte < 0x7f) || KNOWN_CONTROLS.includes(byte));
  return letters.length >= SHARE_OF_TEXT * bytes.length;
}

function writtenAsText(bytes: readonly number[]): string {
  return bytes
    .filter((byte) => byte !== 0x0d)
    .map((byte) => (byte === 0x0a || byte === 0x09 || (byte >= 0x20 && byte < 0x7f) ? String.fromCharCode(byte) : "·"))
    .join("");
}

function writtenAsNumbers(bytes: readonly number[]): string {
  return bytes.map((byte) => `${byte.toString(16).padStart(2, "0")} `).join("");
}
