// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node layout_test.mjs path/to/dermis
// Measures the boxes of all texts and controls of each view: nothing is cut, nothing lies over something else.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { it } from "node:test";
import { faultsOfBoxes, SIZES } from "./faults.mjs";
import {
  arrayToml,
  assertUnhurt,
  becomes,
  bench,
  browser,
  networkDevice,
  openPage,
  readCsv,
  shown,
  useBench,
  VIEWS,
  WAIT_MS,
} from "./harness.mjs";

const ARRAYS = ["chest", "back", "left_arm", "right_arm", "left_shoulder"];
const CONTACTS = 12;
const SIDE = 16;
/** The bar, and the title of a map, on a telephone. */
const HIGHEST_BAR_PX = 130;

useBench(() => {
  const array = ["--array", bench.path("whole.toml")];
  writeFileSync(bench.path("whole.toml"), arrayToml("whole", SIDE, SIDE));
  bench.run("simulate", ...array, "--scene", "idle", "--frames", "1", "--out", bench.path("idle"));
  bench.run("simulate", ...array, "--scene", "calibration", "--out", bench.path("whole"));
  const samples = ["--frames", bench.path("whole/frames.csv"), "--loads", bench.path("whole/loads.csv")];
  bench.run("calibrate", ...array, ...samples, "--out", bench.path("whole.safetensors"));
});

/** A device that sends an array with twelve contacts at once, 50 times a second. */
async function crowdedDevice() {
  const [idle] = readCsv(bench.path("idle/frames.csv"));
  const rest = Object.keys(idle)
    .filter((column) => column.startsWith("r"))
    .map((column) => Number(idle[column]));
  const pressed = new Set(
    Array.from({ length: CONTACTS }, (_, contact) => SIDE * (2 + 5 * Math.floor(contact / 4)) + 2 + 4 * (contact % 4)),
  );
  const counts = () =>
    rest.map((count, taxel) => Math.max(0, Math.round(count + (pressed.has(taxel) ? 400 : 0) + Math.random())));
  return networkDevice(() => `${counts().join(",")}\n`);
}

/** Serves a suit of five arrays, the first of them with twelve contacts. */
async function serveCrowd() {
  const device = await crowdedDevice();
  const array = (name, index) => `[[array]]
name = "${name}"
from = "${index === 0 ? `${device.uri}?rows=${SIDE}&cols=${SIDE}` : `sim:contacts?rate=100&seed=${index}`}"
model = "${index === 0 ? "whole" : "model"}.safetensors"
base_from_array = {translation_mm = [${180 * index}, 0, 0]}
`;
  writeFileSync(bench.path("suit.toml"), `[suit]\n${ARRAYS.map(array).join("\n")}`);
  const server = await bench.serve("--port", "0", "--suit", "suit.toml");
  const stop = async () => {
    await server.stop();
    device.close();
  };
  return { url: server.url, stop };
}

/** Before the page: keeps where the labels of contacts are written on the maps since they were drawn anew. */
function keepLabels() {
  window.labels = [];
  const pen = CanvasRenderingContext2D.prototype;
  const { clearRect, fillText, rect } = pen;
  pen.rect = function (...area) {
    window.map = area;
    return rect.apply(this, area);
  };
  pen.clearRect = function (...area) {
    window.labels = [];
    return clearRect.apply(this, area);
  };
  pen.fillText = function (text, x, y, ...rest) {
    if (text.startsWith("#"))
      window.labels.push({ text, left: x, right: x + this.measureText(text).width, top: y - 8, bottom: y + 8 });
    return fillText.call(this, text, x, y, ...rest);
  };
}

/** In the page: labels of contacts that lie over one another, of a picture that has labels. */
function faultsOfLabels() {
  const { labels } = window;
  if (labels.length < 4) return undefined; // this picture is none of the crowd
  const [mapLeft, , mapWidth] = window.map;
  const over = labels.find(({ left }) => left < mapLeft + mapWidth);
  if (over !== undefined) return [`${over.text} lies over the map`];
  return labels.flatMap((one, index) =>
    labels.slice(index + 1).flatMap((other) => {
      const width = Math.min(one.right, other.right) - Math.max(one.left, other.left);
      const height = Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top);
      return width > 0 && height > 0 ? [`${one.text} lies over ${other.text}`] : [];
    }),
  );
}

