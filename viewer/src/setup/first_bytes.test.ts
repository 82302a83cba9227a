// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { expect, it } from "vitest";
import { dumpOf } from "./first_bytes";

it("shows bytes as numbers and as text", () => {
  expect(dumpOf("74656d703d32312e350d0a")).toBe(
    "00  74 65 6d 70 3d 32 31 2e  temp=21.\n08  35 0d 0a                 5\u00b7\u00b7",
  );
  expect(dumpOf("")).toBe("");
});
