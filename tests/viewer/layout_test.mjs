// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node layout_test.mjs path/to/dermis
// Measures the boxes of all texts and controls of each view: nothing is cut, nothing lies over something else.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { it } from "node:test";
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

const SIZES = [
  { width: 390, height: 844 },
  { width: 768, height: 1024 },
  { width: 1280, height: 720 },
  { width: 1440, height: 900 },
  { width: 1920, height: 1080 },
];
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

/** In the page: what is wrong with its boxes, a line each. */
function faultsOfBoxes() {
  const SLACK = 1.5;
  const style = (target) => getComputedStyle(target);
  const ancestors = (target) => {
    const found = [];
    for (let one = target; one !== null && one !== document.documentElement; one = one.parentElement) found.push(one);
    return found;
  };
  const faults = [];
  const boxes = [];
  const words = (target) =>
    `<${target.tagName.toLowerCase()} ${target.className}> ${(target.value ?? target.textContent).trim().slice(0, 30)}`;
  /** What is seen of a box; undefined where it is scrolled away. */
  const seen = (box, owner) => {
    let { left, top, right, bottom } = box;
    for (const ancestor of ancestors(owner)) {
      const { overflowX, overflowY } = style(ancestor);
      if (overflowX === "visible" && overflowY === "visible") continue;
      const room = ancestor.getBoundingClientRect();
      const isCut = right > room.right + SLACK || left < room.left - SLACK;
      const scrolls = overflowX === "auto" || overflowX === "scroll";
      const isShortened = ancestors(owner).some((one) => style(one).textOverflow === "ellipsis");
      if (isCut && !scrolls && !isShortened && ancestor !== document.body) faults.push(`cut: ${words(owner)}`);
      [left, right] = [Math.max(left, room.left), Math.min(right, room.right)];
      [top, bottom] = [Math.max(top, room.top), Math.min(bottom, room.bottom)];
    }
    return right - left > SLACK && bottom - top > SLACK ? { left, top, right, bottom } : undefined;
  };
  const add = (box, owner) => {
    if (box.width === 0 || box.height === 0) return;
    const part = seen(box, owner);
    if (part === undefined) return;
    if (part.right > innerWidth + SLACK || part.left < -SLACK) faults.push(`beyond the page: ${words(owner)}`);
    boxes.push({ ...part, owner });
  };
  const isLeftOut = (target) =>
    target.closest(".only-spoken, .messages, .suit-room, .uplot, dialog, option, [hidden]") !== null ||
    style(target).visibility === "hidden";
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let text = texts.nextNode(); text !== null; text = texts.nextNode()) {
    const owner = text.parentElement;
    if (text.data.trim() === "" || isLeftOut(owner)) continue;
    const range = document.createRange();
    range.selectNodeContents(text);
    for (const box of range.getClientRects()) add(box, owner);
  }
  for (const control of document.querySelectorAll("input, select, button"))
    if (!isLeftOut(control)) add(control.getBoundingClientRect(), control);
  boxes.forEach((one, index) => {
    for (const other of boxes.slice(index + 1)) {
      if (one.owner.contains(other.owner) || other.owner.contains(one.owner)) continue;
      const width = Math.min(one.right, other.right) - Math.max(one.left, other.left);
      const height = Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top);
      if (width > SLACK && height > SLACK) faults.push(`${words(one.owner)} lies over ${words(other.owner)}`);
    }
  });
  const map = document.querySelector(".map-panel:not([hidden]) .map-plot, .calibration-picture");
  if (map !== null && Math.min(map.clientWidth, map.clientHeight) < 150)
    faults.push(`the map has ${map.clientWidth}x${map.clientHeight} px`);
  const { scrollHeight } = document.documentElement;
  if (innerWidth > 1000 && scrollHeight > innerHeight) faults.push(`the page is ${scrollHeight} px high`);
  if (document.documentElement.scrollWidth > innerWidth)
    faults.push(`the page is ${document.documentElement.scrollWidth} px wide`);
  return [...new Set(faults)];
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
