// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { clock, dayAndTime, engineering, fixed, measured } from "./format";

describe("numbers", () => {
  it("have the prefix of their size and four digits", () => {
    expect(engineering(12345, "\u2126")).toBe("12.35 k\u2126");
    expect(engineering(999.96, "\u2126")).toBe("1.000 k\u2126");
    expect(engineering(912.3, "\u2126")).toBe("912.3 \u2126");
    expect(engineering(1.5e-5, "s")).toBe("15.00 \u00b5s");
    expect(engineering(0, "S")).toBe("0 S");
    expect(engineering(Infinity, "\u2126")).toBe("\u221e \u2126");
  });

  it("have no more digits than two of their standard deviation, and at most hundredths", () => {
    expect(measured(8.4512, 1.573)).toEqual(["8.5", "1.6"]);
    expect(measured(131.2, 15.7)).toEqual(["131", "16"]);
    expect(measured(0.45123, 0.0157)).toEqual(["0.45", "0.02"]);
    expect(measured(NaN, NaN)).toEqual(["\u2013", "\u2013"]);
  });

  it("of a day and its time have the form of the server's log", () => {
    expect(dayAndTime(0)).toBe("1970-01-01 00:00:00 UTC");
  });

  it("have no sign where they are zero, and a dash where they are none", () => {
    expect(fixed(-0.001, 2)).toBe("0.00");
    expect(fixed(-1.5, 1)).toBe("\u22121.5");
    expect(fixed(NaN, 1)).toBe("\u2013");
  });

  it("are times", () => {
    expect(clock(0)).toBe("0:00.0");
    expect(clock(61.26)).toBe("1:01.3");
    expect(clock(59.98)).toBe("1:00.0");
  });
});
