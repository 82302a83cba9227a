// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { nameWithTime, sizeText } from "./save_file";

describe("a saved file", () => {
  it("has the time of its frame in its name", () => {
    expect(nameWithTime("chest", 1795342500.9)).toBe("chest-20261122-101500");
    expect(nameWithTime("chest", 0)).toBe("chest-19700101-000000");
  });

  it("has a size in words", () => {
    expect([0, 999, 9_949, 12_400, 999_900, 1_260_000, 2_345_000_000].map(sizeText)).toEqual([
      "0.0 kB",
      "1.0 kB",
      "9.9 kB",
      "12 kB",
      "1000 kB",
      "1.3 MB",
      "2.35 GB",
    ]);
  });
});
