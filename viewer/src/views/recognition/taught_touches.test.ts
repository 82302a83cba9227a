// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { byClass, missing, type TaughtTouch, warnings } from "./taught_touches";

function touches(name: string, count: number, session = "1"): TaughtTouch[] {
  return Array.from({ length: count }, (_, index) => ({ id: index, class: name, session }));
}

describe("touches that are taught", () => {
  it("are shown by class", () => {
    const classes = byClass([...touches("tap", 2), ...touches("hug", 1), ...touches("tap", 1)]);
    expect([...classes].map(([name, some]) => [name, some.length])).toEqual([
      ["tap", 3],
      ["hug", 1],
    ]);
  });

  it("are warned of below five and from one session", () => {
    expect(warnings([])).toEqual([]);
    const few = warnings([...touches("tap", 10), ...touches("hug", 4)]);
    expect(few).toEqual(["hug has 4 of at least 5 examples", expect.stringContaining("one session")]);
    expect(warnings([...touches("tap", 10), ...touches("hug", 5, "2")])).toEqual([]);
  });

  it("can be learned from two classes of two on", () => {
    expect(missing(touches("tap", 10))).toMatch(/two classes/);
    expect(missing([...touches("tap", 10), ...touches("hug", 1)])).toMatch(/hug/);
    expect(missing([...touches("tap", 2), ...touches("hug", 2)])).toBe("");
  });
});
