// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node press_test.mjs path/to/dermis [folder for pictures]
// A board whose channels are wired in an unknown order: somebody marks the places on a picture and presses them.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { it } from "node:test";
import {
  assertUnhurt,
  browser,
  eventually,
  folder,
  networkDevice,
  openPage,
  part,
  serveEmpty,
  useEmptyFolder,
} from "./harness.mjs";

useEmptyFolder();

const PIXEL = Buffer.from(
  "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==",
  "base64",
);
const MARKS = [
  [0.25, 0.75],
  [0.75, 0.75],
  [0.25, 0.25],
  [0.6, 0.2],
];
const PICTURES = process.argv[3];

let held = -1;
let force = 0;
/** Six channels; that which is held rises, and the others a little. */
function say() {
  force += 0.4 * ((held < 0 ? 0 : 600) - force);
  const channels = Array.from({ length: 6 }, (_, channel) => 300 + (channel === held ? force : 0.1 * force));
  return `${channels.map((reading) => Math.round(reading + 2 * Math.random())).join(" ")}\n`;
}

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

const says = (page, words) =>
  eventually(page, (text) => document.querySelector("[data-role=press-words]").textContent.includes(text), words);

async function press(page, channel, then) {
  held = channel;
  await pause(500);
  held = -1;
  await says(page, then);
}

it("places on a picture get their channels, and are shown there", async () => {
  const device = await networkDevice(say);
  const server = await serveEmpty("--from", `${device.uri}?rows=1&cols=6&line={values}`);
  try {
    const page = await openPage(browser, server.url);
    await part(page, "array-setup").waitFor();
    await page.locator("#array-name").fill("hand");
    await page.locator("[data-role=press-guide] summary").click();
    assert.equal(await page.locator(".press-mark").count(), 6, "the places of the sent shape");
    await page.locator("#press-picture").setInputFiles({ name: "hand.png", mimeType: "image/png", buffer: PIXEL });
    const canvas = page.locator(".press-room canvas");
    await canvas.waitFor();
    await canvas.scrollIntoViewIfNeeded();
    const { width, height } = await canvas.boundingBox();
    for (const [x, y] of MARKS) await page.locator(".press-room").click({ position: { x: x * width, y: y * height } });
    assert.equal(await page.locator(".press-mark").count(), MARKS.length);
    await part(page, "press-begin").click();
    assert.match(await part(page, "press-words").textContent(), /how far 1 is from 2/);
    await page.locator("#press-distance").fill("30");
    await part(page, "press-begin").click();
    await says(page, "Press place 1 of 4");
    await press(page, 4, "Press place 2 of 4");
    await press(page, 4, "Channel 4 answered at place 1 already");
    await press(page, 1, "Press place 3 of 4");
    if (PICTURES !== undefined) await page.screenshot({ path: join(PICTURES, "pressing.png"), fullPage: true });
    await part(page, "press-skip").click();
    await says(page, "Press place 4 of 4");
    await part(page, "press-back").click();
    await press(page, 0, "Press place 4 of 4");
    await press(page, 5, "All places were pressed");
    assert.deepEqual(await page.locator(".press-mark").allTextContents(), ["c4", "c1", "c0", "c5"]);
    await part(page, "press-use").click();
    await page.locator("main").waitFor();
    await part(page, "maps").waitFor();
    const array = readFileSync(join(folder, "hand/array.toml"), "utf8");
    assert.match(array, /taxel_order = \[4, 1, 0, 5\]\nsent = \[1, 6\]/);
    const positions = readFileSync(join(folder, "hand/array.positions.csv"), "utf8").split("\n");
    assert.equal(positions[0], "x_mm,y_mm,z_mm");
    const second = positions[2].split(",").map(Number);
    assert.ok(Math.abs(second[0] - 30) < 0.5, positions[2]);
    held = 0;
    await pause(1500);
    const suit = await (await fetch(new URL("suit.json", server.url))).json();
    assert.equal(suit.arrays[0].places.length, 4);
    if (PICTURES !== undefined) {
      await page.screenshot({ path: join(PICTURES, "map.png") });
      await page.keyboard.press("3");
      await pause(4000);
      await page.screenshot({ path: join(PICTURES, "suit.png") });
    }
    assertUnhurt(page);
    await page.close();
  } finally {
    device.close();
    await server.stop();
  }
});
