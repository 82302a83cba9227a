// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { expect, it } from "vitest";
import { boardLinkOf, hashOf, MOST_LAYOUT_BYTES } from "./board_link";

const LAYOUT = '[layout]\nname = "mat"\nrows = 12\ncols = 10 # \u00b5\n';

it("brings a layout and its baud as they were", async () => {
  for (const baud of [undefined, 921600])
    expect(await boardLinkOf(await hashOf({ layout: LAYOUT, baud }))).toEqual({ layout: LAYOUT, baud });
});

it("may hold the layout as it is", async () => {
  expect(await boardLinkOf(`#toml=${encodeURIComponent(LAYOUT)}&baud=9600`)).toEqual({ layout: LAYOUT, baud: 9600 });
});

it("leaves the addresses of the views alone", async () => {
  for (const hash of ["", "#/array", "#/suit/mat"]) expect(await boardLinkOf(hash)).toBeUndefined();
});

it("is refused where it is damaged, too long, or has no baud that is one", async () => {
  const hash = await hashOf({ layout: LAYOUT, baud: undefined });
  await expect(boardLinkOf(hash.slice(0, -9))).rejects.toThrow("cannot be read");
  await expect(boardLinkOf("#layout=%%%")).rejects.toThrow("cannot be read");
  await expect(boardLinkOf(await hashOf({ layout: "x".repeat(1e7), baud: undefined }))).rejects.toThrow("more than");
  await expect(boardLinkOf(`#toml=${"x".repeat(MOST_LAYOUT_BYTES + 1)}`)).rejects.toThrow("more than");
  for (const baud of ["0", "fast", "1e9", "9600.5"])
    await expect(boardLinkOf(`${hash}&baud=${baud}`)).rejects.toThrow("baud must be");
});
