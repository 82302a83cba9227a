// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node light_touch_test.mjs path/to/dermis
// What shows a light touch, and what was before: scales, held values, pressures, regions, events.
import assert from "node:assert/strict";
import { it } from "node:test";
import { bench, eventually, part, shown, tareAnyway, useBench } from "./harness.mjs";

const AREA_M2 = 38.48e-6; // as in the harness's array.toml

useBench();

const showMaps = (test) => shown(["--from", "sim:contacts?rate=200", ...bench.model], "array", test, "light");

const numberIn = (text) => Number(text.replace("\u2212", "-").replace(/[^-\d.]/g, ""));

/** Puts the cursor on the taxel r1c2. */
async function pointAt(page) {
  await part(page, "maps").focus();
  for (const key of ["ArrowDown", "ArrowDown", "ArrowRight", "ArrowRight"]) await page.keyboard.press(key);
  await page.locator("[data-role=cursor][data-taxel=r1c2]").waitFor();
}

/** In the page: whether a pixel is wholly black (0) on a canvas, as dots beyond the scale are in the dark theme. */
function hasDots([place, tone, isWanted]) {
  const canvas = document.querySelector(place);
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  return new Promise((resolve) =>
    requestAnimationFrame(() => {
      const pen = copy.getContext("2d");
      pen.drawImage(canvas, 0, 0);
      const { data } = pen.getImageData(0, 0, copy.width, copy.height);
      let [drawn, dots] = [0, 0];
      for (let at = 0; at < data.length; at += 4) {
        if (data[at + 3] === 0) continue;
        drawn += 1;
        if (data[at] === tone && data[at + 1] === tone && data[at + 2] === tone) dots += 1;
      }
      resolve(drawn > 0 && dots > 0 === isWanted);
    }),
  );
}

it("steps a scale by itself where that is chosen, and says so", async () => {
  await showMaps(async (page) => {
    const scale = part(page, "scale-force");
    await scale.selectOption("fit now");
    assert.match(await scale.locator("option:checked").textContent(), /^0 \u2013 [\d.]+ N$/);
    await scale.selectOption("in steps, by itself");
    await eventually(page, () =>
      /^was [\d.]+$/.test(document.querySelector("[aria-label='Force map'] [data-role=scale-said]").textContent),
    );
    assert.match(await scale.locator("option:checked").textContent(), /^steps: 0 \u2013 [\d.]+ N$/);
  });
});

it("marks values beyond the scale", async () => {
  await showMaps(async (page) => {
    await part(page, "show-contacts").uncheck();
    await part(page, "scale-raw").selectOption("0 \u2013 4095 counts");
    await part(page, "scale-conductance").selectOption("0 \u2013 20 mS");
    await part(page, "scale-force").selectOption("0 \u2013 0.05 N");
    await page.emulateMedia({ colorScheme: "dark" });
    await eventually(page, hasDots, ["[data-role=maps] canvas", 0, true]);
    await part(page, "scale-force").selectOption("0 \u2013 100 N");
    await eventually(page, hasDots, ["[data-role=maps] canvas", 0, false]);
    await page.locator("[data-tab=suit]").click();
    const scale = page.locator("[data-view=suit] select");
    await scale.selectOption("0.5");
    await eventually(page, hasDots, ["[data-role=suit] canvas", 0, true]);
    await scale.selectOption("100");
    await eventually(page, hasDots, ["[data-role=suit] canvas", 0, false]);
  });
});

it("shows the pressure of a taxel: its force over its area", async () => {
  await showMaps(async (page) => {
    await pointAt(page);
    await eventually(
      page,
      () => parseFloat(document.querySelector("[data-role=cursor] [data-field=newtons]").textContent) > 0.05,
    );
    await part(page, "pause").click();
    const [newtons, kilopascals] = await page.evaluate(() =>
      ["newtons", "pressure"].map(
        (field) => document.querySelector(`[data-role=cursor] [data-field=${field}]`).textContent,
      ),
    );
    assert.ok(
      Math.abs(numberIn(kilopascals) - (1e-3 * numberIn(newtons)) / AREA_M2) < 0.07,
      `${newtons}: ${kilopascals}`,
    );
    await part(page, "show-pressure").check();
    await page.locator("[aria-label='Pressure map']").waitFor();
    assert.ok(await page.locator("[aria-label='Force map']").isHidden());
  });
});

it("holds the highest value of a taxel until it is reset", async () => {
  await showMaps(async (page) => {
    await pointAt(page);
    await part(page, "share").selectOption("highest since reset");
    const newtons = () => page.locator("[data-role=cursor] [data-field=newtons]").textContent().then(numberIn);
    await eventually(
      page,
      () => parseFloat(document.querySelector("[data-role=cursor] [data-field=newtons]").textContent) > 0.2,
    );
    let held = 0;
    for (let look = 0; look < 20; ++look) {
      const now = await newtons();
      assert.ok(now >= held, `${held}, then ${now}`);
      held = now;
      await page.waitForTimeout(50);
    }
    await eventually(
      page,
      (before) => {
        document.querySelector("[data-role=reset-share]").click();
        return parseFloat(document.querySelector("[data-role=cursor] [data-field=newtons]").textContent) < before;
      },
      held,
    );
  });
});

it("plots the force on a region that was drawn, and events", async () => {
  await showMaps(async (page) => {
    await part(page, "show-centre").check();
    await eventually(page, () => / mm$/.test(document.querySelector("[data-role=centre]").textContent));
    const plot = await page.locator("[aria-label='Force map'] .map-plot").boundingBox();
    await part(page, "draw-region").click();
    await page.mouse.move(plot.x + 0.45 * plot.width, plot.y + 0.4 * plot.height);
    await page.mouse.down();
    await page.mouse.move(plot.x + 0.75 * plot.width, plot.y + 0.7 * plot.height, { steps: 4 });
    await page.mouse.up();
    const name = await page.locator(".summary[data-region^=r]").getAttribute("data-region");
    assert.match(name, /^r\dc\d \u2013 r\dc\d$/);
    assert.equal(await page.locator("[data-role^=pin][data-taxel]").count(), 0);
    await page.locator("[data-tab=time]").click();
    await page.locator("[data-role=plot-totals] .legend", { hasText: `region ${name}` }).waitFor();
    await part(page, "last-event").evaluate((line) => {
      window.said = "";
      new MutationObserver(() => (window.said += `${line.textContent}\n`)).observe(line, {
        subtree: true,
        childList: true,
        characterData: true,
      });
    });
    await page.keyboard.press("m");
    await tareAnyway(page);
    for (const words of ["last: mark 1, ", "last: tare, ", "last: contact "])
      await eventually(page, (wanted) => window.said.includes(wanted), words);
    await page.locator("[data-tab=array]").click();
    await part(page, "draw-region").click();
    await page.locator(".summary[data-region='']").waitFor();
  });
});

it("selects no words where somebody drags across the maps", async () => {
  await showMaps(async (page) => {
    const maps = await part(page, "maps").boundingBox();
    await page.mouse.move(maps.x + 30, maps.y + 12);
    await page.mouse.down();
    await page.mouse.move(maps.x + maps.width - 30, maps.y + maps.height - 20, { steps: 8 });
    await page.mouse.up();
    assert.equal(await page.evaluate(() => getSelection().toString()), "");
  });
});
