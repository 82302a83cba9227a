// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** A touch that a person has named, as /recognition/examples has it; `picture` only at first. */
export interface TaughtTouch {
  id: number;
  class: string;
  session: string;
  picture?: number[];
}

/** So many a class are asked for, and fewer are warned of. */
export const WANTED_EXAMPLES = 10;
const FEW_EXAMPLES = 5;

export function byClass(touches: readonly TaughtTouch[]): Map<string, TaughtTouch[]> {
  const classes = new Map<string, TaughtTouch[]>();
  for (const touch of touches) classes.set(touch.class, [...(classes.get(touch.class) ?? []), touch]);
  return classes;
}

/** Warnings to a person before the training. */
export function warnings(touches: readonly TaughtTouch[]): string[] {
  const few = [...byClass(touches)].filter(([, some]) => some.length < FEW_EXAMPLES);
  const lines = few.map(([name, some]) => `${name} has ${some.length} of at least ${FEW_EXAMPLES} examples`);
  if (touches.length > 0 && new Set(touches.map(({ session }) => session)).size === 1) {
    lines.push("all examples are of one session: teach some another day, or after the array was taken off and put on");
  }
  return lines;
}

/** Why there can be no training yet; empty: it can begin. */
export function missing(touches: readonly TaughtTouch[]): string {
  const classes = byClass(touches);
  if (classes.size < 2) return "Teach at least two classes.";
  const single = [...classes].find(([, some]) => some.length < 2);
  return single === undefined ? "" : `${single[0]} needs a second example.`;
}
