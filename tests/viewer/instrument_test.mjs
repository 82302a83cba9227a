// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node instrument_test.mjs path/to/dermis
// The page as an instrument: nothing looks like nothing, and no ring stands on a map that has not its touch.
// DERMIS_TOUCHES: how many touches begin and end, 400 where it is not set.
import assert from "node:assert/strict";
import { it } from "node:test";
import {
  assertUnhurt,
  becomes,
  bench,
  browser,
  networkDevice,
  openPage,
  readCsv,
  shown,
  useBench,
} from "./harness.mjs";

const TOUCHES = Number(process.env.DERMIS_TOUCHES ?? 400);
const LOOKS = 40;
const CORNERS = [0, 4, 15, 19]; // of 4 x 5 taxels
const STEPS_HELD = 6;

useBench(() => {
  const array = ["--array", bench.path("array.toml")];
  bench.run("simulate", ...array, "--scene", "idle", "--frames", "1", "--out", bench.path("idle"));
});

/** In the page: the share of the pixels of all maps that differ from the background and from the lines between taxels;
 *  undefined where nothing was drawn in this frame of the screen. */
function colouredShare() {
  const canvas = document.querySelector("[data-role=maps] canvas");
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  return new Promise((resolve) =>
    requestAnimationFrame(() => {
      const pen = copy.getContext("2d");
      pen.drawImage(canvas, 0, 0);
      const { data } = pen.getImageData(0, 0, copy.width, copy.height);
      const counts = new Map();
      let all = 0;
      for (let at = 0; at < data.length; at += 4) {
        if (data[at + 3] === 0) continue;
        all += 1;
        const color = (data[at] << 16) | (data[at + 1] << 8) | data[at + 2];
        counts.set(color, (counts.get(color) ?? 0) + 1);
      }
      const [background = 0, line = 0] = [...counts.values()].sort((one, other) => other - one);
      resolve(all === 0 ? undefined : (all - background - line) / all);
    }),
  );
}

for (const theme of ["light", "dark"])
  it(`colours no more than a hundredth of the maps of an untouched array, ${theme}`, async () => {
    const untouched = ["--from", "sim:idle?rate=100", ...bench.model];
    await shown(
      untouched,
      "array",
      async (page) => {
        await page.locator("[data-role=highest-taxel]", { hasText: / N / }).waitFor();
        const shares = [];
        while (shares.length < LOOKS) {
          const share = await page.evaluate(colouredShare);
          if (share !== undefined) shares.push(share);
        }
        const mean = shares.reduce((sum, share) => sum + share) / LOOKS;
        console.log(`${theme}: ${(100 * mean).toFixed(2)} % of the pixels are coloured`);
        assert.ok(mean <= 0.01, shares.map((share) => share.toFixed(3)).join(" "));
      },
      theme,
    );
  });

/** A device that taps the four corners of the array, each by itself, 100 times a second. */
function tappingDevice() {
  const [idle] = readCsv(bench.path("idle/frames.csv"));
  const rest = Object.keys(idle)
    .filter((column) => /^r\d+c\d+$/.test(column))
    .map((column) => Number(idle[column]));
  const left = CORNERS.map(() => 0);
  const counts = () => {
    CORNERS.forEach((_, corner) => {
      left[corner] -= 1;
      if (left[corner] < -STEPS_HELD && Math.random() < 0.2) left[corner] = STEPS_HELD;
    });
    const pressed = new Set(CORNERS.filter((_, corner) => left[corner] > 0));
    return rest.map((count, taxel) => Math.round(count + (pressed.has(taxel) ? 500 : 0) + Math.random()));
  };
  return networkDevice(() => `${counts().join(",")}\n`, 10);
}

/** Before the page: compares, at every frame of the screen, the labels on the map with the table. */
function watchRings() {
  window.watched = { touches: new Set(), pictures: 0, rings: 0, faults: [] };
  let labels = new Set();
  const pen = CanvasRenderingContext2D.prototype;
  const { clearRect, fillText } = pen;
  pen.clearRect = function (...area) {
    labels = new Set();
    return clearRect.apply(this, area);
  };
  pen.fillText = function (text, ...rest) {
    const id = /^#(\d+) /.exec(text)?.[1];
    if (id !== undefined) labels.add(id);
    return fillText.call(this, text, ...rest);
  };
  const look = () => {
    requestAnimationFrame(look);
    const view = document.querySelector("[data-view=array]");
    if (view === null || view.dataset.rings === undefined) return;
    const { touches, faults } = window.watched;
    const listed = [...view.querySelectorAll("tr[data-contact]:not([hidden])")].map((row) => row.dataset.contact);
    for (const id of listed) touches.add(id);
    window.watched.pictures += 1;
    window.watched.rings += labels.size;
    for (const id of labels) if (!listed.includes(id)) faults.push(`#${id} is on the map, and not in the table`);
  };
  requestAnimationFrame(look);
}

it("draws no ring that is not in the table, whatever begins and ends", async () => {
  const device = await tappingDevice();
  const server = await bench.serve("--port", "0", "--from", `${device.uri}?rows=4&cols=5`, ...bench.model);
  try {
    const page = await openPage(browser, "about:blank");
    await page.addInitScript(watchRings);
    await page.goto(server.url);
    await becomes(page, "live");
    const touches = () => page.evaluate(() => window.watched.touches.size);
    for (let round = 0; (await touches()) < TOUCHES; ++round) {
      await page.waitForTimeout(2000);
      await page.locator(`[data-tab=${round % 2 === 0 ? "time" : "health"}]`).click();
      await page.waitForTimeout(200);
      await page.locator("[data-tab=array]").click();
      if (round % 3 !== 0) continue;
      for (let press = 0; press < 2; ++press) {
        await page.locator("[data-role=pause]").click();
        await page.waitForTimeout(150);
      }
    }
    const { faults, pictures, rings } = await page.evaluate(() => window.watched);
    console.log(`${await touches()} touches, ${pictures} pictures, ${rings} rings, ${faults.length} faults`);
    assert.deepEqual(faults, []);
    assert.ok(rings > TOUCHES, "most touches were drawn");
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
    device.close();
  }
});
