// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element } from "../dom";

/** Has the browser save what is at an address. */
export function saveFrom(href: string, name: string): void {
  const link = element("a", { href, download: name });
  document.body.append(link);
  link.click();
  link.remove();
}

export function saveBlob(blob: Blob, name: string): void {
  const href = URL.createObjectURL(blob);
  saveFrom(href, name);
  window.setTimeout(() => URL.revokeObjectURL(href), 60_000);
}

/** "chest-20261122-101500": a time in seconds since 1970, in UTC. */
export function nameWithTime(name: string, seconds: number): string {
  const digits = new Date(1000 * seconds).toISOString().replaceAll(/[-:]/g, "");
  return `${name}-${digits.slice(0, 8)}-${digits.slice(9, 15)}`;
}

export function sizeText(bytes: number): string {
  if (bytes < 1e6) return `${(1e-3 * bytes).toFixed(bytes < 1e4 ? 1 : 0)} kB`;
  return bytes < 1e9 ? `${(1e-6 * bytes).toFixed(1)} MB` : `${(1e-9 * bytes).toFixed(2)} GB`;
}
