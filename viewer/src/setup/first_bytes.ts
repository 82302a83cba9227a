// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
/** Bytes in lines of eight: where they begin, in hexadecimal, and as text with a dot for what is none. */
export function dumpOf(hex: string): string {
  const bytes = hex.match(/../g) ?? [];
  const lines: string[] = [];
  for (let at = 0; at < bytes.length; at += 8) {
    const line = bytes.slice(at, at + 8);
    const text = line.map((byte) => letterOf(Number.parseInt(byte, 16))).join("");
    lines.push(`${at.toString(16).padStart(2, "0")}  ${line.join(" ").padEnd(23)}  ${text}`);
  }
  return lines.join("\n");
}

function letterOf(byte: number): string {
  return byte >= 0x20 && byte < 0x7f ? String.fromCharCode(byte) : "\u00b7";
}
