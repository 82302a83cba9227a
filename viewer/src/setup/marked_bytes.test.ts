// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { expect, it } from "vitest";
import { piecesOf } from "./marked_bytes";

it("cuts text where what it holds changes", () => {
  const hex = [..."7,12 13\r\n"].map((letter) => letter.charCodeAt(0).toString(16).padStart(2, "0")).join("");
  expect(
    piecesOf(hex, [
      [0, 1, "number"],
      [2, 4, "values"],
      [5, 7, "values"],
    ]),
  ).toEqual([
    { words: "7", what: "number" },
    { words: ",", what: "" },
    { words: "12", what: "values" },
    { words: " ", what: "" },
    { words: "13", what: "values" },
    { words: "\n", what: "" },
  ]);
});

it("writes other bytes as numbers, and parts only as far as there are bytes", () => {
  expect(
    piecesOf("ffff0200f1", [
      [0, 2, "mark"],
      [2, 40, "values"],
    ]),
  ).toEqual([
    { words: "ff ff ", what: "mark" },
    { words: "02 00 f1 ", what: "values" },
  ]);
  expect(piecesOf("", [])).toEqual([]);
});