/** Views with all that a user can bring into them. */
const fill = {
  array: async (page) => {
    for (const role of ["show-centre", "show-pressure"]) await page.check(`[data-role=${role}]`);
    await page.selectOption("[data-role=share]", "highest");
    for (const select of await page.locator(".map-panel:visible select").all()) await select.selectOption("-1");
    await page.click("[data-role=draw-region]");
    await page.locator("[data-role=maps]").focus();
    for (const key of ["ArrowDown", "ArrowDown", "Enter", "ArrowRight", "Enter"]) await page.keyboard.press(key);
    await page.locator(".summary[data-region^=r]").waitFor();
  },
  time: (page) => page.click("[data-role=mark]"),
};

it("shows the whole guide to somebody with a telephone beside the mat", async () => {
  const server = await bench.serve("--port", "0", "--from", "sim:rehearsal?rate=100", ...bench.model);
  try {
    const page = await openPage(browser, `${server.url}#/calibration`);
    await page.setViewportSize(SIZES[0]);
    await becomes(page, "live");
    await page.locator("[data-role=start]").click();
    await page.locator("[data-role=walk][data-stage='2']").waitFor();
    await page.waitForTimeout(400);
    assert.deepEqual(await page.evaluate(faultsOfBoxes), []);
    for (const part of [".calibration-picture", "[data-role=instruction]", ".ring"]) {
      const { y, height } = await page.locator(part).boundingBox();
      assert.ok(y >= 0 && y + height <= SIZES[0].height, `${part} ends at ${y + height} px`);
    }
    await page.close();
  } finally {
    await server.stop();
  }
});

it("begins with the map on a telephone, and has what the bar offers in a menu", async () => {
  await shown(["--from", "sim:contacts?rate=100", ...bench.model], "array", async (page) => {
    await page.setViewportSize(SIZES[0]);
    for (const [view, map] of [
      ["array", ".map-plot:visible"],
      ["suit", ".suit-room"],
    ]) {
      await page.locator(`[data-tab=${view}]`).click();
      const { y } = await page.locator(map).boundingBox();
      assert.ok(y <= HIGHEST_BAR_PX, `${view} begins at ${y} px`);
    }
    assert.ok(await page.locator("[data-role=tare]").isHidden());
    await page.locator("[data-role=more]").click();
    for (const role of ["record", "pause", "tare", "show-take", "show-thresholds", "theme", "show-help"])
      assert.ok(await page.locator(`[data-role=${role}]`).isVisible(), role);
    await page.locator("[data-role=pause]").click();
    await page.locator("[data-role=connection]", { hasText: "Paused" }).waitFor();
    await page.locator("[data-role=show-help]").click();
    await page.locator("dialog[open]").waitFor();
  });
});

for (const size of SIZES) {
  it(`cuts nothing and lays nothing over another at ${size.width} px, with five arrays and twelve contacts`, async () => {
    const server = await serveCrowd();
    try {
      const page = await openPage(browser, server.url);
      await page.addInitScript(keepLabels);
      await page.reload();
      await page.setViewportSize(size);
      await becomes(page, "live");
      await page.waitForFunction(
        (most) => Number(document.querySelector("dd[data-role=contacts]").textContent) >= most,
        CONTACTS,
        { timeout: WAIT_MS },
      );
      const found = {};
      for (const view of VIEWS) {
        await page.locator(`[data-tab=${view}]`).click();
        await page.locator(`[data-view=${view}]`).waitFor();
        await fill[view]?.(page);
        await page.waitForTimeout(400);
        const faults = await page.evaluate(faultsOfBoxes);
        if (view === "array") {
          const ofLabels = await page.waitForFunction(faultsOfLabels, undefined, { timeout: WAIT_MS });
          faults.push(...(await ofLabels.jsonValue()));
        }
        if (view === "suit") assert.ok((await page.locator(".suit-room").boundingBox()).height > 300);
        if (faults.length > 0) found[view] = faults;
      }
      assert.deepEqual(found, {});
      assertUnhurt(page);
      await page.close();
    } finally {
      await server.stop();
    }
  });
}
