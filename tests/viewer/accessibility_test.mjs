// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node accessibility_test.mjs path/to/dermis
// axe-core finds nothing serious on any view, light or dark, and the Tab key reaches every control.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { describe, it } from "node:test";
import { findings } from "./faults.mjs";
import { arrayToml, bench, browser, networkDevice, openPage, shown, useBench, VIEWS } from "./harness.mjs";

const MOST_TABS = 200;

useBench();

const showArray = (command, test) => shown(command, "array", test);

async function open(page, view) {
  await page.locator(`[data-tab=${view}]`).click();
  await page.locator(`[data-view=${view}]`).waitFor();
}

const live = () => ["--from", "sim:contacts?rate=100", ...bench.model];

describe("axe-core, light and dark", () => {
  it("finds nothing serious on any view", async () => {
    await showArray(live(), async (page) => {
      await page.locator("[data-contact]").first().waitFor();
      const found = {};
      for (const view of VIEWS) {
        await open(page, view);
        if (view === "suit") await page.locator(".array-label").first().waitFor();
        if (view === "health") await page.locator("[data-role=faults] > li").first().waitFor();
        const lines = await findings(page);
        if (lines.length > 0) found[view] = lines;
      }
      assert.deepEqual(found, {});
    });
  });

  it("finds nothing serious in the dialogs, with pressed buttons, and while a calibration is guided", async () => {
    await showArray(["--from", "sim:rehearsal?rate=100", ...bench.model], async (page) => {
      const found = {};
      const look = async (state) => {
        const lines = await findings(page);
        if (lines.length > 0) found[state] = lines;
      };
      for (const dialog of ["show-help", "show-thresholds", "show-take"]) {
        await page.click(`[data-role=${dialog}]`);
        await look(dialog);
        await page.keyboard.press("Escape");
      }
      for (const button of ["pause", "draw-region"]) await page.click(`[data-role=${button}]`);
      await page.selectOption("[data-role=share]", "highest");
      await look("pressed");
      await open(page, "calibration");
      await page.locator("[data-role=start]").click();
      await page.locator("[data-role=walk][data-stage='2']").waitFor();
      await look("guided");
      assert.deepEqual(found, {});
    });
  });

  it("finds nothing serious where an array is not calibrated, or not described", async () => {
    writeFileSync(bench.path("plain.toml"), arrayToml("plain", 4, 5));
    await showArray(["--from", "sim:contacts?rate=100", "--model", bench.path("plain.toml")], async (page) => {
      await page.locator("[data-role=uncalibrated]").waitFor();
      assert.deepEqual(await findings(page), []);
    });
    const nothing = await bench.serve("--port", "0");
    try {
      const page = await openPage(browser, nothing.url);
      await page.locator("[data-role=source-setup]").waitFor();
      assert.deepEqual(await findings(page), []);
      await page.close();
    } finally {
      await nothing.stop();
    }
    const device = await networkDevice(() => "[[1,2,3],[4,5,6]]\n");
    const server = await bench.serve("--port", "0", "--from", device.uri);
    try {
      const page = await openPage(browser, server.url);
      await page.locator("[data-role=array-setup]").waitFor();
      assert.deepEqual(await findings(page), []);
      await page.close();
    } finally {
      await server.stop();
      device.close();
    }
  });
});

/** In the page: what the Tab key must reach, each with a number; a group of radio buttons is one stop. */
function numberStops() {
  const stops = [
    ...document.querySelectorAll("a[href], button:enabled, input:enabled, select:enabled, summary, [tabindex='0']"),
  ].filter((stop) => stop.checkVisibility({ visibilityProperty: true }));
  const groups = new Set();
  let count = 0;
  const names = [];
  for (const stop of stops) {
    if (stop.type === "radio" && groups.has(stop.name)) continue;
    if (stop.type === "radio") groups.add(stop.name);
    stop.dataset.stop = String(count++);
    names.push(`${stop.tagName.toLowerCase()} ${stop.dataset.role ?? stop.textContent.trim().slice(0, 20)}`);
  }
  return names;
}

/** In the page: the number of what has the focus, and whether that is seen. */
function focused() {
  const target = document.activeElement;
  const stop = target.type === "radio" ? document.querySelector(`input[name="${target.name}"][data-stop]`) : target;
  const { outlineStyle, outlineWidth } = getComputedStyle(target);
  return {
    stop: stop?.dataset.stop,
    isSeen: outlineStyle !== "none" && parseFloat(outlineWidth) >= 1,
    what: target.outerHTML.slice(0, 80),
  };
}

describe("the keyboard", () => {
  it("reaches every control of every view, and shows where it is", async () => {
    await showArray(live(), async (page) => {
      for (const view of VIEWS) {
        await open(page, view);
        if (view === "suit") await page.locator(".array-label").first().waitFor();
        const names = await page.evaluate(numberStops);
        assert.ok(names.length > 10, `${view}: ${names.length} controls`);
        const missing = new Map(names.map((name, index) => [String(index), name]));
        await page.evaluate(() => document.activeElement.blur());
        for (let tab = 0; tab < MOST_TABS && missing.size > 0; ++tab) {
          await page.keyboard.press("Tab");
          const { stop, isSeen, what } = await page.evaluate(focused);
          if (stop !== undefined) assert.ok(isSeen, `${view}: the focus is not seen on ${what}`);
          missing.delete(stop);
        }
        assert.deepEqual([...missing.values()], [], view);
      }
    });
  });

  it("opens views, and draws a region from corner to corner", async () => {
    await showArray(live(), async (page) => {
      await page.locator("[data-tab=time]").focus();
      await page.keyboard.press("Enter");
      await page.locator("[data-view=time]").waitFor();
      await page.keyboard.press("1");
      await page.locator("[data-role=draw-region]").press("Enter");
      await page.locator("[data-role=maps]").focus();
      for (const key of ["ArrowDown", "ArrowRight", "Enter", "ArrowDown", "ArrowRight", "Enter"])
        await page.keyboard.press(key);
      await page.waitForFunction(() => / N$/.test(document.querySelector("dd[data-role=region]").textContent));
      assert.equal(await page.locator(".summary").getAttribute("data-region"), "r0c1 \u2013 r1c2");
    });
  });
});
