// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** A label in a column: where it wants to begin, and how high it is, in CSS pixels. */
export interface Standing {
  top: number;
  height: number;
}

/** Moves labels so that none lies over another between two heights, each as near to its wish as there is room. Returns
 *  those that have room; the lowest do without. */
export function spread<T extends Standing>(labels: readonly T[], from: number, to: number): T[] {
  const sorted = [...labels].sort((one, other) => one.top - other.top);
  while (sorted.reduce((sum, { height }) => sum + height, 0) > to - from) sorted.pop();
  let free = from;
  for (const label of sorted) {
    label.top = Math.max(free, label.top);
    free = label.top + label.height;
  }
  free = to;
  for (const label of [...sorted].reverse()) {
    label.top = Math.min(free - label.height, label.top);
    free = label.top;
  }
  return sorted;
}
