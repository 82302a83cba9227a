// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { Rest } from "./rest";

/** Counts that rest at 2 to 11, with noise of two either way. */
const idle = (time: number, scale = 1): number[] =>
  Array.from({ length: 20 }, (_, taxel) => scale * (2 + (taxel % 10) + ((time * 7 + taxel * 3) % 5) - 2));

describe("the rest of an array that nobody has described", () => {
  it("is nothing, whatever its noise", () => {
    for (const scale of [1, 500]) {
      const rest = new Rest();
      let shares: (number | null)[] = [];
      for (let time = 0; time < 60; ++time) shares = rest.sharesOf(idle(time, scale));
      expect(shares.every((share) => share === 0)).toBe(true);
    }
  });

  it("shows a press as the highest of all, upwards and downwards", () => {
    for (const sign of [1, -1]) {
      const rest = new Rest();
      for (let time = 0; time < 20; ++time) rest.sharesOf(idle(time));
      const pressed = idle(20).map((count, taxel) => count + (taxel === 7 ? sign * 400 : 0));
      const shares = rest.sharesOf(pressed);
      expect(shares[7]).toBe(1);
      expect(shares.filter((share) => share !== 0)).toHaveLength(1);
    }
  });

  it("has no share of a reading that is missing", () => {
    expect(new Rest().sharesOf([5, null])).toEqual([0, null]);
  });
});
