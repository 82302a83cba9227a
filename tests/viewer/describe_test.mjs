// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node describe_test.mjs path/to/dermis
// A device whose bytes dermis does not know: the page proposes layouts, marks the bytes, and reads the device by one.
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { it } from "node:test";
import {
  assertUnhurt,
  becomes,
  browser,
  folder,
  networkDevice,
  openPage,
  part,
  serveEmpty,
  useEmptyFolder,
} from "./harness.mjs";

useEmptyFolder();

/** A press on 4x6 taxels that comes and goes. */
function reading(frame, row, col) {
  const press = 800 * Math.max(0, Math.sin(frame / 6)) * Math.exp(-((row - 2) ** 2 + (col - 3) ** 2) / 3);
  return Math.round(press + ((7 * row + 3 * col + 5 * frame) % 6));
}

let frame = 0;
/** "T 120 R0: ...", a line a row. */
function sayRows() {
  frame += 1;
  return Array.from(
    { length: 4 },
    (_, row) =>
      `T ${20 * frame} R${row}: ${Array.from({ length: 6 }, (__, col) => reading(frame, row, col)).join(" ")}\r\n`,
  ).join("");
}

it("proposes a layout, marks what the bytes hold, and reads the device by it", async () => {
  const device = await networkDevice(sayRows);
  const server = await serveEmpty("--from", device.uri);
  try {
    const page = await openPage(browser, server.url);
    await part(page, "layout-choice").waitFor();
    assert.match(await part(page, "found").textContent(), /look like \d+ lines of 6 numbers: rows=4, cols=6/);
    assert.match(await page.locator("[data-proposal='0']").textContent(), /rows=4, cols=6/);
    const marked = (what) => part(page, "marked-bytes").locator(`.part-${what}`);
    assert.match(await marked("time").first().textContent(), /^\d+$/);
    assert.match(await marked("number").first().textContent(), /^[0-3]$/);
    assert.ok((await marked("values").count()) > 12);
    assert.ok(await part(page, "first-bytes").isHidden());
    assert.equal(await page.locator("#array-rows").inputValue(), "4");
    assert.deepEqual(await part(page, "layout-map").evaluate(({ width, height }) => [width, height]), [6, 4]);
    await page.setViewportSize({ width: 390, height: 844 });
    assert.equal(await page.evaluate(() => document.scrollingElement.scrollWidth), 390);
    await page.setViewportSize({ width: 1280, height: 720 });
    await page.locator("#array-name").fill("mine");
    await part(page, "use-layout").click();
    await page.locator("[data-role=array-setup]", { hasText: "layout=mine/layout.toml" }).waitFor();
    assert.match(readFileSync(join(folder, "mine/layout.toml"), "utf8"), /line = "T \{time_ms\} R\{row\}: \{values\}"/);
    await part(page, "live-picture").waitFor();
    assert.ok(await part(page, "layout-choice").isHidden());
    await page.locator("[data-role=array-setup] button[type=submit]").click();
    await part(page, "uncalibrated").waitFor();
    await becomes(page, "live");
    assert.ok(existsSync(join(folder, "mine/array.toml")));
    assert.match(readFileSync(join(folder, "mine/source.toml"), "utf8"), /layout = "layout.toml"/);
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
    device.close();
  }
});

it("asks the bytes for the rows and columns that are typed", async () => {
  const device = await networkDevice(() => {
    frame += 1;
    return `Frame ${frame} ${Array.from({ length: 24 }, (_, k) => reading(frame, Math.floor(k / 6), k % 6)).join(" ")} ok\n`;
  });
  const server = await serveEmpty("--from", device.uri);
  try {
    const page = await openPage(browser, server.url);
    await page.locator("[data-proposal='0']", { hasText: "rows=4, cols=6?" }).waitFor();
    await page.locator("#array-rows").fill("6");
    await page.locator("#array-cols").fill("4");
    await page.locator("[data-proposal='0']", { hasText: "rows=6, cols=4" }).waitFor();
    assert.deepEqual(await part(page, "layout-map").evaluate(({ width, height }) => [width, height]), [4, 6]);
    await page.locator("#array-name").fill("typed");
    await part(page, "use-layout").click();
    await page.locator("[data-role=array-setup]", { hasText: "layout=typed/layout.toml" }).waitFor();
    assert.match(readFileSync(join(folder, "typed/layout.toml"), "utf8"), /rows = 6\ncols = 4\n/);
    await page.close();
  } finally {
    await server.stop();
    device.close();
  }
});
