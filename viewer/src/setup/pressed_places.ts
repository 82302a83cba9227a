// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type { Shape } from "./touch_feed";

/** The answer of /array/pressed. */
export interface Pressed {
  ready: boolean;
  /** That is to be pressed now. */
  place: number;
  done: boolean;
  pressed: boolean;
  /** The place whose channel answered again. */
  repeated: number | null;
  /** One a place; null: none, or not yet. */
  channels: (number | null)[];
  problem: string;
}

/** A point on a picture, as shares of its width and height. */
export type Mark = readonly [x: number, y: number];

/** The middles of the taxels of a grid on a picture of it, row by row. */
export function gridMarks({ rows, cols }: Shape): Mark[] {
  return Array.from({ length: rows * cols }, (_, place) => [
    ((place % cols) + 0.5) / cols,
    (Math.floor(place / cols) + 0.5) / rows,
  ]);
}

/**
 * x and y of each mark in mm, from the left and upper end of all, one after another. `distanceMm`: from the first mark to
 * the second. Undefined where that tells nothing.
 */
export function millimetresOf(
  marks: readonly Mark[],
  width: number,
  height: number,
  distanceMm: number,
): number[] | undefined {
  const points = marks.map(([x, y]) => [x * width, y * height] as const);
  const [first, second] = points;
  if (first === undefined || second === undefined || !(distanceMm > 0)) return undefined;
  const pixels = Math.hypot(second[0] - first[0], second[1] - first[1]);
  if (pixels === 0) return undefined;
  const left = Math.min(...points.map(([x]) => x));
  const top = Math.min(...points.map(([, y]) => y));
  const scale = distanceMm / pixels;
  const inHundredths = (mm: number): number => Math.round(100 * mm) / 100;
  return points.flatMap(([x, y]) => [inHundredths(scale * (x - left)), inHundredths(scale * (y - top))]);
}

/** The task of the person now. */
export function taskOf({ ready, place, done, repeated, channels }: Pressed): string {
  if (!ready) return "Take your hands off for a second.";
  if (done) return "All places were pressed.";
  const task = `Press place ${place + 1} of ${channels.length}, and let go.`;
  if (repeated === null) return task;
  return `Channel ${channels[repeated]} answered at place ${repeated + 1} already. ${task} If it is right, it counts then.`;
}

/** Places before the present one that never answered, or whose channel another one has; empty: there are none. */
export function doubtsOf({ place, channels }: Pressed): string[] {
  const silent: number[] = [];
  const shared: string[] = [];
  channels.slice(0, place).forEach((channel, index) => {
    if (channel === null) silent.push(index + 1);
    const first = channels.indexOf(channel);
    if (channel !== null && first < index)
      shared.push(`Places ${first + 1} and ${index + 1} are both answered by channel ${channel}.`);
  });
  if (silent.length === 0) return shared;
  const words = silent.length === 1 ? `Place ${silent[0]}` : `Places ${silent.join(", ")}`;
  return [`${words} never answered.`, ...shared];
}
